//! Whatever a document may hold comes back live: limits that only the reader used to know.

use super::*;
use crate::document::{
    Content, DerivedMask, Group, Layer, LayerMask, LayerTransform, Live, Part, PartKind,
    StrokeList, TransformShape,
};
use crate::json;
use crate::math::vec2;
use crate::paint::{Brush, Sample, Stroke};
use crate::shading::{Environment, Model, Shading};
use crate::shape::{Ball, SculptStroke, SculptTool};
use crate::surface::Operator;

fn fill() -> Layer {
    Layer::new("Fill", Content::Fill(Color { r: 9, g: 90, b: 200, a: 120 }))
}

fn of(layers: Vec<Layer>) -> Document {
    Document {
        layers: layers.into_iter().map(Arc::new).collect(),
        ..Document::empty(Size::new(48, 40))
    }
}

/// It fits, and comes back equal when saved and opened: nothing became pixels.
fn is_stored_as(document: &Document) -> Vec<u8> {
    assert_eq!(document.fits(None), Ok(()));
    let bytes = write_bytes(document);
    let back = read_back(&bytes);
    assert_eq!(back.notes, [""; 0]);
    assert!(back.is_whole);
    assert_eq!(document.difference(&back.document), None);
    assert_eq!(
        super::super::read_back(Path::new("a.ora"), &bytes, document, &Budget::default())
            .err()
            .map(|e| e.to_string()),
        None
    );
    bytes
}

/// A stroke as a pen at 240 Hz draws it.
fn draw_stroke(count: usize) -> Arc<Stroke> {
    let one = |i: usize| {
        let t = i as f32 / 240.0;
        let at = vec2(24.0 + 18.0 * (0.7 * t).sin(), 20.0 + 15.0 * (0.3 * t).cos());
        let (pressure, tilt) = (0.5 + 0.4 * t.sin(), vec2(30.0 * (0.2 * t).cos(), 12.0));
        Sample { at, pressure, tilt, time_secs: t }.normalized()
    };
    let brush = Brush { size: 3.0, ..Brush::default() };
    Arc::new(Stroke::new(brush, Operator::None, Color::BLACK, (0..count).map(one).collect()))
}

fn strokes(strokes: Vec<Arc<Stroke>>) -> Layer {
    Layer::new("Ink", Content::Strokes(Live::new(StrokeList { strokes })))
}

#[test]
fn forty_nested_groups_come_back() {
    let into = |inner: Layer, i: usize| {
        let group = Group { layers: vec![Arc::new(inner)], pass_through: i.is_multiple_of(2) };
        Layer::new(format!("Group {i}"), Content::Group(group))
    };
    is_stored_as(&of(vec![(0..40).fold(fill(), into)]));
    is_stored_as(&of(vec![(0..Document::DEEPEST).fold(strokes(vec![draw_stroke(5)]), into)]));
}

#[test]
fn two_thousand_and_a_hundred_layers_come_back() {
    let named =
        |i: usize| Layer { name: format!("Layer {i}"), opacity: 1.0 / (i + 1) as f32, ..fill() };
    is_stored_as(&of((0..2_100).map(named).collect()));
}

#[test]
fn a_stroke_of_nine_hundred_thousand_readings_comes_back() {
    let bytes = is_stored_as(&of(vec![strokes(vec![draw_stroke(900_000), draw_stroke(40)])]));
    let description = entries(&bytes).into_iter().find(|(name, _)| name == DOCUMENT).unwrap().1;
    assert!(description.len() < 12_000_000, "{} bytes", description.len());
}

#[test]
fn sculpting_comes_back_whatever_the_number_of_readings() {
    let stroke = |count: usize| SculptStroke {
        tool: SculptTool::Raise,
        size: 9.0,
        hardness: 0.5,
        strength: 0.5,
        samples: draw_stroke(count)
            .samples()
            .iter()
            .map(|sample| (sample.at, sample.pressure))
            .collect(),
    };
    let strokes = [1, 2, 32, 33, 200, 5_000].map(stroke).to_vec();
    let ball =
        PartKind::Sweep { balls: vec![Ball { at: vec2(24.0, 20.0), radius: 15.0 }], puff: 1.0 };
    let sculpt = PartKind::Sculpt { on: "ball".into(), strokes };
    let parts = [Part::new("ball", ball), Part::new("sculpt", sculpt)];
    is_stored_as(&of(vec![fill()]).with_parts(parts.map(Arc::new).to_vec()));
}

#[test]
fn factors_of_any_digits_come_back() {
    let noise = |i: u32| f64::from(crate::math::hash::mix(i)) / f64::from(u32::MAX);
    let turned = |i: u32| {
        let [a, b, c, d, e, f] = std::array::from_fn(|k| noise(6 * i + k as u32));
        let shape = TransformShape::Matrix([1.0 + a, b, -c, 1.0 + d, 90.0 * e, -1e-9 * f]);
        Layer { transform: Some(LayerTransform { shape, filter: Default::default() }), ..fill() }
    };
    is_stored_as(&of((0..500).map(turned).collect()));
}

#[test]
fn what_differs_is_called_by_its_name() {
    let told = |change: fn(&mut Layer)| {
        let mut other = fill();
        change(&mut other);
        of(vec![fill()]).difference(&of(vec![other])).unwrap_or_default()
    };
    let shape = TransformShape::Matrix([1.0, 0.0, 0.0, 1.0, 3.0, 0.0]);
    assert_eq!(told(|layer| layer.opacity = 0.5), "“Fill”: its opacity");
    assert_eq!(
        told(|layer| layer.on = Some(crate::document::Attachment::canvas())),
        "“Fill”: its attachment"
    );
    let moved =
        Layer { transform: Some(LayerTransform { shape, filter: Default::default() }), ..fill() };
    assert_eq!(
        of(vec![fill()]).difference(&of(vec![moved])).unwrap_or_default(),
        "“Fill”: its transform"
    );
}

#[test]
fn a_mask_that_is_a_step_comes_back() {
    let kinds = [
        DerivedMask::Depth { from: 0.5, to: 0.5 },
        DerivedMask::Curvature { scale: 4.0, blur: 0.0, from: -0.25, to: -0.25 },
        DerivedMask::Depth { from: 1.0, to: 0.0 },
    ];
    let masked = |kind| Layer { mask: Some(LayerMask::new(kind)), ..fill() };
    is_stored_as(&of(kinds.into_iter().map(masked).collect()));
}

#[test]
fn a_material_under_an_environment_keeps_its_lamp() {
    let picture =
        crate::raster::Picture::srgb8(Size::new(2, 1), vec![[9, 9, 9, 255], [200; 4]]).unwrap();
    let shading = Shading {
        environment: Some(Environment::new("sky.png".into(), picture)),
        ..Shading::new(Model::Ashikhmin)
    };
    assert_eq!(shading.lights.len(), 1);
    is_stored_as(&of(vec![Layer::new("Metal", Content::Shading(Live::new(shading)))]));
}

#[test]
fn what_dots_far_apart_take_is_counted_by_the_dots() {
    let dots = |i: i32| {
        let mut tiles = crate::raster::TileGrid::default();
        let dot = |v: u8| crate::raster::Tile::from_bytes(vec![v; 64 * 64 * 4]).map(Arc::new);
        tiles.set(crate::raster::TileAt::new(0, 0), dot(255));
        tiles.set(crate::raster::TileAt::new(30, 30 + i), dot(200));
        Layer::new(
            "Dots",
            Content::Pixels(crate::document::PixelLayer { file: String::new(), x: 0, y: 0, tiles }),
        )
    };
    let document = of((0..3).map(dots).collect());
    let bytes = write_bytes(&document);
    // Four million pixels of rectangles each, of which two tiles are painted.
    let budget = Budget { document_px: 100_000, ..Budget::default() };
    let back = read(Path::new("a.ora"), &bytes, &budget).unwrap();
    assert!(back.is_whole && document.difference(&back.document).is_none(), "{:?}", back.notes);
}

#[test]
fn a_description_takes_no_more_values_than_edits_are_held_to() {
    // As many values as a reader counts: each comma, each list, eight for an object.
    let counted = |text: &str| {
        text.bytes()
            .map(|b| match b {
                b'{' => 8,
                b'[' | b',' => 1,
                _ => 0,
            })
            .sum::<usize>()
    };
    let lines = |n: usize| strokes((0..n).map(|_| draw_stroke(40)).collect());
    let few = |n: usize| strokes((0..n).map(|_| draw_stroke(20)).collect());
    let many = [
        of(vec![lines(400)]),
        of(vec![few(400)]),
        of((0..50).map(|_| fill()).collect()),
        everything(64),
    ];
    for document in many {
        let text = String::from_utf8(entries(&write_bytes(&document)).remove(1).1).unwrap();
        let value = json::parse(Path::new("d"), text.as_bytes(), &Budget::default()).unwrap();
        let (layers, strokes) =
            (document.walk().len(), value.to_string().matches("samples").count());
        assert!(counted(&text) < 200 * layers + 300 * (strokes + 1), "{}", counted(&text));
    }
    let (few, many) =
        (counted(&text_of(&of(vec![lines(10)]))), counted(&text_of(&of(vec![lines(110)]))));
    assert!(many - few <= 100 * 60, "{} values a stroke whose brush stays", (many - few) / 100);
}

fn text_of(document: &Document) -> String {
    crate::recipe::print(document)
}

#[test]
fn a_save_that_would_not_come_back_leaves_the_old_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.ora");
    let good = of(vec![fill()]);
    crate::save(&good, &file, crate::Overwrite::Nothing, &Progress::default()).unwrap().unwrap();
    let old = std::fs::read(&file).unwrap();
    let steep = Brush { spacing: 1e9, ..Brush::default() };
    let stroke = Stroke::new(steep, Operator::None, Color::BLACK, vec![Sample::at(vec2(9.0, 9.0))]);
    for (bad, why) in [
        (Layer { opacity: f32::NAN, ..fill() }, "layers[0].opacity"),
        (Layer { opacity: 1.5, ..fill() }, "opacity: is 1.5; it must be between 0 and 1"),
        (strokes(vec![Arc::new(stroke)]), "“Ink” became pixels"),
    ] {
        let said =
            crate::save(&of(vec![bad]), &file, crate::Overwrite::Anything, &Progress::default());
        let said = said.err().map(|e| e.to_string()).unwrap_or_default();
        assert!(said.contains("would not open as it is") && said.contains(why), "{said}");
        assert!(std::fs::read(&file).unwrap() == old, "the old file stays");
        assert_eq!(
            std::fs::read_dir(folder.path()).unwrap().count(),
            1,
            "and nothing is left beside it"
        );
    }
}

#[test]
fn a_drawing_that_was_scaled_by_odd_sides_is_saved() {
    let folder = tempfile::tempdir().unwrap();
    let scaled = everything(63).scaled(0.37).unwrap();
    let file = folder.path().join("a.ora");
    crate::save(&scaled, &file, crate::Overwrite::Nothing, &Progress::default()).unwrap().unwrap();
}
