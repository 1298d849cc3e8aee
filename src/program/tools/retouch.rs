//! The brush as smudge, blur, clone, and one that picks paint up: what it needs before it begins,
//! and what it holds. Floor 5. Not here: what it does to pixels (`paint::retouch`), samples from
//! the pen (`brush`).

use super::purpose::StrokePurpose;
use super::{DocumentChoice, Outcome, PenSample, ToolContext};
use crate::document::symmetry::SymmetryImage;
use crate::document::{Content, Layer, Progress, flatten};
use crate::math::Vec2;
use crate::paint::{ActiveRetouching, ActiveStrokes, BrushMode, Sample, Scene, Stroke};
use crate::raster::{Tile, TileAt, TileGrid};
use std::sync::Arc;

/// Active strokes: of paint, or retouching.
pub(super) enum ActiveWork {
    Strokes(ActiveStrokes),
    Retouching(Box<ActiveRetouching>),
}

impl ActiveWork {
    /// The tiles that the next samples of each stroke change.
    pub fn draw(&mut self, samples: &[Vec<Sample>]) -> Vec<(TileAt, Option<Arc<Tile>>)> {
        match self {
            ActiveWork::Strokes(active) => active.draw(samples),
            ActiveWork::Retouching(retouching) => retouching.draw(samples),
        }
    }

    /// The strokes so far, for a layer that keeps strokes.
    pub fn strokes(&self) -> Vec<Stroke> {
        match self {
            ActiveWork::Strokes(active) => active.strokes(),
            ActiveWork::Retouching(_) => Vec::new(),
        }
    }

    pub fn finish(self) -> Vec<Stroke> {
        match self {
            ActiveWork::Strokes(active) => active.finish(),
            ActiveWork::Retouching(_) => Vec::new(),
        }
    }
}

/// The outcome of a press that starts no stroke: a source point for clones, or the reason; `None`
/// if a stroke can start.
pub(super) fn refuse_press(
    context: &ToolContext,
    pen: PenSample,
    purpose: StrokePurpose,
) -> Option<Outcome> {
    let mode = context.tools.brush.mode;
    if purpose != StrokePurpose::Paint || !context.tools.brush.is_dependent_on_paint() {
        return None;
    }
    if mode.is_clone() && pen.keys.alt {
        return Some(Outcome::Choose(DocumentChoice::CloneSource(pen.place())));
    }
    let layer = context.layer.and_then(|id| context.document.layer(id));
    if !layer.is_some_and(|layer| matches!(layer.content, Content::Pixels(_))) {
        return Some(Outcome::Refused(if mode.is_retouching() {
            "Smudge, blur and clone work on paint layers. Select one, or turn this layer into \
             pixels."
                .into()
        } else {
            "This brush picks up paint, which only paint layers have. Select one, or turn this \
             layer into pixels."
                .into()
        }));
    }
    let has_source = !mode.is_clone() || context.clone_offset.is_some();
    (!has_source).then_some(Outcome::Refused(
        "Alt-click where the clone brush should copy from, then paint.".into(),
    ))
}

/// What works on the pixels of a layer; `None` where the strokes only add paint.
///
/// * `strokes`: one for each image.
pub(super) fn begin_stroke(
    context: &ToolContext,
    images: &[SymmetryImage],
    pen: PenSample,
    layer: &Layer,
    strokes: &[Stroke],
    scene: &Scene,
) -> Option<ActiveWork> {
    let mode = strokes.first().map(Stroke::brush).filter(|brush| brush.is_wet())?.mode;
    let Content::Pixels(pixels) = &layer.content else { return None };
    let offset = context.clone_offset.unwrap_or(Vec2::ZERO);
    // An image of the stroke copies from the image of its source.
    let there = |image: &SymmetryImage, at: Vec2| image.sample(&Sample::at(at)).at;
    let offsets: Vec<Vec2> = images
        .iter()
        .map(|image| there(image, pen.place() + offset) - there(image, pen.place()))
        .collect();
    let source = match mode {
        BrushMode::Clone { picture: true, .. } => flatten(context.document, &Progress::default())?,
        BrushMode::Clone { .. } => pixels.tiles.clone(),
        _ => TileGrid::default(),
    };
    let retouching = ActiveRetouching::new(strokes, &offsets, pixels.tiles.clone(), source, scene);
    Some(ActiveWork::Retouching(Box::new(retouching)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Symmetry;
    use crate::document::{Document, PixelLayer};
    use crate::math::{Size, srgb::Color, vec2};
    use crate::paint::{Brush, Pickup};
    use crate::tools::ToolSettings;
    use crate::tools::{ModifierKeys, ToolKind, press};

    /// A red square at the left of a paint layer, over a blue ground.
    fn document() -> Document {
        let red: Vec<u8> = [255, 0, 0, 255].repeat(40 * 40);
        let tiles = TileGrid::from_straight_rgba(&red, 40, 40, 20, 40);
        let pixels = PixelLayer { file: String::new(), x: 0, y: 0, tiles };
        let ground = Layer::new("Ground", Content::Fill(Color { r: 0, g: 0, b: 255, a: 255 }));
        let layers = vec![Arc::new(ground), Arc::new(Layer::new("Paint", Content::Pixels(pixels)))];
        Document { layers, ..Document::empty(Size::new(200, 120)) }
    }

    fn with_mode(mode: BrushMode) -> ToolSettings {
        let brush = Brush { size: 20.0, hardness: 1.0, mode, ..Brush::default() };
        ToolSettings::with_brush(brush)
    }

    /// The paint layer after a stroke.
    fn drawn(context: &ToolContext, from: Vec2, to: Vec2) -> TileGrid {
        let mut gesture = press(ToolKind::Brush, context, PenSample::at(from)).0.unwrap();
        gesture.drag(&[PenSample::at(from.lerp(to, 0.4)), PenSample::at(to)]);
        let Outcome::Commit { document, .. } = gesture.release() else { panic!("kept") };
        let Content::Pixels(pixels) = &document.layers[1].content else { panic!("paint") };
        pixels.tiles.clone()
    }

    fn on_paint<'a>(document: &'a Document, tools: &'a ToolSettings) -> ToolContext<'a> {
        ToolContext { layer: Some(document.layers[1].id), ..ToolContext::new(document, tools) }
    }

    #[test]
    fn a_smudge_drags_the_layers_paint_and_its_mirror_image() {
        let (mut document, tools) = (document(), with_mode(BrushMode::Smudge { length: 1.0 }));
        document.symmetry.kind = Symmetry::Vertical;
        let tiles = drawn(&on_paint(&document, &tools), vec2(50.0, 60.0), vec2(90.0, 60.0));
        assert!(tiles.pixel(80, 60)[3] > 200 && tiles.pixel(80, 80)[3] == 0);
        // The image drags transparency onto transparency, from the right.
        assert_eq!(tiles.pixel(120, 60), [0; 4]);
    }

    #[test]
    fn a_clone_copies_the_layer_or_the_picture_from_so_far_away() {
        let document = document();
        for (picture, outside) in [(false, [0; 4]), (true, [0, 0, 255, 255])] {
            let tools = with_mode(BrushMode::Clone { aligned: true, picture });
            let context = ToolContext {
                clone_offset: Some(vec2(-100.0, 0.0)),
                ..on_paint(&document, &tools)
            };
            let tiles = drawn(&context, vec2(140.0, 60.0), vec2(175.0, 60.0));
            assert_eq!((tiles.pixel(140, 60), tiles.pixel(175, 60)), ([255, 0, 0, 255], outside));
        }
    }

    #[test]
    fn what_cannot_begin_says_why_and_alt_sets_the_source() {
        let document = document();
        let clone = with_mode(BrushMode::Clone { aligned: true, picture: false });
        let begun = |context: &ToolContext, keys: ModifierKeys| {
            let pen = PenSample { keys, ..PenSample::at(vec2(30.0, 50.0)) };
            press(ToolKind::Brush, context, pen).1
        };
        let plain = on_paint(&document, &clone);
        assert!(
            matches!(begun(&plain, ModifierKeys::default()), Outcome::Refused(why) if why.contains("Alt-click"))
        );
        let alt = ModifierKeys { alt: true, ..ModifierKeys::default() };
        assert!(
            matches!(begun(&plain, alt), Outcome::Choose(DocumentChoice::CloneSource(at)) if at == vec2(30.0, 50.0))
        );
        let on_fill = ToolContext { layer: Some(document.layers[0].id), ..plain };
        assert!(
            matches!(begun(&on_fill, ModifierKeys::default()), Outcome::Refused(why) if why.contains("paint layers"))
        );
    }

    #[test]
    fn a_brush_that_picks_up_mixes_on_paint_layers_and_says_why_not_elsewhere() {
        let document = document();
        let plain = Brush { size: 20.0, hardness: 1.0, ..Brush::default() };
        let mixing = |amount: f32| Brush {
            pickup: Pickup { amount, length: 0.9, radius: 1.0 },
            ..plain.clone()
        };
        let green = Color { r: 0, g: 255, b: 0, a: 255 };
        let drawn_with = |brush: &Brush| {
            let tools = ToolSettings { color: green, ..ToolSettings::with_brush(brush.clone()) };
            drawn(&on_paint(&document, &tools), vec2(40.0, 60.0), vec2(100.0, 60.0)).pixel(90, 60)
        };
        assert_eq!(drawn_with(&plain), [0, 255, 0, 255]);
        let [r, g, _, a] = drawn_with(&mixing(0.5));
        assert!(r > 20 && g > 100 && a > 150, "red and green: {r} {g} {a}");
        let smearing = mixing(1.0);
        assert_eq!(drawn_with(&smearing)[1], 0, "nothing of its own");
        let tools = ToolSettings::with_brush(smearing);
        let on_fill =
            ToolContext { layer: Some(document.layers[0].id), ..on_paint(&document, &tools) };
        let (_, outcome) = press(ToolKind::Brush, &on_fill, PenSample::at(vec2(30.0, 50.0)));
        assert!(matches!(outcome, Outcome::Refused(why) if why.contains("picks up")));
    }
}
