//! What the window remembers from one run to the next: recent files, the places of panels, the
//! theme, keys. A small JSON file in the user's folder for settings; a broken one is reported and
//! never keeps the program from starting. Floor 7. Not here: replacing the file (`io::replace`).

use super::brush_shelf::BrushShelf;
use super::export_memory::ExportMemory;
use super::harmony::Harmony;
use super::jobs;
use super::keymap::{KeyPreset, Keymap};
use super::panel_layout::{ColorView, PanelKind, PanelLayout, SIDES};
use super::preferences::Preferences;
use super::references::ReferencePins;
use super::theme::Look;
use super::usage::{KEPT_SHARE, USUAL_KEPT_SHARE};
use crate::document::Progress;
use crate::io::fs::Disk;
use crate::io::platform::{self, Instant};
use crate::io::replace::{Overwrite, replace};
use crate::language::Language;
use crate::math::srgb::Color;
use crate::session::replay::ReplayValue;
use crate::tools::snap::ViewAids;
use crate::tr;
use crate::{Error, Result};
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The most bookmarks that are read.
const BOOKMARKS: usize = 100;
/// The greatest size of a settings file; larger files are ignored.
const LARGEST_BYTES: u64 = 1 << 20;
/// The time between two checks for changes.
const PAUSE: Duration = Duration::from_secs(2);

/// All settings.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Newest first.
    pub recent: Vec<PathBuf>,
    pub look: Look,
    /// The language of the window; the system's, if none was chosen.
    pub language: Option<Language>,
    /// The scale of the interface, if it was chosen.
    pub scale: Option<f32>,
    pub layout: PanelLayout,
    pub keymap: Keymap,
    /// Whether the three hints of the first start were completed or dismissed.
    pub is_hint_done: bool,
    /// What is shown over the canvas, and what the pen snaps to.
    pub aids: ViewAids,
    /// The share of the machine's memory that documents may keep for speed.
    pub kept_share: f32,
    pub color: ColorView,
    /// Whether the status bar shows what is measured: the surface under the pointer, memory, times.
    pub has_details: bool,
    pub preferences: Preferences,
    /// The last colors painted with, newest first, if they are remembered.
    pub colors: Vec<Color>,
    /// Folders that the user marked in the window's own file dialog.
    pub bookmarks: Vec<PathBuf>,
    pub shelf: BrushShelf,
    /// How documents were exported, and presets for that.
    pub exports: ExportMemory,
    /// Pictures over the canvas.
    pub references: ReferencePins,
    /// The profile that the picture is proofed with.
    pub proof: Option<PathBuf>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            recent: Vec::new(),
            look: Look::default(),
            language: None,
            scale: None,
            layout: PanelLayout::default(),
            keymap: Keymap::default(),
            is_hint_done: false,
            aids: ViewAids::default(),
            kept_share: USUAL_KEPT_SHARE,
            color: ColorView::default(),
            has_details: false,
            preferences: Preferences::default(),
            colors: Vec::new(),
            bookmarks: Vec::new(),
            shelf: BrushShelf::default(),
            exports: ExportMemory::default(),
            references: ReferencePins::default(),
            proof: None,
        }
    }
}

impl Settings {
    pub fn recent_is(&mut self, file: PathBuf) {
        self.recent.retain(|known| *known != file);
        self.recent.insert(0, file);
        self.keep_recent();
    }

    /// Drops recent files beyond their number.
    pub fn keep_recent(&mut self) {
        self.recent.truncate(self.preferences.recent_files);
    }

    fn to_json(&self) -> Value {
        let PanelLayout { side, is_hidden, front, below, floating, width_pt, hides_references } =
            &self.layout;
        let paths = |paths: &[PathBuf]| -> Vec<String> {
            paths.iter().map(|path| path.to_string_lossy().into_owned()).collect()
        };
        let colors: Vec<String> = self.colors.iter().map(Color::to_string).collect();
        let floating: Vec<&str> = floating.iter().map(|front| front.name()).collect();
        let side = SIDES.iter().find(|(known, _)| known == side).map_or("right", |(_, name)| name);
        json!({
            "recent": paths(&self.recent),
            "look": self.look.name(),
            "language": self.language.map(Language::name),
            "scale": self.scale,
            "hint done": self.is_hint_done,
            "panels": {
                "side": side, "hidden": is_hidden, "front": front.name(), "below": below.name(), "apart": floating,
                "width": width_pt.round(), "no references": hides_references,
            },
            "key preset": self.keymap.preset().name(),
            "keys": self.keymap.to_json(),
            "aids": self.aids.to_value(),
            "kept share": self.kept_share,
            "color": {
                "wheel": self.color.is_wheel, "sliders": self.color.has_sliders,
                "numbers": self.color.has_numbers, "harmony": self.color.harmony.name(),
            },
            "details": self.has_details,
            "preferences": self.preferences.to_json(),
            "colors": colors,
            "bookmarks": paths(&self.bookmarks),
            "brushes": self.shelf.to_json(),
            "exports": self.exports.to_json(),
            "references": self.references.to_json(),
            "proof": self.proof.as_ref().map(|file| file.to_string_lossy()),
        })
    }

    /// Unknown values keep their defaults.
    fn from_json(value: &Map<String, Value>) -> Self {
        let text = |value: &Value| value.as_str().map(str::to_owned);
        let texts = |value: Option<&Value>| -> Vec<String> {
            value.and_then(Value::as_array).into_iter().flatten().filter_map(text).collect()
        };
        let flag = |object: &Map<String, Value>, name: &str| {
            object.get(name).and_then(Value::as_bool).unwrap_or(false)
        };
        let nothing = Map::new();
        let object = |name: &str| value.get(name).and_then(Value::as_object).unwrap_or(&nothing);
        let panels = object("panels");
        let word = |name: &str| panels.get(name).and_then(Value::as_str).unwrap_or_default();
        let plain = PanelLayout::default();
        let width = panels
            .get("width")
            .and_then(Value::as_f64)
            .map_or(plain.width_pt, |width| width as f32);
        let layout = PanelLayout {
            side: SIDES
                .iter()
                .find(|(_, name)| *name == word("side"))
                .map_or(plain.side, |(side, _)| *side),
            is_hidden: flag(panels, "hidden"),
            front: PanelKind::from_name(word("front")).unwrap_or(plain.front),
            below: PanelKind::from_name(word("below")).unwrap_or(plain.below),
            floating: texts(panels.get("apart"))
                .iter()
                .filter_map(|name| PanelKind::from_name(name))
                .collect(),
            width_pt: width.max(200.0).min(800.0),
            hides_references: flag(panels, "no references"),
        };
        let preferences = Preferences::from_json(object("preferences"));
        let paths = |name: &str, most: usize| {
            texts(value.get(name)).into_iter().take(most).map(PathBuf::from).collect()
        };
        let (recent, bookmarks) =
            (paths("recent", preferences.recent_files), paths("bookmarks", BOOKMARKS));
        let colors = texts(value.get("colors"));
        let colors = colors.iter().filter_map(|color| Color::parse(color)).collect();
        let preset = value.get("key preset").and_then(Value::as_str);
        let preset = preset.and_then(KeyPreset::from_name).unwrap_or_default();
        let keymap = Keymap::from_json(preset, object("keys"));
        let scale = value
            .get("scale")
            .and_then(Value::as_f64)
            .map(|scale| (scale as f32).max(0.5).min(4.0));
        let aids = value.get("aids").and_then(|aids| ViewAids::read(aids).ok()).unwrap_or_default();
        // Before there were three looks, a flag said whether it is the light one.
        let old = if flag(value, "light") { Look::Light } else { Look::default() };
        let look =
            value.get("look").and_then(Value::as_str).and_then(Look::from_name).unwrap_or(old);
        let language = value.get("language").and_then(Value::as_str).and_then(Language::from_name);
        let is_hint_done = flag(value, "hint done");
        let share = value
            .get("kept share")
            .and_then(Value::as_f64)
            .map_or(USUAL_KEPT_SHARE, |share| share as f32);
        let kept_share = share.max(*KEPT_SHARE.start()).min(*KEPT_SHARE.end());
        let shown = object("color");
        let harmony = shown.get("harmony").and_then(Value::as_str).and_then(Harmony::from_name);
        let color = ColorView {
            is_wheel: flag(shown, "wheel"),
            has_sliders: flag(shown, "sliders"),
            has_numbers: flag(shown, "numbers"),
            harmony: harmony.unwrap_or_default(),
        };
        let has_details = flag(value, "details");
        Self {
            recent,
            look,
            language,
            scale,
            layout,
            keymap,
            is_hint_done,
            aids,
            kept_share,
            color,
            has_details,
            preferences,
            colors,
            bookmarks,
            shelf: BrushShelf::from_json(object("brushes")),
            exports: ExportMemory::from_json(object("exports")),
            references: ReferencePins::from_json(value.get("references")),
            proof: value.get("proof").and_then(Value::as_str).map(PathBuf::from),
        }
    }

    /// Reads a settings file; a missing one counts as empty. Fails if it is not JSON or cannot be
    /// read.
    pub fn read(file: &Path) -> Result<Self> {
        let bytes = match platform::files::metadata(file) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                return Ok(Self::default());
            }
            Err(error) => return Err(Error::io(file, error)),
            Ok(found) if found.len() > LARGEST_BYTES => {
                return Err(Error::too_large(file, "it is not a settings file"));
            }
            Ok(_) => platform::files::read(file).map_err(|error| Error::io(file, error))?,
        };
        let value: Value =
            serde_json::from_slice(&bytes).map_err(|error| Error::decode(file, error))?;
        let object = value
            .as_object()
            .ok_or_else(|| Error::decode(file, "it does not hold a JSON object"))?;
        Ok(Self::from_json(object))
    }

    /// Replaces the file atomically.
    pub fn write(&self, file: &Path) -> Result<()> {
        if let Some(folder) = file.parent() {
            platform::files::create_dir_all(folder).map_err(|error| Error::io(folder, error))?;
        }
        let text = format!("{:#}\n", self.to_json());
        replace(&Disk, file, text.as_bytes(), &Overwrite::Anything.into(), &Progress::default())
            .map(drop)
    }
}

/// The settings file: `rilievo/settings.json` in the user's folder for them; `None` if the system
/// has none.
pub fn file() -> Option<PathBuf> {
    Some(platform::config_folder()?.join("rilievo").join("settings.json"))
}

/// The folder of the user's own brushes: `rilievo/brushes` in the user's folder for data.
pub fn brushes() -> Option<PathBuf> {
    data_folder("brushes")
}

/// The folder of the user's own palettes: `rilievo/palettes` there.
pub fn palettes() -> Option<PathBuf> {
    data_folder("palettes")
}

/// The folder of references that were pasted: `rilievo/references` there.
pub fn references() -> Option<PathBuf> {
    data_folder("references")
}

fn data_folder(name: &str) -> Option<PathBuf> {
    Some(platform::data_folder()?.join("rilievo").join(name))
}

/// Keeps the file up to date.
pub struct SettingsFile {
    file: Option<PathBuf>,
    written: Settings,
    looked: Instant,
}

impl SettingsFile {
    /// The settings of a file and the value that keeps it up to date; without a file nothing is
    /// stored.
    pub fn new(file: Option<PathBuf>) -> (Settings, Self, Option<String>) {
        let read = file.as_deref().map_or_else(|| Ok(Settings::default()), Settings::read);
        let (settings, trouble) = match read {
            Ok(settings) => (settings, None),
            Err(error) => (
                Settings::default(),
                Some(tr!("{error}; the window starts with its default settings", error)),
            ),
        };
        let keeper = Self { file, written: settings.clone(), looked: Instant::now() };
        (settings, keeper, trouble)
    }

    /// Writes what changed, on a thread of its own, not too often.
    pub fn keep(&mut self, settings: &Settings) {
        if self.looked.elapsed() < PAUSE {
            return;
        }
        self.looked = Instant::now();
        let Some(file) = self.file.clone().filter(|_| self.written != *settings) else { return };
        self.written = settings.clone();
        let settings = settings.clone();
        // A failure does not disturb painting; it is reported on leaving.
        let _ = jobs::spawn("settings", move || drop(settings.write(&file)));
    }

    /// Writes what changed, now.
    pub fn finish(&mut self, settings: &Settings) -> Result<()> {
        match &self.file {
            Some(file) if Settings::read(file).ok().as_ref() != Some(settings) => {
                settings.write(file)
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panel_layout::PanelSide;

    #[test]
    fn settings_come_back_as_they_were_written() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("deep").join("settings.json");
        assert_eq!(Settings::read(&file).unwrap(), Settings::default(), "no file is an empty one");
        let layout = PanelLayout {
            side: PanelSide::Left,
            is_hidden: true,
            front: PanelKind::History,
            below: PanelKind::Shape,
            floating: vec![PanelKind::Navigator],
            width_pt: 300.0,
            hides_references: true,
        };
        let aids = ViewAids { rulers: true, locked: true, ..ViewAids::default() };
        let (is_wheel, has_sliders, has_numbers) = (true, true, true);
        let color = ColorView { is_wheel, has_sliders, has_numbers, harmony: Harmony::Triad };
        let keymap = Keymap::with_preset(KeyPreset::Krita);
        let preferences = Preferences { recent_files: 15, ..Preferences::default() };
        let (colors, bookmarks) = (vec![Color::WHITE], vec![PathBuf::from("/pictures")]);
        let mut settings = Settings {
            look: Look::Gray,
            language: Some(Language::Japanese),
            layout,
            is_hint_done: true,
            aids,
            color,
            has_details: true,
            keymap,
            preferences,
            colors,
            bookmarks,
            proof: Some(PathBuf::from("/profiles/press.icc")),
            ..Settings::default()
        };
        settings.references.pin(PathBuf::from("/pictures/cat.png"));
        (0..20).for_each(|i| settings.recent_is(PathBuf::from(format!("{i}.ora"))));
        settings.write(&file).unwrap();
        let read = Settings::read(&file).unwrap();
        assert_eq!(read, settings);
        assert_eq!((read.recent.len(), read.recent[0].to_str()), (15, Some("19.ora")));
    }

    #[test]
    fn a_broken_file_is_told_of_and_starts_all_the_same() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("settings.json");
        for text in [
            "{",
            "[]",
            "\u{0}",
            "{\"panels\": 7, \"recent\": [3], \"keys\": {\"Save\": [9]}, \"light\": \"x\"}",
        ] {
            std::fs::write(&file, text).unwrap();
            let (settings, _, trouble) = SettingsFile::new(Some(file.clone()));
            assert_eq!(settings, Settings::default(), "{text}");
            let is_told = trouble.is_some_and(|trouble| trouble.contains("settings.json"));
            assert_eq!(is_told, text.len() < 9, "{text}");
        }
    }
}
