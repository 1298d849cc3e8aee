//! A number as a bar: its name on the left, its value on the right, filled as far as the value goes.
//! A drag sets it, with Shift finely; a double-click, a right-click, or Enter while it has the
//! focus, types it.
//! Floor 7.

use super::number::parse_number;
use super::{NumberField, ValueChange, begin_with, set_accessible_name};
use crate::theme;
use eframe::egui::accesskit::{Action, ActionData};
use eframe::egui::{
    self, Align2, CursorIcon, DragValue, EventFilter, Id, Key, Modifiers, PointerButton, Rect,
    Response, Sense, Stroke, StrokeKind, TextStyle, TextWrapMode, Ui, WidgetInfo, WidgetText, pos2,
    vec2,
};
use std::ops::RangeInclusive;

/// The distance of the texts from the ends of the bar, points.
const INSET_PT: f32 = 7.0;
/// How much slower a drag with Shift is.
const FINE: f32 = 0.1;
/// The longest time between the first press of a double-click and the second.
const DOUBLE_CLICK_SECS: f64 = 0.5;

/// A bar of a width.
pub fn show(
    ui: &mut Ui,
    field: &NumberField<'_>,
    value: f32,
    width_pt: f32,
) -> Option<ValueChange<f32>> {
    let size = vec2(width_pt, ui.spacing().interact_size.y);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    let typing = response.id.with("typed");
    if ui.data(|data| data.get_temp::<bool>(typing)).unwrap_or_default() {
        return edit_as_text(ui, field, value, rect, typing);
    }
    let along = Along { range: field.range.clone(), is_logarithmic: field.logarithmic };
    let to = read_change(ui, field, &along, value, &response);
    tell(ui, field, value, &response);
    if ui.is_rect_visible(rect) {
        draw(ui, field, &along, to.unwrap_or(value), rect, &response);
    }
    let begins = response.double_clicked()
        || response.secondary_clicked()
        || response.has_focus() && ui.input_mut(|i| i.consume_key(Modifiers::NONE, Key::Enter));
    if begins {
        ui.data_mut(|data| data.insert_temp(typing, true));
    }
    if response.double_clicked() {
        // The first of the two clicks has set the value where it was.
        let before = ui.data(|data| data.get_temp::<(f32, f64)>(response.id.with("before")))?.0;
        return (before != value).then_some(ValueChange { to: before, done: true });
    }
    let (is_held, is_over) = (is_held(ui, &response), is_over(&response));
    let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal);
    if !is_held && !field.hint.is_empty() {
        response.on_hover_text(field.hint);
    }
    // The end of a drag is said even where its last value was said before.
    let to = to.filter(|to| *to != value).or(is_over.then_some(value))?;
    Some(ValueChange { to, done: is_over || !is_held })
}

fn is_held(ui: &Ui, response: &Response) -> bool {
    response.is_pointer_button_down_on() && ui.input(|input| input.pointer.primary_down())
}

/// Whether it was let go in this frame.
fn is_over(response: &Response) -> bool {
    response.drag_stopped_by(PointerButton::Primary) || response.clicked()
}

/// Where values are along the bar.
struct Along {
    range: RangeInclusive<f32>,
    is_logarithmic: bool,
}

impl Along {
    /// What is drawn to scale: small numbers have more room where it is logarithmic.
    fn scale_value(&self, value: f32) -> f32 {
        let (low, high) = (*self.range.start(), *self.range.end());
        if !self.is_logarithmic {
            return value;
        }
        if low > 0.0 {
            return value.max(low).ln();
        }
        let unit = self.unit(low, high);
        value.signum() * (value.abs() / unit).ln_1p()
    }

    fn unscale_value(&self, scaled: f32) -> f32 {
        let (low, high) = (*self.range.start(), *self.range.end());
        if !self.is_logarithmic {
            return scaled;
        }
        if low > 0.0 {
            return scaled.exp();
        }
        scaled.signum() * scaled.abs().exp_m1() * self.unit(low, high)
    }

    /// Below this a logarithmic bar that holds 0 is nearly linear.
    fn unit(&self, low: f32, high: f32) -> f32 {
        (0.01 * low.abs().max(high.abs())).max(f32::MIN_POSITIVE)
    }

    /// The share of the bar's width at which a value is, in `[0, 1]`.
    fn share(&self, value: f32) -> f32 {
        let [low, high] = [*self.range.start(), *self.range.end()].map(|end| self.scale_value(end));
        ((self.scale_value(value) - low) / (high - low)).max(0.0).min(1.0)
    }

    fn value(&self, share: f32) -> f32 {
        let [low, high] = [*self.range.start(), *self.range.end()].map(|end| self.scale_value(end));
        let value = self.unscale_value(low + (high - low) * share.max(0.0).min(1.0));
        value.max(*self.range.start()).min(*self.range.end())
    }

    /// Where the filled part begins: at 0, if that is on the bar.
    fn origin(&self) -> f32 {
        self.share(0.0_f32.max(*self.range.start()).min(*self.range.end()))
    }
}

/// What the pointer, the arrow keys or a screen reader make of the value.
fn read_change(
    ui: &Ui,
    field: &NumberField<'_>,
    along: &Along,
    value: f32,
    response: &Response,
) -> Option<f32> {
    let rounded = |value: f32| {
        let places = 10.0_f32.powi(field.decimals as i32) * field.factor;
        ((value * places).round() / places).max(*along.range.start()).min(*along.range.end())
    };
    let asked = ui.input(|input| {
        let asked = input.accesskit_action_requests(response.id, Action::SetValue);
        let number = |request: &egui::accesskit::ActionRequest| match request.data {
            Some(ActionData::NumericValue(value)) => Some(value as f32),
            _ => None,
        };
        asked.filter_map(number).last()
    });
    if let Some(asked) = asked.filter(|asked| asked.is_finite()) {
        return Some(rounded(asked));
    }
    let steps = keyed_steps(ui, response);
    if steps != 0 {
        let step = (0.01 * (along.range.end() - along.range.start()))
            .max(10.0_f32.powi(-(field.decimals as i32)) / field.factor);
        let by_share = along.value(along.share(value) + 0.01 * steps as f32);
        let next = if field.logarithmic { by_share } else { value + step * steps as f32 };
        return Some(rounded(next));
    }
    if !is_held(ui, response) && !is_over(response) {
        return None;
    }
    let at = response.interact_pointer_pos()?;
    let [kept, before] = ["share", "before"].map(|name| response.id.with(name));
    let (is_pressed, now) = ui.input(|input| (input.pointer.primary_pressed(), input.time));
    let last = ui.data(|data| data.get_temp::<(f32, f64)>(before));
    if is_pressed && last.is_none_or(|(_, at)| now - at > DOUBLE_CLICK_SECS) {
        ui.data_mut(|data| data.insert_temp(before, (value, now)));
    }
    let (fine, by) = ui.input(|i| (i.modifiers.shift, i.pointer.delta().x));
    let share = if fine {
        let from = ui.data(|data| data.get_temp::<f32>(kept)).unwrap_or(along.share(value));
        from + FINE * by / response.rect.width()
    } else {
        (at.x - response.rect.left()) / response.rect.width()
    };
    let is_over = is_over(response);
    ui.data_mut(|data| match is_over {
        true => data.remove::<f32>(kept),
        false => {
            data.insert_temp(kept, share.max(0.0).min(1.0));
        }
    });
    Some(rounded(along.value(share)))
}

/// Steps of the arrow keys, or of a screen reader.
fn keyed_steps(ui: &Ui, response: &Response) -> i32 {
    let (id, has_focus) = (response.id, response.has_focus());
    if has_focus {
        let arrows = EventFilter { horizontal_arrows: true, ..Default::default() };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(id, arrows));
    }
    ui.input(|input| {
        let asked = |action| input.num_accesskit_action_requests(id, action) as i32;
        let pressed = |key| if has_focus { input.num_presses(key) as i32 } else { 0 };
        asked(Action::Increment) - asked(Action::Decrement) + pressed(Key::ArrowRight)
            - pressed(Key::ArrowLeft)
    })
}

/// Its name, value and range for screen readers and tests.
fn tell(ui: &Ui, field: &NumberField<'_>, value: f32, response: &Response) {
    let enabled = ui.is_enabled();
    response.widget_info(|| WidgetInfo::slider(enabled, f64::from(value), field.label));
    ui.ctx().accesskit_node_builder(response.id, |node| {
        node.set_min_numeric_value(f64::from(*field.range.start()));
        node.set_max_numeric_value(f64::from(*field.range.end()));
        [Action::SetValue, Action::Increment, Action::Decrement]
            .into_iter()
            .for_each(|action| node.add_action(action));
    });
}

fn draw(
    ui: &Ui,
    field: &NumberField<'_>,
    along: &Along,
    value: f32,
    rect: Rect,
    response: &Response,
) {
    let is_held = is_held(ui, response);
    let look = ui.style().interact(response);
    let painter = ui.painter();
    let ground = theme::bar_ground(ui.visuals());
    painter.rect_filled(rect, look.corner_radius, ground);
    let (from, to) = (along.origin(), along.share(value));
    let at = |share: f32| rect.left() + share * rect.width();
    let filled = Rect::from_min_max(
        pos2(at(from.min(to)), rect.top()),
        pos2(at(from.max(to)), rect.bottom()),
    );
    let is_hot = is_held || response.hovered();
    let fill = theme::bar_fill(ui.visuals(), is_held);
    // Clipped, so that its outer corners are as round as the bar's.
    painter.with_clip_rect(filled.intersect(ui.clip_rect())).rect_filled(
        rect,
        look.corner_radius,
        fill,
    );
    if is_hot || from > 0.0 {
        let mark = Stroke::new(1.5, theme::mark_on_bar(ui.visuals()));
        let x = at(to).max(rect.left() + 1.0).min(rect.right() - 1.0);
        painter.vline(x, rect.shrink(2.0).y_range(), mark);
    }
    if response.has_focus() {
        let rim = ui.visuals().selection.stroke;
        painter.rect_stroke(rect, look.corner_radius, rim, StrokeKind::Inside);
    }
    texts(ui, field, value, rect, look.text_color());
}

/// The name on the left, cut off where the value begins.
fn texts(ui: &Ui, field: &NumberField<'_>, value: f32, rect: Rect, color: egui::Color32) {
    let painter = ui.painter_at(rect);
    let font = TextStyle::Body.resolve(ui.style());
    let strong = ui.visuals().strong_text_color();
    let right = pos2(rect.right() - INSET_PT, rect.center().y);
    let shown = painter.text(right, Align2::RIGHT_CENTER, field.format(value), font, strong);
    let room = (shown.left() - 6.0 - rect.left() - INSET_PT).max(0.0);
    let name = WidgetText::from(egui::RichText::new(field.label).color(color));
    let name = name.into_galley(ui, Some(TextWrapMode::Truncate), room, TextStyle::Body);
    let top = rect.center().y - 0.5 * name.size().y;
    painter.galley(pos2(rect.left() + INSET_PT, top), name, color);
}

/// The field in its place while the number is typed.
fn edit_as_text(
    ui: &mut Ui,
    field: &NumberField<'_>,
    value: f32,
    rect: Rect,
    typing: Id,
) -> Option<ValueChange<f32>> {
    let mut to = value;
    let (factor, suffix) = (f64::from(field.factor), field.suffix);
    let number = DragValue::new(&mut to)
        .range(field.range.clone())
        .update_while_editing(false)
        .custom_formatter(|value, _| field.format(value as f32))
        .custom_parser(move |text| {
            let digits = text.trim().trim_end_matches(suffix.trim());
            parse_number(digits).map(|value| value / factor)
        });
    let response = ui.put(rect, number);
    set_accessible_name(&response, field.label);
    begin_with(&response);
    let was_focused = response.lost_focus();
    if was_focused {
        ui.data_mut(|data| data.remove::<bool>(typing));
    }
    (response.changed() && to != value).then_some(ValueChange { to, done: true })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_on_the_bar_is_the_value_that_is_drawn_there() {
        for (range, is_logarithmic) in [
            (0.0..=1.0, false),
            (-180.0..=180.0, false),
            (1.0..=1000.0, true),
            (0.0..=50.0, true),
            (-400.0..=400.0, true),
        ] {
            let along = Along { range: range.clone(), is_logarithmic };
            for i in 0..=20 {
                let share = i as f32 / 20.0;
                let value = along.value(share);
                assert!(range.contains(&value), "{range:?}: {value}");
                assert!((along.share(value) - share).abs() < 1e-4, "{range:?} at {share}");
            }
            let ends = [along.value(-1.0) - range.start(), along.value(2.0) - range.end()];
            let least = 1e-6 * (range.end() - range.start());
            assert!(ends.iter().all(|off| off.abs() <= least), "{range:?}: {ends:?}");
        }
    }

    #[test]
    fn a_signed_bar_is_filled_from_its_zero() {
        let along = Along { range: -2.0..=2.0, is_logarithmic: false };
        assert_eq!(along.origin(), 0.5);
        assert_eq!(Along { range: 1.0..=9.0, is_logarithmic: true }.origin(), 0.0);
    }

    #[test]
    fn small_numbers_have_more_room_where_it_is_logarithmic() {
        let along = Along { range: 1.0..=1000.0, is_logarithmic: true };
        assert!((along.value(0.5) - 31.62).abs() < 0.01, "{}", along.value(0.5));
    }
}
