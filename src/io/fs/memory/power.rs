//! Power cuts: what is left of a disk in memory, for every combination of what may be lost.

use super::{DiskState, Inode, MemoryFs, apply};
use std::sync::{Arc, Mutex};

/// Bits of luck that decide about a file that is not synced.
const BITS_A_FILE: usize = 10;

impl DiskState {
    /// Values of `luck` that [`DiskState::after_power_cut`] distinguishes: all of them, or `most`
    /// spread over them.
    pub fn lucks(&self, most: u64) -> impl Iterator<Item = u64> {
        let unsynced = self.inodes.iter().filter(|inode| inode.bytes != inode.synced).count();
        let all = 1u64 << (self.pending.len() + BITS_A_FILE * unsynced).min(63);
        // An odd step visits every value before one comes again.
        let step = if all <= most { 1 } else { 0x9e37_79b9_7f4a_7c15 };
        (0..all.min(most)).map(move |i| i.wrapping_mul(step) % all)
    }

    /// The disk after a power cut. Each bit of `luck` decides about one change of a folder; further
    /// bits decide for each file that is not synced what arrived, and how much.
    pub fn after_power_cut(&self, luck: u64) -> MemoryFs {
        let mut names = self.synced_names.clone();
        let mut bits = luck;
        let mut next = || {
            let bit = bits & 1 == 1;
            bits >>= 1;
            bit
        };
        for change in &self.pending {
            if next() {
                apply(&mut names, change);
            }
        }
        let mut one = |inode: &Inode| {
            if inode.bytes == inode.synced {
                return inode.clone();
            }
            // All, what was synced, or some of what came after.
            let (synced, all) = (inode.synced.len(), inode.bytes.len());
            let (kind, part) =
                ((next(), next()), (0..8).fold(0, |n, bit| n | usize::from(next()) << bit));
            let arrived = &inode.bytes[..synced + (all - synced) * part / 256];
            let bytes = match kind {
                (true, true) => inode.bytes.clone(),
                (true, false) => arrived.to_vec(),
                // Its length is known already, its bytes are not.
                (false, true) => [arrived, &vec![0; all - arrived.len()]].concat(),
                (false, false) => inode.synced.clone(),
            };
            Inode { synced: bytes.clone(), bytes }
        };
        let inodes = self.inodes.iter().map(&mut one).collect();
        let state =
            DiskState { inodes, synced_names: names.clone(), names, ..DiskState::default() };
        MemoryFs(Arc::new(Mutex::new(state)))
    }
}
