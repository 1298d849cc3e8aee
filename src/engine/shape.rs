//! Floor 3: shapes for drawings that have no maps. An outline, a few numbers or a few touches
//! become heights and normals, which `combine` makes into one surface.
//!
//! [`Outline`] is what is known about a drawing, [`Form`] what is made of it: pillows (`inflate`),
//! tubes, bevels, primitives, lathes, sweeps. `touches`, `sculpt`, `relief` and `lines` change an
//! existing form. `flats` reads drawings in flat colors, whose areas are outlines. Not here: where
//! outlines come from and how parts are kept (`document::parts`), files (`io`).

pub mod bevel;
pub mod combine;
pub mod flats;
mod following;
pub mod form;
pub mod inflate;
pub mod lines;
pub mod nearest;
pub mod outline;
pub mod path;
pub mod primitive;
pub mod profiles;
pub mod relief;
pub mod rim;
pub mod sculpt;
pub mod solver;
pub mod sweep;
pub mod touches;
pub mod tube;

pub use bevel::{Bevel, BevelCurve};
pub use combine::{Combine, Relief};
pub use form::{Form, Roundness};
pub use lines::{LineForm, Lines};
pub use outline::Outline;
pub use primitive::{Body, Primitive};
pub use relief::Detail;
pub use rim::OutlineRim;
pub use sculpt::{SculptStroke, SculptTool, Sculpting};
pub use sweep::Ball;
pub use touches::{Touch, Touching};

#[cfg(test)]
mod tests;
