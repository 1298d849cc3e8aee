use super::*;
use crate::math::srgb::Color;
use crate::paint::GradientStop;
use crate::paint::RampStyle;
use crate::psd::descriptor::DescriptorValue;

fn read_again(effects: &[LayerEffect]) -> Vec<LayerEffect> {
    as_read(effects).map_or(Vec::new(), |read| {
        assert!(read.lost.is_empty(), "{:?}", read.lost);
        read.list
    })
}

/// What is set for each kind besides its defaults.
fn changed_effect(kind: EffectKind) -> LayerEffect {
    let mut effect = LayerEffect::new(kind);
    let s = &mut effect.settings;
    (s.size, s.opacity, s.blend) = (17.0, 0.25, BlendMode::Overlay);
    s.color = Color { r: 1, g: 200, b: 77, a: 255 };
    (s.document_light, s.angle, s.distance, s.spread) = (false, -45.0, 21.0, 0.5);
    (s.ramp, s.reverse, s.aligned, s.scale) = (RampStyle::Radial, false, false, 1.5);
    (s.sunken, s.altitude, s.depth, s.soften) = (true, 60.0, 2.0, 4.0);
    (s.knockout, s.noise, s.range) = (false, 0.75, 0.5);
    effect.contour = ToneCurve::new(vec![[0.0, 10.0], [100.0, 250.0], [255.0, 0.0]]);
    effect.stops = [(0.0, 255), (0.5, 51), (1.0, 255)]
        .map(|(t, a)| GradientStop { t, color: Color { r: 9, g: 90, b: 190, a } })
        .to_vec();
    effect
}

#[test]
fn effects_are_read_as_they_were_written() {
    for (kind, _) in EffectKind::ALL.iter().filter(|(kind, _)| *kind != EffectKind::PatternOverlay)
    {
        for effect in [LayerEffect::new(*kind), changed_effect(*kind)] {
            let read = read_again(std::slice::from_ref(&effect));
            // What a kind does not use is not written; what is read is read the same again.
            assert_eq!(read_again(&read), read, "{kind:?}");
            for field in kind.fields() {
                check_field(field, &read[0], &effect);
            }
        }
    }
}

fn check_field(field: crate::paint::effect::EffectField, read: &LayerEffect, meant: &LayerEffect) {
    use crate::paint::effect::EffectField as F;
    let (a, b) = (&read.settings, &meant.settings);
    let unsaid = ["knockout", "altitude", "on_surface"];
    let is_ramp = read.fill() == EffectFill::Gradient;
    match field {
        F::Number(n) if !(unsaid.contains(&n.name) && read.kind != EffectKind::Bevel) => {
            let of_fill = ["phase_x", "phase_y", "scale", "offset_x", "offset_y", "angle"];
            if read.kind == EffectKind::Stroke && of_fill.contains(&n.name) && !is_ramp {
                return;
            }
            assert!(((n.get)(a) - (n.get)(b)).abs() < 1e-5, "{:?}: {}", read.kind, n.name);
        }
        F::Flag(f)
            if read.kind != EffectKind::Stroke
                && (!unsaid.contains(&f.name) || read.kind == EffectKind::DropShadow) =>
        {
            assert_eq!((f.get)(a), (f.get)(b), "{:?}: {}", read.kind, f.name);
        }
        F::Color(c) if !is_ramp => assert_eq!((c.get)(a), (c.get)(b), "{:?}", read.kind),
        F::Choice(c) if read.kind != EffectKind::Stroke || c.name != "ramp" => {
            assert_eq!((c.get)(a), (c.get)(b), "{:?}: {}", read.kind, c.name);
        }
        F::Stops if is_ramp => assert_eq!(read.stops, meant.stops, "{:?}", read.kind),
        F::Contour => assert_eq!(read.contour, meant.contour, "{:?}", read.kind),
        _ => {}
    }
}

#[test]
fn several_effects_of_one_kind_need_the_newer_block() {
    let one = changed_effect(EffectKind::DropShadow);
    let other = LayerEffect { on: false, ..LayerEffect::new(EffectKind::DropShadow) };
    let both = [one.clone(), other];
    assert_eq!(blocks(&both).iter().map(|(key, _)| *key).collect::<Vec<_>>(), KEYS);
    let read = read_again(&both);
    assert_eq!(read.iter().map(|effect| effect.on).collect::<Vec<_>>(), [true, false]);
    assert_eq!(blocks(&[one]).len(), 1);
    assert!(blocks(&[]).is_empty());
}

#[test]
fn blend_modes_are_known_by_older_and_newer_words() {
    let said = |word: &str| {
        DescriptorObject::of(vec![("Md  ", DescriptorValue::Word(word.as_bytes().to_vec()))])
    };
    for (mode, word) in BLENDS.iter().chain(&NEWER_BLENDS) {
        assert_eq!(blend(&said(word), "Md  "), Some(*mode), "{word}");
    }
    assert_eq!(blend(&said("unheard"), "Md  "), None);
}
