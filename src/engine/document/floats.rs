//! Composing without rounding to bytes: live layers are rendered again, in floats, for files of
//! more than 8 bits. Floor 4. Not here: rendering marks (`paint`, `shading`), composing layers
//! (`compose`).

use super::far_side::FarTile;
use super::layer::marks::Marks;
use super::layer::tile_content::TileContent;
use super::prepare::{PreparedDocument, PreparedLayer};
use super::{Document, Layer, LayerId, Progress, Role};
use crate::paint::Scene;
use crate::raster::planar::BRIGHTEST;
use crate::raster::{FloatTexture, PlanarTile, TileAt};
use crate::shading::radiance::Exactness;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

impl Document {
    /// Bytes that flattening it in floats takes besides the picture: the textures that images are
    /// read from.
    pub fn float_bytes(&self) -> u64 {
        let of_layer = |layer: &Arc<Layer>| layer.content.marks().map_or(0, Marks::texture_bytes);
        self.walk()
            .into_iter()
            .map(|(_, layer)| layer)
            .filter(|layer| layer.visible)
            .map(of_layer)
            .sum()
    }

    /// Whether bytes between live layers can differ from floats by more than two levels in the
    /// picture: where a steep blend mode or radiance scaling magnifies how they were rounded.
    pub fn is_rounding_visible(&self) -> bool {
        let shown =
            || self.walk().into_iter().map(|(_, layer)| layer).filter(|layer| layer.visible);
        let magnifies = |layer: &Arc<Layer>| {
            layer.blend.is_steep() || matches!(layer.content.role(), Role::Adjusts(_))
        };
        shown().any(magnifies) && shown().any(|layer| layer.content.marks().is_some())
    }
}

/// What becomes of light that is brighter than white.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Highlights {
    /// Each layer is clipped at white, as a screen shows it: for pictures of 16 bits.
    Clipped,
    /// Pictures, materials and radiance scaling keep it: for files of light. Blend modes whose
    /// formula ends at white clip what they mix.
    Kept,
}

/// What live layers have ready while tiles are composed.
pub(super) struct FloatTiles {
    highlights: Highlights,
    /// Kept, so that each is made once.
    _textures: Vec<Arc<FloatTexture>>,
    /// Tiles that were rendered together.
    together: HashMap<TileKey, Option<PlanarTile>>,
}

/// Of which layer a tile is, where, and on which surface, by its address.
#[derive(PartialEq, Eq, Hash)]
struct TileKey {
    layer: LayerId,
    at: TileAt,
    surface: Option<usize>,
}

impl TileKey {
    fn of(node: &PreparedLayer, at: TileAt, scene: &Scene) -> Self {
        let surface = scene.surface.as_ref().map(|surface| Arc::as_ptr(surface).addr());
        Self { layer: node.layer.id, at, surface }
    }
}

impl FloatTiles {
    pub fn new(prepared: &PreparedDocument, highlights: Highlights) -> Self {
        let mut textures = Vec::new();
        for_each(&prepared.stack, &mut |node| {
            textures.extend(node.layer.content.marks().and_then(Marks::texture));
        });
        Self { highlights, _textures: textures, together: HashMap::new() }
    }

    /// How many textures are kept.
    #[cfg(test)]
    pub fn texture_count(&self) -> usize {
        self._textures.len()
    }

    /// Renders what is to be rendered together on some tiles, and drops what was on others.
    pub fn render(&mut self, prepared: &PreparedDocument, tiles: &[TileAt], progress: &Progress) {
        let found = Mutex::new(HashMap::new());
        for_each(&prepared.stack, &mut |node| {
            let Some(marks) = node.layer.content.marks() else { return };
            for scene in std::iter::once(&node.scene).chain(&node.far) {
                let key = |at| TileKey::of(node, at, scene);
                let done = |at, tile| {
                    found.lock().unwrap_or_else(PoisonError::into_inner).insert(key(at), tile);
                };
                marks.render_together(scene, tiles, progress, &done);
            }
        });
        self.together = found.into_inner().unwrap_or_else(PoisonError::into_inner);
    }

    /// A live layer's pixels on a tile, or behind its contours.
    pub fn content(
        &self,
        node: &PreparedLayer,
        marks: &dyn Marks,
        at: TileAt,
        far: Option<FarTile>,
    ) -> TileContent {
        let pixels = |scene: &Scene| match self.together.get(&TileKey::of(node, at, scene)) {
            Some(known) => known.clone(),
            None => marks.pixels(scene, at),
        };
        let found = match far {
            None => pixels(&node.scene),
            Some(far) => {
                let on_far_side = node.far.as_ref().and_then(pixels);
                let bare = if marks.is_kept_off_surface() && far.has_bare() {
                    pixels(&node.scene)
                } else {
                    None
                };
                Some(far.packed16(on_far_side.as_ref(), bare.as_ref()))
            }
        };
        let Some(mut found) = found else { return TileContent::Nothing };
        if self.highlights == Highlights::Clipped {
            found.clip_to_white();
        }
        TileContent::Group(found)
    }

    /// The straight encoded color above which light is clipped.
    pub fn brightest(&self) -> f32 {
        match self.highlights {
            Highlights::Clipped => 1.0,
            Highlights::Kept => BRIGHTEST,
        }
    }

    pub fn exactness(&self) -> Exactness {
        match self.highlights {
            Highlights::Clipped => Exactness::Exact,
            Highlights::Kept => Exactness::ExactLight,
        }
    }
}

fn for_each(nodes: &[PreparedLayer], tell: &mut impl FnMut(&PreparedLayer)) {
    for node in nodes {
        tell(node);
        for_each(&node.children, tell);
        for_each(&node.clipped, tell);
    }
}

#[cfg(test)]
mod paint_tests;
#[cfg(test)]
mod tests;
