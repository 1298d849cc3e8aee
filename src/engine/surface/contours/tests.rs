//! Contours of analytic bodies, against means of 144 samples of each pixel.

mod spheres;

use super::*;
use crate::math::{Vec3, vec3};
use crate::raster::Plane;
use crate::surface::{Maps, Surface};
use spheres::hit_at;
use std::sync::Arc;

const SIZE: Size = Size::new(spheres::CANVAS[0], spheres::CANVAS[1]);

/// `bits`: of the stored normals; 0 is exact.
fn surface(bits: u32) -> Arc<Surface> {
    let at = |x: usize, y: usize| hit_at(x as f32 + 0.5, y as f32 + 0.5);
    let (low, high) = (-60.0, 220.0);
    let levels = ((1u32 << bits) - 1) as f32;
    let stored = |v: f32| {
        if bits == 0 { v } else { (((v + 1.0) * 0.5 * levels).round() / levels) * 2.0 - 1.0 }
    };
    let normal = |n: Vec3| vec3(stored(n.x), stored(n.y), stored(n.z));
    let normals = Plane::from_fn(SIZE, |x, y| at(x, y).map_or(Vec3::ZERO, |s| normal(s.1)));
    let depth =
        Plane::from_fn(SIZE, |x, y| at(x, y).map_or(f32::NAN, |s| (high - s.2) / (high - low)));
    let coverage = Plane::from_fn(SIZE, |x, y| if at(x, y).is_some() { 255 } else { 0 });
    Arc::new(Surface::new(Maps { normals, depth, coverage }).unwrap())
}

/// What partly covered pixels hold.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Told {
    /// The reading of the center, or none.
    OfCenters,
    /// The mean of what is covered.
    Means,
    /// The reading of the center, or that of nothing: far away, a normal toward the viewer.
    OfNothing,
}

/// The same with a mask of shades.
fn shaded_surface(told: Told) -> Arc<Surface> {
    let covered = |x: usize, y: usize| samples(x as i32, y as i32).flatten();
    let of_center = |x: usize, y: usize| hit_at(x as f32 + 0.5, y as f32 + 0.5);
    let is_mean =
        |x: usize, y: usize| told == Told::Means && (1..144).contains(&covered(x, y).count());
    let normals = Plane::from_fn(SIZE, |x, y| match is_mean(x, y) {
        true => covered(x, y).map(|s| s.1).sum::<Vec3>().normalize(),
        false => of_center(x, y)
            .map_or(if told == Told::OfNothing { Vec3::Z } else { Vec3::ZERO }, |s| s.1),
    });
    let height = |x: usize, y: usize| match is_mean(x, y) {
        true => covered(x, y).map(|s| s.2).sum::<f32>() / covered(x, y).count() as f32,
        false => {
            of_center(x, y).map_or(if told == Told::OfNothing { -60.0 } else { f32::NAN }, |s| s.2)
        }
    };
    let depth = Plane::from_fn(SIZE, |x, y| (220.0 - height(x, y)) / 280.0);
    let coverage = Plane::from_fn(SIZE, |x, y| (covered(x, y).count() * 255 / 144) as u8);
    Arc::new(Surface::new(Maps { normals, depth, coverage }).unwrap())
}

/// Light of a matt body with a highlight on a light ground.
fn shade(normal: Option<Vec3>) -> f32 {
    let Some(n) = normal else { return 0.9 };
    let light = vec3(0.4, 0.5, 0.77).normalize();
    let lit = n.dot(light);
    let mirrored = 2.0 * lit * n - light;
    0.08 + 0.55 * lit.max(0.0) + if lit > 0.0 { 0.5 * mirrored.z.max(0.0).powi(30) } else { 0.0 }
}

/// The mean over the samples of a pixel, and whether they show more than one thing.
fn reference(x: usize, y: usize) -> (f32, bool) {
    let at = |k: usize| (k as f32 + 0.5) / 12.0;
    let samples = (0..144).map(|k| hit_at(x as f32 + at(k % 12), y as f32 + at(k / 12)));
    let shows: Vec<_> = samples.collect();
    let first = shows[0].map(|s| s.0);
    let mean = shows.iter().map(|s| shade(s.map(|s| s.1))).sum::<f32>() / 144.0;
    (mean, shows.iter().any(|s| s.map(|s| s.0) != first))
}

/// Mean error on contour pixels of one sample, and of two sides.
fn errors(surface: &Arc<Surface>) -> [f32; 2] {
    let far = surface.far_side().unwrap();
    let mut mixed = Plane::from_fn(SIZE, |x, y| {
        shade((surface.coverage(x, y) > 0).then(|| surface.normal(x, y)))
    });
    for at in TileAt::covering(SIZE.rect()) {
        let Some(contours) = surface.contours().on(at) else { continue };
        for (i, pixel) in contours.pixels.iter().enumerate() {
            let (x, y) = (pixel.x as usize, pixel.y as usize);
            let other = (i < contours.seen).then(|| {
                let place = place_of(i);
                let (sx, sy) =
                    (contours.far.x0 as usize + place.0, contours.far.y0 as usize + place.1);
                assert_eq!(
                    far.as_far_side().unwrap().canvas_pixel(sx as i32, sy as i32),
                    (pixel.x, pixel.y)
                );
                far.normal(sx, sy)
            });
            mixed.set(x, y, pixel.share * mixed.at(x, y) + (1.0 - pixel.share) * shade(other));
        }
    }
    let (mut sums, mut count) = ([0.0; 2], 0);
    for y in 0..SIZE.height as usize {
        for x in 0..SIZE.width as usize {
            let (mean, is_contour) = reference(x, y);
            if is_contour {
                let one = hit_at(x as f32 + 0.5, y as f32 + 0.5).map(|s| s.1);
                sums[0] += (shade(one) - mean).abs();
                sums[1] += (mixed.at(x, y) - mean).abs();
                count += 1;
            }
        }
    }
    sums.map(|sum| sum / count as f32)
}

#[test]
fn smooth_bodies_come_within_a_fifth_of_one_samples_error() {
    for bits in [0, 16, 8] {
        let surface = surface(bits);
        let [one, two] = errors(&surface);
        eprintln!("bits {bits}: one sample {one}, two sides {two}, ratio {}", two / one);
        assert!(two < 0.2 * one, "{bits} bits: {two} of {one}");
    }
}

/// The samples of a pixel.
fn samples(x: i32, y: i32) -> impl Iterator<Item = Option<(usize, Vec3, f32)>> {
    let at = |k: usize| (k as f32 + 0.5) / 12.0;
    (0..144).map(move |k| hit_at(x as f32 + at(k % 12), y as f32 + at(k / 12)))
}

/// How far the maps' n̄ are from the mean of what a pixel's own side sees, and how far its
/// own normal's.
fn errors_of_own_normals(
    surface: &Arc<Surface>,
    owner: impl Fn(&ContourPixel) -> Option<usize>,
) -> [f32; 2] {
    let (mut before, mut after, mut count) = (0.0, 0.0, 0);
    for pixel in surface.contours().pixels() {
        let Some(own) = owner(pixel) else { continue };
        let shown = || samples(pixel.x, pixel.y).flatten().filter(|s| s.0 == own);
        let mean = shown().map(|s| s.1).sum::<Vec3>() / shown().count() as f32;
        let off = |normal: Vec3| (normal - mean).truncate().length();
        let center = surface.normal(pixel.x as usize, pixel.y as usize);
        (before, after, count) =
            (before + off(center), after + off(pixel.own_normal(center)), count + 1);
    }
    assert!(count > 300, "{count}");
    [before, after].map(|sum| sum / count as f32)
}

#[test]
fn a_pixel_s_own_normal_is_that_of_the_middle_of_its_own_share() {
    let at_center =
        |pixel: &ContourPixel| hit_at(pixel.x as f32 + 0.5, pixel.y as f32 + 0.5).map(|s| s.0);
    let [before, after] = errors_of_own_normals(&surface(0), at_center);
    assert!(after < 0.5 * before, "{before} became {after}");
}

#[test]
fn a_shaded_rim_reads_the_middle_of_what_is_covered_whether_or_not_its_maps_do() {
    // Pixels that show one sphere alone, and nothing.
    let alone = |pixel: &ContourPixel| {
        let mut seen = samples(pixel.x, pixel.y).flatten().map(|s| s.0);
        let first = seen.next();
        first.filter(|_| pixel.share < 1.0 && seen.all(|other| Some(other) == first))
    };
    for told in [Told::OfCenters, Told::Means, Told::OfNothing] {
        let shaded = shaded_surface(told);
        for pixel in shaded.contours().pixels().iter().filter(|pixel| !pixel.is_other_on_surface())
        {
            let covered = samples(pixel.x, pixel.y).flatten().count();
            assert!((pixel.share - covered as f32 / 144.0).abs() < 0.01, "{pixel:?}");
        }
        let [before, after] = errors_of_own_normals(&shaded, alone);
        eprintln!("{told:?}: {before}, own {after}");
        let most = [0.008, 0.002, 0.015][told as usize];
        assert!(after < most, "{told:?}: {before}, own {after}");
    }
}

/// How far shares are off, in the mean, along a straight edge with a nearer band beside it, `gap`
/// px away.
fn error_beside_a_band(gap: f32) -> f32 {
    let (mut error, mut count) = (0.0, 0.0);
    for turn in 0..6 {
        let toward_near = Vec2::from_angle(turn as f32 * 0.52 + 0.1);
        let edge = |x: usize, y: usize| {
            let from = vec2(x as f32 - 130.2, y as f32 - 100.3);
            line::ContourLine { distance_px: toward_near.dot(from), toward_near }
        };
        let depth = |d: f32| {
            if d < 0.0 { 0.8 } else { [0.4, 0.1][usize::from((gap..gap + 4.0).contains(&d))] }
        };
        let depth = Plane::from_fn(SIZE, |x, y| depth(edge(x, y).distance_px));
        let (normals, coverage) = (Plane::full(SIZE, Vec3::Z), Plane::full(SIZE, 255));
        let surface = Surface::new(Maps { normals, depth, coverage }).unwrap();
        for (x, y) in (5..195).flat_map(|y| (5..255).map(move |x| (x, y))) {
            let edge = edge(x, y);
            let own = if edge.distance_px < 0.0 { edge.turned() } else { edge }.nearer_share();
            if edge.distance_px.abs() < 0.7 && own < 0.998 {
                let found =
                    surface.contours().at(x as i32, y as i32).map_or(1.0, |pixel| pixel.share);
                (error, count) = (error + (found - own).abs(), count + 1.0);
            }
        }
    }
    error / count
}

#[test]
fn the_edge_of_a_narrow_band_is_found_next_to_a_third_piece() {
    let alone = error_beside_a_band(30.0);
    for gap in [2.0, 2.5, 3.0] {
        let error = error_beside_a_band(gap);
        eprintln!("{gap} px: {error}, alone {alone}");
        assert!(error < 1.5 * alone, "{gap} px: {error}, alone {alone}");
    }
}

#[test]
fn rows_hold_every_contour_pixel_of_a_tile_once() {
    let surface = surface(0);
    for at in TileAt::covering(SIZE.rect()) {
        let Some(contours) = surface.contours().on(at) else { continue };
        let key = |p: &ContourPixel| (p.y, p.x, p.is_other_on_surface());
        let rows = at.rect().y0..at.rect().y1;
        let mut found: Vec<_> =
            rows.flat_map(|y| contours.in_row(y).map(key).collect::<Vec<_>>()).collect();
        let mut expected: Vec<_> = contours.pixels.iter().map(key).collect();
        expected.sort();
        found.sort();
        assert_eq!(found, expected);
    }
}
