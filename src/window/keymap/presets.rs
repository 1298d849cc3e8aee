//! Keys as other programs have them: for each preset, what differs from the default keys. Floor 7.
//! Not here: applying them (`Keymap`).
//!
//! A row takes its keys from whatever has them by default. A row whose keys are none would leave a
//! command without a key: everything that has one by default has one in every preset.

rilievo_engine::named! {
    /// A preset of keys.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum KeyPreset {
        /// The default keys.
        #[default]
        Rilievo = "rilievo" => "Rilievo",
        Krita = "krita" => "Krita",
        Photoshop = "photoshop" => "Photoshop",
        ClipStudio = "clip studio" => "Clip Studio",
    }
}

impl KeyPreset {
    /// Commands and tools by their names, with their keys as `Keymap` writes them.
    pub fn rows(self) -> &'static [(&'static str, &'static [&'static str])] {
        match self {
            KeyPreset::Rilievo => &[],
            KeyPreset::Krita => KRITA,
            KeyPreset::Photoshop => PHOTOSHOP,
            KeyPreset::ClipStudio => CLIP_STUDIO,
        }
    }
}

type Rows = &'static [(&'static str, &'static [&'static str])];

const KRITA: Rows = &[
    ("Eyedropper", &["P"]),
    ("Shape", &["Shift+P"]),
    ("Path", &["Shift+V"]),
    ("Move", &["T"]),
    ("Transform", &["V"]),
    ("Select rectangle", &["Ctrl+R"]),
    ("Rulers", &["Shift+R"]),
    ("Select ellipse", &["J"]),
    ("Image", &["Shift+J"]),
    ("New paint layer", &["Insert"]),
    ("Paste as new document", &["Ctrl+Shift+N"]),
    ("Duplicate layer", &["Ctrl+J"]),
    ("Layer via copy", &["Ctrl+Alt+J"]),
    ("Ungroup", &["Ctrl+Alt+G"]),
    ("Clip to layer below", &["Ctrl+Shift+G"]),
    ("Image size…", &["Ctrl+Alt+I"]),
    ("Place image…", &["Ctrl+Alt+O"]),
    ("Feather selection…", &["Shift+F6"]),
    ("Black & white…", &["Ctrl+Shift+U"]),
    ("Actual pixels", &["1", "Ctrl+0"]),
    ("Fit canvas", &["2"]),
    ("Full screen", &["Ctrl+Shift+F", "F11"]),
    ("Command palette…", &["Ctrl+Enter", "Ctrl+K", "Ctrl+Shift+P"]),
];

const PHOTOSHOP: Rows = &[
    ("Select rectangle", &["M"]),
    ("Select ellipse", &["Shift+M"]),
    ("Mirror view", &["Shift+H"]),
    ("Quick mask", &["Q"]),
    ("Surface wand", &["Shift+W"]),
    ("Text", &["T"]),
    ("Path", &["P"]),
    ("Shape", &["Shift+P"]),
    ("Figure", &["U"]),
    ("Sculpt", &["Shift+U"]),
    ("Transform", &["Shift+T"]),
    ("Fill", &["Shift+G"]),
    ("Full screen", &["F", "F11"]),
    ("Liquify", &["Ctrl+Shift+X", "K"]),
    ("Layer above", &["Alt+CloseBracket", "PageUp"]),
    ("Layer below", &["Alt+OpenBracket", "PageDown"]),
    ("Move layer up", &["Ctrl+CloseBracket", "Ctrl+PageUp"]),
    ("Move layer down", &["Ctrl+OpenBracket", "Ctrl+PageDown"]),
    ("Show or hide layer", &["Ctrl+Comma"]),
    ("Preferences…", &["Ctrl+K"]),
    ("Command palette…", &["Ctrl+F", "Ctrl+Shift+P"]),
    ("Image size…", &["Ctrl+Alt+I"]),
    ("Place image…", &["Ctrl+Alt+O"]),
    ("Black & white…", &["Ctrl+Alt+Shift+B"]),
    ("Feather selection…", &["Shift+F6"]),
    ("Keyboard shortcuts…", &["Ctrl+Alt+Shift+K"]),
    ("Show grid", &["Ctrl+Quote"]),
    ("Paste", &["Ctrl+V", "Ctrl+Shift+V"]),
    ("Paste as new document", &["Ctrl+Alt+Shift+V"]),
    ("Export…", &["Ctrl+Alt+Shift+W"]),
];

const CLIP_STUDIO: Rows = &[
    ("Brush", &["P", "B"]),
    ("Shape", &["Shift+P"]),
    ("Path", &["Shift+V"]),
    ("Figure", &["U"]),
    ("Sculpt", &["Shift+U"]),
    ("Fill", &["G"]),
    ("Gradient", &["Shift+G"]),
    ("Move", &["K"]),
    ("Liquify", &["J"]),
    ("Image", &["Shift+J"]),
    ("Select rectangle", &["M"]),
    ("Mirror view", &["Shift+H"]),
    ("Select ellipse", &["Shift+M"]),
    ("Strokes", &["O", "S"]),
    ("Text", &["T"]),
    ("Transform", &["Shift+T"]),
    ("Zoom", &["Slash", "Z"]),
    ("Lock alpha", &["Ctrl+Slash"]),
    ("Layer above", &["Alt+CloseBracket", "PageUp"]),
    ("Layer below", &["Alt+OpenBracket", "PageDown"]),
    ("Preferences…", &["Ctrl+K"]),
    ("Command palette…", &["Ctrl+Shift+P"]),
    ("Keyboard shortcuts…", &["Ctrl+Alt+Shift+K"]),
    ("Actual pixels", &["Ctrl+Alt+0", "1"]),
    ("Turn left", &["Minus", "4"]),
    ("Zoom out", &["Ctrl+Minus"]),
    ("Draw along assistants", &["Ctrl+1"]),
    ("Snap", &["Ctrl+3"]),
];
