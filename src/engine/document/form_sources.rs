//! Drawings by the form follow the layers that they read: strokes that hatching follows, the picture
//! whose tone it has or whose edges are lines, and ink and strokes that lines leave out. Floor 4. Not
//! here: what they make of them (`paint::form_drawing`).

use super::flatten::{flatten, flatten_layer};
use super::{Content, Document, Group, Layer, LayerId, Live, Progress};
use crate::math::Vec2;
use crate::paint::{
    ColorPicture, DrawingSources, FormDrawing, FormPattern, FoundSources, InkOnCanvas, ReadLayers,
    Stroke, TonePicture, ToneSource,
};
use crate::raster::TileGrid;
use crate::surface::form_lines::LineKind;
use crate::surface::hatching::{GuideLines, HatchTone, HatchWay};
use std::sync::Arc;

/// From one point of a stroke to the next that gives a direction, px: less is a trembling hand.
const EVERY_PX: f32 = 5.0;

impl Document {
    /// Whether all drawings by the form have what is in the layers that they read.
    pub(super) fn has_form_sources(&self) -> bool {
        let ink = self.ink_on_canvas();
        self.reading_drawings().iter().all(|(layer, drawing)| {
            let found = &drawing.found;
            let is_toned = match (self.tone_layers(layer, drawing), &found.tone) {
                (Some(read), Some(tone)) => tone.is_of(&read),
                (None, None) => true,
                _ => false,
            };
            let is_colored = match (self.color_layers(layer, drawing), &found.colors) {
                (Some(read), Some(colors)) => colors.is_of(&read),
                (None, None) => true,
                _ => false,
            };
            let is_inked = found.ink.is_same(&self.ink_of(drawing, &ink));
            is_toned && is_colored && is_inked && self.guide_lines(drawing) == found.guides
        })
    }

    /// The document with drawings by the form as the layers are that they read
    /// ([`Document::has_form_sources`]).
    pub(super) fn with_form_sources(&self) -> Document {
        if self.has_form_sources() {
            return self.clone();
        }
        let ink = self.ink_on_canvas();
        // Directions first: a picture whose tone is read may show hatching along strokes.
        let guided = self.with_found(|document, _, drawing| FoundSources {
            guides: document.guide_lines(drawing),
            ink: document.ink_of(drawing, &ink),
            ..drawing.found.clone()
        });
        guided.with_found(|document, layer, drawing| FoundSources {
            tone: document.tone_picture(layer, drawing),
            colors: document.color_picture(layer, drawing),
            ..drawing.found.clone()
        })
    }

    /// With what is found for each drawing, the lowest first: those above it see it.
    fn with_found(
        &self,
        find: impl Fn(&Document, &Arc<Layer>, &FormDrawing) -> FoundSources,
    ) -> Document {
        let ids: Vec<LayerId> = self.reading_drawings().iter().map(|(layer, _)| layer.id).collect();
        ids.into_iter().fold(self.clone(), |next, id| {
            let Some(layer) = next.layer(id).cloned() else { return next };
            let Content::FormDrawing(live) = &layer.content else { return next };
            let found = find(&next, &layer, live.params());
            if found.is_same(&live.params().found) {
                return next;
            }
            // What shows the same need not be drawn again.
            let is_alike = found.is_alike(&live.params().found);
            let drawing = FormDrawing { found, ..live.params().clone() };
            let content = Content::FormDrawing(live.with(drawing, |_| is_alike));
            next.with_layer(id, |layer| layer.content = content).unwrap_or(next)
        })
    }

    /// Drawings by the form that read other layers, or did.
    fn reading_drawings(&self) -> Vec<(Arc<Layer>, FormDrawing)> {
        let reads = |layer: &Arc<Layer>| match &layer.content {
            Content::FormDrawing(live) => {
                let drawing = live.params();
                let is_reading = match &drawing.pattern {
                    FormPattern::Lines(lines) => {
                        lines.skip_ink
                            || lines.kinds.has_kind(LineKind::Color)
                            || !drawing.sources.redrawn.is_empty()
                    }
                    FormPattern::Hatching(hatch) => {
                        hatch.way == HatchWay::Guides || hatch.tone != HatchTone::Light
                    }
                };
                let has_read = !drawing.found.is_same(&FoundSources::default());
                (is_reading || has_read).then(|| (layer.clone(), drawing.clone()))
            }
            _ => None,
        };
        self.walk().into_iter().filter_map(|(_, layer)| reads(layer)).collect()
    }

    /// What the ink layers show that are visible.
    fn ink_on_canvas(&self) -> InkOnCanvas {
        fn add(layers: &[Arc<Layer>], all: &mut Vec<TileGrid>) {
            for layer in layers.iter().filter(|layer| layer.visible) {
                match &layer.content {
                    Content::Ink(lines) => {
                        all.extend(lines.shown.iter().map(|shown| shown.tiles.clone()))
                    }
                    Content::Group(group) => add(&group.layers, all),
                    _ => {}
                }
            }
        }
        let mut all = Vec::new();
        add(&self.layers, &mut all);
        InkOnCanvas::of(all)
    }

    /// The ink that a drawing leaves out, and the strokes in the place of its lines.
    fn ink_of(&self, drawing: &FormDrawing, ink: &InkOnCanvas) -> InkOnCanvas {
        match &drawing.pattern {
            FormPattern::Lines(lines) => {
                let ink = if lines.skip_ink { ink.clone() } else { InkOnCanvas::default() };
                ink.with_strokes(self.strokes_of(&drawing.sources.redrawn))
            }
            FormPattern::Hatching(_) => InkOnCanvas::default(),
        }
    }

    fn guide_lines(&self, drawing: &FormDrawing) -> GuideLines {
        let is_guided = drawing.hatching().is_some_and(|hatch| hatch.way == HatchWay::Guides);
        if is_guided { self.strokes_of(&drawing.sources.guides) } else { GuideLines::none() }
    }

    /// The strokes of the layer of a name, where they show.
    fn strokes_of(&self, name: &str) -> GuideLines {
        let Some(layer) = self.layer_named(name).filter(|_| !name.is_empty()) else {
            return GuideLines::none();
        };
        let strokes = self.strokes_on_canvas(layer.id);
        GuideLines::of(strokes.iter().map(|stroke| sparse_points(stroke)))
    }

    /// The layer whose tone a hatching has: none that has the tone of another itself.
    fn tone_layer(&self, drawing: &FormDrawing) -> Option<&Arc<Layer>> {
        self.layer_named(&drawing.sources.tone).filter(|layer| !has_read_tone(layer))
    }

    /// What the tone of a hatching follows from; `None` if it has a light of its own.
    fn tone_layers(&self, layer: &Layer, drawing: &FormDrawing) -> Option<ReadLayers> {
        match drawing.hatching()?.tone {
            HatchTone::Light => None,
            HatchTone::Beneath => Some(self.read_layers(&all_beneath(&self.layers, layer.id)?)),
            HatchTone::Layer => Some(self.read_layers(&[self.tone_layer(drawing)?.clone()])),
        }
    }

    /// What edges of color follow from; `None` if they are not wanted.
    fn color_layers(&self, layer: &Layer, drawing: &FormDrawing) -> Option<ReadLayers> {
        match &drawing.pattern {
            FormPattern::Lines(lines) if lines.kinds.has_kind(LineKind::Color) => {
                Some(self.read_layers(&all_beneath(&self.layers, layer.id)?))
            }
            _ => None,
        }
    }

    /// Layers that are read, bottom first, and the surface that they lie on.
    fn read_layers(&self, read: &[Arc<Layer>]) -> ReadLayers {
        let surface = self.surface.iter().map(ToneSource::of);
        ReadLayers::new(self.size, read.iter().map(ToneSource::of).chain(surface).collect())
    }

    /// The picture whose tone a hatching has: the known one while it follows from the same, else
    /// what is found.
    fn tone_picture(&self, layer: &Layer, drawing: &FormDrawing) -> Option<Arc<TonePicture>> {
        let read = self.tone_layers(layer, drawing)?;
        if let Some(known) = drawing.found.tone.as_ref().filter(|known| known.is_of(&read)) {
            return Some(known.clone());
        }
        let picture = match drawing.hatching()?.tone {
            HatchTone::Light => return None,
            HatchTone::Beneath => self.picture_beneath(layer)?,
            HatchTone::Layer => {
                flatten_layer(self, self.tone_layer(drawing)?.id, &Progress::default())?
            }
        };
        Some(Arc::new(TonePicture::of(&picture, read)))
    }

    /// The same for the picture whose edges of color are lines.
    fn color_picture(&self, layer: &Layer, drawing: &FormDrawing) -> Option<Arc<ColorPicture>> {
        let read = self.color_layers(layer, drawing)?;
        if let Some(known) = drawing.found.colors.as_ref().filter(|known| known.is_of(&read)) {
            return Some(known.clone());
        }
        Some(Arc::new(ColorPicture::of(&self.picture_beneath(layer)?, read)))
    }

    /// What the layers beneath one show together.
    fn picture_beneath(&self, layer: &Layer) -> Option<TileGrid> {
        let layers = layers_beneath(&self.layers, layer.id)?;
        flatten(&Document { layers, ..self.clone() }, &Progress::default())
    }

    /// With drawings by the form naming the layers that they read by their present names;
    /// `before`: the document in which a layer had another name.
    pub(super) fn with_form_sources_renamed(self, before: &Document, id: LayerId) -> Document {
        let names = before.layer(id).zip(self.layer(id)).map(|(old, new)| (&old.name, &new.name));
        let Some((old, new)) = names.filter(|(old, new)| old != new) else { return self };
        if before.layer_named(old).is_none_or(|layer| layer.id != id) {
            return self;
        }
        let renamed = |name: &String| if name == old { new.clone() } else { name.clone() };
        let reading = self.walk().into_iter().filter_map(|(_, layer)| match &layer.content {
            Content::FormDrawing(live) => {
                let DrawingSources { guides, redrawn, tone } = &live.params().sources;
                let reads = !old.is_empty() && [guides, redrawn, tone].contains(&old);
                let [guides, redrawn, tone] = [guides, redrawn, tone].map(renamed);
                let sources = DrawingSources { guides, redrawn, tone };
                reads.then(|| (layer.id, FormDrawing { sources, ..live.params().clone() }))
            }
            _ => None,
        });
        let reading: Vec<(LayerId, FormDrawing)> = reading.collect();
        reading.into_iter().fold(self.clone(), |next, (id, drawing)| {
            let content = Content::FormDrawing(Live::new(drawing));
            next.with_layer(id, |layer| layer.content = content).unwrap_or(next)
        })
    }
}

/// The layers beneath one in its list and around it: groups that hold it show only what lies
/// beneath it. `None` without it.
fn layers_beneath(layers: &[Arc<Layer>], id: LayerId) -> Option<Vec<Arc<Layer>>> {
    for (i, layer) in layers.iter().enumerate() {
        if layer.id == id {
            return Some(layers[..i].to_vec());
        }
        let inner = layer.content.group().and_then(|group| layers_beneath(&group.layers, id));
        if let Some(inner) = inner {
            let mut beneath = layers[..i].to_vec();
            let group = Group { layers: inner, pass_through: true };
            let around = Layer::new(layer.name.clone(), Content::Group(group));
            beneath.push(Arc::new(around));
            return Some(beneath);
        }
    }
    None
}

/// The same layers one after the other, without the groups around it.
fn all_beneath(layers: &[Arc<Layer>], id: LayerId) -> Option<Vec<Arc<Layer>>> {
    layers.iter().enumerate().find_map(|(i, layer)| {
        let inner = if layer.id == id {
            Vec::new()
        } else {
            all_beneath(&layer.content.group()?.layers, id)?
        };
        Some(layers[..i].iter().cloned().chain(inner).collect())
    })
}

/// Whether a layer shows hatching that has the tone of a picture.
fn has_read_tone(layer: &Arc<Layer>) -> bool {
    match &layer.content {
        Content::FormDrawing(live) => {
            live.params().hatching().is_some_and(|hatch| hatch.tone != HatchTone::Light)
        }
        Content::Group(group) => group.layers.iter().any(has_read_tone),
        _ => false,
    }
}

/// The points of a stroke, so far apart that its hand does not tremble.
fn sparse_points(stroke: &Stroke) -> Vec<Vec2> {
    let mut points: Vec<Vec2> = Vec::new();
    let samples = stroke.samples();
    for (i, sample) in samples.iter().enumerate() {
        let is_far = points.last().is_none_or(|last| last.distance(sample.at) >= EVERY_PX);
        if is_far || i + 1 == samples.len() {
            points.push(sample.at);
        }
    }
    points
}

#[cfg(test)]
mod tests;
