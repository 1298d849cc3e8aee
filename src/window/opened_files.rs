//! Files that the desktop asks the running program to open: on macOS alone, where a double click starts
//! no second program and gives the first one none in its arguments. Floor 7.
//! Not here: other starts of the program (`running`).

#[cfg(target_os = "macos")]
mod macos;

#[cfg(target_os = "macos")]
pub use macos::listen;

/// `None`: elsewhere they come as arguments of a start.
#[cfg(not(target_os = "macos"))]
pub fn listen(_open: impl Fn(Vec<std::path::PathBuf>) + 'static) -> Option<()> {
    None
}
