//! Hatching that reads other layers. Floor 4.

use super::*;
use crate::document::{History, StrokeList};
use crate::math::{Size, Vec3, srgb::Color, vec2};
use crate::paint::{Brush, FormPattern, Sample, Scene};
use crate::raster::Plane;
use crate::surface::form_lines::{LineKinds, LineSettings};
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
    let sources =
        DrawingSources { guides: "Guides".into(), tone: "Tone".into(), ..Default::default() };
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
        let sources = DrawingSources { tone: "Hatching".into(), ..DrawingSources::default() };
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

#[test]
fn lines_that_are_drawn_again_give_way_and_the_rest_stays_live() {
    let middle = vec2(64.0, 48.0);
    let disc = |radius_px: f32| {
        let is_on = move |x: usize, y: usize| {
            vec2(x as f32 + 0.5, y as f32 + 0.5).distance(middle) < radius_px
        };
        let maps = Maps {
            normals: Plane::from_fn(
                SIZE,
                move |x, y| if is_on(x, y) { Vec3::Z } else { Vec3::ZERO },
            ),
            depth: Plane::from_fn(SIZE, move |x, y| if is_on(x, y) { 0.5 } else { f32::NAN }),
            coverage: Plane::from_fn(SIZE, move |x, y| if is_on(x, y) { 255 } else { 0 }),
        };
        Some(Arc::new(Surface::new(maps).unwrap()))
    };
    // Along the left half of the outline, as a hand would.
    let arc = (0..=18).map(|i| {
        let turn = (90.0 + 10.0 * i as f32).to_radians();
        middle + 41.0 * vec2(turn.cos(), turn.sin())
    });
    let strokes = stroke_layer("By hand", &arc.collect::<Vec<_>>());
    let sources = DrawingSources { redrawn: "By hand".into(), ..Default::default() };
    let pattern = FormPattern::Lines(LineSettings::DEFAULT);
    let drawing = FormDrawing { sources, ..FormDrawing::new(pattern) };
    let lines = Layer::new("Lines", Content::FormDrawing(Live::new(drawing)));
    let document = Document { surface: disc(40.0), ..document(vec![lines, strokes]) };
    let ink = |document: &Document| {
        let id = document.layer_named("Lines").unwrap().id;
        let picture = flatten_layer(document, id, &Progress::default()).unwrap();
        let of = |from: i32, to: i32| {
            let all = (0..96).flat_map(|y| (from..to).map(move |x| (x, y)));
            all.map(|(x, y)| u32::from(picture.pixel(x, y)[3])).sum::<u32>() / 255
        };
        [of(0, 56), of(72, 128)]
    };
    let [left, right] = ink(&document);
    assert!(left > 100 && right > 100, "{left} {right}");
    let shaped = document.reshaped();
    let [left, right] = ink(&shaped);
    assert!(left < 5 && right > 100, "{left} {right}");
    // Hidden strokes still stand there; the shape may change.
    let id = shaped.layer_named("By hand").unwrap().id;
    let hidden = shaped.with_layer(id, |layer| layer.visible = false).unwrap();
    let larger = Document { surface: disc(44.0), ..hidden }.reshaped();
    let [left, right] = ink(&larger);
    assert!(left < 5 && right > 100, "{left} {right}");
    let renamed = larger.with_layer(id, |layer| layer.name = "Again".into()).unwrap();
    assert!(ink(&renamed.reshaped())[0] < 5);
    let none = renamed.without_strokes(id, &[0]).unwrap().reshaped();
    assert!(ink(&none)[0] > 100);
}

#[test]
fn edges_of_color_are_those_of_the_picture_beneath() {
    let kinds = LineKinds::NONE.with(LineKind::Color, true);
    let lines = LineSettings { kinds, ..LineSettings::DEFAULT };
    let drawing = FormDrawing::new(FormPattern::Lines(lines));
    let lines = Layer::new("Hatching", Content::FormDrawing(Live::new(drawing)));
    let wide = Brush { size: 40.0, hardness: 1.0, ..Brush::default() };
    let samples = [10.0, 110.0].map(|x| Sample::at(vec2(x, 48.0)));
    let stroke = Stroke::new(wide, Operator::None, Color::BLACK, samples.to_vec());
    let strokes = StrokeList { strokes: vec![Arc::new(stroke)] };
    let painted = Layer::new("Paint", Content::Strokes(Live::new(strokes)));
    let id = painted.id;
    let before = document(vec![gray("Page", 240), painted, lines]).with_form_sources();
    let strokes_of = |document: &Document| {
        let layer = document.layer_named("Hatching").unwrap();
        let Content::FormDrawing(live) = &layer.content else { panic!("lines") };
        let scene = Scene { size: SIZE, surface: document.surface.clone() };
        live.params().strokes(&scene).len()
    };
    assert!(strokes_of(&before) > 0 && before.has_form_sources());
    let hidden = before.with_layer(id, |layer| layer.visible = false).unwrap();
    assert!(!hidden.has_form_sources());
    assert_eq!(strokes_of(&hidden.with_form_sources()), 0);
    // Above the lines, paint has no part in them.
    let mut with_above = before.clone();
    with_above.layers.push(Arc::new(gray("Above", 0)));
    assert!(with_above.has_form_sources());
}
