mod adjusted;
mod blending;
mod foreign;
mod lines;
mod made;
mod marks;
mod shapes;
mod sixteen_bit;

use super::*;
use crate::Budget;
use crate::document::{
    Content, Document, Group, Guides, Layer, MaskKind, NamedSelection, PixelLayer, Progress,
    flatten,
};
use crate::math::{Rect, Size};
use crate::paint::{ColorAdjustment, Selection};
use crate::project::ProjectContents;
use crate::project::sample::{
    assert_same, everything, files, png, read as read_recipe, smoothly_painted, tiles16,
};
use crate::raster::{BlendMode, CoverageGrid, TileGrid};
use serde_json::json;
use std::collections::HashSet;
use std::path::Path;
use std::sync::Arc;

fn write_bytes(document: &Document) -> Vec<u8> {
    write(Path::new("a.psd"), document, &Progress::default()).unwrap().unwrap().bytes
}

fn read_back(bytes: &[u8]) -> ProjectContents {
    read(Path::new("a.psd"), bytes, &Budget::default()).unwrap_or_else(|e| panic!("{e}"))
}

/// No selections, no guides, and the light of effects as it begins.
fn no_marks() -> write::FileMarks<'static> {
    static GUIDES: Guides = Guides { vertical: Vec::new(), horizontal: Vec::new() };
    write::FileMarks {
        selections: &[],
        guides: &GUIDES,
        light: Default::default(),
        profile: Default::default(),
    }
}

/// The file with our own resource under a number that nobody knows, as a program leaves it that
/// does.
fn without_ours(bytes: &[u8]) -> Vec<u8> {
    let mark = [&b"8BIM"[..], &OURS.to_be_bytes()].concat();
    let at = bytes.windows(6).position(|w| w == mark).unwrap();
    let mut other = bytes.to_vec();
    other[at + 4..at + 6].copy_from_slice(&4999u16.to_be_bytes());
    other
}

fn worst(a: &Document, b: &Document) -> u8 {
    worst_of(a, b, &|_| true)
}

fn worst_of(a: &Document, b: &Document, is_counted: &dyn Fn((i32, i32)) -> bool) -> u8 {
    let picture = |d: &Document| flatten(d, &Progress::default()).unwrap();
    let (x, y) = (picture(a), picture(b));
    let pixels = (0..a.size.height as i32)
        .flat_map(|row| (0..a.size.width as i32).map(move |col| (col, row)));
    pixels
        .filter(|&at| is_counted(at))
        .flat_map(|(col, row)| (0..4).map(move |c| (col, row, c)))
        .map(|(col, row, c)| x.pixel(col, row)[c].abs_diff(y.pixel(col, row)[c]))
        .max()
        .unwrap_or(0)
}

#[test]
fn smooth_paint_comes_back_in_16_bits_and_other_programs_see_8_which_is_said() {
    let document = smoothly_painted();
    let made = write(Path::new("a.psd"), &document, &Progress::default()).unwrap().unwrap();
    let said = |name: &str| {
        made.notes.iter().any(|note| note.contains(name) && note.contains("8 for other programs"))
    };
    assert!(said("“air”") && !said("“ink”"), "{:?}", made.notes);
    let back = read_back(&made.bytes);
    assert!(back.notes.is_empty(), "{:?}", back.notes);
    assert_same(&document, &back.document);
    assert_eq!(tiles16(&back.document), tiles16(&document));
    assert_same(&document, &read_back(&write_bytes(&back.document)).document);
    let foreign = read_back(&without_ours(&made.bytes)).document;
    // Three layers are rounded, each by half a level at most, and the picture of them.
    assert!(worst(&document, &foreign) <= 2, "{}", worst(&document, &foreign));
}

#[test]
fn our_own_file_comes_back_live_in_every_parameter_and_pixel() {
    let document = everything(64);
    let back = read_back(&write_bytes(&document));
    assert_eq!(back.notes, [""; 0]);
    assert!(back.is_whole);
    assert_same(&document, &back.document);
    // Masks, which such a file keeps beside the pixels, are in the pixels of a project.
    assert!(looks(&back.document) == looks(&everything(64)));
}

#[test]
fn a_document_with_any_adjustment_is_written_and_comes_back() {
    for adjustment in ColorAdjustment::all() {
        let layer = Layer::new(adjustment.name(), adjustment.clone());
        let layers = vec![Arc::new(layer)];
        let document = Document { layers, ..Document::empty(Size::new(8, 8)) };
        let back = read_back(&write_bytes(&document)).document;
        assert_eq!(document.difference(&back), None, "{adjustment:?}");
    }
}

#[test]
fn names_that_other_programs_cannot_show_do_not_cost_what_is_live() {
    for name in [" in blanks ", "two\nlines", "ends\0", "", "\u{7f}"] {
        let mut document = everything(32);
        let named = document.with_layer(document.layers[0].id, |layer| layer.name = name.into());
        document = named.unwrap();
        let back = read_back(&write_bytes(&document));
        assert_eq!(back.notes, [""; 0], "{name:?}");
        assert_same(&document, &back.document);
    }
}

#[test]
fn the_same_document_gives_the_same_bytes() {
    assert!(write_bytes(&everything(48)) == write_bytes(&everything(48)));
}

#[test]
fn other_programs_see_the_same_picture() {
    let document = everything(64);
    let seen = read_back(&without_ours(&write_bytes(&document)));
    // Contour pixels are mixed layer by layer there, and once in ours (docs/PROJECTS.md).
    let surface = document.surface.as_deref().unwrap();
    let mixed: HashSet<_> =
        surface.contours().pixels().iter().map(|pixel| (pixel.x, pixel.y)).collect();
    let worst =
        |is_counted: &dyn Fn((i32, i32)) -> bool| worst_of(&document, &seen.document, is_counted);
    assert!(worst(&|at| !mixed.contains(&at)) <= 3, "{}", worst(&|at| !mixed.contains(&at)));
    assert!(worst(&|_| true) <= 8, "{}", worst(&|_| true));
}

#[test]
fn the_surface_s_edge_cuts_layers_that_keep_to_it_once_for_other_programs_as_well() {
    let mut files = files(40);
    let column = |x: u32| [0, 64, 128, 191, 255][x as usize % 5];
    files.0.insert("edge.png".into(), png(40, 40, |x, _| [column(x), column(x), column(x), 255]));
    let fill = |color: &str| json!({ "name": color, "kind": "fill", "color": color });
    let free = |color: &str| json!({ "name": color, "kind": "fill", "color": color, "clip_to_surface": false });
    let faint =
        |color: &str| json!({ "name": color, "kind": "fill", "color": color, "opacity": 0.4 });
    let group =
        |layers: serde_json::Value| json!({ "name": "group", "kind": "group", "layers": layers });
    let stacks = [
        json!([fill("#fa5ac8"), fill("#0a5ac8")]),
        json!([
            fill("#fa5ac8"),
            fill("#0a5ac8"),
            group(json!([fill("#505ac8"), faint("#c85a00")])),
            fill("#1e5ac8")
        ]),
        json!([
            free("#785ac8"),
            fill("#fa5ac8"),
            faint("#0a5ac8"),
            free("#3c5ac840"),
            fill("#5a5ac8")
        ]),
    ];
    for (i, stack) in stacks.into_iter().enumerate() {
        let surface = json!({ "normal": { "file": "maps/n.png" }, "mask": { "file": "edge.png" } });
        let recipe =
            json!({ "canvas": { "width": 40, "height": 40 }, "surface": surface, "layers": stack });
        let document = read_recipe(&recipe, &files);
        let file = write_bytes(&document);
        let seen = read_back(&without_ours(&file)).document;
        assert!(worst(&document, &seen) <= 2, "stack {i}: {} of 255", worst(&document, &seen));
        // Krita leaves out the mask of a group that passes through. Of the last stack the file's
        // own picture is shown: the edge acts twice for other programs, before and behind the free
        // layer.
        let edge = seen.layers.iter().find(|layer| layer.name == "On the surface");
        let is_isolated =
            |layer: &Layer| layer.content.group().is_some_and(|group| !group.pass_through);
        assert!(
            i == 2 || edge.is_some_and(|layer| layer.mask.is_some() && is_isolated(layer)),
            "stack {i}"
        );
        let own = read_back(&file);
        assert_eq!(own.notes, [""; 0], "stack {i}");
        assert_same(&document, &own.document);
        // The pictures stored for other programs do not change how the layers look here.
        assert!(looks(&own.document) == looks(&read_recipe(&recipe, &files)), "stack {i}");
    }
}

#[test]
fn layers_that_blend_with_what_lies_beneath_the_surface_pass_through_its_edge_and_krita_is_told_of()
{
    let mut files = files(40);
    files.0.insert("edge.png".into(), png(40, 40, |x, _| [(x * 6) as u8, 0, 0, 255]));
    let glaze = json!({ "name": "glaze", "kind": "fill", "color": "#c85a00", "blend": "multiply" });
    let ground =
        json!({ "name": "ground", "kind": "fill", "color": "#78c8c8", "clip_to_surface": false });
    let recipe = json!({ "canvas": { "width": 40, "height": 40 }, "layers": [ground, glaze, glaze],
        "surface": { "normal": { "file": "maps/n.png" }, "mask": { "file": "edge.png" } } });
    let document = read_recipe(&recipe, &files);
    let file = write(Path::new("a.psd"), &document, &Progress::default()).unwrap().unwrap();
    let said = "“On the surface” passes through, and Krita ignores its mask";
    assert!(file.notes.iter().any(|note| note == said), "{:?}", file.notes);
    let seen = read_back(&without_ours(&file.bytes)).document;
    assert!(worst(&document, &seen) <= 2, "{} of 255", worst(&document, &seen));
}

/// The layers' pictures in a project of the document.
fn looks(document: &Document) -> Vec<Vec<u8>> {
    use std::io::{Cursor, Read};
    let project =
        crate::project::write(Path::new("a.ora"), document, &Progress::default()).unwrap().unwrap();
    let mut zip = zip::ZipArchive::new(Cursor::new(project)).unwrap();
    let mut picture = |i: usize| {
        let mut bytes = Vec::new();
        zip.by_name(&format!("data/{i:03}.png")).ok()?.read_to_end(&mut bytes).unwrap();
        Some(bytes)
    };
    let looks: Vec<Vec<u8>> = (0..).map_while(&mut picture).collect();
    assert!(!looks.is_empty());
    looks
}

#[test]
fn layers_groups_masks_clipping_locks_and_names_are_carried() {
    let document = read_recipe(
        &json!({ "canvas": { "width": 40, "height": 30 }, "layers": [
            { "name": "grund “ü” 絵", "kind": "pixels", "file": "paint.png", "x": -11, "y": 22, "lock": "alpha" },
            { "name": "clip", "kind": "pixels", "file": "photo.png", "x": 3, "y": 9, "clip_below": true,
              "visible": false, "blend": "soft-light" },
            { "name": "g", "kind": "group", "opacity": 0.5, "blend": "multiply", "visible": false, "layers": [
                { "name": "inner", "kind": "pixels", "file": "photo.png", "x": 100, "y": 100, "lock": "all" } ] },
            { "name": "through", "kind": "group", "pass_through": true, "layers": [] } ] }),
        &files(40),
    );
    let masked = document.with_layer(document.layers[0].id, |layer| {
        let coverage = crate::raster::Plane::from_fn(Size::new(40, 30), |x, y| (x * 5 + y) as u8);
        let kind = MaskKind::File { file: String::new(), coverage: Arc::new(coverage) };
        layer.mask = Some(crate::document::LayerMask::new(kind));
    });
    let document = masked.unwrap();
    let back = read_back(&without_ours(&write_bytes(&document))).document;
    let names = |d: &Document| {
        d.walk().iter().map(|(path, layer)| format!("{path} {}", layer.name)).collect::<Vec<_>>()
    };
    assert_eq!(names(&document), names(&back));
    for ((_, a), (_, b)) in document.walk().iter().zip(back.walk()) {
        assert_eq!(
            (a.visible, a.clip_below, a.lock, a.blend),
            (b.visible, b.clip_below, b.lock, b.blend),
            "{}",
            a.name
        );
        assert!((a.opacity - b.opacity).abs() < 0.003);
        match (&a.content, &b.content) {
            (Content::Pixels(a), Content::Pixels(b)) => {
                let rect = a.tiles.bounds().union(b.tiles.bounds());
                assert!(
                    a.tiles.to_straight_rgba(rect) == b.tiles.to_straight_rgba(rect),
                    "pixels beyond the canvas too"
                );
            }
            (Content::Group(a), Content::Group(b)) => assert_eq!(a.pass_through, b.pass_through),
            _ => panic!("another kind"),
        }
    }
    let coverage = |d: &Document| match &d.layers[0].mask.as_ref().unwrap().kind {
        MaskKind::File { coverage, .. } => coverage.values().to_vec(),
        _ => panic!("a picture"),
    };
    assert_eq!(coverage(&document), coverage(&back));
}

#[test]
fn every_blend_mode_that_the_format_has_is_carried() {
    for (blend, name) in
        BlendMode::ALL.into_iter().filter(|(blend, _)| blend.is_said_by_photoshop())
    {
        let tiles = TileGrid::from_straight_rgba(&[90; 4 * 4], 2, 2, 0, 0);
        let content = Content::Pixels(PixelLayer { file: String::new(), x: 0, y: 0, tiles });
        let layer = Layer { blend, ..Layer::new(name, content) };
        let document =
            Document { layers: vec![Arc::new(layer)], ..Document::empty(Size::new(2, 2)) };
        assert_eq!(
            read_back(&without_ours(&write_bytes(&document))).document.layers[0].blend,
            blend,
            "{name}"
        );
    }
}

#[test]
fn what_others_blend_otherwise_is_told_where_it_is_seen() {
    let notes = |blend, visible| {
        let tiles = TileGrid::from_straight_rgba(&[90; 4 * 4], 2, 2, 0, 0);
        let content = Content::Pixels(PixelLayer { file: String::new(), x: 0, y: 0, tiles });
        let layer = Layer { blend, visible, ..Layer::new("sheen", content) };
        let document =
            Document { layers: vec![Arc::new(layer)], ..Document::empty(Size::new(2, 2)) };
        write(Path::new("a.psd"), &document, &Progress::default()).unwrap().unwrap().notes
    };
    let said = ["“sheen” is blended by “soft light”, shown otherwise by Krita and GIMP"];
    assert_eq!(notes(BlendMode::SoftLight, true), said);
    assert_eq!(notes(BlendMode::SoftLight, false), [""; 0]);
    assert_eq!(notes(BlendMode::Multiply, true), [""; 0]);
}

#[test]
fn layers_that_another_program_changed_are_believed() {
    let document = everything(48);
    let bytes = write_bytes(&document);
    // A layer's opacity, in its record: behind its blend mode.
    let at = bytes.windows(8).position(|w| w == b"8BIMhLit").unwrap();
    let mut other = bytes.clone();
    other[at + 8] = 10;
    let back = read_back(&other);
    assert!(back.notes[0].contains("changed by another program"), "{:?}", back.notes);
    assert!((back.document.layer_named("last").unwrap().opacity - 10.0 / 255.0).abs() < 1e-6);
}

#[test]
fn broken_files_get_a_sentence_or_what_is_left() {
    let bytes = write_bytes(&everything(32));
    for end in (0..bytes.len()).step_by(499) {
        if let Ok(back) = read(Path::new("a.psd"), &bytes[..end], &Budget::default()) {
            assert!(!back.is_whole || back.document.walk().len() > 5, "cut at {end}");
        }
    }
    let mut huge = bytes.clone();
    huge[14..22].copy_from_slice(&[0, 0, 0xea, 0x60, 0, 0, 0xea, 0x60]);
    let said = read(Path::new("a.psd"), &huge, &Budget::default()).err().unwrap().to_string();
    assert!(said.contains("60000"), "{said}");
}

#[test]
fn groups_that_are_never_closed_or_never_opened_lose_no_layer() {
    let group = |layers: Vec<Layer>| {
        let layers = layers.into_iter().map(Arc::new).collect();
        Layer::new("g", Content::Group(Group { layers, pass_through: false }))
    };
    let pixels = || {
        let tiles = TileGrid::from_straight_rgba(&[255; 4], 1, 1, 0, 0);
        Layer::new("p", Content::Pixels(PixelLayer { file: String::new(), x: 0, y: 0, tiles }))
    };
    let layers = vec![Arc::new(group(vec![pixels(), pixels()])), Arc::new(pixels())];
    let bytes =
        without_ours(&write_bytes(&Document { layers, ..Document::empty(Size::new(4, 4)) }));
    for kind in [1u32, 3] {
        let mark = [&b"8BIMlsct\0\0\0\x0c"[..], &kind.to_be_bytes()].concat();
        let at = bytes.windows(mark.len()).position(|w| w == mark).unwrap();
        let mut broken = bytes.clone();
        // No divider at all: a plain layer.
        broken[at + mark.len() - 1] = 0;
        let back = read_back(&broken).document;
        assert_eq!(back.walk().iter().filter(|(_, layer)| layer.name == "p").count(), 3);
    }
}

#[test]
fn groups_nested_too_deep_are_opened_up_and_many_masks_are_refused() {
    let mark = |section| LayerRecord { name: "g".into(), section, ..LayerRecord::default() };
    let leaf = LayerRecord { name: "leaf".into(), ..LayerRecord::default() };
    let deep: Vec<LayerRecord> =
        [vec![mark(RecordSection::End); 100], vec![leaf], vec![mark(RecordSection::Group); 100]]
            .concat();
    let size = Size::new(4, 4);
    let back = read_back(&write::encode_file(size, &deep, &[0; 64], no_marks(), &[]));
    assert!(back.notes.iter().any(|note| note.contains("nested too deep")), "{:?}", back.notes);
    let depth = |path: &str| path.split('.').count();
    let walk = back.document.walk();
    // One level is kept for the group that the layers may be hidden in.
    assert_eq!(walk.iter().map(|(path, _)| depth(path)).max(), Some(Budget::default().group_depth));
    assert!(walk.iter().any(|(_, layer)| layer.name == "leaf"));
    // Each covers the canvas once read, though it takes no space in the file.
    let mask =
        Some(RecordMask { rect: Rect::EMPTY, outside: 9, values: Vec::new(), disabled: false });
    let masked = vec![LayerRecord { mask, ..LayerRecord::default() }; 50];
    let bytes = write::encode_file(size, &masked, &[0; 64], no_marks(), &[]);
    let budget = Budget { document_px: 100, ..Budget::default() };
    let said = read(Path::new("a.psd"), &bytes, &budget).err().unwrap().to_string();
    assert!(said.contains("hold more than 100 pixels"), "{said}");
}

#[test]
fn numbers_of_colors_become_colors() {
    let mut bytes =
        b"8BPS\0\x01\0\0\0\0\0\0\0\x01\0\0\0\x01\0\0\0\x02\0\x08\0\x02\0\0\x03\0".to_vec();
    let mut table = [0; 768];
    (table[7], table[256 + 7], table[512 + 7]) = (10, 20, 30);
    bytes.extend(table);
    // No resources, no layers; plain.
    bytes.extend([0; 8]);
    bytes.extend([0, 0, 7, 0]);
    let back = read_back(&bytes);
    let seen = flatten(&back.document, &Progress::default()).unwrap();
    assert_eq!([seen.pixel(0, 0), seen.pixel(1, 0)], [[10, 20, 30, 255], [0, 0, 0, 255]]);
}

#[test]
fn selections_kept_by_name_are_channels_for_other_programs() {
    let coverage = |x: i32| CoverageGrid::full(Rect::new(x, 3, x + 20, 90));
    let named = |name: &str, coverage| NamedSelection {
        name: name.into(),
        selection: Arc::new(Selection::new(coverage)),
    };
    let mut document = everything(64);
    document.selections = vec![
        named("Eye", coverage(5)),
        named("目 left", coverage(-9)),
        named("none", Default::default()),
    ];
    let bytes = write_bytes(&document);
    assert_eq!(bytes[12..14], [0, 6], "channels");
    let read = read_back(&without_ours(&bytes)).document;
    let kept: Vec<&str> = read.selections.iter().map(|kept| kept.name.as_str()).collect();
    assert_eq!(kept, ["Eye", "目 left"]);
    for (read, meant) in read.selections.iter().zip(&document.selections) {
        assert!(
            read.selection.coverage.is_same(&meant.selection.coverage.within(document.size.rect())),
            "{}",
            read.name
        );
    }
    document.selections.pop();
    let back = read_back(&write_bytes(&document));
    assert_same(&document, &back.document);
    // More than a file has room for.
    document.selections = (0..60).map(|i| named(&i.to_string(), coverage(i % 40))).collect();
    let many = write(Path::new("a.psd"), &document, &Progress::default()).unwrap().unwrap();
    assert_eq!(many.bytes[12..14], [0, 56]);
    assert!(many.notes.iter().any(|note| note.contains("beyond the first 52")), "{:?}", many.notes);
}
