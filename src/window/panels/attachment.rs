//! What a layer or its strokes lie on: the canvas, or a part of the shape that carries them.
//! Floor 7.

use crate::document::{Attachment, Document};
use crate::language::tr;
use crate::widgets::{name, sentence, set_accessible_name};
use eframe::egui::{ComboBox, Ui};

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
    let mut choices: Vec<(Option<&str>, String)> = vec![(None, tr(around).to_owned())];
    if around != CANVAS {
        choices.push((Some(Attachment::CANVAS), tr(CANVAS).to_owned()));
    }
    choices.extend(forms.map(|part| (Some(part.id.as_str()), sentence(&part.name))));
    if choices.len() < 2 && own.is_none() {
        return None;
    }
    let now = own
        .map(|attachment| &*attachment.part)
        .filter(|part| around != CANVAS || *part != Attachment::CANVAS);
    // What lies on touches or sculpting is carried by the part beneath these.
    let body = now.map(|part| document.parts.body_of(part).map_or(part, |body| body.id.as_str()));
    choose_part(ui, body, &choices).map(|part| part.map(str::to_owned))
}

/// Parts have names that the user gave them: these are shown as they are in every language.
fn choose_part<'a>(
    ui: &mut Ui,
    current: Option<&'a str>,
    choices: &[(Option<&'a str>, String)],
) -> Option<Option<&'a str>> {
    const LABEL: &str = "Attached to";
    ui.horizontal(|ui| {
        name(ui, LABEL);
        ui.spacing_mut().combo_width = ui.available_width();
        let shown = choices.iter().find(|(part, _)| *part == current);
        let shown = shown.map_or("", |(_, word)| word);
        let mut to = current;
        let combo = ComboBox::from_id_salt(LABEL).selected_text(shown).show_ui(ui, |ui| {
            for (part, word) in choices {
                ui.selectable_value(&mut to, *part, word);
            }
        });
        set_accessible_name(&combo.response, tr(LABEL));
        (to != current).then_some(to)
    })
    .inner
}

/// The name of the canvas.
pub const CANVAS: &str = "Canvas";
