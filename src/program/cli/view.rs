//! `rilievo view`: the maps of a document, or of loose files, as pictures.
//! Floor 7. Not here: the views (`document::view`).

use super::LimitArgs;
use super::force::Force;
use super::messages::print_notes;
use crate::document::source::{MapSource, MaskSource};
use crate::document::view::{self, SurfaceView, UnwrappedPicture, ViewOptions, ViewUnavailable};
use crate::document::{Content, Document, Layer, Live, Progress, SurfaceSource};
use crate::io::export::{ExportOptions, OutputFile};
use crate::io::files::{TrackedFiles, read_file};
use crate::io::maps::{self, pairs};
use crate::io::recipe::{self, RecipeSource};
use crate::io::{Budget, RecipeFolder, UserFiles, sixteen_bit_paint};
use crate::math::{ColorProfile, Size, named::former_name, srgb::Color};
use crate::paint::{Adjust, ImageFilter, PictureSource, PlacedImage};
use crate::raster::{Outside, Picture, TileGrid, picture::Texels};
use crate::{Error, Result};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Show maps, curvature, weights and flows as pictures
#[derive(clap::Args)]
pub struct ViewArgs {
    /// A recipe, or normal, depth and mask maps recognized by their names (pot_n.png,
    /// pot_depth.exr, pot_mask.png)
    #[arg(value_name = "FILES")]
    files: Vec<PathBuf>,
    /// What to show; “sheet” shows all views side by side
    #[arg(long, value_name = "VIEW", default_value = "sheet", value_parser = parse_show())]
    show: ShowArg,
    /// The picture to write; a folder gets one picture for each view
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// The layer whose anchors or operator are shown (by default the topmost that has any); with
    /// “unwrapped”, the layer that is shown (by default the whole painting)
    #[arg(long, value_name = "NAME")]
    layer: Option<String>,
    /// The normal map, whatever its name
    #[arg(long, value_name = "FILE")]
    normal: Option<PathBuf>,
    /// The depth map, whatever its name
    #[arg(long, value_name = "FILE")]
    depth: Option<PathBuf>,
    /// The mask, whatever its name
    #[arg(long, value_name = "FILE")]
    mask: Option<PathBuf>,
    /// With “unwrapped”: pixels of the picture per pixel of the surface
    #[arg(long, value_name = "FACTOR", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=4))]
    scale: u32,
    /// Curvature scale in pixels: larger values show stronger curvature
    #[arg(long, value_name = "PX", value_parser = not_negative,
          default_value_t = ViewOptions::default().curvature_scale_px)]
    curvature_scale: f32,
    /// Blur of normals and flows, standard deviation in pixels
    #[arg(long, value_name = "PX", default_value_t = ViewOptions::default().blur_px, value_parser = not_negative)]
    blur: f32,
    /// Background outside the surface, as #rrggbb; required for a JPEG
    #[arg(long, value_name = "COLOR", value_parser = super::values::color)]
    background: Option<Color>,
    #[command(flatten)]
    force: Force,
    #[command(flatten)]
    limits: LimitArgs,
}

/// One view, or all of them on a sheet.
#[derive(Clone, Copy)]
enum ShowArg {
    One(SurfaceView),
    Sheet,
}

fn parse_show() -> impl TypedValueParser<Value = ShowArg> {
    let names = SurfaceView::ALL
        .iter()
        .map(|(_, name)| PossibleValue::new(*name).aliases(former_name(name)))
        .chain([PossibleValue::new("sheet")]);
    PossibleValuesParser::new(names)
        .map(|name| SurfaceView::from_name(&name).map_or(ShowArg::Sheet, ShowArg::One))
}

fn not_negative(text: &str) -> std::result::Result<f32, String> {
    text.parse()
        .ok()
        .filter(|v: &f32| v.is_finite() && *v >= 0.0)
        .ok_or_else(|| "it must be a number, 0 or more".into())
}

/// Draws what was requested.
pub fn run(args: &ViewArgs) -> Result<()> {
    args.limits.install(|| {
        let (document, reads) = match args.show {
            ShowArg::One(view) if view.is_of_nothing() => {
                (Document::empty(Size::new(1, 1)), Vec::new())
            }
            _ => open(args)?,
        };
        let layer =
            args.layer.as_deref().map(|name| find_layer(args, &document, name)).transpose()?;
        let options = ViewOptions { curvature_scale_px: args.curvature_scale, blur_px: args.blur };
        let draw = |view: SurfaceView| {
            view::draw(&document, layer, view, &options).map_err(|why| {
                Error::invalid(named_file(args), format!("--show {}", view.name()), why)
            })
        };
        // Maps are numbers; a painting is in the document's colors.
        let write = |target: &OutputFile, picture: &Picture| {
            write(args, target, picture, ColorProfile::Srgb)
        };
        if args.output.is_dir() {
            let target = |view: SurfaceView| {
                let file = args.output.join(view.name()).with_extension("png");
                Ok((view, OutputFile::new(&file, args.force.export(reads.clone()))?))
            };
            // Either all are possible, or none is drawn.
            let targets: Vec<_> =
                view::available(&document, layer).into_iter().map(target).collect::<Result<_>>()?;
            return targets.into_iter().try_for_each(|(view, target)| write(&target, &draw(view)?));
        }
        let target = OutputFile::new(&args.output, args.force.export(reads.clone()))?;
        match args.show {
            ShowArg::One(SurfaceView::Unwrapped) => {
                let refused = |why| Error::invalid(named_file(args), "--show unwrapped", why);
                let options = view::UnwrapOptions { scale: args.scale, ..Default::default() };
                let seen = view::render_unwrapped(&document, layer, options, &Progress::default())
                    .map_err(refused)?;
                let picture = seen.picture().ok_or_else(|| refused(ViewUnavailable::NoMemory))?;
                self::write(args, &target, &picture, document.profile)?;
                // What puts the picture back.
                println!("{}", layer_line(&document, &args.output, &seen, picture));
                Ok(())
            }
            ShowArg::One(view) => write(&target, &draw(view)?),
            ShowArg::Sheet => {
                let views = view::available(&document, layer)
                    .into_iter()
                    .map(draw)
                    .collect::<Result<Vec<_>>>()?;
                let nothing =
                    || Error::invalid(named_file(args), "--show", "there is nothing to show");
                write(&target, &view::sheet(&views).ok_or_else(nothing)?)
            }
        }
    })
}

/// The layer of a recipe that puts a picture of the unwrapped surface where it was seen.
fn layer_line(
    document: &Document,
    file: &Path,
    seen: &UnwrappedPicture,
    picture: Picture,
) -> String {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let image = PlacedImage {
        source: PictureSource::new(name.into_owned(), picture, Adjust::default()),
        placement: seen.placement,
        outside: Outside::None,
        bend: seen.bend.clone(),
        filter: ImageFilter::Antialias,
        frame: Default::default(),
    };
    let layer = Layer::new(
        file.file_stem().unwrap_or_default().to_string_lossy(),
        Content::Image(Live::new(image)),
    );
    let recipe = recipe::write(&Document {
        layers: vec![Arc::new(layer)],
        ..Document::empty(document.size)
    });
    recipe
        .get("layers")
        .and_then(|layers| layers.get(0))
        .map(ToString::to_string)
        .unwrap_or_default()
}

/// The file named in errors about the whole command.
fn named_file(args: &ViewArgs) -> &Path {
    args.files.first().or(args.normal.as_ref()).or(args.depth.as_ref()).unwrap_or(&args.output)
}

fn write(
    args: &ViewArgs,
    target: &OutputFile,
    picture: &Picture,
    profile: ColorProfile,
) -> Result<()> {
    let Texels::Srgb8(texels) = &picture.texels else { return Ok(()) };
    let (width, height) = (picture.size.width as usize, picture.size.height as usize);
    let grid = TileGrid::from_straight_rgba(texels.as_flattened(), width, height, 0, 0);
    let options = ExportOptions { background: args.background, ..ExportOptions::default() };
    target.write(&grid, picture.size, &options, profile)
}

/// The document, and every file that was read for it.
fn open(args: &ViewArgs) -> Result<(Document, Vec<PathBuf>)> {
    let budget = args.limits.budget();
    let loose = args.normal.is_some() || args.depth.is_some() || args.mask.is_some();
    match args.files.as_slice() {
        [recipe]
            if !loose && recipe.extension().is_some_and(|e| e.eq_ignore_ascii_case("json")) =>
        {
            let files = TrackedFiles::new(RecipeFolder::folder_of(recipe));
            let text = read_file(recipe, budget.json_bytes)?;
            let read = |budget: &Budget| {
                recipe::read(
                    &text,
                    RecipeSource { file: recipe, files: &files, budget, onto: None },
                )
            };
            let (document, rounded) =
                sixteen_bit_paint::read_within_budget(recipe, &budget, read, |document| document)?;
            print_notes(recipe, rounded.as_slice());
            Ok((document, [vec![recipe.clone()], files.read_paths()].concat()))
        }
        _ => of_maps(args, &budget),
    }
}

/// A document with only a surface.
fn of_maps(args: &ViewArgs, budget: &Budget) -> Result<(Document, Vec<PathBuf>)> {
    let mut files = UserFiles::default();
    let sources = sources(args, &mut files)?;
    let files = TrackedFiles::new(files);
    let mut imports = sources.iter().map(|source| maps::import(source, &files, budget));
    // The first successful reading counts; if none succeeds, the first error is reported.
    let first = imports
        .next()
        .unwrap_or_else(|| Err(Error::invalid(named_file(args), "FILES", "no map is named")));
    let import = first.or_else(|refused| imports.find_map(Result::ok).ok_or(refused))?;
    let surface = Arc::new(import.surface);
    Ok((
        Document { surface: Some(surface.clone()), ..Document::empty(surface.size()) },
        files.read_paths(),
    ))
}

/// The possible roles of the files, in the order in which they are tried.
fn sources(args: &ViewArgs, files: &mut UserFiles) -> Result<Vec<SurfaceSource>> {
    let mut parts = [args.normal.clone(), args.depth.clone(), args.mask.clone()];
    if let ([layers], [None, None, _]) = (args.files.as_slice(), &parts)
        && layers.extension().is_some_and(|e| e.eq_ignore_ascii_case("exr"))
    {
        // One EXR may hold normals, depth, or both.
        let ways = [[true, true], [true, false], [false, true]];
        let mask = parts[2].take();
        return Ok(ways
            .map(|way| {
                let part = |held: bool| held.then(|| layers.clone());
                source([part(way[0]), part(way[1]), mask.clone()], files)
            })
            .into());
    }
    for file in &args.files {
        let part = match pairs::part_of(file).map(|(_, part)| part) {
            Some(pairs::MapPart::Depth) => 1,
            Some(pairs::MapPart::Mask) => 2,
            Some(pairs::MapPart::Normal) => 0,
            // A single picture counts as a normal map, the most common kind.
            None if args.files.len() == 1 => 0,
            None => {
                let reason = "its name does not tell which map it is; use --normal, --depth or \
                     --mask";
                return Err(Error::invalid(file, "FILES", reason));
            }
        };
        if let Some(other) = parts[part].replace(file.clone()) {
            let reason = format!(
                "it is the same kind of map as {}; view one surface at a time",
                other.display()
            );
            return Err(Error::invalid(file, "FILES", reason));
        }
    }
    Ok(vec![source(parts, files)])
}

fn source(parts: [Option<PathBuf>; 3], files: &mut UserFiles) -> SurfaceSource {
    let [normal, depth, mask] = parts.map(|part| part.map(|path| files.add(&path)));
    SurfaceSource {
        normal: normal.map(|file| MapSource { file, ..MapSource::default() }),
        depth: depth.map(|file| MapSource { file, ..MapSource::default() }),
        mask: mask.map(|file| MaskSource::File { file, channel: None, invert: false }),
        matrix: None,
    }
}

fn find_layer<'a>(args: &ViewArgs, document: &'a Document, name: &str) -> Result<&'a Layer> {
    document.layer_named(name).map(|layer| &**layer).ok_or_else(|| {
        let names: Vec<_> =
            document.walk().iter().map(|(_, layer)| format!("“{}”", layer.name)).collect();
        let known = if names.is_empty() {
            "there are no layers".into()
        } else {
            format!("there are {}", names.join(", "))
        };
        Error::invalid(named_file(args), "--layer", format!("no layer is called “{name}”; {known}"))
    })
}
