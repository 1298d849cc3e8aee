//! One tile of a document: its layers composed bottom to top, in f32.
//! Floor 4. Which layers these are is `prepare`; what a layer holds is rendered by `content`; how pixels mix is
//! `raster::blend`.

use super::content::{self, Painted};
use super::prepare::{Node, Prepared};
use super::{Content, mask};
use crate::raster::{BlendMode, Coverage, Mix, Paint, PlanarTile, TileAt};
use std::ops::ControlFlow;

/// Composing ends early, with what lies beneath, at an adjustment that is sought.
pub(super) type Flow<T = ()> = ControlFlow<PlanarTile, T>;

/// Composes nodes of one tile.
pub(super) struct Composer<'a> {
    pub prepared: &'a Prepared,
    pub at: TileAt,
    /// The adjustment to end at, if this is to measure what lies beneath one.
    pub sought: Option<usize>,
}

impl Composer<'_> {
    /// Composes a stack onto a tile, leaving out what an opaque layer hides.
    pub fn stack(&self, nodes: &[Node], onto: &mut PlanarTile) -> Flow {
        nodes[self.first_seen(nodes)..].iter().try_for_each(|node| self.node(node, onto, false))
    }
    /// The topmost node that hides all beneath it, else the bottom one.
    pub fn first_seen(&self, nodes: &[Node]) -> usize {
        // What is sought must be reached, so only layers beneath it may hide others.
        let end = nodes.iter().position(|node| self.is_sought_in(node)).unwrap_or(nodes.len());
        nodes[..end].iter().rposition(|node| self.hides_all_beneath(node)).unwrap_or(0)
    }
    /// Composes one layer, with those clipped to it, onto a tile. `atop`: it is itself clipped to what is there.
    fn node(&self, node: &Node, onto: &mut PlanarTile, atop: bool) -> Flow {
        let coverage = mask::coverage(node, self.at);
        if coverage.is_none() && !self.is_sought_in(node) {
            return Flow::Continue(());
        }
        match &node.layer.content {
            Content::RadianceScaling(_) => self.adjustment(node, onto, &coverage),
            // Clipped to something, or with something clipped to it, a group needs pixels of its own.
            Content::Group(group) if group.pass_through && !atop && node.clipped.is_empty() => {
                self.pass_through(node, onto, &coverage)
            }
            _ => self.paint(node, onto, &coverage, atop),
        }
    }
    /// A layer with pixels of its own, or an isolated group.
    fn paint(&self, node: &Node, onto: &mut PlanarTile, coverage: &Coverage, atop: bool) -> Flow {
        let mix = Mix { mode: node.layer.blend, linear: node.layer.blend_linear, atop };
        let painted = self.content(node)?;
        if node.clipped.is_empty() {
            if let Some(paint) = painted.as_paint() {
                onto.blend(mix, paint, coverage);
            }
            return Flow::Continue(());
        }
        // A clipping group: the run on the base's own pixels and in its shape, then the base's way to meet the backdrop.
        let mut own = PlanarTile::transparent();
        if let Some(paint) = painted.as_paint() {
            own.blend(Mix::default(), paint, &coverage.mask_only());
        } else if !self.is_sought_in(node) {
            return Flow::Continue(());
        }
        self.clipped(node, &mut own)?;
        onto.blend(mix, Paint::Planar(&own), &coverage.opacity_only());
        Flow::Continue(())
    }
    fn content(&self, node: &Node) -> Flow<Painted> {
        if let Content::Group(_) = &node.layer.content {
            let mut pixels = PlanarTile::transparent();
            self.stack(&node.children, &mut pixels)?;
            return Flow::Continue(Painted::Group(pixels));
        }
        Flow::Continue(content::render(&node.layer.content, &node.scene, self.at))
    }
    fn clipped(&self, base: &Node, own: &mut PlanarTile) -> Flow {
        base.clipped.iter().try_for_each(|node| self.node(node, own, true))
    }
    /// The children blend with the backdrop itself; opacity and mask fade between before and after.
    fn pass_through(&self, node: &Node, onto: &mut PlanarTile, coverage: &Coverage) -> Flow {
        if coverage.is_full() {
            return self.stack(&node.children, onto);
        }
        let mut after = onto.clone();
        self.stack(&node.children, &mut after)?;
        onto.mix_toward(&after, coverage);
        Flow::Continue(())
    }
    /// Changes what lies beneath; what is clipped to it is painted on the changed picture, within its mask.
    fn adjustment(&self, node: &Node, onto: &mut PlanarTile, coverage: &Coverage) -> Flow {
        let index = node.adjustments.start;
        if self.sought == Some(index) {
            return Flow::Break(std::mem::replace(onto, PlanarTile::transparent()));
        }
        let (Content::RadianceScaling(scaling), Some(&beneath)) =
            (&node.layer.content, self.prepared.beneath.get(index))
        else {
            return Flow::Continue(());
        };
        if coverage.is_full() && node.clipped.is_empty() {
            scaling.apply_tile(&node.scene, self.at, beneath, onto);
            return Flow::Continue(());
        }
        let mut after = onto.clone();
        scaling.apply_tile(&node.scene, self.at, beneath, &mut after);
        self.clipped(node, &mut after)?;
        onto.mix_toward(&after, coverage);
        Flow::Continue(())
    }
    fn is_sought_in(&self, node: &Node) -> bool {
        self.sought.is_some_and(|index| node.adjustments.contains(&index))
    }
    /// Nothing beneath this node can be seen in the tile.
    fn hides_all_beneath(&self, node: &Node) -> bool {
        let layer = &node.layer;
        let may_hide = layer.blend == BlendMode::Normal && layer.opacity >= 1.0 && layer.mask.is_none();
        // Groups and adjustments are never known to hide before they are composed.
        may_hide
            && mask::is_whole_on_surface(node, self.at)
            && content::render(&layer.content, &node.scene, self.at).is_opaque()
    }
}
