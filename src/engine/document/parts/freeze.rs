//! Outlines that follow layers become pictures before these layers are merged. Floor 4.

use super::outlines::OutlineKey;
use super::{CoverageFile, OutlineSource, Part};
use crate::document::{Document, Layer, LayerId, Progress};
use crate::math::Size;
use crate::raster::Plane;
use crate::shape::Outline;
use std::sync::Arc;

impl Document {
    /// With the parts that are outlined by some layers, or by layers in these, keeping their
    /// outlines as pictures: the shape stays when the layers are merged. `None` if canceled.
    ///
    /// What an outline has left of the frame or above it is cut off. A part with nothing left goes
    /// on naming its layer.
    pub fn with_outlines_frozen(&self, layers: &[LayerId], progress: &Progress) -> Option<Self> {
        let follows = |part: &Part| match part.outline() {
            Some(OutlineSource::Layer { layer, .. }) => {
                let is_in = |outer: &LayerId| self.layer(*outer).zip(self.layer_named(layer));
                layers.iter().filter_map(is_in).any(|(outer, named)| contains(outer, named.id))
            }
            _ => false,
        };
        if !self.parts.list.iter().any(|part| follows(part)) {
            return Some(self.clone());
        }
        let freeze = |part: &Arc<Part>| {
            let key = OutlineKey::of_part(self, part).filter(|_| follows(part)).flatten();
            let frozen = key.and_then(|key| picture_of(&key.outline(self, self.most_px())?));
            let mut own = Part::clone(part);
            if let (Some(frozen), Some(outline)) = (frozen, own.outline_mut()) {
                *outline = OutlineSource::File(frozen);
            }
            Arc::new(own)
        };
        self.with_parts_with_progress(self.parts.list.iter().map(freeze).collect(), progress)
    }
}

/// Whether a layer is the one meant, or a group around it.
fn contains(outer: &Layer, id: LayerId) -> bool {
    let group = outer.content.group();
    outer.id == id || group.is_some_and(|group| group.layers.iter().any(|one| contains(one, id)))
}

/// An outline as a picture whose first pixel is the frame's; `None` if nothing of it lies there.
fn picture_of(outline: &Outline) -> Option<CoverageFile> {
    let rect = outline.rect();
    let size = Size::new(u32::try_from(rect.x1).ok()?, u32::try_from(rect.y1).ok()?);
    let coverage = Plane::from_fn(size, |x, y| {
        outline.coverage().get(x as i32 - rect.x0, y as i32 - rect.y0).unwrap_or(0)
    });
    let is_seen = coverage.values().iter().any(|covered| *covered > 0);
    is_seen.then(|| CoverageFile { file: String::new(), coverage: Arc::new(coverage) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_of_an_outline_begins_at_the_frame_and_is_never_empty() {
        let covered = Plane::from_fn(Size::new(6, 4), |_, _| 255);
        let size_at = |x: i32, y: i32| {
            let outline = Outline::new((x, y), &covered).expect("it covers something");
            picture_of(&outline).map(|picture| picture.coverage.size())
        };
        // With an empty pixel beyond it.
        assert_eq!(size_at(-2, 3), Some(Size::new(5, 8)));
        assert_eq!(size_at(-6, 3), None);
        assert_eq!(size_at(2, -9), None);
    }
}
