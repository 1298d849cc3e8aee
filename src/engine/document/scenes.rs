//! Finds the scene of one layer without preparing the whole document: the canvas and the surface with the normal layers
//! beneath it. Floor 4.

use super::{Document, Layer, LayerId, Role, normals};
use crate::paint::Scene;
use std::sync::Arc;

impl Document {
    /// The scene of a layer: the document's surface with the normal layers beneath the layer in its scope. `None` if
    /// there is no such layer.
    pub fn scene_of(&self, layer: LayerId) -> Option<Scene> {
        find(&self.layers, layer, &mut self.scene())
    }
}

/// `scene` is updated to what layers above see.
fn find(layers: &[Arc<Layer>], id: LayerId, scene: &mut Scene) -> Option<Scene> {
    for layer in layers {
        if layer.id == id {
            return Some(scene.clone());
        }
        let found = match layer.content.role() {
            Role::Shapes(normals) if layer.visible => {
                *scene = normals::scene_above(layer, normals, scene);
                None
            }
            Role::Groups(group) if group.pass_through && layer.visible => find(&group.layers, id, scene),
            Role::Groups(group) => find(&group.layers, id, &mut scene.clone()),
            _ => None,
        };
        if found.is_some() {
            return found;
        }
    }
    None
}
