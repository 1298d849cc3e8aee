//! The files that layers name: each is read and decoded once, however many layers use it.
//! Floor 5. Decoding is in `io::picture`.

use super::RecipeSource;
use super::value::RecipeValue;
use crate::document::parts::PartMaps;
use crate::document::source::NormalConvention;
use crate::json::JsonNode;
use crate::maps::detail;
use crate::math::{Size, Vec3};
use crate::paint::{Adjust, LivePath, PictureOrigin, PictureSource, Text};
use crate::picture::Painted;
use crate::raster::{CoverageGrid, Picture, Plane, TileGrid, blur};
use crate::surface::DetailMap;
use crate::{Error, Result};
use crate::{files, picture, text};
use std::{collections::HashMap, sync::Arc};

/// What the names of files of outlines begin with for texts that have none yet.
const TEXTS: &str = "text-";

/// The pixels of paint layers by file and corner.
pub type TileGrids = HashMap<(String, i32, i32), TileGrid>;

/// What has been decoded in one load, by name.
#[derive(Default)]
pub struct PictureCache {
    pictures: HashMap<String, Picture>,
    /// By set of adjustments, so that layers share the adjusted texture as well.
    sources: HashMap<String, Vec<PictureSource>>,
    coverages: HashMap<String, Arc<Plane<u8>>>,
    maps: Vec<PartMaps>,
    tiles: TileGrids,
    details: Vec<CachedDetail>,
    texts: usize,
    used_px: u64,
    searched_px: u64,
    used_bytes: u64,
}

/// A detail map as it was read.
struct CachedDetail {
    file: String,
    convention: NormalConvention,
    blur_px: f32,
    map: Arc<DetailMap>,
}

impl PictureCache {
    pub fn knowing(tiles: TileGrids) -> Self {
        Self { tiles, ..Self::default() }
    }

    /// The picture that a field names, with its adjustments.
    pub fn source(
        &mut self,
        source: RecipeSource,
        name: &JsonNode,
        adjust: Adjust,
    ) -> Result<PictureSource> {
        let picture = self.picture(source, name)?;
        let name = name.text()?;
        let known = self.sources.entry(name.to_owned()).or_default();
        if let Some(same) = known.iter().find(|s| s.adjust == adjust) {
            return Ok(same.clone());
        }
        known.push(PictureSource::new(name.to_owned(), picture, adjust));
        Ok(known[known.len() - 1].clone())
    }

    /// A text that no file holds the outlines of, laid out in the fonts of this machine.
    pub fn text(
        &mut self,
        source: RecipeSource,
        node: &JsonNode,
        text: &Text,
        adjust: Adjust,
    ) -> Result<PictureSource> {
        let laid = text::lay_out_inked(text, source.budget).map_err(|e| node.name_in_error(e))?;
        let size = laid.picture.size;
        self.spend(source, size, laid.picture.bytes() + size.area() * 6)?;
        self.texts += 1;
        let file = format!("{TEXTS}{}.svg", self.texts);
        let mut made = PictureSource::new(file, laid.picture, adjust);
        made.origin = PictureOrigin::Text(Arc::new(laid.text));
        Ok(made)
    }

    /// A path, drawn at the size of its plane.
    pub fn path(
        &mut self,
        source: RecipeSource,
        node: &JsonNode,
        adjust: Adjust,
    ) -> Result<PictureSource> {
        let path = LivePath::from_json(node)?;
        path.fits().map_err(|why| node.refusal(why))?;
        let size = path.picture_size();
        self.spend(source, size, size.area() * 10)?;
        Ok(PictureSource::of_path(path, adjust))
    }

    /// The picture that a field names, as it is.
    pub fn picture(&mut self, source: RecipeSource, name: &JsonNode) -> Result<Picture> {
        if let Some(known) = self.pictures.get(name.text()?) {
            return Ok(known.clone());
        }
        let bytes = bytes(source, name)?;
        let path = source.files.path(name.text()?);
        let picture =
            picture::decode(&path, &bytes, source.budget).map_err(|e| name.name_in_error(e))?;
        // Counted with it is the texture that it is sampled through, in bytes and with its mip
        // levels.
        self.spend(source, picture.size, picture.bytes() + picture.size.area() * 6)?;
        self.pictures.insert(name.text()?.to_owned(), picture.clone());
        Ok(picture)
    }

    /// The detail normals of a picture that a field names, blurred by `blur_px` texels; read again
    /// for each convention.
    pub fn detail(
        &mut self,
        source: RecipeSource,
        name: &JsonNode,
        convention: &NormalConvention,
        blur_px: f32,
    ) -> Result<Arc<DetailMap>> {
        let file = name.text()?;
        let is_same = |d: &&CachedDetail| {
            d.file == file && d.convention == *convention && d.blur_px == blur_px
        };
        if let Some(known) = self.details.iter().find(is_same) {
            return Ok(known.map.clone());
        }
        let bytes = bytes(source, name)?;
        let read = detail::read(&source.files.path(file), &bytes, convention, source.budget);
        let normals = read.map_err(|e| name.name_in_error(e))?;
        self.spend(source, normals.size(), normals.size().area() * 2 * size_of::<Vec3>())?;
        let map = Arc::new(DetailMap::new(blur_normals(normals, blur_px)));
        let (file, convention) = (file.to_owned(), convention.clone());
        self.details.push(CachedDetail { file, convention, blur_px, map: map.clone() });
        Ok(map)
    }

    /// Bytes that the pictures read so far take.
    pub fn used_bytes(&self) -> u64 {
        self.used_bytes
    }

    /// Counts the pixels of a document: many pictures, each within its own limit, could fill the
    /// memory together.
    pub(super) fn spend(&mut self, source: RecipeSource, size: Size, bytes: usize) -> Result<()> {
        self.hold(source, bytes)?;
        self.used_px += size.area() as u64;
        if self.used_px > source.budget.document_px {
            let reason = format!(
                "its pictures hold more than {} pixels together",
                source.budget.document_px
            );
            return Err(Error::too_large(source.file, reason));
        }
        Ok(())
    }

    /// Counts a search for a region of the surface on the canvas.
    pub(super) fn search(&mut self, source: RecipeSource, canvas: Size) -> Result<()> {
        self.searched_px += canvas.area() as u64;
        if self.searched_px > source.budget.region_px {
            let reason = format!(
                "its selections by the surface cover more than {} px",
                source.budget.region_px
            );
            return Err(Error::too_large(source.file, reason));
        }
        Ok(())
    }

    /// Counts bytes alone.
    pub(super) fn hold(&mut self, source: RecipeSource, bytes: usize) -> Result<()> {
        self.used_bytes += bytes as u64;
        source.budget.room(source.file, "what its layers hold", self.used_bytes)
    }

    /// The pixels that a field names, cut into tiles at an offset on the canvas.
    pub fn tiles(
        &mut self,
        source: RecipeSource,
        name: &JsonNode,
        x: i32,
        y: i32,
    ) -> Result<(String, TileGrid)> {
        let key = (name.text()?.to_owned(), x, y);
        if !self.tiles.contains_key(&key) {
            // Another layer may show the same file.
            let painted = match self.pictures.get(name.text()?) {
                Some(picture) => Painted {
                    size: picture.size,
                    tiles: picture::to_tiles(picture, x, y),
                    warning: None,
                },
                None => {
                    let (bytes, path) = (bytes(source, name)?, source.files.path(name.text()?));
                    picture::decode_paint(&path, &bytes, x, y, source.budget)
                        .map_err(|e| name.name_in_error(e))?
                }
            };
            let tiles = if source.budget.sixteen_bit_paint {
                painted.tiles
            } else {
                painted.tiles.rounded()
            };
            self.spend(source, painted.size, tiles.bytes())?;
            self.tiles.insert(key.clone(), tiles);
        }
        let tiles = self.tiles.get(&key).cloned().unwrap_or_default();
        Ok((key.0, tiles))
    }

    /// The mask of a selection that a field names, its corner at a canvas pixel.
    pub fn selection(
        &mut self,
        source: RecipeSource,
        name: &JsonNode,
        x: i32,
        y: i32,
    ) -> Result<CoverageGrid> {
        let bytes = bytes(source, name)?;
        let plane =
            picture::decode_coverage(&source.files.path(name.text()?), &bytes, source.budget);
        let plane = plane.map_err(|e| name.name_in_error(e))?;
        self.spend(source, plane.size(), plane.size().area())?;
        Ok(CoverageGrid::from_plane(&plane, x, y))
    }

    /// A mask that is known already by its name.
    pub fn know_coverage(&mut self, file: &str, coverage: &Arc<Plane<u8>>) {
        self.coverages.insert(file.to_owned(), coverage.clone());
    }

    pub fn know_maps(&mut self, maps: &PartMaps) {
        self.maps.push(maps.clone());
    }

    /// Those of the maps that are known already which are meant.
    pub fn cached_maps(&self, is_meant: impl Fn(&PartMaps) -> bool) -> Option<PartMaps> {
        self.maps.iter().find(|maps| is_meant(maps)).cloned()
    }

    /// The mask that a field names; it has the canvas's size.
    pub fn coverage(
        &mut self,
        source: RecipeSource,
        name: &JsonNode,
        canvas: Option<Size>,
    ) -> Result<(String, Arc<Plane<u8>>)> {
        let file = name.text()?.to_owned();
        let fits = |plane: &Plane<u8>| canvas.is_none_or(|canvas| canvas == plane.size());
        if let Some(known) = self.coverages.get(&file).filter(|known| fits(known)) {
            return Ok((file, known.clone()));
        }
        let bytes = bytes(source, name)?;
        let plane = picture::decode_coverage(&source.files.path(&file), &bytes, source.budget);
        let plane = Arc::new(plane.map_err(|e| name.name_in_error(e))?);
        if let Some(canvas) = canvas.filter(|_| !fits(&plane)) {
            return Err(
                name.refusal(format!("“{file}” has {} pixels, the canvas {canvas}", plane.size()))
            );
        }
        self.coverages.insert(file.clone(), plane.clone());
        Ok((file, plane))
    }
}

/// Normals averaged with their neighbors; their lengths do not matter.
fn blur_normals(normals: Plane<Vec3>, blur_px: f32) -> Plane<Vec3> {
    let pixels: Vec<[f32; 3]> = normals.values().iter().map(|n| n.to_array()).collect();
    let blurred = blur::gaussian_pixels(normals.size(), &pixels, blur_px);
    Plane::from_values(normals.size(), blurred.into_iter().map(Vec3::from).collect())
        .unwrap_or(normals)
}

/// The bytes of a file that a field names. A name that leaves the document's folder is refused
/// before anything is opened.
fn bytes(source: RecipeSource, name: &JsonNode) -> Result<Vec<u8>> {
    let text = name.text()?;
    if let Some(reason) = files::refusal(text) {
        return Err(name.refusal(format!("“{text}” is refused: {reason}")));
    }
    source.files.read(text, source.budget).map_err(|e| name.name_in_error(e))
}
