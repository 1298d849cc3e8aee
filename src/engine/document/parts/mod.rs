//! Parts: the shape of a drawing as a list of values, the farthest first, from which the document's surface follows.
//! Floor 4. What each kind computes is `shape`'s; `derive` makes the surface and keeps what did not change, `forms`
//! tells what it made, `outlines` finds the outlines, `flats` makes parts of a layer of flat colours, and `drawing`
//! says what can be made of one.

mod derive;
pub mod drawing;
pub mod flats;
pub mod forms;
mod outlines;

#[cfg(test)]
mod tests;

use super::Document;
use crate::math::range::{at_most, within};
use crate::math::srgb::Color;
use crate::math::{Affine2, COORDINATE, Mat2, Range, UNIT, Vec2, Vec3, vec2, vec3};
use crate::raster::Plane;
use crate::shape::{Ball, Bevel, BevelCurve, Combine, Detail, Primitive, SculptStroke, Touch};
use crate::surface::Surface;
use derive::PartCache;
use std::sync::Arc;

/// The parts of a document, and what is kept of them for speed.
#[derive(Clone, Default)]
pub struct Parts {
    /// The farthest first.
    pub list: Vec<Arc<Part>>,
    /// The surface of the document's maps, beneath all parts; while there are none it is the document's own.
    pub maps: Option<Arc<Surface>>,
    cache: PartCache,
}

impl Parts {
    /// The parts of one document.
    pub const MOST: usize = 1000;

    pub fn new(list: Vec<Part>) -> Self {
        Self { list: list.into_iter().map(Arc::new).collect(), ..Self::default() }
    }
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }
    pub fn part(&self, id: &str) -> Option<&Arc<Part>> {
        self.list.iter().find(|part| part.id == id)
    }
}

/// One part.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Each part has another.
    pub id: String,
    pub name: String,
    pub visible: bool,
    pub combine: Combine,
    /// Degrees that it leans, up toward the right and toward the bottom.
    pub tilt_deg: Vec2,
    /// Nearer to the viewer by so many px.
    pub raise: f32,
    /// Where it stands: canvas from part.
    pub matrix: Affine2,
    pub kind: PartKind,
}

/// What a part is.
#[derive(Clone, Debug, PartialEq)]
pub enum PartKind {
    Inflate {
        outline: OutlineSource,
        inflation: Inflation,
    },
    Bevel {
        outline: OutlineSource,
        bevel: Bevel,
    },
    Primitive(Primitive),
    /// An outline turned about an axis; upright through its middle without one.
    Lathe {
        outline: OutlineSource,
        axis: Option<[Vec2; 2]>,
        puff: f32,
    },
    /// Balls along a stroke.
    Sweep {
        balls: Vec<Ball>,
        puff: f32,
    },
    /// Normals put down on another part.
    Touches {
        on: String,
        touches: Vec<Touch>,
    },
    /// Heights sculpted on another part.
    Sculpt {
        on: String,
        strokes: Vec<SculptStroke>,
    },
    /// The detail of a picture on another part.
    Relief {
        on: String,
        picture: CoverageFile,
        detail: Detail,
    },
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
    pub const PUFF: Range = 0.0..=8.0;
    pub const PROFILE: Range = UNIT;
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
    /// The alpha of a layer, by its name, the topmost of several; or of it what has a colour.
    Layer { layer: String, color: Option<Color> },
    /// A picture of coverage; its upper left corner is the frame's.
    File(CoverageFile),
    /// A closed polygon, canvas px.
    Path(Vec<Vec2>),
    /// An object of the document's maps, from 1 on.
    Object(u32),
}

impl OutlineSource {
    /// Points of one path.
    pub const MOST_POINTS: usize = 100_000;
}

/// A picture that is read as coverage or as luminance, with the name of its file.
#[derive(Clone, Debug)]
pub struct CoverageFile {
    pub file: String,
    pub coverage: Arc<Plane<u8>>,
}

/// By what they hold: names are given anew by every project.
impl PartialEq for CoverageFile {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.coverage, &other.coverage) || self.coverage == other.coverage
    }
}

impl Part {
    pub const TILT: Range = -80.0..=80.0;
    pub const RAISE: Range = -8192.0..=8192.0;
    /// Letters of an id and of a name.
    pub const LONGEST_NAME: usize = 1000;
    /// Each number of a matrix.
    pub const MATRIX: Range = COORDINATE;

    /// A part as it is first made.
    pub fn new(id: impl Into<String>, kind: PartKind) -> Self {
        let id = id.into();
        let combine = Combine::default();
        let (tilt_deg, raise, matrix) = (Vec2::ZERO, 0.0, Affine2::IDENTITY);
        Self { name: id.clone(), id, visible: true, combine, tilt_deg, raise, matrix, kind }
    }
    /// The whole alpha of a layer, inflated.
    pub fn of_layer(id: impl Into<String>, layer: impl Into<String>, inflation: Inflation) -> Self {
        let outline = OutlineSource::Layer { layer: layer.into(), color: None };
        Self::new(id, PartKind::Inflate { outline, inflation })
    }
    /// The part that this one changes, where it is no form of its own.
    pub fn on(&self) -> Option<&str> {
        match &self.kind {
            PartKind::Touches { on, .. } | PartKind::Sculpt { on, .. } | PartKind::Relief { on, .. } => Some(on),
            _ => None,
        }
    }
    pub fn outline(&self) -> Option<&OutlineSource> {
        match &self.kind {
            PartKind::Inflate { outline, .. } | PartKind::Bevel { outline, .. } | PartKind::Lathe { outline, .. } => {
                Some(outline)
            }
            _ => None,
        }
    }
    /// The files that it names, to be given other names.
    pub fn files_mut(&mut self) -> Option<&mut CoverageFile> {
        match &mut self.kind {
            PartKind::Inflate { outline, .. } | PartKind::Bevel { outline, .. } | PartKind::Lathe { outline, .. } => {
                match outline {
                    OutlineSource::File(file) => Some(file),
                    _ => None,
                }
            }
            PartKind::Relief { picture, .. } => Some(picture),
            _ => None,
        }
    }
    /// The same part on a canvas with other sides.
    pub(super) fn scaled(&self, scale: Vec2, length: f32, plane: impl Fn(&Plane<u8>) -> Plane<u8>) -> Part {
        let mut next = self.clone();
        next.raise *= length;
        let to = Mat2::from_diagonal(scale);
        // What it stands on is scaled as well: the matrix maps scaled points to scaled points.
        next.matrix.matrix2 = to * self.matrix.matrix2 * to.inverse();
        next.matrix.translation *= scale;
        match &mut next.kind {
            PartKind::Inflate { outline, .. } => outline.scale(scale),
            PartKind::Bevel { outline, bevel } => {
                outline.scale(scale);
                bevel.width *= length;
                bevel.height *= length;
            }
            PartKind::Primitive(primitive) => {
                primitive.center *= scale;
                primitive.half *= length;
                for side in [&mut primitive.radius, &mut primitive.length, &mut primitive.tube, &mut primitive.round] {
                    *side *= length;
                }
            }
            PartKind::Lathe { outline, axis, .. } => {
                outline.scale(scale);
                axis.iter_mut().flatten().for_each(|p| *p *= scale);
            }
            PartKind::Sweep { balls, .. } => balls.iter_mut().for_each(|ball| {
                ball.at *= scale;
                ball.radius *= length;
            }),
            PartKind::Touches { touches, .. } => touches.iter_mut().for_each(|touch| {
                touch.at *= scale;
                touch.radius *= length;
                touch.reach *= length;
            }),
            PartKind::Sculpt { strokes, .. } => strokes.iter_mut().for_each(|stroke| {
                stroke.size *= length;
                stroke.strength *= length;
                stroke.samples.iter_mut().for_each(|sample| sample.0 *= scale);
            }),
            PartKind::Relief { detail, .. } => {
                detail.coarse *= length;
                detail.fine *= length;
                detail.radius *= length;
            }
        }
        if let Some(file) = next.files_mut() {
            file.coverage = Arc::new(plane(&file.coverage));
        }
        next
    }
    /// Whether a file can hold it: every number in its range; else a sentence.
    pub fn fits(&self) -> Result<(), String> {
        at_most("letters of the id", self.id.chars().count(), Self::LONGEST_NAME)?;
        at_most("letters of the name", self.name.chars().count(), Self::LONGEST_NAME)?;
        if self.id.is_empty() {
            return Err("a part has no id".into());
        }
        if let Combine::Union { smooth } = self.combine {
            within("the union's smoothness", smooth, &Combine::SMOOTH)?;
        }
        within("the tilt", self.tilt_deg.x, &Self::TILT)?;
        within("the tilt", self.tilt_deg.y, &Self::TILT)?;
        within("how far it is raised", self.raise, &Self::RAISE)?;
        self.matrix.to_cols_array().iter().try_for_each(|v| within("the matrix", *v, &Self::MATRIX))?;
        if let Some(outline) = self.outline() {
            outline.fits()?;
        }
        self.kind.fits()
    }
}

impl OutlineSource {
    fn scale(&mut self, scale: Vec2) {
        if let OutlineSource::Path(points) = self {
            points.iter_mut().for_each(|p| *p *= scale);
        }
    }
    fn fits(&self) -> Result<(), String> {
        match self {
            OutlineSource::Path(points) => {
                at_most("points of the path", points.len(), Self::MOST_POINTS)?;
                points.iter().try_for_each(|p| place("a point of the path", *p))
            }
            OutlineSource::Layer { layer, .. } => {
                at_most("letters of the layer's name", layer.chars().count(), Part::LONGEST_NAME)
            }
            OutlineSource::File(_) | OutlineSource::Object(_) => Ok(()),
        }
    }
}

fn place(what: &str, p: Vec2) -> Result<(), String> {
    within(what, p.x, &COORDINATE)?;
    within(what, p.y, &COORDINATE)
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
        }
    }
    fn fits(&self) -> Result<(), String> {
        match self {
            PartKind::Inflate { inflation, .. } => {
                within("the puff", inflation.puff, &Inflation::PUFF)?;
                within("the profile", inflation.profile, &Inflation::PROFILE)?;
                within("the rim", inflation.rim_deg, &Inflation::RIM)
            }
            PartKind::Bevel { bevel, .. } => {
                within("the bevel's width", bevel.width, &Bevel::WIDTH)?;
                within("the bevel's height", bevel.height, &Bevel::HEIGHT)?;
                let BevelCurve::Points(points) = &bevel.curve else { return Ok(()) };
                at_most("points of the bevel's curve", points.len(), BevelCurve::MOST_POINTS)?;
                points.iter().try_for_each(|p| {
                    within("a point of the bevel's curve", p.x, &UNIT)?;
                    within("a point of the bevel's curve", p.y, &UNIT)
                })
            }
            PartKind::Primitive(body) => {
                place("the middle", body.center)?;
                let Vec3 { x, y, z } = body.half;
                [body.radius, body.length, body.tube, x, y, z]
                    .iter()
                    .try_for_each(|side| within("a side of the body", *side, &Primitive::LENGTH))?;
                within("the radius of its edges", body.round, &Primitive::ROUND)?;
                body.turn_deg.to_array().iter().try_for_each(|turn| within("its turn", *turn, &Primitive::TURN))
            }
            PartKind::Lathe { axis, puff, .. } => {
                within("the puff", *puff, &Inflation::PUFF)?;
                axis.iter().flatten().try_for_each(|p| place("the axis", *p))
            }
            PartKind::Sweep { balls, puff } => {
                within("the puff", *puff, &Inflation::PUFF)?;
                at_most("balls of a sweep", balls.len(), Ball::MOST)?;
                balls.iter().try_for_each(|ball| {
                    place("a ball", ball.at)?;
                    within("the radius of a ball", ball.radius, &Ball::RADIUS)
                })
            }
            PartKind::Touches { touches, .. } => {
                at_most("touches", touches.len(), Touch::MOST)?;
                touches.iter().try_for_each(|touch| {
                    place("a touch", touch.at)?;
                    within("the radius of a touch", touch.radius, &Touch::RADIUS)?;
                    within("the reach of a touch", touch.reach, &Touch::REACH)?;
                    touch.normal.to_array().iter().try_for_each(|v| within("a touch's normal", *v, &(-1.0..=1.0)))
                })
            }
            PartKind::Sculpt { strokes, .. } => {
                let samples: usize = strokes.iter().map(|stroke| stroke.samples.len()).sum();
                at_most("samples of sculpting", samples + strokes.len(), SculptStroke::MOST)?;
                strokes.iter().try_for_each(|stroke| {
                    within("the size of a stroke", stroke.size, &SculptStroke::SIZE)?;
                    within("the hardness of a stroke", stroke.hardness, &SculptStroke::HARDNESS)?;
                    within("the strength of a stroke", stroke.strength, &SculptStroke::STRENGTH)?;
                    stroke.samples.iter().try_for_each(|(at, pressure)| {
                        place("a sample", *at)?;
                        within("the pressure of a sample", *pressure, &SculptStroke::PRESSURE)
                    })
                })
            }
            PartKind::Relief { detail, .. } => {
                within("the coarse detail", detail.coarse, &Detail::HEIGHT)?;
                within("the fine detail", detail.fine, &Detail::HEIGHT)?;
                within("the detail's radius", detail.radius, &Detail::RADIUS)?;
                within("the detail's edge", detail.edge, &Detail::EDGE)
            }
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

impl Document {
    /// The surface of the document's maps alone, beneath its parts.
    pub fn maps_surface(&self) -> Option<&Arc<Surface>> {
        if self.parts.is_empty() { self.surface.as_ref() } else { self.parts.maps.as_ref() }
    }
    /// With other parts, and the surface that follows from them.
    pub fn with_parts(&self, list: Vec<Arc<Part>>) -> Document {
        let maps = self.maps_surface().cloned();
        let mut next = self.clone();
        if list.is_empty() {
            next.surface = maps.clone();
        }
        next.parts = Arc::new(Parts { list, maps, cache: self.parts.cache.clone() });
        next.reshaped()
    }
    /// With other maps beneath its parts.
    pub fn with_maps(&self, surface: Option<Arc<Surface>>) -> Document {
        let mut next = self.clone();
        if self.parts.is_empty() {
            next.surface = surface;
            return next;
        }
        next.parts = Arc::new(Parts { maps: surface, ..Parts::clone(&self.parts) });
        next.reshaped()
    }
    /// Whether files can hold the parts.
    pub(super) fn parts_fit(&self) -> Result<(), String> {
        at_most("Parts", self.parts.list.len(), Parts::MOST)?;
        for (i, part) in self.parts.list.iter().enumerate() {
            let shown: String = part.name.chars().take(60).collect();
            part.fits().map_err(|why| format!("“{shown}”: {why}."))?;
            if self.parts.list[..i].iter().any(|other| other.id == part.id) {
                return Err(format!("“{shown}”: another part has the id “{}” as well.", part.id));
            }
        }
        Ok(())
    }
}
