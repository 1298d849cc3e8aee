//! Parts moved, touched and sculpted by a pen.

use super::part::{PartGizmo, PartHandle};
use super::*;
use crate::document::parts::PartKind;
use crate::math::Size;
use crate::shape::{Body, Primitive, SculptTool};
use crate::tools::ShapeSettings;
use crate::tools::{
    DocumentChoice, ModifierKeys, Outcome, PenSample, ToolContext, ToolKind, ToolSettings,
};

/// An inflated square and a ball in front of a corner of it.
fn scene() -> Document {
    let square =
        [(60.0, 60.0), (260.0, 60.0), (260.0, 260.0), (60.0, 260.0)].map(|(x, y)| vec2(x, y));
    let outline = crate::document::OutlineSource::Path(square.to_vec());
    let square = Part::new("square", PartKind::Inflate { outline, inflation: Default::default() });
    let ball = Part::new(
        "ball",
        PartKind::Primitive(Primitive::new(Body::Sphere, vec2(300.0, 300.0), 60.0)),
    );
    Document::empty(Size::new(400, 400)).with_parts([square, ball].map(Arc::new).to_vec())
}

fn pen(x: f32, y: f32, keys: ModifierKeys) -> PenSample {
    PenSample { keys, ..PenSample::at(vec2(x, y)) }
}

/// A drag with a tool and a selected part; the outcomes of press and release.
fn drag(
    document: &Document,
    tool: ToolKind,
    part: &str,
    way: &[(f32, f32)],
    keys: ModifierKeys,
) -> (Outcome, Option<Outcome>) {
    let tools = ToolSettings::default();
    let context = ToolContext { part: Some(part), ..ToolContext::new(document, &tools) };
    let (gesture, first) = crate::tools::press(tool, &context, pen(way[0].0, way[0].1, keys));
    let last = gesture.map(|mut gesture| {
        way[1..].iter().for_each(|at| drop(gesture.drag(&[pen(at.0, at.1, keys)])));
        gesture.release()
    });
    (first, last)
}

fn commit(outcome: Option<Outcome>) -> (String, Document) {
    match outcome {
        Some(Outcome::Commit { label, document, .. }) => (label, document),
        _ => panic!("nothing was kept"),
    }
}
const NONE: ModifierKeys = ModifierKeys { shift: false, ctrl: false, alt: false };

#[test]
fn the_part_under_the_pen_is_selected_and_moved_by_whole_pixels_with_its_surface() {
    let document = scene();
    let (first, last) =
        drag(&document, ToolKind::Shape, "square", &[(330.0, 300.0), (340.4, 310.6)], NONE);
    assert!(matches!(first, Outcome::Choose(DocumentChoice::Part(id)) if id == "ball"));
    let (label, moved) = commit(last);
    assert_eq!(
        (label.as_str(), moved.parts.part("ball").unwrap().matrix.translation),
        ("Move part", vec2(10.0, 11.0))
    );
    let (was, now) = (document.surface.unwrap(), moved.surface.unwrap());
    assert_eq!(was.normal(320, 290), now.normal(330, 301));
}

#[test]
fn handles_puff_tilt_scale_and_turn_the_selected_part() {
    let document = scene();
    let areas = document.part_areas();
    let gizmo = PartGizmo::of(&areas[0].0, &areas[0].1, 1.0);
    assert!(
        gizmo.low.distance(vec2(60.0, 60.0)) < 2.0 && gizmo.high.distance(vec2(260.0, 260.0)) < 2.0
    );
    assert_eq!(gizmo.handle_at(gizmo.middle()), Some(PartHandle::Puff));
    let drag = |from: Vec2, by: Vec2| {
        let way = [(from.x, from.y), (from.x + by.x, from.y + by.y)];
        let (label, next) = commit(drag(&document, ToolKind::Shape, "square", &way, NONE).1);
        (label, Part::clone(next.parts.part("square").unwrap()))
    };
    let (label, part) = drag(gizmo.middle(), vec2(0.0, -100.0));
    let PartKind::Inflate { inflation, .. } = &part.kind else { panic!("{}", part.kind.name()) };
    assert!(label == "Puff part" && (inflation.puff - 2.0).abs() < 0.05, "{}", inflation.puff);
    let (_, part) = drag(gizmo.tilt().unwrap(), vec2(20.0, -40.0));
    assert_eq!(part.tilt_deg, vec2(-10.0, 20.0), "it faces where the ball goes");
    let said = PartHandle::Tilt.describe(&part);
    assert_eq!(said.as_deref(), Some("Face right 10°, up 20°"));
    let surface = document.with_part(part).surface.unwrap();
    let middle = gizmo.middle().as_uvec2();
    let n = surface.normal(middle.x as usize, middle.y as usize);
    assert!(n.x > 0.1 && n.y > 0.2, "to the right and up: {n}");
    let (label, part) = drag(gizmo.profile().unwrap(), vec2(60.0, 3.0));
    let PartKind::Inflate { inflation, .. } = &part.kind else { panic!("{}", part.kind.name()) };
    assert!(label == "Pillow – tube" && inflation.profile == 0.5, "{}", inflation.profile);
    assert_eq!(PartHandle::Profile.describe(&part).as_deref(), Some("Pillow – tube 0.50"));
    let (label, part) = drag(gizmo.rim().unwrap(), vec2(0.0, 60.0));
    let PartKind::Inflate { inflation, .. } = &part.kind else { panic!("{}", part.kind.name()) };
    assert!(label == "Turn rim" && inflation.rim_deg == 50.0, "{}", inflation.rim_deg);
    let (label, part) = drag(gizmo.depth().unwrap(), vec2(8.0, -25.0));
    assert_eq!((label.as_str(), part.raise), ("Raise part", 25.0));
    let (_, part) = drag(gizmo.high, vec2(-100.0, -100.0));
    assert!((part.matrix.matrix2.x_axis.x - 0.5).abs() < 0.01, "{}", part.matrix);
    let turn = gizmo.turn();
    let (_, part) = drag(turn, gizmo.middle() + vec2(gizmo.middle().y - turn.y, 0.0) - turn);
    assert!(
        part.matrix.matrix2.x_axis.distance(Vec2::Y) < 1e-3,
        "a quarter clockwise: {}",
        part.matrix
    );
}

#[test]
fn touches_are_put_down_along_a_drag_moved_and_taken_away_and_directions_are_taken() {
    let document = scene();
    let way = [(100.0, 160.0), (105.0, 160.0), (150.0, 160.0), (200.0, 160.0)];
    let (_, last) = drag(&document, ToolKind::Touch, "square", &way, NONE);
    let (label, touched) = commit(last);
    let all = touch::touches(&touched);
    assert_eq!((label.as_str(), all.len()), ("Touch", 3), "one that is too near is left out");
    let (x, y) = (150, 160);
    let wanted = ShapeSettings::default().normal;
    let got = touched.surface.as_ref().unwrap().normal(x, y);
    assert!(
        got.dot(wanted) > 0.95 && document.surface.as_ref().unwrap().normal(x, y).dot(wanted) < 0.9,
        "{got}"
    );
    let (_, last) =
        drag(&touched, ToolKind::Touch, "square", &[(150.0, 160.0), (150.0, 200.0)], NONE);
    let (label, moved) = commit(last);
    assert_eq!((label.as_str(), touch::touches(&moved)[1].at), ("Move touch", vec2(150.0, 200.0)));
    let alt = ModifierKeys { alt: true, ..NONE };
    let (first, _) = drag(&touched, ToolKind::Touch, "square", &[(200.0, 160.0)], alt);
    assert_eq!(touch::touches(&commit(Some(first)).1).len(), 2);
    let (first, _) = drag(&document, ToolKind::Touch, "square", &[(330.0, 300.0)], alt);
    assert!(first.settings().shape.normal.x > 0.3);
    let (first, _) = drag(&document, ToolKind::Touch, "square", &[(10.0, 10.0)], NONE);
    assert!(matches!(first, Outcome::Refused(why) if why.contains("no part under the pen")));
}

#[test]
fn sculpting_raises_with_ctrl_lowers_with_shift_smooths_and_strokes_share_a_part() {
    let document = scene();
    let way = [(120.0, 160.0), (160.0, 160.0), (200.0, 160.0)];
    let (label, raised) = commit(drag(&document, ToolKind::Sculpt, "square", &way, NONE).1);
    assert_eq!(label, "Sculpt");
    let rise = |document: &Document| {
        let form = document.form_of(&document.part_areas()[0].0.id).unwrap();
        form.height.get(160 - form.corner.0, 160 - form.corner.1).unwrap()
    };
    assert!(rise(&raised) > rise(&document) + 2.0, "{} from {}", rise(&raised), rise(&document));
    let ctrl = ModifierKeys { ctrl: true, ..NONE };
    let (_, lowered) = commit(drag(&raised, ToolKind::Sculpt, "square", &way, ctrl).1);
    assert!((rise(&lowered) - rise(&document)).abs() < 0.5);
    let shift = ModifierKeys { shift: true, ..NONE };
    let (_, smoothed) = commit(drag(&lowered, ToolKind::Sculpt, "square", &way, shift).1);
    assert_eq!(smoothed.parts.list.len(), 3);
    let PartKind::Sculpt { strokes, .. } = &smoothed.parts.list[1].kind else {
        panic!("beside its part")
    };
    let tools: Vec<SculptTool> = strokes.iter().map(|stroke| stroke.tool).collect();
    assert_eq!(tools, [SculptTool::Raise, SculptTool::Lower, SculptTool::Smooth]);
}

#[test]
fn what_is_put_on_a_moved_and_turned_part_lies_under_the_pen() {
    let mut document = scene();
    let mut part = Part::clone(document.parts.part("square").unwrap());
    part.matrix = map_about(
        vec2(160.0, 160.0),
        Mat2::from_angle(0.6) * Mat2::from_diagonal(Vec2::splat(0.8)),
    );
    document = document.with_part(part);
    let (_, last) = drag(&document, ToolKind::Touch, "square", &[(170.0, 180.0)], NONE);
    let touch = touch::touches(&commit(last).1).remove(0);
    assert!(touch.at.distance(vec2(170.0, 180.0)) < 0.01);
    assert!(touch.normal.distance(ShapeSettings::default().normal) < 1e-5);
}
