//! The panel tool: cuts, new panels, clicks.

use super::layers::{find_panels, with_panels};
use super::*;
use crate::document::{Content, Layer, LayerLock};
use crate::math::Size;
use crate::paint::{PathGeometry, Sample};
use crate::tools::{ModifierKeys, ToolKind, ToolSettings};
use std::sync::Arc;

const SIZE: Size = Size::new(200, 120);

const SETTINGS: PanelSettings = PanelSettings {
    rows: 1.0,
    columns: 1.0,
    margin: 10.0,
    gutter_across: 4.0,
    gutter_down: 8.0,
    border: 2.0,
    ..PanelSettings::DEFAULT
};

fn page(settings: &PanelSettings) -> Document {
    let empty = Document::empty(SIZE);
    let shapes = settings.divide_rectangle([Vec2::ZERO, vec2(200.0, 120.0)]).unwrap();
    let shapes = shapes.into_iter().map(PathGeometry::Figure).collect();
    with_panels(&empty, shapes, LayerSlot::top_level(0), settings).unwrap().0
}

/// Names of the panels from above, with the corners of their frames.
fn describe_panels(document: &Document) -> Vec<(String, Option<[f32; 4]>)> {
    let group = |layer: &Arc<Layer>| {
        let panels = find_panels(document);
        let panel = panels.iter().find(|panel| panel.group == layer.id).unwrap();
        let Content::Image(live) = &document.layer(panel.frame).unwrap().content else { panic!() };
        let figure = live.params().source.path().unwrap().figure().copied();
        let corners = figure.map(|f| [f.from.x, f.from.y, f.to.x, f.to.y]);
        (layer.name.clone(), corners)
    };
    document.layers.iter().rev().map(group).collect()
}

fn drag(document: &Document, settings: PanelSettings, pens: &[Vec2], shift: bool) -> Outcome {
    let tools = ToolSettings { panels: settings, ..ToolSettings::default() };
    let context = ToolContext::new(document, &tools);
    let keys = ModifierKeys { shift, ..ModifierKeys::default() };
    let pen = |at: &Vec2| PenSample { sample: Sample::at(*at), keys };
    let (gesture, _) = crate::tools::press(ToolKind::Panels, &context, pen(&pens[0]));
    let mut gesture = gesture.unwrap();
    let pens: Vec<PenSample> = pens[1..].iter().map(pen).collect();
    gesture.drag(&pens);
    gesture.release()
}

fn commit(outcome: Outcome) -> Document {
    let Outcome::Commit { document, .. } = outcome else { panic!("nothing was done") };
    document
}

#[test]
fn panels_are_named_as_they_are_read_and_the_first_is_on_top() {
    let settings = PanelSettings { rows: 2.0, columns: 2.0, ..SETTINGS };
    let document = page(&settings);
    assert_eq!(
        describe_panels(&document),
        [
            ("Panel 1".into(), Some([10.0, 10.0, 98.0, 56.0])),
            ("Panel 2".into(), Some([102.0, 10.0, 190.0, 56.0])),
            ("Panel 3".into(), Some([10.0, 64.0, 98.0, 110.0])),
            ("Panel 4".into(), Some([102.0, 64.0, 190.0, 110.0]))
        ]
    );
    let group = document.layers[0].content.group().unwrap();
    let names: Vec<&str> = group.layers.iter().map(|layer| layer.name.as_str()).collect();
    assert_eq!(names, ["Paper", "Drawing", "Frame"]);
    let bare = page(&PanelSettings { paper: false, ..settings });
    assert_eq!(bare.layers[0].content.group().unwrap().layers.len(), 2);
}

#[test]
fn a_drag_across_a_panel_cuts_it_and_numbers_it_again() {
    let document = page(&PanelSettings { columns: 2.0, ..SETTINGS });
    // Level, not quite: Shift takes it to the nearest step.
    let across = [vec2(5.0, 60.0), vec2(110.0, 63.0)];
    let cut = commit(drag(&document, SETTINGS, &across, true));
    assert_eq!(
        describe_panels(&cut),
        [
            ("Panel 1".into(), Some([10.0, 10.0, 98.0, 56.0])),
            ("Panel 2".into(), Some([10.0, 64.0, 98.0, 110.0])),
            ("Panel 3".into(), Some([102.0, 10.0, 190.0, 110.0]))
        ],
        "the drag goes over less than half of the right panel"
    );
    // Over both panels, slanted: four, none of which is a rectangle.
    let both = commit(drag(&document, SETTINGS, &[vec2(0.0, 40.0), vec2(200.0, 80.0)], false));
    let names: Vec<_> =
        describe_panels(&both).into_iter().map(|(name, figure)| (name, figure.is_some())).collect();
    let named = |n: usize| (format!("Panel {n}"), false);
    assert_eq!(names.len(), 4);
    assert!(names.iter().all(|(_, is_figure)| !is_figure));
    let mut sorted = names.clone();
    sorted.sort();
    assert_eq!(sorted, [named(1), named(2), named(3), named(4)]);
}

#[test]
fn both_parts_get_what_the_panel_held() {
    let mut document = page(&SETTINGS);
    let panel = &find_panels(&document)[0];
    let note = Layer::new("Note", Content::Fill(crate::math::srgb::Color::BLACK));
    document = document.with_inserted(note, LayerSlot::in_group(panel.group, 1)).unwrap();
    let cut = commit(drag(&document, SETTINGS, &[vec2(100.0, 0.0), vec2(100.0, 120.0)], false));
    let notes = cut.walk().into_iter().filter(|(_, layer)| layer.name == "Note");
    let ids: Vec<LayerId> = notes.map(|(_, layer)| layer.id).collect();
    assert!(ids.len() == 2 && ids[0] != ids[1]);
    assert_eq!(describe_panels(&cut)[0].1, Some([10.0, 10.0, 98.0, 110.0]));
    assert_eq!(describe_panels(&cut)[1].1, Some([102.0, 10.0, 190.0, 110.0]));
    let manga = PanelSettings { right_to_left: true, ..SETTINGS };
    let cut = commit(drag(&document, manga, &[vec2(100.0, 0.0), vec2(100.0, 120.0)], false));
    assert_eq!(describe_panels(&cut)[0].1, Some([102.0, 10.0, 190.0, 110.0]));
}

#[test]
fn what_is_not_crossed_hidden_or_locked_is_not_cut() {
    let document = page(&SETTINGS);
    let refused = |document: &Document, pens: [Vec2; 2]| {
        matches!(drag(document, SETTINGS, &pens, false), Outcome::Refused(_))
    };
    assert!(refused(&document, [vec2(0.0, 60.0), vec2(60.0, 60.0)]), "a third of the way");
    assert!(refused(&document, [vec2(0.0, 5.0), vec2(200.0, 5.0)]), "beside it");
    assert!(refused(&document, [vec2(0.0, 12.0), vec2(200.0, 12.0)]), "nothing would be left");
    let across = [vec2(0.0, 60.0), vec2(200.0, 60.0)];
    assert!(!refused(&document, across));
    let id = document.layers[0].id;
    let hidden = document.with_layer(id, |layer| layer.visible = false).unwrap();
    let locked = document.with_layer(id, |layer| layer.lock = LayerLock::All).unwrap();
    assert!(refused(&hidden, across) && refused(&locked, across));
}

#[test]
fn new_panels_are_drawn_and_clicks_select_frames() {
    let settings = PanelSettings { drag: PanelDrag::Draw, ..SETTINGS };
    let drawn = drag(&page(&SETTINGS), settings, &[vec2(150.0, 90.0), vec2(50.0, 30.0)], false);
    let document = commit(drawn);
    let all = describe_panels(&document);
    assert_eq!(all.len(), 2);
    assert!(all.iter().any(|(_, corners)| *corners == Some([50.0, 30.0, 150.0, 90.0])));
    let square = drag(&document, settings, &[vec2(10.0, 10.0), vec2(50.0, 20.0)], true);
    let all = describe_panels(&commit(square));
    assert!(all.iter().any(|(_, corners)| *corners == Some([10.0, 10.0, 50.0, 50.0])));
    let small = drag(&document, settings, &[vec2(10.0, 10.0), vec2(10.5, 30.0)], false);
    assert!(matches!(small, Outcome::Cancel));
    let click = drag(&document, settings, &[vec2(60.0, 40.0)], false);
    let Outcome::Choose(DocumentChoice::Layer(id)) = click else { panic!("nothing was selected") };
    assert_eq!(id, find_panels(&document).last().unwrap().frame);
    assert!(matches!(drag(&document, settings, &[vec2(1.0, 1.0)], false), Outcome::Cancel));
}

#[test]
fn a_cut_goes_where_the_transform_of_a_panel_shows_it() {
    use crate::document::{LayerTransform, TransformShape};
    use crate::raster::Resampling;
    let document = page(&SETTINGS);
    // Mirrored about the middle of the page, and half as large.
    let shape = TransformShape::Matrix([-0.5, 0.0, 0.0, 0.5, 150.0, 30.0]);
    let transform = Some(LayerTransform { shape, filter: Resampling::default() });
    let id = document.layers[0].id;
    let document = document.with_layer(id, |layer| layer.transform = transform).unwrap();
    let cut = commit(drag(&document, SETTINGS, &[vec2(80.0, 0.0), vec2(80.0, 120.0)], false));
    let frames: Vec<_> =
        describe_panels(&cut).into_iter().map(|(_, corners)| corners.unwrap()).collect();
    // x of the frame is 2 (150 − x of the canvas): the gutter from 78 to 82 lies from 144 to 136.
    assert_eq!(frames, [[144.0, 10.0, 190.0, 110.0], [10.0, 10.0, 136.0, 110.0]]);
}
