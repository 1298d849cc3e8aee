//! The About dialog.
//! Floor 7.

use super::{DialogAnswer, close, set_width};
use crate::language::tr;
use crate::tr;
use eframe::egui::Ui;

pub fn show_about(ui: &mut Ui) -> DialogAnswer {
    set_width(ui, 360.0);
    ui.heading("Rilievo");
    ui.label(tr!("Version {version}", version = crate::io::version()));
    ui.label(tr("Paint on the picture of a shape: brushes, gradients and photos bend over its normals and depth."));
    ui.weak(tr("It implements “Surface Flows for Image-based Shading Design” (2012) and \
         “Radiance Scaling for Versatile Surface Enhancement” (2010)."));
    close(ui)
}
