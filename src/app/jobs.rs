//! Work on files, each on a thread of its own, so that the window never waits for a disk.
//! Floor 7.

use crate::io::maps;
use crate::session::storage::{self, Kind, Opened};
use crate::{Error, Result};
use eframe::egui;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};

/// What a job came to; done by the window when it arrives.
pub enum Done {
    Opened(Box<Result<Opened>>),
    /// The file holds a map: its conventions are to be seen first.
    IsMap(PathBuf),
    /// Maps were read, for the import dialog.
    Read(Box<Result<maps::Import>>),
    /// Nothing is to be done.
    Cancelled,
    /// A file dialog was answered; `None` where the system has no dialog.
    Chosen(crate::app::files::Purpose, Option<PathBuf>),
}

/// The jobs under way.
pub struct Jobs {
    sender: Sender<Done>,
    done: Receiver<Done>,
    ctx: egui::Context,
    /// What each is called, for the status bar.
    pub under_way: Vec<String>,
}

impl Jobs {
    pub fn new(ctx: &egui::Context) -> Self {
        let (sender, done) = channel();
        Self { sender, done, ctx: ctx.clone(), under_way: Vec::new() }
    }
    /// Runs a job; `name` is shown while it lasts.
    pub fn start(&mut self, name: String, work: impl FnOnce() -> Done + Send + 'static) {
        self.under_way.push(name.clone());
        let (sender, ctx) = (self.sender.clone(), self.ctx.clone());
        let run = move || {
            let _ = sender.send(work());
            ctx.request_repaint();
        };
        if let Err(error) = std::thread::Builder::new().name("job".into()).spawn(run) {
            let _ = self.sender.send(Done::Opened(Box::new(Err(Error::io(name, error)))));
        }
    }
    pub fn open(&mut self, file: PathBuf) {
        self.start(format!("Opening {}", file.display()), move || match storage::kind_of(&file) {
            Ok(Kind::Normals | Kind::Depth) => Done::IsMap(file),
            _ => Done::Opened(Box::new(storage::open(&file))),
        });
    }
    /// What was finished since the last call.
    pub fn finished(&mut self) -> Vec<Done> {
        let done: Vec<Done> = self.done.try_iter().collect();
        // They end in any order; how many are left is what counts.
        self.under_way.truncate(self.under_way.len().saturating_sub(done.len()));
        done
    }
}
