//! Which version of the schema a document needs.
//! Floor 5. Not here: what selections and guides need (`selections`, `guides`).

use crate::document::{Content, Document, Layer, LayerLabel};
use crate::paint::grain::GrainSpace;
use crate::paint::{DistanceMetric, PictureOrigin};
use crate::shading::{BallStrokes, Model, PixelShading, SolidGlass};
use crate::surface::Operator;

/// The newest schema this program reads. A document that needs nothing newer is written as the
/// first.
pub const VERSION: i64 = 2;

/// Whether a layer is on the unwrapped surface, sees itself, is a text or a path, or was painted with a
/// dual brush, which the first version does not know.
pub fn has_unwrapped(document: &Document) -> bool {
    let is_print = |operator: Operator| matches!(operator, Operator::Surface { .. });
    let is_new = |layer: &Layer| match &layer.content {
        Content::Image(live) => {
            let bend = &live.params().bend;
            let is_drawn = live.params().source.origin != PictureOrigin::File;
            is_drawn || is_print(bend.operator) || !bend.pieces.is_empty()
        }
        Content::Gradient(live) => {
            is_print(live.params().operator) || !live.params().pieces.is_empty()
        }
        Content::Strokes(live) => live.params().strokes.iter().any(|stroke| {
            let (brush, grain) = (stroke.brush(), stroke.brush().grain.as_ref());
            is_print(stroke.operator())
                || [brush.spacing_on, brush.stabilizer_on].contains(&DistanceMetric::Surface)
                || grain.is_some_and(|grain| grain.lies == GrainSpace::Unwrapped)
                || brush.dual.is_some()
        }),
        Content::Shading(live) => {
            let shading = live.params();
            shading.bounces > 0
                || shading.model == Model::Painter
                || shading.shadows.on
                || shading.pixel != PixelShading::default()
                || shading.strokes != BallStrokes::DEFAULT
                || shading.solid != SolidGlass::DEFAULT
        }
        _ => false,
    };
    document.walk().iter().any(|(_, layer)| is_new(layer))
}

/// Whether the first version has no words for something in a document.
pub fn is_of_second_version(document: &Document) -> bool {
    let has_matrix = document.surface_source.as_ref().is_some_and(|source| source.matrix.is_some());
    let is_new = |layer: &Layer| {
        let is_carried = layer.on.is_some() || layer.content.has_attachments();
        is_carried
            || layer.transform.is_some()
            || layer.liquify.is_some()
            || layer.label != LayerLabel::None
            || matches!(
                layer.content,
                Content::Adjustment(_)
                    | Content::Filter(_)
                    | Content::Ink(_)
                    | Content::FormDrawing(_)
            )
    };
    has_matrix
        || !document.parts.is_empty()
        || document.walk().iter().any(|(_, layer)| is_new(layer))
}
