//! What only Windows says about a file. Floor 5.

use super::Identity;
use std::ffi::c_void;
use std::fs::{self, File, OpenOptions};
use std::io;
use std::os::windows::fs::OpenOptionsExt;
use std::os::windows::io::AsRawHandle;
use std::path::Path;

/// `FILE_FLAG_BACKUP_SEMANTICS`: folders are opened, too.
const FOLDERS_TOO: u32 = 0x0200_0000;

/// `BY_HANDLE_FILE_INFORMATION`.
#[repr(C)]
#[derive(Default)]
struct FileFacts {
    attributes: u32,
    times: [u32; 6],
    volume: u32,
    size: [u32; 2],
    links: u32,
    number_high: u32,
    number_low: u32,
}

/// `OVERLAPPED`, of which locking reads the offset alone.
#[repr(C)]
struct LockPosition {
    results: [usize; 2],
    low: u32,
    high: u32,
    event: *mut c_void,
}

/// `LOCKFILE_EXCLUSIVE_LOCK` and `LOCKFILE_FAIL_IMMEDIATELY`.
const EXCLUSIVE_NOW: u32 = 2 | 1;
/// `ERROR_LOCK_VIOLATION` and `ERROR_IO_PENDING`.
const TAKEN: [i32; 2] = [33, 997];
/// The upper half of the byte that is locked: no file is so long.
const BEYOND_EVERY_FILE: u32 = 1 << 30;

#[link(name = "kernel32")]
unsafe extern "system" {
    fn LockFileEx(
        file: *mut c_void,
        flags: u32,
        reserved: u32,
        length_low: u32,
        length_high: u32,
        position: *mut LockPosition,
    ) -> i32;
    fn GetFileInformationByHandle(file: *mut c_void, facts: *mut FileFacts) -> i32;
}

/// Fails if another program has opened a file so that it cannot be removed or renamed.
pub fn check_removable(path: &Path) -> io::Result<()> {
    // `DELETE`.
    const REMOVING: u32 = 0x0001_0000;
    OpenOptions::new().access_mode(REMOVING).open(path).map(drop)
}

/// The volume and the file's number on it.
pub fn identity(path: &Path) -> io::Result<Identity> {
    // No access is asked for, so that neither rights nor other programs stand in the way.
    let file = OpenOptions::new().access_mode(0).custom_flags(FOLDERS_TOO).open(path)?;
    let mut facts = FileFacts::default();
    // SAFETY: the structure is that of the system's header, and the file is open.
    if unsafe { GetFileInformationByHandle(file.as_raw_handle(), &raw mut facts) } == 0 {
        return Err(io::Error::last_os_error());
    }
    let number = u64::from(facts.number_high) << 32 | u64::from(facts.number_low);
    Ok(Identity { device: u64::from(facts.volume), number })
}

/// Holds a file by one byte far behind its end; false where another handle holds it. Locked bytes
/// cannot be read through other handles there, and what is written must be read back. A lock on
/// the whole file, as `File::try_lock` sets it, includes that byte.
pub fn hold(file: &File) -> io::Result<bool> {
    let mut position = LockPosition {
        results: [0; 2],
        low: 0,
        high: BEYOND_EVERY_FILE,
        event: std::ptr::null_mut(),
    };
    // SAFETY: the structure is that of the system's header, and outlives the call, which does not
    // wait; the file is open.
    let is_held =
        unsafe { LockFileEx(file.as_raw_handle(), EXCLUSIVE_NOW, 0, 1, 0, &raw mut position) != 0 };
    if is_held {
        return Ok(true);
    }
    let error = io::Error::last_os_error();
    if error.raw_os_error().is_some_and(|code| TAKEN.contains(&code)) {
        Ok(false)
    } else {
        Err(error)
    }
}

/// Removes a file, also one that is set read-only, which the system refuses at first.
#[expect(
    clippy::permissions_set_readonly_false,
    reason = "there the attribute is the file's alone"
)]
pub fn remove(path: &Path) -> io::Result<()> {
    let Err(refused) = fs::remove_file(path) else { return Ok(()) };
    let before = fs::symlink_metadata(path)?.permissions();
    if refused.kind() != io::ErrorKind::PermissionDenied || !before.readonly() {
        return Err(refused);
    }
    let mut writable = before.clone();
    writable.set_readonly(false);
    fs::set_permissions(path, writable)?;
    fs::remove_file(path).inspect_err(|_| {
        // The file stays as it was. The error that matters is the first one.
        let _ = fs::set_permissions(path, before);
    })
}
