//! A document in another color profile: assigned, its numbers stay; converted, its colors stay.
//! Floor 5. Not here: where a document has colors (`document::colors`), ICC profiles
//! (`icc_profiles`).
//!
//! A document's pictures hold numbers in its profile. A file that says Display P3 is read as such
//! ([`Budget::profile`]); a picture whose numbers changed has no file any more, and is stored as
//! one made here. SVG drawings stay drawings: their colors are rewritten.

#![warn(missing_docs)]

use crate::document::{ColorMap, Document, Layer};
use crate::math::srgb::Color;
use crate::math::{ColorProfile, ProfileConversion, Size};
use crate::raster::{Picture, TileGrid};
use crate::{Budget, picture, svg};
use std::path::Path;
use std::sync::Arc;

rilievo_engine::named! {
    /// How a document gets another color profile.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum ProfileChange {
        /// Its numbers change.
        Convert = "convert" => ("Convert", "Colors stay as they are; numbers change"),
        /// Its colors change.
        Assign = "assign" => ("Assign", "Numbers stay as they are; colors change"),
    }
}

/// The document in another profile, its numbers as they are: its colors change.
pub fn assign(document: &Document, profile: ColorProfile) -> Document {
    document.with_colors_mapped(profile, &mut SameNumbers).reshaped()
}

/// A document in another profile.
pub struct ConvertedDocument {
    /// The document.
    pub document: Document,
    /// The profile lacks some of its colors; they became the nearest it has.
    pub is_clamped: bool,
}

/// The document in another profile, its colors as they are: its numbers change.
pub fn convert(document: &Document, profile: ColorProfile, budget: &Budget) -> ConvertedDocument {
    let Some(by) = document.profile.conversion_to(profile) else {
        return ConvertedDocument { document: document.clone(), is_clamped: false };
    };
    let mut map = SameColors { profile, by, budget, is_clamped: false };
    let document = document.with_colors_mapped(profile, &mut map).reshaped();
    ConvertedDocument { document, is_clamped: map.is_clamped }
}

/// A picture of a document in a profile, for a document in another one. A file that was read for
/// sRGB and says Display P3 is read again, as wide as it is.
pub fn convert_picture(
    picture: &Picture,
    from: ColorProfile,
    profile: ColorProfile,
    budget: &Budget,
) -> Picture {
    match from.conversion_to(profile) {
        Some(by) => SameColors { profile, by, budget, is_clamped: false }.picture(picture),
        None => picture.clone(),
    }
}

/// Layers of a document in a profile, for a document in another one.
pub fn convert_layers(
    layers: Vec<Layer>,
    from: ColorProfile,
    profile: ColorProfile,
    budget: &Budget,
) -> Vec<Layer> {
    let Some(by) = from.conversion_to(profile) else { return layers };
    let mut map = SameColors { profile, by, budget, is_clamped: false };
    let layers = layers.into_iter().map(Arc::new).collect();
    let document = Document { layers, ..Document::empty(Size::new(1, 1)) };
    let converted = document.with_colors_mapped(profile, &mut map).layers;
    converted.into_iter().map(Arc::unwrap_or_clone).collect()
}

/// The profile of a new document of a picture: that of its file.
pub fn own_profile(picture: &Picture) -> ColorProfile {
    match is_file_in_p3(picture, &Budget::default()) {
        true => ColorProfile::DisplayP3,
        false => ColorProfile::Srgb,
    }
}

/// Straight RGBA bytes of a document as sRGB, for those who know nothing else.
pub fn show_in_srgb(rgba: &mut [u8], profile: ColorProfile) {
    let Some(by) = profile.conversion_to(ColorProfile::Srgb) else { return };
    let mut last = ([0; 4], [0; 4]);
    for texel in rgba.as_chunks_mut::<4>().0 {
        if *texel != last.0 {
            last = (*texel, by.texel8(*texel, &mut false));
        }
        *texel = last.1;
    }
}

/// Whether a picture's file says Display P3: its numbers depend on the document's profile.
fn is_file_in_p3(picture: &Picture, budget: &Budget) -> bool {
    let profile =
        |file: &crate::raster::Asset| picture::profile_of(Path::new(""), file.bytes(), budget);
    picture.encoded.as_ref().map(profile) == Some(ColorProfile::DisplayP3)
}

struct SameNumbers;

impl ColorMap for SameNumbers {
    fn color(&mut self, color: Color) -> Color {
        color
    }

    fn tiles(&mut self, tiles: &TileGrid) -> TileGrid {
        tiles.clone()
    }

    fn picture(&mut self, picture: &Picture) -> Picture {
        // Its file would give other numbers.
        let is_in_p3 = is_file_in_p3(picture, &Budget::default());
        let encoded = picture.encoded.clone().filter(|_| !is_in_p3);
        Picture { encoded, ..picture.clone() }
    }
}

struct SameColors<'b> {
    profile: ColorProfile,
    by: &'static ProfileConversion,
    budget: &'b Budget,
    is_clamped: bool,
}

impl ColorMap for SameColors<'_> {
    fn color(&mut self, color: Color) -> Color {
        self.is_clamped |= self.by.is_clamping(color);
        self.by.color(color)
    }

    fn tiles(&mut self, tiles: &TileGrid) -> TileGrid {
        let (next, is_clamped) = tiles.converted(self.by);
        self.is_clamped |= is_clamped;
        next
    }

    fn picture(&mut self, picture: &Picture) -> Picture {
        let budget = Budget { profile: self.profile, ..*self.budget };
        let (file, encoded) = (Path::new("picture"), picture.encoded.as_ref());
        let again = match encoded {
            // As wide as its file is.
            Some(asset) if is_file_in_p3(picture, &budget) => {
                picture::decode(file, asset.bytes(), &budget).ok()
            }
            Some(asset) if picture.drawing.is_some() => {
                let recolored =
                    svg::recolor(file, asset.bytes(), &budget, |color| self.by.color(color));
                recolored.and_then(|svg| picture::decode(file, &svg, &budget)).ok()
            }
            _ => None,
        };
        again.filter(|again| again.size == picture.size).unwrap_or_else(|| {
            let (next, is_clamped) = picture.converted(self.by);
            self.is_clamped |= is_clamped;
            next
        })
    }
}

#[cfg(test)]
mod tests;
