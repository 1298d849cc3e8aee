//! Pictures of every format, with profiles and without.

use super::*;
use crate::icc_profiles::icc_of;
use crate::math::ColorProfile;
use image::{ImageFormat, RgbaImage};
use std::io::Cursor;

fn encode(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
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
        assert_eq!(texels(&encode(&image, format), name), expected, "{name}");
    }
}

#[test]
fn pictures_of_16_bits_become_paint_of_16_bits_whatever_way_they_are_read() {
    let value = |x: u32, y: u32| (x * 911 + y * 77) as u16;
    let pixel =
        |x: u32, y: u32| image::Rgba([value(x, y), 65535 - value(x, y), 300, 65000 - x as u16]);
    let picture: image::ImageBuffer<image::Rgba<u16>, Vec<u16>> =
        image::ImageBuffer::from_fn(70, 130, pixel);
    let texels16: Vec<[u16; 4]> = picture.pixels().map(|p| p.0).collect();
    let image = DynamicImage::ImageRgba16(picture);
    let wanted = TileGrid::from_straight16(&texels16, 70, 130, -9, 20);
    // Krita writes its profile, which has to be looked at first.
    let mut profiled = Vec::new();
    let mut info = png::Info::with_size(70, 130);
    info.icc_profile = Some(icc_of(ColorProfile::Srgb).to_vec().into());
    (info.color_type, info.bit_depth) = (png::ColorType::Rgba, png::BitDepth::Sixteen);
    let mut writer = png::Encoder::with_info(&mut profiled, info).unwrap().write_header().unwrap();
    let bytes: Vec<u8> = texels16.as_flattened().iter().flat_map(|v| v.to_be_bytes()).collect();
    writer.write_image_data(&bytes).unwrap();
    writer.finish().unwrap();
    let files = [encode(&image, ImageFormat::Png), encode(&image, ImageFormat::Tiff), profiled];
    for (file, name) in files.iter().zip(["a.png", "a.tif", "profiled.png"]) {
        let found = decode_paint(Path::new(name), file, -9, 20, &Budget::default()).unwrap();
        assert_eq!(found.size, Size::new(70, 130));
        assert!(
            wanted
                .iter()
                .all(|(at, tile)| found.tiles.tile(at).is_some_and(|own| own.is_same(tile))),
            "{name}"
        );
    }
    let short = Budget { memory_bytes: 200_000, ..Budget::default() };
    assert!(decode_paint(Path::new("profiled.png"), &files[2], 0, 0, &short).is_err());
}

#[test]
fn sixteen_bits_are_kept_beside_the_bytes_that_they_round_to() {
    let texels16 = image::ImageBuffer::from_fn(300, 2, |x, y| {
        image::Rgba([x as u16 * 211, 7, 40000, 65535 - y as u16])
    });
    for (format, name) in [(ImageFormat::Png, "a.png"), (ImageFormat::Tiff, "a.tif")] {
        let bytes = encode(&DynamicImage::ImageRgba16(texels16.clone()), format);
        let picture = decode(Path::new(name), &bytes, &Budget::default()).unwrap();
        let kept = picture.texels16.as_ref().unwrap();
        assert!(kept.iter().zip(texels16.pixels()).all(|(kept, pixel)| *kept == pixel.0), "{name}");
        let Texels::Srgb8(texels) = &picture.texels else { panic!("bytes") };
        let nearest = |v: u16| (f32::from(v) / 257.0).round() as u8;
        assert!(
            kept.iter().zip(texels.iter()).all(|(texels16, byte)| texels16.map(nearest) == *byte),
            "{name}"
        );
    }
    assert!(
        decode(Path::new("b.png"), &encode(&opaque(), ImageFormat::Png), &Budget::default())
            .unwrap()
            .texels16
            .is_none()
    );
}

#[test]
fn a_mask_is_luminance_times_alpha() {
    let image =
        RgbaImage::from_fn(2, 1, |x, _| image::Rgba([255, 255, 255, [255, 128][x as usize]]));
    let bytes = encode(&DynamicImage::ImageRgba8(image), ImageFormat::Png);
    let plane = decode_coverage(Path::new("m.png"), &bytes, &Budget::default()).unwrap();
    assert_eq!(plane.values(), [255, 128]);
}

#[test]
fn what_is_no_picture_gets_a_sentence() {
    let mut bomb = encode(&DynamicImage::ImageRgba8(sample()), ImageFormat::Png);
    bomb[16..24].copy_from_slice(&[0, 0, 0xea, 0x60, 0, 0, 0xea, 0x60]);
    let cut = encode(&opaque(), ImageFormat::Jpeg);
    let cases: [(&str, &[u8], &str); 4] = [
        ("empty.png", b"", "is empty"),
        ("text.png", b"hello, world", "does not begin like"),
        ("bomb.png", &bomb, "bomb.png"),
        ("cut.jpg", &cut[..cut.len() / 4], "cut short"),
    ];
    for (name, bytes, part) in cases {
        let said = decode(Path::new(name), bytes, &Budget::default()).unwrap_err().to_string();
        assert!(said.contains(part), "{said}");
    }
}

#[test]
fn a_jpeg_without_its_end_is_shown_as_far_as_it_goes() {
    let whole = encode(&opaque(), ImageFormat::Jpeg);
    let scan = whole.windows(2).rposition(|pair| pair == [0xff, 0xda]).unwrap();
    for cut in [whole.len() - 1, whole.len() - 2, (scan + whole.len()) / 2] {
        let read =
            decode_paint(Path::new("a.jpg"), &whole[..cut], 0, 0, &Budget::default()).unwrap();
        assert_eq!(read.size, Size::new(9, 5));
        assert!(read.warning.unwrap_or_default().contains("no end marker"), "cut at {cut}");
    }
}

#[test]
fn our_own_profile_is_one_that_strict_readers_take() {
    let profile = icc_of(ColorProfile::Srgb).to_vec();
    let number = |at: usize| u32::from_be_bytes(*profile[at..].first_chunk().unwrap()) as usize;
    assert_eq!(number(0), profile.len());
    let places = (0..number(128)).map(|i| number(132 + 12 * i + 4));
    assert!(places.into_iter().all(|at| at % 4 == 0 && at < profile.len()));
    assert!(moxcms::ColorProfile::new_from_slice(&profile).unwrap().description.is_some());
    assert!(convert_by_profile(&opaque(), &profile).is_none());
}

#[test]
fn a_wide_profile_is_applied_and_srgb_changes_nothing() {
    let image = opaque();
    let profile = moxcms::ColorProfile::new_display_p3().encode().unwrap();
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
    assert_eq!(
        texels(&encode(Some(moxcms::ColorProfile::new_srgb().encode().unwrap())), "c.png"),
        plain
    );
    // Display P3's primaries are more saturated: a reddish pixel's red grows, the others shrink or
    // stay.
    let (p, w) = (plain[8], wide[8]);
    assert!(w[0] > p[0] && w[1] <= p[1] && w[3] == p[3], "{p:?} became {w:?}");
}
