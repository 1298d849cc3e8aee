//! A brush's habits beside its dab: dabs by time, where dabs stray to, how the hand is read, and paint that is taken
//! up. Floor 3. [`SETTINGS`] says each number's name, range and words once, for documents and for the window. Not
//! here: what is made of them (`walker`, `retouch`).

use super::brush::Brush;
use crate::math::{Range, range::held};

crate::named! {
    /// How coverage falls off from the middle of a dab to its rim.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
    pub enum Falloff {
        /// Whole up to the hardness h of the radius, then a smoothstep.
        #[default]
        Smooth = "smooth",
        /// Two straight lines over the squared radius that meet at (h, h): a peak with a faint, wide foot. It covers
        /// the share h of its disc.
        Peaked = "peaked",
    }
}

crate::named! {
    /// How scattered dabs lie.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
    pub enum Spread {
        /// Evenly over a disc whose radius is the scatter times the dab's diameter.
        #[default]
        Disc = "disc",
        /// Most of them near, some far: the standard deviation along each axis is the scatter times the brush's
        /// diameter.
        Cloud = "cloud",
    }
}

crate::named! {
    /// What the way between a stroke's dabs is measured on.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
    pub enum Measure {
        /// As it is seen.
        #[default]
        Canvas = "canvas",
        /// As long as it is on the surface: dabs stand equally far apart all over the form.
        Surface = "surface",
    }
}

/// Dabs beside those of the spacing.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Rate {
    /// Along a way as long as the brush's own diameter, whatever drives the size.
    pub per_diameter: f32,
    /// While time passes, also where the pen rests.
    pub per_sec: f32,
}

/// Where dabs stand beside the stroke.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Offset {
    /// How far, diameters of the brush.
    pub amount: f32,
    /// To where, degrees counter-clockwise from `from`.
    pub turn_degrees: f32,
    pub from: Bearing,
    /// Every other dab stands as far and as much turned on the other side.
    pub alternates: bool,
}

crate::named! {
    /// Where a direction is measured from.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
    pub enum Bearing {
        /// The right side of the canvas.
        #[default]
        Canvas = "canvas",
        /// Where the stroke goes.
        Stroke = "stroke",
        /// Where the pen leans to; an upright one leans down.
        Pen = "pen",
    }
}

/// How the hand's ways become readings and dabs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hand {
    /// Standard deviation of the places that the pen is read at, diameters of the brush.
    pub tremor: f32,
    /// Each dab comes 1 − e^(−1/lag) of the way from the last one to the pen.
    pub lag_dabs: f32,
    /// A dab stands where the pen would be so much later, at its pace; or was earlier.
    pub lead_secs: f32,
    /// Over which way a direction is averaged.
    pub direction_px: f32,
    /// Over which time each of the two paces is averaged.
    pub pace_secs: f32,
    pub slow_pace_secs: f32,
    /// How many px count as one where a pace is read: more on a canvas that was enlarged, so that its brushes read the
    /// same hand.
    pub pace_px: f32,
    /// Over how many dabs the custom input is averaged.
    pub custom_dabs: f32,
}

impl Default for Hand {
    fn default() -> Self {
        Self {
            tremor: 0.0,
            lag_dabs: 0.0,
            lead_secs: 0.0,
            direction_px: 0.0,
            pace_secs: 0.04,
            slow_pace_secs: 0.8,
            pace_px: 1.0,
            custom_dabs: 0.0,
        }
    }
}

/// What the input *cycle* goes by: 0 where the pen begins to press, rising to 1 along the way, held there, and again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycle {
    /// How far it rises, diameters of the brush.
    pub length: f32,
    /// How long it is held, a ratio of the length; [`Cycle::FOR_EVER`] and more for ever.
    pub hold: f32,
    /// The pressure that it begins at.
    pub pressure: f32,
}

impl Cycle {
    pub const FOR_EVER: f32 = 10.0;
}

impl Default for Cycle {
    fn default() -> Self {
        Self { length: 30.0, hold: 0.0, pressure: 0.0 }
    }
}

/// Paint that a brush takes up from its layer and mixes into its own. Strokes of a stroke layer find nothing to take
/// up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pickup {
    /// How much of a dab's paint was taken up; the rest is the brush's own.
    pub amount: f32,
    /// The share of what it holds that is still there a dab later; the rest is taken up anew.
    pub length: f32,
    /// The radius that it takes paint up from, a ratio of the dab's.
    pub radius: f32,
}

impl Default for Pickup {
    fn default() -> Self {
        Self { amount: 0.0, length: 0.5, radius: 1.0 }
    }
}

/// One number of a brush.
pub struct Setting {
    /// The object of a brush's that documents keep it in; empty: the brush's own.
    pub group: &'static str,
    /// In documents.
    pub name: &'static str,
    pub range: Range,
    /// In the window, and what it means there.
    pub label: &'static str,
    pub hint: &'static str,
    get: fn(&Brush) -> f32,
    set: fn(&mut Brush, f32),
}

impl Setting {
    pub fn of(&self, brush: &Brush) -> f32 {
        (self.get)(brush)
    }
    /// Within its range.
    pub fn set(&self, brush: &mut Brush, to: f32) {
        (self.set)(brush, held(to, &self.range));
    }
    pub fn default(&self) -> f32 {
        self.of(&Brush::default())
    }
}

/// The objects that the settings lie in, as documents call them, in their order.
pub const GROUPS: [&str; 6] = ["", "rate", "offset", "hand", "cycle", "pickup"];

macro_rules! settings {
    ($($group:literal $name:literal $($field:ident).+ in $range:expr, $label:literal, $hint:literal;)*) => {
        /// Every number of these habits.
        pub const SETTINGS: [Setting; [$($name),*].len()] = [$(Setting {
            group: $group,
            name: $name,
            range: $range,
            label: $label,
            hint: $hint,
            get: |brush| brush.$($field).+,
            set: |brush, to| brush.$($field).+ = to,
        }),*];
    };
}

settings! {
    "" "overlap" overlap in 1.0..=100.0, "Overlap",
        "So many dabs that lie over each other come to the flow together";
    "" "size_jitter" size_jitter in 0.0..=4.0, "Size ±",
        "How far a dab's size may be from the brush's, in doublings";
    "rate" "per_diameter" rate.per_diameter in 0.0..=200.0, "Dabs a diameter",
        "Dabs beside those of the spacing, along the brush's own diameter";
    "rate" "per_sec" rate.per_sec in 0.0..=200.0, "Dabs a second",
        "Dabs while time passes, also where the pen rests";
    "offset" "amount" offset.amount in -10.0..=10.0, "Offset",
        "How far beside the stroke dabs stand, in diameters";
    "offset" "turn" offset.turn_degrees in -360.0..=360.0, "Offset turn",
        "To where dabs stand beside the stroke, degrees counter-clockwise";
    "hand" "tremor" hand.tremor in 0.0..=20.0, "Tremor",
        "How far the hand shakes, in diameters";
    "hand" "lag" hand.lag_dabs in 0.0..=100.0, "Lag",
        "After how many dabs the stroke comes to where the pen is";
    "hand" "lead" hand.lead_secs in -1.0..=1.0, "Lead",
        "Dabs stand where the pen would be so many seconds later";
    "hand" "direction" hand.direction_px in 0.0..=1000.0, "Steadiness",
        "The way in pixels over which the stroke's direction is averaged";
    "hand" "pace" hand.pace_secs in 0.0..=10.0, "Pace over",
        "Seconds over which the pace is averaged";
    "hand" "slow_pace" hand.slow_pace_secs in 0.0..=10.0, "Slow pace over",
        "Seconds over which the slow pace is averaged";
    "hand" "pace_pixel" hand.pace_px in 0.001..=1000.0, "Pace pixel",
        "How many pixels count as one where the hand's pace is read";
    "hand" "custom" hand.custom_dabs in 0.0..=1000.0, "Custom over",
        "Dabs over which the custom input is averaged";
    "cycle" "length" cycle.length in 0.01..=10_000.0, "Cycle",
        "How far the cycle takes to rise, in diameters";
    "cycle" "hold" cycle.hold in 0.0..=10.0, "Cycle hold",
        "How long the cycle stays up, of its length; 10 is for ever";
    "cycle" "pressure" cycle.pressure in 0.0..=1.0, "Cycle pressure",
        "The pressure that the cycle begins at";
    "pickup" "amount" pickup.amount in 0.0..=1.0, "Picks up",
        "How much of its paint the brush takes from a paint layer instead of its own colour";
    "pickup" "length" pickup.length in 0.0..=1.0, "Carries",
        "How much of the paint that it took up is still there a dab later";
    "pickup" "radius" pickup.radius in 0.05..=20.0, "Reaches",
        "The radius that it takes paint up from, of the dab's";
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_setting_sets_what_it_gets_and_no_other() {
        for (i, setting) in SETTINGS.iter().enumerate() {
            let mut brush = Brush::default();
            let to = 0.5 * (setting.range.start() + setting.range.end()) + 0.25;
            setting.set(&mut brush, to);
            assert_eq!(setting.of(&brush), to, "{}.{}", setting.group, setting.name);
            let others = SETTINGS.iter().enumerate().filter(|(j, _)| *j != i);
            assert!(others.map(|(_, other)| other).all(|other| other.of(&brush) == other.default()));
        }
    }
    #[test]
    fn defaults_lie_within_their_ranges_and_names_are_of_one_thing() {
        assert!(SETTINGS.iter().all(|setting| setting.range.contains(&setting.default())));
        assert!(SETTINGS.iter().all(|setting| GROUPS.contains(&setting.group)));
        let names: BTreeSet<_> = SETTINGS.iter().map(|setting| (setting.group, setting.name)).collect();
        let labels: BTreeSet<_> = SETTINGS.iter().map(|setting| setting.label).collect();
        assert_eq!((names.len(), labels.len()), (SETTINGS.len(), SETTINGS.len()));
    }
    #[test]
    fn what_cannot_be_becomes_what_can() {
        let mut brush = Brush::default();
        for (to, is) in [(f32::NAN, 0.0), (-3.0, 0.0), (7.0, 1.0)] {
            let setting = SETTINGS.iter().find(|setting| setting.label == "Picks up").unwrap();
            setting.set(&mut brush, to);
            assert_eq!(brush.pickup.amount, is);
        }
    }
}
