//! The export dialog: format, size, background and presets, then the file. It begins as the document
//! was exported last. Floor 7.

mod estimate;

use super::{DialogAnswer, buttons, set_width};
use crate::document::Document;
use crate::export_memory::{ExportMemory, ExportPreset};
use crate::io::export::ExportFormat;
use crate::language::{tr, tr_message};
use crate::math::{ColorProfile, Size, srgb::Color};
use crate::requests::WindowRequest;
use crate::session::{ExportSettings, ExportSize, ExportedFile, Session};
use crate::theme;
use crate::tr;
use crate::widgets::{NumberField, check_box, radio, segment, segments, set_accessible_name};
use eframe::egui::{
    Button, Color32, ComboBox, Id, Rect, Role, Sense, Slider, TextEdit, TextureId, Ui, Vec2,
    WidgetInfo, pos2, vec2,
};
use estimate::{SizeEstimate, size_text};
use std::path::Path;

/// The choices, kept for the next time.
pub struct ExportDialog {
    pub extension: &'static str,
    /// Its bits are ignored by formats that cannot have these.
    pub settings: ExportSettings,
    estimate: SizeEstimate,
}

impl Default for ExportDialog {
    fn default() -> Self {
        Self {
            extension: "png",
            settings: ExportSettings::default(),
            estimate: SizeEstimate::default(),
        }
    }
}

/// Factors to choose by a click.
const SCALES: [(f32, &str, &str); 3] = [
    (0.5, "½×", "Half as large"),
    (1.0, "1×", "As large as the canvas"),
    (2.0, "2×", "Twice as large"),
];
/// The formats whose size depends on what is in the picture so much that it is worth knowing.
const MEASURED: [&str; 2] = ["jpg", "webp"];

const FORMATS: [(&str, &str); 6] = [
    ("png", "PNG: keeps transparency"),
    ("tif", "TIFF: keeps transparency"),
    ("exr", "EXR: linear light, keeps values brighter than white"),
    ("jpg", "JPEG: small, opaque"),
    ("webp", "WebP: lossless, small"),
    ("psd", "PSD: the layers for Photoshop, live ones as pixels"),
];

impl ExportDialog {
    /// The same choices in another dialog; what is computed for this one ends with it.
    pub fn without_estimate(&self) -> Self {
        Self { estimate: SizeEstimate::default(), ..*self }
    }

    /// Chooses what a file was exported with.
    pub fn take(&mut self, last: &ExportedFile) {
        let ending = last.file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        self.take_extension(match ending.as_str() {
            "jpeg" => "jpg",
            "tiff" => "tif",
            other => other,
        });
        self.settings = last.settings;
    }

    fn take_extension(&mut self, extension: &str) {
        let known = FORMATS.iter().find(|(known, _)| *known == extension);
        self.extension = known.map_or(self.extension, |(known, _)| known);
    }

    /// `preview`: the picture, small.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        memory: &mut ExportMemory,
        preview: Option<TextureId>,
    ) -> DialogAnswer {
        set_width(ui, 340.0);
        ui.heading(tr("Export the picture"));
        self.presets(ui, memory);
        let document = session.shown_document();
        if let (Some(preview), Some(document)) = (preview, document) {
            self.preview(ui, preview, document.size);
        }
        if let Some(document) = document {
            self.size(ui, document);
        }
        for (extension, about) in FORMATS {
            radio(ui, &mut self.extension, extension, about);
        }
        self.depth(ui);
        self.profile(ui, document);
        let mut opaque = self.settings.background.is_some() || self.extension == "jpg";
        let can_choose = !["jpg", "psd"].contains(&self.extension);
        ui.add_enabled_ui(can_choose, |ui| check_box(ui, &mut opaque, "Lay it on white"));
        self.settings.background = opaque.then_some(Color::WHITE);
        ui.add_enabled_ui(self.extension == "jpg", |ui| {
            ui.add(Slider::new(&mut self.settings.quality, 1..=100).text(tr("Quality")));
        });
        if let Some(document) = document.filter(|_| MEASURED.contains(&self.extension)) {
            self.bytes(ui, document);
        }
        match buttons(ui, "Export…", document.is_some()) {
            Some(true) => DialogAnswer::Ask(WindowRequest::Export(self.extension)),
            Some(false) => DialogAnswer::Close,
            None => DialogAnswer::Open,
        }
    }

    /// Those that the user named, and a field that names another.
    fn presets(&mut self, ui: &mut Ui, memory: &mut ExportMemory) {
        let id = Id::unique("export preset name");
        let mut name = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_default();
        ui.horizontal(|ui| {
            let mut chosen = None;
            ui.add_enabled_ui(!memory.presets.is_empty(), |ui| {
                let list = ComboBox::from_id_salt("export presets").selected_text(tr("Presets"));
                let list = list.width(96.0).show_ui(ui, |ui| {
                    for preset in &memory.presets {
                        if ui.button(&preset.name).clicked() {
                            chosen = Some(preset.clone());
                        }
                    }
                });
                set_accessible_name(&list.response, tr("Presets"));
            });
            if let Some(preset) = chosen {
                self.take_extension(&preset.extension);
                self.settings = preset.settings;
                name = preset.name;
            }
            let field = TextEdit::singleline(&mut name).hint_text(tr("Name")).desired_width(96.0);
            set_accessible_name(&ui.add(field.char_limit(40)), tr("Name of the preset"));
            let trimmed = name.trim().to_owned();
            let keep = ui.add_enabled(!trimmed.is_empty(), Button::new(tr("Keep")));
            if keep.on_hover_text(tr("Keeps these settings as a preset")).clicked() {
                let (extension, settings) = (self.extension.to_owned(), self.settings);
                memory.keep(ExportPreset { name: trimmed.clone(), extension, settings });
            }
            let is_known = memory.presets.iter().any(|preset| preset.name == trimmed);
            let remove = ui.add_enabled(is_known, Button::new(tr("Remove")));
            if remove.on_hover_text(tr("Removes the preset of this name")).clicked() {
                memory.remove(&trimmed);
            }
        });
        ui.data_mut(|data| data.insert_temp(id, name));
    }

    /// The scale or the width, and the part.
    fn size(&mut self, ui: &mut Ui, document: &Document) {
        let settings = &mut self.settings;
        let pixels = settings.pixels(document);
        ui.horizontal(|ui| {
            ui.label(tr("Size"));
            segments(ui, |ui| {
                for (factor, label, hint) in SCALES {
                    let is_on = settings.size == ExportSize::Scale(factor);
                    if segment(ui, label, hint, is_on).clicked() {
                        settings.size = ExportSize::Scale(factor);
                    }
                }
            });
            let field = NumberField::new("Width", 1.0..=32_768.0, "Of the picture").decimals(0);
            if let Some(changed) = field.field(ui, pixels.width as f32) {
                settings.size = ExportSize::Width(changed.to as u32);
            }
            ui.weak(tr!("{size} pixels", size = pixels));
        });
        let can_choose = document.active_selection.is_some() && self.extension != "psd";
        ui.add_enabled_ui(can_choose, |ui| {
            check_box(ui, &mut settings.selection, "Only the box around the selection")
        });
    }

    /// How many bytes the file will have.
    fn bytes(&mut self, ui: &mut Ui, document: &Document) {
        let ctx = ui.ctx().clone();
        let settings = ExportSettings { bits: None, ..self.settings };
        let text = match self.estimate.bytes(&ctx, document, self.extension, settings) {
            Some(Ok(bytes)) => tr!("File size {size}", size = size_text(bytes)),
            Some(Err(why)) => tr_message(&why).into_owned(),
            None => tr("File size …").to_owned(),
        };
        ui.weak(text);
    }

    /// How a file of this name is written: without what its format cannot hold.
    pub fn settings_for(&self, file: &Path) -> ExportSettings {
        let format = ExportFormat::of(file).ok();
        let depths = format.map_or(&[][..], ExportFormat::depths);
        ExportSettings {
            bits: self.settings.bits.filter(|bits| depths.contains(bits)),
            // What is no picture holds the whole canvas.
            selection: self.settings.selection && format.is_some(),
            ..self.settings
        }
    }

    /// Shown if the document is not in sRGB.
    fn profile(&mut self, ui: &mut Ui, document: Option<&Document>) {
        if document.is_some_and(|document| document.profile != ColorProfile::Srgb) {
            let mut is_converted = self.settings.profile == Some(ColorProfile::Srgb);
            let hint =
                "For programs that ignore color profiles; else the file names the document's";
            check_box(ui, &mut is_converted, "Convert to sRGB").on_hover_text(tr(hint));
            self.settings.profile = is_converted.then_some(ColorProfile::Srgb);
        }
    }

    /// Shown if the format can have more than one depth.
    fn depth(&mut self, ui: &mut Ui) {
        let format = ExportFormat::ALL.iter().find(|(_, extension)| *extension == self.extension);
        let depths = format.map_or(&[][..], |(format, _)| format.depths());
        let usual = depths.first().copied();
        ui.add_enabled_ui(depths.len() > 1, |ui| {
            ui.horizontal(|ui| {
                ui.label(tr("Bits a channel"));
                for &depth in depths {
                    let is_chosen =
                        self.settings.bits.filter(|bits| depths.contains(bits)).or(usual)
                            == Some(depth);
                    if ui.radio(is_chosen, tr!("{depth} bits", depth)).clicked() {
                        self.settings.bits = Some(depth);
                    }
                }
            });
        });
    }

    /// The picture on its background: white or none.
    fn preview(&self, ui: &mut Ui, preview: TextureId, canvas: Size) {
        const ROOM_PT: Vec2 = vec2(320.0, 180.0);
        let side = vec2(canvas.width as f32, canvas.height as f32);
        let side = side * (ROOM_PT.x / side.x).min(ROOM_PT.y / side.y);
        let (room, response) = ui.allocate_exact_size(vec2(ROOM_PT.x, side.y), Sense::hover());
        response
            .widget_info(|| WidgetInfo::labeled(Role::Image, true, tr("Preview of the export")));
        let rect = Rect::from_center_size(room.center(), side);
        let painter = ui.painter_at(rect);
        painter.rect_filled(
            rect,
            0.0,
            if self.settings.background.is_some() { Color32::WHITE } else { theme::CHECKER[0] },
        );
        if self.settings.background.is_none() {
            const SQUARE_PT: f32 = 8.0;
            let (columns, rows) =
                ((side.x / SQUARE_PT).ceil() as u32, (side.y / SQUARE_PT).ceil() as u32);
            for (x, y) in (0..rows)
                .flat_map(|y| (0..columns).map(move |x| (x, y)))
                .filter(|(x, y)| (x + y) % 2 == 0)
            {
                let corner = rect.min + vec2(x as f32, y as f32) * SQUARE_PT;
                painter.rect_filled(
                    Rect::from_min_size(corner, Vec2::splat(SQUARE_PT)),
                    0.0,
                    theme::CHECKER[1],
                );
            }
        }
        painter.image(
            preview,
            rect,
            Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0)),
            Color32::WHITE,
        );
    }
}
