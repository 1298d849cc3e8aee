//! The brush and the eraser: the pen's readings become one stroke, live on a stroke layer, pixels on a paint layer.
//! Floor 5. Dabs and tiles are `paint`'s.

use super::pixels::{self, Effect};
use super::{Begun, Context, Gesture, Outcome, Pen};
use crate::document::{Content, Document, Layer, LayerId, Live, Lock, PixelLayer, Place, StrokeList};
use crate::math::{Vec2, srgb::Color};
use crate::paint::{Brush, Sample, Scene, Stroke, Tip};
use crate::raster::{TileAt, TileGrid};
use crate::surface::Operator;
use std::sync::Arc;

/// What the stroke is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    Paint,
    Erase,
}

/// The pen comes down with the brush. A selected layer that cannot hold strokes gets a stroke layer above it.
pub fn press(context: &Context, pen: Pen, purpose: Purpose) -> Begun {
    let Some((document, id)) = paintable(context, purpose) else { return (None, Outcome::Idle) };
    let Some(layer) = document.layer(id) else { return (None, Outcome::Idle) };
    let target = match (&layer.content, purpose) {
        (Content::Strokes(list), Purpose::Paint) => Target::Strokes(list.clone()),
        (Content::Strokes(list), Purpose::Erase) => {
            let taken =
                TakenAway { document: context.document.clone(), layer: id, list: list.clone(), gone: Vec::new() };
            return begin(taken, pen);
        }
        (Content::Pixels(pixels), _) => {
            let effect = match (purpose, layer.lock) {
                (Purpose::Erase, _) => Effect::Erase,
                (Purpose::Paint, Lock::Alpha) => Effect::Atop,
                (Purpose::Paint, _) => Effect::Over,
            };
            Target::Pixels { base: pixels.clone(), shown: pixels.tiles.clone(), effect }
        }
        _ => return (None, Outcome::Idle),
    };
    let mut samples = Vec::new();
    if let Some(last) = context.last_end.filter(|_| pen.keys.shift) {
        // A straight line from where the last stroke ended, its pressure that of this pen.
        samples.extend((0..8).map(|i| Sample { at: last.lerp(pen.place(), i as f32 / 8.0), ..pen.sample }));
    }
    let painting = Painting {
        brush: context.brush.clone(),
        operator: context.operator,
        color: if purpose == Purpose::Erase { Color { a: 255, ..context.color } } else { context.color },
        scene: document.scene(),
        label: if purpose == Purpose::Erase { "Erase" } else { "Brush stroke" },
        document,
        layer: id,
        target,
        samples,
    };
    begin(painting, pen)
}

fn begin(mut gesture: impl Gesture + 'static, pen: Pen) -> Begun {
    let outcome = gesture.drag(&[pen]);
    (Some(Box::new(gesture)), outcome)
}

/// The document with a layer that a stroke can go to. `None` where the layer in hand is locked, or there is nothing to erase.
fn paintable(context: &Context, purpose: Purpose) -> Option<(Document, LayerId)> {
    let document = context.document;
    let selected = context.layer.and_then(|id| document.layer(id));
    if let Some(layer) = selected {
        let holds = matches!(layer.content, Content::Strokes(_) | Content::Pixels(_));
        if layer.lock == Lock::All {
            return None;
        }
        if holds {
            return Some((document.clone(), layer.id));
        }
    }
    if purpose == Purpose::Erase {
        return None;
    }
    let place = selected
        .and_then(|layer| document.place_of(layer.id))
        .map_or(Place::top_level(usize::MAX), |place| Place { index: place.index + 1, ..place });
    let layer = Layer::new(free_name(document, "Strokes"), Content::Strokes(Live::new(StrokeList::default())));
    let id = layer.id;
    Some((document.with_inserted(layer, place)?, id))
}

/// A name that no layer has: “Strokes”, “Strokes 2”, …
pub fn free_name(document: &Document, base: &str) -> String {
    let taken = |name: &str| document.layer_named(name).is_some();
    let mut name = base.to_owned();
    for i in 2.. {
        if !taken(&name) {
            break;
        }
        name = format!("{base} {i}");
    }
    name
}

/// Where the stroke goes.
enum Target {
    Strokes(Live<StrokeList>),
    Pixels { base: PixelLayer, shown: TileGrid, effect: Effect },
}

/// A stroke in the making.
struct Painting {
    /// As it was before the stroke, with the layer that the stroke goes to.
    document: Document,
    layer: LayerId,
    scene: Scene,
    target: Target,
    brush: Brush,
    operator: Operator,
    color: Color,
    samples: Vec<Sample>,
    label: &'static str,
}

/// The curve up to the sample before the last but one no longer changes as samples are added.
const TAIL: usize = 3;

impl Painting {
    fn stroke(&self, samples: Vec<Sample>) -> Arc<Stroke> {
        Arc::new(Stroke::new(self.brush.clone(), self.operator, self.color, samples))
    }
    /// The document with the stroke as it is; only tiles for which `changes` is true are painted anew.
    fn with(&mut self, stroke: &Arc<Stroke>, changes: impl Fn(TileAt) -> bool) -> Option<Document> {
        match &mut self.target {
            Target::Strokes(list) => {
                let mut strokes = list.params().strokes.clone();
                strokes.push(stroke.clone());
                let next = list.with(StrokeList { strokes }, |at| !stroke.touches(&self.scene, at));
                self.document.with_layer(self.layer, |layer| layer.content = Content::Strokes(next))
            }
            Target::Pixels { base, shown, effect } => {
                let canvas = TileAt::covering(self.scene.size.rect());
                let tiles: Vec<TileAt> = canvas.filter(|&at| stroke.touches(&self.scene, at) && changes(at)).collect();
                *shown = pixels::painted(&base.tiles, shown, stroke, &self.scene, *effect, &tiles);
                // What was painted here is no longer what the file holds.
                let next = PixelLayer { file: String::new(), tiles: shown.clone(), ..base.clone() };
                self.document.with_layer(self.layer, |layer| layer.content = Content::Pixels(next))
            }
        }
    }
}

impl Gesture for Painting {
    fn drag(&mut self, pens: &[Pen]) -> Outcome {
        let from = self.samples.len().saturating_sub(TAIL);
        self.samples.extend(pens.iter().map(|pen| pen.sample));
        let tail = self.stroke(self.samples[from..].to_vec());
        // Dabs of the tail stand a step apart from the stroke's own: a little larger, it covers them.
        let mut wider = tail.brush().clone();
        wider.size *= 1.0 + 2.0 * wider.spacing.min(1.0);
        let tail = Stroke::new(wider, self.operator, self.color, tail.samples().to_vec());
        let (stroke, scene) = (self.stroke(self.samples.clone()), self.scene.clone());
        self.with(&stroke, |at| tail.touches(&scene, at)).map_or(Outcome::Idle, Outcome::Preview)
    }
    fn release(&mut self) -> Outcome {
        let stroke = self.stroke(self.samples.clone());
        let Some(document) = self.with(&stroke, |_| true) else { return Outcome::Cancel };
        Outcome::Commit { label: self.label.into(), document, select: Some(self.layer) }
    }
}

/// The eraser on a stroke layer: a stroke that is touched is gone.
struct TakenAway {
    document: Document,
    layer: LayerId,
    list: Live<StrokeList>,
    gone: Vec<usize>,
}

impl TakenAway {
    fn without(&self) -> Option<Document> {
        let kept = |i: &usize| !self.gone.contains(i);
        let strokes = &self.list.params().strokes;
        let left = (0..strokes.len()).filter(kept).map(|i| strokes[i].clone()).collect();
        let list = Live::new(StrokeList { strokes: left });
        self.document.with_layer(self.layer, |layer| layer.content = Content::Strokes(list))
    }
}

impl Gesture for TakenAway {
    fn drag(&mut self, pens: &[Pen]) -> Outcome {
        let strokes = &self.list.params().strokes;
        for pen in pens {
            let touched = (0..strokes.len()).rev().find(|i| !self.gone.contains(i) && is_on(&strokes[*i], pen.place()));
            self.gone.extend(touched);
        }
        if self.gone.is_empty() {
            return Outcome::Idle;
        }
        self.without().map_or(Outcome::Idle, Outcome::Preview)
    }
    fn release(&mut self) -> Outcome {
        match self.without() {
            Some(document) if !self.gone.is_empty() => {
                let label = if self.gone.len() == 1 { "Take a stroke away" } else { "Take strokes away" };
                Outcome::Commit { label: label.into(), document, select: None }
            }
            _ => Outcome::Cancel,
        }
    }
}

/// The pen stands on a stroke: within its radius of the line through its samples.
pub fn is_on(stroke: &Stroke, at: Vec2) -> bool {
    let radius = (0.5 * stroke.brush().size).max(4.0);
    let round = matches!(stroke.brush().tip, Tip::Round);
    let radius = if round { radius } else { 0.8 * radius };
    let samples = stroke.samples();
    let near = |a: Vec2, b: Vec2| {
        let along = b - a;
        let t = if along.length_squared() > 0.0 { (at - a).dot(along) / along.length_squared() } else { 0.0 };
        at.distance(a + along * t.clamp(0.0, 1.0)) <= radius
    };
    match samples {
        [one] => near(one.at, one.at),
        _ => samples.windows(2).any(|pair| near(pair[0].at, pair[1].at)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Size, vec2};

    fn context<'a>(document: &'a Document, layer: Option<LayerId>, brush: &'a Brush) -> Context<'a> {
        let (color, second_color) = (Color::BLACK, Color::WHITE);
        Context {
            document,
            layer,
            brush,
            color,
            second_color,
            operator: Operator::None,
            px_per_pt: 1.0,
            last_end: None,
        }
    }
    fn drawn(context: &Context, purpose: Purpose, points: &[Vec2]) -> (Document, Option<LayerId>) {
        let (gesture, _) = press(context, Pen::at(points[0]), purpose);
        let mut gesture = gesture.unwrap();
        for &point in &points[1..] {
            gesture.drag(&[Pen::at(point)]);
        }
        match gesture.release() {
            Outcome::Commit { document, select, .. } => (document, select),
            _ => panic!("a stroke is kept"),
        }
    }
    fn paint_layer() -> Document {
        let pixels = PixelLayer { file: String::new(), x: 0, y: 0, tiles: TileGrid::default() };
        let layers = vec![Arc::new(Layer::new("Paint", Content::Pixels(pixels)))];
        Document { layers, ..Document::empty(Size::new(200, 150)) }
    }
    fn tiles(document: &Document) -> &TileGrid {
        match &document.layers[0].content {
            Content::Pixels(pixels) => &pixels.tiles,
            _ => panic!("a paint layer"),
        }
    }
    const LINE: [Vec2; 6] = [
        vec2(20.0, 40.0),
        vec2(60.0, 52.0),
        vec2(100.0, 44.0),
        vec2(140.0, 80.0),
        vec2(150.0, 120.0),
        vec2(90.0, 130.0),
    ];

    #[test]
    fn the_first_stroke_makes_a_layer_to_hold_it() {
        let (empty, brush) = (Document::empty(Size::new(200, 150)), Brush::default());
        let (document, select) = drawn(&context(&empty, None, &brush), Purpose::Paint, &LINE);
        assert_eq!(document.layers.len(), 1);
        assert_eq!(select, Some(document.layers[0].id));
        let Content::Strokes(list) = &document.layers[0].content else { panic!("a stroke layer") };
        assert_eq!(list.params().strokes[0].samples().len(), LINE.len());
        let (again, _) = drawn(&context(&document, select, &brush), Purpose::Paint, &LINE);
        assert_eq!(again.layers.len(), 1, "the next one goes to the same layer");
    }
    #[test]
    fn pixels_painted_step_by_step_are_those_painted_at_once() {
        let (document, brush) = (paint_layer(), Brush { size: 30.0, ..Brush::default() });
        let id = Some(document.layers[0].id);
        let (steps, _) = drawn(&context(&document, id, &brush), Purpose::Paint, &LINE);
        let stroke = Stroke::new(brush, Operator::None, Color::BLACK, LINE.map(Sample::at).to_vec());
        let scene = document.scene();
        for at in TileAt::covering(scene.size.rect()) {
            let whole = crate::paint::stroke::render_tile(&[Arc::new(stroke.clone())], &scene, at);
            let bytes = tiles(&steps).tile(at).map(|tile| tile.bytes().to_vec());
            assert!(bytes == whole.map(|tile| tile.bytes().to_vec()), "{at:?}");
        }
    }
    #[test]
    fn erasing_takes_out_what_painting_put_in_and_locked_alpha_keeps_the_shape() {
        let brush = Brush { size: 30.0, hardness: 1.0, ..Brush::default() };
        let document = paint_layer();
        let id = Some(document.layers[0].id);
        let (painted, _) = drawn(&context(&document, id, &brush), Purpose::Paint, &LINE);
        assert_eq!(tiles(&painted).pixel(60, 52), [0, 0, 0, 255]);
        let (erased, _) = drawn(&context(&painted, id, &brush), Purpose::Erase, &LINE);
        assert_eq!(tiles(&erased).pixel(60, 52), [0; 4]);
        let locked = painted.with_layer(painted.layers[0].id, |layer| layer.lock = Lock::Alpha).unwrap();
        let wide = Brush { size: 90.0, ..brush };
        let white = Context { color: Color::WHITE, ..context(&locked, id, &wide) };
        let (atop, _) = drawn(&white, Purpose::Paint, &LINE);
        assert_eq!((tiles(&atop).pixel(60, 52), tiles(&atop).pixel(60, 90)), ([255; 4], [0; 4]));
    }
    #[test]
    fn a_locked_layer_takes_no_paint() {
        let (document, brush) = (paint_layer(), Brush::default());
        let id = document.layers[0].id;
        let locked = document.with_layer(id, |layer| layer.lock = Lock::All).unwrap();
        assert!(press(&context(&locked, Some(id), &brush), Pen::at(LINE[0]), Purpose::Paint).0.is_none());
    }
    #[test]
    fn the_eraser_takes_whole_strokes_from_a_stroke_layer() {
        let (empty, brush) = (Document::empty(Size::new(200, 150)), Brush { size: 8.0, ..Brush::default() });
        let (one, id) = drawn(&context(&empty, None, &brush), Purpose::Paint, &[vec2(10.0, 20.0), vec2(90.0, 20.0)]);
        let (two, _) = drawn(&context(&one, id, &brush), Purpose::Paint, &[vec2(10.0, 90.0), vec2(90.0, 90.0)]);
        let (left, _) = drawn(&context(&two, id, &brush), Purpose::Erase, &[vec2(50.0, 91.0)]);
        let Content::Strokes(list) = &left.layers[0].content else { panic!("a stroke layer") };
        assert_eq!(list.params().strokes.len(), 1);
        assert_eq!(list.params().strokes[0].samples()[0].at.y, 20.0);
    }
}
