//! The options of the crop tool: its area in numbers, the aspect that it keeps, and its commands.
//! Floor 7.

use crate::canvas::crop;
use crate::language::tr;
use crate::math::Rect;
use crate::requests::UiRequests;
use crate::session::actions::CanvasAction;
use crate::session::{Action, Session};
use crate::tools::crop::CropAspect;
use crate::widgets::{choice, number};
use eframe::egui::{Button, Ui};

/// Places and sides that can be typed, px.
const PLACE: std::ops::RangeInclusive<i32> = -65_536..=65_536;
const SIDE: std::ops::RangeInclusive<i32> = 1..=65_536;

pub fn options(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let Some(canvas) = session.active().map(|open| open.document().size) else { return };
    let area = session.tools.crop.area.unwrap_or(canvas.rect());
    let (mut x, mut y) = (area.x0, area.y0);
    let (mut width, mut height) = (area.width() as i32, area.height() as i32);
    let edit = |ui: &mut Ui, label: &str, value: &mut i32, range| {
        let label = ui.label(tr(label));
        ui.add(number(value).range(range).speed(1.0).suffix(" px")).labelled_by(label.id).changed()
    };
    let mut is_other = edit(ui, "X", &mut x, PLACE);
    is_other |= edit(ui, "Y", &mut y, PLACE);
    let wider = edit(ui, "Width", &mut width, SIDE);
    let taller = edit(ui, "Height", &mut height, SIDE);
    if let Some(ratio) = session.tools.crop.aspect.ratio(canvas) {
        let round = |v: f32| (v.round() as i32).clamp(*SIDE.start(), *SIDE.end());
        match (wider, taller) {
            (true, _) => height = round(width as f32 / ratio),
            (_, true) => width = round(height as f32 * ratio),
            _ => {}
        }
    }
    if is_other || wider || taller {
        let area = Some(Rect::new(x, y, x + width, y + height));
        requests.act(Action::Canvas(CanvasAction::CropArea { frame: area }));
    }
    ui.add_space(6.0);
    if let Some(aspect) =
        choice(ui, "Aspect of the frame", session.tools.crop.aspect, &CropAspect::LABELS)
    {
        requests.act(Action::Canvas(CanvasAction::Aspect { aspect }));
    }
    ui.add_space(6.0);
    let crops = ui.add_enabled(session.tools.crop.area.is_some(), Button::new(tr("Crop to frame")));
    if crops.on_hover_text(tr("The canvas becomes the frame (Enter)")).clicked() {
        requests.act(crop::apply(area));
    }
    let drops = ui.add_enabled(session.tools.crop.area.is_some(), Button::new(tr("Discard")));
    if drops.on_hover_text(tr("Removes the frame (Escape)")).clicked() {
        requests.act(Action::Canvas(CanvasAction::CropArea { frame: None }));
    }
}
