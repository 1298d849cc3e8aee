//! The small picture in a project. Floor 5.

use super::Archive;
use crate::math::Size;
use crate::{Budget, bitmap};
use image::imageops;
use std::path::Path;

/// Its entry in the zip.
pub const ENTRY: &str = "Thumbnails/thumbnail.png";
/// Its longer side, px, as OpenRaster wants it.
pub const STORED_PX: u32 = 256;

/// A small picture, straight sRGB with alpha.
pub struct SmallPicture {
    /// Four bytes a pixel, row by row.
    pub rgba: Vec<u8>,
    /// Its size, px.
    pub size: Size,
}

impl SmallPicture {
    /// The picture, made smaller so that its longer side has at most `side_px`. A small picture
    /// stays as it is. `None` if there are not as many bytes as `size` says, or none.
    pub fn of(rgba: Vec<u8>, size: Size, side_px: u32) -> Option<Self> {
        let picture = image::RgbaImage::from_raw(size.width, size.height, rgba)?;
        let longer = size.width.max(size.height);
        if longer == 0 || longer <= side_px {
            return (longer > 0).then(|| Self { rgba: picture.into_raw(), size });
        }
        let side = |n: u32| ((u64::from(n) * u64::from(side_px) / u64::from(longer)) as u32).max(1);
        let size = Size::new(side(size.width), side(size.height));
        let rgba = imageops::thumbnail(&picture, size.width, size.height).into_raw();
        Some(Self { rgba, size })
    }
}

/// The small picture that a project or another OpenRaster file holds, its longer side at most
/// `side_px`. `None` if there is none that can be read, or none as large.
pub fn stored_thumbnail(
    file: &Path,
    bytes: &[u8],
    side_px: u32,
    budget: &Budget,
) -> Option<SmallPicture> {
    if side_px > STORED_PX || !Archive::is_zip(bytes) {
        return None;
    }
    let archive = Archive::open(file, bytes, budget).ok()?;
    let png = archive.bytes(ENTRY, budget.file_bytes).ok()?;
    let picture = bitmap::decode(file, &png, budget).ok()?.image.into_rgba8();
    let size = Size::new(picture.width(), picture.height());
    SmallPicture::of(picture.into_raw(), size, side_px)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn marked(size: Size) -> Vec<u8> {
        (0..size.area()).flat_map(|i| [(i % 251) as u8, 7, 9, 255]).collect()
    }

    #[test]
    fn a_large_picture_gets_the_side_that_was_asked_for_and_a_small_one_stays() {
        let wide = Size::new(400, 100);
        let small = SmallPicture::of(marked(wide), wide, 128).unwrap();
        assert_eq!((small.size, small.rgba.len()), (Size::new(128, 32), 128 * 32 * 4));
        let icon = Size::new(16, 9);
        let same = SmallPicture::of(marked(icon), icon, 128).unwrap();
        assert_eq!((same.size, same.rgba), (icon, marked(icon)));
        let thin = Size::new(1, 4000);
        assert_eq!(SmallPicture::of(marked(thin), thin, 100).unwrap().size, Size::new(1, 100));
    }

    #[test]
    fn bytes_that_are_missing_make_no_picture() {
        assert!(SmallPicture::of(vec![0; 15], Size::new(2, 2), 128).is_none());
        assert!(SmallPicture::of(Vec::new(), Size::new(0, 0), 128).is_none());
    }
}
