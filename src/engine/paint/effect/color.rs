//! Which color an effect has in each pixel: one, a ramp, or a repeated picture. Floor 3. Not here:
//! how much of it a pixel gets (`matte`).

use super::{EffectFill, EffectKind, EffectTile, LayerEffect};
use crate::math::srgb::Color;
use crate::math::{Rect, Size, Vec2, vec2};
use crate::paint::RampStyle;
use crate::paint::ramp::Ramp;
use crate::raster::tile::transparent_f32;
use crate::raster::{PlanarTile, TILE, TileAt, TilePaint};

/// As far as a coordinate may be from a whole one by rounding.
const ROUNDING: f32 = 1e-3;

/// A picture that an effect repeats.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectPattern {
    name: String,
    size: Size,
    /// Straight sRGB, row by row.
    rgba: Vec<u8>,
}

impl EffectPattern {
    /// The longest side, px.
    pub const LONGEST_PX: u32 = 1024;

    /// `None` unless there are four bytes for each pixel of a size that documents hold.
    pub fn new(name: impl Into<String>, size: Size, rgba: Vec<u8>) -> Option<Self> {
        let fits = (1..=Self::LONGEST_PX).contains(&size.width)
            && (1..=Self::LONGEST_PX).contains(&size.height);
        (fits && rgba.len() == size.area() * 4).then(|| Self { name: name.into(), size, rgba })
    }

    /// What it is called.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// `(size, straight sRGB)`.
    pub fn picture(&self) -> (Size, &[u8]) {
        (self.size, &self.rgba)
    }

    /// The premultiplied color of one of its pixels, repeated beyond its border.
    fn pixel(&self, x: i64, y: i64) -> [f32; 4] {
        let (w, h) = (i64::from(self.size.width), i64::from(self.size.height));
        let at = (y.rem_euclid(h) * w + x.rem_euclid(w)) as usize * 4;
        let &[r, g, b, a] = self.rgba[at..].first_chunk().unwrap_or(&[0; 4]);
        Color { r, g, b, a }.premultiplied()
    }

    /// The premultiplied color at a point of the canvas. Enlarged, its first pixel has its color
    /// where it begins, as measured in Photoshop's pictures, and the next one `scale` px further.
    fn color_at(&self, at: Vec2, scale: f32) -> [f32; 4] {
        let scale = scale.max(1e-3);
        if scale == 1.0 {
            return self.pixel(at.x.floor() as i64, at.y.floor() as i64);
        }
        let p = if scale > 1.0 { (at - 0.5) / scale } else { at / scale - 0.5 };
        let (corner, share) = (p.floor(), p - p.floor());
        let (x, y) = (corner.x as i64, corner.y as i64);
        let mix =
            |a: [f32; 4], b: [f32; 4], t: f32| std::array::from_fn(|i| a[i] + (b[i] - a[i]) * t);
        let along = |y| mix(self.pixel(x, y), self.pixel(x + 1, y), share.x);
        mix(along(y), along(y + 1), share.y)
    }
}

impl RampStyle {
    /// The middle of a ramp, and from there to its end, on a rectangle that it fills.
    ///
    /// * `degrees`: counter-clockwise, as seen.
    /// * `scale`: relative to the length that just fills.
    /// * `offset`: of the middle, in shares of the rectangle.
    pub fn line(rect: Rect, degrees: f32, scale: f32, offset: Vec2) -> (Vec2, Vec2) {
        let (w, h) = (rect.width() as f32, rect.height() as f32);
        let middle = vec2(rect.x0 as f32 + w / 2.0, rect.y0 as f32 + h / 2.0) + offset * vec2(w, h);
        let (sin, cos) = degrees.to_radians().sin_cos();
        // The line ends where it meets the rectangle's border.
        let reach = (w / 2.0 / cos.abs().max(1e-6)).min(h / 2.0 / sin.abs().max(1e-6));
        (middle, vec2(cos, -sin) * reach * scale)
    }

    /// Where such a ramp begins and ends as Photoshop lays it: on whole pixels, of a scaled straight
    /// ramp half of it from a whole middle. There a pixel has the color of its corner, here that of
    /// its center, so that both lie half a pixel further.
    pub fn ends(self, rect: Rect, degrees: f32, scale: f32, offset: Vec2) -> (Vec2, Vec2) {
        let (middle, half) = Self::line(rect, degrees, scale, offset);
        let from = if self == RampStyle::Linear { middle - half } else { middle };
        let exact = (from, middle + half);
        // What is whole but for rounding stays.
        let whole = |p: Vec2| (p + Vec2::splat(ROUNDING)).floor();
        let (from, to) = match self {
            RampStyle::Linear if scale != 1.0 => {
                let half = (half + half.signum() * ROUNDING).trunc();
                (whole(middle) - half, whole(middle) + half)
            }
            _ => (whole(exact.0), whole(exact.1)),
        };
        let (from, to) = if from == to { exact } else { (from, to) };
        (from + Vec2::splat(0.5), to + Vec2::splat(0.5))
    }

    /// The middle of a ramp with these ends, and from there to its end.
    pub fn middle_and_half(self, (from, to): (Vec2, Vec2)) -> (Vec2, Vec2) {
        let middle = if self == RampStyle::Linear { (from + to) / 2.0 } else { from };
        (middle, to - middle)
    }

    /// Position of a point on the ramp; `line`: the middle, and from there to the end.
    pub fn place(self, (middle, half): (Vec2, Vec2), at: Vec2) -> f32 {
        let reach = half.length().max(1e-6);
        let along = half / reach;
        let from = at - middle;
        let p = vec2(from.dot(along) / reach, from.dot(vec2(-along.y, along.x)) / reach);
        match self {
            // Straight ramps begin at the other end of the line.
            RampStyle::Linear => (p.x + 1.0) / 2.0,
            around => around.position(p),
        }
    }
}

/// The color of an effect in a tile.
pub enum EffectPaint {
    /// One, premultiplied.
    Solid([f32; 4]),
    /// One for each pixel.
    Tile(PlanarTile),
}

impl EffectPaint {
    /// As a source of blending.
    pub fn as_paint(&self) -> TilePaint<'_> {
        match self {
            Self::Solid(color) => TilePaint::Solid(*color),
            Self::Tile(tile) => TilePaint::Planar(tile),
        }
    }
}

impl LayerEffect {
    /// Its color in a tile; `None` if it is filled with a picture that it lacks.
    ///
    /// * `filled`: what a ramp or a picture lies on.
    /// * `amounts`: of a glow, whose ramp runs with them.
    pub fn paint(&self, at: TileAt, filled: Rect, amounts: &EffectTile) -> Option<EffectPaint> {
        let s = &self.settings;
        match self.fill() {
            EffectFill::Color => Some(EffectPaint::Solid(s.color.premultiplied())),
            EffectFill::Gradient => {
                let ramp = Ramp::new(&self.stops)?;
                if matches!(self.kind, EffectKind::OuterGlow | EffectKind::InnerGlow) {
                    return Some(paint_tile(at, |i, _| ramp.at(1.0 - amounts.at(i))));
                }
                let offset = vec2(s.offset_x, s.offset_y);
                let line = s.ramp.middle_and_half(s.ramp.ends(filled, s.angle, s.scale, offset));
                let way = |t: f32| if s.reverse { 1.0 - t } else { t };
                Some(paint_tile(at, |_, p| ramp.at(way(s.ramp.place(line, p).max(0.0).min(1.0)))))
            }
            EffectFill::Pattern => {
                let pattern = self.pattern.as_ref()?;
                let corner = vec2(filled.x0 as f32, filled.y0 as f32);
                let corner = if s.aligned { corner } else { Vec2::ZERO };
                let begin = corner + vec2(s.phase_x, s.phase_y);
                Some(paint_tile(at, |_, p| pattern.color_at(p - begin, s.scale)))
            }
        }
    }

    /// The color of its shade, premultiplied.
    pub fn shade(&self) -> [f32; 4] {
        self.settings.shade_color.premultiplied()
    }
}

fn paint_tile(at: TileAt, color: impl Fn(usize, Vec2) -> [f32; 4]) -> EffectPaint {
    let rect = at.rect();
    let mut pixels = transparent_f32();
    for (i, pixel) in pixels.iter_mut().enumerate() {
        let (x, y) = (rect.x0 + (i % TILE) as i32, rect.y0 + (i / TILE) as i32);
        *pixel = color(i, vec2(x as f32 + 0.5, y as f32 + 0.5));
    }
    EffectPaint::Tile(PlanarTile::from_pixels(&pixels))
}
