//! Strokes along the lines of a form. Floor 3.

use super::*;
use crate::math::{Size, Vec3, vec3};
use crate::raster::Plane;
use crate::surface::form_lines::{LineKind, LineKinds};
use crate::surface::{Maps, Surface};

/// A roof over the canvas, its ridge from side to side.
fn roof() -> Scene {
    let size = Size::new(160, 120);
    let side = |y: usize| if y < 60 { 1.0 } else { -1.0 };
    let normals = Plane::from_fn(size, |_, y| vec3(0.0, 0.6 * side(y), 0.8));
    let depth = Plane::from_fn(size, |_, y| 0.005 * (y as f32 + 0.5 - 60.0).abs());
    let coverage = Plane::filled(size, 255);
    let surface = Surface::new(Maps { normals, depth, coverage }).unwrap();
    Scene { size, surface: Some(Arc::new(surface)) }
}

fn drawing(hand: DrawingHand) -> FormDrawing {
    let none = LineKinds::PEN.with(LineKind::Outline, false);
    let settings = LineSettings { kinds: none, light: Vec3::Y, ..LineSettings::DEFAULT };
    FormDrawing { hand, ..FormDrawing::new(FormPattern::Lines(settings)) }
}

#[test]
fn a_ridge_gets_a_tapered_stroke_along_it() {
    let scene = roof();
    let drawing = drawing(DrawingHand { taper: 30.0, ..DrawingHand::DEFAULT });
    let strokes = drawing.strokes(&scene);
    assert_eq!(strokes.len(), 1);
    let samples = strokes[0].samples();
    let off = samples.iter().map(|s| (s.at.y - 60.0).abs()).fold(0.0, f32::max);
    assert!(off < 0.3, "{off} px from the ridge");
    let (first, middle) = (samples[0], samples[samples.len() / 2]);
    assert!(first.pressure < 0.1 && middle.pressure > 0.4, "{first:?} {middle:?}");
    let xs = samples.iter().map(|s| s.at.x);
    let reach = xs.clone().fold(0.0, f32::max) - xs.fold(f32::MAX, f32::min);
    assert!(reach > 155.0, "{reach} px long");
}

#[test]
fn strokes_are_made_once_for_a_scene() {
    let (scene, drawing) = (roof(), drawing(DrawingHand::DEFAULT));
    let first = drawing.strokes(&scene);
    assert!(Arc::ptr_eq(&first, &drawing.strokes(&scene)));
    assert!(drawing.clone().made.last().is_none(), "a clone makes its own");
    let none = Scene { size: scene.size, surface: None };
    assert!(drawing.strokes(&none).is_empty());
}

#[test]
fn a_hand_overshoots_and_strays_the_same_way_each_time() {
    let scene = roof();
    let hand = DrawingHand { overshoot: 10.0, wobble: 3.0, ..DrawingHand::DEFAULT };
    let strokes = [drawing(hand).strokes(&scene), drawing(hand).strokes(&scene)];
    let samples = strokes[0][0].samples();
    assert_eq!(samples, strokes[1][0].samples());
    let off = samples.iter().map(|s| (s.at.y - 60.0).abs()).fold(0.0, f32::max);
    assert!((0.5..4.5).contains(&off), "{off}");
    let xs = samples.iter().map(|s| s.at.x).fold(0.0, f32::max);
    assert!(xs > 163.0, "{xs}");
}

#[test]
fn twice_the_canvas_doubles_the_drawing() {
    let drawing = drawing(DrawingHand { wobble: 2.0, ..DrawingHand::DEFAULT });
    let FormPattern::Lines(lines) = drawing.scaled(2.0).pattern else { panic!("lines") };
    assert_eq!((lines.smooth, lines.shortest, lines.detail), (4.0, 24.0, 0.5));
    let twice = drawing.scaled(2.0);
    assert_eq!((twice.hand.wobble, twice.brush.size), (4.0, 8.0));
    assert_eq!(twice.hand.by_light, drawing.hand.by_light);
}
