//! Floor 3: marks. Each is a footprint (*where*: operator, anchors, weights) times a source (*what*: tip, ramp, image),
//! evaluated over tiles. It knows nothing of the layer tree.

pub mod adjust;
pub mod brush;
pub mod calm;
mod curve;
mod dab;
pub mod dynamics;
pub mod fill;
pub mod gradient;
pub mod grain;
pub mod image;
mod laying;
mod patches;
pub mod pattern;
pub mod picking;
mod profile;
mod ramp;
pub mod retouch;
pub mod scene;
mod stamp;
pub mod stroke;
mod tint;
pub mod tip;
mod wash;

pub use adjust::Adjust;
pub use brush::{Brush, Facing, Jitter, Mark, Stabilizer, Tip};
pub use calm::Calm;
pub use dynamics::{Curve, Drive, Dynamics, Input, Property, Readings};
pub use fill::Fill;
pub use gradient::{Gradient, Stop};
pub use image::{PictureSource, PlacedImage, Placement};
pub use retouch::Retouching;
pub use scene::{Filter, Scene};
pub use stroke::{Ground, InHand, Sample, Stroke};
