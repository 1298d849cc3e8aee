//! Documents in other color profiles: what stays, what changes, what is saved and read.

use super::*;
use crate::document::{Content, PixelLayer, Progress, flatten};
use crate::export::{ExportOptions, high_depth::encode_document};
use crate::icc_profiles::{icc_of, is_display_p3};
use crate::math::Rect;
use crate::project::sample::{self, MemoryFiles, assert_same, everything, png, read};
use crate::raster::picture::Texels;
use crate::{open, pixels as stored, psd, recipe};
use serde_json::{Value, json};
use std::collections::BTreeSet;

const P3: ColorProfile = ColorProfile::DisplayP3;

fn to_p3(document: &Document) -> Document {
    let made = convert(document, P3, &Budget::default());
    assert!(!made.is_clamped, "Display P3 has every color of sRGB");
    made.document
}

fn pixels(document: &Document) -> TileGrid {
    flatten(document, &Progress::default()).unwrap()
}

/// Every color that a document can hold has a number of its own here.
fn colorful() -> Value {
    json!({
        "format": "rilievo", "version": 2,
        "canvas": { "width": 64, "height": 64 },
        "surface": { "normal": { "file": "maps/n.png" } },
        "palette": { "name": "p", "colors": ["#102a43", { "color": "#e8c39e", "name": "sand" }] },
        "layers": [
            { "name": "fill", "kind": "fill", "color": "#c83c32", "effects": [
                { "kind": "color-overlay", "color": "#28a05a" },
                { "kind": "bevel", "color": "#f0e1d2", "shade_color": "#3c2814" },
                { "kind": "gradient-overlay", "stops": [[0, "#5a1e96"], [1, "#96d23c"]] } ] },
            { "name": "ramp", "kind": "gradient", "stops": [[0, "#c83c32"], [1, "#28a05a80"]] },
            { "name": "words", "kind": "image", "source": { "text": { "string": "I", "size": 60, "font": "Hack",
                "color": "#3c50c8", "outline": 2, "outline_color": "#e6be3c" } } },
            { "name": "path", "kind": "image", "source": { "path": { "figure": { "kind": "rectangle", "from": [4, 4],
                "to": [60, 60] }, "fill": "#aa4678", "outline": 8, "outline_color": "#46aa78" } } },
            { "name": "strokes", "kind": "strokes", "strokes": [
                { "brush": { "preset": "hard-round", "size": 30 }, "color": "#ffcc00",
                  "samples": [[9, 9], [50, 50]] } ] },
            { "name": "ink", "kind": "lines", "color": "#25151a" },
            { "name": "hatch", "kind": "hatching", "color": "#1a1530" },
            { "name": "light", "kind": "shading", "model": "painter",
              "lights": [{ "kind": "directional", "direction": [0, 0, 1], "color": "#ffe0c0" }],
              "ambient": { "color": "#203040" }, "diffuse": { "color": "#d05030" }, "specular": { "color": "#fff0a0" },
              "shadows": { "color": "#301050" },
              "painter": { "fill_color": "#a0b0ff", "bounce_color": "#ffa890", "rim_color": "#c0e0ff" },
              "pixel": { "bands": 3, "colors": ["#804020", "#208040"] } },
            { "name": "map", "kind": "adjustment",
              "adjust": { "kind": "gradient-map", "stops": [[0, "#14285a"], [1, "#f0c8a0"]] } },
            { "name": "glass", "kind": "adjustment", "adjust": { "kind": "photo-filter", "color": "#3c8cdc" } },
            { "name": "tint", "kind": "adjustment",
              "adjust": { "kind": "black-white", "tint": true, "color": "#c8a078" } },
            { "name": "dots", "kind": "filter",
              "filter": { "kind": "halftone", "ink": "#5a285a", "paper": "#e6dc78" } },
            { "name": "group", "kind": "group", "layers": [{ "name": "in it", "kind": "fill", "color": "#6496c8" }] } ]
    })
}

/// Replaces every color of a document's JSON; lists the keys that hold them.
fn recolor(value: &mut Value, key: &str, keys: &mut BTreeSet<String>, by: &dyn Fn(Color) -> Color) {
    match value {
        Value::String(text) => {
            if let Some(color) = Color::parse(text) {
                keys.insert(key.to_owned());
                *text = by(color).to_string();
            }
        }
        Value::Array(items) => items.iter_mut().for_each(|item| recolor(item, key, keys, by)),
        Value::Object(fields) => {
            // The pictures of words are made of them.
            fields.shift_remove("file");
            fields.iter_mut().for_each(|(key, value)| recolor(value, key, keys, by));
        }
        _ => {}
    }
}

#[test]
fn every_color_that_a_document_writes_is_converted() {
    let document = read(&colorful(), &sample::files(64));
    let by = ColorProfile::Srgb.conversion_to(P3).unwrap();
    let (mut keys, mut none) = (BTreeSet::new(), BTreeSet::new());
    let mut expected = recipe::write(&document);
    recolor(&mut expected, "", &mut keys, &|color| by.color(color));
    expected["profile"] = "display-p3".into();
    let mut found = recipe::write(&to_p3(&document));
    // Without the names of files, and the colors as they are.
    recolor(&mut found, "", &mut none, &|color| color);
    let (expected, found) = (lines_of(&expected), lines_of(&found));
    assert_eq!(found, expected);
    let known = [
        "bounce_color",
        "color",
        "colors",
        "fill",
        "fill_color",
        "ink",
        "outline_color",
        "paper",
        "rim_color",
        "shade_color",
        "stops",
    ];
    assert_eq!(keys.iter().map(String::as_str).collect::<Vec<_>>(), known);
}

/// The lines of a JSON, whatever the order of its fields.
fn lines_of(value: &Value) -> Vec<String> {
    fn list(value: &Value, path: &str, out: &mut Vec<String>) {
        match value {
            Value::Object(fields) => {
                fields.iter().for_each(|(key, value)| list(value, &format!("{path}.{key}"), out))
            }
            Value::Array(items) => {
                let all = items.iter().enumerate();
                all.for_each(|(i, value)| list(value, &format!("{path}[{i}]"), out));
            }
            value => out.push(format!("{path} {value}")),
        }
    }
    let mut out = Vec::new();
    list(value, "", &mut out);
    out.sort();
    out
}

/// How far the flat opaque pixels of a document differ once it is converted and shown in sRGB, and
/// how many there are.
fn difference(document: &Document) -> (u8, usize) {
    let size = document.size;
    let before = pixels(document).to_straight_rgba(size.rect());
    let converted = to_p3(document);
    let mut after = pixels(&converted).to_straight_rgba(size.rect());
    assert_ne!(before, after, "its numbers are others");
    show_in_srgb(&mut after, converted.profile);
    let (before, after) = (before.as_chunks::<4>().0, after.as_chunks::<4>().0);
    let (w, h) = (size.width as usize, size.height as usize);
    let (mut most, mut count) = (0, 0);
    for y in 1..h - 1 {
        for x in 1..w - 1 {
            let i = y * w + x;
            let around = [i - w, i + w, i - 1, i + 1, i - w - 1, i + w + 1];
            if before[i][3] == 255 && around.iter().all(|&j| before[j] == before[i]) {
                let off = (0..4).map(|c| before[i][c].abs_diff(after[i][c])).max();
                (most, count) = (most.max(off.unwrap_or(0)), count + 1);
            }
        }
    }
    (most, count)
}

#[test]
fn each_kind_of_layer_looks_the_same_once_it_is_converted() {
    let flat = |color: [u8; 3]| png(8, 8, move |_, _| [color[0], color[1], color[2], 255]);
    let (green, orange) = (flat([40, 160, 90]), flat([230, 140, 60]));
    let mut files = sample::files(64);
    files.0.insert("green.png".into(), green);
    files.0.insert("orange.png".into(), orange);
    files.0.insert("level.png".into(), png(64, 64, |_, _| [128, 128, 255, 255]));
    let gray = json!({ "name": "ground", "kind": "fill", "color": "#808080" });
    let ramp = |color: &str| json!([[0, color], [1, color]]);
    let pattern = json!({ "name": "p", "width": 1, "height": 1, "pixels": "KKBa/w" });
    let line = json!([[0, 32], [64, 32]]);
    let kinds = [
        ("fill", json!({ "kind": "fill", "color": "#c83c32" })),
        ("paint", json!({ "kind": "pixels", "file": "green.png" })),
        ("image", json!({ "kind": "image", "source": { "file": "orange.png" } })),
        ("gradient", json!({ "kind": "gradient", "stops": ramp("#3c50c8") })),
        (
            "text",
            json!({ "kind": "image", "source": { "text": { "string": "I", "size": 90, "font": "Hack",
            "weight": 700, "color": "#aa4678" } } }),
        ),
        (
            "path",
            json!({ "kind": "image", "source": { "path": { "figure": { "kind": "rectangle", "from": [8, 8],
            "to": [56, 56] }, "fill": "#aa4678", "outline": 12, "outline_color": "#46aa78" } } }),
        ),
        (
            "strokes",
            json!({ "kind": "strokes", "strokes": [{ "color": "#e6be3c", "samples": line,
            "brush": { "preset": "hard-round", "size": 30 } }] }),
        ),
        (
            "colored tip",
            json!({ "kind": "strokes", "strokes": [{ "samples": line,
            "brush": { "size": 40, "flow": 1, "opacity": 1, "tip": { "file": "green.png" } } }] }),
        ),
        (
            "ambient light",
            json!({ "kind": "shading", "model": "phong", "lights": [],
            "ambient": { "color": "#c8783c", "weight": 1 }, "diffuse": { "weight": 0 },
            "specular": { "weight": 0 } }),
        ),
        (
            "lamp",
            json!({ "kind": "shading", "model": "phong", "ambient": { "weight": 0 },
            "diffuse": { "color": "#ffffff", "weight": 1 }, "specular": { "weight": 0 },
            "lights": [{ "kind": "directional", "direction": [0, 0, 1], "color": "#c8783c" }] }),
        ),
        (
            "lit sphere",
            json!({ "kind": "shading", "model": "lit-sphere", "sphere": { "file": "green.png" } }),
        ),
        (
            "mirror",
            json!({ "kind": "shading", "model": "mirror", "environment": { "file": "orange.png" } }),
        ),
        (
            "effects",
            json!({ "kind": "fill", "color": "#202020", "effects": [
            { "kind": "color-overlay", "color": "#28a05a" } ] }),
        ),
        (
            "ramp of effects",
            json!({ "kind": "fill", "color": "#202020", "effects": [
            { "kind": "gradient-overlay", "stops": ramp("#28a05a") } ] }),
        ),
        (
            "pattern",
            json!({ "kind": "fill", "color": "#202020", "effects": [
            { "kind": "pattern-overlay", "pattern": pattern } ] }),
        ),
        (
            "gradient map",
            json!({ "kind": "adjustment",
            "adjust": { "kind": "gradient-map", "stops": ramp("#c83c32") } }),
        ),
        (
            "halftone",
            json!({ "kind": "filter",
            "filter": { "kind": "halftone", "size": 40, "ink": "#5a285a", "paper": "#e6dc78" } }),
        ),
        ("group", json!({ "kind": "group", "layers": [{ "kind": "fill", "color": "#6496c8" }] })),
    ];
    for (name, mut layer) in kinds {
        layer["name"] = name.into();
        let whole = json!({
            "format": "rilievo", "version": 2, "canvas": { "width": 64, "height": 64 },
            "surface": { "normal": { "file": "level.png" } },
            "layers": [gray, layer]
        });
        let (most, count) = difference(&read(&whole, &files));
        assert!(most <= 2 && count > 20, "{name}: {most}/255 off in {count} pixels");
    }
}

#[test]
fn assigning_keeps_every_number_and_converting_back_every_color() {
    let document = everything(64);
    let assigned = assign(&document, P3);
    assert_eq!(assigned.profile, P3);
    assert!(
        document.difference(&Document { profile: document.profile, ..assigned.clone() }).is_none()
    );
    let rect = document.size.rect();
    assert!(pixels(&document).to_straight_rgba(rect) == pixels(&assigned).to_straight_rgba(rect));
    assert_eq!(document.difference(&assigned).as_deref(), Some("the color profile"));
    // Saturated numbers of Display P3 are beyond sRGB.
    assert!(convert(&assigned, ColorProfile::Srgb, &Budget::default()).is_clamped);
    let there = to_p3(&document);
    let back = convert(&there, ColorProfile::Srgb, &Budget::default());
    let paint = |document: &Document| match &document.layers[1].content {
        Content::Pixels(pixels) => pixels.tiles.to_straight_rgba(Rect::new(0, 0, 30, 30)),
        _ => panic!("no paint"),
    };
    let (a, b) = (paint(&document), paint(&back.document));
    let opaque = a.as_chunks::<4>().0.iter().zip(b.as_chunks::<4>().0).filter(|(a, _)| a[3] > 250);
    let off = opaque.map(|(a, b)| (0..3).map(|c| a[c].abs_diff(b[c])).max().unwrap_or(0)).max();
    assert!(off <= Some(3), "{off:?}");
}

#[test]
fn a_project_keeps_the_profile_and_names_it_in_its_pictures() {
    for document in [to_p3(&everything(64)), assign(&everything(64), P3)] {
        let (file, budget) = (Path::new("a.ora"), Budget::default());
        let bytes = crate::project::write(file, &document, &Progress::default()).unwrap().unwrap();
        crate::project::read_back(file, &bytes, &document, &budget).unwrap();
        let contents = crate::project::read(file, &bytes, &budget).unwrap();
        assert!(contents.notes.is_empty(), "{:?}", contents.notes);
        assert_eq!(contents.document.profile, P3);
        assert_same(&document, &contents.document);
        let again = crate::project::write(file, &contents.document, &Progress::default());
        assert!(again.unwrap().unwrap() == bytes, "the same bytes");
        let archive = crate::project::Archive::open(file, &bytes, &budget).unwrap();
        let profile = |name: &str| {
            let png = archive.bytes(name, budget.file_bytes).unwrap();
            picture::profile_of(Path::new(name), &png, &budget)
        };
        assert_eq!((profile("mergedimage.png"), profile("data/001.png")), (P3, P3));
        assert_eq!(profile("Thumbnails/thumbnail.png"), ColorProfile::Srgb);
    }
}

#[test]
fn a_photoshop_file_keeps_the_profile_with_our_layers_and_without() {
    let document = assign(&everything(64), P3);
    let (file, budget) = (Path::new("a.psd"), Budget::default());
    let written = psd::write(file, &document, &Progress::default()).unwrap().unwrap();
    let contents = psd::read(file, &written.bytes, &budget).unwrap();
    assert_eq!(contents.document.profile, P3);
    assert_same(&document, &contents.document);
    // Any program's.
    let ours = [&b"8BIM"[..], &4711u16.to_be_bytes()].concat();
    let at = written.bytes.windows(6).position(|w| w == ours).unwrap();
    let mut other = written.bytes.clone();
    other[at + 4..at + 6].copy_from_slice(&[0x20, 0x20]);
    let contents = psd::read(file, &other, &budget).unwrap();
    assert_eq!(contents.document.profile, P3);
    let (a, b) = (pixels(&document).pixel(5, 60), pixels(&contents.document).pixel(5, 60));
    assert!((0..4).all(|c| a[c].abs_diff(b[c]) <= 1), "{a:?} {b:?}");
}

#[test]
fn recipes_name_the_profile_and_an_unknown_one_is_refused() {
    let document = to_p3(&everything(64));
    let written = recipe::write(&document);
    assert_eq!(
        (written["profile"].as_str(), written["version"].as_i64()),
        (Some("display-p3"), Some(2))
    );
    assert!(recipe::write(&everything(64)).get("profile").is_none());
    let text = json!({ "canvas": { "width": 4, "height": 4 }, "profile": "adobe-rgb" }).to_string();
    let (files, budget) = (MemoryFiles::default(), Budget::default());
    let source = recipe::RecipeSource {
        file: Path::new("a.json"),
        files: &files,
        budget: &budget,
        onto: None,
    };
    let refused = recipe::read(text.as_bytes(), source).err().unwrap().to_string();
    assert_eq!(refused, "a.json: profile: is “adobe-rgb”; it must be one of srgb, display-p3");
}

/// Patches of strong colors, in Display P3.
fn patches() -> Document {
    let colors =
        [[255, 0, 0], [0, 255, 0], [40, 90, 250], [234, 51, 35], [128, 128, 128], [250, 200, 30]];
    let rgba: Vec<u8> = (0..48 * 8)
        .flat_map(|i| {
            let [r, g, b] = colors[i % 48 / 8];
            [r, g, b, 255]
        })
        .collect();
    let tiles = TileGrid::from_straight_rgba(&rgba, 48, 8, 0, 0);
    let content = Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() });
    let layers = vec![Arc::new(Layer::new("patches", content))];
    Document { layers, profile: P3, ..Document::empty(Size::new(48, 8)) }
}

#[test]
fn exported_files_name_the_profile_or_are_converted_and_open_as_they_were() {
    let folder = tempfile::tempdir().unwrap();
    let document = patches();
    let rect = document.size.rect();
    let own_bytes = pixels(&document).to_straight_rgba(rect);
    let mut shown = own_bytes.clone();
    show_in_srgb(&mut shown, P3);
    for (name, bits, near) in [
        ("a.png", 8, 0),
        ("b.png", 16, 1),
        ("a.tif", 8, 0),
        ("b.tif", 16, 1),
        ("a.webp", 8, 0),
        ("a.jpg", 8, 6),
        ("a.exr", 16, 1),
        ("b.exr", 32, 0),
    ] {
        for (profile, expected) in [(None, &own_bytes), (Some(ColorProfile::Srgb), &shown)] {
            let file = folder.path().join(name);
            let options = ExportOptions {
                bits: Some(bits),
                profile,
                quality: 100,
                ..ExportOptions::default()
            };
            let budget = Budget::default();
            let bytes = encode_document(&file, &document, &options, &budget, &Progress::default());
            std::fs::write(&file, bytes.unwrap().unwrap()).unwrap();
            let opened = open(&file, &budget).unwrap().document;
            assert_eq!(opened.profile, profile.unwrap_or(P3), "{name}");
            let found = pixels(&opened).to_straight_rgba(rect);
            let middle = |i: usize| i / 4 % 8 == 4;
            let off = found.iter().zip(expected.iter()).enumerate();
            let off = off.filter(|(i, _)| middle(*i)).map(|(_, (a, b))| a.abs_diff(*b)).max();
            assert!(off <= Some(near), "{name} as {profile:?}: {off:?}");
        }
    }
}

#[test]
fn code_points_of_a_png_outrank_its_profile() {
    let with = |points: [u8; 4], icc: Option<&[u8]>| {
        let mut bytes = Vec::new();
        let mut info = png::Info::with_size(1, 1);
        (info.color_type, info.bit_depth) = (png::ColorType::Rgb, png::BitDepth::Eight);
        info.icc_profile = icc.map(Into::into);
        let mut writer = png::Encoder::with_info(&mut bytes, info).unwrap().write_header().unwrap();
        writer.write_chunk(png::chunk::ChunkType(*b"cICP"), &points).unwrap();
        writer.write_image_data(&[234, 51, 35]).unwrap();
        writer.finish().unwrap();
        bytes
    };
    let read = |bytes: &[u8], profile| {
        let budget = Budget { profile, ..Budget::default() };
        let file = Path::new("a.png");
        let painted = picture::decode_paint(file, bytes, 0, 0, &budget).unwrap();
        let picture = picture::decode(file, bytes, &budget).unwrap();
        let Texels::Srgb8(texels) = picture.texels else { panic!("bytes") };
        assert_eq!(painted.tiles.pixel(0, 0), texels[0]);
        (picture::profile_of(file, bytes, &budget), texels[0])
    };
    let p3 = with([12, 13, 0, 1], None);
    assert_eq!(read(&p3, P3), (P3, [234, 51, 35, 255]));
    let (_, [r, g, b, _]) = read(&p3, ColorProfile::Srgb);
    assert!(r >= 254 && g <= 1 && b <= 1, "{:?}", [r, g, b]);
    let srgb = with([1, 13, 0, 1], Some(icc_of(P3)));
    assert_eq!(read(&srgb, ColorProfile::Srgb), (ColorProfile::Srgb, [234, 51, 35, 255]));
}

#[test]
fn a_placed_picture_gets_the_colors_of_the_document_and_is_as_wide_as_its_file() {
    let budget = Budget::default();
    let read = |bytes: &[u8]| picture::decode(Path::new("a.png"), bytes, &budget).unwrap();
    let first = |picture: &Picture| match &picture.texels {
        Texels::Srgb8(texels) => texels[0],
        Texels::Linear(_) => panic!("bytes"),
    };
    let srgb = read(&png(2, 2, |_, _| [255, 0, 0, 255]));
    let placed = convert_picture(&srgb, ColorProfile::Srgb, P3, &budget);
    assert_eq!((first(&placed), placed.encoded.is_some()), ([234, 51, 35, 255], false));
    let wide =
        stored::encode_texels_in(Path::new("a.png"), &[[255, 0, 0, 255]], Size::new(1, 1), P3);
    let wide = read(wide.unwrap().bytes());
    assert_eq!((first(&wide), own_profile(&wide)), ([255, 0, 0, 255], P3), "clamped in sRGB");
    let placed = convert_picture(&wide, ColorProfile::Srgb, P3, &budget);
    assert_eq!((first(&placed), placed.encoded.is_some()), ([255, 0, 0, 255], true));
    // Assigned, its numbers stay, so its file cannot be kept.
    assert!(SameNumbers.picture(&wide).encoded.is_none());
    assert!(is_display_p3(icc_of(P3)));
}

#[test]
fn a_drawing_stays_a_drawing() {
    let svg = br##"<svg xmlns="http://www.w3.org/2000/svg" width="8" height="8">
        <linearGradient id="abcdef">
        <stop offset="0" stop-color="red"/><stop offset="1" stop-color="#f00"/></linearGradient>
        <rect width="4" height="8" fill="red"/><rect x="4" width="4" height="8" fill="url(#abcdef)"/></svg>"##;
    let budget = Budget::default();
    let drawn = picture::decode(Path::new("a.svg"), svg, &budget).unwrap();
    let placed = convert_picture(&drawn, ColorProfile::Srgb, P3, &budget);
    let larger = placed.enlarged(2).expect("a drawing");
    for picture in [&placed, &larger] {
        let Texels::Srgb8(texels) = &picture.texels else { panic!("bytes") };
        assert!(texels.iter().all(|texel| *texel == [234, 51, 35, 255]), "{:?}", texels[0]);
    }
    let again = picture::decode(Path::new("a.svg"), placed.encoded.unwrap().bytes(), &budget);
    assert_eq!(again.unwrap().texels, placed.texels);
}

#[test]
fn layers_of_another_document_are_converted() {
    let layer = Layer::new("red", Content::Fill(Color::rgb(255, 0, 0)));
    let there = convert_layers(vec![layer], ColorProfile::Srgb, P3, &Budget::default());
    assert!(matches!(there[0].content, Content::Fill(Color { r: 234, g: 51, b: 35, .. })));
}
