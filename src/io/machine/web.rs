//! What WebAssembly says about memory: it grows to a limit that the program was linked with, and never
//! shrinks. Floor 5.

/// The limit, as `dist/web/build` sets it.
const MOST_BYTES: u64 = 4 << 30;
/// Bytes of one step of growth.
const PAGE_BYTES: u64 = 1 << 16;

/// What it may still grow by. What was freed within it is not known.
pub fn available_bytes() -> Option<u64> {
    Some(MOST_BYTES - resident_bytes()?.min(MOST_BYTES))
}

/// What it has grown to.
pub fn resident_bytes() -> Option<u64> {
    Some(core::arch::wasm32::memory_size::<0>() as u64 * PAGE_BYTES)
}

/// The limit.
pub fn whole_bytes() -> Option<u64> {
    Some(MOST_BYTES)
}
