//! Dual brushes: a second tip paints along the same samples, and the coverage of its whole stroke
//! meets that of the first tip's. Floor 3. Not here: tiles of both (`stroke_tile`), how they are
//! painted (`stroke`).

use super::{Brush, Tip};
use crate::math::number_settings::number_settings;
use crate::math::{Range, UNIT, hash, vec2};
use crate::paint::brush_options::{Cycle, Offset, StylusFilter};
use crate::paint::dynamics::{Curve, Dynamics, Property};
use crate::raster::blend::spec;

crate::named! {
    /// How the coverage of both tips, a of the first and b of the second, makes that of the stroke;
    /// within `[0, 1]`, and nothing where the first tip covers nothing.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
    pub enum DualMode {
        /// a b.
        #[default]
        Multiply = "multiply" => "Multiply",
        /// The lesser of both.
        Darken = "darken" => "Darken",
        /// 2 a b, or 1 − 2 (1 − a) (1 − b) where a is above ½.
        Overlay = "overlay" => "Overlay",
        /// a / (1 − b).
        ColorDodge = "color-dodge" => "Color dodge",
        /// 1 − (1 − a) / b.
        ColorBurn = "color-burn" => "Color burn",
        /// a + b.
        LinearDodge = "linear-dodge" => "Linear dodge",
        /// a + b − 1.
        LinearBurn = "linear-burn" => "Linear burn",
        /// 1 where a + b is above 1, else 0.
        HardMix = "hard-mix" => "Hard mix",
        /// 3 a − 2 (1 − b).
        SoftHardMix = "soft-hard-mix" => "Soft hard mix",
        /// a − b.
        Subtract = "subtract" => "Subtract",
    }
}

/// Half a step of a byte: what is nearer to none or to full does not differ from that.
const HALF_STEP: f32 = 0.5 / 255.0;

impl DualMode {
    /// The coverage of the stroke where the first tip covers `a` and the second `b`, both in
    /// `[0, 1]`. In `[0, 1]`; at most `a` where that is less than half a step of a byte.
    #[inline(always)]
    pub fn combine(self, a: f32, b: f32) -> f32 {
        let both = match self {
            DualMode::Multiply => spec::multiply(a, b),
            DualMode::Darken => spec::darken(a, b),
            DualMode::Overlay => spec::overlay(a, b),
            DualMode::ColorDodge => spec::color_dodge(a, b),
            // What is as good as full stays full, whatever the second tip leaves.
            DualMode::ColorBurn => spec::color_burn(if a > 1.0 - HALF_STEP { 1.0 } else { a }, b),
            DualMode::LinearDodge => spec::linear_dodge(a, b),
            DualMode::LinearBurn => spec::linear_burn(a, b),
            // Unlike that of colors: where the second tip left nothing nothing shows.
            DualMode::HardMix => f32::from(u8::from(a + b > 1.0 + HALF_STEP)),
            DualMode::SoftHardMix => (3.0 * a - 2.0 * (1.0 - b)).max(0.0).min(1.0),
            DualMode::Subtract => spec::subtract(a, b),
        };
        if a < HALF_STEP { both.min(a) } else { both }
    }
}

number_settings! {
    /// The numbers of a dual brush. Ratios are plain numbers.
    pub struct DualSettings {
        /// Diameter of the second tip's dabs, a ratio of the brush's size, whatever drives that.
        size: "Size", "Diameter of the second tip, relative to the brush", DualBrush::SIZE, 1.0;
        /// Share of its radius that is fully covered.
        hardness: "Hardness", "How hard the edge of the second tip is", UNIT, 0.5;
        /// Blur of its footprint.
        softness: "Softness", "How blurred the second tip is", UNIT, 0.0;
        /// The greatest coverage of its whole stroke.
        opacity: "Opacity", "The most that the second tip covers", UNIT, 1.0;
        /// Coverage that one of its dabs adds.
        flow: "Flow", "What one dab of the second tip adds", UNIT, 1.0;
        /// Distance between its dabs, a ratio of their own diameter.
        spacing: "Spacing", "From dab to dab of the second tip, in its diameters", Brush::SPACING, 0.1;
        /// How far its dabs may be from the stroke, a ratio of their own diameter.
        scatter: "Scatter", "How far dabs of the second tip stray, in its diameters", Brush::SCATTER, 0.0;
        /// Counter-clockwise as seen, degrees.
        rotation: "Turn", "How far the second tip is turned, counter-clockwise", -360.0..=360.0, 0.0;
        and
        /// How its stroke meets that of the first.
        mode: DualMode = DualMode::Multiply;
    }
}

/// The second tip of a dual brush.
#[derive(Clone, PartialEq)]
pub struct DualBrush {
    /// Its numbers, and how it meets the first tip.
    pub settings: DualSettings,
    /// What its dabs look like. Of pictures in colors the alpha covers.
    pub tip: Tip,
    /// What its size, flow, opacity, hardness, softness, spacing, rotation and scatter follow. The
    /// input *distance* is measured in its own diameters.
    pub dynamics: Dynamics,
}

impl Default for DualBrush {
    /// Nothing follows the pen.
    fn default() -> Self {
        Self { settings: DualSettings::DEFAULT, tip: Tip::Round, dynamics: Dynamics::none() }
    }
}

/// What the hand and the surface do to the first tip they do to the second as well.
const SHARED: [Property; 6] = [
    Property::Alpha,
    Property::Gamma,
    Property::Detail,
    Property::Offset,
    Property::OffsetTurn,
    Property::Lead,
];
/// Mixed into the seed of a stroke: both tips have random numbers of their own.
const SEED: u32 = 0x6475_616c;

impl DualBrush {
    /// What its size may be, of the brush's.
    pub const SIZE: Range = 0.01..=20.0;

    /// A brush as the second tip of another: its tip, its numbers as far as a second tip has them,
    /// within their ranges, and what they follow.
    pub fn of_brush(second: &Brush, first: &Brush, mode: DualMode) -> Self {
        let numbers = DualSettings {
            size: second.size / first.size,
            hardness: second.hardness,
            softness: second.softness,
            opacity: second.opacity,
            flow: second.flow,
            spacing: second.spacing,
            scatter: second.scatter,
            rotation: second.rotation,
            mode,
        };
        let mut settings = DualSettings { mode, ..DualSettings::DEFAULT };
        for setting in DualSettings::SETTINGS {
            setting.put(&mut settings, (setting.get)(&numbers));
        }
        Self { settings, tip: second.tip.clone(), dynamics: second.dynamics.clone() }
    }

    /// The second tip as a brush of its own, whose strokes are coverage: along the same samples,
    /// bent alike, moved off them as the first tip is. Lengths are the same px.
    pub fn second_brush(&self, first: &Brush) -> Brush {
        let DualSettings { size, hardness, softness, flow, spacing, scatter, rotation, .. } =
            self.settings;
        let ratio = size.max(*Self::SIZE.start());
        let shared = first.dynamics.drives().iter().filter(|d| SHARED.contains(&d.property));
        let own = self.dynamics.drives().iter().filter(|d| !SHARED.contains(&d.property));
        let dynamics = own.fold(Dynamics::none(), |rows, drive| {
            rows.with(drive.property, drive.input, drive.curve.clone())
        });
        let dynamics = shared.fold(dynamics, |rows, drive| {
            let is_length = drive.property == Property::Offset;
            let curve =
                if is_length { shortened(&drive.curve, ratio) } else { drive.curve.clone() };
            rows.with(drive.property, drive.input, curve)
        });
        let StylusFilter { tremor, .. } = first.stylus;
        Brush {
            size: first.size * ratio,
            hardness,
            flow,
            spacing,
            spacing_on: first.spacing_on,
            rotation,
            facing: first.facing,
            softness,
            scatter,
            offset: Offset { amount: first.offset.amount / ratio, ..first.offset },
            reach: first.reach / ratio,
            tip: self.tip.clone(),
            stylus: StylusFilter { tremor: tremor / ratio, ..first.stylus },
            cycle: Cycle { length: first.cycle.length / ratio, ..first.cycle },
            dynamics,
            seed: hash::mix(first.seed ^ SEED),
            ..Brush::default()
        }
    }

    /// Whether its strokes have random properties.
    pub fn is_random(&self) -> bool {
        let plain = Brush { dynamics: Dynamics::none(), ..Brush::default() };
        self.second_brush(&plain).is_random()
    }
}

/// A curve whose outputs are lengths, in diameters that are `ratio` times as long.
fn shortened(curve: &Curve, ratio: f32) -> Curve {
    let Curve::Added(points) = curve else { return curve.clone() };
    let points = points.iter().map(|p| vec2(p.x, p.y / ratio)).collect();
    Curve::additive(points).unwrap_or_else(|| curve.clone())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Size;
    use crate::paint::{Adjust, PictureSource};
    use crate::raster::Picture;
    use std::sync::Arc;

    #[test]
    fn coverage_is_combined_as_computed_by_hand() {
        for (mode, expected) in [
            (DualMode::Multiply, [0.375, 0.0, 0.75, 0.0]),
            (DualMode::Darken, [0.5, 0.0, 0.75, 0.0]),
            (DualMode::Overlay, [0.75, 0.5, 1.0, 0.0]),
            (DualMode::ColorDodge, [1.0, 0.75, 1.0, 0.0]),
            (DualMode::ColorBurn, [0.5, 0.0, 0.75, 0.0]),
            (DualMode::LinearDodge, [1.0, 0.75, 1.0, 0.0]),
            (DualMode::LinearBurn, [0.25, 0.0, 0.75, 0.0]),
            (DualMode::HardMix, [1.0, 0.0, 1.0, 0.0]),
            (DualMode::SoftHardMix, [1.0, 0.25, 1.0, 0.0]),
            (DualMode::Subtract, [0.25, 0.75, 0.0, 0.0]),
        ] {
            let pairs = [(0.75, 0.5), (0.75, 0.0), (0.75, 1.0), (0.0, 1.0)];
            assert_eq!(pairs.map(|(a, b)| mode.combine(a, b)), expected, "{mode:?}");
        }
    }

    #[test]
    fn where_the_second_tip_leaves_nothing_a_full_first_one_shows_wholly_or_not_at_all() {
        let shown = DualMode::ALL.map(|(mode, _)| mode).into_iter().filter(|mode| {
            let both = mode.combine(1.0, 0.0);
            assert!(both == 0.0 || both == 1.0, "{mode:?}: {both}");
            both == 1.0
        });
        use DualMode::{ColorBurn, ColorDodge, LinearDodge, Overlay, SoftHardMix, Subtract};
        let raise = [Overlay, ColorDodge, ColorBurn, LinearDodge, SoftHardMix, Subtract];
        assert_eq!(shown.collect::<Vec<_>>(), raise);
    }

    #[test]
    fn coverage_stays_within_bounds_and_what_does_not_show_is_not_raised() {
        let steps = || (0..=255).map(|i| i as f32 / 255.0);
        for (mode, _) in DualMode::ALL {
            for (a, b) in steps().flat_map(|a| steps().map(move |b| (a, b))) {
                let both = mode.combine(a, b);
                assert!((0.0..=1.0).contains(&both), "{mode:?} {a} {b}: {both}");
                assert!(mode.combine(1e-3, b) <= 1e-3, "{mode:?} {b}");
            }
        }
    }

    #[test]
    fn the_pictures_of_a_second_tip_are_among_those_of_the_brush_and_replaced_with_them() {
        let source = |name: &str| {
            let picture = Picture::srgb8(Size::new(1, 1), vec![[255; 4]]).unwrap();
            PictureSource::new(name.into(), picture, Adjust::default())
        };
        let dual = DualBrush { tip: Tip::Picture(source("second")), ..DualBrush::default() };
        let brush = Brush {
            tip: Tip::Picture(source("first")),
            dual: Some(Arc::new(dual)),
            ..Brush::default()
        };
        let names = |brush: &Brush| -> Vec<String> {
            brush.pictures().map(|source| source.file.clone()).collect()
        };
        assert_eq!(names(&brush), ["first", "second"]);
        let renamed = |old: &PictureSource| Ok::<_, ()>(source(&format!("new {}", old.file)));
        assert_eq!(names(&brush.with_pictures(renamed).unwrap()), ["new first", "new second"]);
        assert!(brush.with_pictures(|_| Err(())).is_err());
    }

    #[test]
    fn a_brush_becomes_a_second_tip_within_its_ranges() {
        let first = Brush { size: 20.0, ..Brush::default() };
        let odd = Brush { size: 1e9, spacing: f32::NAN, scatter: -3.0, ..Brush::default() };
        let DualBrush { settings, .. } = DualBrush::of_brush(&odd, &first, DualMode::Darken);
        let default = DualSettings::DEFAULT;
        assert_eq!(
            (settings.size, settings.spacing, settings.scatter),
            (20.0, default.spacing, 0.0)
        );
        let half = Brush { size: 10.0, flow: 0.25, rotation: 30.0, ..Brush::default() };
        let dual = DualBrush::of_brush(&half, &first, DualMode::Darken);
        let second = dual.second_brush(&first);
        assert_eq!((second.size, second.flow, second.rotation), (10.0, 0.25, 30.0));
        assert!(second.dynamics == half.dynamics);
    }
}
