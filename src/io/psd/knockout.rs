//! Layers that hide what is beneath them in their group, so that they lie on what is beneath the
//! group. Floor 5.
//!
//! What they hide becomes a group that passes through, with a mask that leaves out their shape.

use super::{LayerRecord, RecordMask, RecordSection};
use crate::document::{Content, Group, Layer, LayerMask};
use crate::math::Size;
use std::sync::Arc;

/// Where a layer leaves what is beneath it; `None` where its shape is not known from its pixels.
pub fn shape(record: &LayerRecord, size: Size) -> Option<RecordMask> {
    let pixels = record.rgba.as_chunks::<4>().0;
    let is_layer = record.section == RecordSection::Layer && record.adjustment.is_none();
    if !is_layer || pixels.len() != record.rect.width() * record.rect.height() || pixels.is_empty()
    {
        return None;
    }
    let mask = record.mask.as_ref().filter(|mask| !mask.disabled);
    let (seen, width) = (record.rect.intersect(size.rect()), record.rect.width());
    let row = |y: i32| (seen.x0..seen.x1).map(move |x| (x, y));
    let left = |(x, y): (i32, i32)| {
        let at = (y - record.rect.y0) as usize * width + (x - record.rect.x0) as usize;
        let masked = mask.map_or(255, |mask| u32::from(mask.at(x, y)));
        255 - ((u32::from(pixels[at][3]) * masked + 127) / 255) as u8
    };
    let values = (seen.y0..seen.y1).flat_map(row).map(left).collect();
    Some(RecordMask { rect: seen, outside: 255, values, disabled: false })
}

/// Puts the layers so far into a group with that mask.
pub fn hide_beneath(layers: &mut Vec<Arc<Layer>>, mask: LayerMask, name: &str) {
    let group = Group { layers: std::mem::take(layers), pass_through: true };
    layers.push(Arc::new(Layer {
        mask: Some(mask),
        clip_to_surface: false,
        ..Layer::new(format!("Beneath {name}"), Content::Group(group))
    }));
}

/// How deep groups are nested in these layers, themselves counted.
pub fn depth(layers: &[Arc<Layer>]) -> usize {
    let of_group =
        |layer: &Arc<Layer>| layer.content.group().map_or(0, |group| depth(&group.layers));
    1 + layers.iter().map(of_group).max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rect;

    #[test]
    fn a_shape_is_what_a_layer_and_its_mask_cover_on_the_canvas() {
        let mask = RecordMask {
            rect: Rect::new(0, 0, 1, 9),
            outside: 128,
            values: vec![255; 9],
            disabled: false,
        };
        let record = LayerRecord {
            rect: Rect::new(-1, 0, 2, 1),
            rgba: [[1, 2, 3, 255], [1, 2, 3, 255], [1, 2, 3, 100]].concat(),
            mask: Some(mask),
            ..LayerRecord::default()
        };
        let found = shape(&record, Size::new(4, 4)).unwrap();
        assert_eq!((found.rect, found.values), (Rect::new(0, 0, 2, 1), vec![0, 205]));
        assert_eq!(found.outside, 255);
        let cut = LayerRecord { rgba: vec![0; 4], ..record };
        assert_eq!(shape(&cut, Size::new(4, 4)), None);
    }

    #[test]
    fn what_is_hidden_is_a_group() {
        let mut layers =
            vec![Arc::new(Layer::new("a", Content::Fill(crate::math::srgb::Color::WHITE)))];
        assert_eq!(depth(&layers), 1);
        let shape =
            RecordMask { rect: Rect::EMPTY, outside: 255, values: Vec::new(), disabled: false };
        hide_beneath(&mut layers, shape.to_layer_mask(Size::new(2, 2)), "b");
        assert_eq!((layers.len(), depth(&layers)), (1, 2));
        assert!(layers[0].content.group().is_some_and(|group| group.pass_through));
    }
}
