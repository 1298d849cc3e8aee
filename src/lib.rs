//! Rilievo's engine as a library: documents, recipes, surfaces and rendering, without the window.
pub use rilievo_engine::*;
pub use rilievo_io as io;
