//! What the brush does where it lands: paint, smudge, blur, clone; and how far it may go.
//! Floor 7.

use super::fill::BOUNDS;
use crate::asked::Asked;
use crate::paint::Mark;
use crate::session::actions::HandAction;
use crate::session::{Action, Session};
use crate::widgets::{Number, check, choice};
use eframe::egui::Ui;

/// The marks by their kinds.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Paint,
    Smudge,
    Blur,
    Clone,
}

const KINDS: [(Kind, &str); 4] =
    [(Kind::Paint, "paint"), (Kind::Smudge, "smudge"), (Kind::Blur, "blur"), (Kind::Clone, "clone")];

/// In a bar.
pub fn options(ui: &mut Ui, session: &Session, asked: &mut Asked) {
    let mark = session.brush.mark;
    let mut give = |mark: Option<Mark>| asked.actions.extend(mark.map(|mark| Action::Hand(HandAction::Mark { mark })));
    let kind = match mark {
        Mark::Paint => Kind::Paint,
        Mark::Smudge { .. } => Kind::Smudge,
        Mark::Blur { .. } => Kind::Blur,
        Mark::Clone { .. } => Kind::Clone,
    };
    give(choice(ui, "Mark", kind, &KINDS).map(|kind| match kind {
        Kind::Paint => Mark::Paint,
        Kind::Smudge => Mark::Smudge { length: Mark::SMUDGE_LENGTH },
        Kind::Blur => Mark::Blur { width: Mark::BLUR_WIDTH },
        Kind::Clone => Mark::Clone { aligned: true, picture: false },
    }));
    match mark {
        Mark::Paint => {}
        Mark::Smudge { length } => {
            let number = Number::new("Length", 0.0..=1.0, "How much of the paint is left after a drag of one radius");
            give(number.inline(ui, length, 60.0).map(|c| Mark::Smudge { length: c.to }));
        }
        Mark::Blur { width } => {
            let number = Number::new("Width", 0.0..=1.0, "How soft a stroke leaves an edge, as a share of the radius");
            give(number.inline(ui, width, 60.0).map(|c| Mark::Blur { width: c.to }));
        }
        Mark::Clone { aligned, picture } => {
            let hint = "Keep the distance to the source from stroke to stroke; else every stroke begins at the source";
            give(check(ui, "Aligned", hint, aligned).map(|aligned| Mark::Clone { aligned, picture }));
            let hint = "Copy what the picture shows, not the layer alone";
            give(check(ui, "From the picture", hint, picture).map(|picture| Mark::Clone { aligned, picture }));
        }
    }
    let bounded = choice(ui, "Brush where", session.brush.bounded, &BOUNDS);
    asked.actions.extend(bounded.map(|bounded| Action::Hand(HandAction::Bounded { bounded })));
}
