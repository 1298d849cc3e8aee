//! Outlines of parts in their places, found once and known while what they are made of is the same.
//! Floor 4. Not here: what they are made of (`outlines`).

use super::body::PlacedOutline;
use super::outlines::OutlineKey;
use super::unchanged::split_whole_px;
use super::{OutlineSource, Part};
use crate::document::Document;
use crate::math::srgb::Color;
use crate::math::{Affine2, parallel};
use crate::shape::Outline;
use std::sync::Arc;

/// Each outline needs several planes of the canvas while it is found; on larger canvases they are
/// found one by one, px.
const MOST_AT_ONCE_PX: usize = 1 << 24;

/// A part, and the room for its outline.
struct Sought<'a> {
    part: &'a Arc<Part>,
    found: &'a mut Option<PlacedOutline>,
}

impl Document {
    /// The outlines of parts in their places, side by side: but one after the other where parts are
    /// of one color, whose places are found once, and after the first, which finds what all share.
    pub(super) fn placed_outlines(&self, parts: &[&Arc<Part>]) -> Vec<Option<PlacedOutline>> {
        let mut found: Vec<Option<PlacedOutline>> = vec![None; parts.len()];
        let Some((first, rest)) = found.split_first_mut() else { return found };
        *first = self.placed_outline(parts[0]);
        let color = |part: &Part| match part.outline() {
            Some(OutlineSource::Layer { color: Some(flat), .. }) => Some(flat.color),
            _ => None,
        };
        let mut groups: Vec<(Option<Color>, Vec<Sought>)> = Vec::new();
        for (part, found) in parts[1..].iter().zip(rest) {
            let of = color(part);
            match groups.iter_mut().find(|(other, _)| of.is_some() && *other == of) {
                Some((_, group)) => group.push(Sought { part, found }),
                None => groups.push((of, vec![Sought { part, found }])),
            }
        }
        let find = |(_, group): (Option<Color>, Vec<Sought>)| {
            group.into_iter().for_each(|Sought { part, found }| *found = self.placed_outline(part));
        };
        match self.size.area() <= MOST_AT_ONCE_PX {
            true => parallel::for_each(groups, 1, find),
            false => groups.into_iter().for_each(find),
        }
        found
    }

    /// The outline of a part before it was moved; `None` if it has none.
    pub(super) fn own_outline(&self, part: &Part) -> Option<Arc<Outline>> {
        let source = OutlineKey::of_part(self, part)??;
        let known = self
            .cached_outline(part, &source)
            .filter(|_| split_whole_px(part.matrix).0 == Affine2::IDENTITY);
        match known {
            Some((outline, _)) => Some(outline),
            None => source.outline(self, usize::MAX).map(Arc::new),
        }
    }

    /// The outline of a part in its place; `None` if it has none.
    fn placed_outline(&self, part: &Arc<Part>) -> Option<PlacedOutline> {
        let source = OutlineKey::of_part(self, part)??;
        let (still, moved) = split_whole_px(part.matrix);
        let (outline, is_lost) = match self.cached_outline(part, &source) {
            Some(known) => known,
            None => {
                let (outline, is_lost) = source.placed_outline(self, self.most_px())?;
                let outline = outline.transformed(still, self.most_px())?;
                // Most strokes on a drawing change few of its outlines.
                let same = self.last_outline(part).filter(|last| **last == outline);
                (same.unwrap_or_else(|| Arc::new(outline)), is_lost)
            }
        };
        Some(PlacedOutline { outline, moved, is_lost })
    }
}
