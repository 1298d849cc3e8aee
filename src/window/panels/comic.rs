//! Panels of comics: the options of their tool, in a bar, and the numbers of a page. Floor 7. Not
//! here: the dialog (`dialogs::panels`).

use super::colors;
use crate::language::tr;
use crate::paint::{PanelDrag, PanelSettings};
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::PanelAction;
use crate::session::{Action, Session};
use crate::widgets::{NumberField, check, choice, more};
use eframe::egui::Ui;

/// The widest gap that bars offer, px; wider ones can be typed.
const WIDE_PX: f32 = 200.0;

/// The options of the panel tool, in a bar.
pub fn options(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let mut settings = session.tools.panels;
    let was = settings;
    let drag = choice(ui, "What a drag does", settings.drag, &PANEL_DRAGS);
    settings.drag = drag.unwrap_or(settings.drag);
    let shown = match settings.drag {
        PanelDrag::Cut => &["gutter_across", "gutter_down"][..],
        PanelDrag::Draw => &["border"][..],
    };
    show_numbers(&mut settings, shown, |field, value| field.inline(ui, value, 70.0).map(|c| c.to));
    if settings.drag == PanelDrag::Draw {
        more(ui, |ui| show_look(ui, &mut settings));
    }
    if settings != was {
        requests.act(Action::Panel(PanelAction::Settings { panels: settings }));
    }
    let hint = "Divides the page, the selection or the selected path in panels";
    if ui.button(tr("Panels…")).on_hover_text(tr(hint)).clicked() {
        requests.request(WindowRequest::PanelsDialog);
    }
    ui.weak(tr(session.tool.hint()));
}

/// The choices of a drag, with their names.
const PANEL_DRAGS: [(PanelDrag, &str); 2] =
    [(PanelDrag::Cut, "Cuts panels"), (PanelDrag::Draw, "Draws panels")];

/// Some numbers of settings, by their names.
pub fn show_numbers(
    settings: &mut PanelSettings,
    names: &[&str],
    mut show: impl FnMut(NumberField<'static>, f32) -> Option<f32>,
) {
    for setting in PanelSettings::SETTINGS.iter().filter(|s| names.contains(&s.name)) {
        let least = *setting.range.start();
        let field = match setting.is_length {
            true => NumberField::new(setting.label, least..=WIDE_PX, setting.hint).pixels(),
            false => {
                NumberField::new(setting.label, setting.range.clone(), setting.hint).decimals(0)
            }
        };
        if let Some(to) = show(field, (setting.get)(settings)) {
            setting.put(settings, to);
        }
    }
}

/// What new panels look like, besides numbers, and how they are read.
pub fn show_look(ui: &mut Ui, settings: &mut PanelSettings) {
    ui.horizontal(|ui| {
        let changed = colors::button(ui, "Border color", settings.border_color);
        settings.border_color = changed.map_or(settings.border_color, |changed| changed.to);
        ui.label(tr("Border color"));
    });
    ui.horizontal(|ui| {
        let hint = "A color at the bottom of each panel";
        settings.paper = check(ui, "Paper", hint, settings.paper).unwrap_or(settings.paper);
        if settings.paper {
            let changed = colors::button(ui, "Paper color", settings.paper_color);
            settings.paper_color = changed.map_or(settings.paper_color, |changed| changed.to);
        }
    });
    let hint = "Panels are numbered from right to left, as in manga";
    let checked = check(ui, "Right to left", hint, settings.right_to_left);
    settings.right_to_left = checked.unwrap_or(settings.right_to_left);
}
