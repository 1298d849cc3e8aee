//! Follows the document: requests its picture from the render thread, and takes what was painted.
//! Floor 7.

use super::navigator_picture::{EVERYWHERE, NavigatorPicture};
use super::sheet::TileSheet;
use super::{Canvas, visible_rect};
use crate::Error;
use crate::document::Document;
use crate::math::{Rect, Size};
use crate::render_thread::RenderRequest;
use crate::session::{CanvasView, OpenDocument, Session, is_same_look};
use crate::tools::ToolKind;
use eframe::egui;
use std::time::Duration;

/// How long a frame waits for what is being painted before it is drawn without it.
const SOON: Duration = Duration::from_millis(12);
/// After this time the sign that a picture is done is drawn again, unless something else causes a
/// frame sooner.
const SETTLED: Duration = Duration::from_millis(100);

impl Canvas {
    /// Requests the picture to show, and takes the tiles that were painted.
    pub(super) fn follow(
        &mut self,
        ctx: &egui::Context,
        session: &Session,
        view: &CanvasView,
        area: egui::Rect,
    ) {
        let Some(open) = session.active() else { return };
        let saved = open.saved_document();
        let is_as_saved = session.shows_saved && saved.size == open.shown_document().size;
        let drawn = if is_as_saved { saved.clone() } else { open.drawn_document() };
        if self.key != Some(open.key)
            || self.wanted.as_ref().is_some_and(|(old, _)| old.size != drawn.size)
        {
            self.begin(open, drawn.size);
        }
        // Any part of the picture may be in sight on the sheet.
        let visible = match open.unwrap_settings() {
            Some(_) => drawn.size.rect(),
            None => visible_rect(view, area),
        };
        self.request_picture(drawn, visible, is_dragged(session));
        let was_busy = self.is_busy;
        // What the user did is shown in the same frame, if it is painted soon.
        let is_soon = self.is_busy
            && session.is_drawing()
            && ctx.current_pass_index() > 0
            && self.took < SOON;
        self.take_rendered(open, if is_soon { SOON } else { Duration::ZERO });
        if was_busy && !self.is_busy {
            // The status bar and the panels of this frame were laid out before.
            ctx.request_repaint_after(SETTLED);
        }
        let sent = self.whole.send(ctx, self.is_busy);
        self.small_changed = self.small_changed.union(sent);
        self.draft.send(ctx, self.is_busy);
    }

    /// Starts anew for a document, or for a picture of another size.
    fn begin(&mut self, open: &OpenDocument, size: Size) {
        self.key = Some(open.key);
        self.picture += 1;
        self.whole.begin(size);
        self.small_changed = EVERYWHERE;
        self.sheet.begin();
        if let Some(picture) = open.stored_preview.take() {
            self.whole.show(picture);
        }
        (self.wanted, self.is_draft_in_front, self.draft) = (None, false, TileSheet::default());
    }

    /// Requests the picture of the document, unless it is on its way or shown.
    fn request_picture(&mut self, drawn: Document, visible: Rect, is_dragged: bool) {
        let is_wanted =
            |(old, dragged): &(Document, bool)| *dragged == is_dragged && is_same_look(old, &drawn);
        if self.wanted.as_ref().is_some_and(is_wanted) {
            return;
        }
        if let Some(thread) = &self.render_thread {
            let (picture, document) = (self.picture, drawn.clone());
            thread.want(RenderRequest { picture, document, visible, is_dragged });
            self.is_busy = true;
        }
        self.wanted = Some((drawn, is_dragged));
    }

    /// Takes what has been painted, after waiting for it for so long at most.
    fn take_rendered(&mut self, open: &OpenDocument, wait: Duration) {
        let Some(thread) = &self.render_thread else { return };
        let painted = thread.take_rendered(wait).into_iter();
        for painted in painted.filter(|painted| painted.picture == self.picture) {
            (self.took, self.is_busy) = (painted.took, !painted.is_settled);
            if let Some(refused) = painted.refused {
                self.trouble = Some(Error::out_of_memory(open.title(), refused));
            }
            let is_draft = painted.is_draft;
            if painted.is_settled {
                self.is_draft_in_front = is_draft;
            }
            if is_draft && self.draft.size() != Some(painted.size) {
                self.draft.begin(painted.size);
            }
            if is_draft {
                self.draft.take(painted);
            } else {
                self.sheet.mark_changed(painted.tiles.iter().map(|(at, _)| *at));
                self.whole.take(painted);
            }
        }
    }

    /// The small picture for the navigator, of the sheet while that is shown; updated when the
    /// render thread is idle.
    pub fn small(&mut self, ctx: &egui::Context, canvas: Size) -> Option<egui::TextureId> {
        let shown =
            if self.sheet.shown.size() == Some(canvas) { &self.sheet.shown } else { &self.whole };
        match &mut self.small {
            None => self.small = Some(NavigatorPicture::new(ctx, canvas, &shown.grid)),
            Some(small) if !self.small_changed.is_empty() && !self.is_busy => {
                small.update(ctx, canvas, &shown.grid, self.small_changed);
                self.small_changed = Rect::EMPTY;
            }
            Some(_) => {}
        }
        self.small.as_ref().map(NavigatorPicture::id)
    }
}

/// Whether a slider, a handle or a layer is being dragged. A brush does not count: its strokes
/// change few tiles, and the user looks at them closely. Nor does selecting, which changes nothing
/// in the picture.
fn is_dragged(session: &Session) -> bool {
    let paints = matches!(session.tool, ToolKind::Brush | ToolKind::Eraser)
        || session.tool.is_selection_tool();
    let paints = session.is_drawing() && paints;
    !paints && session.active().is_some_and(|open| open.is_previewing())
}
