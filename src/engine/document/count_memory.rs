//! Counts the memory that documents take, and frees what they keep only for speed. Floor 4. Higher
//! floors, which know the machine, say how much that may be.

use super::{Document, MaskKind, MemoryCount};

impl MemoryCount {
    /// Counts what a document holds besides what was counted before. Unless `keeps`, it frees what
    /// it keeps for speed and was not counted before; that is computed again when needed.
    pub fn add(&mut self, document: &Document, keeps: bool) {
        if let Some(surface) = &document.surface {
            self.add_surface(surface, keeps);
        }
        let kept_by_name = document.selections.iter().map(|named| &named.selection);
        kept_by_name
            .chain(&document.active_selection)
            .for_each(|selection| self.add_selection(selection));
        for (_, layer) in document.walk() {
            if !self.is_new(layer) {
                continue;
            }
            if let Some(MaskKind::File { coverage, .. }) =
                layer.mask.as_ref().map(|mask| &mask.kind)
                && self.is_new(coverage)
            {
                self.add_painted(coverage.size().area() as u64);
            }
            layer.content.count(self, keeps);
            layer.cache.count(self, keeps);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::document::{
        Content, Document, Group, Layer, LayerTransform, Live, MemoryCount, MemoryUse, Progress,
        TransformShape, flatten,
    };
    use crate::math::srgb::Color;
    use crate::math::{Rect, Size, vec2};
    use crate::paint::adjustment::ColorAdjustment;
    use crate::paint::{
        EffectKind, LayerEffect, LiveAdjustment, PictureSource, PlacedImage, Placement,
    };
    use crate::raster::{Lattice, Picture, Resampling, TileGrid};
    use std::sync::Arc;

    const SIZE: Size = Size::new(150, 100);

    fn paint() -> Layer {
        let rgba = [200, 90, 40, 255].repeat(80 * 60);
        Layer::new("paint", TileGrid::from_straight_rgba(&rgba, 80, 60, 30, 20))
    }

    fn image() -> Layer {
        let texels = (0..48 * 36).map(|i| [i as u8, (i / 7) as u8, 90, 255]).collect();
        let picture = Picture::srgb8(Size::new(48, 36), texels).unwrap();
        let placed = PlacedImage::new(PictureSource::from(picture), Placement::covering(SIZE));
        Layer::new("image", Content::Image(Live::new(placed)))
    }

    /// Layers each of which keeps something of another kind.
    fn layers() -> Vec<(&'static str, Layer)> {
        let turned = TransformShape::Matrix([0.9, 0.3, -0.3, 0.9, 12.0, -8.0]);
        let mut lattice = Lattice::default();
        lattice.change(Rect::new(40, 30, 100, 70), |_, _, _| vec2(6.0, -3.0));
        let group = Group { layers: vec![Arc::new(image())], pass_through: false };
        let transform = Some(LayerTransform { shape: turned, filter: Resampling::Smooth });
        let darker = ColorAdjustment::all().into_iter().find(|a| a.name() == "levels").unwrap();
        vec![
            ("a texture", image()),
            ("a table", Layer::new("levels", Content::Adjustment(LiveAdjustment::new(darker)))),
            ("a transform", Layer { transform, ..paint() }),
            (
                "displaced tiles",
                Layer {
                    liquify: Some(Arc::new(lattice)),
                    ..Layer::new("group", Content::Group(group))
                },
            ),
            (
                "effects",
                Layer {
                    effects: Arc::new(vec![LayerEffect::new(EffectKind::DropShadow)]),
                    ..paint()
                },
            ),
        ]
    }

    fn of(layer: Layer) -> Document {
        Document::empty(SIZE).with_top(Layer::new("ground", Color::WHITE)).with_top(layer)
    }

    fn freed(document: &Document) -> MemoryUse {
        let mut count = MemoryCount::default();
        count.add(document, false);
        count.sum_up()
    }

    #[test]
    fn whatever_a_layer_keeps_for_speed_is_counted_and_freed_and_made_again() {
        for (what, layer) in layers() {
            let document = of(layer);
            let before = MemoryUse::of(&document);
            assert_eq!(before.kept, 0, "{what}");
            let picture = || {
                let flat = flatten(&document, &Progress::default()).unwrap();
                flat.to_straight_rgba(SIZE.rect())
            };
            let first = picture();
            let after = MemoryUse::of(&document);
            assert!(after.kept > 5_000, "{what}: {after:?}");
            assert_eq!(MemoryUse { kept: 0, ..after }, before, "{what}");
            assert_eq!(freed(&document), before, "{what}");
            assert_eq!(MemoryUse::of(&document), before, "{what}");
            assert!(picture() == first, "{what}");
            assert_eq!(MemoryUse::of(&document), after, "{what}");
        }
    }
}
