//! A brush's tip prepared for its dabs: pictures are blurred and textures made once, then each dab
//! is painted on its tiles. Floor 3.

use super::brush::{Brush, Tip};
use super::brush_options::Falloff;
use super::dab::{DabScratch, Footprint, PlacedDab, SoftenedStamps, TipShape, round_extent};
use super::dab_walker::Dab;
use super::dynamics::Property;
use super::image::PictureSource;
use super::scene::Scene;
use super::stroke_tile::StrokeTile;
use super::tip::hose::{DabMoment, Hose};
use super::tip::texture::TipTexture;
use crate::raster::TileAt;
use crate::surface::support::DabExtent;

/// A prepared tip.
pub enum PreparedTip {
    Round,
    Shape(TipShape, Falloff),
    /// A round tip that shines through a picture.
    Textured(SoftenedStamps),
    Stamp(SoftenedStamps),
    /// One of the stamps for each dab.
    Hose(Hose, Vec<SoftenedStamps>),
}

impl PreparedTip {
    pub fn of(brush: &Brush) -> Self {
        let is_driven = brush.dynamics.is_driven(Property::Softness);
        let softened =
            |source: &PictureSource| SoftenedStamps::of(source, brush.softness, is_driven);
        let textured = |texture: TipTexture| Self::Textured(softened(&texture.source(brush.size)));
        match &brush.tip {
            Tip::Round
                if brush.falloff == Falloff::Smooth
                    && !brush.dynamics.is_driven(Property::Elongation) =>
            {
                Self::Round
            }
            Tip::Round | Tip::Ellipse { .. } => {
                Self::Shape(TipShape::Ellipse { ratio: brush.ratio() }, brush.falloff)
            }
            Tip::Square { .. } => {
                Self::Shape(TipShape::Square { ratio: brush.ratio() }, brush.falloff)
            }
            Tip::Bristles(bristles) => textured(TipTexture::Bristles(*bristles)),
            Tip::Noise(noise) => textured(TipTexture::Noise(*noise)),
            Tip::Picture(source) => Self::Stamp(softened(source)),
            Tip::Hose(hose) => {
                Self::Hose(hose.clone(), hose.pictures().iter().map(softened).collect())
            }
        }
    }

    /// Places a dab on the canvas, with the size and density that this tip gives it.
    pub fn place<'s>(&self, dab: Dab, scene: &'s Scene) -> PlacedDab<'s> {
        let (dab, extent) = match self {
            Self::Round | Self::Textured(_) => (dab, round_extent(&dab)),
            Self::Shape(shape, falloff) => {
                let shape = shape.of_dab(&dab);
                (Dab { thin: dab.thin * shape.thinness(&dab), ..dab }, shape.extent(*falloff, &dab))
            }
            Self::Stamp(stamps) => (dab, stamps.extent(&dab)),
            Self::Hose(hose, stamps) => {
                let chosen = choice(hose, &dab);
                let dab = Dab { radius: dab.radius * hose.share(chosen), ..dab };
                // Without pictures it paints nothing.
                let nothing = DabExtent { radius_px: 0.0, filter_px: 0.0 };
                (dab, stamps.get(chosen).map_or(nothing, |stamps| stamps.extent(&dab)))
            }
        };
        PlacedDab::new(dab, scene, extent)
    }

    /// Paints a dab on a tile.
    pub fn add(
        &self,
        dab: &PlacedDab,
        at: TileAt,
        stroke_tile: &mut StrokeTile,
        scratch: &mut DabScratch,
    ) {
        match self {
            Self::Round => dab.add_round(at, stroke_tile, scratch),
            Self::Shape(shape, falloff) => {
                let footprint = Footprint::Shape(shape.of_dab(dab.dab()), *falloff);
                dab.add_covered(footprint, at, stroke_tile, scratch);
            }
            Self::Textured(stamps) => {
                dab.add_covered(Footprint::Textured(stamps), at, stroke_tile, scratch)
            }
            Self::Stamp(stamps) => dab.add_softened(stamps, at, stroke_tile, scratch),
            Self::Hose(hose, stamps) => {
                if let Some(stamps) = stamps.get(choice(hose, dab.dab())) {
                    dab.add_softened(stamps, at, stroke_tile, scratch);
                }
            }
        }
    }

    pub fn has_own_colors(&self) -> bool {
        match self {
            Self::Stamp(stamps) => stamps.is_colored(),
            Self::Hose(_, stamps) => stamps.iter().any(SoftenedStamps::is_colored),
            _ => false,
        }
    }
}

fn choice(hose: &Hose, dab: &Dab) -> usize {
    hose.choose(&DabMoment { number: dab.number, inputs: dab.inputs })
}

#[cfg(test)]
mod tests;
