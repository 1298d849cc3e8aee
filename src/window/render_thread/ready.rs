//! Makes a small surface in the background, while the render thread keeps painting. Floor 7.

use crate::document::{ReducedSurface, SurfaceReduction};
use crate::io::platform;
use crate::memory;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// The work of one thread, which ends with it; its result is dropped if nobody waits for it.
pub struct SurfaceJob {
    of: Arc<SurfaceReduction>,
    made: Receiver<ReducedSurface>,
}

/// The progress of a job.
pub enum JobState {
    Working,
    Done(ReducedSurface),
    /// Nothing is left of the surface, or there was no memory.
    Failed,
}

impl SurfaceJob {
    /// `None` if the system cannot start a thread.
    pub fn begin(of: SurfaceReduction) -> Option<Self> {
        let of = Arc::new(of);
        let (sender, made) = channel();
        let work = of.clone();
        let job = move || {
            // Threads of its own: those that paint tiles finish what they have begun before they
            // start anything new.
            let own = platform::thread_pool(1);
            let make = || memory::catch_out_of_memory(|| work.make());
            let made = own.map_or_else(|_| make(), |own| own.install(make));
            if let Ok(Ok(made)) = made {
                let _ = sender.send(made);
            }
        };
        platform::spawn("small surface", job).ok()?;
        Some(Self { of, made })
    }

    /// Whether this is the work that it does.
    pub fn is_of(&self, work: &SurfaceReduction) -> bool {
        self.of.is_same(work)
    }

    pub fn state(&self) -> JobState {
        match self.made.try_recv() {
            Ok(made) => JobState::Done(made),
            Err(TryRecvError::Empty) => JobState::Working,
            Err(TryRecvError::Disconnected) => JobState::Failed,
        }
    }

    /// Waits for the end.
    pub fn wait(self) -> Option<ReducedSurface> {
        self.made.recv().ok()
    }
}
