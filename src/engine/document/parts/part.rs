//! One part: how it is made, what it lies on, and the outline and pictures that it names.
//! Floor 4.

use super::{CoverageFile, Inflation, OutlineSource, Part, PartKind};
use crate::math::{Affine2, COORDINATE, Range, Vec2};
use crate::shape::Combine;

impl OutlineSource {
    /// What it has of points in the part's frame, which go where that goes.
    pub(in crate::document) fn points_mut(&mut self) -> impl Iterator<Item = &mut Vec2> {
        let (path, place): (&mut [Vec2], Option<&mut Vec2>) = match self {
            OutlineSource::Path(points) => (points, None),
            OutlineSource::Layer { color: Some(flat), .. } => (&mut [], flat.at.as_mut()),
            _ => (&mut [], None),
        };
        path.iter_mut().chain(place)
    }
}

impl Part {
    /// Degrees that a part may lean, each way.
    pub const TILT: Range = -80.0..=80.0;
    /// Pixels that a part may be nearer or farther.
    pub const RAISE: Range = -8192.0..=8192.0;
    /// Letters of an id and of a name.
    pub const LONGEST_NAME: usize = 1000;
    /// The range of each number of a matrix.
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

    /// The part that this one changes, if it is no form of its own.
    pub fn on(&self) -> Option<&str> {
        match &self.kind {
            PartKind::Touches { on, .. }
            | PartKind::Sculpt { on, .. }
            | PartKind::Relief { on, .. }
            | PartKind::Lines { on, .. } => Some(on),
            _ => None,
        }
    }

    /// Lets it change another part, if it is no form of its own.
    pub fn lie_on(&mut self, part: &str) {
        match &mut self.kind {
            PartKind::Touches { on, .. }
            | PartKind::Sculpt { on, .. }
            | PartKind::Relief { on, .. }
            | PartKind::Lines { on, .. } => part.clone_into(on),
            _ => {}
        }
    }

    /// What it is made of; for lines, their ink.
    pub fn outline(&self) -> Option<&OutlineSource> {
        match &self.kind {
            PartKind::Inflate { outline, .. }
            | PartKind::Bevel { outline, .. }
            | PartKind::Lathe { outline, .. } => Some(outline),
            PartKind::Lines { ink, .. } => Some(ink),
            PartKind::Profiles { outline, .. } => outline.as_ref(),
            _ => None,
        }
    }

    pub(in crate::document) fn outline_mut(&mut self) -> Option<&mut OutlineSource> {
        match &mut self.kind {
            PartKind::Inflate { outline, .. }
            | PartKind::Bevel { outline, .. }
            | PartKind::Lathe { outline, .. } => Some(outline),
            PartKind::Lines { ink, .. } => Some(ink),
            PartKind::Profiles { outline, .. } => outline.as_mut(),
            _ => None,
        }
    }

    /// A point of the one area of a color that it takes, if it takes one.
    pub fn area_point(&self) -> Option<Vec2> {
        match self.outline() {
            Some(OutlineSource::Layer { color, .. }) => color.and_then(|flat| flat.at),
            _ => None,
        }
    }

    /// Takes only the area of its color at a point of its frame, if it takes a color.
    pub fn set_area_point(&mut self, at: Vec2) {
        if let Some(OutlineSource::Layer { color: Some(flat), .. }) = self.outline_mut() {
            flat.at = Some(at);
        }
    }

    /// Whether it takes a color wherever that is.
    pub fn is_of_color(&self) -> bool {
        matches!(self.outline(), Some(OutlineSource::Layer { color: Some(flat), .. }) if flat.at.is_none())
    }

    /// The pictures that it names, to be renamed. Maps have names of their own.
    pub fn files_mut(&mut self) -> Vec<&mut CoverageFile> {
        fn of_outline(outline: &mut OutlineSource) -> Option<&mut CoverageFile> {
            if let OutlineSource::File(file) = outline { Some(file) } else { None }
        }
        match &mut self.kind {
            PartKind::Inflate { outline, .. }
            | PartKind::Bevel { outline, .. }
            | PartKind::Lathe { outline, .. }
            | PartKind::Lines { ink: outline, .. } => of_outline(outline).into_iter().collect(),
            PartKind::Profiles { outline, shadings } => {
                let own = outline.as_mut().and_then(of_outline);
                own.into_iter()
                    .chain(shadings.iter_mut().map(|shading| &mut shading.picture))
                    .collect()
            }
            PartKind::Relief { picture, .. } => vec![picture],
            _ => Vec::new(),
        }
    }
}
