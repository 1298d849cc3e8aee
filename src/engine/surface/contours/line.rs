//! The straight line by which a contour is described within a pixel's window, and the share of the
//! pixel on its nearer side (MATH 10). Floor 2. Pure functions of a window. Not here: which pixels
//! are looked at (`find`).

use super::plane::LeastSquaresPlane;
use super::window::{PIXELS, PixelWindow, offset_of};
use crate::math::{Vec2, vec2};
use std::sync::LazyLock;

/// A contour near a pixel: a straight line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContourLine {
    /// From the line to the pixel's center, px; positive where the center is on the nearer side.
    pub distance_px: f32,
    /// Unit, image axes: toward the nearer side.
    pub toward_near: Vec2,
}

/// Standard deviations of the windows' Gaussians, px: of the mask's line where it is straight all
/// over the window, and elsewhere.
const STRAIGHT_SIGMA: f32 = 2.0;
const MASK_SIGMA: f32 = 1.2;
/// How far a line may lie on the wrong side of a pixel's center that it should explain, px; what is
/// added by squared distance, since contours bend: so far a circle of 25 px is from its tangent;
/// and within what distance of the middle pixel.
const TOLERANCE_PX: f32 = 0.1;
const BEND_PER_PX: f32 = 0.02;
pub const EXPLAINED_PX: f32 = 2.24;
/// All of the window is nearer than that.
const WINDOW_PX: f32 = 4.3;
/// Cosine of the greatest angle between two lines of one contour.
pub const ALIKE: f32 = 0.7;
/// Fewer pixels give no plane of depths.
const LEAST_FOR_A_LINE: u32 = 6;
/// The share of a straight edge's contrast that a mask must have to be taken for one.
const LEAST_CONTRAST: f32 = 0.5;
/// A Gaussian mean's distance from ½ is taken this many times: a window of 7 px holds 0.92 of a
/// Gaussian of σ = 2 px. The narrow one is whole, but it sees few pixels, and drawn to ½ by as much
/// its line is nearer the truth.
const WITHIN_WINDOW: f32 = 0.92;

impl ContourLine {
    /// The area of the unit pixel on the nearer side, `[0, 1]`: exact (MATH 10).
    pub fn nearer_share(self) -> f32 {
        let (g, d) = (self.toward_near.abs(), self.distance_px);
        let (a, b) = (g.max_element(), g.min_element());
        let s = d.abs().min(0.5 * (a + b));
        // A slanted line cuts off a trapezium, or a triangle once it passes a corner.
        let share = if b < 1e-6 || s <= 0.5 * (a - b) {
            0.5 + s / a.max(1e-9)
        } else {
            1.0 - (0.5 * (a + b) - s).powi(2) / (2.0 * a * b)
        };
        let share = share.clamp(0.0, 1.0);
        if d >= 0.0 { share } else { 1.0 - share }
    }

    /// The same line with its sides exchanged.
    pub fn turned(self) -> Self {
        Self { distance_px: -self.distance_px, toward_near: -self.toward_near }
    }

    /// From the line to a point, px; positive on the nearer side. `from_center`: px.
    #[inline(always)]
    pub fn height(self, from_center: Vec2) -> f32 {
        self.distance_px + self.toward_near.dot(from_center)
    }

    /// The centroid of the unit pixel's area on the nearer side, from the pixel's center, px; the
    /// center where there is no such area.
    pub fn nearer_centroid(self) -> Vec2 {
        let corners = [vec2(-0.5, -0.5), vec2(0.5, -0.5), vec2(0.5, 0.5), vec2(-0.5, 0.5)];
        let mut outline: Vec<Vec2> = Vec::with_capacity(5);
        for (a, b) in std::iter::zip(corners, [corners[1], corners[2], corners[3], corners[0]]) {
            let (from, to) = (self.height(a), self.height(b));
            if from >= 0.0 {
                outline.push(a);
            }
            if (from >= 0.0) != (to >= 0.0) {
                outline.push(a.lerp(b, from / (from - to)));
            }
        }
        // Triangles around the first corner.
        let (mut area, mut moment) = (0.0, Vec2::ZERO);
        for pair in outline.windows(2).skip(1) {
            let twice = (pair[0] - outline[0]).perp_dot(pair[1] - outline[0]);
            (area, moment) =
                (area + twice, moment + twice * (outline[0] + pair[0] + pair[1]) / 3.0);
        }
        if area > 1e-6 { moment / area } else { Vec2::ZERO }
    }

    /// The line that a binary mask of the nearer side gives. Where a line of the wide Gaussian
    /// explains all of the window, as at a straight edge, it is that one: the more pixels, the
    /// finer the line. Where the contour bends, at corners and thin strokes, it is that of the
    /// narrow one. `None` where the mask is no single edge, such as at a thin wire.
    ///
    /// * `near`, `known`: bits of the window: on the nearer side; to be counted at all.
    pub fn of_mask(near: u64, known: u64) -> Option<Self> {
        let narrow = Self::of_moments(near, known, MASK_SIGMA, &MASK_WEIGHTS)?;
        let wide =
            Self::of_moments(near, known, STRAIGHT_SIGMA, &STRAIGHT_WEIGHTS).filter(|wide| {
                let is_alike = wide.toward_near.dot(narrow.toward_near) >= ALIKE;
                is_alike && wide.is_separating(near, known, 0.0, TOLERANCE_PX, WINDOW_PX)
            });
        Some(wide.unwrap_or(narrow))
    }

    /// A Gaussian mean of a step is Φ(d / σ), so that d = σ Φ⁻¹ of it, from the middle of the known
    /// pixels; its direction is that of the first moments.
    ///
    /// * `sigma`: σ of `weights`, px.
    fn of_moments(near: u64, known: u64, sigma: f32, weights: &WindowGaussian) -> Option<Self> {
        let (mut all, mut ones) = (0.0, 0.0);
        let (mut moment, mut shift) = (Vec2::ZERO, Vec2::ZERO);
        for i in bits(known) {
            let w = weights.at(i);
            let at = offset_of(i);
            (all, shift) = (all + w, shift + w * at);
            if near >> i & 1 == 1 {
                (ones, moment) = (ones + w, moment + w * at);
            }
        }
        let mean = (ones / all).clamp(1e-4, 1.0 - 1e-4);
        let gradient = (moment - mean * shift) / all;
        let quantile = normal_quantile(0.5 + WITHIN_WINDOW * (mean - 0.5));
        // A step at this distance has first moments of σ φ(d / σ).
        let expected =
            sigma * (-0.5 * quantile * quantile).exp() / (2.0 * std::f32::consts::PI).sqrt();
        let toward_near =
            gradient.try_normalize().filter(|_| gradient.length() > LEAST_CONTRAST * expected)?;
        Some(Self { distance_px: sigma * quantile - toward_near.dot(shift / all), toward_near })
    }

    /// The line along which two pieces of surface meet at a crease: where planes fitted to their
    /// depths are equally deep. `None` where it contradicts which pixels show which: coarse depth
    /// does not show it.
    ///
    /// * `own`, `other`: bits of the window; the nearer side of the line is `own`.
    pub fn of_depths(window: &PixelWindow, own: u64, other: u64) -> Option<Self> {
        let fit = |members: u64| {
            let is_plane = members.count_ones() >= LEAST_FOR_A_LINE;
            let depth = |i: u32| (CONTINUED_WEIGHTS.at(i), window.depth(i));
            is_plane.then(|| LeastSquaresPlane::fit_weighted(bits(members), 1e-9, depth)).flatten()
        };
        let (own_fit, other_fit) = (fit(own)?, fit(other)?);
        let (here, slope) = (own_fit.here - other_fit.here, own_fit.slope - other_fit.slope);
        let steepness = slope.length();
        if steepness < 1e-7 {
            return None;
        }
        let line = Self { distance_px: here / steepness, toward_near: slope / steepness };
        [line, line.turned()]
            .into_iter()
            .find(|line| line.is_separating(own, own | other, 0.0, TOLERANCE_PX, EXPLAINED_PX))
    }

    /// The line along which two pieces of surface meet at a crease that depth does not show, from
    /// how steeply they lie: along it both are equally high, so that it is perpendicular to the
    /// difference of their slopes. It passes midway between the pixels of both that lie nearest to
    /// it. `None` where they lie on no two sides of such a line.
    ///
    /// * `own`, `other`: bits of the window; the nearer side of the line is `own`.
    /// * `slopes`: of both at the middle pixel, px of depth per px, image axes.
    pub fn of_slopes(own: u64, other: u64, slopes: [Vec2; 2]) -> Option<Self> {
        let across = (slopes[0] - slopes[1]).try_normalize()?;
        let between = |toward_near: Vec2, reach_px: f32| {
            let height = |i: u32| toward_near.dot(offset_of(i));
            let within = |members: u64| {
                bits(members).filter(|&i| offset_of(i).length() <= reach_px).map(height)
            };
            let nearest = within(own).fold(f32::MAX, f32::min);
            let farthest = within(other).fold(-f32::MAX, f32::max);
            let line = Self { distance_px: -0.5 * (nearest + farthest), toward_near };
            let is_known = nearest < f32::MAX && farthest > -f32::MAX;
            (is_known && farthest - nearest <= 2.0 * TOLERANCE_PX).then_some(line)
        };
        let reaches = [WINDOW_PX, EXPLAINED_PX].into_iter();
        reaches
            .flat_map(|reach| [(across, reach), (-across, reach)])
            .find_map(|(v, r)| between(v, r))
    }

    /// Pixels within `reach_px` of the middle one lie on their side of the line, but for a little.
    ///
    /// * `bend`: the contour's curvature, as far as it is known, per px.
    pub fn is_separating(
        &self,
        near: u64,
        known: u64,
        bend: f32,
        tolerance_px: f32,
        reach_px: f32,
    ) -> bool {
        bits(known).all(|i| {
            let at = offset_of(i);
            let d = self.distance_to(at, bend);
            let away = at.length();
            let tolerance = tolerance_px + BEND_PER_PX * away * away;
            away > reach_px || if near >> i & 1 == 1 { d } else { -d } >= -tolerance
        })
    }

    /// The component along the line.
    #[inline(always)]
    pub fn component_along(self, v: Vec2) -> f32 {
        v.dot(self.toward_near.perp())
    }

    /// The distance of a place from the line, or from a circle that touches it next to the pixel's
    /// center, px; positive on the nearer side.
    ///
    /// * `place`: from the pixel's center, px.
    /// * `bend`: the circle's curvature, per px; positive where the nearer side is inside.
    #[inline(always)]
    pub fn distance_to(self, place: Vec2, bend: f32) -> f32 {
        let (across, along) = (self.height(place), self.component_along(place));
        let from_middle = vec2(1.0 - bend * across, bend * along).length();
        (2.0 * across - bend * (across * across + along * along)) / (1.0 + from_middle)
    }

    /// The place with that distance from the line itself: moved across it.
    #[inline(always)]
    pub fn straightened(self, place: Vec2, bend: f32) -> Vec2 {
        place + (self.distance_to(place, bend) - self.height(place)) * self.toward_near
    }

    /// The same line, moved so far that the middle pixel's center lies on the side that it was seen
    /// on.
    pub fn with_center(self, is_near: bool) -> Self {
        let d = self.distance_px;
        Self { distance_px: if is_near { d.max(0.0) } else { d.min(0.0) }, ..self }
    }
}

/// The numbers of the bits that are set, the lowest first.
pub fn bits(mut set: u64) -> impl Iterator<Item = u32> {
    std::iter::from_fn(move || {
        let i = (set != 0).then(|| set.trailing_zeros())?;
        set &= set - 1;
        Some(i)
    })
}

/// Φ⁻¹: the quantile of the standard normal distribution, within 4.5e-4 (Abramowitz and Stegun
/// 1964, 26.2.23). `p`: in (0, 1).
fn normal_quantile(p: f32) -> f32 {
    let tail = p.min(1.0 - p).max(f32::MIN_POSITIVE);
    let t = (-2.0 * tail.ln()).sqrt();
    let above = 2.515_517 + t * (0.802_853 + t * 0.010_328);
    let below = 1.0 + t * (1.432_788 + t * (0.189_269 + t * 0.001_308));
    let z = t - above / below;
    if p < 0.5 { -z } else { z }
}

/// A Gaussian over the window's pixels.
pub struct WindowGaussian(LazyLock<[f32; PIXELS]>);

impl WindowGaussian {
    /// The weight of a pixel of the window.
    #[inline(always)]
    pub fn at(&self, i: u32) -> f32 {
        self.0[i as usize]
    }
}

fn gaussian(sigma: f32) -> [f32; PIXELS] {
    std::array::from_fn(|i| (-offset_of(i as u32).length_squared() / (2.0 * sigma * sigma)).exp())
}

static STRAIGHT_WEIGHTS: WindowGaussian =
    WindowGaussian(LazyLock::new(|| gaussian(STRAIGHT_SIGMA)));
static MASK_WEIGHTS: WindowGaussian = WindowGaussian(LazyLock::new(|| gaussian(MASK_SIGMA)));
/// For maps that are continued as planes.
pub static CONTINUED_WEIGHTS: WindowGaussian = WindowGaussian(LazyLock::new(|| gaussian(1.2)));
/// For what is carried over from the nearest pixels, and for normals that turn toward a rim.
pub static NEAREST_WEIGHTS: WindowGaussian = WindowGaussian(LazyLock::new(|| gaussian(1.0)));

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::contours::window::ALL;

    /// The share of 64 × 64 points of a pixel on the nearer side.
    fn counted(line: ContourLine) -> f32 {
        let at = |i: u32| (i as f32 + 0.5) / 64.0 - 0.5;
        let is_near =
            |i: u32| line.distance_px + line.toward_near.dot(vec2(at(i % 64), at(i / 64))) > 0.0;
        (0..4096).filter(|&i| is_near(i)).count() as f32 / 4096.0
    }

    #[test]
    fn the_share_is_the_area_on_the_nearer_side() {
        for turn in 0..24 {
            let toward_near = Vec2::from_angle(turn as f32 * 0.27);
            for d in [-0.8, -0.5, -0.31, -0.1, 0.0, 0.07, 0.4, 0.6, 0.75] {
                let line = ContourLine { distance_px: d, toward_near };
                let (share, counted) = (line.nearer_share(), counted(line));
                assert!((share - counted).abs() < 0.012, "{line:?}: {share}, counted {counted}");
            }
        }
    }

    #[test]
    fn a_straight_edge_is_found_again_in_its_binary_mask() {
        let (mut sum, mut count) = (0.0, 0.0);
        for turn in 0..40 {
            let toward_near = Vec2::from_angle(turn as f32 * 0.157);
            for step in 0..10 {
                let true_line = ContourLine { distance_px: step as f32 * 0.05 + 0.02, toward_near };
                let near = (0..49)
                    .filter(|&i| true_line.distance_px + toward_near.dot(offset_of(i)) >= 0.0);
                let near = near.fold(0, |set, i| set | 1 << i);
                let found = ContourLine::of_mask(near, ALL).unwrap();
                assert!(found.toward_near.dot(toward_near) > 0.93, "{found:?} for {true_line:?}");
                sum += (found.with_center(true).nearer_share() - true_line.nearer_share()).abs();
                count += 1.0;
            }
        }
        // Without the line the error is 0.25; a binary mask says nothing about an edge along the
        // pixels.
        assert!(sum / count < 0.1, "{}", sum / count);
    }

    #[test]
    fn a_line_of_the_whole_window_is_taken_for_straight_edges_alone() {
        let of = |is_near: &dyn Fn(Vec2) -> bool| {
            (0..49).filter(|&i| is_near(offset_of(i))).fold(0, |set, i| set | 1 << i)
        };
        let is_narrow = |near: u64| {
            ContourLine::of_mask(near, ALL)
                == ContourLine::of_moments(near, ALL, MASK_SIGMA, &MASK_WEIGHTS)
        };
        let toward = Vec2::from_angle(0.3);
        assert!(!is_narrow(of(&|at| toward.dot(at) > -0.2)), "an edge");
        assert!(is_narrow(of(&|at| (-0.2..2.8).contains(&toward.dot(at)))), "a stroke of 3 px");
        assert!(is_narrow(of(&|at| at.x > -0.5 && at.y > -0.5)), "a corner");
    }

    #[test]
    fn a_wire_is_no_edge() {
        let column = |x: u32| (0..7).fold(0u64, |set, y| set | 1 << (y * 7 + x));
        assert!(ContourLine::of_mask(column(3), ALL).is_none());
        assert!(ContourLine::of_mask(column(3) | column(4) | column(5) | column(6), ALL).is_some());
    }

    #[test]
    fn quantiles_are_those_of_the_table() {
        for (p, z) in [(0.5, 0.0), (0.841_345, 1.0), (0.022_750, -2.0), (0.999, 3.090_232)] {
            assert!((normal_quantile(p) - z).abs() < 5e-4, "{p}: {}", normal_quantile(p));
        }
    }

    #[test]
    fn slopes_of_both_sides_of_a_crease_give_its_line() {
        for turn in 0..60 {
            let (v, d) = (Vec2::from_angle(turn as f32 * 0.21), 0.5 - turn as f32 / 60.0);
            let line = ContourLine { distance_px: d.max(0.0), toward_near: v };
            let own =
                bits(ALL).filter(|&i| line.height(offset_of(i)) >= 0.0).fold(0, |a, i| a | 1 << i);
            // Whatever both have in common does not matter.
            let slopes = [vec2(0.2, -0.1) + 0.7 * v, vec2(0.2, -0.1) - 0.4 * v];
            for slopes in [slopes, [slopes[1], slopes[0]]] {
                let found = ContourLine::of_slopes(own, ALL & !own, slopes).unwrap();
                assert!((found.toward_near - v).length() < 1e-5, "{found:?} for {line:?}");
                let off = (found.nearer_share() - line.nearer_share()).abs();
                assert!(off < 0.26, "{found:?} for {line:?}");
            }
            assert!(ContourLine::of_slopes(own, ALL & !own, [vec2(0.1, 0.3); 2]).is_none());
        }
    }
}
