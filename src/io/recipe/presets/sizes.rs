//! Every preset's strokes on a canvas twice as large, reduced by half, compared with the strokes
//! themselves.

use super::{BrushPreset, presets};
use crate::document::{Content, Document, Layer, Live, Progress, StrokeList, flatten};
use crate::math::srgb::Color;
use crate::math::{Size, Vec2, vec2, vec3};
use crate::paint::{Brush, Sample, Stroke};
use crate::raster::Plane;
use crate::surface::{Maps, Surface};
use std::f32::consts::{PI, TAU};
use std::sync::Arc;

const SIZE: Size = Size::new(256, 192);

/// Radius of the ball, px.
const RADIUS: f32 = 88.0;

/// A ball that fills most of the canvas.
fn ball() -> Surface {
    let on = |x: usize, y: usize| (vec2(x as f32, y as f32) + 0.5 - SIZE.center()) / RADIUS;
    let height = |p: Vec2| (1.0 - p.length_squared()).max(0.0).sqrt();
    Surface::new(Maps {
        normals: Plane::from_fn(SIZE, |x, y| {
            let p = on(x, y);
            vec3(p.x, -p.y, height(p).max(0.02)).normalize_or_zero()
        }),
        depth: Plane::from_fn(SIZE, |x, y| 1.0 - height(on(x, y))),
        coverage: Plane::from_fn(SIZE, |x, y| {
            (((1.0 - on(x, y).length()) * RADIUS + 0.5).clamp(0.0, 1.0) * 255.0 + 0.5) as u8
        }),
    })
    .unwrap()
}

/// A wave from left to right, lighter at its ends, drawn in a second.
fn wave() -> Vec<Sample> {
    let at = |i: usize| {
        let t = i as f32 / 32.0;
        let from_middle = vec2(190.0 * (t - 0.5), -32.0 * (t * TAU).sin());
        Sample {
            pressure: (t * PI).sin().max(0.2),
            time_secs: t,
            ..Sample::at(SIZE.center() + from_middle)
        }
    };
    (0..=32).map(at).collect()
}

/// RGB of every pixel.
fn picture(document: &Document) -> Vec<[f32; 3]> {
    let bytes =
        flatten(document, &Progress::default()).unwrap().to_straight_rgba(document.size.rect());
    bytes.chunks_exact(4).map(|p| [0, 1, 2].map(|c| f32::from(p[c]))).collect()
}

/// The mean of each square of `by` × `by` pixels.
fn reduce(picture: &[[f32; 3]], size: Size, by: usize) -> Vec<[f32; 3]> {
    let (width, height) = (size.width as usize / by, size.height as usize / by);
    let mean = |x: usize, y: usize| {
        let square =
            (0..by * by).map(|i| picture[(y * by + i / by) * width * by + x * by + i % by]);
        square.fold([0.0; 3], |sum, p| [0, 1, 2].map(|c| sum[c] + p[c] / (by * by) as f32))
    };
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| mean(x, y)).collect()
}

/// How far two pictures are apart where one of them is painted, sorted.
fn sorted_differences(a: &[[f32; 3]], b: &[[f32; 3]], ground: Color) -> Vec<f32> {
    let ground = [ground.r, ground.g, ground.b].map(f32::from);
    let far = |a: &[f32; 3], b: &[f32; 3]| (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f32::max);
    let painted = a.iter().zip(b).filter(|(a, b)| far(a, &ground).max(far(b, &ground)) > 2.0);
    let mut apart: Vec<f32> = painted.map(|(a, b)| far(a, b)).collect();
    apart.sort_by(f32::total_cmp);
    apart
}

/// A preset's stroke in its own size, and twice as large and reduced again.
fn compare_at_twice_the_size(preset: &BrushPreset, surface: Option<Arc<Surface>>) -> Vec<f32> {
    let dark =
        u32::from(preset.color.r) + u32::from(preset.color.g) + u32::from(preset.color.b) < 380;
    let ground = if dark { Color::WHITE } else { Color { r: 40, g: 40, b: 46, a: 255 } };
    let stroke = Stroke::new(preset.brush.clone(), preset.operator, preset.color, wave());
    let strokes = StrokeList { strokes: vec![Arc::new(stroke)] };
    let layers = [
        Layer { clip_to_surface: false, ..Layer::new("ground", Content::Fill(ground)) },
        Layer {
            clip_to_surface: false,
            ..Layer::new("stroke", Content::Strokes(Live::new(strokes)))
        },
    ];
    let layers = layers.into_iter().map(Arc::new).collect();
    let document = Document { surface, layers, ..Document::empty(SIZE) };
    let double = document.scaled(2.0).unwrap();
    sorted_differences(&picture(&document), &reduce(&picture(&double), double.size, 2), ground)
}

#[test]
fn every_preset_paints_the_same_at_twice_the_size() {
    let mut far = Vec::new();
    for surface in [None, Some(Arc::new(ball()))] {
        for preset in presets() {
            let apart = compare_at_twice_the_size(&preset, surface.clone());
            let at = |share: f32| {
                apart.get((apart.len() as f32 * share) as usize).copied().unwrap_or(0.0)
            };
            let mean = apart.iter().sum::<f32>() / apart.len().max(1) as f32;
            let place = if surface.is_some() { "ball" } else { "flat" };
            let found = format!(
                "{place} {:20} mean {mean:5.2} p95 {:5.1} p99 {:5.1}",
                preset.key,
                at(0.95),
                at(0.99)
            );
            println!("{found}");
            // Before lengths and rims were scaled it was 45. Light along a silhouette is a pixel
            // wide on the ball, and twice the pixels read other normals there.
            let most = if place == "ball" && preset.key == "rim-light" { 10.0 } else { 4.0 };
            far.extend((mean > most).then_some(found));
        }
    }
    assert!(far.is_empty(), "{far:#?}");
}

#[test]
fn a_length_that_is_not_scaled_shows() {
    // The difference found before grain was scaled.
    let preset = presets().find(|preset| preset.key == "hatching").unwrap();
    let stroke = Stroke::new(preset.brush.clone(), preset.operator, preset.color, wave());
    let grain = |brush: &Brush| brush.grain.as_ref().map(|grain| grain.size_px);
    assert_eq!(grain(&stroke.brush().scaled(2.0)), grain(stroke.brush()).map(|px| 2.0 * px));
}
