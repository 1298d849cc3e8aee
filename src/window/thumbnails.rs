//! Thumbnails of layers, painted on a thread of their own, each once for each version of its layer.
//! Floor 7.

use super::jobs;
use crate::Error;
use crate::document::{
    Content, Document, InkLayer, Layer, LayerId, LayerMask, MaskKind, PixelLayer, Progress,
    flatten_layer,
};
use crate::io::profile_change::show_in_srgb;
use crate::mood_pictures::MoodPictures;
use crate::part_pictures::PartPictures;
use crate::raster::{Plane, TileGrid};
use crate::reduce::Reduction;
use crate::surface::Surface;
use eframe::egui::{
    self, Color32, ColorImage, TextureHandle, TextureId, TextureOptions, Vec2, vec2,
};
use std::collections::HashMap;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Weak};

/// The longer side of a thumbnail, px: two for each point of the list.
const SIDE: u32 = 80;

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
    /// None is begun at present.
    is_held: bool,
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
            is_held: false,
            trouble,
        }
    }

    /// Takes what was made.
    ///
    /// * `is_painting`: the canvas is behind its picture. Then and while something is dragged, which
    ///   changes a layer in every frame, no thumbnail is begun: all of them would take the threads
    ///   that paint what the user looks at.
    pub fn collect(&mut self, ctx: &egui::Context, is_painting: bool) {
        self.is_held = is_painting || ctx.input(|input| input.pointer.any_down());
        for Thumbnail { id, image } in self.done.try_iter() {
            let texture = ctx.load_texture(format!("layer {id:?}"), image, TextureOptions::LINEAR);
            self.made.insert(id, texture);
        }
    }

    /// The thumbnail of a layer, updated to the latest version as soon as nothing else is painted.
    /// Adjustments have none.
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
        if !is_ordered && !self.is_held {
            self.ordered.insert(layer.id, Arc::downgrade(layer));
            let alone = Document { layers: vec![without_drawing(layer)], ..document.clone() };
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
            let image = Reduction::new(coverage.size(), SIDE).reduce(|x, y| {
                let v = coverage.at_clamped(x, y);
                let v = if *invert { 255 - v } else { v };
                [v, v, v, 255]
            });
            let texture =
                ctx.load_texture(format!("mask {:?}", layer.id), image, TextureOptions::LINEAR);
            self.masks.insert(layer.id, (Arc::downgrade(coverage), *invert, texture));
        }
        self.masks.get(&layer.id).map(|(_, _, texture)| (texture.id(), texture.size_vec2()))
    }
}

/// The layer as it is without the others: lines that follow a drawing are the pixels that they are
/// now.
fn without_drawing(layer: &Arc<Layer>) -> Arc<Layer> {
    let Content::Ink(InkLayer { shown: Some(shown), .. }) = &layer.content else {
        return layer.clone();
    };
    let pixels = PixelLayer { file: String::new(), x: 0, y: 0, tiles: shown.tiles.clone() };
    Arc::new(Layer { content: Content::Pixels(pixels), ..Layer::clone(layer) })
}

/// The thread's state: the surfaces that were reduced last, the newest first.
#[derive(Default)]
struct ThumbnailMaker {
    surfaces: Vec<(Weak<Surface>, Arc<Surface>)>,
}

/// As many reduced surfaces are kept: one for each scale at which layers are painted.
const SURFACES: usize = 4;
/// How much larger a layer is painted that covers little of the canvas: by a power of two.
const LARGEST_ZOOM: f32 = 4.0;

impl ThumbnailMaker {
    /// Cropped to what the layer covers.
    fn make(&mut self, order: &ThumbnailOrder) -> Option<Thumbnail> {
        let id = order.layer.id;
        let mut factor = (SIDE as f32 / order.document.size.longer_side()).min(1.0);
        let mut image = self.paint(order, factor)?;
        let mut covered = covered_area(&image);
        let zoom = SIDE as f32 / covered.longer_side().max(1.0);
        if zoom >= 2.0 && factor < 1.0 {
            factor = (factor * zoom.min(LARGEST_ZOOM).log2().floor().exp2()).min(1.0);
            image = self.paint(order, factor)?;
            covered = self::covered_area(&image);
        }
        Some(Thumbnail { id, image: image.region_by_pixels(covered.low, covered.size) })
    }

    /// The whole canvas with the layer alone, so much smaller.
    fn paint(&mut self, order: &ThumbnailOrder, factor: f32) -> Option<ColorImage> {
        // The surface is reduced once, not for every layer.
        let flat = Document { surface: None, ..order.document.clone() };
        let mut small = flat.scaled(factor).ok()?;
        small.surface = self.small_surface(order.document.surface.as_ref(), &small);
        let layer = small.layers.first()?;
        let id = layer.id;
        let bare = small.with_layer(id, |layer| (layer.opacity, layer.visible) = (1.0, true))?;
        let grid: TileGrid = flatten_layer(&bare, id, &Progress::default())?;
        let mut bytes = grid.to_straight_rgba(bare.size.rect());
        show_in_srgb(&mut bytes, order.document.profile);
        let pixels = bytes
            .as_chunks::<4>()
            .0
            .iter()
            .map(|&[r, g, b, a]| Color32::from_rgba_unmultiplied(r, g, b, a));
        let size = [bare.size.width as usize, bare.size.height as usize];
        Some(ColorImage::new(size, pixels.collect()))
    }

    fn small_surface(
        &mut self,
        surface: Option<&Arc<Surface>>,
        to: &Document,
    ) -> Option<Arc<Surface>> {
        let surface = surface?;
        let is_same = |(known, small): &&(Weak<Surface>, Arc<Surface>)| {
            known.as_ptr() == Arc::as_ptr(surface) && small.size() == to.size
        };
        if let Some((_, small)) = self.surfaces.iter().find(is_same) {
            return Some(small.clone());
        }
        let small = surface.stretched(to.size).ok().map(Arc::new)?;
        self.surfaces.insert(0, (Arc::downgrade(surface), small.clone()));
        self.surfaces.truncate(SURFACES);
        Some(small)
    }
}

/// A rectangle of a small picture: its corner and its sides, px.
#[derive(Clone, Copy, Debug, PartialEq)]
struct CoveredArea {
    low: [usize; 2],
    size: [usize; 2],
}

impl CoveredArea {
    fn longer_side(self) -> f32 {
        self.size[0].max(self.size[1]) as f32
    }
}

/// What is not transparent, with a margin of a pixel; all of it if nothing is covered.
fn covered_area(image: &ColorImage) -> CoveredArea {
    let [width, height] = image.size;
    let whole = CoveredArea { low: [0, 0], size: image.size };
    let at = |i: usize| [i % width.max(1), i / width.max(1)];
    let seen = image.pixels.iter().enumerate().filter(|(_, pixel)| pixel.a() > 8);
    let ends = seen.map(|(i, _)| (at(i), at(i))).reduce(|(low, high), (a, b)| {
        ([low[0].min(a[0]), low[1].min(a[1])], [high[0].max(b[0]), high[1].max(b[1])])
    });
    let Some((low, high)) = ends else { return whole };
    let low = low.map(|v| v.saturating_sub(1));
    let high = [(high[0] + 2).min(width), (high[1] + 2).min(height)];
    CoveredArea { low, size: [high[0] - low[0], high[1] - low[1]] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Size;

    #[test]
    fn a_thumbnail_is_cropped_to_what_is_covered() {
        let mut image = ColorImage::filled([20, 10], Color32::TRANSPARENT);
        assert_eq!(covered_area(&image).size, [20, 10], "an empty one shows the canvas");
        image[(4, 3)] = Color32::RED;
        image[(7, 9)] = Color32::RED;
        assert_eq!(covered_area(&image), CoveredArea { low: [3, 2], size: [6, 8] });
    }

    #[test]
    fn lines_have_a_thumbnail_without_their_drawing() {
        let size = Size::new(80, 64);
        // Two flats, with ink around and between them.
        let pixel = |i: usize| {
            let (x, y) = (i % 80, i / 80);
            let is_within = |m: usize| (m..80 - m).contains(&x) && (m..64 - m).contains(&y);
            match () {
                _ if !is_within(6) => [0; 4],
                _ if !is_within(8) || (39..41).contains(&x) => [24, 20, 30, 255],
                _ if x < 40 => [210, 60, 40, 255],
                _ => [50, 160, 90, 255],
            }
        };
        let rgba: Vec<u8> = (0..80 * 64).flat_map(pixel).collect();
        let tiles = TileGrid::from_straight_rgba(&rgba, 80, 64, 0, 0);
        let drawing = Layer::new("Drawing", tiles);
        let id = drawing.id;
        let document = Document { layers: vec![Arc::new(drawing)], ..Document::empty(size) };
        let (document, ink) = document.with_lines_on_top(id).unwrap();
        let layer = without_drawing(document.layer(ink).unwrap());
        let alone = Document { layers: vec![layer.clone()], ..document };
        let order = ThumbnailOrder { layer, document: alone };
        let image = ThumbnailMaker::default().make(&order).unwrap().image;
        assert!(image.pixels.iter().any(|pixel| pixel.a() > 200), "no line is seen");
        assert!(image.pixels.iter().all(|pixel| pixel.r() < 60 || pixel.a() < 60), "only lines");
    }
}
