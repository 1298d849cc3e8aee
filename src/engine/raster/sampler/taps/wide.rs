//! Taps in AVX2: the two rows of a tap in the two halves of a register, then two taps side by side.
//! Floor 1. `Taps::singles_portably` and `Taps::means_portably` to the bit.

use super::{GROUP, ONE, SHARES, TapGroup, TapPositions, TapRun, Taps};
use std::arch::x86_64::*;

/// Whether the functions below may run: the processor has AVX2, and every tap's texels are the
/// level's.
pub fn can_read(taps: &Taps, at: TapPositions) -> bool {
    let width = at.level.size.width as usize;
    let all_within =
        usize::try_from(taps.range[1]).is_ok_and(|most| most + width + 1 < at.level.texels.len());
    all_within && std::arch::is_x86_feature_detected!("avx2")
}

/// As `Taps::singles`; call only where [`can_read`] said so.
pub fn singles(taps: &Taps, at: TapPositions, out: &mut [[u8; 4]]) {
    assert!(can_read(taps, at));
    // SAFETY: the processor has AVX2, and no index lies beyond `range`, whose texels are in the
    // level.
    unsafe {
        if taps.range[0] < 0 {
            singles_with::<true>(taps, at, out)
        } else {
            singles_with::<false>(taps, at, out)
        }
    }
}

/// As `Taps::means`; call only where [`can_read`] said so.
pub fn means(taps: &Taps, at: TapPositions, runs: &[TapRun], out: &mut [[u8; 4]]) {
    assert!(can_read(taps, at));
    // SAFETY: as above.
    unsafe {
        if taps.range[0] < 0 {
            means_with::<true>(taps, at, runs, out)
        } else {
            means_with::<false>(taps, at, runs, out)
        }
    }
}

/// As `Taps::group_means`; call only where [`can_read`] said so.
pub fn group_means(taps: &Taps, at: TapPositions, groups: &[TapGroup], out: &mut [[u8; 4]]) {
    assert!(can_read(taps, at));
    // SAFETY: as above.
    unsafe {
        if taps.range[0] < 0 {
            group_means_with::<true>(taps, at, groups, out)
        } else {
            group_means_with::<false>(taps, at, groups, out)
        }
    }
}

/// How many groups of four taps ahead texels are prefetched.
const AHEAD: usize = 16;

/// Four pixels at a time; seams, if there are any, are computed again.
#[target_feature(enable = "avx2")]
unsafe fn singles_with<const SEAMS: bool>(taps: &Taps, at: TapPositions, out: &mut [[u8; 4]]) {
    let n = out.len().min(taps.index.len());
    let out = &mut out[..n];
    let (index, across, down) = (
        taps.index[..n].as_chunks::<4>().0,
        taps.across[..n].as_chunks::<4>().0,
        taps.down[..n].as_chunks::<4>().0,
    );
    let scale = _mm256_set1_ps(1.0 / ONE);
    let ahead =
        taps.index[..n].as_chunks::<4>().0.iter().skip(AHEAD).chain(std::iter::repeat(&[0; 4]));
    for ((((index, across), down), ahead), out) in
        index.iter().zip(across).zip(down).zip(ahead).zip(out.as_chunks_mut::<4>().0)
    {
        prefetch(at, [ahead[0], ahead[2]]);
        // SAFETY: the caller's.
        let rows = unsafe {
            [
                rows::<SEAMS>(at, index[0], across[0]),
                rows::<SEAMS>(at, index[1], across[1]),
                rows::<SEAMS>(at, index[2], across[2]),
                rows::<SEAMS>(at, index[3], across[3]),
            ]
        };
        let first = _mm256_mul_ps(mix(rows[0], rows[1], [down[0], down[1]]), scale);
        let second = _mm256_mul_ps(mix(rows[2], rows[3], [down[2], down[3]]), scale);
        // Taps 0 2 | 1 3, as words, then as bytes.
        let words = _mm256_packs_epi32(_mm256_cvtps_epi32(first), _mm256_cvtps_epi32(second));
        let bytes = _mm256_packus_epi16(words, words);
        let bytes =
            _mm_unpacklo_epi32(_mm256_castsi256_si128(bytes), _mm256_extracti128_si256(bytes, 1));
        // SAFETY: sixteen bytes of four pixels.
        unsafe { _mm_storeu_si128(out.as_mut_ptr().cast(), bytes) };
    }
    let whole = n - n % 4;
    taps.singles_portably(at, whole, &mut out[whole..]);
    if SEAMS {
        for k in (0..whole).filter(|&k| taps.index[k] < 0) {
            taps.singles_portably(at, k, &mut out[k..=k]);
        }
    }
}

/// Eight pixels at a time; seams, if there are any, are computed again.
#[target_feature(enable = "avx2")]
unsafe fn group_means_with<const SEAMS: bool>(
    taps: &Taps,
    at: TapPositions,
    groups: &[TapGroup],
    out: &mut [[u8; 4]],
) {
    let mut first = 0;
    for group in groups {
        let range = first..(first + GROUP * usize::from(group.taps)).min(taps.index.len());
        first = range.end;
        let Some(out) =
            out.get_mut(usize::from(group.first)..).and_then(|out| out.first_chunk_mut::<GROUP>())
        else {
            continue;
        };
        let index = taps.index[range.clone()].as_chunks::<GROUP>().0;
        let across = taps.across[range.clone()].as_chunks::<GROUP>().0;
        let down = taps.down[range.clone()].as_chunks::<GROUP>().0;
        if let Some(ahead) = taps
            .index
            .get(range.end + 4 * AHEAD - GROUP..)
            .and_then(|ahead| ahead.first_chunk::<GROUP>())
        {
            prefetch(at, [ahead[0], ahead[4]]);
        }
        let mut sums = [_mm256_setzero_ps(); GROUP / 2];
        for ((index, across), down) in index.iter().zip(across).zip(down) {
            for (pair, sum) in sums.iter_mut().enumerate() {
                let (a, b) = (2 * pair, 2 * pair + 1);
                // SAFETY: the caller's.
                let rows = unsafe {
                    [rows::<SEAMS>(at, index[a], across[a]), rows::<SEAMS>(at, index[b], across[b])]
                };
                *sum = _mm256_add_ps(*sum, mix(rows[0], rows[1], [down[a], down[b]]));
            }
        }
        let share = _mm256_set1_ps(SHARES[usize::from(group.taps) % SHARES.len()]);
        let whole = |sum| _mm256_cvtps_epi32(_mm256_mul_ps(sum, share));
        let (a, b, c, d) = (whole(sums[0]), whole(sums[1]), whole(sums[2]), whole(sums[3]));
        // Pixels 0 2 4 6 | 1 3 5 7.
        let bytes = _mm256_packus_epi16(_mm256_packs_epi32(a, b), _mm256_packs_epi32(c, d));
        let (even, odd) = (_mm256_castsi256_si128(bytes), _mm256_extracti128_si256(bytes, 1));
        let (low, high) = (_mm_unpacklo_epi32(even, odd), _mm_unpackhi_epi32(even, odd));
        // SAFETY: thirty-two bytes of eight pixels.
        unsafe { _mm256_storeu_si256(out.as_mut_ptr().cast(), _mm256_set_m128i(high, low)) };
        if SEAMS {
            for (k, out) in out.iter_mut().enumerate() {
                if index.iter().any(|index| index[k] < 0) {
                    *out = taps.group_mean(at, range.clone(), k);
                }
            }
        }
    }
}

/// Two taps of a pixel at a time.
#[target_feature(enable = "avx2")]
unsafe fn means_with<const SEAMS: bool>(
    taps: &Taps,
    at: TapPositions,
    runs: &[TapRun],
    out: &mut [[u8; 4]],
) {
    let mut first = 0;
    for run in runs {
        let range = first..(first + usize::from(run.count)).min(taps.index.len());
        first = range.end;
        let Some(out) = out.get_mut(usize::from(run.pixel)) else { continue };
        let (index, across, down) =
            (&taps.index[range.clone()], &taps.across[range.clone()], &taps.down[range.clone()]);
        if SEAMS && index.iter().any(|&first| first < 0) {
            *out = taps.mean(at, range, run.share());
            continue;
        }
        let mut sums = _mm256_setzero_ps();
        let (index, last) = index.as_chunks::<2>();
        let (across, last_across) = across.as_chunks::<2>();
        let (down, last_down) = down.as_chunks::<2>();
        for ((index, across), down) in index.iter().zip(across).zip(down) {
            // SAFETY: the caller's.
            let rows = unsafe {
                [rows::<false>(at, index[0], across[0]), rows::<false>(at, index[1], across[1])]
            };
            sums = _mm256_add_ps(sums, mix(rows[0], rows[1], *down));
        }
        if let ([index], [across], [down]) = (last, last_across, last_down) {
            // SAFETY: the caller's.
            let rows = unsafe { rows::<false>(at, *index, *across) };
            sums = _mm256_add_ps(sums, mix(rows, _mm256_setzero_si256(), [*down, 0.0]));
        }
        let sum = _mm_add_ps(_mm256_castps256_ps128(sums), _mm256_extractf128_ps(sums, 1));
        let whole = _mm_cvtps_epi32(_mm_mul_ps(sum, _mm_set1_ps(run.share())));
        let bytes = _mm_packus_epi16(_mm_packs_epi32(whole, whole), whole);
        *out = _mm_cvtsi128_si32(bytes).to_le_bytes();
    }
}

/// A hint that reads nothing: prefetches the upper row of one tap and the lower row of another.
#[inline]
#[target_feature(enable = "avx2")]
fn prefetch(at: TapPositions, [upper, lower]: [i32; 2]) {
    let texel = |index: i32| at.level.texels.as_ptr().wrapping_add(index.max(0) as usize);
    _mm_prefetch::<_MM_HINT_T0>(texel(upper).cast());
    _mm_prefetch::<_MM_HINT_T0>(texel(lower).wrapping_add(at.level.size.width as usize).cast());
}

/// The upper pair of a tap's texels mixed, and the lower: four channels each, in `[0, 255 ONE]`. At
/// a seam those of texel 0.
#[inline]
#[target_feature(enable = "avx2")]
unsafe fn rows<const SEAMS: bool>(at: TapPositions, index: i32, across: u32) -> __m256i {
    let first = if SEAMS { index.max(0) } else { index } as usize;
    // SAFETY: the caller checked the indices; a row further down is in the level too.
    let both = unsafe {
        let top = at.level.texels.as_ptr().add(first);
        let bottom = top.add(at.level.size.width as usize);
        _mm_castpd_si128(_mm_loadh_pd(_mm_castsi128_pd(_mm_loadl_epi64(top.cast())), bottom.cast()))
    };
    let pairs =
        _mm_shuffle_epi8(both, _mm_setr_epi8(0, 4, 1, 5, 2, 6, 3, 7, 8, 12, 9, 13, 10, 14, 11, 15));
    _mm256_madd_epi16(_mm256_cvtepu8_epi16(pairs), _mm256_set1_epi32(across as i32))
}

/// Two taps, their rows mixed.
#[inline]
#[target_feature(enable = "avx2")]
fn mix(a: __m256i, b: __m256i, [down_a, down_b]: [f32; 2]) -> __m256 {
    let top = _mm256_cvtepi32_ps(_mm256_permute2x128_si256(a, b, 0x20));
    let bottom = _mm256_cvtepi32_ps(_mm256_permute2x128_si256(a, b, 0x31));
    let down = _mm256_set_m128(_mm_set1_ps(down_b), _mm_set1_ps(down_a));
    _mm256_add_ps(top, _mm256_mul_ps(_mm256_sub_ps(bottom, top), down))
}
