//! The files that a document is made from, under names within the project; each is stored once, as
//! its own bytes. Floor 5. A picture that came from no file is encoded without loss.

use crate::Result;
use crate::document::EncodedPixels;
use crate::document::source::{
    DepthConvention, DepthEncoding, MapSource, MaskSource, Near, NormalConvention, NormalEncoding,
    SurfaceSource,
};
use crate::document::{
    Content, Document, Layer, LayerId, MaskKind, Part, PartKind, Parts, SelectionList,
};
use crate::exr;
use crate::math::Rect;
use crate::paint::Selection;
use crate::raster::{Asset, Picture, Plane};
use crate::recipe;
use crate::surface::Surface;
use crate::{picture, pixels};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

/// The folder of the files in the zip; not below `data/`, where every entry belongs to a layer of
/// `stack.xml`.
const FOLDER: &str = "rilievo/files/";
const PIXELS: &str = "rilievo/pixels/";

/// The files of a document in the order they are first named.
#[derive(Default)]
pub struct AssetList {
    files: Vec<(String, Asset)>,
    /// In lower case: names must differ in more than capitals.
    taken: BTreeSet<String>,
    made: MadeFiles,
}

/// Files made from data that came from no file, by its address in memory; kept, so that it is
/// encoded once.
#[derive(Default)]
pub struct MadeFiles {
    pictures: BTreeMap<usize, (Picture, (Asset, &'static str))>,
    masks: BTreeMap<usize, (Arc<Plane<u8>>, Asset)>,
    selections: BTreeMap<usize, (Arc<Selection>, Asset)>,
    /// The maps and the mask of a surface.
    surfaces: BTreeMap<usize, (Arc<Surface>, Asset, Asset)>,
}

/// The pixels of paint layers, and the names under which they are stored already.
pub struct StoredPixels<'a> {
    pub pixels: &'a BTreeMap<LayerId, EncodedPixels>,
    /// Files of `data/` that hold all of a layer's pixels.
    pub shared: &'a BTreeMap<LayerId, String>,
}

impl AssetList {
    /// Starts with what was encoded for an earlier version of the document.
    pub fn continue_from(made: MadeFiles) -> Self {
        Self { made, ..Self::default() }
    }

    pub fn into_made(self) -> MadeFiles {
        self.made
    }

    pub fn files(&self) -> &[(String, Asset)] {
        &self.files
    }

    /// The document with every file under its name in the project.
    pub fn rename(
        &mut self,
        file: &Path,
        document: &Document,
        painted: &StoredPixels,
    ) -> Result<Document> {
        let source = document
            .maps_surface()
            .map(|surface| self.surface(file, surface, document))
            .transpose()?;
        let layers = self.layers(file, &document.layers, painted)?;
        for (place, selection) in
            SelectionList::of(document).all().enumerate().filter(|(_, s)| s.made.is_none())
        {
            let (name, mask) =
                (recipe::selection_file(place), self.made.selection(file, selection)?);
            self.taken.insert(name.to_lowercase());
            self.files.push((name, mask));
        }
        let parts = self.parts(file, &document.parts)?;
        Ok(Document { surface_source: source.map(Arc::new), layers, parts, ..document.clone() })
    }

    /// Parts with their pictures of coverage under their names in the project.
    fn parts(&mut self, file: &Path, parts: &Arc<Parts>) -> Result<Arc<Parts>> {
        let mut next = Parts::clone(parts);
        for part in &mut next.list {
            let mut named = Part::clone(part);
            for coverage in named.files_mut() {
                let asset = self.made.mask(file, &coverage.coverage)?;
                coverage.file =
                    self.add(&name_with_extension(&coverage.file, "outline", "png"), asset);
            }
            if let PartKind::Maps(maps) = &mut named.kind {
                let mut source = SurfaceSource::clone(&maps.source);
                for name in files_of_mut(&mut source) {
                    if let Some(asset) = maps.files.get(name.as_str()) {
                        *name = self.add(name, asset.clone());
                    }
                }
                maps.source = Arc::new(source);
            }
            *part = Arc::new(named);
        }
        Ok(Arc::new(next))
    }

    fn layers(
        &mut self,
        file: &Path,
        layers: &[Arc<Layer>],
        painted: &StoredPixels,
    ) -> Result<Vec<Arc<Layer>>> {
        layers.iter().map(|layer| self.layer(file, layer, painted).map(Arc::new)).collect()
    }

    fn layer(&mut self, file: &Path, layer: &Layer, painted: &StoredPixels) -> Result<Layer> {
        let mut next = layer.clone();
        if let Some(MaskKind::File { file: name, coverage }) =
            next.mask.as_mut().map(|mask| &mut mask.kind)
        {
            *name = {
                let mask = self.made.mask(file, coverage)?;
                self.add(&name_with_extension(name, "mask", "png"), mask)
            };
        }
        match &mut next.content {
            Content::Pixels(paint) => {
                let Some(encoded) = painted.pixels.get(&layer.id) else { return Ok(next) };
                (paint.x, paint.y) = (encoded.x, encoded.y);
                paint.file = match painted.shared.get(&layer.id) {
                    Some(shared) => shared.clone(),
                    None => self.add_in(
                        PIXELS,
                        &name_with_extension(&layer.name, "paint", "png"),
                        encoded.file.clone(),
                    ),
                };
            }
            Content::Group(group) => group.layers = self.layers(file, &group.layers, painted)?,
            content => {
                *content =
                    content.with_files(&mut |name, picture| self.picture(file, name, picture))?
            }
        }
        Ok(next)
    }

    /// The maps as their original files; if any of these is unknown, the surface itself.
    fn surface(
        &mut self,
        file: &Path,
        surface: &Arc<Surface>,
        document: &Document,
    ) -> Result<SurfaceSource> {
        let known = document.surface_source.as_deref();
        let known = known.filter(|source| {
            files_of(source).all(|name| document.surface_files.contains_key(name))
        });
        let Some(source) = known else { return self.write_made_surface(file, surface) };
        let mut source = source.clone();
        for name in files_of_mut(&mut source) {
            if let Some(asset) = document.surface_files.get(name.as_str()) {
                *name = self.add(name, asset.clone());
            }
        }
        Ok(source)
    }

    /// A surface that came from no file: normals and depth of 32 bits, and its coverage.
    fn write_made_surface(&mut self, file: &Path, surface: &Arc<Surface>) -> Result<SurfaceSource> {
        let (maps, mask) = self.made.surface(file, surface)?;
        let (maps, mask) = (self.add("surface.exr", maps), self.add("surface-mask.png", mask));
        let opengl = NormalConvention::from_word("opengl").unwrap_or_default();
        let depth = DepthConvention {
            near: Near::Low,
            encoding: Some(DepthEncoding::Planar),
            range_px: Some(surface.depth_range_px()),
            ..DepthConvention::default()
        };
        Ok(SurfaceSource {
            normal: Some(MapSource {
                file: maps.clone(),
                channel: Some("N".into()),
                convention: NormalConvention { encoding: Some(NormalEncoding::Signed), ..opengl },
            }),
            depth: Some(MapSource { file: maps, channel: Some("Z".into()), convention: depth }),
            mask: Some(MaskSource::File { file: mask, channel: None, invert: false }),
            matrix: None,
        })
    }

    fn picture(&mut self, file: &Path, name: &str, picture: &Picture) -> Result<String> {
        if let Some(asset) = &picture.encoded {
            return Ok(self.add(name, asset.clone()));
        }
        let (asset, extension) = self.made.picture(file, picture)?;
        Ok(self.add(&name_with_extension(name, "picture", extension), asset))
    }

    fn add(&mut self, name: &str, asset: Asset) -> String {
        self.add_in(FOLDER, name, asset)
    }

    /// The entry that holds these bytes: an existing one, or a new one with the name of the file.
    fn add_in(&mut self, folder: &str, name: &str, asset: Asset) -> String {
        let known =
            self.files.iter().find(|(known, held)| known.starts_with(folder) && *held == asset);
        if let Some((known, _)) = known {
            return known.clone();
        }
        let plain = plain_name(name);
        let (stem, extension) = plain
            .rsplit_once('.')
            .map_or((plain.as_str(), String::new()), |(s, e)| (s, format!(".{e}")));
        let numbered =
            |n: usize| if n == 1 { plain.clone() } else { format!("{stem}-{n}{extension}") };
        let mut n = 1;
        while !self.taken.insert(format!("{folder}{}", numbered(n)).to_lowercase()) {
            n += 1;
        }
        let entry = format!("{folder}{}", numbered(n));
        self.files.push((entry.clone(), asset));
        entry
    }
}

/// The names of a surface's files.
fn files_of(source: &SurfaceSource) -> impl Iterator<Item = &str> {
    let normal = source.normal.as_ref().map(|map| map.file.as_str());
    let depth = source.depth.as_ref().map(|map| map.file.as_str());
    let mask = match &source.mask {
        Some(MaskSource::File { file, .. }) => Some(file.as_str()),
        Some(MaskSource::Flat) | None => None,
    };
    [normal, depth, mask].into_iter().flatten()
}

fn files_of_mut(source: &mut SurfaceSource) -> impl Iterator<Item = &mut String> {
    let normal = source.normal.as_mut().map(|map| &mut map.file);
    let depth = source.depth.as_mut().map(|map| &mut map.file);
    let mask = match &mut source.mask {
        Some(MaskSource::File { file, .. }) => Some(file),
        Some(MaskSource::Flat) | None => None,
    };
    [normal, depth, mask].into_iter().flatten()
}

impl MadeFiles {
    /// Its file, and the extension of that.
    fn picture(&mut self, file: &Path, picture: &Picture) -> Result<(Asset, &'static str)> {
        if let Some((_, known)) = self.pictures.get(&picture.place()) {
            return Ok(known.clone());
        }
        let made = picture::encode(file, picture)?;
        self.pictures.insert(picture.place(), (picture.clone(), made.clone()));
        Ok(made)
    }

    fn mask(&mut self, file: &Path, coverage: &Arc<Plane<u8>>) -> Result<Asset> {
        let key = Arc::as_ptr(coverage) as usize;
        if let Some((_, known)) = self.masks.get(&key) {
            return Ok(known.clone());
        }
        let asset = pixels::encode_coverage(file, coverage)?;
        self.masks.insert(key, (coverage.clone(), asset.clone()));
        Ok(asset)
    }

    /// The rectangle that a selection covers.
    fn selection(&mut self, file: &Path, selection: &Arc<Selection>) -> Result<Asset> {
        let key = Arc::as_ptr(selection) as usize;
        if let Some((_, known)) = self.selections.get(&key) {
            return Ok(known.clone());
        }
        let covered = selection.coverage.covered_rect();
        let rect = if covered.is_empty() { Rect::new(0, 0, 1, 1) } else { covered };
        let asset = pixels::encode_coverage(file, &selection.coverage.to_plane(rect))?;
        self.selections.insert(key, (selection.clone(), asset.clone()));
        Ok(asset)
    }

    /// Normals and depth of 32 bits, and the coverage.
    fn surface(&mut self, file: &Path, surface: &Arc<Surface>) -> Result<(Asset, Asset)> {
        let key = Arc::as_ptr(surface) as usize;
        if let Some((_, maps, mask)) = self.surfaces.get(&key) {
            return Ok((maps.clone(), mask.clone()));
        }
        let size = surface.size();
        let pixels = || {
            (0..size.height as usize).flat_map(|y| (0..size.width as usize).map(move |x| (x, y)))
        };
        let normal = |c: usize| pixels().map(|(x, y)| surface.normal(x, y)[c]).collect();
        let depth = pixels().map(|(x, y)| surface.depth(x, y)).collect();
        let channels =
            vec![("N.X", normal(0)), ("N.Y", normal(1)), ("N.Z", normal(2)), ("Z", depth)];
        let maps: Asset = exr::encode_channels(file, size, channels)?.into();
        let mask = pixels::encode_coverage(file, surface.coverage_plane())?;
        self.surfaces.insert(key, (surface.clone(), maps.clone(), mask.clone()));
        Ok((maps, mask))
    }
}

/// The last part of a name, of letters, digits, dots and hyphens; never empty, never hidden, not
/// too long.
fn plain_name(name: &str) -> String {
    let last = name.rsplit(['/', '\\']).next().unwrap_or_default();
    let plain = |c: char| if c.is_alphanumeric() || ".-_".contains(c) { c } else { '-' };
    let plain: String = last.trim_start_matches('.').chars().map(plain).collect();
    let long = plain.chars().count();
    let plain: String = plain.chars().skip(long.saturating_sub(80)).collect();
    if plain.trim_matches(['.', '-']).is_empty() {
        "file".into()
    } else {
        plain.trim_start_matches('.').to_owned()
    }
}

/// A name that ends as the file does.
fn name_with_extension(name: &str, otherwise: &str, extension: &str) -> String {
    let last = plain_name(if name.is_empty() { otherwise } else { name });
    let stem = last.strip_suffix(&format!(".{extension}")).unwrap_or(&last);
    format!("{stem}.{extension}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_stored_once_and_others_of_its_name_beside_it() {
        let mut assets = AssetList::default();
        let (a, b): (Asset, Asset) = (vec![1].into(), vec![2].into());
        assert_eq!(assets.add("/home/me/Wood.png", a.clone()), "rilievo/files/Wood.png");
        assert_eq!(assets.add("other/wood.png", b), "rilievo/files/wood-2.png");
        assert_eq!(assets.add("x.png", vec![1].into()), "rilievo/files/Wood.png", "the same bytes");
        assert_eq!(assets.files().len(), 2);
    }

    #[test]
    fn names_are_plain_and_stay_as_they_are_the_next_time() {
        let long = "x".repeat(300) + ".png";
        for name in ["a b?.png", "..", ".hidden", "", "C:\\a\\b.exr", "é.png", "a/", &long] {
            let plain = plain_name(name);
            assert!(crate::files::refusal(&plain).is_none(), "{name} became {plain}");
            assert_eq!(plain_name(&plain), plain);
        }
        assert_eq!(name_with_extension("a.png", "x", "png"), "a.png");
        assert_eq!(name_with_extension("photo.jpg", "x", "png"), "photo.jpg.png");
        assert_eq!(name_with_extension("", "x", "png"), "x.png");
    }
}
