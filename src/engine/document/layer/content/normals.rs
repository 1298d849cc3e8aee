//! Detail added to the surface for the layers above. Floor 4. Not here: adding it
//! (`document::normals`).

use super::{CanvasScale, Changed, Content, LayerKind, NameFile, Role, VisibleArea};
use crate::Result;
use crate::document::{DetailSource, LayerMap, MemoryCount, NormalLayer};
use crate::paint::Scene;

impl LayerKind for NormalLayer {
    fn name(&self) -> &'static str {
        "normals"
    }

    fn label(&self) -> &'static str {
        "Normals"
    }

    fn role(&self) -> Role<'_> {
        Role::Shapes(self)
    }

    fn scaled(&self, scale: &CanvasScale) -> Content {
        let mut normals = self.clone();
        normals.placement.center *= scale.per_axis;
        if let DetailSource::Grain(grain) = &mut normals.source {
            grain.size_px *= scale.length;
        }
        Content::Normals(normals)
    }

    fn stretched(&self, scale: &CanvasScale) -> Option<Content> {
        let DetailSource::Map { map, .. } = &self.source else { return None };
        let placement = scale.on_new_canvas(&self.placement, map.size());
        Some(Content::Normals(NormalLayer { placement, ..self.clone() }))
    }

    fn on_canvas(&self, map: &LayerMap, _: Option<(&Content, &Content)>) -> Option<Content> {
        Some(Content::Normals(NormalLayer { frame: map.plane, ..self.clone() }))
    }

    fn count(&self, count: &mut MemoryCount, keeps: bool) {
        if let DetailSource::Map { picture, .. } = &self.source {
            count.add_picture(picture, keeps);
        }
    }

    fn files(&self) -> Vec<&str> {
        match &self.source {
            DetailSource::Map { picture, .. } => vec![&picture.file],
            DetailSource::Grain(_) => Vec::new(),
        }
    }

    fn with_files(&self, name: &mut NameFile) -> Result<Option<Content>> {
        let mut normals = self.clone();
        if let DetailSource::Map { picture, .. } = &mut normals.source {
            picture.file = name(&picture.file, &picture.picture)?;
        }
        Ok(Some(Content::Normals(normals)))
    }

    /// Layers that see it see another scene.
    fn visible_area(&self, _scene: Option<&Scene>) -> VisibleArea {
        VisibleArea::Nowhere
    }

    fn difference_from(&self, _old: &Content, _scene: &dyn Fn() -> Scene) -> Changed {
        Changed::Wholly
    }
}
