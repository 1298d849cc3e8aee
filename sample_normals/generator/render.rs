//! From a surface to its maps: an orthographic tracer with 4 × 4 samples where the picture needs
//! them. Not here: the surfaces (`shapes`, `cloth`), files (`output`).

use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Sub-samples per side of a pixel on silhouettes and creases.
pub const SUB: usize = 4;
/// Neighbors whose normals agree less than this (cosine) are sub-sampled.
const CREASE_COS: f64 = 0.94;
/// A ray is on the surface closer than this; about a hundredth of a pixel.
const HIT: f64 = 3e-5;
/// Reach of the central difference for normals: below a tenth of a pixel, far above f64 noise.
const GRADIENT_REACH: f64 = 2e-4;

/// Side of the square blocks of pixels that share the empty first part of their rays.
const BLOCK: usize = 8;

/// Where a ray meets a surface.
#[derive(Clone, Copy)]
pub struct Hit {
    /// Height toward the viewer.
    pub z: f64,
    /// Unit, camera space, +y up.
    pub normal: DVec3,
}

/// Anything a ray along −z can meet.
pub trait Surface: Sync {
    /// The first hit at or below height `top` at the model point (x, y), +y up, if there is one.
    fn hit(&self, at: DVec2, top: f64) -> Option<Hit>;

    /// A height above which no ray closer than `radius` to `at` meets the surface; none if no ray
    /// does.
    fn clearance(&self, _at: DVec2, _radius: f64) -> Option<f64> {
        Some(f64::INFINITY)
    }
}

/// A signed distance function, sphere traced.
pub struct Traced<F> {
    /// Signed distance, negative inside.
    pub distance: F,
    /// Rays run from `+reach` to `−reach`.
    pub reach: f64,
    /// Share of the distance a step advances: below 1 where the field over-estimates.
    pub stride: f64,
}

impl<F: Fn(DVec3) -> f64 + Sync> Surface for Traced<F> {
    fn hit(&self, at: DVec2, top: f64) -> Option<Hit> {
        let z = self.first_root(at, top.min(self.reach))?;
        Some(Hit { z, normal: self.normal(at.extend(z)) })
    }

    fn clearance(&self, at: DVec2, radius: f64) -> Option<f64> {
        let mut z = self.reach;
        while z > -self.reach {
            let free = (self.distance)(at.extend(z)) * self.stride - radius;
            if free < radius {
                return Some(z);
            }
            z -= free;
        }
        None
    }
}

impl<F: Fn(DVec3) -> f64 + Sync> Traced<F> {
    /// Height of the first root of the distance below `top`.
    ///
    /// Sphere tracing crawls on grazing rays. Near the surface it therefore uses secant steps:
    /// along a ray that passes a convex piece the distance is convex too, and the secant stops
    /// short of the root.
    fn first_root(&self, at: DVec2, top: f64) -> Option<f64> {
        let mut z = top;
        let mut last = (top + 1.0, f64::INFINITY);
        for _ in 0..400 {
            let d = (self.distance)(at.extend(z));
            if d.abs() < HIT {
                return Some(z);
            }
            if d < 0.0 {
                return Some(if last.1.is_finite() {
                    self.bracketed_root(at, last, (z, d))
                } else {
                    z
                });
            }
            let fall = (last.1 - d) / (last.0 - z);
            let safe = d * self.stride;
            let secant =
                if d < 0.04 && fall.is_finite() && fall > 0.0 { 0.95 * d / fall } else { safe };
            last = (z, d);
            // The cap keeps a wrong guess from stepping through something thin.
            z -= secant.clamp(safe, (safe * 8.0).min(safe + 0.006)).max(0.5 * HIT);
            if z < -self.reach {
                return None;
            }
        }
        None
    }

    /// The root between a point outside and one inside, by the Illinois variant of regula falsi.
    fn bracketed_root(&self, at: DVec2, mut outside: (f64, f64), mut inside: (f64, f64)) -> f64 {
        let mut z = inside.0;
        for _ in 0..20 {
            z = (outside.0 * inside.1 - inside.0 * outside.1) / (inside.1 - outside.1);
            let d = (self.distance)(at.extend(z));
            if d.abs() < 0.2 * HIT {
                break;
            }
            if d > 0.0 {
                outside = (z, d);
                inside.1 *= 0.5;
            } else {
                inside = (z, d);
                outside.1 *= 0.5;
            }
        }
        z
    }

    /// The gradient's direction, from four samples at the corners of a tetrahedron.
    fn normal(&self, p: DVec3) -> DVec3 {
        const CORNERS: [DVec3; 4] = [
            DVec3::new(1.0, -1.0, -1.0),
            DVec3::new(-1.0, -1.0, 1.0),
            DVec3::new(-1.0, 1.0, -1.0),
            DVec3::new(1.0, 1.0, 1.0),
        ];
        facing(
            CORNERS
                .iter()
                .map(|corner| *corner * (self.distance)(p + *corner * GRADIENT_REACH))
                .sum(),
        )
    }
}

/// The unit normal, kept on the viewer's side: a visible point never faces away.
pub fn facing(n: DVec3) -> DVec3 {
    DVec3::new(n.x, n.y, n.z.max(1e-3 * n.length())).normalize_or(DVec3::Z)
}

/// Which part of the model plane becomes which picture.
pub struct View {
    pub width: usize,
    pub height: usize,
    /// The model point at the picture's center.
    pub center: DVec2,
    /// Half the picture's width, in model units.
    pub half_width: f64,
}

impl View {
    /// The model point at picture position (x, y), in pixels with y down.
    fn model_from_pixel(&self, x: f64, y: f64) -> DVec2 {
        let scale = 2.0 * self.half_width / self.width as f64;
        self.center + DVec2::new(x - self.width as f64 * 0.5, self.height as f64 * 0.5 - y) * scale
    }
}

/// The three maps of a surface, row by row from the top.
pub struct Maps {
    pub width: usize,
    pub height: usize,
    /// Unit normals; flat away from the surface.
    pub normal: Vec<DVec3>,
    /// 0 near, 1 far over the surface.
    pub depth: Vec<f64>,
    /// Share of the pixel the surface covers.
    pub coverage: Vec<f64>,
}

/// One pixel before normalization; `z` and `normal` mean nothing at zero coverage.
#[derive(Clone, Copy)]
struct Pixel {
    coverage: f64,
    z: f64,
    normal: DVec3,
}

/// A surface in its view, with the heights at which the rays of each block of pixels start.
struct Scene<'a> {
    surface: &'a dyn Surface,
    view: &'a View,
    tops: Vec<Option<f64>>,
}

impl<'a> Scene<'a> {
    fn new(surface: &'a dyn Surface, view: &'a View) -> Self {
        let (across, down) = (view.width.div_ceil(BLOCK), view.height.div_ceil(BLOCK));
        let side = BLOCK as f64;
        // Half the diagonal of a block, in model units.
        let radius = side * 0.7072 * 2.0 * view.half_width / view.width as f64;
        let top = |i: usize| {
            let (x, y) = ((i % across) as f64 + 0.5, (i / across) as f64 + 0.5);
            surface.clearance(view.model_from_pixel(x * side, y * side), radius)
        };
        Self { surface, view, tops: (0..across * down).into_par_iter().map(top).collect() }
    }

    /// The hit at picture position (x, y), in pixels with y down.
    fn hit(&self, x: f64, y: f64) -> Option<Hit> {
        let block = (y as usize / BLOCK) * self.view.width.div_ceil(BLOCK) + x as usize / BLOCK;
        self.surface.hit(self.view.model_from_pixel(x, y), self.tops[block]?)
    }
}

/// Renders the maps of `surface` seen in `view`.
pub fn render(surface: &dyn Surface, view: &View) -> Maps {
    let (w, h) = (view.width, view.height);
    let scene = Scene::new(surface, view);
    let centers: Vec<Option<Hit>> = (0..w * h)
        .into_par_iter()
        .with_min_len(w / 4)
        .map(|i| scene.hit((i % w) as f64 + 0.5, (i / w) as f64 + 0.5))
        .collect();
    let jump = 6.0 * 2.0 * view.half_width / w as f64;
    let pixels: Vec<Pixel> = (0..w * h)
        .into_par_iter()
        .with_min_len(w / 4)
        .map(|i| {
            if is_smooth(&centers, w, h, i, jump) {
                centers[i].map_or(EMPTY, |hit| Pixel {
                    coverage: 1.0,
                    z: hit.z,
                    normal: hit.normal,
                })
            } else {
                sub_sampled(&scene, i % w, i / w)
            }
        })
        .collect();
    finish(pixels, w, h)
}

const EMPTY: Pixel = Pixel { coverage: 0.0, z: 0.0, normal: DVec3::Z };

/// Whether pixel `i` and its eight neighbors see one smooth piece of surface, or nothing.
fn is_smooth(hits: &[Option<Hit>], w: usize, h: usize, i: usize, jump: f64) -> bool {
    let (x, y) = (i % w, i / w);
    let rows = y.saturating_sub(1)..=(y + 1).min(h - 1);
    let mut around =
        rows.flat_map(|v| (x.saturating_sub(1)..=(x + 1).min(w - 1)).map(move |u| v * w + u));
    around.all(|j| match (hits[i], hits[j]) {
        (None, None) => true,
        (Some(a), Some(b)) => a.normal.dot(b.normal) > CREASE_COS && (a.z - b.z).abs() < jump,
        _ => false,
    })
}

/// Coverage from every sub-sample; depth and normal from the piece of surface that holds most of
/// them. A mean over pieces would leave a pixel between the near and the far one, and a bent
/// picture would show it as a fringe.
fn sub_sampled(scene: &Scene, x: usize, y: usize) -> Pixel {
    let offset = |i: usize| (i as f64 + 0.5) / SUB as f64;
    let spots = (0..SUB * SUB).map(|i| (x as f64 + offset(i % SUB), y as f64 + offset(i / SUB)));
    let hits: Vec<Option<Hit>> = spots.map(|(u, v)| scene.hit(u, v)).collect();
    let covered = hits.iter().flatten().count();
    let piece = largest_piece(&hits, 2.0 * scene.view.half_width / (scene.view.width * SUB) as f64);
    if piece.is_empty() {
        return EMPTY;
    }
    Pixel {
        coverage: covered as f64 / (SUB * SUB) as f64,
        z: piece.iter().map(|hit| hit.z).sum::<f64>() / piece.len() as f64,
        normal: facing(piece.iter().map(|hit| hit.normal).sum()),
    }
}

/// The hits of the piece that holds most sub-samples, the nearer of two equals; `step` lies between
/// sub-samples.
fn largest_piece(hits: &[Option<Hit>], step: f64) -> Vec<Hit> {
    let mut piece_of: Vec<usize> = (0..hits.len()).collect();
    let mut join = |i: usize, j: usize| {
        if let (Some(a), Some(b)) = (hits[i], hits[j]) {
            let (from, to) = (piece_of[j], piece_of[i]);
            if is_one_piece(a, b, step) {
                piece_of.iter_mut().filter(|piece| **piece == from).for_each(|piece| *piece = to);
            }
        }
    };
    for i in 0..hits.len() {
        if i % SUB + 1 < SUB {
            join(i, i + 1);
        }
        if i + SUB < hits.len() {
            join(i, i + SUB);
        }
    }
    let pieces = (0..hits.len()).map(|piece| -> Vec<Hit> {
        hits.iter()
            .zip(&piece_of)
            .filter(|(_, p)| **p == piece)
            .filter_map(|(hit, _)| *hit)
            .collect()
    });
    let nearest = |piece: &[Hit]| piece.iter().map(|hit| hit.z).fold(f64::NEG_INFINITY, f64::max);
    pieces
        .max_by(|a, b| a.len().cmp(&b.len()).then(nearest(a).total_cmp(&nearest(b))))
        .unwrap_or_default()
}

/// Whether one slope may lead from one hit to the other. A near piece is steep where it ends, the
/// far one is not.
fn is_one_piece(a: Hit, b: Hit, step: f64) -> bool {
    let slope = |hit: Hit| hit.normal.truncate().length() / hit.normal.z;
    (a.z - b.z).abs() < (2.0 * slope(a).min(slope(b)) + 4.0) * step
}

/// Normalizes depth over the surface and grows the surface's values outward.
fn finish(mut pixels: Vec<Pixel>, width: usize, height: usize) -> Maps {
    let covered = pixels.iter().filter(|p| p.coverage > 0.0).map(|p| p.z);
    let (far, near) =
        covered.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), z| (a.min(z), b.max(z)));
    let coverage = pixels.iter().map(|p| p.coverage).collect();
    // A few pixels of margin keep filters that straddle the silhouette on the surface's own values.
    for _ in 0..4 {
        pixels = grown(&pixels, width, height);
    }
    let depth_of =
        |p: &Pixel| if p.coverage > 0.0 { (near - p.z) / (near - far).max(1e-9) } else { 1.0 };
    Maps {
        width,
        height,
        depth: pixels.iter().map(|p| depth_of(p).clamp(0.0, 1.0)).collect(),
        normal: pixels.iter().map(|p| p.normal).collect(),
        coverage,
    }
}

/// Empty pixels next to the surface take the mean of their neighbors on it.
fn grown(pixels: &[Pixel], w: usize, h: usize) -> Vec<Pixel> {
    let value = |i: usize| {
        if pixels[i].coverage > 0.0 {
            return pixels[i];
        }
        let (x, y) = (i % w, i / w);
        let rows = y.saturating_sub(1)..=(y + 1).min(h - 1);
        let around =
            rows.flat_map(|v| (x.saturating_sub(1)..=(x + 1).min(w - 1)).map(move |u| v * w + u));
        let valid: Vec<&Pixel> = around.map(|j| &pixels[j]).filter(|p| p.coverage > 0.0).collect();
        if valid.is_empty() {
            return pixels[i];
        }
        let z = valid.iter().map(|p| p.z).sum::<f64>() / valid.len() as f64;
        Pixel { coverage: 1.0, z, normal: facing(valid.iter().map(|p| p.normal).sum()) }
    };
    (0..pixels.len()).into_par_iter().with_min_len(w).map(value).collect()
}
