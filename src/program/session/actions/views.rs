//! Actions on the view of the canvas. They do not change a document.
//! Floor 6.

use crate::math::{Size, Vec2};
use crate::session::replay::actions;
use crate::session::{Session, view::CanvasView};

actions! {
    /// Screen points are measured from the middle of the canvas's area, y down.
    ViewAction {
        "pan" Pan { by: Vec2 }
        "zoom" Zoom { factor: f32, about: Vec2 }
        /// Screen points per canvas pixel.
        "zoom to" ZoomTo { zoom: f32 }
        "turn" Turn { by_rad: f32 }
        "mirror" Mirror {}
        "upright" Upright {}
        "fit" Fit { window_pt: Vec2 }
        "look at" LookAt { center: Vec2 }
        /// A view of the surface over the picture, by its name, or none.
        "overlay" Overlay { view: Option<String> }
        "overlay opacity" OverlayOpacity { to: f32 }
        /// The picture in grays of its luminance, or in its colors.
        "values" Values { on: bool }
        /// The picture as it will be printed, where the window knows a profile for that.
        "proof" Proof { on: bool }
        /// Marks colors that cannot be printed, there.
        "gamut" Gamut { on: bool }
        /// The picture as the document's file holds it, until anything else is done.
        "saved" Saved { on: bool }
        /// The surface unwrapped instead of the picture, as the current operator says. The pen's
        /// points are then those of the sheet.
        "unwrapped" Unwrapped { on: bool }
    }
}

impl ViewAction {
    /// Performs it.
    pub fn apply(&self, session: &mut Session) {
        match self {
            ViewAction::Overlay { view } => session.overlay.clone_from(view),
            ViewAction::OverlayOpacity { to } => session.overlay_opacity = to.max(0.0).min(1.0),
            ViewAction::Values { on } => session.shows_values = *on,
            ViewAction::Proof { on } => session.shows_proof = *on,
            ViewAction::Gamut { on } => session.marks_gamut = *on,
            ViewAction::Saved { on } => session.shows_saved = *on,
            ViewAction::Unwrapped { on } => unwrap(session, *on),
            _ => {
                if let Some(open) = session.active_mut() {
                    let size = open.shown_size();
                    let view = open
                        .view
                        .unwrap_or_else(|| CanvasView::fitting(size, Vec2::new(800.0, 600.0)));
                    open.view = self.view_after(view, size).or(open.view);
                }
            }
        }
    }

    /// The view after an action that moves it; `None` if the action is none of those.
    ///
    /// * `canvas`: the size of the canvas, px.
    pub fn view_after(&self, view: CanvasView, canvas: Size) -> Option<CanvasView> {
        Some(match self {
            ViewAction::Pan { by } => view.panned(*by),
            ViewAction::Zoom { factor, about } => view.zoomed(*factor, *about),
            ViewAction::ZoomTo { zoom } => view.zoomed(zoom / view.zoom, Vec2::ZERO),
            ViewAction::Turn { by_rad } => view.turned(*by_rad),
            ViewAction::Mirror {} => CanvasView { mirrored: !view.mirrored, ..view },
            ViewAction::Upright {} => CanvasView { turn_rad: 0.0, ..view },
            ViewAction::Fit { window_pt } => CanvasView {
                mirrored: view.mirrored,
                ..CanvasView::fitting(canvas, window_pt.max(Vec2::ONE))
            },
            ViewAction::LookAt { center } => CanvasView { center: *center, ..view },
            ViewAction::Overlay { .. }
            | ViewAction::OverlayOpacity { .. }
            | ViewAction::Values { .. }
            | ViewAction::Proof { .. }
            | ViewAction::Gamut { .. }
            | ViewAction::Saved { .. }
            | ViewAction::Unwrapped { .. } => return None,
        })
    }
}

fn unwrap(session: &mut Session, on: bool) {
    session.drop_gesture();
    let settings = session.unwrap_settings();
    let Some(open) = session.active_mut() else { return };
    let laid = open
        .document()
        .surface
        .as_ref()
        .filter(|_| on)
        .and_then(|surface| surface.plane_layout(settings));
    let is_laid = laid.is_some();
    open.show_unwrapped(laid.map(|_| settings));
    if on && !is_laid {
        session.notes.push("There is no surface to unwrap.".into());
    }
}
