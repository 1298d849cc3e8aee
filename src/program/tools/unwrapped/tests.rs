use super::*;
use crate::math::{Mat2, Size, Vec3, srgb::Color, vec2, vec3};
use crate::paint::Stroke;
use crate::raster::Plane;
use crate::surface::Maps;
use crate::surface::operator::UnwrapSettings;
use crate::tools::ModifierKeys;

const RADIUS: f32 = 80.0;

/// An upright cylinder next to a board that faces the viewer, farther away.
fn surface() -> Arc<Surface> {
    let size = Size::new(320, 120);
    let lean = |x: usize| (x as f32 + 0.5 - 100.0) / RADIUS;
    let is_round = |x: usize| lean(x).abs() < 0.9;
    let normals = Plane::from_fn(size, |x, _| {
        if is_round(x) { vec3(lean(x), 0.0, (1.0 - lean(x) * lean(x)).sqrt()) } else { Vec3::Z }
    });
    let depth = Plane::from_fn(size, |x, _| {
        if is_round(x) { 0.5 - 0.4 * (1.0 - lean(x) * lean(x)).sqrt() } else { 1.0 }
    });
    let coverage = Plane::from_fn(size, |x, _| if is_round(x) || x > 200 { 255 } else { 0 });
    Arc::new(Surface::new(Maps { normals, depth, coverage }).unwrap())
}

pub fn document() -> Document {
    let surface = surface();
    Document { surface: Some(surface.clone()), ..Document::empty(surface.size()) }
}

pub fn layout_of(document: &Document) -> Arc<PlaneLayout> {
    document
        .surface
        .as_ref()
        .unwrap()
        .plane_layout(UnwrapSettings { amount: 1.0, smooth_px: 0.0 })
        .unwrap()
}
const BRUSH: StrokeStart = |context, pen| crate::tools::press(ToolKind::Brush, context, pen);

/// The strokes that result when the pen goes along these points of the sheet.
fn draw(document: &Document, brush: &Brush, points: &[Vec2]) -> Vec<Arc<Stroke>> {
    let tools = ToolSettings::with_brush(brush.clone());
    let context = ToolContext::new(document, &tools);
    let (gesture, _) = paint(&context, PenSample::at(points[0]), layout_of(document), BRUSH);
    let mut gesture = gesture.unwrap();
    points[1..].iter().for_each(|point| drop(gesture.drag(&[PenSample::at(*point)])));
    match gesture.release() {
        Outcome::Commit { document, select, .. } => document.strokes(select.unwrap()).to_vec(),
        _ => panic!("a stroke is kept"),
    }
}

fn on_sheet(document: &Document, x: f32, y: f32) -> Vec2 {
    layout_of(document).sheet_at(document.surface.as_ref().unwrap(), vec2(x, y)).unwrap()
}

#[test]
fn a_line_drawn_evenly_on_the_sheet_goes_evenly_along_the_surface() {
    let document = document();
    let (from, to) = (on_sheet(&document, 40.0, 60.0), on_sheet(&document, 160.0, 60.0));
    let strokes = draw(&document, &Brush::default(), &[from, to]);
    assert_eq!(strokes.len(), 1);
    assert!(strokes[0].operator().unwrapping().is_some(), "painted as a print");
    let arc = |x: f32| RADIUS * ((x - 100.0) / RADIUS).asin();
    let places: Vec<f32> = strokes[0].samples().iter().map(|sample| arc(sample.at.x)).collect();
    let steps: Vec<f32> = places.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let (least, most) = steps.iter().fold((f32::MAX, 0.0f32), |(a, b), s| (a.min(*s), b.max(*s)));
    assert!(
        steps.len() > 30 && least > 0.9 * most,
        "{} steps of {least} to {most} px",
        steps.len()
    );
}

#[test]
fn a_line_over_the_gap_between_two_pieces_is_cut_there_and_one_step() {
    let document = document();
    let (from, to) = (on_sheet(&document, 100.0, 60.0), on_sheet(&document, 260.0, 60.0));
    let strokes = draw(&document, &Brush::default(), &[from, to]);
    assert_eq!(strokes.len(), 2, "one on each piece");
    let objects = document.surface.as_ref().unwrap().objects();
    let labels = objects.labels();
    for stroke in &strokes {
        let on: Vec<u32> = stroke
            .samples()
            .iter()
            .map(|s| labels.at_clamped(s.at.x as i32, s.at.y as i32))
            .collect();
        let there: Vec<u32> = on.iter().copied().filter(|label| *label > 0).collect();
        assert!(!there.is_empty() && there.iter().all(|label| *label == there[0]), "{on:?}");
    }
}

#[test]
fn the_hand_is_calmed_on_the_sheet() {
    let document = document();
    let brush = Brush { stabilizer: Stabilizer::String { length_px: 30.0 }, ..Brush::default() };
    let (from, to) = (on_sheet(&document, 60.0, 60.0), on_sheet(&document, 150.0, 60.0));
    let middle = from.lerp(to, 0.5) + vec2(0.0, 20.0);
    let calm = draw(&document, &brush, &[from, middle, to]);
    let plain = draw(&document, &Brush::default(), &[from, middle, to]);
    let lowest =
        |strokes: &[Arc<Stroke>]| strokes[0].samples().iter().map(|s| s.at.y).fold(0.0, f32::max);
    assert!(lowest(&calm) < lowest(&plain) - 8.0, "{} and {}", lowest(&calm), lowest(&plain));
    assert_eq!(calm[0].brush().stabilizer, Stabilizer::None, "it is smooth already");
}

#[test]
fn shift_joins_the_last_end_by_a_line_that_is_straight_on_the_sheet() {
    let (document, tools) = (document(), ToolSettings::default());
    let context =
        ToolContext { last_end: Some(vec2(40.0, 30.0)), ..ToolContext::new(&document, &tools) };
    let keys = ModifierKeys { shift: true, ..ModifierKeys::default() };
    let to = on_sheet(&document, 160.0, 90.0);
    let (gesture, _) =
        paint(&context, PenSample { keys, ..PenSample::at(to) }, layout_of(&document), BRUSH);
    let Outcome::Commit { document, select, .. } = gesture.unwrap().release() else {
        panic!("it is kept")
    };
    let stroke = document.strokes(select.unwrap())[0].clone();
    let first = stroke.samples()[0].at;
    assert!(first.distance(vec2(40.0, 30.0)) < 1.0, "it begins at {first}");
    let arc = |p: Vec2| vec2(RADIUS * ((p.x - 100.0) / RADIUS).asin(), p.y);
    let (a, b) = (arc(vec2(40.0, 30.0)), arc(vec2(160.0, 90.0)));
    for sample in stroke.samples() {
        let off = (arc(sample.at) - a).perp_dot((b - a).normalize_or(Vec2::X)).abs();
        assert!(off < 1.0, "{} lies {off} px beside the line", sample.at);
    }
}

#[test]
fn tools_that_point_get_the_canvas_under_the_pen() {
    let document = document();
    let red = crate::document::Layer::new(
        "red",
        crate::document::Content::Fill(Color { r: 200, g: 9, b: 9, a: 255 }),
    );
    let document = Document { layers: vec![Arc::new(red)], ..document };
    let tools = ToolSettings::default();
    let context = ToolContext::new(&document, &tools);
    let picked =
        |p: Vec2| point(&context, PenSample::at(p), layout_of(&document), ToolKind::Eyedropper).0;
    let mut picking = picked(on_sheet(&document, 150.0, 70.0)).unwrap();
    assert_eq!(picking.picked_color().map(|color| color.r), Some(200));
    assert_eq!(picking.release().settings().color.r, 200);
    assert!(picked(vec2(-90.0, -90.0)).is_none(), "beside all pieces there is nothing");
}

#[test]
fn the_pen_leans_on_the_canvas_as_it_does_on_the_sheet() {
    let document = document();
    let sheet = Sheet { layout: layout_of(&document), surface: document.surface.clone().unwrap() };
    let at = on_sheet(&document, 130.0, 60.0);
    let pen = PenSample {
        sample: Sample { tilt: vec2(30.0, 10.0), ..Sample::at(at) },
        ..PenSample::at(at)
    };
    let (led, _) = sheet.map_sample(pen).unwrap();
    let CanvasPlace { turn, .. } = sheet.layout.canvas_at(&sheet.surface, at).unwrap();
    assert!(turn.abs_diff_eq(Mat2::IDENTITY, 0.02), "a cylinder turns nothing: {turn}");
    assert!(led.sample.tilt.distance(vec2(30.0, 10.0)) < 1.0, "{}", led.sample.tilt);
}
