//! The samples: a shape without a file, ready to be painted on, in several materials. Floor 7.
//! Made of formulas, so that nothing is downloaded and nothing is missing.

use crate::document::{Content, Document, Layer, Live};
use crate::math::{Size, Vec2, Vec3, srgb::Color, vec2, vec3};
use crate::paint::{Gradient, GradientStop, ImageFilter};
use crate::raster::Plane;
use crate::session::OpenDocument;
use crate::session::storage::OpenedFile;
use crate::shading::{Model, Shading};
use crate::surface::{Maps, Operator, Surface};
use crate::tour::{self, Tour};
use crate::{Error, Result};
use std::sync::Arc;

/// Of a sample, px.
const SIDE: usize = 640;

/// A sample of the start screen.
pub struct StartSample {
    pub name: &'static str,
    pub about: &'static str,
    /// The steps that are shown while it is in front.
    pub tour: &'static Tour,
    begins: SampleKind,
}

/// What a sample is, before anything is done to it.
enum SampleKind {
    /// A ball and a ring, with these layers on them, the lowest first.
    Shape(fn(Size) -> Vec<Layer>),
    /// A document so many pixels wide and high.
    Drawing(fn(usize) -> Result<Document>),
}

/// All samples; the first is the one of the Help menu.
pub static SAMPLES: [StartSample; 4] = [
    StartSample {
        name: "Ball and ring",
        about: "A shape with a gradient that follows it: drop a photo, paint highlights",
        tour: &tour::ON_A_SHAPE,
        begins: SampleKind::Shape(|size| vec![bent_gradient("Base", size, &CLAY, 0.6)]),
    },
    StartSample {
        name: "Chrome",
        about: "A horizon that is bent as metal reflects it",
        tour: &tour::ON_A_SHAPE,
        begins: SampleKind::Shape(|size| vec![bent_gradient("Chrome", size, &CHROME, 1.0)]),
    },
    StartSample {
        name: "In a painter's light",
        about: "Flat color under a lamp with shadows: move the light on the canvas (A)",
        tour: &tour::ON_A_SHAPE,
        begins: SampleKind::Shape(lit_layers),
    },
    StartSample {
        name: "A flat drawing",
        about: "Six steps make a finished picture of it",
        tour: &tour::FROM_A_DRAWING,
        begins: SampleKind::Drawing(tour::drawing),
    },
];
/// The place of the sample that the tour of the Help menu begins with.
pub const TOUR_SAMPLE: usize = 3;

/// Places in `[0, 1]` along a gradient, and their colors.
type Stops = [(f32, [u8; 3])];
const CLAY: [(f32, [u8; 3]); 3] =
    [(0.0, [0xc8, 0xa0, 0x78]), (0.55, [0x86, 0x56, 0x40]), (1.0, [0x36, 0x20, 0x22])];
const CHROME: [(f32, [u8; 3]); 6] = [
    (0.0, [0x5b, 0x8f, 0xc9]),
    (0.42, [0xe6, 0xf0, 0xfa]),
    (0.5, [0xff, 0xff, 0xff]),
    (0.53, [0x2a, 0x24, 0x22]),
    (0.7, [0x7a, 0x60, 0x48]),
    (1.0, [0xe8, 0xd8, 0xb8]),
];
/// The color under the painter's light.
const SKIN: Color = Color { r: 0xd8, g: 0x8c, b: 0x62, a: 255 };

impl StartSample {
    /// The sample as a document of its own.
    pub fn open(&self) -> Result<OpenedFile> {
        Ok(OpenedFile {
            open: OpenDocument::new("Sample", self.document(SIDE)?, None),
            notes: Vec::new(),
            drawing: None,
        })
    }

    /// The same, so many pixels wide and high.
    pub fn document(&self, side: usize) -> Result<Document> {
        let layers = match self.begins {
            SampleKind::Shape(layers) => layers,
            SampleKind::Drawing(drawing) => return drawing(side),
        };
        let surface = surface(side).map_err(|error| Error::unsupported_file("sample", error))?;
        let size = Size::new(side as u32, side as u32);
        let down = (vec2(0.0, 0.0), vec2(0.0, side as f32));
        let dark = [(0.0, [0x3a; 3]), (1.0, [0x24; 3])];
        let behind =
            Layer { clip_to_surface: false, ..gradient("Background", down, &dark, Operator::None) };
        let layers = std::iter::once(behind).chain(layers(size)).map(Arc::new).collect();
        Ok(Document { surface: Some(Arc::new(surface)), layers, ..Document::empty(size) })
    }
}

/// A gradient that follows the directions of the shape.
fn bent_gradient(name: &str, size: Size, stops: &Stops, alpha: f32) -> Layer {
    let ends = (vec2(0.30, 0.22) * size.width as f32, vec2(0.62, 0.74) * size.width as f32);
    gradient(name, ends, stops, Operator::Normal { alpha, beta: 1.0, detail: 0.0 })
}

fn gradient(name: &str, (from, to): (Vec2, Vec2), stops: &Stops, operator: Operator) -> Layer {
    let stop =
        |&(t, [r, g, b]): &(f32, [u8; 3])| GradientStop { t, color: Color { r, g, b, a: 255 } };
    let gradient = Gradient {
        from,
        to,
        stops: stops.iter().map(stop).collect(),
        operator,
        filter: ImageFilter::Antialias,
        frame: Default::default(),
        style: Default::default(),
        pieces: Vec::new(),
    };
    Layer::new(name, Content::Gradient(Live::new(gradient)))
}

/// A color, and a painter's light on it.
fn lit_layers(size: Size) -> Vec<Layer> {
    let mut light = Shading::fitting(Model::Painter, size);
    light.painter.beneath = true;
    vec![
        Layer::new("Color", Content::Fill(SKIN)),
        Layer::new(Model::Painter.label(), Content::Shading(Live::new(light))),
    ]
}

/// The places of the ball and the ring around it, in canvas lengths.
const BALL: (Vec2, f32) = (vec2(0.5, 0.43), 0.27);
const RING: (Vec2, f32, f32) = (vec2(0.5, 0.52), 0.36, 0.075);
/// How far the ring is tilted away: its vertical axis appears this much shorter.
const TILT: f32 = 0.34;

/// What the line of sight meets first.
#[derive(Clone, Copy)]
struct Seen {
    /// Toward the viewer, in canvas lengths.
    height: f32,
    /// Unit, camera space.
    normal: Vec3,
}

/// What is seen at a place; `None` off the shape.
fn hit_at(p: Vec2) -> Option<Seen> {
    ring(p).into_iter().chain(ball(p)).max_by(|a, b| a.height.total_cmp(&b.height))
}

/// The near side of a ball with ripples, so that there is detail to bring out.
fn ball(p: Vec2) -> Option<Seen> {
    // The squared height over the squared radius is smooth at the rim, and its slope (−2 n_x, 2
    // n_y) · height there.
    let squared = |q: Vec2| {
        let rest = 1.0 - q.length_squared();
        let ripple = 1.0 + 0.012 * (q.x * 17.0 + (q.y * 9.0).sin() * 1.4).sin() * rest.max(0.0);
        ripple * ripple * rest
    };
    let q = (p - BALL.0) / BALL.1;
    let height = Some(squared(q)).filter(|squared| *squared > 0.0)?.sqrt();
    let step = 2e-3;
    let slope = |d: Vec2| (squared(q + d * step) - squared(q - d * step)) / (2.0 * step);
    let normal = vec3(-0.5 * slope(Vec2::X), 0.5 * slope(Vec2::Y), height).normalize_or(Vec3::Z);
    Some(Seen { height: BALL.1 * height, normal })
}

/// The near surface of a tilted torus, found along the line of sight.
fn ring(p: Vec2) -> Option<Seen> {
    let (center, large, small) = RING;
    let q = p - center;
    if q.x.abs() > large + small || q.y.abs() > large * TILT + small {
        return None;
    }
    let (sin, cos) = ((1.0 - TILT * TILT).sqrt(), TILT);
    // The torus's own axes: its axis leans toward the viewer.
    let own = |z: f32| vec3(q.x, q.y * cos + z * sin, z * cos - q.y * sin);
    let outside = |z: f32| {
        let at = own(z);
        (at.truncate().length() - large).hypot(at.z) - small
    };
    let (outer, inner) = enter(&outside)?;
    let height = crossing(&outside, outer, inner);
    let on = own(height);
    let ahead = 1.0 - large / on.truncate().length();
    let (x, y, h) = (on.x * ahead, on.y * ahead, on.z);
    let normal = vec3(x, h * sin - y * cos, y * sin + h * cos).normalize_or(Vec3::Z);
    Some(Seen { height, normal })
}

/// Two places on a line of sight, one before a shape and one in it.
///
/// * `outside`: the distance from the shape; negative within.
fn enter(outside: &impl Fn(f32) -> f32) -> Option<(f32, f32)> {
    let (near, far, steps) = (0.42, -0.42, 72);
    let at = |i: i32| near + (far - near) * i as f32 / steps as f32;
    let step = (near - far) / steps as f32;
    let mut i = 0;
    while i < steps {
        let ahead = outside(at(i + 1));
        if ahead < 0.0 {
            return Some((at(i), at(i + 1)));
        }
        // Nothing is nearer than that, so these steps and one more meet nothing. Distances are
        // rounded.
        let free = ((0.999 * ahead - 1e-5) / step) as i32;
        if free > 0 {
            i += free;
            continue;
        }
        // At a rim the line of sight may enter and leave between two steps: near it, smaller steps
        // are taken.
        if ahead <= outside(at(i)).min(outside(at(i + 2))) {
            let nearest = lowest(outside, at(i), at(i + 2));
            if outside(nearest) < 0.0 {
                return Some((at(i), nearest));
            }
        }
        i += 1;
    }
    None
}

/// The minimum of a function that has one between two places.
fn lowest(f: &impl Fn(f32) -> f32, mut a: f32, mut b: f32) -> f32 {
    for _ in 0..24 {
        let (low, high) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
        if f(low) < f(high) { b = high } else { a = low }
    }
    0.5 * (a + b)
}

/// Where a function falls below 0 between two places.
fn crossing(f: &impl Fn(f32) -> f32, mut outer: f32, mut inner: f32) -> f32 {
    for _ in 0..24 {
        let middle = 0.5 * (outer + inner);
        if f(middle) < 0.0 { inner = middle } else { outer = middle }
    }
    inner
}

fn surface(side: usize) -> std::result::Result<Surface, crate::surface::SurfaceError> {
    let size = Size::new(side as u32, side as u32);
    let place = |x: usize, y: usize| vec2(x as f32 + 0.5, y as f32 + 0.5) / side as f32;
    let px = 1.0 / side as f32;
    // The line of sight is followed once for each pixel.
    let seen = Plane::from_fn(size, |x, y| hit_at(place(x, y)));
    let heights = seen.map(|seen| seen.map_or(f32::NEG_INFINITY, |seen| seen.height));
    let normals = seen.map(|seen| seen.map_or(Vec3::ZERO, |seen| seen.normal));
    let finite = |h: &f32| h.is_finite();
    let low = heights.values().iter().copied().filter(finite).fold(f32::INFINITY, f32::min);
    let high = heights.values().iter().copied().filter(finite).fold(f32::NEG_INFINITY, f32::max);
    let depth =
        heights.map(|h| if h.is_finite() { (high - h) / (high - low).max(1e-6) } else { f32::NAN });
    // Coverage: 8 × 8 places of each pixel at the rim.
    let coverage = Plane::from_fn(size, |x, y| {
        let is_on = |dx: i32, dy: i32| heights.at_clamped(x as i32 + dx, y as i32 + dy).is_finite();
        let on = [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)]
            .into_iter()
            .filter(|&(dx, dy)| is_on(dx, dy))
            .count();
        if on == 0 || on == 5 {
            return if on == 0 { 0 } else { 255 };
        }
        let here = place(x, y);
        let sub = |i: i32| ((i % 8) as f32 - 3.5) * px / 8.0;
        let covered =
            (0..64).filter(|&i| hit_at(here + vec2(sub(i), sub(i / 8))).is_some()).count();
        (covered * 255 / 64) as u8
    });
    Surface::new(Maps { normals, depth, coverage })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sample_opens_with_a_surface_that_faces_the_viewer_in_its_middle() {
        let opened = SAMPLES[0].open().unwrap();
        let surface = opened.open.document().surface.clone().unwrap();
        let middle = (BALL.0 * SIDE as f32).as_uvec2();
        let n = surface.normal(middle.x as usize, middle.y as usize);
        assert!(n.z > 0.9, "{n}");
        assert!(!opened.open.is_dirty(), "there is nothing to save yet");
    }

    #[test]
    fn the_steps_that_are_left_out_meet_nothing() {
        let each = |outside: &dyn Fn(f32) -> f32| {
            let at = |i: i32| 0.42 - 0.84 * i as f32 / 72.0;
            (0..72).find(|&i| {
                let nearest = lowest(&outside, at(i), at(i + 2));
                outside(at(i + 1)) < 0.0 || outside(nearest) < 0.0
            })
        };
        for i in 0..64 * 64 {
            let q = vec2((i % 64) as f32, (i / 64) as f32) / 64.0 - 0.5;
            let outside = |z: f32| {
                (vec2(q.x, 0.4 * q.y + 0.9 * z).length() - 0.3).hypot(0.9 * q.y - 0.4 * z) - 0.1
            };
            assert_eq!(enter(&outside).is_some(), each(&outside).is_some(), "{q}");
        }
    }

    #[test]
    fn the_ring_ends_before_the_ball_in_a_clean_line() {
        let surface = surface(SIDE).unwrap();
        let is_ring = |at: Vec2| {
            ring(at).is_some_and(|ring| ball(at).is_none_or(|ball| ball.height < ring.height))
        };
        // Left and right of these the ring ends in front of itself.
        let between = 150..490;
        let contours = surface.contours().pixels().iter();
        let before_ball =
            contours.filter(|pixel| pixel.is_other_on_surface() && between.contains(&pixel.x));
        let errors: Vec<f32> = before_ball
            .map(|pixel| {
                let px = |v: i32, i: i32| (v as f32 + (i as f32 + 0.5) / 16.0) / SIDE as f32;
                let places = (0..256).map(|i| vec2(px(pixel.x, i % 16), px(pixel.y, i / 16)));
                let on_ring = places.filter(|at| is_ring(*at)).count() as f32 / 256.0;
                let own_is_ring = is_ring(vec2(px(pixel.x, 8), px(pixel.y, 8)));
                (pixel.share - if own_is_ring { on_ring } else { 1.0 - on_ring }).abs()
            })
            .collect();
        let mean = errors.iter().sum::<f32>() / errors.len() as f32;
        let worst = errors.iter().copied().fold(0.0, f32::max);
        assert!(
            errors.len() > 300 && mean < 0.015 && worst < 0.08,
            "{} pixels: {mean}, {worst}",
            errors.len()
        );
    }
}
