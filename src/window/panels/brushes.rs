//! The brushes: presets in groups, each with a picture of its stroke on a ball, and the sliders of
//! the current one. Floor 7.

use super::brush;
use super::words::{preset_about, preset_name};
use crate::brush_shelf::BrushShelf;
use crate::file_purpose::FilePurpose;
use crate::icons::{BUTTON_PT, Icon, icon_button};
use crate::io::recipe::{BrushPreset, PresetGroup};
use crate::language::tr;
use crate::paint::{Brush, Property};
use crate::requests::{UiRequests, WindowRequest};
use crate::session::actions::{FileAction, HandAction};
use crate::session::brushes::is_found;
use crate::session::{Action, Session};
use crate::swatches::Swatches;
use crate::theme::ACCENT;
use crate::tr;
use crate::widgets::{NumberField, segment, segments, set_accessible_name, title};
use eframe::egui::text::{LayoutJob, TextWrapping};
use eframe::egui::{
    self, Align, Color32, Id, Rect, Response, Sense, StrokeKind, TextEdit, Ui, pos2, vec2,
};

pub fn show(
    ui: &mut Ui,
    session: &Session,
    shown: (&mut Swatches, &mut BrushShelf),
    requests: &mut UiRequests,
) {
    let id = edits_id();
    let mut edits = ui.data(|data| data.get_temp::<bool>(id)).unwrap_or_default();
    let mut sought = None;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        segments(ui, |ui| {
            for (which, label, hint) in [
                (false, "Presets", "Brushes to choose from"),
                (true, "Current brush", "Settings of the current brush"),
            ] {
                if segment(ui, label, hint, edits == which).clicked() {
                    edits = which;
                }
            }
        });
        ui.add_space(3.0);
        if !edits && ui.available_width() >= SEARCH_PT {
            sought = Some(search(ui, requests));
        }
    });
    // The words of some languages leave no room beside them.
    if !edits && sought.is_none() {
        ui.horizontal(|ui| sought = Some(search(ui, requests)));
    }
    let sought = sought.unwrap_or_default();
    ui.data_mut(|data| data.insert_temp(id, edits));
    if edits {
        numbers(ui, session, requests);
        brush::show(ui, session, requests);
        keep(ui, requests);
    } else {
        presets(ui, session, shown, &sought, requests);
    }
}

/// Where it is kept whether the brush in hand is edited, not chosen.
fn edits_id() -> Id {
    Id::unique("brush in hand")
}

/// Shows the settings of the brush in hand from now on.
pub fn edit(ctx: &egui::Context) {
    ctx.data_mut(|data| data.insert_temp(edits_id(), true));
}

/// The presets that a search finds, group by group.
fn presets(
    ui: &mut Ui,
    session: &Session,
    (swatches, shelf): (&mut Swatches, &mut BrushShelf),
    search: &str,
    requests: &mut UiRequests,
) {
    if !session.presets.iter().any(|preset| is_sought(preset, search)) {
        ui.weak(tr!("No brush is called “{name}”", name = search.trim()));
    }
    let (mut marked, mut is_first) = (None, true);
    for (name, listing, presets) in sections(session, shelf, search) {
        if std::mem::take(&mut is_first) {
            ui.strong(tr(name));
        } else {
            title(ui, name);
        }
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing = vec2(5.0, 5.0);
            for known in presets {
                let is_favorite = shelf.is_favorite(&known.key);
                let look = CellLook { listing, is_on: session.preset == known.key, is_favorite };
                let response = preset(ui, known, look, swatches);
                if response.clicked() {
                    requests.act(Action::Hand(HandAction::Preset { name: known.key.clone() }));
                }
                if let Some(on) = menu(&response, known, is_favorite, requests) {
                    marked = Some((known.key.clone(), on));
                }
            }
        });
    }
    if let Some((key, on)) = marked {
        shelf.mark(&key, on);
    }
}

/// Whether a preset matches a search, in English or by the words that are shown.
fn is_sought(preset: &BrushPreset, search: &str) -> bool {
    let has_shown_words = || {
        let (name, group) = (preset_name(preset), tr(preset.group.name()));
        let text = format!("{name} {group} {}", preset_about(preset)).to_lowercase();
        search.to_lowercase().split_whitespace().all(|word| text.contains(word))
    };
    is_found(preset, search) || has_shown_words()
}

/// Where a preset is listed.
#[derive(Clone, Copy)]
enum PresetListing {
    Favorites,
    LastUsed,
    Group,
}

impl PresetListing {
    /// What a preset is called there for screen readers, where it may be listed twice.
    fn label(self, name: &str) -> String {
        match self {
            PresetListing::Favorites => tr!("Brush {name}, favorite", name),
            PresetListing::LastUsed => tr!("Brush {name}, last used", name),
            PresetListing::Group => tr!("Brush {name}", name),
        }
    }
}

/// The groups that are not empty, each with its title and its kind: favorites, those used last, the
/// user's own, then those of the program.
fn sections<'a>(
    session: &'a Session,
    shelf: &BrushShelf,
    search: &str,
) -> Vec<(&'static str, PresetListing, Vec<&'a BrushPreset>)> {
    let found = |preset: &&BrushPreset| is_sought(preset, search);
    let by_key = |keys: &[String]| -> Vec<&'a BrushPreset> {
        let one = |key: &String| session.presets.iter().find(|preset| preset.key == *key);
        keys.iter().filter_map(one).filter(found).collect()
    };
    let mut sections = vec![("Favorites", PresetListing::Favorites, by_key(&shelf.favorites))];
    // The brush in hand alone says nothing.
    if shelf.used.len() > 1 && search.is_empty() {
        sections.push(("Last used", PresetListing::LastUsed, by_key(&shelf.used)));
    }
    let own = PresetGroup::ALL.into_iter().filter(|(group, _)| *group == PresetGroup::Imported);
    let others = PresetGroup::ALL.into_iter().filter(|(group, _)| *group != PresetGroup::Imported);
    for (group, name) in own.chain(others) {
        let of_group = session.presets.iter().filter(|preset| preset.group == group);
        sections.push((name, PresetListing::Group, of_group.filter(found).collect()));
    }
    sections.retain(|(.., presets)| !presets.is_empty());
    sections
}

/// A right click on a brush; returns whether it is a favorite from now on, if that was said.
fn menu(
    response: &Response,
    known: &BrushPreset,
    is_favorite: bool,
    requests: &mut UiRequests,
) -> Option<bool> {
    let mut marked = None;
    response.context_menu(|ui| {
        let mark = if is_favorite { "Remove from favorites" } else { "Add to favorites" };
        if ui.button(tr(mark)).clicked() {
            marked = Some(!is_favorite);
            ui.close();
        }
        if known.group == PresetGroup::Imported && ui.button(tr("Remove brush")).clicked() {
            requests.act(Action::File(FileAction::RemoveBrush { name: known.key.clone() }));
            ui.close();
        }
    });
    marked
}

/// Saves the current brush under a name.
fn keep(ui: &mut Ui, requests: &mut UiRequests) {
    let id = Id::unique("brush name");
    let mut name = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_default();
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        let word = egui::WidgetText::from(tr("Keep brush"));
        let word_pt = word.clone().into_galley(
            ui,
            Some(egui::TextWrapMode::Extend),
            f32::INFINITY,
            egui::TextStyle::Button,
        );
        let padding_pt = 2.0 * ui.spacing().button_padding.x + 2.0 * ui.spacing().item_spacing.x;
        let button_pt = (word_pt.size().x + padding_pt).max(96.0);
        let field = TextEdit::singleline(&mut name)
            .hint_text(tr("Name"))
            .desired_width((ui.available_width() - button_pt).max(24.0));
        set_accessible_name(&ui.add(field), tr("Name of the brush to keep"));
        let button = ui.add_enabled(!name.trim().is_empty(), egui::Button::new(word));
        if button.on_hover_text(tr("Adds the current brush to the list")).clicked() {
            requests.act(Action::File(FileAction::KeepBrush { name: std::mem::take(&mut name) }));
        }
    });
    ui.data_mut(|data| data.insert_temp(id, name));
}

/// The least room of the field that finds brushes, with its button.
const SEARCH_PT: f32 = BUTTON_PT + 74.0;

/// The field that finds brushes, and the button that imports some; returns the text.
fn search(ui: &mut Ui, requests: &mut UiRequests) -> String {
    let id = Id::unique("brush search");
    let mut search = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_default();
    let room_pt = ui.available_width() - BUTTON_PT - 14.0;
    let field = TextEdit::singleline(&mut search).hint_text(tr("Search")).desired_width(room_pt);
    set_accessible_name(&ui.add(field), tr("Search brushes"));
    let import = icon_button(ui, Icon::Add, "Import a brush…", false).on_hover_text(tr(
        "Import brushes of GIMP (.gbr, .gih), Krita (.kpp, .bundle), MyPaint (.myb), Photoshop (.abr), a preset \
         (.json), or a picture as a tip",
    ));
    if import.clicked() {
        requests.request(WindowRequest::Choose(FilePurpose::Brush));
    }
    ui.data_mut(|data| data.insert_temp(id, search.clone()));
    search
}

/// The size of one preset in the list: its picture above its name.
const CELL_PT: eframe::egui::Vec2 = vec2(58.0, 74.0);
const SWATCH_PT: f32 = 44.0;

/// How a preset is shown.
#[derive(Clone, Copy)]
struct CellLook {
    listing: PresetListing,
    is_on: bool,
    is_favorite: bool,
}

/// One preset.
fn preset(
    ui: &mut Ui,
    preset: &BrushPreset,
    CellLook { listing, is_on, is_favorite }: CellLook,
    swatches: &mut Swatches,
) -> Response {
    let (rect, response) = ui.allocate_exact_size(CELL_PT, Sense::click());
    let label = preset_name(preset);
    response.widget_info(|| {
        egui::WidgetInfo::selected(egui::Role::Button, true, is_on, listing.label(label))
    });
    if !ui.is_rect_visible(rect) {
        return response;
    }
    let look = ui.style().interact_selectable(&response, is_on);
    ui.painter().rect(rect, 5.0, look.weak_bg_fill, look.bg_stroke, StrokeKind::Inside);
    let at = Rect::from_min_size(
        rect.min + vec2(0.5 * (CELL_PT.x - SWATCH_PT), 3.0),
        vec2(SWATCH_PT, SWATCH_PT),
    );
    if let Some(texture) = swatches.of(ui.ctx(), preset) {
        ui.painter().image(
            texture,
            at,
            Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0)),
            Color32::WHITE,
        );
    }
    if is_favorite {
        let corner = at.right_top() + vec2(1.0, 3.0);
        ui.painter().circle_filled(corner, 3.5, ACCENT);
    }
    let font = egui::TextStyle::Small.resolve(ui.style());
    let mut job = LayoutJob::simple(label.to_owned(), font, look.text_color(), rect.width() - 4.0);
    // A name takes two lines; a longer one ends in an ellipsis, and the tooltip shows all of it.
    job.wrap = TextWrapping {
        max_rows: 2,
        break_anywhere: false,
        ..TextWrapping::wrap_at_width(rect.width() - 4.0)
    };
    job.halign = Align::Center;
    let text = ui.fonts_mut(|fonts| fonts.layout_job(job));
    let middle = 0.5 * (at.bottom() + rect.bottom());
    ui.painter().galley(
        pos2(rect.center().x, middle - 0.5 * text.size().y),
        text,
        look.text_color(),
    );
    response.on_hover_text(format!("{label}\n{}", preset_about(preset)))
}

fn numbers(ui: &mut Ui, session: &Session, requests: &mut UiRequests) {
    let brush = &session.tools.brush;
    let mut push = |action: Option<HandAction>| requests.actions.extend(action.map(Action::Hand));
    let size = NumberField::new("Size", Brush::HAND_SIZE, "Diameter of a dab").px();
    push(size.row(ui, brush.size).map(|c| HandAction::Size { to: c.to }));
    let hardness =
        NumberField::new("Hardness", 0.0..=1.0, "Share of the radius that is fully covered")
            .share();
    push(hardness.row(ui, brush.hardness).map(|c| HandAction::Hardness { to: c.to }));
    let softness = NumberField::new(
        "Softness",
        0.0..=1.0,
        "Blur of the footprint: a rougher, less glossy mark",
    )
    .share();
    push(softness.row(ui, brush.softness).map(|c| HandAction::Softness { to: c.to }));
    let opacity = NumberField::new("Opacity", 0.0..=1.0, "Of the whole stroke").share();
    push(opacity.row(ui, brush.opacity).map(|c| HandAction::Opacity { to: c.to }));
    let flow = NumberField::new("Flow", 0.0..=1.0, "What one dab adds").share();
    push(flow.row(ui, brush.flow).map(|c| HandAction::Flow { to: c.to }));
    let spacing = NumberField::new("Spacing", 0.01..=4.0, "Distance between dabs, in diameters")
        .logarithmic();
    push(spacing.row(ui, brush.spacing).map(|c| HandAction::Spacing { to: c.to }));
    let rotation =
        NumberField::new("Rotation", -180.0..=180.0, "Of the tip, counter-clockwise").degrees();
    push(rotation.row(ui, brush.rotation).map(|c| HandAction::Rotation { to: c.to }));
    title(ui, "Pen pressure");
    let [size, flow] =
        [Property::Size, Property::Flow].map(|property| brush.dynamics.pressure_share(property));
    let drives =
        NumberField::new("Size", 0.0..=1.0, "How much the size follows the pressure").share();
    push(drives.row(ui, size).map(|c| HandAction::Pressure { size: c.to, flow }));
    let drives =
        NumberField::new("Flow", 0.0..=1.0, "How much the flow follows the pressure").share();
    push(drives.row(ui, flow).map(|c| HandAction::Pressure { size, flow: c.to }));
}
