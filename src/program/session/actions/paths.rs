//! Actions on paths: figures and nodes that stay parameters. What cannot be done says why. Floor 6.
//! Not here: another path for a layer, which is a property of it (`Property::Drawn`).

use super::layers::slot_above;
use crate::document::{Document, LayerId};
use crate::paint::{Figure, LivePath, PathCap, PathGeometry, PathJoin};
use crate::session::replay::{actions, as_in_recipes, names, record};
use crate::session::{LayerPath, OpenDocument, Session};
use crate::tools::ToolContext;
use crate::tools::path::{self, PathSettings, nodes};

names!(PathCap);
names!(PathJoin);
as_in_recipes!(Figure);
record!(PathSettings { figure, fills, outline, cap, join });

actions! {
    /// `layer` is a layer of a path.
    PathAction {
        /// A path as a layer of its own, its points canvas points.
        "draw" Draw { path: LivePath }
        /// What new paths and figures are like.
        "settings" Settings { path: PathSettings }
        /// The line that clicks of the path tool continue ends.
        "end" End {}
        /// The node that was set last, or that is selected, is taken away.
        "back" Back {}
        /// A figure becomes nodes, which the path tool moves.
        "to nodes" ToNodes { layer: LayerPath }
    }
}

const NO_PATH: &str = "That layer is no path.";

impl PathAction {
    /// Performs it.
    pub fn apply(&self, session: &mut Session) {
        session.drop_gesture();
        match self {
            PathAction::Settings { path } => return session.tools.path = path.clamp_to_ranges(),
            PathAction::End {} => return session.tools.path_node.line = None,
            PathAction::Back {} => return step_back(session),
            _ => {}
        }
        let Some(open) = session.active_mut() else { return session.say("There is no document.") };
        open.forget_preview();
        let done = match self {
            PathAction::Draw { path } => draw(open, path),
            PathAction::ToNodes { layer } => to_nodes(open, layer),
            PathAction::Settings { .. } | PathAction::End {} | PathAction::Back {} => Ok(()),
        };
        if let Err(why) = done {
            session.say(&why);
        }
    }
}

/// Takes the node that was set last away.
fn step_back(session: &mut Session) {
    let Some(open) = session.active() else { return session.say("There is no document.") };
    let context = ToolContext {
        layer: open.active_layer,
        ..ToolContext::new(open.document(), &session.tools)
    };
    let Some((document, selected)) = nodes::step_back(&context) else {
        return session.say("No node of a path is selected.");
    };
    session.tools.path_node = selected;
    if let Some(open) = session.active_mut() {
        open.forget_preview();
        open.commit("Delete node", document);
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
