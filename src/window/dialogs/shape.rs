//! Gives a drawing its first shape: one part, or one per color or place, as a pillow, tube, relief
//! or coin. Floor 7. Not here: what becomes of it (`session::actions::parts::first`).

use super::{DialogAnswer, answers, set_width};
use crate::document::parts::drawing::{DrawingTraits, FigureBackground};
use crate::document::parts::from_flats::PartFor;
use crate::document::{Content, Document, Inflation, Layer, LayerId};
use crate::io::svg;
use crate::language::tr;
use crate::panels::shape::presets;
use crate::requests::UiRequests;
use crate::session::actions::parts::{InflationPreset, PartAction};
use crate::session::{Action, LayerPath, OpenDocument, Session, drawing};
use crate::tr;
use crate::widgets::radio;
use eframe::egui::Ui;
use std::path::PathBuf;
use std::sync::Arc;

/// How many layers are searched for a drawing.
const MOST_LOOKS: usize = 12;

pub struct ShapeDialog {
    /// The open document, by its key.
    key: usize,
    /// Its drawing, if it has one.
    layer: Option<LayerId>,
    traits: DrawingTraits,
    preset: Inflation,
    each: PartFor,
    /// The document was opened just now, from a picture.
    is_first: bool,
    /// Of an SVG: each of its filled paths becomes a part.
    paths: Option<PathsChoice>,
}

/// The choice to take the paths of an SVG.
#[derive(Clone, Default)]
struct PathsChoice {
    is_on: bool,
    /// The file of the layer, if the layer does not hold it.
    file: Option<PathBuf>,
}

/// The drawing of a document: the selected layer, or the topmost that has an outline. Takes long on
/// large canvases.
pub fn find_drawing(
    document: &Document,
    selected: Option<LayerId>,
) -> Option<(LayerId, DrawingTraits)> {
    let others = document.walk().into_iter().rev().map(|(_, layer)| layer);
    let others =
        others.filter(|layer| layer.visible && layer.content.has_pixels()).map(|layer| layer.id);
    let mut first = None;
    for id in selected.into_iter().chain(others).take(MOST_LOOKS) {
        let Some(traits) = drawing::traits_of(document, id) else { continue };
        if traits.has_outline() {
            return Some((id, traits));
        }
        first.get_or_insert((id, traits));
    }
    first
}

impl ShapeDialog {
    /// For a document that was opened from a picture, whose only layer is the drawing.
    ///
    /// * `file`: the SVG that it is, if it is one; its paths are offered first.
    pub fn of_picture(open: &OpenDocument, traits: DrawingTraits, file: Option<PathBuf>) -> Self {
        let layer = open.document().layers.last().map(|layer| layer.id);
        let new = Self::new(open, layer, traits);
        let of_file = file.map(|file| PathsChoice { is_on: true, file: Some(file) });
        Self { is_first: true, paths: of_file.or_else(|| new.paths.clone()), ..new }
    }

    /// For the drawing that was found in a document.
    pub fn of(open: &OpenDocument, found: Option<(LayerId, DrawingTraits)>) -> Self {
        match found {
            Some((id, traits)) => Self::new(open, Some(id), traits),
            None => Self::new(
                open,
                None,
                DrawingTraits { background: FigureBackground::Empty, colors: 0, flat_share: 0.0 },
            ),
        }
    }

    fn new(open: &OpenDocument, layer: Option<LayerId>, traits: DrawingTraits) -> Self {
        let preset = Inflation::PRESETS[0].0;
        let each = if traits.is_of_flats() { PartFor::Color } else { PartFor::Layer };
        let is_svg = layer.and_then(|id| open.document().layer(id)).is_some_and(has_svg);
        let paths = is_svg.then(PathsChoice::default);
        Self { key: open.key, layer, traits, preset, each, is_first: false, paths }
    }

    pub fn show(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        requests: &mut UiRequests,
    ) -> DialogAnswer {
        set_width(ui, 380.0);
        let open = session.open_documents.iter().position(|open| open.key == self.key);
        let Some((index, open)) = open.map(|index| (index, &session.open_documents[index])) else {
            return DialogAnswer::Close;
        };
        ui.heading(tr(if self.is_first {
            "A drawing without a shape"
        } else {
            "A shape for this drawing"
        }));
        if let Some(why) = self.refusal() {
            ui.label(tr(why));
            return super::close(ui);
        }
        ui.label(
            tr("With a shape, light falls on the drawing, and strokes, gradients and photos bend over it. Every number \
             can be changed later, in the panel Shape."),
        );
        if let Some(paths) = &mut self.paths {
            let hint =
                "Exact outlines from the file, also beneath other paths; the paths stay paths";
            let text = "A part for each path of the file";
            radio(ui, &mut paths.is_on, true, text).on_hover_text(tr(hint));
            radio(ui, &mut paths.is_on, false, "Parts by what is seen");
        }
        let reads_paths = self.paths.as_ref().is_some_and(|paths| paths.is_on);
        ui.add_enabled_ui(!reads_paths, |ui| self.show_seen(ui));
        self.preset = presets(ui, self.preset).unwrap_or(self.preset);
        if matches!(self.traits.background, FigureBackground::Flat(_)) && !reads_paths {
            ui.weak(tr("Its one-colored background becomes a separate layer below."));
        }
        let no = if self.is_first { "Only paint" } else { "Cancel" };
        match answers(ui, "Give it a shape", no, true) {
            Some(true) => {
                self.ask(index, open.document(), requests);
                DialogAnswer::Shaped
            }
            Some(false) => DialogAnswer::Close,
            None => DialogAnswer::Open,
        }
    }

    /// What of the pixels becomes parts.
    fn show_seen(&mut self, ui: &mut Ui) {
        radio(ui, &mut self.each, PartFor::Layer, "One part");
        let text = match self.traits.colors {
            0 | 1 => "A part for each color".to_owned(),
            n => tr!("A part for each color ({count})", count = n),
        };
        ui.add_enabled_ui(self.traits.colors > 1, |ui| {
            radio(ui, &mut self.each, PartFor::Color, text)
        });
        ui.add_enabled_ui(self.traits.colors > 0, |ui| {
            let hint = "Separate areas of one color, such as two eyes, become separate parts";
            radio(ui, &mut self.each, PartFor::Area, "A part for each area")
                .on_hover_text(tr(hint));
        });
    }

    /// Why there is nothing to give a shape to.
    fn refusal(&self) -> Option<&'static str> {
        match self.traits.background {
            _ if self.layer.is_some() && self.paths.is_some() => None,
            FigureBackground::Transparent | FigureBackground::Flat(_) if self.layer.is_some() => {
                None
            }
            FigureBackground::Painted => Some(
                "No layer has an outline: this one is opaque all over, and its background has many colors. Select the \
                 figure (W or L), then Layer, New part, Puff up selection.",
            ),
            _ => Some(
                "There is no drawing yet. A shape is made from what a layer covers: paint a figure \
                 on a layer without a background, or begin with a body (Layer, New part, Sphere).",
            ),
        }
    }

    fn ask(&self, index: usize, document: &Document, requests: &mut UiRequests) {
        let Some(layer) = self.layer.and_then(|layer| LayerPath::of(document, layer)) else {
            return;
        };
        requests.act(Action::File(crate::session::actions::FileAction::Show { index }));
        let (preset, flats) = (InflationPreset(self.preset), self.each);
        requests.act(Action::Part(match self.paths.clone().filter(|paths| paths.is_on) {
            Some(PathsChoice { file, .. }) => PartAction::ShapePaths { layer, file, preset },
            None => PartAction::Shape { layer, preset, flats },
        }));
    }
}

/// Whether a layer holds an SVG that is no text.
fn has_svg(layer: &Arc<Layer>) -> bool {
    let Content::Image(live) = &layer.content else { return false };
    let source = &live.params().source;
    let is_file = source.path().is_none() && source.text().is_none();
    is_file && source.picture.encoded.as_ref().is_some_and(|held| svg::is_svg(held.bytes()))
}
