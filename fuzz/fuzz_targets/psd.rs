//! Any bytes to one reader: read or refused, within the budget. The reader is the one that
//! `tests/mutated.rs` runs.
#![no_main]
use libfuzzer_sys::fuzz_target;
use std::path::Path;

#[allow(dead_code)]
#[path = "../../tests/readers/mod.rs"]
mod readers;

fuzz_target!(|bytes: &[u8]| {
    let _ = readers::psd(Path::new("a"), bytes);
});
