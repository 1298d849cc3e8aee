//! Many bilinear taps at once: the fast version of `bilinear`. Floor 1. Two passes: positions to
//! texels and weights, several taps an instruction; then the texels, one tap at a time with its
//! texels' channels side by side, in AVX2 where the processor has it (`wide`): LLVM does not
//! vectorize that on its own. Both versions give the same bits.

mod find;
#[cfg(target_arch = "x86_64")]
mod wide;

use super::super::texture::{MipLevel, Outside};
use super::bilinear_in;
use crate::math::vec2;
use find::find;

/// Where taps read. Scratch, kept from row to row.
#[derive(Default)]
pub struct Taps {
    /// Of the upper left texel; negative at a seam, where the four texels are not adjacent inside
    /// the picture.
    index: Vec<i32>,
    /// Weights of the left texels (low half) and the right ones (high half), in [`ONE`]-ths.
    across: Vec<u32>,
    /// How far down between the upper and the lower pair, `[0, 1]`.
    down: Vec<f32>,
    /// The least and the largest index.
    range: [i32; 2],
}

/// The positions of taps in one level, in its texels, and what lies beyond it.
#[derive(Clone, Copy)]
pub struct TapPositions<'a> {
    pub level: &'a MipLevel,
    pub x: &'a [f32],
    pub y: &'a [f32],
    pub outside: Outside,
}

/// How many of the taps belong to a pixel: at most 31.
#[derive(Clone, Copy, Default)]
pub struct TapRun {
    pub pixel: u16,
    pub count: u16,
}

/// Pixels of a [`TapGroup`].
pub const GROUP: usize = 8;

/// Neighboring pixels with as many taps each: the first tap of all, then the second of all, …
#[derive(Clone, Copy)]
pub struct TapGroup {
    pub first: u16,
    pub taps: u16,
}

impl Taps {
    /// Finds the texels of every position.
    pub fn find(&mut self, at: TapPositions) {
        let n = at.x.len();
        // Every value is written below, so values left from the last call do not matter.
        if n != self.index.len() {
            self.index.resize(n, 0);
            self.across.resize(n, 0);
            self.down.resize(n, 0.0);
        }
        self.range = find(at, &mut self.index, &mut self.across, &mut self.down);
    }

    /// Writes every tap's rounded color to a pixel of its own.
    pub fn singles(&self, at: TapPositions, out: &mut [[u8; 4]]) {
        #[cfg(target_arch = "x86_64")]
        if wide::can_read(self, at) {
            return wide::singles(self, at, out);
        }
        self.singles_portably(at, 0, out);
    }

    /// Writes the rounded mean of the next `count` taps to each run's pixel of `out`.
    pub fn means(&self, at: TapPositions, runs: &[TapRun], out: &mut [[u8; 4]]) {
        #[cfg(target_arch = "x86_64")]
        if wide::can_read(self, at) {
            return wide::means(self, at, runs, out);
        }
        self.means_portably(at, runs, out);
    }

    /// Writes the rounded means of the next taps to each group's pixels of `out`.
    pub fn group_means(&self, at: TapPositions, groups: &[TapGroup], out: &mut [[u8; 4]]) {
        #[cfg(target_arch = "x86_64")]
        if wide::can_read(self, at) {
            return wide::group_means(self, at, groups, out);
        }
        self.group_means_portably(at, groups, out);
    }

    fn group_means_portably(&self, at: TapPositions, groups: &[TapGroup], out: &mut [[u8; 4]]) {
        let mut first = 0;
        for group in groups {
            let taps = first..(first + GROUP * usize::from(group.taps)).min(self.index.len());
            first = taps.end;
            for (k, out) in out.iter_mut().skip(usize::from(group.first)).take(GROUP).enumerate() {
                *out = self.group_mean(at, taps.clone(), k);
            }
        }
    }

    /// The mean of pixel `k` of a group.
    fn group_mean(&self, at: TapPositions, taps: std::ops::Range<usize>, k: usize) -> [u8; 4] {
        let mut sum = [0.0; 4];
        let share = SHARES[taps.len() / GROUP % SHARES.len()];
        for tap in taps.skip(k).step_by(GROUP) {
            let color = self.color(at, tap);
            (0..4).for_each(|c| sum[c] += color[c]);
        }
        sum.map(|v| round(v * share))
    }

    fn singles_portably(&self, at: TapPositions, from: usize, out: &mut [[u8; 4]]) {
        for (tap, out) in (from..self.index.len()).zip(out) {
            *out = self.color(at, tap).map(|v| round(v * (1.0 / ONE)));
        }
    }

    fn means_portably(&self, at: TapPositions, runs: &[TapRun], out: &mut [[u8; 4]]) {
        let mut first = 0;
        for run in runs {
            let taps = first..(first + usize::from(run.count)).min(self.index.len());
            first = taps.end;
            if let Some(out) = out.get_mut(usize::from(run.pixel)) {
                *out = self.mean(at, taps, run.share());
            }
        }
    }

    /// Even and odd taps are added up separately, as in the wide version.
    fn mean(&self, at: TapPositions, taps: std::ops::Range<usize>, share: f32) -> [u8; 4] {
        let mut sums = [[0.0; 4]; 2];
        for (k, tap) in taps.enumerate() {
            let color = self.color(at, tap);
            (0..4).for_each(|c| sums[k % 2][c] += color[c]);
        }
        std::array::from_fn(|c| round((sums[0][c] + sums[1][c]) * share))
    }

    /// One tap, in `[0, 255 ONE]`.
    #[inline(always)]
    fn color(&self, at: TapPositions, tap: usize) -> [f32; 4] {
        match self.texels(at.level, tap) {
            Some([top, bottom]) => {
                let (across, down) = (self.across[tap], self.down[tap]);
                let [top, bottom] = [top, bottom].map(|pair| mix_pair(pair, across));
                std::array::from_fn(|c| top[c] + (bottom[c] - top[c]) * down)
            }
            None => bilinear_in(at.level, vec2(at.x[tap], at.y[tap]), at.outside).map(|v| v * ONE),
        }
    }

    /// The upper and the lower pair of texels of a tap; `None` at a seam.
    #[inline(always)]
    fn texels<'l>(&self, level: &'l MipLevel, tap: usize) -> Option<[&'l [[u8; 4]; 2]; 2]> {
        let first = usize::try_from(self.index[tap]).ok()?;
        let both = level.texels.get(first..first + level.size.width as usize + 2)?;
        Some([both.first_chunk()?, both.last_chunk()?])
    }
}

/// A weight of 1 as an integer: two weighted bytes then fit 22 bits, which an f32 holds exactly.
const ONE: f32 = 16384.0;

/// Two texels side by side, mixed; `[0, 255 ONE]`.
#[inline(always)]
fn mix_pair([left, right]: &[[u8; 4]; 2], across: u32) -> [f32; 4] {
    std::array::from_fn(|c| {
        (u32::from(left[c]) * (across & 0xffff) + u32::from(right[c]) * (across >> 16)) as f32
    })
}

impl TapRun {
    /// The factor that turns a sum of `count` taps into their mean, in bytes.
    #[inline(always)]
    fn share(self) -> f32 {
        SHARES[usize::from(self.count) % SHARES.len()]
    }
}

/// 1 / (n ONE): a division a pixel would cost as much as a tap.
const SHARES: [f32; 32] = {
    let mut shares = [0.0; 32];
    let mut n = 1;
    while n < 32 {
        shares[n] = 1.0 / (n as f32 * ONE);
        n += 1;
    }
    shares
};

/// The nearest byte of a value in `[0, 255]`, ties to even: adding 2²³ leaves the integer in the
/// low bits.
#[inline(always)]
fn round(value: f32) -> u8 {
    (value + 8_388_608.0).to_bits() as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Size;

    #[test]
    fn the_wide_means_are_the_portable_ones_to_the_bit() {
        let texels = (0..9 * 7u32).map(|i| (i.wrapping_mul(0x9e37_79b9)).to_le_bytes()).collect();
        let level = MipLevel { size: Size::new(9, 7), texels };
        let x: Vec<f32> = (0..300).map(|i| (i as f32 * 0.37) % 14.0 - 2.0).collect();
        let y: Vec<f32> = (0..300).map(|i| (i as f32 * 0.61) % 10.0 - 1.5).collect();
        let runs: Vec<TapRun> = (0..100).map(|i| TapRun { pixel: i, count: 1 + i % 5 }).collect();
        for outside in [Outside::None, Outside::Clamp, Outside::Repeat, Outside::Mirror] {
            let at = TapPositions { level: &level, x: &x, y: &y, outside };
            let mut taps = Taps::default();
            taps.find(at);
            let (mut wide, mut portable) = ([[0; 4]; 100], [[0; 4]; 100]);
            taps.means(at, &runs, &mut wide);
            taps.means_portably(at, &runs, &mut portable);
            assert_eq!(wide, portable, "means, {outside:?}");
            let groups =
                [(0, 3), (16, 1), (8, 16), (40, 7)].map(|(first, taps)| TapGroup { first, taps });
            taps.group_means(at, &groups, &mut wide);
            taps.group_means_portably(at, &groups, &mut portable);
            assert_eq!(wide, portable, "groups, {outside:?}");
            for n in [100, 3, 1, 66] {
                taps.singles(at, &mut wide[..n]);
                taps.singles_portably(at, 0, &mut portable[..n]);
                assert_eq!(wide, portable, "singles, {outside:?}");
            }
        }
    }
}
