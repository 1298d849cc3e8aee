//! How much of a lamp is hidden from each pixel, in whole numbers: their sum does not depend on the
//! order of rays. Floor 2.

use super::ShareMap;
use super::heights::turned;
use super::seen;
use crate::math::Size;
use crate::raster::Plane;

/// What a ray counts where it is hidden wholly.
pub(super) const WHOLE: f32 = 1000.0;

/// How much rays are hidden, added up in whole numbers.
pub(super) struct HiddenCounts {
    size: Size,
    upright: Option<Plane<u16>>,
    turned: Option<Plane<u16>>,
}

impl HiddenCounts {
    pub fn new(size: Size) -> Self {
        Self { size, upright: None, turned: None }
    }

    /// The sums of rays that sweep the map as it lies or turned.
    pub fn of(&mut self, is_turned: bool) -> &mut Plane<u16> {
        let Size { width, height } = self.size;
        match is_turned {
            false => self.upright.get_or_insert_with(|| Plane::filled(self.size, 0)),
            true => self.turned.get_or_insert_with(|| Plane::filled(Size::new(height, width), 0)),
        }
    }

    pub fn plus(self, other: Self) -> Self {
        let sum = |a: Option<Plane<u16>>, b: Option<Plane<u16>>| match (a, b) {
            (Some(mut a), Some(b)) => {
                a.values_mut().iter_mut().zip(b.values()).for_each(|(a, b)| *a += b);
                Some(a)
            }
            (a, b) => a.or(b),
        };
        let (upright, turned) = (sum(self.upright, other.upright), sum(self.turned, other.turned));
        Self { size: self.size, upright, turned }
    }

    /// What each pixel sees of the lamp that so many rays go to.
    pub fn visible_shares(self, rays: u32) -> ShareMap {
        let per_count = 1.0 / (WHOLE * rays as f32);
        let turned = self.turned.map(|plane| turned(&plane));
        let mut counts = match (self.upright, turned) {
            (Some(a), Some(b)) => a.updated(|x, y, v| v + b.at(x, y)),
            (a, b) => a.or(b).unwrap_or_else(|| Plane::filled(self.size, 0)),
        };
        let steps: Vec<u16> = (0..=(WHOLE * rays as f32) as u32)
            .map(|count| (seen(count as f32 * per_count) * f32::from(u16::MAX) + 0.5) as u16)
            .collect();
        counts = counts.updated(|_, _, v| steps.get(usize::from(v)).copied().unwrap_or(0));
        ShareMap::from_steps(counts, 1.0)
    }
}
