//! TIFF as scanners, renderers and painting programs store it: gray, palettes, RGB, YCbCr and CMYK,
//! with and without alpha, 1 to 64 bits, integers and floats, in planes or pixel by pixel. Floor 5.
//! Strips, tiles and compressions are the `tiff` crate's; `image` reads only part of what that
//! decodes.

mod directory;
mod sample;
mod unpack;
mod within;

use super::{Bitmap, room, weight};
use crate::Budget;
use crate::math::Size;
use crate::{Error, Remedy, Result};
use directory::Directory;
use image::{DynamicImage, metadata::Orientation};
use sample::TiffSample;
use std::io::Cursor;
use std::path::Path;
use tiff::decoder::{BufferLayoutPreference, Decoder, DecodingResult, Limits};
use tiff::tags::Tag;
use tiff::{ColorType, TiffError};

/// The meaning of a pixel's samples, without extra samples.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ColorModel {
    Gray,
    /// Gray, 0 being white.
    Ink,
    Palette,
    Rgb,
    Cmyk,
    YCbCr,
}

impl ColorModel {
    /// From the value of the tag; `None` for color models that are not supported.
    fn of(photometric: u16) -> Option<Self> {
        Some(match photometric {
            0 => ColorModel::Ink,
            1 => ColorModel::Gray,
            2 => ColorModel::Rgb,
            3 => ColorModel::Palette,
            5 => ColorModel::Cmyk,
            6 => ColorModel::YCbCr,
            _ => return None,
        })
    }

    fn colors(self) -> usize {
        match self {
            ColorModel::Gray | ColorModel::Ink | ColorModel::Palette => 1,
            ColorModel::Rgb | ColorModel::YCbCr => 3,
            ColorModel::Cmyk => 4,
        }
    }
}

/// The meaning of the sample after the colors.
#[derive(Clone, Copy, PartialEq, Eq)]
enum AlphaKind {
    None,
    Straight,
    /// The colors are multiplied by it.
    Associated,
}

/// The ICC profile of the first picture of a TIFF.
pub fn icc_profile(bytes: &[u8]) -> Option<Vec<u8>> {
    Decoder::new(Cursor::new(bytes)).ok()?.get_tag_u8_vec(Tag::IccProfile).ok()
}

/// Decodes the first picture of a TIFF.
pub fn decode(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Bitmap> {
    let entry = photometric(bytes);
    let entry = entry.ok_or_else(|| {
        Error::decode(file, "the TIFF does not say which colors it has; it is damaged or cut short")
    })?;
    let meaning = ColorModel::of(entry.value);
    let others = "its colors are neither gray, indexed, RGB, YCbCr nor CMYK";
    let meaning = meaning.ok_or_else(|| Error::unsupported_file(file, others))?;
    // The crate reads palettes and white-is-zero with alpha as plain gray. Their meaning is
    // restored here.
    let as_gray = match meaning {
        ColorModel::Palette | ColorModel::Ink => Some(entry.with_value(bytes, 1)),
        _ => None,
    };
    let failed = |e: TiffError| failure(file, &e);
    let most = usize::try_from(budget.area_px.saturating_mul(16)).unwrap_or(usize::MAX);
    let mut limits = Limits::default();
    (limits.decoding_buffer_size, limits.intermediate_buffer_size) = (most, most);
    let cursor = Cursor::new(as_gray.as_deref().unwrap_or(bytes));
    let mut decoder = Decoder::new(cursor).map_err(failed)?.with_limits(limits.clone());
    let (width, height) = decoder.dimensions().map_err(failed)?;
    let size = budget.size(file, width.into(), height.into())?;
    let color = decoder.colortype().map_err(failed)?;
    let compression = decoder.find_tag_unsigned::<u16>(Tag::Compression).ok().flatten();
    let values = size.area() as u64 * samples(color) as u64;
    let is_fax = compression.is_some_and(|compression| FAX.contains(&compression));
    let row_bits = if is_fax {
        1
    } else {
        u64::from(color.bit_depth()) * samples(color) as u64 * u64::from(size.width)
    };
    weight::plausible(file, size, row_bits.saturating_mul(size.height.into()), bytes.len())?;
    // The decoded samples, the sorted samples, and the picture made from them.
    room(file, size, values.saturating_mul(2 * u64::from(color.bit_depth()).div_ceil(8)), budget)?;
    if compression == Some(JPEG) {
        within::check(file, &mut decoder, bytes, budget)?;
    }
    parts(file, &mut decoder)?;
    let unpacked =
        unpack::readable(file, as_gray.as_deref().unwrap_or(bytes), &mut decoder, budget)?;
    if let Some(unpacked) = &unpacked {
        decoder = Decoder::new(Cursor::new(&unpacked[..])).map_err(failed)?.with_limits(limits);
    }
    let alpha = find_alpha(&mut decoder, color, meaning);
    let map =
        decoder.find_tag_unsigned_vec::<u16>(Tag::ColorMap).ok().flatten().unwrap_or_default();
    let icc = decoder.get_tag_u8_vec(Tag::IccProfile).ok();
    let turned = decoder.find_tag_unsigned::<u8>(Tag::Orientation).ok().flatten();
    let mut values = DecodingResult::U8(Vec::new());
    let layout = decoder.read_image_to_buffer(&mut values).map_err(failed)?;
    let stored = TiffLayout {
        size,
        samples: samples(color),
        bits: color.bit_depth(),
        layout,
        meaning,
        alpha,
        map,
    };
    let image = stored.image(values).map_err(|reason| Error::unsupported_file(file, reason))?;
    let orientation = turned.and_then(Orientation::from_exif).unwrap_or(Orientation::NoTransforms);
    Ok(Bitmap { image, icc, orientation, format: "TIFF", warning: None })
}

/// What the samples beyond the colors say.
fn find_alpha(
    decoder: &mut Decoder<Cursor<&[u8]>>,
    color: ColorType,
    meaning: ColorModel,
) -> AlphaKind {
    let extra =
        decoder.find_tag_unsigned_vec::<u16>(Tag::ExtraSamples).ok().flatten().unwrap_or_default();
    match extra.first() {
        _ if samples(color) <= meaning.colors() => AlphaKind::None,
        Some(1) => AlphaKind::Associated,
        Some(2) => AlphaKind::Straight,
        None if meaning == ColorModel::Rgb => AlphaKind::Straight,
        _ => AlphaKind::None,
    }
}

/// Strips and tiles of one picture; each takes some fifty microseconds, however small. The longest
/// side in strips of a row and four planes has as many.
const MOST_PARTS: u64 = 4 << 15;

/// Refuses a picture in more pieces than can be read in a few seconds.
fn parts(file: &Path, decoder: &mut Decoder<Cursor<&[u8]>>) -> Result<()> {
    let (size, part) = (decoder.dimensions(), decoder.chunk_dimensions());
    let (width, height) = size.map_err(|e| failure(file, &e))?;
    let planes =
        decoder.find_tag_unsigned::<u16>(Tag::PlanarConfiguration).ok().flatten() == Some(2);
    let planes =
        if planes { decoder.colortype().map_or(1, |color| samples(color) as u64) } else { 1 };
    let count = u64::from(width.div_ceil(part.0.max(1)))
        * u64::from(height.div_ceil(part.1.max(1)))
        * planes;
    if count > MOST_PARTS {
        let reason = format!("the TIFF is in {count} pieces; {MOST_PARTS} are allowed");
        return Err(Error::too_large(file, reason));
    }
    Ok(())
}

/// Compressions of fax machines: a white row takes a bit.
const FAX: std::ops::RangeInclusive<u16> = 2..=4;
/// The compression that is a JPEG in each strip or tile.
const JPEG: u16 = 7;
/// The number of samples per pixel that the crate returns.
fn samples(color: ColorType) -> usize {
    match color {
        ColorType::Gray(_) | ColorType::Palette(_) => 1,
        ColorType::GrayA(_) => 2,
        ColorType::RGB(_) | ColorType::YCbCr(_) | ColorType::Lab(_) => 3,
        ColorType::RGBA(_) | ColorType::CMYK(_) => 4,
        ColorType::CMYKA(_) => 5,
        ColorType::Multiband { num_samples, .. } => num_samples.into(),
        _ => 0,
    }
}

fn failure(file: &Path, error: &TiffError) -> Error {
    match error {
        TiffError::LimitsExceeded => {
            Error::too_large(file, "the TIFF needs more memory than allowed")
                .with_remedy(Remedy::MorePixels)
        }
        TiffError::UnsupportedError(e) => Error::unsupported_file(file, format!("TIFF: {e}")),
        e => Error::decode(file, format!("the TIFF data is damaged or cut short ({e})")),
    }
}

/// The position of the photometric tag's value.
struct Photometric {
    at: usize,
    directory: Directory,
    value: u16,
}

impl Photometric {
    /// The file with another value.
    fn with_value(&self, bytes: &[u8], value: u16) -> Vec<u8> {
        let mut out = bytes.to_vec();
        if let Some(place) = out.get_mut(self.at..self.at + 2) {
            place.copy_from_slice(&self.directory.digits(value.into(), 2));
        }
        out
    }
}

/// Finds that tag in the first directory of a TIFF or BigTIFF.
fn photometric(bytes: &[u8]) -> Option<Photometric> {
    let directory = Directory::first(bytes)?;
    let at = directory.place(bytes, 262)?;
    let value = directory.number(bytes, at, 2)? as u16;
    Some(Photometric { at, directory, value })
}

/// The layout and meaning of the samples.
struct TiffLayout {
    size: Size,
    samples: usize,
    bits: u8,
    layout: BufferLayoutPreference,
    meaning: ColorModel,
    alpha: AlphaKind,
    /// The palette: all reds, all greens, all blues.
    map: Vec<u16>,
}

type TiffRefusal = &'static str;

impl TiffLayout {
    fn image(&self, values: DecodingResult) -> Result<DynamicImage, TiffRefusal> {
        use DecodingResult::{F16, F32, F64, U8, U16, U32, U64};
        match values {
            U8(v) if self.bits < 8 => self.picture(self.unpack_samples(&v)),
            U8(v) => self.picture(v),
            U16(v) => self.picture(v),
            U32(v) => self.picture(v.into_iter().map(|v| (v >> 16) as u16).collect()),
            U64(v) => self.picture(v.into_iter().map(|v| (v >> 48) as u16).collect()),
            F16(v) => self.picture(v.into_iter().map(f32::from).collect()),
            F32(v) => self.picture(v),
            F64(v) => self.picture(v.into_iter().map(|v| v as f32).collect()),
            _ => Err("the samples of this TIFF are signed; those of a picture are not"),
        }
    }

    /// Unpacks samples of less than a byte to a byte each, scaled to its range unless they are
    /// palette indices.
    fn unpack_samples(&self, packed: &[u8]) -> Vec<u8> {
        let bits = usize::from(self.bits);
        let most = (1u32 << bits) - 1;
        let in_row =
            self.size.width as usize * if self.layout.planes > 1 { 1 } else { self.samples };
        let stride = self.layout.row_stride.map_or(1, usize::from);
        let value = |row: &[u8], i: usize| {
            let byte = row.get(i * bits / 8).copied().unwrap_or(0);
            let value = u32::from(byte) >> (8 - bits - i * bits % 8) & most;
            if self.meaning == ColorModel::Palette {
                value as u8
            } else {
                (value * 255 / most) as u8
            }
        };
        packed.chunks(stride).flat_map(|row| (0..in_row).map(move |i| value(row, i))).collect()
    }

    fn picture<T: TiffSample>(&self, values: Vec<T>) -> Result<DynamicImage, TiffRefusal> {
        let pixels =
            self.gather_pixels(&values).ok_or("this TIFF holds fewer samples than it promises")?;
        drop(values);
        let channels = self.channels();
        match self.meaning {
            ColorModel::Palette => self.look_up_palette(&pixels),
            ColorModel::YCbCr => {
                T::rgb_of_ycbcr(pixels).and_then(|rgb| T::image(self.size, channels, rgb))
            }
            ColorModel::Cmyk => T::image(self.size, channels - 1, self.rgb_from_inks(pixels)),
            ColorModel::Gray | ColorModel::Ink | ColorModel::Rgb => {
                T::image(self.size, channels, self.straight(pixels))
            }
        }
        .ok_or("this TIFF stores its colors in a way that is not supported")
    }

    fn channels(&self) -> usize {
        self.meaning.colors() + usize::from(self.alpha != AlphaKind::None)
    }

    /// The colors and the alpha of each pixel in turn, further samples left out; `None` where
    /// there are too few.
    fn gather_pixels<T: TiffSample>(&self, values: &[T]) -> Option<Vec<T>> {
        let (area, channels) = (self.size.area(), self.channels());
        let values = values.get(..area.checked_mul(self.samples)?)?;
        let at = |i: usize, c: usize| {
            if self.layout.planes > 1 { c * area + i } else { i * self.samples + c }
        };
        (channels <= self.samples).then(|| {
            (0..area)
                .flat_map(|i| (0..channels).map(move |c| (i, c)))
                .map(|(i, c)| values[at(i, c)])
                .collect()
        })
    }

    /// Converts to additive colors that are not multiplied by alpha.
    fn straight<T: TiffSample>(&self, mut pixels: Vec<T>) -> Vec<T> {
        for pixel in pixels.chunks_exact_mut(self.channels()) {
            let (colors, alpha) = pixel.split_at_mut(self.meaning.colors());
            for color in colors {
                if self.meaning == ColorModel::Ink {
                    *color = color.inverted();
                }
                if let (AlphaKind::Associated, Some(alpha)) = (self.alpha, alpha.first()) {
                    *color = color.divided(*alpha);
                }
            }
        }
        pixels
    }

    /// RGB of cyan, magenta, yellow and black, with ideal inks.
    fn rgb_from_inks<T: TiffSample>(&self, pixels: Vec<T>) -> Vec<T> {
        let rgb = |pixel: &[T]| {
            let [c, m, y] =
                [pixel[0], pixel[1], pixel[2]].map(|ink| ink.inverted().times(pixel[3].inverted()));
            [Some(c), Some(m), Some(y), pixel.get(4).copied()]
        };
        self.straight(pixels).chunks_exact(self.channels()).flat_map(rgb).flatten().collect()
    }

    /// The colors of palette indices.
    fn look_up_palette<T: TiffSample>(&self, pixels: &[T]) -> Option<DynamicImage> {
        let count = self.map.len() / 3;
        // Some programs wrote bytes where 16 bits are meant.
        let shift = if self.map.iter().any(|v| *v > 255) { 8 } else { 0 };
        let color = |i: usize, c: usize| {
            self.map.get(c * count + i.min(count - 1)).map_or(0, |v| (v >> shift) as u8)
        };
        let rgba = |pixel: &[T]| {
            let (index, alpha) =
                (pixel[0].index(), pixel.get(1).map_or(255, |a| a.index().min(255) as u8));
            [color(index, 0), color(index, 1), color(index, 2), alpha]
        };
        let out = pixels
            .chunks_exact(self.channels())
            .flat_map(|pixel| rgba(pixel).into_iter().take(self.channels() + 2));
        (count > 0).then(|| u8::image(self.size, self.channels() + 2, out.collect())).flatten()
    }
}

#[cfg(test)]
mod tests;
