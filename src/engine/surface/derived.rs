//! What is computed from a surface's maps and cached, and the memory that a surface uses. Floor 2.
//! Not here: how each value is computed. The module of the value does that, and asks the cache
//! first.

use super::Surface;
use super::cache::{Cache, HeapSize, RecentCache};
use super::chunks::BallPlaces;
use super::curvature::{Curvature, CurvatureRims, Kappa};
use super::form_lines::{FormLines, LineKey, SharpLines, SmoothNormals, UnlitLines};
use super::hatching::{HatchKey, HatchLines};
use super::objects::Objects;
use super::ray::RayMap;
use super::ray::body::{SolidBody, Thickness};
use super::region::SurfaceRegion;
use super::shadow::{ContactShade, HeightMaps, ShadowKey, ShareMap};
use super::unwrap::{
    DisplacementKey, PerspectiveView, PlaneDisplacement, PlaneLayout, PlaneSolver, Unwrapping,
};
use crate::math::Rect;
use crate::raster::{CoverageGrid, Plane};
use std::sync::{Arc, OnceLock};

/// Declares the caches, so that all of them are counted and cleared: a row for each.
macro_rules! caches {
    ($($(#[doc = $doc:literal])+ $name:ident: $cache:ty,)+) => {
        /// What was computed from the maps of a surface. A surface with other maps begins with none
        /// of it.
        #[derive(Default)]
        pub(in crate::surface) struct DerivedCaches {
            $($(#[doc = $doc])+ pub $name: $cache,)+
        }

        impl HeapSize for DerivedCaches {
            fn heap_bytes(&self) -> u64 {
                0 $(+ self.$name.heap_bytes())+
            }
        }

        impl Cache for DerivedCaches {
            fn clear(&self) {
                $(self.$name.clear();)+
            }
        }
    };
}

caches! {
    /// By blur, as bits.
    curvatures: RecentCache<u32, Curvature>,
    /// Where curvature is continued.
    rims: RecentCache<(), CurvatureRims>,
    /// By the scales that are weighed: blur, scale and share of each, as bits.
    kappas: RecentCache<Vec<[u32; 3]>, Kappa>,
    /// By radius, as bits.
    occlusions: RecentCache<u32, Plane<f32>>,
    /// Heights toward the viewer, as shadows read them.
    heights: RecentCache<(), HeightMaps>,
    /// What each pixel sees of a lamp.
    shadows: RecentCache<ShadowKey, ShareMap>,
    /// By the largest size, as bits.
    contacts: RecentCache<u32, ContactShade>,
    /// Which place of a painted ball each pixel shows, by its settings, as bits.
    ball_places: RecentCache<[u32; 4], BallPlaces>,
    /// Lines where an illustrator puts them, by what is asked of them.
    form_lines: RecentCache<LineKey, FormLines>,
    /// Those of them that stay when the light moves.
    unlit_lines: RecentCache<LineKey, UnlitLines>,
    /// Those where the surface ends or has an edge.
    sharp_lines: RecentCache<LineKey, SharpLines>,
    /// Hatching lines, by what is asked of them.
    hatch_lines: RecentCache<HatchKey, HatchLines>,
    /// Normals blurred within each piece, by σ, as bits.
    smooth_normals: RecentCache<u32, SmoothNormals>,
    /// What rays are marched through.
    ray_maps: RecentCache<(), RayMap>,
    /// How far the front stands before the middle of the body.
    thicknesses: RecentCache<(), Thickness>,
    /// What light goes through, by the bulge of the back, as bits.
    bodies: RecentCache<u32, SolidBody>,
    /// Coverage of selections by the surface.
    regions: RecentCache<SurfaceRegion, CoverageGrid>,
    /// By amount and blur, as bits.
    unwrappings: RecentCache<[u32; 2], Unwrapping>,
    /// The planes side by side, by the key of their unwrapping; `None` where they do not fit.
    plane_layouts: RecentCache<[u32; 2], Option<Arc<PlaneLayout>>>,
    /// How planes are displaced by anchors.
    plane_displacements: RecentCache<DisplacementKey, PlaneDisplacement>,
    /// By the key of the unwrapping, and the rectangle that they span.
    plane_solver: RecentCache<([u32; 2], Rect), PlaneSolver>,
    /// The perspective near the surface; `None` where it was seen from afar.
    perspective_view: OnceLock<Option<PerspectiveView>>,
    /// The pieces of the surface.
    objects: RecentCache<(), Objects>,
    /// What the other sides of contour pixels read.
    far_sides: RecentCache<(), Surface>,
}

impl Surface {
    /// Bytes of the maps alone and of the links between their pixels.
    pub const BYTES_PER_PX: usize = 4 * size_of::<f32>() + 2 * size_of::<u8>();

    /// Bytes of the maps, of what is computed when a surface is made, and of the pyramids, which
    /// stay: every mark reads them, and they hold a small share of what the maps do.
    pub fn map_bytes(&self) -> u64 {
        let smooth_links = self.smooth_links.as_ref().map_or(0, |plane| plane.heap_bytes());
        let parts = self.parts.as_ref().map_or(0, |plane| plane.heap_bytes());
        (self.size().area() * Self::BYTES_PER_PX) as u64
            + smooth_links
            + parts
            + self.contours().bytes()
            + self.bounds.bytes()
    }

    /// Bytes of what was computed from the maps and can be computed again.
    pub fn cached_bytes(&self) -> u64 {
        self.derived.heap_bytes()
    }

    /// Drops what can be computed again.
    pub fn clear_caches(&self) {
        self.derived.clear();
    }
}

impl HeapSize for Surface {
    fn heap_bytes(&self) -> u64 {
        self.map_bytes() + self.cached_bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, Vec3};
    use crate::surface::Maps;
    use crate::surface::form_lines::LineSettings;
    use crate::surface::operator::UnwrapSettings;

    #[test]
    fn whatever_is_computed_is_counted_and_cleared() {
        let size = Size::new(96, 80);
        let maps = Maps {
            normals: Plane::full(size, Vec3::new(0.3, 0.1, 0.9)),
            depth: Plane::from_fn(size, |x, _| x as f32 / 96.0),
            coverage: Plane::full(size, 255),
        };
        let surface = Arc::new(Surface::new(maps).unwrap());
        let before = surface.cached_bytes();
        let grew = |what: &str, last: &mut u64| {
            let now = surface.cached_bytes();
            assert!(now > *last, "{what}: {now} after {last}");
            *last = now;
        };
        let mut last = before;
        let settings = UnwrapSettings { amount: 1.0, smooth_px: 1.0 };
        surface.objects();
        grew("objects", &mut last);
        surface.curvature(2.0);
        grew("curvature", &mut last);
        surface.occlusion(8.0);
        grew("occlusion", &mut last);
        surface.form_lines(&LineSettings::default());
        grew("lines", &mut last);
        surface.ray_map();
        grew("rays", &mut last);
        surface.body(0.5);
        grew("body", &mut last);
        surface.unwrapping(settings);
        grew("unwrapping", &mut last);
        surface.plane_layout(settings).unwrap();
        grew("layout", &mut last);
        surface.clear_caches();
        assert_eq!(surface.cached_bytes(), 0);
    }
}
