//! The options of the assistants' tool: what it places, and how strongly assistants attract
//! strokes. Floor 7.

use crate::document::AssistantKind;
use crate::document::Symmetry;
use crate::language::tr;
use crate::requests::UiRequests;
use crate::session::actions::{GuideAction, HandAction};
use crate::session::{Action, Session};
use crate::tools::snap::ViewAids;
use crate::widgets::NumberField;
use eframe::egui::{Button, Ui};

const KINDS: [(AssistantKind, &str, &str); 6] = [
    (AssistantKind::Line, "Line", "Drag from end to end; strokes that begin near it are straight"),
    (AssistantKind::Parallel, "Parallel lines", "Drag the direction that strokes have everywhere"),
    (AssistantKind::Ellipse, "Ellipse", "Drag one axis; its third handle sets the other"),
    (
        AssistantKind::OnePoint,
        "1-point perspective",
        "Click the vanishing point; level and upright lines are followed too",
    ),
    (
        AssistantKind::TwoPoint,
        "2-point perspective",
        "Drag the horizon from one vanishing point to the other",
    ),
    (
        AssistantKind::ThreePoint,
        "3-point perspective",
        "Drag between two vanishing points; then move the third",
    ),
];

pub fn options(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let aids = session.tools.aids;
    let mut set = |aids: ViewAids| requests.act(Action::Guide(GuideAction::Aids { aids }));
    for (assistant, label, hint) in KINDS {
        if ui
            .add(Button::selectable(aids.assistant == assistant, tr(label)))
            .on_hover_text(tr(hint))
            .clicked()
        {
            set(ViewAids { assistant, ..aids });
        }
    }
    ui.add_space(6.0);
    let hint = "How strongly strokes follow assistants: 0 not at all, 1 fully";
    let magnetism = NumberField::new("Magnetism", crate::math::UNIT, hint);
    if let Some(changed) = magnetism.inline(ui, aids.magnetism, 80.0) {
        set(ViewAids { magnetism: changed.to, ..aids });
    }
    if session.symmetry().kind != Symmetry::None && ui.button(tr("Axes to the middle")).clicked() {
        requests.act(Action::Hand(HandAction::Axes { center: None, turn: 0.0 }));
    }
}
