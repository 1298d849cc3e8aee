//! Documents for tests: every kind of layer, small.

use crate::document::{Content, Document, Layer, LayerMask, MaskKind, PixelLayer};
use crate::math::{Size, srgb::Color, vec2, vec3};
use crate::paint::stroke::{ActiveStrokes, Backdrop};
use crate::paint::{Brush, Sample, Scene, Stroke};
use crate::raster::{Plane, TileGrid};
use crate::recipe::{self, RecipeSource};
use crate::surface::{Maps, Operator, Surface};
use crate::{Budget, Files};
use crate::{Error, Result};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Files in memory.
#[derive(Default)]
pub struct MemoryFiles(pub BTreeMap<String, Vec<u8>>);

impl Files for MemoryFiles {
    fn read(&self, name: &str, _: &Budget) -> Result<Vec<u8>> {
        let missing = || Error::io(name, std::io::Error::from(std::io::ErrorKind::NotFound));
        self.0.get(name).cloned().ok_or_else(missing)
    }

    fn path(&self, name: &str) -> PathBuf {
        name.into()
    }
}

/// A PNG of a function of its pixels.
pub fn png(width: u32, height: u32, rgba: impl Fn(u32, u32) -> [u8; 4]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let picture = image::RgbaImage::from_fn(width, height, |x, y| image::Rgba(rgba(x, y)));
    picture.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// A dome: normals in blue-green-red, transparent around it.
fn dome(side: u32) -> Vec<u8> {
    png(side, side, |x, y| {
        let unit = |v: u32| (v as f32 + 0.5) / side as f32 * 2.0 - 1.0;
        let (nx, ny) = (unit(x) * 1.1, -unit(y) * 1.1);
        let square = nx * nx + ny * ny;
        if square > 1.0 {
            return [128, 128, 255, 0];
        }
        let byte = |v: f32| (v * 127.5 + 127.5).round() as u8;
        [byte(nx), byte(ny), byte((1.0 - square).sqrt()), 255]
    })
}

pub fn files(side: u32) -> MemoryFiles {
    let noise = |x: u32, y: u32| (crate::math::hash::mix(x * 7919 + y) >> 8) as u8;
    let files = [
        ("maps/n.png", dome(side)),
        ("m.png", png(side, side, |x, _| [(x * 255 / side) as u8, 0, 90, 255])),
        ("photo.png", png(20, 13, |x, y| [noise(x, y), x as u8 * 9, y as u8 * 17, 200 + x as u8])),
        ("paint.png", png(30, 25, |x, y| [noise(x, y), 40, 200, noise(y, x)])),
        (
            "tip.png",
            png(9, 9, |x, y| [if (x + y) % 3 == 0 { 255 } else { 30 }; 4].map(|v| v.max(1))),
        ),
        ("sky.png", png(16, 8, |x, y| [x as u8 * 15, y as u8 * 30, 220, 255])),
    ];
    MemoryFiles(files.map(|(name, bytes)| (name.to_owned(), bytes)).into())
}

pub fn read(json: &Value, files: &dyn Files) -> Document {
    let text = json.to_string();
    let budget = Budget::default();
    let source =
        RecipeSource { file: Path::new("sample.json"), files, budget: &budget, onto: None };
    recipe::read(text.as_bytes(), source).unwrap_or_else(|e| panic!("{e}"))
}

/// A level surface that is covered by 0, a quarter, a half, three quarters and the whole, column
/// after column.
pub fn soft_surface(size: Size) -> Arc<Surface> {
    let coverage = Plane::from_fn(size, |x, _| [0, 64, 128, 191, 255][x % 5]);
    let normals = Plane::full(size, vec3(0.6, 0.0, 0.8));
    Arc::new(
        Surface::new(Maps { normals, depth: Plane::full(size, 0.5), coverage })
            .unwrap_or_else(|e| panic!("{e}")),
    )
}

/// Every kind of layer, with masks, clipping, groups of both sorts, and blend modes.
pub fn everything_json(side: u32) -> Value {
    json!({
        "canvas": { "width": side, "height": side },
        "surface": { "normal": { "file": "maps/n.png" } },
        "layers": [
            { "name": "ground", "kind": "fill", "color": "#304050", "clip_to_surface": false },
            { "name": "paint \"&<é>", "kind": "pixels", "file": "paint.png", "x": -5, "y": 7, "opacity": 0.75,
              "lock": "alpha" },
            { "name": "photo", "kind": "image", "source": { "file": "photo.png", "blur": 1.5 }, "blend": "multiply",
              "operator": { "kind": "normal", "alpha": 0.4 }, "mask": { "file": "m.png" } },
            { "name": "ramp", "kind": "gradient", "blend": "screen", "stops": [[0, "#ff000080"], [1, "#00ff00"]],
              "operator": { "kind": "normal" } },
            { "name": "above ramp", "kind": "gradient", "clip_below": true, "blend": "overlay", "opacity": 0.5 },
            { "name": "lines", "kind": "strokes", "mask": { "kind": "fresnel", "invert": true }, "strokes": [
                { "brush": { "preset": "soft-round", "size": 12 }, "color": "#ffcc00",
                  "samples": [[4, 9, 0.5], [30, 33, 1], [50, 12, 0.25, 5, -4, 1.5]] },
                { "brush": { "size": 9, "tip": { "file": "tip.png" } }, "samples": [[20, 40], [44, 41]] } ] },
            { "name": "group", "kind": "group", "opacity": 0.5, "mask": { "kind": "depth" }, "layers": [
                { "name": "lit", "kind": "shading", "model": "phong",
                  "lights": [{ "kind": "directional", "direction": [0.3, 0.5, 0.8] }] },
                { "name": "through", "kind": "group", "pass_through": true, "layers": [
                    { "name": "dots", "kind": "pixels", "file": "paint.png", "x": 20, "y": 20,
                      "blend": "exclusion" } ] } ] },
            { "name": "relief", "kind": "radiance-scaling", "alpha": 0.3, "opacity": 0.6 },
            { "name": "hidden", "kind": "fill", "visible": false, "color": "#ffffff40", "blend": "plus",
              "lock": "all" },
            { "name": "last", "kind": "pixels", "file": "paint.png", "x": 10, "y": 3, "blend": "hard-light",
              "clip_to_surface": false } ]
    })
}

pub fn everything(side: u32) -> Document {
    read(&everything_json(side), &files(side))
}

/// Paint that was airbrushed by 60 strokes over paper, once more under a mask, too faint for bytes,
/// and an inked line.
pub fn smoothly_painted() -> Document {
    let size = Size::new(150, 100);
    let scene = Scene { size, surface: None };
    let painted = |brush: Brush, strokes: u32| {
        let mut tiles = TileGrid::default();
        for i in 0..strokes {
            let at = [vec2(20.0 + i as f32, -20.0), vec2(30.0, 120.0)].map(Sample::at).to_vec();
            let stroke = Stroke::new(
                brush.clone(),
                Operator::None,
                Color { r: 90, g: 30, b: 4, a: 255 },
                Vec::new(),
            );
            let mut active = ActiveStrokes::new(&[stroke], Backdrop::Pixels(tiles.clone()), &scene);
            active.draw(&[at]).into_iter().for_each(|(at, tile)| tiles.set(at, tile));
        }
        Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() })
    };
    let airy =
        |flow: f32| Brush { size: 90.0, hardness: 0.0, flow, spacing: 0.2, ..Brush::default() };
    let coverage = Arc::new(Plane::from_fn(size, |x, _| (x + 90) as u8));
    let mask = LayerMask::new(MaskKind::File { file: "m.png".into(), coverage });
    let layers = [
        Layer::new("paper", Content::Fill(Color::WHITE)),
        Layer::new("air", painted(airy(0.004), 60)),
        Layer { mask: Some(mask), ..Layer::new("masked air", painted(airy(0.02), 5)) },
        Layer::new("faint", painted(airy(0.0004), 1)),
        Layer::new("ink", painted(Brush { size: 5.0, hardness: 1.0, ..Brush::default() }, 3)),
    ];
    Document { layers: layers.into_iter().map(Arc::new).collect(), ..Document::empty(size) }
}

/// How many tiles of each paint layer hold 16 bits, bottom first.
pub fn tiles16(document: &Document) -> Vec<usize> {
    let of = |layer: &Arc<Layer>| match &layer.content {
        Content::Pixels(pixels) => {
            Some(pixels.tiles.iter().filter(|(_, tile)| tile.is_16_bit()).count())
        }
        _ => None,
    };
    document.walk().into_iter().filter_map(|(_, layer)| of(layer)).collect()
}

/// Panics unless two documents are the same in every parameter and every pixel.
pub fn assert_same(a: &Document, b: &Document) {
    use crate::document::{Content, MaskKind, Progress, flatten};
    assert_eq!(a.size, b.size);
    assert_eq!(parameters(a), parameters(b));
    for ((path, x), (_, y)) in a.walk().iter().zip(b.walk()) {
        if let (Content::Pixels(x), Content::Pixels(y)) = (&x.content, &y.content) {
            let rect = x.tiles.bounds().union(y.tiles.bounds());
            assert!(
                x.tiles.to_straight16(rect) == y.tiles.to_straight16(rect),
                "the pixels of {path}"
            );
        }
        let masks = (x.mask.as_ref().map(|m| &m.kind), y.mask.as_ref().map(|m| &m.kind));
        if let (
            Some(MaskKind::File { coverage: x, .. }),
            Some(MaskKind::File { coverage: y, .. }),
        ) = masks
        {
            assert!(x.values() == y.values(), "the mask of {path}");
        }
    }
    let rect = a.size.rect();
    let picture =
        |document| flatten(document, &Progress::default()).unwrap().to_straight_rgba(rect);
    assert!(picture(a) == picture(b), "the pictures differ");
}

/// The JSON without the files' names and the corners of their pictures, which saving chooses.
fn parameters(document: &Document) -> Value {
    fn strip(value: &mut Value) {
        match value {
            Value::Object(fields) => {
                if fields.get("kind").is_some_and(|kind| kind == "pixels") {
                    ["file", "x", "y"].iter().for_each(|name| drop(fields.shift_remove(*name)));
                }
                fields.shift_remove("file");
                fields.values_mut().for_each(strip);
            }
            Value::Array(items) => items.iter_mut().for_each(strip),
            _ => {}
        }
    }
    let mut value = recipe::write(document);
    strip(&mut value);
    value
}
