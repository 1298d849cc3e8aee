use super::*;
use crate::math::{Size, vec3};
use crate::raster::Plane;
use crate::surface::Maps;

const SIZE: Size = Size::new(220, 180);

/// Heights over a plane that lies at `deep` px of `range`; all of it is covered.
fn surface_of(size: Size, range: f32, height: impl Fn(f32, f32) -> f32 + Sync) -> Surface {
    let depth = Plane::from_fn(size, |x, y| 1.0 - height(x as f32, y as f32) / range);
    let maps =
        Maps { normals: Plane::full(size, Vec3::Z), depth, coverage: Plane::full(size, 255) };
    Surface::with_depth_range(maps, Some(range)).unwrap()
}

/// A ball that floats over a plane.
fn ball(x: f32, y: f32) -> f32 {
    let (dx, dy) = (x - 110.0, y - 90.0);
    let under_root = 30.0f32.powi(2) - dx * dx - dy * dy;
    if under_root > 0.0 { 50.0 + under_root.sqrt() } else { 10.0 }
}

fn lamp(place: LampPlace) -> ShadowLamp {
    ShadowLamp { place, radius: 0.13, reach_px: 220.0, rays: 32, is_coarse: false }
}

const SOME: [Vec3; 5] = [
    vec3(-0.52, 0.62, 0.59),
    vec3(0.8, 0.1, 0.5),
    vec3(0.3, -0.9, 0.8),
    vec3(-0.9, 0.05, 0.3),
    vec3(0.0, 0.0, 1.0),
];

/// What stands highest above a ray between two distances: by how much, and how far away.
fn highest(
    heights: &HeightMaps,
    q: Vec2,
    lamp: LampPlace,
    ray: &LampRay,
    (from, to): (f32, f32),
) -> (f32, f32, f32) {
    let h = heights.upright.whole.at(q.x as usize, q.y as usize);
    let (way, rise, farthest) = match (ray.aim, lamp) {
        (Aim::Along { way, rise }, _) => (way, rise, f32::MAX),
        (Aim::To(lamp), _) => {
            let flat = lamp.truncate() - q;
            let length = flat.length().max(1e-3);
            (flat / length, (lamp.z - h) / length, length)
        }
    };
    let step = 1.0 / way.abs().max_element();
    let mut found = (f32::MIN, 0.0, rise.max(RISE.0));
    let (first, last) = ((from / step) as i32 + 1, (to / step).max(1.0) as i32);
    for t in (first..=last).map(|i| i as f32 * step).take_while(|t| *t < farthest) {
        let at = q + way * t;
        // Rays to a point draw together on their way to it.
        let nearer = if farthest < f32::MAX { farthest / (farthest - t) } else { 1.0 };
        let above = (heights.interpolate(at.x, at.y) - h - rise * t) * nearer;
        if above > found.0 {
            (found.0, found.1) = (above, t);
        }
    }
    found
}

/// How much of a ray is hidden beyond a distance: what is far fades, and near, low things hide as
/// well as far, high ones.
fn share_hidden_beyond(
    heights: &HeightMaps,
    q: Vec2,
    lamp: LampPlace,
    ray: &LampRay,
    from: f32,
) -> f32 {
    let split = 0.5 * ray.reach_px;
    let [near, far] = [(from, split), (split, ray.reach_px)].map(|window| {
        let (above, t, rise) = highest(heights, q, lamp, ray, window);
        hidden_share(above, t, rise, ray.spread) * fade(t, split, ray.reach_px)
    });
    near.max(far)
}

/// The share of a lamp that a pixel sees: the equation, pixel after pixel along each ray.
fn share_seen_from(heights: &HeightMaps, (x, y): (usize, usize), lamp: &ShadowLamp) -> f32 {
    let q = vec2(x as f32, y as f32);
    if let LampPlace::At(_) = lamp.place {
        let rays = lamp.rays(heights.highest);
        let hidden: f32 =
            rays.iter().map(|ray| share_hidden_beyond(heights, q, lamp.place, ray, 0.0)).sum();
        return seen_share(hidden / lamp.rays as f32);
    }
    let rays = parallel::RayGroups::of(lamp, heights.highest);
    let of_group = |group: &parallel::RayGroup| {
        let (above, t, rise) = highest(heights, q, lamp.place, &group.near, (0.0, rays.near_px));
        let near = hidden_share(above, t, rise, group.near.spread) * group.far.len() as f32;
        let beyond = |ray| share_hidden_beyond(heights, q, lamp.place, ray, rays.near_px);
        near.max(group.far.iter().map(beyond).sum())
    };
    seen_share(rays.groups.iter().map(of_group).sum::<f32>() / rays.count as f32)
}

/// The mean difference between the fast way and the equation, and the share of pixels where it is
/// more than a twentieth.
fn differences(surface: &Surface, lamp: &ShadowLamp) -> (f32, f32) {
    let (fast, heights) = (surface.shadow(lamp, 1), surface.heights());
    let (mut sum, mut far, mut count) = (0.0, 0, 0);
    for (x, y) in (3..surface.size().height as usize)
        .step_by(7)
        .flat_map(|y| (2..surface.size().width as usize).step_by(5).map(move |x| (x, y)))
    {
        let off = (fast.at(x, y) - share_seen_from(&heights, (x, y), lamp)).abs();
        (sum, far, count) = (sum + off, far + u32::from(off > 0.05), count + 1);
    }
    (sum / count as f32, far as f32 / count as f32)
}

#[test]
fn sweeping_a_map_finds_what_one_pixel_after_another_does() {
    let surface = surface_of(SIZE, 100.0, ball);
    for direction in SOME {
        // Soft shadows are looked at from farther away at half the size.
        let soft = lamp(LampPlace::Afar(direction));
        let (mean, far) = differences(&surface, &soft);
        assert!(mean < 0.004 && far < 0.025, "{direction}: {mean} {far}");
        let (mean, far) = differences(&surface, &ShadowLamp { radius: 0.03, ..soft });
        assert!(mean < 0.002 && far < 0.01, "{direction}, small: {mean} {far}");
    }
    for at in [vec3(20.0, 30.0, 150.0), vec3(110.3, 60.2, 90.0), vec3(-50.0, 260.0, 40.0)] {
        let (mean, far) = differences(&surface, &lamp(LampPlace::At(at)));
        assert!(mean < 0.004 && far < 0.015, "{at}: {mean} {far}");
    }
}

/// Where a share is crossed along a row from the left on, px.
fn crossing(shadow: &ShareMap, y: usize, xs: std::ops::Range<usize>, share: f32) -> f32 {
    for x in xs {
        let (here, next) = (shadow.at(x, y), shadow.at(x + 1, y));
        if (here - share) * (next - share) <= 0.0 && here != next {
            return x as f32 + (share - here) / (next - here);
        }
    }
    f32::NAN
}

#[test]
fn a_flat_occluder_throws_its_umbra_to_the_pixel() {
    // A table of height 60 over a plane; the lamp stands left, and its shadow falls right.
    let table = |x: f32, _: f32| if (40.0..100.0).contains(&x) { 60.0 } else { 0.0 };
    let surface = surface_of(Size::new(320, 60), 60.0, table);
    for (direction, rise) in [(vec3(-0.8, 0.0, 0.6), 0.75), (vec3(-0.6, 0.0, 0.8), 4.0 / 3.0)] {
        let sharp = ShadowLamp { radius: 0.0, ..lamp(LampPlace::Afar(direction)) };
        let sharp = ShadowLamp { reach_px: 1000.0, ..sharp };
        let end = crossing(&surface.shadow(&sharp, 1), 30, 110..310, 0.5);
        // The table's last pixel ends at 99.5, counted from pixel centers.
        let exact = 99.5 + 60.0 / rise;
        assert!((end - exact).abs() < 1.0, "{direction}: {end}, not {exact}");
    }
}

#[test]
fn a_lamp_nearby_throws_the_umbra_of_a_flat_occluder_to_the_pixel() {
    let table = |x: f32, _: f32| if (40.0..100.0).contains(&x) { 60.0 } else { 0.0 };
    let surface = surface_of(Size::new(420, 60), 60.0, table);
    for at in [vec3(-60.0, 30.0, 40.0), vec3(20.0, 30.0, 60.0), vec3(-200.0, 50.0, 100.0)] {
        let sharp = ShadowLamp { radius: 0.0, reach_px: 4000.0, ..lamp(LampPlace::At(at)) };
        let end = crossing(&surface.shadow(&sharp, 1), 30, 105..415, 0.5);
        // The line from the lamp over the table's last edge, half a pixel of which grows with it.
        let grows = (at.z + 60.0) / at.z;
        let exact = at.x - 0.5 + (99.5 - (at.x - 0.5)) * grows;
        assert!((end - exact).abs() < 0.6 * grows, "{at}: {end}, not {exact}");
    }
}

#[test]
fn shadows_of_a_lamp_nearby_move_evenly_with_it() {
    let surface = surface_of(SIZE, 100.0, ball);
    let shadow = |degree: usize| {
        let (sin, cos) = (2.0 * degree as f32).to_radians().sin_cos();
        let at = vec3(110.0 - 150.0 * cos, 90.0 - 150.0 * sin, 110.0);
        surface.shadow(&lamp(LampPlace::At(at)), 2)
    };
    let moved = |degree: usize| {
        let (before, now) = (shadow(degree), shadow(degree + 1));
        let pixels = (0..180).flat_map(|y| (0..220).map(move |x| (x, y)));
        pixels.map(|(x, y)| (now.at(x, y) - before.at(x, y)).abs()).sum::<f32>()
    };
    let steps: Vec<f32> = (0..44).step_by(4).map(moved).collect();
    let mean = steps.iter().sum::<f32>() / steps.len() as f32;
    let most = steps.iter().copied().fold(0.0, f32::max);
    assert!(most < 1.2 * mean, "{most} where {mean} is usual: {steps:?}");
}

#[test]
fn a_penumbra_widens_in_proportion_to_the_distance() {
    // Tables of two heights: their shadows end at twice the distance.
    let width = |height: f32| {
        let table = move |x: f32, _: f32| if (20.0..60.0).contains(&x) { height } else { 0.0 };
        let surface = surface_of(Size::new(420, 100), 160.0, table);
        let soft = ShadowLamp {
            reach_px: 4000.0,
            rays: MOST_RAYS,
            ..lamp(LampPlace::Afar(vec3(-0.7, 0.0, 0.7)))
        };
        let shadow = surface.shadow(&soft, 1);
        let [dark, light] = [0.1, 0.9].map(|share| crossing(&shadow, 50, 70..400, share));
        light - dark
    };
    let widths = [40.0, 80.0, 160.0].map(width);
    for pair in widths.windows(2) {
        let ratio = pair[1] / pair[0];
        assert!((ratio - 2.0).abs() < 0.2, "{widths:?}");
    }
}

#[test]
fn a_ball_over_a_plane_throws_a_softer_shadow_from_higher_up() {
    let width = |lift: f32| {
        let at = move |x: f32, y: f32| {
            let under_root = 900.0 - (x - 60.0).powi(2) - (y - 60.0).powi(2);
            if under_root > 0.0 { lift + under_root.sqrt() } else { 0.0 }
        };
        let surface = surface_of(Size::new(420, 120), 220.0, at);
        let soft = ShadowLamp {
            reach_px: 4000.0,
            rays: MOST_RAYS,
            ..lamp(LampPlace::Afar(vec3(-0.7, 0.0, 0.7)))
        };
        let shadow = surface.shadow(&soft, 1);
        // The far end of the shadow, which ends about as far away as the ball is high.
        let from = 60 + lift as usize;
        let [dark, light] = [0.25, 0.75].map(|share| crossing(&shadow, 60, from..410, share));
        light - dark
    };
    let [near, far] = [60.0, 120.0].map(width);
    // The end of the shadow is 60 and 120 px below the ball's edge, and 12 more.
    let ratio = (120.0 + 12.0) / (60.0 + 12.0);
    assert!((far / near / ratio - 1.0).abs() < 0.1, "{near} {far}: {}", far / near);
}

#[test]
fn no_shadow_falls_on_a_part_in_front() {
    // A low ridge before a high plateau: light comes over the ridge.
    let at = |x: f32, _: f32| match x {
        x if x < 40.0 => 30.0,
        x if x < 100.0 => 0.0,
        _ => 40.0,
    };
    let surface = surface_of(Size::new(200, 60), 60.0, at);
    let shadow = surface.shadow(&lamp(LampPlace::Afar(vec3(-0.8, 0.0, 0.4))), 1);
    assert!(
        shadow.at(60, 30) < 0.1,
        "the valley lies in the ridge's shadow: {}",
        shadow.at(60, 30)
    );
    for x in 102..190 {
        assert!(shadow.at(x, 30) > 0.999, "{x}: {}", shadow.at(x, 30));
    }
}

#[test]
fn a_level_plane_casts_nothing_on_itself_under_any_lamp() {
    let surface = surface_of(Size::new(120, 90), 60.0, |_, _| 20.0);
    for z in [1.0, 0.5, 0.2, 0.05] {
        for turn in 0..12 {
            let (sin, cos) = (turn as f32 * std::f32::consts::FRAC_PI_6).sin_cos();
            let shadow = surface.shadow(&lamp(LampPlace::Afar(vec3(cos, sin, z))), 1);
            let least = (0..90).map(|y| shadow.at(60, y)).fold(1.0, f32::min);
            assert!(least > 0.98, "{z} {turn}: {least}");
        }
    }
}

#[test]
fn shadows_move_evenly_while_the_lamp_turns() {
    let surface = surface_of(SIZE, 100.0, ball);
    let mut steps = Vec::new();
    let mut before: Option<Arc<ShareMap>> = None;
    for degree in 0..90 {
        let (sin, cos) = (degree as f32).to_radians().sin_cos();
        let now = surface.shadow(&lamp(LampPlace::Afar(vec3(-cos, sin, 0.8))), 2);
        if let Some(before) = before.replace(now.clone()) {
            let of_row = |y: usize| (0..220).map(move |x| (x, y));
            let moved: f32 = (0..180)
                .flat_map(of_row)
                .map(|(x, y)| (now.at(x, y) - before.at(x, y)).abs())
                .sum();
            steps.push(moved);
        }
    }
    let mean = steps.iter().sum::<f32>() / steps.len() as f32;
    let most = steps.iter().copied().fold(0.0, f32::max);
    assert!(most < 1.35 * mean, "{most} where {mean} is usual: {steps:?}");
}

#[test]
fn while_a_lamp_is_dragged_its_shadow_is_nearly_that_at_rest() {
    let surface = surface_of(SIZE, 100.0, ball);
    for direction in &SOME[..4] {
        let at_rest = lamp(LampPlace::Afar(*direction));
        let coarse = ShadowLamp { rays: 4, is_coarse: true, ..at_rest };
        let (whole, draft) = (surface.shadow(&at_rest, 2), surface.shadow(&coarse, 2));
        let pixels = || (0..180).flat_map(|y| (0..220).map(move |x| (x, y)));
        let shade: f32 = pixels().map(|(x, y)| 1.0 - whole.at(x, y)).sum();
        let off: f32 = pixels().map(|(x, y)| (whole.at(x, y) - draft.at(x, y)).abs()).sum();
        assert!(off < 0.15 * shade + 40.0, "{direction}: {off} of {shade}");
    }
}

#[test]
fn any_number_of_threads_finds_the_same_shadow() {
    let surface = surface_of(SIZE, 100.0, ball);
    let [far, near] = [LampPlace::Afar(SOME[0]), LampPlace::At(vec3(30.0, 150.0, 90.0))].map(lamp);
    let lamps = [far, near, ShadowLamp { rays: 4, is_coarse: true, ..far }];
    let made = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| lamps.map(|lamp| ShareMap::of_lamp(&surface.heights(), &lamp)))
    };
    let one = made(1);
    for threads in [2, 3, 7] {
        for (a, b) in one.iter().zip(&made(threads)) {
            let same = (0..180).all(|y| (0..220).all(|x| a.at(x, y) == b.at(x, y)));
            assert!(same, "{threads} threads");
        }
    }
}

#[test]
fn an_edge_beside_what_stands_higher_is_shaded() {
    let at = |x: f32, _: f32| if x < 60.0 { 40.0 } else { 0.0 };
    let surface = surface_of(Size::new(200, 60), 60.0, at);
    let contact = surface.contact(45.0);
    assert!(contact.higher.at(62, 30) > 1.0 && contact.higher.at(180, 30) < 0.01);
    assert!(contact.higher.at(30, 30) == 0.0 && contact.lower.at(58, 30) > 0.2);
}
