//! Rows of numbers of parts, and the presets of inflation.
//! Floor 7.

use crate::document::Inflation;
use crate::language::tr;
use crate::widgets::{NumberField, ValueChange, sentence};
use eframe::egui::{Button, Ui};

/// A number in a row.
pub(super) struct NumberRow<'a> {
    pub(super) field: NumberField<'a>,
    pub(super) value: f32,
}

impl NumberRow<'_> {
    pub(super) fn show<T>(
        self,
        ui: &mut Ui,
        made: impl FnOnce(f32) -> T,
    ) -> Option<ValueChange<T>> {
        self.field.row(ui, self.value).map(|changed| changed.map(made))
    }
}

pub(super) fn number<'a>(
    label: &'a str,
    range: &crate::math::Range,
    hint: &'a str,
    value: f32,
) -> NumberRow<'a> {
    NumberRow { field: NumberField::new(label, range.clone(), hint), value }
}

/// Lengths: near 0 they are set more finely.
pub(super) fn length<'a>(
    label: &'a str,
    range: &crate::math::Range,
    hint: &'a str,
    value: f32,
) -> NumberRow<'a> {
    let row = number(label, range, hint, value);
    NumberRow { field: row.field.pixels().logarithmic(), ..row }
}

pub(super) fn degrees<'a>(
    label: &'a str,
    range: &crate::math::Range,
    hint: &'a str,
    value: f32,
) -> NumberRow<'a> {
    let row = number(label, range, hint, value);
    NumberRow { field: row.field.degrees(), ..row }
}

/// The presets as chips.
pub fn presets(ui: &mut Ui, now: Inflation) -> Option<Inflation> {
    let mut chosen = None;
    ui.horizontal_wrapped(|ui| {
        for (preset, word) in Inflation::PRESETS {
            let (word, hint) = (sentence(word), describe(word));
            let chip = Button::selectable(preset == now, tr(&word)).corner_radius(10);
            if ui.add(chip).on_hover_text(tr(hint)).clicked() {
                chosen = Some(preset);
            }
        }
    });
    chosen
}

fn describe(preset: &str) -> &'static str {
    match preset {
        "pillow" => "Round, as a cloth filled with air",
        "tube" => "Limbs as deep as they are wide",
        "relief" => "Half as high, with a rim that is not quite a silhouette",
        _ => "Nearly flat, with a rim that can be seen",
    }
}
