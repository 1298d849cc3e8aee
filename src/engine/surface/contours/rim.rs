//! The line of a contour that normals give: where those of the nearer piece turn away from the
//! viewer (MATH 10). Floor 2. Pure functions of a window.

use super::line::{ALIKE, ContourLine, EXPLAINED_PX, NEAREST_WEIGHTS, bits};
use super::window::{PIXELS, PixelWindow, offset_of};
use crate::math::{DVec2, Vec2};

/// Beyond this n_z² a pixel says little about where n_z² reaches 0.
const RIM_NZ_SQUARED: f32 = 0.25;
/// Fewer pixels do not tell how normals turn, or how that changes toward the rim.
const LEAST_PIXELS: usize = 4;
const LEAST_PIXELS_FOR_CHANGE: usize = 7;
/// How often the line is found anew from where it was.
const PASSES: usize = 3;
/// The sharpest bend of a rim that is believed, per px.
const SHARPEST_BEND: f32 = 0.3;
/// Added to the squares of places along the rim, px²: next to nothing, but where they are all the
/// same.
const PLACES_RIDGE: f32 = 1e-4;
/// Added to the sums that are divided by: next to nothing, but where all pixels lie in a row.
const PIVOT_RIDGE: f64 = 1e-9;
/// The variance of β that is expected: round bodies have β = 0.
const CHANGE_VARIANCE: f64 = 10.0;
/// The sum of squares that rounding alone may leave of f.
const LEAST_NOISE: f64 = 1e-8;
/// The rim is farther off than is looked, px; or normals do not turn, per px.
const OUT_OF_REACH_PX: f32 = 2.0;
const LEVEL: f64 = 1e-5;
/// How far the line may lie on the wrong side of a pixel's center, px, and from the mask's own
/// line.
const TOLERANCE_PX: f32 = 0.05;
const FARTHEST_PX: f32 = 0.7;
/// The share of the variance of how far normals turn that the distance from the rim must explain.
const LEAST_EXPLAINED: f32 = 0.985;

impl ContourLine {
    /// The line that the nearer side's normals give: at a smooth silhouette they turn away from the
    /// viewer, n_z = 0. `None` where it contradicts the mask, or where normals do not turn evenly:
    /// scanned and coarse meshes have interpolated ones that never reach the rim.
    ///
    /// * `guess`: the mask's own line.
    pub fn of_normals(
        window: &PixelWindow,
        near: u64,
        known: u64,
        guess: ContourLine,
    ) -> Option<Self> {
        let normals = PieceNormals::fit_normals(window, near, guess);
        if normals.count < LEAST_PIXELS {
            return None;
        }
        let start = FittedRim { line: guess, bend: 0.0, explained: 0.0 };
        let FittedRim { line, bend, explained } =
            (0..PASSES).try_fold(start, |fitted, _| normals.rim(fitted.line))?;
        let in_reach = (-1.2..1.5).contains(&line.distance_px)
            && line.toward_near.dot(guess.toward_near) >= ALIKE;
        let agrees = in_reach && line.is_separating(near, known, bend, TOLERANCE_PX, EXPLAINED_PX);
        if !agrees || explained < LEAST_EXPLAINED {
            return None;
        }
        let distance_px = line
            .distance_px
            .clamp(guess.distance_px - FARTHEST_PX, guess.distance_px + FARTHEST_PX);
        Some(Self { distance_px, ..line })
    }
}

/// The tangent of the rim next to a pixel's center, its curvature per px, and the share of the
/// variance of f that the distance from the rim explains.
struct FittedRim {
    line: ContourLine,
    bend: f32,
    explained: f32,
}

/// A rim near its tangent.
struct RimShape {
    /// The slope of the surface along it, toward or away from the viewer.
    tilt: f32,
    /// Its curvature, per px; positive where the surface lies within the bend.
    bend: f32,
}

/// The normals of one piece of surface in a window, up to where they turn toward another rim.
struct PieceNormals {
    pixels: [PiecePixel; PIXELS],
    count: usize,
}

#[derive(Clone, Copy, Default)]
struct PiecePixel {
    /// From the middle pixel's center, px.
    place: Vec2,
    /// How much it says about the rim.
    weight: f32,
    nbar: Vec2,
    nz_squared: f32,
}

impl PieceNormals {
    /// `near`: the pixels of the piece. `line`: one near the rim.
    fn fit_normals(window: &PixelWindow, near: u64, line: ContourLine) -> Self {
        let mut normals = Self { pixels: [PiecePixel::default(); PIXELS], count: 0 };
        for i in bits(near).filter(|&i| window.nbar(i).dot(line.toward_near) <= 0.0) {
            let nz_squared = window.nz_squared(i);
            let weight = NEAREST_WEIGHTS.at(i) * (-nz_squared / RIM_NZ_SQUARED).exp();
            normals.pixels[normals.count] =
                PiecePixel { place: offset_of(i), weight, nbar: window.nbar(i), nz_squared };
            normals.count += 1;
        }
        normals
    }

    fn pixels(&self) -> &[PiecePixel] {
        &self.pixels[..self.count]
    }

    /// Along a rim, n̄ turns with its bend, and off it with its tilt: n̄·v = tilt · n_z + bend · s,
    /// by least squares.
    fn shape(&self, line: ContourLine) -> RimShape {
        let (mut zz, mut zs, mut ss, mut zn, mut sn) = (0.0, 0.0, PLACES_RIDGE, 0.0, 0.0);
        for pixel in self.pixels() {
            let (w, z) = (pixel.weight, pixel.nz_squared.sqrt());
            let (n, s) = (line.component_along(pixel.nbar), line.component_along(pixel.place));
            (zz, zs, ss) = (zz + w * z * z, zs + w * z * s, ss + w * s * s);
            (zn, sn) = (zn + w * z * n, sn + w * s * n);
        }
        let determinant = (zz * ss - zs * zs).max(f32::MIN_POSITIVE);
        let bend = (zz * sn - zs * zn) / determinant;
        RimShape {
            tilt: (ss * zn - zs * sn) / determinant,
            bend: bend.clamp(-SHARPEST_BEND, SHARPEST_BEND),
        }
    }

    /// The rim, from a line near it. On spheres, and on cylinders however they are tilted, the
    /// normals' turn f = 1 − √(1 − (1 + tilt²) n_z²) grows evenly with the distance from the rim.
    fn rim(&self, near_it: ContourLine) -> Option<FittedRim> {
        let RimShape { tilt, bend } = self.shape(near_it);
        let mut turns = TurnSums::default();
        add_turns(self.pixels(), near_it, (tilt, bend), &mut turns);
        let (line, explained) = turns.rim(self.count >= LEAST_PIXELS_FOR_CHANGE)?;
        (line.distance_px.abs() < OUT_OF_REACH_PX).then_some(FittedRim { line, bend, explained })
    }
}

crate::widest! {
    /// Adds the turns of pixels, from a line near their rim.
    ///
    /// * `shape`: tilt and bend of the rim.
    fn add_turns(
        pixels: &[PiecePixel],
        near_it: ContourLine,
        shape: (f32, f32),
        turns: &mut TurnSums
    ) {
        let (tilt, bend) = shape;
        for pixel in pixels {
            // What n_z² is wrong by is divided by the cosine in f.
            let cosine_squared = (1.0 - (1.0 + tilt * tilt) * pixel.nz_squared).max(0.0);
            let place = near_it.straightened(pixel.place, bend);
            turns.add(pixel.weight * cosine_squared, place, 1.0 - cosine_squared.sqrt());
        }
    }
}

/// Weighted sums over pixels of 1, x, y, f, f², x², xy, xf, xf², y², yf, yf², f², f³ and f⁴: f is
/// how far their normals have turned from those of the rim, and (x, y) are places at which the rim
/// is straight.
#[derive(Default)]
struct TurnSums([f64; 15]);

impl TurnSums {
    #[inline(always)]
    fn add(&mut self, weight: f32, place: Vec2, f: f32) {
        let (w, x, y, f) =
            (f64::from(weight), f64::from(place.x), f64::from(place.y), f64::from(f));
        let g = f * f;
        let products =
            [1.0, x, y, f, g, x * x, x * y, x * f, x * g, y * y, y * f, y * g, f * f, f * g, g * g];
        for (sum, product) in self.0.iter_mut().zip(&products) {
            *sum += w * product;
        }
    }

    /// Where f = 0, of f = α d + β f² by least squares, and the share of the variance of f that it
    /// explains. d is the distance from the rim, β how its roundness changes.
    ///
    /// * `changes`: there are enough pixels to tell β.
    fn rim(self, changes: bool) -> Option<(ContourLine, f32)> {
        let [n, x, y, f, g, xx, xy, xf, xg, yy, yf, yg, ff, fg, gg] = self.0;
        let mut sums = [
            [n, x, y, f, g],
            [x, xx, xy, xf, xg],
            [y, xy, yy, yf, yg],
            [f, xf, yf, ff, fg],
            [g, xg, yg, fg, gg],
        ];
        let mut variance = 0.0;
        // What 1, x and y explain is taken from f and f² (Frisch and Waugh 1933).
        for k in 0..3 {
            let pivot = sums[k];
            if pivot[k] + PIVOT_RIDGE <= 0.0 {
                return None;
            }
            for row in k + 1..5 {
                let factor = pivot[row] / (pivot[k] + PIVOT_RIDGE);
                for (sum, of_pivot) in sums[row].iter_mut().zip(&pivot) {
                    *sum -= factor * of_pivot;
                }
            }
            variance = if k == 0 { sums[3][3] } else { variance };
        }
        let [.., [.., ff, fg], [.., gg]] = sums;
        let noise = (ff - fg * fg / gg.max(LEAST_NOISE)).max(LEAST_NOISE);
        // β, drawn to 0 as far as noise may have made it.
        let change =
            if changes && gg > LEAST_NOISE { fg / (gg + noise / CHANGE_VARIANCE) } else { 0.0 };
        let left = ff - 2.0 * change * fg + change * change * gg;
        let value = |k: usize| sums[k][3] - change * sums[k][4];
        let along_y = value(2) / (sums[2][2] + PIVOT_RIDGE);
        let along_x = (value(1) - sums[1][2] * along_y) / (sums[1][1] + PIVOT_RIDGE);
        let here =
            (value(0) - sums[0][1] * along_x - sums[0][2] * along_y) / (sums[0][0] + PIVOT_RIDGE);
        let steepness = along_x.hypot(along_y);
        if steepness < LEVEL {
            return None;
        }
        let toward_near = DVec2::new(along_x, along_y) / steepness;
        let line = ContourLine {
            distance_px: (here / steepness) as f32,
            toward_near: toward_near.as_vec2(),
        };
        Some((line, if variance > 0.0 { 1.0 - left / variance } else { 0.0 } as f32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, vec2};
    use crate::raster::Plane;
    use crate::surface::contours::maps::ContourMaps;
    use crate::surface::contours::window::{ALL, REACH, SIDE};

    const SIZE: Size = Size::new(SIDE as u32, SIDE as u32);

    /// The line that normals give of the pixels that are covered.
    fn line_of(
        nbar: [Plane<f32>; 2],
        is_covered: impl Fn(usize, usize) -> bool + Sync,
    ) -> Option<ContourLine> {
        let coverage = Plane::from_fn(SIZE, |x, y| if is_covered(x, y) { 255 } else { 0 });
        let (depth, links) = (Plane::full(SIZE, 0.5), Plane::full(SIZE, 0));
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

    /// The line that the normals of a cylinder give. `tilt`: that of its axis out of the picture
    /// plane.
    ///
    /// * `rim`: one of its two; the other one is beyond its axis.
    fn of_cylinder(rim: ContourLine, radius: f32, tilt: f32) -> Option<ContourLine> {
        // From the axis, in radii; −1 and 1 are the rims.
        let across = |x: usize, y: usize| {
            let at = vec2(x as f32, y as f32) - REACH as f32;
            (rim.distance_px + rim.toward_near.dot(at)) / radius - 1.0
        };
        let nbar = |x: usize, y: usize| {
            let across = across(x, y);
            let rest = (1.0 - across * across).max(0.0).sqrt();
            across * rim.toward_near + rest * tilt.sin() * rim.toward_near.perp()
        };
        let planes = [0, 1].map(|axis| Plane::from_fn(SIZE, |x, y| nbar(x, y)[axis]));
        line_of(planes, |x, y| across(x, y).abs() < 1.0)
    }

    /// The line that the normals of a ball give whose middle lies beyond `rim`.
    fn of_ball(rim: ContourLine, radius: f32) -> Option<ContourLine> {
        let middle = (radius - rim.distance_px) * rim.toward_near;
        let nbar = |x: usize, y: usize| (vec2(x as f32, y as f32) - REACH as f32 - middle) / radius;
        let planes = [0, 1].map(|axis| Plane::from_fn(SIZE, |x, y| nbar(x, y)[axis]));
        line_of(planes, |x, y| nbar(x, y).length() < 1.0)
    }

    /// Rims of many directions, on either side of the middle pixel's center.
    fn rims() -> impl Iterator<Item = ContourLine> {
        (0..24).flat_map(|turn| {
            let toward_near = Vec2::from_angle(turn as f32 * 0.27);
            (0..9)
                .map(move |step| ContourLine { distance_px: step as f32 * 0.1 - 0.4, toward_near })
        })
    }

    fn assert_is(line: Option<ContourLine>, rim: ContourLine, most: f32, what: &str) {
        let line = line.unwrap_or_else(|| panic!("{rim:?}, {what}"));
        let error = (line.nearer_share() - rim.nearer_share()).abs();
        assert!(error < most, "{line:?} for {rim:?}, {what}: {error}");
    }

    #[test]
    fn the_rim_of_a_limb_is_found_however_thin_and_tilted_it_is() {
        for rim in rims() {
            for (radius, tilt) in
                [3.0, 4.0, 8.0, 40.0].into_iter().flat_map(|r| [0.0, -0.7, 1.2].map(|t| (r, t)))
            {
                assert_is(
                    of_cylinder(rim, radius, tilt),
                    rim,
                    0.01,
                    &format!("radius {radius}, tilt {tilt}"),
                );
            }
        }
    }

    #[test]
    fn the_rim_of_a_ball_is_found_however_small_it_is() {
        for (rim, radius) in rims().flat_map(|rim| [4.0, 8.0, 40.0].map(|radius| (rim, radius))) {
            assert_is(of_ball(rim, radius), rim, 0.02, &format!("radius {radius}"));
        }
    }

    #[test]
    fn normals_that_never_turn_away_give_no_line() {
        let level = || Plane::full(SIZE, 0.3);
        assert_eq!(line_of([level(), level()], |x, _| x > 2), None);
    }
}
