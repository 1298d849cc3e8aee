//! Loaded maps become maps in the program's convention, and then a surface: step by step, since
//! each map needs findings of the other. Floor 5.

use super::background::{self, FilledEdge};
use super::coverage::{drop_unknown, report_mask};
use super::findings::Findings;
use super::overrides::ConventionOverrides;
use super::stored::StoredMap;
use super::{depth, normals, orientation, steps};
use crate::Result;
use crate::document::Progress;
use crate::document::source::{DepthConvention, DepthEncoding, Near};
use crate::math::{Size, Vec3};
use crate::raster::Plane;
use crate::surface::{Maps, differentiate, integrate};

/// The stored maps, one of which may be missing, with what is stated and detected about them.
pub struct LoadedMaps<'a> {
    pub normal: Option<&'a StoredMap>,
    pub depth: Option<&'a StoredMap>,
    /// Conventions that these leave open are detected.
    pub overrides: &'a ConventionOverrides,
    pub findings: &'a mut Findings,
}

/// Maps in the program's convention, one of which may be missing.
pub struct UnderstoodMaps {
    /// Unit; zero where there are none.
    normals: Option<Plane<Vec3>>,
    /// Grows away from the viewer, in any unit.
    planar: Option<Plane<f32>>,
    /// Pixels of the surface with numbers of their own.
    pub inside: Plane<bool>,
    coverage: Plane<u8>,
    /// The coverage comes from something other than the numbers.
    is_masked: bool,
    pub fov_degrees: Option<f32>,
}

impl LoadedMaps<'_> {
    /// Converts the maps to the program's convention; the coverage is the one that is given, if
    /// any.
    pub fn interpret(mut self, given_coverage: Option<Plane<u8>>) -> Result<UnderstoodMaps> {
        let Self { normal, depth, overrides, .. } = self;
        let raw_depth = depth
            .map(|d| depth::read(d, &overrides.depth, given_coverage.as_ref(), self.findings))
            .transpose()?;
        let edge_of = |map: &StoredMap| FilledEdge::of(map, given_coverage.as_ref());
        let (edge_n, edge_d) = (normal.and_then(edge_of), depth.and_then(edge_of));
        let bare = |i: usize| raw_depth.as_ref().is_some_and(|d| d.values.values()[i].is_nan());
        let raw_normals = normal
            .map(|n| {
                normals::read(
                    n,
                    &overrides.normal,
                    given_coverage.as_ref(),
                    edge_n.as_ref(),
                    bare,
                    self.findings,
                )
            })
            .transpose()?;
        let size = normal.or(depth).map_or(Size::new(1, 1), |m| m.size);
        let w = size.width as usize;
        let explicit = given_coverage.is_some();
        let mut coverage = given_coverage.unwrap_or_else(|| {
            let by_normals = raw_normals.as_ref().map(|r| &r.coverage);
            Plane::from_fn(size, |x, y| {
                if bare(y * w + x) { 0 } else { by_normals.map_or(255, |c| c.at(x, y)) }
            })
        });
        if !explicit {
            let is_found_in_depth = raw_depth.as_ref().is_some_and(|depth| depth.has_background);
            report_mask([normal, depth], is_found_in_depth, &coverage, self.findings);
        }
        // A partly covered rim pixel with the background's value has no value of its own.
        let borrowed = |edge: &Option<FilledEdge>, i: usize| {
            explicit
                && coverage.values()[i] < 255
                && edge.as_ref().is_some_and(|edge| edge.holds.values()[i])
        };
        let inside = Plane::from_fn(size, |x, y| {
            let i = y * w + x;
            let zero = raw_normals
                .as_ref()
                .is_some_and(|r| background::is_degenerate(r.vectors.values()[i]));
            coverage.values()[i] > 0
                && !bare(i)
                && !zero
                && !borrowed(&edge_n, i)
                && !borrowed(&edge_d, i)
        });
        // A constant border does not help to detect conventions, and its edge may be the
        // silhouette.
        let fills =
            |i: usize| !explicit && edge_n.as_ref().is_some_and(|edge| edge.holds.values()[i]);
        let judged = Plane::from_fn(size, |x, y| inside.at(x, y) && !fills(y * w + x));
        let enough = judged.values().iter().filter(|j| **j).count() >= 16;
        let judged = if enough { &judged } else { &inside };
        let (mut unit, planar) = self.settle_maps(raw_normals, raw_depth, judged);
        let turned_away = (0..size.area())
            .find(|&i| fills(i))
            .zip(unit.as_ref())
            .is_some_and(|(i, n)| n.values()[i].z < -0.5);
        if turned_away && enough {
            self.findings.note("the border's normals point away from the viewer, unlike the rest: they are background");
            (0..size.area()).filter(|&i| fills(i)).for_each(|i| coverage.values_mut()[i] = 0);
        }
        if let (Some(normals), Some(step)) = (&mut unit, normal.and_then(|n| n.step))
            && overrides.normal.snap_flat.unwrap_or(step > 0.001)
        {
            steps::snap_flat(normals);
        }
        let inside = inside.updated(|x, y, is| is && coverage.at(x, y) > 0);
        let normals =
            unit.map(|n| n.updated(|x, y, n| if inside.at(x, y) { n } else { Vec3::ZERO }));
        let fov_degrees = overrides.depth.fov_degrees.or(depth.and_then(|s| s.fov_degrees));
        Ok(UnderstoodMaps { normals, planar, inside, coverage, is_masked: explicit, fov_degrees })
    }

    /// Settles axes and polarity together; unit normals and planar depth that grows away from the
    /// viewer.
    fn settle_maps(
        &mut self,
        raw_normals: Option<normals::RawNormals>,
        raw_depth: Option<depth::RawDepth>,
        inside: &Plane<bool>,
    ) -> (Option<Plane<Vec3>>, Option<Plane<f32>>) {
        let Self { normal, depth, overrides, .. } = *self;
        let near_override =
            raw_depth.as_ref().and_then(|d| depth::polarity_override(&overrides.depth, d));
        let leaning = raw_depth.as_ref().map_or(0.0, |d| d.near_high_leaning);
        let near = orientation::FixedAxes {
            near_high: near_override,
            near_high_leaning: leaning,
            ..Default::default()
        };
        let values =
            raw_depth.map(|d| match (overrides.depth.smooth_steps, depth.and_then(|s| s.step)) {
                (Some(true), Some(step)) => steps::smooth(&d.values, step, inside),
                _ => d.values,
            });
        let oriented = normal.zip(raw_normals).map(|(stored, raw)| {
            normals::orient(
                raw,
                stored,
                &overrides.normal,
                inside,
                values.as_ref(),
                &near,
                self.findings,
            )
        });
        let Some((stored, values)) = depth.zip(values) else {
            return (oriented.map(|o| o.0), None);
        };
        let near_high = match &oriented {
            Some((_, near_high)) => *near_high,
            None => find_depth_polarity(near_override, leaning, self.findings),
        };
        let unit = oriented.map(|o| o.0);
        let encoding = self.depth_encoding(stored, &values, unit.as_ref(), inside, near_high);
        let planar = depth::planar(stored, values, &overrides.depth, near_high, encoding);
        let near = if near_high { Near::High } else { Near::Low };
        self.findings.depth =
            Some(DepthConvention { near, encoding: Some(encoding), ..overrides.depth.clone() });
        (unit, Some(planar))
    }

    /// The meaning of a depth map's numbers.
    fn depth_encoding(
        &mut self,
        stored: &StoredMap,
        values: &Plane<f32>,
        unit: Option<&Plane<Vec3>>,
        inside: &Plane<bool>,
        near_high: bool,
    ) -> DepthEncoding {
        let (settings, findings) = (&self.overrides.depth, &mut *self.findings);
        if let Some(encoding) = settings.encoding {
            findings.add_given("depth.encoding", encoding.name());
            if encoding == DepthEncoding::RayDistance
                && settings.fov_degrees.or(stored.fov_degrees).is_none()
            {
                findings.note("depth is measured along the ray; without the field of view (“fov”) it is used as it is");
            }
            return encoding;
        }
        let layer = stored.layer.to_lowercase();
        if layer.contains("distance") && settings.fov_degrees.or(stored.fov_degrees).is_some() {
            findings.add_detected("depth.encoding", "ray-distance", 0.7);
            return DepthEncoding::RayDistance;
        }
        let inverse = near_high && unit.is_some_and(|n| depth::is_inverse_depth(values, n, inside));
        let encoding = if inverse { DepthEncoding::Inverse } else { DepthEncoding::Planar };
        findings.add_detected(
            "depth.encoding",
            encoding.name(),
            if unit.is_some() { 0.8 } else { 0.5 },
        );
        encoding
    }
}

/// The polarity of depth without normals: the background is far.
fn find_depth_polarity(overrides: Option<bool>, leaning: f32, findings: &mut Findings) -> bool {
    let name = |high: bool| if high { "high" } else { "low" };
    match overrides {
        Some(high) => findings.add_detected("depth.near", name(high), 0.95),
        None if leaning != 0.0 => findings.add_detected("depth.near", name(leaning > 0.0), 0.7),
        None => findings.add_assumed("depth.near", "low", 0.3),
    }
    overrides.unwrap_or(leaning > 0.0)
}

impl UnderstoodMaps {
    /// Normalizes depth and derives the map that is missing. If canceled meanwhile, the result is
    /// of no use.
    pub fn complete(
        self,
        overrides: &ConventionOverrides,
        findings: &mut Findings,
        progress: &Progress,
    ) -> Maps {
        let UnderstoodMaps { normals, planar, inside, mut coverage, is_masked, fov_degrees } = self;
        let size = inside.size();
        let nothing = || Plane::full(size, f32::NAN);
        let normalized = planar.and_then(|p| depth::normalize(p, &inside, &coverage, findings));
        findings.depth_range = normalized.as_ref().map(|n| (n.near, n.far));
        let (normals, depth) = match (normals, normalized) {
            (Some(normals), Some(n)) => (normals, n.depth),
            (Some(normals), None) => {
                findings.note(
                    "depth was derived from the normals; a depth map is better at \
                               occluding contours",
                );
                let go_on = || !progress.is_canceled();
                let depth =
                    integrate::depth_from_normals_while(&normals, &inside, &go_on).map(|i| i.depth);
                (normals, depth.unwrap_or_else(nothing))
            }
            (None, Some(n)) => {
                let range_px = overrides
                    .depth
                    .range_px
                    .unwrap_or_else(|| depth_range_px(&n, &inside, fov_degrees));
                findings.note(format!(
                    "normals were derived from the depth, which is assumed to be {range_px:.0} \
                     pixels deep (“range_px”)"
                ));
                (differentiate::normals_from_depth(&n.depth, range_px), n.depth)
            }
            (None, None) => (Plane::full(size, Vec3::ZERO), nothing()),
        };
        if is_masked {
            drop_unknown(&mut coverage, &normals, findings);
        }
        Maps { normals, depth, coverage }
    }
}

/// The depth of a surface in pixels: from the camera if depth is metric and the field of view
/// known, else half the longer side of the surface, as for a ball.
fn depth_range_px(
    depth: &depth::NormalizedDepth,
    inside: &Plane<bool>,
    fov_degrees: Option<f32>,
) -> f32 {
    if let Some(fov) = fov_degrees.filter(|_| depth.near > 0.0) {
        let middle = 0.5 * (depth.near + depth.far);
        let width = 2.0 * middle * (fov.to_radians() * 0.5).tan();
        return (depth.far - depth.near) / width * inside.width() as f32;
    }
    let held = |line: &dyn Fn(usize) -> bool, n: usize| {
        let first = (0..n).find(|&k| line(k));
        let last = (0..n).rev().find(|&k| line(k));
        first.zip(last).map_or(1, |(a, b)| b - a + 1)
    };
    let wide = held(&|x| (0..inside.height()).any(|y| inside.at(x, y)), inside.width());
    let tall = held(&|y| inside.row(y).iter().any(|&i| i), inside.height());
    wide.max(tall) as f32 * 0.5
}
