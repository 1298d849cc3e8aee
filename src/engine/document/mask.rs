//! What a layer's mask covers, tile by tile.
//! Floor 4. Not here: what masks there are (`layer_mask`).

use super::behind::Behind;
use super::layer_mask::{DerivedMask, LayerMask, MaskKind};
use super::{Layer, Role, prepare, prepare::PreparedLayer};
use crate::paint::Scene;
use crate::raster::{Plane, TileAt, TileCoverage};
use crate::surface::{ContourPixel, Curvature, Surface};
use std::sync::Arc;

/// The coverage of a layer in each pixel of a tile: its opacity, its mask, and the surface if it is clipped to it. A
/// pixel that the surface covers in part counts as covered: what is clipped to the surface is absent from the rest of
/// it (`behind`), so that coverage acts once.
pub(super) fn coverage(node: &PreparedLayer, at: TileAt) -> TileCoverage {
    let coverage = TileCoverage::uniform(node.layer.opacity);
    let coverage = match clip(node) {
        None => coverage,
        Some(surface) => match cover_of_tile(surface, at) {
            TileCover::None => return TileCoverage::uniform(0.0),
            TileCover::Whole => coverage,
            TileCover::Part => {
                let plane = surface.coverage_plane();
                coverage.times(pixels(at, |x, y| if plane.get(x, y) > Some(0) { 1.0 } else { 0.0 }))
            }
        },
    };
    match &node.layer.mask {
        Some(mask) => mask.multiply(coverage, &node.scene, node.curvature.as_deref(), at),
        None => coverage,
    }
}

/// The surface does not cut the node in this tile.
pub(super) fn is_whole_on_surface(node: &PreparedLayer, at: TileAt) -> bool {
    clip(node).is_none_or(|surface| matches!(cover_of_tile(surface, at), TileCover::Whole))
}

/// The same for the other populations of a tile's contour pixels.
pub(super) fn coverage_behind(node: &PreparedLayer, behind: &Behind) -> TileCoverage {
    let mut coverage = TileCoverage::uniform(node.layer.opacity);
    if clip(node).is_some() && behind.has_bare() {
        coverage = coverage.times_values(behind.values(|_, pixel| if pixel.sees_surface() { 1.0 } else { 0.0 }));
    }
    let Some(mask) = node.layer.mask.as_ref().filter(|mask| mask.acts_on(&node.scene)) else { return coverage };
    if let (MaskKind::Derived(DerivedMask::Region(region)), Some(surface)) = (&mask.kind, &node.scene.surface) {
        // Of the other population's piece, nearby.
        let grid = surface.region(region);
        let way = |c: u8| f32::from(if mask.invert { 255 - c } else { c }) / 255.0;
        let value = |_, pixel: &ContourPixel| match pixel.sees_surface() {
            true => pixel.other_mean(|x, y| way(grid.at(x as i32, y as i32))),
            false => way(grid.at(pixel.x, pixel.y)),
        };
        return coverage.times_values(behind.values(value));
    }
    let value = |place: usize, pixel: &ContourPixel| match (behind.sheet_pixel(place), &node.behind) {
        // A picture lies on the canvas.
        (Some((x, y)), Some(sheet)) if !matches!(mask.kind, MaskKind::File { .. }) => {
            mask.at(sheet, node.behind_curvature.as_deref(), x as i32, y as i32)
        }
        _ => mask.at(&node.scene, node.curvature.as_deref(), pixel.x, pixel.y),
    };
    coverage.times_values(behind.values(value))
}

/// The surface does not cut the node behind the contours of a tile.
pub(super) fn is_whole_behind(node: &PreparedLayer, behind: &Behind) -> bool {
    clip(node).is_none() || !behind.has_bare()
}

/// The surface that a layer is clipped to, if any. A group is not clipped, because its layers clip themselves; clipping
/// twice would thin their rims. An adjustment changes only what is painted already.
pub(super) fn clip(node: &PreparedLayer) -> Option<&Surface> {
    let paints = matches!(node.layer.content.role(), Role::Paints | Role::Shapes(_));
    node.scene.surface.as_deref().filter(|_| paints && node.layer.clip_to_surface)
}

/// How much of a tile a surface covers.
enum TileCover {
    None,
    Part,
    Whole,
}

fn cover_of_tile(surface: &Surface, at: TileAt) -> TileCover {
    let plane = surface.coverage_plane();
    let inside = at.rect().intersect(surface.size().rect());
    let columns = inside.x0 as usize..inside.x1 as usize;
    let (mut least, mut most) = (u8::MAX, 0);
    for y in inside.y0..inside.y1 {
        // A whole row at a time: its bytes are compared side by side.
        for &c in &plane.row(y as usize)[columns.clone()] {
            (least, most) = (least.min(c), most.max(c));
        }
        if least == 0 && most > 0 {
            return TileCover::Part;
        }
    }
    if most == 0 { TileCover::None } else { TileCover::Whole }
}

/// A function of canvas pixels as one of a tile's.
fn pixels(at: TileAt, value: impl Fn(i32, i32) -> f32) -> impl Fn(usize, usize) -> f32 {
    let rect = at.rect();
    move |x, y| value(rect.x0 + x as i32, rect.y0 + y as i32)
}

impl LayerMask {
    /// The same mask as a picture that can be painted on; it looks the same. A derived mask covers everything where
    /// there is no surface.
    pub fn as_picture(&self, layer: &Layer, scene: &Scene) -> LayerMask {
        let plain = LayerMask { invert: false, disabled: false, ..self.clone() };
        let curvature = prepare::curvature_of_mask(layer, scene);
        let cover = |x: usize, y: usize| {
            let v = plain.at(scene, curvature.as_deref(), x as i32, y as i32);
            (v.max(0.0).min(1.0) * 255.0 + 0.5) as u8
        };
        let coverage = Arc::new(Plane::from_fn(scene.size, cover));
        LayerMask { kind: MaskKind::File { file: String::new(), coverage }, ..self.clone() }
    }
    /// Multiplies a coverage by the mask. One derived from a surface changes nothing where there is none.
    fn multiply(
        &self,
        coverage: TileCoverage,
        scene: &Scene,
        curvature: Option<&Curvature>,
        at: TileAt,
    ) -> TileCoverage {
        if !self.acts_on(scene) {
            return coverage;
        }
        if let (MaskKind::Derived(DerivedMask::Region(region)), Some(surface)) = (&self.kind, &scene.surface) {
            let grid = surface.region(region);
            let way = |c: u8| f32::from(if self.invert { 255 - c } else { c }) / 255.0;
            return coverage.times(pixels(at, |x, y| way(grid.at(x, y))));
        }
        coverage.times(pixels(at, |x, y| self.at(scene, curvature, x, y)))
    }
    /// It is shown, and what it is derived from is there.
    fn acts_on(&self, scene: &Scene) -> bool {
        let needs_surface = !matches!(self.kind, MaskKind::File { .. });
        !(self.disabled || needs_surface && scene.surface.is_none())
    }
    /// The mask at a pixel of the canvas, `[0, 1]`; `curvature`: the surface's, for a mask derived from it.
    pub(super) fn at(&self, scene: &Scene, curvature: Option<&Curvature>, x: i32, y: i32) -> f32 {
        if self.disabled {
            return 1.0;
        }
        let way = |v: f32| if self.invert { 1.0 - v } else { v };
        let derived = match &self.kind {
            MaskKind::File { coverage, .. } => return way(coverage.get(x, y).map_or(0.0, |c| f32::from(c) / 255.0)),
            MaskKind::Derived(derived) => *derived,
        };
        let Some(surface) = &scene.surface else { return 1.0 };
        if !surface.size().rect().contains(x, y) {
            return 0.0;
        }
        let (x, y) = (x as usize, y as usize);
        match (derived, curvature) {
            (DerivedMask::Region(region), _) => way(f32::from(surface.region(&region).at(x as i32, y as i32)) / 255.0),
            (DerivedMask::Fresnel { f0, power }, _) => way(fresnel(surface.facing(x, y), f0, power)),
            (DerivedMask::Depth { from, to }, _) => way(ramp(surface.depth(x, y), from, to)),
            (DerivedMask::Curvature { scale, from, to, .. }, Some(curvature)) => {
                way(ramp(curvature.kappa(x, y, scale), from, to))
            }
            (DerivedMask::Curvature { .. }, None) => 1.0,
        }
    }
}

/// Schlick's approximation f0 + (1 − f0)(1 − n·v)^power, n·v clamped to `[0, 1]` (SF fig. 12c).
fn fresnel(facing: f32, f0: f32, power: f32) -> f32 {
    f0 + (1.0 - f0) * (1.0 - facing.max(0.0).min(1.0)).powf(power)
}

/// The tiles in which two masks differ, where both are pictures of one size that count alike; `None` where they are
/// not.
pub(super) fn changed_tiles(old: &LayerMask, new: &LayerMask) -> Option<Vec<TileAt>> {
    let (MaskKind::File { coverage: a, .. }, MaskKind::File { coverage: b, .. }) = (&old.kind, &new.kind) else {
        return None;
    };
    if a.size() != b.size() || old.invert != new.invert || old.disabled != new.disabled {
        return None;
    }
    let canvas = a.size().rect();
    let differs = |at: &TileAt| {
        let inside = at.rect().intersect(canvas);
        let columns = inside.x0 as usize..inside.x1 as usize;
        (inside.y0 as usize..inside.y1 as usize).any(|y| a.row(y)[columns.clone()] != b.row(y)[columns.clone()])
    };
    Some(TileAt::covering(canvas).filter(differs).collect())
}

/// 0 at `from`, 1 at `to`, clamped; a step where they are the same.
fn ramp(v: f32, from: f32, to: f32) -> f32 {
    if from == to {
        return if v >= to { 1.0 } else { 0.0 };
    }
    ((v - from) / (to - from)).max(0.0).min(1.0)
}
