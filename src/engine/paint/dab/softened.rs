//! The stamps of a picture tip, and how a dab lies on them.
//! Floor 3. Not here: making a stamp (`stamp`), reading it on a tile (`coverage`).

use crate::math::{Affine2, Vec2};
use crate::paint::dab_walker::Dab;
use crate::paint::image::PictureSource;
use crate::paint::stamp::{STEPS, TipStamp};
use crate::surface::support::DabExtent;
use std::sync::Arc;

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
            let steps = (0..=STEPS).map(|step| source.stamp(step as f32 / STEPS as f32));
            return SoftenedStamps::Steps(steps.collect());
        }
        SoftenedStamps::One(source.stamp(softness.max(0.0).min(1.0)))
    }

    /// The stamp just below a softness, and the one above with its weight if the dab is between
    /// them.
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

    /// Its stamps have colors of their own.
    pub fn is_colored(&self) -> bool {
        self.at(0.0).0.is_colored
    }

    /// The extent of a dab with the widest of its stamps.
    pub fn extent(&self, dab: &Dab) -> DabExtent {
        let (below, above) = self.at(dab.softness);
        above.map_or(below, |(above, _)| above).extent(dab)
    }
}

impl TipStamp {
    /// A⁻¹ after the shift to the dab's center: texels from canvas px. The footprint is turned
    /// counter-clockwise as seen.
    pub fn texels_from_canvas(&self, dab: &Dab) -> Affine2 {
        let texels_per_px = Vec2::splat(self.texels_per_radius / dab.radius);
        // Counter-clockwise as seen is clockwise in y-down coordinates, so the inverse turns by
        // +rotation.
        let mirror = Vec2::new(if dab.is_mirrored { -1.0 } else { 1.0 }, 1.0);
        Affine2::from_translation(self.texture().size().center())
            * Affine2::from_scale(mirror)
            * Affine2::from_scale_angle_translation(texels_per_px, dab.rotation_rad, Vec2::ZERO)
            * Affine2::from_translation(-dab.at)
    }

    /// The distance of the picture's corners, plus a texel.
    pub fn extent(&self, dab: &Dab) -> DabExtent {
        let px_per_texel = dab.radius / self.texels_per_radius;
        let corner = self.texture().size().center().length() + 1.0;
        // Two pixels' lengths on either side, which one-sided differences may double: the grid of
        // taps and their cells.
        DabExtent { radius_px: corner * px_per_texel, filter_px: 4.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, vec2};
    use crate::paint::Adjust;
    use crate::raster::Picture;

    #[test]
    fn the_longer_side_is_the_diameter_and_turns_counter_clockwise() {
        let picture = Picture::srgb8(Size::new(40, 20), vec![[255; 4]; 800]).unwrap();
        let stamp = PictureSource::new("tip.png".into(), picture, Adjust::default()).stamp(0.0);
        let dab = |rotation_rad: f32| Dab { rotation_rad, ..Dab::plain(vec2(50.0, 60.0), 10.0) };
        let upright = stamp.texels_from_canvas(&dab(0.0));
        assert!((upright.transform_point2(vec2(60.0, 60.0)) - vec2(40.0, 10.0)).length() < 1e-4);
        // A quarter turn: the right end of the tip is at the top.
        let turned = stamp.texels_from_canvas(&dab(std::f32::consts::FRAC_PI_2));
        assert!((turned.transform_point2(vec2(50.0, 50.0)) - vec2(40.0, 10.0)).length() < 1e-4);
    }
}
