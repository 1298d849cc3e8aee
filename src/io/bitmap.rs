//! Decodes raster files within a budget: PNG, JPEG, WebP, TIFF, BMP, TGA, Radiance HDR, GIF, QOI
//! and Netpbm. Floor 5. Not here: what the numbers mean (`picture`, `maps`), EXR (`exr`).

mod gif;
mod passes;
mod pnm;
mod qoi;
mod tga;
mod tiff;
mod unread;
mod upright;
mod weight;

pub use upright::png_exif;
pub use weight::{has_png_profile, png_cicp};

use super::Budget;
use crate::icc_profiles::icc_of;
use crate::math::{ColorProfile, Size};
use crate::{Error, Remedy, Result};
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, metadata::Orientation};
use std::{
    io::Cursor,
    panic::{AssertUnwindSafe, catch_unwind},
    path::Path,
};

/// A decoded file, with its color profile and orientation, both not yet applied.
pub struct Bitmap {
    /// The pixels, as they are stored.
    pub image: DynamicImage,
    /// The color profile, if the file has one.
    pub icc: Option<Vec<u8>>,
    /// How the picture is to be turned to be seen upright.
    pub orientation: Orientation,
    /// The name of the format, for messages.
    pub format: &'static str,
    /// A defect that could be worked around, as a sentence.
    pub warning: Option<&'static str>,
}

const READABLE: &str = "PNG, JPEG, WebP, TIFF, BMP, TGA, GIF, QOI, PNM, HDR or EXR";

/// The formats of this module; the flag says whether a file of a few bytes may hold any number of
/// pixels.
const FORMATS: [(ImageFormat, &str, bool); 10] = [
    (ImageFormat::Png, "PNG", false),
    (ImageFormat::Jpeg, "JPEG", false),
    (ImageFormat::WebP, "WebP", true),
    (ImageFormat::Tiff, "TIFF", false),
    (ImageFormat::Bmp, "BMP", false),
    (ImageFormat::Tga, "TGA", false),
    (ImageFormat::Hdr, "HDR", false),
    (ImageFormat::Gif, "GIF", false),
    (ImageFormat::Qoi, "QOI", false),
    (ImageFormat::Pnm, "PNM", false),
];

/// Decodes a file by its first bytes; TGA, which has no signature, by its name.
pub fn decode(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Bitmap> {
    let found = sniff(file, bytes)?;
    let result = decode_as(file, bytes, budget, found);
    let end = [0, 0, 0, 0, b'I', b'E', b'N', b'D', 0xae, 0x42, 0x60, 0x82];
    if result.is_err() && found.0 == ImageFormat::Png && !bytes.ends_with(&end) {
        // A PNG may have lost only its end marker; if pixels are missing, decoding fails again.
        let whole = [bytes, &end].concat();
        if let Ok(bitmap) = decode_as(file, &whole, budget, found) {
            return Ok(Bitmap {
                warning: Some("the PNG has no end marker; all its pixels are there"),
                ..bitmap
            });
        }
    }
    result
}

fn decode_as(
    file: &Path,
    bytes: &[u8],
    budget: &Budget,
    (format, name, unbounded): (ImageFormat, &'static str, bool),
) -> Result<Bitmap> {
    if format == ImageFormat::Jpeg && !has_end_marker(bytes) {
        return cut_jpeg(file, bytes, budget);
    }
    if format == ImageFormat::Hdr
        && let Some((usual, orientation)) = upright::radiance(bytes)
    {
        let read = decode_as(file, &usual, budget, (format, name, unbounded))?;
        return Ok(Bitmap { orientation, ..read });
    }
    let decoded = catch_unwind(AssertUnwindSafe(|| {
        match format {
            ImageFormat::Tiff => return tiff::decode(file, bytes, budget),
            ImageFormat::Gif => return gif::decode(file, bytes, budget),
            ImageFormat::Qoi => return qoi::decode(file, bytes, budget),
            ImageFormat::Pnm => return pnm::decode(file, bytes, budget),
            _ => {}
        }
        let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
        reader.limits(limits(format, bytes, budget));
        let mut decoder = reader.into_decoder().map_err(|e| failure(file, name, &e))?;
        let (width, height) = decoder.dimensions();
        let size = budget.size(file, width.into(), height.into())?;
        if !unbounded {
            let decoded = decoder.total_bytes().saturating_mul(8);
            let stored = weight::png_pixel_bits(bytes).filter(|_| format == ImageFormat::Png);
            weight::plausible(
                file,
                size,
                stored.map_or(decoded, |bits| bits * size.area() as u64),
                bytes.len(),
            )?;
        }
        if format == ImageFormat::Jpeg {
            passes::check(file, bytes, size, budget)?;
        }
        room(file, size, decoder.total_bytes(), budget)?;
        let icc = decoder.icc_profile().ok().flatten();
        let is_lost = icc.is_none() && format == ImageFormat::Png && weight::has_png_profile(bytes);
        let warning =
            is_lost.then_some("its color profile is damaged or too large, and was left out");
        let icc = code_points(format, bytes).or(icc);
        let exif = decoder.exif_metadata().ok().flatten();
        let turned = exif.as_deref().and_then(upright::of_exif).or_else(|| {
            let exif = upright::png_exif(bytes).filter(|_| format == ImageFormat::Png)?;
            upright::of_exif(exif)
        });
        let orientation = turned.unwrap_or(Orientation::NoTransforms);
        let image = DynamicImage::from_decoder(decoder).map_err(|e| failure(file, name, &e))?;
        let image = if format == ImageFormat::Tga { tga::with_alpha(bytes, image) } else { image };
        Ok(Bitmap { image, icc, orientation, format: name, warning })
    }));
    decoded.unwrap_or_else(|_| Err(Error::decode(file, format!("the {name} data is damaged"))))
}

/// The profile that the code points of a PNG say, which outrank its ICC profile.
fn code_points(format: ImageFormat, bytes: &[u8]) -> Option<Vec<u8>> {
    let points = (format == ImageFormat::Png).then(|| weight::png_cicp(bytes))?;
    let profile = match points? {
        // BT.709 or SMPTE EG 432-1 primaries, the curve of sRGB, RGB of full range.
        [1, 13, 0, 1] => ColorProfile::Srgb,
        [12, 13, 0, 1] => ColorProfile::DisplayP3,
        _ => return None,
    };
    Some(icc_of(profile).to_vec())
}

/// The ICC profile of a file, from its header alone; none where that cannot be read.
pub fn icc_profile(file: &Path, bytes: &[u8], budget: &Budget) -> Option<Vec<u8>> {
    let (format, ..) = sniff(file, bytes).ok()?;
    if let Some(icc) = code_points(format, bytes) {
        return Some(icc);
    }
    let profile = || {
        if format == ImageFormat::Tiff {
            return tiff::icc_profile(bytes);
        }
        let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
        reader.limits(limits(format, bytes, budget));
        reader.into_decoder().ok()?.icc_profile().ok()?
    };
    // Decoders are third-party code: a panic counts as a damaged file.
    catch_unwind(AssertUnwindSafe(profile)).ok()?
}

fn sniff(file: &Path, bytes: &[u8]) -> Result<(ImageFormat, &'static str, bool)> {
    if bytes.is_empty() {
        return Err(Error::decode(file, "the file is empty"));
    }
    let is_tga = file.extension().is_some_and(|e| e.eq_ignore_ascii_case("tga"));
    // A TGA may begin like an icon.
    if let Some(reason) = unread::reason(file, bytes).filter(|_| !is_tga) {
        return Err(Error::unsupported_file(file, reason));
    }
    let is_float_map = bytes.starts_with(b"PF\n") || bytes.starts_with(b"Pf\n");
    let is_big_tiff = bytes.starts_with(b"II+\0") || bytes.starts_with(b"MM\0+");
    let found = match image::guess_format(bytes) {
        _ if is_big_tiff => ImageFormat::Tiff,
        _ if is_float_map => ImageFormat::Pnm,
        Ok(format) => format,
        Err(_) if is_tga => ImageFormat::Tga,
        Err(_) => {
            return Err(Error::decode(
                file,
                format!("the file does not begin like a {READABLE} picture"),
            ));
        }
    };
    let row = FORMATS.iter().find(|(format, ..)| *format == found);
    row.copied().ok_or_else(|| {
        let kind = found.extensions_str().first().copied().unwrap_or("such").to_uppercase();
        Error::unsupported_file(file, format!("{kind} pictures; save it as {READABLE}"))
    })
}

fn limits(format: ImageFormat, bytes: &[u8], budget: &Budget) -> image::Limits {
    let mut limits = image::Limits::no_limits();
    limits.max_alloc = Some(match format {
        // Here the limit is for everything besides the pixels: packed texts and the unpacked
        // profile.
        ImageFormat::Png => bytes_beside_pixels(bytes),
        // Four floats a pixel is the most that any of the formats decodes to.
        _ => budget.area_px.saturating_mul(16),
    });
    limits
}

/// What a PNG may hold in memory besides its pixels.
pub fn bytes_beside_pixels(bytes: &[u8]) -> u64 {
    PROFILE_BYTES + bytes.len() as u64
}

/// What a color profile may unpack to. Those of printing presses have some 4 MB.
const PROFILE_BYTES: u64 = 16 << 20;

/// Reserves memory for decoded pixels, once as the decoder gives them and once as they are passed
/// on.
fn room(file: &Path, size: Size, decoded_bytes: u64, budget: &Budget) -> Result<()> {
    let handed_on = size.area() as u64 * 4;
    budget.room(
        file,
        &format!("a picture of {size} pixels"),
        decoded_bytes.saturating_add(handed_on),
    )
}

/// What there is of a JPEG without its end marker: as far as its pixels go.
fn cut_jpeg(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Bitmap> {
    let jpeg = (ImageFormat::Jpeg, "JPEG", false);
    // Half a marker would swallow the one that is put after it.
    let bytes = bytes.strip_suffix(&[0xff]).unwrap_or(bytes);
    let has_scan = passes::work(bytes).passes > 0;
    let read = has_scan.then(|| decode_as(file, &[bytes, &[0xff, 0xd9]].concat(), budget, jpeg));
    match read {
        Some(Ok(bitmap)) => Ok(Bitmap {
            warning: Some("the JPEG has no end marker; it is shown as far as it goes"),
            ..bitmap
        }),
        Some(Err(error @ Error::TooLarge { .. })) => Err(error),
        _ => Err(Error::decode(
            file,
            "the JPEG data ends before its end marker; the file is cut short",
        )),
    }
}

/// Whether a JPEG's last scan is followed by its end marker.
fn has_end_marker(bytes: &[u8]) -> bool {
    let last = |marker: u8| bytes.windows(2).rposition(|w| w == [0xff, marker]);
    last(0xd9) > last(0xda)
}

fn failure(file: &Path, format: &str, error: &image::ImageError) -> Error {
    use image::ImageError::{Limits, Unsupported};
    match error {
        Limits(e) => Error::too_large(file, e).with_remedy(Remedy::MorePixels),
        Unsupported(e) => Error::unsupported_file(file, e),
        e => Error::decode(file, format!("the {format} data is damaged or cut short ({e})")),
    }
}
