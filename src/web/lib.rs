//! The program in the page of a browser. Floor 8.
//!
//! The page's own thread holds the canvas and hears the user; it may never wait. So the whole window
//! runs in a worker: it gets the events as calls of `Program`, paints by WebGL into the canvas it was
//! handed, and tells the page in messages what to do. Other workers are the threads
//! (`io::platform`). The scripts beside it are in `dist/web`.

#![cfg(target_family = "wasm")]
#![warn(missing_docs)]

mod dropped;
mod events;
mod page;
mod program;

pub use program::Program;

use rilievo_io::platform;
use std::path::Path;
use wasm_bindgen::prelude::wasm_bindgen;

/// What a worker does that is a thread: the work that comes, without an end.
#[wasm_bindgen(js_name = runTasks)]
pub fn run_tasks() {
    platform::run_tasks()
}

/// Puts a file there that the page stored, or was given, before or while the program runs.
#[wasm_bindgen(js_name = putFile)]
pub fn put_file(path: &str, bytes: Vec<u8>) {
    platform::files::put(Path::new(path), bytes);
}

/// The page's answer to a question of this number; without a text it is a refusal.
#[wasm_bindgen]
pub fn answer(number: u32, text: Option<String>, bytes: Vec<u8>) {
    platform::answer(number, platform::Answer { text, bytes });
}
