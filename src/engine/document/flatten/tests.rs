//! Layers' arithmetic on tiny documents, against values computed by hand.

use super::*;
use crate::document::{Content, DerivedMask, Group, LayerMask, MaskKind, PixelLayer};
use crate::math::{Size, Vec3, srgb::Color, vec3};
use crate::raster::{BlendMode, Plane};
use crate::surface::{Maps, Surface};

const SIZE: Size = Size::new(100, 70);

fn color(text: &str) -> Color {
    Color::parse(text).unwrap()
}

fn fill(text: &str) -> Layer {
    Layer::new(text, Content::Fill(color(text)))
}

/// A paint layer that is one color in the columns left of `until`.
fn layer_left_of(until: usize, text: &str) -> Layer {
    let Color { r, g, b, a } = color(text);
    let (w, h) = (SIZE.width as usize, SIZE.height as usize);
    let rgba: Vec<u8> =
        (0..w * h).flat_map(|i| if i % w < until { [r, g, b, a] } else { [0; 4] }).collect();
    let tiles = TileGrid::from_straight_rgba(&rgba, w, h, 0, 0);
    Layer::new(text, Content::Pixels(PixelLayer { file: String::new(), x: 0, y: 0, tiles }))
}

fn group(layers: Vec<Layer>, pass_through: bool) -> Layer {
    let layers = layers.into_iter().map(Arc::new).collect();
    Layer::new("group", Content::Group(Group { layers, pass_through }))
}

fn with(mut layer: Layer, change: impl FnOnce(&mut Layer)) -> Layer {
    change(&mut layer);
    layer
}

fn document(layers: Vec<Layer>) -> Document {
    Document { layers: layers.into_iter().map(Arc::new).collect(), ..Document::empty(SIZE) }
}

fn picture(layers: Vec<Layer>) -> TileGrid {
    flatten(&document(layers), &Progress::default()).unwrap()
}

/// A flat surface in the columns left of 50, half covered at column 50, receding to the right.
fn half_a_surface() -> Arc<Surface> {
    let coverage =
        Plane::from_fn(SIZE, |x, _| [255, 128, 0][(x >= 50) as usize + (x > 50) as usize]);
    let normals = Plane::full(SIZE, vec3(0.6, 0.0, 0.8));
    let depth = Plane::from_fn(SIZE, |x, _| x as f32 / 100.0);
    Arc::new(Surface::new(Maps { normals, depth, coverage }).unwrap())
}

fn mask(kind: impl Into<MaskKind>) -> Option<LayerMask> {
    Some(LayerMask::new(kind))
}

fn left_mask() -> Option<LayerMask> {
    let coverage = Arc::new(Plane::from_fn(SIZE, |x, _| if x < 50 { 255 } else { 0 }));
    mask(MaskKind::File { file: "m.png".into(), coverage })
}

mod contours;
mod singles;

#[test]
fn a_tile_that_one_opaque_layer_fills_is_its_very_own_and_what_composing_gives() {
    let noise = |i: usize| (i.wrapping_mul(0x9e37_79b9) >> 7) as u8;
    let rgba: Vec<u8> =
        (0..128 * 70 * 4).map(|i| if i % 4 == 3 { 255 } else { noise(i) }).collect();
    let tiles = TileGrid::from_straight_rgba(&rgba, 128, 70, 0, 0);
    let opaque = Layer::new(
        "opaque",
        Content::Pixels(PixelLayer { file: String::new(), x: 0, y: 0, tiles }),
    );
    let (first, second) = (TileAt::new(0, 0), TileAt::new(0, 1));
    let prepared = |layers: Vec<Layer>| {
        PreparedDocument::new(&document(layers), &Progress::default()).unwrap()
    };
    let alone = prepared(vec![fill("#203040"), opaque.clone()]);
    let own = alone.sole_tile(first).unwrap();
    assert!(alone.compose_tile(first, None).quantize().unwrap().bytes() == own.bytes());
    assert!(alone.sole_tile(second).is_none(), "the canvas ends within the tile");
    let faint = with(opaque.clone(), |layer| layer.opacity = 0.5);
    let clipped = with(fill("#ffffff"), |layer| layer.clip_below = true);
    for layers in
        [vec![faint], vec![opaque.clone(), layer_left_of(30, "#ff0000")], vec![opaque, clipped]]
    {
        assert!(prepared(layers).sole_tile(first).is_none());
    }
}

#[test]
fn an_empty_document_is_transparent() {
    assert_eq!(picture(Vec::new()).iter().count(), 0);
}

#[test]
fn layers_stack_bottom_to_top_by_their_opacity() {
    let p = picture(vec![
        fill("#000000"),
        with(fill("#ffffff"), |l| l.opacity = 0.5),
        fill("#ff000040"),
    ]);
    // 127.5 · (1 − 64/255) = 95.5; red adds 64.
    assert_eq!(p.pixel(3, 5), [160, 96, 96, 255]);
    assert_eq!(p.pixel(99, 69), [160, 96, 96, 255]);
}

#[test]
fn a_hidden_layer_paints_nothing() {
    let p = picture(vec![fill("#102030"), with(fill("#ffffff"), |l| l.visible = false)]);
    assert_eq!(p.pixel(0, 0), [16, 32, 48, 255]);
}

#[test]
fn twenty_faint_layers_are_rounded_once() {
    let faint = || with(fill("#ffffff"), |l| l.opacity = 0.01);
    let p = picture(std::iter::once(fill("#000000")).chain((0..20).map(|_| faint())).collect());
    // 255 (1 − 0.99^20) = 46.4; rounding each would give 60 (3 a layer).
    assert_eq!(p.pixel(0, 0)[0], 46);
}

#[test]
fn a_file_mask_hides_where_it_is_black_and_inverted_where_it_is_white() {
    let masked = |invert| {
        with(fill("#ffffff"), |l| {
            l.mask = left_mask();
            l.mask.as_mut().unwrap().invert = invert;
        })
    };
    let p = picture(vec![fill("#000000"), masked(false)]);
    assert_eq!((p.pixel(49, 0)[0], p.pixel(50, 0)[0]), (255, 0));
    let p = picture(vec![fill("#000000"), masked(true)]);
    assert_eq!((p.pixel(49, 0)[0], p.pixel(50, 0)[0]), (0, 255));
}

#[test]
fn masks_derived_from_the_surface_follow_its_values() {
    let masked = |kind| Document {
        surface: Some(half_a_surface()),
        ..document(vec![with(fill("#ffffff"), |l| l.mask = mask(kind))])
    };
    let alpha = |kind, x| flatten(&masked(kind), &Progress::default()).unwrap().pixel(x, 0)[3];
    // f0 + (1 − f0) · 0.2⁵ = 0.1 + 0.9 · 0.00032, and with power 1: 0.1 + 0.9 · 0.2 = 0.28.
    assert_eq!(alpha(DerivedMask::Fresnel { f0: 0.1, power: 5.0 }, 10), 26);
    assert_eq!(alpha(DerivedMask::Fresnel { f0: 0.1, power: 1.0 }, 10), 71);
    // z = 0.25 is half way from 0 to 0.5, three quarters from 1 to 0.
    assert_eq!(alpha(DerivedMask::Depth { from: 0.0, to: 0.5 }, 25), 128);
    assert_eq!(alpha(DerivedMask::Depth { from: 1.0, to: 0.0 }, 25), 191);
    // A plane is flat: κ = 0.
    assert_eq!(
        alpha(DerivedMask::Curvature { scale: 4.0, blur: 0.0, from: -1.0, to: 1.0 }, 10),
        128
    );
}

#[test]
fn a_layer_clipped_to_the_surface_follows_its_coverage() {
    let surface = Some(half_a_surface());
    let flat = |layers| {
        flatten(&Document { surface: surface.clone(), ..document(layers) }, &Progress::default())
            .unwrap()
    };
    let p = flat(vec![fill("#ffffff")]);
    assert_eq!([49, 50, 51].map(|x| p.pixel(x, 9)[3]), [255, 128, 0]);
    assert!(p.tile(TileAt::new(1, 0)).is_none());
    let p = flat(vec![with(fill("#ffffff"), |l| l.clip_to_surface = false)]);
    assert_eq!(p.pixel(99, 9)[3], 255);
    // A group does not clip what its layers have clipped already.
    let p = flat(vec![group(vec![fill("#ffffff")], false)]);
    assert_eq!(p.pixel(50, 9)[3], 128);
}

#[test]
fn a_clipped_layer_stays_within_its_base() {
    let clipped = |l: Layer| with(l, |l| l.clip_below = true);
    let p = picture(vec![
        fill("#000000"),
        layer_left_of(50, "#0000ff80"),
        clipped(fill("#ff0000")),
        clipped(layer_left_of(20, "#00ff00")),
    ]);
    // The base's alpha is 128/255; its color is replaced entirely.
    assert_eq!(p.pixel(10, 0), [0, 128, 0, 255]);
    assert_eq!(p.pixel(30, 0), [128, 0, 0, 255]);
    assert_eq!(p.pixel(60, 0), [0, 0, 0, 255]);
}

#[test]
fn a_base_lends_its_blend_and_opacity_to_what_is_clipped_to_it() {
    let base =
        with(layer_left_of(50, "#ffffff"), |l| (l.blend, l.opacity) = (BlendMode::Multiply, 0.5));
    let p = picture(vec![fill("#808080"), base, with(fill("#000000"), |l| l.clip_below = true)]);
    // Multiplied by black at half opacity: half of 128.
    assert_eq!(p.pixel(0, 0), [64, 64, 64, 255]);
    assert_eq!(p.pixel(60, 0), [128, 128, 128, 255]);
}

#[test]
fn a_hidden_base_hides_its_clipped_layers() {
    let p = picture(vec![
        fill("#000000"),
        with(fill("#0000ff"), |l| l.visible = false),
        with(fill("#ff0000"), |l| l.clip_below = true),
    ]);
    assert_eq!(p.pixel(0, 0), [0, 0, 0, 255]);
}

#[test]
fn a_clipped_layer_with_nothing_beneath_paints_nothing() {
    let clipped = || with(fill("#ff0000"), |l| l.clip_below = true);
    assert_eq!(picture(vec![clipped()]).iter().count(), 0);
    // What counts is that its own group has nothing beneath it, not what is beneath the group.
    assert_eq!(
        picture(vec![fill("#000000"), group(vec![clipped()], true)]).pixel(0, 0),
        [0, 0, 0, 255]
    );
}

#[test]
fn an_isolated_group_blends_as_one_picture() {
    let inside = || vec![with(fill("#808080"), |l| l.blend = BlendMode::Multiply)];
    // Isolated, multiply has nothing beneath and lays its gray over the red; passed through, it
    // multiplies the red.
    assert_eq!(
        picture(vec![fill("#ff0000"), group(inside(), false)]).pixel(0, 0),
        [128, 128, 128, 255]
    );
    assert_eq!(picture(vec![fill("#ff0000"), group(inside(), true)]).pixel(0, 0), [128, 0, 0, 255]);
}

#[test]
fn a_pass_through_group_fades_between_before_and_after() {
    let faded = |pass_through| {
        let inside = vec![
            with(fill("#000000"), |l| l.blend = BlendMode::Multiply),
            group(vec![layer_left_of(50, "#00ff00")], true),
        ];
        with(group(inside, pass_through), |l| (l.opacity, l.mask) = (0.5, left_mask()))
    };
    let p = picture(vec![fill("#ff0000"), faded(true)]);
    assert_eq!(p.pixel(0, 0), [128, 128, 0, 255]);
    assert_eq!(p.pixel(60, 0), [255, 0, 0, 255]);
}

#[test]
fn a_group_can_be_clipped_and_clipped_to() {
    let inside = || vec![layer_left_of(50, "#ff0000"), layer_left_of(20, "#00ff00")];
    let p = picture(vec![
        layer_left_of(30, "#ffffff"),
        with(group(inside(), false), |l| l.clip_below = true),
    ]);
    assert_eq!([10, 25, 40].map(|x| p.pixel(x, 0)), [[0, 255, 0, 255], [255, 0, 0, 255], [0; 4]]);
    for pass_through in [false, true] {
        let p = picture(vec![
            group(inside(), pass_through),
            with(fill("#0000ff"), |l| l.clip_below = true),
        ]);
        assert_eq!(
            [10, 40, 60].map(|x| p.pixel(x, 0)),
            [[0, 0, 255, 255], [0, 0, 255, 255], [0; 4]]
        );
    }
}

#[test]
fn one_layer_can_be_flattened_alone() {
    let inner = with(layer_left_of(50, "#ff0000"), |l| {
        (l.visible, l.clip_below, l.opacity) = (false, true, 0.5)
    });
    let id = inner.id;
    let doc = document(vec![
        fill("#ffffff"),
        with(group(vec![fill("#00ff00"), inner], false), |l| l.opacity = 0.1),
    ]);
    let p = flatten_layer(&doc, id, &Progress::default()).unwrap();
    assert_eq!([p.pixel(10, 0), p.pixel(60, 0)], [[128, 0, 0, 128], [0; 4]]);
    assert!(flatten_layer(&doc, LayerId::fresh(), &Progress::default()).is_none());
}

#[test]
fn a_clipped_layer_left_out_does_not_come_between_the_base_and_what_is_clipped_to_it() {
    let clipped = |layer| with(layer, |l| l.clip_below = true);
    let hidden = with(clipped(fill("#00ff00")), |l| l.visible = false);
    let document = document(vec![layer_left_of(30, "#ff0000"), hidden, clipped(fill("#0000ff"))]);
    let selected = [document.layers[0].id, document.layers[2].id];
    let alone = flatten_layers(&document, &selected, &Progress::default()).unwrap();
    assert_eq!((alone.pixel(10, 10), alone.pixel(40, 10)), ([0, 0, 255, 255], [0; 4]));
}

#[test]
fn what_an_opaque_layer_hides_is_never_asked_for() {
    let prepared = PreparedDocument::new(
        &document(vec![fill("#00ff00"), fill("#ff0000"), layer_left_of(10, "#0000ff")]),
        &Progress::default(),
    );
    let prepared = prepared.unwrap();
    let mut pixels = PlanarTile::transparent();
    let composer = Composer {
        prepared: &prepared,
        at: TileAt::new(0, 0),
        far: None,
        sought: None,
        floats: None,
    };
    assert_eq!(composer.first_visible(&prepared.stack), 1);
    assert!(composer.stack(&prepared.stack, &mut pixels).is_continue());
    assert_eq!(pixels.rows()[0].pixel(20), [1.0, 0.0, 0.0, 1.0]);
}

#[test]
fn a_canceled_flattening_gives_nothing() {
    let progress = Progress::default();
    progress.cancel();
    assert!(flatten(&document(vec![fill("#ffffff")]), &progress).is_none());
}

#[test]
fn progress_counts_the_tiles() {
    let progress = Progress::default();
    flatten(&document(vec![fill("#ffffff")]), &progress);
    assert_eq!(progress.read(), (4, 4));
}

#[test]
fn the_bytes_do_not_depend_on_the_number_of_threads() {
    let layers = BlendMode::ALL.iter().enumerate().map(|(i, (mode, _))| {
        with(layer_left_of(5 * i + 10, "#80c04080"), |l| {
            (l.blend, l.opacity, l.blend_linear) = (*mode, 0.7, i % 5 == 0)
        })
    });
    let doc = document(std::iter::once(fill("#406080")).chain(layers).collect());
    let bytes = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| flatten(&doc, &Progress::default()).unwrap().to_straight_rgba(SIZE.rect()))
    };
    assert_eq!(bytes(1), bytes(2));
}

#[test]
fn the_brightest_pixel_beneath_an_adjustment_is_found_in_its_own_scope() {
    use crate::shading::RadianceScaling;
    let adjustment = || Layer::new("rs", Content::RadianceScaling(RadianceScaling::default()));
    let inner = group(vec![layer_left_of(30, "#808080"), adjustment(), fill("#ffffff")], false);
    let doc = document(vec![
        layer_left_of(50, "#ff0000"),
        inner,
        with(adjustment(), |l| l.visible = false),
        adjustment(),
    ]);
    let prepared = PreparedDocument::new(&doc, &Progress::default()).unwrap();
    // #808080 is 0.215861 of linear light; above the group everything is white.
    assert_eq!(prepared.beneath.len(), 2);
    assert!((prepared.beneath[0].brightest - 0.215_861).abs() < 1e-4, "{:?}", prepared.beneath);
    assert!((prepared.beneath[1].brightest - 1.0).abs() < 1e-3, "{:?}", prepared.beneath);
}

#[test]
fn the_brightest_pixel_is_sought_on_the_surface_only() {
    let lit = with(layer_left_of(100, "#808080"), |l| l.clip_to_surface = false);
    let beyond = with(fill("#ffffff"), |l| {
        l.clip_to_surface = false;
        l.mask = left_mask();
        l.mask.as_mut().unwrap().invert = true;
    });
    let adjustment =
        Layer::new("rs", Content::RadianceScaling(crate::shading::RadianceScaling::default()));
    // Half a pixel column (x = 50) of surface shows white; without a surface it counts, too.
    let slope = Plane::full(SIZE, Vec3::Z);
    let coverage = Plane::from_fn(SIZE, |x, _| if x < 50 { 255 } else { 0 });
    let surface =
        Surface::new(Maps { normals: slope, depth: Plane::full(SIZE, 0.5), coverage }).unwrap();
    let doc = document(vec![lit, beyond, adjustment]);
    let on_surface = Document { surface: Some(Arc::new(surface)), ..doc.clone() };
    let reference = |doc: &Document| {
        PreparedDocument::new(doc, &Progress::default()).unwrap().beneath[0].brightest
    };
    assert!((reference(&on_surface) - 0.215_861).abs() < 1e-4);
    assert!((reference(&doc) - 1.0).abs() < 1e-3);
}
