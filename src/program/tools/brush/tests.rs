use super::*;
use crate::document::{Symmetry, SymmetrySettings};
use crate::math::{Size, Vec2, vec2};
use crate::paint::{Brush, Stabilizer};
use crate::raster::TileGrid;
use crate::surface::Operator;
use crate::tools::ModifierKeys;
use crate::tools::ToolSettings;
use std::sync::Arc;

fn context<'a>(
    document: &'a Document,
    layer: Option<LayerId>,
    tools: &'a ToolSettings,
) -> ToolContext<'a> {
    ToolContext { layer, ..ToolContext::new(document, tools) }
}

fn draw(
    context: &ToolContext,
    purpose: StrokePurpose,
    points: &[Vec2],
) -> (Document, Option<LayerId>) {
    let (gesture, _) = press(context, PenSample::at(points[0]), purpose);
    let mut gesture = gesture.unwrap();
    for &point in &points[1..] {
        gesture.drag(&[PenSample::at(point)]);
    }
    match gesture.release() {
        Outcome::Commit { document, select, .. } => (document, select),
        _ => panic!("a stroke is kept"),
    }
}

fn paint_layer() -> Document {
    let pixels = PixelLayer { file: String::new(), x: 0, y: 0, tiles: TileGrid::default() };
    let layers = vec![Arc::new(Layer::new("Paint", Content::Pixels(pixels)))];
    Document { layers, ..Document::empty(Size::new(200, 150)) }
}

fn tiles(document: &Document) -> &TileGrid {
    match &document.layers[0].content {
        Content::Pixels(pixels) => &pixels.tiles,
        _ => panic!("a paint layer"),
    }
}
const LINE: [Vec2; 6] = [
    vec2(20.0, 40.0),
    vec2(60.0, 52.0),
    vec2(100.0, 44.0),
    vec2(140.0, 80.0),
    vec2(150.0, 120.0),
    vec2(90.0, 130.0),
];

#[test]
fn the_first_stroke_makes_a_layer_to_hold_it() {
    let (empty, brush) = (Document::empty(Size::new(200, 150)), Brush::default());
    let tools = ToolSettings::with_brush(brush);
    let (document, select) = draw(&context(&empty, None, &tools), StrokePurpose::Paint, &LINE);
    assert_eq!(document.layers.len(), 1);
    assert_eq!(select, Some(document.layers[0].id));
    let Content::Strokes(list) = &document.layers[0].content else { panic!("a stroke layer") };
    assert_eq!(list.params().strokes[0].samples().len(), LINE.len());
    let (again, _) = draw(&context(&document, select, &tools), StrokePurpose::Paint, &LINE);
    assert_eq!(again.layers.len(), 1, "the next one goes to the same layer");
}

#[test]
fn pixels_painted_step_by_step_are_those_painted_at_once() {
    let (document, brush) = (paint_layer(), Brush { size: 30.0, ..Brush::default() });
    let tools = ToolSettings::with_brush(brush.clone());
    let id = Some(document.layers[0].id);
    let (steps, _) = draw(&context(&document, id, &tools), StrokePurpose::Paint, &LINE);
    let stroke = Stroke::new(brush, Operator::None, Color::BLACK, LINE.map(Sample::at).to_vec());
    let scene = document.scene();
    for at in TileAt::covering(scene.size.rect()) {
        let whole = crate::paint::stroke::render_tile(&[Arc::new(stroke.clone())], &scene, at);
        let bytes = tiles(&steps).tile(at).map(|tile| tile.bytes().to_vec());
        assert!(bytes == whole.map(|tile| tile.bytes().to_vec()), "{at:?}");
    }
}

#[test]
fn erasing_takes_out_what_painting_put_in_and_locked_alpha_keeps_the_shape() {
    let brush = Brush { size: 30.0, hardness: 1.0, ..Brush::default() };
    let tools = ToolSettings::with_brush(brush);
    let document = paint_layer();
    let id = Some(document.layers[0].id);
    let (painted, _) = draw(&context(&document, id, &tools), StrokePurpose::Paint, &LINE);
    assert_eq!(tiles(&painted).pixel(60, 52), [0, 0, 0, 255]);
    let (erased, _) = draw(&context(&painted, id, &tools), StrokePurpose::Erase, &LINE);
    assert_eq!(tiles(&erased).pixel(60, 52), [0; 4]);
    let locked =
        painted.with_layer(painted.layers[0].id, |layer| layer.lock = LayerLock::Alpha).unwrap();
    let wide = Brush { size: 90.0, ..tools.brush.clone() };
    let white = ToolSettings { color: Color::WHITE, ..ToolSettings::with_brush(wide) };
    let (atop, _) = draw(&context(&locked, id, &white), StrokePurpose::Paint, &LINE);
    assert_eq!((tiles(&atop).pixel(60, 52), tiles(&atop).pixel(60, 90)), ([255; 4], [0; 4]));
}

#[test]
fn a_locked_layer_takes_no_paint() {
    let (document, brush) = (paint_layer(), Brush::default());
    let tools = ToolSettings::with_brush(brush);
    let id = document.layers[0].id;
    let locked = document.with_layer(id, |layer| layer.lock = LayerLock::All).unwrap();
    assert!(
        press(&context(&locked, Some(id), &tools), PenSample::at(LINE[0]), StrokePurpose::Paint)
            .0
            .is_none()
    );
}

#[test]
fn the_eraser_with_ctrl_takes_whole_strokes_from_a_stroke_layer() {
    let (empty, brush) =
        (Document::empty(Size::new(200, 150)), Brush { size: 8.0, ..Brush::default() });
    let tools = ToolSettings::with_brush(brush);
    let (one, id) = draw(
        &context(&empty, None, &tools),
        StrokePurpose::Paint,
        &[vec2(10.0, 20.0), vec2(90.0, 20.0)],
    );
    let (two, _) = draw(
        &context(&one, id, &tools),
        StrokePurpose::Paint,
        &[vec2(10.0, 90.0), vec2(90.0, 90.0)],
    );
    let ctrl = PenSample {
        keys: ModifierKeys { ctrl: true, ..ModifierKeys::default() },
        ..PenSample::at(vec2(50.0, 91.0))
    };
    let (gesture, _) = press(&context(&two, id, &tools), ctrl, StrokePurpose::Erase);
    let Outcome::Commit { document: left, .. } = gesture.unwrap().release() else {
        panic!("one is gone")
    };
    let Content::Strokes(list) = &left.layers[0].content else { panic!("a stroke layer") };
    assert_eq!(list.params().strokes.len(), 1);
    assert_eq!(list.params().strokes[0].samples()[0].at.y, 20.0);
}

#[test]
fn the_eraser_lays_a_stroke_that_takes_paint_away_where_there_are_strokes() {
    let (empty, brush) =
        (Document::empty(Size::new(200, 150)), Brush { size: 8.0, ..Brush::default() });
    let tools = ToolSettings::with_brush(brush);
    let (one, id) = draw(
        &context(&empty, None, &tools),
        StrokePurpose::Paint,
        &[vec2(10.0, 20.0), vec2(90.0, 20.0)],
    );
    let (cut, _) = draw(
        &context(&one, id, &tools),
        StrokePurpose::Erase,
        &[vec2(50.0, 5.0), vec2(50.0, 60.0)],
    );
    let Content::Strokes(list) = &cut.layers[0].content else { panic!("a stroke layer") };
    let erases: Vec<bool> =
        list.params().strokes.iter().map(|stroke| stroke.brush().erases).collect();
    assert_eq!(erases, [false, true]);
    let (none, id) =
        (one.with_layer(one.layers[0].id, |layer| layer.content = blank()).unwrap(), id.unwrap());
    assert!(
        press(&context(&none, Some(id), &tools), PenSample::at(LINE[0]), StrokePurpose::Erase)
            .0
            .is_none()
    );
}

fn blank() -> Content {
    Content::Strokes(Live::new(StrokeList::default()))
}

#[test]
fn mirror_images_are_strokes_of_their_own() {
    let symmetry = SymmetrySettings { kind: Symmetry::Vertical, ..SymmetrySettings::default() };
    let empty = Document { symmetry, ..Document::empty(Size::new(200, 150)) };
    let brush = Brush { size: 8.0, hardness: 1.0, ..Brush::default() };
    let tools = ToolSettings::with_brush(brush);
    let mirrored = context(&empty, None, &tools);
    let (document, _) =
        draw(&mirrored, StrokePurpose::Paint, &[vec2(20.0, 40.0), vec2(60.0, 90.0)]);
    let Content::Strokes(list) = &document.layers[0].content else { panic!("a stroke layer") };
    let ends: Vec<Vec2> =
        list.params().strokes.iter().map(|stroke| stroke.samples()[1].at).collect();
    assert_eq!(ends, [vec2(60.0, 90.0), vec2(140.0, 90.0)]);
    let paint = Document { symmetry, ..paint_layer() };
    let on_paint = ToolContext { document: &paint, layer: None, ..mirrored };
    let id = on_paint.document.layers[0].id;
    let (painted, _) = draw(
        &ToolContext { layer: Some(id), ..on_paint },
        StrokePurpose::Paint,
        &[vec2(20.0, 40.0)],
    );
    assert_eq!((tiles(&painted).pixel(20, 40)[3], tiles(&painted).pixel(179, 40)[3]), (255, 255));
}

#[test]
fn a_calmed_line_is_finished_when_the_pen_lifts() {
    let empty = Document::empty(Size::new(200, 150));
    let brush =
        Brush { size: 8.0, stabilizer: Stabilizer::String { length_px: 40.0 }, ..Brush::default() };
    let tools = ToolSettings::with_brush(brush);
    let (document, _) = draw(
        &context(&empty, None, &tools),
        StrokePurpose::Paint,
        &[vec2(20.0, 40.0), vec2(120.0, 40.0)],
    );
    let Content::Strokes(list) = &document.layers[0].content else { panic!("a stroke layer") };
    let places: Vec<f32> = list.params().strokes[0].samples().iter().map(|s| s.at.x).collect();
    assert_eq!(places, [20.0, 80.0, 120.0]);
}

#[test]
fn an_erasing_brush_takes_nothing_from_paint_whose_alpha_is_locked() {
    let brush = Brush { size: 30.0, hardness: 1.0, ..Brush::default() };
    let tools = ToolSettings::with_brush(brush);
    let document = paint_layer();
    let id = Some(document.layers[0].id);
    let (painted, _) = draw(&context(&document, id, &tools), StrokePurpose::Paint, &LINE);
    let locked =
        painted.with_layer(painted.layers[0].id, |layer| layer.lock = LayerLock::Alpha).unwrap();
    let (erased, _) = draw(&context(&locked, id, &tools), StrokePurpose::Erase, &LINE);
    assert_eq!(tiles(&erased).pixel(60, 52), [0, 0, 0, 255]);
}

#[test]
fn what_is_redrawn_while_drawing_does_not_grow_with_the_stroke() {
    use crate::document::diff::diff;
    let (empty, brush) =
        (Document::empty(Size::new(2000, 500)), Brush { size: 20.0, ..Brush::default() });
    let tools = ToolSettings::with_brush(brush);
    let (gesture, first) = press(
        &context(&empty, None, &tools),
        PenSample::at(vec2(20.0, 100.0)),
        StrokePurpose::Paint,
    );
    let (mut gesture, Outcome::Preview(mut before)) = (gesture.unwrap(), first) else {
        panic!("it shows")
    };
    for i in 1..90 {
        let Outcome::Preview(next) =
            gesture.drag(&[PenSample::at(vec2(20.0 + 20.0 * i as f32, 100.0))])
        else {
            panic!("it shows")
        };
        let redrawn = diff(&before, &next).len();
        assert!(redrawn <= 8, "{redrawn} tiles at sample {i}");
        before = next;
    }
}
