//! The pivot of a gizmo between the pen coming down and lifting.
//! Floor 5.

use crate::math::{Vec2, vec2};
use crate::tools::gizmo::{MIDDLE, TransformGizmo};
use crate::tools::snap::{SNAP_PT, SnapLines, SnapTargets};
use crate::tools::{DocumentChoice, Gesture, Outcome, PenSample};

pub struct PivotGesture {
    pub gizmo: TransformGizmo,
    /// Guides and other lines; those of the gizmo itself come first.
    pub snap: SnapTargets,
    /// Whether it snaps to the gizmo.
    pub snaps: bool,
    pub px_per_pt: f32,
    pub lines: SnapLines,
}

/// Where a pivot snaps to, with its name in the window: the middle, the corners, the middles of the
/// sides.
pub const PIVOTS: [(Vec2, &str); 9] = [
    (vec2(0.0, 0.0), "upper left corner"),
    (vec2(0.5, 0.0), "middle above"),
    (vec2(1.0, 0.0), "upper right corner"),
    (vec2(0.0, 0.5), "middle at the left"),
    (MIDDLE, "middle"),
    (vec2(1.0, 0.5), "middle at the right"),
    (vec2(0.0, 1.0), "lower left corner"),
    (vec2(0.5, 1.0), "middle below"),
    (vec2(1.0, 1.0), "lower right corner"),
];

impl PivotGesture {
    fn share(&mut self, at: Vec2) -> Option<Vec2> {
        self.lines = SnapLines::default();
        let near = |share: &Vec2| self.gizmo.point(*share).distance(at);
        let nearest =
            PIVOTS.iter().map(|(share, _)| *share).min_by(|a, b| near(a).total_cmp(&near(b)));
        let own = nearest.filter(|share| self.snaps && near(share) <= SNAP_PT * self.px_per_pt);
        own.or_else(|| {
            let found = self.snap.point(at);
            self.lines = found.lines;
            self.gizmo.share_of(found.at)
        })
    }
}

impl Gesture for PivotGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let share = pens.last().and_then(|pen| self.share(pen.place()));
        share.map_or(Outcome::Idle, |share| Outcome::Choose(DocumentChoice::Pivot(share)))
    }

    fn release(&mut self) -> Outcome {
        Outcome::Idle
    }

    fn snap_lines(&self) -> SnapLines {
        self.lines
    }
}
