//! Preview pictures of brushes: one stroke over a ball, bent by the brush's operator. Floor 6. The
//! window caches the pictures.

mod retouched;

use crate::document::{Content, Document, Layer, Live, Progress, StrokeList, flatten};
use crate::io::recipe::BrushPreset;
use crate::math::{Size, Vec2, srgb::Color, vec2, vec3};
use crate::paint::grain::BrushGrain;
use crate::paint::{Brush, Gradient, GradientStop, ImageFilter, Input, Sample, Stroke};
use crate::raster::{BlendMode, Plane};
use crate::surface::{Maps, Operator, Surface};
use std::f32::consts::{PI, TAU};
use std::sync::Arc;

/// The side of a canvas at which brush sizes are not scaled.
const NATURAL_SIDE: f32 = 360.0;
/// The least and greatest diameter of the brush in the picture, as shares of its side.
const SIZES: [f32; 2] = [0.022, 0.3];
/// Radius of the ball, a share of the side.
const RADIUS: f32 = 0.43;

/// A preset's picture, straight RGBA bytes, `side` px square. `None` if `side` is 0 or far too
/// large.
pub fn render_swatch(preset: &BrushPreset, side: u32) -> Option<Vec<u8>> {
    if !(1..=4096).contains(&side) {
        return None;
    }
    let follows_relief = preset.brush.dynamics.has_input(Input::Curvature);
    let surface = ball(side as usize, if follows_relief { GROOVES } else { 0.0 })?;
    render_swatch_on(preset, Arc::new(surface))
}

/// The same on another surface, as large as that is.
pub fn render_swatch_on(preset: &BrushPreset, surface: Arc<Surface>) -> Option<Vec<u8>> {
    let size = surface.size();
    let side = size.width.min(size.height) as f32;
    let BrushPreset { operator, brush, .. } = preset;
    let background =
        if is_dark(preset.color) || brush.blend == BlendMode::Multiply { PLASTER } else { SLATE };
    if brush.is_dependent_on_paint() {
        let drawn = retouched::draw_stroke(preset, surface, side / NATURAL_SIDE, SLATE)?;
        return Some(flatten(&drawn, &Progress::default())?.to_straight_rgba(size.rect()));
    }
    let brush = scaled(brush, side / NATURAL_SIDE, side);
    let blend = brush.blend;
    // An eraser is shown by what it removes.
    let under = if brush.erases { preset.color } else { Color::TRANSPARENT };
    let brush = Brush { erases: false, ..brush };
    let stroke =
        Arc::new(Stroke::new(brush, *operator, shown_color(preset, background), wave(size)));
    let strokes = Content::Strokes(Live::new(StrokeList { strokes: vec![stroke] }));
    let layers = [
        Layer::new("ground", Content::Gradient(Live::new(clay(background, size)))),
        Layer::new("under", Content::Fill(under)),
        Layer { blend, ..Layer::new("stroke", strokes) },
    ];
    let layers = layers.into_iter().map(Arc::new).collect();
    let document = Document { surface: Some(surface), layers, ..Document::empty(size) };
    let grid = flatten(&document, &Progress::default())?;
    Some(grid.to_straight_rgba(size.rect()))
}

/// Light from the upper left, so that the shape is visible.
fn clay(background: Color, size: Size) -> Gradient {
    let (middle, side) = (size.center(), size.width.min(size.height) as f32);
    let lit = |factor: f32| {
        let channel = |c: u8| (f32::from(c) * factor).min(255.0) as u8;
        Color {
            r: channel(background.r),
            g: channel(background.g),
            b: channel(background.b),
            a: 255,
        }
    };
    let stops = [(0.0, 1.3), (0.45, 1.0), (1.0, 0.62)]
        .map(|(t, factor)| GradientStop { t, color: lit(factor) });
    Gradient {
        from: middle - 0.36 * side,
        to: middle + 0.36 * side,
        stops: stops.to_vec(),
        operator: Operator::Normal { alpha: 0.35, beta: 0.5, detail: 0.0 },
        filter: ImageFilter::Antialias,
        frame: Default::default(),
        style: Default::default(),
        pieces: Vec::new(),
    }
}

/// Height of the grooves on the ball of a brush that follows the relief.
const GROOVES: f32 = 0.055;

/// An eraser shows the background again.
fn shown_color(preset: &BrushPreset, background: Color) -> Color {
    if preset.brush.erases { background } else { preset.color }
}

const SLATE: Color = Color { r: 0x54, g: 0x58, b: 0x60, a: 255 };
const PLASTER: Color = Color { r: 0xcf, g: 0xc9, b: 0xbe, a: 255 };

fn is_dark(color: Color) -> bool {
    2 * u32::from(color.r) + 5 * u32::from(color.g) + u32::from(color.b) < 8 * 0x80
}

/// A brush at the scale of a small picture: its sizes shrink with it, as far as they stay
/// recognizable.
pub fn scaled(brush: &Brush, scale: f32, side: f32) -> Brush {
    let size = (brush.size * scale).max(SIZES[0] * side).min(SIZES[1] * side);
    let shrunk = size / brush.size;
    let grain = brush.grain.clone().map(|grain| BrushGrain {
        size_px: (grain.size_px * shrunk.max(0.5 * scale)).max(1.6),
        ..grain
    });
    Brush { size, grain, ..brush.clone() }
}

/// A ball in the middle of a square, facing the viewer. `relief`: height of the grooves around it,
/// of its radius.
pub fn ball(side: usize, relief: f32) -> Option<Surface> {
    let middle = Vec2::splat(0.5 * side as f32);
    let radius = RADIUS * side as f32;
    let on = move |x: usize, y: usize| (vec2(x as f32 + 0.5, y as f32 + 0.5) - middle) / radius;
    let height = move |p: Vec2| {
        let round = (1.0 - p.length_squared()).max(0.0).sqrt();
        // Grooves like a shell's, lower ones bent, that end softly at the rim.
        round + relief * (TAU * (1.6 * p.y + 0.5 * p.x * p.x)).cos() * round.min(0.7)
    };
    let size = Size::new(side as u32, side as u32);
    // One pixel of soft rim against aliasing of the silhouette.
    let cover = |p: Vec2| ((1.0 - p.length()) * radius + 0.5).clamp(0.0, 1.0);
    let normal = move |p: Vec2| {
        if relief == 0.0 {
            return vec3(p.x, -p.y, height(p).max(0.02)).normalize_or_zero();
        }
        let step = 0.5 / radius;
        let slope = |d: Vec2| {
            ((height(p + d * step) - height(p - d * step)) / (2.0 * step)).clamp(-20.0, 20.0)
        };
        vec3(-slope(Vec2::X), slope(Vec2::Y), 1.0).normalize_or_zero()
    };
    let highest = 1.0 + relief;
    Surface::new(Maps {
        normals: Plane::from_fn(size, |x, y| normal(on(x, y))),
        depth: Plane::from_fn(size, |x, y| (1.0 - height(on(x, y)) / highest).clamp(0.0, 1.0)),
        coverage: Plane::from_fn(size, |x, y| (cover(on(x, y)) * 255.0 + 0.5) as u8),
    })
    .ok()
}

/// A wave from left to right, lighter at its ends, drawn in a second.
fn wave(size: Size) -> Vec<Sample> {
    let (side, middle) = (size.width.min(size.height) as f32, size.center());
    const STEPS: usize = 32;
    let at = |i: usize| {
        let t = i as f32 / STEPS as f32;
        let from_middle = vec2(0.8 * (t - 0.5), -0.15 * (t * TAU).sin());
        let pressure = (t * PI).sin().max(0.2);
        Sample { pressure, time_secs: t, ..Sample::at(middle + from_middle * side) }
    };
    (0..=STEPS).map(at).collect()
}

#[cfg(test)]
mod tests;
