//! Textures of presets built here.

use super::super::tests::{GivenFiles, kpp, pat, png};
use super::*;
use crate::Budget;
use crate::base64::encode;
use crate::brush::ImportedBrush;
use crate::paint::dynamics::DabInputs;
use std::path::Path;

const TIP: &str =
    "<Brush type=\"auto_brush\" spacing=\"0.2\"><MaskGenerator diameter=\"40\"/></Brush>";

/// A preset with a texture of three grays: 0, 51 and 204.
fn read_textured(params: &[(&str, &str)]) -> ImportedBrush {
    let on =
        [("Texture/Pattern/Enabled", "true"), ("Texture/Pattern/PatternFileName", "a/b/p.pat")];
    let params: Vec<_> = on.into_iter().chain(params.iter().copied()).collect();
    let files = GivenFiles(vec![("patterns/p.pat", pat(3, 1, 1, &[0, 51, 204]))]);
    let bytes = kpp("paintbrush", TIP, &params);
    super::super::read(Path::new("b.kpp"), &bytes, &files, &Budget::default()).unwrap()
}

/// The grays of its grain.
fn grays(imported: &ImportedBrush) -> Vec<u8> {
    let Some(BrushGrain { source: GrainSource::Picture(source), .. }) = &imported.brush.grain
    else {
        panic!("no grain: {:?}", imported.notes)
    };
    let Texels::Srgb8(texels) = &source.picture.texels else { panic!("bytes") };
    texels.iter().map(|[v, ..]| *v).collect()
}

#[test]
fn a_texture_that_multiplies_is_the_same_grain() {
    let imported = read_textured(&[("Texture/Pattern/Scale", "4"), ("FlowValue", "0.5")]);
    assert_eq!(grays(&imported), [0, 51, 204]);
    assert_eq!(imported.brush.flow, 0.5);
    assert_eq!(imported.brush.grain.as_ref().unwrap().size_px, 12.0);
    assert!(imported.notes.is_empty(), "{:?}", imported.notes);
    let at = |pressure: f32, params: &[(&str, &str)]| {
        let brush = read_textured(params).brush;
        let inputs = DabInputs { pressure, ..DabInputs::default() };
        brush.dynamics.value(Property::Flow, brush.flow, &inputs)
    };
    let sensor = "<params id=\"pressure\"><curve>0,0;1,1;</curve></params>";
    let followed = [
        ("PressureTexture/Strength/", "true"),
        ("Texture/Strength/Value", "0.5"),
        ("Texture/Strength/Sensor", sensor),
    ];
    // The strength, times the pressure.
    assert!((at(0.25, &followed) - 0.5 * 0.25).abs() < 1e-5);
    let twice = [&followed[..], &[("PressureFlow", "true"), ("FlowSensor", sensor)]].concat();
    assert!((at(0.25, &twice) - 0.5 * 0.25 * 0.25).abs() < 1e-5, "both follow the pressure");
}

#[test]
fn the_grays_of_a_pattern_are_changed_first() {
    let of = |params: &[(&str, &str)]| grays(&read_textured(params));
    assert_eq!(of(&[("Texture/Pattern/Invert", "true")]), [255, 204, 51]);
    // (v − 0.2 − 0.5) · 2 + 0.5: the last is 0.7.
    let params = [("Texture/Pattern/Brightness", "0.2"), ("Texture/Pattern/Contrast", "2")];
    assert_eq!(of(&params), [0, 0, 179]);
    let params = [
        ("Texture/Pattern/NeutralPoint", "0.8"),
        ("Texture/Pattern/CutoffPolicy", "2"),
        ("Texture/Pattern/CutoffRight", "100"),
    ];
    assert_eq!(of(&params), [0, 32, 255], "0.2 of 0.8 is an eighth; 0.5 is beyond, and white");
    let params = [("Texture/Pattern/CutoffPolicy", "1"), ("Texture/Pattern/CutoffLeft", "60")];
    assert_eq!(of(&params), [0, 0, 204]);
    assert_eq!(of(&[("Texture/Pattern/OffsetX", "1")]), [204, 0, 51], "moved to the right");
    let random = read_textured(&[
        ("Texture/Pattern/isRandomOffsetX", "true"),
        ("Texture/Pattern/isRandomOffsetY", "true"),
        ("Texture/Pattern/OffsetX", "1"),
    ]);
    assert_eq!(random.notes, ["its texture lies at the same place for every stroke"]);
    assert_eq!(grays(&random), [0, 51, 204]);
}

#[test]
fn other_ways_are_told_of_and_come_as_near_as_grain_can() {
    let of = |mode: &str, strength: &str| {
        read_textured(&[
            ("Texture/Pattern/TexturingMode", mode),
            ("Texture/Strength/Value", strength),
        ])
    };
    let subtracted = of("1", "0.5");
    // 0.5, 0.3 and nothing.
    assert_eq!((grays(&subtracted), subtracted.brush.flow), (vec![255, 153, 0], 0.5));
    assert_eq!(
        subtracted.notes,
        ["its texture, “subtract” there, takes paint away in proportion here"]
    );
    let color = of("2", "1");
    assert!(color.brush.grain.is_none());
    assert_eq!(
        color.notes,
        ["its texture changes the color there (“lightness”), which is left out"]
    );
    assert!(of("16", "1").notes[0].contains("“16”"));
    for (mode, (name, _)) in MODES.iter().enumerate().skip(4) {
        let imported = of(&mode.to_string(), "0.4");
        assert!(imported.notes[0].contains(name), "{:?}", imported.notes);
        let grays = grays(&imported);
        assert!(grays[0] != grays[2] || mode > 13, "{name}: {grays:?}");
        assert!(grays.iter().any(|v| *v > 0), "{name} paints");
        assert!((0.0..=1.0).contains(&imported.brush.flow), "{name}");
    }
    let soft = read_textured(&[
        ("Texture/Pattern/UseSoftTexturing", "true"),
        ("Texture/Strength/Value", "0.5"),
    ]);
    // 1 − 0.5 (1 − t): 0.5, 0.6 and 0.9.
    assert_eq!((grays(&soft), soft.brush.flow), (vec![128, 153, 230], 1.0));
}

#[test]
fn what_a_texture_leaves_is_a_share() {
    for (_, mode) in MODES {
        for t in 0..=20u8 {
            for s in 0..=20u8 {
                let left = mode.share_at(f32::from(t) / 20.0, f32::from(s) / 20.0);
                assert!((0.0..=1.0).contains(&left), "{mode:?} {t} {s}: {left}");
            }
        }
    }
    let near = |a: f32, b: f32| (a - b).abs() < 1e-6;
    assert!(near(TextureMode::Subtract.share_at(0.3, 1.0), 0.7));
    assert!(near(TextureMode::LinearBurn.share_at(0.3, 0.9), 0.2));
    assert!(near(TextureMode::Overlay.share_at(0.3, 1.0), 0.3));
    assert!(near(TextureMode::SofterMix.share_at(0.5, 1.0), 0.5));
    assert!(near(TextureMode::PhotoshopHeight.share_at(0.3, 0.1), 0.7));
    assert!(near(TextureMode::PhotoshopLinearHeight.share_at(0.5, 0.05), 0.25));
}

#[test]
fn a_pattern_within_the_settings_is_read_once_or_twice_encoded() {
    let picture = png(2, 1, &[[0, 0, 0, 255], [255, 255, 255, 255]]);
    let once = encode(&picture);
    for text in [once.clone(), encode(once.as_bytes())] {
        let imported = read_textured(&[("Texture/Pattern/Pattern", &text)]);
        assert_eq!(grays(&imported), [0, 255]);
    }
    let clear = encode(&png(2, 1, &[[0, 0, 0, 0], [0, 0, 0, 255]]));
    assert_eq!(
        grays(&read_textured(&[("Texture/Pattern/Pattern", &clear)])),
        [255, 0],
        "clear is white"
    );
    let missing = [("Texture/Pattern/PatternFileName", "C:\\else.pat")];
    assert_eq!(
        read_textured(&missing).notes,
        ["the pattern of its texture “else.pat” is not in the file or beside it"]
    );
}
