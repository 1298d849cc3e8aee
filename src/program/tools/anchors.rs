//! The anchor tool: edits where an image is pinned to the surface, and which of its points is
//! pinned there. Floor 5. Not here: the effect of anchors (`surface::deformation`).

use super::gradient::{self, GradientEnd};
use super::{GRAB_PT, Gesture, GestureStart, Outcome, PenSample, ToolContext, closed, lights};
use crate::document::{Content, Document, Layer, LayerId, Live};
use crate::math::{Size, Vec2};
use crate::paint::PlacedImage;
use crate::surface::{Anchor, Deformation, Surface};
use std::sync::Arc;

/// What dragging an anchor changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnchorDrag {
    /// The anchor moves along the surface with its content: `at` changes, `source` stays.
    Carry,
    /// The anchor stays, the content moves under it: `source` changes.
    Content,
    /// The anchor moves over content that stays: `source` becomes what was shown there.
    Repin,
}

/// The handles of a layer, canvas px: its anchors, a gradient's ends, or lights.
pub fn handles(layer: &Layer, canvas: Size) -> Vec<Vec2> {
    match &layer.content {
        Content::Image(live) => live.params().bend.anchors.iter().map(|anchor| anchor.at).collect(),
        Content::Gradient(live) => vec![live.params().from, live.params().to],
        Content::Shading(live) if !live.params().model.is_lit_by_environment() => {
            lights::handles(&live.params().lights, canvas)
        }
        _ => Vec::new(),
    }
}

/// The handle that the pen grabs: from twice as far as other handles, because a near miss would add
/// an anchor, which would bend the whole image differently.
pub fn handle_at(layer: &Layer, canvas: Size, at: Vec2, px_per_pt: f32) -> Option<usize> {
    let near = handles(layer, canvas).into_iter().map(|handle| handle.distance(at)).enumerate();
    near.min_by(|a, b| a.1.total_cmp(&b.1))
        .filter(|(_, d)| *d <= 2.0 * GRAB_PT * px_per_pt)
        .map(|(i, _)| i)
}

/// The pen comes down with the tool.
pub fn press(context: &ToolContext, pen: PenSample) -> GestureStart {
    let Some(layer) = context.layer.and_then(|id| context.document.layer(id)) else {
        return (None, Outcome::Idle);
    };
    if let Some(why) = closed::why_locked(layer) {
        return (None, Outcome::Refused(why.into()));
    }
    let taken = handle_at(layer, context.document.size, pen.place(), context.px_per_pt);
    let document = context.document.clone();
    match (&layer.content, taken) {
        (Content::Image(live), None) if !pen.keys.alt => {
            add(document, layer, live.params().clone(), pen)
        }
        (Content::Image(live), Some(index)) if pen.keys.alt => {
            (None, remove(&document, layer, live.params(), index))
        }
        (Content::Image(live), Some(index)) => {
            let how = match pen.keys {
                keys if keys.ctrl => AnchorDrag::Content,
                keys if keys.shift => AnchorDrag::Repin,
                _ => AnchorDrag::Carry,
            };
            let image = live.params().clone();
            let (before, from, label) = (image.clone(), pen.place(), "Move anchor");
            (
                Some(Box::new(AnchorGesture {
                    document,
                    layer: layer.id,
                    image,
                    before,
                    index,
                    how,
                    from,
                    moved: false,
                    label,
                })),
                Outcome::Idle,
            )
        }
        (Content::Gradient(live), Some(index)) => {
            let end = if index == 0 { GradientEnd::From } else { GradientEnd::To };
            let gradient = live.params().clone();
            gradient::drag_end(context, layer.id, gradient, end)
        }
        (Content::Shading(live), Some(index)) => {
            let (layer, shading) = (layer.id, live.params().clone());
            (
                Some(Box::new(lights::LightGesture {
                    document,
                    layer,
                    shading,
                    index,
                    moved: false,
                })),
                Outcome::Idle,
            )
        }
        (Content::Image(_) | Content::Gradient(_), None) => (None, Outcome::Idle),
        (Content::Strokes(_), _) => (
            None,
            Outcome::Refused("Strokes have no anchors. Move them with the Strokes tool".into()),
        ),
        _ => (
            None,
            Outcome::Refused(
                "This layer has no anchors. Images, gradients and lights have them".into(),
            ),
        ),
    }
}

/// A new anchor that changes nothing yet: it pins the image point shown there.
fn add(document: Document, layer: &Layer, mut image: PlacedImage, pen: PenSample) -> GestureStart {
    let surface = document.surface.clone();
    let at = pen.place();
    let source = shown_place(&image, surface.as_deref(), &document, at);
    image.bend.anchors.push(Anchor { at, source });
    let index = image.bend.anchors.len() - 1;
    let (before, how, from) = (image.clone(), AnchorDrag::Carry, at);
    let mut dragged = AnchorGesture {
        document,
        layer: layer.id,
        image,
        before,
        index,
        how,
        from,
        moved: true,
        label: "Add anchor",
    };
    let outcome = dragged.show();
    (Some(Box::new(dragged)), outcome)
}

fn remove(document: &Document, layer: &Layer, image: &PlacedImage, index: usize) -> Outcome {
    let mut image = image.clone();
    image.bend.anchors.remove(index);
    let content = Content::Image(Live::new(image));
    match document.with_layer(layer.id, |layer| layer.content = content) {
        Some(document) => Outcome::Commit { label: "Remove anchor".into(), document, select: None },
        None => Outcome::Idle,
    }
}

/// D(at): which point of the image is shown there.
fn shown_place(
    image: &PlacedImage,
    surface: Option<&Surface>,
    document: &Document,
    at: Vec2,
) -> Vec2 {
    let deformation = Deformation::new(surface, document.size, &image.bend);
    let center = at.floor();
    deformation.at(center.x as i32, center.y as i32) + (at - center - 0.5)
}

struct AnchorGesture {
    document: Document,
    layer: LayerId,
    image: PlacedImage,
    /// Before the drag.
    before: PlacedImage,
    index: usize,
    how: AnchorDrag,
    from: Vec2,
    moved: bool,
    label: &'static str,
}

impl AnchorGesture {
    fn with(&self) -> Option<Document> {
        let content = Content::Image(Live::new(self.image.clone()));
        self.document.with_layer(self.layer, |layer| layer.content = content)
    }

    fn show(&mut self) -> Outcome {
        self.with().map_or(Outcome::Idle, Outcome::Preview)
    }
}

impl Gesture for AnchorGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        let Some(pen) = pens.last() else { return Outcome::Idle };
        let Some(&start) = self.before.bend.anchors.get(self.index) else { return Outcome::Idle };
        let by = pen.place() - self.from;
        let anchor = match self.how {
            AnchorDrag::Carry => Anchor { at: start.at + by, source: start.source },
            // The content follows the pen, so the source point moves the other way.
            AnchorDrag::Content => Anchor { at: start.at, source: start.source - by },
            AnchorDrag::Repin => {
                let at = start.at + by;
                let surface: Option<Arc<Surface>> = self.document.surface.clone();
                Anchor {
                    at,
                    source: shown_place(&self.before, surface.as_deref(), &self.document, at),
                }
            }
        };
        if let Some(slot) = self.image.bend.anchors.get_mut(self.index) {
            *slot = anchor;
        }
        self.moved = true;
        self.show()
    }

    fn release(&mut self) -> Outcome {
        let label = match self.how {
            AnchorDrag::Content => "Move content under anchor",
            AnchorDrag::Repin => "Re-pin anchor",
            AnchorDrag::Carry => self.label,
        };
        match self.with() {
            Some(document) if self.moved => {
                Outcome::Commit { label: label.into(), document, select: None }
            }
            _ => Outcome::Cancel,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, srgb::Color, vec2};
    use crate::paint::{Adjust, ImageFilter, PictureSource, Placement};
    use crate::raster::{Outside, Picture};
    use crate::surface::{Bend, Operator};
    use crate::tools::ModifierKeys;
    use crate::tools::ToolSettings;

    fn document(anchors: Vec<Anchor>) -> Document {
        let size = Size::new(100, 80);
        let picture = Picture::srgb8(size, vec![[9; 4]; size.area()]).unwrap();
        let image = PlacedImage {
            source: PictureSource::new("p.png".into(), picture, Adjust::default()),
            placement: Placement::covering(size),
            outside: Outside::Mirror,
            bend: Bend { operator: Operator::None, anchors, ..Bend::default() },
            filter: ImageFilter::Antialias,
            frame: Default::default(),
        };
        let layers = vec![Arc::new(Layer::new("image", Content::Image(Live::new(image))))];
        Document { layers, ..Document::empty(size) }
    }

    fn dragged(
        document: &Document,
        keys: ModifierKeys,
        from: Vec2,
        to: Vec2,
    ) -> Option<Vec<Anchor>> {
        let (tools, layer) = (ToolSettings::default(), Some(document.layers[0].id));
        let context = ToolContext { layer, ..ToolContext::new(document, &tools) };
        let (gesture, begun) = press(&context, PenSample { keys, ..PenSample::at(from) });
        let outcome = match gesture {
            Some(mut gesture) => {
                gesture.drag(&[PenSample { keys, ..PenSample::at(to) }]);
                gesture.release()
            }
            None => begun,
        };
        let Outcome::Commit { document, .. } = outcome else { return None };
        let Content::Image(live) = &document.layers[0].content else { return None };
        Some(live.params().bend.anchors.clone())
    }

    #[test]
    fn a_near_miss_takes_the_anchor_and_adds_none() {
        let pinned = document(vec![Anchor::pin(vec2(30.0, 30.0))]);
        let anchors =
            dragged(&pinned, ModifierKeys::default(), vec2(46.0, 30.0), vec2(56.0, 40.0)).unwrap();
        assert_eq!(anchors, [Anchor { at: vec2(40.0, 40.0), source: vec2(30.0, 30.0) }]);
    }

    #[test]
    fn a_layer_without_anchors_says_so() {
        let document = Document {
            layers: vec![Arc::new(Layer::new("a", Content::Fill(Color::BLACK)))],
            ..document(vec![])
        };
        let tools = ToolSettings::default();
        let layer = Some(document.layers[0].id);
        let context = ToolContext { layer, ..ToolContext::new(&document, &tools) };
        assert!(matches!(press(&context, PenSample::at(vec2(30.0, 30.0))).1, Outcome::Refused(_)));
    }

    #[test]
    fn dragging_an_anchor_takes_its_content_along() {
        let pinned = document(vec![Anchor::pin(vec2(30.0, 30.0))]);
        let anchors =
            dragged(&pinned, ModifierKeys::default(), vec2(33.0, 30.0), vec2(53.0, 40.0)).unwrap();
        assert_eq!(anchors, [Anchor { at: vec2(50.0, 40.0), source: vec2(30.0, 30.0) }]);
    }

    #[test]
    fn dragging_content_leaves_the_anchor_where_it_is() {
        let pinned = document(vec![Anchor::pin(vec2(30.0, 30.0))]);
        let keys = ModifierKeys { ctrl: true, ..ModifierKeys::default() };
        let anchors = dragged(&pinned, keys, vec2(30.0, 30.0), vec2(35.0, 32.0)).unwrap();
        assert_eq!(anchors, [Anchor { at: vec2(30.0, 30.0), source: vec2(25.0, 28.0) }]);
    }

    #[test]
    fn a_new_or_repinned_anchor_changes_no_pixel() {
        let moved = Anchor { at: vec2(30.0, 30.0), source: vec2(20.0, 30.0) };
        let anchors = dragged(
            &document(vec![moved]),
            ModifierKeys::default(),
            vec2(80.0, 60.5),
            vec2(80.0, 60.5),
        )
        .unwrap();
        assert_eq!(anchors[1], Anchor { at: vec2(80.0, 60.5), source: vec2(70.0, 60.5) });
        let keys = ModifierKeys { shift: true, ..ModifierKeys::default() };
        let anchors =
            dragged(&document(vec![moved]), keys, vec2(30.0, 30.0), vec2(50.0, 30.0)).unwrap();
        assert_eq!(anchors, [Anchor { at: vec2(50.0, 30.0), source: vec2(40.0, 30.0) }]);
    }

    #[test]
    fn alt_takes_an_anchor_away_and_nothing_else() {
        let pinned = document(vec![Anchor::pin(vec2(30.0, 30.0)), Anchor::pin(vec2(60.0, 30.0))]);
        let keys = ModifierKeys { alt: true, ..ModifierKeys::default() };
        assert_eq!(dragged(&pinned, keys, vec2(61.0, 30.0), vec2(61.0, 30.0)).unwrap().len(), 1);
        assert_eq!(dragged(&pinned, keys, vec2(10.0, 70.0), vec2(10.0, 70.0)), None);
    }
}
