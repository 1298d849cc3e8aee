//! The operators that the bar and the Paint menu offer, and whose operator they change.
//! Floor 7.

use crate::document::Content;
use crate::requests::UiRequests;
use crate::session::actions::{HandAction, LayerAction};
use crate::session::{Action, LayerPath, Property, Session};
use crate::surface::Operator;
use crate::tools::ToolKind;
use crate::widgets::ValueChange;

/// The operators as the tool bar offers them, each with the numbers it begins with.
pub const OPERATORS: [(&str, Operator, &str); 4] = [
    ("Flat", Operator::None, "Marks lie on the canvas as they are"),
    ("Texture", Operator::Depth { gamma: 1.0 }, "Marks follow the depth, like a print on the surface"),
    (
        "Shading",
        Operator::Normal { alpha: 0.5, beta: 1.5, detail: 0.0 },
        "Marks follow the normals, like shading and highlights: mirror for α above 0, glass below",
    ),
    (
        "Reflection",
        Operator::Reflection { alpha: 1.0, detail: 0.0 },
        "Marks follow the mirrored view, like an image in polished metal",
    ),
];

/// Whose operator the bar shows: the selected image's or gradient's with the tools that change it, else the hand's.
pub enum OperatorOwner {
    Hand,
    Layer(LayerPath),
}

pub fn whose(session: &Session) -> (OperatorOwner, Operator) {
    let of_layer = matches!(session.tool, ToolKind::Image | ToolKind::Anchors | ToolKind::Move | ToolKind::Gradient);
    let operator = session.layer().filter(|_| of_layer).and_then(|layer| match &layer.content {
        Content::Image(live) => Some(live.params().bend.operator),
        Content::Gradient(live) => Some(live.params().operator),
        _ => None,
    });
    match (operator, session.layer_path()) {
        (Some(operator), Some(path)) => (OperatorOwner::Layer(path), operator),
        _ => (OperatorOwner::Hand, session.operator),
    }
}

/// The bar shows this operator, whatever its numbers.
pub fn has(session: &Session, operator: Operator) -> bool {
    std::mem::discriminant(&whose(session).1) == std::mem::discriminant(&operator)
}

/// Another operator for what the bar shows.
pub fn give(session: &Session, requests: &mut UiRequests, operator: Operator) {
    set(requests, &whose(session).0, ValueChange { to: operator, done: true });
}

pub fn set(requests: &mut UiRequests, whose: &OperatorOwner, operator: ValueChange<Operator>) {
    let ValueChange { to, done } = operator;
    requests.act(match whose {
        OperatorOwner::Hand => Action::Hand(HandAction::Operator { operator: to }),
        OperatorOwner::Layer(layer) => {
            Action::Layer(LayerAction::Set { layer: layer.clone(), to: Property::Bend { operator: to }, done })
        }
    });
}
