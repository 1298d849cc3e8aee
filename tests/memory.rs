//! Memory has a limit: files that unpack without end, large maps, light and layers, and very many
//! strokes take no more than what is made of them needs; beyond what there is they get a sentence
//! with both figures.

use super::watch;
use rilievo::document::{Live, StrokeList};
use rilievo::files::export::{self, ExportFormat, ExportOptions};
use rilievo::files::{MapSource, SurfaceSource, maps, picture};
use rilievo::math::vec2;
use rilievo::paint::{Brush, Sample, Stroke};
use rilievo::{Budget, Color, Content, Document, Layer, Operator, Progress, Size, flatten, open};
use rilievo_engine::document::parts::{Part, PartKind};
use rilievo_engine::math::hash;
use rilievo_engine::memory::{DABS, FORMS};
use rilievo_engine::shape::{Body, Primitive};
use rilievo_io::{UserFiles, exr, psd};
use std::io::{Cursor, Read, Write};
use std::path::Path;
use std::sync::Arc;

const MIB: usize = 1 << 20;

/// The result of some work, and the most bytes that it held at a time.
fn watched<T>(work: impl FnOnce() -> T) -> (T, usize) {
    let before = watch::forget();
    let done = work();
    (done, watch::peak().saturating_sub(before))
}

fn chunk(kind: &[u8; 4], body: &[u8]) -> Vec<u8> {
    let named = [kind, body].concat();
    [&(body.len() as u32).to_be_bytes()[..], &named, &crc32fast::hash(&named).to_be_bytes()]
        .concat()
}

/// A PNG of one color of `bits` and a kind, with chunks in front of its pixels.
fn png_of(size: Size, kind: png::ColorType, bits: png::BitDepth, before: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size.width, size.height);
    encoder.set_color(kind);
    encoder.set_depth(bits);
    encoder.set_compression(png::Compression::High);
    if kind == png::ColorType::Indexed {
        encoder.set_palette(&[255, 0, 0, 0, 255, 0][..]);
    }
    let row = (size.width as usize * kind.samples() * bits as usize).div_ceil(8);
    let mut writer = encoder.write_header().unwrap();
    let mut rows = writer.stream_writer_with_size(MIB).unwrap();
    let texel: &[u8] = if kind == png::ColorType::Rgb { &[128, 128, 255] } else { &[0] };
    let row: Vec<u8> = texel.iter().copied().cycle().take(row).collect();
    (0..size.height).for_each(|_| rows.write_all(&row).unwrap());
    rows.finish().unwrap();
    writer.finish().unwrap();
    // Behind the header, which takes 33 bytes.
    bytes.splice(33..33, before.concat());
    bytes
}

/// Zeros, packed by DEFLATE within the frame that a PNG wants.
fn bomb(bytes: usize) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    zip.start_file("zeros", zip::write::SimpleFileOptions::default()).unwrap();
    let zeros = vec![0; MIB];
    (0..bytes / MIB).for_each(|_| zip.write_all(&zeros).unwrap());
    let file = zip.finish().unwrap().into_inner();
    let mut archive = zip::ZipArchive::new(Cursor::new(file)).unwrap();
    let mut packed = vec![0x78, 0xda];
    archive.by_index_raw(0).unwrap().read_to_end(&mut packed).unwrap();
    // The checksum is never reached, so any bytes will do.
    packed.extend([0; 4]);
    packed
}

#[test]
fn what_unpacks_without_end_beside_a_picture_is_left_packed() {
    let _turn = watch::turn();
    let bomb = bomb(512 * MIB);
    let beside = [
        chunk(b"iCCP", &[&b"x\0\0"[..], &bomb].concat()),
        chunk(b"zTXt", &[&b"Raw profile type iptc\0\0"[..], &bomb].concat()),
        chunk(b"iTXt", &[&b"XML:com.adobe.xmp\0\x01\0\0\0"[..], &bomb].concat()),
    ];
    for chunk in beside {
        let name = String::from_utf8_lossy(&chunk[4..8]).into_owned();
        let file = png_of(Size::new(8, 8), png::ColorType::Rgb, png::BitDepth::Eight, &[chunk]);
        let read =
            |file: &[u8]| picture::decode(Path::new("a.png"), file, &Budget::default()).unwrap();
        let (read, peak) = watched(|| read(&file));
        assert_eq!(read.size, Size::new(8, 8));
        assert!(peak < 48 * MIB, "{name}: {peak} bytes");
    }
}

#[test]
fn files_that_pack_well_open() {
    let _turn = watch::turn();
    let folder = tempfile::tempdir().unwrap();
    let size = Size::new(6000, 4000);
    let palette = png_of(size, png::ColorType::Indexed, png::BitDepth::One, &[]);
    assert!(palette.len() < 12_000, "{} bytes", palette.len());
    let gray = png_of(size, png::ColorType::Grayscale, png::BitDepth::One, &[]);
    for (name, bytes, pixel) in
        [("palette.png", palette, [255, 0, 0, 255]), ("gray.png", gray, [0, 0, 0, 255])]
    {
        let file = folder.path().join(name);
        std::fs::write(&file, bytes).unwrap();
        let document = open(&file, &Budget::default()).unwrap_or_else(|e| panic!("{e}")).document;
        let Content::Pixels(pixels) = &document.layers[0].content else { panic!("a paint layer") };
        assert_eq!((document.size, pixels.tiles.pixel(5999, 3999)), (size, pixel), "{name}");
    }
}

#[test]
fn a_map_takes_no_more_than_is_asked_for_with_its_depth_derived() {
    let _turn = watch::turn();
    let size = Size::new(4200, 4000);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("flat.png");
    std::fs::write(&file, png_of(size, png::ColorType::Rgb, png::BitDepth::Eight, &[])).unwrap();
    let normal = MapSource { file: file.to_string_lossy().into_owned(), ..MapSource::default() };
    let source = SurfaceSource { normal: Some(normal), ..SurfaceSource::default() };
    let (read, peak) =
        watched(|| maps::import(&source, &UserFiles::default(), &Budget::default()).unwrap());
    assert_eq!(read.surface.size(), size);
    assert!(peak < 100 * size.area(), "{} bytes a pixel", peak / size.area());
    let little = Budget::default().within(300_000_000);
    let said = maps::import(&source, &UserFiles::default(), &little).err().unwrap();
    let figures =
        "a surface of 4200 × 4000 pixels takes 521 MB of memory, and 300 MB are free for it";
    assert!(said.to_string().contains(figures) && said.remedy().is_some(), "{said}");
    let more = Budget::default().within(1_000_000_000);
    let said = maps::import(&source, &UserFiles::default(), &more).err().unwrap();
    assert!(said.to_string().contains("the depth of 4200 × 4000 pixels"), "{said}");
}

#[test]
fn light_becomes_a_paint_layer_a_few_rows_at_a_time() {
    let _turn = watch::turn();
    let size = Size::new(2000, 3000);
    let channel =
        |c: u32| (0..size.area()).map(|i| ((i as u32 * 7 + c) % 1009) as f32 / 900.0).collect();
    let channels = vec![("R", channel(0)), ("G", channel(1)), ("B", channel(2))];
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("light.exr");
    let bytes = exr::encode_channels(&file, size, channels).unwrap();
    std::fs::write(&file, &bytes).unwrap();
    let whole =
        picture::to_tiles(&picture::decode(&file, &bytes, &Budget::default()).unwrap(), 0, 0);
    // Its 16 bits take 12 a pixel, bytes 4.
    let little = Budget { memory_bytes: 11 * size.area() as u64, ..Budget::default() };
    for (budget, most, is_16_bit) in [(Budget::default(), 15, true), (little, 7, false)] {
        let (opened, peak) = watched(|| open(&file, &budget).unwrap());
        let taken = peak.saturating_sub(bytes.len());
        assert!(
            taken < most * size.area(),
            "{} bytes a pixel beside the file",
            taken / size.area()
        );
        let Content::Pixels(pixels) = &opened.document.layers[0].content else {
            panic!("a paint layer")
        };
        assert!(
            whole.iter().all(|(at, tile)| pixels.tiles.tile(at).unwrap().bytes() == tile.bytes())
        );
        assert_eq!(
            (pixels.tiles.is_16_bit_in(size.rect()), opened.notes.len()),
            (is_16_bit, usize::from(!is_16_bit))
        );
    }
}

#[test]
fn sparse_layers_take_what_is_painted_on_them() {
    let _turn = watch::turn();
    let (side, layers) = (3000u32, 6);
    let mut rgba = vec![0; (side * side * 4) as usize];
    for at in [0, rgba.len() - 4] {
        rgba[at..at + 4].copy_from_slice(&[200, 30, 60, 255]);
    }
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, side, side);
    encoder.set_color(png::ColorType::Rgba);
    encoder.write_header().unwrap().write_image_data(&rgba).unwrap();
    drop(rgba);
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let stored =
        zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
    let mut stack = format!("<?xml version='1.0'?><image w='{side}' h='{side}'><stack>");
    let mut entry = |name: &str, bytes: &[u8]| {
        zip.start_file(name, stored).unwrap();
        zip.write_all(bytes).unwrap();
    };
    entry("mimetype", b"image/openraster");
    for i in 0..layers {
        entry(&format!("data/{i}.png"), &png);
        stack += &format!("<layer name='{i}' src='data/{i}.png'/>");
    }
    entry("stack.xml", (stack + "</stack></image>").as_bytes());
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("sparse.ora");
    std::fs::write(&file, zip.finish().unwrap().into_inner()).unwrap();
    let (seen, peak) = watched(|| {
        let document = open(&file, &Budget::default()).unwrap().document;
        let pixels = flatten(&document, &Progress::default()).unwrap();
        let out = export::encode(
            Path::new("a.png"),
            ExportFormat::Png,
            &pixels,
            document.size,
            &ExportOptions::default(),
        );
        (document.layers.len(), pixels.pixel(2999, 2999), out.unwrap().len())
    });
    assert_eq!((seen.0, seen.1), (layers, [200, 30, 60, 255]));
    // One decoded picture alone would take 36 MB.
    assert!(peak < 16 * MIB, "{peak} bytes");
}

#[test]
fn a_photoshop_file_takes_no_more_than_is_asked_for() {
    let _turn = watch::turn();
    let size = Size::new(3000, 2000);
    let fill = Layer::new("sky", Content::Fill(Color { r: 9, g: 90, b: 200, a: 255 }));
    let document = Document { layers: vec![Arc::new(fill)], ..Document::empty(size) };
    let file = Path::new("a.psd");
    let bytes = psd::write(file, &document, &Progress::default()).unwrap().unwrap().bytes;
    // Another program's: the number of our own part is changed.
    let at = bytes.windows(6).position(|w| w == b"8BIM\x12\x67").unwrap();
    let other = [&bytes[..at], b"8BIM\x12\x66", &bytes[at + 6..]].concat();
    let (read, peak) = watched(|| psd::read(file, &other, &Budget::default()).unwrap());
    assert_eq!((read.document.layers.len(), read.notes.len()), (1, 0));
    // Allocated: 4 for the layer, 4 + 4 + 4 for the picture, 4 for the flattened layers.
    assert!(peak < 21 * size.area(), "{} bytes a pixel", peak / size.area());
    for (bytes_free, what) in [
        (20_000_000, "reading its layers takes"),
        (60_000_000, "picture of them all"),
        (100_000_000, "comparing"),
    ] {
        let said = psd::read(file, &other, &Budget::default().within(bytes_free)).err().unwrap();
        assert!(said.to_string().contains(what) && said.remedy().is_some(), "{said}");
    }
}

#[test]
fn of_very_many_strokes_few_dabs_are_held() {
    let _turn = watch::turn();
    DABS.set_limit(4 << 20);
    let size = Size::new(1000, 800);
    let stroke = |i: u32| {
        let at = |j: u32| vec2(1000.0 * hash::unit(i, j, 0), 800.0 * hash::unit(i, j, 1));
        let brush = Brush { size: 4.0, ..Brush::default() };
        let samples = (0..10).map(|j| Sample::at(at(j))).collect();
        Arc::new(Stroke::new(brush, Operator::None, Color::BLACK, samples))
    };
    let list = StrokeList { strokes: (0..80).map(stroke).collect() };
    let layer = Layer::new("strokes", Content::Strokes(Live::new(list)));
    let document = Document { layers: vec![Arc::new(layer)], ..Document::empty(size) };
    let (pixels, peak) = watched(|| flatten(&document, &Progress::default()).unwrap());
    DABS.set_limit(64 << 20);
    assert!(pixels.iter().count() > 100);
    // All dabs together take some 130 MiB.
    assert!(peak < 90 * MIB, "{peak} bytes");
}

#[test]
fn forms_beyond_their_limit_are_made_one_at_a_time_to_the_same_surface() {
    let _turn = watch::turn();
    let size = Size::new(700, 700);
    let ball = |i: u16| {
        let middle = vec2(350.0 + f32::from(i), 350.0);
        Arc::new(Part::new(
            format!("{i}"),
            PartKind::Primitive(Primitive::new(Body::Sphere, middle, 340.0 - f32::from(i))),
        ))
    };
    let list: Vec<Arc<Part>> = (0..24).map(ball).collect();
    let usual = FORMS.limit();
    let made = |limit: u64| {
        FORMS.set_limit(limit);
        let empty = Document::empty(size);
        let most = empty.shape_bytes(&list) as usize;
        let (shaped, peak) = watched(|| empty.with_parts(list.clone()));
        assert!(peak < most, "{peak} bytes, {most} were expected at most");
        // One is moved, and the farthest hidden.
        let mut other = list.clone();
        other[20] = ball(60);
        let next = shaped.with_parts(other[1..].to_vec());
        FORMS.set_limit(usual);
        let areas = next.part_areas();
        assert_eq!((areas.len(), areas[3].1.at(352, 350), areas[3].1.at(3, 3)), (23, 255, 0));
        ([shaped, next].map(|document| document.surface.unwrap()), peak)
    };
    let ((kept, whole), (again, held)) = (made(1 << 30), made(0));
    for (a, b) in kept.iter().zip(&again) {
        assert_eq!(a.depth_plane(), b.depth_plane());
        assert_eq!(
            (a.normal_planes(), a.coverage_plane()),
            (b.normal_planes(), b.coverage_plane())
        );
    }
    assert!(
        held < 100 * size.area() && whole > held + 15 * 17 * size.area(),
        "{held} and {whole} bytes"
    );
}
