//! Two landscapes: a panorama for reflections, and a backplate with one tree before a clear
//! horizon. Linear light; the tree is painted leaf by leaf.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use image::RgbaImage;

use crate::noise::{cells, fbm2, hash, noise2};
use crate::painting::{painted, rolled_off, srgb};
use crate::sdf::{smooth_step, v};

/// A sky: what varies between the two pictures.
struct Sky {
    zenith: DVec3,
    horizon: DVec3,
    /// Position of the sun: x across, y up from the horizon, in picture heights.
    sun: DVec2,
    sunlight: DVec3,
    /// Share of the sky the clouds leave open, about `[−0.3, 0.3]`.
    open: f64,
    seed: u64,
}

impl Sky {
    /// Light from the point `q`: x across, y up from the horizon, in picture heights.
    fn light(&self, q: DVec2) -> DVec3 {
        let up = q.y.max(0.0);
        let air = self.horizon.lerp(self.zenith, 1.0 - (-3.2 * up).exp());
        let away = q.distance(self.sun);
        let glow = self.sunlight * (0.5 * (-4.5 * away).exp() + 0.9 * (-22.0 * away).exp());
        let disc = self.sunlight * 9.0 * smooth_step(0.024, 0.018, away);
        let (cover, shade) = self.cloud(q);
        let lining = (-3.0 * away).exp();
        let cloud = self.horizon.lerp(DVec3::splat(1.0), 0.75) * (1.08 - 0.72 * shade)
            + self.sunlight * lining * (1.0 - shade) * 0.9;
        let haze = smooth_step(0.0, 0.12, up);
        (air + glow + disc * (1.0 - cover)).lerp(cloud, cover * haze * 0.94)
    }

    /// Cover and shade of the clouds: a warped fractal on a plane overhead, so they shrink toward
    /// the horizon.
    fn cloud(&self, q: DVec2) -> (f64, f64) {
        let on_plane = |up: f64| DVec2::new(q.x, 0.55) * 1.25 / (up.max(0.0) + 0.16);
        let field = |at: DVec2| {
            let warp =
                DVec2::new(fbm2(at * 0.8, 4, 0, self.seed), fbm2(at * 0.8, 4, 0, self.seed + 40));
            fbm2(at + warp * 0.75, 7, 0, self.seed + 80) - self.open
        };
        let density = field(on_plane(q.y));
        // Denser toward the sun means shaded: one step of a march.
        let toward = field(on_plane(q.y + 0.035));
        let cover = smooth_step(-0.02, 0.3, density);
        (
            cover,
            (smooth_step(0.05, 0.6, density) * 0.6
                + smooth_step(-0.12, 0.22, toward - density * 0.6) * 0.55)
                .min(1.0),
        )
    }
}

/// A lake among hills under a late sun. 1024 × 512.
pub fn panorama() -> RgbaImage {
    let sky = Sky {
        zenith: srgb(0x1f5cb0),
        horizon: srgb(0xf6c48c),
        sun: DVec2::new(-0.42, 0.15),
        sunlight: v(1.5, 1.0, 0.55),
        open: 0.02,
        seed: 12,
    };
    painted((1024, 512), 2, |p| {
        let q = DVec2::new((p.x - 512.0) / 512.0, (256.0 - p.y) / 512.0);
        let shore = -0.012 + 0.01 * fbm2(DVec2::new(q.x * 3.0, 4.0), 3, 0, 91);
        let meadow =
            -0.33 + 0.07 * fbm2(DVec2::new(q.x * 1.7, 1.0), 4, 0, 17) + 0.1 * (q.x + 0.25).powi(2);
        let light = if q.y < meadow {
            grass(q, 0.1 + meadow - q.y, v(1.0, 0.86, 0.58))
        } else if q.y < shore {
            lake(&sky, q, shore)
        } else {
            land_and_sky(&sky, q)
        };
        rolled_off(light * 1.5).extend(1.0)
    })
}

/// Ridges before the sky, each bluer the farther.
fn land_and_sky(sky: &Sky, q: DVec2) -> DVec3 {
    if q.y > 0.3 {
        return sky.light(q);
    }
    let nearest_first = (0..5).rev().find_map(|layer| ridge(sky, q, layer));
    nearest_first.unwrap_or_else(|| sky.light(q))
}

/// The light of ridge `layer` (0 the farthest of five) where it covers `q`.
fn ridge(sky: &Sky, q: DVec2, layer: u32) -> Option<DVec3> {
    let far = f64::from(4 - layer) / 4.0;
    let seed = 500 + u64::from(layer);
    let broad =
        fbm2(DVec2::new(q.x * (1.3 + 0.8 * (1.0 - far)) + 7.0 * f64::from(layer), 0.5), 7, 0, seed);
    // The two nearest ridges are wooded: crowns rise above the line.
    let wooded = smooth_step(0.6, 0.3, far);
    let crowns = fbm2(DVec2::new(q.x * 60.0, 2.0), 3, 0, seed + 9)
        + 0.6 * mottle(DVec2::new(q.x * 45.0, 0.5), seed);
    let below = 0.012 + 0.075 * far + broad * (0.035 + 0.13 * far) + 0.016 * wooded * crowns - q.y;
    if below <= 0.0 {
        return None;
    }
    let slope = fbm2(DVec2::new(q.x * 9.0 + q.y * 4.0, q.y * 22.0), 5, 0, seed + 20);
    let shade = 0.5 + 0.5 * mottle(q * DVec2::new(70.0, 90.0), seed);
    let forest = srgb(0x2c4524).lerp(srgb(0x6b6f35), 0.5 + 0.5 * slope) * shade;
    let ground = forest * (0.75 + 0.5 * slope + 0.36 * smooth_step(0.02, 0.0, below));
    let air = sky.horizon.lerp(srgb(0x7f9cc4), 0.62) * 0.8;
    Some(ground.lerp(air, 0.12 + 0.72 * far + 0.25 * smooth_step(0.03, 0.12, below) * far))
}

/// Water: the mirrored view, broken into longer ripples toward the viewer.
fn lake(sky: &Sky, q: DVec2, shore: f64) -> DVec3 {
    let depth = shore - q.y;
    let near = smooth_step(0.0, 0.3, depth);
    let rows = DVec2::new(q.x * 16.0 / (0.3 + 2.0 * depth), 26.0 * (1.0 + depth * 12.0).ln());
    let ripple = fbm2(rows, 4, 0, 61);
    let calm = smooth_step(0.1, -0.3, fbm2(DVec2::new(q.x * 2.0, depth * 18.0), 3, 0, 71));
    let swing = ripple * (0.008 + 0.06 * near) * (1.0 - 0.75 * calm);
    let mirrored =
        DVec2::new(q.x + 0.25 * swing, (shore + depth * 0.95 + swing).max(shore + 0.002));
    let tint = v(0.72, 0.84, 0.86).lerp(v(0.4, 0.55, 0.58), near);
    let deep = srgb(0x18333a) * 0.7;
    (land_and_sky(sky, mirrored) * tint).lerp(deep, 0.12 + 0.35 * near)
        + DVec3::splat(0.035 * smooth_step(0.006, 0.0, depth))
}

/// Grass in perspective, with flowers; `drop` is the distance below the vanishing line, positive.
fn grass(q: DVec2, drop: f64, sun: DVec3) -> DVec3 {
    // Conformal: detail shrinks with distance and is nowhere smeared.
    let at = DVec2::new(q.x / drop, drop.ln());
    let blades = fbm2(at * DVec2::new(110.0, 42.0), 2, 0, 5) * smooth_step(0.03, 0.12, drop);
    let patch = fbm2(at * DVec2::new(1.1, 2.4), 5, 0, 33);
    let green = srgb(0x3f5f1f).lerp(srgb(0x9a9a45), smooth_step(-0.55, 0.6, patch + 0.3 * blades));
    let lit = green * (0.72 + 0.75 * blades + 0.35 * patch).max(0.12) * sun;
    let flower = cells(at * 15.0, 0, 0.9, 7);
    let chosen = smooth_step(0.7, 0.72, flower.tag) * smooth_step(0.05, 0.14, drop);
    let size = 0.075 + 0.05 * hash((flower.tag * 1e6) as i64, 3, 1);
    let petals = chosen * smooth_step(size, size * 0.6, flower.nearest);
    let color = if flower.tag > 0.87 { srgb(0xf5e9d0) } else { srgb(0xe0552f) };
    lit.lerp(color * 0.9, petals * 0.9)
}

/// A mottled value in `[0, 1)` of the cell around `p`.
fn mottle(p: DVec2, seed: u64) -> f64 {
    let cell = cells(p, 0, 0.9, seed);
    (cell.tag * 0.7 + 0.3 * (1.0 - cell.nearest)).clamp(0.0, 1.0)
}

/// A tree before fields and a clear horizon. 840 × 560.
pub fn backplate() -> RgbaImage {
    let sky = Sky {
        zenith: srgb(0x2e74c4),
        horizon: srgb(0xcfe4f2),
        sun: DVec2::new(-1.2, 0.9),
        sunlight: v(1.2, 1.1, 0.95),
        open: 0.1,
        seed: 33,
    };
    let (width, height) = (840_u32, 560_u32);
    let mut tree = Tree::new(width as usize * 3, height as usize * 3);
    tree.grow(DVec2::new(-0.28, -0.2), TAU / 4.0 + 0.04, 0.15, 0.026, 0);
    tree.leaves_last();
    painted((width, height), 2, |p| {
        let q = DVec2::new((p.x - 420.0) / 560.0, (325.0 - p.y) / 560.0);
        let ground = field(&sky, q);
        let shadow = tree_shadow(q);
        let light = rolled_off(ground * (1.0 - 0.62 * shadow) * 1.35);
        let (leaf, cover) = tree.at(p * 3.0);
        light.lerp(leaf, cover).extend(1.0)
    })
}

/// Sky, a wooded line on the horizon, fields with hedges, the meadow in front.
fn field(sky: &Sky, q: DVec2) -> DVec3 {
    let hills = 0.02 + 0.03 * fbm2(DVec2::new(q.x * 2.2, 3.0), 4, 0, 71);
    let woods = 0.006
        + 0.011
            * fbm2(DVec2::new(q.x * 30.0, 1.0), 4, 0, 72)
            * smooth_step(-0.3, 0.3, noise2(DVec2::new(q.x * 3.0, 2.0), 0, 73));
    if q.y > woods.max(hills) {
        return sky.light(q);
    }
    if q.y > woods {
        return srgb(0x8ba7c0).lerp(srgb(0x6f8c86), smooth_step(hills, 0.0, q.y)) * 0.8;
    }
    if q.y > 0.0 {
        return srgb(0x4a6647) * (0.6 + 0.5 * mottle(q * 90.0, 4));
    }
    let distance = 1.0 / (0.02 - q.y);
    let on_plane = DVec2::new(q.x * distance, distance);
    let strip = noise2(DVec2::new(on_plane.x * 0.16, on_plane.y * 0.22), 0, 81);
    let crop = srgb(0x93a94b)
        .lerp(srgb(0xd9c468), smooth_step(0.05, 0.12, strip))
        .lerp(srgb(0x5f8a3a), smooth_step(-0.1, -0.2, strip));
    let hedge = smooth_step(0.035, 0.01, (strip - 0.085).abs()) * smooth_step(-0.13, -0.05, q.y);
    let tufts = fbm2(on_plane * DVec2::new(3.0, 1.4), 5, 0, 91);
    let near = grass(q, 0.01 - q.y, v(1.0, 1.0, 0.85)) * 1.15;
    let land = (crop * (0.8 + 0.35 * tufts)).lerp(srgb(0x3c5a2c) * 0.7, hedge);
    let hazy = land.lerp(srgb(0xb9cdd2), 0.5 * smooth_step(-0.09, 0.0, q.y));
    hazy.lerp(near, smooth_step(-0.07, -0.2, q.y))
}

/// The soft shadow to the right of the trunk.
fn tree_shadow(q: DVec2) -> f64 {
    let d = (q - DVec2::new(-0.16, -0.222)) / DVec2::new(0.27, 0.042);
    let ragged = 0.35 * fbm2(q * DVec2::new(22.0, 70.0), 4, 0, 6);
    smooth_step(1.15, 0.55, d.length() + ragged)
}

/// A tree painted into a buffer: color and cover per point.
struct Tree {
    width: usize,
    points: Vec<(DVec3, f64)>,
    /// Positions of leaves: the ends of twigs, by the clump they belong to.
    clumps: Vec<Vec<DVec2>>,
    /// Counts branches, so that each has its own chance.
    count: i64,
}

impl Tree {
    fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            points: vec![(DVec3::ZERO, 0.0); width * height],
            clumps: Vec::new(),
            count: 0,
        }
    }

    /// A branch from `foot`, then its forks. Lengths in picture heights.
    fn grow(&mut self, foot: DVec2, heading: f64, length: f64, radius: f64, order: u32) {
        self.count += 1;
        let id = self.count;
        let chance = |k: i64| hash(id, k, 99) - 0.5;
        let bend = chance(1) * 0.35;
        let (mut at, mut angle) = (foot, heading);
        let pieces = if order == 0 { 30 } else { 8 };
        for piece in 0..pieces {
            let t = f64::from(piece) / f64::from(pieces);
            let next = at + DVec2::from_angle(angle) * length / f64::from(pieces);
            // The trunk's foot spreads into the ground.
            let flare = if order == 0 { 1.0 + 0.6 * (1.0 - t).powi(5) } else { 1.0 };
            self.limb(at, next, radius * (1.0 - 0.3 * t) * flare);
            angle += bend / f64::from(pieces);
            at = next;
        }
        if order == 2 {
            self.clumps.push(Vec::new());
        }
        if let (3.., Some(clump)) = (order, self.clumps.last_mut()) {
            clump.push(at);
        }
        if order == 6 {
            return;
        }
        let forks = if order == 0 { 4 } else { 2 + i64::from(chance(2) > 0.12) };
        for fork in 0..forks {
            let spread = if order == 0 { 1.75 } else { 1.15 };
            let side = (fork as f64 + 0.5) / forks as f64 - 0.5;
            let turned = angle + side * spread + chance(10 + fork) * 0.45;
            // Branches strive upward a little.
            let upward = turned + 0.12 * (TAU / 4.0 - turned);
            let share = 0.78 + 0.2 * chance(20 + fork);
            self.grow(at, upward, length * share, radius * 0.62, order + 1);
        }
    }

    /// A piece of a branch, lit from the left.
    fn limb(&mut self, a: DVec2, b: DVec2, radius: f64) {
        let across = (b - a).perp().normalize_or(DVec2::X);
        self.stamp((a + b) * 0.5, (b - a).length() * 0.5 + radius, |q| {
            let along = ((q - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            let d = q - a.lerp(b, along);
            let buried = smooth_step(-0.205, -0.199, q.y + 0.006 * noise2(q * 160.0, 0, 2));
            let inside = smooth_step(radius, radius - 0.0012, d.length()) * buried;
            let bark = 1.0 + 0.5 * noise2(DVec2::new(q.x * 260.0, q.y * 50.0), 0, 4);
            let lit = 0.45 - 0.5 * d.dot(across) / radius * across.x.signum();
            (srgb(0x6b5440) * bark * lit.max(0.1), inside)
        });
    }

    /// The leaves, clump by clump; in each the shaded ones first and the lit ones last.
    fn leaves_last(&mut self) {
        let clumps = std::mem::take(&mut self.clumps);
        let center = |points: &[DVec2]| points.iter().sum::<DVec2>() / points.len().max(1) as f64;
        let centers: Vec<DVec2> = clumps.iter().map(|clump| center(clump)).collect();
        let crown = center(&centers);
        for (clump, middle) in clumps.iter().zip(&centers) {
            for pass in 0..5 {
                for (i, twig) in clump.iter().enumerate() {
                    self.tuft(*twig, *middle, crown, (i as i64, pass));
                }
            }
        }
    }

    /// The leaves of one twig, lit by their places in the clump and in the crown.
    fn tuft(&mut self, twig: DVec2, middle: DVec2, crown: DVec2, (id, pass): (i64, i64)) {
        const LEFT_ABOVE: DVec2 = DVec2::new(-0.55, 0.83);
        let place = (twig.x * 1e5) as i64;
        for k in 0..7 {
            let chance = |n: i64| hash(id * 64 + k * 8 + n + place * 4096, pass, 7);
            let offset = DVec2::from_angle(chance(0) * TAU) * 0.036 * chance(1).sqrt();
            let at = twig + offset + LEFT_ABOVE * 0.004 * pass as f64;
            let whole = (at - crown).dot(LEFT_ABOVE) / 0.25;
            let lobe = ((at - middle).dot(LEFT_ABOVE) / 0.07).clamp(-1.0, 1.2);
            let own = 0.04 * pass as f64 + 0.3 * (chance(2) - 0.5);
            let lit = (0.3 + 0.16 * whole + 0.34 * lobe + own).clamp(0.02, 1.0);
            let green = srgb(0x1a3316).lerp(srgb(0x93a640), lit) * (0.4 + 0.62 * lit);
            self.leaf(at, 0.0036 + 0.0024 * chance(3), chance(4) * TAU, green);
        }
    }

    fn leaf(&mut self, at: DVec2, size: f64, turn: f64, color: DVec3) {
        let axis = DVec2::from_angle(turn);
        self.stamp(at, size, |q| {
            let d = DVec2::new((q - at).dot(axis), axis.perp_dot(q - at) * 1.7) / size;
            (color * (1.0 + 0.25 * d.y), smooth_step(1.0, 0.75, d.length()))
        });
    }

    /// Lays color over the points within `reach` of `at`.
    fn stamp(&mut self, at: DVec2, reach: f64, paint: impl Fn(DVec2) -> (DVec3, f64)) {
        const SCALE: f64 = 1680.0;
        let (cx, cy, r) = (1260.0 + at.x * SCALE, 975.0 - at.y * SCALE, reach * SCALE + 1.0);
        let height = self.points.len() / self.width;
        let span = |c: f64, size: usize| {
            ((c - r).max(0.0) as usize)..((c + r).clamp(0.0, size as f64 - 1.0) as usize + 1)
        };
        for y in span(cy, height) {
            for x in span(cx, self.width) {
                let q =
                    DVec2::new((x as f64 + 0.5 - 1260.0) / SCALE, (975.0 - y as f64 - 0.5) / SCALE);
                let (color, cover) = paint(q);
                let under = &mut self.points[y * self.width + x];
                let total = cover + under.1 * (1.0 - cover);
                if cover > 0.0 {
                    *under = ((color * cover + under.0 * under.1 * (1.0 - cover)) / total, total);
                }
            }
        }
    }

    /// Color and cover at a point of the buffer.
    fn at(&self, p: DVec2) -> (DVec3, f64) {
        self.points[p.y as usize * self.width + p.x as usize]
    }
}
