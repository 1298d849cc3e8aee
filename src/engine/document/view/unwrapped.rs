//! The unwrapped view: a painting as it lies in the plane of the surface. A picture painted there, placed where the
//! view says and bent by D_s, lies on the surface where it was seen. Floor 4.

use super::ViewUnavailable;
use crate::document::{Document, Layer, Progress, flatten, flatten_layer};
use crate::math::{Rect, Size, Vec2, srgb::quantise, vec2};
use crate::paint::Placement;
use crate::raster::Picture;
use crate::surface::deformation::DeformedRect;
use crate::surface::unwrap::PlaneView;
use crate::surface::{Bend, Deformation, Operator};

/// The painting in the plane, and the placement that lays the same picture back: an image layer with it, the same
/// operator and the same anchors (`"anchors": []` for the whole painting) shows it where it was.
///
/// `layer`: shows that layer alone, in the plane as its own operator and anchors lay it if it is bent by D_s.
pub fn unwrapped(document: &Document, layer: Option<&Layer>) -> Result<(Picture, Placement), ViewUnavailable> {
    let surface = document.surface.as_deref().ok_or(ViewUnavailable::NoSurface)?;
    let plain = || Bend { operator: Operator::Surface { amount: 1.0, smooth: 0.0 }, ..Bend::default() };
    let own = layer.and_then(|layer| layer.content.bend()).filter(|bend| bend.operator.unwrapping().is_some());
    let bend = own.unwrap_or_else(plain);
    let mut deformed = DeformedRect::default();
    Deformation::new(Some(surface), document.size, &bend).fill(document.size.rect(), &mut deformed);
    let view = PlaneView::of(surface, &deformed).ok_or(ViewUnavailable::NothingUnwrapped)?;
    drop(deformed);
    let progress = Progress::default();
    let painting = match layer {
        Some(layer) => flatten_layer(document, layer.id, &progress),
        None => flatten(document, &progress),
    };
    let painting = painting.ok_or(ViewUnavailable::NoMemory)?.to_straight_rgba(document.size.rect());
    let size = Size::new(view.rect.width() as u32, view.rect.height() as u32);
    let texels = view.points.iter().map(|&point| between(&painting, document.size, point)).collect();
    let picture = Picture::srgb8(size, texels).ok_or(ViewUnavailable::NoMemory)?;
    Ok((picture, placed(view.rect, document.size)))
}

/// The placement that shows a picture pixel for pixel over a rectangle of the plane.
fn placed(rect: Rect, canvas: Size) -> Placement {
    let (w, h) = (rect.width() as f32, rect.height() as f32);
    let cover = (canvas.width as f32 / w).max(canvas.height as f32 / h);
    Placement {
        center: vec2(rect.x0 as f32 + 0.5 * w, rect.y0 as f32 + 0.5 * h),
        scale: (1.0 / cover).max(*Placement::SCALE.start()).min(*Placement::SCALE.end()),
        rotation: 0.0,
    }
}

/// The colour between four pixels, weighed by their alpha; transparent where there is no point.
fn between(painting: &[u8], size: Size, point: Vec2) -> [u8; 4] {
    if !point.is_finite() {
        return [0; 4];
    }
    let at = (point - 0.5).max(Vec2::ZERO);
    let (corner, share) = (at.floor(), at.fract());
    let mut sum = [0.0f32; 4];
    for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let x = (corner.x as usize + dx).min(size.width as usize - 1);
        let y = (corner.y as usize + dy).min(size.height as usize - 1);
        let weight = [1.0 - share.x, share.x][dx] * [1.0 - share.y, share.y][dy];
        let texel = &painting[(y * size.width as usize + x) * 4..][..4];
        let alpha = weight * f32::from(texel[3]) / 255.0;
        sum[3] += alpha;
        for c in 0..3 {
            sum[c] += alpha * f32::from(texel[c]) / 255.0;
        }
    }
    let straight = |v: f32| quantise(v / sum[3].max(1e-6));
    [straight(sum[0]), straight(sum[1]), straight(sum[2]), quantise(sum[3])]
}
