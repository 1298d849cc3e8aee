//! Pictures to paint with: any readable file as sRGB bytes or linear light, in its upright position.
//! Floor 5. Not here: normal, depth and mask maps, which are data and whose colour tags are ignored (`maps`).

use super::{Budget, bitmap, exr::ExrFile};
use crate::math::{Size, srgb};
use crate::raster::grid::unpremultiply;
use crate::raster::picture::Texels;
use crate::raster::{Asset, Picture, Plane, Texture, TileGrid};
use crate::{Error, Result};
use image::DynamicImage;
use moxcms::{ColorProfile, DataColorSpace, Layout, TransformOptions};
use std::path::Path;

/// Decodes PNG, JPEG, WebP, TIFF, BMP, TGA, HDR or EXR, told apart by their first bytes.
///
/// * `file`: for messages (and for TGA, which only its name tells).
///
/// Integer files become sRGB bytes (through their ICC profile where it says something else), float files linear light.
/// EXR gives its colour layer, straight alpha. Fails with a sentence on anything damaged, unknown or beyond `budget`.
/// The picture keeps `bytes`, so that a project can store the file as it is.
pub fn decode(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Picture> {
    let is_exr = ExrFile::is_exr(bytes);
    let picture = if is_exr { decode_exr(file, bytes, budget) } else { decode_bitmap(file, bytes, budget) }?;
    Ok(Picture { encoded: Some(Asset::from(bytes.to_vec())), ..picture })
}

fn decode_bitmap(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Picture> {
    let mut bitmap = bitmap::decode(file, bytes, budget)?;
    bitmap.image.apply_orientation(bitmap.orientation);
    let size = Size::new(bitmap.image.width(), bitmap.image.height());
    let picture = match &bitmap.image {
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
            Picture::linear(size, bitmap.image.to_rgba32f().into_raw().as_chunks().0.to_vec())
        }
        image => {
            let profiled = bitmap.icc.as_deref().and_then(|icc| through_profile(image, icc));
            Picture::srgb8(size, profiled.unwrap_or_else(|| image.to_rgba8().into_raw().as_chunks().0.to_vec()))
        }
    };
    picture.ok_or_else(|| Error::decode(file, "the picture has no pixels"))
}

/// A picture as the tiles of a paint layer, its corner at a canvas pixel; light beyond white is clipped, as a texture clips it.
pub fn to_tiles(picture: &Picture, x: i32, y: i32) -> TileGrid {
    let (w, h) = (picture.size.width as usize, picture.size.height as usize);
    match &picture.texels {
        Texels::Srgb8(texels) => TileGrid::from_straight_rgba(texels.as_flattened(), w, h, x, y),
        Texels::Linear(_) => {
            let texture = Texture::new(picture);
            let mut straight = vec![0; w * h * 4];
            unpremultiply(texture.levels()[0].texels.as_flattened(), &mut straight);
            TileGrid::from_straight_rgba(&straight, w, h, x, y)
        }
    }
}

/// Reads a mask: encoded luminance × alpha, 255 wholly covered. Colour profiles are ignored.
pub fn decode_coverage(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Plane<u8>> {
    let plane = if ExrFile::is_exr(bytes) {
        let exr = ExrFile::open(file, bytes, budget)?;
        let size = exr.size();
        let texels = exr_texels(file, &exr)?;
        Plane::from_values(size, texels.iter().map(|&t| coverage(t)).collect())
    } else {
        let mut bitmap = bitmap::decode(file, bytes, budget)?;
        bitmap.image.apply_orientation(bitmap.orientation);
        let size = Size::new(bitmap.image.width(), bitmap.image.height());
        let texels = bitmap.image.into_rgba32f();
        Plane::from_values(size, texels.as_raw().as_chunks().0.iter().map(|&t| coverage(t)).collect())
    };
    plane.ok_or_else(|| Error::decode(file, "the mask has no pixels"))
}

fn coverage([r, g, b, a]: [f32; 4]) -> u8 {
    srgb::quantise(srgb::luminance(r, g, b) * a)
}

fn decode_exr(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Picture> {
    let exr = ExrFile::open(file, bytes, budget)?;
    let mut texels = exr_texels(file, &exr)?;
    // EXR's alpha is associated: colours are stored multiplied by it.
    for [r, g, b, a] in &mut texels {
        if *a > 0.0 && *a < 1.0 {
            [r, g, b].into_iter().for_each(|c| *c /= *a);
        }
    }
    Picture::linear(exr.size(), texels).ok_or_else(|| Error::decode(file, "the picture has no pixels"))
}

/// The colour layer of an EXR as stored, alpha 1 where it has none: the unnamed one, else one called colour or beauty,
/// else the first with R, G and B, else a lone grey channel.
fn exr_texels(file: &Path, exr: &ExrFile) -> Result<Vec<[f32; 4]>> {
    let rank = |name: &str| {
        let last = name.rsplit('.').next().unwrap_or("").to_lowercase();
        let known = ["", "combined", "beauty", "rgba", "rgb", "color", "colour"];
        known.iter().position(|k| *k == last).unwrap_or(known.len())
    };
    let colour = |pass: &&super::exr::Pass| pass.letters("rgb").is_some();
    let grey = |pass: &&super::exr::Pass| pass.letters("y").or(pass.letters("a")).is_some() || pass.channels.len() == 1;
    let passes = exr.passes();
    let chosen = passes.iter().filter(colour).min_by_key(|p| rank(&p.name));
    let Some(pass) = chosen.or_else(|| passes.iter().filter(grey).min_by_key(|p| rank(&p.name))) else {
        let names: Vec<&str> = passes.iter().map(|p| p.name.as_str()).collect();
        let reason = format!("no layer of this EXR has R, G and B; it has {}", names.join(", "));
        return Err(Error::unsupported(file, reason));
    };
    let rgb = pass.letters("rgb").or(pass.letters("y").map(|y| vec![y[0]; 3]));
    let rgb = rgb.unwrap_or_else(|| vec![pass.channels[0]; 3]);
    let alpha = pass.letters("a").filter(|a| a[0] != rgb[0]);
    let wanted: Vec<usize> = rgb.iter().chain(alpha.iter().flatten()).copied().collect();
    let planes = exr.read(&wanted)?;
    let finite = |v: f32| if v.is_finite() { v } else { v.max(0.0).min(65504.0) };
    Ok((0..exr.size().area())
        .map(|i| {
            let at = |c: usize| planes.get(c).map_or(1.0, |p| finite(p.values()[i]));
            [at(0), at(1), at(2), at(3)]
        })
        .collect())
}

/// The profile of sRGB that this program writes. Its encoder would put the present time into it: a file tells no time, and
/// the same document gives the same bytes.
pub fn own_srgb() -> Vec<u8> {
    /// Year, month, day, hour, minute and second, as the header of a profile holds them.
    const DATE: [u8; 12] = [0x07, 0xd0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0];
    /// The illuminant of the connection space, which is always D50 and which the encoder leaves out.
    const D50: [u8; 12] = [0, 0, 0xf6, 0xd6, 0, 1, 0, 0, 0, 0, 0xd3, 0x2d];
    let mut profile = ColorProfile::new_srgb().encode().unwrap_or_default();
    for (at, value) in [(24, DATE), (68, D50)] {
        if let Some(place) = profile.get_mut(at..at + value.len()) {
            place.copy_from_slice(&value);
        }
    }
    profile
}

/// The very profile that this program writes: nothing is to be done.
pub fn is_own_srgb(icc: &[u8]) -> bool {
    own_srgb() == icc
}

/// Straight RGBA bytes in the colours of an ICC profile as sRGB; as they are where `through_profile` finds nothing to do.
pub fn to_srgb(size: Size, rgba: Vec<u8>, icc: &[u8]) -> Vec<u8> {
    let Some(image) = image::RgbaImage::from_raw(size.width, size.height, rgba) else { return Vec::new() };
    let image = DynamicImage::ImageRgba8(image);
    match through_profile(&image, icc) {
        Some(texels) => texels.into_flattened(),
        None => image.into_rgba8().into_raw(),
    }
}

/// Straight sRGB bytes of an integer image in the colours of its ICC profile.
///
/// `None` where the profile is sRGB as far as a byte can tell (so that such files keep their bytes), does not belong to
/// the image's kind of colour, or cannot be used.
fn through_profile(image: &DynamicImage, icc: &[u8]) -> Option<Vec<[u8; 4]>> {
    let profile = ColorProfile::new_from_slice(icc).ok()?;
    let grey = matches!(
        image,
        DynamicImage::ImageLuma8(_)
            | DynamicImage::ImageLumaA8(_)
            | DynamicImage::ImageLuma16(_)
            | DynamicImage::ImageLumaA16(_)
    );
    let (layout, source) = match (profile.color_space, grey) {
        (DataColorSpace::Rgb, false) => (Layout::Rgba, image.to_rgba16().into_raw()),
        (DataColorSpace::Gray, true) => (Layout::GrayAlpha, image.to_luma_alpha16().into_raw()),
        _ => return None,
    };
    let target = ColorProfile::new_srgb();
    let transform = profile.create_transform_16bit(layout, &target, Layout::Rgba, TransformOptions::default()).ok()?;
    let run = |source: &[u16]| {
        let mut out = vec![0u16; source.len() / layout.channels() * 4];
        transform.transform(source, &mut out).ok().map(|()| out)
    };
    let byte = |v: u16| ((u32::from(v) + 128) / 257) as u8;
    let probe = probe(layout);
    let moved = run(&probe)?.as_chunks::<4>().0.iter().zip(probe.chunks(layout.channels())).any(|(to, from)| {
        let from = if grey { [from[0]; 3] } else { [from[0], from[1], from[2]] };
        (0..3).any(|c| byte(to[c]).abs_diff(byte(from[c])) > 1)
    });
    moved.then_some(())?;
    Some(run(&source)?.as_chunks::<4>().0.iter().map(|t| t.map(byte)).collect())
}

/// Colours spread over the cube (or the ramp), opaque.
fn probe(layout: Layout) -> Vec<u16> {
    let level = |i: usize| (i * 13107) as u16;
    match layout {
        Layout::Rgba => (0..216).flat_map(|i| [level(i % 6), level(i / 6 % 6), level(i / 36), u16::MAX]).collect(),
        _ => (0..256).flat_map(|i| [(i * 257) as u16, u16::MAX]).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{ImageFormat, RgbaImage};
    use std::io::Cursor;

    fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
        let mut out = Cursor::new(Vec::new());
        image.write_to(&mut out, format).unwrap();
        out.into_inner()
    }
    fn sample() -> RgbaImage {
        RgbaImage::from_fn(9, 5, |x, y| image::Rgba([x as u8 * 20, y as u8 * 40, 90, 255 - x as u8]))
    }
    fn opaque() -> DynamicImage {
        DynamicImage::ImageRgb8(DynamicImage::ImageRgba8(sample()).to_rgb8())
    }
    fn texels(bytes: &[u8], name: &str) -> Vec<[u8; 4]> {
        match decode(Path::new(name), bytes, &Budget::default()).unwrap().texels {
            Texels::Srgb8(t) => t.to_vec(),
            Texels::Linear(_) => panic!("{name} should hold bytes"),
        }
    }
    #[test]
    fn lossless_formats_keep_their_bytes() {
        let image = sample();
        let expected: Vec<[u8; 4]> = image.pixels().map(|p| p.0).collect();
        let image = DynamicImage::ImageRgba8(image);
        let formats = [
            (ImageFormat::Png, "a.png"),
            (ImageFormat::WebP, "a.webp"),
            (ImageFormat::Tiff, "a.tif"),
            (ImageFormat::Tga, "a.tga"),
            (ImageFormat::Bmp, "a.bmp"),
        ];
        for (format, name) in formats {
            assert_eq!(texels(&encoded(&image, format), name), expected, "{name}");
        }
    }
    #[test]
    fn a_mask_is_luminance_times_alpha() {
        let image = RgbaImage::from_fn(2, 1, |x, _| image::Rgba([255, 255, 255, [255, 128][x as usize]]));
        let bytes = encoded(&DynamicImage::ImageRgba8(image), ImageFormat::Png);
        let plane = decode_coverage(Path::new("m.png"), &bytes, &Budget::default()).unwrap();
        assert_eq!(plane.values(), [255, 128]);
    }
    #[test]
    fn what_is_no_picture_gets_a_sentence() {
        let mut bomb = encoded(&DynamicImage::ImageRgba8(sample()), ImageFormat::Png);
        bomb[16..24].copy_from_slice(&[0, 0, 0xea, 0x60, 0, 0, 0xea, 0x60]);
        let cut = encoded(&opaque(), ImageFormat::Jpeg);
        let cases: [(&str, &[u8], &str); 4] = [
            ("empty.png", b"", "is empty"),
            ("text.png", b"hello, world", "does not begin like"),
            ("bomb.png", &bomb, "bomb.png"),
            ("cut.jpg", &cut[..cut.len() - 2], "cut short"),
        ];
        for (name, bytes, part) in cases {
            let said = decode(Path::new(name), bytes, &Budget::default()).unwrap_err().to_string();
            assert!(said.contains(part), "{said}");
        }
    }
    #[test]
    fn a_wide_profile_is_applied_and_srgb_changes_nothing() {
        let image = opaque();
        let profile = ColorProfile::new_display_p3().encode().unwrap();
        let encode = |icc: Option<Vec<u8>>| {
            use image::ImageEncoder;
            let mut out = Vec::new();
            let mut encoder = image::codecs::png::PngEncoder::new(&mut out);
            if let Some(icc) = icc {
                encoder.set_icc_profile(icc).unwrap();
            }
            encoder.write_image(image.as_bytes(), 9, 5, image::ExtendedColorType::Rgb8).unwrap();
            out
        };
        let (plain, wide) = (texels(&encode(None), "a.png"), texels(&encode(Some(profile)), "b.png"));
        assert_eq!(texels(&encode(Some(ColorProfile::new_srgb().encode().unwrap())), "c.png"), plain);
        // Display P3's primaries are more saturated: a reddish pixel's red grows, the others shrink or stay.
        let (p, w) = (plain[8], wide[8]);
        assert!(w[0] > p[0] && w[1] <= p[1] && w[3] == p[3], "{p:?} became {w:?}");
    }
}
