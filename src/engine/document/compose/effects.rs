//! Composes a layer with its effects. Floor 4. Not here: what an effect is (`paint::effect`), the
//! layer itself (`compose`).
//!
//! With shape and opacity apart: what a layer shows is composed as if it covered everything, its
//! inner effects on it, and then takes the place of the backdrop as far as the layer covers.

use super::{ComposeFlow, Composer};
use crate::document::Role;
use crate::document::layer::effects::{CoverTile, EffectTiles};
use crate::document::mask;
use crate::document::prepare::PreparedLayer;
use crate::paint::effect::{EffectFill, EffectPaint, EffectTile};
use crate::paint::{EffectKind, EffectPlace};
use crate::raster::tile::TILE_AREA;
use crate::raster::{Mix, PlanarTile, TILE, TileAt, TileCoverage, TilePaint};
use std::ops::ControlFlow;

impl Composer<'_> {
    /// A layer or group with effects, with what is clipped to it.
    pub(super) fn with_effects(
        &self,
        node: &PreparedLayer,
        effects: &EffectTiles,
        onto: &mut PlanarTile,
        coverage: &TileCoverage,
        atop: bool,
    ) -> ComposeFlow {
        let passes = matches!(node.layer.content.role(), Role::Groups(group) if group.pass_through)
            && !atop
            && node.clipped.is_empty()
            && node.warp.is_none();
        // What is sought in it lies on what is beneath it.
        if passes && self.is_sought_in(node) {
            self.stack(&node.children, onto)?;
        }
        let mut own = self.blank();
        if let Some(paint) = self.content(node)?.as_paint() {
            self.blend(&mut own, Mix::default(), paint, &coverage.mask_only());
        }
        let shape =
            TileCoverage::FULL.times_values(own.rows().iter().flat_map(|row| row.a).collect());
        let (mut full, mut inside) = (onto.clone(), onto.clone());
        for number in effects.at_place(EffectPlace::Beneath) {
            self.lay(node, effects, number, &mut full, atop);
            if !effects.effects[number].settings.knockout {
                self.lay(node, effects, number, &mut inside, atop);
            }
        }
        if !shape.is_none() || self.is_sought_in(node) {
            if passes {
                self.stack(&node.children, &mut inside)?;
            } else {
                self.compose_clipped(node, &mut own)?;
                own.make_opaque();
                let mix = self.own_mix(node, atop);
                self.fill(&mut inside, mix, &mut own, node.layer.fill_opacity);
            }
            for number in effects.at_place(EffectPlace::Within) {
                self.lay(node, effects, number, &mut inside, atop);
            }
            full.mix_toward(&inside, &shape);
        }
        let mut ground = None;
        for number in effects.at_place(EffectPlace::Over) {
            let is_line = effects.effects[number].kind == EffectKind::Stroke;
            match ground.as_ref().filter(|_| is_line) {
                Some(ground) => self.lay_upper_line(node, effects, number, ground, &mut full, atop),
                None => {
                    ground = is_line.then(|| full.clone()).or(ground);
                    self.lay(node, effects, number, &mut full, atop);
                }
            }
        }
        onto.mix_toward(&full, &coverage.opacity_only());
        ControlFlow::Continue(())
    }

    /// Blends what a layer shows, made opaque, with the opacity of its fill. In some modes that
    /// thins the color before it is blended with what is there, and covers by it where nothing is.
    fn fill(&self, onto: &mut PlanarTile, mix: Mix, own: &mut PlanarTile, opacity: f32) {
        let opaque = opacity.max(0.0).min(1.0);
        let Some(neutral) = mix.mode.neutral_fill().filter(|_| opaque < 1.0) else {
            let coverage = TileCoverage::uniform(opaque);
            return self.blend(onto, mix, TilePaint::Planar(own), &coverage);
        };
        let whole = own.clone();
        for row in own.rows_mut() {
            for channel in &mut row.rgb {
                for (v, a) in channel.iter_mut().zip(row.a) {
                    *v = a * neutral + opaque * (*v - a * neutral);
                }
            }
        }
        let clipped = Mix { atop: true, ..mix };
        self.blend(onto, clipped, TilePaint::Planar(own), &TileCoverage::FULL);
        if !mix.atop {
            lay_where_nothing_is(onto, &whole, opaque);
        }
    }

    /// Paints one effect of a layer on a tile.
    fn lay(
        &self,
        node: &PreparedLayer,
        effects: &EffectTiles,
        number: usize,
        onto: &mut PlanarTile,
        atop: bool,
    ) {
        let amounts = effects.amounts(number, self.at, &|at: TileAt| self.cover(node, at));
        if !amounts.is_nothing() {
            self.lay_amounts(node, effects, number, &amounts, onto, atop);
        }
    }

    /// Paints one effect as far as each pixel of a tile gets it.
    fn lay_amounts(
        &self,
        node: &PreparedLayer,
        effects: &EffectTiles,
        number: usize,
        amounts: &EffectTile,
        onto: &mut PlanarTile,
        atop: bool,
    ) {
        let cover = |at: TileAt| self.cover(node, at);
        let Some(effect) = effects.effects.get(number) else { return };
        let s = &effect.settings;
        let linear = node.layer.blend_linear;
        let mix = |mode| Mix { mode, linear, atop, ..Mix::default() }.on(self.at);
        if effect.kind == EffectKind::Bevel {
            let light = self.share(amounts, |v| v.max(0.0) * s.opacity);
            self.blend(onto, mix(s.blend), TilePaint::Solid(s.color.premultiplied()), &light);
            let shade = self.share(amounts, |v| (-v).max(0.0) * s.shade_opacity);
            return self.blend(onto, mix(s.shade_blend), TilePaint::Solid(effect.shade()), &shade);
        }
        let filled = match effect.fill() {
            EffectFill::Color => self.at.rect(),
            _ => effects.filled_rect(number, &cover),
        };
        let Some(paint) = effect.paint(self.at, filled, amounts) else { return };
        let runs_with_amounts = effect.fill() == EffectFill::Gradient
            && matches!(effect.kind, EffectKind::OuterGlow | EffectKind::InnerGlow);
        let share = |v: f32| if runs_with_amounts && v > 0.0 { s.opacity } else { v * s.opacity };
        let coverage = self.share(amounts, share);
        let paint = match (paint, &self.far) {
            (EffectPaint::Tile(tile), Some(far)) => EffectPaint::Tile(far.same_pixels(&tile)),
            (paint, _) => paint,
        };
        self.blend(onto, mix(s.blend), paint.as_paint(), &coverage);
    }

    /// Paints a line around a layer that replaces those beneath it.
    ///
    /// * `ground`: what the lowest line lies on, which this one is blended with.
    fn lay_upper_line(
        &self,
        node: &PreparedLayer,
        effects: &EffectTiles,
        number: usize,
        ground: &PlanarTile,
        onto: &mut PlanarTile,
        atop: bool,
    ) {
        let amounts = effects.amounts(number, self.at, &|at: TileAt| self.cover(node, at));
        if amounts.is_nothing() {
            return;
        }
        let mut lined = ground.clone();
        self.lay_amounts(node, effects, number, &EffectTile::Even(1.0), &mut lined, atop);
        onto.mix_toward(&lined, &self.share(&amounts, |v| v));
    }

    /// A function of the amounts, for the pixels that are composed.
    fn share(&self, amounts: &EffectTile, share: impl Fn(f32) -> f32) -> TileCoverage {
        if let EffectTile::Even(value) = amounts {
            return TileCoverage::uniform(share(*value));
        }
        let values = match &self.far {
            None => (0..TILE_AREA).map(|i| share(amounts.at(i))).collect(),
            Some(far) => {
                let corner = self.at.rect();
                far.values(|_, pixel| {
                    let (x, y) = ((pixel.x - corner.x0) as usize, (pixel.y - corner.y0) as usize);
                    share(amounts.at(y * TILE + x))
                })
            }
        };
        TileCoverage::FULL.times_values(values)
    }

    /// What a layer covers in a tile: its alpha, its mask, and the surface if it is clipped to it.
    fn cover(&self, node: &PreparedLayer, at: TileAt) -> CoverTile {
        let shown = node.warp.as_ref();
        let shown = shown.and_then(|warp| warp.displaced_tile(at, &|at| self.in_place(node, at)));
        let Some(tile) = shown.unwrap_or_else(|| self.in_place(node, at)) else {
            return CoverTile::Even(0.0);
        };
        let mut pixels = PlanarTile::transparent();
        let coverage = mask::coverage_around_canvas(node, at);
        pixels.blend(Mix::default(), TilePaint::of(&tile), &coverage);
        CoverTile::of(&pixels)
    }
}

/// Adds a share of a picture as far as what is there leaves room for it.
fn lay_where_nothing_is(onto: &mut PlanarTile, picture: &PlanarTile, share: f32) {
    for (row, picture) in onto.rows_mut().iter_mut().zip(picture.rows()) {
        for x in 0..TILE {
            let room = share * (1.0 - row.a[x]);
            for (v, own) in row.rgb.iter_mut().zip(&picture.rgb) {
                v[x] += room * own[x];
            }
            row.a[x] += room * picture.a[x];
        }
    }
}
