//! Actions on the layer tree and its layers. Floor 6. The edits themselves are in `document::edit`.

use crate::document::{
    Content, DetailSource, Document, Group, Layer, LayerId, LayerMask, LayerSlot, Live, MaskKind, NormalLayer,
    PixelLayer, Progress, StrokeList,
};
use crate::math::vec2;
use crate::paint::{Gradient, GradientStop, ImageFilter, Placement};
use crate::raster::{Outside, Plane};
use crate::session::open_document::Edit;
use crate::session::replay::{actions, names};
use crate::session::{LayerPath, OpenDocument, Property, Session};
use crate::shading::{Model, RadianceScaling, Shading};
use crate::surface::NoiseRelief;
use crate::tools::brush::free_name;
use crate::tools::transform;
use std::sync::Arc;

/// Kinds of new layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NewLayer {
    Paint,
    Strokes,
    Fill,
    Gradient,
    Shading,
    RadianceScaling,
    Normals,
    Group,
}

names!(NewLayer, [
    NewLayer::Paint => "paint", NewLayer::Strokes => "strokes", NewLayer::Fill => "fill",
    NewLayer::Gradient => "gradient", NewLayer::Shading => "shading",
    NewLayer::RadianceScaling => "radiance scaling", NewLayer::Normals => "normals", NewLayer::Group => "group",
]);

impl NewLayer {
    /// Every kind with its name in replays.
    pub const ALL: [(NewLayer, &'static str); 8] = [
        (NewLayer::Paint, "Paint layer"),
        (NewLayer::Strokes, "Stroke layer"),
        (NewLayer::Fill, "Fill layer"),
        (NewLayer::Gradient, "Gradient layer"),
        (NewLayer::Shading, "Shading layer"),
        (NewLayer::RadianceScaling, "Radiance scaling"),
        (NewLayer::Normals, "Detail normals"),
        (NewLayer::Group, "Group"),
    ];
}

actions! {
    /// `layer` is always the path before the action.
    LayerAction {
        "select" Select { layer: LayerPath }
        /// Above the selected layer; into it, if it is a group.
        "add" Add { kind: NewLayer }
        "delete" Delete { layer: LayerPath }
        "duplicate" Duplicate { layer: LayerPath }
        /// Into a group (or, without one, the document) so that so many layers lie beneath it, not counting itself.
        "move" Move { layer: LayerPath, group: Option<LayerPath>, index: usize }
        /// One place up (positive) or down among its siblings.
        "nudge" Nudge { layer: LayerPath, by: i32 }
        "merge down" MergeDown { layer: LayerPath }
        /// Everything visible becomes one paint layer.
        "flatten" Flatten {}
        /// A live layer becomes paint.
        "bake" Bake { layer: LayerPath }
        /// A shading layer of a model, with the material it begins with.
        "add shading" AddShading { model: Model }
        /// Adds a paintable mask that shows all of the layer, or hides it; an existing mask becomes paintable.
        "paint mask" PaintMask { layer: LayerPath, hides: bool }
        /// Selects whether the brush paints on the mask or on the layer.
        "on mask" OnMask { layer: LayerPath, on: bool }
        /// The layer's transform is applied for good: its frame becomes the canvas.
        "apply transform" ApplyTransform { layer: LayerPath }
        /// Mirrored about the middle of what it holds: left and right, or up and down.
        "mirror" Mirror { layer: LayerPath, upright: bool }
        /// Turned about the middle of what it holds, counter-clockwise.
        "turn" Turn { layer: LayerPath, degrees: f32 }
        /// Into a group of its own.
        "group" Group { layer: LayerPath }
        "ungroup" Ungroup { layer: LayerPath }
        /// Shown alone, or no longer.
        "solo" Solo { layer: LayerPath }
        /// A property; shown only, until it is `done`.
        "set" Set { layer: LayerPath, to: Property, done: bool }
        /// The strokes or pixels are taken out of a layer, or what is selected of them.
        "clear" Clear { layer: LayerPath }
    }
}

impl LayerAction {
    pub fn apply(&self, session: &mut Session) {
        let gradient_settings = Gradient {
            from: vec2(0.0, 0.0),
            to: vec2(1.0, 1.0),
            stops: vec![
                GradientStop { t: 0.0, color: session.color },
                GradientStop { t: 1.0, color: session.second_color },
            ],
            operator: session.operator,
            filter: ImageFilter::Antialias,
            frame: Default::default(),
        };
        session.drop_gesture();
        let Some(tab) = session.active_mut() else { return };
        if let LayerAction::Set { layer, to, done } = self {
            return set(tab, layer, to, *done);
        }
        tab.forget_preview();
        let id = |path: &LayerPath| path.find(tab.document()).map(|layer| layer.id);
        match self {
            LayerAction::Select { layer } => {
                tab.selected = id(layer).or(tab.selected);
                tab.on_mask = false;
            }
            LayerAction::OnMask { layer, on } => {
                tab.selected = id(layer).or(tab.selected);
                tab.on_mask = *on;
                // Only if there is one to paint on.
                tab.repair();
            }
            LayerAction::Solo { layer } => {
                let id = id(layer);
                tab.solo = if tab.solo == id { None } else { id };
            }
            _ => {
                if let Some(edit) = self.edit(tab, &gradient_settings) {
                    tab.take(edit);
                    tab.on_mask = matches!(self, LayerAction::PaintMask { .. });
                }
            }
        }
    }
    /// Does an edit that needs no settings on an open document.
    pub(super) fn step_on(&self, tab: &mut OpenDocument) {
        let settings = Gradient {
            from: vec2(0.0, 0.0),
            to: vec2(1.0, 1.0),
            stops: Vec::new(),
            frame: Default::default(),
            operator: Default::default(),
            filter: ImageFilter::Antialias,
        };
        if let Some(edit) = self.edit(tab, &settings) {
            tab.take(edit);
        }
    }
    /// The step: its name, the resulting document, and the new selection.
    fn edit(&self, tab: &OpenDocument, gradient_settings: &Gradient) -> Option<Edit> {
        let document = tab.document();
        let layer = |path: &LayerPath| path.find(document).cloned();
        let (label, document, select) = match self {
            LayerAction::Add { kind } => {
                let new = selecting(document, made(*kind, document, gradient_settings));
                let id = new.id;
                ("Add layer", document.with_inserted(new, above(tab))?, Some(id))
            }
            LayerAction::AddShading { model } => {
                let content = Content::Shading(Live::new(Shading::new(*model)));
                let new = selecting(document, Layer::new(free_name(document, &model_name(*model)), content));
                let id = new.id;
                ("Add layer", document.with_inserted(new, above(tab))?, Some(id))
            }
            LayerAction::PaintMask { layer: path, hides } => {
                let layer = layer(path)?;
                let mask = match &layer.mask {
                    Some(mask) => mask.as_picture(&layer, &document.scene()),
                    None => {
                        let coverage = Plane::filled(document.size, if *hides { 0 } else { 255 });
                        LayerMask::new(MaskKind::File { file: String::new(), coverage: Arc::new(coverage) })
                    }
                };
                let id = layer.id;
                ("Layer mask", document.with_layer(id, |layer| layer.mask = Some(mask))?, Some(id))
            }
            LayerAction::Delete { layer: path } => {
                let layer = layer(path)?;
                let place = document.place_of(layer.id)?;
                let next = document.without_layer(layer.id)?;
                let neighbour = sibling(&next, LayerSlot { index: place.index.saturating_sub(1), ..place });
                ("Delete layer", next, neighbour)
            }
            LayerAction::Duplicate { layer: path } => {
                let layer = layer(path)?;
                let place = document.place_of(layer.id)?;
                let copy = copied(&layer, &free_name(document, &format!("{} copy", layer.name)));
                let id = copy.id;
                let next = document.with_inserted(copy, LayerSlot { index: place.index + 1, ..place })?;
                ("Duplicate layer", next, Some(id))
            }
            LayerAction::Move { layer: path, group, index } => {
                let group = group.as_ref().map(|path| layer(path).map(|layer| layer.id).ok_or(())).transpose().ok()?;
                let id = layer(path)?.id;
                ("Move layer", document.with_moved(id, LayerSlot { group, index: *index })?, Some(id))
            }
            LayerAction::Nudge { layer: path, by } => {
                let id = layer(path)?.id;
                let place = document.place_of(id)?;
                let index = place.index.saturating_add_signed(*by as isize);
                ("Move layer", document.with_moved(id, LayerSlot { index, ..place })?, Some(id))
            }
            LayerAction::Mirror { layer: path, upright } => {
                let mirror = transform::mirror(*upright);
                ("Mirror layer", transform::about_middle(document, layer(path)?.id, mirror)?, None)
            }
            LayerAction::Turn { layer: path, degrees } => {
                let turn = transform::turn(f64::from(*degrees))?;
                ("Turn layer", transform::about_middle(document, layer(path)?.id, turn)?, None)
            }
            LayerAction::ApplyTransform { layer: path } => {
                ("Apply transform", document.with_transform_applied(layer(path)?.id)?, None)
            }
            LayerAction::MergeDown { .. } | LayerAction::Flatten {} | LayerAction::Bake { .. } => {
                return self.flattened(document, &Progress::default());
            }
            LayerAction::Group { layer: path } => {
                let layer = layer(path)?;
                let place = document.place_of(layer.id)?;
                let group = Group { layers: vec![layer.clone()], pass_through: false };
                let group = Layer::new(free_name(document, "Group"), Content::Group(group));
                let id = group.id;
                ("Group layer", document.without_layer(layer.id)?.with_inserted(group, place)?, Some(id))
            }
            LayerAction::Ungroup { layer: path } => {
                let document = &document.with_transform_applied(layer(path)?.id)?;
                let layer = path.find(document)?.clone();
                let group = layer.content.group()?;
                let place = document.place_of(layer.id)?;
                let mut next = document.without_layer(layer.id)?;
                for (i, inner) in group.layers.iter().enumerate() {
                    next = next.with_inserted(Layer::clone(inner), LayerSlot { index: place.index + i, ..place })?;
                }
                ("Ungroup", next, group.layers.last().map(|layer| layer.id))
            }
            LayerAction::Clear { layer: path } => {
                let layer = layer(path)?;
                match document.selected() {
                    Some(selected) => ("Clear", document.with_cleared(layer.id, selected)?, None),
                    None => {
                        let empty = layer.content.emptied()?;
                        ("Clear layer", document.with_layer(layer.id, |layer| layer.content = empty)?, None)
                    }
                }
            }
            LayerAction::Select { .. }
            | LayerAction::Solo { .. }
            | LayerAction::OnMask { .. }
            | LayerAction::Set { .. } => return None,
        };
        Some(Edit { label, document, select })
    }
}

/// A new layer that covers the canvas covers what is selected, by a mask.
fn selecting(document: &Document, layer: Layer) -> Layer {
    let covers =
        !matches!(layer.content, Content::Pixels(_) | Content::Strokes(_) | Content::Group(_) | Content::Normals(_));
    Layer { mask: if covers { document.selection_as_mask() } else { None }, ..layer }
}

fn set(tab: &mut OpenDocument, layer: &LayerPath, to: &Property, done: bool) {
    let Some(id) = layer.find(tab.document()).map(|layer| layer.id) else { return tab.forget_preview() };
    let Some(document) = tab.document().with_layer(id, |layer| to.apply(layer)) else { return };
    if done {
        tab.commit(to.label(), document);
    } else {
        tab.show(to.label(), document);
    }
}

/// Where a new layer goes: above the selected one; into it, on top, if it is a group.
pub fn above(tab: &OpenDocument) -> LayerSlot {
    let document = tab.document();
    let Some(layer) = tab.selected.and_then(|id| document.layer(id)) else { return LayerSlot::top_level(usize::MAX) };
    if layer.content.group().is_some() {
        return LayerSlot::in_group(layer.id, usize::MAX);
    }
    let place = document.place_of(layer.id).unwrap_or(LayerSlot::top_level(usize::MAX));
    LayerSlot { index: place.index.saturating_add(1), ..place }
}

/// The layer at a place, or the group it is in.
pub(super) fn sibling(document: &Document, place: LayerSlot) -> Option<LayerId> {
    let layers = match place.group {
        None => &document.layers,
        Some(group) => &document.layer(group)?.content.group()?.layers,
    };
    layers.get(place.index).map(|layer| layer.id).or(place.group)
}

/// “ambient-occlusion” as a layer is called.
fn model_name(model: Model) -> String {
    let spaced = model.name().replace('-', " ");
    let mut letters = spaced.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn made(kind: NewLayer, document: &Document, gradient_settings: &Gradient) -> Layer {
    let size = document.size;
    let (name, content) = match kind {
        NewLayer::Paint => ("Paint", Content::Pixels(PixelLayer::default())),
        NewLayer::Strokes => ("Strokes", Content::Strokes(Live::new(StrokeList::default()))),
        NewLayer::Fill => (
            "Fill",
            Content::Fill(gradient_settings.stops.first().map_or(crate::math::srgb::Color::BLACK, |stop| stop.color)),
        ),
        NewLayer::Gradient => {
            let middle = size.center();
            let reach = vec2(0.0, 0.35 * size.height as f32);
            let gradient = Gradient { from: middle - reach, to: middle + reach, ..gradient_settings.clone() };
            ("Gradient", Content::Gradient(Live::new(gradient)))
        }
        NewLayer::Shading => ("Shading", Content::Shading(Live::new(Shading::new(Model::Phong)))),
        NewLayer::RadianceScaling => ("Radiance scaling", Content::RadianceScaling(RadianceScaling::default())),
        NewLayer::Normals => {
            let normals = NormalLayer {
                source: DetailSource::Grain(NoiseRelief::default()),
                placement: Placement { center: size.center(), scale: 1.0, rotation: 0.0 },
                outside: Outside::Repeat,
                strength: 0.5,
                frame: Default::default(),
            };
            ("Detail normals", Content::Normals(normals))
        }
        NewLayer::Group => ("Group", Content::Group(Group::default())),
    };
    Layer::new(free_name(document, name), content)
}

/// A copy under fresh ids.
pub(super) fn copied(layer: &Layer, name: &str) -> Layer {
    let mut copy = Layer { id: LayerId::fresh(), name: name.into(), ..layer.clone() };
    if let Some(group) = copy.content.group_mut() {
        group.layers = group.layers.iter().map(|inner| Arc::new(copied(inner, &inner.name))).collect();
    }
    copy
}
