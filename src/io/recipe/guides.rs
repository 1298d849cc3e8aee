//! Guides, assistants and symmetry of a document, read and written.
//! Floor 5.

use crate::Result;
use crate::document::symmetry::{MOST_ROUND, SymmetryAxes};
use crate::document::{Assistant, AssistantKind, Document, Guides, Symmetry, SymmetrySettings};
use crate::json::{JsonNode, JsonObject, object};
use crate::math::{COORDINATE, TURNS};
use serde_json::Value;

/// `{ "vertical": [x …], "horizontal": [y …] }`.
pub fn read(node: &JsonNode) -> Result<Guides> {
    let mut fields = node.fields()?;
    let mut lines = |name| {
        fields.get(name).map_or(Ok(Vec::new()), |node| node.numbers(0, Guides::MOST, COORDINATE))
    };
    let guides = Guides { vertical: lines("vertical")?, horizontal: lines("horizontal")? };
    fields.finish()?;
    Ok(guides)
}

/// A list of `{ "kind": …, "points": [[x, y] …] }`.
pub fn read_assistants(node: &JsonNode) -> Result<Vec<Assistant>> {
    node.list(Assistant::MOST)?.iter().map(read_assistant).collect()
}

fn read_assistant(node: &JsonNode) -> Result<Assistant> {
    let mut fields = node.fields()?;
    let kind = fields.require("kind")?.one_of(&AssistantKind::ALL)?;
    let points = fields.require("points")?;
    fields.finish()?;
    let assistant = Assistant {
        kind,
        points: points.list(3)?.iter().map(JsonNode::point).collect::<Result<_>>()?,
    };
    assistant.fits().map_err(|why| points.refusal(why))?;
    Ok(assistant)
}

/// How strokes repeat without a number.
const SYMMETRIES: [(Symmetry, &str); 4] = [
    (Symmetry::None, "none"),
    (Symmetry::Vertical, "vertical"),
    (Symmetry::Horizontal, "horizontal"),
    (Symmetry::Both, "both"),
];

/// `{ "kind": …, "center": [x, y], "turn": degrees }`; the kind is a word or a number of turns.
pub fn read_symmetry(node: &JsonNode) -> Result<SymmetrySettings> {
    let mut fields = node.fields()?;
    let kind = fields.require("kind")?;
    let kind = match kind.value().is_number() {
        true => Symmetry::Radial(kind.whole(2..=MOST_ROUND)?),
        false => kind.one_of(&SYMMETRIES)?,
    };
    let center = fields.get("center").map(|node| node.point()).transpose()?;
    let turn = fields.number("turn", 0.0, TURNS)?;
    fields.finish()?;
    Ok(SymmetrySettings { kind, axes: SymmetryAxes { center, turn } })
}

fn write_symmetry(symmetry: &SymmetrySettings) -> Value {
    let mut out = JsonObject::default();
    let word = SYMMETRIES.iter().find(|(kind, _)| *kind == symmetry.kind).map(|(_, word)| *word);
    match (symmetry.kind, word) {
        (Symmetry::Radial(turns), _) => out.set("kind", turns.into()),
        (_, word) => out.set_some("kind", word, Value::from),
    }
    out.set_some("center", symmetry.axes.center, object::point);
    out.number("turn", symmetry.axes.turn, 0.0);
    out.into_value()
}

/// Absent ones are not written.
pub fn write(out: &mut JsonObject, document: &Document) {
    if !document.guides.is_empty() {
        out.set("guides", write_guides(&document.guides));
    }
    if !document.assistants.is_empty() {
        out.set("assistants", document.assistants.iter().map(write_assistant).collect());
    }
    if document.symmetry != SymmetrySettings::default() {
        out.set("symmetry", write_symmetry(&document.symmetry));
    }
}

fn write_guides(guides: &Guides) -> Value {
    let mut out = JsonObject::default();
    for (name, lines) in [("vertical", &guides.vertical), ("horizontal", &guides.horizontal)] {
        if !lines.is_empty() {
            out.set(name, lines.iter().map(|at| object::number(*at)).collect());
        }
    }
    out.into_value()
}

fn write_assistant(assistant: &Assistant) -> Value {
    let mut out = JsonObject::default();
    out.set("kind", assistant.kind.name().into());
    out.set("points", assistant.points.iter().map(|point| object::point(*point)).collect());
    out.into_value()
}

/// Whether the first version has no words for what is there.
pub fn is_needed(document: &Document) -> bool {
    !document.guides.is_empty()
        || !document.assistants.is_empty()
        || document.symmetry != SymmetrySettings::default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, vec2};
    use crate::{Budget, RecipeFolder, recipe};
    use std::path::Path;
    use std::sync::Arc;

    fn back(text: &str) -> Result<Document> {
        let (file, files, budget) =
            (Path::new("r.json"), RecipeFolder::folder_of(Path::new("r.json")), Budget::default());
        recipe::read(
            text.as_bytes(),
            recipe::RecipeSource { file, files: &files, budget: &budget, onto: None },
        )
    }

    #[test]
    fn guides_and_assistants_come_back_and_a_document_without_them_stays_of_the_first_version() {
        let plain = Document::empty(Size::new(40, 30));
        assert!(recipe::print(&plain).contains(r#""version": 1"#));
        let guides = Arc::new(Guides { vertical: vec![12.5, 0.1], horizontal: vec![-3.0] });
        let kind = AssistantKind::TwoPoint;
        let assistants = Arc::new(vec![Assistant {
            kind,
            points: vec![vec2(-900.0, 12.0), vec2(1200.5, 13.0)],
        }]);
        let document = Document { guides, assistants, ..plain };
        let text = recipe::print(&document);
        assert!(text.contains(r#""version": 2"#), "{text}");
        let read = back(&text).unwrap();
        assert_eq!(document.difference(&read), None);
        assert_eq!(
            Document { assistants: Arc::default(), ..read }.difference(&document).as_deref(),
            Some("the assistants")
        );
    }

    #[test]
    fn symmetry_comes_back_with_its_axes() {
        let axes = SymmetryAxes { center: Some(vec2(12.25, -3.0)), turn: 30.5 };
        for kind in [Symmetry::Vertical, Symmetry::Both, Symmetry::Radial(7), Symmetry::None] {
            let symmetry = SymmetrySettings { kind, axes };
            let document = Document { symmetry, ..Document::empty(Size::new(40, 30)) };
            let text = recipe::print(&document);
            assert!(text.contains(r#""version": 2"#), "{text}");
            assert_eq!(back(&text).unwrap().symmetry, symmetry);
        }
    }

    #[test]
    fn what_is_no_guide_or_assistant_is_refused_by_its_path() {
        let with = |what: &str| {
            let text = format!(
                r#"{{"format":"rilievo","version":2,"canvas":{{"width":4,"height":4}},{what}}}"#
            );
            back(&text).err().map(|error| error.to_string()).unwrap_or_default()
        };
        assert!(with(r#""guides":{"vertical":[1,"x"]}"#).contains("guides.vertical[1]"));
        assert!(with(r#""guides":{"diagonal":[1]}"#).contains("diagonal"));
        assert!(
            with(r#""assistants":[{"kind":"line","points":[[1,2]]}]"#)
                .contains("assistants[0].points")
        );
        assert!(
            with(r#""assistants":[{"kind":"curve","points":[]}]"#).contains("assistants[0].kind")
        );
        assert!(with(r#""symmetry":{"kind":"oblique"}"#).contains("symmetry.kind"));
        assert!(with(r#""symmetry":{"kind":1}"#).contains("symmetry.kind"));
    }
}
