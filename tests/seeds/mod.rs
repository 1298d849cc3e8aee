//! Small files of every format that is read, most of them made here, some by other programs
//! (`files/`).

use rilievo::files::{Files, recipe};
use rilievo::{Budget, Document, Error, Progress, Result};
use rilievo_engine::math::hash::mix;
use rilievo_io::fs::Disk;
use rilievo_io::recovery::RecoveryLog;
use rilievo_io::{project, psd};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A file's name and what it holds.
pub type Seed = (String, Vec<u8>);

pub fn all() -> Vec<Seed> {
    [bitmaps(), palettes(), exrs(), documents(), others()].concat()
}

struct InMemory(HashMap<&'static str, Vec<u8>>);

impl Files for InMemory {
    fn read(&self, name: &str, _: &Budget) -> Result<Vec<u8>> {
        self.0
            .get(name)
            .cloned()
            .ok_or_else(|| Error::unsupported_file(name, "there is no such file"))
    }

    fn path(&self, name: &str) -> PathBuf {
        name.into()
    }
}

fn pixel(x: u32, y: u32) -> [u8; 4] {
    [mix(x * 31 + y) as u8, 90, (x * 9) as u8, 255 - y as u8]
}

/// A hemisphere as an OpenGL normal map.
fn dome(x: u32, y: u32) -> [u8; 4] {
    let [nx, ny] = [x as f32 / 7.5 - 1.0, 1.0 - y as f32 / 7.5];
    let square = nx * nx + ny * ny;
    let byte = |v: f32| ((v + 1.0) * 127.5).round() as u8;
    if square >= 1.0 { [0; 4] } else { [byte(nx), byte(ny), byte((1.0 - square).sqrt()), 255] }
}

fn encoded(image: impl Into<image::DynamicImage>, format: image::ImageFormat) -> Vec<u8> {
    let mut out = Cursor::new(Vec::new());
    image.into().write_to(&mut out, format).unwrap();
    out.into_inner()
}

fn png(w: u32, h: u32, pixel: fn(u32, u32) -> [u8; 4]) -> Vec<u8> {
    encoded(
        image::RgbaImage::from_fn(w, h, |x, y| image::Rgba(pixel(x, y))),
        image::ImageFormat::Png,
    )
}

/// What the `image` crate writes: every depth and channel count of each format.
fn bitmaps() -> Vec<Seed> {
    use image::DynamicImage as Image;
    use image::ImageFormat::{Bmp, Hdr, Jpeg, Png, Tga, Tiff, WebP};
    let rgba =
        Image::ImageRgba8(image::RgbaImage::from_fn(19, 11, |x, y| image::Rgba(pixel(x, y))));
    let rgb = Image::ImageRgb8(rgba.to_rgb8());
    let rgba16 = [
        Image::ImageLuma16(rgba.to_luma16()),
        Image::ImageLumaA16(rgba.to_luma_alpha16()),
        Image::ImageRgb16(rgba.to_rgb16()),
        Image::ImageRgba16(rgba.to_rgba16()),
    ];
    let gray = [Image::ImageLuma8(rgba.to_luma8()), Image::ImageLumaA8(rgba.to_luma_alpha8())];
    let float = Image::ImageRgb32F(rgba.to_rgb32f());
    let all = || [&rgba, &rgb, &gray[0], &gray[1], &rgba16[0], &rgba16[1], &rgba16[2], &rgba16[3]];
    let mut seeds: Vec<Seed> = Vec::new();
    for (i, image) in all().into_iter().enumerate() {
        seeds.push((format!("{i}.png"), encoded(image.clone(), Png)));
    }
    for (i, image) in
        [&rgb, &rgba, &gray[0], &rgba16[0], &rgba16[2], &float].into_iter().enumerate()
    {
        seeds.push((format!("{i}.tif"), encoded(image.clone(), Tiff)));
    }
    for (name, image, format) in [
        ("rgb.jpg", &rgb, Jpeg),
        ("gray.jpg", &gray[0], Jpeg),
        ("rgb.webp", &rgb, WebP),
        ("rgba.webp", &rgba, WebP),
        ("rgb.bmp", &rgb, Bmp),
        ("rgba.bmp", &rgba, Bmp),
        ("rgba.tga", &rgba, Tga),
        ("gray.tga", &gray[0], Tga),
        ("light.hdr", &float, Hdr),
    ] {
        seeds.push((name.into(), encoded(image.clone(), format)));
    }
    seeds.push(("maps/n.png".into(), png(16, 16, dome)));
    seeds
}

/// PNG with a palette, and with less than a byte a pixel.
fn palettes() -> Vec<Seed> {
    use png::{BitDepth, ColorType};
    let depths = [BitDepth::One, BitDepth::Two, BitDepth::Four, BitDepth::Eight];
    let one = |color: ColorType, depth: BitDepth| {
        let mut out = Vec::new();
        let mut encoder = png::Encoder::new(&mut out, 16, 4);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if color == ColorType::Indexed {
            encoder.set_palette((0..6).collect::<Vec<u8>>());
            encoder.set_trns(vec![255, 9]);
        }
        let bytes = vec![0b0101_0001 & (depth as u8 | 1); 2 * depth as usize * 4];
        encoder.write_header().unwrap().write_image_data(&bytes).unwrap();
        out
    };
    let indexed = depths.map(|d| (format!("palette-{}.png", d as u8), one(ColorType::Indexed, d)));
    let gray = [depths[0], depths[2]]
        .map(|d| (format!("gray-{}.png", d as u8), one(ColorType::Grayscale, d)));
    [indexed.to_vec(), gray.to_vec()].concat()
}

/// EXR of every compression that is read, plain and tiled.
fn exrs() -> Vec<Seed> {
    use exr::prelude::*;
    const SIDE: usize = 17;
    let all = [
        ("none", Compression::Uncompressed, false),
        ("rle", Compression::RLE, true),
        ("zip", Compression::ZIP16, false),
        ("zips", Compression::ZIP1, true),
        ("piz", Compression::PIZ, false),
        ("b44", Compression::B44, false),
        ("pxr24", Compression::PXR24, true),
        ("dwaa", Compression::DWAA(None), false),
    ];
    let one = |compression, tiled| {
        let plane = |f: fn(f32) -> f32| {
            FlatSamples::F32((0..SIDE * SIDE).map(|i| f(i as f32 / 300.0)).collect())
        };
        let half = |f: fn(f32) -> f32| {
            FlatSamples::F16((0..SIDE * SIDE).map(|i| f16::from_f32(f(i as f32 / 300.0))).collect())
        };
        let list = [
            AnyChannel::new("N.X", plane(|v| v * 0.4)),
            AnyChannel::new("N.Y", plane(|v| 0.3 - v * 0.5)),
            AnyChannel::new("N.Z", plane(|v| 1.0 - v * 0.2)),
            AnyChannel::new("Z", plane(|v| 2.0 + v.sin())),
            AnyChannel::new("R", half(|v| v)),
            AnyChannel::new("G", half(|v| v * v)),
            AnyChannel::new("B", half(|v| 1.0 - v)),
            AnyChannel::new("A", half(|_| 1.0)),
        ];
        let blocks = if tiled { Blocks::Tiles(Vec2(16, 16)) } else { Blocks::ScanLines };
        let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
        let channels = AnyChannels::sort(list.into_iter().collect());
        let layer = Layer::new((SIDE, SIDE), LayerAttributes::named("main"), encoding, channels);
        let mut out = Cursor::new(Vec::new());
        Image::from_layer(layer).write().to_buffered(&mut out).unwrap();
        out.into_inner()
    };
    let pictures =
        all.map(|(name, compression, tiled)| (format!("{name}.exr"), one(compression, tiled)));
    let maps = [("maps/zip.exr".to_owned(), one(Compression::ZIP16, false))];
    [pictures.to_vec(), maps.to_vec()].concat()
}

/// Recipes with every kind of layer, as themselves, as projects, as Photoshop files and as recovery
/// logs.
fn documents() -> Vec<Seed> {
    let paint = json!({ "canvas": { "width": 24, "height": 20 }, "layers": [
        { "name": "ground", "kind": "fill", "color": "#204060" },
        { "name": "paint", "kind": "pixels", "file": "p.png", "x": 3, "y": -2, "lock": "alpha" },
        { "name": "photo", "kind": "image", "source": { "file": "p.png" }, "blend": "multiply" },
        { "name": "clip", "kind": "gradient", "clip_below": true, "opacity": 0.5 },
        { "name": "g", "kind": "group", "layers": [
            { "name": "line", "kind": "strokes", "strokes": [
                { "brush": { "size": 5 }, "samples": [[2, 3], [15, 9]] } ] } ] } ] });
    let surface = json!({ "canvas": { "width": 16, "height": 16 }, "surface": { "normal": { "file": "n.png" } },
      "layers": [
        { "name": "lit", "kind": "shading", "model": "phong",
          "lights": [{ "kind": "directional", "direction": [0.3, 0.5, 0.8] }] },
        { "name": "photo", "kind": "image", "source": { "file": "p.png" }, "operator": { "kind": "normal" },
          "mask": { "kind": "fresnel" } },
        { "name": "relief", "kind": "radiance-scaling", "alpha": 0.3 } ] });
    let nested = json!({ "canvas": { "width": 21, "height": 17 }, "layers": [
        { "name": "out", "kind": "group", "pass_through": true, "layers": [
            { "name": "in", "kind": "group", "blend": "screen", "mask": { "file": "p.png" }, "layers": [
                { "name": "deep ü", "kind": "pixels", "file": "p.png", "blend": "color-burn" } ] } ] },
        { "name": "off", "kind": "fill", "visible": false, "blend": "exclusion", "lock": "all" } ] });
    let files = InMemory([("p.png", png(21, 17, pixel)), ("n.png", png(16, 16, dome))].into());
    let mut seeds = Vec::new();
    for (name, json) in [("paint", paint), ("surface", surface), ("nested", nested)] {
        let document = read(&json, &files);
        let (progress, file) = (Progress::default(), Path::new(name));
        seeds.push((format!("{name}.json"), json.to_string().into_bytes()));
        seeds.push((
            format!("{name}.ora"),
            project::write(file, &document, &progress).unwrap().unwrap(),
        ));
        seeds.push((
            format!("{name}.psd"),
            psd::write(file, &document, &progress).unwrap().unwrap().bytes,
        ));
        seeds.push((format!("{name}.log"), log(&document)));
    }
    seeds
}

fn read(json: &Value, files: &InMemory) -> Document {
    let budget = Budget::default();
    let source =
        recipe::RecipeSource { file: Path::new("r.json"), files, budget: &budget, onto: None };
    recipe::read(json.to_string().as_bytes(), source).unwrap_or_else(|e| panic!("{e}"))
}

fn log(document: &Document) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let recovery =
        RecoveryLog::start(Arc::new(Disk), folder.path(), document, "seed", None).unwrap();
    recovery.flush();
    let logs = std::fs::read_dir(folder.path()).unwrap().flatten().map(|entry| entry.path());
    std::fs::read(
        logs.into_iter().find(|path| path.extension().is_some_and(|e| e == "log")).unwrap(),
    )
    .unwrap()
}

/// What other programs wrote.
fn others() -> Vec<Seed> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/seeds/files");
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(folder).unwrap().flatten().map(|entry| entry.path()).collect();
    paths.sort();
    paths
        .iter()
        .map(|path| {
            (path.file_name().unwrap().to_string_lossy().into(), std::fs::read(path).unwrap())
        })
        .collect()
}
