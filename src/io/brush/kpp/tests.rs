//! Presets built here, chunk by chunk.

use super::super::abr;
use super::*;
use crate::brush::{NoBrushFiles, ResourceKind};
use crate::paint::dynamics::{DabInputs, Input, Property};
use crate::paint::tip::RankSelect;
use crate::paint::{PictureSource, Tip};
use crate::raster::picture::Texels;

/// A PNG of one pixel with these settings.
pub fn kpp(engine: &str, definition: &str, params: &[(&str, &str)]) -> Vec<u8> {
    holding_kpp(engine, definition, params, "")
}

/// The same with files in it.
fn holding_kpp(
    engine: &str,
    definition: &str,
    params: &[(&str, &str)],
    resources: &str,
) -> Vec<u8> {
    let param = |(name, value): &(&str, &str)| {
        format!("<param name=\"{name}\" type=\"string\"><![CDATA[{value}]]></param>")
    };
    let params: String =
        params.iter().chain([&("brush_definition", definition)]).map(param).collect();
    let text = format!(
        "<Preset paintopid=\"{engine}\" name=\"b) Basic\">\
         <resources>{resources}</resources>{params}</Preset>"
    );
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, 1, 1);
    encoder.add_ztxt_chunk("preset".to_owned(), text).unwrap();
    encoder.write_header().unwrap().write_image_data(&[0]).unwrap();
    out
}

/// A PNG of these pixels.
pub fn png(width: u32, height: u32, texels: &[[u8; 4]]) -> Vec<u8> {
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.write_header().unwrap().write_image_data(texels.as_flattened()).unwrap();
    out
}

/// A GIMP brush of coverage.
pub fn gray_gbr(width: u32, height: u32, pixels: &[u8]) -> Vec<u8> {
    let words = |n: &[u32]| -> Vec<u8> { n.iter().flat_map(|n| n.to_be_bytes()).collect() };
    [&words(&[32, 2, width, height, 1])[..], b"GIMP", &words(&[25]), b"Tip\0", pixels].concat()
}

/// A GIMP pattern.
pub fn pat(width: u32, height: u32, channels: u32, texels: &[u8]) -> Vec<u8> {
    let header: Vec<u8> =
        [26, 1, width, height, channels].iter().flat_map(|n: &u32| n.to_be_bytes()).collect();
    [&header[..], b"GPAT", b"P\0", texels].concat()
}

/// Files given by their folders and names.
pub struct GivenFiles(pub Vec<(&'static str, Vec<u8>)>);

impl BrushFiles for GivenFiles {
    fn find(&self, kind: ResourceKind, name: &str, _: &Budget) -> Result<Option<Vec<u8>>> {
        let wanted = format!("{}/{name}", kind.folder());
        Ok(self.0.iter().find(|(name, _)| *name == wanted).map(|(_, bytes)| bytes.clone()))
    }
}

/// A preset of one of these tips, which is `brushes/tip.ENDING`.
fn with_tip(ending: &'static str, tip: Vec<u8>, attributes: &str) -> ImportedBrush {
    let name: &'static str = match ending {
        "gbr" => "brushes/tip.gbr",
        "gih" => "brushes/tip.gih",
        "svg" => "brushes/tip.svg",
        _ => "brushes/tip.png",
    };
    let definition = format!("<Brush filename=\"tip.{ending}\" BrushVersion=\"2\" {attributes}/>");
    let bytes = kpp("paintbrush", &definition, &[]);
    read(Path::new("b.kpp"), &bytes, &GivenFiles(vec![(name, tip)]), &Budget::default()).unwrap()
}

/// The pixels of its pictures, one after the other.
pub fn texels(imported: &ImportedBrush) -> Vec<[u8; 4]> {
    let of = |source: &PictureSource| match &source.picture.texels {
        Texels::Srgb8(texels) => texels.to_vec(),
        Texels::Linear(_) => panic!("tips hold bytes"),
    };
    imported.brush.pictures().flat_map(of).collect()
}

pub const ROUND: &str = "<Brush type=\"auto_brush\" spacing=\"0.2\" angle=\"0\" useAutoSpacing=\"0\">\
    <MaskGenerator diameter=\"40\" ratio=\"0.5\" hfade=\"0.5\" vfade=\"0.7\" spikes=\"2\" type=\"circle\"/></Brush>";
pub fn read_kpp(bytes: &[u8]) -> Result<ImportedBrush> {
    read(Path::new("b.kpp"), bytes, &NoBrushFiles, &Budget::default())
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
    assert_eq!(notes, ["its tip “chalk.png” is not in the file or beside it; it is round here"]);
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

#[test]
fn a_tip_of_grays_covers_where_it_is_dark() {
    let tip = png(2, 1, &[[0, 0, 0, 255], [200, 200, 200, 255]]);
    let imported = with_tip("png", tip, "scale=\"3\" spacing=\"0.5\" angle=\"1.5707964\"");
    assert_eq!(texels(&imported), [[255; 4], [55, 55, 55, 255]]);
    assert_eq!((imported.brush.size, imported.brush.rotation.round()), (6.0, 90.0));
    assert!(imported.notes.is_empty(), "{:?}", imported.notes);
    let clear = with_tip("png", png(1, 1, &[[0, 0, 0, 102]]), "");
    assert_eq!(texels(&clear), [[102, 102, 102, 255]], "its alpha covers too");
    let gimp = with_tip("gbr", gray_gbr(2, 1, &[10, 250]), "");
    assert_eq!(texels(&gimp), [[10, 10, 10, 255], [250, 250, 250, 255]], "GIMP's light ones cover");
}

#[test]
fn dabs_are_as_far_apart_as_krita_places_them() {
    let tip = || png(4, 1, &[[0, 0, 0, 255]; 4]);
    let spacing = |attributes: &str| with_tip("png", tip(), attributes).brush.spacing;
    // The mean of 4 and 1 px, of a diameter of 4 px.
    assert!((spacing("spacing=\"0.5\"") - 0.5 * 2.0 / 4.0).abs() < 1e-6);
    let auto = spacing("scale=\"4\" useAutoSpacing=\"1\" autoSpacingCoeff=\"2\"");
    assert!((auto - 2.0 * 8f32.sqrt() / 16.0).abs() < 1e-6, "{auto}");
    let first = "<Brush filename=\"tip.png\" scale=\"1\"/>";
    let files = GivenFiles(vec![("brushes/tip.png", tip())]);
    let first =
        read(Path::new("b.kpp"), &kpp("paintbrush", first, &[]), &files, &Budget::default());
    assert_eq!(first.unwrap().brush.size, 8.0, "the first version counts radii");
}

#[test]
fn a_tip_of_colors_stamps_or_covers_as_the_preset_says() {
    let colored = || png(2, 1, &[[250, 10, 10, 255], [40, 80, 80, 100]]);
    let look = |attributes: &str| {
        let imported = with_tip("png", colored(), attributes);
        (texels(&imported), imported.notes)
    };
    let stamp = (vec![[250, 10, 10, 255], [40, 80, 80, 100]], Vec::new());
    for attributes in ["", "ColorAsMask=\"0\"", "brushApplication=\"1\" ColorAsMask=\"1\""] {
        assert_eq!(look(attributes), stamp, "{attributes}");
    }
    // Their grays are (11 r + 16 g + 5 b) / 32: 92 and 66.
    let mask = (vec![[163, 163, 163, 255], [74, 74, 74, 255]], Vec::new());
    for attributes in ["ColorAsMask=\"1\"", "brushApplication=\"0\""] {
        assert_eq!(look(attributes), mask, "{attributes}");
    }
    let (alpha, notes) = look("brushApplication=\"2\"");
    assert_eq!(alpha, [[255; 4], [100, 100, 100, 255]]);
    assert_eq!(notes, ["its tip also lightens and darkens the color there"]);
    assert_eq!(look("ColorAsMask=\"1\" preserveLightness=\"1\"").1, notes);
    assert!(look("brushApplication=\"3\"").1[0].contains("gradient"));
}

#[test]
fn grays_of_a_colored_tip_are_changed_as_the_preset_says() {
    let tip = png(3, 1, &[[127, 127, 127, 255], [0, 0, 0, 255], [255, 254, 255, 255]]);
    let look = |attributes: &str| {
        let attributes = format!("brushApplication=\"0\" {attributes}");
        let texels = texels(&with_tip("png", tip.clone(), &attributes));
        texels.into_iter().map(|[v, ..]| v).collect::<Vec<_>>()
    };
    assert_eq!(look("BrightnessAdjustment=\"0.5\""), [64, 255, 0], "the middle goes to 191");
    assert_eq!(look("ContrastAdjustment=\"-1\""), [127, 127, 127], "all become the middle");
}

#[test]
fn a_hose_and_a_drawing_are_tips_too() {
    let cells = [gray_gbr(2, 2, &[9; 4]), gray_gbr(1, 1, &[200])].concat();
    let hose = [b"Leaves\n2 rank0:2 sel0:random\n".to_vec(), cells].concat();
    let imported = with_tip("gih", hose, "scale=\"5\"");
    let Tip::Hose(hose) = &imported.brush.tip else { panic!("a hose") };
    assert_eq!((hose.pictures().len(), hose.ranks()[0].select), (2, RankSelect::Random));
    assert_eq!((imported.brush.size, texels(&imported)[4]), (10.0, [200, 200, 200, 255]));
    let svg = b"<svg xmlns='http://www.w3.org/2000/svg' width='40' height='20'>\
        <rect width='40' height='20'/></svg>";
    let imported = with_tip("svg", svg.to_vec(), "scale=\"0.5\"");
    assert_eq!(imported.brush.size, 20.0, "half of its own size");
    let size = imported.brush.pictures().next().unwrap().picture.size;
    assert_eq!((size.width, size.height), (1024, 512));
    assert_eq!(texels(&imported)[5000], [255; 4]);
}

#[test]
fn a_tip_within_the_preset_comes_before_others_and_names_stay_within_the_folders() {
    use crate::base64::encode;
    let inner = format!("{}=\n", encode(&gray_gbr(1, 1, &[77])));
    let held = format!(
        "<resource type=\"brushes\" name=\"Tip\" filename=\"tip.gbr\"><![CDATA[{inner}]]></resource>"
    );
    let definition = "<Brush type=\"gbr_brush\" filename=\"tip.gbr\" BrushVersion=\"2\"/>";
    let bytes = holding_kpp("paintbrush", definition, &[], &held);
    let files = GivenFiles(vec![("brushes/tip.gbr", gray_gbr(1, 1, &[5]))]);
    let imported = read(Path::new("b.kpp"), &bytes, &files, &Budget::default()).unwrap();
    assert_eq!(texels(&imported), [[77, 77, 77, 255]]);
    for (name, said) in [
        ("../../secret.png", "its tip “../../secret.png” is not in the file or beside it"),
        ("..", "its tip “..” is no name of a file"),
        ("/etc/", "its tip “/etc/” is no name of a file"),
    ] {
        let definition = format!("<Brush filename=\"{name}\"/>");
        let notes = read_kpp(&kpp("paintbrush", &definition, &[])).unwrap().notes;
        assert_eq!(notes, [format!("{said}; it is round here")]);
    }
    let damaged = with_tip("gbr", b"nothing".to_vec(), "");
    assert!(matches!(damaged.brush.tip, Tip::Round));
    let place = Path::new("b.kpp").join("tip.gbr");
    let said = format!("{}: cannot be read: the brush is cut short", place.display());
    let said = format!("its tip “tip.gbr” cannot be used ({said}); it is round here");
    assert_eq!(damaged.notes, [said]);
}

#[test]
fn a_tip_of_a_photoshop_collection_is_named_by_its_number() {
    let definition = "<Brush type=\"abr_brush\" filename=\"Set of 2_2\" BrushVersion=\"2\"/>";
    let abr = crate::brush::tests::photoshop::new_abr(1);
    let files = GivenFiles(vec![("brushes/Set of 2.abr", abr.clone())]);
    let bytes = kpp("paintbrush", definition, &[]);
    let imported = read(Path::new("b.kpp"), &bytes, &files, &Budget::default()).unwrap();
    let tips = abr::read_tips(Path::new("a.abr"), &abr, &Budget::default()).unwrap();
    let Tip::Picture(source) = &imported.brush.tip else { panic!("{:?}", imported.notes) };
    assert_eq!(source.picture, tips[1]);
}

#[test]
fn one_curve_for_all_sensors_takes_the_place_of_theirs() {
    let sensor = "<params id=\"pressure\"><curve>0,0;1,1;</curve></params>";
    let params = [
        ("PressureSize", "true"),
        ("SizeSensor", sensor),
        ("SizeUseSameCurve", "true"),
        ("SizecommonCurve", "0,0.5;1,0.5;"),
    ];
    let brush = read_kpp(&kpp("paintbrush", ROUND, &params)).unwrap().brush;
    assert_eq!(brush.dynamics.value(Property::Size, 1.0, &DabInputs::default()), 0.5);
}

#[test]
fn numbers_that_are_none_or_too_large_stay_within_their_ranges() {
    use crate::paint::settings::SETTINGS;
    let files = GivenFiles(vec![
        ("brushes/tip.png", png(3, 1, &[[9, 8, 7, 6]; 3])),
        ("patterns/p.pat", pat(3, 1, 1, &[0, 51, 204])),
    ]);
    for number in ["NaN", "inf", "-inf", "1e38", "-1e38", "0", "-1", "", "x", "1e-40"] {
        let attributes = [
            "scale",
            "spacing",
            "angle",
            "autoSpacingCoeff",
            "BrightnessAdjustment",
            "ContrastAdjustment",
            "AdjustmentMidPoint",
        ]
        .map(|name| format!("{name}=\"{number}\" "))
        .concat();
        let keys = [
            "Scale",
            "Brightness",
            "Contrast",
            "NeutralPoint",
            "CutoffLeft",
            "CutoffRight",
            "CutoffPolicy",
            "OffsetX",
            "OffsetY",
        ]
        .map(|name| format!("Texture/Pattern/{name}"));
        let mut params = vec![
            ("Texture/Pattern/Enabled", "true"),
            ("Texture/Pattern/Name", "p.pat"),
            ("OpacityValue", number),
            ("FlowValue", number),
            ("Texture/Strength/Value", number),
        ];
        params.extend(keys.iter().map(|key| (key.as_str(), number)));
        for auto in ["0", "1"] {
            let definition = format!(
                "<Brush filename=\"tip.png\" useAutoSpacing=\"{auto}\" brushApplication=\"0\" {attributes}/>"
            );
            let bytes = kpp("paintbrush", &definition, &params);
            let brush = read(Path::new("b.kpp"), &bytes, &files, &Budget::default()).unwrap().brush;
            for setting in SETTINGS {
                assert!(
                    setting.number.range.contains(&setting.of(&brush)),
                    "{number}: {}",
                    setting.number.name
                );
            }
            let grain = brush.grain.unwrap();
            assert!(crate::paint::grain::BrushGrain::SIZE_PX.contains(&grain.size_px), "{number}");
            assert!(brush.rotation.is_finite());
        }
    }
}

#[test]
fn opacity_and_flow_follow_their_sensors_unless_the_preset_says_no() {
    let sensor = "<params id=\"pressure\"/>";
    let at = |params: &[(&str, &str)]| {
        let params = [&[("OpacitySensor", sensor), ("FlowSensor", sensor)], params].concat();
        let brush = read_kpp(&kpp("paintbrush", ROUND, &params)).unwrap().brush;
        let light = DabInputs { pressure: 0.5, ..DabInputs::default() };
        let value = |property| brush.dynamics.value(property, 1.0, &light);
        (brush.opacity, brush.flow, value(Property::Opacity), value(Property::Flow))
    };
    assert_eq!(at(&[]), (1.0, 1.0, 0.5, 0.5));
    assert_eq!(
        at(&[("PressureOpacity", "false"), ("FlowUseCurve", "false")]),
        (1.0, 1.0, 1.0, 1.0)
    );
    // Each dab has its opacity.
    let built_up = [("PaintOpAction", "1"), ("OpacityValue", "0.5"), ("FlowValue", "0.5")];
    assert_eq!(at(&built_up), (1.0, 0.25, 1.0, 0.25));
}

#[test]
fn what_fades_along_the_stroke_fades_over_its_length() {
    let at = |sensor: &str, distance: f32| {
        let params = [("PressureSize", "true"), ("SizeSensor", sensor)];
        let brush = read_kpp(&kpp("paintbrush", ROUND, &params)).unwrap().brush;
        let inputs = DabInputs { distance, ..DabInputs::default() };
        brush.dynamics.value(Property::Size, 1.0, &inputs)
    };
    // A brush of 40 px counts to 400 px.
    let half = "<params id=\"distance\" length=\"200\"><curve>0,1;1,0;</curve></params>";
    assert_eq!((at(half, 0.25), at(half, 0.5), at(half, 1.0)), (0.5, 0.0, 0.0));
    // 100 dabs of 8 px.
    let twice = "<params id=\"fade\" length=\"100\"/>";
    assert_eq!((at(twice, 0.5), at(twice, 1.0)), (0.25, 0.5));
}

#[test]
fn sensors_that_do_not_multiply_are_told_of() {
    let both = "<params id=\"sensorslist\"><ChildSensor id=\"pressure\"/><ChildSensor id=\"speed\"/></params>";
    let params = [("PressureSize", "true"), ("SizeSensor", both), ("SizecurveMode", "1")];
    let notes = read_kpp(&kpp("paintbrush", ROUND, &params)).unwrap().notes;
    assert_eq!(notes, ["what its size follows multiplies here"]);
}

#[test]
fn a_preset_keeps_its_blend_mode_or_tells_of_it() {
    let read = |op: &str| {
        let imported = read_kpp(&kpp("paintbrush", ROUND, &[("CompositeOp", op)])).unwrap();
        (imported.brush.blend, imported.notes)
    };
    assert_eq!(read("dodge"), (BlendMode::ColorDodge, Vec::new()));
    let (blend, notes) = read("tangent_normalmap");
    assert_eq!(blend, BlendMode::Normal);
    assert_eq!(notes, ["its blend mode “tangent_normalmap” has no counterpart"]);
    assert!(read("erase").1.is_empty());
}

#[test]
fn a_pen_that_leans_lowers_its_declination() {
    let sensor = "<params id=\"declination\"><curve>0,0.2;1,1;</curve></params>";
    let params = [("PressureSize", "true"), ("SizeSensor", sensor)];
    let brush = read_kpp(&kpp("paintbrush", ROUND, &params)).unwrap().brush;
    let at = |tilt: f32| {
        let inputs = DabInputs { tilt, ..DabInputs::default() };
        brush.dynamics.value(Property::Size, 1.0, &inputs)
    };
    let near = |a: f32, b: f32| (a - b).abs() < 0.01;
    assert!(near(at(0.0), 1.0) && near(at(0.7), 0.2) && near(at(1.0), 0.2));
    // At 30°, half of 60°, acos ½ is two thirds of a right angle.
    assert!(near(at(1.0 / 3.0), 0.2 + 0.8 * 2.0 / 3.0), "{}", at(1.0 / 3.0));
}
