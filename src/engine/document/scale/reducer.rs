//! Scales a changing document down again and again: parts that did not change are not scaled twice. Floor 4. The
//! scaling of one layer is in `scale`.

use super::super::{Content, Document, Group, Layer, LayerId, Part, Parts};
use super::CanvasScale;
use crate::math::Size;
use crate::surface::{Surface, SurfaceError};
use std::collections::HashMap;
use std::sync::{Arc, Weak};

/// Scales documents down by one factor, and remembers the parts of the last one. Pictures and gradients are read more
/// coarsely than at rest; with the factor 1 that is the only change.
///
/// Parts that did not change come back as the same `Arc`, so that [`diff`](super::super::diff()) reports only what did.
pub struct DocumentReducer {
    factor: f32,
    surface: Option<(Weak<Surface>, Arc<Surface>)>,
    layers: HashMap<LayerId, (Weak<Layer>, Arc<Layer>)>,
    /// Small parts by their ids, and what was made of them: for documents whose parts the user drags.
    parts: HashMap<String, (Weak<Part>, Arc<Part>)>,
    shaped: Arc<Parts>,
}

/// A surface that is yet to be scaled down; if that must not delay anything, on another thread.
pub struct SurfaceReduction {
    of: Arc<Surface>,
    to: Size,
}

/// A surface that was scaled down.
pub struct ReducedSurface {
    of: Weak<Surface>,
    small: Arc<Surface>,
}

impl SurfaceReduction {
    /// Takes half a second at 4096². Fails if nothing is left of a surface thinner than the new pixels.
    pub fn make(&self) -> Result<ReducedSurface, SurfaceError> {
        Ok(ReducedSurface { of: Arc::downgrade(&self.of), small: Arc::new(self.of.stretched(self.to)?) })
    }
    /// Both do the same work.
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.of, &other.of) && self.to == other.to
    }
}

impl DocumentReducer {
    /// `factor`: as of [`Document::scaled`].
    pub fn new(factor: f32) -> Self {
        let (layers, parts) = (HashMap::new(), HashMap::new());
        Self { factor, surface: None, layers, parts, shaped: Arc::new(Parts::for_drafts()) }
    }
    /// The reduced document: as [`Document::scaled`], with the same errors; but pictures of image layers are read from
    /// levels as much coarser, and selections by the surface are resampled and not found again.
    pub fn of(&mut self, document: &Document) -> Result<Document, SurfaceError> {
        let Some(scale) = self.scale(document) else { return Ok(self.drafted(document)) };
        let of = if document.is_shaped() { document.surface.as_ref() } else { document.maps_surface() };
        let surface = of.map(|surface| self.surface(surface, &scale)).transpose()?;
        let mut layers = HashMap::new();
        let small = self.stack(&document.layers, &|layer| Arc::new(scale.layer(layer)), &mut layers);
        self.layers = layers;
        let small = Document { size: scale.to, surface, layers: small, ..scale.selected(document) };
        Ok(if document.is_shaped() { small } else { self.shaped(document, small, &scale) })
    }
    /// The document in its own size, its layers read as for a moment: all but those that are [kept](Self::keep).
    fn drafted(&mut self, document: &Document) -> Document {
        let mut layers = HashMap::new();
        let drafted = |layer: &Arc<Layer>| match layer.content.drafted() {
            Some(content) => Arc::new(Layer { content, cache: Default::default(), ..Layer::clone(layer) }),
            None => layer.clone(),
        };
        let stack = self.stack(&document.layers, &drafted, &mut layers);
        self.layers = layers;
        Document { layers: stack, ..if document.is_shaped() { document.clone() } else { document.reshaped() } }
    }
    /// Layers of a document at rest are rendered already: in their own size they are shown as they are.
    pub fn keep(&mut self, document: &Document) {
        if self.scale(document).is_none() {
            let own = |(_, layer): (_, &Arc<Layer>)| (layer.id, (Arc::downgrade(layer), layer.clone()));
            self.layers = document.walk().into_iter().map(own).collect();
        }
    }
    /// A small document with the surface of its parts, which are themselves scaled down: the user drags them.
    fn shaped(&mut self, document: &Document, small: Document, scale: &CanvasScale) -> Document {
        let mut parts = HashMap::new();
        for part in &document.parts.list {
            let known = self.parts.get(&part.id).filter(|(known, _)| known.as_ptr() == Arc::as_ptr(part));
            let made = known.map_or_else(|| scale.part(part), |(_, made)| made.clone());
            parts.insert(part.id.clone(), (Arc::downgrade(part), made));
        }
        self.parts = parts;
        let list = document.parts.list.iter().filter_map(|part| Some(self.parts.get(&part.id)?.1.clone()));
        let bare = Document { parts: Arc::new(self.shaped.emptied()), ..small };
        let shaped = bare.with_parts(list.collect());
        self.shaped = shaped.parts.clone();
        shaped
    }
    /// What [`DocumentReducer::of`] would have to scale down of a document's surface; `None` if nothing.
    pub fn missing_surface(&self, document: &Document) -> Option<SurfaceReduction> {
        let scale = self.scale(document)?;
        if !document.is_shaped() {
            return None;
        }
        let surface = document.surface.as_ref().filter(|surface| self.known_surface(surface, scale.to).is_none())?;
        Some(SurfaceReduction { of: surface.clone(), to: scale.to })
    }
    /// Takes in a surface that was scaled down elsewhere.
    pub fn take_surface(&mut self, made: ReducedSurface) {
        self.surface = Some((made.of, made.small));
    }
    /// Scales one more layer of the document in advance for [`DocumentReducer::of`]; returns whether there was one. An
    /// idle thread can prepare in steps with this, and make what [`DocumentReducer::missing_surface`] returns.
    pub fn prepare(&mut self, document: &Document) -> bool {
        let Some(scale) = self.scale(document) else { return false };
        // Groups cost nothing once their layers are known.
        let is_new = |layer: &&Arc<Layer>| {
            let known = self.layers.get(&layer.id).is_some_and(|(known, _)| known.as_ptr() == Arc::as_ptr(layer));
            !known && layer.content.group().is_none()
        };
        let Some(layer) = document.walk().into_iter().map(|(_, layer)| layer).find(is_new) else { return false };
        self.layers.insert(layer.id, (Arc::downgrade(layer), Arc::new(scale.layer(layer))));
        true
    }
    fn scale(&self, document: &Document) -> Option<CanvasScale> {
        CanvasScale::of(document.size, self.factor).map(CanvasScale::for_a_moment)
    }
    fn known_surface(&self, surface: &Arc<Surface>, to: Size) -> Option<&Arc<Surface>> {
        let (of, small) = self.surface.as_ref()?;
        (of.as_ptr() == Arc::as_ptr(surface) && small.size() == to).then_some(small)
    }
    fn surface(&mut self, surface: &Arc<Surface>, scale: &CanvasScale) -> Result<Arc<Surface>, SurfaceError> {
        if let Some(small) = self.known_surface(surface, scale.to) {
            return Ok(small.clone());
        }
        let small = Arc::new(surface.stretched(scale.to)?);
        self.surface = Some((Arc::downgrade(surface), small.clone()));
        Ok(small)
    }
    /// Makes a list of layers again, taking known ones from last time; `next` collects what is known from now on.
    fn stack(
        &self,
        layers: &[Arc<Layer>],
        make: &dyn Fn(&Arc<Layer>) -> Arc<Layer>,
        next: &mut HashMap<LayerId, (Weak<Layer>, Arc<Layer>)>,
    ) -> Vec<Arc<Layer>> {
        let mut small = Vec::with_capacity(layers.len());
        for layer in layers {
            let known = self.layers.get(&layer.id).filter(|(known, _)| known.as_ptr() == Arc::as_ptr(layer));
            // Also if the group itself is known: its layers must stay known.
            let inner = layer
                .content
                .group()
                .map(|group| Group { layers: self.stack(&group.layers, make, next), pass_through: group.pass_through });
            let made = match (known, inner) {
                (Some((_, made)), _) => made.clone(),
                (None, Some(group)) if is_made_of(layer, &group) => layer.clone(),
                (None, Some(group)) => {
                    let hollow = Layer { content: Content::Group(Group::default()), ..Layer::clone(layer) };
                    let made = Layer::clone(&make(&Arc::new(hollow)));
                    Arc::new(Layer { content: Content::Group(group), cache: Default::default(), ..made })
                }
                (None, None) => make(layer),
            };
            next.insert(layer.id, (Arc::downgrade(layer), made.clone()));
            small.push(made);
        }
        small
    }
}

/// A layer is a group of the very same layers.
fn is_made_of(layer: &Layer, group: &Group) -> bool {
    let same = |own: &Group| own.layers.iter().zip(&group.layers).all(|(a, b)| Arc::ptr_eq(a, b));
    layer.content.group().is_some_and(same)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Live, Progress, diff, flatten};
    use crate::math::{srgb::Color, vec3};
    use crate::paint::{Adjust, ImageFilter, PictureSource, PlacedImage, Placement};
    use crate::raster::{Outside, Picture, Plane};
    use crate::surface::Maps;

    fn fill(name: &str, v: u8) -> Layer {
        Layer::new(name, Content::Fill(Color { r: v, g: v, b: v, a: 255 }))
    }

    #[test]
    fn what_did_not_change_is_the_very_same_and_the_picture_is_that_of_scaling() {
        let group =
            Layer::new("group", Content::Group(Group { layers: vec![Arc::new(fill("in", 9))], pass_through: true }));
        let layers = vec![Arc::new(fill("beneath", 40)), Arc::new(group)];
        let document = Document { layers, ..Document::empty(Size::new(300, 200)) };
        let mut reduced = DocumentReducer::new(0.5);
        let first = reduced.of(&document).unwrap();
        assert_eq!(first.size, Size::new(150, 100));
        let inner = document.layer_named("in").unwrap().id;
        let changed = document.with_layer(inner, |layer| layer.opacity = 0.5).unwrap();
        let second = reduced.of(&changed).unwrap();
        assert!(Arc::ptr_eq(&first.layers[0], &second.layers[0]));
        assert!(!diff(&first, &second).is_empty());
        assert!(diff(&second, &reduced.of(&changed).unwrap()).is_empty());
        let (ours, whole) =
            (flatten(&second, &Progress::default()), flatten(&changed.scaled(0.5).unwrap(), &Progress::default()));
        let area = second.size.rect();
        assert!(ours.unwrap().to_straight_rgba(area) == whole.unwrap().to_straight_rgba(area));
    }
    #[test]
    fn pictures_of_a_draft_are_read_as_coarsely_as_its_pixels_are() {
        let size = Size::new(256, 128);
        let texels = (0..size.area()).map(|i| if i % 2 == 0 { [255; 4] } else { [0, 0, 0, 255] }).collect();
        let picture = Picture::srgb8(size, texels).unwrap();
        let levels = |scale: f32, filter: ImageFilter| {
            let image = PlacedImage {
                source: PictureSource::new("stripes".into(), picture.clone(), Adjust::default()),
                placement: Placement { scale, ..Placement::covering(size) },
                outside: Outside::Mirror,
                bend: Default::default(),
                filter,
                frame: Default::default(),
            };
            let layers = vec![Arc::new(Layer::new("image", Content::Image(Live::new(image))))];
            let document = Document { layers, ..Document::empty(size) };
            let width = |document: &Document| match &document.layers[0].content {
                Content::Image(live) => live.params().source.texture().size().width,
                _ => 0,
            };
            let small = DocumentReducer::new(0.25).of(&document).unwrap();
            let grey = flatten(&small, &Progress::default()).unwrap().pixel(32, 16);
            assert!(filter == ImageFilter::Bilinear || scale > 1.0 || grey[0].abs_diff(128) < 4, "{grey:?}");
            (width(&small), width(&document.scaled(0.25).unwrap()))
        };
        assert_eq!(levels(1.0, ImageFilter::Antialias), (64, 256), "a print reads all");
        assert_eq!(levels(2.0, ImageFilter::Antialias), (128, 256), "magnified twice");
        assert_eq!(levels(9.0, ImageFilter::Antialias), (256, 256));
        assert_eq!(levels(1.0, ImageFilter::Bilinear), (256, 256));
    }
    #[test]
    fn what_a_hand_drags_is_read_coarsely_in_its_own_size_and_the_rest_stays_as_it_is() {
        let size = Size::new(96, 64);
        let texel = |i: usize| [(i * 37) as u8, (i * 101) as u8, (i * 11) as u8, 255];
        let picture = Picture::srgb8(Size::new(900, 600), (0..900 * 600).map(texel).collect()).unwrap();
        let image = |name: &str| {
            let image = PlacedImage {
                source: PictureSource::new("noise".into(), picture.clone(), Adjust::default()),
                placement: Placement::covering(size),
                outside: Outside::Mirror,
                bend: Default::default(),
                filter: ImageFilter::Antialias,
                frame: Default::default(),
            };
            Arc::new(Layer::new(name, Content::Image(Live::new(image))))
        };
        let group = |layers| Arc::new(Layer::new("group", Content::Group(Group { layers, pass_through: false })));
        let layers = vec![Arc::new(fill("ground", 9)), group(vec![image("at rest")]), group(vec![image("dragged")])];
        let document = Document { layers, ..Document::empty(size) };
        let mut reduced = DocumentReducer::new(1.0);
        reduced.keep(&document);
        let kept = reduced.of(&document).unwrap();
        assert!(kept.layers.iter().zip(&document.layers).all(|(a, b)| Arc::ptr_eq(a, b)));
        let id = document.layer_named("dragged").unwrap().id;
        let next = document.with_layer(id, |layer| layer.content = image("").content.clone()).unwrap();
        let draft = reduced.of(&next).unwrap();
        let same: Vec<bool> = draft.layers.iter().zip(&next.layers).map(|(a, b)| Arc::ptr_eq(a, b)).collect();
        assert_eq!(same, [true, true, false]);
        let bytes =
            |document: &Document| flatten(document, &Progress::default()).unwrap().to_straight_rgba(size.rect());
        let (coarse, fine) = (bytes(&draft), bytes(&next));
        let apart = coarse.iter().zip(&fine).map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>() / fine.len() as f64;
        assert!(apart > 0.1 && apart < 12.0, "{apart}");
        assert!(bytes(&document) == fine, "at rest nothing is coarser");
        assert!(Arc::ptr_eq(&reduced.of(&next).unwrap().layers[2], &draft.layers[2]), "it is made once");
    }
    #[test]
    fn a_surface_made_small_elsewhere_is_taken_in_and_not_made_again() {
        let size = Size::new(300, 200);
        let normals = Plane::from_fn(size, |x, _| vec3((0.1 * x as f32).sin(), 0.0, 1.0));
        let maps = Maps { normals, depth: Plane::filled(size, 0.5), coverage: Plane::filled(size, 255) };
        let document = Document { surface: Surface::new(maps).ok().map(Arc::new), ..Document::empty(size) };
        let mut reduced = DocumentReducer::new(0.5);
        let missing = reduced.missing_surface(&document).unwrap();
        assert!(missing.is_same(&reduced.missing_surface(&document).unwrap()));
        let made = missing.make().unwrap();
        let small = made.small.clone();
        reduced.take_surface(made);
        assert!(reduced.missing_surface(&document).is_none() && !reduced.prepare(&document));
        assert!(Arc::ptr_eq(reduced.of(&document).unwrap().surface.as_ref().unwrap(), &small));
        assert!(DocumentReducer::new(1.0).missing_surface(&document).is_none(), "nothing is to be made small");
    }
    #[test]
    fn what_was_prepared_part_by_part_is_not_made_again() {
        let document = Document {
            layers: vec![Arc::new(fill("beneath", 40)), Arc::new(fill("above", 90))],
            ..Document::empty(Size::new(300, 200))
        };
        let mut reduced = DocumentReducer::new(0.5);
        assert!(reduced.prepare(&document) && reduced.prepare(&document) && !reduced.prepare(&document));
        let made: Vec<_> = document.layers.iter().map(|layer| reduced.layers[&layer.id].1.clone()).collect();
        let small = reduced.of(&document).unwrap();
        assert!(small.layers.iter().zip(&made).all(|(a, b)| Arc::ptr_eq(a, b)));
        let changed = document.with_layer(document.layers[1].id, |layer| layer.opacity = 0.5).unwrap();
        assert!(reduced.prepare(&changed) && !reduced.prepare(&changed), "only the layer that changed");
    }
    #[test]
    fn parts_that_a_hand_drags_are_shaped_small_and_those_at_rest_are_not_made_again() {
        use crate::document::parts::{Inflation, OutlineSource, PartKind};
        use crate::math::vec2;
        let disc = |x: f32, r: f32| {
            let at = |i: usize| vec2(x, 120.0) + r * crate::math::Vec2::from_angle(i as f32 * 0.1);
            OutlineSource::Path((0..63).map(at).collect())
        };
        let part = |id: &str, x: f32, puff: f32| {
            let inflation = Inflation { puff, ..Inflation::default() };
            Part::new(id, PartKind::Inflate { outline: disc(x, 60.0), inflation })
        };
        let document = Document::empty(Size::new(400, 240));
        let document = document.with_part(part("a", 100.0, 1.0)).with_part(part("b", 280.0, 1.0));
        let mut reduced = DocumentReducer::new(0.5);
        let dragged = document.with_part_ahead(part("a", 100.0, 0.4));
        assert!(
            !dragged.is_shaped() && Arc::ptr_eq(dragged.surface.as_ref().unwrap(), document.surface.as_ref().unwrap())
        );
        let small = reduced.of(&dragged).unwrap();
        let apart = |small: &Document, puff: f32| {
            let whole = document.with_part(part("a", 100.0, puff)).scaled(0.5).unwrap();
            let (a, b) = (small.surface.as_ref().unwrap(), whole.surface.as_ref().unwrap());
            let at = |s: &Surface, x, y| s.normal(x, y);
            [(30, 50), (60, 70), (140, 60), (160, 80)].map(|(x, y)| at(a, x, y).distance(at(b, x, y)))
        };
        assert!(apart(&small, 0.4).iter().all(|d| *d < 1e-3), "{:?}", apart(&small, 0.4));
        let b = small.part_forms()[1].1.clone();
        let next = reduced.of(&document.with_part_ahead(part("a", 100.0, 0.7))).unwrap();
        assert!(apart(&next, 0.7).iter().all(|d| *d < 1e-3) && Arc::ptr_eq(&next.part_forms()[1].1, &b));
        // At rest it is the same surface as if it had been made directly.
        let rested = dragged.reshaped();
        let at_once = document.with_part(part("a", 100.0, 0.4));
        assert!(rested.is_shaped() && rested.parts.list.len() == 2);
        let normals =
            |document: &Document| document.surface.as_ref().unwrap().normal_planes().map(|p| p.values().to_vec());
        assert!(normals(&rested) == normals(&at_once));
    }
}
