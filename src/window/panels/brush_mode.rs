//! The brush mode (paint, smudge, blur, clone) and where the brush may paint.
//! Floor 7.

use super::fill::BOUNDS;
use crate::paint::BrushMode;
use crate::requests::UiRequests;
use crate::session::actions::HandAction;
use crate::session::{Action, Session};
use crate::surface::Operator;
use crate::widgets::{NumberField, check, choice, radio, sentence};
use eframe::egui::Ui;

/// The brush modes.
#[derive(Clone, Copy, PartialEq)]
enum BrushModeChoice {
    Paint,
    Smudge,
    Blur,
    Clone,
}

const KINDS: [(BrushModeChoice, &str); 4] = [
    (BrushModeChoice::Paint, "paint"),
    (BrushModeChoice::Smudge, "smudge"),
    (BrushModeChoice::Blur, "blur"),
    (BrushModeChoice::Clone, "clone"),
];

/// In a bar.
pub fn options(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let mode = session.tools.brush.mode;
    let mut give = |mode: Option<BrushMode>| {
        requests.actions.extend(mode.map(|mode| Action::Hand(HandAction::Mark { mark: mode })))
    };
    let kind = match mode {
        BrushMode::Paint => BrushModeChoice::Paint,
        BrushMode::Smudge { .. } => BrushModeChoice::Smudge,
        BrushMode::Blur { .. } => BrushModeChoice::Blur,
        BrushMode::Clone { .. } => BrushModeChoice::Clone,
    };
    give(choice(ui, "Mark", kind, &KINDS).map(|kind| match kind {
        BrushModeChoice::Paint => BrushMode::Paint,
        BrushModeChoice::Smudge => BrushMode::Smudge { length: BrushMode::SMUDGE_LENGTH },
        BrushModeChoice::Blur => BrushMode::Blur { width: BrushMode::BLUR_WIDTH },
        BrushModeChoice::Clone => BrushMode::Clone { aligned: true, picture: false },
    }));
    match mode {
        BrushMode::Paint => {}
        BrushMode::Smudge { length } => {
            let number = NumberField::new(
                "Length",
                0.0..=1.0,
                "Share of the paint that is left after a drag of one radius",
            );
            give(number.inline(ui, length, 60.0).map(|c| BrushMode::Smudge { length: c.to }));
        }
        BrushMode::Blur { width } => {
            let number = NumberField::new(
                "Width",
                0.0..=1.0,
                "How much a stroke softens an edge, as a share of the radius",
            );
            give(number.inline(ui, width, 60.0).map(|c| BrushMode::Blur { width: c.to }));
        }
        BrushMode::Clone { aligned, picture } => {
            let hint = "Keeps the offset to the source from stroke to stroke; otherwise every stroke \
                        begins at the source";
            give(
                check(ui, "Aligned", hint, aligned)
                    .map(|aligned| BrushMode::Clone { aligned, picture }),
            );
            let hint = "Copies from the whole picture, not from the layer alone";
            give(
                check(ui, "From the picture", hint, picture)
                    .map(|picture| BrushMode::Clone { aligned, picture }),
            );
        }
    }
    let document = session.shown_document();
    let has_surface = document.is_none_or(|document| document.surface.is_some());
    if has_surface && session.tools.operator != Operator::None {
        let hint = "How far from the pen a bent mark may land, in diameters; 0 is anywhere. The \
                    outline under the pointer shows it";
        let spread = NumberField::new("Spread", 0.0..=20.0, hint).decimals(1);
        let spread = spread.inline(ui, session.tools.brush.reach, 60.0);
        requests.actions.extend(spread.map(|c| Action::Hand(HandAction::Reach { to: c.to })));
    }
    if document.is_some_and(|document| !document.parts.is_empty()) {
        let hint = "A stroke that begins on a part of the shape stays on it";
        let on = check(ui, "This part only", hint, !session.tools.crosses_parts);
        let across = on.map(|on| Action::Hand(HandAction::AcrossParts { on: !on }));
        requests.actions.extend(across);
    }
}

/// Where the brush may paint, one choice below the other.
pub fn limits(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let mut bounded = session.tools.brush.bounded;
    for (choice, label) in BOUNDS {
        radio(ui, &mut bounded, choice, sentence(label));
    }
    if bounded != session.tools.brush.bounded {
        requests.act(Action::Hand(HandAction::Bounded { bounded }));
    }
}
