//! Tools of the shape: `part` moves its parts, `touch` and `sculpt` change them by hand. Here: the
//! list of parts after their edits. Floor 5. Not here: what parts are (`document::parts`).

pub mod part;
pub mod sculpt;
pub mod touch;

use crate::document::{Document, Part};
use crate::math::range::clamp_to_range;
use crate::math::{Affine2, Mat2, Size, Vec2, Vec3, vec2, vec3};
use crate::shape::{SculptStroke, SculptTool, Touch};
use std::sync::Arc;

/// The settings of the tools that touch and sculpt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeSettings {
    /// What the sculpting tool does.
    pub tool: SculptTool,
    /// Diameter of a dab, px.
    pub size: f32,
    /// The part of the dab with full strength.
    pub hardness: f32,
    /// How far a dab raises or lowers, px.
    pub height: f32,
    /// How far a dab that smooths, flattens, pinches or scrapes goes: the share of the way.
    pub share: f32,
    /// The direction that a touch gives to the surface; unit, camera space (y up).
    pub normal: Vec3,
    /// The radius of a touch, px.
    pub radius: f32,
    /// How far a touch reaches, px; 0: to the rim and the next touches.
    pub reach: f32,
}

impl Default for ShapeSettings {
    fn default() -> Self {
        Self {
            tool: SculptTool::Raise,
            size: 60.0,
            hardness: 0.3,
            height: 1.0,
            share: 0.3,
            normal: vec3(-0.4, 0.5, 0.768),
            radius: 8.0,
            reach: 0.0,
        }
    }
}

impl ShapeSettings {
    /// The longer side of a canvas up to which the first settings are large enough, px.
    const LARGE_PX: f32 = 600.0;

    /// The first settings on a canvas: as large, and as high, for the picture on any of them.
    pub fn for_canvas(canvas: Size) -> Self {
        let (first, scale) = (Self::default(), (canvas.longer_side() / Self::LARGE_PX).max(1.0));
        Self {
            size: (first.size * scale).round(),
            height: first.height * scale,
            radius: (first.radius * scale).round(),
            ..first
        }
        .clamp_to_ranges()
    }

    /// The same with numbers that a part may hold.
    pub fn clamp_to_ranges(&self) -> Self {
        let normal =
            vec3(self.normal.x, self.normal.y, self.normal.z.max(0.0)).normalize_or(Vec3::Z);
        Self {
            tool: self.tool,
            size: clamp_to_range(self.size, &SculptStroke::SIZE),
            hardness: clamp_to_range(self.hardness, &SculptStroke::HARDNESS),
            height: clamp_to_range(self.height, &SculptStroke::STRENGTH),
            share: clamp_to_range(self.share, &crate::math::UNIT),
            normal,
            radius: clamp_to_range(self.radius, &Touch::RADIUS),
            reach: clamp_to_range(self.reach, &Touch::REACH),
        }
    }

    /// The strength of a dab of the current tool.
    pub fn strength(&self) -> f32 {
        if self.tool.is_by_height() { self.height } else { self.share }
    }
}

/// With one more part: in front of all others, or of all that lies on the same part.
pub fn with_new(document: &Document, part: Part) -> Document {
    document.with_parts(list_with_new(document, part))
}

/// With a part that the user drags, new or not: its shape is made later or, at the end of the drag,
/// at once.
fn with_worked(document: &Document, part: &Part, is_new: bool, is_done: bool) -> Document {
    match (is_new, is_done) {
        (true, true) => with_new(document, part.clone()),
        (true, false) => document.with_parts_ahead(list_with_new(document, part.clone())),
        (false, true) => document.with_part(part.clone()),
        (false, false) => document.with_part_ahead(part.clone()),
    }
}

fn list_with_new(document: &Document, part: Part) -> Vec<Arc<Part>> {
    let mut list = document.parts.list.clone();
    let beside = part
        .on()
        .and_then(|on| list.iter().rposition(|other| other.id == on || other.on() == Some(on)));
    list.insert(beside.map_or(list.len(), |at| at + 1), Arc::new(part));
    list
}

/// An id that no part of a document has: `part-1`, `part-2`, …
pub fn free_id(document: &Document) -> String {
    (1..)
        .map(|i| format!("part-{i}"))
        .find(|id| document.parts.part(id).is_none())
        .unwrap_or_default()
}

/// A linear map about a point.
fn map_about(point: Vec2, map: Mat2) -> Affine2 {
    Affine2::from_translation(point) * Affine2::from_mat2(map) * Affine2::from_translation(-point)
}

/// The mean factor by which a map scales lengths; never 0.
fn length_of(matrix: Affine2) -> f32 {
    matrix.matrix2.determinant().abs().sqrt().max(1e-3)
}

/// A direction of a part on the canvas: it turns with the part.
fn on_canvas_direction(normal: Vec3, matrix: Affine2) -> Vec3 {
    turned(normal, matrix.matrix2.x_axis.to_angle())
}

/// A direction on the canvas in the frame of a part.
fn inverse_direction(normal: Vec3, matrix: Affine2) -> Vec3 {
    turned(normal, -matrix.matrix2.x_axis.to_angle())
}

fn turned(normal: Vec3, by_rad: f32) -> Vec3 {
    // Image axes are y down, normals y up.
    let bar = Vec2::from_angle(by_rad).rotate(vec2(normal.x, -normal.y));
    vec3(bar.x, -bar.y, normal.z)
}

#[cfg(test)]
mod tests;
