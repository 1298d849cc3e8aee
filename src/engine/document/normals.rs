//! Normal layers: detail combined with the surface, for everything above in the group (SF fig.
//! 12b–c). Floor 4. Not here: the equation (`surface::combine`).

use super::layer::normals::Combination;
use super::layer::on_canvas::on_canvas;
use super::{DetailSource, Layer, LayerMap, NormalLayer, Role};
use crate::math::{Affine2, Mat2, Vec2, Vec3, vec2, vec3};
use crate::paint::Scene;
use crate::surface::{Curvature, Surface};
use std::sync::Arc;

/// The scene of the layers above a normal layer. The layer caches it: the surface stays identical
/// until an input changes.
///
/// * `map`: what takes the groups around it to the canvas.
pub(super) fn scene_above(layer: &Arc<Layer>, map: &LayerMap, beneath: &Scene) -> Scene {
    let layer = on_canvas(layer, map);
    let Role::Shapes(normals) = layer.content.role() else { return beneath.clone() };
    let Some(surface) =
        beneath.surface.as_ref().filter(|_| normals.strength > 0.0 && layer.opacity > 0.0)
    else {
        return beneath.clone();
    };
    let combination =
        Combination { normals: normals.clone(), opacity: layer.opacity, mask: layer.mask.clone() };
    let combine = || {
        let curvature = layer.mask.as_ref().and_then(|mask| mask.curvature_on(beneath));
        Some(Arc::new(combination.on(surface, beneath, curvature.as_deref())))
    };
    let combined = layer.cache.combined.get(beneath, &[], &combination, combine);
    Scene { surface: combined.or_else(|| beneath.surface.clone()), ..beneath.clone() }
}

impl Combination {
    /// `curvature`: of the surface, for a mask derived from it.
    fn on(&self, surface: &Arc<Surface>, scene: &Scene, curvature: Option<&Curvature>) -> Surface {
        let detail = PlacedDetail::of(&self.normals, scene);
        surface.combined(|x, y| {
            let mask =
                self.mask.as_ref().map_or(1.0, |m| m.at(scene, curvature, x as i32, y as i32));
            let strength = self.normals.strength * self.opacity * mask;
            let normal =
                detail.normal(vec2(x as f32 + 0.5, y as f32 + 0.5)).filter(|_| strength > 0.0)?;
            Some((normal, strength))
        })
    }
}

/// Detail placed on the canvas.
struct PlacedDetail<'a> {
    normals: &'a NormalLayer,
    /// Texels of the map, or px of the grain, from canvas px.
    from_canvas: Affine2,
    /// How many of those one canvas px covers.
    per_px: f32,
    /// Cosine and sine of the turn, counter-clockwise as seen.
    turn: Vec2,
}

impl<'a> PlacedDetail<'a> {
    fn of(normals: &'a NormalLayer, scene: &Scene) -> Self {
        let placement = &normals.placement;
        let from_canvas = match &normals.source {
            DetailSource::Map { map, .. } => placement.texels_from_canvas(scene.size, map.size()),
            // A picture of the canvas's own size lies pixel for pixel.
            DetailSource::Grain(_) => placement.texels_from_canvas(scene.size, scene.size),
        };
        let per_px = from_canvas.matrix2.determinant().abs().sqrt();
        Self {
            normals,
            from_canvas,
            per_px,
            turn: Vec2::from_angle(placement.rotation.to_radians()),
        }
    }

    /// The detail normal at a canvas point, y up.
    fn normal(&self, q: Vec2) -> Option<Vec3> {
        let (in_frame, jacobian) = self.normals.frame.from_canvas(q)?;
        let at = self.from_canvas.transform_point2(in_frame);
        let per_px = self.per_px * jacobian.determinant().abs().sqrt();
        let normal = match &self.normals.source {
            DetailSource::Map { map, .. } => map.at(at, per_px, self.normals.outside)?,
            DetailSource::Grain(grain) => grain.normal(at, per_px),
        };
        let normal = self.turn.rotate(normal.truncate()).extend(normal.z);
        Some(if jacobian == Mat2::IDENTITY { normal } else { map_normal(normal, jacobian) })
    }
}

/// A normal (y up) of a relief whose places are moved by a map: slopes s become k A⁻ᵀ s, A how
/// places stretch, and k = √|det A|, so that a larger relief is as steep. `jacobian`: A⁻¹, image
/// axes.
fn map_normal(normal: Vec3, jacobian: Mat2) -> Vec3 {
    let slope = vec2(normal.x, -normal.y) / normal.z.max(1e-3);
    let scale = jacobian.determinant().abs().sqrt().max(1e-6).recip();
    let slope = jacobian.transpose() * slope * scale;
    vec3(slope.x, -slope.y, 1.0).normalize_or(Vec3::Z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::conventions::NormalConvention;
    use crate::document::{
        Content, Document, Group, LayerMask, Live, MaskKind, PreparedDocument, Progress, flatten,
    };
    use crate::math::{PlaneMap, Size, srgb::Color};
    use crate::paint::{PictureSource, Placement};
    use crate::raster::{Outside, Plane};
    use crate::shading::{Model, Shading};
    use crate::surface::{DetailMap, Maps, NoiseRelief};

    const SIZE: Size = Size::new(80, 40);

    fn document(layers: Vec<Layer>) -> Document {
        let (depth, coverage) = (Plane::full(SIZE, 0.5), Plane::full(SIZE, 255));
        let surface =
            Surface::new(Maps { normals: Plane::full(SIZE, Vec3::Z), depth, coverage }).unwrap();
        let layers = layers.into_iter().map(Arc::new).collect();
        Document { surface: Some(Arc::new(surface)), layers, ..Document::empty(SIZE) }
    }

    /// Detail that leans everywhere to the right.
    fn leaning(strength: f32) -> NormalLayer {
        let map = Arc::new(DetailMap::new(Plane::full(Size::new(4, 4), vec3(0.6, 0.0, 0.8))));
        let texels = vec![[204, 128, 230, 255]; 16];
        let picture = crate::raster::Picture::srgb8(Size::new(4, 4), texels).unwrap();
        let picture = PictureSource::new("d.png".into(), picture, Default::default());
        let source = DetailSource::Map { picture, convention: NormalConvention::default(), map };
        let (placement, frame) = (Placement::covering(SIZE), PlaneMap::IDENTITY);
        NormalLayer { source, placement, outside: Outside::Repeat, strength, frame }
    }

    fn normals(strength: f32) -> Layer {
        Layer::new("cloth", Content::Normals(leaning(strength)))
    }

    fn clay() -> Layer {
        Layer::new("clay", Content::Shading(Live::new(Shading::new(Model::Phong))))
    }

    fn seen(layer: &Layer, document: &Document) -> Arc<Surface> {
        scene_above(&Arc::new(layer.clone()), &LayerMap::none(SIZE), &document.scene())
            .surface
            .unwrap()
    }

    /// The red of a pixel.
    fn red(document: &Document, x: i32, y: i32) -> u8 {
        flatten(document, &Progress::default()).unwrap().pixel(x, y)[0]
    }

    #[test]
    fn what_stands_above_sees_the_detail_and_what_stands_beneath_does_not() {
        let plain = red(&document(vec![clay()]), 20, 20);
        assert_ne!(red(&document(vec![normals(1.0), clay()]), 20, 20), plain);
        assert_eq!(red(&document(vec![clay(), normals(1.0)]), 20, 20), plain);
        assert_eq!(red(&document(vec![normals(0.0), clay()]), 20, 20), plain);
        let hidden = Layer { visible: false, ..normals(1.0) };
        assert_eq!(red(&document(vec![hidden, clay()]), 20, 20), plain);
        let group = Group { layers: vec![Arc::new(normals(1.0))], pass_through: false };
        assert_eq!(
            red(&document(vec![Layer::new("g", Content::Group(group)), clay()]), 20, 20),
            plain
        );
    }

    #[test]
    fn opacity_and_mask_weigh_the_strength() {
        let coverage = Plane::from_fn(SIZE, |x, _| if x < 40 { 255 } else { 0 });
        let kind = MaskKind::File { file: "m.png".into(), coverage: Arc::new(coverage) };
        let layer = Layer { opacity: 0.5, mask: Some(LayerMask::new(kind)), ..normals(1.0) };
        let surface = seen(&layer, &document(vec![]));
        // Half the slope of 0.6 / 0.8.
        let n = surface.normal(10, 10);
        assert!((n.x / n.z - 0.375).abs() < 1e-4, "{n}");
        assert_eq!(surface.normal(60, 10), Vec3::Z);
    }

    #[test]
    fn turned_detail_leans_where_it_was_turned_to() {
        let mut turned = leaning(1.0);
        turned.placement.rotation = 90.0;
        let surface = seen(&Layer::new("", Content::Normals(turned)), &document(vec![]));
        let n = surface.normal(10, 10);
        assert!(
            (n - vec3(0.0, 0.6, 0.8)).length() < 1e-4,
            "counter-clockwise: to the right becomes up, not {n}"
        );
    }

    #[test]
    fn taken_along_by_a_mirror_detail_leans_the_other_way() {
        let frame = PlaneMap::affine([-1.0, 0.0, 0.0, 1.0, 80.0, 0.0]).unwrap();
        let mirrored = Layer::new("", Content::Normals(NormalLayer { frame, ..leaning(1.0) }));
        let n = seen(&mirrored, &document(vec![])).normal(10, 10);
        assert!((n - vec3(-0.6, 0.0, 0.8)).length() < 1e-4, "{n}");
        // Turned by 90° counter-clockwise, to the right becomes up; twice the size is as steep.
        let turned =
            map_normal(vec3(0.6, 0.0, 0.8), Mat2::from_cols(vec2(0.0, 0.5), vec2(-0.5, 0.0)));
        assert!((turned - vec3(0.0, 0.6, 0.8)).length() < 1e-4, "{turned}");
    }

    #[test]
    fn the_combined_surface_is_kept_until_what_it_is_made_from_changes() {
        let document = document(vec![]);
        let layer = normals(1.0);
        let first = seen(&layer, &document);
        assert!(Arc::ptr_eq(
            &first,
            &seen(&Layer { name: "renamed".into(), ..layer.clone() }, &document)
        ));
        let stronger = Layer {
            content: Content::Normals(NormalLayer { strength: 2.0, ..leaning(1.0) }),
            ..layer.clone()
        };
        assert!(!Arc::ptr_eq(&first, &seen(&stronger, &document)));
        let fainter = Layer { opacity: 0.3, ..layer };
        assert!(!Arc::ptr_eq(&first, &seen(&fainter, &document)));
    }

    #[test]
    fn an_edit_elsewhere_renders_nothing_above_again() {
        let before = document(vec![
            normals(1.0),
            clay(),
            Layer { opacity: 0.5, ..Layer::new("paint", Content::Fill(Color::WHITE)) },
        ]);
        let Content::Shading(live) = &before.layers[1].content else { unreachable!() };
        let tile = |document: &Document| {
            let prepared = PreparedDocument::new(document, &Progress::default()).unwrap();
            let at = crate::raster::TileAt::new(0, 0);
            prepared.flatten_tile(at);
            live.tile(&prepared.stack[0].scene, at, || unreachable!("it was rendered")).unwrap()
        };
        let first = tile(&before);
        let mut after = before.clone();
        after.layers[2] = Arc::new(Layer { opacity: 0.2, ..Layer::clone(&before.layers[2]) });
        assert!(Arc::ptr_eq(&first, &tile(&after)));
    }

    #[test]
    fn grain_roughens_and_without_a_surface_there_is_nothing_to_roughen() {
        let grain =
            NormalLayer { source: DetailSource::Grain(NoiseRelief::default()), ..leaning(0.5) };
        let layer = Layer::new("", Content::Normals(grain));
        let surface = seen(&layer, &document(vec![]));
        assert!((0..40).any(|y| surface.normal(20, y).z < 0.98));
        let nothing = Scene { size: SIZE, surface: None };
        assert!(scene_above(&Arc::new(layer), &LayerMap::none(SIZE), &nothing).surface.is_none());
    }
}
