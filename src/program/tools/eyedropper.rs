//! The eyedropper: the color that the flattened picture shows under the pen, taken when the pen
//! lifts. Floor 5.

use super::{Gesture, GestureStart, Outcome, PenSample, ToolContext};
use crate::document::{Document, PreparedDocument, Progress};
use crate::math::{Vec2, srgb::Color};
use crate::raster::grid::unpremultiply;
use crate::raster::{TILE, TileAt};

/// The pen comes down with the tool.
pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    let mut picking = EyedropperGesture { document: context.document.clone(), color: None };
    let outcome = picking.drag(&[pen]);
    (Some(Box::new(picking)), outcome)
}

struct EyedropperGesture {
    document: Document,
    /// The last color under the pen.
    color: Option<Color>,
}

impl Gesture for EyedropperGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let color = pens.last().and_then(|pen| color_at(&self.document, pen.place()));
        self.color = color.or(self.color);
        Outcome::Idle
    }

    fn release(&mut self) -> Outcome {
        let take = |color| Outcome::Cancel.with_settings(move |tools| tools.color = color);
        self.color.map_or(Outcome::Cancel, take)
    }

    fn picked_color(&self) -> Option<Color> {
        self.color
    }
}

/// The opaque color of a pixel; `None` off the canvas and where nothing is painted.
pub fn color_at(document: &Document, at: Vec2) -> Option<Color> {
    let (x, y) = (at.x.floor() as i32, at.y.floor() as i32);
    if !document.size.rect().contains(x, y) {
        return None;
    }
    let here = TileAt::of_pixel(x, y);
    let tile = PreparedDocument::new(document, &Progress::default())?.flatten_tile(here)?;
    let i = ((y - here.rect().y0) as usize * TILE + (x - here.rect().x0) as usize) * 4;
    let mut straight = [0; 4];
    unpremultiply(tile.bytes().get(i..i + 4)?, &mut straight);
    let [r, g, b, a] = straight;
    (a > 0).then_some(Color { r, g, b, a: 255 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Content, Layer};
    use crate::math::{Size, vec2};
    use std::sync::Arc;

    #[test]
    fn a_color_is_taken_when_the_pen_lifts() {
        let teal = Color { r: 10, g: 120, b: 130, a: 255 };
        let layers = vec![Arc::new(Layer::new("fill", Content::Fill(teal)))];
        let document = Document { layers, ..Document::empty(Size::new(100, 90)) };
        let tools = crate::tools::ToolSettings::default();
        let context = ToolContext::new(&document, &tools);
        let (gesture, outcome) = press(&context, PenSample::at(vec2(5.0, 5.0)));
        let mut gesture = gesture.unwrap();
        assert_eq!((outcome.settings().color, gesture.picked_color()), (tools.color, Some(teal)));
        // Beyond the canvas it keeps the last one.
        gesture.drag(&[PenSample::at(vec2(500.0, 5.0))]);
        assert_eq!(gesture.release().settings().color, teal);
    }

    #[test]
    fn the_color_is_that_of_the_picture_and_beyond_it_there_is_none() {
        let teal = Color { r: 10, g: 120, b: 130, a: 255 };
        let layers = vec![Arc::new(Layer::new("fill", Content::Fill(teal)))];
        let document = Document { layers, ..Document::empty(Size::new(100, 90)) };
        assert_eq!(color_at(&document, vec2(99.5, 89.5)), Some(teal));
        assert_eq!(color_at(&document, vec2(100.5, 10.0)), None);
    }
}
