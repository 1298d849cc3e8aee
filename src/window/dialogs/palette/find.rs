//! What the command palette finds, and by which words: commands, tools, panels and settings of the
//! brush, by their names here or by what other programs call them. Floor 7.
//! Not here: the dialog (the module above).

use crate::commands::{self, MenuCommand};
use crate::language::tr;
use crate::paint::settings::SETTINGS;
use crate::panel_layout::PanelKind;
use crate::tools::ToolKind;

/// Something that the palette can do.
#[derive(Clone, Copy)]
pub enum PaletteEntry {
    Command(&'static MenuCommand),
    Tool(ToolKind),
    Panel(PanelKind),
    /// A setting of the brush: its name and what it does.
    Setting(&'static str, &'static str),
}

/// Settings of the brush that are not in the table of its dynamics.
const BRUSH: [(&str, &str); 8] = [
    ("Size", "The diameter of the brush"),
    ("Hardness", "How sharp the rim of a dab is"),
    ("Opacity", "How much a whole stroke covers"),
    ("Flow", "How much each dab covers"),
    ("Spacing", "The distance between dabs"),
    ("Grain", "The paper or pattern that the brush paints on"),
    ("Dynamics", "What pressure, tilt and speed change"),
    ("Stabilizer", "How smooth the line becomes while you draw"),
];

/// The layers that light the surface, and the bending that looks lit.
const LIT_LAYERS: &[&str] = &[
    "painter's light",
    "soft plastic",
    "toon layer",
    "velvet",
    "brushed metal",
    "painted ball",
    "mirror layer",
    "glass layer",
    "lit by an environment",
    "ambient occlusion",
    "bend: gloss",
];

/// Words of other programs and of everyday speech, and the words here that they mean.
const SYNONYMS: [(&str, &[&str]); 86] = [
    ("flip", &["mirror"]),
    ("reflect", &["mirror"]),
    ("rotate", &["turn", "upright"]),
    ("view", &["turn left", "turn right", "upright", "zoom in", "zoom out", "fit canvas"]),
    ("canvas", &["turn left", "turn right", "upright"]),
    ("resize", &["image size", "canvas size", "transform"]),
    ("resolution", &["image size"]),
    ("scale", &["image size", "transform", "larger interface"]),
    ("skew", &["transform"]),
    ("distort", &["transform", "liquify"]),
    ("perspective", &["transform", "assistants"]),
    ("warp", &["liquify", "transform"]),
    ("smudge", &["brushes", "liquify"]),
    ("blur", &["brushes", "feather"]),
    ("bokeh", &["lens blur"]),
    ("defocus", &["lens blur"]),
    ("field", &["lens blur"]),
    ("radial", &["spin blur", "zoom blur"]),
    ("bloom", &["glow"]),
    ("despeckle", &["median"]),
    ("mosaic", &["pixelate"]),
    ("screentone", &["halftone"]),
    ("frame", &["panels"]),
    ("comic", &["panels"]),
    ("sobel", &["edges"]),
    ("film", &["grain"]),
    ("stabiliser", &["stabilizer"]),
    ("stabilisation", &["stabilizer"]),
    ("stabilization", &["stabilizer"]),
    ("smoothing", &["stabilizer", "steadiness"]),
    ("streamline", &["stabilizer"]),
    ("pressure", &["dynamics"]),
    ("texture", &["grain", "bend: wrap"]),
    ("scatter", &["offset"]),
    ("jitter", &["size ±", "tremor", "offset"]),
    ("bucket", &["fill"]),
    ("colour", &["color", "swap colors", "default colors"]),
    ("grey", &["gray"]),
    ("hue", &["hue", "color"]),
    ("saturation", &["saturation", "color"]),
    ("picker", &["color"]),
    ("eyedropper", &["color"]),
    ("swatches", &["color"]),
    ("magic", &["wand"]),
    ("marquee", &["select rectangle", "select ellipse"]),
    ("unselect", &["deselect"]),
    ("marching", &["hide outline of selection"]),
    ("expand", &["grow selection"]),
    ("contract", &["shrink selection"]),
    ("inverse", &["invert"]),
    ("rasterise", &["into pixels"]),
    ("rasterize", &["into pixels"]),
    ("bake", &["into pixels"]),
    ("operator", &["bend"]),
    ("chrome", &["bend: gloss"]),
    ("shading", LIT_LAYERS),
    ("light", LIT_LAYERS),
    ("phong", &["soft plastic"]),
    ("lambertian", &["velvet"]),
    ("anisotropic", &["brushed metal"]),
    ("ashikhmin", &["brushed metal"]),
    ("matcap", &["painted ball"]),
    ("lit", &["painted ball", "lit by an environment"]),
    ("radiance", &["bring out form"]),
    ("scaling", &["image size", "bring out form"]),
    ("highlight", &["bend: gloss"]),
    ("print", &["bend: wrap"]),
    ("folder", &["group"]),
    ("isolate", &["show layer alone"]),
    ("solo", &["show layer alone"]),
    ("clipping", &["clip to layer below"]),
    ("ruler", &["rulers", "guides", "assistants"]),
    ("symmetry", &["assistants"]),
    ("vector", &["path", "figure"]),
    ("bezier", &["path"]),
    ("polygon", &["figure", "lasso"]),
    ("star", &["figure"]),
    ("arrow", &["figure"]),
    ("bubble", &["figure"]),
    ("trace", &["path from selection"]),
    ("vectorize", &["path from selection"]),
    ("inflate", &["give it a shape", "puff up"]),
    ("3d", &["give it a shape", "open maps"]),
    ("theme", &["dark, gray or light"]),
    ("preferences", &["keyboard shortcuts", "larger interface", "dark, gray or light"]),
    ("hotkeys", &["keyboard shortcuts"]),
];

impl PaletteEntry {
    /// Everything there is, in the order of the menus.
    pub fn all() -> impl Iterator<Item = Self> {
        let settings = SETTINGS.iter().map(|setting| (setting.number.label, setting.number.hint));
        commands::all()
            .map(Self::Command)
            .chain(ToolKind::ALL.into_iter().map(|(tool, _)| Self::Tool(tool)))
            .chain(PanelKind::ALL.into_iter().map(|(panel, _)| Self::Panel(panel)))
            .chain(BRUSH.into_iter().chain(settings).map(|(name, hint)| Self::Setting(name, hint)))
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::Command(command) => command.name,
            Self::Tool(tool) => tool.label(),
            Self::Panel(panel) => panel.name(),
            Self::Setting(name, _) => name,
        }
    }

    /// What it is, where the name does not say so.
    pub fn kind(self) -> &'static str {
        match self {
            Self::Command(_) => "",
            Self::Tool(_) => "tool",
            Self::Panel(_) => "panel",
            Self::Setting(..) => "brush",
        }
    }

    pub fn hint(self) -> &'static str {
        match self {
            Self::Command(command) => command.hint,
            Self::Tool(tool) => tool.hint(),
            Self::Panel(_) => "Brings this panel to the front",
            Self::Setting(_, hint) => hint,
        }
    }

    /// How well it fits what was typed, smaller is better, by its name in the language of the window
    /// or in English. `typed` is in lower case.
    fn rank(self, typed: &str) -> Option<u8> {
        let names = [tr(self.name()), self.name()];
        names.iter().filter_map(|name| self.rank_name(&name.to_lowercase(), typed)).min()
    }

    /// The same by one name, in lower case: it begins so, every word is in it, or words of other
    /// programs mean it.
    fn rank_name(self, name: &str, typed: &str) -> Option<u8> {
        if name.starts_with(typed) {
            return Some(0);
        }
        let kind = self.kind();
        let is_in = |word: &str| name.contains(word) || kind == word || tr(kind) == word;
        if typed.split_whitespace().all(is_in) {
            return Some(1);
        }
        let is_meant = |word: &str| is_in(word) || meanings(word).any(|own| name.contains(own));
        typed.split_whitespace().all(is_meant).then_some(2)
    }
}

/// What a word that begins so means here. Fewer than three letters mean nothing yet.
fn meanings(word: &str) -> impl Iterator<Item = &'static str> {
    let begins =
        move |row: &&(&str, &[&str])| word == row.0 || word.len() >= 3 && row.0.starts_with(word);
    SYNONYMS.iter().filter(begins).flat_map(|(_, own)| *own).copied()
}

/// What fits the typed words: names that begin with them first, then names that hold them, then
/// what they mean. Of equals, what can be done now is first; otherwise in the order of the menus.
pub fn find_entries(typed: &str, can: impl Fn(PaletteEntry) -> bool) -> Vec<PaletteEntry> {
    let typed = typed.trim().to_lowercase();
    let rank = |entry: PaletteEntry| entry.rank(&typed).map(|rank| (rank, entry));
    let mut found: Vec<(u8, PaletteEntry)> = PaletteEntry::all().filter_map(rank).collect();
    found.sort_by_key(|(rank, entry)| (*rank, !can(*entry)));
    found.into_iter().map(|(_, entry)| entry).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(typed: &str) -> Vec<&'static str> {
        find_entries(typed, |_| true).into_iter().map(PaletteEntry::name).collect()
    }

    #[test]
    fn every_synonym_finds_something_that_is_there() {
        for (word, meant) in SYNONYMS {
            for own in meant {
                let is_there = PaletteEntry::all().any(|e| e.name().to_lowercase().contains(own));
                assert!(is_there, "{word}: no “{own}”");
            }
            assert!(!names(word).is_empty(), "{word} finds nothing");
        }
    }

    #[test]
    fn words_of_other_programs_find_what_is_called_otherwise_here() {
        assert!(names("flip").contains(&"Mirror canvas left and right"));
        assert!(names("rotate canvas").contains(&"Turn canvas…"), "{:?}", names("rotate canvas"));
        assert_eq!(names("turn view"), ["Turn right", "Turn left"]);
        assert_eq!(names("new shading layer")[0], "New painter's light layer");
        assert!(!names("new shading layer").contains(&"New paint layer"));
        assert_eq!(names("stabiliser"), ["Stabilizer"]);
        assert_eq!(names("magic wand"), ["Wand", "Surface wand"]);
        assert!(names("hue").contains(&"Color"));
    }

    #[test]
    fn names_that_begin_so_come_first() {
        assert_eq!(names("lasso")[0], "Lasso");
        assert_eq!(names("crop")[0], "Crop to selection");
        assert_eq!(names("crop tool"), ["Crop"]);
        assert!(find_entries("no such thing", |_| true).is_empty());
    }

    #[test]
    fn what_can_be_done_now_comes_first() {
        let is_a_tool = |entry: PaletteEntry| matches!(entry, PaletteEntry::Tool(_));
        let found = find_entries("crop", is_a_tool);
        assert_eq!((found[0].name(), found[0].kind()), ("Crop", "tool"));
    }
}
