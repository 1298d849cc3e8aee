//! How much of an effect each pixel of a tile gets, from what the layer covers around it. Floor 3.
//!
//! Measured on Photoshop's own pictures: shadows and glows are two means over their size
//! ([`Matte::blurred`]), a glow reaches its full strength at its range, satin is the difference of
//! two moved blurs, and a bevel lights the blurred coverage as a height.

use super::{BevelStyle, BevelTechnique, EffectKind, EffectLight, GlowSource, GlowTechnique};
use super::{LayerEffect, StrokePosition};
use crate::math::{Rect, Vec2, Vec3, hash, vec2};
use crate::raster::tile::TILE_AREA;
use crate::raster::{Matte, TILE, TileAt};
use crate::surface::Surface;

/// The amount of an effect in each pixel of a tile: `[0, 1]`, of a bevel `[−1, 1]`, where shade is
/// negative.
#[derive(Clone, Debug, PartialEq)]
pub enum EffectTile {
    /// The same everywhere.
    Even(f32),
    /// Row by row, of 32767.
    Values(Box<[i16]>),
}

/// What an amount of 1 is stored as.
const ONE: f32 = 32767.0;
/// Pixels of Photoshop's specks are the same in every document.
const NOISE_SEED: u32 = 0x5eed;

impl EffectTile {
    /// Nothing of it.
    pub const NOTHING: Self = Self::Even(0.0);

    /// Bytes that it holds besides itself.
    pub fn held_bytes(&self) -> u64 {
        match self {
            Self::Even(_) => 0,
            Self::Values(values) => size_of_val::<[i16]>(values) as u64,
        }
    }

    /// Whether no pixel gets any of it.
    pub fn is_nothing(&self) -> bool {
        *self == Self::NOTHING
    }

    /// The amount of a pixel of the tile, row by row.
    pub fn at(&self, i: usize) -> f32 {
        match self {
            Self::Even(value) => *value,
            Self::Values(values) => values.get(i).map_or(0.0, |v| f32::from(*v) / ONE),
        }
    }

    fn of(values: impl Iterator<Item = f32>) -> Self {
        let stored = |v: f32| (v.max(-1.0).min(1.0) * ONE).round() as i16;
        let values: Box<[i16]> = values.map(stored).collect();
        match values.first() {
            Some(first) if values.iter().all(|v| v == first) => Self::Even(f32::from(*first) / ONE),
            _ => Self::Values(values),
        }
    }
}

impl LayerEffect {
    /// How far beyond what a layer covers, and how far from a pixel, it looks, px.
    pub fn reach_px(&self, light: EffectLight, depth_px: f32) -> i32 {
        let s = &self.settings;
        let far = match self.kind {
            EffectKind::DropShadow | EffectKind::InnerShadow => {
                s.size + self.shadow_distance(light, depth_px)
            }
            EffectKind::OuterGlow | EffectKind::InnerGlow => s.size,
            EffectKind::Satin => s.size + s.distance,
            EffectKind::Stroke => s.size + 1.0,
            EffectKind::Bevel => s.size + s.soften + 1.0,
            _ => return 0,
        };
        far.ceil() as i32 + 2
    }

    /// The longest way of its shadow.
    fn shadow_distance(&self, light: EffectLight, depth_px: f32) -> f32 {
        let fall =
            if self.is_on_surface() { depth_px * fall_per_px(self.light(light)) } else { 0.0 };
        self.settings.distance + fall.min(MOST_FALL_PX)
    }

    fn is_on_surface(&self) -> bool {
        self.kind == EffectKind::DropShadow && self.settings.on_surface
    }

    /// The amounts in a tile.
    ///
    /// * `cover`: what the layer covers in a rectangle.
    /// * `surface`: what shadows may fall on.
    pub fn tile(
        &self,
        at: TileAt,
        light: EffectLight,
        surface: Option<&Surface>,
        cover: &dyn Fn(Rect) -> Matte,
    ) -> EffectTile {
        let rect = at.rect();
        let amounts = match self.kind {
            EffectKind::DropShadow => {
                self.shadow(rect, light, surface.filter(|_| self.is_on_surface()), cover)
            }
            EffectKind::InnerShadow => self.shadow(rect, light, None, &|r| cover(r).complement()),
            EffectKind::OuterGlow => self.glow(rect, cover),
            EffectKind::InnerGlow => self.glow(rect, &|r| cover(r).complement()),
            EffectKind::Satin => self.satin(rect, cover),
            EffectKind::Stroke => self.line(rect, cover),
            EffectKind::Bevel => self.bevel(rect, light, cover),
            _ => return EffectTile::Even(1.0),
        };
        match amounts {
            Amounts::Even(value) if value == 0.0 || self.settings.noise <= 0.0 => {
                EffectTile::Even(value)
            }
            Amounts::Even(value) => self.with_noise(rect, (0..TILE_AREA).map(|_| value)),
            Amounts::Values(values) => self.with_noise(rect, values.into_iter()),
        }
    }

    fn with_noise(&self, rect: Rect, values: impl Iterator<Item = f32>) -> EffectTile {
        let noise = self.settings.noise;
        if noise <= 0.0 {
            return EffectTile::of(values);
        }
        EffectTile::of(values.enumerate().map(|(i, v)| {
            let (x, y) = (rect.x0 + (i % TILE) as i32, rect.y0 + (i / TILE) as i32);
            v * (1.0 - noise * hash::unit(NOISE_SEED, x as u32, y as u32))
        }))
    }

    /// The amount for each tone of a blur.
    fn tone_curve(&self) -> impl Fn(f32) -> f32 {
        let spline = (!self.contour.is_straight()).then(|| self.contour.spline());
        let invert = self.kind == EffectKind::Satin && self.settings.invert;
        move |v: f32| {
            let v = v.max(0.0).min(1.0);
            let v = spline.as_ref().map_or(v, |spline| spline.at(v).max(0.0).min(1.0));
            if invert { 1.0 - v } else { v }
        }
    }

    /// What is covered, solid for a share of the size and blurred for the rest.
    fn soften(&self, matte: Matte) -> Matte {
        // Whole pixels, as in Photoshop's pictures: 64 % of 65 px are 42.
        let solid = (self.settings.size * self.settings.spread).round();
        matte.dilated(solid).blurred(self.settings.size - solid)
    }

    fn shadow(
        &self,
        rect: Rect,
        light: EffectLight,
        surface: Option<&Surface>,
        cover: &dyn Fn(Rect) -> Matte,
    ) -> Amounts {
        let own = self.light(light);
        let (sin, cos) = own.angle.to_radians().sin_cos();
        let away = vec2(-cos, sin);
        // To whole pixels, as in Photoshop's pictures.
        let first = (away * self.settings.distance).round();
        // Where the surface is deepest, a shadow falls farthest.
        let depth_px = surface.map_or(0.0, Surface::depth_range_px);
        let last = first + away * (self.shadow_distance(light, depth_px) - self.settings.distance);
        let moved = |by: Vec2| rect.moved(-by.x.round() as i32, -by.y.round() as i32);
        let window = moved(first).union(moved(last)).grown(self.settings.size.ceil() as i32 + 2);
        let (matte, tone) = (cover(window), self.tone_curve());
        if let Some(even) = even(&matte) {
            return Amounts::Even(tone(even));
        }
        let soft = self.soften(matte);
        let per_px = fall_per_px(own);
        let value = |x: i32, y: i32| {
            let fall = surface.map_or(0.0, |surface| depth_at(surface, x, y) * depth_px * per_px);
            let by = first + away * fall.min(MOST_FALL_PX);
            tone(soft.interpolate(x as f32 - by.x, y as f32 - by.y))
        };
        Amounts::of(rect, value)
    }

    fn glow(&self, rect: Rect, cover: &dyn Fn(Rect) -> Matte) -> Amounts {
        let s = &self.settings;
        let matte = cover(rect.grown(s.size.ceil() as i32 + 2));
        let is_from_center = self.kind == EffectKind::InnerGlow && s.source == GlowSource::Center;
        let tone = self.tone_curve();
        let tone = |v: f32| tone(if is_from_center { 1.0 - v.min(1.0) } else { v });
        if let Some(even) = even(&matte) {
            return Amounts::Even(tone(even));
        }
        let gain = 1.0 / s.range.max(0.01);
        if s.glow == GlowTechnique::Softer {
            let soft = self.soften(matte);
            return Amounts::of(rect, |x, y| tone(soft.at(x, y) * gain));
        }
        let near = matte.fading(s.size);
        Amounts::of(rect, |x, y| tone(near.at(x, y) / (1.0 - s.spread).max(0.01) * 0.5 * gain))
    }

    fn satin(&self, rect: Rect, cover: &dyn Fn(Rect) -> Matte) -> Amounts {
        let s = &self.settings;
        let (sin, cos) = s.angle.to_radians().sin_cos();
        let by = vec2(cos, -sin) * s.distance;
        let (matte, tone) =
            (cover(rect.grown((s.size + s.distance).ceil() as i32 + 2)), self.tone_curve());
        if even(&matte).is_some() {
            return Amounts::Even(tone(0.0));
        }
        let soft = matte.blurred(s.size);
        Amounts::of(rect, |x, y| {
            let (x, y) = (x as f32, y as f32);
            tone(
                (soft.interpolate(x + by.x, y + by.y) - soft.interpolate(x - by.x, y - by.y)).abs(),
            )
        })
    }

    fn line(&self, rect: Rect, cover: &dyn Fn(Rect) -> Matte) -> Amounts {
        let s = &self.settings;
        let matte = cover(rect.grown(s.size.ceil() as i32 + 2));
        // Both are shown as far as the layer lets them: that outside lies beneath it, that within
        // on it.
        let is_within = s.position == StrokePosition::Inside;
        if let Some(even) = even(&matte).filter(|v| *v == 0.0 || *v == 1.0) {
            return Amounts::Even(if is_within { 0.0 } else { even });
        }
        let line = if is_within { matte.complement() } else { matte }.dilated(s.size);
        Amounts::of(rect, |x, y| line.at(x, y))
    }

    /// Light and shade of the blurred coverage as a height: how much more or less light than a flat
    /// place it gets, of what it can get.
    fn bevel(&self, rect: Rect, light: EffectLight, cover: &dyn Fn(Rect) -> Matte) -> Amounts {
        let s = &self.settings;
        let around = (s.size + s.soften).ceil() as i32 + 3;
        let matte = cover(rect.grown(around));
        if even(&matte).is_some() {
            return Amounts::Even(0.0);
        }
        let half = matches!(s.bevel, BevelStyle::Emboss | BevelStyle::Pillow);
        // Half of 41 px is 21, as in a picture of Photoshop.
        let size = if half { (s.size / 2.0).ceil() } else { s.size }.max(1.0);
        let height = match s.technique {
            BevelTechnique::Smooth => matte.clone().blurred(size),
            BevelTechnique::Chisel => chisel(&matte, size, s.bevel),
        };
        let lit = |sunken: bool| {
            self.light_height(&height, size, self.light(light), sunken).blurred(s.soften)
        };
        // Around the layer a pillow falls toward it.
        let around = (s.bevel == BevelStyle::Pillow).then(|| lit(!s.sunken));
        let lit = lit(s.sunken);
        let tone = |x: i32, y: i32| match (s.bevel, &around) {
            (BevelStyle::Outer, _) => lit.at(x, y) * (1.0 - matte.at(x, y)),
            (_, Some(around)) => {
                let outside = around.at(x, y);
                outside + (lit.at(x, y) - outside) * matte.at(x, y)
            }
            _ => lit.at(x, y),
        };
        Amounts::of(rect, tone)
    }

    fn light_height(
        &self,
        height: &Matte,
        size: f32,
        light: EffectLight,
        is_sunken: bool,
    ) -> Matte {
        let (sin, cos) = light.angle.to_radians().sin_cos();
        let (up, flat) = light.altitude.to_radians().sin_cos();
        let toward = Vec3::new(flat * cos, -flat * sin, up);
        let slope = self.settings.depth * size * if is_sunken { -0.5 } else { 0.5 };
        let gloss = (!self.contour.is_straight()).then(|| self.contour.spline());
        let shine = |v: f32| gloss.as_ref().map_or(v, |curve| curve.at(v.max(0.0).min(1.0)));
        let level = shine(up);
        let rect = height.rect();
        let mut out = Matte::full(rect, 0.0);
        for y in rect.y0 + 1..rect.y1 - 1 {
            let row = out.row_mut(y).iter_mut().zip(rect.x0..).skip(1);
            for (v, x) in row.take(rect.width().saturating_sub(2)) {
                let dx = (height.at(x + 1, y) - height.at(x - 1, y)) * slope;
                let dy = (height.at(x, y + 1) - height.at(x, y - 1)) * slope;
                let normal = Vec3::new(-dx, -dy, 1.0) / (dx * dx + dy * dy + 1.0).sqrt();
                let more = shine(normal.dot(toward)) - level;
                let most = if more > 0.0 { 1.0 - level } else { level };
                *v = (more / most.max(1e-3)).max(-1.0).min(1.0);
            }
        }
        out
    }
}

/// The amounts of a rectangle before specks.
enum Amounts {
    Even(f32),
    Values(Vec<f32>),
}

impl Amounts {
    fn of(rect: Rect, value: impl Fn(i32, i32) -> f32) -> Self {
        let mut values = Vec::with_capacity(rect.width() * rect.height());
        for y in rect.y0..rect.y1 {
            values.extend((rect.x0..rect.x1).map(|x| value(x, y)));
        }
        Self::Values(values)
    }
}

/// A shadow on a surface falls no farther than this, px.
const MOST_FALL_PX: f32 = 500.0;

/// How far a shadow moves for each pixel of depth: the cotangent of the light's height.
fn fall_per_px(light: EffectLight) -> f32 {
    1.0 / light.altitude.to_radians().tan().max(0.05)
}

/// How deep a pixel lies, from 0 at the front to 1; what is not on the surface lies at the back.
fn depth_at(surface: &Surface, x: i32, y: i32) -> f32 {
    if !surface.size().rect().contains(x, y) {
        return 1.0;
    }
    let (x, y) = (x as usize, y as usize);
    if surface.coverage_plane().get(x as i32, y as i32) == Some(0) {
        return 1.0;
    }
    surface.depth(x, y).max(0.0).min(1.0)
}

/// A height that rises straight over a length from the edge.
fn chisel(matte: &Matte, size: f32, style: BevelStyle) -> Matte {
    let outer = || matte.clone().fading(size);
    let inner = || matte.clone().complement().fading(size).complement();
    match style {
        BevelStyle::Outer => outer(),
        BevelStyle::Inner => inner(),
        BevelStyle::Emboss | BevelStyle::Pillow => {
            let (mut both, inner) = (outer(), inner());
            let rect = both.rect();
            for y in rect.y0..rect.y1 {
                let row = both.row_mut(y).iter_mut().zip(rect.x0..);
                row.for_each(|(v, x)| *v = 0.5 * (*v + inner.at(x, y)));
            }
            both
        }
    }
}

/// The one value of a matte that is the same everywhere.
fn even(matte: &Matte) -> Option<f32> {
    let first = *matte.values().first()?;
    matte.values().iter().all(|v| *v == first).then_some(first)
}
