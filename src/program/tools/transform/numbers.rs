//! The gizmo of the transform tool in numbers, to be read and typed.
//! Floor 5.

use super::to_storable;
use crate::document::{Document, LayerId, LayerTransform};
use crate::math::{DVec2, PlaneMap, Vec2};
use crate::tools::gizmo::TransformGizmo;

/// The numbers of a gizmo without perspective.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GizmoNumbers {
    /// Its upper left corner, canvas px.
    pub at: DVec2,
    /// Sides, px; one of them is negative in a mirrored gizmo.
    pub width: f64,
    /// The height, px; see `width`.
    pub height: f64,
    /// Degrees, counter-clockwise as seen.
    pub angle: f64,
    /// Degrees that its upright sides lean to the right at the bottom.
    pub skew: f64,
    /// The sides before the layer was transformed, px.
    pub own: DVec2,
}

impl GizmoNumbers {
    /// The least and greatest that can be typed.
    pub const SIDE: std::ops::RangeInclusive<f64> = -65_536.0..=65_536.0;
    /// The least and greatest skew that can be typed.
    pub const SKEW: std::ops::RangeInclusive<f64> = -85.0..=85.0;

    /// `None` for a gizmo in perspective, and for one without area.
    pub fn of(gizmo: &TransformGizmo) -> Option<Self> {
        gizmo.plane.coefficients()?;
        let [a, b, _, d] = gizmo.corners.map(|corner| corner.as_dvec2());
        let (right, down) = (b - a, d - a);
        let width = right.length();
        let across = right / width;
        let (along, height) = (across.dot(down), across.perp_dot(down));
        let own = (gizmo.inner.high - gizmo.inner.low).as_dvec2();
        // No angle is −0.
        let angle = 0.0 - across.y.atan2(across.x).to_degrees();
        let skew = (along / height.abs()).atan().to_degrees();
        let upright = Self { at: a, width, height, angle, skew, own };
        // Mirrored left and right and not turned, rather than up and down and turned by a half.
        let turned = Self {
            width: -width,
            height: -height,
            angle: angle - 180.0f64.copysign(angle),
            skew: -skew,
            ..upright
        };
        let numbers = if height < 0.0 && angle.abs() > 90.0 { turned } else { upright };
        (width > 1e-6 && height.abs() > 1e-6 && own.min_element() > 0.0).then_some(numbers)
    }

    /// Its sides as vectors: to the right and down.
    fn sides(&self) -> (DVec2, DVec2) {
        let across = DVec2::from_angle(-self.angle.to_radians());
        let lean = self.skew.to_radians().tan() * self.height.abs();
        (across * self.width, across.perp() * self.height + across * lean)
    }

    /// A point by shares of its sides, canvas px.
    fn point(&self, share: Vec2) -> DVec2 {
        let (right, down) = self.sides();
        self.at + right * f64::from(share.x) + down * f64::from(share.y)
    }

    /// With a point, given as shares of the sides, where another gizmo has it: sides and angles
    /// change about it.
    pub fn align_pivot(&self, pivot_share: Vec2, other: &Self) -> Self {
        Self { at: self.at + other.point(pivot_share) - self.point(pivot_share), ..*self }
    }

    /// The map of the canvas from a gizmo with other numbers to this one, as a matrix.
    pub fn map_from(&self, other: &Self) -> Option<[f64; 6]> {
        let to_frame = |numbers: &Self| {
            let (x, y) = numbers.sides();
            PlaneMap::affine([x.x, x.y, y.x, y.y, numbers.at.x, numbers.at.y])
        };
        to_frame(other)?.inverse().then(&to_frame(self)?).coefficients_as_written()
    }

    /// A layer's own transform under which its gizmo has these numbers: `None` if that is no map,
    /// inner `None` if none is left.
    pub fn transform(&self, document: &Document, layer: LayerId) -> Option<Option<LayerTransform>> {
        let gizmo = TransformGizmo::of(document, layer)?;
        // A mesh has no sides and angles.
        let own = document.layer(layer)?.transform.as_ref().filter(|own| own.mesh().is_none());
        let plane = own.map_or(Some(PlaneMap::IDENTITY), |own| own.map(document.size))?;
        let around = plane.inverse().then(&gizmo.plane);
        let low = gizmo.inner.low.as_dvec2();
        let (right, down) = self.sides();
        let (x, y) = (right / self.own.x, down / self.own.y);
        let from_low = PlaneMap::affine([x.x, x.y, y.x, y.y, self.at.x, self.at.y])?;
        let whole = PlaneMap::affine([1.0, 0.0, 0.0, 1.0, -low.x, -low.y])?.then(&from_low);
        let filter = own.map_or(gizmo.filter, |own| own.filter);
        to_storable(&whole.then(&around.inverse()), filter, document.size)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{mirror, transform_about_middle};
    use super::*;
    use crate::document::{Content, Layer, PixelLayer};
    use crate::math::Size;
    use crate::raster::TileGrid;
    use std::sync::Arc;

    fn document() -> Document {
        let tiles =
            TileGrid::from_straight_rgba(&[9, 90, 200, 255].repeat(40 * 20), 40, 20, 40, 30);
        let paint =
            Layer::new("paint", Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() }));
        Document { layers: vec![Arc::new(paint)], ..Document::empty(Size::new(200, 100)) }
    }

    fn numbers(document: &Document) -> GizmoNumbers {
        GizmoNumbers::of(&TransformGizmo::of(document, document.layers[0].id).unwrap()).unwrap()
    }

    fn with(document: &Document, numbers: &GizmoNumbers) -> Document {
        let id = document.layers[0].id;
        let transform = numbers.transform(document, id).unwrap();
        document.with_layer(id, |layer| layer.transform = transform).unwrap()
    }

    #[test]
    fn what_is_typed_is_what_the_frame_has() {
        let start = numbers(&document());
        assert_eq!((start.at, start.width, start.height), (DVec2::new(40.0, 30.0), 40.0, 20.0));
        assert!(start.angle.abs() < 1e-9 && start.skew.abs() < 1e-9);
        let wanted = GizmoNumbers {
            at: DVec2::new(12.0, 50.0),
            width: 60.0,
            height: 15.0,
            angle: 30.0,
            skew: -20.0,
            ..start
        };
        let found = numbers(&with(&document(), &wanted));
        let off = [
            (found.at - wanted.at).length(),
            found.width - wanted.width,
            found.height - wanted.height,
            found.angle - wanted.angle,
            found.skew - wanted.skew,
        ];
        assert!(off.iter().all(|off| off.abs() < 1e-3), "{found:?}");
        let back = with(&with(&document(), &wanted), &start);
        assert_eq!(back.layers[0].transform, None);
    }

    #[test]
    fn what_is_mirrored_has_a_negative_side_and_is_not_turned() {
        let start = numbers(&document());
        for (upright, sides) in [(false, [-40.0, 20.0]), (true, [40.0, -20.0])] {
            let document = document();
            let mirrored =
                transform_about_middle(&document, &[document.layers[0].id], mirror(upright))
                    .unwrap();
            let found = numbers(&mirrored);
            assert!(
                (found.width - sides[0]).abs() < 1e-3 && (found.height - sides[1]).abs() < 1e-3,
                "{found:?}"
            );
            assert!(found.angle.abs() < 1e-6 && found.angle.is_sign_positive(), "{found:?}");
            let skewed = GizmoNumbers { skew: 25.0, angle: 10.0, ..found };
            let again = numbers(&with(&mirrored, &skewed));
            assert!(
                (again.skew - 25.0).abs() < 1e-2 && (again.angle - 10.0).abs() < 1e-2,
                "{again:?}"
            );
            let back = GizmoNumbers { width: 40.0, height: 20.0, ..found }
                .align_pivot(Vec2::splat(0.5), &found);
            assert!((numbers(&with(&mirrored, &back)).at - start.at).length() < 1e-3);
        }
    }

    #[test]
    fn sides_and_angles_change_about_the_pivot() {
        let start = numbers(&document());
        for (share, stays) in
            [(Vec2::splat(0.5), DVec2::new(60.0, 40.0)), (Vec2::X, DVec2::new(80.0, 30.0))]
        {
            let turned =
                GizmoNumbers { angle: 90.0, width: 80.0, ..start }.align_pivot(share, &start);
            assert!((turned.point(share) - stays).length() < 1e-9);
            let found = numbers(&with(&document(), &turned));
            assert!((found.point(share) - stays).length() < 1e-3);
        }
    }

    #[test]
    fn the_map_from_one_frame_to_another_takes_its_corners_there() {
        let start = numbers(&document());
        let to = GizmoNumbers {
            at: DVec2::new(3.0, 4.0),
            width: 10.0,
            height: -30.0,
            angle: 40.0,
            ..start
        };
        let map = PlaneMap::affine(to.map_from(&start).unwrap()).unwrap();
        for share in [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE] {
            let went = map.to_canvas(start.point(share).as_vec2()).unwrap();
            assert!(went.distance(to.point(share).as_vec2()) < 1e-4, "{went}");
        }
    }
}
