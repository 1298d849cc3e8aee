//! Maps of which a new surface or a part is made. Floor 6. Not here: reading them (`io::maps`).

use crate::document::parts::PartMaps;
use crate::document::{Document, SurfaceSource};
use crate::io::maps;
use crate::session::actions::parts;
use crate::session::{Session, storage};
use crate::{Error, Result};
use std::sync::Arc;

/// Replaces the surface beneath the layers, as a step; it is stretched to the canvas, with a note. Fails if no surface
/// of the canvas's size can be made of it.
pub fn replace_maps(session: &mut Session, source: &SurfaceSource, import: maps::ImportedSurface) -> Result<()> {
    let maps::ImportedSurface { surface, findings, files } = import;
    let Some(tab) = session.active_mut() else { return Ok(()) };
    let (canvas, found) = (tab.document().size, surface.size());
    let mut notes = findings.notes;
    let placed = source.map();
    let surface = if found == canvas && placed.is_none() {
        Arc::new(surface)
    } else if let Some(map) = &placed {
        Arc::new(surface).onto(canvas, Some(map)).map_err(|error| Error::unsupported("maps", error))?
    } else {
        notes.push(format!("The maps have {found} pixels and were stretched to the canvas, {canvas}."));
        Arc::new(surface.stretched(canvas).map_err(|error| Error::unsupported("maps", error))?)
    };
    let is_whole = found == canvas || placed.is_some();
    let next = Document {
        surface: Some(surface),
        surface_source: is_whole.then(|| Arc::new(source.clone())),
        surface_files: Arc::new(if is_whole { files } else { Default::default() }),
        ..tab.document().clone()
    };
    let maps = next.surface.clone();
    if tab.commit("Replace maps", next.with_maps(maps).with_selections_found()) {
        tab.reads.extend(storage::map_files(source));
        session.notes.extend(notes);
    }
    Ok(())
}

/// A part of maps in front of all others, stretched to the canvas, as a step. Fails if no surface of the canvas's size
/// can be made of them.
pub fn add_maps(session: &mut Session, source: &SurfaceSource, import: maps::ImportedSurface) -> Result<()> {
    let maps::ImportedSurface { surface, findings, files } = import;
    let Some(tab) = session.active_mut() else { return Ok(()) };
    let (canvas, found) = (tab.document().size, surface.size());
    let mut notes = findings.notes;
    if found != canvas {
        notes.push(format!("The maps have {found} pixels and were stretched to the canvas, {canvas}."));
    }
    let surface = Arc::new(surface).onto(canvas, None).map_err(|error| Error::unsupported("maps", error))?;
    parts::new::add_maps(tab, PartMaps { source: Arc::new(source.clone()), files: Arc::new(files), surface });
    tab.reads.extend(storage::map_files(source));
    session.notes.extend(notes);
    Ok(())
}
