//! What drawings by the form read of other layers: strokes that hatching follows, a picture whose
//! tone it has or whose edges are lines, ink and strokes that lines leave out. Floor 3. Not here:
//! finding them in a document (`document::form_sources`).

use super::inked::InkOnCanvas;
use crate::math::{Size, Vec2, srgb};
use crate::raster::{Plane, TILE, TileGrid};
use crate::surface::form_lines::PaperColors;
use crate::surface::hatching::GuideLines;
use std::any::Any;
use std::sync::{Arc, Weak};

/// Layers that a drawing by the form reads, by their names; none where a name is empty.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DrawingSources {
    /// The stroke layer whose strokes hatching follows.
    pub guides: String,
    /// The stroke layer whose strokes stand in the place of form lines.
    pub redrawn: String,
    /// The layer or group whose tone it has.
    pub tone: String,
}

/// What is in those layers. Whatever it is, it counts as equal: it follows from what is around a
/// drawing.
#[derive(Clone, Default)]
pub struct FoundSources {
    /// Strokes that hatching follows.
    pub guides: GuideLines,
    /// The picture whose tone it has; `None` if it has a light of its own.
    pub tone: Option<Arc<TonePicture>>,
    /// The picture whose edges of color are lines; `None` if those are not wanted.
    pub colors: Option<Arc<ColorPicture>>,
    /// The ink and the strokes that lines leave out.
    pub ink: InkOnCanvas,
}

impl PartialEq for FoundSources {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl FoundSources {
    /// The same on a canvas `factor` times as large.
    pub fn scaled(&self, factor: f32) -> Self {
        let (guides, ink) = (self.guides.scaled(factor), self.ink.scaled(factor));
        Self { guides, tone: self.tone.clone(), colors: self.colors.clone(), ink }
    }

    /// Whether both are the same.
    pub fn is_same(&self, other: &Self) -> bool {
        let of = |found: &Self| {
            (found.tone.as_ref().map(Arc::as_ptr), found.colors.as_ref().map(Arc::as_ptr))
        };
        of(self) == of(other) && self.guides == other.guides && self.ink.is_same(&other.ink)
    }

    /// Whether drawings with either are the same.
    pub fn is_alike(&self, other: &Self) -> bool {
        let is_as_light = match (&self.tone, &other.tone) {
            (Some(a), Some(b)) => a.light == b.light,
            (a, b) => a.is_none() && b.is_none(),
        };
        let has_its_colors = match (&self.colors, &other.colors) {
            (Some(a), Some(b)) => a.colors.is_alike(&b.colors),
            (a, b) => a.is_none() && b.is_none(),
        };
        let is_guided_alike = self.guides == other.guides;
        is_as_light && has_its_colors && is_guided_alike && self.ink.is_same(&other.ink)
    }
}

/// Something that a picture was made of, to be known again; not held by this.
#[derive(Clone, Debug)]
pub struct ToneSource(Weak<dyn Any + Send + Sync>);

impl ToneSource {
    /// Of a shared value.
    pub fn of<T: Any + Send + Sync>(shared: &Arc<T>) -> Self {
        let shared: Arc<dyn Any + Send + Sync> = shared.clone();
        Self(Arc::downgrade(&shared))
    }

    fn is_same(&self, other: &Self) -> bool {
        // A weak pointer keeps its address from being used again.
        self.0.as_ptr().cast::<()>() == other.0.as_ptr().cast::<()>()
    }
}

/// Layers that a picture was made of, and the size of their canvas.
#[derive(Clone, Debug)]
pub struct ReadLayers {
    canvas: Size,
    sources: Vec<ToneSource>,
}

impl ReadLayers {
    /// These, on a canvas of that size.
    pub fn new(canvas: Size, sources: Vec<ToneSource>) -> Self {
        Self { canvas, sources }
    }

    /// Whether both are the same.
    pub fn is_same(&self, other: &Self) -> bool {
        self.canvas == other.canvas
            && self.sources.len() == other.sources.len()
            && self.sources.iter().zip(&other.sources).all(|(a, b)| a.is_same(b))
    }
}

/// How light a picture on white paper is, in steps of its sRGB code.
#[derive(Debug)]
pub struct TonePicture {
    light: Plane<u8>,
    read: ReadLayers,
}

impl TonePicture {
    /// Of a picture on a canvas, and of what that was made.
    pub fn of(picture: &TileGrid, read: ReadLayers) -> Self {
        Self { light: on_paper(picture, read.canvas, lightness), read }
    }

    /// Whether it was made of the same.
    pub fn is_of(&self, read: &ReadLayers) -> bool {
        self.read.is_same(read)
    }

    /// Bytes that it holds.
    pub fn bytes(&self) -> u64 {
        self.light.size().area() as u64
    }

    /// The tone at a place of a canvas, `[0, 1]`; the canvas may be of another size.
    pub fn at(&self, place: Vec2, canvas: Size) -> f32 {
        let size = self.light.size();
        let pixel = |v: f32, from: u32, n: u32| {
            let scaled = v * n as f32 / from.max(1) as f32;
            (scaled.max(0.0) as usize).min(n.saturating_sub(1) as usize)
        };
        let (x, y) =
            (pixel(place.x, canvas.width, size.width), pixel(place.y, canvas.height, size.height));
        f32::from(self.light.at(x, y)) / 255.0
    }
}

/// The colors of a picture whose edges are lines.
#[derive(Debug)]
pub struct ColorPicture {
    /// On white paper.
    pub colors: Arc<PaperColors>,
    read: ReadLayers,
}

impl ColorPicture {
    /// Of a picture on a canvas, and of what that was made.
    pub fn of(picture: &TileGrid, read: ReadLayers) -> Self {
        let colors = PaperColors::new(on_paper(picture, read.canvas, color));
        Self { colors: Arc::new(colors), read }
    }

    /// Whether it was made of the same.
    pub fn is_of(&self, read: &ReadLayers) -> bool {
        self.read.is_same(read)
    }

    /// Bytes that it holds.
    pub fn bytes(&self) -> u64 {
        self.colors.size().area() as u64 * 3
    }
}

/// What premultiplied pixels of a picture are on white paper.
fn on_paper<T>(picture: &TileGrid, size: Size, of: impl Fn(&[u8]) -> T) -> Plane<T>
where
    T: Copy + Send + Sync,
{
    let mut plane = Plane::full(size, of(&[0; 4]));
    for (at, tile) in picture.iter() {
        let corner = at.rect();
        let inside = corner.intersect(size.rect());
        for (y, x) in
            (inside.y0..inside.y1).flat_map(|y| (inside.x0..inside.x1).map(move |x| (y, x)))
        {
            let i = (y - corner.y0) as usize * TILE + (x - corner.x0) as usize;
            plane.set(x as usize, y as usize, of(&tile.bytes()[4 * i..4 * i + 4]));
        }
    }
    plane
}

/// The sRGB codes of a premultiplied pixel on white paper.
fn color(pixel: &[u8]) -> [u8; 3] {
    let free = 255 - pixel[3];
    [0, 1, 2].map(|i| pixel[i].saturating_add(free))
}

/// The sRGB code of the luminance of a premultiplied pixel on white paper.
fn lightness(pixel: &[u8]) -> u8 {
    let [r, g, b] = color(pixel).map(|code| srgb::decode(f32::from(code) / 255.0));
    srgb::quantize(srgb::encode(srgb::luminance(r, g, b)))
}
