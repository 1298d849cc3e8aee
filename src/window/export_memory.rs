//! How documents were exported last, by their files, and presets that the user named. Floor 7. Part
//! of the settings. Not here: writing the pictures (`session::exporting`).

use crate::session::replay::ReplayValue;
use crate::session::{ExportSettings, ExportedFile};
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};

/// The most documents that are remembered.
const MOST: usize = 60;
/// The most presets.
const MOST_PRESETS: usize = 40;

/// What is kept of exports from run to run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExportMemory {
    /// The documents' files, the one that was exported last in front.
    documents: Vec<(PathBuf, ExportedFile)>,
    pub presets: Vec<ExportPreset>,
}

/// Settings of an export under a name.
#[derive(Clone, Debug, PartialEq)]
pub struct ExportPreset {
    pub name: String,
    /// One of the endings of the dialog.
    pub extension: String,
    pub settings: ExportSettings,
}

impl ExportMemory {
    /// How the document of a file was exported last.
    pub fn of_document(&self, document: &Path) -> Option<&ExportedFile> {
        self.documents.iter().find(|(known, _)| known == document).map(|(_, exported)| exported)
    }

    /// A document was exported.
    pub fn remember(&mut self, document: PathBuf, exported: ExportedFile) {
        self.documents.retain(|(known, _)| *known != document);
        self.documents.insert(0, (document, exported));
        self.documents.truncate(MOST);
    }

    /// Keeps a preset, in place of one of the same name.
    pub fn keep(&mut self, preset: ExportPreset) {
        self.remove(&preset.name);
        self.presets.push(preset);
        let extra = self.presets.len().saturating_sub(MOST_PRESETS);
        self.presets.drain(..extra);
    }

    pub fn remove(&mut self, name: &str) {
        self.presets.retain(|known| known.name != name);
    }

    pub fn to_json(&self) -> Value {
        let documents: Vec<Value> = self
            .documents
            .iter()
            .map(|(document, exported)| {
                json!({
                    "document": document.to_value(), "file": exported.file.to_value(),
                    "settings": exported.settings.to_value(),
                })
            })
            .collect();
        let presets: Vec<Value> = self
            .presets
            .iter()
            .map(|preset| {
                json!({
                    "name": preset.name, "format": preset.extension,
                    "settings": preset.settings.to_value(),
                })
            })
            .collect();
        json!({ "documents": documents, "presets": presets })
    }

    /// What cannot be read is left out.
    pub fn from_json(value: &Map<String, Value>) -> Self {
        let list = |name: &str| value.get(name).and_then(Value::as_array).into_iter().flatten();
        let settings = |row: &Value| ExportSettings::read(row.get("settings")?).ok();
        let path = |row: &Value, name: &str| PathBuf::read(row.get(name)?).ok();
        let document = |row: &Value| {
            let exported = ExportedFile { file: path(row, "file")?, settings: settings(row)? };
            Some((path(row, "document")?, exported))
        };
        let preset = |row: &Value| {
            let text = |name: &str| row.get(name).and_then(Value::as_str).map(str::to_owned);
            let (name, extension) = (text("name")?, text("format")?);
            Some(ExportPreset { name, extension, settings: settings(row)? })
        };
        Self {
            documents: list("documents").filter_map(document).take(MOST).collect(),
            presets: list("presets").filter_map(preset).take(MOST_PRESETS).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::ExportSize;

    #[test]
    fn exports_and_presets_come_back_and_the_oldest_are_forgotten() {
        let mut memory = ExportMemory::default();
        let settings = ExportSettings {
            size: ExportSize::Width(640),
            selection: true,
            ..ExportSettings::default()
        };
        for i in 0..MOST + 5 {
            let file = PathBuf::from(format!("{i}.jpg"));
            memory.remember(format!("{i}.ora").into(), ExportedFile { file, settings });
        }
        for quality in [50, 90] {
            let settings = ExportSettings { quality, ..settings };
            memory.keep(ExportPreset { name: "Web".into(), extension: "jpg".into(), settings });
        }
        let read = ExportMemory::from_json(memory.to_json().as_object().unwrap());
        assert_eq!(read, memory);
        assert_eq!(read.of_document(Path::new("3.ora")), None);
        let last = read.of_document(Path::new("64.ora")).unwrap();
        assert_eq!(
            (last.file.to_str(), last.settings.size),
            (Some("64.jpg"), ExportSize::Width(640))
        );
        assert_eq!((read.presets.len(), read.presets[0].settings.quality), (1, 90));
        let broken = json!({ "documents": [3, {}], "presets": [{ "name": "a" }] });
        let read = ExportMemory::from_json(broken.as_object().unwrap());
        assert_eq!(read, ExportMemory::default());
    }
}
