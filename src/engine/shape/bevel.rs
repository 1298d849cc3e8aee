//! Bevels: a profile along the distance from the rim, for letters, shields and coins.
//! Floor 3. Not here: distances (`nearest`).

use super::nearest::RimDistance;
use super::{Form, Outline};
use crate::math::{Range, Vec2, Vec3, vec2, vec3};
use crate::raster::Plane;

/// A profile over the width of a bevel: t runs from 0 at the rim to 1, f from 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub enum BevelCurve {
    /// √(1 − (1 − t)²): upright at the rim, level at the top.
    Round,
    /// t: a straight slope.
    Chisel,
    /// 1 − √(1 − t²): level at the rim, upright at the top.
    Cove,
    /// 1: a plate with upright walls.
    Step,
    /// Straight lines through points (t, f), t rising from 0 to 1.
    Points(Vec<Vec2>),
}

impl BevelCurve {
    /// Every named curve, with its name in documents.
    pub const NAMED: [(BevelCurve, &'static str); 4] = [
        (BevelCurve::Round, "round"),
        (BevelCurve::Chisel, "chisel"),
        (BevelCurve::Cove, "cove"),
        (BevelCurve::Step, "step"),
    ];
    /// Points of a custom curve.
    pub const MOST_POINTS: usize = 64;

    /// Height at t and the direction of the curve there as (run, rise), `[0, 1]` each except for
    /// custom curves, which may fall.
    pub fn at(&self, t: f32) -> (f32, Vec2) {
        if t >= 1.0 {
            let last = match self {
                BevelCurve::Points(points) => points.last().map_or(1.0, |p| p.y),
                _ => 1.0,
            };
            return (last, vec2(1.0, 0.0));
        }
        let t = t.max(0.0);
        match self {
            BevelCurve::Round => {
                let height = (1.0 - (1.0 - t) * (1.0 - t)).max(0.0).sqrt();
                (height, vec2(height, 1.0 - t))
            }
            BevelCurve::Chisel => (t, vec2(1.0, 1.0)),
            BevelCurve::Cove => {
                let left = (1.0 - t * t).max(0.0).sqrt();
                (1.0 - left, vec2(left, t))
            }
            BevelCurve::Step => (1.0, vec2(1.0, 0.0)),
            BevelCurve::Points(points) => {
                let span = points.windows(2).find(|pair| t < pair[1].x || pair[1].x >= 1.0);
                let Some([a, b]) = span.and_then(|pair| <[Vec2; 2]>::try_from(pair).ok()) else {
                    return (t, vec2(1.0, 1.0));
                };
                let run = (b.x - a.x).max(1e-4);
                let share = ((t - a.x) / run).max(0.0).min(1.0);
                (a.y + (b.y - a.y) * share, vec2(run, b.y - a.y))
            }
        }
    }
}

/// The numbers of a bevel.
#[derive(Clone, Debug, PartialEq)]
pub struct Bevel {
    /// How far in from the rim it rises, px.
    pub width: f32,
    /// How high, px.
    pub height: f32,
    /// The profile from the rim inward.
    pub curve: BevelCurve,
}

impl Bevel {
    /// What a width may be, px.
    pub const WIDTH: Range = 0.5..=4096.0;
    /// What a height may be, px.
    pub const HEIGHT: Range = -4096.0..=4096.0;
}

impl Default for Bevel {
    fn default() -> Self {
        Self { width: 24.0, height: 24.0, curve: BevelCurve::Round }
    }
}

/// z = f(d/w) · height over an outline, d the distance to the rim.
pub fn bevel_outline(outline: &Outline, bevel: &Bevel) -> Form {
    let RimDistance { distance, inward } = RimDistance::of(outline);
    let inside = outline.inside_pixels();
    let steep = bevel.height / bevel.width;
    let at = |x: usize, y: usize| bevel.curve.at(distance.at(x, y) / bevel.width);
    let height = Plane::from_fn(outline.size(), |x, y| {
        if inside.at(x, y) { at(x, y).0 * bevel.height } else { 0.0 }
    });
    let normals = Plane::from_fn(outline.size(), |x, y| {
        let (way, along) = if inside.at(x, y) {
            (inward.at(x, y), at(x, y).1)
        } else if let Some(line) = outline.rim_line(x, y) {
            (-line.outward, bevel.curve.at(0.0).1)
        } else {
            return Vec3::Z;
        };
        vec3(-way.x * along.y * steep, way.y * along.y * steep, along.x).normalize_or(Vec3::Z)
    });
    let (height, normals) = (height.into(), normals.into());
    Form { corner: outline.corner(), height, normals, coverage: outline.coverage().clone() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_begin_at_the_rim_and_end_at_their_height_and_tell_their_slope() {
        let own = BevelCurve::Points(vec![vec2(0.0, 0.0), vec2(0.3, 0.8), vec2(1.0, 1.0)]);
        for curve in [BevelCurve::Round, BevelCurve::Chisel, BevelCurve::Cove, own] {
            assert!(
                curve.at(0.0).0.abs() < 1e-6 && (curve.at(1.0).0 - 1.0).abs() < 1e-6,
                "{curve:?}"
            );
            for t in [0.1f32, 0.25, 0.5, 0.9] {
                let slope = (curve.at(t + 1e-3).0 - curve.at(t - 1e-3).0) / 2e-3;
                let along = curve.at(t).1;
                assert!(
                    (along.y / along.x - slope).abs() < 0.01 * (1.0 + slope.abs()),
                    "{curve:?} at {t}"
                );
            }
        }
        assert_eq!(BevelCurve::Step.at(0.0).0, 1.0);
    }

    #[test]
    fn a_chiselled_square_has_four_straight_slopes_and_a_level_top() {
        let outline = Outline::of_path(
            &[vec2(5.0, 5.0), vec2(105.0, 5.0), vec2(105.0, 105.0), vec2(5.0, 105.0)],
            1 << 20,
        )
        .unwrap();
        let bevel = Bevel { width: 20.0, height: 10.0, curve: BevelCurve::Chisel };
        let form = bevel_outline(&outline, &bevel);
        let at = |x: i32, y: i32| ((x - form.corner.0) as usize, (y - form.corner.1) as usize);
        let (left, middle) = (at(12, 55), at(55, 55));
        assert!(
            (form.height.at(left.0, left.1) - 3.75).abs() < 0.02,
            "{}",
            form.height.at(left.0, left.1)
        );
        assert!(
            (form.normals.at(left.0, left.1) - vec3(-0.5, 0.0, 1.0).normalize()).length() < 1e-3
        );
        assert_eq!(
            (form.height.at(middle.0, middle.1), form.normals.at(middle.0, middle.1)),
            (10.0, Vec3::Z)
        );
    }
}
