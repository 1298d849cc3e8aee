//! New parts: from the active layer, the selection or the selected stroke, or bodies in the middle
//! of the canvas. Floor 6.

use super::{PartRefusal, free_id, grays};
use crate::document::parts::{CoverageFile, OutlineSource, Part, PartKind, PartMaps};
use crate::document::{Document, Inflation, LayerId};
use crate::math::{Vec2, vec2};
use crate::session::OpenDocument;
use crate::session::replay::names;
use crate::shape::{Ball, Bevel, Body, Detail, Lines, Primitive};
use std::sync::Arc;

rilievo_engine::named! {
    /// The kinds of new parts.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum NewPart {
        InflateLayer = "inflate" => ("Puff up this layer", "What the selected layer covers, filled with air"),
        InflateSelection = "inflate selection" => ("Puff up selection", "What is selected, filled with air"),
        Bevel = "bevel" => ("Bevel", "The selection, or the selected layer, with a slope along its rim"),
        Sphere = "sphere" => ("Sphere", "A ball in the middle of the canvas"),
        Ellipsoid = "ellipsoid" => ("Ellipsoid", "An egg with three axes"),
        Cylinder = "cylinder" => ("Cylinder", "A drum, which can be turned"),
        Cone = "cone" => ("Cone", "A cone, which can be turned"),
        Capsule = "capsule" => ("Capsule", "A cylinder with round ends: a limb"),
        Torus = "torus" => ("Torus", "A ring"),
        Box = "box" => ("Box", "A block with round edges"),
        Lathe = "lathe" => ("Lathe", "What the selected layer covers, turned about its axis: vases, bottles"),
        Sweep = "sweep" => ("Sweep", "A tube along the selected stroke, as wide as the pen pressed: tails, tentacles"),
        Touches = "touches" => ("Touches", "Normals set by hand on the selected part"),
        Sculpt = "sculpt" => ("Sculpt", "Heights sculpted by hand on the selected part"),
        Lines = "lines" => (
            "Lines as form",
            "Ink of the selected layer turns the selected part: folds, creases, chins"
        ),
        Relief = "relief" => (
            "Relief of this layer",
            "Light and dark of the selected layer as detail on the selected part: scales, bark, \
             cloth"
        ),
        Profiles = "profiles" => (
            "Lighting profiles",
            "From two to five selected layers: one drawing shaded by hand in grays, each lit from another side"
        ),
    }
}

impl NewPart {
    /// Why no part was made.
    pub(super) fn why_empty(self) -> PartRefusal {
        match self {
            NewPart::InflateSelection => {
                "The selection covers no pixel fully, so it has no outline."
            }
            NewPart::Touches | NewPart::Sculpt | NewPart::Lines | NewPart::Relief => {
                "The selected part has no form to work on."
            }
            NewPart::Profiles => {
                "The selected layers are black all over, so they say nothing about the light."
            }
            _ => "The layer is empty, so it has no outline: paint on it, or select another.",
        }
    }
}

names!(NewPart);

/// A part as it is first made.
pub fn make_part(kind: NewPart, open: &OpenDocument) -> Result<Part, PartRefusal> {
    let document = open.document();
    let shorter = document.size.width.min(document.size.height) as f32;
    let body = |body| {
        let radius = (0.25 * shorter).round().max(1.0);
        PartKind::Primitive(Primitive::new(body, document.size.center(), radius))
    };
    let made = match kind {
        NewPart::InflateLayer => {
            PartKind::Inflate { outline: of_layer(open)?, inflation: Inflation::default() }
        }
        NewPart::InflateSelection => {
            let outline = of_selection(document)
                .ok_or("Nothing is selected, so there is nothing to puff up.")?;
            PartKind::Inflate { outline, inflation: Inflation::default() }
        }
        NewPart::Bevel => {
            let outline = of_selection(document).map_or_else(|| of_layer(open), Ok)?;
            let side = (0.04 * shorter).round().max(2.0);
            PartKind::Bevel {
                outline,
                bevel: Bevel { width: side, height: side, ..Bevel::default() },
            }
        }
        NewPart::Sphere => body(Body::Sphere),
        NewPart::Ellipsoid => body(Body::Ellipsoid),
        NewPart::Cylinder => body(Body::Cylinder),
        NewPart::Cone => body(Body::Cone),
        NewPart::Capsule => body(Body::Capsule),
        NewPart::Torus => body(Body::Torus),
        NewPart::Box => body(Body::Box),
        NewPart::Lathe => PartKind::Lathe { outline: of_layer(open)?, axis: None, puff: 1.0 },
        NewPart::Sweep => {
            PartKind::Sweep { balls: of_stroke(open).unwrap_or_else(|| tail(document)), puff: 1.0 }
        }
        NewPart::Touches => PartKind::Touches { on: form_of_selected(open)?, touches: Vec::new() },
        NewPart::Sculpt => PartKind::Sculpt { on: form_of_selected(open)?, strokes: Vec::new() },
        NewPart::Lines => PartKind::Lines {
            on: form_of_selected(open)?,
            ink: of_layer(open)?,
            lines: Lines::default(),
        },
        NewPart::Relief => {
            let picture = grays::detail(document, active_layer(open)?)?;
            PartKind::Relief { on: form_of_selected(open)?, picture, detail: Detail::default() }
        }
        NewPart::Profiles => PartKind::Profiles { outline: None, shadings: grays::shadings(open)? },
    };
    let name = match (kind, open.active_layer.and_then(|id| document.layer(id))) {
        (
            NewPart::InflateLayer | NewPart::Lathe | NewPart::Lines | NewPart::Relief,
            Some(layer),
        ) => layer.name.clone(),
        (NewPart::InflateSelection, _) => "Selection".to_owned(),
        _ => kind.label().to_owned(),
    };
    Ok(Part { name: free_name(document, &name), ..Part::new(free_id(document, &[]), made) })
}

/// A part of maps in front of all others, as a step.
pub fn add_maps(open: &mut OpenDocument, maps: PartMaps) {
    let document = open.document();
    let part = Part::new(free_id(document, &[]), PartKind::Maps(maps));
    let part = Part { name: free_name(document, "Maps"), ..part };
    let id = part.id.clone();
    if open.commit("Add part", document.with_part(part)) {
        open.part = Some(id);
    }
}

/// A name that no part has, short enough for a file.
pub fn free_name(document: &Document, base: &str) -> String {
    let base: String = base.chars().take(Part::LONGEST_NAME - 12).collect();
    let taken = |name: &str| document.parts.list.iter().any(|part| part.name == name);
    let numbered = (2..).map(|i| format!("{base} {i}"));
    std::iter::once(base.clone()).chain(numbered).find(|name| !taken(name)).unwrap_or(base)
}

/// The selected part, or the one that it lies on.
fn form_of_selected(open: &OpenDocument) -> Result<String, PartRefusal> {
    let part = open.part.as_deref().and_then(|id| open.document().parts.part(id));
    let part = part.ok_or("No part is selected. Add one first, or give the drawing a shape.")?;
    Ok(part.on().unwrap_or(&part.id).to_owned())
}

const NO_LAYER: PartRefusal = "No layer is selected.";

fn active_layer(open: &OpenDocument) -> Result<LayerId, PartRefusal> {
    open.active_layer.ok_or(NO_LAYER)
}

fn of_layer(open: &OpenDocument) -> Result<OutlineSource, PartRefusal> {
    let document = open.document();
    let layer = document.layer(active_layer(open)?).ok_or(NO_LAYER)?;
    if !layer.content.has_pixels() {
        return Err("This layer has no paint of its own, so it has no outline. Select another.");
    }
    if document.layer_named(&layer.name).is_none_or(|named| named.id != layer.id) {
        return Err(
            "Another layer has the same name. Give this one a different name, so that its part can follow it.",
        );
    }
    Ok(OutlineSource::Layer { layer: layer.name.clone(), color: None })
}

/// The selection as a picture of coverage, under a name that no part's picture has.
fn of_selection(document: &Document) -> Option<OutlineSource> {
    let coverage = Arc::new(document.active_coverage()?.to_plane(document.size.rect()));
    Some(OutlineSource::File(CoverageFile {
        file: grays::free_files(document, "outline").next()?,
        coverage,
    }))
}

/// Balls along the selected or last stroke of the active layer.
fn of_stroke(open: &OpenDocument) -> Option<Vec<Ball>> {
    let strokes = open.document().strokes(open.active_layer?);
    let stroke = match open.selected_strokes().last() {
        Some(&index) => strokes.get(index)?,
        None => strokes.last()?,
    };
    let size = stroke.brush().size;
    let radius = |pressure: f32| (0.5 * size * pressure).max(0.5).min(*Ball::RADIUS.end());
    let mut balls: Vec<Ball> = Vec::new();
    for sample in stroke.samples() {
        let ball = Ball { at: sample.at, radius: radius(sample.pressure) };
        // A fifth of a radius apart, they form one body.
        if balls.last().is_none_or(|last| last.at.distance(ball.at) >= 0.2 * ball.radius) {
            balls.push(ball);
        }
    }
    let step = balls.len().div_ceil(512).max(1);
    Some(balls.into_iter().step_by(step).collect())
}

/// A tapering S in the middle of the canvas.
fn tail(document: &Document) -> Vec<Ball> {
    const BALLS: usize = 24;
    let (middle, shorter) =
        (document.size.center(), document.size.width.min(document.size.height) as f32);
    let ball = |i: usize| {
        let t = i as f32 / (BALLS - 1) as f32;
        let bend = (t * std::f32::consts::TAU).sin();
        let at: Vec2 = middle + shorter * vec2(0.12 * bend, 0.3 - 0.6 * t);
        Ball { at, radius: (shorter * (0.09 - 0.075 * t)).max(0.5) }
    };
    (0..BALLS).map(ball).collect()
}
