//! A placed image, kept live. Floor 4. Not here: its rendering (`paint::image`).

use super::{CanvasScale, Changed, Content, FarScene, LayerKind, NameFile, TileContent};
use crate::Result;
use crate::document::layer::marks::Marks;
use crate::document::{LayerMap, Live, MemoryCount, Progress};
use crate::math::{Mat2, Vec2};
use crate::paint::{ImageFilter, PlacedImage, Placement, Scene};
use crate::raster::sampler::TapRule;
use crate::raster::{FloatTexture, PlanarTile, TileAt};
use crate::surface::{Bend, Deformation};
use std::sync::Arc;

impl Marks for PlacedImage {
    fn pixels(&self, scene: &Scene, at: TileAt) -> Option<PlanarTile> {
        self.render_pixels(scene, at)
    }

    fn texture(&self) -> Option<Arc<FloatTexture>> {
        Some(self.source.float_texture())
    }

    fn texture_bytes(&self) -> u64 {
        // Smaller copies add a third; while it is made, the straight texels are in memory too.
        self.source.picture.size.area() as u64 * 3 * size_of::<[f32; 4]>() as u64
    }
}

impl LayerKind for Live<PlacedImage> {
    fn name(&self) -> &'static str {
        "image"
    }

    fn label(&self) -> &'static str {
        "Image"
    }

    fn render_tile(&self, scene: &Scene, at: TileAt) -> TileContent {
        TileContent::of_tile(self.tile(scene, at, || self.params().render_tile(scene, at)))
    }

    fn render_far_side_tile(&self, scene: &FarScene) -> TileContent {
        self.far_side(scene, true, |scene, at| self.params().render_tile(scene, at))
    }

    fn count(&self, count: &mut MemoryCount, keeps: bool) {
        self.count_rendered(count, keeps);
        count.add_picture(&self.params().source, keeps);
    }

    fn marks(&self) -> Option<&dyn Marks> {
        Some(self.params())
    }

    fn warm(&self, scene: &Scene, _: &Progress) {
        self.params().source.texture();
        Deformation::new(scene.surface.as_deref(), scene.size, &self.params().bend);
    }

    fn scaled(&self, scale: &CanvasScale) -> Content {
        let mut image = self.params().clone();
        image.placement.center *= scale.per_axis;
        image.bend.operator = image.bend.operator.scaled(scale.length);
        image.bend.go_along(|p| p * scale.per_axis, |_| Mat2::from_diagonal(scale.per_axis));
        if image.filter == ImageFilter::Antialias {
            let texture = image.source.texture().size();
            let texels_per_px =
                image.placement.texels_from_canvas(scale.to, texture).matrix2.x_axis.length();
            match scale.levels_to_skip(texels_per_px) {
                0 => {}
                levels => image.source = image.source.coarser(levels),
            }
        }
        Content::Image(Live::new(image))
    }

    fn stretched(&self, scale: &CanvasScale) -> Option<Content> {
        let mut image = self.params().clone();
        image.placement = scale.on_new_canvas(&image.placement, image.source.picture.size);
        let longer = scale.length * scale.from.longer_side() / scale.to.longer_side();
        image.bend.operator = image.bend.operator.scaled(scale.length).on_canvas_of(longer);
        Some(Content::Image(Live::new(image)))
    }

    fn draft(&self) -> Option<Content> {
        let image = self.params();
        let source = image.source.read_by(TapRule::MOVING);
        let is_averaged = image.filter == ImageFilter::Antialias;
        is_averaged.then(|| Content::Image(Live::new(PlacedImage { source, ..image.clone() })))
    }

    fn moved(&self, by: Vec2) -> Option<Content> {
        let image = self.params();
        let placement = Placement { center: image.placement.center + by, ..image.placement };
        Some(Content::Image(Live::new(PlacedImage { placement, ..image.clone() })))
    }

    fn on_canvas(&self, map: &LayerMap, _: Option<(&Content, &Content)>) -> Option<Content> {
        let mut image = self.params().clone();
        image.frame = map.plane;
        image.bend.go_along(|p| map.point(p), |p| map.stretch_at(p));
        Some(Content::Image(Live::new(image)))
    }

    fn bend(&self) -> Option<Bend> {
        Some(self.params().bend.clone())
    }

    fn files(&self) -> Vec<&str> {
        let source = &self.params().source;
        if source.path().is_some() { Vec::new() } else { vec![&source.file] }
    }

    fn with_files(&self, name: &mut NameFile) -> Result<Option<Content>> {
        let mut image = self.params().clone();
        if image.source.path().is_some() {
            return Ok(None);
        }
        image.source.file = name(&image.source.file, &image.source.picture)?;
        Ok(Some(Content::Image(Live::new(image))))
    }

    /// Where both are rendered, their tiles show it.
    fn difference_from(&self, old: &Content, scene: &dyn Fn() -> Scene) -> Changed {
        let Content::Image(old) = old else { return Changed::Wholly };
        if self.ptr_eq(old) {
            return Changed::Nowhere;
        }
        let scene = scene();
        let same = old.same_tiles(self, &scene);
        let (kept, other): (Vec<TileAt>, Vec<TileAt>) =
            TileAt::covering(scene.size.rect()).partition(|&at| same(at));
        if kept.is_empty() { Changed::Wholly } else { Changed::Tiles(other) }
    }
}
