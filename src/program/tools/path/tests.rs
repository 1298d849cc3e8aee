//! Paths and figures under the pen.

use super::*;
use crate::math::{Size, vec2};
use crate::tools::{ModifierKeys, Outcome, PenSample, ToolKind, ToolSettings, press};

const NONE: ModifierKeys = ModifierKeys { shift: false, ctrl: false, alt: false };
const SHIFT: ModifierKeys = ModifierKeys { shift: true, ..NONE };
const CTRL: ModifierKeys = ModifierKeys { ctrl: true, ..NONE };
const ALT: ModifierKeys = ModifierKeys { alt: true, ..NONE };

/// A document, its settings and its selected layer, as a session holds them.
struct Hand {
    document: Document,
    tools: ToolSettings,
    layer: Option<LayerId>,
}

impl Hand {
    fn new() -> Self {
        let document = Document::empty(Size::new(200, 150));
        Self { document, tools: ToolSettings::default(), layer: None }
    }

    /// Drags a tool from a point to others; the step's name.
    fn drag(&mut self, kind: ToolKind, keys: ModifierKeys, points: &[Vec2]) -> Option<String> {
        let pen = |at: Vec2| PenSample { keys, ..PenSample::at(at) };
        let (document, tools) = (self.document.clone(), self.tools.clone());
        let context = ToolContext { layer: self.layer, ..ToolContext::new(&document, &tools) };
        let (gesture, first) = press(kind, &context, pen(points[0]));
        let mut last = first.apply_settings(&mut self.tools);
        if let Some(mut gesture) = gesture {
            points[1..].iter().for_each(|at| drop(gesture.drag(&[pen(*at)])));
            last = gesture.release().apply_settings(&mut self.tools);
        }
        let Outcome::Commit { label, document, select } = last else { return None };
        self.document = document;
        self.layer = select.or(self.layer);
        Some(label)
    }

    fn click(&mut self, keys: ModifierKeys, at: Vec2) -> Option<String> {
        self.drag(ToolKind::Path, keys, &[at])
    }

    fn path(&self) -> LivePath {
        let layer = self.document.layer(self.layer.unwrap()).unwrap();
        LivePath::clone(of_layer(layer).unwrap().source.path().unwrap())
    }

    fn nodes(&self) -> Vec<Vec2> {
        self.path().subpaths().iter().flat_map(|line| line.nodes.iter().map(|n| n.at)).collect()
    }
}

#[test]
fn a_drag_draws_a_figure_and_its_handles_change_it() {
    let mut hand = Hand::new();
    hand.tools.path.figure.kind = FigureKind::Star;
    let figure = ToolKind::Figure;
    let drawn = hand.drag(figure, NONE, &[vec2(20.0, 20.0), vec2(60.0, 50.0)]);
    assert_eq!((drawn.as_deref(), hand.document.layers.len()), (Some("Star"), 1));
    assert_eq!(hand.document.layers[0].name, "Star");
    let changed = hand.drag(figure, NONE, &[vec2(61.0, 51.0), vec2(90.0, 80.0)]);
    assert_eq!(changed.as_deref(), Some("Change figure"));
    let found = *hand.path().figure().unwrap();
    assert_eq!((found.from, found.to), (vec2(20.0, 20.0), vec2(90.0, 80.0)));
    hand.drag(figure, NONE, &[vec2(55.0, 50.0), vec2(65.0, 45.0)]);
    assert_eq!(hand.path().figure().unwrap().center(), vec2(65.0, 45.0));
    let turned = hand.drag(figure, CTRL, &[vec2(30.0, 15.0), vec2(20.0, 60.0)]);
    assert_eq!(turned.as_deref(), Some("Turn figure"));
    assert!(hand.path().figure().unwrap().rotation > 30.0, "{:?}", hand.path().figure());
    // Beside it another one begins; a click draws nothing.
    assert_eq!(hand.drag(figure, NONE, &[vec2(150.0, 120.0)]), None);
    hand.drag(figure, SHIFT, &[vec2(150.0, 110.0), vec2(160.0, 130.0)]);
    let square = *hand.path().figure().unwrap();
    assert_eq!(hand.document.layers.len(), 2);
    assert_eq!(square.to - square.from, vec2(20.0, 20.0));
}

#[test]
fn clicks_set_corners_drags_smooth_nodes_and_the_first_node_closes() {
    let mut hand = Hand::new();
    assert_eq!(hand.click(NONE, vec2(20.0, 20.0)).as_deref(), Some("Path"));
    assert_eq!(hand.click(NONE, vec2(80.0, 20.0)).as_deref(), Some("Add node"));
    hand.drag(ToolKind::Path, NONE, &[vec2(80.0, 80.0), vec2(60.0, 100.0)]);
    let line = hand.path().subpaths()[0].clone();
    assert_eq!((line.nodes.len(), line.closed), (3, false));
    assert_eq!((line.nodes[2].after, line.nodes[2].before), (vec2(-20.0, 20.0), vec2(20.0, -20.0)));
    assert_eq!(hand.click(NONE, vec2(21.0, 19.0)).as_deref(), Some("Close path"));
    assert!(hand.path().subpaths()[0].closed && hand.document.layers.len() == 1);
    // The next click begins another path.
    hand.click(NONE, vec2(150.0, 120.0));
    assert_eq!((hand.document.layers.len(), hand.nodes()), (2, vec![vec2(150.0, 120.0)]));
}

#[test]
fn nodes_are_moved_added_turned_and_deleted_later() {
    let mut hand = Hand::new();
    for at in [vec2(20.0, 20.0), vec2(120.0, 20.0), vec2(120.0, 90.0), vec2(20.0, 20.0)] {
        hand.click(NONE, at);
    }
    let moved = hand.drag(ToolKind::Path, NONE, &[vec2(120.0, 90.0), vec2(100.0, 100.0)]);
    assert_eq!(moved.as_deref(), Some("Move node"));
    assert_eq!(hand.nodes()[2], vec2(100.0, 100.0));
    assert_eq!(hand.click(NONE, vec2(70.0, 22.0)).as_deref(), Some("Add node"));
    assert_eq!(hand.nodes().len(), 4);
    assert!(hand.nodes()[1].distance(vec2(70.0, 20.0)) < 1.0, "{:?}", hand.nodes());
    assert_eq!(hand.click(CTRL, vec2(120.0, 20.0)).as_deref(), Some("Turn node"));
    let node = hand.path().subpaths()[0].nodes[2];
    assert!(node.is_smooth(), "{node:?}");
    // Its handle, broken off.
    let handle = node.at + node.after;
    hand.drag(ToolKind::Path, CTRL, &[handle, handle + vec2(0.0, 20.0)]);
    assert!(!hand.path().subpaths()[0].nodes[2].is_smooth());
    assert_eq!(hand.click(ALT, vec2(70.0, 20.0)).as_deref(), Some("Delete node"));
    assert_eq!(hand.nodes().len(), 3);
}

#[test]
fn shift_begins_another_line_of_the_same_path_and_an_end_is_continued() {
    let mut hand = Hand::new();
    hand.click(NONE, vec2(20.0, 20.0));
    hand.click(NONE, vec2(60.0, 20.0));
    hand.tools.path_node.line = None;
    hand.click(SHIFT, vec2(20.0, 80.0));
    hand.click(NONE, vec2(60.0, 80.0));
    assert_eq!((hand.document.layers.len(), hand.path().subpaths().len()), (1, 2));
    hand.tools.path_node.line = None;
    // The first node of the first line: it goes on from there.
    hand.click(NONE, vec2(20.0, 20.0));
    hand.click(NONE, vec2(10.0, 50.0));
    let first = hand.path().subpaths()[0].nodes.iter().map(|node| node.at).collect::<Vec<_>>();
    assert_eq!(first, [vec2(60.0, 20.0), vec2(20.0, 20.0), vec2(10.0, 50.0)]);
}

#[test]
fn a_step_back_takes_the_last_node_away_and_with_the_last_one_the_layer() {
    let mut hand = Hand::new();
    hand.click(NONE, vec2(20.0, 20.0));
    hand.click(NONE, vec2(60.0, 20.0));
    for left in [1, 0] {
        let context =
            ToolContext { layer: hand.layer, ..ToolContext::new(&hand.document, &hand.tools) };
        let (document, selected) = nodes::step_back(&context).unwrap();
        let count = document.layers.len();
        (hand.document, hand.tools.path_node) = (document, selected);
        assert_eq!(count, left);
        if left > 0 {
            assert_eq!(hand.nodes(), [vec2(20.0, 20.0)]);
        }
    }
}

#[test]
fn a_locked_path_says_so_and_one_beyond_all_limits_is_not_drawn() {
    let mut hand = Hand::new();
    let figure = ToolKind::Figure;
    hand.drag(figure, NONE, &[vec2(20.0, 20.0), vec2(60.0, 50.0)]);
    let id = hand.layer.unwrap();
    let far = hand.drag(figure, NONE, &[vec2(60.0, 50.0), vec2(9e5, 50.0)]);
    assert_eq!(far, None, "what cannot be drawn changes nothing");
    hand.document =
        hand.document.with_layer(id, |layer| layer.lock = crate::document::LayerLock::All).unwrap();
    let context =
        ToolContext { layer: hand.layer, ..ToolContext::new(&hand.document, &hand.tools) };
    let (_, outcome) = press(figure, &context, PenSample::at(vec2(20.0, 20.0)));
    assert!(matches!(outcome, Outcome::Refused(why) if why.contains("is locked")));
}

#[test]
fn a_line_has_an_outline_even_if_none_was_asked_for() {
    let settings = PathSettings::default();
    let colors = [Color::BLACK, Color::WHITE];
    let line = Figure { kind: FigureKind::Line, ..Figure::DEFAULT };
    let path = settings.path(line, colors);
    assert_eq!((path.fill, path.outline, path.outline_color), (None, LINE_PX, Color::BLACK));
    let both = PathSettings { outline: 2.0, ..settings }.path(Figure::DEFAULT, colors);
    assert_eq!((both.fill, both.outline_color), (Some(Color::BLACK), Color::WHITE));
}
