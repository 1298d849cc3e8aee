use super::*;
use crate::math::{Size, srgb, srgb::Color};
use crate::raster::{Picture, Plane, TILE, Tile, TileAt};
use crate::shading::environment::projection::lat_long_direction;
use crate::shading::material::tests::term;
use crate::shading::{Environment, Model, Shading, Term};
use crate::surface::{Maps, Scene};

const SIZE: Size = Size::new(128, 100);
/// Two balls side by side: middle, camera space from the picture's middle (y up), and radius, px.
pub(in crate::shading::material) const PAIR: [(Vec3, f32); 2] =
    [(vec3(-31.0, 2.0, 0.0), 29.0), (vec3(31.0, -2.0, 3.0), 28.0)];

/// What a ray meets first: the place and the normal.
fn cast(balls: &[(Vec3, f32)], from: Vec3, toward: Vec3) -> Option<(Vec3, Vec3)> {
    let meets = balls.iter().filter_map(|&(middle, radius)| {
        let to = from - middle;
        let b = to.dot(toward);
        let under_root = b * b - to.length_squared() + radius * radius;
        let t = -b - under_root.max(0.0).sqrt();
        let place = from + toward * t;
        (under_root > 0.0 && t > 0.05).then(|| (t, place, (place - middle) / radius))
    });
    meets.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, place, normal)| (place, normal))
}

fn hit_at(balls: &[(Vec3, f32)], x: usize, y: usize) -> Option<(Vec3, Vec3)> {
    let at = vec2(x as f32 + 0.5, y as f32 + 0.5) - SIZE.center();
    cast(balls, vec3(at.x, -at.y, 400.0), Vec3::NEG_Z)
}

pub(in crate::shading::material) fn scene(balls: &[(Vec3, f32)]) -> Scene {
    let maps = Maps {
        normals: Plane::from_fn(SIZE, |x, y| hit_at(balls, x, y).map_or(Vec3::ZERO, |s| s.1)),
        depth: Plane::from_fn(SIZE, |x, y| {
            hit_at(balls, x, y).map_or(f32::NAN, |s| (40.0 - s.0.z) / 80.0)
        }),
        coverage: Plane::from_fn(SIZE, |x, y| if hit_at(balls, x, y).is_some() { 255 } else { 0 }),
    };
    Scene { size: SIZE, surface: Some(Arc::new(Surface::new(maps).unwrap())) }
}

/// Light that changes slowly in every direction.
fn sky(light: impl Fn(Vec3) -> [f32; 3]) -> Option<Environment> {
    let texel = |i: u32| {
        let e =
            lat_long_direction(((i % 256) as f32 + 0.5) / 256.0, ((i / 256) as f32 + 0.5) / 128.0);
        let [r, g, b] = light(e);
        [r, g, b, 1.0]
    };
    let picture =
        Picture::linear(Size::new(256, 128), (0..256 * 128).map(texel).collect()).unwrap();
    Some(Environment::new("sky.hdr".into(), picture))
}

fn slanted_light(e: Vec3) -> [f32; 3] {
    [0.5 + 0.45 * e.x, 0.5 + 0.45 * e.y, 0.5 + 0.45 * e.z]
}

fn tiles(shading: &Shading, scene: &Scene) -> Vec<Option<Tile>> {
    TileAt::covering(SIZE.rect()).map(|at| shading.render_tile(scene, at)).collect()
}

fn bytes(tiles: &[Option<Tile>]) -> Vec<Option<&[u8]>> {
    tiles.iter().map(|tile| tile.as_ref().map(Tile::bytes)).collect()
}

fn pixel(tiles: &[Option<Tile>], x: usize, y: usize) -> [u8; 4] {
    let tile = tiles[y / TILE * 2 + x / TILE].as_ref().unwrap();
    tile.bytes().as_chunks::<4>().0[y % TILE * TILE + x % TILE]
}

fn bouncing(model: Model, bounces: u32) -> Shading {
    let mut shading = Shading { bounces, environment: sky(slanted_light), ..Shading::new(model) };
    if model == Model::Ashikhmin {
        (shading.lights, shading.nu, shading.nv) = (Vec::new(), 200.0, 200.0);
    }
    shading
}
const BOUNCING: [Model; 3] = [Model::Mirror, Model::Refraction, Model::Ashikhmin];

#[test]
fn a_ball_is_seen_in_the_ball_beside_it() {
    let scene = scene(&PAIR);
    let gold = Color { r: 240, g: 210, b: 150, a: 255 };
    let mut shading = bouncing(Model::Mirror, 1);
    shading.specular = term(gold, 0.9, 0.0, 0.0);
    let tint = Vec3::from(shading.specular.linear());
    let (once, twice) =
        (tiles(&Shading { bounces: 0, ..shading.clone() }, &scene), tiles(&shading, &scene));
    let (mut met, mut sum, mut before) = (0.0, 0.0, 0.0);
    for (x, y) in (0..SIZE.area()).map(|i| (i % 128, i / 128)) {
        let Some((place, n)) = hit_at(&PAIR, x, y) else { continue };
        let r = 2.0 * n.z * n - Vec3::Z;
        let expected = match cast(&PAIR, place + n * 0.05, r) {
            None => continue,
            // The picture shows only what faces the eye; along rims pixels are too coarse.
            Some((_, m)) if m.z < 0.3 || m.dot(r) > -0.2 => continue,
            Some((_, m)) => tint * tint * Vec3::from(slanted_light(r - 2.0 * m.dot(r) * m)),
        };
        let off = |tiles: &[Option<Tile>]| -> f32 {
            let found = pixel(tiles, x, y);
            let byte = |c: usize| srgb::encode(expected[c]) * 255.0;
            (0..3).map(|c| (f32::from(found[c]) - byte(c)).abs()).fold(0.0, f32::max)
        };
        assert!(off(&twice) < 30.0, "({x}, {y}): {:?} for {expected}", pixel(&twice, x, y));
        (met, sum, before) = (met + 1.0, sum + off(&twice), before + off(&once));
    }
    assert!(
        met > 100.0 && sum / met < 5.0 && before / met > 40.0,
        "{met}: {} {}",
        sum / met,
        before / met
    );
}

#[test]
fn a_plane_and_a_lone_ball_stay_as_they_are() {
    let plane = Maps {
        normals: Plane::full(SIZE, vec3(0.5, -0.3, 1.0)),
        depth: Plane::from_fn(SIZE, |x, y| (x as f32 * 0.5 + y as f32 * 0.3) / 100.0),
        coverage: Plane::full(SIZE, 255),
    };
    let plane = Scene { size: SIZE, surface: Some(Arc::new(Surface::new(plane).unwrap())) };
    for scene in [plane, scene(&PAIR[..1])] {
        for model in BOUNCING {
            let [plain, bounced] = [0, 4].map(|bounces| tiles(&bouncing(model, bounces), &scene));
            assert!(bytes(&plain) == bytes(&bounced), "{}", model.name());
        }
    }
}

#[test]
fn bounces_are_the_same_bytes_on_any_number_of_threads() {
    use rayon::prelude::*;
    for model in BOUNCING {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let (scene, shading) = (scene(&PAIR), bouncing(model, 3));
            let ats: Vec<TileAt> = TileAt::covering(SIZE.rect()).collect();
            pool.install(|| {
                ats.par_iter().map(|&at| shading.render_tile(&scene, at)).collect::<Vec<_>>()
            })
        };
        let (one, three) = (on(1), on(3));
        assert!(bytes(&one) == bytes(&three), "{}", model.name());
    }
}

#[test]
fn where_light_is_the_same_everywhere_a_perfect_mirror_does_not_see_itself() {
    let scene = scene(&PAIR);
    let even = |bounces: u32| Shading {
        environment: sky(|_| [0.6; 3]),
        ..bouncing(Model::Mirror, bounces)
    };
    assert!(bytes(&tiles(&even(0), &scene)) == bytes(&tiles(&even(4), &scene)));
}

#[test]
fn a_glossy_ball_takes_the_color_of_the_one_beside_it() {
    let scene = scene(&PAIR);
    let red = Color { r: 220, g: 20, b: 20, a: 255 };
    let glossy = |bounces: u32| Shading {
        environment: sky(|e| [if e.z.abs() < 0.5 { 0.9 } else { 0.5 }; 3]),
        diffuse: Term::plain(red, 1.0),
        specular: Term::plain(Color::WHITE, 0.5),
        ..bouncing(Model::Ashikhmin, bounces)
    };
    let [plain, bounced] = [0, 2].map(|bounces| tiles(&glossy(bounces), &scene));
    // The left ball at the side of the right one: it mirrors light from there, which is red now.
    let (x, y) = (64 - 31 + 20, 48);
    let ([_, before, ..], [_, after, ..]) = (pixel(&plain, x, y), pixel(&bounced, x, y));
    assert!(before > after + 15, "{:?} {:?}", pixel(&plain, x, y), pixel(&bounced, x, y));
    // Its other side sees nothing but the sky.
    assert_eq!(pixel(&plain, 20, 48), pixel(&bounced, 20, 48));
}

#[test]
fn behind_contours_rays_begin_where_the_other_sides_lies() {
    // One ball before the other: contour pixels between both.
    let balls = [(vec3(-14.0, 2.0, 14.0), 26.0), (vec3(16.0, -2.0, -10.0), 28.0)];
    let scene = scene(&balls);
    let far = scene.far_side().unwrap();
    let shading = bouncing(Model::Mirror, 2);
    let surface = far.surface.as_deref().unwrap();
    let second = SecondLook::on(surface, 2).unwrap();
    let of = far.as_far_side().unwrap();
    let mut seen = 0;
    for (x, y) in
        (0..surface.size().area()).map(|i| (i % TILE, i / TILE)).filter(|(x, y)| x % 2 + y % 2 == 0)
    {
        if surface.coverage(x, y) > 0 {
            let start = second.start(x, y, surface.normal(x, y), Vec3::Z);
            let (px, py) = of.canvas_pixel(x as i32, y as i32);
            assert_eq!(start.at, vec2(px as f32 + 0.5, py as f32 + 0.5));
            // Not where the canvas's own side lies.
            let front = scene.surface.as_deref().unwrap().depth(px as usize, py as usize);
            seen += usize::from((second.map.nearness_of(front) - start.nearness).abs() > 2.0);
        }
    }
    assert!(seen > 20, "{seen}");
    let at = TileAt::new(0, 0);
    let pixels = |bounces: u32| Shading { bounces, ..shading.clone() }.render_tile(&far, at);
    assert!(pixels(2).is_some() && pixels(0).is_some());
}
