//! Finds the stroke under a point, and copies a stroke to another place or style.
//! Floor 3.

use super::brush::{Brush, StrokeFrame};
use super::sample::Sample;
use super::scene::Scene;
use super::selection::StrokeSelection;
use super::stroke::{Stroke, render_tile};
use crate::math::{Mat2, Vec2};
use crate::raster::{BlendMode, CoverageGrid, TILE, Tile, TileAt, TileGrid};
use std::sync::Arc;

/// The least alpha of 255 that counts as part of a stroke: faint rims are hard to see but easy to
/// hit.
const LEAST_ALPHA: u8 = 16;

/// The index of the topmost of some strokes that is visible at a canvas point.
pub fn topmost_at(strokes: &[Arc<Stroke>], scene: &Scene, at: Vec2) -> Option<usize> {
    strokes.iter().rposition(|stroke| stroke.is_at(scene, at))
}

impl Stroke {
    /// Whether the stroke's paint, bent by the surface, is visible at a canvas point.
    pub fn is_at(self: &Arc<Self>, scene: &Scene, at: Vec2) -> bool {
        let pixel = at.floor().as_ivec2();
        let tile = TileAt::of_pixel(pixel.x, pixel.y);
        if !at.is_finite()
            || !scene.size.rect().contains(pixel.x, pixel.y)
            || !self.can_touch(scene, tile)
        {
            return false;
        }
        let (x, y) = ((pixel.x - tile.rect().x0) as usize, (pixel.y - tile.rect().y0) as usize);
        let rendered = render_tile(&[self.as_paint()], scene, tile);
        rendered.is_some_and(|tile| {
            tile.bytes().get((y * TILE + x) * 4 + 3).is_some_and(|&a| a >= LEAST_ALPHA)
        })
    }

    /// The stroke as plain paint on transparency, also if it erases or has another blend mode.
    pub fn render_opaque(self: &Arc<Self>, scene: &Scene) -> TileGrid {
        let paint = [self.as_paint()];
        let mut grid = TileGrid::for_rect(self.bounds(scene));
        for at in TileAt::covering(self.bounds(scene)).filter(|&at| self.can_touch(scene, at)) {
            grid.set(at, render_tile(&paint, scene, at).map(Arc::new));
        }
        grid
    }

    /// Whether any of the stroke's paint lies where something is covered.
    pub fn has_paint_on(self: &Arc<Self>, scene: &Scene, covered: &CoverageGrid) -> bool {
        let paint = [self.as_paint()];
        covered.iter().filter(|(at, _)| self.can_touch(scene, *at)).any(|(at, covered)| {
            let rendered = render_tile(&paint, scene, at);
            let painted = |tile: Tile| {
                let pixels = tile.bytes().as_chunks::<4>().0.iter().zip(covered.bytes());
                pixels.into_iter().any(|(pixel, covered)| pixel[3] > 0 && *covered > 0)
            };
            rendered.is_some_and(painted)
        })
    }

    /// The stroke as it looks on a transparent layer.
    fn as_paint(self: &Arc<Self>) -> Arc<Stroke> {
        let brush = self.brush();
        if !brush.erases && !brush.keeps_alpha && brush.blend == BlendMode::Normal {
            return self.clone();
        }
        let plain =
            Brush { erases: false, keeps_alpha: false, blend: BlendMode::Normal, ..brush.clone() };
        Arc::new(self.with_brush(plain))
    }

    /// The same stroke elsewhere in its frame: every dab bends at its new position.
    pub fn moved(&self, by: Vec2) -> Stroke {
        let samples =
            self.samples().iter().map(|sample| Sample { at: sample.at + by, ..*sample }).collect();
        Stroke::new(self.brush().clone(), self.operator(), self.color(), samples)
            .within(self.selection().map(|selection| selection.moved(by)))
            .on(self.attachment().cloned())
    }

    /// The same stroke within another selection, or within none.
    pub fn selecting(&self, selection: Option<StrokeSelection>) -> Stroke {
        self.with_brush(self.brush().clone()).within(selection)
    }

    /// The stroke where a map takes its samples: `place` gives the new place of a point (`None`:
    /// nowhere), `length` how much longer lengths become there, `turn` how directions turn there
    /// (an orthogonal matrix). Its brush grows by the mean over the remaining samples and faces as
    /// at the first of them; the pen's tilt turns too. It has no attachment and no selection.
    pub fn mapped(
        &self,
        place: &dyn Fn(Vec2) -> Option<Vec2>,
        length: impl Fn(Vec2) -> f32,
        turn: impl Fn(Vec2) -> Mat2,
    ) -> Stroke {
        let placed = |sample: &Sample| {
            let (at, turned) = (place(sample.at)?, turn(sample.at));
            Some(Sample {
                at,
                tilt: if turned == Mat2::IDENTITY { sample.tilt } else { turned * sample.tilt },
                ..*sample
            })
        };
        let (samples, lengths): (Vec<Sample>, Vec<f64>) = self
            .samples()
            .iter()
            .filter_map(|sample| Some((placed(sample)?, f64::from(length(sample.at)))))
            .unzip();
        let mean = lengths.iter().sum::<f64>() / lengths.len().max(1) as f64;
        let mut brush = if samples.is_empty() {
            self.brush().clone()
        } else {
            self.brush().scaled(mean as f32)
        };
        let turned = self
            .samples()
            .iter()
            .find(|sample| place(sample.at).is_some())
            .map(|sample| turn(sample.at));
        if let Some(turned) = turned.filter(|turned| *turned != Mat2::IDENTITY) {
            brush.facing = StrokeFrame::of(turned * brush.facing.map());
        }
        Stroke::new(brush, self.operator(), self.color(), samples)
    }

    /// The same movement of the hand with another brush.
    pub fn with_brush(&self, brush: Brush) -> Stroke {
        Stroke::new(brush, self.operator(), self.color(), self.samples().to_vec())
            .within(self.selection().cloned())
            .on(self.attachment().cloned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, Vec3, srgb::Color, vec2, vec3};
    use crate::raster::Plane;
    use crate::surface::{Maps, Operator, Surface};

    /// The left half faces the viewer, the right half leans to the right: marks of a normal
    /// operator do not cross.
    fn fold() -> Scene {
        let size = Size::new(200, 100);
        let normals =
            Plane::from_fn(size, |x, _| if x < 100 { Vec3::Z } else { vec3(0.6, 0.0, 0.8) });
        let coverage = Plane::full(size, 255);
        let surface =
            Surface::new(Maps { normals, depth: Plane::full(size, 0.5), coverage }).unwrap();
        Scene { size, surface: Some(Arc::new(surface)) }
    }

    fn dot(at: Vec2) -> Arc<Stroke> {
        let brush = Brush { size: 40.0, hardness: 1.0, ..Brush::default() };
        let operator = Operator::Normal { alpha: 1.0, beta: 0.0, detail: 0.0 };
        Arc::new(Stroke::new(brush, operator, Color::BLACK, vec![Sample::at(at)]))
    }

    #[test]
    fn the_topmost_stroke_is_picked_where_it_shows_bent_as_it_is() {
        let scene = fold();
        let strokes = [dot(vec2(60.0, 50.0)), dot(vec2(90.0, 50.0))];
        let at = |x: f32, y: f32| topmost_at(&strokes, &scene, vec2(x, y));
        assert_eq!((at(45.0, 50.0), at(75.0, 50.0), at(85.0, 50.0)), (Some(0), Some(1), Some(1)));
        assert_eq!(at(105.0, 50.0), None, "the fold bends the dab away from its other side");
        assert_eq!((at(60.0, 90.0), at(-5.0, 50.0), at(f32::NAN, 50.0)), (None, None, None));
    }

    #[test]
    fn a_stroke_that_erases_is_picked_where_it_erases() {
        let eraser = dot(vec2(60.0, 50.0)).with_brush(Brush {
            size: 40.0,
            erases: true,
            ..Brush::default()
        });
        assert_eq!(topmost_at(&[Arc::new(eraser)], &fold(), vec2(60.0, 50.0)), Some(0));
    }

    #[test]
    fn a_moved_stroke_bends_at_its_new_place_as_one_painted_there() {
        let scene = fold();
        let moved = Arc::new(dot(vec2(60.0, 50.0)).moved(vec2(70.0, 4.0)));
        let painted = dot(vec2(130.0, 54.0));
        for at in TileAt::covering(scene.size.rect()) {
            let bytes = |stroke: &Arc<Stroke>| {
                render_tile(std::slice::from_ref(stroke), &scene, at).map(|t| t.bytes().to_vec())
            };
            assert_eq!(bytes(&moved), bytes(&painted), "{at:?}");
        }
    }
}
