//! The effects of a layer: which it has, in their order, and what one of them is set to. Floor 7.

use super::setter::LayerSetter;
use super::words::translate_within;
use super::{colors, curve, ramp};
use crate::document::{Document, Layer};
use crate::language::tr;
use crate::math::{Vec2, vec2};
use crate::paint::adjustment::ToneCurve;
use crate::paint::effect::{EffectField, EffectFill};
use crate::paint::{EffectKind, EffectLight, LayerEffect};
use crate::session::Property;
use crate::session::actions::LayerAction;
use crate::tr;
use crate::widgets::{NumberField, ValueChange, check, check_box, choice_row, set_accessible_name};
use eframe::egui::{Id, Ui};

/// The opacity of the fill, the list, and the settings of the effect that is chosen in it.
pub fn show(ui: &mut Ui, document: &Document, layer: &Layer, setter: &mut LayerSetter) {
    if !layer.content.can_be_warped() {
        return;
    }
    let count = layer.effects.len();
    let title = match count {
        0 => tr("Effects").to_owned(),
        _ => tr!("Effects ({count})", count),
    };
    let section = eframe::egui::CollapsingHeader::new(title).id_salt("effects");
    section.show(ui, |ui| {
        let hint = "How much of the layer shows; its effects stay";
        let fill = NumberField::new("Fill opacity", Layer::OPACITY, hint).percent();
        let changed = fill.row(ui, layer.fill_opacity);
        setter.take(changed.map(|c| c.map(|to| Property::FillOpacity { to })));
        let chosen = list(ui, layer, setter);
        add(ui, layer, setter);
        if let Some(effect) = chosen.and_then(|i| layer.effects.get(i)) {
            ui.separator();
            if let Some(changed) = settings(ui, document, effect, setter) {
                let i = chosen.unwrap_or_default();
                let effects = with_effect_at(layer, i, changed.to);
                setter.set(Property::Effects { effects }, changed.done);
            }
        }
    });
}

fn with_effect_at(layer: &Layer, i: usize, to: LayerEffect) -> Vec<LayerEffect> {
    let mut all = layer.effects.to_vec();
    if let Some(effect) = all.get_mut(i) {
        *effect = to;
    }
    all
}

/// Every effect with its switch; the number of the chosen one.
fn list(ui: &mut Ui, layer: &Layer, setter: &mut LayerSetter) -> Option<usize> {
    let kept = Id::unique((layer.id, "chosen effect"));
    let last = ui.data(|data| data.get_temp::<usize>(kept)).unwrap_or(0);
    let mut chosen = last.min(layer.effects.len().saturating_sub(1));
    let set = |setter: &mut LayerSetter, effects| {
        setter.set(Property::Effects { effects }, true);
    };
    for (i, effect) in layer.effects.iter().enumerate() {
        let label = effect.kind.label();
        let (name, number) = (translate_within(label), i + 1);
        ui.horizontal(|ui| {
            let mut on = effect.on;
            let shown = check_box(ui, &mut on, "").on_hover_text(tr("Show this effect"));
            set_accessible_name(&shown, &tr!("Show {effect} {number}", effect = name, number));
            if shown.changed() {
                set(setter, with_effect_at(layer, i, LayerEffect { on, ..effect.clone() }));
            }
            let hint = effect.kind.hint();
            if ui.selectable_label(i == chosen, tr(label)).on_hover_text(tr(hint)).clicked() {
                chosen = i;
            }
            let removed = ui.small_button("✕").on_hover_text(tr("Remove this effect"));
            set_accessible_name(&removed, &tr!("Remove {effect} {number}", effect = name, number));
            if removed.clicked() {
                let mut all = layer.effects.to_vec();
                all.remove(i);
                set(setter, all);
            }
        });
    }
    ui.data_mut(|data| data.insert_temp(kept, chosen));
    (!layer.effects.is_empty()).then_some(chosen)
}

fn add(ui: &mut Ui, layer: &Layer, setter: &mut LayerSetter) {
    let menu = ui.menu_button(tr("Add effect"), |ui| {
        for (kind, label) in EffectKind::LABELS {
            if ui.button(tr(label)).on_hover_text(tr(kind.hint())).clicked() {
                setter.set(Property::Effects { effects: with_new(layer, kind) }, true);
                let kept = Id::unique((layer.id, "chosen effect"));
                ui.data_mut(|data| data.insert_temp(kept, layer.effects.len()));
                ui.close();
            }
        }
    });
    drop(menu);
}

/// The effects of a layer with one more.
fn with_new(layer: &Layer, kind: EffectKind) -> Vec<LayerEffect> {
    let mut all = layer.effects.to_vec();
    all.push(LayerEffect::new(kind));
    all
}

/// The settings of one effect.
fn settings(
    ui: &mut Ui,
    document: &Document,
    effect: &LayerEffect,
    setter: &mut LayerSetter,
) -> Option<ValueChange<LayerEffect>> {
    let (mut next, mut done) = (effect.clone(), None);
    ui.push_id(effect.kind.name(), |ui| {
        for field in effect.kind.fields() {
            if is_idle(field, effect) {
                continue;
            }
            if let EffectField::Number(number) = field
                && is_lit_by_document(effect)
                && ["angle", "altitude"].contains(&number.name)
            {
                light(ui, number.name, document.effect_light, setter);
                continue;
            }
            let changed = field_row(ui, field, &mut next);
            done = changed.or(done);
        }
    });
    done.map(|done| ValueChange { to: next, done })
}

fn is_lit_by_document(effect: &LayerEffect) -> bool {
    let uses_it = |field: &EffectField| matches!(field, EffectField::Flag(flag) if flag.name == "document_light");
    effect.settings.document_light && effect.kind.fields().iter().any(uses_it)
}

/// A setting that changes nothing while another is as it is.
fn is_idle(field: EffectField, effect: &LayerEffect) -> bool {
    let fill = effect.fill();
    match field {
        EffectField::Stops => fill != EffectFill::Gradient,
        EffectField::Pattern => fill != EffectFill::Pattern,
        EffectField::Color(color) => color.name == "color" && fill != EffectFill::Color,
        EffectField::Number(number) if effect.kind == EffectKind::Stroke => match number.name {
            "size" | "opacity" => false,
            "phase_x" | "phase_y" => fill != EffectFill::Pattern,
            "scale" => fill == EffectFill::Color,
            _ => fill != EffectFill::Gradient,
        },
        EffectField::Number(number) if effect.kind == EffectKind::DropShadow => {
            number.name == "altitude" && !effect.settings.on_surface
        }
        EffectField::Choice(choice) => choice.name == "ramp" && fill != EffectFill::Gradient,
        EffectField::Flag(flag) if effect.kind == EffectKind::Stroke => {
            fill == EffectFill::Color || (flag.name == "reverse" && fill != EffectFill::Gradient)
        }
        _ => false,
    }
}

/// A number of the light that all effects share.
fn light(ui: &mut Ui, name: &str, own: EffectLight, setter: &mut LayerSetter) {
    let is_angle = name == "angle";
    let (label, range, value) = match is_angle {
        true => ("Document's angle", EffectLight::ANGLE, own.angle),
        false => ("Document's altitude", EffectLight::ALTITUDE, own.altitude),
    };
    let hint = "Of the light that all effects share, degrees";
    let Some(changed) = NumberField::new(label, range, hint).degrees().row(ui, value) else {
        return;
    };
    let light = match is_angle {
        true => EffectLight { angle: changed.to, ..own },
        false => EffectLight { altitude: changed.to, ..own },
    };
    setter.act(|_| LayerAction::EffectLight { light, done: changed.done });
}

/// Shows a setting; whether its widget was released, if it was changed.
fn field_row(ui: &mut Ui, field: EffectField, effect: &mut LayerEffect) -> Option<bool> {
    let all = &mut effect.settings;
    match field {
        EffectField::Number(number) => {
            let shown = NumberField::new(number.label, number.range.clone(), number.hint);
            let ValueChange { to, done } = shown.row(ui, (number.get)(all))?;
            number.put(all, to);
            Some(done)
        }
        EffectField::Flag(flag) => {
            let to = check(ui, flag.label, flag.hint, (flag.get)(all))?;
            (flag.set)(all, to);
            Some(true)
        }
        EffectField::Color(color) => {
            let changed = ui.horizontal(|ui| {
                let changed = colors::button(ui, color.label, (color.get)(all));
                ui.label(tr(color.label));
                changed
            });
            let ValueChange { to, done } = changed.inner?;
            (color.set)(all, to);
            Some(done)
        }
        EffectField::Choice(choice) => {
            let choices = (choice.choices)();
            let numbered: Vec<(usize, &str)> =
                choices.iter().enumerate().map(|(i, (_, label))| (i, *label)).collect();
            let to = choice_row(ui, choice.label, (choice.get)(all), &numbered)?;
            (choice.set)(all, to);
            Some(true)
        }
        EffectField::Stops => {
            let ValueChange { to, done } = ramp::show(ui, &effect.stops)?;
            effect.stops = to;
            Some(done)
        }
        EffectField::Contour => {
            let ValueChange { to, done } = contour(ui, &effect.contour)?;
            effect.contour = to;
            Some(done)
        }
        EffectField::Pattern => {
            match &effect.pattern {
                Some(pattern) => ui.weak(format!("{} · {}", pattern.name(), pattern.picture().0)),
                None => ui.weak(tr("No picture: the layer stays as it is")),
            };
            None
        }
    }
}

/// How much of the effect each tone of its blur gets.
fn contour(ui: &mut Ui, curve: &ToneCurve) -> Option<ValueChange<ToneCurve>> {
    const HEIGHT_PT: f32 = 90.0;
    let points: Vec<Vec2> = curve.points().iter().map(|[x, y]| vec2(*x, *y) / 255.0).collect();
    let through = |points: &[Vec2]| {
        ToneCurve::new(points.iter().map(|p| [255.0 * p.x, 255.0 * p.y]).collect())
    };
    let line = |points: &[Vec2]| {
        let spline = through(points).spline();
        let at = |i: u32| {
            let x = i as f32 / 64.0;
            vec2(x, spline.at(x).max(0.0).min(1.0))
        };
        (0..=64).map(at).collect()
    };
    let square = curve::CurveSquare {
        label: "Contour",
        height_pt: HEIGHT_PT,
        most: ToneCurve::MOST_POINTS,
        least: 2,
        behind: &|_, _| {},
        line: &line,
    };
    Some(square.show(ui, points)?.map(|points| through(&points)))
}
