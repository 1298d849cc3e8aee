//! Brushes of other programs, built byte by byte as their documents say; and the same ones damaged.

pub mod photoshop;

use super::*;
use crate::math::hash;
use crate::paint::dynamics::{DabInputs, Input, Property};
use crate::paint::settings::SETTINGS;
use crate::paint::tip::RankSelect;
use crate::paint::{Falloff, Spread, Stabilizer};
use crate::raster::picture::Texels;
use photoshop::{named_abr, new_abr, old_abr};

fn budget() -> Budget {
    Budget::default()
}

fn only(file: &str, bytes: &[u8]) -> ImportedBrush {
    let mut brushes =
        read(Path::new(file), bytes, &NoBrushFiles, &budget()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(brushes.len(), 1);
    brushes.remove(0)
}

fn error_of(file: &str, bytes: &[u8]) -> String {
    read(Path::new(file), bytes, &NoBrushFiles, &budget()).map(|_| ()).unwrap_err().to_string()
}

fn texels(source: &PictureSource) -> Vec<[u8; 4]> {
    match &source.picture.texels {
        Texels::Srgb8(texels) => texels.to_vec(),
        Texels::Linear(_) => panic!("tips hold bytes"),
    }
}

/// The pictures of its tip.
fn tips(imported: &ImportedBrush) -> Vec<PictureSource> {
    imported.brush.pictures().cloned().collect()
}

fn words(numbers: &[u32]) -> Vec<u8> {
    numbers.iter().flat_map(|n| n.to_be_bytes()).collect()
}

/// A GIMP brush of version 2.
fn gbr(name: &str, width: u32, height: u32, bytes: u32, spacing: u32, pixels: &[u8]) -> Vec<u8> {
    let header = words(&[28 + name.len() as u32 + 1, 2, width, height, bytes]);
    [&header[..], b"GIMP", &words(&[spacing]), name.as_bytes(), &[0], pixels].concat()
}

fn ramp(n: usize) -> Vec<u8> {
    (0..n).map(|i| (i * 7) as u8).collect()
}

#[test]
fn a_gray_gimp_brush_is_coverage_as_large_as_it_is() {
    let brush = only("b.gbr", &gbr("Round Fuzzy", 3, 2, 1, 20, &[0, 10, 20, 30, 40, 255]));
    assert_eq!(brush.name, "Round Fuzzy");
    assert_eq!((brush.brush.size, brush.brush.spacing), (3.0, 0.2));
    let tip = &tips(&brush)[0];
    assert_eq!(tip.file, "round-fuzzy.png");
    assert_eq!(texels(tip)[..3], [[0, 0, 0, 255], [10, 10, 10, 255], [20, 20, 20, 255]]);
    assert!(brush.notes.is_empty());
}

#[test]
fn colors_and_older_and_newer_versions_are_read_too() {
    let colored = only("b.gbr", &gbr("Pepper", 1, 2, 4, 100, &[1, 2, 3, 4, 5, 6, 7, 8]));
    assert_eq!(texels(&tips(&colored)[0]), [[1, 2, 3, 4], [5, 6, 7, 8]]);
    let first = [&words(&[20 + 4, 1, 2, 1, 1])[..], b"Old\0", &[9, 200]].concat();
    let first = only("b.gbr", &first);
    assert_eq!((first.name.as_str(), first.brush.spacing), ("Old", 0.25));
    assert_eq!(texels(&tips(&first)[0]), [[9, 9, 9, 255], [200, 200, 200, 255]]);
    // CinePaint's: the upper halves of the floats 0.5 and 1.
    let half = [
        &words(&[28 + 2, 3, 2, 1, 18])[..],
        b"GIMP",
        &words(&[30]),
        b"C\0",
        &[0x3f, 0x00, 0x3f, 0x80],
    ]
    .concat();
    assert_eq!(
        texels(&tips(&only("b.gbr", &half))[0]),
        [[128, 128, 128, 255], [255, 255, 255, 255]]
    );
}

#[test]
fn a_gray_brush_before_a_pattern_takes_its_colors() {
    let brush = gbr("P", 2, 1, 1, 10, &[100, 200]);
    let pattern =
        [&words(&[24 + 2, 1, 2, 1, 3])[..], b"GPAT", b"x\0", &[1, 2, 3, 4, 5, 6]].concat();
    let both = [brush, pattern].concat();
    assert_eq!(texels(&tips(&only("b.gpb.gbr", &both))[0]), [[1, 2, 3, 100], [4, 5, 6, 200]]);
}

fn gih() -> Vec<u8> {
    let cells: Vec<u8> = (0..4u8).flat_map(|i| gbr("cell", 4, 4, 1, 50, &[i * 60; 16])).collect();
    let text = "Leaves\n4 ncells:4 cellwidth:4 cellheight:4 step:20 dim:2 cols:1 rows:1 placement:constant \
                rank0:2 sel0:angular rank1:2 sel1:random\n";
    [text.as_bytes(), &cells].concat()
}

#[test]
fn a_hose_keeps_its_pictures_and_its_rule() {
    let brush = only("b.gih", &gih());
    assert_eq!((brush.name.as_str(), brush.brush.spacing, brush.brush.size), ("Leaves", 0.5, 4.0));
    let Tip::Hose(hose) = &brush.brush.tip else { panic!("a hose") };
    let ranks: Vec<_> = hose.ranks().iter().map(|rank| (rank.count, rank.select)).collect();
    assert_eq!(ranks, [(2, RankSelect::Angular), (2, RankSelect::Random)]);
    assert_eq!(hose.pictures()[3].file, "leaves-4.png");
    assert_eq!(texels(&hose.pictures()[2])[0], [120, 120, 120, 255]);
    let bare =
        [b"x\n2\n".to_vec(), gbr("a", 1, 1, 1, 9, &[1]), gbr("b", 1, 1, 1, 9, &[2])].concat();
    let Tip::Hose(hose) = only("b.gih", &bare).brush.tip else { panic!("a hose") };
    assert_eq!((hose.ranks()[0].count, hose.ranks()[0].select), (2, RankSelect::Incremental));
}

#[test]
fn a_hose_with_fewer_pictures_than_it_says_paints_with_those() {
    let bytes = [b"x\n4 rank0:4 sel0:random\n".to_vec(), gbr("a", 1, 1, 1, 9, &[1])].concat();
    let brush = only("b.gih", &bytes);
    assert_eq!(tips(&brush).len(), 1);
    assert_eq!(brush.notes[0], "it holds 1 of the 4 pictures that it announces");
    assert!(error_of("b.gih", &bytes[..bytes.len() - 1]).contains("cut short"));
}

const MYB: &str = r#"{ "version": 3, "group": "", "settings": {
    "radius_logarithmic": { "base_value": 2.3, "inputs": { "pressure": [[0, -0.5], [1, 0.5]] } },
    "hardness": { "base_value": 0.5, "inputs": {} },
    "opaque": { "base_value": 1.0, "inputs": {} },
    "opaque_multiply": { "base_value": 0, "inputs": { "pressure": [[0, 0], [0.5, 0.1], [1, 1]] } },
    "dabs_per_actual_radius": { "base_value": 4, "inputs": {} },
    "dabs_per_basic_radius": { "base_value": 1, "inputs": {} },
    "offset_by_random": { "base_value": 0.4, "inputs": {} },
    "elliptical_dab_ratio": { "base_value": 4, "inputs": {} },
    "elliptical_dab_angle": { "base_value": 90, "inputs": {} },
    "change_color_h": { "base_value": 0, "inputs": { "random": [[0, -0.1], [1, 0.1]] } },
    "slow_tracking": { "base_value": 1.5, "inputs": {} },
    "smudge": { "base_value": 0.7, "inputs": {} } } }"#;

/// The value of a brush property for given inputs.
fn drive(brush: &Brush, property: Property, plain: f32, inputs: DabInputs) -> f32 {
    brush.dynamics.value(property, plain, &inputs)
}

#[test]
fn a_mypaint_brush_becomes_numbers_and_what_is_added_to_them() {
    let ImportedBrush { name, brush, notes } = only("ink blot.myb", MYB.as_bytes());
    assert_eq!(name, "ink blot");
    let pressed = |pressure: f32| DabInputs { pressure, ..DabInputs::default() };
    for (pressure, log) in [(0.0f32, 1.8f32), (0.5, 2.3), (1.0, 2.8)] {
        let size = drive(&brush, Property::Size, brush.size, pressed(pressure));
        assert!((size / (2.0 * log.exp()) - 1.0).abs() < 0.01, "{pressure}: {size}");
    }
    for (pressure, opaque) in [(0.25f32, 0.05f32), (0.5, 0.1), (0.75, 0.55), (1.0, 1.0)] {
        assert!(
            (drive(&brush, Property::Flow, brush.flow, pressed(pressure)) - opaque).abs() < 0.01
        );
    }
    assert_eq!((brush.spacing, brush.rate.per_diameter), (0.125, 2.0), "4 and 1 in a radius");
    assert!((brush.overlap - 9.1).abs() < 1e-3, "10 in a diameter, to nine tenths");
    assert_eq!((brush.scatter, brush.spread), (0.2, Spread::Cloud));
    assert_eq!((brush.hardness, brush.falloff), (0.5, Falloff::Peaked));
    assert!(matches!(brush.tip, Tip::Ellipse { ratio } if ratio == 0.25));
    assert_eq!(brush.rotation, 270.0, "upright");
    assert!(
        (brush.dynamics.added_curve(Property::Hue, Input::Chance).unwrap().at(1.0) - 0.1).abs()
            < 1e-6
    );
    assert_eq!(brush.stabilizer, Stabilizer::Lag { secs: 0.015 });
    assert_eq!((brush.pickup.amount, brush.pickup.length), (0.7, 0.5));
    assert!(notes.is_empty(), "{notes:?}");
}

#[test]
fn a_mypaint_brush_that_follows_several_inputs_follows_them_all() {
    let text = r#"{ "version": 3, "settings": {
        "opaque": { "base_value": 0.4, "inputs": { "pressure": [[0, 0], [1, 0.5]], "random": [[0, -0.4], [1, 0.1]] } },
        "elliptical_dab_ratio": { "base_value": 1, "inputs": { "tilt_declination": [[0, 5], [90, 0]] } },
        "dabs_per_second": { "base_value": 80, "inputs": {} },
        "stroke_holdtime": { "base_value": 10, "inputs": {} } } }"#;
    let ImportedBrush { brush, notes, .. } = only("b.myb", text.as_bytes());
    // The file does not say what multiplies it, so the pressure does.
    let inputs = DabInputs { pressure: 0.5, tilt: 1.0, seed: 3, ..DabInputs::default() };
    let chance = brush.dynamics.added_curve(Property::Flow, Input::Chance).unwrap();
    let random = (0..=100).map(|i| chance.at(i as f32 / 100.0)).fold(0.0, f32::max);
    assert!((random - 0.1).abs() < 1e-5);
    let flow = drive(&brush, Property::Flow, brush.flow, inputs);
    assert!(
        (0.12..=0.38).contains(&flow),
        "between 0.5 (0.4 + 0.25 − 0.4) and 0.5 (0.4 + 0.25 + 0.1): {flow}"
    );
    assert!((drive(&brush, Property::Elongation, 1.0, inputs) - 6.0).abs() < 1e-3);
    assert_eq!((brush.rate.per_sec, brush.cycle.hold), (80.0, 10.0));
    assert!(notes.is_empty(), "{notes:?}");
}

#[test]
fn a_mypaint_brush_tells_what_it_uses_and_loses_and_nothing_else() {
    let text = r#"{ "version": 3, "settings": {
        "posterize": { "base_value": 0.5, "inputs": {} }, "smudge_length": { "base_value": 0.9, "inputs": {} },
        "smudge_bucket": { "base_value": 3, "inputs": {} },
         "offset_by_speed_slowness": { "base_value": 2, "inputs": {} },
        "hardness": { "base_value": 0.5, "inputs": { "gridmap_x": [[0, 0], [256, 1]] } } } }"#;
    let notes = only("b.myb", text.as_bytes()).notes;
    assert_eq!(notes, ["“hardness” does not follow “gridmap_x”", "“posterize” has no counterpart"]);
}

#[test]
fn a_key_given_twice_counts_as_it_does_in_mypaint() {
    let text = r#"{ "version": 3, "settings": { "radius_logarithmic": { "base_value": 1, "inputs": {} },
        "radius_logarithmic": { "base_value": 2, "inputs": {} } } }"#;
    assert!((only("b.myb", text.as_bytes()).brush.size - 2.0 * 2f32.exp()).abs() < 1e-3);
}

#[test]
fn a_mypaint_brush_of_an_older_version_is_read_and_of_another_is_named() {
    let old = only("b.myb", b"radius_logarithmic 1.0 | pressure (0.0 0.0), (1.0 1.0)\nversion 2\n");
    let size = drive(&old.brush, Property::Size, old.brush.size, DabInputs::default());
    assert!((size - 2.0 * 2f32.exp()).abs() < 1e-3);
    assert!(error_of("b.myb", br#"{ "version": 4, "settings": {} }"#).contains("version 4"));
    assert!(error_of("b.myb", br#"{ "version": 3 }"#).contains("no settings"));
}

#[test]
fn every_ending_is_of_one_format_and_a_refusal_names_them_all() {
    let said = error_of("b.txt", b"hello");
    for (ending, format) in EXTENSIONS {
        let file = format!("A.{}", ending.to_uppercase());
        assert_eq!(BrushFormat::of(Path::new(&file), b""), Some(format), "{ending}");
        assert!(said.contains(&format!(".{ending}")), "{said}");
        let count = EXTENSIONS.iter().filter(|(_, other)| *other == format).count();
        assert_eq!(count, 1, "{ending}");
    }
}

#[test]
fn what_is_no_brush_gets_a_sentence() {
    for (file, bytes, part) in [
        ("b.txt", &b"hello"[..], "ends in none of"),
        ("b.gbr", b"", "cut short"),
        ("b.gbr", &gbr("n", 3, 2, 1, 20, &[0; 5]), "cut short"),
        ("b.gbr", &gbr("n", 3, 2, 7, 20, &[0; 42]), "7 bytes a pixel"),
        ("b.gbr", &gbr("n", 60_000, 60_000, 1, 20, &[]), "too large"),
        ("b.gbr", &gbr("n", 0, 5, 1, 20, &[]), "no pixels"),
        ("b.gih", b"name\nmany\n", "how many pictures"),
        ("b.gih", b"name\n999999 x\n", "may have 1024"),
        ("b.abr", &[0, 3, 0, 1], "version 3"),
        ("b.abr", &[0, 6, 0, 9], "subversion 9"),
        ("b.abr", &[0, 6, 0, 2], "no sampled tips"),
    ] {
        assert!(error_of(file, bytes).contains(part), "{file}: {}", error_of(file, bytes));
    }
}

#[test]
fn a_damaged_tip_is_left_out_and_the_others_stay() {
    let mut bytes = new_abr(1);
    // The first tip's compression is unknown.
    let at = bytes.windows(4).position(|w| w == b"samp").unwrap() + 8 + 4 + 47 + 18;
    bytes[at] = 9;
    let left = read(Path::new("set.abr"), &bytes, &NoBrushFiles, &budget()).unwrap();
    assert_eq!(left.len(), 1);
    assert_eq!(left[0].notes, ["1 damaged brushes of the collection were left out"]);
}

/// Changes a few bytes, and leaves one at least.
pub(super) fn damage(bytes: &mut Vec<u8>, chance: &impl Fn(u32) -> u32) {
    for change in 0..1 + chance(0) % 4 {
        let at = chance(10 + change) as usize % bytes.len();
        match chance(20 + change) % 4 {
            0 => bytes[at] = chance(30 + change) as u8,
            1 => bytes[at] = [0, 255, 127, 128][chance(40 + change) as usize % 4],
            2 => bytes.truncate(at.max(1)),
            _ if bytes.len() > 1 => drop(bytes.remove(at)),
            _ => {}
        }
    }
}

#[test]
fn damaged_files_never_panic_and_what_they_give_is_a_brush_within_its_ranges() {
    let files = [
        ("a.gbr", gbr("n", 9, 7, 1, 20, &ramp(63))),
        ("a.gih", gih()),
        ("a.myb", MYB.into()),
        ("b.myb", b"version 2\nopaque 0.5 | pressure (0.0 0.0), (1.0 0.5)\nsmudge 1\ntracking_noise 0.5\n".to_vec()),
        ("a.abr", old_abr()),
        ("b.abr", new_abr(2)),
        ("c.abr", named_abr()),
    ];
    let small =
        Budget { side_px: 4096, area_px: 1 << 20, document_px: 1 << 22, ..Budget::default() };
    for (seed, (file, whole)) in files.into_iter().enumerate() {
        for round in 0..3000u32 {
            let chance =
                |what: u32| hash::mix(hash::mix(seed as u32 * 7919 + round) ^ hash::mix(what));
            let mut bytes = whole.clone();
            damage(&mut bytes, &chance);
            for ImportedBrush { name, brush, .. } in
                read(Path::new(file), &bytes, &NoBrushFiles, &small).into_iter().flatten()
            {
                assert!(!name.is_empty());
                let are_in_range = SETTINGS
                    .iter()
                    .all(|setting| setting.number.range.contains(&setting.of(&brush)));
                assert!(are_in_range, "{file}, round {round}");
                let numbers = [
                    brush.size,
                    brush.hardness,
                    brush.flow,
                    brush.spacing,
                    brush.rotation,
                    brush.scatter,
                ];
                assert!(numbers.iter().all(|v| v.is_finite()), "{file}, round {round}");
                assert!(
                    brush.size > 0.0
                        && (0.01..=100.0).contains(&brush.spacing)
                        && (0.0..=1.0).contains(&brush.flow)
                );
            }
        }
    }
}
