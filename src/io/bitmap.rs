//! Decodes raster files within a budget: PNG, JPEG, WebP, TIFF, BMP, TGA and Radiance HDR.
//! Floor 5. Not here: what the numbers mean (`picture`, `maps`), EXR (`exr`).

mod tiff;

use super::Budget;
use crate::{Error, Remedy, Result, math::Size};
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, metadata::Orientation};
use std::{
    io::Cursor,
    panic::{AssertUnwindSafe, catch_unwind},
    path::Path,
};

/// A decoded file, with its colour profile and orientation, both not yet applied.
pub struct Bitmap {
    pub image: DynamicImage,
    pub icc: Option<Vec<u8>>,
    pub orientation: Orientation,
    pub format: &'static str,
    /// A defect that could be worked around, as a sentence.
    pub warning: Option<&'static str>,
}

const READABLE: &str = "PNG, JPEG, WebP, TIFF, BMP, TGA, HDR or EXR";

/// The formats of this module; the flag says whether a file of a few bytes may hold any number of pixels.
const FORMATS: [(ImageFormat, &str, bool); 7] = [
    (ImageFormat::Png, "PNG", false),
    (ImageFormat::Jpeg, "JPEG", false),
    (ImageFormat::WebP, "WebP", true),
    (ImageFormat::Tiff, "TIFF", false),
    (ImageFormat::Bmp, "BMP", false),
    (ImageFormat::Tga, "TGA", false),
    (ImageFormat::Hdr, "HDR", false),
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
            return Ok(Bitmap { warning: Some("the PNG has no end marker; all its pixels are there"), ..bitmap });
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
    if format == ImageFormat::Jpeg && !ends(bytes) {
        return Err(Error::decode(file, "the JPEG data ends before its end marker; the file is cut short"));
    }
    let decoded = catch_unwind(AssertUnwindSafe(|| {
        if format == ImageFormat::Tiff {
            return tiff::decode(file, bytes, budget);
        }
        let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
        reader.limits(limits(budget));
        let mut decoder = reader.into_decoder().map_err(|e| failure(file, name, &e))?;
        let (width, height) = decoder.dimensions();
        let size = budget.size(file, width.into(), height.into())?;
        if !unbounded {
            plausible(file, size, decoder.total_bytes(), bytes.len())?;
        }
        let icc = decoder.icc_profile().ok().flatten();
        let orientation = decoder.orientation().unwrap_or(Orientation::NoTransforms);
        let image = DynamicImage::from_decoder(decoder).map_err(|e| failure(file, name, &e))?;
        Ok(Bitmap { image, icc, orientation, format: name, warning: None })
    }));
    decoded.unwrap_or_else(|_| Err(Error::decode(file, format!("the {name} data is damaged"))))
}

fn sniff(file: &Path, bytes: &[u8]) -> Result<(ImageFormat, &'static str, bool)> {
    if bytes.is_empty() {
        return Err(Error::decode(file, "the file is empty"));
    }
    let is_tga = file.extension().is_some_and(|e| e.eq_ignore_ascii_case("tga"));
    let is_big_tiff = bytes.starts_with(b"II+\0") || bytes.starts_with(b"MM\0+");
    let found = match image::guess_format(bytes) {
        _ if is_big_tiff => ImageFormat::Tiff,
        Ok(format) => format,
        Err(_) if is_tga => ImageFormat::Tga,
        Err(_) => return Err(Error::decode(file, format!("the file does not begin like a {READABLE} picture"))),
    };
    let row = FORMATS.iter().find(|(format, ..)| *format == found);
    row.copied().ok_or_else(|| {
        let kind = found.extensions_str().first().copied().unwrap_or("such").to_uppercase();
        Error::unsupported(file, format!("{kind} pictures; save it as {READABLE}"))
    })
}

fn limits(budget: &Budget) -> image::Limits {
    let mut limits = image::Limits::no_limits();
    // Four floats a pixel is the most that any of the formats decodes to.
    limits.max_alloc = Some(budget.area_px.saturating_mul(16));
    limits
}

/// Refuses headers that promise more pixels than the following bytes could hold: DEFLATE reaches 1032 : 1, LZW about
/// 2500 : 1.
fn plausible(file: &Path, size: Size, decoded_bytes: u64, file_bytes: usize) -> Result<()> {
    const GRANTED: u64 = 1 << 20;
    if decoded_bytes > GRANTED && decoded_bytes / 4096 > file_bytes as u64 {
        let reason = format!("the header promises {size} pixels, far more than {file_bytes} bytes can hold");
        return Err(Error::decode(file, reason));
    }
    Ok(())
}

/// Whether a JPEG's last scan is followed by its end marker.
fn ends(bytes: &[u8]) -> bool {
    let last = |marker: u8| bytes.windows(2).rposition(|w| w == [0xff, marker]);
    last(0xd9) > last(0xda)
}

fn failure(file: &Path, format: &str, error: &image::ImageError) -> Error {
    use image::ImageError::{Limits, Unsupported};
    match error {
        Limits(e) => Error::too_large(file, e).with_remedy(Remedy::MorePixels),
        Unsupported(e) => Error::unsupported(file, e),
        e => Error::decode(file, format!("the {format} data is damaged or cut short ({e})")),
    }
}
