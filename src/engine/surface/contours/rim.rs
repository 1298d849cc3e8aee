//! The line of a contour that normals give: where those of the nearer piece turn away from the viewer (MATH 10).
//! Floor 2. Pure functions of a window.

use super::line::{ALIKE, ContourLine, EXPLAINED_PX, NEAREST_WEIGHTS, bits};
use super::plane::LeastSquaresPlane;
use super::window::{PixelWindow, SIDE, offset_of};
use crate::math::{Vec2, vec2};

/// Beyond this n_z² a pixel says little about where n_z² reaches 0.
const RIM_NZ_SQUARED: f32 = 0.25;
/// Fewer pixels do not tell how normals turn.
const LEAST_PIXELS: u32 = 4;
/// Steps toward the rim from the foot of the pixel's centre on a line, and how often that line is taken anew.
const STEPS: usize = 3;
/// Where |∇n_z²|² is below this, per px², there is no rim nearby.
const LEVEL: f32 = 1e-10;
/// How far the line may lie on the wrong side of a pixel's centre, px, and from the mask's own line.
const TOLERANCE_PX: f32 = 0.05;
const FARTHEST_PX: f32 = 0.7;
/// The share of the variance of n_z² that normals which turn evenly must explain.
const LEAST_EXPLAINED: f32 = 0.99;

impl ContourLine {
    /// The line that the nearer side's normals give: at a smooth silhouette they turn away from the viewer, n_z = 0.
    /// `None` where it contradicts the mask, or where normals do not turn evenly: scanned and coarse meshes have
    /// interpolated ones that never reach the rim.
    ///
    /// * `guess`: the mask's own line.
    pub fn of_normals(window: &PixelWindow, near: u64, known: u64, guess: ContourLine) -> Option<Self> {
        let turning = TurningNormals::fitted(window, near)?;
        let line = turning.rim(guess)?;
        let in_reach = (-1.2..1.5).contains(&line.distance_px) && line.toward_near.dot(guess.toward_near) >= ALIKE;
        if !in_reach || !line.explains(near, known, TOLERANCE_PX, EXPLAINED_PX) {
            return None;
        }
        if turning.explained(window, near) < LEAST_EXPLAINED {
            return None;
        }
        let distance_px = line.distance_px.clamp(guess.distance_px - FARTHEST_PX, guess.distance_px + FARTHEST_PX);
        Some(Self { distance_px, ..line })
    }
}

/// Planes fitted to both components of n̄: exact on spheres and cylinders of any radius, where n_z² itself is curved.
struct TurningNormals {
    x: LeastSquaresPlane,
    y: LeastSquaresPlane,
    /// How much each pixel of the window says about the rim.
    weights: [f32; (SIDE * SIDE) as usize],
}

impl TurningNormals {
    /// `members`: the pixels of one piece of surface.
    fn fitted(window: &PixelWindow, members: u64) -> Option<Self> {
        if members.count_ones() < LEAST_PIXELS {
            return None;
        }
        let mut weights = [0.0; _];
        for i in bits(members) {
            weights[i as usize] = NEAREST_WEIGHTS.at(i) * (-window.nz_squared(i) / RIM_NZ_SQUARED).exp();
        }
        let fit = |component: fn(Vec2) -> f32| {
            let weight_and_value = |i: u32| (weights[i as usize], component(window.nbar(i)));
            LeastSquaresPlane::weighted(bits(members), 1e-9, weight_and_value)
        };
        Some(Self { x: fit(|n| n.x)?, y: fit(|n| n.y)?, weights })
    }
    /// `at`: from the middle pixel's centre, px.
    fn nbar(&self, at: Vec2) -> Vec2 {
        vec2(self.x.here + self.x.slope.dot(at), self.y.here + self.y.slope.dot(at))
    }
    /// 1 − |n̄|²: negative beyond the rim.
    fn nz_squared(&self, at: Vec2) -> f32 {
        1.0 - self.nbar(at).length_squared()
    }
    /// Its gradient, per px, image axes.
    fn slope(&self, at: Vec2) -> Vec2 {
        let n = self.nbar(at);
        -2.0 * (n.x * self.x.slope + n.y * self.y.slope)
    }
    /// The tangent of the rim, n_z² = 0, next to the middle pixel's centre; `None` if there is none nearby.
    ///
    /// * `guess`: a line near it.
    fn rim(&self, guess: ContourLine) -> Option<ContourLine> {
        (0..STEPS).try_fold(guess, |line, _| {
            let foot = -line.distance_px * line.toward_near;
            let at = (0..STEPS).try_fold(foot, |at, _| {
                let slope = self.slope(at);
                let steepness = slope.length_squared();
                (steepness >= LEVEL).then(|| at - self.nz_squared(at) / steepness * slope)
            })?;
            let toward_near = self.slope(at).try_normalize()?;
            Some(ContourLine { distance_px: -at.dot(toward_near), toward_near })
        })
    }
    /// The share of the variance of the maps' n_z² that the planes explain.
    fn explained(&self, window: &PixelWindow, members: u64) -> f32 {
        let here = self.nz_squared(Vec2::ZERO);
        let (mut all, mut sum, mut squares, mut left) = (0.0, 0.0, 0.0, 0.0);
        for i in bits(members) {
            // From the value at the middle pixel: sums of differences lose fewer digits.
            let (w, v) = (self.weights[i as usize], window.nz_squared(i) - here);
            let error = v - (self.nz_squared(offset_of(i)) - here);
            (all, sum, squares) = (all + w, sum + w * v, squares + w * v * v);
            left += w * error * error;
        }
        let variance = squares - sum * sum / all;
        if variance > 0.0 { 1.0 - left / variance } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Size;
    use crate::raster::Plane;
    use crate::surface::contours::maps::ContourMaps;
    use crate::surface::contours::window::{ALL, REACH};

    const SIZE: Size = Size::new(SIDE as u32, SIDE as u32);

    /// The line that normals give of the pixels that are covered.
    fn line_of(nbar: [Plane<f32>; 2], is_covered: impl Fn(usize, usize) -> bool + Sync) -> Option<ContourLine> {
        let coverage = Plane::from_fn(SIZE, |x, y| if is_covered(x, y) { 255 } else { 0 });
        let (depth, links) = (Plane::filled(SIZE, 0.5), Plane::filled(SIZE, 0));
        let maps = ContourMaps {
            size: SIZE,
            nbar: [&nbar[0], &nbar[1]],
            depth: &depth,
            coverage: &coverage,
            links: &links,
            all_links: &links,
            valid: None,
        };
        let window = PixelWindow::around(&maps, REACH, REACH);
        let guess = ContourLine::of_mask(window.covered, ALL)?;
        ContourLine::of_normals(&window, window.covered, ALL, guess)
    }
    /// That of a cylinder with `rim`, whose other rim is beyond its axis.
    fn of_cylinder(rim: ContourLine, radius: f32) -> Option<ContourLine> {
        // From the axis, in radii; −1 and 1 are the rims.
        let across = |x: usize, y: usize| {
            let at = vec2(x as f32, y as f32) - REACH as f32;
            (rim.distance_px + rim.toward_near.dot(at)) / radius - 1.0
        };
        let nbar = rim.toward_near.to_array().map(|along| Plane::from_fn(SIZE, |x, y| across(x, y) * along));
        line_of(nbar, |x, y| across(x, y).abs() < 1.0)
    }
    #[test]
    fn the_rim_of_a_limb_is_found_however_thin_it_is() {
        for (turn, radius) in (0..24).flat_map(|turn| [3.0, 4.0, 8.0, 40.0].map(|radius| (turn, radius))) {
            for step in 0..9 {
                let toward_near = Vec2::from_angle(turn as f32 * 0.27);
                let rim = ContourLine { distance_px: step as f32 * 0.1 - 0.4, toward_near };
                let line = of_cylinder(rim, radius).unwrap_or_else(|| panic!("{rim:?}, radius {radius}"));
                let error = (line.near_share() - rim.near_share()).abs();
                assert!(error < 2e-3, "{line:?} for {rim:?}, radius {radius}: {error}");
            }
        }
    }
    #[test]
    fn normals_that_never_turn_away_give_no_line() {
        let level = || Plane::filled(SIZE, 0.3);
        assert_eq!(line_of([level(), level()], |x, _| x > 2), None);
    }
}
