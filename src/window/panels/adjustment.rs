//! What sets an adjustment or a filter: sliders, curves, levels and ramps, by the parameters that it
//! shows. Floor 7. Used by the properties of layers and by the dialogs that change paint.

use super::{colors, curve, ramp};
use crate::document::Histogram;
use crate::language::tr;
use crate::math::srgb::Color;
use crate::math::vec2;
use crate::paint::adjustment::{
    ColorTable, HueSaturation, Levels, LevelsRange, NumberParameter, ParameterName,
    ParameterVisitor, ToneCurve,
};
use crate::paint::{ColorAdjustment, GradientStop, PictureFilter};
use crate::theme::ACCENT;
use crate::tr;
use crate::widgets::{NumberField, ValueChange, check, choice_row, set_accessible_name};
use eframe::egui::{self, Color32, Pos2, Rect, Sense, Stroke, StrokeKind, Ui, pos2};

/// Changes of an adjustment, and whether a table was asked for.
#[derive(Default)]
pub struct AdjustmentAnswer {
    pub changed: Option<ValueChange<ColorAdjustment>>,
    pub asks_for_table: bool,
}

/// Shows the parameters; of those in groups, such as channels, one group at a time.
pub fn show(
    ui: &mut Ui,
    adjustment: &ColorAdjustment,
    histogram: Option<&Histogram>,
) -> AdjustmentAnswer {
    let mut next = adjustment.clone();
    let mut listed = GroupLister::default();
    next.visit(&mut listed);
    let tinted = matches!(&next, ColorAdjustment::HueSaturation(own) if own.colorize);
    let mut groups = listed.0;
    if let ColorAdjustment::HueSaturation(_) = next {
        groups.retain(|name| (name.key == HueSaturation::TINT) == tinted);
        if !tinted {
            groups.insert(0, ParameterName { key: "", label: "All colors", hint: "" });
        }
    }
    ui.push_id(adjustment.name(), |ui| {
        let group = chosen_group(ui, &groups);
        if let ColorAdjustment::Levels(levels) = &mut next {
            let changed = level_handles(ui, levels, group, histogram);
            if let Some(done) = changed {
                return answer(next, done);
            }
        }
        let mut shown = ParameterRows {
            ui,
            group,
            depth: 0,
            changed: None,
            asks_for_table: false,
            histogram: histogram.map(|found| counts_of(found, group)),
            hides_bare: matches!(next, ColorAdjustment::HueSaturation(_)) && !group.is_empty(),
        };
        next.visit(&mut shown);
        let ParameterRows { changed, asks_for_table, .. } = shown;
        let changed = changed.map(|done| ValueChange { to: next.clamp_to_ranges(), done });
        AdjustmentAnswer { changed, asks_for_table }
    })
    .inner
}

/// Shows the parameters of a filter.
pub fn show_filter(ui: &mut Ui, filter: &PictureFilter) -> Option<ValueChange<PictureFilter>> {
    let mut next = filter.clone();
    ui.push_id(filter.name(), |ui| {
        let mut shown = ParameterRows {
            ui,
            group: "",
            depth: 0,
            changed: None,
            asks_for_table: false,
            histogram: None,
            hides_bare: false,
        };
        next.visit(&mut shown);
        shown.changed.map(|done| ValueChange { to: next.clamp_to_ranges(), done })
    })
    .inner
}

fn answer(to: ColorAdjustment, done: bool) -> AdjustmentAnswer {
    let changed = Some(ValueChange { to: to.clamp_to_ranges(), done });
    AdjustmentAnswer { changed, asks_for_table: false }
}

/// The counts that suit a group: those of its channel, or of all.
fn counts_of<'h>(histogram: &'h Histogram, group: &str) -> &'h [u32; 256] {
    match group {
        "red" => &histogram.channels[0],
        "green" => &histogram.channels[1],
        "blue" => &histogram.channels[2],
        _ => &histogram.all,
    }
}

/// Finds the groups and curves of an adjustment.
#[derive(Default)]
struct GroupLister(Vec<ParameterName>);

impl ParameterVisitor for GroupLister {
    fn number(&mut self, _: NumberParameter, _: &mut f32) {}

    fn flag(&mut self, _: ParameterName, _: bool, _: &mut bool) {}

    fn color(&mut self, _: ParameterName, _: Color, _: &mut Color) {}

    fn curve(&mut self, name: ParameterName, _: &mut ToneCurve) {
        self.0.push(name);
    }

    fn stops(&mut self, _: ParameterName, _: &mut Vec<GradientStop>) {}

    fn table(&mut self, _: ParameterName, _: &mut Option<ColorTable>) {}

    fn group(&mut self, name: ParameterName, _: &mut dyn FnMut(&mut dyn ParameterVisitor)) {
        self.0.push(name);
    }
}

/// Which group is shown, by its key; the window remembers it.
fn chosen_group(ui: &mut Ui, groups: &[ParameterName]) -> &'static str {
    let Some(first) = groups.first() else { return "" };
    let kept = ui.scope_id().with("group");
    let last = ui.data(|data| data.get_temp::<&'static str>(kept));
    let known = |key: &&str| groups.iter().any(|name| name.key == *key);
    let group = last.filter(known).unwrap_or(first.key);
    if groups.len() < 2 {
        return group;
    }
    let choices: Vec<(&'static str, &str)> =
        groups.iter().map(|name| (name.key, name.label)).collect();
    let group = choice_row(ui, "Range", group, &choices).unwrap_or(group);
    ui.data_mut(|data| data.insert_temp(kept, group));
    group
}

/// Shows each parameter of the selected group, and those outside of groups.
struct ParameterRows<'a> {
    ui: &'a mut Ui,
    group: &'static str,
    depth: usize,
    /// Something changed; whether the widget was released.
    changed: Option<bool>,
    asks_for_table: bool,
    histogram: Option<&'a [u32; 256]>,
    /// Numbers outside of groups are not shown.
    hides_bare: bool,
}

impl ParameterRows<'_> {
    fn take<T>(&mut self, value: &mut T, changed: Option<ValueChange<T>>) {
        if let Some(ValueChange { to, done }) = changed {
            *value = to;
            self.changed = Some(done);
        }
    }
}

impl ParameterVisitor for ParameterRows<'_> {
    fn number(&mut self, parameter: NumberParameter, value: &mut f32) {
        if self.hides_bare && self.depth == 0 {
            return;
        }
        let NumberParameter { name, decimals, .. } = parameter;
        let field = NumberField::new(name.label, parameter.range(), name.hint).decimals(decimals);
        let changed = field.row(self.ui, *value);
        self.take(value, changed);
    }

    fn flag(&mut self, name: ParameterName, _: bool, value: &mut bool) {
        let to = check(self.ui, name.label, name.hint, *value);
        self.take(value, to.map(|to| ValueChange { to, done: true }));
    }

    fn color(&mut self, name: ParameterName, _: Color, value: &mut Color) {
        let changed = self.ui.horizontal(|ui| {
            let changed = colors::button(ui, name.label, *value);
            ui.label(tr(name.label));
            changed
        });
        self.take(value, changed.inner);
    }

    fn curve(&mut self, name: ParameterName, value: &mut ToneCurve) {
        if name.key != self.group {
            return;
        }
        let label = tr!("Curve of {name}", name = tr(name.label));
        let changed = tone_curve(self.ui, &label, value, self.histogram);
        self.take(value, changed);
        if self.ui.button(tr("Reset curve")).clicked() {
            *value = ToneCurve::default();
            self.changed = Some(true);
        }
    }

    fn stops(&mut self, _: ParameterName, value: &mut Vec<GradientStop>) {
        let changed = ramp::show(self.ui, value);
        self.take(value, changed);
    }

    fn table(&mut self, _: ParameterName, value: &mut Option<ColorTable>) {
        self.ui.horizontal_wrapped(|ui| {
            match value {
                Some(table) => {
                    let sides = if table.is_separate() { "1D" } else { "3D" };
                    ui.weak(format!("{} · {} · {sides}", table.title(), table.side()))
                }
                None => ui.weak(tr("No table yet: colors stay as they are")),
            };
            self.asks_for_table |= ui.button(tr("Choose .cube file…")).clicked();
        });
    }

    fn group(&mut self, name: ParameterName, inside: &mut dyn FnMut(&mut dyn ParameterVisitor)) {
        if name.key == self.group {
            self.depth += 1;
            inside(self);
            self.depth -= 1;
        }
    }
}

/// A curve of tones over the histogram of what lies beneath.
fn tone_curve(
    ui: &mut Ui,
    label: &str,
    value: &ToneCurve,
    histogram: Option<&[u32; 256]>,
) -> Option<ValueChange<ToneCurve>> {
    const HEIGHT_PT: f32 = 190.0;
    let points = value.points().iter().map(|[x, y]| vec2(*x, *y) / 255.0).collect();
    let through = |points: &[crate::math::Vec2]| {
        ToneCurve::new(points.iter().map(|p| [255.0 * p.x, 255.0 * p.y]).collect())
    };
    let line = |points: &[crate::math::Vec2]| {
        let spline = through(points).spline();
        let at = |i: u32| {
            let x = i as f32 / 64.0;
            vec2(x, spline.at(x).max(0.0).min(1.0))
        };
        (0..=64).map(at).collect()
    };
    let square = curve::CurveSquare {
        label,
        height_pt: HEIGHT_PT,
        most: ToneCurve::MOST_POINTS,
        least: 2,
        behind: &|painter, rect| paint_counts(painter, rect, histogram),
        line: &line,
    };
    Some(square.show(ui, points)?.map(|points| through(&points)))
}

fn paint_counts(painter: &egui::Painter, rect: Rect, counts: Option<&[u32; 256]>) {
    let Some(counts) = counts else { return };
    // A few very common tones, such as the ends, do not press all others down.
    let mut sorted = *counts;
    sorted.sort_unstable();
    let most = (sorted[250] as f32 * 1.1).max(1.0);
    let width = rect.width() / 256.0;
    for (i, count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
        let height = (*count as f32 / most).min(1.0) * rect.height();
        let x = rect.left() + i as f32 * width;
        let bar = Rect::from_min_max(
            pos2(x, rect.bottom() - height),
            pos2(x + width.max(1.0), rect.bottom()),
        );
        painter.rect_filled(bar, 0.0, Color32::from_gray(128).gamma_multiply(0.5));
    }
}

/// The histogram with a handle each for shadows, mid-tones and highlights; whether a change is
/// done.
fn level_handles(
    ui: &mut Ui,
    levels: &mut Levels,
    group: &str,
    histogram: Option<&Histogram>,
) -> Option<bool> {
    const HEIGHT_PT: f32 = 96.0;
    const FOOT_PT: f32 = 12.0;
    let range = match group {
        "red" => &mut levels.channels[0],
        "green" => &mut levels.channels[1],
        "blue" => &mut levels.channels[2],
        _ => &mut levels.master,
    };
    let size = egui::vec2(ui.available_width(), HEIGHT_PT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    set_accessible_name(&response, tr("Histogram of levels"));
    let graph = Rect::from_min_max(rect.min, pos2(rect.right(), rect.bottom() - FOOT_PT));
    let visuals = ui.visuals();
    let rim = visuals.widgets.noninteractive.bg_stroke;
    ui.painter().rect(graph, 3.0, visuals.extreme_bg_color, rim, StrokeKind::Inside);
    paint_counts(ui.painter(), graph, histogram.map(|found| counts_of(found, group)));
    let handles = handle_tones(range);
    let place = |tone: f32| graph.left() + tone / 255.0 * graph.width();
    for (tone, shade) in handles.into_iter().zip([0, 128, 255]) {
        let top = pos2(place(tone), graph.bottom());
        let triangle =
            vec![top, top + egui::vec2(-5.0, FOOT_PT - 2.0), top + egui::vec2(5.0, FOOT_PT - 2.0)];
        let line = Stroke::new(1.0, ACCENT);
        ui.painter().add(egui::Shape::convex_polygon(triangle, Color32::from_gray(shade), line));
    }
    let held = response.id.with("held");
    let at: Pos2 = response.interact_pointer_pos()?;
    let tone = ((at.x - graph.left()) / graph.width() * 255.0).clamp(0.0, 255.0);
    if response.drag_started() {
        let far = |i: &usize| (handles[*i] - tone).abs();
        let nearest = (0..3).min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(0);
        ui.data_mut(|data| data.insert_temp(held, nearest));
    }
    let which = ui.data(|data| data.get_temp::<usize>(held))?;
    if response.drag_stopped() {
        return Some(true);
    }
    if !response.dragged() {
        return None;
    }
    match which {
        0 => range.black = tone.round().min(range.white - 2.0).max(0.0),
        2 => range.white = tone.round().max(range.black + 2.0),
        _ => {
            // The tone that becomes mid-gray: its share of the range to the power 1/γ is a half.
            let share = (tone - range.black) / (range.white - range.black).max(2.0);
            range.gamma = (share.clamp(0.001, 0.999).ln() / 0.5f32.ln()).clamp(0.1, 9.99);
        }
    }
    Some(false)
}

/// The tones at which the handles stand.
fn handle_tones(range: &LevelsRange) -> [f32; 3] {
    let middle = range.black + 0.5f32.powf(range.gamma) * (range.white - range.black);
    [range.black, middle, range.white]
}
