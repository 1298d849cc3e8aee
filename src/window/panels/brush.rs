//! The editor of the current brush: tip, spread, grain, stabilizer and dynamics. Floor 7. Not here:
//! the second tip (`dual_brush`), the list of brushes (`brushes`), the curve widget (`curve`).

use super::brush_tip::{self, TipChoice};
use super::words::translate_within;
use super::{curve, dual_brush};
use crate::io::recipe::brush_to_json;
use crate::language::tr;
use crate::math::NumberSetting;
use crate::paint::brush_options::{Bearing, DistanceMetric, Falloff, Spread};
use crate::paint::grain::{BrushGrain, GrainSource, GrainSpace};
use crate::paint::pattern::Pattern;
use crate::paint::settings::SETTINGS;
use crate::paint::{Brush, Curve, Drive, Dynamics, Input, Property, Stabilizer};
use crate::raster::BlendMode;
use crate::requests::UiRequests;
use crate::session::actions::HandAction;
use crate::session::{Action, Session};
use crate::tr;
use crate::widgets::{NumberField, check, choice_row, sentence, set_accessible_name, tr_sentence};
use eframe::egui::{self, Ui};

/// The sections of the brush editor that can be unfolded.
pub fn show(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let brush = &session.tools.brush;
    let mut changed = None;
    let mut part = |ui: &mut Ui, label: &str, show: &mut dyn FnMut(&mut Ui) -> Option<Brush>| {
        let header = egui::CollapsingHeader::new(tr(label)).id_salt(("brush", label));
        changed = header.show(ui, show).body_returned.flatten().or(changed.take());
    };
    part(ui, "Tip", &mut |ui| tip(ui, brush));
    part(ui, "Spread and color", &mut |ui| spread(ui, brush));
    part(ui, "Grain", &mut |ui| grain(ui, brush));
    part(ui, "Dual brush", &mut |ui| dual_brush::show(ui, session, requests));
    part(ui, "Stroke", &mut |ui| stroke(ui, brush));
    part(ui, "Mixing and stylus", &mut |ui| mixing_and_stylus(ui, brush));
    part(ui, "Dynamics", &mut |ui| dynamics(ui, brush));
    if let Some(brush) = changed {
        requests.act(Action::Hand(HandAction::Brush { brush: brush_to_json(&brush) }));
    }
}

fn tip(ui: &mut Ui, brush: &Brush) -> Option<Brush> {
    let chosen = choice_row(ui, "Shape", TipChoice::of(&brush.tip), &TipChoice::LABELS);
    let tip = chosen.map(TipChoice::tip).or(brush_tip::numbers(ui, &brush.tip))?;
    Some(Brush { tip, ..brush.clone() })
}

fn spread(ui: &mut Ui, brush: &Brush) -> Option<Brush> {
    let mut to = brush.clone();
    let mut changed = false;
    let mut number = |ui: &mut Ui, number: NumberField, value: &mut f32| {
        if let Some(c) = number.row(ui, *value) {
            (*value, changed) = (c.to, true);
        }
    };
    number(
        ui,
        NumberField::new(
            "Scatter",
            0.0..=4.0,
            "Greatest distance of a dab from the stroke, in diameters",
        ),
        &mut to.scatter,
    );
    let jitter = &mut to.jitter;
    let hues = NumberField::new("Hue ±", 0.0..=180.0, "Greatest random difference of a dab's hue")
        .degrees();
    number(ui, hues, &mut jitter.hue_degrees);
    number(
        ui,
        NumberField::new(
            "Saturation ±",
            0.0..=1.0,
            "Greatest random difference of a dab's saturation",
        ),
        &mut jitter.saturation,
    );
    number(
        ui,
        NumberField::new("Value ±", 0.0..=1.0, "How much lighter or darker a dab may be"),
        &mut jitter.value,
    );
    changed.then_some(to)
}

/// `None`: no grain.
const PATTERNS: [(Option<Pattern>, &str); 6] = [
    (None, "none"),
    (Some(Pattern::Paper), "paper"),
    (Some(Pattern::Weave), "weave"),
    (Some(Pattern::Scales), "scales"),
    (Some(Pattern::Lines), "lines"),
    (Some(Pattern::Dots), "dots"),
];

fn grain(ui: &mut Ui, brush: &Brush) -> Option<Brush> {
    let pattern = match brush.grain.as_ref().map(|grain| &grain.source) {
        Some(GrainSource::Pattern { pattern, .. }) => Some(*pattern),
        _ => None,
    };
    let chosen = choice_row(ui, "Pattern", pattern, &PATTERNS).map(|pattern| {
        let like = brush.grain.clone().unwrap_or_default();
        pattern
            .map(|pattern| BrushGrain { source: GrainSource::Pattern { pattern, seed: 0 }, ..like })
    });
    let of_grain = |grain: Option<BrushGrain>| Brush { grain, ..brush.clone() };
    let Some(grain) = &brush.grain else { return chosen.map(of_grain) };
    let mut to = grain.clone();
    let mut changed = false;
    let mut number = |ui: &mut Ui, number: NumberField, value: &mut f32| {
        if let Some(c) = number.row(ui, *value) {
            (*value, changed) = (c.to, true);
        }
    };
    number(
        ui,
        NumberField::new("Size", 1.0..=400.0, "Size of one feature of the pattern").px(),
        &mut to.size_px,
    );
    number(
        ui,
        NumberField::new("Strength", 0.0..=1.0, "How much paint the valleys lose"),
        &mut to.strength,
    );
    number(
        ui,
        NumberField::new("Turn", -180.0..=180.0, "Counter-clockwise").degrees(),
        &mut to.rotation,
    );
    const SPACES: [(&str, GrainSpace, &str); 3] = [
        ("On the canvas", GrainSpace::Canvas, "The grain is flat on the canvas"),
        (
            "On the surface",
            GrainSpace::Unwrapped,
            "The grain follows the surface, at the same size everywhere",
        ),
        (
            "By depth",
            GrainSpace::Surface { gamma: 1.0 },
            "The grain is larger where the surface is nearer",
        ),
    ];
    ui.horizontal_wrapped(|ui| {
        for (label, lies, hint) in SPACES {
            let is_on = grain.lies.plain() == lies;
            if ui.selectable_label(is_on, tr(label)).on_hover_text(tr(hint)).clicked() && !is_on {
                (to.lies, changed) = (lies, true);
            }
        }
    });
    if let GrainSpace::Surface { gamma } = &mut to.lies {
        let gammas =
            NumberField::new("Depth γ", 0.0..=4.0, "How strongly the grain follows the depth");
        if let Some(c) = gammas.row(ui, *gamma) {
            (*gamma, changed) = (c.to, true);
        }
    }
    chosen.or(changed.then_some(Some(to))).map(of_grain)
}

/// The kinds of stabilizer.
#[derive(Clone, Copy, PartialEq)]
enum StabilizerChoice {
    None,
    Average,
    String,
    Lag,
}

const STABILIZERS: [(StabilizerChoice, &str); 4] = [
    (StabilizerChoice::None, "none"),
    (StabilizerChoice::Average, "trailing average"),
    (StabilizerChoice::String, "pulled string"),
    (StabilizerChoice::Lag, "late line"),
];

fn stroke(ui: &mut Ui, brush: &Brush) -> Option<Brush> {
    let kind = match brush.stabilizer {
        Stabilizer::None => StabilizerChoice::None,
        Stabilizer::Average { .. } => StabilizerChoice::Average,
        Stabilizer::String { .. } => StabilizerChoice::String,
        Stabilizer::Lag { .. } => StabilizerChoice::Lag,
    };
    let chosen = choice_row(ui, "Stabilizer", kind, &STABILIZERS).map(|kind| match kind {
        StabilizerChoice::None => Stabilizer::None,
        StabilizerChoice::Average => Stabilizer::Average { weight: 0.7 },
        StabilizerChoice::String => Stabilizer::String { length_px: 30.0 },
        StabilizerChoice::Lag => Stabilizer::Lag { secs: 0.05 },
    });
    let amount = match brush.stabilizer {
        Stabilizer::None => None,
        Stabilizer::Average { weight } => {
            let number = NumberField::new(
                "Weight",
                0.0..=0.98,
                "How much of the earlier path still counts after ten pixels",
            );
            number.row(ui, weight).map(|c| Stabilizer::Average { weight: c.to })
        }
        Stabilizer::String { length_px } => {
            let number = NumberField::new(
                "Length",
                1.0..=300.0,
                "The pen pulls the line on a string this long",
            )
            .px();
            number.row(ui, length_px).map(|c| Stabilizer::String { length_px: c.to })
        }
        Stabilizer::Lag { secs } => {
            let number =
                NumberField::new("Seconds", 0.0..=1.0, "How late the line comes after the pen");
            number.row(ui, secs).map(|c| Stabilizer::Lag { secs: c.to })
        }
    };
    let has_length =
        matches!(brush.stabilizer, Stabilizer::Average { .. } | Stabilizer::String { .. });
    let measured = has_length
        .then(|| choice_row(ui, "Smooth on", brush.stabilizer_on, &DistanceMetric::ALL))
        .flatten();
    let stabilized = chosen.or(amount).map(|stabilizer| Brush { stabilizer, ..brush.clone() });
    let stabilized =
        stabilized.or(measured.map(|stabilizer_on| Brush { stabilizer_on, ..brush.clone() }));
    let blended = choice_row(ui, "Blend", brush.blend, &BlendMode::LABELS)
        .map(|blend| Brush { blend, ..brush.clone() });
    let erases = check(ui, "Erases", "The stroke erases", brush.erases);
    let erases = erases.map(|erases| Brush { erases, ..brush.clone() });
    let keeps = check(
        ui,
        "Keeps alpha",
        "The stroke is visible only where there is paint",
        brush.keeps_alpha,
    );
    let keeps = keeps.map(|keeps_alpha| Brush { keeps_alpha, ..brush.clone() });
    stabilized.or(blended).or(erases).or(keeps)
}

/// The hints of how a brush mixes and follows the stylus, in their order.
fn mixing_and_stylus(ui: &mut Ui, brush: &Brush) -> Option<Brush> {
    let mut to = brush.clone();
    let mut changed = false;
    let mut took = |is_chosen: bool| changed |= is_chosen;
    for setting in &SETTINGS {
        let NumberSetting { label, hint, range, .. } = &setting.number;
        let change = NumberField::new(label, range.clone(), hint).row(ui, setting.of(brush));
        took(change.is_some());
        if let Some(change) = change {
            setting.set(&mut to, change.to);
        }
    }
    let chosen = choice_row(ui, "Offset from", to.offset.from, &Bearing::ALL);
    took(chosen.is_some());
    to.offset.from = chosen.unwrap_or(to.offset.from);
    let chosen =
        check(ui, "Alternate sides", "Every other dab is on the other side", to.offset.alternates);
    took(chosen.is_some());
    to.offset.alternates = chosen.unwrap_or(to.offset.alternates);
    let chosen = choice_row(ui, "Scatter shape", to.spread, &Spread::ALL);
    took(chosen.is_some());
    to.spread = chosen.unwrap_or(to.spread);
    let chosen = choice_row(ui, "Spacing on", to.spacing_on, &DistanceMetric::ALL);
    took(chosen.is_some());
    to.spacing_on = chosen.unwrap_or(to.spacing_on);
    let chosen = choice_row(ui, "Falloff", to.falloff, &Falloff::ALL);
    took(chosen.is_some());
    to.falloff = chosen.unwrap_or(to.falloff);
    changed.then_some(to)
}

fn dynamics(ui: &mut Ui, brush: &Brush) -> Option<Brush> {
    let mut to: Option<Dynamics> = None;
    for Drive { property, input, curve: shape } in brush.dynamics.drives() {
        let (property_name, input_name) =
            (word(&Property::ALL, property), word(&Input::ALL, input));
        let (what, by) = (tr(&property_name), translate_within(&input_name));
        let label = match shape.is_additive() {
            true => tr!("{property} plus by {input}", property = what, input = by),
            false => tr!("{property} by {input}", property = what, input = by),
        };
        ui.horizontal(|ui| {
            ui.label(&label);
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let remove = ui.small_button(tr("Remove")).on_hover_text(tr("Removes this row"));
                set_accessible_name(&remove, &tr!("Remove {name}", name = label));
                if remove.clicked() {
                    to = Some(brush.dynamics.without(*property, *input, shape.is_additive()));
                }
            });
        });
        let label = tr!("Curve of {name}", name = translate_within(&label));
        let bent = curve::show(ui, &label, shape, 64.0);
        to = bent.map(|bent| brush.dynamics.with(*property, *input, bent.to)).or(to.take());
    }
    let menu = ui.menu_button(tr("+ Let something follow…"), |ui| {
        for (property, name) in Property::ALL {
            ui.menu_button(tr_sentence(name), |ui| {
                for (input, name) in Input::ALL {
                    let is_new = brush.dynamics.curve(property, input).is_none();
                    if ui.add_enabled(is_new, egui::Button::new(tr_sentence(name))).clicked() {
                        to = Some(brush.dynamics.with(property, input, Curve::Share(1.0)));
                        ui.close();
                    }
                }
            });
        }
    });
    menu.response.on_hover_text(tr(
        "Choose a property of the brush, then what it follows: the pen, chance, or the surface",
    ));
    to.map(|dynamics| Brush { dynamics, ..brush.clone() })
}

/// The English display name of a property or an input.
fn word<T: PartialEq>(all: &[(T, &str)], wanted: &T) -> String {
    all.iter()
        .find(|(known, _)| known == wanted)
        .map_or_else(String::new, |(_, word)| sentence(word))
}
