//! Actions on a comic's panels. What cannot be done says why. Floor 6. Not here: their layers
//! (`tools::panels`).

use crate::document::{Document, LayerId};
use crate::math::{Vec2, vec2};
use crate::paint::{PanelSettings, PathGeometry};
use crate::session::replay::{actions, as_in_recipes};
use crate::session::{LayerPath, OpenDocument, Session};
use crate::tools::panels::layers;
use crate::tools::path::along;

as_in_recipes!(PanelSettings);

actions! {
    /// Panels are groups whose frame is a path.
    PanelAction {
        /// What a page of panels and new panels are like.
        "settings" Settings { panels: PanelSettings }
        /// The shape of a path becomes panels in its place; without a layer the box around what is
        /// selected, or the page.
        "divide" Divide { layer: Option<LayerPath> }
        /// The panels that a straight line goes over are cut.
        "cut" Cut { from: Vec2, to: Vec2 }
    }
}

impl PanelAction {
    /// Performs it.
    pub fn apply(&self, session: &mut Session) {
        session.drop_gesture();
        if let PanelAction::Settings { panels } = self {
            session.tools.panels = panels.clamp_to_ranges();
            return;
        }
        let settings = session.tools.panels.clamp_to_ranges();
        let Some(open) = session.active_mut() else { return session.say("There is no document.") };
        open.forget_preview();
        let done = match self {
            PanelAction::Divide { layer } => divide(open, layer.as_ref(), &settings),
            PanelAction::Cut { from, to } => cut(open, [*from, *to], &settings),
            PanelAction::Settings { .. } => Ok(()),
        };
        if let Err(why) = done {
            session.say(&why);
        }
    }
}

fn divide(
    open: &mut OpenDocument,
    layer: Option<&LayerPath>,
    settings: &PanelSettings,
) -> Result<(), String> {
    let refused = |why: String| format!("There are no panels: {why}.");
    let document = open.document();
    let (place, rest, shapes) = match layer {
        Some(layer) => {
            let id = layer.find(document).ok_or("There is no such layer.")?.id;
            let shapes = divide_path(document, id, settings).map_err(refused)?;
            let place = document.place_of(id).ok_or("There is no such layer.")?;
            let rest = document.without_layer(id).ok_or("There is no such layer.")?;
            (place, rest, shapes)
        }
        None => {
            let size = document.size;
            let page = [Vec2::ZERO, vec2(size.width as f32, size.height as f32)];
            let divided = match document.active_coverage().map(|c| c.covered_rect()) {
                Some(area) if !area.is_empty() => {
                    let corner = |x: i32, y: i32| vec2(x as f32, y as f32);
                    let corners = [corner(area.x0, area.y0), corner(area.x1, area.y1)];
                    PanelSettings { margin: 0.0, ..*settings }.divide_rectangle(corners)
                }
                _ => settings.divide_rectangle(page),
            };
            let shapes = divided.map_err(refused)?.into_iter().map(PathGeometry::Figure).collect();
            let place = layers::slot_for_panel(document, open.active_layer);
            (place, document.clone(), shapes)
        }
    };
    let label = if shapes.len() > 1 { "Panels" } else { "Panel" };
    let made = layers::with_panels(&rest, shapes, place, settings);
    let (next, drawing) = made.ok_or_else(|| refused("they would be too large".into()))?;
    if open.commit(label, next) {
        open.active_layer = Some(drawing);
    }
    Ok(())
}

/// The shapes of the panels that a path's inside is divided in, on the canvas.
fn divide_path(
    document: &Document,
    id: LayerId,
    settings: &PanelSettings,
) -> Result<Vec<PathGeometry>, String> {
    let lines = along::lines_on_canvas(document, id).ok_or("that layer is no path")?;
    let shapes = settings.divide_shape(&lines)?;
    if shapes.is_empty() { Err("the path has no inside".into()) } else { Ok(shapes) }
}

fn cut(open: &mut OpenDocument, ends: [Vec2; 2], settings: &PanelSettings) -> Result<(), String> {
    let cut = layers::with_cut(open.document(), settings, ends);
    let (next, count) =
        cut.ok_or("No panel was cut: the line goes over none that is shown and not locked.")?;
    open.commit(if count > 1 { "Cut panels" } else { "Cut panel" }, next);
    Ok(())
}
