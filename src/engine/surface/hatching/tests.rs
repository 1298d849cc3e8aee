//! Hatching of forms that are known exactly. Floor 2.

use super::*;
use crate::math::{Mat2, Size, vec2, vec3};
use crate::raster::Plane;
use crate::surface::Maps;
use crate::surface::unwrap::metric::stretch;
use directions::principal;

/// A surface of unit normals (y up) where there is one, lying flat.
fn surface(size: Size, normal: impl Fn(f32, f32) -> Option<Vec3> + Sync) -> Surface {
    let at = |x: usize, y: usize| normal(x as f32 + 0.5, y as f32 + 0.5);
    let normals = Plane::from_fn(size, |x, y| at(x, y).unwrap_or(Vec3::ZERO));
    let depth = Plane::from_fn(size, |x, y| at(x, y).map_or(f32::NAN, |n| 0.5 - 0.2 * n.z));
    let coverage = Plane::from_fn(size, |x, y| if at(x, y).is_some() { 255 } else { 0 });
    Surface::new(Maps { normals, depth, coverage }).unwrap()
}

/// A cylinder that lies along x, its radius 90 px.
fn cylinder() -> Surface {
    surface(Size::new(240, 200), |_, y| {
        let up = (100.0 - y) / 90.0;
        (up.abs() < 0.97).then(|| vec3(0.0, up, (1.0 - up * up).sqrt()))
    })
}

fn directions_of(line: &HatchLine) -> impl Iterator<Item = Vec2> {
    line.points.windows(9).map(|nine| (nine[8].at - nine[0].at).normalize())
}

#[test]
fn a_cylinder_bends_around_its_axis() {
    // Of radius r along x: ∂n̄_y/∂y = 1/r.
    let bent = principal([Vec2::ZERO, vec2(0.0, 1.0 / 50.0)], Mat2::IDENTITY);
    assert!((bent.angle.cos().abs()) < 1e-4, "{bent:?}");
    assert!((bent.directed - 0.01).abs() < 1e-5, "{bent:?}");
}

#[test]
fn lines_go_around_a_cylinder_or_along_it() {
    let cylinder = cylinder();
    for (way, along) in [(HatchWay::Around, Vec2::Y), (HatchWay::Along, Vec2::X)] {
        let settings = HatchSettings { way, style: HatchStyle::Hatch, ..HatchSettings::DEFAULT };
        let lines = cylinder.hatch_lines(&settings);
        assert!(lines.lines.len() > 20, "{}", lines.lines.len());
        let cosines = lines
            .lines
            .iter()
            .flat_map(|line| directions_of(line).map(|d| d.dot(along).abs()).collect::<Vec<_>>());
        let least = cosines.fold(1.0, f32::min);
        assert!(least > 10f32.to_radians().cos(), "{}", least.acos().to_degrees());
    }
}

#[test]
fn neighbors_are_as_far_apart_on_the_surface_as_was_asked() {
    let cylinder = cylinder();
    let settings = HatchSettings {
        way: HatchWay::Along,
        style: HatchStyle::Engraving,
        spacing: 16.0,
        ..HatchSettings::DEFAULT
    };
    let lines = &cylinder.hatch_lines(&settings).lines;
    let mut gaps: Vec<f32> = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        for point in line.points.iter().step_by(10) {
            // To the nearest line below, on the surface.
            let (x, y) = (point.at.x as usize, point.at.y as usize);
            let root = stretch(cylinder.nbar(x, y), cylinder.normal(x, y).z, 1.0);
            let others = lines.iter().enumerate().filter(|(j, _)| *j != i);
            let below = others.flat_map(|(_, line)| line.points.iter()).filter_map(|other| {
                let off = other.at - point.at;
                (off.y > 0.0 && off.x.abs() < 1.0).then(|| (root * off).length())
            });
            gaps.extend(below.min_by(f32::total_cmp));
        }
    }
    gaps.sort_by(f32::total_cmp);
    let at = |share: f32| gaps[(share * (gaps.len() - 1) as f32) as usize] / 8.0;
    let (low, middle, high) = (at(0.1), at(0.5), at(0.9));
    assert!(low > 0.75 && high < 1.25, "p10 {low}, median {middle}, p90 {high}");
}

#[test]
fn levels_together_cover_what_tone_asks() {
    for style in [HatchStyle::Crosshatch, HatchStyle::Hatch, HatchStyle::Engraving] {
        let settings = HatchSettings { style, ..HatchSettings::DEFAULT };
        for dark in [0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0] {
            let free = settings.coverages(dark).fold(1.0, |free, share| free * (1.0 - share));
            assert!((1.0 - free - dark).abs() < 1e-5, "{style:?} {dark}: {}", 1.0 - free);
        }
    }
}

#[test]
fn the_room_of_even_lines_is_the_distance_between_them() {
    let flat = surface(Size::new(240, 200), |_, _| Some(Vec3::Z));
    let settings = HatchSettings {
        way: HatchWay::Paper,
        style: HatchStyle::Engraving,
        spacing: 16.0,
        ..HatchSettings::DEFAULT
    };
    let lines = flat.hatch_lines(&settings);
    let points = lines.lines.iter().flat_map(|line| &line.points);
    let mut rooms: Vec<f32> = points.map(|point| point.room_px).collect();
    rooms.sort_by(f32::total_cmp);
    let middle = rooms[rooms.len() / 2];
    assert!((7.0..9.0).contains(&middle), "{middle}");
    let level = lines.lines.iter().flat_map(directions_of).map(|d| d.y.abs()).fold(0.0, f32::max);
    assert!(level < 0.02, "{level}");
}

#[test]
fn lines_are_the_same_with_any_number_of_threads() {
    let settings = HatchSettings::DEFAULT;
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| HatchLines::of(&cylinder(), &settings))
    };
    assert_eq!(with(1), with(4));
}
