//! Finds the scene of one layer without preparing the whole document: the canvas and the surface
//! with the normal layers beneath it. Floor 4.

use super::{Document, Layer, LayerId, LayerMap, Role, normals};
use crate::paint::Scene;
use std::sync::Arc;

impl Document {
    /// The scene of a layer: the document's surface with the normal layers beneath the layer in its
    /// scope. `None` if there is no such layer.
    pub fn scene_of(&self, layer: LayerId) -> Option<Scene> {
        find(&self.layers, layer, &LayerMap::none(self.size), &mut self.scene())
    }
}

/// `scene` is updated to what layers above see.
fn find(layers: &[Arc<Layer>], id: LayerId, around: &LayerMap, scene: &mut Scene) -> Option<Scene> {
    for layer in layers {
        if layer.id == id {
            return Some(scene.clone());
        }
        let found = match layer.content.role() {
            Role::Shapes(_) if layer.visible => {
                *scene = normals::scene_above(layer, around, scene);
                None
            }
            Role::Groups(group) if group.pass_through && layer.visible => {
                find(&group.layers, id, &around.within(layer), scene)
            }
            Role::Groups(group) => {
                find(&group.layers, id, &around.within(layer), &mut scene.clone())
            }
            _ => None,
        };
        if found.is_some() {
            return found;
        }
    }
    None
}
