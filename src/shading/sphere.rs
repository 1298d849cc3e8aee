//! A lit sphere (Sloan et al. 2001; "matcap"): a painted sphere that tells the colour of every normal.
//! Floor 3.

use crate::raster::Picture;

/// A picture whose inscribed disc is the sphere seen orthographically.
#[derive(Clone)]
pub struct LitSphere {
    /// The name it goes by in the document.
    pub file: String,
    pub picture: Picture,
}

impl LitSphere {
    pub fn new(file: String, picture: Picture) -> Self {
        Self { file, picture }
    }
}
