//! The shape tool: the part under the pen is selected and moved; handles around the selected one
//! scale, turn, puff and tilt it. Floor 5. Not here: numbers without a handle (the panel).

use super::map_about;
use crate::document::Document;
use crate::document::parts::{FormArea, Inflation, Part, PartKind};
use crate::math::range::clamp_to_range;
use crate::math::{Affine2, Mat2, Vec2, vec2};
use crate::shape::Bevel;
use crate::tools::{
    DocumentChoice, GRAB_PT, Gesture, GestureStart, Outcome, PenSample, ToolContext,
};
use std::sync::Arc;

/// The box around what a part covers, with its handles; canvas px.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartGizmo {
    /// The upper left corner.
    pub low: Vec2,
    /// The lower right corner.
    pub high: Vec2,
    /// Canvas px per screen point, by which handles within and above the box keep their distances
    /// on the screen.
    pub px_per_pt: f32,
    /// Whether it has a height to drag.
    pub has_puff: bool,
    /// Whether it is inflated, so that it has a profile and a rim.
    pub is_inflated: bool,
}

/// What the pen holds of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartHandle {
    /// Upper left, upper right, lower right, lower left: scales about the opposite corner.
    Corner(usize),
    /// Above the box: turns about its middle.
    Turn,
    /// In the middle: dragging up raises the part, dragging down lowers it.
    Puff,
    /// The ball below the middle: the part leans to the side of the drag.
    Tilt,
    /// Left of the middle: dragging to the right makes a pillow a tube.
    Profile,
    /// Right of the middle: dragging up turns the rim away, dragging down makes a low relief.
    Rim,
    /// Above the middle: dragging up brings the part nearer.
    Depth,
    /// All else of the part.
    Body,
}

/// The distance of the turning handle above the box, and of the handles around the middle from it,
/// points.
const TURN_PT: f32 = 26.0;
const AROUND_PT: f32 = 34.0;
/// A smaller box has no room for handles within, points.
const LEAST_BOX_PT: f32 = 84.0;
/// Points of a drag per degree of tilt.
const TILT_PT_A_DEGREE: f32 = 2.0;
/// Points of a drag from a pillow to a tube.
const PROFILE_PT: f32 = 120.0;
/// Points of a drag per degree of the rim.
const RIM_PT_A_DEGREE: f32 = 1.5;
/// Turns with Shift go in steps of this.
const STEP_DEGREES: f32 = 15.0;

impl PartHandle {
    /// The text shown while it is dragged: what it changes, and its value.
    pub fn describe(self, part: &Part) -> Option<String> {
        let inflation = match &part.kind {
            PartKind::Inflate { inflation, .. } => Some(*inflation),
            _ => None,
        };
        Some(match self {
            PartHandle::Puff => format!("Height {:.2}", height_of(&part.kind)?.0),
            PartHandle::Tilt => describe_tilt(part.tilt_deg),
            PartHandle::Profile => format!("Pillow – tube {:.2}", inflation?.profile),
            PartHandle::Rim => format!("Rim {:.0}°", inflation?.rim_deg),
            PartHandle::Depth => format!("Raise {:.0} px", part.raise),
            PartHandle::Corner(_) | PartHandle::Turn | PartHandle::Body => return None,
        })
    }
}

/// Where a part faces that leans by so many degrees, up toward the right and toward the bottom.
pub fn describe_tilt(tilt_deg: Vec2) -> String {
    let Vec2 { x, y } = tilt_deg;
    let (across, along) =
        (if x < 0.0 { "right" } else { "left" }, if y < 0.0 { "down" } else { "up" });
    format!("Face {across} {:.0}°, {along} {:.0}°", x.abs(), y.abs())
}

impl PartGizmo {
    /// For a part by what its form covers.
    pub fn of(part: &Part, area: &FormArea, px_per_pt: f32) -> Self {
        let (low, high) = area.covered_box();
        let is_inflated = matches!(part.kind, PartKind::Inflate { .. });
        Self { low, high, px_per_pt, has_puff: height_of(&part.kind).is_some(), is_inflated }
    }

    /// The same, seen through a map of the canvas.
    pub fn transformed(self, map: Affine2) -> Self {
        let corners = self.corners().map(|corner| map.transform_point2(corner));
        let low = corners.iter().fold(Vec2::MAX, |a, b| a.min(*b));
        let high = corners.iter().fold(Vec2::MIN, |a, b| a.max(*b));
        Self { low, high, ..self }
    }

    /// Upper left, upper right, lower right, lower left.
    pub fn corners(&self) -> [Vec2; 4] {
        [self.low, vec2(self.high.x, self.low.y), self.high, vec2(self.low.x, self.high.y)]
    }

    /// The middle of the box, the handle for the height.
    pub fn middle(&self) -> Vec2 {
        (self.low + self.high) * 0.5
    }

    /// The handle that turns the part.
    pub fn turn(&self) -> Vec2 {
        vec2(self.middle().x, self.low.y - TURN_PT * self.px_per_pt)
    }

    /// The place of the handle of the height, if the part has one and there is room.
    pub fn puff(&self) -> Option<Vec2> {
        (self.has_puff && self.has_room()).then(|| self.middle())
    }

    /// The handle that tilts it, if there is room.
    pub fn tilt(&self) -> Option<Vec2> {
        self.handle_beside_middle(vec2(0.0, 1.0))
    }

    /// The handle for its profile, if it is inflated.
    pub fn profile(&self) -> Option<Vec2> {
        self.handle_beside_middle(vec2(-1.0, 0.0)).filter(|_| self.is_inflated)
    }

    /// The handle for its rim, if it is inflated.
    pub fn rim(&self) -> Option<Vec2> {
        self.handle_beside_middle(vec2(1.0, 0.0)).filter(|_| self.is_inflated)
    }

    /// The handle for its depth, if there is room.
    pub fn depth(&self) -> Option<Vec2> {
        self.handle_beside_middle(vec2(0.0, -1.0))
    }

    /// Next to the middle, if there is room.
    fn handle_beside_middle(&self, way: Vec2) -> Option<Vec2> {
        self.has_room().then(|| self.middle() + way * (AROUND_PT * self.px_per_pt))
    }

    fn has_room(&self) -> bool {
        (self.high - self.low).min_element() >= LEAST_BOX_PT * self.px_per_pt
    }

    /// The handle at a canvas point.
    pub fn handle_at(&self, at: Vec2) -> Option<PartHandle> {
        let near = |p: Vec2| p.distance(at) <= GRAB_PT * self.px_per_pt;
        if let Some(corner) = self.corners().iter().position(|corner| near(*corner)) {
            return Some(PartHandle::Corner(corner));
        }
        let inner = [
            (Some(self.turn()), PartHandle::Turn),
            (self.puff(), PartHandle::Puff),
            (self.tilt(), PartHandle::Tilt),
            (self.profile(), PartHandle::Profile),
            (self.rim(), PartHandle::Rim),
            (self.depth(), PartHandle::Depth),
        ];
        inner.into_iter().find(|(p, _)| p.is_some_and(near)).map(|(_, handle)| handle)
    }
}

/// The number that is the height of a part, and how much of it a drag over half of the part's
/// smaller side changes.
fn height_of(kind: &PartKind) -> Option<(f32, f32)> {
    match kind {
        PartKind::Inflate { inflation, .. } => Some((inflation.puff, 1.0)),
        PartKind::Lathe { puff, .. } | PartKind::Sweep { puff, .. } => Some((*puff, 1.0)),
        PartKind::Bevel { bevel, .. } => Some((bevel.height, bevel.width)),
        _ => None,
    }
}

fn with_height(kind: &PartKind, to: f32) -> PartKind {
    let mut kind = kind.clone();
    match &mut kind {
        PartKind::Inflate { inflation, .. } => {
            inflation.puff = clamp_to_range(to, &Inflation::PUFF)
        }
        PartKind::Lathe { puff, .. } | PartKind::Sweep { puff, .. } => {
            *puff = clamp_to_range(to, &Inflation::PUFF)
        }
        PartKind::Bevel { bevel, .. } => bevel.height = clamp_to_range(to, &Bevel::HEIGHT),
        _ => {}
    }
    kind
}

/// The pen comes down with the tool.
pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    let document = context.document;
    let areas = document.part_areas();
    if areas.is_empty() {
        let why = "There is no part here. Make some (Layer, Give it a shape…), or add one in the \
                   panel Shape.";
        return (None, Outcome::Refused(why.into()));
    }
    let gizmo_of = |id: &str| {
        let (part, area) = areas.iter().find(|(part, _)| part.id == id)?;
        Some((part.clone(), PartGizmo::of(part, area, context.px_per_pt)))
    };
    let selected = context.part.and_then(gizmo_of);
    let on_handle =
        selected.and_then(|(part, gizmo)| Some((part, gizmo, gizmo.handle_at(pen.place())?)));
    let held = on_handle.or_else(|| {
        let part = crate::document::parts::forms::nearest_at(&areas, pen.place())?;
        let (part, gizmo) = gizmo_of(&part.id)?;
        Some((part, gizmo, PartHandle::Body))
    });
    let Some((part, gizmo, handle)) = held else { return (None, Outcome::Idle) };
    let selected = Outcome::Choose(DocumentChoice::Part(part.id.clone()));
    let gesture = PartGesture {
        document: document.clone(),
        part,
        gizmo,
        handle,
        from: pen.place(),
        found: None,
    };
    (Some(Box::new(gesture)), selected)
}

struct PartGesture {
    document: Document,
    /// Before the drag.
    part: Arc<Part>,
    gizmo: PartGizmo,
    handle: PartHandle,
    from: Vec2,
    /// As it was last dragged.
    found: Option<Part>,
}

/// An inflated part with other numbers.
fn with_inflation(part: &Part, to: impl Fn(Inflation) -> Inflation) -> Option<Part> {
    let PartKind::Inflate { outline, inflation } = &part.kind else { return None };
    let kind = PartKind::Inflate { outline: outline.clone(), inflation: to(*inflation) };
    Some(Part { kind, ..part.clone() })
}

impl PartGesture {
    /// Points of the screen in canvas px.
    fn pt(&self, points: f32) -> f32 {
        points * self.gizmo.px_per_pt.max(1e-6)
    }

    fn part_at(&self, pen: &PenSample) -> Option<Part> {
        let (to, part) = (pen.place(), &*self.part);
        let by = to - self.from;
        let mapped = |map: Affine2| {
            let matrix = map * part.matrix;
            let is_finite = matrix.is_finite()
                && matrix.to_cols_array().iter().all(|v| Part::MATRIX.contains(v));
            is_finite.then(|| Part { matrix, ..part.clone() })
        };
        match self.handle {
            PartHandle::Body => mapped(Affine2::from_translation(whole_px(by, pen.keys.shift))),
            PartHandle::Turn => {
                let middle = self.gizmo.middle();
                let (before, after) = (self.from - middle, to - middle);
                let degrees = (after.to_angle() - before.to_angle()).to_degrees();
                let step = |v: f32| (v / STEP_DEGREES).round() * STEP_DEGREES;
                let degrees = if pen.keys.shift { step(degrees) } else { degrees };
                mapped(map_about(middle, Mat2::from_angle(degrees.to_radians())))
            }
            PartHandle::Corner(corner) => {
                let corners = self.gizmo.corners();
                let fixed =
                    if pen.keys.alt { self.gizmo.middle() } else { corners[(corner + 2) % 4] };
                let way = corners[corner] - fixed;
                let scale = (to - fixed).dot(way) / way.length_squared().max(1.0);
                mapped(map_about(
                    fixed,
                    Mat2::from_diagonal(Vec2::splat(scale.max(0.02).min(50.0))),
                ))
            }
            PartHandle::Puff => {
                let (height, per_half) = height_of(&part.kind)?;
                let half = (0.5 * (self.gizmo.high - self.gizmo.low).min_element()).max(1.0);
                Some(Part {
                    kind: with_height(&part.kind, height - per_half * by.y / half),
                    ..part.clone()
                })
            }
            PartHandle::Profile => with_inflation(part, |now| {
                let profile = now.profile + by.x / self.pt(PROFILE_PT);
                Inflation {
                    profile: (clamp_to_range(profile, &Inflation::PROFILE) * 100.0).round() / 100.0,
                    ..now
                }
            }),
            PartHandle::Rim => with_inflation(part, |now| {
                let rim_deg = (now.rim_deg - by.y / self.pt(RIM_PT_A_DEGREE)).round();
                Inflation { rim_deg: clamp_to_range(rim_deg, &Inflation::RIM), ..now }
            }),
            // As the pen moves: a px of height for a px of the canvas.
            PartHandle::Depth => Some(Part {
                raise: clamp_to_range((part.raise - by.y).round(), &Part::RAISE),
                ..part.clone()
            }),
            PartHandle::Tilt => {
                // The part faces where the ball goes, so it falls there.
                let by = by / self.pt(TILT_PT_A_DEGREE);
                let tilt = (part.tilt_deg - by).round();
                let tilt_deg =
                    vec2(clamp_to_range(tilt.x, &Part::TILT), clamp_to_range(tilt.y, &Part::TILT));
                Some(Part { tilt_deg, ..part.clone() })
            }
        }
    }
}

/// By whole pixels, so that nothing is made again; with Shift along one axis.
fn whole_px(by: Vec2, along_axis: bool) -> Vec2 {
    match along_axis {
        true if by.x.abs() >= by.y.abs() => vec2(by.x, 0.0).round(),
        true => vec2(0.0, by.y).round(),
        false => by.round(),
    }
}

impl Gesture for PartGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(part) = pens.last().and_then(|pen| self.part_at(pen)) else {
            return Outcome::Idle;
        };
        self.found = Some(part.clone());
        Outcome::Preview(self.document.with_part_ahead(part))
    }

    fn release(&mut self) -> Outcome {
        let label = match self.handle {
            PartHandle::Body => "Move part",
            PartHandle::Corner(_) => "Scale part",
            PartHandle::Turn => "Turn part",
            PartHandle::Puff => "Puff part",
            PartHandle::Tilt => "Tilt part",
            PartHandle::Profile => "Pillow – tube",
            PartHandle::Rim => "Turn rim",
            PartHandle::Depth => "Raise part",
        };
        match self.found.take().filter(|found| *found != *self.part) {
            Some(part) => {
                let document = self.document.with_part(part);
                Outcome::Commit { label: label.into(), document, select: None }
            }
            None => Outcome::Cancel,
        }
    }
}
