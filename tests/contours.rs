//! Contours of every kind of layer: nine spheres in front of each other and of nothing, compared
//! with the mean of the same picture five times as large (MATH 10).

/// The same that the engine's own tests are made of.
#[path = "../src/engine/surface/contours/tests/spheres.rs"]
mod spheres;

use rilievo::files::{RecipeFolder, recipe};
use rilievo::math::Vec3;
use rilievo::raster::Plane;
use rilievo::{Budget, Color, Content, Document, Layer, Maps, Progress, Size, Surface, flatten};
use rilievo_engine::math::srgb;
use serde_json::{Value, json};
use spheres::hit_at;
use std::path::Path;
use std::sync::Arc;

const SIZE: Size = Size::new(spheres::CANVAS[0], spheres::CANVAS[1]);
/// How much larger the picture is that the reference is the mean of; odd, so that a sample lies in
/// each middle.
const TIMES: usize = 5;
/// The spheres, so many times as large.
fn surface(times: usize) -> Arc<Surface> {
    let size = Size::new(SIZE.width * times as u32, SIZE.height * times as u32);
    let at = |x: usize, y: usize| {
        hit_at((x as f32 + 0.5) / times as f32, (y as f32 + 0.5) / times as f32)
    };
    let maps = Maps {
        normals: Plane::from_fn(size, |x, y| at(x, y).map_or(Vec3::ZERO, |s| s.1)),
        depth: Plane::from_fn(size, |x, y| at(x, y).map_or(f32::NAN, |s| (220.0 - s.2) / 280.0)),
        coverage: Plane::from_fn(size, |x, y| if at(x, y).is_some() { 255 } else { 0 }),
    };
    Arc::new(Surface::new(maps).unwrap())
}

/// Pixels whose parts in the larger reference show more than one thing.
fn is_contour(x: usize, y: usize) -> bool {
    let at = |k: usize| (k as f32 + 0.5) / TIMES as f32;
    let mut parts = (0..TIMES * TIMES)
        .map(|k| hit_at(x as f32 + at(k % TIMES), y as f32 + at(k / TIMES)).map(|s| s.0));
    let first = parts.next();
    parts.any(|part| Some(part) != first)
}

/// Linear light, premultiplied, row by row.
fn light(document: &Document) -> Vec<[f32; 4]> {
    let grid = flatten(document, &Progress::default()).unwrap();
    let linear = |[r, g, b, a]: [u8; 4]| {
        let alpha = f32::from(a) / 255.0;
        let [r, g, b] = [r, g, b].map(|v| srgb::decode_u8(v) * alpha);
        [r, g, b, alpha]
    };
    grid.to_straight_rgba(document.size.rect())
        .as_chunks()
        .0
        .iter()
        .map(|pixel| linear(*pixel))
        .collect()
}

/// Mean error over contour pixels of one sample, and of the picture itself.
fn errors(layers: &[Layer], surfaces: &[Arc<Surface>; 2]) -> [f64; 2] {
    let flat = Document {
        layers: layers.iter().cloned().map(Arc::new).collect(),
        ..Document::empty(SIZE)
    };
    let large =
        Document { surface: Some(surfaces[1].clone()), ..flat.scaled(TIMES as f32).unwrap() };
    let (own, large) =
        (light(&Document { surface: Some(surfaces[0].clone()), ..flat }), light(&large));
    let (mut sums, mut count) = ([0.0; 2], 0);
    let (w, h) = (SIZE.width as usize, SIZE.height as usize);
    for (x, y) in
        (0..h).flat_map(|y| (0..w).map(move |x| (x, y))).filter(|&(x, y)| is_contour(x, y))
    {
        let part = |i: usize, j: usize| large[(y * TIMES + j) * w * TIMES + x * TIMES + i];
        let parts = || (0..TIMES * TIMES).map(|k| part(k % TIMES, k / TIMES));
        let (one, own) = (part(TIMES / 2, TIMES / 2), own[y * w + x]);
        for c in 0..4 {
            let mean = parts().map(|p| p[c]).sum::<f32>() / (TIMES * TIMES) as f32;
            sums[0] += f64::from((one[c] - mean).abs());
            sums[1] += f64::from((own[c] - mean).abs());
        }
        count += 4;
    }
    sums.map(|sum| sum / f64::from(count))
}

fn layers(list: Value, folder: &Path) -> Vec<Layer> {
    let text = json!({ "canvas": { "width": SIZE.width, "height": SIZE.height }, "layers": list })
        .to_string();
    let (file, budget) = (folder.join("a.json"), Budget::default());
    let files = RecipeFolder::folder_of(&file);
    let source = recipe::RecipeSource { file: &file, files: &files, budget: &budget, onto: None };
    let document = recipe::read(text.as_bytes(), source).unwrap();
    document.layers.iter().map(|layer| Layer::clone(layer)).collect()
}

#[test]
fn every_kind_of_layer_and_any_number_of_them_is_smooth_at_contours() {
    let folder = tempfile::tempdir().unwrap();
    let wave = |x: u32, y: u32, c: u32| {
        (128.0 + 90.0 * (0.11 * (x + 9 * c) as f32).sin() * (0.09 * y as f32).cos()) as u8
    };
    let photo =
        image::RgbImage::from_fn(260, 200, |x, y| image::Rgb([0, 1, 2].map(|c| wave(x, y, c))));
    photo.save(folder.path().join("photo.png")).unwrap();
    let lights = json!([{ "kind": "directional", "direction": [0.4, 0.5, 0.77] }]);
    let bent = json!({ "kind": "normal", "alpha": 0.2 });
    let phong = json!({ "name": "lit", "kind": "shading", "model": "phong", "lights": lights });
    let fill = |color: &str| json!({ "name": "fill", "kind": "fill", "color": color });
    let masked =
        |mask: Value| json!({ "name": "masked", "kind": "fill", "color": "#101040", "mask": mask });
    let stroke = |y: u32| {
        let samples = json!([[10, y], [250, y + 20]]);
        json!({ "brush": { "size": 44 }, "operator": bent, "color": "#e0b020", "samples": samples })
    };
    // An anchor reads the pixel that holds it: in its middle the larger picture is pinned at the
    // same normal.
    let anchors = json!([{ "at": [130.5, 100.5] }]);
    let image = json!({ "name": "image", "kind": "image", "source": { "file": "photo.png" }, "operator": bent,
                        "anchors": anchors });
    let gradient = json!({ "name": "ramp", "kind": "gradient", "from": [20, 30], "to": [240, 170], "operator": bent });
    let strokes = json!({ "name": "strokes", "kind": "strokes", "strokes": [stroke(40), stroke(90), stroke(140)] });
    let mirror = json!({ "name": "mirror", "kind": "shading", "model": "mirror", "reference": 1,
                         "environment": { "file": "photo.png" } });
    let mut bounced = mirror.clone();
    (bounced["name"], bounced["bounces"]) = ("bounced".into(), 2.into());
    let scaling =
        json!({ "name": "scaling", "kind": "radiance-scaling", "gamma": 1.5, "reference": 1 });
    let curvature = json!({ "kind": "curvature", "from": 0.0, "to": 0.6 });
    // The last number: the most that may be left of one sample's error, a tenth more than was
    // measured. A fifth is the aim; curvature misses it, which is highest along creases. What a
    // mirror sees of itself has outlines of its own, one ray a pixel.
    let kinds = [
        ("fill", json!([fill("#d08040")]), 0.05),
        ("gradient", json!([gradient]), 0.08),
        ("image", json!([image]), 0.11),
        ("strokes", json!([fill("#304030"), strokes]), 0.13),
        ("Phong", json!([phong]), 0.09),
        ("mirror", json!([mirror]), 0.14),
        ("mirror with two bounces", json!([bounced]), 0.24),
        ("radiance scaling", json!([phong, scaling]), 0.22),
        ("Fresnel mask", json!([phong, masked(json!({ "kind": "fresnel" }))]), 0.12),
        ("curvature mask", json!([phong, masked(curvature)]), 0.51),
        ("depth mask", json!([phong, masked(json!({ "kind": "depth" }))]), 0.07),
    ];
    let surfaces = [surface(1), surface(TIMES)];
    let mut far = Vec::new();
    let mut judge = |name: String, layers: &[Layer], most: f64| {
        let [one, own] = errors(layers, &surfaces);
        eprintln!("{name}: one sample {one:.4}, two sides {own:.4}, ratio {:.3}", own / one);
        if own > most * one {
            far.push(format!("{name}: {own:.4} of {one:.4}"));
        }
    };
    for (name, list, most) in kinds {
        judge(name.into(), &layers(list, folder.path()), most);
    }
    for n in [2, 4, 8, 16] {
        let mut stack = layers(json!([phong]), folder.path());
        stack.extend((1..n).map(|i| {
            let color = Color { r: (i * 15) as u8, g: 250 - (i * 12) as u8, b: 120, a: 255 };
            Layer { opacity: 0.3, ..Layer::new("veil", Content::Fill(color)) }
        }));
        judge(format!("{n} layers"), &stack, 0.08);
    }
    assert!(far.is_empty(), "{far:#?}");
}
