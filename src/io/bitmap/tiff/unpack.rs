//! Compressions of TIFF that the `tiff` crate lacks: ZSTD, group 3 fax, and fax with reversed bit
//! order. Floor 5. Pieces are unpacked here, and the file is read with these instead of its own.

use super::directory::Directory;
use crate::{Budget, Error, Result};
use std::io::{Cursor, Read};
use std::path::Path;
use tiff::decoder::Decoder;
use tiff::tags::Tag;

const COMPRESSION: u16 = 259;
const FILL_ORDER: u16 = 266;
/// Where pieces begin, and how long they are.
const TILES: [Tag; 2] = [Tag::TileOffsets, Tag::TileByteCounts];
const STRIPS: [Tag; 2] = [Tag::StripOffsets, Tag::StripByteCounts];
const PLAIN: u16 = 1;
const FAX3: u16 = 3;
const FAX4: u16 = 4;
const ZSTD: u16 = 50_000;
/// The number that ZSTD had before it was given one.
const OLD_ZSTD: u16 = 34_926;

/// The same picture in a way that the crate reads; `None` where it does so already.
pub fn readable(
    file: &Path,
    bytes: &[u8],
    decoder: &mut Decoder<Cursor<&[u8]>>,
    budget: &Budget,
) -> Result<Option<Vec<u8>>> {
    let mut short = |tag| decoder.find_tag_unsigned::<u16>(tag).ok().flatten();
    let (compression, reversed) =
        (short(Tag::Compression).unwrap_or(PLAIN), short(Tag::FillOrder) == Some(2));
    let options = short(Tag::Unknown(292)).unwrap_or(0);
    let becomes = match compression {
        ZSTD | OLD_ZSTD => PLAIN,
        FAX3 if options & 1 == 1 => {
            return Err(Error::unsupported_file(
                file,
                "two-dimensional group 3 fax in a TIFF; save it as group 4 or LZW",
            ));
        }
        FAX3 => PLAIN,
        FAX4 if reversed => FAX4,
        _ => return Ok(None),
    };
    let directory =
        Directory::first(bytes).ok_or_else(|| Error::decode(file, "the TIFF is cut short"))?;
    let in_tiles = directory.place(bytes, Tag::TileOffsets.to_u16()).is_some();
    let tags = if in_tiles { TILES } else { STRIPS };
    let mut list = |tag| decoder.get_tag_u64_vec(tag);
    let failed = |_| Error::decode(file, "the TIFF does not say where its pieces are");
    let (starts, lengths) = (list(tags[0]).map_err(failed)?, list(tags[1]).map_err(failed)?);
    let piece = Piece::of(decoder);
    budget.room(
        file,
        "the unpacked TIFF",
        (piece.bytes() as u64).saturating_mul(starts.len() as u64 + 1),
    )?;
    let mut pieces = Vec::new();
    for (&start, &length) in starts.iter().zip(&lengths) {
        let end = start.saturating_add(length).min(bytes.len() as u64);
        let mut packed = bytes.get(start as usize..end as usize).unwrap_or_default().to_vec();
        if reversed {
            packed.iter_mut().for_each(|byte| *byte = byte.reverse_bits());
        }
        pieces.push(match compression {
            FAX4 => packed,
            FAX3 => piece.fax(packed),
            _ => piece
                .zstd(&packed)
                .map_err(|e| Error::decode(file, format!("its ZSTD data is damaged ({e})")))?,
        });
    }
    let new = [(COMPRESSION, Some(becomes)), (FILL_ORDER, None)];
    Ok(Some(directory.with_pieces(bytes, &pieces, tags.map(|tag| tag.to_u16()), &new)))
}

/// A strip or tile, unpacked.
struct Piece {
    width: u32,
    rows: u32,
    row_bytes: usize,
}

impl Piece {
    fn of(decoder: &mut Decoder<Cursor<&[u8]>>) -> Self {
        let (width, rows) = decoder.chunk_dimensions();
        let planes =
            decoder.find_tag_unsigned::<u16>(Tag::PlanarConfiguration).ok().flatten() == Some(2);
        let color = decoder.colortype().ok();
        let samples = color.filter(|_| !planes).map_or(1, super::samples);
        let bits = color.map_or(1, |color| usize::from(color.bit_depth()));
        let row_bytes = (width as usize).saturating_mul(samples * bits).div_ceil(8);
        Self { width, rows, row_bytes }
    }

    fn bytes(&self) -> usize {
        self.row_bytes.saturating_mul(self.rows as usize)
    }

    /// At most what it can hold.
    fn zstd(&self, packed: &[u8]) -> std::io::Result<Vec<u8>> {
        let decoder =
            ruzstd::decoding::StreamingDecoder::new(packed).map_err(std::io::Error::other)?;
        let mut out = Vec::new();
        decoder.take(self.bytes() as u64).read_to_end(&mut out)?;
        Ok(out)
    }

    /// Rows of bits, black being 1. A damaged row ends the piece; the rest is white.
    fn fax(&self, packed: Vec<u8>) -> Vec<u8> {
        let mut out = Vec::new();
        let Ok(width) = u16::try_from(self.width) else { return out };
        // A row ends where the next begins: with a mark, which some files leave out before the
        // first and after the last.
        let begins = packed.starts_with(&[0]);
        let first: &[u8] = if begins { &[] } else { &[0, 1] };
        let bits = first.iter().copied().chain(packed).chain([0, 1, 0, 1]);
        let Ok(mut decoder) =
            fax::decoder::Group3Decoder::new(bits.map(Ok::<u8, std::convert::Infallible>))
        else {
            return vec![0; self.bytes()];
        };
        while out.len() < self.bytes() && decoder.advance().is_ok() {
            let mut row = vec![0u8; self.row_bytes];
            for (x, pel) in fax::decoder::pels(decoder.transitions(), width).enumerate() {
                row[x / 8] |= u8::from(pel == fax::Color::Black) << (7 - x % 8);
            }
            out.extend(row);
        }
        out.resize(self.bytes(), 0);
        out
    }
}
