//! Floor 2: the shape that is painted on, and how an image bends over it.
//!
//! [`Surface`] holds the maps in one convention (camera space, image axes for n̄, depth 0 near … 1 far); nothing above
//! the door (`io`) knows of any other. [`operator`] holds the equations, [`anchor`] where they are pinned,
//! [`deformation`] evaluates them over tiles.

pub mod anchor;
mod bounds;
pub mod combine;
pub mod curvature;
pub mod deformation;
pub mod differentiate;
pub mod fit;
pub mod flow;
pub mod grain;
pub mod grow;
pub mod integrate;
mod kept;
pub mod links;
pub mod maps;
pub mod objects;
mod occlusion;
pub mod operator;
pub mod reach;
pub mod scene;

pub use anchor::{Anchor, Bend, Weights};
pub use combine::DetailMap;
pub use curvature::Curvature;
pub use deformation::Deformation;
pub use flow::{Flow, Tensor};
pub use grain::Grain;
pub use maps::{Maps, Surface, SurfaceError};
pub use objects::{Bounded, Objects};
pub use operator::Operator;
pub use reach::Reach;
pub use scene::Scene;
