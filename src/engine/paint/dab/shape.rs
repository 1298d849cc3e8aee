//! Tips in closed form that are not round: ellipses and squares, averaged over each pixel's piece
//! of the image plane. Floor 3. They are evaluated in *tip space*, where the dab's center is the
//! origin and its half-axes have length 1.

use super::round::slope;
use crate::math::{Affine2, Mat2, Vec2};
use crate::paint::brush::Tip;
use crate::paint::brush_options::Falloff;
use crate::paint::dab_walker::Dab;
use crate::paint::peaked::PeakedProfile;
use crate::paint::profile::{Profile, RoundProfile};
use crate::paint::rim::Rim;
use crate::surface::links;
use crate::surface::support::DabExtent;

/// A tip with two axes; the longer one is the diameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TipShape {
    /// `ratio`: the shorter axis over the longer, `(0, 1]`.
    Ellipse {
        /// The shorter axis, relative to the longer.
        ratio: f32,
    },
    /// A rectangle, the longer axis along x before it is turned.
    Square {
        /// The shorter side, relative to the longer.
        ratio: f32,
    },
}

/// Half of a dab's least width, px: a thinner dab is fainter instead.
const LEAST_HALF_PX: f32 = 0.75;

impl TipShape {
    /// With the length and width that the dab's inputs gave it.
    pub fn of_dab(self, dab: &Dab) -> Self {
        match self {
            TipShape::Ellipse { .. } => TipShape::Ellipse { ratio: dab.ratio },
            TipShape::Square { .. } => TipShape::Square { ratio: dab.ratio },
        }
    }

    /// The shorter half-axis relative to the longer one, as a dab is drawn; and the factor by which
    /// the dab's flow is reduced.
    fn ratio(self, radius: f32) -> (f32, f32) {
        let (TipShape::Ellipse { ratio } | TipShape::Square { ratio }) = self;
        let ratio = ratio.max(*Tip::RATIO.start()).min(1.0);
        let drawn = ratio.max((LEAST_HALF_PX / radius).min(1.0));
        (drawn, ratio / drawn)
    }

    /// The ratio of a pixel's width that a dab reaches: below 1 if it is thinner than a pixel.
    pub fn thinness(self, dab: &Dab) -> f32 {
        self.ratio(dab.radius).1
    }

    /// Tip space from canvas px. The footprint is turned counter-clockwise as seen.
    pub fn tip_from_canvas(self, dab: &Dab) -> Affine2 {
        let (ratio, _) = self.ratio(dab.radius);
        let per_axis = Vec2::new(1.0, 1.0 / ratio) / dab.radius;
        Affine2::from_scale(per_axis)
            * Affine2::from_angle(dab.rotation_rad)
            * Affine2::from_translation(-dab.at)
    }

    /// How far a dab reaches.
    pub fn extent(self, falloff: Falloff, dab: &Dab) -> DabExtent {
        let (ratio, _) = self.ratio(dab.radius);
        let corner = match self {
            TipShape::Ellipse { .. } => 1.0,
            TipShape::Square { .. } => ratio.hypot(1.0),
        };
        let reach = match falloff {
            Falloff::Smooth => RoundProfile::new(dab.hardness, dab.softness).outer_radius(),
            Falloff::Peaked => PeakedProfile::new(dab.hardness, dab.softness).outer_radius(),
        };
        // A pixel's width along the axis that the tip squeezes most, seen along the other one.
        let filter_px = 0.5 * (0.5 * (ratio + 1.0 / ratio)).max(1.0);
        DabExtent { radius_px: dab.radius * reach * corner, filter_px }
    }
}

/// D at a span's pixels, at one more at each end, and in the rows above and below, in tip space;
/// (x, y) each.
#[derive(Clone, Copy)]
pub struct TipSpanNeighbors<'f> {
    pub above: (&'f [f32], &'f [f32]),
    pub row: (&'f [f32], &'f [f32]),
    pub below: (&'f [f32], &'f [f32]),
    /// Which neighbors continue the surface, one for each pixel of the span.
    pub linked: &'f [u8],
    /// ∂/∂q where no neighbor does.
    pub flat: Mat2,
}

/// Coverage of an ellipse at (x, y) in tip space, J's columns `across` and `along`: F(|p|) over a
/// width |Jᵀ p̂|; and the share of the pixel that a stroke with this rim may reach.
#[inline(always)]
pub fn ellipse<P: Profile>(
    profile: &P,
    rim: Rim,
    (x, y): (f32, f32),
    across: (f32, f32),
    along: (f32, f32),
) -> (f32, f32) {
    // At the exact center there is no direction; the next pixel's width serves as well as any.
    let r2 = x * x + y * y + 1e-12;
    let (a, b) = (across.0 * x + across.1 * y, along.0 * x + along.1 * y);
    let (r, width_squared) = (r2.sqrt(), (a * a + b * b) / r2);
    let wide = across.0 * across.0 + across.1 * across.1 + along.0 * along.0 + along.1 * along.1;
    (profile.mean_over(r, width_squared, wide - width_squared), rim.share(r, width_squared.sqrt()))
}

/// Coverage of a square: F(|x|) F(|y|), each over the pixel's width along its own axis; and the
/// share.
#[inline(always)]
pub fn square<P: Profile>(
    profile: &P,
    rim: Rim,
    (x, y): (f32, f32),
    across: (f32, f32),
    along: (f32, f32),
) -> (f32, f32) {
    let width_x = across.0 * across.0 + along.0 * along.0;
    let width_y = across.1 * across.1 + along.1 * along.1;
    let of = |v: f32, width_squared: f32| {
        (profile.mean(v.abs(), width_squared), rim.share(v.abs(), width_squared.sqrt()))
    };
    let (of_x, of_y) = (of(x, width_x), of(y, width_y));
    (of_x.0 * of_y.0, of_x.1 * of_y.1)
}

impl TipShape {
    /// Coverage of each pixel of a span, in `[0, 1]`, and the share that the stroke may reach; 0
    /// where D is NaN. `d`: in the tip space of this dab.
    pub fn row(
        self,
        falloff: Falloff,
        dab: &Dab,
        d: TipSpanNeighbors,
        coverage: &mut [f32],
        shares: &mut [f32],
    ) {
        let Dab { hardness, softness, rim, thin, .. } = *dab;
        let out = (coverage, shares);
        match (self, falloff) {
            (TipShape::Ellipse { .. }, Falloff::Smooth) => {
                ellipse_row(d, &RoundProfile::new(hardness, softness), (rim, thin), out)
            }
            (TipShape::Square { .. }, Falloff::Smooth) => {
                square_row(d, &RoundProfile::new(hardness, softness), (rim, thin), out)
            }
            (TipShape::Ellipse { .. }, Falloff::Peaked) => {
                fill_peaked_ellipse_row(
                    d,
                    &PeakedProfile::new(hardness, softness),
                    (rim, thin),
                    out,
                );
            }
            (TipShape::Square { .. }, Falloff::Peaked) => {
                fill_peaked_square_row(
                    d,
                    &PeakedProfile::new(hardness, softness),
                    (rim, thin),
                    out,
                );
            }
        }
    }
}

/// Coverage and shares of a span.
type Covered<'c> = (&'c mut [f32], &'c mut [f32]);

crate::widest! {
    fn ellipse_row(d: TipSpanNeighbors, profile: &RoundProfile, rim: (Rim, f32), out: Covered) {
        for_each(d, rim.1, out, |p, across, along| ellipse(profile, rim.0, p, across, along));
    }

    fn square_row(d: TipSpanNeighbors, profile: &RoundProfile, rim: (Rim, f32), out: Covered) {
        for_each(d, rim.1, out, |p, across, along| square(profile, rim.0, p, across, along));
    }

    fn fill_peaked_ellipse_row(d: TipSpanNeighbors, profile: &PeakedProfile, rim: (Rim, f32), out: Covered) {
        for_each(d, rim.1, out, |p, across, along| ellipse(profile, rim.0, p, across, along));
    }

    fn fill_peaked_square_row(d: TipSpanNeighbors, profile: &PeakedProfile, rim: (Rim, f32), out: Covered) {
        for_each(d, rim.1, out, |p, across, along| square(profile, rim.0, p, across, along));
    }
}

/// Visits the pixels of a span with J by differences toward linked neighbors. `thin`: the dab's
/// own.
#[inline(always)]
fn for_each(
    d: TipSpanNeighbors,
    thin: f32,
    (coverage, shares): Covered,
    f: impl Fn((f32, f32), (f32, f32), (f32, f32)) -> (f32, f32),
) {
    let n = coverage.len();
    let shares = &mut shares[..n];
    let (cx, cy) = (&d.row.0[..n + 2], &d.row.1[..n + 2]);
    let (ax, ay) = (&d.above.0[..n + 2], &d.above.1[..n + 2]);
    let (bx, by) = (&d.below.0[..n + 2], &d.below.1[..n + 2]);
    let linked = &d.linked[..n];
    let [flat_across, flat_along] = [d.flat.x_axis, d.flat.y_axis];
    for i in 0..n {
        let (x, y) = (cx[i + 1], cy[i + 1]);
        let has = |bit: u8| linked[i] & bit != 0;
        let (l, r, u, d) = (has(links::LEFT), has(links::RIGHT), has(links::UP), has(links::DOWN));
        let across = (
            slope(l, r, cx[i], x, cx[i + 2], flat_across.x),
            slope(l, r, cy[i], y, cy[i + 2], flat_across.y),
        );
        let along = (
            slope(u, d, ax[i + 1], x, bx[i + 1], flat_along.x),
            slope(u, d, ay[i + 1], y, by[i + 1], flat_along.y),
        );
        let (value, share) = f((x, y), across, along);
        // The comparisons turn NaN into 0 and keep rounding errors within the range.
        let value = if value > 0.0 { value } else { 0.0 };
        coverage[i] = thin * if value < share { value } else { share };
        shares[i] = thin * share;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;

    fn dab(radius: f32, rotation_deg: f32, hardness: f32, softness: f32) -> Dab {
        Dab {
            rotation_rad: rotation_deg.to_radians(),
            hardness,
            softness,
            ..Dab::plain(vec2(50.0, 60.0), radius)
        }
    }

    /// Coverage at a point of a flat canvas.
    fn at(shape: TipShape, dab: &Dab, place: Vec2) -> f32 {
        let map = shape.tip_from_canvas(dab);
        let (p, across, along) =
            (map.transform_point2(place), map.matrix2.x_axis, map.matrix2.y_axis);
        let profile = RoundProfile::new(dab.hardness, dab.softness);
        let of = match shape {
            TipShape::Ellipse { .. } => ellipse::<RoundProfile>,
            TipShape::Square { .. } => square::<RoundProfile>,
        };
        of(&profile, Rim::SOFT, (p.x, p.y), (across.x, across.y), (along.x, along.y)).0
    }

    #[test]
    fn the_longer_axis_is_the_diameter_and_turns_counter_clockwise() {
        for shape in [TipShape::Ellipse { ratio: 0.25 }, TipShape::Square { ratio: 0.25 }] {
            let dab = dab(20.0, 90.0, 1.0, 0.0);
            // Upright: 20 px up and down, 5 px to the sides.
            assert!(at(shape, &dab, vec2(50.0, 60.0 - 18.0)) > 0.99);
            assert!(at(shape, &dab, vec2(50.0, 60.0 + 22.0)) < 0.01);
            assert!(at(shape, &dab, vec2(54.0, 60.0)) > 0.99);
            assert!(at(shape, &dab, vec2(57.0, 60.0)) < 0.01);
        }
        let leaning = dab(20.0, 45.0, 1.0, 0.0);
        let ellipse = TipShape::Ellipse { ratio: 0.2 };
        // A turn of 45° counter-clockwise as seen leads up to the right.
        assert!(at(ellipse, &leaning, vec2(60.0, 50.0)) > 0.99);
        assert!(at(ellipse, &leaning, vec2(60.0, 70.0)) < 0.01);
    }

    #[test]
    fn a_round_ellipse_is_the_round_tip_and_a_square_has_its_corners() {
        let dab = dab(12.0, 30.0, 0.4, 0.3);
        let profile = RoundProfile::new(0.4, 0.3);
        for i in 0..40 {
            let place = dab.at + Vec2::from_angle(i as f32) * 0.5 * i as f32;
            let r = (place - dab.at).length() / 12.0;
            let round = profile.mean(r, 1.0 / 144.0);
            assert!(
                (at(TipShape::Ellipse { ratio: 1.0 }, &dab, place) - round).abs() < 1e-3,
                "{place}"
            );
        }
        let upright = self::dab(10.0, 0.0, 1.0, 0.0);
        assert!(at(TipShape::Square { ratio: 1.0 }, &upright, upright.at + 9.0) > 0.99);
        assert!(at(TipShape::Ellipse { ratio: 1.0 }, &upright, upright.at + 9.0) < 0.01);
    }

    #[test]
    fn coverage_adds_up_to_the_tips_area_however_it_is_turned() {
        for (shape, area) in [
            (TipShape::Ellipse { ratio: 0.3 }, std::f32::consts::PI * 16.0 * 16.0 * 0.3),
            (TipShape::Square { ratio: 0.3 }, 32.0 * 32.0 * 0.3),
            // Thinner than a pixel: as much paint, over a pixel's width.
            (TipShape::Ellipse { ratio: 0.02 }, std::f32::consts::PI * 16.0 * 16.0 * 0.02),
        ] {
            for turn in [0.0, 17.0, 45.0, 80.0] {
                let dab = dab(16.0, turn, 1.0, 0.0);
                let pixels =
                    (20..80).flat_map(|x| (30..90).map(move |y| vec2(x as f32, y as f32) + 0.5));
                let sum: f32 =
                    pixels.map(|place| at(shape, &dab, place)).sum::<f32>() * shape.thinness(&dab);
                assert!(
                    (sum / area - 1.0).abs() < if area > 50.0 { 0.04 } else { 0.12 },
                    "{shape:?} turned {turn}: {sum} for {area}"
                );
            }
        }
    }

    #[test]
    fn softness_changes_coverage_without_jumps_and_nothing_lies_beyond_the_extent() {
        for shape in [TipShape::Ellipse { ratio: 0.4 }, TipShape::Square { ratio: 0.4 }] {
            for place in [vec2(50.0, 60.0), vec2(62.0, 62.0), vec2(66.0, 63.0)] {
                let values: Vec<f32> = (0..=100)
                    .map(|i| at(shape, &dab(16.0, 20.0, 0.8, i as f32 / 100.0), place))
                    .collect();
                assert!(
                    values.windows(2).all(|v| (v[1] - v[0]).abs() < 0.04),
                    "{shape:?} at {place}"
                );
            }
            let dab = dab(16.0, 20.0, 0.8, 0.5);
            let DabExtent { radius_px, filter_px } = shape.extent(Falloff::Smooth, &dab);
            let beyond = (0..360).map(|i| {
                dab.at + Vec2::from_angle((i as f32).to_radians()) * (radius_px + filter_px)
            });
            assert!(beyond.map(|place| at(shape, &dab, place)).all(|v| v < 1e-3));
        }
    }
}
