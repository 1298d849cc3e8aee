//! Presets built here, chunk by chunk.

use super::*;
use crate::paint::dynamics::{DabInputs, Input};

/// A PNG of one pixel with these settings.
fn kpp(engine: &str, definition: &str, params: &[(&str, &str)]) -> Vec<u8> {
    let param = |(name, value): &(&str, &str)| {
        format!("<param name=\"{name}\" type=\"string\"><![CDATA[{value}]]></param>")
    };
    let params: String =
        params.iter().chain([&("brush_definition", definition)]).map(param).collect();
    let text = format!("<Preset paintopid=\"{engine}\" name=\"b) Basic\">{params}</Preset>");
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, 1, 1);
    encoder.add_ztxt_chunk("preset".to_owned(), text).unwrap();
    encoder.write_header().unwrap().write_image_data(&[0]).unwrap();
    out
}
const ROUND: &str = "<Brush type=\"auto_brush\" spacing=\"0.2\" angle=\"0\" useAutoSpacing=\"0\">\
    <MaskGenerator diameter=\"40\" ratio=\"0.5\" hfade=\"0.5\" vfade=\"0.7\" spikes=\"2\" type=\"circle\"/></Brush>";
fn read_kpp(bytes: &[u8]) -> Result<ImportedBrush> {
    read(Path::new("b.kpp"), bytes, &Budget::default())
}

#[test]
fn a_pixel_preset_is_read_with_what_follows_the_pressure() {
    let bytes = kpp(
        "paintbrush",
        ROUND,
        &[
            ("OpacityValue", "0.8"),
            ("FlowValue", "0.5"),
            ("PressureSize", "true"),
            ("SizeSensor", "<params id=\"pressure\"> <curve>0,0.2;0.5,0.5;1,1;</curve> </params>"),
            ("PressureOpacity", "true"),
            (
                "OpacitySensor",
                "<params id=\"sensorslist\"><ChildSensor id=\"pressure\"/>\
                    <ChildSensor id=\"tangentialpressure\"/></params>",
            ),
            ("PressureRotation", "false"),
            ("RotationSensor", "<params id=\"fuzzy\"/>"),
        ],
    );
    let ImportedBrush { name, brush, notes } = read_kpp(&bytes).unwrap();
    assert_eq!(
        (name.as_str(), brush.size, brush.spacing, brush.hardness),
        ("b) Basic", 40.0, 0.2, 0.6)
    );
    assert_eq!((brush.opacity, brush.flow), (0.8, 0.5));
    assert!(matches!(brush.tip, Tip::Ellipse { ratio: 0.5 }));
    let light = DabInputs { pressure: 0.25, ..DabInputs::default() };
    assert!((brush.dynamics.value(Property::Size, 1.0, &light) - 0.35).abs() < 1e-5);
    assert_eq!(brush.dynamics.value(Property::Opacity, 1.0, &light), 0.25);
    assert!(
        brush.dynamics.curve(Property::Rotation, Input::Random).is_none(),
        "it is switched off"
    );
    assert_eq!(notes, ["nothing here follows “tangentialpressure”"]);
}

#[test]
fn a_smudge_preset_takes_paint_up_and_an_eraser_takes_it_away() {
    let smudge = kpp(
        "colorsmudge",
        ROUND,
        &[("PressureColorRate", "true"), ("ColorRateValue", "0.25"), ("SmudgeRateValue", "0.9")],
    );
    let pickup = read_kpp(&smudge).unwrap().brush.pickup;
    assert_eq!((pickup.amount, pickup.length), (0.75, 0.9));
    assert!(read_kpp(&kpp("paintbrush", ROUND, &[("CompositeOp", "erase")])).unwrap().brush.erases);
}

#[test]
fn spacing_that_krita_chooses_is_a_root_of_the_size_and_tips_elsewhere_are_told_of() {
    let auto = "<Brush type=\"png_brush\" filename=\"chalk.png\" useAutoSpacing=\"1\" autoSpacingCoeff=\"0.8\"/>";
    let ImportedBrush { brush, notes, .. } = read_kpp(&kpp("paintbrush", auto, &[])).unwrap();
    assert!((brush.spacing - 0.8 / brush.size.sqrt()).abs() < 1e-5);
    assert_eq!(notes, ["its tip “chalk.png” is not in the file; it is round here"]);
}

#[test]
fn other_engines_and_other_pictures_are_refused_in_words() {
    let said = |bytes: &[u8]| read_kpp(bytes).map(|_| ()).unwrap_err().to_string();
    assert!(said(&kpp("sketchbrush", ROUND, &[])).contains("sketchbrush"));
    assert!(said(b"nothing").contains("no Krita preset"));
    let mut plain = Vec::new();
    png::Encoder::new(&mut plain, 1, 1).write_header().unwrap().write_image_data(&[0]).unwrap();
    assert!(said(&plain).contains("without a Krita preset"));
}
