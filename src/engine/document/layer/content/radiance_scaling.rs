//! Radiance scaling of what is painted beneath. Floor 4. Not here: what it does to pixels
//! (`shading::radiance`).

use super::{CanvasScale, Changed, Content, LayerKind, Role};
use crate::document::Progress;
use crate::document::layer::adjustment::{AdjustedPlace, Adjustment, BackdropMeter, Reach};
use crate::paint::Scene;
use crate::raster::PlanarTile;
use crate::shading::radiance::{BackdropStats, Exactness};
use crate::shading::{RadianceScaling, Reference};

impl LayerKind for RadianceScaling {
    fn name(&self) -> &'static str {
        "radiance-scaling"
    }

    fn label(&self) -> &'static str {
        "Bring out form"
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

    fn is_tied_to_shape(&self) -> bool {
        false
    }

    fn difference_from(&self, old: &Content, _scene: &dyn Fn() -> Scene) -> Changed {
        Changed::wholly_if(!matches!(old, Content::RadianceScaling(old) if old == self))
    }
}

impl Adjustment for RadianceScaling {
    fn reach(&self) -> Reach {
        if self.keep_mean || self.reference == Reference::Auto {
            Reach::Picture
        } else {
            Reach::Pixel
        }
    }

    fn measure(&self, beneath: &dyn BackdropMeter) -> Option<BackdropStats> {
        let brightest = match self.reference {
            Reference::Value(value) => value,
            Reference::Auto => beneath.brightest()?,
        };
        let gain = if self.keep_mean { beneath.gain(self, brightest)? } else { 1.0 };
        Some(BackdropStats { brightest, gain })
    }

    fn adjust(
        &self,
        place: &AdjustedPlace,
        beneath: BackdropStats,
        exactness: Exactness,
        pixels: &mut PlanarTile,
    ) {
        match *place {
            AdjustedPlace::Tile { scene, at } => {
                self.apply_at(scene, at, beneath, exactness, pixels)
            }
            AdjustedPlace::Packed { surface: Some(surface), places, .. } => {
                self.apply_packed(surface, places, beneath, exactness, pixels);
            }
            AdjustedPlace::Packed { surface: None, .. } => {}
        }
    }
}
