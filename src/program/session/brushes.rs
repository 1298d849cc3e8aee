//! The available brushes: those of the program, and the user's own, which were imported from files
//! or saved by the user. Floor 6. The user's own are in a folder, one preset file each. Not here:
//! the formats (`io`).

use super::Session;
use crate::io::brush::{self, ImportedBrush, NeighborFiles, plain};
use crate::io::platform::files;
use crate::io::recipe::{BrushPreset, PresetGroup, load_preset};
use crate::io::{Budget, Overwrite, Terms, files::read_file, picture};
use crate::math::srgb::Color;
use crate::paint::{Adjust, Brush, DualBrush, DualMode, PictureSource, Tip};
use crate::raster::Picture;
use crate::surface::Operator;
use crate::{Error, Result};
use std::convert::Infallible;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The extension of presets of this program.
const PRESET: &str = "json";
/// Extensions of pictures that become tips.
const PICTURES: [&str; 7] = ["png", "jpg", "jpeg", "webp", "tif", "tiff", "bmp"];

/// Extensions of files with brushes: of other programs, presets, pictures.
pub fn extensions() -> Vec<&'static str> {
    let others = brush::EXTENSIONS.iter().map(|(extension, _)| *extension);
    others.chain([PRESET]).chain(PICTURES).collect()
}

/// Whether a file holds brushes of another program, by its extension.
pub fn is_brush_file(file: &Path) -> bool {
    let extension = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    brush::EXTENSIONS.iter().any(|(known, _)| *known == extension)
}

/// Reads the brushes of a file: another program's, a preset's own, or a picture as a tip. At least
/// one.
pub fn read(file: &Path, budget: &Budget) -> Result<Vec<(BrushPreset, Vec<String>)>> {
    let extension = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    if extension == PRESET {
        return load_preset(file, budget).map(|preset| vec![(preset, Vec::new())]);
    }
    let bytes = read_file(file, budget.file_bytes)?;
    if PICTURES.contains(&extension.as_str()) {
        return picture_tip(file, &bytes, budget).map(|preset| vec![(preset, Vec::new())]);
    }
    let brushes = brush::read(file, &bytes, &NeighborFiles::of(file), budget)?;
    Ok(brushes.into_iter().map(|imported| preset_of(file, imported)).collect())
}

/// An imported brush as a preset, with notes on what could not be imported.
fn preset_of(file: &Path, imported: ImportedBrush) -> (BrushPreset, Vec<String>) {
    let ImportedBrush { name, brush, notes } = imported;
    let about = format!("From {}.", file.file_name().unwrap_or_default().to_string_lossy());
    let key = Some(plain(&name)).filter(|key| !key.is_empty()).unwrap_or_else(|| "brush".into());
    let color = Color { r: 0xf4, g: 0xee, b: 0xe0, a: 255 };
    (
        BrushPreset {
            key,
            name,
            group: PresetGroup::Imported,
            about,
            color,
            brush,
            operator: Operator::None,
        },
        notes,
    )
}

/// Adds the brushes of a file to the list, and selects the first.
pub fn import(session: &mut Session, file: &Path) -> Result<()> {
    let mut first = None;
    for (preset, notes) in read(file, &Budget::of_this_machine())? {
        session.notes.extend(notes.iter().map(|note| format!("{}: {note}.", preset.name)));
        let key = add(session, preset)?;
        first.get_or_insert(key);
    }
    if let Some(key) = first {
        session.take_preset(&key);
    }
    session.brush_files.push(file.into());
    Ok(())
}

/// Gives the current brush the tip of an available one as its second, or takes that away. What a
/// dual brush has set stays; else the second tip is as large as its brush, and follows the same.
pub fn set_second_tip(session: &mut Session, key: &str) {
    let brush = &session.tools.brush;
    if key.is_empty() {
        session.tools.brush.dual = None;
        return;
    }
    let Some(preset) = session.presets.iter().find(|preset| preset.key == key) else { return };
    let like = DualBrush::of_brush(&preset.brush, brush, DualMode::default());
    let first = Brush { dual: None, ..brush.clone() };
    // Values name pictures, so that two must not share a name.
    let is_taken = |name: &str, picture: &Picture| {
        first.pictures().any(|own| own.file == name && own.picture != *picture)
    };
    let rename = |source: &PictureSource| {
        let mut name = source.file.clone();
        while is_taken(&name, &source.picture) {
            name = format!("second-{name}");
        }
        if name == source.file {
            return Ok(source.clone());
        }
        Ok::<_, Infallible>(PictureSource::new(name, source.picture.clone(), source.adjust))
    };
    let Ok(tip) = like.tip.with_pictures(rename);
    let kept = brush.dual.as_deref().cloned().unwrap_or(like);
    session.tools.brush.dual = Some(Arc::new(DualBrush { tip, ..kept }));
}

/// Adds the current brush to the list under a name.
pub fn keep(session: &mut Session, name: &str) -> Result<()> {
    let name: String = name.trim().chars().filter(|c| !c.is_control()).take(80).collect();
    let name = if name.is_empty() { "My brush".to_owned() } else { name };
    let key = Some(plain(&name)).filter(|key| !key.is_empty()).unwrap_or_else(|| "brush".into());
    let (brush, color, operator) =
        (session.tools.brush.clone(), session.tools.color, session.tools.operator);
    let preset = BrushPreset {
        key,
        name,
        group: PresetGroup::Imported,
        about: String::new(),
        color,
        brush,
        operator,
    };
    session.preset = add(session, preset)?;
    Ok(())
}

/// Adds a brush to the list and the folder; returns its key.
fn add(session: &mut Session, mut preset: BrushPreset) -> Result<String> {
    preset.key = free_key(session, &preset.key);
    preset.group = PresetGroup::Imported;
    if let Some(folder) = &session.brush_folder {
        files::create_dir_all(folder).map_err(|error| Error::io(folder, error))?;
        let encoded = brush::encode(&file_of(folder, &preset.key), &preset)?;
        // The name is free, or was a moment ago.
        encoded.write(&Terms::export(Overwrite::Nothing, Vec::new()))?;
        preset = encoded.preset;
    }
    let key = preset.key.clone();
    session.presets.push(preset);
    Ok(key)
}

/// Removes one of the user's own brushes from the list and the folder, with its pictures.
pub fn remove(session: &mut Session, key: &str) -> Result<()> {
    let is_it = |preset: &BrushPreset| preset.key == key && preset.group == PresetGroup::Imported;
    let Some(at) = session.presets.iter().position(is_it) else { return Ok(()) };
    if let Some(folder) = &session.brush_folder {
        brush::remove(&file_of(folder, key), &session.presets[at])?;
    }
    session.presets.remove(at);
    Ok(())
}

fn file_of(folder: &Path, key: &str) -> PathBuf {
    folder.join(format!("{key}.json"))
}

/// The user's own brushes in a folder, by name, and a sentence for each that cannot be read.
pub fn load_brushes(folder: &Path) -> (Vec<BrushPreset>, Vec<String>) {
    // A folder that does not exist yet holds none.
    let entries = files::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut files: Vec<PathBuf> =
        entries.filter(|file| file.extension().is_some_and(|e| e == "json")).collect();
    files.sort();
    let (mut presets, mut notes) = (Vec::new(), Vec::new());
    for file in files {
        match load_preset(&file, &Budget::of_this_machine()) {
            Ok(preset) => presets.push(BrushPreset { group: PresetGroup::Imported, ..preset }),
            Err(error) => notes.push(error.to_string()),
        }
    }
    (presets, notes)
}

/// Adds the brushes of the folder to the list, each under the name of its file.
pub fn adopt(session: &mut Session, presets: Vec<BrushPreset>) {
    for preset in presets {
        if !session.presets.iter().any(|known| known.key == preset.key) {
            session.presets.push(preset);
        } else {
            let key = &preset.key;
            session
                .notes
                .push(format!("{key}.json: a brush already has this name; rename the file."));
        }
    }
}

/// A picture as a brush that stamps it.
fn picture_tip(file: &Path, bytes: &[u8], budget: &Budget) -> Result<BrushPreset> {
    let picture = picture::decode(file, bytes, budget)?;
    let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let tip = PictureSource::new(format!("{}.png", plain(&stem)), picture, Adjust::default());
    let size = tip.picture.size.longer_side();
    let brush = Brush { size, spacing: 0.25, tip: Tip::Picture(tip), ..Brush::default() };
    let imported = ImportedBrush { name: stem, brush, notes: Vec::new() };
    Ok(preset_of(file, imported).0)
}

/// A key that no other brush has, and no file of the folder, such as one that could not be read.
fn free_key(session: &Session, key: &str) -> String {
    let entries = session.brush_folder.iter().flat_map(files::read_dir).flatten().flatten();
    let stem =
        |name: std::ffi::OsString| name.to_string_lossy().split('.').next().map(str::to_owned);
    let files: Vec<String> = entries.filter_map(|entry| stem(entry.file_name())).collect();
    let is_known = |key: &str| session.presets.iter().any(|preset| preset.key == key);
    let is_taken = |key: &str| is_known(key) || files.iter().any(|file| file == key);
    let mut free = key.to_owned();
    for i in 2.. {
        if !is_taken(&free) {
            break;
        }
        free = format!("{key}-{i}");
    }
    free
}

/// Whether a brush matches a search: every word is in its name, its group or its description.
pub fn is_found(preset: &BrushPreset, search: &str) -> bool {
    let text = format!("{} {} {}", preset.name, preset.group.name(), preset.about).to_lowercase();
    search.to_lowercase().split_whitespace().all(|word| text.contains(word))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paint::Tip;
    use crate::session::Action;
    use crate::session::actions::{FileAction, HandAction};

    /// A GIMP brush of two pixels.
    fn gbr() -> Vec<u8> {
        let numbers = |n: &[u32]| -> Vec<u8> { n.iter().flat_map(|n| n.to_be_bytes()).collect() };
        [
            numbers(&[32, 2, 2, 1, 1]),
            b"GIMP".to_vec(),
            numbers(&[40]),
            b"Pen\0".to_vec(),
            vec![255, 90],
        ]
        .concat()
    }

    #[test]
    fn an_imported_brush_goes_to_hand_and_stays_in_the_list_under_a_key_of_its_own() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("pen.gbr");
        std::fs::write(&file, gbr()).unwrap();
        let mut session = Session::default();
        let known = session.presets.len();
        for key in ["pen", "pen-2"] {
            Action::File(FileAction::ImportBrush { file: file.clone() })
                .apply(&mut session)
                .unwrap();
            assert_eq!(session.preset, key);
            assert!(matches!(session.tools.brush.tip, Tip::Picture(_)));
        }
        assert_eq!(session.presets.len(), known + 2);
        Action::Hand(HandAction::Preset { name: "ink".into() }).apply(&mut session).unwrap();
        Action::Hand(HandAction::Preset { name: "pen".into() }).apply(&mut session).unwrap();
        assert_eq!((session.preset.as_str(), session.tools.brush.spacing), ("pen", 0.4));
    }

    #[test]
    fn every_file_of_brushes_can_be_chosen_once() {
        let offered = extensions();
        let others = brush::EXTENSIONS.iter().map(|(extension, _)| *extension);
        for extension in others.chain(["json", "png"]) {
            let count = offered.iter().filter(|known| **known == extension).count();
            assert_eq!(count, 1, "{extension}");
        }
    }

    #[test]
    fn a_search_finds_brushes_by_name_group_and_sentence() {
        let session = Session::default();
        let found =
            |search: &str| session.presets.iter().filter(|preset| is_found(preset, search)).count();
        assert_eq!(found(""), session.presets.len());
        assert!(found("pencil") >= 3 && found("PENCIL") == found("pencil"));
        assert!(found("light highlight") >= 3);
        assert_eq!(found("no brush is called so"), 0);
    }

    #[test]
    fn the_users_own_brushes_lie_in_their_folder_from_one_run_to_the_next_until_they_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        let (file, own) = (folder.path().join("pen.gbr"), folder.path().join("brushes"));
        std::fs::write(&file, gbr()).unwrap();
        let mut session = Session { brush_folder: Some(own.clone()), ..Session::default() };
        import(&mut session, &file).unwrap();
        session.tools.brush.spacing = 0.7;
        Action::File(FileAction::KeepBrush { name: " Wide pen ".into() })
            .apply(&mut session)
            .unwrap();
        assert_eq!(session.preset, "wide-pen");
        let (presets, notes) = load_brushes(&own);
        let told = |preset: &BrushPreset| {
            (preset.key.clone(), preset.brush.spacing, preset.brush.pictures().count())
        };
        let told: Vec<_> = presets.iter().map(told).collect();
        assert_eq!(
            (told, notes),
            (vec![("pen".into(), 0.4, 1), ("wide-pen".into(), 0.7, 1)], Vec::new())
        );
        for name in ["pen", "wide-pen", "ink", "nobody"] {
            Action::File(FileAction::RemoveBrush { name: name.into() })
                .apply(&mut session)
                .unwrap();
        }
        assert_eq!(std::fs::read_dir(&own).unwrap().count(), 0, "nothing is left of them");
        assert!(session.presets.iter().any(|preset| preset.key == "ink"), "the program's own stay");
    }

    #[test]
    fn a_picture_becomes_a_tip_and_a_broken_file_of_the_folder_is_told_of() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("Leaf 3.png");
        image::RgbaImage::from_pixel(20, 30, image::Rgba([9, 200, 9, 128])).save(&file).unwrap();
        let mut session = Session::default();
        import(&mut session, &file).unwrap();
        assert_eq!((session.preset.as_str(), session.tools.brush.size), ("leaf-3", 30.0));
        std::fs::write(folder.path().join("broken.json"), "{").unwrap();
        let (presets, notes) = load_brushes(folder.path());
        assert!(
            presets.is_empty() && notes.len() == 1 && notes[0].contains("broken.json"),
            "{notes:?}"
        );
        let ink = session.presets.iter().find(|preset| preset.key == "ink").cloned().unwrap();
        let known = session.presets.len();
        adopt(&mut session, vec![ink.clone(), BrushPreset { key: "my-ink".into(), ..ink }]);
        assert_eq!((session.presets.len(), session.notes.len()), (known + 1, 1));
    }

    #[test]
    fn the_brush_in_hand_is_changed_by_what_a_recipe_would_say_and_keeps_its_pictures() {
        use crate::io::recipe::brush_to_json;
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("pen.gbr");
        std::fs::write(&file, gbr()).unwrap();
        let mut session = Session::default();
        import(&mut session, &file).unwrap();
        let scattered = Brush { scatter: 2.0, ..session.tools.brush.clone() };
        Action::Hand(HandAction::Brush { brush: brush_to_json(&scattered) })
            .apply(&mut session)
            .unwrap();
        assert_eq!((session.tools.brush.scatter, session.tools.brush.spacing), (2.0, 0.4));
        assert!(matches!(session.tools.brush.tip, Tip::Picture(_)));
        let unknown = serde_json::json!({ "tip": { "file": "else.png" } });
        Action::Hand(HandAction::Brush { brush: unknown }).apply(&mut session).unwrap();
        assert!(session.notes[0].contains("tip.file: is “else.png”"), "{:?}", session.notes);
        assert_eq!(session.tools.brush.scatter, 2.0);
    }
    #[test]
    fn the_tip_of_another_brush_becomes_the_second_one_and_is_taken_away_again() {
        use crate::io::recipe::brush_to_json;
        let folder = tempfile::tempdir().unwrap();
        let mut session = Session::default();
        for (name, pixels) in [("a", [255, 90]), ("b", [10, 200])] {
            let file = folder.path().join(name).join("pen.gbr");
            std::fs::create_dir(file.parent().unwrap()).unwrap();
            let header = gbr();
            std::fs::write(&file, [&header[..header.len() - 2], &pixels[..]].concat()).unwrap();
            import(&mut session, &file).unwrap();
        }
        let act = |session: &mut Session, action: HandAction| {
            Action::Hand(action).apply(session).unwrap();
        };
        act(&mut session, HandAction::Preset { name: "pen".into() });
        act(&mut session, HandAction::SecondTip { name: "pen-2".into() });
        let names = |session: &Session| -> Vec<String> {
            session.tools.brush.pictures().map(|source| source.file.clone()).collect()
        };
        assert_eq!(
            names(&session),
            ["pen.png", "second-pen.png"],
            "they differ, so do their names"
        );
        let with_both = session.tools.brush.clone();
        act(&mut session, HandAction::Brush { brush: brush_to_json(&with_both) });
        assert!(session.tools.brush == with_both, "{:?}", session.notes);
        // What was set stays with another tip.
        let set = serde_json::json!({ "dual": { "mode": "subtract", "spacing": 0.7 } });
        act(&mut session, HandAction::Brush { brush: set });
        act(&mut session, HandAction::SecondTip { name: "charcoal".into() });
        let dual = session.tools.brush.dual.clone().unwrap();
        assert_eq!((dual.settings.mode, dual.settings.spacing), (DualMode::Subtract, 0.7));
        assert!(
            dual.tip == session.presets.iter().find(|p| p.key == "charcoal").unwrap().brush.tip
        );
        act(&mut session, HandAction::SecondTip { name: "nobody".into() });
        assert!(session.tools.brush.dual.is_some());
        act(&mut session, HandAction::SecondTip { name: String::new() });
        assert!(session.tools.brush.dual.is_none());
    }
}
