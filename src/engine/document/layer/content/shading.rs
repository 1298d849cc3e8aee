//! A material under light, kept live. Floor 4. Not here: its rendering (`shading::material`).

use super::{CanvasScale, Changed, Content, FarScene, LayerKind, NameFile, Role, TileContent};
use crate::Result;
use crate::document::layer::adjustment::{AdjustedPlace, Adjustment};
use crate::document::layer::marks::Marks;
use crate::document::{LayerMap, Live, MemoryCount, Progress};
use crate::paint::Scene;
use crate::raster::{PlanarTile, TileAt};
use crate::shading::radiance::{BackdropStats, Exactness};
use crate::shading::{LightKind, LitSphere, Shading};

/// The lit spheres of a material.
fn spheres(shading: &Shading) -> impl Iterator<Item = &LitSphere> {
    [&shading.sphere, &shading.sphere_concave].into_iter().flatten()
}

impl Marks for Shading {
    fn pixels(&self, scene: &Scene, at: TileAt) -> Option<PlanarTile> {
        self.render_pixels(scene, at)
    }

    /// Off the surface it shows nothing.
    fn is_kept_off_surface(&self) -> bool {
        false
    }
}

/// A painter's light on what lies beneath.
impl Adjustment for Shading {
    fn adjust(
        &self,
        place: &AdjustedPlace,
        _: BackdropStats,
        exactness: Exactness,
        pixels: &mut PlanarTile,
    ) {
        match *place {
            AdjustedPlace::Tile { scene, at } => self.light_tile(scene, at, exactness, pixels),
            AdjustedPlace::Packed { surface, front, places, canvas } => {
                self.light_packed([surface, front], places, canvas, exactness, pixels);
            }
        }
    }
}

impl LayerKind for Live<Shading> {
    fn name(&self) -> &'static str {
        "shading"
    }

    fn label(&self) -> &'static str {
        "Shading"
    }

    fn role(&self) -> Role<'_> {
        if self.params().is_lighting_beneath() {
            Role::Adjusts(self.params())
        } else {
            Role::Paints
        }
    }

    fn render_tile(&self, scene: &Scene, at: TileAt) -> TileContent {
        if self.params().is_lighting_beneath() {
            return TileContent::Nothing;
        }
        TileContent::of_tile(self.tile(scene, at, || self.params().render_tile(scene, at)))
    }

    fn render_far_side_tile(&self, scene: &FarScene) -> TileContent {
        if self.params().is_lighting_beneath() {
            return TileContent::Nothing;
        }
        // Off the surface it shows nothing.
        self.far_side(scene, false, |scene, at| self.params().render_tile(scene, at))
    }

    fn count(&self, count: &mut MemoryCount, keeps: bool) {
        self.count_rendered(count, keeps);
    }

    fn marks(&self) -> Option<&dyn Marks> {
        (!self.params().is_lighting_beneath()).then_some(self.params() as &dyn Marks)
    }

    fn is_shown_off_surface(&self) -> bool {
        self.params().has_ground_shadow()
    }

    fn draft(&self) -> Option<Content> {
        Some(Content::Shading(Live::new(self.params().drafted()?)))
    }

    fn warm(&self, scene: &Scene, _: &Progress) {
        self.params().warm(scene);
    }

    fn scaled(&self, scale: &CanvasScale) -> Content {
        let mut shading = self.params().scaled(scale.length);
        if let (true, Some(drafted)) = (scale.is_draft(), shading.drafted()) {
            shading = drafted;
        }
        scale.features(&mut shading.features);
        for light in &mut shading.lights {
            if let LightKind::Point { position } = &mut light.kind {
                *position *= scale.per_axis.extend(scale.length);
            }
        }
        Content::Shading(Live::new(shading))
    }

    fn on_canvas(&self, map: &LayerMap, _: Option<(&Content, &Content)>) -> Option<Content> {
        let mut shading = self.params().clone();
        for light in &mut shading.lights {
            if let LightKind::Point { position } = &mut light.kind {
                let at = position.truncate();
                *position = map.point(at).extend(position.z * map.length_at(at));
            }
        }
        Some(Content::Shading(Live::new(shading)))
    }

    fn files(&self) -> Vec<&str> {
        let environment =
            self.params().environment.iter().map(|environment| environment.file.as_str());
        environment.chain(spheres(self.params()).map(|sphere| sphere.file.as_str())).collect()
    }

    fn with_files(&self, name: &mut NameFile) -> Result<Option<Content>> {
        let mut shading = self.params().clone();
        if let Some(environment) = &mut shading.environment {
            environment.file = name(&environment.file, &environment.picture)?;
        }
        for sphere in [&mut shading.sphere, &mut shading.sphere_concave].into_iter().flatten() {
            sphere.file = name(&sphere.file, &sphere.picture)?;
        }
        Ok(Some(Content::Shading(Live::new(shading))))
    }

    fn lacks(&self) -> Option<(&'static str, String)> {
        let shading = self.params();
        let reason = || format!("is missing; “{}” shows nothing else", shading.model.name());
        shading.is_without_environment().then(|| ("environment", reason()))
    }

    fn is_tied_to_shape(&self) -> bool {
        false
    }

    fn difference_from(&self, old: &Content, scene: &dyn Fn() -> Scene) -> Changed {
        let Content::Shading(old) = old else { return Changed::Wholly };
        if self.ptr_eq(old) {
            return Changed::Nowhere;
        }
        // Where the ball is painted on, the figure shows few of its places.
        let has_strokes = self.params().has_strokes();
        let tiles =
            has_strokes.then(|| self.params().repainted_tiles(old.params(), &scene())).flatten();
        tiles.map_or(Changed::Wholly, Changed::Tiles)
    }
}
