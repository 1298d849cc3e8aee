mod damage;
mod foreign;
mod held;

use super::sample::{assert_same, everything, png, smoothly_painted, tiles16};
use super::*;
use crate::Budget;
use crate::document::{Content, Layer, MaskKind, SurfaceSource};
use crate::math::{PlaneMap, Size, srgb::Color};
use crate::raster::Plane;
use std::collections::HashSet;
use std::sync::Arc;

fn write_bytes(document: &Document) -> Vec<u8> {
    write(Path::new("a.ora"), document, &Progress::default()).unwrap().unwrap()
}

fn read_back(bytes: &[u8]) -> ProjectContents {
    read(Path::new("a.ora"), bytes, &Budget::default()).unwrap_or_else(|e| panic!("{e}"))
}

/// The entries of a zip, in their order.
fn entries(bytes: &[u8]) -> Vec<(String, Vec<u8>)> {
    let mut zip = zip::ZipArchive::new(std::io::Cursor::new(bytes)).unwrap();
    let count = zip.len();
    let one = |i| {
        let mut entry = zip.by_index(i).unwrap();
        let mut bytes = Vec::new();
        std::io::Read::read_to_end(&mut entry, &mut bytes).unwrap();
        (entry.name().unwrap().into_owned(), bytes)
    };
    (0..count).map(one).collect()
}

fn pack(entries: &[(String, Vec<u8>)]) -> Vec<u8> {
    let mut packer = ZipPacker::default();
    entries.iter().for_each(|(name, bytes)| packer.store(name, bytes).unwrap());
    packer.finish().unwrap()
}

/// A project whose entries went through another program.
fn change_entries(bytes: &[u8], change: impl Fn(&str, Vec<u8>) -> Option<Vec<u8>>) -> Vec<u8> {
    let kept = entries(bytes)
        .into_iter()
        .filter_map(|(name, bytes)| Some((name.clone(), change(&name, bytes)?)));
    pack(&kept.collect::<Vec<_>>())
}

#[test]
fn a_document_comes_back_in_every_parameter_and_pixel() {
    let document = everything(64);
    let back = read_back(&write_bytes(&document));
    assert_eq!(back.notes, [""; 0]);
    assert!(back.is_whole);
    assert_same(&document, &back.document);
}

#[test]
fn smooth_paint_comes_back_in_16_bits_and_ink_is_stored_in_8() {
    let document = smoothly_painted();
    let found = tiles16(&document);
    assert!(found[..3].iter().all(|&deep| deep > 1) && found[3] == 0, "{found:?}");
    let file = write_bytes(&document);
    let back = read_back(&file);
    assert!(
        back.notes.is_empty() && document.difference(&back.document).is_none(),
        "{:?}",
        back.notes
    );
    assert_same(&document, &back.document);
    assert_eq!(tiles16(&back.document), found);
    assert!(write_bytes(&back.document) == file, "saved again");
    let depth = |name: &str| {
        let entry = entries(&file).into_iter().find(|(known, _)| known == name).unwrap();
        crate::pixels::is_16_bit(&entry.1)
    };
    let names = ["data/001.png", "data/004.png", "mergedimage.png"];
    assert_eq!(names.map(depth), [true, false, false]);
    // Another program finds the pixels as they are.
    let foreign =
        change_entries(&file, |name, bytes| (!name.starts_with("rilievo/")).then_some(bytes));
    let seen = tiles16(&read_back(&foreign).document);
    assert_eq!(seen[1..2], found[..1]);
}

#[test]
fn saved_and_read_and_saved_again_it_is_the_same_file() {
    let first = write_bytes(&everything(64));
    assert!(first == write_bytes(&everything(64)), "another document of the same parameters");
    let back = read_back(&first).document;
    let second = write_bytes(&back);
    assert!(first == second, "{:?}", differing(&first, &second));
}

/// The first entries that differ.
fn differing(a: &[u8], b: &[u8]) -> Vec<(String, String)> {
    let pairs = entries(a).into_iter().zip(entries(b)).filter(|(a, b)| a != b);
    pairs
        .map(|(a, b)| (format!("{} {}", a.0, a.1.len()), format!("{} {}", b.0, b.1.len())))
        .collect()
}

#[test]
fn an_unchanged_layer_is_copied_and_a_changed_one_is_not() {
    let document = everything(64);
    let first = write_bytes(&document);
    let layer = document.layer_named("last").unwrap();
    let look = || {
        layer
            .cache
            .pixels
            .get(&document.scene(), std::slice::from_ref(layer), &(), || panic!("encoded again"))
            .unwrap()
    };
    let before = look();
    assert!(first == write_bytes(&document));
    assert!(look().file.ptr_eq(&before.file));
    let moved = document.with_layer(layer.id, |layer| {
        let Content::Pixels(pixels) = &mut layer.content else { panic!("pixels") };
        pixels.tiles = crate::raster::TileGrid::from_straight_rgba(&[9; 4 * 4], 2, 2, 0, 0);
    });
    assert_same(
        &read_back(&write_bytes(moved.as_ref().unwrap())).document,
        moved.as_ref().unwrap(),
    );
}

#[test]
fn sources_maps_and_tips_keep_their_very_bytes() {
    let files = super::sample::files(64);
    let stored: Vec<Vec<u8>> =
        entries(&write_bytes(&everything(64))).into_iter().map(|(_, bytes)| bytes).collect();
    for name in ["maps/n.png", "photo.png", "tip.png"] {
        assert!(stored.contains(&files.0[name]), "{name}");
    }
}

#[test]
fn it_is_a_valid_openraster_file() {
    let bytes = write_bytes(&everything(64));
    assert_eq!(&bytes[30..54], b"mimetypeimage/openraster", "first, and stored");
    let names: Vec<String> = entries(&bytes).into_iter().map(|(name, _)| name).collect();
    assert_eq!(names[..4], [MIMETYPE, DOCUMENT, MANIFEST, STACK]);
    assert_eq!(names[names.len() - 2..], [MERGED, thumbnail::ENTRY]);
    let xml = entries(&bytes).into_iter().find(|(name, _)| name == STACK).unwrap().1;
    let xml = String::from_utf8(xml).unwrap();
    for name in names.iter().filter(|name| name.starts_with("data/")) {
        assert!(xml.contains(&format!("src=\"{name}\"")), "{name} belongs to no layer");
    }
}

#[test]
fn what_other_programs_see_is_the_same_picture() {
    let document = everything(64);
    // Without our own entries, everything is what OpenRaster alone can say.
    let bytes = change_entries(&write_bytes(&document), |name, bytes| {
        (!name.starts_with("rilievo/")).then_some(bytes)
    });
    let seen = read_back(&bytes);
    let picture =
        |d: &Document| flatten(d, &Progress::default()).unwrap().to_straight_rgba(d.size.rect());
    let (ours, theirs) = (picture(&document), picture(&seen.document));
    let premultiplied = |p: &[u8]| [0, 1, 2].map(|c| i32::from(p[c]) * i32::from(p[3]) / 255);
    let surface = document.surface.as_ref().unwrap();
    let width = document.size.width as usize;
    let contours: HashSet<usize> = surface
        .contours()
        .pixels()
        .iter()
        .map(|pixel| pixel.y as usize * width + pixel.x as usize)
        .collect();
    let on_contour = |i: usize| contours.contains(&i);
    let (mut worst, mut at_contours) = (0, 0);
    for (i, (a, b)) in ours.chunks(4).zip(theirs.chunks(4)).enumerate() {
        let (pa, pb) = (premultiplied(a), premultiplied(b));
        let far = (0..3).map(|c| (pa[c] - pb[c]).abs()).max().unwrap();
        let most = if on_contour(i) { &mut at_contours } else { &mut worst };
        *most = far.max(*most);
    }
    println!("{worst} inside, {at_contours} at contours");
    assert!(worst <= 2, "{worst}");
    for name in ["photo", "ramp", "lines", "lit"] {
        assert!(
            seen.notes.iter().any(|note| note.contains(&format!("“{name}” became pixels"))),
            "{:?}",
            seen.notes
        );
    }
}

#[test]
fn a_picture_that_another_program_changed_becomes_pixels_and_the_rest_stays_live() {
    let document = everything(64);
    let bytes = write_bytes(&document);
    let path = document.walk().iter().position(|(_, layer)| layer.name == "lines").unwrap();
    let manifest: serde_json::Value = entries(&bytes)
        .iter()
        .find(|(name, _)| name == MANIFEST)
        .map(|(_, bytes)| serde_json::from_slice(bytes).unwrap())
        .unwrap();
    let name = manifest["pictures"]
        .as_array()
        .unwrap()
        .iter()
        .find(|p| p["layer"] == document.walk()[path].0.as_str());
    let name = name.unwrap()["picture"].as_str().unwrap().to_owned();
    let red = png(3, 3, |_, _| [255, 0, 0, 255]);
    let back = read_back(&change_entries(&bytes, |entry, bytes| {
        Some(if entry == name { red.clone() } else { bytes })
    }));
    assert_eq!(back.notes.len(), 1, "{:?}", back.notes);
    assert!(back.notes[0].contains("“lines” was changed by another program"));
    let kind =
        |name: &str| std::mem::discriminant(&back.document.layer_named(name).unwrap().content);
    let before = |name: &str| std::mem::discriminant(&document.layer_named(name).unwrap().content);
    assert_eq!(kind("lines"), before("last"));
    assert_eq!(kind("photo"), before("photo"));
}

#[test]
fn a_stack_that_another_program_changed_is_believed_and_untouched_layers_stay_live() {
    let document = everything(64);
    let bytes = change_entries(&write_bytes(&document), |name, bytes| {
        let edited = |xml: String| {
            xml.replace("name=\"photo\" opacity=\"1\"", "name=\"Foto\" opacity=\"0.25\"")
        };
        Some(if name == STACK {
            edited(String::from_utf8(bytes).unwrap()).into_bytes()
        } else {
            bytes
        })
    });
    let back = read_back(&bytes);
    assert!(
        back.notes.iter().any(|note| note.contains("changed by another program")),
        "{:?}",
        back.notes
    );
    let photo = back.document.layer_named("Foto").unwrap();
    assert_eq!(photo.opacity, 0.25);
    assert!(
        matches!(photo.content, Content::Image(_))
            && matches!(photo.mask.as_ref().unwrap().kind, MaskKind::File { .. })
    );
    assert!(back.document.surface.is_some());
}

#[test]
fn a_damaged_entry_costs_its_own_layer_only() {
    let document = everything(64);
    let bytes = write_bytes(&document);
    for (entry, layer) in [("rilievo/files/photo.png", "photo"), ("rilievo/files/tip.png", "lines")]
    {
        let at = bytes.windows(entry.len()).position(|w| w == entry.as_bytes()).unwrap();
        // The first match is in the compressed JSON only by accident; the header's comes right
        // before the data.
        let mut broken = bytes.clone();
        broken[at + entry.len() + 60] ^= 1;
        let back = read_back(&broken);
        assert!(!back.is_whole);
        assert!(
            back.notes.iter().any(|note| note.contains(&format!("“{layer}” became pixels"))),
            "{:?}",
            back.notes
        );
        assert_eq!(back.document.walk().len(), document.walk().len());
    }
}

#[test]
fn a_document_cut_short_gives_what_is_there() {
    let document = everything(64);
    let bytes = write_bytes(&document);
    let first = bytes.windows(12).position(|w| w == b"data/006.png").unwrap();
    let back = read_back(&bytes[..first + 200]);
    assert!(!back.is_whole && back.notes.len() > 1, "{:?}", back.notes);
    assert_eq!(back.document.walk().len(), document.walk().len());
    assert!(read(Path::new("a.ora"), &bytes[..20], &Budget::default()).is_err());
}

#[test]
fn a_surface_that_came_from_no_file_comes_back() {
    let mut document = everything(64);
    (document.surface_source, document.surface_files) = (None, Arc::default());
    let back = read_back(&write_bytes(&document)).document;
    let (a, b) = (document.surface.as_ref().unwrap(), back.surface.as_ref().unwrap());
    for (x, y) in [(32, 32), (20, 40), (50, 25)] {
        assert!(
            (a.normal(x, y) - b.normal(x, y)).length() < 1e-5,
            "{} {}",
            a.normal(x, y),
            b.normal(x, y)
        );
        assert!((a.depth(x, y) - b.depth(x, y)).abs() < 1e-5);
    }
    assert!(a.coverage_plane().values() == b.coverage_plane().values());
    assert!((a.depth_range_px() - b.depth_range_px()).abs() < 1e-2);
}

#[test]
fn maps_that_were_turned_come_back_as_their_files_and_a_matrix() {
    let plain = everything(64);
    assert!(
        !text_of(&write_bytes(&plain)).contains("\"matrix\""),
        "nothing of it where it is not used"
    );
    let turn = PlaneMap::rotation(30.0, plain.size.center());
    let surface = plain.surface.as_ref().unwrap().transformed(plain.size, &turn).unwrap();
    let source = SurfaceSource {
        matrix: turn.coefficients_as_written(),
        ..SurfaceSource::clone(plain.surface_source.as_ref().unwrap())
    };
    let document = Document {
        surface_source: Some(Arc::new(source)),
        surface: Some(surface.clone()),
        ..plain.clone()
    };
    let bytes = write_bytes(&document);
    let back = read_back(&bytes).document;
    assert_same(&document, &back);
    let again = back.surface.unwrap();
    assert!(surface.normal_planes().map(Plane::values) == again.normal_planes().map(Plane::values));
    assert!(surface.depth_plane().values() == again.depth_plane().values());
    let names = |bytes: &[u8]| entries(bytes).into_iter().map(|(name, _)| name).collect::<Vec<_>>();
    assert_eq!(names(&bytes), names(&write_bytes(&plain)), "the files of the maps");
    assert!(text_of(&bytes).contains("\"version\": 2"));
    let flat =
        SurfaceSource { matrix: Some([1.0, 2.0, 2.0, 4.0, 0.0, 0.0]), ..SurfaceSource::default() };
    let refused =
        Document { surface_source: Some(Arc::new(flat)), ..plain }.fits(None).unwrap_err();
    assert!(refused.contains("cannot be inverted"), "{refused}");
}

#[test]
fn a_drawing_whose_canvas_was_changed_again_and_again_is_saved_as_it_is() {
    use crate::document::canvas_change::{CanvasAnchor, CanvasChange, CanvasMirror};
    let mut here = everything(64);
    for step in 0..7 {
        let size = here.size;
        let change = match step {
            0 => CanvasChange::quarter_turns(size, 1),
            1 => CanvasChange::mirror(size, CanvasMirror::LeftRight),
            2 => CanvasChange::crop(size, crate::math::Rect::new(9, 5, 60, 58)).unwrap(),
            3 => CanvasChange::turn(size, 25.0),
            4 => CanvasChange::resize(size, Size::new(90, 70), CanvasAnchor::BottomRight).unwrap(),
            5 => CanvasChange::turn(size, -25.0),
            _ => CanvasChange::mirror(size, CanvasMirror::UpDown),
        };
        here = here.on_other_canvas(&change).unwrap();
        assert_eq!(here.fits(None), Ok(()), "step {step}");
        assert_same(&here, &read_back(&write_bytes(&here)).document);
    }
    let scaled = here.resampled(Size::new(120, 130), crate::raster::Resampling::Sharp).unwrap();
    assert_same(&scaled, &read_back(&write_bytes(&scaled)).document);
}

/// The recipe in a project.
fn text_of(bytes: &[u8]) -> String {
    let found = entries(bytes)
        .into_iter()
        .find(|(name, _)| name == DOCUMENT)
        .unwrap_or_else(|| panic!("no recipe"));
    String::from_utf8(found.1).unwrap()
}

#[test]
fn an_empty_document_and_an_empty_layer_come_back() {
    let empty = Document::empty(Size::new(3, 2));
    assert_same(&empty, &read_back(&write_bytes(&empty)).document);
    let layer = Layer::new(
        "",
        Content::Pixels(crate::document::PixelLayer {
            file: String::new(),
            x: 0,
            y: 0,
            tiles: Default::default(),
        }),
    );
    let one = Document {
        layers: vec![Arc::new(layer), Arc::new(Layer::new("f", Content::Fill(Color::WHITE)))],
        ..empty
    };
    assert_same(&one, &read_back(&write_bytes(&one)).document);
}

#[test]
fn a_layer_that_keeps_to_what_is_beneath_is_clipped_to_all_of_it() {
    let stack = r#"<image w="4" h="4"><stack>
        <layer name="atop" src="data/c.png" composite-op="svg:src-atop"/>
        <layer name="b" src="data/b.png"/><layer name="a" src="data/a.png"/></stack></image>"#;
    let dots = |x: u32, y: u32, rgb: [u8; 3]| {
        png(
            4,
            4,
            move |px, py| if (px, py) == (x, y) { [rgb[0], rgb[1], rgb[2], 255] } else { [0; 4] },
        )
    };
    let entries = [
        (STACK.to_owned(), stack.into()),
        ("data/a.png".to_owned(), dots(0, 0, [255, 0, 0])),
        ("data/b.png".to_owned(), dots(1, 1, [0, 255, 0])),
        ("data/c.png".to_owned(), png(4, 4, |_, _| [0, 0, 255, 255])),
    ];
    let back = read_back(&pack(&entries));
    assert_eq!(back.notes, [""; 0]);
    let seen = flatten(&back.document, &Progress::default()).unwrap();
    let pixels = [(0, 0), (1, 1), (2, 2)].map(|(x, y)| seen.pixel(x, y));
    assert_eq!(pixels, [[0, 0, 255, 255], [0, 0, 255, 255], [0; 4]]);
}

#[test]
fn meshes_and_liquify_come_back_to_the_last_bit_and_are_of_the_second_version() {
    use crate::document::{LayerTransform, Mesh, MeshFrame, TransformShape};
    use crate::math::{Rect, Size, vec2};
    use crate::raster::{Lattice, Resampling};
    let plain = Document {
        layers: vec![Arc::new(Layer::new("fill", Content::Fill(Color::BLACK)))],
        ..Document::empty(Size::new(128, 96))
    };
    let mut lattice = Lattice::default();
    lattice.change(Rect::new(20, 20, 90, 70), |_, q, _| vec2(q.y * 0.07, 3.3 - q.x * 0.05));
    let even = Mesh::even(3, 4, MeshFrame::of(plain.size)).unwrap();
    let points = even.points().iter().map(|p| *p * 1.013 + vec2(0.1, -7.7)).collect();
    let shape = TransformShape::Mesh(Arc::new(even.with_points(points).unwrap()));
    let id = plain.layers[0].id;
    let warped = plain.with_layer(id, |layer| {
        layer.transform = Some(LayerTransform { shape, filter: Resampling::Sharp });
        layer.liquify = Some(Arc::new(lattice));
    });
    let warped = warped.unwrap();
    assert_eq!(warped.fits(None), Ok(()));
    let back = read_back(&write_bytes(&warped)).document;
    assert_eq!(warped.difference(&back), None);
    assert_eq!(plain.difference(&back), Some("“fill”: its transform".into()));
    let recipe = crate::recipe::write;
    assert_eq!(
        (recipe(&plain)["version"].as_i64(), recipe(&warped)["version"].as_i64()),
        (Some(1), Some(2))
    );
}
