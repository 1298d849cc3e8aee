//! A part's row: eye, picture, name and kind; drag it to another place to bring it forward or send
//! it back. Floor 7.

use super::{act, forms, set};
use crate::document::{Document, Part, PartKind};
use crate::icons::{Icon, add_sized_button};
use crate::language::tr;
use crate::panels::words::translate_within;
use crate::part_pictures::PartPictures;
use crate::requests::UiRequests;
use crate::session::Session;
use crate::session::actions::PartAction;
use crate::theme::ACCENT;
use crate::theme::strengthen_hints;
use crate::tr;
use crate::widgets::{ValueChange, sentence, set_accessible_name};
use eframe::egui::{
    self, Align2, Color32, Id, Rect, Response, Sense, Stroke, TextEdit, TextStyle, Ui, pos2, vec2,
};
use std::sync::Arc;

const ROW_PT: f32 = 34.0;
const INDENT_PT: f32 = 16.0;

/// What is dragged.
struct HeldPart(String);

pub fn show(
    ui: &mut Ui,
    session: &Session,
    document: &Document,
    part: &Arc<Part>,
    pictures: &PartPictures,
    requests: &mut UiRequests,
) {
    let lies_on = part.on().is_some_and(|on| document.parts.part(on).is_some());
    let (rect, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), ROW_PT), Sense::click_and_drag());
    let is_selected = session.active().is_some_and(|open| open.part.as_ref() == Some(&part.id));
    if is_selected {
        show_once(ui, &response, &part.id);
    }
    let label = tr!("Part {name}", name = part.name);
    response
        .widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_selected, &label));
    let fill = match (is_selected, response.hovered()) {
        (true, _) => ui.visuals().selection.bg_fill,
        (false, true) => ui.visuals().widgets.hovered.weak_bg_fill,
        _ => ui.visuals().faint_bg_color,
    };
    ui.painter().rect_filled(rect, 4.0, fill);
    let layout = egui::Layout::left_to_right(egui::Align::Center);
    let mut inner = ui.new_child(egui::UiBuilder::new().max_rect(rect).layout(layout));
    inner.spacing_mut().item_spacing.x = 3.0;
    if is_selected {
        strengthen_hints(&mut inner);
    }
    inner.add_space(2.0 + if lies_on { INDENT_PT } else { 0.0 });
    let eye = if part.visible { Icon::Shown } else { Icon::Hidden };
    let eye = add_sized_button(
        &mut inner,
        eye,
        &tr!("Show part {name}", name = part.name),
        part.visible,
        22.0,
    );
    if eye.on_hover_text(tr("Show or hide")).clicked() {
        act(requests, PartAction::Visible { part: part.id.clone(), on: !part.visible });
    }
    if !lies_on {
        picture(&mut inner, part, pictures);
    }
    name(&mut inner, part, &response, requests);
    if !lies_on {
        drag_row(ui, document, part, &response, rect, requests);
    }
    if response.clicked() {
        act(requests, PartAction::Select { part: part.id.clone() });
    }
    response.on_hover_text(tr("Drag it up to bring it forward; double-click to rename it"));
}

/// Brings a part's row into sight when the part becomes the selected one, as by a click on the
/// canvas.
fn show_once(ui: &Ui, row: &Response, part: &str) {
    let shown = Id::unique("shown part");
    if ui.data(|data| data.get_temp::<String>(shown)).as_deref() != Some(part) {
        row.scroll_to_me(None);
        ui.data_mut(|data| data.insert_temp(shown, part.to_owned()));
    }
}

fn picture(ui: &mut Ui, part: &Part, pictures: &PartPictures) {
    let (rect, _) = ui.allocate_exact_size(vec2(28.0, 28.0), Sense::hover());
    ui.painter().rect_filled(rect, 3.0, Color32::from_gray(0x50));
    if let Some((texture, size)) = pictures.picture(part).filter(|_| part.visible) {
        let scale = (rect.width() / size.x).min(rect.height() / size.y);
        let at = Rect::from_center_size(rect.center(), size * scale);
        ui.painter().image(
            texture,
            at,
            Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0)),
            Color32::WHITE,
        );
    }
}

/// The name, or a text field to change it; and the kind.
fn name(ui: &mut Ui, part: &Part, row: &Response, requests: &mut UiRequests) {
    let renaming = Id::unique("renaming part");
    let typed = ui
        .data(|data| data.get_temp::<(String, String)>(renaming))
        .filter(|(id, _)| *id == part.id);
    if let Some((id, mut text)) = typed {
        let response =
            ui.add(TextEdit::singleline(&mut text).desired_width(ui.available_width() - 8.0));
        set_accessible_name(&response, tr("Part name"));
        if response.lost_focus() {
            ui.data_mut(|data| data.remove::<(String, String)>(renaming));
            let is_kept =
                !ui.input(|i| i.key_pressed(egui::Key::Escape)) && !text.trim().is_empty();
            if is_kept && text.trim() != part.name {
                let to = Part { name: text.trim().to_owned(), ..part.clone() };
                set(requests, ValueChange { to, done: true });
            }
        } else {
            response.request_focus();
            ui.data_mut(|data| data.insert_temp(renaming, (id, text)));
        }
        return;
    }
    if row.double_clicked() {
        ui.data_mut(|data| data.insert_temp(renaming, (part.id.clone(), part.name.clone())));
    }
    let at = ui.available_rect_before_wrap();
    let strong = ui.visuals().strong_text_color();
    let color = if part.visible { strong } else { ui.visuals().weak_text_color() };
    let text = egui::WidgetText::from(egui::RichText::new(&part.name).color(color));
    let room = (at.width() - 6.0).max(10.0);
    let galley = text.into_galley(ui, Some(egui::TextWrapMode::Truncate), room, TextStyle::Body);
    ui.painter().galley(pos2(at.left() + 3.0, at.top() + 2.0), galley, color);
    let combine = match part.combine.name() {
        "over" => String::new(),
        other => format!(" · {}", translate_within(&sentence(other))),
    };
    let kind = match part.kind {
        PartKind::Inflate { .. } => "Puffed up".to_owned(),
        _ => sentence(part.kind.name()),
    };
    let about = format!("{}{combine}", tr(&kind));
    let font = TextStyle::Small.resolve(ui.style());
    let corner = pos2(at.left() + 3.0, at.bottom() - 3.0);
    ui.painter().text(corner, Align2::LEFT_BOTTOM, about, font, ui.visuals().weak_text_color());
}

/// The dragged row, and the rows that it can be dropped between.
fn drag_row(
    ui: &Ui,
    document: &Document,
    part: &Part,
    response: &Response,
    rect: Rect,
    requests: &mut UiRequests,
) {
    response.dnd_set_drag_payload(HeldPart(part.id.clone()));
    let is_above = |y: f32| y < rect.center().y;
    if let Some(held) = response.dnd_hover_payload::<HeldPart>()
        && held.0 != part.id
        && let Some(pointer) = ui.input(|i| i.pointer.hover_pos())
    {
        let y = if is_above(pointer.y) { rect.top() } else { rect.bottom() };
        ui.painter().hline(rect.x_range(), y, Stroke::new(2.0, ACCENT));
    }
    let Some(held) = response.dnd_release_payload::<HeldPart>().filter(|held| held.0 != part.id)
    else {
        return;
    };
    let Some(pointer) = ui.input(|i| i.pointer.interact_pos()) else { return };
    // How many of the others are behind this one.
    let behind =
        forms(document).filter(|other| other.id != held.0).position(|other| other.id == part.id);
    let Some(behind) = behind else { return };
    let index = if is_above(pointer.y) { behind + 1 } else { behind };
    act(requests, PartAction::Order { part: held.0.clone(), index });
}
