//! Pixels as a project stores them: 8-bit sRGB PNGs with straight alpha, each decoded again and compared before it is
//! trusted. Floor 5. `look` decides which pixels are stored.

use crate::Budget;
use crate::bitmap;
use crate::document::EncodedPixels;
use crate::math::{Rect, Size};
use crate::raster::{Asset, Plane, TILE, Tile, TileAt, TileGrid};
use crate::{Error, Result};
use std::borrow::Cow;
use std::io::Write;
use std::path::Path;

/// The pixels of a paint layer that was a picture.
pub struct Painted {
    /// Of the whole picture, transparent parts included.
    pub size: Size,
    pub tiles: TileGrid,
}

/// The tight rectangle around what is not transparent, as a PNG; one transparent pixel where there is nothing.
///
/// Premultiplied bytes come back from straight ones as they were, so nothing is lost.
pub fn encode(file: &Path, tiles: &TileGrid, within: Option<Rect>) -> Result<EncodedPixels> {
    let bounds = painted(tiles, within);
    let rect = if bounds.is_empty() { Rect::new(0, 0, 1, 1) } else { bounds };
    let size = Size::new(rect.width() as u32, rect.height() as u32);
    let strips = || strips(rect).map(|strip| Cow::Owned(tiles.to_straight_rgba(strip)));
    Ok(EncodedPixels { file: checked(file, strips, size, png::ColorType::Rgba)?, size, x: rect.x0, y: rect.y0 })
}

/// A rectangle in rows of tiles.
pub fn strips(rect: Rect) -> impl Iterator<Item = Rect> {
    let row_of = |y: i32| TileAt::of_pixel(rect.x0, y).row;
    let rows = row_of(rect.y0)..=row_of(rect.y1 - 1);
    rows.map(move |row| {
        let tile = TileAt::new(0, row).rect();
        Rect::new(rect.x0, tile.y0.max(rect.y0), rect.x1, tile.y1.min(rect.y1))
    })
}

/// A mask as a grey PNG.
pub fn encode_coverage(file: &Path, plane: &Plane<u8>) -> Result<Asset> {
    checked(file, || [Cow::Borrowed(plane.values())].into_iter(), plane.size(), png::ColorType::Grayscale)
}

/// Straight RGBA texels as a PNG, the colours of transparent ones kept.
pub fn encode_texels(file: &Path, texels: &[[u8; 4]], size: Size) -> Result<Asset> {
    checked(file, || [Cow::Borrowed(texels.as_flattened())].into_iter(), size, png::ColorType::Rgba)
}

/// Of a chunk of packed pixels.
const CHUNK_BYTES: usize = 1 << 20;
/// What a PNG takes beside its pixels.
const STORED_BYTES: usize = 1 << 10;

/// Encodes, decodes what was encoded, and compares: encoders have written files that nobody could read.
///
/// * `strips`: the values, a few whole rows at a time. Asked for twice.
fn checked<'v, S: Iterator<Item = Cow<'v, [u8]>>>(
    file: &Path,
    strips: impl Fn() -> S,
    size: Size,
    color: png::ColorType,
) -> Result<Asset> {
    let encode = |how| encoded(strips(), size, color, how).map_err(|e| Error::unsupported(file, e));
    let mut bytes = encode(png::Compression::Fast)?;
    // The quick compressor makes noise larger than it is.
    if bytes.len() > STORED_BYTES + size.area() * color.samples() * 1001 / 1000 {
        bytes = encode(png::Compression::NoCompression)?;
    }
    if !comes_back(&bytes, strips()) {
        return Err(Error::unsupported(file, "a picture did not come back as it was written; nothing was saved"));
    }
    Ok(bytes.into())
}

fn encoded<'v>(
    strips: impl Iterator<Item = Cow<'v, [u8]>>,
    size: Size,
    color: png::ColorType,
    how: png::Compression,
) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size.width, size.height);
    encoder.set_color(color);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(how);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    let mut rows = writer.stream_writer_with_size(CHUNK_BYTES)?;
    for strip in strips {
        rows.write_all(&strip)?;
    }
    rows.finish()?;
    writer.finish()?;
    Ok(bytes)
}

/// Whether a PNG holds these values, row by row.
fn comes_back<'v>(png: &[u8], strips: impl Iterator<Item = Cow<'v, [u8]>>) -> bool {
    let Ok(mut reader) = png::Decoder::new(std::io::Cursor::new(png)).read_info() else { return false };
    let Some(length) = reader.output_line_size(reader.info().width) else { return false };
    let mut line = vec![0; length];
    let is_same = |reader: &mut png::Reader<_>, line: &mut Vec<u8>, row: &[u8]| {
        matches!(reader.read_row(line), Ok(Some(_))) && line == row
    };
    let all = strips.into_iter().all(|strip| strip.chunks(length).all(|row| is_same(&mut reader, &mut line, row)));
    all && matches!(reader.read_row(&mut line), Ok(None)) && reader.finish().is_ok()
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
pub fn decode_tiles(bytes: &[u8], x: i32, y: i32, budget: &Budget) -> Option<Painted> {
    let limits = png::Limits { bytes: usize::try_from(bitmap::beside_pixels(bytes)).ok()? };
    let mut decoder = png::Decoder::new_with_limits(std::io::Cursor::new(bytes), limits);
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().ok()?;
    let info = reader.info();
    let is_bare = info.exif_metadata.is_none() && info.animation_control.is_none() && !bitmap::has_png_profile(bytes);
    let size = budget.size(Path::new(""), info.width.into(), info.height.into()).ok()?;
    let (color, depth) = reader.output_color_type();
    if depth != png::BitDepth::Eight || !is_bare || info.interlaced {
        return None;
    }
    let rect = Rect::new(x, y, x.checked_add(size.width as i32)?, y.checked_add(size.height as i32)?);
    let mut tiles = TileGrid::for_rect(rect);
    let line = rect.width() * 4;
    let mut strip = vec![0; line * TILE.min(rect.height())];
    let mut stored = vec![0; reader.output_line_size(size.width)?];
    let mut top = y;
    while top < rect.y1 {
        let next = TileAt::of_pixel(x, top).rect().y1.min(rect.y1);
        let rows = (next - top) as usize;
        for row in strip[..rows * line].chunks_exact_mut(line) {
            reader.read_row(&mut stored).ok()??;
            to_rgba(&stored, color, row)?;
        }
        let part = TileGrid::from_straight_rgba(&strip[..rows * line], rect.width(), rows, x, top);
        part.iter().for_each(|(at, tile)| tiles.set(at, Some(tile.clone())));
        top = next;
    }
    reader.finish().ok()?;
    Some(Painted { size, tiles })
}

/// A row of a PNG's samples as straight RGBA; `None` of one that still numbers colours.
fn to_rgba(stored: &[u8], color: png::ColorType, row: &mut [u8]) -> Option<()> {
    let pixels = row.as_chunks_mut::<4>().0;
    match color {
        png::ColorType::Rgba => row.copy_from_slice(stored.get(..row.len())?),
        png::ColorType::Rgb => {
            pixels.iter_mut().zip(stored.as_chunks().0).for_each(|(p, [r, g, b])| *p = [*r, *g, *b, 255]);
        }
        png::ColorType::Grayscale => pixels.iter_mut().zip(stored).for_each(|(p, v)| *p = [*v, *v, *v, 255]),
        png::ColorType::GrayscaleAlpha => {
            pixels.iter_mut().zip(stored.as_chunks().0).for_each(|(p, [v, a])| *p = [*v, *v, *v, *a]);
        }
        png::ColorType::Indexed => return None,
    }
    Some(())
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
        let quick = decode_tiles(encoded.file.bytes(), encoded.x, encoded.y, &Budget::default()).unwrap().tiles;
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
