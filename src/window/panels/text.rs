//! What a text says and in which type. What is typed, here or on the canvas, is seen on the canvas
//! at once, where `canvas::text_carets` draws the caret. Floor 7.

use super::colors;
use super::setter::LayerSetter;
use crate::document::{Content, LayerId};
use crate::io::text;
use crate::language::tr;
use crate::paint::{Text, TextAlign, TextPath, TextStyle};
use crate::panel_layout::PanelKind;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::LayerAction;
use crate::session::{Action, Property, Session, Writing};
use crate::tools::ToolKind;
use crate::tr;
use crate::typed_range::{TypedRange, typed_range};
use crate::widgets::{NumberField, check, name, set_accessible_name};
use eframe::egui::text::{CCursor, CCursorRange};
use eframe::egui::{self, ComboBox, Id, Rect, TextEdit, Ui, UiBuilder, vec2};
use std::ops::Range;
use std::sync::Arc;

pub fn show(ui: &mut Ui, layer: LayerId, words: &Text, setter: &mut LayerSetter) {
    let id = Id::unique(("words of a layer", layer));
    let mut range = field(ui, id, "Words", (layer, words), setter);
    let on_canvas = ui.data(|data| data.get_temp::<Option<TypedRange>>(typed_range())).flatten();
    if let Some(typed) = on_canvas.filter(|typed| typed.layer == layer) {
        range = typed.bytes;
    }
    let style = words.style_at(range.end);
    let lost = text::missing_families(words);
    if !lost.is_empty() {
        let lost = lost.join("”, “");
        let hint = "The text keeps its outlines until you change it; then another font is used";
        let about = tr!("“{fonts}” is not installed here", fonts = lost);
        ui.colored_label(ui.visuals().warn_fg_color, about).on_hover_text(tr(hint));
    }
    // What is changed: the selected letters, or all of them.
    let all = range.is_empty();
    let of = if all { 0..words.string().len() } else { range };
    let restyled = |change: &dyn Fn(&mut TextStyle)| Property::Worded {
        text: words.styled(of.start, of.end, change),
    };
    if let Some(family) = family(ui, layer, &style.family) {
        setter.set(restyled(&|style| style.family.clone_from(&family)), true);
    }
    let size = NumberField::new("Size", 4.0..=400.0, "The height of the type").px().logarithmic();
    setter.take(size.row(ui, style.size).map(|c| c.map(|to| restyled(&|style| style.size = to))));
    ui.horizontal(|ui| {
        if let Some(bold) = check(ui, "Bold", "Heavier letters", style.weight >= 600) {
            let weight = if bold { 700 } else { 400 };
            setter.set(restyled(&|style| style.weight = weight), true);
        }
        if let Some(italic) = check(ui, "Italic", "Slanted letters", style.italic) {
            setter.set(restyled(&|style| style.italic = italic), true);
        }
    });
    let color = colors::picker(ui, "Text color", style.color);
    setter.take(color.map(|c| c.map(|to| restyled(&|style| style.color = to))));
    let tracking =
        NumberField::new("Tracking", -200.0..=1000.0, "Added between letters, 1/1000 of the size");
    setter.take(
        tracking
            .decimals(0)
            .row(ui, style.tracking)
            .map(|c| c.map(|to| restyled(&|style| style.tracking = to))),
    );
    let outline = NumberField::new("Outline", 0.0..=64.0, "A line around the letters").px();
    setter.take(
        outline.row(ui, style.outline).map(|c| c.map(|to| restyled(&|style| style.outline = to))),
    );
    if style.outline > 0.0 {
        let color = colors::picker(ui, "Outline color", style.outline_color);
        setter.take(color.map(|c| c.map(|to| restyled(&|style| style.outline_color = to))));
    }
    lines(ui, words, setter);
    ui.separator();
}

/// How lines lie.
fn lines(ui: &mut Ui, words: &Text, setter: &mut LayerSetter) {
    let changed = |change: &dyn Fn(&mut Text)| {
        let mut text = words.clone();
        change(&mut text);
        Property::Worded { text }
    };
    ui.horizontal(|ui| {
        name(ui, "Lines");
        for (align, label) in TextAlign::LABELS {
            let is_on = words.align == align;
            if ui.selectable_label(is_on, tr(label)).clicked() && !is_on {
                setter.set(changed(&|text| text.align = align), true);
            }
        }
    });
    let leading = NumberField::new("Leading", 0.5..=3.0, "The distance of lines, in sizes");
    let leading = leading.row(ui, words.leading);
    setter.take(leading.map(|c| c.map(|to| changed(&|text| text.leading = to))));
    let width = NumberField::new("Width", 0.0..=4000.0, "Where lines are broken; 0: nowhere");
    let width = width.px().decimals(0).row(ui, words.width);
    setter.take(width.map(|c| c.map(|to| changed(&|text| text.width = to))));
    if let Some(path) = &words.path {
        return along_path(ui, path, words, setter);
    }
    let arc = NumberField::new("Arc", -360.0..=360.0, "Bends lines along a circle").degrees();
    let arc = arc.row(ui, words.arc);
    setter.take(arc.map(|c| c.map(|to| changed(&|text| text.arc = to))));
    let hint = "Columns from right to left, as in Japanese";
    if let Some(vertical) = check(ui, "Vertical", hint, words.vertical) {
        setter.set(changed(&|text| text.vertical = vertical), true);
    }
}

/// Where on its path a text is.
fn along_path(ui: &mut Ui, path: &TextPath, words: &Text, setter: &mut LayerSetter) {
    let worded = |path: Option<TextPath>| Property::Worded { text: Text { path, ..words.clone() } };
    let shift = NumberField::new("Offset", -2000.0..=2000.0, "Moves the text along its path");
    let shift = shift.px().decimals(0).row(ui, path.shift);
    setter.take(shift.map(|c| c.map(|shift| worded(Some(TextPath { shift, ..path.clone() })))));
    ui.horizontal(|ui| {
        let hint = "The text runs the other way, on the other side of its path";
        if ui.button(tr("Other side")).on_hover_text(tr(hint)).clicked() {
            let line = path.line.reversed();
            setter.set(worded(Some(TextPath { line, shift: 0.0 })), true);
        }
        let hint = "Lines are straight again";
        if ui.button(tr("Take off the path")).on_hover_text(tr(hint)).clicked() {
            setter.set(worded(None), true);
        }
    });
}

/// Typing on the canvas: a field that is not seen, for the text that the text tool was pressed on.
/// `Properties` comes to the front.
pub fn type_on_canvas(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let Some(writing) = session.writing.filter(|_| session.tool == ToolKind::Text) else { return };
    let (Some(layer), Some(path)) = (session.layer(), session.layer_path()) else { return };
    let Content::Image(live) = &layer.content else { return };
    let Some(words) = live.params().source.text().filter(|_| layer.id == writing.layer) else {
        return;
    };
    let id = Id::unique(("words on the canvas", layer.id));
    if try_to_begin(ui, id, writing, &words.string()) {
        requests.request(WindowRequest::ShowPanel(PanelKind::Properties));
    }
    let corner = Rect::from_min_size(ui.max_rect().left_bottom(), vec2(200.0, 20.0));
    let mut hidden = ui.new_child(UiBuilder::new().max_rect(corner));
    hidden.set_opacity(0.0);
    let mut setter = LayerSetter { layer: path, requests };
    field(&mut hidden, id, "Words on the canvas", (layer.id, words), &mut setter);
}

/// A field that is typed in; the bytes that are selected in it.
fn field(
    ui: &mut Ui,
    id: Id,
    label: &str,
    (layer, words): (LayerId, &Text),
    setter: &mut LayerSetter,
) -> Range<usize> {
    let mut string = words.string();
    let edit = TextEdit::multiline(&mut string).id(id).desired_rows(2).desired_width(f32::INFINITY);
    let output = edit.show(ui);
    set_accessible_name(&output.response, tr(label));
    let byte =
        |letters: usize| string.char_indices().nth(letters).map_or(string.len(), |(byte, _)| byte);
    let range = output.cursor_range.map(|range| {
        let ends = [byte(range.primary.index.0), byte(range.secondary.index.0)];
        (ends[0].min(ends[1])..ends[0].max(ends[1]), ends[0])
    });
    if let Some((bytes, caret)) = range.clone().filter(|_| output.response.has_focus()) {
        let typed = TypedRange { layer, bytes, caret };
        ui.data_mut(|data| data.insert_temp(typed_range(), Some(typed)));
    } else if output.response.lost_focus() {
        ui.data_mut(|data| data.insert_temp(typed_range(), None::<TypedRange>));
    }
    if output.response.changed() {
        // A word is a step of the history.
        let is_word = string.ends_with(char::is_whitespace);
        setter.set(Property::Worded { text: words.saying(&string) }, is_word);
    } else if output.response.lost_focus() {
        // What was typed is kept.
        setter.requests.act(Action::Layer(LayerAction::Unadjust {}));
    }
    range.map_or(0..0, |(bytes, _)| bytes)
}

/// Goes into the field where the text tool was pressed, once for each press; whether it did.
fn try_to_begin(ui: &Ui, id: Id, writing: Writing, string: &str) -> bool {
    let last = Id::unique("last press of the text tool");
    // A click ends with the release, and takes the focus from fields beside it.
    let is_pressed = ui.input(|i| i.pointer.any_down() || i.pointer.any_released());
    if is_pressed || ui.data(|data| data.get_temp::<Writing>(last)) == Some(writing) {
        return false;
    }
    ui.data_mut(|data| data.insert_temp(last, writing));
    let letters = |byte: usize| string.get(..byte).map_or(0, |before| before.chars().count());
    let range = match writing.byte {
        Some(byte) => CCursorRange::one(CCursor::new(letters(byte))),
        None => CCursorRange::two(CCursor::new(0), CCursor::new(letters(string.len()))),
    };
    let mut state = egui::text_edit::TextEditState::load(ui.ctx(), id).unwrap_or_default();
    state.cursor.set_char_range(Some(range));
    state.store(ui.ctx(), id);
    ui.memory_mut(|memory| memory.request_focus(id));
    true
}

/// A menu of all fonts; another one that was chosen.
fn family(ui: &mut Ui, layer: LayerId, current: &str) -> Option<String> {
    let mut chosen = None;
    ui.horizontal(|ui| {
        name(ui, "Font");
        let shown = if current.is_empty() { tr("Sans-serif") } else { current };
        let response = ComboBox::from_id_salt(("font", layer))
            .selected_text(shown)
            .width(170.0)
            .show_ui(ui, |ui| {
                if ui.selectable_label(current.is_empty(), tr("Sans-serif")).clicked() {
                    chosen = Some(String::new());
                }
                for family in families(ui).iter() {
                    if ui.selectable_label(current == family, family).clicked() {
                        chosen = Some(family.clone());
                    }
                }
            });
        set_accessible_name(&response.response, tr("Font"));
    });
    chosen
}

/// The families of this machine, read once.
fn families(ui: &Ui) -> Arc<Vec<String>> {
    let id = Id::unique("families of fonts");
    if let Some(known) = ui.data(|data| data.get_temp::<Arc<Vec<String>>>(id)) {
        return known;
    }
    let families = Arc::new(text::families());
    ui.data_mut(|data| data.insert_temp(id, families.clone()));
    families
}
