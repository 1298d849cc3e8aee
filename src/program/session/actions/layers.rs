//! Actions on the layer tree and its layers. Floor 6. Not here: the edits themselves
//! (`document::edit`, `document::several`), new layers (`new`).

mod flattening;
mod looks;
mod new;
mod previewed;
mod refusal;
mod steps;
pub(super) mod texts;

pub use new::NewLayer;
pub(super) use steps::copy_layer;

use crate::document::{Content, Document, Layer, LayerId, LayerSlot, Live, Progress};
use crate::io::Budget;
use crate::math::{PlaneMap, Vec2};
use crate::paint::{ColorAdjustment, EffectLight, FormDrawing, PictureFilter, Text};
use crate::session::drawing::colors_beneath;
use crate::session::open_document::Edit;
use crate::session::replay::actions;
use crate::session::{LayerPath, LayerPaths, OpenDocument, Property, Session};
use crate::shading::{Model, PixelShading};
use crate::tools::transform;
use flattening::bake_displacement;
use new::{NewLayerSettings, lit_layer, make_layer, selecting};
use steps::{
    EditStep, attach, clear_layers, delete, duplicate, group, moves, paint_mask,
    selection_after_move, ungroup,
};

actions! {
    /// `layer` is always the path before the action; if several are possible, the layers of a group
    /// among them follow it.
    LayerAction {
        "select" Select { layer: LayerPath }
        /// These are selected, the active one too; `anchor`: where a range begins that is extended
        /// later.
        "choose" Choose { layer: LayerPaths, active_layer: LayerPath, anchor: Option<LayerPath> }
        /// Above the selected layer; into it, if it is a group.
        "add" Add { kind: NewLayer }
        "delete" Delete { layer: LayerPaths }
        /// Copies of several go together above the topmost of them.
        "duplicate" Duplicate { layer: LayerPaths }
        /// Into a group (or, without one, the document) so that so many layers lie beneath, not
        /// counting themselves.
        "move" Move { layer: LayerPaths, group: Option<LayerPath>, index: usize }
        /// One place up (positive) or down among its siblings.
        "nudge" Nudge { layer: LayerPaths, by: i32 }
        /// One layer with the one beneath it; several with each other.
        "merge down" MergeDown { layer: LayerPaths }
        /// Makes one paint layer of everything visible.
        "flatten" Flatten {}
        /// A live layer becomes paint.
        "bake" Bake { layer: LayerPaths }
        /// The strokes of a drawing by the form become a stroke layer.
        "make strokes" MakeStrokes { layer: LayerPath }
        /// Hatching follows the strokes of a stroke layer above it, which is added or chosen.
        "draw guides" DrawGuides { layer: LayerPath }
        /// A drawing by the form gets the brush and the color in hand.
        "draw with" DrawWith { layer: LayerPath }
        /// A shading layer of a model, with the material it begins with.
        "add shading" AddShading { model: Model }
        /// A text as a layer of its own; its first baseline begins at a point.
        "write" Write { text: Text, at: Vec2 }
        /// A look that comes with the program, by its key, on top of all layers.
        "look" Look { name: String }
        /// A material that comes with the program, by its key, on a part by its id, on what is selected
        /// or on the whole surface; shown only, until it is `done`.
        "material" Material { name: String, part: Option<String>, done: bool }
        /// A ball that comes with the program, by its key, for a layer of lit spheres.
        "painted ball" PaintedBall { layer: LayerPath, name: String, hollows: bool }
        /// Opens a ball of a layer of lit spheres as a document of its own.
        "paint ball" PaintBall { layer: LayerPath, hollows: bool }
        /// A painter's light lights in tones of the colors of the picture beneath it.
        "pixel colors" PixelColors { layer: LayerPath }
        /// A layer that adjusts the colors beneath it.
        "add adjustment" AddAdjustment { adjustment: ColorAdjustment }
        /// The light of all effects without one of their own.
        "effect light" EffectLight { light: EffectLight, done: bool }
        /// The paint of layers is adjusted for good, within the selection; shown only, until it is
        /// `done`.
        "adjust" Adjust { layer: LayerPaths, adjustment: ColorAdjustment, done: bool }
        /// A layer that filters what lies beneath it.
        "add filter" AddFilter { filter: PictureFilter }
        /// The paint of layers is filtered for good, within the selection; shown only, until it is
        /// `done`.
        "filter" Filter { layer: LayerPaths, filter: PictureFilter, done: bool }
        /// Forgets what is only shown; what was typed is kept.
        "unadjust" Unadjust {}
        /// Adds a paintable mask that shows all of the layer, or hides it; an existing mask becomes
        /// paintable.
        "paint mask" PaintMask { layer: LayerPath, hides: bool }
        /// Selects whether the brush paints on the mask or on the layer.
        "on mask" OnMask { layer: LayerPath, on: bool }
        /// The layer's transform is applied for good: its frame becomes the canvas.
        "apply transform" ApplyTransform { layer: LayerPaths }
        /// A grid of points over what the layer shows, which the transform tool drags; an existing
        /// one gets new points.
        "mesh" Mesh { layer: LayerPaths, columns: usize, rows: usize }
        /// Mirrored about the middle of what they hold: left and right, or up and down.
        "mirror" Mirror { layer: LayerPaths, upright: bool }
        /// Turned about the middle of what they hold, counter-clockwise.
        "turn" Turn { layer: LayerPaths, degrees: f32 }
        /// What they show is moved by a map of the canvas (a, b, c, d, e, f); shown only, until it
        /// is `done`.
        "take along" TakeAlong { layer: LayerPaths, by: [f64; 6], done: bool }
        /// The gizmo of the selected layers is turned about this point, by shares of its sides.
        "pivot" Pivot { at: Vec2 }
        /// Into a group of their own, in the place of the topmost.
        "group" Group { layer: LayerPaths }
        "ungroup" Ungroup { layer: LayerPaths }
        /// Shown alone, or with the others again.
        "solo" Solo { layer: LayerPath }
        /// A property; shown only, until it is `done`.
        "set" Set { layer: LayerPaths, to: Property, done: bool }
        /// On a part of the shape by its id, on `canvas`, or on what is around it; it shows where
        /// it showed.
        "home" Attach { layer: LayerPaths, part: Option<String> }
        /// The strokes or pixels of a layer are removed, or the selected ones.
        "clear" Clear { layer: LayerPaths }
    }
}

impl LayerAction {
    /// The action that chooses some layers, the active one last; `None` if there are none.
    pub fn select_layers(
        document: &Document,
        ids: &[LayerId],
        anchor: Option<LayerId>,
    ) -> Option<Self> {
        let active_layer = LayerPath::of(document, *ids.last()?)?;
        if ids.len() == 1 {
            return Some(LayerAction::Select { layer: active_layer });
        }
        let anchor = anchor.and_then(|id| LayerPath::of(document, id));
        Some(LayerAction::Choose { layer: LayerPaths::of(document, ids), active_layer, anchor })
    }

    /// Whether it adds a layer that is made of its settings, which are what is set next.
    pub fn is_adding_settings(&self) -> bool {
        match self {
            // A fill has the color in hand.
            LayerAction::Add { kind } => !matches!(
                kind,
                NewLayer::Paint | NewLayer::Strokes | NewLayer::Fill | NewLayer::Group
            ),
            LayerAction::AddShading { .. }
            | LayerAction::AddAdjustment { .. }
            | LayerAction::AddFilter { .. } => true,
            _ => false,
        }
    }

    /// Performs it.
    pub fn apply(&self, session: &mut Session) {
        let settings = NewLayerSettings::of(&session.tools);
        session.drop_gesture();
        if let LayerAction::PaintBall { layer, hollows } = self {
            return self.paint_ball(session, layer, *hollows);
        }
        if let LayerAction::DrawWith { layer } = self {
            return self.draw_with(session, layer);
        }
        let target = session.tools.transform.target;
        let Some(open) = session.active_mut() else { return };
        if let LayerAction::Set { layer, to, done } = self {
            if let Some(why) = self.refusal(open.document()) {
                open.forget_preview();
                return session.say(why);
            }
            let is_set = previewed::set(open, layer, to, *done);
            return session.said.extend(is_set.err());
        }
        if let LayerAction::Write { text, at } = self {
            open.forget_preview();
            let written = texts::write(open, text, *at);
            return session.said.extend(written.err().map(|why| why.to_string()));
        }
        if let LayerAction::Material { name, part, done } = self {
            if let Some(why) = self.refusal(open.document()) {
                open.forget_preview();
                return session.say(why);
            }
            return looks::give_material(open, name, part.as_deref(), *done);
        }
        if let LayerAction::EffectLight { light, done } = self {
            return previewed::light_effects(open, *light, *done);
        }
        if let LayerAction::Adjust { layer, adjustment, done } = self {
            return previewed::adjust(session, layer, adjustment, *done);
        }
        if let LayerAction::Filter { layer, filter, done } = self {
            return previewed::filter_paint(session, layer, filter, *done);
        }
        if let LayerAction::TakeAlong { layer, by, done } = self {
            return previewed::take_along(session, layer, *by, *done);
        }
        open.forget_preview();
        let id = |path: &LayerPath| path.find(open.document()).map(|layer| layer.id);
        match self {
            LayerAction::Select { layer } => {
                open.select_layers(id(layer).into_iter().collect());
                open.on_mask = false;
            }
            LayerAction::Choose { layer, active_layer, anchor } => {
                let (Some(mut ids), Some(active_layer)) =
                    (layer.find(open.document()), id(active_layer))
                else {
                    return;
                };
                ids.retain(|id| *id != active_layer);
                ids.push(active_layer);
                open.select_range(ids, anchor.as_ref().and_then(id));
                open.on_mask = false;
            }
            LayerAction::OnMask { layer, on } => {
                open.select_layers(id(layer).into_iter().collect());
                open.on_mask = *on;
                // Only if there is one to paint on.
                open.repair();
            }
            LayerAction::Pivot { at } => open.set_pivot(target, *at),
            LayerAction::Unadjust {}
            | LayerAction::PaintBall { .. }
            | LayerAction::DrawWith { .. }
            | LayerAction::Write { .. } => {}
            LayerAction::Solo { layer } => {
                let id = id(layer);
                open.solo = if open.solo == id { None } else { id };
            }
            _ => {
                let no_room = || self.no_room(open.document(), &Budget::of_this_machine());
                let refusal = self.refusal(open.document()).map(str::to_owned).or_else(no_room);
                let edit = if refusal.is_none() { self.edit(open, &settings) } else { None };
                match edit {
                    Some(edit) => {
                        open.take(edit);
                        open.on_mask = matches!(self, LayerAction::PaintMask { .. });
                    }
                    None => session.said.extend(refusal),
                }
            }
        }
    }

    fn paint_ball(&self, session: &mut Session, layer: &LayerPath, hollows: bool) {
        let Some(document) = session.active().map(OpenDocument::document) else { return };
        let (refusal, found) = (self.refusal(document), layer.find(document).map(|found| found.id));
        match (refusal, found) {
            (Some(why), _) => session.say(why),
            (None, found) => found.into_iter().for_each(|id| session.paint_ball(id, hollows)),
        }
    }

    fn draw_with(&self, session: &mut Session, layer: &LayerPath) {
        let (brush, color) = (session.tools.brush.clone(), session.tools.color);
        let Some(open) = session.active_mut() else { return };
        if let Some(why) = self.refusal(open.document()) {
            return session.say(why);
        }
        open.forget_preview();
        let Some(id) = layer.find(open.document()).map(|found| found.id) else { return };
        let next = open.document().with_layer(id, |layer| {
            if let Content::FormDrawing(live) = &mut layer.content {
                *live = Live::new(FormDrawing { brush, color, ..live.params().clone() });
            }
        });
        if let Some(next) = next {
            open.commit("Brush of the lines", next);
        }
    }

    /// Does an edit that needs no settings on an open document.
    pub(super) fn step_on(&self, open: &mut OpenDocument) {
        if let Some(edit) = self.edit(open, &NewLayerSettings::default()) {
            open.take(edit);
        }
    }

    /// The step: its name, the resulting document, and the new selection.
    fn edit(&self, open: &OpenDocument, settings: &NewLayerSettings) -> Option<Edit> {
        let document = open.document();
        let layer = |path: &LayerPath| path.find(document).cloned();
        let selected =
            |layer: &LayerPaths| layer.find(document).map(|ids| document.outermost(&ids));
        let (label, document, select) = match self {
            LayerAction::Add { kind } => {
                let new = selecting(document, make_layer(*kind, document, settings));
                let id = new.id;
                ("Add layer", document.with_inserted(new, slot_above(open))?, vec![id])
            }
            LayerAction::AddShading { model } => add_layer(open, lit_layer(*model, document))?,
            LayerAction::Look { name } => looks::apply_look(document, name)?,
            LayerAction::MakeStrokes { layer: path } => {
                let id = layer(path)?.id;
                ("Make strokes", document.with_made_strokes(id)?, vec![id])
            }
            LayerAction::DrawGuides { layer: path } => {
                new::add_guides(document, layer(path)?.as_ref())?
            }
            LayerAction::PaintedBall { layer: path, name, hollows } => {
                let layer = layer(path)?;
                looks::with_ball(document, &layer, name, *hollows)?
            }
            LayerAction::PixelColors { layer: path } => tone_step(document, layer(path)?.as_ref())?,
            LayerAction::AddAdjustment { adjustment } => {
                let name = document.free_layer_name(adjustment.label());
                add_layer(open, Layer::new(name, adjustment.clone()))?
            }
            LayerAction::AddFilter { filter } => {
                let name = document.free_layer_name(filter.label());
                add_layer(open, Layer::new(name, filter.clone()))?
            }
            LayerAction::PaintMask { layer: path, hides } => {
                let layer = layer(path)?;
                paint_mask(document, &layer, *hides)?
            }
            LayerAction::Delete { layer } => delete(document, &selected(layer)?)?,
            LayerAction::Duplicate { layer } => duplicate(document, &selected(layer)?)?,
            LayerAction::Move { layer: paths, group, index } => {
                let group = group
                    .as_ref()
                    .map(|path| layer(path).map(|layer| layer.id).ok_or(()))
                    .transpose()
                    .ok()?;
                let ids = selected(paths)?;
                let next = document.with_moved_layers(&ids, LayerSlot { group, index: *index })?;
                (moves(&ids), next, selection_after_move(open, ids))
            }
            LayerAction::Nudge { layer, by } => {
                let ids = selected(layer)?;
                (
                    moves(&ids),
                    document.with_nudged_layers(&ids, *by)?,
                    selection_after_move(open, ids),
                )
            }
            LayerAction::Mirror { layer, upright } => {
                let mirror = transform::mirror(*upright);
                let next = transform::transform_about_middle(document, &selected(layer)?, mirror)?;
                ("Mirror layer", next, Vec::new())
            }
            LayerAction::Turn { layer, degrees } => {
                let turn: PlaneMap = transform::turn(f64::from(*degrees))?;
                let next = transform::transform_about_middle(document, &selected(layer)?, turn)?;
                ("Turn layer", next, Vec::new())
            }
            LayerAction::ApplyTransform { layer } => {
                let apply = |next: Document, id| bake_displacement(&next, id, &Progress::default());
                let next = selected(layer)?.into_iter().try_fold(document.clone(), apply)?;
                ("Apply transform", next, Vec::new())
            }
            LayerAction::Mesh { layer, columns, rows } => {
                let mesh =
                    |next: Document, id| transform::mesh::with_grid(&next, id, *columns, *rows);
                let next = selected(layer)?.into_iter().try_fold(document.clone(), mesh)?;
                ("Mesh", next, Vec::new())
            }
            LayerAction::MergeDown { .. } | LayerAction::Flatten {} | LayerAction::Bake { .. } => {
                return self.perform_long(document, &Progress::default());
            }
            LayerAction::Group { layer } => group(document, &selected(layer)?)?,
            LayerAction::Ungroup { layer } => ungroup(document, &selected(layer)?)?,
            LayerAction::Attach { layer, part } => {
                attach(document, &layer.find(document)?, part.as_deref()).ok()?
            }
            LayerAction::Clear { layer } => clear_layers(document, &selected(layer)?)?,
            LayerAction::Select { .. }
            | LayerAction::Choose { .. }
            | LayerAction::Solo { .. }
            | LayerAction::OnMask { .. }
            | LayerAction::Adjust { .. }
            | LayerAction::Filter { .. }
            | LayerAction::EffectLight { .. }
            | LayerAction::Material { .. }
            | LayerAction::Unadjust {}
            | LayerAction::TakeAlong { .. }
            | LayerAction::Pivot { .. }
            | LayerAction::PaintBall { .. }
            | LayerAction::DrawWith { .. }
            | LayerAction::Write { .. }
            | LayerAction::Set { .. } => return None,
        };
        Some(Edit { label, document, select, note: None })
    }
}

/// A new layer above the selected one, masked by the selection.
fn add_layer(open: &OpenDocument, new: Layer) -> Option<EditStep> {
    let document = open.document();
    let new = selecting(document, new);
    let id = new.id;
    Some(("Add layer", document.with_inserted(new, slot_above(open))?, vec![id]))
}

/// A painter's light in tones of the picture beneath it; in three tones if light was smooth.
fn tone_step(document: &Document, layer: &Layer) -> Option<EditStep> {
    let Content::Shading(live) = &layer.content else { return None };
    let mut shading = live.params().clone();
    shading.pixel.colors = colors_beneath(document, layer.id)?;
    if !shading.pixel.is_on() {
        shading.pixel.bands = PixelShading::USUAL_BANDS;
    }
    let content = Content::Shading(Live::new(shading));
    let next = document.with_layer(layer.id, |layer| layer.content = content)?;
    Some(("Pixel shading", next, vec![layer.id]))
}

/// Where a new layer goes: above the selected one; into it, on top, if it is a group.
pub fn slot_above(open: &OpenDocument) -> LayerSlot {
    let document = open.document();
    let highest = document.layers_below_top_ink();
    let Some(layer) = open.active_layer.and_then(|id| document.layer(id)) else {
        return LayerSlot::top_level(highest);
    };
    if layer.content.group().is_some() {
        return LayerSlot::in_group(layer.id, usize::MAX);
    }
    let place = document.place_of(layer.id).unwrap_or(LayerSlot::top_level(highest));
    let index = place.index.saturating_add(1);
    match place.group {
        None => LayerSlot::top_level(index.min(highest)),
        Some(_) => LayerSlot { index, ..place },
    }
}

/// The layer at a place, or the group it is in.
pub(super) fn sibling(document: &Document, place: LayerSlot) -> Option<LayerId> {
    let layers = match place.group {
        None => &document.layers,
        Some(group) => &document.layer(group)?.content.group()?.layers,
    };
    layers.get(place.index).map(|layer| layer.id).or(place.group)
}
