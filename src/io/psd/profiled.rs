//! Files of RGB whose layers blend otherwise in sRGB than in the colors of the file's profile: the
//! layers keep the file's values, and a table above them shows these as sRGB. Floor 5.

use crate::document::{Content, Document, Layer};
use crate::math::Size;
use crate::paint::ColorAdjustment;
use crate::paint::adjustment::{ColorLookup, ColorTable};
use crate::picture;
use std::sync::Arc;

/// The name of the layer with the table.
const NAME: &str = "Color profile";
/// What is noted.
pub const NOTE: &str = "its layers hold the values of the file's color profile, which the adjustment \
     “Color profile” above them turns into sRGB: colors that are picked or painted beneath it look otherwise";
/// Entries along each side of the table.
const SIDE: usize = ColorTable::MOST_SIDE;
/// Bytes of the table.
pub const TABLE_BYTES: u64 = (SIDE * SIDE * SIDE * 6) as u64;

/// A document of a profile's values with the table above it; `None` where the profile cannot be used.
pub fn show_in_srgb(mut document: Document, icc: &[u8]) -> Option<Document> {
    let table = Content::from(ColorAdjustment::ColorLookup(to_srgb(icc)?));
    document.layers.push(Arc::new(Layer { clip_to_surface: false, ..Layer::new(NAME, table) }));
    Some(document)
}

/// What a profile's values are in sRGB.
fn to_srgb(icc: &[u8]) -> Option<ColorLookup> {
    let value = |i: usize| (i * 65535 / (SIDE - 1)) as u16;
    let color =
        |i: usize| [value(i % SIDE), value(i / SIDE % SIDE), value(i / SIDE / SIDE), u16::MAX];
    let texels = (0..SIDE * SIDE * SIDE).map(color).collect();
    let size = Size::new((SIDE * SIDE) as u32, SIDE as u32);
    let shown = picture::to_srgb16(size, texels, false, icc);
    let values = shown.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect();
    let table = ColorTable::new(NAME, SIDE, false, values)?;
    Some(ColorLookup { table: Some(table) })
}
