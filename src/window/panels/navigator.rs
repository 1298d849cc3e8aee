//! The navigator: the whole picture with an outline around the visible part; a click moves the view
//! there. Floor 7.

use crate::canvas::Canvas;
use crate::language::tr;
use crate::math::{Size, Vec2, vec2};
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::ViewAction;
use crate::session::view::{CanvasView, ZOOMS};
use crate::session::{Action, Session};
use crate::widgets::NumberField;
use eframe::egui::{self, Color32, Rect, Sense, Shape, Stroke, Ui, pos2};

pub fn show(ui: &mut Ui, session: &Session, canvas: &mut Canvas, requests: &mut UiRequests) {
    let Some(open) = session.active() else {
        ui.weak(tr("No document is open."));
        return;
    };
    let (size, Some(view)) = (open.shown_size(), open.view) else { return };
    small_picture(ui, (size, &view), canvas, requests);
    ui.horizontal(|ui| {
        let per_point = ui.ctx().pixels_per_point();
        let [least, most] = ZOOMS.map(|zoom| zoom * 100.0);
        let hint = "Screen pixels per hundred pixels of the canvas";
        let zoom = NumberField::new("Zoom", least..=most, hint).percent().logarithmic();
        if let Some(changed) = zoom.inline(ui, view.zoom * per_point * 100.0, 90.0) {
            requests
                .act(Action::View(ViewAction::ZoomTo { zoom: changed.to / (100.0 * per_point) }));
        }
    });
    buttons(ui, &view, requests);
}

/// The whole canvas, with an outline around what is seen of it.
fn small_picture(
    ui: &mut Ui,
    (size, view): (Size, &CanvasView),
    canvas: &mut Canvas,
    requests: &mut UiRequests,
) {
    let room = egui::vec2(ui.available_width() - 4.0, 180.0);
    let scale = (room.x / size.width as f32).min(room.y / size.height as f32);
    let side = egui::vec2(size.width as f32, size.height as f32) * scale;
    ui.vertical_centered(|ui| {
        let (rect, response) = ui.allocate_exact_size(side, Sense::click_and_drag());
        response
            .widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, tr("Navigator")));
        ui.painter().rect_filled(rect, 0.0, Color32::from_gray(0x78));
        if let Some(texture) = canvas.small(ui.ctx(), size) {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter().image(texture, rect, whole, Color32::WHITE);
        }
        let inverse = view.canvas_from_screen();
        let half = canvas.area_pt * 0.5;
        let corner = |x: f32, y: f32| {
            let p: Vec2 = inverse.transform_point2(vec2(x, y) * half) * scale;
            rect.min + egui::vec2(p.x, p.y)
        };
        let outline = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        // If everything is visible, there is no outline.
        if !Rect::from_points(&outline).contains_rect(rect.shrink(1.0)) {
            let painter = ui.painter_at(rect);
            for stroke in
                [Stroke::new(3.0, Color32::from_black_alpha(120)), Stroke::new(1.4, Color32::WHITE)]
            {
                painter.add(Shape::closed_line(outline.to_vec(), stroke));
            }
        }
        let pressed = response.interact_pointer_pos();
        if let Some(pos) = pressed.filter(|_| response.is_pointer_button_down_on()) {
            let at = (pos - rect.min) / scale;
            requests.act(Action::View(ViewAction::LookAt { center: vec2(at.x, at.y) }));
        }
    });
}

fn buttons(ui: &mut Ui, view: &CanvasView, requests: &mut UiRequests) {
    ui.horizontal(|ui| {
        if ui.button(tr("Fit")).on_hover_text(tr("The whole canvas in the window")).clicked() {
            requests.request(WindowRequest::Scale(0.0));
        }
        if ui.button("100 %").on_hover_text(tr("Actual pixels")).clicked() {
            requests.request(WindowRequest::Scale(1.0));
        }
        let mirror = ui.selectable_label(view.mirrored, tr("Mirror"));
        if mirror.on_hover_text(tr("See the picture mirrored (M)")).clicked() {
            requests.act(Action::View(ViewAction::Mirror {}));
        }
        let upright = ui.selectable_label(view.turn_rad != 0.0, tr("Upright"));
        if upright.on_hover_text(tr("Turn the canvas back (5)")).clicked() {
            requests.act(Action::View(ViewAction::Upright {}));
        }
    });
}
