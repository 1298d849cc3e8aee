//! Palettes of documents and of the user: edited, undone, saved, taken from pictures, imported and
//! exported.

use super::*;
use crate::paint::{ColorPalette, NamedColor};
use crate::session::PaletteShelf;

fn story(session: &mut Session, folder: &Path, lines: &str) {
    session.replay(&folder.join("story.jsonl"), lines).unwrap();
}

fn color_texts(palette: &ColorPalette) -> String {
    let one = |named: &NamedColor| format!("{} {}", named.color, named.name).trim().to_owned();
    palette.colors.iter().map(one).collect::<Vec<_>>().join(", ")
}

#[test]
fn the_palette_of_a_document_is_edited_in_steps_saved_and_opened() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = Session::default();
    story(
        &mut session,
        folder.path(),
        r##"{"in":"file","do":"new","width":20,"height":10,"background":null}
{"in":"palette","do":"add","color":"#102030","name":" night "}
{"in":"palette","do":"add","color":"#ff000080","name":""}
{"in":"palette","do":"add","color":"#00ff00","name":"grass","index":0}
{"in":"palette","do":"move","index":0,"to":9}
{"in":"palette","do":"name","index":1,"name":"red"}
{"in":"palette","do":"rename","name":"Mine"}
{"in":"palette","do":"recolor","index":0,"color":"#112233"}
{"in":"palette","do":"remove","index":7}"##,
    );
    let document = session.active().unwrap().document();
    assert_eq!(color_texts(&document.palette), "#112233 night, #ff0000 red, #00ff00 grass");
    assert!(session.active().unwrap().is_dirty());
    let file = folder.path().join("a.ora");
    story(&mut session, folder.path(), &format!(r#"{{"in":"file","do":"save","file":{file:?}}}"#));
    assert!(!session.active().unwrap().is_dirty());
    let opened = crate::session::storage::open(&file).unwrap();
    assert_eq!(opened.open.document().palette, session.active().unwrap().document().palette);
    story(&mut session, folder.path(), r#"{"in":"edit","do":"walk","steps":-2}"#);
    let document = session.active().unwrap().document();
    assert_eq!(
        (document.palette.name.as_str(), color_texts(&document.palette).contains("#102030")),
        ("", true)
    );
}

#[test]
fn palettes_of_the_user_are_copied_changed_and_kept_from_run_to_run() {
    let folder = tempfile::tempdir().unwrap();
    let own = folder.path().join("own");
    let palettes = PaletteShelf::load(&own).0;
    let mut session = Session { palettes, ..Session::default() };
    story(
        &mut session,
        folder.path(),
        r##"{"in":"palette","do":"add","palette":"Basic","color":"#102030","name":""}
{"in":"palette","do":"copy","palette":"Basic","to":"Mine"}
{"in":"palette","do":"add","palette":"Mine","color":"#102030","name":"night"}
{"in":"palette","do":"columns","palette":"Mine","to":5}
{"in":"palette","do":"new","name":"Mine"}
{"in":"palette","do":"set","palette":"Mine 2","to":{"name":"Other","colors":["#808080"]}}
{"in":"palette","do":"rename","palette":"Mine 2","name":"Gray"}"##,
    );
    assert!(session.said[0].contains("comes with the program"), "{:?}", session.said);
    assert_eq!(session.palettes.shown.as_deref(), Some("Gray"));
    let (read, notes) = PaletteShelf::load(&own);
    assert_eq!(notes, [""; 0]);
    let mine = read.get("Mine").unwrap();
    assert_eq!((mine.columns, mine.colors.len()), (5, 15));
    assert_eq!(color_texts(read.get("Gray").unwrap()), "#808080");
    story(
        &mut session,
        folder.path(),
        r#"{"in":"file","do":"new","width":20,"height":10,"background":null}
{"in":"palette","do":"copy","palette":"Gray"}
{"in":"palette","do":"delete","palette":"Gray"}
{"in":"palette","do":"delete","palette":"Basic"}"#,
    );
    assert_eq!(color_texts(&session.active().unwrap().document().palette), "#808080");
    assert_eq!(session.palettes.names().collect::<Vec<_>>(), ["Mine", "Basic"]);
    story(&mut session, folder.path(), r#"{"in":"palette","do":"delete"}"#);
    assert!(session.active().unwrap().document().palette.is_blank());
}

#[test]
fn colors_of_the_picture_become_a_palette_that_other_programs_read() {
    let folder = tempfile::tempdir().unwrap();
    let mut session = Session::default();
    let file = folder.path().join("two.ase");
    let text = format!(
        r##"{{"in":"file","do":"new","width":90,"height":70,"background":"#b04020"}}
{{"in":"palette","do":"from picture","count":8}}
{{"in":"palette","do":"name","index":0,"name":"brick"}}
{{"in":"palette","do":"export file","file":{file:?}}}
{{"in":"palette","do":"import file","file":{file:?}}}"##
    );
    story(&mut session, folder.path(), &text);
    assert_eq!(session.palettes.shown.as_deref(), Some("two"));
    assert_eq!(color_texts(session.shown_palette().unwrap()), "#b04020 brick");
    let again = Action::read(&serde_json::json!({
        "in": "palette", "do": "export file", "file": file, "palette": "two", "format": "kpl"
    }));
    let said = again.unwrap().apply(&mut session).unwrap_err().to_string();
    assert!(said.contains("not replaced"), "{said}");
    let unknown = folder.path().join("two.txt");
    let line = serde_json::json!({ "in": "palette", "do": "export file", "file": unknown });
    let said = Action::read(&line).unwrap().apply(&mut session).unwrap_err().to_string();
    assert!(said.ends_with("must end in one of .gpl, .aco, .act, .ase, .pal, .kpl"), "{said}");
}
