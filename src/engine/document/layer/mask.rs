//! The masks that a layer can have: a picture of coverage, or one derived from the surface.
//! Floor 4. Not here: what else a layer covers (`document::mask`).

use crate::math::{Range, UNIT};
use crate::paint::Scene;
use crate::raster::tile::TILE_AREA;
use crate::raster::{Plane, TILE, TileAt, TileCoverage};
use crate::surface::region::SurfaceRegion;
use crate::surface::{Curvature, Surface};
use std::sync::Arc;

/// What a layer's coverage is multiplied by.
#[derive(Clone)]
pub struct LayerMask {
    /// Where its values come from.
    pub kind: MaskKind,
    /// 1 − the mask.
    pub invert: bool,
    /// The layer is shown as if it had no mask.
    pub disabled: bool,
}

/// What a mask is made of.
#[derive(Clone)]
pub enum MaskKind {
    /// A picture of the canvas's size: encoded luminance × alpha.
    File {
        /// The name of the file.
        file: String,
        /// What it covers, one byte a pixel.
        coverage: Arc<Plane<u8>>,
    },
    /// Derived again wherever the surface changes.
    Derived(DerivedMask),
}

/// A mask that follows the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DerivedMask {
    /// Schlick's approximation: f0 + (1 − f0)(1 − n_z)^power (SF fig. 12c).
    Fresnel {
        /// What it is where the surface faces the viewer.
        f0: f32,
        /// How steeply it rises toward the silhouette.
        power: f32,
    },
    /// κ of MATH 4, 0 at `from`, 1 at `to`.
    Curvature {
        /// The scale s of κ, px.
        scale: f32,
        /// Blur of the normals beforehand, px.
        blur: f32,
        /// The curvature where it begins.
        from: f32,
        /// The curvature where it is whole.
        to: f32,
    },
    /// z, 0 at `from`, 1 at `to`.
    Depth {
        /// The depth where it begins.
        from: f32,
        /// The depth where it is whole.
        to: f32,
    },
    /// The region that has something in common with a point of the surface.
    Region(SurfaceRegion),
}

impl LayerMask {
    /// An enabled mask that is not inverted.
    pub fn new(kind: impl Into<MaskKind>) -> Self {
        Self { kind: kind.into(), invert: false, disabled: false }
    }

    /// The mask that follows the surface, if it is one.
    pub fn derived_mask(&self) -> Option<DerivedMask> {
        match self.kind {
            MaskKind::Derived(derived) => Some(derived),
            MaskKind::File { .. } => None,
        }
    }

    /// Whether both have the same coverage: the same picture by pointer, or the same numbers.
    pub(in crate::document) fn is_same(&self, other: &LayerMask) -> bool {
        let same_kind = match (&self.kind, &other.kind) {
            (MaskKind::File { coverage: a, .. }, MaskKind::File { coverage: b, .. }) => {
                Arc::ptr_eq(a, b)
            }
            (MaskKind::Derived(a), MaskKind::Derived(b)) => a == b,
            _ => false,
        };
        same_kind && self.invert == other.invert && self.disabled == other.disabled
    }
}

impl DerivedMask {
    /// What the share of light reflected straight back may be.
    pub const F0: Range = UNIT;
    /// What the exponent of the Fresnel term may be.
    pub const POWER: Range = 0.0..=64.0;
    /// Curvatures at which the mask is 0 or 1.
    pub const KAPPA: Range = -1.0..=1.0;
    /// Depths at which the mask is 0 or 1.
    pub const DEPTH: Range = UNIT;

    // The numbers of a mask that gives none.
    /// The share of light that most materials reflect straight back.
    pub const PLAIN_F0: f32 = 0.04;
    /// The exponent of Schlick's approximation.
    pub const PLAIN_POWER: f32 = 5.0;
    /// The scale of curvature by default, px.
    pub const PLAIN_SCALE_PX: f32 = 4.0;
    /// Stronger toward the silhouette, as most materials reflect.
    pub const FRESNEL: Self = Self::Fresnel { f0: Self::PLAIN_F0, power: Self::PLAIN_POWER };
    /// From hollow to raised.
    pub const CURVATURE: Self =
        Self::Curvature { scale: Self::PLAIN_SCALE_PX, blur: 0.0, from: -1.0, to: 1.0 };
    /// From near to far.
    pub const RAMP_OF_DEPTH: Self = Self::Depth { from: 0.0, to: 1.0 };
}

impl From<DerivedMask> for MaskKind {
    fn from(derived: DerivedMask) -> Self {
        MaskKind::Derived(derived)
    }
}

impl LayerMask {
    /// The same mask as a picture that can be painted on; it looks the same. A derived mask covers
    /// everything where there is no surface.
    pub fn as_picture(&self, scene: &Scene) -> LayerMask {
        let plain = LayerMask { invert: false, disabled: false, ..self.clone() };
        let curvature = self.curvature_on(scene);
        let cover = |x: usize, y: usize| {
            let v = plain.at(scene, curvature.as_deref(), x as i32, y as i32);
            (v.max(0.0).min(1.0) * 255.0 + 0.5) as u8
        };
        let coverage = Arc::new(Plane::from_fn(scene.size, cover));
        LayerMask { kind: MaskKind::File { file: String::new(), coverage }, ..self.clone() }
    }

    /// The curvature that it is derived from, of the surface that a layer sees.
    pub(in crate::document) fn curvature_on(&self, scene: &Scene) -> Option<Arc<Curvature>> {
        match self.derived_mask()? {
            DerivedMask::Curvature { blur, .. } => Some(scene.surface.as_ref()?.curvature(blur)),
            _ => None,
        }
    }

    /// Multiplies a coverage by the mask. One derived from a surface changes nothing where there is
    /// none.
    pub(in crate::document) fn multiply(
        &self,
        coverage: TileCoverage,
        scene: &Scene,
        curvature: Option<&Curvature>,
        at: TileAt,
    ) -> TileCoverage {
        if !self.is_active_on(scene) {
            return coverage;
        }
        if let (MaskKind::Derived(DerivedMask::Region(region)), Some(surface)) =
            (&self.kind, &scene.surface)
        {
            let grid = surface.region(region);
            let way = |c: u8| f32::from(if self.invert { 255 - c } else { c }) / 255.0;
            return coverage.times(tile_pixels(at, |x, y| way(grid.at(x, y))));
        }
        let on_contours = self.own_facings(scene, at);
        coverage.times(tile_pixels(at, |x, y| {
            let own = |_: &Surface| {
                let facing = on_contours.as_ref()?[y as usize % TILE * TILE + x as usize % TILE];
                (!facing.is_nan()).then_some(facing)
            };
            self.at_facing(scene, curvature, (x, y), own)
        }))
    }

    /// Of a mask that follows the view: n·v in the middle of what a tile's contour pixels see
    /// themselves, else NaN.
    fn own_facings(&self, scene: &Scene, at: TileAt) -> Option<Vec<f32>> {
        let Some(DerivedMask::Fresnel { .. }) = self.derived_mask() else { return None };
        let surface = scene.surface.as_ref()?;
        let contours = surface.contours().on(at)?;
        let mut own = vec![f32::NAN; TILE_AREA];
        for pixel in contours.pixels {
            own[pixel.y as usize % TILE * TILE + pixel.x as usize % TILE] =
                surface.own_facing(pixel);
        }
        Some(own)
    }

    /// It is shown, and what it is derived from is there.
    pub(in crate::document) fn is_active_on(&self, scene: &Scene) -> bool {
        let needs_surface = !matches!(self.kind, MaskKind::File { .. });
        !(self.disabled || needs_surface && scene.surface.is_none())
    }

    /// The mask at a pixel of the canvas, `[0, 1]`; `curvature`: the surface's, for a mask derived
    /// from it.
    pub(in crate::document) fn at(
        &self,
        scene: &Scene,
        curvature: Option<&Curvature>,
        x: i32,
        y: i32,
    ) -> f32 {
        let own = |surface: &Surface| Some(surface.own_facing(surface.contours().at(x, y)?));
        self.at_facing(scene, curvature, (x, y), own)
    }

    /// The same, where it is known what n·v of a contour pixel is in the middle of what it sees
    /// itself.
    fn at_facing(
        &self,
        scene: &Scene,
        curvature: Option<&Curvature>,
        (x, y): (i32, i32),
        on_contour: impl Fn(&Surface) -> Option<f32>,
    ) -> f32 {
        if self.disabled {
            return 1.0;
        }
        let way = |v: f32| if self.invert { 1.0 - v } else { v };
        let derived = match &self.kind {
            MaskKind::File { coverage, .. } => {
                return way(coverage.get(x, y).map_or(0.0, |c| f32::from(c) / 255.0));
            }
            MaskKind::Derived(derived) => *derived,
        };
        let Some(surface) = &scene.surface else { return 1.0 };
        if !surface.size().rect().contains(x, y) {
            return 0.0;
        }
        let (x, y) = (x as usize, y as usize);
        match (derived, curvature) {
            (DerivedMask::Region(region), _) => {
                way(f32::from(surface.region(&region).at(x as i32, y as i32)) / 255.0)
            }
            (DerivedMask::Fresnel { f0, power }, _) => {
                let facing = on_contour(surface).unwrap_or_else(|| surface.facing(x, y));
                way(fresnel(facing, f0, power))
            }
            (DerivedMask::Depth { from, to }, _) => way(ramp(surface.depth(x, y), from, to)),
            (DerivedMask::Curvature { scale, from, to, .. }, Some(curvature)) => {
                way(ramp(curvature.kappa(x, y, scale), from, to))
            }
            (DerivedMask::Curvature { .. }, None) => 1.0,
        }
    }

    /// The tiles in which another version differs, where both are pictures of one size, used alike;
    /// otherwise `None`.
    pub(in crate::document) fn changed_tiles(&self, new: &LayerMask) -> Option<Vec<TileAt>> {
        let (MaskKind::File { coverage: a, .. }, MaskKind::File { coverage: b, .. }) =
            (&self.kind, &new.kind)
        else {
            return None;
        };
        if a.size() != b.size() || self.invert != new.invert || self.disabled != new.disabled {
            return None;
        }
        let canvas = a.size().rect();
        let differs = |at: &TileAt| {
            let inside = at.rect().intersect(canvas);
            let columns = inside.x0 as usize..inside.x1 as usize;
            (inside.y0 as usize..inside.y1 as usize)
                .any(|y| a.row(y)[columns.clone()] != b.row(y)[columns.clone()])
        };
        Some(TileAt::covering(canvas).filter(differs).collect())
    }
}

/// Schlick's approximation f0 + (1 − f0)(1 − n·v)^power, n·v clamped to `[0, 1]` (SF fig. 12c).
fn fresnel(facing: f32, f0: f32, power: f32) -> f32 {
    f0 + (1.0 - f0) * (1.0 - facing.max(0.0).min(1.0)).powf(power)
}

/// 0 at `from`, 1 at `to`, clamped; a step where they are the same.
fn ramp(v: f32, from: f32, to: f32) -> f32 {
    if from == to {
        return if v >= to { 1.0 } else { 0.0 };
    }
    ((v - from) / (to - from)).max(0.0).min(1.0)
}

/// A function of canvas pixels as one of tile pixels.
pub(in crate::document) fn tile_pixels(
    at: TileAt,
    value: impl Fn(i32, i32) -> f32,
) -> impl Fn(usize, usize) -> f32 {
    let rect = at.rect();
    move |x, y| value(rect.x0 + x as i32, rect.y0 + y as i32)
}
