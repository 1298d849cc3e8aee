//! Writes pictures: PNG, JPEG, WebP, TIFF and EXR, each completely or not at all. Floor 5. Not
//! here: flattening (`document::flatten`), more than 8 bits (`high_depth`), layers of an EXR
//! (`layers`).

pub mod high_depth;
pub mod layers;
pub mod shape;

use crate::document::{Document, Progress};
use crate::fs::Disk;
use crate::icc_profiles::to_embed;
use crate::math::{ColorProfile, Rect, Size, srgb, srgb::Color};
use crate::pixels::strips;
use crate::raster::TileGrid;
use crate::replace::{Overwrite, Terms, check, replace};
use crate::{Budget, Error, Remedy, Result};
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};

/// A kind of file that a picture can be written to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExportFormat {
    /// Straight alpha, marked as sRGB or Display P3.
    Png,
    /// 8 bits, opaque.
    Jpeg,
    /// Lossless.
    WebP,
    /// Straight alpha.
    Tiff,
    /// Linear light, premultiplied.
    Exr,
}

impl ExportFormat {
    /// Every format by its file extensions; some have two.
    pub const ALL: [(ExportFormat, &'static str); 7] = [
        (ExportFormat::Png, "png"),
        (ExportFormat::Exr, "exr"),
        (ExportFormat::Jpeg, "jpg"),
        (ExportFormat::Jpeg, "jpeg"),
        (ExportFormat::WebP, "webp"),
        (ExportFormat::Tiff, "tif"),
        (ExportFormat::Tiff, "tiff"),
    ];

    /// Bits a channel that it can have, the usual one first. Those of an EXR are floats.
    pub fn depths(self) -> &'static [u8] {
        match self {
            ExportFormat::Png | ExportFormat::Tiff => &[8, 16],
            ExportFormat::Exr => &[16, 32],
            ExportFormat::Jpeg | ExportFormat::WebP => &[8],
        }
    }

    /// The bits a channel that a picture is written with; `file` is for messages. Fails where the
    /// format has none such.
    pub fn bits(self, file: &Path, asked: Option<u8>) -> Result<u8> {
        let depths = self.depths();
        let bits = asked.unwrap_or(depths[0]);
        depths.contains(&bits).then_some(bits).ok_or_else(|| {
            let known: Vec<String> = depths.iter().map(u8::to_string).collect();
            Error::unsupported_file(
                file,
                format!("this format has {} bits a channel, not {bits}", known.join(" or ")),
            )
        })
    }

    /// The format for a file name.
    pub fn of(file: &Path) -> Result<ExportFormat> {
        let extension = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let found = Self::ALL.iter().find(|(_, known)| *known == extension);
        found.map(|(format, _)| *format).ok_or_else(|| {
            let known: Vec<_> = Self::ALL.iter().map(|(_, known)| format!(".{known}")).collect();
            Error::unsupported_file(
                file,
                format!("the name of a picture must end in {}", known.join(", ")),
            )
        })
    }
}

/// How a picture is written.
#[derive(Clone, Copy, Debug)]
pub struct ExportOptions {
    /// The color behind transparent parts; none by default.
    pub background: Option<Color>,
    /// Quality of a JPEG, 1 … 100.
    pub quality: u8,
    /// The print resolution, if the format can store it (PNG).
    pub dots_per_inch: Option<f32>,
    /// The part that is written; all of the canvas by default.
    pub crop: Option<Rect>,
    /// Bits a channel, one of [`ExportFormat::depths`]; the format's usual one by default.
    pub bits: Option<u8>,
    /// The profile that colors are converted to, and that the file names; that of the document by
    /// default.
    pub profile: Option<ColorProfile>,
}

impl Default for ExportOptions {
    fn default() -> Self {
        Self {
            background: None,
            quality: 92,
            dots_per_inch: None,
            crop: None,
            bits: None,
            profile: None,
        }
    }
}

/// The format that a file's name requests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Output {
    /// The whole document as a project.
    Project,
    /// The whole document as a Photoshop file.
    Psd,
    /// A flat picture.
    Picture(ExportFormat),
}

impl Output {
    /// Fails if the name requests no format that can be written.
    pub fn of(file: &Path) -> Result<Self> {
        let extension = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        Ok(match extension.as_str() {
            "ora" => Output::Project,
            "psd" => Output::Psd,
            _ => Output::Picture(ExportFormat::of(file)?),
        })
    }
}

/// A place to write to, checked before the work that fills it begins.
#[derive(Debug)]
pub struct OutputFile {
    named: PathBuf,
    terms: Terms,
}

impl OutputFile {
    /// Fails if the name requests no format that can be written, or where [`replace`] would.
    pub fn new(named: &Path, terms: Terms) -> Result<Self> {
        Output::of(named)?;
        check(&Disk, named, &terms)?;
        Ok(Self { named: named.into(), terms })
    }

    /// Flattens a document and writes it, with as many bits as requested; nothing if canceled. A
    /// shape that is still to be made is made first.
    pub fn write_document(
        &self,
        document: &Document,
        options: &ExportOptions,
        budget: &Budget,
        progress: &Progress,
    ) -> Result<()> {
        let Some(document) = document.reshaped_with_progress(progress) else { return Ok(()) };
        let bytes = high_depth::encode_document(&self.named, &document, options, budget, progress)?;
        bytes.map_or(Ok(()), |bytes| self.replace(&bytes))
    }

    /// Encodes and writes the part of a flattened picture that the canvas shows.
    ///
    /// * `profile`: what its numbers mean, which the file names.
    pub fn write(
        &self,
        pixels: &TileGrid,
        canvas: Size,
        options: &ExportOptions,
        profile: ColorProfile,
    ) -> Result<()> {
        let format = ExportFormat::of(&self.named)?;
        self.replace(&encode_in(&self.named, format, pixels, canvas, options, profile)?)
    }

    /// The target is the old file or the new one, never a part of it.
    pub fn replace(&self, bytes: &[u8]) -> Result<()> {
        // It can be canceled only during painting: writing is short.
        replace(&Disk, &self.named, bytes, &self.terms, &Progress::default()).map(drop)
    }
}

/// Renders a document to a picture file, in the format that its name ends in: `.png`, `.exr`,
/// `.jpg`, `.webp`, `.tif`.
///
/// The file is written wholly or not at all. Fails if the name requests no format that can be
/// written, if `over` does not allow to replace what is there, or if the disk refuses.
pub fn write_picture(document: &Document, file: &Path, over: Overwrite) -> Result<()> {
    let output = OutputFile::new(file, Terms::export(over, Vec::new()))?;
    output.write_document(
        document,
        &ExportOptions::default(),
        &Budget::of_this_machine(),
        &Progress::default(),
    )
}

/// The bytes of a picture file of sRGB; `file` is for messages.
pub fn encode(
    file: &Path,
    format: ExportFormat,
    pixels: &TileGrid,
    canvas: Size,
    options: &ExportOptions,
) -> Result<Vec<u8>> {
    encode_in(file, format, pixels, canvas, options, ColorProfile::Srgb)
}

/// The same of pixels in a color profile, which the file names.
pub fn encode_in(
    file: &Path,
    format: ExportFormat,
    pixels: &TileGrid,
    canvas: Size,
    options: &ExportOptions,
    profile: ColorProfile,
) -> Result<Vec<u8>> {
    let rect = options.crop.map_or(canvas.rect(), |crop| crop.intersect(canvas.rect()));
    if rect.is_empty() {
        return Err(Error::unsupported_file(file, "the part to write has no pixels"));
    }
    let canvas = Size::new(rect.width() as u32, rect.height() as u32);
    let straight = |rect: Rect| {
        let mut rgba = pixels.to_straight_rgba(rect);
        if let Some(background) = options.background {
            lay_on(&mut rgba, background);
        }
        rgba
    };
    match format {
        ExportFormat::Png => {
            let rows = strips(rect).map(straight);
            let written = png(rows, canvas, png::BitDepth::Eight, options, profile);
            written.map_err(|e| Error::unsupported_file(file, e))
        }
        ExportFormat::Jpeg => jpeg(file, &straight(rect), canvas, options.quality, profile),
        ExportFormat::WebP => webp(file, &straight(rect), canvas, profile),
        ExportFormat::Tiff => tiff(file, straight(rect), canvas, profile),
        ExportFormat::Exr => {
            exr(&straight(rect), canvas, profile).map_err(|e| Error::unsupported_file(file, e))
        }
    }
}

/// Straight pixels over a color, as a normal layer above a fill would show.
fn lay_on(rgba: &mut [u8], background: Color) {
    let under = background.premultiplied();
    for pixel in rgba.chunks_exact_mut(4) {
        let a = f32::from(pixel[3]) / 255.0;
        if pixel[3] == 255 {
            continue;
        }
        let alpha = a + under[3] * (1.0 - a);
        for (c, below) in pixel.iter_mut().zip(under).take(3) {
            let premultiplied = f32::from(*c) / 255.0 * a + below * (1.0 - a);
            *c = if alpha > 0.0 { srgb::quantize(premultiplied / alpha) } else { 0 };
        }
        pixel[3] = srgb::quantize(alpha);
    }
}

fn tiff(file: &Path, rgba: Vec<u8>, size: Size, profile: ColorProfile) -> Result<Vec<u8>> {
    let image = image::RgbaImage::from_raw(size.width, size.height, rgba);
    high_depth::tiff(file, image.map(image::DynamicImage::ImageRgba8), profile)
}

/// Pixels a meter.
fn png_resolution(dots_per_inch: f32) -> png::PixelDimensions {
    let per_meter = (dots_per_inch / 0.0254).round() as u32;
    png::PixelDimensions { xppu: per_meter, yppu: per_meter, unit: png::Unit::Meter }
}

/// Straight RGBA of 8 bits, or of 16 with the larger byte first, a few rows at a time.
fn png(
    strips: impl Iterator<Item = Vec<u8>>,
    size: Size,
    depth: png::BitDepth,
    options: &ExportOptions,
    profile: ColorProfile,
) -> Result<Vec<u8>, png::EncodingError> {
    /// Size of a chunk of packed pixels.
    const CHUNK_BYTES: usize = 1 << 20;
    let mut bytes = Vec::new();
    let mut info = png::Info::with_size(size.width, size.height);
    (info.color_type, info.bit_depth) = (png::ColorType::Rgba, depth);
    info.icc_profile = to_embed(profile).map(Into::into);
    let mut encoder = png::Encoder::with_info(&mut bytes, info)?;
    if profile == ColorProfile::Srgb {
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    }
    encoder.set_pixel_dims(options.dots_per_inch.map(png_resolution));
    let mut writer = encoder.write_header()?;
    let mut rows = writer.stream_writer_with_size(CHUNK_BYTES)?;
    for strip in strips {
        rows.write_all(&strip)?;
    }
    rows.finish()?;
    writer.finish()?;
    Ok(bytes)
}

fn jpeg(
    file: &Path,
    rgba: &[u8],
    size: Size,
    quality: u8,
    profile: ColorProfile,
) -> Result<Vec<u8>> {
    if rgba.chunks_exact(4).any(|pixel| pixel[3] != 255) {
        let reason = "the picture has transparent parts, and a JPEG cannot store them";
        return Err(Error::unsupported_file(file, reason).with_remedy(Remedy::Background));
    }
    if size.width.max(size.height) > u16::MAX.into() {
        return Err(Error::unsupported_file(
            file,
            format!("a JPEG has at most 65535 pixels a side, not {size}"),
        ));
    }
    let rgb: Vec<u8> =
        rgba.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder =
        image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, quality.clamp(1, 100));
    name_profile(file, &mut encoder, profile)?;
    let encoded = encoder.encode(&rgb, size.width, size.height, image::ExtendedColorType::Rgb8);
    encoded.map_err(|e| Error::unsupported_file(file, e))?;
    Ok(bytes.into_inner())
}

fn webp(file: &Path, rgba: &[u8], size: Size, profile: ColorProfile) -> Result<Vec<u8>> {
    if size.width.max(size.height) > 16_384 {
        return Err(Error::unsupported_file(
            file,
            format!("a WebP has at most 16384 pixels a side, not {size}"),
        ));
    }
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = image::codecs::webp::WebPEncoder::new_lossless(&mut bytes);
    name_profile(file, &mut encoder, profile)?;
    let encoded = encoder.encode(rgba, size.width, size.height, image::ExtendedColorType::Rgba8);
    encoded.map_err(|e| Error::unsupported_file(file, e))?;
    Ok(bytes.into_inner())
}

/// Puts a profile into a file; none of sRGB.
fn name_profile(
    file: &Path,
    encoder: &mut impl image::ImageEncoder,
    profile: ColorProfile,
) -> Result<()> {
    let Some(icc) = to_embed(profile) else { return Ok(()) };
    encoder.set_icc_profile(icc.to_vec()).map_err(|e| Error::unsupported_file(file, e))
}

fn exr(rgba: &[u8], size: Size, profile: ColorProfile) -> Result<Vec<u8>, exr::error::Error> {
    high_depth::exr(size, 16, profile, |i| {
        let [r, g, b, a] = std::array::from_fn(|c| rgba[4 * i + c]);
        let alpha = f32::from(a) / 255.0;
        let light = |c: u8| srgb::decode_u8(c) * alpha;
        [light(r), light(g), light(b), alpha]
    })
}

#[cfg(test)]
mod tests;
