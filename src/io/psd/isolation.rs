//! Whether the layers of a group look the same composed alone as on what is beneath the group.
//! Krita ignores the mask of a pass-through group, so one with a mask is isolated if this loses
//! nothing. Floor 5.

use super::{LayerRecord, RecordSection};
use crate::math::{Rect, Size};

/// Blended normally.
const NORMAL: [u8; 4] = *b"norm";

/// True if all are blended normally, or are on opaque layers of the same group wherever they paint.
/// Bottom first.
pub fn can_be_isolated(size: Size, records: &[LayerRecord]) -> bool {
    let mut ground = OpaqueGround { size, solid: vec![false; size.area()] };
    let mut rest = records.iter();
    while let Some(record) = rest.next() {
        let whole =
            if record.section == RecordSection::End { closing(&mut rest) } else { Some(record) };
        let Some(record) = whole else { return false };
        if !record.visible || record.opacity == 0 {
            continue;
        }
        let is_group = record.section == RecordSection::Group;
        if record.clipped || (is_group && record.blend != NORMAL) {
            return false;
        }
        if record.blend != NORMAL && !ground.is_wholly_over(record) {
            return false;
        }
        if !is_group {
            ground.add(record);
        }
    }
    true
}

/// The record of a group whose layers come next; they are passed over.
fn closing<'a>(rest: &mut std::slice::Iter<'a, LayerRecord>) -> Option<&'a LayerRecord> {
    let mut depth = 1;
    rest.find(|record| {
        match record.section {
            RecordSection::End => depth += 1,
            RecordSection::Group => depth -= 1,
            RecordSection::Layer => {}
        }
        depth == 0
    })
}

/// Where the layers so far hide all that is beneath them.
struct OpaqueGround {
    size: Size,
    solid: Vec<bool>,
}

impl OpaqueGround {
    /// Wherever a layer paints on the canvas.
    fn is_wholly_over(&self, record: &LayerRecord) -> bool {
        self.pixels(record).all(|(at, alpha)| alpha == 0 || self.solid[at])
    }

    fn add(&mut self, record: &LayerRecord) {
        let is_whole = record.blend == NORMAL && record.opacity == 255 && record.mask.is_none();
        if is_whole {
            let opaque: Vec<usize> =
                self.pixels(record).filter(|(_, alpha)| *alpha == 255).map(|(at, _)| at).collect();
            opaque.into_iter().for_each(|at| self.solid[at] = true);
        }
    }

    /// Places on the canvas, and how opaque a record is there.
    fn pixels<'a>(&self, record: &'a LayerRecord) -> impl Iterator<Item = (usize, u8)> + use<'a> {
        let (rect, width) = (record.rect, self.size.width as usize);
        let seen: Rect = rect.intersect(self.size.rect());
        (seen.y0..seen.y1).flat_map(move |y| (seen.x0..seen.x1).map(move |x| (x, y))).map(
            move |(x, y)| {
                let within = (y - rect.y0) as usize * rect.width() + (x - rect.x0) as usize;
                let alpha = record.rgba.get(4 * within + 3).copied().unwrap_or(0);
                (y as usize * width + x as usize, alpha)
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layer(rect: Rect, blend: &[u8; 4], alpha: u8) -> LayerRecord {
        let rgba = [9, 9, 9, alpha].repeat(rect.width() * rect.height());
        LayerRecord { rect, blend: *blend, rgba, ..LayerRecord::default() }
    }

    fn group(blend: &[u8; 4], layers: &[LayerRecord]) -> Vec<LayerRecord> {
        let end = LayerRecord { section: RecordSection::End, ..LayerRecord::default() };
        let head =
            LayerRecord { section: RecordSection::Group, blend: *blend, ..LayerRecord::default() };
        [&[end], layers, &[head]].concat()
    }

    fn alone(records: &[LayerRecord]) -> bool {
        can_be_isolated(Size::new(8, 8), records)
    }

    #[test]
    fn what_is_blended_otherwise_needs_an_opaque_layer_of_the_group_beneath() {
        let (all, left) = (Rect::new(0, 0, 8, 8), Rect::new(-3, 0, 4, 8));
        let (fill, glaze) = (layer(all, b"norm", 255), layer(left, b"mul ", 90));
        assert!(alone(&[layer(all, b"norm", 120), layer(left, b"norm", 7)]));
        assert!(alone(&[fill.clone(), glaze.clone()]));
        assert!(alone(&[layer(left, b"norm", 255), glaze.clone()]));
        assert!(
            !alone(std::slice::from_ref(&glaze))
                && !alone(&[layer(all, b"norm", 254), glaze.clone()])
        );
        assert!(!alone(&[layer(left, b"norm", 255), layer(all, b"scrn", 1)]));
        assert!(!alone(&[LayerRecord { opacity: 254, ..fill.clone() }, glaze.clone()]));
        assert!(!alone(&[LayerRecord { visible: false, ..fill }, glaze.clone()]));
        assert!(alone(&[LayerRecord { visible: false, ..glaze }]));
    }

    #[test]
    fn a_group_within_counts_by_how_it_is_blended() {
        let glaze = layer(Rect::new(0, 0, 8, 8), b"mul ", 90);
        assert!(alone(&group(b"norm", std::slice::from_ref(&glaze))));
        assert!(!alone(&group(b"pass", std::slice::from_ref(&glaze))));
        assert!(!alone(&[group(b"norm", &[]), vec![glaze]].concat()));
        assert!(!alone(&group(b"norm", &[])[..1]), "never closed");
    }
}
