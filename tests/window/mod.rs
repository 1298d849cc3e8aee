//! The window, driven by the names of its controls, with no display and no graphics card.

mod brush_options;
mod brushes;
mod busy;
mod canvas;
mod colors;
mod comics;
mod documents;
mod goldens;
mod keyboard;
mod layers;
mod light;
mod marks;
mod panels;
mod pasting;
mod paths;
mod pens;
mod preferences;
mod recovery;
mod replayed;
mod selecting;
mod several;
mod shape;
mod transforming;
mod unwrapped;
mod warping;
mod writing;

use eframe::egui::{Key, Modifiers, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use rilievo_window::MainWindow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How long a slow machine may take for what is waited for.
const LONGEST_WAIT: Duration = Duration::from_secs(60);

type Story = Harness<'static, Option<MainWindow>>;

/// A window of a usual size, with an empty canvas in it.
fn window() -> Story {
    window_at(1.0, None)
}

/// The same with so many pixels to a point, and the settings of a file.
fn window_at(pixels_per_point: f32, settings: Option<PathBuf>) -> Story {
    let mut harness =
        window_of(pixels_per_point, move |ctx| MainWindow::remembering(ctx, settings.clone()));
    click(&mut harness, "File");
    click(&mut harness, "New…");
    click(&mut harness, "Create");
    harness
}

/// A new window, which uses its own dialog for files.
fn window_of(
    pixels_per_point: f32,
    make: impl Fn(&eframe::egui::Context) -> MainWindow + 'static,
) -> Story {
    let show = move |ui: &mut eframe::egui::Ui, window: &mut Option<MainWindow>| {
        window.get_or_insert_with(|| make(ui.ctx()).asking_itself()).show(ui);
    };
    let builder = Harness::builder()
        .with_size([1280.0, 820.0])
        .with_pixels_per_point(pixels_per_point)
        .with_step_dt(1.0 / 60.0);
    let mut harness = builder.build_ui_state(show, None);
    harness.step();
    harness
}

/// The render thread requests frames at any time, so run a fixed number of them.
fn steps(harness: &mut Story) {
    (0..4).for_each(|_| harness.step());
}

fn click(harness: &mut Story, label: &str) {
    harness.get_by_label_contains(label).click();
    steps(harness);
}

/// Steps until something is so, which other threads may have to do first.
#[track_caller]
fn until(harness: &mut Story, is_so: impl Fn(&Story) -> bool) {
    act_until(harness, |harness| harness.step(), is_so);
    steps(harness);
}

/// Does something again and again until something is so, and lets other threads work in between.
#[track_caller]
fn act_until(
    harness: &mut Story,
    mut act: impl FnMut(&mut Story),
    mut is_so: impl FnMut(&Story) -> bool,
) {
    let began = Instant::now();
    loop {
        act(harness);
        if is_so(harness) {
            return;
        }
        assert!(began.elapsed() < LONGEST_WAIT, "what is waited for did not happen");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// By its whole name.
fn press(harness: &mut Story, label: &str) {
    harness.get_by_label(label).click();
    steps(harness);
}

fn key(harness: &mut Story, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    steps(harness);
}

/// By its name, typed into the palette of commands.
fn command(harness: &mut Story, name: &str) {
    // While an edit is under way there is no palette.
    let open = |harness: &mut Story| key(harness, Modifiers::COMMAND, Key::K);
    act_until(harness, open, |harness| harness.query_by_label("Command").is_some());
    harness.get_by_label("Command").type_text(name);
    steps(harness);
    key(harness, Modifiers::NONE, Key::Enter);
}

/// From the middle of the canvas, with the current tool.
fn stroke(harness: &mut Story, by: Vec2) {
    drag(harness, Vec2::ZERO, by);
}

/// From one place to another, seen from the middle of the canvas.
fn drag(harness: &mut Story, from: Vec2, to: Vec2) {
    let middle = harness.get_by_label("Canvas").rect().center();
    harness.drag_at(middle + from);
    steps(harness);
    for share in [0.25, 0.5, 0.75, 1.0] {
        harness.hover_at(middle + from + (to - from) * share);
        steps(harness);
    }
    harness.drop_at(middle + to);
    steps(harness);
}

/// Answers the window's own file dialog.
fn choose(harness: &mut Story, file: &Path) {
    until(harness, |harness| harness.query_by_label("File name").is_some());
    // Replaces the proposed text.
    key(harness, Modifiers::COMMAND, Key::A);
    harness.get_by_label("File name").type_text(&file.to_string_lossy());
    steps(harness);
    key(harness, Modifiers::NONE, Key::Enter);
}

/// A file as the system drops it.
#[derive(Debug)]
struct Dropped(PathBuf);
impl eframe::egui::DroppedFile for Dropped {
    fn path(&self) -> &std::path::Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

fn drop_files(harness: &mut Story, files: &[&Path]) {
    for file in files {
        harness.input_mut().dropped_files.push(Arc::new(Dropped(file.to_path_buf())));
    }
    harness.step();
}

fn session(harness: &Story) -> &rilievo_program::session::Session {
    &harness.state().as_ref().unwrap().session
}

fn layers(harness: &Story) -> Vec<String> {
    let document = session(harness).active().unwrap().document();
    document.layers.iter().map(|layer| layer.name.clone()).collect()
}
