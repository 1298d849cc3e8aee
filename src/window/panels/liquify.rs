//! The options of the liquify tool.
//! Floor 7.

use crate::commands::{REMOVE_LIQUIFY, TRANSFORMS};
use crate::language::tr;
use crate::paint::{LiquifySettings, LiquifyTool};
use crate::requests::UiRequests;
use crate::session::actions::HandAction;
use crate::session::{Action, Session};
use crate::widgets::{NumberField, check_box, tr_sentence};
use eframe::egui::{Button, Ui};

pub fn options(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let (now, mut to) = (session.tools.liquify, None);
    for (tool, label) in LiquifyTool::LABELS {
        let button = Button::selectable(now.tool == tool, tr_sentence(label));
        if ui.add(button).on_hover_text(tr(tool.hint())).clicked() {
            to = Some(LiquifySettings { tool, ..now });
        }
    }
    ui.add_space(6.0);
    let field = NumberField::new(
        "Size",
        LiquifySettings::SIZE,
        "Diameter of a dab ([ and ], or the right button)",
    );
    to =
        field.px().inline(ui, now.size, 70.0).map(|c| LiquifySettings { size: c.to, ..now }).or(to);
    let hint = "Strength of a dab; a push at 1 goes as far as the pen. Lighter pressure does less";
    let field = NumberField::new("Strength", LiquifySettings::STRENGTH, hint);
    to = field
        .inline(ui, now.strength, 60.0)
        .map(|c| LiquifySettings { strength: c.to, ..now })
        .or(to);
    let mut next = now;
    let hint = "Only the object under the first dab is displaced";
    if check_box(ui, &mut next.one_object, "Keep to one object").on_hover_text(tr(hint)).changed() {
        to = Some(LiquifySettings { one_object: next.one_object, ..now });
    }
    let hint = "Measures dabs and their movement along the surface: less where it turns away";
    if check_box(ui, &mut next.foreshortened, "Foreshortened").on_hover_text(tr(hint)).changed() {
        to = Some(LiquifySettings { foreshortened: next.foreshortened, ..now });
    }
    if let Some(command) = TRANSFORMS.iter().find(|command| command.name == REMOVE_LIQUIFY) {
        let button = ui
            .add_enabled((command.can)(session), Button::new(tr(command.name)))
            .on_hover_text(tr(command.hint));
        if button.clicked() {
            (command.run)(session, requests);
        }
    }
    requests.actions.extend(to.map(|liquify| Action::Hand(HandAction::Liquify { liquify })));
}
