use super::*;
use crate::document::{
    Content, Group, Layer, LayerLock, LayerTransform, PixelLayer, TransformShape,
};
use crate::math::{Size, vec2};
use crate::raster::TileGrid;
use crate::tools::ModifierKeys;
use crate::tools::gizmo::GizmoMemory;
use crate::tools::{DocumentChoice, ToolSettings};
use std::sync::Arc;

/// A square of paint from (40, 30) to (80, 50).
fn document() -> Document {
    let tiles = TileGrid::from_straight_rgba(&[9, 90, 200, 255].repeat(40 * 20), 40, 20, 40, 30);
    let paint = Layer::new("paint", Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() }));
    Document { layers: vec![Arc::new(paint)], ..Document::empty(Size::new(200, 100)) }
}

fn pen(at: Vec2, keys: ModifierKeys) -> PenSample {
    PenSample { keys, ..PenSample::at(at) }
}

fn drag(document: &Document, from: Vec2, to: Vec2, keys: ModifierKeys) -> Option<Document> {
    let (tools, layer) = (ToolSettings::default(), Some(document.layers[0].id));
    // Zoomed in, so that the handles of the small square lie apart.
    let context = ToolContext { layer, px_per_pt: 0.3, ..ToolContext::new(document, &tools) };
    let mut gesture = press(&context, pen(from, keys)).0?;
    gesture.drag(&[pen(to, keys)]);
    match gesture.release() {
        Outcome::Commit { document, .. } => Some(document),
        _ => None,
    }
}

fn corners(document: &Document) -> [Vec2; 4] {
    TransformGizmo::of(document, document.layers[0].id).unwrap().corners
}

fn close(a: [Vec2; 4], b: [(f32, f32); 4]) {
    for (a, (x, y)) in a.into_iter().zip(b) {
        assert!(a.distance(vec2(x, y)) < 1e-2, "{a}, not ({x}, {y})");
    }
}
const NONE: ModifierKeys = ModifierKeys { shift: false, ctrl: false, alt: false };

#[test]
fn the_frame_is_the_box_around_the_paint() {
    close(corners(&document()), [(40.0, 30.0), (80.0, 30.0), (80.0, 50.0), (40.0, 50.0)]);
}

#[test]
fn the_inside_moves_by_whole_pixels_and_back_leaves_no_transform() {
    let moved = drag(&document(), vec2(50.0, 40.0), vec2(57.4, 37.1), NONE).unwrap();
    close(corners(&moved), [(47.0, 27.0), (87.0, 27.0), (87.0, 47.0), (47.0, 47.0)]);
    let back = drag(&moved, vec2(60.0, 40.0), vec2(53.0, 43.0), NONE).unwrap();
    assert_eq!(back.layers[0].transform, None);
    assert!(
        drag(&document(), vec2(50.0, 40.0), vec2(50.2, 40.0), NONE).is_none(),
        "nothing was moved"
    );
}

#[test]
fn a_corner_goes_where_the_pen_goes_and_the_opposite_one_stays() {
    let scaled = drag(&document(), vec2(80.0, 50.0), vec2(100.0, 70.0), NONE).unwrap();
    close(corners(&scaled), [(40.0, 30.0), (100.0, 30.0), (100.0, 70.0), (40.0, 70.0)]);
    let about_middle = ModifierKeys { alt: true, ..NONE };
    let scaled = drag(&document(), vec2(80.0, 50.0), vec2(90.0, 60.0), about_middle).unwrap();
    close(corners(&scaled), [(30.0, 20.0), (90.0, 20.0), (90.0, 60.0), (30.0, 60.0)]);
    let kept_aspect = ModifierKeys { shift: true, ..NONE };
    let scaled = drag(&document(), vec2(80.0, 50.0), vec2(120.0, 52.0), kept_aspect).unwrap();
    close(corners(&scaled), [(40.0, 30.0), (120.0, 30.0), (120.0, 70.0), (40.0, 70.0)]);
}

#[test]
fn an_edge_stretches_one_side_and_with_ctrl_it_skews() {
    let wider = drag(&document(), vec2(80.0, 40.0), vec2(120.0, 90.0), NONE).unwrap();
    close(corners(&wider), [(40.0, 30.0), (120.0, 30.0), (120.0, 50.0), (40.0, 50.0)]);
    let skew = ModifierKeys { ctrl: true, ..NONE };
    let skewed = drag(&document(), vec2(60.0, 30.0), vec2(70.0, 30.0), skew).unwrap();
    close(corners(&skewed), [(50.0, 30.0), (90.0, 30.0), (80.0, 50.0), (40.0, 50.0)]);
}

#[test]
fn outside_turns_about_the_middle_in_steps_with_shift() {
    // From the right to above: a quarter turn counter-clockwise as seen.
    let turned = drag(
        &document(),
        vec2(160.0, 40.0),
        vec2(62.0, -40.0),
        ModifierKeys { shift: true, ..NONE },
    );
    close(corners(&turned.unwrap()), [(50.0, 60.0), (50.0, 20.0), (70.0, 20.0), (70.0, 60.0)]);
}

#[test]
fn a_corner_with_ctrl_gives_a_perspective_and_no_crossed_one() {
    let distort = ModifierKeys { ctrl: true, ..NONE };
    let distorted = drag(&document(), vec2(80.0, 50.0), vec2(82.0, 51.0), distort).unwrap();
    close(corners(&distorted), [(40.0, 30.0), (80.0, 30.0), (82.0, 51.0), (40.0, 50.0)]);
    assert!(matches!(
        distorted.layers[0].transform.clone().unwrap().shape,
        TransformShape::Quad(_)
    ));
}

#[test]
fn a_corner_dragged_past_the_others_or_the_horizon_stays_as_near_as_it_can() {
    let distort = ModifierKeys { ctrl: true, ..NONE };
    let corner =
        |to| corners(&drag(&document(), vec2(80.0, 50.0), to, distort).expect("it goes on"))[2];
    let folded = corner(vec2(41.0, 31.0));
    assert!(
        folded.distance(vec2(80.0, 50.0)) > 5.0 && folded.y + 0.5 * folded.x > 70.0,
        "not folded: {folded}"
    );
    // Directly beneath the upper right corner the far side of the canvas would lie behind the
    // horizon.
    for to in [vec2(80.2, 31.0), vec2(-500.0, 4000.0), vec2(1e30, -1e30), vec2(40.0, 30.0)] {
        let at = corner(to);
        assert!(at.is_finite() && at.x > 40.0 && at.y > 30.0, "{to} led to {at}");
    }
    // Step by step the corner goes no farther than the pen.
    let mut last = corner(vec2(80.0, 50.5));
    for step in 1..400 {
        let to = vec2(80.0 - step as f32 * 0.3, 50.5 + (step as f32 * 0.1).sin() * 30.0);
        let at = corner(to);
        assert!(at.distance(last) < 6.0, "from {last} to {at} with the pen at {to}");
        last = at;
    }
}

#[test]
fn the_pivot_is_dragged_snaps_to_corners_and_is_what_is_turned_and_scaled_about() {
    let document = document();
    let tools = ToolSettings::default();
    let (ids, mut kept) = ([document.layers[0].id], GizmoMemory::default());
    let context = |kept| ToolContext {
        layer: Some(ids[0]),
        px_per_pt: 0.3,
        gizmo: kept,
        ..ToolContext::new(&document, &tools)
    };
    let pivot_by = |from: Vec2, to: Vec2, keys| {
        let mut gesture = press(&context(GizmoMemory::nothing()), pen(from, keys)).0.unwrap();
        match gesture.drag(&[pen(to, keys)]) {
            Outcome::Choose(DocumentChoice::Pivot(share)) => Some(share),
            _ => None,
        }
    };
    assert_eq!(
        pivot_by(vec2(60.5, 40.0), vec2(41.0, 31.0), NONE),
        Some(Vec2::ZERO),
        "the upper left corner"
    );
    assert_eq!(
        pivot_by(vec2(60.5, 40.0), vec2(90.0, 70.0), NONE),
        Some(vec2(1.25, 2.0)),
        "beyond the gizmo"
    );
    assert_eq!(pivot_by(vec2(50.0, 36.0), vec2(50.0, 35.0), NONE), None, "the inside moves");
    let alt = ModifierKeys { alt: true, ..NONE };
    assert_eq!(pivot_by(vec2(50.0, 36.0), vec2(50.0, 35.0), alt), Some(vec2(0.25, 0.25)));
    kept.set_pivot(&document, GizmoContent::Layers(&ids), Vec2::ZERO);
    let done = |from: Vec2, to: Vec2, keys| {
        let mut gesture = press(&context(&kept), pen(from, keys)).0.unwrap();
        gesture.drag(&[pen(to, keys)]);
        let Outcome::Commit { document, .. } = gesture.release() else { panic!("transformed") };
        corners(&document)
    };
    // A quarter counter-clockwise about the upper left corner.
    let turned = done(vec2(140.0, 30.0), vec2(40.0, -70.0), ModifierKeys { shift: true, ..NONE });
    close(turned, [(40.0, 30.0), (40.0, -10.0), (60.0, -10.0), (60.0, 30.0)]);
    let scaled = done(vec2(80.0, 50.0), vec2(60.0, 90.0), alt);
    close(scaled, [(40.0, 30.0), (60.0, 30.0), (60.0, 90.0), (40.0, 90.0)]);
    assert_eq!(kept.gizmo_for(&document, GizmoContent::Layers(&[LayerId::fresh()])), None);
}

#[test]
fn within_a_transformed_group_the_pen_still_leads() {
    let inner = document().layers[0].clone();
    let id = inner.id;
    let group = Layer {
        transform: Some(LayerTransform {
            shape: TransformShape::Matrix([0.0, -0.5, 0.5, 0.0, 30.0, 90.0]),
            filter: Default::default(),
        }),
        ..Layer::new("g", Content::Group(Group { layers: vec![inner], pass_through: false }))
    };
    let document = Document { layers: vec![Arc::new(group)], ..document() };
    let before = TransformGizmo::of(&document, id).unwrap();
    let tools = ToolSettings::default();
    let context =
        ToolContext { layer: Some(id), px_per_pt: 0.1, ..ToolContext::new(&document, &tools) };
    for (from, by) in
        [(before.pivot() + vec2(2.0, 2.0), vec2(10.0, -6.0)), (before.corners[2], vec2(5.0, -4.0))]
    {
        let mut gesture = press(&context, PenSample::at(from)).0.unwrap();
        gesture.drag(&[PenSample::at(from + by)]);
        let Outcome::Commit { document, .. } = gesture.release() else { panic!("moved") };
        let after = TransformGizmo::of(&document, id).unwrap();
        assert!(after.corners[2].distance(before.corners[2] + by) < 1e-2, "{:?}", after.corners);
    }
}

#[test]
fn two_mirrors_and_four_quarter_turns_leave_no_transform() {
    let document = document();
    let id = document.layers[0].id;
    for (map, times) in
        [(mirror(false), 2), (mirror(true), 2), (turn(90.0).unwrap(), 4), (turn(36.0).unwrap(), 10)]
    {
        let once = transform_about_middle(&document, &[id], map).unwrap();
        assert!(once.layers[0].transform.is_some());
        let all = (1..times)
            .fold(once, |document, _| transform_about_middle(&document, &[id], map).unwrap());
        let left = all.map_of(id).unwrap();
        assert!(left.is_none(), "{:?}", left.plane);
    }
}

/// Two pieces of paint apart: a square at the left, a square at the right.
fn two() -> Document {
    let square = |name: &str, x: i32| {
        let tiles = TileGrid::from_straight_rgba(&[200; 20 * 20 * 4], 20, 20, x, 40);
        Arc::new(Layer::new(name, Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() })))
    };
    Document { layers: vec![square("left", 20), square("right", 120)], ..document() }
}

fn drag_both(document: &Document, from: Vec2, to: Vec2, keys: ModifierKeys) -> Option<Document> {
    let ids: Vec<LayerId> = document.layers.iter().map(|layer| layer.id).collect();
    let tools = ToolSettings::default();
    let context =
        ToolContext { layer: Some(ids[0]), layers: &ids, ..ToolContext::new(document, &tools) };
    let mut gesture = press(&context, PenSample::at(from)).0?;
    gesture.drag(&[PenSample { keys, ..PenSample::at(to) }]);
    match gesture.release() {
        Outcome::Commit { document, .. } => Some(document),
        _ => None,
    }
}

fn corners_of(document: &Document, index: usize) -> [Vec2; 4] {
    TransformGizmo::of(document, document.layers[index].id).unwrap().corners
}

#[test]
fn several_layers_have_one_frame_and_each_goes_along_in_its_own() {
    let both = two();
    let ids: Vec<LayerId> = both.layers.iter().map(|layer| layer.id).collect();
    let gizmo = TransformGizmo::around(&both, &ids).unwrap();
    close(gizmo.corners, [(20.0, 40.0), (140.0, 40.0), (140.0, 60.0), (20.0, 60.0)]);
    // The lower right corner: half as wide, twice as high.
    let scaled = drag_both(&both, vec2(140.0, 60.0), vec2(80.0, 80.0), NONE).unwrap();
    close(corners_of(&scaled, 0), [(20.0, 40.0), (30.0, 40.0), (30.0, 80.0), (20.0, 80.0)]);
    close(corners_of(&scaled, 1), [(70.0, 40.0), (80.0, 40.0), (80.0, 80.0), (70.0, 80.0)]);
    let moved = drag_both(&scaled, vec2(50.0, 60.0), vec2(55.0, 50.0), NONE).unwrap();
    close(corners_of(&moved, 1), [(75.0, 30.0), (85.0, 30.0), (85.0, 70.0), (75.0, 70.0)]);
    let distort = ModifierKeys { ctrl: true, ..NONE };
    let distorted = drag_both(&both, vec2(140.0, 60.0), vec2(150.0, 70.0), distort).unwrap();
    assert!(corners_of(&distorted, 1)[2].distance(vec2(150.0, 70.0)) < 1e-2);
    assert!(corners_of(&distorted, 0)[0].distance(vec2(20.0, 40.0)) < 1e-2);
    let about = transform_about_middle(&both, &ids, mirror(false)).unwrap();
    close(corners_of(&about, 0), [(140.0, 40.0), (120.0, 40.0), (120.0, 60.0), (140.0, 60.0)]);
}

#[test]
fn the_frame_of_several_layers_turns_with_them() {
    let both = two();
    let ids: Vec<LayerId> = both.layers.iter().map(|layer| layer.id).collect();
    let mut kept = GizmoMemory::default();
    kept.hold(&both, GizmoContent::Layers(&ids));
    let turn = PlaneMap::rotation(30.0, vec2(80.0, 50.0));
    let turned = ids.iter().fold(both.clone(), |next, id| mapped(&next, *id, turn).unwrap());
    kept.hold(&turned, GizmoContent::Layers(&ids));
    let gizmo = kept.gizmo_for(&turned, GizmoContent::Layers(&ids)).unwrap();
    let numbers = GizmoNumbers::of(&gizmo).unwrap();
    assert!(
        (numbers.angle - 30.0).abs() < 1e-3 && (numbers.width - 120.0).abs() < 1e-3,
        "{numbers:?}"
    );
    // One of them alone moved: the gizmo is the box around both again.
    let apart = mapped(&turned, ids[0], PlaneMap::translation(vec2(9.0, 0.0))).unwrap();
    assert!(
        GizmoNumbers::of(&kept.gizmo_for(&apart, GizmoContent::Layers(&ids)).unwrap())
            .unwrap()
            .angle
            .abs()
            < 1e-6
    );
    let back = GizmoNumbers { angle: 0.0, ..numbers }.align_pivot(Vec2::splat(0.5), &numbers);
    let by = PlaneMap::affine(back.map_from(&numbers).unwrap()).unwrap();
    let back = ids.iter().fold(turned, |next, id| mapped(&next, *id, by).unwrap());
    assert!(back.layers.iter().all(|layer| layer.transform.is_none()), "nothing is left of it");
}

#[test]
fn a_locked_layer_among_several_keeps_all_of_them() {
    let both = two();
    let id = both.layers[1].id;
    let locked = both.with_layer(id, |layer| layer.lock = LayerLock::All).unwrap();
    assert!(drag_both(&locked, vec2(50.0, 50.0), vec2(60.0, 50.0), NONE).is_none());
}

#[test]
fn the_points_of_a_mesh_are_dragged_one_or_several() {
    let tiles = TileGrid::from_straight_rgba(&[9, 90, 200, 255].repeat(120 * 60), 120, 60, 40, 30);
    let paint = Layer::new("paint", Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() }));
    let plain = Document { layers: vec![Arc::new(paint)], ..Document::empty(Size::new(200, 120)) };
    let id = plain.layers[0].id;
    let document = mesh::with_grid(&plain, id, 3, 3).unwrap();
    assert!(!document.layers[0].is_warped(), "an even mesh moves nothing");
    let with_points = |selected: &[usize]| {
        let mut tools = ToolSettings::default();
        tools.transform.mesh_points = selected.to_vec();
        tools
    };
    let drag = |selected: &[usize], from: Vec2, to: Vec2| {
        let tools = with_points(selected);
        let context = ToolContext { layer: Some(id), ..ToolContext::new(&document, &tools) };
        let (gesture, outcome) = press(&context, PenSample::at(from));
        assert!(!outcome.settings().transform.mesh_points.is_empty());
        let mut gesture = gesture.unwrap();
        gesture.drag(&[PenSample::at(to)]);
        match gesture.release() {
            Outcome::Commit { document, .. } => {
                document.layers[0].transform.as_ref().unwrap().mesh().unwrap().clone()
            }
            _ => panic!("nothing was moved"),
        }
    };
    // The middle of the paint, then two points together.
    let moved = drag(&[], vec2(100.0, 60.0), vec2(110.0, 55.0));
    assert!(moved.points()[4].distance(vec2(110.0, 55.0)) < 1e-3, "{:?}", moved.points());
    assert_eq!(moved.points()[0], vec2(40.0, 30.0));
    let both = drag(&[4, 5], vec2(100.0, 60.0), vec2(100.0, 70.0));
    assert_eq!([both.points()[4].y, both.points()[5].y, both.points()[3].y], [70.0, 70.0, 60.0]);
    // With Shift points are selected, and deselected.
    let shift = ModifierKeys { shift: true, ..ModifierKeys::default() };
    let tools = with_points(&[4]);
    let context = ToolContext { layer: Some(id), ..ToolContext::new(&document, &tools) };
    let selected_at = |p: Vec2| {
        let pen = PenSample { keys: shift, ..PenSample::at(p) };
        let mut tools = tools.clone();
        press(&context, pen).1.apply_settings(&mut tools);
        tools.transform.mesh_points
    };
    assert_eq!(selected_at(vec2(40.0, 30.0)), [4, 0]);
    assert_eq!(selected_at(vec2(100.0, 60.0)), [0; 0]);
}
