//! The list of shortcuts, and what this program is.
//! Floor 7.

use super::Answer;
use crate::app::commands;
use crate::app::widgets::named;
use crate::tools::ToolKind;
use eframe::egui::{Grid, RichText, ScrollArea, TextEdit, Ui};

/// What the mouse and held keys do on the canvas.
pub const ON_CANVAS: [(&str, &str); 12] = [
    ("Move the view", "Space and drag, or the middle button"),
    ("Zoom", "Wheel, or Ctrl and Space and drag"),
    ("Turn the view", "Shift and Space and drag"),
    ("Pan with the wheel", "Shift or Alt and the wheel"),
    ("Brush size", "Drag with the right button"),
    ("Straight line", "Shift and click with the brush"),
    ("Take a colour", "Alt and click with the brush"),
    ("Content under an anchor", "Ctrl and drag with the anchor tool"),
    ("Re-pin an anchor", "Shift and drag with the anchor tool"),
    ("Remove an anchor", "Alt and click with the anchor tool"),
    ("Scale, turn an image", "Shift, Ctrl and drag with the image tool"),
    ("Give a stroke up", "Escape"),
];

pub fn shortcuts(ui: &mut Ui, filter: &mut String) -> Answer {
    ui.set_width(460.0);
    ui.heading("Keyboard shortcuts");
    let field = ui.add(TextEdit::singleline(filter).hint_text("Find").desired_width(f32::INFINITY));
    named(&field, "Find a shortcut");
    let wanted = filter.to_lowercase();
    let shown = |name: &str| name.to_lowercase().contains(&wanted);
    ScrollArea::vertical().max_height(420.0).auto_shrink([false, false]).show(ui, |ui| {
        Grid::new("shortcuts").num_columns(2).striped(true).spacing([24.0, 4.0]).show(ui, |ui| {
            for row in ToolKind::ALL.iter().filter(|row| shown(row.label)) {
                ui.label(row.label);
                ui.label(RichText::new(row.key.to_string()).monospace());
                ui.end_row();
            }
            for (what, how) in ON_CANVAS.iter().filter(|(what, _)| shown(what)) {
                ui.label(*what);
                ui.label(*how);
                ui.end_row();
            }
            for command in commands::all().filter(|c| !c.name.is_empty() && !c.keys.is_empty() && shown(c.name)) {
                ui.label(command.name).on_hover_text(command.hint);
                let keys: Vec<String> = command.keys.iter().map(|keys| ui.ctx().format_shortcut(keys)).collect();
                ui.label(RichText::new(keys.join(", ")).monospace());
                ui.end_row();
            }
        });
    });
    if ui.button("Close").clicked() { Answer::Close } else { Answer::Open }
}

pub fn about(ui: &mut Ui) -> Answer {
    ui.set_width(360.0);
    ui.heading("Rilievo");
    ui.label(format!("Version {}", env!("CARGO_PKG_VERSION")));
    ui.label("Paint on the picture of a shape: brushes, gradients and photos bend over its normals and depth.");
    ui.weak("It computes what “Surface Flows for Image-based Shading Design” (2012) and “Radiance Scaling for Versatile Surface Enhancement” (2010) define.");
    if ui.button("Close").clicked() { Answer::Close } else { Answer::Open }
}
