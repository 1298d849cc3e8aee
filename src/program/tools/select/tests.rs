use super::*;
use crate::document::{Content, Layer, PixelLayer};
use crate::math::{Rect, Size, Vec3, vec2};
use crate::raster::{CoverageGrid, Plane, TileGrid};
use crate::surface::{Maps, Surface};
use crate::tools::ModifierKeys;
use crate::tools::ToolSettings;
use std::sync::Arc;

const SIZE: Size = Size::new(200, 130);

/// Bands of gray that get lighter from left to right, 20 px wide; the sixth is separate from the
/// rest.
fn bands() -> Document {
    let gray = |x: usize| (x / 20 * 20) as u8;
    let rgba: Vec<u8> =
        (0..200 * 130).flat_map(|i| [gray(i % 200), gray(i % 200), 0, 255]).collect();
    let tiles = TileGrid::from_straight_rgba(&rgba, 200, 130, 0, 0);
    let layer = Layer::new("bands", Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() }));
    Document { layers: vec![Arc::new(layer)], ..Document::empty(SIZE) }
}

/// Drags a tool; returns the resulting document and settings.
fn drag_with(
    kind: ToolKind,
    document: &Document,
    select: SelectSettings,
    keys: ModifierKeys,
    points: &[Vec2],
) -> (Option<Document>, SelectSettings) {
    let mut tools = ToolSettings { select, ..ToolSettings::default() };
    let context = ToolContext::new(document, &tools);
    let pen = |at: Vec2| PenSample { keys, ..PenSample::at(at) };
    let (gesture, _) = press(kind, &context, pen(points[0]));
    let Some(mut gesture) = gesture else { return (None, select) };
    points[1..].iter().for_each(|&at| drop(gesture.drag(&[pen(at)])));
    match gesture.release().apply_settings(&mut tools) {
        Outcome::Commit { document, .. } => (Some(document), tools.select),
        _ => (None, select),
    }
}

fn draw(
    kind: ToolKind,
    document: &Document,
    keys: ModifierKeys,
    points: &[Vec2],
) -> Option<Document> {
    drag_with(kind, document, SelectSettings::default(), keys, points).0
}

fn covered_rect(document: &Document) -> Rect {
    document.active_coverage().map_or(Rect::EMPTY, CoverageGrid::covered_rect)
}
const NONE: ModifierKeys = ModifierKeys { shift: false, ctrl: false, alt: false };

#[test]
fn a_rectangle_is_dragged_along_whole_pixels_and_keys_say_how_it_meets_the_last() {
    let points = [vec2(20.3, 30.4), vec2(50.0, 40.0), vec2(80.6, 90.2)];
    let one = draw(ToolKind::SelectRectangle, &Document::empty(SIZE), NONE, &points).unwrap();
    assert_eq!(covered_rect(&one), Rect::new(20, 30, 81, 90));
    let next = [vec2(60.0, 10.0), vec2(120.0, 60.0)];
    let with = |shift, alt| {
        let found =
            draw(ToolKind::SelectRectangle, &one, ModifierKeys { shift, alt, ctrl: false }, &next)
                .unwrap();
        let grid = found.active_coverage().unwrap().clone();
        [(30, 70), (70, 40), (100, 20)].map(|(x, y)| grid.at(x, y) == 255)
    };
    assert_eq!(with(false, false), [false, true, true]);
    assert_eq!(with(true, false), [true, true, true]);
    assert_eq!(with(false, true), [true, false, false]);
    assert_eq!(with(true, true), [false, true, false]);
}

#[test]
fn a_drag_within_the_selection_moves_it_and_a_click_beside_it_lets_go() {
    let one =
        draw(ToolKind::SelectRectangle, &bands(), NONE, &[vec2(20.0, 30.0), vec2(80.0, 90.0)])
            .unwrap();
    let moved =
        draw(ToolKind::SelectRectangle, &one, NONE, &[vec2(50.0, 50.0), vec2(75.4, 39.6)]).unwrap();
    assert_eq!(covered_rect(&moved), Rect::new(45, 20, 105, 80));
    let all = bands().with_selection(Some(Selection::new(CoverageGrid::full(SIZE.rect()))));
    let drag = [vec2(50.0, 50.0), vec2(75.0, 90.0)];
    let anew = draw(ToolKind::SelectRectangle, &all, NONE, &drag).unwrap();
    assert_eq!(
        covered_rect(&anew),
        Rect::new(50, 50, 75, 90),
        "in all of the canvas it begins anew"
    );
    let click = [vec2(150.0, 100.0), vec2(151.0, 100.0)];
    assert!(
        draw(ToolKind::SelectRectangle, &one, NONE, &click).unwrap().active_coverage().is_none()
    );
    let shift = ModifierKeys { shift: true, ..NONE };
    assert!(
        draw(ToolKind::SelectRectangle, &one, shift, &click).is_none(),
        "adding nothing is no step"
    );
}

#[test]
fn a_lasso_drawn_freely_closes_when_the_pen_lifts() {
    let points = [vec2(20.0, 20.0), vec2(120.0, 20.0), vec2(120.0, 100.0), vec2(20.0, 100.0)];
    let found = draw(ToolKind::Lasso, &Document::empty(SIZE), NONE, &points).unwrap();
    assert_eq!(covered_rect(&found), Rect::new(20, 20, 120, 100));
}

#[test]
fn a_lasso_of_clicks_goes_on_until_its_first_corner_is_clicked() {
    let (document, mut tools) = (Document::empty(SIZE), ToolSettings::default());
    for at in [vec2(20.0, 20.0), vec2(120.0, 20.0), vec2(120.0, 100.0)] {
        let context = ToolContext::new(&document, &tools);
        let mut gesture = press(ToolKind::Lasso, &context, PenSample::at(at)).0.unwrap();
        let outcome = gesture.release().apply_settings(&mut tools);
        assert!(matches!(outcome, Outcome::Cancel), "it goes on");
    }
    assert_eq!(tools.lasso.len(), 3);
    let context = ToolContext::new(&document, &tools);
    let Outcome::Commit { document: found, .. } =
        press(ToolKind::Lasso, &context, PenSample::at(vec2(22.0, 23.0))).1
    else {
        panic!("it is closed")
    };
    assert_eq!(covered_rect(&found), Rect::new(20, 20, 120, 100));
    assert!(
        select_closed_lasso(&document, &tools.lasso[..2], &SelectSettings::default()).is_none()
    );
}

#[test]
fn the_wand_selects_what_is_like_a_pixel_and_a_drag_changes_how_like() {
    let document = bands();
    let at = vec2(45.0, 60.0);
    let found = draw(ToolKind::Wand, &document, NONE, &[at]).unwrap();
    assert_eq!(
        covered_rect(&found),
        Rect::new(20, 0, 80, 130),
        "a tolerance of 25 bytes takes one more on each side"
    );
    // 50 of 500 points: a tenth more.
    let (wider, settings) =
        drag_with(ToolKind::Wand, &document, SelectSettings::default(), NONE, &[at, at + 50.0]);
    assert_eq!(covered_rect(&wider.unwrap()), Rect::new(0, 0, 100, 130));
    assert!((settings.wand.tolerance - 0.2).abs() < 1e-6, "it stays for the next one");
    let everywhere = SelectSettings { joined: false, ..SelectSettings::default() };
    let striped =
        draw(ToolKind::SelectRectangle, &document, NONE, &[vec2(0.0, 0.0), vec2(9.0, 9.0)])
            .unwrap();
    let (all, _) = drag_with(ToolKind::Wand, &striped, everywhere, NONE, &[at]);
    assert_eq!(covered_rect(&all.unwrap()), Rect::new(20, 0, 80, 130));
}

#[test]
fn the_surface_wand_keeps_what_it_was_told_and_says_why_it_cannot() {
    let normals =
        Plane::from_fn(SIZE, |x, _| Vec3::new(if x < 100 { -0.6 } else { 0.6 }, 0.0, 0.8));
    let maps = Maps { normals, depth: Plane::full(SIZE, 0.5), coverage: Plane::full(SIZE, 255) };
    let roof =
        Document { surface: Some(Arc::new(Surface::new(maps).unwrap())), ..Document::empty(SIZE) };
    let points = [vec2(30.5, 40.5), vec2(55.5, 40.5)];
    let (found, settings) =
        drag_with(ToolKind::SurfaceWand, &roof, SelectSettings::default(), NONE, &points);
    let found = found.unwrap();
    assert_eq!(covered_rect(&found), Rect::new(0, 0, 100, 130));
    let told = found.active_selection.as_ref().unwrap().made.unwrap();
    assert_eq!((told.at, told.tolerance), (points[0], 24.0));
    assert_eq!(settings.region.tolerance, 24.0);
    let added = drag_with(
        ToolKind::SurfaceWand,
        &found,
        settings,
        ModifierKeys { shift: true, ..NONE },
        &[vec2(150.5, 9.5)],
    );
    let added = added.0.unwrap();
    assert!(added.active_selection.as_ref().unwrap().made.is_none(), "two regions are no region");
    assert_eq!(covered_rect(&added), SIZE.rect());
    let (empty, tools) = (Document::empty(SIZE), ToolSettings::default());
    let said =
        press(ToolKind::SurfaceWand, &ToolContext::new(&empty, &tools), PenSample::at(points[0])).1;
    assert!(matches!(said, Outcome::Refused(why) if why.contains("no surface")));
}
