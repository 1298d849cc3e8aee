//! Gaussian blur of any width: exact taps for narrow ones, a recursive filter whose cost does not
//! grow for wide ones. Floor 1. Not here: the blur of normals along a surface, which stops at depth
//! jumps (`surface::curvature`).

use super::Plane;
use crate::math::{Size, parallel};

/// What the filter finds beyond the picture.
#[derive(Clone, Copy, PartialEq)]
enum BlurBorder {
    /// The border's value, repeated.
    Border,
    /// 0: sums lose weight, and dividing by the blurred mask restores it.
    Nothing,
}

/// Blurs a map; its border value is repeated beyond the border. `sigma_px`: standard deviation; 0
/// and below change nothing.
pub fn gaussian(plane: &Plane<f32>, sigma_px: f32) -> Plane<f32> {
    let (pixels, _) = plane.values().as_chunks::<1>();
    let blurred = gaussian_pixels(plane.size(), pixels, sigma_px);
    Plane::from_values(plane.size(), blurred.into_flattened()).expect("one value per pixel")
}

/// Blurs the values under a mask without mixing in what is outside: Σ w·m·v / Σ w·m, and 0 where
/// the mask is far away.
///
/// `mask`: weights in `[0, 1]`, of the map's size (what they do not share counts as outside).
pub fn gaussian_masked(plane: &Plane<f32>, mask: &Plane<f32>, sigma_px: f32) -> Plane<f32> {
    let weighted: Vec<[f32; 2]> = (0..plane.size().area())
        .map(|i| {
            let m = if mask.size() == plane.size() { mask.values()[i] } else { 0.0 };
            [m * plane.values()[i], m]
        })
        .collect();
    let blurred = blurred(plane.size(), &weighted, sigma_px, BlurBorder::Nothing);
    // Below a thousandth of the weight only the filter's own error would be divided.
    let values = blurred.iter().map(|&[v, m]| if m > 1e-3 { v / m } else { 0.0 }).collect();
    Plane::from_values(plane.size(), values).expect("one value per pixel")
}

/// Blurs pixels of `N` values each (RGBA: premultiplied), row by row; the border pixel is repeated
/// beyond the border.
///
/// Returns the pixels unchanged if `sigma_px` is not above 0 or `pixels` are not one per pixel of
/// `size`.
pub fn gaussian_pixels<const N: usize>(
    size: Size,
    pixels: &[[f32; N]],
    sigma_px: f32,
) -> Vec<[f32; N]> {
    blurred(size, pixels, sigma_px, BlurBorder::Border)
}

/// Blurs pixels by a Gaussian of a variance, px²; beyond the border there is nothing, so that sums
/// lose weight: a weight among the values gives it back. Returns them unchanged as
/// [`gaussian_pixels`] does.
pub fn spread_pixels<const N: usize>(
    size: Size,
    pixels: &[[f32; N]],
    variance: f32,
) -> Vec<[f32; N]> {
    /// Narrower Gaussians are too narrow to be sampled: three pixels of the same variance replace
    /// them.
    const SAMPLED: f32 = 0.64;
    if variance > 0.0 && variance < SAMPLED && pixels.len() == size.area() && N > 0 {
        return blur_pass(
            size,
            pixels,
            &Gaussian::Taps(vec![1.0 - variance, 0.5 * variance]),
            BlurBorder::Nothing,
        );
    }
    blurred(size, pixels, variance.max(0.0).sqrt(), BlurBorder::Nothing)
}

fn blurred<const N: usize>(
    size: Size,
    pixels: &[[f32; N]],
    sigma_px: f32,
    beyond: BlurBorder,
) -> Vec<[f32; N]> {
    if sigma_px.is_nan() || sigma_px <= 0.0 || pixels.len() != size.area() || N == 0 {
        return pixels.to_vec();
    }
    blur_pass(size, pixels, &Gaussian::new(sigma_px.min(4.0 * size.longer_side().max(1.0))), beyond)
}

fn blur_pass<const N: usize>(
    size: Size,
    pixels: &[[f32; N]],
    filter: &Gaussian,
    beyond: BlurBorder,
) -> Vec<[f32; N]> {
    let (w, h) = (size.width as usize, size.height as usize);
    // Each pass blurs down the columns and transposes the result.
    let sideways = down_columns(pixels, w, h, filter, beyond);
    down_columns(&sideways, h, w, filter, beyond)
}

/// Floats filtered together: a cache line, two AVX registers.
const LANES: usize = 16;

/// A strip of columns: rows of `LANES` floats.
type ColumnStrip = Vec<[f32; LANES]>;

/// Blurs the columns of `width · height` pixels; the result is transposed, `height · width`.
fn down_columns<const N: usize>(
    pixels: &[[f32; N]],
    width: usize,
    height: usize,
    filter: &Gaussian,
    beyond: BlurBorder,
) -> Vec<[f32; N]> {
    let mut out = vec![[0.0; N]; pixels.len()];
    let across = (LANES / N).max(1);
    let blur_strip = |(strip, result): &mut (ColumnStrip, ColumnStrip),
                      (i, out): (usize, &mut [[f32; N]])| {
        let columns = i * across..(i * across + across).min(width);
        for lanes in (0..N * columns.len()).step_by(LANES) {
            let lanes = lanes..(lanes + LANES).min(N * columns.len());
            strip.clear();
            strip.extend(pixels.chunks_exact(width).map(|row| {
                let mut line = [0.0; LANES];
                let floats = &row[columns.clone()].as_flattened()[lanes.clone()];
                line[..floats.len()].copy_from_slice(floats);
                line
            }));
            filter.apply(strip, beyond, result);
            for (lane, float) in lanes.enumerate() {
                let column = &mut out[float / N * height..][..height];
                for (pixel, line) in column.iter_mut().zip(result.iter()) {
                    pixel[float % N] = line[lane];
                }
            }
        }
    };
    // This runs on one thread: a worker that waited for others could be given a tile that waits for
    // this same blur.
    if rayon::current_thread_index().is_some() {
        let mut buffers = (ColumnStrip::new(), ColumnStrip::new());
        out.chunks_mut(across * height)
            .enumerate()
            .for_each(|strip| blur_strip(&mut buffers, strip));
    } else {
        let strips = out.chunks_mut(across * height).enumerate();
        let buffers = || (ColumnStrip::new(), ColumnStrip::new());
        parallel::for_each_with(strips, 1, buffers, blur_strip);
    }
    out
}

/// A one-dimensional Gaussian.
enum Gaussian {
    /// Weights at distances 0, 1, …
    Taps(Vec<f32>),
    /// Two damped oscillations; see [`GaussianPole`].
    Poles([GaussianPole; 2]),
}

/// One term of Deriche's fourth-order approximation of a Gaussian (INRIA report 1893, 1993): Re(a
/// pⁿ) at distance n, a and p complex.
///
/// Run as first-order recursions, each term keeps its accuracy in f32 however wide the Gaussian is.
#[derive(Clone, Copy)]
struct GaussianPole {
    a: (f32, f32),
    p: (f32, f32),
    /// The state after infinitely many ones: 1 / (1 − p).
    rest: (f32, f32),
}

impl Gaussian {
    /// From here on the taps cost more than the recursion.
    const WIDEST_TAPS_PX: f32 = 4.0;

    fn new(sigma_px: f32) -> Self {
        if sigma_px <= Self::WIDEST_TAPS_PX {
            Self::Taps(half_kernel(sigma_px))
        } else {
            Self::poles(sigma_px)
        }
    }

    fn poles(sigma_px: f32) -> Self {
        // (1.68 cos(0.6318 t) + 3.735 sin(0.6318 t)) e^(−1.783 t) − (0.6803 cos(1.997 t) + 0.2598
        // sin(1.997 t)) e^(−1.723 t)
        let terms = [((1.68, -3.735), (1.783, 0.6318)), ((-0.6803, 0.2598), (1.723, 1.997))];
        let poles = terms.map(|((re, im), (decay, frequency))| {
            let s = f64::from(sigma_px);
            let (sin, cos) = (frequency / s).sin_cos();
            let p = ((-decay / s).exp() * cos, (-decay / s).exp() * sin);
            let norm = (1.0 - p.0).powi(2) + p.1 * p.1;
            let rest = ((1.0 - p.0) / norm, p.1 / norm);
            // Σ over both sides of Re(a pⁿ): Re(a (2 rest − 1)).
            let weight = re * (2.0 * rest.0 - 1.0) - im * 2.0 * rest.1;
            ((re, im), p, rest, weight)
        });
        let sum: f64 = poles.iter().map(|&(.., weight)| weight).sum();
        let narrow = |(re, im): (f64, f64)| (re as f32, im as f32);
        Self::Poles(poles.map(|((re, im), p, rest, _)| GaussianPole {
            a: narrow((re / sum, im / sum)),
            p: narrow(p),
            rest: narrow(rest),
        }))
    }

    /// Filters every lane of a strip; `out` gets as many rows.
    fn apply(&self, strip: &[[f32; LANES]], beyond: BlurBorder, out: &mut ColumnStrip) {
        out.clear();
        out.resize(strip.len(), [0.0; LANES]);
        match self {
            Gaussian::Taps(taps) => apply_taps(strip, taps, beyond, out),
            Gaussian::Poles(poles) => apply_poles(strip, poles, beyond, out),
        }
    }
}

/// The weights of a Gaussian at distances 0, 1, … up to four standard deviations (6e-5 of the
/// weight lies beyond); with their mirror image they add up to 1. `sigma_px ≥ 0`; 0 gives the
/// single weight 1.
pub fn half_kernel(sigma_px: f32) -> Vec<f32> {
    let radius = (4.0 * sigma_px).ceil() as usize;
    let weight = |k: usize| {
        if k == 0 { 1.0 } else { (-0.5 * (k as f64 / f64::from(sigma_px)).powi(2)).exp() }
    };
    let sum: f64 = 1.0 + 2.0 * (1..=radius).map(weight).sum::<f64>();
    (0..=radius).map(|k| (weight(k) / sum) as f32).collect()
}

crate::widest! {
    /// Σ_k w_k (strip[y − k] + strip[y + k]).
    fn apply_taps(strip: &[[f32; LANES]], taps: &[f32], beyond: BlurBorder, out: &mut [[f32; LANES]]) {
        let (n, reach) = (strip.len(), taps.len() - 1);
        let nothing = [0.0; LANES];
        for y in 0..n {
            let mut sum = strip[y];
            for v in &mut sum {
                *v *= taps[0];
            }
            if reach <= y && y + reach < n {
                let (before, behind) = (&strip[y - reach..y], &strip[y + 1..=y + reach]);
                for ((a, b), w) in before.iter().rev().zip(behind).zip(&taps[1..]) {
                    for l in 0..LANES {
                        sum[l] += w * (a[l] + b[l]);
                    }
                }
            } else {
                let is_read = |inside: bool| inside || beyond == BlurBorder::Border;
                for (k, &w) in taps.iter().enumerate().skip(1) {
                    let above = if is_read(y >= k) { &strip[y.saturating_sub(k)] } else { &nothing };
                    let beneath = if is_read(y + k < n) { &strip[(y + k).min(n - 1)] } else { &nothing };
                    for l in 0..LANES {
                        sum[l] += w * (above[l] + beneath[l]);
                    }
                }
            }
            out[y] = sum;
        }
    }

    /// Σ_n Re(a pⁿ) over both sides, as one recursion down and one up.
    fn apply_poles(strip: &[[f32; LANES]], poles: &[GaussianPole; 2], beyond: BlurBorder, out: &mut [[f32; LANES]]) {
        let (Some(first), Some(last)) = (strip.first(), strip.last()) else { return };
        let mut down = poles.map(|p| RecursionState::resting(p, first, beyond));
        for (line, out) in strip.iter().zip(out.iter_mut()) {
            for (state, pole) in down.iter_mut().zip(poles) {
                // s ← x + p s
                state.advance(pole);
                state.add(line);
                state.add_to(pole, out);
            }
        }
        let mut up = poles.map(|p| RecursionState::resting(p, last, beyond));
        for (line, out) in strip.iter().zip(out.iter_mut()).rev() {
            for (state, pole) in up.iter_mut().zip(poles) {
                // s ← p s, then the pixel itself for those above: distance 0 was counted on the way
                // down.
                state.advance(pole);
                state.add_to(pole, out);
                state.add(line);
            }
        }
    }
}

/// The complex state of one recursion, lane by lane.
struct RecursionState {
    re: [f32; LANES],
    im: [f32; LANES],
}

impl RecursionState {
    /// Starts as if `line` had been repeated forever, or as if there had been nothing.
    #[inline(always)]
    fn resting(pole: GaussianPole, line: &[f32; LANES], beyond: BlurBorder) -> Self {
        let (mut re, mut im) = ([0.0; LANES], [0.0; LANES]);
        if beyond == BlurBorder::Border {
            for l in 0..LANES {
                re[l] = pole.rest.0 * line[l];
                im[l] = pole.rest.1 * line[l];
            }
        }
        Self { re, im }
    }

    #[inline(always)]
    fn add(&mut self, line: &[f32; LANES]) {
        for (re, v) in self.re.iter_mut().zip(line) {
            *re += v;
        }
    }

    #[inline(always)]
    fn advance(&mut self, pole: &GaussianPole) {
        for l in 0..LANES {
            let (re, im) = (self.re[l], self.im[l]);
            self.re[l] = pole.p.0 * re - pole.p.1 * im;
            self.im[l] = pole.p.0 * im + pole.p.1 * re;
        }
    }

    #[inline(always)]
    fn add_to(&self, pole: &GaussianPole, out: &mut [f32; LANES]) {
        for ((out, re), im) in out.iter_mut().zip(&self.re).zip(&self.im) {
            *out += pole.a.0 * re - pole.a.1 * im;
        }
    }
}

#[cfg(test)]
mod tests;
