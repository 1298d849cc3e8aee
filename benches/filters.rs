//! Adjustments and filters while something beneath or of them changes: ms a frame, from the new
//! document to its flattened tiles, as least, middle, and what nine of ten stay within.
//! `cargo bench --bench filters`.

mod timing;

use rilievo::document::{Content, Layer, PixelLayer, PreparedDocument, diff};
use rilievo::math::{Vec3, vec3};
use rilievo::raster::{Plane, TileAt};
use rilievo::{Color, Document, Maps, Progress, Size, Surface, TileGrid};
use rilievo_engine::document::DocumentReducer;
use rilievo_engine::math::hash;
use rilievo_engine::paint::adjustment::{
    ColorTable, NumberParameter, ParameterName, ParameterVisitor, ToneCurve,
};
use rilievo_engine::paint::filter::GaussianBlur;
use rilievo_engine::paint::{ColorAdjustment, GradientStop, PictureFilter};
use rilievo_program::tools::{ToolContext, ToolKind, ToolSettings};
use std::sync::Arc;
use std::time::Instant;

const SCREEN: Size = Size::new(1920, 1080);
const LARGE: Size = Size::new(4096, 4096);
const FRAMES: usize = 9;

/// Opaque paint in patches of noise.
fn paint(size: Size) -> Layer {
    let (w, h) = (size.width as usize, size.height as usize);
    let byte = |x: usize, y: usize, c: u32| (hash::unit(c, x as u32, y as u32) * 255.0) as u8;
    let pixel = |i: usize| {
        let (x, y) = (i % w / 8, i / w / 8);
        [byte(x, y, 0), byte(x, y, 1), byte(x, y, 2), 255]
    };
    let rgba: Vec<u8> = (0..w * h).flat_map(pixel).collect();
    Layer::new("paint", TileGrid::from_straight_rgba(&rgba, w, h, 0, 0))
}

fn of(size: Size, layers: Vec<Layer>) -> Document {
    Document { layers: layers.into_iter().map(Arc::new).collect(), ..Document::empty(size) }
}

/// A ball before a wall, over the whole canvas.
fn shaped(document: Document) -> Document {
    let size = document.size;
    let (radius, middle) = (0.4 * size.height as f32, size.center());
    let from = |x: usize, y: usize| (x as f32 - middle.x, y as f32 - middle.y);
    let up = |x, y| {
        let (dx, dy) = from(x, y);
        (radius * radius - dx * dx - dy * dy).max(0.0).sqrt()
    };
    let normal = |x: usize, y: usize| -> Vec3 {
        let (dx, dy) = from(x, y);
        if up(x, y) > 0.0 { vec3(dx, -dy, up(x, y)) } else { Vec3::Z }
    };
    let maps = Maps {
        normals: Plane::from_fn(size, normal),
        depth: Plane::from_fn(size, |x, y| 0.9 - 0.5 * up(x, y) / radius),
        coverage: Plane::full(size, 255),
    };
    Document { surface: Surface::new(maps).ok().map(Arc::new), ..document }
}

/// ms of one frame: the tiles that differ.
fn frame(old: &Document, new: &Document, picture: &mut TileGrid) -> Option<f64> {
    let progress = Progress::default();
    let start = Instant::now();
    let tiles: Vec<TileAt> = diff(old, new).into_iter().collect();
    *picture = PreparedDocument::new(new, &progress)?.flatten_tiles(picture, &tiles, &progress)?;
    Some(start.elapsed().as_secs_f64() * 1e3)
}

/// The frames of a series of documents.
///
/// * `drawn`: what is drawn of each.
fn series(
    first: &Document,
    mut drawn: impl FnMut(&Document) -> Document,
    next: impl Fn(&Document, usize) -> Document,
) -> Vec<f64> {
    let mut picture = rilievo::flatten(first, &Progress::default()).unwrap_or_default();
    let (mut own, mut shown) = (first.clone(), first.clone());
    let step = |i: usize| {
        own = next(&own, i);
        let new = drawn(&own);
        let ms = frame(&shown, &new, &mut picture)?;
        shown = new;
        Some(ms)
    };
    (1..=FRAMES).map_while(step).collect()
}

/// Moves the first slider by a share of its range.
struct Nudge {
    by: f32,
    is_moved: bool,
}

impl ParameterVisitor for Nudge {
    fn number(&mut self, parameter: NumberParameter, value: &mut f32) {
        if !std::mem::replace(&mut self.is_moved, true) {
            let by = self.by * (parameter.most - parameter.least);
            *value = (*value + by).max(parameter.least).min(parameter.most);
        }
    }

    fn flag(&mut self, _: ParameterName, _: bool, _: &mut bool) {}

    fn color(&mut self, _: ParameterName, _: Color, _: &mut Color) {}

    fn curve(&mut self, _: ParameterName, _: &mut ToneCurve) {}

    fn stops(&mut self, _: ParameterName, _: &mut Vec<GradientStop>) {}

    fn table(&mut self, _: ParameterName, _: &mut Option<ColorTable>) {}

    fn group(&mut self, _: ParameterName, inside: &mut dyn FnMut(&mut dyn ParameterVisitor)) {
        inside(self);
    }
}

/// A slider of a filter over the whole picture is dragged: as the window draws it meanwhile, and, where
/// that is a draft, each picture as it is at rest.
fn dragged(filter: &PictureFilter) {
    let layer = |filter: PictureFilter| Layer::new("filter", filter);
    let document = shaped(of(SCREEN, vec![paint(SCREEN), layer(filter.clone())]));
    let id = document.layers[1].id;
    let next = |document: &Document, i: usize| {
        let set = |layer: &mut Layer| {
            let mut next = filter.clone();
            next.visit(&mut Nudge { by: i as f32 * 1e-3, is_moved: false });
            layer.content = Content::from(next);
        };
        document.with_layer(id, set).unwrap_or_else(|| document.clone())
    };
    let mut reduced = DocumentReducer::new(1.0);
    reduced.keep(&document);
    let mut draft = |document: &Document| reduced.of(document).expect("of its own size");
    let name = filter.name();
    timing::row(&format!("{name}, dragged, 1920 × 1080"), series(&document, &mut draft, next));
    let moved = next(&document, 1);
    if !diff(&moved, &draft(&moved)).is_empty() {
        let ms = series(&document, Document::clone, next);
        timing::row(&format!("{name}, at rest, 1920 × 1080"), ms);
    }
}

/// A dab of 40 px beneath a Gaussian blur.
fn painted_beneath(radius: f32) {
    let filter = PictureFilter::GaussianBlur(GaussianBlur { radius });
    let name = format!("{} of {radius} px, a dab beneath, 1920 × 1080", filter.name());
    let document = shaped(of(SCREEN, vec![paint(SCREEN), Layer::new("filter", filter)]));
    let id = document.layers[0].id;
    let next = |document: &Document, i: usize| {
        let rgba = [i as u8 * 20, 90, 200, 255].repeat(40 * 40);
        let dab = TileGrid::from_straight_rgba(&rgba, 40, 40, 700 + 40 * i as i32, 500);
        let set = |layer: &mut Layer| {
            if let Content::Pixels(PixelLayer { tiles, .. }) = &mut layer.content {
                dab.iter().for_each(|(at, tile)| tiles.set(at, Some(tile.clone())));
            }
        };
        document.with_layer(id, set).unwrap_or_else(|| document.clone())
    };
    timing::row(&name, series(&document, Document::clone, next));
}

/// Adjustments over 4096², a stroke beneath.
fn stacked(adjustments: Vec<ColorAdjustment>) {
    let count = adjustments.len();
    let adjustments = adjustments.into_iter().map(|a| Layer::new("adjust", a));
    let layers = std::iter::once(paint(LARGE)).chain(adjustments);
    let document = of(LARGE, layers.collect());
    let id = document.layers[0].id;
    let tools = ToolSettings::default();
    let context = ToolContext { layer: Some(id), ..ToolContext::new(&document, &tools) };
    let frames = timing::frames(ToolKind::Brush, &context, timing::on_wave, 30);
    timing::row(&format!("{count} adjustments, a stroke beneath, 4096²"), frames);
}

fn main() {
    println!("{:56} {:>8} {:>8} {:>8}", "ms a frame", "least", "middle", "9 of 10");
    PictureFilter::all().iter().for_each(dragged);
    [4.0, 20.0, 100.0].into_iter().for_each(painted_beneath);
    let names = [
        "levels",
        "curves",
        "exposure",
        "brightness-contrast",
        "vibrance",
        "hue-saturation",
        "color-balance",
        "photo-filter",
        "channel-mixer",
        "selective-color",
        "black-white",
        "gradient-map",
    ];
    stacked(names.into_iter().filter_map(ColorAdjustment::from_name).collect());
    // One of each kind, with settings that change something.
    let moved = |mut adjustment: ColorAdjustment| {
        adjustment.visit(&mut Nudge { by: 0.1, is_moved: false });
        adjustment
    };
    stacked(ColorAdjustment::all().into_iter().map(moved).collect());
}
