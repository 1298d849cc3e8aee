//! The budget of every reader: no allocation is sized by a file's own numbers without a check against it.
//! Floor 5.

use crate::{Error, Result, math::Size};
use std::path::Path;

/// Limits for what one file may request. The command line raises them with `--max-pixels` and `--max-side`.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// Longest side of a picture, px.
    pub side_px: u32,
    /// Pixels of a picture.
    pub area_px: u64,
    /// Pixels of all pictures of one document together.
    pub document_px: u64,
    /// Bytes of any one file.
    pub file_bytes: u64,
    /// Bytes read from all entries of a zip together.
    pub unpacked_bytes: u64,
    /// Entries of a zip.
    pub entries: usize,
    /// Bytes of a JSON text.
    pub json_bytes: u64,
    /// Values of a JSON text, an object counting as eight; each takes some eighty bytes once parsed.
    pub json_values: usize,
    /// Nesting of a JSON text.
    pub json_depth: usize,
    pub layers: usize,
    pub group_depth: usize,
    /// Anchors a layer.
    pub anchors: usize,
    /// Samples a stroke.
    pub samples: usize,
}

impl Default for Budget {
    fn default() -> Self {
        Self {
            side_px: 32_768,
            area_px: 268_435_456,
            document_px: 1 << 30,
            file_bytes: 2 << 30,
            unpacked_bytes: 8 << 30,
            entries: 4_096,
            json_bytes: 16 << 20,
            json_values: 4_000_000,
            // 32 groups take two levels each; the content of the innermost takes the rest.
            json_depth: 80,
            layers: 2_000,
            group_depth: 32,
            anchors: 10_000,
            samples: 1_000_000,
        }
    }
}

impl Budget {
    /// The size, or an error that names the limit it exceeds. A side of 0 is not a picture.
    pub fn size(&self, file: &Path, width: u64, height: u64) -> Result<Size> {
        if width == 0 || height == 0 {
            return Err(Error::decode(file, format!("a picture of {width} × {height} pixels has no pixels")));
        }
        if width.max(height) > u64::from(self.side_px) {
            let reason =
                format!("{width} × {height} pixels; a side may have {} (raise it with --max-side)", self.side_px);
            return Err(Error::too_large(file, reason));
        }
        if width * height > self.area_px {
            let reason =
                format!("{width} × {height} pixels; a picture may have {} (raise it with --max-pixels)", self.area_px);
            return Err(Error::too_large(file, reason));
        }
        Ok(Size::new(width as u32, height as u32))
    }
}
