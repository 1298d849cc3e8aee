//! The forms of a document's parts in their places: what a pointer hits, and what a list shows. Floor 4. The surface
//! was made of the same forms.

use super::Part;
use crate::document::Document;
use crate::math::{Affine2, Vec2};
use crate::shape::Form;
use std::sync::Arc;

impl Document {
    /// The visible forms, with their parts, the farthest first. Nothing of the shape that was made last is made again.
    /// Parts that make no form, such as an empty outline, are left out.
    ///
    /// While the user drags parts, their forms are those that were made last, where the parts were then.
    pub fn part_forms(&self) -> Vec<(Arc<Part>, Arc<Form>)> {
        if !self.is_shaped() {
            return self.last_part_forms().into_iter().map(|(part, form, _)| (part, form)).collect();
        }
        let shown = || self.parts.list.iter().filter(|part| part.visible && part.on().is_none());
        if shown().any(|part| self.made_form(part).is_none()) {
            self.make_forms();
        }
        shown().filter_map(|part| Some((part.clone(), self.made_form(part)?))).collect()
    }
    /// The forms that were made last, with their parts as they are now, and the map of each form from where it was made
    /// to where its part is.
    pub fn last_part_forms(&self) -> Vec<(Arc<Part>, Arc<Form>, Affine2)> {
        let shown = self.parts.list.iter().filter(|part| part.visible && part.on().is_none());
        let last = |part: &Arc<Part>| {
            let (then, form) = self.last_form(&part.id)?;
            Some((part.clone(), form, part.matrix * then.matrix.inverse()))
        };
        shown.filter_map(last).collect()
    }
    /// The nearest part whose form covers a canvas point by half or more.
    pub fn part_at(&self, at: Vec2) -> Option<Arc<Part>> {
        nearest_at(&self.part_forms(), at)
    }
}

/// The last of some forms that covers a canvas point by half or more: the nearest of a document's.
pub fn nearest_at(forms: &[(Arc<Part>, Arc<Form>)], at: Vec2) -> Option<Arc<Part>> {
    let (x, y) = (at.x.floor() as i32, at.y.floor() as i32);
    let covers = |form: &Form| {
        let (x, y) = (x.saturating_sub(form.corner.0), y.saturating_sub(form.corner.1));
        form.coverage.get(x, y).unwrap_or(0) >= 128
    };
    forms.iter().rev().find(|(_, form)| covers(form)).map(|(part, _)| part.clone())
}
