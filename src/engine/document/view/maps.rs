//! Views of the maps and of curvature: a color per pixel.
//! Floor 4.

use super::{ViewOptions, paint_pixels};
use crate::math::{Vec3, srgb, vec3};
use crate::raster::Picture;
use crate::surface::Surface;

pub(super) fn normals(surface: &Surface) -> Picture {
    paint_pixels(surface.size(), Some(surface), |x, y| {
        (surface.normal(x, y) * 0.5 + 0.5).to_array()
    })
}

pub(super) fn depth(surface: &Surface) -> Picture {
    paint_pixels(surface.size(), Some(surface), |x, y| [surface.depth(x, y); 3])
}

pub(super) fn mask(surface: &Surface) -> Picture {
    paint_pixels(surface.size(), None, |x, y| [f32::from(surface.coverage(x, y)) / 255.0; 3])
}

/// A color for each object, darker where it turns away.
pub(super) fn objects(surface: &Surface) -> Picture {
    let objects = surface.objects();
    let labels = objects.labels();
    paint_pixels(surface.size(), Some(surface), |x, y| {
        let color = super::anchor_color((labels.at(x, y) as usize).saturating_sub(1));
        (color * (0.35 + 0.65 * surface.normal(x, y).z.max(0.0))).to_array()
    })
}

/// Convex, flat, concave: encoded.
pub(super) const CONVEX: Vec3 = vec3(0.10, 0.25, 0.90);
const FLAT: Vec3 = vec3(1.00, 0.92, 0.35);
pub(super) const CONCAVE: Vec3 = vec3(0.85, 0.08, 0.10);

pub(super) fn curvature(surface: &Surface, options: &ViewOptions) -> Picture {
    let curvature = surface.curvature(options.blur_px);
    paint_pixels(surface.size(), Some(surface), |x, y| {
        let kappa = curvature.kappa(x, y, options.curvature_scale_px);
        FLAT.lerp(if kappa > 0.0 { CONVEX } else { CONCAVE }, kappa.abs()).to_array()
    })
}

pub(super) fn curvature_gray(surface: &Surface, options: &ViewOptions) -> Picture {
    let curvature = surface.curvature(options.blur_px);
    paint_pixels(surface.size(), Some(surface), |x, y| {
        [0.5 + 0.5 * curvature.kappa(x, y, options.curvature_scale_px); 3]
    })
}

/// From the upper left, toward the viewer.
const LIGHT: Vec3 = vec3(-0.45, 0.6, 0.66);

/// Diffuse light and a highlight, encoded.
fn shade(normal: Vec3) -> f32 {
    let light = LIGHT.normalize_or_zero();
    let half = (light + Vec3::Z).normalize_or_zero();
    let (diffuse, glossy) = (normal.dot(light).max(0.0), normal.dot(half).max(0.0).powf(60.0));
    srgb::encode((0.04 + 0.55 * diffuse + 0.35 * glossy).min(1.0))
}

/// Behind a lit surface: between its light and its dark side, so that the outlines of both are
/// visible.
const BACKDROP: f32 = 0.40;

pub(super) fn render_lit(surface: &Surface) -> Picture {
    let size = surface.size();
    // In the lower right corner, small enough not to hide the surface.
    let radius = 0.07 * size.width.min(size.height) as f32;
    let center = [size.width as f32 - 1.3 * radius, size.height as f32 - 1.3 * radius];
    let ball = |x: usize, y: usize| {
        let n = [(x as f32 + 0.5 - center[0]) / radius, (center[1] - y as f32 - 0.5) / radius];
        let z2 = 1.0 - n[0] * n[0] - n[1] * n[1];
        (z2 >= 0.0).then(|| vec3(n[0], n[1], z2.sqrt()))
    };
    paint_pixels(size, None, |x, y| {
        let covered = f32::from(surface.coverage(x, y)) / 255.0;
        let shade = match ball(x, y) {
            Some(normal) => shade(normal),
            None => BACKDROP + (shade(surface.normal(x, y)) - BACKDROP) * covered,
        };
        [shade; 3]
    })
}

/// A matt surface in a lamp's light and, from the other side, in a faint one, so that nothing is
/// fully black; encoded.
pub(super) fn clay(surface: &Surface) -> Picture {
    let (lamp, fill) = (LIGHT.normalize_or_zero(), vec3(0.7, -0.3, 0.5).normalize_or_zero());
    paint_pixels(surface.size(), Some(surface), |x, y| {
        let n = surface.normal(x, y);
        let light = 0.10 + 0.70 * n.dot(lamp).max(0.0) + 0.10 * n.dot(fill).max(0.0);
        CLAY.map(|c| srgb::encode((light * c).min(1.0)))
    })
}

/// Linear.
const CLAY: [f32; 3] = [0.92, 0.86, 0.80];
/// Lines of equal depth from the nearest to the farthest point, the strong ones among them, and how
/// wide they are, px.
const LINES: f32 = 20.0;
const STRONG_EACH: i32 = 4;
const LINE_PX: [f32; 2] = [0.55, 1.1];

pub(super) fn contours(surface: &Surface) -> Picture {
    let depth = surface.depth_plane();
    paint_pixels(surface.size(), Some(surface), |x, y| {
        let (xi, yi) = (x as i32, y as i32);
        let here = depth.at(x, y) * LINES;
        // The steepest of the differences to both sides that are no jump: lines are equally wide on
        // every slope.
        let slope = |dx: i32, dy: i32| {
            let side = |s: i32| (depth.at_clamped(xi + s * dx, yi + s * dy) * LINES - here).abs();
            side(1).min(side(-1))
        };
        let steep = slope(1, 0).hypot(slope(0, 1)).max(1e-4);
        let line = here.round();
        let away_px = (here - line).abs() / steep;
        let is_strong = (line as i32).rem_euclid(STRONG_EACH) == 0;
        let wide = LINE_PX[usize::from(is_strong)];
        // A level plane that lies on a line is no line.
        let ink = if steep < 2e-3 { 0.0 } else { (wide + 0.5 - away_px).max(0.0).min(1.0) };
        let paper = 0.95 - 0.35 * depth.at(x, y);
        let ink = ink * if is_strong { 0.85 } else { 0.55 };
        [paper, paper, paper * 0.98].map(|c| c + (0.12 - c) * ink)
    })
}
