//! Meshes under the transform tool: points that are dragged, one or those that are selected. Floor
//! 5. Not here: what a mesh does (`document::layer`).

use crate::document::{Document, Layer, LayerId, LayerTransform, Mesh, MeshFrame, TransformShape};
use crate::math::{PlaneMap, Vec2, vec2};
use crate::tools::{GRAB_PT, Gesture, Outcome, PenSample, ToolContext};
use std::sync::Arc;

/// A layer with a grid of so many points over what it shows; an existing mesh gets new points.
/// `None` for an empty layer, or if there is no such grid.
pub fn with_grid(
    document: &Document,
    id: LayerId,
    columns: usize,
    rows: usize,
) -> Option<Document> {
    let (layer, map) = (document.layer(id)?, document.map_of(id)?);
    let filter = layer.transform.as_ref().map_or(map.filter, |own| own.filter);
    let old = layer.transform.as_ref();
    let mesh = match old.and_then(|own| own.mesh()) {
        Some(mesh) => {
            let even = Mesh::even(columns, rows, mesh.frame())?;
            even.with_points(even.points().iter().map(|p| mesh.at(*p).0).collect())?
        }
        None => {
            let frame = document.frame_box(id)?;
            let even = Mesh::even(
                columns,
                rows,
                MeshFrame { corner: frame.low, size: frame.high - frame.low },
            )?;
            even.then(&old.map_or(Some(PlaneMap::IDENTITY), |own| own.map(document.size))?)?
        }
    };
    with_mesh(document, id, mesh, filter)
}

fn with_mesh(
    document: &Document,
    id: LayerId,
    mesh: Mesh,
    filter: crate::raster::Resampling,
) -> Option<Document> {
    let transform = LayerTransform { shape: TransformShape::Mesh(Arc::new(mesh)), filter };
    document.with_layer(id, |layer| layer.transform = Some(transform))
}

/// The points of a layer's mesh on the canvas, and the mesh; `None` for a layer without one.
pub fn points_of(document: &Document, layer: &Layer) -> Option<(Arc<Mesh>, Vec<Vec2>)> {
    let mesh = layer.transform.as_ref()?.mesh()?;
    let to_canvas = document.map_of(layer.id)?.map_outside_own();
    let points = mesh.points().iter().map(|p| to_canvas.to_canvas(*p).unwrap_or(*p)).collect();
    Some((mesh.clone(), points))
}

/// What a press does at the points of the selected layer's mesh; `None` if it has none. Shift adds
/// a point to those selected, or removes it.
pub(super) fn press(
    context: &ToolContext,
    pen: PenSample,
) -> Option<(Option<Box<dyn Gesture>>, Outcome)> {
    let [id] = context.selected_layers() else { return None };
    let document = context.document;
    let layer = document.layer(*id)?;
    let (mesh, points) = points_of(document, layer)?;
    let distance = |k: &usize| points[*k].distance(pen.place());
    let nearest = (0..points.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    if distance(&nearest) > GRAB_PT * context.px_per_pt {
        return None;
    }
    let mut selected: Vec<usize> =
        context.tools.transform.mesh_points.iter().copied().filter(|k| *k < points.len()).collect();
    if pen.keys.shift {
        match selected.iter().position(|k| *k == nearest) {
            Some(place) => drop(selected.remove(place)),
            None => selected.push(nearest),
        }
        return Some((None, choose_points(selected)));
    }
    if !selected.contains(&nearest) {
        selected = vec![nearest];
    }
    let to_canvas = document.map_of(*id)?.map_outside_own();
    let gesture = MeshGesture {
        document: document.clone(),
        layer: *id,
        mesh,
        selected: selected.clone(),
        to_canvas,
        from: pen.place(),
        by: Vec2::ZERO,
    };
    Some((Some(Box::new(gesture)), choose_points(selected)))
}

fn choose_points(points: Vec<usize>) -> Outcome {
    Outcome::set(move |tools| tools.transform.mesh_points = points)
}

struct MeshGesture {
    document: Document,
    layer: LayerId,
    mesh: Arc<Mesh>,
    selected: Vec<usize>,
    to_canvas: PlaneMap,
    from: Vec2,
    /// Px of the list that holds the layer.
    by: Vec2,
}

impl MeshGesture {
    fn with(&self) -> Option<Document> {
        let mut points = self.mesh.points().to_vec();
        self.selected.iter().for_each(|k| points[*k] += self.by);
        let filter = self.document.layer(self.layer)?.transform.as_ref()?.filter;
        with_mesh(&self.document, self.layer, self.mesh.with_points(points)?, filter)
    }
}

impl Gesture for MeshGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last() else { return Outcome::Idle };
        let from_canvas = |p: Vec2| self.to_canvas.from_canvas(p).map(|(p, _)| p);
        let Some((from, to)) = from_canvas(self.from).zip(from_canvas(pen.place())) else {
            return Outcome::Idle;
        };
        let by = to - from;
        // Shift keeps to one axis.
        self.by = match pen.keys.shift {
            true if by.x.abs() >= by.y.abs() => vec2(by.x, 0.0),
            true => vec2(0.0, by.y),
            false => by,
        };
        self.with().map_or(Outcome::Idle, Outcome::Preview)
    }

    fn release(&mut self) -> Outcome {
        match self.with().filter(|_| self.by != Vec2::ZERO) {
            Some(document) => Outcome::Commit { label: "Mesh".into(), document, select: None },
            None => Outcome::Cancel,
        }
    }
}
