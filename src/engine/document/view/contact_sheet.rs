//! The contact sheet: several views side by side.
//! Floor 4.

use crate::math::{Rect, Size};
use crate::raster::Picture;

/// Longer side of a view on the sheet, px.
const CELL_PX: f32 = 320.0;
const GAP_PX: u32 = 8;
/// A middle gray: dark and light views are both visible against it.
const BACKGROUND: f32 = 0.32;

/// Arranges pictures of one size in rows of four, in order, scaled down to fit. `None` without
/// pictures.
pub fn sheet(pictures: &[Picture]) -> Option<Picture> {
    let size = pictures.first()?.size;
    let cell = size.scaled((CELL_PX / size.longer_side()).min(1.0));
    let columns = (pictures.len() as u32).min(4);
    let rows = (pictures.len() as u32).div_ceil(columns);
    let side = |cells: u32, cell: u32| cells * (cell + GAP_PX) + GAP_PX;
    let sheet = Size::new(side(columns, cell.width), side(rows, cell.height));
    let background = crate::math::srgb::quantize(BACKGROUND);
    let mut texels = vec![[background, background, background, 255]; sheet.area()];
    for (i, picture) in pictures.iter().enumerate() {
        let (column, row) = (i as u32 % columns, i as u32 / columns);
        let (left, top) = (side(column, cell.width), side(row, cell.height));
        for y in 0..cell.height {
            for x in 0..cell.width {
                let [r, g, b] =
                    mean_over_background(picture, source_rect(picture.size, cell, x, y));
                texels[((top + y) * sheet.width + left + x) as usize] = [r, g, b, 255];
            }
        }
    }
    Picture::srgb8(sheet, texels)
}

/// The number of pixels of a picture that one pixel of a smaller one covers; at least one.
fn source_rect(from: Size, to: Size, x: u32, y: u32) -> Rect {
    let span = |i: u32, from: u32, to: u32| {
        let at = |i: u32| (u64::from(i) * u64::from(from) / u64::from(to)) as i32;
        (at(i).min(from as i32 - 1), at(i + 1).max(at(i) + 1).min(from as i32))
    };
    let ((x0, x1), (y0, y1)) = (span(x, from.width, to.width), span(y, from.height, to.height));
    Rect::new(x0, y0, x1, y1)
}

fn mean_over_background(picture: &Picture, pixels: Rect) -> [u8; 3] {
    let mut sum = [0.0f32; 3];
    for y in pixels.y0..pixels.y1 {
        for x in pixels.x0..pixels.x1 {
            let [r, g, b, a] = picture.linear_at(x as usize, y as usize);
            for (sum, c) in sum.iter_mut().zip([r, g, b]) {
                *sum += c * a + crate::math::srgb::decode(BACKGROUND) * (1.0 - a);
            }
        }
    }
    let count = (pixels.width() * pixels.height()).max(1) as f32;
    sum.map(|v| crate::math::srgb::quantize(crate::math::srgb::encode(v / count)))
}
