//! A file that was dropped onto the page, and put among its files. Floor 8.

use eframe::egui::DroppedFile;
use rilievo_io::platform::files;
use std::future::{Future, ready};
use std::path::{Path, PathBuf};
use std::pin::Pin;

/// One of the page's files.
#[derive(Debug)]
pub struct DroppedDocument(pub PathBuf);

impl DroppedFile for DroppedDocument {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes_async(&self) -> Pin<Box<dyn Future<Output = Result<Vec<u8>, String>> + '_>> {
        Box::pin(ready(files::read(&self.0).map_err(|error| error.to_string())))
    }
}
