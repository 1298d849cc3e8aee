//! The brushes to choose from: those of the program, and those of files that were brought in.
//! Floor 6. Formats are `io`'s.

use super::Session;
use crate::Result;
use crate::io::brush::{self, Imported, plain};
use crate::io::recipe::{Group, Preset, load_preset};
use crate::io::{Budget, files::read_file};
use crate::math::srgb::Color;
use crate::surface::Operator;
use std::path::Path;

/// Endings of the files that brushes come from.
pub const ENDINGS: [&str; 5] = ["gbr", "gih", "myb", "abr", "json"];

/// Reads the brushes of a file: another program's, or a preset's own. At least one.
pub fn read(file: &Path, budget: &Budget) -> Result<Vec<(Preset, Vec<String>)>> {
    let ending = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    if ending == "json" {
        return load_preset(file, budget).map(|preset| vec![(preset, Vec::new())]);
    }
    let bytes = read_file(file, budget.file_bytes)?;
    let brushes = brush::read(file, &bytes, budget)?;
    Ok(brushes.into_iter().map(|imported| preset_of(file, imported)).collect())
}

/// A brush of another program as one that can be chosen, and what could not be carried over.
fn preset_of(file: &Path, imported: Imported) -> (Preset, Vec<String>) {
    let Imported { name, brush, notes } = imported;
    let about = format!("From {}.", file.file_name().unwrap_or_default().to_string_lossy());
    let key = Some(plain(&name)).filter(|key| !key.is_empty()).unwrap_or_else(|| "brush".into());
    let color = Color { r: 0xf4, g: 0xee, b: 0xe0, a: 255 };
    (Preset { key, name, group: Group::Imported, about, color, brush, operator: Operator::None }, notes)
}

/// The brushes of a file join the list, and the first of them goes to hand.
pub fn import(session: &mut Session, file: &Path) -> Result<()> {
    let mut first = None;
    for (mut preset, notes) in read(file, &Budget::default())? {
        preset.key = free_key(session, &preset.key);
        preset.group = Group::Imported;
        session.notes.extend(notes.iter().map(|note| format!("{}: {note}.", preset.name)));
        first.get_or_insert(preset.key.clone());
        session.presets.push(preset);
    }
    if let Some(key) = first {
        session.take_preset(&key);
    }
    Ok(())
}

/// A key that no other brush has.
fn free_key(session: &Session, key: &str) -> String {
    let is_taken = |key: &str| session.presets.iter().any(|preset| preset.key == key);
    let mut free = key.to_owned();
    for i in 2.. {
        if !is_taken(&free) {
            break;
        }
        free = format!("{key}-{i}");
    }
    free
}

/// The brush is one that a search asks for: every word stands in its name, its group or its sentence.
pub fn is_found(preset: &Preset, search: &str) -> bool {
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
        [numbers(&[32, 2, 2, 1, 1]), b"GIMP".to_vec(), numbers(&[40]), b"Pen\0".to_vec(), vec![255, 90]].concat()
    }

    #[test]
    fn an_imported_brush_goes_to_hand_and_stays_in_the_list_under_a_key_of_its_own() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("pen.gbr");
        std::fs::write(&file, gbr()).unwrap();
        let mut session = Session::default();
        let known = session.presets.len();
        for key in ["pen", "pen-2"] {
            Action::File(FileAction::ImportBrush { file: file.clone() }).apply(&mut session).unwrap();
            assert_eq!(session.preset, key);
            assert!(matches!(session.brush.tip, Tip::Picture(_)));
        }
        assert_eq!(session.presets.len(), known + 2);
        Action::Hand(HandAction::Preset { name: "ink".into() }).apply(&mut session).unwrap();
        Action::Hand(HandAction::Preset { name: "pen".into() }).apply(&mut session).unwrap();
        assert_eq!((session.preset.as_str(), session.brush.spacing), ("pen", 0.4));
    }
    #[test]
    fn a_search_finds_brushes_by_name_group_and_sentence() {
        let session = Session::default();
        let found = |search: &str| session.presets.iter().filter(|preset| is_found(preset, search)).count();
        assert_eq!(found(""), session.presets.len());
        assert!(found("pencil") >= 3 && found("PENCIL") == found("pencil"));
        assert!(found("light highlight") >= 3);
        assert_eq!(found("no brush is called so"), 0);
    }
}
