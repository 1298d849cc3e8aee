//! The Layer menu.
//! Floor 7.

use super::row::{
    LINE, MenuCommand, ctrl, ctrl_alt, ctrl_shift, has_document, has_layer, has_surface, key, row,
    shift, submenu,
};
use crate::document::{Content, Layer, LayerLock, LayerMask, MaskKind};
use crate::file_purpose::FilePurpose;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::PicturePart;
use crate::session::actions::{ClipboardAction, LayerAction, NewLayer, PartAction};
use crate::session::selected_layers::{neighbor, range};
use crate::session::{Action, LayerPath, LayerPaths, Property, Session};
use eframe::egui::Key;

/// Does something with all selected layers; if there are none, says so.
fn with_selected(
    session: &Session,
    requests: &mut UiRequests,
    action: impl FnOnce(LayerPaths) -> LayerAction,
) {
    if session.active().is_some() {
        requests.act(Action::Layer(action(session.layer_paths())));
    }
}

/// Does something with the selected layer.
fn with_active_layer(
    session: &Session,
    requests: &mut UiRequests,
    action: impl FnOnce(LayerPath) -> LayerAction,
) {
    requests.actions.extend(session.layer_path().map(action).map(Action::Layer));
}

fn set(session: &Session, requests: &mut UiRequests, to: Property) {
    with_selected(session, requests, |layer| LayerAction::Set { layer, to, done: true });
}

fn add(requests: &mut UiRequests, kind: NewLayer) {
    requests.act(Action::Layer(LayerAction::Add { kind }));
}

fn toggle_lock(session: &Session, requests: &mut UiRequests, lock: LayerLock) {
    let lock = if is_locked(session, lock) { LayerLock::None } else { lock };
    set(session, requests, Property::Locked { lock });
}

/// Moves to the next layer, or adds it.
fn step(session: &Session, requests: &mut UiRequests, by: i32, extends: bool) {
    let Some((open, active_layer)) =
        session.active().and_then(|open| Some((open, open.active_layer?)))
    else {
        return;
    };
    let to = neighbor(open.document(), active_layer, by);
    let anchor = open.range_start().filter(|_| extends);
    let listed: Vec<_> = open.document().walk().iter().map(|(_, layer)| layer.id).collect();
    let ids = anchor.map_or_else(|| vec![to], |anchor| range(&listed, anchor, to));
    requests
        .actions
        .extend(LayerAction::select_layers(open.document(), &ids, anchor).map(Action::Layer));
}

/// Whether something is true of the selected layer.
fn is_so_of_layer(session: &Session, is: impl FnOnce(&Layer) -> bool) -> bool {
    session.layer().is_some_and(|layer| is(layer))
}

fn is_live(session: &Session) -> bool {
    is_so_of_layer(session, |layer| {
        !matches!(
            layer.content,
            Content::Pixels(_)
                | Content::RadianceScaling(_)
                | Content::Adjustment(_)
                | Content::Filter(_)
        )
    })
}

fn is_shown(session: &Session) -> bool {
    is_so_of_layer(session, |layer| layer.visible)
}

fn is_clipped(session: &Session) -> bool {
    is_so_of_layer(session, |layer| layer.clip_below)
}

fn is_locked(session: &Session, lock: LayerLock) -> bool {
    is_so_of_layer(session, |layer| layer.lock == lock)
}

fn is_alone(session: &Session) -> bool {
    session.active().is_some_and(|open| open.solo.is_some() && open.solo == open.active_layer)
}

fn has_mask(session: &Session) -> bool {
    is_so_of_layer(session, |layer| layer.mask.is_some())
}

fn is_so_of_mask(session: &Session, is: impl FnOnce(&LayerMask) -> bool) -> bool {
    is_so_of_layer(session, |layer| layer.mask.as_ref().is_some_and(is))
}

/// Whether the selected layer is drawn by the form.
fn has_form_drawing(session: &Session) -> bool {
    session.layer().is_some_and(|layer| matches!(layer.content, Content::FormDrawing(_)))
}

fn is_on_mask(session: &Session) -> bool {
    session.active().is_some_and(|open| open.on_mask)
}

pub const COMMANDS: &[MenuCommand] = &[
    row(
        "New paint layer",
        &[key(Key::Insert), ctrl_shift(Key::N)],
        "A layer of pixels: strokes on it cannot be moved later",
        has_document,
        |_, requests| add(requests, NewLayer::Paint),
    ),
    row(
        "New stroke layer",
        &[],
        "A layer of strokes: each can be moved along the surface later",
        has_document,
        |_, requests| add(requests, NewLayer::Strokes),
    ),
    row("New group", &[], "Layers flattened together", has_document, |_, requests| {
        add(requests, NewLayer::Group)
    }),
    submenu("New live layer", LIVE),
    submenu("New shading layer", super::shading::COMMANDS),
    submenu("New adjustment layer", super::adjustments::LAYERS),
    submenu("New filter layer", super::filters::LAYERS),
    submenu("Effects", super::effects::COMMANDS),
    LINE,
    row(
        "Give it a shape…",
        &[],
        "Makes a lit shape from the drawing, in one part or a part for each color, to paint on",
        has_document,
        |_, requests| requests.request(WindowRequest::ShapeDialog),
    ),
    submenu("New part", super::parts::COMMANDS),
    submenu("From the drawing", DRAWING),
    submenu("Path", super::paths::COMMANDS),
    LINE,
    row(
        "Layer via copy",
        &[ctrl(Key::J)],
        "Copies the selected pixels of this layer to a new one; without a selection, all of it",
        has_layer,
        |_, requests| requests.act(Action::Clipboard(ClipboardAction::LayerVia { cut: false })),
    ),
    row(
        "Layer via cut",
        &[ctrl_shift(Key::J)],
        "Moves the selected pixels of this layer to a new one",
        has_layer,
        |_, requests| requests.act(Action::Clipboard(ClipboardAction::LayerVia { cut: true })),
    ),
    row(
        "Duplicate layer",
        &[],
        "Copies the selected layers, above them",
        has_document,
        |session, requests| {
            with_selected(session, requests, |layer| LayerAction::Duplicate { layer })
        },
    ),
    row(
        "Delete layer",
        &[shift(Key::Delete)],
        "Deletes the selected layers and what is in them",
        has_document,
        |session, requests| with_selected(session, requests, |layer| LayerAction::Delete { layer }),
    ),
    row(
        "Group layer",
        &[ctrl(Key::G)],
        "Puts the selected layers into a new group",
        has_document,
        |session, requests| with_selected(session, requests, |layer| LayerAction::Group { layer }),
    ),
    row(
        "Ungroup",
        &[ctrl_shift(Key::G)],
        "Takes the layers out of the selected groups",
        has_document,
        |session, requests| {
            with_selected(session, requests, |layer| LayerAction::Ungroup { layer })
        },
    ),
    submenu("Arrange and select", ORDER),
    LINE,
    row(
        "Merge down",
        &[ctrl(Key::E), ctrl_shift(Key::M)],
        "Makes one paint layer of this layer and the one below it, or of all selected ones",
        has_document,
        |session, requests| {
            with_selected(session, requests, |layer| LayerAction::MergeDown { layer })
        },
    ),
    row(
        "Turn layer into pixels",
        &[ctrl_shift(Key::B)],
        "Turns a live layer into paint: it keeps its look and no longer follows the surface",
        is_live,
        |session, requests| with_selected(session, requests, |layer| LayerAction::Bake { layer }),
    ),
    row(
        "Flatten picture",
        &[ctrl_shift(Key::E)],
        "Makes one paint layer of everything visible",
        has_layer,
        |_, requests| requests.act(Action::Layer(LayerAction::Flatten {})),
    ),
    LINE,
    submenu("Mask", MASK),
    row(
        "Clip to layer below",
        &[ctrl_alt(Key::G)],
        "Paint only where the layer beneath has paint",
        has_layer,
        |session, requests| {
            set(session, requests, Property::ClipBelow { on: !is_clipped(session) })
        },
    )
    .ticked(|session, _| is_clipped(session)),
    row(
        "Lock alpha",
        &[key(Key::Slash)],
        "Paint only where the layer has paint already",
        has_layer,
        |session, requests| toggle_lock(session, requests, LayerLock::Alpha),
    )
    .ticked(|session, _| is_locked(session, LayerLock::Alpha)),
    row("Lock layer", &[], "No tool can change it", has_layer, |session, requests| {
        toggle_lock(session, requests, LayerLock::All)
    })
    .ticked(|session, _| is_locked(session, LayerLock::All)),
    row(
        "Show or hide layer",
        &[],
        "Same as the eye of the selected layer",
        has_layer,
        |session, requests| {
            set(session, requests, Property::Visible { on: !is_shown(session) });
        },
    )
    .ticked(|session, _| is_shown(session)),
    row(
        "Show layer alone",
        &[],
        "Hides all other layers, or shows them again",
        has_layer,
        |session, requests| {
            with_active_layer(session, requests, |layer| LayerAction::Solo { layer })
        },
    )
    .ticked(|session, _| is_alone(session)),
];

/// Layers that stay as they were set, and can be set again.
const LIVE: &[MenuCommand] = &[
    row("New fill layer", &[], "A layer of one color", has_document, |_, requests| {
        add(requests, NewLayer::Fill)
    }),
    row(
        "New gradient layer",
        &[],
        "A gradient from the first to the second color, bent like new marks",
        has_document,
        |_, requests| add(requests, NewLayer::Gradient),
    ),
    row(
        "New form lines",
        &[],
        "Outlines, creases and folds of the shape in ink; they follow it",
        has_surface,
        |_, requests| add(requests, NewLayer::Lines),
    ),
    row(
        "New hatching",
        &[],
        "Hatching or engraving along the form, its tone by a light that you can move",
        has_surface,
        |_, requests| add(requests, NewLayer::Hatching),
    ),
    row(
        "Bring out form",
        &[],
        "A layer that enhances the relief of everything beneath it (radiance scaling)",
        has_document,
        |_, requests| add(requests, NewLayer::RadianceScaling),
    ),
    row(
        "New detail normals",
        &[],
        "Adds grain or a normal map to the surface, for everything above it",
        has_document,
        |_, requests| add(requests, NewLayer::Normals),
    ),
];

const DRAWING: &[MenuCommand] = &[
    row(
        "Split part by area",
        &[],
        "Separate areas of the selected part's color, such as two eyes, become separate parts",
        |session| {
            session
                .active()
                .and_then(|open| open.selected_part())
                .is_some_and(|part| part.is_of_color())
        },
        |session, requests| {
            if let Some(part) = session.active().and_then(|open| open.selected_part()) {
                requests.act(Action::Part(PartAction::Split { part: part.id.clone() }));
            }
        },
    ),
    row(
        "Lines on top",
        &[],
        "A layer above all others shows the ink of the selected one as it was drawn; light falls on what lies beneath",
        has_layer,
        |session, requests| {
            let lines = session.layer_path().map(|layer| Action::Part(PartAction::Ink { layer }));
            requests.actions.extend(lines);
        },
    ),
    row(
        "Make paper transparent",
        &[],
        "The paper of a scan becomes transparent, and its pencil or ink lines stand on top of all layers",
        has_layer,
        |session, requests| {
            let bare = session.layer_path().map(|layer| Action::Part(PartAction::Paper { layer }));
            requests.actions.extend(bare);
        },
    ),
    row(
        "Make strokes",
        &[],
        "The lines that were drawn by the form become strokes, to be edited one by one",
        has_form_drawing,
        |session, requests| {
            let made = session.layer_path().map(|layer| LayerAction::MakeStrokes { layer });
            made.into_iter().for_each(|made| requests.act(Action::Layer(made)));
        },
    ),
    row(
        "Cut drawing by parts",
        &[],
        "Divides the selected layer into a layer for each part, so that a part moves with its \
         paint",
        has_layer,
        |session, requests| {
            let cut = session.layer_path().map(|layer| Action::Part(PartAction::Cut { layer }));
            requests.actions.extend(cut);
        },
    ),
];

const ORDER: &[MenuCommand] = &[
    row(
        "Move layer up",
        &[ctrl(Key::PageUp)],
        "Moves the selected layers above the next one",
        has_layer,
        |session, requests| {
            with_selected(session, requests, |layer| LayerAction::Nudge { layer, by: 1 })
        },
    ),
    row(
        "Move layer down",
        &[ctrl(Key::PageDown)],
        "Moves the selected layers below the next one",
        has_layer,
        |session, requests| {
            with_selected(session, requests, |layer| LayerAction::Nudge { layer, by: -1 })
        },
    ),
    LINE,
    row(
        "Layer above",
        &[key(Key::PageUp)],
        "Selects the next layer of the list upward",
        has_layer,
        |session, requests| step(session, requests, 1, false),
    ),
    row(
        "Layer below",
        &[key(Key::PageDown)],
        "Selects the next layer of the list downward",
        has_layer,
        |session, requests| step(session, requests, -1, false),
    ),
    row(
        "Select layer above too",
        &[shift(Key::PageUp)],
        "Extends the selection of layers upward",
        has_layer,
        |session, requests| step(session, requests, 1, true),
    ),
    row(
        "Select layer below too",
        &[shift(Key::PageDown)],
        "Extends the selection of layers downward",
        has_layer,
        |session, requests| step(session, requests, -1, true),
    ),
];

const MASK: &[MenuCommand] = &[
    row(
        "Paint on mask",
        &[],
        "Switches the brush between the layer and its mask (white shows, black hides); adds a mask if there is none",
        has_layer,
        |session, requests| {
            let mask = session.layer().and_then(|layer| layer.mask.clone());
            let is_on = is_on_mask(session);
            with_active_layer(session, requests, |layer| match mask {
                Some(mask) if matches!(mask.kind, MaskKind::File { .. }) => LayerAction::OnMask { layer, on: !is_on },
                _ => LayerAction::PaintMask { layer, hides: false },
            });
        },
    )
    .ticked(|session, _| is_on_mask(session)),
    row("Mask from a picture…", &[], "Light parts of the picture show the layer", has_layer, |_, requests| {
        requests.request(WindowRequest::Choose(FilePurpose::Part(PicturePart::Mask)))
    }),
    row("Invert mask", &[], "Shows what the mask hides, and hides what it shows", has_mask, |session, requests| {
        let on = !is_so_of_mask(session, |mask| mask.invert);
        set(session, requests, Property::MaskInverted { on });
    })
    .ticked(|session, _| is_so_of_mask(session, |mask| mask.invert)),
    row("Use mask", &[], "Disables the mask, or enables it again", has_mask, |session, requests| {
        let on = is_so_of_mask(session, |mask| !mask.disabled);
        set(session, requests, Property::MaskDisabled { on });
    })
    .ticked(|session, _| is_so_of_mask(session, |mask| !mask.disabled)),
    row("Delete mask", &[], "Removes the mask: the whole layer is visible again", has_mask, |session, requests| {
        set(session, requests, Property::Mask { mask: None })
    }),
];
