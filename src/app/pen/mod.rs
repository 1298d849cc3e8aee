//! The pen as a platform reports it, whichever that is: a [`PenSource`] says what the pen did, [`Watch`] makes good readings of
//! it and ends a stroke whose pen went bad.
//! Floor 7. Sources: `events`, the window's own (mouse, touch with its force, pens that come as touch); `recorded`, for tests.
//! Not here: what the reports do (`canvas::hand`).

mod events;
#[cfg(test)]
mod recorded;
mod watch;

use eframe::egui::{PointerButton, Pos2};

pub use events::WindowPen;
#[cfg(test)]
pub use recorded::RecordedPen;
pub use watch::{Reading, Watch};

/// One report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    pub phase: Phase,
    /// Screen pt.
    pub at: Pos2,
    /// `[0, 1]`; `None` of what cannot tell.
    pub pressure: Option<f32>,
    /// Degrees from upright, right and down positive.
    pub tilt: (f32, f32),
    /// By the clock of the source.
    pub secs: f64,
    /// The pen is held upside down.
    pub is_eraser: bool,
}

/// What the pen did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// A barrel button comes as the mouse's that it stands for.
    Down(PointerButton),
    /// Above the canvas or on it.
    Move,
    Up,
    /// It left the tablet's reach, was unplugged, or the platform took it away: whatever it drew ends where it last was.
    Lost,
}

/// Something that a pen's reports come from, in their order.
pub trait PenSource {
    /// The next report; `None` while there is none.
    fn next(&mut self) -> Option<Report>;
}
