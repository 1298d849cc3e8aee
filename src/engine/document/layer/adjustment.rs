//! What a layer that adjusts the picture beneath it implements: composed pixels in, changed colors
//! out. Floor 4. Not here: composing what lies beneath (`compose`), measuring it (`measure`).

use crate::paint::{LiveFilter, Scene};
use crate::raster::{PlanarTile, TileAt};
use crate::shading::RadianceScaling;
use crate::shading::radiance::{BackdropStats, Exactness};
use crate::surface::Surface;

/// Changes the colors of what is composed beneath a layer, in its scope.
pub trait Adjustment {
    /// How much of the picture beneath a changed pixel depends on.
    fn reach(&self) -> Reach {
        Reach::Pixel
    }

    /// The filter that it is, if it reads what lies around a pixel.
    fn filter(&self) -> Option<&LiveFilter> {
        None
    }

    /// What must be known of the whole picture beneath before a part of it can be adjusted; `None`
    /// if canceled.
    fn measure(&self, _beneath: &dyn BackdropMeter) -> Option<BackdropStats> {
        Some(BackdropStats::default())
    }

    /// Changes pixels in place: premultiplied sRGB of those that `place` names.
    ///
    /// * `beneath`: what [`Adjustment::measure`] found.
    fn adjust(
        &self,
        place: &AdjustedPlace,
        beneath: BackdropStats,
        exactness: Exactness,
        pixels: &mut PlanarTile,
    );
}

/// Measures the picture beneath an adjustment. Every figure is `None` if that is canceled.
pub trait BackdropMeter {
    /// Y*: its greatest luminance over the surface, linear light.
    fn brightest(&self) -> Option<f32>;
    /// The factor that restores its mean luminance after a scaling.
    fn gain(&self, scaling: &RadianceScaling, brightest: f32) -> Option<f32>;
}

/// How much of the picture beneath a changed pixel depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// On the pixel beneath it.
    Pixel,
    /// On what its filter reads.
    Around,
    /// On all of it.
    Picture,
}

/// Where the pixels lie that are adjusted.
pub enum AdjustedPlace<'a> {
    /// A tile of the canvas.
    Tile {
        /// What the layer sees.
        scene: &'a Scene,
        /// Which tile.
        at: TileAt,
    },
    /// Rows of pixels as the other sides of contour pixels see them.
    Packed {
        /// What they see.
        surface: Option<&'a Surface>,
        /// The surface of the canvas.
        front: Option<&'a Surface>,
        /// For each pixel its place on the surface that it sees, or that it is off it.
        places: &'a [Option<(usize, usize)>],
        /// For each pixel that of the canvas; `None` for those that fill a row.
        canvas: &'a [Option<(usize, usize)>],
    },
}
