//! Any bytes as a picture: decoded or refused, within the budget.
#![no_main]
use libfuzzer_sys::fuzz_target;
use rilievo::io::{Budget, picture};
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    let budget = Budget { area_px: 1 << 20, side_px: 4096, ..Budget::default() };
    let _ = picture::decode(Path::new("a"), bytes, &budget);
    let _ = picture::decode_coverage(Path::new("a"), bytes, &budget);
});
