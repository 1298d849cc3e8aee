//! Edits of the strokes of a stroke layer: adding, removing, ordering, moving and restyling them.
//! Floor 4. Only tiles that an edit can change are rendered again.

use super::{
    Content, Document, Layer, LayerId, LayerLock, LayerSlot, Live, PixelLayer, Progress,
    StrokeList, flatten_to_paint,
};
use crate::math::Vec2;
use crate::paint::{Scene, Stroke};
use crate::raster::TileAt;
use std::collections::BTreeSet;
use std::sync::Arc;

/// The edits. Each is `None` where there is no such layer or stroke, or the layer is locked;
/// strokes are named by position, the first painted is 0. `self` never changes.
impl Document {
    /// The strokes of a stroke layer, the first painted first; `None` for other layers.
    pub fn strokes(&self, layer: LayerId) -> &[Arc<Stroke>] {
        match self.layer(layer).map(|layer| &layer.content) {
            Some(Content::Strokes(live)) => &live.params().strokes,
            _ => &[],
        }
    }

    /// The same where they show: through the transforms and attachments of the layer and of each
    /// stroke.
    pub fn strokes_on_canvas(&self, layer: LayerId) -> Vec<Arc<Stroke>> {
        let found = self.layer(layer).zip(self.map_of(layer));
        match found
            .map(|(layer, map)| map.layer_on_canvas(layer))
            .map(|layer| layer.content.clone())
        {
            Some(Content::Strokes(live)) => live.params().strokes.clone(),
            _ => Vec::new(),
        }
    }

    /// With some strokes changed one by one.
    pub fn with_each_stroke(
        &self,
        layer: LayerId,
        selected: &[usize],
        change: impl Fn(&Stroke) -> Stroke,
    ) -> Option<Document> {
        self.with_strokes(layer, |strokes| {
            for &index in in_order(selected, strokes)?.iter() {
                strokes[index] = Arc::new(change(&strokes[index]));
            }
            Some(())
        })
    }

    /// With the strokes of a drawing by the form as a stroke layer, to be edited one by one; `None`
    /// if the layer is no such drawing.
    pub fn with_made_strokes(&self, layer: LayerId) -> Option<Document> {
        let found = self.layer(layer).filter(|layer| layer.lock != LayerLock::All)?;
        let Content::FormDrawing(live) = &found.content else { return None };
        let strokes = live.params().strokes(&self.scene_of(layer)?).to_vec();
        self.with_layer(layer, |layer| {
            layer.content = Content::Strokes(Live::new(StrokeList { strokes }));
            // Outlines lie half beyond what they bound, and lines of the form on the canvas.
            (layer.clip_to_surface, layer.transform, layer.on) = (false, None, None);
        })
    }

    /// With strokes of a layer moved by so many pixels; `None` if nothing changes.
    pub fn with_moved_strokes(
        &self,
        layer: LayerId,
        selected: &[usize],
        by: Vec2,
    ) -> Option<Document> {
        self.with_each_stroke(layer, selected, |stroke| stroke.moved(by))
    }

    /// Without some strokes of a layer; `None` if nothing changes.
    pub fn without_strokes(&self, layer: LayerId, selected: &[usize]) -> Option<Document> {
        self.with_strokes(layer, |strokes| {
            for &index in in_order(selected, strokes)?.iter().rev() {
                strokes.remove(index);
            }
            Some(())
        })
    }

    /// With a moved copy of each right above it; and the positions of the copies.
    pub fn with_copied_strokes(
        &self,
        layer: LayerId,
        selected: &[usize],
        by: Vec2,
    ) -> Option<(Document, Vec<usize>)> {
        let mut copies = Vec::new();
        let next = self.with_strokes(layer, |strokes| {
            for (before, &index) in in_order(selected, strokes)?.iter().enumerate() {
                // The copies so far lie below.
                let index = index + before;
                strokes.insert(index + 1, Arc::new(strokes[index].moved(by)));
                copies.push(index + 1);
            }
            Some(())
        })?;
        Some((next, copies))
    }

    /// With one stroke at another position, counted without it; beyond the last means on top.
    pub fn with_reordered_stroke(
        &self,
        layer: LayerId,
        stroke: usize,
        to: usize,
    ) -> Option<Document> {
        self.with_strokes(layer, |strokes| {
            if stroke >= strokes.len() {
                return None;
            }
            let taken = strokes.remove(stroke);
            strokes.insert(to.min(strokes.len()), taken);
            Some(())
        })
    }

    /// With some strokes taken out of their layer and put as pixels on a paint layer of their own;
    /// also returns its id.
    ///
    /// It is beneath the stroke layer if the strokes were its lowest, else above it, and blends as
    /// that layer does.
    pub fn with_baked_strokes(
        &self,
        layer: LayerId,
        selected: &[usize],
    ) -> Option<(Document, LayerId)> {
        let all = self.strokes(layer);
        let selected = in_order(selected, all)?;
        let are_lowest =
            selected.iter().enumerate().all(|(i, &index)| i == index) && selected.len() < all.len();
        let strokes = selected.iter().filter_map(|&index| all.get(index).cloned()).collect();
        let bare = self.with_layer(layer, |layer| {
            layer.content = Content::Strokes(Live::new(StrokeList { strokes }));
            (layer.opacity, layer.mask, layer.blend, layer.clip_to_surface) =
                (1.0, None, Default::default(), false);
        })?;
        let tiles = flatten_to_paint(&bare.with_only(&[layer])?, &Progress::default())?;
        let left = self.without_strokes(layer, &selected)?;
        let old = self.layer(layer)?;
        let pixels = Content::Pixels(PixelLayer { file: String::new(), x: 0, y: 0, tiles });
        let name = format!("{} baked", old.name);
        let baked = Layer {
            id: LayerId::fresh(),
            name,
            cache: Default::default(),
            content: pixels,
            ..Layer::clone(old)
        };
        let (id, place) = (baked.id, self.place_of(layer)?);
        let index = if are_lowest { place.index } else { place.index + 1 };
        Some((left.with_inserted(baked, LayerSlot { index, ..place })?, id))
    }

    /// With the strokes of a layer edited as a list.
    pub fn with_strokes(
        &self,
        layer: LayerId,
        edit: impl FnOnce(&mut Vec<Arc<Stroke>>) -> Option<()>,
    ) -> Option<Document> {
        let old = self.layer(layer).filter(|layer| layer.lock != LayerLock::All)?;
        let Content::Strokes(live) = &old.content else { return None };
        let before = &live.params().strokes;
        let mut strokes = before.clone();
        edit(&mut strokes)?;
        let changed = changed_tiles(&self.scene_of(layer)?, before, &strokes);
        let next = live.with(StrokeList { strokes }, |at| !changed.contains(&at));
        self.with_layer(layer, |layer| layer.content = Content::Strokes(next))
    }
}

/// Positions in rising order, each once; `None` if one does not exist, or there are none.
fn in_order(selected: &[usize], strokes: &[Arc<Stroke>]) -> Option<Vec<usize>> {
    let places: BTreeSet<usize> = selected.iter().copied().collect();
    let all_there = places.last().is_some_and(|&last| last < strokes.len());
    all_there.then(|| places.into_iter().collect())
}

/// The tiles on which two lists paint different strokes, or the same in another order.
fn changed_tiles(scene: &Scene, old: &[Arc<Stroke>], new: &[Arc<Stroke>]) -> BTreeSet<TileAt> {
    let same = |(a, b): &(&Arc<Stroke>, &Arc<Stroke>)| Arc::ptr_eq(a, b);
    let start = old.iter().zip(new).take_while(same).count();
    let (old, new) = (&old[start..], &new[start..]);
    let end = old.iter().rev().zip(new.iter().rev()).take_while(same).count();
    let (old, new) = (&old[..old.len() - end], &new[..new.len() - end]);
    let on_tile = |strokes: &[Arc<Stroke>], at: TileAt| -> Vec<*const Stroke> {
        strokes.iter().filter(|stroke| stroke.can_touch(scene, at)).map(Arc::as_ptr).collect()
    };
    let canvas = TileAt::covering(scene.size.rect());
    canvas.filter(|&at| on_tile(old, at) != on_tile(new, at)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::flatten;
    use crate::math::{Size, srgb::Color, vec2, vec3};
    use crate::paint::{Brush, DrawingHand, FormDrawing, FormPattern, Sample};
    use crate::raster::Plane;
    use crate::surface::form_lines::LineSettings;
    use crate::surface::hatching::{HatchSettings, HatchStyle};
    use crate::surface::{Maps, Operator, Surface};

    const SIZE: Size = Size::new(300, 200);

    /// Dots in a row from the left, each over the one before it, each in its own hue.
    fn document() -> (Document, LayerId) {
        let stroke = |i: u8| {
            let brush = Brush { size: 50.0, hardness: 1.0, ..Brush::default() };
            let color = Color { r: 60 * i, g: 255 - 60 * i, b: 40, a: 255 };
            Arc::new(Stroke::new(
                brush,
                Operator::None,
                color,
                vec![Sample::at(vec2(40.0 + 35.0 * f32::from(i), 40.0))],
            ))
        };
        let list = StrokeList { strokes: (0..4).map(stroke).collect() };
        let layer = Layer::new("Dots", Content::Strokes(Live::new(list)));
        let id = layer.id;
        (Document { layers: vec![Arc::new(layer)], ..Document::empty(SIZE) }, id)
    }

    /// Premultiplied.
    fn picture(document: &Document) -> Vec<u8> {
        let grid = flatten(document, &Progress::default()).unwrap();
        (0..200)
            .flat_map(|y| (0..300).map(move |x| (x, y)))
            .flat_map(|(x, y)| grid.pixel(x, y))
            .collect()
    }

    /// The same layers, not rendered yet.
    fn afresh(document: &Document, id: LayerId) -> Document {
        let strokes = document.strokes(id).to_vec();
        let content = Content::Strokes(Live::new(StrokeList { strokes }));
        document.with_layer(id, |layer| layer.content = content).unwrap()
    }

    fn colors(document: &Document, id: LayerId) -> Vec<u8> {
        document.strokes(id).iter().map(|stroke| stroke.color().r / 60).collect()
    }

    #[test]
    fn every_edit_of_a_rendered_layer_looks_like_the_list_it_leads_to_painted_afresh() {
        let (old, id) = document();
        let before = picture(&old);
        let green = |stroke: &Stroke| {
            let color = Color { r: 0, g: 200, b: 0, a: 255 };
            Stroke::new(stroke.brush().clone(), stroke.operator(), color, stroke.samples().to_vec())
        };
        let edits = [
            old.with_moved_strokes(id, &[1], vec2(60.0, 90.0)),
            old.with_each_stroke(id, &[0, 3, 3], green),
            old.without_strokes(id, &[2, 0]),
            old.with_copied_strokes(id, &[0, 2], vec2(0.0, 80.0)).map(|(document, _)| document),
            old.with_reordered_stroke(id, 0, 2),
            old.with_reordered_stroke(id, 3, 0),
        ];
        for (i, edited) in edits.into_iter().enumerate() {
            let edited = edited.unwrap();
            let now = picture(&edited);
            assert!(now == picture(&afresh(&edited, id)), "edit {i}");
            assert!(now != before, "edit {i} shows");
        }
        assert!(picture(&old) == before, "the old document is as it was");
    }

    #[test]
    fn moving_a_stroke_renders_no_tile_it_does_not_touch() {
        let (old, id) = document();
        picture(&old);
        let far = old.with_moved_strokes(id, &[0], vec2(0.0, 120.0)).unwrap();
        let tile = |document: &Document, at: TileAt| match &document.layer(id).unwrap().content {
            Content::Strokes(live) => live.tile(&document.scene(), at, || panic!("rendered again")),
            _ => panic!("strokes"),
        };
        // Column 2 is beyond the first dot, before and after.
        let kept = tile(&far, TileAt::new(2, 0)).unwrap();
        assert!(Arc::ptr_eq(&kept, &tile(&old, TileAt::new(2, 0)).unwrap()));
        let changed = crate::document::diff(&old, &far);
        assert!(!changed.contains(&TileAt::new(2, 0)) && changed.contains(&TileAt::new(0, 0)));
    }

    #[test]
    fn order_copies_and_removals_are_those_asked_for() {
        let (old, id) = document();
        assert_eq!(colors(&old.with_reordered_stroke(id, 0, 99).unwrap(), id), [1, 2, 3, 0]);
        assert_eq!(colors(&old.with_reordered_stroke(id, 2, 1).unwrap(), id), [0, 2, 1, 3]);
        assert_eq!(colors(&old.without_strokes(id, &[1, 3]).unwrap(), id), [0, 2]);
        let (copied, copies) = old.with_copied_strokes(id, &[2, 0], vec2(1.0, 0.0)).unwrap();
        assert_eq!((colors(&copied, id), copies), (vec![0, 0, 1, 2, 2, 3], vec![1, 4]));
    }

    #[test]
    fn what_is_not_there_or_locked_is_not_edited() {
        let (old, id) = document();
        assert!(old.without_strokes(id, &[4]).is_none() && old.without_strokes(id, &[]).is_none());
        assert!(old.with_reordered_stroke(id, 9, 0).is_none());
        assert!(old.without_strokes(LayerId::fresh(), &[0]).is_none());
        let locked = old.with_layer(id, |layer| layer.lock = LayerLock::All).unwrap();
        assert!(locked.with_moved_strokes(id, &[0], Vec2::ONE).is_none());
    }

    #[test]
    fn baked_strokes_look_as_they_did_and_the_lowest_go_beneath() {
        let (old, id) = document();
        let before = picture(&old);
        for (selected, place) in [(vec![0, 1], 0), (vec![2, 3], 1), (vec![0, 1, 2, 3], 1)] {
            let (baked, pixels) = old.with_baked_strokes(id, &selected).unwrap();
            assert_eq!(baked.place_of(pixels), Some(LayerSlot::top_level(place)));
            assert_eq!(baked.strokes(id).len(), 4 - selected.len());
            let now = picture(&baked);
            let apart = now.iter().zip(&before).map(|(a, b)| a.abs_diff(*b)).max();
            // Rims are rounded to bytes once more.
            assert!(apart <= Some(1), "{apart:?}");
        }
    }

    /// A ball before a wall that bends.
    fn ball_before_a_wall() -> Surface {
        let normal = |x: usize, y: usize| {
            let from = vec2(x as f32 + 0.5 - 130.0, 100.0 - y as f32 - 0.5) / 80.0;
            let rest = 1.0 - from.length_squared();
            if rest > 0.0 {
                return from.extend(rest.sqrt());
            }
            vec3(0.6 * (x as f32 * 0.03).sin(), 0.3, 1.0).normalize()
        };
        let is_ball = |x: usize, y: usize| vec2(x as f32 - 129.5, y as f32 - 99.5).length() < 80.0;
        let maps = Maps {
            normals: Plane::from_fn(SIZE, normal),
            depth: Plane::from_fn(SIZE, |x, y| {
                if is_ball(x, y) { 0.5 - 0.3 * normal(x, y).z } else { 1.0 }
            }),
            coverage: Plane::full(SIZE, 255),
        };
        Surface::new(maps).unwrap()
    }

    #[test]
    fn strokes_made_of_a_drawing_by_the_form_look_like_it() {
        let surface = Some(Arc::new(ball_before_a_wall()));
        let lines = FormPattern::Lines(LineSettings::DEFAULT);
        let styles = HatchStyle::ALL.map(|(style, _)| {
            FormPattern::Hatching(HatchSettings { style, ..HatchSettings::DEFAULT })
        });
        let hand = DrawingHand { wobble: 1.5, overshoot: 3.0, ..DrawingHand::DEFAULT };
        let soft = Brush { size: 6.0, hardness: 0.2, ..FormDrawing::burin() };
        for pattern in [lines].into_iter().chain(styles) {
            for drawing in [
                FormDrawing::new(pattern),
                FormDrawing { hand, brush: soft.clone(), ..FormDrawing::new(pattern) },
            ] {
                let layer = Layer::new("Drawing", Content::FormDrawing(Live::new(drawing)));
                let (id, layers) = (layer.id, vec![Arc::new(layer)]);
                let live = Document { layers, surface: surface.clone(), ..Document::empty(SIZE) };
                let made = live.with_made_strokes(id).unwrap();
                assert!(!made.strokes(id).is_empty());
                let (live, made) = (picture(&live), picture(&made));
                let ink: usize = live.iter().skip(3).step_by(4).filter(|a| **a > 0).count();
                let most = live.iter().zip(&made).map(|(a, b)| a.abs_diff(*b)).max();
                assert!(ink > 500 && most == Some(0), "{pattern:?}: {ink} px, {most:?} off");
            }
        }
    }
}
