//! Paths and figures: what new ones are like, in the options bar, and what the selected one is, in
//! Properties. Floor 7. Not here: handles on the canvas (`canvas::path_handles`).

use super::colors;
use super::setter::LayerSetter;
use crate::language::tr;
use crate::math::srgb::Color;
use crate::paint::{Figure, FigureKind, LivePath, PathCap, PathGeometry, PathJoin, PathRule};
use crate::requests::UiRequests;
use crate::session::actions::PathAction;
use crate::session::{Action, Property, Session};
use crate::tools::ToolKind;
use crate::tools::path::PathSettings;
use crate::tr;
use crate::widgets::{NumberField, ValueChange, check, choice, choice_row, more};
use eframe::egui::Ui;
use std::ops::RangeInclusive;

/// The outlines that a bar offers, px; wider ones can be typed.
const OUTLINE: RangeInclusive<f32> = 0.0..=100.0;
const OUTLINE_HINT: &str = "The width of the line along the path; 0: none";
const FILL_HINT: &str = "Filled with a color";
const FRAME_HINT: &str =
    "What lies beneath it in its group is seen inside of it only, as in a comic's panel";

/// The options of the path tool and the figure tool, in a bar.
pub fn options(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let settings = session.tools.path;
    let mut push = |to: Option<PathSettings>| {
        requests.actions.extend(to.map(|path| Action::Path(PathAction::Settings { path })))
    };
    if session.tool == ToolKind::Figure {
        let kind = choice(ui, "Kind of figure", settings.figure.kind, &FigureKind::LABELS);
        let with = |figure: Figure| PathSettings { figure, ..settings };
        push(kind.map(|kind| with(Figure { kind, ..settings.figure })));
        // New ones lie level.
        let names = settings.figure.kind.numbers().iter().copied();
        let names: Vec<&str> = names.filter(|name| *name != "rotation").collect();
        let number =
            figure_numbers(settings.figure, &names, |field, value| field.inline(ui, value, 60.0));
        push(number.map(|changed| with(changed.to)));
    }
    let fill = check(ui, "Fill", "New ones are filled with the first color", settings.fills);
    push(fill.map(|fills| PathSettings { fills, ..settings }));
    let outline = NumberField::new("Outline", OUTLINE, OUTLINE_HINT).pixels();
    let outline = outline.inline(ui, settings.outline, 60.0);
    push(outline.map(|changed| PathSettings { outline: changed.to, ..settings }));
    more(ui, |ui| {
        let cap = choice_row(ui, "Ends", settings.cap, &PathCap::LABELS);
        push(cap.map(|cap| PathSettings { cap, ..settings }));
        let join = choice_row(ui, "Corners", settings.join, &PathJoin::LABELS);
        push(join.map(|join| PathSettings { join, ..settings }));
    });
    ui.weak(tr(session.tool.hint()));
}

/// Some numbers of a figure, by their names; the changed figure.
fn figure_numbers(
    figure: Figure,
    names: &[&str],
    mut show: impl FnMut(NumberField<'static>, f32) -> Option<ValueChange<f32>>,
) -> Option<ValueChange<Figure>> {
    let mut changed = None;
    for setting in Figure::SETTINGS {
        if !names.contains(&setting.name) {
            continue;
        }
        let range = setting.range.clone();
        let field =
            |most: f32| NumberField::new(setting.label, *range.start()..=most, setting.hint);
        let field = match setting.name {
            // The rotation of the placement is beneath it.
            "rotation" => NumberField::new("Turn", -180.0..=180.0, setting.hint).degrees(),
            "sides" => field(24.0).decimals(0),
            _ if setting.is_length => field(200.0).pixels(),
            _ => field(*range.end()),
        };
        if let Some(to) = show(field, (setting.get)(&figure)) {
            changed = Some(to.map(|value| {
                let mut next = figure;
                (setting.set)(&mut next, value);
                next
            }));
        }
    }
    changed
}

/// The properties of the selected path.
pub fn show(ui: &mut Ui, path: &LivePath, setter: &mut LayerSetter) {
    match &path.geometry {
        PathGeometry::Figure(figure) => show_figure(ui, path, figure, setter),
        PathGeometry::Nodes(lines) => {
            let (nodes, lines) = (path.count_nodes(), lines.len());
            ui.weak(match lines {
                1 => tr!("{nodes} nodes, 1 line; take the path tool to move them", nodes),
                _ => {
                    tr!(
                        "{nodes} nodes, {lines} lines; take the path tool to move them",
                        nodes,
                        lines
                    )
                }
            });
            let rule = choice_row(ui, "Inside", path.rule, &PathRule::LABELS);
            set(setter, rule.map(|rule| LivePath { rule, ..path.clone() }));
        }
    }
    show_fill(ui, path, setter);
    show_outline(ui, path, setter);
    if let Some(frames) = check(ui, "Frame of its group", FRAME_HINT, path.frames) {
        set(setter, Some(LivePath { frames, ..path.clone() }));
    }
    ui.separator();
}

/// Another path, as a step.
fn set(setter: &mut LayerSetter, path: Option<LivePath>) {
    setter.take(path.map(|path| ValueChange { to: Property::Drawn { path }, done: true }));
}

/// Another path, as far as a widget was moved.
fn take(setter: &mut LayerSetter, path: Option<ValueChange<LivePath>>) {
    setter.take(path.map(|changed| changed.map(|path| Property::Drawn { path })));
}

fn show_figure(ui: &mut Ui, path: &LivePath, figure: &Figure, setter: &mut LayerSetter) {
    let with = |figure: Figure| LivePath { geometry: figure.into(), ..path.clone() };
    let kind = choice_row(ui, "Kind", figure.kind, &FigureKind::LABELS);
    set(setter, kind.map(|kind| with(Figure { kind, ..*figure })));
    let names = figure.kind.numbers();
    let number = figure_numbers(*figure, names, |field, value| field.row(ui, value));
    take(setter, number.map(|changed| changed.map(with)));
    let hint = "Its corners become nodes, which the path tool moves";
    if ui.button(tr("To nodes")).on_hover_text(tr(hint)).clicked() {
        let layer = setter.layer.clone();
        setter.requests.act(Action::Path(PathAction::ToNodes { layer }));
    }
}

fn show_fill(ui: &mut Ui, path: &LivePath, setter: &mut LayerSetter) {
    ui.horizontal(|ui| {
        if let Some(fills) = check(ui, "Fill", FILL_HINT, path.fill.is_some()) {
            // What was neither filled nor outlined in another color becomes black.
            let color = if path.outline > 0.0 { path.outline_color } else { Color::BLACK };
            set(setter, Some(LivePath { fill: fills.then_some(color), ..path.clone() }));
        }
        if let Some(color) = path.fill {
            let changed = colors::button(ui, "Fill color", color);
            let with = |color| LivePath { fill: Some(color), ..path.clone() };
            take(setter, changed.map(|changed| changed.map(with)));
        }
    });
}

fn show_outline(ui: &mut Ui, path: &LivePath, setter: &mut LayerSetter) {
    let field = NumberField::new("Outline", OUTLINE, OUTLINE_HINT).pixels();
    let changed = field.row(ui, path.outline);
    take(setter, changed.map(|c| c.map(|outline| LivePath { outline, ..path.clone() })));
    if path.outline <= 0.0 {
        return;
    }
    ui.horizontal(|ui| {
        let changed = colors::button(ui, "Outline color", path.outline_color);
        let with = |outline_color| LivePath { outline_color, ..path.clone() };
        take(setter, changed.map(|changed| changed.map(with)));
        ui.label(tr("Outline color"));
    });
    let cap = choice_row(ui, "Ends", path.cap, &PathCap::LABELS);
    set(setter, cap.map(|cap| LivePath { cap, ..path.clone() }));
    let join = choice_row(ui, "Corners", path.join, &PathJoin::LABELS);
    set(setter, join.map(|join| LivePath { join, ..path.clone() }));
    let [dash, gap] = [0, 1].map(|i| path.dashes.get(i).copied().unwrap_or(0.0));
    let number = |label, hint| NumberField::new(label, OUTLINE, hint).pixels();
    let with = |dash: f32, gap: f32| {
        let dashes = if dash > 0.0 || gap > 0.0 { vec![dash, gap] } else { Vec::new() };
        LivePath { dashes, ..path.clone() }
    };
    let changed = number("Dash", "The length of dashes; 0 with rounded ends: dots").row(ui, dash);
    take(setter, changed.map(|c| c.map(|dash| with(dash, gap))));
    let changed = number("Gap", "What lies between two dashes; 0: one line").row(ui, gap);
    take(setter, changed.map(|c| c.map(|gap| with(dash, gap))));
}
