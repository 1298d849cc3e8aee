//! Snapping: points and boxes that the user drags go to guides, the grid, the canvas and the boxes
//! of layers when near. Floor 5. Pure functions. Not here: which tools snap (their files), what is
//! drawn (the window).

use super::gizmo::TransformGizmo;
use crate::document::{AssistantKind, Content, Document, LayerId};
use crate::math::range::{Range, clamp_to_range};
use crate::math::{COORDINATE, Vec2, vec2};

/// What is snapped to, and what is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewAids {
    /// Rulers along the edges of the view.
    pub rulers: bool,
    /// Guides are shown; hidden ones are not snapped to.
    pub guides: bool,
    /// Guides stay where they are.
    pub locked: bool,
    /// The grid is shown.
    pub grid_shown: bool,
    /// The grid, and what is shown of it.
    pub grid: CanvasGrid,
    /// Whether anything snaps at all.
    pub snaps: bool,
    /// The pen snaps to guides.
    pub to_guides: bool,
    /// The pen snaps to the grid.
    pub to_grid: bool,
    /// Its edges and its middle.
    pub to_canvas: bool,
    /// The edges and middles of what other layers hold.
    pub to_layers: bool,
    /// How strongly assistants attract strokes: 0 not at all, 1 wholly.
    pub magnetism: f32,
    /// The kind that the tool *Assistants* sets.
    pub assistant: AssistantKind,
}

/// Level and upright lines at equal distances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CanvasGrid {
    /// From one line to the next, px.
    pub spacing: f32,
    /// Parts of each square.
    pub subdivisions: u32,
    /// The place of one crossing, canvas px.
    pub offset: Vec2,
}

impl CanvasGrid {
    /// The range of the spacing, px.
    pub const SPACING: Range = 2.0..=10_000.0;
    /// The range of the subdivisions.
    pub const SUBDIVISIONS: std::ops::RangeInclusive<u32> = 1..=16;

    /// With its numbers within their ranges.
    pub fn clamp_to_ranges(self) -> Self {
        Self {
            spacing: clamp_to_range(self.spacing, &Self::SPACING),
            subdivisions: self
                .subdivisions
                .clamp(*Self::SUBDIVISIONS.start(), *Self::SUBDIVISIONS.end()),
            offset: vec2(
                clamp_to_range(self.offset.x, &COORDINATE),
                clamp_to_range(self.offset.y, &COORDINATE),
            ),
        }
    }

    /// Between two lines, subdivisions counted, px; never less than a pixel.
    pub fn step(&self) -> f32 {
        (self.spacing / self.subdivisions as f32).max(1.0)
    }

    /// The line nearest to a coordinate; `axis`: 0 for upright lines, 1 for level ones.
    fn nearest(&self, at: f32, axis: usize) -> f32 {
        let offset = self.offset[axis];
        offset + ((at - offset) / self.step()).round() * self.step()
    }
}

impl Default for ViewAids {
    fn default() -> Self {
        Self {
            rulers: false,
            guides: true,
            locked: false,
            grid_shown: false,
            grid: CanvasGrid { spacing: 64.0, subdivisions: 2, offset: Vec2::ZERO },
            snaps: true,
            to_guides: true,
            to_grid: true,
            to_canvas: true,
            to_layers: false,
            magnetism: 1.0,
            assistant: AssistantKind::Line,
        }
    }
}

/// The lines that something can snap to, and the greatest distance.
#[derive(Clone, Debug, Default)]
pub struct SnapTargets {
    /// Upright lines by their x, then level ones by their y.
    lines: [Vec<f32>; 2],
    grid: Option<CanvasGrid>,
    radius_px: f32,
}

/// The place of a point after snapping.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Snapped {
    /// The point after snapping.
    pub at: Vec2,
    /// The lines that it snapped to.
    pub lines: SnapLines,
}

/// The lines that something snapped to: an upright one by its x, a level one by its y.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SnapLines {
    /// An upright line.
    pub x: Option<f32>,
    /// A level line.
    pub y: Option<f32>,
}

/// The greatest distance from which something snaps, screen points.
pub const SNAP_PT: f32 = 8.0;
/// The most strokes of a layer whose box is computed: more would take too long.
const MOST_STROKES: usize = 400;

impl SnapTargets {
    /// No lines: nothing snaps.
    pub fn none() -> &'static Self {
        static NONE: SnapTargets =
            SnapTargets { lines: [Vec::new(), Vec::new()], grid: None, radius_px: 0.0 };
        &NONE
    }

    /// The lines of a document; `moving`: layers that are no targets, because they move themselves.
    pub fn of(document: &Document, aids: &ViewAids, moving: &[LayerId], px_per_pt: f32) -> Self {
        let mut targets = Self { radius_px: SNAP_PT * px_per_pt, ..Self::default() };
        if !aids.snaps {
            return targets;
        }
        let [upright, level] = &mut targets.lines;
        if aids.to_guides && aids.guides {
            upright.extend(&document.guides.vertical);
            level.extend(&document.guides.horizontal);
        }
        let mut edges = |low: Vec2, high: Vec2| {
            let middle = (low + high) * 0.5;
            upright.extend([low.x, middle.x, high.x]);
            level.extend([low.y, middle.y, high.y]);
        };
        if aids.to_canvas {
            edges(Vec2::ZERO, document.size.center() * 2.0);
        }
        if aids.to_layers {
            for layer in
                document.layers.iter().filter(|layer| layer.visible && !moving.contains(&layer.id))
            {
                let has_end = match &layer.content {
                    Content::Pixels(_) => true,
                    Content::Strokes(live) => live.params().strokes.len() <= MOST_STROKES,
                    _ => false,
                };
                if let Some(gizmo) =
                    has_end.then(|| TransformGizmo::of(document, layer.id)).flatten()
                {
                    let [a, b, c, d] = gizmo.corners;
                    edges(a.min(b).min(c).min(d), a.max(b).max(c).max(d));
                }
            }
        }
        targets.grid =
            Some(aids.grid.clamp_to_ranges()).filter(|_| aids.to_grid && aids.grid_shown);
        targets
    }

    /// Whether there is nothing to snap to.
    pub fn is_empty(&self) -> bool {
        self.grid.is_none() && self.lines.iter().all(Vec::is_empty)
    }

    /// A point after snapping.
    pub fn point(&self, at: Vec2) -> Snapped {
        snap(at, self, self.radius_px)
    }

    /// The further move of a dragged box that makes its edges or its middle snap.
    pub fn shift(&self, low: Vec2, high: Vec2) -> Snapped {
        let mut shift = Snapped::default();
        for axis in 0..2 {
            let places = [low[axis], high[axis], 0.5 * (low[axis] + high[axis])];
            let moves = places.iter().filter_map(|place| {
                let to = self.nearest(axis, *place, self.radius_px)?;
                Some((to - place, to))
            });
            if let Some((by, to)) = moves.min_by(|a, b| a.0.abs().total_cmp(&b.0.abs())) {
                shift.at[axis] = by;
                *shift.lines.of(axis) = Some(to);
            }
        }
        shift
    }

    /// The nearest line of an axis within a radius.
    fn nearest(&self, axis: usize, at: f32, radius_px: f32) -> Option<f32> {
        let lines =
            self.lines[axis].iter().copied().chain(self.grid.map(|grid| grid.nearest(at, axis)));
        let near = lines.filter(|line| (line - at).abs() <= radius_px);
        near.min_by(|a, b| (a - at).abs().total_cmp(&(b - at).abs()))
    }
}

impl SnapLines {
    fn of(&mut self, axis: usize) -> &mut Option<f32> {
        if axis == 0 { &mut self.x } else { &mut self.y }
    }
}

/// A point moved to the nearest upright and the nearest level line within a radius, px; each
/// separately.
///
/// Total: an invalid point is returned unchanged.
pub fn snap(point: Vec2, candidates: &SnapTargets, radius_px: f32) -> Snapped {
    let mut found = Snapped { at: point, lines: SnapLines::default() };
    if !point.is_finite() {
        return found;
    }
    for axis in 0..2 {
        if let Some(to) = candidates.nearest(axis, point[axis], radius_px) {
            found.at[axis] = to;
            *found.lines.of(axis) = Some(to);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Guides, Layer, PixelLayer};
    use crate::math::Size;
    use crate::raster::TileGrid;
    use std::sync::Arc;

    fn document() -> Document {
        let tiles = TileGrid::from_straight_rgba(&[200; 20 * 10 * 4], 20, 10, 130, 61);
        let paint =
            Layer::new("paint", Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() }));
        let guides = Arc::new(Guides { vertical: vec![40.0], horizontal: vec![33.5] });
        Document { layers: vec![Arc::new(paint)], guides, ..Document::empty(Size::new(200, 100)) }
    }

    fn to(aids: ViewAids) -> SnapTargets {
        SnapTargets::of(&document(), &aids, &[], 1.0)
    }

    fn only(change: impl FnOnce(&mut ViewAids)) -> SnapTargets {
        let none =
            ViewAids { to_guides: false, to_grid: false, to_canvas: false, ..ViewAids::default() };
        let mut aids = none;
        change(&mut aids);
        to(aids)
    }

    #[test]
    fn a_point_goes_to_the_nearest_line_of_each_direction() {
        let near = |targets: &SnapTargets, x: f32, y: f32| targets.point(vec2(x, y)).at;
        let guides = only(|aids| aids.to_guides = true);
        assert_eq!(near(&guides, 47.0, 26.0), vec2(40.0, 33.5));
        assert_eq!(near(&guides, 49.0, 30.0), vec2(49.0, 33.5), "more than eight points away");
        let canvas = only(|aids| aids.to_canvas = true);
        assert_eq!(near(&canvas, 104.0, 96.0), vec2(100.0, 100.0));
        let layers = only(|aids| aids.to_layers = true);
        assert_eq!(near(&layers, 143.0, 59.0), vec2(140.0, 61.0));
        let grid = only(|aids| {
            (aids.to_grid, aids.grid_shown) = (true, true);
            aids.grid = CanvasGrid { spacing: 30.0, subdivisions: 2, offset: vec2(1.0, 0.0) };
        });
        assert_eq!(near(&grid, 48.0, -13.0), vec2(46.0, -15.0));
        assert_eq!(
            near(&to(ViewAids { snaps: false, ..ViewAids::default() }), 41.0, 33.0),
            vec2(41.0, 33.0)
        );
        assert!(near(&guides, f32::NAN, 33.0).x.is_nan(), "and nothing else happens");
        let found = guides.point(vec2(41.0, 90.0));
        assert_eq!(found.lines, SnapLines { x: Some(40.0), y: None }, "the line to show");
    }

    #[test]
    fn a_box_snaps_by_its_edges_and_its_middle() {
        let guides = only(|aids| aids.to_guides = true);
        let shift = |low: Vec2, high: Vec2| guides.shift(low, high).at;
        assert_eq!(shift(vec2(43.0, 0.0), vec2(60.0, 10.0)), vec2(-3.0, 0.0));
        assert_eq!(shift(vec2(10.0, 30.0), vec2(45.0, 38.0)), vec2(-5.0, -0.5));
        assert_eq!(shift(vec2(0.0, 0.0), vec2(82.0, 9.0)), vec2(-1.0, 0.0));
    }

    #[test]
    fn what_moves_is_no_target_of_itself() {
        let document = document();
        let aids =
            ViewAids { to_guides: false, to_canvas: false, to_layers: true, ..ViewAids::default() };
        let moving = [document.layers[0].id];
        assert!(SnapTargets::of(&document, &aids, &moving, 1.0).is_empty());
        assert!(!SnapTargets::of(&document, &aids, &[], 1.0).is_empty());
    }
}
