//! A fill: one color everywhere.
//! Floor 4.

use super::{CanvasScale, Changed, Content, FarScene, LayerKind, TileContent};
use crate::math::srgb::Color;
use crate::paint::Scene;
use crate::raster::TileAt;

impl LayerKind for Color {
    fn name(&self) -> &'static str {
        "fill"
    }

    fn label(&self) -> &'static str {
        "Fill"
    }

    fn render_tile(&self, _scene: &Scene, _at: TileAt) -> TileContent {
        TileContent::Solid(self.premultiplied())
    }

    fn render_far_side_tile(&self, _scene: &FarScene) -> TileContent {
        TileContent::Solid(self.premultiplied())
    }

    fn scaled(&self, _scale: &CanvasScale) -> Content {
        Content::Fill(*self)
    }

    fn is_tied_to_shape(&self) -> bool {
        false
    }

    fn difference_from(&self, old: &Content, _scene: &dyn Fn() -> Scene) -> Changed {
        Changed::wholly_if(!matches!(old, Content::Fill(old) if old == self))
    }
}
