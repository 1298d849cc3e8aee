//! Whether two documents hold the same, however it was made and wherever it lies in memory: a save
//! is compared by this. Floor 4. Names of files are not part of it: a project gives them its own.
//! Not here: what must be redrawn (`diff`).

use super::source::{MaskSource, SurfaceSource};
use super::{
    Content, DetailSource, Document, Layer, LayerMask, MaskKind, NamedSelection, Part, StrokeList,
};
use crate::memory::free_bytes;
use crate::paint::Stroke;
use crate::raster::tile::TILE_AREA;
use crate::raster::{Plane, TileGrid};
use crate::surface::Surface;
use std::sync::Arc;

impl Document {
    /// What differs in the other document, in a few words; `None` if the two are equal.
    pub fn difference(&self, other: &Document) -> Option<String> {
        if self.size != other.size {
            return Some("the size of the canvas".into());
        }
        if self.profile != other.profile {
            return Some("the color profile".into());
        }
        surface(self, other)
            .or_else(|| parts(&self.parts.list, &other.parts.list))
            .or_else(|| layers(&self.layers, &other.layers))
            .or_else(|| shape(self, other))
            .or_else(|| selections(self, other))
            .or_else(|| (self.guides != other.guides).then(|| "the guides".into()))
            .or_else(|| {
                (self.effect_light != other.effect_light).then(|| "the effects' light".into())
            })
            .or_else(|| (self.assistants != other.assistants).then(|| "the assistants".into()))
            .or_else(|| (self.symmetry != other.symmetry).then(|| "the symmetry".into()))
            .or_else(|| (self.palette != other.palette).then(|| "the palette".into()))
    }
}

/// Those kept by name, and the active one.
fn selections(a: &Document, b: &Document) -> Option<String> {
    let same_kept = |(a, b): (&NamedSelection, &NamedSelection)| {
        a.name == b.name
            && (Arc::ptr_eq(&a.selection, &b.selection) || a.selection.is_same(&b.selection))
    };
    if a.selections.len() != b.selections.len()
        || !a.selections.iter().zip(&b.selections).all(same_kept)
    {
        return Some("the selections kept by name".into());
    }
    let same_active = match (&a.active_selection, &b.active_selection) {
        (None, None) => true,
        (Some(a), Some(b)) => Arc::ptr_eq(a, b) || a.is_same(b),
        _ => false,
    };
    (!same_active).then(|| "the selection".into())
}

fn surface(a: &Document, b: &Document) -> Option<String> {
    let is_same = match (a.maps_surface(), b.maps_surface()) {
        (None, None) => true,
        (Some(x), Some(y)) => {
            let source = a.surface_source.as_deref().filter(|source| has_files(source, a));
            match (source, b.surface_source.as_deref()) {
                (Some(source), Some(other)) => {
                    x.size() == y.size() && are_same_maps(a, source, b, other)
                }
                // One that came from no file is stored as maps made of it, which are normalized
                // when they are read.
                (None, _) => x.size() == y.size(),
                (Some(_), None) => false,
            }
        }
        _ => false,
    };
    (!is_same).then(|| "the surface".into())
}

fn parts(a: &[Arc<Part>], b: &[Arc<Part>]) -> Option<String> {
    if a.len() != b.len() {
        return Some(format!("the number of parts of its shape, {} and not {}", b.len(), a.len()));
    }
    let (part, _) = a.iter().zip(b).find(|(a, b)| !Arc::ptr_eq(a, b) && a != b)?;
    Some(format!("“{}” among the parts of its shape", part.name))
}

/// What the same parts make of the same layers on the same maps; other maps were fitted again,
/// which may round them.
fn shape(a: &Document, b: &Document) -> Option<String> {
    let is_same = |a: Option<&Arc<Surface>>, b: Option<&Arc<Surface>>| match (a, b) {
        (Some(a), Some(b)) => Arc::ptr_eq(a, b) || a.has_same_maps(b),
        (a, b) => a.is_none() && b.is_none(),
    };
    let follows = !a.parts.is_empty() && is_same(a.maps_surface(), b.maps_surface());
    let is_made = match (&a.surface, &b.surface) {
        (Some(a), Some(b)) => is_alike(a, b),
        // Beside the first there is no room to make it once more; what it is made of was compared.
        (Some(_), None) => b.shape_fits_in(free_bytes()).is_err(),
        (a, b) => a.is_none() && b.is_none(),
    };
    (follows && !is_made).then(|| "the shape that its parts make".into())
}

/// A shape that was moved and one that was made at its place may be rounded differently, so that a
/// few pixels at an edge are of another part: one in so many.
const ONE_IN: usize = 1000;
/// Less is not seen, of 1.
const LEAST_SEEN: f32 = 1.0 / 256.0;

fn is_alike(a: &Surface, b: &Surface) -> bool {
    let (range, other) = (a.depth_range_px(), b.depth_range_px());
    if a.size() != b.size() || (range - other).abs() > LEAST_SEEN * range.max(1.0) {
        return false;
    }
    let apart = |a: &Plane<f32>, b: &Plane<f32>| -> Vec<bool> {
        a.values().iter().zip(b.values()).map(|(a, b)| (a - b).abs() > LEAST_SEEN).collect()
    };
    let [x, y, z] = a.normal_planes();
    let [u, v, w] = b.normal_planes();
    let planes = [apart(x, u), apart(y, v), apart(z, w), apart(a.depth_plane(), b.depth_plane())];
    let covered = a.coverage_plane().values().iter().zip(b.coverage_plane().values());
    let differs = |(i, (a, b)): (usize, (&u8, &u8))| {
        a.abs_diff(*b) > 1 || planes.iter().any(|plane| plane[i])
    };
    covered.enumerate().filter(|pixel| differs(*pixel)).count() <= a.size().area() / ONE_IN
}

/// Whether the files of a surface's maps are known, so that they themselves are stored.
fn has_files(source: &SurfaceSource, document: &Document) -> bool {
    files_of(source).all(|file| document.surface_files.contains_key(file))
}

/// The same files, read in the same way: the surface follows from them. One that was scaled since
/// is fitted again when it is read, which may round it differently.
fn are_same_maps(
    a: &Document,
    source: &SurfaceSource,
    b: &Document,
    other: &SurfaceSource,
) -> bool {
    let mut files = files_of(source).zip(files_of(other));
    without_names(source) == without_names(other)
        && files.all(|(x, y)| {
            a.surface_files.get(x).is_some_and(|file| b.surface_files.get(y) == Some(file))
        })
}

fn files_of(source: &SurfaceSource) -> impl Iterator<Item = &str> {
    let mask = match &source.mask {
        Some(MaskSource::File { file, .. }) => Some(file.as_str()),
        _ => None,
    };
    let (normal, depth) = (source.normal.as_ref(), source.depth.as_ref());
    [normal.map(|map| map.file.as_str()), depth.map(|map| map.file.as_str()), mask]
        .into_iter()
        .flatten()
}

fn without_names(source: &SurfaceSource) -> SurfaceSource {
    let mut bare = source.clone();
    bare.normal.iter_mut().for_each(|map| map.file.clear());
    bare.depth.iter_mut().for_each(|map| map.file.clear());
    if let Some(MaskSource::File { file, .. }) = &mut bare.mask {
        file.clear();
    }
    bare
}

fn layers(a: &[Arc<Layer>], b: &[Arc<Layer>]) -> Option<String> {
    if a.len() != b.len() {
        return Some(format!("the number of layers, {} and not {}", b.len(), a.len()));
    }
    a.iter().zip(b).find_map(|(a, b)| if Arc::ptr_eq(a, b) { None } else { layer(a, b) })
}

fn layer(a: &Layer, b: &Layer) -> Option<String> {
    if let (Content::Group(a), Content::Group(b)) = (&a.content, &b.content)
        && let Some(inner) = layers(&a.layers, &b.layers)
    {
        return Some(inner);
    }
    let what = if a.name != b.name {
        "name"
    } else if let Some(what) = meeting(a, b) {
        what
    } else if !is_same_mask(a.mask.as_ref(), b.mask.as_ref()) {
        "mask"
    } else {
        content(&a.content, &b.content)?
    };
    Some(format!("“{}”: its {what}", a.name))
}

/// What differs in how two layers meet what is around them.
fn meeting(a: &Layer, b: &Layer) -> Option<&'static str> {
    // The place of a part belongs to the part.
    let on = |l: &Layer| l.on.as_ref().map(|attachment| attachment.part.clone());
    let each = [
        ("visibility", a.visible == b.visible),
        ("opacity", a.opacity == b.opacity),
        ("blend mode", (a.blend, a.blend_linear) == (b.blend, b.blend_linear)),
        ("clipping", (a.clip_below, a.clip_to_surface) == (b.clip_below, b.clip_to_surface)),
        ("lock", a.lock == b.lock),
        ("label", a.label == b.label),
        ("effects", a.effects == b.effects && a.fill_opacity == b.fill_opacity),
        ("transform", a.transform == b.transform),
        ("liquify", a.liquify == b.liquify),
        ("attachment", on(a) == on(b)),
    ];
    each.into_iter().find(|(_, is_same)| !is_same).map(|(what, _)| what)
}

fn is_same_mask(a: Option<&LayerMask>, b: Option<&LayerMask>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => match (&a.kind, &b.kind) {
            (MaskKind::File { coverage: x, .. }, MaskKind::File { coverage: y, .. }) => {
                (a.invert, a.disabled) == (b.invert, b.disabled) && (Arc::ptr_eq(x, y) || x == y)
            }
            _ => a.is_same(b),
        },
        (a, b) => a.is_none() && b.is_none(),
    }
}

/// What differs in two layers' contents; `None` if nothing does.
fn content(a: &Content, b: &Content) -> Option<&'static str> {
    let (what, is_same) = match (a, b) {
        (Content::Fill(a), Content::Fill(b)) => ("color", a == b),
        (Content::Pixels(a), Content::Pixels(b)) => ("pixels", are_same_pixels(&a.tiles, &b.tiles)),
        (Content::Image(a), Content::Image(b)) => {
            ("picture or how it lies", a.ptr_eq(b) || a.params() == b.params())
        }
        (Content::Gradient(a), Content::Gradient(b)) => {
            ("gradient", a.ptr_eq(b) || a.params() == b.params())
        }
        (Content::Strokes(a), Content::Strokes(b)) => {
            ("strokes", a.ptr_eq(b) || are_same_strokes(a.params(), b.params()))
        }
        (Content::FormDrawing(a), Content::FormDrawing(b)) => {
            ("lines or how they are drawn", a.ptr_eq(b) || a.params() == b.params())
        }
        (Content::Shading(a), Content::Shading(b)) => {
            ("material", a.ptr_eq(b) || a.params() == b.params())
        }
        (Content::RadianceScaling(a), Content::RadianceScaling(b)) => ("scaling", a == b),
        (Content::Adjustment(a), Content::Adjustment(b)) => ("adjustment", a == b),
        (Content::Filter(a), Content::Filter(b)) => ("filter", a == b),
        (Content::Normals(a), Content::Normals(b)) => {
            let alike =
                (a.placement, a.outside, a.strength) == (b.placement, b.outside, b.strength);
            ("detail", alike && is_same_detail(&a.source, &b.source))
        }
        (Content::Ink(a), Content::Ink(b)) => ("drawing", a.of == b.of),
        (Content::Group(a), Content::Group(b)) => {
            ("passing through", a.pass_through == b.pass_through)
        }
        _ => ("kind", false),
    };
    (!is_same).then_some(what)
}

fn is_same_detail(a: &DetailSource, b: &DetailSource) -> bool {
    match (a, b) {
        (DetailSource::Grain(a), DetailSource::Grain(b)) => a == b,
        // The map itself follows from these.
        (
            DetailSource::Map { picture: a, convention: x, .. },
            DetailSource::Map { picture: b, convention: y, .. },
        ) => a == b && x == y,
        _ => false,
    }
}

fn is_same_selection(a: &Stroke, b: &Stroke) -> bool {
    match (a.selection(), b.selection()) {
        (None, None) => true,
        (Some(a), Some(b)) => a.is_same(b),
        _ => false,
    }
}

fn are_same_strokes(a: &StrokeList, b: &StrokeList) -> bool {
    let attachment = |stroke: &Stroke| {
        stroke.attachment().map(|attachment| (attachment.frame.part.clone(), attachment.own))
    };
    let same = |(a, b): (&Arc<Stroke>, &Arc<Stroke>)| {
        Arc::ptr_eq(a, b)
            || (a.operator(), a.color()) == (b.operator(), b.color())
                && a.samples() == b.samples()
                && is_same_selection(a, b)
                && attachment(a) == attachment(b)
                && a.brush() == b.brush()
    };
    a.strokes.len() == b.strokes.len() && a.strokes.iter().zip(&b.strokes).all(same)
}

/// Every pixel is the same; a wholly transparent tile counts as absent.
fn are_same_pixels(a: &TileGrid, b: &TileGrid) -> bool {
    if a.ptr_eq(b) {
        return true;
    }
    let holds = |a: &TileGrid, b: &TileGrid| {
        a.iter().all(|(at, tile)| match b.tile(at) {
            Some(other) => Arc::ptr_eq(tile, other) || tile.is_same(other),
            None => (0..TILE_AREA).all(|i| !tile.is_painted(i)),
        })
    };
    holds(a, b) && holds(b, a)
}
