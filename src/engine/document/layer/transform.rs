//! Transforms: where a layer's own frame lies on the canvas. Floor 4. Not here: all transforms that
//! act on a layer (`LayerMap`).

pub(super) mod mesh;

use crate::math::plane_map::round_as_written;
use crate::math::{COORDINATE, DVec2, PlaneMap, Size, Vec2, range, vec2};
use crate::raster::Resampling;
use mesh::Mesh;
use std::sync::Arc;

/// Where a layer's frame lies, and how its pixels are sampled.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerTransform {
    /// Where points of the frame go.
    pub shape: TransformShape,
    /// How pixels are sampled.
    pub filter: Resampling,
}

/// A map of the layer's frame to the canvas.
#[derive(Clone, Debug, PartialEq)]
pub enum TransformShape {
    /// a, b, c, d, e, f: x′ = a x + c y + e, y′ = b x + d y + f.
    Matrix([f64; 6]),
    /// Where the canvas's corners go: upper left, upper right, lower right, lower left.
    Quad([DVec2; 4]),
    /// Where the points of a grid go.
    Mesh(Arc<Mesh>),
}

impl LayerTransform {
    /// Factors and shears; places have the range of coordinates.
    pub const FACTOR: range::Range = -1e4..=1e4;

    /// The map of the plane; `None` where a matrix cannot be inverted or corners form no convex
    /// quadrilateral. A mesh that is not a matrix leaves the plane unmoved and displaces what is
    /// seen ([`super::LayerWarp`]).
    pub fn map(&self, canvas: Size) -> Option<PlaneMap> {
        match &self.shape {
            TransformShape::Matrix(coefficients) => PlaneMap::affine(*coefficients),
            TransformShape::Quad(corners) => PlaneMap::quad(canvas, *corners),
            TransformShape::Mesh(mesh) => Some(mesh.as_affine().unwrap_or_default()),
        }
    }

    /// The mesh that it is, if it is one.
    pub fn mesh(&self) -> Option<&Arc<Mesh>> {
        if let TransformShape::Mesh(mesh) = &self.shape { Some(mesh) } else { None }
    }

    /// Refuses numbers that files cannot hold, and what is no map.
    pub fn fits(&self) -> Result<(), String> {
        let place = |v: f64| range::check_range("a place of the transform", v as f32, &COORDINATE);
        match &self.shape {
            TransformShape::Matrix([a, b, c, d, e, f]) => {
                [a, b, c, d].into_iter().try_for_each(|v| {
                    range::check_range("a factor of the transform", *v as f32, &Self::FACTOR)
                })?;
                [*e, *f].into_iter().try_for_each(place)?;
                self.map(Size::new(1, 1))
                    .map(|_| ())
                    .ok_or_else(|| "cannot be inverted: it has no area".into())
            }
            TransformShape::Quad(corners) => {
                corners.iter().flat_map(|corner| corner.to_array()).try_for_each(place)?;
                self.map(Size::new(1, 1))
                    .map(|_| ())
                    .ok_or_else(|| "is not a convex quadrilateral".into())
            }
            TransformShape::Mesh(mesh) => mesh.fits(),
        }
    }

    /// A map of the plane as a transform; `None` for a perspective whose horizon crosses the
    /// canvas.
    pub fn of_map(map: &PlaneMap, filter: Resampling, canvas: Size) -> Option<Self> {
        if let Some(coefficients) = map.coefficients_as_written() {
            return Some(LayerTransform { shape: TransformShape::Matrix(coefficients), filter });
        }
        let (w, h) = (canvas.width as f32, canvas.height as f32);
        let corners = [vec2(0.0, 0.0), vec2(w, 0.0), vec2(w, h), vec2(0.0, h)]
            .map(|corner| map.to_canvas(corner));
        let [Some(a), Some(b), Some(c), Some(d)] = corners else { return None };
        let shape = TransformShape::Quad([a, b, c, d].map(|corner| {
            DVec2::new(round_as_written(corner.x.into()), round_as_written(corner.y.into()))
        }));
        let transform = LayerTransform { shape, filter };
        transform.map(canvas).map(|_| transform)
    }

    /// The same, sampled quickly while a hand drags.
    pub(in crate::document) fn drafted(&self) -> Self {
        match self.filter {
            Resampling::Smooth | Resampling::Sharp => {
                Self { filter: Resampling::Linear, ..self.clone() }
            }
            Resampling::Linear | Resampling::Nearest => self.clone(),
        }
    }

    /// The same picture on a canvas `per_axis` times as large.
    pub(in crate::document) fn scaled(&self, per_axis: Vec2) -> Self {
        let s = per_axis.as_dvec2();
        let shape = match &self.shape {
            TransformShape::Matrix(coefficients) => {
                TransformShape::Matrix(scaled_matrix(*coefficients, per_axis))
            }
            TransformShape::Quad(corners) => TransformShape::Quad(corners.map(|corner| corner * s)),
            TransformShape::Mesh(mesh) => TransformShape::Mesh(Arc::new(mesh.scaled(per_axis))),
        };
        Self { shape, ..*self }
    }
}

/// The matrix with the same effect on a canvas `per_axis` times as large.
pub(in crate::document) fn scaled_matrix([a, b, c, d, e, f]: [f64; 6], per_axis: Vec2) -> [f64; 6] {
    let s = per_axis.as_dvec2();
    [a, b * s.y / s.x, c * s.x / s.y, d, e * s.x, f * s.y]
}
