//! The main window: shows the panels, performs their requests, and reports errors. Floor 7.
//! `layout` arranges the panels; `files` and `leaving` handle files.

mod by_name;
mod drawer;
mod files;
mod interface;
mod layout;
mod leaving;
mod pinning;
mod proof;
mod requested;
mod steps;
mod typing;
mod unwrap;
mod work;

use super::canvas::{Canvas, SecondView};
use super::clipboard::{self, Clipboard, ClipboardSource};
use super::dialogs::import::MapsRead;
use super::dialogs::{Dialog, DialogAnswer, DialogContext, export, maps, unwrapped};
use super::fonts::FallbackFonts;
use super::jobs::{JobKind, JobResult, JobWindow, Jobs};
use super::messages::Messages;
use super::panel_layout::PanelKind;
use super::panels::menu::MenuState;
use super::pen::SharedTablet;
use super::pending::{AfterUnsaved, Pending, Saving};
use super::references::References;
use super::requests::{UiRequests, WindowRequest};
use super::sample::{SAMPLES, StartSample};
use super::sample_pictures::SamplePictures;
use super::settings::{self, Settings, SettingsFile};
use super::swatches::Swatches;
use super::theme;
use super::thumbnails::Thumbnails;
use crate::Error;
use crate::advice::with_advice;
use crate::document::{Progress, SurfaceSource};
use crate::language::{Language, tr};
use crate::session::actions::{self, GuideAction};
use crate::session::replay::ReplayValue;
use crate::session::{Action, Session, storage};
use crate::surface::Surface;
use crate::surface::operator::UnwrapSettings;
use crate::titles::marked_title;
use crate::tools::snap::ViewAids;
use crate::tr;
use crate::usage::MemoryMeter;
use eframe::egui::{self, Ui, ViewportCommand};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::Receiver;

/// The program's one window.
pub struct MainWindow {
    /// The program behind the window.
    pub session: Session,
    canvas: Canvas,
    second_view: SecondView,
    references: References,
    /// Where pasted references are kept.
    reference_folder: Option<PathBuf>,
    thumbnails: Thumbnails,
    swatches: Swatches,
    samples: SamplePictures,
    pub(super) jobs: Jobs<MainWindow>,
    /// The last one is shown.
    pub(super) dialogs: Vec<Dialog>,
    /// Messages that stay until they are closed.
    pub(super) messages: Messages,
    /// The menus by keyboard, and the pictures of files.
    menu: MenuState,
    settings: Settings,
    keeper: SettingsFile,
    /// Whether it uses its own file dialogs instead of the system's.
    asks_itself: bool,
    /// Whether the panels of a narrow window are shown.
    is_drawer_open: bool,
    /// The steps that are shown over the canvas.
    steps: Option<steps::TourProgress>,
    export: export::ExportDialog,
    maps: maps::MapsDialog,
    unwrapped: unwrapped::UnwrappedDialog,
    /// The surface that was unwrapped ahead last.
    unwrapping: Option<(Arc<Surface>, UnwrapSettings)>,
    /// The purpose of the open system dialog.
    title: String,
    /// The language of the system, if the window speaks it; tests have none.
    system_language: Option<Language>,
    fonts: FallbackFonts,
    /// Whether the stored theme was applied.
    has_first_scale: bool,
    /// The user agreed to leave.
    leaving: bool,
    /// What to do once the document is saved, while the user is asked where to.
    after_saving: Option<AfterUnsaved>,
    memory: MemoryMeter,
    /// What the system's clipboard holds.
    clipboard_source: ClipboardSource,
    /// What was copied last; kept, so that it stays in the system's clipboard.
    clipboard: Option<Clipboard>,
    /// What this window last put there.
    handed_out: Option<Arc<Vec<u8>>>,
    /// The files that other starts of the program name.
    other_starts: Option<Receiver<Vec<PathBuf>>>,
    /// What waits until it is no longer busy.
    busy: typing::BusyInput,
    /// The recorded actions, if they are recorded.
    recorded: Option<Vec<Action>>,
}

/// The name of the job that reads maps for their dialog.
const READING_MAPS: &str = "Reading maps";

impl JobWindow for MainWindow {
    fn show_error(&mut self, error: &Error) {
        self.messages.push(with_advice(error));
    }
}

impl MainWindow {
    /// A window without stored settings.
    pub fn new(ctx: &egui::Context) -> Self {
        Self::remembering(ctx, None)
    }

    /// A window with the settings of a file, which it updates.
    pub fn remembering(ctx: &egui::Context, file: Option<PathBuf>) -> Self {
        let (settings, keeper, trouble) = SettingsFile::new(file);
        settings.look.show(ctx);
        let mut messages = Messages::default();
        messages.extend(trouble);
        let mut session = Session::default().with_aids(settings.aids);
        session.tools.presses_by_speed = settings.preferences.presses_by_speed;
        session.recent_colors.clone_from(&settings.colors);
        let mut window = Self {
            session,
            canvas: Canvas::new(ctx),
            second_view: SecondView::default(),
            references: References::default(),
            reference_folder: None,
            thumbnails: Thumbnails::new(ctx),
            swatches: Swatches::default(),
            samples: SamplePictures::default(),
            jobs: Jobs::new(ctx),
            dialogs: Vec::new(),
            messages,
            menu: MenuState::default(),
            settings,
            keeper,
            asks_itself: false,
            is_drawer_open: false,
            steps: None,
            export: export::ExportDialog::default(),
            maps: maps::MapsDialog::default(),
            unwrapped: unwrapped::UnwrappedDialog::default(),
            unwrapping: None,
            title: String::new(),
            system_language: None,
            fonts: FallbackFonts::default(),
            has_first_scale: false,
            leaving: false,
            after_saving: None,
            memory: MemoryMeter::default(),
            clipboard_source: clipboard::read_clipboard,
            clipboard: None,
            handed_out: None,
            other_starts: None,
            busy: typing::BusyInput::default(),
            recorded: None,
        };
        window.follow_language(ctx);
        window
    }

    /// The window of a user, with what is stored for them, and these files, or the start screen if
    /// there are none.
    ///
    /// * `tablet`: hears of the pen before the window does.
    pub fn of_user(ctx: &egui::Context, tablet: SharedTablet, files: Vec<PathBuf>) -> Self {
        theme::install(ctx);
        let mut window = Self::remembering(ctx, settings::file());
        window.system_language = Some(crate::language::system_language());
        window.follow_language(ctx);
        window.draw_on(tablet);
        if let Some(folder) = crate::io::recovery::folder() {
            window.keep_recovery_in(folder);
        }
        let crashed = crate::io::crash_report::folder();
        let crashed = crashed.and_then(|folder| crate::io::crash_report::take_unread(&folder));
        window.messages.extend(crashed.map(|report| {
            let report = report.display();
            tr!(
                "Rilievo crashed. A report is in {report}; please send it. Nothing was sent.",
                report
            )
        }));
        if let Some(folder) = settings::brushes() {
            window.keep_brushes_in(folder);
        }
        if let Some(folder) = settings::palettes() {
            window.keep_palettes_in(folder);
        }
        if let Some(folder) = settings::references() {
            window.keep_references_in(folder);
        }
        window.begin(files);
        window
    }

    /// A window that always uses its own file dialogs.
    pub fn asking_itself(self) -> Self {
        Self { asks_itself: true, ..self }
    }

    /// A window that pastes what this returns, not what is in the system's clipboard.
    pub fn pasting_from(self, clipboard_source: ClipboardSource) -> Self {
        Self { clipboard_source, ..self }
    }

    /// A window that records its actions, see [`MainWindow::replay_text`].
    pub fn recording(self) -> Self {
        // Snapping settings were stored, and are no action of this window.
        let aids = Action::Guide(GuideAction::Aids { aids: self.session.tools.aids });
        let is_plain = self.session.tools.aids == ViewAids::default();
        Self { recorded: Some(Some(aids).filter(|_| !is_plain).into_iter().collect()), ..self }
    }

    /// The recorded actions as a replay file, one line each. Documents with corrected maps and
    /// recovered drawings do not come from files, and are not in it.
    pub fn replay_text(&self) -> String {
        self.recorded.iter().flatten().map(|action| format!("{}\n", action.to_value())).collect()
    }

    /// Records an action.
    fn did(&mut self, action: impl FnOnce() -> Action) {
        if let Some(recorded) = &mut self.recorded {
            recorded.push(action());
        }
    }

    /// The tablet that the pointer may belong to.
    pub fn draw_on(&mut self, tablet: SharedTablet) {
        self.second_view.draw_on(tablet.clone());
        self.canvas.draw_on(tablet);
    }

    /// Opens what the program was started with.
    pub fn begin(&mut self, files: Vec<PathBuf>) {
        if !files.is_empty() {
            self.open_files(files, None);
        }
    }

    /// Opens the sample of a name, or the first one if none has it.
    pub fn open_sample_named(&mut self, name: &str) {
        let is_it = |sample: &StartSample| sample.name.eq_ignore_ascii_case(name);
        self.open_sample(SAMPLES.iter().position(is_it).unwrap_or(0));
    }

    fn open_sample(&mut self, index: usize) {
        let Some(sample) = SAMPLES.get(index) else { return };
        self.jobs.start(tr("Opening the sample").into(), JobKind::Working, |_| {
            JobResult::of(sample.open(), |window: &mut Self, opened| {
                window.add_opened(None, opened);
                window.begin_tour(sample.tour);
            })
            .in_front()
        });
    }

    /// One frame.
    pub fn show(&mut self, ui: &mut Ui) {
        let mut requests = UiRequests::default();
        self.tell_front();
        self.apply_first_scale(ui.ctx());
        self.follow_language(ui.ctx());
        self.finish_jobs(ui.ctx());
        let profile = self.session.shown_document().map(|document| document.profile);
        theme::show_profile(profile.unwrap_or_default());
        self.tell_troubles();
        self.unwrap_ahead();
        let is_painting = self.canvas.is_painting(&self.session);
        self.thumbnails.collect(ui.ctx(), is_painting);
        let is_opening = self.session.active().is_none() && !self.jobs.under_way.is_empty();
        self.swatches.is_held = is_painting || is_opening;
        self.do_held(&mut requests);
        self.hear_keys(ui.ctx(), &mut requests);
        self.take_dropped(ui.ctx());
        self.take_other_starts(ui.ctx());
        self.lay_out(ui, &mut requests);
        let keymap = self.is_free_for_keys().then_some(&self.settings.keymap);
        let (canvas, session) = (&mut self.canvas, &self.session);
        self.second_view.show(ui.ctx(), canvas, session, keymap, &mut requests);
        self.canvas.end_frame();
        self.show_dialog(ui.ctx(), &mut requests);
        self.show_editing(ui.ctx());
        self.guard_leaving(ui.ctx());
        let dialogs = self.dialogs.len();
        self.do_requests(ui.ctx(), requests);
        self.expect_dialog(dialogs);
        self.session.keep();
        self.set_title(ui.ctx());
        self.follow_settings(ui.ctx());
        self.keeper.keep(&self.settings);
    }

    /// The settings learn what the session keeps of them, and the session and the canvas what the
    /// user prefers.
    fn follow_settings(&mut self, ctx: &egui::Context) {
        let (settings, session) = (&mut self.settings, &mut self.session);
        settings.aids = session.tools.aids;
        let preferences = &mut settings.preferences;
        preferences.presses_by_speed = session.tools.presses_by_speed;
        settings.colors.clear();
        if preferences.remembers_colors {
            settings.colors.clone_from(&session.recent_colors);
        }
        settings.shelf.note_used(&session.preset);
        session.keep_steps(preferences.undo_steps);
        self.canvas.prefer(preferences);
        self.second_view.prefer(preferences);
        let has_fingers = self.canvas.has_felt_fingers();
        theme::enlarge_targets(ctx, preferences.has_large_targets || has_fingers);
        settings.keep_recent();
    }

    /// Collects the errors of the window's threads.
    fn tell_troubles(&mut self) {
        let troubles = [
            &mut self.canvas.trouble,
            &mut self.thumbnails.trouble,
            &mut self.thumbnails.moods.trouble,
            &mut self.swatches.trouble,
            &mut self.samples.trouble,
        ];
        self.messages
            .extend(troubles.into_iter().filter_map(Option::take).map(|error| with_advice(&error)));
    }

    /// Messages belong to the document in front.
    fn tell_front(&mut self) {
        let open = &self.session.open_documents;
        let is_open = |key| open.iter().any(|open| open.key == key);
        self.messages.front_is(self.session.active().map(|open| open.key), is_open);
    }

    /// Shows what the session has to say, once: a stroke tried again says nothing new.
    fn tell_notes(&mut self) {
        self.tell_front();
        for note in std::mem::take(&mut self.session.notes) {
            if !self.messages.contains(&note) {
                self.messages.push(note);
            }
        }
    }

    fn show_dialog(&mut self, ctx: &egui::Context, requests: &mut UiRequests) {
        let Some(dialog) = self.dialogs.last_mut() else { return };
        let size = self.session.shown_document().map(|document| document.size);
        let is_flat = self.session.active().is_some_and(|open| open.unwrap_settings().is_some());
        let is_seen = matches!(dialog, Dialog::Export(_)) && !is_flat;
        let preview = size.filter(|_| is_seen).and_then(|size| self.canvas.small(ctx, size));
        let under =
            ctx.input(|input| input.pointer.hover_pos()).and_then(|pos| self.canvas.canvas_at(pos));
        let context = DialogContext {
            session: &self.session,
            settings: &mut self.settings,
            preview,
            pens: self.canvas.pens(),
            under,
            memory: &mut self.memory,
            pictures: &mut self.menu.pictures,
            requests,
        };
        let answer = dialog.show(ctx, context);
        match dialog {
            Dialog::Export(export) => self.export = export.without_estimate(),
            Dialog::Maps(maps) => self.maps = maps.clone(),
            _ => {}
        }
        if let Dialog::Unwrapped(unwrapped) = dialog {
            self.unwrapped = unwrapped.clone();
        }
        match answer {
            DialogAnswer::Open => return,
            // The dialog stays while a file is chosen for it.
            DialogAnswer::Ask(ask @ WindowRequest::Choose(_)) => return requests.request(ask),
            DialogAnswer::Import(source) => return self.read_maps(*source),
            // The dialog stays while there are drawings in it.
            DialogAnswer::Recover(lost) => return self.recover(lost),
            DialogAnswer::Delete(lost) => return self.delete(lost),
            _ => {
                if let Some(Dialog::Import(_)) = self.dialogs.pop() {
                    self.jobs.cancel(READING_MAPS);
                }
            }
        }
        match answer {
            DialogAnswer::Chosen(purpose, file) => self.use_chosen_file(purpose, file),
            DialogAnswer::Imported(opened) => self.session.adopt(*opened),
            DialogAnswer::Replaced(maps) => self.take_maps(*maps, actions::files::replace_maps),
            DialogAnswer::Added(maps) => self.take_maps(*maps, actions::files::add_maps),
            DialogAnswer::Discard(then) => self.proceed(ctx, then, true),
            DialogAnswer::SaveThen(then) => self.save(Some(then)),
            DialogAnswer::Replace(pending) => self.put(pending.forced()),
            DialogAnswer::Lose(saving) => {
                self.put(Pending::Save(Box::new(Saving { knows_losses: true, ..*saving })))
            }
            DialogAnswer::Ask(ask) => requests.request(ask),
            // The parts are next to their numbers.
            DialogAnswer::Shaped => self.settings.layout.below = PanelKind::Shape,
            DialogAnswer::Open
            | DialogAnswer::Close
            | DialogAnswer::Import(_)
            | DialogAnswer::Recover(_)
            | DialogAnswer::Delete(_) => {}
        }
    }

    /// Reads the maps of the import dialog, in place of those that are being read.
    fn read_maps(&mut self, source: SurfaceSource) {
        let read = move |progress: &Progress| {
            let found = match storage::import_watched(&source, progress) {
                Ok(Some(found)) => Ok(found),
                Ok(None) => return JobResult::nothing(),
                Err(error) => Err(error),
            };
            let picture = storage::finished_picture(&source);
            let read = MapsRead { source, found, picture };
            JobResult::then(|window: &mut Self, ctx| {
                if let Some(import) = window.import() {
                    import.take(ctx, read);
                }
            })
        };
        self.jobs.cancel(READING_MAPS);
        self.jobs.start(READING_MAPS.into(), JobKind::Working, read);
    }

    /// Performs a request.
    fn do_requests(&mut self, ctx: &egui::Context, requests: UiRequests) {
        if !requests.actions.is_empty() {
            // The frame is laid out again to show what was done in it.
            ctx.request_discard("an action");
        }
        for action in requests.actions {
            if !self.hold_action(&action) && !self.begin_edit(&action) {
                self.apply(&action);
            }
            if matches!(&action, Action::Layer(action) if action.is_adding_settings()) {
                self.settings.layout.front = PanelKind::Properties;
            }
        }
        self.tell_notes();
        self.session.said.drain(..).for_each(|sentence| self.jobs.say(sentence));
        self.hand_out();
        for ask in requests.window {
            self.do_request(ctx, ask);
        }
    }

    fn apply(&mut self, action: &Action) {
        match action.apply(&mut self.session) {
            Ok(()) => self.did(|| action.clone()),
            Err(error) => self.messages.push(with_advice(&error)),
        }
        self.tell_notes();
    }

    fn set_title(&mut self, ctx: &egui::Context) {
        let title = self.session.active().map_or_else(
            || "Rilievo".to_owned(),
            |open| format!("{} – Rilievo", marked_title(open)),
        );
        if title != self.title {
            ctx.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }
}

impl eframe::App for MainWindow {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.show(ui);
        self.clipboard = clipboard::take_text(ui.ctx()).or(self.clipboard.take());
    }

    fn raw_input_hook(&mut self, ctx: &egui::Context, raw: &mut egui::RawInput) {
        clipboard::translate_keys(ctx, &mut raw.events);
    }

    fn on_exit(&mut self, _gl: Option<&eframe::glow::Context>) {
        self.session.close();
        if let Err(error) = self.keeper.finish(&self.settings) {
            // The window is closed; the terminal still shows the message.
            eprintln!("{error}");
        }
    }
}
