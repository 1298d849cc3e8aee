//! Layers and their masks, by the buttons of their panel and the commands of their menu.

use super::{Story, click, command, layers, press, session, steps, stroke, until, window};
use eframe::egui::{Modifiers, pos2, vec2};
use egui_kittest::kittest::Queryable;
use rilievo::Content;
use rilievo::document::MaskKind;

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
fn a_layer_that_is_made_of_settings_shows_them() {
    let mut harness = window();
    press(&mut harness, "Brushes");
    command(&mut harness, "New stroke layer");
    let shows_settings = |harness: &Story| harness.query_all_by_label("Made of").next().is_some();
    assert!(!shows_settings(&harness), "brushes stay, which it is painted with");
    command(&mut harness, "New vibrance layer");
    assert!(shows_settings(&harness));
}

#[test]
fn layers_are_merged_baked_and_flattened_beside_the_window() {
    let mut harness = window();
    command(&mut harness, "New gradient layer");
    command(&mut harness, "Turn layer into pixels");
    until(&mut harness, |harness| {
        matches!(session(harness).layer().unwrap().content, Content::Pixels(_))
    });
    command(&mut harness, "Merge down");
    until(&mut harness, |harness| layers(harness) == ["Background"]);
    command(&mut harness, "Flatten picture");
    until(&mut harness, |harness| layers(harness) == ["Picture"]);
    command(&mut harness, "Undo");
    assert_eq!(layers(&harness), ["Background"]);
}

#[test]
fn a_mask_is_made_painted_on_inverted_put_aside_and_deleted() {
    let mut harness = window();
    press(&mut harness, "Properties");
    harness.get_by_label("Hide all").scroll_to_me();
    steps(&mut harness);
    press(&mut harness, "Hide all");
    let masked = |harness: &Story| session(harness).layer().unwrap().mask.clone();
    let coverage = |harness: &Story| match masked(harness).unwrap().kind {
        MaskKind::File { coverage, .. } => coverage,
        _ => panic!("a mask to paint on"),
    };
    assert!(
        session(&harness).active().unwrap().on_mask
            && coverage(&harness).values().iter().all(|&v| v == 0)
    );
    command(&mut harness, "Swap colors");
    stroke(&mut harness, vec2(60.0, 10.0));
    assert!(coverage(&harness).values().iter().any(|&v| v > 100), "white paint shows");
    assert_eq!(layers(&harness), ["Background"], "the stroke went to the mask");
    command(&mut harness, "Invert mask");
    command(&mut harness, "Use mask");
    assert!(masked(&harness).unwrap().invert && masked(&harness).unwrap().disabled);
    press(&mut harness, "Mask of Background");
    assert!(!session(&harness).active().unwrap().on_mask, "the brush paints on the layer again");
    command(&mut harness, "Delete mask");
    assert!(masked(&harness).is_none());
    command(&mut harness, "Paint on mask");
    assert!(masked(&harness).is_some(), "every command is in the palette");
}

/// From the middle of a row of the list to a share of the height of another one.
fn drag_row(harness: &mut Story, from: &str, to: &str, share: f32) {
    let row = |harness: &Story, name: &str| {
        harness.get_by_label_contains(&format!("Layer {name}")).rect()
    };
    let (start, end) = (row(harness, from), row(harness, to));
    let at = pos2(end.center().x, end.top() + share * end.height());
    harness.drag_at(start.center());
    steps(harness);
    for step in [0.3, 0.7, 1.0] {
        harness.hover_at(start.center() + (at - start.center()) * step);
        steps(harness);
    }
    harness.drop_at(at);
    steps(harness);
}

#[test]
fn rows_are_dragged_to_another_place_and_into_a_group_one_or_several() {
    let mut harness = window();
    ["New fill layer", "New gradient layer", "New group"]
        .into_iter()
        .for_each(|name| command(&mut harness, name));
    // The properties leave room for three rows only.
    press(&mut harness, "Brushes");
    assert_eq!(layers(&harness), ["Background", "Fill", "Gradient", "Group"]);
    drag_row(&mut harness, "Gradient", "Fill", 0.9);
    assert_eq!(layers(&harness), ["Background", "Gradient", "Fill", "Group"]);
    drag_row(&mut harness, "Background", "Fill", 0.1);
    assert_eq!(layers(&harness), ["Gradient", "Fill", "Background", "Group"]);
    let row = |harness: &mut Story, name: &str, keys| {
        harness.get_by_label_contains(&format!("Layer {name}")).click_modifiers(keys);
        steps(harness);
    };
    row(&mut harness, "Gradient", Modifiers::NONE);
    row(&mut harness, "Background", Modifiers::COMMAND);
    drag_row(&mut harness, "Background", "Group", 0.5);
    assert_eq!(layers(&harness), ["Fill", "Group"]);
    let inner = |harness: &Story| {
        let document = session(harness).active().unwrap().document();
        let group = document.layer_named("Group").unwrap().content.group().unwrap().clone();
        group.layers.iter().map(|layer| layer.name.clone()).collect::<Vec<_>>()
    };
    assert_eq!(inner(&harness), ["Gradient", "Background"]);
    assert_eq!(session(&harness).active().unwrap().history.undo_label(), Some("Move layers"));
    command(&mut harness, "Undo");
    assert_eq!(layers(&harness), ["Gradient", "Fill", "Background", "Group"]);
}
