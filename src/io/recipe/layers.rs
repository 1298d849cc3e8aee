//! Reads and writes layers: the common fields, and the kinds that need only a line.
//! Floor 5.

use super::LayerReader;
use super::value::RecipeValue;
use super::{
    effects, form_drawings, images, liquify, masks, normals, shading, strokes, transforms,
};
use crate::document::{
    Attachment, Content, Group, InkLayer, Layer, LayerLabel, LayerLock, Live, PixelLayer,
    SelectionList,
};
use crate::json::{Fields, JsonNode, JsonObject, Printer, object};
use crate::math::Size;
use crate::math::srgb::Color;
use crate::paint::{ColorAdjustment, PictureFilter};
use crate::raster::{BlendMode, TileGrid};
use crate::{Error, Result};
use serde_json::Value;
use std::sync::Arc;

/// Whether a layer blends linear light.
const BLEND_SPACES: [(bool, &str); 2] = [(false, "srgb"), (true, "linear")];

/// Reads what a kind of layer has in addition to every layer; the number says how many groups are
/// around it.
type ReadContent = fn(&mut LayerReader<'_>, &mut Fields<'_>, usize) -> Result<Content>;

/// Every kind of layer as it is read, with its name in documents ([`Content::kind_name`]).
const KINDS: [(ReadContent, &str); 14] = [
    (|_, fields, _| Ok(Content::Fill(fields.color("color", Color::BLACK)?)), "fill"),
    (|reader, fields, _| Ok(Content::Pixels(reader.pixels(fields)?)), "pixels"),
    (|reader, fields, _| Ok(Content::Image(Live::new(reader.image(fields)?))), "image"),
    (|reader, fields, _| Ok(Content::Gradient(Live::new(reader.gradient(fields)?))), "gradient"),
    (|reader, fields, _| Ok(Content::Strokes(Live::new(reader.strokes(fields)?))), "strokes"),
    (|reader, fields, _| Ok(Content::FormDrawing(Live::new(reader.form_lines(fields)?))), "lines"),
    (|reader, fields, _| Ok(Content::FormDrawing(Live::new(reader.hatching(fields)?))), "hatching"),
    (|reader, fields, _| Ok(Content::Shading(Live::new(reader.shading(fields)?))), "shading"),
    (
        |_, fields, _| Ok(Content::RadianceScaling(shading::radiance_scaling(fields)?)),
        "radiance-scaling",
    ),
    (
        |_, fields, _| Ok(ColorAdjustment::from_json(&fields.require("adjust")?)?.into()),
        "adjustment",
    ),
    (|_, fields, _| Ok(PictureFilter::from_json(&fields.require("filter")?)?.into()), "filter"),
    (|reader, fields, _| Ok(Content::Normals(reader.normals(fields)?)), "normals"),
    (|_, fields, _| Ok(Content::Ink(InkLayer::of(fields.require("of")?.text()?))), "ink"),
    (|reader, fields, depth| Ok(Content::Group(reader.group(fields, depth)?)), "group"),
];

impl LayerReader<'_> {
    /// A list of layers, bottom first; `depth` is the number of enclosing groups.
    pub fn layers(&mut self, node: &JsonNode, depth: usize) -> Result<Vec<Arc<Layer>>> {
        let items = node.list(self.layers_left)?;
        self.layers_left -= items.len();
        items.iter().map(|item| self.layer(item, depth).map(Arc::new)).collect()
    }

    fn layer(&mut self, node: &JsonNode, depth: usize) -> Result<Layer> {
        let mut fields = node.fields()?;
        let read_content = fields.require("kind")?.one_of(&KINDS)?;
        let name = fields.get("name").map_or(Ok(""), |name| name.text())?.to_owned();
        let visible = fields.boolean("visible", true)?;
        let opacity = fields.number("opacity", 1.0, Layer::OPACITY)?;
        let blend = fields.one_of("blend", &BlendMode::ALL, BlendMode::Normal)?;
        let blend_linear = fields.one_of("blend_space", &BLEND_SPACES, false)?;
        let clip_below = fields.boolean("clip_below", false)?;
        let lock = fields.one_of("lock", &LayerLock::ALL, LayerLock::None)?;
        let label = fields.one_of("label", &LayerLabel::ALL, LayerLabel::None)?;
        let clip_to_surface = fields.boolean("clip_to_surface", true)?;
        let effects = fields.get("effects").map_or(Ok(Vec::new()), |node| effects::read(&node))?;
        let fill_opacity = fields.number("fill_opacity", 1.0, Layer::OPACITY)?;
        let mask = fields.get("mask").map(|mask| self.mask(&mask)).transpose()?;
        let transform = fields
            .get("transform")
            .map(|node| transforms::read(&node, Some(self.size)))
            .transpose()?;
        let warped = fields.get("liquify");
        let liquify = warped.as_ref().map(liquify::read).transpose()?.flatten();
        let on = fields.get("on").map(|node| self.attachment(&node)).transpose()?;
        let content = read_content(self, &mut fields, depth)?;
        fields.finish()?;
        let layer = Layer::new(name, content);
        let is_warped =
            liquify.is_some() || transform.as_ref().is_some_and(|own| own.mesh().is_some());
        if is_warped && !layer.content.can_be_warped() {
            let why = "shows nothing of its own, so a mesh or liquify cannot displace it";
            return Err(warped.as_ref().unwrap_or(node).refusal(why));
        }
        let layer = Layer { visible, opacity, blend, blend_linear, clip_below, lock, ..layer };
        let effects = Arc::new(effects);
        let layer = Layer { effects, fill_opacity, ..layer };
        Ok(Layer { label, mask, clip_to_surface, transform, liquify, on, ..layer })
    }

    /// The attachment of a layer or a stroke.
    pub fn attachment(&self, node: &JsonNode) -> Result<Attachment> {
        let id = node.text()?;
        if id != Attachment::CANVAS && !self.attachments.iter().any(|known| known == id) {
            return Err(node.refusal(format!("is “{id}”; there is no part with that id")));
        }
        Ok(Attachment::on(id))
    }

    fn pixels(&mut self, fields: &mut Fields) -> Result<PixelLayer> {
        let mut offset =
            |name| fields.get(name).map_or(Ok(0), |node| node.integer(-1_000_000..=1_000_000));
        let (x, y) = (offset("x")? as i32, offset("y")? as i32);
        let Some(node) = fields.get("file") else {
            return Ok(PixelLayer { file: String::new(), x, y, tiles: TileGrid::default() });
        };
        let (file, tiles) = self.pictures.tiles(self.source, &node, x, y)?;
        Ok(PixelLayer { file, x, y, tiles })
    }

    fn group(&mut self, fields: &mut Fields, depth: usize) -> Result<Group> {
        let deepest = self.source.budget.group_depth;
        if depth >= deepest {
            let reason =
                format!("{} is nested in more than {deepest} groups", fields.node().path());
            return Err(Error::too_large(self.source.file, reason));
        }
        let pass_through = fields.boolean("pass_through", false)?;
        let layers =
            fields.get("layers").map_or(Ok(Vec::new()), |node| self.layers(&node, depth + 1))?;
        Ok(Group { layers, pass_through })
    }
}

/// Layers as JSON; `canvas` determines the default placements.
pub fn write(layers: &[Arc<Layer>], canvas: Size, list: &SelectionList) -> Value {
    let one = |layer: &Arc<Layer>| {
        let mut out = bare(layer, canvas);
        match &layer.content {
            Content::Group(group) => out.set("layers", write(&group.layers, canvas, list)),
            Content::Strokes(live) => {
                out.set("strokes", strokes::write_strokes(live.params(), list).collect())
            }
            _ => {}
        }
        out.into_value()
    };
    layers.iter().map(one).collect()
}

/// The same as text, a stroke at a time.
pub fn print(layers: &[Arc<Layer>], canvas: Size, list: &SelectionList, out: &mut Printer) {
    out.open_list(Some("layers"));
    for layer in layers {
        out.open_object(None);
        bare(layer, canvas).fields().iter().for_each(|(key, value)| out.value(Some(key), value));
        match &layer.content {
            Content::Group(group) => print(&group.layers, canvas, list, out),
            Content::Strokes(live) => {
                out.open_list(Some("strokes"));
                strokes::write_strokes(live.params(), list)
                    .for_each(|stroke| out.value(None, &stroke));
                out.close_list();
            }
            _ => {}
        }
        out.close_object();
    }
    out.close_list();
}

/// A layer without what it holds in lists: strokes, or layers of a group.
fn bare(layer: &Layer, canvas: Size) -> JsonObject {
    let mut out = JsonObject::default();
    out.text("name", &layer.name, "");
    out.set("kind", layer.content.kind_name().into());
    out.flag("visible", layer.visible, true);
    out.number("opacity", layer.opacity, 1.0);
    out.word("blend", &BlendMode::ALL, layer.blend, BlendMode::Normal);
    out.word("blend_space", &BLEND_SPACES, layer.blend_linear, false);
    out.flag("clip_below", layer.clip_below, false);
    out.word("lock", &LayerLock::ALL, layer.lock, LayerLock::None);
    out.word("label", &LayerLabel::ALL, layer.label, LayerLabel::None);
    out.flag("clip_to_surface", layer.clip_to_surface, true);
    effects::write(&mut out, layer);
    if let Some(mask) = &layer.mask {
        out.set("mask", masks::write(mask));
    }
    out.set_some("transform", layer.transform.as_ref(), transforms::write);
    out.set_some("liquify", layer.liquify.as_deref(), liquify::write);
    out.set_some("on", layer.on.as_ref(), |attachment| (*attachment.part).into());
    write_content(&mut out, &layer.content, canvas);
    out
}

fn write_content(out: &mut JsonObject, content: &Content, canvas: Size) {
    match content {
        Content::Fill(color) => out.set("color", object::color(*color)),
        Content::Pixels(pixels) => {
            out.text("file", &pixels.file, "");
            out.number("x", pixels.x as f32, 0.0);
            out.number("y", pixels.y as f32, 0.0);
        }
        Content::Image(live) => images::write_image(out, live.params(), canvas),
        Content::Gradient(live) => images::write_gradient(out, live.params()),
        Content::Strokes(_) => {}
        Content::FormDrawing(live) => form_drawings::write(out, live.params()),
        Content::Shading(live) => shading::write(out, live.params()),
        Content::RadianceScaling(scaling) => shading::write_radiance_scaling(out, scaling),
        Content::Adjustment(live) => out.set("adjust", live.params().to_json()),
        Content::Filter(live) => out.set("filter", live.params().to_json()),
        Content::Normals(layer) => normals::write(out, layer, canvas),
        Content::Ink(lines) => out.set("of", lines.of.as_str().into()),
        Content::Group(group) => out.flag("pass_through", group.pass_through, false),
    }
}
