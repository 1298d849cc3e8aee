//! How wide a strip of the picture each line has for itself: one over the length of its level's
//! lines in an area, so that the width of a line that covers a share of it is known; and how much of
//! it each point has. Floor 2.

use super::{HatchLine, HatchPoint, HatchSettings, TAPER_OF_ROOM};
use crate::math::{Size, Vec2};
use crate::raster::{Plane, blur};
use crate::surface::Surface;

/// The side of a cell in which lengths are summed, px.
const CELL_PX: usize = 2;
/// σ of the mean over an area, in distances of the level, and its least and most, px.
const MEAN: (f32, f32, f32) = (0.9, 3.0, 24.0);

/// Lines with the room of their points.
pub fn measure_room(
    surface: &Surface,
    lines: Vec<(u8, Vec<Vec2>)>,
    settings: &HatchSettings,
) -> Vec<HatchLine> {
    let levels = settings.levels();
    let densities: Vec<PointDensity> = levels
        .iter()
        .enumerate()
        .map(|(i, level)| {
            let own = lines.iter().filter(|(level, _)| usize::from(*level) == i);
            let apart = level.apart * settings.spacing;
            density_of(surface, own.flat_map(|(_, points)| count_points(points, apart)), apart)
        })
        .collect();
    let line = |(level, points): (u8, Vec<Vec2>)| {
        let apart = levels[usize::from(level)].apart * settings.spacing;
        let density = &densities[usize::from(level)];
        let point = |at: Vec2| {
            let per_px = density.at(at).max(1.0 / (4.0 * apart));
            HatchPoint { at, room_px: 1.0 / per_px }
        };
        HatchLine { level, points: points.into_iter().map(point).collect() }
    };
    lines.into_iter().map(line).collect()
}

/// The points of a line, and what each counts: less where it tapers.
fn count_points(points: &[Vec2], apart: f32) -> impl Iterator<Item = (Vec2, f32)> {
    let taper = ((TAPER_OF_ROOM * apart) as usize).min(points.len() / 2);
    let whole = taper..points.len() - taper;
    let counts = move |i: usize| if whole.contains(&i) { 1.0 } else { TAPERED };
    points.iter().enumerate().map(move |(i, at)| (*at, counts(i)))
}

fn cell(v: f32) -> i32 {
    v as i32 / CELL_PX as i32
}

/// What a line covers where it tapers, of what it would cover: the mean of t (2 − t) up to 1.
const TAPERED: f32 = 2.0 / 3.0;

/// How many points there are around a place for each px² of the surface; of lines, that is their
/// length in px, less what they lack where they taper.
pub(super) struct PointDensity(Plane<f32>);

impl PointDensity {
    pub fn at(&self, place: Vec2) -> f32 {
        self.0.at_clamped(cell(place.x), cell(place.y))
    }
}

/// The density of points that lie so far apart.
///
/// * `points`: and what each counts.
pub(super) fn density_of(
    surface: &Surface,
    points: impl Iterator<Item = (Vec2, f32)>,
    apart: f32,
) -> PointDensity {
    let size = surface.size();
    let cells = Size::new(
        size.width.div_ceil(CELL_PX as u32).max(1),
        size.height.div_ceil(CELL_PX as u32).max(1),
    );
    let mut sums = vec![[0.0f32; 2]; cells.area()];
    let index = |x: i32, y: i32| {
        (x.clamp(0, cells.width as i32 - 1)
            + y.clamp(0, cells.height as i32 - 1) * cells.width as i32) as usize
    };
    points.for_each(|(at, counts)| sums[index(cell(at.x), cell(at.y))][0] += counts);
    for y in 0..size.height as usize {
        for (x, covered) in surface.coverage_plane().row(y).iter().enumerate() {
            if *covered > 0 {
                sums[index((x / CELL_PX) as i32, (y / CELL_PX) as i32)][1] += 1.0;
            }
        }
    }
    let sigma = (MEAN.0 * apart).max(MEAN.1).min(MEAN.2) / CELL_PX as f32;
    let mean = blur::gaussian_pixels(cells, &sums, sigma);
    PointDensity(Plane::from_fn(cells, |x, y| {
        let [length, area] = mean[index(x as i32, y as i32)];
        length / area.max(1e-6)
    }))
}
