//! One surface, a ball with a bump, stored in every convention: it must come back as the same
//! normals and depth.

use super::maps::{Ball, Memory, SIDE, encode, exr_bytes, png};
use rilievo::Budget;
use rilievo::files::maps::{ImportedSurface, import};
use rilievo::files::{
    DepthConvention, DepthEncoding, MapSource, MaskSource, NormalConvention, SurfaceSource,
};

/// Which files take part besides the one under test.
#[derive(Clone, Copy, Debug, PartialEq)]
enum With {
    DepthAndMask,
    Depth,
    Mask,
}

fn source(
    normal: Option<MapSource<NormalConvention>>,
    depth: Option<MapSource<DepthConvention>>,
    mask: bool,
) -> SurfaceSource {
    let mask =
        mask.then(|| MaskSource::File { file: "m.png".into(), channel: None, invert: false });
    SurfaceSource { normal, depth, mask, matrix: None }
}

fn map<C: Default>(file: &str) -> Option<MapSource<C>> {
    Some(MapSource { file: file.into(), ..MapSource::default() })
}

/// Mean angle in degrees and mean difference of depth, over the pixels wholly inside.
fn errors(import: &ImportedSurface) -> (f64, f64) {
    let (ball, s) = (Ball::new(), &import.surface);
    let (near, far) = ball.range();
    let (mut angle, mut depth, mut count) = (0.0, 0.0, 0.0);
    for y in 0..SIDE {
        for x in 0..SIDE {
            let Some((n, z)) = ball.at(x, y).filter(|_| ball.is_inner(x, y)) else { continue };
            let m = s.normal(x, y);
            angle += f64::from(n.cross(m).length().atan2(n.dot(m)).to_degrees());
            depth += f64::from((s.depth(x, y) - (z - near) / (far - near)).abs());
            count += 1.0;
        }
    }
    (angle / count, depth / count)
}

type Encode = fn(glam::Vec3) -> [f32; 4];

/// Name, how a unit normal becomes numbers in [0, 1], what fills the outside, bits, and degrees
/// granted.
const NORMALS: [(&str, Encode, [f32; 4], u8, f64); 15] = [
    ("opengl 8", |n| encode(n.x, n.y, n.z), [0.5, 0.5, 1.0, 1.0], 8, 0.25),
    ("opengl 16", |n| encode(n.x, n.y, n.z), [0.5, 0.5, 1.0, 1.0], 16, 0.01),
    ("directx", |n| encode(n.x, -n.y, n.z), [0.5, 0.5, 1.0, 1.0], 8, 0.25),
    ("mirrored x", |n| encode(-n.x, n.y, n.z), [0.5, 0.5, 1.0, 1.0], 8, 0.25),
    ("away z", |n| encode(n.x, n.y, -n.z), [0.5, 0.5, 1.0, 1.0], 8, 0.25),
    ("all of b for z", |n| full_z(encode(n.x, n.y, n.z)), [0.5, 0.5, 1.0, 1.0], 8, 0.25),
    ("two channels", |n| empty_b(encode(n.x, n.y, n.z)), [0.5, 0.5, 0.0, 1.0], 8, 0.6),
    ("dxt5nm", |n| dxt5nm(encode(n.x, n.y, n.z)), [1.0, 0.5, 0.0, 0.5], 8, 0.6),
    ("z x y", |n| encode(n.z, n.x, n.y), [1.0, 0.5, 0.5, 1.0], 8, 0.25),
    ("y z x, y down", |n| encode(-n.y, n.z, n.x), [0.5, 1.0, 0.5, 1.0], 8, 0.25),
    (
        "baked through srgb",
        |n| through_srgb(encode(n.x, n.y, n.z)),
        [0.735_4, 0.735_4, 1.0, 1.0],
        8,
        0.6,
    ),
    ("shortened at the rim", |n| shortened(n), [0.5, 0.5, 0.5, 1.0], 16, 0.05),
    ("black outside", |n| encode(n.x, n.y, n.z), [0.0, 0.0, 0.0, 1.0], 8, 0.25),
    ("gray outside", |n| encode(n.x, n.y, n.z), [0.501_96, 0.501_96, 0.501_96, 1.0], 8, 0.25),
    ("clear outside", |n| encode(n.x, n.y, n.z), [0.0, 0.0, 0.0, 0.0], 8, 0.25),
];

/// As averaging over samples leaves them.
fn shortened(n: glam::Vec3) -> [f32; 4] {
    let n = n * (0.6 + n.z).min(1.0);
    encode(n.x, n.y, n.z)
}

fn full_z([r, g, b, a]: [f32; 4]) -> [f32; 4] {
    [r, g, 2.0 * b - 1.0, a]
}

fn empty_b([r, g, _, a]: [f32; 4]) -> [f32; 4] {
    [r, g, 0.0, a]
}

fn dxt5nm([r, g, ..]: [f32; 4]) -> [f32; 4] {
    [1.0, g, 0.0, r]
}

fn through_srgb(v: [f32; 4]) -> [f32; 4] {
    let [r, g, b, a] = v.map(rilievo_engine::math::srgb::encode);
    [r, g, b, a]
}

#[test]
fn every_encoding_of_normals_comes_back_as_the_same_normals() {
    let ball = Ball::new();
    for (name, texel, outside, bits, granted) in NORMALS {
        let file = png(bits, |x, y| ball.at(x, y).map_or(outside, |(n, _)| texel(n)));
        let files =
            Memory::new([("n.png", file), ("d.png", ball.depth_png()), ("m.png", ball.mask_png())]);
        for with in [With::DepthAndMask, With::Depth, With::Mask] {
            let depth = if with == With::Mask { None } else { map("d.png") };
            let import = import(
                &source(map("n.png"), depth, with != With::Depth),
                &files,
                &Budget::default(),
            );
            let import = import.unwrap_or_else(|e| panic!("{name} {with:?}: {e}"));
            let (angle, depth) = errors(&import);
            assert!(
                angle < granted,
                "{name} {with:?}: {angle:.3}° off; {:?}",
                import.findings.choices
            );
            let depth_granted = if with == With::Mask { 0.05 } else { 1e-4 };
            assert!(depth < depth_granted, "{name} {with:?}: depth {depth:.5} off");
        }
    }
}

#[test]
fn what_was_found_reads_the_same_maps_again() {
    let ball = Ball::new();
    let file =
        png(8, |x, y| ball.at(x, y).map_or([0.5, 0.5, 1.0, 1.0], |(n, _)| encode(n.z, -n.x, n.y)));
    let files =
        Memory::new([("n.png", file), ("d.png", ball.depth_png()), ("m.png", ball.mask_png())]);
    let found =
        import(&source(map("n.png"), map("d.png"), true), &files, &Budget::default()).unwrap();
    let told = Some(MapSource {
        convention: found.findings.normal.clone().unwrap(),
        ..map("n.png").unwrap()
    });
    let alone = import(&source(told, None, true), &files, &Budget::default()).unwrap();
    assert!(errors(&alone).0 < 0.25);
    assert!(
        alone
            .findings
            .choices
            .iter()
            .filter(|c| c.field.starts_with("normal"))
            .all(|c| c.confidence == 1.0)
    );
}

#[test]
fn every_layout_of_exr_is_read() {
    let ball = Ball::new();
    let plane = |f: &dyn Fn(glam::Vec3, f32) -> f32, outside: f32| -> Vec<f32> {
        let at = |i: usize| ball.at(i % SIDE, i / SIDE).map_or(outside, |(n, z)| f(n, z));
        (0..SIDE * SIDE).map(at).collect()
    };
    let xyz = [plane(&|n, _| n.x, 0.0), plane(&|n, _| n.y, 0.0), plane(&|n, _| n.z, 0.0)];
    let z = plane(&|_, z| z, 1e10);
    let layouts: [([&str; 3], &str); 7] = [
        (["ViewLayer.Normal.X", "ViewLayer.Normal.Y", "ViewLayer.Normal.Z"], "ViewLayer.Depth.Z"),
        (["my view.Normal.X", "my view.Normal.Y", "my view.Normal.Z"], "my view.Depth.V"),
        (["sh.X", "sh.Y", "sh.Z"], "dd.T"),
        (["N.R", "N.G", "N.B"], "Z"),
        (["N.red", "N.green", "N.blue"], "depth.Z"),
        (["__Nworld.r", "__Nworld.g", "__Nworld.b"], "__depth.r"),
        (["VRayNormals.R", "VRayNormals.G", "VRayNormals.B"], "VRayZDepth.Y"),
    ];
    for (normals, depth) in layouts {
        let color = plane(&|n, _| n.z * 0.5, 0.0);
        let mut channels: Vec<(&str, Vec<f32>)> = normals.into_iter().zip(xyz.clone()).collect();
        channels.push((depth, z.clone()));
        channels.extend(["R", "G", "B"].map(|c| (c, color.clone())));
        let files = Memory::new([("g.exr", exr_bytes(&channels, None))]);
        let import = import(&source(map("g.exr"), map("g.exr"), false), &files, &Budget::default());
        let import = import.unwrap_or_else(|e| panic!("{depth}: {e}"));
        let (angle, off) = errors(&import);
        assert!(angle < 0.05 && off < 1e-4, "{normals:?} {depth}: {angle}° and {off} off");
        assert_eq!(import.surface.coverage(0, 0), 0);
    }
}

#[test]
fn world_space_normals_are_turned_to_the_camera() {
    let ball = Ball::new();
    let turn = glam::Mat3::from_rotation_x(-1.2) * glam::Mat3::from_rotation_z(0.6);
    let to_world = turn.transpose();
    let plane = |f: &dyn Fn(glam::Vec3, f32) -> f32, outside: f32| -> Vec<f32> {
        let at = |i: usize| ball.at(i % SIDE, i / SIDE).map_or(outside, |(n, z)| f(n, z));
        (0..SIDE * SIDE).map(at).collect()
    };
    let channels = [
        ("N.X", plane(&|n, _| (to_world * n).x, 0.0)),
        ("N.Y", plane(&|n, _| (to_world * n).y, 0.0)),
        ("N.Z", plane(&|n, _| (to_world * n).z, 0.0)),
        ("Z", plane(&|_, z| z, 1e10)),
    ];
    // For row vectors, as the attribute is defined: the transpose of the matrix for column vectors.
    let c = turn.to_cols_array_2d();
    let attribute = std::array::from_fn(|i| {
        if i / 4 < 3 && i % 4 < 3 { c[i / 4][i % 4] } else { [0.0, 1.0][i / 15] }
    });
    let rows = [0, 1, 2].map(|r| [0, 1, 2].map(|k| c[k][r]));
    let told = NormalConvention { world_to_camera: Some(rows), ..NormalConvention::default() };
    let cases = [
        ("found from depth", None, NormalConvention::default(), true, 1.0),
        ("found from the silhouette", None, NormalConvention::default(), false, 4.0),
        ("given by the file", Some(attribute), NormalConvention::default(), true, 0.05),
        ("given by the user", None, told, true, 0.05),
    ];
    for (name, attribute, convention, with_depth, granted) in cases {
        let files =
            Memory::new([("g.exr", exr_bytes(&channels, attribute)), ("m.png", ball.mask_png())]);
        let normal = Some(MapSource { convention, ..map("g.exr").unwrap() });
        let depth = if with_depth { map("g.exr") } else { None };
        let import = import(&source(normal, depth, true), &files, &Budget::default()).unwrap();
        let (angle, _) = errors(&import);
        assert!(angle < granted, "{name}: {angle}° off; {:?}", import.findings);
    }
}

#[test]
fn every_convention_of_depth_comes_back_as_the_same_depth() {
    use DepthEncoding::{Disparity, Inverse, RayDistance};
    let ball = Ball::new();
    let (near, far) = ball.range();
    let focal = SIDE as f32 * 0.5 / (25.0f32.to_radians()).tan();
    let ray = |x: usize, y: usize, z: f32| {
        let (u, v) = (
            (x as f32 + 0.5 - SIDE as f32 * 0.5) / focal,
            (y as f32 + 0.5 - SIDE as f32 * 0.5) / focal,
        );
        z * (1.0 + u * u + v * v).sqrt()
    };
    type Store<'a> = &'a dyn Fn(usize, usize, f32) -> f32;
    let plain: Store = &|_, _, z| z;
    let told = |encoding, fov_degrees| DepthConvention {
        encoding: Some(encoding),
        fov_degrees,
        ..Default::default()
    };
    let auto = DepthConvention::default;
    let odd = DepthConvention { background: vec![170.0], ..Default::default() };
    let cases: [(&str, Store, f32, DepthConvention, f64); 15] = [
        ("1e10 outside", plain, 1e10, auto(), 1e-4),
        ("infinity outside", plain, f32::INFINITY, auto(), 1e-4),
        ("NaN outside", plain, f32::NAN, auto(), 1e-4),
        ("65504 outside", plain, 65504.0, auto(), 1e-4),
        ("0 outside", plain, 0.0, auto(), 1e-4),
        ("−1 outside", plain, -1.0, auto(), 1e-4),
        ("1e6 outside", plain, 1e6, auto(), 1e-4),
        ("a value told", plain, 170.0, odd, 1e-4),
        ("negative camera z", &|_, _, z| -z, -1e6, auto(), 1e-4),
        ("near white", &|_, _, z| 1.0 - (z - near) / (far - near), 0.0, auto(), 1e-4),
        ("1/z found", &|_, _, z| 1.0 / z, 0.0, auto(), 1e-3),
        ("1/z told", &|_, _, z| 1.0 / z, 0.0, told(Inverse, None), 1e-3),
        ("disparity", &|_, _, z| 7.0 - 0.02 * z, 0.0, told(Disparity, None), 1e-3),
        ("millimeters", &|_, _, z| (z * 10.0).round(), 0.0, auto(), 2e-3),
        ("along the ray", &|x, y, z| ray(x, y, z), 0.0, told(RayDistance, Some(50.0)), 1e-4),
    ];
    for (name, store, outside, convention, granted) in cases {
        let value = |i: usize| {
            ball.at(i % SIDE, i / SIDE).map_or(outside, |(_, z)| store(i % SIDE, i / SIDE, z))
        };
        let values: Vec<f32> = (0..SIDE * SIDE).map(value).collect();
        let files = Memory::new([
            ("n.png", ball.normal_png()),
            ("d.exr", exr_bytes(&[("Z", values)], None)),
            ("m.png", ball.mask_png()),
        ]);
        for mask in [true, false] {
            let depth = Some(MapSource { convention: convention.clone(), ..map("d.exr").unwrap() });
            let import =
                import(&source(map("n.png"), depth, mask), &files, &Budget::default()).unwrap();
            let (angle, off) = errors(&import);
            assert!(
                off < granted && angle < 0.01,
                "{name}, mask {mask}: {off} and {angle}° off; {:?}",
                import.findings
            );
            let s = &import.surface;
            assert!(s.depth_plane().values().iter().all(|z| (0.0..=1.0).contains(z)), "{name}");
        }
    }
}

#[test]
fn depth_in_pictures_of_any_depth_and_polarity_is_read() {
    let ball = Ball::new();
    let (near, far) = ball.range();
    for (bits, white_is_near, granted) in
        [(8, false, 2e-3), (8, true, 2e-3), (16, false, 1e-5), (16, true, 1e-5)]
    {
        let value = |x, y| {
            let z = ball.at(x, y).map_or(1.0, |(_, z)| (z - near) / (far - near));
            let v = if white_is_near { 1.0 - z } else { z };
            [v, v, v, 1.0]
        };
        let files = Memory::new([
            ("n.png", ball.normal_png()),
            ("d.png", png(bits, value)),
            ("m.png", ball.mask_png()),
        ]);
        let import =
            import(&source(map("n.png"), map("d.png"), true), &files, &Budget::default()).unwrap();
        assert!(
            errors(&import).1 < granted,
            "{bits} bits, white near {white_is_near}: {:?}",
            import.findings
        );
        let alone = rilievo::files::maps::import(
            &source(None, map("d.png"), true),
            &files,
            &Budget::default(),
        )
        .unwrap();
        assert!(
            errors(&alone).1 < granted && errors(&alone).0 < 12.0,
            "alone: {:?}",
            errors(&alone)
        );
    }
}

#[test]
fn a_flat_border_is_surface_until_it_is_said_to_be_background() {
    let ball = Ball::new();
    let files = Memory::new([("n.png", ball.normal_png())]);
    let open = import(&source(map("n.png"), None, false), &files, &Budget::default()).unwrap();
    assert_eq!(open.surface.coverage(0, 0), 255);
    assert!(open.findings.notes.iter().any(|n| n.contains("looks like background")));
    let flat = SurfaceSource { mask: Some(MaskSource::Flat), ..source(map("n.png"), None, false) };
    let closed = import(&flat, &files, &Budget::default()).unwrap();
    assert_eq!(closed.surface.coverage(0, 0), 0);
    assert_eq!(closed.surface.coverage(SIDE / 2, SIDE / 2), 255);
}

#[test]
fn a_hole_in_a_ring_is_background_where_the_depth_says_so_and_a_plate_at_the_border_is_not() {
    // A ring, and a plate that faces the viewer and fills the lowest rows.
    let seen = |x: usize, y: usize| {
        let (p, r) = (glam::vec2(x as f32 - 47.5, 40.0 - y as f32), 12.0);
        let t = (p.length() - 24.0) / r;
        let ring = (t.abs() < 0.99).then(|| (p.normalize() * t, 0.5 - 0.4 * (1.0 - t * t).sqrt()));
        ring.map(|(n, z)| (n.extend((1.0 - n.length_squared()).sqrt()), z))
            .or((y >= 84).then_some((glam::Vec3::Z, 0.7)))
    };
    let normals =
        png(16, |x, y| seen(x, y).map_or([0.5, 0.5, 1.0, 1.0], |(n, _)| encode(n.x, n.y, n.z)));
    let depth = png(16, |x, y| [seen(x, y).map_or(1.0, |(_, z)| z); 4]);
    let files = Memory::new([("n.png", normals), ("d.png", depth)]);
    let coverage = |depth: Option<MapSource<DepthConvention>>| {
        let flat =
            SurfaceSource { mask: Some(MaskSource::Flat), ..source(map("n.png"), depth, false) };
        let surface = import(&flat, &files, &Budget::default()).unwrap().surface;
        // Beside the ring, within it, on it, on the plate.
        [(2, 2), (47, 40), (24, 40), (47, 90)].map(|(x, y)| surface.coverage(x, y))
    };
    assert_eq!(coverage(None), [0, 255, 255, 0]);
    assert_eq!(coverage(map("d.png")), [0, 0, 255, 255]);
}

#[test]
fn maps_that_do_not_fit_get_a_sentence() {
    let ball = Ball::new();
    let small = super::maps::png_of(SIDE / 2, 8, |_, _| [0.5, 0.5, 1.0, 1.0]);
    let gray = png(8, |x, _| {
        let v = x as f32 / SIDE as f32;
        [v, v, v, 1.0]
    });
    let empty = exr_bytes(&[("Z", vec![f32::INFINITY; SIDE * SIDE])], None);
    let files = Memory::new([
        ("n.png", ball.normal_png()),
        ("s.png", small),
        ("g.png", gray),
        ("e.exr", empty),
    ]);
    let cases = [
        (
            source(map("s.png"), map("g.png"), false),
            "differ in size: s.png has 48 × 48 pixels, g.png has 96 × 96",
        ),
        (source(map("g.png"), None, false), "g.png: cannot be read: the picture is gray"),
        (source(None, map("n.png"), false), "n.png: cannot be read: the picture is colored"),
        (source(None, map("e.exr"), false), "no surface at all"),
        (source(map("e.exr"), None, false), "no layer of this EXR looks like normals"),
        (source(map("lost.png"), None, false), "lost.png"),
        (SurfaceSource::default(), "neither normals nor depth"),
    ];
    for (source, part) in cases {
        let said = import(&source, &files, &Budget::default())
            .err()
            .map(|e| e.to_string())
            .unwrap_or_default();
        assert!(said.contains(part), "“{said}” should say “{part}”");
    }
}
