//! Asks for the size of the canvas, of the picture, and for the angle that it is turned by.
//! Floor 7.

use super::{Dialog, DialogAnswer, buttons, set_width};
use crate::document::canvas_change::{CanvasAnchor, CanvasChange};
use crate::language::{tr, tr_number};
use crate::math::Size;
use crate::raster::Resampling;
use crate::requests::{UiRequests, WindowRequest};
use crate::session::Action;
use crate::session::actions::CanvasAction;
use crate::tr;
use crate::widgets::{begin_with, check_box, choice, number};
use eframe::egui::{Button, Grid, Ui};

/// A side in the dialogs, px: as for new documents.
const SIDE: std::ops::RangeInclusive<u32> = 1..=16_384;
/// What printers take for one inch.
const PRINT_PPI: f32 = 300.0;

/// The requested dialog, for a canvas of a size.
pub fn dialog_for(ask: &WindowRequest, size: Size) -> Dialog {
    match ask {
        WindowRequest::ImageSizeDialog => Dialog::ImageSize(ImageSizeDialog::of(size)),
        WindowRequest::TurnDialog => Dialog::Turn(TurnDialog::of(size)),
        _ => Dialog::Canvas(CanvasSizeDialog::of(size)),
    }
}

/// Two sides, which may keep their aspect.
struct CanvasSides {
    from: Size,
    width: u32,
    height: u32,
    keeps_aspect: bool,
}

impl CanvasSides {
    fn of(from: Size, keeps_aspect: bool) -> Self {
        Self { from, width: from.width, height: from.height, keeps_aspect }
    }

    fn size(&self) -> Size {
        Size::new(self.width, self.height)
    }

    fn show(&mut self, ui: &mut Ui) {
        let (w, h) = (self.from.width as f32, self.from.height as f32);
        let held = |v: f32| (v.round() as u32).clamp(*SIDE.start(), *SIDE.end());
        let mut percent = [100.0 * self.width as f32 / w, 100.0 * self.height as f32 / h];
        let (mut wider, mut taller) = (false, false);
        Grid::new("sides").num_columns(3).show(ui, |ui| {
            for (i, name) in ["Width", "Height"].into_iter().enumerate() {
                let name = tr(name);
                let label = ui.label(name);
                let side = if i == 0 { &mut self.width } else { &mut self.height };
                let px = number(side).range(SIDE).suffix(" px");
                let px = ui.add(px).labelled_by(label.id);
                if i == 0 {
                    begin_with(&px);
                }
                let mut is_other = px.changed();
                let share = number(&mut percent[i]).range(0.1..=10_000.0).speed(0.5).suffix(" %");
                let share = ui
                    .add(share)
                    .on_hover_text(tr!("{side}, relative to the present size", side = name));
                if share.changed() {
                    *side = held([w, h][i] * percent[i] / 100.0);
                    is_other = true;
                }
                *[&mut wider, &mut taller][i] |= is_other;
                ui.end_row();
            }
        });
        let hint = "Changing one side changes the other";
        let locked = check_box(ui, &mut self.keeps_aspect, "Keep the aspect")
            .on_hover_text(tr(hint))
            .changed();
        if self.keeps_aspect && (wider || locked) {
            self.height = held(self.width as f32 * h / w);
        } else if self.keeps_aspect && taller {
            self.width = held(self.height as f32 * w / h);
        }
        ui.weak(describe(self.from, self.size()));
    }
}

/// What a size means.
fn describe(from: Size, to: Size) -> String {
    let cm = |px: u32| px as f32 / PRINT_PPI * 2.54;
    let millions = to.area() as f32 / 1e6;
    let (w, h) = (cm(to.width), cm(to.height));
    let tenths = |value: f32| tr_number(&format!("{value:.1}")).into_owned();
    tr!(
        "{from} to {to} px, {millions} megapixels; {width} × {height} cm printed at {resolution} px an inch",
        from,
        to,
        millions = tenths(millions),
        width = tenths(w),
        height = tenths(h),
        resolution = PRINT_PPI,
    )
}

/// Borders that move.
pub struct CanvasSizeDialog {
    sides: CanvasSides,
    anchor: CanvasAnchor,
}

/// Their names in the window.
const ANCHORS: [(CanvasAnchor, &str); 9] = [
    (CanvasAnchor::TopLeft, "The upper left corner stays"),
    (CanvasAnchor::Top, "The upper side stays"),
    (CanvasAnchor::TopRight, "The upper right corner stays"),
    (CanvasAnchor::Left, "The left side stays"),
    (CanvasAnchor::Center, "The middle stays"),
    (CanvasAnchor::Right, "The right side stays"),
    (CanvasAnchor::BottomLeft, "The lower left corner stays"),
    (CanvasAnchor::Bottom, "The lower side stays"),
    (CanvasAnchor::BottomRight, "The lower right corner stays"),
];

impl CanvasSizeDialog {
    pub fn of(size: Size) -> Self {
        Self { sides: CanvasSides::of(size, false), anchor: CanvasAnchor::Center }
    }

    pub fn show(&mut self, ui: &mut Ui, requests: &mut UiRequests) -> DialogAnswer {
        set_width(ui, 360.0);
        ui.heading(tr("Canvas size"));
        ui.weak(tr("Moves the borders. Paint beyond them is kept; masks of layers are cut."));
        self.sides.show(ui);
        Grid::new("anchor").spacing([2.0, 2.0]).show(ui, |ui| {
            for (i, (anchor, hint)) in ANCHORS.into_iter().enumerate() {
                let button =
                    Button::selectable(self.anchor == anchor, "").min_size([30.0, 26.0].into());
                let hint = tr(hint);
                let response = ui.add(button).on_hover_text(hint);
                let is_on = self.anchor == anchor;
                response.widget_info(|| {
                    eframe::egui::WidgetInfo::selected(
                        eframe::egui::Role::RadioButton,
                        true,
                        is_on,
                        hint,
                    )
                });
                if response.clicked() {
                    self.anchor = anchor;
                }
                if i % 3 == 2 {
                    ui.end_row();
                }
            }
        });
        let Size { width, height } = self.sides.size();
        answer(ui, requests, "Resize", CanvasAction::Size { width, height, anchor: self.anchor })
    }
}

/// A picture that becomes larger or smaller.
pub struct ImageSizeDialog {
    sides: CanvasSides,
    filter: Resampling,
}

impl ImageSizeDialog {
    pub fn of(size: Size) -> Self {
        Self { sides: CanvasSides::of(size, true), filter: Resampling::Sharp }
    }

    pub fn show(&mut self, ui: &mut Ui, requests: &mut UiRequests) -> DialogAnswer {
        set_width(ui, 360.0);
        ui.heading(tr("Image size"));
        ui.weak(tr("Paint is resampled; strokes, images, gradients and the shape are rendered again, as sharp as \
             before."));
        self.sides.show(ui);
        ui.horizontal(|ui| {
            ui.label(tr("Paint is sampled"));
            self.filter = choice(ui, "How paint is sampled", self.filter, &Resampling::ALL)
                .unwrap_or(self.filter);
        });
        let Size { width, height } = self.sides.size();
        answer(ui, requests, "Resize", CanvasAction::Scale { width, height, filter: self.filter })
    }
}

/// A turn by any angle.
pub struct TurnDialog {
    size: Size,
    degrees: f32,
}

impl TurnDialog {
    pub fn of(size: Size) -> Self {
        Self { size, degrees: 15.0 }
    }

    pub fn show(&mut self, ui: &mut Ui, requests: &mut UiRequests) -> DialogAnswer {
        set_width(ui, 360.0);
        ui.heading(tr("Turn canvas"));
        ui.weak(tr(
            "Counter-clockwise. Paint gets a transform, so it can be turned back without loss.",
        ));
        ui.horizontal(|ui| {
            let label = ui.label(tr("Angle"));
            let angle = number(&mut self.degrees).range(-360.0..=360.0).speed(0.5).suffix("°");
            begin_with(&ui.add(angle).labelled_by(label.id));
        });
        ui.weak(describe(self.size, CanvasChange::turn(self.size, f64::from(self.degrees)).size()));
        answer(ui, requests, "Turn", CanvasAction::Turn { degrees: self.degrees })
    }
}

fn answer(ui: &mut Ui, requests: &mut UiRequests, yes: &str, action: CanvasAction) -> DialogAnswer {
    match buttons(ui, yes, true) {
        Some(true) => {
            requests.act(Action::Canvas(action));
            DialogAnswer::Close
        }
        Some(false) => DialogAnswer::Close,
        None => DialogAnswer::Open,
    }
}
