//! How much each pixel of a surface differs from one of its pixels, by each kind of region (MATH
//! 7). Floor 2.

use super::RegionKind;
use crate::math::{Vec2, Vec3, vec3};
use crate::raster::Plane;
use crate::surface::flow::FlowField;
use crate::surface::operator::MapValues;
use crate::surface::{StructureTensor, Surface};

/// κ is taken at this share of the canvas's longer side, and the normals are blurred by that one
/// before: a picture has the same regions at any size.
const KAPPA_SCALE: f32 = 1.0 / 96.0;
const KAPPA_BLUR: f32 = 1.0 / 512.0;
/// The smoothing of the flow, a share of the longer side.
const FLOW_BLUR: f32 = 1.0 / 256.0;

/// v of every pixel; infinite off the surface.
///
/// * `at`: the point that they differ from, canvas px.
pub fn of(surface: &Surface, kind: RegionKind, at: Vec2) -> Plane<f32> {
    let on_surface = |value: &(dyn Fn(usize, usize) -> f32 + Sync)| {
        Plane::from_fn(surface.size(), |x, y| {
            if surface.coverage(x, y) > 0 { value(x, y) } else { f32::INFINITY }
        })
    };
    let longer = surface.size().longer_side();
    let MapValues { depth: z0, nbar, nz } = surface.values_near(at);
    let n0 = vec3(nbar.x, -nbar.y, nz);
    match kind {
        RegionKind::Direction => on_surface(&|x, y| angle(surface.normal(x, y), n0)),
        RegionKind::Shine => {
            on_surface(&|x, y| angle(mirrored(surface.normal(x, y)), mirrored(n0)))
        }
        RegionKind::Depth => on_surface(&|x, y| (surface.depth(x, y) - z0).abs()),
        RegionKind::Curvature => {
            let curvature = surface.curvature(KAPPA_BLUR * longer);
            let kappa = |x: usize, y: usize| curvature.kappa(x, y, KAPPA_SCALE * longer);
            let k0 = surface.interpolate(at, kappa);
            on_surface(&|x, y| (kappa(x, y) - k0).abs())
        }
        RegionKind::Object => {
            let objects = surface.objects();
            let labels = objects.labels();
            let (x0, y0) = surface.pixel_of(at);
            let here = labels.at(x0, y0);
            on_surface(&|x, y| if labels.at(x, y) == here { 0.0 } else { f32::INFINITY })
        }
        RegionKind::Flow => {
            let flow = FlowField::of_normals(surface)
                .smoothed(Some(surface.coverage_plane()), FLOW_BLUR * longer);
            let tensor = |x: usize, y: usize| {
                let StructureTensor { xx, xy, yy } = flow.at(x, y);
                vec3(xx, xy, yy)
            };
            let along = |of: Vec3| {
                let eigen = StructureTensor { xx: of.x, xy: of.y, yy: of.z }.eigen();
                // Where the normals turn equally in all directions there is no line.
                (eigen.larger > 1.05 * eigen.smaller.max(0.0) + 1e-12).then_some(eigen.direction)
            };
            let Some(u0) = along(surface.interpolate(at, tensor)) else {
                return on_surface(&|_, _| f32::INFINITY);
            };
            on_surface(&|x, y| {
                along(tensor(x, y)).map_or(f32::INFINITY, |u| angle_between_lines(u, u0))
            })
        }
    }
}

/// The angle between unit vectors, degrees: 2 asin(½ |a − b|), which keeps the digits of small
/// angles.
pub fn angle(a: Vec3, b: Vec3) -> f32 {
    2.0 * (0.5 * a.distance(b)).min(1.0).asin().to_degrees()
}

/// r = 2 n_z n − e_z: where a mirror sends the view (MATH 5).
pub fn mirrored(n: Vec3) -> Vec3 {
    2.0 * n.z * n - Vec3::Z
}

/// The angle between two lines of unit directions, degrees, at most 90.
pub fn angle_between_lines(a: Vec2, b: Vec2) -> f32 {
    a.perp_dot(b).abs().atan2(a.dot(b).abs()).to_degrees()
}
