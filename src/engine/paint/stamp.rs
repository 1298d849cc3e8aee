//! Picture tips: a picture prepared as a stamp, blurred by its softness. Floor 3. Not here: placing
//! a stamp (`dab`), reading pictures through a deformation (`raster::sampler`).

use crate::math::Size;
use crate::raster::texture::MipLevel;
use crate::raster::{Picture, Texture, blur};
use std::sync::{Arc, Mutex, PoisonError};

/// A tip as it is sampled. Its picture covers the square of the dab's diameter; softness makes it
/// larger.
pub struct TipStamp {
    texture: Texture,
    /// Whether it has its own colors; otherwise only its alpha counts.
    pub is_colored: bool,
    /// Texels of `texture` along the radius of a dab.
    pub(in crate::paint) texels_per_radius: f32,
}

/// The stamps made from one picture, by softness: a brush's strokes share theirs.
#[derive(Default)]
pub struct StampCache {
    made: Mutex<Vec<(u32, Arc<TipStamp>)>>,
    grains: Mutex<Vec<([u32; 2], Arc<Texture>)>>,
}

/// Cached stamps of one picture: the steps of a brush whose softness varies, and a few others.
const KEPT: usize = STEPS as usize + 8;
/// Softnesses in between are mixed from the two nearest of these steps; the difference to the true
/// blur is invisible.
pub(in crate::paint) const STEPS: u32 = 12;

impl StampCache {
    /// The textures made from the picture as grain, by levels.
    pub fn grains(&self) -> &Mutex<Vec<([u32; 2], Arc<Texture>)>> {
        &self.grains
    }

    /// The stamp of the picture, by its texture, with a softness in `[0, 1]`.
    pub fn stamp(&self, texture: &Texture, softness: f32) -> Arc<TipStamp> {
        let lock = || self.made.lock().unwrap_or_else(PoisonError::into_inner);
        let key = softness.to_bits();
        let find = |made: &[(u32, Arc<TipStamp>)]| {
            made.iter().find(|(k, _)| *k == key).map(|(_, s)| s.clone())
        };
        if let Some(stamp) = find(&lock()) {
            return stamp;
        }
        // Without the lock: two threads may both compute it; the results are equal.
        let stamp = Arc::new(TipStamp::new(texture, softness));
        let mut made = lock();
        if made.len() >= KEPT {
            made.remove(0);
        }
        made.push((key, stamp.clone()));
        stamp
    }
}

/// Standard deviation of the blur at softness 1, in radii: that of the round tip's two kernels
/// together.
const SIGMA_RATIO: f32 = 0.35;
/// A blur of this many texels is smooth when magnified; a wider one is made at a coarser level, at
/// the same cost.
const SIGMA_TEXELS: f32 = 8.0;

impl TipStamp {
    fn new(tip: &Texture, softness: f32) -> Self {
        let size = tip.size();
        let is_colored = !is_gray(&tip.levels()[0]);
        let mut sigma = SIGMA_RATIO * softness * 0.5 * size.longer_side();
        let mut level = &tip.levels()[0];
        for coarser in tip.levels().iter().skip(1) {
            if sigma <= SIGMA_TEXELS {
                break;
            }
            sigma *= coarser.size.longer_side() / level.size.longer_side();
            level = coarser;
        }
        let texels_per_radius = 0.5 * level.size.longer_side();
        Self {
            texture: Texture::new(&soften(level, is_colored, sigma)),
            is_colored,
            texels_per_radius,
        }
    }

    pub fn texture(&self) -> &Texture {
        &self.texture
    }
}

/// Opaque and gray everywhere: a picture of coverage.
fn is_gray(level: &MipLevel) -> bool {
    level.texels.iter().all(|&[r, g, b, a]| r == g && g == b && a == 255)
}

/// The tip's picture with a transparent border as wide as its blur; coverage becomes alpha.
fn soften(level: &MipLevel, is_colored: bool, sigma: f32) -> Picture {
    let margin = (3.0 * sigma).ceil() as u32;
    let size = Size::new(level.size.width + 2 * margin, level.size.height + 2 * margin);
    let mut texels = vec![[0.0f32; 4]; size.area()];
    for (y, row) in level.texels.chunks_exact(level.size.width as usize).enumerate() {
        let start = (y + margin as usize) * size.width as usize + margin as usize;
        for (to, &[r, g, b, a]) in texels[start..].iter_mut().zip(row) {
            // The texels of a texture are premultiplied; a gray one's alpha is its gray.
            *to = if is_colored { [r, g, b, a] } else { [r; 4] }.map(f32::from);
        }
    }
    let texels = blur::gaussian_pixels(size, &texels, sigma);
    let straight = texels.into_iter().map(|[r, g, b, a]| {
        let per_alpha = if a > 0.0 { 255.0 / a } else { 0.0 };
        [r * per_alpha, g * per_alpha, b * per_alpha, a].map(|v| (v + 0.5) as u8)
    });
    Picture::srgb8(size, straight.collect()).unwrap_or_else(transparent)
}

/// A transparent picture instead of one that cannot be made: nothing is painted.
fn transparent() -> Picture {
    let texels: Arc<[[u8; 4]]> = Arc::new([[0; 4]]);
    Picture {
        size: Size::new(1, 1),
        texels: crate::raster::picture::Texels::Srgb8(texels),
        texels16: None,
        encoded: None,
        drawing: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paint::{Adjust, PictureSource};

    fn source(size: Size, texel: impl Fn(u32, u32) -> [u8; 4]) -> PictureSource {
        let texels = (0..size.height)
            .flat_map(|y| (0..size.width).map(move |x| (x, y)))
            .map(|(x, y)| texel(x, y));
        PictureSource::new(
            "tip.png".into(),
            Picture::srgb8(size, texels.collect()).unwrap(),
            Adjust::default(),
        )
    }

    #[test]
    fn an_opaque_gray_picture_is_coverage_and_any_other_a_colored_stamp() {
        let gray = source(Size::new(8, 4), |x, _| [x as u8 * 30, x as u8 * 30, x as u8 * 30, 255])
            .stamp(0.0);
        assert!(!gray.is_colored);
        assert_eq!(
            gray.texture().levels()[0].texels[3],
            [90; 4],
            "premultiplied white of alpha 90"
        );
        assert!(source(Size::new(8, 4), |_, _| [1, 2, 3, 255]).stamp(0.0).is_colored);
        assert!(source(Size::new(8, 4), |x, _| [9, 9, 9, x as u8]).stamp(0.0).is_colored);
    }

    #[test]
    fn softness_keeps_what_a_stamp_covers_and_costs_no_more_the_larger_the_tip() {
        for side in [64, 1024] {
            let source = source(Size::new(side, side), |_, _| [255; 4]);
            let covered = |softness: f32| {
                let stamp = source.stamp(softness);
                let level = &stamp.texture().levels()[0];
                assert!(level.size.longer_side() < 3.0 * side as f32);
                let sum: f64 = level.texels.iter().map(|t| f64::from(t[3]) / 255.0).sum();
                sum / f64::from(stamp.texels_per_radius).powi(2)
            };
            let hard = covered(0.0);
            assert!((hard - 4.0).abs() < 1e-6, "a square of two radii");
            assert!((covered(0.2) / hard - 1.0).abs() < 0.01);
            assert!((covered(1.0) / hard - 1.0).abs() < 0.01);
        }
    }

    #[test]
    fn strokes_of_one_brush_share_their_stamp() {
        let tip = source(Size::new(8, 8), |_, _| [255; 4]);
        assert!(Arc::ptr_eq(&tip.stamp(0.25), &tip.clone().stamp(0.25)));
    }
}
