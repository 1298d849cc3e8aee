//! What stands highest of the last rows, however many these are: the greatest since the last whole
//! block of rows began, or that of the end of the block before (van Herk 1992). Floor 2. Heights
//! and rows are one number each, so that the greater of two is one instruction.

/// Lines of a strip, side by side: whole vectors, four at a time.
pub(super) const LANES: usize = 128;
/// The low bits of a key: its row, modulo their range.
pub(super) const ROW_BITS: u32 = 11;
/// Rows that a key can tell apart.
pub(super) const MOST_ROWS: usize = (1 << ROW_BITS) - 1;
/// Keys of heights are smaller than this in size.
pub(super) const LIMIT: i32 = 1 << 30;

/// A height above the ray, in steps, over the row that it is in.
pub(super) type Keys = [i32; LANES];

/// The key of a height in a row.
#[inline(always)]
pub(super) fn key(steps: i32, row: usize) -> i32 {
    (steps << ROW_BITS) | (row & MOST_ROWS) as i32
}

/// The highest of rows that slide over a map.
pub(super) struct SlidingKeys {
    /// Of this block, the keys of its rows, and the highest since it began.
    block: Vec<Keys>,
    since: Keys,
    in_block: usize,
    /// The highest of a row of the block before or of those after it.
    before: Vec<Keys>,
    highest: Keys,
}

impl SlidingKeys {
    const NONE: Keys = [-LIMIT; LANES];

    /// For rows that look back at `reach` others, `≥ 1`.
    pub fn of(reach: usize) -> Self {
        Self {
            block: vec![Self::NONE; reach],
            since: Self::NONE,
            in_block: 0,
            before: vec![Self::NONE; reach],
            highest: Self::NONE,
        }
    }

    /// Forgets the rows of another strip.
    pub fn leave(&mut self) {
        (self.since, self.in_block) = (Self::NONE, 0);
        self.before.fill(Self::NONE);
    }

    /// The highest of the rows that the next one looks back at.
    #[inline(always)]
    pub fn highest(&mut self) -> &Keys {
        let (since, before) = (&self.since, &self.before[self.in_block]);
        for i in 0..LANES {
            self.highest[i] = higher(since[i], before[i]);
        }
        &self.highest
    }

    /// Goes on to the next row. Copies are loops: the compiler would call `memmove`.
    #[inline(always)]
    pub fn take(&mut self, keys: &Keys) {
        let row = &mut self.block[self.in_block];
        for i in 0..LANES {
            row[i] = keys[i];
            self.since[i] = higher(self.since[i], keys[i]);
        }
        self.in_block += 1;
        if self.in_block == self.block.len() {
            let mut after = Self::NONE;
            for (row, before) in self.block.iter().zip(&mut self.before).rev() {
                for i in 0..LANES {
                    after[i] = higher(after[i], row[i]);
                    before[i] = after[i];
                }
            }
            (self.since, self.in_block) = (Self::NONE, 0);
        }
    }
}

#[inline(always)]
pub(super) fn higher(a: i32, b: i32) -> i32 {
    if a > b { a } else { b }
}
