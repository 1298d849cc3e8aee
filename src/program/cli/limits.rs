//! Options for limits and threads, common to all subcommands.
//! Floor 7.

use crate::document::{Document, MemoryUse};
use crate::io::Budget;
use crate::io::machine::{self, free_bytes};
use crate::{Error, Result};
use std::path::Path;

/// How much memory the program may take.
#[derive(clap::Args, Default)]
pub struct MemoryLimit {
    /// Maximum memory for reading and painting, such as 800M or 6G; by default, the free memory
    #[arg(long, value_name = "SIZE", value_parser = bytes)]
    max_memory: Option<u64>,
}

impl MemoryLimit {
    /// From now on, for whatever is opened and done.
    pub fn set(&self) {
        self.max_memory.into_iter().for_each(machine::set_limit);
    }
}

/// How much a command may use.
#[derive(clap::Args)]
pub struct LimitArgs {
    /// Maximum side of a picture, in pixels
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    max_side: Option<u32>,
    /// Maximum number of pixels of a picture
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100_000_000_000))]
    max_pixels: Option<u64>,
    #[command(flatten)]
    memory: MemoryLimit,
    /// Number of threads; the result does not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

/// A number of bytes; a suffix K, M or G means thousands, millions or billions.
fn bytes(text: &str) -> std::result::Result<u64, String> {
    let short = text.trim_end_matches(['b', 'B']);
    let units = [("k", 1e3), ("K", 1e3), ("m", 1e6), ("M", 1e6), ("g", 1e9), ("G", 1e9)];
    let found = units.into_iter().find_map(|(name, unit)| Some((short.strip_suffix(name)?, unit)));
    let (digits, unit) = found.unwrap_or((short, 1.0));
    let number = digits.trim().parse::<f64>().ok().filter(|n| (0.0..1e18).contains(n));
    number
        .map(|n| (n * unit) as u64)
        .ok_or_else(|| "a size is a number such as 800M or 6G".to_owned())
}

impl LimitArgs {
    /// The budget for readers.
    pub fn budget(&self) -> Budget {
        let usual = Budget::default().within(self.memory.max_memory.unwrap_or_else(free_bytes));
        let area_px = self.max_pixels.unwrap_or(usual.area_px);
        Budget {
            side_px: self.max_side.unwrap_or(usual.side_px),
            area_px,
            document_px: usual.document_px.max(area_px.saturating_mul(4)),
            ..usual
        }
    }

    /// Checks, before painting a document, that its memory is available.
    pub fn room_to_paint(&self, file: &Path, document: &Document) -> Result<()> {
        let what = format!("painting {} pixels", document.size);
        let painting = document.flattening_bytes();
        // What is free was asked for after the document was read; a given limit is for both.
        let held = self.memory.max_memory.map_or(0, |_| MemoryUse::of(document).total());
        self.budget().room(file, &what, painting.saturating_add(held))
    }

    /// Does the work with the requested number of threads.
    pub fn install<T: Send>(&self, work: impl FnOnce() -> Result<T> + Send) -> Result<T> {
        let Some(threads) = self.threads else { return work() };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build();
        pool.map_err(|e| Error::io("--threads", std::io::Error::other(e)))?.install(work)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, Vec3};
    use crate::raster::Plane;
    use crate::surface::{Maps, Surface};
    use std::sync::Arc;

    #[test]
    fn a_given_limit_is_for_the_document_and_for_painting_it() {
        let size = Size::new(512, 512);
        let depth = Plane::full(size, 0.0);
        let (normals, coverage) = (Plane::full(size, Vec3::Z), Plane::full(size, 255));
        let surface = Surface::new(Maps { normals, depth, coverage }).unwrap();
        let document = Document { surface: Some(Arc::new(surface)), ..Document::empty(size) };
        let (held, painting) = (MemoryUse::of(&document).total(), document.flattening_bytes());
        assert!(held > 512 * 512 * 16, "the maps of the surface: {held}");
        let is_room = |bytes: u64| {
            let limits = LimitArgs { memory: MemoryLimit { max_memory: Some(bytes) }, ..limits() };
            limits.room_to_paint(Path::new("a"), &document).is_ok()
        };
        assert!(is_room(2 * (held + painting)) && !is_room(painting + held / 2));
    }

    /// None given.
    fn limits() -> LimitArgs {
        LimitArgs {
            max_side: None,
            max_pixels: None,
            memory: MemoryLimit::default(),
            threads: None,
        }
    }

    #[test]
    fn sizes_are_read_with_their_units() {
        let read = ["1000", "800M", "1.5 GB", "2k"].map(bytes);
        assert_eq!(read, [Ok(1000), Ok(800_000_000), Ok(1_500_000_000), Ok(2000)]);
        assert!(["", "M", "-3G", "lots", "nan"].map(bytes).iter().all(Result::is_err));
    }
}
