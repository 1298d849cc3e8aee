//! Tips: what a dab looks like before it is bent.
//! Floor 3.
//!
//! | tip | evaluated |
//! |---|---|
//! | round | in closed form (`profile`) |
//! | ellipse, square | in closed form, in a space where they are a disc and a square (`dab::shape`) |
//! | bristles, noise | a round tip times a texture made once (`texture`) |
//! | picture | read like a placed image (`stamp`) |
//! | hose | one of several pictures (`hose`) |

pub mod hose;
pub mod texture;

pub use hose::{Hose, HoseRank, RankSelect};
pub use texture::{Bristles, Noise, TipTexture};
