//! Panels: functions `(ui, &session, &mut requests)`. egui stores the state of a panel itself (an open row, a text
//! being typed). Floor 7.

mod assistants;
mod brush;
pub mod brush_mode;
pub mod brushes;
pub mod colors;
mod crop;
mod curve;
pub mod fill;
pub mod history;
mod home;
pub mod layers;
mod liquify;
pub mod mask;
pub mod material;
pub mod menu;
pub mod navigator;
pub mod options;
pub mod properties;
mod select;
mod setter;
pub mod shape;
mod shaping;
pub mod status;
pub mod strokes;
pub mod surface;
pub mod tools;
mod transform;

rilievo_engine::named! {
    /// A panel that can stand beside the canvas or in a window of its own.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum PanelKind {
        Color = "Colour",
        Brushes = "Brushes",
        Properties = "Properties",
        Surface = "Surface",
        History = "History",
        Navigator = "Navigator",
        /// Below the others, as the parts of the shape.
        Layers = "Layers",
        Shape = "Shape",
    }
}

impl PanelKind {
    /// Whether it stands below, where the layers are.
    pub fn is_below(self) -> bool {
        matches!(self, PanelKind::Layers | PanelKind::Shape)
    }
}
