//! The pen as the platform reports it: a [`PenSource`] gives its reports, and [`ReportFilter`]
//! passes the good ones on and ends a stroke whose reports become invalid. Floor 7. Sources:
//! `events`, the window's own (mouse, touch with its force, pens that come as touch, pens that come
//! as a pointer with a `tablet`'s state); `recorded`, for tests. A platform's [`PenDevices`] know
//! the state: `x11`, `windows`, `macos`, `wayland`; `feed` carries it from them to the tablet, and
//! `steps` to the window's pointer where the platform does not move it for pens. Not here: the use
//! of the reports (`canvas::pointer`).

mod events;
#[cfg(not(target_family = "wasm"))]
mod feed;
#[cfg(any(target_os = "macos", test))]
mod macos;
#[cfg(test)]
mod recorded;
mod report_filter;
#[cfg(not(target_family = "wasm"))]
#[cfg_attr(target_os = "macos", allow(dead_code, reason = "macOS moves the pointer for pens"))]
mod steps;
mod tablet;
#[cfg(all(unix, not(target_os = "macos")))]
mod wayland;
#[cfg(any(windows, test))]
mod windows;
#[cfg(all(unix, not(target_os = "macos")))]
mod x11;

use crate::paint::Curve;
use eframe::egui::{PointerButton, Pos2};

pub use events::WindowPen;
#[cfg(not(target_family = "wasm"))]
pub use feed::PenFeed;
#[cfg(test)]
pub use recorded::RecordedPen;
pub use report_filter::{FilteredReport, ReportFilter};
#[cfg(not(target_family = "wasm"))]
pub use steps::PenStep;
pub use tablet::{AxisMeaning, PenAxes, PenAxis, PenState, SharedTablet};

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
    /// Degrees clockwise about its own length; `None` for devices that do not say.
    pub twist: Option<f32>,
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
    Up(PointerButton),
    /// It left the tablet, was unplugged, or was canceled by the platform: its stroke ends where
    /// it last was.
    Lost,
}

/// A source of a pen's reports, in order.
pub trait PenSource {
    /// The next report; `None` while there is none.
    fn next(&mut self) -> Option<PenReport>;
}

/// What a platform knows about its pens beyond the window's own events.
#[cfg(not(target_family = "wasm"))]
pub trait PenDevices {
    /// What happened since the last call, in order.
    fn read(&mut self) -> Vec<PenNews>;

    /// A window is open, by the platform's number.
    fn open(&mut self, _window: u64) {}

    /// A window has so many px per point.
    fn rescale(&mut self, _window: u64, _px_per_pt: f64) {}

    /// Whether the platform moves no pointer for pens: their news are [`PenNews::Step`].
    fn is_own_pointer(&self) -> bool {
        false
    }

    /// Whether every motion of the window's pointer is a [`PenNews::Feel`] before it comes, a
    /// mouse's too.
    fn has_all_motions(&self) -> bool {
        false
    }

    /// Whether news alone do not turn the window's loop.
    fn is_unheard_by_loop(&self) -> bool {
        false
    }
}

/// Something that a platform says about pens.
#[cfg(not(target_family = "wasm"))]
#[derive(Clone, Debug, PartialEq)]
#[allow(dead_code, reason = "each platform says some of them")]
pub enum PenNews {
    /// Another device moves the window's pointer; its axes come with the window's events.
    Follow(PenAxes),
    /// The window's pointer comes to this place next, px, in this state.
    Feel([f64; 2], PenState),
    /// A pen that does not move the window's pointer did this in this window.
    Step(u64, PenStep),
}

/// The platform's information on pens beyond its events; `None` if there is none.
#[cfg(all(unix, not(target_os = "macos")))]
pub fn devices<T>(events: &winit::event_loop::EventLoop<T>) -> Option<Box<dyn PenDevices>> {
    use winit::raw_window_handle::{HasDisplayHandle, RawDisplayHandle};
    if winit::platform::x11::EventLoopExtX11::is_x11(events) {
        return Some(Box::new(x11::X11Server::connect()?));
    }
    let RawDisplayHandle::Wayland(display) = events.display_handle().ok()?.as_raw() else {
        return None;
    };
    // SAFETY: the display is that of the window's loop, which alone reads the pens.
    let compositor = unsafe { wayland::WaylandPens::connect(display.display) };
    Some(Box::new(compositor?))
}

/// What Windows knows about pens beyond the window's events; `None` if that is nothing.
#[cfg(windows)]
pub fn devices<T>(_: &winit::event_loop::EventLoop<T>) -> Option<Box<dyn PenDevices>> {
    Some(Box::new(windows::WindowsPens::find()?))
}

/// What macOS knows about pens beyond the window's events; `None` if that is nothing.
#[cfg(target_os = "macos")]
pub fn devices<T>(_: &winit::event_loop::EventLoop<T>) -> Option<Box<dyn PenDevices>> {
    Some(Box::new(macos::MacPens::listen()?))
}
