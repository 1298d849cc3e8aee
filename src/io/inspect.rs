//! Describes a file before its use is decided: format, size, channels and layers.
//! Floor 5. `info` prints it; a dialog that opens a file shows it. Conventions are `maps`' work.

use super::maps::{MapRole, fitting};
use super::{Budget, bitmap, exr::ExrFile, svg};
use crate::Result;
use crate::math::{Size, vec3};
use std::path::Path;

/// A layer of an EXR.
#[derive(Clone, Debug, PartialEq)]
pub struct ExrLayer {
    /// Empty for the channels without a layer.
    pub name: String,
    /// The channels' whole names and kinds: half, float or uint.
    pub channels: Vec<(String, &'static str)>,
}

/// A picture file from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct FileDescription {
    /// `PNG`, `EXR`, …
    pub format: &'static str,
    /// The size of the picture.
    pub size: Size,
    /// For pictures: `r`, `g`, `b`, `a`, or `y` if gray. For EXR: the channels' whole names.
    pub channels: Vec<String>,
    /// Bits of a channel; of EXR those of the widest.
    pub bits: u8,
    /// EXR only: its layers, and what its pixels are compressed with.
    pub layers: Vec<ExrLayer>,
    /// How it is packed, if the format has several ways.
    pub compression: Option<String>,
    /// EXR only: layers that fit as normals and as depth, the likeliest first.
    pub normals: Vec<String>,
    /// The depth of each channel.
    pub depths: Vec<String>,
    /// No two color channels differ.
    pub is_gray: bool,
    /// Whether it is a color picture whose texels, read as normals, have length 1.
    pub looks_like_normals: bool,
    /// A defect that could be worked around.
    pub warning: Option<&'static str>,
}

/// Describes a file. Of an EXR only some rows of colors that may be normals are decoded; other
/// formats' pixels all are, so that damage shows.
pub fn describe(file: &Path, bytes: &[u8], budget: &Budget) -> Result<FileDescription> {
    if ExrFile::is_exr(bytes) {
        describe_exr(file, bytes, budget)
    } else if svg::is_svg(bytes) {
        describe_svg(file, bytes, budget)
    } else {
        describe_bitmap(file, bytes, budget)
    }
}

fn describe_exr(file: &Path, bytes: &[u8], budget: &Budget) -> Result<FileDescription> {
    let exr = ExrFile::open(file, bytes, budget)?;
    let of = |i: &usize| exr.channels().get(*i).map(|c| (c.name.clone(), c.kind));
    let layers = exr.passes().iter().map(|p| ExrLayer {
        name: p.name.clone(),
        channels: p.channels.iter().filter_map(of).collect(),
    });
    Ok(FileDescription {
        format: "EXR",
        size: exr.size(),
        channels: exr.channels().iter().map(|c| c.name.clone()).collect(),
        bits: if exr.channels().iter().all(|c| c.kind == "half") { 16 } else { 32 },
        layers: layers.collect(),
        compression: Some(exr.compression()),
        normals: fitting(&exr, MapRole::Normals),
        depths: fitting(&exr, MapRole::Depth),
        is_gray: exr.channels().len() == 1,
        looks_like_normals: false,
        warning: None,
    })
}

/// An SVG drawing, at its own size.
fn describe_svg(file: &Path, bytes: &[u8], budget: &Budget) -> Result<FileDescription> {
    let painted = svg::decode_paint(file, bytes, 0, 0, budget)?;
    Ok(FileDescription {
        format: "SVG",
        size: painted.size,
        channels: ["r", "g", "b", "a"].map(String::from).into(),
        bits: 8,
        layers: Vec::new(),
        compression: None,
        normals: Vec::new(),
        depths: Vec::new(),
        is_gray: false,
        looks_like_normals: false,
        warning: painted.warning,
    })
}

fn describe_bitmap(file: &Path, bytes: &[u8], budget: &Budget) -> Result<FileDescription> {
    let bitmap = bitmap::decode(file, bytes, budget)?;
    let image = &bitmap.image;
    let color = image.color();
    let names: &[&str] = if color.has_color() { &["r", "g", "b", "a"] } else { &["y", "a"] };
    let texels = texels(image);
    let is_gray = texels.iter().all(|[r, g, b]| r == g && g == b);
    Ok(FileDescription {
        format: bitmap.format,
        size: Size::new(image.width(), image.height()),
        channels: names
            .iter()
            .take(color.channel_count().into())
            .map(ToString::to_string)
            .collect(),
        bits: (color.bits_per_pixel() / u16::from(color.channel_count())) as u8,
        layers: Vec::new(),
        compression: None,
        normals: Vec::new(),
        depths: Vec::new(),
        is_gray,
        looks_like_normals: !is_gray && length_error(&texels) < 0.06,
        warning: bitmap.warning,
    })
}

/// Colors spread over the picture.
fn texels(image: &image::DynamicImage) -> Vec<[f32; 3]> {
    use image::GenericImageView;
    let (w, h) = image.dimensions();
    let step = (f64::from(w) * f64::from(h) / 40_000.0).sqrt().ceil().max(1.0) as usize;
    let rows = (0..h).step_by(step);
    let at = |x: u32, y: u32| {
        let [r, g, b, _] = image.get_pixel(x, y).0;
        [r, g, b].map(|v| f32::from(v) / 255.0)
    };
    rows.flat_map(|y| (0..w).step_by(step).map(move |x| (x, y))).map(|(x, y)| at(x, y)).collect()
}

/// How far the vectors of these numbers are from length 1 in the mean, z about ½ as x and y are, or
/// from 0 to 1.
fn length_error(texels: &[[f32; 3]]) -> f32 {
    let of = |z: fn(f32) -> f32| {
        let error =
            |[r, g, b]: &[f32; 3]| (vec3(2.0 * r - 1.0, 2.0 * g - 1.0, z(*b)).length() - 1.0).abs();
        texels.iter().map(error).sum::<f32>() / texels.len().max(1) as f32
    };
    of(|b| 2.0 * b - 1.0).min(of(|b| b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exr::encode_channels;
    use crate::math::Vec3;

    const SIDE: u32 = 32;

    /// A dome's normals; none in the corners.
    fn dome(i: usize) -> Option<Vec3> {
        let at = |v: usize| (v as f32 + 0.5) / SIDE as f32 * 2.0 - 1.0;
        let (x, y) = (at(i % SIDE as usize), -at(i / SIDE as usize));
        let square = x * x + y * y;
        (square < 1.0).then(|| vec3(x, y, (1.0 - square).sqrt()))
    }

    fn described(names: [&str; 3], color: impl Fn(usize) -> Vec3) -> FileDescription {
        let size = Size::new(SIDE, SIDE);
        let colors: Vec<Vec3> = (0..size.area()).map(color).collect();
        let channels = names
            .into_iter()
            .enumerate()
            .map(|(c, name)| (name, colors.iter().map(|v| v[c]).collect()));
        let file = Path::new("a.exr");
        describe(
            file,
            &encode_channels(file, size, channels.collect()).unwrap(),
            &Budget::default(),
        )
        .unwrap()
    }

    #[test]
    fn colors_are_normals_where_they_have_length_1_and_a_finished_picture_is_none() {
        let rgb = ["R", "G", "B"];
        let signed = described(rgb, |i| dome(i).unwrap_or(Vec3::ZERO));
        let biased = described(rgb, |i| dome(i).unwrap_or(Vec3::Z) * 0.5 + 0.5);
        let sunny =
            described(rgb, |i| dome(i).map_or(Vec3::ZERO, |n| vec3(0.9, 0.7, 0.4) * n.y.max(0.05)));
        assert_eq!([signed.normals.len(), biased.normals.len(), sunny.normals.len()], [1, 1, 0]);
        // The red of colors is not depth either.
        assert_eq!([signed.depths.len(), sunny.depths.len()], [0, 0]);
        let named = described(["N.R", "N.G", "N.B"], |i| dome(i).unwrap_or(Vec3::ZERO) * 0.3);
        assert_eq!(named.normals, ["N"], "what is called so is one, whatever its length");
    }

    #[test]
    fn a_map_whose_z_goes_from_0_to_1_is_one() {
        let texels = |full_z: bool| -> Vec<[f32; 3]> {
            let of = |n: Vec3| {
                [n.x * 0.5 + 0.5, n.y * 0.5 + 0.5, if full_z { n.z } else { n.z * 0.5 + 0.5 }]
            };
            (0..(SIDE * SIDE) as usize).map(|i| of(dome(i).unwrap_or(Vec3::Z))).collect()
        };
        assert!(length_error(&texels(true)) < 0.01 && length_error(&texels(false)) < 0.01);
        let sky: Vec<[f32; 3]> =
            (0..900).map(|i| [0.2 + i as f32 / 3000.0, 0.5, 0.9 - i as f32 / 2000.0]).collect();
        assert!(length_error(&sky) > 0.06, "{}", length_error(&sky));
    }
}
