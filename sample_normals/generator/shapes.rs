//! The sample objects, one function each: what they are made of and how they are framed. Not here:
//! the medal (`medal`), the snail (`snail`), the sculpted head (`muse`), the draped cloth
//! (`cloth`), how they are traced (`render`).

use std::f64::consts::TAU;

use glam::{DVec2, DVec3, DVec4};

use crate::noise::{fbm3, hash};
use crate::render::{Hit, Surface, Traced, View};
use crate::sdf::{
    capsule, carve, cylinder, ellipsoid, object_from_camera, rounded_box, smooth_max, smooth_min,
    smooth_step, sphere, torus, v,
};
use crate::tube::Tube;

/// A surface, its folder's name and its framing.
pub struct Sample {
    pub name: &'static str,
    pub surface: Box<dyn Surface>,
    pub view: View,
}

/// Frames `surface`: a picture of `width` × `height` whose center and half width are in model
/// units.
pub fn framed(
    name: &'static str,
    surface: impl Surface + 'static,
    (width, height): (usize, usize),
    center: DVec2,
    half_width: f64,
) -> Sample {
    Sample { name, surface: Box::new(surface), view: View { width, height, center, half_width } }
}

pub fn traced(
    distance: impl Fn(DVec3) -> f64 + Sync + 'static,
    stride: f64,
) -> impl Surface + 'static {
    Traced { distance, reach: 2.5, stride }
}

pub fn points(list: &[[f64; 4]]) -> Vec<DVec4> {
    list.iter().map(|p| DVec4::from_array(*p)).collect()
}

/// The unit sphere, in closed form.
struct Ball;

impl Surface for Ball {
    fn hit(&self, at: DVec2, _top: f64) -> Option<Hit> {
        let z2 = 1.0 - at.length_squared();
        (z2 > 0.0).then(|| Hit { z: z2.sqrt(), normal: at.extend(z2.sqrt()) })
    }
}

/// A sphere, exact: the reference for every operator.
pub fn ball() -> Sample {
    framed("sphere", Ball, (480, 480), DVec2::ZERO, 1.06)
}

/// An apple with its stem and a leaf.
pub fn apple() -> Sample {
    let turn = object_from_camera(-18.0, 24.0, 7.0);
    let stem = Tube::through(&points(&[
        [0.0, 0.22, 0.0, 0.035],
        [0.01, 0.5, 0.0, 0.027],
        [0.06, 0.72, 0.02, 0.03],
        [0.15, 0.88, 0.04, 0.048],
    ]));
    let distance = move |camera: DVec3| {
        let p = turn * camera;
        let stalk = stem.distance(p);
        smooth_min(smooth_min(apple_flesh(p), stalk, 0.03), leaf(p), 0.025)
    };
    framed("apple", traced(distance, 0.75), (480, 512), DVec2::new(0.05, 0.12), 0.98)
}

/// A spindle torus, narrower below, with the five soft lobes of the calyx end.
fn apple_flesh(p: DVec3) -> f64 {
    let taper = 1.0 + 0.16 * (0.25 - p.y);
    let radial =
        DVec2::new(p.x, p.z).length() * (1.0 + 0.16 * (taper - 1.0).max(-0.5)) * taper.max(0.6);
    let angle = p.z.atan2(p.x);
    let lobes =
        0.014 * (5.0 * angle).cos() * smooth_step(0.2, -0.8, p.y) * smooth_step(0.0, 0.3, radial);
    let swell = 0.014 * (2.0 * angle + 0.7).cos() * smooth_step(0.0, 0.3, radial);
    let flesh = DVec2::new((radial * radial + 0.0016).sqrt() - 0.3, (p.y + 0.05) * 0.86).length()
        - 0.5
        - swell
        - lobes;
    flesh * 0.9
}

/// A leaf on the stem: a thin bent lens with a midrib.
fn leaf(p: DVec3) -> f64 {
    let q = p - v(0.08, 0.68, 0.04);
    if q.length() > 1.0 {
        return q.length() - 0.8;
    }
    let local = object_from_camera(18.0, 24.0, 14.0) * q;
    let along = local.x - 0.3;
    let bent = v(
        along,
        local.y + 0.75 * along * along - 0.07 - 0.4 * (local.z * local.z + 2e-4).sqrt(),
        local.z,
    );
    let veins = 0.006
        * (70.0 * (along * 0.75 - local.z.abs() * 0.6)).sin()
        * smooth_step(0.0, 0.05, local.z.abs());
    let width = 0.17 * (1.0 - 0.55 * along);
    let lens = ellipsoid(bent, v(0.36, 0.036, width)) + veins * 0.5;
    lens * 0.7
}

/// A ribbed teapot under glaze.
pub fn teapot() -> Sample {
    let turn = object_from_camera(24.0, 17.0, 0.0);
    let spout = Tube::through(&points(&[
        [0.36, -0.26, 0.0, 0.17],
        [0.62, -0.18, 0.0, 0.135],
        [0.8, 0.08, 0.0, 0.095],
        [0.9, 0.33, 0.0, 0.078],
        [1.04, 0.47, 0.0, 0.07],
    ]));
    let handle = Tube::through(&points(&[
        [-0.45, 0.2, 0.0, 0.07],
        [-0.68, 0.38, 0.0, 0.058],
        [-0.93, 0.33, 0.0, 0.056],
        [-1.02, 0.05, 0.0, 0.056],
        [-0.88, -0.24, 0.0, 0.054],
        [-0.52, -0.38, 0.0, 0.068],
    ]));
    let distance = move |camera: DVec3| {
        let p = turn * camera;
        let grip = smooth_min(teapot_body(p), handle.distance(p), 0.1);
        let bore = capsule(p, v(0.86, 0.28, 0.0), v(1.12, 0.6, 0.0), 0.03, 0.06);
        let pour = carve(spout.distance(p), bore, 0.02);
        smooth_min(smooth_min(grip, pour, 0.12), teapot_lid(p), 0.012)
    };
    framed("teapot", traced(distance, 0.8), (560, 432), DVec2::new(0.0, -0.02), 1.16)
}

fn teapot_body(p: DVec3) -> f64 {
    let angle = p.z.atan2(p.x);
    let radial = DVec2::new(p.x, p.z).length();
    // Melon ribs: rounded lobes with a narrow valley, fading out at the shoulder and the foot.
    let fade = smooth_step(-0.5, -0.25, p.y)
        * smooth_step(0.36, 0.12, p.y)
        * smooth_step(0.1, 0.4, radial);
    let ribs = 0.03 * fade * (((7.0 * angle).sin().powi(2) + 0.02).sqrt() - 0.6);
    let belly = ellipsoid(p - v(0.0, -0.1, 0.0), v(0.62, 0.47, 0.62)) - ribs;
    let foot = cylinder(p - v(0.0, -0.56, 0.0), 0.34, 0.05, 0.03);
    let collar = torus(p - v(0.0, 0.33, 0.0), 0.3, 0.035);
    smooth_min(smooth_min(belly, foot, 0.09), collar, 0.05)
}

fn teapot_lid(p: DVec3) -> f64 {
    let dome = ellipsoid(p - v(0.0, 0.34, 0.0), v(0.285, 0.135, 0.285));
    let neck = capsule(p, v(0.0, 0.44, 0.0), v(0.0, 0.56, 0.0), 0.05, 0.035);
    let knob = ellipsoid(p - v(0.0, 0.61, 0.0), v(0.1, 0.078, 0.1));
    smooth_min(smooth_min(dome, neck, 0.07), knob, 0.035)
}

/// Solids that overlap in the picture and are far apart in depth.
pub fn still_life() -> Sample {
    let turn = object_from_camera(-14.0, 16.0, 0.0);
    let distance = move |camera: DVec3| {
        let p = turn * camera;
        let ring = object_from_camera(28.0, 78.0, 16.0) * (p - v(-0.28, 0.1, 0.1));
        let block = object_from_camera(34.0, 0.0, 0.0) * (p - v(-0.72, -0.5, -0.75));
        let column = cylinder(p - v(0.46, -0.02, -1.0), 0.27, 0.86, 0.05);
        let flutes = 0.018
            * (12.0 * (p.z + 1.0).atan2(p.x - 0.46)).cos()
            * smooth_step(0.86, 0.7, (p.y + 0.02).abs());
        let pieces = [
            torus(ring, 0.56, 0.15),
            sphere(p - v(0.3, -0.5, 0.75), 0.36),
            rounded_box(block, v(0.33, 0.4, 0.33), 0.06),
            (column + flutes) * 0.8,
            cone(p - v(0.93, -0.52, -0.1)),
            sphere(p - v(-0.62, -0.7, 0.82), 0.19),
            ellipsoid(p - v(-0.72, 0.2, -0.75), v(0.22, 0.3, 0.22)),
        ];
        pieces.into_iter().fold(f64::INFINITY, f64::min)
    };
    framed("still_life", traced(distance, 0.9), (540, 480), DVec2::new(0.06, -0.02), 1.24)
}

/// A cone on its base, apex up, rounded.
fn cone(p: DVec3) -> f64 {
    let radial = DVec2::new(p.x, p.z).length();
    let side = DVec2::new(radial, p.y - 0.62).dot(DVec2::new(0.949, 0.316));
    smooth_max(side, -p.y - 0.38, 0.06)
}

/// A trefoil knot: a chrome piece with curvature of every sign.
pub fn knot() -> Sample {
    let turn = object_from_camera(18.0, 20.0, 8.0);
    let control: Vec<DVec4> = (0..60)
        .map(|i| {
            let t = f64::from(i) / 60.0 * TAU;
            let at = v(
                t.sin() + 2.0 * (2.0 * t).sin(),
                t.cos() - 2.0 * (2.0 * t).cos(),
                -1.25 * (3.0 * t).sin(),
            );
            (at * 0.3).extend(0.195 + 0.025 * (3.0 * t + 0.6).cos())
        })
        .collect();
    let tube = Tube::closed(&control);
    let distance = move |camera: DVec3| tube.distance(turn * camera);
    framed("knot", traced(distance, 0.98), (496, 496), DVec2::new(-0.06, -0.1), 1.04)
}

/// The program's name in one inflated stroke.
pub fn lettering() -> Sample {
    let stem = Tube::through(&heavier(&points(&[
        [0.42, 2.02, 0.0, 0.17],
        [0.34, 1.5, 0.0, 0.19],
        [0.26, 0.9, 0.0, 0.2],
        [0.17, 0.3, 0.0, 0.19],
        [0.02, 0.0, 0.0, 0.17],
        [-0.25, -0.02, 0.02, 0.13],
        [-0.38, 0.2, 0.04, 0.1],
    ])));
    let run = Tube::through(&heavier(&points(&LETTER_RUN)));
    let dots = [v(2.24, 1.52, 0.05), v(4.04, 1.52, 0.05)];
    let middle = v(3.45, 1.0, 0.0);
    let distance = move |camera: DVec3| {
        let p = camera + middle;
        let strokes = smooth_min(stem.distance(p), run.distance(p), 0.06);
        dots.iter().map(|dot| sphere(p - *dot, 0.22)).fold(strokes, f64::min)
    };
    framed("lettering", traced(distance, 0.95), (640, 272), DVec2::new(0.0, 0.05), 4.25)
}

/// Strokes as drawn, with more body.
fn heavier(stroke: &[DVec4]) -> Vec<DVec4> {
    stroke.iter().map(|p| p.truncate().extend(p.w * 1.16)).collect()
}

/// The stroke of "R" after its stem, and of "ilievo": x, y, lift, radius. Thin going up, full
/// coming down; where the stroke crosses itself the later pass lies on top.
const LETTER_RUN: [[f64; 4]; 54] = [
    [-0.3, 1.55, 0.1, 0.1],
    [-0.28, 1.9, 0.14, 0.13],
    [0.1, 2.14, 0.2, 0.16],
    [0.6, 2.18, 0.16, 0.18],
    [1.02, 1.95, 0.08, 0.19],
    [1.08, 1.5, 0.06, 0.19],
    [0.78, 1.18, 0.1, 0.16],
    [0.4, 1.1, 0.16, 0.12],
    [0.66, 0.9, 0.12, 0.14],
    [0.95, 0.45, 0.06, 0.18],
    [1.22, 0.08, 0.02, 0.18],
    [1.56, 0.08, 0.0, 0.13],
    // i
    [1.86, 0.5, 0.0, 0.1],
    [2.12, 0.98, 0.02, 0.13],
    [2.12, 0.6, 0.04, 0.17],
    [2.14, 0.2, 0.02, 0.17],
    [2.38, 0.04, 0.0, 0.14],
    [2.64, 0.34, -0.04, 0.1],
    // l
    [2.92, 0.95, -0.1, 0.1],
    [3.13, 1.65, -0.06, 0.12],
    [3.08, 2.06, 0.02, 0.14],
    [2.86, 2.04, 0.1, 0.16],
    [2.78, 1.5, 0.14, 0.18],
    [2.82, 0.8, 0.14, 0.18],
    [2.92, 0.22, 0.06, 0.17],
    [3.2, 0.02, 0.0, 0.14],
    // i
    [3.58, 0.4, 0.0, 0.1],
    [3.92, 0.98, 0.02, 0.13],
    [3.92, 0.6, 0.04, 0.17],
    [3.94, 0.2, 0.02, 0.17],
    [4.18, 0.04, 0.0, 0.14],
    [4.46, 0.3, -0.04, 0.1],
    // e
    [4.86, 0.62, -0.08, 0.11],
    [5.04, 0.9, -0.02, 0.13],
    [4.82, 1.08, 0.06, 0.15],
    [4.58, 0.78, 0.12, 0.18],
    [4.6, 0.28, 0.1, 0.18],
    [4.9, 0.02, 0.04, 0.16],
    [5.24, 0.24, 0.0, 0.11],
    // v
    [5.44, 0.8, 0.0, 0.11],
    [5.6, 1.02, 0.02, 0.13],
    [5.72, 0.74, 0.04, 0.17],
    [5.86, 0.2, 0.04, 0.17],
    [6.02, 0.06, 0.04, 0.15],
    [6.2, 0.5, 0.02, 0.11],
    [6.3, 0.98, 0.0, 0.12],
    [6.52, 0.86, -0.04, 0.1],
    // o
    [6.84, 1.06, -0.08, 0.12],
    [6.56, 0.78, 0.1, 0.17],
    [6.56, 0.26, 0.12, 0.18],
    [6.9, 0.02, 0.06, 0.17],
    [7.2, 0.34, 0.0, 0.16],
    [7.14, 0.86, 0.02, 0.15],
    [6.92, 1.08, 0.1, 0.13],
];

/// A cratered moon.
pub fn moon() -> Sample {
    let craters = craters();
    let distance = move |p: DVec3| {
        let r = p.length();
        if r > 1.1 {
            return r - 1.03;
        }
        let dir = p / r.max(1e-6);
        let plains = smooth_step(-0.12, 0.2, fbm3(dir * 1.4 + DVec3::splat(4.0), 3, 77));
        let rough = 0.014 * fbm3(dir * 7.0, 4, 9) * (0.35 + 0.65 * plains);
        r - 1.0
            - rough
            - craters.iter().map(|c| c.height(dir)).sum::<f64>() * (0.45 + 0.55 * plains)
    };
    framed("moon", traced(distance, 0.8), (480, 480), DVec2::ZERO, 1.07)
}

struct Crater {
    center: DVec3,
    /// Angular radius, radians.
    radius: f64,
}

impl Crater {
    /// Bowl, rim and a central peak for the large ones.
    fn height(&self, dir: DVec3) -> f64 {
        let apart = dir.distance_squared(self.center) / (self.radius * self.radius);
        if apart > 2.2 * 2.2 {
            return 0.0;
        }
        let chord = apart.sqrt();
        let bowl = -0.3 * smooth_step(1.0, 0.35, chord);
        let rim = 0.12 * (-((chord - 1.02) / 0.2).powi(2)).exp() * smooth_step(2.2, 1.4, chord);
        let peak = if self.radius > 0.11 { 0.14 * (-(chord / 0.17).powi(2)).exp() } else { 0.0 };
        // Large craters are flatter for their size than small ones.
        (bowl + rim + peak) * self.radius * (0.9 - 1.6 * self.radius).max(0.35)
    }
}

/// Many small craters, few large ones, spread evenly over the sphere.
fn craters() -> Vec<Crater> {
    (0..260)
        .map(|i| {
            let pick = |seed: u64| hash(i, 7, seed);
            let z = 2.0 * pick(1) - 1.0;
            let ring = (1.0 - z * z).sqrt();
            let angle = TAU * pick(2);
            let radius = (0.028 * (1.0 - 0.985 * pick(3)).powf(-0.55)).min(0.26);
            Crater { center: v(ring * angle.cos(), ring * angle.sin(), z), radius }
        })
        .filter(|crater| crater.center.z > -0.6)
        .collect()
}
