//! A brush's tip, its grain and its second tip. Read and written.
//! Floor 5. Not here: the numbers of a brush (`brush`).

use super::dynamics;
use super::light::{of_object, settings, write_settings};
use crate::Result;
use crate::json::{Fields, JsonNode, JsonObject, object};
use crate::math::{TURNS, UNIT};
use crate::paint::grain::{BrushGrain, GrainSource, GrainSpace};
use crate::paint::pattern::Pattern;
use crate::paint::tip::{Bristles, Hose, HoseRank, Noise, RankSelect};
use crate::paint::{Brush, DualBrush, DualMode, DualSettings, PictureSource, Tip};
use serde_json::{Value, json};
use std::sync::Arc;

/// Reads the picture that a field names.
pub type PictureReader<'a> = dyn FnMut(&JsonNode) -> Result<PictureSource> + 'a;

/// The kinds of tips that are made, not drawn.
#[derive(Clone, Copy, PartialEq)]
enum TipKind {
    Round,
    Ellipse,
    Square,
    Bristles,
    Noise,
    Picture,
    Hose,
}

const KINDS: [(TipKind, &str); 7] = [
    (TipKind::Round, "round"),
    (TipKind::Ellipse, "ellipse"),
    (TipKind::Square, "square"),
    (TipKind::Bristles, "bristles"),
    (TipKind::Noise, "noise"),
    (TipKind::Picture, "picture"),
    (TipKind::Hose, "hose"),
];

/// The fields `tip`, `grain` and `dual`; where they are absent the brush keeps what it has.
pub fn read(fields: &mut Fields, brush: &mut Brush, picture: &mut PictureReader) -> Result<()> {
    if let Some(node) = fields.get("tip") {
        brush.tip = tip(&node, picture)?;
    }
    if let Some(node) = fields.get("grain") {
        brush.grain = Some(grain(&node, picture)?);
    }
    if let Some(node) = fields.get("dual") {
        brush.dual = Some(Arc::new(dual(&node, picture)?));
    }
    Ok(())
}

/// `{ "mode": "subtract", "size": 0.8, "spacing": 0.2, "tip": { … }, "dynamics": { … } }`.
fn dual(node: &JsonNode, picture: &mut PictureReader) -> Result<DualBrush> {
    of_object(node, |fields| {
        let plain = DualBrush::default();
        let numbers = settings(fields, DualSettings::SETTINGS, plain.settings)?;
        let mode = fields.one_of("mode", &DualMode::ALL, numbers.mode)?;
        let tip = fields.get("tip").map_or(Ok(plain.tip), |node| tip(&node, picture))?;
        let dynamics = match fields.get("dynamics") {
            Some(node) => dynamics::read(&node, &plain.dynamics)?,
            None => plain.dynamics,
        };
        Ok(DualBrush { settings: DualSettings { mode, ..numbers }, tip, dynamics })
    })
}

/// `{ "file": "leaf.png" }`, `{ "kind": "ellipse", "ratio": 0.5 }`, `{ "kind": "hose", "files":
/// […], "ranks": […] }` and so on.
fn tip(node: &JsonNode, picture: &mut PictureReader) -> Result<Tip> {
    let mut fields = node.fields()?;
    let kind = match fields.get("kind") {
        Some(kind) => kind.one_of(&KINDS)?,
        None => TipKind::Picture,
    };
    let tip = match kind {
        TipKind::Round => Tip::Round,
        TipKind::Ellipse => Tip::Ellipse { ratio: fields.number("ratio", 0.5, Tip::RATIO)? },
        TipKind::Square => Tip::Square { ratio: fields.number("ratio", 1.0, Tip::RATIO)? },
        TipKind::Bristles => {
            let plain = Bristles::default();
            let count = whole(&mut fields, "count", plain.count, Bristles::COUNT)?;
            Tip::Bristles(Bristles {
                count,
                seed: whole(&mut fields, "seed", plain.seed, 0..=u32::MAX)?,
            })
        }
        TipKind::Noise => {
            let plain = Noise::default();
            let cells = whole(&mut fields, "cells", plain.cells, Noise::CELLS)?;
            let density = fields.number("density", plain.density, UNIT)?;
            let seed = whole(&mut fields, "seed", plain.seed, 0..=u32::MAX)?;
            Tip::Noise(Noise { cells, density, seed })
        }
        TipKind::Picture => Tip::Picture(picture(&fields.require("file")?)?),
        TipKind::Hose => Tip::Hose(hose(&mut fields, picture)?),
    };
    fields.finish()?;
    Ok(tip)
}

fn whole(
    fields: &mut Fields,
    name: &'static str,
    default: u32,
    range: std::ops::RangeInclusive<u32>,
) -> Result<u32> {
    fields.get(name).map_or(Ok(default), |node| node.whole(range))
}

fn hose(fields: &mut Fields, picture: &mut PictureReader) -> Result<Hose> {
    let files = fields.require("files")?;
    let pictures =
        files.list(Hose::MOST_PICTURES)?.iter().map(picture).collect::<Result<Vec<_>>>()?;
    if pictures.is_empty() {
        return Err(files.refusal("is empty; a hose has at least one picture"));
    }
    let ranks = match fields.get("ranks") {
        Some(node) => node.list(Hose::MOST_RANKS)?.iter().map(rank).collect::<Result<_>>()?,
        None => vec![HoseRank { count: pictures.len() as u32, select: RankSelect::default() }],
    };
    Ok(Hose::new(pictures, ranks))
}

fn rank(node: &JsonNode) -> Result<HoseRank> {
    let mut fields = node.fields()?;
    let count = fields.require("count")?.integer(1..=Hose::MOST_PICTURES as i64)? as u32;
    let select = fields.one_of("select", &RankSelect::ALL, RankSelect::default())?;
    fields.finish()?;
    Ok(HoseRank { count, select })
}

/// `{ "kind": "paper", "size": 6, … }` or `{ "file": "canvas.png", "size": 200, … }`.
fn grain(node: &JsonNode, picture: &mut PictureReader) -> Result<BrushGrain> {
    let plain = BrushGrain::default();
    let mut fields = node.fields()?;
    let seed = whole(&mut fields, "seed", 0, 0..=u32::MAX)?;
    let pattern = fields.one_of("kind", &Pattern::ALL, Pattern::default())?;
    let source = match fields.get("file") {
        Some(file) => GrainSource::Picture(picture(&file)?),
        None => GrainSource::Pattern { pattern, seed },
    };
    let levels = fields.get("levels").map_or(Ok(plain.levels), |node| {
        let levels = node.numbers(2, 2, BrushGrain::LEVEL)?;
        if levels[0] >= levels[1] {
            return Err(node.refusal("must have the lower level first"));
        }
        Ok([levels[0], levels[1]])
    })?;
    let gamma = fields.number("gamma", 1.0, BrushGrain::GAMMA)?;
    let lies = fields.one_of("lies", &GrainSpace::ALL, GrainSpace::Canvas)?;
    let grain = BrushGrain {
        source,
        size_px: fields.number("size", plain.size_px, BrushGrain::SIZE_PX)?,
        rotation: fields.number("rotation", plain.rotation, TURNS)?,
        strength: fields.number("strength", plain.strength, UNIT)?,
        levels,
        lies: if let GrainSpace::Surface { .. } = lies {
            GrainSpace::Surface { gamma }
        } else {
            lies
        },
    };
    fields.finish()?;
    Ok(grain)
}

pub fn write_tip(out: &mut JsonObject, tip: &Tip) {
    let mut written = JsonObject::default();
    let mut kind = |word: &str| written.set("kind", word.into());
    match tip {
        Tip::Round => {}
        Tip::Ellipse { ratio } => {
            kind("ellipse");
            written.number("ratio", *ratio, 0.5);
        }
        Tip::Square { ratio } => {
            kind("square");
            written.number("ratio", *ratio, 1.0);
        }
        Tip::Bristles(Bristles { count, seed }) => {
            kind("bristles");
            written.set("count", (*count).into());
            written.set("seed", (*seed).into());
        }
        Tip::Noise(Noise { cells, density, seed }) => {
            kind("noise");
            written.set("cells", (*cells).into());
            written.number("density", *density, 0.5);
            written.set("seed", (*seed).into());
        }
        Tip::Picture(source) => written.set("file", source.file.as_str().into()),
        Tip::Hose(hose) => {
            kind("hose");
            written
                .set("files", hose.pictures().iter().map(|source| source.file.as_str()).collect());
            written.set("ranks", hose.ranks().iter().map(write_rank).collect());
        }
    }
    out.object("tip", written);
}

fn write_rank(rank: &HoseRank) -> Value {
    let word = RankSelect::ALL
        .iter()
        .find(|(select, _)| *select == rank.select)
        .map_or("incremental", |(_, word)| word);
    json!({ "count": rank.count, "select": word })
}

pub fn write_grain(out: &mut JsonObject, grain: Option<&BrushGrain>) {
    let Some(grain) = grain else { return };
    let plain = BrushGrain::default();
    let mut written = JsonObject::default();
    match &grain.source {
        GrainSource::Pattern { pattern, seed } => {
            let word = Pattern::ALL
                .iter()
                .find(|(known, _)| known == pattern)
                .map_or("paper", |(_, word)| word);
            written.set("kind", word.into());
            if *seed != 0 {
                written.set("seed", (*seed).into());
            }
        }
        GrainSource::Picture(source) => written.set("file", source.file.as_str().into()),
    }
    written.number("size", grain.size_px, plain.size_px);
    written.number("rotation", grain.rotation, plain.rotation);
    written.number("strength", grain.strength, plain.strength);
    if grain.levels != plain.levels {
        written.set("levels", grain.levels.map(object::number).to_vec().into());
    }
    written.word("lies", &GrainSpace::ALL, grain.lies.plain(), GrainSpace::Canvas);
    if let GrainSpace::Surface { gamma } = grain.lies {
        written.number("gamma", gamma, 1.0);
    }
    out.object("grain", written);
}

pub fn write_dual(out: &mut JsonObject, dual: Option<&DualBrush>) {
    let Some(DualBrush { settings, tip, dynamics }) = dual else { return };
    let plain = DualBrush::default();
    let mut written = JsonObject::default();
    // Always said, so that a brush that differs in nothing else is not lost.
    written.set("mode", settings.mode.name().into());
    write_settings(&mut written, DualSettings::SETTINGS, settings, &plain.settings);
    write_tip(&mut written, tip);
    written.object("dynamics", dynamics::write(dynamics, &plain.dynamics));
    out.object("dual", written);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Size;
    use crate::paint::Adjust;
    use crate::raster::Picture;
    use std::path::Path;

    fn read_brush(value: &Value) -> Result<Brush> {
        let mut fields = JsonNode::root(Path::new("r.json"), value).fields()?;
        let mut brush = Brush::default();
        let mut picture = |node: &JsonNode| {
            let picture = Picture::srgb8(Size::new(1, 1), vec![[255; 4]]).unwrap();
            Ok(PictureSource::new(node.text()?.into(), picture, Adjust::default()))
        };
        read(&mut fields, &mut brush, &mut picture)?;
        fields.finish()?;
        Ok(brush)
    }

    #[test]
    fn every_tip_and_grain_is_written_as_it_was_read() {
        for text in [
            json!({}),
            json!({ "tip": { "file": "leaf.png" } }),
            json!({ "tip": { "kind": "ellipse", "ratio": 0.25 } }),
            json!({ "tip": { "kind": "square" } }),
            json!({ "tip": { "kind": "bristles", "count": 9, "seed": 4 } }),
            json!({ "tip": { "kind": "noise", "cells": 7, "density": 0.25, "seed": 1 } }),
            json!({ "tip": { "kind": "hose", "files": ["a.png", "b.png"],
                             "ranks": [{ "count": 2, "select": "angular" }] } }),
            json!({ "grain": { "kind": "weave", "seed": 3, "size": 20, "rotation": 45, "strength": 0.5,
              "levels": [0.25, 0.75],
                               "lies": "surface", "gamma": 2 } }),
            json!({ "grain": { "file": "canvas.png", "size": 200 } }),
            json!({ "grain": { "kind": "paper", "size": 9, "lies": "unwrapped" } }),
            json!({ "dual": { "mode": "multiply" } }),
            json!({ "dual": { "mode": "soft-hard-mix", "size": 3, "hardness": 1, "softness": 0.25,
                              "opacity": 0.75, "flow": 0.5, "spacing": 0.5, "scatter": 2, "rotation": -40,
                              "tip": { "file": "chalk.png" },
                              "dynamics": { "flow": { "pressure": [[0, 1], [1, 0.5]] },
                                            "rotation": { "random": 1 } } } }),
        ] {
            let brush = read_brush(&text).unwrap();
            let mut out = JsonObject::default();
            write_tip(&mut out, &brush.tip);
            write_grain(&mut out, brush.grain.as_ref());
            write_dual(&mut out, brush.dual.as_deref());
            assert_eq!(out.into_value(), text);
        }
    }

    #[test]
    fn what_cannot_be_is_refused_in_a_sentence() {
        let says = |value: Value, what: &str| {
            let said = read_brush(&value).err().map(|e| e.to_string()).unwrap_or_default();
            assert!(said.contains(what), "{said}");
        };
        says(
            json!({ "tip": { "kind": "elipse" } }),
            "tip.kind: is “elipse”; it must be one of round, ellipse",
        );
        says(json!({ "tip": { "kind": "ellipse", "ratio": 2 } }), "tip.ratio: is 2");
        says(json!({ "tip": {} }), "tip.file: is missing");
        says(json!({ "tip": { "kind": "round", "ratio": 1 } }), "tip.ratio: is unknown");
        says(json!({ "tip": { "kind": "hose", "files": [] } }), "tip.files: is empty");
        says(
            json!({ "grain": { "levels": [0.5, 0.5] } }),
            "grain.levels: must have the lower level first",
        );
        says(json!({ "grain": { "lies": "floor" } }), "must be one of canvas, surface");
        says(json!({ "dual": { "size": 0 } }), "r.json: dual.size: is 0; it must be between 0.01");
        says(json!({ "dual": { "spacing": "wide" } }), "dual.spacing: is");
        says(json!({ "dual": { "mode": "divide" } }), "dual.mode: is “divide”; it must be one of");
        says(json!({ "dual": { "tip": { "kind": "hose", "files": [] } } }), "dual.tip.files");
        says(json!({ "dual": { "dual": {} } }), "dual.dual: is unknown");
        says(
            json!({ "dual": { "dynamics": { "size": { "tilt": [[1, 0], [0, 1]] } } } }),
            "is not a",
        );
    }
}
