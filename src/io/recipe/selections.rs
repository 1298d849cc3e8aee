//! Selections of a document: those kept by name, the active one, and those that strokes were
//! painted in. Read and written. Floor 5. Each is stored once, under an id; strokes name it. Not
//! here: masks of layers (`masks`).

use super::LayerReader;
use super::value::RecipeValue;
use crate::Result;
use crate::document::{Document, NamedSelection, OutlineSource, Part, SelectionList};
use crate::json::{Fields, JsonNode, JsonObject, object};
use crate::math::{Vec2, vec2};
use crate::paint::{Scene, Selection, Stroke, StrokeSelection};
use crate::raster::CoverageGrid;
use crate::surface::region::{RegionKind, SurfaceRegion};
use serde_json::Value;
use std::sync::Arc;

/// The folder of their masks in a project.
const FOLDER: &str = "rilievo/selections/";

/// The name of the selection at a place of the list.
fn id(place: usize) -> String {
    format!("s{}", place + 1)
}

/// The file that holds its mask.
pub fn file(place: usize) -> String {
    format!("{FOLDER}{}.png", id(place))
}

impl LayerReader<'_> {
    /// The list of selections; those with a name are returned, all can be named by their ids from
    /// now on.
    pub fn selections(&mut self, node: &JsonNode, scene: &Scene) -> Result<Vec<NamedSelection>> {
        let mut kept: Vec<NamedSelection> = Vec::new();
        for item in node.list(Document::MOST_SELECTIONS)? {
            let mut fields = item.fields()?;
            let id = fields.require("id")?;
            let name = fields
                .get("name")
                .map(|name| Ok::<_, crate::Error>((name.text()?.to_owned(), name)))
                .transpose()?;
            let selection = match fields.get("mask") {
                Some(mask) => Arc::new(self.selection(&mask, scene)?),
                // A selection without bounds.
                None => Arc::new(Selection::new(CoverageGrid::full(self.size.rect()))),
            };
            fields.finish()?;
            let known = (selection.clone(), name.as_ref().map(|(name, _)| name.clone()));
            if self.selections.insert(id.text()?.to_owned(), known).is_some() {
                return Err(id.refusal("is the id of another selection too"));
            }
            if let Some((name, at)) = name {
                if name.is_empty() || kept.iter().any(|known| known.name == name) {
                    return Err(at.refusal("must be there, and no other selection's"));
                }
                kept.push(NamedSelection { name, selection });
            }
        }
        Ok(kept)
    }

    /// The selection of an id.
    pub fn selection_of(&self, node: &JsonNode) -> Result<Arc<Selection>> {
        let id = node.text()?;
        let known = self.selections.get(id).map(|(selection, _)| selection.clone());
        known.ok_or_else(|| node.refusal(format!("is “{id}”; there is no selection with that id")))
    }

    /// The kept selection that an outline names, by its id or, in an edit, by its name; one that
    /// has no name is called by its id.
    pub fn outline_selection(&self, node: &JsonNode) -> Result<String> {
        let id = node.text()?;
        match self.selections.get(id) {
            Some((_, name)) => Ok(name.clone().unwrap_or_else(|| id.to_owned())),
            None => Err(node.refusal(format!("is “{id}”; there is no selection with that id"))),
        }
    }

    /// The selections that have no name and are outlines of parts, kept by their ids.
    pub fn outline_selections(
        &self,
        parts: &[Arc<Part>],
        kept: &[NamedSelection],
    ) -> Vec<NamedSelection> {
        let mut new: Vec<NamedSelection> = Vec::new();
        for part in parts {
            let Some(OutlineSource::Selection(name)) = part.outline() else { continue };
            let is_known = kept.iter().chain(&new).any(|known| known.name == *name);
            if let Some((selection, None)) = self.selections.get(name).filter(|_| !is_known) {
                new.push(NamedSelection { name: name.clone(), selection: selection.clone() });
            }
        }
        new
    }

    fn selection(&mut self, node: &JsonNode, scene: &Scene) -> Result<Selection> {
        let mut fields = node.fields()?;
        let selection = match fields.get("kind") {
            // Each takes as long as a picture of the canvas.
            Some(kind) => {
                self.pictures.search(self.source, self.size)?;
                let found = Selection::of_region(
                    region(kind.one_of(&RegionKind::ALL)?, &mut fields)?,
                    scene,
                );
                self.pictures.hold(self.source, found.coverage.bytes())?;
                found
            }
            None => {
                let mut side = |name| {
                    fields.get(name).map_or(Ok(0), |node| node.integer(-1_000_000..=1_000_000))
                };
                let (x, y) = (side("x")? as i32, side("y")? as i32);
                Selection::new(self.pictures.selection(
                    self.source,
                    &fields.require("file")?,
                    x,
                    y,
                )?)
            }
        };
        fields.finish()?;
        Ok(selection)
    }

    /// The selection that a stroke was painted in, and how far it was moved since.
    pub fn stroke_selection(&self, fields: &mut Fields) -> Result<Option<StrokeSelection>> {
        let moved = fields.point("selection_moved", Vec2::ZERO)?;
        let own = fields.get("selection").map(|node| self.selection_of(&node)).transpose()?;
        Ok(own.map(|selection| StrokeSelection { selection, moved }))
    }
}

impl RecipeValue for SurfaceRegion {
    fn to_json(&self) -> Value {
        let mut out = JsonObject::default();
        write_region(&mut out, self);
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        let mut fields = node.fields()?;
        let kind = fields.require("kind")?.one_of(&RegionKind::ALL)?;
        let region = region(kind, &mut fields)?;
        fields.finish()?;
        Ok(region)
    }
}

/// A region of the surface, its kind known already.
pub fn region(kind: RegionKind, fields: &mut Fields) -> Result<SurfaceRegion> {
    Ok(SurfaceRegion {
        kind,
        at: fields.require("at")?.point()?,
        tolerance: fields.number("tolerance", kind.tolerance(), kind.tolerances())?,
        softness: fields.number("softness", 0.0, SurfaceRegion::SOFTNESS)?,
        contiguous: fields.boolean("contiguous", true)?,
    })
}

pub fn write_region(out: &mut JsonObject, region: &SurfaceRegion) {
    out.set("kind", region.kind.name().into());
    out.set("at", object::point(region.at));
    out.number("tolerance", region.tolerance, region.kind.tolerance());
    out.number("softness", region.softness, 0.0);
    out.flag("contiguous", region.contiguous, true);
}

/// The list, and which of it is active.
pub fn write(out: &mut JsonObject, document: &Document, list: &SelectionList) {
    if list.is_empty() {
        return;
    }
    let one = |(place, (name, selection)): (usize, (Option<&str>, &Arc<Selection>))| {
        let mut entry = JsonObject::default();
        entry.set("id", id(place).into());
        entry.text("name", name.unwrap_or_default(), "");
        let mut mask = JsonObject::default();
        match &selection.made {
            Some(region) => write_region(&mut mask, region),
            None => {
                let rect = selection.coverage.covered_rect();
                mask.set("file", file(place).into());
                mask.number("x", rect.x0 as f32, 0.0);
                mask.number("y", rect.y0 as f32, 0.0);
            }
        }
        entry.set("mask", mask.into_value());
        entry.into_value()
    };
    out.set("selections", list.iter_with_names().enumerate().map(one).collect());
    if let Some(place) = document.active_selection.as_ref().and_then(|active| list.place(active)) {
        out.set("active_selection", id(place).into());
    }
}

/// The fields of a stroke that was painted in a selection.
pub fn write_of_stroke(stroke: &Stroke, list: &SelectionList) -> JsonObject {
    let mut out = JsonObject::default();
    if let Some((own, place)) =
        stroke.selection().and_then(|own| Some((own, list.place(&own.selection)?)))
    {
        out.set("selection", id(place).into());
        if own.moved != vec2(0.0, 0.0) {
            out.set("selection_moved", object::point(own.moved));
        }
    }
    out
}

/// The list's name for a kept selection.
pub fn id_of_kept(name: &str, list: &SelectionList) -> Option<String> {
    list.iter_with_names().position(|(known, _)| known == Some(name)).map(id)
}

/// A stroke's JSON with those fields.
pub fn with_selection(mut stroke: Value, fields: &JsonObject) -> Value {
    if let Value::Object(stroke) = &mut stroke {
        stroke.extend(fields.fields().iter().map(|(name, value)| (name.clone(), value.clone())));
    }
    stroke
}

/// Version 1 cannot express these.
pub fn is_needed(document: &Document, list: &SelectionList) -> bool {
    use crate::document::{DerivedMask, MaskKind};
    let follows = |mask: &crate::document::LayerMask| {
        matches!(mask.kind, MaskKind::Derived(DerivedMask::Region(_)))
    };
    !list.is_empty()
        || document.walk().iter().any(|(_, layer)| layer.mask.as_ref().is_some_and(follows))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Content, DerivedMask, Layer, LayerMask, Live, StrokeList};
    use crate::math::{Rect, Size, srgb::Color};
    use crate::paint::{Brush, Sample};
    use crate::surface::Operator;
    use crate::{Budget, project};
    use serde_json::json;
    use std::path::Path;

    fn square(x0: i32) -> Selection {
        Selection::new(CoverageGrid::full(Rect::new(x0, 20, 90, 110)))
    }

    /// Two kept, one of them active, and strokes in another, in the active one moved, and in none.
    fn document() -> Document {
        let document = Document::empty(Size::new(200, 130)).with_selection(Some(square(10)));
        let first = document.with_kept_selection("Eye").unwrap();
        let other = StrokeSelection::new(Arc::new(square(40)));
        let samples = [vec2(10.0, 50.0), vec2(190.0, 50.0)].map(Sample::at).to_vec();
        let plain = Stroke::new(Brush::default(), Operator::None, Color::BLACK, samples);
        let moved = first.stroke_selection().map(|own| own.moved(vec2(3.5, -2.0)));
        let strokes = [Some(other.clone()), moved, None, Some(other)]
            .map(|own| Arc::new(plain.selecting(own)));
        let content = Content::Strokes(Live::new(StrokeList { strokes: strokes.to_vec() }));
        let region = SurfaceRegion {
            softness: 0.25,
            ..SurfaceRegion::new(RegionKind::Shine, vec2(3.0, 4.5))
        };
        let mask = Some(LayerMask::new(DerivedMask::Region(region)));
        let layers = vec![
            Arc::new(Layer { mask, ..Layer::new("fill", Content::Fill(Color::WHITE)) }),
            Arc::new(Layer::new("strokes", content)),
        ];
        let found = Selection::of_region(
            SurfaceRegion::new(RegionKind::Depth, vec2(9.0, 9.0)),
            &first.scene(),
        );
        let both = Document { layers, ..first }
            .with_selection(Some(found))
            .with_kept_selection("Near")
            .unwrap();
        both.with_selection(Some(square(10)))
    }

    #[test]
    fn selections_come_back_each_once_with_the_strokes_that_were_painted_in_them() {
        let (document, file) = (document(), Path::new("a.ora"));
        let written = project::write(file, &document, &Default::default()).unwrap().unwrap();
        let read = project::read(file, &written, &Budget::default()).unwrap();
        assert_eq!((read.notes.clone(), document.difference(&read.document)), (Vec::new(), None));
        let strokes = read.document.strokes(read.document.layers[1].id);
        let own = |i: usize| strokes[i].selection().unwrap();
        assert!(Arc::ptr_eq(&own(0).selection, &own(3).selection));
        assert!(Arc::ptr_eq(&own(1).selection, &read.document.selections[0].selection));
        assert_eq!(own(1).moved, vec2(3.5, -2.0));
        assert!(strokes[2].selection().is_none());
        let again = project::write(file, &read.document, &Default::default()).unwrap().unwrap();
        assert!(written == again, "the same document gives the same bytes");
        let bare = document
            .with_each_stroke(document.layers[1].id, &[0], |stroke| stroke.selecting(None))
            .unwrap();
        assert_eq!(bare.difference(&read.document).as_deref(), Some("“strokes”: its strokes"));
        assert_eq!(
            document.with_selection(None).difference(&read.document).as_deref(),
            Some("the selection")
        );
    }

    #[test]
    fn only_a_document_with_selections_is_one_of_version_2() {
        let version = |document: &Document| crate::recipe::write(document)["version"].clone();
        assert_eq!(version(&document()), 2);
        assert_eq!(version(&Document::empty(Size::new(8, 8))), 1);
    }

    #[test]
    fn what_names_no_selection_or_a_wrong_number_is_refused_by_its_path() {
        let said = |more: Value| {
            let mut text = json!({ "canvas": { "width": 8, "height": 8 } });
            text.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
            let budget = Budget::default();
            let files = &crate::UserFiles::default();
            let source = crate::recipe::RecipeSource {
                file: Path::new("r.json"),
                files,
                budget: &budget,
                onto: None,
            };
            crate::recipe::read_value(&text, source)
                .err()
                .map(|e| e.to_string())
                .unwrap_or_default()
        };
        let stroke = json!({ "selection": "s9" });
        assert_eq!(
            said(json!({ "layers": [{ "kind": "strokes", "strokes": [stroke] }] })),
            "r.json: layers[0].strokes[0].selection: is “s9”; there is no selection with that id"
        );
        let mask = json!({ "kind": "direction", "at": [1, 1], "tolerance": 200 });
        let list = json!([{ "id": "a", "mask": mask }]);
        assert!(
            said(json!({ "selections": list }))
                .contains("selections[0].mask.tolerance: is 200; it must be between")
        );
        assert!(
            said(json!({ "selections": [{ "id": "a" }, { "id": "a" }] }))
                .contains("another selection too")
        );
        assert_eq!(said(json!({ "selections": [{ "id": "a" }], "active_selection": "a" })), "");
    }
}
