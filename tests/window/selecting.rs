//! Selections, by tools, keys and the Select menu.

use super::{Story, command, drag, key, layers, press, session, steps, window};
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable;
use rilievo::raster::CoverageGrid;
use rilievo_program::tools::ToolKind;

fn area(harness: &Story) -> f64 {
    session(harness)
        .active()
        .unwrap()
        .document()
        .active_coverage()
        .map_or(0.0, CoverageGrid::area_px)
}

#[test]
fn a_rectangle_is_selected_grown_inverted_and_let_go_of_and_the_status_says_where_it_is() {
    let mut harness = window();
    press(&mut harness, "Select rectangle");
    drag(&mut harness, vec2(-60.0, -40.0), vec2(60.0, 40.0));
    let small = area(&harness);
    assert!(small > 1000.0);
    harness.get_by_label_contains("Selected ");
    command(&mut harness, "Grow selection…");
    harness.get_by_label("Pixels");
    press(&mut harness, "Change");
    assert!(area(&harness) > small);
    key(&mut harness, Modifiers::COMMAND | Modifiers::SHIFT, Key::I);
    assert!(area(&harness) > 1024.0 * 1024.0 - 2.0 * small);
    key(&mut harness, Modifiers::COMMAND | Modifiers::SHIFT, Key::A);
    assert_eq!(area(&harness), 0.0);
    assert!(harness.query_by_label_contains("Selected ").is_none());
    key(&mut harness, Modifiers::COMMAND | Modifiers::SHIFT, Key::A);
    harness.get_by_label_contains("Nothing is selected.");
    key(&mut harness, Modifiers::COMMAND | Modifiers::SHIFT, Key::D);
    assert!(area(&harness) > 0.0, "what was let go of is back");
}

#[test]
fn buttons_and_keys_say_how_a_selection_meets_the_last() {
    let mut harness = window();
    key(&mut harness, Modifiers::NONE, Key::R);
    assert_eq!(session(&harness).tool, ToolKind::SelectRectangle);
    drag(&mut harness, vec2(-100.0, -50.0), vec2(0.0, 50.0));
    let one = area(&harness);
    press(&mut harness, "Add");
    drag(&mut harness, vec2(20.0, -50.0), vec2(120.0, 50.0));
    assert!((area(&harness) - 2.0 * one).abs() < 0.03 * one);
    press(&mut harness, "Subtract");
    drag(&mut harness, vec2(20.0, -60.0), vec2(130.0, 60.0));
    assert!((area(&harness) - one).abs() < 0.03 * one);
    command(&mut harness, "Select all");
    assert_eq!(area(&harness), 1024.0 * 1024.0);
}

#[test]
fn a_lasso_of_clicks_is_closed_by_enter_and_given_up_by_escape() {
    let mut harness = window();
    press(&mut harness, "Lasso");
    let corners = [vec2(-80.0, -60.0), vec2(80.0, -60.0), vec2(80.0, 60.0)];
    let set = |harness: &mut Story| corners.iter().for_each(|&at| drag(harness, at, at));
    set(&mut harness);
    assert_eq!(session(&harness).tools.lasso.len(), 3);
    key(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(session(&harness).tools.lasso.is_empty() && area(&harness) == 0.0);
    set(&mut harness);
    key(&mut harness, Modifiers::NONE, Key::Enter);
    assert!(area(&harness) > 1000.0 && session(&harness).tools.lasso.is_empty());
}

#[test]
fn what_is_selected_is_cut_to_a_layer_of_its_own_kept_by_name_and_taken_again() {
    let mut harness = window();
    press(&mut harness, "Select ellipse");
    drag(&mut harness, vec2(-60.0, -60.0), vec2(60.0, 60.0));
    let round = area(&harness);
    key(&mut harness, Modifiers::COMMAND, Key::J);
    assert_eq!(layers(&harness), ["Background", "Background copy"]);
    command(&mut harness, "Keep selection…");
    harness.get_by_label("Name of selection").type_text("Eye");
    steps(&mut harness);
    press(&mut harness, "Keep");
    key(&mut harness, Modifiers::COMMAND | Modifiers::SHIFT, Key::A);
    press(&mut harness, "Select");
    press(&mut harness, "Select kept");
    press(&mut harness, "Eye");
    assert_eq!(area(&harness), round);
}
