//! The box around what a layer holds, in its own frame: what the handles of a transform surround.
//! Floor 4.

use super::{Content, Document, Layer, LayerId, LayerMap, Live, StrokeList};
use crate::math::{PlaneMap, Rect, Vec2, vec2};
use crate::paint::{Scene, Stroke, stroke};
use crate::raster::{TILE, Tile, TileAt, TileGrid};
use std::sync::Arc;

/// A box with sides along the axes, px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameBox {
    /// Its upper left corner.
    pub low: Vec2,
    /// Its lower right corner.
    pub high: Vec2,
}

impl FrameBox {
    fn of(rect: Rect) -> Option<Self> {
        let corner = |x: i32, y: i32| vec2(x as f32, y as f32);
        (!rect.is_empty())
            .then(|| Self { low: corner(rect.x0, rect.y0), high: corner(rect.x1, rect.y1) })
    }

    fn around(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Upper left, upper right, lower right, lower left.
    pub fn corners(self) -> [Vec2; 4] {
        let Self { low, high } = self;
        [low, vec2(high.x, low.y), high, vec2(low.x, high.y)]
    }

    /// Its middle.
    pub fn center(self) -> Vec2 {
        (self.low + self.high) * 0.5
    }
}

impl Document {
    /// The box around the content of a layer in its own frame: paint and strokes exactly, strokes
    /// on parts of the shape in whole tiles, for unbounded content the canvas. `None` for an empty
    /// layer.
    pub fn frame_box(&self, id: LayerId) -> Option<FrameBox> {
        let scene = self.scene_of(id)?;
        let layer = self.layer(id)?;
        // The points of a mesh lie where its layer shows.
        if let Some(mesh) = layer.transform.as_ref().and_then(|own| own.mesh()) {
            let low = mesh.points().iter().copied().reduce(Vec2::min)?;
            return Some(FrameBox { low, high: mesh.points().iter().copied().reduce(Vec2::max)? });
        }
        box_of(layer, &scene, &self.map_of(id)?)
    }
}

/// `map`: the layer's.
fn box_of(layer: &Layer, scene: &Scene, map: &LayerMap) -> Option<FrameBox> {
    // Content with a frame of its own, in that of the layer.
    let within = |inner: FrameBox, plane: &PlaneMap| {
        let to = plane.then(&map.plane.inverse());
        let corners = inner.corners().map(|corner| to.to_canvas(corner).unwrap_or(corner));
        let low = corners.into_iter().fold(Vec2::INFINITY, Vec2::min);
        FrameBox { low, high: corners.into_iter().fold(Vec2::NEG_INFINITY, Vec2::max) }
    };
    match &layer.content {
        Content::Pixels(pixels) => FrameBox::of(painted_rect(&pixels.tiles)),
        Content::Strokes(live) if !layer.content.has_attachments() => {
            FrameBox::of(live.painted_box(scene, || strokes_rect(live, scene)))
        }
        // Content with an attachment of its own takes whole tiles.
        Content::Strokes(live) => {
            let box_of =
                |stroke: &Arc<Stroke>| {
                    let inner = FrameBox::of(stroke.bounds(scene))?;
                    Some(stroke.attachment().map_or(inner, |attachment| {
                        within(inner, &map.of_stroke(attachment).plane)
                    }))
                };
            live.params().strokes.iter().filter_map(box_of).reduce(FrameBox::around)
        }
        Content::Group(group) => {
            let seen = group.layers.iter().filter_map(|layer| {
                let own = map.within(layer);
                Some(within(box_of(layer, scene, &own)?, &own.plane))
            });
            seen.reduce(FrameBox::around)
        }
        _ => FrameBox::of(scene.size.rect()),
    }
}

/// The pixels of a grid that are not wholly transparent. Called for every window frame that shows
/// handles: a tile within the known box is not looked at.
fn painted_rect(tiles: &TileGrid) -> Rect {
    let with = |known: Rect, (at, tile): (TileAt, &Arc<Tile>)| match is_within(known, at) {
        true => known,
        false => with_tile(known, at, tile),
    };
    tiles.iter().fold(Rect::EMPTY, with)
}

/// The pixels of strokes that are not wholly transparent.
fn strokes_rect(live: &Live<StrokeList>, scene: &Scene) -> Rect {
    let strokes = &live.params().strokes;
    let all = strokes.iter().map(|stroke| stroke.bounds(scene)).fold(Rect::EMPTY, Rect::union);
    let mut tiles: Vec<(TileAt, Rect)> = TileAt::covering(all).map(|at| (at, at.rect())).collect();
    // From the outside in: what lies within the known box is not rendered.
    tiles.sort_by_key(|(_, tile)| {
        (tile.x0 - all.x0).min(tile.y0 - all.y0).min(all.x1 - tile.x1).min(all.y1 - tile.y1)
    });
    tiles.into_iter().fold(Rect::EMPTY, |known, (at, _)| {
        let render = || live.tile(scene, at, || stroke::render_tile(strokes, scene, at));
        if is_within(known, at) {
            known
        } else {
            render().map_or(known, |tile| with_tile(known, at, &tile))
        }
    })
}

fn is_within(known: Rect, at: TileAt) -> bool {
    known.union(at.rect()) == known
}

/// The known box, extended by the pixels of one more tile that are not wholly transparent.
fn with_tile(known: Rect, at: TileAt, tile: &Tile) -> Rect {
    let origin = at.rect();
    (0..TILE).zip(origin.y0..).fold(known, |all, (row, y)| {
        let is_painted = |x: &usize| tile.is_painted(row * TILE + x);
        match (0..TILE).find(is_painted).zip((0..TILE).rfind(is_painted)) {
            Some((first, last)) => all.union(Rect::new(
                origin.x0 + first as i32,
                y,
                origin.x0 + last as i32 + 1,
                y + 1,
            )),
            None => all,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Progress, flatten};
    use crate::math::{Size, hash, srgb::Color};
    use crate::paint::{Brush, Sample};
    use crate::surface::Operator;

    #[test]
    fn the_box_around_paint_holds_every_pixel_of_it_and_no_row_more() {
        for seed in 0..20 {
            let mut rgba = vec![0u8; 300 * 200 * 4];
            let random = |i: u32, most: u32| hash::mix(seed * 31 + i) % most;
            let mut expected = Rect::EMPTY;
            for i in 0..3 + seed % 4 {
                let (x, y) = (random(2 * i, 300), random(2 * i + 1, 200));
                rgba[((y * 300 + x) * 4 + 3) as usize] = 9;
                expected =
                    expected.union(Rect::new(x as i32, y as i32, x as i32 + 1, y as i32 + 1));
            }
            assert_eq!(
                painted_rect(&TileGrid::from_straight_rgba(&rgba, 300, 200, 0, 0)),
                expected
            );
        }
    }

    #[test]
    fn the_box_around_strokes_holds_every_pixel_of_them_and_no_row_more() {
        let stroke = |from: Vec2, to: Vec2| {
            let brush = Brush { size: 30.0, hardness: 1.0, ..Brush::default() };
            let samples = [from, to].map(Sample::at).to_vec();
            Arc::new(Stroke::new(brush, Operator::None, Color::BLACK, samples))
        };
        let strokes = vec![
            stroke(vec2(210.0, 90.0), vec2(300.0, 130.0)),
            stroke(vec2(150.0, 310.0), vec2(220.0, 200.0)),
        ];
        let layer = Layer::new("Strokes", Content::Strokes(Live::new(StrokeList { strokes })));
        let document = Document::empty(Size::new(500, 400));
        let document = Document { layers: vec![Arc::new(layer)], ..document };
        let FrameBox { low, high } = document.frame_box(document.layers[0].id).unwrap();
        let painted = flatten(&document, &Progress::default()).unwrap();
        let Rect { x0, y0, x1, y1 } = super::painted_rect(&painted);
        assert_eq!((low, high), (vec2(x0 as f32, y0 as f32), vec2(x1 as f32, y1 as f32)));
        assert!(x0.abs_diff(135) <= 3 && x1.abs_diff(315) <= 3, "{x0} {x1}");
        assert!(y0.abs_diff(75) <= 3 && y1.abs_diff(325) <= 3, "{y0} {y1}");
    }
}
