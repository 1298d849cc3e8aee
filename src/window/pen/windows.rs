//! Pens on Windows: what `GetPointerPenInfoHistory` says about one moment of a pen. Floor 7.
//! Compiled for tests everywhere. Not here: how Windows is asked (`hook`).

#[cfg(windows)]
mod hook;

use super::steps::{HeldButtons, PenMoment};
use super::tablet::PenState;

#[cfg(windows)]
pub use hook::WindowsPens;

/// `POINTER_FLAG_…`.
const IN_RANGE: u32 = 0x2;
const IN_CONTACT: u32 = 0x4;
const CANCELED: u32 = 0x8000;
/// `PEN_FLAG_…`.
const BARREL: u32 = 0x1;
const INVERTED: u32 = 0x2;
const ERASER: u32 = 0x4;
/// `PEN_MASK_…`: the values that the pen has.
const HAS_PRESSURE: u32 = 0x1;
const HAS_ROTATION: u32 = 0x2;
const HAS_TILT_X: u32 = 0x4;
const HAS_TILT_Y: u32 = 0x8;
/// The hardest pressure.
const HARDEST: f32 = 1024.0;

/// What marks a message of the mouse that Windows made of a pen or a finger, and the bit of a finger.
const MADE_OF_POINTER: usize = 0xFF51_5700;
const POINTER_MASK: usize = 0xFFFF_FF00;
const MADE_OF_FINGER: usize = 0x80;

/// Left, top, right, bottom.
pub type Edges = [i32; 4];

/// One entry of a pen's history, as Windows has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PointerReport {
    pub window: u64,
    /// `pointerId`: another one each time that the pen comes near.
    pub pointer: u32,
    /// `pointerFlags`.
    pub flags: u32,
    pub pen_flags: u32,
    pub pen_mask: u32,
    pub pressure: u32,
    /// Degrees clockwise.
    pub rotation: u32,
    /// Degrees from upright, right and toward the hand positive.
    pub tilt: [i32; 2],
    /// The screen's px, in whole numbers.
    pub pixel: [i32; 2],
    /// The tablet's hundredths of a millimeter: finer than a pixel.
    pub himetric: [i32; 2],
    /// The tablet, in hundredths of a millimeter, and the part of the screen that it covers, px;
    /// empty if Windows does not say.
    pub tablet: Edges,
    pub screen: Edges,
    /// The upper left corner of the window's inner area on the screen, px.
    pub origin: [i32; 2],
}

impl PointerReport {
    /// The pen at this moment.
    pub fn moment(&self) -> PenMoment {
        let is_canceled = self.flags & CANCELED != 0;
        let tip = self.flags & IN_CONTACT != 0 && !is_canceled;
        let held: HeldButtons = [tip, self.pen_flags & BARREL != 0, false, false];
        PenMoment {
            window: self.window,
            at_px: [0, 1].map(|axis| self.place_px(axis)),
            state: self.state(),
            is_near: self.flags & (IN_RANGE | IN_CONTACT) != 0 && !is_canceled,
            held,
        }
    }

    /// The place in the window, px.
    fn place_px(&self, axis: usize) -> f64 {
        let [least, most] = [axis, axis + 2];
        let span = |edges: &Edges| f64::from(edges[most]) - f64::from(edges[least]);
        let (tablet, screen) = (span(&self.tablet), span(&self.screen));
        let on_screen = if tablet > 0.0 && screen > 0.0 {
            let at = f64::from(self.himetric[axis]) - f64::from(self.tablet[least]);
            f64::from(self.screen[least]) + at / tablet * screen
        } else {
            f64::from(self.pixel[axis])
        };
        on_screen - f64::from(self.origin[axis])
    }

    fn state(&self) -> PenState {
        let has = |value: u32| self.pen_mask & value != 0;
        let tilt = |value: u32, axis: usize| {
            if has(value) { self.tilt[axis].clamp(-90, 90) as f32 } else { 0.0 }
        };
        PenState {
            device: self.pointer,
            pressure: has(HAS_PRESSURE).then(|| (self.pressure as f32 / HARDEST).min(1.0)),
            tilt: (tilt(HAS_TILT_X, 0), tilt(HAS_TILT_Y, 1)),
            twist: has(HAS_ROTATION).then_some((self.rotation % 360) as f32),
            is_eraser: self.pen_flags & (INVERTED | ERASER) != 0,
        }
    }
}

/// Whether Windows made a message of the mouse of a pen, by the message's `GetMessageExtraInfo`.
pub fn is_made_of_pen(extra: usize) -> bool {
    extra & POINTER_MASK == MADE_OF_POINTER && extra & MADE_OF_FINGER == 0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pen::PenStep;
    use crate::pen::recorded::numbers;
    use crate::pen::steps::PenFollower;
    use eframe::egui::PointerButton;

    /// `[flags, pen flags, mask, pressure, rotation, tilt x, tilt y, himetric x, himetric y]`.
    fn report(line: &[f64]) -> PointerReport {
        let whole = |i: usize| line[i] as i32;
        PointerReport {
            window: 7,
            pointer: 21,
            flags: line[0] as u32,
            pen_flags: line[1] as u32,
            pen_mask: line[2] as u32,
            pressure: line[3] as u32,
            rotation: line[4] as u32,
            tilt: [whole(5), whole(6)],
            pixel: [0, 0],
            himetric: [whole(7), whole(8)],
            tablet: [0, 0, 20_000, 10_000],
            screen: [1920, 0, 3920, 1000],
            origin: [2000, 100],
        }
    }

    fn steps(lines: &str) -> Vec<PenStep> {
        let (mut pen, mut steps) = (PenFollower::default(), Vec::new());
        for line in numbers(lines) {
            pen.follow(report(&line).moment(), &mut steps);
        }
        steps.into_iter().map(|(_, step)| step).collect()
    }

    /// Hovers, comes down, draws, lifts, leaves: flags as Windows sets them (update, down, up, in
    /// range, in contact, first button, primary, new).
    const STROKE: &str = "[139266, 0, 15, 0, 0, 10, -20, 4000, 3000]\n\
        [131074, 0, 15, 0, 0, 10, -20, 4000, 3000]\n\
        [73750, 0, 15, 256, 0, 10, -20, 4001, 3000]\n\
        [139286, 0, 15, 512, 90, 12, -20, 4005, 3010]\n\
        [270338, 0, 15, 0, 90, 12, -20, 4010, 3020]\n\
        [131072, 0, 15, 0, 90, 12, -20, 4010, 3020]";

    #[test]
    fn a_recorded_stroke_hovers_presses_draws_lifts_and_leaves() {
        let state = |pressure, twist, tilt| PenState {
            device: 21,
            pressure: Some(pressure),
            tilt,
            twist: Some(twist),
            is_eraser: false,
        };
        let first = (10.0, -20.0);
        let steps = steps(STROKE);
        let at = |i: usize| match steps[i] {
            PenStep::Move { at_px, state } => (at_px.map(|v| (v * 10.0).round() / 10.0), state),
            step => panic!("{step:?}"),
        };
        assert_eq!(at(0), ([320.0, 200.0], state(0.0, 0.0, first)));
        assert_eq!(at(1), ([320.1, 200.0], state(0.25, 0.0, first)));
        assert_eq!(steps[2], PenStep::Press(PointerButton::Primary));
        assert_eq!(at(3), ([320.5, 201.0], state(0.5, 90.0, (12.0, -20.0))));
        assert_eq!(at(4), ([321.0, 202.0], state(0.0, 90.0, (12.0, -20.0))));
        let ends = [PenStep::Release(PointerButton::Primary), PenStep::Leave];
        assert_eq!(steps[5..], ends);
    }

    #[test]
    fn the_other_end_erases_and_the_barrel_is_the_right_button() {
        let eraser = report(&[139_286.0, 6.0, 1.0, 1024.0, 0.0, 0.0, 0.0, 0.0, 0.0]).moment();
        assert!(eraser.state.is_eraser && eraser.held == [true, false, false, false]);
        assert_eq!(eraser.state.pressure, Some(1.0));
        let hovers = report(&[131_074.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]).moment();
        assert_eq!((hovers.held, hovers.is_near), ([false, true, false, false], true));
    }

    #[test]
    fn what_a_pen_does_not_have_is_not_read() {
        let state =
            report(&[139_286.0, 0.0, 0.0, 700.0, 45.0, 30.0, 30.0, 0.0, 0.0]).moment().state;
        assert_eq!(state, PenState { device: 21, ..PenState::default() });
        let wild = report(&[139_286.0, 0.0, 15.0, 9000.0, 725.0, 200.0, -99.0, 0.0, 0.0]).moment();
        assert_eq!((wild.state.pressure, wild.state.tilt), (Some(1.0), (90.0, -90.0)));
        assert_eq!(wild.state.twist, Some(5.0));
    }

    #[test]
    fn a_stroke_that_windows_cancels_is_released_where_it_was() {
        let canceled = STROKE.lines().take(4).collect::<Vec<_>>().join("\n")
            + "\n[294914, 0, 15, 512, 0, 0, 0, 0, 0]";
        let steps = steps(&canceled);
        let ends = [PenStep::Release(PointerButton::Primary), PenStep::Leave];
        assert_eq!(steps[steps.len() - 2..], ends);
    }

    #[test]
    fn a_tablet_without_edges_is_read_by_the_pixel() {
        let plain = PointerReport { pixel: [2100, 350], origin: [2000, 100], ..Default::default() };
        assert_eq!(plain.moment().at_px, [100.0, 250.0]);
    }

    #[test]
    fn a_mouse_that_is_made_of_a_pen_is_told_from_a_mouse_and_a_finger() {
        assert!(is_made_of_pen(0xFF51_5700) && is_made_of_pen(0xFF51_5703));
        assert!(!is_made_of_pen(0) && !is_made_of_pen(0xFF51_5780));
    }
}
