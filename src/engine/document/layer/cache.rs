//! The cache of a layer: values that stay valid until their inputs change. Floor 4. Rendered tiles
//! are cached in `live`.

use super::{
    Layer, LayerMap, effects::EffectCache, normals::Combination, on_canvas::CanvasCache,
    warp::WarpCache,
};
use crate::document::filter_stage::StoredTiles;
use crate::document::memory_use::MemoryCount;
use crate::math::Size;
use crate::raster::{Asset, CoverageGrid};
use crate::shading::RadianceScaling;
use crate::surface::{Scene, Surface};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

/// Cached values of a layer; shared by its versions.
#[derive(Clone, Default)]
pub struct LayerCache {
    /// The preview of the layer alone, as a file stores it.
    pub preview: Memo<PreviewKind, EncodedPixels>,
    /// The pixels of a paint layer, as a project stores them.
    pub pixels: Memo<(), EncodedPixels>,
    /// The layer seen through its transforms.
    pub(in crate::document) on_canvas: CanvasCache,
    /// The composed tiles that are displaced.
    pub(in crate::document) warped: WarpCache,
    /// What its effects were computed from, and they themselves.
    pub(in crate::document) effects: EffectCache,
    /// For a normal layer: the surface with its detail.
    pub(in crate::document) combined: Memo<Combination, Arc<Surface>>,
    /// The greatest luminance.
    pub(in crate::document) brightest: Memo<()>,
    /// The factor that restores the mean luminance, for given parameters.
    pub(in crate::document) gain: Memo<RadianceScaling>,
    /// For a frame: what lies inside of it, by the map of its group.
    pub(in crate::document) framed: Memo<LayerMap, Arc<CoverageGrid>>,
    /// For a filter: what is composed beneath it, if it is clipped or not, in a group's place.
    pub(in crate::document) beneath: Memo<(bool, LayerMap), Arc<StoredTiles>>,
}

impl LayerCache {
    /// Counts what it holds, or drops it.
    pub(in crate::document) fn count(&self, count: &mut MemoryCount, keeps: bool) {
        if let Some(tiles) = self.beneath.last() {
            tiles.count(count, keeps);
        }
        if let Some(inside) = self.framed.last().filter(|inside| count.is_new(inside)) {
            count.add_kept(inside.bytes() as u64);
        }
        self.warped.count(count, keeps);
        self.effects.count(count, keeps);
        self.on_canvas.count(count, keeps);
    }
}

/// What its preview includes of a layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PreviewKind {
    /// Its mask.
    pub masked: bool,
    /// Its effects, and the opacity of its fill.
    pub effects: bool,
    /// The rim of the surface as if that covered it wholly.
    pub whole_rim: bool,
}

/// A layer's pixels as a file holds them, with their place.
#[derive(Clone, Debug, PartialEq)]
pub struct EncodedPixels {
    /// The bytes of the file.
    pub file: Asset,
    /// Its size, px.
    pub size: Size,
    /// Column of the canvas of its upper left corner.
    pub x: i32,
    /// Row of the canvas of that corner.
    pub y: i32,
}

/// A value that depends on the scene, on some layers (most often all beneath a layer), and on a
/// key.
#[derive(Clone)]
pub struct Memo<K, V = f32> {
    last: Arc<Mutex<Option<MemoEntry<K, V>>>>,
}

struct MemoEntry<K, V> {
    scene: Scene,
    /// Weak, so that the cache keeps no layer alive and layers do not keep each other alive.
    beneath: Vec<Weak<Layer>>,
    key: K,
    value: V,
}

impl<K, V> Default for Memo<K, V> {
    fn default() -> Self {
        Self { last: Arc::default() }
    }
}

impl<K: Clone + PartialEq, V: Clone> Memo<K, V> {
    /// The value for a scene, the identical layers beneath and an equal key; computed again if any
    /// differs. `None` if `measure` is canceled.
    ///
    /// It never computes while holding the lock: a thread that waits for work in its own pool would
    /// deadlock.
    pub fn get(
        &self,
        scene: &Scene,
        beneath: &[Arc<Layer>],
        key: &K,
        measure: impl FnOnce() -> Option<V>,
    ) -> Option<V> {
        let holds = |m: &MemoEntry<K, V>| {
            let same_layers = m.beneath.len() == beneath.len()
                && m.beneath
                    .iter()
                    .zip(beneath)
                    .all(|(kept, now)| kept.as_ptr() == Arc::as_ptr(now));
            same_layers && m.scene.is_same(scene) && m.key == *key
        };
        if let Some(value) = self.lock().as_ref().filter(|m| holds(m)).map(|m| m.value.clone()) {
            return Some(value);
        }
        let value = measure()?;
        let beneath = beneath.iter().map(Arc::downgrade).collect();
        *self.lock() = Some(MemoEntry {
            scene: scene.clone(),
            beneath,
            key: key.clone(),
            value: value.clone(),
        });
        Some(value)
    }

    /// The last value.
    fn last(&self) -> Option<V> {
        self.lock().as_ref().map(|entry| entry.value.clone())
    }

    fn lock(&self) -> MutexGuard<'_, Option<MemoEntry<K, V>>> {
        self.last.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Content;
    use crate::math::{Size, srgb::Color};

    #[test]
    fn a_value_is_measured_again_only_when_something_beneath_is_another() {
        let scene = Scene { size: Size::new(8, 8), surface: None };
        let layer = |name| Arc::new(Layer::new(name, Content::Fill(Color::BLACK)));
        let (a, b) = (layer("a"), layer("b"));
        let memo = Memo::default();
        let both = [a.clone(), b.clone()];
        assert_eq!(memo.get(&scene, &both, &7, || Some(1.0)), Some(1.0));
        assert_eq!(memo.clone().get(&scene, &both, &7, || unreachable!()), Some(1.0));
        assert_eq!(memo.get(&scene, &both, &8, || Some(2.0)), Some(2.0));
        assert_eq!(memo.get(&scene, &both[..1], &8, || Some(3.0)), Some(3.0));
        let larger = Scene { size: Size::new(9, 8), surface: None };
        assert_eq!(memo.get(&larger, &both[..1], &8, || None), None);
    }
}
