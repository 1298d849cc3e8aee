//! SVG drawings through a session: opened, placed, saved, opened again.

use super::*;
use crate::math::Size;

const DRAWING: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="60" height="40">
    <ellipse cx="30" cy="20" rx="25" ry="15" fill="#c06030"/>
    <text x="12" y="26" font-size="16" fill="#ffffff">Rel</text></svg>"##;

#[test]
fn an_svg_opens_as_paint_is_given_a_shape_and_placed() {
    let folder = tempfile::tempdir().unwrap();
    let named = |name: &str| folder.path().join(name).to_string_lossy().replace('\\', "/");
    std::fs::write(named("drawing.svg"), DRAWING).unwrap();
    let mut session = Session::default();
    let script = format!(
        r#"{{"in":"file","do":"open","file":"{0}"}}
{{"in":"part","do":"shape","layer":"0","preset":"pillow","flats":false}}
{{"in":"file","do":"place","file":"{0}","at":[30,20]}}
{{"in":"file","do":"save","file":"{1}"}}
{{"in":"file","do":"open","file":"{1}"}}"#,
        named("drawing.svg"),
        named("drawing.ora")
    );
    session.replay(Path::new("story"), &script).unwrap_or_else(|e| panic!("{e}"));
    let [made, read] = &session.open_documents[..] else { panic!("there are not two documents") };
    assert_eq!(made.document().size, Size::new(60, 40));
    assert!(made.document().surface.is_some(), "{:?}", session.notes);
    let image = |open: &OpenDocument| {
        let document = open.document();
        document.walk().into_iter().find_map(|(_, layer)| match &layer.content {
            Content::Image(live) => Some(live.params().source.picture.clone()),
            _ => None,
        })
    };
    assert!(image(made).is_some_and(|picture| picture.size.width >= 2048), "it is no image layer");
    assert!(image(made) == image(read), "the placed drawing came back changed");
}
