//! How much of a lamp is hidden from each pixel, in whole numbers: their sum does not depend on the
//! order of rays. Floor 2.

use super::ShareMap;
use super::heights::turned;
use super::seen_share;
use crate::math::{Size, fast, parallel};
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
            false => self.upright.get_or_insert_with(|| Plane::full(self.size, 0)),
            true => self.turned.get_or_insert_with(|| Plane::full(Size::new(height, width), 0)),
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
        let (mut counts, turned) = match (self.upright, self.turned.map(|plane| turned(&plane))) {
            (Some(a), b) => (a, b),
            (None, Some(b)) => (b, None),
            (None, None) => return ShareMap::full(self.size),
        };
        let width = counts.width().max(1);
        parallel::for_each_row(counts.values_mut(), width, 1, |y, row| {
            if let Some(turned) = &turned {
                row.iter_mut().zip(turned.row(y)).for_each(|(a, b)| *a += b);
            }
            see_row(row, per_count);
        });
        ShareMap::from_steps(counts, 1.0)
    }
}

crate::widest! {
    /// Counts to shares that are seen, in steps of a 65535th.
    fn see_row(row: &mut [u16], per_count: f32) {
        for v in row {
            let hidden = fast::min(f32::from(*v) * per_count, 1.0);
            *v = fast::whole(seen_share(hidden) * 65535.0) as u16;
        }
    }
}
