//! Maps as their files store them: numbers per channel. Only the layer of an EXR is chosen; nothing
//! else is interpreted. Floor 5. Color tags (sRGB, gAMA, iCCP) are ignored here: maps are data.

use super::channel::{Channel, channels};
use super::layers::{self, MapRole};
use crate::math::Size;
use crate::{Budget, bitmap, exr::ExrFile};
use crate::{Error, Result};
use std::path::{Path, PathBuf};

/// The contents of one map file.
pub struct StoredMap {
    pub file: PathBuf,
    pub size: Size,
    /// One to four channels: red, green, blue, alpha of a picture; x, y, z of an EXR layer. `[0,
    /// 1]` in integer files.
    pub channels: Vec<Channel>,
    /// Coverage stored in the file, `[0, 1]`; absent if it is 1 everywhere.
    pub alpha: Option<Channel>,
    /// The step between two neighboring numbers of an integer file: 1/255 or 1/65535.
    pub step: Option<f32>,
    /// JPEG, or EXR's B44: equal pixels may differ a little, and the background bleeds into the
    /// rim.
    pub lossy: bool,
    /// The EXR layer, for messages; empty otherwise.
    pub layer: String,
    pub world_to_camera: Option<[f32; 16]>,
    pub fov_degrees: Option<f32>,
    /// A defect of the file that could be worked around.
    pub warning: Option<&'static str>,
}

/// Reads one map; `channel` names an EXR layer or channel, or one of `r g b a` of a picture.
pub fn load(
    file: &Path,
    bytes: &[u8],
    channel: Option<&str>,
    role: MapRole,
    budget: &Budget,
) -> Result<StoredMap> {
    if ExrFile::is_exr(bytes) {
        load_exr(file, bytes, channel, role, budget)
    } else {
        load_bitmap(file, bytes, channel, budget)
    }
}

fn load_exr(
    file: &Path,
    bytes: &[u8],
    channel: Option<&str>,
    role: MapRole,
    budget: &Budget,
) -> Result<StoredMap> {
    let exr = ExrFile::open(file, bytes, budget)?;
    let choice = layers::choose(file, &exr, channel, role)?;
    let wanted: Vec<usize> = choice.channels.iter().chain(&choice.alpha).copied().collect();
    let stored = wanted.len() as u64 * size_of::<f32>() as u64;
    budget.room(
        file,
        &surface_of(exr.size()),
        exr.size().area() as u64 * (PEAK_BYTES_PER_PX + stored),
    )?;
    let mut channels = exr.read(&wanted)?;
    let alpha = if choice.alpha.is_some() { channels.pop() } else { None };
    // Beyond the data window there is nothing: alpha 0, and NaN in every other channel.
    let alpha = alpha.map(|a| a.map(|v| if v.is_finite() { v.max(0.0).min(1.0) } else { 0.0 }));
    Ok(StoredMap {
        file: file.into(),
        size: exr.size(),
        channels: channels.into_iter().map(Channel::Float).collect(),
        alpha: alpha.map(Channel::Float).filter(Channel::is_below_one),
        step: None,
        lossy: exr.compression().starts_with("b44"),
        layer: choice.name,
        world_to_camera: exr.world_to_camera(),
        fov_degrees: exr.fov_degrees(),
        warning: None,
    })
}

fn load_bitmap(
    file: &Path,
    bytes: &[u8],
    channel: Option<&str>,
    budget: &Budget,
) -> Result<StoredMap> {
    let bitmap = bitmap::decode(file, bytes, budget)?;
    let image = bitmap.image;
    let size = Size::new(image.width(), image.height());
    let step = match image.color().bytes_per_pixel() / image.color().channel_count() {
        1 => Some(1.0 / 255.0),
        2 => Some(1.0 / 65535.0),
        _ => None,
    };
    let (colors, has_alpha) =
        (if image.color().has_color() { 3 } else { 1 }, image.color().has_alpha());
    let stored = u64::from(image.color().bytes_per_pixel());
    budget.room(file, &surface_of(size), size.area() as u64 * (PEAK_BYTES_PER_PX + stored))?;
    let mut stored = StoredMap {
        file: file.into(),
        size,
        channels: channels(image),
        alpha: None,
        step,
        lossy: bitmap.format == "JPEG",
        layer: String::new(),
        world_to_camera: None,
        fov_degrees: None,
        warning: bitmap.warning,
    };
    if let Some(name) = channel {
        let at = match name.to_ascii_lowercase().as_str() {
            "r" | "y" | "l" => Some(0),
            "g" => Some(1),
            "b" => Some(2),
            "a" => Some(colors),
            _ => None,
        };
        let plane = at.and_then(|i| stored.channels.get(i).cloned());
        let reason =
            format!("this picture has no channel “{name}”; its channels are called r, g, b and a");
        stored.channels = vec![plane.ok_or_else(|| Error::invalid(file, "channel", reason))?];
    } else if has_alpha {
        stored.alpha = stored.channels.last().filter(|alpha| alpha.is_below_one()).cloned();
    }
    Ok(stored)
}

/// Memory of the largest step from maps to a surface, besides the stored maps, measured on one of
/// 8192².
const PEAK_BYTES_PER_PX: u64 = 28;

fn surface_of(size: Size) -> String {
    format!("a surface of {size} pixels")
}

impl StoredMap {
    /// The first three channels at a pixel, 0 where there are fewer; the fourth is alpha or a
    /// fourth channel.
    pub fn texel(&self, i: usize) -> [f32; 4] {
        std::array::from_fn(|c| self.channels.get(c).map_or(0.0, |channel| channel.at(i)))
    }

    /// The number of the file's color channels, alpha not counted.
    pub fn colors(&self) -> usize {
        match self.channels.len() {
            2 if self.step.is_some() => 1,
            4 => 3,
            n => n,
        }
    }

    /// Whether all color channels are equal at every pixel, as in a gray picture stored as RGB.
    pub fn is_gray(&self, tolerance: f32) -> bool {
        let first = &self.channels[0];
        let others = self.channels.iter().take(self.colors()).skip(1);
        let area = self.size.area();
        others.into_iter().all(|other| {
            let far = (0..area).filter(|&i| (other.at(i) - first.at(i)).abs() > tolerance);
            far.count() * 1000 <= area
        })
    }
}
