//! What was worked out once for a layer and holds until what it was worked out from changes.
//! Floor 4. Rendered tiles are kept by `live`.

use super::Layer;
use crate::paint::Scene;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

/// A number that depends on the scene and on everything beneath a layer; shared by the layer's versions.
#[derive(Clone, Default)]
pub struct Kept {
    measured: Arc<Mutex<Option<Measured>>>,
}

struct Measured {
    scene: Scene,
    /// Weak, so that a measure keeps no layer alive and no two layers each other.
    beneath: Vec<Weak<Layer>>,
    value: f32,
}

impl Kept {
    /// The value for a scene and the very same layers beneath, measured anew if either is another; `None` if `measure` gives up.
    ///
    /// Never measures under the lock: a thread that waits for its own pool's work would stand still.
    pub fn measured(
        &self,
        scene: &Scene,
        beneath: &[Arc<Layer>],
        measure: impl FnOnce() -> Option<f32>,
    ) -> Option<f32> {
        let holds = |m: &Measured| {
            let same_layers = m.beneath.len() == beneath.len()
                && m.beneath.iter().zip(beneath).all(|(kept, now)| kept.as_ptr() == Arc::as_ptr(now));
            m.scene.is_same(scene) && same_layers
        };
        if let Some(value) = self.lock().as_ref().filter(|m| holds(m)).map(|m| m.value) {
            return Some(value);
        }
        let value = measure()?;
        let beneath = beneath.iter().map(Arc::downgrade).collect();
        *self.lock() = Some(Measured { scene: scene.clone(), beneath, value });
        Some(value)
    }
    fn lock(&self) -> MutexGuard<'_, Option<Measured>> {
        self.measured.lock().unwrap_or_else(PoisonError::into_inner)
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
        let kept = Kept::default();
        assert_eq!(kept.measured(&scene, &[a.clone(), b.clone()], || Some(1.0)), Some(1.0));
        assert_eq!(kept.clone().measured(&scene, &[a.clone(), b.clone()], || unreachable!()), Some(1.0));
        assert_eq!(kept.measured(&scene, std::slice::from_ref(&a), || Some(2.0)), Some(2.0));
        let larger = Scene { size: Size::new(9, 8), surface: None };
        assert_eq!(kept.measured(&larger, &[a], || None), None);
    }
}
