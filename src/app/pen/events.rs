//! The window's own events as a pen: a mouse, or a touch with the force that it reports (pens on Windows, phones and the web).
//! Floor 7.

use super::{PenSource, Phase, Report};
use eframe::egui::{Event, Pos2, TouchPhase};
use std::collections::VecDeque;

/// The pen in the window's events.
#[derive(Default)]
pub struct WindowPen {
    reports: VecDeque<Report>,
    at: Pos2,
    /// Of the touch that is down.
    force: Option<f32>,
    /// Fingers and pens on the glass.
    touches: usize,
}

impl WindowPen {
    /// Hears an event of a frame; what the pen did comes out as reports.
    pub fn hear(&mut self, event: &Event, now_secs: f64) {
        let phase = match *event {
            Event::Touch { phase, force, .. } => {
                match phase {
                    TouchPhase::Start => self.touches += 1,
                    TouchPhase::End | TouchPhase::Cancel => self.touches = self.touches.saturating_sub(1),
                    TouchPhase::Move => {}
                }
                self.force = force.filter(|_| self.touches > 0);
                // The pointer's own events follow, except where the touch was taken away.
                (phase == TouchPhase::Cancel).then_some(Phase::Lost)
            }
            Event::PointerMoved(at) => {
                self.at = at;
                Some(Phase::Move)
            }
            Event::PointerButton { pos, button, pressed, .. } => {
                self.at = pos;
                Some(if pressed { Phase::Down(button) } else { Phase::Up })
            }
            // A mouse's button goes up elsewhere when the window loses the keyboard, and nobody tells.
            Event::WindowFocused(false) => Some(Phase::Lost),
            _ => None,
        };
        let report = |phase| Report {
            phase,
            at: self.at,
            pressure: self.force,
            tilt: (0.0, 0.0),
            secs: now_secs,
            is_eraser: false,
        };
        self.reports.extend(phase.map(report));
    }
    /// How many fingers and pens are on the glass: two or more look, they do not paint.
    pub fn touches(&self) -> usize {
        self.touches
    }
}

impl PenSource for WindowPen {
    fn next(&mut self) -> Option<Report> {
        self.reports.pop_front()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::{Modifiers, PointerButton, TouchDeviceId, TouchId, pos2};

    fn touch(phase: TouchPhase, force: Option<f32>) -> Event {
        Event::Touch { device_id: TouchDeviceId(1), id: TouchId(1), phase, pos: pos2(3.0, 4.0), force }
    }
    fn reports(events: &[Event]) -> Vec<(Phase, Option<f32>)> {
        let mut pen = WindowPen::default();
        events.iter().for_each(|event| pen.hear(event, 0.0));
        std::iter::from_fn(|| pen.next()).map(|report| (report.phase, report.pressure)).collect()
    }
    fn button(pressed: bool) -> Event {
        let (pos, button, modifiers) = (pos2(3.0, 4.0), PointerButton::Primary, Modifiers::default());
        Event::PointerButton { pos, button, pressed, modifiers }
    }

    #[test]
    fn a_touchs_force_is_the_pressure_of_the_pointer_that_follows_it() {
        let events = [
            touch(TouchPhase::Start, Some(0.25)),
            button(true),
            touch(TouchPhase::Move, Some(0.5)),
            Event::PointerMoved(pos2(9.0, 9.0)),
            touch(TouchPhase::End, None),
            button(false),
        ];
        let down = Phase::Down(PointerButton::Primary);
        assert_eq!(reports(&events), [(down, Some(0.25)), (Phase::Move, Some(0.5)), (Phase::Up, None)]);
    }
    #[test]
    fn a_touch_that_is_taken_away_is_lost_and_a_mouse_has_no_pressure() {
        let events = [touch(TouchPhase::Start, Some(1.0)), button(true), touch(TouchPhase::Cancel, None)];
        assert_eq!(reports(&events).last(), Some(&(Phase::Lost, None)));
        assert_eq!(reports(&[button(true)]), [(Phase::Down(PointerButton::Primary), None)]);
    }
}
