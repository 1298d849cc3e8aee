//! Pictures are exported in other sizes, in parts, and again in the same way.

use super::*;
use crate::io::{self, Budget};
use crate::math::Size;
use crate::session::{ExportSettings, ExportSize};
use std::path::PathBuf;

fn size_of(file: &Path) -> Size {
    let bytes = std::fs::read(file).unwrap();
    io::picture::decode(file, &bytes, &Budget::default()).unwrap().size
}

fn export(session: &mut Session, file: &Path, rest: &str) -> crate::Result<()> {
    let text = format!(
        r#"{{"in":"file","do":"export","file":{file:?},"background":null,"quality":92{rest}}}"#
    );
    session.replay(Path::new("story"), &text)
}

#[test]
fn a_picture_is_exported_at_the_size_that_is_asked_for_and_again() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| -> PathBuf { folder.path().join(name) };
    let mut session = replay(&format!("{PAPER}{STROKE}"));
    session.replay(Path::new("story"), r#"{"in":"file","do":"export again"}"#).unwrap();
    assert_eq!(session.said, ["The document was not exported yet."]);
    for (name, rest, size) in [
        ("a.png", "", (200, 150)),
        ("b.png", r#","size":{"scale":2}"#, (400, 300)),
        ("c.jpg", r#","size":{"scale":0.5}"#, (100, 75)),
        ("d.webp", r#","size":{"width":64}"#, (64, 48)),
    ] {
        export(&mut session, &at(name), rest).unwrap();
        assert_eq!(size_of(&at(name)), Size::new(size.0, size.1), "{name}");
    }
    std::fs::remove_file(at("d.webp")).unwrap();
    for _ in 0..2 {
        session.replay(Path::new("story"), r#"{"in":"file","do":"export again"}"#).unwrap();
        assert_eq!(size_of(&at("d.webp")), Size::new(64, 48));
    }
    let said = export(&mut session, &at("a.png"), "").unwrap_err().to_string();
    assert!(said.contains("not replaced"), "{said}");
    let said = export(&mut session, &at("e.png"), r#","size":{"scale":0}"#).unwrap_err();
    assert!(said.to_string().contains("scale from 0.01 to 16"), "{said}");
}

#[test]
fn the_box_around_the_selection_is_exported_alone_at_any_size() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("part.png");
    let mut session = replay(&format!("{PAPER}{STROKE}"));
    let selection = r#"{"in":"pointer","do":"press","tool":"select rectangle","pen":[30,60],"px_per_pt":1}
{"in":"pointer","do":"drag","pens":[[90,85]]}
{"in":"pointer","do":"release"}"#;
    session.replay(Path::new("story"), selection).unwrap();
    let open = session.active().unwrap();
    let settings = ExportSettings { selection: true, ..ExportSettings::default() };
    let part = settings.part(open.document());
    assert!((58..=62).contains(&part.width()) && (23..=27).contains(&part.height()), "{part:?}");
    let whole = flatten(open.document(), &Progress::default()).unwrap().to_straight_rgba(part);
    export(&mut session, &file, r#","selection":true"#).unwrap();
    let read = io::picture::decode(&file, &std::fs::read(&file).unwrap(), &Budget::default());
    let crate::raster::picture::Texels::Srgb8(texels) = read.unwrap().texels else { panic!() };
    assert_eq!(texels.as_flattened(), whole, "the same pixels as of the canvas");
    let twice = folder.path().join("twice.png");
    export(&mut session, &twice, r#","selection":true,"size":{"scale":2}"#).unwrap();
    let (w, h) = (part.width() as u32, part.height() as u32);
    assert_eq!(size_of(&twice), Size::new(2 * w, 2 * h));
    let wide = folder.path().join("wide.png");
    export(&mut session, &wide, r#","selection":true,"size":{"width":33}"#).unwrap();
    assert_eq!(size_of(&wide).width, 33);
    let settings = ExportSettings { size: ExportSize::Width(33), ..settings };
    assert_eq!(settings.pixels(session.active().unwrap().document()), size_of(&wide));
    let psd = folder.path().join("part.psd");
    let said = export(&mut session, &psd, r#","selection":true"#).unwrap_err().to_string();
    assert!(said.contains("holds the whole canvas"), "{said}");
}
