//! A tile: 64 × 64 pixels of a layer, premultiplied sRGB with 8 bits, and with 16 if something soft
//! was painted; shared and never edited while shared. Floor 1. Pixels of 16 bits, and what is
//! smooth, are in `sixteen_bit`.

pub mod sixteen_bit;

use crate::math::{Rect, srgb::quantize};
use sixteen_bit::Row16;
use tiny_skia::Pixmap;

/// Side of a tile, in pixels. 64² f32 RGBA is 64 KiB: one layer of a flattening stays in the
/// second-level cache.
pub const TILE: usize = 64;
/// Pixels of a tile.
pub const TILE_AREA: usize = TILE * TILE;

/// One tile's pixels in flight: premultiplied, sRGB-encoded, f32, row by row.
pub type TileF32 = [[f32; 4]; TILE_AREA];

/// A fresh transparent [`TileF32`] on the heap.
pub fn transparent_f32() -> Box<TileF32> {
    vec![[0.0f32; 4]; TILE_AREA]
        .into_boxed_slice()
        .try_into()
        .expect("a vector of TILE_AREA pixels")
}

/// Which tile of the canvas lattice: tile (0, 0) holds canvas pixel (0, 0); negative tiles lie left
/// of and above it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TileAt {
    /// From the left, in tiles.
    pub col: i32,
    /// From the top, in tiles.
    pub row: i32,
}

impl TileAt {
    /// The tile in this column and row.
    pub const fn new(col: i32, row: i32) -> Self {
        Self { col, row }
    }

    /// The tile that holds a canvas pixel.
    pub fn of_pixel(x: i32, y: i32) -> Self {
        Self { col: x.div_euclid(TILE as i32), row: y.div_euclid(TILE as i32) }
    }

    /// The canvas pixels of the tile.
    pub fn rect(self) -> Rect {
        let t = TILE as i32;
        Rect::new(self.col * t, self.row * t, (self.col + 1) * t, (self.row + 1) * t)
    }

    /// All tiles that a pixel rectangle touches, row by row.
    pub fn covering(rect: Rect) -> impl Iterator<Item = TileAt> {
        let r = if rect.is_empty() { Rect::EMPTY } else { rect };
        let (a, b) = (TileAt::of_pixel(r.x0, r.y0), TileAt::of_pixel(r.x1 - 1, r.y1 - 1));
        let rows = if r.is_empty() { 0..0 } else { a.row..b.row + 1 };
        rows.flat_map(move |row| (a.col..b.col + 1).map(move |col| TileAt { col, row }))
    }
}

/// The pixels of one tile. `None` in a grid is a transparent tile.
#[derive(Clone)]
pub struct Tile {
    pixmap: Pixmap,
    opaque: bool,
    /// What `pixmap` was rounded from, if it holds more than bytes can.
    rows16: Option<Box<[Row16]>>,
}

impl Tile {
    /// A tile of `TILE_AREA · 4` premultiplied bytes; colors above alpha are lowered to it.
    pub fn from_bytes(mut rgba: Vec<u8>) -> Option<Tile> {
        if rgba.len() != TILE_AREA * 4 {
            return None;
        }
        let opaque = lower_to_alpha(&mut rgba);
        let size = tiny_skia::IntSize::from_wh(TILE as u32, TILE as u32)?;
        Some(Tile { pixmap: Pixmap::from_vec(rgba, size)?, opaque, rows16: None })
    }

    /// A tile of [`TILE`] rows of 16 bits, colors no greater than alpha; one of bytes if these
    /// hold it exactly. `None` if it is wholly transparent.
    pub fn from_rows16(rows: Box<[Row16]>) -> Option<Tile> {
        if rows.len() != TILE || rows.iter().all(|row| row[3] == [0; TILE]) {
            return None;
        }
        let mut bytes = vec![0u8; TILE_AREA * 4];
        let is_of_bytes = sixteen_bit::to_bytes(&rows, &mut bytes);
        let tile = Tile::from_bytes(bytes)?;
        let opaque = tile.opaque && rows.iter().all(|row| row[3] == [u16::MAX; TILE]);
        Some(if is_of_bytes { tile } else { Tile { opaque, rows16: Some(rows), ..tile } })
    }

    /// Quantizes a tile; `None` if it is wholly transparent.
    pub fn quantize(pixels: &TileF32) -> Option<Tile> {
        let mut bytes = vec![0u8; TILE_AREA * 4];
        quantize_pixels(pixels, &mut bytes);
        Tile::from_pixels(bytes)
    }

    /// As [`Tile::from_bytes`]; `None` if it is wholly transparent.
    pub fn from_pixels(rgba: Vec<u8>) -> Option<Tile> {
        let is_transparent = rgba.chunks_exact(4).all(|p| p[3] == 0);
        if is_transparent { None } else { Tile::from_bytes(rgba) }
    }

    /// Bytes that a pixel takes at most; `is_16_bit`: tiles may have 16 bits.
    pub const fn most_bytes_a_pixel(is_16_bit: bool) -> u64 {
        if is_16_bit { 12 } else { 4 }
    }

    /// Bytes that its pixels take.
    pub fn held_bytes(&self) -> u64 {
        TILE_AREA as u64 * Self::most_bytes_a_pixel(self.is_16_bit())
    }

    /// Every pixel is wholly covered.
    pub fn is_opaque(&self) -> bool {
        self.opaque
    }

    /// Its rows of 16 bits, if bytes do not hold all of it.
    pub fn rows16(&self) -> Option<&[Row16]> {
        self.rows16.as_deref()
    }

    /// It holds more than bytes can.
    pub fn is_16_bit(&self) -> bool {
        self.rows16.is_some()
    }

    /// Its rows in 16 bits, whatever it holds.
    pub fn to_rows16(&self) -> Box<[Row16]> {
        self.rows16.clone().unwrap_or_else(|| {
            let mut rows = sixteen_bit::clear_rows();
            sixteen_bit::of_bytes(self.bytes(), &mut rows);
            rows
        })
    }

    /// A premultiplied pixel in 16 bits, whatever it holds; `x`, `y` below [`TILE`], transparent
    /// beyond.
    pub fn pixel16(&self, x: usize, y: usize) -> [u16; 4] {
        match &self.rows16 {
            Some(rows) => sixteen_bit::pixel_of(rows, x, y),
            None => {
                let byte =
                    self.bytes().as_chunks::<4>().0.get(y * TILE + x).copied().unwrap_or_default();
                byte.map(|v| u16::from(v) * sixteen_bit::LEVEL)
            }
        }
    }

    /// There is some paint on a pixel, even fainter than a byte can hold; `i`: its index, row by
    /// row.
    pub fn is_painted(&self, i: usize) -> bool {
        match &self.rows16 {
            Some(rows) => rows[i / TILE][3][i % TILE] > 0,
            None => self.bytes()[4 * i + 3] > 0,
        }
    }

    /// Both hold the same pixels.
    pub fn is_same(&self, other: &Tile) -> bool {
        let is_same_in_16_bits = match (&self.rows16, &other.rows16) {
            (Some(own), Some(other)) => are_equal(own.as_flattened(), other.as_flattened()),
            (own, other) => own.is_none() && other.is_none(),
        };
        let [own, other] = [self, other].map(|tile| tile.bytes().as_chunks::<TILE>().0);
        is_same_in_16_bits && are_equal(own, other)
    }

    /// Premultiplied RGBA bytes, row by row; 16 bits are rounded.
    pub fn bytes(&self) -> &[u8] {
        self.pixmap.data()
    }

    /// Its premultiplied pixels.
    pub fn pixmap(&self) -> &Pixmap {
        &self.pixmap
    }
}

/// Whether rows are equal. Each is compared as a whole: comparing slices goes byte by byte in a
/// browser.
fn are_equal<T: Copy + Into<u32>>(own: &[[T; TILE]], other: &[[T; TILE]]) -> bool {
    let is_equal = |(own, other): (&[T; TILE], &[T; TILE])| {
        own.iter().zip(other).fold(0, |off, (a, b)| off | ((*a).into() ^ (*b).into())) == 0
    };
    own.len() == other.len() && own.iter().zip(other).all(is_equal)
}

crate::widest! {
    /// Lowers colors to their alpha; whether every alpha is 255.
    fn lower_to_alpha(rgba: &mut [u8]) -> bool {
        let mut least = [u8::MAX; 32];
        // Eight pixels at a time, which become one shuffle and one minimum.
        for pixels in rgba.as_chunks_mut::<32>().0 {
            // A loop and no closure, which is not always inlined.
            let mut alpha = [0; 32];
            for i in 0..32 {
                alpha[i] = pixels[i | 3];
            }
            for i in 0..32 {
                pixels[i] = pixels[i].min(alpha[i]);
                least[i] = least[i].min(alpha[i]);
            }
        }
        least == [u8::MAX; 32]
    }

    /// Rounds premultiplied f32 pixels to bytes; `bytes` holds four for each pixel.
    pub fn quantize_pixels(pixels: &[[f32; 4]], bytes: &mut [u8]) {
        for (p, b) in pixels.iter().zip(bytes.chunks_exact_mut(4)) {
            for c in 0..4 {
                b[c] = quantize(p[c]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_left_of_the_canvas_have_negative_columns() {
        assert_eq!(TileAt::of_pixel(-1, 64), TileAt::new(-1, 1));
        assert_eq!(TileAt::covering(Rect::new(-1, 0, 65, 1)).count(), 3);
        assert_eq!(TileAt::covering(Rect::EMPTY).count(), 0);
    }

    #[test]
    fn colors_never_exceed_their_alpha() {
        let tile = Tile::from_bytes([200, 100, 0, 128].repeat(TILE_AREA)).unwrap();
        assert_eq!(&tile.bytes()[..4], &[128, 100, 0, 128]);
        assert!(!tile.is_opaque());
    }
}
