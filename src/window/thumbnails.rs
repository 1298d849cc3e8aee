//! Thumbnails of layers, painted on a thread of their own, each once for each version of its layer.
//! Floor 7.

use super::jobs;
use crate::Error;
use crate::document::{Document, Layer, LayerId, LayerMask, MaskKind, Progress, flatten_layer};
use crate::mood_pictures::MoodPictures;
use crate::part_pictures::PartPictures;
use crate::raster::{Plane, TileGrid};
use crate::surface::Surface;
use eframe::egui::{
    self, Color32, ColorImage, TextureHandle, TextureId, TextureOptions, Vec2, vec2,
};
use std::collections::HashMap;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Weak};

/// The longer side of a thumbnail, px.
const SIDE: u32 = 64;

/// A request for a thumbnail.
struct ThumbnailOrder {
    layer: Arc<Layer>,
    document: Document,
}

/// A finished thumbnail.
struct Thumbnail {
    id: LayerId,
    image: ColorImage,
}

/// The finished thumbnails, and the thread that makes them.
pub struct Thumbnails {
    orders: Sender<ThumbnailOrder>,
    done: Receiver<Thumbnail>,
    made: HashMap<LayerId, TextureHandle>,
    /// Which version of a layer was ordered last.
    ordered: HashMap<LayerId, Weak<Layer>>,
    /// For masks that are pictures, each with the one it shows.
    masks: HashMap<LayerId, (Weak<Plane<u8>>, bool, TextureHandle)>,
    /// Of the parts of the shape.
    pub parts: PartPictures,
    /// Of the moods.
    pub moods: MoodPictures,
    /// Errors to report once.
    pub trouble: Option<Error>,
}

impl Thumbnails {
    pub fn new(ctx: &egui::Context) -> Self {
        let (orders, coming) = channel::<ThumbnailOrder>();
        let (finished, done) = channel();
        let waker = ctx.clone();
        let work = move || {
            let mut maker = ThumbnailMaker::default();
            while let Ok(order) = coming.recv() {
                // If a layer changes while it waits, only the last version counts.
                let mut latest: HashMap<LayerId, ThumbnailOrder> =
                    HashMap::from([(order.layer.id, order)]);
                latest.extend(coming.try_iter().map(|order| (order.layer.id, order)));
                for order in latest.into_values() {
                    let Some(small) = maker.make(&order) else { continue };
                    if finished.send(small).is_err() {
                        return;
                    }
                    waker.request_repaint();
                }
            }
        };
        // Without a thread there are no thumbnails, only icons.
        let trouble = jobs::spawn("thumbnails", work).err();
        Self {
            orders,
            done,
            made: HashMap::new(),
            ordered: HashMap::new(),
            masks: HashMap::new(),
            parts: PartPictures::default(),
            moods: MoodPictures::default(),
            trouble,
        }
    }

    /// Takes what was made.
    pub fn collect(&mut self, ctx: &egui::Context) {
        for Thumbnail { id, image } in self.done.try_iter() {
            let texture = ctx.load_texture(format!("layer {id:?}"), image, TextureOptions::LINEAR);
            self.made.insert(id, texture);
        }
    }

    /// The thumbnail of a layer, updated to the latest version as soon as possible. Adjustments
    /// have none.
    pub fn of(
        &mut self,
        _ctx: &egui::Context,
        document: &Document,
        layer: &Arc<Layer>,
    ) -> Option<(TextureId, Vec2)> {
        if !layer.content.has_pixels() {
            return None;
        }
        let is_ordered =
            self.ordered.get(&layer.id).is_some_and(|known| known.as_ptr() == Arc::as_ptr(layer));
        if !is_ordered {
            self.ordered.insert(layer.id, Arc::downgrade(layer));
            let alone = Document { layers: vec![layer.clone()], ..document.clone() };
            // Without a thread there is no receiver; the error was reported.
            let _ = self.orders.send(ThumbnailOrder { layer: layer.clone(), document: alone });
        }
        self.made
            .get(&layer.id)
            .map(|texture| (texture.id(), vec2(texture.size()[0] as f32, texture.size()[1] as f32)))
    }

    /// The thumbnail of a layer's mask with its inversion; a derived mask has none.
    pub fn of_mask(&mut self, ctx: &egui::Context, layer: &Layer) -> Option<(TextureId, Vec2)> {
        let LayerMask { kind: MaskKind::File { coverage, .. }, invert, .. } =
            layer.mask.as_ref()?
        else {
            return None;
        };
        let known = self
            .masks
            .get(&layer.id)
            .filter(|(of, inverted, _)| of.as_ptr() == Arc::as_ptr(coverage) && inverted == invert);
        if known.is_none() {
            let size = coverage.size();
            let step = size.width.max(size.height).div_ceil(SIDE).max(1);
            let (width, height) =
                (size.width.div_ceil(step) as usize, size.height.div_ceil(step) as usize);
            let gray = |i: usize| {
                let at = |v: usize| (v as u32 * step + step / 2) as i32;
                let v = coverage.clamped(at(i % width), at(i / width));
                Color32::from_gray(if *invert { 255 - v } else { v })
            };
            let image = ColorImage::new([width, height], (0..width * height).map(gray).collect());
            let texture =
                ctx.load_texture(format!("mask {:?}", layer.id), image, TextureOptions::LINEAR);
            self.masks.insert(layer.id, (Arc::downgrade(coverage), *invert, texture));
        }
        self.masks.get(&layer.id).map(|(_, _, texture)| (texture.id(), texture.size_vec2()))
    }
}

/// The thread's state: the last reduced surface.
#[derive(Default)]
struct ThumbnailMaker {
    surface: Option<(Weak<Surface>, Option<Arc<Surface>>)>,
}

impl ThumbnailMaker {
    fn make(&mut self, order: &ThumbnailOrder) -> Option<Thumbnail> {
        let size = order.document.size;
        let factor = (SIDE as f32 / size.longer_side()).min(1.0);
        // The surface is reduced once, not for every layer.
        let flat = Document { surface: None, ..order.document.clone() };
        let mut small = flat.scaled(factor).ok()?;
        small.surface = self.small_surface(order.document.surface.as_ref(), &small);
        let layer = small.layers.first()?;
        let id = layer.id;
        let bare = small.with_layer(id, |layer| (layer.opacity, layer.visible) = (1.0, true))?;
        let grid: TileGrid = flatten_layer(&bare, id, &Progress::default())?;
        let bytes = grid.to_straight_rgba(bare.size.rect());
        let pixels = bytes
            .as_chunks::<4>()
            .0
            .iter()
            .map(|&[r, g, b, a]| Color32::from_rgba_unmultiplied(r, g, b, a));
        let image = ColorImage::new(
            [bare.size.width as usize, bare.size.height as usize],
            pixels.collect(),
        );
        Some(Thumbnail { id, image })
    }

    fn small_surface(
        &mut self,
        surface: Option<&Arc<Surface>>,
        to: &Document,
    ) -> Option<Arc<Surface>> {
        let surface = surface?;
        if let Some((known, small)) = &self.surface
            && known.as_ptr() == Arc::as_ptr(surface)
        {
            return small.clone();
        }
        let small = surface.stretched(to.size).ok().map(Arc::new);
        self.surface = Some((Arc::downgrade(surface), small.clone()));
        small
    }
}
