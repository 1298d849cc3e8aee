//! Recipes: a document as JSON that names files next to it. Floor 5. The schema is
//! `docs/RECIPES.md`; a project's zip holds the same JSON and is read through the same [`Files`].
//!
//! | file | reads and writes |
//! |---|---|
//! | this one | the document itself: format, version, canvas |
//! | `surface` | normal map, depth map, mask and their conventions |
//! | `parts` | the parts of a shape |
//! | `layers` | what every layer has, and fills, pixels and groups |
//! | `images` | placed images, gradients, normal layers: operator, anchors, placement |
//! | `texts`, `paths` | what images are that are drawn from words or lines |
//! | `strokes` | strokes |
//! | `samples` | readings of the pen |
//! | `brush` | the numbers of a brush, its dynamics |
//! | `tips` | a brush's tip and its grain |
//! | `materials` | the materials that come with the program |
//! | `looks` | the looks and painted balls that come with the program |
//! | `presets` | the brushes that come with the program, and those in files of their own |
//! | `shading` | shading layers, radiance scaling |
//! | `light` | lights, terms, scalings and features |
//! | `masks` | layer masks |
//! | `transforms` | where the frames of layers lie |
//! | `selections` | selections |
//! | `effects` | effects of layers, and their light |
//! | `guides` | guides, assistants and symmetry |
//! | `palettes` | the palette of a document |
//! | `pictures` | the files that layers name, each decoded once |
//! | `version` | which version a document needs |
//! | `value` | the trait of values that replays write as recipes do |

mod adjustments;
mod brush;
mod brush_options;
mod dynamics;
mod effects;
mod form_drawings;
mod guides;
mod images;
mod layers;
mod light;
mod liquify;
mod looks;
mod masks;
mod materials;
mod normals;
mod palettes;
pub mod parts;
mod paths;
mod pictures;
mod presets;
mod samples;
mod selections;
mod shading;
mod strokes;
pub mod surface;
mod texts;
mod tips;
pub mod transforms;
pub mod value;
mod version;

pub use looks::{LiveLook, PaintedBall};
pub use materials::PartMaterial;
pub use presets::{
    BrushPreset, PresetGroup, brush_to_json, load_preset, preset, preset_brush, preset_names,
    presets, read_brush, write_preset,
};
pub use samples::parse;
pub use selections::{file as selection_file, with_selection, write_of_stroke};
pub use strokes::write_stroke;

use super::json::{Fields, JsonNode, JsonObject, Printer};
use super::{Budget, Files, RecipeFolder, files, maps};
use crate::document::{Document, Guides, SelectionList, SurfaceSource, SymmetrySettings};
use crate::math::{ColorProfile, Size};
use crate::paint::{Scene, Selection};
use crate::raster::Asset;
use crate::surface::{Surface, SurfaceError};
use crate::{Error, Result};
use pictures::PictureCache;
pub use pictures::TileGrids;
use serde_json::{Value, json};
use std::collections::{BTreeMap, HashMap};
use std::{path::Path, sync::Arc};
pub use version::VERSION;
use version::{has_unwrapped, is_of_second_version};

/// The source of a document.
#[derive(Clone, Copy)]
pub struct RecipeSource<'a> {
    /// The recipe, for messages.
    pub file: &'a Path,
    /// The files that it may name.
    pub files: &'a dyn Files,
    /// What it may take.
    pub budget: &'a Budget,
    /// Another object to put the painting on, in place of the document's own.
    pub onto: Option<OtherSurface<'a>>,
}

/// A surface that is not the document's own, and where its maps are.
#[derive(Clone, Copy)]
pub struct OtherSurface<'a> {
    /// The maps that it names.
    pub surface: &'a SurfaceSource,
    /// Files by name.
    pub files: &'a dyn Files,
}

/// Loads a recipe; the files it names are in its own folder or below.
pub fn load(file: &Path, budget: &Budget) -> Result<Document> {
    load_onto(file, budget, None)
}

/// Loads a recipe and puts it on another object; its canvas stays, the maps are fitted to it.
pub fn load_onto(file: &Path, budget: &Budget, onto: Option<OtherSurface>) -> Result<Document> {
    let text = files::read_file(file, budget.json_bytes)?;
    read(&text, RecipeSource { file, files: &RecipeFolder::folder_of(file), budget, onto })
}

/// Reads a document from its JSON.
pub fn read(text: &[u8], source: RecipeSource) -> Result<Document> {
    read_value(&parse(source.file, text, source.budget)?, source)
}

/// The same, with what was found in its maps and could not be carried over, a sentence each.
pub fn read_noting(text: &[u8], source: RecipeSource) -> Result<(Document, Vec<String>)> {
    let (document, notes) =
        read_unshaped(&parse(source.file, text, source.budget)?, source, TileGrids::new())?;
    let document = with_shape(document);
    let notes = [notes, document.notes_of_parts()].concat();
    Ok((document, notes))
}

/// Reads a document from JSON that is parsed already.
pub fn read_value(value: &Value, source: RecipeSource) -> Result<Document> {
    read_with_tiles(value, source, TileGrids::new())
}

/// As [`read_value`], with the pixels of some paint layers known already; they were within the
/// budget.
pub fn read_with_tiles(value: &Value, source: RecipeSource, tiles: TileGrids) -> Result<Document> {
    read_unshaped(value, source, tiles).map(|(document, _)| with_shape(document))
}

/// With the surface that its parts make, and what is selected of it.
fn with_shape(document: Document) -> Document {
    let document = document.reshaped();
    let active_selection = document.active_selection.clone().filter(|found| !found.is_empty());
    Document { active_selection, ..document }
}

/// A document whose surface is still that of its maps alone, for those who put pixels into its
/// layers before it is reshaped; with notes.
pub fn read_unshaped(
    value: &Value,
    source: RecipeSource,
    tiles: TileGrids,
) -> Result<(Document, Vec<String>)> {
    let mut root = JsonNode::root(source.file, value).fields()?;
    check_version(&mut root)?;
    let canvas = root.get("canvas").map(|node| canvas(&node, source)).transpose()?;
    let surface_node = root.get("surface");
    let own = match &surface_node {
        Some(node) => surface::read(node)?.map(|own| (own, node.clone())),
        None => None,
    };
    let layers = root.get("layers");
    let (selections, active) = (root.get("selections"), root.get("active_selection"));
    let effect_light = root
        .get("effect_light")
        .map_or(Ok(Default::default()), |node| effects::read_light(&node))?;
    let guides = root.get("guides").map_or(Ok(Guides::default()), |node| guides::read(&node))?;
    let assistants =
        root.get("assistants").map_or(Ok(Vec::new()), |node| guides::read_assistants(&node))?;
    let symmetry = root
        .get("symmetry")
        .map_or(Ok(SymmetrySettings::default()), |node| guides::read_symmetry(&node))?;
    let palette = root.get("palette").map_or(Ok(Arc::default()), |node| palettes::read(&node))?;
    let profile = root.one_of("profile", &ColorProfile::ALL, ColorProfile::default())?;
    root.finish()?;

    // Pictures in the document's profile stay as they are.
    let budget = Budget { profile, ..*source.budget };
    let source = RecipeSource { budget: &budget, ..source };
    let CanvasAndSurface { size, surface, files, notes: of_maps } =
        shape(canvas, own.as_ref(), source)?;
    let surface_source = source.onto.map(fit_source).or(own.map(|(own, _)| own)).map(Arc::new);
    let Budget { layers: layers_left, document_samples: samples_left, .. } = *source.budget;
    let pictures = PictureCache::knowing(tiles);
    let (known, attachments, notes) = (HashMap::new(), Vec::new(), of_maps);
    let mut reader = LayerReader {
        source,
        size,
        layers_left,
        samples_left,
        pictures,
        selections: known,
        attachments,
        notes,
    };
    let scene = Scene { size, surface: surface.clone() };
    // Those that follow the surface are found on the maps, and again once the parts have made
    // theirs.
    let mut selections =
        selections.map_or(Ok(Vec::new()), |node| reader.selections(&node, &scene))?;
    let active_selection = active.map(|node| reader.selection_of(&node)).transpose()?;
    let parts = match surface_node {
        Some(node) => node
            .fields()?
            .get("parts")
            .map(|node| reader.parts(&node))
            .transpose()?
            .unwrap_or_default(),
        None => Vec::new(),
    };
    selections.extend(reader.outline_selections(&parts, &selections));
    reader.attachments = parts.iter().map(|part| part.id.clone()).collect();
    let layers = layers.map_or(Ok(Vec::new()), |node| reader.layers(&node, 0))?;
    let bare = Document {
        size,
        profile,
        surface,
        surface_source,
        surface_files: Arc::new(files),
        parts: Arc::default(),
        layers,
        selections,
        active_selection,
        effect_light,
        guides: Arc::new(guides),
        assistants: Arc::new(assistants),
        symmetry,
        palette,
    };
    let document = match source.onto {
        _ if parts.is_empty() => bare,
        // Another object takes the place of the document's own, parts and all.
        Some(_) => bare.off_parts(parts),
        None => {
            source.budget.room_for_shape(
                source.file,
                &bare,
                &parts,
                reader.pictures.used_bytes(),
            )?;
            bare.with_parts_unshaped(parts)
        }
    };
    Ok((document, reader.notes))
}

/// The color profile that a document's JSON says, if it is one that is known.
pub fn profile_of(value: &Value) -> ColorProfile {
    value["profile"].as_str().and_then(ColorProfile::from_name).unwrap_or_default()
}

fn check_version(root: &mut Fields) -> Result<()> {
    root.one_of("format", &[((), "rilievo")], ())?;
    let Some(version) = root.get("version") else { return Ok(()) };
    let number = version.integer(1..=i64::MAX)?;
    if number > VERSION {
        let reason =
            format!("is {number}; this program reads up to {VERSION}, so a newer one is needed");
        return Err(version.refusal(reason));
    }
    Ok(())
}

fn canvas(node: &JsonNode, source: RecipeSource) -> Result<Size> {
    let mut fields = node.fields()?;
    let mut side = |name| fields.require(name)?.integer(1..=i64::from(u32::MAX));
    let (width, height) = (side("width")?, side("height")?);
    fields.finish()?;
    source.budget.size(source.file, width as u64, height as u64)
}

/// Puts a document on another object; the canvas stays, the maps are fitted to it.
pub fn put_onto(
    document: &Document,
    file: &Path,
    onto: OtherSurface,
    budget: &Budget,
) -> Result<Document> {
    let maps::ImportedSurface { surface, files, .. } =
        maps::import(onto.surface, onto.files, budget)?;
    let surface = Arc::new(surface)
        .onto(document.size, None)
        .map_err(|e| Error::unsupported_file(file, e))?;
    let surface_source = Some(Arc::new(fit_source(onto)));
    let surface_files = Arc::new(files);
    let bare = document.with_parts(Vec::new());
    let next = Document { surface: Some(surface), surface_source, surface_files, ..bare };
    Ok(next.with_selections_found())
}

struct CanvasAndSurface {
    size: Size,
    surface: Option<Arc<Surface>>,
    /// The files of its maps.
    files: BTreeMap<String, Asset>,
    notes: Vec<String>,
}

/// The size of the canvas (by default that of the document's own maps), and the surface fitted to
/// it.
fn shape(
    canvas: Option<Size>,
    own: Option<&(SurfaceSource, JsonNode)>,
    source: RecipeSource,
) -> Result<CanvasAndSurface> {
    let own_map = own.and_then(|(own, _)| own.map());
    // Another object keeps the document's canvas, so its own maps are read only if they determine
    // the size.
    let own = match own {
        Some((own, node)) if canvas.is_none() || source.onto.is_none() => {
            let import = maps::import(own, source.files, source.budget)
                .map_err(|e| node.name_in_error(e))?;
            Some((import, node))
        }
        _ => None,
    };
    let other = source.onto.map(|o| maps::import(o.surface, o.files, source.budget)).transpose()?;
    let no_surface = "is missing, and there is no normal or depth map to take the size from";
    let size = canvas
        .or(own.as_ref().map(|(import, _)| import.surface.size()))
        .or(other.as_ref().map(|import| import.surface.size()))
        .ok_or_else(|| Error::invalid(source.file, "canvas", no_surface))?;
    let (import, node) = match (other, own) {
        (Some(other), _) => (other, None),
        (None, Some((own, node))) => (own, Some(node)),
        (None, None) => {
            return Ok(CanvasAndSurface {
                size,
                surface: None,
                files: BTreeMap::new(),
                notes: Vec::new(),
            });
        }
    };
    let maps::ImportedSurface { surface, findings, files } = import;
    let refused = |e: SurfaceError| match node {
        Some(node) => node.refusal(e),
        None => Error::unsupported_file(source.file, e),
    };
    let map = node.and(own_map);
    let surface = Some(Arc::new(surface).onto(size, map.as_ref()).map_err(refused)?);
    Ok(CanvasAndSurface { size, surface, files, notes: findings.notes })
}

/// Another object is fitted to the canvas, wherever its maps were on its own canvas.
fn fit_source(onto: OtherSurface) -> SurfaceSource {
    SurfaceSource { matrix: None, ..onto.surface.clone() }
}

/// Reads layers, once the canvas is known.
struct LayerReader<'a> {
    source: RecipeSource<'a>,
    size: Size,
    /// How many more layers the budget allows.
    layers_left: usize,
    /// And readings of the pen.
    samples_left: usize,
    pictures: PictureCache,
    /// By their ids, with the names of those that are kept.
    selections: HashMap<String, (Arc<Selection>, Option<String>)>,
    /// The ids of the parts that layers and strokes may lie on.
    attachments: Vec<String>,
    /// What could not be carried over, a sentence each.
    notes: Vec<String>,
}

/// The JSON that [`read`] reads back to an equal document. Files are named, not written: a project
/// stores its pixels next to it under the same names.
pub fn write(document: &Document) -> Value {
    write_naming(document, &SelectionList::of(document))
}

/// The same for a document whose selections are in a list; it may lack some of their strokes.
pub fn write_naming(document: &Document, list: &SelectionList) -> Value {
    let mut out = head(document, list);
    out.set("layers", layers::write(&document.layers, document.size, list));
    out.into_value()
}

/// The same as text. However many strokes there are, only one at a time is in memory as values.
pub fn print(document: &Document) -> String {
    let mut out = Printer::default();
    out.open_object(None);
    let list = SelectionList::of(document);
    head(document, &list).fields().iter().for_each(|(key, value)| out.value(Some(key), value));
    layers::print(&document.layers, document.size, &list, &mut out);
    out.close_object();
    out.into_text()
}

/// All but the layers.
fn head(document: &Document, list: &SelectionList) -> JsonObject {
    let mut out = JsonObject::default();
    out.set("format", "rilievo".into());
    let is_second = is_of_second_version(document)
        || selections::is_needed(document, list)
        || has_unwrapped(document)
        || effects::is_needed(document)
        || guides::is_needed(document)
        || palettes::is_needed(document)
        || document.profile != ColorProfile::default();
    out.set("version", if is_second { VERSION } else { 1 }.into());
    out.set("canvas", json!({ "width": document.size.width, "height": document.size.height }));
    if document.profile != ColorProfile::default() {
        out.set("profile", document.profile.name().into());
    }
    let mut surface = document.surface_source.as_deref().map(surface::write).unwrap_or_default();
    if !document.parts.is_empty() {
        surface.set("parts", parts::write(document, list));
    }
    out.object("surface", surface);
    selections::write(&mut out, document, list);
    effects::write_light(&mut out, document.effect_light);
    guides::write(&mut out, document);
    palettes::write(&mut out, document);
    out
}
