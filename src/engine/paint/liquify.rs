//! Liquify: dabs that push, swell and twirl what a layer shows, as a displacement of the nodes
//! under them. Floor 3. Not here: what a displacement is (`raster::lattice`), how layers are seen
//! through it (`document::layer::warp`).

use super::Scene;
use crate::math::{COORDINATE, Mat2, PlaneMap, Range, Rect, UNIT, Vec2, vec2};
use crate::raster::{CoverageGrid, Lattice};
use crate::surface::Surface;
use crate::surface::objects::{ObjectId, Objects};
use std::sync::Arc;

crate::named! {
    /// What a dab does to the pixels under it.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
    pub enum LiquifyTool {
        /// Moves them with the pen.
        #[default]
        Push = "push" => ("push", "Drags what is under the pen (Ctrl restores)"),
        Grow = "grow" => ("grow", "Enlarges what is under the dab (Ctrl shrinks)"),
        Shrink = "shrink" => ("shrink", "Shrinks what is under the dab (Ctrl enlarges)"),
        TwirlLeft = "twirl left" => ("twirl left", "Turns what is under the dab counter-clockwise \
             (Ctrl: clockwise)"),
        TwirlRight = "twirl right" => ("twirl right", "Turns what is under the dab clockwise \
             (Ctrl: counter-clockwise)"),
        /// Evens out their displacement.
        Smooth = "smooth" => ("smooth", "Evens out the displacement (Shift with any tool)"),
        Restore = "restore" => ("restore", "Removes the displacement"),
    }
}

impl LiquifyTool {
    /// What does the same in a mirror.
    pub fn mirrored(self) -> Self {
        match self {
            LiquifyTool::TwirlLeft => LiquifyTool::TwirlRight,
            LiquifyTool::TwirlRight => LiquifyTool::TwirlLeft,
            tool => tool,
        }
    }
}

/// How a stroke of liquify works.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LiquifySettings {
    /// What it does.
    pub tool: LiquifyTool,
    /// Diameter of a dab, px.
    pub size: f32,
    /// In the middle of a dab; a push at 1 goes as far as the pen.
    pub strength: f32,
    /// Only the object under the first dab is displaced.
    pub one_object: bool,
    /// Dabs and their effect are measured along the surface.
    pub foreshortened: bool,
}

impl Default for LiquifySettings {
    fn default() -> Self {
        Self {
            tool: LiquifyTool::Push,
            size: 120.0,
            strength: 0.6,
            one_object: false,
            foreshortened: false,
        }
    }
}

impl LiquifySettings {
    /// What its diameter may be, px.
    pub const SIZE: Range = 8.0..=4000.0;
    /// What its strength may be.
    pub const STRENGTH: Range = UNIT;

    /// The same with numbers in range.
    pub fn clamp_to_ranges(&self) -> Self {
        let held = crate::math::range::clamp_to_range;
        Self {
            size: held(self.size, &Self::SIZE),
            strength: held(self.strength, &Self::STRENGTH),
            ..*self
        }
    }
}

/// A stroke of liquify while it is drawn: samples go in, the displacement follows.
pub struct LiquifyStroke {
    settings: LiquifySettings,
    scene: Scene,
    /// What is displaced; absent: everything.
    selection: Option<CoverageGrid>,
    /// The map from the displacement's frame to the canvas.
    to_canvas: PlaneMap,
    /// The object that it is limited to, if any.
    object: Option<(Arc<Objects>, ObjectId)>,
    last: Vec2,
    /// Canvas px since the last dab.
    gone: f32,
}

/// From one dab to the next, radii.
const SPACING: f32 = 0.1;
/// Radius of a dab in the frame of the displacement, px.
const MOST_RADIUS_PX: f32 = 4096.0;
/// How much a dab grows or shrinks its middle.
const SWELL: f32 = 0.06;
/// The angle by which a dab turns its middle, radians.
const TURN: f32 = 0.08;
/// A surface that is tilted more is measured as if it had this tilt.
const LEAST_FACING: f32 = 0.1;

impl LiquifyStroke {
    /// Begins at a point of the canvas.
    ///
    /// * `to_canvas`: the map from the frame of the displacement to the canvas.
    pub fn new(
        settings: LiquifySettings,
        scene: Scene,
        selection: Option<CoverageGrid>,
        to_canvas: PlaneMap,
        at: Vec2,
    ) -> Self {
        let surface = scene.surface.as_ref().filter(|_| settings.one_object);
        let object = surface.and_then(|surface| {
            let objects = surface.objects();
            objects.at(at.x.floor() as i32, at.y.floor() as i32).map(|object| (objects, object))
        });
        Self {
            settings: settings.clamp_to_ranges(),
            scene,
            selection,
            to_canvas,
            object,
            last: at,
            gone: 0.0,
        }
    }

    fn radius(&self) -> f32 {
        0.5 * self.settings.size
    }

    /// The first dab, unless it pushes.
    pub fn begin(&self, lattice: &mut Lattice, pressure: f32) {
        if self.settings.tool != LiquifyTool::Push {
            self.dab(lattice, self.last, Vec2::ZERO, pressure);
        }
    }

    /// Continues to a point of the canvas.
    pub fn draw_to(&mut self, lattice: &mut Lattice, at: Vec2, pressure: f32) {
        if !at.is_finite() || at.abs().max_element() > *COORDINATE.end() {
            return;
        }
        let spacing = (SPACING * self.radius()).max(1.0);
        let along = (at - self.last).normalize_or_zero();
        let mut left = self.last.distance(at) + self.gone;
        // The last dab was `gone` behind.
        let mut place = self.last - along * self.gone;
        // A jump across the picture must not become a push of a thousand dabs.
        let most = 4096;
        for _ in 0..most {
            if left < spacing {
                break;
            }
            place += along * spacing;
            left -= spacing;
            self.dab(lattice, place, along * spacing, pressure);
        }
        (self.last, self.gone) = (at, left.min(spacing));
    }

    /// One dab: the nodes under it take new displacements.
    ///
    /// * `step`: how far the pen moved since the last one, canvas px.
    fn dab(&self, lattice: &mut Lattice, at: Vec2, step: Vec2, pressure: f32) {
        let Some((center, back)) = self.to_canvas.from_canvas(at) else { return };
        let radius = self.radius() * back.determinant().abs().sqrt();
        // In a group that is scaled down to nearly nothing, a dab would hold endless nodes.
        if radius.is_nan()
            || radius > MOST_RADIUS_PX
            || center.abs().max_element() > *COORDINATE.end()
        {
            return;
        }
        let reach = radius + 1.0;
        let rect = Rect::new(
            (center.x - reach).floor() as i32,
            (center.y - reach).floor() as i32,
            (center.x + reach).ceil() as i32 + 1,
            (center.y + reach).ceil() as i32 + 1,
        );
        let strength = self.settings.strength * pressure.max(0.0).min(1.0);
        let step = back * step;
        let here = self.slope(at);
        lattice.change(rect, |old, q, u| {
            let offset = q - center;
            let seen = self.to_canvas.to_canvas(q).unwrap_or(q);
            let slope = self.slope(seen);
            let distance = offset.length() * stretch(slope, offset);
            let weight = strength * falloff(distance / radius) * self.share(seen);
            if weight <= 0.0 {
                return u;
            }
            let by = |v: Vec2| v + old.at(q + v).by;
            match self.settings.tool {
                LiquifyTool::Push => {
                    by(-step * (weight * stretch(here, step) / stretch(slope, step)).min(2.0))
                }
                LiquifyTool::Grow => by(-offset * (SWELL * weight / stretch(slope, offset))),
                LiquifyTool::Shrink => by(offset * (SWELL * weight / stretch(slope, offset))),
                LiquifyTool::TwirlLeft => by(turned(offset, TURN * weight, slope)),
                LiquifyTool::TwirlRight => by(turned(offset, -TURN * weight, slope)),
                LiquifyTool::Smooth => u + (mean(old, q) - u) * (0.5 * weight),
                LiquifyTool::Restore => restore(u, weight),
            }
        });
    }

    /// How much of a canvas point may be displaced.
    fn share(&self, p: Vec2) -> f32 {
        let (x, y) = (p.x.floor() as i32, p.y.floor() as i32);
        if self.object.as_ref().is_some_and(|(objects, object)| objects.at(x, y) != Some(*object)) {
            return 0.0;
        }
        self.selection.as_ref().map_or(1.0, |covered| f32::from(covered.at(x, y)) / 255.0)
    }

    /// How the depth of the surface changes along the axes; 0 if it is not needed.
    fn slope(&self, p: Vec2) -> Vec2 {
        let surface = self.scene.surface.as_ref().filter(|_| self.settings.foreshortened);
        surface.map_or(Vec2::ZERO, |surface| slope_of(surface, p))
    }
}

fn slope_of(surface: &Surface, p: Vec2) -> Vec2 {
    // Image axes: y down.
    surface.values_at(p).map_or(Vec2::ZERO, |at| at.nbar / at.nz.max(LEAST_FACING))
}

/// How much longer a direction is along a surface than as seen: √(1 + (s · d)²).
fn stretch(slope: Vec2, along: Vec2) -> f32 {
    (1.0 + slope.dot(along.normalize_or_zero()).powi(2)).sqrt()
}

/// 1 in the middle of a dab, 0 at its rim, smooth at both.
fn falloff(t: f32) -> f32 {
    // NaN is beyond the rim.
    if t < 1.0 { (1.0 - t * t).powi(2) } else { 0.0 }
}

/// From a point about the middle to the one that a turn counter-clockwise as seen brings there.
fn turned(offset: Vec2, by_rad: f32, slope: Vec2) -> Vec2 {
    // y points down: backward, that is a positive angle.
    (Mat2::from_angle(by_rad) * offset - offset) / stretch(slope, offset.perp())
}

/// The mean of the displacements around a node.
fn mean(lattice: &Lattice, q: Vec2) -> Vec2 {
    let cell = crate::raster::lattice::CELL as i32;
    let (i, j) = (q.x as i32 / cell, q.y as i32 / cell);
    let (i, j) = (i - i32::from(q.x < (i * cell) as f32), j - i32::from(q.y < (j * cell) as f32));
    let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy)));
    around.map(|(dx, dy)| lattice.node(i + dx, j + dy)).sum::<Vec2>() / 9.0
}

/// A displacement reduced by a ratio, at least by the smallest step that can be held, so that it
/// ends at 0.
fn restore(u: Vec2, share: f32) -> Vec2 {
    const LEAST_SHARE: f32 = 1.0 / 64.0;
    if share < LEAST_SHARE {
        return u;
    }
    let least = 1.0 / Lattice::PER_PX;
    let side = |v: f32| {
        let left = (v * (1.0 - share)).abs().min((v.abs() - least).max(0.0));
        left.copysign(v)
    };
    vec2(side(u.x), side(u.y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Size;

    fn scene() -> Scene {
        Scene { size: Size::new(400, 300), surface: None }
    }

    fn drawn(settings: LiquifySettings, lattice: &mut Lattice, way: &[Vec2]) {
        let mut stroke = LiquifyStroke::new(settings, scene(), None, PlaneMap::IDENTITY, way[0]);
        stroke.begin(lattice, 1.0);
        way[1..].iter().for_each(|at| stroke.draw_to(lattice, *at, 1.0));
    }

    fn of(tool: LiquifyTool) -> LiquifySettings {
        LiquifySettings { tool, size: 160.0, strength: 1.0, ..LiquifySettings::default() }
    }

    #[test]
    fn a_push_at_full_strength_takes_what_lay_under_the_pen_along() {
        let mut lattice = Lattice::default();
        drawn(of(LiquifyTool::Push), &mut lattice, &[vec2(200.0, 152.0), vec2(240.0, 152.0)]);
        // Where the pen ended shows what was where it began.
        let found = lattice.at(vec2(240.0, 152.0)).by;
        assert!((found - vec2(-40.0, 0.0)).length() < 2.0, "{found}");
        assert_eq!(lattice.at(vec2(200.0, 20.0)).by, Vec2::ZERO);
    }

    #[test]
    fn a_twirl_turns_its_middle_by_its_angle() {
        let mut lattice = Lattice::default();
        let center = vec2(200.0, 152.0);
        drawn(of(LiquifyTool::TwirlLeft), &mut lattice, &[center]);
        for offset in [vec2(16.0, 0.0), vec2(0.0, -24.0), vec2(24.0, 32.0)] {
            let angle = TURN * falloff(offset.length() / 80.0);
            let expected = Mat2::from_angle(angle) * offset - offset;
            let found = lattice.at(center + offset).by;
            assert!(
                (found - expected).length() <= 1.0 / Lattice::PER_PX,
                "{offset}: {found} {expected}"
            );
        }
        let mut back = Lattice::default();
        drawn(of(LiquifyTool::TwirlRight), &mut back, &[center]);
        let p = center + vec2(16.0, 8.0);
        let there = p + lattice.at(p).by;
        assert!((there + back.at(there).by - p).length() < 0.1, "one turn undoes the other");
    }

    #[test]
    fn what_was_pushed_can_be_restored_until_nothing_is_left() {
        let mut lattice = Lattice::default();
        drawn(of(LiquifyTool::Push), &mut lattice, &[vec2(180.0, 150.0), vec2(230.0, 170.0)]);
        assert!(!lattice.is_empty());
        let restore = LiquifySettings { size: 700.0, ..of(LiquifyTool::Restore) };
        for _ in 0..20 {
            drawn(restore, &mut lattice, &[vec2(150.0, 150.0), vec2(260.0, 150.0)]);
        }
        assert!(lattice.is_empty(), "{lattice:?}");
    }

    #[test]
    fn what_is_not_selected_stays() {
        let selected = CoverageGrid::full(Rect::new(0, 0, 200, 300));
        let mut lattice = Lattice::default();
        let settings = of(LiquifyTool::Grow);
        let mut stroke = LiquifyStroke::new(
            settings,
            scene(),
            Some(selected),
            PlaneMap::IDENTITY,
            vec2(200.0, 150.0),
        );
        stroke.begin(&mut lattice, 1.0);
        stroke.draw_to(&mut lattice, vec2(210.0, 150.0), 1.0);
        assert!(lattice.node(23, 19) != Vec2::ZERO && lattice.node(26, 19) == Vec2::ZERO);
    }

    #[test]
    fn a_direction_down_a_slope_is_longer_than_it_is_seen() {
        // At 60° a slope of √3: twice as long along it as seen, unchanged across it.
        let slope = vec2(3f32.sqrt(), 0.0);
        assert!((stretch(slope, vec2(5.0, 0.0)) - 2.0).abs() < 1e-6);
        assert!((stretch(slope, vec2(0.0, -3.0)) - 1.0).abs() < 1e-6);
        assert_eq!(stretch(slope, Vec2::ZERO), 1.0);
    }

    #[test]
    fn a_pen_without_a_place_changes_nothing() {
        let mut lattice = Lattice::default();
        let way = [vec2(200.0, 150.0), vec2(f32::NAN, 3.0), vec2(f32::INFINITY, 0.0)];
        drawn(of(LiquifyTool::Push), &mut lattice, &way);
        assert!(lattice.is_empty());
    }
}
