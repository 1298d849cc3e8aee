//! Maps of which a new surface or a part is made. Floor 6. Not here: reading them (`io::maps`).

use crate::document::parts::PartMaps;
use crate::document::{Document, SurfaceSource};
use crate::io::maps;
use crate::math::{PlaneMap, Size};
use crate::session::actions::parts;
use crate::session::{Session, storage};
use crate::{Error, Result};
use std::sync::Arc;

/// Replaces the surface beneath the layers, as a step; it is stretched to the canvas, with a note.
/// Fails if no surface of the canvas's size can be made of it.
pub fn replace_maps(
    session: &mut Session,
    source: &SurfaceSource,
    import: maps::ImportedSurface,
) -> Result<()> {
    let maps::ImportedSurface { surface, findings, files } = import;
    let Some(open) = session.active_mut() else { return Ok(()) };
    let (canvas, found) = (open.document().size, surface.size());
    let mut notes = findings.notes;
    let map = source.map().or_else(|| {
        let is_other = found != canvas;
        notes.extend(is_other.then(|| stretch_text(found, canvas)));
        is_other.then(|| PlaneMap::scaling(found, canvas))
    });
    let surface = Arc::new(surface)
        .onto(canvas, map.as_ref())
        .map_err(|error| Error::unsupported_file("maps", error))?;
    let next = Document {
        surface_source: Some(Arc::new(source.placed_as(&surface))),
        surface: Some(surface),
        surface_files: Arc::new(files),
        ..open.document().clone()
    };
    let maps = next.surface.clone();
    if open.commit("Replace maps", next.with_maps(maps).with_selections_found()) {
        open.reads.extend(storage::map_files(source));
        session.notes.extend(notes);
    }
    Ok(())
}

fn stretch_text(found: Size, canvas: Size) -> String {
    format!("The maps have {found} pixels and were stretched to the canvas, {canvas}.")
}

/// A part of maps in front of all others, stretched to the canvas, as a step. Fails if no surface
/// of the canvas's size can be made of them.
pub fn add_maps(
    session: &mut Session,
    source: &SurfaceSource,
    import: maps::ImportedSurface,
) -> Result<()> {
    let maps::ImportedSurface { surface, findings, files } = import;
    let Some(open) = session.active_mut() else { return Ok(()) };
    let (canvas, found) = (open.document().size, surface.size());
    let mut notes = findings.notes;
    notes.extend((found != canvas).then(|| stretch_text(found, canvas)));
    let surface = Arc::new(surface)
        .onto(canvas, source.map().as_ref())
        .map_err(|error| Error::unsupported_file("maps", error))?;
    parts::new::add_maps(
        open,
        PartMaps { source: Arc::new(source.clone()), files: Arc::new(files), surface },
    );
    open.reads.extend(storage::map_files(source));
    session.notes.extend(notes);
    Ok(())
}
