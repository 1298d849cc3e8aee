//! What a tip looks like: its kind and its numbers. Floor 7.

use crate::language::tr;
use crate::paint::Tip;
use crate::paint::tip::{Bristles, Noise};
use crate::widgets::NumberField;
use eframe::egui::Ui;

/// The kinds of tips. A picture is chosen by importing it.
#[derive(Clone, Copy, PartialEq)]
pub enum TipChoice {
    Round,
    Ellipse,
    Square,
    Bristles,
    Noise,
    Pictures,
}

impl TipChoice {
    /// Those that can be chosen, with their names.
    pub const LABELS: [(TipChoice, &str); 5] = [
        (TipChoice::Round, "round"),
        (TipChoice::Ellipse, "ellipse"),
        (TipChoice::Square, "square"),
        (TipChoice::Bristles, "bristles"),
        (TipChoice::Noise, "specks"),
    ];

    pub fn of(tip: &Tip) -> Self {
        match tip {
            Tip::Round => TipChoice::Round,
            Tip::Ellipse { .. } => TipChoice::Ellipse,
            Tip::Square { .. } => TipChoice::Square,
            Tip::Bristles(_) => TipChoice::Bristles,
            Tip::Noise(_) => TipChoice::Noise,
            Tip::Picture(_) | Tip::Hose(_) => TipChoice::Pictures,
        }
    }

    /// A tip of the kind as it begins.
    pub fn tip(self) -> Tip {
        match self {
            TipChoice::Round | TipChoice::Pictures => Tip::Round,
            TipChoice::Ellipse => Tip::Ellipse { ratio: 0.5 },
            TipChoice::Square => Tip::Square { ratio: 1.0 },
            TipChoice::Bristles => Tip::Bristles(Bristles::default()),
            TipChoice::Noise => Tip::Noise(Noise::default()),
        }
    }
}

/// The numbers that a kind has.
pub fn numbers(ui: &mut Ui, tip: &Tip) -> Option<Tip> {
    let ratios =
        || NumberField::new("Ratio", 0.01..=1.0, "Ratio of the shorter side to the longer one");
    let whole = |v: f32| v.round().max(1.0) as u32;
    match tip {
        Tip::Round => None,
        Tip::Ellipse { ratio } => ratios().row(ui, *ratio).map(|c| Tip::Ellipse { ratio: c.to }),
        Tip::Square { ratio } => ratios().row(ui, *ratio).map(|c| Tip::Square { ratio: c.to }),
        Tip::Bristles(bristles) => {
            let number =
                NumberField::new("Hairs", 1.0..=400.0, "How many hairs the brush has").decimals(0);
            let count = number.row(ui, bristles.count as f32).map(|c| whole(c.to));
            count.map(|count| Tip::Bristles(Bristles { count, ..*bristles }))
        }
        Tip::Noise(noise) => {
            let cells =
                NumberField::new("Specks", 1.0..=100.0, "Number along the diameter").decimals(0);
            let cells =
                cells.row(ui, noise.cells as f32).map(|c| Noise { cells: whole(c.to), ..*noise });
            let density = NumberField::new("Density", 0.0..=1.0, "How much of the tip they cover");
            let density = density.row(ui, noise.density).map(|c| Noise { density: c.to, ..*noise });
            cells.or(density).map(Tip::Noise)
        }
        Tip::Picture(_) | Tip::Hose(_) => {
            ui.weak(tr("Pictures. Import… adds others."));
            None
        }
    }
}
