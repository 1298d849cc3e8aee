//! Views: pictures of a document's maps and of what is derived from them. Floor 4. Not here: the
//! maps and flows themselves (`surface`), files (`io`), the command (`cli::view`).

mod contact_sheet;
mod flows;
mod maps;
mod scaling;
mod unwrapped;
mod weights;
pub mod wobble;

pub use contact_sheet::sheet;
pub use unwrapped::{UnwrapOptions, UnwrappedPicture, place_over, render_unwrapped};
pub use weights::color_of as anchor_color;

use super::{Document, Layer, Progress};
use crate::math::{Size, srgb::quantize};
use crate::raster::{Picture, Plane};
use crate::surface::{Bend, Surface};

crate::named! {
    /// What a view shows.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub enum SurfaceView {
        /// R = x right, G = y up, B = z to the viewer; ½ is 0.
        Normals = "normals",
        /// Black near, white far.
        Depth = "depth",
        /// White where the surface is.
        Mask = "mask",
        /// The objects into which depth jumps split the surface: a color for each.
        Objects = "objects",
        /// Convex blue, concave red, flat yellow.
        Curvature = "curvature",
        /// Convex light, concave dark.
        CurvatureGray = "curvature-gray",
        /// Lines along the direction that curves most.
        Directions = "directions",
        /// A layer's anchors and how they share the surface (SF fig. 9).
        Weights = "weights",
        /// T_p: how a texture on the surface is squeezed (SF fig. 2).
        FlowDepth = "flow-depth",
        /// T_n: how a reflection is squeezed (SF fig. 2).
        FlowNormals = "flow-normals",
        /// ∂D/∂q: how a layer's operator squeezes its image (SF fig. 3c).
        FlowOperator = "flow-operator",
        /// σ over δ for several κ, at α = 0.2 and 0.8 (RS fig. 2): needs no document.
        Scaling = "scaling",
        /// The painting, or one layer, as it lies in the plane of the surface unwrapped: what D_s
        /// prints from.
        Unwrapped = "unwrapped",
        /// The surface and a ball next to it under one light: if they agree, the maps are read the
        /// right way round.
        Lit = "lit",
        /// Unpainted, in even light from above left.
        Clay = "clay",
        /// Lines of equal depth, every fourth a strong one.
        Contours = "contours",
    }
}

impl SurfaceView {
    /// Whether it shows no document.
    pub fn is_of_nothing(self) -> bool {
        self == SurfaceView::Scaling
    }

    /// Whether it shows a layer's anchors or operator, and so needs a layer that has them.
    pub fn is_of_layer(self) -> bool {
        matches!(self, SurfaceView::Weights | SurfaceView::FlowOperator)
    }
}

/// How curvature and flows are shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewOptions {
    /// *s* of κ, px.
    pub curvature_scale_px: f32,
    /// Standard deviation of the blur of normals and flows, px. One pixel suppresses the noise of
    /// 8-bit maps.
    pub blur_px: f32,
}

impl Default for ViewOptions {
    fn default() -> Self {
        Self { curvature_scale_px: 4.0, blur_px: 1.0 }
    }
}

/// Why there is nothing to show.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ViewUnavailable {
    /// There is no surface.
    #[error("the document has no surface to show")]
    NoSurface,
    /// Nothing is unwrapped.
    #[error("no two neighboring pixels of the surface are in the plane")]
    NothingUnwrapped,
    /// It does not fit in memory.
    #[error("there is no memory for the picture")]
    NoMemory,
    /// No layer has anchors.
    #[error("the document has no layer with anchors")]
    NoAnchoredLayer,
    /// A layer has no anchors.
    #[error("the layer “{0}” has no anchors; image and gradient layers have them")]
    NoAnchors(String),
}

/// Draws a view. `layer`: the layer whose anchors or operator are shown; by default the topmost
/// that has them.
pub fn draw(
    document: &Document,
    layer: Option<&Layer>,
    view: SurfaceView,
    options: &ViewOptions,
) -> Result<Picture, ViewUnavailable> {
    let surface = || document.surface.as_deref().ok_or(ViewUnavailable::NoSurface);
    Ok(match view {
        SurfaceView::Normals => maps::normals(surface()?),
        SurfaceView::Depth => maps::depth(surface()?),
        SurfaceView::Mask => maps::mask(surface()?),
        SurfaceView::Objects => maps::objects(surface()?),
        SurfaceView::Curvature => maps::curvature(surface()?, options),
        SurfaceView::CurvatureGray => maps::curvature_gray(surface()?, options),
        SurfaceView::Lit => maps::render_lit(surface()?),
        SurfaceView::Clay => maps::clay(surface()?),
        SurfaceView::Contours => maps::contours(surface()?),
        SurfaceView::Scaling => scaling::plots().ok_or(ViewUnavailable::NoMemory)?,
        SurfaceView::Unwrapped => {
            let seen =
                render_unwrapped(document, layer, UnwrapOptions::default(), &Progress::default())?;
            seen.picture().ok_or(ViewUnavailable::NoMemory)?
        }
        SurfaceView::Directions => flows::directions(surface()?, options),
        SurfaceView::FlowDepth => flows::of_depth(surface()?, options),
        SurfaceView::FlowNormals => flows::of_normals(surface()?, options),
        SurfaceView::FlowOperator => flows::of_operator(
            document.surface.as_deref(),
            document.size,
            &bend(document, layer)?,
            options,
        ),
        SurfaceView::Weights => {
            weights::weights(document.surface.as_deref(), document.size, &bend(document, layer)?)
        }
    })
}

/// The views that show something for this document.
pub fn available(document: &Document, layer: Option<&Layer>) -> Vec<SurfaceView> {
    let can = |view: SurfaceView| match view {
        SurfaceView::Weights => bend(document, layer).is_ok(),
        SurfaceView::FlowOperator => bend(document, layer).is_ok(),
        // One shows nothing of this document, the other has a size of its own: they are shown
        // alone.
        SurfaceView::Scaling | SurfaceView::Unwrapped => false,
        _ => document.surface.is_some(),
    };
    SurfaceView::ALL.iter().map(|(view, _)| *view).filter(|&view| can(view)).collect()
}

/// A layer's operator, anchors and weights.
fn bend(document: &Document, layer: Option<&Layer>) -> Result<Bend, ViewUnavailable> {
    let of = |layer: &Layer| layer.content.bend().filter(|bend| !bend.anchors.is_empty());
    match layer {
        Some(layer) => of(layer).ok_or_else(|| ViewUnavailable::NoAnchors(layer.name.clone())),
        None => document
            .walk()
            .into_iter()
            .rev()
            .find_map(|(_, layer)| of(layer))
            .ok_or(ViewUnavailable::NoAnchoredLayer),
    }
}

/// A picture from a color per pixel, encoded, each in `[0, 1]`; transparent where the surface does
/// not cover.
fn paint_pixels(
    size: Size,
    coverage: Option<&Surface>,
    color: impl Fn(usize, usize) -> [f32; 3] + Sync,
) -> Picture {
    let texels = Plane::from_fn(size, |x, y| {
        let [r, g, b] = color(x, y).map(quantize);
        [r, g, b, coverage.map_or(255, |s| s.coverage(x, y))]
    });
    Picture::srgb8(size, texels.into_values()).expect("a canvas has pixels, and each got its color")
}

#[cfg(test)]
mod tests;
