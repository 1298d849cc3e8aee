//! Floor 3: light. Materials lit by lights or environments, and radiance scaling, on the document's
//! normals.
//!
//! [`scaling`] is the paper's function σ; [`radiance`] applies it to the layers beneath,
//! [`material`] to each term of a lit material. [`features`] selects the curvature that drives it.
//! Colors are linear light inside.

mod ball_strokes;
pub mod environment;
pub mod features;
pub mod light;
pub mod material;
pub mod mood;
mod painter;
mod pixel;
pub mod radiance;
mod repainted;
pub mod scaling;
mod shadow;
mod solid_glass;
pub mod sphere;
pub mod surface_row;

pub use crate::math::NumberSetting;
pub use ball_strokes::BallStrokes;
pub use environment::{Environment, Projection};
pub use features::{FeatureScale, Features};
pub use light::{Light, LightKind};
pub use material::{Model, Shading, Term};
pub use mood::Mood;
pub use painter::Painter;
pub use pixel::PixelShading;
pub use radiance::RadianceScaling;
pub use scaling::{Reference, Scaling};
pub use shadow::Shadows;
pub use solid_glass::SolidGlass;
pub use sphere::LitSphere;
