//! The options of a brush apart from its dab: dabs by time, scatter and offset, how the hand is read, and
//! paint that is picked up. Floor 3. Not here: the table of their numbers (`settings`), how they
//! are used (`dab_walker`, `retouch`).

crate::named! {
    /// How coverage falls off from the middle of a dab to its rim.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
    pub enum Falloff {
        /// Full up to the hardness h of the radius, then a smoothstep.
        #[default]
        Smooth = "smooth",
        /// Two straight lines over the squared radius that meet at (h, h): a peak with a faint,
        /// wide foot. It covers the share h of its disc.
        Peaked = "peaked",
    }
}

crate::named! {
    /// How scattered dabs are distributed.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
    pub enum Spread {
        /// Uniformly over a disc whose radius is the scatter times the dab's diameter.
        #[default]
        Disc = "disc",
        /// Normally: the standard deviation along each axis is the scatter times the brush's
        /// diameter.
        Cloud = "cloud",
    }
}

crate::named! {
    /// What the path between a stroke's dabs, and that of a smoothed hand, is measured on.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
    pub enum DistanceMetric {
        /// On the canvas, as seen.
        #[default]
        Canvas = "canvas",
        /// On the surface: dabs are equally far apart, and lines are equally smooth, everywhere on
        /// the form.
        Surface = "surface",
    }
}

/// Dabs in addition to those of the spacing.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Rate {
    /// Per path length of the brush's own diameter, whatever drives the size.
    pub per_diameter: f32,
    /// Per second, even while the pen rests.
    pub per_sec: f32,
}

/// How dabs are displaced from the stroke.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Offset {
    /// How far, diameters of the brush.
    pub amount: f32,
    /// In which direction, degrees counter-clockwise from `from`.
    pub turn_degrees: f32,
    /// What its angle is measured from.
    pub from: Bearing,
    /// Every other dab is equally far away on the other side.
    pub alternates: bool,
}

crate::named! {
    /// Where a direction is measured from.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
    pub enum Bearing {
        /// The right side of the canvas.
        #[default]
        Canvas = "canvas",
        /// The stroke's direction.
        Stroke = "stroke",
        /// Where the pen leans; an upright one counts as leaning down.
        Pen = "pen",
    }
}

/// How the hand's movement becomes readings and dabs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StylusFilter {
    /// Standard deviation of the positions where the pen is read, diameters of the brush.
    pub tremor: f32,
    /// Each dab moves 1 − e^(−1/lag) of the way from the last one to the pen.
    pub lag_dabs: f32,
    /// A dab is where the pen would be this much later at its pace, or was earlier.
    pub lead_secs: f32,
    /// The path length over which a direction is averaged.
    pub direction_px: f32,
    /// The time over which each of the two paces is averaged.
    pub pace_secs: f32,
    /// The same for the slow pace.
    pub slow_pace_secs: f32,
    /// How many px count as one when a pace is read: more on an enlarged canvas, so that its
    /// brushes read the same pace.
    pub pace_px: f32,
    /// The number of dabs over which the custom input is averaged.
    pub custom_dabs: f32,
}

impl Default for StylusFilter {
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

/// What drives the input *cycle*: 0 where the pen begins to press, rising to 1 along the path, held
/// there, then repeated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycle {
    /// The path length over which it rises, diameters of the brush.
    pub length: f32,
    /// How long it is held, a ratio of the length; [`Cycle::FOR_EVER`] and more for ever.
    pub hold: f32,
    /// The pressure at which it begins.
    pub pressure: f32,
}

impl Cycle {
    /// A hold so long that it never ends.
    pub const FOR_EVER: f32 = 10.0;
}

impl Default for Cycle {
    fn default() -> Self {
        Self { length: 30.0, hold: 0.0, pressure: 0.0 }
    }
}

/// Paint that a brush picks up from its layer and mixes into its own. Strokes of a stroke layer
/// find nothing to pick up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pickup {
    /// The share of a dab's paint that was picked up; the rest is the brush's own.
    pub amount: f32,
    /// The share of the paint it holds that remains a dab later; the rest is picked up from the
    /// layer.
    pub length: f32,
    /// The radius from which it picks up paint, a ratio of the dab's.
    pub radius: f32,
}

impl Default for Pickup {
    fn default() -> Self {
        Self { amount: 0.0, length: 0.5, radius: 1.0 }
    }
}
