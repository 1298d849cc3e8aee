//! Radiance scaling of what is painted beneath. Floor 4. Not here: what it does to pixels (`shading::radiance`).

use super::{CanvasScale, Changed, Content, LayerKind, Role};
use crate::document::Progress;
use crate::paint::Scene;
use crate::shading::{RadianceScaling, Reference};

impl LayerKind for RadianceScaling {
    fn name(&self) -> &'static str {
        "radiance-scaling"
    }
    fn label(&self) -> &'static str {
        "Radiance scaling"
    }
    fn role(&self) -> Role<'_> {
        Role::Adjusts(self)
    }
    fn warm(&self, scene: &Scene, _: &Progress) {
        let _ = scene.surface.as_deref().map(|surface| self.features.on(surface));
    }
    fn scaled(&self, scale: &CanvasScale) -> Content {
        let mut scaling = self.clone();
        scale.features(&mut scaling.features);
        Content::RadianceScaling(scaling)
    }
    fn goes_with_shape(&self) -> bool {
        false
    }
    fn changed_from(&self, old: &Content, _scene: &dyn Fn() -> Scene) -> Changed {
        Changed::wholly_if(!matches!(old, Content::RadianceScaling(old) if old == self))
    }
    fn measures_beneath(&self) -> bool {
        self.keep_mean || self.reference == Reference::Auto
    }
}
