//! Contours of a surface whose pixels moved as a whole: turned by quarters, mirrored, cut.
//! Floor 2.

use super::line::bits;
use super::window::{SIDE, steps_of};
use super::{ContourPixel, Contours};
use crate::math::Size;
use crate::math::plane_map::PixelMove;
use crate::raster::TILE;

impl Contours {
    /// The same contours where a move takes them, those on a canvas of another size alone.
    pub(in crate::surface) fn moved(&self, by: PixelMove, canvas: Size) -> Self {
        let (columns, rows) = (
            canvas.width.div_ceil(TILE as u32) as usize,
            canvas.height.div_ceil(TILE as u32) as usize,
        );
        let mut tiles: Vec<Vec<ContourPixel>> = vec![Vec::new(); columns * rows];
        for pixel in &self.pixels {
            let (x, y) = by.target(pixel.x, pixel.y);
            let others = bits(pixel.others).filter_map(|i| {
                let (dx, dy) = steps_of(i);
                let (dx, dy) = by.turned(dx, dy);
                canvas.rect().contains(x + dx, y + dy).then(|| 1u64 << bit_of(dx, dy))
            });
            let others = others.fold(0, |set, bit| set | bit);
            // What it saw beyond its own edge was cut away.
            let is_blind = others == 0 && pixel.others != 0;
            if canvas.rect().contains(x, y) && !is_blind {
                let [other_at, own_turn] =
                    [pixel.other_at, pixel.own_turn].map(|v| by.turned_vector(v));
                let tile = &mut tiles[y as usize / TILE * columns + x as usize / TILE];
                tile.push(ContourPixel { x, y, others, other_at, own_turn, ..*pixel });
            }
        }
        Self::of_tiles(canvas, tiles)
    }
}

/// The bit of a pixel of the window, from steps away from its middle.
fn bit_of(dx: i32, dy: i32) -> i32 {
    let middle = SIDE / 2;
    (dy + middle) * SIDE + dx + middle
}
