//! Hatching that reads other layers. Floor 4.

use super::*;
use crate::document::{History, StrokeList};
use crate::math::{Size, Vec3, srgb::Color, vec2};
use crate::paint::{Brush, FormPattern, Sample};
use crate::raster::Plane;
use crate::surface::hatching::HatchSettings;
use crate::surface::{Maps, Operator, Surface};

const SIZE: Size = Size { width: 128, height: 96 };

fn flat() -> Arc<Surface> {
    let maps = Maps {
        normals: Plane::full(SIZE, Vec3::Z),
        depth: Plane::full(SIZE, 0.5),
        coverage: Plane::full(SIZE, 255),
    };
    Arc::new(Surface::new(maps).unwrap())
}

fn stroke_layer(name: &str, points: &[Vec2]) -> Layer {
    let samples = points.iter().map(|at| Sample::at(*at).normalized()).collect();
    let stroke = Stroke::new(Brush::default(), Operator::None, Color::BLACK, samples);
    let strokes = vec![Arc::new(stroke)];
    Layer::new(name, Content::Strokes(Live::new(StrokeList { strokes })))
}

fn hatching(way: HatchWay, tone: HatchTone) -> Layer {
    let settings = HatchSettings { way, tone, ..HatchSettings::DEFAULT };
    let sources = HatchSources { guides: "Guides".into(), tone: "Tone".into() };
    let drawing = FormDrawing { sources, ..FormDrawing::new(FormPattern::Hatching(settings)) };
    Layer::new("Hatching", Content::FormDrawing(Live::new(drawing)))
}

fn document(layers: Vec<Layer>) -> Document {
    let layers = layers.into_iter().map(Arc::new).collect();
    Document { layers, surface: Some(flat()), ..Document::empty(SIZE) }
}

fn sources_of(document: &Document) -> FoundSources {
    let layer = document.layer_named("Hatching").unwrap();
    let Content::FormDrawing(live) = &layer.content else { panic!("hatching") };
    live.params().found.clone()
}

fn gray(name: &str, level: u8) -> Layer {
    Layer::new(name, Content::Fill(Color { r: level, g: level, b: level, a: 255 }))
}

#[test]
fn guides_follow_their_layer_and_its_name() {
    let strokes = stroke_layer("Guides", &[vec2(10.0, 10.0), vec2(90.0, 70.0)]);
    let bare = document(vec![hatching(HatchWay::Guides, HatchTone::Light), strokes]);
    assert!(!bare.is_shaped());
    let history: History<()> = History::new(bare, 10);
    assert!(history.present().is_shaped());
    let before = sources_of(history.present());
    assert!(!before.guides.is_empty());
    let id = history.present().layer_named("Guides").unwrap().id;
    let renamed = history.present().with_layer(id, |layer| layer.name = "Ways".into()).unwrap();
    assert!(renamed.is_shaped() && sources_of(&renamed).is_same(&before), "a new name is followed");
    let moved = renamed.with_moved_strokes(id, &[0], vec2(0.0, 9.0)).unwrap();
    assert!(!moved.is_shaped());
    assert!(!sources_of(&moved.reshaped()).is_same(&before));
    let gone = renamed.with_layer(id, |layer| layer.name = "x".into()).unwrap();
    let gone = gone.without_strokes(id, &[0]).unwrap().reshaped();
    assert!(sources_of(&gone).guides.is_empty() && gone.is_shaped());
}

#[test]
fn tone_is_that_of_what_lies_beneath_or_of_one_layer() {
    let at = |document: &Document| sources_of(document).tone.unwrap().at(vec2(60.0, 40.0), SIZE);
    let beneath = hatching(HatchWay::Paper, HatchTone::Beneath);
    let shown = document(vec![gray("Tone", 51), beneath, gray("Above", 200)]).reshaped();
    assert!(shown.is_shaped());
    assert!((at(&shown) - 0.2).abs() < 0.005, "{}", at(&shown));
    let id = shown.layer_named("Tone").unwrap().id;
    let lighter = shown.with_layer(id, |layer| layer.opacity = 0.5).unwrap();
    assert!(!lighter.is_shaped(), "what lies beneath is another");
    assert!((at(&lighter.reshaped()) - 0.6).abs() < 0.01, "{}", at(&lighter.reshaped()));
    let above = shown.layer_named("Above").unwrap().id;
    assert!(shown.with_layer(above, |layer| layer.opacity = 0.5).unwrap().is_shaped());

    let of_layer = hatching(HatchWay::Paper, HatchTone::Layer);
    let hidden = Layer { visible: false, ..gray("Tone", 51) };
    let shown = document(vec![gray("Ground", 255), of_layer, hidden]).reshaped();
    assert!((at(&shown) - 0.2).abs() < 0.005, "a hidden layer has a tone: {}", at(&shown));
}

#[test]
fn hatching_that_names_itself_has_its_own_light() {
    let mut own = hatching(HatchWay::Paper, HatchTone::Layer);
    if let Content::FormDrawing(live) = &mut own.content {
        let sources = HatchSources { tone: "Hatching".into(), ..HatchSources::default() };
        *live = Live::new(FormDrawing { sources, ..live.params().clone() });
    }
    let document = document(vec![own]).reshaped();
    assert!(document.is_shaped() && sources_of(&document).tone.is_none());
}

#[test]
fn hatching_is_as_dense_as_the_picture_beneath_is_dark() {
    let ink = |level: u8| {
        let layer = hatching(HatchWay::Paper, HatchTone::Beneath);
        let document = document(vec![gray("Tone", level), layer]).reshaped();
        let id = document.layer_named("Hatching").unwrap().id;
        let picture = flatten_layer(&document, id, &Progress::default()).unwrap();
        let sum: u64 = picture
            .iter()
            .flat_map(|(_, tile)| {
                tile.bytes().chunks_exact(4).map(|p| u64::from(p[3])).collect::<Vec<_>>()
            })
            .sum();
        sum as f32 / 255.0 / SIZE.area() as f32
    };
    let [dark, middle, light] = [40, 128, 230].map(ink);
    assert!(light < 0.01 && (0.25..0.5).contains(&middle) && dark > 0.6, "{dark} {middle} {light}");
}
