//! Floor 2: the surface that is painted on, and how an image bends over it.
//!
//! [`Surface`] holds the maps in one convention (camera space, image axes for n̄, depth 0 near … 1 far); other
//! conventions exist only inside the readers of files (`io::maps`). [`operator`] holds the equations, [`anchor`] the
//! points where an image is pinned, and [`deformation`] evaluates them over tiles.

pub mod anchor;
mod cache;
pub mod combine;
pub mod contours;
mod creases;
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
mod pyramid;
pub mod reach;
pub mod region;
pub mod scene;
mod springs;
pub mod support;
pub mod through;
pub mod unwrap;
pub mod view;

pub use anchor::{Anchor, Bend, Weights};
pub use combine::DetailMap;
pub use contours::{ContourPixel, Contours};
pub use curvature::Curvature;
pub use deformation::Deformation;
pub use flow::{FlowField, StructureTensor};
pub use grain::NoiseRelief;
pub use grow::KnownNearest;
pub use maps::{Maps, Surface, SurfaceError};
pub use objects::{Objects, PaintLimit};
pub use operator::Operator;
pub use reach::DabReach;
pub use scene::Scene;
pub use support::SupportBounds;
