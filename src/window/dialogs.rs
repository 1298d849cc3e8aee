//! Dialogs: one at a time, over the window. Each is a struct that holds the input and a function
//! that shows it. Floor 7.

pub mod canvas;
pub mod edge;
pub mod export;
pub mod grid;
pub mod help;
pub mod import;
pub mod looks;
pub mod losses;
pub mod maps;
pub mod materials;
pub mod new;
pub mod news;
pub mod paint_change;
pub mod palette;
pub mod panels;
pub mod path;
pub mod preferences;
pub mod profile;
pub mod recovery;
pub mod replace;
pub mod shape;
pub mod unsaved;
pub mod unwrapped;

use super::file_pictures::FilePictures;
use super::file_purpose::FilePurpose;
use super::pen::PenReport;
use super::pending::{AfterUnsaved, Pending, Saving};
use super::requests::{UiRequests, WindowRequest};
use super::settings::Settings;
use super::usage::MemoryMeter;
use crate::document::SurfaceSource;
use crate::io::maps::ImportedSurface;
use crate::io::recovery::LostSession;
use crate::language::tr;
use crate::math::Vec2;
use crate::session::Session;
use eframe::egui::{self, Id, Modal, Ui};
use std::path::PathBuf;

/// The least air beside a dialog, points.
const BESIDE_PT: f32 = 24.0;

/// A dialog is as wide as it wants to be, where the window has room for that.
fn set_width(ui: &mut Ui, wanted_pt: f32) {
    ui.set_width(wanted_pt.min(ui.ctx().content_rect().width() - 2.0 * BESIDE_PT).max(1.0));
}

/// The dialog that is open.
pub enum Dialog {
    New(new::NewDialog),
    PaintChange(Box<paint_change::PaintChangeDialog>),
    Edge(edge::EdgeDialog),
    Keep(edge::KeepDialog),
    Grid,
    Looks(Box<looks::LooksDialog>),
    Materials(Box<materials::MaterialsDialog>),
    Canvas(canvas::CanvasSizeDialog),
    ImageSize(canvas::ImageSizeDialog),
    Turn(canvas::TurnDialog),
    Export(export::ExportDialog),
    Unwrapped(unwrapped::UnwrappedDialog),
    Import(Box<import::ImportDialog>),
    Path(path::PathDialog),
    Profile(profile::ProfileDialog),
    Recovery(recovery::RecoveryDialog),
    Shape(shape::ShapeDialog),
    Unsaved(unsaved::UnsavedDialog),
    Replace(replace::Replace),
    Losses(losses::Losses),
    Maps(maps::MapsDialog),
    Palette(palette::CommandPalette),
    Panels(panels::PanelsDialog),
    Preferences(Box<preferences::PreferencesDialog>),
    News,
    About,
}

/// The result of a dialog.
pub enum DialogAnswer {
    /// It stays open.
    Open,
    Close,
    Chosen(FilePurpose, PathBuf),
    /// These maps are to be read.
    Import(Box<SurfaceSource>),
    /// The document that was made from them.
    Imported(import::MadeDocument),
    /// The new maps of the document in front.
    Replaced(Box<(SurfaceSource, ImportedSurface)>),
    /// Maps for a new part of the document in front.
    Added(Box<(SurfaceSource, ImportedSurface)>),
    /// Discard unsaved changes, then do this.
    Discard(AfterUnsaved),
    /// Save first, then do this.
    SaveThen(AfterUnsaved),
    /// Replace the existing file.
    Replace(Pending),
    /// Save, whatever the format cannot hold.
    Lose(Box<Saving>),
    Ask(WindowRequest),
    /// The drawing was given a shape.
    Shaped,
    /// Recover these drawings.
    Recover(Vec<LostSession>),
    /// The user decided to delete this drawing.
    Delete(LostSession),
}

/// What dialogs read and change besides their own input.
pub struct DialogContext<'a> {
    pub session: &'a Session,
    pub settings: &'a mut Settings,
    /// The picture of the document in front, small.
    pub preview: Option<egui::TextureId>,
    /// What the pen reported in this frame.
    pub pens: &'a [PenReport],
    /// The place of the pointer on the canvas.
    pub under: Option<Vec2>,
    pub memory: &'a mut MemoryMeter,
    pub pictures: &'a mut FilePictures,
    pub requests: &'a mut UiRequests,
}

impl Dialog {
    /// Shows the dialog; escape and a click outside close it.
    pub fn show(&mut self, ctx: &egui::Context, mut context: DialogContext) -> DialogAnswer {
        let mut modal = Modal::new(Id::unique("dialog"));
        if let Dialog::PaintChange(_) | Dialog::Materials(_) = self {
            // Beside the picture, which shows what it does.
            let beside = Modal::default_area(Id::unique("dialog"))
                .anchor(egui::Align2::RIGHT_TOP, egui::vec2(-24.0, 72.0));
            modal = modal.area(beside).backdrop_color(egui::Color32::TRANSPARENT);
        }
        let modal = modal.show(ctx, |ui| {
            ui.spacing_mut().item_spacing.y = 7.0;
            self.content(ui, &mut context)
        });
        let mut is_used = false;
        if let (Dialog::Materials(materials), DialogAnswer::Open) = (&mut *self, &modal.inner) {
            let is_beside =
                modal.backdrop_response.contains_pointer() && !modal.response.contains_pointer();
            let is_clicked = modal.backdrop_response.clicked();
            let under = context.under.filter(|_| is_beside);
            is_used = materials.follow(under, is_clicked, context.session, context.requests);
        }
        let closes = modal.should_close() && !is_used;
        let answer = if closes && matches!(modal.inner, DialogAnswer::Open) {
            DialogAnswer::Close
        } else {
            modal.inner
        };
        match (&*self, &answer) {
            (Dialog::PaintChange(change), DialogAnswer::Close) => change.forget(context.requests),
            (Dialog::Materials(materials), DialogAnswer::Close) => {
                materials.forget(context.requests)
            }
            _ => {}
        }
        answer
    }

    fn content(&mut self, ui: &mut Ui, context: &mut DialogContext) -> DialogAnswer {
        match self {
            Dialog::Preferences(preferences) => return preferences.show(ui, context),
            Dialog::Path(path) => return path.show(ui, context),
            _ => {}
        }
        let DialogContext { session, settings, preview, requests, .. } = context;
        match self {
            Dialog::New(new) => new.show(ui, requests),
            Dialog::PaintChange(change) => change.show(ui, requests),
            Dialog::Edge(edge) => edge.show(ui, requests),
            Dialog::Keep(keep) => {
                let kept = session.active().map_or(&[][..], |open| &open.document().selections);
                let names: Vec<String> = kept.iter().map(|kept| kept.name.clone()).collect();
                keep.show(ui, &names, requests)
            }
            Dialog::Grid => grid::show(ui, session, requests),
            Dialog::Panels(panels) => panels.show(ui, requests),
            Dialog::Looks(looks) => looks.show(ui, session, requests),
            Dialog::Materials(materials) => materials.show(ui, session, requests),
            Dialog::Canvas(canvas) => canvas.show(ui, requests),
            Dialog::ImageSize(image) => image.show(ui, requests),
            Dialog::Turn(turn) => turn.show(ui, requests),
            Dialog::Profile(profile) => profile.show(ui, requests),
            Dialog::Export(export) => export.show(ui, session, &mut settings.exports, *preview),
            Dialog::Unwrapped(unwrapped) => unwrapped.show(ui, session),
            Dialog::Import(import) => import.show(ui),
            Dialog::Recovery(recovery) => recovery.show(ui),
            Dialog::Shape(shape) => shape.show(ui, session, requests),
            Dialog::Unsaved(unsaved) => unsaved.show(ui, session),
            Dialog::Replace(replace) => replace.show(ui),
            Dialog::Maps(maps) => maps.show(ui, session),
            Dialog::Losses(losses) => losses.show(ui),
            Dialog::Palette(palette) => palette.show(ui, session, &settings.keymap, requests),
            Dialog::News => news::show(ui),
            Dialog::About => help::show_about(ui),
            Dialog::Preferences(_) | Dialog::Path(_) => DialogAnswer::Close,
        }
    }
}

/// The button at the foot of a dialog that only shows something.
fn close(ui: &mut Ui) -> DialogAnswer {
    ui.add_space(4.0);
    let row = egui::vec2(ui.available_width(), ui.spacing().interact_size.y);
    let right = egui::Layout::right_to_left(egui::Align::Center);
    let closed =
        ui.allocate_ui_with_layout(row, right, |ui| ui.button(tr("Close")).clicked()).inner;
    // Enter on a control belongs to the control.
    let is_free = ui.memory(|memory| memory.focused().is_none());
    let is_accepted = is_free && ui.input(|i| i.key_pressed(egui::Key::Enter));
    if closed || is_accepted { DialogAnswer::Close } else { DialogAnswer::Open }
}

/// The two buttons at a dialog's foot, named in English, the affirmative one last; true for it, false for the other.
fn buttons(ui: &mut Ui, yes: &str, can: bool) -> Option<bool> {
    answers(ui, yes, "Cancel", can)
}

/// The same with a special name for canceling.
fn answers(ui: &mut Ui, yes: &str, no: &str, can: bool) -> Option<bool> {
    let mut answer = None;
    ui.add_space(4.0);
    let row = egui::vec2(ui.available_width(), ui.spacing().interact_size.y);
    ui.allocate_ui_with_layout(row, egui::Layout::right_to_left(egui::Align::Center), |ui| {
        let enter = ui.input(|i| i.key_pressed(egui::Key::Enter));
        let strong = egui::Button::new(egui::RichText::new(tr(yes)).strong())
            .fill(ui.visuals().selection.bg_fill);
        if ui.add_enabled(can, strong).clicked() || (enter && can) {
            answer = Some(true);
        }
        if ui.button(tr(no)).clicked() {
            answer = Some(false);
        }
    });
    answer
}
