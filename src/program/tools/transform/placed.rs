//! The places of layers, before and after a drag of their gizmo. Floor 5.

use crate::document::{Layer, LayerMap, LayerTransform, Mesh, TransformShape};
use crate::math::{PlaneMap, Size};
use crate::raster::{Lattice, Resampling};
use std::sync::Arc;

/// The place of a layer: its transform and its liquify.
#[derive(Clone, PartialEq)]
pub(super) struct LayerPlacement {
    pub transform: Option<LayerTransform>,
    pub liquify: Option<Arc<Lattice>>,
}

impl LayerPlacement {
    pub fn of(layer: &Layer) -> Self {
        Self { transform: layer.transform.clone(), liquify: layer.liquify.clone() }
    }

    pub fn put(&self, layer: &mut Layer) {
        layer.transform.clone_from(&self.transform);
        layer.liquify.clone_from(&self.liquify);
    }

    /// The same with what shows mapped; `None` if that is no map.
    ///
    /// * `whole`: the layer's map.
    pub fn then(&self, whole: &LayerMap, map: &DragMap, canvas: Size) -> Option<Self> {
        let own =
            self.transform.as_ref().map_or(Some(PlaneMap::IDENTITY), |own| own.map(canvas))?;
        let plane = match map {
            DragMap::OnCanvas(map) => compose_layer_map(own, &whole.plane, *map),
            // A mesh is drawn where it shows.
            DragMap::Local(map) if self.mesh().is_some() => own.then(map),
            DragMap::Local(map) => map.then(&own),
        };
        // The same in the list that holds the layer.
        let outer = own.inverse().then(&plane);
        let filter = self.transform.as_ref().map_or(whole.filter, |own| own.filter);
        let transform = match self.mesh() {
            Some(mesh) => {
                let shape = TransformShape::Mesh(Arc::new(mesh.then(&outer)?));
                Some(LayerTransform { shape, filter })
            }
            None => to_storable(&plane, filter, canvas)?,
        };
        let within = canvas.rect().grown(canvas.longer_side() as i32);
        let carried = self.liquify.as_ref().map(|lattice| lattice.transformed(&outer, within));
        let liquify = carried.filter(|lattice| !lattice.is_empty()).map(Arc::new);
        Some(Self { transform, liquify })
    }

    fn mesh(&self) -> Option<&Arc<Mesh>> {
        self.transform.as_ref().and_then(|own| own.mesh())
    }
}

/// A layer's own map if what shows is moved by a map of the canvas; `whole`: its own and those of
/// the groups around it.
fn compose_layer_map(own: PlaneMap, whole: &PlaneMap, on_canvas: PlaneMap) -> PlaneMap {
    let around = own.inverse().then(whole);
    own.then(&around).then(&on_canvas).then(&around.inverse())
}

/// A map as a transform that files can hold, or none if it moves nothing; outer `None` if there is
/// no such transform.
pub(super) fn to_storable(
    map: &PlaneMap,
    filter: Resampling,
    canvas: Size,
) -> Option<Option<LayerTransform>> {
    if map.is_identity_on(canvas) {
        return Some(None);
    }
    let transform = LayerTransform::of_map(map, filter, canvas)?;
    transform.fits().ok().map(|()| Some(transform))
}

/// What a drag does to all that is in the gizmo.
pub(super) enum DragMap {
    OnCanvas(PlaneMap),
    /// Before the gizmo's own map.
    Local(PlaneMap),
}
