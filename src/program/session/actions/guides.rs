//! Setting, pulling out and clearing guides and assistants; what snaps to them and which are shown.
//! Floor 6. Not here: moving guides on the canvas with the pen (`tools::guides`).

use crate::document::{Assistant, AssistantKind, Document, Guides};
use crate::math::UNIT;
use crate::math::range::clamp_to_range;
use crate::session::Session;
use crate::session::replay::{actions, names, record};
use crate::tools::PenSample;
use crate::tools::guides::pull;
use crate::tools::snap::{CanvasGrid, SnapTargets, ViewAids};
use std::sync::Arc;

names!(AssistantKind);
record!(CanvasGrid { spacing, subdivisions, offset });
record!(ViewAids {
    rulers,
    guides,
    locked,
    grid_shown,
    grid,
    snaps,
    to_guides,
    to_grid,
    to_canvas,
    to_layers,
    magnetism,
    assistant,
});
record!(Guides { vertical, horizontal });
record!(Assistant { kind, points });

actions! {
    GuideAction {
        /// Out of a ruler; drags and a release of the pointer follow, and released beyond the
        /// canvas it is dropped.
        "pull" Pull { vertical: bool, pen: PenSample, px_per_pt: f32 }
        /// All of them.
        "set" Set { guides: Guides }
        "clear" Clear {}
        "assistants" Assistants { assistants: Vec<Assistant> }
        /// What is shown and what the pen snaps to; not a step.
        "aids" Aids { aids: ViewAids }
    }
}

impl GuideAction {
    /// Performs it.
    pub fn apply(&self, session: &mut Session) {
        session.drop_gesture();
        match self {
            GuideAction::Aids { aids } => {
                session.tools.aids = ViewAids {
                    grid: aids.grid.clamp_to_ranges(),
                    magnetism: clamp_to_range(aids.magnetism, &UNIT),
                    ..*aids
                };
            }
            GuideAction::Pull { vertical, pen, px_per_pt } => {
                // A guide that is pulled out becomes visible.
                session.tools.aids.guides = true;
                let Some(open) = session.active() else {
                    return session.say("There is no document.");
                };
                let aids = ViewAids { to_guides: false, ..session.tools.aids };
                let targets = SnapTargets::of(open.document(), &aids, &[], *px_per_pt);
                let start = pull(open.document(), *vertical, targets, *pen);
                super::pointer::begin(session, start);
            }
            GuideAction::Set { guides } => commit(session, "Guides", |document| Document {
                guides: Arc::new(guides.clone()),
                ..document
            }),
            GuideAction::Clear {} => {
                let is_empty =
                    session.active().is_none_or(|open| open.document().guides.is_empty());
                if is_empty {
                    return session.say("There are no guides.");
                }
                commit(session, "Clear guides", |document| Document {
                    guides: Arc::default(),
                    ..document
                });
            }
            GuideAction::Assistants { assistants } if assistants.is_empty() => {
                let is_empty =
                    session.active().is_none_or(|open| open.document().assistants.is_empty());
                if is_empty {
                    return session.say("There are no assistants.");
                }
                commit(session, "Clear assistants", |document| Document {
                    assistants: Arc::default(),
                    ..document
                });
            }
            GuideAction::Assistants { assistants } => commit(session, "Assistants", |document| {
                Document { assistants: Arc::new(assistants.clone()), ..document }
            }),
        }
    }
}

fn commit(session: &mut Session, label: &str, change: impl FnOnce(Document) -> Document) {
    if let Some(open) = session.active_mut() {
        let document = change(open.document().clone());
        open.commit(label, document);
    }
}
