//! The sample that a first start opens: a bust's worth of shape without a file, ready to be painted on.
//! Floor 7. Made of formulas, so that nothing is downloaded and nothing is missing.

use crate::document::{Content, Document, Layer, Live};
use crate::math::{Size, Vec2, srgb::Color, vec2, vec3};
use crate::paint::{Gradient, GradientStop, ImageFilter};
use crate::raster::Plane;
use crate::session::OpenDocument;
use crate::session::storage::OpenedTab;
use crate::surface::{Maps, Operator, Surface};
use crate::{Error, Result};
use std::sync::Arc;

const SIDE: usize = 640;

/// The sample as a document of its own.
pub fn open() -> Result<OpenedTab> {
    let surface = surface().map_err(|error| Error::unsupported("sample", error))?;
    let background = Gradient {
        from: vec2(0.0, 0.0),
        to: vec2(0.0, SIDE as f32),
        stops: vec![GradientStop { t: 0.0, color: grey(0x3a) }, GradientStop { t: 1.0, color: grey(0x24) }],
        operator: Operator::None,
        filter: ImageFilter::Antialias,
        frame: Default::default(),
    };
    let clay = Gradient {
        from: vec2(0.30, 0.22) * SIDE as f32,
        to: vec2(0.62, 0.74) * SIDE as f32,
        stops: vec![
            GradientStop { t: 0.0, color: Color { r: 0xc8, g: 0xa0, b: 0x78, a: 255 } },
            GradientStop { t: 0.55, color: Color { r: 0x86, g: 0x56, b: 0x40, a: 255 } },
            GradientStop { t: 1.0, color: Color { r: 0x36, g: 0x20, b: 0x22, a: 255 } },
        ],
        operator: Operator::Normal { alpha: 0.6, beta: 1.0, detail: 0.0 },
        filter: ImageFilter::Antialias,
        frame: Default::default(),
    };
    let behind = Layer { clip_to_surface: false, ..Layer::new("Background", Content::Gradient(Live::new(background))) };
    let layers = vec![Arc::new(behind), Arc::new(Layer::new("Base", Content::Gradient(Live::new(clay))))];
    let size = Size::new(SIDE as u32, SIDE as u32);
    let document = Document { surface: Some(Arc::new(surface)), layers, ..Document::empty(size) };
    Ok(OpenedTab { tab: OpenDocument::new("Sample", document, None), notes: Vec::new(), drawing: None })
}

fn grey(v: u8) -> Color {
    Color { r: v, g: v, b: v, a: 255 }
}

/// Where the ball and the ring around it stand, in canvas lengths.
const BALL: (Vec2, f32) = (vec2(0.5, 0.43), 0.27);
const RING: (Vec2, f32, f32) = (vec2(0.5, 0.52), 0.36, 0.075);
/// How far the ring is tilted away: its vertical axis is seen this much shorter.
const TILT: f32 = 0.34;

/// Height toward the viewer at a place, in canvas lengths; `None` off the shape.
fn height(p: Vec2) -> Option<f32> {
    let ball = {
        let q = (p - BALL.0) / BALL.1;
        // A ripple, so that there is detail to bring out.
        let ripple = 1.0 + 0.012 * (q.x * 17.0 + (q.y * 9.0).sin() * 1.4).sin() * (1.0 - q.length_squared()).max(0.0);
        (q.length_squared() < 1.0).then(|| BALL.1 * ripple * (1.0 - q.length_squared()).sqrt())
    };
    ring(p).into_iter().chain(ball).max_by(f32::total_cmp)
}

/// The near surface of a tilted torus, found along the line of sight.
fn ring(p: Vec2) -> Option<f32> {
    let (center, large, small) = RING;
    let beside = (p - center).abs();
    if beside.x > large + small || beside.y > large * TILT + small {
        return None;
    }
    let (sin, cos) = ((1.0 - TILT * TILT).sqrt(), TILT);
    let inside = |z: f32| {
        let q = p - center;
        // The torus's own axes: its axis leans toward the viewer.
        let (x, y, h) = (q.x, q.y * cos + z * sin, z * cos - q.y * sin);
        (vec2(x, y).length() - large).hypot(h) - small
    };
    let (near, far, steps) = (0.42, -0.42, 72);
    let at = |i: usize| near + (far - near) * i as f32 / steps as f32;
    let hit = (0..steps).find(|&i| inside(at(i + 1)) < 0.0)?;
    let (mut outer, mut inner) = (at(hit), at(hit + 1));
    for _ in 0..14 {
        let middle = 0.5 * (outer + inner);
        if inside(middle) < 0.0 { inner = middle } else { outer = middle }
    }
    Some(inner)
}

fn surface() -> std::result::Result<Surface, crate::surface::SurfaceError> {
    let size = Size::new(SIDE as u32, SIDE as u32);
    let place = |x: usize, y: usize| vec2(x as f32 + 0.5, y as f32 + 0.5) / SIDE as f32;
    let heights = Plane::from_fn(size, |x, y| height(place(x, y)).unwrap_or(f32::NEG_INFINITY));
    let px = 1.0 / SIDE as f32;
    // Derivatives from differences a quarter pixel wide, one-sided where the shape ends or jumps.
    let normals = Plane::from_fn(size, |x, y| {
        let (p, here) = (place(x, y), heights.at(x, y));
        if !here.is_finite() {
            return vec3(0.0, 0.0, 0.0);
        }
        let step = 0.25 * px;
        let slope = |d: Vec2| {
            let side = |s: f32| height(p + d * s).map(|h| (h - here) / s).filter(|v| v.abs() < 60.0);
            match (side(step), side(-step)) {
                (Some(a), Some(b)) => {
                    if a.abs() < b.abs() {
                        a
                    } else {
                        b
                    }
                }
                (Some(a), None) | (None, Some(a)) => a,
                (None, None) => 0.0,
            }
        };
        let (dx, dy) = (slope(vec2(1.0, 0.0)), slope(vec2(0.0, 1.0)));
        vec3(-dx, dy, 1.0).normalize_or_zero()
    });
    let finite = |h: &f32| h.is_finite();
    let low = heights.values().iter().copied().filter(finite).fold(f32::INFINITY, f32::min);
    let high = heights.values().iter().copied().filter(finite).fold(f32::NEG_INFINITY, f32::max);
    let depth = heights.map(|h| if h.is_finite() { (high - h) / (high - low).max(1e-6) } else { f32::NAN });
    // Coverage: 3 × 3 places of each pixel at the rim.
    let coverage = Plane::from_fn(size, |x, y| {
        let is_on = |dx: i32, dy: i32| heights.clamped(x as i32 + dx, y as i32 + dy).is_finite();
        let on = [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)].into_iter().filter(|&(dx, dy)| is_on(dx, dy)).count();
        if on == 0 || on == 5 {
            return if on == 0 { 0 } else { 255 };
        }
        let here = place(x, y);
        let sub = |i: i32| (i % 3 - 1) as f32 * px / 3.0;
        let covered = (0..9).filter(|&i| height(here + vec2(sub(i), sub(i / 3))).is_some()).count();
        (covered * 255 / 9) as u8
    });
    Surface::new(Maps { normals, depth, coverage })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sample_opens_with_a_surface_that_faces_the_viewer_in_its_middle() {
        let opened = open().unwrap();
        let surface = opened.tab.document().surface.clone().unwrap();
        let middle = (BALL.0 * SIDE as f32).as_uvec2();
        let n = surface.normal(middle.x as usize, middle.y as usize);
        assert!(n.z > 0.9, "{n}");
        assert!(!opened.tab.is_dirty(), "there is nothing to save yet");
    }
}
