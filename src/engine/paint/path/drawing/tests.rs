//! Pictures of paths.

use super::*;
use crate::paint::path::{Figure, FigureKind, PathNode};

const RED: Color = Color { r: 200, g: 30, b: 20, a: 255 };

fn rectangle(from: Vec2, to: Vec2) -> Figure {
    Figure { from, to, ..Figure::DEFAULT }
}

fn alpha_at(path: &LivePath, x: i32, y: i32) -> u8 {
    let (bounds, picture) = (path.bounds(), path.picture());
    if x < bounds.x0 || x >= bounds.x1 || y < bounds.y0 || y >= bounds.y1 {
        return 0;
    }
    let crate::raster::picture::Texels::Srgb8(texels) = &picture.texels else { panic!("bytes") };
    texels[((y - bounds.y0) as u32 * picture.size.width + (x - bounds.x0) as u32) as usize][3]
}

#[test]
fn a_filled_rectangle_covers_its_pixels_and_half_of_those_it_cuts() {
    let path = LivePath::new(rectangle(vec2(10.0, 20.0), vec2(40.5, 60.0))).with_fill(RED);
    assert_eq!(path.bounds(), Rect { x0: 9, y0: 19, x1: 42, y1: 61 });
    assert_eq!([alpha_at(&path, 10, 20), alpha_at(&path, 39, 59)], [255, 255]);
    assert_eq!([alpha_at(&path, 9, 20), alpha_at(&path, 20, 60)], [0, 0]);
    assert_eq!([alpha_at(&path, 40, 30), alpha_at(&path, 40, 59)], [128; 2]);
}

#[test]
fn an_outline_lies_half_inside_and_ends_as_its_caps_say() {
    let line = Figure { kind: FigureKind::Line, ..rectangle(vec2(20.0, 20.0), vec2(60.0, 20.0)) };
    let plain = LivePath { outline: 10.0, ..LivePath::new(line) };
    assert_eq!([alpha_at(&plain, 40, 15), alpha_at(&plain, 40, 24)], [255, 255]);
    assert_eq!(plain.bounds(), Rect { x0: 19, y0: 14, x1: 61, y1: 26 });
    let square = LivePath { cap: PathCap::Square, ..plain.clone() };
    assert_eq!(square.bounds(), Rect { x0: 14, y0: 14, x1: 66, y1: 26 });
    let dashed = LivePath { dashes: vec![10.0], ..plain };
    assert_eq!([alpha_at(&dashed, 25, 20), alpha_at(&dashed, 35, 20)], [255, 0]);
}

#[test]
fn what_lies_inside_twice_is_a_hole_by_the_rule() {
    let square =
        |a: f32, b: f32| Subpath::polygon([vec2(a, a), vec2(b, a), vec2(b, b), vec2(a, b)]);
    let both = LivePath::new(vec![square(0.0, 60.0), square(20.0, 40.0)]).with_fill(RED);
    assert_eq!(alpha_at(&both, 30, 30), 255);
    let holed = LivePath { rule: PathRule::EvenOdd, ..both };
    assert_eq!([alpha_at(&holed, 30, 30), alpha_at(&holed, 10, 30)], [0, 255]);
}

#[test]
fn an_uneven_outline_is_as_wide_as_its_nodes_say() {
    let mut nodes = vec![PathNode::corner(vec2(20.0, 50.0)), PathNode::corner(vec2(120.0, 50.0))];
    nodes[1].width = 3.0;
    let line = vec![Subpath { nodes, closed: false }];
    let path = LivePath { outline: 10.0, ..LivePath::new(line) };
    let height = |x: i32| (20..80).filter(|y| alpha_at(&path, x, *y) > 127).count();
    // 10 px at the beginning, 30 at the end, and the mean of both between.
    assert!(height(21).abs_diff(10) <= 1, "{}", height(21));
    assert!(height(70).abs_diff(20) <= 1, "{}", height(70));
    assert!(height(119).abs_diff(30) <= 1, "{}", height(119));
}

#[test]
fn a_large_path_is_drawn_smaller_by_a_whole_number_and_larger_where_it_is_seen() {
    let path = LivePath::new(rectangle(Vec2::ZERO, vec2(10_000.0, 30.0))).with_fill(RED);
    let (bounds, size) = (path.bounds(), path.picture_size());
    assert_eq!((bounds.width() % 3, bounds.height() % 3), (0, 0));
    assert_eq!(size, Size::new(bounds.width() as u32 / 3, bounds.height() as u32 / 3));
    let picture = path.picture();
    assert_eq!(picture.own_size(), vec2(bounds.width() as f32, bounds.height() as f32));
    let larger = picture.enlarged(2).unwrap();
    assert_eq!(larger.size, Size::new(size.width * 2, size.height * 2));
}

#[test]
fn what_covers_nothing_is_a_picture_of_nothing() {
    let empty = LivePath::new(Vec::new());
    let point = LivePath::new(vec![Subpath::polygon([vec2(50.0, 50.0)])]).with_fill(RED);
    let flat = LivePath::new(rectangle(vec2(5.0, 5.0), vec2(90.0, 5.0))).with_fill(RED);
    for path in [empty, point, flat] {
        let picture = path.picture();
        let crate::raster::picture::Texels::Srgb8(texels) = &picture.texels else {
            panic!("bytes")
        };
        assert!(texels.iter().all(|texel| texel[3] == 0), "{path:?}");
        assert_eq!(path.fits(), Ok(()));
    }
}

#[test]
fn a_path_beyond_the_limits_is_refused_before_it_is_drawn() {
    let far = LivePath::new(rectangle(vec2(-1e6, 0.0), vec2(1e6, 10.0))).with_fill(RED);
    assert!(far.fits().unwrap_err().contains("px long"), "{:?}", far.fits());
    let wide = LivePath { outline: f32::NAN, ..LivePath::new(Vec::new()) };
    assert!(wide.fits().is_err());
}

/// The share of a pixel that a test of points finds inside, over 32 × 32 points.
fn share_by_points(x: i32, y: i32, is_inside: impl Fn(Vec2) -> bool) -> f32 {
    let at = |i: i32| vec2((i % 32) as f32 + 0.5, (i / 32) as f32 + 0.5) / 32.0;
    let points = (0..1024).map(|i| vec2(x as f32, y as f32) + at(i));
    points.filter(|p| is_inside(*p)).count() as f32 / 1024.0
}

#[test]
fn edges_cover_the_exact_share_of_their_pixels() {
    let (middle, radius) = (vec2(30.3, 29.8), 20.4);
    let (from, to) = (middle - radius, middle + radius);
    let disc = Figure { kind: FigureKind::Ellipse, ..rectangle(from, to) };
    let filled = LivePath::new(disc).with_fill(RED);
    let ring = LivePath { outline: 3.3, outline_color: RED, ..LivePath::new(disc) };
    let (mut most, mut of_ring) = (0.0f32, 0.0f32);
    for (x, y) in (0..60).flat_map(|y| (0..60).map(move |x| (x, y))) {
        let apart = |path: &LivePath, is_inside: &dyn Fn(f32) -> bool| {
            let share = share_by_points(x, y, |p| is_inside(p.distance(middle)));
            (f32::from(alpha_at(path, x, y)) - 255.0 * share).abs()
        };
        most = most.max(apart(&filled, &|d| d < radius));
        of_ring = of_ring.max(apart(&ring, &|d| (d - radius).abs() < 1.65));
    }
    // A circle of cubic curves is up to a four thousandth of its radius too large.
    assert!(most < 4.5 && of_ring < 5.5, "{most} {of_ring}");
}

#[test]
fn an_outline_lies_over_the_fill_as_colors_do() {
    let outline_color = Color { r: 0, g: 0, b: 250, a: 128 };
    let square = LivePath::new(rectangle(vec2(10.0, 10.0), vec2(40.0, 40.0))).with_fill(RED);
    let path = LivePath { outline: 8.0, outline_color, ..square };
    let (bounds, picture) = (path.bounds(), path.picture());
    let crate::raster::picture::Texels::Srgb8(texels) = &picture.texels else { panic!("bytes") };
    let at = |x: i32, y: i32| {
        texels[((y - bounds.y0) as u32 * picture.size.width + (x - bounds.x0) as u32) as usize]
    };
    assert_eq!(
        [at(7, 20), at(12, 20), at(20, 20)],
        [[0, 0, 250, 128], [100, 15, 135, 255], [200, 30, 20, 255]]
    );
}
