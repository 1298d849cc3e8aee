//! The surface wand: all that faces the same way as the point under the pen, lies as deep, bends as
//! it does, belongs to its object, would shine with it, or flows along it; a drag to the right or
//! the left changes the tolerance. Floor 5. Not here: finding it (`surface::region`).

use super::{adjust, combine_selections, drag_tolerance};
use crate::document::Document;
use crate::math::Vec2;
use crate::paint::Selection;
use crate::raster::coverage::SelectionMode;
use crate::surface::region::{RegionField, SurfaceRegion};
use crate::tools::{Gesture, GestureStart, Outcome, PenSample, SelectSettings, ToolContext};

pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    let Some(surface) = &context.document.surface else {
        return (
            None,
            Outcome::Refused(
                "There is no surface to select by. Open its maps (File, Open maps…).".into(),
            ),
        );
    };
    let region = SurfaceRegion { at: pen.place(), ..context.tools.select.region };
    let Some(field) = RegionField::new(surface, region.kind, region.at) else {
        return (
            None,
            Outcome::Refused(
                "Click on the surface: outside it there is nothing to select by.".into(),
            ),
        );
    };
    let mut gesture = RegionGesture {
        document: context.document.clone(),
        how: context.tools.select.how(pen.keys),
        field,
        from: pen.place(),
        begun: region,
        region,
        settings: context.tools.select,
        px_per_pt: context.px_per_pt,
    };
    let outcome = gesture.drag(&[pen]);
    (Some(Box::new(gesture)), outcome)
}

struct RegionGesture {
    document: Document,
    how: SelectionMode,
    field: RegionField,
    from: Vec2,
    begun: SurfaceRegion,
    /// With the tolerance of the drag so far.
    region: SurfaceRegion,
    settings: SelectSettings,
    px_per_pt: f32,
}

impl RegionGesture {
    fn outcome(&self, is_done: bool) -> Outcome {
        let selection = Selection::provisional(self.field.region(&self.region), Some(self.region));
        let document = combine_selections(&self.document, selection, self.how);
        let select = SelectSettings { region: self.region, ..self.settings };
        adjust(document, select, is_done)
    }
}

impl Gesture for RegionGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last() else { return Outcome::Idle };
        let by_px = pen.place().x - self.from.x;
        let range = self.begun.kind.tolerances();
        self.region.tolerance = drag_tolerance(self.begun.tolerance, by_px, self.px_per_pt, &range);
        self.outcome(false)
    }

    fn release(&mut self) -> Outcome {
        self.outcome(true)
    }
}
