//! Filters of what lies beneath: blurs, sharpening, noise and their like. Floor 4. Not here: what
//! they do to pixels (`paint::filter`), and in which order (`document::filters`).

use super::{CanvasScale, Changed, Content, LayerKind, Role};
use crate::document::Progress;
use crate::document::layer::adjustment::{AdjustedPlace, Adjustment, Reach};
use crate::paint::{LiveFilter, Scene};
use crate::raster::PlanarTile;
use crate::shading::radiance::{BackdropStats, Exactness};

impl LayerKind for LiveFilter {
    fn name(&self) -> &'static str {
        "filter"
    }

    fn label(&self) -> &'static str {
        self.params().label()
    }

    fn role(&self) -> Role<'_> {
        Role::Adjusts(self)
    }

    fn warm(&self, scene: &Scene, _: &Progress) {
        LiveFilter::warm(self, scene);
    }

    fn scaled(&self, scale: &CanvasScale) -> Content {
        Content::Filter(LiveFilter::scaled(self, scale.length))
    }

    fn draft(&self) -> Option<Content> {
        Some(Content::Filter(self.drafted()?))
    }

    fn is_tied_to_shape(&self) -> bool {
        false
    }

    fn difference_from(&self, old: &Content, _scene: &dyn Fn() -> Scene) -> Changed {
        Changed::wholly_if(!matches!(old, Content::Filter(old) if old == self))
    }
}

/// Pixels are filtered in blocks, with what lies around them, and taken from there.
impl Adjustment for LiveFilter {
    fn reach(&self) -> Reach {
        Reach::Around
    }

    fn filter(&self) -> Option<&LiveFilter> {
        Some(self)
    }

    fn adjust(&self, _: &AdjustedPlace, _: BackdropStats, _: Exactness, _: &mut PlanarTile) {}
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{
        Document, DocumentReducer, Group, Layer, LayerMask, MaskKind, PreparedDocument, diff,
        flatten,
    };
    use crate::math::srgb::Color;
    use crate::math::{Size, Vec3, vec3};
    use crate::paint::PictureFilter;
    use crate::paint::filter::GaussianBlur;
    use crate::raster::{BlendMode, Plane, TileAt, TileGrid};
    use crate::surface::{Maps, Surface};
    use std::collections::BTreeSet;
    use std::sync::Arc;

    const SIZE: Size = Size::new(600, 300);

    fn blur(radius: f32) -> Layer {
        Layer::new("blur", PictureFilter::GaussianBlur(GaussianBlur { radius }))
    }

    fn fill(r: u8, g: u8, b: u8) -> Layer {
        Layer::new("fill", Color { r, g, b, a: 255 })
    }

    /// White paint over the left half.
    fn half() -> Layer {
        let rgba = [255; 4].repeat(300 * 300);
        Layer::new("half", TileGrid::from_straight_rgba(&rgba, 300, 300, 0, 0))
    }

    fn of(layers: Vec<Layer>) -> Document {
        let layers = layers.into_iter().map(Arc::new).collect();
        Document { layers, ..Document::empty(SIZE) }
    }

    fn shown(layers: Vec<Layer>) -> TileGrid {
        flatten(&of(layers), &Progress::default()).unwrap()
    }

    #[test]
    fn what_lies_beneath_is_blurred_and_what_lies_above_is_not() {
        let tiles = shown(vec![fill(0, 0, 0), half(), blur(6.0)]);
        // A step, blurred: half at the step, and 84 % a standard deviation beside it.
        let at = |x| tiles.pixel(x, 150)[0];
        assert!(
            at(299).abs_diff(136) <= 1 && at(300).abs_diff(119) <= 1,
            "{} {}",
            at(299),
            at(300)
        );
        assert!(at(293).abs_diff(219) <= 3, "{}", at(293));
        assert_eq!((at(200), at(400)), (255, 0));
        let sharp = shown(vec![fill(0, 0, 0), blur(6.0), half()]);
        assert_eq!((sharp.pixel(299, 150)[0], sharp.pixel(300, 150)[0]), (255, 0));
    }

    #[test]
    fn alpha_is_blurred_too_except_where_it_is_clipped() {
        let soft = shown(vec![half(), blur(6.0)]);
        let [r, _, _, a] = soft.pixel(304, 150);
        assert!(a > 40 && r == a, "white at every alpha: {r} of {a}");
        let group =
            Group { layers: vec![Arc::new(half()), Arc::new(blur(6.0))], pass_through: false };
        let grouped = shown(vec![fill(0, 0, 0), Layer::new("group", group)]);
        assert!(grouped.pixel(300, 150)[0].abs_diff(119) <= 1);
        let clipped = Layer { clip_below: true, ..blur(6.0) };
        let kept = shown(vec![half(), clipped]);
        assert_eq!((kept.pixel(299, 150), kept.pixel(300, 150)), ([255; 4], [0; 4]));
    }

    #[test]
    fn masks_opacity_and_blend_modes_lie_between_before_and_after() {
        let coverage = Plane::from_fn(SIZE, |_, y| if y < 150 { 255 } else { 0 });
        let kind = MaskKind::File { file: String::new(), coverage: Arc::new(coverage) };
        let masked = Layer { mask: Some(LayerMask::new(kind)), ..blur(6.0) };
        let tiles = shown(vec![fill(0, 0, 0), half(), masked]);
        assert!(tiles.pixel(299, 100)[0].abs_diff(136) <= 1);
        assert_eq!(tiles.pixel(299, 200)[0], 255);
        let faint = Layer { opacity: 0.5, ..blur(6.0) };
        let tiles = shown(vec![fill(0, 0, 0), half(), faint]);
        assert!(tiles.pixel(299, 100)[0].abs_diff(196) <= 1);
        let lighter = Layer { blend: BlendMode::Lighten, ..blur(6.0) };
        let tiles = shown(vec![fill(0, 0, 0), half(), lighter]);
        assert_eq!(tiles.pixel(299, 100)[0], 255);
        assert!(tiles.pixel(300, 100)[0].abs_diff(119) <= 1);
    }

    #[test]
    fn filters_above_each_other_read_what_those_beneath_made() {
        let both = shown(vec![fill(0, 0, 0), half(), blur(3.0), blur(4.0)]);
        let one = shown(vec![fill(0, 0, 0), half(), blur(5.0)]);
        for x in 280..320 {
            let (a, b) = (both.pixel(x, 150)[0], one.pixel(x, 150)[0]);
            assert!(a.abs_diff(b) <= 1, "at {x}: {a} and {b}: variances add up");
        }
    }

    /// A stroke beneath a filter.
    fn painted_on(before: &Document) -> Document {
        let rgba = [90, 20, 200, 255].repeat(20 * 20);
        let dab = TileGrid::from_straight_rgba(&rgba, 20, 20, 305, 50);
        let id = before.layers[1].id;
        before
            .with_layer(id, |layer| {
                let Content::Pixels(pixels) = &mut layer.content else { panic!("no paint") };
                pixels.tiles.join(&dab);
            })
            .unwrap()
    }

    #[test]
    fn an_edit_beneath_changes_what_the_filter_reaches_and_nothing_else() {
        let size = Size::new(1200, 130);
        for radius in [2.0, 9.0] {
            let layers = vec![fill(9, 9, 9), half(), blur(radius), blur(1.0)];
            let before = Document { size, ..of(layers) };
            let after = painted_on(&before);
            let reported: BTreeSet<TileAt> = diff(&before, &after).into_iter().collect();
            let all = TileAt::covering(size.rect()).count();
            assert!(reported.len() < all, "all tiles at {radius}");
            let (old, new) = (
                flatten(&before, &Progress::default()).unwrap(),
                flatten(&after, &Progress::default()).unwrap(),
            );
            for at in old.changed_tiles(&new) {
                let (a, b) = (old.tile(at).unwrap(), new.tile(at).unwrap());
                assert!(reported.contains(&at) || a.is_same(b), "{at:?} at {radius}");
            }
            // Only those tiles again gives the very same picture.
            let prepared = PreparedDocument::new(&after, &Progress::default());
            let tiles: Vec<TileAt> = reported.into_iter().collect();
            let part = prepared.unwrap().flatten_tiles(&old, &tiles, &Progress::default()).unwrap();
            for at in TileAt::covering(size.rect()) {
                assert!(part.tile(at).unwrap().is_same(new.tile(at).unwrap()), "{at:?}");
            }
        }
    }

    #[test]
    fn a_tile_alone_shows_what_it_shows_in_the_picture() {
        let document = of(vec![fill(0, 0, 0), half(), blur(8.0)]);
        let whole = flatten(&document, &Progress::default()).unwrap();
        let prepared = PreparedDocument::new(&document, &Progress::default()).unwrap();
        let at = TileAt::of_pixel(300, 150);
        assert!(prepared.flatten_tile(at).unwrap().is_same(whole.tile(at).unwrap()));
    }

    /// White paint over the left half of a ball before a wall, on a canvas of odd sides, and a filter.
    fn on_ball(filter: PictureFilter) -> Document {
        let size = Size::new(601, 299);
        let up = |x: usize, y: usize| {
            let (dx, dy) = (x as f32 - 300.0, y as f32 - 150.0);
            vec3(dx, -dy, (120.0f32 * 120.0 - dx * dx - dy * dy).max(0.0).sqrt())
        };
        let maps = Maps {
            normals: Plane::from_fn(size, |x, y| if up(x, y).z > 0.0 { up(x, y) } else { Vec3::Z }),
            depth: Plane::from_fn(size, |x, y| 0.9 - 0.5 * up(x, y).z / 120.0),
            coverage: Plane::full(size, 255),
        };
        let layers = vec![fill(40, 90, 160), half(), Layer::new("filter", filter)];
        let surface = Surface::new(maps).ok().map(Arc::new);
        Document { size, surface, ..of(layers) }
    }

    fn bytes(document: &Document) -> Vec<u8> {
        let tiles = flatten(document, &Progress::default()).unwrap();
        tiles.to_straight_rgba(document.size.rect())
    }

    /// The mean difference, levels.
    fn mean_difference(a: &[u8], b: &[u8]) -> f64 {
        let sum: f64 = a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b))).sum();
        sum / a.len() as f64
    }

    #[test]
    fn a_filter_is_a_draft_while_its_slider_is_dragged_and_whole_at_rest() {
        for name in ["spin-blur", "zoom-blur", "lens-blur", "flow-blur"] {
            let filter = PictureFilter::from_name(name).unwrap();
            let document = on_ball(filter.clone());
            let mut reduced = DocumentReducer::new(1.0);
            reduced.keep(&document);
            let rest = reduced.of(&document).unwrap();
            assert!(Arc::ptr_eq(&rest.layers[2], &document.layers[2]), "{name} at rest");
            let id = document.layers[2].id;
            let set = |layer: &mut Layer| layer.content = Content::from(filter.clone());
            let moved = document.with_layer(id, set).unwrap();
            let draft = reduced.of(&moved).unwrap();
            let all = TileAt::covering(document.size.rect()).count();
            assert_eq!(diff(&moved, &draft).len(), all, "{name} on release");
            assert!(diff(&draft, &reduced.of(&moved).unwrap()).is_empty());
            let (seen, whole) = (bytes(&draft), bytes(&moved));
            let apart = mean_difference(&seen, &whole);
            assert!(seen != whole && apart < 2.0, "{name}: {apart} levels");
            assert!(whole == bytes(&document), "{name} at rest");
        }
    }

    #[test]
    fn tiles_of_drafts_are_the_same_alone_and_in_the_picture() {
        for name in ["spin-blur", "zoom-blur", "lens-blur", "flow-blur"] {
            let document = on_ball(PictureFilter::from_name(name).unwrap());
            let draft = DocumentReducer::new(1.0).of(&document).unwrap();
            let whole = flatten(&draft, &Progress::default()).unwrap();
            for at in TileAt::covering(document.size.rect()) {
                let alone = PreparedDocument::new(&draft, &Progress::default()).unwrap();
                let alone = alone.flatten_tile(at).unwrap();
                assert!(alone.is_same(whole.tile(at).unwrap()), "{name}: {at:?}");
            }
        }
    }

    #[test]
    fn a_smaller_document_for_a_moment_shows_drafts_of_its_own_size() {
        for name in ["spin-blur", "zoom-blur", "lens-blur", "flow-blur"] {
            let document = on_ball(PictureFilter::from_name(name).unwrap());
            let small = DocumentReducer::new(0.5).of(&document).unwrap();
            let whole = document.scaled(0.5).unwrap();
            assert!(small.layers[2].content.filter() != whole.layers[2].content.filter());
            let apart = mean_difference(&bytes(&small), &bytes(&whole));
            assert!(apart < 2.0, "{name}: {apart} levels");
        }
    }
}
