//! The window's own events as a pen: a mouse, a touch with the force that it reports (pens on
//! an old Windows, phones), or a pointer whose tablet reports pressure and tilt separately. Floor 7.

use super::tablet::PenState;
use super::{PenPhase, PenReport, PenSource, SharedTablet};
use eframe::egui::{Event, Pos2, TouchPhase};
use std::collections::VecDeque;

/// The pen in the window's events.
#[derive(Default)]
pub struct WindowPen {
    reports: VecDeque<PenReport>,
    at: Pos2,
    /// The state of the touch that is down.
    force: Option<f32>,
    /// Fingers and pens on the glass.
    touches: usize,
    has_felt_fingers: bool,
    tablet: Option<SharedTablet>,
    /// The last state of the tablet.
    held: PenState,
    is_down: bool,
}

impl WindowPen {
    /// The tablet that pointer and buttons may belong to.
    pub fn on(&mut self, tablet: SharedTablet) {
        self.tablet = Some(tablet);
    }

    /// Takes an event of a frame (`px_per_pt`: px per point) and turns it into reports.
    pub fn read_event(&mut self, event: &Event, px_per_pt: f32, now_secs: f64) {
        let phase = match *event {
            Event::Touch { phase, force, .. } => {
                match phase {
                    TouchPhase::Start => {
                        self.touches += 1;
                        // A pen that comes as a touch has a force.
                        self.has_felt_fingers |= force.is_none();
                    }
                    TouchPhase::End | TouchPhase::Cancel => {
                        self.touches = self.touches.saturating_sub(1)
                    }
                    TouchPhase::Move => {}
                }
                self.force = force.filter(|_| self.touches > 0);
                // The pointer's own events follow, unless the touch was canceled.
                (phase == TouchPhase::Cancel).then_some(PenPhase::Lost)
            }
            Event::PointerMoved(at) => {
                self.move_to(at, px_per_pt, now_secs);
                Some(PenPhase::Move)
            }
            Event::PointerButton { pos, button, pressed, .. } => {
                self.at = pos;
                self.is_down = pressed;
                Some(if pressed { PenPhase::Down(button) } else { PenPhase::Up(button) })
            }
            // When the window loses the focus, the release of a mouse button is not reported.
            Event::WindowFocused(false) => Some(PenPhase::Lost),
            _ => None,
        };
        let report = phase.map(|phase| self.report(phase, now_secs));
        self.reports.extend(report);
    }

    /// All events of a frame are processed.
    pub fn end_frame(&mut self) {
        if let Some(tablet) = &self.tablet {
            tablet.borrow_mut().drop_motions();
        }
    }

    fn move_to(&mut self, at: Pos2, px_per_pt: f32, now_secs: f64) {
        let at_px = [at.x * px_per_pt, at.y * px_per_pt].map(f64::from);
        if let Some(held) = self.tablet.as_ref().and_then(|tablet| tablet.borrow_mut().take(at_px))
        {
            // Another device took the pointer: a pen's stroke ends at its last place. With several
            // mice this may be reported late.
            if self.is_down && self.held.pressure.is_some() && held.device != self.held.device {
                self.is_down = false;
                self.reports.push_back(self.report(PenPhase::Lost, now_secs));
            }
            self.held = held;
        }
        self.at = at;
    }

    fn report(&self, phase: PenPhase, secs: f64) -> PenReport {
        let PenState { pressure, tilt, twist, is_eraser, .. } = self.held;
        let pressure = self.force.or(pressure);
        PenReport { phase, at: self.at, pressure, tilt, twist, secs, is_eraser }
    }

    /// Whether the screen was touched with a finger since the program started.
    pub fn has_felt_fingers(&self) -> bool {
        self.has_felt_fingers
    }

    /// The number of fingers and pens on the glass: two or more move the view instead of painting.
    pub fn touches(&self) -> usize {
        self.touches
    }
}

impl PenSource for WindowPen {
    fn next(&mut self) -> Option<PenReport> {
        self.reports.pop_front()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{AxisMeaning, PenAxes, PenAxis};
    use super::*;
    use eframe::egui::{Modifiers, PointerButton, TouchDeviceId, TouchId, pos2};

    fn touch(phase: TouchPhase, force: Option<f32>) -> Event {
        Event::Touch {
            device_id: TouchDeviceId(1),
            id: TouchId(1),
            phase,
            pos: pos2(3.0, 4.0),
            force,
        }
    }

    fn reports(events: &[Event]) -> Vec<(PenPhase, Option<f32>)> {
        let mut pen = WindowPen::default();
        events.iter().for_each(|event| pen.read_event(event, 1.0, 0.0));
        std::iter::from_fn(|| pen.next()).map(|report| (report.phase, report.pressure)).collect()
    }

    fn button(pressed: bool) -> Event {
        let (pos, button, modifiers) =
            (pos2(3.0, 4.0), PointerButton::Primary, Modifiers::default());
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
        let [down, up] = [PenPhase::Down, PenPhase::Up].map(|phase| phase(PointerButton::Primary));
        assert_eq!(reports(&events), [(down, Some(0.25)), (PenPhase::Move, Some(0.5)), (up, None)]);
    }

    #[test]
    fn a_touch_that_is_taken_away_is_lost_and_a_mouse_has_no_pressure() {
        let events =
            [touch(TouchPhase::Start, Some(1.0)), button(true), touch(TouchPhase::Cancel, None)];
        assert_eq!(reports(&events).last(), Some(&(PenPhase::Lost, None)));
        assert_eq!(reports(&[button(true)]), [(PenPhase::Down(PointerButton::Primary), None)]);
    }

    #[test]
    fn a_tablets_pressure_is_that_of_its_motion_at_any_scale_of_the_screen() {
        let tablet = SharedTablet::default();
        let axes = PenAxis::new(2, AxisMeaning::Pressure, (0.0, 1000.0), 0.0);
        tablet.borrow_mut().follow(PenAxes {
            device: 7,
            axes: axes.into_iter().collect(),
            is_eraser: true,
        });
        let mut pen = WindowPen::default();
        pen.on(tablet.clone());
        for (at_px, pressure) in [([33.25, 10.5], 250.0), ([36.0, 12.0], 500.0)] {
            tablet.borrow_mut().move_to(at_px);
            tablet.borrow_mut().axis(2, pressure);
        }
        pen.read_event(&Event::PointerMoved(pos2(33.25 / 1.5, 7.0)), 1.5, 0.0);
        pen.read_event(&Event::PointerMoved(pos2(24.0, 8.0)), 1.5, 0.0);
        let reports: Vec<_> =
            std::iter::from_fn(|| pen.next()).map(|r| (r.pressure, r.is_eraser)).collect();
        assert_eq!(reports, [(Some(0.25), true), (Some(0.5), true)]);
    }

    #[test]
    fn another_device_that_takes_the_pointer_ends_a_pens_stroke_and_no_mouses() {
        let ends = |first: Option<PenAxis>| {
            let tablet = SharedTablet::default();
            let mut pen = WindowPen::default();
            pen.on(tablet.clone());
            tablet.borrow_mut().follow(PenAxes {
                device: 7,
                axes: first.into_iter().collect(),
                is_eraser: false,
            });
            tablet.borrow_mut().move_to([3.0, 4.0]);
            pen.read_event(&Event::PointerMoved(pos2(3.0, 4.0)), 1.0, 0.0);
            pen.read_event(&button(true), 1.0, 0.0);
            tablet.borrow_mut().follow(PenAxes { device: 8, ..PenAxes::default() });
            tablet.borrow_mut().move_to([50.0, 60.0]);
            pen.read_event(&Event::PointerMoved(pos2(50.0, 60.0)), 1.0, 0.0);
            std::iter::from_fn(|| pen.next()).skip(2).map(|r| (r.phase, r.at)).collect::<Vec<_>>()
        };
        let moved = (PenPhase::Move, pos2(50.0, 60.0));
        assert_eq!(
            ends(PenAxis::new(2, AxisMeaning::Pressure, (0.0, 1.0), 0.5)),
            [(PenPhase::Lost, pos2(3.0, 4.0)), moved]
        );
        assert_eq!(ends(None), [moved]);
    }
}
