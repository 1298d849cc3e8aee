//! Picture tips: a picture prepared as a stamp, blurred by its softness.
//! Floor 3. Not here: placing a stamp (`dab`), reading pictures through a deformation (`raster::sampler`).

use super::dab_walker::Dab;
use super::image::PictureSource;
use crate::math::{Affine2, Size, Vec2};
use crate::raster::texture::MipLevel;
use crate::raster::{Picture, Texture, blur};
use crate::surface::support::DabExtent;
use std::sync::{Arc, Mutex, PoisonError};

/// A tip as it is sampled. Its picture covers the square of the dab's diameter; softness makes it larger.
pub struct TipStamp {
    texture: Texture,
    /// Whether it has its own colours; otherwise only its alpha counts.
    pub is_colored: bool,
    /// Texels of `texture` along the radius of a dab.
    texels_per_radius: f32,
}

/// The stamps made from one picture, by softness: a brush's strokes share theirs.
#[derive(Default)]
pub struct StampCache {
    made: Mutex<Vec<(u32, Arc<TipStamp>)>>,
    grains: Mutex<Vec<([u32; 2], Arc<Texture>)>>,
}

/// Cached stamps of one picture: the steps of one brush whose softness varies, and a few of others.
const KEPT: usize = STEPS as usize + 8;
/// Softnesses in between are mixed from the two nearest of these steps; the difference to the true blur is invisible.
const STEPS: u32 = 12;

impl StampCache {
    /// The textures made of the picture as grain, by levels.
    pub fn grains(&self) -> &Mutex<Vec<([u32; 2], Arc<Texture>)>> {
        &self.grains
    }
    /// The stamp of a picture with a softness in `[0, 1]`.
    pub fn of(source: &PictureSource, softness: f32) -> Arc<TipStamp> {
        let lock = || source.stamps().made.lock().unwrap_or_else(PoisonError::into_inner);
        let key = softness.to_bits();
        let find = |made: &[(u32, Arc<TipStamp>)]| made.iter().find(|(k, _)| *k == key).map(|(_, s)| s.clone());
        if let Some(stamp) = find(&lock()) {
            return stamp;
        }
        // Without the lock: two threads may both compute it; the results are equal.
        let stamp = Arc::new(TipStamp::new(source.texture(), softness));
        let mut made = lock();
        if made.len() >= KEPT {
            made.remove(0);
        }
        made.push((key, stamp.clone()));
        stamp
    }
}

/// The stamps of a tip, sharp to blurred.
pub enum SoftenedStamps {
    /// Every dab has the brush's own softness.
    One(Arc<TipStamp>),
    /// From softness 0 to 1 at even steps.
    Steps(Vec<Arc<TipStamp>>),
}

impl SoftenedStamps {
    /// `is_driven`: dabs differ in softness.
    pub fn of(source: &PictureSource, softness: f32, is_driven: bool) -> Self {
        if is_driven {
            let steps = (0..=STEPS).map(|step| StampCache::of(source, step as f32 / STEPS as f32));
            return SoftenedStamps::Steps(steps.collect());
        }
        SoftenedStamps::One(StampCache::of(source, softness.max(0.0).min(1.0)))
    }
    /// The stamp next below a softness, and the one above with its share where the dab lies between them.
    pub fn at(&self, softness: f32) -> (&TipStamp, Option<(&TipStamp, f32)>) {
        match self {
            SoftenedStamps::One(stamp) => (stamp, None),
            SoftenedStamps::Steps(stamps) => {
                let place = softness.max(0.0).min(1.0) * STEPS as f32;
                let below = (place as usize).min(stamps.len().saturating_sub(2));
                let share = place - below as f32;
                let above = stamps.get(below + 1).filter(|_| share > 0.0);
                (&stamps[below], above.map(|above| (&**above, share)))
            }
        }
    }
    pub fn is_colored(&self) -> bool {
        self.at(0.0).0.is_colored
    }
    /// The extent of a dab with the widest of its stamps.
    pub fn extent(&self, dab: &Dab) -> DabExtent {
        let (below, above) = self.at(dab.softness);
        above.map_or(below, |(above, _)| above).extent(dab)
    }
}

/// Standard deviation of the blur at softness 1, in radii: that of the round tip's two kernels together.
const SIGMA_RATIO: f32 = 0.35;
/// A blur of this many texels is smooth when magnified; a wider one is made at a coarser level, at the same cost.
const SIGMA_TEXELS: f32 = 8.0;

impl TipStamp {
    fn new(tip: &Texture, softness: f32) -> Self {
        let size = tip.size();
        let is_colored = !is_grey(&tip.levels()[0]);
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
        Self { texture: Texture::new(&softened(level, is_colored, sigma)), is_colored, texels_per_radius }
    }
    pub fn texture(&self) -> &Texture {
        &self.texture
    }
    /// A⁻¹ after the shift to the dab's centre: texels from canvas px. The footprint is turned counter-clockwise as
    /// seen.
    pub fn texels_from_canvas(&self, dab: &Dab) -> Affine2 {
        let texels_per_px = Vec2::splat(self.texels_per_radius / dab.radius);
        // Counter-clockwise as seen is clockwise in y-down coordinates, so the inverse turns by +rotation.
        let mirror = Vec2::new(if dab.is_mirrored { -1.0 } else { 1.0 }, 1.0);
        Affine2::from_translation(self.texture.size().center())
            * Affine2::from_scale(mirror)
            * Affine2::from_scale_angle_translation(texels_per_px, dab.rotation_rad, Vec2::ZERO)
            * Affine2::from_translation(-dab.at)
    }
    /// The distance of the picture's corners, plus a texel.
    pub fn extent(&self, dab: &Dab) -> DabExtent {
        let px_per_texel = dab.radius / self.texels_per_radius;
        let corner = self.texture.size().center().length() + 1.0;
        // Two pixels' lengths on either side, which one-sided differences may double: the grid of taps and their cells.
        DabExtent { radius_px: corner * px_per_texel, filter_px: 4.0 }
    }
}

/// Opaque and grey throughout: a picture of coverage.
fn is_grey(level: &MipLevel) -> bool {
    level.texels.iter().all(|&[r, g, b, a]| r == g && g == b && a == 255)
}

/// The tip's picture with a transparent border as wide as its blur; coverage becomes alpha.
fn softened(level: &MipLevel, is_colored: bool, sigma: f32) -> Picture {
    let margin = (3.0 * sigma).ceil() as u32;
    let size = Size::new(level.size.width + 2 * margin, level.size.height + 2 * margin);
    let mut texels = vec![[0.0f32; 4]; size.area()];
    for (y, row) in level.texels.chunks_exact(level.size.width as usize).enumerate() {
        let start = (y + margin as usize) * size.width as usize + margin as usize;
        for (to, &[r, g, b, a]) in texels[start..].iter_mut().zip(row) {
            // The texels of a texture are premultiplied; a grey one's alpha is its grey.
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

/// A transparent picture in place of one that cannot be made: nothing is painted.
fn transparent() -> Picture {
    let texels: Arc<[[u8; 4]]> = Arc::new([[0; 4]]);
    Picture { size: Size::new(1, 1), texels: crate::raster::picture::Texels::Srgb8(texels), deep: None, encoded: None }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;
    use crate::paint::Adjust;

    fn source(size: Size, texel: impl Fn(u32, u32) -> [u8; 4]) -> PictureSource {
        let texels = (0..size.height).flat_map(|y| (0..size.width).map(move |x| (x, y))).map(|(x, y)| texel(x, y));
        PictureSource::new("tip.png".into(), Picture::srgb8(size, texels.collect()).unwrap(), Adjust::default())
    }
    fn dab(radius: f32, rotation_rad: f32) -> Dab {
        Dab { rotation_rad, ..Dab::plain(vec2(50.0, 60.0), radius) }
    }

    #[test]
    fn an_opaque_grey_picture_is_coverage_and_any_other_a_coloured_stamp() {
        let grey =
            StampCache::of(&source(Size::new(8, 4), |x, _| [x as u8 * 30, x as u8 * 30, x as u8 * 30, 255]), 0.0);
        assert!(!grey.is_colored);
        assert_eq!(grey.texture().levels()[0].texels[3], [90; 4], "premultiplied white of alpha 90");
        assert!(StampCache::of(&source(Size::new(8, 4), |_, _| [1, 2, 3, 255]), 0.0).is_colored);
        assert!(StampCache::of(&source(Size::new(8, 4), |x, _| [9, 9, 9, x as u8]), 0.0).is_colored);
    }
    #[test]
    fn the_longer_side_is_the_diameter_and_turns_counter_clockwise() {
        let stamp = StampCache::of(&source(Size::new(40, 20), |_, _| [255; 4]), 0.0);
        let upright = stamp.texels_from_canvas(&dab(10.0, 0.0));
        assert!((upright.transform_point2(vec2(60.0, 60.0)) - vec2(40.0, 10.0)).length() < 1e-4);
        // A quarter turn: the right end of the tip is at the top.
        let turned = stamp.texels_from_canvas(&dab(10.0, std::f32::consts::FRAC_PI_2));
        assert!((turned.transform_point2(vec2(50.0, 50.0)) - vec2(40.0, 10.0)).length() < 1e-4);
    }
    #[test]
    fn softness_keeps_what_a_stamp_covers_and_costs_no_more_the_larger_the_tip() {
        for side in [64, 1024] {
            let source = source(Size::new(side, side), |_, _| [255; 4]);
            let covered = |softness: f32| {
                let stamp = StampCache::of(&source, softness);
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
        assert!(Arc::ptr_eq(&StampCache::of(&tip, 0.25), &StampCache::of(&tip.clone(), 0.25)));
    }
}
