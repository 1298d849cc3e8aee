//! Grain: a texture that reduces a stroke's paint in the valleys of the canvas or of the surface.
//! Floor 3. The patterns are in `pattern`; the operators D_p and D_s place the grain on a surface.
//!
//! ```text
//! F′(q) = F(q) · (1 − k (1 − G(P⁻¹(T(q)))))      T(q) = q            grain on the canvas
//!                                               T(q) = D_p(q; q_s)  grain that follows the depth
//!                                               T(q) = D_s(q; q_s)  grain that lies on the surface
//! ```
//!
//! k is the strength, P scales and turns the texture, and q_s is where the stroke began: T(q_s) =
//! q_s, so that the grain there has its size on the canvas; it is larger on nearer parts and
//! smaller on farther ones. G repeats without end.

mod tile;

pub use tile::{GrainTile, StrokeGrain};

use super::image::PictureSource;
use super::pattern::Pattern;
use super::tip::texture::gray;
use crate::math::Range;
use crate::memory::compute_once;
use crate::raster::{Plane, Texture};
use std::sync::{Arc, Mutex};

/// A brush's grain.
#[derive(Clone, PartialEq)]
pub struct BrushGrain {
    /// What the texture is.
    pub source: GrainSource,
    /// Size of one feature of a pattern, or of a picture's longer side; canvas px, `> 0`.
    pub size_px: f32,
    /// Counter-clockwise as seen, degrees.
    pub rotation: f32,
    /// k, `[0, 1]`: 0 is no grain.
    pub strength: f32,
    /// Grays up to the first take no paint, those from the second on take all; both in `[0, 1]`,
    /// the first below the second.
    pub levels: [f32; 2],
    /// What it is fixed to.
    pub lies: GrainSpace,
}

/// What the grain is.
#[derive(Clone, PartialEq)]
pub enum GrainSource {
    /// A formula, repeated.
    Pattern {
        /// Which one.
        pattern: Pattern,
        /// For what is random in it.
        seed: u32,
    },
    /// Its luminance times its alpha.
    Picture(PictureSource),
}

/// What the grain lies on.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum GrainSpace {
    /// The flat canvas.
    #[default]
    Canvas,
    /// The surface, through D_p.
    Surface {
        /// How strongly it follows the depth.
        gamma: f32,
    },
    /// The surface, through D_s: equally large everywhere.
    Unwrapped,
}

impl GrainSpace {
    /// Every kind with its name in documents and default numbers; `named!` is for choices without
    /// numbers.
    pub const ALL: [(GrainSpace, &'static str); 3] = [
        (GrainSpace::Canvas, "canvas"),
        (GrainSpace::Surface { gamma: 1.0 }, "surface"),
        (GrainSpace::Unwrapped, "unwrapped"),
    ];
    /// The same kind with its default numbers.
    pub fn plain(self) -> Self {
        let is_same = |(kind, _): &&(Self, &str)| {
            std::mem::discriminant(kind) == std::mem::discriminant(&self)
        };
        Self::ALL.iter().find(is_same).map_or(self, |(kind, _)| *kind)
    }
}

impl BrushGrain {
    /// What the size of a feature may be, px.
    pub const SIZE_PX: Range = 0.5..=20_000.0;
    /// The range of a level.
    pub const LEVEL: Range = -4.0..=4.0;
    /// The range of the rate of its own operator.
    pub const GAMMA: Range = 0.0..=8.0;
}

impl Default for BrushGrain {
    fn default() -> Self {
        Self {
            source: GrainSource::Pattern { pattern: Pattern::default(), seed: 0 },
            size_px: 6.0,
            rotation: 0.0,
            strength: 1.0,
            levels: [0.0, 1.0],
            lies: GrainSpace::default(),
        }
    }
}

/// Cached textures: more than a painting uses.
const KEPT: usize = 16;
static MADE: Mutex<Vec<(PatternKey, Arc<Texture>)>> = Mutex::new(Vec::new());

/// The pattern, its seed, its levels, its side.
type PatternKey = (Pattern, u32, [u32; 2], u32);

impl BrushGrain {
    /// G with its levels applied: red holds it, green its square, alpha whether it is not black.
    fn texture(&self) -> Arc<Texture> {
        let levels = self.levels.map(f32::to_bits);
        match &self.source {
            GrainSource::Pattern { pattern, seed } => {
                let side = Pattern::side_of(self.size_px);
                let make = || of_grays(&pattern.plane(*seed, side), self.levels);
                compute_once(&MADE, KEPT, (*pattern, *seed, levels, side), make)
            }
            GrainSource::Picture(source) => {
                let make = || of_grays(&luminance(&source.texture()), self.levels);
                compute_once(source.stamps().grains(), KEPT, levels, make)
            }
        }
    }
}

/// Gray bytes below this count as black: a stroke's dabs do not fill them.
const BLACK: u8 = 10;

fn square(v: u8) -> u8 {
    ((u32::from(v) * u32::from(v) + 127) / 255) as u8
}

fn of_grays(plane: &Plane<f32>, [low, high]: [f32; 2]) -> Texture {
    let span = (high - low).max(1.0 / 256.0);
    let mut picture = gray(&plane.map(|v| (v - low) / span));
    // The channels: red is the gray, green its square, alpha whether there is any.
    if let crate::raster::picture::Texels::Srgb8(texels) = &picture.texels {
        let grays: Vec<[u8; 4]> = texels
            .iter()
            .map(|&[v, ..]| [v, square(v), 0, if v < BLACK { 0 } else { 255 }])
            .collect();
        picture.texels = crate::raster::picture::Texels::Srgb8(grays.into());
    }
    Texture::new(&picture)
}

/// From premultiplied texels: a light but transparent texel counts as dark.
fn luminance(texture: &Texture) -> Plane<f32> {
    let level = &texture.levels()[0];
    let gray = |&[r, g, b, _]: &[u8; 4]| {
        (0.2126 * f32::from(r) + 0.7152 * f32::from(g) + 0.0722 * f32::from(b)) / 255.0
    };
    let values = level.texels.iter().map(gray).collect();
    Plane::from_values(level.size, values).unwrap_or_else(|| Plane::full(level.size, 1.0))
}

#[cfg(test)]
mod tests;
