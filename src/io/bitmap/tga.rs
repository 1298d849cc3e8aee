//! What the fourth channel of a TGA is: by its header, its extension area, and the pixels. Floor 5.
//! Pixels are decoded by `image`, which takes the channel for alpha.

use image::DynamicImage;

/// The bits of the header's last byte that say how many bits of alpha a pixel has.
const ALPHA_BITS: u8 = 15;
/// Where the extension area says what the channel is.
const ATTRIBUTES_AT: usize = 494;
const FOOTER: &[u8] = b"TRUEVISION-XFILE.\0";

/// Straight alpha, as the file means it: opaque where the channel is said to be none or is empty
/// throughout, divided out where colors were multiplied by it.
pub fn with_alpha(bytes: &[u8], image: DynamicImage) -> DynamicImage {
    let DynamicImage::ImageRgba8(mut pixels) = image else { return image };
    let declared = bytes.get(17).is_some_and(|byte| byte & ALPHA_BITS != 0);
    let attributes = attributes(bytes);
    let is_empty = pixels.pixels().all(|pixel| pixel[3] == 0);
    let is_alpha = match attributes {
        Some(kind) => kind >= 3,
        None => declared || pixels.pixels().any(|pixel| pixel[3] != pixels.get_pixel(0, 0)[3]),
    };
    for pixel in pixels.pixels_mut() {
        let alpha = u32::from(pixel[3]);
        if !is_alpha || is_empty {
            pixel[3] = 255;
        } else if attributes == Some(4) && alpha > 0 {
            for c in 0..3 {
                pixel[c] = ((u32::from(pixel[c]) * 255 + alpha / 2) / alpha).min(255) as u8;
            }
        }
    }
    DynamicImage::ImageRgba8(pixels)
}

/// The kind of the fourth channel, from the extension area if there is one: 0 to 2 mean none, 3
/// alpha, 4 alpha that colors were multiplied by.
fn attributes(bytes: &[u8]) -> Option<u8> {
    let footer = bytes.get(bytes.len().checked_sub(26)?..)?;
    let start = u32::from_le_bytes(*footer.first_chunk()?) as usize;
    (footer.ends_with(FOOTER) && start > 0).then_some(())?;
    bytes.get(start.checked_add(ATTRIBUTES_AT)?).copied()
}

#[cfg(test)]
mod tests {
    use crate::{Budget, bitmap};
    use std::path::Path;

    /// Two pixels of 32 bits, blue first, with an extension area of one kind if there is to be one.
    fn tga(alpha_bits: u8, alphas: [u8; 2], kind: Option<u8>) -> Vec<u8> {
        let header = [0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 0, 32, 32 | alpha_bits];
        let mut bytes = [&header[..], &[10, 20, 30, alphas[0], 40, 50, 60, alphas[1]]].concat();
        if let Some(kind) = kind {
            let start = bytes.len() as u32;
            bytes.extend([&[0; 494][..], &[kind]].concat());
            bytes.extend([&start.to_le_bytes()[..], &[0; 4], super::FOOTER].concat());
        }
        bytes
    }

    #[test]
    fn the_fourth_channel_is_alpha_only_where_the_file_means_it() {
        let read = |bytes: &[u8]| {
            let read = bitmap::decode(Path::new("a.tga"), bytes, &Budget::default()).unwrap();
            read.image.into_rgba8().pixels().map(|pixel| pixel.0).collect::<Vec<_>>()
        };
        let alphas = |bytes: &[u8]| read(bytes).iter().map(|pixel| pixel[3]).collect::<Vec<_>>();
        assert_eq!(alphas(&tga(8, [7, 9], None)), [7, 9]);
        assert_eq!(alphas(&tga(0, [7, 9], None)), [7, 9], "a header that forgets its alpha");
        assert_eq!(alphas(&tga(8, [0, 0], None)), [255, 255], "nothing would be seen");
        assert_eq!(alphas(&tga(0, [3, 3], None)), [255, 255]);
        assert_eq!(alphas(&tga(8, [7, 9], Some(0))), [255, 255]);
        assert_eq!(alphas(&tga(8, [7, 9], Some(3))), [7, 9]);
        assert_eq!(read(&tga(8, [60, 0], Some(4)))[0], [128, 85, 43, 60]);
    }
}
