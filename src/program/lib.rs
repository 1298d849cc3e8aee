//! The program without its window: the tools, the session in which they are used, and the command line.
//! Floors 5 to 7 of the house (`docs/ARCHITECTURE.md`). The window ([`session::Action`]s asked by panels) stands on it.

pub mod tools;

pub mod session;

pub mod cli;

// The floors beneath, under the names that they have there.
use rilievo_engine::{Error, Result, document, math, paint, raster, shading, surface};
use rilievo_io as io;
