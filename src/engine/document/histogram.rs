//! How many pixels have which tone beneath a layer, for the panels of adjustments. Floor 4. Some
//! tiles spread over the picture stand for all of it.

use super::compose::{ComposeFlow, Composer};
use super::prepare::PreparedDocument;
use super::progress::in_parallel;
use super::{Document, LayerId, Progress, Role};
use crate::math::srgb::quantize;
use crate::raster::{PlanarTile, TileAt};

/// Counts of each byte of red, green and blue, and of all three together.
#[derive(Clone, Debug, PartialEq)]
pub struct Histogram {
    /// How many pixels have each brightness.
    pub all: [u32; 256],
    /// How many have each red, green and blue.
    pub channels: [[u32; 256]; 3],
}

impl Default for Histogram {
    fn default() -> Self {
        Self { all: [0; 256], channels: [[0; 256]; 3] }
    }
}

impl Histogram {
    /// Tiles that are composed at most: a few milliseconds.
    const MOST_TILES: usize = 96;

    /// Of what lies beneath an adjustment in its scope; `None` if it is no visible adjustment, or
    /// canceled.
    pub fn of_backdrop(document: &Document, layer: LayerId, progress: &Progress) -> Option<Self> {
        let prepared = PreparedDocument::new(document, progress)?;
        let sought = prepared.adjustment_of(layer);
        let below = sought?;
        let tiles = prepared.all_tiles();
        let step = tiles.len().div_ceil(Self::MOST_TILES).max(1);
        let some: Vec<TileAt> = tiles.into_iter().step_by(step).collect();
        prepared.filter_beneath(&some, below, None, progress)?;
        let of_tile = |at| {
            let composer = Composer { prepared: &prepared, at, far: None, sought, floats: None };
            let mut counts = Self::default();
            if let ComposeFlow::Break(beneath) =
                composer.stack(&prepared.stack, &mut PlanarTile::transparent())
            {
                counts.add(&beneath);
            }
            counts
        };
        let counts = in_parallel(&some, progress, of_tile)?;
        Some(counts.iter().fold(Self::default(), Self::plus))
    }

    /// Pixels that are at least half there, by their straight colors.
    fn add(&mut self, pixels: &PlanarTile) {
        for row in pixels.rows() {
            for (x, &a) in row.a.iter().enumerate().filter(|(_, a)| **a >= 0.5) {
                for (channel, counts) in row.rgb.iter().zip(&mut self.channels) {
                    let byte = usize::from(quantize(channel[x] / a));
                    counts[byte] += 1;
                    self.all[byte] += 1;
                }
            }
        }
    }

    fn plus(mut self, other: &Self) -> Self {
        let sum = |own: &mut [u32; 256], other: &[u32; 256]| {
            own.iter_mut().zip(other).for_each(|(a, b)| *a += b);
        };
        sum(&mut self.all, &other.all);
        self.channels.iter_mut().zip(&other.channels).for_each(|(own, other)| sum(own, other));
        self
    }
}

impl PreparedDocument {
    /// The number of a layer among the adjustments, in the order they apply.
    fn adjustment_of(&self, layer: LayerId) -> Option<usize> {
        let mut left: Vec<_> = self.stack.iter().collect();
        while let Some(node) = left.pop() {
            if node.layer.id == layer && matches!(node.layer.content.role(), Role::Adjusts(_)) {
                return Some(node.adjustments.start);
            }
            left.extend(node.children.iter().chain(&node.clipped));
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Layer;
    use crate::math::{Size, srgb::Color};
    use crate::paint::ColorAdjustment;
    use std::sync::Arc;

    #[test]
    fn tones_are_those_beneath_the_adjustment() {
        let fill = |r| Layer::new("fill", Color { r, g: 20, b: 30, a: 255 });
        let curves = Layer::new("adjust", ColorAdjustment::from_name("invert").unwrap());
        let id = curves.id;
        let layers = vec![Arc::new(fill(200)), Arc::new(curves), Arc::new(fill(9))];
        let document = Document { layers, ..Document::empty(Size::new(64, 64)) };
        let found = Histogram::of_backdrop(&document, id, &Progress::default()).unwrap();
        assert_eq!(found.channels[0][200], 64 * 64);
        assert_eq!((found.channels[1][20], found.all[30]), (64 * 64, 64 * 64));
        let other = document.layers[0].id;
        assert_eq!(Histogram::of_backdrop(&document, other, &Progress::default()), None);
    }
}
