//! What Windows says about memory. Floor 5. A job's limit around the process is not asked for.

use std::ffi::c_void;
use std::mem::size_of;

/// `MEMORYSTATUSEX`.
#[repr(C)]
#[derive(Default)]
struct MemoryStatus {
    length: u32,
    load: u32,
    total: u64,
    available: u64,
    commit_limit: u64,
    commit_available: u64,
    addresses: u64,
    addresses_available: u64,
    extended: u64,
}

/// `PROCESS_MEMORY_COUNTERS`.
#[repr(C)]
#[derive(Default)]
struct ProcessCounters {
    length: u32,
    page_faults: u32,
    peak_working_set: usize,
    working_set: usize,
    pools: [usize; 4],
    commit: usize,
    peak_commit: usize,
}

#[link(name = "kernel32")]
unsafe extern "system" {
    fn GlobalMemoryStatusEx(status: *mut MemoryStatus) -> i32;
    fn GetCurrentProcess() -> *mut c_void;
    fn K32GetProcessMemoryInfo(
        process: *mut c_void,
        counters: *mut ProcessCounters,
        length: u32,
    ) -> i32;
}

fn status() -> Option<MemoryStatus> {
    let mut status =
        MemoryStatus { length: size_of::<MemoryStatus>() as u32, ..MemoryStatus::default() };
    // SAFETY: the structure is that of the system's header, and its first field says its length.
    let is_filled = unsafe { GlobalMemoryStatusEx(&raw mut status) } != 0;
    is_filled.then_some(status)
}

/// The least of free memory, of what the system still promises to programs (memory and page files),
/// and of the process's addresses.
pub fn available_bytes() -> Option<u64> {
    let MemoryStatus { available, commit_available, addresses_available, .. } = status()?;
    Some(available.min(commit_available).min(addresses_available))
}

/// The machine's memory.
pub fn whole_bytes() -> Option<u64> {
    Some(status()?.total)
}

/// The process's working set.
pub fn resident_bytes() -> Option<u64> {
    let length = size_of::<ProcessCounters>() as u32;
    let mut counters = ProcessCounters { length, ..ProcessCounters::default() };
    // SAFETY: the structure is that of the system's header and as long as the call says; the handle
    // of the own process is always valid.
    let is_filled =
        unsafe { K32GetProcessMemoryInfo(GetCurrentProcess(), &raw mut counters, length) } != 0;
    is_filled.then_some(counters.working_set as u64)
}
