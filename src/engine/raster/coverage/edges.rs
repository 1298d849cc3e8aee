//! Edges of coverage moved, drawn, softened and rounded. Floor 1. Edges run where coverage passes
//! ½; beyond the canvas a selection continues as at the border, so that the border is no edge.

use super::CoverageGrid;
use crate::math::{Range, Rect};
use crate::raster::{Plane, blur, distance};

/// How far an edge can be moved, and how wide a border may be, px.
pub const DISTANCE_PX: Range = 0.0..=distance::FARTHEST as f32 - 2.0;
/// The standard deviation of the blur that softens or rounds an edge, px.
pub const SOFTNESS_PX: Range = 0.0..=500.0;

/// Coverage of marked pixels with their edge moved outward by g: ½ + g − d, clamped, with d how far
/// a pixel's center lies beyond the edge, which runs midway between marked and unmarked pixels: a
/// step across an axis stays sharp, a slanted one is smoothed.
///
/// * `marked`: not 0. Beyond the plane nothing is marked, and nothing ends.
/// * `grow_px`: g, either way; its amount counts up to [`distance::FARTHEST`] − 1.
/// * `antialias`: else pixels are covered wholly or not at all.
pub fn moved(marked: &Plane<u8>, grow_px: f32, antialias: bool) -> Plane<u8> {
    let limit = grow_px.abs().ceil() as u16 + 1;
    let to_inside = distance::squared_distances(marked, limit);
    let to_outside = distance::squared_distances(&marked.map(|p| u8::from(p == 0)), limit);
    let share = |beyond: f32| {
        let share = 0.5 + grow_px - beyond;
        let share =
            if antialias { share.clamp(0.0, 1.0) } else { f32::from(u8::from(share > 0.5)) };
        (share * 255.0).round() as u8
    };
    // A pixel's coverage depends only on its squared distance.
    let farthest = (usize::from(limit.min(distance::FARTHEST)) + 1).pow(2);
    let distances = || (0..=farthest).map(|squared| (squared as f32).sqrt());
    let outside: Vec<u8> = distances().map(|d| share(d - 0.5)).collect();
    let inside: Vec<u8> = distances().map(|d| share(0.5 - d)).collect();
    let to_share = |x: usize, y: usize, marked: u8| match marked {
        0 => outside[usize::from(to_inside.at(x, y)).min(farthest)],
        _ => inside[usize::from(to_outside.at(x, y)).min(farthest)],
    };
    marked.clone().updated(to_share)
}

/// Its edge moved outward (negative: inward), px.
pub fn grown(grid: &CoverageGrid, px: f32, canvas: Rect) -> CoverageGrid {
    let px = px.max(-*DISTANCE_PX.end()).min(*DISTANCE_PX.end());
    let Some((rect, plane)) = padded_coverage(grid, px.abs().ceil() as i32 + 2, canvas) else {
        return CoverageGrid::default();
    };
    let marked = plane.map(|c| u8::from(c >= 128));
    CoverageGrid::from_plane(&moved(&marked, px, true), rect.x0, rect.y0)
}

/// A band of this width about its edge, half of it on each side.
pub fn border(grid: &CoverageGrid, width_px: f32, canvas: Rect) -> CoverageGrid {
    let half = 0.5 * width_px.max(0.0).min(*DISTANCE_PX.end());
    grown(grid, half, canvas).combined(&grown(grid, -half, canvas), u8::saturating_sub)
}

/// Blurred by a Gaussian of this standard deviation, px.
pub fn feathered(grid: &CoverageGrid, sigma_px: f32, canvas: Rect) -> CoverageGrid {
    blurred(grid, sigma_px, canvas, |share| share)
}

/// Its corners rounded: blurred by a Gaussian of this standard deviation σ, and made as steep as an
/// edge again. A straight edge rises by 1 / (σ √2π) a px under the blur, so that times σ √2π it
/// rises within one px.
pub fn smooth(grid: &CoverageGrid, sigma_px: f32, canvas: Rect) -> CoverageGrid {
    let sigma_px = sigma_px.max(0.0).min(*SOFTNESS_PX.end());
    let steep = (sigma_px * std::f32::consts::TAU.sqrt()).max(1.0);
    blurred(grid, sigma_px, canvas, |share| 0.5 + (share - 0.5) * steep)
}

fn blurred(
    grid: &CoverageGrid,
    sigma_px: f32,
    canvas: Rect,
    share: impl Fn(f32) -> f32 + Sync,
) -> CoverageGrid {
    /// This many standard deviations away less than half a 255th is left.
    const REACH: f32 = 3.0;
    let sigma_px = sigma_px.max(0.0).min(*SOFTNESS_PX.end());
    let reach = (REACH * sigma_px).ceil() as i32 + 1;
    let Some((rect, plane)) = padded_coverage(grid, reach, canvas) else {
        return CoverageGrid::default();
    };
    let soft = blur::gaussian(&plane.map(|c| f32::from(c) / 255.0), sigma_px);
    let bytes = soft.map(|v| (share(v).max(0.0).min(1.0) * 255.0).round() as u8);
    CoverageGrid::from_plane(&bytes, rect.x0, rect.y0)
}

/// The covered rectangle with this margin, within the canvas, and its coverage; `None` if it is
/// empty.
fn padded_coverage(grid: &CoverageGrid, reach: i32, canvas: Rect) -> Option<(Rect, Plane<u8>)> {
    let rect = grid.covered_rect().grown(reach).intersect(canvas);
    (!rect.is_empty()).then(|| (rect, grid.to_plane(rect)))
}

#[cfg(test)]
mod tests {
    use super::super::shapes;
    use super::*;
    use crate::math::vec2;

    const CANVAS: Rect = Rect::new(0, 0, 220, 180);

    fn disc(radius: f32) -> CoverageGrid {
        shapes::ellipse(
            vec2(100.0 - radius, 90.0 - radius),
            vec2(100.0 + radius, 90.0 + radius),
            CANVAS,
        )
    }

    /// The radius of the disc of that area.
    fn radius(grid: &CoverageGrid) -> f32 {
        (grid.area_px() / std::f64::consts::PI).sqrt() as f32
    }

    #[test]
    fn a_disc_grown_or_shrunk_is_a_disc_of_that_radius() {
        for by in [-20.0, -3.5, 0.0, 4.0, 17.25, 40.0] {
            let found = radius(&grown(&disc(40.0), by, CANVAS));
            assert!((found - 40.0 - by).abs() < 0.4, "by {by}: {found}");
        }
        assert!(grown(&disc(10.0), -12.0, CANVAS).is_empty());
    }

    #[test]
    fn a_border_is_as_wide_as_said_on_both_sides_of_the_edge() {
        let found = border(&disc(40.0), 6.0, CANVAS);
        // The nearest pixels of a slanted edge stick out a little.
        let width = found.area_px() / (std::f64::consts::TAU * 40.0);
        assert!((width - 6.0).abs() < 0.5, "{width}");
        assert_eq!((found.at(100, 90), found.at(140, 90), found.at(145, 90)), (0, 255, 0));
    }

    #[test]
    fn feathering_keeps_the_edge_at_one_half_and_the_amount() {
        let half = shapes::rectangle(vec2(0.0, 0.0), vec2(100.0, 180.0), CANVAS);
        let soft = feathered(&half, 8.0, CANVAS);
        // Φ(0.5 / 8) and Φ(−8.5 / 8) of the normal distribution.
        assert!((i32::from(soft.at(99, 90)) - 134).abs() <= 1, "{}", soft.at(99, 90));
        assert!((i32::from(soft.at(108, 90)) - 37).abs() <= 1, "{}", soft.at(108, 90));
        assert_eq!((soft.at(0, 0), soft.at(50, 179)), (255, 255), "the canvas's border is no edge");
        let disc = disc(30.0);
        let soft = feathered(&disc, 5.0, CANVAS);
        assert!((soft.area_px() / disc.area_px() - 1.0).abs() < 0.005);
    }

    #[test]
    fn smoothing_rounds_corners_and_leaves_straight_edges() {
        let square = shapes::rectangle(vec2(40.0, 40.0), vec2(120.0, 120.0), CANVAS);
        let round = smooth(&square, 6.0, CANVAS);
        assert_eq!((round.at(40, 80), round.at(39, 80)), (255, 0));
        assert_eq!(round.at(40, 40), 0, "the corner is gone");
        assert_eq!(round.at(48, 48), 255);
    }

    #[test]
    fn all_of_the_canvas_has_no_edge() {
        let all = CoverageGrid::full(CANVAS);
        for changed in
            [grown(&all, -9.0, CANVAS), feathered(&all, 9.0, CANVAS), smooth(&all, 9.0, CANVAS)]
        {
            assert!(changed.is_same(&all));
        }
        assert!(border(&all, 9.0, CANVAS).is_empty());
    }
}
