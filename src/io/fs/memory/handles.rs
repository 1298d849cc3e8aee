//! Open files and locks of the disk in memory.
//! Floor 5.

use super::MemoryFs;
use crate::fs::{FileHandle, FileLock};
use std::io::{self, Read, Write};
use std::path::PathBuf;

pub(super) struct OpenInode {
    pub memory: MemoryFs,
    pub inode: usize,
    pub at: usize,
    pub holds: bool,
}

impl Read for OpenInode {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let short = self.memory.turn()?.is_some();
        let state = self.memory.state();
        let rest = state.inodes[self.inode].bytes.get(self.at..).unwrap_or_default();
        let n = rest.len().min(buffer.len()).min(if short { 1 } else { usize::MAX });
        buffer[..n].copy_from_slice(&rest[..n]);
        self.at += n;
        Ok(n)
    }
}

impl Write for OpenInode {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let short = self.memory.turn()?.is_some();
        let n = if short { bytes.len() / 2 } else { bytes.len() };
        self.memory.state().inodes[self.inode].bytes.extend_from_slice(&bytes[..n]);
        Ok(n)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl FileHandle for OpenInode {
    fn sync(&mut self) -> io::Result<()> {
        self.memory.turn()?;
        let mut state = self.memory.state();
        let inode = &mut state.inodes[self.inode];
        inode.synced = inode.bytes.clone();
        Ok(())
    }

    fn hold(&mut self) -> io::Result<bool> {
        self.memory.turn()?;
        let is_free = self.memory.state().held.insert(self.inode);
        self.holds |= is_free;
        Ok(self.holds)
    }
}

impl Drop for OpenInode {
    fn drop(&mut self) {
        if self.holds {
            self.memory.state().held.remove(&self.inode);
        }
    }
}

pub(super) struct MemoryLock(pub MemoryFs, pub PathBuf);

impl FileLock for MemoryLock {}

impl Drop for MemoryLock {
    fn drop(&mut self) {
        self.0.state().locked.remove(&self.1);
    }
}
