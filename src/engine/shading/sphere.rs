//! A lit sphere (Sloan et al. 2001; "matcap"): a painted sphere that gives the color of every
//! normal. Floor 3.

use crate::math::{Size, Vec2, Vec3, Vec3A, fast, srgb, vec2, vec3};
use crate::raster::{Picture, TILE};
use crate::shading::surface_row::{Light3, RowValues};
use rayon::prelude::*;
use std::sync::{Arc, LazyLock, OnceLock};

/// How many sizes of a sphere there are, each half of the one before.
const HALVINGS: usize = 5;

/// A picture whose inscribed disc is the sphere seen orthographically.
#[derive(Clone)]
pub struct LitSphere {
    /// Its name in the document.
    pub file: String,
    /// A painted sphere that fills its picture.
    pub picture: Picture,
    /// As large as its picture, half as large, and so on. Shared by clones, made on first use.
    light: Arc<[OnceLock<SphereLight>; HALVINGS]>,
}

impl PartialEq for LitSphere {
    /// The same picture, whatever its name.
    fn eq(&self, other: &Self) -> bool {
        self.picture == other.picture
    }
}

impl LitSphere {
    /// A painted sphere, under its name in the document.
    pub fn new(file: String, picture: Picture) -> Self {
        Self { file, picture, light: Arc::default() }
    }

    /// The sphere's light, ready to be looked up.
    pub fn light(&self) -> &SphereLight {
        self.level(0)
    }

    /// The same, as fine as is seen where its disc is so many px wide.
    pub fn light_at(&self, diameter_px: f32) -> &SphereLight {
        self.level(Self::halvings(self.picture.size, diameter_px) as usize)
    }

    /// How often a picture of a sphere is halved for that.
    pub fn halvings(size: Size, diameter_px: f32) -> f32 {
        let texels = size.width.min(size.height) as f32;
        let halvings = (texels / diameter_px.max(1.0)).log2().round();
        halvings.max(0.0).min((HALVINGS - 1) as f32)
    }

    fn level(&self, times: usize) -> &SphereLight {
        let make = || match times {
            0 => SphereLight::new(&self.picture),
            _ => self.level(times - 1).halved(),
        };
        crate::memory::once(&self.light[times], make)
    }

    /// Gray clay under a window at the upper left: the sphere of a layer that names none.
    pub fn clay() -> &'static LitSphere {
        static CLAY: LazyLock<LitSphere> = LazyLock::new(|| LitSphere::new(String::new(), clay()));
        &CLAY
    }
}

/// Linear light of a sphere by its projected normal.
pub struct SphereLight {
    size: Size,
    /// Beyond the disc the nearest color inside is repeated, so that lookups at the rim never read
    /// the picture's background. Each takes 16 bytes, so that one instruction reads it.
    texels: Vec<Vec3A>,
    /// The greatest luminance on the disc.
    brightest: f32,
}

impl SphereLight {
    fn new(picture: &Picture) -> Self {
        let (width, height) = (picture.size.width as usize, picture.size.height as usize);
        // This runs on one thread: a worker that waited for others could be given a tile that waits
        // for this same sphere.
        let texel = |i: usize| Vec3A::from(nearest_inside(picture, i % width, i / width));
        let texels: Vec<Vec3A> = match rayon::current_thread_index() {
            Some(_) => (0..width * height).map(texel).collect(),
            None => (0..width * height).into_par_iter().map(texel).collect(),
        };
        let brightest = texels.iter().map(|t| srgb::luminance(t.x, t.y, t.z)).fold(0.0, f32::max);
        Self { size: picture.size, texels, brightest }
    }

    /// Half as large: means of four texels.
    fn halved(&self) -> Self {
        let (w, h) = (self.size.width as usize, self.size.height as usize);
        let size = Size::new(self.size.width.div_ceil(2), self.size.height.div_ceil(2));
        let texel = |x: usize, y: usize| self.texels[y.min(h - 1) * w + x.min(w - 1)];
        let mean = |i: usize| {
            let (x, y) = (2 * (i % size.width as usize), 2 * (i / size.width as usize));
            (texel(x, y) + texel(x + 1, y) + texel(x, y + 1) + texel(x + 1, y + 1)) * 0.25
        };
        let texels: Vec<Vec3A> = (0..size.area()).map(mean).collect();
        Self { size, texels, brightest: self.brightest }
    }

    /// The color at ½ + ½ n̄ of the picture, bilinear, linear light (MATH 5). `nbar`: image axes
    /// (y down), length ≤ 1.
    #[inline(always)]
    pub fn at(&self, nbar: Vec2) -> [f32; 3] {
        let SphereSpot { index, across, along } = self.spot(nbar);
        self.interpolate(index, across, along).to_array()
    }

    /// The same for a row of normals, camera space (y up).
    pub fn at_row(&self, normal: &[RowValues; 3], light: &mut Light3) {
        read_row(self, normal, light);
    }

    #[inline(always)]
    fn spot(&self, nbar: Vec2) -> SphereSpot {
        let (w, h) = (self.size.width as i32, self.size.height as i32);
        let (x, y) = ((0.5 + 0.5 * nbar.x) * w as f32 - 0.5, (0.5 + 0.5 * nbar.y) * h as f32 - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let (i, j) = (fast::whole(left), fast::whole(top));
        let index = |i: i32, j: i32| j.max(0).min(h - 1) * w + i.max(0).min(w - 1);
        let index = [index(i, j), index(i + 1, j), index(i, j + 1), index(i + 1, j + 1)];
        SphereSpot { index, across: x - left, along: y - top }
    }

    /// Of four texels, by their numbers.
    #[inline(always)]
    fn interpolate(&self, index: [i32; 4], across: f32, along: f32) -> Vec3A {
        let texel = |i: i32| self.texels.get(i as usize).copied().unwrap_or_default();
        let above = texel(index[0]).lerp(texel(index[1]), across);
        let below = texel(index[2]).lerp(texel(index[3]), across);
        above.lerp(below, along)
    }

    /// The greatest luminance on the sphere.
    pub fn brightest(&self) -> f32 {
        self.brightest
    }
}

/// Where a normal is read: the numbers of four texels, and how far between them.
struct SphereSpot {
    index: [i32; 4],
    across: f32,
    along: f32,
}

crate::widest! {
    fn read_row(sphere: &SphereLight, normal: &[RowValues; 3], light: &mut Light3) {
        let mut index = [[0; TILE]; 4];
        let [mut across, mut along] = [[0.0; TILE]; 2];
        for x in 0..TILE {
            let spot = sphere.spot(vec2(normal[0][x], -normal[1][x]));
            [index[0][x], index[1][x], index[2][x], index[3][x]] = spot.index;
            (across[x], along[x]) = (spot.across, spot.along);
        }
        for x in 0..TILE {
            let index = [index[0][x], index[1][x], index[2][x], index[3][x]];
            let here = sphere.interpolate(index, across[x], along[x]);
            (light[0][x], light[1][x], light[2][x]) = (here.x, here.y, here.z);
        }
    }
}

/// The texel if it lies on the disc, else the nearest toward the center that does.
fn nearest_inside(picture: &Picture, x: usize, y: usize) -> [f32; 3] {
    let (w, h) = (picture.size.width as f32, picture.size.height as f32);
    // In units of the disc's radius, which may differ along x and y as the picture's sides do.
    let at = vec2((x as f32 + 0.5) / w * 2.0 - 1.0, (y as f32 + 0.5) / h * 2.0 - 1.0);
    // The outermost texel of the rim may be mixed with the background, so it is left out.
    let most = 1.0 - 1.5 / w.min(h);
    if at.length() <= most {
        let [r, g, b, _] = picture.linear_at(x, y);
        return [r, g, b];
    }
    let inside = at * (most.max(0.0) / at.length());
    let index = |v: f32, n: f32| (((v * 0.5 + 0.5) * n) as usize).min(n as usize - 1);
    let [r, g, b, _] = picture.linear_at(index(inside.x, w), index(inside.y, h));
    [r, g, b]
}

fn clay() -> Picture {
    const SIDE: u32 = 256;
    let (key, sky) = (vec3(-0.45, 0.6, 0.66).normalize_or(Vec3::Z), Vec3::Y);
    let color = |x: u32, y: u32| {
        let at = |i: u32| (i as f32 + 0.5) / SIDE as f32 * 2.0 - 1.0;
        let (u, v) = (at(x), -at(y));
        let n = vec3(u, v, (1.0 - u * u - v * v).max(0.0).sqrt()).normalize_or(Vec3::Z);
        let matt = 0.05 + 0.1 * (0.5 + 0.5 * n.dot(sky)) + 0.55 * n.dot(key).max(0.0);
        let gloss = 0.25 * (key + Vec3::Z).normalize_or(Vec3::Z).dot(n).max(0.0).powf(40.0);
        let byte = |tint: f32| srgb::quantize(srgb::encode(matt * tint + gloss));
        [byte(1.0), byte(0.97), byte(0.93), 255]
    };
    let texels = (0..SIDE * SIDE).map(|i| color(i % SIDE, i / SIDE)).collect();
    Picture::srgb8(Size::new(SIDE, SIDE), texels).expect("one color for each of the pixels")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disc whose red is x, whose green is y (down), on a bright background.
    fn disc(side: u32) -> LitSphere {
        let color = |i: u32| {
            let at = |v: u32| (v as f32 + 0.5) / side as f32;
            let (x, y) = (at(i % side), at(i / side));
            match (x - 0.5).hypot(y - 0.5) < 0.5 {
                true => [x, y, 0.0, 1.0],
                false => [9000.0, 9000.0, 9000.0, 1.0],
            }
        };
        let size = Size::new(side, side);
        LitSphere::new(
            "disc".into(),
            Picture::linear(size, (0..side * side).map(color).collect()).unwrap(),
        )
    }

    #[test]
    fn a_normal_finds_its_place_on_the_disc() {
        let sphere = disc(200);
        for nbar in [vec2(0.0, 0.0), vec2(0.5, -0.3), vec2(-0.6, 0.7)] {
            let [r, g, _] = sphere.light().at(nbar);
            assert!(
                (r - (0.5 + 0.5 * nbar.x)).abs() < 1e-4 && (g - (0.5 + 0.5 * nbar.y)).abs() < 1e-4,
                "{r} {g}"
            );
        }
    }

    #[test]
    fn a_row_reads_the_same_bits_as_single_normals() {
        let sphere = disc(57);
        let at = |x: usize| Vec2::from_angle(x as f32 * 0.7) * (x as f32 / (TILE - 1) as f32);
        let (nx, ny) = (std::array::from_fn(|x| at(x).x), std::array::from_fn(|x| -at(x).y));
        let mut light = [[0.0; TILE]; 3];
        sphere.light().at_row(&[nx, ny, [0.0; TILE]], &mut light);
        let read = |x: usize| light.map(|row| row[x]);
        (0..TILE).for_each(|x| assert_eq!(read(x), sphere.light().at(at(x)), "{x}"));
    }

    #[test]
    fn the_ground_around_the_sphere_is_never_seen() {
        for side in [1, 2, 3, 17, 256] {
            let sphere = disc(side);
            for i in 0..360 {
                let nbar = Vec2::from_angle((i as f32).to_radians());
                let light = sphere.light().at(nbar);
                assert!(light.iter().all(|v| *v <= 1.0), "{side} {i}: {light:?}");
            }
            assert!(sphere.light().brightest() <= 1.0);
        }
    }

    #[test]
    fn clay_is_brightest_at_the_upper_left() {
        let light = LitSphere::clay().light();
        let [lit, shaded] = [vec2(-0.4, -0.5), vec2(0.4, 0.5)].map(|nbar| light.at(nbar)[0]);
        assert!(lit > 0.4 && shaded < 0.3 && light.brightest() < 1.0, "{lit} {shaded}");
    }
}
