//! What two versions of a part have in common, so that it is not made again. Floor 4.

use super::outlines::OutlineKey;
use super::{Part, PartKind};
use crate::math::Affine2;
use crate::surface::Surface;
use std::sync::Arc;

/// The matrix without its whole px, and these.
pub fn split_whole_px(matrix: Affine2) -> (Affine2, (i32, i32)) {
    let whole = matrix.translation.floor();
    let still = Affine2 { translation: matrix.translation - whole, ..matrix };
    (still, (whole.x as i32, whole.y as i32))
}

pub fn are_same_parts(a: &[Arc<Part>], b: &[Arc<Part>]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| Arc::ptr_eq(a, b) || a == b)
}

pub fn are_same_inks(a: &[OutlineKey], b: &[OutlineKey]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.is_same(b))
}

/// Whether two versions of a part have the same form, wherever it is.
pub fn is_same_shape(a: &Arc<Part>, b: &Arc<Part>) -> bool {
    Arc::ptr_eq(a, b)
        || (is_same_kind(&a.kind, &b.kind) && a.tilt_deg == b.tilt_deg && a.raise == b.raise)
}

/// Whether two kinds make the same of one outline, whatever its name.
pub fn is_same_kind(a: &PartKind, b: &PartKind) -> bool {
    match (a, b) {
        (PartKind::Inflate { inflation: a, .. }, PartKind::Inflate { inflation: b, .. }) => a == b,
        (PartKind::Bevel { bevel: a, .. }, PartKind::Bevel { bevel: b, .. }) => a == b,
        (PartKind::Lathe { axis: a, puff: x, .. }, PartKind::Lathe { axis: b, puff: y, .. }) => {
            a == b && x == y
        }
        _ => a == b,
    }
}

/// The very same surface, or none twice.
pub fn is_same_surface(a: &Option<Arc<Surface>>, b: &Option<Arc<Surface>>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => Arc::ptr_eq(a, b),
        (a, b) => a.is_none() && b.is_none(),
    }
}
