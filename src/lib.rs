//! Rilievo: a 2D raster painting program whose brushes know the shape they paint on.
//!
//! A picture of an object's shape (a normal map, a depth map, a mask) is a [`surface::Surface`]. Every dab, gradient
//! and photo is a footprint (*where*: operator, anchors, weights) times a source (*what*: tip, ramp, image), bent
//! over that surface before it lands on a tile.
//!
//! The house has floors, and arrows point down only (`docs/ARCHITECTURE.md`, kept by `tests/floors.rs`):
//!
//! | floor | module | holds |
//! |---|---|---|
//! | 7 | [`cli`], `app` | the subcommands; the window |
//! | 6 | [`session`] | the program without its window |
//! | 5 | [`io`], [`tools`] | one file per file format; one file per tool |
//! | 4 | [`document`] | layers, content, flattening |
//! | 3 | [`paint`], [`shading`] | footprints, strokes, gradients, placed images; materials and radiance scaling |
//! | 2 | [`surface`] | maps, curvature, the operators D_p and D_n, anchors, weights |
//! | 1 | [`raster`] | tiles, blend modes, textures, samplers |
//! | 0 | [`math`], [`error`] | rectangles, sRGB, run-time SIMD, the one error type |

pub mod error;
pub mod math;

pub mod raster;

pub mod surface;

pub mod paint;
pub mod shading;

pub mod document;

pub mod io;
pub mod tools;

pub mod session;

#[cfg(feature = "gui")]
pub mod app;
pub mod cli;

pub use error::{Error, Result};
