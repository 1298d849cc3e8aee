use super::*;
use crate::document::symmetry::SymmetryAxes;
use crate::document::{Content, Layer, Live, StrokeList, Symmetry};
use crate::math::{Size, vec2};
use crate::paint::Brush;
use crate::tools::ToolSettings;
use crate::tools::purpose::StrokePurpose;
use crate::tools::snap::ViewAids;
use crate::tools::{ModifierKeys, brush};

fn empty() -> Document {
    let strokes = Content::Strokes(Live::new(StrokeList::default()));
    Document {
        layers: vec![Arc::new(Layer::new("Strokes", strokes))],
        ..Document::empty(Size::new(200, 150))
    }
}

fn with(kind: AssistantKind, points: &[Vec2]) -> Document {
    Document { assistants: Arc::new(vec![Assistant { kind, points: points.to_vec() }]), ..empty() }
}

/// A stroke through points with some magnetism; the places of its samples.
fn stroke(document: &Document, points: &[Vec2], magnetism: f32) -> Vec<Vec2> {
    let hard = Brush { size: 4.0, ..Brush::default() };
    let aids = ViewAids { magnetism, ..ViewAids::default() };
    let tools = ToolSettings { aids, ..ToolSettings::with_brush(hard) };
    let layer = Some(document.layers[0].id);
    let context = ToolContext { layer, ..ToolContext::new(document, &tools) };
    let start = |context: &ToolContext, pen| brush::press(context, pen, StrokePurpose::Paint);
    let mut gesture = press_along(&context, PenSample::at(points[0]), start).0.unwrap();
    for point in &points[1..] {
        gesture.drag(&[PenSample::at(*point)]);
    }
    let Outcome::Commit { document, select, .. } = gesture.release() else {
        panic!("a stroke is kept")
    };
    let strokes = document.strokes(select.unwrap());
    strokes[0].samples().iter().map(|sample| sample.at).collect()
}

fn drag_tool(
    document: &Document,
    kind: AssistantKind,
    from: Vec2,
    to: Vec2,
    alt: bool,
) -> Option<Document> {
    let aids = ViewAids { assistant: kind, snaps: false, ..ViewAids::default() };
    let tools = ToolSettings { aids, ..ToolSettings::default() };
    let context = ToolContext::new(document, &tools);
    let keys = ModifierKeys { alt, ..ModifierKeys::default() };
    let committed = |outcome| match outcome {
        Outcome::Commit { document, .. } => Some(document),
        _ => None,
    };
    let (gesture, outcome) = press(&context, PenSample { keys, ..PenSample::at(from) });
    let Some(mut gesture) = gesture else { return committed(outcome) };
    gesture.drag(&[PenSample::at(to)]);
    committed(gesture.release())
}

#[test]
fn a_stroke_beside_a_line_is_drawn_on_it() {
    let ruled = with(AssistantKind::Line, &[vec2(10.0, 50.0), vec2(190.0, 50.0)]);
    let shaky = [vec2(30.0, 58.0), vec2(34.0, 57.0), vec2(60.0, 44.0), vec2(120.0, 61.0)];
    let drawn = stroke(&ruled, &shaky, 1.0);
    assert!(drawn.iter().all(|at| (at.y - 50.0).abs() < 1e-3), "{drawn:?}");
    assert_eq!((drawn[0].x.round(), drawn.last().unwrap().x.round()), (30.0, 120.0));
    let half = stroke(&ruled, &shaky, 0.5);
    assert!((half.last().unwrap().y - 55.5).abs() < 1e-3, "halfway with half the magnetism");
    assert_eq!(stroke(&ruled, &shaky, 0.0), stroke(&empty(), &shaky, 1.0));
    let away = [vec2(30.0, 100.0), vec2(60.0, 104.0), vec2(120.0, 101.0)];
    assert_eq!(stroke(&ruled, &away, 1.0), stroke(&empty(), &away, 1.0), "too far away");
}

#[test]
fn the_first_points_choose_among_the_lines_of_a_perspective() {
    let perspective = with(AssistantKind::TwoPoint, &[vec2(-400.0, 40.0), vec2(700.0, 40.0)]);
    let from = vec2(100.0, 100.0);
    for (to, along) in [
        (vec2(40.0, 95.0), vec2(-500.0, -60.0)),
        (vec2(150.0, 92.0), vec2(600.0, -60.0)),
        (vec2(103.0, 140.0), vec2(0.0, 1.0)),
    ] {
        let drawn = stroke(&perspective, &[from, from.lerp(to, 0.5), to, to + vec2(3.0, 3.0)], 1.0);
        let off = |at: &Vec2| (*at - from).perp_dot(along.normalize()).abs();
        assert!(drawn.iter().all(|at| off(at) < 1e-2), "{to}: {drawn:?}");
    }
}

#[test]
fn a_dot_is_a_dot_and_an_ellipse_is_gone_round() {
    let round =
        with(AssistantKind::Ellipse, &[vec2(20.0, 75.0), vec2(180.0, 75.0), vec2(100.0, 25.0)]);
    let dot = stroke(&round, &[vec2(100.0, 28.0), vec2(100.0, 29.0)], 1.0);
    assert_eq!(dot[0], vec2(100.0, 28.0));
    let drawn = stroke(
        &round,
        &[vec2(100.0, 28.0), vec2(130.0, 30.0), vec2(170.0, 60.0), vec2(176.0, 90.0)],
        1.0,
    );
    let on = |at: &Vec2| ((at.x - 100.0) / 80.0).powi(2) + ((at.y - 75.0) / 50.0).powi(2);
    assert!(drawn.iter().all(|at| (on(at) - 1.0).abs() < 1e-3), "{drawn:?}");
}

#[test]
fn assistants_are_laid_moved_and_taken_away_each_in_one_step() {
    let none = empty();
    let laid =
        drag_tool(&none, AssistantKind::Line, vec2(20.0, 20.0), vec2(90.0, 60.0), false).unwrap();
    assert_eq!(laid.assistants[0].points, [vec2(20.0, 20.0), vec2(90.0, 60.0)]);
    let moved =
        drag_tool(&laid, AssistantKind::Line, vec2(92.0, 61.0), vec2(100.0, 20.0), false).unwrap();
    assert_eq!(moved.assistants[0].points, [vec2(20.0, 20.0), vec2(100.0, 20.0)]);
    let gone =
        drag_tool(&moved, AssistantKind::Line, vec2(21.0, 20.0), vec2(21.0, 20.0), true).unwrap();
    assert!(gone.assistants.is_empty());
    assert!(
        drag_tool(&none, AssistantKind::Line, vec2(20.0, 20.0), vec2(21.0, 20.0), false).is_none(),
        "a click"
    );
    let point =
        drag_tool(&none, AssistantKind::OnePoint, vec2(20.0, 20.0), vec2(21.0, 20.0), false)
            .unwrap();
    assert_eq!(point.assistants[0].points.len(), 1);
    for (kind, _) in AssistantKind::ALL {
        let laid = drag_tool(&none, kind, vec2(20.0, 20.0), vec2(90.0, 60.0), false).unwrap();
        assert!(laid.assistants[0].fits().is_ok() && laid.fits(None).is_ok(), "{kind:?}");
    }
}

#[test]
fn axes_of_symmetry_are_moved_by_their_middle_and_turned_by_their_end() {
    let (mut document, tools) = (empty(), ToolSettings::default());
    document.symmetry.kind = Symmetry::Vertical;
    let context = ToolContext::new(&document, &tools);
    let drag = |from: Vec2, to: Vec2| {
        let mut gesture = press(&context, PenSample::at(from)).0.unwrap();
        gesture.drag(&[PenSample::at(to)]);
        let Outcome::Commit { document, .. } = gesture.release() else { panic!("a step") };
        document.symmetry.axes
    };
    let moved = drag(vec2(100.0, 75.0), vec2(60.0, 50.0));
    assert_eq!(moved.middle(document.size), vec2(60.0, 50.0));
    let end = SymmetryAxes::default().handles(document.size, 1.0)[1];
    let turned = drag(end, vec2(160.0, 75.0));
    let images = Symmetry::Vertical.images_about(document.size, turned);
    let at = images[1].sample(&crate::paint::Sample::at(vec2(30.0, 20.0))).at;
    assert!(at.distance(vec2(30.0, 130.0)) < 1e-2, "{at}: the axis lies level now");
}
