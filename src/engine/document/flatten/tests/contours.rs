//! Pixels that two sides see: coverage acts once, whatever is stacked; what is behind a
//! contour shows in its share.

use super::*;
use crate::document::{Live, NormalLayer};
use crate::math::srgb;
use crate::paint::{
    Brush, DualBrush, DualSettings, Gradient, GradientStop, ImageFilter, PictureSource, Placement,
    Sample, Stroke,
};
use crate::raster::{Outside, Picture};
use crate::shading::{Model, RadianceScaling, Scaling, Shading};
use crate::surface::{DetailMap, Operator};

/// Covered by the shares of the columns: 0 … 255 over and over.
fn soft_surface() -> Arc<Surface> {
    let coverage = Plane::from_fn(SIZE, |x, _| share(x));
    let normals = Plane::full(SIZE, vec3(0.6, 0.0, 0.8));
    Arc::new(Surface::new(Maps { normals, depth: Plane::full(SIZE, 0.5), coverage }).unwrap())
}

fn share(x: usize) -> u8 {
    [0, 64, 128, 191, 255][x % 5]
}

fn on_soft(layers: Vec<Layer>) -> TileGrid {
    flatten(&Document { surface: Some(soft_surface()), ..document(layers) }, &Progress::default())
        .unwrap()
}

fn unclipped_layer(text: &str) -> Layer {
    with(fill(text), |l| l.clip_to_surface = false)
}

/// Every pixel of the first columns is `c · covered + (1 − c) · bare`, premultiplied.
fn assert_shared(found: &TileGrid, covered: [u8; 4], bare: [u8; 4], what: &str) {
    for x in 0..10 {
        let c = f32::from(share(x)) / 255.0;
        let expected =
            std::array::from_fn(|i| c * f32::from(covered[i]) + (1.0 - c) * f32::from(bare[i]));
        let pixel = found.pixel(x as i32, 7);
        for i in 0..4 {
            let expected: [f32; 4] = expected;
            assert!(
                (f32::from(pixel[i]) - expected[i]).abs() <= 1.0,
                "{what}, column {x}: {pixel:?} ≠ {expected:?}"
            );
        }
    }
}

#[test]
fn opaque_fills_cover_as_the_mask_says_however_many_there_are() {
    for n in [1, 2, 4, 8, 16] {
        let p = on_soft((0..n).map(|_| fill("#ffffff")).collect());
        assert_shared(&p, [255; 4], [0; 4], &format!("{n} fills"));
    }
}

#[test]
fn no_outline_shows_whatever_meets_on_the_rim() {
    let white = || fill("#ffffff");
    let mode = |l: Layer, mode| with(l, |l| l.blend = mode);
    let clipped = |l: Layer| with(l, |l| l.clip_below = true);
    let scaling = || {
        let scaling =
            RadianceScaling { scaling: Scaling::new(0.2, 0.0), ..RadianceScaling::default() };
        Layer::new("rs", Content::RadianceScaling(scaling))
    };
    let stacks: Vec<(&str, Vec<Layer>)> = vec![
        ("multiply", vec![white(), mode(white(), BlendMode::Multiply), white()]),
        ("groups", vec![group(vec![white(), group(vec![white()], true)], false), white()]),
        ("clipping", vec![white(), clipped(white()), clipped(group(vec![white()], false))]),
        (
            "screen",
            vec![white(), mode(white(), BlendMode::Screen), mode(white(), BlendMode::Normal)],
        ),
        ("adjustment", vec![white(), scaling(), white()]),
        ("half", vec![white(), with(white(), |l| l.opacity = 0.5)]),
    ];
    for (name, stack) in stacks {
        assert_shared(&on_soft(stack.clone()), [255; 4], [0; 4], name);
        let on_white = std::iter::once(unclipped_layer("#ffffff")).chain(stack).collect();
        assert_shared(&on_soft(on_white), [255; 4], [255; 4], &format!("{name} on white"));
    }
}

#[test]
fn what_is_not_clipped_to_the_surface_stands_in_both() {
    let stack = vec![
        unclipped_layer("#204060"),
        fill("#ff8000"),
        with(unclipped_layer("#ffffff"), |l| l.opacity = 0.5),
    ];
    let p = on_soft(stack);
    assert_shared(&p, [255, 191, 127, 255], [143, 159, 175, 255], "over and under");
    let paint = with(layer_left_of(50, "#00ff00"), |l| l.clip_to_surface = false);
    assert_shared(
        &on_soft(vec![fill("#ff0000"), paint]),
        [0, 255, 0, 255],
        [0, 255, 0, 255],
        "paint",
    );
}

/// Detail that leans everywhere in one direction.
pub fn cloth(normal: Vec3) -> Layer {
    let detail = Arc::new(DetailMap::new(Plane::full(Size::new(4, 4), normal)));
    let picture = Picture::srgb8(Size::new(1, 1), vec![[255; 4]]).unwrap();
    let picture = PictureSource::new("d.png".into(), picture, Default::default());
    let source =
        crate::document::DetailSource::Map { picture, convention: Default::default(), map: detail };
    let placement = Placement::covering(SIZE);
    let normals = NormalLayer {
        source,
        placement,
        outside: Outside::Repeat,
        strength: 1.0,
        frame: Default::default(),
    };
    Layer::new("cloth", Content::Normals(normals))
}

#[test]
fn masks_and_normal_layers_leave_coverage_to_act_once() {
    let normals = cloth(vec3(0.1, 0.0, 1.0));
    let masked =
        with(fill("#ffffff"), |l| l.mask = mask(DerivedMask::Depth { from: 0.0, to: 1.0 }));
    let p = on_soft(vec![normals, masked.clone(), with(masked, |l| l.mask = left_mask())]);
    assert_shared(&p, [255; 4], [0; 4], "masked");
}

/// A near plate in the columns left of 40.5 before a farther one that leans; no mask.
fn plates() -> Arc<Surface> {
    let near = |x: usize| x < 40;
    let normals = Plane::from_fn(SIZE, |x, _| if near(x) { Vec3::Z } else { vec3(0.6, 0.0, 0.8) });
    let depth =
        Plane::from_fn(SIZE, |x, _| if near(x) { 0.0 } else { 0.5 + 0.0075 * (x as f32 - 40.0) });
    Arc::new(Surface::new(Maps { normals, depth, coverage: Plane::full(SIZE, 255) }).unwrap())
}

#[test]
fn away_from_contours_every_byte_stays() {
    // The contour lies between columns 39 and 40: only those two are mixed.
    let clay = Layer::new("clay", Content::Shading(Live::new(Shading::new(Model::Phong))));
    let doc = Document { surface: Some(plates()), ..document(vec![clay]) };
    let picture = flatten(&doc, &Progress::default()).unwrap();
    let far = picture.pixel(60, 30);
    let near = picture.pixel(20, 30);
    assert_ne!(far, near);
    for x in [0, 10, 38] {
        assert_eq!(picture.pixel(x, 30), near);
    }
    for x in [41, 50, 99] {
        assert_eq!(picture.pixel(x, 30), far);
    }
}

#[test]
fn live_layers_are_rendered_for_both_sides_alike() {
    // A straight edge along the pixels' border gives whole shares, so a slanted one is needed:
    // below it the far plate, above it the near one; along it each pixel holds a mean of both.
    let near = |x: usize, y: usize| (y as f32 + 0.5) < 20.0 + 0.31 * x as f32;
    let normals =
        Plane::from_fn(SIZE, |x, y| if near(x, y) { Vec3::Z } else { vec3(0.0, 0.5, 0.866) });
    let depth = Plane::from_fn(SIZE, |x, y| if near(x, y) { 0.1 } else { 0.6 + 0.0058 * y as f32 });
    let surface =
        Arc::new(Surface::new(Maps { normals, depth, coverage: Plane::full(SIZE, 255) }).unwrap());
    let operator = Operator::Normal { alpha: 0.6, beta: 0.0, detail: 0.0 };
    let stops = vec![
        GradientStop { t: 0.0, color: color("#000000") },
        GradientStop { t: 1.0, color: color("#ffffff") },
    ];
    let (from, to) = (crate::math::vec2(50.0, 2.0), crate::math::vec2(50.0, 68.0));
    let gradient = Gradient {
        from,
        to,
        stops,
        operator,
        filter: ImageFilter::Antialias,
        frame: Default::default(),
        style: Default::default(),
        pieces: Vec::new(),
    };
    let brush = Brush { size: 300.0, hardness: 1.0, ..Brush::default() };
    // The second tip takes half of the first one's everywhere.
    let settings = DualSettings { size: 4.0, hardness: 1.0, opacity: 0.5, ..DualSettings::DEFAULT };
    let dual = DualBrush { settings, ..DualBrush::default() };
    let dual = Brush { dual: Some(Arc::new(dual)), ..brush.clone() };
    let stroke_of = |brush: &Brush, operator| {
        let samples = vec![Sample::at(crate::math::vec2(50.0, 5.0))];
        let strokes =
            vec![Arc::new(Stroke::new(brush.clone(), operator, color("#3060c0"), samples))];
        Layer::new("s", Content::Strokes(Live::new(crate::document::StrokeList { strokes })))
    };
    let stroke = |operator| stroke_of(&brush, operator);
    let layers = [
        Layer::new("clay", Content::Shading(Live::new(Shading::new(Model::Phong)))),
        Layer::new("g", Content::Gradient(Live::new(gradient))),
        with(fill("#ff0000"), |l| l.mask = mask(DerivedMask::Fresnel { f0: 0.0, power: 1.0 })),
        with(fill("#ff0000"), |l| l.mask = mask(DerivedMask::Depth { from: 0.0, to: 1.0 })),
        stroke(Operator::None),
        stroke(Operator::Normal { alpha: 0.2, beta: 1.0, detail: 0.0 }),
        stroke_of(&dual, Operator::None),
        stroke_of(&dual, Operator::Normal { alpha: 0.2, beta: 1.0, detail: 0.0 }),
    ];
    for layer in layers {
        let doc = Document { surface: Some(surface.clone()), ..document(vec![layer.clone()]) };
        let picture = flatten(&doc, &Progress::default()).unwrap();
        let name = layer.name;
        let mut mixed = 0;
        for at in TileAt::covering(SIZE.rect()) {
            let Some(contours) = surface.contours().on(at) else { continue };
            for pixel in contours.pixels.iter().filter(|p| p.x > 4 && p.x < 95 && p.share < 0.9) {
                // Across the edge, from the pixels beyond it on both sides; light is what is mixed.
                let value = |dy: i32| {
                    let p = picture.pixel(pixel.x, pixel.y + dy).map(|v| f32::from(v) / 255.0);
                    srgb::decode((p[0] / p[3].max(1e-3)).min(1.0)) * p[3] + 3.0 * p[3]
                };
                let (up, down) = (2.0 * value(-2) - value(-3), 2.0 * value(2) - value(3));
                let is_near = near(pixel.x as usize, pixel.y as usize);
                let (own, other) = if is_near { (up, down) } else { (down, up) };
                let (expected, found) = (pixel.share * own + (1.0 - pixel.share) * other, value(0));
                let room = 0.02 + 0.06 * (up - down).abs();
                assert!(
                    (found - expected).abs() < room,
                    "{name} at {pixel:?}: {found} ≠ {expected} ({up}, {down})"
                );
                mixed += 1;
            }
        }
        assert!(mixed > 50, "{name}: {mixed}");
    }
}

#[test]
fn contours_do_not_depend_on_the_number_of_threads() {
    let clay = Layer::new("clay", Content::Shading(Live::new(Shading::new(Model::Phong))));
    let bytes = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let doc = Document { surface: Some(plates()), ..document(vec![clay.clone()]) };
        pool.install(|| flatten(&doc, &Progress::default()).unwrap().to_straight_rgba(SIZE.rect()))
    };
    assert_eq!(bytes(1), bytes(2));
}

/// A disc that faces the viewer before nothing. `hard`: its mask is binary, else one of 64 samples
/// a pixel.
fn disc(hard: bool) -> Arc<Surface> {
    let from_rim = |x: f32, y: f32| crate::math::vec2(x - 50.3, y - 34.6).length() - 27.4;
    let part = |i: usize| (i as f32 + 0.5) / 8.0;
    let coverage = Plane::from_fn(SIZE, |x, y| {
        let covers = |i: &usize| from_rim(x as f32 + part(i % 8), y as f32 + part(i / 8)) < 0.0;
        match hard {
            true => 255 * u8::from(from_rim(x as f32 + 0.5, y as f32 + 0.5) < 0.0),
            false => (255 * (0..64).filter(covers).count() / 64) as u8,
        }
    });
    let (normals, depth) = (Plane::full(SIZE, Vec3::Z), Plane::full(SIZE, 0.5));
    Arc::new(Surface::new(Maps { normals, depth, coverage }).unwrap())
}

/// Every rim pixel of a disc: how much of it is covered, and what it shows.
fn rim(surface: &Arc<Surface>, pixels: impl Fn(i32, i32) -> [f32; 4]) -> Vec<(f32, [f32; 4])> {
    let covered = |p: &crate::surface::ContourPixel| {
        if p.is_own_on_surface() { p.share } else { 1.0 - p.share }
    };
    let mut rim: Vec<_> =
        surface.contours().pixels().iter().map(|p| (covered(p), pixels(p.x, p.y))).collect();
    rim.sort_by(|a, b| a.0.total_cmp(&b.0));
    rim
}

#[test]
fn a_rim_shows_its_coverage_as_an_opacity_wherever_the_pixels_centers_lie() {
    let on_ground =
        |layers: Vec<Layer>| std::iter::once(unclipped_layer("#203038")).chain(layers).collect();
    let white = || fill("#e0d0c0");
    let clipped = |l: Layer| with(l, |l| l.clip_below = true);
    let half = |l: Layer| with(l, |l| l.opacity = 0.5);
    let mut stacks: Vec<(&str, Vec<Layer>)> = vec![
        ("no ground", vec![white()]),
        ("fill", on_ground(vec![white()])),
        ("half", on_ground(vec![half(white()), half(white())])),
        ("group", on_ground(vec![group(vec![white(), group(vec![white()], true)], false)])),
        ("passing group", on_ground(vec![half(group(vec![white(), half(fill("#ff0000"))], true))])),
        (
            "clipping",
            on_ground(vec![
                fill("#808080"),
                clipped(white()),
                clipped(group(vec![white()], false)),
            ]),
        ),
        ("clipped to the ground", on_ground(vec![clipped(white())])),
    ];
    for (mode, name) in BlendMode::ALL.into_iter().filter(|(mode, _)| *mode != BlendMode::Dissolve)
    {
        stacks.push((name, on_ground(vec![with(white(), |l| l.blend = mode)])));
    }
    for (name, layers) in stacks {
        for hard in [true, false] {
            let surface = disc(hard);
            let document = Document { surface: Some(surface.clone()), ..document(layers.clone()) };
            let bytes = flatten(&document, &Progress::default()).unwrap();
            let floats =
                flatten_to_floats(&document, Highlights::Clipped, &Progress::default()).unwrap();
            let bytes = |x: i32, y: i32| bytes.pixel(x, y).map(|v| f32::from(v) / 255.0);
            let floats = |x: i32, y: i32| floats[y as usize * SIZE.width as usize + x as usize];
            for (depth, rim) in [("8", rim(&surface, bytes)), ("16", rim(&surface, floats))] {
                let (bare, whole) = if depth == "8" {
                    (bytes(1, 1), bytes(50, 34))
                } else {
                    (floats(1, 1), floats(50, 34))
                };
                let what = format!("{name}, {depth} bits, hard: {hard}");
                assert!(rim.len() > 100, "{what}: {}", rim.len());
                for (covered, shown) in &rim {
                    for i in 0..4 {
                        let expected = bare[i] + covered * (whole[i] - bare[i]);
                        let off = (shown[i] - expected).abs();
                        assert!(
                            off < 1.1 / 255.0,
                            "{what}: {covered} covered shows {shown:?}, not {expected}"
                        );
                    }
                }
                // Less is never brighter.
                for pair in rim.windows(2) {
                    for i in 0..4 {
                        let grows = (pair[1].1[i] - pair[0].1[i]) * (whole[i] - bare[i]).signum();
                        assert!(whole[i] == bare[i] || grows > -1e-6, "{what}: {pair:?}");
                    }
                }
            }
        }
    }
}
