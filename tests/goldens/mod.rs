//! Reference pictures: what each blend mode, operator and filter, shading model, mask and tip looks
//! like, and what the recipes of the gallery look like. Each is made again and compared, with a
//! tolerance given next to its recipe.
//!
//! `UPDATE_GOLDEN=1 cargo test --test program goldens` accepts what has changed; `CONTRIBUTING.md`
//! says more.
//!
//! The other tests check this one: a shift by a pixel is found, and no picture passes for another.

mod cases;
mod compare;
mod gallery;
mod pictures;
mod sheets;
mod surfaces;

use cases::Case;
use compare::{Difference, Found, Place};
use image::{Rgba, RgbaImage};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// The most bytes of all reference pictures together, and the most pictures: people look at them.
const MOST_BYTES: u64 = 4 << 20;
const MOST_PICTURES: usize = 80;

/// The reference pictures, next to this file.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/goldens")
}

/// How much each case differs from its picture. Computed once, before any other test reads the
/// pictures, since this may accept new ones.
static FAULTS: LazyLock<Vec<String>> = LazyLock::new(|| {
    let check = |case: &Case| {
        compare::check(&folder(), &case.name, &case.place, &case.rendered(), case.tolerance).err()
    };
    cases::all().iter().filter_map(check).collect()
});

fn golden(case: &Case) -> RgbaImage {
    LazyLock::force(&FAULTS);
    compare::stored(&folder(), &case.place).unwrap_or_else(|e| panic!("{}: {e}", case.name))
}

#[test]
fn every_case_looks_as_its_reference_picture() {
    assert!(FAULTS.is_empty(), "{}\n{}", FAULTS.join("\n"), compare::HOW_TO_ACCEPT);
}

#[test]
fn every_reference_picture_belongs_to_a_case_and_all_are_light() {
    LazyLock::force(&FAULTS);
    let mut known: BTreeSet<String> =
        cases::all().into_iter().map(|case| case.place.file).collect();
    known.extend(gallery::LOSSLESS.map(|name| format!("gallery/{name}")));
    let (mut bytes, mut stored) = (0, BTreeSet::new());
    for group in std::fs::read_dir(folder())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_dir())
    {
        for picture in std::fs::read_dir(&group).unwrap().map(|entry| entry.unwrap().path()) {
            bytes += picture.metadata().unwrap().len();
            let name = picture.strip_prefix(folder()).unwrap().with_extension("");
            stored.insert(name.to_string_lossy().replace('\\', "/"));
        }
    }
    assert_eq!(
        stored, known,
        "one picture a case or a sheet (UPDATE_GOLDEN=1 makes those that are missing)"
    );
    assert!(stored.len() <= MOST_PICTURES, "{} pictures", stored.len());
    assert!(bytes <= MOST_BYTES, "{bytes} bytes");
}

#[test]
fn a_shift_by_one_pixel_is_found_in_every_picture() {
    for case in cases::all() {
        let golden = golden(&case);
        for (dx, dy) in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
            let Difference { largest, pixels, .. } =
                Difference::of(&compare::moved(&golden, dx, dy), &golden, case.tolerance);
            assert!(
                largest > 4 * case.tolerance.max(1) && pixels > 20,
                "{}, moved by {dx}, {dy}: only {pixels} pixels differ, by {largest} at most",
                case.name
            );
        }
    }
}

#[test]
fn no_two_cases_look_alike() {
    let with_picture = |case: Case| {
        let picture = golden(&case);
        (case, picture)
    };
    let goldens: Vec<(Case, RgbaImage)> = cases::all().into_iter().map(with_picture).collect();
    for (i, (a, picture)) in goldens.iter().enumerate() {
        // Cells of one sheet with each other, and pictures of their own.
        let is_beside =
            |b: &Case| a.place.file == b.place.file || !(a.place.is_tile() || b.place.is_tile());
        let beside = goldens[..i].iter().filter(|(b, _)| is_beside(b));
        for (b, other) in beside.filter(|(_, other)| other.dimensions() == picture.dimensions()) {
            let Difference { pixels, .. } =
                Difference::of(picture, other, a.tolerance.max(b.tolerance));
            assert!(pixels > 20, "{} and {} differ in {pixels} pixels only", a.name, b.name);
        }
    }
}

#[test]
fn a_fault_is_told_with_its_place_and_a_picture() {
    let expected = RgbaImage::from_pixel(20, 10, Rgba([90, 100, 110, 255]));
    let mut found = expected.clone();
    found.put_pixel(12, 7, Rgba([90, 140, 110, 255]));
    found.put_pixel(3, 2, Rgba([90, 103, 110, 255]));
    let scratch = tempfile::tempdir().unwrap();
    let told = |tolerance| {
        let scratch = Found {
            references: scratch.path(),
            faults: &scratch.path().join("faults"),
            accept: false,
        };
        scratch.check("a/b", &Place::alone("a/b"), &found, tolerance)
    };
    std::fs::create_dir(scratch.path().join("a")).unwrap();
    expected.save(scratch.path().join("a/b.png")).unwrap();
    let sentence = told(3).unwrap_err();
    assert!(
        sentence.contains("by up to 40 at (12, 7)") && sentence.contains("1 pixel"),
        "{sentence}"
    );
    assert!(told(2).unwrap_err().contains("2 pixels"));
    assert_eq!(told(40), Ok(()));
    let shown = image::open(scratch.path().join("faults/a/b.png")).unwrap().to_rgba8();
    assert_eq!(shown.dimensions(), (3 * 20 + 2 * compare::GAP, 10), "found, expected, difference");
}

#[test]
fn a_tile_of_a_sheet_is_accepted_alone_and_read_back() {
    let scratch = tempfile::tempdir().unwrap();
    let colors = [[200, 0, 0, 255], [0, 150, 0, 255], [0, 0, 90, 128]]
        .map(|c| RgbaImage::from_pixel(6, 6, Rgba(c)));
    let check = |tile: u32, found: &RgbaImage, accept: bool| {
        let faults = scratch.path().join("faults");
        let place = Place::tile("a/sheet", tile, 6);
        Found { references: scratch.path(), faults: &faults, accept }.check(
            &format!("a/{tile}"),
            &place,
            found,
            0,
        )
    };
    // The last one first: the sheet grows by rows.
    for (tile, color) in [(9, &colors[2]), (0, &colors[0]), (3, &colors[1])] {
        assert!(check(tile, color, false).is_err(), "it is not stored yet");
        assert_eq!(check(tile, color, true), Ok(()));
    }
    for (tile, color) in [(9, &colors[2]), (0, &colors[0]), (3, &colors[1])] {
        assert_eq!(check(tile, color, false), Ok(()));
    }
    let said = check(3, &colors[0], false).unwrap_err();
    assert!(said.starts_with("a/3: 36 pixels differ"), "{said}");
}
