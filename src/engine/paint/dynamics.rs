//! Brush dynamics: curves drive each property of a dab by inputs of the pen and of the surface. Floor 3. Not here:
//! where dabs are placed and how the inputs are measured (`dab_walker`).

use crate::math::{Vec2, hash, vec2};
use std::f32::consts::TAU;
use std::sync::Arc;

/// A property that can be driven. Curves multiply it, or add to it where [`Property::adds`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Property {
    Size,
    /// The greatest coverage of a dab's pixels, in addition to the stroke's own opacity.
    Opacity,
    Flow,
    Hardness,
    Spacing,
    /// A curve's 1 is a full turn counter-clockwise.
    Rotation,
    Scatter,
    Softness,
    /// A curve's 1 is once round the colour wheel.
    Hue,
    Saturation,
    Value,
    /// α of D_n and D_r.
    Alpha,
    /// γ of D_p.
    Gamma,
    /// μ, the detail of D_n and D_r.
    Detail,
}

impl Property {
    /// Every property with its name in documents.
    pub const ALL: [(Property, &str); 14] = [
        (Property::Size, "size"),
        (Property::Opacity, "opacity"),
        (Property::Flow, "flow"),
        (Property::Hardness, "hardness"),
        (Property::Spacing, "spacing"),
        (Property::Rotation, "rotation"),
        (Property::Scatter, "scatter"),
        (Property::Softness, "softness"),
        (Property::Hue, "hue"),
        (Property::Saturation, "saturation"),
        (Property::Value, "value"),
        (Property::Alpha, "alpha"),
        (Property::Gamma, "gamma"),
        (Property::Detail, "detail"),
    ];
    /// Whether its curves are turns that add up instead of factors that multiply.
    pub fn adds(self) -> bool {
        matches!(self, Property::Rotation | Property::Hue)
    }
}

/// An input that can drive properties, in `[0, 1]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Input {
    /// The pressure of the pen, unchanged.
    Pressure,
    /// From upright, 0, to lying, 1: the length of (tilt x, tilt y) over 90°.
    Tilt,
    /// The direction in which the pen leans, in turns counter-clockwise as seen: 0 right, ¼ up. 0 of an upright pen.
    TiltDirection,
    /// The direction of the stroke, in turns counter-clockwise as seen: 0 right, ¼ up. 0 of a stroke of one sample.
    Direction,
    /// Over [`FAST_LENGTHS_PER_SEC`].
    Speed,
    /// Along the stroke, over [`FAR_DIAMETERS`] of the brush.
    Distance,
    /// Random for every dab and property, uniformly distributed.
    Random,
    /// 1 − n_z: 0 faces the viewer, 1 is seen edge-on. 0 off the surface.
    Slope,
    /// ½ + ½ κ of MATH 4, *s* a 32nd of *L*, normals blurred by 1 px: hollow 0, flat ½, raised 1. ½ off the surface.
    Curvature,
    /// Of the map: 0 near, 1 far. 1 off the surface.
    Depth,
}

impl Input {
    /// Every input with its name in documents.
    pub const ALL: [(Input, &str); 10] = [
        (Input::Pressure, "pressure"),
        (Input::Tilt, "tilt"),
        (Input::TiltDirection, "tilt-direction"),
        (Input::Direction, "direction"),
        (Input::Speed, "speed"),
        (Input::Distance, "distance"),
        (Input::Random, "random"),
        (Input::Slope, "slope"),
        (Input::Curvature, "curvature"),
        (Input::Depth, "depth"),
    ];
}

/// The speed that reads 1, canvas lengths *L* a second.
pub const FAST_LENGTHS_PER_SEC: f32 = 2.0;
/// The distance that reads 1, diameters.
pub const FAR_DIAMETERS: f32 = 10.0;

/// The inputs at a dab's place, each in `[0, 1]` as [`Input`] defines it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DabInputs {
    pub pressure: f32,
    pub tilt: f32,
    pub tilt_direction: f32,
    pub direction: f32,
    pub speed: f32,
    pub distance: f32,
    pub slope: f32,
    pub curvature: f32,
    pub depth: f32,
    /// The seed of this dab: its random properties follow from it.
    pub seed: u32,
}

impl Default for DabInputs {
    /// Full pressure, upright, at rest, off the surface.
    fn default() -> Self {
        Self {
            pressure: 1.0,
            tilt: 0.0,
            tilt_direction: 0.0,
            direction: 0.0,
            speed: 0.0,
            distance: 0.0,
            slope: 0.0,
            curvature: 0.5,
            depth: 1.0,
            seed: 0,
        }
    }
}

impl DabInputs {
    /// The value of an input, for a property.
    fn of(&self, input: Input, property: Property) -> f32 {
        match input {
            Input::Pressure => self.pressure,
            Input::Tilt => self.tilt,
            Input::TiltDirection => self.tilt_direction,
            Input::Direction => self.direction,
            Input::Speed => self.speed,
            Input::Distance => self.distance,
            Input::Random => hash::unit(self.seed, property as u32, 1),
            Input::Slope => self.slope,
            Input::Curvature => self.curvature,
            Input::Depth => self.depth,
        }
    }
}

/// The direction of a vector in image axes (y down), in turns counter-clockwise as seen, `[0, 1)`; 0 of none.
pub fn turns_of(v: Vec2) -> f32 {
    let turns = if v == Vec2::ZERO { 0.0 } else { (-v.y).atan2(v.x) / TAU };
    // A turn just below 0 rounds up to 1.
    (turns - turns.floor()) % 1.0
}

/// Maps an input in `[0, 1]` to a factor or share in `[0, 1]`.
#[derive(Clone, Debug, PartialEq)]
pub enum Curve {
    /// The line from 1 − p to 1: p in `[0, 1]` is the share of the property that follows the input.
    Share(f32),
    /// Straight lines between points, level beyond the first and the last. Only of [`Curve::through`].
    Points(Arc<[Vec2]>),
}

/// The most points of one curve: more than anyone sets by hand.
pub const MAX_POINTS: usize = 64;

impl Curve {
    /// The curve through points (input, output) of `[0, 1]²` from left to right; two above each other are a step.
    /// `None` for no points, too many, or any that are not of this kind.
    pub fn through(points: Vec<Vec2>) -> Option<Self> {
        let is_inside = |p: &Vec2| (0.0..=1.0).contains(&p.x) && (0.0..=1.0).contains(&p.y);
        let is_ordered = points.windows(2).all(|pair| pair[0].x <= pair[1].x);
        let is_curve = (1..=MAX_POINTS).contains(&points.len()) && points.iter().all(is_inside) && is_ordered;
        is_curve.then(|| Curve::Points(points.into()))
    }
    /// The output at an input; NaN counts as 0.
    pub fn at(&self, x: f32) -> f32 {
        let x = x.max(0.0).min(1.0);
        match self {
            Curve::Share(p) => 1.0 - p * (1.0 - x),
            Curve::Points(points) => {
                let mut before = points.first().copied().unwrap_or(vec2(0.0, 1.0));
                for &point in points.iter() {
                    if x <= point.x {
                        let width = point.x - before.x;
                        let along = if width > 0.0 { (x - before.x) / width } else { 1.0 };
                        return before.y + (point.y - before.y) * along;
                    }
                    before = point;
                }
                before.y
            }
        }
    }
    /// How many points it has; a share has none.
    pub fn points(&self) -> usize {
        if let Curve::Points(points) = self { points.len() } else { 0 }
    }
    /// Whether it is 1 everywhere.
    fn is_idle(&self) -> bool {
        match self {
            Curve::Share(p) => *p == 0.0,
            Curve::Points(points) => points.iter().all(|p| p.y == 1.0),
        }
    }
}

/// One row: a property follows an input.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    pub property: Property,
    pub input: Input,
    pub curve: Curve,
}

/// All rows of a brush, at most one for a property and an input.
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
    pub fn drives(&self) -> &[Drive] {
        &self.drives
    }
    /// Replaces the row for the same property and input by this one. A factor that is always 1 removes it.
    pub fn with(&self, property: Property, input: Input, curve: Curve) -> Self {
        let is_row = |drive: &&Drive| drive.property == property && drive.input == input;
        let is_idle = if property.adds() { curve == Curve::Share(0.0) } else { curve.is_idle() };
        let row = (!is_idle).then_some(Drive { property, input, curve });
        // In one order, whatever came first: factors multiply to the same bits.
        let others = self.drives.iter().filter(|drive| !is_row(drive)).cloned();
        let mut drives: Vec<Drive> = others.chain(row).collect();
        drives.sort_by_key(|drive| (drive.property as u8, drive.input as u8));
        Self { drives: drives.into() }
    }
    pub fn curve(&self, property: Property, input: Input) -> Option<&Curve> {
        self.drives.iter().find(|drive| drive.property == property && drive.input == input).map(|drive| &drive.curve)
    }
    /// The share of a property that follows the pressure, `[0, 1]`: a slider shows any curve by its total fall.
    pub fn pressure_share(&self, property: Property) -> f32 {
        self.curve(property, Input::Pressure).map_or(0.0, |curve| (curve.at(1.0) - curve.at(0.0)).max(0.0))
    }
    pub fn with_pressure(&self, property: Property, share: f32) -> Self {
        self.with(property, Input::Pressure, Curve::Share(share.max(0.0).min(1.0)))
    }
    /// Whether some property follows this input.
    pub fn follow(&self, input: Input) -> bool {
        self.drives.iter().any(|drive| drive.input == input)
    }
    /// Whether something drives this property.
    pub fn drive(&self, property: Property) -> bool {
        self.drives.iter().any(|drive| drive.property == property)
    }
    fn outputs(&self, property: Property, inputs: &DabInputs) -> impl Iterator<Item = f32> {
        let rows = self.drives.iter().filter(move |drive| drive.property == property);
        rows.map(move |drive| drive.curve.at(inputs.of(drive.input, property)))
    }
    /// The factor of a property, `[0, 1]`.
    pub fn factor(&self, property: Property, inputs: &DabInputs) -> f32 {
        self.outputs(property, inputs).product()
    }
    /// The turns that are added to an angle.
    pub fn turns(&self, property: Property, inputs: &DabInputs) -> f32 {
        self.outputs(property, inputs).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn through(points: &[(f32, f32)]) -> Curve {
        Curve::through(points.iter().map(|&(x, y)| vec2(x, y)).collect()).unwrap()
    }

    #[test]
    fn a_curve_is_straight_between_its_points_and_level_beyond_them() {
        let curve = through(&[(0.2, 1.0), (0.6, 0.5), (0.6, 0.1), (0.8, 0.3)]);
        for (x, y) in [(0.0, 1.0), (0.2, 1.0), (0.4, 0.75), (0.6, 0.5), (0.7, 0.2), (0.9, 0.3), (f32::NAN, 1.0)] {
            assert!((curve.at(x) - y).abs() < 1e-6, "{x}: {}", curve.at(x));
        }
        assert!(curve.at(0.6001) < 0.11, "two points above each other are a step");
        assert_eq!([0.0, 0.5, 1.0].map(|x| Curve::Share(0.5).at(x)), [0.5, 0.75, 1.0]);
    }
    #[test]
    fn points_that_run_back_or_leave_the_square_are_no_curve() {
        for points in [&[][..], &[(0.5, 0.5), (0.4, 0.5)], &[(0.0, 1.5)], &[(f32::NAN, 0.5)]] {
            assert!(Curve::through(points.iter().map(|&(x, y)| vec2(x, y)).collect()).is_none(), "{points:?}");
        }
        assert!(Curve::through(vec![Vec2::ZERO; MAX_POINTS + 1]).is_none());
    }
    #[test]
    fn rows_of_one_property_multiply_and_angles_add() {
        let dynamics = Dynamics::none()
            .with(Property::Size, Input::Pressure, Curve::Share(1.0))
            .with(Property::Size, Input::Slope, through(&[(0.0, 1.0), (1.0, 0.5)]))
            .with(Property::Rotation, Input::Direction, Curve::Share(1.0))
            .with(Property::Rotation, Input::Tilt, Curve::Share(1.0));
        let inputs = DabInputs { pressure: 0.5, slope: 1.0, direction: 0.25, tilt: 0.5, ..DabInputs::default() };
        assert_eq!(dynamics.factor(Property::Size, &inputs), 0.25);
        assert_eq!(dynamics.turns(Property::Rotation, &inputs), 0.75);
        assert_eq!(dynamics.factor(Property::Flow, &inputs), 1.0);
    }
    #[test]
    fn a_row_takes_the_place_of_the_one_before_and_a_factor_of_one_is_none() {
        let plain = Dynamics::default();
        assert_eq!(plain.with_pressure(Property::Flow, 0.0), Dynamics::none());
        let twice = plain.with_pressure(Property::Flow, 0.25).with_pressure(Property::Flow, 0.5);
        assert_eq!((twice.drives().len(), twice.pressure_share(Property::Flow)), (1, 0.5));
    }
    #[test]
    fn directions_turn_counter_clockwise_as_seen() {
        let turns = [vec2(1.0, 0.0), vec2(0.0, -2.0), vec2(-1.0, 0.0), vec2(0.0, 3.0), Vec2::ZERO].map(turns_of);
        assert_eq!(turns, [0.0, 0.25, 0.5, 0.75, 0.0]);
        assert!(turns_of(vec2(1.0, 1e-9)) < 1.0);
    }
    #[test]
    fn what_is_random_differs_from_dab_to_dab_and_from_property_to_property() {
        let random = |seed, property| DabInputs { seed, ..DabInputs::default() }.of(Input::Random, property);
        assert_eq!(random(3, Property::Size), random(3, Property::Size));
        assert_ne!(random(3, Property::Size), random(4, Property::Size));
        assert_ne!(random(3, Property::Size), random(3, Property::Hue));
    }
}
