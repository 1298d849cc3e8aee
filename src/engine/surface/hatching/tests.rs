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
        let lines = cylinder.hatch_lines(&settings, &GuideLines::none());
        assert!(lines.lines.len() > 20, "{}", lines.lines.len());
        let cosines = lines
            .lines
            .iter()
            .flat_map(|line| directions_of(line).map(|d| d.dot(along).abs()).collect::<Vec<_>>());
        let least = cosines.fold(1.0, f32::min);
        assert!(least > 10f32.to_radians().cos(), "{}", least.acos().to_degrees());
    }
}

/// A torus seen along its axis: its tube bends around circles that point away from the middle.
fn torus() -> Surface {
    surface(Size::new(240, 240), |x, y| {
        let from = vec2(x - 120.0, 120.0 - y);
        let across = (from.length() - 70.0) / 32.0;
        let rest = 1.0 - across * across;
        (rest > 0.02).then(|| (from.normalize() * across).extend(rest.sqrt()))
    })
}

#[test]
fn lines_go_around_the_tube_of_a_torus_or_along_it() {
    let torus = torus();
    for (way, is_across) in [(HatchWay::Around, false), (HatchWay::Along, true)] {
        let settings = HatchSettings { way, style: HatchStyle::Hatch, ..HatchSettings::DEFAULT };
        let lines = torus.hatch_lines(&settings, &GuideLines::none());
        let mut off: Vec<f32> = Vec::new();
        for nine in lines.lines.iter().flat_map(|line| line.points.windows(9)) {
            let from = nine[4].at - vec2(120.0, 120.0);
            // Near the outer rim it is seen too much aslant; near the inner one it bends nearly as much
            // the other way.
            if (60.0..96.0).contains(&from.length()) {
                let out = from.normalize();
                let expected = if is_across { out.perp() } else { out };
                let way = (nine[8].at - nine[0].at).normalize();
                off.push(way.dot(expected).abs().min(1.0).acos().to_degrees());
            }
        }
        off.sort_by(f32::total_cmp);
        let [p95, p99] = [95, 99].map(|share| off[off.len() * share / 100]);
        let is_near = off.len() > 3000 && p95 < 8.0 && p99 < 15.0;
        assert!(is_near, "{way:?}: {p95}° and {p99}° of {}", off.len());
    }
}

/// A rod along x, its radius 60 px, that ends in half a ball with faint dents.
fn rod() -> Surface {
    surface(Size::new(320, 140), |x, y| {
        let (across, beyond) = ((70.0 - y) / 60.0, ((70.0 - x) / 60.0).max(0.0));
        let rest = 1.0 - across * across - beyond * beyond;
        let dents = if beyond > 0.0 { 0.03 } else { 0.0 };
        let dent =
            dents * vec2((x / 9.0).sin() * (y / 11.0).cos(), (x / 8.0).cos() * (y / 10.0).sin());
        (rest > 0.02).then(|| (vec2(-beyond, across) + dent).extend(rest.sqrt()).normalize())
    })
}

#[test]
fn lines_do_not_waver_where_a_form_bends_alike_in_all_directions() {
    let settings = HatchSettings { style: HatchStyle::Hatch, ..HatchSettings::DEFAULT };
    let lines = rod().hatch_lines(&settings, &GuideLines::none());
    let nines = lines.lines.iter().flat_map(|line| line.points.windows(9));
    // As around the rod, up to where the ball turns away.
    let on_ball = nines.filter(|nine| (35.0..70.0).contains(&nine[4].at.x));
    let upright: Vec<f32> =
        on_ball.map(|nine| (nine[8].at - nine[0].at).normalize().y.abs()).collect();
    let mean = upright.iter().sum::<f32>() / upright.len() as f32;
    assert!(upright.len() > 300 && mean > 0.8, "{mean} of {}", upright.len());
}

#[test]
fn lines_like_wires_are_straight_on_the_unwrapped_form() {
    let cylinder = cylinder();
    for (angle, along) in [(0.0, Vec2::X), (90.0, Vec2::Y)] {
        let (way, style) = (HatchWay::Wires, HatchStyle::Hatch);
        let settings = HatchSettings { way, style, angle, ..HatchSettings::DEFAULT };
        let lines = cylinder.hatch_lines(&settings, &GuideLines::none());
        assert!(lines.lines.len() > 20, "{}", lines.lines.len());
        let cosines = lines.lines.iter().flat_map(directions_of).map(|d| d.dot(along).abs());
        let least = cosines.fold(1.0, f32::min);
        assert!(least > 3f32.to_radians().cos(), "{angle}: {}°", least.acos().to_degrees());
    }
}

/// How far lines turn from a direction near a place, degrees: the most, and that of how many.
fn angle_from(lines: &HatchLines, near: Vec2, along: Vec2) -> (f32, usize) {
    let found = lines.lines.iter().flat_map(|line| line.points.windows(9)).filter_map(|nine| {
        let is_near = nine[4].at.distance(near) < 12.0;
        let way = (nine[8].at - nine[0].at).normalize();
        is_near.then(|| way.dot(along).abs().min(1.0).acos().to_degrees())
    });
    found.fold((0.0, 0), |(most, count), turn| (most.max(turn), count + 1))
}

#[test]
fn lines_follow_drawn_strokes_and_turn_evenly_between_them() {
    let flat = surface(Size::new(240, 200), |_, _| Some(Vec3::Z));
    let settings =
        HatchSettings { way: HatchWay::Guides, style: HatchStyle::Hatch, ..HatchSettings::DEFAULT };
    let slanted = vec2(1.0, 1.0).normalize();
    let strokes = [[vec2(30.0, 20.0), vec2(30.0, 180.0)], [vec2(190.0, 80.0), vec2(230.0, 120.0)]];
    let guides = GuideLines::of(strokes.into_iter().map(Vec::from));
    let lines = flat.hatch_lines(&settings, &guides);
    for (near, along) in [(vec2(30.0, 100.0), Vec2::Y), (vec2(210.0, 100.0), slanted)] {
        let (most, count) = angle_from(&lines, near, along);
        assert!(count > 10 && most < 10.0, "{most}° of {count} near {near}");
    }
    // Between them the doubled angle is halfway: 22.5° from either.
    let halfway = vec2(22.5f32.to_radians().sin(), 22.5f32.to_radians().cos());
    let (most, count) = angle_from(&lines, vec2(118.0, 100.0), halfway);
    assert!(count > 10 && most < 16.0, "{most}° of {count}");
    let turned = HatchSettings { angle: 90.0, ..settings };
    let (most, _) = angle_from(&flat.hatch_lines(&turned, &guides), vec2(30.0, 100.0), Vec2::X);
    assert!(most < 10.0, "{most}°");
}

#[test]
fn pieces_without_a_stroke_follow_the_form() {
    let cylinder = cylinder();
    let [guided, around] = [HatchWay::Guides, HatchWay::Around].map(|way| {
        let settings = HatchSettings { way, ..HatchSettings::DEFAULT };
        let beside = GuideLines::of([vec![vec2(0.0, 1.0), vec2(90.0, 1.0)]].into_iter());
        cylinder.hatch_lines(&settings, &beside)
    });
    assert_eq!(guided, around);
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
    let lines = &cylinder.hatch_lines(&settings, &GuideLines::none()).lines;
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
fn stipples_are_even_on_the_surface_in_every_level() {
    let cylinder = cylinder();
    let settings =
        HatchSettings { style: HatchStyle::Stipple, spacing: 16.0, ..HatchSettings::DEFAULT };
    let points = &cylinder.hatch_lines(&settings, &GuideLines::none()).lines;
    for (i, level) in settings.levels().iter().enumerate() {
        let shown: Vec<Vec2> = points
            .iter()
            .filter(|line| usize::from(line.level) <= i)
            .map(|line| line.points[0].at)
            .collect();
        let nearest = |at: &Vec2| {
            let (x, y) = (at.x as usize, at.y as usize);
            let root = stretch(cylinder.nbar(x, y), cylinder.normal(x, y).z, 1.0);
            let others = shown.iter().filter(|other| *other != at);
            let far = others.map(|other| (root * (*other - *at)).length());
            far.min_by(f32::total_cmp).unwrap() / (level.apart * settings.spacing)
        };
        let mut far: Vec<f32> = shown.iter().map(nearest).collect();
        far.sort_by(f32::total_cmp);
        let at = |share: f32| far[(share * (far.len() - 1) as f32) as usize];
        let (low, middle, high) = (at(0.1), at(0.5), at(0.9));
        assert!(low > 0.93 && high < 1.35, "{i}: p10 {low}, median {middle}, p90 {high}");
    }
}

#[test]
fn stipples_grow_level_by_level_and_cover_the_tone() {
    let settings = HatchSettings { style: HatchStyle::Stipple, ..HatchSettings::DEFAULT };
    let last = settings.levels().len() - 1;
    for level in 0..=last {
        let areas: Vec<f32> =
            (0..=100).map(|i| settings.stipple_area(i as f32 / 100.0, level)).collect();
        assert_eq!(areas[0], 0.0);
        assert!(areas.windows(2).all(|pair| pair[1] >= pair[0] && pair[1] - pair[0] < 0.9));
    }
    assert!(settings.stipple_area(0.02, 0) > 0.1 && settings.stipple_area(0.02, 1) == 0.0);
    // All points together cover what is asked while they do not meet.
    let share = |i: usize| (settings.levels()[last].apart / settings.levels()[i].apart).powi(2);
    for dark in [0.1, 0.2, 0.4] {
        let own = |i: usize| share(i) - if i == 0 { 0.0 } else { share(i - 1) };
        let sum: f32 = (0..=last).map(|i| own(i) * settings.stipple_area(dark, i)).sum();
        assert!((sum - dark).abs() < 1e-4, "{dark}: {sum}");
    }
}

#[test]
fn levels_together_cover_what_tone_asks() {
    for style in [HatchStyle::Crosshatch, HatchStyle::Hatch, HatchStyle::Engraving] {
        // So far apart that soft edges do not overlap.
        let settings = HatchSettings { style, spacing: 1e9, ..HatchSettings::DEFAULT };
        let close = HatchSettings { spacing: 9.0, ..settings };
        for dark in [0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0] {
            let mut covered = [0.0; 2];
            let levels = settings.levels().iter().zip(settings.coverages(dark));
            levels.for_each(|(level, share)| covered[usize::from(level.family)] += share);
            let free = (1.0 - covered[0]) * (1.0 - covered[1]);
            assert!((1.0 - free - dark).abs() < 1e-5, "{style:?} {dark}: {}", 1.0 - free);
            // Where they do, lines are wider, within their room.
            let mut wider = settings.coverages(dark).zip(close.coverages(dark));
            assert!(wider.all(|(far, near)| near + 1e-6 >= far && near <= 1.0));
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
    let lines = flat.hatch_lines(&settings, &GuideLines::none());
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
        pool.install(|| HatchLines::of(&cylinder(), &settings, &GuideLines::none()))
    };
    assert_eq!(with(1), with(4));
}
