//! Content from what a program has in hand, so that `Layer::new` takes any of it. Floor 4.

use super::{Content, Group, NormalLayer, PixelLayer, StrokeList};
use crate::document::Live;
use crate::math::srgb::Color;
use crate::paint::{
    ColorAdjustment, Gradient, LiveAdjustment, LiveFilter, PictureFilter, PlacedImage, Stroke,
};
use crate::raster::TileGrid;
use crate::shading::{RadianceScaling, Shading};
use std::sync::Arc;

/// One color everywhere.
impl From<Color> for Content {
    fn from(color: Color) -> Self {
        Content::Fill(color)
    }
}

/// Pixels to paint on, where they lie on the canvas.
impl From<TileGrid> for Content {
    fn from(tiles: TileGrid) -> Self {
        Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() })
    }
}

/// A picture that is bent over the surface.
impl From<PlacedImage> for Content {
    fn from(image: PlacedImage) -> Self {
        Content::Image(Live::new(image))
    }
}

/// A color ramp that is bent over the surface.
impl From<Gradient> for Content {
    fn from(gradient: Gradient) -> Self {
        Content::Gradient(Live::new(gradient))
    }
}

/// A stroke that stays editable.
impl From<Stroke> for Content {
    fn from(stroke: Stroke) -> Self {
        vec![stroke].into()
    }
}

/// Strokes that stay editable, the lowest first.
impl From<Vec<Stroke>> for Content {
    fn from(strokes: Vec<Stroke>) -> Self {
        Content::Strokes(Live::new(StrokeList {
            strokes: strokes.into_iter().map(Arc::new).collect(),
        }))
    }
}

/// The surface lit.
impl From<Shading> for Content {
    fn from(shading: Shading) -> Self {
        Content::Shading(Live::new(shading))
    }
}

/// What lies beneath, brighter or darker by the curvature.
impl From<RadianceScaling> for Content {
    fn from(scaling: RadianceScaling) -> Self {
        Content::RadianceScaling(scaling)
    }
}

/// What lies beneath, its colors adjusted.
impl From<ColorAdjustment> for Content {
    fn from(adjustment: ColorAdjustment) -> Self {
        Content::Adjustment(LiveAdjustment::new(adjustment))
    }
}

/// What lies beneath, filtered.
impl From<PictureFilter> for Content {
    fn from(filter: PictureFilter) -> Self {
        Content::Filter(LiveFilter::new(filter))
    }
}

/// Detail for the surface that layers above see.
impl From<NormalLayer> for Content {
    fn from(normals: NormalLayer) -> Self {
        Content::Normals(normals)
    }
}

/// Layers, flattened together.
impl From<Group> for Content {
    fn from(group: Group) -> Self {
        Content::Group(group)
    }
}
