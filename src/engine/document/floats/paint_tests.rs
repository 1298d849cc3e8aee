//! Paint layers keep what was painted softly: compared with what floats give, and with what bytes
//! would.

use crate::document::{
    Content, Document, Group, Highlights, Layer, Live, PixelLayer, Progress, StrokeList, flatten,
};
use crate::document::{flatten_to_floats, flatten_to_paint};
use crate::math::{Size, Vec2, hash, srgb::Color, vec2};
use crate::paint::stroke::{ActiveStrokes, Backdrop};
use crate::paint::{
    ActiveRetouching, Brush, BrushMode, Curve, Dynamics, Input, Property, Sample, Scene, Stroke,
};
use crate::raster::{BlendMode, Tile, TileAt, TileGrid};
use crate::surface::Operator;
use std::collections::BTreeSet;
use std::sync::Arc;

const SIZE: Size = Size::new(192, 160);

fn stroke(brush: &Brush, color: Color, path: &[Vec2]) -> Stroke {
    Stroke::new(
        brush.clone(),
        Operator::None,
        color,
        path.iter().copied().map(Sample::at).collect(),
    )
}

/// A paint layer's pixels after some more strokes, one after the other.
fn paint_strokes(mut tiles: TileGrid, strokes: impl IntoIterator<Item = Stroke>) -> TileGrid {
    let scene = Scene { size: SIZE, surface: None };
    for stroke in strokes {
        let mut active = ActiveStrokes::new(
            std::slice::from_ref(&stroke),
            Backdrop::Pixels(tiles.clone()),
            &scene,
        );
        let mut changed = active.draw(&[stroke.samples().to_vec()]);
        changed.extend(active.draw(&[Vec::new()]));
        changed.into_iter().for_each(|(at, tile)| tiles.set(at, tile));
    }
    tiles
}

fn paint(tiles: TileGrid) -> Layer {
    Layer::new("paint", Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() }))
}

fn document(layers: Vec<Layer>) -> Document {
    Document { layers: layers.into_iter().map(Arc::new).collect(), ..Document::empty(SIZE) }
}

fn tiles16(tiles: &TileGrid) -> usize {
    tiles.iter().filter(|(_, tile)| tile.is_16_bit()).count()
}

/// The same without what bytes cannot hold.
fn in_bytes(tiles: &TileGrid) -> TileGrid {
    let mut out = TileGrid::default();
    tiles
        .iter()
        .for_each(|(at, tile)| out.set(at, Tile::from_pixels(tile.bytes().to_vec()).map(Arc::new)));
    out
}

fn levels(values: impl Iterator<Item = u32>) -> usize {
    values.collect::<BTreeSet<u32>>().len()
}

#[test]
fn four_hundred_dabs_of_less_than_half_a_percent_reach_what_they_should() {
    let brush = Brush { size: 30.0, hardness: 1.0, flow: 0.004, ..Brush::default() };
    let dab = || stroke(&brush, Color::WHITE, &[vec2(60.5, 60.5)]);
    let tiles = paint_strokes(TileGrid::default(), (0..400).map(|_| dab()));
    let (found, wanted) = (f32::from(tiles.pixel16(60, 60)[3]) / 65535.0, 1.0 - 0.996f32.powi(400));
    assert!((found - wanted).abs() < 0.5 / 255.0, "{found} for {wanted}");
    assert_eq!(tiles.pixel(60, 60)[3], (wanted * 255.0).round() as u8, "the screen sees it, too");
}

#[test]
fn an_eraser_of_less_than_half_a_percent_erases() {
    let full = Brush { size: 60.0, hardness: 1.0, ..Brush::default() };
    let opaque =
        paint_strokes(TileGrid::default(), [stroke(&full, Color::WHITE, &[vec2(60.5, 60.5)])]);
    assert_eq!((opaque.pixel(60, 60), tiles16(&opaque)), ([255; 4], 0));
    let brush = Brush { size: 30.0, hardness: 1.0, flow: 0.004, erases: true, ..Brush::default() };
    let rubbed =
        paint_strokes(opaque, (0..400).map(|_| stroke(&brush, Color::WHITE, &[vec2(60.5, 60.5)])));
    let (found, wanted) = (f32::from(rubbed.pixel16(60, 60)[3]) / 65535.0, 0.996f32.powi(400));
    assert!((found - wanted).abs() < 0.5 / 255.0, "{found} for {wanted}");
    assert_eq!(rubbed.pixel(40, 60), [255; 4]);
}

#[test]
fn paint_too_faint_for_a_byte_is_kept_until_more_of_it_is_seen() {
    let brush = Brush { size: 30.0, hardness: 1.0, flow: 0.001, ..Brush::default() };
    let once =
        paint_strokes(TileGrid::default(), [stroke(&brush, Color::WHITE, &[vec2(30.5, 30.5)])]);
    assert_eq!((once.pixel(30, 30), once.pixel16(30, 30)), ([0; 4], [66; 4]));
    let often =
        paint_strokes(once, (0..99).map(|_| stroke(&brush, Color::WHITE, &[vec2(30.5, 30.5)])));
    assert_eq!(often.pixel(30, 30)[3], (255.0 * (1.0 - 0.999f32.powi(100))).round() as u8);
}

#[test]
fn faint_paint_burns_colors_as_floats_do() {
    let brush = Brush { size: 90.0, hardness: 0.0, flow: 0.03, spacing: 0.1, ..Brush::default() };
    let strokes: Vec<Stroke> = (0..6)
        .map(|i| {
            let color = Color { r: 4 + 5 * i, g: 20, b: 60 - 9 * i, a: 255 };
            let at = |j: u32| {
                vec2(190.0 * hash::unit(i.into(), j, 0), 160.0 * hash::unit(i.into(), j, 1))
            };
            stroke(&brush, color, &[at(0), at(1)])
        })
        .collect();
    let tiles = paint_strokes(TileGrid::default(), strokes.clone());
    let ground = || Layer::new("ground", Content::Fill(Color { r: 250, g: 240, b: 225, a: 255 }));
    let burning =
        |layer: Layer| document(vec![ground(), Layer { blend: BlendMode::ColorBurn, ..layer }]);
    let list = StrokeList { strokes: strokes.into_iter().map(Arc::new).collect() };
    let live = burning(Layer::new("strokes", Content::Strokes(Live::new(list))));
    let floats = flatten_to_floats(&live, Highlights::Clipped, &Progress::default()).unwrap();
    let farthest = |tiles: TileGrid| {
        let shown = flatten(&burning(paint(tiles)), &Progress::default()).unwrap();
        let apart = |(i, p): (usize, &[f32; 4])| {
            let byte = shown.pixel(i as i32 % SIZE.width as i32, i as i32 / SIZE.width as i32);
            p.iter().zip(byte).map(|(f, b)| (f * 255.0 - f32::from(b)).abs()).fold(0.0, f32::max)
        };
        floats.iter().enumerate().map(apart).fold(0.0, f32::max)
    };
    let (of_bytes, of_paint) = (farthest(in_bytes(&tiles)), farthest(tiles));
    assert!(of_bytes > 8.0, "the case tells bytes from floats: {of_bytes}");
    assert!(of_paint <= 1.0, "{of_paint} of 255");
}

#[test]
fn an_airbrush_over_sixty_strokes_has_no_bands() {
    let brush = Brush { size: 150.0, hardness: 0.0, flow: 0.004, spacing: 0.1, ..Brush::default() };
    let lines = (0..60)
        .map(|i| stroke(&brush, Color::BLACK, &[vec2(20.0 + i as f32, -40.0), vec2(20.0, 200.0)]));
    let tiles = paint_strokes(TileGrid::default(), lines);
    let document = document(vec![Layer::new("paper", Content::Fill(Color::WHITE)), paint(tiles)]);
    let floats = flatten_to_floats(&document, Highlights::Clipped, &Progress::default()).unwrap();
    let shown = flatten(&document, &Progress::default()).unwrap();
    let all = levels(floats.iter().map(|p| (p[0] * 65535.0).round() as u32));
    let few = levels(
        shown.iter().flat_map(|(_, tile)| tile.bytes().chunks_exact(4)).map(|p| p[0].into()),
    );
    assert!(all >= 10 * few, "{all} levels of 16 bits, {few} of 8");
}

#[test]
fn inked_lines_stay_in_bytes_whatever_they_cross() {
    let mut tiles = TileGrid::default();
    for (i, (size, hardness)) in
        [(1.0, 1.0), (2.5, 1.0), (6.0, 0.9), (14.0, 1.0), (40.0, 0.95)].into_iter().enumerate()
    {
        let dynamics = Dynamics::none().with(Property::Size, Input::Pressure, Curve::Share(0.85));
        let brush = Brush { size, hardness, dynamics, ..Brush::default() };
        let lines = (0..30u32).map(|k| {
            let at = |j: u32| {
                220.0 * vec2(hash::unit(i as u32, k, j), hash::unit(k, i as u32, j + 9)) - 20.0
            };
            let color = Color { r: 3 * k as u8, g: 200, b: 17, a: 255 };
            let pressed = |j: u32| Sample { pressure: hash::unit(j, k, 3), ..Sample::at(at(j)) };
            Stroke::new(brush.clone(), Operator::None, color, (0..5).map(pressed).collect())
        });
        tiles = paint_strokes(tiles, lines);
    }
    assert_eq!(tiles16(&tiles), 0, "of {}", tiles.iter().count());
    assert_eq!(tiles.bytes() - 9 * 8, 9 * 16384);
    let soft = Brush { size: 60.0, hardness: 0.0, flow: 0.02, ..Brush::default() };
    let aired = paint_strokes(tiles.clone(), [stroke(&soft, Color::BLACK, &[vec2(30.0, 30.0)])]);
    assert_eq!(tiles16(&aired), 1, "the airbrush met one tile");
    assert_eq!(aired.bytes(), tiles.bytes() + 2 * 16384);
    let inked = paint_strokes(
        aired.clone(),
        [stroke(&Brush::default(), Color::WHITE, &[vec2(30.0, 10.0)])],
    );
    assert_eq!(tiles16(&inked), 1, "it stays so while it is painted on");
    let gone = Brush { size: 200.0, hardness: 1.0, ..Brush::default() };
    let covered = paint_strokes(aired, [stroke(&gone, Color::WHITE, &[vec2(30.0, 30.0)])]);
    assert_eq!(tiles16(&covered), 0, "what bytes hold is of bytes again");
}

#[test]
fn retouched_paint_is_kept_as_it_was_and_as_it_becomes() {
    let ink = Brush { size: 50.0, hardness: 1.0, ..Brush::default() };
    let tiles =
        paint_strokes(TileGrid::default(), [stroke(&ink, Color::WHITE, &[vec2(60.0, 60.0)])]);
    let scene = Scene { size: SIZE, surface: None };
    let retouched = |tiles: &TileGrid, mode: BrushMode, offset: Vec2| {
        let brush = Brush { size: 70.0, hardness: 0.2, mode, ..Brush::default() };
        let stroke = stroke(&brush, Color::WHITE, &[vec2(80.0, 60.0), vec2(95.0, 60.0)]);
        let mut active = ActiveRetouching::new(
            std::slice::from_ref(&stroke),
            &[offset],
            tiles.clone(),
            tiles.clone(),
            &scene,
        );
        let mut next = tiles.clone();
        active
            .draw(&[stroke.samples().to_vec()])
            .into_iter()
            .for_each(|(at, tile)| next.set(at, tile));
        next
    };
    assert_eq!(tiles16(&tiles), 0);
    let blurred = retouched(&tiles, BrushMode::Blur { width: 0.4 }, Vec2::ZERO);
    assert!(tiles16(&blurred) > 0, "a blurred edge is smooth");
    let faint = Brush { size: 50.0, hardness: 1.0, flow: 0.001, ..Brush::default() };
    let faint =
        paint_strokes(TileGrid::default(), [stroke(&faint, Color::WHITE, &[vec2(40.0, 60.0)])]);
    let clone = BrushMode::Clone { aligned: true, picture: false };
    assert_eq!(retouched(&faint, clone, vec2(-50.0, 0.0)).pixel16(90, 60), [66; 4]);
}

#[test]
fn what_is_moved_scaled_cut_and_merged_stays_as_fine() {
    let brush = Brush { size: 150.0, hardness: 0.0, flow: 0.03, ..Brush::default() };
    let soft = paint_strokes(
        TileGrid::default(),
        [stroke(&brush, Color::WHITE, &[vec2(70.0, 70.0), vec2(100.0, 60.0)])],
    );
    let fine = |document: &Document| {
        let Content::Pixels(pixels) = &document.layers[0].content else { panic!("paint") };
        levels(pixels.tiles.iter().flat_map(|(_, tile)| {
            tile.to_rows16().iter().flat_map(|row| row[3]).map(u32::from).collect::<Vec<_>>()
        }))
    };
    let one = document(vec![paint(soft.clone())]);
    let (whole, id) = (fine(&one), one.layers[0].id);
    assert!(whole > 1000, "{whole} levels");
    let scaled = one.scaled(0.5).unwrap();
    assert!(fine(&scaled) > whole / 8, "{} levels", fine(&scaled));
    let half = crate::raster::CoverageGrid::from_plane(
        &crate::raster::Plane::from_fn(SIZE, |x, _| x as u8),
        0,
        0,
    );
    assert!(fine(&one.with_cleared(id, &half).unwrap()) > 1000);
    let copy = one.copy_covered(id, &half).unwrap();
    assert!(fine(&document(vec![copy])) > 1000);
    let merged = flatten_to_paint(
        &document(vec![paint(soft.clone()), paint(soft.clone())]),
        &Progress::default(),
    );
    assert!(fine(&document(vec![paint(merged.unwrap())])) > 1000);
    let same = flatten_to_paint(&one, &Progress::default()).unwrap();
    assert!(
        same.iter().all(|(at, tile)| tile.is_same(soft.tile(at).unwrap())),
        "a layer alone is what it was"
    );
    // Liquified alone, and in a group that is liquified.
    let mut lattice = crate::raster::Lattice::default();
    lattice.change(SIZE.rect(), |_, _, _| vec2(0.37, 0.21));
    let liquified = |layer: Layer| Layer { liquify: Some(Arc::new(lattice.clone())), ..layer };
    let group = Group { layers: vec![Arc::new(paint(soft.clone()))], pass_through: false };
    for layer in [paint(soft.clone()), Layer::new("group", Content::Group(group))] {
        let shown = flatten_to_floats(
            &document(vec![liquified(layer)]),
            Highlights::Clipped,
            &Progress::default(),
        );
        let found = levels(shown.unwrap().iter().map(|p| (p[3] * 65535.0).round() as u32));
        assert!(found > 1000, "{found} levels");
    }
    let noise: Vec<[u16; 4]> =
        (0..64 * 64).map(|i| [(hash::unit(i, 0, 0) * 65535.0) as u16; 4]).collect();
    let noise = TileGrid::from_straight16(&noise, 64, 64, 0, 0);
    let ink = paint_strokes(
        TileGrid::default(),
        [stroke(&Brush::default(), Color::WHITE, &[vec2(20.0, 20.0)])],
    );
    let both =
        flatten_to_paint(&document(vec![paint(noise.clone()), paint(ink)]), &Progress::default())
            .unwrap();
    assert_eq!(both.pixel16(63, 63), noise.pixel16(63, 63), "though nothing of it is smooth");
    let moved = one.layers[0].content.moved(vec2(17.0, -5.0));
    let Content::Pixels(moved) = &moved else { panic!("paint") };
    assert_eq!(moved.tiles.pixel16(77, 55), soft.pixel16(60, 60));
    assert!(soft.tile(TileAt::new(1, 1)).is_some_and(|tile| tile.is_16_bit()));
}
