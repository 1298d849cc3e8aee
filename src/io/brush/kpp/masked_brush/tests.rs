//! Presets with a second brush, built here.

use super::super::read;
use super::super::tests::{GivenFiles, ROUND, kpp, png, read_kpp, texels};
use crate::Budget;
use crate::brush::ImportedBrush;
use crate::paint::dynamics::{DabInputs, Property};
use crate::paint::{DualMode, DualSettings, Tip};
use std::path::Path;

/// A preset of a round tip of 40 px with a masked brush.
fn with_second(second: &str, params: &[(&str, &str)]) -> ImportedBrush {
    let on = [("MaskingBrush/Enabled", "true"), ("MaskingBrush/Preset/brush_definition", second)];
    let all = [&on[..], params];
    let files = GivenFiles(vec![("brushes/tip.png", png(4, 1, &[[0, 0, 0, 255]; 4]))]);
    let bytes = kpp("paintbrush", ROUND, &all.concat());
    read(Path::new("b.kpp"), &bytes, &files, &Budget::default()).unwrap()
}

const SECOND: &str = "<Brush filename=\"tip.png\" scale=\"2\" spacing=\"0.5\" BrushVersion=\"2\"/>";

#[test]
fn a_masked_brush_becomes_a_dual_brush() {
    let imported = with_second(
        SECOND,
        &[
            ("MaskingBrush/MaskingCompositeOp", "linear_burn"),
            ("MaskingBrush/UseMasterSize", "true"),
            ("MaskingBrush/MasterSizeCoeff", "0.25"),
            ("MaskingBrush/Preset/FlowValue", "0.5"),
            ("MaskingBrush/Preset/PressureScatter", "true"),
            ("MaskingBrush/Preset/ScatterValue", "2"),
            ("MaskingBrush/Preset/OpacitySensor", "<params id=\"pressure\"/>"),
            ("MaskingBrush/Preset/PressureMirror", "true"),
            ("PressureScatter", "false"),
            ("OpacityValue", "0.5"),
        ],
    );
    // It acts before both tips meet.
    let value = |property| imported.brush.dynamics.value(property, 1.0, &DabInputs::default());
    assert_eq!((imported.brush.opacity, value(Property::Opacity)), (1.0, 0.5));
    assert_eq!(imported.notes, ["the dabs of its dual brush are not mirrored"]);
    assert_eq!((imported.brush.size, imported.brush.scatter), (40.0, 0.0));
    let dual = imported.brush.dual.as_ref().unwrap();
    let DualSettings { size, flow, spacing, scatter, mode, .. } = dual.settings;
    assert_eq!((size, flow, scatter, mode), (0.25, 0.5, 1.0, DualMode::LinearBurn));
    // Half of the mean of 10 and 2.5 px, of 10 px.
    assert!((spacing - 0.25).abs() < 1e-6, "{spacing}");
    assert!(matches!(dual.tip, Tip::Picture(_)));
    let light = DabInputs { pressure: 0.25, ..DabInputs::default() };
    assert_eq!(dual.dynamics.value(Property::Opacity, 1.0, &light), 0.25);
    assert_eq!(imported.brush.pictures().count(), 1);
}

#[test]
fn the_size_of_a_second_tip_is_its_own_where_the_preset_says_so_and_its_spacing_goes_with_it() {
    let dual = |definition: &str, params: &[(&str, &str)]| {
        with_second(definition, params).brush.dual.unwrap().settings
    };
    let own = dual(SECOND, &[("MaskingBrush/UseMasterSize", "false")]);
    assert_eq!((own.size, own.mode), (0.2, DualMode::Multiply));
    // A root of its size, 90 px, as Krita chooses it.
    let auto = "<Brush useAutoSpacing=\"1\" autoSpacingCoeff=\"1\">\
        <MaskGenerator diameter=\"10\" ratio=\"1\" hfade=\"1\" vfade=\"1\" type=\"circle\"/></Brush>";
    let auto = dual(auto, &[("MaskingBrush/MasterSizeCoeff", "2.25")]);
    assert_eq!(auto.size, 2.25);
    assert!((auto.spacing - 90f32.sqrt() / 90.0).abs() < 1e-5, "{}", auto.spacing);
}

#[test]
fn a_second_tip_that_cannot_be_had_is_left_out_in_words() {
    let missing = with_second("<Brush filename=\"else.png\"/>", &[]);
    assert!(missing.brush.dual.is_none());
    assert_eq!(
        missing.notes,
        ["its dual brush is left out: its tip “else.png” is not in the file or beside it"]
    );
    let odd = with_second(SECOND, &[("MaskingBrush/MaskingCompositeOp", "greater_than")]);
    assert_eq!(odd.notes, ["its dual brush, “greater than” there, multiplies here"]);
    assert_eq!(odd.brush.dual.unwrap().settings.mode, DualMode::Multiply);
    let params =
        [("MaskingBrush/Enabled", "true"), ("MaskingBrush/Preset/brush_definition", SECOND)];
    let smudge = read_kpp(&kpp("colorsmudge", ROUND, &params)).unwrap();
    assert!(smudge.brush.dual.is_none());
    assert!(smudge.notes[0].contains("works on existing paint"), "{:?}", smudge.notes);
    let off = with_second(SECOND, &[("MaskingBrush/Enabled", "false")]);
    assert!(off.brush.dual.is_none() && off.notes.is_empty(), "{:?}", off.notes);
}

#[test]
fn a_stamp_as_a_second_tip_covers_where_it_is_light() {
    let colored = png(2, 1, &[[250, 10, 10, 255], [40, 80, 80, 100]]);
    let second = "<Brush filename=\"tip.png\" BrushVersion=\"2\"/>";
    let params =
        [("MaskingBrush/Enabled", "true"), ("MaskingBrush/Preset/brush_definition", second)];
    let files = GivenFiles(vec![("brushes/tip.png", colored)]);
    let bytes = kpp("paintbrush", ROUND, &params);
    let imported = read(Path::new("b.kpp"), &bytes, &files, &Budget::default()).unwrap();
    // Grays of 92 and 66, the second at 100 of 255.
    assert_eq!(texels(&imported), [[92, 92, 92, 255], [26, 26, 26, 255]]);
}

#[test]
fn numbers_of_a_masked_brush_that_are_none_or_too_large_stay_within_their_ranges() {
    for number in ["NaN", "inf", "-inf", "1e38", "-1e38", "0", "-1", "", "x", "1e-40"] {
        let definition = format!(
            "<Brush filename=\"tip.png\" scale=\"{number}\" spacing=\"{number}\" angle=\"{number}\"/>"
        );
        let names =
            ["MasterSizeCoeff", "Preset/OpacityValue", "Preset/FlowValue", "Preset/ScatterValue"];
        let names = names.map(|name| format!("MaskingBrush/{name}"));
        let relative = ["true", "false"];
        for relative in relative {
            let mut params: Vec<(&str, &str)> =
                names.iter().map(|name| (name.as_str(), number)).collect();
            params.push(("MaskingBrush/UseMasterSize", relative));
            params.push(("MaskingBrush/Preset/PressureScatter", "true"));
            let dual = with_second(&definition, &params).brush.dual.unwrap();
            for setting in DualSettings::SETTINGS {
                let value = (setting.get)(&dual.settings);
                assert!(setting.range.contains(&value), "{number}: {} is {value}", setting.name);
            }
        }
    }
}
