//! The status bar: zoom, the point under the pointer, messages and a hint for the current tool; if
//! they are asked for, the map values there, memory, and the time of the last redraw. Floor 7.

use crate::canvas::Canvas;
use crate::document::{Document, MemoryUse};
use crate::jobs::{JobKind, JobWindow, Jobs, RunningJob};
use crate::language::{tr, tr_amount, tr_message, tr_number};
use crate::math::Vec2;
use crate::memory::bytes_text;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::memory::DocumentMemory;
use crate::session::{OpenDocument, Session};
use crate::tr;
use crate::usage::{KEPT_SHARE, MemoryMeter};
use crate::widgets::{NumberField, bar, set_accessible_name};
use eframe::egui::{Align, Button, Grid, Label, Layout, RichText, Ui};

pub fn show<W: JobWindow>(
    ui: &mut Ui,
    session: &Session,
    canvas: &Canvas,
    jobs: &Jobs<W>,
    (details, kept_share): (Option<&mut MemoryMeter>, f32),
    requests: &mut UiRequests,
) {
    ui.horizontal(|ui| {
        show_jobs(ui, jobs);
        let Some(open) = session.active() else {
            if !say(ui, jobs) {
                ui.weak(tr("Open a document, or drop a picture or a normal map on the window"));
            }
            return;
        };
        let document = open.shown_document();
        show_view(ui, open, requests);
        show_selection(ui, canvas, document);
        if say(ui, jobs) {
            ui.separator();
        }
        // The canvas is drawn later: its state may still belong to the previous document.
        let is_here =
            |at: &Vec2| document.size.rect().contains(at.x.floor() as i32, at.y.floor() as i32);
        let under = canvas.under.filter(is_here);
        if let Some(at) = under {
            show_point(ui, document, at, details.is_some());
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if let Some(memory) = details {
                show_measurements(ui, session, canvas, (memory, kept_share), requests);
            }
            if document.surface.is_none() {
                ui.weak(tr("No surface: marks stay flat"));
            }
            if under.is_none() {
                // What there is no room for is shown under the pointer.
                let hint = Label::new(RichText::new(tr(session.tool.hint())).weak()).truncate();
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| ui.add(hint));
            }
        });
    });
}

/// What is under way, each with its share and a button that cancels it.
fn show_jobs<W: JobWindow>(ui: &mut Ui, jobs: &Jobs<W>) {
    let is_shown =
        |job: &RunningJob| matches!(job.kind, JobKind::Working | JobKind::Looking) && job.is_long();
    for job in jobs.under_way.iter().filter(|job| is_shown(job)) {
        ui.label(tr_message(&job.title()));
        bar(ui, job.share(), 90.0);
        let hint = tr!("Cancel: {job}", job = tr_message(&job.name));
        if ui.small_button(tr("Cancel")).on_hover_text(hint).clicked() {
            job.progress.cancel();
        }
        ui.separator();
    }
    if !jobs.under_way.is_empty() {
        ui.ctx().request_repaint_after(std::time::Duration::from_millis(80));
    }
}

/// The zoom, the canvas's size, and whether the planes of the surface are painted on.
fn show_view(ui: &mut Ui, open: &OpenDocument, requests: &mut UiRequests) {
    let percent = open.view.map_or(100.0, |view| view.zoom * ui.ctx().pixels_per_point() * 100.0);
    if ui
        .add(Button::new(format!("{percent:.0} %")).frame(false))
        .on_hover_text(tr("Click for actual pixels"))
        .clicked()
    {
        requests.request(WindowRequest::Scale(1.0));
    }
    ui.weak(open.shown_document().size.to_string());
    if open.unwrap_settings().is_some() {
        ui.label(tr("Unwrapped")).on_hover_text(tr(
            "You are painting on the unwrapped surface; View, Unwrapped shows the picture",
        ));
    }
    ui.separator();
}

/// The rectangle around the selection, if there is one.
fn show_selection(ui: &mut Ui, canvas: &Canvas, document: &Document) {
    let Some(rect) = canvas.selected_rect().filter(|_| document.active_selection.is_some()) else {
        return;
    };
    let about = tr!(
        "Selected {width} × {height} at {x}, {y}",
        width = rect.width(),
        height = rect.height(),
        x = rect.x0,
        y = rect.y0
    );
    ui.label(about).on_hover_text(tr("The rectangle around all that is selected"));
    ui.separator();
}

/// The point under the pointer, and what the maps hold there if it is asked for.
fn show_point(ui: &mut Ui, document: &Document, at: Vec2, is_detailed: bool) {
    let (x, y) = (at.x.floor() as usize, at.y.floor() as usize);
    ui.label(RichText::new(format!("{x}, {y}")).monospace());
    let surface = document.surface.as_deref();
    if let Some(surface) = surface.filter(|s| is_detailed && s.coverage(x, y) > 0) {
        let n = surface.normal(x, y);
        let about = format!("n {:+.2} {:+.2} {:+.2}  z {:.3}", n.x, n.y, n.z, surface.depth(x, y));
        ui.label(RichText::new(tr_number(&about)).monospace())
            .on_hover_text(tr("The surface's normal and depth under the pointer"));
    }
}

/// The time of the last redraw, and the memory of the document.
fn show_measurements(
    ui: &mut Ui,
    session: &Session,
    canvas: &Canvas,
    (memory, kept_share): (&mut MemoryMeter, f32),
    requests: &mut UiRequests,
) {
    let took = format!("{:.0} ms", canvas.took.as_secs_f32() * 1000.0);
    let took = if canvas.is_busy { tr("Painting…").to_owned() } else { took };
    ui.weak(took).on_hover_text(tr("Time of the last redraw"));
    let is_idle = !canvas.is_busy && !ui.input(|input| input.pointer.any_down());
    let used = memory.documents(session, kept_share, is_idle);
    memory_menu(ui, memory, kept_share, used, requests);
}

/// An amount of memory, as the language of the window writes numbers.
fn memory_text(bytes: u64) -> String {
    tr_amount(&bytes_text(bytes)).into_owned()
}

/// How much may be kept for speed.
pub fn cache_limit(
    ui: &mut Ui,
    memory: &mut MemoryMeter,
    kept_share: f32,
    requests: &mut UiRequests,
) {
    let percent = *KEPT_SHARE.start() * 100.0..=*KEPT_SHARE.end() * 100.0;
    let hint = "Share of the machine's memory. Beyond it, old steps of the history drop their \
                rendered pictures, which are rendered again on undo";
    let field = NumberField::new("Cache limit", percent, hint).percent();
    if let Some(change) = field.row(ui, (kept_share * 100.0).round()) {
        requests.request(WindowRequest::KeptShare(change.map(|percent| percent / 100.0).to));
    }
    let (limit, machine) =
        (memory_text(memory.limit(kept_share)), memory_text(memory.machine_bytes()));
    ui.weak(tr!("{limit} of {machine} for caches, in all documents", limit, machine));
}

/// The memory of the document in front; the menu lists it, and sets how much may be kept for speed.
fn memory_menu(
    ui: &mut Ui,
    memory: &mut MemoryMeter,
    kept_share: f32,
    used: DocumentMemory,
    requests: &mut UiRequests,
) {
    let MemoryUse { painted, pictures, maps, kept } = used.front;
    let text = RichText::new(memory_text(used.front.total())).weak();
    let button = ui.menu_button(text, |ui| {
        ui.set_width(300.0);
        let rows = [
            ("Painted, with its history", painted),
            ("Placed pictures", pictures),
            ("Maps of the shape", maps),
            ("Caches", kept),
        ];
        Grid::new("memory").num_columns(2).show(ui, |ui| {
            let others = used.all.total() - used.front.total();
            let program = memory.bytes().map(|bytes| ("The whole program", bytes));
            let rows = rows
                .into_iter()
                .chain((others > 0).then_some(("Other documents", others)))
                .chain(program);
            for (name, bytes) in rows {
                ui.label(tr(name));
                ui.label(memory_text(bytes));
                ui.end_row();
            }
        });
        ui.separator();
        cache_limit(ui, memory, kept_share, requests);
    });
    let about = tr!(
        "Memory of this document: {painted} painted, {pictures} of pictures, {maps} of maps, {caches} \
         of caches. Click for more",
        painted = memory_text(painted),
        pictures = memory_text(pictures),
        maps = memory_text(maps),
        caches = memory_text(kept)
    );
    set_accessible_name(&button.response, tr("Memory of this document"));
    button.response.on_hover_text(about);
}

/// The last message, while it is shown; returns whether there is one.
fn say<W: JobWindow>(ui: &mut Ui, jobs: &Jobs<W>) -> bool {
    let said = jobs.success_message();
    if let Some(said) = said {
        ui.label(tr_message(said));
        ui.ctx().request_repaint_after(std::time::Duration::from_secs(1));
    }
    said.is_some()
}
