//! Actions on paths: figures and nodes that stay parameters. What cannot be done says why. Floor 6.
//! Not here: another path for a layer, which is a property of it (`Property::Drawn`).

use super::layers::{slot_above, texts};
use crate::paint::{Figure, LivePath, PathCap, PathGeometry, PathJoin, Selection};
use crate::raster::coverage::SelectionMode;
use crate::session::replay::{actions, as_in_recipes, names, record};
use crate::session::{LayerPath, OpenDocument, Session};
use crate::tools::ToolContext;
use crate::tools::path::{self, PathSettings, along, nodes};

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
        /// The edge of the selection as a layer of a path.
        "from selection" FromSelection {}
        /// What lies inside is selected.
        "select" Select { layer: LayerPath, how: SelectionMode }
        /// The brush in hand goes along it, on another layer, or on strokes above it.
        "stroke" Stroke { layer: LayerPath, onto: Option<LayerPath> }
        /// A text runs along the path, where that lies now.
        "carry text" CarryText { layer: LayerPath, text: LayerPath }
        /// A figure becomes nodes, which the path tool moves.
        "to nodes" ToNodes { layer: LayerPath }
    }
}

const NO_PATH: &str = "That layer is no path.";
const NO_LAYER: &str = "There is no such layer.";

impl PathAction {
    /// Performs it.
    pub fn apply(&self, session: &mut Session) {
        session.drop_gesture();
        match self {
            PathAction::Settings { path } => return session.tools.path = path.clamp_to_ranges(),
            PathAction::End {} => return session.tools.path_node.line = None,
            PathAction::Back {} => return step_back(session),
            PathAction::FromSelection {} => {
                let made = from_selection(session);
                return session.said.extend(made.err());
            }
            PathAction::Stroke { layer, onto } => {
                let stroked = stroke(session, layer, onto.as_ref());
                return session.said.extend(stroked.err());
            }
            _ => {}
        }
        let Some(open) = session.active_mut() else { return session.say("There is no document.") };
        open.forget_preview();
        let done = match self {
            PathAction::Draw { path } => draw(open, path),
            PathAction::ToNodes { layer } => to_nodes(open, layer),
            PathAction::Select { layer, how } => select(open, layer, *how),
            PathAction::CarryText { layer, text } => carry_text(open, layer, text),
            PathAction::Settings { .. }
            | PathAction::End {}
            | PathAction::Back {}
            | PathAction::FromSelection {}
            | PathAction::Stroke { .. } => Ok(()),
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

/// Selects what lies inside of a path.
fn select(open: &mut OpenDocument, layer: &LayerPath, how: SelectionMode) -> Result<(), String> {
    let document = open.document();
    let id = layer.find(document).ok_or(NO_LAYER)?.id;
    let inside = along::inside(document, id).ok_or(NO_PATH)?;
    if inside.is_empty() {
        return Err("The path has no inside: there is nothing to select.".into());
    }
    open.commit("Select path", document.with_combined(Selection::new(inside), how));
    Ok(())
}

/// Draws a path around what is selected.
fn from_selection(session: &mut Session) -> Result<(), String> {
    let colors = [session.tools.color, session.tools.second_color];
    let settings = session.tools.path.clamp_to_ranges();
    let open = session.active_mut().ok_or("There is no document.")?;
    open.forget_preview();
    let selected = open.document().active_coverage().ok_or("Nothing is selected.")?;
    let path = along::around(selected, &settings, colors)
        .ok_or("The selection has no edge that a path could follow.")?;
    draw(open, &path)
}

/// Paints along a path with the brush in hand.
fn stroke(session: &mut Session, path: &LayerPath, onto: Option<&LayerPath>) -> Result<(), String> {
    let open = session.active().ok_or("There is no document.")?;
    let document = open.document();
    let path = path.find(document).ok_or(NO_LAYER)?.id;
    let onto = onto.map(|onto| onto.find(document).ok_or(NO_LAYER)).transpose()?;
    let layer = onto.map_or(path, |onto| onto.id);
    let context = ToolContext { layer: Some(layer), ..ToolContext::new(document, &session.tools) };
    let (next, select) = along::stroke(&context, path)?;
    session.remember_color();
    if let Some(open) = session.active_mut() {
        open.forget_preview();
        if open.commit("Stroke path", next) {
            open.active_layer = select.or(open.active_layer);
        }
    }
    Ok(())
}

fn carry_text(open: &mut OpenDocument, path: &LayerPath, text: &LayerPath) -> Result<(), String> {
    let document = open.document();
    let [path, text] = [path, text].map(|layer| layer.find(document).map(|layer| layer.id));
    let (path, text) = path.zip(text).ok_or(NO_LAYER)?;
    if let Some(next) = texts::put_on_path(document, text, path)? {
        open.commit("Text along path", next);
        open.active_layer = Some(text);
    }
    Ok(())
}

fn to_nodes(open: &mut OpenDocument, layer: &LayerPath) -> Result<(), String> {
    let found = layer.find(open.document()).cloned().ok_or(NO_LAYER)?;
    let live = path::of_layer(&found).and_then(|image| image.source.path()).ok_or(NO_PATH)?;
    let PathGeometry::Figure(figure) = &live.geometry else {
        return Err("The path consists of nodes already.".into());
    };
    let nodes = live.with_lines(figure.subpaths());
    if let Some(next) = path::replace_paths(open.document(), &[found.id], &nodes)? {
        open.commit("To nodes", next);
    }
    Ok(())
}
