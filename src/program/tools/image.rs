//! The image tool: where the selected image lies before it is bent.
//! Floor 5. Its anchors are `anchors`'.

use super::{Begun, Context, Gesture, Outcome, Pen};
use crate::document::{Content, Document, LayerId, Live, Lock};
use crate::math::Vec2;
use crate::paint::{PlacedImage, Placement};

pub fn press(context: &Context, pen: Pen) -> Begun {
    let layer = context.layer.and_then(|id| context.document.layer(id)).filter(|layer| layer.lock != Lock::All);
    let Some((layer, Content::Image(live))) = layer.map(|layer| (layer, &layer.content)) else {
        return (None, Outcome::Idle);
    };
    let how = match pen.keys {
        keys if keys.shift => How::Scale,
        keys if keys.ctrl => How::Turn,
        _ => How::Move,
    };
    let image = live.params().clone();
    let placement = image.placement;
    let (document, layer) = (context.document.clone(), layer.id);
    (Some(Box::new(Placing { document, layer, image, placement, how, from: pen.place(), moved: false })), Outcome::Idle)
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum How {
    Move,
    Scale,
    Turn,
}

struct Placing {
    document: Document,
    layer: LayerId,
    image: PlacedImage,
    /// Before the drag.
    placement: Placement,
    how: How,
    from: Vec2,
    moved: bool,
}

impl Placing {
    fn with(&self) -> Option<Document> {
        let content = Content::Image(Live::new(self.image.clone()));
        self.document.with_layer(self.layer, |layer| layer.content = content)
    }
}

impl Gesture for Placing {
    fn drag(&mut self, pens: &[Pen]) -> Outcome {
        let Some(pen) = pens.last() else { return Outcome::Idle };
        self.image.placement = placed(self.placement, self.how, self.from, pen.place());
        self.moved = true;
        self.with().map_or(Outcome::Idle, Outcome::Preview)
    }
    fn release(&mut self) -> Outcome {
        let label = match self.how {
            How::Move => "Move image",
            How::Scale => "Scale image",
            How::Turn => "Turn image",
        };
        match self.with() {
            Some(document) if self.moved => Outcome::Commit { label: label.into(), document, select: None },
            _ => Outcome::Cancel,
        }
    }
}

/// A placement dragged from one point to another.
fn placed(placement: Placement, how: How, from: Vec2, to: Vec2) -> Placement {
    let (before, after) = (from - placement.center, to - placement.center);
    match how {
        How::Move => Placement { center: placement.center + to - from, ..placement },
        How::Scale => {
            let factor = after.length() / before.length().max(1.0);
            Placement { scale: (placement.scale * factor).clamp(0.01, 100.0), ..placement }
        }
        // Counter-clockwise as seen is clockwise in y-down coordinates.
        How::Turn => {
            let turn = (before.to_angle() - after.to_angle()).to_degrees();
            Placement { rotation: (placement.rotation + turn + 540.0).rem_euclid(360.0) - 180.0, ..placement }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;

    #[test]
    fn a_drag_moves_scales_or_turns_about_the_centre() {
        let start = Placement { center: vec2(50.0, 50.0), scale: 1.0, rotation: 10.0 };
        let moved = placed(start, How::Move, vec2(10.0, 10.0), vec2(15.0, 30.0));
        assert_eq!(moved.center, vec2(55.0, 70.0));
        assert_eq!(placed(start, How::Scale, vec2(60.0, 50.0), vec2(50.0, 70.0)).scale, 2.0);
        let turned = placed(start, How::Turn, vec2(60.0, 50.0), vec2(50.0, 40.0));
        assert!((turned.rotation - 100.0).abs() < 1e-3, "upward is a quarter turn as seen: {}", turned.rotation);
    }
}
