//! Pixels as a project stores them: 8-bit sRGB PNGs with straight alpha, each decoded again and compared before it is
//! trusted. Floor 5. `look` decides which pixels are stored.

use crate::Budget;
use crate::document::cache::EncodedPixels;
use crate::math::{Rect, Size};
use crate::raster::{Asset, Plane, TILE, Tile, TileAt, TileGrid};
use crate::{Error, Result};
use std::path::Path;

/// The tight rectangle around what is not transparent, as a PNG; one transparent pixel where there is nothing.
///
/// Premultiplied bytes come back from straight ones as they were, so nothing is lost.
pub fn encode(file: &Path, tiles: &TileGrid, within: Option<Rect>) -> Result<EncodedPixels> {
    let bounds = painted(tiles, within);
    let rect = if bounds.is_empty() { Rect::new(0, 0, 1, 1) } else { bounds };
    let size = Size::new(rect.width() as u32, rect.height() as u32);
    let straight = tiles.to_straight_rgba(rect);
    let png = checked(file, &straight, size, png::ColorType::Rgba)?;
    Ok(EncodedPixels { file: png, size, x: rect.x0, y: rect.y0 })
}

/// A mask as a grey PNG.
pub fn encode_coverage(file: &Path, plane: &Plane<u8>) -> Result<Asset> {
    checked(file, plane.values(), plane.size(), png::ColorType::Grayscale)
}

/// Straight RGBA texels as a PNG, the colours of transparent ones kept.
pub fn encode_texels(file: &Path, texels: &[[u8; 4]], size: Size) -> Result<Asset> {
    checked(file, texels.as_flattened(), size, png::ColorType::Rgba)
}

/// Encodes, decodes the result and compares it: encoders have written unreadable files before.
fn checked(file: &Path, values: &[u8], size: Size, color: png::ColorType) -> Result<Asset> {
    let bytes = encoded(values, size, color).map_err(|e| Error::unsupported(file, e))?;
    if decoded(&bytes).as_deref() != Some(values) {
        return Err(Error::unsupported(file, "a picture did not come back as it was written; nothing was saved"));
    }
    Ok(bytes.into())
}

fn encoded(values: &[u8], size: Size, color: png::ColorType) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size.width, size.height);
    encoder.set_color(color);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(values)?;
    writer.finish()?;
    Ok(bytes)
}

/// The values of a PNG that was encoded here.
pub fn decoded(bytes: &[u8]) -> Option<Vec<u8>> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().ok()?;
    let mut values = vec![0; reader.output_buffer_size()?];
    let info = reader.next_frame(&mut values).ok()?;
    reader.finish().ok()?;
    values.truncate(info.buffer_size());
    Some(values)
}

/// The tiles of a PNG of the kind that is stored here, its corner at a canvas pixel; `None` for any other or damaged
/// one: `picture` then reads it or reports the error.
///
/// A row of tiles at a time, so that no more than that is in memory twice.
pub fn decode_tiles(bytes: &[u8], x: i32, y: i32, budget: &Budget) -> Option<TileGrid> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().ok()?;
    let info = reader.info();
    let is_plain = (info.color_type, info.bit_depth) == (png::ColorType::Rgba, png::BitDepth::Eight);
    let is_bare = info.icc_profile.is_none() && info.exif_metadata.is_none() && info.animation_control.is_none();
    if !is_plain || !is_bare || info.interlaced {
        return None;
    }
    let size = budget.size(Path::new(""), info.width.into(), info.height.into()).ok()?;
    let rect = Rect::new(x, y, x.checked_add(size.width as i32)?, y.checked_add(size.height as i32)?);
    let mut grid = TileGrid::for_rect(rect);
    let line = rect.width() * 4;
    let mut strip = vec![0; line * TILE.min(rect.height())];
    let mut top = y;
    while top < rect.y1 {
        let next = TileAt::of_pixel(x, top).rect().y1.min(rect.y1);
        let rows = (next - top) as usize;
        for row in strip[..rows * line].chunks_exact_mut(line) {
            reader.read_row(row).ok()??;
        }
        let tiles = TileGrid::from_straight_rgba(&strip[..rows * line], rect.width(), rows, x, top);
        tiles.iter().for_each(|(at, tile)| grid.set(at, Some(tile.clone())));
        top = next;
    }
    reader.finish().ok()?;
    Some(grid)
}

/// The smallest rectangle that holds every pixel that is not transparent.
fn painted(tiles: &TileGrid, within: Option<Rect>) -> Rect {
    tiles.iter().fold(Rect::EMPTY, |bounds, (at, tile)| {
        let rect = painted_of(at, tile);
        bounds.union(within.map_or(rect, |within| rect.intersect(within)))
    })
}

fn painted_of(at: TileAt, tile: &Tile) -> Rect {
    let tile_rect = at.rect();
    if tile.is_opaque() {
        return tile_rect;
    }
    let (mut x0, mut x1, mut y0, mut y1) = (TILE, 0, TILE, 0);
    for (y, row) in tile.bytes().chunks_exact(TILE * 4).enumerate() {
        let is_painted = |pixel: &[u8]| pixel[3] != 0;
        let Some(first) = row.chunks_exact(4).position(is_painted) else { continue };
        let last = row.chunks_exact(4).rposition(is_painted).unwrap_or(first);
        (x0, x1) = (x0.min(first), x1.max(last + 1));
        (y0, y1) = (y0.min(y), y + 1);
    }
    let (x, y) = (tile_rect.x0, tile_rect.y0);
    Rect::new(x + x0 as i32, y + y0 as i32, x + x1 as i32, y + y1 as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture;

    #[test]
    fn premultiplied_pixels_come_back_as_they_were() {
        // Every alpha with every colour it allows.
        let premultiplied: Vec<u8> = (0..=255u8).flat_map(|a| (0..=a).flat_map(move |c| [c, a - c, 0, a])).collect();
        let mut tiles = TileGrid::default();
        for (i, chunk) in premultiplied.chunks(TILE * TILE * 4).enumerate() {
            let mut bytes = chunk.to_vec();
            bytes.resize(TILE * TILE * 4, 0);
            tiles.set(TileAt::new(i as i32 - 3, 1), Tile::from_bytes(bytes).map(Into::into));
        }
        let encoded = encode(Path::new("a"), &tiles, None).unwrap();
        let picture = picture::decode(Path::new("a"), encoded.file.bytes(), &Budget::default()).unwrap();
        let crate::raster::picture::Texels::Srgb8(texels) = picture.texels else { panic!("bytes") };
        let (w, h) = (encoded.size.width as usize, encoded.size.height as usize);
        let back = TileGrid::from_straight_rgba(texels.as_flattened(), w, h, encoded.x, encoded.y);
        let quick = decode_tiles(encoded.file.bytes(), encoded.x, encoded.y, &Budget::default()).unwrap();
        for (at, tile) in tiles.iter() {
            assert_eq!(back.tile(at).unwrap().bytes(), tile.bytes(), "{at:?}");
            assert_eq!(quick.tile(at).unwrap().bytes(), tile.bytes(), "{at:?}");
        }
    }
    #[test]
    fn only_what_is_painted_is_stored() {
        let mut rgba = vec![0; 100 * 90 * 4];
        for (x, y) in [(70, 10), (20, 80)] {
            rgba[(y * 100 + x) * 4..][..4].copy_from_slice(&[1, 2, 3, 4]);
        }
        let tiles = TileGrid::from_straight_rgba(&rgba, 100, 90, -30, -7);
        let encoded = encode(Path::new("a"), &tiles, None).unwrap();
        assert_eq!((encoded.x, encoded.y, encoded.size), (-10, 3, Size::new(51, 71)));
        let nothing = encode(Path::new("a"), &TileGrid::default(), None).unwrap();
        assert_eq!(nothing.size, Size::new(1, 1));
    }
    #[test]
    fn a_mask_comes_back_as_it_was() {
        let plane = Plane::from_fn(Size::new(256, 2), |x, _| x as u8);
        let file = encode_coverage(Path::new("m"), &plane).unwrap();
        let back = picture::decode_coverage(Path::new("m"), file.bytes(), &Budget::default()).unwrap();
        assert_eq!(back.values(), plane.values());
    }
}
