//! Documents made, opened, exported, saved and closed.

use super::{
    choose, click, command, drop_files, layers, press, session, steps, stroke, until, window,
    window_of,
};
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable;
use rilievo_window::MainWindow;
use std::path::{Path, PathBuf};

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
    assert!(session(&harness).active().is_none());
}

#[test]
fn what_cannot_be_opened_is_told_in_a_sentence_that_stays() {
    let mut harness = window();
    harness.state_mut().as_mut().unwrap().begin(vec![PathBuf::from("no such picture.png")]);
    until(&mut harness, |harness| harness.query_by_label_contains("no such picture.png").is_some());
    click(&mut harness, "Dismiss");
    assert!(harness.query_by_label_contains("no such picture.png").is_none());
}

#[test]
fn files_that_another_start_names_open_in_this_window() {
    let (other_start, files) = std::sync::mpsc::channel();
    let mut harness = window();
    harness.state_mut().as_mut().unwrap().open_what_comes(files);
    let open = session(&harness).open_documents.len();
    other_start.send(vec![PathBuf::from("sample_normals/axolotl.json")]).unwrap();
    other_start.send(Vec::new()).unwrap();
    until(&mut harness, |harness| session(harness).open_documents.len() > open);
    assert!(session(&harness).active().unwrap().title().contains("axolotl"));
}

#[test]
fn a_script_is_played_beside_what_is_open_and_its_documents_have_their_history() {
    let folder = tempfile::tempdir().unwrap();
    let script = folder.path().join("story.jsonl");
    let lines = [
        r##"{"in":"file","do":"new","width":60,"height":40,"background":"#804020"}"##,
        r#"{"in":"layer","do":"add","kind":"paint"}"#,
        r#"{"in":"file","do":"save","file":"never.ora"}"#,
    ];
    std::fs::write(&script, lines.join("\n")).unwrap();
    let mut harness = window();
    let open = session(&harness).open_documents.len();
    harness.state_mut().as_mut().unwrap().begin(vec![script]);
    until(&mut harness, |harness| session(harness).open_documents.len() > open);
    let shown = session(&harness).active().unwrap();
    assert_eq!((shown.document().size.width, shown.document().layers.len()), (60, 2));
    assert_eq!(shown.history.past_names().count(), 1);
    assert!(harness.query_by_label_contains("story.jsonl was played").is_some());
}

#[test]
fn a_picture_is_exported_and_a_project_saved_with_the_windows_own_dialogs() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = window();
    command(&mut harness, "Export");
    harness.get_by_label("Preview of the export");
    press(&mut harness, "Export…");
    let (png, ora) = (folder.path().join("out.png"), folder.path().join("out.ora"));
    choose(&mut harness, &png);
    until(&mut harness, |_| png.is_file());
    command(&mut harness, "Save as");
    choose(&mut harness, &ora);
    until(&mut harness, |harness| session(harness).active().unwrap().file.is_some());
    assert!(ora.is_file() && !session(&harness).active().unwrap().is_dirty());
}

#[test]
fn a_picture_of_sixteen_bits_is_exported_where_that_is_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let png = folder.path().join("deep.png");
    let mut harness = window();
    command(&mut harness, "Export…");
    press(&mut harness, "16 bits");
    press(&mut harness, "Export…");
    choose(&mut harness, &png);
    until(&mut harness, |harness| harness.query_by_label_contains("Exported").is_some());
    assert_eq!(image::open(&png).unwrap().color(), image::ColorType::Rgba16);
}

#[test]
fn quitting_asks_for_each_document_with_unsaved_work_and_saves_it_where_it_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("kept.ora");
    let mut harness = window();
    stroke(&mut harness, vec2(40.0, 10.0));
    command(&mut harness, "Close");
    harness.get_by_label_contains("Save the changes to “Untitled 1”?");
    press(&mut harness, "Cancel");
    assert!(session(&harness).active().is_some_and(|open| open.is_dirty()));
    command(&mut harness, "Close");
    press(&mut harness, "Save");
    choose(&mut harness, &file);
    until(&mut harness, |harness| session(harness).active().is_none());
    harness.state_mut().as_mut().unwrap().begin(vec![file]);
    until(&mut harness, |harness| session(harness).active().is_some());
    assert_eq!(layers(&harness), ["Background", "Strokes"]);
    assert!(!session(&harness).active().unwrap().is_dirty());
}

#[test]
fn several_documents_stand_in_tabs_and_the_next_one_comes_to_the_front() {
    let mut harness = window();
    command(&mut harness, "New…");
    press(&mut harness, "1920 × 1080");
    press(&mut harness, "Dark");
    press(&mut harness, "Create");
    assert_eq!((session(&harness).open_documents.len(), session(&harness).current), (2, 1));
    command(&mut harness, "Next document");
    assert_eq!(session(&harness).current, 0);
    press(&mut harness, "Untitled 2");
    assert_eq!(session(&harness).active().unwrap().document().size.width, 1920);
    press(&mut harness, "Close Untitled 1");
    assert_eq!(session(&harness).open_documents.len(), 1);
}

/// Whether something of this name is there, perhaps a control next to its name.
fn shows(harness: &super::Story, label: &str) -> bool {
    harness.query_all_by_label(label).count() > 0
}

/// Makes a document of the maps, as soon as they are read as the dialog says.
fn create(harness: &mut super::Story) {
    let confirm = |harness: &mut super::Story| super::key(harness, Modifiers::NONE, Key::Enter);
    super::act_until(harness, confirm, |harness| session(harness).open_documents.len() == 2);
}

/// A ball's normals and depth, as 8-bit pictures with a flat border.
fn ball(folder: &Path) -> [PathBuf; 2] {
    let files = ["shape.png", "far.png"].map(|name| folder.join(name));
    let at = |x: u32, y: u32| {
        let (x, y) = ((x as f32 - 47.5) / 40.0, (y as f32 - 47.5) / 40.0);
        let z = 1.0 - x * x - y * y;
        if z > 0.0 { [x, -y, z.sqrt()] } else { [0.0, 0.0, 1.0] }
    };
    let byte = |v: f32| (v * 127.5 + 128.0) as u8;
    image::RgbImage::from_fn(96, 96, |x, y| image::Rgb(at(x, y).map(byte)))
        .save(&files[0])
        .unwrap();
    let depth = |x: u32, y: u32| {
        if at(x, y) == [0.0, 0.0, 1.0] { 255 } else { 200 - (at(x, y)[2] * 150.0) as u8 }
    };
    image::GrayImage::from_fn(96, 96, |x, y| image::Luma([depth(x, y)])).save(&files[1]).unwrap();
    files
}

/// The dialog grows to its new size and stays in the middle while it does: a click must not miss
/// it.
fn still(harness: &mut super::Story, name: &str) {
    let place = |harness: &super::Story| harness.get_all_by_label(name).next().unwrap().rect();
    let (mut before, mut still) = (place(harness), 0);
    super::act_until(
        harness,
        |harness| harness.step(),
        |harness| {
            let now = place(harness);
            still = if now == before { still + 1 } else { 0 };
            before = now;
            still == 10
        },
    );
}

#[test]
fn maps_are_seen_four_ways_and_corrected_before_they_become_a_document() {
    let folder = tempfile::tempdir().unwrap();
    let [normals, _] = ball(folder.path());
    let mut harness = window();
    drop_files(&mut harness, &[&normals]);
    until(&mut harness, |harness| shows(harness, "Flip green"));
    // The flat border was taken for background, and that can be taken back.
    let is_read = |harness: &super::Story| {
        shows(harness, "Flip green") && !shows(harness, "Reading the maps…")
    };
    until(&mut harness, |harness| shows(harness, "Flat border") && is_read(harness));
    still(&mut harness, "Flip green");
    harness.get_all_by_label("Flip green").next().unwrap().click();
    steps(&mut harness);
    // The choice stays, and nothing else is chosen.
    let chosen = |harness: &super::Story, name: &str| {
        use egui_kittest::kittest::NodeT;
        let node = harness.get_all_by_label(name).next().unwrap();
        format!("{:?}", node.accesskit_node().toggled()).contains("True")
    };
    until(&mut harness, is_read);
    let all = ["As it is", "Flip red", "Flip green", "Flip both"];
    assert_eq!(all.map(|name| chosen(&harness, name)), [false, false, true, false]);
    press(&mut harness, "Detected");
    until(&mut harness, |harness| shows(harness, "plain numbers"));
    for jargon in ["normal.srgb", "normal.encoding", "depth.near", "false", "full-z"] {
        assert!(!shows(&harness, jargon), "{jargon}");
    }
    create(&mut harness);
    let open = session(&harness).active().unwrap();
    let surface = open.document().surface.clone().unwrap();
    assert_eq!((surface.coverage(2, 2), surface.coverage(48, 48)), (0, 255));
    assert!(surface.normal(48, 20).y < 0.0, "the upper half looks down now");
}

#[test]
fn bumps_of_a_depth_map_alone_become_dents_by_a_click() {
    let folder = tempfile::tempdir().unwrap();
    let [_, depth] = ball(folder.path());
    let alone = folder.path().join("alone_depth.png");
    std::fs::rename(depth, &alone).unwrap();
    std::fs::remove_file(folder.path().join("shape.png")).unwrap();
    let looks_up = |turned: bool| {
        let mut harness = window();
        drop_files(&mut harness, &[&alone]);
        let read = |harness: &super::Story| {
            shows(harness, "Inside out") && !shows(harness, "Reading the maps…")
        };
        until(&mut harness, read);
        if turned {
            still(&mut harness, "Inside out");
            harness.get_all_by_label("Inside out").next().unwrap().click();
            steps(&mut harness);
            until(&mut harness, read);
        }
        create(&mut harness);
        let surface = session(&harness).active().unwrap().document().surface.clone().unwrap();
        surface.normal(48, 20).y > 0.0
    };
    assert_ne!(looks_up(false), looks_up(true));
}

#[test]
fn maps_that_are_dropped_together_are_one_objects() {
    let folder = tempfile::tempdir().unwrap();
    let [normals, depth] = ball(folder.path());
    let depth_named = folder.path().join("other_depth.png");
    std::fs::rename(depth, &depth_named).unwrap();
    let mut harness = window();
    drop_files(&mut harness, &[&depth_named, &normals]);
    until(&mut harness, |harness| shows(harness, "Near is"));
    for name in ["shape.png", "other_depth.png"] {
        harness.get_by_label(name);
    }
    create(&mut harness);
    assert!(harness.query_by_label("Create").is_none(), "there was one dialog");
    assert_eq!(session(&harness).open_documents.len(), 2);
}

#[test]
fn the_first_start_offers_a_sample_with_three_steps_that_can_be_put_away() {
    let mut harness = window_of(1.0, |ctx| {
        let mut window = MainWindow::new(ctx);
        window.begin(Vec::new());
        window
    });
    for card in ["New picture", "Open a drawing", "Open normal maps", "Chrome"] {
        assert!(harness.query_by_label(card).is_some(), "{card}");
    }
    press(&mut harness, "Ball and ring");
    until(&mut harness, |harness| harness.query_by_label("Three steps").is_some());
    assert!(harness.query_by_label("New picture").is_none());
    assert_eq!(layers(&harness), ["Background", "Base"]);
    press(&mut harness, "Not now");
    assert!(harness.query_by_label("Three steps").is_none());
    key_is_free(&mut harness);
}

#[test]
fn the_tour_makes_a_finished_picture_of_a_flat_drawing_and_shows_each_step() {
    let mut harness = window_of(1.0, MainWindow::new);
    command(&mut harness, "Take the tour");
    until(&mut harness, |harness| harness.query_by_label("Show me").is_some());
    let past =
        |harness: &super::Story| session(harness).active().unwrap().history.past_names().len();
    for name in ["Give it a shape", "Move the light", "Paint a gloss", "Make a part", "Try a look"]
    {
        let before = past(&harness);
        press(&mut harness, "Show me");
        until(&mut harness, |harness| past(harness) > before);
        steps(&mut harness);
        assert!(past(&harness) > before, "{name}");
    }
    let document = session(&harness).shown_document().unwrap();
    assert!(document.surface.is_some());
    assert!(document.parts.list.len() > 5, "{}", document.parts.list.len());
    press(&mut harness, "Show me");
    until(&mut harness, |harness| harness.query_by_label("Export…").is_some());
}

/// With the hint gone, keys reach the canvas as ever.
fn key_is_free(harness: &mut super::Story) {
    super::key(harness, Modifiers::NONE, Key::E);
    assert_eq!(session(harness).tool, rilievo_program::tools::ToolKind::Eraser);
}

#[test]
fn a_file_that_is_there_already_is_replaced_only_when_that_is_said_twice() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("there.png");
    std::fs::write(&file, "something else").unwrap();
    let mut harness = window();
    command(&mut harness, "Export…");
    press(&mut harness, "Export…");
    choose(&mut harness, &file);
    harness.get_by_label_contains("This file already exists");
    assert_eq!(std::fs::read(&file).unwrap(), b"something else");
    press(&mut harness, "Replace");
    until(&mut harness, |harness| harness.query_by_label_contains("Exported").is_some());
    assert_ne!(std::fs::read(&file).unwrap(), b"something else");
}

#[test]
fn a_smaller_document_comes_to_the_front_under_a_pointer_over_a_larger_one() {
    let mut harness = window();
    let canvas = harness.get_by_label("Canvas").rect();
    harness.hover_at(canvas.center() + vec2(0.0, 0.44 * canvas.height()));
    steps(&mut harness);
    let small = Path::new(env!("CARGO_MANIFEST_DIR")).join("sample_normals/bronze_muse.json");
    drop_files(&mut harness, &[&small]);
    until(&mut harness, |harness| session(harness).open_documents.len() == 2);
    assert!(session(&harness).shown_document().is_some_and(|document| document.surface.is_some()));
}

#[test]
fn what_stands_after_a_point_is_a_part_of_the_name() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("robot v1.ora"), "another painting").unwrap();
    let mut harness = window();
    command(&mut harness, "Save as");
    choose(&mut harness, &at("robot v1.2"));
    until(&mut harness, |harness| session(harness).active().unwrap().file.is_some());
    assert!(at("robot v1.2.ora").is_file());
    command(&mut harness, "Export…");
    press(&mut harness, "Export…");
    // The proposed name keeps all of it.
    until(&mut harness, |harness| harness.query_by_label("File name").is_some());
    assert_eq!(harness.get_by_label("File name").value().as_deref(), Some("robot v1.2.png"));
    choose(&mut harness, &at("final v1.2"));
    until(&mut harness, |_| at("final v1.2.png").is_file());
    assert_eq!(std::fs::read(at("robot v1.ora")).unwrap(), b"another painting");
}

#[test]
fn a_photoshop_file_is_saved_once_it_was_said_what_it_loses() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("s.psd");
    let mut harness = window();
    stroke(&mut harness, vec2(40.0, 10.0));
    command(&mut harness, "Save as");
    choose(&mut harness, &file);
    until(&mut harness, |harness| harness.query_by_label("Save as a Photoshop file?").is_some());
    assert!(!file.exists());
    press(&mut harness, "Save");
    until(&mut harness, |harness| !session(harness).active().unwrap().is_dirty());
    assert!(std::fs::read(&file).unwrap().starts_with(b"8BPS"));
    // Known from now on.
    stroke(&mut harness, vec2(-30.0, 10.0));
    command(&mut harness, "Save");
    until(&mut harness, |harness| !session(harness).active().unwrap().is_dirty());
    // Opened again, everything is live and it is saved to the same file.
    harness.state_mut().as_mut().unwrap().begin(vec![file.clone()]);
    until(&mut harness, |harness| session(harness).open_documents.len() == 2);
    assert_eq!(layers(&harness), ["Background", "Strokes"]);
    assert_eq!(session(&harness).active().unwrap().file, Some(file));
}

#[test]
fn a_photoshop_file_is_exported() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("out.psd");
    let mut harness = window();
    command(&mut harness, "Export…");
    harness.get_by_label_contains("PSD").click();
    steps(&mut harness);
    press(&mut harness, "Export…");
    choose(&mut harness, &folder.path().join("out"));
    until(&mut harness, |harness| harness.query_by_label_contains("Exported").is_some());
    assert!(std::fs::read(&file).unwrap().starts_with(b"8BPS"));
    assert!(session(&harness).active().unwrap().file.is_none(), "an export is no save");
}

#[test]
fn what_an_open_document_was_made_from_is_never_exported_over() {
    let folder = tempfile::tempdir().unwrap();
    let photo = folder.path().join("photo.png");
    image::RgbImage::from_pixel(30, 20, image::Rgb([200, 10, 10])).save(&photo).unwrap();
    let before = std::fs::read(&photo).unwrap();
    let mut harness = window();
    drop_files(&mut harness, &[&photo]);
    until(&mut harness, |harness| layers(harness).contains(&"photo".to_owned()));
    command(&mut harness, "Export…");
    press(&mut harness, "Export…");
    choose(&mut harness, &photo);
    press(&mut harness, "Replace");
    until(&mut harness, |harness| harness.query_by_label_contains("made from it").is_some());
    assert_eq!(std::fs::read(&photo).unwrap(), before);
    // A picture that was opened is not proposed as the file of its own export.
    harness.state_mut().as_mut().unwrap().begin(vec![photo.clone()]);
    until(&mut harness, |harness| session(harness).open_documents.len() == 2);
    steps(&mut harness);
    command(&mut harness, "Export…");
    press(&mut harness, "Export…");
    until(&mut harness, |harness| harness.query_by_label("File name").is_some());
    assert_eq!(harness.get_by_label("File name").value().as_deref(), Some("photo 2.png"));
}

#[test]
fn a_file_that_may_not_be_replaced_unasked_is_asked_about_when_it_is_saved() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.ora");
    let mut harness = window();
    command(&mut harness, "Save as");
    choose(&mut harness, &file);
    until(&mut harness, |harness| !session(harness).active().unwrap().is_dirty() && file.is_file());
    std::fs::write(&file, "another program's").unwrap();
    stroke(&mut harness, vec2(40.0, 10.0));
    command(&mut harness, "Save");
    until(&mut harness, |harness| harness.query_by_label("Replace “a.ora”?").is_some());
    press(&mut harness, "Cancel");
    assert_eq!(std::fs::read(&file).unwrap(), b"another program's");
    command(&mut harness, "Save");
    until(&mut harness, |harness| harness.query_by_label("Replace “a.ora”?").is_some());
    press(&mut harness, "Replace");
    until(&mut harness, |harness| !session(harness).active().unwrap().is_dirty());
    assert_ne!(std::fs::read(&file).unwrap(), b"another program's");
    assert_eq!(std::fs::read(folder.path().join("a.ora~")).unwrap(), b"another program's");
}
