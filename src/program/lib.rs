//! The program without its window: the tools, the session in which they are used, and the command
//! line. Floors 5 to 7 (`docs/ARCHITECTURE.md`). The window is built on it: its panels request
//! [`session::Action`]s.

#![cfg_attr(not(test), warn(missing_docs))]

pub mod language;

pub mod tools;

pub mod session;

pub mod cli;

// The lower floors, under their own names.
use rilievo_engine::{
    Error, Remedy, Result, document, math, memory, paint, raster, shading, shape, surface,
};
use rilievo_io as io;
