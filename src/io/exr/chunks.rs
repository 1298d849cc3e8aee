//! The chunks of an EXR: found by walking the file, checked, then decoded in parallel. Floor 5. The
//! walk does not trust the file's numbers: it finds every chunk and verifies that none is missing
//! before any pixel is allocated.

use super::guard;
use crate::{Error, Result};
use exr::block::{
    UncompressedBlock,
    chunk::{
        Chunk as CrateChunk, CompressedBlock, CompressedScanLineBlock, CompressedTileBlock,
        TileCoordinates,
    },
};
use exr::math::Vec2;
use exr::meta::{BlockDescription, MetaData, header::Header};
use exr::prelude::Compression;
use rayon::prelude::*;
use std::{ops::Range, path::Path};

/// Where a chunk's compressed bytes lie and which block of its part they hold.
#[derive(Clone, Debug)]
pub struct Chunk {
    pub part: usize,
    place: ChunkPlace,
    bytes: Range<usize>,
}

impl Chunk {
    /// The rows of the display window that it holds some of, those of a whole block.
    pub fn rows(&self, header: &Header) -> Range<i64> {
        let (data, display) = (
            header.own_attributes.layer_position,
            header.shared_attributes.display_window.position,
        );
        let (top, rows) = match (self.place, header.blocks) {
            (ChunkPlace::Rows { y }, _) => {
                (i64::from(y), header.compression.scan_lines_per_block())
            }
            (ChunkPlace::Tile { y, .. }, BlockDescription::Tiles(tiles)) => {
                (i64::from(data.y()) + (y * tiles.tile_size.y()) as i64, tiles.tile_size.y())
            }
            (ChunkPlace::Tile { .. }, BlockDescription::ScanLines) => {
                (i64::from(data.y()), header.layer_size.y())
            }
        };
        let top = top - i64::from(display.y());
        top..top + rows as i64
    }
}

#[derive(Clone, Copy, Debug)]
enum ChunkPlace {
    /// The top row, in the file's own coordinates.
    Rows { y: i32 },
    /// A tile of the full resolution.
    Tile { x: usize, y: usize },
}

/// Reads little-endian numbers one after another.
struct WordReader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl WordReader<'_> {
    fn next(&mut self) -> Option<i32> {
        let word = self.bytes.get(self.at..)?.first_chunk::<4>()?;
        self.at += 4;
        Some(i32::from_le_bytes(*word))
    }
}

/// Finds the chunks of every part's full resolution from the byte after the header.
///
/// Fails if the file ends early, a chunk's position or size is wrong, or a block is missing.
pub fn walk(file: &Path, bytes: &[u8], header_end: usize, meta: &MetaData) -> Result<Vec<Chunk>> {
    let total: usize = meta.headers.iter().fold(0, |sum, h| h.chunk_count.saturating_add(sum));
    let tables = total.saturating_mul(8).saturating_add(header_end);
    if tables > bytes.len() {
        return Err(Error::decode(
            file,
            format!("the EXR promises {total} chunks but ends at byte {}", bytes.len()),
        ));
    }
    let mut words = WordReader { bytes, at: tables };
    let mut seen: Vec<Vec<bool>> =
        meta.headers.iter().map(|h| vec![false; full_blocks(h)]).collect();
    let mut chunks = Vec::new();
    for number in 0..total {
        // Smaller copies of the picture are not read; some programs promise them and write none.
        if words.at == bytes.len() && seen.iter().flatten().all(|&s| s) {
            break;
        }
        let cut = || {
            Error::decode(
                file,
                format!("the EXR ends in chunk {} of {total}; it is cut short", number + 1),
            )
        };
        let bad = || {
            Error::decode(file, format!("chunk {} of {total} of the EXR is damaged", number + 1))
        };
        let part =
            if meta.requirements.has_multiple_layers { words.next().ok_or_else(cut)? } else { 0 };
        let part = usize::try_from(part).map_err(|_| bad())?;
        let header = meta.headers.get(part).ok_or_else(bad)?;
        let (place, block) = match header.blocks {
            BlockDescription::ScanLines => {
                let y = words.next().ok_or_else(cut)?;
                (Some(ChunkPlace::Rows { y }), scan_block(header, y).ok_or_else(bad)?)
            }
            BlockDescription::Tiles(_) => {
                let mut at = [0; 4];
                for v in &mut at {
                    *v = words.next().and_then(|v| usize::try_from(v).ok()).ok_or_else(cut)?;
                }
                let [x, y, level_x, level_y] = at;
                let full = level_x == 0 && level_y == 0;
                let block = if full { tile_block(header, x, y).ok_or_else(bad)? } else { 0 };
                (full.then_some(ChunkPlace::Tile { x, y }), block)
            }
        };
        let length = usize::try_from(words.next().ok_or_else(cut)?).map_err(|_| bad())?;
        let range = words.at..words.at.checked_add(length).ok_or_else(bad)?;
        let body = bytes.get(range.clone()).ok_or_else(cut)?;
        words.at = range.end;
        let Some(place) = place else { continue };
        if matches!(header.compression, Compression::DWAA(_) | Compression::DWAB(_))
            && !is_sane_dwa(header, body)
        {
            return Err(Error::decode(
                file,
                format!("chunk {} of {total} claims impossible DWA sizes", number + 1),
            ));
        }
        let first_time = seen.get_mut(part).and_then(|s| s.get_mut(block)).ok_or_else(bad)?;
        *first_time = true;
        chunks.push(Chunk { part, place, bytes: range });
    }
    if seen.iter().flatten().any(|&s| !s) {
        return Err(Error::decode(file, "blocks of the EXR are missing"));
    }
    Ok(chunks)
}

/// Blocks that make up the full resolution. Bounded by the chunk count the file has proved to have
/// room for.
fn full_blocks(header: &Header) -> usize {
    let size = header.layer_size;
    match header.blocks {
        BlockDescription::ScanLines => size.y().div_ceil(header.compression.scan_lines_per_block()),
        BlockDescription::Tiles(t) => {
            size.x().div_ceil(t.tile_size.x().max(1)) * size.y().div_ceil(t.tile_size.y().max(1))
        }
    }
}

fn scan_block(header: &Header, y: i32) -> Option<usize> {
    let row =
        usize::try_from(i64::from(y) - i64::from(header.own_attributes.layer_position.y())).ok()?;
    let rows = header.compression.scan_lines_per_block();
    (row < header.layer_size.y() && row % rows == 0).then_some(row / rows)
}

fn tile_block(header: &Header, x: usize, y: usize) -> Option<usize> {
    let BlockDescription::Tiles(tiles) = header.blocks else { return None };
    let across = header.layer_size.x().div_ceil(tiles.tile_size.x().max(1));
    let down = header.layer_size.y().div_ceil(tiles.tile_size.y().max(1));
    (x < across && y < down).then_some(y * across + x)
}

/// Whether a DWA chunk's counters are plausible: the decoder sizes its memory by them.
///
/// No section holds more than a few times the block's raw bytes, and the compressed sections fit
/// into the chunk.
fn is_sane_dwa(header: &Header, body: &[u8]) -> bool {
    let block = header.max_block_pixel_size();
    let raw = (block.x() as u64 * block.y() as u64)
        .saturating_mul(header.channels.bytes_per_pixel as u64);
    if body.is_empty() || body.len() as u64 == raw {
        return true;
    }
    let counter = |i: usize| {
        body.get(i * 8..)
            .and_then(|b| b.first_chunk::<8>())
            .map_or(u64::MAX, |b| u64::from_le_bytes(*b))
    };
    // Padding to 8 × 8 blocks can make a thin block's sections many times its raw bytes: 64 samples
    // at least a channel.
    let room =
        raw.saturating_mul(4).saturating_add(64 * 16 * header.channels.list.len() as u64 * 8)
            + (1 << 16);
    let inflated = [counter(1), counter(6), counter(7), counter(8), counter(9)];
    let stored = [counter(2), counter(3), counter(4), counter(5)];
    inflated.iter().all(|&v| v <= room) && stored.iter().all(|&v| v <= body.len() as u64)
}

/// Decodes chunks in parallel, a few at a time, and passes the blocks on in the order of the file.
pub fn decode(
    file: &Path,
    bytes: &[u8],
    meta: &MetaData,
    chunks: &[&Chunk],
    mut place: impl FnMut(&UncompressedBlock),
) -> Result<()> {
    // Enough to keep every thread busy, few enough to hold decoded.
    for batch in chunks.chunks(64) {
        let blocks: Vec<Result<UncompressedBlock>> = batch
            .par_iter()
            .map(|chunk| {
                let chunk = crate_chunk(chunk, bytes.get(chunk.bytes.clone()).unwrap_or_default());
                guard(file, "pixel data", || {
                    UncompressedBlock::decompress_chunk(chunk, meta, false)
                })
            })
            .collect();
        for block in blocks {
            place(&block?);
        }
    }
    Ok(())
}

fn crate_chunk(chunk: &Chunk, body: &[u8]) -> CrateChunk {
    let compressed_pixels_le = body.to_vec();
    let compressed_block = match chunk.place {
        ChunkPlace::Rows { y } => CompressedBlock::ScanLine(CompressedScanLineBlock {
            y_coordinate: y,
            compressed_pixels_le,
        }),
        ChunkPlace::Tile { x, y } => CompressedBlock::Tile(CompressedTileBlock {
            coordinates: TileCoordinates { tile_index: Vec2(x, y), level_index: Vec2(0, 0) },
            compressed_pixels_le,
        }),
    };
    CrateChunk { layer_index: chunk.part, compressed_block }
}
