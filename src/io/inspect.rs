//! Describes a file before its use is decided: format, size, channels and layers.
//! Floor 5. `info` prints it; a dialog that opens a file shows it. Conventions are `maps`' work.

use super::maps::{MapRole, fitting};
use super::{Budget, bitmap, exr::ExrFile};
use crate::Result;
use crate::math::Size;
use std::path::Path;

/// A layer of an EXR.
#[derive(Clone, Debug, PartialEq)]
pub struct ExrLayer {
    /// Empty for the channels without a layer.
    pub name: String,
    /// The channels' whole names and kinds: half, float or uint.
    pub channels: Vec<(String, &'static str)>,
}

/// A picture file from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct FileDescription {
    /// `PNG`, `EXR`, …
    pub format: &'static str,
    pub size: Size,
    /// Of pictures: `r`, `g`, `b`, `a`, or `y` where grey. Of EXR: the channels' whole names.
    pub channels: Vec<String>,
    /// Bits of a channel; of EXR those of the widest.
    pub bits: u8,
    /// EXR only: its layers, and what its pixels are compressed with.
    pub layers: Vec<ExrLayer>,
    pub compression: Option<String>,
    /// EXR only: layers that fit as normals and as depth, the likeliest first.
    pub normals: Vec<String>,
    pub depths: Vec<String>,
    /// No two colour channels differ.
    pub is_grey: bool,
    /// Whether it is a colour picture whose texels, read as normals, have length 1.
    pub looks_like_normals: bool,
    /// A defect that could be worked around.
    pub warning: Option<&'static str>,
}

/// Describes a file. EXR pixels are not decoded; other formats' are, so that damage shows.
pub fn describe(file: &Path, bytes: &[u8], budget: &Budget) -> Result<FileDescription> {
    if ExrFile::is_exr(bytes) { describe_exr(file, bytes, budget) } else { describe_bitmap(file, bytes, budget) }
}

fn describe_exr(file: &Path, bytes: &[u8], budget: &Budget) -> Result<FileDescription> {
    let exr = ExrFile::open(file, bytes, budget)?;
    let of = |i: &usize| exr.channels().get(*i).map(|c| (c.name.clone(), c.kind));
    let layers = exr
        .passes()
        .iter()
        .map(|p| ExrLayer { name: p.name.clone(), channels: p.channels.iter().filter_map(of).collect() });
    Ok(FileDescription {
        format: "EXR",
        size: exr.size(),
        channels: exr.channels().iter().map(|c| c.name.clone()).collect(),
        bits: if exr.channels().iter().all(|c| c.kind == "half") { 16 } else { 32 },
        layers: layers.collect(),
        compression: Some(exr.compression()),
        normals: fitting(&exr, MapRole::Normals),
        depths: fitting(&exr, MapRole::Depth),
        is_grey: exr.channels().len() == 1,
        looks_like_normals: false,
        warning: None,
    })
}

fn describe_bitmap(file: &Path, bytes: &[u8], budget: &Budget) -> Result<FileDescription> {
    let bitmap = bitmap::decode(file, bytes, budget)?;
    let image = &bitmap.image;
    let colour = image.color();
    let names: &[&str] = if colour.has_color() { &["r", "g", "b", "a"] } else { &["y", "a"] };
    let texels = texels(image);
    let is_grey = texels.iter().all(|[r, g, b]| r == g && g == b);
    Ok(FileDescription {
        format: bitmap.format,
        size: Size::new(image.width(), image.height()),
        channels: names.iter().take(colour.channel_count().into()).map(ToString::to_string).collect(),
        bits: (colour.bits_per_pixel() / u16::from(colour.channel_count())) as u8,
        layers: Vec::new(),
        compression: None,
        normals: Vec::new(),
        depths: Vec::new(),
        is_grey,
        looks_like_normals: !is_grey && length_error(&texels) < 0.06,
        warning: bitmap.warning,
    })
}

/// Colours spread over the picture.
fn texels(image: &image::DynamicImage) -> Vec<[f32; 3]> {
    use image::GenericImageView;
    let (w, h) = image.dimensions();
    let step = (f64::from(w) * f64::from(h) / 40_000.0).sqrt().ceil().max(1.0) as usize;
    let rows = (0..h).step_by(step);
    let at = |x: u32, y: u32| {
        let [r, g, b, _] = image.get_pixel(x, y).0;
        [r, g, b].map(|v| f32::from(v) / 255.0)
    };
    rows.flat_map(|y| (0..w).step_by(step).map(move |x| (x, y))).map(|(x, y)| at(x, y)).collect()
}

/// Mean of | |2 v − 1| − 1 |.
fn length_error(texels: &[[f32; 3]]) -> f32 {
    let error = |t: &[f32; 3]| (t.iter().map(|v| (2.0 * v - 1.0).powi(2)).sum::<f32>().sqrt() - 1.0).abs();
    texels.iter().map(error).sum::<f32>() / texels.len().max(1) as f32
}
