//! Why an action on layers has nothing to act on.
//! Floor 6.

use super::LayerAction;
use super::flattening::layer_beneath;
use super::steps::attach;
use crate::document::parts::forms::visible_place;
use crate::document::{Content, Document, Layer, LayerId, LayerLock, Live, Mesh, Role};
use crate::io::recipe::{LiveLook, PaintedBall, PartMaterial};
use crate::session::{LayerPath, LayerPaths};
use crate::shading::{Model, Shading};
use std::sync::Arc;

impl LayerAction {
    /// Why there is nothing to act on, in a sentence for the user.
    pub fn refusal(&self, document: &Document) -> Option<&'static str> {
        let selected = |layer: &LayerPaths| layer.find(document).ok_or("Select a layer first.");
        let refusal = match self {
            LayerAction::Delete { layer }
            | LayerAction::Duplicate { layer }
            | LayerAction::Move { layer, .. }
            | LayerAction::Nudge { layer, .. }
            | LayerAction::Bake { layer }
            | LayerAction::ApplyTransform { layer }
            | LayerAction::Mirror { layer, .. }
            | LayerAction::Turn { layer, .. }
            | LayerAction::Group { layer }
            | LayerAction::Set { layer, .. }
            | LayerAction::TakeAlong { layer, .. }
            | LayerAction::Clear { layer } => selected(layer).map(drop),
            LayerAction::Mesh { layer, columns, rows }
                if [columns, rows].iter().all(|n| Mesh::SIDE.contains(n)) =>
            {
                selected(layer).and_then(|ids| check_mesh(document, &ids))
            }
            LayerAction::Mesh { .. } => Err("A mesh has 2 to 33 points along a side."),
            LayerAction::Ungroup { layer } => {
                selected(layer).and_then(|ids| check_ungroup(document, &ids))
            }
            LayerAction::Look { name } => check_look(document, name),
            LayerAction::Material { name, part, .. } => {
                check_material(document, name, part.as_deref())
            }
            LayerAction::PaintedBall { name, .. } if PaintedBall::of_key(name).is_none() => {
                Err("No painted ball has this name.")
            }
            LayerAction::PaintedBall { layer, .. } | LayerAction::PaintBall { layer, .. } => {
                let is_ball = |live: &Live<Shading>| live.params().model == Model::LitSphere;
                check_shading(document, layer, is_ball)
                    .map_err(|()| "Select a layer that is lit by a painted ball first.")
            }
            LayerAction::PixelColors { layer } => {
                let is_lighting = |live: &Live<Shading>| live.params().is_lighting_beneath();
                check_shading(document, layer, is_lighting)
                    .map_err(|()| "Select a painter's light that lights what is beneath first.")
            }
            LayerAction::MakeStrokes { layer }
            | LayerAction::DrawWith { layer }
            | LayerAction::DrawGuides { layer } => check_form_drawing(document, layer),
            LayerAction::Attach { layer, part } => {
                selected(layer).and_then(|ids| attach(document, &ids, part.as_deref()).map(drop))
            }
            LayerAction::MergeDown { layer } => {
                selected(layer).and_then(|ids| check_merge(document, &ids))
            }
            _ => Ok(()),
        };
        refusal.err()
    }
}

type Check = Result<(), &'static str>;

fn check_mesh(document: &Document, ids: &[LayerId]) -> Check {
    let is_displaced = |id: &LayerId| {
        let can = document.layer(*id).is_some_and(|layer| layer.content.can_be_warped());
        let frame = document.frame_box(*id).filter(|_| can);
        frame.is_some_and(|frame| (frame.high - frame.low).min_element() >= 1.0)
    };
    match ids.iter().all(is_displaced) {
        true => Ok(()),
        false => Err("The layer holds nothing that a mesh could displace."),
    }
}

fn check_ungroup(document: &Document, ids: &[LayerId]) -> Check {
    let layers = ids.iter().filter_map(|id| document.layer(*id));
    let mut groups = layers.filter(|layer| layer.content.group().is_some()).peekable();
    if groups.peek().is_none() {
        return Err("There is no group among the selected layers.");
    }
    match groups.any(|group| group.is_warped()) {
        true => Err("A mesh or liquify displaces the group: apply or remove it first."),
        false => Ok(()),
    }
}

fn check_look(document: &Document, name: &str) -> Check {
    if document.surface.is_none() {
        return Err("A look needs a shape: give the drawing one first.");
    }
    LiveLook::of_key(name).map(drop).ok_or("No look has this name.")
}

fn check_material(document: &Document, name: &str, part: Option<&str>) -> Check {
    if document.surface.is_none() {
        return Err("A material needs a shape: give the drawing one first.");
    }
    if PartMaterial::of_key(name).is_none() {
        return Err("No material has this name.");
    }
    match part.is_some_and(|part| visible_place(document, part).is_none()) {
        true => Err("There is no part of this name, or nothing of it is seen."),
        false => Ok(()),
    }
}

/// Fails without a reason unless the layer is a shading layer that is as asked for.
fn check_shading(
    document: &Document,
    layer: &LayerPath,
    is_asked_for: impl Fn(&Live<Shading>) -> bool,
) -> Result<(), ()> {
    match layer.find(document).map(|layer| &layer.content) {
        Some(Content::Shading(live)) if is_asked_for(live) => Ok(()),
        _ => Err(()),
    }
}

fn check_form_drawing(document: &Document, layer: &LayerPath) -> Check {
    let is_drawing = |layer: &&Arc<Layer>| matches!(layer.content, Content::FormDrawing(_));
    match layer.find(document).filter(is_drawing) {
        None => Err("Select a layer of form lines or hatching first."),
        Some(layer) if layer.lock == LayerLock::All => Err("The layer is locked."),
        Some(_) => Ok(()),
    }
}

fn check_merge(document: &Document, ids: &[LayerId]) -> Check {
    let is_lowest = |id: LayerId| document.place_of(id).is_none_or(|place| place.index == 0);
    match ids {
        [one] if is_lowest(*one) => Err("There is no layer beneath to merge with."),
        [one] => match layer_beneath(document, *one) {
            Some(beneath) if has_no_paint(document, beneath) => Err(
                "The layer beneath only changes what lies below it. Merge that layer down first.",
            ),
            _ => Ok(()),
        },
        several => match document.outermost(several).first() {
            Some(lowest) if has_no_paint(document, *lowest) => Err(
                "The lowest of these layers only changes what lies below it. Select a layer below it too.",
            ),
            _ => Ok(()),
        },
    }
}

/// Whether a layer shows nothing alone: what is merged onto it would lose what it does.
fn has_no_paint(document: &Document, id: LayerId) -> bool {
    let role = document.layer(id).map(|layer| layer.content.role());
    matches!(role, Some(Role::Adjusts(_) | Role::Shapes(_)))
}
