//! Bundles built here, and the same ones damaged.

use super::super::kpp::tests::{gray_gbr, kpp, pat, png};
use super::super::tests::damage;
use super::*;
use crate::math::hash;
use crate::paint::Tip;
use crate::paint::settings::SETTINGS;
use crate::project::packer::ZipPacker;

const TIP: &str = "<Brush type=\"gbr_brush\" filename=\"tip.gbr\" BrushVersion=\"2\" scale=\"2\"/>";
const TEXTURE: [(&str, &str); 2] =
    [("Texture/Pattern/Enabled", "true"), ("Texture/Pattern/PatternFileName", "p.pat")];

fn pack(entries: &[(&str, &[u8])]) -> Vec<u8> {
    let mut packer = ZipPacker::default();
    packer.store("mimetype", b"application/x-krita-resourcebundle").unwrap();
    entries.iter().for_each(|(name, bytes)| packer.deflate(name, bytes).unwrap());
    packer.finish().unwrap()
}

fn bundle() -> Vec<u8> {
    pack(&[
        ("META-INF/manifest.xml", b"<manifest:manifest/>"),
        ("brushes/tip.gbr", &gray_gbr(3, 2, &[1, 2, 3, 4, 5, 6])),
        ("patterns/p.pat", &pat(2, 1, 3, &[0, 0, 0, 255, 255, 255])),
        ("paintoppresets/b.kpp", &kpp("paintbrush", TIP, &TEXTURE)),
        (
            "paintoppresets/a.myb",
            br#"{ "version": 3, "settings": { "radius_logarithmic": { "base_value": 1 } } }"#,
        ),
        ("paintoppresets/c.kpp", &kpp("sketchbrush", TIP, &[])),
        ("paintoppresets/d.kpp", &kpp("sketchbrush", TIP, &[])),
        ("paintoppresets/e.kpp", b"no picture"),
        ("paintoppresets/b.png", b"a thumbnail"),
    ])
}

fn read_bundle(bytes: &[u8]) -> Result<Vec<ImportedBrush>> {
    read(Path::new("set.bundle"), bytes, &Budget::default())
}

#[test]
fn a_bundle_gives_its_presets_with_their_tips_and_patterns() {
    let bytes = bundle();
    let brushes = read_bundle(&bytes).unwrap();
    let names: Vec<&str> = brushes.iter().map(|brush| brush.name.as_str()).collect();
    assert_eq!(names, ["a", "b) Basic"]);
    assert!(matches!(brushes[1].brush.tip, Tip::Picture(_)));
    assert_eq!((brushes[1].brush.size, brushes[1].brush.pictures().count()), (6.0, 2));
    assert!(brushes[1].notes.is_empty(), "{:?}", brushes[1].notes);
    assert_eq!(brushes[0].notes.len(), 2);
    let said = "2 of the bundle left out, c.kpp, d.kpp: Krita's brush engine “sketchbrush”";
    assert!(brushes[0].notes.iter().any(|note| note.starts_with(said)), "{:?}", brushes[0].notes);
    // By its content, whatever it is called.
    use crate::brush::BrushFormat;
    assert_eq!(BrushFormat::of(Path::new("set.zip"), &bytes), Some(BrushFormat::KritaBundle));
    assert_eq!(BrushFormat::of(Path::new("set.zip"), &pack(&[])[40..]), None);
}

#[test]
fn a_bundle_of_tips_gives_a_brush_for_each() {
    let red = png(1, 1, &[[255, 0, 0, 255]]);
    let brushes = read_bundle(&pack(&[
        ("brushes/a.gbr", &gray_gbr(3, 1, &[1, 2, 3])),
        ("brushes/dark & light.png", &red),
    ]));
    let brushes = brushes.unwrap();
    let told: Vec<_> = brushes.iter().map(|b| (b.name.as_str(), b.brush.size)).collect();
    assert_eq!(told, [("Tip", 3.0), ("dark & light", 1.0)]);
}

#[test]
fn what_is_no_bundle_of_brushes_gets_a_sentence() {
    let said = |bytes: &[u8]| read_bundle(bytes).map(|_| ()).unwrap_err().to_string();
    assert!(said(b"# v2 git bundle").contains("no bundle of Krita"));
    assert!(said(&pack(&[("gradients/a.ggr", b"x")])).contains("a bundle without brushes"));
    let only = pack(&[("paintoppresets/x.kpp", &kpp("hairybrush", TIP, &[]))]);
    assert!(said(&only).contains("1 of the bundle left out, x.kpp: Krita's brush engine"));
    assert!(said(&pack(&[("../x.kpp", b"x")])).contains("contains “..”"));
    let small = Budget { entries: 2, ..Budget::default() };
    let refused = read(Path::new("set.bundle"), &bundle(), &small).map(|_| ()).unwrap_err();
    assert!(refused.to_string().contains("entries"), "{refused}");
}

#[test]
fn entries_beyond_the_budget_are_notes() {
    let small = Budget { area_px: 5, ..Budget::default() };
    let brushes = read(Path::new("set.bundle"), &bundle(), &small).unwrap();
    let note = &brushes[1].notes[0];
    assert!(note.contains("“tip.gbr” cannot be used") && note.contains("too large"), "{note}");
}

#[test]
fn damaged_bundles_never_panic_and_what_they_give_is_a_brush_within_its_ranges() {
    let whole = bundle();
    let inner: [(&str, Vec<u8>); 3] = [
        ("brushes/tip.gbr", gray_gbr(3, 2, &[1, 2, 3, 4, 5, 6])),
        ("patterns/p.pat", pat(2, 1, 3, &[0, 0, 0, 255, 255, 255])),
        ("paintoppresets/b.kpp", kpp("paintbrush", TIP, &TEXTURE)),
    ];
    let small =
        Budget { side_px: 4096, area_px: 1 << 16, document_px: 1 << 18, ..Budget::default() };
    for round in 0..3000u32 {
        let chance = |what: u32| hash::mix(hash::mix(round) ^ hash::mix(what));
        // The zip itself, or one of its entries.
        let bytes = match round % 4 {
            0 => {
                let mut bytes = whole.clone();
                damage(&mut bytes, &chance);
                bytes
            }
            entry => {
                let mut inner = inner.clone();
                damage(&mut inner[entry as usize - 1].1, &chance);
                pack(&inner.each_ref().map(|(name, bytes)| (*name, &bytes[..])))
            }
        };
        let brushes = read(Path::new("set.bundle"), &bytes, &small).into_iter().flatten();
        for ImportedBrush { name, brush, .. } in brushes {
            let is_in_range = |setting: &crate::paint::settings::BrushSetting| {
                setting.number.range.contains(&setting.of(&brush))
            };
            assert!(!name.is_empty() && SETTINGS.iter().all(is_in_range), "round {round}");
        }
    }
}
