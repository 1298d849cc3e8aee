//! What memory may be used for: buffers that ask before they are made, and the limit of what is
//! kept for speed alone. Floor 0. Not here: how much the machine has, which floors above read and
//! pass in.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

/// The allocator has no room for a buffer of so many bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no memory for {} more", bytes_text(*.bytes))]
pub struct OutOfMemory {
    /// The bytes that could not be had.
    pub bytes: u64,
}

/// `len` copies of a value, or a refusal where the allocator has no room for them: `vec!` would end
/// the program.
///
/// The room is asked for and given back before the buffer is made, since a buffer of zeros comes
/// from the system untouched, which one that is filled by hand does not.
pub fn fill<T: Clone>(len: usize, value: T) -> Result<Vec<T>, OutOfMemory> {
    let mut probe: Vec<T> = Vec::new();
    let bytes = (len as u64).saturating_mul(size_of::<T>() as u64);
    probe.try_reserve_exact(len).map_err(|_| OutOfMemory { bytes })?;
    drop(probe);
    Ok(vec![value; len])
}

/// As [`fill`] for those who cannot fail: unwinds with an [`OutOfMemory`], which [`catch_out_of_memory`] makes
/// a refusal of.
pub fn fill_or_unwind<T: Clone>(len: usize, value: T) -> Vec<T> {
    fill(len, value).unwrap_or_else(|refused| std::panic::panic_any(refused))
}

/// A copy of values, for those who cannot fail: unwinds as [`fill_or_unwind`] does.
pub fn copy_or_unwind<T: Clone>(values: &[T]) -> Vec<T> {
    let mut copy = Vec::new();
    if copy.try_reserve_exact(values.len()).is_err() {
        std::panic::panic_any(OutOfMemory { bytes: size_of_val(values) as u64 });
    }
    copy.extend_from_slice(values);
    copy
}

/// Does work of which some buffer may find no room.
pub fn catch_out_of_memory<T>(work: impl FnOnce() -> T) -> Result<T, OutOfMemory> {
    // What the work made is dropped with it; nothing half done is seen again.
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(work)).map_err(|payload| {
        match payload.downcast() {
            Ok(refused) => *refused,
            Err(other) => std::panic::resume_unwind(other),
        }
    })
}

/// Bytes as people read them: “312 MB”, “1.4 GB”.
pub fn bytes_text(bytes: u64) -> String {
    let mb = bytes as f64 / 1e6;
    if mb < 1000.0 { format!("{mb:.0} MB") } else { format!("{:.1} GB", mb / 1000.0) }
}

/// Asks how many bytes are free; all are until a floor above says how to ask.
static FREE: OnceLock<fn() -> u64> = OnceLock::new();

/// Says how to ask how many bytes are free for what is made next. Who says it first is asked.
pub fn ask_for_free_bytes(ask: fn() -> u64) {
    FREE.get_or_init(|| ask);
}

/// Bytes that are free for what is made next.
pub fn free_bytes() -> u64 {
    FREE.get().map_or(u64::MAX, |ask| ask())
}

/// Checks memory before it is allocated; fails with a sentence without its full stop. `what`: in
/// front of “takes”; `free`: how many bytes there are.
pub fn room_for(what: &str, bytes: u64, free: u64) -> Result<(), String> {
    if bytes <= free {
        return Ok(());
    }
    let (asked, there) = (bytes_text(bytes), bytes_text(free));
    Err(format!("{what} takes {asked} of memory, and {there} are free for it"))
}

/// Bytes that may be kept for speed alone, what could be computed again, and those that are.
#[derive(Debug)]
pub struct CachePool {
    limit: AtomicU64,
    kept: AtomicU64,
}

/// For the dabs of strokes.
pub static DABS: CachePool = CachePool::new(64 << 20);
/// For the forms of parts.
pub static FORMS: CachePool = CachePool::new(1 << 30);

impl CachePool {
    const fn new(limit: u64) -> Self {
        Self { limit: AtomicU64::new(limit), kept: AtomicU64::new(0) }
    }

    /// Sets how much may be kept. What is kept already stays.
    pub fn set_limit(&self, bytes: u64) {
        self.limit.store(bytes, Ordering::Relaxed);
    }

    /// How much may be kept.
    pub fn limit(&self) -> u64 {
        self.limit.load(Ordering::Relaxed)
    }

    /// How much more may be kept.
    pub fn room(&self) -> u64 {
        self.limit().saturating_sub(self.kept.load(Ordering::Relaxed))
    }

    /// `None` where all that is kept would be more than the limit.
    pub fn reserve(&'static self, bytes: u64) -> Option<CacheReservation> {
        let limit = self.limit();
        let more = |kept: u64| kept.checked_add(bytes).filter(|sum| *sum <= limit);
        let kept = self.kept.fetch_update(Ordering::Relaxed, Ordering::Relaxed, more);
        kept.ok().map(|_| CacheReservation { pool: self, bytes })
    }
}

/// Leave to keep something that could be computed again, for as long as this lives.
#[derive(Debug)]
pub struct CacheReservation {
    pool: &'static CachePool,
    bytes: u64,
}

impl Drop for CacheReservation {
    fn drop(&mut self) {
        self.pool.kept.fetch_sub(self.bytes, Ordering::Relaxed);
    }
}

/// The value of a cell, or a new one. Nothing is held while it is made: a worker that waits for
/// others there may be given work that needs the same cell, and would then wait for itself. So two
/// threads may both make it; the results are equal.
pub fn once<T>(cell: &OnceLock<T>, make: impl FnOnce() -> T) -> &T {
    if let Some(known) = cell.get() {
        return known;
    }
    let made = make();
    cell.get_or_init(|| made)
}

/// A value that can be made again: made when it is first read, and kept until it is dropped.
#[derive(Debug)]
pub struct RemadeCell<T>(Mutex<Option<T>>);

impl<T> Default for RemadeCell<T> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<T: Clone> RemadeCell<T> {
    /// The value. Others who want it wait while it is made, so `make` may divide nothing among
    /// threads: a worker that waited for others there could be given work that needs this cell.
    pub fn get_or_make(&self, make: impl FnOnce() -> T) -> T {
        self.lock().get_or_insert_with(make).clone()
    }

    /// The value, if there is one now.
    pub fn get(&self) -> Option<T> {
        self.lock().clone()
    }

    /// Drops the value. What others hold stays in memory until they drop it, too.
    pub fn clear(&self) {
        let before = self.lock().take();
        // After the lock.
        drop(before);
    }

    fn lock(&self) -> MutexGuard<'_, Option<T>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The value of a key that was made before, or a new one.
///
/// * `made`: the last values and their keys; `most`: how many are kept.
pub fn compute_once<K: PartialEq, V>(
    made: &Mutex<Vec<(K, Arc<V>)>>,
    most: usize,
    key: K,
    make: impl FnOnce() -> V,
) -> Arc<V> {
    let lock = || made.lock().unwrap_or_else(PoisonError::into_inner);
    let find = |made: &[(K, Arc<V>)]| {
        made.iter().find(|(known, _)| *known == key).map(|(_, value)| value.clone())
    };
    if let Some(value) = find(&lock()) {
        return value;
    }
    // Without the lock: two threads may both compute it; the results are equal.
    let value = Arc::new(make());
    let mut made = lock();
    if let Some(value) = find(&made) {
        return value;
    }
    if made.len() >= most {
        made.remove(0);
    }
    made.push((key, value.clone()));
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_buffer_without_room_is_a_refusal_and_no_abort() {
        let refused = fill(usize::MAX / 16, [0u64; 2]).unwrap_err();
        assert!(refused.to_string().starts_with("there is no memory for "), "{refused}");
        assert_eq!(
            catch_out_of_memory(|| fill_or_unwind(usize::MAX / 16, [0u64; 2]).len()),
            Err(refused)
        );
        assert_eq!(fill(3, 7u8), Ok(vec![7; 3]));
    }

    #[test]
    fn a_value_is_made_once_and_again_after_it_was_dropped() {
        let (cell, made) = (RemadeCell::default(), AtomicU64::new(0));
        let make = || made.fetch_add(1, Ordering::Relaxed) + 1;
        assert_eq!((cell.get(), cell.get_or_make(make), cell.get_or_make(make)), (None, 1, 1));
        cell.clear();
        assert_eq!((cell.get(), cell.get_or_make(make), cell.get()), (None, 2, Some(2)));
    }

    #[test]
    fn other_panics_are_passed_on() {
        let passed = std::panic::catch_unwind(|| catch_out_of_memory(|| panic!("another")));
        assert_eq!(passed.unwrap_err().downcast_ref(), Some(&"another"));
    }

    #[test]
    fn what_is_kept_stays_below_the_limit_and_is_given_back() {
        assert!(DABS.reserve(u64::MAX).is_none());
        let kept = DABS.reserve(1000);
        assert!(kept.is_some() && DABS.kept.load(Ordering::Relaxed) >= 1000);
        assert!(DABS.reserve((64 << 20) - 999).is_none());
        drop(kept);
        assert!(DABS.reserve(1000).is_some());
    }

    #[test]
    fn bytes_are_written_in_the_unit_they_fill() {
        assert_eq!(
            [312_000_000, 900_000_000, 1_440_000_000].map(bytes_text),
            ["312 MB", "900 MB", "1.4 GB"]
        );
    }
}
