//! Rilievo as a library: paint over normal and depth maps without the window.
//!
//! A [`Document`] is a canvas, the [`Surface`] that is painted on, and layers. It is read from a recipe or a project
//! file, or built in code; [`flatten()`] makes the picture. Values are cheap to clone and never change while shared.
//!
//! Render a recipe to a PNG:
//!
//! ```
//! use rilievo::export::{ExportOptions, OutputFile};
//! use rilievo::{Budget, Overwrite, Progress, Terms, flatten, open};
//!
//! # fn main() -> rilievo::Result<()> {
//! # let folder = tempfile::tempdir().unwrap();
//! # let recipe = folder.path().join("painting.json");
//! # let text = r##"{ "format": "rilievo", "version": 1, "canvas": { "width": 64, "height": 64 },
//! #     "layers": [{ "kind": "fill", "color": "#20242c" }] }"##;
//! # std::fs::write(&recipe, text).unwrap();
//! # let picture = folder.path().join("painting.png");
//! let opened = open(&recipe, &Budget::default())?;
//! for note in &opened.notes {
//!     eprintln!("{note}");
//! }
//! let pixels = flatten(&opened.document, &Progress::default()).unwrap_or_default();
//! let output = OutputFile::new(&picture, Terms::export(Overwrite::Nothing, vec![recipe]))?;
//! output.write(&pixels, opened.document.size, &ExportOptions::default())?;
//! # assert!(picture.exists());
//! # Ok(())
//! # }
//! ```
//!
//! Build a document in code and save it as a project that the program opens:
//!
//! ```
//! use rilievo::{BlendMode, Color, Content, Document, Layer, Overwrite, Progress, Size, save};
//!
//! # fn main() -> rilievo::Result<()> {
//! # let folder = tempfile::tempdir().unwrap();
//! # let project = folder.path().join("two-fills.ora");
//! let mut document = Document::empty(Size::new(320, 200));
//! let fill = |r, g, b| Content::Fill(Color { r, g, b, a: 255 });
//! document.layers.push(Layer::new("Ground", fill(32, 36, 44)).into());
//! let glow = Layer { blend: BlendMode::Screen, opacity: 0.5, ..Layer::new("Glow", fill(192, 128, 64)) };
//! document.layers.push(glow.into());
//! save(&document, &project, Overwrite::Nothing, &Progress::default())?;
//! # assert!(project.exists());
//! # Ok(())
//! # }
//! ```
//!
//! Anything not named here is not part of the library: the crates `rilievo-engine`, `rilievo-io`, `rilievo-program` and
//! `rilievo-window` may change with every release.

#![warn(missing_docs)]

pub use rilievo_engine::document::{
    Content, Document, Group, Layer, LayerId, LayerLock, LayerSlot, PixelLayer, Progress, flatten, flatten_layer,
};
pub use rilievo_engine::math::{Size, srgb::Color};
pub use rilievo_engine::raster::{BlendMode, TILE, Tile, TileGrid};
pub use rilievo_engine::surface::Surface;
pub use rilievo_engine::{Error, Remedy, Result};
pub use rilievo_io::{
    Budget, Files, OpenedDocument, Overwrite, RecipeFolder, SavedDocument, Terms, export, open, recipe, save,
};
