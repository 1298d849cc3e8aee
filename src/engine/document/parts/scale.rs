//! Parts on a canvas of another size: all their lengths, and nothing else. Floor 4.

use super::{OutlineSource, Part, PartKind};
use crate::math::{Mat2, Vec2};
use crate::raster::Plane;
use std::sync::Arc;

impl Part {
    /// The same part on a canvas with other sides.
    pub(in crate::document) fn scaled(
        &self,
        scale: Vec2,
        length: f32,
        plane: impl Fn(&Plane<u8>) -> Plane<u8>,
    ) -> Part {
        let mut next = self.clone();
        next.raise *= length;
        let to = Mat2::from_diagonal(scale);
        // What it refers to is scaled as well: the matrix maps scaled points to scaled points.
        next.matrix.matrix2 = to * self.matrix.matrix2 * to.inverse();
        next.matrix.translation *= scale;
        match &mut next.kind {
            PartKind::Inflate { outline, .. } => outline.scale(scale),
            PartKind::Bevel { outline, bevel } => {
                outline.scale(scale);
                bevel.width *= length;
                bevel.height *= length;
            }
            PartKind::Primitive(primitive) => {
                primitive.center *= scale;
                primitive.half *= length;
                for side in [&mut primitive.radius, &mut primitive.length, &mut primitive.tube, &mut primitive.round] {
                    *side *= length;
                }
            }
            PartKind::Lathe { outline, axis, .. } => {
                outline.scale(scale);
                axis.iter_mut().flatten().for_each(|p| *p *= scale);
            }
            PartKind::Sweep { balls, .. } => balls.iter_mut().for_each(|ball| {
                ball.at *= scale;
                ball.radius *= length;
            }),
            PartKind::Touches { touches, .. } => touches.iter_mut().for_each(|touch| {
                touch.at *= scale;
                touch.radius *= length;
                touch.reach *= length;
            }),
            PartKind::Sculpt { strokes, .. } => strokes.iter_mut().for_each(|stroke| {
                stroke.size *= length;
                // For tools that go a share of the way this is not a length.
                stroke.strength *= if stroke.tool.is_by_height() { length } else { 1.0 };
                stroke.samples.iter_mut().for_each(|sample| sample.0 *= scale);
            }),
            PartKind::Lines { ink, lines, .. } => {
                ink.scale(scale);
                lines.reach *= length;
            }
            PartKind::Profiles { outline, .. } => {
                if let Some(outline) = outline {
                    outline.scale(scale);
                }
            }
            PartKind::Maps(maps) => {
                // What is thinner than a pixel of the new canvas stays unchanged.
                if let Ok(surface) = maps.surface.stretched(maps.surface.size().scaled(length)) {
                    maps.surface = Arc::new(surface);
                }
            }
            PartKind::Relief { detail, .. } => {
                detail.coarse *= length;
                detail.fine *= length;
                detail.radius *= length;
            }
        }
        for file in next.files_mut() {
            file.coverage = Arc::new(plane(&file.coverage));
        }
        next
    }
}

impl OutlineSource {
    fn scale(&mut self, scale: Vec2) {
        self.points_mut().for_each(|p| *p *= scale);
    }
}
