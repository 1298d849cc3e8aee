//! Pictures of more than 8 bits: PNG and TIFF of 16, EXR of half floats or whole ones, from what
//! was composed without rounding. Floor 5.

use super::{ExportFormat, ExportOptions, name_profile, png};
use crate::document::{
    Document, Highlights, Progress, flatten, flatten_rounding_once, flatten_to_floats,
};
use crate::math::{ColorProfile, ProfileConversion, Size, srgb};
use crate::project::Cancelable;
use crate::raster::TileGrid;
use crate::{Budget, Error, Result};
use image::DynamicImage;
use rayon::prelude::*;
use std::io::Cursor;
use std::path::Path;

/// The bytes of a picture file of a document, with 8 bits or more as requested; `None` if
/// canceled. `file` is for messages.
pub fn encode_document(
    file: &Path,
    document: &Document,
    options: &ExportOptions,
    budget: &Budget,
    progress: &Progress,
) -> Cancelable<Vec<u8>> {
    let format = ExportFormat::of(file)?;
    if format.bits(file, options.bits)? == 8 {
        // Without room for textures of floats, layers are rounded to bytes one by one, as on the
        // screen.
        let is_exact =
            budget.room(file, "a picture that is rounded once", document.float_bytes()).is_ok();
        let pixels = if is_exact {
            flatten_rounding_once(document, progress)
        } else {
            flatten(document, progress)
        };
        let conversion = conversion(document, options);
        let encode = |pixels: TileGrid| {
            let pixels = match conversion {
                Some(by) => pixels.converted(by).0,
                None => pixels,
            };
            let profile = written_profile(document, options);
            super::encode_in(file, format, &pixels, document.size, options, profile)
        };
        return pixels.map(encode).transpose();
    }
    let Some(mut pixels) =
        flatten_within_budget(file, document, highlights(format), budget, progress)?
    else {
        return Ok(None);
    };
    if let Some(by) = conversion(document, options) {
        pixels.par_iter_mut().for_each(|pixel| *pixel = convert(*pixel, by));
    }
    let profile = written_profile(document, options);
    encode_in(file, format, &pixels, document.size, options, profile).map(Some)
}

/// The profile that a file of a document names.
fn written_profile(document: &Document, options: &ExportOptions) -> ColorProfile {
    options.profile.unwrap_or(document.profile)
}

/// How the document's colors become those of the file.
fn conversion(document: &Document, options: &ExportOptions) -> Option<&'static ProfileConversion> {
    document.profile.conversion_to(written_profile(document, options))
}

/// A premultiplied encoded pixel, light brighter than white kept.
fn convert([r, g, b, a]: [f32; 4], by: &ProfileConversion) -> [f32; 4] {
    if a <= 0.0 {
        return [0.0; 4];
    }
    let [r, g, b] = by.encoded_bright([r, g, b].map(|v| v / a)).map(|v| v * a);
    [r, g, b, a]
}

/// A document flattened without rounding, if there is memory for it and for its file; `None` if
/// canceled.
pub(super) fn flatten_within_budget(
    file: &Path,
    document: &Document,
    highlights: Highlights,
    budget: &Budget,
    progress: &Progress,
) -> Cancelable<Vec<[f32; 4]>> {
    let asked =
        document.size.area() as u64 * 2 * size_of::<[f32; 4]>() as u64 + document.float_bytes();
    budget.room(file, "a picture of more than 8 bits", asked)?;
    Ok(flatten_to_floats(document, highlights, progress))
}

/// A file of light keeps what is brighter than white.
fn highlights(format: ExportFormat) -> Highlights {
    if format == ExportFormat::Exr { Highlights::Kept } else { Highlights::Clipped }
}

/// The bytes of a picture file of sRGB, of pixels as [`crate::document::flatten_to_floats`] gives
/// them; `file` is for messages.
///
/// Fails for formats of 8 bits.
pub fn encode(
    file: &Path,
    format: ExportFormat,
    pixels: &[[f32; 4]],
    canvas: Size,
    options: &ExportOptions,
) -> Result<Vec<u8>> {
    encode_in(file, format, pixels, canvas, options, ColorProfile::Srgb)
}

/// The same of pixels in a color profile, which the file names.
pub fn encode_in(
    file: &Path,
    format: ExportFormat,
    pixels: &[[f32; 4]],
    canvas: Size,
    options: &ExportOptions,
    profile: ColorProfile,
) -> Result<Vec<u8>> {
    let rect = options.crop.map_or(canvas.rect(), |crop| crop.intersect(canvas.rect()));
    if rect.is_empty() || pixels.len() != canvas.area() {
        return Err(Error::unsupported_file(file, "the part to write has no pixels"));
    }
    let size = Size::new(rect.width() as u32, rect.height() as u32);
    let rows =
        pixels.chunks_exact(canvas.width as usize).skip(rect.y0 as usize).take(rect.height());
    let part = rows.flat_map(|row| row.iter().skip(rect.x0 as usize).take(rect.width()));
    let under = options.background.map_or([0.0; 4], |color| color.premultiplied());
    let part: Vec<[f32; 4]> = part.map(|&[r, g, b, a]| compose_over([r, g, b, a], under)).collect();
    match format {
        ExportFormat::Png => {
            let values: Vec<u8> =
                part.iter().flat_map(straight16).flat_map(u16::to_be_bytes).collect();
            png([values].into_iter(), size, png::BitDepth::Sixteen, options, profile)
                .map_err(|e| Error::unsupported_file(file, e))
        }
        ExportFormat::Tiff => {
            let values = part.iter().flat_map(straight16).collect();
            let image = image::ImageBuffer::from_raw(size.width, size.height, values);
            tiff(file, image.map(DynamicImage::ImageRgba16), profile)
        }
        ExportFormat::Exr => {
            let bits = format.bits(file, options.bits)?;
            exr(size, bits, profile, |i| light(&part[i]))
                .map_err(|e| Error::unsupported_file(file, e))
        }
        ExportFormat::Jpeg | ExportFormat::WebP => Err(Error::unsupported_file(
            file,
            "this format has 8 bits a channel; PNG, TIFF and EXR have more",
        )),
    }
}

/// A premultiplied pixel over a color.
fn compose_over(p: [f32; 4], under: [f32; 4]) -> [f32; 4] {
    std::array::from_fn(|c| p[c] + under[c] * (1.0 - p[3]))
}

/// Straight alpha, 16 bits.
fn straight16(&[r, g, b, a]: &[f32; 4]) -> [u16; 4] {
    let to = |v: f32| (v.max(0.0).min(1.0) * 65535.0).round() as u16;
    let straight = |v: f32| if a > 0.0 { to(v / a) } else { 0 };
    [straight(r), straight(g), straight(b), to(a)]
}

/// A TIFF of an image, whatever its depth.
pub(super) fn tiff(
    file: &Path,
    image: Option<DynamicImage>,
    profile: ColorProfile,
) -> Result<Vec<u8>> {
    let mut bytes = Cursor::new(Vec::new());
    let image =
        image.ok_or_else(|| Error::unsupported_file(file, "the picture holds no pixels"))?;
    let mut encoder = image::codecs::tiff::TiffEncoder::new(&mut bytes);
    name_profile(file, &mut encoder, profile)?;
    image.write_with_encoder(encoder).map_err(|e| Error::unsupported_file(file, e))?;
    Ok(bytes.into_inner())
}

/// An EXR of a picture, one part, of 16 or 32 bits a channel.
///
/// `light`: of the pixel with a number, row by row: linear, multiplied by alpha.
pub(super) fn exr(
    size: Size,
    bits: u8,
    profile: ColorProfile,
    light: impl Fn(usize) -> [f32; 4] + Sync,
) -> Result<Vec<u8>, exr::error::Error> {
    use crate::exr::chromaticities;
    use exr::prelude::*;
    // Lines are written in order, so that the bytes do not depend on the threads.
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let (extent, attributes) =
        ((size.width as usize, size.height as usize), LayerAttributes::default());
    let light = |at: Vec2<usize>| light(at.y() * extent.0 + at.x());
    let mut bytes = Cursor::new(Vec::new());
    if bits == 32 {
        let channels =
            SpecificChannels::rgba(|at: Vec2<usize>| <(f32, f32, f32, f32)>::from(light(at)));
        let mut image = Image::from_layer(Layer::new(extent, attributes, encoding, channels));
        image.attributes.chromaticities = chromaticities(profile);
        image.write().to_buffered(&mut bytes)?;
    } else {
        let half = |at: Vec2<usize>| <(f16, f16, f16, f16)>::from(light(at).map(f16::from_f32));
        let channels = SpecificChannels::rgba(half);
        let mut image = Image::from_layer(Layer::new(extent, attributes, encoding, channels));
        image.attributes.chromaticities = chromaticities(profile);
        image.write().to_buffered(&mut bytes)?;
    }
    Ok(bytes.into_inner())
}

/// Linear light, multiplied by alpha, of an encoded premultiplied pixel; limited to what a half
/// float can hold.
pub(super) fn light(&[r, g, b, a]: &[f32; 4]) -> [f32; 4] {
    const HALF_MAX: f32 = 65504.0;
    let light =
        |v: f32| if a > 0.0 { (srgb::decode((v / a).max(0.0)) * a).min(HALF_MAX) } else { 0.0 };
    [light(r), light(g), light(b), a]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Content, Layer, Live};
    use crate::math::{Rect, srgb::Color, vec2};
    use crate::paint::{Gradient, GradientStop, ImageFilter};
    use crate::picture;
    use crate::surface::Operator;

    /// A ramp finer than bytes.
    fn ramp() -> (Vec<[f32; 4]>, Size) {
        let size = Size::new(512, 2);
        ((0..1024).map(|i| [(i % 512) as f32 / 1022.0, 0.25, 0.0, 0.5]).collect(), size)
    }

    #[test]
    fn sixteen_bits_keep_what_eight_would_round() {
        let (pixels, size) = ramp();
        for (format, name) in [(ExportFormat::Png, "a.png"), (ExportFormat::Tiff, "a.tif")] {
            let bytes =
                encode(Path::new(name), format, &pixels, size, &ExportOptions::default()).unwrap();
            let image = image::load_from_memory(&bytes).unwrap().to_rgba16();
            let [r, g, b, a] = image.get_pixel(100, 1).0;
            assert_eq!(
                [r, g, b, a],
                [(100.0 / 511.0 * 65535.0f32).round() as u16, 32768, 0, 32768],
                "{name}"
            );
        }
    }

    #[test]
    fn a_gradient_of_4096_pixels_has_4000_levels_in_every_file_of_more_than_8_bits() {
        let document = gradient_4096();
        let distinct = |values: Vec<u32>| {
            values.into_iter().collect::<std::collections::BTreeSet<u32>>().len()
        };
        let written = |name: &str, bits| {
            let options = ExportOptions { bits: Some(bits), ..ExportOptions::default() };
            let (file, budget) = (Path::new(name), Budget::default());
            encode_document(file, &document, &options, &budget, &Progress::default())
                .unwrap()
                .unwrap()
        };
        for name in ["a.png", "a.tif"] {
            let image = image::load_from_memory(&written(name, 16)).unwrap().to_rgba16();
            let found = distinct(image.pixels().take(4096).map(|p| p.0[0].into()).collect());
            assert!(found >= 4000, "{name}: {found}");
            assert_eq!(
                image::load_from_memory(&written(name, 8)).unwrap().color(),
                image::ColorType::Rgba8
            );
        }
        for bits in [16, 32] {
            let read =
                picture::decode(Path::new("a.exr"), &written("a.exr", bits), &Budget::default())
                    .unwrap();
            let found = distinct((0..4096).map(|x| read.linear_at(x, 0)[0].to_bits()).collect());
            assert!(found >= 4000, "EXR of {bits} bits: {found}");
        }
        let options = ExportOptions { bits: Some(32), ..ExportOptions::default() };
        let said = encode_document(
            Path::new("a.png"),
            &document,
            &options,
            &Budget::default(),
            &Progress::default(),
        );
        assert!(said.unwrap_err().to_string().contains("has 8 or 16 bits a channel, not 32"));
    }

    #[test]
    fn an_airbrush_over_sixty_strokes_has_ten_times_the_levels_in_16_bits() {
        let document = crate::project::sample::smoothly_painted();
        let written = |bits| {
            let options = ExportOptions { bits: Some(bits), ..ExportOptions::default() };
            let (file, budget) = (Path::new("a.png"), Budget::default());
            let bytes = encode_document(file, &document, &options, &budget, &Progress::default())
                .unwrap()
                .unwrap();
            let image = image::load_from_memory(&bytes).unwrap().to_rgba16();
            image
                .pixels()
                .map(|pixel| pixel.0[0])
                .collect::<std::collections::BTreeSet<u16>>()
                .len()
        };
        let (of_16, of_8) = (written(16), written(8));
        assert!(of_16 >= 10 * of_8, "{of_16} levels, and {of_8} in bytes");
    }

    fn gradient_4096() -> Document {
        let stop = |t, color| GradientStop { t, color };
        let gradient = Gradient {
            from: vec2(0.0, 1.0),
            to: vec2(4096.0, 1.0),
            stops: vec![stop(0.0, Color::BLACK), stop(1.0, Color::WHITE)],
            operator: Operator::None,
            filter: ImageFilter::Antialias,
            frame: Default::default(),
            style: Default::default(),
            pieces: Vec::new(),
        };
        let layer = Layer::new("gradient", Content::Gradient(Live::new(gradient)));
        Document { layers: vec![layer.into()], ..Document::empty(Size::new(4096, 2)) }
    }

    #[test]
    fn an_exr_keeps_light_that_is_brighter_than_white() {
        let size = Size::new(2, 1);
        let pixels = [[srgb::encode(9.0), 0.5, 0.0, 1.0], [srgb::encode(9.0) * 0.5, 0.0, 0.0, 0.5]];
        for bits in [16, 32] {
            let options = ExportOptions { bits: Some(bits), ..ExportOptions::default() };
            let bytes =
                encode(Path::new("a.exr"), ExportFormat::Exr, &pixels, size, &options).unwrap();
            let read = picture::decode(Path::new("a.exr"), &bytes, &Budget::default()).unwrap();
            for x in 0..2 {
                assert!((read.linear_at(x, 0)[0] - 9.0).abs() < 0.01, "{:?}", read.linear_at(x, 0));
            }
        }
    }

    #[test]
    fn an_exr_holds_linear_light_of_the_part_that_was_asked_for() {
        let (pixels, size) = ramp();
        let options =
            ExportOptions { crop: Some(Rect::new(100, 1, 200, 9)), ..ExportOptions::default() };
        let bytes = encode(Path::new("a.exr"), ExportFormat::Exr, &pixels, size, &options).unwrap();
        let read = picture::decode(Path::new("a.exr"), &bytes, &Budget::default()).unwrap();
        assert_eq!(read.size, Size::new(100, 1));
        let expected = srgb::decode(150.0 / 511.0);
        assert!((read.linear_at(50, 0)[0] - expected).abs() < 1e-3);
    }
}
