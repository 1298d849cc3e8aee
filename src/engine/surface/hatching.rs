//! Hatching: lines that follow the form, equally far apart on the surface, in nested levels, so that
//! tone decides only which are drawn and how wide. Floor 2. Here: what is asked of them, their
//! levels, and the cache. `directions` holds the field that they follow, `guided` spreads drawn
//! strokes over it, `streamlines` places them, `bridges` joins
//! them over gaps, `placed` finds those nearby, `stipples` places points
//! in their stead, `room` measures how densely they lie. Not here: tone, and strokes along them
//! (`paint::form_drawing`).

mod bridges;
mod directions;
mod guided;
mod placed;
mod room;
mod stipples;
mod streamlines;
mod stretch;

#[cfg(test)]
mod tests;

use super::Surface;
use super::cache::HeapSize;
use crate::math::number_settings::number_settings;
use crate::math::{Vec2, Vec3};
use directions::DirectionField;
pub use guided::GuideLines;
use std::sync::Arc;
use streamlines::Streamlines;

crate::named! {
    /// How tone becomes lines.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
    pub enum HatchStyle {
        /// One family, then a second across it in the shade.
        #[default]
        Crosshatch = "crosshatch" => ("Crosshatching", "A second family of lines crosses the first in the shade"),
        /// One family, denser in the shade.
        Hatch = "hatch" => ("Hatching", "One family of lines, denser in the shade"),
        /// One family whose width alone carries the tone.
        Engraving = "engraving" => ("Engraving", "One family of lines, whose width alone carries the tone"),
        /// Points, more and larger ones in the shade.
        Stipple = "stipple" => ("Stippling", "Points, more and larger ones in the shade"),
    }
}

crate::named! {
    /// Which way lines of the first family go.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
    pub enum HatchWay {
        /// Around the form: where it bends most.
        #[default]
        Around = "around" => ("Around the form", "Where the form bends most"),
        /// Along the form: where it bends least.
        Along = "along" => ("Along the form", "Where the form bends least"),
        /// Down the slope, as rain would run.
        Slope = "slope" => ("Down the slope", "Toward the outline, as rain would run"),
        /// At one angle in the plane that the form unwraps to.
        Wires = "wires" => ("Like wires", "Straight on the unwrapped form, as wires around it"),
        /// At one angle on the paper.
        Paper = "paper" => ("On the paper", "At one angle, whatever the form"),
        /// Along strokes that are drawn on another layer.
        Guides = "guides" =>
            ("Along my strokes", "Along the strokes of a stroke layer; pieces without one: around the form"),
    }
}

crate::named! {
    /// What says how dark hatching is.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
    pub enum HatchTone {
        /// A light of its own on the form.
        #[default]
        Light = "light" => ("Its own light", "A light on the form, with shadows and hollows"),
        /// The picture beneath.
        Beneath = "beneath" => ("What lies beneath", "How dark the picture beneath is"),
        /// One layer, shown or hidden.
        Layer = "layer" => ("One layer", "How dark a layer or group is, shown or hidden"),
    }
}

number_settings! {
    /// What is asked of hatching. Lengths are canvas px.
    pub struct HatchSettings {
        /// The distance between the lines of the widest level, px on the surface.
        spacing: "Lines apart", "The distance between the first lines, px on the surface", 2.0..=200.0, 9.0, px;
        /// The angle of the first family, degrees counter-clockwise; on the form, from its way.
        angle: "Angle", "How far lines are turned, degrees", -180.0..=180.0, 0.0;
        /// σ: forms smaller than this turn no line, px.
        smooth: "Smallest form", "Forms smaller than this turn no line, px", 0.5..=50.0, 3.0, px;
        /// How far directions spread over what has none, px.
        spread: "Even out", "How far directions spread over what has none, px", 0.0..=200.0, 25.0, px;
        /// How dark the tone is.
        darkness: "Darkness", "How dark the darkest tone is", 0.0..=1.0, 0.9;
        /// Tones lighter than this stay paper.
        paper: "Paper shows from", "Lighter tones stay paper", 0.05..=1.0, 0.85;
        /// How dark cast shadows are.
        shadow: "Cast shadows", "How dark cast shadows are", 0.0..=1.0, 0.7;
        /// How dark hollows are.
        hollows: "Hollows", "How dark hollows are", 0.0..=1.0, 0.5;
        and
        /// How tone becomes lines.
        style: HatchStyle = HatchStyle::Crosshatch;
        /// Which way lines go.
        way: HatchWay = HatchWay::Around;
        /// What says how dark it is.
        tone: HatchTone = HatchTone::Light;
        /// Toward the light, camera space (y up), any length.
        light: Vec3 = Vec3::new(-0.5, 0.6, 0.62);
    }
}

impl HatchSettings {
    /// The same on a canvas `factor` times as large.
    pub fn scaled(&self, factor: f32) -> Self {
        let mut next = *self;
        for setting in Self::lengths() {
            setting.put(&mut next, (setting.get)(self) * factor);
        }
        next
    }

    /// The levels, the first drawn first.
    pub fn levels(&self) -> &'static [HatchLevel] {
        const fn level(apart: f32, family: u8, share: f32) -> HatchLevel {
            HatchLevel { apart, family, share }
        }
        const CROSSHATCH: &[HatchLevel] =
            &[level(1.0, 0, 0.2), level(0.5, 0, 0.24), level(0.55, 1, 0.5), level(0.28, 0, 1.0)];
        const HATCH: &[HatchLevel] = &[level(1.0, 0, 0.2), level(0.5, 0, 0.4), level(0.25, 0, 1.0)];
        const ENGRAVING: &[HatchLevel] = &[level(0.5, 0, 1.0)];
        const STIPPLE: &[HatchLevel] = &[
            level(1.0, 0, 1.0),
            level(0.8, 0, 1.0),
            level(0.64, 0, 1.0),
            level(0.512, 0, 1.0),
            level(0.41, 0, 1.0),
            level(0.328, 0, 1.0),
        ];
        match self.style {
            HatchStyle::Stipple => STIPPLE,
            HatchStyle::Crosshatch => CROSSHATCH,
            HatchStyle::Hatch => HATCH,
            HatchStyle::Engraving => ENGRAVING,
        }
    }

    /// What the lines of each level cover where the tone is so dark, `[0, 1]`: together they cover
    /// `dark`. Lines of a family lie beside each other, so that what they cover adds up, but for
    /// their soft edges, which overlap the more the closer they lie; of what the other family
    /// covers, they cover their share once more.
    pub fn coverages(&self, dark: f32) -> impl Iterator<Item = f32> {
        let mut covered = [0.0f32; 2];
        let overlap = (OVERLAP_PX / self.spacing.max(1.0)).min(1.0);
        self.levels().iter().map(move |level| {
            let (own, other) = (usize::from(level.family), usize::from(1 - level.family));
            let free = (1.0 - dark).max(0.0) / (1.0 - covered[other]).max(1e-6);
            let gain = 1.0 - overlap * covered[own];
            let share = ((1.0 - free - covered[own]).max(0.0) / gain).min(level.share);
            covered[own] += share * gain;
            share
        })
    }

    /// The area of a point of stippling where the tone is so dark, of what each point has for itself
    /// among all levels. One level after the other is drawn, its points up to the size of those
    /// before; where all are drawn, all grow on and run into each other.
    pub fn stipple_area(&self, dark: f32, level: usize) -> f32 {
        let levels = self.levels();
        // As many points lie that far apart, of all.
        let share = |level: &HatchLevel| (levels[levels.len() - 1].apart / level.apart).powi(2);
        if dark > STIPPLED_UP_TO {
            return overlapping_area(dark);
        }
        let before = if level == 0 { 0.0 } else { share(&levels[level - 1]) };
        let own = share(&levels[level]) - before;
        (dark - before * STIPPLED_UP_TO).max(0.0).min(own * STIPPLED_UP_TO) / own
    }

    fn key(&self, guides: &GuideLines) -> HatchKey {
        let own = [self.spacing, self.angle, self.smooth, self.spread].map(f32::to_bits);
        let guides = if self.way == HatchWay::Guides { guides.clone() } else { GuideLines::none() };
        HatchKey { style: self.style, way: self.way, bits: own, guides }
    }
}

/// Of what lines of a family cover that lies beside lines of an earlier level, this is covered
/// already: so many px of their spacing, as measured.
const OVERLAP_PX: f32 = 4.5;

/// How dark stippling is when all of its points are drawn, just before they meet.
const STIPPLED_UP_TO: f32 = 0.45;

/// What discs at such points cover together, and the area of each, of what it has for itself, as
/// measured; between them straight lines.
const OVERLAPPING: [(f32, f32); 12] = [
    (STIPPLED_UP_TO, STIPPLED_UP_TO),
    (0.529, 0.55),
    (0.575, 0.6),
    (0.659, 0.7),
    (0.734, 0.8),
    (0.792, 0.9),
    (0.841, 1.0),
    (0.882, 1.1),
    (0.915, 1.2),
    (0.96, 1.4),
    (0.983, 1.6),
    (1.0, 2.2),
];

/// The area of points that cover so much though they overlap, of what each has for itself.
fn overlapping_area(dark: f32) -> f32 {
    let all = &OVERLAPPING;
    let i = all.iter().position(|(covered, _)| *covered >= dark).unwrap_or(all.len() - 1).max(1);
    let ((c0, a0), (c1, a1)) = (all[i - 1], all[i]);
    a0 + (a1 - a0) * ((dark - c0) / (c1 - c0)).max(0.0).min(1.0)
}

/// The longest taper of a line, in distances of its level: where fine lines end side by side, longer
/// ones would leave a hole.
pub const TAPER_OF_ROOM: f32 = 1.5;

/// One of the nested levels of lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HatchLevel {
    /// The distance between its lines and those of the levels before, of the widest spacing.
    pub apart: f32,
    /// 0, or 1 across it.
    pub family: u8,
    /// The most that its lines cover.
    pub share: f32,
}

/// What tells the lines of a surface from others.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::surface) struct HatchKey {
    style: HatchStyle,
    way: HatchWay,
    bits: [u32; 4],
    guides: GuideLines,
}

/// A point of a hatching line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HatchPoint {
    /// Canvas px.
    pub at: Vec2,
    /// How wide the strip of the picture is that the line has for itself among those of its level;
    /// of a single point, the side of the square that it has among all. px.
    pub room_px: f32,
}

/// A line of one level.
#[derive(Clone, Debug, PartialEq)]
pub struct HatchLine {
    /// Its level, from 0 on.
    pub level: u8,
    /// Its points, a pixel apart; a single one in stippling.
    pub points: Vec<HatchPoint>,
}

/// All lines of a surface, level by level.
#[derive(Debug, Default, PartialEq)]
pub struct HatchLines {
    /// In the order in which they were placed.
    pub lines: Vec<HatchLine>,
}

impl HeapSize for HatchLines {
    fn heap_bytes(&self) -> u64 {
        let points = |line: &HatchLine| line.points.len() * size_of::<HatchPoint>();
        let lines = self.lines.iter().map(|line| size_of::<HatchLine>() + points(line));
        lines.sum::<usize>() as u64
    }
}

impl HatchLines {
    fn of(surface: &Surface, settings: &HatchSettings, guides: &GuideLines) -> Self {
        let normals = surface.smooth_normals(settings.smooth);
        if settings.style == HatchStyle::Stipple {
            return Self { lines: stipples::place_points(surface, &normals, settings) };
        }
        let field = DirectionField::of(surface, &normals, settings, guides);
        let levels = settings.levels();
        // Lines of two families do not keep each other at a distance.
        let family = |family: u8| {
            let mut lines = Streamlines::new(surface, &field, family);
            for (i, level) in levels.iter().enumerate().filter(|(_, l)| l.family == family) {
                lines.fill(i as u8, (level.apart * settings.spacing).max(1.2));
            }
            lines.into_lines()
        };
        let (first, second) = rayon::join(|| family(0), || family(1));
        let mut all: Vec<(u8, Vec<Vec2>)> = first.into_iter().chain(second).collect();
        // The order of placing within a level stays.
        all.sort_by_key(|(level, _)| *level);
        Self { lines: room::measure_room(surface, all, settings) }
    }
}

impl Surface {
    /// The hatching lines of the surface, cached: tone is no part of them.
    ///
    /// * `guides`: what they follow if their way is [`HatchWay::Guides`].
    pub fn hatch_lines(&self, settings: &HatchSettings, guides: &GuideLines) -> Arc<HatchLines> {
        const KEPT: usize = 3;
        let compute = |_| HatchLines::of(self, settings, guides);
        self.derived.hatch_lines.get_or_compute(settings.key(guides), KEPT, compute)
    }
}
