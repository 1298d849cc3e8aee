//! The window's own file dialog, for systems without one, and for those who like it: the files of a
//! folder with their pictures, and folders to go to. Floor 7.

use super::{DialogAnswer, DialogContext, buttons, set_width};
use crate::file_pictures::FilePictures;
use crate::file_purpose::FilePurpose;
use crate::io::platform;
use crate::language::tr;
use crate::settings::Settings;
use crate::widgets::{set_accessible_name, title};
use eframe::egui::{
    self, Align, Button, Image, Key, Layout, Response, ScrollArea, TextEdit, Ui,
    load::SizedTexture, vec2,
};
use std::path::{Path, PathBuf};

/// The height of the list, and the width of the folders beside it, points.
const LIST_PT: f32 = 330.0;
const PLACES_PT: f32 = 150.0;
/// A row with a picture, and the picture's side, points.
const ROW_PT: f32 = 36.0;
const PICTURE_PT: f32 = 32.0;
/// The most folders of recent files that are shown.
const MOST_RECENT: usize = 5;

pub struct PathDialog {
    purpose: FilePurpose,
    folder: PathBuf,
    /// The typed text: a name in the folder. A typed folder becomes the one that is shown.
    name: String,
    listed: FolderListing,
    /// Folders of the user's own, by their names.
    places: Vec<(String, PathBuf)>,
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
            places: places(),
            is_begun: false,
            replaces: None,
            extension,
        }
    }

    pub fn show(&mut self, ui: &mut Ui, context: &mut DialogContext) -> DialogAnswer {
        set_width(ui, 640.0);
        ui.heading(tr(self.purpose.title()));
        if self.listed.folder != self.folder {
            self.listed = FolderListing::of(&self.folder, self.purpose);
        }
        self.show_folder(ui, context.settings);
        let room_pt = (ui.ctx().content_rect().height() - 210.0).max(120.0).min(LIST_PT);
        let mut chosen = None;
        let size = vec2(ui.available_width(), room_pt);
        ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Min), |ui| {
            ui.vertical(|ui| {
                ui.set_width(PLACES_PT);
                let area = ScrollArea::vertical().id_salt("places");
                let area = area.max_height(room_pt).min_scrolled_height(room_pt);
                area.show(ui, |ui| self.show_places(ui, context.settings));
            });
            ui.separator();
            ui.vertical(|ui| chosen = self.rows(ui, room_pt, context.pictures));
        });
        self.field(ui);
        // A whole path replaces the folder.
        let typed = self.folder.join(self.name.trim());
        let is_folder = platform::is_folder(&typed) && !self.name.trim().is_empty();
        let can = !self.name.trim().is_empty()
            && (is_folder || self.purpose.is_saving() || platform::is_file(&typed));
        let is_warned = self.replaces.as_ref() == Some(&typed);
        if is_warned {
            ui.colored_label(ui.visuals().warn_fg_color, tr("This file already exists."));
        }
        let yes = match self.purpose.is_saving() && !is_folder {
            true if is_warned => "Replace",
            true => "Save",
            false => "Open",
        };
        match (buttons(ui, yes, can), chosen) {
            (_, Some(file)) => self.choose(file),
            (Some(true), None) if is_folder => {
                self.go_to(typed);
                DialogAnswer::Open
            }
            (Some(true), None) => self.choose(typed),
            (Some(false), None) => DialogAnswer::Close,
            (None, None) => DialogAnswer::Open,
        }
    }

    /// Another folder is shown; the name of a file to be saved stays.
    fn go_to(&mut self, folder: PathBuf) {
        self.folder = folder;
        if !self.purpose.is_saving() {
            self.name.clear();
        }
        self.is_begun = false;
    }

    /// The folder, the one that it is in, and whether it is marked.
    fn show_folder(&mut self, ui: &mut Ui, settings: &mut Settings) {
        ui.horizontal(|ui| {
            let up = self.folder.parent().map(Path::to_owned);
            if ui.add_enabled(up.is_some(), Button::new(tr("Up"))).clicked() {
                self.go_to(up.unwrap_or_default());
            }
            let mut is_marked = settings.bookmarks.contains(&self.folder);
            let mark = ui.toggle_value(&mut is_marked, tr("Bookmark"));
            if mark.on_hover_text(tr("Lists this folder among the bookmarks")).changed() {
                settings.bookmarks.retain(|known| *known != self.folder);
                settings.bookmarks.extend(is_marked.then(|| self.folder.clone()));
            }
            ui.add(egui::Label::new(self.folder.display().to_string()).truncate());
        });
    }

    /// Folders to go to: the user's own, marked ones, and those of recent files.
    fn show_places(&mut self, ui: &mut Ui, settings: &Settings) {
        let mut recent: Vec<PathBuf> = Vec::new();
        for folder in settings.recent.iter().filter_map(|file| file.parent()) {
            if recent.len() < MOST_RECENT && !recent.iter().any(|known| known == folder) {
                recent.push(folder.to_owned());
            }
        }
        let named = |folder: &PathBuf| {
            let name = folder.file_name().unwrap_or(folder.as_os_str());
            (name.to_string_lossy().into_owned(), folder.clone())
        };
        let groups = [
            ("Places", self.places.clone()),
            ("Bookmarks", settings.bookmarks.iter().map(named).collect()),
            ("Recent", recent.iter().map(named).collect()),
        ];
        for (name, folders) in groups {
            if folders.is_empty() {
                continue;
            }
            title(ui, name);
            for (name, folder) in folders {
                let button = Button::selectable(folder == self.folder, name).truncate();
                if ui.add(button).on_hover_text(folder.display().to_string()).clicked() {
                    self.go_to(folder);
                }
            }
        }
    }

    /// The folders and files; a double-clicked file is chosen.
    fn rows(
        &mut self,
        ui: &mut Ui,
        height_pt: f32,
        pictures: &mut FilePictures,
    ) -> Option<PathBuf> {
        let folders = self.listed.folders.len();
        let all = folders + self.listed.files.len();
        let (mut entered, mut chosen) = (None, None);
        let area = ScrollArea::vertical().id_salt("files").auto_shrink([false, false]);
        let area = area.max_height(height_pt).min_scrolled_height(height_pt);
        area.show_rows(ui, ROW_PT, all, |ui, range| {
            for index in range {
                if let Some(folder) = self.listed.folders.get(index) {
                    let button = Button::new(format!("{folder}/")).frame(false);
                    let button = button.min_size(vec2(ui.available_width(), ROW_PT));
                    if ui.add(button).clicked() {
                        entered = Some(self.listed.folder.join(folder));
                    }
                    continue;
                }
                let Some(file) = self.listed.files.get(index - folders) else { continue };
                let path = self.listed.folder.join(file);
                let response = row(ui, file, *file == self.name, &path, pictures);
                if response.clicked() {
                    self.name.clone_from(file);
                }
                if response.double_clicked() {
                    chosen = Some(path);
                }
            }
            if all == 0 {
                ui.weak(tr("Nothing here that can be opened"));
            }
        });
        if let Some(folder) = entered {
            self.go_to(folder);
        }
        chosen
    }

    /// The field for the name. What is typed up to a separator is a folder, which is shown.
    fn field(&mut self, ui: &mut Ui) {
        let field = ui.horizontal(|ui| {
            let label = ui.label(tr("File"));
            ui.add(TextEdit::singleline(&mut self.name).desired_width(f32::INFINITY))
                .labelled_by(label.id)
        });
        let field = field.inner;
        set_accessible_name(&field, tr("File name"));
        if !std::mem::replace(&mut self.is_begun, true) {
            field.request_focus();
        }
        if field.changed() {
            self.take_typed_folder();
        }
        self.walk(ui, &field);
    }

    fn take_typed_folder(&mut self) {
        let Some(at) = self.name.rfind(std::path::is_separator) else { return };
        let (typed, rest) = self.name.split_at(at + 1);
        let folder = match typed.strip_prefix('~').filter(|rest| rest.starts_with('/')) {
            Some(within) => platform::home_folder().map(|home| home.join(&within[1..])),
            None => Some(self.folder.join(typed)),
        };
        let Some(folder) = folder.filter(|folder| platform::is_folder(folder)) else { return };
        let rest = rest.to_owned();
        (self.folder, self.name) = (folder, rest);
    }

    /// The arrows go through the files.
    fn walk(&mut self, ui: &Ui, field: &Response) {
        let (up, down) = ui.input(|i| (i.key_pressed(Key::ArrowUp), i.key_pressed(Key::ArrowDown)));
        if !field.has_focus() || up == down || self.listed.files.is_empty() {
            return;
        }
        let files = &self.listed.files;
        let now = files.iter().position(|file| *file == self.name);
        let next = match now {
            None if down => 0,
            None => files.len() - 1,
            Some(now) if down => (now + 1).min(files.len() - 1),
            Some(now) => now.saturating_sub(1),
        };
        self.name.clone_from(&files[next]);
    }

    /// Overwriting a file needs a second confirmation.
    fn choose(&mut self, file: PathBuf) -> DialogAnswer {
        // With its final name, so that the question is about the file that would be lost.
        let file = self.purpose.final_name(file, self.extension);
        if self.purpose.is_saving()
            && platform::is_file(&file)
            && self.replaces.as_ref() != Some(&file)
        {
            self.name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
            self.folder = file.parent().map_or_else(|| self.folder.clone(), Path::to_owned);
            self.replaces = Some(file);
            return DialogAnswer::Open;
        }
        DialogAnswer::Chosen(self.purpose, file)
    }
}

/// A file with its picture.
fn row(ui: &mut Ui, file: &str, is_on: bool, path: &Path, pictures: &mut FilePictures) -> Response {
    let button = match pictures.of(ui.ctx(), path) {
        Some(texture) => {
            let size = texture.size_vec2();
            let size = size * (PICTURE_PT / size.max_elem().max(1.0));
            let picture = Image::from_texture(SizedTexture::new(texture.id(), size));
            Button::image_and_text(picture.fit_to_exact_size(size), file)
        }
        None => Button::new(file),
    };
    let button = button.selected(is_on).frame_when_inactive(is_on);
    let response = ui.add(button.min_size(vec2(ui.available_width(), ROW_PT)));
    set_accessible_name(&response, file);
    response
}

/// The folders that systems have for a user, as far as they exist.
fn places() -> Vec<(String, PathBuf)> {
    let Some(home) = platform::home_folder() else { return Vec::new() };
    let within = ["Desktop", "Documents", "Pictures", "Downloads"];
    let mut places = vec![(tr("Home").to_owned(), home.clone())];
    places.extend(within.map(|name| (tr(name).to_owned(), home.join(name))));
    places.retain(|(_, folder)| platform::is_folder(folder));
    places
}

impl FolderListing {
    fn of(folder: &Path, purpose: FilePurpose) -> Self {
        let extensions: Vec<&str> =
            purpose.filters().into_iter().flat_map(|(_, extensions)| extensions).collect();
        let mut listed = Self { folder: folder.into(), ..Self::default() };
        for entry in platform::files::read_dir(folder).into_iter().flatten().flatten() {
            let (name, path) = (entry.file_name().to_string_lossy().into_owned(), entry.path());
            let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
            if name.starts_with('.') {
                continue;
            }
            if platform::is_folder(&path) {
                listed.folders.push(name);
            } else if extensions.contains(&extension.as_str()) {
                listed.files.push(name);
            }
        }
        let by_name = |name: &String| name.to_lowercase();
        listed.folders.sort_by_key(by_name);
        listed.files.sort_by_key(by_name);
        listed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_typed_folder_is_shown_and_the_rest_stays_the_name() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("deep")).unwrap();
        let mut dialog = PathDialog::new(FilePurpose::Open, folder.path().into(), "", "png");
        for (typed, name, within) in [
            ("deep/", "", "deep"),
            ("../deep/a.ora", "a.ora", "deep/../deep"),
            ("no/x", "no/x", ""),
        ] {
            dialog.name = typed.into();
            dialog.folder = folder.path().join(if typed.starts_with("..") { "deep" } else { "" });
            dialog.take_typed_folder();
            assert_eq!(dialog.name, name);
            let shown = folder.path().join(within);
            assert_eq!(dialog.folder.canonicalize().unwrap(), shown.canonicalize().unwrap());
        }
        let whole = folder.path().join("deep").join("b.png");
        dialog.name = whole.to_string_lossy().into_owned();
        dialog.take_typed_folder();
        assert_eq!((dialog.folder.join(&dialog.name), &*dialog.name), (whole, "b.png"));
    }
}
