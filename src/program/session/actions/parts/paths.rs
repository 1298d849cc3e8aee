//! The first shape of a vector drawing: each filled path of an SVG is the outline of a part. Floor 6.
//! Not here: what an SVG holds (`io::svg`), shapes of pixels (`first`).

use super::{FirstShape, first, free_id, new};
use crate::document::parts::from_flats::MOST_COLORS;
use crate::document::{
    Content, Document, Group, Inflation, Layer, LayerId, LayerSlot, Live, OutlineSource, Part,
    PartKind, Progress,
};
use crate::io::Budget;
use crate::io::files::read_file;
use crate::io::svg::{self, SvgShape, SvgShapes};
use crate::math::{Affine2, Size, Vec2};
use crate::paint::path::StraightCut;
use crate::paint::{LivePath, PathRule, PlacedImage, Subpath};
use crate::raster::CoverageGrid;
use crate::raster::coverage::product;
use crate::shape::flats::areas::LEAST_SHARE;
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

/// A path that is less opaque is a shade on others, and no part.
const LEAST_OPACITY: f32 = 0.5;

/// A path that covers more of the canvas is a ground and no part, unless there is no other.
const GROUND_SHARE: f64 = 0.999;

/// With more paths, the drawing stays one picture, and only outlines of parts are layers.
const MOST_LAYERS: usize = 64;

/// The name of a path without an id, and of the group of outlines that are not shown.
const PATH: &str = "Path";
const OUTLINES: &str = "Outlines";

const NO_SVG: &str = "This layer is no SVG drawing, so it has no paths.";

/// The parts of the paths of an SVG, and the layers that they are made from.
pub struct PathParts {
    /// Paths, or groups of a path and what clips it; bottom first.
    pub layers: Vec<Arc<Layer>>,
    /// Each from one of the layers; the farthest first.
    pub parts: Vec<Part>,
    /// The layers look like the drawing.
    pub is_drawing: bool,
    /// Filled paths that are too small or too many to be parts.
    left_out: usize,
}

impl PathParts {
    /// Of an SVG on a canvas.
    ///
    /// * `map`: canvas px from pixels of the SVG. `taken`: names that no layer may have.
    pub fn of(
        svg: &SvgShapes,
        canvas: Size,
        map: &Affine2,
        mut taken: BTreeSet<String>,
        inflation: Inflation,
    ) -> Self {
        let placed: Vec<SvgShape> = svg.shapes.iter().map(|shape| place(shape, map)).collect();
        let mut areas: Vec<(usize, f64)> = placed
            .iter()
            .enumerate()
            .filter(|(_, shape)| is_solid(shape))
            .map(|(i, shape)| (i, visible_area_px(shape, canvas)))
            .filter(|(_, area)| *area > 0.0)
            .collect();
        // What covers all of the canvas is the ground that others lie on.
        let ground = GROUND_SHARE * canvas.area() as f64;
        if areas.iter().any(|(_, area)| *area < ground) {
            areas.retain(|(_, area)| *area < ground);
        }
        let filled = areas.len();
        let least = f64::from(LEAST_SHARE) * canvas.area() as f64;
        areas.retain(|(_, area)| *area >= least);
        areas.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        areas.truncate(MOST_COLORS);
        let solid: BTreeSet<usize> = areas.into_iter().map(|(i, _)| i).collect();
        let is_drawing = svg.is_exact && placed.len() <= MOST_LAYERS;
        let (mut layers, mut parts) = (Vec::new(), Vec::new());
        for (i, shape) in placed.iter().enumerate() {
            if !is_drawing && !solid.contains(&i) {
                continue;
            }
            let name = free_name(&shape.name, &mut taken);
            layers.push(Arc::new(layer_of(shape, &name, canvas)));
            if solid.contains(&i) {
                let outline = OutlineSource::Layer { layer: name.clone(), color: None };
                let id = format!("part-{}", parts.len() + 1);
                let part = Part::new(id, PartKind::Inflate { outline, inflation });
                parts.push(Part { name, ..part });
            }
        }
        Self { layers, left_out: filled - parts.len(), parts, is_drawing }
    }

    /// What the user is told about paths without a part.
    pub fn note(&self) -> Option<String> {
        let paths = match self.left_out {
            0 => return None,
            1 => "One filled path is".into(),
            n => format!("{n} filled paths are"),
        };
        let least = LEAST_SHARE * 100.0;
        Some(format!(
            "{paths} left without a part: a part covers at least {least} % of the picture, and \
             there are at most {MOST_COLORS} parts."
        ))
    }
}

/// A name that is not taken, and is from now on.
fn free_name(name: &str, taken: &mut BTreeSet<String>) -> String {
    let base = if name.trim().is_empty() { PATH } else { name };
    let base: String = base.chars().take(Layer::LONGEST_NAME - 8).collect();
    let numbered = (2..).map(|i| format!("{base} {i}"));
    let free = [base.clone()].into_iter().chain(numbered).find(|name| !taken.contains(name));
    let free = free.unwrap_or(base);
    taken.insert(free.clone());
    free
}

/// A shape on the canvas.
fn place(shape: &SvgShape, map: &Affine2) -> SvgShape {
    let scale = map.matrix2.determinant().abs().sqrt();
    let mapped = |path: &LivePath| {
        let lines = path.subpaths();
        let lines = lines.iter().map(|line| line.mapped(|p| map.transform_point2(p))).collect();
        LivePath {
            outline: path.outline * scale,
            dashes: path.dashes.iter().map(|dash| dash * scale).collect(),
            ..path.with_lines(lines)
        }
    };
    SvgShape {
        name: shape.name.clone(),
        path: mapped(&shape.path),
        clips: shape.clips.iter().map(mapped).collect(),
        opacity: shape.opacity,
    }
}

/// Whether a shape covers what lies beneath it, and a document can hold it.
fn is_solid(shape: &SvgShape) -> bool {
    let alpha = shape.path.fill.map_or(0.0, |fill| f32::from(fill.a) / 255.0);
    alpha * shape.opacity >= LEAST_OPACITY
}

/// How much of the canvas a shape covers, px.
fn visible_area_px(shape: &SvgShape, canvas: Size) -> f64 {
    let inside = |path: &LivePath| path.inside(canvas.rect());
    let clipped = |own: CoverageGrid, clip: &LivePath| own.combined(&inside(clip), product);
    shape.clips.iter().fold(inside(&shape.path), clipped).area_px()
}

/// The layer of a shape: its path, cut by straight clips; in a group with clips that are not
/// straight.
fn layer_of(shape: &SvgShape, name: &str, canvas: Size) -> Layer {
    let flat = |name: &str, path: LivePath| {
        let image = PlacedImage::of_path(canvas, path);
        Layer { clip_to_surface: false, ..Layer::new(name, Content::Image(Live::new(image))) }
    };
    let (mut path, mut frames) = (shape.path.clone(), Vec::new());
    for clip in &shape.clips {
        match clipped_straight(&path, clip) {
            Some(cut) => path = cut,
            None => frames.push(flat("Clip", clip.clone())),
        }
    }
    let own = flat(if frames.is_empty() { name } else { PATH }, path);
    if frames.is_empty() {
        return Layer { opacity: shape.opacity, ..own };
    }
    let layers = [own].into_iter().chain(frames).map(Arc::new).collect();
    let group = Content::Group(Group { layers, pass_through: false });
    Layer { opacity: shape.opacity, clip_to_surface: false, ..Layer::new(name, group) }
}

/// A path without an outline within a convex clip of straight sides; `None` for any other.
fn clipped_straight(path: &LivePath, clip: &LivePath) -> Option<LivePath> {
    let lines = clip.subpaths();
    let [line] = &lines[..] else { return None };
    let has_handle =
        line.nodes.iter().any(|node| node.before != Vec2::ZERO || node.after != Vec2::ZERO);
    if path.outline > 0.0 || has_handle || line.nodes.len() < 3 || path.rule == PathRule::EvenOdd {
        return None;
    }
    let corners: Vec<Vec2> = line.nodes.iter().map(|node| node.at).collect();
    let next = |i: usize| corners[(i + 1) % corners.len()];
    let turn = |i: usize| (next(i) - corners[i]).perp_dot(next((i + 1) % corners.len()) - next(i));
    let turns: Vec<f32> = (0..corners.len()).map(turn).collect();
    let is_left = turns.iter().all(|turn| *turn <= 0.0);
    if !is_left && !turns.iter().all(|turn| *turn >= 0.0) {
        return None;
    }
    let mut inside: Vec<Subpath> = path.subpaths().into_owned();
    for (i, corner) in corners.iter().enumerate() {
        let Some(side) = StraightCut::between(*corner, next(i)) else { continue };
        inside = if is_left { side } else { side.reversed() }.left_of(&inside);
    }
    Some(path.with_lines(inside))
}

/// A layer of an SVG gets a shape, a part for each of its filled paths. If canceled, nobody uses the
/// result.
///
/// * `file`: the SVG, if the layer does not hold it.
pub fn shape_paths(
    document: &Document,
    layer: LayerId,
    file: Option<&Path>,
    inflation: Inflation,
    progress: &Progress,
) -> Result<FirstShape, String> {
    const NO_LAYER: &str = "There is no such layer.";
    let budget = Budget::of_this_machine();
    let applied = document.with_transform_applied(layer).ok_or(NO_LAYER)?;
    let shown = applied.layer(layer).ok_or(NO_LAYER)?;
    let (held, map) = match &shown.content {
        Content::Image(live) => {
            let image = live.params();
            let held = image.source.picture.encoded.clone();
            let plane = applied.map_of(layer).and_then(|map| map.plane.as_affine());
            (held, plane.unwrap_or_default() * image.frame_from_own(document.size))
        }
        Content::Pixels(_) => (None, Affine2::IDENTITY),
        _ => return Err(NO_SVG.into()),
    };
    let read = file.map(|file| read_file(file, budget.file_bytes)).transpose();
    let bytes = match (read.map_err(|error| error.to_string())?, &held) {
        (Some(bytes), _) => bytes,
        (None, Some(held)) => held.bytes().to_vec(),
        (None, None) => Vec::new(),
    };
    let name = file.unwrap_or(Path::new(&shown.name));
    if !svg::is_svg(&bytes) {
        return Err(NO_SVG.into());
    }
    let svg = svg::read_shapes(name, &bytes, &budget).map_err(|error| error.to_string())?;
    let taken = document.walk().into_iter().map(|(_, layer)| layer.name.clone()).collect();
    let made = PathParts::of(&svg, document.size, &map, taken, inflation);
    put(&applied, layer, made, progress)
}

/// The document with the layers and the parts of a drawing's paths.
fn put(
    document: &Document,
    layer: LayerId,
    made: PathParts,
    progress: &Progress,
) -> Result<FirstShape, String> {
    const NO_LAYER: &str = "There is no such layer.";
    let note = made.note();
    let mut list = document.parts.list.clone();
    for part in made.parts {
        let id = free_id(document, &list);
        let name = new::free_name(document, &part.name);
        list.push(Arc::new(Part { id, name, ..part }));
    }
    let last = list.last().filter(|_| list.len() > document.parts.list.len());
    let part = last.map(|part| part.id.clone());
    let part = part.ok_or("No filled path of it covers enough to be a part.")?;
    let group = Content::Group(Group { layers: made.layers, pass_through: false });
    let place = document.place_of(layer).ok_or(NO_LAYER)?;
    let next = match made.is_drawing {
        true => document.with_layer(layer, |layer| {
            (layer.content, layer.clip_to_surface) = (group, false);
        }),
        false => {
            let outlines = Layer {
                visible: false,
                clip_to_surface: false,
                ..Layer::new(document.free_layer_name(OUTLINES), group)
            };
            let drawn = document.with_layer(layer, |layer| layer.clip_to_surface = false);
            drawn.and_then(|drawn| drawn.with_inserted(outlines, place))
        }
    };
    let next = next.ok_or(NO_LAYER)?;
    let light = first::light_layer(&next, None);
    let id = light.id;
    let place = next.place_of(layer).ok_or(NO_LAYER)?;
    let above = LayerSlot { index: place.index + 1, ..place };
    let next = next.with_inserted(light, above).ok_or(NO_LAYER)?;
    let next = next.with_parts_with_progress(list, progress).ok_or("It was canceled.")?;
    match next.surface {
        Some(_) => Ok(FirstShape { document: next, part, light: id, note }),
        None => Err("Nothing in this layer is opaque enough to have a shape.".into()),
    }
}
