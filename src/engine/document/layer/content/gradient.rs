//! A gradient, kept live. Floor 4. Not here: its rendering (`paint::gradient`).

use super::{CanvasScale, Changed, Content, FarScene, LayerKind, TileContent};
use crate::document::layer::marks::Marks;
use crate::document::{LayerMap, Live, MemoryCount, Progress};
use crate::math::{Mat2, Vec2};
use crate::paint::{Gradient, ImageFilter, Scene};
use crate::raster::{PlanarTile, TileAt};
use crate::surface::plane_piece::PlanePiece;
use crate::surface::{Bend, Deformation};

impl Marks for Gradient {
    fn pixels(&self, scene: &Scene, at: TileAt) -> Option<PlanarTile> {
        self.render_pixels(scene, at)
    }
}

impl LayerKind for Live<Gradient> {
    fn name(&self) -> &'static str {
        "gradient"
    }

    fn label(&self) -> &'static str {
        "Gradient"
    }

    fn render_tile(&self, scene: &Scene, at: TileAt) -> TileContent {
        TileContent::of_tile(self.tile(scene, at, || self.params().render_tile(scene, at)))
    }

    fn render_far_side_tile(&self, scene: &FarScene) -> TileContent {
        self.far_side(scene, true, |scene, at| self.params().render_tile(scene, at))
    }

    fn count(&self, count: &mut MemoryCount, keeps: bool) {
        self.count_rendered(count, keeps);
    }

    fn marks(&self) -> Option<&dyn Marks> {
        Some(self.params())
    }

    fn warm(&self, scene: &Scene, _: &Progress) {
        let bend = Bend { operator: self.params().operator, ..Bend::default() };
        Deformation::new(scene.surface.as_deref(), scene.size, &bend);
    }

    fn scaled(&self, scale: &CanvasScale) -> Content {
        let mut gradient = self.params().clone();
        gradient.from *= scale.per_axis;
        gradient.to *= scale.per_axis;
        gradient.operator = gradient.operator.scaled(scale.length);
        let stretch = Mat2::from_diagonal(scale.per_axis);
        PlanePiece::go_along(&mut gradient.pieces, |p| p * scale.per_axis, |_| stretch);
        Content::Gradient(Live::new(gradient))
    }

    fn draft(&self) -> Option<Content> {
        // Most ramps are smooth: only stops that lie close together show their pixels meanwhile.
        let gradient = self.params();
        let is_averaged = gradient.filter == ImageFilter::Antialias;
        let at_points = || Gradient { filter: ImageFilter::Bilinear, ..gradient.clone() };
        is_averaged.then(|| Content::Gradient(Live::new(at_points())))
    }

    fn moved(&self, by: Vec2) -> Option<Content> {
        let gradient = self.params();
        let (from, to) = (gradient.from + by, gradient.to + by);
        Some(Content::Gradient(Live::new(Gradient { from, to, ..gradient.clone() })))
    }

    fn on_canvas(&self, map: &LayerMap, _: Option<(&Content, &Content)>) -> Option<Content> {
        let mut gradient = Gradient { frame: map.plane, ..self.params().clone() };
        PlanePiece::go_along(&mut gradient.pieces, |p| map.point(p), |p| map.stretch_at(p));
        Some(Content::Gradient(Live::new(gradient)))
    }

    fn bend(&self) -> Option<Bend> {
        Some(self.params().bend())
    }

    fn difference_from(&self, old: &Content, _scene: &dyn Fn() -> Scene) -> Changed {
        Changed::of_live(self, if let Content::Gradient(old) = old { Some(old) } else { None })
    }
}
