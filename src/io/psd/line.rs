//! The line around a shape: how it is drawn and with what, and where it lies. Floor 5. Layers whose
//! pixels are in the file show it there. Not here: the paths (`outline`).

use super::colors::Colors;
use super::descriptor::{DescriptorObject, DescriptorWriter};
use super::effects;
use super::fill::{LayerFill, share};
use super::fill_block;
use super::outline::{VectorPaths, length_px};
use super::{LayerRecord, RecordMask};
use crate::math::srgb::{self, Color};
use crate::math::{Size, Vec2};
use crate::paint::effect::StrokePosition;
use crate::paint::{LivePath, PathCap, PathJoin, Subpath};
use crate::raster::BlendMode;
use tiny_skia::{FillRule, LineCap, LineJoin, Mask, Stroke, StrokeDash, Transform};

/// The widest line that is drawn.
const WIDEST_PX: f32 = 2000.0;
/// Lengths of dashes and gaps that a line may have, and dashes that are drawn.
const MOST_LENGTHS: usize = 32;
const MOST_DASHES: f32 = 20_000.0;
/// Points of an inch.
const POINTS: f32 = 72.0;

/// What is noted of shapes whose line no path has.
const FILLED: &str = "it is no live path: the line of a path here has one color";
const ASIDE: &str = "it is no live path: the line of a path here lies half inside of its edge";
const BLENDED: &str = "it is no live path: the line of a path here is blended as the path is";
const DASHED: &str = "it is no live path: its line has too many dashes, or begins within one";
const SHARP: &str = "it is no live path: its line is cut at other corners than that of a path here";

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
            .doubles("strokeStyleLineDashSet")
            .take(MOST_LENGTHS)
            .map(|length| (length.max(0.0) * f64::from(width_px)) as f32)
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

    /// The outline of a path, which has one; `None` where the format cannot hold it.
    pub fn of_path(path: &LivePath) -> Option<Self> {
        if path.outline <= 0.0 || path.outline > WIDEST_PX {
            return None;
        }
        Some(Self::of_outline(path))
    }

    fn of_outline(path: &LivePath) -> Self {
        let opacity = f32::from(path.outline_color.a) / 255.0;
        let mut dashes = path.dashes.clone();
        if dashes.len() % 2 == 1 {
            dashes.extend_from_within(..);
        }
        Self {
            fill: LayerFill::Solid(Color { a: 255, ..path.outline_color }),
            opacity,
            blend: BlendMode::Normal,
            width_px: path.outline,
            position: StrokePosition::Center,
            cap: match path.cap {
                PathCap::Butt => LineCap::Butt,
                PathCap::Round => LineCap::Round,
                PathCap::Square => LineCap::Square,
            },
            join: match path.join {
                PathJoin::Miter => LineJoin::Miter,
                PathJoin::Round => LineJoin::Round,
                PathJoin::Bevel => LineJoin::Bevel,
            },
            miter_limit: LivePath::MITER,
            dashes,
            dash_offset_px: 0.0,
            coverage: None,
        }
    }

    /// What is written of a shape without a line.
    pub fn unseen() -> Self {
        let black = LivePath { outline: 1.0, ..LivePath::new(Vec::new()) };
        Self::of_outline(&black)
    }

    /// A path with this line as its outline; what is noted where no path has it.
    pub fn draw_on(&self, path: LivePath) -> Result<LivePath, &'static str> {
        let LayerFill::Solid(color) = self.fill else { return Err(FILLED) };
        if self.position != StrokePosition::Center {
            return Err(ASIDE);
        }
        if self.blend != BlendMode::Normal {
            return Err(BLENDED);
        }
        let has_dashes = self.has_dashes();
        let is_odd = self.dashes.len() > LivePath::MOST_DASHES || self.dash_offset_px != 0.0;
        let lines = path.subpaths();
        if has_dashes && (is_odd || self.count_dashes(length_px(&lines)) > MOST_DASHES) {
            return Err(DASHED);
        }
        let is_mitered = self.join == LineJoin::Miter;
        let limits = [self.miter_limit, LivePath::MITER];
        let is_cut_alike = |ratio: f32| (ratio > limits[0]) == (ratio > limits[1]);
        if is_mitered && !lines.iter().all(|line| miters(line).all(is_cut_alike)) {
            return Err(SHARP);
        }
        drop(lines);
        Ok(LivePath {
            outline: self.width_px,
            outline_color: Color { a: srgb::quantize(self.opacity), ..color },
            cap: match self.cap {
                LineCap::Butt => PathCap::Butt,
                LineCap::Round => PathCap::Round,
                LineCap::Square => PathCap::Square,
            },
            join: match self.join {
                LineJoin::Round => PathJoin::Round,
                LineJoin::Bevel => PathJoin::Bevel,
                LineJoin::Miter | LineJoin::MiterClip => PathJoin::Miter,
            },
            dashes: if has_dashes { self.dashes.clone() } else { Vec::new() },
            ..path
        })
    }

    fn has_dashes(&self) -> bool {
        self.dashes.iter().sum::<f32>() > 0.0
    }

    /// The dashes of a line that is so long.
    fn count_dashes(&self, length_px: f32) -> f32 {
        length_px / self.dashes.iter().sum::<f32>() * (self.dashes.len() / 2) as f32
    }

    /// The block of a line of one color around a record's shape.
    pub fn block(&self, record: &LayerRecord) -> Vec<u8> {
        let mut out = DescriptorWriter::default();
        out.whole("strokeStyleVersion", 2.0);
        out.flag("strokeEnabled", record.stroked);
        out.flag("fillEnabled", !record.unfilled);
        out.measure("strokeStyleLineWidth", "#Pxl", f64::from(self.width_px));
        out.measure("strokeStyleLineDashOffset", "#Pnt", f64::from(self.dash_offset_px));
        out.double("strokeStyleMiterLimit", f64::from(self.miter_limit));
        let mut choose = |name: &str, word: &str| out.word(name, name, word);
        choose(
            "strokeStyleLineCapType",
            match self.cap {
                LineCap::Butt => "strokeStyleButtCap",
                LineCap::Round => "strokeStyleRoundCap",
                LineCap::Square => "strokeStyleSquareCap",
            },
        );
        choose(
            "strokeStyleLineJoinType",
            match self.join {
                LineJoin::Round => "strokeStyleRoundJoin",
                LineJoin::Bevel => "strokeStyleBevelJoin",
                LineJoin::Miter | LineJoin::MiterClip => "strokeStyleMiterJoin",
            },
        );
        choose(
            "strokeStyleLineAlignment",
            match self.position {
                StrokePosition::Inside => "strokeStyleAlignInside",
                StrokePosition::Outside => "strokeStyleAlignOutside",
                StrokePosition::Center => "strokeStyleAlignCenter",
            },
        );
        out.flag("strokeStyleScaleLock", false);
        out.flag("strokeStyleStrokeAdjust", false);
        // Each by the width of the line.
        let share = |dash: &f32| f64::from(*dash) / f64::from(self.width_px);
        let dashes: Vec<f64> = self.dashes.iter().map(share).collect();
        out.measures("strokeStyleLineDashSet", "#Nne", &dashes);
        out.word("strokeStyleBlendMode", "BlnM", "Nrml");
        out.measure("strokeStyleOpacity", "#Prc", f64::from(self.opacity) * 100.0);
        let mut content = DescriptorWriter::default();
        if let LayerFill::Solid(color) = self.fill {
            content.color("Clr ", color);
        }
        out.object("strokeStyleContent", "solidColorLayer", content);
        out.double("strokeStyleResolution", f64::from(POINTS));
        out.into_bytes_of("strokeStyle")
    }

    /// Draws it along paths. `filled`: what they cover, row by row. Whether it could be drawn.
    pub fn try_draw(&mut self, paths: &VectorPaths, size: Size, filled: &[u8]) -> bool {
        let Some((path, length_px)) = paths.path_of_line(size) else { return false };
        let has_dashes = self.has_dashes();
        if has_dashes && self.count_dashes(length_px) > MOST_DASHES {
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

/// How far a sharp corner reaches at each node that a line turns at, by the line's width.
fn miters(line: &Subpath) -> impl Iterator<Item = f32> + '_ {
    let count = line.count_curves();
    let direction = |curve: [Vec2; 4], from: [usize; 3], end: usize| {
        let away = from.into_iter().map(|i| curve[i] - curve[end]);
        away.map(Vec2::normalize_or_zero).find(|v| *v != Vec2::ZERO).unwrap_or(Vec2::ZERO)
    };
    let curves: Vec<[Vec2; 4]> = line.curves().collect();
    let turns = if line.closed { count } else { count.saturating_sub(1) };
    (0..turns).map(move |i| {
        let back = direction(curves[i], [2, 1, 0], 3);
        let on = direction(curves[(i + 1) % count], [1, 2, 3], 0);
        // Of half the angle between both.
        let sin = (0.5 * (1.0 - back.dot(on))).max(0.0).sqrt();
        1.0 / sin.max(1e-6)
    })
}
