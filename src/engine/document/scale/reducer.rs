//! Scales a changing document down again and again: parts that did not change are not scaled twice.
//! Floor 4. The scaling of one layer is in `scale`.

use super::super::{
    Content, Document, Group, Layer, LayerId, LayerTransform, Part, Parts, PixelLayer,
};
use super::CanvasScale;
use crate::math::Size;
use crate::raster::{TileAt, TileGrid};
use crate::surface::{Surface, SurfaceError};
use std::collections::HashMap;
use std::sync::{Arc, Weak};

/// Scales documents down by one factor, and remembers the parts of the last one. Pictures and
/// gradients are read more coarsely than at rest; with the factor 1 that is the only change.
///
/// Parts that did not change come back as the same `Arc`, so that [`diff`](super::super::diff())
/// reports only what did.
pub struct DocumentReducer {
    factor: f32,
    surface: Option<(Weak<Surface>, Arc<Surface>)>,
    layers: HashMap<LayerId, KnownLayer>,
    begun: Option<BegunLayer>,
    /// Small parts by their ids, and what was made of them: for documents whose parts the user
    /// drags.
    parts: HashMap<String, (Weak<Part>, Arc<Part>)>,
    shaped: Arc<Parts>,
}

/// A layer, and what was made of it.
struct KnownLayer {
    of: Weak<Layer>,
    /// Of a new version of the layer with the same content only the rest is made again.
    content: Content,
    made: Arc<Layer>,
}

impl KnownLayer {
    fn new(of: &Arc<Layer>, made: Arc<Layer>) -> Self {
        // The layers of a group are known one by one.
        let content = if of.content.group().is_some() {
            Content::Group(Group::default())
        } else {
            of.content.clone()
        };
        Self { of: Arc::downgrade(of), content, made }
    }

    fn is_of(&self, layer: &Arc<Layer>) -> bool {
        self.of.as_ptr() == Arc::as_ptr(layer)
    }
}

/// A paint layer of which some tiles are scaled.
struct BegunLayer {
    of: Weak<Layer>,
    tiles: TileGrid,
    /// Those still to come.
    left: Vec<TileAt>,
}

impl BegunLayer {
    /// Small tiles that are made in one go: a few ms, which a new stroke may have to wait.
    const AT_ONCE: usize = 256;

    fn new(layer: &Arc<Layer>, pixels: &PixelLayer, scale: &CanvasScale) -> Self {
        let (tiles, left) = scale.blank_grid(&pixels.tiles);
        Self { of: Arc::downgrade(layer), tiles, left }
    }

    /// Scales some more tiles; whether that was all.
    fn advance(&mut self, pixels: &PixelLayer, scale: &CanvasScale) -> bool {
        let now = self.left.split_off(self.left.len().saturating_sub(Self::AT_ONCE));
        scale.fill_tiles(&pixels.tiles, &now, &mut self.tiles);
        self.left.is_empty()
    }

    /// The layer's content with the tiles that were made.
    fn content(self, pixels: &PixelLayer, scale: &CanvasScale) -> Content {
        let blank = PixelLayer { tiles: TileGrid::default(), ..pixels.clone() };
        match Content::Pixels(blank).scaled(scale) {
            Content::Pixels(small) => Content::Pixels(PixelLayer { tiles: self.tiles, ..small }),
            other => other,
        }
    }
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
    /// Takes half a second at 4096². Fails if nothing is left of a surface thinner than the new
    /// pixels.
    pub fn make(&self) -> Result<ReducedSurface, SurfaceError> {
        Ok(ReducedSurface { of: Arc::downgrade(&self.of), small: self.of.scaled(self.to)? })
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
        Self {
            factor,
            surface: None,
            layers,
            begun: None,
            parts,
            shaped: Arc::new(Parts::for_drafts()),
        }
    }

    /// The reduced document: as [`Document::scaled`], with the same errors; but pictures of image
    /// layers are read from levels as much coarser, and selections by the surface are resampled and
    /// not found again.
    pub fn of(&mut self, document: &Document) -> Result<Document, SurfaceError> {
        let Some(scale) = self.scale(document) else { return Ok(self.draft(document)) };
        let of =
            if document.is_ahead() { document.maps_surface() } else { document.surface.as_ref() };
        let surface = of.map(|surface| self.surface(surface, &scale)).transpose()?;
        let mut layers = HashMap::new();
        let small = self.stack(
            &document.layers,
            &|layer| Arc::new(self.scaled(layer, &scale)),
            &mut layers,
        );
        self.layers = layers;
        let small =
            Document { size: scale.to, surface, layers: small, ..scale.scale_selections(document) };
        Ok(if document.is_ahead() {
            self.with_scaled_shape(document, small, &scale)
        } else {
            small
        })
    }

    fn scaled(&self, layer: &Arc<Layer>, scale: &CanvasScale) -> Layer {
        let known =
            self.layers.get(&layer.id).filter(|known| known.content.is_identical(&layer.content));
        scale.layer_showing(layer, known.map(|known| &*known.made))
    }

    /// The document in its own size, its layers read as for a moment: all but those that are
    /// [kept](Self::keep).
    fn draft(&mut self, document: &Document) -> Document {
        let mut layers = HashMap::new();
        let drafted = |layer: &Arc<Layer>| {
            let transform = layer.transform.as_ref().map(LayerTransform::drafted);
            match layer.content.drafted() {
                Some(content) => Arc::new(Layer {
                    content,
                    transform,
                    cache: Default::default(),
                    ..Layer::clone(layer)
                }),
                None if transform != layer.transform => {
                    Arc::new(Layer { transform, ..Layer::clone(layer) })
                }
                None => layer.clone(),
            }
        };
        let stack = self.stack(&document.layers, &drafted, &mut layers);
        self.layers = layers;
        Document {
            layers: stack,
            ..if document.is_ahead() { document.reshaped() } else { document.clone() }
        }
    }

    /// Layers of a document at rest are rendered already: in their own size they are shown as they
    /// are.
    pub fn keep(&mut self, document: &Document) {
        if self.scale(document).is_none() {
            let own =
                |(_, layer): (_, &Arc<Layer>)| (layer.id, KnownLayer::new(layer, layer.clone()));
            self.layers = document.walk().into_iter().map(own).collect();
        }
    }

    /// A small document with the surface of its parts, which are themselves scaled down: the user
    /// drags them.
    fn with_scaled_shape(
        &mut self,
        document: &Document,
        small: Document,
        scale: &CanvasScale,
    ) -> Document {
        let mut parts = HashMap::new();
        for part in &document.parts.list {
            let known =
                self.parts.get(&part.id).filter(|(known, _)| known.as_ptr() == Arc::as_ptr(part));
            let made = known.map_or_else(|| scale.part(part), |(_, made)| made.clone());
            parts.insert(part.id.clone(), (Arc::downgrade(part), made));
        }
        self.parts = parts;
        let list =
            document.parts.list.iter().filter_map(|part| Some(self.parts.get(&part.id)?.1.clone()));
        let bare = Document { parts: Arc::new(self.shaped.emptied()), ..small };
        let shaped = bare.with_parts(list.collect());
        self.shaped = shaped.parts.clone();
        shaped
    }

    /// What [`DocumentReducer::of`] would have to scale down of a document's surface; `None` if
    /// nothing.
    pub fn missing_surface(&self, document: &Document) -> Option<SurfaceReduction> {
        let scale = self.scale(document)?;
        if document.is_ahead() {
            return None;
        }
        let surface = document
            .surface
            .as_ref()
            .filter(|surface| self.known_surface(surface, scale.to).is_none())?;
        Some(SurfaceReduction { of: surface.clone(), to: scale.to })
    }

    /// Takes in a surface that was scaled down elsewhere.
    pub fn take_surface(&mut self, made: ReducedSurface) {
        self.surface = Some((made.of, made.small));
    }

    /// Scales one more layer of the document, or more of its tiles, in advance for
    /// [`DocumentReducer::of`]; returns whether there was one. An idle thread can prepare in steps
    /// with this, and make what [`DocumentReducer::missing_surface`] returns.
    pub fn prepare(&mut self, document: &Document) -> bool {
        let Some(scale) = self.scale(document) else { return false };
        // Groups cost nothing once their layers are known.
        let is_new = |layer: &&Arc<Layer>| {
            let known = self.layers.get(&layer.id).is_some_and(|known| known.is_of(layer));
            !known && layer.content.group().is_none()
        };
        let Some(layer) = document.walk().into_iter().map(|(_, layer)| layer).find(is_new) else {
            return false;
        };
        let layer = layer.clone();
        let known = self
            .layers
            .get(&layer.id)
            .is_some_and(|known| known.content.is_identical(&layer.content));
        let made = match &layer.content {
            Content::Pixels(pixels) if !known => {
                let begun =
                    self.begun.take().filter(|begun| begun.of.as_ptr() == Arc::as_ptr(&layer));
                let mut begun = begun.unwrap_or_else(|| BegunLayer::new(&layer, pixels, &scale));
                if !begun.advance(pixels, &scale) {
                    self.begun = Some(begun);
                    return true;
                }
                let content = begun.content(pixels, &scale);
                scale.layer_showing(&layer, Some(&Layer { content, ..Layer::clone(&layer) }))
            }
            _ => self.scaled(&layer, &scale),
        };
        self.layers.insert(layer.id, KnownLayer::new(&layer, Arc::new(made)));
        true
    }

    fn scale(&self, document: &Document) -> Option<CanvasScale> {
        CanvasScale::of(document.size, self.factor).map(CanvasScale::for_a_moment)
    }

    fn known_surface(&self, surface: &Arc<Surface>, to: Size) -> Option<&Arc<Surface>> {
        let (of, small) = self.surface.as_ref()?;
        (of.as_ptr() == Arc::as_ptr(surface) && small.size() == to).then_some(small)
    }

    fn surface(
        &mut self,
        surface: &Arc<Surface>,
        scale: &CanvasScale,
    ) -> Result<Arc<Surface>, SurfaceError> {
        if let Some(small) = self.known_surface(surface, scale.to) {
            return Ok(small.clone());
        }
        let small = surface.scaled(scale.to)?;
        self.surface = Some((Arc::downgrade(surface), small.clone()));
        Ok(small)
    }

    /// Makes a list of layers again, taking known ones from last time; `next` collects what is
    /// known from now on.
    fn stack(
        &self,
        layers: &[Arc<Layer>],
        make: &dyn Fn(&Arc<Layer>) -> Arc<Layer>,
        next: &mut HashMap<LayerId, KnownLayer>,
    ) -> Vec<Arc<Layer>> {
        let mut small = Vec::with_capacity(layers.len());
        for layer in layers {
            let known = self.layers.get(&layer.id).filter(|known| known.is_of(layer));
            // Also if the group itself is known: its layers must stay known.
            let inner = layer.content.group().map(|group| Group {
                layers: self.stack(&group.layers, make, next),
                pass_through: group.pass_through,
            });
            let made = match (known, inner) {
                (Some(known), _) => known.made.clone(),
                (None, Some(group)) if is_made_of(layer, &group) => make(layer),
                (None, Some(group)) => {
                    let hollow =
                        Layer { content: Content::Group(Group::default()), ..Layer::clone(layer) };
                    let made = Layer::clone(&make(&Arc::new(hollow)));
                    Arc::new(Layer {
                        content: Content::Group(group),
                        cache: Default::default(),
                        ..made
                    })
                }
                (None, None) => make(layer),
            };
            next.insert(layer.id, KnownLayer::new(layer, made.clone()));
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
mod tests;
