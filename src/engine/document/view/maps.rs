//! Views of the maps and of curvature: a colour per pixel.
//! Floor 4.

use super::{ViewOptions, painted};
use crate::math::{Vec3, srgb, vec3};
use crate::raster::Picture;
use crate::surface::Surface;

pub(super) fn normals(surface: &Surface) -> Picture {
    painted(surface.size(), Some(surface), |x, y| (surface.normal(x, y) * 0.5 + 0.5).to_array())
}

pub(super) fn depth(surface: &Surface) -> Picture {
    painted(surface.size(), Some(surface), |x, y| [surface.depth(x, y); 3])
}

pub(super) fn mask(surface: &Surface) -> Picture {
    painted(surface.size(), None, |x, y| [f32::from(surface.coverage(x, y)) / 255.0; 3])
}

/// A colour for each object, darker where it turns away.
pub(super) fn objects(surface: &Surface) -> Picture {
    let labels = surface.objects().labels();
    painted(surface.size(), Some(surface), |x, y| {
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
    painted(surface.size(), Some(surface), |x, y| {
        let kappa = curvature.kappa(x, y, options.curvature_scale_px);
        FLAT.lerp(if kappa > 0.0 { CONVEX } else { CONCAVE }, kappa.abs()).to_array()
    })
}

pub(super) fn curvature_grey(surface: &Surface, options: &ViewOptions) -> Picture {
    let curvature = surface.curvature(options.blur_px);
    painted(surface.size(), Some(surface), |x, y| [0.5 + 0.5 * curvature.kappa(x, y, options.curvature_scale_px); 3])
}

/// From the upper left, toward the viewer.
const LIGHT: Vec3 = vec3(-0.45, 0.6, 0.66);

/// Diffuse light and a highlight, encoded.
fn lit_by(normal: Vec3) -> f32 {
    let light = LIGHT.normalize_or_zero();
    let half = (light + Vec3::Z).normalize_or_zero();
    let (diffuse, glossy) = (normal.dot(light).max(0.0), normal.dot(half).max(0.0).powf(60.0));
    srgb::encode((0.04 + 0.55 * diffuse + 0.35 * glossy).min(1.0))
}

/// Behind a lit surface: between its light and its dark side, so that the outlines of both are visible.
const BACKDROP: f32 = 0.40;

pub(super) fn lit(surface: &Surface) -> Picture {
    let size = surface.size();
    // In the lower right corner, small enough not to hide the surface.
    let radius = 0.07 * size.width.min(size.height) as f32;
    let center = [size.width as f32 - 1.3 * radius, size.height as f32 - 1.3 * radius];
    let ball = |x: usize, y: usize| {
        let n = [(x as f32 + 0.5 - center[0]) / radius, (center[1] - y as f32 - 0.5) / radius];
        let z2 = 1.0 - n[0] * n[0] - n[1] * n[1];
        (z2 >= 0.0).then(|| vec3(n[0], n[1], z2.sqrt()))
    };
    painted(size, None, |x, y| {
        let covered = f32::from(surface.coverage(x, y)) / 255.0;
        let shade = match ball(x, y) {
            Some(normal) => lit_by(normal),
            None => BACKDROP + (lit_by(surface.normal(x, y)) - BACKDROP) * covered,
        };
        [shade; 3]
    })
}
