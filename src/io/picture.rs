//! Pictures to paint with: any readable file as sRGB bytes or linear light, in its upright
//! position. Floor 5. Not here: normal, depth and mask maps, which are data and whose color tags
//! are ignored (`maps`).

mod light;
mod painted;
mod passes;

pub use crate::pixels::Painted;
pub use light::read_finished_picture;
pub use painted::decode_paint;
pub use passes::{LightLayer, layers};

use super::bitmap::Bitmap;
use super::exr::{self, ExrFile};
use super::{Budget, bitmap, pixels, svg};
use crate::icc_profiles::is_display_p3;
use crate::math::{ColorProfile, Size, srgb};
use crate::raster::picture::Texels;
use crate::raster::{Asset, Picture, Plane, TileGrid, tile};
use crate::{Error, Result};
use image::DynamicImage;
use moxcms::{DataColorSpace, Layout, TransformOptions};
use std::path::Path;

/// Decodes any format of `bitmap`, EXR or SVG, distinguished by their first bytes.
///
/// * `file`: for messages (and for TGA, which only its name identifies).
///
/// Integer files become sRGB bytes (through their ICC profile where it says something else; Display
/// P3 stays for a document in Display P3), float files linear light. EXR gives its color layer,
/// straight alpha; integers of 16 bits are kept along with the bytes. Fails with a sentence on
/// anything damaged, unknown or beyond `budget`. The picture keeps `bytes`, so that a project can
/// store the file as it is.
pub fn decode(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Picture> {
    if svg::is_svg(bytes) {
        return svg::decode(file, bytes, budget);
    }
    let is_exr = ExrFile::is_exr(bytes);
    let picture = if is_exr {
        light::decode(file, bytes, budget)
    } else {
        picture_of(file, decode_upright(file, bytes, budget)?, budget)
    }?;
    Ok(Picture { encoded: Some(Asset::from(bytes.to_vec())), ..picture })
}

/// A picture as a file, without loss, and the extension of its format: a PNG of 8
/// or 16 bits, or an EXR of light.
///
/// * `file`: for messages.
pub fn encode(file: &Path, picture: &Picture) -> Result<(Asset, &'static str)> {
    let size = picture.size;
    match (&picture.texels, &picture.texels16) {
        (Texels::Srgb8(_), Some(texels16)) => Ok((pixels::encode16(file, texels16, size)?, "png")),
        (Texels::Srgb8(texels), None) => Ok((pixels::encode_texels(file, texels, size)?, "png")),
        (Texels::Linear(light), _) => Ok((exr::encode_light(file, size, light)?.into(), "exr")),
    }
}

/// Whether the colors of a picture file are Display P3 or anything else, by its header.
pub fn profile_of(file: &Path, bytes: &[u8], budget: &Budget) -> ColorProfile {
    if ExrFile::is_exr(bytes) {
        return ExrFile::open(file, bytes, budget).map_or(ColorProfile::Srgb, |exr| exr.profile());
    }
    let icc = bitmap::icc_profile(file, bytes, budget);
    let is_p3 = !svg::is_svg(bytes) && icc.is_some_and(|icc| is_display_p3(&icc));
    if is_p3 { ColorProfile::DisplayP3 } else { ColorProfile::Srgb }
}

/// A decoded file in its upright position, without the profile of colors that stay.
fn decode_upright(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Bitmap> {
    let mut bitmap = bitmap::decode(file, bytes, budget)?;
    bitmap.image.apply_orientation(bitmap.orientation);
    let stays = budget.profile == ColorProfile::DisplayP3;
    bitmap.icc = bitmap.icc.filter(|icc| !(stays && is_display_p3(icc)));
    Ok(bitmap)
}

fn picture_of(file: &Path, bitmap: Bitmap, budget: &Budget) -> Result<Picture> {
    let size = Size::new(bitmap.image.width(), bitmap.image.height());
    let picture = match &bitmap.image {
        image if is_light(image) => {
            let texels = bitmap.image.into_rgba32f().into_raw().as_chunks().0.to_vec();
            let profiled =
                bitmap.icc.as_deref().and_then(|icc| light_through_profile(&texels, icc));
            Picture::linear(size, profiled.unwrap_or(texels))
        }
        image if is_sixteen_bits(image) => {
            // In addition to what was decoded: texels of both kinds.
            let asked = image.as_bytes().len() as u64 + 12 * size.area() as u64;
            budget.room(
                file,
                &format!("a picture of {size} pixels of 16 bits a channel"),
                asked,
            )?;
            let profiled = bitmap.icc.as_deref().and_then(|icc| convert_by_profile(image, icc));
            let plain = || bitmap.image.into_rgba16().into_raw().as_chunks().0.to_vec();
            Picture::srgb16(size, profiled.unwrap_or_else(plain))
        }
        image => {
            let profiled = bitmap.icc.as_deref().and_then(|icc| convert_by_profile(image, icc));
            let profiled = profiled.map(|texels| texels.iter().map(|t| t.map(byte)).collect());
            let plain = || bitmap.image.into_rgba8().into_raw().as_chunks().0.to_vec();
            Picture::srgb8(size, profiled.unwrap_or_else(plain))
        }
    };
    picture.ok_or_else(|| Error::decode(file, "the picture has no pixels"))
}

fn is_sixteen_bits(image: &DynamicImage) -> bool {
    matches!(
        image,
        DynamicImage::ImageLuma16(_)
            | DynamicImage::ImageLumaA16(_)
            | DynamicImage::ImageRgb16(_)
            | DynamicImage::ImageRgba16(_)
    )
}

fn is_light(image: &DynamicImage) -> bool {
    matches!(image, DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_))
}

/// The byte nearest to a value of 16 bits.
fn byte(v: u16) -> u8 {
    tile::sixteen_bit::byte_of(v)
}

/// A picture as the tiles of a paint layer, its corner at a canvas pixel, of 16 bits where it has
/// more than 8; light beyond white is clipped, as a texture clips it.
pub fn to_tiles(picture: &Picture, x: i32, y: i32) -> TileGrid {
    let (w, h) = (picture.size.width as usize, picture.size.height as usize);
    match (&picture.texels, &picture.texels16) {
        (Texels::Srgb8(_), Some(texels16)) => TileGrid::from_straight16(texels16, w, h, x, y),
        (Texels::Srgb8(texels), None) => {
            TileGrid::from_straight_rgba(texels.as_flattened(), w, h, x, y)
        }
        (Texels::Linear(light), _) => TileGrid::from_light(light, w, h, x, y),
    }
}

/// Reads a mask: encoded luminance × alpha, 255 wholly covered. Color profiles are ignored.
pub fn decode_coverage(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Plane<u8>> {
    let plane = if ExrFile::is_exr(bytes) {
        let exr = ExrFile::open(file, bytes, budget)?;
        let mut covered = Vec::with_capacity(exr.size().area());
        light::in_bands(file, &exr, light::choose_pass(file, &exr)?, |texels| {
            covered.extend(texels.iter().map(|&t| coverage(t)));
            Ok(())
        })?;
        Plane::from_values(exr.size(), covered)
    } else {
        let mut bitmap = bitmap::decode(file, bytes, budget)?;
        bitmap.image.apply_orientation(bitmap.orientation);
        let size = Size::new(bitmap.image.width(), bitmap.image.height());
        let mut covered = Vec::with_capacity(size.area());
        for strip in strips(&bitmap.image) {
            covered
                .extend(strip.into_rgba32f().as_raw().as_chunks().0.iter().map(|&t| coverage(t)));
        }
        Plane::from_values(size, covered)
    };
    plane.ok_or_else(|| Error::decode(file, "the mask has no pixels"))
}

/// Rows of a strip.
const STRIP_ROWS: u32 = 64;

/// An image in strips of a few rows, so that intermediate results are never as large as the image.
fn strips(image: &DynamicImage) -> impl Iterator<Item = DynamicImage> {
    let (w, h) = (image.width(), image.height());
    (0..h).step_by(STRIP_ROWS as usize).map(move |y| image.crop_imm(0, y, w, STRIP_ROWS.min(h - y)))
}

fn coverage([r, g, b, a]: [f32; 4]) -> u8 {
    srgb::quantize(srgb::luminance(r, g, b) * a)
}

/// Straight RGBA bytes in the colors of an ICC profile as sRGB; unchanged if `convert_by_profile`
/// finds nothing to do.
///
/// * `is_gray`: red, green and blue are equal, and the profile is one of gray.
pub fn to_srgb(size: Size, rgba: Vec<u8>, is_gray: bool, icc: &[u8]) -> Vec<u8> {
    let Some(image) = image::RgbaImage::from_raw(size.width, size.height, rgba) else {
        return Vec::new();
    };
    let image = if is_gray {
        let two = image.pixels().flat_map(|pixel| [pixel[0], pixel[3]]).collect();
        image::ImageBuffer::from_raw(size.width, size.height, two)
            .map(DynamicImage::ImageLumaA8)
            .unwrap_or_default()
    } else {
        DynamicImage::ImageRgba8(image)
    };
    match convert_by_profile(&image, icc) {
        Some(texels) => texels.into_flattened().into_iter().map(byte).collect(),
        None => image.into_rgba8().into_raw(),
    }
}

/// The same for straight values of 16 bits.
pub fn to_srgb16(size: Size, texels: Vec<[u16; 4]>, is_gray: bool, icc: &[u8]) -> Vec<[u16; 4]> {
    let image = if is_gray {
        let two = texels.iter().flat_map(|[gray, .., alpha]| [*gray, *alpha]).collect();
        image::ImageBuffer::from_raw(size.width, size.height, two).map(DynamicImage::ImageLumaA16)
    } else {
        let four = texels.as_flattened().to_vec();
        image::ImageBuffer::from_raw(size.width, size.height, four).map(DynamicImage::ImageRgba16)
    };
    image.and_then(|image| convert_by_profile(&image, icc)).unwrap_or(texels)
}

/// Straight sRGB of an integer image in the colors of its ICC profile, 16 bits a channel.
///
/// `None` where the profile is sRGB as far as a byte can tell (so that such files keep their
/// bytes), does not belong to the image's kind of color, or cannot be used.
fn convert_by_profile(image: &DynamicImage, icc: &[u8]) -> Option<Vec<[u16; 4]>> {
    let profile = moxcms::ColorProfile::new_from_slice(icc).ok()?;
    let gray = matches!(
        image,
        DynamicImage::ImageLuma8(_)
            | DynamicImage::ImageLumaA8(_)
            | DynamicImage::ImageLuma16(_)
            | DynamicImage::ImageLumaA16(_)
    );
    let layout = match (profile.color_space, gray) {
        (DataColorSpace::Rgb, false) => Layout::Rgba,
        (DataColorSpace::Gray, true) => Layout::GrayAlpha,
        _ => return None,
    };
    let target = moxcms::ColorProfile::new_srgb();
    let transform = profile
        .create_transform_16bit(layout, &target, Layout::Rgba, TransformOptions::default())
        .ok()?;
    let run = |source: &[u16]| {
        let mut out = vec![0u16; source.len() / layout.channels() * 4];
        transform.transform(source, &mut out).ok().map(|()| out)
    };
    let probe = probe(layout);
    let moved = run(&probe)?.as_chunks::<4>().0.iter().zip(probe.chunks(layout.channels())).any(
        |(to, from)| {
            let from = if gray { [from[0]; 3] } else { [from[0], from[1], from[2]] };
            (0..3).any(|c| byte(to[c]).abs_diff(byte(from[c])) > 1)
        },
    );
    moved.then_some(())?;
    let mut texels = Vec::with_capacity(image.width() as usize * image.height() as usize);
    for strip in strips(image) {
        let source = if gray {
            strip.into_luma_alpha16().into_raw()
        } else {
            strip.into_rgba16().into_raw()
        };
        texels.extend_from_slice(run(&source)?.as_chunks::<4>().0);
    }
    Some(texels)
}

/// Linear light of float texels in the colors of an ICC profile; beyond white it is clipped.
///
/// `None` where the profile's light is sRGB's and linear (so that such files keep what is beyond
/// white), or cannot be used.
fn light_through_profile(texels: &[[f32; 4]], icc: &[u8]) -> Option<Vec<[f32; 4]>> {
    let profile = moxcms::ColorProfile::new_from_slice(icc).ok()?;
    let layout = match profile.color_space {
        DataColorSpace::Rgb => Layout::Rgba,
        DataColorSpace::Gray => Layout::GrayAlpha,
        _ => return None,
    };
    let options = TransformOptions::default();
    let transform = profile
        .create_transform_f32(layout, &moxcms::ColorProfile::new_srgb(), Layout::Rgba, options)
        .ok()?;
    let run = |texels: &[[f32; 4]]| -> Option<Vec<[f32; 4]>> {
        let bounded = |v: f32| v.max(0.0).min(1.0);
        let source: Vec<f32> = match layout {
            Layout::Rgba => texels.iter().flat_map(|texel| texel.map(bounded)).collect(),
            _ => texels.iter().flat_map(|texel| [bounded(texel[0]), bounded(texel[3])]).collect(),
        };
        let mut out = vec![0.0; texels.len() * 4];
        transform.transform(&source, &mut out).ok()?;
        let light = |[r, g, b, a]: [f32; 4]| {
            [srgb::decode(bounded(r)), srgb::decode(bounded(g)), srgb::decode(bounded(b)), a]
        };
        Some(out.as_chunks().0.iter().map(|texel| light(*texel)).collect())
    };
    let probe: Vec<[f32; 4]> = probe(Layout::Rgba)
        .as_chunks()
        .0
        .iter()
        .map(|t: &[u16; 4]| t.map(|v| f32::from(v) / 65535.0))
        .collect();
    let probe: Vec<[f32; 4]> = match layout {
        Layout::Rgba => probe,
        _ => probe.into_iter().map(|[r, _, _, a]| [r, r, r, a]).collect(),
    };
    let differs = |(a, b): (&[f32; 4], &[f32; 4])| (0..3).any(|c| (a[c] - b[c]).abs() > 2e-3);
    run(&probe)?.iter().zip(&probe).any(differs).then_some(())?;
    run(texels)
}

/// Colors spread over the cube (or the ramp), opaque.
fn probe(layout: Layout) -> Vec<u16> {
    let level = |i: usize| (i * 13107) as u16;
    match layout {
        Layout::Rgba => (0..216)
            .flat_map(|i| [level(i % 6), level(i / 6 % 6), level(i / 36), u16::MAX])
            .collect(),
        _ => (0..256).flat_map(|i| [(i * 257) as u16, u16::MAX]).collect(),
    }
}

#[cfg(test)]
mod tests;
