//! Long work: each job runs on its own thread, with a progress bar and a cancel button, so that the
//! window never waits. Floor 7.

use crate::clipboard::{Clipboard, PastedContent};
use crate::document::parts::drawing::DrawingTraits;
use crate::document::{Document, LayerId, Progress, SurfaceSource};
use crate::file_purpose::FilePurpose;
use crate::io::recipe::BrushPreset;
use crate::io::replace::FileStamp;
use crate::io::{maps, recovery};
use crate::math::Vec2;
use crate::memory;
use crate::pending::{Pending, Saving};
use crate::raster::Picture;
use crate::session::PicturePart;
use crate::session::actions::parts::FirstShape;
use crate::session::actions::pictures::ReadPart;
use crate::session::actions::placing::read_picture;
use crate::session::actions::{PartAction, PasteTo};
use crate::session::autosave::RestoredDocument;
use crate::session::storage::{self, FileUse, OpenedFile, SortedFiles};
use crate::session::{Action, Edit};
use crate::{Error, Result};
use eframe::egui;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

/// The result of a job; the window handles it when it arrives.
pub enum JobResult {
    /// A document, with its file if it has one.
    Opened(Option<PathBuf>, Box<Result<OpenedFile>>),
    /// Maps of an object: the import dialog shows their conventions first.
    AreMaps(Box<SurfaceSource>),
    /// The file is opened as a document of its own.
    IsDocument(PathBuf),
    /// The file is read to become a layer.
    IsPicture(PathBuf, PictureUse),
    /// Several results.
    Several(Vec<JobResult>),
    /// Maps were read, for the import dialog.
    Read(Box<MapsRead>),
    /// Drawings that can be recovered.
    Lost(Vec<recovery::LostSession>),
    /// One of them was recovered.
    Recovered(Box<Result<RestoredDocument>>),
    /// A picture was read from a file, to become a layer.
    Pictured(PathBuf, String, Picture, PictureUse),
    /// The same, to lie on the unwrapped surface.
    Flat(PathBuf, String, Picture),
    /// The surface of an open document, by its key, was unwrapped.
    Unwrapped(usize),
    /// A picture was read for a layer of an open document.
    Part(Box<PartResult>),
    /// An open document was saved.
    Saved(Box<Saving>, FileStamp),
    /// It is not yet saved: the user must first know what the format cannot hold.
    Loses(Box<Saving>),
    /// Something was exported; what the format cannot hold.
    Exported(PathBuf, Vec<String>),
    /// Maps of the shape were exported.
    ExportedMaps(Vec<PathBuf>),
    /// Something would be lost that the user was not asked about; why.
    Refused(Pending, String),
    /// An edit of an open document that took long.
    Edited(Box<EditResult>),
    /// A drawing was given a shape: its open document, by its key, the value before, and the action.
    Shaped(Box<ShapedResult>),
    /// Something cannot be done; why.
    Declined(&'static str),
    /// What drawing an open document, by its key, holds.
    Looked(usize, Option<(LayerId, DrawingTraits)>),
    /// There is nothing to do; why.
    Said(String),
    /// The flattened picture is in the clipboard as long as this is kept.
    Copied(Clipboard),
    Pasted(PastedContent, PastePlace),
    /// What was copied in this window is to be pasted.
    PastedOwn(PastePlace),
    /// The user's own brushes, and the errors of unreadable ones.
    Brushes(Vec<BrushPreset>, Vec<String>),
    /// Nothing to do, as after a cancelled job.
    Nothing,
    Failed(Error),
    /// The result of a file dialog; `None` if the system has no dialog.
    Chosen(FilePurpose, Option<PathBuf>),
}

/// Maps as they were read.
pub struct MapsRead {
    /// What was requested: a dialog that wants other maps by now ignores it.
    pub source: SurfaceSource,
    pub found: Result<maps::ImportedSurface>,
    /// The finished picture that the same file holds, and the name of its layer.
    pub picture: Option<(String, Picture)>,
}

pub struct PartResult {
    /// By its key.
    pub key: usize,
    pub layer: LayerId,
    pub part: PicturePart,
    pub file: PathBuf,
    pub read: ReadPart,
}

impl JobResult {
    /// Whether something comes in front that nobody waits for: a document, or a dialog about one.
    pub fn comes_in_front(&self) -> bool {
        match self {
            JobResult::Several(several) => several.iter().any(JobResult::comes_in_front),
            JobResult::Opened(..)
            | JobResult::AreMaps(_)
            | JobResult::Lost(_)
            | JobResult::Recovered(_)
            | JobResult::Looked(..) => true,
            _ => false,
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

pub struct EditResult {
    /// By its key.
    pub key: usize,
    pub action: Action,
    /// What was edited.
    pub from: Document,
    pub edit: Edit,
}

pub struct ShapedResult {
    /// By its key.
    pub key: usize,
    pub action: PartAction,
    /// What was given a shape.
    pub from: Document,
    pub shape: FirstShape,
}

/// What the user can do while a job runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JobKind {
    /// It can be cancelled.
    Working,
    /// It edits the document in front, so no other edits are possible meanwhile. It can be
    /// cancelled.
    Editing,
    /// It waits for another program: a dialog of the system.
    Asking,
    /// It reads what a dialog will show, which the user asked for. It can be cancelled.
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
            "" => self.name.clone(),
            stage => format!("{}: {stage}", self.name),
        }
    }

    /// Whether it has run long enough to be shown.
    pub fn is_long(&self) -> bool {
        self.since.elapsed() > Duration::from_millis(250)
    }
}

/// The running jobs.
pub struct Jobs {
    sender: Sender<(usize, JobResult)>,
    done: Receiver<(usize, JobResult)>,
    ctx: egui::Context,
    next: usize,
    pub under_way: Vec<RunningJob>,
    said: Option<(String, Instant)>,
}

impl Jobs {
    pub fn new(ctx: &egui::Context) -> Self {
        let (sender, done) = channel();
        Self { sender, done, ctx: ctx.clone(), next: 0, under_way: Vec::new(), said: None }
    }

    /// Runs a job; `name` is shown meanwhile.
    pub fn start(
        &mut self,
        name: String,
        kind: JobKind,
        work: impl FnOnce(&Progress) -> JobResult + Send + 'static,
    ) {
        let key = self.next;
        self.next += 1;
        let progress = Arc::new(Progress::default());
        let (sender, ctx, watched) = (self.sender.clone(), self.ctx.clone(), progress.clone());
        let named = name.clone();
        let run = move || {
            let done = memory::caught(|| work(&watched));
            let done = done
                .unwrap_or_else(|refused| JobResult::Failed(Error::out_of_memory(&named, refused)));
            // The window may be closed by then.
            let _ = sender.send((key, done));
            ctx.request_repaint();
        };
        if let Err(error) = spawn(&name, run) {
            // This end of the channel is held here.
            let _ = self.sender.send((key, JobResult::Failed(error)));
        }
        self.under_way.push(RunningJob { key, name, progress, kind, since: Instant::now() });
    }

    /// Opens files that came together. `use_of`: what becomes of pictures; absent: they open as
    /// documents.
    pub fn open(&mut self, files: Vec<PathBuf>, use_of: Option<PictureUse>) {
        let name = match &files[..] {
            [file] => format!("Opening {}", short(file)),
            files => format!("Opening {} files", files.len()),
        };
        self.start(name, JobKind::Working, move |_| {
            let (mut known, mut done) = (Vec::new(), Vec::new());
            for file in files {
                match storage::kind_of(&file) {
                    Ok(kind) => known.push((file, kind)),
                    Err(error) => done.push(JobResult::Failed(error)),
                }
            }
            let SortedFiles { objects, others } = storage::sorted(known);
            done.extend(objects.into_iter().map(|source| JobResult::AreMaps(Box::new(source))));
            done.extend(others.into_iter().map(|(file, kind)| {
                match use_of.filter(|_| kind == FileUse::Picture) {
                    Some(use_of) => JobResult::IsPicture(file, use_of),
                    None => JobResult::IsDocument(file),
                }
            }));
            JobResult::Several(done)
        });
    }

    pub fn read_document(&mut self, file: PathBuf) {
        let name = format!("Opening {}", short(&file));
        self.start(name, JobKind::Working, move |_| {
            let opened = storage::open(&file);
            JobResult::Opened(Some(file), Box::new(opened))
        });
    }

    pub fn read_picture(&mut self, file: PathBuf, use_of: PictureUse) {
        self.start(format!("Reading {}", short(&file)), JobKind::Working, move |_| {
            match read_picture(&file) {
                Ok((name, picture)) => JobResult::Pictured(file, name, picture, use_of),
                Err(error) => JobResult::Failed(error),
            }
        });
    }

    /// Shows a success message for a while.
    pub fn say(&mut self, sentence: String) {
        self.said = Some((sentence, Instant::now()));
    }

    /// The current success message.
    pub fn success_message(&self) -> Option<&str> {
        let (sentence, _) = self.said.as_ref().filter(|(_, since)| since.elapsed() < TOLD)?;
        Some(sentence)
    }

    /// The results since the last call. Cancelled jobs have none, unless they were already done.
    pub fn finished(&mut self) -> Vec<JobResult> {
        let mut finished = Vec::new();
        for (key, done) in self.done.try_iter() {
            let is_cancelled =
                self.under_way.iter().any(|job| job.key == key && job.progress.is_cancelled());
            self.under_way.retain(|job| job.key != key);
            if !is_cancelled || matches!(done, JobResult::Saved(..)) {
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
    pub fn awaits_dialog(&self) -> bool {
        self.under_way.iter().any(|job| matches!(job.kind, JobKind::Asking | JobKind::Looking))
    }

    /// The job that blocks other edits.
    pub fn editing(&self) -> Option<&RunningJob> {
        self.under_way.iter().find(|job| job.kind == JobKind::Editing)
    }
}

/// How long a success message stays.
const TOLD: Duration = Duration::from_secs(8);

/// The name of a file, for lines without room for the path.
pub fn short(file: &Path) -> String {
    file.file_name().unwrap_or(file.as_os_str()).to_string_lossy().into_owned()
}

/// Starts a thread. Fails if the system cannot start one, with an error that names the purpose.
pub fn spawn(name: &str, work: impl FnOnce() + Send + 'static) -> Result<()> {
    let started = std::thread::Builder::new().name("rilievo".into()).spawn(work);
    started.map(drop).map_err(|error| Error::io(name, error))
}
