//! The window's own file dialog, for systems without one.
//! Floor 7.

use super::{DialogAnswer, buttons};
use crate::file_purpose::FilePurpose;
use crate::widgets::{list, set_accessible_name};
use eframe::egui::{Button, TextEdit, Ui};
use std::fs;
use std::path::{Path, PathBuf};

pub struct PathDialog {
    purpose: FilePurpose,
    folder: PathBuf,
    /// The typed text: a name in the folder, or a whole path.
    name: String,
    listed: FolderListing,
    /// Whether the name field was focused once.
    is_begun: bool,
    /// The existing file that the user was warned about.
    replaces: Option<PathBuf>,
    /// The extension for exports without one.
    extension: &'static str,
}

/// The contents of the shown folder.
#[derive(Default)]
struct FolderListing {
    folder: PathBuf,
    folders: Vec<String>,
    files: Vec<String>,
}

impl PathDialog {
    /// `extension`: for exports without one.
    pub fn new(purpose: FilePurpose, folder: PathBuf, name: &str, extension: &'static str) -> Self {
        Self {
            purpose,
            folder,
            name: name.into(),
            listed: FolderListing::default(),
            is_begun: false,
            replaces: None,
            extension,
        }
    }

    pub fn show(&mut self, ui: &mut Ui) -> DialogAnswer {
        ui.set_width(460.0);
        ui.heading(self.purpose.title());
        if self.listed.folder != self.folder {
            self.listed = FolderListing::of(&self.folder, self.purpose);
        }
        ui.horizontal(|ui| {
            let up = self.folder.parent().map(Path::to_owned);
            if ui.add_enabled(up.is_some(), Button::new("Up")).clicked() {
                self.folder = up.unwrap_or_default();
            }
            ui.label(self.folder.display().to_string());
        });
        let mut chosen = None;
        list(ui, 320.0).auto_shrink([false, false]).show(ui, |ui| {
            for folder in &self.listed.folders {
                if ui.add(Button::new(format!("{folder}/")).frame(false)).clicked() {
                    self.folder = self.listed.folder.join(folder);
                }
            }
            for file in &self.listed.files {
                let response = ui.add(Button::selectable(*file == self.name, file));
                if response.clicked() {
                    self.name.clone_from(file);
                }
                if response.double_clicked() {
                    chosen = Some(self.listed.folder.join(file));
                }
            }
        });
        ui.horizontal(|ui| {
            let label = ui.label("File");
            let field = ui
                .add(TextEdit::singleline(&mut self.name).desired_width(f32::INFINITY))
                .labelled_by(label.id);
            set_accessible_name(&field, "File name");
            if !std::mem::replace(&mut self.is_begun, true) {
                field.request_focus();
            }
        });
        // A whole path replaces the folder.
        let typed = self.folder.join(self.name.trim());
        let can = !self.name.trim().is_empty() && (self.purpose.is_saving() || typed.is_file());
        let is_warned = self.replaces.as_ref() == Some(&typed);
        if is_warned {
            ui.colored_label(ui.visuals().warn_fg_color, "This file already exists.");
        }
        let yes = match self.purpose.is_saving() {
            true if is_warned => "Replace",
            true => "Save",
            false => "Open",
        };
        match (buttons(ui, yes, can), chosen) {
            (_, Some(file)) => self.choose(file),
            (Some(true), None) => self.choose(typed),
            (Some(false), None) => DialogAnswer::Close,
            (None, None) => DialogAnswer::Open,
        }
    }

    /// Overwriting a file needs a second confirmation.
    fn choose(&mut self, file: PathBuf) -> DialogAnswer {
        // With its final name, so that the question is about the file that would be lost.
        let file = self.purpose.final_name(file, self.extension);
        if self.purpose.is_saving() && file.is_file() && self.replaces.as_ref() != Some(&file) {
            self.name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
            self.folder = file.parent().map_or_else(|| self.folder.clone(), Path::to_owned);
            self.replaces = Some(file);
            return DialogAnswer::Open;
        }
        DialogAnswer::Chosen(self.purpose, file)
    }
}

impl FolderListing {
    fn of(folder: &Path, purpose: FilePurpose) -> Self {
        let extensions: Vec<&str> =
            purpose.filters().into_iter().flat_map(|(_, extensions)| extensions).collect();
        let mut listed = Self { folder: folder.into(), ..Self::default() };
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let (name, path) = (entry.file_name().to_string_lossy().into_owned(), entry.path());
            let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
            if name.starts_with('.') {
                continue;
            }
            if path.is_dir() {
                listed.folders.push(name);
            } else if extensions.contains(&extension.as_str()) {
                listed.files.push(name);
            }
        }
        listed.folders.sort_unstable();
        listed.files.sort_unstable();
        listed
    }
}
