//! Finds the layer of an EXR that holds the normals, the depth or the coverage, by the names that
//! renderers use. Floor 5.

use crate::exr::{ExrFile, ExrPass};
use crate::math::vec3;
use crate::{Error, Result};
use std::path::Path;

/// Which map a file is read for: it decides which EXR layer is looked for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum MapRole {
    /// A normal map.
    Normals,
    /// A depth map.
    Depth,
    /// A mask.
    Mask,
}

/// The channels to read.
pub struct ChannelChoice {
    pub channels: Vec<usize>,
    pub alpha: Option<usize>,
    /// The layer's name.
    pub name: String,
}

/// Chooses by the given name, else by the usual names of layers.
pub fn choose(
    file: &Path,
    exr: &ExrFile,
    wanted: Option<&str>,
    role: MapRole,
) -> Result<ChannelChoice> {
    let alpha = coverage(exr);
    let (channels, name) = match (wanted, role) {
        (Some(wanted), _) => {
            find_named(exr, wanted, role).ok_or_else(|| missing(file, exr, wanted))?
        }
        (None, MapRole::Normals) => {
            let rank = |pass: &ExrPass| normal_rank(pass).filter(|_| can_be_normals(exr, pass));
            best(exr, rank, vector_channels).ok_or_else(|| none(file, exr, "normals"))?
        }
        (None, MapRole::Depth) => {
            best(exr, depth_rank, depth_channels).ok_or_else(|| none(file, exr, "depth"))?
        }
        (None, MapRole::Mask) => match alpha {
            Some(a) => (vec![a], exr.channels()[a].name.clone()),
            None => best(exr, |p| Some(p.channels.len()), vec_of_first)
                .ok_or_else(|| none(file, exr, "a mask"))?,
        },
    };
    let alpha = alpha.filter(|a| role != MapRole::Mask && !channels.contains(a));
    Ok(ChannelChoice { channels, alpha, name })
}

/// The layers that fit a role, best first: the window lists them for the user to choose.
pub fn fitting(exr: &ExrFile, role: MapRole) -> Vec<String> {
    let rank = |p: &ExrPass| match role {
        MapRole::Normals => {
            normal_rank(p).filter(|_| vector_channels(p).is_some() && can_be_normals(exr, p))
        }
        MapRole::Depth => depth_rank(p).filter(|_| depth_channels(p).is_some()),
        MapRole::Mask => p.letters("a").map(|_| 0),
    };
    let mut found: Vec<(usize, String)> =
        exr.passes().iter().filter_map(|p| Some((rank(p)?, p.name.clone()))).collect();
    found.sort();
    found.into_iter().map(|(_, name)| name).collect()
}

/// Parts of a picture that are looked at, and how far their vectors may be from length 1 in the
/// mean.
const MOST_BANDS: usize = 8;
const MOST_LENGTH_ERROR: f64 = 0.1;

/// Colors whose name does not mention normals may be anything, such as the finished picture:
/// whether they are vectors of length 1, as stored or about ½. Other layers are judged by their
/// names.
fn can_be_normals(exr: &ExrFile, pass: &ExrPass) -> bool {
    let colors = pass.letters("rgb").filter(|_| pass.letters("xyz").is_none());
    let Some(colors) = colors.filter(|_| normal_rank(pass).is_some_and(|rank| rank > SURE_RANK))
    else {
        return true;
    };
    let bands: Vec<_> = exr.bands().collect();
    let step = bands.len().div_ceil(MOST_BANDS).max(1);
    let (mut signed, mut biased, mut count) = (0.0, 0.0, 0u32);
    for rows in bands.into_iter().step_by(step) {
        let Ok(planes) = exr.read_rows(&colors, rows) else { return false };
        let [x, y, z] = [0, 1, 2].map(|c| planes[c].values());
        for ((x, y), z) in x.iter().zip(y).zip(z) {
            let v = vec3(*x, *y, *z);
            // Beyond the surface there is nothing.
            if v.is_finite() && v.abs().max_element() > 0.0 {
                let off = |length: f32| f64::from((length - 1.0).abs().min(1.0));
                signed += off(v.length());
                biased += off((2.0 * v - 1.0).length());
                count += 1;
            }
        }
    }
    count >= 16 && signed.min(biased) / f64::from(count) < MOST_LENGTH_ERROR
}

fn best(
    exr: &ExrFile,
    rank: impl Fn(&ExrPass) -> Option<usize>,
    channels: impl Fn(&ExrPass) -> Option<Vec<usize>>,
) -> Option<(Vec<usize>, String)> {
    let fitting = exr.passes().iter().filter_map(|p| Some((rank(p)?, channels(p)?, p)));
    fitting.min_by_key(|(rank, ..)| *rank).map(|(_, channels, pass)| (channels, pass.name.clone()))
}

fn vec_of_first(pass: &ExrPass) -> Option<Vec<usize>> {
    Some(vec![*pass.channels.first()?])
}

/// x, y and z; red, green and blue; or x and y alone.
fn vector_channels(pass: &ExrPass) -> Option<Vec<usize>> {
    ["xyz", "rgb", "xy", "rg"].iter().find_map(|letters| pass.letters(letters))
}

/// The channel of depth. A layer with x and y is a vector, whose z is not depth.
fn depth_channels(pass: &ExrPass) -> Option<Vec<usize>> {
    if pass.letters("xy").is_some() {
        return None;
    }
    ["z", "v", "t", "r", "y", "x", "w"]
        .iter()
        .find_map(|letter| pass.letters(letter))
        .or_else(|| vec_of_first(pass).filter(|_| pass.letters("a").is_none()))
}

/// The highest rank of a name that speaks of normals.
const SURE_RANK: usize = 2;

/// How likely a layer holds normals by its name, 0 surest.
fn normal_rank(pass: &ExrPass) -> Option<usize> {
    let key = pass.key();
    match key.as_str() {
        "n" | "normal" | "normals" | "nn" | "shnormal" | "shadingnormal" => Some(0),
        "nworld" | "ncam" | "ncamera" | "vraynormals" | "worldnormal" | "worldnormals" => Some(1),
        k if k.contains("normal") || k.contains("nrm") => Some(2),
        k if [
            "position", "p", "pworld", "vector", "uv", "combined", "beauty", "albedo", "motion",
        ]
        .contains(&k) =>
        {
            None
        }
        k if k.contains("crypto") || k.contains("diff") || k.contains("gloss") => None,
        "" => Some(4),
        _ => Some(3 + 2 * usize::from(pass.letters("xyz").is_none())),
    }
}

/// How likely a layer holds depth by its name, 0 surest. A bare `Z` is depth by EXR's own
/// convention, a bare `Y` luminance.
fn depth_rank(pass: &ExrPass) -> Option<usize> {
    let key = pass.key();
    match key.as_str() {
        "" if pass.letters("z").is_some() => Some(0),
        "depth" | "z" | "zdepth" | "vrayzdepth" => Some(1),
        k if k.contains("depth") => Some(2),
        "distance" | "linearz" | "disparity" => Some(3),
        "" if pass.letters("v").or(pass.letters("t")).is_some() => Some(4),
        "mist" => Some(5),
        "" if pass.letters("y").is_some() => Some(6),
        "" if pass.letters("r").is_some() && pass.letters("g").is_none() => Some(8),
        k if k.contains("id") || k == "alpha" || k == "a" || k.contains("normal") || k == "n" => {
            None
        }
        _ if pass.channels.len() == 1 || pass.letters("t").is_some() => Some(7),
        _ => None,
    }
}

/// The alpha of the whole picture: a channel outside the layers, or that of the combined picture.
fn coverage(exr: &ExrFile) -> Option<usize> {
    let alphas: Vec<(String, usize)> =
        exr.passes().iter().filter_map(|p| Some((p.key(), *p.letters("a")?.first()?))).collect();
    let known = ["", "alpha", "a", "rgba", "combined", "beauty", "mask"];
    let found = known.iter().find_map(|k| alphas.iter().find(|(key, _)| key == k));
    found.or(alphas.first().filter(|_| alphas.len() == 1)).map(|(_, channel)| *channel)
}

/// A layer or a channel by name, letter case aside.
fn find_named(exr: &ExrFile, wanted: &str, role: MapRole) -> Option<(Vec<usize>, String)> {
    if let Some(channel) = exr.channels().iter().position(|c| c.name.eq_ignore_ascii_case(wanted))
        && role != MapRole::Normals
    {
        return Some((vec![channel], wanted.into()));
    }
    let pass = exr.passes().iter().find(|p| p.name.eq_ignore_ascii_case(wanted))?;
    let channels = match role {
        MapRole::Normals => vector_channels(pass),
        MapRole::Depth => depth_channels(pass).or_else(|| pass.letters("z")),
        MapRole::Mask => pass.letters("a").or_else(|| vec_of_first(pass)),
    };
    Some((channels?, pass.name.clone()))
}

fn listing(exr: &ExrFile) -> String {
    exr.channels().iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join(", ")
}

fn missing(file: &Path, exr: &ExrFile, wanted: &str) -> Error {
    Error::invalid(
        file,
        "channel",
        format!("this EXR has no suitable layer “{wanted}”; it has {}", listing(exr)),
    )
}

fn none(file: &Path, exr: &ExrFile, what: &str) -> Error {
    let reason = format!(
        "no layer of this EXR looks like {what}; name one with “channel” (it has {})",
        listing(exr)
    );
    Error::decode(file, reason)
}
