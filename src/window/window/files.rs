//! Files of the window's documents: handles what was opened or chosen, and proposes file names.
//! Floor 7.

use super::MainWindow;
use crate::advice::with_advice;
use crate::dialogs::{Dialog, import, path, shape};
use crate::document::SurfaceSource;
use crate::file_purpose::FilePurpose;
use crate::files::{self, FileAnswer};
use crate::io::maps::ImportedSurface;
use crate::io::palette::PaletteFormat;
use crate::io::platform;
use crate::io::{Budget, Overwrite};
use crate::jobs::{JobKind, JobResult, PastePlace, PictureUse, PinPosition, short};
use crate::language::tr;
use crate::math::{ColorProfile, Vec2};
use crate::paint::ColorAdjustment;
use crate::paint::adjustment::ColorLookup;
use crate::raster::Picture;
use crate::session::actions::LayerAction;
use crate::session::actions::files::export_lines;
use crate::session::actions::placing::{place, read_picture};
use crate::session::actions::{ClipboardAction, FileAction, PaletteAction, PastedPicture};
use crate::session::actions::{palettes, pictures};
use crate::session::script::{self, PlayedScript};
use crate::session::storage::{self, FileUse, OpenedFile, SortedFiles};
use crate::session::{Action, PaletteShelf, PicturePart, Property, Session, brushes};
use crate::titles::title_of;
use crate::tr;
use eframe::egui;
use std::path::{Path, PathBuf};

/// What to do with maps.
type GiveMaps = fn(&mut Session, &SurfaceSource, ImportedSurface) -> crate::Result<()>;

impl MainWindow {
    pub(super) fn finish_jobs(&mut self, ctx: &egui::Context) {
        for done in self.results(ctx) {
            done.finish(self, ctx);
        }
    }

    /// Opens files that came together; those of brushes are imported. `use_of`: what becomes of
    /// pictures; absent: they open as documents.
    pub(super) fn open_files(&mut self, files: Vec<PathBuf>, use_of: Option<PictureUse>) {
        let name = match &files[..] {
            [file] => tr!("Opening {file}", file = short(file)),
            files => tr!("Opening {count} files", count = files.len()),
        };
        self.jobs.start(name, JobKind::Working, move |_| {
            let (mut known, mut done) = (Vec::new(), Vec::new());
            let (brushes, files): (Vec<_>, Vec<_>) =
                files.into_iter().partition(|file| brushes::is_brush_file(file));
            done.extend(brushes.into_iter().map(|file| {
                JobResult::then(move |window: &mut Self, _| {
                    window.apply(&Action::File(FileAction::ImportBrush { file }));
                })
            }));
            for file in files {
                match storage::kind_of(&file) {
                    Ok(kind) => known.push((file, kind)),
                    Err(error) => done.push(JobResult::from_error(error)),
                }
            }
            let SortedFiles { objects, others } = storage::sort_files(known);
            // Of maps the import dialog shows the conventions first.
            done.extend(objects.into_iter().map(|source| {
                let dialog = import::ImportDialog::of(source);
                JobResult::then(|window: &mut Self, _| {
                    window.dialogs.push(Dialog::Import(Box::new(dialog)));
                })
                .in_front()
            }));
            done.extend(others.into_iter().map(|(file, kind)| {
                let use_of = use_of.filter(|_| kind == FileUse::Picture);
                JobResult::then(move |window: &mut Self, _| match use_of {
                    Some(use_of) => window.read_layer(file, use_of),
                    None if kind == FileUse::Script => window.play_script(file),
                    None => window.read_document(file),
                })
            }));
            JobResult::all(done)
        });
    }

    fn read_document(&mut self, file: PathBuf) {
        let name = tr!("Opening {file}", file = short(&file));
        self.jobs.start(name, JobKind::Working, move |_| {
            let opened = storage::open(&file);
            JobResult::of(opened, |window: &mut Self, opened| window.add_opened(Some(file), opened))
                .in_front()
        });
    }

    /// Plays a script; the documents that it leaves open come in front.
    fn play_script(&mut self, file: PathBuf) {
        let name = tr!("Playing {file}", file = short(&file));
        self.jobs.start(name, JobKind::Working, move |progress| {
            match script::play(&file, progress) {
                Ok(Some(played)) => JobResult::then(move |window: &mut Self, _| {
                    window.show_played(&file, played);
                })
                .in_front(),
                Ok(None) => JobResult::nothing(),
                Err(error) => JobResult::from_error(error),
            }
        });
    }

    fn show_played(&mut self, file: &Path, played: PlayedScript) {
        played.open_documents.into_iter().for_each(|open| self.session.add_document(open));
        self.messages.extend(played.notes);
        if played.skipped > 0 {
            self.jobs.say(tr!("{file} was played, without writing files", file = short(file)));
        }
    }

    /// A document was opened, from a file if it has one.
    pub(super) fn add_opened(&mut self, file: Option<PathBuf>, opened: OpenedFile) {
        self.recent_is(file.clone());
        let is_svg = |file: &PathBuf| {
            file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("svg"))
        };
        let svg = file.clone().filter(is_svg);
        let drawing = opened.drawing.filter(|traits| traits.has_outline() || svg.is_some());
        self.session.adopt(opened);
        if let (Some(traits), Some(open)) = (drawing, self.session.active()) {
            self.dialogs.push(Dialog::Shape(shape::ShapeDialog::of_picture(open, traits, svg)));
        }
        if let Some(file) = file {
            self.did(|| Action::File(FileAction::Open { file }));
        }
        self.tell_notes();
    }

    /// Reads a picture that becomes a layer.
    fn read_layer(&mut self, file: PathBuf, use_of: PictureUse) {
        self.jobs.start(tr!("Reading {file}", file = short(&file)), JobKind::Working, move |_| {
            let read = read_picture(&file);
            JobResult::of(read, move |window: &mut Self, (name, picture)| match use_of {
                PictureUse::Pasted(place) => {
                    window.paste_picture(PastedPicture { name, picture }, place);
                    window.session.note_read(&file);
                }
                PictureUse::Placed(at) => {
                    let at = window.add_picture_layer(&name, picture, at);
                    window.session.note_read(&file);
                    window.did(|| Action::File(FileAction::Place { file, at }));
                }
            })
        });
    }

    /// What the user chose in the system's dialog for files.
    fn take_file_answer(&mut self, purpose: FilePurpose, answer: FileAnswer) {
        match answer {
            FileAnswer::File(file) => self.use_chosen_file(purpose, file),
            FileAnswer::Canceled => {}
            FileAnswer::Nowhere => {
                let folder = self.folder();
                let name =
                    if purpose.is_saving() { self.propose_name(purpose) } else { String::new() };
                let dialog = path::PathDialog::new(purpose, folder, &name, self.export.extension);
                self.dialogs.push(Dialog::Path(dialog));
            }
        }
    }

    /// The user's own brushes are kept here from now on; existing ones are added to the list.
    pub fn keep_brushes_in(&mut self, folder: PathBuf) {
        self.session.brush_folder = Some(folder.clone());
        self.jobs.start(tr("Reading brushes").into(), JobKind::Working, move |_| {
            let (presets, notes) = brushes::load_brushes(&folder);
            JobResult::then(|window: &mut Self, _| {
                brushes::adopt(&mut window.session, presets);
                window.messages.extend(notes);
            })
        });
    }

    /// The user's own palettes are kept here from now on; existing ones are added to the list.
    pub fn keep_palettes_in(&mut self, folder: PathBuf) {
        self.jobs.start(tr("Reading palettes").into(), JobKind::Working, move |_| {
            let (shelf, notes) = PaletteShelf::load(&folder);
            JobResult::then(|window: &mut Self, _| {
                window.session.palettes = shelf;
                window.messages.extend(notes);
            })
        });
    }

    /// Reads a picture for the selected layer.
    fn read_part(&mut self, part: PicturePart, file: PathBuf) {
        let Some((key, layer)) =
            self.session.active().and_then(|open| Some((open.key, open.active_layer?)))
        else {
            return;
        };
        self.jobs.start(tr!("Reading {file}", file = short(&file)), JobKind::Working, move |_| {
            let read = pictures::read(part, &file);
            JobResult::of(read, move |window: &mut Self, read| {
                let all = &mut window.session.open_documents;
                let Some(open) = all.iter_mut().find(|other| other.key == key) else { return };
                pictures::put(open, layer, read);
                open.reads.push(file.clone());
                window.did(|| Action::File(FileAction::Use { part, file }));
            })
        });
    }

    /// A picture becomes a layer. It goes to the pointer's place once it was read: the system does
    /// not report positions of dragged files. Returns the position.
    pub(super) fn add_picture_layer(
        &mut self,
        name: &str,
        picture: Picture,
        at: PinPosition,
    ) -> Vec2 {
        let center =
            self.session.shown_document().map_or(Vec2::ZERO, |document| document.size.center());
        let at = self.canvas.under.filter(|_| at == PinPosition::Pointer).unwrap_or(center);
        // Pictures are read in sRGB.
        place(&mut self.session, name, picture, ColorProfile::default(), at);
        at
    }

    /// A picture of another program is pasted.
    pub(super) fn paste_picture(
        &mut self,
        picture: PastedPicture,
        PastePlace { to, at }: PastePlace,
    ) {
        self.apply(&Action::Clipboard(ClipboardAction::PastePicture { picture, to, at }));
    }

    /// A table of colors for the dialog that is open, or for the selected adjustment layers.
    fn read_color_table(&mut self, file: &Path) {
        let budget = Budget::of_this_machine();
        let read = crate::io::files::read_file(file, budget.json_bytes);
        let table = match read.and_then(|bytes| crate::io::cube::parse(file, &bytes)) {
            Ok(table) => table,
            Err(error) => return self.messages.push(with_advice(&error)),
        };
        let to = ColorAdjustment::ColorLookup(ColorLookup { table: Some(table) });
        if let Some(Dialog::PaintChange(change)) = self.dialogs.last_mut()
            && change.can_take_table()
        {
            return change.take_table(to);
        }
        let layer = self.session.layer_paths();
        let to = Property::Adjustment { to };
        self.apply(&Action::Layer(LayerAction::Set { layer, to, done: true }));
    }

    /// A file was chosen in a dialog.
    pub(super) fn use_chosen_file(&mut self, purpose: FilePurpose, file: PathBuf) {
        match purpose {
            FilePurpose::Open => self.open_files(vec![file], None),
            FilePurpose::Place => {
                self.read_layer(file, PictureUse::Placed(PinPosition::Middle));
            }
            FilePurpose::ImportUnwrapped => self.import_unwrapped(file),
            FilePurpose::ColorProfile => self.proof_with(file),
            FilePurpose::Reference => self.pin_reference(file),
            FilePurpose::Brush => {
                self.apply(&Action::File(FileAction::ImportBrush { file }));
            }
            FilePurpose::Part(part) => self.read_part(part, file),
            FilePurpose::Palette => {
                self.apply(&Action::Palette(PaletteAction::Import { file }));
            }
            FilePurpose::ColorTable => self.read_color_table(&file),
            FilePurpose::NormalMap | FilePurpose::DepthMap | FilePurpose::MaskMap => {
                if let Some(import) = self.import() {
                    import.take_file(purpose, file);
                }
            }
            FilePurpose::ExportMaps => self.export_maps_to(file),
            FilePurpose::Save
            | FilePurpose::Export
            | FilePurpose::ExportUnwrapped
            | FilePurpose::ExportLines
            | FilePurpose::ExportPalette(_) => {
                self.write_chosen_file(purpose, file);
            }
        }
    }

    /// Gives the document in front maps, as another dialog asked.
    pub(super) fn take_maps(
        &mut self,
        (source, import): (SurfaceSource, ImportedSurface),
        give: GiveMaps,
    ) {
        let done = give(&mut self.session, &source, import);
        self.messages.extend(done.err().map(|error| with_advice(&error)));
        self.tell_notes();
    }

    /// A file was chosen to be written. Where it is there the dialog asked about it, unless it gets
    /// another name here.
    fn write_chosen_file(&mut self, purpose: FilePurpose, file: PathBuf) {
        let named = purpose.final_name(file.clone(), self.export.extension);
        let was_asked = named == file && platform::is_file(&named);
        let over = if was_asked { Overwrite::Anything } else { Overwrite::Nothing };
        if let FilePurpose::ExportPalette(format) = purpose {
            self.export_palette(named, format, over);
        } else if purpose == FilePurpose::ExportLines {
            self.export_lines(named, over);
        } else if purpose == FilePurpose::Save {
            let then = self.after_saving.take();
            self.save_to(named, over, false, then);
        } else {
            self.export_to(named, over, purpose == FilePurpose::ExportUnwrapped);
        }
    }

    /// The palette that is shown; it takes no time.
    fn export_palette(&mut self, file: PathBuf, format: PaletteFormat, over: Overwrite) {
        let palette = self.session.palettes.shown.clone();
        let done = palettes::export(&self.session, palette.as_deref(), &file, format, over);
        match done {
            Ok(()) => {
                let format = Some(format);
                self.did(|| Action::Palette(PaletteAction::Export { palette, file, format }));
            }
            Err(error) => self.messages.extend([with_advice(&error)]),
        }
    }

    /// The lines of the form; it takes no time.
    fn export_lines(&mut self, file: PathBuf, over: Overwrite) {
        match export_lines(&self.session, &file, over) {
            Ok(()) => self.did(|| Action::File(FileAction::ExportLines { file })),
            Err(error) => self.messages.extend([with_advice(&error)]),
        }
    }

    /// The import dialog, if it is open.
    pub(super) fn import(&mut self) -> Option<&mut import::ImportDialog> {
        self.dialogs.iter_mut().rev().find_map(|dialog| match dialog {
            Dialog::Import(import) => Some(&mut **import),
            _ => None,
        })
    }

    pub(super) fn ask_where(&mut self, purpose: FilePurpose) {
        let name = self.propose_name(purpose);
        self.ask_for(purpose, &name);
    }

    pub(super) fn ask_for(&mut self, purpose: FilePurpose, name: &str) {
        let then = move |window: &mut Self, answer| window.take_file_answer(purpose, answer);
        let asks_itself = self.asks_itself || self.settings.preferences.has_own_file_dialog;
        files::request(&mut self.jobs, purpose, name, asks_itself, then);
    }

    /// The proposed name of a file.
    pub(super) fn propose_name(&self, purpose: FilePurpose) -> String {
        let title = self.session.active().map_or_else(String::new, title_of);
        let stem = storage::without_ending(&title);
        if purpose == FilePurpose::ExportUnwrapped {
            return format!("{stem}-unwrapped.png");
        }
        if purpose == FilePurpose::ExportLines {
            return format!("{stem}-lines.svg");
        }
        if let FilePurpose::ExportPalette(format) = purpose {
            let name = self.session.shown_palette().map(|palette| palette.name.as_str());
            let name = name.filter(|name| !name.is_empty()).unwrap_or(stem);
            return format!("{}.{}", name.replace(['/', '\\'], "-"), format.extension());
        }
        let extension = match purpose {
            FilePurpose::Export => self.export.extension,
            FilePurpose::ExportMaps if self.maps.options.is_exr => "exr",
            FilePurpose::ExportMaps => "png",
            _ => storage::SAVED[0],
        };
        // For several files the name of the first, so that the user sees what the names will be.
        let suffix = match purpose {
            FilePurpose::ExportMaps => self.maps.maps().first().map_or("", |map| map.name()),
            _ => "",
        };
        self.name_beside_sources(&format!("{stem}{suffix}"), extension)
    }

    /// A file name, counted on where a file of it is what an open document was made from: that one
    /// may not be replaced.
    fn name_beside_sources(&self, stem: &str, extension: &str) -> String {
        let reads = self.session.reads();
        let is_source = |name: &str| reads.iter().any(|read| read.ends_with(name));
        let plain = format!("{stem}.{extension}");
        let counted = (2..).map(|count| format!("{stem} {count}.{extension}"));
        std::iter::once(plain).chain(counted).find(|name| !is_source(name)).unwrap_or_default()
    }

    /// The folder to begin in.
    pub(super) fn folder(&self) -> PathBuf {
        let beside = self.session.active().and_then(|open| open.file.as_deref()).or(self
            .settings
            .recent
            .first()
            .map(PathBuf::as_path));
        let folder = beside
            .and_then(Path::parent)
            .filter(|folder| platform::is_folder(folder))
            .map(Path::to_owned);
        folder.or_else(|| platform::current_folder().ok()).unwrap_or_default()
    }

    pub(super) fn recent_is(&mut self, file: Option<PathBuf>) {
        if let Some(file) = file {
            // An absolute path, which is also valid in the next run.
            let file = std::path::absolute(&file).unwrap_or(file);
            self.menu.pictures.forget(&file);
            self.settings.recent_is(file);
        }
    }
}
