//! Color look-up tables, one- and three-dimensional, as `.cube` files hold them. Floor 3.

use std::sync::Arc;

/// Colors for evenly spaced colors, 16 bits a channel.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorTable {
    title: String,
    /// Entries along an axis.
    side: usize,
    /// Each channel by itself, not all together.
    is_separate: bool,
    /// Red, green and blue of each entry; in three dimensions red changes fastest.
    values: Arc<[u16]>,
}

impl ColorTable {
    /// Entries along an axis that a table may have: of one dimension, and of three.
    pub const MOST_SEPARATE: usize = 65_536;
    /// The most entries along a side of a table of three dimensions.
    pub const MOST_SIDE: usize = 65;
    /// Letters of a title.
    pub const LONGEST_TITLE: usize = 200;

    /// The entries that a table of `side` has; `None` beyond what is allowed.
    pub fn entries(side: usize, is_separate: bool) -> Option<usize> {
        let most = if is_separate { Self::MOST_SEPARATE } else { Self::MOST_SIDE };
        let entries = if is_separate { side } else { side.checked_mul(side)?.checked_mul(side)? };
        (2..=most).contains(&side).then_some(entries)
    }

    /// `None` if the values are not as many as the entries need.
    pub fn new(title: &str, side: usize, is_separate: bool, values: Vec<u16>) -> Option<Self> {
        let entries = Self::entries(side, is_separate)?;
        let title = title.chars().filter(|c| !c.is_control()).take(Self::LONGEST_TITLE).collect();
        let values: Arc<[u16]> = values.into();
        (values.len() == 3 * entries).then_some(Self { title, side, is_separate, values })
    }

    /// The title that its file has.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// How many entries lie along a side.
    pub fn side(&self) -> usize {
        self.side
    }

    /// It holds a curve for each channel, not a cube of colors.
    pub fn is_separate(&self) -> bool {
        self.is_separate
    }

    /// Its entries, three numbers each, red fastest.
    pub fn values(&self) -> &[u16] {
        &self.values
    }

    #[inline(always)]
    fn entry(&self, i: usize) -> [f32; 3] {
        std::array::from_fn(|c| self.values.get(3 * i + c).map_or(0.0, |v| f32::from(*v) / 65535.0))
    }

    /// Straight lines between entries in one dimension; in three, the tetrahedron that the color
    /// lies in: grays between grays stay gray.
    #[inline(always)]
    pub fn color(&self, rgb: [f32; 3]) -> [f32; 3] {
        let last = (self.side - 1) as f32;
        let place = rgb.map(|v| v.max(0.0).min(1.0) * last);
        let cell = place.map(|v| (v as usize).min(self.side - 2));
        let share: [f32; 3] = std::array::from_fn(|c| place[c] - cell[c] as f32);
        if self.is_separate {
            return std::array::from_fn(|c| {
                let (low, high) = (self.entry(cell[c])[c], self.entry(cell[c] + 1)[c]);
                low + (high - low) * share[c]
            });
        }
        let steps = [1, self.side, self.side * self.side];
        let corner = cell[0] + cell[1] * steps[1] + cell[2] * steps[2];
        // From the dark corner along the axis of the greatest share, then of the next, then of the
        // least.
        let mut order = [0, 1, 2];
        order.sort_by(|a, b| share[*b].total_cmp(&share[*a]));
        let mut at = corner;
        let mut last = self.entry(at);
        let mut out = last;
        for axis in order {
            at += steps[axis];
            let next = self.entry(at);
            for c in 0..3 {
                out[c] += (next[c] - last[c]) * share[axis];
            }
            last = next;
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(side: usize, of: impl Fn([f32; 3]) -> [f32; 3]) -> ColorTable {
        let entry = |i: usize| {
            let at = [i % side, i / side % side, i / side / side];
            of(at.map(|v| v as f32 / (side - 1) as f32))
        };
        let values =
            (0..side * side * side).flat_map(entry).map(|v| (v * 65535.0).round() as u16).collect();
        ColorTable::new("made", side, false, values).unwrap()
    }

    #[test]
    fn a_table_of_a_linear_map_is_that_map() {
        let map = |[r, g, b]: [f32; 3]| [0.5 * r + 0.25 * b, 1.0 - g, 0.3 * r + 0.3 * g + 0.4 * b];
        let table = cube(5, map);
        for i in 0..1000 {
            let rgb = [i % 10, i / 10 % 10, i / 100].map(|v| v as f32 / 9.0);
            let (found, meant) = (table.color(rgb), map(rgb));
            assert!((0..3).all(|c| (found[c] - meant[c]).abs() < 2e-5), "{rgb:?} {found:?}");
        }
    }

    #[test]
    fn grays_between_grays_stay_gray_where_colors_are_bent() {
        let table = cube(3, |[r, g, b]| if r == g && g == b { [r * r; 3] } else { [r, 0.0, 1.0] });
        for i in 0..=100 {
            let [r, g, b] = table.color([i as f32 / 100.0; 3]);
            assert!((r - g).abs() < 1e-5 && (g - b).abs() < 1e-5, "{r} {g} {b}");
        }
    }

    #[test]
    fn sizes_that_are_not_allowed_make_no_table() {
        assert!(ColorTable::new("", 1, false, vec![0; 3]).is_none());
        assert!(ColorTable::new("", 2, false, vec![0; 23]).is_none());
        assert!(ColorTable::new("", usize::MAX, false, vec![]).is_none());
    }
}
