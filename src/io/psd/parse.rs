//! Splits a Photoshop file into its parts: header, resources, layers, merged picture. Floor 5.
//! `layers` reads the records, `tree` builds the document.

use super::blocks::block;
use super::colors::{Colors, Mode};
use super::cursor::ByteCursor;
use super::gray::GrayTones;
use super::header::{PsdHeader, header, resource};
use super::inks::InkTones;
use super::layers::RecordReader;
use super::merged::{Merged, read_merged};
use super::pattern::{self, PatternResource};
use super::{ICC_PROFILE, LayerRecord, OURS, marks};
use crate::Budget;
use crate::document::Guides;
use crate::icc_profiles::{is_display_p3, is_own_srgb};
use crate::math::ColorProfile;
use crate::paint::EffectLight;
use crate::{Error, Result};
use std::path::Path;

/// Which color of the table means transparent.
const TRANSPARENT_NUMBER: u16 = 1047;

/// A file's parts.
pub struct ParsedPsd<'a> {
    pub header: PsdHeader,
    /// Our own resource.
    pub ours: Option<&'a [u8]>,
    /// Bottom first.
    pub records: Vec<LayerRecord>,
    /// The picture that the file holds of all its layers; absent where it is damaged.
    pub merged: Option<Merged>,
    pub patterns: Vec<PatternResource>,
    /// Its values are those of a color profile.
    pub has_profile: bool,
    /// What its gray values are in sRGB, unless they are the same.
    pub gray: Option<GrayTones>,
    /// Its inks, if they have a profile and there is something to adjust.
    pub inks: Option<InkTones>,
    /// The profile of its colors.
    pub icc: Option<&'a [u8]>,
    /// Of the document.
    pub profile: ColorProfile,
    /// The light of effects that have none of their own.
    pub effect_light: EffectLight,
    /// And how many were left out.
    pub guides: (Guides, usize),
    /// What could not be read.
    pub damage: Vec<String>,
    /// Memory of the layers and the picture.
    pub held_bytes: u64,
}

/// Reads a file. Damaged layers are reported and left out; fails only if nothing can be recovered.
pub fn parse<'a>(file: &Path, bytes: &'a [u8], budget: &Budget) -> Result<ParsedPsd<'a>> {
    parse_as(file, bytes, budget, RecordView::Live)
}

/// What is read of records.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum RecordView {
    /// What is shown in sRGB; shapes as live paths.
    Live,
    /// The same, and the pixels of shapes.
    Pixels,
    /// The values of a file of inks, Lab or gray, and those of RGB with a profile.
    Values,
}

/// As [`parse`].
pub fn parse_as<'a>(
    file: &Path,
    bytes: &'a [u8],
    budget: &Budget,
    view: RecordView,
) -> Result<ParsedPsd<'a>> {
    let cut = || Error::decode(file, "the file is cut short");
    let mut rest = ByteCursor::new(bytes);
    let header = header(file, &mut rest, budget)?;
    let table = rest.section(false).ok_or_else(cut)?;
    let resources = rest.section(false).ok_or_else(cut)?;
    let icc = resource(resources, ICC_PROFILE).filter(|icc| !is_own_srgb(icc));
    // Values of Display P3 stay: the document has that profile.
    let is_p3 = header.mode == Mode::Rgb && header.bits < 32 && icc.is_some_and(is_display_p3);
    let profile = if is_p3 { ColorProfile::DisplayP3 } else { ColorProfile::Srgb };
    let colors = Colors {
        mode: header.mode,
        channels: header.colors(),
        is_light: header.bits == 32,
        is_deep_lab: header.mode == Mode::Lab && header.bits == 16,
        table: table.rest(),
        nothing: resource(resources, TRANSPARENT_NUMBER)
            .and_then(|data| u8::try_from(ByteCursor::new(data).u16()?).ok()),
        icc: icc.filter(|_| !is_p3),
    };
    let length = rest.length(header.large).ok_or_else(cut)?;
    let section = ByteCursor::new(rest.rest().get(..length).unwrap_or(rest.rest()));
    let keeps_values = view == RecordView::Values;
    let own = match keeps_values && header.mode == Mode::Rgb {
        true => Colors { icc: None, ..colors },
        false => colors,
    };
    let mut reader = RecordReader::new(file, budget, &header, &own);
    reader.keeps_inks = keeps_values && matches!(header.mode, Mode::Cmyk | Mode::Lab | Mode::Gray);
    reader.keeps_pixels = view == RecordView::Pixels;
    let info = layer_info(section, header.large);
    let records = info.map_or_else(|| Ok(Vec::new()), |info| reader.records(info))?;
    let patterns = pattern::read(global_blocks(section, header.large), |px| reader.spend(px))?;
    let held_bytes = reader.held_bytes();
    let mut damage = reader.damage;
    let is_there = rest.take(length).is_some();
    let count = info.and_then(|info| ByteCursor::new(info.rest()).i16());
    // In files of 16 and 32 bits a block says what else a negative count does.
    let has_transparency = global_blocks(section, header.large)
        .any(|(key, _)| [*b"Mtrn", *b"Mt16", *b"Mt32"].contains(&key));
    let count =
        count.map(|count| if has_transparency { -count.saturating_abs().max(1) } else { count });
    let held_bytes = held_bytes.saturating_add(header.merged_bytes());
    budget.room(file, "reading its layers and the picture of them all", held_bytes)?;
    let channels = usize::from(header.channels).saturating_sub(header.colors());
    // A plane of each, and the coverage that is made of it.
    let channel_bytes = if header.is_16_bit { 3 } else { 2 } * header.size.area() as u64;
    let with_channels = held_bytes.saturating_add(channel_bytes.saturating_mul(channels as u64));
    let has_room = budget.room(file, "its layers, its picture and its selections", with_channels);
    let has_room = if header.is_16_bit { has_room.map(|()| true)? } else { has_room.is_ok() };
    if !has_room {
        damage
            .push("its named selections are left out: there is too little memory for them".into());
    }
    let merged = match (is_there, header.is_16_bit) {
        (false, _) => None,
        (true, true) => read_merged::<u16>(&mut rest, &header, &colors, resources, count, has_room),
        (true, false) => read_merged::<u8>(&mut rest, &header, &colors, resources, count, has_room),
    };
    if merged.is_none() && records.is_empty() {
        return Err(Error::decode(
            file,
            "it holds no layers, and its picture is damaged or cut short",
        ));
    }
    let adjusts = records.iter().any(|record| record.adjustment.is_some());
    let inks = if adjusts { InkTones::of(&colors) } else { None };
    let guides = marks::guides(resources);
    let effect_light = marks::effect_light(resources);
    Ok(ParsedPsd {
        header,
        ours: resource(resources, OURS),
        records,
        merged,
        patterns,
        has_profile: own.has_profile(),
        gray: GrayTones::of(&colors, header.bits),
        inks,
        icc: colors.icc,
        profile,
        effect_light,
        guides,
        damage,
        held_bytes,
    })
}

/// Where the layers are: in their own section, or in files of 16 or 32 bits in a block after it.
fn layer_info(mut section: ByteCursor<'_>, large: bool) -> Option<ByteCursor<'_>> {
    let whole = section;
    let length = section.length(large)?;
    if length > 0 {
        return Some(ByteCursor::new(section.rest().get(..length).unwrap_or(section.rest())));
    }
    let holds_layers = |key: &[u8; 4]| [*b"Lr16", *b"Lr32", *b"Layr"].contains(key);
    global_blocks(whole, large).find(|(key, _)| holds_layers(key)).map(|(_, data)| data)
}

/// The blocks behind the layers, which belong to the whole file.
fn global_blocks(
    mut section: ByteCursor<'_>,
    large: bool,
) -> impl Iterator<Item = ([u8; 4], ByteCursor<'_>)> {
    let is_there = section.section(large).and_then(|_| section.section(false)).is_some();
    std::iter::from_fn(move || if is_there { block(&mut section, large) } else { None })
}
