//! Composes one tile of a document: its layers from bottom to top, in f32. By the same rules it
//! composes what the other sides of its contour pixels see (`far_side`). Floor 4. `prepare`
//! selects the layers, `content` renders them, `raster::blend` mixes the pixels.

mod effects;

use super::far_side::{FarScene, FarTile};
use super::floats::FloatTiles;
use super::layer::adjustment::{AdjustedPlace, Adjustment};
use super::layer::tile_content::TileContent;
use super::prepare::{PreparedDocument, PreparedLayer};
use super::{Content, Layer, Role, mask};
use crate::raster::{BlendMode, Mix, PlanarTile, TILE, Tile, TileAt, TileCoverage, TilePaint};
use crate::shading::radiance::{BackdropStats, Exactness};
use std::ops::ControlFlow;
use std::sync::Arc;

/// Breaks with the composite so far when the sought adjustment is reached.
pub(super) type ComposeFlow<T = ()> = ControlFlow<PlanarTile, T>;

/// Composes nodes of one tile.
pub(super) struct Composer<'a> {
    pub prepared: &'a PreparedDocument,
    pub at: TileAt,
    /// The pixels to compose, if not the tile's.
    pub far: Option<FarTile<'a>>,
    /// The adjustment to end at, if this is to measure what lies beneath one.
    pub sought: Option<usize>,
    /// The pixels of live layers, if not the bytes that they are rendered to.
    pub floats: Option<&'a FloatTiles>,
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
        nodes[..end].iter().rposition(|node| self.is_covering(node)).unwrap_or(0)
    }

    /// The tile of the topmost node, if nothing else is seen: it hides what lies beneath, and
    /// nothing is clipped to it.
    pub fn only_tile(&self, nodes: &[PreparedLayer]) -> Option<Arc<Tile>> {
        let node = nodes.last().filter(|node| node.clipped.is_empty() && self.is_covering(node))?;
        if let TileContent::Tile(tile) = self.compose_layer(node) { Some(tile) } else { None }
    }

    /// Composes one layer, with those clipped to it, onto a tile. `atop`: it is itself clipped to
    /// what is there.
    fn node(&self, node: &PreparedLayer, onto: &mut PlanarTile, atop: bool) -> ComposeFlow {
        let coverage = match &self.far {
            Some(far) => mask::coverage_on_far_side(node, far),
            None => mask::coverage(node, self.at),
        };
        if coverage.is_none() && node.effects.is_none() && !self.is_sought_in(node) {
            return ComposeFlow::Continue(());
        }
        if let Some(effects) = &node.effects {
            return self.with_effects(node, effects, onto, &coverage, atop);
        }
        match node.layer.content.role() {
            Role::Adjusts(_) => self.adjustment(node, onto, &coverage, atop),
            // Clipped to something, or with something clipped to it, a group needs pixels of its
            // own.
            Role::Groups(group)
                if group.pass_through
                    && !atop
                    && node.clipped.is_empty()
                    && node.warp.is_none() =>
            {
                self.pass_through(node, onto, &coverage)
            }
            _ => self.paint(node, onto, &coverage, atop),
        }
    }

    /// A layer with pixels of its own, or an isolated group.
    fn paint(
        &self,
        node: &PreparedLayer,
        onto: &mut PlanarTile,
        coverage: &TileCoverage,
        atop: bool,
    ) -> ComposeFlow {
        let mix = self.own_mix(node, atop);
        let painted = self.content(node)?;
        if node.clipped.is_empty() {
            if let Some(paint) = painted.as_paint() {
                self.blend(onto, mix, paint, coverage);
            }
            return ComposeFlow::Continue(());
        }
        // A clipping group: the run on the base's own pixels and in its shape, then onto the
        // backdrop as the base's blending says.
        let mut own = self.blank();
        if let Some(paint) = painted.as_paint() {
            own.blend(Mix::default(), paint, &coverage.mask_only());
        } else if !self.is_sought_in(node) {
            return ComposeFlow::Continue(());
        }
        self.compose_clipped(node, &mut own)?;
        self.blend(onto, mix, TilePaint::Planar(&own), &coverage.opacity_only());
        ComposeFlow::Continue(())
    }

    /// How a layer's own color is mixed.
    fn own_mix(&self, node: &PreparedLayer, atop: bool) -> Mix {
        let Layer { blend: mode, blend_linear: linear, .. } = *node.layer;
        Mix { mode, linear, atop, ..Mix::default() }.on(self.at)
    }

    /// As many transparent pixels as are composed.
    pub fn blank(&self) -> PlanarTile {
        self.far.map_or_else(PlanarTile::transparent, |far| PlanarTile::of_rows(far.rows()))
    }

    fn blend(&self, onto: &mut PlanarTile, mix: Mix, paint: TilePaint, coverage: &TileCoverage) {
        let Some(far) = self.far.filter(|_| mix.mode == BlendMode::Dissolve) else {
            return match self.floats {
                Some(_) => onto.blend_bright(mix, paint, coverage),
                None => onto.blend(mix, paint, coverage),
            };
        };
        // Noise is fixed to the canvas, and packed pixels lie anywhere on it. Pixels that are whole
        // or empty stay so.
        let mut dissolved = self.blank();
        dissolved.blend(Mix::default(), paint, coverage);
        far.dissolve(&mut dissolved);
        onto.blend(mix, TilePaint::Planar(&dissolved), &TileCoverage::FULL);
    }

    fn content(&self, node: &PreparedLayer) -> ComposeFlow<TileContent> {
        if let Role::Groups(_) = node.layer.content.role() {
            // What lies beneath an adjustment in it is measured undisplaced.
            if !node.children.iter().any(|child| self.is_sought_in(child))
                && let Some(shown) = self.compose_displaced(node)
            {
                return ComposeFlow::Continue(shown);
            }
            let mut pixels = self.blank();
            self.layers_of(node, &mut pixels)?;
            return ComposeFlow::Continue(TileContent::Group(pixels));
        }
        ComposeFlow::Continue(self.compose_layer(node))
    }

    /// Composes the layers of a group onto a tile; what lies beneath a frame only inside of it.
    fn layers_of(&self, group: &PreparedLayer, onto: &mut PlanarTile) -> ComposeFlow {
        let nodes = &group.children;
        let mut framed =
            nodes.iter().enumerate().filter(|(_, node)| node.frame.is_some()).peekable();
        if framed.peek().is_none() {
            return self.stack(nodes, onto);
        }
        let (around, mut done) = (onto.clone(), 0);
        for (place, node) in framed {
            self.stack(&nodes[done..place], onto)?;
            let all = std::mem::replace(onto, around.clone());
            onto.mix_toward(&all, &self.frame_coverage(node));
            done = place;
        }
        self.stack(&nodes[done..], onto)
    }

    /// Where what lies beneath a frame is seen.
    fn frame_coverage(&self, node: &PreparedLayer) -> TileCoverage {
        let Some(inside) = &node.frame else { return TileCoverage::FULL };
        let share = |c: u8| f32::from(c) / 255.0;
        if let Some(far) = &self.far {
            let values = far.values(|_, pixel| share(inside.at(pixel.x, pixel.y)));
            return TileCoverage::FULL.times_values(values);
        }
        match inside.tile(self.at) {
            None => TileCoverage::uniform(0.0),
            Some(tile) if tile.is_whole() => TileCoverage::FULL,
            Some(tile) => {
                TileCoverage::FULL.times_values(tile.bytes().iter().map(|c| share(*c)).collect())
            }
        }
    }

    fn compose_layer(&self, node: &PreparedLayer) -> TileContent {
        self.compose_displaced(node).unwrap_or_else(|| self.compose_in_place(node))
    }

    /// What a displaced layer shows; `None` where it shows itself, and for one that is not
    /// displaced. Both sides of a contour pixel see the same, as with paint.
    fn compose_displaced(&self, node: &PreparedLayer) -> Option<TileContent> {
        let shown = node.warp.as_ref()?.displaced_tile(self.at, &|at| self.in_place(node, at))?;
        let Some(tile) = shown else { return Some(TileContent::Nothing) };
        Some(match self.far {
            Some(far) => TileContent::Packed(Arc::new(far.same(&tile))),
            None => TileContent::Tile(tile),
        })
    }

    /// A tile of a layer alone, undisplaced: its contours mixed, not yet clipped to the surface.
    fn in_place(&self, node: &PreparedLayer, at: TileAt) -> Option<Arc<Tile>> {
        let composed = |far: Option<FarTile>| {
            let composer =
                Composer { prepared: self.prepared, at, far, sought: None, floats: None };
            let mut pixels = composer.blank();
            match node.layer.content.role() {
                Role::Groups(_) => drop(composer.layers_of(node, &mut pixels)),
                _ => {
                    if let Some(paint) = composer.compose_in_place(node).as_paint() {
                        pixels.blend(Mix::default(), paint, &TileCoverage::FULL);
                    }
                }
            }
            pixels
        };
        let mut pixels = composed(None);
        if let Some(contours) = self.prepared.contours.as_ref().and_then(|contours| contours.on(at))
        {
            let far = FarTile::new(at, contours);
            let other = composed(Some(far));
            match node.warp.as_ref().is_some_and(|warp| warp.is_cut) {
                true => far.take_surface_into(&other, &mut pixels),
                false => far.mix_into(&other, &mut pixels, 1.0),
            }
        }
        match node.has_16_bit_paint(at) {
            true => pixels.to_tile(true),
            false => pixels.quantize(),
        }
        .map(Arc::new)
    }

    fn compose_in_place(&self, node: &PreparedLayer) -> TileContent {
        if let (Some(floats), Some(marks)) = (self.floats, node.layer.content.marks()) {
            return floats.content(node, marks, self.at, self.far);
        }
        match self.far {
            Some(far) => node.layer.content.render_far_side_tile(&node.far_scene(far)),
            None => node.layer.content.render_tile(&node.scene, self.at),
        }
    }

    fn compose_clipped(&self, base: &PreparedLayer, own: &mut PlanarTile) -> ComposeFlow {
        base.clipped.iter().try_for_each(|node| self.node(node, own, true))
    }

    /// The children blend with the backdrop itself; opacity and mask fade between before and after.
    fn pass_through(
        &self,
        node: &PreparedLayer,
        onto: &mut PlanarTile,
        coverage: &TileCoverage,
    ) -> ComposeFlow {
        if coverage.is_full() {
            return self.layers_of(node, onto);
        }
        let mut after = onto.clone();
        self.layers_of(node, &mut after)?;
        onto.mix_toward(&after, coverage);
        ComposeFlow::Continue(())
    }

    /// Changes what lies beneath; what is clipped to it is painted on the changed picture, within
    /// its mask. `atop`: it is clipped to what is there, whose alpha stays.
    fn adjustment(
        &self,
        node: &PreparedLayer,
        onto: &mut PlanarTile,
        coverage: &TileCoverage,
        atop: bool,
    ) -> ComposeFlow {
        let index = node.adjustments.start;
        if self.sought == Some(index) {
            return ComposeFlow::Break(std::mem::replace(onto, PlanarTile::transparent()));
        }
        let (Role::Adjusts(adjustment), Some(&beneath)) =
            (node.layer.content.role(), self.prepared.beneath.get(index))
        else {
            return ComposeFlow::Continue(());
        };
        let exactness = self.floats.map_or(Exactness::Fast, FloatTiles::exactness);
        let filtered = self.prepared.filtered_tile(index, self.at, self.floats);
        let apply = |pixels: &mut PlanarTile| match (&filtered, &self.far) {
            (Some(filtered), Some(far)) => filtered.put_on_far_side(far, pixels, atop),
            (Some(filtered), None) => filtered.put_on(pixels, atop),
            (None, Some(far)) => {
                adjust_far_side(adjustment, &node.far_scene(*far), beneath, exactness, pixels)
            }
            (None, None) => {
                let place = AdjustedPlace::Tile { scene: &node.scene, at: self.at };
                adjustment.adjust(&place, beneath, exactness, pixels);
            }
        };
        let Layer { blend, blend_linear: linear, .. } = *node.layer;
        let is_plain = blend == BlendMode::Normal && !linear;
        if is_plain && coverage.is_full() && node.clipped.is_empty() {
            apply(onto);
            return ComposeFlow::Continue(());
        }
        let mut after = onto.clone();
        apply(&mut after);
        self.compose_clipped(node, &mut after)?;
        if is_plain {
            onto.mix_toward(&after, coverage);
            return ComposeFlow::Continue(());
        }
        // The changed colors are blended with those before, wherever these are; alpha stays.
        after.make_opaque();
        let mix = Mix { mode: blend, linear, atop: true, ..Mix::default() }.on(self.at);
        self.blend(onto, mix, TilePaint::Planar(&after), coverage);
        ComposeFlow::Continue(())
    }

    fn is_sought_in(&self, node: &PreparedLayer) -> bool {
        self.sought.is_some_and(|index| node.adjustments.contains(&index))
    }

    /// Whether this node hides everything beneath it in the tile.
    fn is_covering(&self, node: &PreparedLayer) -> bool {
        let layer = &node.layer;
        let may_hide = layer.blend == BlendMode::Normal
            && layer.opacity >= 1.0
            && layer.fill_opacity >= 1.0
            && layer.mask.is_none()
            && node.effects.is_none();
        if layer.content.filter().is_some() {
            // It replaces what is there by what it has composed itself.
            return may_hide && !layer.blend_linear;
        }
        // Groups and adjustments are never known to hide before they are composed.
        let is_whole = || match &self.far {
            Some(far) => mask::is_whole_on_far_side(node, far),
            None => mask::is_whole_on_surface(node, self.at),
        };
        // In floats a layer is rendered once, for what it shows.
        let is_known = self.floats.is_none() || node.layer.content.marks().is_none();
        may_hide && is_known && is_whole() && self.compose_layer(node).is_opaque()
    }
}

impl PreparedLayer {
    /// Whether its paint, or that of a layer in it or clipped to it, has 16 bits on a tile.
    pub(super) fn has_16_bit_paint(&self, at: TileAt) -> bool {
        let own = match &self.layer.content {
            Content::Pixels(pixels) => pixels.tiles.tile(at).is_some_and(|tile| tile.is_16_bit()),
            _ => false,
        };
        own || self.children.iter().chain(&self.clipped).any(|node| node.has_16_bit_paint(at))
    }

    /// Whether a placed picture of more than 8 bits shows on a tile: its own, or one of a layer in
    /// or clipped to it.
    pub(super) fn has_16_bit_picture(&self, at: TileAt) -> bool {
        let own = match &self.layer.content {
            Content::Image(live) if live.params().source.picture.is_16_bit() => {
                !matches!(self.layer.content.render_tile(&self.scene, at), TileContent::Nothing)
            }
            _ => false,
        };
        own || self.children.iter().chain(&self.clipped).any(|node| node.has_16_bit_picture(at))
    }

    fn far_scene<'s>(&'s self, tile: FarTile<'s>) -> FarScene<'s> {
        FarScene { tile, front: &self.scene, far: self.far.as_ref() }
    }
}

/// An adjustment of what the other sides see.
fn adjust_far_side(
    adjustment: &dyn Adjustment,
    scene: &FarScene,
    beneath: BackdropStats,
    exactness: Exactness,
    pixels: &mut PlanarTile,
) {
    let surface = scene.far.and_then(|far| far.surface.as_deref());
    let places: Vec<Option<(usize, usize)>> =
        (0..scene.tile.rows() * TILE).map(|place| scene.tile.far_pixel(place)).collect();
    let mut canvas = vec![None; places.len()];
    for (place, pixel) in scene.tile.places() {
        canvas[place] = usize::try_from(pixel.x).ok().zip(usize::try_from(pixel.y).ok());
    }
    let front = scene.front.surface.as_deref();
    adjustment.adjust(
        &AdjustedPlace::Packed { surface, front, places: &places, canvas: &canvas },
        beneath,
        exactness,
        pixels,
    );
}

#[cfg(test)]
mod tests;
