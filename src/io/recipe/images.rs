//! Reads and writes placed images and gradients, and the fields they share with others: operator,
//! anchors, placement, source. Floor 5.

use super::LayerReader;
use super::value::RecipeValue;
use crate::json::{Fields, JsonNode, JsonObject, object};
use crate::math::range::STOPS;
use crate::math::{Size, TURNS, UNIT, Vec2, srgb::Color, vec2};
use crate::paint::{
    Adjust, Gradient, GradientStop, ImageFilter, PictureOrigin, PictureSource, PlacedImage,
    Placement, RampStyle, Text,
};
use crate::raster::Outside;
use crate::surface::plane_piece::PlanePiece;
use crate::surface::{Anchor, Bend, Operator, Weights};
use crate::{Error, Result};
use serde_json::Value;
use std::sync::Arc;

impl LayerReader<'_> {
    pub fn image(&mut self, fields: &mut Fields) -> Result<PlacedImage> {
        let source = self.picture_source(&fields.require("source")?)?;
        let by_itself = source.default_placement(self.size);
        let placement =
            fields.get("placement").map_or(Ok(by_itself), |node| placement(&node, by_itself))?;
        let outside = fields.one_of("outside", &Outside::ALL, source.default_outside())?;
        Ok(PlacedImage {
            source,
            placement,
            outside,
            bend: self.bend(fields, placement.center)?,
            filter: fields.one_of("filter", &ImageFilter::ALL, ImageFilter::Antialias)?,
            frame: Default::default(),
        })
    }

    /// By default from the middle of the left side to the middle of the right one, black to white.
    pub fn gradient(&mut self, fields: &mut Fields) -> Result<Gradient> {
        let (w, h) = (self.size.width as f32, self.size.height as f32);
        let black_to_white = || {
            vec![
                GradientStop { t: 0.0, color: Color::BLACK },
                GradientStop { t: 1.0, color: Color::WHITE },
            ]
        };
        Ok(Gradient {
            from: fields.point("from", vec2(0.0, h / 2.0))?,
            to: fields.point("to", vec2(w, h / 2.0))?,
            stops: fields.get("stops").map_or_else(|| Ok(black_to_white()), |node| stops(&node))?,
            operator: operator(fields)?.unwrap_or_default(),
            filter: fields.one_of("filter", &ImageFilter::ALL, ImageFilter::Antialias)?,
            frame: Default::default(),
            style: fields.one_of("style", &RampStyle::ALL, RampStyle::default())?,
            pieces: pieces(fields)?,
        })
    }

    /// Operator, anchors and weights. An operator without a list of anchors is pinned at `center`;
    /// an empty list pins nothing.
    fn bend(&self, fields: &mut Fields, center: Vec2) -> Result<Bend> {
        let operator = operator(fields)?.unwrap_or_default();
        let anchors = match fields.get("anchors") {
            Some(node) => node
                .list(self.source.budget.anchors)?
                .iter()
                .map(Anchor::from_json)
                .collect::<Result<_>>()?,
            None => default_anchors(operator, center),
        };
        let weights =
            fields.get("weights").map_or(Ok(Weights::default()), |node| weights(&node))?;
        Ok(Bend { operator, anchors, weights, pieces: pieces(fields)? })
    }

    pub fn placement(&self, fields: &mut Fields) -> Result<Placement> {
        let covering = Placement::covering(self.size);
        fields.get("placement").map_or(Ok(covering), |node| placement(&node, covering))
    }

    /// A path, a picture of a file, or a text, whose outlines are in a file if it was laid out before.
    pub fn picture_source(&mut self, node: &JsonNode) -> Result<PictureSource> {
        let mut fields = node.fields()?;
        if let Some(path) = fields.get("path") {
            let adjust = adjust(&mut fields)?;
            fields.finish()?;
            return self.pictures.path(self.source, &path, adjust);
        }
        let text = fields.get("text");
        let text = text.map(|node| Ok::<_, Error>((Text::from_json(&node)?, node))).transpose()?;
        let file = match &text {
            Some(_) => fields.get("file"),
            None => Some(fields.require("file")?),
        };
        let adjust = adjust(&mut fields)?;
        fields.finish()?;
        match (file, text) {
            (Some(file), text) => {
                let mut source = self.pictures.source(self.source, &file, adjust)?;
                if let Some((text, _)) = text {
                    source.origin = PictureOrigin::Text(Arc::new(text));
                }
                Ok(source)
            }
            (None, Some((text, node))) => self.pictures.text(self.source, &node, &text, adjust),
            (None, None) => Err(node.refusal("needs a “file”, a “text” or a “path”")),
        }
    }
}

/// The default anchor of an image: its center, if it bends at all.
pub fn default_anchors(operator: Operator, center: Vec2) -> Vec<Anchor> {
    match operator {
        Operator::None => Vec::new(),
        _ => vec![Anchor::pin(center)],
    }
}

/// The field `pieces`; none by default.
fn pieces(fields: &mut Fields) -> Result<Vec<PlanePiece>> {
    let read =
        |node: JsonNode| node.list(PlanePiece::MOST)?.iter().map(RecipeValue::from_json).collect();
    fields.get("pieces").map_or(Ok(Vec::new()), read)
}

/// The field `operator`, if present.
pub fn operator(fields: &mut Fields) -> Result<Option<Operator>> {
    fields.get("operator").map(|node| Operator::from_json(&node)).transpose()
}

/// A kind with its numbers.
impl RecipeValue for Operator {
    fn to_json(&self) -> Value {
        let mut out = write_operator(*self);
        if *self == Operator::None {
            out.set("kind", self.row().1.into());
        }
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        let mut fields = node.fields()?;
        let operator = fields.one_of("kind", &Operator::KINDS, Operator::None)?;
        let operator = operator
            .try_map(|number, default| fields.number(number.key, default, number.range.clone()))?;
        fields.finish()?;
        Ok(operator)
    }
}

/// `{ "at": [x, y], "source": [x, y] }`.
impl RecipeValue for Anchor {
    fn to_json(&self) -> Value {
        let mut out = JsonObject::default();
        out.set("at", object::point(self.at));
        if self.source != self.at {
            out.set("source", object::point(self.source));
        }
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        let mut fields = node.fields()?;
        let at = fields.require("at")?.point()?;
        let source = fields.point("source", at)?;
        fields.finish()?;
        Ok(Anchor { at, source })
    }
}

/// `{ "at": [x, y], "move": [x, y], "scale": 1, "rotation": 0 }`.
impl RecipeValue for PlanePiece {
    fn to_json(&self) -> Value {
        let (mut out, still) = (JsonObject::default(), PlanePiece::at(self.at));
        out.set("at", object::point(self.at));
        if self.moved != still.moved {
            out.set("move", object::point(self.moved));
        }
        out.number("scale", self.scale, still.scale);
        out.number("rotation", self.rotation, still.rotation);
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        let mut fields = node.fields()?;
        let still = PlanePiece::at(fields.require("at")?.point()?);
        let piece = PlanePiece {
            moved: fields.point("move", still.moved)?,
            scale: fields.number("scale", still.scale, PlanePiece::SCALE)?,
            rotation: fields.number("rotation", still.rotation, PlanePiece::ROTATION)?,
            ..still
        };
        fields.finish()?;
        Ok(piece)
    }
}

/// `[t, "#rrggbb"]`.
impl RecipeValue for GradientStop {
    fn to_json(&self) -> Value {
        Value::Array(vec![object::number(self.t), object::color(self.color)])
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        let [t, color] = &node.list(2)?[..] else {
            return Err(node.refusal("must be [t, color]"));
        };
        Ok(GradientStop { t: t.number(UNIT)?, color: color.color()? })
    }
}

/// The placement alone; a document omits one that covers the canvas.
impl RecipeValue for Placement {
    fn to_json(&self) -> Value {
        let mut out = write_placement_beside(self, &place_unscaled(self.center));
        out.set("center", object::point(self.center));
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        let center = node.fields()?.require("center")?.point()?;
        placement(node, place_unscaled(center))
    }
}

impl RecipeValue for Adjust {
    fn to_json(&self) -> Value {
        let mut out = JsonObject::default();
        write_adjust(&mut out, self);
        out.into_value()
    }

    fn from_json(node: &JsonNode) -> Result<Self> {
        let mut fields = node.fields()?;
        let adjust = adjust(&mut fields)?;
        fields.finish()?;
        Ok(adjust)
    }
}

fn adjust(fields: &mut Fields) -> Result<Adjust> {
    let plain = Adjust::default();
    Ok(Adjust {
        blur: fields.number("blur", plain.blur, Adjust::BLUR)?,
        exposure: fields.number("exposure", plain.exposure, STOPS)?,
        hue: fields.number("hue", plain.hue, TURNS)?,
        saturation: fields.number("saturation", plain.saturation, Adjust::FACTOR)?,
        brightness: fields.number("brightness", plain.brightness, Adjust::FACTOR)?,
        contrast: fields.number("contrast", plain.contrast, Adjust::FACTOR)?,
    })
}

/// * `base`: what it leaves unsaid.
fn placement(node: &JsonNode, base: Placement) -> Result<Placement> {
    let mut fields = node.fields()?;
    let placement = Placement {
        center: fields.point("center", base.center)?,
        scale: fields.number("scale", base.scale, Placement::SCALE)?,
        rotation: fields.number("rotation", base.rotation, TURNS)?,
    };
    fields.finish()?;
    Ok(placement)
}

fn place_unscaled(center: Vec2) -> Placement {
    Placement { center, scale: 1.0, rotation: 0.0 }
}

fn weights(node: &JsonNode) -> Result<Weights> {
    let mut fields = node.fields()?;
    let power = fields.number("power", 2.0, Weights::POWER)?;
    fields.finish()?;
    Ok(Weights::Shepard { power })
}

/// The stops of a ramp, each at or above the one before.
pub fn stops(node: &JsonNode) -> Result<Vec<GradientStop>> {
    let items = node.list(Gradient::MOST_STOPS)?;
    if items.is_empty() {
        return Err(node.refusal("is empty; a gradient needs at least one stop"));
    }
    let mut stops: Vec<GradientStop> = Vec::with_capacity(items.len());
    for item in &items {
        let stop = GradientStop::from_json(item)?;
        if stops.last().is_some_and(|before| before.t > stop.t) {
            return Err(
                item.list(2)?[0].refusal("is less than the stop before it; stops go from 0 to 1")
            );
        }
        stops.push(stop);
    }
    Ok(stops)
}

pub fn write_image(out: &mut JsonObject, image: &PlacedImage, canvas: Size) {
    out.set("source", write_source(&image.source));
    let by_itself = image.source.default_placement(canvas);
    out.object("placement", write_placement_beside(&image.placement, &by_itself));
    out.word("outside", &Outside::ALL, image.outside, image.source.default_outside());
    write_bend(out, &image.bend, image.placement.center);
    out.word("filter", &ImageFilter::ALL, image.filter, ImageFilter::Antialias);
}

pub fn write_gradient(out: &mut JsonObject, gradient: &Gradient) {
    out.set("from", object::point(gradient.from));
    out.set("to", object::point(gradient.to));
    out.word("style", &RampStyle::ALL, gradient.style, RampStyle::default());
    out.set("stops", gradient.stops.iter().map(GradientStop::to_json).collect());
    out.object("operator", write_operator(gradient.operator));
    write_pieces(out, &gradient.pieces);
    out.word("filter", &ImageFilter::ALL, gradient.filter, ImageFilter::Antialias);
}

fn write_bend(out: &mut JsonObject, bend: &Bend, center: Vec2) {
    out.object("operator", write_operator(bend.operator));
    if bend.anchors != default_anchors(bend.operator, center) {
        out.set("anchors", bend.anchors.iter().map(Anchor::to_json).collect());
    }
    write_pieces(out, &bend.pieces);
    if let Weights::Shepard { power } = bend.weights {
        let mut weights = JsonObject::default();
        weights.number("power", power, 2.0);
        out.object("weights", weights);
    }
}

fn write_pieces(out: &mut JsonObject, pieces: &[PlanePiece]) {
    if !pieces.is_empty() {
        out.set("pieces", pieces.iter().map(PlanePiece::to_json).collect());
    }
}

/// Empty for the operator that does nothing.
pub fn write_operator(operator: Operator) -> JsonObject {
    let mut out = JsonObject::default();
    if operator == Operator::None {
        return out;
    }
    let (plain, name) = operator.row();
    out.set("kind", name.into());
    for ((number, value), (_, default)) in operator.numbers().into_iter().zip(plain.numbers()) {
        out.number(number.key, value, default);
    }
    out
}

/// Empty for the placement that covers the canvas.
pub fn write_placement(placement: &Placement, canvas: Size) -> JsonObject {
    write_placement_beside(placement, &Placement::covering(canvas))
}

fn write_placement_beside(placement: &Placement, base: &Placement) -> JsonObject {
    let mut out = JsonObject::default();
    if placement.center != base.center {
        out.set("center", object::point(placement.center));
    }
    out.number("scale", placement.scale, base.scale);
    out.number("rotation", placement.rotation, base.rotation);
    out
}

pub fn write_source(source: &PictureSource) -> Value {
    let mut out = JsonObject::default();
    match &source.origin {
        PictureOrigin::Path(path) => out.set("path", path.to_json()),
        _ => out.set("file", source.file.as_str().into()),
    }
    out.set_some("text", source.text(), |text| text.to_json());
    write_adjust(&mut out, &source.adjust);
    out.into_value()
}

fn write_adjust(out: &mut JsonObject, adjust: &Adjust) {
    let plain = Adjust::default();
    let Adjust { blur, exposure, hue, saturation, brightness, contrast } = *adjust;
    out.number("blur", blur, plain.blur);
    out.number("exposure", exposure, plain.exposure);
    out.number("hue", hue, plain.hue);
    out.number("saturation", saturation, plain.saturation);
    out.number("brightness", brightness, plain.brightness);
    out.number("contrast", contrast, plain.contrast);
}
