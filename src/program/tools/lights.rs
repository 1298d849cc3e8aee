//! The lights of a shading layer on the canvas: each is a handle. A distant light has its handle on
//! a disc around the middle, which is the half sphere of directions seen from the front; a point
//! light has it at its position. Floor 5. Not here: the effect of light (`shading`).

use super::{Gesture, Outcome, PenSample};
use crate::document::{Content, Document, LayerId, Live};
use crate::math::{Size, Vec2, Vec3, vec2, vec3};
use crate::shading::{Light, LightKind, Shading};

/// Radius of the disc of directions, as a share of the canvas's shorter side.
const REACH: f32 = 0.42;

fn reach_px(canvas: Size) -> f32 {
    REACH * canvas.width.min(canvas.height) as f32
}

/// The position of each light's handle, canvas px.
pub fn handles(lights: &[Light], canvas: Size) -> Vec<Vec2> {
    let place = |light: &Light| match light.kind {
        LightKind::Directional { direction } => {
            let l = direction.normalize_or(Vec3::Z);
            canvas.center() + vec2(l.x, -l.y) * reach_px(canvas)
        }
        LightKind::Point { position } => position.truncate(),
    };
    lights.iter().map(place).collect()
}

/// The light whose handle was dragged to a point of the canvas. Directions stay in front of the
/// surface.
fn drag_light(light: Light, to: Vec2, canvas: Size) -> Light {
    let kind = match light.kind {
        LightKind::Directional { .. } => {
            let flat = ((to - canvas.center()) / reach_px(canvas).max(1.0)).clamp_length_max(0.999);
            let height = (1.0 - flat.length_squared()).max(0.0).sqrt();
            LightKind::Directional { direction: vec3(flat.x, -flat.y, height) }
        }
        LightKind::Point { position } => LightKind::Point { position: to.extend(position.z) },
    };
    Light { kind, ..light }
}

/// A light being dragged.
pub struct LightGesture {
    /// The document before the drag.
    pub document: Document,
    /// The shading layer.
    pub layer: LayerId,
    /// Its parameters.
    pub shading: Shading,
    /// The number of the light among its lights.
    pub index: usize,
    /// Whether the light has been moved.
    pub moved: bool,
}

impl LightGesture {
    fn with(&self) -> Option<Document> {
        let content = Content::Shading(Live::new(self.shading.clone()));
        self.document.with_layer(self.layer, |layer| layer.content = content)
    }
}

impl Gesture for LightGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last() else { return Outcome::Idle };
        let canvas = self.document.size;
        if let Some(light) = self.shading.lights.get_mut(self.index) {
            *light = drag_light(*light, pen.place(), canvas);
        }
        self.moved = true;
        self.with().map_or(Outcome::Idle, Outcome::Preview)
    }

    fn release(&mut self) -> Outcome {
        match self.with() {
            Some(document) if self.moved => {
                Outcome::Commit { label: "Move light".into(), document, select: None }
            }
            _ => Outcome::Cancel,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_handle_stands_where_it_was_dragged_to() {
        let canvas = Size::new(400, 300);
        for kind in [
            LightKind::Directional { direction: vec3(0.3, 0.5, 0.8) },
            LightKind::Point { position: vec3(5.0, 6.0, 70.0) },
        ] {
            let light = Light { kind, ..Light::default() };
            let to = vec2(240.0, 110.0);
            assert!(handles(&[drag_light(light, to, canvas)], canvas)[0].distance(to) < 1e-3);
        }
        let beyond = drag_light(Light::default(), vec2(9000.0, 150.0), canvas);
        let LightKind::Directional { direction } = beyond.kind else { panic!("a direction") };
        assert!(direction.is_finite() && direction.z > 0.0 && direction.x > 0.99);
    }
}
