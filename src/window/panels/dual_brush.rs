//! The second tip of the current brush. Floor 7. Not here: the rest of the brush (`brush`).

use super::brush_tip::{self, TipChoice};
use super::words::preset_name;
use crate::io::recipe::PresetGroup;
use crate::language::tr;
use crate::math::NumberSetting;
use crate::paint::{Brush, Curve, DualBrush, DualMode, DualSettings, Dynamics, Input, Property};
use crate::requests::UiRequests;
use crate::session::actions::HandAction;
use crate::session::{Action, Session};
use crate::widgets::{NumberField, choice_row, list};
use eframe::egui::Ui;
use std::sync::Arc;

/// Which tip, how it meets the first one, and its numbers. `None` if nothing was changed.
pub fn show(ui: &mut Ui, session: &Session, requests: &mut UiRequests) -> Option<Brush> {
    let brush = &session.tools.brush;
    if brush.is_wet() {
        ui.weak(tr("For brushes that paint and pick up no paint."));
        return None;
    }
    let dual = brush.dual.as_deref();
    let with = |dual: Option<DualBrush>| Brush { dual: dual.map(Arc::new), ..brush.clone() };
    let kind = dual.map(|dual| TipChoice::of(&dual.tip));
    let kinds = TipChoice::LABELS.map(|(kind, label)| (Some(kind), label));
    let kinds: Vec<_> = [(None, "none")].into_iter().chain(kinds).collect();
    let chosen = choice_row(ui, "Second tip", kind, &kinds)
        .map(|kind| kind.map(|kind| with_tip(dual, kind)));
    choose_tip_of_brush(ui, session, requests);
    let Some(dual) = dual else { return chosen.map(with) };
    let mode = choice_row(ui, "Meets by", dual.settings.mode, &DualMode::LABELS);
    let mode = mode.map(|mode| DualSettings { mode, ..dual.settings });
    let settings = mode.or(numbers(ui, &dual.settings));
    let settings = settings.map(|settings| DualBrush { settings, ..dual.clone() });
    let tip = brush_tip::numbers(ui, &dual.tip).map(|tip| DualBrush { tip, ..dual.clone() });
    chosen.or(settings.or(tip).map(Some)).map(with)
}

/// The brush's second tip with another shape; the first one turns at random, so that it leaves no
/// streaks.
fn with_tip(dual: Option<&DualBrush>, kind: TipChoice) -> DualBrush {
    let turning = Dynamics::none().with(Property::Rotation, Input::Random, Curve::Share(1.0));
    let begin = || DualBrush {
        settings: DualSettings { spacing: 0.4, ..DualSettings::DEFAULT },
        dynamics: turning,
        ..DualBrush::default()
    };
    DualBrush { tip: kind.tip(), ..dual.cloned().unwrap_or_else(begin) }
}

/// A list of the brushes whose tips can be taken; the user's own come first.
fn choose_tip_of_brush(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let menu = ui.menu_button(tr("Tip of a brush…"), |ui| {
        list(ui, 320.0).show(ui, |ui| {
            let is_own = |own: bool| {
                session.presets.iter().filter(move |p| (p.group == PresetGroup::Imported) == own)
            };
            for preset in is_own(true).chain(is_own(false)) {
                if ui.button(preset_name(preset)).clicked() {
                    let name = preset.key.clone();
                    requests.act(Action::Hand(HandAction::SecondTip { name }));
                    ui.close();
                }
            }
        });
    });
    menu.response.on_hover_text(tr("Takes the tip of another brush as the second one"));
}

fn numbers(ui: &mut Ui, settings: &DualSettings) -> Option<DualSettings> {
    let mut changed = None;
    for setting in DualSettings::SETTINGS {
        let NumberSetting { name, label, hint, range, .. } = setting;
        let field = NumberField::new(label, range.clone(), hint);
        let field = match *name {
            "size" => field.share().logarithmic(),
            "spacing" => field.logarithmic(),
            "rotation" => field.degrees(),
            "hardness" | "softness" | "opacity" | "flow" => field.share(),
            _ => field,
        };
        if let Some(change) = field.row(ui, (setting.get)(settings)) {
            let mut to = *settings;
            setting.put(&mut to, change.to);
            changed = Some(to);
        }
    }
    changed
}
