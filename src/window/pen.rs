//! The pen as the platform reports it: a [`PenSource`] gives its reports, and [`ReportFilter`]
//! passes the good ones on and ends a stroke whose reports become invalid. Floor 7. Sources:
//! `events`, the window's own (mouse, touch with its force, pens that come as touch, pens that come
//! as a pointer with a `tablet`'s axes); `recorded`, for tests. A platform's [`PenDevices`] give
//! the meaning of the axes: `x11`. Not here: the use of the reports (`canvas::pointer`).

mod events;
#[cfg(test)]
mod recorded;
mod report_filter;
mod tablet;
#[cfg(all(unix, not(target_os = "macos")))]
mod x11;

use crate::paint::Curve;
use eframe::egui::{PointerButton, Pos2};

pub use events::WindowPen;
#[cfg(test)]
pub use recorded::RecordedPen;
pub use report_filter::{FilteredReport, ReportFilter};
pub use tablet::{AxisMeaning, PenAxes, PenAxis, SharedTablet};

/// One report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PenReport {
    pub phase: PenPhase,
    /// Screen pt.
    pub at: Pos2,
    /// `[0, 1]`; `None` for devices without pressure.
    pub pressure: Option<f32>,
    /// Degrees from upright, right and down positive.
    pub tilt: (f32, f32),
    /// Seconds, by the clock of the source.
    pub secs: f64,
    /// The pen is held upside down.
    pub is_eraser: bool,
}

impl PenReport {
    /// The same with another pressure for each; what is not a number stays so.
    pub fn pressed_along(self, curve: &Curve) -> Self {
        let along = |pressed: f32| if pressed.is_finite() { curve.at(pressed) } else { pressed };
        Self { pressure: self.pressure.map(along), ..self }
    }
}

/// What the pen did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PenPhase {
    /// A barrel button is reported as its mouse button.
    Down(PointerButton),
    /// It moved, above the canvas or on it.
    Move,
    Up,
    /// It left the tablet, was unplugged, or was canceled by the platform: its stroke ends where
    /// it last was.
    Lost,
}

/// A source of a pen's reports, in order.
pub trait PenSource {
    /// The next report; `None` while there is none.
    fn next(&mut self) -> Option<PenReport>;
}

/// Reports which pen moves the pointer.
#[cfg(not(target_family = "wasm"))]
pub trait PenDevices {
    /// The axes of the device that moves the pointer now, if they changed since the last call.
    fn change(&mut self) -> Option<PenAxes>;
}

/// The platform's information on pens beyond its events; `None` if there is none.
#[cfg(all(unix, not(target_os = "macos")))]
pub fn devices<T>(events: &winit::event_loop::EventLoop<T>) -> Option<Box<dyn PenDevices>> {
    let is_x11 = winit::platform::x11::EventLoopExtX11::is_x11(events);
    let server = is_x11.then(x11::X11Server::connect).flatten()?;
    Some(Box::new(server))
}

/// What the platform of the window knows about pens beyond its events.
#[cfg(any(windows, target_os = "macos"))]
pub fn devices<T>(_: &winit::event_loop::EventLoop<T>) -> Option<Box<dyn PenDevices>> {
    None
}
