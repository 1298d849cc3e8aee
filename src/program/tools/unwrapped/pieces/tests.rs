use super::super::tests::{document, layout_of};
use super::*;
use crate::document::Layer;
use crate::math::{Affine2, srgb::Color};
use crate::paint::{Adjust, GradientStop, ImageFilter, PictureSource, Placement};
use crate::raster::{Outside, Picture};
use crate::surface::{Anchor, Operator};
use crate::tools::ToolKind;
use crate::tools::ToolSettings;
use proptest::prelude::*;
use std::sync::{Arc, LazyLock};

/// The cylinder and the board, with a picture on both, whose plane is turned on the cylinder by its
/// anchors.
fn painted_document() -> Document {
    let document = document();
    let surface = document.surface.clone().unwrap();
    let plain = layout_of(&document);
    let [a, b] = [vec2(80.5, 40.5), vec2(120.5, 40.5)];
    let [u, v] = [a, b].map(|q| plain.sheet_at(&surface, q).unwrap());
    let pins = [Anchor { at: a, source: u }, Anchor { at: b, source: u + (v - u).perp() }];
    let picture = Picture::srgb8(document.size, vec![[9; 4]; document.size.area()]).unwrap();
    let image = PlacedImage {
        source: PictureSource::new("p.png".into(), picture, Adjust::default()),
        placement: Placement::covering(document.size),
        outside: Outside::Repeat,
        bend: Bend {
            operator: Operator::Surface { amount: 1.0, smooth: 0.0 },
            anchors: pins.to_vec(),
            ..Bend::default()
        },
        filter: ImageFilter::Antialias,
        frame: Default::default(),
    };
    Document {
        layers: vec![Arc::new(Layer::new("print", Content::Image(Live::new(image))))],
        ..document
    }
}

/// Unwrapped once.
static BARE: LazyLock<Document> = LazyLock::new(document);

/// The same shapes under a ramp between two points of the cylinder.
fn ramp_document(from: Vec2, to: Vec2) -> Document {
    let stops = [(0.0, Color::BLACK), (1.0, Color::WHITE)]
        .map(|(t, color)| GradientStop { t, color })
        .to_vec();
    let (operator, filter) =
        (Operator::Surface { amount: 1.0, smooth: 0.0 }, ImageFilter::Bilinear);
    let ramp = Gradient {
        from,
        to,
        stops,
        operator,
        filter,
        frame: Default::default(),
        style: Default::default(),
        pieces: Vec::new(),
    };
    Document {
        layers: vec![Arc::new(Layer::new("ramp", Content::Gradient(Live::new(ramp))))],
        ..BARE.clone()
    }
}

fn image_point_at(document: &Document, q: Vec2) -> Vec2 {
    let bend = bend_on_pieces(&document.layers[0].content).unwrap();
    Deformation::new(document.surface.as_deref(), document.size, &bend).at(q.x as i32, q.y as i32)
}

/// The drawing after a drag from the sheet's point of a canvas point to another, or by some px.
fn drag_on_sheet(document: &Document, keys: ModifierKeys, from: Vec2, to: Vec2) -> Document {
    let tools = ToolSettings::default();
    let context =
        ToolContext { layer: Some(document.layers[0].id), ..ToolContext::new(document, &tools) };
    let pen = PenSample { keys, ..PenSample::at(from) };
    let (gesture, _) = super::super::point(&context, pen, layout_of(document), ToolKind::Image);
    let mut gesture = gesture.expect("a piece is held");
    gesture.drag(&[PenSample { keys, ..PenSample::at(to) }]);
    let Outcome::Commit { document, .. } = gesture.release() else { panic!("a step") };
    document
}

#[test]
fn a_drag_on_the_sheet_takes_the_picture_of_one_piece_along() {
    let before = painted_document();
    let layout = layout_of(&before);
    let surface = before.surface.clone().unwrap();
    let on_sheet = |x: f32, y: f32| layout.sheet_at(&surface, vec2(x, y)).unwrap();
    let (from, to) = (on_sheet(90.5, 60.5), on_sheet(110.5, 75.5));
    let after = drag_on_sheet(&before, ModifierKeys::default(), from, to);
    let (was, is) =
        (image_point_at(&before, vec2(90.5, 60.5)), image_point_at(&after, vec2(110.5, 75.5)));
    assert!(was.distance(is) < 0.05, "what was under the pen is under it: {was} and {is}");
    let board = vec2(250.5, 60.5);
    assert_eq!(image_point_at(&before, board), image_point_at(&after, board));
}

#[test]
fn handles_scale_and_turn_about_the_middle_of_the_piece() {
    let before = painted_document();
    let layout = layout_of(&before);
    let surface = before.surface.clone().unwrap();
    let piece = layout.pieces()[0];
    let middle = layout.middle_of(&surface, &piece);
    let pivot = layout.sheet_at(&surface, middle).unwrap();
    let gizmo = PieceGizmo::of(&piece, 1.0).unwrap();
    let larger = drag_on_sheet(
        &before,
        ModifierKeys::default(),
        gizmo.corners[0],
        pivot + (gizmo.corners[0] - pivot) * 2.0,
    );
    let away = |document: &Document, q: Vec2| {
        image_point_at(document, q) - image_point_at(document, middle)
    };
    let beside = middle + vec2(20.0, 10.0);
    assert!(away(&larger, beside).distance(0.5 * away(&before, beside)) < 0.1, "twice as large");
    let turn = Affine2::from_translation(pivot)
        * Affine2::from_angle(-0.5)
        * Affine2::from_translation(-pivot);
    let turned = drag_on_sheet(
        &before,
        ModifierKeys::default(),
        gizmo.knob,
        turn.transform_point2(gizmo.knob),
    );
    let Content::Image(live) = &turned.layers[0].content else { panic!("an image") };
    assert!(
        (live.params().bend.pieces[0].rotation - 0.5f32.to_degrees()).abs() < 0.1,
        "counter-clockwise"
    );
    assert!((away(&turned, beside).length() / away(&before, beside).length() - 1.0).abs() < 1e-3);
    // A second drag continues from the first.
    let twice = drag_on_sheet(
        &turned,
        ModifierKeys { ctrl: true, ..Default::default() },
        pivot + Vec2::X,
        pivot + Vec2::Y,
    );
    let Content::Image(live) = &twice.layers[0].content else { panic!("an image") };
    assert_eq!(live.params().bend.pieces.len(), 1);
}

#[test]
fn other_layers_and_operators_are_refused_in_a_sentence() {
    let flat = document();
    let tools = ToolSettings::default();
    let outcome = |document: &Document| {
        let layer = document.layers.first().map(|layer| layer.id);
        press(
            &ToolContext { layer, ..ToolContext::new(document, &tools) },
            PenSample::at(vec2(60.0, 60.0)),
            &layout_of(document),
        )
        .1
    };
    assert!(matches!(outcome(&flat), Outcome::Refused(_)));
    let painted = painted_document();
    let Content::Image(live) = &painted.layers[0].content else { panic!("an image") };
    let mut image = live.params().clone();
    image.bend.operator = Operator::Depth { gamma: 1.0 };
    let bent = painted
        .with_layer(painted.layers[0].id, |layer| layer.content = Content::Image(Live::new(image)));
    assert!(matches!(outcome(&bent.unwrap()), Outcome::Refused(_)));
}

proptest! {
    #[test]
    fn a_drag_takes_a_ramp_on_one_piece_along_however_its_ends_scale_it(
        (from_x, to_x, y) in (40.5f32..95.0, 105.0f32..160.0, 20.5f32..100.0),
        (pen_x, pen_y, goal_x, goal_y) in (45.5f32..155.0, 10.5f32..110.0, 45.5f32..155.0, 10.5f32..110.0),
        shift in any::<bool>(),
    ) {
        let before = ramp_document(vec2(from_x, y), vec2(to_x, 110.0 - y));
        let (layout, surface) = (layout_of(&before), before.surface.clone().unwrap());
        // Where pixels are, so that what is shown under the pen is known exactly.
        let center = |x: f32, y: f32| vec2(x.floor() + 0.5, y.floor() + 0.5);
        let (pen, goal) = (center(pen_x, pen_y), center(goal_x, goal_y));
        let [from, to] = [pen, goal].map(|q| layout.sheet_at(&surface, q).unwrap());
        let keys = ModifierKeys { shift, ..Default::default() };
        let drag = if shift { PieceDrag::Scale } else { PieceDrag::Move };
        // Beside the handles, those of the board too.
        prop_assume!(grab_piece(&layout, from, 1.0, keys) == Some((layout.pieces()[0], drag)));
        let pivot = layout.sheet_at(&surface, layout.middle_of(&surface, &layout.pieces()[0])).unwrap();
        let after = drag_on_sheet(&before, keys, from, to);
        let board = vec2(250.5, 60.5);
        prop_assert_eq!(image_point_at(&before, board), image_point_at(&after, board));
        let Content::Gradient(live) = &after.layers[0].content else { panic!("a gradient") };
        if shift {
            let wanted = (to.distance(pivot) / from.distance(pivot).max(1.0)).max(0.01);
            prop_assert!((live.params().pieces[0].scale / wanted - 1.0).abs() < 1e-3);
        } else {
            // Whole px of the ramp's plane, which its ends scale by up to 1.5.
            let (was, is) = (image_point_at(&before, pen), image_point_at(&after, goal));
            prop_assert!(was.distance(is) < 0.1, "under the pen was {}, is {}", was, is);
        }
    }
}
