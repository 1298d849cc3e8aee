//! Outlines of parts in their places, found once and known while what they are made of is the same. Floor 4. Not here:
//! what they are made of (`outlines`).

use super::Part;
use super::body::StandingOutline;
use super::outlines::OutlineKey;
use super::unchanged::apart;
use crate::document::Document;
use crate::math::Affine2;
use crate::shape::Outline;
use rayon::prelude::*;
use std::sync::Arc;

/// Each outline needs several planes of the canvas while it is found; on larger canvases they are found one by one, px.
const MOST_AT_ONCE_PX: usize = 1 << 24;

impl Document {
    /// The outlines of parts in their places, side by side once the first has found what many share.
    pub(super) fn standing_outlines(&self, parts: &[&Arc<Part>]) -> Vec<Option<StandingOutline>> {
        let Some((first, rest)) = parts.split_first() else { return Vec::new() };
        let first = self.standing_outline(first);
        let outline = |part: &&Arc<Part>| self.standing_outline(part);
        let rest: Vec<_> = match self.size.area() <= MOST_AT_ONCE_PX {
            true => rest.par_iter().map(outline).collect(),
            false => rest.iter().map(outline).collect(),
        };
        std::iter::once(first).chain(rest).collect()
    }
    /// The outline of a part before it was moved; `None` if it has none.
    pub(super) fn own_outline(&self, part: &Part) -> Option<Arc<Outline>> {
        let source = OutlineKey::of_part(self, part)??;
        let known = self.known_outline(part, &source).filter(|_| apart(part.matrix).0 == Affine2::IDENTITY);
        match known {
            Some((outline, _)) => Some(outline),
            None => source.outline(self, usize::MAX).map(Arc::new),
        }
    }
    /// The outline of a part in its place; `None` if it has none.
    fn standing_outline(&self, part: &Arc<Part>) -> Option<StandingOutline> {
        let source = OutlineKey::of_part(self, part)??;
        let (still, moved) = apart(part.matrix);
        let (outline, is_lost) = match self.known_outline(part, &source) {
            Some(known) => known,
            None => {
                let (outline, is_lost) = source.placed_outline(self, self.most_px())?;
                let outline = outline.through(still, self.most_px())?;
                // Most strokes on a drawing change few of its outlines.
                let same = self.last_outline(part).filter(|last| **last == outline);
                (same.unwrap_or_else(|| Arc::new(outline)), is_lost)
            }
        };
        Some(StandingOutline { outline, moved, is_lost })
    }
}
