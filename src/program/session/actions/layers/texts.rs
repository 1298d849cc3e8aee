//! Layers that are texts: written, and retyped in their places. Floor 6. Not here: how a text is
//! laid out (`io::text`).

use super::slot_above;
use crate::Result;
use crate::document::{Content, Document, Layer, LayerId, Live};
use crate::io::{Budget, text};
use crate::math::{Size, Vec2};
use crate::paint::{
    Adjust, ImageFilter, LivePath, PictureOrigin, PictureSource, PlacedImage, Placement, Subpath,
    Text, TextPath, TextStyle,
};
use crate::raster::Outside;
use crate::session::actions::file_names::free_file;
use crate::session::{OpenDocument, Session, Writing};
use crate::surface::{Anchor, Bend};
use crate::tools::path;
use std::sync::Arc;
use text::{Caret, TextPicture};

/// The most letters of a layer's name that come from its text.
const NAME_LETTERS: usize = 24;

/// What a text says before anybody typed.
const PLACEHOLDER: &str = "Text";

/// The heights of the canvas that make the size of a first text.
const FIRST_SIZE: f32 = 0.1;

/// The pen comes down with the text tool: on a text, to go on in it, or beside, to begin one in the
/// style of the selected text.
///
/// Beside texts, on the line of a path, the text runs along that from there. `reach`: how near
/// counts as on it, canvas px.
pub(in crate::session::actions) fn press(session: &mut Session, at: Vec2, reach: f32) {
    let turn = session.writing.map_or(0, |writing| writing.turn.wrapping_add(1));
    let color = session.tools.color;
    let Some(open) = session.active_mut() else { return };
    open.forget_preview();
    if let Some((layer, byte)) = text_under(open.document(), at) {
        open.select_layers(vec![layer]);
        session.writing = Some(Writing { layer, byte, turn });
        return;
    }
    let selected = open.active_layer.and_then(|id| open.document().layer(id)).and_then(text_of);
    let style = selected.map_or_else(
        || {
            let size = FIRST_SIZE * open.document().size.height as f32;
            let size = size.round().max(12.0).min(*TextStyle::SIZE.end());
            TextStyle { size, color, ..TextStyle::default() }
        },
        |text| text.style_at(0),
    );
    let mut text = Text::new(PLACEHOLDER, style);
    text.path = path_under(open.document(), at, reach);
    // The points of a path are canvas points.
    let begin = if text.path.is_some() { Vec2::ZERO } else { at };
    match write(open, &text, begin) {
        Ok(()) => {
            let layer = open.active_layer;
            session.writing = layer.map(|layer| Writing { layer, byte: None, turn });
        }
        Err(error) => session.say(&error.to_string()),
    }
}

/// The topmost visible text whose box a canvas point lies in, and the place between its letters
/// that is nearest to it.
fn text_under(document: &Document, at: Vec2) -> Option<(LayerId, Option<usize>)> {
    document.walk().into_iter().rev().filter(|(_, layer)| layer.visible).find_map(|(_, layer)| {
        let Content::Image(live) = &layer.content else { return None };
        let (image, text) = (live.params(), &**live.params().source.text()?);
        let (in_frame, _) = image.frame.from_canvas(at)?;
        let own = image.frame_from_own(document.size).inverse().transform_point2(in_frame);
        let size = image.source.picture.own_size();
        let is_within = own.cmpge(Vec2::ZERO).all() && own.cmple(size).all();
        is_within.then(|| {
            let carets = text::carets(text).unwrap_or_default();
            let distance = |caret: &Caret| {
                let middle = caret.at - Vec2::Y * (0.35 * caret.height);
                (middle + text.origin).distance_squared(own)
            };
            let nearest = carets.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
            (layer.id, nearest.map(|caret| caret.byte))
        })
    })
}

/// The line of the topmost visible path that a canvas point lies on, in canvas px, for a text that
/// begins there.
fn path_under(document: &Document, at: Vec2, reach: f32) -> Option<TextPath> {
    document.walk().into_iter().rev().filter(|(_, layer)| layer.visible).find_map(|(_, layer)| {
        let lines = lines_on_canvas(document, layer, &Some);
        lines.into_iter().find_map(|line| {
            let place = line.flatten(&Some)?.nearest_place(at)?;
            (place.at.distance(at) <= reach).then_some(TextPath { line, shift: place.along })
        })
    })
}

/// The lines of a layer that is a path, moved from the canvas by a map; without those that have a
/// point that it has none for.
fn lines_on_canvas(
    document: &Document,
    layer: &Layer,
    map: &impl Fn(Vec2) -> Option<Vec2>,
) -> Vec<Subpath> {
    let Some(image) = path::of_layer(layer) else { return Vec::new() };
    let Some(live) = image.source.path() else { return Vec::new() };
    let to_canvas = path::to_canvas(image, document.size);
    let moved = |point| map(to_canvas(point)?).filter(|at| at.is_finite());
    let is_whole = |line: &&Subpath| {
        let mut points = line.nodes.iter().flat_map(|n| [n.at, n.at + n.before, n.at + n.after]);
        points.all(|point| moved(point).is_some())
    };
    let lines = live.subpaths();
    let mapped = lines.iter().filter(is_whole);
    let mapped = mapped.map(|line| line.mapped(|point| moved(point).unwrap_or(point)));
    // What no file could hold is no line here.
    mapped.filter(|line| LivePath::new(vec![line.clone()]).fits().is_ok()).collect()
}

/// The document with a text that runs along the longest line of a path, where that lies now.
pub(in crate::session::actions) fn put_on_path(
    document: &Document,
    text: LayerId,
    path: LayerId,
) -> std::result::Result<Option<Document>, String> {
    const NO_TEXT: &str = "That layer is no text.";
    let layers = document.layer(text).zip(document.layer(path));
    let (layer, path) = layers.ok_or("There is no such layer.")?;
    let Content::Image(live) = &layer.content else { return Err(NO_TEXT.into()) };
    let image = live.params();
    let words = image.source.text().ok_or(NO_TEXT)?;
    let to_own = image.frame_from_own(document.size).inverse();
    let to_text = |at: Vec2| {
        let (in_frame, _) = image.frame.from_canvas(at)?;
        Some(to_own.transform_point2(in_frame) - words.origin)
    };
    let lines = lines_on_canvas(document, path, &to_text);
    let length = |line: &Subpath| line.flatten(&Some).map_or(0.0, |flat| flat.length());
    let longest = lines.into_iter().max_by(|a, b| length(a).total_cmp(&length(b)));
    let line = longest.filter(|line| length(line) > 0.0);
    let line = line.ok_or("That layer is no path that a text could run along.")?;
    let next = Text { path: Some(TextPath { line, shift: 0.0 }), ..Text::clone(words) };
    replace_texts(document, document, &[text], &next).map_err(|why| why.to_string())
}

fn text_of(layer: &Arc<Layer>) -> Option<Arc<Text>> {
    match &layer.content {
        Content::Image(live) => live.params().source.text().cloned(),
        _ => None,
    }
}

/// Adds a text above the selected layer, and selects it. Its first baseline begins at a point.
pub(super) fn write(open: &mut OpenDocument, text: &Text, at: Vec2) -> Result<()> {
    let laid = text::lay_out(text, &Budget::of_this_machine())?;
    let document = open.document();
    let canvas = document.size;
    let center = at - laid.text.origin + laid.size / 2.0;
    let placement = Placement::at_own_size(canvas, &laid.picture, center);
    let image = PlacedImage {
        source: source(free_file(document, "text.svg"), laid, Adjust::default()),
        placement,
        outside: Outside::None,
        bend: Bend { anchors: vec![Anchor::pin(center)], ..Bend::default() },
        filter: ImageFilter::Antialias,
        frame: Default::default(),
    };
    let (name, content) = (document.free_layer_name(&name(text)), Content::Image(Live::new(image)));
    let layer = Layer { clip_to_surface: false, ..Layer::new(name, content) };
    let id = layer.id;
    if let Some(next) = document.with_inserted(layer, slot_above(open))
        && open.commit("Write", next)
    {
        open.active_layer = Some(id);
    }
    Ok(())
}

/// The document with another text in the layers that are texts; `None` where none is. Each keeps
/// its size and the place where its first baseline begins, and its name if that is not its text.
///
/// * `shown`: the document as it is shown, with the keys that are no step yet: a text is painted
///   over what is seen of it, and lies where that of the last step would.
pub(super) fn replace_texts(
    document: &Document,
    shown: &Document,
    ids: &[LayerId],
    text: &Text,
) -> Result<Option<Document>> {
    let is_text = |id: &LayerId| document.layer(*id).and_then(text_of).is_some();
    let ids: Vec<LayerId> = ids.iter().copied().filter(is_text).collect();
    if ids.is_empty() {
        return Ok(None);
    }
    let (file, canvas) = (free_file(document, "text.svg"), document.size);
    let budget = Budget::of_this_machine();
    let mut laid: Vec<(&Live<PlacedImage>, TextPicture)> = Vec::new();
    for id in &ids {
        let layer = shown.layer(*id).filter(|layer| text_of(layer).is_some());
        let Some(Content::Image(seen)) =
            layer.or_else(|| document.layer(*id)).map(|layer| &layer.content)
        else {
            continue;
        };
        laid.push((seen, text::lay_out_again(text, &seen.params().source.picture, &budget)?));
    }
    let mut laid = laid.into_iter();
    Ok(document.with_layers(&ids, |layer| {
        let Content::Image(live) = &layer.content else { return };
        let Some((seen, laid)) = laid.next() else { return };
        let old = live.params().source.text().cloned();
        let next = with_text(live.params(), seen, canvas, file.clone(), laid);
        layer.content = Content::Image(next);
        if old.is_some_and(|old| layer.name == name(&old)) && layer.name != name(text) {
            layer.name = document.free_layer_name(&name(text));
        }
    }))
}

/// An image that shows another text at the same size, its first baseline where it was.
///
/// * `seen`: the layer that the text was laid out in the place of.
fn with_text(
    image: &PlacedImage,
    seen: &Live<PlacedImage>,
    canvas: Size,
    file: String,
    laid: TextPicture,
) -> Live<PlacedImage> {
    let placement = placement_of(image, canvas, &laid);
    let was = seen.params();
    let unchanged = PlacedImage { source: was.source.clone(), placement, ..image.clone() };
    let Some(changed) = laid.changed.filter(|_| unchanged == *was) else {
        let source = source(file, laid, image.source.adjust);
        return Live::new(PlacedImage { source, ..unchanged });
    };
    // What a key did not change stays as it is drawn.
    let rows = changed.y0.max(0) as u32..changed.y1.max(0) as u32;
    let mut source = was.source.repainted(file, laid.picture, rows);
    source.origin = PictureOrigin::Text(Arc::new(laid.text));
    let next = PlacedImage { source, ..unchanged };
    match next.seen_rect(canvas, changed) {
        Some(changed) => seen.with(next, |at| changed.intersect(at.rect()).is_empty()),
        None => Live::new(next),
    }
}

/// Where another text lies in the place of that of an image: at the same size, its first baseline
/// where it was.
fn placement_of(image: &PlacedImage, canvas: Size, laid: &TextPicture) -> Placement {
    let (old, new) = (&image.source.picture, &laid.picture);
    let own = Placement::at_own_size(canvas, old, Vec2::ZERO).scale;
    let enlarged = image.placement.scale / own;
    let placement = Placement::at_own_size(canvas, new, image.placement.center);
    let scale = placement.scale * enlarged;
    let scale = scale.max(*Placement::SCALE.start()).min(*Placement::SCALE.end());
    // From the middle of a picture to where its first baseline begins, canvas px.
    let turn = Vec2::from_angle(-image.placement.rotation.to_radians());
    let begin = |origin: Vec2, size: Vec2| turn.rotate((origin - size / 2.0) * enlarged);
    let was = image.source.text().map_or(Vec2::ZERO, |text| text.origin);
    let moved = begin(was, old.own_size()) - begin(laid.text.origin, laid.size);
    let center = image.placement.center + moved;
    let placement = Placement { center, scale, rotation: image.placement.rotation };
    if is_near(&placement, &image.placement) { image.placement } else { placement }
}

/// Whether they are the same but for rounding.
fn is_near(a: &Placement, b: &Placement) -> bool {
    let is_in_place = a.center.distance(b.center) < 1e-3;
    is_in_place && (a.scale / b.scale - 1.0).abs() < 1e-6 && a.rotation == b.rotation
}

fn source(file: String, laid: TextPicture, adjust: Adjust) -> PictureSource {
    let mut source = PictureSource::new(file, laid.picture, adjust);
    source.origin = PictureOrigin::Text(Arc::new(laid.text));
    source
}

/// What a layer of a text is called: how the text begins.
fn name(text: &Text) -> String {
    let string = text.string();
    let words = string.split_whitespace().collect::<Vec<_>>().join(" ");
    let short: String = words.chars().take(NAME_LETTERS).collect();
    match short.trim_end() {
        "" => "Text".to_owned(),
        short if short.len() < words.len() => format!("{short}…"),
        short => short.to_owned(),
    }
}
