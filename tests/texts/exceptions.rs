//! Literals that look like texts and are none, and texts that stand in no literal.

/// A part of a file's path, and why none of its literals are texts of the window.
pub const EXCEPT_FILES: &[(&str, &str)] = &[
    ("src/engine/shape/flats/area_names.rs", "names of parts belong to the document"),
    ("src/program/cli/info", "what `rilievo info` prints is read by programs"),
    ("src/program/language", "the names of languages are in their own"),
    ("src/window/fonts.rs", "names of fonts"),
];

/// A file whose texts all begin like sentences, and what its other phrases are.
pub const LOWER_IS_NONE: &[(&str, &str)] = &[
    ("src/window/dialogs/palette/find.rs", "what people type who look for a command"),
    ("src/window/preferences.rs", "keys of the settings file"),
];

/// The end of a file's path, a literal of it, and why it is no text.
pub const EXCEPT_TEXTS: &[(&str, &str, &str)] = &[
    ("src/engine/raster/asset.rs", "Asset({} bytes)", "for debugging"),
    ("src/engine/raster/lattice.rs", "Lattice of {} blocks", "for debugging"),
    ("src/io/palette/gpl.rs", "GIMP Palette\nName: {}\nColumns: {}\n#\n", "written to a file"),
    ("src/io/text/markup.rs", "'{}', sans-serif", "written to an SVG"),
    ("src/program/cli.rs", "rilievo: {sentence}", "the program's name"),
    (
        "src/program/cli/crash.rs",
        "Rilievo {}\n{} {}, {threads} threads\n\ninternal error: {what}\n\n\
         the last actions:\n  {actions}\n\nremember is at {here:#x}\n\nthe calls:\n{calls:#}",
        "a report for programmers",
    ),
    ("src/program/cli/messages.rs", "rilievo: {sentence}", "the program's name"),
    ("src/program/cli/replay.rs", "{steps} steps\n", "read by programs"),
    ("src/window/clipboard/system.rs", "Pasted.{ending}", "a file's name"),
    ("src/window/desktop.rs", "Rilievo", "the program's name"),
    ("src/window/dialogs/help.rs", "Rilievo", "the program's name"),
    ("src/window/keymap/presets.rs", "Clip Studio", "a program's name"),
    ("src/window/keymap/presets.rs", "Insert", "a key"),
    ("src/window/keymap/presets.rs", "Krita", "a program's name"),
    ("src/window/keymap/presets.rs", "Minus", "a key"),
    ("src/window/keymap/presets.rs", "Photoshop", "a program's name"),
    ("src/window/keymap/presets.rs", "Rilievo", "the program's name"),
    ("src/window/keymap/presets.rs", "Slash", "a key"),
    ("src/window/settings.rs", "no references", "a key of the settings file"),
    ("src/window/settings.rs", "key preset", "a key of the settings file"),
    ("src/window/settings.rs", "hint done", "a key of the settings file"),
    ("src/window/settings.rs", "kept share", "a key of the settings file"),
];

/// Types whose names in files the window asks for and does not show.
pub const NAMES_NOT_SHOWN: &[&str] = &["ExportFormat", "ShapeMap"];

/// Types whose names in files the window shows.
pub const SHOWN_TYPES: &[&str] = &["SurfaceView"];

/// Texts that no literal has: the kinds of parts, which the list of parts shows by their names.
pub const SHOWN_NAMES: &[&str] = &[
    "Bevel",
    "Primitive",
    "Lathe",
    "Sweep",
    "Touches",
    "Sculpt",
    "Relief",
    "Lines",
    "Profiles",
    "Maps",
];
