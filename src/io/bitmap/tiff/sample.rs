//! The number types of TIFF samples (bytes, 16-bit integers, floats) and their arithmetic.
//! Floor 5.

use crate::math::Size;
use image::{DynamicImage, ImageBuffer};

/// A number type of samples.
pub trait TiffSample: Copy {
    /// White for black.
    fn inverted(self) -> Self;
    /// A color that was multiplied by alpha.
    fn divided(self, alpha: Self) -> Self;
    /// Multiplied, white being 1.
    fn times(self, other: Self) -> Self;
    fn index(self) -> usize;
    /// One to four channels: gray or RGB, and alpha.
    fn image(size: Size, channels: usize, values: Vec<Self>) -> Option<DynamicImage>;
    /// `None` where this kind of number is not stored so.
    fn rgb_of_ycbcr(_: Vec<Self>) -> Option<Vec<Self>> {
        None
    }
}

/// As [`TiffSample::image`], for integers, which have variants of their own.
macro_rules! integer_image {
    ($luma:ident, $luma_a:ident, $rgb:ident, $rgba:ident) => {
        fn image(size: Size, channels: usize, values: Vec<Self>) -> Option<DynamicImage> {
            let (w, h) = (size.width, size.height);
            match channels {
                1 => ImageBuffer::from_raw(w, h, values).map(DynamicImage::$luma),
                2 => ImageBuffer::from_raw(w, h, values).map(DynamicImage::$luma_a),
                3 => ImageBuffer::from_raw(w, h, values).map(DynamicImage::$rgb),
                _ => ImageBuffer::from_raw(w, h, values).map(DynamicImage::$rgba),
            }
        }
    };
}

impl TiffSample for u8 {
    fn inverted(self) -> Self {
        255 - self
    }

    fn divided(self, alpha: Self) -> Self {
        let (c, a) = (u32::from(self), u32::from(alpha));
        if a == 0 { 0 } else { ((c * 255 + a / 2) / a).min(255) as u8 }
    }

    fn times(self, other: Self) -> Self {
        ((u32::from(self) * u32::from(other) + 127) / 255) as u8
    }

    fn index(self) -> usize {
        self.into()
    }
    integer_image!(ImageLuma8, ImageLumaA8, ImageRgb8, ImageRgba8);
    /// As in JPEG.
    fn rgb_of_ycbcr(values: Vec<Self>) -> Option<Vec<Self>> {
        let rgb = |[y, b, r]: [u8; 3]| {
            let (y, b, r) = (f32::from(y), f32::from(b) - 128.0, f32::from(r) - 128.0);
            let light = [y + 1.402 * r, y - 0.344_136 * b - 0.714_136 * r, y + 1.772 * b];
            light.map(|v| v.round().max(0.0).min(255.0) as u8)
        };
        Some(values.as_chunks().0.iter().flat_map(|ycc| rgb(*ycc)).collect())
    }
}

impl TiffSample for u16 {
    fn inverted(self) -> Self {
        65535 - self
    }

    fn divided(self, alpha: Self) -> Self {
        let (c, a) = (u64::from(self), u64::from(alpha));
        if a == 0 { 0 } else { ((c * 65535 + a / 2) / a).min(65535) as u16 }
    }

    fn times(self, other: Self) -> Self {
        ((u64::from(self) * u64::from(other) + 32767) / 65535) as u16
    }

    fn index(self) -> usize {
        self.into()
    }
    integer_image!(ImageLuma16, ImageLumaA16, ImageRgb16, ImageRgba16);
}

impl TiffSample for f32 {
    fn inverted(self) -> Self {
        1.0 - self
    }

    fn divided(self, alpha: Self) -> Self {
        if alpha > 0.0 { self / alpha } else { 0.0 }
    }

    fn times(self, other: Self) -> Self {
        self * other
    }

    fn index(self) -> usize {
        self.max(0.0) as usize
    }

    /// There is no gray of floats: it becomes RGB.
    fn image(size: Size, channels: usize, values: Vec<Self>) -> Option<DynamicImage> {
        let (w, h) = (size.width, size.height);
        let rgb = |gray: &[f32]| [&[gray[0]; 3], &gray[1..]].concat();
        match channels {
            1 | 2 => Self::image(
                size,
                channels + 2,
                values.chunks_exact(channels).flat_map(rgb).collect(),
            ),
            3 => ImageBuffer::from_raw(w, h, values).map(DynamicImage::ImageRgb32F),
            _ => ImageBuffer::from_raw(w, h, values).map(DynamicImage::ImageRgba32F),
        }
    }
}
