//! Files of 16 and 32 bits a channel: what bytes cannot hold of them is still there when they are
//! open.

use super::foreign::attack;
use super::made::*;
use super::read_back;
use crate::document::{Content, Document};
use crate::math::{Rect, srgb};
use crate::project::ProjectContents;
use crate::raster::TileGrid;
use crate::sixteen_bit_paint::read_within_budget;
use crate::{Budget, Remedy};
use std::path::Path;

const SIDE: u32 = 96;
const RECT: Rect = Rect::new(0, 0, SIDE as i32, SIDE as i32);

/// A value that no byte has, for each pixel and channel.
fn value(i: usize, c: usize) -> u16 {
    (i * 7 + c * 20_011 + 1) as u16
}

fn plane(c: usize, stored: impl Fn(u16) -> Vec<u8>) -> Vec<u8> {
    (0..(SIDE * SIDE) as usize).flat_map(|i| stored(value(i, c))).collect()
}

fn short(v: u16) -> Vec<u8> {
    v.to_be_bytes().to_vec()
}

/// Linear light whose sRGB is the value.
fn light(v: u16) -> Vec<u8> {
    srgb::decode(f32::from(v) / 65535.0).to_be_bytes().to_vec()
}

/// The canvas filled with those values, as a picture alone or with a layer that shows the same.
fn file_of(bits: u16, stored: impl Fn(u16) -> Vec<u8>, has_layer: bool) -> Made {
    let planes: Vec<Vec<u8>> = (0..3).map(|c| plane(c, &stored)).collect();
    let channels = planes.iter().zip(0..).map(|(plane, c)| (c, plane.clone())).collect();
    let layer = MadeLayer { channels, ..colored_layer("soft", SIDE, SIDE, [0; 3]) };
    Made {
        bits,
        merged: planes,
        layers: has_layer.then(|| vec![layer]),
        ..plain(SIDE, SIDE, [0; 3])
    }
}

fn tiles(document: &Document, layer: usize) -> &TileGrid {
    match &document.layers[layer].content {
        Content::Pixels(pixels) => &pixels.tiles,
        _ => panic!("a paint layer"),
    }
}

/// The greatest difference of any channel from what was stored.
fn greatest_difference(tiles: &TileGrid) -> u16 {
    let pixels = tiles.to_straight16(RECT);
    let of =
        |(i, pixel): (usize, &[u16; 4])| (0..3).map(move |c| (i, c, pixel[c])).collect::<Vec<_>>();
    pixels.iter().enumerate().flat_map(of).map(|(i, c, v)| v.abs_diff(value(i, c))).max().unwrap()
}

#[test]
fn pictures_and_layers_of_more_than_8_bits_become_paint_of_16() {
    for (bits, most, said) in [(16, 0, "are kept here"), (32, 1, "became 16")] {
        for has_layer in [false, true] {
            let made = if bits == 16 {
                file_of(16, short, has_layer)
            } else {
                file_of(32, light, has_layer)
            };
            let bytes = made.bytes();
            attack(&bytes);
            let ProjectContents { document, notes, .. } = read_back(&bytes);
            assert_eq!((document.layers.len(), notes.len()), (1, 1), "{bits} bits: {notes:?}");
            assert!(
                notes[0].contains(said) && notes[0].contains("8 for other programs"),
                "{notes:?}"
            );
            assert!(
                greatest_difference(tiles(&document, 0)) <= most,
                "{bits} bits, layers: {has_layer}"
            );
        }
    }
    let eight = file_of(8, |v| vec![(v >> 8) as u8], true);
    assert!(!tiles(&read_back(&eight.bytes()).document, 0).is_16_bit_in(RECT));
}

#[test]
fn gray_and_half_transparent_pixels_keep_16_bits() {
    let mut gray = file_of(16, short, true);
    (gray.mode, gray.merged) = (1, vec![plane(0, short)]);
    let layer = &mut gray.layers.as_mut().unwrap()[0];
    layer.channels = vec![(0, plane(0, short)), (-1, plane(1, |v| short(v | 0x4000)))];
    let document = read_back(&gray.bytes()).document;
    let own = document.walk().into_iter().find(|(_, layer)| layer.name == "soft").unwrap().1;
    let Content::Pixels(pixels) = &own.content else { panic!("a paint layer") };
    for (i, [r, g, b, a]) in pixels.tiles.to_straight16(RECT).into_iter().enumerate() {
        assert_eq!(a, value(i, 1) | 0x4000);
        // Premultiplied by a quarter at least.
        assert!(r == g && g == b && r.abs_diff(value(i, 0)) <= 2, "{r} for {}", value(i, 0));
    }
}

#[test]
fn the_file_s_own_picture_keeps_16_bits_where_it_is_shown() {
    let mut made = file_of(16, short, true);
    made.layers.as_mut().unwrap().push(empty("dark", vec![(b"levl", vec![0; 4])]));
    made.layers.as_mut().unwrap()[0].channels =
        (0..3).map(|c| (c, vec![0; (SIDE * SIDE * 2) as usize])).collect();
    let document = read_back(&made.bytes()).document;
    assert_eq!(document.layers[1].name, "The file's own picture");
    assert_eq!(greatest_difference(tiles(&document, 1)), 0);
}

#[test]
fn a_wide_profile_is_applied_in_16_bits() {
    let mut made = file_of(16, short, false);
    made.resources = vec![(1039, moxcms::ColorProfile::new_adobe_rgb().encode().unwrap())];
    let document = read_back(&made.bytes()).document;
    let pixels = tiles(&document, 0).to_straight16(RECT);
    assert!(greatest_difference(tiles(&document, 0)) > 1000, "sRGB is narrower");
    let distinct: std::collections::BTreeSet<u16> = pixels.iter().map(|pixel| pixel[1]).collect();
    assert!(distinct.len() > 4000, "{} levels", distinct.len());
}

#[test]
fn short_of_memory_a_file_of_16_bits_is_read_with_8() {
    let (file, bytes) = (Path::new("a.psd"), file_of(16, short, true).bytes());
    let area = u64::from(SIDE * SIDE);
    let read = |free: u64| {
        let budget = Budget { memory_bytes: free, ..Budget::default() };
        read_within_budget(
            file,
            &budget,
            |budget| super::super::read(file, &bytes, budget),
            |read| &read.document,
        )
    };
    let (whole, none) = read(60 * area).unwrap();
    assert_eq!(none, None);
    // With 8 bits the layer takes 4 a pixel, the picture 4 with planes of 4 and 8, and flattening
    // 4; 16 bits take 12, 12, 8, 8 and 4.
    for free in [24 * area, 39 * area] {
        let (rounded, note) = read(free).unwrap();
        assert!(note.is_some_and(|note| note.contains("8 bits a channel")), "{free}");
        let (found, wanted) = (tiles(&rounded.document, 0), tiles(&whole.document, 0));
        assert!(!found.is_16_bit_in(RECT) && wanted.is_16_bit_in(RECT));
        let pairs = wanted.to_straight_rgba(RECT).into_iter().zip(found.to_straight_rgba(RECT));
        assert!(pairs.map(|(a, b)| a.abs_diff(b)).max() <= Some(1));
    }
    assert_eq!(read(3 * area).err().unwrap().remedy(), Some(Remedy::MoreMemory));
}
