//! The window: lays the panels out, does what they ask for, and tells what went wrong.
//! Floor 7.

use super::asked::{Asked, WindowAsk};
use super::canvas::Canvas;
use super::dialogs::{Answer, Dialog, Then, export, import, new, palette, path, unsaved};
use super::files::{self, Purpose};
use super::jobs::{Done, Jobs};
use super::swatches::Swatches;
use super::thumbnails::Thumbnails;
use super::{commands, keys, panels, sample};
use crate::math::Vec2;
use crate::session::actions::{FileAction, ViewAction};
use crate::session::{Action, Session, storage};
use eframe::egui::{self, CentralPanel, Frame, Margin, Panel, RichText, Ui, ViewportCommand};
use std::path::{Path, PathBuf};

/// The program's one window.
pub struct Window {
    pub session: Session,
    canvas: Canvas,
    thumbnails: Thumbnails,
    swatches: Swatches,
    jobs: Jobs,
    /// The last one is shown.
    dialogs: Vec<Dialog>,
    /// Sentences that stay until they are read.
    messages: Vec<String>,
    panels_hidden: bool,
    /// Which panel is in front above the layers.
    front: Front,
    recent: Vec<PathBuf>,
    export: export::Export,
    /// What the file dialog of the system is asked for with this name.
    title: String,
    /// The user agreed to leave.
    leaving: bool,
}

/// The panels that share a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Front {
    Color,
    Brushes,
    Properties,
    Surface,
    History,
    Navigator,
}

impl Front {
    const ALL: [(Front, &'static str); 6] = [
        (Front::Color, "Colour"),
        (Front::Brushes, "Brushes"),
        (Front::Properties, "Properties"),
        (Front::Surface, "Surface"),
        (Front::History, "History"),
        (Front::Navigator, "Navigator"),
    ];
}

impl Window {
    pub fn new(ctx: &egui::Context) -> Self {
        Self {
            session: Session::default(),
            canvas: Canvas::new(ctx),
            thumbnails: Thumbnails::new(ctx),
            swatches: Swatches::default(),
            jobs: Jobs::new(ctx),
            dialogs: Vec::new(),
            messages: Vec::new(),
            panels_hidden: false,
            front: Front::Color,
            recent: Vec::new(),
            export: export::Export::default(),
            title: String::new(),
            leaving: false,
        }
    }
    /// Opens what the program was started with.
    pub fn begin(&mut self, files: Vec<PathBuf>) {
        if files.is_empty() {
            self.jobs.start("Opening the sample".into(), || Done::Opened(Box::new(sample::open())));
        }
        for file in files {
            self.jobs.open(file);
        }
    }
    /// One frame.
    pub fn show(&mut self, ui: &mut Ui) {
        let mut asked = Asked::default();
        self.finish_jobs(ui.ctx());
        self.thumbnails.collect(ui.ctx());
        if self.dialogs.is_empty() {
            keys::listen(ui.ctx(), &self.session, &mut asked);
        }
        self.take_dropped(ui.ctx(), &mut asked);
        self.lay_out(ui, &mut asked);
        self.show_dialog(ui.ctx(), &mut asked);
        self.guard_leaving(ui.ctx());
        self.do_asked(ui.ctx(), asked);
        self.set_title(ui.ctx());
    }
    fn lay_out(&mut self, ui: &mut Ui, asked: &mut Asked) {
        let bar = |ui: &Ui| Frame::side_top_panel(ui.style()).inner_margin(Margin::symmetric(6, 3));
        Panel::top("menu").frame(bar(ui)).show(ui, |ui| panels::menu::show(ui, &self.session, &self.recent, asked));
        if !self.panels_hidden {
            Panel::top("options").frame(bar(ui)).show(ui, |ui| panels::options::show(ui, &self.session, asked));
            Panel::bottom("status")
                .frame(bar(ui))
                .show(ui, |ui| panels::status::show(ui, &self.session, &self.canvas, asked));
            Panel::left("tools").exact_size(44.0).resizable(false).frame(bar(ui)).show(ui, |ui| {
                panels::tools::show(ui, &self.session, asked);
            });
            Panel::right("panels").default_size(268.0).size_range(230.0..=460.0).show(ui, |ui| self.side(ui, asked));
        }
        if !self.session.tabs.is_empty() {
            Panel::top("tabs").frame(bar(ui)).show(ui, |ui| panels::menu::tabs(ui, &self.session, asked));
        }
        self.show_messages(ui);
        CentralPanel::no_frame().show(ui, |ui| self.canvas.show(ui, &self.session, &mut asked.actions));
    }
    /// The panels at the right: one of those above, the layers below.
    fn side(&mut self, ui: &mut Ui, asked: &mut Asked) {
        Panel::top("front").resizable(true).default_size(330.0).size_range(140.0..=640.0).show(ui, |ui| {
            ui.horizontal_wrapped(|ui| {
                for (front, name) in Front::ALL {
                    ui.selectable_value(&mut self.front, front, name);
                }
            });
            ui.add_space(2.0);
            egui::ScrollArea::vertical().id_salt("front").auto_shrink([false, false]).show(ui, |ui| match self.front {
                Front::Color => panels::colors::show(ui, &self.session, asked),
                Front::Brushes => panels::brushes::show(ui, &self.session, &mut self.swatches, asked),
                Front::Properties => panels::properties::show(ui, &self.session, asked),
                Front::Surface => panels::surface::show(ui, &self.session, asked),
                Front::History => panels::history::show(ui, &self.session, asked),
                Front::Navigator => panels::navigator::show(ui, &self.session, &mut self.canvas, asked),
            });
        });
        CentralPanel::no_frame().show(ui, |ui| {
            ui.add_space(4.0);
            panels::layers::show(ui, &self.session, &mut self.thumbnails, asked);
        });
    }
    fn show_messages(&mut self, ui: &mut Ui) {
        if self.messages.is_empty() {
            return;
        }
        let mut read = None;
        Panel::top("messages").show(ui, |ui| {
            for (i, message) in self.messages.iter().enumerate() {
                ui.horizontal_wrapped(|ui| {
                    if ui.button("Dismiss").clicked() {
                        read = Some(i);
                    }
                    ui.label(RichText::new(message).color(ui.visuals().warn_fg_color));
                });
            }
        });
        if let Some(i) = read {
            self.messages.remove(i);
        }
    }
    fn show_dialog(&mut self, ctx: &egui::Context, asked: &mut Asked) {
        let Some(dialog) = self.dialogs.last_mut() else { return };
        let answer = dialog.show(ctx, &self.session, asked);
        if let Dialog::Export(export) = dialog {
            self.export = export.clone();
        }
        match answer {
            Answer::Open => return,
            // The dialog stays while a file is chosen for it.
            Answer::Ask(ask @ WindowAsk::Choose(_)) => return asked.ask(ask),
            Answer::Import(source) => {
                let read = move || Done::Read(Box::new(storage::import(&source)));
                return self.jobs.start("Reading maps".into(), read);
            }
            _ => drop(self.dialogs.pop()),
        }
        match answer {
            Answer::Chosen(purpose, file) => self.chosen(purpose, file),
            Answer::Imported(opened) => self.session.adopt(*opened),
            Answer::Discard(then) => self.proceed(ctx, then, true),
            Answer::SaveThen(then) => {
                if self.save() {
                    self.proceed(ctx, then, false);
                }
            }
            Answer::Ask(ask) => asked.ask(ask),
            Answer::Open | Answer::Close | Answer::Import(_) => {}
        }
    }
    /// Does what was asked for.
    fn do_asked(&mut self, ctx: &egui::Context, asked: Asked) {
        for action in asked.actions {
            if let Err(error) = action.apply(&mut self.session) {
                self.messages.push(error.to_string());
            }
        }
        self.messages.append(&mut self.session.notes);
        for ask in asked.window {
            self.do_ask(ctx, ask);
        }
    }
    fn do_ask(&mut self, ctx: &egui::Context, ask: WindowAsk) {
        match ask {
            WindowAsk::NewDialog => self.dialogs.push(Dialog::New(new::New::default())),
            WindowAsk::OpenDialog => files::ask(&mut self.jobs, Purpose::Open, ""),
            WindowAsk::OpenMapsDialog => self.dialogs.push(Dialog::Import(Box::default())),
            WindowAsk::Choose(purpose) => files::ask(&mut self.jobs, purpose, ""),
            WindowAsk::PlaceDialog => files::ask(&mut self.jobs, Purpose::Place, ""),
            WindowAsk::Open(file) => self.jobs.open(file),
            WindowAsk::OpenSample => {
                self.jobs.start("Opening the sample".into(), || Done::Opened(Box::new(sample::open())))
            }
            WindowAsk::Save => drop(self.save()),
            WindowAsk::SaveAs => self.ask_where(Purpose::Save),
            WindowAsk::ExportDialog => self.dialogs.push(Dialog::Export(self.export.clone())),
            WindowAsk::Export(ending) => {
                self.export.ending = ending;
                self.ask_where(Purpose::Export);
            }
            WindowAsk::Close(tab) => self.close(ctx, tab),
            WindowAsk::Quit => ctx.send_viewport_cmd(ViewportCommand::Close),
            WindowAsk::CopyMerged => self.copy_merged(ctx),
            WindowAsk::Paste => self.paste(),
            WindowAsk::Palette => self.dialogs.push(Dialog::Palette(palette::Palette::default())),
            WindowAsk::Shortcuts => self.dialogs.push(Dialog::Shortcuts(String::new())),
            WindowAsk::About => self.dialogs.push(Dialog::About),
            WindowAsk::TogglePanels => self.panels_hidden = !self.panels_hidden,
            WindowAsk::ToggleTheme => {
                let dark = ctx.global_style().visuals.dark_mode;
                ctx.set_theme(if dark { egui::Theme::Light } else { egui::Theme::Dark });
            }
            WindowAsk::Scale(scale) => self.scale(ctx, scale),
            WindowAsk::FullScreen => {
                let is_full = ctx.input(|i| i.viewport().fullscreen.unwrap_or(false));
                ctx.send_viewport_cmd(ViewportCommand::Fullscreen(!is_full));
            }
        }
    }
    fn apply(&mut self, action: &Action) -> bool {
        let done = action.apply(&mut self.session);
        let is_done = done.is_ok();
        self.messages.extend(done.err().map(|error| error.to_string()));
        self.messages.append(&mut self.session.notes);
        is_done
    }
    /// 0 fits the canvas; 1 is a pixel of the canvas to one of the screen.
    fn scale(&mut self, ctx: &egui::Context, scale: f32) {
        let action = if scale > 0.0 {
            ViewAction::ZoomTo { zoom: scale / ctx.pixels_per_point() }
        } else {
            ViewAction::Fit { window_pt: self.canvas.area_pt }
        };
        self.apply(&Action::View(action));
    }
    fn finish_jobs(&mut self, ctx: &egui::Context) {
        for done in self.jobs.finished() {
            match done {
                Done::Opened(opened) => match *opened {
                    Ok(opened) => {
                        self.recent_is(opened.tab.file.clone());
                        self.session.adopt(opened);
                        self.messages.append(&mut self.session.notes);
                    }
                    Err(error) => self.messages.push(error.to_string()),
                },
                Done::IsMap(file) => {
                    let import = import::Import::of(Some(&file));
                    self.dialogs.push(Dialog::Import(Box::new(import)));
                }
                Done::Read(found) => {
                    if let Some(import) = self.import() {
                        import.take(ctx, *found);
                    }
                }
                Done::Chosen(purpose, Some(file)) => self.chosen(purpose, file),
                Done::Chosen(purpose, None) => {
                    let folder = self.folder();
                    let name = if purpose.is_saving() { self.proposed(purpose) } else { String::new() };
                    self.dialogs.push(Dialog::Path(path::PathDialog::new(purpose, folder, &name)));
                }
                Done::Cancelled => {}
            }
        }
    }
    /// A file was chosen in a dialog.
    fn chosen(&mut self, purpose: Purpose, file: PathBuf) {
        match purpose {
            Purpose::Open => self.jobs.open(file),
            Purpose::Place => {
                let at = self.session.shown().map_or(Vec2::ZERO, |document| document.size.center());
                self.apply(&Action::File(FileAction::Place { file, at }));
            }
            Purpose::NormalMap | Purpose::DepthMap | Purpose::MaskMap => {
                if let Some(import) = self.import() {
                    import.take_file(purpose, file);
                }
            }
            Purpose::Save => {
                let file = storage::with_ending(file);
                if self.apply(&Action::File(FileAction::Save { file: file.clone() })) {
                    self.recent_is(Some(file));
                }
            }
            Purpose::Export => {
                let file =
                    if file.extension().is_some() { file } else { file.with_added_extension(self.export.ending) };
                let (background, quality) = (self.export.background, self.export.quality);
                self.apply(&Action::File(FileAction::Export { file, background, quality }));
            }
        }
    }
    /// The import dialog, where it is open.
    fn import(&mut self) -> Option<&mut import::Import> {
        self.dialogs.iter_mut().rev().find_map(|dialog| match dialog {
            Dialog::Import(import) => Some(&mut **import),
            _ => None,
        })
    }
    fn ask_where(&mut self, purpose: Purpose) {
        let name = self.proposed(purpose);
        files::ask(&mut self.jobs, purpose, &name);
    }
    /// The name a file is proposed to have.
    fn proposed(&self, purpose: Purpose) -> String {
        let title = self.session.tab().map_or_else(String::new, |tab| tab.title());
        let ending = if purpose == Purpose::Export { self.export.ending } else { storage::DOCUMENTS[0] };
        Path::new(&title).with_extension(ending).to_string_lossy().into_owned()
    }
    /// The folder to begin in.
    fn folder(&self) -> PathBuf {
        let beside =
            self.session.tab().and_then(|tab| tab.file.as_deref()).or(self.recent.first().map(PathBuf::as_path));
        let folder = beside.and_then(Path::parent).filter(|folder| folder.is_dir()).map(Path::to_owned);
        folder.or_else(|| std::env::current_dir().ok()).unwrap_or_default()
    }
    fn recent_is(&mut self, file: Option<PathBuf>) {
        let Some(file) = file else { return };
        self.recent.retain(|known| *known != file);
        self.recent.insert(0, file);
        self.recent.truncate(12);
    }
    /// Saves the document in front; whether that was possible without asking.
    fn save(&mut self) -> bool {
        match self.session.tab().and_then(|tab| tab.file.clone()).filter(|file| storage::is_document(file)) {
            Some(file) => self.apply(&Action::File(FileAction::Save { file })),
            None => {
                self.ask_where(Purpose::Save);
                false
            }
        }
    }
    fn close(&mut self, ctx: &egui::Context, tab: usize) {
        if self.session.tabs.get(tab).is_some_and(|tab| tab.is_dirty()) {
            self.session.current = tab;
            self.dialogs.push(Dialog::Unsaved(unsaved::Unsaved { tab, then: Then::Close(tab) }));
        } else {
            self.proceed(ctx, Then::Close(tab), false);
        }
    }
    /// After the question about unsaved work. `discarding`: the tab asked about is given up.
    fn proceed(&mut self, ctx: &egui::Context, then: Then, discarding: bool) {
        match then {
            Then::Close(tab) => self.session.close_tab(tab),
            Then::Quit => {
                if discarding {
                    self.session.close_tab(self.session.current);
                }
                ctx.send_viewport_cmd(ViewportCommand::Close);
            }
        }
    }
    /// The window is about to be closed: not while there is unsaved work that nobody gave up.
    fn guard_leaving(&mut self, ctx: &egui::Context) {
        if self.leaving || !ctx.input(|i| i.viewport().close_requested()) {
            return;
        }
        match self.session.tabs.iter().position(|tab| tab.is_dirty()) {
            Some(tab) => {
                ctx.send_viewport_cmd(ViewportCommand::CancelClose);
                self.session.current = tab;
                self.dialogs.push(Dialog::Unsaved(unsaved::Unsaved { tab, then: Then::Quit }));
            }
            None => self.leaving = true,
        }
    }
    /// Files dropped on the window: pictures go where they fall, all else is opened.
    fn take_dropped(&mut self, ctx: &egui::Context, asked: &mut Asked) {
        let dropped = ctx.input(|i| i.raw.dropped_files.clone());
        for file in dropped {
            let path = file.path().to_path_buf();
            match storage::kind_of(&path) {
                Ok(storage::Kind::Picture) if self.session.tab().is_some() => {
                    let center = self.session.shown().map_or(Vec2::ZERO, |document| document.size.center());
                    let at = self.canvas.under.unwrap_or(center);
                    asked.act(Action::File(FileAction::Place { file: path, at }));
                }
                Ok(_) => asked.ask(WindowAsk::Open(path)),
                Err(error) => self.messages.push(error.to_string()),
            }
        }
    }
    fn copy_merged(&mut self, ctx: &egui::Context) {
        let Some(document) = self.session.shown() else { return };
        let rgba = self.canvas.grid.to_straight_rgba(document.size.rect());
        let size = [document.size.width as usize, document.size.height as usize];
        ctx.copy_image(egui::ColorImage::from_rgba_unmultiplied(size, &rgba));
    }
    fn paste(&mut self) {
        let pasted = arboard::Clipboard::new().and_then(|mut clipboard| clipboard.get_image());
        let Ok(image) = pasted else {
            return self.messages.push("There is no picture in the clipboard.".into());
        };
        let size = crate::math::Size::new(image.width as u32, image.height as u32);
        let texels = image.bytes.as_chunks::<4>().0.to_vec();
        if let Some(picture) = crate::raster::Picture::srgb8(size, texels) {
            let center = self.session.shown().map_or(Vec2::ZERO, |document| document.size.center());
            let at = self.canvas.under.unwrap_or(center);
            crate::session::actions::files::place(&mut self.session, "pasted.png", picture, at);
        }
    }
    fn set_title(&mut self, ctx: &egui::Context) {
        let title = self.session.tab().map_or_else(
            || "Rilievo".to_owned(),
            |tab| format!("{}{} – Rilievo", if tab.is_dirty() { "• " } else { "" }, tab.title()),
        );
        if title != self.title {
            ctx.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }
    /// Runs a command by its name, as a menu would.
    pub fn command(&mut self, ctx: &egui::Context, name: &str) {
        let mut asked = Asked::default();
        if let Some(command) = commands::named(name).filter(|command| (command.can)(&self.session)) {
            (command.run)(&self.session, &mut asked);
        }
        self.do_asked(ctx, asked);
    }
}

impl eframe::App for Window {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.show(ui);
    }
}
