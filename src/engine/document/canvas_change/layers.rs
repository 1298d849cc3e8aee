//! Layers on another canvas. Each is carried by a map N of its own frame, and its transform T
//! becomes M T N⁻¹, where M is the change's own map: the picture is moved by M, whatever N does to
//! the frame. Floor 4.

use super::selections::{CarriedSelections, moved_rect, turned_rect};
use super::{CanvasChange, TURNED};
use crate::document::apply_transform::{apply_to_placement, in_place};
use crate::document::layer::on_canvas::on_canvas;
use crate::document::{
    Content, DerivedMask, DetailSource, Group, InkLayer, Layer, LayerId, LayerMap, LayerMask,
    LayerTransform, Live, MaskKind, NormalLayer, PixelLayer, StrokeList, TransformShape,
};
use crate::math::{Mat2, PlaneMap, Size, Vec2, vec2, vec3};
use crate::paint::{FormDrawing, Gradient, PlacedImage, Stroke};
use crate::raster::warp::{warp_plane_onto, warp_tiles};
use crate::raster::{BlendMode, TileAt};
use crate::shading::{LightKind, Shading};
use crate::surface::plane_piece::PlanePiece;
use crate::surface::region::SurfaceRegion;
use std::sync::Arc;

/// Carries layers.
pub struct Carrier<'c> {
    pub change: &'c CanvasChange,
    pub selections: &'c CarriedSelections<'c>,
}

impl Carrier<'_> {
    pub fn layers(&self, layers: &[Arc<Layer>]) -> Result<Vec<Arc<Layer>>, String> {
        layers.iter().map(|layer| self.layer(layer).map(Arc::new)).collect()
    }

    fn layer(&self, layer: &Arc<Layer>) -> Result<Layer, String> {
        let has_picture =
            matches!(&layer.mask, Some(LayerMask { kind: MaskKind::File { .. }, .. }));
        // A mask has the size of the canvas: what a transform brings back from beyond it would be
        // lost.
        if has_picture
            && (layer.transform.is_some() || layer.is_warped())
            && !self.change.has_whole_old_canvas()
        {
            let shown = in_place(layer, &LayerMap::none(self.change.from));
            if shown.transform.is_none() && !shown.is_warped() {
                return self.carried(&shown, &self.frame_of(&shown));
            }
            if !shown.content.is_shaping_surface() {
                return self.carried(&group_under_mask(layer, self.change.from), &self.change.map);
            }
        }
        self.carried(layer, &self.frame_of(layer))
    }

    /// N: where a layer's frame goes.
    fn frame_of(&self, layer: &Layer) -> PlaneMap {
        let map = self.change.map;
        let own = layer
            .transform
            .as_ref()
            .and_then(|transform| transform.map(self.change.from))
            .unwrap_or_default();
        let whole = own.then(&map);
        match &layer.content {
            // A mesh works only where its frame stays a rectangle: `carried` ensures this.
            _ if layer.is_warped() && is_mesh(layer) => map,
            // Paint needs no transform if its pixels only move.
            Content::Pixels(_) if whole.pixel_move_on(self.change.reach()).is_some() => whole,
            // Paint turns by its transform, unless its mask would not fit the canvas.
            Content::Pixels(_) if self.change.pixel_move().is_none() => {
                let (from, to) = (self.change.from, self.change.to);
                let fits = to.width >= from.width && to.height >= from.height;
                if fits || layer.mask.is_none() { PlaneMap::IDENTITY } else { map }
            }
            // A placement cannot be mirrored: the transform does it.
            Content::Image(_) | Content::Normals(_) if self.change.matrix().determinant() < 0.0 => {
                let width = f64::from(self.change.to.width);
                map.then(&PlaneMap::affine([-1.0, 0.0, 0.0, 1.0, width, 0.0]).unwrap_or_default())
            }
            _ => map,
        }
    }

    /// A layer whose frame is moved by `frame`.
    fn carried(&self, layer: &Layer, frame: &PlaneMap) -> Result<Layer, String> {
        let CanvasChange { map, from, to } = self.change;
        let own =
            layer.transform.as_ref().and_then(|transform| transform.map(*from)).unwrap_or_default();
        let next = frame.inverse().then(&own).then(map);
        let mesh =
            layer.transform.as_ref().filter(|_| layer.is_warped()).and_then(|own| own.mesh());
        let transform = if let Some(mesh) = mesh {
            let carried = mesh.transformed(map).map(|mesh| TransformShape::Mesh(Arc::new(mesh)));
            let why = || {
                format!(
                    "“{}” is warped by a mesh, which cannot be turned like this. Apply it first.",
                    layer.name
                )
            };
            let filter = layer.transform.as_ref().map_or(TURNED, |transform| transform.filter);
            Some(LayerTransform { shape: carried.ok_or_else(why)?, filter })
        } else if next.is_identity_on(*to) {
            None
        } else {
            let filter = layer.transform.as_ref().map_or(TURNED, |transform| transform.filter);
            let carried_by_map = LayerTransform::of_map(&next, filter, *to);
            Some(carried_by_map.ok_or_else(|| {
                format!(
                    "“{}” is in a perspective that the corners of the new canvas cannot describe. Apply its \
                     transform first.",
                    layer.name
                )
            })?)
        };
        Ok(Layer {
            content: self.content(&layer.content, frame)?,
            mask: layer.mask.as_ref().map(|mask| self.mask(mask, frame)),
            transform,
            liquify: layer.transformed_liquify(map, *to),
            cache: Default::default(),
            ..layer.clone()
        })
    }

    fn layer_map(&self, plane: &PlaneMap) -> LayerMap {
        LayerMap::of_plane(*plane, TURNED, self.change.reach())
    }

    fn mask(&self, mask: &LayerMask, frame: &PlaneMap) -> LayerMask {
        let kind = match &mask.kind {
            MaskKind::File { file, coverage } => {
                let coverage =
                    warp_plane_onto(coverage, &self.layer_map(frame), TURNED, self.change.to);
                MaskKind::File { file: file.clone(), coverage: Arc::new(coverage) }
            }
            // Regions lie on the canvas.
            MaskKind::Derived(DerivedMask::Region(region)) => {
                DerivedMask::Region(SurfaceRegion { at: self.change.point(region.at), ..*region })
                    .into()
            }
            same => same.clone(),
        };
        LayerMask { kind, ..mask.clone() }
    }

    /// How much longer *L*, the unit of bends, was.
    fn ratio(&self) -> f32 {
        self.change.from.longer_side() / self.change.to.longer_side()
    }

    fn content(&self, content: &Content, frame: &PlaneMap) -> Result<Content, String> {
        Ok(match content {
            Content::Fill(_) | Content::RadianceScaling(_) | Content::Adjustment(_) => {
                content.clone()
            }
            Content::Filter(_) => content.clone(),
            Content::Ink(lines) => Content::Ink(InkLayer::of(lines.of.clone())),
            Content::Pixels(pixels) => Content::Pixels(self.pixels(pixels, frame)),
            Content::Image(live) => Content::Image(Live::new(self.image(live.params(), frame))),
            Content::Gradient(live) => {
                Content::Gradient(Live::new(self.gradient(live.params(), frame)))
            }
            Content::Strokes(live) => {
                let strokes = live
                    .params()
                    .strokes
                    .iter()
                    .map(|stroke| Arc::new(self.stroke(stroke)))
                    .collect();
                Content::Strokes(Live::new(StrokeList { strokes }))
            }
            Content::FormDrawing(live) => {
                Content::FormDrawing(Live::new(self.form_drawing(live.params())))
            }
            Content::Shading(live) => Content::Shading(Live::new(self.shading(live.params()))),
            Content::Normals(normals) => Content::Normals(self.normals(normals, frame)),
            Content::Group(group) => {
                Content::Group(Group { layers: self.layers(&group.layers)?, ..*group })
            }
        })
    }

    /// Pixels beyond the canvas are moved too.
    fn pixels(&self, pixels: &PixelLayer, frame: &PlaneMap) -> PixelLayer {
        let map = self.layer_map(frame);
        let bounds = pixels.tiles.bounds();
        match frame.pixel_move_on(self.change.reach()) {
            _ if map.is_none() || bounds.is_empty() => pixels.clone(),
            Some(by) if by.right == (1, 0) && by.down == (0, 1) => PixelLayer {
                x: pixels.x.saturating_add(by.origin.0),
                y: pixels.y.saturating_add(by.origin.1),
                tiles: pixels.tiles.translated(by.origin.0, by.origin.1),
                file: pixels.file.clone(),
            },
            by => {
                let area =
                    by.map_or_else(|| turned_rect(bounds, frame), |by| moved_rect(bounds, by));
                let wanted: Vec<TileAt> = TileAt::covering(area).collect();
                PixelLayer {
                    tiles: warp_tiles(&pixels.tiles, &map, TURNED, &wanted),
                    ..PixelLayer::default()
                }
            }
        }
    }

    fn image(&self, image: &PlacedImage, frame: &PlaneMap) -> PlacedImage {
        let mut next = image.clone();
        let placement = image.placement.on_canvas_of(
            self.change.from,
            self.change.to,
            image.source.picture.size,
        );
        next.placement = apply_to_placement(&placement, frame).unwrap_or(placement);
        let at = |p: Vec2| frame.to_canvas(p).unwrap_or(p);
        next.bend.go_along(at, |p| frame.stretch_at(p).unwrap_or(Mat2::IDENTITY));
        next.bend.operator = image.bend.operator.on_canvas_of(self.ratio());
        next
    }

    fn gradient(&self, gradient: &Gradient, frame: &PlaneMap) -> Gradient {
        let at = |p: Vec2| frame.to_canvas(p).unwrap_or(p);
        let (from, to) = (at(gradient.from), at(gradient.to));
        let operator = gradient.operator.on_canvas_of(self.ratio());
        let mut next = Gradient { from, to, operator, ..gradient.clone() };
        PlanePiece::go_along(&mut next.pieces, at, |p| {
            frame.stretch_at(p).unwrap_or(Mat2::IDENTITY)
        });
        let is_mirrored = frame.stretch_at(from).is_some_and(|m| m.determinant() < 0.0);
        if is_mirrored && next.style.is_closed() {
            // In a mirror it runs around the other way.
            next.stops.iter_mut().for_each(|stop| stop.t = 1.0 - stop.t);
            next.stops.reverse();
        }
        next
    }

    fn stroke(&self, stroke: &Stroke) -> Stroke {
        let matrix = self.change.matrix();
        let moved = stroke.mapped(&|p| self.change.map.to_canvas(p), |_| 1.0, |_| matrix);
        let operator = stroke.operator().on_canvas_of(self.ratio());
        let next =
            Stroke::new(moved.brush().clone(), operator, stroke.color(), moved.samples().to_vec());
        next.within(stroke.selection().map(|own| self.selections.of_stroke(own)))
    }

    fn form_drawing(&self, drawing: &FormDrawing) -> FormDrawing {
        let mut next = drawing.clone();
        let light = next.light_mut();
        let along = self.change.matrix() * vec2(light.x, -light.y);
        *light = vec3(along.x, -along.y, light.z);
        next
    }

    fn shading(&self, shading: &Shading) -> Shading {
        let (mut next, matrix) = (shading.clone(), self.change.matrix());
        for light in &mut next.lights {
            match &mut light.kind {
                LightKind::Point { position } => {
                    *position = self.change.point(position.truncate()).extend(position.z);
                }
                LightKind::Directional { direction } => {
                    let along = matrix * vec2(direction.x, -direction.y);
                    *direction = vec3(along.x, -along.y, direction.z);
                }
            }
        }
        next
    }

    fn normals(&self, normals: &NormalLayer, frame: &PlaneMap) -> NormalLayer {
        let (from, to) = (self.change.from, self.change.to);
        let placement = match &normals.source {
            DetailSource::Map { map, .. } => normals.placement.on_canvas_of(from, to, map.size()),
            DetailSource::Grain(_) => normals.placement,
        };
        let mut placement = apply_to_placement(&placement, frame).unwrap_or(placement);
        if let DetailSource::Grain(_) = &normals.source {
            // Noise is counted from the canvas's middle.
            let turn = Mat2::from_angle(-placement.rotation.to_radians());
            placement.center += placement.scale * (turn * (to.center() - from.center()));
        }
        NormalLayer { placement, ..normals.clone() }
    }
}

/// A mesh that is not a matrix displaces it.
fn is_mesh(layer: &Layer) -> bool {
    layer
        .transform
        .as_ref()
        .and_then(|own| own.mesh())
        .is_some_and(|mesh| mesh.as_affine().is_none())
}

/// A layer without its mask, in a group whose mask is that one as it lies on the canvas.
fn group_under_mask(layer: &Arc<Layer>, canvas: Size) -> Layer {
    let bare = Layer {
        mask: None,
        opacity: 1.0,
        blend: BlendMode::Normal,
        clip_below: false,
        ..Layer::clone(layer)
    };
    let inner = Layer { id: LayerId::fresh(), visible: true, cache: Default::default(), ..bare };
    let content = Content::Group(Group { layers: vec![Arc::new(inner)], pass_through: false });
    let mask = on_canvas(layer, &LayerMap::none(canvas)).mask.clone();
    Layer {
        content,
        mask,
        transform: None,
        liquify: None,
        cache: Default::default(),
        ..Layer::clone(layer)
    }
}
