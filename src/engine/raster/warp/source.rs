//! Where the pixels of a warp come from: grids of tiles, and maps of the canvas.
//! Floor 1.

use crate::math::Rect;
use crate::raster::{Plane, TILE, TileAt, TileGrid};

/// Where pixels come from: premultiplied, in `[0, 1]`.
pub(super) trait PixelSource: Sync {
    /// The part of a rectangle that must be read.
    fn rect_to_read(&self, rect: Rect) -> Rect;
    /// Whether the border is repeated beyond what is held; else there is nothing.
    fn has_continued_border(&self) -> bool;
    /// The pixels of a rectangle, row by row.
    fn read(&self, rect: Rect) -> Vec<[f32; 4]>;
}

pub(super) struct GridSource<'a> {
    pub grid: &'a TileGrid,
    pub bounds: Rect,
    pub continues: bool,
}

/// The part of a rectangle within another; at least the nearest pixel of its border.
fn nearest(rect: Rect, within: Rect) -> Rect {
    let (x0, y0) =
        (rect.x0.clamp(within.x0, within.x1 - 1), rect.y0.clamp(within.y0, within.y1 - 1));
    Rect::new(x0, y0, rect.x1.clamp(x0 + 1, within.x1), rect.y1.clamp(y0 + 1, within.y1))
}

impl PixelSource for GridSource<'_> {
    fn has_continued_border(&self) -> bool {
        self.continues
    }

    fn rect_to_read(&self, rect: Rect) -> Rect {
        if self.continues && !self.bounds.is_empty() {
            nearest(rect, self.bounds)
        } else {
            rect.intersect(self.bounds)
        }
    }

    fn read(&self, rect: Rect) -> Vec<[f32; 4]> {
        let mut out = vec![[0.0; 4]; rect.width() * rect.height()];
        for at in TileAt::covering(rect) {
            let Some(tile) = self.grid.tile(at) else { continue };
            let (from, area) = (at.rect(), at.rect().intersect(rect));
            for y in area.y0..area.y1 {
                if tile.is_16_bit() {
                    let to = (y - rect.y0) as usize * rect.width() + (area.x0 - rect.x0) as usize;
                    let pixels =
                        out[to..to + area.width()].iter_mut().zip((area.x0 - from.x0) as usize..);
                    let row = (y - from.y0) as usize;
                    pixels.for_each(|(to, x)| {
                        *to = tile.pixel16(x, row).map(|v| f32::from(v) / 65535.0)
                    });
                    continue;
                }
                let start = ((y - from.y0) as usize * TILE + (area.x0 - from.x0) as usize) * 4;
                let bytes = tile.bytes()[start..start + area.width() * 4].as_chunks::<4>().0;
                let to = (y - rect.y0) as usize * rect.width() + (area.x0 - rect.x0) as usize;
                shares_of_bytes(
                    bytes.as_flattened(),
                    out[to..to + area.width()].as_flattened_mut(),
                );
            }
        }
        out
    }
}

crate::widest! {
    fn shares_of_bytes(bytes: &[u8], out: &mut [f32]) {
        for (out, byte) in out.iter_mut().zip(bytes) {
            *out = f32::from(*byte) / 255.0;
        }
    }
}

pub(super) struct PlaneSource<'a> {
    pub plane: &'a Plane<u8>,
}

impl PixelSource for PlaneSource<'_> {
    fn has_continued_border(&self) -> bool {
        true
    }

    fn rect_to_read(&self, rect: Rect) -> Rect {
        nearest(rect, self.plane.size().rect())
    }

    fn read(&self, rect: Rect) -> Vec<[f32; 4]> {
        let at = |x: i32, y: i32| {
            [0.0, 0.0, 0.0, f32::from(self.plane.at(x as usize, y as usize)) / 255.0]
        };
        (rect.y0..rect.y1).flat_map(|y| (rect.x0..rect.x1).map(move |x| at(x, y))).collect()
    }
}
