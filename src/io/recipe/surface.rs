//! Reads and writes the surface: its maps and what their numbers mean. Floor 5. `io::maps` detects
//! what is not given.

use super::transforms;
use crate::Result;
use crate::document::source::{
    DepthConvention, DepthEncoding, MapSource, MaskSource, Near, NormalConvention, NormalEncoding,
    NormalSpace, SurfaceSource,
};
use crate::files;
use crate::json::{Fields, JsonNode, JsonObject, object};
use serde_json::{Value, json};

/// Stored values that mean "no surface".
const MOST_BACKGROUNDS: usize = 64;

/// Reads the maps of the object `surface`; none if it has parts and no maps.
pub fn read(node: &JsonNode) -> Result<Option<SurfaceSource>> {
    let mut fields = node.fields()?;
    let matrix = fields.get("matrix").map(|node| matrix(&node)).transpose()?;
    let source = SurfaceSource { matrix, ..maps_of(&mut fields)? };
    // They are read once the canvas is known.
    let has_parts = fields.get("parts").is_some();
    fields.finish()?;
    if source.normal.is_none() && source.depth.is_none() {
        if has_parts && source.mask.is_none() && source.matrix.is_none() {
            return Ok(None);
        }
        return Err(node.refusal("names neither a normal map nor a depth map"));
    }
    Ok(Some(source))
}

/// The maps alone, of the surface or of a part.
pub fn maps_of(fields: &mut Fields) -> Result<SurfaceSource> {
    Ok(SurfaceSource {
        normal: fields.get("normal").map(|node| normal(&node)).transpose()?,
        depth: fields.get("depth").map(|node| depth(&node)).transpose()?,
        mask: fields.get("mask").map(|node| mask(&node)).transpose()?,
        matrix: None,
    })
}

/// The matrix of maps.
pub fn matrix(node: &JsonNode) -> Result<[f64; 6]> {
    let matrix = transforms::matrix_of(node)?;
    let source = SurfaceSource { matrix: Some(matrix), ..SurfaceSource::default() };
    source.fits().map(|()| matrix).map_err(|why| node.refusal(why))
}

fn normal(node: &JsonNode) -> Result<MapSource<NormalConvention>> {
    let mut fields = node.fields()?;
    let map = MapSource {
        file: file(&mut fields)?,
        channel: channel(&mut fields)?,
        convention: fields
            .get("convention")
            .map_or(Ok(NormalConvention::default()), |c| normal_convention(&c))?,
    };
    fields.finish()?;
    Ok(map)
}

/// A word, or an object with each choice that is not to be detected.
pub fn normal_convention(node: &JsonNode) -> Result<NormalConvention> {
    if node.value().is_string() {
        let words = NormalConvention::WORDS.map(|word| (word, word));
        return Ok(NormalConvention::from_word(node.one_of(&words)?).unwrap_or_default());
    }
    let mut fields = node.fields()?;
    let mut flag = |name| fields.get(name).map(|node| node.boolean()).transpose();
    let convention = NormalConvention {
        srgb: flag("srgb")?,
        flip_x: flag("flip_x")?,
        flip_y: flag("flip_y")?,
        flip_z: flag("flip_z")?,
        snap_flat: flag("snap_flat")?,
        smooth_steps: flag("smooth_steps")?,
        encoding: fields
            .get("encoding")
            .map(|node| node.one_of(&NormalEncoding::ALL))
            .transpose()?,
        channels: fields.get("channels").map(|node| channels(&node)).transpose()?,
        space: fields.get("space").map(|node| node.one_of(&NormalSpace::ALL)).transpose()?,
        world_to_camera: fields.get("world_to_camera").map(|node| rotation(&node)).transpose()?,
    };
    fields.finish()?;
    Ok(convention)
}

fn channels(node: &JsonNode) -> Result<[u8; 3]> {
    let letters = node.text()?;
    let read = NormalConvention::channels_from_letters(letters);
    read.ok_or_else(|| {
        node.refusal(format!("is “{letters}”; it must be three different letters of rgba"))
    })
}

/// The upper left 3 × 3 of a matrix of three or four rows. Its translation moves no normal.
fn rotation(node: &JsonNode) -> Result<[[f32; 3]; 3]> {
    let rows = node.list(4)?;
    if rows.len() < 3 {
        return Err(node.refusal(format!("has {} rows; it must have 3 or 4", rows.len())));
    }
    let mut rotation = [[0.0; 3]; 3];
    for (row, into) in rows.iter().zip(&mut rotation) {
        into.copy_from_slice(&row.numbers(rows.len(), rows.len(), -1e6..=1e6)?[..3]);
    }
    Ok(rotation)
}

fn depth(node: &JsonNode) -> Result<MapSource<DepthConvention>> {
    let mut fields = node.fields()?;
    let file = file(&mut fields)?;
    let channel = channel(&mut fields)?;
    let plain = DepthConvention::default();
    let convention = DepthConvention {
        near: fields.one_of("near", &Near::ALL, plain.near)?,
        encoding: fields
            .get("encoding")
            .map(|node| node.one_of(&DepthEncoding::ALL))
            .transpose()?,
        fov_degrees: fields.get("fov").map(|node| node.number(1.0..=179.0)).transpose()?,
        background: match fields.get("background") {
            Some(node) => node.numbers(0, MOST_BACKGROUNDS, f32::MIN..=f32::MAX)?,
            None => plain.background,
        },
        range_px: fields.get("range_px").map(|node| node.number(1e-3..=1e6)).transpose()?,
        smooth_steps: fields.get("smooth_steps").map(|node| node.boolean()).transpose()?,
    };
    fields.finish()?;
    Ok(MapSource { file, channel, convention })
}

fn mask(node: &JsonNode) -> Result<MaskSource> {
    let mut fields = node.fields()?;
    let mask = match fields.get("from") {
        Some(from) => from.one_of(&[((), "flat")]).map(|()| MaskSource::Flat)?,
        None => MaskSource::File {
            file: file(&mut fields)?,
            channel: channel(&mut fields)?,
            invert: fields.boolean("invert", false)?,
        },
    };
    fields.finish()?;
    Ok(mask)
}

fn file(fields: &mut Fields) -> Result<String> {
    let node = fields.require("file")?;
    let name = node.text()?;
    match files::refusal(name) {
        Some(reason) => Err(node.refusal(format!("“{name}” is refused: {reason}"))),
        None => Ok(name.to_owned()),
    }
}

fn channel(fields: &mut Fields) -> Result<Option<String>> {
    fields.get("channel").map(|node| node.text().map(str::to_owned)).transpose()
}

/// The fields of the object `surface` that are maps.
pub fn write(source: &SurfaceSource) -> JsonObject {
    let mut out = JsonObject::default();
    if let Some(normal) = &source.normal {
        let mut map = start(&normal.file, normal.channel.as_deref());
        write_normal_convention(&mut map, &normal.convention);
        out.object("normal", map);
    }
    if let Some(depth) = &source.depth {
        let mut map = start(&depth.file, depth.channel.as_deref());
        write_depth_convention(&mut map, &depth.convention);
        out.object("depth", map);
    }
    match &source.mask {
        None => {}
        Some(MaskSource::Flat) => out.set("mask", json!({ "from": "flat" })),
        Some(MaskSource::File { file, channel, invert }) => {
            let mut map = start(file, channel.as_deref());
            map.flag("invert", *invert, false);
            out.object("mask", map);
        }
    }
    out.set_some("matrix", source.matrix, |matrix| json!(matrix));
    out
}

fn start(file: &str, channel: Option<&str>) -> JsonObject {
    let mut out = JsonObject::default();
    out.set("file", file.into());
    out.set_some("channel", channel, Value::from);
    out
}

/// The field `convention`: one word for all, or each choice that was made.
pub fn write_normal_convention(into: &mut JsonObject, c: &NormalConvention) {
    if let Some(word) = c.word() {
        return into.text("convention", word, "auto");
    }
    let mut out = JsonObject::default();
    out.set_some("encoding", c.encoding, |e| e.name().into());
    out.set_some("channels", c.channels, |c| NormalConvention::letters(c).into());
    for (name, flag) in
        [("srgb", c.srgb), ("flip_x", c.flip_x), ("flip_y", c.flip_y), ("flip_z", c.flip_z)]
    {
        out.set_some(name, flag, Value::from);
    }
    out.set_some("space", c.space, |s| s.name().into());
    let row = |row: [f32; 3]| row.into_iter().map(object::number).collect::<Value>();
    out.set_some("world_to_camera", c.world_to_camera, |rows| rows.into_iter().map(row).collect());
    out.set_some("snap_flat", c.snap_flat, Value::from);
    out.set_some("smooth_steps", c.smooth_steps, Value::from);
    into.object("convention", out);
}

fn write_depth_convention(out: &mut JsonObject, convention: &DepthConvention) {
    out.word("near", &Near::ALL, convention.near, Near::Auto);
    out.set_some("encoding", convention.encoding, |e| e.name().into());
    out.set_some("fov", convention.fov_degrees, object::number);
    if !convention.background.is_empty() {
        out.set("background", convention.background.iter().copied().map(object::number).collect());
    }
    out.set_some("range_px", convention.range_px, object::number);
    out.set_some("smooth_steps", convention.smooth_steps, Value::from);
}
