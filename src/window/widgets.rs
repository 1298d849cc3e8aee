//! The window's own widgets: each has a name that a screen reader and a test can find, and
//! distinguishes dragging from its end. They take their names and hints in English and show them in
//! the language of the window. `value_bar` draws numbers. Floor 7.

mod number;
mod value_bar;

pub use number::number;

use super::icons::Icon;
use super::theme::{self, color32, outline};
use crate::language::{find_translation, tr, tr_number};
use crate::math::srgb::Color;
use eframe::egui::containers::menu::{MenuButton, MenuConfig};
use eframe::egui::{
    self, ProgressBar, Response, RichText, ScrollArea, TextEdit, Ui,
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
    /// What the shown number is to the value: 100 for a percentage of 1.
    pub factor: f32,
}

impl<'a> NumberField<'a> {
    pub fn new(label: &'a str, range: RangeInclusive<f32>, hint: &'a str) -> Self {
        Self {
            label: tr(label),
            hint: tr(hint),
            range,
            suffix: "",
            decimals: 2,
            logarithmic: false,
            factor: 1.0,
        }
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

    /// Shown as a percentage of 1.
    pub fn share(self) -> Self {
        Self { suffix: " %", decimals: 0, factor: 100.0, ..self }
    }

    /// A value as it is shown.
    pub fn format(&self, value: f32) -> String {
        // A zero has no sign.
        let shown = value * self.factor + 0.0;
        format!("{}{}", tr_number(&format!("{shown:.*}", self.decimals)), self.suffix)
    }

    /// A bar in a row of its own.
    pub fn row(self, ui: &mut Ui, value: f32) -> Option<ValueChange<f32>> {
        let width_pt = ui.available_width().max(60.0);
        value_bar::show(ui, &self, value, width_pt)
    }

    /// A bar among others, with its name and so much room for the drag.
    pub fn inline(self, ui: &mut Ui, value: f32, width_pt: f32) -> Option<ValueChange<f32>> {
        /// The width of the number: four digits and a unit, and the insets of both texts.
        const NUMBER_PT: f32 = 56.0;
        let font = egui::TextStyle::Body.resolve(ui.style());
        let name = ui.painter().layout_no_wrap(self.label.into(), font, egui::Color32::WHITE);
        value_bar::show(ui, &self, value, name.size().x + NUMBER_PT + 0.3 * width_pt)
    }

    /// A number alone, to be dragged or typed.
    pub fn field(self, ui: &mut Ui, value: f32) -> Option<ValueChange<f32>> {
        let mut to = value;
        let speed = (self.range.end() - self.range.start()) / 300.0;
        let drag = number(&mut to)
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
    let text = tr(text);
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
    let combo = egui::ComboBox::from_id_salt(label).selected_text(tr_sentence(shown));
    let combo = combo.show_ui(ui, |ui| {
        for (choice, word) in choices {
            ui.selectable_value(&mut to, *choice, tr_sentence(word));
        }
    });
    set_accessible_name(&combo.response, tr(label));
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
        ui.spacing_mut().combo_width = ui.available_width();
        choice(ui, label, current, choices)
    })
    .inner
}

/// A name such as “color-dodge” for display.
pub fn sentence(word: &str) -> String {
    capitalize(&word.replace('-', " "))
}

/// The same in the current language, by the row of what is displayed or of the name.
pub fn tr_sentence(word: &str) -> String {
    let english = sentence(word);
    match find_translation(&english) {
        Some(row) => row.to_owned(),
        None => find_translation(word).map_or(english, capitalize),
    }
}

fn capitalize(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

pub fn check(ui: &mut Ui, label: &str, hint: &str, on: bool) -> Option<bool> {
    let mut to = on;
    check_box(ui, &mut to, label).on_hover_text(tr(hint)).changed().then_some(to)
}

/// A box to tick, whose outline is seen while it is empty.
pub fn check_box(ui: &mut Ui, on: &mut bool, label: impl AsRef<str>) -> Response {
    show_outlined(ui, |ui| ui.checkbox(on, tr(label.as_ref())))
}

/// One of several choices, as a ring to fill.
pub fn radio<T: PartialEq>(
    ui: &mut Ui,
    current: &mut T,
    choice: T,
    label: impl AsRef<str>,
) -> Response {
    show_outlined(ui, |ui| ui.radio_value(current, choice, tr(label.as_ref())))
}

fn show_outlined(ui: &mut Ui, show: impl FnOnce(&mut Ui) -> Response) -> Response {
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
    ui.add_space(8.0);
    ui.label(RichText::new(tr(text)).strong());
}

/// Several choices on a common ground, of which one is on.
pub fn segments(ui: &mut Ui, show: impl FnOnce(&mut Ui)) {
    let track = egui::Frame::new().fill(theme::bar_ground(ui.visuals())).corner_radius(5);
    track.show(ui, |ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        show(ui);
    });
}

/// One of them.
pub fn segment(ui: &mut Ui, label: &str, hint: &str, on: bool) -> Response {
    let label = tr(label);
    let text = if on { RichText::new(label).strong() } else { RichText::new(label) };
    let button =
        egui::Button::selectable(on, text).min_size(vec2(0.0, ui.spacing().interact_size.y));
    ui.add(button).on_hover_text(tr(hint))
}

/// A button for what the tool needs less often; it stays open while something is set there.
pub fn more(ui: &mut Ui, show: impl FnOnce(&mut Ui)) {
    let stays = MenuConfig::new().close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside);
    let (button, _) = MenuButton::new(tr("More")).config(stays).ui(ui, |ui| {
        ui.set_width(250.0);
        show(ui);
    });
    set_accessible_name(&button, tr("More options"));
    button.on_hover_text(tr("What this tool needs less often"));
}

/// The height of a tab, points.
const TAB_PT: f32 = 24.0;
/// Around the content of a tab, and between its icon and its name, points.
const TAB_INSET_PT: f32 = 8.0;
const TAB_GAP_PT: f32 = 5.0;

/// The width of a tab that shows its name, points.
pub fn tab_width_pt(ui: &Ui, has_icon: bool, label: &str) -> f32 {
    let font = egui::TextStyle::Body.resolve(ui.style());
    let name = ui.painter().layout_no_wrap(label.into(), font, egui::Color32::WHITE);
    let icon_pt = if has_icon { Icon::Dots.grid() + TAB_GAP_PT } else { 0.0 };
    2.0 * TAB_INSET_PT + icon_pt + name.size().x
}

/// One of several names, in the language of the window, of which one is in front, with a line beneath
/// it. Without room for the name
/// only the icon is shown.
pub fn tab(ui: &mut Ui, icon: Option<Icon>, label: &str, shows_name: bool, on: bool) -> Response {
    let icon_pt = Icon::Dots.grid();
    let width = match shows_name {
        true => tab_width_pt(ui, icon.is_some(), label),
        false => icon_pt + 2.0 * TAB_INSET_PT - 2.0,
    };
    let (rect, response) = ui.allocate_exact_size(vec2(width, TAB_PT), egui::Sense::click());
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, on, label));
    let visuals = ui.visuals();
    let color = match on || response.hovered() || response.has_focus() {
        true => visuals.strong_text_color(),
        false => visuals.weak_text_color(),
    };
    let painter = ui.painter();
    let mut left = rect.left() + TAB_INSET_PT - if shows_name { 0.0 } else { 1.0 };
    if let Some(icon) = icon {
        let middle = egui::pos2(left + 0.5 * icon_pt, rect.center().y);
        let at = egui::Rect::from_center_size(middle, egui::Vec2::splat(icon_pt - 1.0));
        icon.draw(painter, at, color);
        left += icon_pt + TAB_GAP_PT;
    }
    if shows_name {
        let font = egui::TextStyle::Body.resolve(ui.style());
        let at = egui::pos2(left, rect.center().y);
        painter.text(at, egui::Align2::LEFT_CENTER, label, font, color);
    }
    if on || response.has_focus() {
        let line = egui::Stroke::new(2.0, theme::accent(ui.visuals()));
        painter.hline(rect.shrink2(vec2(4.0, 0.0)).x_range(), rect.bottom() - 1.0, line);
    }
    response
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
    draw_swatch(ui, label, color, rect, response)
}

/// The same at a place.
pub fn swatch_at(ui: &Ui, label: &str, color: Color, rect: egui::Rect) -> Response {
    let response = ui.interact(rect, ui.scope_id().with(label), egui::Sense::click());
    draw_swatch(ui, label, color, rect, response)
}

/// The same where the response is known.
pub fn draw_swatch(
    ui: &Ui,
    label: &str,
    color: Color,
    rect: egui::Rect,
    response: Response,
) -> Response {
    let label = tr(label);
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
