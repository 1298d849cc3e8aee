//! Pictures of more than 8 bits: PNG and TIFF of 16, EXR of half floats, from what was composed without rounding.
//! Floor 5.

use super::{ExportFormat, ExportOptions, png};
use crate::math::{Size, srgb};
use crate::{Error, Result};
use image::DynamicImage;
use std::io::Cursor;
use std::path::Path;

/// The bytes of a picture file, of pixels as [`crate::document::flatten_deep`] gives them; `file` is for messages.
///
/// Fails for formats of 8 bits.
pub fn encode(
    file: &Path,
    format: ExportFormat,
    pixels: &[[f32; 4]],
    canvas: Size,
    options: &ExportOptions,
) -> Result<Vec<u8>> {
    let rect = options.crop.map_or(canvas.rect(), |crop| crop.intersect(canvas.rect()));
    if rect.is_empty() || pixels.len() != canvas.area() {
        return Err(Error::unsupported(file, "the part to be written holds no pixels"));
    }
    let size = Size::new(rect.width() as u32, rect.height() as u32);
    let rows = pixels.chunks_exact(canvas.width as usize).skip(rect.y0 as usize).take(rect.height());
    let part = rows.flat_map(|row| row.iter().skip(rect.x0 as usize).take(rect.width()));
    let under = options.background.map_or([0.0; 4], |color| color.premultiplied());
    let part: Vec<[f32; 4]> = part.map(|&[r, g, b, a]| over([r, g, b, a], under)).collect();
    match format {
        ExportFormat::Png => {
            let values: Vec<u8> = part.iter().flat_map(straight16).flat_map(u16::to_be_bytes).collect();
            png([values].into_iter(), size, png::BitDepth::Sixteen, options).map_err(|e| Error::unsupported(file, e))
        }
        ExportFormat::Tiff => {
            let values = part.iter().flat_map(straight16).collect();
            let image = image::ImageBuffer::from_raw(size.width, size.height, values);
            tiff(file, image.map(DynamicImage::ImageRgba16))
        }
        ExportFormat::Exr => exr(size, |i| light(&part[i])).map_err(|e| Error::unsupported(file, e)),
        ExportFormat::Jpeg | ExportFormat::WebP => {
            Err(Error::unsupported(file, "this format has 8 bits a channel; PNG, TIFF and EXR have more"))
        }
    }
}

/// A premultiplied pixel over a colour.
fn over(p: [f32; 4], under: [f32; 4]) -> [f32; 4] {
    std::array::from_fn(|c| p[c] + under[c] * (1.0 - p[3]))
}

/// Straight alpha, 16 bits.
fn straight16(&[r, g, b, a]: &[f32; 4]) -> [u16; 4] {
    let to = |v: f32| (v.max(0.0).min(1.0) * 65535.0).round() as u16;
    let straight = |v: f32| if a > 0.0 { to(v / a) } else { 0 };
    [straight(r), straight(g), straight(b), to(a)]
}

/// A TIFF of an image, whatever its depth.
pub(super) fn tiff(file: &Path, image: Option<DynamicImage>) -> Result<Vec<u8>> {
    let mut bytes = Cursor::new(Vec::new());
    let image = image.ok_or_else(|| Error::unsupported(file, "the picture holds no pixels"))?;
    image.write_to(&mut bytes, image::ImageFormat::Tiff).map_err(|e| Error::unsupported(file, e))?;
    Ok(bytes.into_inner())
}

/// A half-float EXR of a picture, one part.
///
/// `light`: of the pixel with a number, row by row: linear, multiplied by alpha.
pub(super) fn exr(size: Size, light: impl Fn(usize) -> [f32; 4] + Sync) -> Result<Vec<u8>, exr::error::Error> {
    use exr::prelude::*;
    let width = size.width as usize;
    let channels = SpecificChannels::rgba(|at: Vec2<usize>| {
        let [r, g, b, a] = light(at.y() * width + at.x()).map(f16::from_f32);
        (r, g, b, a)
    });
    // Lines are written in order, so that the bytes do not depend on the threads.
    let encoding =
        Encoding { compression: Compression::ZIP16, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };
    let layer = Layer::new((width, size.height as usize), LayerAttributes::default(), encoding, channels);
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer).write().to_buffered(&mut bytes)?;
    Ok(bytes.into_inner())
}

/// Linear light, multiplied by alpha, of an encoded premultiplied pixel.
pub(super) fn light(&[r, g, b, a]: &[f32; 4]) -> [f32; 4] {
    let light = |v: f32| if a > 0.0 { srgb::decode((v / a).max(0.0).min(1.0)) * a } else { 0.0 };
    [light(r), light(g), light(b), a]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rect;
    use crate::{Budget, picture};

    /// A ramp finer than bytes.
    fn ramp() -> (Vec<[f32; 4]>, Size) {
        let size = Size::new(512, 2);
        ((0..1024).map(|i| [(i % 512) as f32 / 1022.0, 0.25, 0.0, 0.5]).collect(), size)
    }
    #[test]
    fn sixteen_bits_keep_what_eight_would_round() {
        let (pixels, size) = ramp();
        for (format, name) in [(ExportFormat::Png, "a.png"), (ExportFormat::Tiff, "a.tif")] {
            let bytes = encode(Path::new(name), format, &pixels, size, &ExportOptions::default()).unwrap();
            let image = image::load_from_memory(&bytes).unwrap().to_rgba16();
            let [r, g, b, a] = image.get_pixel(100, 1).0;
            assert_eq!([r, g, b, a], [(100.0 / 511.0 * 65535.0f32).round() as u16, 32768, 0, 32768], "{name}");
        }
    }
    #[test]
    fn an_exr_holds_linear_light_of_the_part_that_was_asked_for() {
        let (pixels, size) = ramp();
        let options = ExportOptions { crop: Some(Rect::new(100, 1, 200, 9)), ..ExportOptions::default() };
        let bytes = encode(Path::new("a.exr"), ExportFormat::Exr, &pixels, size, &options).unwrap();
        let read = picture::decode(Path::new("a.exr"), &bytes, &Budget::default()).unwrap();
        assert_eq!(read.size, Size::new(100, 1));
        let expected = srgb::decode(150.0 / 511.0);
        assert!((read.linear_at(50, 0)[0] - expected).abs() < 1e-3);
    }
}
