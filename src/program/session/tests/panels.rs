//! Comics through a session: panels divided, cut, painted in, undone, saved, opened again.

use super::*;
use crate::document::Document;
use crate::math::Size;

fn play(lines: &[&str]) -> Session {
    let mut session = Session::default();
    session.add_document(OpenDocument::new("page", Document::empty(Size::new(200, 120)), None));
    for line in lines {
        session.replay(Path::new("story"), line).unwrap_or_else(|e| panic!("{e}"));
    }
    session
}

fn pixel(session: &Session, x: i32, y: i32) -> [u8; 4] {
    let document = session.active().unwrap().document();
    flatten(document, &Progress::default()).unwrap().pixel(x, y)
}

fn names(session: &Session) -> Vec<String> {
    session.active().unwrap().document().layers.iter().rev().map(|l| l.name.clone()).collect()
}

const SETTINGS: &str = r##"{"in":"panel","do":"settings","panels":{"rows":1,"columns":2,"margin":10,
"gutter_across":20,"gutter_down":20,"border":4,"border_color":"#102030"}}"##;
const DIVIDE: &str = r#"{"in":"panel","do":"divide"}"#;
const CUT: &str = r#"{"in":"panel","do":"cut","from":[0,60],"to":[95,60]}"#;
const PAINT: [&str; 7] = [
    r##"{"in":"hand","do":"color","color":"#c02010"}"##,
    r#"{"in":"hand","do":"size","to":60}"#,
    r#"{"in":"hand","do":"hardness","to":1}"#,
    r#"{"in":"hand","do":"opacity","to":1}"#,
    r#"{"in":"hand","do":"flow","to":1}"#,
    r#"{"in":"pointer","do":"press","tool":"brush","pen":[60,60,1],"px_per_pt":1}"#,
    r#"{"in":"pointer","do":"release"}"#,
];

#[test]
fn paint_in_a_panel_stays_in_it_and_goes_along_with_a_cut() {
    let settings = SETTINGS.replace('\n', "");
    let mut session = play(&[&settings, DIVIDE]);
    assert_eq!(names(&session), ["Panel 1", "Panel 2"]);
    for line in PAINT {
        session.replay(Path::new("story"), line).unwrap();
    }
    let (red, white, line) = ([0xc0, 0x20, 0x10, 255], [255; 4], [0x10, 0x20, 0x30, 255]);
    // The panel ends at 90, its line at 92.
    assert_eq!([pixel(&session, 60, 60), pixel(&session, 85, 60)], [red; 2]);
    assert_eq!([pixel(&session, 88, 60), pixel(&session, 91, 60)], [line; 2]);
    assert_eq!(pixel(&session, 93, 60)[3], 0);
    assert_eq!(pixel(&session, 130, 60), white, "the other panel has none of it");
    session.replay(Path::new("story"), CUT).unwrap();
    assert_eq!(names(&session), ["Panel 1", "Panel 2", "Panel 3"]);
    assert_eq!([pixel(&session, 60, 45), pixel(&session, 60, 75)], [red; 2]);
    assert_eq!(pixel(&session, 60, 60)[3], 0, "the gutter");
    session.replay(Path::new("story"), r#"{"in":"edit","do":"undo"}"#).unwrap();
    assert_eq!(names(&session), ["Panel 1", "Panel 2"]);
    assert_eq!(pixel(&session, 60, 60), red);
}

#[test]
fn a_page_comes_back_from_a_project_and_from_a_photoshop_file() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["page.ora", "page.psd"] {
        let file = folder.path().join(name).to_string_lossy().replace('\\', "/");
        let save = format!(r#"{{"in":"file","do":"save","file":"{file}"}}"#);
        let open = format!(r#"{{"in":"file","do":"open","file":"{file}"}}"#);
        let settings = SETTINGS.replace('\n', "");
        let lines: Vec<&str> =
            [&settings[..], DIVIDE].into_iter().chain(PAINT).chain([CUT, &save, &open]).collect();
        let session = play(&lines);
        let [made, read] = &session.open_documents[..] else { panic!("{:?}", session.notes) };
        assert_eq!(made.document().difference(read.document()), None, "{name}");
        let drawn = |open: &OpenDocument| flatten(open.document(), &Progress::default()).unwrap();
        let rect = made.document().size.rect();
        assert!(drawn(made).to_straight_rgba(rect) == drawn(read).to_straight_rgba(rect), "{name}");
    }
}

#[test]
fn the_selection_and_the_shape_of_a_path_become_panels() {
    let settings = SETTINGS.replace('\n', "");
    let select = [
        r#"{"in":"pointer","do":"press","tool":"select rectangle","pen":[20,20],"px_per_pt":1}"#,
        r#"{"in":"pointer","do":"drag","pens":[[160,100]]}"#,
        r#"{"in":"pointer","do":"release"}"#,
    ];
    let draw = r##"{"in":"path","do":"draw","path":{"fill":"#20c040",
"figure":{"kind":"ellipse","from":[20,10],"to":[180,110]}}}"##;
    let draw = draw.replace('\n', "");
    let divide = r#"{"in":"panel","do":"divide","layer":"0"}"#;
    let session = play(&[&settings, &draw, divide]);
    assert_eq!(names(&session), ["Panel 1", "Panel 2"], "{:?}", session.notes);
    assert_eq!(pixel(&session, 50, 60), [255; 4]);
    assert_eq!([pixel(&session, 100, 60)[3], pixel(&session, 22, 12)[3]], [0; 2]);
    let session = play(&[&settings, select[0], select[1], select[2], DIVIDE]);
    assert_eq!(names(&session), ["Panel 1", "Panel 2"], "{:?}", session.notes);
    assert_eq!([pixel(&session, 30, 30), pixel(&session, 150, 90)], [[255; 4]; 2]);
    assert_eq!([pixel(&session, 90, 60)[3], pixel(&session, 12, 60)[3]], [0; 2]);
    let none = play(&[r#"{"in":"panel","do":"settings","panels":{"margin":70}}"#, DIVIDE]);
    assert!(names(&none).is_empty());
    assert_eq!(
        none.said,
        [
            "There are no panels: 2 × 3 panels, their gutters and the margin do not fit in 200 × 120 px."
        ]
    );
    let none = play(&[CUT]);
    assert_eq!(
        none.said,
        ["No panel was cut: the line goes over none that is shown and not locked."]
    );
}
