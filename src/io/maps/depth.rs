//! Reads depth as renderers, sensors and painters store it: finds its background, polarity,
//! encoding and range. Floor 5.

use super::{background, findings::Findings, samples, stored::StoredMap};
use crate::document::source::{DepthConvention, DepthEncoding, Near};
use crate::math::Vec3;
use crate::raster::Plane;
use crate::{Error, Result};
use rayon::prelude::*;

/// Values beyond this are background whatever the scene's unit: renderers write 1e10.
const FAR_AWAY: f32 = 1e9;
/// Numbers that sensors and half floats use for “no depth”.
const USUAL: [f32; 3] = [0.0, -1.0, 65504.0];

/// Depth as stored, without its background, and what the background implies.
pub struct RawDepth {
    /// NaN where there is no surface.
    pub values: Plane<f32>,
    /// A background value was found that cannot be depth.
    pub has_background: bool,
    /// Nearer is higher, where that is certain.
    pub near_high: Option<bool>,
    /// The evidence that nearer is higher, −1 … 1.
    pub near_high_leaning: f32,
}

/// Finds the background and what it implies about the polarity.
pub fn read(
    stored: &StoredMap,
    overrides: &DepthConvention,
    coverage: Option<&Plane<u8>>,
    findings: &mut Findings,
) -> Result<RawDepth> {
    if stored.colors() >= 3 && !stored.is_gray(if stored.lossy { 0.05 } else { 0.004 }) {
        let reason = "the picture is colored; depth is one gray channel (name one with “channel”)";
        return Err(Error::decode(&stored.file, reason));
    }
    let channel = &stored.channels[0];
    let covered = |i: usize| coverage.is_none_or(|c| c.values()[i] > 0);
    let edge = background::constant(stored, coverage).map(|t| t[0]);
    let mut values =
        channel.map(|v| if v.is_finite() && v.abs() < FAR_AWAY { v } else { f32::NAN });
    let stray =
        |v: f32| overrides.background.iter().any(|b| (v - b).abs() <= 1e-6 * b.abs().max(1.0));
    if !overrides.background.is_empty() {
        values = values.updated(|_, _, v| if stray(v) { f32::NAN } else { v });
    }
    let mut sentinels = Vec::new();
    while let Some(sentinel) =
        sentinels.len().lt(&3).then(|| find_sentinel(&values, covered)).flatten()
    {
        values = values.updated(|_, _, v| if v == sentinel { f32::NAN } else { v });
        sentinels.push(sentinel);
    }
    if stored.lossy {
        drop_bled(&mut values, covered);
    }
    let (low, high) = range(&values, covered).ok_or_else(|| {
        Error::decode(
            &stored.file,
            "there is no surface at all: every pixel of the depth map is background",
        )
    })?;
    for s in &sentinels {
        findings.note(format!("{s} counts as background, not as depth"));
    }
    let area = stored.size.area();
    let infinite = (0..area).into_par_iter().any(|i| channel.at(i) >= FAR_AWAY);
    let outliers = sentinels.iter().filter(|s| s.abs() > 1000.0 * (high - low).max(1e-6));
    let (above, below) =
        (infinite || outliers.clone().any(|s| *s > high), outliers.clone().any(|s| *s < low));
    // The farthest value marks the background of metric depth; of camera z, which is negative, the
    // lowest.
    let near_high = match (above, below || high < 0.0) {
        (true, false) => Some(false),
        (false, true) => Some(true),
        _ => None,
    };
    let leaning = match edge.filter(|e| !sentinels.contains(e) && high > low) {
        Some(e) if e >= high => -0.5,
        Some(e) if e <= low => 0.5,
        // Numbers beyond 1 are a scene's own unit, which grows away from the camera.
        _ if stored.step.is_none() && high > 1.0 => -0.3,
        _ => 0.0,
    };
    let has_background = !sentinels.is_empty()
        || (0..area).into_par_iter().any(|i| {
            values.values()[i].is_nan() != channel.at(i).is_nan() || channel.at(i).is_nan()
        });
    Ok(RawDepth { values, has_background, near_high, near_high_leaning: leaning })
}

/// A number at the end of the range that many pixels hold exactly and a gap sets apart from all
/// others.
///
/// The usual "nothing" numbers need a gap of a quarter of the others' range, any other number a gap
/// of four times it.
fn find_sentinel(values: &Plane<f32>, covered: impl Fn(usize) -> bool + Sync) -> Option<f32> {
    let (low, high) = range(values, &covered)?;
    let inside = || {
        let values = values.values().par_iter().enumerate();
        values.filter(|(i, v)| covered(*i) && !v.is_nan()).map(|(_, v)| *v)
    };
    let total = inside().count();
    let next_above = inside().filter(|v| *v > low).reduce(|| f32::INFINITY, f32::min);
    let next_below = inside().filter(|v| *v < high).reduce(|| f32::NEG_INFINITY, f32::max);
    let is_sentinel = |end: f32, next: f32, other: f32| {
        let (gap, rest) = ((next - end).abs(), (other - next).abs());
        let held = inside().filter(|v| *v == end).count();
        let floor = 1e-3 * next.abs();
        let needed = if USUAL.contains(&end) {
            (0.25 * rest).max(floor)
        } else {
            (4.0 * rest).max(1000.0 * floor)
        };
        gap.is_finite() && held >= 4 && held * 1000 >= total && gap > needed
    };
    if is_sentinel(low, next_above, high) {
        return Some(low);
    }
    is_sentinel(high, next_below, low).then_some(high)
}

/// Removes pixels that lossy compression mixed from surface and background: pixels near the rim
/// beyond the range of those further in.
fn drop_bled(values: &mut Plane<f32>, covered: impl Fn(usize) -> bool + Sync) {
    // Blocks of 4 × 4 reach three pixels.
    const REACH: i32 = 3;
    let (w, size) = (values.width(), values.size());
    let here = |v: &Plane<f32>, x: i32, y: i32| {
        v.get(x, y).is_none_or(|z| z.is_finite() && covered(y as usize * w + x as usize))
    };
    let mut inner = vec![false; size.area()];
    for (i, is_inner) in inner.iter_mut().enumerate() {
        let (x, y) = ((i % w) as i32, (i / w) as i32);
        let ring = [
            (-REACH, 0),
            (REACH, 0),
            (0, -REACH),
            (0, REACH),
            (-2, -2),
            (2, -2),
            (-2, 2),
            (2, 2),
            (0, 0),
        ];
        *is_inner = ring.iter().all(|(dx, dy)| here(values, x + dx, y + dy));
    }
    let Some((low, high)) = range(values, |i| inner[i]) else { return };
    let slack = 0.02 * (high - low);
    for (v, _) in values.values_mut().iter_mut().zip(&inner).filter(|(_, inner)| !**inner) {
        if *v < low - slack || *v > high + slack {
            *v = f32::NAN;
        }
    }
}

fn range(values: &Plane<f32>, covered: impl Fn(usize) -> bool + Sync) -> Option<(f32, f32)> {
    const AT_A_TIME: usize = 1 << 14;
    let of_some = |(n, some): (usize, &[f32])| {
        let inside =
            some.iter().enumerate().filter(|(i, v)| !v.is_nan() && covered(n * AT_A_TIME + i));
        inside.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), (_, &v)| {
            (low.min(v), high.max(v))
        })
    };
    let ranges = values.values().par_chunks(AT_A_TIME).enumerate().map(of_some);
    let range = ranges.reduce_with(|(a, b), (c, d)| (a.min(c), b.max(d)))?;
    (range.0 <= range.1).then_some(range)
}

/// The polarity as far as it is known without normals: from the convention, then from the encoding.
pub fn polarity_override(overrides: &DepthConvention, raw: &RawDepth) -> Option<bool> {
    match (overrides.near, overrides.encoding) {
        (Near::Low, _) => Some(false),
        (Near::High, _) => Some(true),
        (Near::Auto, Some(DepthEncoding::Inverse | DepthEncoding::Disparity)) => Some(true),
        _ => raw.near_high,
    }
}

/// Turns stored numbers into planar depth that grows away from the viewer, in any unit; NaN stays.
pub fn planar(
    stored: &StoredMap,
    values: Plane<f32>,
    overrides: &DepthConvention,
    near_high: bool,
    encoding: DepthEncoding,
) -> Plane<f32> {
    let size = values.size();
    let fov = overrides.fov_degrees.or(stored.fov_degrees);
    let focal_px = fov.map(|f| size.width as f32 * 0.5 / (f.to_radians() * 0.5).tan());
    let center = size.center();
    values.updated(|x, y, v| {
        match encoding {
            DepthEncoding::Inverse if v.abs() < 1e-12 => f32::NAN,
            // 1/z falls with distance; where low was said to be near, the numbers are negative
            // camera z inverted.
            DepthEncoding::Inverse => {
                if near_high {
                    1.0 / v
                } else {
                    -1.0 / v
                }
            }
            _ if near_high && encoding != DepthEncoding::RayDistance => -v,
            DepthEncoding::RayDistance => focal_px.map_or(v.abs(), |f| {
                let (u, w) = ((x as f32 + 0.5 - center.x) / f, (y as f32 + 0.5 - center.y) / f);
                v.abs() / (1.0 + u * u + w * w).sqrt()
            }),
            _ => v,
        }
    })
}

/// Whether stored numbers that are nearer where they are higher are 1/z.
///
/// The slope given by the normals, divided by the step of the stored number v, is constant if v is
/// linear in depth. For 1/z it falls as v⁻² (as v⁻¹ in perspective, where a pixel spans more the
/// farther it is): the exponent decides.
pub fn is_inverse_depth(values: &Plane<f32>, normals: &Plane<Vec3>, inside: &Plane<bool>) -> bool {
    let w = values.width();
    let at = samples::spread(inside);
    if at.iter().any(|&i| values.values()[i] < 1e-9) {
        return false;
    }
    let pairs: Vec<(f64, f64)> = at
        .iter()
        .filter_map(|&i| {
            let (n, v) = (normals.values()[i], values.values()[i]);
            let step = samples::slope(values, i % w, i / w, 1)?.length();
            let slope = n.truncate().length() / n.z;
            (n.z > 0.4 && slope > 0.1 && step > 0.0)
                .then(|| (f64::from(v).ln(), f64::from(slope / step).ln()))
        })
        .collect();
    let count = pairs.len() as f64;
    let mean = |f: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(f).sum::<f64>() / count.max(1.0);
    let (mx, my) = (mean(&|p| p.0), mean(&|p| p.1));
    let (xx, xy, yy) = (
        mean(&|p| (p.0 - mx).powi(2)),
        mean(&|p| (p.0 - mx) * (p.1 - my)),
        mean(&|p| (p.1 - my).powi(2)),
    );
    if count < 200.0 || xx < 1e-6 {
        return false;
    }
    let exponent = xy / xx;
    let error = ((yy - exponent * xy).max(0.0) / (xx * count)).sqrt();
    exponent + 4.0 * error < -0.5
}

/// Depth in `[0, 1]` and the planar depths at its ends.
pub struct NormalizedDepth {
    pub depth: Plane<f32>,
    pub near: f32,
    pub far: f32,
}

/// Normalizes planar depth over the surface, near 0, far 1. If stray pixels would flatten the rest
/// (the range from the 0.1th to the 99.9th percentile is under half of the full one), that range is
/// used, with a note.
///
/// * `inside`: pixels with a depth of their own. Partly covered ones that hold the background's
///   value join the range where that value carries on from the surface's (a map whose far end is
///   the background's), and get no depth.
pub fn normalize(
    planar: Plane<f32>,
    inside: &Plane<bool>,
    coverage: &Plane<u8>,
    findings: &mut Findings,
) -> Option<NormalizedDepth> {
    let (mut near, mut far) =
        range(&planar, |i| inside.values()[i] && planar.values()[i].is_finite())?;
    let pairs = planar.values().par_iter().zip(inside.values());
    let mut held: Vec<f32> = pairs.filter(|(v, i)| **i && v.is_finite()).map(|(v, _)| *v).collect();
    let last = held.len() - 1;
    let mut percentile =
        |p: f64| *held.select_nth_unstable_by((last as f64 * p).round() as usize, f32::total_cmp).1;
    let (low, high) = (percentile(0.001), percentile(0.999));
    drop(held);
    if high - low < 0.5 * (far - near) && high > low {
        findings.note(format!(
            "depth was clipped to {low} … {high}: a few stray pixels reach {near} … {far}"
        ));
        (near, far) = (low, high);
    } else {
        let slack = 0.02 * (far - near);
        let (from, to) = (near - slack, far + slack);
        let joins =
            |i: usize| coverage.values()[i] > 0 && (from..=to).contains(&planar.values()[i]);
        (near, far) = range(&planar, joins).map_or((near, far), |(a, b)| (near.min(a), far.max(b)));
    }
    let span = far - near;
    if span <= 0.0 {
        findings.note("depth is the same everywhere; D_p will bend nothing");
    }
    let scale = if span > 0.0 { 1.0 / span } else { 0.0 };
    let depth = planar.updated(|x, y, v| {
        if inside.at(x, y) && v.is_finite() {
            ((v - near) * scale).max(0.0).min(1.0)
        } else {
            f32::NAN
        }
    });
    Some(NormalizedDepth { depth, near, far })
}
