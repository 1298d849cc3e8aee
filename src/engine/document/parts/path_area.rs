//! Outlines of paths: the exact area that a path covers, not the pixels that it paints. Floor 4.
//! Not here: outlines of pixels (`outlines`).

use super::drawn::DrawnLayer;
use crate::document::layer::Layer;
use crate::document::layer::content::{Content, Group};
use crate::math::Size;
use crate::paint::{LivePath, PlacedImage};
use crate::raster::CoverageGrid;
use crate::raster::coverage::product;
use crate::surface::Bend;
use std::sync::Arc;

impl DrawnLayer {
    /// What a path covers, however opaque it is: a layer that is one, or a group of one and the
    /// frames that clip it. `None` for any other layer, and where something displaces it, masks it
    /// or lies around it.
    pub fn path_area(&self, canvas: Size) -> Option<CoverageGrid> {
        let layer = self.layer();
        if self.is_displaced() || !is_plain(layer) {
            return None;
        }
        match &layer.content {
            Content::Image(_) => {
                let shown = self.map().layer_on_canvas(layer);
                Some(flat_path(&shown, canvas)?.area(canvas.rect()))
            }
            Content::Group(group) => self.clipped_area(group, canvas),
            _ => None,
        }
    }

    fn clipped_area(&self, group: &Group, canvas: Size) -> Option<CoverageGrid> {
        let [own, frames @ ..] = &group.layers[..] else { return None };
        let path = |layer: &Arc<Layer>| {
            let is_seen = is_plain(layer) && !layer.is_warped();
            let shown = is_seen.then(|| self.map().within(layer).layer_on_canvas(layer))?;
            flat_path(&shown, canvas)
        };
        let is_bare = |frame: &LivePath| frame.fill.is_none() && frame.outline <= 0.0;
        let clip = |area: CoverageGrid, layer: &Arc<Layer>| {
            let frame = path(layer).filter(|frame| layer.is_frame() && is_bare(frame))?;
            Some(area.combined(&frame.inside(canvas.rect()), product))
        };
        let area = path(own).filter(|_| !own.is_frame())?.area(canvas.rect());
        frames.iter().try_fold(area, clip)
    }
}

/// Whether a layer shows what it holds, more or less opaque.
fn is_plain(layer: &Layer) -> bool {
    let is_bare = layer.mask.is_none() && layer.effects.is_empty() && !layer.clip_below;
    is_bare && layer.visible && layer.opacity > 0.0
}

/// The path of a layer on the canvas, where no surface bends it.
fn flat_path(layer: &Layer, canvas: Size) -> Option<LivePath> {
    let Content::Image(live) = &layer.content else { return None };
    let flat = PlacedImage { bend: Bend::default(), ..live.params().clone() };
    flat.path_on_canvas(canvas)
}
