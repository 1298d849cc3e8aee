//! Long work: each job runs on its own thread, with a progress bar and a cancel button, so that the
//! window never waits. Floor 7.

use crate::document::Progress;
use crate::io::platform::{self, Instant};
use crate::language::{tr, tr_message};
use crate::math::Vec2;
use crate::memory;
use crate::session::actions::PasteTo;
use crate::{Error, Result};
use eframe::egui;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

/// The result of a job: what is done with it in the window `W`, as soon as it may be.
pub struct JobResult<W> {
    then: Option<Continuation<W>>,
    /// Whether something comes in front that nobody waits for: a document, or a dialog about one.
    pub comes_in_front: bool,
    /// Whether it counts even if the job was canceled meanwhile: a file is written already.
    is_final: bool,
}

type Continuation<W> = Box<dyn FnOnce(&mut W, &egui::Context) + Send>;

/// A window that jobs report errors to.
pub trait JobWindow: 'static {
    fn show_error(&mut self, error: &Error);
}

impl<W: JobWindow> JobResult<W> {
    /// Nothing to do, as after a canceled job.
    pub fn nothing() -> Self {
        Self { then: None, comes_in_front: false, is_final: false }
    }

    pub fn then(then: impl FnOnce(&mut W, &egui::Context) + Send + 'static) -> Self {
        Self { then: Some(Box::new(then)), ..Self::nothing() }
    }

    pub fn from_error(error: Error) -> Self {
        Self::then(move |window, _| window.show_error(&error))
    }

    /// What is done with a success; an error is shown.
    pub fn of<T: Send + 'static>(
        found: Result<T>,
        then: impl FnOnce(&mut W, T) + Send + 'static,
    ) -> Self {
        match found {
            Ok(found) => Self::then(move |window, _| then(window, found)),
            Err(error) => Self::from_error(error),
        }
    }

    /// All of them, in this order.
    pub fn all(several: Vec<Self>) -> Self {
        let comes_in_front = several.iter().any(|result| result.comes_in_front);
        let run = |window: &mut W, ctx: &egui::Context| {
            several.into_iter().for_each(|result| result.finish(window, ctx));
        };
        Self { comes_in_front, ..Self::then(run) }
    }

    pub fn in_front(self) -> Self {
        Self { comes_in_front: true, ..self }
    }

    pub fn even_if_canceled(self) -> Self {
        Self { is_final: true, ..self }
    }

    /// Does it.
    pub fn finish(self, window: &mut W, ctx: &egui::Context) {
        if let Some(then) = self.then {
            then(window, ctx);
        }
    }
}

/// What becomes of a picture from a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PictureUse {
    Placed(PinPosition),
    Pasted(PastePlace),
}

/// What is pasted becomes this.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PastePlace {
    pub to: PasteTo,
    /// With its middle at this canvas point, or in the middle of the view.
    pub at: Option<Vec2>,
}

/// Where a picture is to be pinned to the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PinPosition {
    /// In the middle of the canvas.
    Middle,
    /// Under the pointer, if that is on the canvas.
    Pointer,
}

/// What the user can do while a job runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JobKind {
    /// It can be canceled.
    Working,
    /// It edits the document in front, so no other edits are possible meanwhile. It can be
    /// canceled.
    Editing,
    /// It waits for another program: a dialog of the system.
    Asking,
    /// It reads what a dialog will show, which the user asked for. It can be canceled.
    Looking,
}

/// A running job.
pub struct RunningJob {
    key: usize,
    /// Its description for the status bar.
    pub name: String,
    pub progress: Arc<Progress>,
    pub kind: JobKind,
    since: Instant,
}

impl RunningJob {
    /// Its progress, `[0, 1]`; `None` while it is unknown.
    pub fn share(&self) -> Option<f32> {
        let (done, total) = self.progress.read();
        (total > 0).then(|| done as f32 / total as f32)
    }

    /// Its description, and what it does now if that has a name of its own.
    pub fn title(&self) -> String {
        match self.progress.stage() {
            "" => tr_message(&self.name).into_owned(),
            stage => format!("{}: {}", tr_message(&self.name), tr(stage)),
        }
    }

    /// Whether it has run long enough to be shown.
    pub fn is_long(&self) -> bool {
        self.since.elapsed() > Duration::from_millis(250)
    }
}

/// The running jobs.
pub struct Jobs<W> {
    sender: Sender<(usize, JobResult<W>)>,
    done: Receiver<(usize, JobResult<W>)>,
    ctx: egui::Context,
    next: usize,
    pub under_way: Vec<RunningJob>,
    said: Option<(String, Instant)>,
}

impl<W: JobWindow> Jobs<W> {
    pub fn new(ctx: &egui::Context) -> Self {
        let (sender, done) = channel();
        Self { sender, done, ctx: ctx.clone(), next: 0, under_way: Vec::new(), said: None }
    }

    /// Runs a job; `name` is shown meanwhile.
    pub fn start(
        &mut self,
        name: String,
        kind: JobKind,
        work: impl FnOnce(&Progress) -> JobResult<W> + Send + 'static,
    ) {
        let key = self.next;
        self.next += 1;
        let progress = Arc::new(Progress::default());
        let (sender, ctx, watched) = (self.sender.clone(), self.ctx.clone(), progress.clone());
        let named = name.clone();
        let run = move || {
            let done = memory::catch_out_of_memory(|| work(&watched));
            let done = done.unwrap_or_else(|refused| {
                JobResult::from_error(Error::out_of_memory(&named, refused))
            });
            // The window may be closed by then.
            let _ = sender.send((key, done));
            ctx.request_repaint();
        };
        if let Err(error) = spawn(&name, run) {
            // This end of the channel is held here.
            let _ = self.sender.send((key, JobResult::from_error(error)));
        }
        self.under_way.push(RunningJob { key, name, progress, kind, since: Instant::now() });
    }

    /// Shows a success message for a while.
    pub fn say(&mut self, sentence: String) {
        self.said = Some((tr_message(&sentence).into_owned(), Instant::now()));
    }

    /// The current success message.
    pub fn success_message(&self) -> Option<&str> {
        let (sentence, _) = self.said.as_ref().filter(|(_, since)| since.elapsed() < SHOWN_FOR)?;
        Some(sentence)
    }

    /// The results since the last call. Canceled jobs have none, unless they were already done.
    pub fn take_results(&mut self) -> Vec<JobResult<W>> {
        let mut finished = Vec::new();
        for (key, done) in self.done.try_iter() {
            let is_canceled =
                self.under_way.iter().any(|job| job.key == key && job.progress.is_canceled());
            self.under_way.retain(|job| job.key != key);
            if !is_canceled || done.is_final {
                finished.push(done);
            }
        }
        finished
    }

    /// Cancels the jobs of a name: their results are no longer wanted.
    pub fn cancel(&self, name: &str) {
        self.under_way.iter().filter(|job| job.name == name).for_each(|job| job.progress.cancel());
    }

    /// Whether a job is under way that ends with a dialog, or waits in one of the system's.
    pub fn is_awaiting_dialog(&self) -> bool {
        self.under_way.iter().any(|job| matches!(job.kind, JobKind::Asking | JobKind::Looking))
    }

    /// The job that blocks other edits.
    pub fn editing(&self) -> Option<&RunningJob> {
        self.under_way.iter().find(|job| job.kind == JobKind::Editing)
    }
}

/// How long a success message stays.
const SHOWN_FOR: Duration = Duration::from_secs(8);

/// The name of a file, for lines without room for the path.
pub fn short(file: &Path) -> String {
    file.file_name().unwrap_or(file.as_os_str()).to_string_lossy().into_owned()
}

/// Starts a thread. Fails if the system cannot start one, with an error that names the purpose.
pub fn spawn(name: &str, work: impl FnOnce() + Send + 'static) -> Result<()> {
    platform::spawn("rilievo", work).map(drop).map_err(|error| Error::io(name, error))
}
