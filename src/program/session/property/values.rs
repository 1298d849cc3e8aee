//! The values of properties in replays.
//! Floor 6.

use crate::document::{DerivedMask, Layer, LayerLabel, LayerLock, LayerMask, LayerTransform};
use crate::io::json::JsonNode;
use crate::io::recipe::transforms;
use crate::paint::{
    Adjust, ColorAdjustment, DrawingHand, EffectLight, GradientStop, ImageFilter, LayerEffect,
    LivePath, PictureFilter, Placement, Text,
};
use crate::raster::{BlendMode, Outside};
use crate::session::replay::{as_in_recipes, names};
use crate::shading::scaling::Reference;
use crate::shading::{
    BallStrokes, Features, Light, Model, Mood, Painter, PixelShading, Projection, Scaling, Shadows,
    SolidGlass, Term,
};
use crate::surface::form_lines::LineSettings;
use crate::surface::hatching::HatchSettings;
use crate::surface::plane_piece::PlanePiece;
use crate::surface::{Anchor, NoiseRelief, Operator};

names!(BlendMode);
names!(LayerLabel);
names!(LayerLock);
names!(ImageFilter);
names!(Outside);
names!(Model);
names!(Projection);
names!(Mood);
as_in_recipes!(Operator, Anchor, PlanePiece, Placement, Adjust, GradientStop);
as_in_recipes!(ColorAdjustment, PictureFilter, Text, LivePath, LayerEffect, EffectLight);
as_in_recipes!(NoiseRelief, DerivedMask, Light, Term, Scaling, Features, Reference);
as_in_recipes!(Shadows, Painter, PixelShading, BallStrokes, SolidGlass);
as_in_recipes!(LineSettings, HatchSettings, DrawingHand);

/// As documents write it.
impl crate::session::replay::ReplayValue for LayerTransform {
    fn to_value(&self) -> serde_json::Value {
        transforms::write(self)
    }

    fn read(value: &serde_json::Value) -> Result<Self, String> {
        transforms::read(&JsonNode::root(std::path::Path::new("transform"), value), None)
            .map_err(|error| error.to_string())
    }
}

/// Gives a layer a derived mask, or none; inversion and enabling stay.
pub(super) fn set_mask(layer: &mut Layer, mask: Option<DerivedMask>) {
    let invert = layer.mask.as_ref().is_some_and(|mask| mask.invert);
    layer.mask = mask.map(|kind| LayerMask { invert, ..LayerMask::new(kind) });
}
