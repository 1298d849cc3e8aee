//! The keymap: the default keys of commands and tools, those of a preset, and those the user chose
//! instead. Floor 7. `keys` handles key presses.

mod presets;

pub use presets::KeyPreset;

use super::commands::{self, MenuCommand};
use crate::language::{find_translation, tr};
use crate::tools::ToolKind;
use eframe::egui::{Context, Key, KeyboardShortcut, Modifiers};
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// The keys chosen by the user, by the name of the command or the label of the tool; all others
/// have those of the preset.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Keymap {
    preset: KeyPreset,
    /// Where the preset differs from the default keys.
    of_preset: BTreeMap<&'static str, Vec<KeyboardShortcut>>,
    custom: BTreeMap<String, Vec<KeyboardShortcut>>,
}

/// A command or tool that can have keys.
#[derive(Clone, Copy)]
pub enum KeyTarget {
    Command(&'static MenuCommand),
    Tool(ToolKind),
}

impl KeyTarget {
    /// Everything that can have keys, tools first.
    pub fn all() -> impl Iterator<Item = KeyTarget> {
        let commands = commands::all().map(KeyTarget::Command);
        ToolKind::ALL.into_iter().map(|(tool, _)| KeyTarget::Tool(tool)).chain(commands)
    }

    pub fn name(self) -> &'static str {
        match self {
            KeyTarget::Command(command) => command.name,
            KeyTarget::Tool(tool) => tool.label(),
        }
    }

    pub fn hint(self) -> &'static str {
        match self {
            KeyTarget::Command(command) => command.hint,
            KeyTarget::Tool(tool) => tool.hint(),
        }
    }

    /// Its default keys.
    fn default_keys(self) -> Vec<KeyboardShortcut> {
        match self {
            KeyTarget::Command(command) => command.keys.to_vec(),
            KeyTarget::Tool(tool) => {
                let held = if tool.is_key_shifted() { Modifiers::SHIFT } else { Modifiers::NONE };
                let key = Key::from_name(&tool.key().to_string());
                key.into_iter().map(|key| KeyboardShortcut::new(held, key)).collect()
            }
        }
    }
}

/// What a preset changes: its own rows, and what lost a default key to one of them.
fn differences(preset: KeyPreset) -> BTreeMap<&'static str, Vec<KeyboardShortcut>> {
    let rows: BTreeMap<&str, Vec<KeyboardShortcut>> = preset
        .rows()
        .iter()
        .map(|(name, keys)| (*name, keys.iter().filter_map(|keys| read(keys)).collect()))
        .collect();
    let is_taken = |keys: &KeyboardShortcut| rows.values().any(|taken| taken.contains(keys));
    let changed = |keyed: KeyTarget| {
        let keys = match rows.get(keyed.name()) {
            Some(keys) => keys.clone(),
            None => keyed.default_keys().into_iter().filter(|keys| !is_taken(keys)).collect(),
        };
        (keys != keyed.default_keys()).then_some((keyed.name(), keys))
    };
    KeyTarget::all().filter_map(changed).collect()
}

impl Keymap {
    pub fn of(&self, keyed: KeyTarget) -> Vec<KeyboardShortcut> {
        self.custom.get(keyed.name()).cloned().unwrap_or_else(|| self.usual(keyed))
    }

    /// Its keys in the preset.
    fn usual(&self, keyed: KeyTarget) -> Vec<KeyboardShortcut> {
        self.of_preset.get(keyed.name()).cloned().unwrap_or_else(|| keyed.default_keys())
    }

    pub fn preset(&self) -> KeyPreset {
        self.preset
    }

    /// Takes all keys of a preset; what the user chose is dropped.
    pub fn with_preset(preset: KeyPreset) -> Self {
        Self { preset, of_preset: differences(preset), custom: BTreeMap::new() }
    }

    /// Whether the user changed anything of the preset.
    pub fn is_changed(&self) -> bool {
        !self.custom.is_empty()
    }

    /// The first key of a command, which menus show.
    pub fn first(&self, command: &'static MenuCommand) -> Option<KeyboardShortcut> {
        self.of(KeyTarget::Command(command)).first().copied()
    }

    pub fn is_custom(&self, keyed: KeyTarget) -> bool {
        self.custom.contains_key(keyed.name())
    }

    /// Sets the keys; those of the preset are not stored.
    pub fn set(&mut self, keyed: KeyTarget, keys: Vec<KeyboardShortcut>) {
        if keys == self.usual(keyed) {
            self.custom.remove(keyed.name());
        } else {
            self.custom.insert(keyed.name().to_owned(), keys);
        }
    }

    pub fn reset(&mut self, keyed: KeyTarget) {
        self.custom.remove(keyed.name());
    }

    /// What else has this key.
    pub fn conflict(&self, keys: KeyboardShortcut, except: KeyTarget) -> Option<KeyTarget> {
        KeyTarget::all()
            .find(|other| other.name() != except.name() && self.of(*other).contains(&keys))
    }

    /// Takes a key from its present owner, and assigns it.
    pub fn take(&mut self, keys: KeyboardShortcut, to: KeyTarget) {
        while let Some(other) = self.conflict(keys, to) {
            let left = self.of(other).into_iter().filter(|known| *known != keys).collect();
            self.set(other, left);
        }
        let mut of = self.of(to);
        if !of.contains(&keys) {
            of.push(keys);
        }
        self.set(to, of);
    }

    pub fn to_json(&self) -> Value {
        let text = |keys: &Vec<KeyboardShortcut>| {
            keys.iter().map(|&keys| Value::from(write_keys(keys))).collect()
        };
        Value::Object(
            self.custom
                .iter()
                .map(|(name, keys)| (name.clone(), Value::Array(text(keys))))
                .collect(),
        )
    }

    /// Unknown entries are left out.
    pub fn from_json(preset: KeyPreset, value: &Map<String, Value>) -> Self {
        let known = |name: &str| KeyTarget::all().any(|keyed| keyed.name() == name);
        let keys = |list: &Value| -> Option<Vec<KeyboardShortcut>> {
            list.as_array()?.iter().map(|keys| read(keys.as_str()?)).collect()
        };
        let custom = value.iter().filter(|(name, _)| known(name));
        Self {
            custom: custom.filter_map(|(name, list)| Some((name.clone(), keys(list)?))).collect(),
            ..Self::with_preset(preset)
        }
    }
}

/// A key for display: “Ctrl+[”, with the system's names of modifiers, in the language of the window.
pub fn key_text(ctx: &Context, keys: KeyboardShortcut) -> String {
    let (text, key) = (ctx.format_shortcut(&keys), keys.logical_key);
    let Some(held) = text.strip_suffix(key.name()) else { return text };
    // The toolkit writes “OpenBracket”; its arrows are not in every font.
    let symbol = key.symbol_or_name();
    let shown = if symbol.is_ascii() { symbol } else { key.name() };
    // Letters and digits are the same in all languages.
    let shown = if shown.len() > 1 { tr_key(shown) } else { shown };
    let held = held.split_inclusive('+').map(|word| match word.strip_suffix('+') {
        Some(word) => format!("{}+", tr_key(word)),
        None => tr_key(word).to_owned(),
    });
    held.chain([shown.to_owned()]).collect()
}

/// What is written on a key, in the current language.
fn tr_key(name: &str) -> &str {
    match name {
        "Shift" => tr("Shift"),
        "Insert" => tr("Insert"),
        // The key, not what it does.
        "Delete" => find_translation("Delete key").unwrap_or("Delete"),
        "PageUp" => tr("PageUp"),
        "PageDown" => tr("PageDown"),
        "Minus" => "-",
        other => tr(other),
    }
}

/// “Ctrl+Shift+Z”, the same on every system.
fn write_keys(keys: KeyboardShortcut) -> String {
    let Modifiers { alt, shift, command, .. } = keys.modifiers;
    let mut text = String::new();
    for (is_held, word) in [(command, "Ctrl+"), (alt, "Alt+"), (shift, "Shift+")] {
        text.push_str(if is_held { word } else { "" });
    }
    text + keys.logical_key.name()
}

fn read(text: &str) -> Option<KeyboardShortcut> {
    let (mut modifiers, mut rest) = (Modifiers::NONE, text);
    for (word, modifier) in
        [("Ctrl+", Modifiers::COMMAND), ("Alt+", Modifiers::ALT), ("Shift+", Modifiers::SHIFT)]
    {
        if let Some(after) = rest.strip_prefix(word) {
            (modifiers, rest) = (modifiers.plus(modifier), after);
        }
    }
    Some(KeyboardShortcut::new(modifiers, Key::from_name(rest)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(name: &str) -> KeyTarget {
        KeyTarget::all().find(|keyed| keyed.name() == name).unwrap()
    }

    #[test]
    fn every_key_survives_being_written_and_read() {
        for keyed in KeyTarget::all() {
            for keys in keyed.default_keys() {
                assert_eq!(read(&write_keys(keys)), Some(keys), "{}", write_keys(keys));
            }
        }
        assert_eq!(read("Ctrl+Nothing"), None);
    }

    #[test]
    fn a_key_that_is_taken_is_gone_from_where_it_was() {
        let mut keymap = Keymap::default();
        let [brush, save] = ["Brush", "Save"].map(named);
        let of_brush = keymap.of(brush)[0];
        assert_eq!(keymap.conflict(of_brush, save).unwrap().name(), "Brush");
        keymap.take(of_brush, save);
        assert!(keymap.of(brush).is_empty() && keymap.of(save).contains(&of_brush));
        let json = keymap.to_json();
        assert_eq!(Keymap::from_json(KeyPreset::Rilievo, json.as_object().unwrap()), keymap);
        keymap.reset(brush);
        keymap.reset(save);
        assert_eq!(keymap, Keymap::default());
    }
    #[test]
    fn every_row_of_a_preset_names_a_command_or_tool_and_keys_that_exist() {
        for (preset, _) in KeyPreset::ALL {
            for (name, keys) in preset.rows() {
                assert!(KeyTarget::all().any(|keyed| keyed.name() == *name), "no “{name}”");
                for keys in *keys {
                    assert!(read(keys).is_some(), "{name}: no key “{keys}”");
                }
            }
        }
    }

    #[test]
    fn no_two_commands_share_a_key_in_a_preset_and_none_loses_its_last() {
        for (preset, _) in KeyPreset::ALL {
            let keymap = Keymap::with_preset(preset);
            for keyed in KeyTarget::all() {
                let keys = keymap.of(keyed);
                let name = keyed.name();
                for one in &keys {
                    let other = keymap.conflict(*one, keyed).map(KeyTarget::name);
                    assert_eq!(other, None, "{preset:?}: {} of {name}", write_keys(*one));
                }
                let had = !keyed.default_keys().is_empty();
                assert!(!had || !keys.is_empty(), "{preset:?}: {name} has no key");
            }
        }
    }

    #[test]
    fn a_preset_is_changed_by_hand_and_comes_back_with_the_change() {
        let mut keymap = Keymap::with_preset(KeyPreset::Krita);
        let [picker, save] = ["Eyedropper", "Save"].map(named);
        assert_eq!(keymap.of(picker), [read("P").unwrap()]);
        assert!(!keymap.is_custom(picker), "a preset's key is not the user's");
        keymap.take(read("P").unwrap(), save);
        assert!(keymap.of(picker).is_empty() && keymap.is_changed());
        let json = keymap.to_json();
        assert_eq!(Keymap::from_json(KeyPreset::Krita, json.as_object().unwrap()), keymap);
        keymap.reset(picker);
        keymap.reset(save);
        assert_eq!(keymap, Keymap::with_preset(KeyPreset::Krita));
    }
}
