//! Panels in a narrow window: they slide in over the picture, and a touch on the picture puts them
//! away. Floor 7. Not here: where they are in a wide one (`layout`).

use super::MainWindow;
use crate::language::tr;
use crate::panel_layout::PanelSide;
use crate::requests::UiRequests;
use eframe::egui::{
    Area, Button, Context, Frame, Id, Order, Rect, Sense, Ui, UiBuilder, Vec2, pos2, vec2,
};

/// Windows below this width have no room for panels beside the picture, points.
const NARROW_PT: f32 = 640.0;
/// The handle that opens and closes them, points.
const HANDLE_PT: Vec2 = vec2(26.0, 72.0);
/// The greatest share of the window that they cover.
const SHARE: f32 = 0.82;

/// Whether a window is too narrow for panels beside the picture.
pub(super) fn is_narrow(ctx: &Context) -> bool {
    ctx.content_rect().width() < NARROW_PT
}

impl MainWindow {
    /// Shows the panels' handle and, while they are open, the panels.
    pub(super) fn show_drawer(&mut self, ui: &Ui, requests: &mut UiRequests) {
        let ctx = ui.ctx();
        let room = ui.max_rect();
        let width = self.settings.layout.width_pt.min(SHARE * room.width());
        let shown = width * ctx.animate_bool(Id::unique("drawer opens"), self.is_drawer_open);
        let is_left = self.settings.layout.side == PanelSide::Left;
        // The edge that moves, and which way the panels lie of it.
        let edge = if is_left { room.left() + shown } else { room.right() - shown };
        if shown > 0.0 {
            let left = if is_left { edge - width } else { edge };
            let drawer = Rect::from_min_size(pos2(left, room.top()), vec2(width, room.height()));
            self.is_drawer_open &= !is_picture_touched(ctx, room);
            let area = Area::new(Id::unique("drawer")).order(Order::Middle).constrain(false);
            area.fixed_pos(drawer.min).show(ctx, |ui| {
                ui.allocate_rect(drawer, Sense::click_and_drag());
                ui.painter().rect_filled(drawer, 0.0, ui.visuals().panel_fill);
                let frame = Frame::side_top_panel(ui.style());
                let inside = drawer - frame.total_margin();
                let mut inside = ui.new_child(UiBuilder::new().max_rect(inside));
                self.show_panels(&mut inside, requests);
            });
        }
        let left = if is_left { edge } else { edge - HANDLE_PT.x };
        let at = pos2(left, room.center().y - 0.5 * HANDLE_PT.y);
        let sign = if self.is_drawer_open == is_left { "‹" } else { "›" };
        let handle = Area::new(Id::unique("drawer's handle")).order(Order::Middle);
        handle.constrain(false).fixed_pos(at).show(ctx, |ui| {
            let button = ui.add_sized(HANDLE_PT, Button::new(sign)).on_hover_text(tr("Panels"));
            crate::widgets::set_accessible_name(&button, tr("Panels"));
            if button.clicked() {
                self.is_drawer_open = !self.is_drawer_open;
            }
        });
    }
}

/// Whether the picture was touched; nothing is painted by that.
fn is_picture_touched(ctx: &Context, room: Rect) -> bool {
    let shield = Area::new(Id::unique("beside the drawer")).order(Order::Middle).constrain(false);
    shield
        .fixed_pos(room.min)
        .show(ctx, |ui| ui.allocate_rect(room, Sense::click()))
        .inner
        .clicked()
}
