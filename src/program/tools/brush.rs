//! The brush and the eraser: the pen's samples become one stroke, live on a stroke layer, pixels on a paint layer.
//! Floor 5. Dabs and tiles are in `paint`.

use super::retouch::{self, ActiveWork};
use super::symmetry::SymmetryImage;
use super::{Gesture, GestureStart, Outcome, PenSample, ToolContext};
use crate::document::{Content, Document, Layer, LayerId, LayerLock, LayerSlot, Live, PixelLayer, StrokeList};
use crate::math::{Vec2, hash, srgb::Color};
use crate::paint::{ActiveStrokes, Backdrop, BrushMode, Sample, Scene, StabilizedPen, Stroke, Tip};
use crate::raster::{Tile, TileAt, TileGrid};
use std::collections::HashSet;
use std::sync::Arc;

/// What the stroke is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StrokePurpose {
    Paint,
    Erase,
}

/// The pen comes down with the brush. A selected layer that cannot hold strokes gets a stroke layer above it.
pub fn press(context: &ToolContext, pen: PenSample, purpose: StrokePurpose) -> GestureStart {
    if let Some(refused) = retouch::refused(context, pen, purpose) {
        return (None, refused);
    }
    let Some((document, id)) = paintable(context, purpose) else { return (None, Outcome::Idle) };
    let Some(layer) = document.layer(id) else { return (None, Outcome::Idle) };
    let scene = document.scene_of(id).unwrap_or_else(|| document.scene());
    let (target, backdrop) = match (&layer.content, purpose) {
        (Content::Strokes(list), StrokePurpose::Erase) if pen.keys.ctrl => {
            let taken = EraseStrokesGesture {
                document: context.document.clone(),
                layer: id,
                list: list.clone(),
                gone: Vec::new(),
            };
            return begin(taken, pen);
        }
        (Content::Strokes(list), _) => {
            let strokes = list.params().strokes.clone();
            // The tiles of an empty layer are known.
            let blank = TileAt::covering(scene.size.rect()).filter(|_| strokes.is_empty()).map(|at| (at, None));
            let shown = list.with_tiles(list.params().clone(), &scene, blank);
            (StrokeTarget::Strokes { beneath: strokes.clone(), shown }, Backdrop::Strokes(strokes))
        }
        (Content::Pixels(pixels), _) => {
            let mut shown = pixels.tiles.clone();
            shown.reserve(scene.size.rect());
            let base = PixelLayer { file: String::new(), ..pixels.clone() };
            (StrokeTarget::Pixels { base, shown }, Backdrop::Pixels(pixels.tiles.clone()))
        }
        _ => return (None, Outcome::Idle),
    };
    let is_eraser = purpose == StrokePurpose::Erase;
    let mut brush = context.brush.clone();
    if is_eraser {
        brush.mode = BrushMode::Paint;
    }
    brush.erases |= is_eraser;
    brush.keeps_alpha |= layer.lock == LayerLock::Alpha;
    if brush.is_random() {
        // The same samples give the same seed, so a repeated stroke is identical.
        brush.seed = hash::mix(pen.place().x.to_bits() ^ hash::mix(pen.place().y.to_bits()));
    }
    let color = if is_eraser { Color { a: 255, ..context.color } } else { context.color };
    let images = context.symmetry.images_about(document.size, context.axes);
    let like = |image: &SymmetryImage| {
        Stroke::new(image.brush(&brush), context.operator, color, Vec::new())
            .within(context.document.stroke_selection())
    };
    let strokes: Vec<Stroke> = images.iter().map(like).collect();
    let work = retouch::begun(context, &images, pen, layer, &strokes, &scene);
    // With Shift a straight line from where the last stroke ended, with the pressure of this sample.
    let start = context.last_end.filter(|_| pen.keys.shift).into_iter();
    let line = start.flat_map(|last| (0..8).map(move |i| last.lerp(pen.place(), i as f32 / 8.0)));
    let painting = StrokeGesture {
        lead: line.map(|at| Sample { at, ..pen.sample }).collect(),
        active: Some(work.unwrap_or_else(|| ActiveWork::Strokes(ActiveStrokes::new(&strokes, backdrop, &scene)))),
        stabilized: StabilizedPen::new(brush.stabilizer),
        room: Some(Stroke::MOST_SAMPLES),
        label: if is_eraser { "Erase" } else { "Brush stroke" },
        document,
        layer: id,
        scene,
        target,
        images,
    };
    begin(painting, pen)
}

fn begin(mut gesture: impl Gesture + 'static, pen: PenSample) -> GestureStart {
    let outcome = gesture.drag(&[pen]);
    (Some(Box::new(gesture)), outcome)
}

/// The document with a layer that a stroke can go to. `None` if the selected layer is locked, or there is nothing to
/// erase.
fn paintable(context: &ToolContext, purpose: StrokePurpose) -> Option<(Document, LayerId)> {
    let document = context.document;
    let selected = context.layer.and_then(|id| document.layer(id));
    if let Some(layer) = selected {
        let holds = match &layer.content {
            Content::Strokes(list) => purpose == StrokePurpose::Paint || !list.params().strokes.is_empty(),
            content => matches!(content, Content::Pixels(_)),
        };
        if layer.lock == LayerLock::All {
            return None;
        }
        if holds {
            return Some((document.clone(), layer.id));
        }
    }
    if purpose == StrokePurpose::Erase {
        return None;
    }
    let place = selected
        .and_then(|layer| document.place_of(layer.id))
        .map_or(LayerSlot::top_level(usize::MAX), |place| LayerSlot { index: place.index + 1, ..place });
    let layer = Layer::new(free_name(document, "Strokes"), Content::Strokes(Live::new(StrokeList::default())));
    let id = layer.id;
    Some((document.with_inserted(layer, place)?, id))
}

/// A name that no layer has: “Strokes”, “Strokes 2”, …
pub fn free_name(document: &Document, base: &str) -> String {
    // Looked up once: asked of the document for each number, names would cost the square of the layers.
    let layers = document.walk();
    let taken: HashSet<&str> = layers.iter().map(|(_, layer)| layer.name.as_str()).collect();
    let mut name = base.to_owned();
    for i in 2.. {
        if !taken.contains(name.as_str()) {
            break;
        }
        name = format!("{base} {i}");
    }
    name
}

/// Where the strokes go.
enum StrokeTarget {
    Strokes { beneath: Vec<Arc<Stroke>>, shown: Live<StrokeList> },
    Pixels { base: PixelLayer, shown: TileGrid },
}

/// A stroke being drawn, and its mirror images.
struct StrokeGesture {
    /// The document before the stroke, with the layer that the stroke goes to.
    document: Document,
    layer: LayerId,
    /// What the layer sees.
    scene: Scene,
    target: StrokeTarget,
    /// `None` once it is finished.
    active: Option<ActiveWork>,
    images: Vec<SymmetryImage>,
    stabilized: StabilizedPen,
    /// Samples before the pen's first.
    lead: Vec<Sample>,
    /// How many more a stroke may have; `None` once it was told that there are none.
    room: Option<usize>,
    label: &'static str,
}

impl StrokeGesture {
    /// Draws on to more samples; the tiles that changed.
    fn draw(&mut self, mut samples: Vec<Sample>) -> Vec<(TileAt, Option<Arc<Tile>>)> {
        let Some(active) = &mut self.active else { return Vec::new() };
        // What a file could not give back is not drawn.
        samples.truncate(self.room.unwrap_or_default());
        self.room = self.room.map(|room| room - samples.len());
        let of_image = |image: &SymmetryImage| samples.iter().map(|sample| image.sample(sample).settled()).collect();
        let samples: Vec<Vec<Sample>> = self.images.iter().map(of_image).collect();
        let tiles = active.draw(&samples);
        if let StrokeTarget::Pixels { shown, .. } = &mut self.target {
            tiles.iter().for_each(|(at, tile)| shown.set(*at, tile.clone()));
        }
        tiles
    }
    /// The document with the strokes, of which these tiles changed.
    fn with(&mut self, strokes: Vec<Stroke>, tiles: Vec<(TileAt, Option<Arc<Tile>>)>) -> Option<Document> {
        let content = match &mut self.target {
            StrokeTarget::Strokes { beneath, shown } => {
                let strokes = beneath.iter().cloned().chain(strokes.into_iter().map(Arc::new)).collect();
                *shown = shown.with_tiles(StrokeList { strokes }, &self.scene, tiles);
                Content::Strokes(shown.clone())
            }
            // Painted pixels no longer match the file.
            StrokeTarget::Pixels { base, shown } => {
                Content::Pixels(PixelLayer { tiles: shown.clone(), ..base.clone() })
            }
        };
        self.document.with_layer(self.layer, |layer| layer.content = content)
    }
}

impl Gesture for StrokeGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
        match self.room {
            Some(0) => {
                self.room = None;
                return Outcome::Refused("A stroke can be no longer than this. Lift the pen to begin another.");
            }
            None => return Outcome::Idle,
            Some(_) => {}
        }
        let mut samples = std::mem::take(&mut self.lead);
        samples.extend(pens.iter().filter_map(|pen| self.stabilized.push(pen.sample)));
        let tiles = self.draw(samples);
        let strokes = self.active.as_ref().map_or(Vec::new(), ActiveWork::strokes);
        self.with(strokes, tiles).map_or(Outcome::Idle, Outcome::Preview)
    }
    fn release(&mut self) -> Outcome {
        let rest = self.stabilized.finish().into_iter().collect();
        let tiles = self.draw(rest);
        let strokes = self.active.take().map_or(Vec::new(), ActiveWork::finish);
        let Some(mut document) = self.with(strokes, tiles) else { return Outcome::Cancel };
        if let StrokeTarget::Strokes { shown, .. } = &self.target {
            // Behind contours strokes are rendered once they are finished.
            let content = Content::Strokes(shown.settled());
            document = document.with_layer(self.layer, |layer| layer.content = content).unwrap_or(document);
        }
        Outcome::Commit { label: self.label.into(), document, select: Some(self.layer) }
    }
}

/// The eraser with Ctrl on a stroke layer: it removes every stroke that it touches.
struct EraseStrokesGesture {
    document: Document,
    layer: LayerId,
    list: Live<StrokeList>,
    gone: Vec<usize>,
}

impl EraseStrokesGesture {
    fn without(&self) -> Option<Document> {
        let kept = |i: &usize| !self.gone.contains(i);
        let strokes = &self.list.params().strokes;
        let left = (0..strokes.len()).filter(kept).map(|i| strokes[i].clone()).collect();
        let list = Live::new(StrokeList { strokes: left });
        self.document.with_layer(self.layer, |layer| layer.content = Content::Strokes(list))
    }
}

impl Gesture for EraseStrokesGesture {
    fn drag(&mut self, pens: &[PenSample]) -> Outcome {
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
                let label = if self.gone.len() == 1 { "Delete stroke" } else { "Delete strokes" };
                Outcome::Commit { label: label.into(), document, select: None }
            }
            _ => Outcome::Cancel,
        }
    }
}

/// Whether the pen is on a stroke: within its radius of the line through its samples.
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
    use crate::paint::{Brush, Stabilizer};
    use crate::surface::Operator;
    use crate::tools::{ModifierKeys, Symmetry};

    fn context<'a>(document: &'a Document, layer: Option<LayerId>, brush: &'a Brush) -> ToolContext<'a> {
        ToolContext { layer, ..ToolContext::new(document, brush) }
    }
    fn drawn(context: &ToolContext, purpose: StrokePurpose, points: &[Vec2]) -> (Document, Option<LayerId>) {
        let (gesture, _) = press(context, PenSample::at(points[0]), purpose);
        let mut gesture = gesture.unwrap();
        for &point in &points[1..] {
            gesture.drag(&[PenSample::at(point)]);
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
        let (document, select) = drawn(&context(&empty, None, &brush), StrokePurpose::Paint, &LINE);
        assert_eq!(document.layers.len(), 1);
        assert_eq!(select, Some(document.layers[0].id));
        let Content::Strokes(list) = &document.layers[0].content else { panic!("a stroke layer") };
        assert_eq!(list.params().strokes[0].samples().len(), LINE.len());
        let (again, _) = drawn(&context(&document, select, &brush), StrokePurpose::Paint, &LINE);
        assert_eq!(again.layers.len(), 1, "the next one goes to the same layer");
    }
    #[test]
    fn pixels_painted_step_by_step_are_those_painted_at_once() {
        let (document, brush) = (paint_layer(), Brush { size: 30.0, ..Brush::default() });
        let id = Some(document.layers[0].id);
        let (steps, _) = drawn(&context(&document, id, &brush), StrokePurpose::Paint, &LINE);
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
        let (painted, _) = drawn(&context(&document, id, &brush), StrokePurpose::Paint, &LINE);
        assert_eq!(tiles(&painted).pixel(60, 52), [0, 0, 0, 255]);
        let (erased, _) = drawn(&context(&painted, id, &brush), StrokePurpose::Erase, &LINE);
        assert_eq!(tiles(&erased).pixel(60, 52), [0; 4]);
        let locked = painted.with_layer(painted.layers[0].id, |layer| layer.lock = LayerLock::Alpha).unwrap();
        let wide = Brush { size: 90.0, ..brush };
        let white = ToolContext { color: Color::WHITE, ..context(&locked, id, &wide) };
        let (atop, _) = drawn(&white, StrokePurpose::Paint, &LINE);
        assert_eq!((tiles(&atop).pixel(60, 52), tiles(&atop).pixel(60, 90)), ([255; 4], [0; 4]));
    }
    #[test]
    fn a_locked_layer_takes_no_paint() {
        let (document, brush) = (paint_layer(), Brush::default());
        let id = document.layers[0].id;
        let locked = document.with_layer(id, |layer| layer.lock = LayerLock::All).unwrap();
        assert!(press(&context(&locked, Some(id), &brush), PenSample::at(LINE[0]), StrokePurpose::Paint).0.is_none());
    }
    #[test]
    fn the_eraser_with_ctrl_takes_whole_strokes_from_a_stroke_layer() {
        let (empty, brush) = (Document::empty(Size::new(200, 150)), Brush { size: 8.0, ..Brush::default() });
        let (one, id) =
            drawn(&context(&empty, None, &brush), StrokePurpose::Paint, &[vec2(10.0, 20.0), vec2(90.0, 20.0)]);
        let (two, _) = drawn(&context(&one, id, &brush), StrokePurpose::Paint, &[vec2(10.0, 90.0), vec2(90.0, 90.0)]);
        let ctrl = PenSample {
            keys: ModifierKeys { ctrl: true, ..ModifierKeys::default() },
            ..PenSample::at(vec2(50.0, 91.0))
        };
        let (gesture, _) = press(&context(&two, id, &brush), ctrl, StrokePurpose::Erase);
        let Outcome::Commit { document: left, .. } = gesture.unwrap().release() else { panic!("one is gone") };
        let Content::Strokes(list) = &left.layers[0].content else { panic!("a stroke layer") };
        assert_eq!(list.params().strokes.len(), 1);
        assert_eq!(list.params().strokes[0].samples()[0].at.y, 20.0);
    }
    #[test]
    fn the_eraser_lays_a_stroke_that_takes_paint_away_where_there_are_strokes() {
        let (empty, brush) = (Document::empty(Size::new(200, 150)), Brush { size: 8.0, ..Brush::default() });
        let (one, id) =
            drawn(&context(&empty, None, &brush), StrokePurpose::Paint, &[vec2(10.0, 20.0), vec2(90.0, 20.0)]);
        let (cut, _) = drawn(&context(&one, id, &brush), StrokePurpose::Erase, &[vec2(50.0, 5.0), vec2(50.0, 60.0)]);
        let Content::Strokes(list) = &cut.layers[0].content else { panic!("a stroke layer") };
        let erases: Vec<bool> = list.params().strokes.iter().map(|stroke| stroke.brush().erases).collect();
        assert_eq!(erases, [false, true]);
        let (none, id) = (one.with_layer(one.layers[0].id, |layer| layer.content = blank()).unwrap(), id.unwrap());
        assert!(press(&context(&none, Some(id), &brush), PenSample::at(LINE[0]), StrokePurpose::Erase).0.is_none());
    }
    fn blank() -> Content {
        Content::Strokes(Live::new(StrokeList::default()))
    }
    #[test]
    fn mirror_images_are_strokes_of_their_own() {
        let empty = Document::empty(Size::new(200, 150));
        let brush = Brush { size: 8.0, hardness: 1.0, ..Brush::default() };
        let plain = context(&empty, None, &brush);
        let mirrored = ToolContext { symmetry: Symmetry::Vertical, ..plain };
        let (document, _) = drawn(&mirrored, StrokePurpose::Paint, &[vec2(20.0, 40.0), vec2(60.0, 90.0)]);
        let Content::Strokes(list) = &document.layers[0].content else { panic!("a stroke layer") };
        let ends: Vec<Vec2> = list.params().strokes.iter().map(|stroke| stroke.samples()[1].at).collect();
        assert_eq!(ends, [vec2(60.0, 90.0), vec2(140.0, 90.0)]);
        let on_paint = ToolContext { document: &paint_layer(), layer: None, ..mirrored };
        let id = on_paint.document.layers[0].id;
        let (painted, _) =
            drawn(&ToolContext { layer: Some(id), ..on_paint }, StrokePurpose::Paint, &[vec2(20.0, 40.0)]);
        assert_eq!((tiles(&painted).pixel(20, 40)[3], tiles(&painted).pixel(179, 40)[3]), (255, 255));
    }
    #[test]
    fn a_calmed_line_is_finished_when_the_pen_lifts() {
        let empty = Document::empty(Size::new(200, 150));
        let brush = Brush { size: 8.0, stabilizer: Stabilizer::String { length_px: 40.0 }, ..Brush::default() };
        let (document, _) =
            drawn(&context(&empty, None, &brush), StrokePurpose::Paint, &[vec2(20.0, 40.0), vec2(120.0, 40.0)]);
        let Content::Strokes(list) = &document.layers[0].content else { panic!("a stroke layer") };
        let places: Vec<f32> = list.params().strokes[0].samples().iter().map(|s| s.at.x).collect();
        assert_eq!(places, [20.0, 80.0, 120.0]);
    }
    #[test]
    fn an_erasing_brush_takes_nothing_from_paint_whose_alpha_is_locked() {
        let brush = Brush { size: 30.0, hardness: 1.0, ..Brush::default() };
        let document = paint_layer();
        let id = Some(document.layers[0].id);
        let (painted, _) = drawn(&context(&document, id, &brush), StrokePurpose::Paint, &LINE);
        let locked = painted.with_layer(painted.layers[0].id, |layer| layer.lock = LayerLock::Alpha).unwrap();
        let (erased, _) = drawn(&context(&locked, id, &brush), StrokePurpose::Erase, &LINE);
        assert_eq!(tiles(&erased).pixel(60, 52), [0, 0, 0, 255]);
    }
    #[test]
    fn what_is_redrawn_while_drawing_does_not_grow_with_the_stroke() {
        use crate::document::diff::diff;
        let (empty, brush) = (Document::empty(Size::new(2000, 500)), Brush { size: 20.0, ..Brush::default() });
        let (gesture, first) =
            press(&context(&empty, None, &brush), PenSample::at(vec2(20.0, 100.0)), StrokePurpose::Paint);
        let (mut gesture, Outcome::Preview(mut before)) = (gesture.unwrap(), first) else { panic!("it shows") };
        for i in 1..90 {
            let Outcome::Preview(next) = gesture.drag(&[PenSample::at(vec2(20.0 + 20.0 * i as f32, 100.0))]) else {
                panic!("it shows")
            };
            let redrawn = diff(&before, &next).len();
            assert!(redrawn <= 8, "{redrawn} tiles at sample {i}");
            before = next;
        }
    }
}
