//! Figures and paths, by their tools, keys and the panel of properties.

use super::{Story, drag, key, layers, press, session, steps, window};
use eframe::egui::{Key, Modifiers, Pos2, Vec2, vec2};
use egui_kittest::kittest::Queryable;
use rilievo::Content;
use rilievo::paint::{FigureKind, LivePath};
use rilievo_program::tools::ToolKind;

fn path(harness: &Story) -> LivePath {
    let layer = session(harness).layer().expect("no layer is selected");
    match &layer.content {
        Content::Image(live) => {
            LivePath::clone(live.params().source.path().expect("it is no path"))
        }
        _ => panic!("it is no image layer"),
    }
}

/// Opens a menu of choices by its name, and takes one.
fn choose_in(harness: &mut Story, menu: &str, choice: &str) {
    press(harness, menu);
    harness.get_all_by_label(choice).last().expect("the choice").click();
    steps(harness);
}

fn middle(harness: &Story) -> Pos2 {
    harness.get_by_label("Canvas").rect().center()
}

fn click_at(harness: &mut Story, at: Vec2) {
    drag(harness, at, at);
}

#[test]
fn each_figure_is_drawn_and_changed_by_its_handles_and_numbers() {
    let mut harness = window();
    key(&mut harness, Modifiers::SHIFT, Key::U);
    assert_eq!(session(&harness).tool, ToolKind::Figure);
    for (i, (kind, label)) in FigureKind::LABELS.into_iter().enumerate() {
        if kind != session(&harness).tools.path.figure.kind {
            choose_in(&mut harness, "Kind of figure", label);
        }
        let corner = vec2(-260.0 + 90.0 * i as f32, -60.0);
        drag(&mut harness, corner, corner + vec2(60.0, 50.0));
        let drawn = *path(&harness).figure().expect("a figure");
        assert_eq!((drawn.kind, layers(&harness).len()), (kind, 2 + i), "{label}");
        let longer = corner + vec2(60.0, 80.0);
        drag(&mut harness, corner + vec2(60.0, 50.0), longer);
        let changed = *path(&harness).figure().expect("a figure");
        assert_eq!(layers(&harness).len(), 2 + i, "{label}: its handle was not grabbed");
        assert!(changed.to.y > drawn.to.y + 5.0, "{label}: {drawn:?} {changed:?}");
        assert!(changed.from.distance(drawn.from) < 0.01, "{label}: {drawn:?} {changed:?}");
    }
    key(&mut harness, Modifiers::COMMAND, Key::Z);
    let restored = *path(&harness).figure().expect("a figure");
    assert!((restored.to.y - restored.from.y) < 60.0 * restored.to.x.max(1.0));
}

#[test]
fn a_path_is_clicked_closed_by_its_first_node_and_taken_back_node_by_node() {
    let mut harness = window();
    key(&mut harness, Modifiers::SHIFT, Key::P);
    assert_eq!(session(&harness).tool, ToolKind::Path);
    click_at(&mut harness, vec2(-100.0, -60.0));
    click_at(&mut harness, vec2(80.0, -60.0));
    drag(&mut harness, vec2(80.0, 60.0), vec2(40.0, 110.0));
    assert_eq!((path(&harness).count_nodes(), layers(&harness).len()), (3, 2));
    key(&mut harness, Modifiers::NONE, Key::Backspace);
    assert_eq!(path(&harness).count_nodes(), 2);
    click_at(&mut harness, vec2(90.0, 70.0));
    click_at(&mut harness, vec2(-100.0, -60.0));
    let closed = path(&harness);
    assert!(closed.subpaths()[0].closed && closed.count_nodes() == 3, "{closed:?}");
    // A node is dragged afterwards.
    drag(&mut harness, vec2(90.0, 70.0), vec2(120.0, 40.0));
    assert!(path(&harness).subpaths()[0].nodes[2].at.x > closed.subpaths()[0].nodes[2].at.x);
    assert_eq!(layers(&harness).len(), 2);
    // Enter ends an open line: the next click begins a path of its own.
    click_at(&mut harness, vec2(-180.0, 120.0));
    click_at(&mut harness, vec2(-120.0, 120.0));
    key(&mut harness, Modifiers::NONE, Key::Enter);
    click_at(&mut harness, vec2(-180.0, 180.0));
    assert_eq!(layers(&harness).len(), 4, "{:?}", layers(&harness));
    assert!(middle(&harness).x > 0.0);
}

#[test]
fn properties_fill_outline_and_turn_a_figure_into_nodes() {
    let mut harness = window();
    key(&mut harness, Modifiers::SHIFT, Key::U);
    drag(&mut harness, vec2(-80.0, -60.0), vec2(80.0, 60.0));
    press(&mut harness, "Properties");
    let filled = path(&harness).fill;
    assert!(filled.is_some());
    harness.get_all_by_label("Fill").last().expect("the box of the layer").click();
    steps(&mut harness);
    assert_eq!(path(&harness).fill, None);
    press(&mut harness, "To nodes");
    assert_eq!((path(&harness).figure(), path(&harness).count_nodes()), (None, 4));
}
