//! Why an action on layers has nothing to act on.
//! Floor 6.

use super::LayerAction;
use super::flattening::layer_beneath;
use super::steps::attach;
use crate::document::parts::forms::visible_place;
use crate::document::{Content, Document, Layer, LayerId, LayerLock, Mesh, Role};
use crate::io::recipe::{LiveLook, PaintedBall, PartMaterial};
use crate::session::LayerPaths;
use crate::shading::Model;
use std::sync::Arc;

impl LayerAction {
    /// Why there is nothing to act on, in a sentence for the user.
    pub fn refusal(&self, document: &Document) -> Option<&'static str> {
        let is_group =
            |id: &LayerId| document.layer(*id).is_some_and(|layer| layer.content.group().is_some());
        let is_warped = |id: &LayerId| document.layer(*id).is_some_and(|layer| layer.is_warped());
        let shows = |id: &LayerId| {
            let can = document.layer(*id).is_some_and(|layer| layer.content.can_be_warped());
            can && document
                .frame_box(*id)
                .is_some_and(|frame| (frame.high - frame.low).min_element() >= 1.0)
        };
        let lies_lowest =
            |id: &LayerId| document.place_of(*id).is_none_or(|place| place.index == 0);
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
                selected(layer).and_then(|ids| match ids.iter().all(shows) {
                    true => Ok(()),
                    false => Err("The layer holds nothing that a mesh could displace."),
                })
            }
            LayerAction::Mesh { .. } => Err("A mesh has 2 to 33 points along a side."),
            LayerAction::Ungroup { layer } => {
                selected(layer).and_then(|ids| match ids.iter().any(is_group) {
                    true if ids.iter().filter(|id| is_group(id)).any(is_warped) => {
                        Err("A mesh or liquify displaces the group: apply or remove it first.")
                    }
                    true => Ok(()),
                    false => Err("There is no group among the selected layers."),
                })
            }
            LayerAction::Look { .. } if document.surface.is_none() => {
                Err("A look needs a shape: give the drawing one first.")
            }
            LayerAction::Look { name } if LiveLook::of_key(name).is_none() => {
                Err("No look has this name.")
            }
            LayerAction::Material { .. } if document.surface.is_none() => {
                Err("A material needs a shape: give the drawing one first.")
            }
            LayerAction::Material { name, .. } if PartMaterial::of_key(name).is_none() => {
                Err("No material has this name.")
            }
            LayerAction::Material { part: Some(part), .. }
                if visible_place(document, part).is_none() =>
            {
                Err("There is no part of this name, or nothing of it is seen.")
            }
            LayerAction::PaintedBall { name, .. } if PaintedBall::of_key(name).is_none() => {
                Err("No painted ball has this name.")
            }
            LayerAction::PaintedBall { layer, .. } | LayerAction::PaintBall { layer, .. } => {
                let shows_ball = |layer: &Arc<Layer>| match &layer.content {
                    Content::Shading(live) => live.params().model == Model::LitSphere,
                    _ => false,
                };
                match layer.find(document).is_some_and(shows_ball) {
                    true => Ok(()),
                    false => Err("Select a layer that is lit by a painted ball first."),
                }
            }
            LayerAction::MakeStrokes { layer } | LayerAction::DrawWith { layer } => {
                let is_drawing =
                    |layer: &&Arc<Layer>| matches!(layer.content, Content::FormDrawing(_));
                match layer.find(document).filter(is_drawing) {
                    None => Err("Select a layer of form lines or hatching first."),
                    Some(layer) if layer.lock == LayerLock::All => Err("The layer is locked."),
                    Some(_) => Ok(()),
                }
            }
            LayerAction::PixelColors { layer } => {
                let lights = |layer: &Arc<Layer>| match &layer.content {
                    Content::Shading(live) => live.params().is_lighting_beneath(),
                    _ => false,
                };
                match layer.find(document).is_some_and(lights) {
                    true => Ok(()),
                    false => Err("Select a painter's light that lights what is beneath first."),
                }
            }
            LayerAction::Attach { layer, part } => {
                selected(layer).and_then(|ids| attach(document, &ids, part.as_deref()).map(drop))
            }
            LayerAction::MergeDown { layer } => selected(layer).and_then(|ids| match &ids[..] {
                [one] if lies_lowest(one) => Err("There is no layer beneath to merge with."),
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
            }),
            _ => Ok(()),
        };
        refusal.err()
    }
}

/// Whether a layer shows nothing alone: what is merged onto it would lose what it does.
fn has_no_paint(document: &Document, id: LayerId) -> bool {
    let role = document.layer(id).map(|layer| layer.content.role());
    matches!(role, Some(Role::Adjusts(_) | Role::Shapes(_)))
}
