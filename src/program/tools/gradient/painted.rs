//! Gradients that are painted: their pixels go into a paint layer, within the selection. Floor 5.
//! Not here: live ones (the module above), the colors (`paint::Gradient`).

use super::end_at;
use crate::document::{Content, Document, LayerId, LayerLock, PixelLayer};
use crate::paint::Gradient;
use crate::raster::{
    CoverageGrid, Mix, PlanarTile, TILE, Tile, TileAt, TileCoverage, TileGrid, TilePaint,
};
use crate::tools::snap::{SnapLines, SnapTargets};
use crate::tools::{Gesture, Outcome, PenSample};
use rayon::prelude::*;
use std::sync::Arc;

/// A gradient over a paint layer, from where the pen came down.
pub(super) struct PaintedGradient {
    pub document: Document,
    /// The paint layer.
    pub layer: LayerId,
    pub gradient: Gradient,
    pub snap: SnapTargets,
    pub lines: SnapLines,
}

impl PaintedGradient {
    fn with(&self) -> Option<Document> {
        paint_gradient(&self.document, self.layer, &self.gradient)
    }
}

impl Gesture for PaintedGradient {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last() else { return Outcome::Idle };
        (self.gradient.to, self.lines) = end_at(&self.snap, self.gradient.from, pen);
        self.with().map_or(Outcome::Idle, Outcome::Preview)
    }

    fn release(&mut self) -> Outcome {
        if self.gradient.from.distance(self.gradient.to) < super::SHORTEST_PX {
            return Outcome::Cancel;
        }
        self.with().map_or(Outcome::Cancel, |document| Outcome::Commit {
            label: "Gradient".into(),
            document,
            select: None,
        })
    }

    fn snap_lines(&self) -> SnapLines {
        self.lines
    }
}

/// The document with a gradient over the pixels of a paint layer, where they are selected.
fn paint_gradient(document: &Document, id: LayerId, gradient: &Gradient) -> Option<Document> {
    let layer = document.layer(id)?;
    let Content::Pixels(pixels) = &layer.content else { return None };
    let (scene, selected) = (document.scene_of(id)?, document.active_coverage());
    let mix = Mix { atop: layer.lock == LayerLock::Alpha, ..Mix::default() };
    let area = document.size.rect();
    let places: Vec<TileAt> = TileAt::covering(area).collect();
    let one = |&at: &TileAt| {
        let base = pixels.tiles.tile(at);
        let Some(coverage) = coverage(selected, at) else { return base.cloned() };
        match gradient.render_pixels(&scene, at) {
            Some(paint) => paint_over(base.map(|tile| &**tile), &paint, mix, &coverage),
            None => base.cloned(),
        }
    };
    let made: Vec<Option<Arc<Tile>>> = places.par_iter().map(one).collect();
    let mut tiles: TileGrid = pixels.tiles.clone();
    tiles.reserve(area);
    places.iter().zip(made).for_each(|(&at, tile)| tiles.set(at, tile));
    let next = PixelLayer { file: String::new(), tiles, ..pixels.clone() };
    document.with_layer(id, |layer| layer.content = Content::Pixels(next))
}

/// How much of the paint arrives in a tile; `None` if nothing does.
fn coverage(selected: Option<&CoverageGrid>, at: TileAt) -> Option<TileCoverage> {
    let Some(selected) = selected else { return Some(TileCoverage::FULL) };
    let tile = selected.tile(at)?;
    Some(match tile.is_whole() {
        true => TileCoverage::FULL,
        false => TileCoverage::FULL.times(|x, y| f32::from(tile.bytes()[y * TILE + x]) / 255.0),
    })
}

fn paint_over(
    base: Option<&Tile>,
    paint: &PlanarTile,
    mix: Mix,
    coverage: &TileCoverage,
) -> Option<Arc<Tile>> {
    let mut pixels = PlanarTile::of_tile(base);
    pixels.blend(mix, TilePaint::Planar(paint), coverage);
    pixels.to_tile_over(base).map(Arc::new)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Layer;
    use crate::math::{Size, Vec2, vec2};
    use crate::paint::{RampColors, RampStyle};
    use crate::tools::gradient::{GradientSettings, press};
    use crate::tools::{ToolContext, ToolSettings};

    /// An opaque white left half of 100 × 60 px.
    fn document(lock: LayerLock) -> Document {
        let white: Vec<u8> = [255; 4].repeat(50 * 60);
        let tiles = TileGrid::from_straight_rgba(&white, 50, 60, 0, 0);
        let content = Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() });
        let layer = Layer { lock, ..Layer::new("paper", content) };
        Document { layers: vec![Arc::new(layer)], ..Document::empty(Size::new(100, 60)) }
    }

    fn drag(document: &Document, tools: &ToolSettings, from: Vec2, to: Vec2) -> Outcome {
        let layer = document.layers.first().map(|layer| layer.id);
        let context = ToolContext { layer, ..ToolContext::new(document, tools) };
        let mut gesture = press(&context, PenSample::at(from)).0.unwrap();
        gesture.drag(&[PenSample::at(to)]);
        gesture.release()
    }

    fn pixel(document: &Document, x: i32, y: i32) -> [u8; 4] {
        let Content::Pixels(pixels) = &document.layers[0].content else { panic!("paint") };
        pixels.tiles.pixel(x, y)
    }

    #[test]
    fn a_gradient_goes_into_the_paint_and_live_ones_into_a_layer_of_their_own() {
        let tools = ToolSettings::default();
        let document = document(LayerLock::None);
        let ends = (vec2(0.0, 30.0), vec2(100.0, 30.0));
        let Outcome::Commit { document: after, .. } = drag(&document, &tools, ends.0, ends.1)
        else {
            panic!("painted")
        };
        assert_eq!(after.layers.len(), 1);
        let [left, middle, right] = [1, 50, 98].map(|x| pixel(&after, x, 20));
        assert!(
            left[0] < 8 && middle[0].abs_diff(128) < 40 && right[0] > 247,
            "{left:?} {middle:?} {right:?}"
        );
        assert!([left, middle, right].iter().all(|pixel| pixel[3] == 255));
        let settings = GradientSettings { live: true, ..tools.gradient };
        let live = ToolSettings { gradient: settings, ..tools };
        let Outcome::Commit { document: after, select, .. } =
            drag(&document, &live, ends.0, ends.1)
        else {
            panic!("laid")
        };
        assert_eq!((after.layers.len(), select), (2, Some(after.layers[1].id)));
        assert_eq!(pixel(&after, 1, 20), [255; 4], "the paint stays");
    }

    #[test]
    fn a_round_gradient_fades_from_the_color_into_the_paint() {
        let gradient = GradientSettings {
            style: RampStyle::Radial,
            colors: RampColors::Fading,
            ..GradientSettings::default()
        };
        let tools = ToolSettings { gradient, ..ToolSettings::default() };
        let ends = (vec2(25.0, 30.0), vec2(45.0, 30.0));
        let painted = |tools: &ToolSettings| {
            let Outcome::Commit { document, .. } =
                drag(&document(LayerLock::None), tools, ends.0, ends.1)
            else {
                panic!("painted")
            };
            [(25, 30), (25, 40), (25, 52)].map(|(x, y)| pixel(&document, x, y))
        };
        let [middle, half, beyond] = painted(&tools);
        assert!(middle[0] < 12 && half[0].abs_diff(128) < 24, "{middle:?} {half:?}");
        assert_eq!(beyond, [255; 4]);
        let reversed = GradientSettings { reverse: true, ..gradient };
        let [middle, _, beyond] = painted(&ToolSettings { gradient: reversed, ..tools });
        assert!(middle[0] > 243 && beyond == [0, 0, 0, 255], "{middle:?} {beyond:?}");
    }

    #[test]
    fn locked_alpha_keeps_the_outline_and_a_locked_layer_says_so() {
        let tools = ToolSettings::default();
        let ends = (vec2(0.0, 30.0), vec2(100.0, 30.0));
        let outlined = document(LayerLock::Alpha);
        let Outcome::Commit { document: after, .. } = drag(&outlined, &tools, ends.0, ends.1)
        else {
            panic!("painted")
        };
        assert_eq!((pixel(&after, 80, 20), pixel(&after, 10, 20)[3]), ([0; 4], 255));
        let locked = document(LayerLock::All);
        let layer = locked.layers.first().map(|layer| layer.id);
        let context = ToolContext { layer, ..ToolContext::new(&locked, &tools) };
        let refused = press(&context, PenSample::at(ends.0)).1;
        assert!(matches!(refused, Outcome::Refused(why) if why.contains("locked")));
    }
}
