//! Panels: functions `(ui, &session, &mut requests)`. egui stores the state of a panel itself (an
//! open row, a text being typed). Floor 7.

pub mod adjustment;
mod assistants;
mod attachment;
mod balls;
mod brush;
pub mod brush_mode;
pub mod brushes;
pub mod colors;
mod crop;
pub mod curve;
pub mod effects;
pub mod fill;
mod form_drawing;
pub mod gradient;
pub mod history;
pub mod layers;
mod liquify;
pub mod mask;
pub mod material;
pub mod menu;
pub mod navigator;
pub mod options;
mod painter;
pub mod properties;
mod ramp;
mod select;
mod setter;
pub mod shape;
mod shaping;
pub mod start;
pub mod status;
pub mod strokes;
pub mod surface;
pub mod text;
pub mod tools;
mod transform;
