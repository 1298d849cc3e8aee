//! Caches of what is computed from a surface, and the memory that they hold.
//! Floor 2. Not here: which caches a surface has (`derived`).
use crate::raster::coverage::CoverageTile;
use crate::raster::{CoverageGrid, Plane};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

/// Memory on the heap.
pub(super) trait HeapSize {
    fn heap_bytes(&self) -> u64;
}

/// Values that can be computed again.
pub(super) trait Cache: HeapSize {
    /// Drops them. What others hold stays in memory until they drop it, too.
    fn clear(&self);
}

/// The last few values, the oldest first.
pub(super) struct RecentCache<K, V> {
    entries: Mutex<Vec<(K, Arc<V>)>>,
}

impl<K, V> Default for RecentCache<K, V> {
    fn default() -> Self {
        Self { entries: Mutex::default() }
    }
}

impl<K: PartialEq, V> RecentCache<K, V> {
    fn lock(&self) -> MutexGuard<'_, Vec<(K, Arc<V>)>> {
        self.entries.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The value of a key, if it is held.
    pub fn get(&self, key: &K) -> Option<Arc<V>> {
        self.lock().iter().find(|(known, _)| known == key).map(|(_, value)| value.clone())
    }

    /// The sum of a figure over all values that are held.
    pub fn sum(&self, figure: impl Fn(&V) -> u64) -> u64 {
        self.lock().iter().map(|(_, value)| figure(value)).sum()
    }

    /// Drops all values.
    pub fn clear(&self) {
        self.lock().clear();
    }

    /// The value of a key. It never computes while holding the lock: a thread that waits for work
    /// of its own pool would deadlock. Threads that call it at the same time may each compute it;
    /// the results are equal.
    ///
    /// * `keep`: how many are held, `≥ 1`.
    /// * `compute`: receives an evicted value that nobody else holds, so that its memory can be
    ///   reused.
    pub fn get_or_compute(
        &self,
        key: K,
        keep: usize,
        compute: impl FnOnce(Option<V>) -> V,
    ) -> Arc<V> {
        let find = |entries: &[(K, Arc<V>)]| {
            entries.iter().find(|(k, _)| *k == key).map(|(_, v)| v.clone())
        };
        let recycled = {
            let mut entries = self.lock();
            if let Some(found) = find(&entries) {
                return found;
            }
            (entries.len() >= keep.max(1)).then(|| entries.remove(0).1).and_then(Arc::into_inner)
        };
        let computed = Arc::new(compute(recycled));
        let mut entries = self.lock();
        if let Some(found) = find(&entries) {
            return found;
        }
        entries.push((key, computed.clone()));
        computed
    }
}

impl<T: Copy> HeapSize for Plane<T> {
    fn heap_bytes(&self) -> u64 {
        (self.size().area() * size_of::<T>()) as u64
    }
}

impl<T: HeapSize> HeapSize for Option<T> {
    fn heap_bytes(&self) -> u64 {
        self.as_ref().map_or(0, T::heap_bytes)
    }
}

impl<T: HeapSize> HeapSize for Arc<T> {
    fn heap_bytes(&self) -> u64 {
        T::heap_bytes(self)
    }
}

impl HeapSize for CoverageGrid {
    fn heap_bytes(&self) -> u64 {
        self.iter().map(|(_, tile)| CoverageTile::held_bytes(tile)).sum()
    }
}

impl<K: PartialEq, V: HeapSize> HeapSize for RecentCache<K, V> {
    fn heap_bytes(&self) -> u64 {
        self.sum(V::heap_bytes)
    }
}

impl<K: PartialEq, V: HeapSize> Cache for RecentCache<K, V> {
    fn clear(&self) {
        RecentCache::clear(self);
    }
}

impl<T: Copy> HeapSize for OnceLock<T> {
    fn heap_bytes(&self) -> u64 {
        0
    }
}

impl<T: Copy> Cache for OnceLock<T> {
    /// A few numbers, read at every pixel: they stay, and need no lock.
    fn clear(&self) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_few_are_kept_and_the_oldest_hands_its_memory_on() {
        let entries = RecentCache::default();
        let first = entries.get_or_compute(1, 2, |_| vec![1; 100]);
        assert!(Arc::ptr_eq(&first, &entries.get_or_compute(1, 2, |_| unreachable!("it is kept"))));
        let memory = first.as_ptr();
        drop(first);
        entries.get_or_compute(2, 2, |recycled| recycled.unwrap_or_default());
        let third = entries.get_or_compute(3, 2, |recycled| recycled.expect("the first's"));
        assert_eq!(third.as_ptr(), memory);
        assert_eq!(*entries.get_or_compute(1, 2, |_| vec![7]), [7], "the first is gone");
    }
}
