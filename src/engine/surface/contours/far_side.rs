//! The far side of a surface: a small one that holds what the other sides read. Renderers read
//! it like any surface. Floor 2. Not here: what both sides answer alike (`both_sides`).
//!
//! Each contour pixel takes 2 × 2 pixels of it: the pixel itself, and the readings one pixel to the
//! right and below, so that differences to linked neighbors show how its maps change. Four by four
//! of them make a block of 8 × 8; eight blocks lie side by side. The pixels of a tile of the canvas
//! begin with a block of the first column, and are in the order of the canvas's blocks, so that a
//! dab leaves out most that it does not reach.

use super::continued::{Continued, nz_of};
use super::line::bits;
use super::window::{PixelWindow, steps_of};
use super::{ContourPixel, Contours};
use crate::math::{Rect, Size, parallel, vec2};
use crate::raster::{Plane, TILE, TileAt};
use crate::surface::pyramid::TileBlocks;
use crate::surface::{Surface, links, pyramid};
use std::ops::Range;
use std::sync::{Arc, Weak};

/// Side of a block, px.
pub const BLOCK: usize = pyramid::BLOCK;
/// Columns of a far side, as many as of a tile.
pub const COLUMNS: usize = TILE;
/// Contour pixels of a block, and of a row of blocks.
const IN_BLOCK: usize = BLOCK * BLOCK / 4;
const IN_ROW: usize = IN_BLOCK * COLUMNS / BLOCK;

/// What a far side belongs to.
pub struct FarSide {
    /// It holds its far side, so that must not hold it.
    surface: Weak<Surface>,
    canvas: Size,
    contours: Arc<Contours>,
}

/// Brings a tile's pixels into the order of the far side, and leaves out what does not fit.
pub(super) fn sort(pixels: &mut Vec<ContourPixel>) {
    let seen = pixels.iter().filter(|pixel| pixel.is_other_on_surface()).count();
    if seen > Contours::MOST_SEEN {
        // The least shared go first.
        pixels.sort_by(|a, b| {
            a.is_other_on_surface().cmp(&b.is_other_on_surface()).then(a.share.total_cmp(&b.share))
        });
        pixels.truncate(pixels.len() - (seen - Contours::MOST_SEEN));
    }
    let block = |v: i32| v / BLOCK as i32;
    pixels.sort_by_key(|p| match p.is_other_on_surface() {
        true => (false, block(p.y), block(p.x), p.y, p.x),
        false => (true, 0, 0, p.y, p.x),
    });
}

/// The runs of a tile's pixels, one for each row of blocks.
pub(super) fn rows(pixels: Range<usize>) -> impl Iterator<Item = Range<u32>> {
    let end = pixels.end;
    pixels.step_by(IN_ROW).map(move |start| start as u32..(start + IN_ROW).min(end) as u32)
}

/// The pixels of the far side that hold so many contour pixels.
pub(super) fn rect(first_row: u32, seen: usize) -> Rect {
    let (blocks, side) = (seen.div_ceil(IN_BLOCK), BLOCK as i32);
    let (across, rows) =
        (blocks.min(COLUMNS / BLOCK) as i32, blocks.div_ceil(COLUMNS / BLOCK) as i32);
    let y0 = first_row as i32 * side;
    Rect::new(0, y0, across * side, y0 + rows * side)
}

/// Where the `i`th contour pixel of a tile lies in its part of the far side.
#[inline(always)]
pub fn place_of(i: usize) -> (usize, usize) {
    let (block, inside) = (i / IN_BLOCK, i % IN_BLOCK);
    let across = COLUMNS / BLOCK;
    (
        block % across * BLOCK + inside % (BLOCK / 2) * 2,
        block / across * BLOCK + inside / (BLOCK / 2) * 2,
    )
}

impl FarSide {
    /// Bytes that one pixel of a far side takes.
    pub const BYTES: usize = 18;

    /// The surface whose contours they are; `None` once nobody holds it any more.
    pub fn surface(&self) -> Option<Arc<Surface>> {
        self.surface.upgrade()
    }

    /// The size of the canvas.
    pub fn canvas(&self) -> Size {
        self.canvas
    }

    /// The contours that it is behind.
    pub fn contours(&self) -> &Contours {
        &self.contours
    }

    /// The contour pixel that a pixel of the far side belongs to.
    #[inline(always)]
    pub fn contour_pixel(&self, x: usize, y: usize) -> Option<&ContourPixel> {
        let row = self.contours.far_rows.get(y / BLOCK)?;
        let inside = (y % BLOCK / 2) * (BLOCK / 2) + x % BLOCK / 2;
        let i = row.start as usize + x / BLOCK * IN_BLOCK + inside;
        self.contours.pixels[..row.end as usize].get(i)
    }

    /// The canvas pixel whose readings a pixel of the far side holds; any where it holds none.
    #[inline(always)]
    pub fn canvas_pixel(&self, x: i32, y: i32) -> (i32, i32) {
        let Some(pixel) = self.contour_pixel(x as usize, y as usize) else { return (0, 0) };
        (pixel.x + (x & 1), pixel.y + (y & 1))
    }

    /// The blocks of a tile's part of the far side that hold readings of pixels in some blocks of the
    /// tile, or beside them; `None` if there are none.
    pub fn blocks_under(&self, at: TileAt, touched: &TileBlocks) -> Option<TileBlocks> {
        let contours = self.contours.on(at)?;
        let wide = |bits: u8| bits | bits << 1 | bits >> 1;
        let near: TileBlocks = std::array::from_fn(|row| {
            let above = if row > 0 { touched[row - 1] } else { 0 };
            wide(touched[row] | above | touched.get(row + 1).copied().unwrap_or(0))
        });
        let corner = at.rect();
        let block = |v: i32, from: i32| (v - from) as usize / BLOCK;
        let mut blocks = TileBlocks::default();
        for (i, pixels) in contours.pixels[..contours.seen].chunks(IN_BLOCK).enumerate() {
            let is_near =
                |p: &ContourPixel| near[block(p.y, corner.y0)] >> block(p.x, corner.x0) & 1 == 1;
            if pixels.iter().any(is_near) {
                blocks[i / (COLUMNS / BLOCK)] |= 1 << (i % (COLUMNS / BLOCK));
            }
        }
        (blocks != TileBlocks::default()).then_some(blocks)
    }

    /// A map of the canvas continued over the far side: as n̄ is.
    pub fn continue_map(&self, size: Size, map: impl Fn(usize, usize) -> f32 + Sync) -> Plane<f32> {
        self.map_each(size, |pixel| {
            let plane = super::continued::plane_of(pixel, &map);
            [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| {
                let at = pixel.other_at + vec2(dx as f32, dy as f32);
                plane.map_or(0.0, |plane| plane.here + plane.slope.dot(at))
            })
        })
    }

    /// A map over the far side: a value for each contour pixel, which all that it takes there hold.
    pub fn map<T: Copy + Send + Sync + Default>(
        &self,
        size: Size,
        value: impl Fn(&ContourPixel) -> T + Sync,
    ) -> Plane<T> {
        self.map_each(size, |pixel| [value(pixel); 4])
    }

    /// A map over the far side, from the four values of each contour pixel, row by row.
    fn map_each<T: Copy + Send + Sync + Default>(
        &self,
        size: Size,
        values: impl Fn(&ContourPixel) -> [T; 4] + Sync,
    ) -> Plane<T> {
        let mut map = Plane::full(size, T::default());
        let width = map.width().max(1);
        parallel::for_each_row(map.values_mut(), 2 * width, 1, |i, rows| {
            let (upper, lower) = rows.split_at_mut(width);
            let pairs = upper.as_chunks_mut::<2>().0.iter_mut().zip(lower.as_chunks_mut::<2>().0);
            for (j, (upper, lower)) in pairs.enumerate() {
                if let Some(pixel) = self.contour_pixel(2 * j, 2 * i) {
                    let [a, b, c, d] = values(pixel);
                    (*upper, *lower) = ([a, b], [c, d]);
                }
            }
        });
        map
    }
}

impl ContourPixel {
    /// The other side's pixel nearest to this one.
    pub fn nearest_other(&self) -> Option<(i32, i32)> {
        let away = |i: u32| {
            let (dx, dy) = steps_of(i);
            dx * dx + dy * dy
        };
        let (dx, dy) = steps_of(bits(self.others).min_by_key(|&i| away(i))?);
        Some((self.x + dx, self.y + dy))
    }

    /// The mean of a map of the canvas over the other side's pixels nearby.
    pub fn other_mean(&self, map: impl Fn(usize, usize) -> f32) -> f32 {
        super::mean_of(self.others, (self.x, self.y), map)
    }
}

/// Readings of a far side, as planes.
struct FarMaps {
    nbar: [Plane<f32>; 2],
    nz: Plane<f32>,
    depth: Plane<f32>,
    coverage: Plane<u8>,
    links: Plane<u8>,
}

impl FarMaps {
    fn empty(size: Size) -> Self {
        let still = || Plane::full(size, 0.0);
        let (coverage, links) = (Plane::full(size, 0), Plane::full(size, 0));
        Self {
            nbar: [still(), still()],
            nz: Plane::full(size, 1.0),
            depth: still(),
            coverage,
            links,
        }
    }
}

impl Surface {
    /// What the other sides of contour pixels read; `None` where no pixel has another one on
    /// a surface. Cached.
    pub fn far_side(self: &Arc<Self>) -> Option<Arc<Surface>> {
        let rows = self.contours().far_rows.len();
        (rows > 0)
            .then(|| self.derived.far_sides.get_or_compute((), 1, |_| self.build_far_side(rows)))
    }

    fn build_far_side(self: &Arc<Self>, rows: usize) -> Surface {
        let size = Size::new(COLUMNS as u32, (rows * BLOCK) as u32);
        let mut maps = FarMaps::empty(size);
        let contours = self.contours().clone();
        let band = BLOCK * COLUMNS;
        let FarMaps { nbar: [nx, ny], nz, depth, coverage, links } = &mut maps;
        let [nx, ny, nz, depth] =
            [nx, ny, nz, depth].map(|plane| plane.values_mut().chunks_mut(band));
        let [coverage, links] = [coverage, links].map(|plane| plane.values_mut().chunks_mut(band));
        let planes = nx.zip(ny).zip(nz).zip(depth).zip(coverage.zip(links));
        let detailed = self.far_normals();
        self.with_contour_maps(None, |read| {
            parallel::for_each(
                planes.zip(&contours.far_rows).enumerate(),
                1,
                |(row, (((((nx, ny), nz), depth), (coverage, links)), pixels))| {
                    let pixels = &contours.pixels[pixels.start as usize..pixels.end as usize];
                    for (i, pixel) in pixels.iter().enumerate() {
                        let window = PixelWindow::around(read, pixel.x, pixel.y);
                        let Some(continued) = Continued::from(&window, pixel.others) else {
                            continue;
                        };
                        let (x, y) = place_of(i);
                        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                            let (at, step) = (
                                (y + dy) * COLUMNS + x + dx,
                                pixel.other_at + vec2(dx as f32, dy as f32),
                            );
                            let n = continued.nbar(step);
                            (nx[at], ny[at], nz[at]) = (n.x, n.y, nz_of(n));
                            if let Some(normals) = detailed {
                                let n = normals.at(x + dx, row * BLOCK + y + dy);
                                (nx[at], ny[at], nz[at]) = (n.x, -n.y, n.z);
                            }
                            (depth[at], coverage[at]) = (continued.depth(step), 255);
                        }
                        links[y * COLUMNS + x] = links::RIGHT | links::DOWN;
                    }
                },
            );
        });
        let far_side = FarSide { surface: Arc::downgrade(self), canvas: self.size(), contours };
        let FarMaps { nbar: [nbar_x, nbar_y], nz, depth, coverage, links } = maps;
        self.far_side_of_planes([nbar_x, nbar_y, nz, depth], [coverage, links], far_side)
    }
}
