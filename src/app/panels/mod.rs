//! Panels: functions of what there is, `(ui, &session, &mut asked)`. What a panel remembers of itself (an open row, a text being
//! typed) is egui's to keep.
//! Floor 7.

pub mod brushes;
pub mod colors;
pub mod history;
pub mod layers;
pub mod material;
pub mod menu;
pub mod navigator;
pub mod options;
pub mod properties;
pub mod status;
pub mod surface;
pub mod tools;
