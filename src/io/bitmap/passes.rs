//! How many passes a JPEG makes over its picture, counted before it is decoded: progressive ones
//! may do so any number of times in a few bytes each. Floor 5. Not here: JPEGs in the strips of a
//! TIFF (`tiff/within`), which are counted one by one.

use crate::Budget;
use crate::math::Size;
use crate::{Error, Remedy, Result};
use std::path::Path;

/// Passes over the largest picture that is read. Programs write some ten.
const MOST: u64 = 32;

/// What the headers of a JPEG declare.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct JpegWork {
    /// Pixels of the largest frame.
    pub frame_px: u64,
    /// Passes over it: scans.
    pub passes: u64,
}

impl JpegWork {
    /// Pixels that decoding visits, those of each pass counted again; a small frame still takes a
    /// header's time.
    pub fn visits(self) -> u64 {
        self.frame_px.max(64).saturating_mul(self.passes)
    }
}

/// Pixels that decoding one file may visit.
pub fn most_visits(budget: &Budget) -> u64 {
    budget.area_px.saturating_mul(MOST)
}

/// Refuses a JPEG of more passes than a picture of its size may have.
pub fn check(file: &Path, bytes: &[u8], size: Size, budget: &Budget) -> Result<()> {
    let most = most_visits(budget) / size.area().max(64) as u64;
    let passes = work(bytes).passes;
    if passes > most {
        let reason =
            format!("the JPEG has {passes} passes over its {size} pixels; {most} are allowed");
        return Err(Error::too_large(file, reason).with_remedy(Remedy::MorePixels));
    }
    Ok(())
}

/// Walks from marker to marker; what follows a damaged one does not count.
pub fn work(bytes: &[u8]) -> JpegWork {
    let mut work = JpegWork::default();
    let mut at = 0;
    while let Some(marker) = next_marker(bytes, at) {
        let kind = bytes[marker + 1];
        at = marker + 2;
        match kind {
            // A frame: its length, bits, height, width. Not tables (c4, cc) and what is reserved
            // (c8).
            0xc0..=0xcf if !matches!(kind, 0xc4 | 0xc8 | 0xcc) => {
                let side = |i: usize| {
                    bytes
                        .get(at + i..at + i + 2)
                        .map_or(0, |b| u64::from(b[0]) << 8 | u64::from(b[1]))
                };
                work.frame_px = work.frame_px.max(side(3) * side(5));
            }
            0xda => work.passes += 1,
            _ => {}
        }
        // Markers without a length: starts, ends, restarts.
        if !matches!(kind, 0x01 | 0xd0..=0xd9) {
            let length =
                bytes.get(at..at + 2).map_or(2, |b| usize::from(b[0]) << 8 | usize::from(b[1]));
            at += length.max(2);
        }
    }
    work
}

/// Where the next marker begins; within coded data ff followed by 0 or by another ff is not one.
fn next_marker(bytes: &[u8], from: usize) -> Option<usize> {
    let rest = bytes.get(from..)?;
    let found = rest.windows(2).position(|pair| pair[0] == 0xff && !matches!(pair[1], 0 | 0xff))?;
    Some(from + found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{ImageFormat, RgbImage};
    use std::io::Cursor;

    fn jpeg(side: u32) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        RgbImage::new(side, side).write_to(&mut bytes, ImageFormat::Jpeg).unwrap();
        bytes.into_inner()
    }

    /// With its only scan so often.
    fn repeated(bytes: &[u8], times: usize) -> Vec<u8> {
        let scan = bytes.windows(2).position(|pair| pair == [0xff, 0xda]).unwrap();
        let (head, scan) = (&bytes[..scan], &bytes[scan..bytes.len() - 2]);
        [head, &scan.repeat(times), &[0xff, 0xd9]].concat()
    }

    #[test]
    fn passes_are_counted_and_the_frame_is_measured() {
        let plain = jpeg(24);
        assert_eq!(work(&plain), JpegWork { frame_px: 576, passes: 1 });
        assert_eq!(work(&repeated(&plain, 70)), JpegWork { frame_px: 576, passes: 70 });
        assert_eq!(work(&plain[..9]), JpegWork::default());
    }

    #[test]
    fn a_jpeg_that_goes_over_its_picture_without_end_is_refused_by_its_headers() {
        let budget = Budget { area_px: 64 * 64, ..Budget::default() };
        let read = |bytes: &[u8]| {
            crate::bitmap::decode(Path::new("a.jpg"), bytes, &budget).map(|b| b.format)
        };
        assert_eq!(read(&jpeg(64)).unwrap(), "JPEG");
        let said = read(&repeated(&jpeg(64), 33)).unwrap_err();
        let expected =
            "a.jpg: too large: the JPEG has 33 passes over its 64 × 64 pixels; 32 are allowed";
        assert_eq!(said.to_string(), expected);
        assert_eq!(said.remedy(), Some(Remedy::MorePixels));
    }
}
