//! Guides under the pen: pulled out of a ruler, dragged over the canvas, and removed by dragging
//! off it. Floor 5.

use super::snap::{SnapLines, SnapTargets};
use super::{Gesture, GestureStart, Outcome, PenSample};
use crate::document::{Document, Guides};
use crate::math::Vec2;
use std::sync::Arc;

/// One of the guides of a document.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GuideAt {
    /// Whether it is an upright one.
    pub is_vertical: bool,
    /// Its number among those.
    pub index: usize,
}

/// The nearest guide within a distance in px of a point.
pub fn guide_at(guides: &Guides, at: Vec2, near_px: f32) -> Option<GuideAt> {
    let of = |lines: &[f32], place: f32, is_vertical: bool| {
        let all = lines
            .iter()
            .enumerate()
            .map(move |(index, line)| ((line - place).abs(), GuideAt { is_vertical, index }));
        all.min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let both = [of(&guides.vertical, at.x, true), of(&guides.horizontal, at.y, false)];
    let near = both.into_iter().flatten().filter(|(far, _)| *far <= near_px);
    near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, guide)| guide)
}

/// Grabs a guide.
pub fn hold(document: &Document, guide: GuideAt, targets: SnapTargets) -> GestureStart {
    let mut rest = Guides::clone(&document.guides);
    let lines = if guide.is_vertical { &mut rest.vertical } else { &mut rest.horizontal };
    if guide.index >= lines.len() {
        return (None, Outcome::Idle);
    }
    lines.remove(guide.index);
    (
        Some(Box::new(GuideGesture::new(document, rest, guide.is_vertical, targets, true))),
        Outcome::Idle,
    )
}

/// A new guide that follows the pen.
pub fn pull(
    document: &Document,
    is_vertical: bool,
    targets: SnapTargets,
    pen: PenSample,
) -> GestureStart {
    if document.guides.vertical.len().max(document.guides.horizontal.len()) >= Guides::MOST {
        return (None, Outcome::Refused("The document has the maximum number of guides.".into()));
    }
    let rest = Guides::clone(&document.guides);
    let mut gesture = GuideGesture::new(document, rest, is_vertical, targets, false);
    let outcome = gesture.drag(&[pen]);
    (Some(Box::new(gesture)), outcome)
}

struct GuideGesture {
    document: Document,
    /// All others.
    rest: Guides,
    is_vertical: bool,
    targets: SnapTargets,
    /// Whether it existed before.
    is_old: bool,
    /// Where it is; `None` beyond the canvas.
    at: Option<f32>,
    has_moved: bool,
    lines: SnapLines,
}

impl GuideGesture {
    fn new(
        document: &Document,
        rest: Guides,
        is_vertical: bool,
        targets: SnapTargets,
        is_old: bool,
    ) -> Self {
        let (document, lines) = (document.clone(), SnapLines::default());
        Self { document, rest, is_vertical, targets, is_old, at: None, has_moved: false, lines }
    }

    fn with(&self) -> Document {
        let mut guides = self.rest.clone();
        if let Some(at) = self.at {
            if self.is_vertical { guides.vertical.push(at) } else { guides.horizontal.push(at) }
        }
        Document { guides: Arc::new(guides), ..self.document.clone() }
    }
}

impl Gesture for GuideGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last().filter(|pen| pen.place().is_finite()) else {
            return Outcome::Idle;
        };
        self.has_moved = true;
        let found = self.targets.point(pen.place());
        let axis = usize::from(!self.is_vertical);
        let (at, most) = (found.at[axis], 2.0 * self.document.size.center()[axis]);
        // At whole pixels if it snaps to nothing.
        let has_snapped = if self.is_vertical { found.lines.x } else { found.lines.y }.is_some();
        let at = if has_snapped { at } else { at.round() };
        self.at = (0.0..=most).contains(&at).then_some(at);
        self.lines = match self.is_vertical {
            true => SnapLines { y: None, ..found.lines },
            false => SnapLines { x: None, ..found.lines },
        };
        Outcome::Preview(self.with())
    }

    fn release(&mut self) -> Outcome {
        let label = match (self.is_old, self.at) {
            (true, _) if !self.has_moved => return Outcome::Cancel,
            (true, None) => "Remove guide",
            (true, Some(_)) => "Move guide",
            (false, None) => return Outcome::Cancel,
            (false, Some(_)) => "Add guide",
        };
        Outcome::Commit { label: label.into(), document: self.with(), select: None }
    }

    fn snap_lines(&self) -> SnapLines {
        self.lines
    }

    fn is_guide(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, vec2};
    use crate::tools::snap::ViewAids;

    fn document() -> Document {
        let guides = Arc::new(Guides { vertical: vec![40.0, 90.0], horizontal: vec![33.5] });
        Document { guides, ..Document::empty(Size::new(200, 100)) }
    }

    fn dragged(start: GestureStart, to: Vec2) -> Option<(String, Guides)> {
        let mut gesture = start.0?;
        gesture.drag(&[PenSample::at(to)]);
        match gesture.release() {
            Outcome::Commit { label, document, .. } => {
                Some((label, Guides::clone(&document.guides)))
            }
            _ => None,
        }
    }

    fn targets() -> SnapTargets {
        SnapTargets::of(
            &document(),
            &ViewAids { to_guides: false, ..ViewAids::default() },
            &[],
            1.0,
        )
    }

    #[test]
    fn the_nearest_guide_is_held() {
        let guides = document().guides;
        assert_eq!(
            guide_at(&guides, vec2(43.0, 80.0), 4.0),
            Some(GuideAt { is_vertical: true, index: 0 })
        );
        assert_eq!(
            guide_at(&guides, vec2(87.0, 34.0), 4.0),
            Some(GuideAt { is_vertical: false, index: 0 })
        );
        assert_eq!(guide_at(&guides, vec2(60.0, 60.0), 4.0), None);
        assert_eq!(guide_at(&Guides::default(), Vec2::NAN, 4.0), None);
    }

    #[test]
    fn guides_are_pulled_out_moved_and_taken_away() {
        let document = document();
        let new =
            dragged(pull(&document, true, targets(), PenSample::at(Vec2::ZERO)), vec2(60.4, 9.0))
                .unwrap();
        assert_eq!((new.0.as_str(), &new.1.vertical[..]), ("Add guide", &[40.0, 90.0, 60.0][..]));
        let held = GuideAt { is_vertical: true, index: 0 };
        let moved = dragged(hold(&document, held, targets()), vec2(105.0, 3.0)).unwrap();
        assert_eq!(
            (moved.0.as_str(), &moved.1.vertical[..]),
            ("Move guide", &[90.0, 100.0][..]),
            "to the middle"
        );
        let gone = dragged(hold(&document, held, targets()), vec2(-40.0, 3.0)).unwrap();
        assert_eq!((gone.0.as_str(), gone.1.vertical.len()), ("Remove guide", 1));
        assert!(
            dragged(pull(&document, false, targets(), PenSample::at(Vec2::ZERO)), vec2(9.0, -30.0))
                .is_none()
        );
        let lost = GuideAt { is_vertical: false, index: 7 };
        assert!(hold(&document, lost, targets()).0.is_none());
    }
}
