//! A second view of the document in front, in a window of its own: the whole picture beside details,
//! or a detail on another screen. Both are painted in; each has its own zoom. Floor 7.

use super::ants::Ants;
use super::blocks::{corners, middle_on_pixels, on_screen};
use super::ground::surround_shape;
use super::parts::PartMarks;
use super::pointer::PointerState;
use super::{Canvas, guides, marks, to_screen, tool_keys, visible_rect, words};
use crate::keymap::Keymap;
use crate::keys;
use crate::language::tr;
use crate::math::{Affine2, Vec2, vec2};
use crate::pen::SharedTablet;
use crate::preferences::Preferences;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::ViewAction;
use crate::session::{Action, CanvasView, OpenDocument, Session};
use crate::theme;
use crate::titles::title_of;
use crate::tr;
use eframe::egui::{
    CentralPanel, Context, Id, Painter, Response, Role, Sense, Ui, ViewportBuilder, ViewportId,
    WidgetInfo,
};

/// The size that its window begins with, points.
const SIZE_PT: [f32; 2] = [720.0, 560.0];

/// The second view, while it is shown.
#[derive(Default)]
pub struct SecondView {
    is_open: bool,
    /// Of the open document of this key; another one is seen whole at first.
    view: Option<(usize, CanvasView)>,
    /// The size of the view when it was last shown, points.
    area_pt: Vec2,
    hand: PointerState,
    ants: Ants,
    parts: PartMarks,
}

impl SecondView {
    /// Opens or closes it.
    pub fn toggle(&mut self) {
        (self.is_open, self.view) = (!self.is_open, None);
    }

    /// The tablet that its pointer may belong to.
    pub fn draw_on(&mut self, tablet: SharedTablet) {
        self.hand.draw_on(tablet);
    }

    /// Works as the user prefers.
    pub fn prefer(&mut self, preferences: &Preferences) {
        self.hand.prefer(preferences);
    }

    /// Shows it, where the system has windows, as one of its own, in which the keys of `keymap` count,
    /// too. Without a keymap it is looked at, and nothing else: a dialog is open.
    pub fn show(
        &mut self,
        ctx: &Context,
        canvas: &mut Canvas,
        session: &Session,
        keymap: Option<&Keymap>,
        requests: &mut UiRequests,
    ) {
        if !self.is_open {
            return;
        }
        let title = session.active().map_or_else(String::new, title_of);
        let builder = ViewportBuilder::default()
            .with_title(tr!("{title} – second view", title))
            .with_inner_size(SIZE_PT);
        let id = ViewportId::from_hash_of("second view");
        ctx.show_viewport_immediate(id, builder, |ui, _| {
            let mut own = UiRequests::default();
            CentralPanel::no_frame().show(ui, |ui| self.draw(ui, canvas, session, &mut own));
            let is_apart = ui.ctx().viewport_id() == id;
            if is_apart && ui.input(|i| i.viewport().close_requested()) {
                self.is_open = false;
            }
            if let Some(keymap) = keymap.filter(|_| is_apart) {
                keys::listen(ui.ctx(), session, keymap, &mut own);
                tool_keys::listen(ui, session, &mut own.actions);
            }
            self.follow(ui, session, own, keymap.is_some(), requests);
        });
    }

    fn draw(
        &mut self,
        ui: &mut Ui,
        canvas: &mut Canvas,
        session: &Session,
        requests: &mut UiRequests,
    ) {
        let rect = ui.available_rect_before_wrap();
        let response = ui.interact(rect, Id::unique("second view"), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, tr("Second view")));
        let painter = ui.painter_at(rect);
        let ground = painter.rect_filled(rect, 0.0, theme::surround(ui.visuals()));
        let Some(open) = session.active() else { return self.hand.overhear(ui) };
        let view = self.view_of(open, vec2(rect.width(), rect.height()));
        let middle = middle_on_pixels(rect, &view, ui.ctx().pixels_per_point());
        let to_window = Affine2::from_translation(vec2(middle.x, middle.y));
        let screen_from_canvas = to_window * view.screen_from_canvas();
        let outline = corners(open.shown_document().size.rect());
        let outline = outline.map(|(x, y)| on_screen(screen_from_canvas, x, y));
        painter.set(ground, surround_shape(rect, outline, ui.visuals()));
        canvas.draw_elsewhere(ui.ctx(), session, &painter, screen_from_canvas);
        if session.shows_saved {
            words::show_badge(ui, rect, words::AS_SAVED);
        }
        self.draw_aids(&painter, &response, session, (view, screen_from_canvas), canvas);
        canvas.draw_loupe(ui, self.hand.picking(), session, screen_from_canvas.inverse(), false);
        self.hand.listen(ui, &response, session, &view, middle, &mut requests.actions);
    }

    /// The view of a document: all of it at first, and as long as nobody moves it.
    fn view_of(&mut self, open: &OpenDocument, area_pt: Vec2) -> CanvasView {
        let size = open.shown_document().size;
        let was_fitting = CanvasView::fitting(size, self.area_pt);
        let known = self.view.filter(|(key, view)| *key == open.key && *view != was_fitting);
        let view = known.map_or_else(|| CanvasView::fitting(size, area_pt), |(_, view)| view);
        (self.view, self.area_pt) = (Some((open.key, view)), area_pt);
        view
    }

    /// What helps the hand, over the picture. Tools mark places of the unwrapped surface while that
    /// is shown, which have none here.
    fn draw_aids(
        &mut self,
        painter: &Painter,
        response: &Response,
        session: &Session,
        (view, screen_from_canvas): (CanvasView, Affine2),
        canvas: &mut Canvas,
    ) {
        let visible = visible_rect(&view, response.rect);
        guides::draw(painter, session, &to_screen(screen_from_canvas), visible, view.zoom);
        self.ants.draw(painter, session, screen_from_canvas, visible);
        if !is_flat(session) {
            return;
        }
        let pointer = response.hover_pos().filter(|_| !self.hand.is_looking());
        let inverse = screen_from_canvas.inverse();
        let under = pointer.map(|p| inverse.transform_point2(vec2(p.x, p.y)));
        let tool = self.hand.tool(session);
        marks::draw(painter, session, screen_from_canvas, under, tool);
        self.parts.draw(painter, session, screen_from_canvas, under, tool);
        if response.hovered() || self.hand.is_looking() {
            canvas.under = under.filter(|p| visible.contains(p.x as i32, p.y as i32));
            painter.ctx().set_cursor_icon(self.hand.cursor(session, under.is_some()));
        }
    }

    /// Moves the view as asked for in its window, and passes on what is meant for the document.
    fn follow(
        &mut self,
        ui: &Ui,
        session: &Session,
        own: UiRequests,
        is_free: bool,
        requests: &mut UiRequests,
    ) {
        let is_painted_in = is_flat(session) && is_free || session.is_drawing();
        for action in own.actions {
            match action {
                Action::View(action) if self.try_move(session, &action) => {}
                action if is_painted_in || matches!(action, Action::View(_)) => {
                    requests.act(action)
                }
                _ => {}
            }
        }
        for request in own.window {
            match request {
                WindowRequest::Scale(scale) if scale > 0.0 => {
                    let zoom = scale / ui.ctx().pixels_per_point();
                    self.try_move(session, &ViewAction::ZoomTo { zoom });
                }
                WindowRequest::Scale(_) => self.view = None,
                request => requests.request(request),
            }
        }
    }

    /// Moves the view, if an action is one that does.
    fn try_move(&mut self, session: &Session, action: &ViewAction) -> bool {
        let Some((open, (key, view))) = session.active().zip(self.view) else { return false };
        let next = action.view_after(view, open.shown_document().size);
        self.view = next.map(|next| (key, next)).or(self.view);
        next.is_some()
    }
}

/// Whether tools work on the picture, not on the surface unwrapped.
fn is_flat(session: &Session) -> bool {
    session.active().is_some_and(|open| open.unwrap_settings().is_none())
}
