//! The layers of a comic's panels: groups whose frame is a path, made, divided and put in the order
//! in which they are read. Floor 5. Not here: the pen (`panels`).

use crate::document::{
    Content, Document, Group, Layer, LayerId, LayerLock, LayerMap, LayerSlot, Live, PixelLayer,
};
use crate::math::{PlaneMap, Vec2};
use crate::paint::path::{StraightCut, order_panels};
use crate::paint::{LivePath, PanelSettings, PathGeometry, PathJoin, PlacedImage, Subpath};
use crate::tools::path;
use std::sync::Arc;

/// The name of a panel before its number.
const PANEL: &str = "Panel";

/// The names of its layers, from below.
const PAPER: &str = "Paper";
const DRAWING: &str = "Drawing";
const FRAME: &str = "Frame";

/// A part of a panel that is smaller is none, px² of the frame's plane.
const LEAST_AREA: f32 = 4.0;

/// The share of a panel along a cut that a drag has to go over.
const CROSSED: f32 = 0.5;

/// A panel as it lies on the canvas.
pub struct Panel {
    /// The group.
    pub group: LayerId,
    /// The path in it that is its frame, the topmost one.
    pub frame: LayerId,
    /// The corners of its outline, of each of its lines.
    lines: Vec<Vec<Vec2>>,
    /// It and what it is in are seen, and it may be changed.
    pub is_open: bool,
}

/// The panels of a document, bottom first.
pub fn find_panels(document: &Document) -> Vec<Panel> {
    let mut found = Vec::new();
    visit(document, &document.layers, &LayerMap::none(document.size), true, &mut found);
    found
}

fn visit(
    document: &Document,
    layers: &[Arc<Layer>],
    around: &LayerMap,
    is_open: bool,
    found: &mut Vec<Panel>,
) {
    for layer in layers {
        let Some(group) = layer.content.group() else { continue };
        let map = around.within(layer);
        let is_open = is_open && layer.visible && layer.lock != LayerLock::All;
        visit(document, &group.layers, &map, is_open, found);
        let Some(frame) = group.frames().last().map(|place| &group.layers[place]) else { continue };
        let Some(image) = path::of_layer(frame) else { continue };
        let plane = map.within(frame).plane;
        let Some(lines) = lines_on_canvas(image, document, &plane) else { continue };
        let is_open = is_open && frame.lock != LayerLock::All;
        found.push(Panel { group: layer.id, frame: frame.id, lines, is_open });
    }
}

/// The corners of each line of a path, on the canvas; `None` for what is no path.
fn lines_on_canvas(
    image: &PlacedImage,
    document: &Document,
    plane: &PlaneMap,
) -> Option<Vec<Vec<Vec2>>> {
    let map = image.frame_from_path(document.size);
    let to_canvas = |point: Vec2| plane.to_canvas(map?.transform_point2(point));
    let lines = image.source.path()?.flatten(to_canvas);
    Some(lines.into_iter().map(|line| line.points).collect())
}

/// The corners of the box around some lines.
fn box_around(lines: &[Vec<Vec2>]) -> [Vec2; 2] {
    let points = || lines.iter().flatten();
    let low = points().fold(Vec2::INFINITY, |low, p| low.min(*p));
    let high = points().fold(Vec2::NEG_INFINITY, |high, p| high.max(*p));
    if low.is_finite() && high.is_finite() { [low, high] } else { [Vec2::ZERO; 2] }
}

impl Panel {
    /// Where a line crosses its outline, px from a point of the line.
    fn crossings(&self, from: Vec2, along: Vec2) -> Vec<f32> {
        let side = |p: Vec2| along.perp_dot(p - from);
        let mut found = Vec::new();
        for line in &self.lines {
            for (a, b) in line.iter().zip(line.iter().cycle().skip(1)) {
                let (before, after) = (side(*a), side(*b));
                if (before > 0.0) != (after > 0.0) {
                    let at = a.lerp(*b, before / (before - after));
                    found.push(along.dot(at - from));
                }
            }
        }
        found.sort_by(f32::total_cmp);
        found
    }

    /// Whether a point lies inside of it.
    pub fn has_inside(&self, p: Vec2) -> bool {
        let beyond = self.crossings(p, Vec2::X).into_iter().filter(|at| *at > 0.0).count();
        !beyond.is_multiple_of(2)
    }

    /// Whether a drag goes over enough of it to cut it.
    fn is_crossed(&self, from: Vec2, to: Vec2) -> bool {
        let Some(along) = (to - from).try_normalize() else { return false };
        let length = from.distance(to);
        let (mut whole, mut over) = (0.0, 0.0);
        for ends in self.crossings(from, along).chunks_exact(2) {
            whole += ends[1] - ends[0];
            over += (ends[1].min(length) - ends[0].max(0.0)).max(0.0);
        }
        over > 0.0 && over >= CROSSED * whole
    }
}

/// A panel of a shape, whose points are canvas points; `None` for one that no file could hold.
fn make_panel(document: &Document, shape: PathGeometry, settings: &PanelSettings) -> Option<Layer> {
    let path = LivePath {
        outline: settings.border,
        outline_color: settings.border_color,
        join: PathJoin::Miter,
        frames: true,
        ..LivePath::new(shape)
    };
    path.fits().ok()?;
    let frame = Content::Image(Live::new(PlacedImage::of_path(document.size, path)));
    let flat = |name: &str, content: Content| Layer {
        clip_to_surface: false,
        ..Layer::new(name, content)
    };
    let paper = settings.paper.then(|| flat(PAPER, Content::Fill(settings.paper_color)));
    let drawing = Layer::new(DRAWING, Content::Pixels(PixelLayer::default()));
    let layers = paper.into_iter().chain([drawing, flat(FRAME, frame)]).map(Arc::new).collect();
    let name = format!("{PANEL} {}", u32::MAX);
    Some(Layer::new(name, Content::Group(Group { layers, pass_through: false })))
}

/// The document with panels of some shapes, whose points are canvas points, the first one on top,
/// and the layer in that one to draw on. `None` where the place does not exist, or no file could hold
/// a shape.
pub fn with_panels(
    document: &Document,
    shapes: Vec<PathGeometry>,
    place: LayerSlot,
    settings: &PanelSettings,
) -> Option<(Document, LayerId)> {
    let (mut next, mut drawing, mut above) = (document.clone(), None, 0);
    for shape in shapes.into_iter().rev() {
        let panel = make_panel(document, shape, settings)?;
        let layers = &panel.content.group()?.layers;
        drawing = layers.iter().find(|layer| layer.name == DRAWING).map(|layer| layer.id);
        let index = place.index.saturating_add(above);
        next = next.with_inserted(panel, LayerSlot { index, ..place })?;
        above += 1;
    }
    Some((with_numbers(next, settings), drawing?))
}

/// The document with its panels cut along a drag, those that it goes over, and how many there were;
/// both parts of a panel get what it held.
pub fn with_cut(
    document: &Document,
    settings: &PanelSettings,
    [from, to]: [Vec2; 2],
) -> Option<(Document, usize)> {
    let sides = settings.cuts(from, to)?;
    let crossed = find_panels(document).into_iter().filter(|panel| panel.is_crossed(from, to));
    let (mut next, mut count) = (document.clone(), 0);
    for panel in crossed.filter(|panel| panel.is_open) {
        if let Some(cut) = with_panel_cut(&next, &panel, sides, settings) {
            (next, count) = (cut, count + 1);
        }
    }
    (count > 0).then(|| (with_numbers(next, settings), count))
}

/// The document with one panel cut; `None` where one side of it would be empty.
fn with_panel_cut(
    document: &Document,
    panel: &Panel,
    sides: [StraightCut; 2],
    settings: &PanelSettings,
) -> Option<Document> {
    let frame = document.layer(panel.frame)?;
    let image = path::of_layer(frame)?;
    let live = image.source.path()?;
    let map = document.map_of(panel.frame)?.plane;
    let to_frame = image.frame_from_path(document.size)?.inverse();
    let to_path = |p: Vec2| Some(to_frame.transform_point2(map.from_canvas(p)?.0));
    let lines = live.subpaths();
    let halves = sides.map(|side| -> Option<PlacedImage> {
        let half = side.mapped(to_path)?.left_of(&lines);
        let area: f32 = half.iter().map(Subpath::area_px).sum();
        let path = LivePath { geometry: PathGeometry::of_lines(half), ..LivePath::clone(live) };
        (area >= LEAST_AREA && path.fits().is_ok()).then_some(())?;
        image.with_path(document.size, path)
    });
    let [Some(a), Some(b)] = halves else { return None };
    // The one that is read first stays above, with the layers as they are.
    let bounds = |image: &PlacedImage| Some(box_around(&lines_on_canvas(image, document, &map)?));
    let boxes = [bounds(&a)?, bounds(&b)?];
    let is_first = order_panels(&boxes, settings.right_to_left)[0] == 0;
    let (first, second) = if is_first { (a, b) } else { (b, a) };
    let with_frame = |group: &mut Layer, image: PlacedImage| {
        let place = group.content.group()?.frames().last()?;
        let inner = group.content.group_mut()?.layers.get_mut(place)?;
        Arc::make_mut(inner).content = Content::Image(Live::new(image));
        Some(())
    };
    let mut copy = document.layer(panel.group)?.copy_with_fresh_ids();
    copy.name = format!("{PANEL} {}", u32::MAX);
    with_frame(&mut copy, second)?;
    let place = document.place_of(panel.group)?;
    let kept = document.with_layer(panel.frame, |layer| {
        layer.content = Content::Image(Live::new(first));
    })?;
    kept.with_inserted(copy, place)
}

/// The document with its numbered panels numbered as they are read.
fn with_numbers(document: Document, settings: &PanelSettings) -> Document {
    let is_numbered = |panel: &Panel| {
        let number = document.layer(panel.group).and_then(|layer| layer.name.strip_prefix(PANEL));
        number.is_some_and(|n| n.trim_start().parse::<u32>().is_ok())
    };
    let panels: Vec<Panel> = find_panels(&document).into_iter().filter(is_numbered).collect();
    let boxes: Vec<[Vec2; 2]> = panels.iter().map(|panel| box_around(&panel.lines)).collect();
    let order = order_panels(&boxes, settings.right_to_left);
    let mut next = document.clone();
    for (number, i) in order.into_iter().enumerate() {
        let (id, name) = (panels[i].group, format!("{PANEL} {}", number + 1));
        if next.layer(id).is_some_and(|layer| layer.name != name) {
            next = next.with_layer(id, |layer| layer.name = name).unwrap_or(next);
        }
    }
    next
}

/// Where a new panel is put: above all that the selected layer is in.
pub fn slot_for_panel(document: &Document, layer: Option<LayerId>) -> LayerSlot {
    let highest = document.layers_below_top_ink();
    let holds = |outer: &Arc<Layer>, id: LayerId| outer.id == id || has_layer_within(outer, id);
    let outermost = layer.and_then(|id| document.layers.iter().position(|outer| holds(outer, id)));
    LayerSlot::top_level(outermost.map_or(highest, |place| (place + 1).min(highest)))
}

fn has_layer_within(layer: &Layer, id: LayerId) -> bool {
    let group = layer.content.group();
    group.is_some_and(|group| {
        group.layers.iter().any(|inner| inner.id == id || has_layer_within(inner, id))
    })
}
