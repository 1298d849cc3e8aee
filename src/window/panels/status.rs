//! The status bar: zoom, the point under the pointer with the map values there, memory, the time of the last redraw,
//! and a hint for the current tool. Floor 7.

use crate::canvas::Canvas;
use crate::jobs::{JobKind, Jobs};
use crate::math::Vec2;
use crate::memory::spoken;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::Session;
use crate::usage::MemoryMeter;
use crate::widgets::bar;
use eframe::egui::{self, Button, RichText, Ui};

pub fn show(
    ui: &mut Ui,
    session: &Session,
    canvas: &Canvas,
    jobs: &Jobs,
    memory: &mut MemoryMeter,
    requests: &mut UiRequests,
) {
    ui.horizontal(|ui| {
        for job in jobs.under_way.iter().filter(|job| job.kind == JobKind::Working && job.is_long()) {
            ui.label(&job.name);
            bar(ui, job.share(), 90.0);
            if ui.small_button("Cancel").on_hover_text(format!("Give up: {}", job.name)).clicked() {
                job.progress.cancel();
            }
            ui.separator();
        }
        if !jobs.under_way.is_empty() {
            ui.ctx().request_repaint_after(std::time::Duration::from_millis(80));
        }
        let Some(tab) = session.active() else {
            if !say(ui, jobs) {
                ui.weak("Open a document, or drop a picture or a normal map on the window");
            }
            return;
        };
        let document = tab.shown();
        let percent = tab.view.map_or(100.0, |view| view.zoom * ui.ctx().pixels_per_point() * 100.0);
        if ui
            .add(Button::new(format!("{percent:.0} %")).frame(false))
            .on_hover_text("Click for actual pixels")
            .clicked()
        {
            requests.request(WindowRequest::Scale(1.0));
        }
        ui.weak(document.size.to_string());
        if tab.unwrapped().is_some() {
            ui.label("Unwrapped")
                .on_hover_text("You paint on the surface laid flat; View, Unwrapped shows the picture");
        }
        ui.separator();
        if let Some(rect) = canvas.selected().filter(|_| document.active_selection.is_some()) {
            let about = format!("Selected {} × {} at {}, {}", rect.width(), rect.height(), rect.x0, rect.y0);
            ui.label(about).on_hover_text("The rectangle around all that is selected");
            ui.separator();
        }
        if say(ui, jobs) {
            ui.separator();
        }
        // The canvas is drawn later: its state may still belong to the previous document.
        let is_here = |at: &Vec2| document.size.rect().contains(at.x.floor() as i32, at.y.floor() as i32);
        if let Some(at) = canvas.under.filter(is_here) {
            let (x, y) = (at.x.floor() as usize, at.y.floor() as usize);
            ui.label(RichText::new(format!("{x}, {y}")).monospace());
            if let Some(surface) = document.surface.as_deref().filter(|s| s.coverage(x, y) > 0) {
                let n = surface.normal(x, y);
                let about = format!("n {:+.2} {:+.2} {:+.2}  z {:.3}", n.x, n.y, n.z, surface.depth(x, y));
                ui.label(RichText::new(about).monospace())
                    .on_hover_text("The surface's normal and depth under the pointer");
            }
        } else {
            ui.weak(session.tool.row().hint);
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let took = format!("{:.0} ms", canvas.took.as_secs_f32() * 1000.0);
            let text = if canvas.is_busy { RichText::new("Painting…").weak() } else { RichText::new(took).weak() };
            ui.label(text).on_hover_text("Time of the last redraw");
            if let Some(bytes) = memory.bytes() {
                ui.weak(spoken(bytes)).on_hover_text("Memory used by the program");
            }
            if document.surface.is_none() {
                ui.weak("No surface: marks lie flat");
            }
        });
    });
}

/// What was said last, for as long as it stands; whether there is any.
fn say(ui: &mut Ui, jobs: &Jobs) -> bool {
    let said = jobs.said();
    if let Some(said) = said {
        ui.label(said);
        ui.ctx().request_repaint_after(std::time::Duration::from_secs(1));
    }
    said.is_some()
}
