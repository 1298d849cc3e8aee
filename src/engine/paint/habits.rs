//! A brush's habits beside its dab: dabs by time, where dabs stray to, how the hand is read, and paint that is taken
//! up. Floor 3. Not here: the table of their numbers (`settings`), what is made of them (`dab_walker`, `retouch`).

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
    /// What the way between a stroke's dabs, and that of a hand that is smoothed, is measured on.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
    pub enum Measure {
        /// As it is seen.
        #[default]
        Canvas = "canvas",
        /// As long as it is on the surface: dabs stand equally far apart, and lines are equally smooth, all over the
        /// form.
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
