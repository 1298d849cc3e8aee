//! Palettes, the bars of lightness, chroma and hue, harmonies, and exports that are remembered.

use super::{choose, command, key, press, session, steps, until, window, window_at};
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable;

/// The colors of the palette of the document, in their order.
fn palette(harness: &super::Story) -> Vec<String> {
    let document = session(harness).active().unwrap().document();
    document.palette.colors.iter().map(|named| named.color.to_string()).collect()
}

#[test]
fn colors_are_added_to_the_palette_taken_from_it_dragged_and_removed() {
    let mut harness = window();
    press(&mut harness, "Palettes");
    press(&mut harness, "Add color");
    key(&mut harness, Modifiers::NONE, Key::X);
    press(&mut harness, "Add color");
    assert_eq!(palette(&harness), ["#000000", "#ffffff"]);
    press(&mut harness, "Palette color 1");
    assert_eq!(session(&harness).tools.color.to_string(), "#000000");
    let [first, second] =
        ["Palette color 1", "Palette color 2"].map(|label| harness.get_by_label(label).rect());
    harness.drag_at(first.center());
    steps(&mut harness);
    harness.hover_at(second.center() + vec2(5.0, 0.0));
    steps(&mut harness);
    harness.drop_at(second.center() + vec2(5.0, 0.0));
    steps(&mut harness);
    assert_eq!(palette(&harness), ["#ffffff", "#000000"]);
    harness.get_by_label("Palette color 2").click_secondary();
    steps(&mut harness);
    press(&mut harness, "Remove");
    assert_eq!(palette(&harness), ["#ffffff"]);
    key(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(palette(&harness).len(), 2);
}

#[test]
fn a_palette_of_another_program_is_imported_and_copied_to_the_document() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("sea.gpl");
    std::fs::write(&file, "GIMP Palette\nName: Sea\n#\n1 2 3\tdeep\n200 220 230\tfoam\n").unwrap();
    let mut harness = window();
    press(&mut harness, "Palettes");
    press(&mut harness, "Palette menu");
    press(&mut harness, "Import…");
    choose(&mut harness, &file);
    until(&mut harness, |harness| session(harness).palettes.shown.as_deref() == Some("Sea"));
    press(&mut harness, "Palette color 2, foam");
    assert_eq!(session(&harness).tools.color.to_string(), "#c8dce6");
    press(&mut harness, "Palette menu");
    press(&mut harness, "Copy to this document");
    assert_eq!(palette(&harness), ["#010203", "#c8dce6"]);
}

#[test]
fn bars_of_lightness_and_chroma_lead_to_colors_that_srgb_has() {
    let mut harness = window();
    press(&mut harness, "Color");
    press(&mut harness, "Lightness, chroma, hue");
    key(&mut harness, Modifiers::NONE, Key::Escape);
    let mut click_bar = |label: &str, share: f32| {
        let rect = harness.get_by_label(label).rect();
        let at = rect.lerp_inside(vec2(share, 0.5));
        harness.drag_at(at);
        steps(&mut harness);
        harness.drop_at(at);
        steps(&mut harness);
        let color = session(&harness).tools.color;
        [color.r, color.g, color.b]
    };
    let gray = click_bar("Lightness of the color", 0.6);
    assert!(gray[0] == gray[1] && (100..150).contains(&gray[0]), "{gray:?}");
    let strong = click_bar("Chroma of the color", 1.0);
    assert!(strong.iter().max().unwrap() - strong.iter().min().unwrap() > 100, "{strong:?}");
    let lighter = click_bar("Lightness of the color", 0.98);
    let back = click_bar("Lightness of the color", 0.6);
    assert_ne!(lighter, back);
    assert_eq!(back, strong, "the chroma that sRGB lacks was not forgotten");
}

#[test]
fn the_colors_of_a_harmony_are_beside_the_wheel() {
    let mut harness = window();
    key(&mut harness, Modifiers::NONE, Key::D);
    press(&mut harness, "Color");
    press(&mut harness, "Numbers and palette");
    press(&mut harness, "Harmony");
    press(&mut harness, "Complement");
    key(&mut harness, Modifiers::NONE, Key::Escape);
    press(&mut harness, "Hex color");
    key(&mut harness, Modifiers::COMMAND, Key::A);
    harness.get_by_label("Hex color").type_text("#ff8000");
    steps(&mut harness);
    key(&mut harness, Modifiers::NONE, Key::Enter);
    press(&mut harness, "Harmony 1");
    assert_eq!(session(&harness).tools.color.to_string(), "#007fff");
}

#[test]
fn an_export_is_repeated_by_one_key_and_remembered_with_the_file_of_the_document() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let (jpg, ora) = (at("small.jpg"), at("a.ora"));
    let size = |file: &std::path::Path| image::image_dimensions(file).unwrap();
    let settings = at("settings.json");
    let mut harness = window_at(1.0, Some(settings.clone()));
    command(&mut harness, "Save as");
    choose(&mut harness, &ora);
    until(&mut harness, |harness| session(harness).active().unwrap().file.is_some());
    command(&mut harness, "Export…");
    press(&mut harness, "½×");
    press(&mut harness, "JPEG: small, opaque");
    until(&mut harness, |harness| harness.query_by_label_contains(" kB").is_some());
    press(&mut harness, "Export…");
    choose(&mut harness, &jpg);
    until(&mut harness, |_| jpg.is_file());
    assert_eq!(size(&jpg), (512, 512));
    until(&mut harness, |harness| session(harness).active().unwrap().exported.is_some());
    let again = Modifiers::COMMAND | Modifiers::ALT | Modifiers::SHIFT;
    std::fs::remove_file(&jpg).unwrap();
    key(&mut harness, again, Key::E);
    until(&mut harness, |_| jpg.is_file());
    let read = |file: &std::path::Path| std::fs::read_to_string(file).unwrap_or_default();
    until(&mut harness, |_| read(&settings).contains("small.jpg"));
    drop(harness);
    std::fs::remove_file(&jpg).unwrap();
    let mut later = window_at(1.0, Some(settings));
    later.state_mut().as_mut().unwrap().begin(vec![ora]);
    until(&mut later, |harness| session(harness).active().unwrap().file.is_some());
    key(&mut later, again, Key::E);
    until(&mut later, |_| jpg.is_file());
    assert_eq!(size(&jpg), (512, 512));
}
