//! The pen as tools see it.
//! Floor 5.

use crate::math::Vec2;
use crate::paint::Sample;

/// How near the pen must come to a handle, screen points.
pub const GRAB_PT: f32 = 10.0;

/// One sample of the pen with the modifier keys held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PenSample {
    /// Where the pen is, and how it is held.
    pub sample: Sample,
    /// The modifier keys that are held.
    pub keys: ModifierKeys,
}

/// The modifier keys, by their names on most keyboards.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct ModifierKeys {
    /// Shift.
    pub shift: bool,
    /// Ctrl, or Command.
    pub ctrl: bool,
    /// Alt.
    pub alt: bool,
}

impl PenSample {
    /// A mouse without keys.
    pub fn at(at: Vec2) -> Self {
        Self { sample: Sample::at(at), keys: ModifierKeys::default() }
    }

    /// The canvas point under the pen.
    pub fn place(&self) -> Vec2 {
        self.sample.at
    }
}
