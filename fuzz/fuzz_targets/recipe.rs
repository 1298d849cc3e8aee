//! Any text as a recipe that may name no file: read or refused.
#![no_main]
use libfuzzer_sys::fuzz_target;
use rilievo::io::recipe::{self, Source};
use rilievo::io::{Budget, Given};
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    let budget = Budget { area_px: 1 << 20, file_bytes: 0, ..Budget::default() };
    let _ = recipe::read(bytes, Source { file: Path::new("a"), files: &Given::default(), budget: &budget, onto: None });
});
