//! Properties of drawings by the form: which lines, brush and color, the hand, the light. Floor 7.

use super::setter::LayerSetter;
use super::words::{preset_about, preset_name};
use super::{colors, painter};
use crate::document::{Content, Layer};
use crate::io::recipe::presets;
use crate::language::tr;
use crate::math::{Vec3, vec3};
use crate::paint::{Brush, DrawingHand, FormDrawing, FormPattern};
use crate::session::actions::LayerAction;
use crate::session::{Property, Session};
use crate::surface::form_lines::{LineKind, LineSettings};
use crate::surface::hatching::{HatchSettings, HatchStyle, HatchTone, HatchWay};
use crate::widgets::{NumberField, check, choice_row, name, set_accessible_name, title};
use eframe::egui::{self, Ui};

/// The panel of one.
pub fn show(
    ui: &mut Ui,
    session: &Session,
    drawing: &FormDrawing,
    has_surface: bool,
    setter: &mut LayerSetter,
) {
    if !has_surface {
        ui.weak(tr("These lines need a shape: give the drawing one, or add maps."));
    }
    match drawing.pattern {
        FormPattern::Lines(lines) => {
            line_settings(ui, lines, setter);
            redraw_row(ui, session, &drawing.sources.redrawn, setter);
        }
        FormPattern::Hatching(hatch) => hatch_settings(ui, session, drawing, hatch, setter),
    }
    brush(ui, session, drawing, setter);
    title(ui, "Hand");
    let hand = DrawingHand::settings_of(&drawing.pattern);
    painter::settings(ui, hand, drawing.hand, setter, |hand| Property::Hand { hand });
    let hint = "The lines become strokes, to be edited one by one";
    if ui.button(tr("Make strokes")).on_hover_text(tr(hint)).clicked() {
        setter.act(|layer| LayerAction::MakeStrokes { layer });
    }
}

fn line_settings(ui: &mut Ui, lines: LineSettings, setter: &mut LayerSetter) {
    title(ui, "Lines");
    for (kind, _) in LineKind::ALL {
        if let Some(on) = check(ui, kind.label(), kind.hint(), lines.kinds.has_kind(kind)) {
            let kinds = lines.kinds.with(kind, on);
            setter.set(Property::Lines { lines: LineSettings { kinds, ..lines } }, true);
        }
    }
    let hint = "Leaves out lines that the drawing's own ink draws already";
    if let Some(skip_ink) = check(ui, "Not where there is ink", hint, lines.skip_ink) {
        setter.set(Property::Lines { lines: LineSettings { skip_ink, ..lines } }, true);
    }
    painter::settings(ui, LineSettings::SETTINGS, lines, setter, |lines| Property::Lines { lines });
    light(ui, lines.light, setter, |light| Property::Lines {
        lines: LineSettings { light, ..lines },
    });
}

fn hatch_settings(
    ui: &mut Ui,
    session: &Session,
    drawing: &FormDrawing,
    hatching: HatchSettings,
    setter: &mut LayerSetter,
) {
    title(ui, "Hatching");
    if let Some(style) = choice_row(ui, "Style", hatching.style, &HatchStyle::LABELS) {
        let hatching = HatchSettings { style, ..hatching };
        setter.set(Property::Hatched { hatching }, true);
    }
    if let Some(way) = choice_row(ui, "Lines go", hatching.way, &HatchWay::LABELS) {
        let hatching = HatchSettings { way, ..hatching };
        setter.set(Property::Hatched { hatching }, true);
    }
    if hatching.way == HatchWay::Guides {
        guides(ui, session, &drawing.sources.guides, setter);
    }
    if let Some(tone) = choice_row(ui, "Tone", hatching.tone, &HatchTone::LABELS) {
        setter.set(Property::Hatched { hatching: HatchSettings { tone, ..hatching } }, true);
    }
    if hatching.tone == HatchTone::Layer {
        let of = &drawing.sources.tone;
        if let Some(name) = layer_row(ui, session, "Tone of", of, |_| true) {
            setter.set(Property::ToneOf { name }, true);
        }
    }
    painter::settings(ui, HatchSettings::SETTINGS, hatching, setter, |hatching| {
        Property::Hatched { hatching }
    });
    if hatching.tone == HatchTone::Light {
        light(ui, hatching.light, setter, |light| Property::Hatched {
            hatching: HatchSettings { light, ..hatching },
        });
    }
}

/// Which strokes hatching follows, and how they are drawn.
fn guides(ui: &mut Ui, session: &Session, of: &str, setter: &mut LayerSetter) {
    let is_strokes = |layer: &Layer| matches!(layer.content, Content::Strokes(_));
    if let Some(name) = layer_row(ui, session, "Strokes of", of, is_strokes) {
        setter.set(Property::GuidedBy { name }, true);
    }
    let hint = "Selects a stroke layer; lines follow the strokes that you paint on it";
    if ui.button(tr("Draw guide strokes")).on_hover_text(tr(hint)).clicked() {
        setter.act(|layer| LayerAction::DrawGuides { layer });
    }
}

/// Which strokes stand in the place of lines, and how they are drawn.
fn redraw_row(ui: &mut Ui, session: &Session, on: &str, setter: &mut LayerSetter) {
    let is_strokes = |layer: &Layer| matches!(layer.content, Content::Strokes(_));
    if !on.is_empty()
        && let Some(name) = layer_row(ui, session, "Redrawn on", on, is_strokes)
    {
        setter.set(Property::RedrawnOn { name }, true);
    }
    let hint = "Selects a stroke layer; strokes that you paint along lines take their place";
    if ui.button(tr("Redraw lines")).on_hover_text(tr(hint)).clicked() {
        setter.act(|layer| LayerAction::DrawGuides { layer });
    }
}

/// A choice of a layer by its name.
fn layer_row(
    ui: &mut Ui,
    session: &Session,
    label: &str,
    current: &str,
    suits: impl Fn(&Layer) -> bool,
) -> Option<String> {
    let document = session.shown_document()?;
    let layers: Vec<_> = document.walk().into_iter().filter(|(_, layer)| suits(layer)).collect();
    let mut chosen = None;
    ui.horizontal(|ui| {
        name(ui, label);
        let shown = if current.is_empty() { tr("None") } else { current };
        let combo = egui::ComboBox::from_id_salt(label)
            .selected_text(shown)
            .width(ui.available_width())
            .truncate();
        let response = combo.show_ui(ui, |ui| {
            for (_, layer) in layers.iter().rev() {
                if ui.selectable_label(layer.name == current, &layer.name).clicked() {
                    chosen = Some(layer.name.clone());
                }
            }
        });
        set_accessible_name(&response.response, tr(label));
    });
    chosen
}

/// Where the light comes from: its turn in the picture and its height above it.
fn light(ui: &mut Ui, light: Vec3, setter: &mut LayerSetter, put: impl Fn(Vec3) -> Property) {
    let to = light.normalize_or(Vec3::Z);
    let (turn, height) = (to.y.atan2(to.x).to_degrees(), to.z.clamp(-1.0, 1.0).asin().to_degrees());
    let toward = |turn: f32, height: f32| {
        let (turn, height) = (turn.to_radians(), height.to_radians());
        vec3(turn.cos() * height.cos(), turn.sin() * height.cos(), height.sin())
    };
    let field = |label, range, hint| NumberField::new(label, range, hint).degrees();
    let turned = field("Light from", -180.0..=180.0, "0 right, 90 above").row(ui, turn);
    setter.take(turned.map(|c| c.map(|turn| put(toward(turn, height)))));
    // Straight from the front it would forget its turn.
    let raised = field("Light height", 0.0..=89.0, "90 from the viewer").row(ui, height);
    setter.take(raised.map(|c| c.map(|height| put(toward(turn, height)))));
}

fn brush(ui: &mut Ui, session: &Session, drawing: &FormDrawing, setter: &mut LayerSetter) {
    title(ui, "Brush");
    let changed = colors::button(ui, "Line color", drawing.color);
    setter.take(changed.map(|c| c.map(|color| Property::Fill { color })));
    let size = NumberField::new("Line width", Brush::HAND_SIZE, "At full pressure, px");
    let changed = size.row(ui, drawing.brush.size);
    setter.take(changed.map(|c| c.map(|to| Property::LineSize { to })));
    let combo = egui::ComboBox::from_id_salt("brush of the lines").selected_text(tr("Brushes"));
    let response = combo.show_ui(ui, |ui| {
        for preset in presets().filter(|preset| !preset.brush.mode.is_retouching()) {
            if ui
                .selectable_label(false, preset_name(&preset))
                .on_hover_text(preset_about(&preset))
                .clicked()
            {
                setter.set(Property::DrawnWith { preset: preset.key }, true);
            }
        }
    });
    set_accessible_name(&response.response, tr("Brush of the lines"));
    let hint = "The brush and the color in hand draw the lines";
    let can_draw = !session.tools.brush.mode.is_retouching();
    let button = ui.add_enabled(can_draw, egui::Button::new(tr("Use my brush")));
    if button.on_hover_text(tr(hint)).clicked() {
        setter.act(|layer| LayerAction::DrawWith { layer });
    }
}
