//! A layer's masks as a file holds them: their place, density and softness, and how they combine.
//! Floor 5. Not here: reading their channels (`layers`), paths (`outline`).

use super::RecordMask;
use super::cursor::ByteCursor;
use crate::document::{LayerMask, MaskKind};
use crate::math::{Rect, Size};
use crate::raster::{Plane, blur};
use std::sync::Arc;

/// A mask's place and what its flags say; its values are a channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaskRecord {
    pub rect: Rect,
    pub outside: u8,
    pub disabled: bool,
    inverted: bool,
    /// Drawn from the vector mask, not painted.
    pub is_drawn: bool,
}

/// How much of a mask counts, and how far its edge is smoothed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Softness {
    /// 255: all of it.
    pub density: u8,
    pub feather_px: f32,
}

/// What precedes a layer's masks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaskData {
    /// Channel −2: the painted mask, or the painted and the vector mask together.
    pub shown: MaskRecord,
    /// Channel −3: the painted mask, where −2 is both.
    pub painted: Option<MaskRecord>,
    /// One each for the painted mask and the vector mask.
    pub softness: [Softness; 2],
}

impl Softness {
    /// All of a mask counts, as it was drawn.
    pub const HARD: Self = Self { density: 255, feather_px: 0.0 };
}

/// No real drawing has more.
const WIDEST_FEATHER_PX: f32 = 1000.0;

impl MaskData {
    /// `None` without a mask.
    pub fn read(mut data: ByteCursor) -> Option<Self> {
        let rect = data.rect()?;
        let (outside, flags) = (data.u8()?, data.u8()?);
        // Rectangle, outside and flags of the painted mask take 18 bytes.
        let painted = if data.rest().len() >= 18 {
            let (flags, outside) = (data.u8()?, data.u8()?);
            Some(MaskRecord::new(data.rect()?, outside, flags))
        } else {
            None
        };
        let mut softness = [Softness::HARD; 2];
        if flags & 16 != 0
            && let Some(given) = data.u8()
        {
            for (i, soft) in softness.iter_mut().enumerate() {
                if given & 1 << (2 * i) != 0 {
                    soft.density = data.u8()?;
                }
                if given & 2 << (2 * i) != 0 {
                    soft.feather_px = (data.f64()? as f32).max(0.0).min(WIDEST_FEATHER_PX);
                }
            }
        }
        Some(Self { shown: MaskRecord::new(rect, outside, flags), painted, softness })
    }
}

impl MaskRecord {
    fn new(rect: Rect, outside: u8, flags: u8) -> Self {
        let [disabled, inverted, is_drawn] = [2, 4, 8].map(|bit| flags & bit != 0);
        Self { rect, outside, disabled, inverted, is_drawn }
    }

    /// The mask that its channel's values make.
    pub fn with(&self, rect: Rect, mut values: Vec<u8>) -> RecordMask {
        let mut outside = self.outside;
        if self.inverted {
            outside = 255 - outside;
            values.iter_mut().for_each(|v| *v = 255 - *v);
        }
        RecordMask { rect, outside, values, disabled: self.disabled }
    }
}

impl RecordMask {
    /// A mask with the coverage of a plane of the canvas.
    pub fn of_canvas(size: Size, values: Vec<u8>) -> Self {
        RecordMask { rect: size.rect(), outside: 0, values, disabled: false }
    }

    /// The coverage at a canvas pixel.
    pub fn at(&self, x: i32, y: i32) -> u8 {
        if !self.rect.contains(x, y) {
            return self.outside;
        }
        let at = (y - self.rect.y0) as usize * self.rect.width() + (x - self.rect.x0) as usize;
        self.values.get(at).copied().unwrap_or(self.outside)
    }

    /// The least rectangle around what is covered within its own.
    pub fn bounds(&self) -> Rect {
        let width = self.rect.width().max(1);
        let covered = self
            .values
            .iter()
            .enumerate()
            .filter(|(_, v)| **v > 0)
            .map(|(i, _)| (i % width, i / width));
        covered.fold(Rect::EMPTY, |all, (x, y)| {
            let (x, y) = (self.rect.x0 + x as i32, self.rect.y0 + y as i32);
            all.union(Rect::new(x, y, x + 1, y + 1))
        })
    }

    /// As a layer's mask.
    pub fn to_layer_mask(&self, size: Size) -> LayerMask {
        let coverage = Arc::new(self.plane(size));
        let kind = MaskKind::File { file: String::new(), coverage };
        LayerMask { disabled: self.disabled, ..LayerMask::new(kind) }
    }

    /// The coverage of the whole canvas.
    pub fn plane(&self, size: Size) -> Plane<u8> {
        Plane::from_fn(size, |x, y| self.at(x as i32, y as i32))
    }

    /// Where both cover, on the canvas.
    pub fn times(&self, size: Size, other: &RecordMask) -> RecordMask {
        let product = |a: u8, b: u8| ((u32::from(a) * u32::from(b) + 127) / 255) as u8;
        let both = Plane::from_fn(size, |x, y| {
            let (x, y) = (x as i32, y as i32);
            product(self.at(x, y), other.at(x, y))
        });
        RecordMask::of_canvas(size, both.into_values())
    }

    /// The mask as it counts, once its edge is smoothed and its density taken.
    pub fn softened(self, size: Size, softness: Softness) -> RecordMask {
        let mut mask = self;
        if softness.feather_px > 0.0 {
            let sharp = mask.plane(size).map(|v| f32::from(v) / 255.0);
            // Photoshop's feather is the standard deviation, measured on its pixels.
            let soft = blur::gaussian(&sharp, softness.feather_px);
            let values =
                soft.values().iter().map(|v| (v.max(0.0).min(1.0) * 255.0 + 0.5) as u8).collect();
            mask = RecordMask { disabled: mask.disabled, ..RecordMask::of_canvas(size, values) };
        }
        let density = u32::from(softness.density);
        let dense = |v: u8| (255 - (density * (255 - u32::from(v)) + 127) / 255) as u8;
        if softness.density < 255 {
            mask.outside = dense(mask.outside);
            mask.values.iter_mut().for_each(|v| *v = dense(*v));
        }
        mask
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn density_lets_through_what_a_mask_hides_and_feather_smooths_its_edge() {
        let size = Size::new(8, 1);
        let mask = || RecordMask {
            rect: Rect::new(0, 0, 4, 1),
            outside: 0,
            values: vec![255; 4],
            disabled: false,
        };
        let half = mask().softened(size, Softness { density: 128, feather_px: 0.0 });
        assert_eq!([half.at(0, 0), half.at(7, 0), half.at(-50, 9)], [255, 127, 127]);
        let soft = mask().softened(size, Softness { density: 255, feather_px: 2.0 });
        // Half a pixel is a quarter of the standard deviation, which covers 0.599.
        assert!(soft.at(3, 0).abs_diff(153) <= 4 && soft.at(4, 0).abs_diff(102) <= 4);
    }

    #[test]
    fn what_stands_before_masks_is_read_in_each_of_its_lengths() {
        let rect = [[0u8, 0, 0, 1], [0, 0, 0, 2], [0, 0, 0, 3], [0, 0, 0, 4]].concat();
        let short = [rect.clone(), vec![255, 2 | 4, 0, 0]].concat();
        let read = MaskData::read(ByteCursor::new(&short)).unwrap();
        assert_eq!(
            (read.shown.rect, read.shown.outside, read.painted),
            (Rect::new(2, 1, 4, 3), 255, None)
        );
        assert!(read.shown.disabled && read.shown.inverted && !read.shown.is_drawn);
        let feather = 3.5f64.to_be_bytes();
        let long =
            [rect.clone(), vec![0, 8 | 16, 0, 255], rect, vec![1 | 8, 100], feather.to_vec()]
                .concat();
        let read = MaskData::read(ByteCursor::new(&long)).unwrap();
        assert!(read.shown.is_drawn && read.painted.is_some_and(|painted| painted.outside == 255));
        assert_eq!(
            read.softness,
            [
                Softness { density: 100, ..Softness::HARD },
                Softness { feather_px: 3.5, ..Softness::HARD }
            ]
        );
        assert_eq!(MaskData::read(ByteCursor::new(&[])), None);
    }
}
