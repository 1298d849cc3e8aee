//! Small documents of changing ones: what is made again, and what is not.

use super::*;
use crate::document::{Live, PixelLayer, Progress, TransformShape, diff, flatten};
use crate::math::{srgb::Color, vec3};
use crate::paint::{Adjust, ImageFilter, PictureSource, PlacedImage, Placement};
use crate::raster::{Outside, Picture, Plane, Resampling, Tile};
use crate::surface::Maps;

fn fill(name: &str, v: u8) -> Layer {
    Layer::new(name, Content::Fill(Color { r: v, g: v, b: v, a: 255 }))
}

#[test]
fn what_did_not_change_is_the_very_same_and_the_picture_is_that_of_scaling() {
    let group = Layer::new(
        "group",
        Content::Group(Group { layers: vec![Arc::new(fill("in", 9))], pass_through: true }),
    );
    let layers = vec![Arc::new(fill("beneath", 40)), Arc::new(group)];
    let document = Document { layers, ..Document::empty(Size::new(300, 200)) };
    let mut reduced = DocumentReducer::new(0.5);
    let first = reduced.of(&document).unwrap();
    assert_eq!(first.size, Size::new(150, 100));
    let inner = document.layer_named("in").unwrap().id;
    let changed = document.with_layer(inner, |layer| layer.opacity = 0.5).unwrap();
    let second = reduced.of(&changed).unwrap();
    assert!(Arc::ptr_eq(&first.layers[0], &second.layers[0]));
    assert!(!diff(&first, &second).is_empty());
    assert!(diff(&second, &reduced.of(&changed).unwrap()).is_empty());
    let (ours, whole) = (
        flatten(&second, &Progress::default()),
        flatten(&changed.scaled(0.5).unwrap(), &Progress::default()),
    );
    let area = second.size.rect();
    assert!(ours.unwrap().to_straight_rgba(area) == whole.unwrap().to_straight_rgba(area));
}

#[test]
fn pictures_of_a_draft_are_read_as_coarsely_as_its_pixels_are() {
    let size = Size::new(256, 128);
    let texels =
        (0..size.area()).map(|i| if i % 2 == 0 { [255; 4] } else { [0, 0, 0, 255] }).collect();
    let picture = Picture::srgb8(size, texels).unwrap();
    let levels = |scale: f32, filter: ImageFilter| {
        let image = PlacedImage {
            source: PictureSource::new("stripes".into(), picture.clone(), Adjust::default()),
            placement: Placement { scale, ..Placement::covering(size) },
            outside: Outside::Mirror,
            bend: Default::default(),
            filter,
            frame: Default::default(),
        };
        let layers = vec![Arc::new(Layer::new("image", Content::Image(Live::new(image))))];
        let document = Document { layers, ..Document::empty(size) };
        let width = |document: &Document| match &document.layers[0].content {
            Content::Image(live) => live.params().source.texture().size().width,
            _ => 0,
        };
        let small = DocumentReducer::new(0.25).of(&document).unwrap();
        let gray = flatten(&small, &Progress::default()).unwrap().pixel(32, 16);
        assert!(
            filter == ImageFilter::Bilinear || scale > 1.0 || gray[0].abs_diff(128) < 4,
            "{gray:?}"
        );
        (width(&small), width(&document.scaled(0.25).unwrap()))
    };
    assert_eq!(levels(1.0, ImageFilter::Antialias), (64, 256), "a print reads all");
    assert_eq!(levels(2.0, ImageFilter::Antialias), (128, 256), "magnified twice");
    assert_eq!(levels(9.0, ImageFilter::Antialias), (256, 256));
    assert_eq!(levels(1.0, ImageFilter::Bilinear), (256, 256));
}

#[test]
fn a_transform_that_a_hand_drags_is_sampled_quickly_and_its_pixels_are_made_small_once() {
    let size = Size::new(192, 128);
    let rgba: Vec<u8> =
        (0..size.area() as u32).flat_map(|i| [(i * 37) as u8, (i * 11) as u8, 90, 255]).collect();
    let tiles = crate::raster::TileGrid::from_straight_rgba(&rgba, 192, 128, 0, 0);
    let paint = Layer::new("paint", Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() }));
    let turned = |degrees: f64, filter: Resampling| {
        let map = crate::math::PlaneMap::rotation(degrees, size.center());
        let shape = TransformShape::Matrix(map.coefficients().unwrap());
        Layer { transform: Some(LayerTransform { shape, filter }), ..paint.clone() }
    };
    let document =
        |layer: Layer| Document { layers: vec![Arc::new(layer)], ..Document::empty(size) };
    let filter = |document: &Document| document.layers[0].transform.as_ref().unwrap().filter;
    let rest = document(turned(3.0, Resampling::Smooth));
    let mut reduced = DocumentReducer::new(1.0);
    reduced.keep(&rest);
    assert_eq!(filter(&reduced.of(&rest).unwrap()), Resampling::Smooth);
    assert_eq!(
        filter(&reduced.of(&document(turned(4.0, Resampling::Smooth))).unwrap()),
        Resampling::Linear
    );
    assert_eq!(
        filter(&reduced.of(&document(turned(5.0, Resampling::Nearest))).unwrap()),
        Resampling::Nearest
    );
    let mut half = DocumentReducer::new(0.5);
    let drafts =
        [6.0, 7.0].map(|degrees| half.of(&document(turned(degrees, Resampling::Sharp))).unwrap());
    assert!(drafts.iter().all(|draft| filter(draft) == Resampling::Linear));
    assert!(drafts[0].layers[0].content.is_identical(&drafts[1].layers[0].content));
    let scaled = document(turned(7.0, Resampling::Linear)).scaled(0.5).unwrap();
    let bytes = |document: &Document| {
        flatten(document, &Progress::default()).unwrap().to_straight_rgba(size.rect())
    };
    assert!(bytes(&drafts[1]) == bytes(&scaled));
}

#[test]
fn what_a_hand_drags_is_read_coarsely_in_its_own_size_and_the_rest_stays_as_it_is() {
    let size = Size::new(96, 64);
    let texel = |i: usize| [(i * 37) as u8, (i * 101) as u8, (i * 11) as u8, 255];
    let picture = Picture::srgb8(Size::new(900, 600), (0..900 * 600).map(texel).collect()).unwrap();
    let image = |name: &str| {
        let image = PlacedImage {
            source: PictureSource::new("noise".into(), picture.clone(), Adjust::default()),
            placement: Placement::covering(size),
            outside: Outside::Mirror,
            bend: Default::default(),
            filter: ImageFilter::Antialias,
            frame: Default::default(),
        };
        Arc::new(Layer::new(name, Content::Image(Live::new(image))))
    };
    let group = |layers| {
        Arc::new(Layer::new("group", Content::Group(Group { layers, pass_through: false })))
    };
    let layers = vec![
        Arc::new(fill("ground", 9)),
        group(vec![image("at rest")]),
        group(vec![image("dragged")]),
    ];
    let document = Document { layers, ..Document::empty(size) };
    let mut reduced = DocumentReducer::new(1.0);
    reduced.keep(&document);
    let kept = reduced.of(&document).unwrap();
    assert!(kept.layers.iter().zip(&document.layers).all(|(a, b)| Arc::ptr_eq(a, b)));
    let id = document.layer_named("dragged").unwrap().id;
    let next = document.with_layer(id, |layer| layer.content = image("").content.clone()).unwrap();
    let draft = reduced.of(&next).unwrap();
    let same: Vec<bool> =
        draft.layers.iter().zip(&next.layers).map(|(a, b)| Arc::ptr_eq(a, b)).collect();
    assert_eq!(same, [true, true, false]);
    let bytes = |document: &Document| {
        flatten(document, &Progress::default()).unwrap().to_straight_rgba(size.rect())
    };
    let (coarse, fine) = (bytes(&draft), bytes(&next));
    let apart = coarse.iter().zip(&fine).map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>()
        / fine.len() as f64;
    assert!(apart > 0.1 && apart < 12.0, "{apart}");
    assert!(bytes(&document) == fine, "at rest nothing is coarser");
    assert!(
        Arc::ptr_eq(&reduced.of(&next).unwrap().layers[2], &draft.layers[2]),
        "it is made once"
    );
}

#[test]
fn a_surface_made_small_elsewhere_is_taken_in_and_not_made_again() {
    let size = Size::new(300, 200);
    let normals = Plane::from_fn(size, |x, _| vec3((0.1 * x as f32).sin(), 0.0, 1.0));
    let maps = Maps { normals, depth: Plane::full(size, 0.5), coverage: Plane::full(size, 255) };
    let document =
        Document { surface: Surface::new(maps).ok().map(Arc::new), ..Document::empty(size) };
    let mut reduced = DocumentReducer::new(0.5);
    let missing = reduced.missing_surface(&document).unwrap();
    assert!(missing.is_same(&reduced.missing_surface(&document).unwrap()));
    let made = missing.make().unwrap();
    let small = made.small.clone();
    reduced.take_surface(made);
    assert!(reduced.missing_surface(&document).is_none() && !reduced.prepare(&document));
    assert!(Arc::ptr_eq(reduced.of(&document).unwrap().surface.as_ref().unwrap(), &small));
    assert!(
        DocumentReducer::new(1.0).missing_surface(&document).is_none(),
        "nothing is to be made small"
    );
}

#[test]
fn what_was_prepared_part_by_part_is_not_made_again() {
    let document = Document {
        layers: vec![Arc::new(fill("beneath", 40)), Arc::new(fill("above", 90))],
        ..Document::empty(Size::new(300, 200))
    };
    let mut reduced = DocumentReducer::new(0.5);
    assert!(
        reduced.prepare(&document) && reduced.prepare(&document) && !reduced.prepare(&document)
    );
    let made: Vec<_> =
        document.layers.iter().map(|layer| reduced.layers[&layer.id].made.clone()).collect();
    let small = reduced.of(&document).unwrap();
    assert!(small.layers.iter().zip(&made).all(|(a, b)| Arc::ptr_eq(a, b)));
    let changed = document.with_layer(document.layers[1].id, |layer| layer.opacity = 0.5).unwrap();
    assert!(reduced.prepare(&changed) && !reduced.prepare(&changed), "only the layer that changed");
}

#[test]
fn a_large_paint_layer_is_made_small_in_several_goes_with_the_same_tiles() {
    let size = Size::new(2400, 2200);
    let mut tiles = TileGrid::default();
    tiles.reserve(size.rect());
    for (k, at) in TileAt::covering(size.rect()).enumerate().filter(|(k, _)| k % 3 != 0) {
        tiles.set(
            at,
            Tile::from_bytes([k as u8 / 2, k as u8 / 3, 0, 200].repeat(64 * 64)).map(Arc::new),
        );
    }
    let paint = Layer::new(
        "paint",
        Content::Pixels(PixelLayer { tiles, x: 3, y: 5, ..PixelLayer::default() }),
    );
    let document = Document { layers: vec![Arc::new(paint)], ..Document::empty(size) };
    let mut reduced = DocumentReducer::new(0.5);
    assert!(
        reduced.prepare(&document) && reduced.begun.is_some(),
        "342 small tiles are not made in one go"
    );
    assert!(reduced.prepare(&document) && reduced.begun.is_none() && !reduced.prepare(&document));
    let (parts, whole) =
        (reduced.of(&document).unwrap(), DocumentReducer::new(0.5).of(&document).unwrap());
    let (Content::Pixels(a), Content::Pixels(b)) =
        (&parts.layers[0].content, &whole.layers[0].content)
    else {
        panic!()
    };
    assert_eq!((a.x, a.y, a.tiles.bounds()), (b.x, b.y, b.tiles.bounds()));
    let bytes = |grid: &TileGrid, at| grid.tile(at).map(|tile| tile.bytes().to_vec());
    assert!(TileAt::covering(size.rect()).all(|at| bytes(&a.tiles, at) == bytes(&b.tiles, at)));
    // Another version of the layer before all is made.
    let mut anew = DocumentReducer::new(0.5);
    assert!(anew.prepare(&document));
    let faint = document.with_layer(document.layers[0].id, |layer| layer.opacity = 0.5).unwrap();
    assert!(anew.prepare(&faint) && anew.prepare(&faint) && !anew.prepare(&faint));
    assert_eq!(anew.of(&faint).unwrap().layers[0].opacity, 0.5);
}

#[test]
fn parts_that_a_hand_drags_are_shaped_small_and_those_at_rest_are_not_made_again() {
    use crate::document::parts::{Inflation, OutlineSource, PartKind};
    use crate::math::vec2;
    let disc = |x: f32, r: f32| {
        let at = |i: usize| vec2(x, 120.0) + r * crate::math::Vec2::from_angle(i as f32 * 0.1);
        OutlineSource::Path((0..63).map(at).collect())
    };
    let part = |id: &str, x: f32, puff: f32| {
        let inflation = Inflation { puff, ..Inflation::default() };
        Part::new(id, PartKind::Inflate { outline: disc(x, 60.0), inflation })
    };
    let document = Document::empty(Size::new(400, 240));
    let document = document.with_part(part("a", 100.0, 1.0)).with_part(part("b", 280.0, 1.0));
    let mut reduced = DocumentReducer::new(0.5);
    let dragged = document.with_part_ahead(part("a", 100.0, 0.4));
    assert!(
        dragged.is_ahead()
            && !dragged.is_shaped()
            && Arc::ptr_eq(dragged.surface.as_ref().unwrap(), document.surface.as_ref().unwrap())
    );
    let small = reduced.of(&dragged).unwrap();
    let apart = |small: &Document, puff: f32| {
        let whole = document.with_part(part("a", 100.0, puff)).scaled(0.5).unwrap();
        let (a, b) = (small.surface.as_ref().unwrap(), whole.surface.as_ref().unwrap());
        let at = |s: &Surface, x, y| s.normal(x, y);
        [(30, 50), (60, 70), (140, 60), (160, 80)].map(|(x, y)| at(a, x, y).distance(at(b, x, y)))
    };
    assert!(apart(&small, 0.4).iter().all(|d| *d < 1e-3), "{:?}", apart(&small, 0.4));
    let b = small.part_areas()[1].1.clone();
    let next = reduced.of(&document.with_part_ahead(part("a", 100.0, 0.7))).unwrap();
    assert!(
        apart(&next, 0.7).iter().all(|d| *d < 1e-3) && Arc::ptr_eq(&next.part_areas()[1].1, &b)
    );
    // At rest it is the same surface as if it had been made directly.
    let rested = dragged.reshaped();
    let at_once = document.with_part(part("a", 100.0, 0.4));
    assert!(rested.is_shaped() && rested.parts.list.len() == 2);
    let normals = |document: &Document| {
        document.surface.as_ref().unwrap().normal_planes().map(|p| p.values().to_vec())
    };
    assert!(normals(&rested) == normals(&at_once));
}
