//! The shape: its parts, the nearest on top, with the numbers of the selected one beneath. Floor 7.
//! `row` shows one part, `numbers` and `kinds` its settings.

mod fields;
mod kinds;
mod numbers;
mod row;

use crate::commands::PARTS;
use crate::document::{Document, Part};
use crate::icons::{Icon, icon_button};
use crate::io::recipe::parts::write_part;
use crate::language::tr;
use crate::part_pictures::PartPictures;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::PartAction;
use crate::session::{Action, LayerPath, Session};
use crate::widgets::ValueChange;
use eframe::egui::{ScrollArea, Ui};
pub use fields::presets;
use std::sync::Arc;

/// The largest share of the panel's height for the list; the numbers take the rest.
const LIST_SHARE: f32 = 0.45;
const LEAST_LIST_PT: f32 = 116.0;

fn act(requests: &mut UiRequests, action: PartAction) {
    requests.act(Action::Part(action));
}

/// Requests a part with other values.
fn set(requests: &mut UiRequests, changed: ValueChange<Part>) {
    act(requests, PartAction::Set { part: write_part(&changed.to), done: changed.done });
}

pub fn show(
    ui: &mut Ui,
    session: &Session,
    pictures: &mut PartPictures,
    requests: &mut UiRequests,
) {
    let Some((open, document)) = session.active().zip(session.shown_document()) else {
        ui.weak(tr("No document is open."));
        return;
    };
    head(ui, session, document, requests);
    if document.parts.is_empty() {
        return begin(ui, document, requests);
    }
    pictures.follow(ui.ctx(), document);
    let most = (ui.available_height() * LIST_SHARE).max(LEAST_LIST_PT);
    ScrollArea::vertical().id_salt("parts").max_height(most).auto_shrink([false, true]).show(
        ui,
        |ui| {
            ui.spacing_mut().item_spacing.y = 1.0;
            for part in forms(document).rev() {
                row::show(ui, session, document, part, pictures, requests);
                for upon in document
                    .parts
                    .list
                    .iter()
                    .rev()
                    .filter(|upon| upon.on() == Some(part.id.as_str()))
                {
                    row::show(ui, session, document, upon, pictures, requests);
                }
            }
        },
    );
    ui.add_space(2.0);
    let Some(part) = open.selected_part() else { return };
    ScrollArea::vertical().id_salt("part").auto_shrink([false, false]).show(ui, |ui| {
        flats(ui, document, part, requests);
        if let Some(changed) = numbers::show(ui, part) {
            set(requests, changed);
        }
    });
}

/// What can be done with a part that has its color from a drawing, and with that drawing.
fn flats(ui: &mut Ui, document: &Document, part: &Part, requests: &mut UiRequests) {
    let split = part.is_of_color().then(|| PartAction::Split { part: part.id.clone() });
    let drawing = document.drawing_to_cut(part).and_then(|id| LayerPath::of(document, id));
    let cut = drawing.map(|layer| PartAction::Cut { layer });
    let buttons = [
        (
            split,
            "Split by area",
            "Separate areas of its color, such as two eyes, become separate parts",
        ),
        (
            cut,
            "Cut drawing",
            "Divides the drawing into a layer for each part, so that a part moves with its paint",
        ),
    ];
    if buttons.iter().all(|(action, ..)| action.is_none()) {
        return;
    }
    ui.horizontal(|ui| {
        for (action, label, hint) in buttons {
            // Only what can be done has a button.
            if let Some(action) =
                action.filter(|_| ui.button(tr(label)).on_hover_text(tr(hint)).clicked())
            {
                act(requests, action);
            }
        }
    });
}

/// The parts that have a form of their own, the farthest first; and those that lie on nothing.
fn forms(document: &Document) -> impl DoubleEndedIterator<Item = &Arc<Part>> {
    let parts = &document.parts;
    parts.list.iter().filter(|part| part.on().is_none_or(|on| parts.part(on).is_none()))
}

/// The buttons that add, copy, order and delete.
fn head(ui: &mut Ui, session: &Session, document: &Document, requests: &mut UiRequests) {
    ui.horizontal(|ui| {
        ui.menu_button(tr("+ Part"), |ui| {
            for command in PARTS {
                let response = ui.add_enabled(
                    (command.can)(session),
                    eframe::egui::Button::new(tr(command.name)),
                );
                if response.on_hover_text(tr(command.hint)).clicked() {
                    (command.run)(session, requests);
                    ui.close();
                }
            }
        })
        .response
        .on_hover_text(tr("Adds a part in front of all others"));
        let Some(part) = session.active().and_then(|open| open.selected_part()) else { return };
        let siblings: Vec<&Arc<Part>> =
            document.parts.list.iter().filter(|other| other.on() == part.on()).collect();
        let at = siblings.iter().position(|other| other.id == part.id).unwrap_or(0);
        let order = |index: usize| PartAction::Order { part: part.id.clone(), index };
        let buttons = [
            (
                Icon::Duplicate,
                "Duplicate part",
                Some(PartAction::Duplicate { part: part.id.clone() }),
            ),
            (Icon::Up, "Bring part forward", (at + 1 < siblings.len()).then(|| order(at + 1))),
            (Icon::Down, "Send part back", at.checked_sub(1).map(order)),
            (Icon::Delete, "Delete part", Some(PartAction::Delete { part: part.id.clone() })),
        ];
        for (icon, label, action) in buttons {
            let button =
                ui.add_enabled_ui(action.is_some(), |ui| icon_button(ui, icon, label, false));
            if let Some(action) = action.filter(|_| button.inner.on_hover_text(tr(label)).clicked())
            {
                act(requests, action);
            }
        }
    });
}

/// What to do if there are no parts yet.
fn begin(ui: &mut Ui, document: &Document, requests: &mut UiRequests) {
    ui.label(match document.surface {
        Some(_) => tr("The shape comes from the maps. Parts are in front of it."),
        None => tr("This drawing has no shape yet: marks stay flat."),
    });
    let hint =
        "Inflates what the drawing covers, in one part or a part for each color, and lights it";
    if ui.button(tr("Give it a shape…")).on_hover_text(tr(hint)).clicked() {
        requests.request(WindowRequest::ShapeDialog);
    }
}
