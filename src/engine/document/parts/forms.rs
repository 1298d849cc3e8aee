//! The forms of a document's parts in their places: what a pointer hits, and what a list shows.
//! Floor 4. The surface was made of the same forms.

use super::{FormArea, Part};
use crate::document::{Document, Progress};
use crate::math::{Affine2, Vec2, vec2};
use crate::memory::free_bytes;
use std::sync::Arc;

impl Document {
    /// Where the visible forms lie, with their parts, the farthest first. Nothing of the shape that
    /// was made last is made again. Parts that make no form, such as an empty outline, are left
    /// out.
    ///
    /// While the user drags parts, their forms are those that were made last, where the parts were
    /// then.
    pub fn part_areas(&self) -> Vec<(Arc<Part>, Arc<FormArea>)> {
        if self.is_ahead() {
            return self
                .last_part_areas()
                .into_iter()
                .map(|(part, area, _)| (part, area))
                .collect();
        }
        let shown = || self.parts.list.iter().filter(|part| part.visible && part.on().is_none());
        let is_missing = shown().any(|part| self.cached_area(part).is_none());
        // What was made last may be of another version of the document.
        if is_missing && (self.has_its_surface() || self.shape_fits_in(free_bytes()).is_ok()) {
            drop(self.derived(&Progress::default()));
        }
        shown().filter_map(|part| Some((part.clone(), self.cached_area(part)?))).collect()
    }

    /// Where the forms lie that were made last, with their parts as they are now, and the map of
    /// each form from where it was made to where its part is.
    pub fn last_part_areas(&self) -> Vec<(Arc<Part>, Arc<FormArea>, Affine2)> {
        let shown = self.parts.list.iter().filter(|part| part.visible && part.on().is_none());
        let last = |part: &Arc<Part>| {
            let (then, area) = self.last_area(&part.id)?;
            Some((part.clone(), area, part.matrix * then.matrix.inverse()))
        };
        shown.filter_map(last).collect()
    }

    /// The nearest part whose form covers a canvas point by half or more.
    pub fn part_at(&self, at: Vec2) -> Option<Arc<Part>> {
        nearest_at(&self.part_areas(), at)
    }
}

/// The last of some forms that covers a canvas point by half or more: the nearest of a document's.
pub fn nearest_at(areas: &[(Arc<Part>, Arc<FormArea>)], at: Vec2) -> Option<Arc<Part>> {
    let (x, y) = (at.x.floor() as i32, at.y.floor() as i32);
    areas.iter().rev().find(|(_, area)| area.at(x, y) >= 128).map(|(part, _)| part.clone())
}

/// A canvas point where a part is seen, in the middle of its longest visible row; `None` where
/// nothing of it is.
pub fn visible_place(document: &Document, part: &str) -> Option<Vec2> {
    let areas = document.part_areas();
    let place = areas.iter().position(|(known, _)| known.id == part)?;
    let (own, nearer) = (&areas[place].1, &areas[place + 1..]);
    let (low, high) = own.covered_box();
    let [x0, y0, x1, y1] = [low.x, low.y, high.x, high.y].map(|v| v as i32);
    let canvas = document.size.rect();
    let is_seen = |x: i32, y: i32| {
        canvas.contains(x, y)
            && own.at(x, y) >= 128
            && nearer.iter().all(|(_, area)| area.at(x, y) < 128)
    };
    let mut longest: Option<(i32, Vec2)> = None;
    for y in y0..y1 {
        let mut run = 0;
        for x in x0..=x1 {
            if x < x1 && is_seen(x, y) {
                run += 1;
                continue;
            }
            if run > longest.map_or(0, |(length, _)| length) {
                longest = Some((run, vec2(x as f32 - 0.5 * run as f32, y as f32 + 0.5)));
            }
            run = 0;
        }
    }
    longest.map(|(_, at)| at)
}
