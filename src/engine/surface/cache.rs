//! What was computed of a surface and may be asked for again: the last few results, by what they were asked with.
//! Floor 2.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

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
    /// The value of a key. Never computes under the lock: a thread that waits for its own pool's work would stand
    /// still. Threads that ask at the same time may each compute it, and compute the same.
    ///
    /// * `keep`: how many are held, `≥ 1`.
    /// * `compute`: is handed one that nobody holds any more, for its memory.
    pub fn get_or_compute(&self, key: K, keep: usize, compute: impl FnOnce(Option<V>) -> V) -> Arc<V> {
        let find = |entries: &[(K, Arc<V>)]| entries.iter().find(|(k, _)| *k == key).map(|(_, v)| v.clone());
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
