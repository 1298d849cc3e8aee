//! Damaged projects: nothing changes silently, and what is intact comes back.

use super::super::sample::{everything_json, files, png, read as read_recipe};
use super::*;
use crate::recipe;
use serde_json::json;

/// Every kind of layer on a canvas of a few pixels, so that every bit can be flipped.
fn tiny() -> Document {
    let mut json = everything_json(12);
    let mut files = files(12);
    files.0.insert("photo.png".into(), png(4, 3, |x, y| [x as u8 * 60, y as u8 * 80, 90, 255]));
    files
        .0
        .insert("paint.png".into(), png(6, 5, |x, y| [200, x as u8 * 40, 10, 100 + y as u8 * 30]));
    files.0.insert("tip.png".into(), png(3, 3, |x, _| [x as u8 * 100 + 1; 4].map(|v| v.max(1))));
    json["layers"][1]["x"] = json!(1);
    json["layers"][1]["y"] = json!(2);
    read_recipe(&json, &files)
}

/// A document's parameters, and a checksum of its picture.
fn fingerprint(document: &Document) -> (String, u32) {
    let picture =
        flatten(document, &Progress::default()).unwrap().to_straight_rgba(document.size.rect());
    (recipe::write(document).to_string(), crc32fast::hash(&picture))
}

/// Reads damaged bytes: an error, a note, or the very same document; whether anything came back.
fn check(bytes: &[u8], whole: &(String, u32), what: &str) -> bool {
    match read(Path::new("a.ora"), bytes, &Budget::default()) {
        Err(_) => false,
        Ok(back) if back.is_whole && back.notes.is_empty() => {
            assert!(fingerprint(&back.document) == *whole, "{what}: changed without a word");
            true
        }
        Ok(_) => true,
    }
}

fn flip_bits(step: usize) {
    let bytes = write_bytes(&tiny());
    assert!(bytes.len() < 20_000, "{}", bytes.len());
    let whole = fingerprint(&read_back(&bytes).document);
    let (mut came_back, mut flips) = (0, 0);
    for bit in (0..bytes.len() * 8).step_by(step) {
        let mut broken = bytes.clone();
        broken[bit / 8] ^= 1 << (bit % 8);
        flips += 1;
        came_back += usize::from(check(&broken, &whole, &format!("bit {bit}")));
    }
    // Only a name that leads out of the file makes all of it unreadable.
    assert!(came_back * 1000 >= flips * 995, "{came_back} of {flips}");
}

fn truncate(step: usize) {
    let bytes = write_bytes(&tiny());
    let whole = fingerprint(&read_back(&bytes).document);
    for end in (0..bytes.len()).step_by(step) {
        let came_back = check(&bytes[..end], &whole, &format!("cut at {end}"));
        // From where the document itself is whole, something always comes back.
        assert!(came_back || end < 3000, "cut at {end}");
    }
}

#[test]
fn no_flipped_bit_changes_a_project_silently() {
    flip_bits(97);
}

#[test]
fn a_project_cut_short_anywhere_gives_what_is_there() {
    truncate(61);
}

/// *Long*: see docs/PROJECTS.md.
#[test]
#[ignore = "minutes; run by name"]
fn long_every_bit_and_every_length() {
    flip_bits(1);
    truncate(1);
}

#[test]
fn a_lost_table_of_contents_loses_nothing() {
    let bytes = write_bytes(&tiny());
    let table = bytes.windows(4).rposition(|w| w == b"PK\x03\x04").unwrap();
    let back = read_back(&bytes[..bytes.len() - 30]);
    assert!(!back.is_whole && table > 0);
    assert_eq!(fingerprint(&back.document), fingerprint(&read_back(&bytes).document));
}

mod generated {
    use super::*;
    use crate::raster::BlendMode;
    use proptest::prelude::*;
    use std::collections::HashSet;

    /// A layer of any kind with any of what every layer has.
    fn layer() -> impl Strategy<Value = serde_json::Value> {
        let kind = prop_oneof![
            Just(json!({ "kind": "fill", "color": "#80ff2040" })),
            (-40..40, -40..40).prop_map(|(x, y)| json!({ "kind": "pixels", "file": "paint.png", "x": x, "y": y })),
            (0.1..2.0f32).prop_map(|s| json!({ "kind": "image", "source": { "file": "photo.png" },
                "placement": { "scale": s } })),
            (0.0..30.0f32).prop_map(|x| json!({ "kind": "gradient", "from": [x, 3], "to": [31, 20],
                "operator": { "kind": "normal" } })),
            (1.0..9.0f32, 0.0..31.0f32).prop_map(|(size, x)| json!({ "kind": "strokes", "strokes": [
                { "brush": { "size": size }, "color": "#fedcba", "samples": [[x, 4], [12, x, 0.5]] } ] })),
            Just(json!({ "kind": "shading", "model": "phong",
                "lights": [{ "kind": "directional", "direction": [0, 0.5, 0.8] }] })),
            Just(json!({ "kind": "radiance-scaling" })),
        ];
        let mask = prop_oneof![
            3 => Just(None),
            1 => Just(Some(json!({ "file": "m.png" }))),
            1 => Just(Some(json!({ "kind": "depth", "invert": true }))),
        ];
        let blend = (0..BlendMode::ALL.len()).prop_map(|i| BlendMode::ALL[i].1);
        (kind, "\\PC{0,12}", any::<bool>(), 0..=100u8, blend, any::<[bool; 3]>(), mask).prop_map(
            |(mut layer, name, visible, percent, blend, [clip, linear, on_surface], mask)| {
                let fields = json!({ "name": name, "visible": visible, "opacity": f64::from(percent) / 100.0,
                    "blend": blend, "clip_below": clip, "clip_to_surface": on_surface,
                    "blend_space": if linear && percent % 4 == 0 { "linear" } else { "srgb" } });
                fields.as_object().unwrap().iter().for_each(|(name, value)| layer[name] = value.clone());
                if let Some(mask) = mask {
                    layer["mask"] = mask;
                }
                layer
            },
        )
    }

    fn layers() -> impl Strategy<Value = serde_json::Value> {
        let list = |item| prop::collection::vec(item, 0..4).prop_map(serde_json::Value::from);
        let group = (list(layer().boxed()), any::<bool>(), 0..=4u8).prop_map(|(layers, through, quarters)| {
            json!({ "kind": "group", "layers": layers, "pass_through": through, "opacity": f64::from(quarters) / 4.0 })
        });
        list(prop_oneof![3 => layer(), 1 => group].boxed())
    }

    fn document(layers: &serde_json::Value) -> Document {
        let json = json!({ "canvas": { "width": 32, "height": 32 },
            "surface": { "normal": { "file": "maps/n.png" } }, "layers": layers });
        read_recipe(&json, &files(32))
    }
    proptest! {
        #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn any_document_comes_back_and_its_second_file_is_the_first(layers in layers()) {
            let document = document(&layers);
            let first = write_bytes(&document);
            let back = read_back(&first);
            prop_assert!(back.is_whole && back.notes.is_empty(), "{:?}", back.notes);
            assert_same(&document, &back.document);
            prop_assert!(write_bytes(&back.document) == first);
        }

        #[test]
        fn any_document_looks_the_same_to_other_programs(layers in layers()) {
            let document = document(&layers);
            let bytes = change_entries(&write_bytes(&document), |name, bytes| {
                (!name.starts_with("rilievo/")).then_some(bytes)
            });
            let seen = read_back(&bytes).document;
            let picture = |d: &Document| flatten(d, &Progress::default()).unwrap();
            let (ours, theirs) = (picture(&document), picture(&seen));
            // A contour pixel's two sides are mixed in the whole picture, not layer by layer.
            let surface = document.surface.as_deref();
            let contours = surface.into_iter().flat_map(|surface| surface.contours().pixels());
            let mixed: HashSet<_> = contours.map(|pixel| (pixel.x, pixel.y)).collect();
            let shown = |[r, g, b, a]: [u8; 4]| [r, g, b, 255].map(|v| f32::from(v) * f32::from(a) / 255.0);
            for (x, y) in (0..32).flat_map(|y| (0..32).map(move |x| (x, y))).filter(|at| !mixed.contains(at)) {
                let (a, b) = (ours.pixel(x, y), theirs.pixel(x, y));
                let off = shown(a).into_iter().zip(shown(b)).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
                // Each layer's picture is rounded to bytes once more; saturations of near-grays
                // make most of that, 4.4 in the worst of 30,000 documents.
                prop_assert!(off <= 6.0, "at {x}, {y}: {a:?} is {b:?} elsewhere");
            }
        }
    }
}
