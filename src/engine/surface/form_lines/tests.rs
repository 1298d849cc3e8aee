//! Lines of forms that are known exactly. Floor 2.

use super::*;
use crate::math::{Size, vec2, vec3};
use crate::raster::Plane;
use crate::surface::Maps;

/// A surface from a height above the picture, px, where there is one; its derivatives are taken
/// finely.
pub(super) fn surface(size: Size, height: impl Fn(f32, f32) -> Option<f32> + Sync) -> Surface {
    const H: f32 = 0.01;
    let (w, h) = (size.width as f32, size.height as f32);
    let range = w.max(h);
    let at = |x: usize, y: usize| (x as f32 + 0.5, y as f32 + 0.5);
    let normals = Plane::from_fn(size, |x, y| {
        let (x, y) = at(x, y);
        let slope = |dx: f32, dy: f32| {
            let (a, b) = (height(x - dx * H, y - dy * H), height(x + dx * H, y + dy * H));
            Some((b? - a?) / (2.0 * H))
        };
        match (height(x, y), slope(1.0, 0.0), slope(0.0, 1.0)) {
            (Some(_), Some(dx), Some(dy)) => vec3(-dx, dy, 1.0).normalize(),
            (Some(_), ..) => vec3((x - 0.5 * w) / w, (0.5 * h - y) / h, 0.05).normalize(),
            _ => Vec3::ZERO,
        }
    });
    let depth = Plane::from_fn(size, |x, y| {
        let (x, y) = at(x, y);
        height(x, y).map_or(f32::NAN, |v| (0.5 * range - v) / range)
    });
    let coverage = Plane::from_fn(size, |x, y| {
        let (x, y) = at(x, y);
        if height(x, y).is_some() { 255 } else { 0 }
    });
    Surface::new(Maps { normals, depth, coverage }).unwrap()
}

fn ball(size: f32, radius: f32) -> impl Fn(f32, f32) -> Option<f32> + Sync {
    move |x, y| {
        let p = vec2(x - 0.5 * size, y - 0.5 * size);
        let rest = radius * radius - p.length_squared();
        (rest > 0.0).then(|| rest.sqrt())
    }
}

/// A solid as rays from the front meet it: the nearest of the planes n · p = d (y up) that face the
/// viewer, limits of a convex body.
fn convex(size: f32, planes: Vec<(Vec3, f32)>) -> impl Fn(f32, f32) -> Option<f32> + Sync {
    move |x, y| {
        let (x, y) = (x - 0.5 * size, 0.5 * size - y);
        let (mut top, mut bottom) = (f32::INFINITY, f32::NEG_INFINITY);
        for (n, d) in &planes {
            let rest = d - n.x * x - n.y * y;
            if n.z > 1e-6 {
                top = top.min(rest / n.z);
            } else if n.z < -1e-6 {
                bottom = bottom.max(rest / n.z);
            } else if rest < 0.0 {
                return None;
            }
        }
        (top > bottom).then_some(top)
    }
}

pub(super) fn cube(size: f32, half: f32) -> impl Fn(f32, f32) -> Option<f32> + Sync {
    // Turned about y by 35°, then about x by 30°.
    let (sy, cy) = 35f32.to_radians().sin_cos();
    let (sx, cx) = 30f32.to_radians().sin_cos();
    let turned = |v: Vec3| {
        let v = vec3(cy * v.x + sy * v.z, v.y, cy * v.z - sy * v.x);
        vec3(v.x, cx * v.y - sx * v.z, sx * v.y + cx * v.z)
    };
    let axes = [Vec3::X, Vec3::Y, Vec3::Z].map(turned);
    convex(size, axes.into_iter().flat_map(|a| [(a, half), (-a, half)]).collect())
}

/// A torus seen from so many degrees above its plane.
pub(super) fn torus(
    size: f32,
    big: f32,
    small: f32,
    degrees: f32,
) -> impl Fn(f32, f32) -> Option<f32> + Sync {
    let (s, c) = degrees.to_radians().sin_cos();
    move |x, y| {
        let (x, y) = (x - 0.5 * size, 0.5 * size - y);
        let outside = |z: f32| {
            // Into the frame of the torus, whose axis is y.
            let p = vec3(x, c * y + s * z, c * z - s * y);
            vec2(vec2(p.x, p.z).length() - big, p.y).length() - small
        };
        // Steps from the front as far as it is away at least.
        let mut z = big + small + 1.0;
        for _ in 0..400 {
            let away = outside(z);
            if away < 1e-4 {
                return Some(z);
            }
            z -= away;
            if z < -(big + small) - 1.0 {
                break;
            }
        }
        None
    }
}

fn lines_of(surface: &Surface, settings: &LineSettings) -> Vec<FormLine> {
    surface.form_lines(settings).lines.clone()
}

#[test]
fn a_ball_has_its_outline_and_nothing_else() {
    let ball = surface(Size::new(200, 200), ball(200.0, 80.0));
    let kinds = LineKinds::PEN.with(LineKind::Ridge, true);
    let lines = lines_of(&ball, &LineSettings { kinds, detail: 0.8, ..Default::default() });
    let kinds: Vec<_> = lines.iter().map(|l| (l.kind, l.points.len(), l.is_closed)).collect();
    assert_eq!(lines.len(), 1, "{kinds:?}");
    assert!(lines[0].is_closed && lines[0].kind == LineKind::Outline);
    let middle = vec2(100.0, 100.0);
    let off = lines[0].points.iter().map(|p| (p.at.distance(middle) - 80.0).abs());
    let most = off.fold(0.0, f32::max);
    assert!(most < 0.35, "{most} px off the circle");
}

#[test]
fn a_cube_has_its_nine_visible_edges() {
    let cube = surface(Size::new(240, 240), cube(240.0, 60.0));
    let lines = lines_of(&cube, &LineSettings::default());
    let of = |kind| lines.iter().filter(|line| line.kind == kind).count();
    let all: Vec<_> = lines.iter().map(|l| (l.kind, l.length_px())).collect();
    assert_eq!([of(LineKind::Outline), of(LineKind::Crease)], [6, 3], "{all:?}");
    assert_eq!(lines.len(), 9, "{all:?}");
}

#[test]
fn an_inner_contour_of_a_torus_ends_in_cusps() {
    let torus = surface(Size::new(320, 240), |x, y| torus(320.0, 100.0, 34.0, 30.0)(x, y + 40.0));
    let lines = lines_of(&torus, &LineSettings::default());
    let outlines: Vec<_> = lines.iter().filter(|l| l.kind == LineKind::Outline).collect();
    let all: Vec<_> = lines.iter().map(|l| (l.kind, l.is_closed, l.length_px())).collect();
    let whole = outlines.iter().filter(|line| line.is_closed).count();
    assert!(whole >= 1 && outlines.len() >= 2, "{all:?}");
    assert!(outlines.iter().any(|line| !line.is_closed), "{all:?}");
}

/// The farthest that a point of one drawing is from the other, px, where it is not at an end.
fn lines_difference(a: &[FormLine], b: &[FormLine]) -> f32 {
    let points: Vec<Vec2> = b.iter().flat_map(|l| l.points.iter().map(|p| p.at)).collect();
    let inner = a.iter().flat_map(|line| {
        let ends = if line.is_closed { 0 } else { 4 };
        let n = line.points.len();
        line.points[ends.min(n)..n.saturating_sub(ends).max(ends.min(n))].iter()
    });
    let mut all: Vec<f32> = inner
        .map(|p| {
            // To the chord between the two nearest.
            let by = |q: &Vec2| q.distance_squared(p.at);
            let first = points.iter().copied().min_by(|a, b| by(a).total_cmp(&by(b))).unwrap();
            let rest = points.iter().copied().filter(|q| *q != first);
            let second = rest.min_by(|a, b| by(a).total_cmp(&by(b))).unwrap();
            let way = (second - first).normalize_or_zero();
            way.perp_dot(p.at - first).abs().min(first.distance(p.at))
        })
        .collect();
    all.sort_by(f32::total_cmp);
    all[(all.len() - 1) * 99 / 100]
}

/// Two soft bumps, one before the other.
fn bumps(x: f32, y: f32) -> Option<f32> {
    let bump = |cx: f32, cy: f32, r: f32, h: f32| {
        h * (-(vec2(x - cx, y - cy).length_squared()) / (r * r)).exp()
    };
    let p = vec2(x - 128.0, y - 120.0) / vec2(112.0, 96.0);
    (p.length() < 1.0).then(|| bump(100.0, 100.0, 30.0, 44.0) + bump(160.0, 140.0, 22.0, 34.0))
}

#[test]
fn a_quarter_turn_turns_the_lines() {
    let side = 256.0;
    let size = Size::new(256, 256);
    let kinds = LineKinds::PEN.with(LineKind::Ridge, true);
    let settings = LineSettings { kinds, detail: 1.0, ..Default::default() };
    let upright = lines_of(&surface(size, bumps), &settings);
    let turned = lines_of(&surface(size, |x, y| bumps(y, side - x)), &settings);
    assert!(upright.len() > 2, "{}", upright.len());
    let back: Vec<FormLine> = turned
        .iter()
        .map(|line| {
            let point = |p: &LinePoint| LinePoint { at: vec2(p.at.y, side - p.at.x), ..*p };
            FormLine { points: line.points.iter().map(point).collect(), ..line.clone() }
        })
        .collect();
    let off = lines_difference(&back, &upright).max(lines_difference(&upright, &back));
    assert!(off <= 0.1, "{off} px");
}

#[test]
fn no_line_doubles_another() {
    for height in [&bumps as &(dyn Fn(f32, f32) -> Option<f32> + Sync), &cube(256.0, 60.0)] {
        let kinds = LineKinds::PEN.with(LineKind::Ridge, true);
        let settings = LineSettings { kinds, detail: 0.9, ..Default::default() };
        let lines = lines_of(&surface(Size::new(256, 256), height), &settings);
        for (i, line) in lines.iter().enumerate() {
            assert!(line.length_px() >= settings.shortest);
            for other in lines.iter().skip(i + 1) {
                let near = |p: &LinePoint| line.points.iter().any(|q| q.at.distance(p.at) < 2.0);
                let count = other.points.iter().filter(|p| near(p)).count();
                assert!(count <= 8, "{count} of {:?} beside {:?}", other.kind, line.kind);
            }
        }
    }
}

#[test]
fn light_that_moves_moves_no_other_line() {
    let bumps = surface(Size::new(256, 256), bumps);
    let kinds = LineKinds::PEN.with(LineKind::Light, true);
    let at = |degrees: f32| {
        let (s, c) = degrees.to_radians().sin_cos();
        lines_of(&bumps, &LineSettings { kinds, light: vec3(c, s, 1.0), ..Default::default() })
    };
    let others = |lines: &[FormLine]| -> Vec<FormLine> {
        lines.iter().filter(|l| l.kind != LineKind::Light).cloned().collect()
    };
    let (a, b) = (at(40.0), at(41.0));
    assert_eq!(others(&a), others(&b));
    assert!(a.len() > others(&a).len() && a != b);
}

#[test]
fn lines_stand_back_behind_what_passes_in_front() {
    // A bar before a board with a crease.
    let both = |x: f32, y: f32| {
        let board = if y < 128.0 { -0.5 * (128.0 - y) } else { -0.5 * (y - 128.0) };
        Some(if (110.0..140.0).contains(&x) { 80.0 } else { board })
    };
    let surface = surface(Size::new(256, 256), both);
    let reach = |gap_px: f32| {
        let lines = lines_of(&surface, &LineSettings { gap: gap_px, ..Default::default() });
        let creases = lines.iter().filter(|line| line.kind == LineKind::Crease);
        let ends = creases.flat_map(|line| line.points.iter().map(|p| p.at.x));
        ends.filter(|x| *x < 125.0).fold(0.0, f32::max)
    };
    assert!((reach(0.0) - 110.0).abs() < 1.5, "{}", reach(0.0));
    assert!((reach(8.0) - 102.0).abs() < 2.0, "{}", reach(8.0));
}

#[test]
fn a_groove_gets_a_line_along_its_bottom() {
    let groove = |x: f32, y: f32| {
        let off = (x - 128.3) / 5.0;
        Some(-10.0 * (-off * off).exp() + 0.0 * y)
    };
    let surface = surface(Size::new(256, 200), groove);
    let kinds = LineKinds::NONE.with(LineKind::Valley, true);
    let lines = lines_of(&surface, &LineSettings { kinds, ..Default::default() });
    assert_eq!(lines.len(), 1, "{:?}", lines.iter().map(FormLine::length_px).collect::<Vec<_>>());
    let off = lines[0].points.iter().map(|p| (p.at.x - 128.3).abs()).fold(0.0, f32::max);
    assert!(off < 0.1, "{off} px off");
    assert!(lines[0].length_px() > 190.0);
}

#[test]
fn normals_are_diffused_as_by_a_gaussian() {
    // A step of n̄: after σ it is the integral of a Gaussian.
    let mut plane = Plane::from_fn(Size::new(120, 90), |x, _| if x < 60 { 0.0 } else { 1.0 });
    let linked = |x: usize, y: usize| {
        let side = |bit: u8, is: bool| if is { bit } else { 0 };
        side(1, x > 0) | side(2, x < 119) | side(4, y > 0) | side(8, y < 89)
    };
    let links = Plane::from_fn(plane.size(), linked);
    smooth::diffuse(&mut plane, &links, 3.0);
    // Φ(−0.5/3), Φ(−3.5/3).
    assert!((plane.at(59, 40) - 0.4338).abs() < 4e-3, "{}", plane.at(59, 40));
    assert!((plane.at(56, 40) - 0.1217).abs() < 6e-3, "{}", plane.at(56, 40));
    let mut wide = Plane::from_fn(plane.size(), |x, _| if x < 60 { 0.0 } else { 1.0 });
    smooth::diffuse(&mut wide, &links, 8.0);
    assert!((wide.at(51, 40) - 0.144).abs() < 0.03, "{}", wide.at(51, 40));
}

#[test]
fn a_rim_that_coarse_maps_tore_off_breaks_no_outline() {
    // Pixels along the lower rim are far behind the form.
    let block = |x: f32, y: f32| {
        let is_inside = (40.0..160.0).contains(&x) && (40.0..120.0).contains(&y);
        is_inside.then_some(if y > 119.0 { -60.0 } else { 20.0 })
    };
    let lines = lines_of(&surface(Size::new(200, 160), block), &LineSettings::default());
    let all: Vec<_> = lines.iter().map(|l| (l.kind, l.length_px(), l.is_joined)).collect();
    assert_eq!(lines.len(), 4, "{all:?}");
    assert!(lines.iter().all(|line| line.is_joined == [true; 2]), "{all:?}");
}

#[test]
fn a_cast_shadow_has_an_edge_where_the_lamp_is_half_hidden() {
    // A block 30 px high on a board, its right side at x = 100, in light at 45° from the left.
    let block = |x: f32, y: f32| {
        let is_in = (60.0..100.0).contains(&x) && (60.0..140.0).contains(&y);
        Some(if is_in { 30.0 } else { 0.0 })
    };
    let kinds = LineKinds::NONE.with(LineKind::Shadow, true);
    let light = vec3(-1.0, 0.0, 1.0);
    let settings = LineSettings { kinds, light, ..Default::default() };
    let lines = lines_of(&surface(Size::new(200, 200), block), &settings);
    let along = |line: &&FormLine| line.points.iter().any(|p| (p.at.y - 100.0).abs() < 2.0);
    let edge: Vec<f32> = lines
        .iter()
        .filter(along)
        .flat_map(|line| line.points.iter().filter(|p| (p.at.y - 100.0).abs() < 20.0))
        .map(|p| p.at.x)
        .filter(|x| *x > 110.0)
        .collect();
    assert!(edge.len() > 20, "{} points, {} lines", edge.len(), lines.len());
    assert!(edge.iter().all(|x| (x - 130.0).abs() < 2.5), "{edge:?}");
}

/// A bump that its height above a plane falls off from like a Gaussian: it is steepest at 18/√2 px.
fn gaussian_bump(x: f32, y: f32) -> Option<f32> {
    Some(27.0 * (-vec2(x - 80.0, y - 80.0).length_squared() / (18.0 * 18.0)).exp())
}

#[test]
fn a_gaussian_bump_has_a_suggestive_contour_where_it_is_steepest() {
    let bump = surface(Size::new(160, 160), gaussian_bump);
    let kinds = LineKinds::NONE.with(LineKind::Suggestive, true);
    let lines = lines_of(&bump, &LineSettings { kinds, detail: 1.0, ..Default::default() });
    assert_eq!(lines.len(), 1, "{:?}", lines.iter().map(FormLine::length_px).collect::<Vec<_>>());
    let radii = lines[0].points.iter().map(|p| p.at.distance(vec2(80.0, 80.0)));
    let (least, most) = radii.fold((f32::MAX, 0.0f32), |(a, b), r| (a.min(r), b.max(r)));
    // Blurring by σ = 2 px moves it out: a Gaussian of √(18² + 2 · 2²).
    let exact = (0.5f32 * (18.0 * 18.0 + 8.0)).sqrt();
    assert!(lines[0].is_closed && most - least < 0.2, "{least} to {most}");
    assert!((0.5 * (least + most) - exact).abs() < 0.3, "{least} to {most}, {exact}");
}

#[test]
fn a_cylinder_and_a_saddle_have_no_inner_lines() {
    let cylinder = |_: f32, y: f32| {
        let rest = 70.0 * 70.0 - (y - 100.0) * (y - 100.0);
        (rest > 0.0).then(|| rest.sqrt())
    };
    let saddle = |x: f32, y: f32| {
        let p = vec2(x - 100.0, y - 100.0);
        (p.length() < 80.0).then_some(0.006 * (p.x * p.x - p.y * p.y))
    };
    for height in [&cylinder as &(dyn Fn(f32, f32) -> Option<f32> + Sync), &saddle] {
        let kinds = LineKinds::PEN.with(LineKind::Ridge, true);
        let settings = LineSettings { kinds, detail: 0.8, ..Default::default() };
        let lines = lines_of(&surface(Size::new(200, 200), height), &settings);
        let inner: Vec<_> = lines.iter().filter(|l| l.kind != LineKind::Outline).collect();
        let found: Vec<_> = inner.iter().map(|l| (l.kind, l.length_px())).collect();
        assert!(found.is_empty() && !lines.is_empty(), "{found:?}");
    }
}

#[test]
fn maps_twice_as_large_have_the_same_lines_twice_as_large() {
    let kinds = LineKinds::PEN.with(LineKind::Ridge, true);
    let settings = LineSettings { kinds, detail: 0.8, ..Default::default() };
    let once = lines_of(&surface(Size::new(256, 256), bumps), &settings);
    let large = |x: f32, y: f32| bumps(0.5 * x, 0.5 * y).map(|height| 2.0 * height);
    let twice = lines_of(&surface(Size::new(512, 512), large), &settings.scaled(2.0));
    let half: Vec<FormLine> = twice
        .iter()
        .map(|line| {
            let point = |p: &LinePoint| LinePoint { at: 0.5 * p.at, ..*p };
            FormLine { points: line.points.iter().map(point).collect(), ..line.clone() }
        })
        .collect();
    let of = |lines: &[FormLine]| {
        let mut kinds: Vec<_> = lines.iter().map(|line| line.kind).collect();
        kinds.sort();
        kinds
    };
    assert_eq!(of(&once), of(&half));
    let off = lines_difference(&half, &once).max(lines_difference(&once, &half));
    assert!(off <= 0.4, "{off} px");
}

#[test]
fn lines_are_the_same_with_any_number_of_threads() {
    let kinds = LineKinds::PEN.with(LineKind::Ridge, true).with(LineKind::Light, true);
    let settings = LineSettings { kinds, detail: 0.9, ..Default::default() };
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| lines_of(&surface(Size::new(256, 256), bumps), &settings))
    };
    assert_eq!(with(1), with(4));
}

#[test]
fn colors_have_an_edge_where_they_meet_and_none_where_they_fade() {
    let size = Size::new(120, 80);
    let flat = surface(size, |_, _| Some(0.0));
    let settings =
        LineSettings { kinds: LineKinds::NONE.with(LineKind::Color, true), ..Default::default() };
    let edges = |color: &(dyn Fn(usize, usize) -> [u8; 3] + Sync), size: Size| {
        let colors = Arc::new(PaperColors::new(Plane::from_fn(size, color)));
        let lines = flat.form_lines_on(&settings, Some(&colors));
        assert!(Arc::ptr_eq(&lines, &flat.form_lines_on(&settings, Some(&colors))));
        lines.lines.clone()
    };
    // As light as each other.
    let halves = |x: usize, _: usize| if x < 50 { [200, 80, 80] } else { [42, 134, 42] };
    let found = edges(&halves, size);
    assert!(found.len() == 1 && found[0].length_px() > 76.0, "{found:?}");
    let off = found[0].points.iter().map(|point| (point.at.x - 50.0).abs());
    assert!(off.fold(0.0, f32::max) < 0.1);
    // A picture of half the size has them at the same places.
    let half = edges(&|x, y| halves(2 * x, 2 * y), Size::new(60, 40));
    let off = half[0].points.iter().map(|point| (point.at.x - 50.0).abs());
    assert!(half.len() == 1 && off.fold(0.0, f32::max) < 0.3, "{half:?}");
    // A ramp, and one color.
    assert!(edges(&|x, _| [2 * x as u8; 3], size).is_empty());
    assert!(edges(&|_, _| [90; 3], size).is_empty());
    // A disc has one closed line around it.
    let disc = |x: usize, y: usize| {
        let away = vec2(x as f32 + 0.5, y as f32 + 0.5).distance(vec2(60.0, 40.0));
        [if away < 25.0 { 30 } else { 220 }; 3]
    };
    let ring = edges(&disc, size);
    let off = ring[0].points.iter().map(|p| (p.at.distance(vec2(60.0, 40.0)) - 25.0).abs());
    assert!(ring.len() == 1 && ring[0].is_closed && off.fold(0.0, f32::max) < 0.7, "{ring:?}");
}
