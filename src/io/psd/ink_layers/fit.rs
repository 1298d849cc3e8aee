//! The sRGB pixels with which a layer looks as its inks do. Floor 5.

use super::super::LayerRecord;
use super::{InkPixel, InkView, area_of, place};
use crate::math::{Rect, srgb};

/// A pixel looks otherwise beyond this, of 1, and a layer if more than one in that many do.
const VISIBLE: f32 = 4.0 / 255.0;
const PART: usize = 500;

/// What a layer changes at a pixel.
pub struct Change {
    /// Its place in the strip, and on the canvas.
    pub at: usize,
    pub x: i32,
    pub y: i32,
    pub after: InkPixel,
    /// How much of it the layer covers.
    pub alpha: f32,
    /// The layer's own color.
    pub own: [f32; 3],
}

/// A layer's pixels of sRGB, and whether they are needed.
pub struct FittedLayer {
    pub rect: Rect,
    /// It is blended normally.
    pub is_plain: bool,
    rgba: Vec<u8>,
    painted: usize,
    /// Pixels that look otherwise with the layer's own color.
    different: usize,
}

impl FittedLayer {
    /// Empty pixels of a rectangle.
    pub fn new(rect: Rect) -> Self {
        let rgba = vec![0; area_of(rect) * 4];
        Self { rect, is_plain: false, rgba, painted: 0, different: 0 }
    }

    /// Takes what the layer changes, and puts it into the inks beneath.
    pub fn fit(
        &mut self,
        changes: Vec<Change>,
        onto: &mut [InkPixel],
        view: &InkView,
    ) -> Option<()> {
        let beneath: Vec<[f32; 4]> =
            changes.iter().map(|change| onto[change.at].straight()).collect();
        let after: Vec<[f32; 4]> = changes.iter().map(|change| change.after.straight()).collect();
        let (beneath, after) = (view.show(&beneath)?, view.show(&after)?);
        for (change, (beneath, after)) in changes.iter().zip(beneath.into_iter().zip(after)) {
            let before = onto[change.at].alpha;
            // Premultiplied, as they are composed.
            let (beneath, seen) =
                (beneath.map(|v| v * before), after.map(|v| v * change.after.alpha));
            let rest = 1.0 - change.alpha;
            let plain = |c: usize| change.alpha * change.own[c] + rest * beneath[c];
            self.painted += 1;
            let is_other = (0..3).any(|c| (plain(c) - seen[c]).abs() > VISIBLE);
            self.different += usize::from(is_other);
            let pixel = fit_pixel(beneath, seen, change.alpha, before >= 1.0);
            let at = place(self.rect, change.x, change.y) * 4;
            self.rgba[at..at + 4].copy_from_slice(&pixel);
            onto[change.at] = change.after;
        }
        Some(())
    }

    /// Whether the layer's own pixels would look otherwise.
    pub fn is_needed(&self) -> bool {
        !self.is_plain || self.different > self.painted / PART
    }

    /// In the place of what a record had.
    pub fn put_into(self, record: &mut LayerRecord, note: &'static str) {
        (record.rect, record.rgba) = (self.rect, self.rgba);
        (record.blend, record.opacity, record.fill_opacity) = (*b"norm", 255, 255);
        (record.mask, record.fill, record.adjustment, record.line) = (None, None, None, None);
        (record.adjustment_of_black, record.inks) = (None, Vec::new());
        record.note_conversion(note);
    }
}

/// The straight pixel that on `beneath` gives `seen`, both premultiplied: with the alpha that the
/// layer has, or on something opaque with the least beyond it whose color is one of sRGB.
fn fit_pixel(beneath: [f32; 3], seen: [f32; 3], alpha: f32, is_opaque: bool) -> [u8; 4] {
    let mut needed = alpha;
    for (below, to) in beneath.into_iter().zip(seen).filter(|_| is_opaque) {
        let part =
            if to < below { (below - to) / below } else { (to - below) / (1.0 - below).max(1e-6) };
        needed = needed.max(part);
    }
    // Rounded up, so that the color stays within.
    let stored = (needed.max(0.0).min(1.0) * 255.0 - 1e-3).ceil().max(1.0);
    let covered = if is_opaque { stored / 255.0 } else { alpha.max(1e-4) };
    let color = |c: usize| srgb::quantize((seen[c] - (1.0 - covered) * beneath[c]) / covered);
    let stored = if is_opaque { stored as u8 } else { srgb::quantize(alpha) };
    [color(0), color(1), color(2), stored]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_gets_the_color_and_if_need_be_the_alpha_with_which_it_looks_right() {
        let shown = |pixel: [u8; 4], beneath: [f32; 3]| {
            let [r, g, b, a] = pixel.map(|v| f32::from(v) / 255.0);
            [0, 1, 2].map(|c| a * [r, g, b][c] + (1.0 - a) * beneath[c])
        };
        let beneath = [0.8, 0.5, 0.1];
        for (seen, alpha) in
            [([0.6, 0.4, 0.3], 0.5), ([0.1, 0.9, 0.1], 0.2), ([0.8, 0.5, 0.1], 0.3)]
        {
            let pixel = fit_pixel(beneath, seen, alpha, true);
            let found = shown(pixel, beneath);
            assert!((0..3).all(|c| (found[c] - seen[c]).abs() < 0.004), "{found:?} of {seen:?}");
            assert!(f32::from(pixel[3]) / 255.0 >= alpha - 0.004);
        }
        // 0.1 of 0.8 is left if the layer covers at least seven eighths.
        assert_eq!(fit_pixel(beneath, [0.1, 0.9, 0.1], 0.2, true)[3], 224);
        // On nothing, alpha is the layer's.
        assert_eq!(fit_pixel([0.0; 3], [0.2, 0.1, 0.0], 0.4, false), [128, 64, 0, 102]);
    }
}
