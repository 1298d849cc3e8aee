//! The coarser picture that shows a drag, and its preparation. Floor 7.

use super::pass::RenderPass;
use super::ready::{JobState, SurfaceJob};
use super::{COARSEST, DRAFT_SHARE, FINE, FRAME};
use crate::document::{Document, DocumentReducer};
use crate::math::Rect;

/// A smaller picture, or one of all pixels that is read more coarsely, for this drag and the next
/// ones.
pub struct DraftRender {
    /// Canvas pixels per pixel of its own, along a side.
    pub step: u32,
    pub reduced: DocumentReducer,
    /// The surface that another thread scales down.
    surface: Option<SurfaceJob>,
    pub pass: RenderPass,
}

/// How far a document is ready for a drag.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Readiness {
    Ready,
    /// There is more to do at once.
    #[default]
    NotYet,
    /// Another thread works on the rest.
    Waits,
}

impl DraftRender {
    pub fn new(step: u32) -> Self {
        let reduced = DocumentReducer::new(1.0 / step as f32);
        Self { step, reduced, surface: None, pass: RenderPass::default() }
    }

    /// Scales down one more layer, or starts on the surface on another thread.
    pub fn prepare(&mut self, document: &Document) -> Readiness {
        let missing = self.reduced.missing_surface(document);
        let missing = missing.and_then(|missing| match self.surface.take() {
            Some(job) if job.is_of(&missing) => match job.state() {
                JobState::Working => {
                    self.surface = Some(job);
                    Some(())
                }
                JobState::Done(made) => {
                    self.reduced.take_surface(made);
                    None
                }
                // A drag will report this itself.
                JobState::Failed => {
                    self.surface = Some(job);
                    None
                }
            },
            _ => {
                self.surface = SurfaceJob::begin(missing);
                self.surface.as_ref().map(|_| ())
            }
        });
        match (self.reduced.prepare(document), missing) {
            (true, _) => Readiness::NotYet,
            (false, Some(())) => Readiness::Waits,
            (false, None) => Readiness::Ready,
        }
    }

    /// Half-done work on the other thread is waited for: starting again would take longer.
    pub fn wait_for_surface(&mut self, document: &Document) {
        let missing = self.reduced.missing_surface(document);
        let job = missing.zip(self.surface.take()).filter(|(missing, job)| job.is_of(missing));
        if let Some(made) = job.and_then(|(_, job)| job.wait()) {
            self.reduced.take_surface(made);
        }
    }

    /// The visible pixels of the small picture.
    pub fn in_sight(&self, canvas: Rect) -> Rect {
        let step = self.step as i32;
        let Rect { x0, y0, x1, y1 } = canvas;
        Rect::new(
            x0.div_euclid(step),
            y0.div_euclid(step),
            x1.div_euclid(step) + 1,
            y1.div_euclid(step) + 1,
        )
    }

    /// Its passes take too long, and a coarser one is possible. The first does not count: it scaled
    /// everything down.
    pub fn is_slow(&self) -> bool {
        self.step < COARSEST && self.pass.passes() > 1 && self.pass.duration() > FRAME.mul_f32(1.6)
    }

    /// It was prepared, but no drag has used it.
    pub fn is_unused(&self) -> bool {
        self.pass.passes() == 0
    }

    pub fn is_quick_in_whole_pixels(&self) -> bool {
        let whole = (self.step * self.step) as f32 / DRAFT_SHARE;
        self.pass.passes() > 1 && self.pass.duration().mul_f32(whole) < FINE
    }
}
