//! Features that only files of other programs have: each a small file made here.

use super::made::*;
use super::read_back;
use crate::Budget;
use crate::document::{Content, Document, Progress, flatten};
use crate::math::hash::mix;
use crate::math::srgb::Color;
use crate::paint::{EffectKind, RampStyle};
use crate::project::ProjectContents;
use crate::raster::BlendMode;
use std::path::Path;

pub fn open(made: &Made) -> ProjectContents {
    let bytes = made.bytes();
    attack(&bytes);
    read_back(&bytes)
}

/// Each of these files in many damaged versions: read or refused, never a panic, nothing as large
/// as a file claims.
pub fn attack(bytes: &[u8]) {
    let budget =
        Budget { area_px: 1 << 18, document_px: 1 << 20, side_px: 2048, ..Budget::default() };
    let dice = |i: u32, j: u32| mix(i.wrapping_mul(31).wrapping_add(j)) as usize;
    for i in 0..250 {
        let mut broken = bytes.to_vec();
        for j in 0..1 + i % 3 {
            // Colors, resources and records come first; most values that may be wrong are there.
            let at = dice(i, 4 * j) % broken.len().min(if i % 2 == 0 { usize::MAX } else { 900 });
            match dice(i, 4 * j + 1) % 5 {
                0 => broken[at] ^= 1 << (dice(i, 4 * j + 2) % 8),
                1 => broken[at] = [0, 1, 0x7f, 0x80, 0xff][dice(i, 4 * j + 2) % 5],
                2 => {
                    let figure =
                        [0u32, 1, 0x7fff_ffff, 0xffff_ffff, 0x0001_0000][dice(i, 4 * j + 2) % 5];
                    broken
                        .iter_mut()
                        .skip(at)
                        .zip(figure.to_be_bytes())
                        .for_each(|(byte, digit)| *byte = digit);
                }
                3 => drop(broken.drain(at..(at + dice(i, 4 * j + 2) % 9).min(broken.len()))),
                _ => broken.truncate(at.max(30)),
            }
            if broken.is_empty() {
                break;
            }
        }
        match super::read(Path::new("a.psd"), &broken, &budget) {
            Ok(read) => assert!(read.document.size.area() <= 1 << 18, "{i}"),
            Err(error) => assert!(error.to_string().starts_with("a.psd"), "{i}: {error}"),
        }
    }
}

pub fn pixel(document: &Document, x: i32, y: i32) -> [u8; 4] {
    flatten(document, &Progress::default()).unwrap().pixel(x, y)
}

fn names(document: &Document) -> Vec<(&str, bool)> {
    document.layers.iter().map(|layer| (layer.name.as_str(), layer.visible)).collect()
}
const HIDDEN: [(&str, bool); 2] = [("Layers", false), ("The file's own picture", true)];

#[test]
fn every_kind_of_colors_opens_from_the_file_s_picture() {
    let float = |v: f32| v.to_be_bytes().to_vec();
    let table = || {
        (0..3)
            .flat_map(|c| (0..256).map(move |i| if i == 7 { [10, 20, 30][c] } else { 0 }))
            .collect()
    };
    type Kind = (u16, u16, Vec<u8>, Vec<Vec<u8>>, [u8; 3]);
    let kinds: [Kind; 9] = [
        // The first pixel of eight is white, the others ink.
        (0, 1, vec![], vec![vec![0b0111_1111]], [255; 3]),
        (1, 16, vec![], vec![vec![0x80, 0x80]], [128; 3]),
        (2, 8, table(), vec![vec![7]], [10, 20, 30]),
        (3, 8, vec![], vec![vec![1], vec![2], vec![3]], [1, 2, 3]),
        (3, 32, vec![], vec![float(1.0), float(0.214_041), float(f32::NAN)], [255, 127, 0]),
        (4, 8, vec![], vec![vec![255], vec![0], vec![255], vec![128]], [128, 0, 128]),
        (7, 8, vec![], vec![vec![255], vec![0], vec![255]], [255, 0, 255]),
        (8, 8, vec![], vec![vec![90]], [90; 3]),
        (9, 8, vec![], vec![vec![255], vec![128], vec![128]], [255; 3]),
    ];
    for (mode, bits, table, merged, rgb) in kinds {
        let made = Made { mode, bits, table, merged, layers: None, ..plain(1, 1, [0; 3]) };
        let back = open(&made);
        let [r, g, b, a] = pixel(&back.document, 0, 0);
        let far = [r, g, b].iter().zip(rgb).map(|(v, w)| v.abs_diff(w)).max();
        assert!(far <= Some(1) && a == 255, "mode {mode}, {bits} bits: {:?}", [r, g, b, a]);
        assert_eq!(
            back.notes.len(),
            usize::from(bits > 8 || ![0, 2, 3].contains(&mode)),
            "{:?}",
            back.notes
        );
    }
    let odd = Made { mode: 5, ..plain(1, 1, [0; 3]) };
    let said = super::read(std::path::Path::new("a.psd"), &odd.bytes(), &crate::Budget::default())
        .err()
        .unwrap();
    assert!(said.to_string().contains("color mode 5 is unknown"), "{said}");
}

#[test]
fn a_spare_channel_with_a_name_is_no_transparency() {
    let mut made = Made { layers: None, ..plain(1, 1, [9, 9, 9]) };
    made.merged.push(vec![0]);
    assert_eq!(pixel(&open(&made).document, 0, 0)[3], 0);
    made.resources = vec![(1053, vec![0, 0, 0, 5])];
    assert_eq!(pixel(&open(&made).document, 0, 0), [9, 9, 9, 255]);
}

#[test]
fn what_is_left_out_and_missed_brings_the_file_s_own_picture() {
    // An adjustment, a look-up that turns gray 100 into 30.
    let mut made = plain(4, 4, [100; 3]);
    made.layers.as_mut().unwrap().push(empty("dark", vec![(b"levl", vec![0; 4])]));
    made.merged = vec![vec![30; 16]; 3];
    let back = open(&made);
    assert_eq!(names(&back.document), HIDDEN);
    assert_eq!(pixel(&back.document, 1, 1), [30, 30, 30, 255]);
    assert!(back.notes[0].contains("“dark”: its adjustment is left out"), "{:?}", back.notes);
    assert!(
        back.notes[1].contains("differ from the file's own picture by 70.0"),
        "{:?}",
        back.notes
    );
    // If it changes nothing, the layers stay visible.
    made.merged = vec![vec![100; 16]; 3];
    let back = open(&made);
    assert_eq!(
        names(&back.document),
        [("ground", true), ("dark", true), ("The file's own picture", false)]
    );
    // If nothing is left out and the pictures agree, there is nothing to add.
    assert_eq!(open(&plain(4, 4, [100; 3])).notes, [""; 0]);
}

#[test]
fn nothing_looks_otherwise_without_a_note() {
    let made = Made { merged: vec![(0..16).collect(); 3], ..plain(4, 4, [100; 3]) };
    let back = open(&made);
    assert_eq!(names(&back.document), HIDDEN);
    assert!(back.notes.len() == 1 && back.notes[0].contains("differ"), "{:?}", back.notes);
}

#[test]
fn knockout_blend_if_and_channels_that_are_left_alone_are_told() {
    let mut layer = colored_layer("top", 4, 4, [100; 3]);
    layer.ranges = [[0, 0, 255, 255], [0, 0, 200, 255]].concat();
    layer.blocks = vec![(b"knko", vec![2, 0, 0, 0]), (b"brst", vec![0; 4])];
    let mut made = plain(4, 4, [100; 3]);
    made.layers = Some(vec![layer]);
    let notes = open(&made).notes.join("\n");
    for part in ["“blend if”", "knockout", "channels that it leaves alone"] {
        assert!(notes.contains(part), "{part}: {notes}");
    }
    let mut made = plain(4, 4, [100; 3]);
    made.layers.as_mut().unwrap()[0].ranges = [0, 0, 255, 255].repeat(8);
    assert_eq!(open(&made).notes, [""; 0], "ranges that let everything through");
}

#[test]
fn effects_are_live_and_shown_where_they_are_switched_on() {
    let effects = |master: bool, shadow: bool| {
        let shadow = objc(&[("enab", flag(shadow)), ("present", flag(true))]);
        let values = [("masterFXSwitch", flag(master)), ("DrSh", shadow)];
        [&[0; 4][..], &descriptor(&values)].concat()
    };
    for (master, shadow) in [(true, true), (true, false), (false, true)] {
        let mut made = plain(4, 4, [100; 3]);
        // The old block repeats them.
        made.layers.as_mut().unwrap()[0].blocks =
            vec![(b"lrFX", vec![0; 4]), (b"lfx2", effects(master, shadow))];
        let opened = open(&made);
        let all = opened.document.walk();
        let layer = all.iter().map(|(_, layer)| layer).find(|layer| !layer.effects.is_empty());
        let on: Vec<bool> = layer.unwrap().effects.iter().map(|effect| effect.on).collect();
        assert_eq!(on, [master && shadow]);
    }
    let mut made = plain(4, 4, [100; 3]);
    // It says that there is one effect, and ends.
    made.layers.as_mut().unwrap()[0].blocks = vec![(b"lrFX", vec![0, 0, 0, 1])];
    let notes = open(&made).notes.join("\n");
    assert!(notes.contains("its effects are left out"), "{notes}");
}

#[test]
fn effects_of_the_old_block_are_live_where_it_is_alone() {
    let fixed = |v: i32| (v << 16).to_be_bytes().to_vec();
    let shadow = |on: u8| {
        let numbers = [fixed(7), fixed(20), fixed(135), fixed(9)].concat();
        // RGB, red; multiply; whether it is on, without the document's light, half opaque.
        let color = [[0, 0, 0xff, 0xff], [0; 4]].concat();
        let own = [0, 0, 0, 0].to_vec();
        let body =
            [own, numbers, color, vec![0; 2], b"8BIMmul ".to_vec(), vec![on, 0, 128], vec![0; 10]];
        let body = body.concat();
        let length = (body.len() as u32).to_be_bytes().to_vec();
        [vec![0, 0, 0, 1], b"8BIMdsdw".to_vec(), length, body].concat()
    };
    let effects = |on: u8| {
        let mut made = plain(4, 4, [100; 3]);
        made.layers.as_mut().unwrap()[0].blocks = vec![(b"lrFX", shadow(on))];
        let opened = open(&made);
        let all = opened.document.walk();
        let found = all.iter().flat_map(|(_, layer)| layer.effects.iter().cloned());
        found.collect::<Vec<_>>()
    };
    let [shadow] = &effects(1)[..] else { panic!("not one effect") };
    let s = &shadow.settings;
    assert_eq!((shadow.kind, shadow.on), (EffectKind::DropShadow, true));
    assert_eq!((s.size, s.spread, s.angle, s.distance), (7.0, 0.2, 135.0, 9.0));
    assert_eq!(
        (s.color, s.blend, s.opacity),
        (Color::rgb(255, 0, 0), BlendMode::Multiply, 128.0 / 255.0)
    );
    assert_eq!(effects(0).len(), 0, "what is switched off there means nothing");
}

/// A rectangle's knots, as shares of the canvas: left, top, right, bottom.
pub fn rectangle([x0, y0, x1, y1]: [f32; 4]) -> Vec<u8> {
    let mut out = [3u32.to_be_bytes(), [0; 4]].concat();
    let mut begin = [0, 0, 0, 4, 0, 1].to_vec();
    begin.resize(26, 0);
    out.extend(begin);
    for (x, y) in [(x0, y0), (x1, y0), (x1, y1), (x0, y1)] {
        out.extend([0, 1]);
        out.extend([y, x].map(|v| ((v * 16_777_216.0) as i32).to_be_bytes()).concat().repeat(3));
    }
    out
}

#[test]
fn a_solid_fill_with_a_vector_mask_is_a_path() {
    let fill = descriptor(&[("Clr ", rgb([200, 10, 20]))]);
    let mask = rectangle([0.0, 0.0, 0.5, 1.0]);
    let mut made = plain(4, 4, [100; 3]);
    let shape = empty("shape", vec![(b"SoCo", fill.clone()), (b"vmsk", mask.clone())]);
    made.layers.as_mut().unwrap().push(shape);
    let row = |v: u8| [v, v, 100, 100].repeat(4);
    made.merged = vec![row(200), row(10), row(20)];
    let back = open(&made);
    assert_eq!(back.notes, [""; 0]);
    let layer = &back.document.layers[1];
    let Content::Image(live) = &layer.content else { panic!("no path") };
    let inside = live.params().source.path().and_then(|path| path.fill);
    assert_eq!((inside, layer.mask.is_none()), (Some(Color::rgb(200, 10, 20)), true));
    assert_eq!(
        [pixel(&back.document, 1, 2), pixel(&back.document, 2, 2)],
        [[200, 10, 20, 255], [100, 100, 100, 255]]
    );
    // Later versions store its pixels too, which show the mask.
    let mut with_pixels = colored_layer("shape", 2, 4, [200, 10, 20]);
    with_pixels.channels.push((-1, vec![255; 8]));
    with_pixels.blocks = vec![(b"SoCo", fill), (b"vmsk", mask)];
    made.layers.as_mut().unwrap()[1] = with_pixels;
    let back = open(&made);
    assert_eq!(back.notes, [""; 0]);
    assert!(matches!(back.document.layers[1].content, Content::Image(_)));
    assert_eq!(
        [pixel(&back.document, 1, 2), pixel(&back.document, 2, 2)],
        [[200, 10, 20, 255], [100, 100, 100, 255]]
    );
}

#[test]
fn colors_of_fills_are_light_where_channels_have_32_bits() {
    let fill = descriptor(&[("Clr ", rgb([55, 255, 0]))]);
    let mask = rectangle([0.0, 0.0, 0.5, 1.0]);
    let mut made = plain(4, 4, [0; 3]);
    made.bits = 32;
    made.layers = Some(vec![empty("shape", vec![(b"SoCo", fill), (b"vmsk", mask)])]);
    let row = |v: f32| [v, v, 0.0, 0.0].map(f32::to_be_bytes).concat().repeat(4);
    made.merged = vec![row(55.0 / 255.0), row(1.0), row(0.0), row(1.0)];
    // The fourth channel is how opaque all layers are.
    made.blocks = vec![(b"Mt32", Vec::new())];
    let back = open(&made);
    assert!(!back.notes.iter().any(|note| note.contains("differ")), "{:?}", back.notes);
    let [layer] = &back.document.layers[..] else { panic!("not one layer") };
    let Content::Image(live) = &layer.content else { panic!("no path") };
    let fill = live.params().source.path().and_then(|path| path.fill);
    assert_eq!(fill, Some(Color::rgb(128, 255, 0)));
    assert_eq!(pixel(&back.document, 3, 0), [0; 4]);
}

#[test]
fn a_gradient_fill_is_a_gradient_of_its_style() {
    let stop = |at: i32, value: u8| {
        objc(&[("Clr ", rgb([value; 3])), ("Lctn", long(at)), ("Mdpn", long(50))])
    };
    let ramp = objc(&[("Clrs", list(&[stop(0, 0), stop(4096, 255)])), ("Trns", list(&[]))]);
    let fill = |way: &str| {
        descriptor(&[("Type", choice("GrdT", way)), ("Angl", double(0.0)), ("Grad", ramp.clone())])
    };
    let mut made = plain(8, 1, [100; 3]);
    // A pixel has the color of its left edge.
    made.merged = vec![(0..8).map(|x| (x * 32) as u8).collect(); 3];
    made.layers.as_mut().unwrap().push(empty("ramp", vec![(b"GdFl", fill("Lnr "))]));
    let back = open(&made);
    assert_eq!(back.notes, [""; 0]);
    assert!(matches!(back.document.layers[1].content, Content::Gradient(_)));
    made.layers.as_mut().unwrap()[1] = empty("ramp", vec![(b"GdFl", fill("Rflc"))]);
    made.merged = vec![[4i32, 3, 2, 1, 0, 1, 2, 3].map(|v| (v * 255 / 4) as u8).to_vec(); 3];
    let back = open(&made);
    assert_eq!(back.notes, [""; 0]);
    let Content::Gradient(live) = &back.document.layers[1].content else { panic!("a gradient") };
    assert_eq!(live.params().style, RampStyle::Reflected);
}

#[test]
fn a_pattern_fill_is_drawn_from_the_file_s_pattern() {
    let plane = |values: [u8; 2]| {
        // Depth, rectangle, depth again, plain.
        let rect: Vec<u8> = [0i32, 0, 1, 2].iter().flat_map(|v| v.to_be_bytes()).collect();
        let data = [&8u32.to_be_bytes()[..], &rect, &8u16.to_be_bytes(), &[0], &values].concat();
        [&1u32.to_be_bytes()[..], &(data.len() as u32).to_be_bytes(), &data].concat()
    };
    let rect: Vec<u8> = [0i32, 0, 1, 2].iter().flat_map(|v| v.to_be_bytes()).collect();
    let planes = [plane([10, 40]), plane([20, 50]), plane([30, 60]), vec![0; 8]].concat();
    let body = [&rect[..], &3u32.to_be_bytes(), &planes].concat();
    let head =
        [&1u32.to_be_bytes()[..], &3u32.to_be_bytes(), &[0, 1, 0, 2], &[0; 4], b"\x02ab"].concat();
    let one = [&head[..], &3u32.to_be_bytes(), &(body.len() as u32).to_be_bytes(), &body].concat();
    let mut made = plain(4, 1, [100; 3]);
    made.blocks = vec![(b"Patt", [&(one.len() as u32).to_be_bytes()[..], &one].concat())];
    let fill =
        |id: &str| descriptor(&[("Ptrn", objc(&[("Idnt", text(id))])), ("Scl ", percent(100.0))]);
    made.layers.as_mut().unwrap().push(empty("tiles", vec![(b"PtFl", fill("ab"))]));
    made.merged = [[10, 40], [20, 50], [30, 60]].map(|pair: [u8; 2]| pair.repeat(2)).to_vec();
    let back = open(&made);
    assert!(
        matches!(&back.notes[..], [note] if note.contains("pattern became pixels")),
        "{:?}",
        back.notes
    );
    assert_eq!(pixel(&back.document, 3, 0), [40, 50, 60, 255]);
    made.layers.as_mut().unwrap()[1] = empty("tiles", vec![(b"PtFl", fill("cd"))]);
    assert!(open(&made).notes[0].contains("not in the file"));
}

#[test]
fn an_artboard_has_its_ground_and_cuts_off_what_lies_beyond() {
    let side = |v: f64| double(v);
    let rect =
        objc(&[("Top ", side(0.0)), ("Left", side(0.0)), ("Btom", side(2.0)), ("Rght", side(4.0))]);
    let kind = ("artboardBackgroundType", long(4));
    let board = descriptor(&[("artboardRect", rect), kind, ("Clr ", rgb([1, 2, 3]))]);
    let mut big = colored_layer("big", 2, 4, [200, 200, 200]);
    big.channels.push((-1, vec![255; 8]));
    let group =
        vec![(b"lsct", [1u32.to_be_bytes(), *b"8BIM", *b"pass"].concat()), (b"artb", board)];
    let layers = vec![
        empty("</>", vec![(b"lsct", 3u32.to_be_bytes().to_vec())]),
        big,
        empty("board", group),
    ];
    let plane = |inside: u8, ground: u8| {
        [[inside, inside, ground, ground].repeat(2), vec![255; 8]].concat()
    };
    let merged = vec![plane(200, 1), plane(200, 2), plane(200, 3)];
    let made = Made { layers: Some(layers), merged, ..plain(4, 4, [0; 3]) };
    let back = open(&made);
    assert_eq!(back.notes, [""; 0]);
    let seen = [(0, 0), (3, 1), (0, 3)].map(|(x, y)| pixel(&back.document, x, y));
    assert_eq!(seen, [[200, 200, 200, 255], [1, 2, 3, 255], [0; 4]]);
}

#[test]
fn masks_are_switched_off_dense_and_inverted_as_the_file_says() {
    let rect: Vec<u8> = [0i32, 0, 4, 2].iter().flat_map(|v| v.to_be_bytes()).collect();
    let masked = |tail: &[u8]| {
        // The picture is unlike the layers, so that both are there.
        let mut made = Made { merged: vec![(0..16).collect(); 3], ..plain(4, 4, [0; 3]) };
        let mut layer = colored_layer("top", 4, 4, [200; 3]);
        layer.channels.push((-2, vec![255; 8]));
        layer.mask_data = [&rect, tail].concat();
        made.layers.as_mut().unwrap().push(layer);
        let document = open(&made).document;
        let Content::Group(group) = &document.layers[0].content else {
            panic!("the picture is another")
        };
        let layers = Document { layers: group.layers.clone(), ..document.clone() };
        [pixel(&layers, 0, 0)[0], pixel(&layers, 3, 0)[0]]
    };
    // Outside, flags, padding.
    assert_eq!(masked(&[0, 0, 0, 0]), [200, 0]);
    assert_eq!(masked(&[255, 0, 0, 0]), [200, 200]);
    assert_eq!(masked(&[0, 2, 0, 0]), [200, 200], "switched off");
    assert_eq!(masked(&[0, 4, 0, 0]), [0, 200], "inverted");
    assert_eq!(masked(&[0, 16, 1, 128]), [200, 100], "half as dense");
}

#[test]
fn kept_selections_open_by_their_names_and_inks_do_not() {
    let text = |name: &str| [&[name.len() as u8], name.as_bytes()].concat();
    let wide = |name: &str| {
        let units = name.encode_utf16().flat_map(u16::to_be_bytes);
        (name.encode_utf16().count() as u32)
            .to_be_bytes()
            .into_iter()
            .chain(units)
            .collect::<Vec<u8>>()
    };
    let shown = |kind: u8| [&[0; 12][..], &[kind]].concat();
    let mut made = plain(4, 3, [10, 20, 30]);
    made.merged.extend([vec![0, 255, 128, 0, 0, 0, 0, 0, 0, 0, 0, 7], vec![255; 12], vec![9; 12]]);
    made.resources = vec![(1006, ["Eye", "Gold", "Eye"].map(text).concat())];
    made.resources.push((1077, [&[0, 0, 0, 1][..], &shown(1), &shown(2), &shown(1)].concat()));
    let read = open(&made);
    let kept = &read.document.selections;
    assert_eq!(kept.iter().map(|kept| kept.name.as_str()).collect::<Vec<_>>(), ["Eye", "Eye 2"]);
    let coverage = &kept[0].selection.coverage;
    assert_eq!([(1, 0), (2, 0), (3, 2), (0, 1)].map(|(x, y)| coverage.at(x, y)), [255, 128, 7, 0]);
    assert!(read.notes.iter().any(|note| note.contains("inks")), "{:?}", read.notes);
    // Letters beyond a byte, and channels that nobody named.
    made.resources = vec![(1045, wide("Auge – 目"))];
    let read = open(&made);
    let names: Vec<&str> = read.document.selections.iter().map(|kept| kept.name.as_str()).collect();
    assert_eq!(names, ["Auge – 目", "Alpha 2", "Alpha 3"]);
}

/// A ground, a group that passes through with a fill of `fill`, and a layer clipped to it.
fn clipped_to_group(fill: u8) -> ProjectContents {
    let divider = |kind: u32| [&kind.to_be_bytes()[..], b"8BIMpass"].concat();
    let mut group = empty("group", vec![(b"lsct", divider(1)), (b"iOpa", vec![fill, 0, 0, 0])]);
    group.blend = *b"pass";
    let mut clipped = colored_layer("clipped", 4, 4, [9; 3]);
    clipped.is_clipped = true;
    let mut made = plain(4, 4, [100; 3]);
    made.layers = Some(vec![
        colored_layer("ground", 4, 4, [100; 3]),
        empty("</Layer group>", vec![(b"lsct", divider(3))]),
        colored_layer("inside", 4, 4, [40; 3]),
        group,
        clipped,
    ]);
    open(&made)
}

#[test]
fn a_group_whose_fill_is_not_whole_does_not_pass_through() {
    for (fill, passes) in [(255, true), (102, false)] {
        let opened = clipped_to_group(fill);
        let walk = opened.document.walk();
        let found = walk
            .iter()
            .find(|(_, layer)| layer.name == "group")
            .and_then(|(_, layer)| Some((layer.content.group()?.pass_through, layer.fill_opacity)));
        assert_eq!(found, Some((passes, f32::from(fill) / 255.0)));
    }
}
