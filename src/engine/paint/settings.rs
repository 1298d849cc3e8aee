//! The numbers of a brush that a user sets: the range and field of each, and for options the name
//! and label, defined once for documents and for the window. Floor 3. Not here: what options mean
//! (`brush_options`).

use super::brush::Brush;
use crate::math::{NumberSetting, Range, TURNS, UNIT, range::clamp_to_range};

/// A number of a brush that a user sets, for new strokes or for existing ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BrushNumber {
    /// Its diameter, px.
    Size,
    /// The share of its radius that is wholly covered.
    Hardness,
    /// The most that a stroke covers.
    Opacity,
    /// What a dab adds.
    Flow,
    /// How blurred it is.
    Softness,
    /// From dab to dab, in diameters.
    Spacing,
    /// How far its tip is turned.
    Rotation,
    /// How far from the pen a bent mark may land.
    Reach,
}

impl BrushNumber {
    /// The range in which a user may set it.
    pub fn range(self) -> Range {
        match self {
            BrushNumber::Size => Brush::HAND_SIZE,
            BrushNumber::Spacing => Brush::SPACING,
            BrushNumber::Rotation => TURNS,
            BrushNumber::Reach => Brush::REACHES,
            BrushNumber::Hardness
            | BrushNumber::Opacity
            | BrushNumber::Flow
            | BrushNumber::Softness => UNIT,
        }
    }

    /// Sets it, within its range.
    pub fn set(self, brush: &mut Brush, to: f32) {
        let field = match self {
            BrushNumber::Size => &mut brush.size,
            BrushNumber::Hardness => &mut brush.hardness,
            BrushNumber::Opacity => &mut brush.opacity,
            BrushNumber::Flow => &mut brush.flow,
            BrushNumber::Softness => &mut brush.softness,
            BrushNumber::Spacing => &mut brush.spacing,
            BrushNumber::Rotation => &mut brush.rotation,
            BrushNumber::Reach => &mut brush.reach,
        };
        *field = clamp_to_range(to, &self.range());
    }
}

/// One number of a brush's options.
pub struct BrushSetting {
    /// The object of a brush that holds it in documents; empty: the brush itself.
    pub group: &'static str,
    /// Its names, its range, and how it is read and set.
    pub number: NumberSetting<Brush>,
}

impl BrushSetting {
    /// What it is for a brush.
    pub fn of(&self, brush: &Brush) -> f32 {
        (self.number.get)(brush)
    }

    /// Within its range.
    pub fn set(&self, brush: &mut Brush, to: f32) {
        (self.number.set)(brush, clamp_to_range(to, &self.number.range));
    }

    /// What it is for a new brush.
    pub fn default(&self) -> f32 {
        self.of(&Brush::default())
    }
}

/// The objects that hold the settings, by their names in documents, in order.
pub const GROUPS: [&str; 6] = ["", "rate", "offset", "hand", "cycle", "pickup"];

macro_rules! settings {
    ($($group:literal $name:literal $($field:ident).+ in $range:expr, $label:literal, $hint:literal;)*) => {
        /// Every number of these options.
        pub const SETTINGS: [BrushSetting; [$($name),*].len()] = [$(BrushSetting {
            group: $group,
            number: NumberSetting {
                name: $name,
                label: $label,
                hint: $hint,
                range: $range,
                is_length: false,
                get: |brush| brush.$($field).+,
                set: |brush, to| brush.$($field).+ = to,
            },
        }),*];
    };
}

settings! {
    "" "overlap" overlap in 1.0..=100.0, "Overlap",
        "How many overlapping dabs add up to the flow";
    "" "size_jitter" size_jitter in 0.0..=4.0, "Size ±",
        "How much the size of dabs varies, in doublings";
    "rate" "per_diameter" rate.per_diameter in 0.0..=200.0, "Dabs a diameter",
        "Additional dabs per diameter of the brush";
    "rate" "per_sec" rate.per_sec in 0.0..=200.0, "Dabs a second",
        "Dabs per second, even while the pen rests";
    "offset" "amount" offset.amount in -10.0..=10.0, "Offset",
        "How far from the stroke dabs are placed, in diameters";
    "offset" "turn" offset.turn_degrees in -360.0..=360.0, "Offset turn",
        "Direction of dabs from the stroke, degrees counter-clockwise";
    "hand" "tremor" stylus.tremor in 0.0..=20.0, "Tremor",
        "How far the hand shakes, in diameters";
    "hand" "lag" stylus.lag_dabs in 0.0..=100.0, "Lag",
        "How many dabs the stroke lags behind the pen";
    "hand" "lead" stylus.lead_secs in -1.0..=1.0, "Lead",
        "Places dabs where the pen would be this many seconds later";
    "hand" "direction" stylus.direction_px in 0.0..=1000.0, "Steadiness",
        "The distance in pixels over which the stroke's direction is averaged";
    "hand" "pace" stylus.pace_secs in 0.0..=10.0, "Pace over",
        "Seconds over which the pace is averaged";
    "hand" "slow_pace" stylus.slow_pace_secs in 0.0..=10.0, "Slow pace over",
        "Seconds over which the slow pace is averaged";
    "hand" "pace_pixel" stylus.pace_px in 0.001..=1000.0, "Pace pixel",
        "How many pixels count as one when the pace of the hand is measured";
    "hand" "custom" stylus.custom_dabs in 0.0..=1000.0, "Custom over",
        "Dabs over which the custom input is averaged";
    "cycle" "length" cycle.length in 0.01..=10_000.0, "Cycle",
        "Path length over which the cycle rises, in diameters";
    "cycle" "hold" cycle.hold in 0.0..=10.0, "Cycle hold",
        "How long the cycle stays at 1, relative to its length; 10 is forever";
    "cycle" "pressure" cycle.pressure in 0.0..=1.0, "Cycle pressure",
        "The pressure at which the cycle begins";
    "pickup" "amount" pickup.amount in 0.0..=1.0, "Pickup",
        "How much of its paint the brush takes from a paint layer instead of its own color";
    "pickup" "length" pickup.length in 0.0..=1.0, "Pickup length",
        "How much of the picked-up paint is left after one dab";
    "pickup" "radius" pickup.radius in 0.05..=20.0, "Pickup radius",
        "The radius that paint is picked up from, relative to the dab's";
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_setting_sets_what_it_gets_and_no_other() {
        for (i, setting) in SETTINGS.iter().enumerate() {
            let mut brush = Brush::default();
            let to = 0.5 * (setting.number.range.start() + setting.number.range.end()) + 0.25;
            setting.set(&mut brush, to);
            assert_eq!(setting.of(&brush), to, "{}.{}", setting.group, setting.number.name);
            let others = SETTINGS.iter().enumerate().filter(|(j, _)| *j != i);
            assert!(
                others.map(|(_, other)| other).all(|other| other.of(&brush) == other.default())
            );
        }
    }

    #[test]
    fn defaults_lie_within_their_ranges_and_names_are_of_one_thing() {
        assert!(SETTINGS.iter().all(|setting| setting.number.range.contains(&setting.default())));
        assert!(SETTINGS.iter().all(|setting| GROUPS.contains(&setting.group)));
        let names: BTreeSet<_> =
            SETTINGS.iter().map(|setting| (setting.group, setting.number.name)).collect();
        let labels: BTreeSet<_> = SETTINGS.iter().map(|setting| setting.number.label).collect();
        assert_eq!((names.len(), labels.len()), (SETTINGS.len(), SETTINGS.len()));
    }

    #[test]
    fn what_cannot_be_becomes_what_can() {
        let mut brush = Brush::default();
        for (to, is) in [(f32::NAN, 0.0), (-3.0, 0.0), (7.0, 1.0)] {
            let setting = SETTINGS.iter().find(|setting| setting.number.label == "Pickup").unwrap();
            setting.set(&mut brush, to);
            assert_eq!(brush.pickup.amount, is);
        }
    }
}
