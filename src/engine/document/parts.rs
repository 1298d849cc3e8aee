//! Parts: the shape of a drawing as a list of values, the farthest first, from which the document's
//! surface follows. Floor 4. Not here: what each kind of part computes (`shape`).
//!
//! `part` is one of them and `edit` changes the list. `derive` makes the surface again where it
//! changed; it uses `placed_outlines`, `solve_form` and `body` for one form, `modifiers` for what
//! is on a form, `whole` for all together, `form_cache` for what is kept, and `unchanged` to
//! compare versions. `inputs` says whether a surface is still the right one, `weight` what memory
//! it takes. `outlines` finds outlines, `drawn` what layers draw for them; `drawing` says what can
//! be made of a layer, and `from_flats` makes parts of one in flat colors (`shape::flats`), for
//! which `order` finds who lies in front; `cut` makes a drawing go with its parts. `forms` has the
//! forms that were made, `flats_cache` what was found in flats, `scale` changes the canvas, and
//! `fit` holds parts to what files can hold.

mod body;
mod cut;
mod derive;
pub mod drawing;
mod drawn;
mod edit;
mod fit;
mod flats_cache;
mod form_cache;
pub mod forms;
mod freeze;
pub mod from_flats;
mod inputs;
mod modifiers;
mod order;
mod outlines;
mod part;
mod path_area;
pub mod pixel_art;
mod placed_outlines;
mod scale;
mod solve_form;
mod unchanged;
mod weight;
mod whole;

#[cfg(test)]
mod tests;

use super::source::SurfaceSource;
use crate::math::srgb::Color;
use crate::math::{Affine2, Range, UNIT, Vec2, Vec3, vec2, vec3};
use crate::raster::{Asset, Plane};
use crate::shape::{Ball, Bevel, Combine, Detail, Lines, Primitive, SculptStroke, Touch};
use crate::surface::Surface;
pub use form_cache::FormArea;
use form_cache::PartCache;
use inputs::SurfaceInputs;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The parts of a document, and what is kept about them for speed.
#[derive(Clone, Default)]
pub struct Parts {
    /// The farthest first.
    pub list: Vec<Arc<Part>>,
    /// The surface of the document's maps, beneath all parts; while there are none it is the
    /// document's own.
    pub maps: Option<Arc<Surface>>,
    /// The parts, by their ids, whose place no longer has their color, so that they take the
    /// nearest area of it.
    pub lost: Vec<String>,
    /// The document's surface is still that of the parts as they were, while the user drags them.
    is_ahead: bool,
    /// Of a document of another size: its surface, on which the points of this one's are read.
    points: Option<Arc<Surface>>,
    /// What the document's surface was made of.
    made_of: Option<Arc<SurfaceInputs>>,
    cache: PartCache,
}

impl Parts {
    /// The parts of one document.
    pub const MOST: usize = 1000;

    /// Parts that are still to be shaped.
    pub fn new(list: Vec<Part>) -> Self {
        Self { list: list.into_iter().map(Arc::new).collect(), ..Self::default() }
    }

    /// No parts, but what is kept for speed.
    pub(in crate::document) fn emptied(&self) -> Self {
        Self { cache: self.cache.clone(), ..Self::default() }
    }

    /// No parts yet, for a document of another size than one whose surface is given.
    pub(in crate::document) fn pointing_on(points: Option<Arc<Surface>>) -> Self {
        Self { points, ..Self::default() }
    }

    /// No parts, for documents that are shown for a moment while the user drags: what is made may
    /// be slightly off.
    pub(in crate::document) fn for_drafts() -> Self {
        let mut parts = Self::default();
        parts.cache.is_draft = true;
        parts
    }

    /// There is none.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// The part that a part finally changes, or itself; `None` if there is no such part.
    pub fn body_of(&self, id: &str) -> Option<&Arc<Part>> {
        let mut part = self.part(id)?;
        // No chain is longer than the list; a loop ends there.
        for _ in 0..self.list.len() {
            let Some(next) = part.on().and_then(|on| self.part(on)) else { break };
            part = next;
        }
        Some(part)
    }

    /// The part with an id.
    pub fn part(&self, id: &str) -> Option<&Arc<Part>> {
        self.list.iter().find(|part| part.id == id)
    }
}

/// One part.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Each part has another.
    pub id: String,
    /// What the list shows.
    pub name: String,
    /// It belongs to the shape.
    pub visible: bool,
    /// How it meets what is beneath it.
    pub combine: Combine,
    /// Degrees that it leans, up toward the right and toward the bottom.
    pub tilt_deg: Vec2,
    /// Nearer to the viewer by so many px.
    pub raise: f32,
    /// Its place: canvas from part.
    pub matrix: Affine2,
    /// What its form is made of.
    pub kind: PartKind,
}

/// What a part is.
#[derive(Clone, Debug, PartialEq)]
pub enum PartKind {
    /// An outline, inflated.
    Inflate {
        /// Its outline.
        outline: OutlineSource,
        /// How it is inflated.
        inflation: Inflation,
    },
    /// An outline with a flat top and slanted rims.
    Bevel {
        /// Its outline.
        outline: OutlineSource,
        /// How its rim is shaped.
        bevel: Bevel,
    },
    /// A body of geometry.
    Primitive(Primitive),
    /// An outline turned about an axis; upright through its middle without one.
    Lathe {
        /// The outline that is turned.
        outline: OutlineSource,
        /// Two points of the axis.
        axis: Option<[Vec2; 2]>,
        /// How deep it is, relative to its width.
        puff: f32,
    },
    /// Balls along a stroke.
    Sweep {
        /// The balls along the path.
        balls: Vec<Ball>,
        /// How deep it is, relative to its width.
        puff: f32,
    },
    /// Normals put down on another part.
    Touches {
        /// The part that is touched.
        on: String,
        /// What was touched.
        touches: Vec<Touch>,
    },
    /// Heights sculpted on another part.
    Sculpt {
        /// The part that is sculpted.
        on: String,
        /// The strokes that sculpt it.
        strokes: Vec<SculptStroke>,
    },
    /// Ink that marks where another part turns.
    Lines {
        /// The part that the lines are on.
        on: String,
        /// The ink of the lines.
        ink: OutlineSource,
        /// How lines shape it.
        lines: Lines,
    },
    /// Several shadings of one drawing by hand, each with the light elsewhere, within an outline or
    /// wherever they hold anything.
    Profiles {
        /// Its outline.
        outline: Option<OutlineSource>,
        /// The shaded pictures that it follows.
        shadings: Vec<ProfilePicture>,
    },
    /// Maps that were made elsewhere.
    Maps(PartMaps),
    /// The detail of a picture on another part.
    Relief {
        /// The part that the relief is on.
        on: String,
        /// The picture of the relief.
        picture: CoverageFile,
        /// How high it is.
        detail: Detail,
    },
}

impl ProfilePicture {
    /// The range of each number of its light.
    pub const LIGHT: Range = -1e4..=1e4;
}

/// A shading of a drawing as a gray picture, and where its light is.
#[derive(Clone, Debug, PartialEq)]
pub struct ProfilePicture {
    /// sRGB.
    pub picture: CoverageFile,
    /// Toward the light, camera space (y up); any length.
    pub light: Vec3,
}

/// Maps as a part, with the surface that they are. Its size is that of their frame: the canvas on
/// which they were put, whatever became of that since.
#[derive(Clone)]
pub struct PartMaps {
    /// With the matrix that takes them to their frame, if they are not fitted to it.
    pub source: Arc<SurfaceSource>,
    /// The files that it names.
    pub files: Arc<BTreeMap<String, Asset>>,
    /// The surface that they give.
    pub surface: Arc<Surface>,
}

/// By their contents: every project gives new names.
impl PartialEq for PartMaps {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.surface, &other.surface) || self.surface.has_same_maps(&other.surface)
    }
}

impl std::fmt::Debug for PartMaps {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PartMaps").field("source", &self.source).finish_non_exhaustive()
    }
}

/// How an outline is inflated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inflation {
    /// Factor of the height; at 1 a disc becomes a half sphere.
    pub puff: f32,
    /// 0 a pillow … 1 a tube.
    pub profile: f32,
    /// Degrees that the rim turns.
    pub rim_deg: f32,
}

impl Inflation {
    /// How high it may be, as a factor.
    pub const PUFF: Range = 0.0..=8.0;
    /// What its profile may be.
    pub const PROFILE: Range = UNIT;
    /// The angle that its rim may have, degrees.
    pub const RIM: Range = 1.0..=90.0;
    /// Settings that have a name.
    pub const PRESETS: [(Inflation, &'static str); 4] = [
        (Inflation { puff: 1.0, profile: 0.0, rim_deg: 90.0 }, "pillow"),
        (Inflation { puff: 1.0, profile: 1.0, rim_deg: 90.0 }, "tube"),
        (Inflation { puff: 0.5, profile: 0.5, rim_deg: 60.0 }, "relief"),
        (Inflation { puff: 0.2, profile: 0.5, rim_deg: 30.0 }, "coin"),
    ];
}

impl Default for Inflation {
    fn default() -> Self {
        Self { puff: 1.0, profile: 0.0, rim_deg: 90.0 }
    }
}

/// Where an outline comes from. It stays linked: the part follows what it names.
#[derive(Clone, Debug, PartialEq)]
pub enum OutlineSource {
    /// The alpha of a layer, by its name, the topmost of several; or its pixels of one color.
    Layer {
        /// The layer's name.
        layer: String,
        /// The color that is meant; without one, all of its paint.
        color: Option<FlatColor>,
    },
    /// A picture of coverage; its upper left corner is the frame's.
    File(CoverageFile),
    /// A selection kept by name. One that follows the surface is found on the document's maps,
    /// without parts.
    Selection(String),
    /// A closed polygon, canvas px.
    Path(Vec<Vec2>),
    /// An object of the document's maps, from 1 on.
    Object(u32),
}

/// A color of a layer of flats, wherever it is, or in one place only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatColor {
    /// The color.
    pub color: Color,
    /// A point of the area that is meant, px of the part's frame, which is the canvas before the
    /// part's matrix. If the color is not there, the nearest area of it is meant.
    pub at: Option<Vec2>,
}

impl From<Color> for FlatColor {
    fn from(color: Color) -> Self {
        Self { color, at: None }
    }
}

impl OutlineSource {
    /// Points of one path.
    pub const MOST_POINTS: usize = 100_000;
}

/// A picture that is read as coverage or as luminance, with the name of its file.
#[derive(Clone, Debug)]
pub struct CoverageFile {
    /// The name of the file.
    pub file: String,
    /// What it covers, one byte a pixel.
    pub coverage: Arc<Plane<u8>>,
}

/// By their contents: every project gives new names.
impl PartialEq for CoverageFile {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.coverage, &other.coverage) || self.coverage == other.coverage
    }
}

impl PartKind {
    /// The name of the kind in documents.
    pub fn name(&self) -> &'static str {
        match self {
            PartKind::Inflate { .. } => "inflate",
            PartKind::Bevel { .. } => "bevel",
            PartKind::Primitive(_) => "primitive",
            PartKind::Lathe { .. } => "lathe",
            PartKind::Sweep { .. } => "sweep",
            PartKind::Touches { .. } => "touches",
            PartKind::Sculpt { .. } => "sculpt",
            PartKind::Relief { .. } => "relief",
            PartKind::Lines { .. } => "lines",
            PartKind::Profiles { .. } => "profiles",
            PartKind::Maps(_) => "maps",
        }
    }
}

/// The direction of a normal through the linear part of a map of the canvas: it turns with it.
fn turned(normal: Vec3, matrix: Affine2) -> Vec3 {
    let along = matrix.matrix2.x_axis.try_normalize().unwrap_or(Vec2::X);
    // Image axes are y down, normals y up.
    let bar = along.rotate(vec2(normal.x, -normal.y));
    vec3(bar.x, -bar.y, normal.z)
}
