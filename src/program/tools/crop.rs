//! The crop tool: an area that is dragged over the canvas, or beyond it, until it is applied or
//! canceled. Floor 5. Not here: what a document becomes within it (`document::canvas_change`).

use super::gizmo::TransformHandle;
use super::snap::{SnapLines, SnapTargets};
use super::{GRAB_PT, Gesture, GestureStart, Outcome, PenSample, ToolContext};
use crate::math::range::clamp_to_range;
use crate::math::{COORDINATE, Rect, Size, Vec2, vec2};

/// The settings of the crop tool.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct CropSettings {
    /// What it cuts out, canvas px.
    pub area: Option<Rect>,
    /// The aspect that it keeps.
    pub aspect: CropAspect,
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
    pub fn apply(self, area: Rect, canvas: Size) -> Rect {
        let Some(ratio) = self.ratio(canvas) else { return area };
        let height = (area.width() as f32 / ratio).round().max(1.0) as i32;
        let top = area.y0 + (area.height() as i32 - height).div_euclid(2);
        Rect::new(area.x0, top, area.x1, top + height)
    }
}

/// The corners of an area: upper left, upper right, lower right, lower left.
pub fn corners(area: Rect) -> [Vec2; 4] {
    let [x0, y0, x1, y1] = [area.x0, area.y0, area.x1, area.y1].map(|v| v as f32);
    [vec2(x0, y0), vec2(x1, y0), vec2(x1, y1), vec2(x0, y1)]
}

/// The middle of the side from a corner to the next.
pub fn edge(area: Rect, index: usize) -> Vec2 {
    let corners = corners(area);
    (corners[index % 4] + corners[(index + 1) % 4]) * 0.5
}

/// The handle of an area at a point; `grab_px`: the distance that counts as near.
pub fn handle_at(area: Rect, at: Vec2, grab_px: f32) -> TransformHandle {
    let near = |p: Vec2| p.distance(at) <= grab_px;
    let corners = corners(area);
    if let Some(corner) = (0..4).find(|&i| near(corners[i])) {
        return TransformHandle::Corner(corner);
    }
    if let Some(side) = (0..4).find(|&i| near(edge(area, i))) {
        return TransformHandle::Edge(side);
    }
    let inside = at.x >= corners[0].x
        && at.x <= corners[2].x
        && at.y >= corners[0].y
        && at.y <= corners[2].y;
    if inside { TransformHandle::Inside } else { TransformHandle::Outside }
}

/// The pen comes down with the tool.
pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    let at = pen.place();
    let handle =
        context.tools.crop.area.map_or(TransformHandle::Outside, |area| {
            handle_at(area, at, GRAB_PT * context.px_per_pt)
        });
    let gesture = CropGesture {
        area: context.tools.crop.area,
        handle,
        from: at,
        slop_px: SLOP_PT * context.px_per_pt,
        is_begun: false,
        ratio: context.tools.crop.aspect.ratio(context.document.size),
        snap: context.snap.clone(),
        lines: SnapLines::default(),
    };
    (Some(Box::new(gesture)), Outcome::Idle)
}

/// A pen that moves less than this, screen points, draws no new area.
const SLOP_PT: f32 = 4.0;

struct CropGesture {
    /// Before the drag.
    area: Option<Rect>,
    handle: TransformHandle,
    from: Vec2,
    slop_px: f32,
    is_begun: bool,
    ratio: Option<f32>,
    snap: SnapTargets,
    lines: SnapLines,
}

impl CropGesture {
    /// The area with the held handle at the pen; Shift keeps its aspect.
    fn area_at(&self, pen: &PenSample) -> Rect {
        let at = pen.place();
        let Some(area) = self.area.filter(|_| self.handle != TransformHandle::Outside) else {
            let ratio = self.ratio.or(pen.keys.shift.then_some(1.0));
            return area_between(self.from, at, ratio);
        };
        let ratio =
            self.ratio.or(pen.keys.shift.then(|| area.width() as f32 / area.height() as f32));
        match self.handle {
            TransformHandle::Corner(corner) => {
                area_between(corners(area)[(corner + 2) % 4], at, ratio)
            }
            TransformHandle::Edge(side) => with_side(area, side, at, ratio),
            TransformHandle::Inside | TransformHandle::Outside | TransformHandle::Pivot => {
                let by = place(at - self.from);
                Rect::new(area.x0 + by.0, area.y0 + by.1, area.x1 + by.0, area.y1 + by.1)
            }
        }
    }
}

/// A point in whole px that files can hold.
fn place(at: Vec2) -> (i32, i32) {
    (
        clamp_to_range(at.x, &COORDINATE).round() as i32,
        clamp_to_range(at.y, &COORDINATE).round() as i32,
    )
}

/// The area from a fixed corner to the pen, at least a pixel; with an aspect it is as large as the
/// farther side needs.
fn area_between(fixed: Vec2, at: Vec2, ratio: Option<f32>) -> Rect {
    let by = at - fixed;
    let (mut w, mut h) = (by.x.abs().max(1.0), by.y.abs().max(1.0));
    if let Some(ratio) = ratio.filter(|ratio| ratio.is_finite() && *ratio > 0.0) {
        (w, h) = if w >= h * ratio { (w, w / ratio) } else { (h * ratio, h) };
    }
    let far = fixed + vec2(w.max(1.0).copysign(by.x), h.max(1.0).copysign(by.y));
    let ((ax, ay), (bx, by)) = (place(fixed), place(far));
    let span = |a: i32, b: i32| if a == b { (a, a + 1) } else { (a.min(b), a.max(b)) };
    let ((x0, x1), (y0, y1)) = (span(ax, bx), span(ay, by));
    Rect::new(x0, y0, x1, y1)
}

/// An area with one side at the pen; with an aspect it grows about its middle along that side.
fn with_side(area: Rect, side: usize, at: Vec2, ratio: Option<f32>) -> Rect {
    let [top_left, _, bottom_right, _] = corners(area);
    let (mut low, mut high) = (top_left, bottom_right);
    match side {
        0 => low.y = at.y,
        1 => high.x = at.x,
        2 => high.y = at.y,
        _ => low.x = at.x,
    }
    let (low, high) = (low.min(high), low.max(high));
    let size = (high - low).max(Vec2::ONE);
    let Some(ratio) = ratio else { return area_between(low, low + size, None) };
    let middle = (low + high) * 0.5;
    let is_upright = side.is_multiple_of(2);
    let size = if is_upright { vec2(size.y * ratio, size.y) } else { vec2(size.x, size.x / ratio) };
    let low = if is_upright {
        vec2(middle.x - 0.5 * size.x, low.y)
    } else {
        vec2(low.x, middle.y - 0.5 * size.y)
    };
    area_between(low.round(), low.round() + size.round(), None)
}

impl Gesture for CropGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last() else { return Outcome::Idle };
        self.is_begun |= pen.place().distance(self.from) > self.slop_px
            || self.handle != TransformHandle::Outside;
        if !self.is_begun {
            return Outcome::Idle;
        }
        let mut snapped = *pen;
        self.lines = SnapLines::default();
        if self.handle != TransformHandle::Inside {
            let found = self.snap.point(pen.place());
            (snapped.sample.at, self.lines) = (found.at, found.lines);
        }
        let area = self.area_at(&snapped);
        Outcome::set(move |tools| tools.crop.area = Some(area))
    }

    fn release(&mut self) -> Outcome {
        Outcome::Idle
    }

    fn snap_lines(&self) -> SnapLines {
        self.lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Document;
    use crate::math::Size;
    use crate::tools::ToolSettings;

    /// The area after a drag; `None` if it was left unchanged.
    fn dragged(area: Option<Rect>, aspect: CropAspect, from: Vec2, to: Vec2) -> Option<Rect> {
        let document = Document::empty(Size::new(200, 100));
        let tools = ToolSettings { crop: CropSettings { area, aspect }, ..ToolSettings::default() };
        let mut gesture =
            press(&ToolContext::new(&document, &tools), PenSample::at(from)).0.unwrap();
        gesture.drag(&[PenSample::at(to)]).settings().crop.area
    }
    const FRAME: Rect = Rect { x0: 50, y0: 20, x1: 150, y1: 80 };

    #[test]
    fn a_drag_draws_a_frame_and_a_click_beside_one_does_nothing() {
        let drawn = dragged(None, CropAspect::Free, vec2(90.2, 70.0), vec2(-10.0, 20.4));
        assert_eq!(drawn, Some(Rect::new(-10, 20, 90, 70)));
        assert_eq!(
            dragged(Some(FRAME), CropAspect::Free, vec2(10.0, 90.0), vec2(11.0, 90.0)),
            None
        );
        let anew = dragged(Some(FRAME), CropAspect::Free, vec2(10.0, 95.0), vec2(30.0, 5.0));
        assert_eq!(anew, Some(Rect::new(10, 5, 30, 95)));
    }

    #[test]
    fn corners_sides_and_the_inside_are_held() {
        let to = |from, to| dragged(Some(FRAME), CropAspect::Free, from, to).unwrap();
        assert_eq!(to(vec2(148.0, 79.0), vec2(220.0, 60.0)), Rect::new(50, 20, 220, 60));
        assert_eq!(to(vec2(50.0, 50.0), vec2(70.0, 10.0)), Rect::new(70, 20, 150, 80));
        assert_eq!(to(vec2(100.0, 50.0), vec2(95.0, 58.0)), Rect::new(45, 28, 145, 88));
        // Past the other side it turns over, and never becomes empty.
        assert_eq!(to(vec2(50.0, 50.0), vec2(170.0, 50.0)), Rect::new(150, 20, 170, 80));
        assert_eq!(to(vec2(50.0, 50.0), vec2(150.0, 50.0)).width(), 1);
    }

    #[test]
    fn an_aspect_is_kept_by_every_handle() {
        for (aspect, ratio) in
            [(CropAspect::Canvas, 2.0), (CropAspect::Square, 1.0), (CropAspect::ThreeToTwo, 1.5)]
        {
            for from in [vec2(50.0, 20.0), vec2(150.0, 80.0), vec2(100.0, 20.0), vec2(150.0, 50.0)]
            {
                let area = dragged(Some(FRAME), aspect, from, from + vec2(17.0, -31.0)).unwrap();
                let off = (area.width() as f32 - ratio * area.height() as f32).abs();
                assert!(off <= 0.5 + 0.5 * ratio, "{aspect:?} {from}: {area:?}");
            }
        }
        assert_eq!(CropAspect::Square.apply(FRAME, Size::new(9, 9)), Rect::new(50, 0, 150, 100));
    }

    #[test]
    fn what_is_no_place_is_held() {
        let area = dragged(None, CropAspect::Free, vec2(0.0, 0.0), vec2(f32::MAX, f32::NAN));
        assert!(area.is_none_or(|area| area.x1 <= 1_000_001 && area.height() >= 1));
    }
}
