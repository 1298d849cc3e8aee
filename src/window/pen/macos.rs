//! Pens on macOS: what an `NSEvent` says about the pen that moves the pointer. Floor 7. Compiled
//! for tests everywhere. Not here: how the events are overheard (`monitor`).

#[cfg(target_os = "macos")]
mod monitor;

use super::tablet::PenState;

#[cfg(target_os = "macos")]
pub use monitor::MacPens;

/// `NSPointingDeviceType`: a puck reports no pressure, the eraser is the other end of a pen.
const PUCK: usize = 2;
const ERASER: usize = 3;
/// A tilt of 1.
const FARTHEST_DEGREES: f32 = 90.0;

/// What an event is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MacEvent {
    /// The pointer moved, or a button changed; `is_pen` is that the event's subtype is a tablet's
    /// point.
    Pointer { is_pen: bool },
    /// A pen changed that did not move: its pressure, or its tilt.
    Point,
    /// A pen came near, or left.
    Proximity { is_entering: bool, pointing_device: usize },
}

/// One event, as AppKit has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MacReport {
    pub event: MacEvent,
    /// `deviceID`: which pen.
    pub device: usize,
    /// The window's points, from the upper left.
    pub at_pt: [f64; 2],
    /// Px per point.
    pub scale: f64,
    /// `[0, 1]`.
    pub pressure: f32,
    /// `[-1, 1]`: right and away from the hand positive.
    pub tilt: [f64; 2],
    /// Degrees, in any range.
    pub rotation: f32,
}

/// Which pen is near, and how it is held.
#[derive(Clone, Copy, Debug, Default)]
pub struct MacPen {
    /// The pen's number and `NSPointingDeviceType`.
    near: Option<(usize, usize)>,
    state: PenState,
}

impl MacPen {
    /// Where the window's pointer comes next, px, and in which state; `None` for an event after
    /// which it does not move.
    pub fn read_report(&mut self, report: &MacReport) -> Option<([f64; 2], PenState)> {
        match report.event {
            MacEvent::Proximity { is_entering, pointing_device } => {
                self.near = is_entering.then_some((report.device, pointing_device));
                self.state = PenState::default();
                None
            }
            MacEvent::Point => {
                self.state = self.state_of(report);
                None
            }
            MacEvent::Pointer { is_pen } => {
                self.state = if is_pen { self.state_of(report) } else { PenState::default() };
                Some((report.at_pt.map(|v| v * report.scale), self.state))
            }
        }
    }

    fn state_of(&self, report: &MacReport) -> PenState {
        // A pen that was near when the program started is a pen until it comes near again.
        let near = self.near.filter(|(device, _)| *device == report.device);
        let pointing_device = near.map(|(_, kind)| kind);
        if pointing_device == Some(PUCK) {
            return PenState::default();
        }
        let degrees = report.tilt.map(|v| (v as f32).clamp(-1.0, 1.0) * FARTHEST_DEGREES);
        let is_eraser = pointing_device == Some(ERASER);
        PenState {
            // The number 0 is the mouse's.
            device: (report.device as u32).saturating_add(1),
            pressure: Some(report.pressure.clamp(0.0, 1.0)),
            tilt: (degrees[0], 0.0 - degrees[1]),
            twist: Some(report.rotation.rem_euclid(360.0)),
            is_eraser,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pen::recorded::numbers;

    /// `[event, device, x, y, pressure, tilt x, tilt y, rotation]`: event 0 is a mouse, 1 a pen's
    /// point in a mouse's event, 2 a point alone, 3 the pen leaving, from 10 on the pen coming as
    /// such a device.
    fn report(line: &[f64]) -> MacReport {
        let event = match line[0] as usize {
            0 => MacEvent::Pointer { is_pen: false },
            1 => MacEvent::Pointer { is_pen: true },
            2 => MacEvent::Point,
            3 => MacEvent::Proximity { is_entering: false, pointing_device: 0 },
            more => MacEvent::Proximity { is_entering: true, pointing_device: more - 10 },
        };
        MacReport {
            event,
            device: line[1] as usize,
            at_pt: [line[2], line[3]],
            scale: 2.0,
            pressure: line[4] as f32,
            tilt: [line[5], line[6]],
            rotation: line[7] as f32,
        }
    }

    fn places(lines: &str) -> Vec<([f64; 2], PenState)> {
        let mut pen = MacPen::default();
        numbers(lines).iter().filter_map(|line| pen.read_report(&report(line))).collect()
    }

    #[test]
    fn a_recorded_stroke_has_pressure_tilt_and_twist_where_the_pointer_comes() {
        let places = places(
            "[11, 4, 0, 0, 0, 0, 0, 0]\n\
             [1, 4, 10.25, 20, 0, 0.5, 0.25, -90]\n\
             [2, 4, 10.25, 20, 0.25, 0.5, 0.25, 0]\n\
             [1, 4, 11, 20.5, 0.5, 0.5, 0.25, 0]\n\
             [3, 4, 0, 0, 0, 0, 0, 0]\n\
             [0, 0, 30, 40, 1, 0, 0, 0]",
        );
        let state = |pressure, twist| PenState {
            device: 5,
            pressure: Some(pressure),
            tilt: (45.0, -22.5),
            twist: Some(twist),
            is_eraser: false,
        };
        assert_eq!(
            places,
            [
                ([20.5, 40.0], state(0.0, 270.0)),
                ([22.0, 41.0], state(0.5, 0.0)),
                // A mouse's event has a pressure of its own, which is none.
                ([60.0, 80.0], PenState::default()),
            ]
        );
    }

    #[test]
    fn the_other_end_erases_until_another_comes_near() {
        let places = places(
            "[13, 4, 0, 0, 0, 0, 0, 0]\n[1, 4, 1, 1, 0.5, 0, 0, 0]\n\
             [11, 6, 0, 0, 0, 0, 0, 0]\n[1, 6, 2, 2, 0.5, 0, 0, 0]\n\
             [12, 7, 0, 0, 0, 0, 0, 0]\n[1, 7, 3, 3, 0.5, 0, 0, 0]",
        );
        let ends: Vec<_> = places.iter().map(|(_, s)| (s.is_eraser, s.pressure)).collect();
        assert_eq!(ends, [(true, Some(0.5)), (false, Some(0.5)), (false, None)]);
    }

    #[test]
    fn a_pen_that_was_near_before_the_program_is_a_pen() {
        let places = places("[1, 4, 1, 1, 2.5, -3, 9, 725]");
        let (_, state) = places[0];
        assert_eq!((state.pressure, state.tilt), (Some(1.0), (-90.0, -90.0)));
        assert_eq!((state.twist, state.is_eraser), (Some(5.0), false));
    }
}
