//! An image or a gradient on the unwrapped sheet: moved, scaled and turned on one piece of the
//! surface alone. Floor 5. Not here: what a piece does to its picture (`surface::unwrap`).

use crate::document::{Content, Document, LayerId, Live};
use crate::math::{Mat2, Rect, Vec2, vec2};
use crate::paint::{Gradient, PlacedImage};
use crate::surface::plane_piece::PlanePiece;
use crate::surface::unwrap::metric::turn;
use crate::surface::unwrap::{LaidPiece, PlaneLayout};
use crate::surface::{Bend, Deformation, Surface};
use crate::tools::{
    GRAB_PT, Gesture, GestureStart, ModifierKeys, Outcome, PenSample, ToolContext, closed,
};

/// What a drag does to the picture on a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PieceDrag {
    /// It is moved.
    Move,
    /// It is scaled about what is under its middle.
    Scale,
    /// It is turned about that.
    Turn,
}

/// The handles of a piece, px of the sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PieceGizmo {
    /// Those that scale, clockwise from the upper left.
    pub corners: [Vec2; 4],
    /// The one that turns.
    pub knob: Vec2,
}

/// The distance of the knob above its piece, screen pt.
const KNOB_PT: f32 = 22.0;
/// Pieces smaller than this have no gizmo, px.
const LEAST_PX: usize = 24;

impl PieceGizmo {
    /// `None` for a fragment.
    pub fn of(piece: &LaidPiece, px_per_pt: f32) -> Option<Self> {
        let Rect { x0, y0, x1, y1 } = piece.rect;
        let [x0, y0, x1, y1] = [x0, y0, x1, y1].map(|v| v as f32);
        (piece.rect.width().min(piece.rect.height()) >= LEAST_PX).then(|| Self {
            corners: [vec2(x0, y0), vec2(x1, y0), vec2(x1, y1), vec2(x0, y1)],
            knob: vec2(0.5 * (x0 + x1), y0 - KNOB_PT * px_per_pt),
        })
    }
}

/// The piece that the pen grabs, by a handle or on it, and what a drag does there.
pub fn grab_piece(
    layout: &PlaneLayout,
    at: Vec2,
    px_per_pt: f32,
    keys: ModifierKeys,
) -> Option<(LaidPiece, PieceDrag)> {
    let is_near = |handle: Vec2| handle.distance(at) <= GRAB_PT * px_per_pt;
    let by_handle = |piece: &LaidPiece| {
        let gizmo = PieceGizmo::of(piece, px_per_pt)?;
        let how = match gizmo.corners.into_iter().any(is_near) {
            true => PieceDrag::Scale,
            false if is_near(gizmo.knob) => PieceDrag::Turn,
            false => return None,
        };
        Some((*piece, how))
    };
    let inside = |piece: &&LaidPiece| piece.rect.contains(at.x.floor() as i32, at.y.floor() as i32);
    let how = match keys {
        keys if keys.shift => PieceDrag::Scale,
        keys if keys.ctrl => PieceDrag::Turn,
        _ => PieceDrag::Move,
    };
    let pieces = layout.pieces();
    pieces
        .iter()
        .find_map(by_handle)
        .or_else(|| pieces.iter().find(inside).map(|piece| (*piece, how)))
}

/// How content that can be moved on one piece is bent.
pub fn bend_on_pieces(content: &Content) -> Option<Bend> {
    match content {
        Content::Image(live) => Some(live.params().bend.clone()),
        Content::Gradient(live) => Some(live.params().bend()),
        _ => None,
    }
}

/// The same content, its picture moved on these pieces; other content as it is.
fn with_pieces(content: &Content, pieces: Vec<PlanePiece>) -> Content {
    match content {
        Content::Image(live) => {
            let image = live.params().clone();
            Content::Image(Live::new(PlacedImage { bend: Bend { pieces, ..image.bend }, ..image }))
        }
        Content::Gradient(live) => {
            Content::Gradient(Live::new(Gradient { pieces, ..live.params().clone() }))
        }
        other => other.clone(),
    }
}

/// The pen comes down on the sheet with the image or the gradient tool; `pen` is on the sheet.
pub fn press(context: &ToolContext, pen: PenSample, layout: &PlaneLayout) -> GestureStart {
    let layer = context.layer.and_then(|id| context.document.layer(id));
    if let Some(why) = layer.and_then(|layer| closed::why_locked(layer)) {
        return (None, Outcome::Refused(why.into()));
    }
    let Some((layer, mut bend)) =
        layer.and_then(|layer| Some((layer, bend_on_pieces(&layer.content)?)))
    else {
        return (
            None,
            Outcome::Refused(
                "Select an image or a gradient to move, scale and turn it on one piece".into(),
            ),
        );
    };
    if bend.operator.unwrapping().is_none() {
        return (
            None,
            Outcome::Refused("Only what is bent by Wrap can be moved on one piece".into()),
        );
    }
    let Some(surface) = context.document.surface.clone() else { return (None, Outcome::Idle) };
    let Some((piece, how)) = grab_piece(layout, pen.place(), context.px_per_pt, pen.keys) else {
        return (None, Outcome::Idle);
    };
    let known =
        bend.pieces.iter().position(|known| layout.object_at(&surface, known.at) == piece.object);
    let index = known.unwrap_or_else(|| {
        bend.pieces.push(PlanePiece::at(layout.middle_of(&surface, &piece)));
        bend.pieces.len() - 1
    });
    let before = bend.pieces[index];
    let plane_from_sheet = plane_from_sheet(context.document, &surface, &bend, layout, before.at);
    let middle = layout.sheet_at(&surface, before.at).unwrap_or(pen.place());
    let pivot = middle + plane_from_sheet.inverse() * before.moved;
    let (document, layer, content, from) =
        (context.document.clone(), layer.id, layer.content.clone(), pen.place());
    let pieces = bend.pieces;
    let drag = PieceGesture {
        document,
        layer,
        content,
        pieces,
        index,
        before,
        how,
        from,
        pivot,
        plane_from_sheet,
        moved: false,
    };
    (Some(Box::new(drag)), Outcome::Idle)
}

/// How a layer's plane is turned and scaled relative to the sheet, about a point of the canvas,
/// before its pieces are moved: the ends of a gradient scale its plane.
fn plane_from_sheet(
    document: &Document,
    surface: &Surface,
    bend: &Bend,
    layout: &PlaneLayout,
    at: Vec2,
) -> Mat2 {
    let (x, y) = surface.pixel_of(at);
    let still = Bend { pieces: Vec::new(), ..bend.clone() };
    let plane = Deformation::new(Some(surface), document.size, &still).jacobian(x as i32, y as i32);
    let sheet = layout.jacobian(surface, x, y);
    let scale = (plane.determinant() / sheet.determinant()).abs().sqrt();
    // A ramp between two ends at one place has no scale.
    let scale = if scale.is_finite() && scale > 1e-6 { scale } else { 1.0 };
    turn(plane, sheet) * scale
}

struct PieceGesture {
    document: Document,
    layer: LayerId,
    /// Before the drag.
    content: Content,
    pieces: Vec<PlanePiece>,
    index: usize,
    /// Before the drag.
    before: PlanePiece,
    how: PieceDrag,
    from: Vec2,
    /// The point that the picture is turned and scaled about, px of the sheet.
    pivot: Vec2,
    plane_from_sheet: Mat2,
    moved: bool,
}

impl PieceGesture {
    fn with(&self) -> Option<Document> {
        let content = with_pieces(&self.content, self.pieces.clone());
        self.document.with_layer(self.layer, |layer| layer.content = content)
    }

    fn piece_at(&self, to: Vec2) -> PlanePiece {
        let (before, after) = (self.from - self.pivot, to - self.pivot);
        match self.how {
            PieceDrag::Move => {
                let moved = self.before.moved + self.plane_from_sheet * (to - self.from);
                PlanePiece { moved, ..self.before }
            }
            PieceDrag::Scale => {
                let scale = self.before.scale * after.length() / before.length().max(1.0);
                let scale = scale.max(*PlanePiece::SCALE.start()).min(*PlanePiece::SCALE.end());
                PlanePiece { scale, ..self.before }
            }
            // Counter-clockwise as seen is clockwise in y-down coordinates.
            PieceDrag::Turn => {
                let turn = (before.to_angle() - after.to_angle()).to_degrees();
                let rotation = (self.before.rotation + turn + 540.0).rem_euclid(360.0) - 180.0;
                PlanePiece { rotation, ..self.before }
            }
        }
    }
}

impl Gesture for PieceGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last() else { return Outcome::Idle };
        self.pieces[self.index] = self.piece_at(pen.place());
        self.moved = true;
        self.with().map_or(Outcome::Idle, Outcome::Preview)
    }

    fn release(&mut self) -> Outcome {
        let label = match self.how {
            PieceDrag::Move => "Move piece",
            PieceDrag::Scale => "Scale piece",
            PieceDrag::Turn => "Turn piece",
        };
        match self.with() {
            Some(document) if self.moved => {
                Outcome::Commit { label: label.into(), document, select: None }
            }
            _ => Outcome::Cancel,
        }
    }
}

#[cfg(test)]
mod tests;
