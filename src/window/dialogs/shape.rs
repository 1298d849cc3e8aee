//! Gives a drawing its first shape: one part, or one per color or place, as a pillow, tube, relief
//! or coin. Floor 7. Not here: what becomes of it (`session::actions::parts::first`).

use super::{DialogAnswer, answers, set_width};
use crate::document::parts::drawing::{DrawingTraits, FigureBackground};
use crate::document::parts::from_flats::PartFor;
use crate::document::{Document, Inflation, LayerId};
use crate::panels::shape::presets;
use crate::requests::UiRequests;
use crate::session::actions::parts::{InflationPreset, PartAction};
use crate::session::{Action, LayerPath, OpenDocument, Session, drawing};
use crate::widgets::radio;
use eframe::egui::Ui;

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
    pub fn of_picture(open: &OpenDocument, traits: DrawingTraits) -> Self {
        let layer = open.document().layers.last().map(|layer| layer.id);
        Self { is_first: true, ..Self::new(open, layer, traits) }
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
        Self { key: open.key, layer, traits, preset, each, is_first: false }
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
        ui.heading(if self.is_first {
            "A drawing without a shape"
        } else {
            "A shape for this drawing"
        });
        if let Some(why) = self.refusal() {
            ui.label(why);
            return super::close(ui);
        }
        ui.label(
            "With a shape, light falls on the drawing, and strokes, gradients and photos bend over it. Every number \
             can be changed later, in the panel Shape.",
        );
        radio(ui, &mut self.each, PartFor::Layer, "One part");
        let text = match self.traits.colors {
            0 | 1 => "A part for each color".to_owned(),
            n => format!("A part for each color ({n})"),
        };
        ui.add_enabled_ui(self.traits.colors > 1, |ui| {
            radio(ui, &mut self.each, PartFor::Color, text)
        });
        ui.add_enabled_ui(self.traits.colors > 0, |ui| {
            let hint = "Separate areas of one color, such as two eyes, become separate parts";
            radio(ui, &mut self.each, PartFor::Area, "A part for each area").on_hover_text(hint);
        });
        self.preset = presets(ui, self.preset).unwrap_or(self.preset);
        if matches!(self.traits.background, FigureBackground::Flat(_)) {
            ui.weak("Its one-colored background becomes a separate layer below.");
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

    /// Why there is nothing to give a shape to.
    fn refusal(&self) -> Option<&'static str> {
        match self.traits.background {
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
        requests.act(Action::Part(PartAction::Shape { layer, preset, flats }));
    }
}
