//! Floor 3: shapes for drawings that have no maps. From an outline, a few numbers or a few touches to heights and
//! normals, which `combine` makes into one surface.
//!
//! [`Outline`] is what is known of a drawing, [`Form`] what is made of it: pillows (`inflate`), tubes, bevels,
//! primitives, lathes, sweeps. `touches`, `sculpt`, `relief` and `lines` change a form that is there. Not here: where
//! outlines come from and how parts are kept (`document::parts`), files (`io`).

pub mod form;
pub mod inflate;
pub mod nearest;
pub mod outline;
pub mod path;
pub mod rim;
pub mod tube;

pub use form::{Form, Roundness};
pub use outline::Outline;
pub use rim::Rim;

#[cfg(test)]
mod tests;
