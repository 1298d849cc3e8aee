//! The settings of the tools. Floor 5. Not here: those of the brush (`paint`), snapping (`snap`),
//! what the transform tool moves (`gizmo`).

use super::pen::ModifierKeys;
use crate::math::range::held;
use crate::math::{Range, Rect, Size, Vec2, Vec3, vec3};
use crate::paint::Fill;
use crate::raster::coverage::SelectionMode;
use crate::shape::{SculptStroke, SculptTool, Touch};
use crate::surface::region::{RegionKind, SurfaceRegion};

/// What brush and eraser change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum BrushTarget {
    /// The selected layer.
    #[default]
    Layer,
    /// The mask of the selected layer.
    Mask,
    /// The selection itself, under a quick mask.
    Selection,
}

/// The purpose of a stroke.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StrokePurpose {
    Paint,
    Erase,
}

/// The settings of the selection tools.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelectSettings {
    /// How a new selection is combined with the present one, unless a key says otherwise.
    pub combine: SelectionMode,
    /// The wand: its region is that of a fill.
    pub wand: Fill,
    /// The wand takes only what is joined to the pixel.
    pub joined: bool,
    /// The surface wand: its point is that of the pen.
    pub region: SurfaceRegion,
}

impl Default for SelectSettings {
    fn default() -> Self {
        Self {
            combine: SelectionMode::Replace,
            wand: Fill { grow_px: 0.0, ..Fill::default() },
            joined: true,
            region: SurfaceRegion::new(RegionKind::Direction, Vec2::ZERO),
        }
    }
}

impl SelectSettings {
    /// The tolerance of the wand.
    pub const TOLERANCE: Range = crate::math::UNIT;

    /// With another kind of region, which begins with its own tolerance.
    pub fn with_kind(self, kind: RegionKind) -> Self {
        Self { region: SurfaceRegion { kind, tolerance: kind.tolerance(), ..self.region }, ..self }
    }

    /// How a selection is combined with the present one: Shift adds, Alt subtracts, both intersect.
    pub fn how(&self, keys: ModifierKeys) -> SelectionMode {
        match (keys.shift, keys.alt) {
            (true, true) => SelectionMode::Intersect,
            (true, false) => SelectionMode::Add,
            (false, true) => SelectionMode::TakeAway,
            (false, false) => self.combine,
        }
    }
}

/// The settings of the tools that touch and sculpt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeSettings {
    /// What the sculpting tool does.
    pub tool: SculptTool,
    /// Diameter of a dab, px.
    pub size: f32,
    /// The part of the dab with full strength.
    pub hardness: f32,
    /// How far a dab raises or lowers, px.
    pub height: f32,
    /// How far a dab that smooths, flattens, pinches or scrapes goes: the share of the way.
    pub share: f32,
    /// The direction that a touch gives to the surface; unit, camera space (y up).
    pub normal: Vec3,
    /// The radius of a touch, px.
    pub radius: f32,
    /// How far a touch reaches, px; 0: to the rim and the next touches.
    pub reach: f32,
}

impl Default for ShapeSettings {
    fn default() -> Self {
        Self {
            tool: SculptTool::Raise,
            size: 60.0,
            hardness: 0.3,
            height: 1.0,
            share: 0.3,
            normal: vec3(-0.4, 0.5, 0.768),
            radius: 8.0,
            reach: 0.0,
        }
    }
}

impl ShapeSettings {
    /// The same with numbers that a part may hold.
    pub fn held(&self) -> Self {
        let normal =
            vec3(self.normal.x, self.normal.y, self.normal.z.max(0.0)).normalize_or(Vec3::Z);
        Self {
            tool: self.tool,
            size: held(self.size, &SculptStroke::SIZE),
            hardness: held(self.hardness, &SculptStroke::HARDNESS),
            height: held(self.height, &SculptStroke::STRENGTH),
            share: held(self.share, &crate::math::UNIT),
            normal,
            radius: held(self.radius, &Touch::RADIUS),
            reach: held(self.reach, &Touch::REACH),
        }
    }

    /// The strength of a dab of the current tool.
    pub fn strength(&self) -> f32 {
        if self.tool.is_by_height() { self.height } else { self.share }
    }
}

rilievo_engine::named! {
    /// The aspect that the crop area keeps.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
    pub enum CropAspect {
        #[default]
        Free = "free" => "Free",
        /// The canvas's own.
        Canvas = "canvas" => "As it is",
        Square = "1:1" => "1 : 1",
        FourToThree = "4:3" => "4 : 3",
        SixteenToNine = "16:9" => "16 : 9",
        ThreeToTwo = "3:2" => "3 : 2",
    }
}

impl CropAspect {
    /// Width by height.
    pub fn ratio(self, canvas: Size) -> Option<f32> {
        match self {
            CropAspect::Free => None,
            CropAspect::Canvas => Some(canvas.width as f32 / canvas.height as f32),
            CropAspect::Square => Some(1.0),
            CropAspect::FourToThree => Some(4.0 / 3.0),
            CropAspect::SixteenToNine => Some(16.0 / 9.0),
            CropAspect::ThreeToTwo => Some(1.5),
        }
    }

    /// An area with this aspect about the middle of another one, with its width.
    pub fn given(self, area: Rect, canvas: Size) -> Rect {
        let Some(ratio) = self.ratio(canvas) else { return area };
        let height = (area.width() as f32 / ratio).round().max(1.0) as i32;
        let top = area.y0 + (area.height() as i32 - height).div_euclid(2);
        Rect::new(area.x0, top, area.x1, top + height)
    }
}
