//! What the numbers of a document's colors mean: sRGB or Display P3, and how colors of one become
//! numbers of the other. Floor 0. Both have the transfer curve of sRGB and the same white, so only
//! the primaries differ: linear light goes through a matrix. Not here: ICC profiles (`io`).

#![warn(missing_docs)]

use super::fast::{max, min};
use super::srgb::{self, Color};
use std::sync::LazyLock;

crate::named! {
    /// The colors that a document's numbers mean. Both profiles have the same transfer curve and
    /// the same white.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum ColorProfile {
        /// IEC 61966-2-1.
        #[default]
        Srgb = "srgb" => ("sRGB", "What every screen shows"),
        /// SMPTE RP 431-2 primaries, the white and the curve of sRGB.
        DisplayP3 = "display-p3" => ("Display P3", "More saturated colors, as newer screens show them"),
    }
}

impl ColorProfile {
    /// The chromaticities x, y of red, green, blue and white.
    pub const fn chromaticities(self) -> [[f32; 2]; 4] {
        const D65: [f32; 2] = [0.3127, 0.3290];
        match self {
            Self::Srgb => [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06], D65],
            Self::DisplayP3 => [[0.68, 0.32], [0.265, 0.69], [0.15, 0.06], D65],
        }
    }

    /// How colors of this profile become numbers of another; `None` if they are the same.
    pub fn conversion_to(self, to: ColorProfile) -> Option<&'static ProfileConversion> {
        match (self, to) {
            (Self::Srgb, Self::DisplayP3) => Some(&TO_P3),
            (Self::DisplayP3, Self::Srgb) => Some(&TO_SRGB),
            _ => None,
        }
    }
}

static TO_P3: LazyLock<ProfileConversion> =
    LazyLock::new(|| ProfileConversion::new(ColorProfile::Srgb, ColorProfile::DisplayP3));
static TO_SRGB: LazyLock<ProfileConversion> =
    LazyLock::new(|| ProfileConversion::new(ColorProfile::DisplayP3, ColorProfile::Srgb));

/// Colors of one profile in the numbers of another. What the other cannot represent is clamped,
/// channel by channel.
#[derive(Clone, Debug, PartialEq)]
pub struct ProfileConversion {
    /// Of linear light.
    rows: [[f32; 3]; 3],
}

impl ProfileConversion {
    fn new(from: ColorProfile, to: ColorProfile) -> Self {
        let (from, to) = (xyz_of(from), inverse(xyz_of(to)));
        let entry = |r: usize, c: usize| (0..3).map(|k| to[r][k] * from[k][c]).sum::<f64>();
        // Grays stay: each row adds up to 1, whatever was rounded.
        let row = |r: usize| {
            let row: [f64; 3] = std::array::from_fn(|c| entry(r, c));
            let sum: f64 = row.iter().sum();
            row.map(|v| (v / sum) as f32)
        };
        Self { rows: std::array::from_fn(row) }
    }

    /// Linear light, which may be brighter than white; no channel of the result is below 0.
    #[inline(always)]
    pub fn light(&self, light: [f32; 3]) -> [f32; 3] {
        self.matrix(light).map(|v| max(v, 0.0))
    }

    #[inline(always)]
    fn matrix(&self, [r, g, b]: [f32; 3]) -> [f32; 3] {
        self.rows.map(|[x, y, z]| x * r + y * g + z * b)
    }

    /// An encoded color; each channel of the result is in `[0, 1]`.
    pub fn encoded(&self, color: [f32; 3]) -> [f32; 3] {
        self.encoded_noting(color, &mut false)
    }

    /// The same; `is_clamped` becomes true if the color lies outside of the other profile.
    fn encoded_noting(&self, color: [f32; 3], is_clamped: &mut bool) -> [f32; 3] {
        // Bytes that were rounded lie so far outside, and nothing is seen of that.
        const INSIDE: std::ops::RangeInclusive<f32> = -2.5e-3..=1.009;
        // Grays stay as they are, to the bit.
        if color[0] == color[1] && color[1] == color[2] {
            return color.map(|v| v.max(0.0).min(1.0));
        }
        let light = self.matrix(color.map(srgb::decode));
        *is_clamped |= light.iter().any(|v| !INSIDE.contains(v));
        light.map(|v| srgb::encode(v).max(0.0).min(1.0))
    }

    /// As [`ProfileConversion::encoded`], light that is brighter than white kept.
    pub fn encoded_bright(&self, color: [f32; 3]) -> [f32; 3] {
        self.light(color.map(srgb::decode)).map(srgb::encode)
    }

    /// Whether a color lies outside of the other profile, so that it is clamped.
    pub fn is_clamping(&self, color: Color) -> bool {
        let mut is_clamped = false;
        self.encoded_noting(rgb_of(color), &mut is_clamped);
        is_clamped
    }

    /// A color, its alpha kept.
    pub fn color(&self, color: Color) -> Color {
        let [r, g, b] = self.encoded(rgb_of(color)).map(srgb::quantize);
        Color { r, g, b, a: color.a }
    }

    /// Straight bytes; `is_clamped` becomes true if the color lies outside of the other profile.
    pub fn texel8(&self, [r, g, b, a]: [u8; 4], is_clamped: &mut bool) -> [u8; 4] {
        let color = [r, g, b].map(|v| f32::from(v) / 255.0);
        let [r, g, b] = self.encoded_noting(color, is_clamped).map(srgb::quantize);
        [r, g, b, a]
    }

    /// Straight values of 16 bits, likewise.
    pub fn texel16(&self, [r, g, b, a]: [u16; 4], is_clamped: &mut bool) -> [u16; 4] {
        let color = [r, g, b].map(|v| f32::from(v) / 65535.0);
        let [r, g, b] = self.encoded_noting(color, is_clamped).map(srgb::quantize16);
        [r, g, b, a]
    }

    /// Premultiplied bytes, row by row, for a screen: within 1/255 of what the exact conversion
    /// gives. See [`ProfileConversion::premultiplied`] for its twin.
    ///
    /// * `shown`: as many as `texels`.
    pub fn show(&self, texels: &[[u8; 4]], shown: &mut [[u8; 4]]) {
        for (texels, shown) in texels.chunks(LANES).zip(shown.chunks_mut(LANES)) {
            show_chunk(&self.rows, texels, shown);
        }
    }

    /// A premultiplied texel, exactly.
    pub fn premultiplied(&self, texel: [u8; 4]) -> [u8; 4] {
        self.premultiplied_noting(texel, &mut false)
    }

    /// The same; `is_clamped` becomes true if the color lies outside of the other profile.
    pub fn premultiplied_noting(&self, [r, g, b, a]: [u8; 4], is_clamped: &mut bool) -> [u8; 4] {
        if a == 0 {
            return [0; 4];
        }
        let alpha = f32::from(a) / 255.0;
        let straight = [r, g, b].map(|v| (f32::from(v) / f32::from(a)).min(1.0));
        let [r, g, b] =
            self.encoded_noting(straight, is_clamped).map(|v| srgb::quantize(v * alpha));
        [r, g, b, a]
    }
}

fn rgb_of(color: Color) -> [f32; 3] {
    let [r, g, b, _] = color.to_f32();
    [r, g, b]
}

/// Texels that are converted together.
const LANES: usize = 64;

crate::widest! {
    fn show_chunk(rows: &[[f32; 3]; 3], texels: &[[u8; 4]], shown: &mut [[u8; 4]]) {
        let mut packed = [0u32; LANES];
        for (packed, texel) in packed.iter_mut().zip(texels) {
            *packed = u32::from_le_bytes(*texel);
        }
        // Each step over all texels: whole loops become wide instructions.
        let (mut light, mut alpha, mut out) = ([[0.0f32; LANES]; 3], [0.0f32; LANES], [0u32; LANES]);
        for x in 0..LANES {
            alpha[x] = (packed[x] >> 24) as i32 as f32;
            out[x] = packed[x] & 0xff00_0000;
        }
        for (c, light) in light.iter_mut().enumerate() {
            for x in 0..LANES {
                let v = (packed[x] >> (8 * c) & 255) as i32 as f32;
                light[x] = srgb::decode_fast(min(v / max(alpha[x], 1.0), 1.0));
            }
        }
        for (c, row) in rows.iter().enumerate() {
            for x in 0..LANES {
                let v = row[0] * light[0][x] + row[1] * light[1][x] + row[2] * light[2][x];
                let encoded = srgb::encode_fast(min(max(v, 0.0), 1.0));
                let byte = u32::from(srgb::quantize(encoded * alpha[x] * (1.0 / 255.0)));
                out[x] |= byte << (8 * c);
            }
        }
        for (shown, out) in shown.iter_mut().zip(out) {
            *shown = out.to_le_bytes();
        }
    }
}

type Matrix = [[f64; 3]; 3];

/// XYZ of linear light: the columns are the primaries, as bright as white needs them.
fn xyz_of(profile: ColorProfile) -> Matrix {
    let [r, g, b, white] = profile.chromaticities().map(|[x, y]| {
        // The numbers as they are written, not as floats round them.
        let [x, y] = [x, y].map(|v| (f64::from(v) * 1e4).round() / 1e4);
        [x / y, 1.0, (1.0 - x - y) / y]
    });
    let columns: Matrix = std::array::from_fn(|i| [r[i], g[i], b[i]]);
    let back = inverse(columns);
    let gains: [f64; 3] = std::array::from_fn(|i| (0..3).map(|k| back[i][k] * white[k]).sum());
    columns.map(|row| std::array::from_fn(|c| row[c] * gains[c]))
}

fn inverse(m: Matrix) -> Matrix {
    let minor = |r: usize, c: usize| {
        let [r1, r2, c1, c2] = [(r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3];
        m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]
    };
    let determinant: f64 = (0..3).map(|c| m[0][c] * minor(0, c)).sum();
    std::array::from_fn(|r| std::array::from_fn(|c| minor(c, r) / determinant))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn to_srgb() -> &'static ProfileConversion {
        ColorProfile::DisplayP3.conversion_to(ColorProfile::Srgb).unwrap()
    }

    fn to_p3() -> &'static ProfileConversion {
        ColorProfile::Srgb.conversion_to(ColorProfile::DisplayP3).unwrap()
    }

    #[test]
    fn the_matrices_are_those_of_css_color_4() {
        // CSS Color 4, 18: lin_P3_to_XYZ, then XYZ_to_lin_sRGB.
        let expected = [
            [1.224_940_2, -0.224_940_18, 0.0],
            [-0.042_056_955, 1.042_057, 0.0],
            [-0.019_637_555, -0.078_636_05, 1.098_273_6],
        ];
        let there = &to_srgb().rows;
        for (found, expected) in there.as_flattened().iter().zip(expected.as_flattened()) {
            assert!((found - expected).abs() < 2e-6, "{there:?}");
        }
        for (r, row) in there.iter().enumerate() {
            for c in 0..3 {
                let other = to_p3().rows.map(|other| other[c]);
                let product: f32 = row.iter().zip(other).map(|(a, b)| a * b).sum();
                assert!((product - f32::from(u8::from(r == c))).abs() < 1e-6, "{r} {c}");
            }
        }
    }

    #[test]
    fn known_colors_have_their_numbers_and_grays_stay() {
        // CSS Color 4, examples of color(display-p3 …).
        assert_eq!(to_p3().color(Color::rgb(255, 0, 0)), Color::rgb(234, 51, 35));
        assert_eq!(to_p3().color(Color::rgb(0, 255, 0)), Color::rgb(117, 251, 76));
        assert_eq!(to_srgb().color(Color::rgb(255, 0, 0)), Color::rgb(255, 0, 0), "clamped");
        for v in 0..=255 {
            let gray = Color { r: v, g: v, b: v, a: v };
            assert_eq!((to_p3().color(gray), to_srgb().color(gray)), (gray, gray));
        }
        assert!(to_srgb().is_clamping(Color::rgb(255, 0, 0)));
        assert!(!to_srgb().is_clamping(Color::rgb(234, 51, 35)));
        assert!(!to_p3().is_clamping(Color::rgb(255, 0, 0)));
    }

    #[test]
    fn colors_of_both_profiles_come_back_within_two_levels() {
        let level = |i: u32| (i * 15) as u8;
        for i in 0..18 * 18 * 18 {
            let color = Color::rgb(level(i % 18), level(i / 18 % 18), level(i / 324));
            let back = to_srgb().color(to_p3().color(color));
            let off = [(color.r, back.r), (color.g, back.g), (color.b, back.b)];
            // Near 0 the curve is steep on one side and the matrix subtracts on the other.
            let most = if color.r.min(color.g).min(color.b) < 30 { 8 } else { 2 };
            assert!(off.iter().all(|(a, b)| a.abs_diff(*b) <= most), "{color} becomes {back}");
            let whole = [color.r, color.g, color.b, 255].map(|v| u16::from(v) * 257);
            let mut is_clamped = false;
            let fine = to_p3().texel16(whole, &mut is_clamped);
            let back = to_srgb().texel16(fine, &mut is_clamped);
            assert!(!is_clamped, "{color}");
            for (a, b) in back.iter().zip([color.r, color.g, color.b]) {
                assert!(a.abs_diff(u16::from(b) * 257) <= 24, "{color}: {back:?}");
            }
        }
    }

    #[test]
    fn what_a_screen_gets_is_the_exact_conversion_within_a_level() {
        let byte = |i: u32, k: u32| (super::super::hash::unit(i, k, 7) * 256.0) as u8;
        let texels: Vec<[u8; 4]> = (0..20_011u32)
            .map(|i| {
                let a = if i % 3 == 0 { byte(i, 3) } else { 255 };
                let of = |k: u32| (u32::from(byte(i, k)) * u32::from(a) / 255) as u8;
                [of(0), of(1), of(2), a]
            })
            .collect();
        for conversion in [to_srgb(), to_p3()] {
            let mut shown = vec![[9; 4]; texels.len()];
            conversion.show(&texels, &mut shown);
            for (texel, shown) in texels.iter().zip(&shown) {
                let exact = conversion.premultiplied(*texel);
                let near = (0..3).all(|c| exact[c].abs_diff(shown[c]) <= 1) && exact[3] == shown[3];
                assert!(near, "{texel:?}: {shown:?}, not {exact:?}");
            }
        }
        let mut gray = [[0; 4]; 1];
        for v in 0..=255 {
            to_srgb().show(&[[v, v, v, 255]], &mut gray);
            assert!((0..3).all(|c| gray[0][c].abs_diff(v) == 0), "{v}: {gray:?}");
        }
    }
}
