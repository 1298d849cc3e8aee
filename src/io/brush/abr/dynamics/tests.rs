use super::*;
use crate::paint::dynamics::DabInputs;
use crate::psd::descriptor::DescriptorValue::{Flag, Number, Object, Text, Word};
use crate::psd::descriptor::{DescriptorObject, DescriptorValue};

type Values = Vec<(&'static str, DescriptorValue)>;

fn part(control: i32, jitter: f64, least: f64) -> DescriptorValue {
    let values = vec![
        ("bVTy", Number(control.into())),
        ("fStp", Number(25.0)),
        ("jitter", Number(jitter)),
        ("Mnm ", Number(least)),
    ];
    Object(DescriptorObject::of(values))
}

fn convert(values: Values) -> (Brush, Vec<String>) {
    let preset = DescriptorObject::of(values);
    let AbrConversion { brush, notes, .. } = with_dynamics(&preset, Brush::default(), Vec::new());
    (brush, notes)
}

fn at(brush: &Brush, property: Property, pressure: f32) -> f32 {
    brush.dynamics.value(property, 1.0, &DabInputs { pressure, ..DabInputs::default() })
}

#[test]
fn shape_and_transfer_follow_the_pen_down_to_their_minimum() {
    let (brush, notes) = convert(vec![
        ("useTipDynamics", Flag(true)),
        // The part says 0 where the brush says more.
        ("minimumDiameter", Number(40.0)),
        ("szVr", part(2, 0.0, 0.0)),
        ("angleDynamics", part(6, 0.0, 0.0)),
        ("usePaintDynamics", Flag(true)),
        ("opVr", part(2, 0.0, 25.0)),
        ("prVr", part(0, 50.0, 0.0)),
    ]);
    assert_eq!(notes, [""; 0]);
    assert!(
        (at(&brush, Property::Size, 0.0) - 0.4).abs() < 1e-6
            && at(&brush, Property::Size, 1.0) == 1.0
    );
    assert!((at(&brush, Property::Opacity, 0.0) - 0.25).abs() < 1e-6);
    assert_eq!(
        brush.dynamics.curve(Property::Rotation, Input::Direction),
        Some(&Curve::Share(1.0))
    );
    assert_eq!(brush.dynamics.curve(Property::Flow, Input::Random), Some(&Curve::Share(0.5)));
    assert!(
        brush.dynamics.curve(Property::Flow, Input::Pressure).is_none(),
        "nothing follows it unasked"
    );
}

#[test]
fn what_is_switched_off_drives_nothing() {
    let (brush, notes) = convert(vec![
        ("useTipDynamics", Flag(false)),
        ("szVr", part(2, 90.0, 0.0)),
        ("useScatter", Flag(false)),
        ("Scat", Number(300.0)),
        ("useTexture", Flag(false)),
    ]);
    assert_eq!((brush.dynamics.drives().len(), brush.scatter, notes.len()), (0, 0.0, 0));
}

#[test]
fn a_round_tip_gets_as_flat_as_it_is_said_to() {
    let (brush, _) =
        convert(vec![("useTipDynamics", Flag(true)), ("roundnessDynamics", part(2, 0.0, 25.0))]);
    let long = |pressure| at(&brush, Property::Elongation, pressure);
    assert!(
        (long(0.0) - 4.0).abs() < 1e-5 && (long(1.0) - 1.0).abs() < 1e-5,
        "{} {}",
        long(0.0),
        long(1.0)
    );
    assert!((long(0.5) - 1.0 / 0.625).abs() < 1e-5);
}

#[test]
fn dabs_scatter_by_their_radius_and_stand_closer_where_there_are_several() {
    let (brush, notes) = convert(vec![
        ("useScatter", Flag(true)),
        ("bothAxes", Flag(true)),
        ("scatterDynamics", part(3, 200.0, 0.0)),
        ("Cnt ", Number(4.0)),
    ]);
    assert_eq!(
        (brush.scatter, brush.spacing, notes.len()),
        (1.0, Brush::default().spacing / 4.0, 0)
    );
    assert_eq!(brush.dynamics.curve(Property::Scatter, Input::Tilt), Some(&Curve::Share(1.0)));
}

#[test]
fn only_what_is_used_and_lost_is_told() {
    let (brush, notes) = convert(vec![
        ("useTipDynamics", Flag(true)),
        ("szVr", part(1, 0.0, 0.0)),
        ("useColorDynamics", Flag(true)),
        ("H   ", Number(50.0)),
        ("Wtdg", Flag(true)),
        ("Nose", Flag(false)),
    ]);
    assert_eq!(notes, ["nothing here follows fading", "wet edges not imported from Photoshop"]);
    assert_eq!(brush.jitter, ColorJitter { hue_degrees: 90.0, saturation: 0.0, value: 0.0 });
}

#[test]
fn a_texture_is_the_collection_s_pattern() {
    let pattern = PatternResource::gray("p", crate::math::Size::new(2, 1), &[0, 200]);
    let values = |blend: &[u8]| {
        DescriptorObject::of(vec![
            ("useTexture", Flag(true)),
            ("Txtr", Object(DescriptorObject::of(vec![("Idnt", Text("p".into()))]))),
            ("textureScale", Number(150.0)),
            ("textureDepth", Number(60.0)),
            ("InvT", Flag(true)),
            ("textureBlendMode", Word(blend.into())),
        ])
    };
    let textured = |preset: &DescriptorObject, patterns: &[PatternResource]| {
        let mut carried = with_dynamics(preset, Brush::default(), Vec::new());
        carried.convert_texture(Path::new("a.abr"), patterns, &mut TipNames::default());
        (carried.brush.grain, carried.notes)
    };
    let (grain, notes) = textured(&values(b"Mltp"), std::slice::from_ref(&pattern));
    let grain = grain.unwrap();
    assert_eq!((grain.size_px, grain.strength, notes.len()), (3.0, 0.6, 0));
    assert_eq!(textured(&values(b"CBrn"), &[pattern]).1.len(), 1, "another way to take paint away");
    let (none, notes) = textured(&values(b"Mltp"), &[]);
    assert!(none.is_none() && notes[0].contains("not in the collection"), "{notes:?}");
}
