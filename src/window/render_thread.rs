//! The render thread: flattens documents tile by tile, so that the window never waits for pixels.
//! It compares the shown document with the requested one and paints only tiles that differ, visible
//! ones first. While something is dragged and whole pixels would take longer than a frame, it
//! paints a smaller picture instead, and the full one as soon as the user pauses. Floor 7. Pixels
//! come from `document::flatten`; `pass` tracks what is left to paint of one picture.

mod draft;
mod pass;
mod ready;

use crate::document::Document;
use crate::io::platform::{self, Instant};
use crate::math::{Rect, Size};
use crate::memory::{self, OutOfMemory};
use crate::raster::{Tile, TileAt};
use draft::{DraftRender, Readiness};
use pass::RenderPass;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::Duration;

/// A request: what to show.
pub struct RenderRequest {
    /// A new number means a new picture: nothing of the last one is valid.
    pub picture: u64,
    pub document: Document,
    /// The visible canvas pixels.
    pub visible: Rect,
    /// Whether a slider or a handle is being dragged: a smaller picture soon is better than a full
    /// one late.
    pub is_dragged: bool,
}

/// Tiles that were painted.
pub struct RenderedTileBatch {
    pub picture: u64,
    /// They belong to a picture that is shown only for a moment: with fewer pixels, or read more
    /// coarsely.
    pub is_draft: bool,
    /// The size of the picture that the tiles are cut from.
    pub size: Size,
    pub tiles: Vec<(TileAt, Option<Arc<Tile>>)>,
    /// Whether nothing visible is left to paint.
    pub is_settled: bool,
    /// The time since work on this document began.
    pub took: Duration,
    /// There was no memory to paint it; what was painted before stays until another document is
    /// requested.
    pub refused: Option<OutOfMemory>,
}

#[derive(Default)]
struct SharedRequest {
    wanted: Mutex<Option<RenderRequest>>,
    wake: Condvar,
    closed: Mutex<bool>,
    /// A frame waits for what is painted: it need not be told.
    is_awaited: Mutex<bool>,
}

/// The handle of the thread; the thread ends with it.
pub struct RenderThread {
    shared: Arc<SharedRequest>,
    painted: Receiver<RenderedTileBatch>,
}

/// Tiles painted between two checks for a newer request.
const BATCH: usize = 48;
/// The same during a drag, so that a slow redraw is noticed soon.
const FEW: usize = 12;
/// A pass over the visible tiles may take this long before a newer request interrupts it, so that a
/// drag shows complete pictures.
const PASS: Duration = Duration::from_millis(150);
/// If a redraw during a drag takes no longer than this, it is painted as at rest.
const FINE: Duration = Duration::from_millis(16);
/// If it takes longer, pictures are read coarsely; if that takes longer than this, it has fewer
/// pixels.
const FRAME: Duration = Duration::from_millis(30);
/// The time of a draft of all pixels, as a share of the picture's time at rest.
const DRAFT_SHARE: f32 = 0.7;
/// If no request came for this long, the user paused: then the full picture is painted.
const REST: Duration = Duration::from_millis(180);
/// After this long without a request, the thread prepares for the next drag.
const PAUSE: Duration = Duration::from_millis(600);
/// The time between two checks of what another thread prepares.
const LOOK: Duration = Duration::from_millis(30);
/// The time per canvas pixel for the surface of parts, before it was measured.
const SHAPING: Duration = Duration::from_nanos(120);
/// Canvas pixels per pixel of the smallest picture.
const COARSEST: u32 = 8;

impl RenderThread {
    /// `done` is called on the render thread after each batch that no frame waits for. Fails if the
    /// system cannot start a thread.
    pub fn new(done: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        let shared = Arc::new(SharedRequest::default());
        let (sender, painted) = channel();
        let for_thread = shared.clone();
        platform::spawn("painter", move || {
            work(&for_thread, &sender, &done);
        })?;
        Ok(Self { shared, painted })
    }

    /// Requests a document; only the last request counts.
    pub fn want(&self, wanted: RenderRequest) {
        *lock(&self.shared.wanted) = Some(wanted);
        self.shared.wake.notify_one();
    }

    /// What was painted since the last call, and what else is painted within some time.
    pub fn take_rendered(&self, wait: Duration) -> Vec<RenderedTileBatch> {
        let mut taken: Vec<RenderedTileBatch> = Vec::new();
        let until = Instant::now() + wait;
        *lock(&self.shared.is_awaited) = !wait.is_zero();
        while taken.last().is_none_or(|batch| !batch.is_settled) {
            let left = until.saturating_duration_since(Instant::now());
            match platform::recv_timeout(&self.painted, left) {
                Ok(batch) => taken.push(batch),
                Err(_) => break,
            }
        }
        // What was sent while this was so has told nobody.
        let mut is_awaited = lock(&self.shared.is_awaited);
        taken.extend(self.painted.try_iter());
        *is_awaited = false;
        taken
    }
}

impl Drop for RenderThread {
    fn drop(&mut self) {
        *lock(&self.shared.closed) = true;
        self.shared.wake.notify_one();
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Which picture is painted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
enum RenderPhase {
    /// The whole one, or a draft once that is found to take too long for a drag.
    #[default]
    Whole,
    /// The draft, which shows a drag.
    Draft,
    /// The whole one, however long that takes: the user paused a drag.
    Paused,
}

/// The current work of the thread.
#[derive(Default)]
struct RenderWork {
    wanted: Option<RenderRequest>,
    whole: RenderPass,
    draft: Option<DraftRender>,
    /// What was shown before the drag began.
    at_rest: Option<Document>,
    phase: RenderPhase,
    /// How far the reduced document is ready for a drag.
    readiness: Readiness,
    /// The whole picture still needs the surface of dragged parts, and how long that took last.
    is_behind: bool,
    shaping: Duration,
}

/// `None` once the window is closed.
fn work(shared: &SharedRequest, sender: &Sender<RenderedTileBatch>, done: &dyn Fn()) -> Option<()> {
    let mut work = RenderWork::default();
    let send = |painted| {
        let is_awaited = lock(&shared.is_awaited);
        sender.send(painted).ok()?;
        let is_taken = *is_awaited;
        drop(is_awaited);
        if !is_taken {
            done();
        }
        Some(())
    };
    loop {
        if let Some(next) = work.wait(shared)? {
            let picture = next.picture;
            let refused = work.if_there_is_memory(|work| work.begin(next)).err();
            // Nothing differs: the picture is complete already.
            if !work.has_more() {
                send(RenderedTileBatch { picture, refused, ..work.nothing() })?;
            }
        }
        let begun = Instant::now();
        loop {
            let painted = match work.if_there_is_memory(RenderWork::paint) {
                Ok(Some(painted)) => painted,
                Ok(None) => break,
                Err(refused) => {
                    let picture = work.wanted.as_ref().map_or(0, |wanted| wanted.picture);
                    send(RenderedTileBatch { picture, refused: Some(refused), ..work.nothing() })?;
                    break;
                }
            };
            let is_settled = painted.is_settled;
            send(painted)?;
            let newer = lock(&shared.wanted).is_some();
            if (newer && (is_settled || begun.elapsed() > PASS))
                || (work.is_drafting() && is_settled)
            {
                break;
            }
        }
    }
}

impl RenderWork {
    /// Does some of the work; without memory for it, it is put aside, and the next document is
    /// painted whole.
    fn if_there_is_memory<T>(
        &mut self,
        step: impl FnOnce(&mut Self) -> T,
    ) -> Result<T, OutOfMemory> {
        let done = memory::catch_out_of_memory(|| step(self));
        if done.is_err() {
            (self.whole, self.draft) = (RenderPass::default(), None);
            (self.phase, self.readiness) = (RenderPhase::Whole, Readiness::Ready);
        }
        done
    }

    /// Waits for something to do; returns the newly requested document, if any. `None` once the
    /// window is closed.
    fn wait(&mut self, shared: &SharedRequest) -> Option<Option<RenderRequest>> {
        let mut pause = PAUSE;
        let mut wanted = lock(&shared.wanted);
        loop {
            if *lock(&shared.closed) {
                return None;
            }
            if wanted.is_some() || (!self.is_drafting() && self.has_more()) {
                return Some(wanted.take());
            }
            let rest =
                if self.is_drafting() { Some(REST) } else { self.is_slow().then_some(pause) };
            let Some(rest) = rest else {
                wanted = shared.wake.wait(wanted).unwrap_or_else(PoisonError::into_inner);
                continue;
            };
            let (next, waited) =
                shared.wake.wait_timeout(wanted, rest).unwrap_or_else(PoisonError::into_inner);
            wanted = next;
            if waited.timed_out() && self.is_drafting() {
                self.phase = RenderPhase::Paused;
            } else if waited.timed_out() {
                drop(wanted);
                // If there is no memory to prepare a drag, the drag itself will report it.
                let is_prepared = self.if_there_is_memory(Self::prepare).is_ok();
                let waits = is_prepared && self.readiness == Readiness::Waits;
                // The next part at once.
                pause = if waits { LOOK } else { Duration::ZERO };
                wanted = lock(&shared.wanted);
            }
        }
    }

    /// A drag will need a smaller picture, and some of it is still to be made.
    fn is_slow(&self) -> bool {
        self.readiness != Readiness::Ready && self.whole.slowest() > FINE
    }

    /// Scales down some of the document before a drag needs it: all of a large one would delay the
    /// first frame.
    fn prepare(&mut self) {
        let step = step_for(self.whole.slowest());
        self.readiness = match &self.wanted {
            Some(wanted) => {
                self.draft.get_or_insert_with(|| DraftRender::new(step)).prepare(&wanted.document)
            }
            None => Readiness::Ready,
        };
    }

    fn begin(&mut self, next: RenderRequest) {
        if self.wanted.as_ref().is_none_or(|old| old.picture != next.picture) {
            (self.whole, self.draft, self.at_rest) = (RenderPass::default(), None, None);
        } else if let Some(old) = self.wanted.take_if(|old| next.is_dragged && !old.is_dragged) {
            self.draft.iter_mut().for_each(|draft| draft.reduced.keep(&old.document));
            self.at_rest = Some(old.document);
        }
        self.whole.begin(next.document.clone());
        self.is_behind = next.document.is_ahead();
        // The first frame of a large canvas is not waited for either.
        let area = next.document.size.area();
        let shaping =
            if self.shaping.is_zero() { SHAPING.mul_f32(area as f32) } else { self.shaping };
        let is_slow = self.is_behind && shaping > FRAME;
        if is_slow && self.draft.is_none() {
            // The surface of parts is scaled down, too.
            self.begin_draft(step_for(self.whole.slowest().max(shaping)).max(2));
        }
        let was_quick = self
            .draft
            .as_ref()
            .is_none_or(|draft| draft.is_unused() || draft.is_quick_in_whole_pixels());
        let drafts = next.is_dragged && (is_slow || !was_quick);
        (self.wanted, self.readiness) = (Some(next), Readiness::NotYet);
        self.phase = RenderPhase::Whole;
        if drafts {
            self.show_draft();
        }
    }

    /// Gives the whole picture the surface of its parts.
    fn catch_up(&mut self) {
        let Some(wanted) = self.wanted.as_ref().filter(|_| self.is_behind) else { return };
        let begun = Instant::now();
        self.whole.begin(wanted.document.reshaped());
        (self.shaping, self.is_behind) = (begun.elapsed(), false);
    }

    fn begin_draft(&mut self, step: u32) {
        let mut draft = DraftRender::new(step);
        self.at_rest.iter().for_each(|document| draft.reduced.keep(document));
        self.draft = Some(draft);
    }

    fn is_drafting(&self) -> bool {
        self.phase == RenderPhase::Draft
    }

    /// Passes the requested document to the draft, which is painted from now on.
    fn show_draft(&mut self) {
        self.phase = RenderPhase::Draft;
        if let Some(draft) = self.draft.as_ref().filter(|draft| draft.is_slow()) {
            let step = draft.step * 2;
            self.begin_draft(step);
        }
        let (Some(draft), Some(wanted)) = (&mut self.draft, &self.wanted) else { return };
        draft.wait_for_surface(&wanted.document);
        match draft.reduced.of(&wanted.document) {
            Ok(small) => draft.pass.begin(small),
            // A surface too thin to be scaled down is painted whole.
            Err(_) => (self.draft, self.phase) = (None, RenderPhase::Whole),
        }
    }

    fn has_more(&self) -> bool {
        match &self.draft {
            Some(draft) if self.is_drafting() => draft.pass.has_more(),
            _ => self.is_behind || self.whole.has_more(),
        }
    }

    fn nothing(&self) -> RenderedTileBatch {
        let size = self.wanted.as_ref().map_or(Size::new(0, 0), |wanted| wanted.document.size);
        let (is_draft, size) = match &self.draft {
            Some(draft) if self.is_drafting() => (true, draft.pass.size().unwrap_or(size)),
            _ => (false, size),
        };
        let (tiles, took) = (Vec::new(), Duration::ZERO);
        RenderedTileBatch {
            picture: 0,
            is_draft,
            size,
            tiles,
            is_settled: true,
            took,
            refused: None,
        }
    }

    /// Paints some of what is left, visible tiles first.
    fn paint(&mut self) -> Option<RenderedTileBatch> {
        let wanted = self.wanted.as_ref()?;
        let (picture, is_dragged, visible) = (wanted.picture, wanted.is_dragged, wanted.visible);
        let is_drafting = self.is_drafting();
        if let Some(draft) = self.draft.as_mut().filter(|_| is_drafting) {
            let done = draft.pass.paint(draft.in_sight(visible), BATCH)?;
            let size = draft.pass.size()?;
            return Some(RenderedTileBatch { is_draft: true, ..done.into_batch(picture, size) });
        }
        self.catch_up();
        let done = self.whole.paint(visible, if is_dragged { FEW } else { BATCH })?;
        if is_dragged && self.phase == RenderPhase::Whole && !done.is_settled && done.took > FINE {
            let step = step_for(done.took.mul_f32(done.share_left() + 1.0));
            // A prepared one will do if it is small enough, unless all pixels can be shown.
            let does = |draft: &DraftRender| {
                draft.step == step || (draft.is_unused() && draft.step > step && step > 1)
            };
            if !self.draft.as_ref().is_some_and(does) {
                self.begin_draft(step);
            }
            self.show_draft();
        }
        let size = size_of_request(self.wanted.as_ref());
        Some(done.into_batch(picture, size))
    }
}

fn size_of_request(wanted: Option<&RenderRequest>) -> Size {
    wanted.map_or(Size::new(0, 0), |wanted| wanted.document.size)
}

/// How much smaller a picture must be to be painted within a frame, if whole pixels take so long.
fn step_for(whole: Duration) -> u32 {
    let fits =
        |step: u32| whole.as_secs_f32() * DRAFT_SHARE <= FRAME.as_secs_f32() * (step * step) as f32;
    [1, 2, 4].into_iter().find(|&step| fits(step)).unwrap_or(COARSEST)
}

#[cfg(test)]
mod tests;
