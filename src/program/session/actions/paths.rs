//! Actions on paths: figures and nodes that stay parameters. What cannot be done says why. Floor 6.
//! Not here: another path for a layer, which is a property of it (`Property::Drawn`).

use super::layers::slot_above;
use crate::document::{Document, LayerId};
use crate::paint::{LivePath, PathGeometry};
use crate::session::replay::actions;
use crate::session::{LayerPath, OpenDocument, Session};
use crate::tools::path;

actions! {
    /// `layer` is a layer of a path.
    PathAction {
        /// A path as a layer of its own, its points canvas points.
        "draw" Draw { path: LivePath }
        /// A figure becomes nodes, which the path tool moves.
        "to nodes" ToNodes { layer: LayerPath }
    }
}

const NO_PATH: &str = "That layer is no path.";

impl PathAction {
    /// Performs it.
    pub fn apply(&self, session: &mut Session) {
        session.drop_gesture();
        let Some(open) = session.active_mut() else { return session.say("There is no document.") };
        open.forget_preview();
        let done = match self {
            PathAction::Draw { path } => draw(open, path),
            PathAction::ToNodes { layer } => to_nodes(open, layer),
        };
        if let Err(why) = done {
            session.say(&why);
        }
    }
}

/// Adds a path above the selected layer, and selects it.
fn draw(open: &mut OpenDocument, path: &LivePath) -> Result<(), String> {
    path.fits().map_err(|why| format!("The path cannot be drawn: {why}."))?;
    let layer = path::make_layer(open.document(), path.clone());
    let id = layer.id;
    if let Some(next) = open.document().with_inserted(layer, slot_above(open))
        && open.commit(path.label(), next)
    {
        open.active_layer = Some(id);
    }
    Ok(())
}

fn to_nodes(open: &mut OpenDocument, layer: &LayerPath) -> Result<(), String> {
    let found = layer.find(open.document()).cloned().ok_or("There is no such layer.")?;
    let live = path::of_layer(&found).and_then(|image| image.source.path()).ok_or(NO_PATH)?;
    let PathGeometry::Figure(figure) = &live.geometry else {
        return Err("The path consists of nodes already.".into());
    };
    let nodes = live.with_lines(figure.subpaths());
    if let Some(next) = path::replace_paths(open.document(), &[found.id], &nodes) {
        open.commit("To nodes", next);
    }
    Ok(())
}

/// The document with another path in those of some layers that are paths; refuses one that no file
/// could hold before it is drawn.
pub(super) fn replace(
    document: &Document,
    ids: &[LayerId],
    path: &LivePath,
) -> Result<Option<Document>, String> {
    const SHOWN: usize = 60;
    if let (Err(why), Some(layer)) = (path.fits(), ids.iter().find_map(|id| document.layer(*id))) {
        let name: String = layer.name.chars().take(SHOWN).collect();
        return Err(format!("“{name}”: {why}. Nothing was changed."));
    }
    Ok(path::replace_paths(document, ids, path))
}
