//! Pens on Wayland: what `zwp_tablet_tool_v2` says, event by event until a frame's end. Floor 7.
//! Not here: how the compositor is asked (`listener`).

mod listener;

use super::steps::{HeldButtons, PenFollower, PenMoment, WindowStep};
use super::tablet::PenState;

pub use listener::WaylandPens;

/// The hardest pressure.
const HARDEST: f32 = 65_535.0;
/// `zwp_tablet_tool_v2.type`: the other end of a pen.
const ERASER: u32 = 0x141;
/// The buttons on the barrel, by the kernel's numbers, in the order of [`HeldButtons`] after the
/// tip: compositors without pens take the first for the right button too.
const BARREL: [u32; 3] = [0x14b, 0x14c, 0x149];

/// One event of a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ToolEvent {
    Kind(u32),
    HasPressure,
    HasRotation,
    /// It came near above a window, by the number of the window's surface.
    Near {
        surface: u64,
    },
    Far,
    Down,
    Up,
    /// The surface's points.
    Motion(f64, f64),
    Pressure(u32),
    /// Degrees from upright, right and down positive.
    Tilt(f64, f64),
    /// Degrees clockwise.
    Rotation(f64),
    Button {
        number: u32,
        pressed: bool,
    },
    /// All events since the last frame happened at once.
    Frame,
    /// It was unplugged.
    Removed,
}

/// One tool: an end of a pen, a brush, an airbrush.
#[derive(Clone, Copy, Debug, Default)]
pub struct WaylandTool {
    kind: u32,
    device: u32,
    has_pressure: bool,
    has_rotation: bool,
    surface: Option<u64>,
    at_pt: [f64; 2],
    pressure: u32,
    tilt: (f32, f32),
    rotation: f32,
    held: HeldButtons,
    follower: PenFollower,
}

impl WaylandTool {
    /// A tool with a number that no other one has; 0 is the mouse's.
    pub fn new(device: u32) -> Self {
        Self { device, ..Self::default() }
    }

    /// Takes an event; `scale` is px per point of a surface.
    pub fn read_event(
        &mut self,
        event: ToolEvent,
        scale: impl Fn(u64) -> f64,
        steps: &mut Vec<WindowStep>,
    ) {
        match event {
            ToolEvent::Kind(kind) => self.kind = kind,
            ToolEvent::HasPressure => self.has_pressure = true,
            ToolEvent::HasRotation => self.has_rotation = true,
            ToolEvent::Near { surface } => self.surface = Some(surface),
            ToolEvent::Far => {
                (self.surface, self.pressure) = (None, 0);
                self.held = HeldButtons::default();
            }
            ToolEvent::Down => self.held[0] = true,
            ToolEvent::Up => self.held[0] = false,
            ToolEvent::Motion(x, y) => self.at_pt = [x, y],
            ToolEvent::Pressure(pressure) => self.pressure = pressure,
            ToolEvent::Tilt(x, y) => {
                self.tilt = (x.clamp(-90.0, 90.0) as f32, y.clamp(-90.0, 90.0) as f32)
            }
            ToolEvent::Rotation(degrees) => self.rotation = degrees.rem_euclid(360.0) as f32,
            ToolEvent::Button { number, pressed } => {
                if let Some(i) = BARREL.iter().position(|button| *button == number) {
                    self.held[i + 1] = pressed;
                }
            }
            ToolEvent::Frame => match self.surface {
                Some(window) => self.follower.follow(self.moment(window, scale(window)), steps),
                None => self.follower.leave(steps),
            },
            ToolEvent::Removed => self.follower.leave(steps),
        }
    }

    fn moment(&self, window: u64, scale: f64) -> PenMoment {
        let state = PenState {
            device: self.device,
            pressure: self.has_pressure.then(|| (self.pressure as f32 / HARDEST).min(1.0)),
            tilt: self.tilt,
            twist: self.has_rotation.then_some(self.rotation),
            is_eraser: self.kind == ERASER,
        };
        let at_px = self.at_pt.map(|v| v * scale);
        PenMoment { window, at_px, state, is_near: true, held: self.held }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pen::PenStep;
    use crate::pen::recorded::named;
    use eframe::egui::PointerButton;

    /// `["motion", x, y]` and the like, by the protocol's names.
    fn event(name: &str, numbers: &[f64]) -> ToolEvent {
        let whole = |i: usize| numbers[i] as u32;
        match name {
            "type" => ToolEvent::Kind(whole(0)),
            "capability" if whole(0) == 2 => ToolEvent::HasPressure,
            "capability" => ToolEvent::HasRotation,
            "proximity_in" => ToolEvent::Near { surface: u64::from(whole(0)) },
            "proximity_out" => ToolEvent::Far,
            "down" => ToolEvent::Down,
            "up" => ToolEvent::Up,
            "motion" => ToolEvent::Motion(numbers[0], numbers[1]),
            "pressure" => ToolEvent::Pressure(whole(0)),
            "tilt" => ToolEvent::Tilt(numbers[0], numbers[1]),
            "rotation" => ToolEvent::Rotation(numbers[0]),
            "button" => ToolEvent::Button { number: whole(0), pressed: whole(1) == 1 },
            "frame" => ToolEvent::Frame,
            "removed" => ToolEvent::Removed,
            other => panic!("{other}"),
        }
    }

    fn steps(lines: &str) -> Vec<PenStep> {
        let (mut tool, mut steps) = (WaylandTool::new(5), Vec::new());
        for (name, numbers) in named(lines) {
            tool.read_event(event(&name, &numbers), |_| 1.5, &mut steps);
        }
        assert!(steps.iter().all(|(window, _)| *window == 42));
        steps.into_iter().map(|(_, step)| step).collect()
    }

    const HEAD: &str = "[\"type\", 320]\n[\"capability\", 2]\n[\"proximity_in\", 42]\n";

    #[test]
    fn a_recorded_stroke_has_pressure_tilt_and_twist_at_each_frame() {
        let steps = steps(&format!(
            "{HEAD}[\"capability\", 4]\n[\"motion\", 10, 20]\n[\"tilt\", 12.5, -30]\n[\"frame\"]\n\
             [\"down\"]\n[\"pressure\", 13107]\n[\"frame\"]\n\
             [\"motion\", 11, 20.5]\n[\"pressure\", 65535]\n[\"rotation\", -45]\n[\"frame\"]\n\
             [\"frame\"]\n[\"up\"]\n[\"pressure\", 0]\n[\"frame\"]\n[\"proximity_out\"]\n[\"frame\"]"
        ));
        let place = |x, y, pressure, twist| PenStep::Move {
            at_px: [x, y],
            state: PenState {
                device: 5,
                pressure: Some(pressure),
                tilt: (12.5, -30.0),
                twist: Some(twist),
                is_eraser: false,
            },
        };
        assert_eq!(
            steps,
            [
                place(15.0, 30.0, 0.0, 0.0),
                place(15.0, 30.0, 0.2, 0.0),
                PenStep::Press(PointerButton::Primary),
                place(16.5, 30.75, 1.0, 315.0),
                place(16.5, 30.75, 0.0, 315.0),
                PenStep::Release(PointerButton::Primary),
                PenStep::Leave,
            ]
        );
    }

    #[test]
    fn a_tool_that_is_unplugged_in_a_stroke_releases_it() {
        for end in ["[\"removed\"]", "[\"proximity_out\"]\n[\"frame\"]"] {
            let steps = steps(&format!("{HEAD}[\"down\"]\n[\"frame\"]\n{end}"));
            let ends = [PenStep::Release(PointerButton::Primary), PenStep::Leave];
            assert_eq!(steps[steps.len() - 2..], ends, "{end}");
        }
    }

    #[test]
    fn the_barrel_has_three_buttons_and_others_are_none() {
        for (number, button) in [
            (0x14b, Some(PointerButton::Secondary)),
            (0x14c, Some(PointerButton::Middle)),
            (0x149, Some(PointerButton::Extra1)),
            (0x110, None),
        ] {
            let steps =
                steps(&format!("{HEAD}[\"frame\"]\n[\"button\", {number}, 1]\n[\"frame\"]"));
            assert_eq!(steps.get(1).copied(), button.map(PenStep::Press), "{number:#x}");
        }
    }

    #[test]
    fn an_eraser_erases_and_a_tool_without_pressure_is_a_mouse() {
        let steps =
            steps("[\"type\", 321]\n[\"proximity_in\", 42]\n[\"pressure\", 9]\n[\"frame\"]");
        let state = PenState { device: 5, is_eraser: true, ..PenState::default() };
        assert_eq!(steps, [PenStep::Move { at_px: [0.0, 0.0], state }]);
    }
}
