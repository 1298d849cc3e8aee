//! The window: lays the panels out, does what they ask for, and tells what went wrong.
//! Floor 7. `layout` says where the panels stand, `files` and `leaving` hold what files ask for.

mod files;
mod layout;
mod leaving;

use super::asked::{Asked, WindowAsk};
use super::canvas::Canvas;
use super::dialogs::{Answer, Dialog, export, new, palette};
use super::files::{self as choosing, Purpose};
use super::jobs::{Done, Jobs};
use super::swatches::Swatches;
use super::thumbnails::Thumbnails;
use super::{commands, keys, sample};
use crate::session::actions::ViewAction;
use crate::session::{Action, Session, storage};
use eframe::egui::{self, Ui, ViewportCommand};
use std::path::PathBuf;

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
            WindowAsk::OpenDialog => choosing::ask(&mut self.jobs, Purpose::Open, ""),
            WindowAsk::OpenMapsDialog => self.dialogs.push(Dialog::Import(Box::default())),
            WindowAsk::Choose(purpose) => choosing::ask(&mut self.jobs, purpose, ""),
            WindowAsk::PlaceDialog => choosing::ask(&mut self.jobs, Purpose::Place, ""),
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
