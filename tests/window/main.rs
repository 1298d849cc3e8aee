//! The window, driven by the names of its controls, with no display and no graphics card.
#![cfg(feature = "window-tests")]

use eframe::egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use rilievo::app::Window;
use rilievo::document::Content;
use std::path::PathBuf;

type Story = Harness<'static, Option<Window>>;

/// A window of a usual size, with an empty canvas in it.
fn window() -> Story {
    window_at(1.0, None)
}
/// The same with so many pixels to a point, and the settings of a file.
fn window_at(pixels_per_point: f32, settings: Option<PathBuf>) -> Story {
    let show = move |ui: &mut eframe::egui::Ui, window: &mut Option<Window>| {
        let window = window.get_or_insert_with(|| Window::remembering(ui.ctx(), settings.clone()).asking_itself());
        window.show(ui);
    };
    let builder =
        Harness::builder().with_size([1280.0, 820.0]).with_pixels_per_point(pixels_per_point).with_step_dt(1.0 / 60.0);
    let mut harness = builder.build_ui_state(show, None);
    harness.step();
    click(&mut harness, "File");
    click(&mut harness, "New…");
    click(&mut harness, "Create");
    harness
}
/// The painter's thread asks for frames as it likes, so a fixed number of them is enough.
fn steps(harness: &mut Story) {
    (0..4).for_each(|_| harness.step());
}
fn click(harness: &mut Story, label: &str) {
    harness.get_by_label_contains(label).click();
    steps(harness);
}
/// Steps until something is so, as other threads come to it.
fn until(harness: &mut Story, is_so: impl Fn(&Story) -> bool) {
    for _ in 0..600 {
        harness.step();
        if is_so(harness) {
            return steps(harness);
        }
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    panic!("it never came to that");
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
fn command(harness: &mut Story, name: &str) {
    key(harness, Modifiers::COMMAND, Key::K);
    harness.get_by_label("Command").type_text(name);
    steps(harness);
    key(harness, Modifiers::NONE, Key::Enter);
}
fn session(harness: &Story) -> &rilievo::session::Session {
    &harness.state().as_ref().unwrap().session
}
fn layers(harness: &Story) -> Vec<String> {
    let document = session(harness).tab().unwrap().document();
    document.layers.iter().map(|layer| layer.name.clone()).collect()
}

#[test]
fn a_new_document_is_painted_on_and_the_stroke_undone() {
    let mut harness = window();
    assert_eq!(layers(&harness), ["Background"]);
    let canvas = harness.get_by_label("Canvas").rect();
    harness.drag_at(canvas.center());
    steps(&mut harness);
    harness.hover_at(canvas.center() + eframe::egui::vec2(90.0, 30.0));
    steps(&mut harness);
    harness.drop_at(canvas.center() + eframe::egui::vec2(90.0, 30.0));
    steps(&mut harness);
    assert_eq!(layers(&harness), ["Background", "Strokes"]);
    let Content::Strokes(live) = &session(&harness).layer().unwrap().content else { panic!("a stroke layer") };
    assert!(live.params().strokes[0].samples().len() >= 2);
    click(&mut harness, "Edit");
    click(&mut harness, "Undo");
    assert_eq!(layers(&harness), ["Background"]);
}
#[test]
fn layers_are_added_hidden_and_deleted_by_their_buttons() {
    let mut harness = window();
    click(&mut harness, "+ Add");
    click(&mut harness, "Gradient layer");
    assert_eq!(layers(&harness), ["Background", "Gradient"]);
    harness.get_by_label("Show Gradient").click();
    steps(&mut harness);
    assert!(!session(&harness).layer().unwrap().visible);
    harness.get_by_label("Delete layer").click();
    steps(&mut harness);
    assert_eq!(layers(&harness), ["Background"]);
}
#[test]
fn every_panel_shows_every_kind_of_layer() {
    let mut harness = window();
    for kind in
        ["Paint layer", "Stroke layer", "Fill layer", "Gradient layer", "Shading layer", "Radiance scaling", "Group"]
    {
        click(&mut harness, "+ Add");
        harness.get_by_label(kind).click();
        steps(&mut harness);
        for panel in ["Brushes", "Properties", "Surface", "History", "Navigator", "Colour"] {
            harness.get_by_label(panel).click();
            steps(&mut harness);
        }
    }
}
#[test]
fn closing_with_unsaved_work_asks_first() {
    let mut harness = window();
    click(&mut harness, "+ Add");
    click(&mut harness, "Fill layer");
    click(&mut harness, "File");
    harness.get_by_label_contains("Close Ctrl").click();
    steps(&mut harness);
    harness.get_by_label("Do not save").click();
    steps(&mut harness);
    assert!(session(&harness).tab().is_none());
}
#[test]
fn what_cannot_be_opened_is_told_in_a_sentence_that_stays() {
    let mut harness = window();
    harness.state_mut().as_mut().unwrap().begin(vec![PathBuf::from("no such picture.png")]);
    std::thread::sleep(std::time::Duration::from_millis(300));
    steps(&mut harness);
    harness.get_by_label_contains("no such picture.png");
    click(&mut harness, "Dismiss");
    assert!(harness.query_by_label_contains("no such picture.png").is_none());
}
#[test]
fn a_stroke_is_chosen_in_the_list_ordered_duplicated_and_deleted() {
    let mut harness = window();
    let canvas = harness.get_by_label("Canvas").rect();
    for dy in [-40.0, 40.0] {
        let from = canvas.center() + eframe::egui::vec2(-60.0, dy);
        harness.drag_at(from);
        steps(&mut harness);
        harness.drop_at(from + eframe::egui::vec2(120.0, 0.0));
        steps(&mut harness);
    }
    let heights = |harness: &Story| -> Vec<f32> {
        let tab = session(harness).tab().unwrap();
        tab.document().strokes(tab.selected.unwrap()).iter().map(|stroke| stroke.samples()[0].at.y).collect()
    };
    let [upper, lower] = heights(&harness)[..] else { panic!("two strokes") };
    harness.get_by_label("Properties").click();
    steps(&mut harness);
    click(&mut harness, "Stroke 1 ·");
    assert_eq!(session(&harness).tool, rilievo::tools::ToolKind::Strokes);
    assert_eq!(session(&harness).tab().unwrap().chosen_strokes(), [0]);
    harness.get_by_label("Stroke up").click();
    steps(&mut harness);
    assert_eq!(heights(&harness), [lower, upper]);
    harness.get_by_label("Duplicate strokes").click();
    steps(&mut harness);
    assert_eq!(heights(&harness).len(), 3);
    harness.get_by_label("Delete strokes").click();
    steps(&mut harness);
    assert_eq!(heights(&harness), [lower, upper]);
    // On the canvas: the lower one, dragged up.
    harness.drag_at(canvas.center() + eframe::egui::vec2(0.0, 40.0));
    steps(&mut harness);
    harness.hover_at(canvas.center() + eframe::egui::vec2(0.0, 10.0));
    steps(&mut harness);
    harness.drop_at(canvas.center() + eframe::egui::vec2(0.0, 10.0));
    steps(&mut harness);
    assert_eq!(session(&harness).tab().unwrap().chosen_strokes(), [0]);
    assert!(heights(&harness)[0] < lower && heights(&harness)[1] == upper);
}
#[test]
fn the_fill_tool_shows_its_options_and_fills() {
    let mut harness = window();
    click(&mut harness, "Fill");
    assert_ne!(harness.query_all_by_label("Close gaps").count(), 0);
    harness.get_by_label("This layer only").click();
    steps(&mut harness);
    assert!(session(&harness).fill.layer_alone);
    let canvas = harness.get_by_label("Canvas").rect();
    harness.drag_at(canvas.center());
    steps(&mut harness);
    harness.drop_at(canvas.center());
    steps(&mut harness);
    assert_eq!(layers(&harness), ["Background", "Paint"]);
    let Content::Pixels(pixels) = &session(&harness).layer().unwrap().content else { panic!("a paint layer") };
    assert_ne!(pixels.tiles.pixel(3, 3), [0; 4]);
}
#[test]
fn every_shading_model_is_made_from_the_menu_and_shows_its_properties() {
    let mut harness = window();
    press(&mut harness, "Properties");
    for (name, shows) in [
        ("New Phong layer", "Add light at a point"),
        ("New toon layer", "Tones"),
        ("New sub-Lambertian layer", "Flatness"),
        ("New Ashikhmin layer", "Choose environment"),
        ("New lit-sphere layer", "Choose lit sphere of hollows"),
        ("New mirror layer", "Choose environment"),
        ("New glass layer", "Index"),
        ("New layer lit by an environment", "Reach"),
        ("New ambient occlusion layer", "Reach"),
    ] {
        command(&mut harness, name);
        assert!(matches!(session(&harness).layer().unwrap().content, Content::Shading(_)), "{name}");
        assert!(harness.query_all_by_label(shows).count() > 0, "{name} shows {shows}");
    }
    command(&mut harness, "New detail normals");
    assert!(harness.query_all_by_label("Roughness").count() > 0);
}
#[test]
fn pictures_and_maps_are_read_beside_the_window_and_put_where_they_belong() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("sky.png");
    let picture = image::RgbImage::from_fn(64, 32, |x, y| image::Rgb([(x * 4) as u8, (y * 8) as u8, 20]));
    picture.save(&file).unwrap();
    let mut harness = window();
    command(&mut harness, "New mirror layer");
    press(&mut harness, "Properties");
    press(&mut harness, "Choose environment");
    choose(&mut harness, &file);
    until(&mut harness, |harness| environment(harness).is_some_and(|file| file == "sky.png"));
    press(&mut harness, "Remove");
    assert_eq!(environment(&harness), None);
    harness.input_mut().dropped_files.push(std::sync::Arc::new(Dropped(file)));
    harness.step();
    until(&mut harness, |harness| layers(harness).contains(&"sky".to_owned()));
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
fn environment(harness: &Story) -> Option<String> {
    match &session(harness).layer().unwrap().content {
        Content::Shading(live) => live.params().environment.as_ref().map(|environment| environment.file.clone()),
        _ => None,
    }
}
/// Answers the window's own file dialog.
fn choose(harness: &mut Story, file: &std::path::Path) {
    until(harness, |harness| harness.query_by_label("File name").is_some());
    // What was proposed gives way.
    key(harness, Modifiers::COMMAND, Key::A);
    harness.get_by_label("File name").type_text(&file.to_string_lossy());
    steps(harness);
    key(harness, Modifiers::NONE, Key::Enter);
}
#[test]
fn a_pixel_of_the_canvas_is_one_of_the_screen_at_any_density() {
    for pixels_per_point in [1.0, 1.5, 2.0] {
        let mut harness = window_at(pixels_per_point, None);
        command(&mut harness, "Actual pixels");
        let zoom = session(&harness).tab().unwrap().view.unwrap().zoom;
        assert!((zoom * pixels_per_point - 1.0).abs() < 1e-4, "{zoom}");
        harness.get_by_label("100 %");
    }
}
#[test]
fn layers_are_merged_baked_and_flattened_beside_the_window() {
    let mut harness = window();
    command(&mut harness, "New gradient layer");
    command(&mut harness, "Bake layer");
    until(&mut harness, |harness| matches!(session(harness).layer().unwrap().content, Content::Pixels(_)));
    command(&mut harness, "Merge down");
    until(&mut harness, |harness| layers(harness) == ["Background"]);
    command(&mut harness, "Flatten picture");
    until(&mut harness, |harness| layers(harness) == ["Picture"]);
    command(&mut harness, "Undo");
    assert_eq!(layers(&harness), ["Background"]);
}
/// Steps until something holds that a thread brings about.
fn wait_until(harness: &mut Story, holds: impl Fn(&Story) -> bool) {
    for _ in 0..3000 {
        harness.step();
        if holds(harness) {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    panic!("waited in vain");
}
/// A window that keeps its recovery logs in a folder.
fn window_recovering(folder: &std::path::Path) -> Harness<'static, Option<Window>> {
    let folder = folder.to_owned();
    let show = move |ui: &mut eframe::egui::Ui, window: &mut Option<Window>| {
        let window = window.get_or_insert_with(|| {
            let mut window = Window::new(ui.ctx());
            window.keep_recovery_in(folder.clone());
            window
        });
        window.show(ui);
    };
    let mut harness = Harness::builder().with_size([1280.0, 820.0]).build_ui_state(show, None);
    harness.step();
    harness
}
#[test]
fn after_a_crash_the_window_offers_what_was_unsaved() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = window_recovering(folder.path());
    click(&mut harness, "File");
    click(&mut harness, "New…");
    click(&mut harness, "Create");
    click(&mut harness, "+ Add");
    click(&mut harness, "Gradient layer");
    // Dropped without its leave, as a crash would.
    drop(harness);
    std::fs::write(folder.path().join("0-broken.log"), "garbage").unwrap();
    let mut harness = window_recovering(folder.path());
    wait_until(&mut harness, |harness| harness.query_by_label("Recover unsaved drawings?").is_some());
    harness.get_by_label("Recover Unnamed").click();
    wait_until(&mut harness, |harness| harness.query_by_label_contains("no whole version").is_some());
    harness.get_by_label("Recover all").click();
    wait_until(&mut harness, |harness| session(harness).tab().is_some());
    assert!(harness.query_by_label("Recover unsaved drawings?").is_none());
    assert_eq!(layers(&harness), ["Background", "Gradient"]);
    let tab = session(&harness).tab().unwrap();
    assert!(tab.is_dirty() && tab.file.is_none());
    assert_eq!(tab.title(), "Untitled 1 (recovered)");
}
#[test]
fn the_brush_is_made_to_smudge_and_says_what_it_needs() {
    let mut harness = window();
    harness.get_by_label("Mark").click();
    steps(&mut harness);
    harness.get_by_label("Smudge").click();
    steps(&mut harness);
    assert!(session(&harness).brush.mark.is_retouching());
    assert_ne!(harness.query_all_by_label("Length").count(), 0);
    let canvas = harness.get_by_label("Canvas").rect();
    harness.drag_at(canvas.center());
    steps(&mut harness);
    harness.drop_at(canvas.center());
    steps(&mut harness);
    assert_eq!(layers(&harness), ["Background"]);
    harness.get_by_label_contains("work on paint layers");
}
