//! How a mark samples its source.
//! Floor 3.

pub use crate::surface::Scene;

crate::named! {
    /// How an image is read through its deformation.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
    pub enum ImageFilter {
        /// Filtered over the pixel's footprint in the image plane.
        #[default]
        Antialias = "antialias",
        /// One bilinear tap at D(q): the exact, unfiltered result.
        Bilinear = "bilinear",
    }
}
