//! One channel of a map, no wider in memory than in its file.
//! Floor 5.

use crate::math::Size;
use crate::raster::Plane;
use image::DynamicImage;
use rayon::prelude::*;

/// The numbers of a channel: `[0, 1]` of integers, as they are of floats.
#[derive(Clone)]
pub enum Channel {
    Byte(Plane<u8>),
    Word(Plane<u16>),
    Float(Plane<f32>),
}

impl Channel {
    /// The number of a pixel.
    #[inline(always)]
    pub fn at(&self, i: usize) -> f32 {
        match self {
            Channel::Byte(plane) => f32::from(plane.values()[i]) / 255.0,
            Channel::Word(plane) => f32::from(plane.values()[i]) / 65535.0,
            Channel::Float(plane) => plane.values()[i],
        }
    }

    /// The number of each pixel turned into something.
    pub fn map<T: Copy + Send + Sync + Default>(&self, f: impl Fn(f32) -> T + Sync) -> Plane<T> {
        let size = self.size();
        Plane::from_fn(size, |x, y| f(self.at(y * size.width as usize + x)))
    }

    /// Removes the pixels from a set whose numbers `is` rejects; `is` is called once per number of
    /// an integer file.
    pub fn keep_where(&self, set: &mut Plane<bool>, is: impl Fn(f32) -> bool + Sync) {
        fn keep<T: Copy + Sync>(
            set: &mut Plane<bool>,
            plane: &Plane<T>,
            is: impl Fn(T) -> bool + Sync,
        ) {
            let rows = plane.values().par_chunks(plane.width().max(1));
            set.values_mut().par_chunks_mut(plane.width().max(1)).zip(rows).for_each(
                |(set, row)| {
                    set.iter_mut().zip(row).for_each(|(kept, v)| *kept &= is(*v));
                },
            );
        }
        match self {
            Channel::Byte(plane) => {
                let known: Vec<bool> = (0..=u8::MAX).map(|v| is(f32::from(v) / 255.0)).collect();
                keep(set, plane, |v| known[usize::from(v)]);
            }
            Channel::Word(plane) => {
                let known: Vec<bool> = (0..=u16::MAX).map(|v| is(f32::from(v) / 65535.0)).collect();
                keep(set, plane, |v| known[usize::from(v)]);
            }
            Channel::Float(plane) => keep(set, plane, is),
        }
    }

    fn size(&self) -> Size {
        match self {
            Channel::Byte(plane) => plane.size(),
            Channel::Word(plane) => plane.size(),
            Channel::Float(plane) => plane.size(),
        }
    }

    /// Some number is below 1.
    pub fn is_below_one(&self) -> bool {
        match self {
            Channel::Byte(plane) => plane.values().iter().any(|&v| v < u8::MAX),
            Channel::Word(plane) => plane.values().iter().any(|&v| v < u16::MAX),
            Channel::Float(plane) => plane.values().iter().any(|&v| v < 1.0),
        }
    }
}

/// The channels of an image, gray as one, alpha last where there is one.
pub fn channels(image: DynamicImage) -> Vec<Channel> {
    let size = Size::new(image.width(), image.height());
    match image {
        DynamicImage::ImageLuma8(v) => split_channels(size, &v.into_raw(), 1, Channel::Byte),
        DynamicImage::ImageLumaA8(v) => split_channels(size, &v.into_raw(), 2, Channel::Byte),
        DynamicImage::ImageRgb8(v) => split_channels(size, &v.into_raw(), 3, Channel::Byte),
        DynamicImage::ImageRgba8(v) => split_channels(size, &v.into_raw(), 4, Channel::Byte),
        DynamicImage::ImageLuma16(v) => split_channels(size, &v.into_raw(), 1, Channel::Word),
        DynamicImage::ImageLumaA16(v) => split_channels(size, &v.into_raw(), 2, Channel::Word),
        DynamicImage::ImageRgb16(v) => split_channels(size, &v.into_raw(), 3, Channel::Word),
        DynamicImage::ImageRgba16(v) => split_channels(size, &v.into_raw(), 4, Channel::Word),
        DynamicImage::ImageRgb32F(v) => split_channels(size, &v.into_raw(), 3, Channel::Float),
        image if image.color().has_alpha() => {
            split_channels(size, &image.into_rgba32f().into_raw(), 4, Channel::Float)
        }
        image => split_channels(size, &image.into_rgb32f().into_raw(), 3, Channel::Float),
    }
}

fn split_channels<T: Copy + Send + Sync + Default>(
    size: Size,
    values: &[T],
    per_pixel: usize,
    channel: impl Fn(Plane<T>) -> Channel,
) -> Vec<Channel> {
    let width = size.width as usize;
    let plane = |c: usize| Plane::from_fn(size, |x, y| values[(y * width + x) * per_pixel + c]);
    (0..per_pixel).map(|c| channel(plane(c))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_that_floats_of_the_image_have() {
        let words: Vec<u16> = (0..65536).map(|v| v as u16).collect();
        let wide =
            DynamicImage::ImageRgba16(image::ImageBuffer::from_raw(128, 128, words).unwrap());
        let narrow = DynamicImage::ImageLumaA8(
            image::ImageBuffer::from_raw(128, 1, (0..=255).collect()).unwrap(),
        );
        for image in [wide, narrow] {
            let held = channels(image.clone());
            let floats = image.to_rgba32f().into_raw();
            let (first, last) = (&held[0], &held[held.len() - 1]);
            for (i, texel) in floats.as_chunks::<4>().0.iter().enumerate() {
                // The image library rounds once more.
                let is_near = |a: f32, b: f32| (a - b).abs() <= f32::EPSILON;
                assert!(
                    is_near(first.at(i), texel[0]) && is_near(last.at(i), texel[3]),
                    "{i}: {texel:?}"
                );
            }
        }
    }
}
