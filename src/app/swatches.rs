//! What a preset paints: one stroke over a ball, bent by the preset's operator.
//! Floor 7. Painted once, on a thread of its own.

use super::jobs;
use crate::Error;
use crate::document::{Content, Document, Layer, Live, Progress, StrokeList, flatten};
use crate::io::recipe::{preset_brush, preset_names};
use crate::math::{Size, Vec2, srgb::Color, vec2, vec3};
use crate::paint::{Brush, Sample, Stroke};
use crate::raster::Plane;
use crate::surface::{Maps, Surface};
use eframe::egui::{self, ColorImage, TextureHandle, TextureId, TextureOptions};
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};

/// The pictures of the presets.
#[derive(Default)]
pub struct Swatches {
    coming: Option<Receiver<(&'static str, ColorImage)>>,
    made: HashMap<String, TextureHandle>,
    /// What cannot be done here, to be told once.
    pub trouble: Option<Error>,
}

/// Side of a swatch, px, and of the ball's radius in it.
const SIDE: usize = 128;
const RADIUS: f32 = 54.0;

impl Swatches {
    /// The picture of a preset, once it is painted.
    pub fn of(&mut self, ctx: &egui::Context, name: &str) -> Option<TextureId> {
        let coming = self.coming.get_or_insert_with(|| {
            let (sender, coming) = channel();
            let waker = ctx.clone();
            let work = move || {
                for name in preset_names() {
                    if let Some(image) = painted(name)
                        && sender.send((name, image)).is_ok()
                    {
                        waker.request_repaint();
                    }
                }
            };
            // Without a thread there are no pictures, only names.
            self.trouble = jobs::spawn("pictures of the brushes", work).err();
            coming
        });
        for (name, image) in coming.try_iter() {
            self.made.insert(name.into(), ctx.load_texture(name, image, TextureOptions::LINEAR));
        }
        self.made.get(name).map(TextureHandle::id)
    }
}

/// A ball in the middle of a square, facing the viewer.
pub fn ball(side: usize, radius: f32) -> Option<Surface> {
    let middle = vec2(side as f32, side as f32) * 0.5;
    let on = move |x: usize, y: usize| (vec2(x as f32 + 0.5, y as f32 + 0.5) - middle) / radius;
    let height = |p: Vec2| (1.0 - p.length_squared()).max(0.0).sqrt();
    let size = Size::new(side as u32, side as u32);
    // A pixel of soft rim, so that the silhouette is not a staircase.
    let cover = |p: Vec2| ((1.0 - p.length()) * radius + 0.5).clamp(0.0, 1.0);
    Surface::new(Maps {
        normals: Plane::from_fn(size, |x, y| {
            vec3(on(x, y).x, -on(x, y).y, height(on(x, y)).max(0.02)).normalize_or_zero()
        }),
        depth: Plane::from_fn(size, |x, y| 1.0 - height(on(x, y))),
        coverage: Plane::from_fn(size, |x, y| (cover(on(x, y)) * 255.0 + 0.5) as u8),
    })
    .ok()
}

/// A wave from left to right, lighter at its ends.
fn wave() -> Vec<Sample> {
    let at = |i: usize| {
        let t = i as f32 / 24.0;
        let (x, y) = (0.2 + 0.6 * t, 0.5 + 0.13 * (t * std::f32::consts::TAU).sin());
        let pressure = (t * std::f32::consts::PI).sin().max(0.15);
        Sample { pressure, ..Sample::at(vec2(x, y) * SIDE as f32) }
    };
    (0..=24).map(at).collect()
}

fn painted(name: &str) -> Option<ColorImage> {
    let (brush, operator) = preset_brush(name)?;
    let brush = Brush { size: brush.size.clamp(7.0, 38.0), ..brush };
    let clay = Layer::new("clay", Content::Fill(Color { r: 0x54, g: 0x58, b: 0x60, a: 255 }));
    let stroke = Arc::new(Stroke::new(brush, operator, Color { r: 0xf4, g: 0xee, b: 0xe0, a: 255 }, wave()));
    let strokes = Layer::new("stroke", Content::Strokes(Live::new(StrokeList { strokes: vec![stroke] })));
    let mut document = Document::empty(Size::new(SIDE as u32, SIDE as u32));
    document.surface = Some(Arc::new(ball(SIDE, RADIUS)?));
    document.layers = vec![Arc::new(clay), Arc::new(strokes)];
    let grid = flatten(&document, &Progress::default())?;
    Some(ColorImage::from_rgba_unmultiplied([SIDE, SIDE], &grid.to_straight_rgba(document.size.rect())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_leaves_a_mark_on_the_ball() {
        for name in preset_names() {
            let image = painted(name).unwrap();
            let clay = egui::Color32::from_rgb(0x54, 0x58, 0x60);
            let marked = image.pixels.iter().filter(|p| p.a() == 255 && **p != clay).count();
            assert!(marked > 100, "{name}: {marked}");
        }
    }
}
