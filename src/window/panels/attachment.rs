//! What a layer or its strokes lie on: the canvas, or a part of the shape that carries them.
//! Floor 7.

use crate::document::{Attachment, Document};
use crate::widgets::choice_row;
use eframe::egui::Ui;

/// A row with the parts to choose from, if there are any; returns what was chosen, `None` for what
/// is around.
///
/// * `own`: its own attachment.
/// * `around`: the name of the choice of none.
pub fn choice(
    ui: &mut Ui,
    document: &Document,
    own: Option<&Attachment>,
    around: &str,
) -> Option<Option<String>> {
    let forms = document.parts.list.iter().filter(|part| part.on().is_none());
    let mut choices: Vec<(Option<&str>, &str)> = vec![(None, around)];
    if around != CANVAS {
        choices.push((Some(Attachment::CANVAS), CANVAS));
    }
    choices.extend(forms.map(|part| (Some(part.id.as_str()), part.name.as_str())));
    if choices.len() < 2 && own.is_none() {
        return None;
    }
    let now = own
        .map(|attachment| &*attachment.part)
        .filter(|part| around != CANVAS || *part != Attachment::CANVAS);
    // What lies on touches or sculpting is carried by the part beneath these.
    let body = now.map(|part| document.parts.body_of(part).map_or(part, |body| body.id.as_str()));
    choice_row(ui, "Attached to", body, &choices).map(|part| part.map(str::to_owned))
}

/// The name of the canvas.
pub const CANVAS: &str = "Canvas";
