//! Tips: what a dab looks like before it is bent.
//! Floor 3.
//!
//! | tip | evaluated |
//! |---|---|
//! | round | in closed form (`profile`) |
//! | ellipse, square | in closed form, in a space where they are a disc and a square (`shape`) |
//! | bristles, noise | a round tip times a texture made once (`texture`) |
//! | picture | read like a placed image (`stamp`) |
//! | hose | one of several pictures (`hose`) |

pub mod hose;
mod prepared;
pub mod shape;
pub mod texture;

pub use hose::{Hose, HoseRank, RankSelect};
pub(super) use prepared::PreparedTip;
pub use shape::TipShape;
pub use texture::{Bristles, Noise, TipTexture};

#[cfg(test)]
mod tests;
