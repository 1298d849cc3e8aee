//! Primitives: bodies whose heights and normals are known exactly, seen along the z axis.
//! Floor 3. Inflated shapes are tested against them, too.

use super::Form;
use crate::math::{Mat3, Range, Size, TURNS, Vec2, Vec3, vec2, vec3};
use crate::raster::Plane;

crate::named! {
    /// Which body, each with the numbers of a [`Primitive`] that it uses.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Body {
        /// `radius`.
        Sphere = "sphere",
        /// `half`: its half axes.
        Ellipsoid = "ellipsoid",
        /// `radius`, `length` along its axis (y before it is turned).
        Cylinder = "cylinder",
        /// As a cylinder; its tip is up.
        Cone = "cone",
        /// `length`: between the middles of its ends.
        Capsule = "capsule",
        /// `radius` of its ring, which faces the viewer before it is turned, and `tube` around it.
        Torus = "torus",
        /// `half`: half of each side; `round`: the radius of its edges.
        Box = "box",
    }
}

impl Body {}

/// A body on the canvas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Primitive {
    /// Which body it is.
    pub body: Body,
    /// Canvas px.
    pub center: Vec2,
    /// px.
    pub radius: f32,
    /// Half the axes of an ellipsoid or the sides of a box, px.
    pub half: Vec3,
    /// The length of a cylinder, a cone or a capsule, px.
    pub length: f32,
    /// The radius of a torus's tube, px.
    pub tube: f32,
    /// The radius of rounded edges, px.
    pub round: f32,
    /// Degrees about x, then y, then z (camera space, y up), counter-clockwise.
    pub turn_deg: Vec3,
}

impl Primitive {
    /// Lengths, px.
    pub const LENGTH: Range = 0.5..=8192.0;
    /// What `round` may be, px.
    pub const ROUND: Range = 0.0..=8192.0;
    /// What a turn may be, degrees.
    pub const TURN: Range = TURNS;

    /// A body of a visible size.
    pub fn new(body: Body, center: Vec2, radius: f32) -> Self {
        let half = Vec3::splat(radius);
        let (length, tube, round) = (2.0 * radius, 0.3 * radius, 0.1 * radius);
        Self { body, center, radius, half, length, tube, round, turn_deg: Vec3::ZERO }
    }

    /// Visible height (px, toward the viewer, 0 at the body's middle) and unit normal (camera
    /// space) at a canvas point; `None` off the body.
    pub fn surface_at(&self, p: Vec2) -> Option<(f32, Vec3)> {
        self.hit_at(self.turn(), p)
    }

    fn turn(&self) -> Mat3 {
        let turn = self.turn_deg * std::f32::consts::PI / 180.0;
        Mat3::from_rotation_z(turn.z)
            * Mat3::from_rotation_y(turn.y)
            * Mat3::from_rotation_x(turn.x)
    }

    fn hit_at(&self, turn: Mat3, p: Vec2) -> Option<(f32, Vec3)> {
        let from = vec3(p.x - self.center.x, self.center.y - p.y, 0.0);
        let ray = Ray { origin: turn.transpose() * from, way: turn.transpose() * Vec3::Z };
        let (z, normal) = match self.body {
            Body::Sphere => ray.ellipsoid(Vec3::splat(self.radius)),
            Body::Ellipsoid => ray.ellipsoid(self.half),
            Body::Cylinder => ray.cylinder(self.radius, 0.5 * self.length),
            Body::Cone => ray.cone(self.radius, 0.5 * self.length),
            Body::Capsule => ray.capsule(self.radius, 0.5 * self.length),
            Body::Torus => ray.trace(self.radius + self.tube, |p| torus(p, self.radius, self.tube)),
            Body::Box => {
                let round = self.round.min(self.half.min_element());
                ray.trace(self.half.length(), |p| rounded_box(p, self.half, round))
            }
        }?;
        let normal = (turn * normal).normalize_or(Vec3::Z);
        Some((z, vec3(normal.x, normal.y, normal.z.max(0.0)).normalize_or(Vec3::Z)))
    }

    /// The greatest distance from the middle, px.
    pub fn reach(&self) -> f32 {
        match self.body {
            Body::Sphere => self.radius,
            Body::Ellipsoid | Body::Box => self.half.length(),
            Body::Cylinder | Body::Cone => self.radius.hypot(0.5 * self.length),
            Body::Capsule => self.radius + 0.5 * self.length,
            Body::Torus => self.radius + self.tube,
        }
    }

    /// The body over the pixels that it covers; `None` where it is not finite or has more than
    /// `most_px` pixels.
    pub fn form(&self, most_px: usize) -> Option<Form> {
        let reach = self.reach() + 1.0;
        let (low, high) = ((self.center - reach).floor(), (self.center + reach).ceil());
        let size = high - low;
        if !(f64::from(size.x) * f64::from(size.y) <= most_px as f64
            && low.abs().max_element() <= 1e6)
        {
            return None;
        }
        let turn = self.turn();
        let size = Size::new(size.x as u32, size.y as u32);
        let texels = Plane::from_fn(size, |x, y| self.texel(turn, low + vec2(x as f32, y as f32)));
        Some(Form {
            corner: (low.x as i32, low.y as i32),
            height: texels.map(|t| t.height).into(),
            normals: texels.map(|t| t.normal).into(),
            coverage: texels.map(|t| t.coverage).into(),
        })
    }

    /// What one pixel shows: its center, or the mean of its covered part.
    fn texel(&self, turn: Mat3, corner: Vec2) -> PrimitiveTexel {
        const SIDE: usize = 8;
        let middle = self.hit_at(turn, corner + 0.5);
        let ends = [vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(0.0, 1.0), vec2(1.0, 1.0)];
        let hits = ends.iter().filter(|e| self.hit_at(turn, corner + **e).is_some()).count();
        let texel = |(height, normal), coverage| PrimitiveTexel { height, normal, coverage };
        match (middle, hits) {
            (Some(middle), 4) => texel(middle, 255),
            (None, 0) => PrimitiveTexel::default(),
            _ => {
                let part = |i: usize| (i as f32 + 0.5) / SIDE as f32;
                let at =
                    |i: usize| self.hit_at(turn, corner + vec2(part(i % SIDE), part(i / SIDE)));
                let seen: Vec<_> = (0..SIDE * SIDE).filter_map(at).collect();
                if seen.is_empty() {
                    return PrimitiveTexel::default();
                }
                let coverage = (seen.len() * 255).div_ceil(SIDE * SIDE) as u8;
                let mean = || {
                    let height = seen.iter().map(|s| s.0).sum::<f32>() / seen.len() as f32;
                    (height, seen.iter().map(|s| s.1).sum::<Vec3>().normalize_or(Vec3::Z))
                };
                texel(middle.unwrap_or_else(mean), coverage)
            }
        }
    }
}

#[derive(Clone, Copy)]
struct PrimitiveTexel {
    height: f32,
    normal: Vec3,
    coverage: u8,
}

impl Default for PrimitiveTexel {
    fn default() -> Self {
        Self { height: 0.0, normal: Vec3::Z, coverage: 0 }
    }
}

/// A line of sight in the frame of a body: points `origin + z · way`, seen from large z.
struct Ray {
    origin: Vec3,
    way: Vec3,
}

type Hit = Option<(f32, Vec3)>;

/// The larger root of a z² + 2 b z + c.
fn root(a: f32, b: f32, c: f32) -> Option<f32> {
    let under = b * b - a * c;
    (under >= 0.0 && a.abs() > 1e-12).then(|| (-b + under.sqrt() * a.signum()) / a)
}

/// The one nearer to the viewer.
fn nearer(a: Hit, b: Hit) -> Hit {
    match (a, b) {
        (Some(x), Some(y)) => Some(if x.0 >= y.0 { x } else { y }),
        (a, b) => a.or(b),
    }
}

impl Ray {
    fn at(&self, z: f32) -> Vec3 {
        self.origin + z * self.way
    }

    fn ellipsoid(&self, half: Vec3) -> Hit {
        let (o, d) = (self.origin / half, self.way / half);
        let z = root(d.dot(d), o.dot(d), o.dot(o) - 1.0)?;
        Some((z, self.at(z) / (half * half)))
    }

    /// The disc of a radius across the axis at y, seen from its side.
    fn cap(&self, y: f32, radius: f32) -> Hit {
        let faces = self.way.y * y.signum();
        if faces <= 1e-6 {
            return None;
        }
        let z = (y - self.origin.y) / self.way.y;
        let p = self.at(z);
        (p.x.hypot(p.z) <= radius).then_some((z, vec3(0.0, y.signum(), 0.0)))
    }

    fn cylinder(&self, radius: f32, half: f32) -> Hit {
        let (o, d) = (vec2(self.origin.x, self.origin.z), vec2(self.way.x, self.way.z));
        let side = root(d.dot(d), o.dot(d), o.dot(o) - radius * radius).map(|z| (z, self.at(z)));
        let side = side.filter(|(_, p)| p.y.abs() <= half).map(|(z, p)| (z, vec3(p.x, 0.0, p.z)));
        nearer(side, nearer(self.cap(half, radius), self.cap(-half, radius)))
    }

    /// x² + z² = (slope (half − y))², the tip up.
    fn cone(&self, radius: f32, half: f32) -> Hit {
        let slope = radius / (2.0 * half);
        let (o, d) = (self.origin, self.way);
        let k = slope * slope;
        let above = half - o.y;
        let a = d.x * d.x + d.z * d.z - k * d.y * d.y;
        let b = o.x * d.x + o.z * d.z + k * above * d.y;
        let c = o.x * o.x + o.z * o.z - k * above * above;
        let under = b * b - a * c;
        let side = (under >= 0.0 && a.abs() > 1e-9).then(|| under.sqrt()).and_then(|s| {
            // Where the cone opens toward the viewer the nearer root may lie on its mirror image
            // beyond the tip.
            let both = [(-b + s) / a, (-b - s) / a].map(|z| (z, self.at(z)));
            let on = both.iter().filter(|(_, p)| p.y.abs() <= half);
            on.max_by(|x, y| x.0.total_cmp(&y.0)).copied()
        });
        let side = side.map(|(z, p)| (z, vec3(p.x, k * (half - p.y), p.z)));
        nearer(side, self.cap(-half, radius))
    }

    fn capsule(&self, radius: f32, half: f32) -> Hit {
        let (o, d) = (vec2(self.origin.x, self.origin.z), vec2(self.way.x, self.way.z));
        let side = root(d.dot(d), o.dot(d), o.dot(o) - radius * radius).map(|z| (z, self.at(z)));
        let side = side.filter(|(_, p)| p.y.abs() <= half).map(|(z, p)| (z, vec3(p.x, 0.0, p.z)));
        let end = |y: f32| {
            let moved = Ray { origin: self.origin - vec3(0.0, y, 0.0), way: self.way };
            moved.ellipsoid(Vec3::splat(radius))
        };
        nearer(side, nearer(end(half), end(-half)))
    }

    /// The first place where a distance (and its gradient) becomes 0, starting `reach` in front of
    /// the middle.
    fn trace(&self, reach: f32, distance: impl Fn(Vec3) -> (f32, Vec3)) -> Hit {
        let mut z = reach;
        for _ in 0..200 {
            let (d, normal) = distance(self.at(z));
            if d < 1e-5 * reach {
                return Some((z, normal));
            }
            z -= d;
            if z < -reach {
                return None;
            }
        }
        None
    }
}

/// Distance to a torus around z, and the direction from it.
fn torus(p: Vec3, radius: f32, tube: f32) -> (f32, Vec3) {
    let ring = vec2(p.x, p.y).normalize_or_zero() * radius;
    let from = p - vec3(ring.x, ring.y, 0.0);
    (from.length() - tube, from)
}

/// Distance to a box of half sides `half` with round edges, and the direction from it.
fn rounded_box(p: Vec3, half: Vec3, round: f32) -> (f32, Vec3) {
    let q = p.abs() - (half - round);
    let out = q.max(Vec3::ZERO);
    if out != Vec3::ZERO {
        return (out.length() - round, out * p.signum());
    }
    let way = match q.max_element() {
        m if m == q.x => Vec3::X,
        m if m == q.y => Vec3::Y,
        _ => Vec3::Z,
    };
    (q.max_element() - round, way * p.signum())
}
