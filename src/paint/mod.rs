//! Floor 3: marks. Each is a footprint (*where*: operator, anchors, weights) times a source (*what*: tip, ramp, image),
//! evaluated over tiles. It knows nothing of the layer tree.

pub mod adjust;
pub mod brush;
mod dab;
pub mod gradient;
pub mod image;
mod patches;
mod path;
mod profile;
mod ramp;
pub mod scene;
mod stamp;
pub mod stroke;
mod wash;

pub use adjust::Adjust;
pub use brush::{Brush, Drive, Dynamics, Tip};
pub use gradient::{Gradient, Stop};
pub use image::{PictureSource, PlacedImage, Placement};
pub use scene::{Filter, Scene};
pub use stroke::{Sample, Stroke};
