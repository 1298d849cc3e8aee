//! What first steps there are: their words, when each is done, and how the program does it for who
//! wants to watch. Floor 7. Not here: how they are shown (`window::steps`).

use crate::Result;
use crate::document::parts::from_flats::PartFor;
use crate::document::{Content, Document, Inflation, Layer, LayerId, PixelLayer};
use crate::io::{Budget, svg};
use crate::math::{Vec2, srgb::Color, vec2};
use crate::paint::Stroke;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::parts::InflationPreset;
use crate::session::actions::{HandAction, LayerAction, PartAction, PointerAction};
use crate::session::{Action, LayerPath, Property, Session};
use crate::shading::{Model, Mood};
use crate::surface::Operator;
use crate::tools::{PenSample, ToolKind};
use std::path::Path;

/// Steps that lead through a first picture.
#[derive(Debug)]
pub struct Tour {
    pub title: &'static str,
    pub steps: &'static [TourStep],
}

/// One of them.
#[derive(Debug)]
pub struct TourStep {
    pub name: &'static str,
    /// How it is done in the window.
    pub how: &'static str,
    pub is_done: fn(&Session) -> bool,
    /// Does it for the user; without it, the user is on their own.
    pub show: Option<fn(&Session, &mut UiRequests)>,
}

/// For a shape from elsewhere.
pub static ON_A_SHAPE: Tour = Tour {
    title: "Three steps",
    steps: &[
        TourStep {
            name: "Drop a photo on the shape",
            how: "It bends over it like a reflection. Or File, Place image…",
            is_done: has_image,
            show: None,
        },
        TourStep {
            name: "Paint highlights",
            how: "Brush (B), Gloss (F3): strokes follow the form",
            is_done: has_bent_stroke,
            show: None,
        },
        TourStep {
            name: "Move what you made",
            how: "Anchors (A) move the photo along the surface, Move (V) a stroke",
            is_done: |session| {
                has_done_any(session, &["Move anchor", "Add anchor", "Move stroke", "Move layer"])
            },
            show: None,
        },
    ],
};

/// From a flat drawing to a finished picture.
pub static FROM_A_DRAWING: Tour = Tour {
    title: "From a drawing to a picture",
    steps: &[
        TourStep {
            name: "Give it a shape",
            how: "Layer, Give it a shape…: each area of color becomes a round part, and its ink stays on top",
            is_done: |session| {
                session.shown_document().is_some_and(|document| document.surface.is_some())
            },
            show: Some(give_shape),
        },
        TourStep {
            name: "Move the light",
            how: "Drag the lamp with the anchors tool (A), or choose a mood in the properties",
            is_done: |session| has_done_any(session, &["Move light", "Lights", "Mood"]),
            show: Some(change_mood),
        },
        TourStep {
            name: "Paint a gloss",
            how: "Brush (B), Gloss (F3): the stroke follows the form, whatever way you draw it",
            is_done: has_bent_stroke,
            show: Some(paint_gloss),
        },
        TourStep {
            name: "Make a part of another material",
            how: "Paint, Materials…: choose one, and click on the hat",
            is_done: |session| has_done_any(session, &["Material"]),
            show: Some(change_material),
        },
        TourStep {
            name: "Try a look",
            how: "Paint, Looks…: the whole picture as an engraving, a comic or in oil; Ctrl Z takes it back",
            is_done: |session| has_done_any(session, &["Look"]),
            show: Some(add_look),
        },
        TourStep {
            name: "Take it with you",
            how: "File, Export… writes a picture; Ctrl S keeps the layers",
            is_done: |session| {
                session.active().is_some_and(|open| open.exported.is_some() || open.file.is_some())
            },
            show: Some(|_, requests| requests.request(WindowRequest::ExportDialog)),
        },
    ],
};

/// Side of the drawing, px, and places on it: on the breast, across the belly, on the hat.
const SIDE: f32 = 640.0;
const GLOSS: [Vec2; 5] = [
    vec2(222.0, 300.0),
    vec2(232.0, 268.0),
    vec2(252.0, 240.0),
    vec2(280.0, 226.0),
    vec2(308.0, 228.0),
];
const HAT: Vec2 = vec2(320.0, 140.0);
const GLOSS_PX: f32 = 44.0;

/// The flat drawing of a robin on white, so many pixels wide and high.
pub fn drawing(side: usize) -> Result<Document> {
    let text = include_str!("tour/robin.svg");
    let text = text.replacen("<svg ", &format!("<svg width=\"{side}\" height=\"{side}\" "), 1);
    let painted =
        svg::decode_paint(Path::new("robin.svg"), text.as_bytes(), 0, 0, &Budget::default())?;
    let pixels = PixelLayer { file: String::new(), x: 0, y: 0, tiles: painted.tiles };
    let layers = vec![Layer::new("Robin", Content::Pixels(pixels)).into()];
    Ok(Document { layers, ..Document::empty(painted.size) })
}

fn has_any(session: &Session, is: impl Fn(&Content) -> bool) -> bool {
    session
        .shown_document()
        .is_some_and(|document| document.walk().iter().any(|(_, layer)| is(&layer.content)))
}

fn has_image(session: &Session) -> bool {
    has_any(session, |content| matches!(content, Content::Image(_)))
}

fn has_bent_stroke(session: &Session) -> bool {
    let is_bent = |stroke: &Stroke| stroke.operator() != Operator::None;
    has_any(session, |content| match content {
        Content::Strokes(live) => live.params().strokes.iter().any(|stroke| is_bent(stroke)),
        _ => false,
    })
}

/// Whether a step of the document in front has one of these names.
fn has_done_any(session: &Session, names: &[&str]) -> bool {
    session.active().is_some_and(|open| open.history.past_names().any(|name| names.contains(&name)))
}

/// The path of the first layer, from the lowest, that is so.
fn find_path(session: &Session, is_it: impl Fn(&Layer) -> bool) -> Option<LayerPath> {
    let document = session.shown_document()?;
    let id: LayerId = document.walk().iter().find(|(_, layer)| is_it(layer))?.1.id;
    LayerPath::of(document, id)
}

fn give_shape(session: &Session, requests: &mut UiRequests) {
    let Some(layer) = find_path(session, |layer| matches!(layer.content, Content::Pixels(_)))
    else {
        return;
    };
    let preset = InflationPreset(Inflation::PRESETS[0].0);
    requests.act(Action::Part(PartAction::Shape { layer, preset, flats: PartFor::Area }));
}

fn change_mood(session: &Session, requests: &mut UiRequests) {
    let is_light = |layer: &Layer| match &layer.content {
        Content::Shading(live) => live.params().model == Model::Painter,
        _ => false,
    };
    if let Some(layer) = find_path(session, is_light) {
        let to = Property::InMood { mood: Mood::Sunset };
        requests.act(Action::Layer(LayerAction::Set { layer: layer.into(), to, done: true }));
    }
}

fn paint_gloss(session: &Session, requests: &mut UiRequests) {
    let Some(document) = session.shown_document() else { return };
    let scale = document.size.width as f32 / SIDE;
    let pens = GLOSS.map(|at| PenSample::at(at * scale));
    let operator = Operator::Normal { alpha: 0.6, beta: 1.0, detail: 0.0 };
    let hand = [
        HandAction::Tool { tool: ToolKind::Brush },
        HandAction::Preset { name: "highlight-gloss".into() },
        HandAction::Size { to: GLOSS_PX * scale },
        HandAction::Color { color: Color { r: 255, g: 246, b: 226, a: 255 } },
        HandAction::Operator { operator },
    ];
    requests.actions.extend(hand.map(Action::Hand));
    let press = PointerAction::Press { tool: ToolKind::Brush, pen: pens[0], px_per_pt: 1.0 };
    let drag = PointerAction::Drag { pens: pens[1..].to_vec() };
    requests.actions.extend([press, drag, PointerAction::Release {}].map(Action::Pointer));
}

fn change_material(session: &Session, requests: &mut UiRequests) {
    let Some(document) = session.shown_document() else { return };
    let hat = document.part_at(HAT * (document.size.width as f32 / SIDE));
    let part = hat.map(|part| part.id.clone());
    let name = "gold".into();
    requests.act(Action::Layer(LayerAction::Material { name, part, done: true }));
}

fn add_look(_: &Session, requests: &mut UiRequests) {
    requests.act(Action::Layer(LayerAction::Look { name: "engraving".into() }));
}
