//! Textured tips: bristles and specks, made once as a picture that a round tip shines through.
//! Floor 3. The round tip keeps the meaning of hardness and softness; the picture blurs with the
//! softness too.

use crate::math::Size;
use crate::paint::Adjust;
use crate::paint::image::PictureSource;
use crate::paint::pattern;
use crate::raster::{Picture, Plane};
use std::sync::{Mutex, PoisonError};

/// What a textured tip is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TipTexture {
    /// The ends of hairs.
    Bristles(Bristles),
    /// Specks.
    Noise(Noise),
}

/// The ends of a brush's hairs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bristles {
    /// Number of hairs, `[1, 1000]`.
    pub count: u32,
    /// Where they stand.
    pub seed: u32,
}

/// Specks, as of a sponge or a dry brush.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Specks along the diameter, `[1, 200]`.
    pub cells: u32,
    /// Share of the tip that they cover, `[0, 1]`.
    pub density: f32,
    /// Where they lie.
    pub seed: u32,
}

impl Bristles {
    /// How many there may be.
    pub const COUNT: std::ops::RangeInclusive<u32> = 1..=1000;
}

impl Noise {
    /// How many may lie along the diameter.
    pub const CELLS: std::ops::RangeInclusive<u32> = 1..=200;
}

impl Default for Bristles {
    fn default() -> Self {
        Self { count: 60, seed: 0 }
    }
}

impl Default for Noise {
    fn default() -> Self {
        Self { cells: 12, density: 0.5, seed: 0 }
    }
}

/// Cached pictures: more than a painting uses.
const KEPT: usize = 32;
static MADE: Mutex<Vec<((TipTexture, u32), PictureSource)>> = Mutex::new(Vec::new());

impl TipTexture {
    /// The picture for dabs of a diameter in px: coverage, opaque and gray. Every brush gets the
    /// same one.
    pub fn source(self, diameter_px: f32) -> PictureSource {
        // For NaN the comparisons give the smallest.
        let side = if diameter_px > 400.0 {
            1024
        } else if diameter_px > 100.0 {
            512
        } else {
            256
        };
        let lock = || MADE.lock().unwrap_or_else(PoisonError::into_inner);
        let find = |made: &[((Self, u32), PictureSource)]| {
            made.iter().find(|(key, _)| *key == (self, side)).map(|(_, source)| source.clone())
        };
        if let Some(source) = find(&lock()) {
            return source;
        }
        // Without the lock: two threads may both compute it; the results are equal.
        let source = PictureSource::new("tip".into(), self.picture(side), Adjust::default());
        let mut made = lock();
        if let Some(source) = find(&made) {
            return source;
        }
        if made.len() >= KEPT {
            made.remove(0);
        }
        made.push(((self, side), source.clone()));
        source
    }

    fn picture(self, side: u32) -> Picture {
        gray(&match self {
            TipTexture::Bristles(Bristles { count, seed }) => {
                pattern::bristles(count.min(1000), seed, side)
            }
            TipTexture::Noise(Noise { cells, density, seed }) => {
                pattern::specks(cells.min(200), density.max(0.0).min(1.0), seed, side)
            }
        })
    }
}

/// Values in `[0, 1]` as an opaque gray picture.
pub fn gray(plane: &Plane<f32>) -> Picture {
    let texels = plane.values().iter().map(|v| {
        let byte = (v.max(0.0).min(1.0) * 255.0 + 0.5) as u8;
        [byte, byte, byte, 255]
    });
    let none = || Picture {
        size: Size::new(1, 1),
        texels: crate::raster::picture::Texels::Srgb8([[0; 4]].into()),
        texels16: None,
        encoded: None,
        drawing: None,
    };
    Picture::srgb8(plane.size(), texels.collect()).unwrap_or_else(none)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    #[test]
    fn tips_of_equal_parameters_share_one_picture_as_fine_as_their_dabs() {
        let tip = TipTexture::Noise(Noise { seed: 77, ..Noise::default() });
        let at = |diameter: f32| Arc::as_ptr(&tip.source(diameter).texture());
        assert_eq!(at(40.0), at(80.0));
        assert_ne!(at(40.0), at(2000.0));
        assert_eq!(tip.source(f32::NAN).picture.size, Size::new(256, 256));
        assert_eq!(tip.source(2000.0).picture.size, Size::new(1024, 1024));
    }
}
