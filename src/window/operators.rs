//! The operators that the bar and the Paint menu offer, and whose operator they change.
//! Floor 7.

use crate::requests::UiRequests;
use crate::session::actions::{HandAction, LayerAction};
use crate::session::{Action, LayerPath, Property, Session};
use crate::surface::Operator;
use crate::tools::ToolKind;
use crate::widgets::ValueChange;

/// An operator as the window offers it.
pub struct OfferedOperator {
    pub label: &'static str,
    /// With its first numbers.
    pub begins: Operator,
    pub hint: &'static str,
}

/// The operators as the tool bar offers them.
pub const OPERATORS: [OfferedOperator; 5] = [FLAT, TEXTURE, DEPTH_TEXTURE, SHADING, REFLECTION];

pub const FLAT: OfferedOperator = OfferedOperator {
    label: "Flat",
    begins: Operator::None,
    hint: "Marks stay flat on the canvas, as in any painting program",
};
pub const TEXTURE: OfferedOperator = OfferedOperator {
    label: "Wrap",
    begins: Operator::Surface { amount: 1.0, smooth: 0.0 },
    hint: "Marks are wrapped around the surface like a print, at the same size everywhere (D_s)",
};
pub const DEPTH_TEXTURE: OfferedOperator = OfferedOperator {
    label: "Near and far",
    begins: Operator::Depth { gamma: 1.0 },
    hint: "Marks are larger where the surface is nearer than their anchor, smaller where it is farther (D_p)",
};
pub const SHADING: OfferedOperator = OfferedOperator {
    label: "Gloss",
    begins: Operator::Normal { alpha: 0.5, beta: 1.5, detail: 0.0 },
    hint: "Marks follow the directions of the surface, as highlights do: chrome for a \
           strength above 0, glass below (D_n)",
};
pub const REFLECTION: OfferedOperator = OfferedOperator {
    label: "True mirror",
    begins: Operator::Reflection { alpha: 1.0, detail: 0.0 },
    hint: "Marks follow the mirrored view, like an image in polished metal (D_r)",
};

/// What a number of an operator does, by its name in documents.
pub fn hint_of(key: &str) -> &'static str {
    match key {
        "alpha" => "A mirror above 0, flat at 0, glass below (α of the paper)",
        "beta" => {
            "How soon the bend reaches its full strength: 0 bends most at the edges of the form, \
             more bends its middle too (β of the paper)"
        }
        "detail" => "How much small bumps bend the image beyond the large form",
        "gamma" => "How strongly the image follows the depth (γ of the paper)",
        "amount" => {
            "How far the surface is unwrapped: 0 is flat, 1 as long as the surface is, 2 exaggerates it"
        }
        "smooth" => {
            "Blurs the shape beforehand, in pixels, so that fine relief does not shear the print"
        }
        _ => "",
    }
}

/// Whose operator the bar shows: the selected image's or gradient's with the tools that change it,
/// else the current one.
pub enum OperatorOwner {
    Hand,
    Layer(LayerPath),
}

pub fn whose(session: &Session) -> (OperatorOwner, Operator) {
    let of_layer = matches!(
        session.tool,
        ToolKind::Image
            | ToolKind::Text
            | ToolKind::Figure
            | ToolKind::Path
            | ToolKind::Anchors
            | ToolKind::Move
            | ToolKind::Gradient
    );
    let bent = session.layer().filter(|_| of_layer).and_then(|layer| layer.content.bend());
    let operator = bent.map(|bend| bend.operator);
    match (operator, session.layer_path()) {
        (Some(operator), Some(path)) => (OperatorOwner::Layer(path), operator),
        _ => (OperatorOwner::Hand, session.tools.operator),
    }
}

/// The bar shows this operator, whatever its numbers.
pub fn has_operator(session: &Session, operator: Operator) -> bool {
    whose(session).1.is_like(operator)
}

/// Another operator for what the bar shows.
pub fn give(session: &Session, requests: &mut UiRequests, operator: Operator) {
    set(requests, &whose(session).0, ValueChange { to: operator, done: true });
}

pub fn set(requests: &mut UiRequests, whose: &OperatorOwner, operator: ValueChange<Operator>) {
    let ValueChange { to, done } = operator;
    requests.act(match whose {
        OperatorOwner::Hand => Action::Hand(HandAction::Operator { operator: to }),
        OperatorOwner::Layer(layer) => Action::Layer(LayerAction::Set {
            layer: layer.clone().into(),
            to: Property::Bend { operator: to },
            done,
        }),
    });
}
