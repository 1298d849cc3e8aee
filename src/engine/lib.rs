//! The engine: surfaces, the operators that bend marks over them, brushes, shading and the layered
//! document. Floors 0 to 4 (`docs/ARCHITECTURE.md`). It opens no file, reads no clock and starts no
//! thread of its own. It gives the same bytes on every run, with any number of threads.
//!
//! A picture of an object's shape (a normal map, a depth map, a mask) is a [`surface::Surface`].
//! Every dab, gradient and photo is a footprint (*where*: operator, anchors, weights) times a
//! source (*what*: tip, ramp, image), bent over that surface before it lands on a tile.
//!
//! | floor | module | holds |
//! |---|---|---|
//! | 4 | [`document`] | layers, content, flattening |
//! | 3 | [`paint`], [`shading`] | footprints, strokes, gradients, placed images; materials and radiance scaling |
//! | 3 | [`shape`] | forms from outlines: inflated, turned, touched, combined |
//! | 2 | [`surface`] | maps, curvature, the operators D_p and D_n, anchors, weights |
//! | 1 | [`raster`] | tiles, blend modes, textures, samplers |
//! | 0 | [`math`], [`error`], [`memory`] | rectangles, sRGB, run-time SIMD; the error type; buffers that ask first |

#![cfg_attr(not(test), warn(missing_docs))]

pub mod error;
pub mod math;
pub mod memory;

pub mod raster;

pub mod surface;

pub mod paint;
pub mod shading;
pub mod shape;

pub mod document;

pub use error::{Error, Remedy, Result};
