//! Writes a zip: the same entries always give the same bytes.
//! Floor 5. Reading one is `archive`.

use std::io::{Cursor, Write};
use zip::result::ZipResult;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// Entries in the order they are added. Entries have no date, and the header of each has its size
/// and checksum, so that entries can be found without the table of contents.
pub struct ZipPacker {
    zip: ZipWriter<Cursor<Vec<u8>>>,
}

impl Default for ZipPacker {
    fn default() -> Self {
        Self { zip: ZipWriter::new(Cursor::default()) }
    }
}

impl ZipPacker {
    /// Adds bytes as they are: pictures are compressed already.
    pub fn store(&mut self, name: &str, bytes: &[u8]) -> ZipResult<()> {
        self.add(name, bytes, CompressionMethod::Stored)
    }

    /// Adds text.
    pub fn deflate(&mut self, name: &str, bytes: &[u8]) -> ZipResult<()> {
        self.add(name, bytes, CompressionMethod::Deflated)
    }

    pub fn finish(self) -> ZipResult<Vec<u8>> {
        Ok(self.zip.finish()?.into_inner())
    }

    fn add(&mut self, name: &str, bytes: &[u8], method: CompressionMethod) -> ZipResult<()> {
        let options = SimpleFileOptions::default()
            .compression_method(method)
            .last_modified_time(DateTime::default())
            .large_file(u32::try_from(bytes.len()).is_err());
        self.zip.start_file(name, options)?;
        self.zip.write_all(bytes)?;
        Ok(())
    }
}
