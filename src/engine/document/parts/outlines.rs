//! The outlines that parts name: of layers, colors, pictures, paths and objects.
//! Floor 4.

use super::drawn::{DrawnLayer, is_same_paint};
use super::flats_cache::CachedFlats;
use super::{CoverageFile, FlatColor, OutlineSource, Part, PartKind, Parts};
use crate::document::Document;
use crate::math::srgb::Color;
use crate::math::{Rect, Size, Vec2, vec2};
use crate::paint::{Scene, Selection};
use crate::raster::{CoverageGrid, Plane, TileGrid};
use crate::shape::Outline;
use crate::shape::flats::beneath::fill_beneath;
use crate::shape::flats::color_areas::SplitAreas;
use crate::shape::flats::shares::Flats;
use crate::surface::Surface;
use crate::surface::region::SurfaceRegion;
use std::sync::Arc;

/// What an outline is made of: while this is the same, so is the outline.
#[derive(Clone)]
pub enum OutlineKey {
    Layer(Box<DrawnLayer>, Option<FlatArea>),
    Coverage(Arc<Plane<u8>>),
    Selection(Arc<Selection>),
    /// A selection that follows the maps.
    Region(SurfaceRegion, Option<Arc<Surface>>),
    Path(OutlineSource),
    /// Wherever one of some pictures is not black.
    Profiles(Vec<Arc<Plane<u8>>>),
    Object(Arc<Surface>, u32),
}

/// What a part takes of a layer of flats.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatArea {
    flat: FlatColor,
    /// The colors of the parts that lie over it, beneath whose edges it continues.
    over: Vec<Color>,
    /// The colors of all nearer parts of the same layer, the farthest first, moved and hidden ones
    /// too: it continues beneath what they cover inside of it.
    nearer: Vec<Color>,
    /// The other colors of parts of that layer.
    farther: Vec<Color>,
}

impl FlatArea {
    /// The colors of all parts of the layer, in an order that is the same for each of them.
    fn part_colors(&self) -> Vec<Color> {
        let mut all: Vec<Color> =
            [&self.nearer[..], &self.farther[..], &[self.flat.color]].concat();
        all.sort_unstable_by_key(|color| [color.r, color.g, color.b, color.a]);
        all.dedup();
        all
    }

    /// The share of each pixel that it takes, and whether its area has its color no longer, so
    /// that this is the nearest one; `corner`: of the flats. `None` where the color is nowhere.
    fn share(&self, known: &CachedFlats, corner: Vec2) -> Option<(Plane<u8>, bool)> {
        let flats = &known.flats;
        let mut share = flats.share_of(self.flat.color, &self.over);
        let mut is_lost = false;
        if let Some(at) = self.flat.at {
            let areas = known.areas_of(self.flat.color);
            let (area, is_beside) = areas.nearest(at - corner)?;
            is_lost = is_beside;
            share = areas.shares(&[area], &share).pop()?;
        }
        if !(self.nearer.is_empty() && self.farther.is_empty()) {
            fill_beneath(&mut share, flats, &self.nearer, &self.farther);
        }
        Some((share, is_lost))
    }
}

impl Document {
    /// What a part takes of the color of a layer, among the other parts of the same layer.
    fn area_of(&self, part: &Part, flat: FlatColor) -> FlatArea {
        let mut area = FlatArea { flat, over: Vec::new(), nearer: Vec::new(), farther: Vec::new() };
        let Some(OutlineSource::Layer { layer: own, .. }) =
            part.outline().filter(|_| part.on().is_none())
        else {
            return area;
        };
        // Several parts may take one color in different areas.
        let add = |to: &mut Vec<Color>, color: Color| {
            if !to.contains(&color) {
                to.push(color);
            }
        };
        let mut is_nearer = false;
        for other in &self.parts.list {
            if other.id == part.id {
                is_nearer = true;
                continue;
            }
            let Some(OutlineSource::Layer { layer, color: Some(FlatColor { color, .. }) }) =
                other.outline().filter(|_| other.on().is_none())
            else {
                continue;
            };
            if layer != own {
                continue;
            }
            add(if is_nearer { &mut area.nearer } else { &mut area.farther }, *color);
            // Edges meet where both were made.
            if is_nearer && other.visible && other.matrix == part.matrix {
                add(&mut area.over, *color);
            }
        }
        area.farther.retain(|color| !area.nearer.contains(color));
        area
    }
}

impl Document {
    /// The areas of the color that a part takes of a layer, wherever it is; `None` for any other
    /// part, and for one that has an area already.
    pub fn areas_of(&self, part: &Part) -> Option<SplitAreas> {
        let OutlineSource::Layer { layer, color: Some(FlatColor { color, at: None }) } =
            part.outline()?
        else {
            return None;
        };
        let layer = self.layer_named(layer)?;
        let tiles = DrawnLayer::of(self, layer, part)?.pixels(self)?;
        let rect = tiles.bounds();
        let area = self.area_of(part, (*color).into());
        Flats::of(&tiles, rect, &area.part_colors())
            .map(|flats| SplitAreas::of(&flats, *color, rect))
    }

    /// What the user is told when parts take another area than the one that was meant, which no
    /// longer has their color; `before`: of those parts nothing is said again.
    pub fn note_of_lost(&self, before: Option<&Document>) -> Option<String> {
        let known = |id: &String| before.is_some_and(|before| before.parts.lost.contains(id));
        let part = |id: &String| self.parts.part(id).map(|part| format!("“{}”", part.name));
        let names: Vec<String> =
            self.parts.lost.iter().filter(|id| !known(id)).filter_map(part).collect();
        let is = if names.len() == 1 {
            "takes the area of its color that is"
        } else {
            "take the areas of their colors that are"
        };
        (!names.is_empty()).then(|| {
            format!("{} {is} nearest: its former area has another color now.", names.join(", "))
        })
    }

    /// With the points of areas in layers that were moved since `before`, paint unchanged, moved
    /// as well.
    pub(in crate::document) fn with_areas_carried(self, before: &Document) -> Document {
        let carried = |part: &Arc<Part>| {
            let Some(OutlineSource::Layer { layer, color: Some(FlatColor { at: Some(at), .. }) }) =
                part.outline()
            else {
                return None;
            };
            let (old, new) = (before.layer_named(layer)?, self.layer_named(layer)?);
            if old.id != new.id || !is_same_paint(old, new) {
                return None;
            }
            let plane = |document, layer| Some(DrawnLayer::of(document, layer, part)?.map().plane);
            let (from, to) = (plane(before, old)?, plane(&self, new)?);
            let moved = from.inverse().then(&to).to_canvas(*at).filter(|_| from != to)?;
            let mut next = Part::clone(part);
            next.outline_mut()?.points_mut().for_each(|p| *p = moved);
            Some(Arc::new(next))
        };
        if self.parts.list.iter().all(|part| part.area_point().is_none()) {
            return self;
        }
        let list = self
            .parts
            .list
            .iter()
            .map(|part| carried(part).unwrap_or_else(|| part.clone()))
            .collect();
        Document { parts: Arc::new(Parts { list, ..Parts::clone(&self.parts) }), ..self }
    }
}

impl OutlineKey {
    /// What a part is made of, if it is made of anything; outer `None` if what it names does not
    /// exist.
    pub fn of_part(document: &Document, part: &Part) -> Option<Option<Self>> {
        match (&part.kind, part.outline()) {
            (_, Some(outline)) => Self::of(document, part, outline).map(Some),
            (PartKind::Profiles { shadings, .. }, None) => Some(Some(Self::Profiles(
                shadings.iter().map(|shading| shading.picture.coverage.clone()).collect(),
            ))),
            (_, None) => Some(None),
        }
    }

    fn of(document: &Document, part: &Part, source: &OutlineSource) -> Option<Self> {
        Some(match source {
            OutlineSource::Layer { layer, color } => {
                let layer = document.layer_named(layer)?;
                let color = color.map(|flat| document.area_of(part, flat));
                Self::Layer(Box::new(DrawnLayer::of(document, layer, part)?), color)
            }
            OutlineSource::File(CoverageFile { coverage, .. }) => Self::Coverage(coverage.clone()),
            OutlineSource::Selection(name) => {
                let kept = &document.selections.iter().find(|kept| kept.name == *name)?.selection;
                match kept.made {
                    Some(region) => Self::Region(region, document.maps_surface().cloned()),
                    None => Self::Selection(kept.clone()),
                }
            }
            OutlineSource::Path(_) => Self::Path(source.clone()),
            OutlineSource::Object(object) => {
                Self::Object(document.maps_surface()?.clone(), *object)
            }
        })
    }

    pub fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Layer(a, x), Self::Layer(b, y)) => x == y && a.is_same(b),
            (Self::Coverage(a), Self::Coverage(b)) => Arc::ptr_eq(a, b),
            (Self::Selection(a), Self::Selection(b)) => Arc::ptr_eq(a, b),
            (Self::Region(a, on), Self::Region(b, other)) => {
                let same = on.as_ref().map(Arc::as_ptr) == other.as_ref().map(Arc::as_ptr);
                a == b && same
            }
            (Self::Path(a), Self::Path(b)) => a == b,
            (Self::Profiles(a), Self::Profiles(b)) => {
                a.len() == b.len() && a.iter().zip(b).all(|(a, b)| Arc::ptr_eq(a, b))
            }
            (Self::Object(a, x), Self::Object(b, y)) => Arc::ptr_eq(a, b) && x == y,
            _ => false,
        }
    }

    /// The outline; `None` where nothing is covered.
    pub fn outline(&self, document: &Document, most_px: usize) -> Option<Outline> {
        self.placed_outline(document, most_px).map(|(outline, _)| outline)
    }

    /// The same, and whether it is of another area because its point no longer has its color.
    pub fn placed_outline(&self, document: &Document, most_px: usize) -> Option<(Outline, bool)> {
        let mut is_lost = false;
        let outline = match self {
            Self::Layer(drawn, color) => {
                if color.is_none()
                    && let Some(area) = drawn.path_area(document.size)
                {
                    return Some((outline_coverage(&area, most_px)?, false));
                }
                let tiles = drawn.pixels(document)?;
                let rect = tiles.bounds();
                if rect.is_empty()
                    || rect.width().checked_mul(rect.height()).is_none_or(|px| px > most_px)
                {
                    return None;
                }
                let coverage = match color {
                    None => alpha(&tiles, rect),
                    Some(area) => {
                        let corner = vec2(rect.x0 as f32, rect.y0 as f32);
                        let flats = document.parts.flats_of(&tiles, &area.part_colors())?;
                        let (share, is_beside) = area.share(&flats, corner)?;
                        is_lost = is_beside;
                        share
                    }
                };
                Outline::new((rect.x0, rect.y0), &coverage)
            }
            Self::Coverage(coverage) => Outline::new((0, 0), coverage),
            Self::Selection(selection) => outline_coverage(&selection.coverage, most_px),
            Self::Region(region, surface) => {
                let scene = Scene { size: document.size, surface: surface.clone() };
                outline_coverage(&Selection::of_region(*region, &scene).coverage, most_px)
            }
            Self::Profiles(pictures) => {
                let size = pictures.first()?.size();
                let is_inside = |x: usize, y: usize| {
                    pictures.iter().any(|p| p.get(x as i32, y as i32).unwrap_or(0) > 0)
                };
                Outline::new(
                    (0, 0),
                    &Plane::from_fn(size, |x, y| if is_inside(x, y) { 255 } else { 0 }),
                )
            }
            Self::Path(OutlineSource::Path(points)) => Outline::of_path(points, most_px),
            Self::Path(_) => None,
            Self::Object(surface, object) => {
                let objects = surface.objects();
                let labels = objects.labels();
                let coverage = Plane::from_fn(surface.size(), |x, y| {
                    if labels.at(x, y) == *object { surface.coverage(x, y) } else { 0 }
                });
                Outline::new((0, 0), &coverage)
            }
        };
        Some((outline?, is_lost))
    }
}

/// The outline of coverage in tiles.
fn outline_coverage(coverage: &CoverageGrid, most_px: usize) -> Option<Outline> {
    let rect = coverage.covered_rect();
    if rect.is_empty() || rect.width().checked_mul(rect.height()).is_none_or(|px| px > most_px) {
        return None;
    }
    Outline::new((rect.x0, rect.y0), &coverage.to_plane(rect))
}

fn size_of(rect: Rect) -> Size {
    Size::new(rect.width() as u32, rect.height() as u32)
}

fn alpha(tiles: &TileGrid, rect: Rect) -> Plane<u8> {
    Plane::from_fn(size_of(rect), |x, y| tiles.pixel(rect.x0 + x as i32, rect.y0 + y as i32)[3])
}
