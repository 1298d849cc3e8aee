//! Starts the window on Windows without a console: what the menu and a double click start there.
//!
//! `rilievo.exe` is a program of the console, so that the command line can print, be piped and
//! return an exit code. A shortcut to it would open a console beside the window.

#![cfg_attr(windows, windows_subsystem = "windows")]

use std::process::{Command, ExitCode};

fn main() -> ExitCode {
    let program = match std::env::current_exe() {
        Ok(launcher) => launcher.with_file_name(format!("rilievo{}", std::env::consts::EXE_SUFFIX)),
        Err(_) => return ExitCode::FAILURE,
    };
    let mut command = Command::new(program);
    command.arg("open").args(std::env::args_os().skip(1));
    #[cfg(windows)]
    {
        use std::os::windows::process::CommandExt;
        const CREATE_NO_WINDOW: u32 = 0x0800_0000;
        command.creation_flags(CREATE_NO_WINDOW);
    }
    match command.spawn() {
        Ok(_) => ExitCode::SUCCESS,
        Err(_) => ExitCode::FAILURE,
    }
}
