//! Brushes of Photoshop, of every version.

use super::*;
use crate::paint::{DualMode, DualSettings};

/// A tip of a collection from its bounds on: 8 or 16 bits, plain or packed.
fn tip(width: u32, height: u32, bits: u16, packed: bool, values: &[u8]) -> Vec<u8> {
    let mut out = words(&[0, 0, height, width]);
    out.extend(bits.to_be_bytes());
    out.push(u8::from(packed));
    if packed {
        let row = width as usize * usize::from(bits / 8);
        // Runs of literals.
        let rows: Vec<Vec<u8>> =
            values.chunks(row).map(|r| [&[r.len() as u8 - 1], r].concat()).collect();
        rows.iter().for_each(|r| out.extend((r.len() as u16).to_be_bytes()));
        rows.iter().for_each(|r| out.extend(r));
    } else {
        out.extend(values);
    }
    out
}

/// A collection of version 2: one computed tip, one sampled.
pub fn old_abr() -> Vec<u8> {
    let numbers = |n: &[u16]| -> Vec<u8> { n.iter().flat_map(|n| n.to_be_bytes()).collect() };
    let computed = [words(&[0]), numbers(&[25, 40, 50, 30, 80])].concat();
    let name: Vec<u8> = "Chalk\0".encode_utf16().flat_map(u16::to_be_bytes).collect();
    let head = [words(&[0]), numbers(&[15]), words(&[6]), name, vec![1], vec![0; 8]].concat();
    let sampled = [head, tip(3, 2, 8, true, &[0, 50, 100, 150, 200, 255])].concat();
    let record = |kind: u16, record: Vec<u8>| {
        [numbers(&[kind]), words(&[record.len() as u32]), record].concat()
    };
    [numbers(&[2, 2]), record(1, computed), record(2, sampled)].concat()
}

/// A collection of version 6 with two sampled tips.
pub fn new_abr(subversion: u16) -> Vec<u8> {
    let unknown = vec![b'k'; if subversion == 1 { 47 } else { 301 }];
    let record = |tip: Vec<u8>| {
        let length = unknown.len() + tip.len();
        let filling = vec![0; length.next_multiple_of(4) - length];
        [words(&[length as u32]), unknown.clone(), tip, filling].concat()
    };
    let pixels16: Vec<u8> = [0u16, 257 * 100, 65535].iter().flat_map(|v| v.to_be_bytes()).collect();
    let tips =
        [record(tip(4, 3, 8, false, &ramp(12))), record(tip(3, 1, 16, true, &pixels16))].concat();
    let block = |key: &[u8; 4], data: &[u8]| {
        [b"8BIM", &key[..], &words(&[data.len() as u32]), data].concat()
    };
    [&[0, 6][..], &subversion.to_be_bytes(), &block(b"patt", &[1, 2, 3, 4]), &block(b"samp", &tips)]
        .concat()
}

#[test]
fn photoshop_tips_of_every_version_are_read() {
    let old = read(Path::new("set.abr"), &old_abr(), &NoBrushFiles, &budget()).unwrap();
    assert_eq!(old.len(), 2);
    let round = &old[0].brush;
    assert!(matches!(round.tip, Tip::Ellipse { ratio } if ratio == 0.5));
    assert_eq!(
        (round.size, round.hardness, round.rotation, round.spacing),
        (40.0, 0.8, 30.0, 0.25)
    );
    assert_eq!((old[1].name.as_str(), old[1].brush.spacing), ("Chalk", 0.15));
    assert_eq!(texels(&tips(&old[1])[0])[5], [255; 4]);
    for subversion in [1, 2] {
        let new =
            read(Path::new("set.abr"), &new_abr(subversion), &NoBrushFiles, &budget()).unwrap();
        assert_eq!(new.len(), 2);
        assert_eq!((new[0].name.as_str(), new[0].brush.size), ("set 1", 4.0));
        assert_eq!(texels(&tips(&new[0])[0])[11], [77, 77, 77, 255]);
        let pixels16: Vec<u8> = texels(&tips(&new[1])[0]).iter().map(|t| t[0]).collect();
        assert_eq!(pixels16, [0, 100, 255]);
    }
}

/// The same; a description calls its second tip “Reed”, and there is a computed brush as well, whose
/// dual brush is that tip.
pub fn named_abr() -> Vec<u8> {
    let text = |t: &str| {
        let letters: Vec<u8> = t.encode_utf16().chain([0]).flat_map(u16::to_be_bytes).collect();
        [words(&[t.len() as u32 + 1]), letters].concat()
    };
    let named = |name: &str, kind: &str, value: Vec<u8>| {
        let length = if name.len() == 4 { 0 } else { name.len() as u32 };
        [words(&[length]), name.into(), kind.into(), value].concat()
    };
    let percent = |name, v: f64| named(name, "UntF", [&b"#Prc"[..], &v.to_be_bytes()].concat());
    let object = |values: &[Vec<u8>]| {
        [text(""), words(&[0]), b"null".to_vec(), words(&[values.len() as u32]), values.concat()]
            .concat()
    };
    let preset = |name: &str, brush: &[Vec<u8>], more: &[Vec<u8>]| {
        let fields = [
            named("Nm  ", "TEXT", text(name)),
            named("Brsh", "Objc", object(brush)),
            named("useScatter", "bool", vec![1]),
            percent("Scat", 120.0),
        ];
        [b"Objc".to_vec(), object(&[&fields[..], more].concat())].concat()
    };
    let sampled = [
        percent("Dmtr", 30.0),
        percent("Spcn", 40.0),
        named("sampledData", "TEXT", text("second")),
    ];
    let computed = [percent("Dmtr", 12.0), percent("Hrdn", 50.0), percent("Rndn", 100.0)];
    let key = |key: &str| {
        let length = if key.len() == 4 { 0 } else { key.len() as u32 };
        [words(&[length]), key.into()].concat()
    };
    let second = [percent("Dmtr", 3.0), named("sampledData", "TEXT", text("second"))];
    let dual = [
        named("useDualBrush", "bool", vec![1]),
        named("Brsh", "Objc", object(&second)),
        named("BlnM", "enum", [key("BlnM"), key("linearBurn")].concat()),
        percent("Spcn", 70.0),
        named("useScatter", "bool", vec![0]),
    ];
    let dual = [named("dualBrush", "Objc", object(&dual))];
    let list =
        [words(&[2]), preset("Reed", &sampled, &[]), preset("Dot", &computed, &dual)].concat();
    let description = [words(&[16]), object(&[named("Brsh", "VlLs", list)])].concat();
    let mut bytes = new_abr(1);
    // The second tip's key, a length and its letters, follows the length of its record.
    let first = bytes.windows(4).position(|w| w == b"samp").unwrap() + 8;
    let length = u32::from_be_bytes(bytes[first..first + 4].try_into().unwrap()) as usize;
    let key = first + 4 + length.next_multiple_of(4) + 4;
    bytes[key..key + 7].copy_from_slice(b"\x06second");
    [bytes, b"8BIMdesc".to_vec(), words(&[description.len() as u32]), description].concat()
}

#[test]
fn later_photoshop_brushes_have_their_names_sizes_and_spacings() {
    let read = read(Path::new("set.abr"), &named_abr(), &NoBrushFiles, &budget()).unwrap();
    let told: Vec<_> =
        read.iter().map(|b| (b.name.as_str(), b.brush.size, b.brush.spacing)).collect();
    assert_eq!(told, [("Reed", 30.0, 0.4), ("Dot", 12.0, 0.25), ("set 1", 4.0, 0.25)]);
    assert_eq!(texels(&tips(&read[0])[0])[2], [255; 4], "the second tip's");
    assert_eq!(
        (read[1].brush.hardness, read[0].notes[0].as_str()),
        (0.5, "it scatters to all sides, not across the stroke alone")
    );
    // Scattered up to 120 %, which is a radius of 60.
    assert_eq!(read[0].brush.scatter, 0.6);
    let dual = read[1].brush.dual.as_ref().expect("a second tip");
    let DualSettings { size, spacing, scatter, mode, .. } = dual.settings;
    assert_eq!((size, spacing, scatter, mode), (0.25, 0.7, 0.0, DualMode::LinearBurn));
    let Tip::Picture(source) = &dual.tip else { panic!("a sampled tip") };
    assert_eq!(texels(source)[2], [255; 4], "the second tip's");
    assert!(read[0].brush.dual.is_none());
}
