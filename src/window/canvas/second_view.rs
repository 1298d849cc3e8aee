//! A second view of the document in front, in a window of its own: the whole picture beside details,
//! or a detail on another screen. It is looked at, not painted in. Floor 7.

use super::Canvas;
use crate::keymap::Keymap;
use crate::keys;
use crate::math::{Affine2, Vec2, vec2};
use crate::requests::UiRequests;
use crate::session::{CanvasView, Session};
use crate::theme;
use eframe::egui::{
    CentralPanel, Context, Id, Key, PointerButton, Pos2, Rect, Sense, Ui, ViewportBuilder,
    ViewportId,
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
}

impl SecondView {
    /// Opens or closes it.
    pub fn toggle(&mut self) {
        (self.is_open, self.view) = (!self.is_open, None);
    }

    /// Shows it, where the system has windows, as one of its own, in which the keys of `keymap` count,
    /// too.
    pub fn show(
        &mut self,
        ctx: &Context,
        canvas: &Canvas,
        session: &Session,
        keymap: Option<&Keymap>,
        requests: &mut UiRequests,
    ) {
        if !self.is_open {
            return;
        }
        let title = session.active().map_or_else(String::new, |open| open.title());
        let builder = ViewportBuilder::default()
            .with_title(format!("{title} – second view"))
            .with_inner_size(SIZE_PT);
        let id = ViewportId::from_hash_of("second view");
        ctx.show_viewport_immediate(id, builder, |ui, _| {
            let close = |ui: &Ui| {
                ui.input(|i| i.viewport().close_requested() || i.key_pressed(Key::Escape))
            };
            CentralPanel::no_frame().show(ui, |ui| self.draw(ui, canvas, session));
            let is_alone = ui.ctx().viewport_id() == id;
            if is_alone && close(ui) {
                self.is_open = false;
            } else if let Some(keymap) = keymap.filter(|_| is_alone) {
                keys::listen(ui.ctx(), session, keymap, requests);
            }
        });
    }

    fn draw(&mut self, ui: &mut Ui, canvas: &Canvas, session: &Session) {
        let rect = ui.available_rect_before_wrap();
        let response = ui.interact(rect, Id::unique("second view"), Sense::click_and_drag());
        response.widget_info(|| {
            eframe::egui::WidgetInfo::labeled(eframe::egui::Role::Image, true, "Second view")
        });
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 0.0, theme::surround(ui.visuals()));
        let Some(open) = session.active() else { return };
        let size = open.shown_document().size;
        let area_pt = vec2(rect.width(), rect.height());
        let fitting = CanvasView::fitting(size, area_pt);
        // A view of everything stays so when the window gets another size.
        let was_fitting = CanvasView::fitting(size, self.area_pt);
        let known = self.view.filter(|(key, view)| *key == open.key && *view != was_fitting);
        let view = known.map_or(fitting, |(_, view)| view);
        let view = drag_view(ui, rect, &response, view).unwrap_or(view);
        let view = if response.double_clicked() { fitting } else { view };
        (self.view, self.area_pt) = (Some((open.key, view)), area_pt);
        let middle = rect.center();
        let to_window = Affine2::from_translation(vec2(middle.x, middle.y));
        canvas.draw_elsewhere(&painter, to_window * view.screen_from_canvas(), size);
    }
}

/// The view after this frame's drags and wheel.
fn drag_view(
    ui: &Ui,
    rect: Rect,
    response: &eframe::egui::Response,
    view: CanvasView,
) -> Option<CanvasView> {
    let about = |pos: Pos2| vec2(pos.x - rect.center().x, pos.y - rect.center().y);
    if response.dragged_by(PointerButton::Primary) || response.dragged_by(PointerButton::Middle) {
        let by = response.drag_delta();
        return Some(view.panned(vec2(by.x, by.y)));
    }
    let at = response.hover_pos()?;
    let (wheel, pinch) = ui.input(|i| (i.smooth_scroll_delta.y, i.zoom_delta()));
    let factor = (wheel * 0.005).exp() * pinch;
    (factor.is_finite() && factor != 1.0).then(|| view.zoomed(factor, about(at)))
}
