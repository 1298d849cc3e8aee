//! Effects of the selected layer. Floor 7.

use super::row::{MenuCommand, has_layer, row};
use crate::paint::{EffectKind, LayerEffect};
use crate::requests::UiRequests;
use crate::session::actions::LayerAction;
use crate::session::{Action, Property, Session};
use eframe::egui::KeyboardShortcut;
use std::sync::Arc;

const NO_KEYS: &[KeyboardShortcut] = &[];

fn add(session: &Session, requests: &mut UiRequests, name: &str) {
    let found = session.layer().zip(EffectKind::from_name(name));
    let Some((layer, kind)) = found else { return };
    let mut effects = layer.effects.to_vec();
    effects.push(LayerEffect::new(kind));
    set(session, requests, effects);
}

fn set(session: &Session, requests: &mut UiRequests, effects: Vec<LayerEffect>) {
    let to = Property::Effects { effects };
    let layer = session.layer_paths();
    requests.act(Action::Layer(LayerAction::Set { layer, to, done: true }));
}

/// The effects of the selected layer, given to all that are selected.
fn spread(session: &Session, requests: &mut UiRequests) {
    let Some(layer) = session.layer() else { return };
    set(session, requests, Arc::clone(&layer.effects).to_vec());
}

fn clear(session: &Session, requests: &mut UiRequests) {
    set(session, requests, Vec::new());
}

fn has_effects(session: &Session) -> bool {
    session.layer().is_some_and(|layer| !layer.effects.is_empty())
}

/// Declares the menu: the name in documents, of the command, and what it does.
macro_rules! commands {
    ($($name:literal, $command:literal, $hint:literal;)+) => {
        pub const COMMANDS: &[MenuCommand] = &[
            $(row($command, NO_KEYS, $hint, has_layer, |session, requests| add(session, requests, $name)),)+
            row(
                "Give effects to selected layers",
                NO_KEYS,
                "All selected layers get the effects of the one selected last",
                has_effects,
                spread,
            ),
            row("Remove effects", NO_KEYS, "Of all selected layers", has_effects, clear),
        ];
    };
}

commands! {
    "drop-shadow", "Add drop shadow", "The layer darkens what lies beneath it";
    "outer-glow", "Add outer glow", "Light around the layer";
    "pattern-overlay", "Add pattern overlay", "A repeated picture on the layer";
    "gradient-overlay", "Add gradient overlay", "A ramp of colors on the layer";
    "color-overlay", "Add color overlay", "One color on the layer";
    "satin", "Add satin", "The layer's own shape, blurred and folded, as on silk";
    "inner-glow", "Add inner glow", "Light along the layer's edge or from its middle";
    "inner-shadow", "Add inner shadow", "The layer looks cut out of what is around it";
    "stroke", "Add stroke", "A line along the layer's edge";
    "bevel", "Add bevel", "Light and shade on slanted edges";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_effect_has_its_command_in_order() {
        for ((kind, label), command) in EffectKind::LABELS.iter().zip(COMMANDS) {
            assert_eq!(command.name, format!("Add {}", label.to_lowercase()));
            assert_eq!(command.hint, kind.hint());
        }
        assert_eq!(COMMANDS.len(), EffectKind::LABELS.len() + 2);
    }
}
