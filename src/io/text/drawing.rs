//! The picture of a text, painted from the outlines of its lines: those that are where they were are
//! not painted again. The same bytes as those of the text's file (`svg`). Floor 5.

use super::shaped::ShapedLine;
use crate::math::{Rect, Size, Vec2, vec2};
use crate::raster::{Picture, VectorDrawing};
use crate::svg::{self, PaintedPaths, PlainPath};
use crate::{Budget, Error, Result};
use resvg::usvg::{self, Transform};
use std::any::Any;
use std::path::Path;
use std::sync::Arc;

/// A line that was shaped, in its place.
pub(super) struct PlacedLine {
    pub shaped: Arc<ShapedLine>,
    /// Where its origin lies, px.
    pub at: Vec2,
}

impl PlacedLine {
    /// All that is inked of it, px.
    pub fn inked_rect(&self) -> Option<usvg::Rect> {
        let (x, y) = (self.at.x, self.at.y);
        let inked = self.shaped.inked?;
        let (left, top) = (inked.left() + x, inked.top() + y);
        usvg::Rect::from_ltrb(left, top, inked.right() + x, inked.bottom() + y)
    }
}

/// A text as a drawing.
#[derive(Debug)]
pub(super) struct TextDrawing {
    size: Vec2,
    paths: Vec<PlainPath>,
    /// Its picture, as it was first painted.
    painted: PaintedPaths,
}

impl TextDrawing {
    /// Paints lines, and tells which texels differ from those of an old picture. `None` if they hold
    /// anything but paths in plain colors.
    ///
    /// * `bounds`: the rectangle of the plane that the picture shows, px.
    pub fn of(
        lines: &[PlacedLine],
        bounds: Rect,
        old: Option<&Picture>,
        budget: &Budget,
    ) -> Result<Option<(Picture, Option<Rect>)>> {
        let file = Path::new(super::FILE);
        let mut paths = Vec::new();
        for line in lines {
            let Some(own) = line.shaped.paths() else { return Ok(None) };
            let steps = [
                Transform::from_translate(-bounds.x0 as f32, -bounds.y0 as f32),
                Transform::from_translate(line.at.x, line.at.y),
            ];
            let steps: Vec<_> = steps.into_iter().filter(|step| !step.is_identity()).collect();
            paths.extend(own.iter().map(|path| path.within(&steps)));
        }
        let size = vec2(bounds.width() as f32, bounds.height() as f32);
        let (scale, px) = svg::layer_size(file, size, budget)?;
        let known = old.and_then(|old| old.drawing.as_ref()?.as_any().downcast_ref::<Self>());
        let painted = match known {
            Some(known) => known.painted.repaint(&paths, px, scale),
            None => PaintedPaths::paint(&paths, px, scale).map(|painted| (painted, None)),
        };
        let failed = || Error::decode(file, "the text cannot be painted");
        let (painted, changed) = painted.ok_or_else(failed)?;
        let picture = Picture::of_bytes(px, painted.texels.clone()).ok_or_else(failed)?;
        let drawing = Some(Arc::new(Self { size, paths, painted }) as Arc<dyn VectorDrawing>);
        Ok(Some((Picture { drawing, ..picture }, changed)))
    }
}

impl VectorDrawing for TextDrawing {
    fn size(&self) -> Vec2 {
        self.size
    }

    fn draw(&self, size: Size) -> Option<Vec<[u8; 4]>> {
        let scale = size.width as f32 / self.size.x;
        Some(PaintedPaths::paint(&self.paths, size, scale)?.texels.to_vec())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
