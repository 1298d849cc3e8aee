//! Floor 1: pixels that know nothing of the surface. Tiles and tile grids hold layers; planes and
//! textures hold what is sampled and never edited; blend modes and samplers work on both.

pub mod asset;
pub mod bits;
pub mod blend;
pub mod blur;
pub mod border;
mod converted;
pub mod coverage;
pub mod distance;
pub mod flood;
pub mod gaps;
pub mod grid;
pub mod lattice;
pub mod line_integral;
pub mod matte;
pub mod paper;
pub mod picture;
pub mod planar;
pub mod plane;
pub mod sampler;
pub mod texture;
pub mod tile;
pub mod warp;

pub use asset::Asset;
pub use blend::{BlendMode, Mix, TileCoverage, TilePaint};
pub use coverage::{CoverageGrid, CoverageTile, SelectionMode};
pub use grid::TileGrid;
pub use lattice::Lattice;
pub use matte::Matte;
pub use picture::{Picture, VectorDrawing};
pub use planar::PlanarTile;
pub use plane::Plane;
pub use texture::{FloatTexture, Outside, Texture};
pub use tile::{TILE, Tile, TileAt};
pub use warp::Resampling;
