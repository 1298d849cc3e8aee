//! What outlines a part is what its layer shows: every edit of it gives the surface that a file
//! would be read with.

use super::*;
use crate::document::parts::{FlatColor, Inflation, OutlineSource, PartKind};
use crate::document::{
    History, LayerMask, Live, MaskKind, Mesh, MeshFrame, PixelLayer, StrokeList, TransformShape,
    flatten,
};
use crate::math::srgb::Color;
use crate::math::{Affine2, Rect, Size, Vec2, vec2};
use crate::paint::{Attachment, Brush, Sample, Stroke};
use crate::raster::{Lattice, Plane, Resampling};
use crate::surface::{Operator, Surface};

const SIZE: Size = Size::new(160, 120);
const ORANGE: Color = Color { r: 200, g: 90, b: 40, a: 255 };
const GREEN: Color = Color { r: 20, g: 90, b: 40, a: 255 };

fn discs(name: &str, discs: &[(Vec2, f32, Color)]) -> Layer {
    let mut rgba = vec![0u8; SIZE.area() * 4];
    for (i, pixel) in rgba.as_chunks_mut::<4>().0.iter_mut().enumerate() {
        let p =
            vec2((i % SIZE.width as usize) as f32 + 0.5, (i / SIZE.width as usize) as f32 + 0.5);
        if let Some((.., color)) = discs.iter().rev().find(|(c, r, _)| p.distance(*c) < *r) {
            *pixel = [color.r, color.g, color.b, color.a];
        }
    }
    let tiles =
        TileGrid::from_straight_rgba(&rgba, SIZE.width as usize, SIZE.height as usize, 0, 0);
    Layer::new(name, Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() }))
}

fn group(name: &str, layers: Vec<Layer>) -> Layer {
    let layers = layers.into_iter().map(Arc::new).collect();
    Layer::new(name, Content::Group(Group { layers, pass_through: false }))
}

fn stroke(y: f32) -> Arc<Stroke> {
    let samples = [30.0, 120.0].map(|x| Sample::at(vec2(x, y))).to_vec();
    Arc::new(Stroke::new(Brush { size: 14.0, ..Brush::default() }, Operator::None, ORANGE, samples))
}

fn part(id: &str, outline: OutlineSource) -> Arc<Part> {
    Arc::new(Part::new(id, PartKind::Inflate { outline, inflation: Inflation::default() }))
}

/// Parts of two colors of a paint layer, of strokes, and of a group; all layers are in a group.
fn drawing() -> Document {
    let flats =
        discs("Flats", &[(vec2(50.0, 40.0), 24.0, ORANGE), (vec2(110.0, 40.0), 20.0, GREEN)]);
    let strokes = Layer::new(
        "Strokes",
        Content::Strokes(Live::new(StrokeList { strokes: vec![stroke(85.0)] })),
    );
    let inner = vec![
        discs("Left", &[(vec2(60.0, 100.0), 15.0, ORANGE)]),
        discs("Right", &[(vec2(80.0, 100.0), 15.0, GREEN)]),
    ];
    let all = group("All", vec![flats, strokes, group("Pair", inner)]);
    let of = |layer: &str, color: Option<Color>| OutlineSource::Layer {
        layer: layer.into(),
        color: color.map(FlatColor::from),
    };
    let flat = Document { layers: vec![Arc::new(all)], ..Document::empty(SIZE) };
    flat.with_parts(vec![
        part("green", of("Flats", Some(GREEN))),
        part("strokes", of("Strokes", None)),
        part("pair", of("Pair", None)),
        part("orange", of("Flats", Some(ORANGE))),
    ])
}

/// The same as a file would be read: nothing is known of what was made before.
fn without_caches(document: &Document) -> Document {
    let (surface, list) = (document.maps_surface().cloned(), document.parts.list.clone());
    let layers = document.layers.iter().map(without_cache).collect();
    Document { surface, parts: Arc::default(), layers, ..document.clone() }.with_parts(list)
}

fn without_cache(layer: &Arc<Layer>) -> Arc<Layer> {
    let mut next = Layer { cache: LayerCache::default(), ..Layer::clone(layer) };
    match &mut next.content {
        Content::Group(group) => group.layers = group.layers.iter().map(without_cache).collect(),
        Content::Strokes(live) => *live = Live::new(live.params().clone()),
        _ => {}
    }
    Arc::new(next)
}

fn is_equal(a: &Surface, b: &Surface) -> bool {
    a.has_same_maps(b)
}

fn lattice(by: Vec2) -> Option<Arc<Lattice>> {
    let mut lattice = Lattice::default();
    lattice.change(Rect::new(20, 10, 140, 115), |_, _, _| by);
    Some(Arc::new(lattice))
}

fn mesh(by: Vec2) -> Option<LayerTransform> {
    let even = Mesh::even(4, 4, MeshFrame::of(SIZE)).unwrap();
    let moved = |(k, p): (usize, &Vec2)| if [5, 6].contains(&k) { *p + by } else { *p };
    let points = even.points().iter().enumerate().map(moved).collect();
    let shape = TransformShape::Mesh(Arc::new(even.with_points(points).unwrap()));
    Some(LayerTransform { shape, filter: Resampling::Smooth })
}

fn matrix(by: Vec2) -> Option<LayerTransform> {
    let shape = TransformShape::Matrix([1.0, 0.1, -0.1, 0.9, by.x.into(), by.y.into()]);
    Some(LayerTransform { shape, filter: Resampling::Smooth })
}

fn half_mask() -> Option<LayerMask> {
    let coverage = Arc::new(Plane::from_fn(SIZE, |x, _| if x < 70 { 255 } else { 0 }));
    Some(LayerMask::new(MaskKind::File { file: String::new(), coverage }))
}

type LayerEdit = (&'static str, fn(&mut Layer));

/// Everything that can change what a layer shows.
const EDITS: [LayerEdit; 14] = [
    ("liquify", |layer| layer.liquify = lattice(vec2(7.0, -4.0))),
    ("more liquify", |layer| layer.liquify = lattice(vec2(-5.0, 6.0))),
    ("no liquify", |layer| layer.liquify = None),
    ("a mesh", |layer| layer.transform = mesh(vec2(12.0, 9.0))),
    ("another mesh", |layer| layer.transform = mesh(vec2(-9.0, 5.0))),
    ("a mesh and liquify", |layer| layer.liquify = lattice(vec2(3.0, 3.0))),
    ("a matrix", |layer| (layer.transform, layer.liquify) = (matrix(vec2(5.0, 3.0)), None)),
    ("a mask", |layer| layer.mask = half_mask()),
    ("less opacity", |layer| layer.opacity = 0.4),
    ("a mask and liquify", |layer| layer.liquify = lattice(vec2(7.0, -4.0))),
    ("hidden", |layer| layer.visible = false),
    ("on a part", |layer| {
        layer.on = Some(Attachment { matrix: Affine2::IDENTITY, ..Attachment::on("orange") })
    }),
    ("another name", |layer| layer.name.push_str(" 2")),
    ("nothing else", |layer| {
        *layer = Layer { id: layer.id, ..Layer::new(layer.name.clone(), layer.content.clone()) }
    }),
];

#[test]
fn whatever_changes_what_a_layer_shows_the_surface_is_that_of_the_file() {
    let document = drawing();
    let mut differing = 0;
    for name in ["All", "Flats", "Strokes", "Pair", "Left"] {
        let mut shaped = document.clone();
        for (what, edit) in EDITS {
            let id = document.layer_named(name).unwrap().id;
            let edited = shaped.with_layer(id, edit).unwrap();
            let before = shaped.surface.clone().unwrap();
            shaped = edited.reshaped();
            let (now, file) =
                (shaped.surface.clone().unwrap(), without_caches(&edited).surface.unwrap());
            assert!(is_equal(&now, &file), "“{name}” with {what}");
            // Not shaped means that the surface may be another; it is never another without being
            // told.
            assert!(shaped.is_shaped(), "“{name}” with {what}");
            assert!(
                !edited.is_shaped() || is_equal(&before, &now),
                "“{name}” with {what}: silently another"
            );
            differing += usize::from(!is_equal(&before, &now));
        }
    }
    assert!(differing > 30, "only {differing} edits changed the surface");
}

#[test]
fn what_changes_no_outline_makes_nothing_again() {
    let document = drawing();
    let id = document.layer_named("Flats").unwrap().id;
    for (what, edit) in EDITS
        .iter()
        .filter(|(what, _)| ["a mask", "less opacity", "hidden", "another name"].contains(what))
    {
        let edited = document.with_layer(id, edit).unwrap();
        // Parts name the layer, so they change with its name.
        assert!(edited.is_shaped() || *what == "another name", "{what}");
        assert!(
            Arc::ptr_eq(
                edited.reshaped().surface.as_ref().unwrap(),
                document.surface.as_ref().unwrap()
            ),
            "{what}"
        );
    }
}

#[test]
fn a_layer_that_its_part_carries_is_not_moved_twice_where_it_is_bent() {
    let flats = discs("Flats", &[(vec2(50.0, 40.0), 24.0, ORANGE)]);
    let id = flats.id;
    let flat = Document { layers: vec![Arc::new(flats)], ..Document::empty(SIZE) };
    let outline = OutlineSource::Layer { layer: "Flats".into(), color: None };
    let mut moved = Part::clone(&part("a", outline));
    let document = flat.with_parts(vec![Arc::new(moved.clone())]);
    let bent = document
        .with_layer(id, |layer| layer.liquify = lattice(vec2(-6.0, 0.0)))
        .unwrap()
        .reshaped();
    let bent = bent.with_layer_on(id, Some("a")).unwrap().reshaped();
    moved.matrix = Affine2::from_translation(vec2(40.0, 20.0));
    let moved = bent.with_part(moved);
    let pixels = flatten(&moved, &Progress::default()).unwrap();
    let surface = moved.surface.as_ref().unwrap();
    let painted = |x: usize, y: usize| pixels.pixel(x as i32, y as i32)[3] > 127;
    let covered = |x: usize, y: usize| surface.coverage(x, y) > 127;
    let (mut both, mut one) = (0, 0);
    for (x, y) in (0..120).flat_map(|y| (0..160).map(move |x| (x, y))) {
        both += usize::from(painted(x, y) && covered(x, y));
        one += usize::from(painted(x, y) != covered(x, y));
    }
    assert!(both > 1500 && one < 60, "paint and shape meet in {both} pixels, and differ in {one}");
}

#[test]
fn a_history_holds_shapes_and_not_what_is_to_become_one() {
    let document = drawing();
    let id = document.layer_named("Flats").unwrap().id;
    let flat = Document { surface: None, ..document.clone() };
    let mut history = History::new(flat.clone(), 10);
    assert!(!flat.is_shaped() && history.present().is_shaped());
    let bent =
        history.present().with_layer(id, |layer| layer.liquify = lattice(vec2(7.0, -4.0))).unwrap();
    history.commit("Liquify", bent.clone(), ());
    let anew = |document: &Document| without_caches(document).surface.unwrap();
    assert!(is_equal(history.present().surface.as_ref().unwrap(), &anew(&bent)));
    history.undo();
    assert!(is_equal(history.present().surface.as_ref().unwrap(), &anew(&document)));
}

#[test]
fn a_shape_that_its_parts_do_not_make_is_a_difference() {
    let document = drawing();
    let id = document.layer_named("Flats").unwrap().id;
    let bent = document.with_layer(id, |layer| layer.liquify = lattice(vec2(7.0, -4.0))).unwrap();
    let file = without_caches(&bent);
    assert_eq!(bent.difference(&file).as_deref(), Some("the shape that its parts make"));
    assert_eq!(bent.reshaped().difference(&file), None);
}

#[test]
fn what_was_erased_leaves_no_trace_in_the_shape() {
    let document = drawing();
    let id = document.layer_named("Flats").unwrap().id;
    let with_tile = |tile: Option<Arc<Tile>>| {
        let put = |layer: &mut Layer| {
            if let Content::Pixels(pixels) = &mut layer.content {
                pixels.tiles.set(TileAt::new(10, 10), tile.clone());
            }
        };
        document.with_layer(id, put).unwrap().reshaped().surface.unwrap()
    };
    let erased = Tile::from_bytes(vec![0; TILE_AREA * 4]).map(Arc::new);
    assert!(erased.is_some() && is_equal(&with_tile(erased), &with_tile(None)));
}

#[test]
fn one_layer_alone_is_seen_on_the_surface_of_the_whole_drawing() {
    let document = drawing();
    let left = document.layer_named("Left").unwrap().id;
    let alone = document.with_only(&[left]).unwrap();
    assert!(alone.is_shaped());
    assert!(Arc::ptr_eq(
        alone.reshaped().surface.as_ref().unwrap(),
        document.surface.as_ref().unwrap()
    ));
}
