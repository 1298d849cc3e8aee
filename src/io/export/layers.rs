//! A document as a multilayer EXR: one group of channels a layer, and the surface's normals and
//! depth. Floor 5. Names and conventions are those that compositing programs expect: `LAYER.R`,
//! `normal.X`, `depth.Z`.

use super::high_depth::{flatten_within_budget, light};
use crate::document::{Document, Highlights, Progress};
use crate::exr::chromaticities;
use crate::math::{ColorProfile, Size};
use crate::project::Cancelable;
use crate::{Budget, Error, Result};
use exr::prelude::*;
use std::collections::BTreeSet;
use std::io::Cursor;
use std::path::Path;

/// The bytes of the EXR; `None` if canceled. The whole picture is in R, G, B and A; colors are
/// linear floats of 16 or 32 `bits`, multiplied by alpha, each layer with its own opacity and mask;
/// normals and depth have 32 bits.
pub fn encode(
    file: &Path,
    document: &Document,
    bits: u8,
    budget: &Budget,
    progress: &Progress,
) -> Cancelable<Vec<u8>> {
    let Some(document) = document.reshaped_with_progress(progress) else { return Ok(None) };
    let size = document.size;
    let seen = |document: &Document| {
        flatten_within_budget(file, document, Highlights::Kept, budget, progress)
    };
    let mut channels = Vec::new();
    let Some(whole) = seen(&document)? else { return Ok(None) };
    push_picture(&mut channels, "", whole, bits);
    let mut taken = BTreeSet::from(["normal".to_owned(), "depth".to_owned()]);
    for (_, layer) in document.walk() {
        if layer.visible && layer.content.has_pixels() {
            let Some(pixels) =
                document.with_only(&[layer.id]).map_or(Ok(None), |alone| seen(&alone))?
            else {
                return Ok(None);
            };
            push_picture(
                &mut channels,
                &format!("{}.", free_name(&layer.name, &mut taken)),
                pixels,
                bits,
            );
        }
    }
    if let Some(surface) = document.surface.as_deref() {
        let pixels = || {
            (0..size.height as usize).flat_map(|y| (0..size.width as usize).map(move |x| (x, y)))
        };
        for (c, name) in ["normal.X", "normal.Y", "normal.Z"].into_iter().enumerate() {
            let values = pixels().map(|(x, y)| surface.normal(x, y)[c]).collect();
            channels.push(AnyChannel::new(name, FlatSamples::F32(values)));
        }
        let depth = pixels().map(|(x, y)| surface.depth(x, y)).collect();
        channels.push(AnyChannel::new("depth.Z", FlatSamples::F32(depth)));
    }
    write_exr(size, channels, document.profile)
        .map(Some)
        .map_err(|e| Error::unsupported_file(file, e))
}

fn push_picture(
    channels: &mut Vec<AnyChannel<FlatSamples>>,
    prefix: &str,
    mut pixels: Vec<[f32; 4]>,
    bits: u8,
) {
    pixels.iter_mut().for_each(|pixel| *pixel = light(pixel));
    for (c, name) in ["R", "G", "B", "A"].into_iter().enumerate() {
        let values = pixels.iter().map(|p| p[c]);
        let samples = match bits {
            32 => FlatSamples::F32(values.collect()),
            _ => FlatSamples::F16(values.map(f16::from_f32).collect()),
        };
        channels.push(AnyChannel::new(format!("{prefix}{name}").as_str(), samples));
    }
}

/// A name for a group of channels: no dots, which part groups, and none twice.
fn free_name(name: &str, taken: &mut BTreeSet<String>) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || "-_ ".contains(c) { c } else { '_' };
    let plain: String = name.chars().take(60).map(plain).collect();
    let plain = if plain.trim().is_empty() { "layer".to_owned() } else { plain };
    let numbered = |n: usize| if n == 1 { plain.clone() } else { format!("{plain} {n}") };
    let free = (1..).map(numbered).find(|name| taken.insert(name.to_lowercase()));
    free.unwrap_or(plain)
}

fn write_exr(
    size: Size,
    channels: Vec<AnyChannel<FlatSamples>>,
    profile: ColorProfile,
) -> Result<Vec<u8>, exr::error::Error> {
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let extent = (size.width as usize, size.height as usize);
    let layer = Layer::new(
        extent,
        LayerAttributes::default(),
        encoding,
        AnyChannels::sort(channels.into()),
    );
    let mut bytes = Cursor::new(Vec::new());
    let mut image = Image::from_layer(layer);
    image.attributes.chromaticities = chromaticities(profile);
    image.write().to_buffered(&mut bytes)?;
    Ok(bytes.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{exr::ExrFile, project::sample::everything};

    #[test]
    fn every_visible_layer_and_the_surface_have_channels() {
        let document = everything(32);
        let bytes =
            encode(Path::new("a.exr"), &document, 16, &Budget::default(), &Progress::default())
                .unwrap()
                .unwrap();
        let budget = Budget::default();
        let file = ExrFile::open(Path::new("a.exr"), &bytes, &budget).unwrap();
        let names: Vec<&str> =
            file.channels().iter().map(|channel| channel.name.as_str()).collect();
        for name in ["R", "A", "ground.R", "photo.B", "lit.A", "normal.X", "normal.Z", "depth.Z"] {
            assert!(names.contains(&name), "{name} in {names:?}");
        }
        assert!(!names.iter().any(|name| name.starts_with("hidden")));
    }

    #[test]
    fn names_are_told_apart() {
        let mut taken = BTreeSet::new();
        let names = ["a.b", "a/b", "", "  "].map(|name| free_name(name, &mut taken));
        assert_eq!(names, ["a_b", "a_b 2", "layer", "layer 2"]);
    }
}
