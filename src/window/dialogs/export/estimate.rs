//! How many bytes a picture will take, found by encoding it on another thread. Floor 7. A change of
//! the settings cancels what is under way.

use crate::document::{Document, Progress};
use crate::io::Budget;
use crate::io::export::high_depth::encode_document;
use crate::jobs;
use crate::language::tr_amount;
use crate::session::{ExportSettings, is_same};
use crate::tr;
use eframe::egui::Context;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// What is being found, or was found last.
#[derive(Default)]
pub struct SizeEstimate {
    asked: Option<Arc<Asked>>,
}

/// A question, and its answer once it is known.
struct Asked {
    document: Document,
    extension: &'static str,
    settings: ExportSettings,
    progress: Progress,
    /// Bytes, or why there are none.
    found: Mutex<Option<Result<usize, String>>>,
}

impl SizeEstimate {
    /// The bytes of the picture as the settings say, or why it cannot be written; `None` while that
    /// is computed.
    pub fn bytes(
        &mut self,
        ctx: &Context,
        document: &Document,
        extension: &'static str,
        settings: ExportSettings,
    ) -> Option<Result<usize, String>> {
        let is_asked = self.asked.as_ref().is_some_and(|asked| {
            asked.extension == extension
                && asked.settings == settings
                && is_same(&asked.document, document)
        });
        // Not for every value that a slider passes.
        if !is_asked && !ctx.input(|input| input.pointer.any_down()) {
            self.cancel();
            self.asked = ask(ctx, document, extension, settings);
        }
        let asked = self.asked.as_ref().filter(|_| is_asked)?;
        asked.found.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn cancel(&mut self) {
        if let Some(asked) = self.asked.take() {
            asked.progress.cancel();
        }
    }
}

impl Drop for SizeEstimate {
    fn drop(&mut self) {
        self.cancel();
    }
}

fn ask(
    ctx: &Context,
    document: &Document,
    extension: &'static str,
    settings: ExportSettings,
) -> Option<Arc<Asked>> {
    let asked = Arc::new(Asked {
        document: document.clone(),
        extension,
        settings,
        progress: Progress::default(),
        found: Mutex::default(),
    });
    let (work, waker) = (asked.clone(), ctx.clone());
    let encode = move || {
        let found = work.encode();
        *work.found.lock().unwrap_or_else(PoisonError::into_inner) = found;
        waker.request_repaint();
    };
    jobs::spawn("size of the export", encode).ok().map(|()| asked)
}

impl Asked {
    /// `None` if canceled.
    fn encode(&self) -> Option<Result<usize, String>> {
        let (file, budget) = (format!("picture.{}", self.extension), Budget::of_this_machine());
        let file = Path::new(&file);
        let prepared = self.settings.prepare(&self.document, file, &budget);
        let encoded = prepared.and_then(|(document, options)| {
            encode_document(file, &document, &options, &budget, &self.progress)
        });
        encoded.map(|bytes| bytes.map(|bytes| bytes.len())).map_err(|e| e.to_string()).transpose()
    }
}

/// Bytes as people read them.
pub fn size_text(bytes: usize) -> String {
    let amount = match bytes as f64 {
        b if b < 1e3 => return tr!("{count} bytes", count = format!("{b:.0}")),
        b if b < 1e5 => format!("{:.1} kB", b / 1e3),
        b if b < 1e6 => format!("{:.0} kB", b / 1e3),
        b => format!("{:.1} MB", b / 1e6),
    };
    tr_amount(&amount).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_told_in_the_unit_that_suits_them() {
        assert_eq!(size_text(999), "999 bytes");
        assert_eq!(size_text(12_345), "12.3 kB");
        assert_eq!(size_text(456_789), "457 kB");
        assert_eq!(size_text(7_654_321), "7.7 MB");
    }
}
