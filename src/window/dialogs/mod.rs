//! Dialogs: one at a time, over the window. Each is a struct that holds what was typed and a function that shows it.
//! Floor 7.

pub mod export;
pub mod help;
pub mod import;
pub mod new;
pub mod palette;
pub mod path;
pub mod recovery;
pub mod shortcuts;
pub mod unsaved;

use super::asked::{Asked, WindowAsk};
use super::files::Purpose;
use super::keymap::Keymap;
use crate::document::SurfaceSource;
use crate::io::maps;
use crate::io::recovery::Session as Lost;
use crate::session::Session;
use eframe::egui::{self, Id, Modal, Ui};
use std::path::PathBuf;

/// The dialog that is open.
pub enum Dialog {
    New(new::New),
    Export(export::Export),
    Import(Box<import::Import>),
    Path(path::PathDialog),
    Recovery(recovery::Recovery),
    Unsaved(unsaved::Unsaved),
    Palette(palette::Palette),
    Shortcuts(shortcuts::Shortcuts),
    About,
}

/// What a dialog came to.
pub enum Answer {
    /// It stays open.
    Open,
    Close,
    Chosen(Purpose, PathBuf),
    /// These maps are to be read.
    Import(Box<SurfaceSource>),
    /// The document that was made of them.
    Imported(import::Made),
    /// The maps that the document in front is to have.
    Replaced(Box<(SurfaceSource, maps::Import)>),
    /// Lose what is not saved, and do this.
    Discard(Then),
    /// Save first, then do this.
    SaveThen(Then),
    Ask(WindowAsk),
    /// Bring these drawings back.
    Recover(Vec<Lost>),
    /// The user said that this drawing is to be deleted.
    Delete(Lost),
}

/// What follows a question about unsaved work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Then {
    Close(usize),
    Quit,
}

impl Dialog {
    /// Shows the dialog; escape and a click beside it close it. `preview`: the picture of the document in front, small.
    pub fn show(
        &mut self,
        ctx: &egui::Context,
        session: &Session,
        keymap: &mut Keymap,
        preview: Option<egui::TextureId>,
        asked: &mut Asked,
    ) -> Answer {
        let modal = Modal::new(Id::unique("dialog")).show(ctx, |ui| {
            ui.spacing_mut().item_spacing.y = 7.0;
            match self {
                Dialog::New(new) => new.show(ui, asked),
                Dialog::Export(export) => export.show(ui, session, preview),
                Dialog::Import(import) => import.show(ui),
                Dialog::Path(path) => path.show(ui),
                Dialog::Recovery(recovery) => recovery.show(ui),
                Dialog::Unsaved(unsaved) => unsaved.show(ui, session),
                Dialog::Palette(palette) => palette.show(ui, session, keymap, asked),
                Dialog::Shortcuts(shortcuts) => shortcuts.show(ui, keymap),
                Dialog::About => help::about(ui),
            }
        });
        if modal.should_close() && matches!(modal.inner, Answer::Open) { Answer::Close } else { modal.inner }
    }
}

/// The button at the foot of a dialog that only shows something.
fn close(ui: &mut Ui) -> Answer {
    ui.add_space(4.0);
    let row = egui::vec2(ui.available_width(), ui.spacing().interact_size.y);
    let right = egui::Layout::right_to_left(egui::Align::Center);
    let closed = ui.allocate_ui_with_layout(row, right, |ui| ui.button("Close").clicked()).inner;
    if closed { Answer::Close } else { Answer::Open }
}

/// The two buttons at a dialog's foot, the affirmative one last; true for it, false for the other.
fn buttons(ui: &mut Ui, yes: &str, can: bool) -> Option<bool> {
    let mut answer = None;
    ui.add_space(4.0);
    let row = egui::vec2(ui.available_width(), ui.spacing().interact_size.y);
    ui.allocate_ui_with_layout(row, egui::Layout::right_to_left(egui::Align::Center), |ui| {
        let enter = ui.input(|i| i.key_pressed(egui::Key::Enter));
        let strong = egui::Button::new(egui::RichText::new(yes).strong()).fill(ui.visuals().selection.bg_fill);
        if ui.add_enabled(can, strong).clicked() || (enter && can) {
            answer = Some(true);
        }
        if ui.button("Cancel").clicked() {
            answer = Some(false);
        }
    });
    answer
}
