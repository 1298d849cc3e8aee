use super::*;
use crate::document::{Group, History, flatten};
use crate::document::{LayerTransform, Progress};
use crate::math::{PlaneMap, Size, srgb::Color};

const SIZE: Size = Size { width: 80, height: 64 };
const INK: [u8; 4] = [24, 20, 30, 255];

/// Red and green halves with ink around and between them.
fn drawing() -> TileGrid {
    let pixel = |i: usize| {
        let (x, y) = (i % 80, i / 80);
        let within = |m: usize| (m..80 - m).contains(&x) && (m..64 - m).contains(&y);
        match () {
            _ if !within(6) => [0; 4],
            _ if !within(8) || (39..41).contains(&x) => INK,
            _ if x < 40 => [210, 60, 40, 255],
            _ => [50, 160, 90, 255],
        }
    };
    let rgba: Vec<u8> = (0..80 * 64).flat_map(pixel).collect();
    TileGrid::from_straight_rgba(&rgba, 80, 64, 0, 0)
}

/// The drawing, a gray that multiplies it, and its lines on top of that.
fn lit_drawing() -> Document {
    let base = Layer {
        blend: crate::raster::BlendMode::Multiply,
        clip_below: true,
        ..Layer::new("Base", Color { r: 128, g: 128, b: 128, a: 255 })
    };
    let lines = Layer::new("Ink", Content::Ink(InkLayer::of("Drawing")));
    let layers = [Layer::new("Drawing", drawing()), base, lines];
    let layers = layers.into_iter().map(Arc::new).collect();
    Document { layers, ..Document::empty(SIZE) }.reshaped()
}

fn pixel(document: &Document, x: i32, y: i32) -> [u8; 4] {
    flatten::flatten(document, &Progress::default()).unwrap().pixel(x, y)
}

#[test]
fn ink_is_as_it_was_drawn_and_the_flats_beneath_are_lit() {
    let document = lit_drawing();
    assert!(document.is_shaped());
    for (x, y) in [(7, 30), (39, 30), (20, 7), (72, 50)] {
        assert_eq!(pixel(&document, x, y), INK, "{x} {y}");
    }
    let shown = pixel(&document, 20, 30);
    assert!(shown[0].abs_diff(105) <= 1 && shown[1].abs_diff(30) <= 1, "{shown:?}");
    let hidden = document.with_layer(document.layers[2].id, |layer| layer.visible = false);
    let beneath = pixel(&hidden.unwrap().reshaped(), 39, 30);
    assert!(beneath[0] > 90 || beneath[1] > 70, "the colors continue beneath: {beneath:?}");
}

#[test]
fn lines_follow_a_drawing_that_is_painted_on_renamed_or_moved() {
    let document = lit_drawing();
    let id = document.layers[0].id;
    let mut painted = drawing();
    painted.set(crate::raster::TileAt::new(1, 0), None);
    let content = Content::from(painted);
    let edited = document.with_layer(id, |layer| layer.content = content).unwrap();
    assert!(!edited.is_shaped());
    let mut history = History::new(document.clone(), 5);
    history.commit("Paint", edited, ());
    assert!(history.present().is_shaped());
    assert_eq!(pixel(history.present(), 72, 30), [0; 4], "what was erased has no lines");
    assert_eq!(pixel(history.present(), 7, 30), INK);

    let renamed = document.with_layer(id, |layer| layer.name = "Fox".into()).unwrap();
    assert!(renamed.is_shaped(), "a name changes no ink");
    let Content::Ink(lines) = &renamed.layers[2].content else { panic!("lines") };
    assert_eq!(lines.of, "Fox");

    let by = PlaneMap::affine([1.0, 0.0, 0.0, 1.0, 4.0, 0.0]).unwrap();
    let transform = LayerTransform::of_map(&by, Default::default(), SIZE);
    let moved = document.with_layer(id, |layer| layer.transform = transform).unwrap();
    let moved = moved.reshaped();
    assert_eq!(pixel(&moved, 43, 30), INK);
    assert_ne!(pixel(&moved, 39, 30), INK);
}

#[test]
fn without_a_line_layer_the_ink_is_on_the_drawing_again() {
    let document = lit_drawing();
    let alone = document.without_layer(document.layers[2].id).unwrap();
    assert!(!alone.is_shaped());
    let alone = alone.reshaped();
    assert!(alone.layers[0].lifted.is_none());
    assert!(pixel(&alone, 39, 30)[0] < 24, "lit as all else");
}

#[test]
fn what_lies_in_front_in_a_group_hides_the_lines_behind_it() {
    let front = Layer {
        transform: LayerTransform::of_map(
            &PlaneMap::affine([1.0, 0.0, 0.0, 1.0, 20.0, 10.0]).unwrap(),
            Default::default(),
            SIZE,
        ),
        ..Layer::new("Front", drawing())
    };
    let layers = [Layer::new("Behind", drawing()), front].map(Arc::new).to_vec();
    let group = Layer::new("Drawing", Group { layers, pass_through: false });
    let lines = Layer::new("Ink", Content::Ink(InkLayer::of("Drawing")));
    let layers = [group, lines].map(Arc::new).to_vec();
    let both = Document { layers, ..Document::empty(SIZE) };
    let before = flatten::flatten(
        &Document { layers: both.layers[..1].to_vec(), ..both.clone() },
        &Progress::default(),
    );
    let lined = flatten::flatten(&both.reshaped(), &Progress::default()).unwrap();
    let before = before.unwrap();
    for (x, y) in (0..64).flat_map(|y| (0..80).map(move |x| (x, y))) {
        let (was, is) = (before.pixel(x, y), lined.pixel(x, y));
        assert!((0..4).all(|c| was[c].abs_diff(is[c]) <= 1), "{x} {y}: {is:?} for {was:?}");
    }
}

#[test]
fn a_drawing_is_read_once_for_its_parts_and_its_ink() {
    let (document, drawing) = (Document::empty(SIZE), drawing());
    let read = document.parts.reading_of(&drawing).unwrap();
    let _ = document.lift_ink(&drawing);
    let again = document.parts.reading_of(&drawing.clone()).unwrap();
    assert!(Arc::ptr_eq(&read.picture, &again.picture));
    let other = document.parts.reading_of(&TileGrid::from_straight_rgba(&[9; 4], 1, 1, 0, 0));
    assert!(!Arc::ptr_eq(&read.picture, &other.unwrap().picture));
}
