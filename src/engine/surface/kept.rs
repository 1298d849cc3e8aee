//! What was computed of a surface and may be asked for again: the last few results, by what they were asked with.
//! Floor 2.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The last few values, the oldest first.
pub(super) struct Kept<K, V> {
    kept: Mutex<Vec<(K, Arc<V>)>>,
}

impl<K, V> Default for Kept<K, V> {
    fn default() -> Self {
        Self { kept: Mutex::default() }
    }
}

impl<K: PartialEq, V> Kept<K, V> {
    fn lock(&self) -> MutexGuard<'_, Vec<(K, Arc<V>)>> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
    /// The value of a key. Never computes under the lock: a thread that waits for its own pool's work would stand still.
    /// Threads that ask at the same time may each compute it, and compute the same.
    ///
    /// * `keep`: how many are held, `≥ 1`.
    /// * `compute`: is handed one that nobody holds any more, for its memory.
    pub fn get_or_compute(&self, key: K, keep: usize, compute: impl FnOnce(Option<V>) -> V) -> Arc<V> {
        let find = |kept: &[(K, Arc<V>)]| kept.iter().find(|(k, _)| *k == key).map(|(_, v)| v.clone());
        let recycled = {
            let mut kept = self.lock();
            if let Some(found) = find(&kept) {
                return found;
            }
            (kept.len() >= keep.max(1)).then(|| kept.remove(0).1).and_then(Arc::into_inner)
        };
        let computed = Arc::new(compute(recycled));
        let mut kept = self.lock();
        if let Some(found) = find(&kept) {
            return found;
        }
        kept.push((key, computed.clone()));
        computed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_few_are_kept_and_the_oldest_hands_its_memory_on() {
        let kept = Kept::default();
        let first = kept.get_or_compute(1, 2, |_| vec![1; 100]);
        assert!(Arc::ptr_eq(&first, &kept.get_or_compute(1, 2, |_| unreachable!("it is kept"))));
        let memory = first.as_ptr();
        drop(first);
        kept.get_or_compute(2, 2, |recycled| recycled.unwrap_or_default());
        let third = kept.get_or_compute(3, 2, |recycled| recycled.expect("the first's"));
        assert_eq!(third.as_ptr(), memory);
        assert_eq!(*kept.get_or_compute(1, 2, |_| vec![7]), [7], "the first is gone");
    }
}
