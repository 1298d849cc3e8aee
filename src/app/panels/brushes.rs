//! The brushes: presets, each shown painted on a ball, and the numbers of the one in hand.
//! Floor 7.

use crate::app::asked::Asked;
use crate::app::swatches::Swatches;
use crate::app::widgets::{Number, sentence, title};
use crate::io::recipe::preset_names;
use crate::paint::Property;
use crate::session::actions::HandAction;
use crate::session::actions::hand::SIZES;
use crate::session::{Action, Session};
use eframe::egui::{self, Color32, Rect, Sense, StrokeKind, Ui, pos2, vec2};

pub fn show(ui: &mut Ui, session: &Session, swatches: &mut Swatches, asked: &mut Asked) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(5.0, 5.0);
        for name in preset_names() {
            if preset(ui, name, session.preset == name, swatches) {
                asked.act(Action::Hand(HandAction::Preset { name: name.into() }));
            }
        }
    });
    ui.add_space(4.0);
    title(ui, "Brush in hand");
    numbers(ui, session, asked);
}

/// One preset; whether it was chosen.
fn preset(ui: &mut Ui, name: &str, is_on: bool, swatches: &mut Swatches) -> bool {
    let (rect, response) = ui.allocate_exact_size(vec2(72.0, 84.0), Sense::click());
    let label = sentence(name);
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_on, format!("Brush {label}")));
    let look = ui.style().interact_selectable(&response, is_on);
    ui.painter().rect(rect, 5.0, look.weak_bg_fill, look.bg_stroke, StrokeKind::Inside);
    let at = Rect::from_min_size(rect.min + vec2(4.0, 4.0), vec2(64.0, 62.0));
    if let Some(texture) = swatches.of(ui.ctx(), name) {
        ui.painter().image(texture, at, Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0)), Color32::WHITE);
    }
    let font = egui::TextStyle::Small.resolve(ui.style());
    ui.painter().text(
        pos2(rect.center().x, rect.bottom() - 4.0),
        egui::Align2::CENTER_BOTTOM,
        &label,
        font,
        look.text_color(),
    );
    response.on_hover_text(label).clicked()
}

fn numbers(ui: &mut Ui, session: &Session, asked: &mut Asked) {
    let brush = &session.brush;
    let mut push = |action: Option<HandAction>| asked.actions.extend(action.map(Action::Hand));
    let size = Number::new("Size", SIZES[0]..=SIZES[1], "Diameter of a dab").px();
    push(size.row(ui, brush.size).map(|c| HandAction::Size { to: c.to }));
    let hardness = Number::new("Hardness", 0.0..=1.0, "Share of the radius that is fully covered");
    push(hardness.row(ui, brush.hardness).map(|c| HandAction::Hardness { to: c.to }));
    let softness = Number::new("Softness", 0.0..=1.0, "Blur of the footprint: a rougher, less glossy mark");
    push(softness.row(ui, brush.softness).map(|c| HandAction::Softness { to: c.to }));
    let opacity = Number::new("Opacity", 0.0..=1.0, "Of the whole stroke");
    push(opacity.row(ui, brush.opacity).map(|c| HandAction::Opacity { to: c.to }));
    let flow = Number::new("Flow", 0.0..=1.0, "What one dab adds");
    push(flow.row(ui, brush.flow).map(|c| HandAction::Flow { to: c.to }));
    let spacing = Number::new("Spacing", 0.01..=4.0, "Distance between dabs, in diameters").logarithmic();
    push(spacing.row(ui, brush.spacing).map(|c| HandAction::Spacing { to: c.to }));
    let rotation = Number::new("Rotation", -180.0..=180.0, "Of the tip, counter-clockwise").degrees();
    push(rotation.row(ui, brush.rotation).map(|c| HandAction::Rotation { to: c.to }));
    title(ui, "Pen pressure");
    let [size, flow] = [Property::Size, Property::Flow].map(|property| brush.dynamics.pressure_share(property));
    let drives = Number::new("Size", 0.0..=1.0, "How much the size follows the pressure");
    push(drives.row(ui, size).map(|c| HandAction::Pressure { size: c.to, flow }));
    let drives = Number::new("Flow", 0.0..=1.0, "How much the flow follows the pressure");
    push(drives.row(ui, flow).map(|c| HandAction::Pressure { size, flow: c.to }));
}
