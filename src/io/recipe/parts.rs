//! Reads and writes the parts of a shape: `surface.parts`, the farthest first.
//! Floor 5. Ranges and names are those of the types. The writer is `write`.

mod write;

use write::write_maps;
pub use write::{write, write_part};

use super::pictures::PictureCache;
use super::{LayerReader, RecipeSource, maps, samples, surface};
use crate::document::parts::{
    CoverageFile, FlatColor, Inflation, OutlineSource, Part, PartKind, PartMaps, Parts,
    ProfilePicture,
};
use crate::document::{Document, NamedSelection, SurfaceSource};
use crate::files::UserFiles;
use crate::json::{Fields, JsonNode, JsonObject};
use crate::math::{Affine2, COORDINATE, Range, Size, Vec2, Vec3, vec2};
use crate::shape::profiles::MOST_PROFILES;
use crate::shape::{
    Ball, Bevel, BevelCurve, Body, Combine, Detail, LineForm, Lines, Primitive, SculptStroke,
    SculptTool, Touch,
};
use crate::surface::Surface;
use crate::{Budget, Result};
use serde_json::Value;
use std::path::Path;
use std::sync::Arc;

/// The defaults that are in no type.
const TOUCH_RADIUS: f32 = 6.0;
const BODY_RADIUS: f32 = 50.0;
const DAB_SIZE: f32 = 40.0;
const DAB_HARDNESS: f32 = 0.5;
const DAB_STRENGTH: f32 = 2.0;

/// One part as an edit of a document describes it. The pictures that it names are those of the
/// document's parts, or the user's own. `file`: for messages.
pub fn read_part(file: &Path, value: &Value, document: &Document, budget: &Budget) -> Result<Part> {
    let files = UserFiles::default();
    let source = RecipeSource { file, files: &files, budget, onto: None };
    let mut pictures = PictureCache::default();
    for part in &document.parts.list {
        for known in Part::clone(part).files_mut() {
            pictures.know_coverage(&known.file, &known.coverage);
        }
        if let PartKind::Maps(maps) = &part.kind {
            pictures.know_maps(maps);
        }
    }
    let Budget { layers: layers_left, document_samples: samples_left, .. } = *budget;
    let size = document.size;
    // Edits call selections by their names.
    let by_name = |kept: &NamedSelection| {
        (kept.name.clone(), (kept.selection.clone(), Some(kept.name.clone())))
    };
    let selections = document.selections.iter().map(by_name).collect();
    let (attachments, notes) = (Vec::new(), Vec::new());
    let mut reader = LayerReader {
        source,
        size,
        layers_left,
        samples_left,
        pictures,
        selections,
        attachments,
        notes,
    };
    reader.part(&JsonNode::root(file, value), document.parts.list.len())
}

impl LayerReader<'_> {
    /// The list of parts.
    pub fn parts(&mut self, node: &JsonNode) -> Result<Vec<Arc<Part>>> {
        let items = node.list(Parts::MOST)?;
        let mut list: Vec<Arc<Part>> = Vec::with_capacity(items.len());
        for (i, item) in items.iter().enumerate() {
            let part = self.part(item, i)?;
            if list.iter().any(|other| other.id == part.id) {
                return Err(
                    item.refusal(format!("has the id “{}”, which another part has", part.id))
                );
            }
            list.push(Arc::new(part));
        }
        Ok(list)
    }

    fn part(&mut self, node: &JsonNode, index: usize) -> Result<Part> {
        let mut fields = node.fields()?;
        let kind = self.part_kind(&mut fields)?;
        let id = fields.get("id").map_or(Ok(None), |id| id.text().map(|id| Some(id.to_owned())))?;
        let id = id.unwrap_or_else(|| format!("part-{}", index + 1));
        let plain = Part::new(id, kind);
        let name = fields
            .get("name")
            .map_or(Ok(None), |name| name.text().map(|name| Some(name.to_owned())))?;
        let mut combine = fields.one_of("combine", &Combine::ALL, Combine::Over)?;
        let smooth = fields.get("smooth").map(|node| node.number(Combine::SMOOTH)).transpose()?;
        if let (Combine::Union { smooth: own }, Some(smooth)) = (&mut combine, smooth) {
            *own = smooth;
        }
        let tilt = fields.get("tilt").map(|node| node.numbers(2, 2, Part::TILT)).transpose()?;
        let matrix =
            fields.get("matrix").map(|node| node.numbers(6, 6, Part::MATRIX)).transpose()?;
        let part = Part {
            visible: fields.boolean("visible", true)?,
            raise: fields.number("raise", 0.0, Part::RAISE)?,
            tilt_deg: tilt.map_or(Vec2::ZERO, |v| vec2(v[0], v[1])),
            matrix: matrix.map_or(Affine2::IDENTITY, |m| {
                Affine2::from_cols_array(&[m[0], m[1], m[2], m[3], m[4], m[5]])
            }),
            name: name.unwrap_or_else(|| plain.name.clone()),
            combine,
            ..plain
        };
        fields.finish()?;
        part.fits().map_err(|why| node.refusal(why))?;
        Ok(part)
    }

    fn part_kind(&mut self, fields: &mut Fields) -> Result<PartKind> {
        type ReadKind = fn(&mut LayerReader<'_>, &mut Fields<'_>) -> Result<PartKind>;
        const KINDS: [(ReadKind, &str); 11] = [
            (|reader, fields| reader.inflate(fields), "inflate"),
            (|reader, fields| reader.bevel(fields), "bevel"),
            (|_, fields| Ok(PartKind::Primitive(primitive(fields)?)), "primitive"),
            (|reader, fields| reader.lathe(fields), "lathe"),
            (|_, fields| sweep(fields), "sweep"),
            (|_, fields| touches(fields), "touches"),
            (|reader, fields| reader.sculpt(fields), "sculpt"),
            (|reader, fields| reader.relief(fields), "relief"),
            (|reader, fields| reader.lines(fields), "lines"),
            (|reader, fields| reader.profiles(fields), "profiles"),
            (|reader, fields| reader.maps(fields), "maps"),
        ];
        fields.require("kind")?.one_of(&KINDS)?(self, fields)
    }

    fn inflate(&mut self, fields: &mut Fields) -> Result<PartKind> {
        let plain = Inflation::default();
        let inflation = Inflation {
            puff: fields.number("puff", plain.puff, Inflation::PUFF)?,
            profile: fields.number("profile", plain.profile, Inflation::PROFILE)?,
            rim_deg: fields.number("rim", plain.rim_deg, Inflation::RIM)?,
        };
        Ok(PartKind::Inflate { outline: self.outline(fields)?, inflation })
    }

    fn bevel(&mut self, fields: &mut Fields) -> Result<PartKind> {
        let plain = Bevel::default();
        let bevel = Bevel {
            width: fields.number("width", plain.width, Bevel::WIDTH)?,
            height: fields.number("height", plain.height, Bevel::HEIGHT)?,
            curve: fields.get("curve").map_or(Ok(plain.curve), |node| curve(&node))?,
        };
        Ok(PartKind::Bevel { outline: self.outline(fields)?, bevel })
    }

    fn lathe(&mut self, fields: &mut Fields) -> Result<PartKind> {
        let axis = fields.get("axis").map(|node| points(&node, 2)).transpose()?;
        let axis = match axis.as_deref() {
            None => None,
            Some([a, b]) => Some([*a, *b]),
            Some(_) => return Err(fields.node().refusal("has an axis that is not two points")),
        };
        let puff = fields.number("puff", 1.0, Inflation::PUFF)?;
        Ok(PartKind::Lathe { outline: self.outline(fields)?, axis, puff })
    }

    fn relief(&mut self, fields: &mut Fields) -> Result<PartKind> {
        let plain = Detail::default();
        let detail = Detail {
            coarse: fields.number("coarse", plain.coarse, Detail::HEIGHT)?,
            fine: fields.number("fine", plain.fine, Detail::HEIGHT)?,
            radius: fields.number("radius", plain.radius, Detail::RADIUS)?,
            edge: fields.number("edge", plain.edge, Detail::EDGE)?,
        };
        let (file, coverage) =
            self.pictures.coverage(self.source, &fields.require("file")?, None)?;
        Ok(PartKind::Relief { on: on(fields)?, picture: CoverageFile { file, coverage }, detail })
    }

    fn lines(&mut self, fields: &mut Fields) -> Result<PartKind> {
        let plain = Lines::default();
        let lines = Lines {
            form: fields.one_of("form", &LineForm::ALL, plain.form)?,
            angle_deg: fields.number("angle", plain.angle_deg, Lines::ANGLE)?,
            reach: fields.number("reach", plain.reach, Lines::REACH)?,
        };
        Ok(PartKind::Lines { on: on(fields)?, ink: self.outline(fields)?, lines })
    }

    fn profiles(&mut self, fields: &mut Fields) -> Result<PartKind> {
        let outline = fields.get("outline").map(|node| self.outline_of(&node)).transpose()?;
        let mut shading = |item: &JsonNode| {
            let mut fields = item.fields()?;
            let (file, coverage) =
                self.pictures.coverage(self.source, &fields.require("file")?, None)?;
            let light = fields.require("light")?.vector(ProfilePicture::LIGHT)?;
            fields.finish()?;
            Ok(ProfilePicture { picture: CoverageFile { file, coverage }, light })
        };
        let items = fields.require("pictures")?.list(MOST_PROFILES)?;
        let shadings = items.iter().map(&mut shading).collect::<Result<_>>()?;
        Ok(PartKind::Profiles { outline, shadings })
    }

    fn maps(&mut self, fields: &mut Fields) -> Result<PartKind> {
        let node = fields.node().clone();
        let frame = fields.get("frame").map(|node| self.frame(&node)).transpose()?;
        let (size, matrix) = frame.unwrap_or((self.size, None));
        // The pictures of an edit are known, wherever they came from: their files are not read
        // again.
        let is_as_written = |known: &PartMaps| {
            let mut written = JsonObject::default();
            write_maps(&mut written, known, Some(known.surface.size()));
            let is_same = |(name, value): (&String, &Value)| {
                name == "frame" || node.value().get(name) == Some(value)
            };
            (known.surface.size(), known.source.matrix) == (size, matrix)
                && written.fields().iter().all(is_same)
        };
        if let Some(known) = self.pictures.cached_maps(is_as_written) {
            for name in ["normal", "depth", "mask"] {
                fields.get(name);
            }
            return Ok(PartKind::Maps(known));
        }
        let source = SurfaceSource { matrix, ..surface::maps_of(fields)? };
        if source.normal.is_none() && source.depth.is_none() {
            return Err(node.refusal("names neither a normal map nor a depth map"));
        }
        let found = maps::import(&source, self.source.files, self.source.budget)
            .map_err(|error| node.name_in_error(error))?;
        let made = Arc::new(found.surface).onto(size, source.map().as_ref());
        let surface = made.map_err(|error| node.refusal(error))?;
        self.notes.extend(found.findings.notes);
        Ok(PartKind::Maps(PartMaps {
            source: Arc::new(source),
            files: Arc::new(found.files),
            surface,
        }))
    }

    /// The frame that maps are put on, and how, if they are not fitted to it.
    fn frame(&mut self, node: &JsonNode) -> Result<(Size, Option<[f64; 6]>)> {
        let mut fields = node.fields()?;
        let mut side = |name| fields.require(name)?.integer(1..=i64::from(u32::MAX));
        let (width, height) = (side("width")?, side("height")?);
        let matrix = fields.get("matrix").map(|node| surface::matrix(&node)).transpose()?;
        fields.finish()?;
        let size = self.source.budget.size(self.source.file, width as u64, height as u64)?;
        self.pictures.hold(self.source, size.area() * Surface::BYTES_PER_PX)?;
        Ok((size, matrix))
    }

    fn sculpt(&mut self, fields: &mut Fields) -> Result<PartKind> {
        let mut stroke = |item: &JsonNode| {
            let mut fields = item.fields()?;
            let samples = fields.require("samples")?;
            let stroke = SculptStroke {
                tool: fields.one_of("tool", &SculptTool::ALL, SculptTool::default())?,
                size: fields.number("size", DAB_SIZE, SculptStroke::SIZE)?,
                hardness: fields.number("hardness", DAB_HARDNESS, SculptStroke::HARDNESS)?,
                strength: fields.number("strength", DAB_STRENGTH, SculptStroke::STRENGTH)?,
                samples: samples::read_pressed(
                    &samples,
                    SculptStroke::MOST,
                    &mut self.samples_left,
                )?,
            };
            fields.finish()?;
            Ok(stroke)
        };
        let items = fields.require("strokes")?.list(SculptStroke::MOST)?;
        let strokes = items.iter().map(&mut stroke).collect::<Result<_>>()?;
        Ok(PartKind::Sculpt { on: on(fields)?, strokes })
    }

    fn outline(&mut self, fields: &mut Fields) -> Result<OutlineSource> {
        let node = fields.require("outline")?;
        self.outline_of(&node)
    }

    fn outline_of(&mut self, node: &JsonNode) -> Result<OutlineSource> {
        let mut fields = node.fields()?;
        let color = fields.get("color").map(|node| node.color()).transpose()?;
        let at = fields.get("at").map(|node| node.point()).transpose()?;
        if at.is_some() && color.is_none() {
            return Err(node.refusal("has a place (“at”), but no color"));
        }
        let color = color.map(|color| FlatColor { color, at });
        let source = if let Some(layer) = fields.get("layer") {
            OutlineSource::Layer { layer: layer.text()?.to_owned(), color }
        } else if let Some(file) = fields.get("file") {
            let (file, coverage) = self.pictures.coverage(self.source, &file, None)?;
            OutlineSource::File(CoverageFile { file, coverage })
        } else if let Some(path) = fields.get("path") {
            OutlineSource::Path(points(&path, OutlineSource::MOST_POINTS)?)
        } else if let Some(selection) = fields.get("selection") {
            OutlineSource::Selection(self.outline_selection(&selection)?)
        } else if let Some(object) = fields.get("object") {
            OutlineSource::Object(object.whole(1..=u32::MAX)?)
        } else {
            return Err(node.refusal("names no layer, file, selection, path or object"));
        };
        if color.is_some() && !matches!(source, OutlineSource::Layer { .. }) {
            return Err(node.refusal("has a color, but no layer"));
        }
        fields.finish()?;
        Ok(source)
    }
}

fn on(fields: &mut Fields) -> Result<String> {
    fields.require("on")?.text().map(str::to_owned)
}

fn points(node: &JsonNode, most: usize) -> Result<Vec<Vec2>> {
    node.list(most)?.iter().map(|item| item.point()).collect()
}

/// A word, or points (t, f).
fn curve(node: &JsonNode) -> Result<BevelCurve> {
    if node.value().is_string() {
        let words: Vec<(usize, &str)> =
            BevelCurve::NAMED.iter().enumerate().map(|(i, (_, name))| (i, *name)).collect();
        return Ok(BevelCurve::NAMED[node.one_of(&words)?].0.clone());
    }
    let points = points(node, BevelCurve::MOST_POINTS)?;
    if points.len() < 2 || points.windows(2).any(|pair| pair[0].x > pair[1].x) {
        return Err(
            node.refusal("must have two points or more, each farther in than the one before")
        );
    }
    Ok(BevelCurve::Points(points))
}

fn primitive(fields: &mut Fields) -> Result<Primitive> {
    let body = fields.require("shape")?.one_of(&Body::ALL)?;
    let center = fields.require("center")?.point()?;
    let radius = fields.number("radius", BODY_RADIUS, Primitive::LENGTH)?;
    let plain = Primitive::new(body, center, radius);
    let vector = |node: Option<JsonNode>, plain: Vec3, range: Range| {
        node.map_or(Ok(plain), |node| node.vector(range))
    };
    Ok(Primitive {
        half: vector(fields.get("half"), plain.half, Primitive::LENGTH)?,
        length: fields.number("length", plain.length, Primitive::LENGTH)?,
        tube: fields.number("tube", plain.tube, Primitive::LENGTH)?,
        round: fields.number("round", plain.round, Primitive::ROUND)?,
        turn_deg: vector(fields.get("turn"), plain.turn_deg, Primitive::TURN)?,
        ..plain
    })
}

fn sweep(fields: &mut Fields) -> Result<PartKind> {
    let ball = |item: &JsonNode| {
        let v = item.numbers(3, 3, COORDINATE)?;
        Ok(Ball { at: vec2(v[0], v[1]), radius: v[2] })
    };
    let balls =
        fields.require("balls")?.list(Ball::MOST)?.iter().map(ball).collect::<Result<_>>()?;
    Ok(PartKind::Sweep { balls, puff: fields.number("puff", 1.0, Inflation::PUFF)? })
}

fn touches(fields: &mut Fields) -> Result<PartKind> {
    let touch = |item: &JsonNode| {
        let mut fields = item.fields()?;
        let touch = Touch {
            at: fields.require("at")?.point()?,
            radius: fields.number("radius", TOUCH_RADIUS, Touch::RADIUS)?,
            normal: fields.require("normal")?.vector(-1.0..=1.0)?,
            reach: fields.number("reach", 0.0, Touch::REACH)?,
        };
        fields.finish()?;
        Ok(touch)
    };
    let touches =
        fields.require("touches")?.list(Touch::MOST)?.iter().map(touch).collect::<Result<_>>()?;
    Ok(PartKind::Touches { on: on(fields)?, touches })
}

#[cfg(test)]
mod attachment_tests;
#[cfg(test)]
mod tests;
