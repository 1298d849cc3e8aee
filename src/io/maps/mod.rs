//! Normal, depth and mask maps in whatever convention, brought into the program's own.
//! Floor 5.

pub mod findings;

pub use findings::{Choice, Findings, How};

use super::{Budget, Files};
use crate::document::source::SurfaceSource;
use crate::surface::Surface;
use crate::{Error, Result};

/// A surface and how its maps were understood.
pub struct Import {
    pub surface: Surface,
    pub findings: Findings,
}

/// Reads a document's maps.
pub fn import(source: &SurfaceSource, files: &dyn Files, _budget: &Budget) -> Result<Import> {
    let name = source.normal.as_ref().map_or("surface", |n| &n.file);
    Err(Error::unsupported(files.path(name), "maps are not read yet"))
}
