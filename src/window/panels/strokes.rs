//! The strokes of the selected stroke layer: list, selection, style, order, deletion, baking.
//! Floor 7.

use super::{attachment, colors, options};
use crate::icons::{Icon, icon_button};
use crate::language::tr;
use crate::operators::{OPERATORS, OfferedOperator};
use crate::paint::{Brush, Stroke};
use crate::requests::UiRequests;
use crate::session::actions::{HandAction, StrokeAction, Style};
use crate::session::{Action, LayerPath, Session};
use crate::tools::ToolKind;
use crate::tr;
use crate::widgets::{NumberField, ValueChange, swatch, title};
use eframe::egui::{Button, ScrollArea, Ui, vec2};
use std::sync::Arc;

/// The number of visible rows of the list.
const ROWS: usize = 6;

/// The list, and the actions on the selected strokes.
pub fn show(
    ui: &mut Ui,
    session: &Session,
    layer: &LayerPath,
    strokes: &[Arc<Stroke>],
    requests: &mut UiRequests,
) {
    let n = strokes.len();
    ui.label(match n {
        1 => tr("1 stroke").to_owned(),
        _ => tr!("{count} strokes", count = n),
    });
    let selected = session.active().map(|open| open.selected_strokes()).unwrap_or_default();
    list(ui, layer, strokes, &selected, requests);
    let Some(first) = selected.first().and_then(|&index| strokes.get(index)) else {
        ui.weak(tr("Select strokes here or on the canvas with the stroke tool (S)."));
        return;
    };
    buttons(ui, layer, n, &selected, requests);
    title(ui, if selected.len() == 1 { "Stroke" } else { "Strokes" });
    if let Some(document) = session.shown_document()
        && let Some(part) = attachment::choice(
            ui,
            document,
            first.attachment().map(|attachment| &attachment.frame),
            "As its layer",
        )
    {
        let (layer, strokes) = (layer.clone(), selected.clone());
        requests.act(Action::Stroke(StrokeAction::Attach { layer, strokes, part }));
    }
    styles(ui, first, |to, done| {
        let (layer, strokes) = (layer.clone(), selected.clone());
        requests.act(Action::Stroke(StrokeAction::Restyle { layer, strokes, to, done }));
    });
}

/// The topmost stroke first.
fn list(
    ui: &mut Ui,
    layer: &LayerPath,
    strokes: &[Arc<Stroke>],
    selected: &[usize],
    requests: &mut UiRequests,
) {
    let height = ui.spacing().interact_size.y;
    let area = ScrollArea::vertical().id_salt("strokes").max_height((height + 2.0) * ROWS as f32);
    ui.spacing_mut().item_spacing.y = 2.0;
    area.auto_shrink([false, true]).show_rows(ui, height, strokes.len(), |ui, rows| {
        for index in rows.map(|row| strokes.len() - 1 - row) {
            let Some(stroke) = strokes.get(index) else { continue };
            let is_on = selected.contains(&index);
            ui.horizontal(|ui| {
                swatch(
                    ui,
                    &tr!("Color of stroke {number}", number = index + 1),
                    stroke.color(),
                    vec2(18.0, height - 4.0),
                );
                let size = format!("{:.0}", stroke.brush().size);
                let name = tr!("Stroke {number} · {size} px", number = index + 1, size);
                let row = Button::selectable(is_on, name).min_size(vec2(ui.available_width(), 0.0));
                if ui.add(row).clicked() {
                    let adds = ui.input(|i| i.modifiers.shift || i.modifiers.command);
                    let strokes = toggle_selected(selected, index, adds);
                    requests.act(Action::Stroke(StrokeAction::Choose {
                        layer: layer.clone(),
                        strokes,
                    }));
                    requests.act(Action::Hand(HandAction::Tool { tool: ToolKind::Strokes }));
                }
            });
        }
    });
}

/// The selection after a click on a row.
fn toggle_selected(selected: &[usize], index: usize, adds: bool) -> Vec<usize> {
    match (adds, selected.contains(&index)) {
        (false, _) => vec![index],
        (true, true) => selected.iter().copied().filter(|&other| other != index).collect(),
        (true, false) => selected.iter().copied().chain([index]).collect(),
    }
}

fn buttons(
    ui: &mut Ui,
    layer: &LayerPath,
    count: usize,
    selected: &[usize],
    requests: &mut UiRequests,
) {
    let (layer, strokes) = (|| layer.clone(), || selected.to_vec());
    let mut act = |action: StrokeAction| requests.act(Action::Stroke(action));
    ui.horizontal(|ui| {
        if let [stroke] = *selected {
            if stroke + 1 < count && icon_button(ui, Icon::Up, "Stroke up", false).clicked() {
                act(StrokeAction::Order { layer: layer(), stroke, to: stroke + 1 });
            }
            if stroke > 0 && icon_button(ui, Icon::Down, "Stroke down", false).clicked() {
                act(StrokeAction::Order { layer: layer(), stroke, to: stroke - 1 });
            }
            let hint = "Takes over its brush, bending and color";
            if icon_button(ui, Icon::Tool(ToolKind::Eyedropper), "Use its brush", false)
                .on_hover_text(tr(hint))
                .clicked()
            {
                act(StrokeAction::Take { layer: layer(), stroke });
            }
        }
        if icon_button(ui, Icon::Duplicate, "Duplicate strokes", false)
            .on_hover_text(tr("Duplicate"))
            .clicked()
        {
            act(StrokeAction::Duplicate { layer: layer(), strokes: strokes() });
        }
        let hint = "Turns them into pixels on a paint layer of their own";
        if icon_button(ui, Icon::Bake, "Turn strokes into pixels", false)
            .on_hover_text(tr(hint))
            .clicked()
        {
            act(StrokeAction::Bake { layer: layer(), strokes: strokes() });
        }
        if icon_button(ui, Icon::Delete, "Delete strokes", false)
            .on_hover_text(tr("Delete"))
            .clicked()
        {
            act(StrokeAction::Delete { layer: layer(), strokes: strokes() });
        }
        let hint = "Paints them with the current brush";
        let restyle = StrokeAction::Restyle {
            layer: layer(),
            strokes: strokes(),
            to: Style::Brush {},
            done: true,
        };
        if icon_button(ui, Icon::Tool(ToolKind::Brush), "Apply current brush", false)
            .on_hover_text(tr(hint))
            .clicked()
        {
            act(restyle);
        }
    });
}

/// The style of the first selected stroke; changes apply to all of them.
fn styles(ui: &mut Ui, stroke: &Stroke, mut set: impl FnMut(Style, bool)) {
    let brush = stroke.brush();
    let mut give = |changed: Option<ValueChange<Style>>| {
        if let Some(ValueChange { to, done }) = changed {
            set(to, done);
        }
    };
    let unit = |label, hint| NumberField::new(label, 0.0..=1.0, hint);
    let size = NumberField::new("Stroke size", Brush::HAND_SIZE, "Diameter of a dab").px();
    give(size.row(ui, brush.size).map(|c| c.map(|to| Style::Size { to })));
    let opacity = unit("Opacity", "Of the whole stroke").row(ui, brush.opacity);
    give(opacity.map(|c| c.map(|to| Style::Opacity { to })));
    let flow = unit("Flow", "What one dab adds").row(ui, brush.flow);
    give(flow.map(|c| c.map(|to| Style::Flow { to })));
    let hardness =
        unit("Hardness", "Share of the radius that is fully covered").row(ui, brush.hardness);
    give(hardness.map(|c| c.map(|to| Style::Hardness { to })));
    let softness = unit("Softness", "A rougher, less glossy mark").row(ui, brush.softness);
    give(softness.map(|c| c.map(|to| Style::Softness { to })));
    ui.horizontal_wrapped(|ui| {
        for OfferedOperator { label, begins, hint } in OPERATORS {
            let is_on = stroke.operator().is_like(begins);
            if ui.selectable_label(is_on, tr(label)).on_hover_text(tr(hint)).clicked() && !is_on {
                give(Some(ValueChange { to: Style::Operator { operator: begins }, done: true }));
            }
        }
    });
    let numbers = options::number_rows(ui, stroke.operator());
    give(numbers.map(|c| c.map(|operator| Style::Operator { operator })));
    let color = colors::picker(ui, "Stroke color", stroke.color());
    give(color.map(|c| c.map(|color| Style::Color { color })));
}
