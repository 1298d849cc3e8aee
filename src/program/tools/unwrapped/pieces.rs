//! An image on the unwrapped sheet: moved, scaled and turned on one piece of the surface alone. Floor 5. Not here:
//! what a piece does to its picture (`surface::unwrap`).

use crate::document::{Content, Document, LayerId, LayerLock, Live};
use crate::math::{Mat2, Rect, Vec2, vec2};
use crate::paint::PlacedImage;
use crate::surface::plane_piece::PlanePiece;
use crate::surface::unwrap::metric::turn;
use crate::surface::unwrap::{LaidPiece, PlaneLayout};
use crate::surface::{Bend, Deformation, Surface};
use crate::tools::{GRAB_PT, Gesture, GestureStart, ModifierKeys, Outcome, PenSample, ToolContext};

/// What a drag does to the picture on a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PieceDrag {
    Move,
    Scale,
    Turn,
}

/// The handles of a piece, px of the sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PieceFrame {
    /// Those that scale, clockwise from the upper left.
    pub corners: [Vec2; 4],
    /// The one that turns.
    pub knob: Vec2,
}

/// The distance of the knob above its piece, screen pt.
const KNOB_PT: f32 = 22.0;
/// Pieces smaller than this have no frame, px.
const LEAST_PX: usize = 24;

impl PieceFrame {
    /// `None` for a crumb.
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
pub fn held(layout: &PlaneLayout, at: Vec2, px_per_pt: f32, keys: ModifierKeys) -> Option<(LaidPiece, PieceDrag)> {
    let is_near = |handle: Vec2| handle.distance(at) <= GRAB_PT * px_per_pt;
    let by_handle = |piece: &LaidPiece| {
        let frame = PieceFrame::of(piece, px_per_pt)?;
        let how = match frame.corners.into_iter().any(is_near) {
            true => PieceDrag::Scale,
            false if is_near(frame.knob) => PieceDrag::Turn,
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
    pieces.iter().find_map(by_handle).or_else(|| pieces.iter().find(inside).map(|piece| (*piece, how)))
}

/// The pen comes down on the sheet with the image tool; `pen` is on the sheet.
pub fn press(context: &ToolContext, pen: PenSample, layout: &PlaneLayout) -> GestureStart {
    let layer = context.layer.and_then(|id| context.document.layer(id)).filter(|layer| layer.lock != LayerLock::All);
    let Some((layer, Content::Image(live))) = layer.map(|layer| (layer, &layer.content)) else {
        return (None, Outcome::Refused("Select an image layer to move, scale and turn it on one piece"));
    };
    let image = live.params();
    if image.bend.operator.unwrapping().is_none() {
        return (None, Outcome::Refused("Only an image bent by Texture can be moved on one piece"));
    }
    let Some(surface) = context.document.surface.clone() else { return (None, Outcome::Idle) };
    let Some((piece, how)) = held(layout, pen.place(), context.px_per_pt, pen.keys) else {
        return (None, Outcome::Idle);
    };
    let mut image = image.clone();
    let known = image.bend.pieces.iter().position(|known| layout.object_at(&surface, known.at) == piece.object);
    let index = known.unwrap_or_else(|| {
        image.bend.pieces.push(PlanePiece::at(layout.middle_of(&surface, &piece)));
        image.bend.pieces.len() - 1
    });
    let before = image.bend.pieces[index];
    let plane_from_sheet = plane_from_sheet(context.document, &surface, &image.bend, layout, before.at);
    let middle = layout.sheet_at(&surface, before.at).unwrap_or(pen.place());
    let pivot = middle + plane_from_sheet.transpose() * before.moved;
    let (document, layer, from) = (context.document.clone(), layer.id, pen.place());
    let drag = PieceGesture { document, layer, image, index, before, how, from, pivot, plane_from_sheet, moved: false };
    (Some(Box::new(drag)), Outcome::Idle)
}

/// How an image's plane is turned relative to the sheet, about a point of the canvas, before its pieces are moved.
fn plane_from_sheet(document: &Document, surface: &Surface, bend: &Bend, layout: &PlaneLayout, at: Vec2) -> Mat2 {
    let (x, y) = surface.pixel_of(at);
    let still = Bend { pieces: Vec::new(), ..bend.clone() };
    let plane = Deformation::new(Some(surface), document.size, &still).jacobian(x as i32, y as i32);
    turn(plane, layout.jacobian(surface, x, y))
}

struct PieceGesture {
    document: Document,
    layer: LayerId,
    image: PlacedImage,
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
        let content = Content::Image(Live::new(self.image.clone()));
        self.document.with_layer(self.layer, |layer| layer.content = content)
    }
    fn dragged(&self, to: Vec2) -> PlanePiece {
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
        self.image.bend.pieces[self.index] = self.dragged(pen.place());
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
            Some(document) if self.moved => Outcome::Commit { label: label.into(), document, select: None },
            _ => Outcome::Cancel,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{document, laid};
    use super::*;
    use crate::document::Layer;
    use crate::math::Affine2;
    use crate::paint::{Adjust, Brush, ImageFilter, PictureSource, Placement};
    use crate::raster::{Outside, Picture};
    use crate::surface::{Anchor, Operator};
    use crate::tools::ToolKind;
    use std::sync::Arc;

    /// The cylinder and the board, with a picture on both, whose plane is turned on the cylinder by its anchors.
    fn painted() -> Document {
        let document = document();
        let surface = document.surface.clone().unwrap();
        let plain = laid(&document);
        let [a, b] = [vec2(80.5, 40.5), vec2(120.5, 40.5)];
        let [u, v] = [a, b].map(|q| plain.sheet_at(&surface, q).unwrap());
        let pins = [Anchor { at: a, source: u }, Anchor { at: b, source: u + (v - u).perp() }];
        let picture = Picture::srgb8(document.size, vec![[9; 4]; document.size.area()]).unwrap();
        let image = PlacedImage {
            source: PictureSource::new("p.png".into(), picture, Adjust::default()),
            placement: Placement::covering(document.size),
            outside: Outside::Repeat,
            bend: Bend {
                operator: Operator::Surface { amount: 1.0, smooth: 0.0 },
                anchors: pins.to_vec(),
                ..Bend::default()
            },
            filter: ImageFilter::Antialias,
            frame: Default::default(),
        };
        Document { layers: vec![Arc::new(Layer::new("print", Content::Image(Live::new(image))))], ..document }
    }
    fn shown_at(document: &Document, q: Vec2) -> Vec2 {
        let Content::Image(live) = &document.layers[0].content else { panic!("an image") };
        let surface = document.surface.as_deref();
        Deformation::new(surface, document.size, &live.params().bend).at(q.x as i32, q.y as i32)
    }
    /// The drawing after a drag from the sheet's point of a canvas point to another, or by some px.
    fn dragged(document: &Document, keys: ModifierKeys, from: Vec2, to: Vec2) -> Document {
        let brush = Brush::default();
        let context = ToolContext { layer: Some(document.layers[0].id), ..ToolContext::new(document, &brush) };
        let pen = PenSample { keys, ..PenSample::at(from) };
        let (gesture, _) = super::super::point(&context, pen, laid(document), ToolKind::Image);
        let mut gesture = gesture.expect("a piece is held");
        gesture.drag(&[PenSample { keys, ..PenSample::at(to) }]);
        let Outcome::Commit { document, .. } = gesture.release() else { panic!("a step") };
        document
    }

    #[test]
    fn a_drag_on_the_sheet_takes_the_picture_of_one_piece_along() {
        let before = painted();
        let layout = laid(&before);
        let surface = before.surface.clone().unwrap();
        let on_sheet = |x: f32, y: f32| layout.sheet_at(&surface, vec2(x, y)).unwrap();
        let (from, to) = (on_sheet(90.5, 60.5), on_sheet(110.5, 75.5));
        let after = dragged(&before, ModifierKeys::default(), from, to);
        let (was, is) = (shown_at(&before, vec2(90.5, 60.5)), shown_at(&after, vec2(110.5, 75.5)));
        assert!(was.distance(is) < 0.05, "what was under the pen is under it: {was} and {is}");
        let board = vec2(250.5, 60.5);
        assert_eq!(shown_at(&before, board), shown_at(&after, board));
    }
    #[test]
    fn handles_scale_and_turn_about_the_middle_of_the_piece() {
        let before = painted();
        let layout = laid(&before);
        let surface = before.surface.clone().unwrap();
        let piece = layout.pieces()[0];
        let middle = layout.middle_of(&surface, &piece);
        let pivot = layout.sheet_at(&surface, middle).unwrap();
        let frame = PieceFrame::of(&piece, 1.0).unwrap();
        let larger =
            dragged(&before, ModifierKeys::default(), frame.corners[0], pivot + (frame.corners[0] - pivot) * 2.0);
        let away = |document: &Document, q: Vec2| shown_at(document, q) - shown_at(document, middle);
        let beside = middle + vec2(20.0, 10.0);
        assert!(away(&larger, beside).distance(0.5 * away(&before, beside)) < 0.1, "twice as large");
        let turn = Affine2::from_translation(pivot) * Affine2::from_angle(-0.5) * Affine2::from_translation(-pivot);
        let turned = dragged(&before, ModifierKeys::default(), frame.knob, turn.transform_point2(frame.knob));
        let Content::Image(live) = &turned.layers[0].content else { panic!("an image") };
        assert!((live.params().bend.pieces[0].rotation - 0.5f32.to_degrees()).abs() < 0.1, "counter-clockwise");
        assert!((away(&turned, beside).length() / away(&before, beside).length() - 1.0).abs() < 1e-3);
        // A second drag continues from the first.
        let twice =
            dragged(&turned, ModifierKeys { ctrl: true, ..Default::default() }, pivot + Vec2::X, pivot + Vec2::Y);
        let Content::Image(live) = &twice.layers[0].content else { panic!("an image") };
        assert_eq!(live.params().bend.pieces.len(), 1);
    }
    #[test]
    fn other_layers_and_operators_are_refused_in_a_sentence() {
        let flat = document();
        let brush = Brush::default();
        let outcome = |document: &Document| {
            let layer = document.layers.first().map(|layer| layer.id);
            press(
                &ToolContext { layer, ..ToolContext::new(document, &brush) },
                PenSample::at(vec2(60.0, 60.0)),
                &laid(document),
            )
            .1
        };
        assert!(matches!(outcome(&flat), Outcome::Refused(_)));
        let painted = painted();
        let Content::Image(live) = &painted.layers[0].content else { panic!("an image") };
        let mut image = live.params().clone();
        image.bend.operator = Operator::Depth { gamma: 1.0 };
        let bent = painted.with_layer(painted.layers[0].id, |layer| layer.content = Content::Image(Live::new(image)));
        assert!(matches!(outcome(&bent.unwrap()), Outcome::Refused(_)));
    }
}
