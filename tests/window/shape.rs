//! The shape workshop: from a drawing to a lit, bent picture, by the window's own controls.

use super::{
    Story, choose, command, drag, key, layers, press, session, steps, stroke, until, window,
    window_of,
};
use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, Vec2, vec2};
use egui_kittest::kittest::Queryable;
use rilievo::shape::{Part, PartKind};
use rilievo::{Document, Progress, flatten_layer};
use rilievo_program::tools::ToolKind;
use rilievo_window::MainWindow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tempfile::TempDir;

/// A head on a body, each of a flat color with soft edges, on a transparent ground.
fn drawing(folder: &TempDir) -> PathBuf {
    let disc = |x: f32, y: f32, cx: f32, cy: f32, r: f32| {
        (r + 0.5 - (x - cx).hypot(y - cy)).clamp(0.0, 1.0)
    };
    let picture = image::RgbaImage::from_fn(320, 400, |x, y| {
        let (x, y) = (x as f32 + 0.5, y as f32 + 0.5);
        let (head, body) = (disc(x, y, 160.0, 120.0, 80.0), disc(x, y, 160.0, 260.0, 110.0));
        let mixed = |h: f32, b: f32| (h * head + b * (1.0 - head)).round() as u8;
        let alpha = (255.0 * head.max(body)).round() as u8;
        image::Rgba([mixed(230.0, 70.0), mixed(170.0, 120.0), mixed(90.0, 210.0), alpha])
    });
    let file = folder.path().join("creature.png");
    picture.save(&file).unwrap();
    file
}

/// A window started with a file to open.
fn opening(file: &Path) -> Story {
    let mut harness = window_of(1.0, MainWindow::new);
    key(&mut harness, Modifiers::COMMAND, Key::O);
    choose(&mut harness, file);
    harness
}

fn asked(harness: &mut Story) {
    until(harness, |harness| harness.query_by_label("Only paint").is_some());
}

/// Answers the question with yes, and waits for the shape.
fn give(harness: &mut Story) {
    press(harness, "Give it a shape");
    until(harness, |harness| !parts(harness).is_empty());
}

fn parts(harness: &Story) -> Vec<Arc<Part>> {
    session(harness).active().unwrap().document().parts.list.clone()
}

/// Where a canvas point is seen, from the middle of the canvas.
fn seen(harness: &Story, x: f32, y: f32) -> Vec2 {
    let view = session(harness).active().unwrap().view.unwrap();
    let at = view.screen_from_canvas().transform_point2(rilievo::math::vec2(x, y));
    vec2(at.x, at.y)
}

fn puff(part: &Part) -> f32 {
    match &part.kind {
        PartKind::Inflate { inflation, .. } => inflation.puff,
        other => panic!("{}", other.name()),
    }
}

#[test]
fn a_drawing_gets_a_shape_is_puffed_touched_sculpted_painted_saved_and_opened_again() {
    let folder = TempDir::new().unwrap();
    let mut harness = opening(&drawing(&folder));
    asked(&mut harness);
    harness.get_by_label("A part for each color (2)");
    give(&mut harness);
    assert_eq!(layers(&harness), ["creature", "Light"]);
    let made = parts(&harness);
    assert_eq!(made.len(), 2);
    // The panel with the parts is in front, one of them selected.
    harness.get_by_label("Part Orange");
    assert!(harness.query_all_by_label("Pillow – tube").next().is_some());
    steps(&mut harness);

    key(&mut harness, Modifiers::NONE, Key::P);
    assert_eq!(session(&harness).tool, ToolKind::Shape);
    let (head, down) = (seen(&harness, 160.0, 120.0), seen(&harness, 160.0, 180.0));
    drag(&mut harness, head, head);
    let selected = session(&harness).active().unwrap().part.clone().unwrap();
    // The height handle is in the middle of the selected part.
    drag(&mut harness, head, down);
    let part =
        |harness: &Story, id: &str| parts(harness).into_iter().find(|part| part.id == id).unwrap();
    let flatter = part(&harness, &selected);
    assert!(puff(&flatter) < 0.5, "dragged down it is flatter: {flatter:?}");

    key(&mut harness, Modifiers::NONE, Key::N);
    let at = seen(&harness, 150.0, 300.0);
    drag(&mut harness, at, at);
    key(&mut harness, Modifiers::NONE, Key::U);
    let (from, to) = (seen(&harness, 110.0, 280.0), seen(&harness, 200.0, 320.0));
    drag(&mut harness, from, to);
    let body = made.iter().find(|part| part.id != selected).unwrap().id.clone();
    let on_body: Vec<Arc<Part>> =
        parts(&harness).into_iter().filter(|part| part.on() == Some(body.as_str())).collect();
    assert_eq!(
        on_body.iter().map(|part| part.kind.name()).collect::<Vec<_>>(),
        ["touches", "sculpt"]
    );

    key(&mut harness, Modifiers::NONE, Key::B);
    key(&mut harness, Modifiers::NONE, Key::F3);
    stroke(&mut harness, vec2(40.0, 60.0));
    assert_eq!(layers(&harness).len(), 3);
    let (steps_done, document) = {
        let open = session(&harness).active().unwrap();
        (open.history.past_names().count(), open.document().clone())
    };
    // The shape, the puff, the touch, the sculpting, the stroke: one step each.
    assert_eq!(steps_done, 5);

    command(&mut harness, "Save as…");
    let file = folder.path().join("creature.ora");
    choose(&mut harness, &file);
    until(&mut harness, |harness| !session(harness).active().unwrap().is_dirty());
    let mut again = opening(&file);
    until(&mut again, |harness| session(harness).active().is_some());
    let opened = session(&again).active().unwrap().document();
    assert_eq!(document.difference(opened), None);
    let surfaces = [&document, opened].map(|document| document.surface.clone().unwrap());
    assert_eq!(surfaces[0].normal_planes()[0].values(), surfaces[1].normal_planes()[0].values());
}

#[test]
fn materials_are_shown_on_the_part_under_the_pointer_and_given_to_parts_that_are_clicked() {
    let folder = TempDir::new().unwrap();
    let mut harness = opening(&drawing(&folder));
    asked(&mut harness);
    give(&mut harness);
    let before = layers(&harness);
    let (head, body) = (seen(&harness, 130.0, 90.0), seen(&harness, 120.0, 300.0));
    command(&mut harness, "Materials…");
    // The dialog finds its size meanwhile.
    super::act_until(
        &mut harness,
        |harness| press(harness, "Material: Gold"),
        |harness| harness.query_by_label("Click a part of the drawing.").is_some(),
    );
    assert_eq!(layers(&harness), before, "nothing is given yet");

    // The head is shown in it while the pointer is over it, and no step is made.
    let middle = harness.get_by_label("Canvas").rect().center();
    let count = |harness: &Story| {
        let open = session(harness).active().unwrap();
        (open.shown_document().layers.len(), open.document().layers.len())
    };
    harness.hover_at(middle + head);
    steps(&mut harness);
    assert_eq!(count(&harness), (before.len() + 1, before.len()));

    // A click gives it, and the next part gets it by the next click.
    drag(&mut harness, head, head);
    drag(&mut harness, body, body);
    let document = session(&harness).active().unwrap().document().clone();
    let made = &document.layers[before.len()..];
    let names: Vec<&str> = made.iter().map(|layer| layer.name.as_str()).collect();
    assert_eq!(names.len(), 2, "{names:?}");
    let selected: Vec<bool> = [(130, 90), (120, 300)]
        .into_iter()
        .zip(made)
        .map(|(at, group)| {
            let shown = flatten_layer(&document, group.id, &Progress::default()).unwrap();
            let other = if at.1 == 90 { (120, 300) } else { (130, 90) };
            let alpha = |(x, y): (i32, i32)| shown.pixel(x, y)[3];
            alpha(at) > 0 && alpha(other) == 0
        })
        .collect();
    assert_eq!(selected, [true, true], "each is on the part that was clicked");
    press(&mut harness, "Close");
    assert_eq!(layers(&harness).len(), before.len() + 2);
}

#[test]
fn flats_become_a_part_for_each_area_or_a_part_is_split_by_area() {
    let folder = TempDir::new().unwrap();
    let picture = image::RgbaImage::from_fn(300, 200, |x, y| {
        let inside = |cx: f32, r: f32| (x as f32 + 0.5 - cx).hypot(y as f32 - 99.5) < r;
        let (eye, face) = ([250, 250, 250, 255], [230, 170, 90, 255]);
        let ground = if inside(150.0, 95.0) { face } else { [0; 4] };
        image::Rgba(if inside(110.0, 18.0) || inside(190.0, 22.0) { eye } else { ground })
    });
    let file = folder.path().join("pair.png");
    picture.save(&file).unwrap();
    let mut harness = opening(&file);
    asked(&mut harness);
    press(&mut harness, "A part for each area");
    give(&mut harness);
    let places =
        |harness: &Story| parts(harness).iter().filter(|part| part.area_point().is_some()).count();
    assert_eq!((parts(&harness).len(), places(&harness)), (3, 2));

    // As one part it can be split later.
    let mut harness = opening(&file);
    asked(&mut harness);
    press(&mut harness, "One part");
    give(&mut harness);
    assert!(harness.query_by_label("Split by area").is_none(), "it is of no color");
    let mut harness = opening(&file);
    asked(&mut harness);
    harness.get_by_label_contains("A part for each color").click();
    steps(&mut harness);
    give(&mut harness);
    assert_eq!((parts(&harness).len(), places(&harness)), (2, 0));
    press(&mut harness, "Split by area");
    steps(&mut harness);
    assert_eq!(parts(&harness).len(), 3, "{:?} {:?}", session(&harness).notes, parts(&harness));
    assert_eq!(places(&harness), 2);
    assert!(
        harness.query_by_label("Split by area").is_none(),
        "a part of one place cannot be split"
    );

    // The drawing goes with its parts.
    press(&mut harness, "Cut drawing");
    steps(&mut harness);
    assert_eq!(layers(&harness)[..2], ["pair", "pair by parts"]);
    let document = session(&harness).shown_document().unwrap().clone();
    let group = document.layers[1].content.group().unwrap();
    assert!(group.layers.iter().all(|piece| piece.on.is_some()) && group.layers.len() == 3);
    assert!(harness.query_by_label("Cut drawing").is_none(), "it is cut already");
}

#[test]
fn who_only_wants_to_paint_is_not_asked_again_but_told_where_marks_lie_flat() {
    let folder = TempDir::new().unwrap();
    let mut harness = opening(&drawing(&folder));
    asked(&mut harness);
    press(&mut harness, "Only paint");
    assert!(session(&harness).shown_document().unwrap().surface.is_none());
    key(&mut harness, Modifiers::NONE, Key::B);
    key(&mut harness, Modifiers::NONE, Key::F3);
    harness.get_by_label_contains("No surface here");
    press(&mut harness, "Give it a shape…");
    until(&mut harness, |harness| harness.query_by_label("One part").is_some());
    press(&mut harness, "One part");
    press(&mut harness, "Coin");
    give(&mut harness);
    assert_eq!(parts(&harness).len(), 1);
    assert!(puff(&parts(&harness)[0]) < 0.3);
}

#[test]
fn a_first_minute_leads_from_a_drawing_to_a_bent_stroke_and_its_picture() {
    let folder = TempDir::new().unwrap();
    let mut harness = opening(&drawing(&folder));
    asked(&mut harness);
    press(&mut harness, "Tube");
    give(&mut harness);
    key(&mut harness, Modifiers::NONE, Key::B);
    key(&mut harness, Modifiers::NONE, Key::F3);
    stroke(&mut harness, vec2(40.0, 60.0));
    let painted = |harness: &Story, is_bent: bool| {
        let document = session(harness).active().unwrap().document().clone();
        let top = document.layers.last().unwrap().id;
        let document = if is_bent { document } else { Document { surface: None, ..document } };
        flatten_layer(&document, top, &Progress::default())
            .unwrap()
            .to_straight_rgba(document.size.rect())
    };
    let (bent, flat) = (painted(&harness, true), painted(&harness, false));
    let apart = bent.iter().zip(&flat).filter(|(a, b)| a.abs_diff(**b) > 30).count();
    assert!(apart > 200, "{apart} values differ from the flat stroke");

    key(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(layers(&harness), ["creature", "Light"]);
    key(&mut harness, Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert!(painted(&harness, true) == bent);
    command(&mut harness, "Export…");
    press(&mut harness, "Export…");
    let png = folder.path().join("painted.png");
    choose(&mut harness, &png);
    until(&mut harness, |harness| harness.query_by_label_contains("Exported").is_some());
    let (before, after) = (
        image::open(drawing(&folder)).unwrap().into_rgba8(),
        image::open(&png).unwrap().into_rgba8(),
    );
    let changed = before.pixels().zip(after.pixels()).filter(|(a, b)| a != b).count();
    assert_eq!(before.dimensions(), after.dimensions());
    assert!(changed > 20_000, "lit all over: {changed}");
}

#[test]
fn the_row_of_a_part_that_is_clicked_on_the_canvas_comes_into_sight() {
    let mut harness = window();
    command(&mut harness, "Sphere");
    until(&mut harness, |harness| harness.query_by_label("Layers").is_some());
    let tabs: Vec<_> = harness.get_all_by_label("Shape").collect();
    tabs.last().unwrap().click();
    steps(&mut harness);
    for name in ["Box", "Cone", "Torus", "Cylinder", "Capsule", "Ellipsoid"] {
        command(&mut harness, name);
        steps(&mut harness);
        harness.get_by_label(&format!("Show part {name}")).click_accesskit();
        steps(&mut harness);
    }
    assert_eq!(parts(&harness).iter().filter(|part| part.visible).count(), 1);
    let row = |harness: &Story, name: &str| harness.get_by_label(&format!("Part {name}")).rect();
    let (nearest, hidden) = (row(&harness, "Ellipsoid"), row(&harness, "Sphere"));
    assert!(hidden.min.y > nearest.max.y + 60.0, "{hidden:?} is far below {nearest:?}");
    key(&mut harness, Modifiers::NONE, Key::P);
    drag(&mut harness, vec2(50.0, -70.0), vec2(50.0, -70.0));
    steps(&mut harness);
    assert_eq!(session(&harness).active().unwrap().selected_part().unwrap().name, "Sphere");
    assert!(row(&harness, "Sphere").min.y < hidden.min.y - 30.0, "scrolled to");
}

#[test]
fn parts_are_added_selected_ordered_hidden_and_renamed_by_their_controls() {
    let mut harness = window();
    command(&mut harness, "Sphere");
    command(&mut harness, "Box");
    assert_eq!(parts(&harness).len(), 2);
    until(&mut harness, |harness| harness.query_by_label("Layers").is_some());
    // The tab next to the layers; the tool of that name comes before it.
    let tabs: Vec<_> = harness.get_all_by_label("Shape").collect();
    tabs.last().unwrap().click();
    steps(&mut harness);
    press(&mut harness, "Part Sphere");
    press(&mut harness, "Bring part forward");
    let names: Vec<String> = parts(&harness).iter().map(|part| part.name.clone()).collect();
    assert_eq!(names, ["Box", "Sphere"]);
    press(&mut harness, "Show part Sphere");
    assert!(!parts(&harness)[1].visible);
    press(&mut harness, "Delete part");
    assert_eq!(parts(&harness).len(), 1);
}

#[test]
fn maps_of_the_shape_are_exported_under_the_names_that_engines_expect() {
    let folder = TempDir::new().unwrap();
    let mut harness = window();
    command(&mut harness, "Sphere");
    command(&mut harness, "Export maps…");
    press(&mut harness, "down (DirectX)");
    press(&mut harness, "8 bits");
    press(&mut harness, "Mask (_mask)");
    press(&mut harness, "Export…");
    choose(&mut harness, &folder.path().join("ball.png"));
    let is_there = |name: &str| folder.path().join(name).exists();
    until(&mut harness, |_| is_there("ball_id.png"));
    assert!(
        is_there("ball_n.png")
            && is_there("ball_d.png")
            && is_there("ball_h.png")
            && !is_there("ball_mask.png")
    );
    let normals = image::open(folder.path().join("ball_n.png")).unwrap().into_rgba8();
    let above = normals.get_pixel(512, 300).0;
    assert!(above[1] < 100 && above[3] == 255, "green points down: {above:?}");
}

#[test]
fn a_layer_is_carried_by_a_part_that_is_chosen_in_its_properties() {
    let mut harness = window();
    command(&mut harness, "Sphere");
    command(&mut harness, "New paint layer");
    press(&mut harness, "Properties");
    harness.get_by_role_and_label(Role::ComboBox, "Attached to").click_accesskit();
    steps(&mut harness);
    harness.get_by_label("Sphere").click_accesskit();
    steps(&mut harness);
    let attachment = |harness: &Story| {
        let document = session(harness).active().unwrap().document();
        document.layers.last().unwrap().on.as_ref().map(|attachment| attachment.part.to_string())
    };
    assert_eq!(attachment(&harness).as_deref(), Some("part-1"));
    key(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(attachment(&harness), None);
}

#[test]
fn a_bevel_shows_its_profile_and_lines_their_angle() {
    let folder = TempDir::new().unwrap();
    let mut harness = opening(&drawing(&folder));
    asked(&mut harness);
    press(&mut harness, "Only paint");
    command(&mut harness, "Bevel");
    until(&mut harness, |harness| harness.query_by_label("Layers").is_some());
    let tabs: Vec<_> = harness.get_all_by_label("Shape").collect();
    tabs.last().unwrap().click();
    steps(&mut harness);
    assert!(harness.query_by_label("Profile of the bevel").is_some());
    command(&mut harness, "Lines as form");
    assert_eq!(parts(&harness)[1].kind.name(), "lines");
    assert!(harness.query_all_by_label("Angle").next().is_some());
}
