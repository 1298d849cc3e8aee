//! What a layer's mask covers, tile by tile.
//! Floor 4. Not here: what masks there are (`layer::mask`).

use super::far_side::FarTile;
use super::layer::mask::tile_pixels;
use super::prepare::PreparedLayer;
use super::{DerivedMask, MaskKind};
use crate::raster::{TileAt, TileCoverage};
use crate::surface::{ContourPixel, Surface};

/// The coverage of a layer in each pixel of a tile: its opacity, its mask, and the surface if it is
/// clipped to it. A pixel that the surface covers in part counts as covered: what is clipped to the
/// surface is missing in the rest of the pixel (`far_side`), so that coverage acts once.
pub(super) fn coverage(node: &PreparedLayer, at: TileAt) -> TileCoverage {
    let coverage = TileCoverage::uniform(node.layer.opacity);
    let coverage = match clip(node) {
        None => coverage,
        Some(surface) => match cover_of_tile(surface, at) {
            TileCover::None => return TileCoverage::uniform(0.0),
            TileCover::Whole => coverage,
            TileCover::Part => {
                let plane = surface.coverage_plane();
                coverage.times(tile_pixels(
                    at,
                    |x, y| if plane.get(x, y) > Some(0) { 1.0 } else { 0.0 },
                ))
            }
        },
    };
    match &node.layer.mask {
        Some(mask) => mask.multiply(coverage, &node.scene, node.curvature.as_deref(), at),
        None => coverage,
    }
}

/// The mask of a layer in a tile that may lie beyond the canvas: a picture's border is continued
/// there, so that the border of the canvas is no edge. The opacity is no part of it.
pub(super) fn coverage_around_canvas(node: &PreparedLayer, at: TileAt) -> TileCoverage {
    let canvas = node.scene.size.rect();
    if at.rect().intersect(canvas) == at.rect() {
        return coverage(node, at).mask_only();
    }
    let mut covered = TileCoverage::FULL;
    if let Some(surface) = clip(node) {
        let plane = surface.coverage_plane();
        covered = covered.times(tile_pixels(at, |x, y| {
            if plane.get(x, y).is_some_and(|c| c > 0) { 1.0 } else { 0.0 }
        }));
    }
    let Some(mask) = node.layer.mask.as_ref().filter(|mask| mask.is_active_on(&node.scene)) else {
        return covered;
    };
    covered.times(tile_pixels(at, |x, y| {
        let (x, y) = (x.clamp(0, canvas.x1 - 1), y.clamp(0, canvas.y1 - 1));
        mask.at(&node.scene, node.curvature.as_deref(), x, y)
    }))
}

/// The surface does not cut the node in this tile.
pub(super) fn is_whole_on_surface(node: &PreparedLayer, at: TileAt) -> bool {
    clip(node).is_none_or(|surface| matches!(cover_of_tile(surface, at), TileCover::Whole))
}

/// The same for the other sides of a tile's contour pixels.
pub(super) fn coverage_on_far_side(node: &PreparedLayer, far: &FarTile) -> TileCoverage {
    let mut coverage = TileCoverage::uniform(node.layer.opacity);
    if clip(node).is_some() && far.has_bare() {
        coverage = coverage.times_values(
            far.values(|_, pixel| if pixel.is_other_on_surface() { 1.0 } else { 0.0 }),
        );
    }
    let Some(mask) = node.layer.mask.as_ref().filter(|mask| mask.is_active_on(&node.scene)) else {
        return coverage;
    };
    if let (MaskKind::Derived(DerivedMask::Region(region)), Some(surface)) =
        (&mask.kind, &node.scene.surface)
    {
        // Read from the other side's piece, nearby.
        let grid = surface.region(region);
        let way = |c: u8| f32::from(if mask.invert { 255 - c } else { c }) / 255.0;
        let value = |_, pixel: &ContourPixel| match pixel.is_other_on_surface() {
            true => pixel.other_mean(|x, y| way(grid.at(x as i32, y as i32))),
            false => way(grid.at(pixel.x, pixel.y)),
        };
        return coverage.times_values(far.values(value));
    }
    let value = |place: usize, pixel: &ContourPixel| match (far.far_pixel(place), &node.far) {
        // A picture lies on the canvas.
        (Some((x, y)), Some(far)) if !matches!(mask.kind, MaskKind::File { .. }) => {
            mask.at(far, node.far_curvature.as_deref(), x as i32, y as i32)
        }
        _ => mask.at(&node.scene, node.curvature.as_deref(), pixel.x, pixel.y),
    };
    coverage.times_values(far.values(value))
}

/// The surface does not cut the node behind the contours of a tile.
pub(super) fn is_whole_on_far_side(node: &PreparedLayer, far: &FarTile) -> bool {
    clip(node).is_none() || !far.has_bare()
}

/// The surface that a layer is clipped to, if any. A group is not clipped, because its layers are
/// themselves clipped; clipping twice would thin their rims. An adjustment changes only what is
/// painted already.
pub(super) fn clip(node: &PreparedLayer) -> Option<&Surface> {
    let clips = node.layer.clip_to_surface && node.layer.can_be_cut();
    node.scene.surface.as_deref().filter(|_| clips)
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
