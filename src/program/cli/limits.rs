//! Options for limits and threads, common to all subcommands.
//! Floor 7.

use crate::io::Budget;
use crate::{Error, Result};

/// How much a command may use.
#[derive(clap::Args)]
pub struct LimitArgs {
    /// Longest side of any picture, in pixels
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    max_side: Option<u32>,
    /// Pixels of any picture
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100_000_000_000))]
    max_pixels: Option<u64>,
    /// Threads to work with; the result is the same with any number
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

impl LimitArgs {
    /// The budget for readers.
    pub fn budget(&self) -> Budget {
        let usual = Budget::default();
        let area_px = self.max_pixels.unwrap_or(usual.area_px);
        Budget {
            side_px: self.max_side.unwrap_or(usual.side_px),
            area_px,
            document_px: usual.document_px.max(area_px.saturating_mul(4)),
            ..usual
        }
    }
    /// Does the work with the requested number of threads.
    pub fn install<T: Send>(&self, work: impl FnOnce() -> Result<T> + Send) -> Result<T> {
        let Some(threads) = self.threads else { return work() };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build();
        pool.map_err(|e| Error::io("--threads", std::io::Error::other(e)))?.install(work)
    }
}
