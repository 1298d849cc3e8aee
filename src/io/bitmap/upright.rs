//! Which way up a file is to be seen: the EXIF data of pictures, and the scan order of Radiance
//! files. Floor 5.

use image::metadata::Orientation;

/// The orientation in EXIF data, which some programs begin with the mark that JPEG has there.
pub fn of_exif(exif: &[u8]) -> Option<Orientation> {
    Orientation::from_exif_chunk(exif.strip_prefix(b"Exif\0\0").unwrap_or(exif))
}

/// The EXIF data of a PNG, which may also follow its pixels.
pub fn png_exif(bytes: &[u8]) -> Option<&[u8]> {
    let mut at = 8usize;
    loop {
        let head = bytes.get(at..at.checked_add(8)?)?;
        let length = u32::from_be_bytes(*head.first_chunk()?) as usize;
        if &head[4..] == b"eXIf" {
            return bytes.get(at + 8..(at + 8).checked_add(length)?);
        }
        at = at.checked_add(length)?.checked_add(12)?;
    }
}

/// A Radiance file in the usual scan order, and how its picture is then to be turned; `None` where
/// it has that order.
///
/// A line such as `+X 20 -Y 10` names the axis between rows, then that along a row.
pub fn radiance(bytes: &[u8]) -> Option<(Vec<u8>, Orientation)> {
    let start = bytes.windows(2).position(|pair| pair == b"\n\n")? + 2;
    let line = bytes[start..].split(|&byte| byte == b'\n').next()?;
    let words: Vec<&[u8]> = line.split(|&byte| byte == b' ').collect();
    let &[outer, rows, inner, columns] = &words[..] else { return None };
    let orientation = match (outer, inner) {
        (b"+Y", b"+X") => Orientation::FlipVertical,
        (b"-Y", b"-X") => Orientation::FlipHorizontal,
        (b"+Y", b"-X") => Orientation::Rotate180,
        (b"+X", b"-Y") => Orientation::Rotate90FlipH,
        (b"-X", b"-Y") => Orientation::Rotate90,
        (b"+X", b"+Y") => Orientation::Rotate270,
        (b"-X", b"+Y") => Orientation::Rotate270FlipH,
        _ => return None,
    };
    let usual = [b"-Y ", rows, b" +X ", columns].concat();
    Some(([&bytes[..start], &usual, &bytes[start + line.len()..]].concat(), orientation))
}

#[cfg(test)]
mod tests {
    use crate::{Budget, picture};
    use image::DynamicImage;
    use std::path::Path;

    /// Two pixels wide, three high; the first is the brightest.
    fn hdr(line: &str) -> Vec<u8> {
        let texel = |i: u8| [i * 16, 8, 8, 128];
        let texels: Vec<u8> = (1..=6).rev().flat_map(texel).collect();
        [b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n", line.as_bytes(), b"\n", &texels].concat()
    }

    #[test]
    fn radiance_files_are_read_in_each_of_their_eight_orders() {
        let cases = [
            ("-Y 3 +X 2", (2, 3), [6, 5, 4, 3, 2, 1]),
            ("+Y 3 +X 2", (2, 3), [2, 1, 4, 3, 6, 5]),
            ("-Y 3 -X 2", (2, 3), [5, 6, 3, 4, 1, 2]),
            ("+Y 3 -X 2", (2, 3), [1, 2, 3, 4, 5, 6]),
            ("+X 3 -Y 2", (3, 2), [6, 4, 2, 5, 3, 1]),
            ("-X 3 -Y 2", (3, 2), [2, 4, 6, 1, 3, 5]),
            ("+X 3 +Y 2", (3, 2), [5, 3, 1, 6, 4, 2]),
            ("-X 3 +Y 2", (3, 2), [1, 3, 5, 2, 4, 6]),
        ];
        for (line, size, expected) in cases {
            let read =
                crate::bitmap::decode(Path::new("a.hdr"), &hdr(line), &Budget::default()).unwrap();
            let mut image = read.image;
            image.apply_orientation(read.orientation);
            assert_eq!((image.width(), image.height()), size, "{line}");
            let reds = image.into_rgb32f().pixels().map(|p| (p[0] * 16.0).round() as i32).collect();
            let reds: Vec<i32> = reds;
            assert_eq!(reds, expected, "{line}");
        }
    }

    /// EXIF with one entry: the orientation.
    fn exif(value: u8) -> Vec<u8> {
        [&b"II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0"[..], &[value, 0, 0, 0, 0, 0, 0, 0]]
            .concat()
    }

    fn chunk(name: &[u8], data: &[u8]) -> Vec<u8> {
        let named = [name, data].concat();
        let crc = crc32fast::hash(&named).to_be_bytes();
        [&(data.len() as u32).to_be_bytes()[..], &named, &crc].concat()
    }

    #[test]
    fn png_and_webp_are_turned_by_their_exif_data() {
        let image = image::RgbaImage::from_fn(2, 1, |x, _| image::Rgba([x as u8 * 200, 0, 0, 255]));
        let image = DynamicImage::ImageRgba8(image);
        let mut plain = std::io::Cursor::new(Vec::new());
        image.write_to(&mut plain, image::ImageFormat::Png).unwrap();
        let plain = plain.into_inner();
        let end = plain.len() - 12;
        let turned =
            |at: usize, exif: &[u8]| [&plain[..at], &chunk(b"eXIf", exif), &plain[at..]].concat();
        let marked = [b"Exif\0\0", &exif(6)[..]].concat();
        let mut webp = Vec::new();
        let mut encoder = image::codecs::webp::WebPEncoder::new_lossless(&mut webp);
        image::ImageEncoder::set_exif_metadata(&mut encoder, marked.clone()).unwrap();
        image.write_with_encoder(encoder).unwrap();
        let files = [turned(33, &exif(6)), turned(end, &exif(6)), turned(33, &marked), webp];
        for (file, name) in files.iter().zip(["a.png", "after.png", "marked.png", "a.webp"]) {
            let painted =
                picture::decode_paint(Path::new(name), file, 0, 0, &Budget::default()).unwrap();
            assert_eq!((painted.size.width, painted.size.height), (1, 2), "{name}");
        }
    }
}
