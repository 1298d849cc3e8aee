//! Grain: a texture that reduces a stroke's paint in the valleys of the canvas or of the surface. Floor 3. The patterns
//! are in `pattern`; the operators D_p and D_s place the grain on a surface.
//!
//! ```text
//! F′(q) = F(q) · (1 − k (1 − G(P⁻¹(T(q)))))      T(q) = q            grain on the canvas
//!                                               T(q) = D_p(q; q_s)  grain that follows the depth
//!                                               T(q) = D_s(q; q_s)  grain that lies on the surface
//! ```
//!
//! k is the strength, P scales and turns the texture, and q_s is where the stroke began: T(q_s) = q_s, so that the
//! grain there has its size on the canvas, is larger on nearer parts and smaller on farther ones. G repeats without
//! end.

use super::image::{PictureSource, transform};
use super::patches::Patches;
use super::pattern::Pattern;
use super::scene::Scene;
use super::tip::texture::grey;
use crate::math::Range;
use crate::math::{Affine2, Vec2};
use crate::raster::sampler::Antialias;
use crate::raster::tile::TILE_AREA;
use crate::raster::{Outside, Plane, TILE, Texture, TileAt};
use crate::surface::Operator;
use crate::surface::deformation::{Deformation, DeformedRect};
use std::sync::{Arc, Mutex, PoisonError};

/// A brush's grain.
#[derive(Clone, PartialEq)]
pub struct BrushGrain {
    pub source: GrainSource,
    /// Size of one feature of a pattern, or of a picture's longer side; canvas px, `> 0`.
    pub size_px: f32,
    /// Counter-clockwise as seen, degrees.
    pub rotation: f32,
    /// k, `[0, 1]`: 0 is the same as no grain.
    pub strength: f32,
    /// Greys up to the first take no paint, those from the second on take all; both in `[0, 1]`, the first below the
    /// second.
    pub levels: [f32; 2],
    pub lies: GrainSpace,
}

/// What the grain is.
#[derive(Clone, PartialEq)]
pub enum GrainSource {
    Pattern {
        pattern: Pattern,
        seed: u32,
    },
    /// Its luminance times its alpha.
    Picture(PictureSource),
}

/// What the grain lies on.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum GrainSpace {
    /// The flat canvas.
    #[default]
    Canvas,
    /// The surface, through D_p.
    Surface { gamma: f32 },
    /// The surface, through D_s: as large everywhere.
    Unwrapped,
}

impl GrainSpace {
    /// Every kind with its name in documents; the first with the numbers of the name alone.
    pub const ALL: [(GrainSpace, &'static str); 3] = [
        (GrainSpace::Canvas, "canvas"),
        (GrainSpace::Surface { gamma: 1.0 }, "surface"),
        (GrainSpace::Unwrapped, "unwrapped"),
    ];
    /// The same kind with the numbers of its name alone.
    pub fn plain(self) -> Self {
        let is_same = |(kind, _): &&(Self, &str)| std::mem::discriminant(kind) == std::mem::discriminant(&self);
        Self::ALL.iter().find(is_same).map_or(self, |(kind, _)| *kind)
    }
}

impl BrushGrain {
    pub const SIZE_PX: Range = 0.5..=20_000.0;
    pub const LEVEL: Range = -4.0..=4.0;
    pub const GAMMA: Range = 0.0..=8.0;
}

impl Default for BrushGrain {
    fn default() -> Self {
        Self {
            source: GrainSource::Pattern { pattern: Pattern::default(), seed: 0 },
            size_px: 6.0,
            rotation: 0.0,
            strength: 1.0,
            levels: [0.0, 1.0],
            lies: GrainSpace::default(),
        }
    }
}

/// What grain leaves of each pixel of a tile. A pixel may hold light and dark grain finer than itself: a stroke's dabs
/// fill the light part sooner than the dark one, so a mean of both would be filled too soon. It is two parts, chosen so
/// that mean and variance are right; where grain is black and white, the parts are.
pub struct GrainTile {
    /// The factor of F in either part, `[0, 1]`.
    pub light: [f32; TILE_AREA],
    pub dark: [f32; TILE_AREA],
    /// How much of the pixel the lighter part is, `[0, 1]`.
    pub share: [f32; TILE_AREA],
}

/// The grain under one stroke.
pub struct StrokeGrain {
    texture: Arc<Texture>,
    texels_from_canvas: Affine2,
    operator: Operator,
    /// q_s.
    start: Vec2,
    strength: f32,
}

impl StrokeGrain {
    /// `start`: where the stroke begins, canvas px.
    pub fn new(grain: &BrushGrain, start: Vec2) -> Self {
        let texture = grain.texture();
        let texels = match grain.source {
            GrainSource::Pattern { .. } => texture.size().longer_side() / Pattern::CELLS as f32,
            GrainSource::Picture(_) => texture.size().longer_side(),
        };
        // Comparisons that NaN fails give a pattern of one pixel.
        let texels_per_px = Vec2::splat(texels / grain.size_px.max(0.01));
        let turn = if grain.rotation.is_finite() { grain.rotation.to_radians() } else { 0.0 };
        let operator = match grain.lies {
            GrainSpace::Canvas => Operator::None,
            GrainSpace::Surface { gamma } => Operator::Depth { gamma },
            GrainSpace::Unwrapped => Operator::Surface { amount: 1.0, smooth: 0.0 },
        };
        Self {
            texture,
            texels_from_canvas: Affine2::from_scale(texels_per_px) * Affine2::from_angle(turn),
            operator,
            start,
            strength: grain.strength.max(0.0).min(1.0),
        }
    }
    /// The factors of F over a tile, row by row; 1 beyond the canvas.
    pub fn tile(&self, scene: &Scene, at: TileAt) -> Box<GrainTile> {
        let whole = [1.0; TILE_AREA];
        let mut out = Box::new(GrainTile { light: whole, dark: whole, share: whole });
        let area = scene.area(at);
        if area.is_empty() {
            return out;
        }
        let (mut deformed, mut patches) = (DeformedRect::default(), Patches::default());
        let (mut antialias, mut row) = (Antialias::default(), vec![[0; 4]; area.width()]);
        let deformation = Deformation::of_pattern(scene.surface.as_deref(), scene.size, self.operator, self.start);
        deformation.fill(area.grown(1), &mut deformed);
        transform(self.texels_from_canvas, &mut deformed.x, &mut deformed.y);
        for y in scene.rows(area) {
            let patches = patches.row(scene, area, y, &deformed, self.texels_from_canvas);
            antialias.row(&self.texture, patches, Outside::Repeat, &mut row);
            let start = (y - area.y0) as usize * TILE;
            for (i, texel) in (start..).zip(&row) {
                let [grey, square, _, bare] = texel.map(|v| f32::from(v) / 255.0);
                let [light, dark, share] = parts(grey, square, bare);
                (out.light[i], out.dark[i]) = (factor_of(self.strength, light), factor_of(self.strength, dark));
                out.share[i] = share;
            }
        }
        out
    }
}

/// Two greys and the share of the first, of a mean grey m, the mean of its square and the share p that is not black,
/// all in `[0, 1]`. Where some is black, that is one part, since no paint ever fills it; else with σ² = ⟨G²⟩ − m²:
///
/// ```text
/// p < 1:   light = m / p,                    dark = 0,                        share = p
/// p = 1:   light = m + σ √((1 − m) / m),   dark = m − σ √(m / (1 − m)),   share = m
/// ```
pub fn parts(mean: f32, square: f32, share: f32) -> [f32; 3] {
    if share < 1.0 {
        return [if share > 0.0 { (mean / share).min(1.0) } else { 0.0 }, 0.0, share];
    }
    let variance = (square - mean * mean).max(0.0).min(mean * (1.0 - mean));
    // What rounding to bytes may be.
    if variance < 2.0 / 255.0 {
        return [mean, mean, 1.0];
    }
    let (sigma, ratio) = (variance.sqrt(), (mean / (1.0 - mean)).sqrt());
    [(mean + sigma / ratio).min(1.0), (mean - sigma * ratio).max(0.0), mean]
}

/// 1 − k (1 − G): the share of a dab's coverage that the grain leaves. `strength` k and `grey` G in `[0, 1]`.
pub fn factor_of(strength: f32, grey: f32) -> f32 {
    1.0 - strength * (1.0 - grey)
}

/// Cached textures: more than one painting uses.
const KEPT: usize = 16;
static MADE: Mutex<Vec<(PatternKey, Arc<Texture>)>> = Mutex::new(Vec::new());

/// Which pattern, its seed, its levels, its side.
type PatternKey = (Pattern, u32, [u32; 2], u32);

impl BrushGrain {
    /// G, its levels applied: red holds it, green its square, alpha whether it is not black.
    fn texture(&self) -> Arc<Texture> {
        let levels = self.levels.map(f32::to_bits);
        match &self.source {
            GrainSource::Pattern { pattern, seed } => {
                let side = Pattern::side_of(self.size_px);
                let make = || of_greys(&pattern.plane(*seed, side), self.levels);
                kept(&MADE, KEPT, (*pattern, *seed, levels, side), make)
            }
            GrainSource::Picture(source) => {
                let make = || of_greys(&luminance(source.texture()), self.levels);
                kept(source.stamps().grains(), KEPT, levels, make)
            }
        }
    }
}

/// The cached texture of a key, or a new one.
pub fn kept<K: PartialEq, V>(made: &Mutex<Vec<(K, Arc<V>)>>, most: usize, key: K, make: impl FnOnce() -> V) -> Arc<V> {
    let lock = || made.lock().unwrap_or_else(PoisonError::into_inner);
    let find = |made: &[(K, Arc<V>)]| made.iter().find(|(known, _)| *known == key).map(|(_, value)| value.clone());
    if let Some(value) = find(&lock()) {
        return value;
    }
    // Without the lock: two threads may both compute it; the results are equal.
    let value = Arc::new(make());
    let mut made = lock();
    if let Some(value) = find(&made) {
        return value;
    }
    if made.len() >= most {
        made.remove(0);
    }
    made.push((key, value.clone()));
    value
}

/// Grey bytes below this count as black: a stroke's dabs do not fill them.
const BLACK: u8 = 10;

fn square(v: u8) -> u8 {
    ((u32::from(v) * u32::from(v) + 127) / 255) as u8
}

fn of_greys(plane: &Plane<f32>, [low, high]: [f32; 2]) -> Texture {
    let span = (high - low).max(1.0 / 256.0);
    let mut picture = grey(&plane.map(|v| (v - low) / span));
    // What is read: red, the grey, green, its square, and alpha: whether there is any.
    if let crate::raster::picture::Texels::Srgb8(texels) = &picture.texels {
        let greys: Vec<[u8; 4]> =
            texels.iter().map(|&[v, ..]| [v, square(v), 0, if v < BLACK { 0 } else { 255 }]).collect();
        picture.texels = crate::raster::picture::Texels::Srgb8(greys.into());
    }
    Texture::new(&picture)
}

/// Of premultiplied texels: a light but transparent texel counts as dark.
fn luminance(texture: &Texture) -> Plane<f32> {
    let level = &texture.levels()[0];
    let grey =
        |&[r, g, b, _]: &[u8; 4]| (0.2126 * f32::from(r) + 0.7152 * f32::from(g) + 0.0722 * f32::from(b)) / 255.0;
    let values = level.texels.iter().map(grey).collect();
    Plane::from_values(level.size, values).unwrap_or_else(|| Plane::filled(level.size, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, vec2, vec3};
    use crate::surface::{Maps, Surface};

    const SIZE: Size = Size::new(128, 128);

    /// A ramp that comes nearer from left to right.
    fn ramp() -> Scene {
        let maps = Maps {
            normals: Plane::from_fn(SIZE, |_, _| vec3(0.0, 0.0, 1.0)),
            depth: Plane::from_fn(SIZE, |x, _| 1.0 - x as f32 / 127.0),
            coverage: Plane::from_fn(SIZE, |_, _| 255),
        };
        Scene { size: SIZE, surface: Some(Arc::new(Surface::new(maps).unwrap())) }
    }
    fn row(grain: &BrushGrain, scene: &Scene, y: usize) -> Vec<f32> {
        let laid = StrokeGrain::new(grain, vec2(64.0, 64.0));
        let tiles = [0, 1].map(|col| laid.tile(scene, TileAt::new(col, (y / TILE) as i32)));
        tiles.iter().flat_map(|tile| means(tile)[y % TILE * TILE..][..TILE].to_vec()).collect()
    }
    fn means(tile: &GrainTile) -> Vec<f32> {
        let of = |i: usize| tile.dark[i] + (tile.light[i] - tile.dark[i]) * tile.share[i];
        (0..TILE_AREA).map(of).collect()
    }
    fn lines(lies: GrainSpace) -> BrushGrain {
        let source = GrainSource::Pattern { pattern: Pattern::Lines, seed: 0 };
        BrushGrain { source, size_px: 8.0, rotation: 90.0, levels: [0.4, 0.6], lies, ..BrushGrain::default() }
    }
    /// How often a part of a row changes from bare to covered.
    fn crossings(row: &[f32]) -> usize {
        row.windows(2).filter(|pair| pair[0] < 0.5 && pair[1] >= 0.5).count()
    }

    #[test]
    fn strength_says_how_much_the_valleys_take_away() {
        assert_eq!(factor_of(0.0, 0.0), 1.0);
        assert_eq!(factor_of(1.0, 0.25), 0.25);
        assert_eq!(factor_of(0.5, 0.0), 0.5);
        let flat = Scene { size: SIZE, surface: None };
        let weak = BrushGrain { strength: 0.5, ..lines(GrainSpace::Canvas) };
        assert!(row(&weak, &flat, 10).iter().all(|f| (0.499..=1.0).contains(f)));
    }
    #[test]
    fn a_feature_of_a_pattern_is_as_large_as_the_grain_says_and_repeats() {
        let flat = Scene { size: SIZE, surface: None };
        assert!((15..=17).contains(&crossings(&row(&lines(GrainSpace::Canvas), &flat, 64))));
        let coarse = BrushGrain { size_px: 32.0, ..lines(GrainSpace::Canvas) };
        assert!((3..=5).contains(&crossings(&row(&coarse, &flat, 64))));
    }
    #[test]
    fn on_the_surface_grain_is_larger_where_the_shape_comes_near() {
        let row = row(&lines(GrainSpace::Surface { gamma: 1.5 }), &ramp(), 64);
        let (far, near) = (crossings(&row[..60]), crossings(&row[68..]));
        assert!(far > near + 1, "{far} lines on the far half, {near} on the near one");
    }
    #[test]
    fn on_a_flat_surface_and_where_the_stroke_begins_it_is_the_canvas_s() {
        let laid = |lies| means(&StrokeGrain::new(&lines(lies), vec2(20.5, 20.5)).tile(&ramp(), TileAt::new(0, 0)));
        let (canvas, surface) = (laid(GrainSpace::Canvas), laid(GrainSpace::Surface { gamma: 2.0 }));
        let start = 20 * TILE + 20;
        assert!((canvas[start] - surface[start]).abs() < 0.02);
        let flat = Scene { size: SIZE, surface: None };
        let [a, b] = [GrainSpace::Canvas, GrainSpace::Surface { gamma: 2.0 }].map(|lies| row(&lines(lies), &flat, 30));
        assert_eq!(a, b);
    }
    #[test]
    fn a_pixel_s_two_parts_have_its_mean_and_variance() {
        for (mean, square) in [(0.5, 0.5), (0.3, 0.2), (0.8, 0.7), (0.5, 0.26), (0.02, 0.02), (0.99, 0.985)] {
            let [light, dark, share] = parts(mean, square, 1.0);
            assert!((0.0..=1.0).contains(&dark) && dark <= light && light <= 1.0, "{mean} {square}");
            assert!((dark + (light - dark) * share - mean).abs() < 1e-5, "{mean} {square}");
            let found = dark * dark + (light * light - dark * dark) * share;
            assert!((found - square).abs() < 0.011, "{mean} {square}: {found}");
        }
        assert_eq!(parts(0.5, 0.5, 1.0), [1.0, 0.0, 0.5], "black and white");
        assert_eq!(parts(0.5, 0.25, 1.0), [0.5, 0.5, 1.0], "grey");
        assert_eq!(parts(0.2, 0.15, 0.5), [0.4, 0.0, 0.5], "half of it is black");
        for (mean, square) in [(0.0, 0.0), (1.0, 1.0), (0.0, 1.0), (1.0, 0.0)] {
            for share in [0.0, 0.01, 1.0] {
                assert!(parts(mean, square, share).iter().all(|v| (0.0..=1.0).contains(v)), "{mean} {square} {share}");
            }
        }
    }
    #[test]
    fn what_is_not_a_number_still_gives_factors() {
        let bad = BrushGrain {
            size_px: f32::NAN,
            rotation: f32::INFINITY,
            strength: f32::NAN,
            levels: [0.5, 0.5],
            ..BrushGrain::default()
        };
        assert!(row(&bad, &ramp(), 3).iter().all(|f| (0.0..=1.0).contains(f)));
    }
}
