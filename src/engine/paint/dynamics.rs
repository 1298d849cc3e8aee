//! Brush dynamics: curves drive each property of a dab by inputs of the pen and of the surface.
//! Floor 3. Not here: where dabs are placed and how the inputs are measured (`dab_walker`).

mod curve;
mod inputs;

pub use curve::{Curve, MAX_POINTS, MOST_ADDED};
pub use inputs::{
    DabInputs, FAR_DIAMETERS, FAST_LENGTHS_PER_SEC, PACES_PX_PER_SEC, pace_of, px_per_sec_of,
    turns_of,
};

use std::sync::Arc;

crate::named! {
    /// What can be driven. Curves multiply, unless [`Property::is_additive`]; a [`Curve::Added`] adds in
    /// the unit given here, else in the property's own.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum Property {
        /// An added 1 doubles it.
        Size = "size",
        /// The greatest coverage of a dab's pixels, in addition to the stroke's own opacity.
        Opacity = "opacity",
        Flow = "flow",
        Hardness = "hardness",
        Spacing = "spacing",
        /// A curve's 1 is a full turn counter-clockwise.
        Rotation = "rotation",
        Scatter = "scatter",
        Softness = "softness",
        /// A curve's 1 is a full turn of the color wheel.
        Hue = "hue",
        Saturation = "saturation",
        Value = "value",
        /// α of D_n and D_r.
        Alpha = "alpha",
        /// γ of D_p.
        Gamma = "gamma",
        /// μ, the detail of D_n and D_r.
        Detail = "detail",
        /// Of a round, elliptic or square tip: the longer side over the shorter one.
        Elongation = "elongation",
        /// HSL lightness of the color.
        Lightness = "lightness",
        /// How far sizes vary, see [`super::Brush::size_jitter`].
        SizeJitter = "size-jitter",
        /// How far dabs are displaced from the stroke, and where to; see [`super::Offset`].
        Offset = "offset",
        /// A curve's 1 is a full turn counter-clockwise.
        OffsetTurn = "offset-turn",
        /// See [`super::StylusFilter`]; added seconds.
        Lead = "lead",
        /// See [`super::Pickup`].
        Pickup = "pickup",
        PickupLength = "pickup-length",
        /// What [`Input::Custom`] reads at the next dab. It is 0 unless something is added to it.
        Custom = "custom",
    }
}

impl Property {
    /// Whether its curves are turns that add up instead of factors that multiply.
    pub fn is_additive(self) -> bool {
        matches!(self, Property::Rotation | Property::Hue | Property::OffsetTurn)
    }
}

crate::named! {
    /// An input that can drive properties, in `[0, 1]`.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum Input {
        /// The pressure of the pen, unchanged.
        Pressure = "pressure",
        /// From upright, 0, to flat, 1: the length of (tilt x, tilt y) over 90°.
        Tilt = "tilt",
        /// The direction in which the pen leans, in turns counter-clockwise as seen: 0 right, ¼ up.
        /// 0 for an upright pen.
        TiltDirection = "tilt-direction",
        /// The direction of the stroke, in turns counter-clockwise as seen: 0 right, ¼ up. 0 for a
        /// stroke of one sample.
        Direction = "direction",
        /// Over [`FAST_LENGTHS_PER_SEC`].
        Speed = "speed",
        /// Along the stroke, over [`FAR_DIAMETERS`] of the brush.
        Distance = "distance",
        /// Random for every dab and property, uniformly distributed.
        Random = "random",
        /// 1 − n·v: 0 faces the viewer, 1 is seen edge-on. 0 off the surface.
        Slope = "slope",
        /// ½ + ½ κ of MATH 4, *s* a 32nd of *L*, normals blurred by 1 px: hollow 0, flat ½, raised
        /// 1. ½ off the surface.
        Curvature = "curvature",
        /// From the map: 0 near, 1 far. 1 off the surface.
        Depth = "depth",
        /// The speed in canvas px a second on a logarithmic scale, see [`pace_of`], averaged over
        /// [`super::StylusFilter::pace_secs`].
        Pace = "pace",
        /// The same, averaged over [`super::StylusFilter::slow_pace_secs`].
        SlowPace = "slow-pace",
        /// Random for every dab, the same for all its properties, uniformly distributed.
        Chance = "chance",
        /// Repeats along the stroke; see [`super::Cycle`].
        Cycle = "cycle",
        /// Where the pen leans, in turns counter-clockwise from the stroke's direction. An upright
        /// pen counts as leaning down.
        Attack = "attack",
        /// The value of [`Property::Custom`] at the previous dabs.
        Custom = "custom",
    }
}

impl Input {}

/// One row: a property follows an input.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// What is driven.
    pub property: Property,
    /// What drives it.
    pub input: Input,
    /// The output for each input.
    pub curve: Curve,
}

/// All rows of a brush: for a property and an input at most one that adds and one that acts as the
/// property's curves do.
#[derive(Clone, Debug, PartialEq)]
pub struct Dynamics {
    drives: Arc<[Drive]>,
}

impl Default for Dynamics {
    /// Pressure drives the opacity, not the size.
    fn default() -> Self {
        Self::none().with(Property::Flow, Input::Pressure, Curve::Share(1.0))
    }
}

impl Dynamics {
    /// Whether nothing is driven.
    pub fn none() -> Self {
        Self { drives: Arc::new([]) }
    }

    /// All of them, in the order in which they are applied.
    pub fn drives(&self) -> &[Drive] {
        &self.drives
    }

    /// With this row instead of the one of its kind for the same property and input. A factor that
    /// is always 1 needs no row.
    pub fn with(&self, property: Property, input: Input, curve: Curve) -> Self {
        let adds = curve.is_additive();
        let is_row = |drive: &&Drive| {
            drive.property == property && drive.input == input && drive.curve.is_additive() == adds
        };
        let is_idle = if property.is_additive() && !curve.is_additive() {
            curve == Curve::Share(0.0)
        } else {
            curve.is_idle()
        };
        let row = (!is_idle).then_some(Drive { property, input, curve });
        // In a fixed order, whatever came first: factors multiply to the same bits.
        let others = self.drives.iter().filter(|drive| !is_row(drive)).cloned();
        let mut drives: Vec<Drive> = others.chain(row).collect();
        drives.sort_by_key(|drive| (drive.property as u8, drive.input as u8));
        Self { drives: drives.into() }
    }

    /// Without the row of a kind for a property and an input.
    pub fn without(&self, property: Property, input: Input, adds: bool) -> Self {
        let stays = |drive: &&Drive| {
            drive.property != property || drive.input != input || drive.curve.is_additive() != adds
        };
        Self { drives: self.drives.iter().filter(stays).cloned().collect() }
    }

    /// The curve by which a property follows an input, unless it adds.
    pub fn curve(&self, property: Property, input: Input) -> Option<&Curve> {
        self.of_kind(property, input, false)
    }

    /// What an input adds to a property.
    pub fn added_curve(&self, property: Property, input: Input) -> Option<&Curve> {
        self.of_kind(property, input, true)
    }

    fn of_kind(&self, property: Property, input: Input, adds: bool) -> Option<&Curve> {
        let mut drives =
            self.drives.iter().filter(|drive| drive.property == property && drive.input == input);
        drives.find(|drive| drive.curve.is_additive() == adds).map(|drive| &drive.curve)
    }

    /// The share of a property that follows the pressure, `[0, 1]`: a slider shows a curve by its
    /// total fall.
    pub fn pressure_share(&self, property: Property) -> f32 {
        let curve =
            self.curve(property, Input::Pressure).or(self.added_curve(property, Input::Pressure));
        let fall = |curve: &Curve| match property {
            Property::Size if curve.is_additive() => 1.0 - (curve.at(0.0) - curve.at(1.0)).exp2(),
            _ => curve.at(1.0) - curve.at(0.0),
        };
        curve.map_or(0.0, fall).max(0.0).min(1.0)
    }

    /// All other effects of the pressure on the property are removed.
    pub fn with_pressure(&self, property: Property, share: f32) -> Self {
        self.without(property, Input::Pressure, true).with(
            property,
            Input::Pressure,
            Curve::Share(share.max(0.0).min(1.0)),
        )
    }

    /// Whether some property follows this input.
    pub fn has_input(&self, input: Input) -> bool {
        self.drives.iter().any(|drive| drive.input == input)
    }

    /// Whether something drives this property.
    pub fn is_driven(&self, property: Property) -> bool {
        self.drives.iter().any(|drive| drive.property == property)
    }

    /// The sum of a property's rows that add, and the product of those that multiply.
    fn outputs(&self, property: Property, inputs: &DabInputs) -> (f32, f32) {
        let rows = self.drives.iter().filter(|drive| drive.property == property);
        rows.fold((0.0, 1.0), |(sum, product), drive| {
            let y = drive.curve.at(inputs.of(drive.input, property));
            if drive.curve.is_additive() || property.is_additive() {
                (sum + y, product)
            } else {
                (sum, product * y)
            }
        })
    }

    /// A property whose value is `plain` if nothing drives it: sums first, then factors.
    pub fn value(&self, property: Property, plain: f32, inputs: &DabInputs) -> f32 {
        let (sum, product) = self.outputs(property, inputs);
        match property {
            // Brushes without such a row do not change by a bit.
            Property::Size if sum != 0.0 => plain * sum.exp2() * product,
            _ => (plain + sum) * product,
        }
    }

    /// What is added to an angle, in turns.
    pub fn turns(&self, property: Property, inputs: &DabInputs) -> f32 {
        self.outputs(property, inputs).0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec2;

    fn through(points: &[(f32, f32)]) -> Curve {
        Curve::through(points.iter().map(|&(x, y)| vec2(x, y)).collect()).unwrap()
    }

    #[test]
    fn rows_of_one_property_multiply_and_angles_add() {
        let dynamics = Dynamics::none()
            .with(Property::Size, Input::Pressure, Curve::Share(1.0))
            .with(Property::Size, Input::Slope, through(&[(0.0, 1.0), (1.0, 0.5)]))
            .with(Property::Rotation, Input::Direction, Curve::Share(1.0))
            .with(Property::Rotation, Input::Tilt, Curve::Share(1.0));
        let inputs = DabInputs {
            pressure: 0.5,
            slope: 1.0,
            direction: 0.25,
            tilt: 0.5,
            ..DabInputs::default()
        };
        assert_eq!(dynamics.value(Property::Size, 1.0, &inputs), 0.25);
        assert_eq!(dynamics.turns(Property::Rotation, &inputs), 0.75);
        assert_eq!(dynamics.value(Property::Flow, 1.0, &inputs), 1.0);
    }

    #[test]
    fn a_row_takes_the_place_of_the_one_before_and_a_factor_of_one_is_none() {
        let plain = Dynamics::default();
        assert_eq!(plain.with_pressure(Property::Flow, 0.0), Dynamics::none());
        let twice = plain.with_pressure(Property::Flow, 0.25).with_pressure(Property::Flow, 0.5);
        assert_eq!((twice.drives().len(), twice.pressure_share(Property::Flow)), (1, 0.5));
    }

    #[test]
    fn what_is_random_differs_from_dab_to_dab_and_from_property_to_property() {
        let random =
            |seed, property| DabInputs { seed, ..DabInputs::default() }.of(Input::Random, property);
        assert_eq!(random(3, Property::Size), random(3, Property::Size));
        assert_ne!(random(3, Property::Size), random(4, Property::Size));
        assert_ne!(random(3, Property::Size), random(3, Property::Hue));
    }

    #[test]
    fn what_adds_comes_before_what_multiplies_and_sizes_double() {
        let added = |points: &[(f32, f32)]| {
            Curve::additive(points.iter().map(|&(x, y)| vec2(x, y)).collect()).unwrap()
        };
        let dynamics = Dynamics::none()
            .with(Property::Hardness, Input::Pressure, added(&[(0.0, -0.25), (1.0, 0.25)]))
            .with(Property::Hardness, Input::Tilt, Curve::Share(1.0))
            .with(Property::Size, Input::Pressure, added(&[(0.0, -2.0), (1.0, 2.0)]))
            .with(Property::Rotation, Input::Pressure, added(&[(0.0, -1.0), (1.0, 0.0)]));
        let inputs = DabInputs { pressure: 0.0, tilt: 0.5, ..DabInputs::default() };
        assert_eq!(dynamics.value(Property::Hardness, 0.75, &inputs), 0.25);
        assert_eq!(dynamics.value(Property::Size, 20.0, &inputs), 5.0);
        assert_eq!(dynamics.turns(Property::Rotation, &inputs), -1.0);
        assert_eq!(dynamics.pressure_share(Property::Size), 1.0 - 1.0 / 16.0);
        let none = dynamics.with(Property::Hardness, Input::Pressure, added(&[(0.0, 0.0)]));
        assert!(
            none.added_curve(Property::Hardness, Input::Pressure).is_none(),
            "adding nothing is no row"
        );
        assert_eq!(dynamics.with_pressure(Property::Size, 0.5).pressure_share(Property::Size), 0.5);
    }

    #[test]
    fn chance_is_one_for_all_properties_of_a_dab() {
        let of =
            |input, property| DabInputs { seed: 7, ..DabInputs::default() }.of(input, property);
        assert_eq!(of(Input::Chance, Property::Size), of(Input::Chance, Property::Hue));
        assert_ne!(of(Input::Random, Property::Size), of(Input::Chance, Property::Size));
    }
}
