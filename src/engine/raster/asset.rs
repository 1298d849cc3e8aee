//! A file's bytes as they were read, shared by everything that was made from them.
//! Floor 1. Nothing here knows what the bytes mean.

use std::{fmt, sync::Arc};

/// The whole of a file. Cheap to clone; never changed.
#[derive(Clone, Eq)]
pub struct Asset(Arc<[u8]>);

impl Asset {
    /// The file, as it was read.
    pub fn bytes(&self) -> &[u8] {
        &self.0
    }

    /// Where the bytes are in memory: no two live assets share it.
    pub fn address(&self) -> usize {
        self.0.as_ptr() as usize
    }

    /// Both are the same bytes in memory.
    pub fn ptr_eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl From<Vec<u8>> for Asset {
    fn from(bytes: Vec<u8>) -> Self {
        Self(bytes.into())
    }
}

impl PartialEq for Asset {
    fn eq(&self, other: &Self) -> bool {
        self.ptr_eq(other) || self.0 == other.0
    }
}

/// Prints the length only: the bytes would not help a reader.
impl fmt::Debug for Asset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Asset({} bytes)", self.0.len())
    }
}
