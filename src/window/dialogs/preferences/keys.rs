//! The keys: every command and tool with its keys, which can be changed; conflicts are shown before a
//! key is reassigned. Presets have the keys of other programs. Floor 7.

use crate::keymap::{KeyPreset, KeyTarget, Keymap, key_text};
use crate::language::tr;
use crate::tr;
use crate::widgets::{choice, list, name, set_accessible_name};
use eframe::egui::{Event, Grid, Key, KeyboardShortcut, Modifiers, RichText, TextEdit, Ui};

#[derive(Default)]
pub struct KeysPage {
    filter: String,
    /// A preset that waits for an answer.
    preset: Option<KeyPreset>,
    /// What waits for a key.
    waiting: Option<&'static str>,
    /// A pressed key that already belongs to something else.
    conflict: Option<(&'static str, KeyboardShortcut)>,
}

/// What the mouse and held keys do on the canvas.
pub const ON_CANVAS: [(&str, &str); 12] = [
    ("Move the view", "Space and drag, or the middle button"),
    ("Zoom", "Wheel, or Ctrl and Space and drag"),
    ("Turn the view", "Shift and Space and drag"),
    ("Pan with the wheel", "Shift or Alt and the wheel"),
    ("Brush size", "Drag with the right button"),
    ("Straight line", "Shift and click with the brush"),
    ("Take a color", "Ctrl or Alt and click with the brush; the page Colors says which"),
    ("Content under an anchor", "Ctrl and drag with the anchor tool"),
    ("Re-pin an anchor", "Shift and drag with the anchor tool"),
    ("Remove an anchor", "Alt and click with the anchor tool"),
    ("Scale, turn an image", "Shift, Ctrl and drag with the image tool"),
    ("Cancel a stroke", "Escape"),
];

impl KeysPage {
    pub fn show(&mut self, ui: &mut Ui, keymap: &mut Keymap) {
        self.presets(ui, keymap);
        let field = ui.add(
            TextEdit::singleline(&mut self.filter)
                .hint_text(tr("Find"))
                .desired_width(f32::INFINITY),
        );
        set_accessible_name(&field, tr("Find a shortcut"));
        self.listen(ui, keymap);
        self.request(ui, keymap);
        let wanted = self.filter.to_lowercase();
        let is_in = |name: &str| name.to_lowercase().contains(&wanted);
        let shown = |name: &str| is_in(tr(name)) || is_in(name);
        list(ui, super::PAGE_PT - 76.0).auto_shrink([false, false]).show(ui, |ui| {
            Grid::new("shortcuts").num_columns(2).striped(true).spacing([24.0, 4.0]).show(
                ui,
                |ui| {
                    for keyed in KeyTarget::all().filter(|keyed| shown(keyed.name())) {
                        ui.label(tr(keyed.name())).on_hover_text(tr(keyed.hint()));
                        ui.horizontal(|ui| self.keys(ui, keymap, keyed));
                        ui.end_row();
                    }
                    for (what, how) in ON_CANVAS.iter().filter(|(what, _)| shown(what)) {
                        ui.label(tr(what));
                        ui.label(tr(how));
                        ui.end_row();
                    }
                },
            );
        });
    }

    /// The presets; those that would drop the user's own keys ask first.
    fn presets(&mut self, ui: &mut Ui, keymap: &mut Keymap) {
        ui.horizontal(|ui| {
            name(ui, "Preset");
            let now = self.preset.unwrap_or(keymap.preset());
            let chosen = choice(ui, "Preset of keys", now, &KeyPreset::LABELS);
            if let Some(preset) = chosen {
                self.preset = Some(preset);
            }
            if keymap.is_changed() && self.preset.is_none() {
                ui.weak(tr("with your own keys"));
                if ui
                    .button(tr("Drop them"))
                    .on_hover_text(tr("All keys as in the preset"))
                    .clicked()
                {
                    *keymap = Keymap::with_preset(keymap.preset());
                }
            }
        });
        let Some(preset) = self.preset else { return };
        if preset == keymap.preset() || !keymap.is_changed() {
            if preset != keymap.preset() {
                *keymap = Keymap::with_preset(preset);
            }
            return self.preset = None;
        }
        ui.horizontal_wrapped(|ui| {
            let text = tr("The preset replaces the keys that you chose yourself.");
            ui.label(RichText::new(text).color(ui.visuals().warn_fg_color));
            if ui.button(tr("Replace them")).clicked() {
                *keymap = Keymap::with_preset(preset);
                self.preset = None;
            }
            if ui.button(tr("Keep mine")).clicked() {
                self.preset = None;
            }
        });
    }

    /// The keys of one command or tool, and the buttons to change them.
    fn keys(&mut self, ui: &mut Ui, keymap: &mut Keymap, keyed: KeyTarget) {
        let name = keyed.name();
        let keys = keymap.of(keyed);
        for &one in &keys {
            let text = key_text(ui.ctx(), one);
            let response =
                ui.button(RichText::new(&text).monospace()).on_hover_text(tr("Click to remove it"));
            set_accessible_name(&response, &tr!("{keys} of {name}", keys = text, name = tr(name)));
            if response.clicked() {
                keymap.set(keyed, keys.iter().copied().filter(|known| *known != one).collect());
            }
        }
        let is_waiting = self.waiting == Some(name);
        let response =
            ui.selectable_label(is_waiting, if is_waiting { tr("Press a key…") } else { "+" });
        set_accessible_name(&response, &tr!("Add a key to {name}", name = tr(name)));
        if response.on_hover_text(tr("Then press the key; Escape cancels")).clicked() {
            (self.waiting, self.conflict) = (Some(name), None);
        }
        if keymap.is_custom(keyed) {
            let response = ui.small_button(tr("Reset")).on_hover_text(tr("The keys of the preset"));
            set_accessible_name(&response, &tr!("Reset {name}", name = tr(name)));
            if response.clicked() {
                keymap.reset(keyed);
            }
        }
    }

    /// Takes the key that is being waited for.
    fn listen(&mut self, ui: &Ui, keymap: &mut Keymap) {
        let Some(keyed) = self.waiting.and_then(find_target) else { return };
        let pressed = ui.input_mut(|i| {
            let at = i
                .events
                .iter()
                .position(|event| matches!(event, Event::Key { pressed: true, .. }))?;
            // Escape must not close the dialog, nor Tab move the focus.
            let Event::Key { key, modifiers, .. } = i.events.remove(at) else { return None };
            i.events.retain(|event| !matches!(event, Event::Text(_)));
            Some((key, modifiers))
        });
        let Some((key, held)) = pressed else { return };
        self.waiting = None;
        if key == Key::Escape {
            return;
        }
        let mut modifiers = Modifiers::NONE;
        for (is_held, modifier) in [
            (held.command, Modifiers::COMMAND),
            (held.alt, Modifiers::ALT),
            (held.shift, Modifiers::SHIFT),
        ] {
            modifiers = if is_held { modifiers.plus(modifier) } else { modifiers };
        }
        let keys = KeyboardShortcut::new(modifiers, key);
        match keymap.conflict(keys, keyed) {
            Some(_) => self.conflict = Some((keyed.name(), keys)),
            None => keymap.take(keys, keyed),
        }
    }

    /// Asks whether a key may be reassigned.
    fn request(&mut self, ui: &mut Ui, keymap: &mut Keymap) {
        let Some((name, keys)) = self.conflict else { return };
        let Some(keyed) = find_target(name) else { return };
        let Some(other) = keymap.conflict(keys, keyed) else { return self.conflict = None };
        ui.horizontal_wrapped(|ui| {
            let text = tr!(
                "{keys} belongs to “{owner}”.",
                keys = key_text(ui.ctx(), keys),
                owner = tr(other.name())
            );
            ui.label(RichText::new(text).color(ui.visuals().warn_fg_color));
            if ui.button(tr!("Give it to “{name}”", name = tr(name))).clicked() {
                keymap.take(keys, keyed);
                self.conflict = None;
            }
            if ui.button(tr("Keep it")).clicked() {
                self.conflict = None;
            }
        });
    }
}

fn find_target(name: &str) -> Option<KeyTarget> {
    KeyTarget::all().find(|keyed| keyed.name() == name)
}
