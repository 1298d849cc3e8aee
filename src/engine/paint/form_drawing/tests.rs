//! Strokes along the lines of a form. Floor 3.

use super::*;
use crate::math::vec2;
use crate::math::{Size, Vec3, vec3};
use crate::paint::sample::Sample;
use crate::paint::stroke;
use crate::raster::Plane;
use crate::raster::TileAt;
use crate::surface::form_lines::{FormLine, LineKind, LineKinds, LinePoint};
use crate::surface::hatching::{GuideLines, HatchPoint, HatchStyle};
use crate::surface::{Maps, Surface};

/// A roof over the canvas, its ridge from side to side.
fn roof() -> Scene {
    let size = Size::new(160, 120);
    let side = |y: usize| if y < 60 { 1.0 } else { -1.0 };
    let normals = Plane::from_fn(size, |_, y| vec3(0.0, 0.6 * side(y), 0.8));
    let depth = Plane::from_fn(size, |_, y| 0.005 * (y as f32 + 0.5 - 60.0).abs());
    let coverage = Plane::full(size, 255);
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
fn a_line_along_the_nib_is_thin_and_one_across_it_is_not() {
    let scene = roof(); // its ridge runs level
    let heaviest = |by_angle: f32, nib_angle: f32| {
        let hand = DrawingHand { by_angle, nib_angle, taper: 0.0, ..DrawingHand::DEFAULT };
        let strokes = drawing(hand).strokes(&scene);
        strokes[0].samples().iter().map(|s| s.pressure).fold(0.0, f32::max)
    };
    let plain = heaviest(0.0, 0.0);
    for (by_angle, nib_angle, share) in
        [(1.0, 90.0, 1.0), (1.0, 30.0, 0.5), (0.5, 30.0, 0.75), (0.6, 180.0, 0.4)]
    {
        let weight = heaviest(by_angle, nib_angle) / plain;
        assert!((weight - share).abs() < 0.02, "{by_angle} at {nib_angle}°: {weight}, not {share}");
    }
    // Degrees run anticlockwise as seen: a line that rises to the right is thin at 45°.
    let rising = rising_line();
    let weight = |nib_angle: f32| {
        let hand = DrawingHand { by_angle: 1.0, nib_angle, taper: 0.0, ..DrawingHand::DEFAULT };
        let light =
            hand::LightOnLines { surface: scene.surface.as_deref().unwrap(), light: Vec3::Y };
        let stroke = hand.stroke(&drawing(hand), &rising, &light);
        stroke.samples().iter().map(|s| s.pressure).fold(0.0, f32::max)
    };
    assert!(weight(45.0) < 0.05 && weight(135.0) > 0.4, "{} {}", weight(45.0), weight(135.0));
}

/// A line across the roof that rises to the right.
fn rising_line() -> FormLine {
    let point = |i: u32| {
        let at = vec2(20.0 + i as f32, 100.0 - i as f32);
        LinePoint { at, strength: 1.0 }
    };
    let points = (0..60).map(point).collect();
    FormLine { kind: LineKind::Crease, points, is_closed: false, is_joined: [false; 2] }
}

#[test]
fn twice_the_canvas_doubles_the_drawing() {
    let drawing = drawing(DrawingHand { wobble: 2.0, ..DrawingHand::DEFAULT });
    let FormPattern::Lines(lines) = drawing.scaled(2.0).pattern else { panic!("lines") };
    assert_eq!((lines.smooth, lines.shortest, lines.detail), (4.0, 24.0, 0.6));
    let twice = drawing.scaled(2.0);
    assert_eq!((twice.hand.wobble, twice.brush.size), (4.0, 8.0));
    assert_eq!(twice.hand.by_light, drawing.hand.by_light);
}

/// A sheet whose normals turn from the light to away from it, from left to right.
fn turning() -> Scene {
    let size = Size::new(384, 192);
    let normals = Plane::from_fn(size, |x, _| {
        let turn = (x as f32 / 384.0 - 0.5) * 1.8;
        vec3(-turn.sin(), 0.0, turn.cos())
    });
    let depth = Plane::full(size, 0.5);
    let coverage = Plane::full(size, 255);
    let surface = Surface::new(Maps { normals, depth, coverage }).unwrap();
    Scene { size, surface: Some(Arc::new(surface)) }
}

fn hatching(style: HatchStyle) -> FormDrawing {
    let settings = HatchSettings {
        style,
        light: vec3(-0.8, 0.0, 0.6),
        shadow: 0.0,
        hollows: 0.0,
        spacing: 8.0,
        ..HatchSettings::DEFAULT
    };
    let hand = DrawingHand { taper: 0.0, ..DrawingHand::DEFAULT };
    FormDrawing { hand, ..FormDrawing::new(FormPattern::Hatching(settings)) }
}

#[test]
fn hatching_covers_what_the_tone_asks() {
    let scene = turning();
    for (style, _) in HatchStyle::ALL {
        let drawing = hatching(style);
        let FormPattern::Hatching(settings) = &drawing.pattern else { panic!("hatching") };
        let tone = hatched::FormTone::of(scene.surface.as_deref().unwrap(), settings, None);
        let strokes = drawing.strokes(&scene);
        let mut coverage = Plane::full(scene.size, 0.0f32);
        for at in TileAt::covering(scene.size.rect()) {
            let Some(tile) = stroke::render_tile(&strokes, &scene, at) else { continue };
            let corner = at.rect();
            for (i, pixel) in tile.bytes().chunks_exact(4).enumerate() {
                let (x, y) = (corner.x0 as usize + i % 64, corner.y0 as usize + i / 64);
                coverage.set(x, y, f32::from(pixel[3]) / 255.0);
            }
        }
        let mut off: Vec<f32> = Vec::new();
        for (cx, cy) in
            (20..370).step_by(12).flat_map(|x| (24..172).step_by(12).map(move |y| (x, y)))
        {
            let (mut sum, mut wanted, mut count) = (0.0, 0.0, 0.0);
            for (x, y) in (cx - 12..=cx + 12).flat_map(|x| (cy - 12..=cy + 12).map(move |y| (x, y)))
            {
                let from = vec2(x as f32 - cx as f32, y as f32 - cy as f32);
                if from.length() <= 12.0 {
                    sum += coverage.at(x as usize, y as usize);
                    wanted += tone.dark(vec2(x as f32 + 0.5, y as f32 + 0.5));
                    count += 1.0;
                }
            }
            off.push((sum - wanted) / count);
        }
        let mean = off.iter().sum::<f32>() / off.len() as f32;
        off.iter_mut().for_each(|v| *v = v.abs());
        off.sort_by(f32::total_cmp);
        let (p50, p90) = (off[off.len() / 2], off[off.len() * 9 / 10]);
        assert!(p50 < 0.03 && p90 < 0.06, "{style:?}: mean {mean}, median {p50}, p90 {p90}");
    }
}

#[test]
fn hatching_that_stays_does_not_move_with_the_light() {
    let scene = turning();
    let before = hatching(HatchStyle::Crosshatch);
    let mut after = before.clone();
    let (sin, cos) = 5f32.to_radians().sin_cos();
    let light = before.light();
    *after.light_mut() = vec3(cos * light.x - sin * light.z, 0.0, sin * light.x + cos * light.z);
    let places = |drawing: &FormDrawing| -> std::collections::HashSet<[u32; 2]> {
        let strokes = drawing.strokes(&scene);
        let inner = strokes.iter().flat_map(|s| &s.samples()[1..s.samples().len() - 1]);
        inner.map(|sample| sample.at.to_array().map(f32::to_bits)).collect()
    };
    let (a, b) = (places(&before), places(&after));
    assert!(a != b);
    // Ends move along their lines; all else is where it was, on lines that light has no part in.
    let kept = a.intersection(&b).count();
    assert!(kept * 10 > a.len().min(b.len()) * 9, "{kept} of {} and {}", a.len(), b.len());
    let surface = scene.surface.as_deref().unwrap();
    let lines = surface.hatch_lines(before.hatching().unwrap(), &GuideLines::none());
    let points = lines.lines.iter().flat_map(|line| &line.points);
    let place = |point: &HatchPoint| Sample::at(point.at).normalized().at;
    let on_lines: std::collections::HashSet<_> =
        points.map(|point| place(point).to_array().map(f32::to_bits)).collect();
    assert!(a.is_subset(&on_lines) && b.is_subset(&on_lines));
}

#[test]
fn hatching_grows_evenly_as_the_light_turns() {
    let scene = turning();
    let pressures = |degrees: f32| -> std::collections::HashMap<[u32; 2], f32> {
        let mut drawing = hatching(HatchStyle::Crosshatch);
        let (sin, cos) = degrees.to_radians().sin_cos();
        *drawing.light_mut() = vec3(-cos, 0.0, sin);
        let strokes = drawing.strokes(&scene);
        let inner = strokes.iter().flat_map(|s| &s.samples()[1..s.samples().len() - 1]);
        inner.map(|s| (s.at.to_array().map(f32::to_bits), s.pressure)).collect()
    };
    let (a, b) = (pressures(40.0), pressures(41.0));
    let both = a.iter().filter_map(|(at, before)| Some((before - b.get(at)?).abs()));
    let (most, count) = both.fold((0.0f32, 0), |(most, n), change| (most.max(change), n + 1));
    assert!(count > 1000 && most < 0.12, "{most} at {count}");
    // What comes or goes is thin: a fifth of the brush at most.
    let new = b.iter().filter(|(at, _)| !a.contains_key(*at)).map(|(_, pressure)| *pressure);
    let mut new: Vec<f32> = new.collect();
    new.sort_by(f32::total_cmp);
    assert!(new.is_empty() || new[new.len() * 9 / 10] < 0.2, "{:?}", new.last());
}
