//! Actions on the shape of the document in front: its parts, the farthest first. What cannot be
//! done says why. Floor 6. `new` makes parts, `grays` the pictures for them from layers; `first`
//! gives a drawing its first shape, `ink` puts its lines on top, `list` orders parts, `split` divides
//! them. Not here: parts that the pen changes on the canvas (`tools::shape`).

pub mod first;
mod grays;
mod ink;
mod list;
pub mod new;
pub mod paths;
mod split;

pub use first::FirstShape;
pub use new::NewPart;

use crate::document::parts::{Part, from_flats::PartFor};
use crate::document::{Document, Inflation, Progress};
use crate::io::Budget;
use crate::io::recipe::parts::read_part;
use crate::math::PlaneMap;
use crate::session::replay::{ReplayValue, actions, names, record};
use crate::session::{LayerPath, OpenDocument, Session};
use crate::shape::SculptTool;
use crate::tools::ShapeSettings;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;

names!(SculptTool);
record!(ShapeSettings { tool, size, hardness, height, share, normal, radius, reach });

/// A preset of inflation, by its name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InflationPreset(pub Inflation);

/// Whether there is a part for each color was the question before areas were told apart.
impl ReplayValue for PartFor {
    fn to_value(&self) -> Value {
        match self {
            PartFor::Layer => false.into(),
            PartFor::Color => true.into(),
            PartFor::Area => AREAS.into(),
        }
    }

    fn read(value: &Value) -> Result<Self, String> {
        match value {
            Value::Bool(is_color) => Ok(if *is_color { PartFor::Color } else { PartFor::Layer }),
            Value::String(word) if [AREAS, "places"].contains(&word.as_str()) => Ok(PartFor::Area),
            _ => Err(format!("must be true, false or “{AREAS}”")),
        }
    }
}

const AREAS: &str = "areas";

impl ReplayValue for InflationPreset {
    fn to_value(&self) -> Value {
        let known = Inflation::PRESETS.iter().find(|(preset, _)| *preset == self.0);
        known.map_or(Inflation::PRESETS[0].1, |(_, name)| name).into()
    }

    fn read(value: &Value) -> Result<Self, String> {
        let known = value
            .as_str()
            .and_then(|word| Inflation::PRESETS.iter().find(|(_, name)| *name == word));
        known
            .map(|(preset, _)| InflationPreset(*preset))
            .ok_or_else(|| format!("is {value}, which is not a preset"))
    }
}

actions! {
    /// `part` is always an id.
    PartAction {
        /// From the active layer, the selection or the selected part, as its kind says; in front
        /// of all others.
        "add" Add { kind: NewPart }
        /// A layer gets a shape: one part from its alpha (`false`), one from each of its flat
        /// colors (`true`) or from each area of one (`"areas"`), and a layer of light.
        "shape" Shape { layer: LayerPath, preset: InflationPreset, flats: PartFor }
        /// A layer of an SVG gets a shape, a part for each filled path. `file`: the SVG, for a layer
        /// of paint that it was opened as.
        "shape paths" ShapePaths { layer: LayerPath, file: Option<PathBuf>, preset: InflationPreset }
        /// A part in a new version, as recipes write it; shown only, until it is `done`.
        "set" Set { part: Value, done: bool }
        /// With what lies on it.
        "delete" Delete { part: String }
        /// So that this many parts with a form of their own lie behind it; what lies on it follows.
        "order" Order { part: String, index: usize }
        "visible" Visible { part: String, on: bool }
        "duplicate" Duplicate { part: String }
        /// A part of a color in several areas becomes a part for each.
        "split" Split { part: String }
        /// A drawing becomes a layer for each part that has its outline from it, which goes with
        /// the part.
        "cut" Cut { layer: LayerPath }
        /// The ink of a drawing becomes a layer of lines on top, which no light falls on.
        "ink" Ink { layer: LayerPath }
        /// The paper of a scan becomes transparent; its lines stand on top.
        "paper" Paper { layer: LayerPath }
        "select" Select { part: String }
        /// The whole shape moved by a map of the canvas (a, b, c, d, e, f), with what is painted on
        /// it; shown only, until it is `done`.
        "take along" TakeAlong { by: [f64; 6], done: bool }
        /// What the tools that touch and sculpt do.
        "settings" Settings { shape: ShapeSettings }
    }
}

/// Why something could not be done.
type PartRefusal = &'static str;
const NO_PART: PartRefusal = "There is no such part.";

impl PartAction {
    /// Performs it.
    pub fn apply(&self, session: &mut Session) {
        if let PartAction::Settings { shape } = self {
            session.tools.shape = shape.clamp_to_ranges();
            return;
        }
        session.drop_gesture();
        let Some(open) = session.active_mut() else { return session.say("There is no document.") };
        let done = match self {
            PartAction::Set { part, done } => set(open, part, *done),
            PartAction::TakeAlong { by, done } => take_along(open, *by, *done),
            PartAction::Select { part } => match open.document().parts.part(part) {
                Some(_) => {
                    open.part = Some(part.clone());
                    Ok(())
                }
                None => Err(NO_PART.into()),
            },
            PartAction::Shape { .. } | PartAction::ShapePaths { .. } => {
                open.forget_preview();
                let shaped = self.perform_long(open.document(), &Progress::default());
                shaped.map(|shaped| shaped.into_iter().for_each(|shaped| shaped.put(open)))
            }
            _ => {
                open.forget_preview();
                self.step(open).map_err(str::to_owned)
            }
        };
        session.notes.extend(done.err());
    }

    /// A description of a long edit.
    pub fn takes_long(&self) -> Option<&'static str> {
        let is_long = matches!(self, PartAction::Shape { .. } | PartAction::ShapePaths { .. });
        is_long.then_some("Giving it a shape")
    }

    /// Performs a long edit on a document, on any thread; `None` for any other.
    pub fn perform_long(
        &self,
        document: &Document,
        progress: &Progress,
    ) -> Result<Option<FirstShape>, String> {
        let find = |layer: &LayerPath| layer.find(document).map(|layer| layer.id);
        let no_layer = || "There is no such layer.".to_owned();
        match self {
            PartAction::Shape { layer, preset, flats } => {
                let layer = find(layer).ok_or_else(no_layer)?;
                first::shape_layer(document, layer, preset.0, *flats, progress)
                    .map(Some)
                    .map_err(str::to_owned)
            }
            PartAction::ShapePaths { layer, file, preset } => {
                let layer = find(layer).ok_or_else(no_layer)?;
                paths::shape_paths(document, layer, file.as_deref(), preset.0, progress).map(Some)
            }
            _ => Ok(None),
        }
    }

    fn step(&self, open: &mut OpenDocument) -> Result<(), PartRefusal> {
        let document = open.document();
        let of = |id: &str| document.parts.part(id).cloned().ok_or(NO_PART);
        let (label, next, selected) = match self {
            PartAction::Add { kind } => {
                let part = new::make_part(*kind, open)?;
                let id = part.id.clone();
                let next = list::with_new(document, part);
                // What lies on another shows there. What could not be made is refused below.
                let shows = next
                    .parts
                    .part(&id)
                    .and_then(|part| part.on().map(str::to_owned))
                    .unwrap_or(id.clone());
                if next.is_shaped() && !next.part_areas().iter().any(|(part, _)| part.id == shows) {
                    return Err(kind.why_empty());
                }
                ("Add part", next, Some(id))
            }
            PartAction::Delete { part } => {
                ("Delete part", document.without_part(part).ok_or(NO_PART)?, None)
            }
            PartAction::Order { part, index } => {
                ("Order parts", list::with_part_at(document, &of(part)?.id, *index), None)
            }
            PartAction::Visible { part, on } => {
                let next = Part { visible: *on, ..Part::clone(&*of(part)?) };
                (if *on { "Show part" } else { "Hide part" }, document.with_part(next), None)
            }
            PartAction::Duplicate { part } => {
                let (next, id) = list::duplicate(document, &*of(part)?);
                ("Duplicate part", next, Some(id))
            }
            PartAction::Split { part } => {
                let part = of(part)?;
                ("Split by area", split::split_by_area(document, &part)?, Some(part.id.clone()))
            }
            PartAction::Ink { layer } => {
                let (next, lines) = ink::on_top(document, layer)?;
                if open.commit("Lines on top", next) {
                    open.active_layer = Some(lines);
                }
                return Ok(());
            }
            PartAction::Paper { layer } => {
                let (next, lines) = ink::without_paper(document, layer)?;
                if open.commit("Make paper transparent", next) {
                    open.active_layer = Some(lines);
                }
                return Ok(());
            }
            PartAction::Cut { layer } => {
                let layer =
                    layer.find(document).map(|layer| layer.id).ok_or("There is no such layer.")?;
                let (next, group) = document.cut_by_parts(layer)?;
                if open.commit("Cut drawing by parts", next) {
                    open.active_layer = Some(group);
                }
                return Ok(());
            }
            PartAction::Shape { .. }
            | PartAction::ShapePaths { .. }
            | PartAction::Set { .. }
            | PartAction::TakeAlong { .. }
            | PartAction::Select { .. }
            | PartAction::Settings { .. } => return Ok(()),
        };
        if open.commit(label, next) {
            open.part = selected.or(open.part.take());
            open.repair();
        }
        Ok(())
    }
}

/// The document with its shape moved by a map of the canvas: a step, or a preview of one.
fn take_along(open: &mut OpenDocument, by: [f64; 6], done: bool) -> Result<(), String> {
    let map = PlaneMap::affine(by).ok_or("A shape needs an area.")?;
    let next = open.document().with_shape_through(&map).inspect_err(|_| open.forget_preview())?;
    match done {
        true => drop(open.commit("Transform shape", next)),
        false => open.show("Transform shape", next),
    }
    Ok(())
}

/// A part of the document in a new version.
fn set(open: &mut OpenDocument, value: &Value, done: bool) -> Result<(), String> {
    let document = open.document();
    let read = read_part(Path::new("part"), value, document, &Budget::holding(document));
    let next = match read {
        Ok(next) => next,
        Err(error) => {
            open.forget_preview();
            return Err(error.to_string());
        }
    };
    let Some(old) = document.parts.part(&next.id) else {
        open.forget_preview();
        return Err(NO_PART.into());
    };
    let label = label(old, &next);
    if done {
        let next = document.with_part(next);
        open.commit(label, next);
    } else {
        // A drag must not wait: whoever shows the document makes its shape.
        let next = document.with_part_ahead(next);
        open.show(label, next);
    }
    Ok(())
}

/// The name of a change of a part.
fn label(old: &Part, next: &Part) -> &'static str {
    let only = |same: &dyn Fn(&mut Part)| {
        let mut changed = old.clone();
        same(&mut changed);
        changed == *next
    };
    if only(&|part| part.name.clone_from(&next.name)) {
        "Rename part"
    } else if only(&|part| part.matrix = next.matrix) {
        "Move part"
    } else if only(&|part| part.tilt_deg = next.tilt_deg) {
        "Tilt part"
    } else if only(&|part| part.combine = next.combine) {
        "Combine part"
    } else {
        "Shape part"
    }
}

/// An id that no part of a document has: `part-1`, `part-2`, …
fn free_id(document: &Document, taken: &[Arc<Part>]) -> String {
    let is_taken =
        |id: &str| document.parts.part(id).is_some() || taken.iter().any(|part| part.id == id);
    (1..).map(|i| format!("part-{i}")).find(|id| !is_taken(id)).unwrap_or_default()
}

#[cfg(test)]
mod tests;
