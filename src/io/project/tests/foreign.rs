//! Projects that other programs wrote: how much of them is read at all.

use super::super::sample::{files, read as read_recipe};
use super::*;
use serde_json::json;

/// A project without our entries: layers that show pictures, bottom last.
fn foreign(size: Size, layers: &[&str], pictures: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let layers: String =
        layers.iter().map(|src| format!("<layer name=\"{src}\" src=\"data/{src}\"/>")).collect();
    let (w, h) = (size.width, size.height);
    let stack = format!("<image w=\"{w}\" h=\"{h}\"><stack>{layers}</stack></image>");
    let mut entries = vec![(MIMETYPE.into(), MIME.into()), (STACK.into(), stack.into_bytes())];
    entries.extend(pictures.iter().map(|(name, bytes)| (format!("data/{name}"), bytes.clone())));
    pack(&entries)
}

fn picture(size: Size) -> Vec<u8> {
    let texels = vec![[9, 90, 200, 255]; size.area()];
    pixels::encode_texels(Path::new("p.png"), &texels, size).unwrap().bytes().to_vec()
}

#[test]
fn pictures_are_counted_by_their_headers_before_the_first_is_decoded() {
    let size = Size::new(70, 50);
    // Whoever decodes these calls them damaged, and opens the rest.
    let begun: Vec<u8> = picture(size)[..40].into();
    let bytes =
        foreign(size, &["a.png", "b.png", "a.png"], &[("a.png", begun.clone()), ("b.png", begun)]);
    let of = |document_px| {
        read(Path::new("a.ora"), &bytes, &Budget { document_px, ..Budget::default() })
    };
    assert!(!of(3 * 3500).unwrap().is_whole);
    let said = of(3 * 3500 - 1).err().unwrap().to_string();
    assert!(said.contains("its layers hold more than 10499 pixels together"), "{said}");
}

#[test]
fn layers_that_show_one_picture_share_its_tiles() {
    let size = Size::new(70, 50);
    let bytes = foreign(
        size,
        &["a.png", "b.png", "a.png"],
        &[("a.png", picture(size)), ("b.png", picture(size))],
    );
    let back = read_back(&bytes);
    let tiles = |i: usize| match &back.document.layers[i].content {
        Content::Pixels(pixels) => {
            pixels.tiles.iter().map(|(_, tile)| tile.clone()).collect::<Vec<_>>()
        }
        _ => panic!("pixels"),
    };
    let shared =
        |i: usize, j: usize| tiles(i).iter().zip(&tiles(j)).all(|(a, b)| Arc::ptr_eq(a, b));
    assert_eq!((tiles(0).len(), shared(0, 2), shared(0, 1)), (2, true, false));
}

/// A shape of parts alone; paint on a part, and a stroke in a selection on another.
fn on_parts() -> Document {
    let json = json!({
        "canvas": { "width": 40, "height": 30 },
        "surface": { "parts": [
            { "id": "ball", "kind": "sweep", "balls": [[20, 15, 12]], "matrix": [1, 0, 0, 1, 2, 1] },
            { "id": "eye", "kind": "sweep", "balls": [[24, 12, 3]] } ] },
        "selections": [{ "id": "s1", "mask": { "file": "m.png" } }, { "id": "s2", "name": "Kept" }],
        "layers": [
            { "name": "Base", "kind": "fill", "color": "#c08040", "on": "ball" },
            { "name": "Ink", "kind": "strokes", "on": "ball", "strokes": [
                { "selection": "s1", "brush": { "size": 5 }, "samples": [[9, 9], [30, 14]], "on": "eye" } ] },
            { "name": "Top", "kind": "pixels", "file": "paint.png" } ],
    });
    read_recipe(&json, &files(40))
}

#[test]
fn what_lies_on_parts_stays_live_when_something_else_is_damaged_or_changed() {
    let document = on_parts();
    let bytes = write_bytes(&document);
    let live = |back: &ProjectContents, name: &str| {
        let layer =
            back.document.layer_named(name).unwrap_or_else(|| panic!("{name}: {:?}", back.notes));
        (layer.content.kind_name(), layer.on.clone())
    };
    let attachment = |name: &str| document.layer_named(name).unwrap().on.clone();
    // The pixels of a layer are gone.
    let damaged = change_entries(&bytes, |name, bytes| {
        (!name.starts_with("rilievo/pixels/")).then_some(bytes)
    });
    // Another program moved a layer away and kept our entries.
    let reordered = change_entries(&bytes, |name, bytes| {
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        Some(if name == STACK {
            text(bytes).replace("name=\"Top\"", "name=\"Up\"").into_bytes()
        } else {
            bytes
        })
    });
    for bytes in [damaged, reordered] {
        let back = read_back(&bytes);
        assert_eq!(live(&back, "Base"), ("fill", attachment("Base")));
        assert_eq!(live(&back, "Ink"), ("strokes", attachment("Ink")));
        let said = back.notes.join("; ");
        assert!(!said.is_empty(), "something is told");
        assert!(!said.contains("surface is lost"), "{said}");
        assert!(back.document.surface.is_some() && back.document.parts.list.len() == 2);
    }
}
