use super::*;
use crate::math::{PlaneMap, Size, hash, vec2};

/// A map of the plane, as layers have it.
struct Through(PlaneMap, Size);

impl PixelMap for Through {
    fn source_of(&self, q: Vec2) -> Option<(Vec2, Mat2)> {
        self.0.from_canvas(q)
    }

    fn pixel_move(&self) -> Option<PixelMove> {
        self.0.pixel_move_on(self.1)
    }

    fn source_rect(&self, canvas: Rect) -> Rect {
        self.0.source_rect(canvas)
    }
}

const SIDE: i32 = 256;
const CANVAS: Size = Size::new(SIDE as u32, SIDE as u32);

fn tiles() -> Vec<TileAt> {
    TileAt::covering(CANVAS.rect()).collect()
}

/// An opaque gray picture.
fn picture(value: impl Fn(f32, f32) -> f32) -> TileGrid {
    let gray = |i: i32| quantize(value((i % SIDE) as f32 + 0.5, (i / SIDE) as f32 + 0.5));
    let rgba: Vec<u8> = (0..SIDE * SIDE).flat_map(|i| [gray(i), gray(i), gray(i), 255]).collect();
    TileGrid::from_straight_rgba(&rgba, SIDE as usize, SIDE as usize, 0, 0)
}

fn noise() -> TileGrid {
    let byte = |i: u32| (hash::unit(9, i, 0) * 256.0) as u8;
    let rgba: Vec<u8> = (0..(SIDE * SIDE * 4) as u32).map(byte).collect();
    TileGrid::from_straight_rgba(&rgba, SIDE as usize, SIDE as usize, 0, 0)
}

fn warp(grid: &TileGrid, map: PlaneMap, filter: Resampling) -> TileGrid {
    warp_tiles(grid, &Through(map, CANVAS), filter, &tiles())
}

fn affine(c: [f64; 6]) -> PlaneMap {
    PlaneMap::affine(c).unwrap()
}

/// 1 at the middle, ever finer rings toward the corners: at half size those beyond 64 px cannot be
/// shown.
fn rings(x: f32, y: f32) -> f32 {
    let (dx, dy) = (x - 128.0, y - 128.0);
    0.5 + 0.5 * ((dx * dx + dy * dy) * std::f32::consts::PI / 256.0).cos()
}

#[test]
fn mirrors_quarter_turns_and_shifts_there_and_back_give_the_same_bytes() {
    let picture = noise();
    let middle = vec2(128.0, 128.0);
    let mirror = affine([-1.0, 0.0, 0.0, 1.0, 256.0, 0.0]);
    let shift = |dx: f32| PlaneMap::translation(vec2(dx, 0.0));
    for steps in [vec![mirror, mirror], vec![PlaneMap::rotation(90.0, middle); 4]] {
        let back =
            steps.iter().fold(picture.clone(), |grid, step| warp(&grid, *step, Resampling::Smooth));
        assert!(
            tiles()
                .iter()
                .all(|&at| back.tile(at).unwrap().bytes() == picture.tile(at).unwrap().bytes())
        );
    }
    let moved = warp(&picture, shift(7.0), Resampling::Smooth);
    assert_eq!(moved.pixel(17, 5), picture.pixel(10, 5));
    assert_eq!(moved.pixel(3, 5), [0; 4]);
}

#[test]
fn a_flat_color_stays_one_however_it_is_turned_or_reduced() {
    let grid = picture(|_, _| 0.6);
    for map in
        [PlaneMap::rotation(17.0, vec2(128.0, 128.0)), affine([0.31, 0.1, -0.2, 0.4, 90.0, 80.0])]
    {
        for (filter, _) in Resampling::ALL {
            let out = warp(&grid, map, filter);
            assert_eq!(out.pixel(128, 128), [153, 153, 153, 255], "{filter:?}");
        }
    }
}

#[test]
fn a_zone_plate_at_half_size_is_what_supersampling_gives() {
    let half = affine([0.5, 0.0, 0.0, 0.5, 0.0, 0.0]);
    let shown = warp(&picture(rings), half, Resampling::Smooth);
    let (mut own, mut unfiltered) = (0.0f64, 0.0f64);
    for y in 0..SIDE / 2 {
        for x in 0..SIDE / 2 {
            let at = |k: i32| (k as f32 + 0.5) / 4.0;
            let truth: f32 = (0..64)
                .map(|k| rings(2.0 * x as f32 + at(k % 8), 2.0 * y as f32 + at(k / 8)))
                .sum();
            let truth = truth / 64.0;
            // What one sample without a filter gives.
            let point = rings(2.0 * x as f32 + 0.5, 2.0 * y as f32 + 0.5);
            own += f64::from(f32::from(shown.pixel(x, y)[0]) / 255.0 - truth).powi(2);
            unfiltered += f64::from(point - truth).powi(2);
        }
    }
    let ratio = (own / unfiltered).sqrt();
    assert!(ratio < 0.17, "{ratio} of unfiltered");
}

#[test]
fn a_sharp_turn_there_and_back_loses_little() {
    let soft = |x: f32, y: f32| 0.5 + 0.3 * (x * 0.15).sin() * (y * 0.11).cos();
    let grid = picture(soft);
    let turn = |degrees: f64| PlaneMap::rotation(degrees, vec2(128.0, 128.0));
    let there = warp(&grid, turn(30.0), Resampling::Sharp);
    let back = warp(&there, turn(-30.0), Resampling::Sharp);
    let off = |x: i32, y: i32| i32::from(back.pixel(x, y)[0]) - i32::from(grid.pixel(x, y)[0]);
    let worst =
        (64..192).flat_map(|y| (64..192).map(move |x| (x, y))).map(|(x, y)| off(x, y).abs()).max();
    assert!(worst.unwrap() <= 2, "{worst:?}");
}

#[test]
fn a_horizon_and_a_speck_of_a_picture_are_shown_without_stalling() {
    use glam::dvec2;
    let grid = noise();
    let near = [dvec2(0.0, 0.0), dvec2(256.0, 0.0), dvec2(128.5, 200.0), dvec2(127.5, 200.0)];
    let map = PlaneMap::quad(CANVAS, near).unwrap();
    assert!(warp(&grid, map, Resampling::Smooth).pixel(128, 20)[3] > 0);
    let speck = affine([1e-4, 0.0, 0.0, 1e-4, 40.0, 40.0]);
    assert!(warp(&grid, speck, Resampling::Smooth).pixel(200, 200)[3] == 0);
}

#[test]
fn a_mask_moves_with_its_border_going_on() {
    let mask = Plane::from_fn(CANVAS, |x, _| if x < 100 { 255u8 } else { 0 });
    let map = Through(PlaneMap::translation(vec2(20.5, 0.0)), CANVAS);
    let moved = warp_plane(&mask, &map, Resampling::Smooth);
    assert_eq!((moved.at(0, 9), moved.at(110, 9), moved.at(130, 9)), (255, 255, 0));
    assert!((100..155).contains(&moved.at(120, 9)), "half of both, not {}", moved.at(120, 9));
}

#[test]
fn rows_of_pixels_are_to_the_bit_what_each_is_alone() {
    use glam::dvec2;
    let turn = |degrees: f64, scale: f64| {
        let about = vec2(128.0, 128.0);
        let scaled = affine([scale, 0.0, 0.0, 1.1 * scale, 20.0, 9.0]);
        Through(PlaneMap::rotation(degrees, about).then(&scaled), CANVAS)
    };
    let corners = [dvec2(9.0, 3.0), dvec2(240.0, 40.0), dvec2(190.0, 250.0), dvec2(30.0, 180.0)];
    let mut maps: Vec<Box<dyn PixelMap>> =
        vec![Box::new(Through(PlaneMap::quad(CANVAS, corners).unwrap(), CANVAS))];
    for (degrees, scale) in
        [(0.0, 1.0), (17.0, 1.0), (3.0, 0.93), (45.0, 0.4), (80.0, 0.11), (10.0, 2.5)]
    {
        maps.push(Box::new(turn(degrees, scale)));
    }
    // One that squeezes in one place, stretches in another, and has nothing in between.
    let rect = TileAt::new(1, 1).rect();
    let mut points = TilePoints::new(TILE * TILE);
    for k in 0..points.len() {
        let q = vec2((k % TILE) as f32, (k / TILE) as f32) + 64.5;
        let by = vec2(9.0 * (q.x * 0.13).sin(), 5.0 * (q.y * 0.31).cos());
        let jacobian = Mat2::from_cols(
            vec2(1.0 + 1.17 * (q.x * 0.13).cos(), 0.1),
            vec2(0.0, 1.0 - (q.y * 0.31).sin()),
        );
        points.set(k, if k % 97 == 0 { (Vec2::splat(-1e6), jacobian) } else { (q + by, jacobian) });
    }
    points.x[70] = f32::NAN;
    maps.push(Box::new(TileMap::new(rect, points)));
    let grid = noise();
    let mut seen = 0;
    for (map, filter) in
        maps.iter().flat_map(|map| Resampling::ALL.map(|(filter, _)| (map.as_ref(), filter)))
    {
        for continues in [false, true] {
            let source = GridSource { grid: &grid, bounds: Rect::new(0, 0, 200, 256), continues };
            let wanted = source.rect_to_read(map.source_rect(rect));
            let window =
                window::SourceWindow { rect: wanted, pixels: source.read(wanted), continues };
            let (mut points, mut scratch) = (PointRow::default(), rows::WarpScratch::default());
            for y in rect.y0..rect.y1 {
                // Also rows that do not fill a tile.
                let mut row = [[9.0; 4]; 61];
                map.source_row(rect.x0, y, row.len(), &mut points);
                window.row(&points, filter, &mut scratch, &mut row);
                for (x, found) in (rect.x0..).zip(row) {
                    let point = map.source_of(vec2(x as f32 + 0.5, y as f32 + 0.5));
                    let alone =
                        point.map_or([0.0; 4], |(p, jacobian)| window.sample(p, jacobian, filter));
                    assert!(found == alone, "{filter:?} {x} {y}: {found:?} {alone:?}");
                    seen += usize::from(alone[3] > 0.0);
                }
            }
        }
    }
    assert!(seen > 50_000, "{seen}");
}
