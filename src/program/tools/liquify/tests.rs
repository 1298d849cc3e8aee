use super::*;
use crate::document::{Group, Layer, PixelLayer, Progress, Symmetry, flatten};
use crate::math::{Rect, Size, Vec2, srgb::Color, vec2};
use crate::paint::LiquifySettings;
use crate::raster::{CoverageGrid, TileAt, TileGrid};
use crate::tools::ModifierKeys;
use crate::tools::ToolSettings;

const SIZE: Size = Size::new(256, 192);

/// A fine pattern of colors.
fn document() -> Document {
    let mut rgba = Vec::new();
    for y in 0..SIZE.height {
        for x in 0..SIZE.width {
            rgba.extend([(x * 7 % 256) as u8, (y * 5 % 256) as u8, ((x ^ y) % 256) as u8, 255]);
        }
    }
    let tiles =
        TileGrid::from_straight_rgba(&rgba, SIZE.width as usize, SIZE.height as usize, 0, 0);
    let paint = Layer::new("paint", Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() }));
    Document { layers: vec![Arc::new(paint)], ..Document::empty(SIZE) }
}

fn settings(tool: LiquifyTool) -> LiquifySettings {
    LiquifySettings { tool, size: 60.0, strength: 1.0, ..LiquifySettings::default() }
}

fn stroke(document: &Document, settings: LiquifySettings, way: &[Vec2]) -> Option<Document> {
    let tools = ToolSettings { liquify: settings, ..ToolSettings::default() };
    let layer = Some(document.layers[0].id);
    let context = ToolContext { layer, ..ToolContext::new(document, &tools) };
    let (gesture, _) = press(&context, PenSample::at(way[0]));
    let mut gesture = gesture?;
    way[1..].iter().for_each(|at| drop(gesture.drag(&[PenSample::at(*at)])));
    match gesture.release() {
        Outcome::Commit { document, .. } => Some(document),
        _ => None,
    }
}

fn bytes(document: &Document) -> Vec<[u8; 4]> {
    let flat = flatten(document, &Progress::default()).unwrap();
    let (w, h) = (SIZE.width as i32, SIZE.height as i32);
    (0..h).flat_map(|y| (0..w).map(move |x| (x, y))).map(|(x, y)| flat.pixel(x, y)).collect()
}

#[test]
fn a_push_takes_pixels_along_and_leaves_all_far_from_it() {
    let before = document();
    let after =
        stroke(&before, settings(LiquifyTool::Push), &[vec2(100.0, 100.0), vec2(116.0, 100.0)])
            .unwrap();
    let (old, new) = (bytes(&before), bytes(&after));
    let at = |x: usize, y: usize| y * SIZE.width as usize + x;
    assert_ne!(old[at(110, 100)], new[at(110, 100)]);
    assert_eq!(old[at(20, 20)], new[at(20, 20)]);
    // Undoing is a step of history: the layer's pixels themselves were not changed.
    let Content::Pixels(a) = &before.layers[0].content else { unreachable!() };
    let Content::Pixels(b) = &after.layers[0].content else { unreachable!() };
    assert!(a.tiles.ptr_eq(&b.tiles));
    let tiles = crate::document::diff(&before, &after);
    assert!(tiles.contains(&TileAt::new(1, 1)) && !tiles.contains(&TileAt::new(3, 2)), "{tiles:?}");
}

#[test]
fn what_is_pushed_and_restored_has_its_bytes_again() {
    let before = document();
    let pushed =
        stroke(&before, settings(LiquifyTool::Push), &[vec2(100.0, 100.0), vec2(130.0, 90.0)])
            .unwrap();
    let restore = LiquifySettings { size: 600.0, ..settings(LiquifyTool::Restore) };
    let mut now = pushed.clone();
    for _ in 0..20 {
        now = stroke(&now, restore, &[vec2(80.0, 95.0), vec2(150.0, 95.0)]).unwrap_or(now);
    }
    assert!(now.layers[0].liquify.is_none());
    assert!(bytes(&pushed) != bytes(&before) && bytes(&now) == bytes(&before));
}

#[test]
fn a_group_is_displaced_as_paint_is_and_looks_alike_baked() {
    let before = document();
    let group = Layer::new(
        "group",
        Content::Group(Group { layers: before.layers.clone(), pass_through: true }),
    );
    let grouped = Document { layers: vec![Arc::new(group)], ..before.clone() };
    let way = [vec2(100.0, 100.0), vec2(120.0, 110.0)];
    let [a, b] = [&before, &grouped]
        .map(|document| stroke(document, settings(LiquifyTool::Push), &way).unwrap());
    assert!(bytes(&a) == bytes(&b), "both are sampled once, from the same pixels");
    let applied = a.with_transform_applied(a.layers[0].id).unwrap();
    assert!(applied.layers[0].liquify.is_none() && bytes(&applied) == bytes(&a));
}

#[test]
fn what_is_not_selected_stays_as_it_was() {
    let mut before = document();
    let half = CoverageGrid::full(Rect::new(0, 0, 96, SIZE.height as i32));
    before.active_selection = Some(Arc::new(crate::paint::Selection::new(half)));
    let after =
        stroke(&before, settings(LiquifyTool::Grow), &[vec2(100.0, 96.0), vec2(110.0, 96.0)])
            .unwrap();
    let (old, new) = (bytes(&before), bytes(&after));
    let at = |x: usize, y: usize| y * SIZE.width as usize + x;
    assert_ne!(old[at(86, 90)], new[at(86, 90)]);
    // Between nodes it fades within two cells.
    assert!((0..192).all(|y| (112..256).all(|x| old[at(x, y)] == new[at(x, y)])));
}

#[test]
fn what_cannot_be_displaced_says_why() {
    let tools = ToolSettings::default();
    let fill = Layer::new("fill", Content::Fill(Color::BLACK));
    let document = Document { layers: vec![Arc::new(fill)], ..Document::empty(SIZE) };
    let context =
        ToolContext { layer: Some(document.layers[0].id), ..ToolContext::new(&document, &tools) };
    let pen = PenSample { keys: ModifierKeys::default(), ..PenSample::at(vec2(9.0, 9.0)) };
    assert!(matches!(press(&context, pen).1, Outcome::Refused(why) if why.contains("one color")));
    let nothing = ToolContext { layer: None, ..context };
    assert!(
        matches!(press(&nothing, pen).1, Outcome::Refused(why) if why.contains("Select a layer"))
    );
}

#[test]
fn a_stroke_and_its_mirror_image_displace_alike() {
    let mut document = document();
    document.symmetry.kind = Symmetry::Vertical;
    let layer = Some(document.layers[0].id);
    for tool in [LiquifyTool::Push, LiquifyTool::Grow, LiquifyTool::TwirlLeft] {
        let tools = ToolSettings { liquify: settings(tool), ..ToolSettings::default() };
        let context = ToolContext { layer, ..ToolContext::new(&document, &tools) };
        let (gesture, _) = press(&context, PenSample::at(vec2(60.0, 100.0)));
        let mut gesture = gesture.unwrap();
        gesture.drag(&[PenSample::at(vec2(70.0, 92.0))]);
        let Outcome::Commit { document, .. } = gesture.release() else { panic!("{tool:?}") };
        let lattice = document.layers[0].liquify.clone().unwrap();
        let mut most = 0f32;
        for (x, y) in (0..128)
            .step_by(5)
            .flat_map(|x| (40..160).step_by(5).map(move |y| (x as f32, y as f32)))
        {
            let (left, right) = (lattice.at(vec2(x, y)).by, lattice.at(vec2(256.0 - x, y)).by);
            most = most.max(left.length());
            assert!(
                (left * vec2(-1.0, 1.0) - right).length() < 0.1,
                "{tool:?} at {x} {y}: {left} {right}"
            );
        }
        assert!(most > 1.0, "{tool:?} {most}");
    }
}
