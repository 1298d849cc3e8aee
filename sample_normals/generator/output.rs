//! Files: maps as PNG, pictures as PNG or JPEG. The only module that writes.

use std::error::Error;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::Path;

use image::codecs::hdr::HdrEncoder;
use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, Rgb, Rgba, RgbaImage};

use crate::photometry::Captured;
use crate::render::Maps;

type Outcome = Result<(), Box<dyn Error>>;

/// Normals keep this many of 16 bits: errors of 0.004 degrees, and much smaller files.
const NORMAL_BITS: u32 = 14;
/// Depth keeps this many of 16 bits.
const DEPTH_BITS: u32 = 15;

/// Writes `normal.png`, `depth.png` and `mask.png` into `folder`.
pub fn write_maps(folder: &Path, maps: &Maps) -> Outcome {
    fs::create_dir_all(folder)?;
    let normal: Vec<u16> = maps
        .normal
        .iter()
        .flat_map(|n| n.to_array())
        .map(|c| quantized(c * 0.5 + 0.5, NORMAL_BITS))
        .collect();
    let depth: Vec<u16> = maps.depth.iter().map(|z| quantized(*z, DEPTH_BITS)).collect();
    let mask: Vec<u8> = maps.coverage.iter().map(|c| (c * 255.0).round() as u8).collect();
    let size = (maps.width as u32, maps.height as u32);
    write_png(&folder.join("normal.png"), &bytes(&normal), size, ExtendedColorType::Rgb16)?;
    write_png(&folder.join("depth.png"), &bytes(&depth), size, ExtendedColorType::L16)?;
    write_png(&folder.join("mask.png"), &mask, size, ExtendedColorType::L8)
}

/// Writes `normal.png`, `mask.png` and `photo.jpg` into `folder`: a rig gives no depth.
pub fn write_captured(folder: &Path, captured: &Captured) -> Outcome {
    write_picture(&folder.join("normal.png"), &captured.normals)?;
    write_picture(&folder.join("photo.jpg"), &captured.photograph)?;
    let size = captured.normals.dimensions();
    write_png(&folder.join("mask.png"), &captured.mask, size, ExtendedColorType::L8)
}

/// A value in `[0, 1]` as 16 bits, rounded to a multiple of `2^(16 − bits)`.
fn quantized(value: f64, bits: u32) -> u16 {
    let step = f64::from(1u32 << (16 - bits));
    ((value.clamp(0.0, 1.0) * 65535.0 / step).round() * step).min(65535.0) as u16
}

fn bytes(values: &[u16]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_ne_bytes()).collect()
}

fn write_png(path: &Path, data: &[u8], (w, h): (u32, u32), color: ExtendedColorType) -> Outcome {
    let file = BufWriter::new(File::create(path)?);
    PngEncoder::new_with_quality(file, CompressionType::Best, FilterType::Adaptive)
        .write_image(data, w, h, color)?;
    Ok(())
}

/// Writes a picture: `.png` with its alpha, `.jpg` without.
pub fn write_picture(path: &Path, picture: &RgbaImage) -> Outcome {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    let size = picture.dimensions();
    if path.extension().is_some_and(|ending| ending == "jpg") {
        let file = BufWriter::new(File::create(path)?);
        let rgb: Vec<u8> = picture.pixels().flat_map(|Rgba([r, g, b, _])| [*r, *g, *b]).collect();
        JpegEncoder::new_with_quality(file, 88).write_image(
            &rgb,
            size.0,
            size.1,
            ExtendedColorType::Rgb8,
        )?;
        return Ok(());
    }
    if picture.pixels().all(|p| p[3] == 255) {
        let rgb: Vec<u8> = picture.pixels().flat_map(|Rgba([r, g, b, _])| [*r, *g, *b]).collect();
        return write_png(path, &rgb, size, ExtendedColorType::Rgb8);
    }
    write_png(path, picture.as_raw(), size, ExtendedColorType::Rgba8)
}

/// Writes linear light as a Radiance picture.
pub fn write_light(path: &Path, width: usize, height: usize, light: &[Rgb<f32>]) -> Outcome {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    HdrEncoder::new(BufWriter::new(File::create(path)?)).encode(light, width, height)?;
    Ok(())
}
