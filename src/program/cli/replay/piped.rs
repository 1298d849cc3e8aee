//! Actions from a pipe, each answered with a line of JSON, for programs that drive this one.
//! Floor 7.
//!
//! A line that fails is answered and changes nothing more; the next is performed as usual. Where a
//! recovery log is kept, what is answered is in it.

use crate::document::Document;
use crate::io::Budget;
use crate::session::actions::Action;
use crate::session::replay::{self, ReplayValue};
use crate::session::{Autosave, LayerPath, LayerPaths, Session};
use crate::{Error, Result};
use serde_json::{Map, Value, json};
use std::io::{BufRead, ErrorKind, Read, Write};
use std::path::Path;

/// The lines that ask instead of act: `{"in":"query","do":"document"}`.
const QUERY: &str = "query";

/// A line of the pipe.
enum Request {
    /// An action, and the layer that it names.
    Act(Box<Action>, Option<Value>),
    /// What the document in front holds.
    Describe,
}

impl ReplayValue for Request {
    fn to_value(&self) -> Value {
        match self {
            Self::Act(action, _) => action.to_value(),
            Self::Describe => json!({ "in": QUERY, "do": "document" }),
        }
    }

    fn read(value: &Value) -> std::result::Result<Self, String> {
        if value.get("in").and_then(Value::as_str) != Some(QUERY) {
            let layer = value.get("layer").filter(|named| !named.is_null()).cloned();
            return Action::read(value).map(|action| Self::Act(Box::new(action), layer));
        }
        match value.get("do").and_then(Value::as_str) {
            Some("document") => Ok(Self::Describe),
            _ => Err("“do” of a query must be “document”".into()),
        }
    }
}

/// Reads from standard input until it ends. Fails if a line was refused or an answer cannot be
/// written.
pub fn run(mut session: Session) -> Result<()> {
    let done = answer_all(&mut session, std::io::stdin().lock(), std::io::stdout().lock());
    session.close();
    done
}

/// Answers each line of `from` with a line in `to`.
fn answer_all(session: &mut Session, mut from: impl BufRead, mut to: impl Write) -> Result<()> {
    let most = Budget::of_this_machine().json_bytes;
    let (mut refused, mut number, mut text) = (0, 0, Vec::new());
    loop {
        text.clear();
        let read = (&mut from).take(most).read_until(b'\n', &mut text);
        if read.map_err(|e| Error::io("standard input", e))? == 0 {
            break;
        }
        number += 1;
        let line = String::from_utf8_lossy(&text);
        let Some((is_done, mut reply)) = answer(session, number, &line) else {
            continue;
        };
        refused += usize::from(!is_done);
        session.keep();
        session.autosave.iter().for_each(Autosave::wait_until_written);
        let mut notes = std::mem::take(&mut session.notes);
        notes.append(&mut session.said);
        reply.insert("notes".into(), notes.into());
        match writeln!(to, "{}", Value::Object(reply)).and_then(|()| to.flush()) {
            // Who closed the pipe has read enough.
            Err(e) if e.kind() == ErrorKind::BrokenPipe => return Ok(()),
            written => written.map_err(|e| Error::io("standard output", e))?,
        }
    }
    match refused {
        0 => Ok(()),
        1 => Err(Error::unsupported_file("standard input", "a line was refused")),
        many => {
            Err(Error::unsupported_file("standard input", format!("{many} lines were refused")))
        }
    }
}

/// Performs one line: whether it was done, and the reply. `None` for an empty line.
fn answer(session: &mut Session, number: usize, line: &str) -> Option<(bool, Map<String, Value>)> {
    let file = Path::new("standard input");
    let done = match replay::line(line) {
        Ok(None) => return None,
        Ok(Some(Request::Describe)) => Ok(session.shown_document().map(description)),
        Ok(Some(Request::Act(action, named))) => match missing_layer(session, named) {
            Some(reason) => Err(replay::line_error(file, number, reason)),
            None => action.apply(session).map(|()| None),
        },
        Err(reason) => Err(replay::line_error(file, number, reason)),
    };
    let mut reply = Map::new();
    reply.insert("line".into(), number.into());
    reply.insert("done".into(), done.is_ok().into());
    reply.insert("layer".into(), session.layer_path().map_or(Value::Null, |path| path.to_value()));
    match &done {
        Ok(Some(document)) => drop(reply.insert("document".into(), document.clone())),
        Ok(None) => {}
        Err(error) => drop(reply.insert("error".into(), error.to_string().into())),
    }
    Some((done.is_ok(), reply))
}

/// What is wrong with the layer that a line names. The window names none that is not there, so that
/// an action on a missing one is nothing to it.
fn missing_layer(session: &Session, named: Option<Value>) -> Option<String> {
    let named = named?;
    let paths = LayerPaths::read(&named).ok()?;
    let is_there = session.active().is_some_and(|open| paths.find(open.document()).is_some());
    (!is_there).then(|| format!("“layer” is {named}, and there is no such layer"))
}

/// The size, layers (the bottom one first, groups before what they hold) and parts of a document.
fn description(document: &Document) -> Value {
    let walked = document.walk();
    let layers = walked.iter().filter_map(|(_, layer)| {
        let path = LayerPath::of(document, layer.id)?;
        Some(json!({
            "layer": path.to_value(),
            "name": layer.name,
            "kind": layer.content.kind_name(),
            "visible": layer.visible,
        }))
    });
    let parts =
        document.parts.list.iter().map(|part| json!({ "part": part.id, "name": part.name }));
    json!({
        "width": document.size.width,
        "height": document.size.height,
        "layers": layers.collect::<Vec<_>>(),
        "parts": parts.collect::<Vec<_>>(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Progress;

    fn answered(lines: &str) -> (Vec<Value>, Result<()>) {
        let mut replies = Vec::new();
        let done = answer_all(&mut Session::default(), lines.as_bytes(), &mut replies);
        let text = String::from_utf8(replies).unwrap();
        (text.lines().map(|line| serde_json::from_str(line).unwrap()).collect(), done)
    }

    #[test]
    fn every_line_is_answered_and_a_refused_one_stops_nothing() {
        let (replies, done) = answered(concat!(
            "# a drawing\n\n",
            r##"{"in":"file","do":"new","width":40,"height":30,"background":"#ffffff"}"##,
            "\n{\"in\":\"layer\",\"do\":\"add\",\"kind\":\"sculpture\"}\n",
            "{\"in\":\"layer\",\"do\":\"add\",\"kind\":\"strokes\"}\n",
            "not JSON\n{\"in\":\"layer\",\"do\":\"clear\",\"layer\":\"7\"}\n",
            "{\"in\":\"query\",\"do\":\"document\"}",
        ));
        let done = done.unwrap_err().to_string();
        assert!(done.contains("3 lines were refused"), "{done}");
        let lines: Vec<_> = replies.iter().map(|reply| (&reply["line"], &reply["done"])).collect();
        let expected = [(3, true), (4, false), (5, true), (6, false), (7, false), (8, true)];
        let expected: Vec<_> = expected.map(|(line, done)| (json!(line), json!(done))).into();
        assert!(
            lines.iter().zip(&expected).all(|(a, b)| *a.0 == b.0 && *a.1 == b.1),
            "{replies:?}"
        );
        assert_eq!(lines.len(), expected.len());
        assert!(replies[1]["error"].as_str().unwrap().contains("sculpture"), "{replies:?}");
        assert!(replies[4]["error"].as_str().unwrap().contains("no such layer"), "{replies:?}");
        let document = &replies[5]["document"];
        assert_eq!((&document["width"], &document["height"]), (&json!(40), &json!(30)));
        let layers = document["layers"].as_array().unwrap();
        assert_eq!(layers.last().unwrap()["kind"], "strokes");
        assert_eq!(layers.last().unwrap()["layer"], replies[2]["layer"]);
    }

    #[test]
    fn what_is_answered_is_in_the_recovery_log() {
        let folder = tempfile::tempdir().unwrap();
        let mut session = Session::default();
        session.autosave = Some(Autosave::new(folder.path().into()));
        let lines = "{\"in\":\"file\",\"do\":\"new\",\"width\":40,\"height\":30}\n\
                     {\"in\":\"layer\",\"do\":\"add\",\"kind\":\"paint\"}\n";
        answer_all(&mut session, lines.as_bytes(), Vec::new()).unwrap();
        let kept = session.active().unwrap().document().clone();
        drop(session);
        let lost = Autosave::new(folder.path().into()).find_lost_sessions();
        let left = lost.list().pop().expect("a log");
        let back = lost.bring_back(left, &Progress::default()).unwrap().unwrap();
        assert_eq!(kept.difference(back.open.document()), None);
    }

    #[test]
    fn a_refusal_without_a_file_is_a_note_of_its_line() {
        let (replies, done) = answered(concat!(
            "{\"in\":\"file\",\"do\":\"new\",\"width\":40,\"height\":30}\n",
            "{\"in\":\"layer\",\"do\":\"add\",\"kind\":\"paint\"}\n",
            r#"{"in":"layer","do":"set","layer":"0","to":{"do":"visible","on":false},"done":true}"#,
            "\n",
            r#"{"in":"pointer","do":"press","tool":"brush","pen":[9,9],"px_per_pt":1}"#,
            "\n{\"in\":\"pointer\",\"do\":\"release\"}\n",
            "{\"in\":\"layer\",\"do\":\"look\",\"name\":\"gold\"}\n",
        ));
        done.unwrap();
        let notes: Vec<usize> =
            replies.iter().map(|reply| reply["notes"].as_array().unwrap().len()).collect();
        assert_eq!(notes[..3], [0, 0, 0], "{replies:?}");
        assert!(notes[3] + notes[4] == 1, "{replies:?}");
        assert!(replies[5]["notes"][0].as_str().unwrap().contains("needs a shape"), "{replies:?}");
    }
}
