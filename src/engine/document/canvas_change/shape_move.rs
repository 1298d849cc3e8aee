//! The shape moved, turned, mirrored or scaled on its canvas, with the paint that lies on it.
//! Floor 4. Not here: changes of the canvas under the shape (the module above), and paint that slides
//! over the shape (a transform of its layer).

use super::parts::{carry, outline_mut, same_object};
use crate::document::FrameBox;
use crate::document::attachments::transform_of;
use crate::document::parts::{OutlineSource, Part};
use crate::document::selections::selecting;
use crate::document::{
    Content, DerivedMask, Document, Group, Layer, LayerMap, LayerMask, LayerTransform, MaskKind,
    NamedSelection, SurfaceSource, TransformShape,
};
use crate::math::{Affine2, PlaneMap, Vec2, vec2};
use crate::paint::Selection;
use crate::surface::region::SurfaceRegion;
use crate::surface::{Surface, SurfaceError};
use std::sync::Arc;

impl FrameBox {
    /// The box around all that a surface covers, px of its maps; `None` where that is nothing.
    pub fn of_surface(surface: &Surface) -> Option<FrameBox> {
        let coverage = surface.coverage_plane();
        let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        for y in 0..coverage.height() {
            let row = coverage.row(y);
            let Some((first, last)) =
                row.iter().position(|c| *c > 0).zip(row.iter().rposition(|c| *c > 0))
            else {
                continue;
            };
            low = low.min(vec2(first as f32, y as f32));
            high = high.max(vec2(last as f32 + 1.0, y as f32 + 1.0));
        }
        low.is_finite().then_some(FrameBox { low, high })
    }
}

impl Document {
    /// The drawing with its whole shape moved by an affine map of the canvas: maps and parts with
    /// their normals, and the layers that are clipped to the surface, except light and fills.
    /// Selections by the surface are found at the new place of their point.
    ///
    /// Maps are sampled once from what they were made of, layers keep a transform: turning back
    /// restores them.
    ///
    /// Fails, in a sentence, where there is no shape, nothing of it would be left, or the map does
    /// not suit it.
    pub fn with_shape_through(&self, map: &PlaneMap) -> Result<Document, String> {
        let affine = map
            .as_affine()
            .ok_or("A shape cannot be put in perspective: its depth would not fit.")?;
        self.surface.as_ref().ok_or("There is no shape to move.")?;
        // What lies on parts is carried as it shows, and put on them again at their new places.
        let lifted = self.detach(|_| true);
        let around = LayerMap::none(self.size);
        let layers = carry_layers(&lifted.layers, &around, map)
            .ok_or("A layer cannot follow the shape there.")?;
        let maps = self.maps_surface().map(|maps| maps.transformed(self.size, map)).transpose();
        let maps = maps.map_err(|error| match error {
            SurfaceError::Empty => "No part of the shape would be left on the canvas.".to_owned(),
            other => format!("The shape cannot be moved: {other}."),
        })?;
        let source = self.surface_source.as_ref().zip(maps.as_ref());
        let source: Option<SurfaceSource> = source.map(|(source, maps)| source.placed_as(maps));
        let both = self.maps_surface().zip(maps.as_ref());
        let parts = self
            .parts
            .list
            .iter()
            .map(|part| Arc::new(self.carried_part(part, affine, both)))
            .collect();
        let found = |selection: &Arc<Selection>| match selection.made {
            Some(region) => {
                let made = Some(SurfaceRegion { at: affine.transform_point2(region.at), ..region });
                Arc::new(Selection::provisional(selection.coverage.clone(), made))
            }
            None => selection.clone(),
        };
        let kept = |kept: &NamedSelection| NamedSelection {
            selection: found(&kept.selection),
            ..kept.clone()
        };
        let bare = Document {
            surface_source: source.map(Arc::new),
            surface: maps,
            parts: Arc::default(),
            layers,
            selections: self.selections.iter().map(kept).collect(),
            active_selection: self.active_selection.as_ref().map(found),
            ..self.clone()
        };
        let parts: Vec<Arc<Part>> = parts;
        let next =
            if parts.is_empty() { bare } else { bare.with_parts(parts).with_attachments_of(self) };
        if next.surface.is_none() {
            return Err("No part of the shape would be left on the canvas.".into());
        }
        Ok(next.with_selections_found())
    }

    /// A part moved with the shape. One whose outline moves by itself follows that; all others move
    /// by their matrix, and what lies on them with them.
    fn carried_part(
        &self,
        part: &Part,
        map: Affine2,
        maps: Option<(&Arc<Surface>, &Arc<Surface>)>,
    ) -> Part {
        let body = self.parts.body_of(&part.id).map_or(part, |body| body);
        let follows = match body.outline() {
            Some(OutlineSource::Object(_)) => true,
            Some(OutlineSource::Layer { layer, .. }) => {
                self.layer_named(layer).is_some_and(|layer| is_moved_with_shape(layer))
            }
            _ => false,
        };
        let length = map.matrix2.determinant().abs().sqrt();
        let mut next =
            if follows { part.scaled(Vec2::ONE, length, Clone::clone) } else { part.clone() };
        match follows {
            true => {
                next.matrix = map * part.matrix * map.inverse();
                carry(&mut next.kind, map);
            }
            false => {
                next.matrix = map * part.matrix;
                next.raise *= length;
            }
        }
        // It leans as it is seen: slopes change as those of normals do.
        let slope = vec2(part.tilt_deg.x.to_radians().tan(), part.tilt_deg.y.to_radians().tan());
        if part.tilt_deg != Vec2::ZERO && map.matrix2 != crate::math::Mat2::IDENTITY {
            let slope = length * (map.matrix2.inverse().transpose() * slope);
            next.tilt_deg = vec2(slope.x.atan().to_degrees(), slope.y.atan().to_degrees());
        }
        if let (Some(OutlineSource::Object(object)), Some((old, new))) =
            (outline_mut(&mut next.kind), maps)
        {
            *object = same_object(*object, old, new, |p| map.transform_point2(p));
        }
        next
    }
}

/// Whether a layer moves with the shape: it is clipped to the surface and is no light, or has a
/// painted mask; for a group, whether all in it does.
fn is_moved_with_shape(layer: &Layer) -> bool {
    match &layer.content {
        Content::Group(group) => {
            !group.layers.is_empty() && group.layers.iter().all(|layer| is_moved_with_shape(layer))
        }
        content => layer.clip_to_surface && (content.is_tied_to_shape() || has_painted_mask(layer)),
    }
}

fn has_painted_mask(layer: &Layer) -> bool {
    layer.mask.as_ref().is_some_and(|mask| matches!(mask.kind, MaskKind::File { .. }))
}

/// Layers, those that move with the shape moved by a map of the canvas; `None` where that cannot be
/// expressed.
fn carry_layers(
    layers: &[Arc<Layer>],
    around: &LayerMap,
    map: &PlaneMap,
) -> Option<Vec<Arc<Layer>>> {
    let one = |layer: &Arc<Layer>| {
        let own = around.within(layer);
        if !is_moved_with_shape(layer) {
            let Content::Group(group) = &layer.content else { return Some(masked(layer, map)) };
            let layers = carry_layers(&group.layers, &own, map)?;
            let content = Content::Group(Group { layers, ..group.clone() });
            return Some(Arc::new(Layer { content, ..Layer::clone(&masked(layer, map)) }));
        }
        // The map in the list that holds the layer.
        let outer = around.plane.then(map).then(&around.plane.inverse());
        // Selections by the surface that strokes were painted in lie in their frame, and move with
        // it unchanged.
        let bound = |selection: &Arc<Selection>| match selection.made {
            Some(_) => Arc::new(Selection::new(selection.coverage.clone())),
            None => selection.clone(),
        };
        let next = selecting(&masked(layer, map), &bound);
        let transform = match layer.transform.as_ref().and_then(|own| own.mesh()) {
            Some(mesh) => {
                let shape = TransformShape::Mesh(Arc::new(mesh.then(&outer)?));
                Some(LayerTransform { shape, filter: own.filter })
            }
            None => transform_of(&own.plane.then(&around.plane.inverse()).then(&outer), &own)?,
        };
        let liquify = layer.transformed_liquify(&outer, own.canvas());
        Some(Arc::new(Layer { transform, liquify, ..Layer::clone(&next) }))
    };
    layers.iter().map(one).collect()
}

/// A layer whose mask is a region of the surface about a point, with that point moved.
fn masked(layer: &Arc<Layer>, map: &PlaneMap) -> Arc<Layer> {
    let Some(mask) = &layer.mask else { return layer.clone() };
    let Some(DerivedMask::Region(region)) = mask.derived_mask() else { return layer.clone() };
    let at = map.to_canvas(region.at).unwrap_or(region.at);
    let kind = DerivedMask::Region(SurfaceRegion { at, ..region }).into();
    let mask = LayerMask { kind, ..mask.clone() };
    Arc::new(Layer { mask: Some(mask), ..Layer::clone(layer) })
}

#[cfg(test)]
mod tests {
    use super::super::tests::{dome, operator, paint, picture, ramp, under};
    use super::*;
    use crate::math::{Size, Vec3};

    fn on_dome() -> Document {
        let mut document = Document { surface: Some(dome()), ..under(paint()) };
        document.layers.push(Arc::new(ramp(operator())));
        document
    }

    fn turned(document: &Document, degrees: f64) -> Document {
        document.with_shape_through(&PlaneMap::rotation(degrees, document.size.center())).unwrap()
    }

    #[test]
    fn a_shape_turned_round_in_quarters_or_mirrored_twice_is_the_same_picture() {
        let start = on_dome();
        let before = picture(&start);
        let quarter = turned(&start, 90.0);
        assert_ne!(picture(&quarter), before);
        let round = (0..3).fold(quarter, |next, _| turned(&next, 90.0));
        assert!(round.layers.iter().all(|layer| layer.transform.is_none()));
        assert_eq!(picture(&round), before);
        let tens = (0..36).fold(start.clone(), |next, _| turned(&next, 10.0));
        assert_eq!(picture(&tens), before, "36 turns of 10° are none");
        let mirror =
            PlaneMap::affine([-1.0, 0.0, 0.0, 1.0, f64::from(start.size.width), 0.0]).unwrap();
        let twice = start.with_shape_through(&mirror).unwrap().with_shape_through(&mirror).unwrap();
        assert_eq!(picture(&twice), before);
    }

    #[test]
    fn the_normals_turn_with_the_shape_and_the_paint_goes_along() {
        let start = on_dome();
        let half = turned(&start, 180.0);
        let (old, new) = (start.surface.as_ref().unwrap(), half.surface.as_ref().unwrap());
        let Size { width, height } = start.size;
        let (w, h) = (width as usize, height as usize);
        for (x, y) in [(40, 30), (60, 50), (81, 44)] {
            let (n, m) = (old.normal(x, y), new.normal(w - 1 - x, h - 1 - y));
            assert!(m.distance(Vec3::new(-n.x, -n.y, n.z)) < 1e-6, "{n} became {m}");
        }
        let ids: Vec<_> = half.layers.iter().map(|layer| layer.transform.is_some()).collect();
        assert_eq!(ids, [false, true, true], "the ground, which is no part of the surface, stays");
        let (before, after) = (picture(&start), picture(&half));
        let pixel = |of: &[u8], x: usize, y: usize| of[(y * w + x) * 4..][..4].to_vec();
        for (x, y) in [(40, 30), (60, 50), (81, 44)] {
            assert_eq!(pixel(&before, x, y), pixel(&after, w - 1 - x, h - 1 - y));
        }
    }

    #[test]
    fn what_cannot_be_done_is_a_sentence() {
        let start = on_dome();
        let away = PlaneMap::translation(vec2(5000.0, 0.0));
        assert!(
            start.with_shape_through(&away).is_err_and(|why| why.contains("No part of the shape"))
        );
        assert!(
            under(paint())
                .with_shape_through(&PlaneMap::IDENTITY)
                .is_err_and(|why| why.contains("no shape"))
        );
    }
}
