//! Any bytes as a file of this kind: read or refused, within the budget.
#![no_main]
use libfuzzer_sys::fuzz_target;
use rilievo::io::{Budget, psd};
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    let budget = Budget { area_px: 1 << 20, document_px: 1 << 22, side_px: 4096, ..Budget::default() };
    let _ = psd::read(Path::new("a"), bytes, &budget);
});
