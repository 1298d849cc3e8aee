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
use crate::paint::effect::{EffectFill, EffectPaint, EffectTile, StrokePosition};
use crate::paint::{EffectKind, EffectPlace, LayerEffect};
use crate::raster::tile::TILE_AREA;
use crate::raster::{BlendMode, Mix, PlanarTile, TILE, TileAt, TileCoverage, TilePaint};
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
            self.layers_of(node, onto)?;
        }
        let mut own = self.blank();
        if let Some(paint) = self.content(node)?.as_paint() {
            self.blend(&mut own, Mix::default(), paint, &coverage.mask_only());
        }
        let alphas: Vec<f32> = own.rows().iter().flat_map(|row| row.a).collect();
        let (mut full, mut inside) = (onto.clone(), onto.clone());
        for number in effects.at_place(EffectPlace::Beneath) {
            self.lay(node, effects, number, &mut full, atop);
            if !effects.effects[number].settings.knockout {
                self.lay(node, effects, number, &mut inside, atop);
            }
        }
        let lines = self.lines(node, effects, &alphas);
        let kept = LineShares::leave(&lines, alphas);
        for line in lines.iter().filter(|line| line.is_seen()) {
            let mut lined = inside.clone();
            self.lay_amounts(node, effects, line.number, &EffectTile::Even(1.0), &mut lined, atop);
            full.mix_toward(&lined, &line.coverage(&kept));
        }
        let shape = TileCoverage::FULL.times_values(kept);
        if !shape.is_none() || self.is_sought_in(node) {
            if passes {
                self.layers_of(node, &mut inside)?;
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
        for number in effects.at_place(EffectPlace::Over) {
            self.lay(node, effects, number, &mut full, atop);
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
        let shares = vec![opaque; own.rows().len() * TILE];
        self.blend_thinned(onto, mix, own, neutral, &shares);
    }

    /// Blends a share of each pixel of a picture, whose color is thinned by it toward one that
    /// changes nothing; where nothing is beneath, it covers by its share.
    fn blend_thinned(
        &self,
        onto: &mut PlanarTile,
        mix: Mix,
        picture: &mut PlanarTile,
        neutral: f32,
        shares: &[f32],
    ) {
        let whole = picture.clone();
        for (row, shares) in picture.rows_mut().iter_mut().zip(shares.chunks(TILE)) {
            for (x, share) in shares.iter().enumerate() {
                let covered = share * row.a[x];
                let is_seen = covered > 0.0;
                for channel in &mut row.rgb {
                    let thinned = share * channel[x] + (1.0 - covered) * neutral;
                    channel[x] = if is_seen { thinned } else { 0.0 };
                }
                row.a[x] = if is_seen { 1.0 } else { 0.0 };
            }
        }
        let clipped = Mix { atop: true, ..mix };
        self.blend(onto, clipped, TilePaint::Planar(picture), &TileCoverage::FULL);
        if !mix.atop {
            lay_where_nothing_is(onto, &whole, shares);
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
            let light = |v: f32| v.max(0.0) * s.opacity;
            let color = TilePaint::Solid(s.color.premultiplied());
            self.lay_share(onto, mix(s.blend), color, amounts, light);
            let shade = |v: f32| (-v).max(0.0) * s.shade_opacity;
            let color = TilePaint::Solid(effect.shade());
            return self.lay_share(onto, mix(s.shade_blend), color, amounts, shade);
        }
        let filled = match effect.fill() {
            EffectFill::Color => self.at.rect(),
            _ => effect.ramp_rect(effects.filled_rect(number, &cover)),
        };
        let Some(paint) = effect.paint(self.at, filled, amounts) else { return };
        let runs_with_amounts = effect.fill() == EffectFill::Gradient
            && matches!(effect.kind, EffectKind::OuterGlow | EffectKind::InnerGlow);
        let share = |v: f32| if runs_with_amounts && v > 0.0 { s.opacity } else { v * s.opacity };
        let paint = match (paint, &self.far) {
            (EffectPaint::Tile(tile), Some(far)) => EffectPaint::Tile(far.same_pixels(&tile)),
            (paint, _) => paint,
        };
        self.lay_share(onto, mix(s.blend), paint.as_paint(), amounts, share);
    }

    /// Paints a share of the amounts of an effect. Where a mode has a color that changes nothing, the
    /// share thins the paint toward that, as with fills: all of it may then be more than white.
    fn lay_share(
        &self,
        onto: &mut PlanarTile,
        mix: Mix,
        paint: TilePaint,
        amounts: &EffectTile,
        share: impl Fn(f32) -> f32,
    ) {
        // A threshold has no such color.
        let neutral = mix.mode.neutral_fill().filter(|_| mix.mode != BlendMode::HardMix);
        let Some(neutral) = neutral else {
            return self.blend(onto, mix, paint, &self.share(amounts, share));
        };
        let mut picture = self.blank();
        picture.blend(Mix::default(), paint, &TileCoverage::FULL);
        let shares = self.values(amounts, share);
        self.blend_thinned(onto, mix, &mut picture, neutral, &shares);
    }

    /// The lines of a layer, the lowest first.
    ///
    /// * `alphas`: what the layer covers of the pixels that are composed.
    fn lines(
        &self,
        node: &PreparedLayer,
        effects: &EffectTiles,
        alphas: &[f32],
    ) -> Vec<LineShares> {
        let mut lines: Vec<LineShares> = Vec::new();
        for number in effects.at_place(EffectPlace::Line) {
            let amounts = effects.amounts(number, self.at, &|at: TileAt| self.cover(node, at));
            let effect = &effects.effects[number];
            let half = LineShares::of(number, effect, self.values(&amounts, |v| v), alphas);
            let first = lines.last_mut();
            match first.filter(|line| effects.effects[line.number].is_other_half(effect)) {
                Some(line) => line.add(&half),
                None => lines.push(half),
            }
        }
        lines
    }

    /// A function of the amounts, for the pixels that are composed.
    fn share(&self, amounts: &EffectTile, share: impl Fn(f32) -> f32) -> TileCoverage {
        match amounts {
            EffectTile::Even(value) => TileCoverage::uniform(share(*value)),
            _ => TileCoverage::FULL.times_values(self.values(amounts, share)),
        }
    }

    fn values(&self, amounts: &EffectTile, value: impl Fn(f32) -> f32) -> Vec<f32> {
        match &self.far {
            None => (0..TILE_AREA).map(|i| value(amounts.at(i))).collect(),
            Some(far) => {
                let corner = self.at.rect();
                far.values(|_, pixel| {
                    let (x, y) = ((pixel.x - corner.x0) as usize, (pixel.y - corner.y0) as usize);
                    value(amounts.at(y * TILE + x))
                })
            }
        }
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

/// How much a line takes of pixels, and how much it leaves of what the layer covers there. The line
/// lies on what is beneath the layer: what it takes of the layer is not seen.
struct LineShares {
    /// Of its effect, or of that of one half.
    number: usize,
    taken: Vec<f32>,
    left: Vec<f32>,
}

impl LineShares {
    fn of(number: usize, effect: &LayerEffect, amounts: Vec<f32>, alphas: &[f32]) -> Self {
        let is_within = effect.settings.position == StrokePosition::Inside;
        let taken = |(v, a): (&f32, &f32)| v * if is_within { *a } else { 1.0 - a };
        let left = |v: &f32| if is_within { 1.0 - v } else { 1.0 };
        let taken = amounts.iter().zip(alphas).map(taken).collect();
        Self { number, taken, left: amounts.iter().map(left).collect() }
    }

    fn add(&mut self, half: &Self) {
        self.taken.iter_mut().zip(&half.taken).for_each(|(all, v)| *all += v);
        self.left.iter_mut().zip(&half.left).for_each(|(all, v)| *all *= v);
    }

    fn is_seen(&self) -> bool {
        self.taken.iter().any(|v| *v > 0.0)
    }

    /// What lines leave of what a layer covers.
    fn leave(lines: &[Self], mut alphas: Vec<f32>) -> Vec<f32> {
        for line in lines {
            alphas.iter_mut().zip(&line.left).for_each(|(a, left)| *a *= left);
        }
        alphas
    }

    /// What it takes of that which a layer leaves.
    ///
    /// * `kept`: what is seen of the layer.
    fn coverage(&self, kept: &[f32]) -> TileCoverage {
        let share = |(v, kept): (&f32, &f32)| if *v > 0.0 { v / (1.0 - kept) } else { 0.0 };
        TileCoverage::FULL.times_values(self.taken.iter().zip(kept).map(share).collect())
    }
}

/// Adds a share of each pixel of a picture as far as what is there leaves room for it.
fn lay_where_nothing_is(onto: &mut PlanarTile, picture: &PlanarTile, shares: &[f32]) {
    let rows = onto.rows_mut().iter_mut().zip(picture.rows()).zip(shares.chunks(TILE));
    for ((row, picture), shares) in rows {
        for (x, share) in shares.iter().enumerate() {
            let room = share * (1.0 - row.a[x]);
            for (v, own) in row.rgb.iter_mut().zip(&picture.rgb) {
                v[x] += room * own[x];
            }
            row.a[x] += room * picture.a[x];
        }
    }
}
