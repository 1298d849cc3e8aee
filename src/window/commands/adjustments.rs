//! Adjustments: new layers, and the same done to paint. Floor 7.

use super::row::{MenuCommand, ctrl, has_document, has_paint, row};
use crate::paint::ColorAdjustment;
use crate::requests::{PaintChange, UiRequests, WindowRequest};
use crate::session::actions::LayerAction;
use crate::session::{Action, Session};
use eframe::egui::{Key, KeyboardShortcut};

fn add(requests: &mut UiRequests, name: &str) {
    let adjustment = ColorAdjustment::from_name(name);
    let add = |adjustment| Action::Layer(LayerAction::AddAdjustment { adjustment });
    requests.actions.extend(adjustment.map(add));
}

/// At once if there is nothing to set, else by a dialog.
fn adjust(session: &Session, requests: &mut UiRequests, name: &str) {
    match ColorAdjustment::from_name(name) {
        Some(adjustment @ ColorAdjustment::Invert(_)) => {
            let layer = session.layer_paths();
            let act = LayerAction::Adjust { layer, adjustment, done: true };
            requests.act(Action::Layer(act));
        }
        Some(adjustment) => {
            let change = PaintChange::Adjust(adjustment);
            requests.request(WindowRequest::PaintChangeDialog(Box::new(change)));
        }
        None => {}
    }
}

const NO_KEYS: &[KeyboardShortcut] = &[];

/// Declares both menus: the name in documents, of the layer's command, of the command on paint, its
/// keys, and what it does.
macro_rules! commands {
    ($($name:literal, $layer:literal, $paint:literal, $keys:expr, $hint:literal;)+) => {
        pub const LAYERS: &[MenuCommand] = &[$(
            row($layer, NO_KEYS, $hint, has_document, |_, requests| add(requests, $name)),
        )+];
        pub const PAINT: &[MenuCommand] = &[$(
            row($paint, $keys, $hint, has_paint, |session, requests| adjust(session, requests, $name)),
        )+];
    };
}

commands! {
    "brightness-contrast", "New brightness/contrast layer", "Brightness/contrast…", NO_KEYS,
        "Brighter or darker, with more or less contrast";
    "levels", "New levels layer", "Levels…", &[ctrl(Key::L)],
        "What becomes black and what white, and the mid-tones between";
    "curves", "New curves layer", "Curves…", &[ctrl(Key::M)],
        "Each tone by a curve, of all channels or of one";
    "exposure", "New exposure layer", "Exposure…", NO_KEYS, "More or less light, in stops";
    "vibrance", "New vibrance layer", "Vibrance…", NO_KEYS, "More saturation where there is little";
    "hue-saturation", "New hue/saturation layer", "Hue/saturation…", &[ctrl(Key::U)],
        "Hue, saturation and lightness, of all colors or of a range; or one hue";
    "color-balance", "New color balance layer", "Color balance…", &[ctrl(Key::B)],
        "Warmer or cooler, in shadows, mid-tones and highlights";
    "black-white", "New black & white layer", "Black & white…", NO_KEYS,
        "Grays, with a brightness for each hue";
    "photo-filter", "New photo filter layer", "Photo filter…", NO_KEYS,
        "A colored glass in front of the picture";
    "channel-mixer", "New channel mixer layer", "Channel mixer…", NO_KEYS,
        "Each channel as a sum of all three";
    "color-lookup", "New color look-up layer", "Color look-up…", NO_KEYS,
        "The colors of a .cube file";
    "invert", "New invert layer", "Invert colors", &[ctrl(Key::I)],
        "Light becomes dark, and each color its complement";
    "posterize", "New posterize layer", "Posterize…", NO_KEYS, "A few tones of each channel";
    "threshold", "New threshold layer", "Threshold…", NO_KEYS,
        "Black and white only";
    "gradient-map", "New gradient map layer", "Gradient map…", NO_KEYS,
        "A color of a gradient for each brightness";
    "selective-color", "New selective color layer", "Selective color…", NO_KEYS,
        "Cyan, magenta, yellow and black for each range of colors";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_adjustment_has_its_commands_in_order() {
        let all = ColorAdjustment::all();
        assert_eq!((LAYERS.len(), PAINT.len()), (all.len(), all.len()));
        for ((adjustment, layer), paint) in all.iter().zip(LAYERS).zip(PAINT) {
            assert_eq!((layer.hint, paint.hint), (adjustment.hint(), adjustment.hint()));
            let label = adjustment.label();
            assert_eq!(layer.name, format!("New {} layer", label.to_lowercase()));
            assert!(paint.name.starts_with(label), "{}", paint.name);
        }
    }
}
