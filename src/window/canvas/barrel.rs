//! The buttons on a pen's barrel: what each does is a preference. Floor 7. A mouse's buttons keep
//! their meaning. Not here: the gestures (`pointer`).

use crate::pen::PenReport;
use crate::preferences::{BarrelAction, Preferences};
use eframe::egui::PointerButton;

/// What the buttons do, and which of them are held.
#[derive(Default)]
pub struct Barrel {
    preferred: Vec<(PointerButton, BarrelAction)>,
    held: Vec<(PointerButton, BarrelAction)>,
}

impl Barrel {
    /// From now on the buttons do what the user prefers.
    pub fn prefer(&mut self, preferences: &Preferences) {
        let action = Preferences::BARREL.map(|barrel| (barrel.button, (barrel.get)(preferences)));
        self.preferred = action.to_vec();
    }

    /// A button goes down: its action; `None` for a mouse, a pen's tip, or a button without a
    /// preference.
    pub fn press(&mut self, report: &PenReport, button: PointerButton) -> Option<BarrelAction> {
        // Without pressure it is a mouse's.
        report.pressure?;
        let (_, action) = self.preferred.iter().find(|(of, _)| *of == button)?;
        self.held.retain(|(held, _)| *held != button);
        self.held.push((button, *action));
        Some(*action)
    }

    pub fn release(&mut self, button: PointerButton) {
        self.held.retain(|(held, _)| *held != button);
    }

    /// The pen is gone.
    pub fn release_all(&mut self) {
        self.held.clear();
    }

    /// Whether a button that does this is held.
    pub fn is_held(&self, action: BarrelAction) -> bool {
        self.held.iter().any(|(_, of)| *of == action)
    }
}
