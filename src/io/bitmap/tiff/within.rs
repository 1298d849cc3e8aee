//! JPEGs in the strips and tiles of a TIFF: whether decoding them is more work than the picture is
//! worth. Floor 5. Each is decoded whole, however small the part of the picture that it is for.

use crate::bitmap::passes::{most_visits, work};
use crate::{Budget, Error, Remedy, Result};
use std::collections::HashMap;
use std::io::Cursor;
use std::path::Path;
use tiff::decoder::Decoder;
use tiff::tags::Tag;

/// Pixels by which a JPEG may be longer than its strip or tile at each side: blocks are filled up.
const FILLED_PX: u64 = 64;

/// Refuses JPEGs that claim to be larger than their strips or tiles, whose decoder would allocate
/// that size first, and those that together have more pixels than a picture may. `file_bytes`:
/// length of the whole file.
pub fn check(
    file: &Path,
    decoder: &mut Decoder<Cursor<&[u8]>>,
    file_bytes: &[u8],
    budget: &Budget,
) -> Result<()> {
    let mut list =
        |tags: [Tag; 2]| tags.into_iter().find_map(|tag| decoder.get_tag_u64_vec(tag).ok());
    let starts = list([Tag::TileOffsets, Tag::StripOffsets]).unwrap_or_default();
    let lengths = list([Tag::TileByteCounts, Tag::StripByteCounts]).unwrap_or_default();
    let (width, height) = decoder.chunk_dimensions();
    let most_px = (u64::from(width) + FILLED_PX).saturating_mul(u64::from(height) + FILLED_PX);
    // Parts of a picture that look alike may share their bytes. Others that lie over each other are
    // read again and again.
    let (mut known, mut walked) = (HashMap::new(), 0u64);
    let mut visits = 0u64;
    for (&start, &length) in starts.iter().zip(&lengths) {
        let found = match known.get(&(start, length)) {
            Some(found) => *found,
            None => {
                let end = start.saturating_add(length).min(file_bytes.len() as u64);
                let part = file_bytes.get(start as usize..end as usize).unwrap_or_default();
                walked += part.len() as u64;
                if walked > 8 * file_bytes.len() as u64 {
                    return Err(Error::decode(file, "the parts of the TIFF overlap"));
                }
                let found = work(part);
                known.insert((start, length), found);
                found
            }
        };
        if found.frame_px > most_px {
            return Err(Error::too_large(
                file,
                "a JPEG within the TIFF claims more pixels than its part of the picture",
            ));
        }
        visits = visits.saturating_add(found.visits());
    }
    let most = most_visits(budget);
    if visits > most {
        let reason = format!("the JPEGs in the TIFF visit {visits} pixels; {most} are allowed");
        return Err(Error::too_large(file, reason).with_remedy(Remedy::MorePixels));
    }
    Ok(())
}
