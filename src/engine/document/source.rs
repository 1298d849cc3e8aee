//! What a document says about its surface: its files and what their numbers mean. Floor 4. Plain
//! data with their names in JSON. Not here: reading the files (`io::maps`).

pub use super::conventions::{
    DepthConvention, DepthEncoding, Near, NormalConvention, NormalEncoding, NormalSpace,
};

use super::{LayerTransform, TransformShape};
use crate::math::PlaneMap;
use crate::raster::Resampling;
use crate::surface::Surface;
use std::sync::Arc;

/// The `"surface"` object. At least one of `normal` and `depth`; the importer derives the other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceSource {
    /// The normal map; derived from the depth if it is absent.
    pub normal: Option<MapSource<NormalConvention>>,
    /// The depth map; derived from the normals if it is absent.
    pub depth: Option<MapSource<DepthConvention>>,
    /// Where the shape is; absent: found from alpha and background values.
    pub mask: Option<MaskSource>,
    /// `"matrix"`: canvas from the pixels of the maps, a, b, c, d, e, f: x′ = a x + c y + e, y′ = b
    /// x + d y + f. Without one the maps are as large as the canvas allows, centered.
    pub matrix: Option<[f64; 6]>,
}

impl SurfaceSource {
    /// The matrix as a map; `None` if there is none, or one that cannot be inverted.
    pub fn map(&self) -> Option<PlaneMap> {
        PlaneMap::affine(self.matrix?)
    }

    /// The same maps where they are as a surface that was made of them: with the matrix that takes
    /// them there, or without one if they are fitted to it.
    pub fn placed_as(&self, surface: &Arc<Surface>) -> Self {
        let origin = surface.origin();
        let (maps, canvas) = (origin.surface.size(), surface.size());
        let is_fitted = origin.map.is_same_on(&Surface::fit_map(maps, canvas), maps);
        let matrix = if is_fitted { None } else { origin.map.coefficients_as_written() };
        SurfaceSource { matrix, ..self.clone() }
    }

    /// Refuses, in a sentence, a matrix that files cannot hold.
    pub fn fits(&self) -> Result<(), String> {
        let Some(matrix) = self.matrix else { return Ok(()) };
        let transform =
            LayerTransform { shape: TransformShape::Matrix(matrix), filter: Resampling::default() };
        transform.fits().map_err(|why| format!("the matrix of the maps: {why}"))
    }
}

/// A file and how to read it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MapSource<C> {
    /// `"file"`.
    pub file: String,
    /// `"channel"`: which layer of an EXR (`"ViewLayer.Normal"`) or which single channel
    /// (`"ViewLayer.Depth.Z"`); detected where absent.
    pub channel: Option<String>,
    /// For normals the field `"convention"`; for depth the fields `"near"`, `"encoding"`, … next to
    /// `"file"`.
    pub convention: C,
}

/// `"mask"`: where the surface is.
#[derive(Clone, Debug, PartialEq)]
pub enum MaskSource {
    /// `{ "file": "m.png", "channel": "objectid.A", "invert": false }`
    File {
        /// The name of the file.
        file: String,
        /// The channel of it.
        channel: Option<String>,
        /// It is black where the shape is.
        invert: bool,
    },
    /// `{ "from": "flat" }`: pixels whose normal is exactly flat and that are joined to the border
    /// are background.
    Flat,
}
