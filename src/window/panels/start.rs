//! The start screen, while no document is open: what to begin with, recent files and samples with
//! their pictures. Floor 7. Not here: making the pictures (`file_pictures`, `sample_pictures`).

use crate::commands::find_command;
use crate::file_pictures::FilePictures;
use crate::icons::Icon;
use crate::keymap::{Keymap, key_text};
use crate::language::tr;
use crate::requests::{UiRequests, WindowRequest};
use crate::sample::SAMPLES;
use crate::sample_pictures::SamplePictures;
use crate::tools::ToolKind;
use eframe::egui::text::{LayoutJob, TextFormat, TextWrapping};
use eframe::egui::{
    Align2, Color32, Context, Rect, Response, RichText, Role, ScrollArea, Sense, Stroke,
    StrokeKind, TextStyle, TextWrapMode, TextureHandle, Ui, UiBuilder, Vec2, WidgetInfo,
    WidgetText, pos2, vec2,
};
use std::path::PathBuf;

/// The greatest width of the column, and the air between cards, points.
const COLUMN_PT: f32 = 780.0;
const GAP_PT: f32 = 12.0;
/// Heights of a card with a command, and of one with a picture; the least width of the latter.
const COMMAND_PT: f32 = 62.0;
const PICTURE_PT: Vec2 = vec2(146.0, 146.0);
/// The height of the line with the name beneath a picture.
const NAME_PT: f32 = 30.0;

/// What the screen begins with: a command, the card's name, what it does, its sign.
const BEGINNINGS: [(&str, &str, &str, Icon); 3] = [
    ("New…", "New picture", "An empty canvas", Icon::Add),
    ("Open…", "Open a drawing", "To shape it, or to paint", Icon::Tool(ToolKind::Image)),
    ("Open maps…", "Open normal maps", "A shape from elsewhere", Icon::Normals),
];

/// What a card with a picture opens.
#[derive(Clone)]
enum StartCard {
    File(PathBuf),
    /// By its place among the samples.
    Sample(usize),
}

/// Who makes the pictures.
pub struct StartPictures<'a> {
    pub files: &'a mut FilePictures,
    pub samples: &'a mut SamplePictures,
}

impl StartPictures<'_> {
    fn of(&mut self, ctx: &Context, card: &StartCard) -> Option<&TextureHandle> {
        match card {
            StartCard::File(file) => self.files.of(ctx, file),
            StartCard::Sample(index) => self.samples.of(ctx, *index),
        }
    }
}

pub fn show(
    ui: &mut Ui,
    area: Rect,
    (recent, keymap): (&[PathBuf], &Keymap),
    mut pictures: StartPictures<'_>,
    requests: &mut UiRequests,
) {
    let width = COLUMN_PT.min(area.width() - 4.0 * GAP_PT).max(200.0);
    let column = Rect::from_min_max(
        pos2(area.center().x - 0.5 * width, area.top()),
        pos2(area.center().x + 0.5 * width + GAP_PT, area.bottom()),
    );
    ui.scope_builder(UiBuilder::new().max_rect(column), |ui| {
        ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            ui.set_width(width);
            ui.spacing_mut().item_spacing = Vec2::splat(GAP_PT);
            ui.add_space((0.08 * area.height()).min(64.0));
            ui.label(RichText::new("Rilievo").size(28.0).strong());
            ui.weak(tr(
                "Paint on shapes: drop a drawing, a photo, normal maps or a project anywhere here.",
            ));
            beginnings(ui, keymap, requests);
            let files: Vec<StartCard> = recent.iter().cloned().map(StartCard::File).collect();
            cards(ui, "Recent", &files, &mut pictures, requests);
            let samples: Vec<StartCard> = (0..SAMPLES.len()).map(StartCard::Sample).collect();
            cards(ui, "Samples", &samples, &mut pictures, requests);
            ui.add_space(2.0 * GAP_PT);
        });
    });
}

/// The commands that make or open a document.
fn beginnings(ui: &mut Ui, keymap: &Keymap, requests: &mut UiRequests) {
    let count = BEGINNINGS.len() as f32;
    let side = (ui.available_width() - (count - 1.0) * GAP_PT) / count;
    ui.horizontal(|ui| {
        for (name, title, about, icon) in BEGINNINGS {
            let Some(command) = find_command(name) else { continue };
            let keys = keymap.first(command).map(|keys| key_text(ui.ctx(), keys));
            let hint = format!("{} {}", tr(command.hint), keys.unwrap_or_default());
            let (title, about) = (tr(title), tr(about));
            let (rect, response) = ui.allocate_exact_size(vec2(side, COMMAND_PT), Sense::click());
            frame(ui, rect, &response, title);
            let visuals = ui.visuals();
            let (strong, weak) = (visuals.strong_text_color(), visuals.weak_text_color());
            let sign = Rect::from_center_size(
                pos2(rect.left() + 28.0, rect.center().y),
                Vec2::splat(22.0),
            );
            icon.draw(ui.painter(), sign, strong);
            let left = sign.right() + 12.0;
            let room = rect.right() - left - 8.0;
            let wrap = TextWrapping { max_rows: 3, ..TextWrapping::wrap_at_width(room) };
            let mut texts = LayoutJob { wrap, ..LayoutJob::default() };
            let font = TextStyle::Body.resolve(ui.style());
            for (text, color) in [(title, strong), ("\n", weak), (about, weak)] {
                texts.append(text, 0.0, TextFormat::simple(font.clone(), color));
            }
            let texts = ui.painter().layout_job(texts);
            let at = Align2::LEFT_CENTER.anchor_size(pos2(left, rect.center().y), texts.size());
            ui.painter().galley(at.min, texts, strong);
            if response.on_hover_text(hint.trim()).clicked() {
                // None of them asks about a document.
                (command.run)(&crate::session::Session::default(), requests);
            }
        }
    });
}

/// A title and cards beneath it, as many in a row as there is room for.
fn cards(
    ui: &mut Ui,
    title: &str,
    cards: &[StartCard],
    pictures: &mut StartPictures<'_>,
    requests: &mut UiRequests,
) {
    if cards.is_empty() {
        return;
    }
    ui.add_space(GAP_PT);
    ui.label(RichText::new(tr(title)).strong());
    let columns = ((ui.available_width() + GAP_PT) / (PICTURE_PT.x + GAP_PT)).floor().max(1.0);
    let side = (ui.available_width() - (columns - 1.0) * GAP_PT) / columns;
    for row in cards.chunks(columns as usize) {
        ui.horizontal(|ui| {
            row.iter().for_each(|one| card(ui, one, side, pictures, requests));
        });
    }
}

/// A picture with its name beneath; a click opens it.
fn card(
    ui: &mut Ui,
    card: &StartCard,
    width_pt: f32,
    pictures: &mut StartPictures<'_>,
    requests: &mut UiRequests,
) {
    let (name, about, request) = match card {
        StartCard::File(file) => (
            file.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            file.display().to_string(),
            WindowRequest::Open(file.clone()),
        ),
        StartCard::Sample(index) => {
            let Some(sample) = SAMPLES.get(*index) else { return };
            (
                tr(sample.name).to_owned(),
                tr(sample.about).to_owned(),
                WindowRequest::OpenSample(*index),
            )
        }
    };
    let (rect, response) = ui.allocate_exact_size(vec2(width_pt, PICTURE_PT.y), Sense::click());
    if ui.is_rect_visible(rect) {
        frame(ui, rect, &response, &name);
        let room = Rect::from_min_max(rect.min, rect.max - vec2(0.0, NAME_PT)).shrink(8.0);
        match pictures.of(ui.ctx(), card) {
            Some(texture) => {
                let size = texture.size_vec2();
                let scale = (room.width() / size.x).min(room.height() / size.y);
                let at = Rect::from_center_size(room.center(), size * scale);
                let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
                ui.painter().image(texture.id(), at, uv, Color32::WHITE);
            }
            None => {
                let at = Rect::from_center_size(room.center(), Vec2::splat(28.0));
                Icon::Tool(ToolKind::Image).draw(ui.painter(), at, ui.visuals().weak_text_color());
            }
        }
        let left = pos2(rect.left() + 10.0, rect.bottom() - 0.5 * NAME_PT - 2.0);
        line(ui, left, rect.width() - 20.0, &name, ui.visuals().text_color());
    }
    if response.on_hover_text(about).clicked() {
        requests.request(request);
    }
}

/// The ground of a card, and its name for screen readers and tests.
fn frame(ui: &Ui, rect: Rect, response: &Response, name: &str) {
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    let visuals = ui.visuals();
    let is_hot = response.hovered() || response.has_focus();
    let fill = if is_hot { visuals.widgets.inactive.weak_bg_fill } else { visuals.panel_fill };
    let rim = match is_hot {
        true => Stroke::new(1.0, crate::theme::accent(visuals)),
        false => visuals.widgets.noninteractive.bg_stroke,
    };
    ui.painter().rect(rect, 8.0, fill, rim, StrokeKind::Inside);
}

/// A line of text, cut off where there is no more room.
fn line(ui: &Ui, left_center: eframe::egui::Pos2, width_pt: f32, text: &str, color: Color32) {
    let text = WidgetText::from(RichText::new(text).color(color));
    let room = width_pt.max(10.0);
    let galley = text.into_galley(ui, Some(TextWrapMode::Truncate), room, TextStyle::Body);
    let at = Align2::LEFT_CENTER.anchor_size(left_center, galley.size());
    ui.painter().galley(at.min, galley, color);
}
