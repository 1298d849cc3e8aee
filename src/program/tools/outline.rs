//! Outlines: of the next dab, bent by the surface, as the brush's cursor, and of a stroke. Floor 5.
//! The curve on which D(q) is one radius from the anchor, or on which paint begins, found on a
//! grid.

use crate::document::Document;
use crate::math::{Rect, Vec2, vec2};
use crate::paint::{Scene, Stroke};
use crate::surface::support::{DabExtent, SupportBounds};
use crate::surface::{DabReach, Deformation, Operator};
use std::sync::Arc;

/// Cells along the longer side of the grid: fine enough for a cursor, and fast enough for every
/// frame.
const CELLS: i32 = 72;

/// The outline of a dab of `radius_px` at `at` that lands within `reach_px` (0: anywhere), as pairs
/// of points to be joined by lines; canvas px.
pub fn outline(
    document: &Document,
    operator: Operator,
    at: Vec2,
    radius_px: f32,
    reach_px: f32,
) -> Vec<[Vec2; 2]> {
    let surface = document.surface.as_deref();
    let reach = DabReach::new(at, reach_px, 2.0 * radius_px);
    let deformation = Deformation::of_dab(surface, document.size, operator, at).within(reach);
    if deformation.is_identity() || !at.is_finite() {
        return circle(at, radius_px);
    }
    let extent = DabExtent { radius_px, filter_px: 0.0 };
    let mut touched = Rect::EMPTY;
    SupportBounds::new(surface, document.size, operator, at, extent)
        .within(reach)
        .for_each_tile(|tile| touched = touched.union(tile.rect()));
    let area = touched.intersect(document.size.rect()).grown(1);
    if area.is_empty() {
        return circle(at, radius_px);
    }
    let step = (area.width().max(area.height()) as i32 / CELLS).max(1);
    let distance = |x: i32, y: i32| deformation.at(x, y).distance(at) - radius_px;
    let (cols, rows) = (area.width() as i32 / step + 1, area.height() as i32 / step + 1);
    let at_node = |c: i32, r: i32| (area.x0 + c * step, area.y0 + r * step);
    let nodes: Vec<f32> = (0..rows * cols)
        .map(|i| {
            let (x, y) = at_node(i % cols, i / cols);
            distance(x, y)
        })
        .collect();
    let inside: Vec<bool> = nodes.iter().map(|distance| *distance < 0.0).collect();
    let specks = specks(&inside, cols as usize);
    // What the outline leaves out counts as outside.
    let node = |c: i32, r: i32| {
        let i = (r * cols + c) as usize;
        if specks[i] { f32::MIN_POSITIVE } else { nodes[i] }
    };
    let point = |c: i32, r: i32| {
        let (x, y) = at_node(c, r);
        vec2(x as f32 + 0.5, y as f32 + 0.5)
    };
    let mut lines = Vec::new();
    for r in 0..rows - 1 {
        for c in 0..cols - 1 {
            let corners = [(c, r), (c + 1, r), (c + 1, r + 1), (c, r + 1)]
                .map(|(c, r)| (point(c, r), node(c, r)));
            cell(&corners, &mut lines);
        }
    }
    lines
}

/// Which nodes of a grid lie in pieces too small to matter: under a twentieth of the largest. On a
/// detailed surface a dab lands in dozens of specks, and a cursor of dozens of loops shows nothing.
fn specks(inside: &[bool], cols: usize) -> Vec<bool> {
    const SHARE: usize = 20;
    let mut piece_of: Vec<Option<usize>> = vec![None; inside.len()];
    let mut sizes: Vec<usize> = Vec::new();
    let mut open = Vec::new();
    for start in 0..inside.len() {
        if !inside[start] || piece_of[start].is_some() {
            continue;
        }
        let piece = sizes.len();
        sizes.push(0);
        piece_of[start] = Some(piece);
        open.push(start);
        while let Some(i) = open.pop() {
            sizes[piece] += 1;
            let x = i % cols;
            let beside = [
                (x > 0).then(|| i - 1),
                (x + 1 < cols).then_some(i + 1),
                i.checked_sub(cols),
                Some(i + cols),
            ];
            for j in beside.into_iter().flatten().filter(|&j| j < inside.len()) {
                if inside[j] && piece_of[j].is_none() {
                    piece_of[j] = Some(piece);
                    open.push(j);
                }
            }
        }
    }
    let largest = sizes.iter().copied().max().unwrap_or(0);
    piece_of.iter().map(|piece| piece.is_some_and(|piece| sizes[piece] * SHARE < largest)).collect()
}

/// The outline of what a stroke covers, as pairs of points to be joined by lines; canvas px.
pub fn of_stroke(stroke: &Arc<Stroke>, scene: &Scene) -> Vec<[Vec2; 2]> {
    /// A pixel counts as covered from this alpha on.
    const LEAST: f32 = 24.0;
    /// Cells along the longer side: a stroke's outline winds more than a dab's.
    const CELLS: i32 = 400;
    let covered = stroke.render_opaque(scene);
    let area = stroke.bounds(scene).grown(1);
    let step = (area.width().max(area.height()) as i32 / CELLS).max(1);
    let (cols, rows) = (area.width() as i32 / step + 1, area.height() as i32 / step + 1);
    let corner = |c: i32, r: i32| {
        let (x, y) = (area.x0 + c * step, area.y0 + r * step);
        (vec2(x as f32 + 0.5, y as f32 + 0.5), LEAST - f32::from(covered.pixel(x, y)[3]))
    };
    let mut lines = Vec::new();
    for (r, c) in (0..rows - 1).flat_map(|r| (0..cols - 1).map(move |c| (r, c))) {
        let corners = [(c, r), (c + 1, r), (c + 1, r + 1), (c, r + 1)].map(|(c, r)| corner(c, r));
        cell(&corners, &mut lines);
    }
    lines
}

/// Marching squares: where the outline crosses a cell.
fn cell(corners: &[(Vec2, f32); 4], lines: &mut Vec<[Vec2; 2]>) {
    let crossing = |i: usize| {
        let ((a, va), (b, vb)) = (corners[i], corners[(i + 1) % 4]);
        ((va < 0.0) != (vb < 0.0)).then(|| a.lerp(b, va / (va - vb)))
    };
    let crossings: Vec<Vec2> = (0..4).filter_map(crossing).collect();
    for pair in crossings.chunks_exact(2) {
        lines.push([pair[0], pair[1]]);
    }
}

/// A circle, as segments.
pub fn circle(at: Vec2, radius_px: f32) -> Vec<[Vec2; 2]> {
    const SIDES: usize = 64;
    let on = |i: usize| {
        at + radius_px * Vec2::from_angle(i as f32 * std::f32::consts::TAU / SIDES as f32)
    };
    (0..SIDES).map(|i| [on(i), on(i + 1)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, vec3};
    use crate::raster::Plane;
    use crate::surface::{Maps, Surface};

    fn ball() -> Document {
        let size = Size::new(128, 128);
        let at = |x: usize, y: usize| vec2(x as f32 + 0.5 - 64.0, y as f32 + 0.5 - 64.0) / 60.0;
        let z = |p: Vec2| (1.0 - p.length_squared()).max(0.0).sqrt();
        let normals = Plane::from_fn(size, |x, y| vec3(at(x, y).x, -at(x, y).y, z(at(x, y))));
        let coverage = Plane::from_fn(size, |x, y| if at(x, y).length() < 1.0 { 255 } else { 0 });
        let depth = Plane::from_fn(size, |x, y| 1.0 - z(at(x, y)));
        let surface = Surface::new(Maps { normals, depth, coverage }).unwrap();
        Document { surface: Some(Arc::new(surface)), ..Document::empty(size) }
    }

    #[test]
    fn a_strokes_outline_runs_where_its_paint_begins() {
        use crate::math::srgb::Color;
        use crate::paint::{Brush, Sample};
        let scene = Scene { size: Size::new(200, 100), surface: None };
        let samples = [vec2(50.0, 50.0), vec2(150.0, 50.0)].map(Sample::at).to_vec();
        let brush = Brush { size: 30.0, hardness: 1.0, spacing: 0.05, ..Brush::default() };
        let lines =
            of_stroke(&Arc::new(Stroke::new(brush, Operator::None, Color::BLACK, samples)), &scene);
        assert!(lines.len() > 100);
        for p in lines.iter().flatten() {
            let to_line = p.distance(vec2(p.x.clamp(50.0, 150.0), 50.0));
            assert!((to_line - 15.0).abs() < 1.0, "{p}");
        }
    }

    #[test]
    fn specks_beside_a_large_piece_are_left_out() {
        let size = 40;
        let at = |i: usize| ((i % size) as i32, (i / size) as i32);
        let inside: Vec<bool> = (0..size * size)
            .map(|i| {
                let (x, y) = at(i);
                let is_large = (x - 12).pow(2) + (y - 12).pow(2) < 100;
                is_large || (x, y) == (35, 35) || ((28..36).contains(&x) && (5..12).contains(&y))
            })
            .collect();
        let specks = specks(&inside, size);
        assert!(specks[35 * size + 35], "one node");
        assert_eq!(
            specks.iter().filter(|&&speck| speck).count(),
            1,
            "the second largest piece stays"
        );
    }

    #[test]
    fn without_a_surface_the_footprint_is_a_circle() {
        let flat = Document::empty(Size::new(100, 100));
        let lines = outline(&flat, Operator::Depth { gamma: 2.0 }, vec2(50.0, 40.0), 12.0, 0.0);
        assert!(lines.iter().flatten().all(|p| (p.distance(vec2(50.0, 40.0)) - 12.0).abs() < 1e-3));
    }

    #[test]
    fn on_a_ball_a_reflecting_dab_is_smaller_and_its_outline_is_where_d_is_its_radius() {
        let (ball, at) = (ball(), vec2(64.0, 64.0));
        let operator = Operator::Normal { alpha: 0.5, beta: 0.0, detail: 0.0 };
        let lines = outline(&ball, operator, at, 20.0, 0.0);
        assert!(lines.len() > 8);
        // n̄ = (q − q_0) / 60 on the ball and f_n(u) = α u at β = 0: a point r px away is moved to
        // a distance of r + α L (r / 60)².
        let a = 0.5 * 128.0 / (60.0 * 60.0);
        let expected = ((1.0f32 + 4.0 * a * 20.0).sqrt() - 1.0) / (2.0 * a);
        for point in lines.iter().flatten() {
            assert!((point.distance(at) - expected).abs() < 0.5, "{}", point.distance(at));
        }
    }
}
