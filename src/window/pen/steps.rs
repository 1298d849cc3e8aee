//! A pen that moves the pointer by itself: turns what the platform reports about it, moment by
//! moment, into the steps that the window takes. Floor 7. Not here: how a platform's numbers are
//! read (`windows`, `wayland`), and how the window takes the steps (`feed`).

use super::tablet::PenState;
use eframe::egui::PointerButton;

/// The buttons of a pen as those of the mouse: its tip, then those on its barrel.
pub const PEN_BUTTONS: [PointerButton; 4] = [
    PointerButton::Primary,
    PointerButton::Secondary,
    PointerButton::Middle,
    PointerButton::Extra1,
];

/// One of each of [`PEN_BUTTONS`].
pub type HeldButtons = [bool; PEN_BUTTONS.len()];

/// A pen at one moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PenMoment {
    /// The window that it is above, by the platform's number.
    pub window: u64,
    /// The window's px.
    pub at_px: [f64; 2],
    pub state: PenState,
    /// It touches the tablet, or is just above it.
    pub is_near: bool,
    pub held: HeldButtons,
}

/// What the window does about a pen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PenStep {
    /// The pointer moves.
    Move {
        at_px: [f64; 2],
        state: PenState,
    },
    Press(PointerButton),
    Release(PointerButton),
    /// The pointer leaves the window.
    Leave,
}

/// A step, and the window that takes it.
pub type WindowStep = (u64, PenStep);

/// Compares each moment of one pen with the one before.
#[derive(Clone, Copy, Debug, Default)]
pub struct PenFollower {
    /// While it is near.
    last: Option<PenMoment>,
}

impl PenFollower {
    /// The steps from the last moment to this one. A moment that is reported twice is no step.
    pub fn follow(&mut self, now: PenMoment, steps: &mut Vec<WindowStep>) {
        if self.last.is_some_and(|last| last.is_of_another_pen(&now)) {
            self.leave(steps);
        }
        let before = self.last;
        if !now.is_near {
            // It lifts at its last place and with its last pressure: where it went is unknown.
            self.leave(steps);
            return;
        }
        let is_moved = |last: PenMoment| (last.at_px, last.state) != (now.at_px, now.state);
        if before.is_none_or(is_moved) {
            steps.push((now.window, PenStep::Move { at_px: now.at_px, state: now.state }));
        }
        let held = before.map_or_else(HeldButtons::default, |last| last.held);
        push_changes(now.window, held, now.held, steps);
        self.last = Some(now);
    }

    /// The pen is gone: whatever it holds is released.
    pub fn leave(&mut self, steps: &mut Vec<WindowStep>) {
        if let Some(last) = self.last.take() {
            push_changes(last.window, last.held, HeldButtons::default(), steps);
            steps.push((last.window, PenStep::Leave));
        }
    }
}

impl PenMoment {
    /// The other end of a pen is another pen.
    fn is_of_another_pen(&self, other: &Self) -> bool {
        let ends = [self, other].map(|moment| (moment.state.device, moment.state.is_eraser));
        ends[0] != ends[1] || self.window != other.window
    }
}

/// Releases come before presses, and the barrel before the tip, whose press it may change.
fn push_changes(window: u64, from: HeldButtons, to: HeldButtons, steps: &mut Vec<WindowStep>) {
    let changes = PEN_BUTTONS.iter().zip(from.iter().zip(to));
    let released = changes.clone().filter(|(_, (was, is))| **was && !is);
    steps.extend(released.map(|(button, _)| (window, PenStep::Release(*button))));
    let pressed = changes.rev().filter(|(_, (was, is))| !**was && *is);
    steps.extend(pressed.map(|(button, _)| (window, PenStep::Press(*button))));
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIP: HeldButtons = [true, false, false, false];
    const BARREL: HeldButtons = [false, true, false, false];

    fn moment(x: f64, held: HeldButtons) -> PenMoment {
        let state = PenState { device: 3, pressure: Some(0.5), ..PenState::default() };
        PenMoment { window: 9, at_px: [x, 0.0], state, is_near: true, held }
    }

    fn steps(moments: &[PenMoment]) -> Vec<PenStep> {
        let (mut pen, mut steps) = (PenFollower::default(), Vec::new());
        moments.iter().for_each(|moment| pen.follow(*moment, &mut steps));
        assert!(steps.iter().all(|(window, _)| *window == 9));
        steps.into_iter().map(|(_, step)| step).collect()
    }

    fn move_to(x: f64) -> PenStep {
        PenStep::Move { at_px: [x, 0.0], state: moment(x, TIP).state }
    }

    #[test]
    fn a_pen_moves_before_it_presses_and_a_doubled_report_is_none() {
        let (hovers, down) = (moment(1.0, HeldButtons::default()), moment(2.0, TIP));
        assert_eq!(
            steps(&[hovers, hovers, down, down, moment(2.0, HeldButtons::default())]),
            [
                move_to(1.0),
                move_to(2.0),
                PenStep::Press(PointerButton::Primary),
                PenStep::Release(PointerButton::Primary)
            ]
        );
    }

    #[test]
    fn a_pen_that_leaves_releases_what_it_holds_where_it_was() {
        let gone = PenMoment { is_near: false, ..moment(70.0, TIP) };
        assert_eq!(
            steps(&[moment(1.0, TIP), gone, gone]),
            [
                move_to(1.0),
                PenStep::Press(PointerButton::Primary),
                PenStep::Release(PointerButton::Primary),
                PenStep::Leave
            ]
        );
    }

    #[test]
    fn a_button_of_the_barrel_changes_beside_the_tip() {
        let both = [true, true, false, false];
        assert_eq!(
            steps(&[moment(1.0, TIP), moment(1.0, both), moment(1.0, BARREL)])[1..],
            [
                PenStep::Press(PointerButton::Primary),
                PenStep::Press(PointerButton::Secondary),
                PenStep::Release(PointerButton::Primary)
            ]
        );
    }

    #[test]
    fn a_button_that_is_held_as_the_tip_comes_down_is_pressed_first() {
        let presses = [PointerButton::Secondary, PointerButton::Primary].map(PenStep::Press);
        assert_eq!(steps(&[moment(1.0, [true, true, false, false])])[1..], presses);
    }

    #[test]
    fn the_other_end_of_a_pen_begins_anew() {
        let mut eraser = moment(5.0, TIP);
        eraser.state.is_eraser = true;
        let steps = steps(&[moment(1.0, TIP), eraser]);
        assert_eq!(
            steps[2..4],
            [PenStep::Release(PointerButton::Primary), PenStep::Leave],
            "the tip ends its stroke"
        );
        assert_eq!(steps.len(), 6);
        assert_eq!(steps[5], PenStep::Press(PointerButton::Primary));
    }
}
