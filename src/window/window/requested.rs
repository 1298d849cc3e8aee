//! Requests of panels and menus to the window alone: dialogs, the layout of panels, the size of the
//! interface. Floor 7.

use super::MainWindow;
use crate::dialogs::{
    Dialog, canvas, edge, import, looks, materials, new, paint_change, palette, panels,
    preferences, profile,
};
use crate::file_purpose::FilePurpose;
use crate::requests::WindowRequest;
use eframe::egui::{self, ViewportCommand};

impl MainWindow {
    pub(super) fn do_request(&mut self, ctx: &egui::Context, ask: WindowRequest) {
        match ask {
            WindowRequest::NewDialog => self.dialogs.push(Dialog::New(new::NewDialog::default())),
            WindowRequest::OpenDialog => self.ask_for(FilePurpose::Open, ""),
            WindowRequest::OpenMapsDialog => self.dialogs.push(Dialog::Import(Box::default())),
            WindowRequest::ReplaceMapsDialog => {
                let source =
                    self.session.active().and_then(|open| open.document().surface_source.clone());
                let import = import::ImportDialog::replacing(source.as_deref());
                self.dialogs.push(Dialog::Import(Box::new(import)));
            }
            WindowRequest::PartMapsDialog => {
                self.dialogs.push(Dialog::Import(import::ImportDialog::for_part().into()))
            }
            WindowRequest::ShapeDialog => self.look_for_drawing(),
            WindowRequest::Choose(purpose) => self.ask_for(purpose, ""),
            WindowRequest::PlaceDialog => self.ask_for(FilePurpose::Place, ""),
            WindowRequest::Open(file) => self.open_files(vec![file], None),
            WindowRequest::OpenSample(index) => self.open_sample(index),
            WindowRequest::Save => self.save(None),
            WindowRequest::SaveAs => self.save_as(None),
            WindowRequest::ExportDialog => self.ask_how_to_export(),
            WindowRequest::ExportAgain => self.export_again(),
            WindowRequest::ExportMapsDialog => self.dialogs.push(Dialog::Maps(self.maps.clone())),
            WindowRequest::ExportMaps => self.ask_where(FilePurpose::ExportMaps),
            WindowRequest::KeptShare(share) => self.settings.kept_share = share,
            WindowRequest::CopyText(text) => ctx.copy_text(text),
            WindowRequest::Say(sentence) => self.jobs.say(sentence),
            WindowRequest::Wobble => self.canvas.wobble(ctx, &self.session),
            WindowRequest::Export(extension) => {
                self.export.extension = extension;
                self.ask_where(FilePurpose::Export);
            }
            WindowRequest::ExportPalette(format) => {
                self.ask_where(FilePurpose::ExportPalette(format))
            }
            WindowRequest::ExportUnwrappedDialog => {
                self.dialogs.push(Dialog::Unwrapped(self.unwrapped.clone()))
            }
            WindowRequest::ExportUnwrapped => self.ask_where(FilePurpose::ExportUnwrapped),
            WindowRequest::ExportLines => self.ask_where(FilePurpose::ExportLines),
            WindowRequest::Unwrap => self.unwrap_surface(),
            WindowRequest::Close(index) => self.close(ctx, index),
            WindowRequest::Quit => ctx.send_viewport_cmd(ViewportCommand::Close),
            WindowRequest::CanvasSizeDialog
            | WindowRequest::ImageSizeDialog
            | WindowRequest::TurnDialog => {
                let size = self.session.active().map(|open| open.document().size);
                self.dialogs.extend(size.map(|size| canvas::dialog_for(&ask, size)));
            }
            WindowRequest::ProfileDialog => {
                let profile = self.session.active().map(|open| open.document().profile);
                let dialog = profile.map(profile::ProfileDialog::of);
                self.dialogs.extend(dialog.map(Dialog::Profile));
            }
            WindowRequest::PaintChangeDialog(change) => {
                let dialog = paint_change::PaintChangeDialog::new(*change, &self.session);
                self.dialogs.push(Dialog::PaintChange(Box::new(dialog)));
            }
            WindowRequest::EdgeDialog(change) => {
                self.dialogs.push(Dialog::Edge(edge::EdgeDialog::new(change)))
            }
            WindowRequest::KeepDialog => {
                self.dialogs.push(Dialog::Keep(edge::KeepDialog::default()))
            }
            WindowRequest::GridDialog => self.dialogs.push(Dialog::Grid),
            WindowRequest::PanelsDialog => {
                self.dialogs.extend(panels::PanelsDialog::new(&self.session).map(Dialog::Panels))
            }
            WindowRequest::LooksDialog => {
                self.dialogs.push(Dialog::Looks(Box::new(looks::LooksDialog::new(ctx))))
            }
            WindowRequest::MaterialsDialog => self.ask_for_material(ctx),
            WindowRequest::Paste(to) => self.paste(to),
            WindowRequest::Palette => {
                self.dialogs.push(Dialog::Palette(palette::CommandPalette::default()))
            }
            WindowRequest::Preferences(page) => self
                .dialogs
                .push(Dialog::Preferences(Box::new(preferences::PreferencesDialog::at(page)))),
            WindowRequest::News => self.dialogs.push(Dialog::News),
            WindowRequest::About => self.dialogs.push(Dialog::About),
            WindowRequest::Menus => {
                if ctx.input(|i| i.viewport().fullscreen.unwrap_or(false)) {
                    // Hidden panels hide the menus, too.
                    self.settings.layout.is_hidden = false;
                }
                self.menu.keys.open();
                ctx.request_repaint();
            }
            WindowRequest::SecondView => self.second_view.toggle(),
            WindowRequest::ToggleProof => self.toggle_proof(),
            WindowRequest::PasteReference => self.paste_reference(),
            WindowRequest::ToggleReferences => {
                self.settings.layout.hides_references = !self.settings.layout.hides_references;
            }
            WindowRequest::ClearReferences => self.settings.references.clear(),
            WindowRequest::TogglePanels => {
                self.settings.layout.is_hidden = !self.settings.layout.is_hidden;
                // The tab key that requested it also moved the focus to the next button.
                ctx.memory_mut(|memory| memory.stop_text_input());
            }
            WindowRequest::OtherSide => {
                self.settings.layout.side = self.settings.layout.side.other()
            }
            WindowRequest::PanelsApart => self.settings.layout.toggle_apart(),
            WindowRequest::Float(panel) => self.settings.layout.toggle_floating(panel),
            WindowRequest::ShowPanel(panel) => self.settings.layout.show(panel),
            WindowRequest::EditBrush => crate::panels::brushes::edit(ctx),
            WindowRequest::NextLook => self.show_next_look(ctx),
            WindowRequest::ToggleDetails => {
                self.settings.has_details = !self.settings.has_details;
            }
            WindowRequest::ResizeInterface { is_larger } => self.resize_interface(ctx, is_larger),
            WindowRequest::ScaleInterface(scale) => self.scale_interface(ctx, scale),
            WindowRequest::Scale(scale) => self.scale(ctx, scale),
            WindowRequest::FullScreen => {
                let is_full = ctx.input(|i| i.viewport().fullscreen.unwrap_or(false));
                ctx.send_viewport_cmd(ViewportCommand::Fullscreen(!is_full));
            }
        }
    }

    /// Shows the materials for the part that is selected.
    fn ask_for_material(&mut self, ctx: &egui::Context) {
        let part = self.session.active().and_then(|open| open.part.clone());
        let dialog = materials::MaterialsDialog::new(ctx, &self.session, part);
        self.dialogs.push(Dialog::Materials(Box::new(dialog)));
    }
}
