//! The keymap: the default keys of commands and tools, and those the user chose instead. Floor 7.
//! `keys` handles key presses.

use super::commands::{self, MenuCommand};
use crate::tools::ToolKind;
use eframe::egui::{Context, Key, KeyboardShortcut, Modifiers};
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// The keys chosen by the user, by the name of the command or the label of the tool; all others
/// keep their defaults.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Keymap {
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

impl Keymap {
    pub fn of(&self, keyed: KeyTarget) -> Vec<KeyboardShortcut> {
        self.custom.get(keyed.name()).cloned().unwrap_or_else(|| keyed.default_keys())
    }

    /// The first key of a command, which menus show.
    pub fn first(&self, command: &'static MenuCommand) -> Option<KeyboardShortcut> {
        self.of(KeyTarget::Command(command)).first().copied()
    }

    pub fn is_custom(&self, keyed: KeyTarget) -> bool {
        self.custom.contains_key(keyed.name())
    }

    /// Sets the keys; default ones are not stored.
    pub fn set(&mut self, keyed: KeyTarget, keys: Vec<KeyboardShortcut>) {
        if keys == keyed.default_keys() {
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
    pub fn from_json(value: &Map<String, Value>) -> Self {
        let known = |name: &str| KeyTarget::all().any(|keyed| keyed.name() == name);
        let keys = |list: &Value| -> Option<Vec<KeyboardShortcut>> {
            list.as_array()?.iter().map(|keys| read(keys.as_str()?)).collect()
        };
        let custom = value.iter().filter(|(name, _)| known(name));
        Self {
            custom: custom.filter_map(|(name, list)| Some((name.clone(), keys(list)?))).collect(),
        }
    }
}

/// A key for display: “Ctrl+[”, with the system's names of modifiers.
pub fn key_text(ctx: &Context, keys: KeyboardShortcut) -> String {
    let (text, key) = (ctx.format_shortcut(&keys), keys.logical_key);
    // The toolkit writes “OpenBracket”; its arrows are not in every font.
    match text.strip_suffix(key.name()) {
        Some(held) if key.symbol_or_name().is_ascii() => format!("{held}{}", key.symbol_or_name()),
        _ => text,
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
        assert_eq!(Keymap::from_json(json.as_object().unwrap()), keymap);
        keymap.reset(brush);
        keymap.reset(save);
        assert_eq!(keymap, Keymap::default());
    }
}
