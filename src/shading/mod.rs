//! Floor 3: light. Materials lit by lights or environments, and radiance scaling, on the document's normals.

pub mod material;
pub mod radiance;

pub use material::Shading;
pub use radiance::RadianceScaling;
