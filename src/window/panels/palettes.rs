//! Palettes: which one is shown, its colors to choose from, to put in order and to name, and files
//! of other programs. Floor 7.

use crate::file_purpose::FilePurpose;
use crate::icons::{BUTTON_PT, Icon, icon_button};
use crate::io::palette::PaletteFormat;
use crate::language::tr;
use crate::paint::ColorPalette;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::{HandAction, PaletteAction};
use crate::session::{Action, Session};
use crate::theme::ACCENT;
use crate::tr;
use crate::widgets::{NumberField, draw_swatch, set_accessible_name};
use eframe::egui::{
    self, Button, ComboBox, Id, Pos2, Rect, Response, Sense, Stroke, StrokeKind, TextEdit, Ui, vec2,
};

/// The side of a color, and the gap between two, points.
const SIDE_PT: f32 = 19.0;
const GAP_PT: f32 = 2.0;
/// How many colors can be taken from the picture at once.
const COUNTS: [u32; 5] = [4, 8, 16, 32, 64];
/// What the palette of the document is called in lists.
const OF_DOCUMENT: &str = "This document";

pub fn show(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let shown = session.palettes.shown.clone();
    head(ui, session, shown.as_deref(), requests);
    let Some(palette) = session.shown_palette() else {
        ui.weak(tr("No document is open."));
        return;
    };
    let is_fixed = shown.as_deref().is_some_and(|name| session.palettes.is_fixed(name));
    if palette.colors.is_empty() {
        ui.weak(tr("It has no colors yet."));
    } else {
        let view = PaletteView { session, palette, shown: shown.as_deref(), is_fixed };
        view.colors(ui, requests);
    }
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        let add = ui.add_enabled(!is_fixed, Button::new(tr("Add color")));
        if add.on_hover_text(tr("Adds the current color at the end")).clicked() {
            let (color, name) = (session.tools.color, String::new());
            act(requests, PaletteAction::Add { palette: shown.clone(), color, name, index: None });
        }
        let has_document = session.active().is_some();
        ui.add_enabled_ui(!is_fixed && has_document, |ui| {
            ui.menu_button(tr("From the picture"), |ui| {
                for count in COUNTS {
                    if ui.button(tr!("{count} colors", count)).clicked() {
                        let palette = shown.clone();
                        act(requests, PaletteAction::FromPicture { palette, count });
                        ui.close();
                    }
                }
            });
        });
    });
}

fn act(requests: &mut UiRequests, action: PaletteAction) {
    requests.act(Action::Palette(action));
}

/// Which palette is shown, and the menu of what is done with a whole one.
fn head(ui: &mut Ui, session: &Session, shown: Option<&str>, requests: &mut UiRequests) {
    ui.horizontal(|ui| {
        let width = ui.available_width() - BUTTON_PT - 8.0;
        let list = ComboBox::from_id_salt("palette").width(width).truncate();
        // The program's own palette has a name in every language.
        let name_of = |name| if session.palettes.is_fixed(name) { tr(name) } else { name };
        let list = list.selected_text(shown.map_or(tr(OF_DOCUMENT), name_of));
        let list = list.show_ui(ui, |ui| {
            if ui.selectable_label(shown.is_none(), tr(OF_DOCUMENT)).clicked() {
                act(requests, PaletteAction::Show { palette: None });
            }
            for name in session.palettes.names() {
                if ui.selectable_label(shown == Some(name), name_of(name)).clicked() {
                    act(requests, PaletteAction::Show { palette: Some(name.into()) });
                }
            }
        });
        set_accessible_name(&list.response, tr("Palette shown"));
        let dots = icon_button(ui, Icon::Dots, "Palette menu", false)
            .on_hover_text(tr("New, name, copies, files of other programs"));
        let stays = egui::PopupCloseBehavior::CloseOnClickOutside;
        egui::Popup::menu(&dots)
            .close_behavior(stays)
            .show(|ui| menu(ui, session, shown, requests));
    });
}

fn menu(ui: &mut Ui, session: &Session, shown: Option<&str>, requests: &mut UiRequests) {
    let mut entry = |ui: &mut Ui, label: &str, is_on: bool, action: PaletteAction| {
        if ui.add_enabled(is_on, Button::new(tr(label))).clicked() {
            act(requests, action);
            ui.close();
        }
    };
    let is_fixed = shown.is_some_and(|name| session.palettes.is_fixed(name));
    let (palette, has_document) = (shown.map(str::to_owned), session.active().is_some());
    let named = session.shown_palette().map_or("", |palette| palette.name.as_str());
    entry(ui, "New palette", true, PaletteAction::New { name: "Palette".into() });
    let to = Some(named.to_owned());
    let copy = PaletteAction::Copy { palette: palette.clone(), to };
    entry(ui, "Copy to my palettes", session.shown_palette().is_some(), copy);
    let copy = PaletteAction::Copy { palette: palette.clone(), to: None };
    entry(ui, "Copy to this document", has_document && shown.is_some(), copy);
    let delete = PaletteAction::Delete { palette: palette.clone() };
    let is_there = session.shown_palette().is_some_and(|palette| !palette.is_blank());
    entry(ui, "Delete palette", !is_fixed && is_there, delete);
    ui.separator();
    if ui.button(tr("Import…")).clicked() {
        requests.request(WindowRequest::Choose(FilePurpose::Palette));
        ui.close();
    }
    ui.add_enabled_ui(session.shown_palette().is_some(), |ui| {
        ui.menu_button(tr("Export"), |ui| {
            for (format, label) in PaletteFormat::LABELS {
                if ui.button(format!("{}…", tr(label))).clicked() {
                    requests.request(WindowRequest::ExportPalette(format));
                    ui.close();
                }
            }
        });
    });
    ui.separator();
    ui.add_enabled_ui(!is_fixed && session.shown_palette().is_some(), |ui| {
        if let Some(name) = name_field(ui, "Name of the palette", named) {
            act(requests, PaletteAction::Rename { palette: palette.clone(), name });
        }
        let columns = session.shown_palette().map_or(0, |palette| palette.columns);
        let hint = "Colors in a row; 0 is as many as there is room for";
        let field = NumberField::new("Columns", 0.0..=ColorPalette::MOST_COLUMNS as f32, hint);
        if let Some(changed) = field.decimals(0).row(ui, columns as f32)
            && changed.done
        {
            act(requests, PaletteAction::Columns { palette, to: changed.to as u32 });
        }
    });
}

/// A text that is taken when its field is left.
fn name_field(ui: &mut Ui, label: &str, current: &str) -> Option<String> {
    let id = ui.scope_id().with(label);
    let known = ui.data(|data| data.get_temp::<String>(id));
    let mut text = known.unwrap_or_else(|| current.to_owned());
    let field = TextEdit::singleline(&mut text).hint_text(tr("Name")).desired_width(170.0);
    let response = ui.add(field.char_limit(ColorPalette::LONGEST_NAME));
    set_accessible_name(&response, tr(label));
    if response.has_focus() {
        ui.data_mut(|data| data.insert_temp(id, text));
        return None;
    }
    ui.data_mut(|data| data.remove::<String>(id));
    (response.lost_focus() && text != current).then_some(text)
}

/// The color that is dragged, by its place.
struct HeldColor(usize);

/// The colors of the palette that is shown.
struct PaletteView<'a> {
    session: &'a Session,
    palette: &'a ColorPalette,
    shown: Option<&'a str>,
    is_fixed: bool,
}

impl PaletteView<'_> {
    /// In rows; only those in sight are made.
    fn colors(&self, ui: &mut Ui, requests: &mut UiRequests) {
        let step = SIDE_PT + GAP_PT;
        let room = ((ui.available_width() + GAP_PT) / step).max(1.0) as usize;
        let columns = match self.palette.columns {
            0 => room,
            columns => (columns as usize).min(room),
        };
        let count = self.palette.colors.len();
        let size = vec2(columns as f32 * step, count.div_ceil(columns) as f32 * step);
        let (area, _) = ui.allocate_exact_size(size, Sense::hover());
        let seen = ui.clip_rect().intersect(area);
        if !seen.is_positive() {
            return;
        }
        let row_at = |y: f32| ((y - area.top()) / step).max(0.0) as usize;
        let first = row_at(seen.top()) * columns;
        let end = ((row_at(seen.bottom()) + 1) * columns).min(count);
        for i in first..end {
            let at = vec2((i % columns) as f32, (i / columns) as f32) * step;
            let rect = Rect::from_min_size(area.min + at, vec2(SIDE_PT, SIDE_PT));
            self.color(ui, i, rect, requests);
        }
    }

    /// One color: a click takes it, a drag moves it, a right click changes it.
    fn color(&self, ui: &Ui, i: usize, rect: Rect, requests: &mut UiRequests) {
        let named = &self.palette.colors[i];
        let label = match named.name.as_str() {
            "" => tr!("Palette color {number}", number = i + 1),
            name => tr!("Palette color {number}, {name}", number = i + 1, name),
        };
        let sense = if self.is_fixed { Sense::click() } else { Sense::click_and_drag() };
        let response = ui.interact(rect, ui.scope_id().with(("palette color", i)), sense);
        let response = draw_swatch(ui, &label, named.color, rect, response);
        if self.session.tools.color == named.color {
            ui.painter().rect_stroke(rect, 3.0, Stroke::new(2.0, ACCENT), StrokeKind::Inside);
        }
        if response.clicked() {
            requests.act(Action::Hand(HandAction::Color { color: named.color }));
        }
        if !self.is_fixed {
            self.drag(ui, i, &response, rect, requests);
            response.context_menu(|ui| self.color_menu(ui, i, requests));
        }
    }

    /// A dragged color, and the line where it would be dropped.
    fn drag(&self, ui: &Ui, i: usize, response: &Response, rect: Rect, requests: &mut UiRequests) {
        response.dnd_set_drag_payload(HeldColor(i));
        let is_before = |pointer: Pos2| pointer.x < rect.center().x;
        if response.dnd_hover_payload::<HeldColor>().is_some_and(|held| held.0 != i)
            && let Some(pointer) = ui.input(|input| input.pointer.hover_pos())
        {
            let x = if is_before(pointer) { rect.left() - 1.0 } else { rect.right() + 1.0 };
            ui.painter().vline(x, rect.y_range(), Stroke::new(2.0, ACCENT));
        }
        let held = response.dnd_release_payload::<HeldColor>();
        let pointer = ui.input(|input| input.pointer.interact_pos());
        let (Some(held), Some(pointer)) = (held, pointer) else { return };
        let before = if is_before(pointer) { i } else { i + 1 };
        // Once it is taken out, those behind it are one place further ahead.
        let to = if held.0 < before { before - 1 } else { before };
        if to != held.0 {
            let palette = self.shown.map(str::to_owned);
            act(requests, PaletteAction::Move { palette, index: held.0, to });
        }
    }

    fn color_menu(&self, ui: &mut Ui, index: usize, requests: &mut UiRequests) {
        let palette = || self.shown.map(str::to_owned);
        let named = &self.palette.colors[index];
        ui.push_id(Id::unique(("palette color menu", index)), |ui| {
            if let Some(name) = name_field(ui, "Name of the color", &named.name) {
                act(requests, PaletteAction::Name { palette: palette(), index, name });
            }
        });
        if ui.button(tr("Replace with the current color")).clicked() {
            let color = self.session.tools.color;
            act(requests, PaletteAction::Recolor { palette: palette(), index, color });
            ui.close();
        }
        if ui.button(tr("Remove")).clicked() {
            act(requests, PaletteAction::Remove { palette: palette(), index });
            ui.close();
        }
    }
}
