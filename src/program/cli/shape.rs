//! `rilievo shape`: maps for a drawing that has none. Floor 7. Not here: what a shape is made of
//! (`document::parts`), the files (`io::export::shape`).

use super::force::Force;
use super::messages::print_notes;
use super::{LimitArgs, values};
use crate::document::parts::drawing::{FigureBackground, without_background};
use crate::document::parts::from_flats::{self, FlatParts, PartFor};
use crate::document::parts::{Inflation, Part};
use crate::document::{Content, Document, Layer, PixelLayer};
use crate::io::export::shape::{ShapeFiles, ShapeMap, ShapeOptions};
use crate::io::export::{ExportOptions, OutputFile};
use crate::io::files::read_file;
use crate::io::{Budget, Terms, picture, svg};
use crate::math::{Affine2, Range, Size, Vec2};
use crate::raster::TileGrid;
use crate::session::actions::parts::paths::PathParts;
use crate::shape::flats::lifted_ink::LiftedInk;
use crate::{Error, Result};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// How much larger or smaller than its own size an SVG is drawn.
const SCALE: Range = 0.01..=64.0;

/// Make normals, depth and parts for a drawing that has no maps
///
/// The drawing's alpha is its outline; a background of one color is left out. With --flats each
/// flat color becomes a part, and parts that interrupt the outline of others lie in front of them.
/// With --paths each filled path of an SVG drawing becomes a part.
/// FOLDER gets DRAWING_n (normals), _d (depth, near is 0), _h (height), _mask and _id (the number
/// of the part).
#[derive(clap::Args)]
pub struct ShapeArgs {
    /// The drawing, on a background that is transparent or of one color
    #[arg(value_name = "DRAWING")]
    drawing: PathBuf,
    /// A picture of the same size with a flat color for each part
    #[arg(long, value_name = "FILE")]
    flats: Option<PathBuf>,
    /// A part for each separate area of a color, such as two eyes
    #[arg(long, requires = "flats", alias = "places")]
    areas: bool,
    /// A part for each filled path of the drawing, which is an SVG
    #[arg(long, conflicts_with_all = ["flats", "areas", "ink"])]
    paths: bool,
    /// With --paths: the maps are so many times larger than the SVG says; by default so that the
    /// longer side has at least 2048 pixels
    #[arg(long, value_name = "FACTOR", requires = "paths", value_parser = scale)]
    scale: Option<f32>,
    /// The folder to write the maps to; created if it does not exist
    #[arg(short, long, value_name = "FOLDER")]
    output: PathBuf,
    /// How parts are rounded
    #[arg(long, value_name = "PRESET", default_value = "pillow", value_parser = presets())]
    preset: Inflation,
    /// Height factor, instead of the preset's
    #[arg(long, value_name = "FACTOR", value_parser = puff)]
    puff: Option<f32>,
    /// 0 (pillow) to 1 (tube), instead of the preset's
    #[arg(long, value_name = "SHARE", value_parser = profile)]
    profile: Option<f32>,
    /// Angle of the rim in degrees (90 is a silhouette), instead of the preset's
    #[arg(long, value_name = "DEGREES", value_parser = rim)]
    rim: Option<f32>,
    /// Direction of green in the normals: up (opengl) or down (directx)
    #[arg(long, value_name = "WORD", default_value = "opengl", value_parser = ["opengl", "directx"])]
    convention: String,
    /// Also write the drawing's ink alone (_ink), to lie unlit on top, and the drawing without it
    /// (_flats), whose colors continue beneath
    #[arg(long)]
    ink: bool,
    /// Bits per channel of a PNG: 8 or 16
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = values::bits)]
    bits: u8,
    /// File format: png, or exr with 32 bits per channel
    #[arg(long, value_name = "FORMAT", default_value = "png", value_parser = ["png", "exr"])]
    format: String,
    #[command(flatten)]
    force: Force,
    #[command(flatten)]
    limits: LimitArgs,
}

fn presets() -> impl TypedValueParser<Value = Inflation> {
    let names = Inflation::PRESETS.iter().map(|(_, name)| PossibleValue::new(*name));
    PossibleValuesParser::new(names).map(|word| {
        Inflation::PRESETS
            .iter()
            .find(|(_, name)| *name == word)
            .map_or(Inflation::default(), |(preset, _)| *preset)
    })
}

fn parse_within(text: &str, range: &Range) -> std::result::Result<f32, String> {
    let number = text.parse().ok().filter(|v| range.contains(v));
    number.ok_or_else(|| format!("it must be between {} and {}", range.start(), range.end()))
}

fn puff(text: &str) -> std::result::Result<f32, String> {
    parse_within(text, &Inflation::PUFF)
}

fn profile(text: &str) -> std::result::Result<f32, String> {
    parse_within(text, &Inflation::PROFILE)
}

fn scale(text: &str) -> std::result::Result<f32, String> {
    parse_within(text, &SCALE)
}

fn rim(text: &str) -> std::result::Result<f32, String> {
    parse_within(text, &Inflation::RIM)
}

pub fn run(args: &ShapeArgs) -> Result<()> {
    args.limits.install(|| {
        let (document, note) = shape_drawing(args)?;
        let nothing = || {
            Error::unsupported_file(&args.drawing, "nothing in it is opaque enough to have a shape")
        };
        let surface = document.surface.as_ref().ok_or_else(nothing)?;
        std::fs::create_dir_all(&args.output).map_err(|e| Error::io(&args.output, e))?;
        let stem = args.drawing.file_stem().unwrap_or_default().to_string_lossy();
        let reads: Vec<PathBuf> =
            [Some(args.drawing.clone()), args.flats.clone()].into_iter().flatten().collect();
        let options = ShapeOptions {
            is_directx: args.convention == "directx",
            is_16_bit: args.bits == 16,
            is_exr: args.format == "exr",
        };
        let maps = ShapeMap::ALL.map(|(map, _)| map);
        // The extension of the name is not part of it.
        let base = args.output.join(format!("{stem}.{}", args.format));
        let terms = args.force.export(reads);
        let maps = ShapeFiles::new(&base, &maps, options, &terms)?;
        let ink = args.ink.then(|| InkFiles::new(&args.output, &stem, &terms)).transpose()?;
        maps.write(surface)?;
        if let Some(files) = ink {
            files.write(&document)?;
        }
        print_notes(args.flats.as_ref().unwrap_or(&args.drawing), note.as_slice());
        Ok(())
    })
}

/// Where the two halves of a drawing go.
struct InkFiles {
    ink: OutputFile,
    flats: OutputFile,
}

impl InkFiles {
    fn new(folder: &Path, stem: &str, terms: &Terms) -> Result<Self> {
        let file =
            |what: &str| OutputFile::new(&folder.join(format!("{stem}_{what}.png")), terms.clone());
        Ok(Self { ink: file("ink")?, flats: file("flats")? })
    }

    fn write(&self, document: &Document) -> Result<()> {
        let drawing = document.layer_named("Drawing").map(|layer| &layer.content);
        let Some(Content::Pixels(drawing)) = drawing else { return Ok(()) };
        let lifted = LiftedInk::of(&drawing.tiles);
        let options = ExportOptions::default();
        self.ink.write(&lifted.lines, document.size, &options, document.profile)?;
        self.flats.write(&lifted.flats, document.size, &options, document.profile)
    }
}

/// Flats are found through so much, and no surface takes less.
const BYTES_A_PIXEL: u64 = 64;

/// The drawing as a document with parts, and what is told about colors without one.
fn shape_drawing(args: &ShapeArgs) -> Result<(Document, Option<String>)> {
    let budget = args.limits.budget();
    let inflation = Inflation {
        puff: args.puff.unwrap_or(args.preset.puff),
        profile: args.profile.unwrap_or(args.preset.profile),
        rim_deg: args.rim.unwrap_or(args.preset.rim_deg),
    };
    if args.paths {
        return shape_of_paths(args, inflation, &budget);
    }
    let (size, drawing) = tiles(&args.drawing, &budget)?;
    budget.room(
        &args.drawing,
        &format!("the shape of {size} pixels"),
        size.area() as u64 * BYTES_A_PIXEL,
    )?;
    let held = drawing.bytes() as u64;
    let (parts, layers) = match &args.flats {
        None => {
            let figure = figure(&args.drawing, drawing, size)?;
            let part = Part::of_layer("drawing", "Drawing", inflation);
            (FlatParts::of_one(part), vec![layer("Drawing", figure)])
        }
        Some(file) => {
            let (other, flats) = tiles(file, &budget)?;
            if other != size {
                return Err(Error::unsupported_file(
                    file,
                    format!("it has {other} pixels, the drawing {size}"),
                ));
            }
            let each = if args.areas { PartFor::Area } else { PartFor::Color };
            let flats = match FigureBackground::of(&flats, size) {
                // Flats may fill their picture.
                FigureBackground::Painted => flats,
                _ => figure(file, flats, size)?,
            };
            let parts = from_flats::parts_of_flats(&flats, "Flats", inflation, each);
            if parts.parts.is_empty() {
                return Err(Error::unsupported_file(
                    file,
                    "no flat color in it covers enough to be a part",
                ));
            }
            (parts, vec![layer("Flats", flats), layer("Drawing", drawing)])
        }
    };
    let document = Document { layers, ..Document::empty(size) };
    let note = parts.note();
    let list: Vec<Arc<Part>> = parts.parts.into_iter().map(Arc::new).collect();
    budget.room_for_shape(&args.drawing, &document, &list, held)?;
    Ok((document.with_parts(list), note))
}

/// An SVG as a document with a part for each of its filled paths.
fn shape_of_paths(
    args: &ShapeArgs,
    inflation: Inflation,
    budget: &Budget,
) -> Result<(Document, Option<String>)> {
    let refused = |reason: String| Error::unsupported_file(&args.drawing, reason);
    let bytes = read_file(&args.drawing, budget.file_bytes)?;
    if !svg::is_svg(&bytes) {
        return Err(refused("it is no SVG drawing, so it has no paths (--paths)".into()));
    }
    let read = svg::read_shapes(&args.drawing, &bytes, budget)?;
    let scale = args.scale.unwrap_or_else(|| svg::layer_scale(read.size));
    // A length that was scaled to whole pixels may be a little above.
    let side = |length: f32| (length * scale - 1e-3).ceil().max(1.0) as u64;
    let size = budget.size(&args.drawing, side(read.size.x), side(read.size.y))?;
    budget.room(
        &args.drawing,
        &format!("the shape of {size} pixels"),
        size.area() as u64 * BYTES_A_PIXEL,
    )?;
    let map = Affine2::from_scale(Vec2::splat(scale));
    let made = PathParts::of(&read, size, &map, BTreeSet::new(), inflation);
    let note = made.note();
    if made.parts.is_empty() {
        return Err(refused("no filled path in it covers enough to be a part".into()));
    }
    let document = Document { layers: made.layers, ..Document::empty(size) };
    let list: Vec<Arc<Part>> = made.parts.into_iter().map(Arc::new).collect();
    budget.room_for_shape(&args.drawing, &document, &list, 0)?;
    Ok((document.with_parts(list), note))
}

fn layer(name: &str, tiles: TileGrid) -> Arc<Layer> {
    Arc::new(Layer::new(
        name,
        Content::Pixels(PixelLayer { file: String::new(), x: 0, y: 0, tiles }),
    ))
}

fn tiles(file: &Path, budget: &Budget) -> Result<(Size, TileGrid)> {
    let picture = picture::decode(file, &read_file(file, budget.file_bytes)?, budget)?;
    Ok((picture.size, picture::to_tiles(&picture, 0, 0)))
}

/// A drawing without its ground; one that fills its picture has no outline but the picture's.
fn figure(file: &Path, drawing: TileGrid, size: Size) -> Result<TileGrid> {
    match FigureBackground::of(&drawing, size) {
        FigureBackground::Transparent => Ok(drawing),
        FigureBackground::Flat(ground) => Ok(without_background(&drawing, size, ground)),
        FigureBackground::Painted => Err(Error::unsupported_file(
            file,
            "it is opaque everywhere, so it has no outline; give it a transparent background, or \
             name its flats with --flats",
        )),
        FigureBackground::Bare(_) => Err(Error::unsupported_file(
            file,
            "it has one color all over, so there is no figure in it to have a shape",
        )),
        FigureBackground::Empty => {
            Err(Error::unsupported_file(file, "nothing in it is opaque enough to have a shape"))
        }
    }
}
