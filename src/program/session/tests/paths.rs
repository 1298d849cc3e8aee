//! Paths through a session: drawn, changed, selected, stroked, saved, opened again.

use super::*;
use crate::document::Document;
use crate::math::Size;
use crate::raster::TileGrid;

fn play(lines: &[&str]) -> Session {
    let mut session = Session::default();
    session.add_document(OpenDocument::new("page", Document::empty(Size::new(200, 120)), None));
    for line in lines {
        let line = line.replace('\n', "");
        session.replay(Path::new("story"), &line).unwrap_or_else(|e| panic!("{e}"));
    }
    session
}

fn document(session: &Session) -> &Document {
    session.active().unwrap().document()
}

fn render(session: &Session) -> TileGrid {
    flatten(document(session), &Progress::default()).unwrap()
}

const DRAW: &str = r##"{"in":"path","do":"draw","path":{"fill":"#c03020","outline":4,"outline_color":"#204060",
"figure":{"kind":"rectangle","from":[20,20],"to":[120,80]}}}"##;

#[test]
fn a_figure_is_seen_at_its_points_and_another_one_takes_its_place() {
    let mut session = play(&[DRAW]);
    let seen = render(&session);
    assert_eq!(seen.pixel(60, 50), [0xc0, 0x30, 0x20, 255]);
    assert_eq!([seen.pixel(19, 50), seen.pixel(120, 50)], [[0x20, 0x40, 0x60, 255]; 2]);
    assert_eq!(seen.pixel(17, 50)[3], 0);
    let set = r##"{"in":"layer","do":"set","layer":"0","done":true,"to":{"do":"path","path":
{"fill":"#30a060","figure":{"kind":"ellipse","from":[20,20],"to":[120,80]}}}}"##;
    session.replay(Path::new("story"), &set.replace('\n', "")).unwrap();
    let seen = render(&session);
    assert_eq!(seen.pixel(60, 50), [0x30, 0xa0, 0x60, 255]);
    assert_eq!(seen.pixel(22, 22)[3], 0);
    assert_eq!(document(&session).layers[0].name, "Ellipse");
}

#[test]
fn a_path_is_saved_as_numbers_and_opened_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("star.ora").to_string_lossy().replace('\\', "/");
    let save = format!(r#"{{"in":"file","do":"save","file":"{file}"}}"#);
    let open = format!(r#"{{"in":"file","do":"open","file":"{file}"}}"#);
    let nodes = r#"{"in":"path","do":"to nodes","layer":"0"}"#;
    let session = play(&[DRAW, nodes, DRAW, &save, &open]);
    let [made, read] = &session.open_documents[..] else { panic!("there are not two documents") };
    assert!(made.document().difference(read.document()).is_none());
    let of_layer = crate::tools::path::of_layer;
    let layers = read.document().layers.iter();
    let paths: Vec<_> =
        layers.filter_map(|layer| of_layer(layer)?.source.path().cloned()).collect();
    assert_eq!((paths[0].count_nodes(), paths[0].figure()), (4, None));
    assert!(paths[1].figure().is_some());
}

#[test]
fn the_inside_of_a_path_is_selected_and_the_brush_goes_along_it() {
    let select = r#"{"in":"path","do":"select","layer":"0","how":"replace"}"#;
    let session = play(&[DRAW, select]);
    let area = document(&session).active_coverage().unwrap().area_px();
    assert!((area - 6000.0).abs() < 1.0, "{area}");
    let brush = r##"{"in":"hand","do":"size","to":6}"##;
    let color = r##"{"in":"hand","do":"color","color":"#00ff00"}"##;
    let stroke = r#"{"in":"path","do":"stroke","layer":"0","onto":null}"#;
    let stroked = play(&[DRAW, brush, color, stroke]);
    assert_eq!(document(&stroked).layers.len(), 2, "strokes lie above the path");
    let seen = render(&stroked);
    let green = |x: i32, y: i32| seen.pixel(x, y)[1] > 200;
    assert!(green(60, 20) && green(120, 50) && green(60, 80) && green(20, 50));
    assert!(!green(60, 50));
    assert_eq!(stroked.active().unwrap().history.past_names().last(), Some("Stroke path"));
}

#[test]
fn a_path_around_a_selection_selects_it_again() {
    let all = r#"{"in":"selection","do":"none"}"#;
    let select = r#"{"in":"path","do":"select","layer":"0","how":"replace"}"#;
    let ellipse = DRAW.replace("rectangle", "ellipse");
    let made = r#"{"in":"path","do":"from selection"}"#;
    let again = r#"{"in":"path","do":"select","layer":"1","how":"replace"}"#;
    let before = play(&[&ellipse, select]);
    let after = play(&[&ellipse, select, made, all, again]);
    let area = |session: &Session| document(session).active_coverage().unwrap().area_px();
    let (before, now) = (area(&before), area(&after));
    assert!((before - now).abs() < 0.004 * before, "{before} {now}");
    let layer = &document(&after).layers[1];
    let path = crate::tools::path::of_layer(layer).unwrap().source.path().unwrap();
    assert!(path.count_nodes() < 16, "{}", path.count_nodes());
}

#[test]
fn what_is_no_path_says_so() {
    let add = r#"{"in":"layer","do":"add","kind":"paint"}"#;
    for action in [
        r#"{"in":"path","do":"select","layer":"0","how":"replace"}"#,
        r#"{"in":"path","do":"stroke","layer":"0","onto":null}"#,
        r#"{"in":"path","do":"to nodes","layer":"0"}"#,
    ] {
        let said = play(&[add, action]).said.join(" ");
        assert!(said.contains("no path"), "{action}: {said}");
    }
    let back = play(&[r#"{"in":"path","do":"back"}"#]);
    assert!(back.said.join(" ").contains("No node"), "{:?}", back.said);
}
