//! Another canvas under the same drawing: crops, other borders, turns, mirrors. Floor 4.
//!
//! Everything follows: paint, live layers, transforms, masks, selections, the maps with their
//! vectors, the parts of the shape. Moves of whole pixels, quarter turns and mirrors change no
//! value of paint; a turn by another angle turns paint by its transform, so that turns that cancel
//! out leave nothing. What lies beyond the new canvas is kept, except for masks. Not here: another
//! size of the picture itself (`scale`).

mod layers;
mod parts;
mod selections;
mod shape_move;

#[cfg(test)]
mod tests;

use super::{Document, NamedSelection};
use crate::math::plane_map::PixelMove;
use crate::math::{Mat2, PlaneMap, Rect, Size, Vec2, vec2};
use crate::paint::Selection;
use crate::raster::Resampling;
use crate::surface::SurfaceError;
use selections::CarriedSelections;
use std::sync::Arc;

crate::named! {
    /// Which part of the old picture stays in place when the size of the canvas changes.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
    pub enum CanvasAnchor {
        TopLeft = "top-left",
        Top = "top",
        TopRight = "top-right",
        Left = "left",
        #[default]
        Center = "center",
        Right = "right",
        BottomLeft = "bottom-left",
        Bottom = "bottom",
        BottomRight = "bottom-right",
    }
}

impl CanvasAnchor {
    /// Halves of what is added that go to the left and to the top.
    fn halves(self) -> (i32, i32) {
        let place = Self::ALL.iter().position(|(anchor, _)| *anchor == self).unwrap_or(4) as i32;
        (place % 3, place / 3)
    }
}

crate::named! {
    /// Which sides a mirror exchanges.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
    pub enum CanvasMirror {
        /// Left and right.
        #[default]
        LeftRight = "left-right",
        /// Top and bottom.
        UpDown = "up-down",
    }
}

/// A rigid map of a canvas to another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CanvasChange {
    /// From points of the old canvas to points of the new one; lengths stay.
    map: PlaneMap,
    from: Size,
    to: Size,
}

impl CanvasChange {
    /// To a rectangle of the old canvas, which may reach beyond it; `None` for an empty one.
    pub fn crop(from: Size, to: Rect) -> Option<Self> {
        let map = PlaneMap::translation(vec2(-to.x0 as f32, -to.y0 as f32));
        (!to.is_empty()).then(|| Self {
            map,
            from,
            to: Size::new(to.width() as u32, to.height() as u32),
        })
    }

    /// To another size; the anchor says what stays in place. The smaller half of an odd difference
    /// comes first. `None` for a size without pixels.
    pub fn resize(from: Size, to: Size, anchor: CanvasAnchor) -> Option<Self> {
        let (across, down) = anchor.halves();
        let (wider, taller) =
            (to.width as i32 - from.width as i32, to.height as i32 - from.height as i32);
        let (x0, y0) = (-(wider * across).div_euclid(2), -(taller * down).div_euclid(2));
        Self::crop(from, Rect::new(x0, y0, x0 + to.width as i32, y0 + to.height as i32))
    }

    /// Turned by so many quarters, counter-clockwise as seen.
    pub fn quarter_turns(from: Size, turns: i32) -> Self {
        let (w, h) = (f64::from(from.width), f64::from(from.height));
        let (matrix, to) = match turns.rem_euclid(4) {
            0 => ([1.0, 0.0, 0.0, 1.0, 0.0, 0.0], from),
            1 => ([0.0, -1.0, 1.0, 0.0, 0.0, w], Size::new(from.height, from.width)),
            2 => ([-1.0, 0.0, 0.0, -1.0, w, h], from),
            _ => ([0.0, 1.0, -1.0, 0.0, h, 0.0], Size::new(from.height, from.width)),
        };
        Self { map: PlaneMap::affine(matrix).unwrap_or_default(), from, to }
    }

    /// Turned by an angle, degrees counter-clockwise as seen, on a canvas that holds all of the old
    /// one. Its sides are odd if the old ones are, so that pixels turned back lie on pixels.
    pub fn turn(from: Size, degrees: f64) -> Self {
        let quarters = (degrees / 90.0).round();
        if !degrees.is_finite() || (degrees - quarters * 90.0).abs() < 1e-6 {
            return Self::quarter_turns(
                from,
                if degrees.is_finite() { quarters.rem_euclid(4.0) as i32 } else { 0 },
            );
        }
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let (w, h) = (f64::from(from.width), f64::from(from.height));
        let side = |v: f64, old: u32| {
            let least = (v - 1e-6).ceil().max(1.0) as u32;
            least + (least + old) % 2
        };
        let width = side(w * cosine.abs() + h * sine.abs(), from.width);
        let height = side(w * sine.abs() + h * cosine.abs(), from.height);
        let to = Size::new(width, height);
        let map = PlaneMap::rotation(degrees, from.center())
            .then(&PlaneMap::translation(to.center() - from.center()));
        Self { map, from, to }
    }

    /// A canvas that is mirrored.
    pub fn mirror(from: Size, mirror: CanvasMirror) -> Self {
        let matrix = match mirror {
            CanvasMirror::LeftRight => [-1.0, 0.0, 0.0, 1.0, f64::from(from.width), 0.0],
            CanvasMirror::UpDown => [1.0, 0.0, 0.0, -1.0, 0.0, f64::from(from.height)],
        };
        Self { map: PlaneMap::affine(matrix).unwrap_or_default(), from, to: from }
    }

    /// The size of the new canvas.
    pub fn size(&self) -> Size {
        self.to
    }

    /// Where a point of the old canvas lies on the new one.
    pub fn point(&self, p: Vec2) -> Vec2 {
        self.map.to_canvas(p).unwrap_or(p)
    }

    /// It changes nothing.
    pub fn is_none(&self) -> bool {
        self.from == self.to && self.map.is_identity_on(self.from)
    }

    /// Its move by whole pixels, if it is one.
    fn pixel_move(&self) -> Option<PixelMove> {
        self.map.pixel_move_on(self.reach())
    }

    /// A canvas as large as both.
    fn reach(&self) -> Size {
        Size::new(self.from.width.max(self.to.width), self.from.height.max(self.to.height))
    }

    /// Its matrix: orthogonal.
    fn matrix(&self) -> Mat2 {
        self.map.as_affine().map_or(Mat2::IDENTITY, |map| map.matrix2)
    }

    /// It moves, and neither turns nor mirrors.
    fn is_shift(&self) -> bool {
        self.matrix() == Mat2::IDENTITY
    }

    /// The old canvas lies wholly on the new one.
    fn has_whole_old_canvas(&self) -> bool {
        let (w, h) = (self.from.width as f32, self.from.height as f32);
        let (right, bottom) = (self.to.width as f32 + 0.01, self.to.height as f32 + 0.01);
        [vec2(0.0, 0.0), vec2(w, 0.0), vec2(w, h), vec2(0.0, h)].into_iter().all(|corner| {
            let at = self.point(corner);
            at.min_element() >= -0.01 && at.x <= right && at.y <= bottom
        })
    }
}

impl Document {
    /// The drawing on another canvas. Layers keep their ids.
    ///
    /// Fails, in a sentence, where nothing of the shape would be left, and where the corners of the
    /// new canvas cannot express a layer's perspective.
    pub fn on_other_canvas(&self, change: &CanvasChange) -> Result<Document, String> {
        if change.is_none() {
            return Ok(self.clone());
        }
        let carried = CarriedSelections::new(change);
        // What lies on parts is carried as it shows, and put on them again at their new places.
        let lifted = self.detach(|_| true);
        let layers = layers::Carrier { change, selections: &carried }.layers(&lifted.layers)?;
        let maps = self.maps_surface().map(|maps| maps.transformed(change.to, &change.map));
        let maps = maps.transpose().map_err(|error| match error {
            SurfaceError::Empty => NOTHING_LEFT.to_owned(),
            other => format!("The surface cannot be moved: {other}."),
        })?;
        let source = self.surface_source.as_ref().zip(maps.as_ref());
        let kept = |kept: &NamedSelection| NamedSelection {
            selection: carried.of(&kept.selection),
            ..kept.clone()
        };
        let shows = |selection: &Arc<Selection>| {
            !selection.coverage.covered_rect().intersect(change.to.rect()).is_empty()
        };
        let both = self.maps_surface().zip(maps.as_ref()).map(|(old, new)| [old, new]);
        let parts = parts::transform_parts(&self.parts.list, change, both);
        let bare = Document {
            size: change.to,
            profile: self.profile,
            surface_source: source.map(|(source, maps)| Arc::new(source.placed_as(maps))),
            surface: maps,
            surface_files: self.surface_files.clone(),
            parts: Arc::default(),
            layers,
            selections: self.selections.iter().map(kept).collect(),
            active_selection: self
                .active_selection
                .as_ref()
                .map(|own| carried.of(own))
                .filter(shows),
            guides: Arc::new(self.guides.transformed(&change.map)),
            effect_light: self.effect_light,
            assistants: Arc::new(
                self.assistants.iter().filter_map(|own| own.transformed(&change.map)).collect(),
            ),
            symmetry: self.symmetry.transformed(&change.map, [self.size, change.to]),
            palette: self.palette.clone(),
        };
        let next =
            if parts.is_empty() { bare } else { bare.with_parts(parts).with_attachments_of(self) };
        if self.surface.is_some() && next.surface.is_none() {
            return Err(NOTHING_LEFT.into());
        }
        Ok(next.with_selections_found())
    }
}

const NOTHING_LEFT: &str =
    "The new canvas would hold nothing of the shape: layers could not be kept to it.";

/// How turned paint is sampled, unless its layer says otherwise.
const TURNED: Resampling = Resampling::Smooth;
