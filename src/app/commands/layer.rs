//! The Layer menu.
//! Floor 7.

use super::{Command, Menu, ctrl, ctrl_shift, has_document, has_layer, key, line};
use crate::app::asked::{Asked, WindowAsk};
use crate::app::files::Purpose;
use crate::document::{Content, Lock, MaskKind};
use crate::session::actions::pictures::Part;
use crate::session::actions::{LayerAction, NewLayer};
use crate::session::{Action, LayerPath, Property, Session};
use eframe::egui::{Key, KeyboardShortcut, Modifiers};

const MENU: Menu = Menu::Layer;

/// Does something with the selected layer.
fn with_selected(session: &Session, asked: &mut Asked, action: impl FnOnce(LayerPath) -> LayerAction) {
    asked.actions.extend(session.layer_path().map(action).map(Action::Layer));
}
fn set(session: &Session, asked: &mut Asked, to: Property) {
    with_selected(session, asked, |layer| LayerAction::Set { layer, to, done: true });
}
fn add(asked: &mut Asked, kind: NewLayer) {
    asked.act(Action::Layer(LayerAction::Add { kind }));
}
const fn ctrl_page(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND, key)
}
fn is_group(session: &Session) -> bool {
    session.layer().is_some_and(|layer| matches!(layer.content, Content::Group(_)))
}
fn has_mask(session: &Session) -> bool {
    session.layer().is_some_and(|layer| layer.mask.is_some())
}
fn is_live(session: &Session) -> bool {
    session.layer().is_some_and(|layer| !matches!(layer.content, Content::Pixels(_) | Content::RadianceScaling(_)))
}

pub const COMMANDS: &[Command] = &[
    Command {
        name: "New paint layer",
        menu: MENU,
        keys: &[key(Key::Insert), ctrl_shift(Key::N)],
        hint: "Pixels; strokes on it cannot be moved later, but it can be erased",
        can: has_document,
        run: |_, asked| add(asked, NewLayer::Paint),
    },
    Command {
        name: "New stroke layer",
        menu: MENU,
        keys: &[],
        hint: "Strokes stay strokes: each can be moved along the surface later",
        can: has_document,
        run: |_, asked| add(asked, NewLayer::Strokes),
    },
    Command {
        name: "New fill layer",
        menu: MENU,
        keys: &[],
        hint: "One colour everywhere",
        can: has_document,
        run: |_, asked| add(asked, NewLayer::Fill),
    },
    Command {
        name: "New gradient layer",
        menu: MENU,
        keys: &[],
        hint: "From the first colour to the second, bent by the operator in hand",
        can: has_document,
        run: |_, asked| add(asked, NewLayer::Gradient),
    },
    Command {
        name: "New radiance scaling",
        menu: MENU,
        keys: &[],
        hint: "Brings out the relief of whatever is painted beneath it",
        can: has_document,
        run: |_, asked| add(asked, NewLayer::RadianceScaling),
    },
    Command {
        name: "New detail normals",
        menu: MENU,
        keys: &[],
        hint: "Grain or a map of normals laid onto the surface, for everything above it",
        can: has_document,
        run: |_, asked| add(asked, NewLayer::Normals),
    },
    Command {
        name: "New group",
        menu: MENU,
        keys: &[],
        hint: "Layers flattened together",
        can: has_document,
        run: |_, asked| add(asked, NewLayer::Group),
    },
    line(MENU),
    Command {
        name: "Duplicate layer",
        menu: MENU,
        keys: &[ctrl(Key::J)],
        hint: "A copy above it",
        can: has_layer,
        run: |session, asked| with_selected(session, asked, |layer| LayerAction::Duplicate { layer }),
    },
    Command {
        name: "Delete layer",
        menu: MENU,
        keys: &[KeyboardShortcut::new(Modifiers::SHIFT, Key::Delete)],
        hint: "With all that is in it",
        can: has_layer,
        run: |session, asked| with_selected(session, asked, |layer| LayerAction::Delete { layer }),
    },
    Command {
        name: "Group layer",
        menu: MENU,
        keys: &[ctrl(Key::G)],
        hint: "Put the selected layer into a group of its own",
        can: has_layer,
        run: |session, asked| with_selected(session, asked, |layer| LayerAction::Group { layer }),
    },
    Command {
        name: "Ungroup",
        menu: MENU,
        keys: &[ctrl_shift(Key::G)],
        hint: "Take the layers out of the selected group",
        can: is_group,
        run: |session, asked| with_selected(session, asked, |layer| LayerAction::Ungroup { layer }),
    },
    Command {
        name: "Move layer up",
        menu: MENU,
        keys: &[ctrl_page(Key::PageUp)],
        hint: "Above the next one",
        can: has_layer,
        run: |session, asked| with_selected(session, asked, |layer| LayerAction::Nudge { layer, by: 1 }),
    },
    Command {
        name: "Move layer down",
        menu: MENU,
        keys: &[ctrl_page(Key::PageDown)],
        hint: "Beneath the next one",
        can: has_layer,
        run: |session, asked| with_selected(session, asked, |layer| LayerAction::Nudge { layer, by: -1 }),
    },
    line(MENU),
    Command {
        name: "Merge down",
        menu: MENU,
        keys: &[ctrl_shift(Key::M)],
        hint: "This layer and the one beneath it become one paint layer",
        can: has_layer,
        run: |session, asked| with_selected(session, asked, |layer| LayerAction::MergeDown { layer }),
    },
    Command {
        name: "Bake layer",
        menu: MENU,
        keys: &[ctrl_shift(Key::B)],
        hint: "A live layer becomes paint: as it looks now, and no longer bent when the surface changes",
        can: is_live,
        run: |session, asked| with_selected(session, asked, |layer| LayerAction::Bake { layer }),
    },
    Command {
        name: "Flatten picture",
        menu: MENU,
        keys: &[ctrl_shift(Key::E)],
        hint: "All that shows becomes one paint layer",
        can: has_layer,
        run: |_, asked| asked.act(Action::Layer(LayerAction::Flatten {})),
    },
    line(MENU),
    Command {
        name: "Paint on mask",
        menu: MENU,
        keys: &[],
        hint: "The brush changes the mask of the layer, made if there is none: white shows, black hides. Or the layer again",
        can: has_layer,
        run: |session, asked| {
            let mask = session.layer().and_then(|layer| layer.mask.clone());
            let is_on = session.tab().is_some_and(|tab| tab.on_mask);
            with_selected(session, asked, |layer| match mask {
                Some(mask) if matches!(mask.kind, MaskKind::File { .. }) => LayerAction::OnMask { layer, on: !is_on },
                _ => LayerAction::PaintMask { layer, hides: false },
            });
        },
    },
    Command {
        name: "Mask from a picture…",
        menu: MENU,
        keys: &[],
        hint: "Its light parts show the layer",
        can: has_layer,
        run: |_, asked| asked.ask(WindowAsk::Choose(Purpose::Part(Part::Mask))),
    },
    Command {
        name: "Invert mask",
        menu: MENU,
        keys: &[],
        hint: "Show what it hides, and hide what it shows",
        can: has_mask,
        run: |session, asked| {
            let on = session.layer().is_some_and(|layer| layer.mask.as_ref().is_some_and(|mask| !mask.invert));
            set(session, asked, Property::MaskInverted { on });
        },
    },
    Command {
        name: "Use mask",
        menu: MENU,
        keys: &[],
        hint: "Put the mask aside, or use it again",
        can: has_mask,
        run: |session, asked| {
            let on = session.layer().is_some_and(|layer| layer.mask.as_ref().is_some_and(|mask| !mask.disabled));
            set(session, asked, Property::MaskDisabled { on });
        },
    },
    Command {
        name: "Delete mask",
        menu: MENU,
        keys: &[],
        hint: "The layer shows whole again",
        can: has_mask,
        run: |session, asked| set(session, asked, Property::Mask { mask: None }),
    },
    line(MENU),
    Command {
        name: "Show or hide layer",
        menu: MENU,
        keys: &[],
        hint: "The eye of the selected layer",
        can: has_layer,
        run: |session, asked| {
            let on = session.layer().is_some_and(|layer| !layer.visible);
            set(session, asked, Property::Visible { on });
        },
    },
    Command {
        name: "Show layer alone",
        menu: MENU,
        keys: &[],
        hint: "Hide all others until it is chosen again",
        can: has_layer,
        run: |session, asked| with_selected(session, asked, |layer| LayerAction::Solo { layer }),
    },
    Command {
        name: "Clip to layer below",
        menu: MENU,
        keys: &[KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::ALT), Key::G)],
        hint: "Paint only where the layer beneath has paint",
        can: has_layer,
        run: |session, asked| {
            let on = session.layer().is_some_and(|layer| !layer.clip_below);
            set(session, asked, Property::ClipBelow { on });
        },
    },
    Command {
        name: "Lock alpha",
        menu: MENU,
        keys: &[key(Key::Slash)],
        hint: "Paint only where the layer has paint already",
        can: has_layer,
        run: |session, asked| {
            let is_locked = session.layer().is_some_and(|layer| layer.lock == Lock::Alpha);
            set(session, asked, Property::Locked { lock: if is_locked { Lock::None } else { Lock::Alpha } });
        },
    },
    Command {
        name: "Lock layer",
        menu: MENU,
        keys: &[],
        hint: "No tool changes it",
        can: has_layer,
        run: |session, asked| {
            let is_locked = session.layer().is_some_and(|layer| layer.lock == Lock::All);
            set(session, asked, Property::Locked { lock: if is_locked { Lock::None } else { Lock::All } });
        },
    },
];
