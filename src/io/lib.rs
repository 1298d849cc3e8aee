//! Floor 5: files. There is one module per format. Each converts what it reads to the program's own
//! conventions at once.

#![cfg_attr(not(test), warn(missing_docs))]

mod aseprite;
pub mod base64;
pub mod bitmap;
pub mod brush;
pub mod budget;
mod clip;
pub mod crash_report;
pub mod cube;
pub mod export;
pub mod exr;
pub mod files;
pub mod fs;
pub mod icc_profiles;
pub mod inspect;
pub mod json;
pub mod line_svg;
pub mod machine;
pub mod maps;
pub mod open;
pub mod palette;
pub mod path_svg;
pub mod picture;
pub mod pixels;
pub mod platform;
pub mod profile_change;
pub mod project;
pub mod proof;
pub mod psd;
pub mod recipe;
pub mod recovery;
pub mod replace;
pub mod save;
pub mod sixteen_bit_paint;
pub mod svg;
pub mod text;
pub mod thumbnail;
mod version;

// The floors beneath, under their own names.
use rilievo_engine::{
    Error, Remedy, Result, document, math, memory, paint, raster, shading, shape, surface,
};

pub use budget::Budget;
pub use files::{Files, RecipeFolder, UserFiles};
pub use open::{OpenedDocument, open};
pub use replace::{Overwrite, Terms};
pub use save::{SavedDocument, save};
pub use version::{set_commit, version};
