//! A brush's tip made ready for its dabs: pictures blurred, textures made, and each dab put on its tiles.
//! Floor 3.

use super::hose::{Hose, Moment};
use super::shape::Shape;
use super::texture::TipTexture;
use crate::paint::brush::{Brush, Tip};
use crate::paint::dab::{DabScratch, Footprint, PlacedDab, round_extent};
use crate::paint::dynamics::Property;
use crate::paint::image::PictureSource;
use crate::paint::laying::Dab;
use crate::paint::scene::Scene;
use crate::paint::stamp::Softened;
use crate::paint::wash::Wash;
use crate::raster::TileAt;
use crate::raster::tile::TILE_AREA;
use crate::surface::reach::Extent;

/// A tip, ready to be put down.
pub enum LaidTip {
    Round,
    Shape(Shape),
    /// A round tip that shines through a picture.
    Textured(Softened),
    Stamp(Softened),
    /// One of the stamps each time.
    Hose(Hose, Vec<Softened>),
}

/// What grain leaves of each pixel of a tile.
pub type GrainTile = [f32; TILE_AREA];

impl LaidTip {
    pub fn of(brush: &Brush) -> Self {
        let is_driven = brush.dynamics.drive(Property::Softness);
        let softened = |source: &PictureSource| Softened::of(source, brush.softness, is_driven);
        let textured = |texture: TipTexture| Self::Textured(softened(&texture.source(brush.size)));
        match &brush.tip {
            Tip::Round => Self::Round,
            Tip::Ellipse { ratio } => Self::Shape(Shape::Ellipse { ratio: *ratio }),
            Tip::Square { ratio } => Self::Shape(Shape::Square { ratio: *ratio }),
            Tip::Bristles(bristles) => textured(TipTexture::Bristles(*bristles)),
            Tip::Noise(noise) => textured(TipTexture::Noise(*noise)),
            Tip::Picture(source) => Self::Stamp(softened(source)),
            Tip::Hose(hose) => Self::Hose(hose.clone(), hose.pictures().iter().map(softened).collect()),
        }
    }
    /// A dab on the canvas, as large and as dense as this tip makes it.
    pub fn place<'s>(&self, dab: Dab, scene: &'s Scene) -> PlacedDab<'s> {
        let (dab, extent) = match self {
            Self::Round | Self::Textured(_) => (dab, round_extent(&dab)),
            Self::Shape(shape) => (Dab { flow: dab.flow * shape.thinness(&dab), ..dab }, shape.extent(&dab)),
            Self::Stamp(stamps) => (dab, stamps.extent(&dab)),
            Self::Hose(hose, stamps) => {
                let chosen = choice(hose, &dab);
                let dab = Dab { radius: dab.radius * hose.share(chosen), ..dab };
                // Without pictures it is nothing, anywhere.
                let nothing = Extent { radius_px: 0.0, filter_px: 0.0 };
                (dab, stamps.get(chosen).map_or(nothing, |stamps| stamps.extent(&dab)))
            }
        };
        PlacedDab::new(dab, scene, extent)
    }
    /// Puts a dab on a tile.
    pub fn add(
        &self,
        dab: &PlacedDab,
        at: TileAt,
        grain: Option<&GrainTile>,
        wash: &mut Wash,
        scratch: &mut DabScratch,
    ) {
        match self {
            Self::Round if grain.is_none() => dab.add_round(at, wash, scratch),
            Self::Round => dab.add_covered(Footprint::Round, grain, at, wash, scratch),
            Self::Shape(shape) => dab.add_covered(Footprint::Shape(*shape), grain, at, wash, scratch),
            Self::Textured(stamps) => dab.add_covered(Footprint::Textured(stamps), grain, at, wash, scratch),
            Self::Stamp(stamps) => dab.add_softened(stamps, grain, at, wash, scratch),
            Self::Hose(hose, stamps) => {
                if let Some(stamps) = stamps.get(choice(hose, dab.dab())) {
                    dab.add_softened(stamps, grain, at, wash, scratch);
                }
            }
        }
    }
    pub fn brings_colors(&self) -> bool {
        match self {
            Self::Stamp(stamps) => stamps.is_colored(),
            Self::Hose(_, stamps) => stamps.iter().any(Softened::is_colored),
            _ => false,
        }
    }
}

fn choice(hose: &Hose, dab: &Dab) -> usize {
    hose.choose(&Moment { number: dab.number, readings: dab.readings })
}
