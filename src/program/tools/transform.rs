//! The transform tool: a gizmo with handles around the selected layers and groups, which stay live
//! until it is applied. Floor 5. Not here: what a layer becomes under its transform
//! (`document::layer`).

mod corner;
mod gesture;
pub mod mesh;
mod numbers;
mod pivot;
mod placed;

pub use numbers::GizmoNumbers;
pub use pivot::PIVOTS;

use super::gizmo::{GizmoContent, TransformGizmo, TransformHandle, TransformTarget};
use super::snap::SnapLines;
use super::{GestureStart, Outcome, PenSample, ToolContext, closed};
use crate::document::{Document, Layer, LayerId};
use crate::math::{PlaneMap, Vec2};
use gesture::{HeldLayer, TransformGesture};
use pivot::PivotGesture;
use placed::{DragMap, LayerPlacement, to_storable};

/// The settings of the transform tool.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct TransformSettings {
    /// What it moves.
    pub target: TransformTarget,
    /// The selected points of the active layer's mesh.
    pub mesh_points: Vec<usize>,
}

/// The pen comes down with the tool.
pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    let document = context.document;
    let content =
        GizmoContent::new(context.tools.transform.target, document, context.selected_layers());
    let of_shape = content == GizmoContent::Shape;
    let selected = if of_shape { &[] } else { context.selected_layers() };
    let layers: Vec<&Layer> =
        selected.iter().filter_map(|id| document.layer(*id)).map(|l| &**l).collect();
    if layers.is_empty() && !of_shape {
        return (None, Outcome::Refused("Select a layer first.".into()));
    }
    if let Some(why) = layers.iter().find_map(|layer| closed::why_locked(layer)) {
        return (None, Outcome::Refused(why.into()));
    }
    if !of_shape && let Some(begun) = mesh::press(context, pen) {
        return begun;
    }
    let Some(gizmo) = context.gizmo.gizmo_for(document, content) else {
        return (
            None,
            Outcome::Refused("The layer is empty: there is nothing to transform.".into()),
        );
    };
    let handle = gizmo.handle_at(pen.place(), context.px_per_pt, pen.keys.alt);
    if handle == TransformHandle::Pivot {
        let (snap, snaps, px_per_pt) =
            (context.snap.clone(), context.tools.aids.snaps, context.px_per_pt);
        let gesture = PivotGesture { gizmo, snap, snaps, px_per_pt, lines: SnapLines::default() };
        return (Some(Box::new(gesture)), Outcome::Idle);
    }
    if of_shape && pen.keys.ctrl && matches!(handle, TransformHandle::Corner(_)) {
        return (
            None,
            Outcome::Refused(
                "A shape cannot be put in perspective: its depth would not fit. Drag its sides."
                    .into(),
            ),
        );
    }
    let held = |layer: &&Layer| {
        Some(HeldLayer {
            id: layer.id,
            own: LayerPlacement::of(layer),
            map: document.map_of(layer.id)?,
        })
    };
    let layers = layers.iter().filter_map(held).collect();
    let (document, snap) = (document.clone(), context.snap.clone());
    let (from, lines) = (pen.place(), SnapLines::default());
    let gesture = TransformGesture {
        document,
        layers,
        of_shape,
        gizmo,
        handle,
        from,
        found: None,
        snap,
        lines,
    };
    (Some(Box::new(gesture)), Outcome::Idle)
}

/// A mirror about the origin.
pub fn mirror(upright: bool) -> PlaneMap {
    let [x, y] = if upright { [1.0, -1.0] } else { [-1.0, 1.0] };
    PlaneMap::affine([x, 0.0, 0.0, y, 0.0, 0.0]).unwrap_or_default()
}

/// A turn about the origin, counter-clockwise as seen; `None` for NaN.
pub fn turn(degrees: f64) -> Option<PlaneMap> {
    degrees.is_finite().then(|| PlaneMap::rotation(degrees, Vec2::ZERO))
}

/// Layers with what they show mapped about its middle. `None` for empty layers, or where that
/// cannot be expressed.
pub fn transform_about_middle(
    document: &Document,
    layers: &[LayerId],
    map: PlaneMap,
) -> Option<Document> {
    let pivot = TransformGizmo::around(document, layers)?.pivot();
    // A middle between pixels along only one axis would move pixels by halves when they are turned.
    let pivot = if map.coefficients().is_some_and(|c| c[1] != 0.0) { pivot.round() } else { pivot };
    let on_canvas = PlaneMap::translation(-pivot).then(&map).then(&PlaneMap::translation(pivot));
    layers.iter().try_fold(document.clone(), |next, layer| mapped(&next, *layer, on_canvas))
}

/// A map about the middle of the shape as a matrix on the canvas. `None` if there is no shape.
pub fn matrix_about_shape(document: &Document, map: PlaneMap) -> Option<[f64; 6]> {
    let [low, high] = TransformGizmo::of_shape(document)?.bounds();
    let middle = (low + high) * 0.5;
    let pivot =
        if map.coefficients().is_some_and(|c| c[1] != 0.0) { middle.round() } else { middle };
    PlaneMap::translation(-pivot).then(&map).then(&PlaneMap::translation(pivot)).coefficients()
}

/// A layer with what it shows moved by a map of the canvas; `None` where that cannot be expressed.
pub fn mapped(document: &Document, layer: LayerId, on_canvas: PlaneMap) -> Option<Document> {
    let (own, whole) = (LayerPlacement::of(document.layer(layer)?), document.map_of(layer)?);
    let next = own.then(&whole, &DragMap::OnCanvas(on_canvas), document.size)?;
    document.with_layer(layer, |layer| next.put(layer))
}

#[cfg(test)]
mod tests;
