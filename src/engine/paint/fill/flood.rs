//! Which pixels are joined to one by colors like its own, over their four neighbors. Floor 3.
//! Finds which pixels may be filled, a row of a tile at a time; `raster::flood` spreads.

use crate::math::Size;
use crate::raster::bits::{TileBits, bits_of, bytes_of};
use crate::raster::flood::{Flooded, OpenTile};
use crate::raster::gaps::PixelSet;
use crate::raster::{CoverageGrid, CoverageTile, Plane, TILE, Tile, TileAt};
use crate::surface::objects::CanvasPart;
use std::sync::Arc;

/// Everything that is joined to a pixel of the canvas; `None` if that pixel may not be touched.
/// `tolerance` in bytes.
pub(super) fn connected_area(
    (x, y): (i32, i32),
    canvas: Size,
    part: &CanvasPart,
    tolerance: u8,
    tile: impl Fn(TileAt) -> Option<Arc<Tile>> + Sync,
) -> Option<Flooded> {
    let like = color_at((x, y), part, &tile)?;
    let opened = |at: TileAt| OpenTile {
        open: open_tile(at, tile(at).as_deref(), like, tolerance, canvas, part),
        links: None,
    };
    Some(Flooded::from((x, y), canvas, opened))
}

/// All pixels of the canvas with a color like one's, wherever they are.
pub(super) fn alike(
    start: (i32, i32),
    canvas: Size,
    part: &CanvasPart,
    tolerance: u8,
    tile: impl Fn(TileAt) -> Option<Arc<Tile>> + Sync,
) -> Option<CoverageGrid> {
    let like = color_at(start, part, &tile)?;
    let found = |at: TileAt| {
        CoverageTile::of_bits(&open_tile(at, tile(at).as_deref(), like, tolerance, canvas, part))
    };
    Some(CoverageGrid::gather(canvas.rect(), found))
}

fn color_at(
    (x, y): (i32, i32),
    part: &CanvasPart,
    tile: impl Fn(TileAt) -> Option<Arc<Tile>>,
) -> Option<[u8; 4]> {
    if part.coverage(x, y) <= 0.0 {
        return None;
    }
    let at = TileAt::of_pixel(x, y);
    let place = ((x - at.rect().x0) as usize, (y - at.rect().y0) as usize);
    Some(pixel(tile(at).as_deref(), place))
}

fn pixel(tile: Option<&Tile>, (x, y): (usize, usize)) -> [u8; 4] {
    let bytes = tile.and_then(|tile| tile.bytes().as_chunks::<4>().0.get(y * TILE + x).copied());
    bytes.unwrap_or_default()
}

/// The pixels of a tile that may be filled.
fn open_tile(
    at: TileAt,
    tile: Option<&Tile>,
    like: [u8; 4],
    tolerance: u8,
    canvas: Size,
    part: &CanvasPart,
) -> TileBits {
    let area = at.rect().intersect(canvas.rect());
    let mut open = [0; TILE];
    let blank_is_open = is_like([0; 4], like, tolerance);
    for y in area.y0..area.y1 {
        let row = (y - at.rect().y0) as usize;
        let mut bits = match tile {
            Some(tile) => {
                let mut alike = [0; TILE];
                row_like(&tile.bytes()[4 * row * TILE..][..4 * TILE], like, tolerance, &mut alike);
                bits_of(&alike)
            }
            None => {
                if blank_is_open {
                    u64::MAX
                } else {
                    0
                }
            }
        };
        if area.width() < TILE {
            bits &= (1 << area.width()) - 1;
        }
        if !part.is_whole() {
            for x in (0..area.width()).filter(|x| bits >> x & 1 != 0).collect::<Vec<_>>() {
                if part.coverage(area.x0 + x as i32, y) <= 0.0 {
                    bits &= !(1 << x);
                }
            }
        }
        open[row] = bits;
    }
    open
}

crate::widest! {
    /// 1 for each of a row's pixels whose bytes are all similar, 0 for the others: [`is_like`],
    /// byte by byte.
    fn row_like(row: &[u8], like: [u8; 4], tolerance: u8, alike: &mut [u8; TILE]) {
        let mut near = [[0u8; 4]; TILE];
        for (near, pixel) in near.iter_mut().zip(row.as_chunks::<4>().0) {
            for c in 0..4 {
                near[c] = u8::from(pixel[c].abs_diff(like[c]) <= tolerance);
            }
        }
        for (alike, near) in alike.iter_mut().zip(&near) {
            *alike = u8::from(u32::from_ne_bytes(*near) == 0x0101_0101);
        }
    }
}

/// Whether no channel differs by more than the tolerance.
fn is_like(a: [u8; 4], b: [u8; 4], tolerance: u8) -> bool {
    let near = |c: usize| a[c].abs_diff(b[c]) <= tolerance;
    near(0) & near(1) & near(2) & near(3)
}

/// The pixels that were reached, in the smallest rectangle of whole tiles that holds them.
pub(super) fn pixels(flooded: &Flooded) -> PixelSet {
    let rect = flooded.rect();
    let mut pixels = Plane::full(Size::new(rect.width() as u32, rect.height() as u32), 0u8);
    for (at, tile) in flooded.tiles() {
        let area = at.rect().intersect(rect);
        for y in area.y0..area.y1 {
            let bits = tile[(y - at.rect().y0) as usize];
            let row = &mut pixels.row_mut((y - rect.y0) as usize)[(area.x0 - rect.x0) as usize..]
                [..area.width()];
            row.copy_from_slice(&bytes_of(bits)[..area.width()]);
        }
    }
    PixelSet { rect, pixels }
}
