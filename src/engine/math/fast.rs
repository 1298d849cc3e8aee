//! Powers, logarithms, tanh, sine, acos and atan2 for inner loops: polynomials of bounded error that the
//! compiler vectorizes. Floor 0. The references are std's; the bounds below are tests. The
//! approximations of sRGB are in `srgb`, next to the curve.

/// The larger of two numbers; `b` where `a` is NaN. One instruction, where `f32::max` needs three.
#[inline(always)]
pub fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The smaller of two numbers; `b` where `a` is NaN.
#[inline(always)]
pub fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// Raises a value in place to another, unless that is NaN. `f32::max` and no comparison: the
/// compiler turns a comparison into a masked store, which takes some processors (Zen) forty steps,
/// and the next read of the value waits for it.
#[inline(always)]
pub fn raise(value: &mut f32, to: f32) {
    *value = value.max(to);
}

/// Adding 1.5 · 2²³ leaves the nearest whole number in the low bits: rounding without SSE 4.1.
const ROUND: f32 = 12_582_912.0;

/// A whole number below 2²² in size as an integer; for others some integer.
#[inline(always)]
pub fn whole(x: f32) -> i32 {
    (x + ROUND).to_bits().wrapping_sub(ROUND.to_bits()) as i32
}

/// 2^x, relative error below 4e-6; exactly 1 at 0. `x` is clamped to ±126, NaN becomes 2^-126.
#[inline(always)]
pub fn exp2(x: f32) -> f32 {
    let x = min(max(x, -126.0), 126.0);
    let rounded = x + ROUND;
    let f = x - (rounded - ROUND);
    let two_to_f =
        1.0 + f * (0.693_124_2 + f * (0.240_241 + f * (0.055_906_37 + f * 0.009_582_819)));
    // The whole part goes into the exponent.
    let whole = rounded.to_bits() << 23;
    f32::from_bits(two_to_f.to_bits().wrapping_add(whole))
}

/// e^x; like [`exp2`].
#[inline(always)]
pub fn exp(x: f32) -> f32 {
    exp2(x * std::f32::consts::LOG2_E)
}

/// log₂ x for normal positive `x`, absolute error below 3e-6 and a rounding; exactly 0 at 1. Below
/// the smallest normal float, −126.
#[inline(always)]
pub fn log2(x: f32) -> f32 {
    // √½: mantissas then lie around 1, from √½ to √2.
    const HALF_ROOT: i32 = 0x3f35_04f3;
    let x = max(x, f32::MIN_POSITIVE);
    let bits = x.to_bits() as i32;
    let exponent = (bits - HALF_ROOT) >> 23;
    let f = f32::from_bits((bits - (exponent << 23)) as u32) - 1.0;
    let p = 0.479_348_12 + f * (-0.367_489_73 + f * (0.322_153_87 + f * -0.206_591_95));
    exponent as f32 + f * (1.442_713_5 + f * (-0.721_131_86 + f * p))
}

/// x^p for `x ≥ 0`; 0 at 0 where `p > 0`. Relative error below 3e-6 · (p + 1).
#[inline(always)]
pub fn pow(x: f32, p: f32) -> f32 {
    let y = exp2(p * log2(x));
    if x > 0.0 { y } else { 0.0 }
}

/// tanh x, absolute error below 5e-7; exactly 0 at 0 and odd. NaN becomes −tanh 7.8.
///
/// A quotient of polynomials up to 7.8, where tanh is 1 − 3.4e-7, and constant beyond.
#[inline(always)]
pub fn tanh(x: f32) -> f32 {
    let x = min(max(x, -7.8), 7.8);
    let y = x * x;
    let above =
        (0.127_175_93 + y * 0.002_702_542_3) + (y * y) * (7.218_450_3e-6 - y * 6.262_684e-9);
    let below = 0.460_506_44 + y * (0.022_874_406 + y * 1.976_120_3e-4);
    x * (0.999_999_2 + y * above) / (1.0 + y * below)
}

/// acos x for `x` in `[−1, 1]`, clamped to it; absolute error below 7e-5 (Abramowitz and Stegun
/// 1964, 4.4.45). NaN becomes π.
#[inline(always)]
pub fn acos(x: f32) -> f32 {
    let x = min(max(x, -1.0), 1.0);
    let a = x.abs();
    let angle =
        (1.0 - a).sqrt() * (1.570_728_8 + a * (-0.212_114_4 + a * (0.074_261 + a * -0.018_729_3)));
    if x < 0.0 { std::f32::consts::PI - angle } else { angle }
}

/// atan2(y, x), in `[−π, π]`; absolute error below 6e-7, 0 where both are 0. NaN becomes some angle
/// or NaN.
#[inline(always)]
pub fn atan2(y: f32, x: f32) -> f32 {
    let (across, up) = (x.abs(), y.abs());
    let t = min(across, up) / max(max(across, up), f32::MIN_POSITIVE);
    let s = t * t;
    // atan t / t on [0, 1] for the smallest greatest error, 2.5e-7.
    let p = 0.198_078_16
        + s * (-0.132_333_43 + s * (0.079_623_67 + s * (-0.033_604_22 + s * 0.006_811_792_5)));
    let angle = t * (0.999_996_1 + s * (-0.333_173_7 + s * p));
    let angle = if up > across { std::f32::consts::FRAC_PI_2 - angle } else { angle };
    let angle = if x < 0.0 { std::f32::consts::PI - angle } else { angle };
    if y < 0.0 { -angle } else { angle }
}

/// Sine and cosine of 2π x, absolute error below 4e-7 and that of `x`'s place in its turn.
#[inline(always)]
pub fn sin_cos_of_turn(x: f32) -> (f32, f32) {
    let g = x - (x + 0.5).floor();
    let side = g.abs();
    let sin = sin_of_quarter_turn(0.25 - (side - 0.25).abs());
    (if g < 0.0 { -sin } else { sin }, sin_of_quarter_turn(0.25 - side))
}

/// sin 2π h for `h` in `[−¼, ¼]`: its series.
#[inline(always)]
fn sin_of_quarter_turn(h: f32) -> f32 {
    let s = h * h;
    let p = 81.605_25 + s * (-76.705_86 + s * (42.058_693 + s * -15.094_643));
    h * (std::f32::consts::TAU + s * (-41.341_7 + s * p))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps(from: f32, to: f32) -> impl Iterator<Item = f32> {
        (0..=200_000).map(move |i| from + (to - from) * i as f32 / 200_000.0)
    }

    #[test]
    fn sines_keep_their_bounds() {
        for x in steps(-2.0, 2.0) {
            let (sin, cos) = sin_cos_of_turn(x);
            let (real_sin, real_cos) = (std::f64::consts::TAU * f64::from(x)).sin_cos();
            assert!((f64::from(sin) - real_sin).abs() < 4e-7, "sin {x}");
            assert!((f64::from(cos) - real_cos).abs() < 4e-7, "cos {x}");
        }
        assert_eq!(sin_cos_of_turn(0.0), (0.0, sin_cos_of_turn(1.0).1));
    }

    #[test]
    fn powers_keep_their_bounds() {
        for x in steps(-30.0, 30.0) {
            assert!((exp2(x) / x.exp2() - 1.0).abs() < 4e-6, "{x}");
        }
        assert_eq!((exp2(0.0), exp2(3.0)), (1.0, 8.0));
        assert!(exp2(f32::NAN).is_finite() && exp2(f32::INFINITY).is_finite());
    }

    #[test]
    fn logarithms_keep_their_bounds() {
        for x in steps(1e-6, 4.0).chain(steps(1.0, 1e6)) {
            assert!((log2(x) - x.log2()).abs() < 3e-6 + x.log2().abs() * 2e-7, "{x}");
        }
        assert_eq!((log2(1.0), log2(4.0)), (0.0, 2.0));
        assert!(log2(0.0) <= -126.0 && log2(-1.0) <= -126.0 && log2(f32::NAN) <= -126.0);
    }

    #[test]
    fn a_highlight_is_as_sharp_as_its_exponent() {
        for p in [0.3, 1.0, 40.0, 500.0] {
            for x in steps(0.5, 1.0) {
                let error = (pow(x, p) - x.powf(p)).abs();
                assert!(error < 3e-6 * (p + 1.0) * x.powf(p) + 1e-30, "{x}^{p}");
            }
        }
        assert_eq!((pow(0.0, 0.5), pow(1.0, 7.0)), (0.0, 1.0));
    }

    #[test]
    fn whole_numbers_stay_as_they_are() {
        (-4_000_000..=4_000_000).step_by(17).for_each(|i| assert_eq!(whole(i as f32), i));
    }

    #[test]
    fn angles_keep_their_bound() {
        for x in steps(-1.0, 1.0) {
            assert!((acos(x) - x.acos()).abs() < 7.5e-5, "{x}");
        }
        assert!(acos(2.0) == 0.0 && acos(f32::NAN).is_finite());
    }

    #[test]
    fn directions_keep_their_bound() {
        for angle in steps(-0.9999, 0.9999).map(|t| t * std::f32::consts::PI) {
            let (y, x) = angle.sin_cos();
            for length in [1.0, 1e-9, 3e7] {
                assert!(
                    (atan2(y * length, x * length) - (y * length).atan2(x * length)).abs() < 6e-7,
                    "{angle}"
                );
            }
        }
        let sides = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0), (0.0, 0.0)];
        assert_eq!(sides.map(|(y, x)| atan2(y, x)), sides.map(|(y, x): (f32, f32)| y.atan2(x)));
    }

    #[test]
    fn tanh_keeps_its_bound_and_its_sign() {
        for x in steps(-12.0, 12.0) {
            assert!((tanh(x) - x.tanh()).abs() < 5e-7, "{x}");
            assert_eq!(tanh(-x), -tanh(x));
        }
        assert!(tanh(0.0) == 0.0 && tanh(1e9) <= 1.0 && tanh(f32::NAN).is_finite());
    }
}
