//! The rules for the dabs of a stroke: the brush, driven by the readings at each dab. Floor 3. Not
//! here: where they are placed (`walk`).

use super::stylus::{CurvePoint, gauss};
use super::{Dab, FAR_PX};
use crate::math::{Mat2, Rect, Vec2, hash, srgb::Color, vec2, vec3};
use crate::paint::brush::{Brush, Tip};
use crate::paint::brush_options::{Bearing, DistanceMetric, Spread};
use crate::paint::dynamics::{
    DabInputs, FAR_DIAMETERS, FAST_LENGTHS_PER_SEC, Input, Property, pace_of, turns_of,
};
use crate::paint::rim::{Rim, RimTable};
use crate::paint::scene::Scene;
use crate::paint::surface_metric::SurfaceMetric;
use crate::paint::tint;
use crate::surface::{Curvature, Operator};
use std::f32::consts::TAU;
use std::sync::Arc;

/// The smallest step between dabs. Below it neighboring dabs of any size do not differ by a byte.
pub(super) const MIN_STEP_PX: f32 = 0.1;
/// Dabs are on a grid as fine as f32 resolves positions on canvases of 4096 px.
const STEPS_PER_PX: f32 = 4096.0;
/// The smallest dab, a little wider than a pixel.
const PIXEL_RADIUS_PX: f32 = 0.75;
/// *s* of the κ that drives a brush: *L* over this. Relative, so that a larger canvas gives the
/// same picture.
const CURVATURE_SCALES: f32 = 32.0;
/// Blur of the normals under that κ: one pixel smooths the noise of 8-bit maps.
const CURVATURE_BLUR_PX: f32 = 1.0;
/// The longest tip, times its width.
const MOST_ELONGATION: f32 = 1.0 / *Tip::RATIO.start();

/// Readings that cost more than the others: they are computed only if something follows them.
const PEN: [Input; 5] =
    [Input::TiltDirection, Input::Direction, Input::Attack, Input::Pace, Input::SlowPace];

#[derive(Clone)]
pub(super) struct DabRules {
    pub brush: Brush,
    pub operator: Operator,
    pub color: Color,
    pub scene: Scene,
    /// The corner of the pixel in which the stroke begins: its positions are relative to it.
    pub origin: Option<Vec2>,
    /// Canvas from the frame that the stroke was drawn in.
    facing: Mat2,
    /// If something follows it.
    curvature: Option<Arc<Curvature>>,
    reads_surface: bool,
    /// Whether anything follows the readings of [`PEN`], which take arc tangents and logarithms.
    reads_pen: bool,
    /// If paths are measured on the surface.
    measured: Option<SurfaceMetric>,
    varies_in_color: bool,
    rims: Option<Arc<RimTable>>,
}

/// What the walk knows where a dab is due.
#[derive(Clone, Copy)]
pub(super) struct Moment {
    pub place: CurvePoint,
    /// Of the path; zero if there is none.
    pub direction: Vec2,
    pub traveled_px: f64,
    /// `[0, 1]`.
    pub cycle: f32,
    pub custom: f32,
    pub number: u32,
}

/// How densely dabs follow a dab.
#[derive(Clone, Copy)]
pub(super) struct Due {
    /// Along the tip's longer axis.
    per_px: f64,
    pub per_sec: f64,
    /// Canvas directions in the tip's frame, where its half-axes have equal lengths.
    tip: Mat2,
}

impl Due {
    pub const NEVER: Self = Self { per_px: 0.0, per_sec: 0.0, tip: Mat2::IDENTITY };

    /// Dabs per px of a path.
    pub fn per_px(&self, way: Vec2) -> f64 {
        if self.tip == Mat2::IDENTITY {
            return self.per_px;
        }
        let stretch = (self.tip * way.normalize_or_zero()).length();
        let densest = f64::from(1.0 / MIN_STEP_PX);
        (self.per_px * f64::from(stretch)).min(densest)
    }
}

impl DabRules {
    pub fn new(brush: &Brush, operator: Operator, color: Color, scene: &Scene) -> Self {
        let follows = |input| brush.dynamics.has_input(input);
        let measured = SurfaceMetric::of(scene, operator)
            .filter(|_| brush.spacing_on == DistanceMetric::Surface);
        let curvature = scene.surface.as_ref().filter(|_| follows(Input::Curvature));
        Self {
            brush: brush.clone(),
            operator,
            color,
            scene: scene.clone(),
            origin: None,
            facing: brush.facing.map(),
            curvature: curvature
                .map(|surface| surface.read_at(Vec2::ZERO).0.curvature(CURVATURE_BLUR_PX)),
            reads_pen: matches!(brush.tip, Tip::Hose(_)) || PEN.into_iter().any(follows),
            reads_surface: [Input::Slope, Input::Curvature, Input::Depth].into_iter().any(follows),
            measured,
            varies_in_color: tint::has_varied_color(brush),
            rims: RimTable::of(brush),
        }
    }

    /// The length of a px of a path on the surface, if it is measured there: |S d| of MATH 8,
    /// between pixels; 1 off it.
    ///
    /// * `at`: relative to where the stroke begins, like all positions here.
    pub fn stretch(&self, at: Vec2, way: Vec2) -> f64 {
        let Some(measured) = &self.measured else { return 1.0 };
        f64::from(measured.stretch(at + self.origin.unwrap_or_default(), way))
    }

    /// The number of parts in which a piece of the path is measured: of a px if the surface is
    /// read, else one.
    pub fn parts(&self, from: Vec2, to: Vec2) -> usize {
        /// A longer piece is measured coarsely.
        const MOST_PARTS: f32 = 4096.0;
        let origin = self.origin.unwrap_or_default();
        let (low, high) = ((from.min(to) + origin).floor(), (from.max(to) + origin).floor());
        let over = Rect::new(low.x as i32, low.y as i32, high.x as i32 + 1, high.y as i32 + 1);
        if self.measured.is_none() || over.intersect(self.scene.size.rect()).is_empty() {
            return 1;
        }
        from.distance(to).ceil().max(1.0).min(MOST_PARTS) as usize
    }

    pub fn inputs(&self, moment: &Moment) -> DabInputs {
        let Moment { place, traveled_px, cycle, custom, number, .. } = *moment;
        let unit = |v: f32| v.max(0.0).min(1.0);
        let inputs = DabInputs {
            pressure: place.pressure,
            tilt: unit(place.tilt.length() / 90.0),
            speed: unit(place.px_per_sec / (FAST_LENGTHS_PER_SEC * self.scene.size.longer_side())),
            distance: unit(traveled_px as f32 / (FAR_DIAMETERS * self.brush.size)),
            cycle,
            custom,
            seed: hash::mix(self.brush.seed ^ hash::mix(number.wrapping_add(0x9e37_79b9))),
            ..DabInputs::default()
        };
        let inputs = if self.reads_pen { self.of_pen(moment, inputs) } else { inputs };
        self.with_surface_values(self.on_canvas(place.at), inputs)
    }

    /// A position on the canvas.
    fn on_canvas(&self, at: Vec2) -> Vec2 {
        (at * STEPS_PER_PX).round() / STEPS_PER_PX + self.origin.unwrap_or_default()
    }

    /// With the readings of [`PEN`].
    fn of_pen(&self, moment: &Moment, inputs: DabInputs) -> DabInputs {
        let Moment { place, direction, .. } = *moment;
        let in_frame = |v: Vec2| self.facing.transpose() * v;
        let [pace, slow_pace] =
            place.paces.map(|px_per_sec| pace_of(px_per_sec / self.brush.stylus.pace_px));
        DabInputs {
            tilt_direction: turns_of(in_frame(place.tilt)),
            direction: turns_of(in_frame(direction)),
            attack: (turns_of(in_frame(leaning(&place))) - turns_of(in_frame(direction)))
                .rem_euclid(1.0),
            pace,
            slow_pace,
            ..inputs
        }
    }

    /// With the surface's values at a dab's center, between pixels.
    fn with_surface_values(&self, at: Vec2, inputs: DabInputs) -> DabInputs {
        let flat = DabInputs::default();
        let nowhere =
            DabInputs { slope: flat.slope, curvature: flat.curvature, depth: flat.depth, ..inputs };
        let Some(surface) = self.scene.surface.as_deref().filter(|_| self.reads_surface) else {
            return nowhere;
        };
        let (surface, at) = surface.read_at(at);
        if !surface.is_on(at) {
            return nowhere;
        }
        let scale_px = surface.size().longer_side() / CURVATURE_SCALES;
        let kappa =
            |x, y| self.curvature.as_ref().map_or(0.0, |curvature| curvature.kappa(x, y, scale_px));
        let read = |x, y| {
            let slope = 1.0 - surface.facing(x, y).max(0.0).min(1.0);
            vec3(slope, kappa(x, y), surface.depth(x, y))
        };
        let [slope, kappa, depth] = surface.interpolate(at, read).to_array();
        DabInputs { slope, curvature: 0.5 + 0.5 * kappa, depth: depth.max(0.0).min(1.0), ..inputs }
    }

    fn value(&self, property: Property, plain: f32, inputs: &DabInputs) -> f32 {
        self.brush.dynamics.value(property, plain, inputs)
    }

    fn diameter(&self, inputs: &DabInputs) -> f32 {
        self.value(Property::Size, self.brush.size, inputs)
    }

    /// What drives the custom input.
    pub fn custom(&self, inputs: &DabInputs) -> f32 {
        self.value(Property::Custom, 0.0, inputs).max(0.0).min(1.0)
    }

    /// How densely dabs follow one with these readings. A step that is not a number must not stop
    /// the walk.
    pub fn due(&self, inputs: &DabInputs) -> Due {
        let spacing = self.value(Property::Spacing, self.brush.spacing, inputs);
        let step = f64::from((spacing * self.diameter(inputs)).max(MIN_STEP_PX));
        let sane = |v: f32| if v.is_finite() && v > 0.0 { f64::from(v) } else { 0.0 };
        let beside = sane(self.brush.rate.per_diameter / self.brush.size);
        // A brush without other dabs keeps its exact step.
        let per_px = if beside > 0.0 {
            (1.0 / step + beside).min(1.0 / f64::from(MIN_STEP_PX))
        } else {
            1.0 / step
        };
        let ratio = self.ratio(inputs);
        let tip = if ratio < 1.0 {
            Mat2::from_diagonal(vec2(1.0, 1.0 / ratio))
                * Mat2::from_angle(self.rotation_rad(inputs))
        } else {
            Mat2::IDENTITY
        };
        Due { per_px, per_sec: sane(self.brush.rate.per_sec), tip }
    }

    /// The ratio of the tip's shorter side to its longer one.
    fn ratio(&self, inputs: &DabInputs) -> f32 {
        let plain = self.brush.ratio();
        if !self.brush.dynamics.is_driven(Property::Elongation) {
            return plain;
        }
        1.0 / self.value(Property::Elongation, 1.0 / plain, inputs).max(1.0).min(MOST_ELONGATION)
    }

    fn rotation_rad(&self, inputs: &DabInputs) -> f32 {
        let brush = &self.brush;
        let rotation_rad =
            if brush.rotation.is_finite() { brush.rotation.to_radians() } else { 0.0 };
        brush
            .facing
            .rotation_rad(rotation_rad + TAU * brush.dynamics.turns(Property::Rotation, inputs))
    }

    /// The position of a dab that is due at a point.
    fn stray_position(&self, moment: &Moment, inputs: &DabInputs) -> Vec2 {
        let at = moment.place.at;
        let away =
            self.scatter_offset(inputs) + self.offset(moment, inputs) + self.lead(moment, inputs);
        // Comparisons that NaN fails.
        if away.length() > 0.0 && away.length() <= FAR_PX { at + away } else { at }
    }

    fn scatter_offset(&self, inputs: &DabInputs) -> Vec2 {
        let ratio = self.value(Property::Scatter, self.brush.scatter, inputs).max(0.0);
        if ratio.is_nan() || ratio <= 0.0 {
            return Vec2::ZERO;
        }
        let away = match self.brush.spread {
            Spread::Disc => {
                let (turn, share) = (hash::unit(inputs.seed, 0, 3), hash::unit(inputs.seed, 1, 3));
                // The root distributes them uniformly over the disc.
                ratio * self.diameter(inputs) * share.sqrt() * Vec2::from_angle(TAU * turn)
            }
            Spread::Cloud => {
                ratio * self.brush.size * vec2(gauss(inputs.seed, 0), gauss(inputs.seed, 1))
            }
        };
        self.facing * away
    }

    fn offset(&self, moment: &Moment, inputs: &DabInputs) -> Vec2 {
        let offset = self.brush.offset;
        let amount = self.value(Property::Offset, offset.amount, inputs);
        if amount.is_nan() || amount == 0.0 {
            return Vec2::ZERO;
        }
        let side = if offset.alternates && moment.number % 2 == 1 { -1.0 } else { 1.0 };
        let from = match offset.from {
            Bearing::Canvas => Vec2::X,
            Bearing::Stroke => self.facing.transpose() * moment.direction.normalize_or(Vec2::X),
            Bearing::Pen => self.facing.transpose() * leaning(&moment.place).normalize_or(Vec2::X),
        };
        let turns =
            offset.turn_degrees / 360.0 + self.brush.dynamics.turns(Property::OffsetTurn, inputs);
        // Counter-clockwise as seen is clockwise where y goes down.
        let toward = Vec2::from_angle(-TAU * side * turns).rotate(from);
        self.facing * (side * amount * self.brush.size * toward)
    }

    fn lead(&self, moment: &Moment, inputs: &DabInputs) -> Vec2 {
        let secs = self.value(Property::Lead, self.brush.stylus.lead_secs, inputs);
        if secs == 0.0 {
            Vec2::ZERO
        } else {
            secs * moment.place.paces[0] * moment.direction.normalize_or_zero()
        }
    }

    /// How much larger a dab is by chance, and how much fainter: a dab that grows spreads its
    /// paint.
    fn chance_of_size(&self, inputs: &DabInputs) -> (f32, f32) {
        let doublings = self.value(Property::SizeJitter, self.brush.size_jitter, inputs);
        if doublings.is_nan() || doublings <= 0.0 {
            return (1.0, 1.0);
        }
        let factor = (doublings * gauss(inputs.seed, 2)).exp2();
        (factor, if factor > 1.0 { 1.0 / (factor * factor) } else { 1.0 })
    }

    /// What each of several overlapping dabs adds.
    fn flow(&self, inputs: &DabInputs) -> f32 {
        let flow = self.value(Property::Flow, self.brush.flow, inputs).max(0.0).min(1.0);
        let overlap = self.brush.overlap;
        // A brush whose dabs do not overlap keeps its exact flow.
        if overlap > 1.0 { 1.0 - (1.0 - flow).powf(1.0 / overlap) } else { flow }
    }

    /// The dab of a moment; `None` if nothing would be visible.
    pub fn dab(&self, moment: &Moment, inputs: DabInputs) -> Option<Dab> {
        let strayed = self.stray_position(moment, &inputs);
        let at = self.on_canvas(strayed);
        let inputs =
            if strayed == moment.place.at { inputs } else { self.with_surface_values(at, inputs) };
        let brush = &self.brush;
        let unit = |v: f32| v.max(0.0).min(1.0);
        let (larger, fainter) = self.chance_of_size(&inputs);
        let radius = 0.5 * self.diameter(&inputs) * larger;
        let flow = self.flow(&inputs) * fainter;
        let ceiling = unit(self.value(Property::Opacity, 1.0, &inputs));
        // Comparisons that NaN fails.
        let is_visible = radius > 0.01 && radius <= FAR_PX && flow > 0.0 && ceiling > 0.0;
        // A dab smaller than a pixel becomes a fainter one of a pixel's size that covers as much.
        // Along the stroke dabs add up, across it each reaches the same part of the pixel.
        let share = (radius / PIXEL_RADIUS_PX).min(1.0);
        is_visible.then(|| Dab {
            at,
            radius: radius.max(PIXEL_RADIUS_PX),
            ratio: self.ratio(&inputs),
            rotation_rad: self.rotation_rad(&inputs),
            is_mirrored: brush.facing.is_mirrored,
            hardness: unit(self.value(Property::Hardness, brush.hardness, &inputs)),
            softness: unit(self.value(Property::Softness, brush.softness, &inputs)),
            flow: unit(flow * share),
            thin: share,
            rim: self.rims.as_ref().map_or(Rim::SOFT, |rims| rims.at(flow)),
            ceiling,
            color: if self.varies_in_color {
                tint::of(brush, self.color, &inputs)
            } else {
                self.color
            },
            operator: self.operator(&inputs),
            reach_px: 2.0 * radius * brush.reach,
            number: moment.number,
            inputs,
        })
    }

    fn operator(&self, inputs: &DabInputs) -> Operator {
        // The parameters of unwrapping are not driven: every value would need its own solve.
        self.operator.map(|number, value| match number.key {
            "gamma" => self.value(Property::Gamma, value, inputs),
            "alpha" => self.value(Property::Alpha, value, inputs),
            "detail" => self.value(Property::Detail, value, inputs),
            _ => value,
        })
    }
}

/// Where a pen leans; an upright one counts as leaning down, toward the hand that holds it.
fn leaning(place: &CurvePoint) -> Vec2 {
    if place.tilt == Vec2::ZERO { Vec2::Y } else { place.tilt }
}
