//! Layers of paths: how new ones look, the path that the pen changes, and what of it is selected.
//! Floor 5.

pub mod along;
pub mod figures;
pub mod nodes;

use super::{GRAB_PT, ToolContext, closed};
use crate::document::{Content, Document, Layer, LayerId, LayerSlot, Live};
use crate::math::range::clamp_to_range;
use crate::math::{Size, Vec2, srgb::Color};
use crate::paint::path::PathPlace;
use crate::paint::{Figure, FigureKind, LivePath, PathCap, PathGeometry, PathJoin, PlacedImage};

/// The width of a line that would be seen by nothing else, px.
const LINE_PX: f32 = 4.0;

/// Letters of a layer's name that a refusal shows.
const SHOWN_LETTERS: usize = 60;

/// What new paths are like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathSettings {
    /// The kind of new figures, and its numbers.
    pub figure: Figure,
    /// They are filled with the first color.
    pub fills: bool,
    /// The width of their outline, px; 0: none. In the second color if they are filled, else in the
    /// first one.
    pub outline: f32,
    /// How outlines end.
    pub cap: PathCap,
    /// How outlines turn at corners.
    pub join: PathJoin,
}

/// What of a path the path tool has selected.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SelectedNode {
    /// The layer of the path.
    pub layer: Option<LayerId>,
    /// The line that clicks continue.
    pub line: Option<usize>,
    /// The node whose handles are shown.
    pub node: Option<PathPlace>,
}

impl Default for PathSettings {
    fn default() -> Self {
        Self {
            figure: Figure::DEFAULT,
            fills: true,
            outline: 0.0,
            cap: PathCap::Round,
            join: PathJoin::Miter,
        }
    }
}

impl PathSettings {
    /// The nearest settings that paths can have.
    pub fn clamp_to_ranges(self) -> Self {
        let mut figure = Figure { from: Vec2::ZERO, to: Vec2::ZERO, ..self.figure };
        for setting in Figure::SETTINGS {
            setting.put(&mut figure, (setting.get)(&self.figure));
        }
        Self { figure, outline: clamp_to_range(self.outline, &LivePath::OUTLINE), ..self }
    }

    /// A new path in the user's two colors. A line has an outline, or nothing of it would be seen.
    pub fn path(&self, geometry: impl Into<PathGeometry>, [first, second]: [Color; 2]) -> LivePath {
        let geometry = geometry.into();
        let is_line =
            matches!(&geometry, PathGeometry::Figure(figure) if figure.kind == FigureKind::Line);
        let fills = self.fills && !is_line;
        let needs_line = !fills && self.outline <= 0.0;
        LivePath {
            fill: fills.then_some(first),
            outline: if needs_line { LINE_PX } else { self.outline },
            outline_color: if fills { second } else { first },
            cap: self.cap,
            join: self.join,
            ..LivePath::new(geometry)
        }
    }
}

impl SelectedNode {
    /// The same as far as it is there in a path: an undo may have taken its node away.
    pub fn within(self, layer: LayerId, path: &LivePath) -> Self {
        if self.layer != Some(layer) {
            return Self { layer: Some(layer), ..Self::default() };
        }
        let lines = path.subpaths();
        let is_open = |line: &usize| lines.get(*line).is_some_and(|line| !line.closed);
        let is_there = |place: &PathPlace| path.node(*place).is_some();
        Self { line: self.line.filter(is_open), node: self.node.filter(is_there), ..self }
    }
}

/// A layer of a path whose points are canvas points.
pub fn make_layer(document: &Document, path: LivePath) -> Layer {
    let name = document.free_layer_name(path.label());
    let image = PlacedImage::of_path(document.size, path);
    Layer { clip_to_surface: false, ..Layer::new(name, Content::Image(Live::new(image))) }
}

/// The document with another path in the layers of paths among some; `None` where none is. A layer
/// that is named after its figure is named after the new one. A path that no file could hold is
/// refused before it is drawn.
pub fn replace_paths(
    document: &Document,
    ids: &[LayerId],
    path: &LivePath,
) -> Result<Option<Document>, String> {
    let is_path = |id: &LayerId| document.layer(*id).is_some_and(|layer| of_layer(layer).is_some());
    let ids: Vec<LayerId> = ids.iter().copied().filter(is_path).collect();
    let Some(first) = ids.first().and_then(|id| document.layer(*id)) else { return Ok(None) };
    if let Err(why) = path.fits() {
        let name: String = first.name.chars().take(SHOWN_LETTERS).collect();
        return Err(format!("“{name}”: {why}. Nothing was changed."));
    }
    Ok(document.with_layers(&ids, |layer| {
        let Some(image) = of_layer(layer) else { return };
        let (was, label) = (image.source.path().map(|path| path.label()), path.label());
        let Some(next) = image.with_path(document.size, path.clone()) else { return };
        layer.content = Content::Image(Live::new(next));
        if was.is_some_and(|was| was != label && layer.name == was) {
            layer.name = document.free_layer_name(label);
        }
    }))
}

/// The image of a layer that is a path.
pub fn of_layer(layer: &Layer) -> Option<&PlacedImage> {
    match &layer.content {
        Content::Image(live) => live.params().source.path().map(|_| live.params()),
        _ => None,
    }
}

/// The path that the pen changes, of a layer that is there or a new one.
struct HeldPath {
    /// Before the gesture.
    document: Document,
    path: LivePath,
    layer: PathTarget,
}

enum PathTarget {
    New(Box<Layer>, LayerSlot),
    Old(LayerId, Box<PlacedImage>),
}

impl HeldPath {
    /// The path of the selected layer; refused if that is locked.
    fn of_selected(context: &ToolContext) -> Result<Option<Self>, String> {
        let Some(layer) = context.layer.and_then(|id| context.document.layer(id)) else {
            return Ok(None);
        };
        let Some(image) = of_layer(layer) else { return Ok(None) };
        if let Some(why) = closed::why_locked(layer) {
            return Err(why);
        }
        let Some(path) = image.source.path() else { return Ok(None) };
        let (path, layer) =
            (LivePath::clone(path), PathTarget::Old(layer.id, Box::new(image.clone())));
        Ok(Some(Self { document: context.document.clone(), path, layer }))
    }

    /// A new path above the selected layer.
    fn new(context: &ToolContext, path: LivePath) -> Self {
        let place = context.layer.and_then(|id| context.document.place_of(id));
        let place = place
            .map_or(LayerSlot::top_level(usize::MAX), |p| LayerSlot { index: p.index + 1, ..p });
        let document = context.document.clone();
        let layer = PathTarget::New(Box::new(make_layer(&document, path.clone())), place);
        Self { document, path, layer }
    }

    fn id(&self) -> LayerId {
        match &self.layer {
            PathTarget::New(layer, _) => layer.id,
            PathTarget::Old(id, _) => *id,
        }
    }

    /// The document with another path; `None` for one that no file can hold.
    fn with(&self, path: &LivePath) -> Option<Document> {
        path.fits().ok()?;
        match &self.layer {
            PathTarget::Old(id, _) => replace_paths(&self.document, &[*id], path).ok()?,
            PathTarget::New(layer, place) => {
                let image = PlacedImage::of_path(self.document.size, path.clone());
                let content = Content::Image(Live::new(image));
                self.document.with_inserted(Layer { content, ..Layer::clone(layer) }, *place)
            }
        }
    }

    /// A point of the canvas in the path's plane.
    fn to_path(&self, at: Vec2) -> Vec2 {
        match &self.layer {
            PathTarget::New(..) => at,
            PathTarget::Old(_, image) => {
                image.path_from_canvas(self.document.size, at).unwrap_or(at)
            }
        }
    }

    /// How near counts as touching, px of the path's plane.
    fn reach(&self, at: Vec2, px_per_pt: f32) -> f32 {
        let grab = GRAB_PT * px_per_pt;
        self.to_path(at + Vec2::X * grab).distance(self.to_path(at))
    }
}

/// The points of a path's plane on the canvas, for what is drawn over it.
pub fn to_canvas(image: &PlacedImage, canvas: Size) -> impl Fn(Vec2) -> Option<Vec2> {
    let map = image.frame_from_path(canvas);
    let frame = image.frame;
    move |point| frame.to_canvas(map?.transform_point2(point))
}

#[cfg(test)]
mod tests;
