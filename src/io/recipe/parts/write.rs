//! Writes the parts of a shape. Floor 5. Defaults are left out; those that are in no type come from
//! the reader.

use super::super::selections::id_of_kept;
use super::super::{samples, surface};
use super::{BODY_RADIUS, DAB_HARDNESS, DAB_SIZE, DAB_STRENGTH, TOUCH_RADIUS};
use crate::document::parts::{Inflation, OutlineSource, Part, PartKind, PartMaps, ProfilePicture};
use crate::document::{Document, SelectionList, SurfaceSource};
use crate::json::{JsonObject, object};
use crate::math::{Affine2, Size, Vec2};
use crate::shape::{
    Ball, Bevel, BevelCurve, Body, Combine, Detail, LineForm, Lines, Primitive, SculptStroke,
    SculptTool, Touch,
};
use serde_json::{Value, json};
use std::sync::Arc;

/// The list of a document's parts as JSON; `list`: what selections are called.
pub fn write(document: &Document, list: &SelectionList) -> Value {
    let one =
        |part: &Arc<Part>| write_fitted(part, Some(document.size), |name| id_of_kept(name, list));
    document.parts.list.iter().map(one).collect()
}

/// One part as an edit describes it: as in the list, but with selections by name, and whatever the
/// canvas.
pub fn write_part(part: &Part) -> Value {
    write_fitted(part, None, |name| Some(name.to_owned()))
}

/// `canvas`: the frame of maps that need not be named.
fn write_fitted(
    part: &Part,
    canvas: Option<Size>,
    selection: impl Fn(&str) -> Option<String>,
) -> Value {
    let mut out = JsonObject::default();
    out.set("id", part.id.as_str().into());
    out.text("name", &part.name, &part.id);
    out.set("kind", part.kind.name().into());
    out.flag("visible", part.visible, true);
    out.text("combine", part.combine.name(), Combine::Over.name());
    if let Combine::Union { smooth } = part.combine {
        out.number("smooth", smooth, Combine::DEFAULT_SMOOTH);
    }
    if let Some(outline) = part.outline() {
        out.set("outline", write_outline(outline, selection));
    }
    write_kind(&mut out, &part.kind, canvas);
    if part.tilt_deg != Vec2::ZERO {
        out.set("tilt", object::point(part.tilt_deg));
    }
    out.number("raise", part.raise, 0.0);
    if part.matrix != Affine2::IDENTITY {
        out.set("matrix", part.matrix.to_cols_array().into_iter().map(object::number).collect());
    }
    out.into_value()
}

fn write_outline(outline: &OutlineSource, selection: impl Fn(&str) -> Option<String>) -> Value {
    let mut out = JsonObject::default();
    match outline {
        OutlineSource::Layer { layer, color } => {
            out.set("layer", layer.as_str().into());
            out.set_some("color", color.map(|flat| flat.color), object::color);
            out.set_some("at", color.and_then(|flat| flat.at), object::point);
        }
        OutlineSource::File(file) => out.set("file", file.file.as_str().into()),
        OutlineSource::Path(points) => {
            out.set("path", points.iter().copied().map(object::point).collect())
        }
        OutlineSource::Selection(name) => out.set_some("selection", selection(name), Value::from),
        OutlineSource::Object(object) => out.set("object", (*object).into()),
    }
    out.into_value()
}

fn write_kind(out: &mut JsonObject, kind: &PartKind, canvas: Option<Size>) {
    match kind {
        PartKind::Inflate { inflation, .. } => {
            let plain = Inflation::default();
            out.number("puff", inflation.puff, plain.puff);
            out.number("profile", inflation.profile, plain.profile);
            out.number("rim", inflation.rim_deg, plain.rim_deg);
        }
        PartKind::Bevel { bevel, .. } => {
            let plain = Bevel::default();
            out.number("width", bevel.width, plain.width);
            out.number("height", bevel.height, plain.height);
            match &bevel.curve {
                BevelCurve::Points(points) => {
                    out.set("curve", points.iter().copied().map(object::point).collect())
                }
                named => {
                    let name = BevelCurve::NAMED
                        .iter()
                        .find(|(curve, _)| curve == named)
                        .map_or("round", |(_, n)| n);
                    out.text("curve", name, "round");
                }
            }
        }
        PartKind::Primitive(body) => write_primitive(out, body),
        PartKind::Lathe { axis, puff, .. } => {
            out.set_some("axis", *axis, |axis| axis.into_iter().map(object::point).collect());
            out.number("puff", *puff, 1.0);
        }
        PartKind::Sweep { balls, puff } => {
            let ball = |b: &Ball| {
                [b.at.x, b.at.y, b.radius].into_iter().map(object::number).collect::<Value>()
            };
            out.set("balls", balls.iter().map(ball).collect());
            out.number("puff", *puff, 1.0);
        }
        PartKind::Touches { on, touches } => {
            out.set("on", on.as_str().into());
            let touch = |touch: &Touch| {
                let mut out = JsonObject::default();
                out.set("at", object::point(touch.at));
                out.number("radius", touch.radius, TOUCH_RADIUS);
                out.set("normal", object::vector(touch.normal));
                out.number("reach", touch.reach, 0.0);
                out.into_value()
            };
            out.set("touches", touches.iter().map(touch).collect());
        }
        PartKind::Sculpt { on, strokes } => {
            out.set("on", on.as_str().into());
            out.set("strokes", strokes.iter().map(write_stroke).collect());
        }
        PartKind::Lines { on, lines, .. } => {
            let plain = Lines::default();
            out.set("on", on.as_str().into());
            out.word("form", &LineForm::ALL, lines.form, plain.form);
            out.number("angle", lines.angle_deg, plain.angle_deg);
            out.number("reach", lines.reach, plain.reach);
        }
        PartKind::Profiles { shadings, .. } => {
            let shading = |shading: &ProfilePicture| {
                let light = object::vector(shading.light);
                json!({ "file": shading.picture.file, "light": light })
            };
            out.set("pictures", shadings.iter().map(shading).collect());
        }
        PartKind::Maps(maps) => write_maps(out, maps, canvas),
        PartKind::Relief { on, picture, detail } => {
            let plain = Detail::default();
            out.set("on", on.as_str().into());
            out.set("file", picture.file.as_str().into());
            out.number("coarse", detail.coarse, plain.coarse);
            out.number("fine", detail.fine, plain.fine);
            out.number("radius", detail.radius, plain.radius);
            out.number("edge", detail.edge, plain.edge);
        }
    }
}

/// The maps, and their frame unless they are fitted to the canvas.
pub fn write_maps(out: &mut JsonObject, maps: &PartMaps, canvas: Option<Size>) {
    // The matrix of a part is another.
    let bare = SurfaceSource { matrix: None, ..SurfaceSource::clone(&maps.source) };
    surface::write(&bare).fields().iter().for_each(|(name, value)| out.set(name, value.clone()));
    let size = maps.surface.size();
    if maps.source.matrix.is_some() || canvas != Some(size) {
        let mut frame = JsonObject::default();
        frame.set("width", size.width.into());
        frame.set("height", size.height.into());
        frame.set_some("matrix", maps.source.matrix, |matrix| json!(matrix));
        out.set("frame", frame.into_value());
    }
}

fn write_stroke(stroke: &SculptStroke) -> Value {
    let mut out = JsonObject::default();
    out.word("tool", &SculptTool::ALL, stroke.tool, SculptTool::default());
    out.number("size", stroke.size, DAB_SIZE);
    out.number("hardness", stroke.hardness, DAB_HARDNESS);
    out.number("strength", stroke.strength, DAB_STRENGTH);
    out.set("samples", samples::write_pressed(&stroke.samples));
    out.into_value()
}

fn write_primitive(out: &mut JsonObject, body: &Primitive) {
    let name =
        Body::ALL.iter().find(|(known, _)| *known == body.body).map_or("sphere", |(_, name)| name);
    out.set("shape", name.into());
    out.set("center", object::point(body.center));
    let plain = Primitive::new(body.body, body.center, body.radius);
    out.number("radius", body.radius, BODY_RADIUS);
    if body.half != plain.half {
        out.set("half", object::vector(body.half));
    }
    out.number("length", body.length, plain.length);
    out.number("tube", body.tube, plain.tube);
    out.number("round", body.round, plain.round);
    if body.turn_deg != plain.turn_deg {
        out.set("turn", object::vector(body.turn_deg));
    }
}
