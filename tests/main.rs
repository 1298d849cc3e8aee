//! Every test of the whole program in one binary, so that it is linked once. Tests of damaged files
//! are separate (`damage.rs`): they watch the allocator.

mod circles;
mod cli;
mod commands;
mod contours;
mod conventions;
mod depth;
mod documents;
mod equations;
mod examples;
mod floors;
mod gallery;
mod goldens;
mod info;
mod interchange;
#[cfg(target_os = "linux")]
mod kills;
mod lines;
mod maps;
mod names;
mod overwriting;
mod performance;
mod program;
mod python;
mod recipe;
mod scripting;
mod shape;
mod texts;
mod verbs;
mod version;
mod view;
#[cfg(feature = "window-tests")]
mod window;
mod words;
