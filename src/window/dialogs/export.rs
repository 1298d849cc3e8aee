//! The export dialog: format and background, then the file.
//! Floor 7.

use super::{DialogAnswer, buttons};
use crate::io::export::ExportFormat;
use crate::math::{Size, srgb::Color};
use crate::requests::WindowRequest;
use crate::session::Session;
use crate::theme;
use crate::widgets::{check_box, radio};
use eframe::egui::{
    Color32, Rect, Role, Sense, Slider, TextureId, Ui, Vec2, WidgetInfo, pos2, vec2,
};
use std::path::Path;

/// The choices, kept for the next time.
#[derive(Clone)]
pub struct ExportDialog {
    pub extension: &'static str,
    pub background: Option<Color>,
    pub quality: u8,
    /// Bits per channel; the format's default if it cannot have these.
    pub bits: Option<u8>,
}

impl Default for ExportDialog {
    fn default() -> Self {
        Self { extension: "png", background: None, quality: 92, bits: None }
    }
}

const FORMATS: [(&str, &str); 6] = [
    ("png", "PNG: keeps transparency"),
    ("tif", "TIFF: keeps transparency"),
    ("exr", "EXR: linear light, keeps values brighter than white"),
    ("jpg", "JPEG: small, opaque"),
    ("webp", "WebP: lossless, small"),
    ("psd", "PSD: the layers for Photoshop, live ones as pixels"),
];

impl ExportDialog {
    /// `preview`: the picture, small.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        preview: Option<TextureId>,
    ) -> DialogAnswer {
        ui.set_width(320.0);
        ui.heading("Export the picture");
        if let (Some(preview), Some(document)) = (preview, session.shown_document()) {
            self.preview(ui, preview, document.size);
        }
        if let Some(document) = session.shown_document() {
            ui.weak(format!("{} pixels", document.size));
        }
        for (extension, about) in FORMATS {
            radio(ui, &mut self.extension, extension, about);
        }
        self.depth(ui);
        let mut opaque = self.background.is_some() || self.extension == "jpg";
        let can_choose = !["jpg", "psd"].contains(&self.extension);
        ui.add_enabled_ui(can_choose, |ui| check_box(ui, &mut opaque, "Lay it on white"));
        self.background = opaque.then_some(Color::WHITE);
        ui.add_enabled_ui(self.extension == "jpg", |ui| {
            ui.add(Slider::new(&mut self.quality, 1..=100).text("Quality"));
        });
        match buttons(ui, "Export…", session.shown_document().is_some()) {
            Some(true) => DialogAnswer::Ask(WindowRequest::Export(self.extension)),
            Some(false) => DialogAnswer::Close,
            None => DialogAnswer::Open,
        }
    }

    /// The bits per channel for a file of this name, if they are not the format's default.
    pub fn bits_for(&self, file: &Path) -> Option<u8> {
        let format = ExportFormat::of(file).ok()?;
        self.bits.filter(|bits| format.depths().contains(bits))
    }

    /// Shown if the format can have more than one depth.
    fn depth(&mut self, ui: &mut Ui) {
        let format = ExportFormat::ALL.iter().find(|(_, extension)| *extension == self.extension);
        let depths = format.map_or(&[][..], |(format, _)| format.depths());
        let usual = depths.first().copied();
        ui.add_enabled_ui(depths.len() > 1, |ui| {
            ui.horizontal(|ui| {
                ui.label("Bits a channel");
                for &depth in depths {
                    let is_chosen =
                        self.bits.filter(|bits| depths.contains(bits)).or(usual) == Some(depth);
                    if ui.radio(is_chosen, format!("{depth} bits")).clicked() {
                        self.bits = Some(depth);
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
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Preview of the export"));
        let rect = Rect::from_center_size(room.center(), side);
        let painter = ui.painter_at(rect);
        painter.rect_filled(
            rect,
            0.0,
            if self.background.is_some() { Color32::WHITE } else { theme::CHECKER[0] },
        );
        if self.background.is_none() {
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
