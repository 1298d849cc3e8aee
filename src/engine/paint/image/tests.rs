//! Placed pictures, bent and not, as bytes.

use super::*;
use crate::math::{hash, vec2, vec3};
use crate::paint::Adjust;
use crate::raster::{Plane, TileGrid, picture::Texels, sampler};
use crate::surface::operator::second_order;
use crate::surface::{Anchor, Maps, Operator, Surface};
use std::sync::Arc;

/// Every tile of the layer, as straight bytes of the canvas.
fn render(image: &PlacedImage, scene: &Scene) -> Vec<u8> {
    let mut grid = TileGrid::for_rect(scene.size.rect());
    for at in TileAt::covering(scene.size.rect()) {
        grid.set(at, image.render_tile(scene, at).map(Arc::new));
    }
    grid.to_straight_rgba(scene.size.rect())
}

fn noise(size: Size) -> Picture {
    let byte = |i: u32, c: u32| (hash::unit(3, i, c) * 256.0) as u8;
    let texel = |i| [byte(i, 0), byte(i, 1), byte(i, 2), 255];
    Picture::srgb8(size, (0..size.area() as u32).map(texel).collect()).unwrap()
}

fn place(picture: Picture, canvas: Size) -> PlacedImage {
    PlacedImage {
        source: PictureSource::new("noise.png".into(), picture, Adjust::default()),
        placement: Placement::covering(canvas),
        outside: Outside::None,
        bend: Bend::default(),
        filter: ImageFilter::Bilinear,
        frame: Default::default(),
    }
}

#[test]
fn an_unbent_picture_of_the_canvas_size_equals_its_file_byte_for_byte() {
    let size = Size::new(131, 70);
    let picture = noise(size);
    let Texels::Srgb8(texels) = &picture.texels else { unreachable!() };
    let texels = texels.as_flattened().to_vec();
    let scene = Scene { size, surface: None };
    for filter in [ImageFilter::Bilinear, ImageFilter::Antialias] {
        let image = PlacedImage { filter, ..place(picture.clone(), size) };
        assert!(render(&image, &scene) == texels, "{filter:?}");
    }
}

#[test]
fn a_tile_beyond_the_canvas_or_the_picture_is_nothing() {
    let size = Size::new(100, 100);
    let scene = Scene { size, surface: None };
    let mut image = place(noise(size), size);
    assert!(image.render_tile(&scene, TileAt::new(2, 0)).is_none());
    assert!(image.render_tile(&scene, TileAt::new(-1, 0)).is_none());
    image.placement.center = vec2(-400.0, 50.0);
    assert!(image.render_tile(&scene, TileAt::new(0, 0)).is_none());
}

#[test]
fn dragged_content_shows_its_source_point_at_the_anchor() {
    let size = Size::new(64, 64);
    let picture = noise(size);
    let scene = Scene { size, surface: None };
    let mut image = place(picture.clone(), size);
    image.bend.anchors = vec![Anchor { at: vec2(10.5, 20.5), source: vec2(40.5, 7.5) }];
    let bytes = render(&image, &scene);
    let Texels::Srgb8(texels) = &picture.texels else { unreachable!() };
    assert_eq!(bytes[(20 * 64 + 10) * 4..][..4], texels[7 * 64 + 40]);
}

#[test]
fn an_angular_map_that_covers_the_mirror_leaves_no_holes() {
    let size = Size::new(96, 80);
    let on = |x: usize, y: usize| (vec2(x as f32, y as f32) + 0.5 - size.center()) / 38.0;
    let z = |x: usize, y: usize| (1.0 - on(x, y).length_squared()).max(0.0).sqrt();
    let maps = Maps {
        normals: Plane::from_fn(size, |x, y| {
            crate::math::vec3(on(x, y).x, -on(x, y).y, z(x, y).max(0.01))
        }),
        depth: Plane::from_fn(size, |x, y| 1.0 - z(x, y)),
        coverage: Plane::from_fn(size, |x, y| if on(x, y).length() < 1.0 { 255 } else { 0 }),
    };
    let scene = Scene { size, surface: Some(Arc::new(Surface::new(maps).unwrap())) };
    // The inscribed disc of a square.
    let disc = |i: u32| {
        let from_middle = vec2((i % 64) as f32 + 0.5, (i / 64) as f32 + 0.5) - 32.0;
        if from_middle.length() < 32.0 { [255; 4] } else { [0; 4] }
    };
    let map = Picture::srgb8(Size::new(64, 64), (0..64 * 64).map(disc).collect()).unwrap();
    let at = vec2(62.0, 33.0);
    let (x, y) = (at.x as usize, at.y as usize);
    let turn =
        crate::surface::operator::reflection::mirrored(vec2(on(x, y).x, on(x, y).y), z(x, y));
    let holes = |placement: Placement| {
        let bend = Bend {
            operator: Operator::Reflection { alpha: 1.0, detail: 0.0 },
            anchors: vec![Anchor::pin(at)],
            ..Bend::default()
        };
        let image = PlacedImage { placement, bend, ..place(map.clone(), size) };
        let alphas = render(&image, &scene).into_iter().skip(3).step_by(4).enumerate();
        let covered = |i: usize| on(i % 96, i / 96).length() < 1.0;
        alphas.filter(|(i, a)| covered(*i) && *a < 250).count()
    };
    assert_eq!(holes(Placement::covering_mirror(size, 1.0, turn)), 0);
    assert!(holes(Placement::covering(size)) > 400, "or else the test says nothing");
}

#[test]
fn a_picture_of_the_canvas_size_maps_pixel_for_pixel() {
    let size = Size::new(300, 200);
    let m = Placement::covering(size).texels_from_canvas(size, size);
    assert!((m.transform_point2(vec2(12.5, 7.5)) - vec2(12.5, 7.5)).length() < 1e-4);
}

#[test]
fn rotation_is_counter_clockwise_as_seen() {
    let size = Size::new(200, 200);
    let placement = Placement { rotation: 90.0, ..Placement::covering(size) };
    // The picture's right end must be at the top of the canvas.
    let texel = placement.texels_from_canvas(size, size).transform_point2(vec2(100.0, 10.0));
    assert!((texel - vec2(190.0, 100.0)).length() < 1e-3, "{texel}");
}

/// The document's surface from its n̄ (image axes) and depth at a pixel's column and row.
fn scene(
    size: Size,
    nbar: impl Fn(Vec2) -> Vec2 + Sync,
    depth: impl Fn(usize) -> f32 + Sync,
) -> Scene {
    let maps = Maps {
        normals: Plane::from_fn(size, |x, y| {
            let n = nbar(vec2(x as f32 + 0.5, y as f32 + 0.5));
            vec3(n.x, -n.y, (1.0 - n.length_squared()).sqrt())
        }),
        depth: Plane::from_fn(size, |x, _| depth(x)),
        coverage: Plane::full(size, 255),
    };
    Scene { size, surface: Some(Arc::new(Surface::new(maps).unwrap())) }
}

#[test]
fn antialiasing_removes_three_quarters_of_the_error_against_64_samples_a_pixel() {
    let size = Size::new(96, 96);
    let nbar = |q: Vec2| vec2((q.x / 13.0).sin() * (q.y / 17.0).cos(), (q.y / 11.0).sin()) * 0.35;
    let scene = scene(size, nbar, |_| 0.5);
    // A checkerboard of 3 × 3 texels, two texels a pixel.
    let check = |i: usize| {
        if (i % 192 / 3 + i / 192 / 3).is_multiple_of(2) { [255; 4] } else { [0, 0, 0, 255] }
    };
    let picture = Picture::srgb8(Size::new(192, 192), (0..192 * 192).map(check).collect()).unwrap();
    let (alpha, beta, center) = (0.5, 1.0, vec2(48.5, 48.5));
    let mut image = place(picture, size);
    image.outside = Outside::Mirror;
    image.bend.operator = Operator::Normal { alpha, beta, detail: 0.0 };
    image.bend.anchors = vec![Anchor::pin(center)];

    let map = image.placement.texels_from_canvas(size, Size::new(192, 192));
    let sample = |q: Vec2| {
        let offset = 96.0 * second_order::offset(nbar(q) - nbar(center), alpha, beta);
        sampler::bilinear(&image.source.texture(), map.transform_point2(q + offset), image.outside)
            [0]
            * 255.0
    };
    let supersampled = |x: usize, y: usize| {
        let at = |k: usize| (k as f32 + 0.5) / 8.0;
        let sum: f32 =
            (0..64).map(|k| sample(vec2(x as f32 + at(k % 8), y as f32 + at(k / 8)))).sum();
        sum / 64.0
    };
    let pixels: Vec<(usize, usize)> = (2..94).flat_map(|y| (2..94).map(move |x| (x, y))).collect();
    let reference: Vec<f32> = pixels.iter().map(|&(x, y)| supersampled(x, y)).collect();
    let error = |filter| {
        let bytes = render(&PlacedImage { filter, ..image.clone() }, &scene);
        let squares = pixels
            .iter()
            .zip(&reference)
            .map(|(&(x, y), r)| (f32::from(bytes[(y * 96 + x) * 4]) - r).powi(2));
        (squares.sum::<f32>() / pixels.len() as f32).sqrt()
    };
    let (filtered, unfiltered) = (error(ImageFilter::Antialias), error(ImageFilter::Bilinear));
    assert!(filtered < 0.25 * unfiltered, "{filtered} of {unfiltered}");
}

#[test]
fn nothing_bleeds_across_a_silhouette() {
    // Two plates, the right one far behind and turned: on each plate D is a translation, so no
    // pixel needs filtering.
    let size = Size::new(64, 64);
    let plates = scene(
        size,
        |q| if q.x < 32.0 { Vec2::ZERO } else { vec2(0.5, 0.0) },
        |x| if x < 32 { 0.0 } else { 1.0 - 0.577 * (64 - x) as f32 / 64.0 * 0.1 },
    );
    let mut image = place(noise(size), size);
    image.outside = Outside::Mirror;
    image.bend.operator = Operator::Normal { alpha: 0.5, beta: 0.0, detail: 0.0 };
    image.bend.anchors = vec![Anchor::pin(vec2(10.5, 30.5))];
    let bilinear = render(&image, &plates);
    image.filter = ImageFilter::Antialias;
    let antialias = render(&image, &plates);
    assert!(
        bilinear[(30 * 64 + 40) * 4..][..3]
            != render(&place(noise(size), size), &plates)[(30 * 64 + 40) * 4..][..3]
    );
    assert!(antialias == bilinear, "a pixel at the jump was blurred over both plates");
}
