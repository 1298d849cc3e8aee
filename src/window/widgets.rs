//! The window's own widgets: each has a name that a screen reader and a test can find, and
//! distinguishes dragging from its end. Floor 7.

use super::theme::{color32, outline};
use crate::math::srgb::Color;
use eframe::egui::{
    self, Align, DragValue, Layout, ProgressBar, Response, RichText, ScrollArea, Slider,
    SliderClamping, TextEdit, Ui,
    text::{CCursor, CCursorRange},
    vec2,
};
use std::ops::RangeInclusive;

/// A new value from a widget: a preview, or final.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValueChange<T> {
    pub to: T,
    /// The widget was released: one step of history.
    pub done: bool,
}

impl<T> ValueChange<T> {
    pub fn map<U>(self, f: impl FnOnce(T) -> U) -> ValueChange<U> {
        ValueChange { to: f(self.to), done: self.done }
    }
}

/// Turns a widget's response into a preview, a final value, or nothing.
pub fn change<T>(response: &Response, to: T) -> Option<ValueChange<T>> {
    if response.drag_stopped() {
        return Some(ValueChange { to, done: true });
    }
    response.changed().then(|| ValueChange { to, done: !response.dragged() })
}

/// Gives a widget the keyboard when it was not there a moment ago: the first number of a dialog, so
/// that it can be typed at once.
pub fn begin_with(response: &Response) {
    let (ctx, id) = (&response.ctx, response.id.with("shown last"));
    let now = ctx.cumulative_pass_nr();
    let last = ctx.data_mut(|data| std::mem::replace(data.get_temp_mut_or(id, 0), now));
    if now > last + 2 {
        response.request_focus();
        // What is typed replaces the number.
        let mut state = TextEdit::load_state(ctx, response.id).unwrap_or_default();
        let whole = CCursorRange::two(CCursor::new(0), CCursor::new(NUMBER_CHARS));
        state.cursor.set_char_range(Some(whole));
        state.store(ctx, response.id);
    }
}

/// More characters than a number has.
const NUMBER_CHARS: usize = 64;

/// A number with its name in front of it.
pub struct NumberField<'a> {
    pub label: &'a str,
    pub hint: &'a str,
    pub range: RangeInclusive<f32>,
    pub suffix: &'a str,
    pub decimals: usize,
    pub logarithmic: bool,
}

impl<'a> NumberField<'a> {
    pub fn new(label: &'a str, range: RangeInclusive<f32>, hint: &'a str) -> Self {
        Self { label, hint, range, suffix: "", decimals: 2, logarithmic: false }
    }

    pub fn px(self) -> Self {
        Self { suffix: " px", decimals: 0, logarithmic: true, ..self }
    }

    /// A few pixels, perhaps none.
    pub fn pixels(self) -> Self {
        Self { suffix: " px", decimals: 1, ..self }
    }

    pub fn degrees(self) -> Self {
        Self { suffix: "°", decimals: 0, ..self }
    }

    pub fn percent(self) -> Self {
        Self { suffix: " %", decimals: 0, ..self }
    }

    pub fn decimals(self, decimals: usize) -> Self {
        Self { decimals, ..self }
    }

    pub fn logarithmic(self) -> Self {
        Self { logarithmic: true, ..self }
    }

    fn slider<'v>(&self, value: &'v mut f32) -> Slider<'v>
    where
        'a: 'v,
    {
        Slider::new(value, self.range.clone())
            .suffix(self.suffix)
            .fixed_decimals(self.decimals)
            .logarithmic(self.logarithmic)
            // A value is not rounded to the digits shown: that would be an edit of its own.
            .clamping(SliderClamping::Edits)
            .trailing_fill(true)
    }

    /// A slider in a row of its own, the name to its left.
    pub fn row(self, ui: &mut Ui, value: f32) -> Option<ValueChange<f32>> {
        let mut to = value;
        let response = ui.horizontal(|ui| {
            let label = name(ui, self.label);
            let width = (ui.available_width() - 64.0).max(40.0);
            ui.spacing_mut().slider_width = width;
            ui.add(self.slider(&mut to)).labelled_by(label.id)
        });
        change(&response.inner.on_hover_text(self.hint), to)
    }

    /// A slider in a bar among others, its name before it.
    pub fn inline(self, ui: &mut Ui, value: f32, width_pt: f32) -> Option<ValueChange<f32>> {
        /// The width of the number after the slider: four digits and a unit.
        const NUMBER_PT: f32 = 56.0;
        let mut to = value;
        let font = egui::TextStyle::Body.resolve(ui.style());
        let name_pt =
            ui.painter().layout_no_wrap(self.label.into(), font, egui::Color32::WHITE).size().x;
        let room = vec2(
            name_pt + width_pt + NUMBER_PT + 2.0 * ui.spacing().item_spacing.x,
            ui.spacing().interact_size.y,
        );
        // In a wrapping bar, label and slider stay together.
        let inner = ui.allocate_ui_with_layout(room, Layout::left_to_right(Align::Center), |ui| {
            let label = ui.label(self.label);
            ui.spacing_mut().slider_width = width_pt;
            ui.add(self.slider(&mut to)).labelled_by(label.id)
        });
        change(&inner.inner.on_hover_text(self.hint), to)
    }

    /// A number alone, to be dragged or typed.
    pub fn field(self, ui: &mut Ui, value: f32) -> Option<ValueChange<f32>> {
        let mut to = value;
        let speed = (self.range.end() - self.range.start()) / 300.0;
        let drag = DragValue::new(&mut to)
            .range(self.range.clone())
            .speed(speed.min(1.0))
            .suffix(self.suffix)
            .fixed_decimals(self.decimals);
        let response = ui.add(drag);
        response.widget_info(|| egui::WidgetInfo::drag_value(true, f64::from(value)));
        set_accessible_name(&response, self.label);
        change(&response.on_hover_text(self.hint), to)
    }
}

/// Gives a widget a name for screen readers and tests.
pub fn set_accessible_name(response: &Response, label: &str) {
    let label = label.to_owned();
    response.ctx.accesskit_node_builder(response.id, |node| node.set_label(label));
}

/// A property's name; all have the same width.
pub fn name(ui: &mut Ui, text: &str) -> Response {
    let (rect, response) =
        ui.allocate_exact_size(vec2(76.0, ui.spacing().interact_size.y), egui::Sense::hover());
    let color = ui.visuals().text_color();
    let font = egui::TextStyle::Body.resolve(ui.style());
    ui.painter().text(rect.left_center(), egui::Align2::LEFT_CENTER, text, font, color);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, text));
    response
}

/// A choice among several options.
pub fn choice<T: Copy + PartialEq>(
    ui: &mut Ui,
    label: &str,
    current: T,
    choices: &[(T, &str)],
) -> Option<T> {
    let shown = choices.iter().find(|(choice, _)| *choice == current).map_or("", |(_, word)| word);
    let mut to = current;
    let combo =
        egui::ComboBox::from_id_salt(label).selected_text(sentence(shown)).show_ui(ui, |ui| {
            for (choice, word) in choices {
                ui.selectable_value(&mut to, *choice, sentence(word));
            }
        });
    set_accessible_name(&combo.response, label);
    (to != current).then_some(to)
}

/// As [`choice`], in a row with its name.
pub fn choice_row<T: Copy + PartialEq>(
    ui: &mut Ui,
    label: &str,
    current: T,
    choices: &[(T, &str)],
) -> Option<T> {
    ui.horizontal(|ui| {
        name(ui, label);
        choice(ui, label, current, choices)
    })
    .inner
}

/// A name such as “color-dodge” for display.
pub fn sentence(word: &str) -> String {
    let spaced = word.replace('-', " ");
    let mut letters = spaced.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

pub fn check(ui: &mut Ui, label: &str, hint: &str, on: bool) -> Option<bool> {
    let mut to = on;
    check_box(ui, &mut to, label).on_hover_text(hint).changed().then_some(to)
}

/// A box to tick, whose outline is seen while it is empty.
pub fn check_box(ui: &mut Ui, on: &mut bool, label: impl Into<String>) -> Response {
    outlined(ui, |ui| ui.checkbox(on, label.into()))
}

/// One of several choices, as a ring to fill.
pub fn radio<T: PartialEq>(
    ui: &mut Ui,
    current: &mut T,
    choice: T,
    label: impl Into<String>,
) -> Response {
    outlined(ui, |ui| ui.radio_value(current, choice, label.into()))
}

fn outlined(ui: &mut Ui, show: impl FnOnce(&mut Ui) -> Response) -> Response {
    let before = ui.visuals().widgets.inactive.bg_stroke;
    outline(ui);
    let response = show(ui);
    ui.visuals_mut().widgets.inactive.bg_stroke = before;
    response
}

/// A list in a dialog, as tall as its content, up to `most_pt` and the room in the window.
pub fn list(ui: &Ui, most_pt: f32) -> ScrollArea {
    /// The height of a dialog above and below its list.
    const AROUND_PT: f32 = 210.0;
    let height = (ui.ctx().content_rect().height() - AROUND_PT).max(120.0).min(most_pt);
    ScrollArea::vertical().max_height(height).min_scrolled_height(height)
}

/// The title of a part of a panel.
pub fn title(ui: &mut Ui, text: &str) {
    ui.add_space(2.0);
    ui.label(RichText::new(text).strong());
}

/// How far a job has come.
pub fn bar(ui: &mut Ui, share: Option<f32>, width_pt: f32) {
    match share {
        Some(share) => {
            drop(ui.add(ProgressBar::new(share).desired_width(width_pt).desired_height(8.0)))
        }
        None => drop(ui.spinner()),
    }
}

/// A field of color that can be clicked.
pub fn swatch(ui: &mut Ui, label: &str, color: Color, size: egui::Vec2) -> Response {
    let (rect, response) = ui.allocate_exact_size(size, egui::Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, label));
    let painter = ui.painter();
    painter.rect_filled(rect, 3.0, color32(Color { a: 255, ..color }));
    let rim = if response.hovered() {
        ui.visuals().widgets.hovered.fg_stroke
    } else {
        ui.visuals().window_stroke
    };
    painter.rect_stroke(rect, 3.0, rim, egui::StrokeKind::Inside);
    response.on_hover_text(format!("{label}: {color}"))
}
