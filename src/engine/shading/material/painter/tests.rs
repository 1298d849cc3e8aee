use super::*;
use crate::math::Size;
use crate::math::srgb::Color;
use crate::raster::{Plane, TileAt};
use crate::shading::radiance::Exactness;
use crate::shading::{Light, LightKind, Model};
use crate::surface::{Maps, Scene};

/// The light of one pixel: the table of MATH 5, line by line, under one lamp of radiance 1.
///
/// * `lit`: the share of the lamp that is seen; `higher`, `lower`: as in `ContactShade`.
fn light_of(
    shading: &Shading,
    a: [f32; 3],
    (n, l): (Vec3, Vec3),
    lit: f32,
    (higher, lower): (f32, f32),
) -> [f32; 3] {
    let p = &shading.painter;
    let o = p.contact_floor + (1.0 - p.contact_floor) * (-0.4 * p.contact * higher).exp();
    let k = ((n.dot(l) + p.wrap) / (1.0 + p.wrap)).max(0.0);
    let left = shading.shadows.remaining_light();
    let edge = (4.0 * k * (1.0 - k)).max(0.0).powi(2) * lit * 0.25 * p.edge;
    let back = vec3(-l.x, 0.8 - l.y, -0.25).normalize();
    let smooth = |from: f32, to: f32, v: f32| {
        let t = ((v - from) / (to - from)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    };
    let rim = smooth(0.55, 0.98, 1.0 - n.z)
        * (n.dot(back) + 0.25).max(0.0)
        * o
        * smooth(0.12, 0.45, lower);
    let half = (l + Vec3::Z).normalize();
    let gloss = n.dot(half).max(0.0).powf(shading.shininess) - half.z.powf(shading.shininess);
    let shine = gloss.max(0.0) * lit * shading.specular.weight;
    let of = |c: usize| {
        let warm = 1.0 + p.warmth * [0.06, 0.0, -0.1][c];
        let key = k * warm * (lit + (1.0 - lit) * left[c]);
        let up = 0.5 + 0.5 * n.y;
        let even = up * p.fill * 0.44 * p.fill_color.linear()[c]
            + (-n.y).max(0.0) * p.bounce * 0.30 * p.bounce_color.linear()[c]
            + 0.10 * p.around;
        let knee = |e: f32| if e > 0.7 { 0.7 + (e - 0.7) / (1.0 + (e - 0.7) / 0.6) } else { e };
        let e = knee((key + o * even) * p.exposure) / knee(LEVEL[c]);
        let rich = a[c].powf([0.94, 1.06, 1.12][c]);
        let rim = rim * p.rim * 0.55 * p.rim_color.linear()[c] * (0.35 + a[c]);
        (a[c] * (1.0 - edge.min(1.0)) + rich * edge.min(1.0)) * e + p.exposure * (rim + shine)
    };
    [of(0), of(1), of(2)]
}

/// A ball on a plane, and its figure alone.
fn ball(size: Size, on_plane: bool) -> Scene {
    let (w, h) = (size.width as f32, size.height as f32);
    let radius = 0.3 * h;
    let at = move |x: usize, y: usize| {
        let (u, v) = ((x as f32 - w / 2.0) / radius, (h / 2.0 - y as f32) / radius);
        let z2 = 1.0 - u * u - v * v;
        if z2 > 0.0 { Some(vec3(u, v, z2.sqrt())) } else { None }
    };
    let maps = Maps {
        normals: Plane::from_fn(size, |x, y| at(x, y).unwrap_or(Vec3::Z)),
        depth: Plane::from_fn(size, |x, y| at(x, y).map_or(1.0, |n| 1.0 - n.z)),
        coverage: Plane::from_fn(size, |x, y| if on_plane || at(x, y).is_some() { 255 } else { 0 }),
    };
    Scene { size, surface: Some(Arc::new(Surface::new(maps).unwrap())) }
}

#[test]
fn rows_are_lit_as_the_table_says() {
    let scene = ball(Size::new(160, 150), false);
    let surface = scene.surface.as_deref().unwrap();
    let mut shading = Shading::new(Model::Painter);
    shading.shadows.color = Color::rgb(60, 40, 120);
    shading.painter.rim = 2.0;
    let features = shading.features.on(surface);
    let lights = &mut shading.row_lights(surface);
    let (mut terms, mut out) = (PainterTerms::new(&shading, surface, lights), [[0.0; TILE]; 3]);
    let (contact, own) = (surface.contact(shading.painter.contact_size), [0.7, 0.3, 0.1]);
    let l = vec3(-0.52, 0.62, 0.59).normalize();
    for y in (0..150).step_by(7) {
        let row = SurfaceRow::new(surface, &features, 48, y, 64);
        lights.iter_mut().for_each(|lit| lit.turn(&row));
        terms.read(&row, lights, 0);
        terms.shade(&shading, lights, &own.map(|c| [c; TILE]), &mut out);
        for x in 0..64 {
            let lit = lights[0].shadow.as_ref().unwrap().seen[x];
            let around = (contact.higher.at(48 + x, y), contact.lower.at(48 + x, y));
            let exact = light_of(&shading, own, (row.normal_at(x), l), lit, around);
            let painted = out.map(|channel| channel[x]);
            let off = (0..3).map(|c| (painted[c] - exact[c]).abs()).fold(0.0, f32::max);
            assert!(off < 2e-4, "{x} {y}: {painted:?} {exact:?}");
        }
    }
}

/// A layer that lights what is beneath, straight ahead.
fn straight_ahead() -> Shading {
    let kind = LightKind::Directional { direction: Vec3::Z };
    let mut shading = Shading::new(Model::Painter);
    shading.lights = vec![Light { kind, ..Light::default() }];
    shading.painter.beneath = true;
    shading
}

#[test]
fn pixel_shading_has_as_many_tones_as_bands_and_nothing_between() {
    let scene = ball(Size::new(64, 64), true);
    let own = [0xd0, 0x88, 0x58];
    let mut shading = Shading::new(Model::Painter);
    shading.painter.beneath = true;
    shading.pixel.bands = 4;
    let tones: Vec<[u8; 3]> = (-2..=1).map(|step| shading.pixel.tone(own, step)).collect();
    for exactness in [Exactness::Fast, Exactness::Exact] {
        let mut tile = crate::raster::PlanarTile::transparent();
        tile.rows_mut().iter_mut().for_each(|row| {
            row.rgb = own.map(|c| [f32::from(c) / 255.0; TILE]);
            row.a = [1.0; TILE];
        });
        shading.light_tile(&scene, TileAt::new(0, 0), exactness, &mut tile);
        let mut found: Vec<[u8; 3]> = tile
            .rows()
            .iter()
            .flat_map(|row| (0..TILE).map(|x| row.rgb.map(|c| crate::math::srgb::quantize(c[x]))))
            .collect();
        assert_eq!(found[0], own, "a level part keeps its color");
        found.sort_unstable();
        found.dedup();
        assert!(found.len() >= 3, "{found:?}");
        assert!(found.iter().all(|tone| tones.contains(tone)), "{found:?} of {tones:?}");
    }
}

#[test]
fn a_level_part_lit_from_straight_ahead_keeps_its_color() {
    let scene = ball(Size::new(300, 300), true);
    for color in [[0.9, 0.8, 0.7], [0.3, 0.5, 0.9], [0.05, 0.1, 0.02]] {
        let mut tile = crate::raster::PlanarTile::transparent();
        tile.rows_mut().iter_mut().for_each(|row| {
            row.rgb = color.map(|c| [c; TILE]);
            row.a = [1.0; TILE];
        });
        let exact = crate::shading::radiance::Exactness::Exact;
        // A corner, far from the ball.
        straight_ahead().light_tile(&scene, TileAt::new(0, 0), exact, &mut tile);
        let linear = |v: f32| crate::math::srgb::decode(v);
        for (c, color) in color.into_iter().enumerate() {
            let found = linear(tile.rows()[3].rgb[c][3]) / linear(color);
            assert!((found - 1.0).abs() < 0.02, "{color}: {found}");
        }
    }
}
