//! Composes one tile of a document: its layers from bottom to top, in f32. Floor 4. `prepare` selects the layers,
//! `content` renders them, `raster::blend` mixes the pixels.

use super::content::TileContent;
use super::prepare::{PreparedDocument, PreparedLayer};
use super::{Role, mask};
use crate::raster::{BlendMode, Mix, PlanarTile, TileAt, TileCoverage, TilePaint};
use std::ops::ControlFlow;

/// Breaks with the composite so far when the sought adjustment is reached.
pub(super) type ComposeFlow<T = ()> = ControlFlow<PlanarTile, T>;

/// Composes nodes of one tile.
pub(super) struct Composer<'a> {
    pub prepared: &'a PreparedDocument,
    pub at: TileAt,
    /// The adjustment to end at, if this is to measure what lies beneath one.
    pub sought: Option<usize>,
}

impl Composer<'_> {
    /// Composes a stack onto a tile, leaving out what an opaque layer hides.
    pub fn stack(&self, nodes: &[PreparedLayer], onto: &mut PlanarTile) -> ComposeFlow {
        nodes[self.first_visible(nodes)..].iter().try_for_each(|node| self.node(node, onto, false))
    }
    /// The topmost node that hides all beneath it, else the bottom one.
    pub fn first_visible(&self, nodes: &[PreparedLayer]) -> usize {
        // The sought adjustment must be reached, so only layers beneath it may hide others.
        let end = nodes.iter().position(|node| self.is_sought_in(node)).unwrap_or(nodes.len());
        nodes[..end].iter().rposition(|node| self.hides_all_beneath(node)).unwrap_or(0)
    }
    /// Composes one layer, with those clipped to it, onto a tile. `atop`: it is itself clipped to what is there.
    fn node(&self, node: &PreparedLayer, onto: &mut PlanarTile, atop: bool) -> ComposeFlow {
        let coverage = mask::coverage(node, self.at);
        if coverage.is_none() && !self.is_sought_in(node) {
            return ComposeFlow::Continue(());
        }
        match node.layer.content.role() {
            Role::Adjusts(_) => self.adjustment(node, onto, &coverage),
            // Clipped to something, or with something clipped to it, a group needs pixels of its own.
            Role::Groups(group) if group.pass_through && !atop && node.clipped.is_empty() => {
                self.pass_through(node, onto, &coverage)
            }
            _ => self.paint(node, onto, &coverage, atop),
        }
    }
    /// A layer with pixels of its own, or an isolated group.
    fn paint(&self, node: &PreparedLayer, onto: &mut PlanarTile, coverage: &TileCoverage, atop: bool) -> ComposeFlow {
        let mix = Mix { mode: node.layer.blend, linear: node.layer.blend_linear, atop, ..Mix::default() }.on(self.at);
        let painted = self.content(node)?;
        if node.clipped.is_empty() {
            if let Some(paint) = painted.as_paint() {
                onto.blend(mix, paint, coverage);
            }
            return ComposeFlow::Continue(());
        }
        // A clipping group: the run on the base's own pixels and in its shape, then the base's way to meet the
        // backdrop.
        let mut own = PlanarTile::transparent();
        if let Some(paint) = painted.as_paint() {
            own.blend(Mix::default(), paint, &coverage.mask_only());
        } else if !self.is_sought_in(node) {
            return ComposeFlow::Continue(());
        }
        self.clipped(node, &mut own)?;
        onto.blend(mix, TilePaint::Planar(&own), &coverage.opacity_only());
        ComposeFlow::Continue(())
    }
    fn content(&self, node: &PreparedLayer) -> ComposeFlow<TileContent> {
        if let Role::Groups(_) = node.layer.content.role() {
            let mut pixels = PlanarTile::transparent();
            self.stack(&node.children, &mut pixels)?;
            return ComposeFlow::Continue(TileContent::Group(pixels));
        }
        ComposeFlow::Continue(node.layer.content.painted(&node.scene, self.at))
    }
    fn clipped(&self, base: &PreparedLayer, own: &mut PlanarTile) -> ComposeFlow {
        base.clipped.iter().try_for_each(|node| self.node(node, own, true))
    }
    /// The children blend with the backdrop itself; opacity and mask fade between before and after.
    fn pass_through(&self, node: &PreparedLayer, onto: &mut PlanarTile, coverage: &TileCoverage) -> ComposeFlow {
        if coverage.is_full() {
            return self.stack(&node.children, onto);
        }
        let mut after = onto.clone();
        self.stack(&node.children, &mut after)?;
        onto.mix_toward(&after, coverage);
        ComposeFlow::Continue(())
    }
    /// Changes what lies beneath; what is clipped to it is painted on the changed picture, within its mask.
    fn adjustment(&self, node: &PreparedLayer, onto: &mut PlanarTile, coverage: &TileCoverage) -> ComposeFlow {
        let index = node.adjustments.start;
        if self.sought == Some(index) {
            return ComposeFlow::Break(std::mem::replace(onto, PlanarTile::transparent()));
        }
        let (Role::Adjusts(scaling), Some(&beneath)) = (node.layer.content.role(), self.prepared.beneath.get(index))
        else {
            return ComposeFlow::Continue(());
        };
        if coverage.is_full() && node.clipped.is_empty() {
            scaling.apply_tile(&node.scene, self.at, beneath, onto);
            return ComposeFlow::Continue(());
        }
        let mut after = onto.clone();
        scaling.apply_tile(&node.scene, self.at, beneath, &mut after);
        self.clipped(node, &mut after)?;
        onto.mix_toward(&after, coverage);
        ComposeFlow::Continue(())
    }
    fn is_sought_in(&self, node: &PreparedLayer) -> bool {
        self.sought.is_some_and(|index| node.adjustments.contains(&index))
    }
    /// Whether this node hides everything beneath it in the tile.
    fn hides_all_beneath(&self, node: &PreparedLayer) -> bool {
        let layer = &node.layer;
        let may_hide = layer.blend == BlendMode::Normal && layer.opacity >= 1.0 && layer.mask.is_none();
        // Groups and adjustments are never known to hide before they are composed.
        may_hide && mask::is_whole_on_surface(node, self.at) && layer.content.painted(&node.scene, self.at).is_opaque()
    }
}
