//! The numbers of the grid, and what the pen snaps to. Each change is shown at once. Floor 7.

use super::{DialogAnswer, close, set_width};
use crate::language::tr;
use crate::requests::UiRequests;
use crate::session::actions::GuideAction;
use crate::session::{Action, Session};
use crate::tools::snap::{CanvasGrid, ViewAids};
use crate::widgets::{begin_with, check, number};
use eframe::egui::{Key, Ui};

pub fn show(ui: &mut Ui, session: &Session, requests: &mut UiRequests) -> DialogAnswer {
    set_width(ui, 320.0);
    ui.heading(tr("Grid and snapping"));
    let mut aids = session.tools.aids;
    grid(ui, &mut aids.grid);
    ui.separator();
    for (label, hint, get) in CHOICES {
        if let Some(on) = check(ui, label, hint, *get(&mut aids)) {
            *get(&mut aids) = on;
        }
    }
    if aids != session.tools.aids {
        requests.act(Action::Guide(GuideAction::Aids { aids }));
    }
    // Enter in a number sets it, and with it the grid is done.
    match ui.input(|input| input.key_pressed(Key::Enter)) {
        true => DialogAnswer::Close,
        false => close(ui),
    }
}

/// A setting of the snapping, to be read and written.
type Choice = fn(&mut ViewAids) -> &mut bool;

const CHOICES: [(&str, &str, Choice); 6] = [
    ("Show grid", "Lines at equal distances over the picture", |aids| &mut aids.grid_shown),
    ("Snap", "What you drag snaps to lines within eight points", |aids| &mut aids.snaps),
    ("To guides", "While they are shown", |aids| &mut aids.to_guides),
    ("To the grid", "While it is shown", |aids| &mut aids.to_grid),
    ("To the canvas", "Its edges and its middle", |aids| &mut aids.to_canvas),
    ("To layers", "The edges and middles of what other layers hold", |aids| &mut aids.to_layers),
];

fn grid(ui: &mut Ui, grid: &mut CanvasGrid) {
    let mut edit = |label: &str, value: &mut f32, range: std::ops::RangeInclusive<f32>| {
        let row = ui.horizontal(|ui| {
            let label = ui.label(tr(label));
            ui.add(number(value).range(range).speed(0.5).suffix(" px")).labelled_by(label.id)
        });
        row.inner
    };
    begin_with(&edit("Spacing", &mut grid.spacing, CanvasGrid::SPACING));
    edit("Offset x", &mut grid.offset.x, crate::math::COORDINATE);
    edit("Offset y", &mut grid.offset.y, crate::math::COORDINATE);
    ui.horizontal(|ui| {
        let label = ui.label(tr("Subdivisions"));
        ui.add(number(&mut grid.subdivisions).range(CanvasGrid::SUBDIVISIONS).speed(0.05))
            .labelled_by(label.id);
    });
}
