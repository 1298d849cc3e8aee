//! Parts on a canvas of another size: all their lengths, and nothing else. Floor 4.

use super::{OutlineSource, Part, PartKind, PartMaps};
use crate::math::{Mat2, PlaneMap, Size, Vec2};
use crate::raster::Plane;
use crate::surface::Surface;
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
                for side in [
                    &mut primitive.radius,
                    &mut primitive.length,
                    &mut primitive.tube,
                    &mut primitive.round,
                ] {
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
            PartKind::Maps(maps) => *maps = maps.scaled(scale),
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

impl PartMaps {
    /// The same maps in a frame with other sides. Where nothing would be left of what is thinner
    /// than a pixel there, they stay unchanged.
    fn scaled(&self, scale: Vec2) -> PartMaps {
        let Size { width, height } = self.surface.size();
        let side = |v: u32, s: f32| ((f64::from(v) * f64::from(s)).round() as u32).max(1);
        let frame = Size::new(side(width, scale.x), side(height, scale.y));
        let map = PlaneMap::affine([scale.x.into(), 0.0, 0.0, scale.y.into(), 0.0, 0.0])
            .unwrap_or_default();
        self.surface
            .transformed(frame, &map)
            .map_or_else(|_| self.clone(), |surface| self.on(surface))
    }

    /// These maps as another surface made of them.
    fn on(&self, surface: Arc<Surface>) -> PartMaps {
        PartMaps {
            source: Arc::new(self.source.placed_as(&surface)),
            files: self.files.clone(),
            surface,
        }
    }
}

impl OutlineSource {
    fn scale(&mut self, scale: Vec2) {
        self.points_mut().for_each(|p| *p *= scale);
    }
}
