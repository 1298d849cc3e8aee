//! Deterministic noise: the same inputs give the same numbers on every machine and thread.
//! Floor 0. Not for cryptography.

/// Mixes one 32-bit word (the "lowbias32" finaliser: xor-shift-multiply with full avalanche).
#[inline(always)]
pub const fn mix(mut x: u32) -> u32 {
    x ^= x >> 16;
    x = x.wrapping_mul(0x7feb_352d);
    x ^= x >> 15;
    x = x.wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

/// A number in `[0, 1)` from a seed and up to two indices.
#[inline(always)]
pub fn unit(seed: u32, i: u32, j: u32) -> f32 {
    let h = mix(seed ^ mix(i.wrapping_add(0x9e37_79b9) ^ mix(j.wrapping_add(0x85eb_ca6b))));
    (h >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// Two numbers in `[0, 1)` from a seed and two indices, 16 bits each.
#[inline(always)]
pub const fn unit_pair(seed: u32, i: u32, j: u32) -> [f32; 2] {
    let h = mix(seed ^ mix(i.wrapping_add(0x9e37_79b9) ^ mix(j.wrapping_add(0x85eb_ca6b))));
    [(h >> 16) as f32 * (1.0 / 65_536.0), (h & 0xffff) as f32 * (1.0 / 65_536.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_uniform_enough_to_dither_with() {
        let mean = (0..10_000).map(|i| unit(7, i, i / 100)).sum::<f32>() / 10_000.0;
        assert!((mean - 0.5).abs() < 0.01, "{mean}");
        assert_ne!(unit(1, 2, 3), unit(1, 3, 2));
    }
}
