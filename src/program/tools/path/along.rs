//! What else a path is good for: the selection of its inside and the other way round, and strokes of
//! the brush along it.
//! Floor 5.

use super::{PathSettings, of_layer, to_canvas};
use crate::document::{Document, LayerId};
use crate::math::{Vec2, srgb::Color};
use crate::paint::path::{FlatLine, fit_closed};
use crate::paint::{LivePath, PathRule, Sample, Subpath};
use crate::raster::CoverageGrid;
use crate::raster::coverage::{shapes, trace};
use crate::tools::{Outcome, PenSample, ToolContext, ToolKind, press};

/// How far the pen goes from sample to sample, px, and in a second.
const STEP_PX: f32 = 2.0;
const SPEED_PX: f32 = 500.0;

/// How far a path may run from the edge of the selection that it is made from, px.
const ERROR_PX: f32 = 0.6;

/// The path around what is selected; `None` where nothing is, or no file could hold it.
pub fn around(
    selected: &CoverageGrid,
    settings: &PathSettings,
    colors: [Color; 2],
) -> Option<LivePath> {
    let lines = trace::trace(selected);
    let lines: Vec<Subpath> = lines.iter().map(|line| fit_closed(line, ERROR_PX)).collect();
    let path = settings.path(lines, colors);
    (path.count_nodes() > 0 && path.fits().is_ok()).then_some(path)
}

/// What lies inside of the path of a layer, where it is seen before it is bent; `None` for a layer
/// that is no path.
pub fn inside(document: &Document, id: LayerId) -> Option<CoverageGrid> {
    let (lines, rule) = canvas_lines(document, id)?;
    let polygons: Vec<&[Vec2]> = lines.iter().map(|line| &line.points[..]).collect();
    let has_holes = rule == PathRule::EvenOdd;
    Some(shapes::polygons(&polygons, has_holes, document.size.rect()))
}

/// The lines of the path of a layer on the canvas.
fn canvas_lines(document: &Document, id: LayerId) -> Option<(Vec<FlatLine>, PathRule)> {
    let shown = document.with_transform_applied(id)?;
    let image = of_layer(shown.layer(id)?)?;
    let path = image.source.path()?;
    Some((path.flatten(to_canvas(image, document.size)), path.rule))
}

/// The closed lines of the path of a layer on the canvas, before it is bent; `None` for a layer that
/// is no path, and beyond a horizon.
pub fn lines_on_canvas(document: &Document, id: LayerId) -> Option<Vec<Subpath>> {
    let shown = document.with_transform_applied(id)?;
    let image = of_layer(shown.layer(id)?)?;
    let path = image.source.path()?;
    let map = to_canvas(image, document.size);
    let is_seen = |line: &&Subpath| line.flatten(&map).is_some();
    let lines = path.subpaths();
    let seen = lines.iter().filter(|line| line.nodes.len() > 1).filter(is_seen);
    let lines = seen.map(|line| Subpath { closed: true, ..line.mapped(|p| map(p).unwrap_or(p)) });
    Some(lines.collect())
}

/// The document after the brush went along the path of a layer, and the layer that it painted on.
/// Refused where the brush is refused.
///
/// * `context`: its active layer is painted on; one that cannot hold strokes gets a stroke layer
///   above it.
pub fn stroke(context: &ToolContext, path: LayerId) -> Result<(Document, Option<LayerId>), String> {
    let lines = canvas_lines(context.document, path).ok_or("That layer is no path.")?.0;
    let (mut document, mut layer) = (context.document.clone(), context.layer);
    let mut is_any = false;
    for pens in lines.iter().map(pens_along).filter(|pens| !pens.is_empty()) {
        let here = ToolContext { document: &document, layer, ..*context };
        let (gesture, outcome) = press(ToolKind::Brush, &here, pens[0]);
        let Some(mut gesture) = gesture else {
            return match outcome {
                Outcome::Refused(why) => Err(why.into_owned()),
                _ => Err("The brush cannot paint there.".into()),
            };
        };
        gesture.drag(&pens[1..]);
        let mut outcome = gesture.release();
        while let Outcome::Settings(_, then) = outcome {
            outcome = *then;
        }
        if let Outcome::Commit { document: next, select, .. } = outcome {
            (document, layer, is_any) = (next, select.or(layer), true);
        }
    }
    if is_any { Ok((document, layer)) } else { Err("The path has no line to go along.".into()) }
}

/// A pen that goes along a line at an even speed, pressed as wide as the line is.
fn pens_along(line: &FlatLine) -> Vec<PenSample> {
    let widest = line.widths.iter().copied().fold(1.0, f32::max);
    let (mut pens, mut gone_px) = (Vec::new(), 0.0);
    let mut push = |at: Vec2, width: f32, gone_px: f32| {
        let (pressure, time_secs) = ((width / widest).max(0.0).min(1.0), gone_px / SPEED_PX);
        let sample = Sample { pressure, time_secs, ..Sample::at(at) };
        pens.push(PenSample { sample, ..PenSample::at(at) });
    };
    for (i, pair) in line.points.windows(2).enumerate() {
        let (length, widths) = (pair[0].distance(pair[1]), &line.widths[i..i + 2]);
        if i == 0 {
            push(pair[0], widths[0], 0.0);
        }
        let steps = (length / STEP_PX).ceil().max(1.0);
        for step in 1..=steps as usize {
            let t = step as f32 / steps;
            let width = widths[0] + (widths[1] - widths[0]) * t;
            push(pair[0].lerp(pair[1], t), width, gone_px + length * t);
        }
        gone_px += length;
    }
    pens
}
