//! The line around a shape: how it is drawn and with what, and where it lies. Floor 5. Layers whose
//! pixels are in the file show it there. Not here: the paths (`outline`).

use super::RecordMask;
use super::colors::Colors;
use super::descriptor::DescriptorObject;
use super::effects;
use super::fill::{LayerFill, share};
use super::fill_block;
use super::outline::VectorPaths;
use crate::math::Size;
use crate::paint::effect::StrokePosition;
use crate::raster::BlendMode;
use tiny_skia::{FillRule, LineCap, LineJoin, Mask, Stroke, StrokeDash, Transform};

/// The widest line that is drawn.
const WIDEST_PX: f32 = 2000.0;
/// Lengths of dashes and gaps that a line may have, and dashes that are drawn.
const MOST_LENGTHS: usize = 32;
const MOST_DASHES: f32 = 20_000.0;
/// Points of an inch.
const POINTS: f32 = 72.0;

/// A line along a shape's paths.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeLine {
    /// What it is drawn with.
    pub fill: LayerFill,
    /// Of the line alone.
    pub opacity: f32,
    /// How it is blended with what fills the shape.
    pub blend: BlendMode,
    width_px: f32,
    position: StrokePosition,
    cap: LineCap,
    join: LineJoin,
    miter_limit: f32,
    /// Lengths of dashes and gaps in turn, px; none of a whole line.
    dashes: Vec<f32>,
    dash_offset_px: f32,
    /// Where it lies, once it was drawn.
    pub coverage: Option<RecordMask>,
}

impl ShapeLine {
    /// `None` where it is not understood.
    pub fn read(said: &DescriptorObject, colors: &Colors) -> Option<Self> {
        let resolution = said.number("strokeStyleResolution").unwrap_or(POINTS).max(1.0);
        let px = |name: &str| {
            let per_unit = if said.is_in_points(name) { resolution / POINTS } else { 1.0 };
            said.number(name).map(|v| v * per_unit)
        };
        let width_px = px("strokeStyleLineWidth")?.max(0.0).min(WIDEST_PX);
        let dashes: Vec<f32> = said
            .numbers("strokeStyleLineDashSet")
            .take(MOST_LENGTHS)
            .map(|length| length.max(0.0) * width_px)
            .collect();
        let mut line = Self {
            fill: fill_block::of_line(said.object("strokeStyleContent")?, colors)?,
            opacity: share(said, "strokeStyleOpacity", 1.0).max(0.0).min(1.0),
            blend: effects::blend(said, "strokeStyleBlendMode").unwrap_or(BlendMode::Normal),
            width_px,
            position: match said.word("strokeStyleLineAlignment") {
                Some(b"strokeStyleAlignInside") => StrokePosition::Inside,
                Some(b"strokeStyleAlignOutside") => StrokePosition::Outside,
                _ => StrokePosition::Center,
            },
            cap: match said.word("strokeStyleLineCapType") {
                Some(b"strokeStyleRoundCap") => LineCap::Round,
                Some(b"strokeStyleSquareCap") => LineCap::Square,
                _ => LineCap::Butt,
            },
            join: match said.word("strokeStyleLineJoinType") {
                Some(b"strokeStyleRoundJoin") => LineJoin::Round,
                Some(b"strokeStyleBevelJoin") => LineJoin::Bevel,
                _ => LineJoin::Miter,
            },
            miter_limit: said.number("strokeStyleMiterLimit").unwrap_or(100.0).max(1.0).min(1000.0),
            dash_offset_px: px("strokeStyleLineDashOffset").unwrap_or(0.0).max(-1e6).min(1e6),
            dashes,
            coverage: None,
        };
        // An odd number counts twice.
        if line.dashes.len() % 2 == 1 {
            line.dashes.extend_from_within(..);
        }
        Some(line)
    }

    /// Draws it along paths. `filled`: what they cover, row by row. Whether it could be drawn.
    pub fn try_draw(&mut self, paths: &VectorPaths, size: Size, filled: &[u8]) -> bool {
        let Some((path, length_px)) = paths.path_of_line(size) else { return false };
        let period: f32 = self.dashes.iter().sum();
        let has_dashes = !self.dashes.is_empty() && period > 0.0;
        if has_dashes && length_px / period * (self.dashes.len() / 2) as f32 > MOST_DASHES {
            return false;
        }
        let is_centered = self.position == StrokePosition::Center;
        let stroke = Stroke {
            width: if is_centered { self.width_px } else { 2.0 * self.width_px },
            miter_limit: self.miter_limit,
            line_cap: self.cap,
            line_join: self.join,
            dash: None,
        };
        let drawn = || {
            let path = match has_dashes {
                true => {
                    let dashes = StrokeDash::new(self.dashes.clone(), self.dash_offset_px)?;
                    path.dash(&dashes, 1.0)?
                }
                false => path,
            };
            let outline = path.stroke(&stroke, 1.0)?;
            let mut mask = Mask::new(size.width, size.height)?;
            mask.fill_path(&outline, FillRule::Winding, true, Transform::identity());
            Some(mask)
        };
        let Some(drawn) = drawn() else { return false };
        let product = |a: u8, b: u8| ((u32::from(a) * u32::from(b) + 127) / 255) as u8;
        let part = |(line, fill): (&u8, &u8)| match self.position {
            StrokePosition::Center => *line,
            StrokePosition::Inside => product(*line, *fill),
            StrokePosition::Outside => product(*line, 255 - *fill),
        };
        let values = drawn.data().iter().zip(filled).map(part).collect();
        self.coverage = Some(RecordMask::of_canvas(size, values));
        true
    }
}
