//! What the user prefers: a row for each choice, which the settings file and the dialog of
//! preferences ask. Floor 7. Not here: the file (`settings`), the dialog (`dialogs::preferences`),
//! keys (`keymap`), the places of panels (`panel_layout`).

use crate::math::{NumberSetting, Vec2, named::current_name, vec2};
use crate::paint::Curve;
use eframe::egui::{Modifiers, PointerButton};
use serde_json::{Map, Value, json};

rilievo_engine::named! {
    /// A page of the dialog of preferences.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum PreferencePage {
        #[default]
        Interface = "Interface",
        Keys = "Keys",
        Pen = "Pen",
        Colors = "Colors",
        Files = "Files",
        Memory = "Memory",
    }
}

rilievo_engine::named! {
    /// The keys that take a color from the canvas while they are held with a brush in hand.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum PickKeys {
        #[default]
        Both = "ctrl or alt" => "Ctrl or Alt",
        Ctrl = "ctrl" => "Ctrl",
        Alt = "alt" => "Alt",
    }
}

impl PickKeys {
    /// Whether such a key is held, and nothing else.
    pub fn are_held(self, held: Modifiers) -> bool {
        let (ctrl, alt) = (held.command && !held.alt, held.alt && !held.command);
        !held.shift
            && match self {
                Self::Both => ctrl || alt,
                Self::Ctrl => ctrl,
                Self::Alt => alt,
            }
    }
}

rilievo_engine::named! {
    /// What a button on the barrel of a pen does over the canvas.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum BarrelAction {
        Size = "brush size" => "Brush size",
        Pan = "pan" => "Move the view",
        Turn = "turn" => "Turn the view",
        Pick = "color" => "Take a color",
        Erase = "erase" => "Erase",
        Undo = "undo" => "Undo",
        Nothing = "nothing" => "Nothing",
    }
}

/// A button on the barrel of a pen: the system takes it for one of a mouse.
pub struct BarrelButton {
    pub button: PointerButton,
    /// Its name in the settings file.
    pub name: &'static str,
    pub label: &'static str,
    pub get: fn(&Preferences) -> BarrelAction,
    pub set: fn(&mut Preferences, BarrelAction),
}

/// All of them, but those that have a file of their own.
#[derive(Clone, Debug, PartialEq)]
pub struct Preferences {
    pub pick_keys: PickKeys,
    pub has_loupe: bool,
    pub remembers_colors: bool,
    pub alt_opens_menus: bool,
    pub has_large_targets: bool,
    pub has_own_file_dialog: bool,
    pub presses_by_speed: bool,
    /// From the pressure that a pen reports to the one that is painted with.
    pub pressure: Curve,
    pub right_barrel: BarrelAction,
    pub middle_barrel: BarrelAction,
    pub recent_files: usize,
    pub undo_steps: usize,
}

/// Something that is on or off.
pub struct FlagPreference {
    pub page: PreferencePage,
    /// Its name in the settings file.
    pub name: &'static str,
    pub label: &'static str,
    pub hint: &'static str,
    pub get: fn(&Preferences) -> bool,
    pub set: fn(&mut Preferences, bool),
}

/// A pen's pressure as it is reported.
const PRESSED_AS_REPORTED: Curve = Curve::Share(1.0);

impl Default for Preferences {
    fn default() -> Self {
        Self {
            pick_keys: PickKeys::default(),
            has_loupe: true,
            remembers_colors: true,
            alt_opens_menus: true,
            has_large_targets: false,
            has_own_file_dialog: false,
            presses_by_speed: false,
            pressure: PRESSED_AS_REPORTED,
            right_barrel: BarrelAction::Size,
            middle_barrel: BarrelAction::Pan,
            recent_files: 12,
            undo_steps: 200,
        }
    }
}

impl Preferences {
    /// Everything that is on or off.
    pub const FLAGS: [FlagPreference; 6] = [
        FlagPreference {
            page: PreferencePage::Interface,
            name: "alt opens menus",
            label: "Alt opens the menus",
            hint: "A short press of Alt alone; F10 opens them in any case",
            get: |all| all.alt_opens_menus,
            set: |all, on| all.alt_opens_menus = on,
        },
        FlagPreference {
            page: PreferencePage::Interface,
            name: "large targets",
            label: "Large targets",
            hint: "Buttons, rows and sliders are at least 32 points high, for fingers and pens",
            get: |all| all.has_large_targets,
            set: |all, on| all.has_large_targets = on,
        },
        FlagPreference {
            page: PreferencePage::Pen,
            name: "pressure from speed",
            label: "Pressure from speed",
            hint: "A mouse, or a finger without pressure, presses less when it moves faster",
            get: |all| all.presses_by_speed,
            set: |all, on| all.presses_by_speed = on,
        },
        FlagPreference {
            page: PreferencePage::Colors,
            name: "loupe",
            label: "Loupe while a color is taken",
            hint: "Enlarged pixels around the pointer, in a ring of the new and the old color",
            get: |all| all.has_loupe,
            set: |all, on| all.has_loupe = on,
        },
        FlagPreference {
            page: PreferencePage::Colors,
            name: "remember colors",
            label: "Remember recent colors",
            hint: "The recent colors are there again when the program is started the next time",
            get: |all| all.remembers_colors,
            set: |all, on| all.remembers_colors = on,
        },
        FlagPreference {
            page: PreferencePage::Files,
            name: "own file dialog",
            label: "Rilievo's own file dialog",
            hint: "With pictures of the files and bookmarks, instead of the system's",
            get: |all| all.has_own_file_dialog,
            set: |all, on| all.has_own_file_dialog = on,
        },
    ];
    /// Every number, with its page.
    pub const NUMBERS: [(PreferencePage, NumberSetting<Preferences>); 2] = [
        (
            PreferencePage::Files,
            NumberSetting {
                name: "recent files",
                label: "Recent files",
                hint: "How many files Open recent lists; 0 keeps none",
                range: 0.0..=40.0,
                is_length: false,
                get: |all| all.recent_files as f32,
                set: |all, to| all.recent_files = to.round() as usize,
            },
        ),
        (
            PreferencePage::Memory,
            NumberSetting {
                name: "undo steps",
                label: "Undo steps",
                hint: "How many steps of each document can be undone; older ones are forgotten",
                range: 10.0..=1000.0,
                is_length: false,
                get: |all| all.undo_steps as f32,
                set: |all, to| all.undo_steps = to.round() as usize,
            },
        ),
    ];

    /// The buttons on a pen's barrel.
    pub const BARREL: [BarrelButton; 2] = [
        BarrelButton {
            button: PointerButton::Secondary,
            name: "right pen button",
            label: "Right click",
            get: |all| all.right_barrel,
            set: |all, to| all.right_barrel = to,
        },
        BarrelButton {
            button: PointerButton::Middle,
            name: "middle pen button",
            label: "Middle click",
            get: |all| all.middle_barrel,
            set: |all, to| all.middle_barrel = to,
        },
    ];

    /// Whether a pen's pressure is painted with as it is reported.
    pub fn is_pressed_as_reported(&self) -> bool {
        self.pressure == PRESSED_AS_REPORTED
    }

    /// The pressure is painted with as it is reported, from now on.
    pub fn reset_pressure(&mut self) {
        self.pressure = PRESSED_AS_REPORTED;
    }

    pub fn to_json(&self) -> Value {
        let mut out = Map::new();
        for flag in Self::FLAGS {
            out.insert(flag.name.into(), (flag.get)(self).into());
        }
        for (_, number) in Self::NUMBERS {
            out.insert(number.name.into(), (number.get)(self).into());
        }
        for barrel in Self::BARREL {
            out.insert(barrel.name.into(), (barrel.get)(self).name().into());
        }
        out.insert(PICK.into(), self.pick_keys.name().into());
        if let Curve::Points(points) = &self.pressure {
            out.insert(PRESSURE.into(), points.iter().map(|p| json!([p.x, p.y])).collect());
        }
        out.into()
    }

    /// What is unknown or out of range keeps its default.
    pub fn from_json(value: &Map<String, Value>) -> Self {
        let mut read = Self::default();
        for flag in Self::FLAGS {
            if let Some(on) = value.get(flag.name).and_then(Value::as_bool) {
                (flag.set)(&mut read, on);
            }
        }
        for (_, number) in Self::NUMBERS {
            if let Some(to) = value.get(number.name).and_then(Value::as_f64) {
                number.put(&mut read, to as f32);
            }
        }
        for barrel in Self::BARREL {
            let action = value.get(barrel.name).and_then(Value::as_str).map(current_name);
            if let Some(action) = action.and_then(BarrelAction::from_name) {
                (barrel.set)(&mut read, action);
            }
        }
        let keys = value.get(PICK).and_then(Value::as_str).map(current_name);
        read.pick_keys = keys.and_then(PickKeys::from_name).unwrap_or_default();
        let points = value.get(PRESSURE).and_then(Value::as_array);
        let points = points.and_then(|points| points.iter().map(point).collect());
        read.pressure = points.and_then(Curve::through).unwrap_or(read.pressure);
        read
    }
}

const PICK: &str = "pick with";
const PRESSURE: &str = "pressure";

/// [x, y].
fn point(value: &Value) -> Option<Vec2> {
    let [x, y] = value.as_array()?.as_slice() else { return None };
    Some(vec2(x.as_f64()? as f32, y.as_f64()? as f32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preference_comes_back_and_what_is_wrong_keeps_its_default() {
        let mut all = Preferences::default();
        for flag in Preferences::FLAGS {
            let other = !(flag.get)(&all);
            (flag.set)(&mut all, other);
            assert_eq!((flag.get)(&all), other, "{}", flag.name);
        }
        for (_, number) in Preferences::NUMBERS {
            number.put(&mut all, *number.range.start() + 7.0);
        }
        for barrel in Preferences::BARREL {
            (barrel.set)(&mut all, BarrelAction::Turn);
            assert_eq!((barrel.get)(&all), BarrelAction::Turn, "{}", barrel.name);
        }
        all.pick_keys = PickKeys::Ctrl;
        all.pressure = Curve::through(vec![vec2(0.25, 0.0), vec2(0.5, 1.0)]).unwrap();
        assert_eq!(Preferences::from_json(all.to_json().as_object().unwrap()), all);
        let wrong = json!({
            "pressure": [[0.5, 9], "x"], "undo steps": "many", "loupe": 3, "pick with": "shift",
            "right pen button": "brew", "middle pen button": 3,
        });
        let read = Preferences::from_json(wrong.as_object().unwrap());
        assert_eq!(read, Preferences::default());
        let most = json!({ "undo steps": 1e9 });
        assert_eq!(Preferences::from_json(most.as_object().unwrap()).undo_steps, 1000);
    }

    #[test]
    fn a_color_is_taken_with_the_chosen_key_alone() {
        let (ctrl, alt) = (Modifiers::COMMAND, Modifiers::ALT);
        let held = |keys: PickKeys| {
            [ctrl, alt, ctrl | alt, alt | Modifiers::SHIFT].map(|held| keys.are_held(held))
        };
        assert_eq!(held(PickKeys::Both), [true, true, false, false]);
        assert_eq!(held(PickKeys::Ctrl), [true, false, false, false]);
        assert_eq!(held(PickKeys::Alt), [false, true, false, false]);
    }
}
