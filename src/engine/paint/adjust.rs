//! Adjustments of a placed picture, which convey material: blur for gloss, color for the base.
//! Floor 3.

use crate::math::{Mat3, Size, Vec3, srgb, vec3};
use crate::raster::picture::Texels;
use crate::raster::planar::BRIGHTEST;
use crate::raster::{Picture, blur};

/// Applied in this order: blur, exposure (linear light), then hue, saturation, brightness, contrast
/// (encoded values).
///
/// The last four are those of W3C Filter Effects Module 1, so that a picture looks as it does in a
/// browser.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adjust {
    /// Standard deviation of a Gaussian, in texels of the picture, `≥ 0`.
    pub blur: f32,
    /// Stops: linear light is multiplied by 2^exposure.
    pub exposure: f32,
    /// Rotation of the hue, degrees.
    pub hue: f32,
    /// Factor of the distance from gray, `≥ 0`; 1 leaves it.
    pub saturation: f32,
    /// Factor of the encoded value, `≥ 0`; 1 leaves it.
    pub brightness: f32,
    /// Factor of the distance from mid gray (0.5), `≥ 0`; 1 leaves it.
    pub contrast: f32,
}

impl Adjust {
    /// What its blur may be, px.
    pub const BLUR: crate::math::Range = 0.0..=4096.0;
    /// The factors of saturation, brightness and contrast.
    pub const FACTOR: crate::math::Range = 0.0..=100.0;
}

impl Default for Adjust {
    fn default() -> Self {
        Self { blur: 0.0, exposure: 0.0, hue: 0.0, saturation: 1.0, brightness: 1.0, contrast: 1.0 }
    }
}

impl Adjust {
    /// The adjusted picture, of the same size and kind of light. An adjustment that changes nothing
    /// returns the same texels.
    ///
    /// Display-referred pictures are blurred on their encoded values, as layers are blended, and
    /// clipped once, at the end. Scene-referred ones stay linear through blur and exposure and keep
    /// light above white throughout, so that lowering the brightness recovers the disc of the sun.
    pub fn apply(&self, picture: &Picture) -> Picture {
        if *self == Self::default() {
            return picture.clone();
        }
        let is_linear = matches!(picture.texels, Texels::Linear(_));
        let texels = self.adjusted(picture.size, floats(&picture.texels), is_linear);
        let adjusted = if is_linear {
            Picture::linear(picture.size, texels)
        } else {
            Picture::srgb8(
                picture.size,
                texels.into_iter().map(|t| t.map(srgb::quantize)).collect(),
            )
        };
        adjusted.unwrap_or_else(|| picture.clone())
    }

    /// The texels of the adjusted picture without rounding, from 16 bits if it has them: straight,
    /// encoded, with light that is brighter than white above 1.
    pub fn apply_in_floats(&self, picture: &Picture) -> Vec<[f32; 4]> {
        let is_linear = matches!(picture.texels, Texels::Linear(_));
        let mut texels = match &picture.texels16 {
            Some(texels16) => texels16.iter().map(|t| t.map(|v| f32::from(v) / 65535.0)).collect(),
            None => floats(&picture.texels),
        };
        if *self != Self::default() {
            texels = self.adjusted(picture.size, texels, is_linear);
        }
        for [r, g, b, a] in &mut texels {
            for v in [r, g, b] {
                *v = if is_linear { srgb::encode(*v) } else { *v }.max(0.0).min(BRIGHTEST);
            }
            *a = a.max(0.0).min(1.0);
        }
        texels
    }

    /// Straight texels in their own kind of light.
    fn adjusted(&self, size: Size, mut texels: Vec<[f32; 4]>, is_linear: bool) -> Vec<[f32; 4]> {
        if self.blur > 0.0 {
            texels = blurred(size, texels, self.blur);
        }
        let tone = TexelAdjust::new(self, is_linear);
        for t in &mut texels {
            *t = tone.apply(*t);
        }
        texels
    }
}

/// Straight texels as they are stored, bytes in `[0, 1]`.
fn floats(texels: &Texels) -> Vec<[f32; 4]> {
    match texels {
        Texels::Srgb8(t) => t.iter().map(|t| t.map(|v| f32::from(v) / 255.0)).collect(),
        Texels::Linear(t) => t.to_vec(),
    }
}

/// The adjustments of single texels, precomputed.
struct TexelAdjust {
    is_linear: bool,
    /// Factor of linear light.
    exposure: f32,
    /// For encoded color: hue, then saturation, then brightness and contrast; `None` is the
    /// identity.
    encoded: Option<(Mat3, Vec3)>,
}

impl TexelAdjust {
    fn new(adjust: &Adjust, is_linear: bool) -> Self {
        let Adjust { hue, saturation, brightness, contrast, .. } = *adjust;
        let identity = hue == 0.0 && saturation == 1.0 && brightness == 1.0 && contrast == 1.0;
        let matrix =
            contrast * brightness * (saturation_matrix(saturation) * hue_matrix(hue.to_radians()));
        let offset = Vec3::splat(0.5 - 0.5 * contrast);
        Self {
            is_linear,
            exposure: adjust.exposure.exp2(),
            encoded: (!identity).then_some((matrix, offset)),
        }
    }

    /// Straight alpha, in the picture's own kind of light.
    fn apply(&self, [r, g, b, a]: [f32; 4]) -> [f32; 4] {
        let mut c = vec3(r, g, b);
        let mut linear = self.is_linear;
        if self.exposure != 1.0 {
            if !linear {
                c = map(c, srgb::decode);
                linear = true;
            }
            c *= self.exposure;
        }
        if let Some((matrix, offset)) = self.encoded {
            if linear {
                c = map(c, srgb::encode);
                linear = false;
            }
            c = matrix * c + offset;
        }
        let c = match (linear, self.is_linear) {
            (true, false) => map(c, srgb::encode),
            (false, true) => map(c, srgb::decode),
            _ => c,
        };
        [c.x, c.y, c.z, a]
    }
}

fn map(v: Vec3, f: impl Fn(f32) -> f32) -> Vec3 {
    vec3(f(v.x), f(v.y), f(v.z))
}

/// Each column weighs one channel of the luminance, so `M c` is the gray of `c` (Rec. 709, on
/// encoded values).
fn gray_matrix() -> Mat3 {
    Mat3::from_cols(Vec3::splat(0.2126), Vec3::splat(0.7152), Vec3::splat(0.0722))
}

/// Gray plus `factor` times the distance from it.
fn saturation_matrix(factor: f32) -> Mat3 {
    gray_matrix() * (1.0 - factor) + Mat3::IDENTITY * factor
}

/// Turns the colors about the gray axis, keeping the gray of each (Filter Effects, `hue-rotate`).
///
/// gray + cos · (identity − gray) + sin · S, where S turns by a quarter.
fn hue_matrix(angle: f32) -> Mat3 {
    let gray = gray_matrix();
    let quarter = Mat3::from_cols(
        vec3(-0.213, 0.143, -0.787),
        vec3(-0.715, 0.140, 0.715),
        vec3(0.928, -0.283, 0.072),
    );
    gray + (Mat3::IDENTITY - gray) * angle.cos() + quarter * angle.sin()
}

/// A Gaussian blur of premultiplied values, so that color under transparent texels does not
/// spread.
fn blurred(size: Size, mut texels: Vec<[f32; 4]>, sigma: f32) -> Vec<[f32; 4]> {
    for t in &mut texels {
        *t = [t[0] * t[3], t[1] * t[3], t[2] * t[3], t[3]];
    }
    let mut texels = blur::gaussian_pixels(size, &texels, sigma);
    for t in &mut texels {
        let a = t[3];
        *t = if a > 0.0 { [t[0] / a, t[1] / a, t[2] / a, a] } else { [0.0; 4] };
    }
    texels
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    fn gradient_picture() -> Picture {
        let texels = (0..64 * 48)
            .map(|i| [(i % 64 * 4) as u8, (i / 64 * 5) as u8, 90, 255 - (i % 7) as u8 * 30]);
        Picture::srgb8(Size::new(64, 48), texels.collect()).unwrap()
    }

    fn one(adjust: Adjust, texel: [u8; 4]) -> [u8; 4] {
        match adjust.apply(&Picture::srgb8(Size::new(1, 1), vec![texel]).unwrap()).texels {
            Texels::Srgb8(t) => t[0],
            Texels::Linear(_) => unreachable!(),
        }
    }

    #[test]
    fn adjusting_nothing_returns_the_same_texels() {
        let picture = gradient_picture();
        let (Texels::Srgb8(a), Texels::Srgb8(b)) =
            (&Adjust::default().apply(&picture).texels, &picture.texels)
        else {
            unreachable!()
        };
        assert!(Arc::ptr_eq(a, b));
    }

    #[test]
    fn one_stop_doubles_linear_light() {
        let adjust = Adjust { exposure: 1.0, ..Adjust::default() };
        // 128 decodes to 0.215861; twice that encodes to 0.689158 = 175.7 bytes.
        assert_eq!(one(adjust, [128, 0, 255, 77]), [176, 0, 255, 77]);
    }

    #[test]
    fn saturation_zero_is_the_luma_and_contrast_turns_about_mid_gray() {
        let gray = one(Adjust { saturation: 0.0, ..Adjust::default() }, [255, 0, 0, 255]);
        assert_eq!(gray, [54, 54, 54, 255]);
        assert_eq!(
            one(Adjust { contrast: 0.0, ..Adjust::default() }, [9, 200, 77, 255]),
            [128, 128, 128, 255]
        );
        assert_eq!(
            one(Adjust { contrast: 2.0, ..Adjust::default() }, [100, 130, 250, 255]),
            [73, 133, 255, 255]
        );
        assert_eq!(
            one(Adjust { brightness: 0.5, ..Adjust::default() }, [100, 130, 250, 9]),
            [50, 65, 125, 9]
        );
    }

    #[test]
    fn a_full_turn_of_the_hue_changes_nothing_and_grays_never_turn() {
        let red = [200, 40, 30, 255];
        let turned = one(Adjust { hue: 360.0, ..Adjust::default() }, red);
        assert!((0..4).all(|c| turned[c].abs_diff(red[c]) <= 1), "{turned:?}");
        let gray = one(Adjust { hue: 77.0, ..Adjust::default() }, [120, 120, 120, 255]);
        assert!(gray[..3].iter().all(|v| v.abs_diff(120) <= 1), "{gray:?}");
        let [r, g, ..] = one(Adjust { hue: 120.0, ..Adjust::default() }, red);
        assert!(g > r, "a third of a turn from red is green");
    }

    #[test]
    fn light_above_white_comes_back_when_it_is_lowered() {
        let picture = Picture::linear(Size::new(1, 1), vec![[4.0, 1.0, 0.25, 1.0]]).unwrap();
        let Texels::Linear(t) =
            Adjust { exposure: -2.0, ..Adjust::default() }.apply(&picture).texels
        else {
            unreachable!()
        };
        assert_eq!(t[0], [1.0, 0.25, 0.0625, 1.0]);
        let Texels::Linear(t) =
            Adjust { brightness: 0.5, ..Adjust::default() }.apply(&picture).texels
        else {
            unreachable!()
        };
        assert!((srgb::encode(t[0][0]) - srgb::encode(4.0) * 0.5).abs() < 1e-4);
    }

    #[test]
    fn blurring_keeps_the_mean_and_spreads_no_hidden_color() {
        let size = Size::new(40, 40);
        // Green is hidden under alpha 0 in the left half.
        let texels = (0..1600)
            .map(|i| if i % 40 < 20 { [0, 255, 0, 0] } else { [255, 0, 0, 255] })
            .collect();
        let picture = Picture::srgb8(size, texels).unwrap();
        let Texels::Srgb8(t) = Adjust { blur: 4.0, ..Adjust::default() }.apply(&picture).texels
        else {
            unreachable!()
        };
        assert!(t.iter().all(|t| t[1] == 0), "green leaked");
        let alpha = t.iter().map(|t| f64::from(t[3])).sum::<f64>() / 1600.0;
        assert!((alpha - 127.5).abs() < 1.5, "{alpha}");
        let edge = t[20 * 40 + 20][3];
        assert!((135..=145).contains(&edge), "half a texel inside the edge: {edge}");
    }

    #[test]
    fn hostile_figures_give_finite_texels() {
        for v in [f32::NAN, f32::INFINITY, -1e30, 1e30] {
            let adjust =
                Adjust { blur: v, exposure: v, hue: v, saturation: v, brightness: v, contrast: v };
            adjust.apply(&gradient_picture());
            let hdr =
                Picture::linear(Size::new(2, 1), vec![[1.0, 2.0, 0.0, 1.0], [0.5, 0.0, 9.0, 0.5]])
                    .unwrap();
            let Texels::Linear(t) = adjust.apply(&hdr).texels else { unreachable!() };
            assert!(t.iter().flatten().all(|v| v.is_finite()));
        }
    }
}
