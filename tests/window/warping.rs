//! Meshes and liquify by the window's own controls.

use super::{Story, click, command, drag, press, session, steps, window};
use eframe::egui::vec2;
use egui_kittest::kittest::Queryable;
use rilievo::Layer;
use std::sync::Arc;

/// A paint layer with a stroke on it.
fn painted() -> Story {
    let mut harness = window();
    command(&mut harness, "New paint layer");
    press(&mut harness, "Brush");
    drag(&mut harness, vec2(-60.0, -30.0), vec2(60.0, 30.0));
    harness
}

fn layer(harness: &Story) -> Arc<Layer> {
    session(harness).layer().unwrap().clone()
}

#[test]
fn a_layer_is_liquified_by_the_named_tool_undone_and_its_liquify_removed() {
    let mut harness = painted();
    press(&mut harness, "Liquify");
    click(&mut harness, "Twirl left");
    drag(&mut harness, vec2(-10.0, -5.0), vec2(10.0, 5.0));
    assert!(layer(&harness).liquify.is_some());
    command(&mut harness, "Undo");
    assert!(layer(&harness).liquify.is_none());
    command(&mut harness, "Redo");
    assert!(layer(&harness).liquify.is_some());
    command(&mut harness, "Remove liquify");
    assert!(layer(&harness).liquify.is_none());
}

#[test]
fn a_mesh_is_laid_from_its_menu_and_applied() {
    let mut harness = painted();
    command(&mut harness, "Transform");
    click(&mut harness, "Mesh");
    click(&mut harness, "4 × 4 points");
    assert!(layer(&harness).transform.as_ref().is_some_and(|own| own.mesh().is_some()));
    assert!(harness.query_by_label("Mesh 4 × 4").is_some());
    command(&mut harness, "Apply transform");
    steps(&mut harness);
    assert!(layer(&harness).transform.is_none());
}
