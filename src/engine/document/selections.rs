//! The selections of a document: the active one, the named ones, and those that strokes were
//! painted in. Floor 4. Not here: what a selection is (`paint::selection`), cutting and copying by
//! one (`cut`).

use super::{Content, DerivedMask, Document, Layer, LayerMask, Live, MaskKind, StrokeList};
use crate::paint::{Selection, Stroke, StrokeSelection};
use crate::raster::coverage::SelectionMode;
use crate::raster::{CoverageGrid, Plane};
use std::collections::HashMap;
use std::sync::Arc;

/// A selection kept by name.
#[derive(Clone)]
pub struct NamedSelection {
    /// Its name, which no other has.
    pub name: String,
    /// What it selects.
    pub selection: Arc<Selection>,
}

impl NamedSelection {
    /// Letters of a name.
    pub const LONGEST_NAME: usize = Layer::LONGEST_NAME;
}

/// The edits; `self` never changes.
impl Document {
    /// Selections of a document, those of strokes too.
    pub const MOST_SELECTIONS: usize = 10_000;
    /// Pixels of the canvas for each selection that follows the surface, all together: each is
    /// looked for when the drawing is opened. On a canvas of 4096 × 4096 there may be 1024 of them.
    pub const MOST_REGION_PX: u64 = 1 << 34;

    /// The coverage of the active selection; `None` where everything may be changed.
    pub fn active_coverage(&self) -> Option<&CoverageGrid> {
        self.active_selection.as_ref().map(|selection| &selection.coverage)
    }

    /// With another active selection. An empty one is none.
    pub fn with_selection(&self, selection: Option<Selection>) -> Document {
        let selection = selection.filter(|selection| !selection.is_empty());
        Document { active_selection: selection.map(Arc::new), ..self.clone() }
    }

    /// With a new selection combined with the active one. If it replaces that one, or there is
    /// none, it stays unchanged.
    pub fn with_combined(&self, new: Selection, how: SelectionMode) -> Document {
        let canvas = self.size.rect();
        let new = new.within(canvas);
        let all = || CoverageGrid::full(canvas);
        let both = match (how, self.active_coverage()) {
            (SelectionMode::Replace, _) | (SelectionMode::Add | SelectionMode::Intersect, None) => {
                new
            }
            // Without a selection everything is covered.
            (SelectionMode::TakeAway, None) => {
                Selection::new(all().combined(&new.coverage, |a, b| how.of(a, b)))
            }
            (_, Some(old)) => Selection::new(old.combined(&new.coverage, |a, b| how.of(a, b))),
        };
        self.with_selection(Some(both))
    }

    /// What bounds a stroke that begins now.
    pub fn stroke_selection(&self) -> Option<StrokeSelection> {
        self.active_selection.clone().map(StrokeSelection::new)
    }

    /// With the active selection kept by a name, replacing one of that name. `None` if nothing is
    /// selected.
    pub fn with_kept_selection(&self, name: &str) -> Option<Document> {
        let (selection, name) = (self.active_selection.clone()?, name.to_owned());
        let mut selections = self.selections.clone();
        match selections.iter_mut().find(|kept| kept.name == name) {
            Some(kept) => kept.selection = selection,
            None => selections.push(NamedSelection { name, selection }),
        }
        Some(Document { selections, ..self.clone() })
    }

    /// Without the selection of a name; outlines of parts that follow it keep it as a picture.
    /// `None` if there is none.
    pub fn without_kept_selection(&self, name: &str) -> Option<Document> {
        let gone = self.selections.iter().find(|kept| kept.name == name)?;
        let selections = self.selections.iter().filter(|kept| kept.name != name).cloned().collect();
        Some(Document { selections, ..self.without_outlines_of(gone) })
    }

    /// With every selection that follows the surface found on the present one; itself if they were.
    pub fn with_selections_found(&self) -> Document {
        let scene = self.scene();
        let mut found: HashMap<usize, Arc<Selection>> = HashMap::new();
        for selection in SelectionList::of(self).all() {
            if let Some(next) = selection.found_on(&scene) {
                found.insert(Arc::as_ptr(selection) as usize, Arc::new(next));
            }
        }
        if found.is_empty() {
            return self.clone();
        }
        let next = |selection: &Arc<Selection>| {
            found.get(&(Arc::as_ptr(selection) as usize)).unwrap_or(selection).clone()
        };
        let kept = |kept: &NamedSelection| NamedSelection {
            selection: next(&kept.selection),
            ..kept.clone()
        };
        Document {
            active_selection: self
                .active_selection
                .as_ref()
                .map(next)
                .filter(|found| !found.is_empty()),
            selections: self.selections.iter().map(kept).collect(),
            layers: self.layers.iter().map(|layer| selecting(layer, &next)).collect(),
            ..self.clone()
        }
    }

    /// How far a layer covers each pixel of the canvas by its mask; fully if it has none.
    pub fn mask_coverage(&self, layer: &Layer) -> CoverageGrid {
        let Some(mask) = &layer.mask else { return CoverageGrid::full(self.size.rect()) };
        let scene = self.scene_of(layer.id).unwrap_or_else(|| self.scene());
        match mask.as_picture(&scene) {
            LayerMask { kind: MaskKind::File { coverage, .. }, invert, .. } => {
                let way = coverage.map(|c| if invert { 255 - c } else { c });
                CoverageGrid::from_plane(&way, 0, 0)
            }
            _ => CoverageGrid::default(),
        }
    }

    /// The active selection as a mask: what was selected by the surface follows it, all else is a
    /// picture.
    pub fn selection_as_mask(&self) -> Option<LayerMask> {
        let selection = self.active_selection.as_deref()?;
        let kind = match selection.made {
            Some(region) if self.surface.is_some() => DerivedMask::Region(region).into(),
            _ => picture(&selection.coverage.to_plane(self.size.rect())),
        };
        Some(LayerMask::new(kind))
    }
}

/// A mask that came from no file.
pub(super) fn picture(coverage: &Plane<u8>) -> MaskKind {
    MaskKind::File { file: String::new(), coverage: Arc::new(coverage.clone()) }
}

/// A layer with the selections of its strokes replaced; the very same if none was.
pub(super) fn selecting(
    layer: &Arc<Layer>,
    next: &impl Fn(&Arc<Selection>) -> Arc<Selection>,
) -> Arc<Layer> {
    let content = match &layer.content {
        Content::Strokes(live) => {
            let mut changed = false;
            let mut stroke = |stroke: &Arc<Stroke>| {
                let Some(own) = stroke.selection() else { return stroke.clone() };
                let selection = next(&own.selection);
                if Arc::ptr_eq(&selection, &own.selection) {
                    return stroke.clone();
                }
                changed = true;
                Arc::new(stroke.selecting(Some(StrokeSelection { selection, moved: own.moved })))
            };
            let strokes = live.params().strokes.iter().map(&mut stroke).collect();
            changed.then(|| Content::Strokes(Live::new(StrokeList { strokes })))
        }
        Content::Group(group) => {
            let layers: Vec<_> = group.layers.iter().map(|layer| selecting(layer, next)).collect();
            let changed = layers.iter().zip(&group.layers).any(|(a, b)| !Arc::ptr_eq(a, b));
            changed.then(|| Content::Group(super::Group { layers, ..group.clone() }))
        }
        _ => None,
    };
    content
        .map_or_else(|| layer.clone(), |content| Arc::new(Layer { content, ..Layer::clone(layer) }))
}

/// Every selection of a document once, in a fixed order: those kept by name, the active one, those
/// of strokes. Files refer to them by position.
pub struct SelectionList {
    all: Vec<(Option<String>, Arc<Selection>)>,
    places: HashMap<usize, usize>,
}

impl SelectionList {
    /// The selections of a document, each once.
    pub fn of(document: &Document) -> Self {
        let mut list = Self { all: Vec::new(), places: HashMap::new() };
        for kept in &document.selections {
            // Two names of one selection are two entries.
            list.places.entry(Arc::as_ptr(&kept.selection) as usize).or_insert(list.all.len());
            list.all.push((Some(kept.name.clone()), kept.selection.clone()));
        }
        document.active_selection.iter().for_each(|selection| list.add(selection));
        for (_, layer) in document.walk() {
            if let Content::Strokes(live) = &layer.content {
                let strokes = live.params().strokes.iter();
                strokes
                    .filter_map(|stroke| stroke.selection())
                    .for_each(|own| list.add(&own.selection));
            }
        }
        list
    }

    fn add(&mut self, selection: &Arc<Selection>) {
        let place = self.all.len();
        if *self.places.entry(Arc::as_ptr(selection) as usize).or_insert(place) == place {
            self.all.push((None, selection.clone()));
        }
    }

    /// All of them, in the order of the list.
    pub fn all(&self) -> impl ExactSizeIterator<Item = &Arc<Selection>> {
        self.all.iter().map(|(_, selection)| selection)
    }

    /// With the names of those that have one.
    pub fn iter_with_names(&self) -> impl Iterator<Item = (Option<&str>, &Arc<Selection>)> {
        self.all.iter().map(|(name, selection)| (name.as_deref(), selection))
    }

    /// The position of a selection among all; `None` for one of another document.
    pub fn place(&self, selection: &Arc<Selection>) -> Option<usize> {
        self.places.get(&(Arc::as_ptr(selection) as usize)).copied()
    }

    /// There is none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }
}

#[cfg(test)]
mod tests;
