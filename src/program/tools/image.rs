//! The image tool: moves, scales and turns the selected image before it is bent. Floor 5. Not here:
//! anchors (`anchors`).

use super::{Gesture, GestureStart, Outcome, PenSample, ToolContext, closed};
use crate::document::{Content, Document, LayerId, Live};
use crate::math::Vec2;
use crate::paint::{PlacedImage, Placement};

/// The pen comes down with the tool.
pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    let layer = context.layer.and_then(|id| context.document.layer(id));
    let Some((layer, Content::Image(live))) = layer.map(|layer| (layer, &layer.content)) else {
        return (None, Outcome::Idle);
    };
    if let Some(why) = closed::why_locked(layer) {
        return (None, Outcome::Refused(why.into()));
    }
    let how = match pen.keys {
        keys if keys.shift => ImageDrag::Scale,
        keys if keys.ctrl => ImageDrag::Turn,
        _ => ImageDrag::Move,
    };
    let image = live.params().clone();
    let placement = image.placement;
    let (document, layer) = (context.document.clone(), layer.id);
    (
        Some(Box::new(ImageGesture {
            document,
            layer,
            image,
            placement,
            how,
            from: pen.place(),
            moved: false,
        })),
        Outcome::Idle,
    )
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ImageDrag {
    Move,
    Scale,
    Turn,
}

struct ImageGesture {
    document: Document,
    layer: LayerId,
    image: PlacedImage,
    /// Before the drag.
    placement: Placement,
    how: ImageDrag,
    from: Vec2,
    moved: bool,
}

impl ImageGesture {
    fn with(&self) -> Option<Document> {
        let content = Content::Image(Live::new(self.image.clone()));
        self.document.with_layer(self.layer, |layer| layer.content = content)
    }
}

impl Gesture for ImageGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last() else { return Outcome::Idle };
        self.image.placement = drag_placement(self.placement, self.how, self.from, pen.place());
        self.moved = true;
        self.with().map_or(Outcome::Idle, Outcome::Preview)
    }

    fn release(&mut self) -> Outcome {
        let label = match self.how {
            ImageDrag::Move => "Move image",
            ImageDrag::Scale => "Scale image",
            ImageDrag::Turn => "Turn image",
        };
        match self.with() {
            Some(document) if self.moved => {
                Outcome::Commit { label: label.into(), document, select: None }
            }
            _ => Outcome::Cancel,
        }
    }
}

/// A placement dragged from one point to another.
fn drag_placement(placement: Placement, how: ImageDrag, from: Vec2, to: Vec2) -> Placement {
    let (before, after) = (from - placement.center, to - placement.center);
    match how {
        ImageDrag::Move => Placement { center: placement.center + to - from, ..placement },
        ImageDrag::Scale => {
            let factor = after.length() / before.length().max(1.0);
            Placement { scale: (placement.scale * factor).clamp(0.01, 100.0), ..placement }
        }
        // Counter-clockwise as seen is clockwise in y-down coordinates.
        ImageDrag::Turn => {
            let turn = (before.to_angle() - after.to_angle()).to_degrees();
            Placement {
                rotation: (placement.rotation + turn + 540.0).rem_euclid(360.0) - 180.0,
                ..placement
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;

    #[test]
    fn a_drag_moves_scales_or_turns_about_the_center() {
        let start = Placement { center: vec2(50.0, 50.0), scale: 1.0, rotation: 10.0 };
        let moved = drag_placement(start, ImageDrag::Move, vec2(10.0, 10.0), vec2(15.0, 30.0));
        assert_eq!(moved.center, vec2(55.0, 70.0));
        assert_eq!(
            drag_placement(start, ImageDrag::Scale, vec2(60.0, 50.0), vec2(50.0, 70.0)).scale,
            2.0
        );
        let turned = drag_placement(start, ImageDrag::Turn, vec2(60.0, 50.0), vec2(50.0, 40.0));
        assert!(
            (turned.rotation - 100.0).abs() < 1e-3,
            "upward is a quarter turn as seen: {}",
            turned.rotation
        );
    }
}
