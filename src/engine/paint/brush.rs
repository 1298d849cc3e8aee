//! A brush: the footprint of one dab and how dabs follow each other. Floor 3. `dual_brush` is its
//! second tip. Not here: how pen and surface drive it (`dynamics`), the dabs themselves
//! (`dab_walker`).

pub mod dual_brush;

use super::brush_options::{
    Cycle, DistanceMetric, Falloff, Offset, Pickup, Rate, Spread, StylusFilter,
};
use super::dynamics::{Dynamics, Input, Property};
use super::grain::{BrushGrain, GrainSource};
use super::image::PictureSource;
use super::tip::{Bristles, Hose, Noise};
use crate::math::{Mat2, Range, UNIT, Vec2, range::clamp_to_range};
use crate::raster::BlendMode;
use crate::surface::PaintLimit;
use dual_brush::{DualBrush, DualSettings};
use std::sync::Arc;

/// The settings of a brush. Lengths are canvas px, ratios plain numbers.
#[derive(Clone, PartialEq)]
pub struct Brush {
    /// Diameter of a dab, px, `> 0`.
    pub size: f32,
    /// Ratio of the radius that is fully covered, `[0, 1]`; beyond it coverage falls off to 0 at
    /// the rim.
    pub hardness: f32,
    /// Opacity of the whole stroke, `[0, 1]`.
    pub opacity: f32,
    /// Coverage that one dab adds, `[0, 1]`.
    pub flow: f32,
    /// Distance between dabs, a ratio of the diameter, `> 0`; for a flat tip, of its width along
    /// the stroke.
    pub spacing: f32,
    /// What that distance, the cycle and the input distance are measured on.
    pub spacing_on: DistanceMetric,
    /// How many dabs overlap, `≥ 1`: each adds 1 − (1 − flow)^(1/overlap), so that together they
    /// reach the flow.
    pub overlap: f32,
    /// How the coverage of round, elliptic and square tips falls off.
    pub falloff: Falloff,
    /// Dabs in addition to those of the spacing.
    pub rate: Rate,
    /// Counter-clockwise as seen, degrees.
    pub rotation: f32,
    /// How symmetry turned or mirrored the stroke.
    pub facing: StrokeFrame,
    /// Blur of the footprint, `[0, 1]`: a rougher, less glossy mark. Its rim moves out by this
    /// share of the radius.
    pub softness: f32,
    /// How far a dab may be from the stroke, a ratio as `spread` says, `[0, 10]`.
    pub scatter: f32,
    /// How dabs are spread within the scatter.
    pub spread: Spread,
    /// How far sizes vary: their standard deviation in doublings. A dab that grows covers less: its
    /// paint is spread out.
    pub size_jitter: f32,
    /// How dabs are displaced from the stroke.
    pub offset: Offset,
    /// How far the color of each dab strays.
    pub jitter: ColorJitter,
    /// How the stroke blends with its layer.
    pub blend: BlendMode,
    /// The stroke erases from its layer instead of painting.
    pub erases: bool,
    /// The stroke shows only where its layer has paint, and keeps the coverage there.
    pub keeps_alpha: bool,
    /// Where the stroke may paint.
    pub bounded: PaintLimit,
    /// How far from the pen a bent mark may land, a ratio of the dab's diameter, in
    /// [`Brush::REACHES`]; 0 is no limit.
    pub reach: f32,
    /// What the brush does where its footprint lands. Strokes of a stroke layer always paint.
    pub mode: BrushMode,
    /// The paint that it picks up on its way.
    pub pickup: Pickup,
    /// What a dab looks like.
    pub tip: Tip,
    /// A texture that takes paint away.
    pub grain: Option<BrushGrain>,
    /// A second tip, whose stroke meets that of the first. Only painting brushes that pick up no
    /// paint use it: a stroke has to be whole before it is laid down.
    pub dual: Option<Arc<DualBrush>>,
    /// How the hand is smoothed. The samples of a stroke are smooth already: rendering it does not
    /// use this.
    pub stabilizer: Stabilizer,
    /// What its lengths are measured on.
    pub stabilizer_on: DistanceMetric,
    /// How the hand's movement becomes readings and dabs.
    pub stylus: StylusFilter,
    /// What drives [`Input::Cycle`].
    pub cycle: Cycle,
    /// What follows pen and surface, and how.
    pub dynamics: Dynamics,
    /// The seed of all randomness: the same seed and samples paint the same pixels.
    pub seed: u32,
}

/// The frame in which a stroke was drawn, relative to the canvas: first mirrored, then turned. Dabs
/// are rotated and scattered within this frame, so that mirror images match dab by dab.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct StrokeFrame {
    /// Counter-clockwise as seen, degrees.
    pub turn: f32,
    /// Mirrored left to right.
    pub is_mirrored: bool,
}

impl StrokeFrame {
    /// From an orthogonal map of the canvas, y down.
    pub fn of(map: Mat2) -> Self {
        let is_mirrored = map.determinant() < 0.0;
        let across = if is_mirrored { -map.x_axis } else { map.x_axis };
        Self { turn: (-across.y).atan2(across.x).to_degrees(), is_mirrored }
    }

    /// The linear map: canvas from the stroke's frame.
    pub fn map(self) -> Mat2 {
        let mirror = Mat2::from_diagonal(Vec2::new(if self.is_mirrored { -1.0 } else { 1.0 }, 1.0));
        // Counter-clockwise as seen is clockwise where y goes down.
        Mat2::from_angle(-self.turn_rad()) * mirror
    }

    /// The rotation on the canvas of a footprint rotated by this much within the frame; in a
    /// mirrored frame the footprint is also mirrored left to right.
    pub fn rotation_rad(self, within_rad: f32) -> f32 {
        if self.is_mirrored { self.turn_rad() - within_rad } else { self.turn_rad() + within_rad }
    }

    fn turn_rad(self) -> f32 {
        if self.turn.is_finite() { self.turn.to_radians() } else { 0.0 }
    }
}

/// What a brush does where its footprint lands. All modes but paint change the pixels of a paint
/// layer.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum BrushMode {
    /// Lays paint.
    #[default]
    Paint,
    /// Drags existing paint; `length` in `[0, 1]`, the share of it that is left after a drag of one
    /// radius.
    Smudge {
        /// How long it carries what it picked up.
        length: f32,
    },
    /// Softens the existing paint; `width` in `[0, 1]`: the standard deviation that a stroke
    /// leaves, a ratio of the radius.
    Blur {
        /// How wide it blurs, in radii of the dab.
        width: f32,
    },
    /// Copies from elsewhere.
    Clone {
        /// At the same offset for every stroke; otherwise every stroke starts at the source point.
        aligned: bool,
        /// Copies from the whole picture, not only from the layer.
        picture: bool,
    },
}

impl BrushMode {
    /// The defaults of a smudge's length and a blur's width.
    pub const SMUDGE_LENGTH: f32 = 0.8;
    /// The default of a blur's width.
    pub const BLUR_WIDTH: f32 = 0.3;
    /// What length and width may be.
    pub const SHARE: Range = UNIT;

    /// With its numbers clamped to their ranges.
    pub fn clamp_to_ranges(self) -> Self {
        match self {
            BrushMode::Paint | BrushMode::Clone { .. } => self,
            BrushMode::Smudge { length } => {
                BrushMode::Smudge { length: clamp_to_range(length, &Self::SHARE) }
            }
            BrushMode::Blur { width } => {
                BrushMode::Blur { width: clamp_to_range(width, &Self::SHARE) }
            }
        }
    }

    /// Whether it changes existing paint.
    pub fn is_retouching(self) -> bool {
        self != BrushMode::Paint
    }

    /// Whether it copies from elsewhere.
    pub fn is_clone(self) -> bool {
        matches!(self, BrushMode::Clone { .. })
    }
}

/// How far a dab's color may be from the stroke's, either way; drawn for each dab.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct ColorJitter {
    /// `[0, 180]`.
    pub hue_degrees: f32,
    /// `[0, 1]`, of the color's saturation and value (HSV).
    pub saturation: f32,
    /// `[0, 1]`, as for the saturation.
    pub value: f32,
}

impl ColorJitter {
    /// How far hues may stray.
    pub const HUE_DEGREES: Range = 0.0..=180.0;
}

/// How the tool smooths the pen's path before it becomes a stroke.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Stabilizer {
    /// The line is the hand's.
    #[default]
    None,
    /// The line follows the pen as a running average; `weight` in `[0, 1)` is the share of the past
    /// that is left after the pen has moved ten px, of the canvas or of the surface
    /// ([`Brush::stabilizer_on`]).
    Average {
        /// How much of the place before stays, `[0, 1)`.
        weight: f32,
    },
    /// The pen pulls the line on a string of this length, px: wiggles shorter than it do not show.
    String {
        /// How far the pen may be from the brush.
        length_px: f32,
    },
    /// The line follows the pen in time: after t, e^(−t/secs) of the lag is left. It ends when the
    /// pen lifts.
    Lag {
        /// How long the brush takes.
        secs: f32,
    },
}

impl Stabilizer {
    /// What the weight of an average may be.
    pub const WEIGHT: Range = UNIT;
    /// What the length of a string may be.
    pub const LENGTH_PX: Range = 0.0..=10_000.0;
    /// What a lag may be.
    pub const SECS: Range = 0.0..=10.0;
}

/// What a dab looks like before it is bent.
#[derive(Clone, PartialEq)]
pub enum Tip {
    /// A disc.
    Round,
    /// `ratio`: the shorter axis over the longer one, which is the diameter and lies along x; `(0,
    /// 1]`.
    Ellipse {
        /// The shorter axis, relative to the longer.
        ratio: f32,
    },
    /// A rectangle; its longer side is the diameter. Hardness and softness apply to each side.
    Square {
        /// The shorter side, relative to the longer.
        ratio: f32,
    },
    /// The ends of many hairs.
    Bristles(Bristles),
    /// Specks.
    Noise(Noise),
    /// A picture whose longer side is the diameter. An opaque gray picture is coverage, white
    /// covering fully; any other is a stamp in its own colors.
    Picture(PictureSource),
    /// One of several pictures each time.
    Hose(Hose),
}

impl Tip {
    /// What the ratio of its axes may be.
    pub const RATIO: Range = 0.01..=1.0;

    /// The pictures that it uses.
    pub fn pictures(&self) -> &[PictureSource] {
        match self {
            Tip::Picture(source) => std::slice::from_ref(source),
            Tip::Hose(hose) => hose.pictures(),
            _ => &[],
        }
    }

    /// The same tip with its pictures replaced, in that order.
    pub fn with_pictures<E>(
        &self,
        replace: impl FnMut(&PictureSource) -> Result<PictureSource, E>,
    ) -> Result<Self, E> {
        let pictures = self.pictures().iter().map(replace).collect::<Result<Vec<_>, E>>()?;
        Ok(match (self, pictures.as_slice()) {
            (Tip::Picture(_), [source]) => Tip::Picture(source.clone()),
            (Tip::Hose(hose), _) => Tip::Hose(hose.with_pictures(pictures)),
            _ => self.clone(),
        })
    }
}

impl Brush {
    /// Diameters that a file may hold, px.
    pub const SIZE: Range = 0.1..=20_000.0;
    /// Diameters that a user can set, px.
    pub const HAND_SIZE: Range = 1.0..=2000.0;
    /// A hundredth of the diameter looks like a line; less only costs time.
    pub const SPACING: Range = 0.01..=100.0;
    /// What scatter may be.
    pub const SCATTER: Range = 0.0..=10.0;
    /// The range of a reach.
    pub const REACHES: std::ops::RangeInclusive<f32> = 0.0..=100.0;
    /// The reach of the brushes that come with the program: on a rugged surface their marks stay
    /// near the pen.
    pub const NEAR: f32 = 3.0;

    /// The pictures that it uses: its tip's, then its grain's, then its second tip's.
    pub fn pictures(&self) -> impl Iterator<Item = &PictureSource> {
        let grain = self.grain.as_ref().and_then(|grain| match &grain.source {
            GrainSource::Picture(source) => Some(source),
            GrainSource::Pattern { .. } => None,
        });
        let second = self.dual.iter().flat_map(|dual| dual.tip.pictures());
        self.tip.pictures().iter().chain(grain).chain(second)
    }

    /// The same brush with its pictures replaced, in that order.
    pub fn with_pictures<E>(
        &self,
        mut replace: impl FnMut(&PictureSource) -> Result<PictureSource, E>,
    ) -> Result<Self, E> {
        let mut next = self.clone();
        next.tip = self.tip.with_pictures(&mut replace)?;
        if let Some(BrushGrain { source: GrainSource::Picture(source), .. }) = &mut next.grain {
            *source = replace(source)?;
        }
        if let Some(dual) = &self.dual {
            let tip = dual.tip.with_pictures(&mut replace)?;
            next.dual = Some(Arc::new(DualBrush { tip, ..(**dual).clone() }));
        }
        Ok(next)
    }
}

impl Default for Brush {
    fn default() -> Self {
        Self {
            size: 80.0,
            hardness: 0.5,
            opacity: 1.0,
            flow: 1.0,
            spacing: 0.1,
            spacing_on: DistanceMetric::default(),
            overlap: 1.0,
            falloff: Falloff::default(),
            rate: Rate::default(),
            rotation: 0.0,
            facing: StrokeFrame::default(),
            softness: 0.0,
            scatter: 0.0,
            spread: Spread::default(),
            size_jitter: 0.0,
            offset: Offset::default(),
            jitter: ColorJitter::default(),
            blend: BlendMode::Normal,
            erases: false,
            keeps_alpha: false,
            bounded: PaintLimit::Free,
            reach: 0.0,
            mode: BrushMode::Paint,
            pickup: Pickup::default(),
            tip: Tip::Round,
            grain: None,
            dual: None,
            stabilizer: Stabilizer::None,
            stabilizer_on: DistanceMetric::default(),
            stylus: StylusFilter::default(),
            cycle: Cycle::default(),
            dynamics: Dynamics::default(),
            seed: 0,
        }
    }
}

impl Brush {
    /// Whether both are the same brush: only what belongs to each stroke may differ, its seed and
    /// its facing.
    pub fn is_alike(&self, other: &Brush) -> bool {
        self.size == other.size
            && *self == Brush { seed: self.seed, facing: self.facing, ..other.clone() }
    }

    /// Whether its strokes have random properties and so need a seed of their own.
    pub fn is_random(&self) -> bool {
        let ColorJitter { hue_degrees, saturation, value } = self.jitter;
        let strays =
            [self.scatter, self.stylus.tremor, self.size_jitter, hue_degrees, saturation, value];
        let adds = [Property::Scatter, Property::SizeJitter]
            .into_iter()
            .any(|p| self.dynamics.is_driven(p));
        let follows =
            [Input::Random, Input::Chance].into_iter().any(|input| self.dynamics.has_input(input));
        strays.iter().any(|&v| v > 0.0)
            || adds
            || follows
            || matches!(self.tip, Tip::Hose(_))
            || self.dual.as_ref().is_some_and(|dual| dual.is_random())
    }

    /// Its second tip, as a brush whose strokes are coverage, and how both meet.
    pub(super) fn second(&self) -> Option<(Brush, DualSettings)> {
        let dual = self.dual.as_ref().filter(|_| !self.is_wet())?;
        Some((dual.second_brush(self), dual.settings))
    }

    /// It works on existing paint, dab by dab.
    pub fn is_wet(&self) -> bool {
        self.mode.is_retouching() || self.is_picking_up()
    }

    /// It picks up paint on its way.
    pub fn is_picking_up(&self) -> bool {
        self.mode == BrushMode::Paint
            && (self.pickup.amount > 0.0 || self.dynamics.is_driven(Property::Pickup))
    }

    /// Without paint to work on it would leave next to nothing: it retouches, or paints more with
    /// what it picks up than with its own color.
    pub fn is_dependent_on_paint(&self) -> bool {
        self.mode.is_retouching() || (self.mode == BrushMode::Paint && self.pickup.amount > 0.5)
    }

    /// The ratio of the tip's shorter side to its longer one, before anything drives it; `(0, 1]`.
    pub fn ratio(&self) -> f32 {
        match self.tip {
            Tip::Ellipse { ratio } | Tip::Square { ratio } => {
                ratio.max(*Tip::RATIO.start()).min(1.0)
            }
            _ => 1.0,
        }
    }
}
