//! Pixels as a project stores them: PNGs with straight alpha, of 16 bits where some tile has
//! them, else of 8, each decoded again and compared before it is trusted. Floor 5. `look` decides
//! which pixels are stored.

use crate::Budget;
use crate::bitmap;
use crate::document::EncodedPixels;
use crate::icc_profiles::{icc_of, is_own_srgb};
use crate::math::{ColorProfile, Rect, Size};
use crate::raster::tile::sixteen_bit::byte_of;
use crate::raster::{Asset, Plane, TILE, Tile, TileAt, TileGrid};
use crate::{Error, Result};
use std::borrow::Cow;
use std::io::Write;
use std::path::Path;

/// The pixels of a paint layer that was a picture.
pub struct Painted {
    /// Of the whole picture, transparent parts included.
    pub size: Size,
    /// The pixels.
    pub tiles: TileGrid,
    /// A defect of the file that could be worked around, as a sentence.
    pub warning: Option<&'static str>,
}

/// The tight rectangle around what is not transparent, as a PNG; one transparent pixel if all is
/// transparent.
///
/// Premultiplied values come back exactly from straight ones, so nothing is lost.
///
/// * `profile`: what the file says that its colors are.
pub fn encode(
    file: &Path,
    tiles: &TileGrid,
    within: Option<Rect>,
    profile: ColorProfile,
) -> Result<EncodedPixels> {
    let bounds = painted_rect(tiles, within);
    let rect = if bounds.is_empty() { Rect::new(0, 0, 1, 1) } else { bounds };
    Ok(EncodedPixels {
        file: encode_rect(file, tiles, rect, profile)?,
        size: size_of(rect),
        x: rect.x0,
        y: rect.y0,
    })
}

/// All of a rectangle as a PNG.
pub fn encode_rect(
    file: &Path,
    tiles: &TileGrid,
    rect: Rect,
    profile: ColorProfile,
) -> Result<Asset> {
    let is_16_bit = tiles.is_16_bit_in(rect);
    let values = |strip: Rect| match is_16_bit {
        true => tiles
            .to_straight16(strip)
            .into_flattened()
            .into_iter()
            .flat_map(u16::to_be_bytes)
            .collect(),
        false => tiles.to_straight_rgba(strip),
    };
    let kind = if is_16_bit { PngKind::RGBA16 } else { PngKind::RGBA8 };
    let kind = PngKind { profile, ..kind };
    check(file, || strips(rect).map(|strip| Cow::Owned(values(strip))), size_of(rect), kind)
}

fn size_of(rect: Rect) -> Size {
    Size::new(rect.width() as u32, rect.height() as u32)
}

/// What a PNG holds of each pixel.
#[derive(Clone, Copy)]
struct PngKind {
    color: png::ColorType,
    depth: png::BitDepth,
    profile: ColorProfile,
}

impl PngKind {
    const RGBA8: PngKind = PngKind {
        color: png::ColorType::Rgba,
        depth: png::BitDepth::Eight,
        profile: ColorProfile::Srgb,
    };
    const RGBA16: PngKind = PngKind { depth: png::BitDepth::Sixteen, ..Self::RGBA8 };
    const GRAY8: PngKind = PngKind { color: png::ColorType::Grayscale, ..Self::RGBA8 };

    /// Of a pixel.
    fn bytes(self) -> usize {
        self.color.samples() * if self.depth == png::BitDepth::Sixteen { 2 } else { 1 }
    }
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

/// A mask as a gray PNG.
pub fn encode_coverage(file: &Path, plane: &Plane<u8>) -> Result<Asset> {
    check(file, || [Cow::Borrowed(plane.values())].into_iter(), plane.size(), PngKind::GRAY8)
}

/// Straight RGBA texels as a PNG of sRGB, the colors of transparent ones kept.
pub fn encode_texels(file: &Path, texels: &[[u8; 4]], size: Size) -> Result<Asset> {
    encode_texels_in(file, texels, size, ColorProfile::Srgb)
}

/// The same in a color profile.
pub fn encode_texels_in(
    file: &Path,
    texels: &[[u8; 4]],
    size: Size,
    profile: ColorProfile,
) -> Result<Asset> {
    let kind = PngKind { profile, ..PngKind::RGBA8 };
    check(file, || [Cow::Borrowed(texels.as_flattened())].into_iter(), size, kind)
}

/// The same with 16 bits a channel.
pub fn encode16(file: &Path, texels: &[[u16; 4]], size: Size) -> Result<Asset> {
    let bytes = |rows: &[[u16; 4]]| -> Cow<[u8]> {
        rows.as_flattened().iter().flat_map(|v| v.to_be_bytes()).collect()
    };
    let rows = || texels.chunks(size.width as usize).map(bytes);
    check(file, rows, size, PngKind::RGBA16)
}

/// Of a chunk of packed pixels.
const CHUNK_BYTES: usize = 1 << 20;
/// What a PNG takes besides its pixels.
const STORED_BYTES: usize = 1 << 10;

/// Encodes, decodes the result, and compares: encoders have written files that nobody could read.
///
/// * `strips`: the values, a few whole rows at a time. Read twice.
fn check<'v, S: Iterator<Item = Cow<'v, [u8]>>>(
    file: &Path,
    strips: impl Fn() -> S,
    size: Size,
    kind: PngKind,
) -> Result<Asset> {
    let encode = |how| {
        encode_strips(strips(), size, kind, how).map_err(|e| Error::unsupported_file(file, e))
    };
    let mut bytes = encode(png::Compression::Fast)?;
    // The quick compressor makes noise larger than it is.
    if bytes.len() > STORED_BYTES + size.area() * kind.bytes() * 1001 / 1000 {
        bytes = encode(png::Compression::NoCompression)?;
    }
    if !is_stored_as(&bytes, strips()) {
        return Err(Error::unsupported_file(
            file,
            "a picture could not be read back correctly; nothing was saved",
        ));
    }
    Ok(bytes.into())
}

fn encode_strips<'v>(
    strips: impl Iterator<Item = Cow<'v, [u8]>>,
    size: Size,
    kind: PngKind,
    how: png::Compression,
) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut info = png::Info::with_size(size.width, size.height);
    (info.color_type, info.bit_depth) = (kind.color, kind.depth);
    match (kind.depth, kind.profile) {
        (png::BitDepth::Eight, ColorProfile::Srgb) => {
            info.srgb = Some(png::SrgbRenderingIntent::Perceptual);
        }
        // Krita asks for a profile, layer by layer, for pictures of 16 bits that do not contain
        // one.
        (_, profile) => info.icc_profile = Some(icc_of(profile).into()),
    }
    let mut encoder = png::Encoder::with_info(&mut bytes, info)?;
    encoder.set_compression(how);
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
fn is_stored_as<'v>(png: &[u8], strips: impl Iterator<Item = Cow<'v, [u8]>>) -> bool {
    let Ok(mut reader) = png::Decoder::new(std::io::Cursor::new(png)).read_info() else {
        return false;
    };
    let Some(length) = reader.output_line_size(reader.info().width) else { return false };
    let mut line = vec![0; length];
    let is_same = |reader: &mut png::Reader<_>, line: &mut Vec<u8>, row: &[u8]| {
        matches!(reader.read_row(line), Ok(Some(_))) && line == row
    };
    let all = strips
        .into_iter()
        .all(|strip| strip.chunks(length).all(|row| is_same(&mut reader, &mut line, row)));
    all && matches!(reader.read_row(&mut line), Ok(None)) && reader.finish().is_ok()
}

/// Whether a PNG that was encoded here holds 16 bits a channel.
pub fn is_16_bit(png: &[u8]) -> bool {
    let reader = png::Decoder::new(std::io::Cursor::new(png)).read_info();
    reader.is_ok_and(|reader| reader.info().bit_depth == png::BitDepth::Sixteen)
}

/// The values of a PNG that was encoded here, rounded to bytes.
pub fn decode_png(bytes: &[u8]) -> Option<Vec<u8>> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().ok()?;
    let mut values = vec![0; reader.output_buffer_size()?];
    let info = reader.next_frame(&mut values).ok()?;
    reader.finish().ok()?;
    values.truncate(info.buffer_size());
    Some(match info.bit_depth {
        png::BitDepth::Sixteen => {
            values.as_chunks().0.iter().map(|v| byte_of(u16::from_be_bytes(*v))).collect()
        }
        _ => values,
    })
}

/// The tiles of a PNG of the kind that is stored here, its corner at a canvas pixel; `None` for any
/// other or damaged one: `picture` then reads it or reports the error.
///
/// A row of tiles at a time, so that only this is in memory twice.
pub fn decode_tiles(bytes: &[u8], x: i32, y: i32, budget: &Budget) -> Option<Painted> {
    let limits = png::Limits { bytes: usize::try_from(bitmap::bytes_beside_pixels(bytes)).ok()? };
    let mut decoder = png::Decoder::new_with_limits(std::io::Cursor::new(bytes), limits);
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().ok()?;
    let info = reader.info();
    let is_own = |icc: &[u8]| {
        let stays = budget.profile == ColorProfile::DisplayP3;
        is_own_srgb(icc) || stays && icc_of(ColorProfile::DisplayP3) == icc
    };
    let stays = !bitmap::has_png_profile(bytes) || info.icc_profile.as_deref().is_some_and(is_own);
    let stays = stays && bitmap::png_cicp(bytes).is_none();
    let is_bare = bitmap::png_exif(bytes).is_none() && info.animation_control.is_none() && stays;
    let size = budget.size(Path::new(""), info.width.into(), info.height.into()).ok()?;
    let (color, depth) = reader.output_color_type();
    let is_16_bit = depth == png::BitDepth::Sixteen;
    if !(is_16_bit || depth == png::BitDepth::Eight) || !is_bare || info.interlaced {
        return None;
    }
    let rect =
        Rect::new(x, y, x.checked_add(size.width as i32)?, y.checked_add(size.height as i32)?);
    let mut tiles = TileGrid::for_rect(rect);
    let (line, held) = (rect.width(), rect.width() * TILE.min(rect.height()));
    let (mut strip, mut pixels16) = (
        vec![[0; 4]; if is_16_bit { 0 } else { held }],
        vec![[0; 4]; if is_16_bit { held } else { 0 }],
    );
    let mut used_bytes = 0;
    let mut stored = vec![0; reader.output_line_size(size.width)?];
    let mut top = y;
    while top < rect.y1 {
        let next = TileAt::of_pixel(x, top).rect().y1.min(rect.y1);
        let rows = (next - top) as usize;
        for row in 0..rows {
            reader.read_row(&mut stored).ok()??;
            let row = row * line..(row + 1) * line;
            match is_16_bit {
                true => {
                    let samples: Vec<u16> =
                        stored.as_chunks().0.iter().map(|v| u16::from_be_bytes(*v)).collect();
                    to_rgba(&samples, color, u16::MAX, &mut pixels16[row])?;
                }
                false => to_rgba(&stored, color, u8::MAX, &mut strip[row])?,
            }
        }
        let part = match is_16_bit {
            true => TileGrid::from_straight16(&pixels16[..rows * line], line, rows, x, top),
            false => TileGrid::from_straight_rgba(
                strip[..rows * line].as_flattened(),
                line,
                rows,
                x,
                top,
            ),
        };
        let part = if budget.sixteen_bit_paint { part } else { part.rounded() };
        used_bytes += part.bytes() as u64;
        budget.room(Path::new(""), "a layer's pixels", used_bytes).ok()?;
        part.iter().for_each(|(at, tile)| tiles.set(at, Some(tile.clone())));
        top = next;
    }
    reader.finish().ok()?;
    Some(Painted { size, tiles, warning: None })
}

/// A row of a PNG's samples as straight RGBA; `None` of one that still numbers colors. `whole`:
/// the greatest sample.
fn to_rgba<T: Copy>(
    stored: &[T],
    color: png::ColorType,
    whole: T,
    row: &mut [[T; 4]],
) -> Option<()> {
    match color {
        png::ColorType::Rgba => row.copy_from_slice(stored.as_chunks().0.get(..row.len())?),
        png::ColorType::Rgb => {
            row.iter_mut()
                .zip(stored.as_chunks().0)
                .for_each(|(p, [r, g, b])| *p = [*r, *g, *b, whole]);
        }
        png::ColorType::Grayscale => {
            row.iter_mut().zip(stored).for_each(|(p, v)| *p = [*v, *v, *v, whole])
        }
        png::ColorType::GrayscaleAlpha => {
            row.iter_mut().zip(stored.as_chunks().0).for_each(|(p, [v, a])| *p = [*v, *v, *v, *a]);
        }
        png::ColorType::Indexed => return None,
    }
    Some(())
}

/// The smallest rectangle that holds every pixel that is not transparent.
fn painted_rect(tiles: &TileGrid, within: Option<Rect>) -> Rect {
    tiles.iter().fold(Rect::EMPTY, |bounds, (at, tile)| {
        let rect = painted_rect_in_tile(at, tile);
        bounds.union(within.map_or(rect, |within| rect.intersect(within)))
    })
}

fn painted_rect_in_tile(at: TileAt, tile: &Tile) -> Rect {
    let tile_rect = at.rect();
    if tile.is_opaque() {
        return tile_rect;
    }
    let (mut x0, mut x1, mut y0, mut y1) = (TILE, 0, TILE, 0);
    for y in 0..TILE {
        let is_painted = |x: &usize| tile.is_painted(y * TILE + x);
        let Some(first) = (0..TILE).find(is_painted) else { continue };
        let last = (0..TILE).rfind(is_painted).unwrap_or(first);
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
        // Every alpha with every color it allows.
        let premultiplied: Vec<u8> =
            (0..=255u8).flat_map(|a| (0..=a).flat_map(move |c| [c, a - c, 0, a])).collect();
        let mut tiles = TileGrid::default();
        for (i, chunk) in premultiplied.chunks(TILE * TILE * 4).enumerate() {
            let mut bytes = chunk.to_vec();
            bytes.resize(TILE * TILE * 4, 0);
            tiles.set(TileAt::new(i as i32 - 3, 1), Tile::from_bytes(bytes).map(Into::into));
        }
        let encoded = encode(Path::new("a"), &tiles, None, ColorProfile::Srgb).unwrap();
        let picture =
            picture::decode(Path::new("a"), encoded.file.bytes(), &Budget::default()).unwrap();
        let crate::raster::picture::Texels::Srgb8(texels) = picture.texels else { panic!("bytes") };
        let (w, h) = (encoded.size.width as usize, encoded.size.height as usize);
        let back = TileGrid::from_straight_rgba(texels.as_flattened(), w, h, encoded.x, encoded.y);
        let quick = decode_tiles(encoded.file.bytes(), encoded.x, encoded.y, &Budget::default())
            .unwrap()
            .tiles;
        for (at, tile) in tiles.iter() {
            assert_eq!(back.tile(at).unwrap().bytes(), tile.bytes(), "{at:?}");
            assert_eq!(quick.tile(at).unwrap().bytes(), tile.bytes(), "{at:?}");
        }
    }

    #[test]
    fn pixels_of_16_bits_come_back_as_they_were_beside_those_of_8() {
        let value = |i: usize, c: u32| (crate::math::hash::unit(i as u32, c, 3) * 65536.0) as u16;
        let soft = |i: usize| [0, 1, 2, 3].map(|c| value(i, c));
        // Fainter than a byte can say at the left border.
        let pixel = |i: usize| {
            if i.is_multiple_of(200) {
                [9, 8, 7, 100]
            } else if i % 200 > 135 {
                [257, 514, 0, 65535]
            } else {
                soft(i)
            }
        };
        let pixels: Vec<[u16; 4]> = (0..200 * 90).map(pixel).collect();
        let tiles = TileGrid::from_straight16(&pixels, 200, 90, -8, 5);
        let encoded = encode(Path::new("a"), &tiles, None, ColorProfile::Srgb).unwrap();
        assert!(is_16_bit(encoded.file.bytes()));
        assert!(bitmap::has_png_profile(encoded.file.bytes()), "Krita would ask for one");
        assert_eq!((encoded.x, encoded.y, encoded.size), (-8, 5, Size::new(200, 90)));
        let quick = decode_tiles(encoded.file.bytes(), encoded.x, encoded.y, &Budget::default())
            .unwrap()
            .tiles;
        // With a profile, as Krita writes them, another way is taken.
        let picture =
            picture::decode(Path::new("a"), encoded.file.bytes(), &Budget::default()).unwrap();
        let slow = picture::to_tiles(&picture, encoded.x, encoded.y);
        for (at, tile) in tiles.iter() {
            assert!(
                quick.tile(at).unwrap().is_same(tile) && slow.tile(at).unwrap().is_same(tile),
                "{at:?}"
            );
            assert_eq!(tile.is_16_bit(), at.col < 2, "{at:?}");
        }
        assert!(!is_16_bit(
            encode(
                Path::new("a"),
                &tiles,
                Some(Rect::new(150, 5, 180, 9)),
                ColorProfile::default()
            )
            .unwrap()
            .file
            .bytes()
        ));
        let short = Budget { memory_bytes: 100_000, ..Budget::default() };
        assert!(decode_tiles(encoded.file.bytes(), 0, 0, &short).is_none());
        let bytes = decode_png(encoded.file.bytes()).unwrap();
        assert_eq!(bytes[4 * 33..4 * 34], soft(33).map(|v| ((u32::from(v) + 128) / 257) as u8));
    }

    #[test]
    fn only_what_is_painted_is_stored() {
        let mut rgba = vec![0; 100 * 90 * 4];
        for (x, y) in [(70, 10), (20, 80)] {
            rgba[(y * 100 + x) * 4..][..4].copy_from_slice(&[1, 2, 3, 4]);
        }
        let tiles = TileGrid::from_straight_rgba(&rgba, 100, 90, -30, -7);
        let encoded = encode(Path::new("a"), &tiles, None, ColorProfile::Srgb).unwrap();
        assert_eq!((encoded.x, encoded.y, encoded.size), (-10, 3, Size::new(51, 71)));
        let nothing =
            encode(Path::new("a"), &TileGrid::default(), None, ColorProfile::default()).unwrap();
        assert_eq!(nothing.size, Size::new(1, 1));
    }

    #[test]
    fn a_mask_comes_back_as_it_was() {
        let plane = Plane::from_fn(Size::new(256, 2), |x, _| x as u8);
        let file = encode_coverage(Path::new("m"), &plane).unwrap();
        let back =
            picture::decode_coverage(Path::new("m"), file.bytes(), &Budget::default()).unwrap();
        assert_eq!(back.values(), plane.values());
    }
}
