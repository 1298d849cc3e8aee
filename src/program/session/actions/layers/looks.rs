//! Looks, materials and painted balls that come with the program, put into a document.
//! Floor 6. Not here: what they are (`io::recipe::looks` and `materials`).

use super::steps::EditStep;
use crate::document::{Content, Document, Layer, Live};
use crate::io::recipe::{LiveLook, PaintedBall, PartMaterial};
use crate::session::OpenDocument;
use crate::shading::{LitSphere, Model};

/// The step that puts a document in a look: its name, the document, and what is selected then.
pub(super) fn apply_look(document: &Document, name: &str) -> Option<EditStep> {
    document.surface.as_ref()?;
    let next = LiveLook::of_key(name)?.on(document).ok()?;
    let selected = next.layers.last().map(|layer| layer.id);
    Some(("Look", next, selected.into_iter().collect()))
}

/// Gives a part, or what is selected, a material: a step, or a preview of one.
pub(super) fn give_material(open: &mut OpenDocument, name: &str, part: Option<&str>, done: bool) {
    let given = PartMaterial::of_key(name).and_then(|of| of.on(open.document(), part).ok());
    match given {
        Some((next, layer)) if done => {
            if open.commit("Material", next) {
                open.select_layers(vec![layer]);
            }
        }
        Some((next, _)) => open.show("Material", next),
        None => open.forget_preview(),
    }
}

/// The step that gives a layer a ball, whose strokes stay whole from then on.
pub(super) fn with_ball(
    document: &Document,
    layer: &Layer,
    name: &str,
    hollows: bool,
) -> Option<EditStep> {
    let Content::Shading(live) = &layer.content else { return None };
    let ball = PaintedBall::of_key(name)?;
    let sphere = LitSphere::new(ball.file(), ball.picture().ok()?);
    let mut shading = live.params().clone().with_ball(hollows, sphere);
    shading.strokes.on |= shading.model == Model::LitSphere;
    let content = Content::Shading(Live::new(shading));
    let next = document.with_layer(layer.id, |layer| layer.content = content)?;
    Some(("Painted ball", next, vec![layer.id]))
}
