//! The view of weights: one color per anchor, blended by the weights, and a dot at each anchor
//! (the insets of SF fig. 9).
//! Floor 4.

use super::paint_pixels;
use crate::math::{Size, Vec3, srgb, vec3};
use crate::raster::Picture;
use crate::raster::picture::Texels;
use crate::surface::{Bend, Surface};
use tiny_skia::{Color, FillRule, Paint, PathBuilder, Pixmap, Stroke, Transform};

pub(super) fn weights(surface: Option<&Surface>, size: Size, bend: &Bend) -> Picture {
    let colors: Vec<Vec3> = (0..bend.anchors.len()).map(color_of).collect();
    let shared = paint_pixels(size, surface, |x, y| {
        let q = crate::math::vec2(x as f32, y as f32) + 0.5;
        let weights = bend.weights.at(&bend.anchors, q);
        let blended =
            weights.iter().zip(&colors).fold(Vec3::ZERO, |sum, (&w, &color)| sum + w * color);
        // The surface is shaded, so that the parts that an anchor influences can be recognized.
        let light = surface.map_or(1.0, |s| 0.45 + 0.55 * s.normal(x, y).z.max(0.0));
        (blended * light).to_array()
    });
    with_dots(&shared, bend, &colors).unwrap_or(shared)
}

/// Blue, green and red as in the paper, then distinct hues.
pub fn color_of(anchor: usize) -> Vec3 {
    const FIRST: [Vec3; 3] =
        [vec3(0.20, 0.40, 1.00), vec3(0.15, 0.80, 0.25), vec3(1.00, 0.25, 0.20)];
    if let Some(&color) = FIRST.get(anchor) {
        return color;
    }
    // Steps by the golden ratio around the circle never repeat.
    let turn = (anchor as f32 * 0.618_034 + 0.11).fract();
    let channel = |offset: f32| (((turn + offset).fract() * 6.0 - 3.0).abs() - 1.0).clamp(0.0, 1.0);
    vec3(channel(0.0), channel(2.0 / 3.0), channel(1.0 / 3.0)) * 0.85 + 0.1
}

/// Draws the anchors; `None` where the picture is too large to draw on.
fn with_dots(picture: &Picture, bend: &Bend, colors: &[Vec3]) -> Option<Picture> {
    let Texels::Srgb8(texels) = &picture.texels else { return None };
    let Size { width, height } = picture.size;
    let mut pixmap = Pixmap::new(width, height)?;
    crate::raster::grid::premultiply(texels.as_flattened(), pixmap.data_mut());
    let radius = 3.0 + 0.006 * picture.size.longer_side();
    for (anchor, color) in bend.anchors.iter().zip(colors) {
        if let Some(dot) = PathBuilder::from_circle(anchor.at.x, anchor.at.y, radius) {
            let mut paint = Paint { anti_alias: true, ..Paint::default() };
            let [r, g, b] = color.to_array().map(srgb::quantize);
            paint.set_color_rgba8(r, g, b, 255);
            pixmap.fill_path(&dot, &paint, FillRule::Winding, Transform::identity(), None);
            paint.set_color(Color::WHITE);
            let rim = Stroke { width: 0.4 * radius, ..Stroke::default() };
            pixmap.stroke_path(&dot, &paint, &rim, Transform::identity(), None);
        }
    }
    let mut straight = vec![[0; 4]; texels.len()];
    crate::raster::grid::unpremultiply(pixmap.data(), straight.as_flattened_mut());
    Picture::srgb8(picture.size, straight)
}
