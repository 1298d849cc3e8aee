//! The window: lays the panels out, does what they ask for, and tells what went wrong.
//! Floor 7. `layout` says where the panels stand, `files` and `leaving` hold what files ask for.

mod files;
mod interface;
mod layout;
mod leaving;
mod steps;
mod work;

use super::asked::{Asked, WindowAsk};
use super::canvas::Canvas;
use super::clipboard::{self, Clipboard};
use super::dialogs::{Answer, Dialog, Then, export, import, new, palette, shortcuts};
use super::files::Purpose;
use super::jobs::{Done, Jobs, While};
use super::memory::Memory;
use super::pen::SharedTablet;
use super::settings::{Keeper, Settings, Side};
use super::swatches::Swatches;
use super::thumbnails::Thumbnails;
use super::{commands, keys, sample};
use crate::document::Progress;
use crate::session::actions::ViewAction;
use crate::session::replay::Replayed;
use crate::session::{Action, Session, storage};
use eframe::egui::{self, Ui, ViewportCommand};
use std::path::PathBuf;

/// The program's one window.
pub struct Window {
    pub session: Session,
    canvas: Canvas,
    thumbnails: Thumbnails,
    swatches: Swatches,
    pub(super) jobs: Jobs,
    /// The last one is shown.
    pub(super) dialogs: Vec<Dialog>,
    /// Sentences that stay until they are read.
    pub(super) messages: Vec<String>,
    settings: Settings,
    keeper: Keeper,
    /// Not with the dialogs of the system.
    asks_itself: bool,
    /// The program was started without a file, so the sample is open.
    is_first_start: bool,
    export: export::Export,
    /// What the file dialog of the system is asked for with this name.
    title: String,
    /// The look that is remembered was put on.
    is_dressed: bool,
    /// The user agreed to leave.
    leaving: bool,
    /// What is to be done once the document is saved.
    after_saving: Option<Then>,
    memory: Memory,
    /// What was copied last; kept, so that it stays in the system's clipboard.
    clipboard: Option<Clipboard>,
    /// What was done, while that is written down.
    recorded: Option<Vec<Action>>,
}

impl Window {
    /// A window that remembers nothing.
    pub fn new(ctx: &egui::Context) -> Self {
        Self::remembering(ctx, None)
    }
    /// A window with the settings of a file, kept there from now on.
    pub fn remembering(ctx: &egui::Context, file: Option<PathBuf>) -> Self {
        let (settings, keeper, trouble) = Keeper::new(file);
        ctx.set_theme(if settings.is_light { egui::Theme::Light } else { egui::Theme::Dark });
        Self {
            session: Session::default(),
            canvas: Canvas::new(ctx),
            thumbnails: Thumbnails::new(ctx),
            swatches: Swatches::default(),
            jobs: Jobs::new(ctx),
            dialogs: Vec::new(),
            messages: trouble.into_iter().collect(),
            settings,
            keeper,
            asks_itself: false,
            is_first_start: false,
            export: export::Export::default(),
            title: String::new(),
            is_dressed: false,
            leaving: false,
            after_saving: None,
            memory: Memory::default(),
            clipboard: None,
            recorded: None,
        }
    }
    /// A window that asks for files with its own dialog, whatever the system has.
    pub fn asking_itself(self) -> Self {
        Self { asks_itself: true, ..self }
    }
    /// A window that writes down what is done, see [`Window::recorded`].
    pub fn recording(self) -> Self {
        Self { recorded: Some(Vec::new()), ..self }
    }
    /// What was done, as a replay file: one line an action. Documents made with corrected maps, pasted pictures and recovered
    /// drawings come from no file alone, and are not in it.
    pub fn recorded(&self) -> String {
        self.recorded.iter().flatten().map(|action| format!("{}\n", action.written())).collect()
    }
    /// Writes down what was done.
    fn did(&mut self, action: impl FnOnce() -> Action) {
        if let Some(recorded) = &mut self.recorded {
            recorded.push(action());
        }
    }
    /// The tablet that the pointer may belong to.
    pub fn draw_on(&mut self, tablet: SharedTablet) {
        self.canvas.draw_on(tablet);
    }
    /// Opens what the program was started with.
    pub fn begin(&mut self, files: Vec<PathBuf>) {
        self.is_first_start = files.is_empty();
        if files.is_empty() {
            self.open_sample();
        }
        if !files.is_empty() {
            self.jobs.open(files, None);
        }
    }
    fn open_sample(&mut self) {
        self.jobs.start("Opening the sample".into(), While::Working, |_| Done::Opened(None, Box::new(sample::open())));
    }
    /// One frame.
    pub fn show(&mut self, ui: &mut Ui) {
        let mut asked = Asked::default();
        self.dress(ui.ctx());
        self.finish_jobs(ui.ctx());
        self.tell_troubles();
        self.thumbnails.collect(ui.ctx());
        if self.dialogs.is_empty() && self.jobs.editing().is_none() {
            keys::listen(ui.ctx(), &self.session, &self.settings.keymap, &mut asked);
        }
        self.take_dropped(ui.ctx());
        self.lay_out(ui, &mut asked);
        self.show_dialog(ui.ctx(), &mut asked);
        self.show_editing(ui.ctx());
        self.guard_leaving(ui.ctx());
        self.do_asked(ui.ctx(), asked);
        self.session.keep();
        self.set_title(ui.ctx());
        self.keeper.keep(&self.settings);
    }
    /// What the window's own threads could not do.
    fn tell_troubles(&mut self) {
        let troubles = [&mut self.canvas.trouble, &mut self.thumbnails.trouble, &mut self.swatches.trouble];
        self.messages.extend(troubles.into_iter().filter_map(Option::take).map(|error| error.to_string()));
    }
    fn show_dialog(&mut self, ctx: &egui::Context, asked: &mut Asked) {
        let Some(dialog) = self.dialogs.last_mut() else { return };
        let size = self.session.shown().map(|document| document.size);
        let is_seen = matches!(dialog, Dialog::Export(_));
        let preview = size.filter(|_| is_seen).and_then(|size| self.canvas.small(ctx, size));
        let answer = dialog.show(ctx, &self.session, &mut self.settings.keymap, preview, asked);
        if let Dialog::Export(export) = dialog {
            self.export = export.clone();
        }
        match answer {
            Answer::Open => return,
            // The dialog stays while a file is chosen for it.
            Answer::Ask(ask @ WindowAsk::Choose(_)) => return asked.ask(ask),
            Answer::Import(source) => {
                let read = move |_: &Progress| Done::Read(Box::new(storage::import(&source)));
                return self.jobs.start("Reading maps".into(), While::Working, read);
            }
            // The dialog stays while there are drawings in it.
            Answer::Recover(lost) => return self.recover(lost),
            Answer::Delete(lost) => return self.delete(lost),
            _ => drop(self.dialogs.pop()),
        }
        match answer {
            Answer::Chosen(purpose, file) => self.chosen(purpose, file),
            Answer::Imported(opened) => self.session.adopt(*opened),
            Answer::Replaced(maps) => {
                let done = crate::session::actions::files::replace_maps(&mut self.session, &maps.0, maps.1);
                self.messages.extend(done.err().map(|error| error.to_string()));
                self.messages.append(&mut self.session.notes);
            }
            Answer::Discard(then) => self.proceed(ctx, then, true),
            Answer::SaveThen(then) => {
                self.after_saving = Some(then);
                self.save();
            }
            Answer::Ask(ask) => asked.ask(ask),
            Answer::Open | Answer::Close | Answer::Import(_) | Answer::Recover(_) | Answer::Delete(_) => {}
        }
    }
    /// Does what was asked for.
    fn do_asked(&mut self, ctx: &egui::Context, asked: Asked) {
        let is_editing = self.jobs.editing().is_some();
        for action in asked.actions {
            // Seen it may be, but not changed, while an edit is under way.
            if (is_editing && !matches!(action, Action::View(_))) || self.begin_edit(&action) {
                continue;
            }
            self.apply(&action);
        }
        self.messages.append(&mut self.session.notes);
        for ask in asked.window {
            self.do_ask(ctx, ask);
        }
    }
    fn do_ask(&mut self, ctx: &egui::Context, ask: WindowAsk) {
        match ask {
            WindowAsk::NewDialog => self.dialogs.push(Dialog::New(new::New::default())),
            WindowAsk::OpenDialog => self.ask_for(Purpose::Open, ""),
            WindowAsk::OpenMapsDialog => self.dialogs.push(Dialog::Import(Box::default())),
            WindowAsk::ReplaceMapsDialog => {
                let source = self.session.tab().and_then(|tab| tab.document().surface_source.clone());
                let import = import::Import::replacing(source.as_deref());
                self.dialogs.push(Dialog::Import(Box::new(import)));
            }
            WindowAsk::Choose(purpose) => self.ask_for(purpose, ""),
            WindowAsk::PlaceDialog => self.ask_for(Purpose::Place, ""),
            WindowAsk::Open(file) => self.jobs.open(vec![file], None),
            WindowAsk::OpenSample => self.open_sample(),
            WindowAsk::Save => self.save(),
            WindowAsk::SaveAs => self.ask_where(Purpose::Save),
            WindowAsk::ExportDialog => self.dialogs.push(Dialog::Export(self.export.clone())),
            WindowAsk::Export(ending) => {
                self.export.ending = ending;
                self.ask_where(Purpose::Export);
            }
            WindowAsk::Close(tab) => self.close(ctx, tab),
            WindowAsk::Quit => ctx.send_viewport_cmd(ViewportCommand::Close),
            WindowAsk::CopyMerged => self.copy_merged(),
            WindowAsk::Paste => self.paste(),
            WindowAsk::Palette => self.dialogs.push(Dialog::Palette(palette::Palette::default())),
            WindowAsk::Shortcuts => self.dialogs.push(Dialog::Shortcuts(shortcuts::Shortcuts::default())),
            WindowAsk::About => self.dialogs.push(Dialog::About),
            WindowAsk::TogglePanels => {
                self.settings.layout.is_hidden = !self.settings.layout.is_hidden;
                // The tab key that asked for it went on to the next button as well.
                ctx.memory_mut(|memory| memory.stop_text_input());
            }
            WindowAsk::OtherSide => self.settings.layout.side = self.settings.layout.side.other(),
            WindowAsk::PanelsApart => {
                let side = &mut self.settings.layout.side;
                *side = if *side == Side::Apart { Side::Right } else { Side::Apart };
            }
            WindowAsk::Float(front) => {
                let apart = &mut self.settings.layout.apart;
                if apart.contains(&front) { apart.retain(|other| *other != front) } else { apart.push(front) }
            }
            WindowAsk::ToggleTheme => self.toggle_theme(ctx),
            WindowAsk::ResizeInterface { is_larger } => self.resize_interface(ctx, is_larger),
            WindowAsk::Scale(scale) => self.scale(ctx, scale),
            WindowAsk::FullScreen => {
                let is_full = ctx.input(|i| i.viewport().fullscreen.unwrap_or(false));
                ctx.send_viewport_cmd(ViewportCommand::Fullscreen(!is_full));
            }
        }
    }
    fn apply(&mut self, action: &Action) {
        match action.apply(&mut self.session) {
            Ok(()) => self.did(|| action.clone()),
            Err(error) => self.messages.push(error.to_string()),
        }
        self.messages.append(&mut self.session.notes);
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
    /// The menus' titles, and the commands of each.
    pub fn menus() -> impl Iterator<Item = (&'static str, Vec<&'static str>)> {
        let names = |commands: &[commands::Command]| commands.iter().map(|command| command.name).collect::<Vec<_>>();
        let menus = commands::MENUS.map(|(title, commands)| (title, names(commands)));
        menus.into_iter().map(|(title, names)| (title, names.into_iter().filter(|name| !name.is_empty()).collect()))
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
        self.clipboard = clipboard::take_text(ui.ctx()).or(self.clipboard.take());
    }
    fn raw_input_hook(&mut self, ctx: &egui::Context, raw: &mut egui::RawInput) {
        clipboard::hear(ctx, &mut raw.events);
    }
    fn on_exit(&mut self, _gl: Option<&eframe::glow::Context>) {
        self.session.close();
        if let Err(error) = self.keeper.finish(&self.settings) {
            // The window is gone; whoever started it from a terminal sees it.
            eprintln!("{error}");
        }
    }
}
