//! Converts stored normals to camera space: decoding, axes, space, rim.
//! Floor 5.

use super::axes::AxisMapping;
use super::background::{self, FilledEdge, is_degenerate};
use super::channel::Channel;
use super::encoding::{self, TexelReading};
use super::findings::Findings;
use super::orientation::{self, FixedAxes};
use super::{samples, steps, stored::StoredMap, world};
use crate::Result;
use crate::document::source::{NormalConvention, NormalEncoding, NormalSpace};
use crate::math::{Mat3, Vec3};
use crate::raster::Plane;

/// Normals decoded as vectors, their axes still those of the file.
pub struct RawNormals {
    /// Zero where there are none; any length.
    pub vectors: Plane<Vec3>,
    pub reading: TexelReading,
    /// Coverage by the normals alone.
    pub coverage: Plane<u8>,
}

/// Reads the numbers as vectors.
///
/// * `coverage`: the mask, if there is one.
/// * `edge`: what fills the map's outside.
/// * `without`: pixels that depth says are background.
pub fn read(
    stored: &StoredMap,
    overrides: &NormalConvention,
    coverage: Option<&Plane<u8>>,
    edge: Option<&FilledEdge>,
    without: impl Fn(usize) -> bool + Sync,
    findings: &mut Findings,
) -> Result<RawNormals> {
    let size = stored.size;
    let w = size.width as usize;
    let finite = |i: usize| stored.step.is_some() || stored.texel(i).iter().all(|v| v.is_finite());
    let in_mask = |i: usize| coverage.is_none_or(|c| c.values()[i] > 127) && finite(i);
    let likely = Plane::from_fn(size, |x, y| {
        let i = y * w + x;
        in_mask(i) && !without(i) && edge.is_none_or(|edge| !edge.holds.values()[i])
    });
    let mut at = samples::spread(&likely);
    // A constant map, or one of a single pixel: use all pixels.
    if at.len() < 4 {
        at = (0..size.area()).filter(|&i| in_mask(i)).collect();
    }
    let (stored, smoothed) = smooth_if_asked(stored, overrides, &likely, findings);
    let stored = smoothed.as_ref().unwrap_or(stored);
    let reading = encoding::choose(stored, &at, overrides, findings)?;
    let vectors = Plane::from_fn(size, |x, y| {
        let n = reading.vector(stored.texel(y * w + x));
        if n.is_finite() { n } else { Vec3::ZERO }
    });
    let strange = edge.filter(|edge| {
        let n = reading.vector(edge.texel);
        let rebuilt =
            matches!(reading.encoding, NormalEncoding::TwoChannel | NormalEncoding::Dxt5nm);
        is_degenerate(n)
            || (n.length() - 1.0).abs() > 0.3
            || (rebuilt && n.truncate().length() > 1.2)
    });
    let outside = |i: usize| strange.is_some_and(|edge| edge.holds.values()[i]);
    let interior = at.iter().map(|&i| (vectors.values()[i].length() - 1.0).abs()).sum::<f32>()
        / at.len().max(1) as f32;
    let coverage = background::coverage_of_normals(&vectors, outside, interior < 0.05);
    Ok(RawNormals { vectors, reading, coverage })
}

/// A copy of the file's numbers without the steps of 8 bits, if requested.
fn smooth_if_asked<'a>(
    stored: &'a StoredMap,
    overrides: &NormalConvention,
    inside: &Plane<bool>,
    findings: &mut Findings,
) -> (&'a StoredMap, Option<StoredMap>) {
    let (Some(true), Some(step)) = (overrides.smooth_steps, stored.step) else {
        return (stored, None);
    };
    findings.note("the steps of the normals were smoothed, within half a step");
    let smooth = |c: &Channel| Channel::Float(steps::smooth(&c.map(|v| v), step, inside));
    let channels = stored.channels.iter().map(smooth).collect();
    let copy = StoredMap {
        channels,
        alpha: None,
        file: stored.file.clone(),
        layer: stored.layer.clone(),
        ..*stored
    };
    (stored, Some(copy))
}

/// Turns vectors into camera space; returns them with unit length (zero where there are none), and
/// whether higher stored depth is nearer.
///
/// * `depth`: as stored, NaN where there is none.
pub fn orient(
    raw: RawNormals,
    stored: &StoredMap,
    overrides: &NormalConvention,
    inside: &Plane<bool>,
    depth: Option<&Plane<f32>>,
    near: &FixedAxes,
    findings: &mut Findings,
) -> (Plane<Vec3>, bool) {
    let RawNormals { vectors, reading, .. } = raw;
    let unit = vectors
        .updated(|_, _, n| if is_degenerate(n) { Vec3::ZERO } else { n.normalize_or_zero() });
    let at = samples::spread(inside);
    let turn = space(&unit, stored, overrides, inside, &at, depth, near, findings);
    let turned = match turn {
        Some(m) => unit.updated(|_, _, n| m * n),
        None => unit,
    };
    // Rotated normals are already in camera space: only the user can flip them.
    let fixed = FixedAxes {
        order: overrides
            .channels
            .map(|c| order_of(c, reading.encoding))
            .or(turn.map(|_| [0, 1, 2])),
        flip: [0, 1, 2].map(|k| {
            [overrides.flip_x, overrides.flip_y, overrides.flip_z][k].or(turn.map(|_| false))
        }),
        ..*near
    };
    let found = orientation::find(&turned, inside, depth, &fixed);
    report(overrides, &found, &fixed, depth.is_some(), findings);
    findings.normal = Some(NormalConvention {
        encoding: Some(reading.encoding),
        channels: Some(channels_of(found.axes.order, reading.encoding)),
        srgb: Some(reading.srgb),
        flip_x: Some(found.axes.flip[0]),
        flip_y: Some(found.axes.flip[1]),
        flip_z: Some(found.axes.flip[2]),
        space: Some(if turn.is_some() { NormalSpace::World } else { NormalSpace::Camera }),
        world_to_camera: turn.map(world::to_rows),
        snap_flat: overrides.snap_flat,
        smooth_steps: overrides.smooth_steps,
    });
    let axes = found.axes;
    (
        if axes == AxisMapping::PLAIN { turned } else { turned.updated(|_, _, n| axes.apply(n)) },
        found.near_high,
    )
}

/// Two-channel maps rebuild z themselves, so that no other order makes sense.
pub(super) fn order_of(channels: [u8; 3], encoding: NormalEncoding) -> [usize; 3] {
    match encoding {
        NormalEncoding::TwoChannel | NormalEncoding::Dxt5nm => [0, 1, 2],
        _ => channels.map(|c| usize::from(c).min(2)),
    }
}

fn channels_of(order: [usize; 3], encoding: NormalEncoding) -> [u8; 3] {
    if encoding == NormalEncoding::Dxt5nm { [3, 1, 2] } else { order.map(|c| c as u8) }
}

fn report(
    overrides: &NormalConvention,
    found: &orientation::FoundAxes,
    fixed: &FixedAxes,
    has_depth: bool,
    findings: &mut Findings,
) {
    let letters = NormalConvention::letters(found.axes.order.map(|c| c as u8));
    match overrides.channels {
        Some(c) => findings.add_given("normal.channels", NormalConvention::letters(c)),
        None => findings.add_detected("normal.channels", letters, found.order_confidence),
    }
    let flips = [
        ("normal.flip_x", overrides.flip_x),
        ("normal.flip_y", overrides.flip_y),
        ("normal.flip_z", overrides.flip_z),
    ];
    for (k, (field, given)) in flips.into_iter().enumerate() {
        match (given, fixed.flip[k]) {
            (Some(flip), _) => findings.add_given(field, flip),
            (None, Some(flip)) => findings.add_assumed(field, flip, 0.9),
            (None, None) if found.confidence[k] < 0.5 => {
                findings.add_assumed(field, found.axes.flip[k], found.confidence[k])
            }
            (None, None) => findings.add_detected(field, found.axes.flip[k], found.confidence[k]),
        }
    }
    if has_depth {
        let near = if found.near_high { "high" } else { "low" };
        match fixed.near_high {
            Some(_) => findings.add_detected("depth.near", near, 0.99),
            None => findings.add_detected("depth.near", near, found.near_confidence),
        }
    }
}

/// The matrix from world to camera, if the normals are in world space.
#[expect(clippy::too_many_arguments, reason = "everything that may tell the space")]
fn space(
    unit: &Plane<Vec3>,
    stored: &StoredMap,
    overrides: &NormalConvention,
    inside: &Plane<bool>,
    at: &[usize],
    depth: Option<&Plane<f32>>,
    near: &FixedAxes,
    findings: &mut Findings,
) -> Option<Mat3> {
    if overrides.space == Some(NormalSpace::Camera) {
        findings.add_given("normal.space", "camera");
        return None;
    }
    if let Some(rows) = overrides.world_to_camera {
        findings.add_given("normal.space", "world");
        return world::orthonormal(world::from_rows(rows)).or_else(|| {
            findings.note("normal.world_to_camera is not a rotation; it was ignored");
            None
        });
    }
    let sampled: Vec<Vec3> =
        at.iter().map(|&i| unit.values()[i]).filter(|n| *n != Vec3::ZERO).collect();
    let away = world::share_away(Mat3::IDENTITY, &sampled);
    let toward = world::share_away(Mat3::from_diagonal(Vec3::NEG_ONE), &sampled);
    let sided = orientation::one_sided(&sampled);
    let named = stored.layer.to_lowercase().contains("world");
    let wanted = overrides.space == Some(NormalSpace::World);
    if let Some((matrix, share)) = by_attribute(stored, &sampled)
        && (wanted || named || share + 0.01 < away.min(toward))
    {
        findings.add_detected("normal.space", "world", if share < 0.02 { 0.98 } else { 0.6 });
        findings.note("the normals were rotated by the file's worldToCamera");
        return Some(matrix);
    }
    let planar =
        depth.map(|d| if near.near_high == Some(true) { d.map(|v| -v) } else { d.clone() });
    let aligned = planar.as_ref().and_then(|d| world::from_depth(unit, d, at));
    let mixed = !sided.iter().any(|&s| s) && away.min(toward) > 0.01;
    let turned = aligned
        .is_some_and(|a| a.free.fit > 0.9 && a.is_turned() && angle_degrees(a.free.matrix) > 3.0);
    if !wanted && !named && !mixed && !turned {
        findings.add_detected("normal.space", "camera", if sided[2] { 0.95 } else { 0.6 });
        return None;
    }
    fitted_rotation(aligned.map(|a| a.free), world::from_rim(unit, inside), &sampled, findings)
}

/// The file's own matrix, and the share of the normals that then point away. Renderers disagree on
/// where their camera's z points.
fn by_attribute(stored: &StoredMap, sampled: &[Vec3]) -> Option<(Mat3, f32)> {
    let matrix = stored.world_to_camera.and_then(world::from_attribute)?;
    let looks_back = Mat3::from_diagonal(Vec3::new(1.0, 1.0, -1.0)) * matrix;
    [matrix, looks_back]
        .map(|matrix| (matrix, world::share_away(matrix, sampled)))
        .into_iter()
        .min_by(|(_, a), (_, b)| a.total_cmp(b))
}

/// The rotation to the camera that depth or else the silhouette says.
fn fitted_rotation(
    by_depth: Option<world::FittedRotation>,
    by_rim: Option<world::FittedRotation>,
    sampled: &[Vec3],
    findings: &mut Findings,
) -> Option<Mat3> {
    let is_sound = |r: &world::FittedRotation| world::share_away(r.matrix, sampled) < 0.1;
    if let Some(found) = by_depth.filter(|r| r.fit > 0.8 && is_sound(r)) {
        // Depth of unknown polarity leaves half a turn about the view axis open; the rim settles
        // it.
        let matrix = turn_upright(found.matrix, by_rim.as_ref());
        findings.add_detected("normal.space", "world", (found.fit * 2.0 - 1.0).max(0.1));
        findings.note(format!(
            "the normals are in world space; the rotation to the camera ({:.0}°) was found from \
             the depth map",
            angle_degrees(matrix)
        ));
        return Some(matrix);
    }
    if let Some(found) = by_rim.filter(|r| r.fit > 0.7 && is_sound(r)) {
        findings.add_detected("normal.space", "world", 0.5 * found.fit);
        findings.note(
            "the normals are in world space; the rotation was estimated from the silhouette. A \
             depth map or the camera's matrix would give a better one",
        );
        return Some(found.matrix);
    }
    findings.add_assumed("normal.space", "camera", 0.2);
    findings.note(
        "some normals point away from the viewer, as world-space normals do, but no rotation to the camera was found",
    );
    None
}

/// By how much a rotation turns, degrees.
fn angle_degrees(m: Mat3) -> f32 {
    ((m.col(0).x + m.col(1).y + m.col(2).z - 1.0) * 0.5).max(-1.0).min(1.0).acos().to_degrees()
}

/// The matrix or its half turn about the view axis, whichever fits the silhouette better.
fn turn_upright(matrix: Mat3, by_rim: Option<&world::FittedRotation>) -> Mat3 {
    let Some(rim) = by_rim else { return matrix };
    let likeness =
        |m: Mat3| (m.transpose() * rim.matrix).to_cols_array().iter().step_by(4).sum::<f32>();
    let turned = Mat3::from_diagonal(Vec3::new(-1.0, -1.0, 1.0)) * matrix;
    if likeness(turned) > likeness(matrix) { turned } else { matrix }
}
