//! Adjustments of the colors beneath: levels, curves and their like. Floor 4. Not here: what they
//! do to pixels (`paint::adjustment`).

use super::{CanvasScale, Changed, Content, LayerKind, Role};
use crate::document::Progress;
use crate::document::layer::adjustment::{AdjustedPlace, Adjustment};
use crate::document::memory_use::MemoryCount;
use crate::paint::{LiveAdjustment, Scene};
use crate::raster::PlanarTile;
use crate::shading::radiance::{BackdropStats, Exactness};

impl LayerKind for LiveAdjustment {
    fn name(&self) -> &'static str {
        "adjustment"
    }

    fn label(&self) -> &'static str {
        self.params().label()
    }

    fn role(&self) -> Role<'_> {
        Role::Adjusts(self)
    }

    fn warm(&self, _: &Scene, _: &Progress) {
        LiveAdjustment::warm(self);
    }

    fn scaled(&self, _: &CanvasScale) -> Content {
        Content::Adjustment(self.clone())
    }

    fn is_tied_to_shape(&self) -> bool {
        false
    }

    fn difference_from(&self, old: &Content, _scene: &dyn Fn() -> Scene) -> Changed {
        Changed::wholly_if(!matches!(old, Content::Adjustment(old) if old == self))
    }

    fn count(&self, count: &mut MemoryCount, keeps: bool) {
        count.add_adjustment(self, keeps);
    }
}

/// A pixel depends on the pixel alone, wherever it lies; tones are exact to 16 bits anyway, and
/// light beyond white is clipped.
impl Adjustment for LiveAdjustment {
    fn adjust(&self, _: &AdjustedPlace, _: BackdropStats, _: Exactness, pixels: &mut PlanarTile) {
        self.apply(pixels);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Document, Group, Layer, LayerMask, MaskKind, Progress, diff, flatten};
    use crate::math::Size;
    use crate::math::srgb::Color;
    use crate::paint::ColorAdjustment;
    use crate::raster::{BlendMode, Plane, TileGrid};
    use std::sync::Arc;

    const SIZE: Size = Size::new(200, 100);
    const GROUND: [u8; 4] = [200, 100, 50, 255];
    const INVERTED: [u8; 4] = [55, 155, 205, 255];

    fn fill([r, g, b, a]: [u8; 4]) -> Layer {
        Layer::new("fill", Color { r, g, b, a })
    }

    fn invert() -> Layer {
        Layer::new("invert", ColorAdjustment::from_name("invert").unwrap())
    }

    /// Paint over the left half.
    fn half() -> Layer {
        let rgba = [10, 20, 30, 255].repeat(100 * 100);
        Layer::new("half", TileGrid::from_straight_rgba(&rgba, 100, 100, 0, 0))
    }

    fn of(layers: Vec<Layer>) -> Document {
        let layers = layers.into_iter().map(Arc::new).collect();
        Document { layers, ..Document::empty(SIZE) }
    }

    /// Left and right of the middle.
    fn shown(layers: Vec<Layer>) -> [[u8; 4]; 2] {
        let tiles = flatten(&of(layers), &Progress::default()).unwrap();
        [tiles.pixel(20, 50), tiles.pixel(180, 50)]
    }

    fn group(layers: Vec<Layer>, pass_through: bool) -> Layer {
        let layers = layers.into_iter().map(Arc::new).collect();
        Layer::new("group", Group { layers, pass_through })
    }

    #[test]
    fn it_acts_on_all_beneath_it_in_its_scope() {
        assert_eq!(shown(vec![fill(GROUND), invert()]), [INVERTED; 2]);
        let parts = || vec![half(), invert()];
        let painted = [245, 235, 225, 255];
        assert_eq!(shown(vec![fill(GROUND), group(parts(), false)]), [painted, GROUND]);
        assert_eq!(shown(vec![fill(GROUND), group(parts(), true)]), [painted, INVERTED]);
        let clipped = Layer { clip_below: true, ..invert() };
        assert_eq!(shown(vec![fill(GROUND), half(), clipped]), [painted, GROUND]);
        // Nothing becomes no paint.
        assert_eq!(shown(vec![half(), invert()])[1], [0; 4]);
    }

    #[test]
    fn a_mask_and_opacity_lie_between_before_and_after() {
        let coverage = Plane::from_fn(SIZE, |x, _| if x < 100 { 255 } else { 0 });
        let kind = MaskKind::File { file: String::new(), coverage: Arc::new(coverage) };
        let masked = Layer { mask: Some(LayerMask::new(kind)), ..invert() };
        assert_eq!(shown(vec![fill(GROUND), masked]), [INVERTED, GROUND]);
        let faint = Layer { opacity: 0.2, ..invert() };
        assert_eq!(shown(vec![fill(GROUND), faint])[0], [171, 111, 81, 255]);
    }

    #[test]
    fn a_blend_mode_mixes_what_is_adjusted_with_what_was_there_and_keeps_alpha() {
        let darker = Layer { blend: BlendMode::Darken, ..invert() };
        assert_eq!(shown(vec![fill(GROUND), darker.clone()])[0], [55, 100, 50, 255]);
        let half_there = shown(vec![fill([200, 100, 50, 128]), darker])[0];
        // Premultiplied.
        assert_eq!(half_there, [28, 50, 25, 128]);
    }

    #[test]
    fn an_edit_beneath_changes_its_own_tiles_alone() {
        let before = of(vec![fill(GROUND), half(), invert()]);
        let id = before.layers[1].id;
        let rgba = [90, 90, 90, 255].repeat(20 * 20);
        let dab = TileGrid::from_straight_rgba(&rgba, 20, 20, 3, 3);
        let after = before
            .with_layer(id, |layer| {
                let Content::Pixels(pixels) = &mut layer.content else { panic!("no paint") };
                pixels.tiles.join(&dab);
            })
            .unwrap();
        assert_eq!(diff(&before, &after).len(), 1);
    }
}
