//! A pen that moves the pointer like a mouse and reports pressure and tilt on separate axes: keeps
//! their values at each motion. Floor 7. Not here: which axes they are
//! ([`Devices`](super::PenDevices)).

use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

/// Updated by the event loop and read by the window, both on one thread.
pub type SharedTablet = Rc<RefCell<Tablet>>;

/// The most motions kept for a window that does not read them: more than a second of the fastest
/// pen.
const MOST_MOTIONS: usize = 4096;
/// Places within this distance are the same, px: the window rounds them to points and back.
const SAME_PX: f64 = 0.02;

/// The range of tilt that pens report.
const FARTHEST_DEGREES: f64 = 60.0;

/// The meaning of one axis of a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisMeaning {
    /// From nothing to the hardest.
    Pressure,
    /// Degrees from upright, to the right.
    TiltX,
    /// Degrees from upright, down.
    TiltY,
}

/// One axis of a device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PenAxis {
    /// Its number, by the platform.
    pub number: u32,
    /// What its values mean.
    pub reads: AxisMeaning,
    /// The least and the greatest value.
    pub range: (f64, f64),
    /// Its value when the device was found.
    pub value: f64,
}

impl PenAxis {
    /// `None` if the device reports an empty range.
    pub fn new(number: u32, reads: AxisMeaning, range: (f64, f64), value: f64) -> Option<Self> {
        (range.1 > range.0).then_some(Self { number, reads, range, value })
    }

    /// As a share of the range, `[0, 1]`. NaN stays NaN, and ends the stroke.
    fn ratio(&self, value: f64) -> f64 {
        ((value - self.range.0) / (self.range.1 - self.range.0)).clamp(0.0, 1.0)
    }

    /// The common drivers report degrees; any other range is taken to go from one side to the
    /// other.
    fn degrees(&self, value: f64) -> f64 {
        let is_degrees = self.range.0 < 0.0 && self.range.0 >= -90.0 && self.range.1 <= 90.0;
        if is_degrees {
            value.clamp(-90.0, 90.0)
        } else {
            (2.0 * self.ratio(value) - 1.0) * FARTHEST_DEGREES
        }
    }
}

/// The pen axes of one device; a mouse has none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PenAxes {
    /// The device, by the platform's number.
    pub device: u32,
    /// What it reports besides the place.
    pub axes: Vec<PenAxis>,
    /// Whether the device is the eraser end of a pen.
    pub is_eraser: bool,
}

/// The state of a pen at one motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PenState {
    /// The device, by a number of the platform's; 0 is a mouse.
    pub device: u32,
    /// `[0, 1]`; `None` for a mouse.
    pub pressure: Option<f32>,
    /// Degrees from upright, right and down positive, `[-90, 90]`.
    pub tilt: (f32, f32),
    /// How far it is turned about its own length, degrees clockwise, `[0, 360)`; `None` if it does
    /// not say.
    pub twist: Option<f32>,
    /// It is held upside down.
    pub is_eraser: bool,
}

/// The states of the pen at motions of the pointer that the window has not read yet.
#[derive(Debug, Default)]
pub struct Tablet {
    axes: PenAxes,
    held: PenState,
    /// Position, px, and state there.
    motions: VecDeque<([f64; 2], PenState)>,
}

impl Tablet {
    /// Another device moves the pointer from now on.
    pub fn follow(&mut self, axes: PenAxes) {
        self.held =
            PenState { device: axes.device, is_eraser: axes.is_eraser, ..PenState::default() };
        self.axes = axes;
        for axis in self.axes.axes.clone() {
            self.read(&axis, axis.value);
        }
    }

    /// The pointer moved to a place of the window, px; its axes follow.
    pub fn move_to(&mut self, at_px: [f64; 2]) {
        self.note(at_px, self.held);
    }

    /// The pointer comes to a place of the window, px, in a state of its own.
    pub fn note(&mut self, at_px: [f64; 2], state: PenState) {
        if self.motions.len() == MOST_MOTIONS {
            self.motions.pop_front();
        }
        self.motions.push_back((at_px, state));
    }

    /// Sets an axis of the last motion.
    pub fn axis(&mut self, number: u32, value: f64) {
        if let Some(axis) = self.axes.axes.iter().find(|axis| axis.number == number).copied() {
            self.read(&axis, value);
        }
        if let Some((_, held)) = self.motions.back_mut() {
            *held = self.held;
        }
    }

    fn read(&mut self, axis: &PenAxis, value: f64) {
        match axis.reads {
            AxisMeaning::Pressure => self.held.pressure = Some(axis.ratio(value) as f32),
            AxisMeaning::TiltX => self.held.tilt.0 = axis.degrees(value) as f32,
            AxisMeaning::TiltY => self.held.tilt.1 = axis.degrees(value) as f32,
        }
    }

    /// The state at the window's next motion, which went to this place, px; `None` if no device
    /// reported it.
    pub fn take(&mut self, at_px: [f64; 2]) -> Option<PenState> {
        let is_here =
            |at: [f64; 2]| (at[0] - at_px[0]).abs() < SAME_PX && (at[1] - at_px[1]).abs() < SAME_PX;
        let found = self.motions.iter().position(|&(at, _)| is_here(at))?;
        self.motions.drain(..=found).next_back().map(|(_, held)| held)
    }

    /// The window has read all motions.
    pub fn drop_motions(&mut self) {
        self.motions.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pen() -> Tablet {
        let axis = |number, reads, range| PenAxis::new(number, reads, range, 0.0);
        let axes = [
            axis(2, AxisMeaning::Pressure, (0.0, 2000.0)),
            axis(3, AxisMeaning::TiltX, (-64.0, 63.0)),
            axis(4, AxisMeaning::TiltY, (0.0, 100.0)),
            axis(5, AxisMeaning::Pressure, (7.0, 7.0)),
        ];
        let mut tablet = Tablet::default();
        tablet.follow(PenAxes {
            device: 9,
            axes: axes.into_iter().flatten().collect(),
            is_eraser: false,
        });
        tablet
    }

    #[test]
    fn each_motion_keeps_what_the_axes_told_after_it() {
        let mut pen = pen();
        for (x, pressure) in [(1.0, 500.0), (2.0, 1000.0), (3.0, 3000.0)] {
            pen.move_to([x, 0.0]);
            pen.axis(2, pressure);
        }
        pen.axis(3, 30.0);
        pen.axis(4, 75.0);
        let pressure = |held: Option<PenState>| held.and_then(|held| held.pressure);
        assert_eq!(pressure(pen.take([1.0, 0.0])), Some(0.25));
        // The window merged two motions: the second counts.
        let last = pen.take([3.0, 0.001]).unwrap();
        assert_eq!((last.pressure, last.tilt, last.device), (Some(1.0), (30.0, 30.0), 9));
        assert_eq!(pen.take([2.0, 0.0]), None);
    }

    #[test]
    fn a_mouse_has_no_pressure_after_a_pen_had() {
        let mut tablet = pen();
        tablet.follow(PenAxes::default());
        tablet.move_to([5.0, 5.0]);
        // The axis of a wheel is ignored.
        tablet.axis(3, 120.0);
        assert_eq!(tablet.take([5.0, 5.0]), Some(PenState::default()));
    }

    #[test]
    fn what_is_no_number_stays_none_and_an_empty_range_is_no_axis() {
        let mut pen = pen();
        pen.move_to([0.0, 0.0]);
        pen.axis(2, f64::NAN);
        assert!(pen.take([0.0, 0.0]).unwrap().pressure.unwrap().is_nan());
        assert_eq!(PenAxis::new(1, AxisMeaning::Pressure, (f64::NAN, 1.0), 0.0), None);
    }

    #[test]
    fn motions_that_nobody_reads_do_not_pile_up() {
        let mut pen = pen();
        (0..10_000).for_each(|i| pen.move_to([f64::from(i), 0.0]));
        assert_eq!(pen.motions.len(), MOST_MOTIONS);
        pen.drop_motions();
        assert_eq!(pen.take([9_999.0, 0.0]), None);
    }
}
