//! Pictures for parts, taken from layers: light and dark of one as detail, and several as shadings
//! of one drawing. Floor 6. Not here: what becomes of them (`shape::relief`, `shape::profiles`).

use super::PartRefusal;
use crate::document::parts::{CoverageFile, Part, ProfilePicture};
use crate::document::{Document, Layer, LayerId};
use crate::math::srgb::{decode, encode, luminance, quantize};
use crate::math::{Vec3, vec3};
use crate::raster::{Plane, TileGrid};
use crate::session::OpenDocument;
use crate::session::drawing::render_layer;
use crate::shape::profiles::MOST_PROFILES;
use std::sync::Arc;

const PAINTS_NOTHING: PartRefusal =
    "This layer has no paint of its own. Select one with light and dark on it.";

/// Directions of the lights of hand-made shadings, by the names of their layers; in this order if
/// the names say nothing.
const LIGHTS: [(&[&str], Vec3); MOST_PROFILES] = [
    (&["left"], vec3(-0.7, 0.0, 0.71)),
    (&["right"], vec3(0.7, 0.0, 0.71)),
    (&["top", "above", "up"], vec3(0.0, 0.7, 0.71)),
    (&["bottom", "below", "down"], vec3(0.0, -0.7, 0.71)),
    (&["front"], vec3(0.0, 0.0, 1.0)),
];

/// Names for pictures that no part uses: `outline-1.png`, …
pub fn free_files<'a>(document: &Document, stem: &'a str) -> impl Iterator<Item = String> + 'a {
    let of = |part: &Arc<Part>| {
        let mut part = Part::clone(part);
        part.files_mut().into_iter().map(|file| file.file.clone()).collect::<Vec<_>>()
    };
    let taken: Vec<String> = document.parts.list.iter().flat_map(of).collect();
    (1..).map(move |i| format!("{stem}-{i}.png")).filter(move |name| !taken.contains(name))
}

/// Light and dark of a layer, sRGB; where it covers nothing, its mean, so that its edge is no
/// detail.
pub fn detail(document: &Document, layer: LayerId) -> Result<CoverageFile, PartRefusal> {
    let tiles = render_layer(document, layer)
        .filter(|tiles| !tiles.bounds().is_empty())
        .ok_or(PAINTS_NOTHING)?;
    let straight = Plane::from_fn(document.size, |x, y| {
        let [r, g, b, a] = tiles.pixel(x as i32, y as i32);
        let whole = |v: u8| f32::from(v) / f32::from(a.max(1));
        (gray(whole(r), whole(g), whole(b)), a)
    });
    let (mut sum, mut weight) = (0.0f64, 0.0f64);
    for (gray, a) in straight.values() {
        sum += f64::from(*gray) * f64::from(*a);
        weight += f64::from(*a);
    }
    let mean = (sum / weight.max(1.0)) as f32;
    let coverage = straight.map(|(gray, a)| quantize(mean + (gray - mean) * f32::from(a) / 255.0));
    let file = free_files(document, "relief").next().ok_or(PAINTS_NOTHING)?;
    Ok(CoverageFile { file, coverage: Arc::new(coverage) })
}

/// The selected layers as shadings, the lowest first.
pub fn shadings(open: &OpenDocument) -> Result<Vec<ProfilePicture>, PartRefusal> {
    let (document, selected) = (open.document(), open.selected_layers());
    let all = document.walk().into_iter().map(|(_, layer)| layer);
    let layers: Vec<&Arc<Layer>> = all.filter(|layer| selected.contains(&layer.id)).collect();
    if !(2..=MOST_PROFILES).contains(&layers.len()) {
        return Err(
            "Select two to five layers with Ctrl, each a shading of the drawing with the light \
             from another side.",
        );
    }
    let mut lights =
        lights_of(&layers.iter().map(|layer| layer.name.as_str()).collect::<Vec<_>>()).into_iter();
    let shading = |(layer, file): (&Arc<Layer>, String)| {
        let tiles: TileGrid = render_layer(document, layer.id).ok_or(PAINTS_NOTHING)?;
        let coverage = Plane::from_fn(document.size, |x, y| {
            let [r, g, b, _] = tiles.pixel(x as i32, y as i32).map(|v| f32::from(v) / 255.0);
            quantize(gray(r, g, b))
        });
        let picture = CoverageFile { file, coverage: Arc::new(coverage) };
        Ok(ProfilePicture { picture, light: lights.next().unwrap_or(Vec3::Z) })
    };
    layers.into_iter().zip(free_files(document, "shading")).map(shading).collect()
}

/// A light for each name: the one that it names, else the first that no other names.
fn lights_of(names: &[&str]) -> Vec<Vec3> {
    let says = |name: &str| {
        let words: Vec<String> =
            name.to_lowercase().split(|c: char| !c.is_alphabetic()).map(str::to_owned).collect();
        LIGHTS
            .iter()
            .position(|(known, _)| known.iter().any(|word| words.iter().any(|own| own == word)))
    };
    let said: Vec<Option<usize>> = names.iter().map(|name| says(name)).collect();
    let mut left = (0..LIGHTS.len()).filter(|i| !said.contains(&Some(*i)));
    said.iter().map(|said| said.or_else(|| left.next()).map_or(Vec3::Z, |i| LIGHTS[i].1)).collect()
}

/// The luminance of an encoded color, encoded.
fn gray(r: f32, g: f32, b: f32) -> f32 {
    if r == g && g == b { r } else { encode(luminance(decode(r), decode(g), decode(b))) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lights_stand_where_the_names_of_their_layers_say() {
        let at = |i: usize| LIGHTS[i].1;
        assert_eq!(lights_of(&["From the right", "Layer 2", "top light"]), [at(1), at(0), at(2)]);
        assert_eq!(lights_of(&["a", "b"]), [at(0), at(1)]);
    }
}
