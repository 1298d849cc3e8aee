//! Writes records as the bytes of a Photoshop file.
//! Floor 5.

use super::channel::pack;
use super::{
    ICC_PROFILE, LayerRecord, MAGIC, OURS, RESOLUTION, RecordMask, RecordSection, VERSION_INFO,
};
use super::{adjustments, alpha_channels, effects, marks, shape};
use crate::document::{Guides, LayerLabel, NamedSelection};
use crate::math::{ColorProfile, Rect, Size};
use crate::paint::EffectLight;

/// The default print resolution.
const DOTS_PER_INCH: u32 = 72;

/// What belongs to a document besides its layers.
#[derive(Clone, Copy)]
pub struct FileMarks<'a> {
    /// They become channels.
    pub selections: &'a [NamedSelection],
    pub guides: &'a Guides,
    /// Of effects without a light of their own.
    pub light: EffectLight,
    pub profile: ColorProfile,
}

/// The whole file. `merged` is RGBA of the canvas [on white](on_white), `ours` is our own resource.
pub fn encode_file(
    size: Size,
    records: &[LayerRecord],
    merged: &[u8],
    marks: FileMarks,
    ours: &[u8],
) -> Vec<u8> {
    let selections = marks.selections;
    let mut out = MAGIC.to_vec();
    short(&mut out, 1);
    out.extend([0; 6]);
    short(&mut out, 4 + selections.len() as u16);
    long(&mut out, size.height);
    long(&mut out, size.width);
    short(&mut out, 8);
    // RGB, and no table of colors.
    short(&mut out, 3);
    long(&mut out, 0);
    section(&mut out, &resources(marks, ours));
    let mut layers = Vec::new();
    section(&mut layers, &layer_info(records));
    // No mask of all layers.
    long(&mut layers, 0);
    section(&mut out, &layers);
    let coverage =
        |kept: &NamedSelection| kept.selection.coverage.to_plane(size.rect()).into_values();
    let planes: Vec<Vec<u8>> =
        (0..4).map(|c| plane(merged, c)).chain(selections.iter().map(coverage)).collect();
    pack_planes(&mut out, &planes, size.width as usize);
    out
}

/// The merged picture's colors are blended with white where it is transparent; readers remove the
/// white again.
pub fn on_white(straight: &[u8]) -> Vec<u8> {
    let mixed = |c: u8, a: u8| {
        ((u32::from(c) * u32::from(a) + 255 * (255 - u32::from(a)) + 127) / 255) as u8
    };
    straight
        .as_chunks()
        .0
        .iter()
        .flat_map(|&[r, g, b, a]| [mixed(r, a), mixed(g, a), mixed(b, a), a])
        .collect()
}

fn short(out: &mut Vec<u8>, value: u16) {
    out.extend(value.to_be_bytes());
}

fn long(out: &mut Vec<u8>, value: u32) {
    out.extend(value.to_be_bytes());
}

/// A section preceded by its length.
fn section(out: &mut Vec<u8>, bytes: &[u8]) {
    long(out, bytes.len() as u32);
    out.extend(bytes);
}

fn rect(out: &mut Vec<u8>, rect: Rect) {
    [rect.y0, rect.x0, rect.y1, rect.x1].iter().for_each(|side| out.extend(side.to_be_bytes()));
}

/// Text of 16-bit units behind their number.
fn unicode(out: &mut Vec<u8>, text: &str) {
    let units: Vec<u16> = text.encode_utf16().collect();
    long(out, units.len() as u32);
    units.iter().for_each(|unit| short(out, *unit));
}

fn resources(kept: FileMarks, ours: &[u8]) -> Vec<u8> {
    let mut resolution = Vec::new();
    for _ in 0..2 {
        // Fixed point; shown per inch, lengths in inches.
        long(&mut resolution, DOTS_PER_INCH << 16);
        short(&mut resolution, 1);
        short(&mut resolution, 1);
    }
    let mut version = Vec::new();
    long(&mut version, 1);
    // The merged picture is valid.
    version.push(1);
    unicode(&mut version, "Rilievo");
    unicode(&mut version, "Rilievo");
    long(&mut version, 1);
    let mut out = Vec::new();
    let profile = crate::icc_profiles::icc_of(kept.profile);
    let mut named = alpha_channels::resources(kept.selections);
    named.extend(marks::guides_resource(kept.guides));
    named.extend(marks::effect_light_resources(kept.light));
    let own = [
        (RESOLUTION, &resolution[..]),
        (ICC_PROFILE, profile),
        (VERSION_INFO, &version),
        (OURS, ours),
    ];
    for (id, data) in named.iter().map(|(id, data)| (*id, &data[..])).chain(own) {
        out.extend(b"8BIM");
        short(&mut out, id);
        // No name, padded.
        short(&mut out, 0);
        section(&mut out, data);
        out.resize(out.len().next_multiple_of(2), 0);
    }
    out
}

fn layer_info(records: &[LayerRecord]) -> Vec<u8> {
    if records.is_empty() {
        return Vec::new();
    }
    let mut out = Vec::new();
    // Negative: the merged picture's fourth channel is its transparency.
    out.extend((-(records.len() as i16)).to_be_bytes());
    let channels: Vec<Vec<(i16, Vec<u8>)>> = records.iter().map(channels).collect();
    for (i, (record, channels)) in records.iter().zip(&channels).enumerate() {
        header(&mut out, record, channels, i as u32 + 1);
    }
    channels.iter().flatten().for_each(|(_, data)| out.extend(data));
    out.resize(out.len().next_multiple_of(4), 0);
    out
}

/// The channels of a layer with their numbers: transparency, red, green, blue, mask.
fn channels(record: &LayerRecord) -> Vec<(i16, Vec<u8>)> {
    let one = |values: Vec<u8>, width: usize| {
        let mut out = Vec::new();
        pack_planes(&mut out, &[values], width);
        out
    };
    let width = record.rect.width();
    let mut all: Vec<(i16, Vec<u8>)> = [(-1, 3), (0, 0), (1, 1), (2, 2)]
        .into_iter()
        .map(|(id, c)| (id, one(plane(&record.rgba, c), width)))
        .collect();
    if let Some(mask) = &record.mask {
        all.push((-2, one(mask.values.clone(), mask.rect.width())));
    }
    all
}

fn plane(rgba: &[u8], channel: usize) -> Vec<u8> {
    rgba.iter().skip(channel).step_by(4).copied().collect()
}

/// Planes in run lengths: the lengths of all rows, then the rows. An empty plane is stored
/// uncompressed.
fn pack_planes(out: &mut Vec<u8>, planes: &[Vec<u8>], width: usize) {
    if planes.iter().all(Vec::is_empty) || width == 0 {
        return short(out, 0);
    }
    short(out, 1);
    let mut data = Vec::new();
    for row in planes.iter().flat_map(|plane| plane.chunks(width)) {
        let before = data.len();
        pack(row, &mut data);
        // A packed row of 30,000 bytes has at most 30,235.
        short(out, (data.len() - before) as u16);
    }
    out.extend(data);
}

fn header(out: &mut Vec<u8>, record: &LayerRecord, channels: &[(i16, Vec<u8>)], id: u32) {
    rect(out, record.rect);
    short(out, channels.len() as u16);
    for (number, data) in channels {
        out.extend(number.to_be_bytes());
        long(out, data.len() as u32);
    }
    out.extend(b"8BIM");
    out.extend(record.blend);
    let hidden = if record.visible { 0 } else { 2 };
    // Bit 3: bit 4 says whether a record has its own pixels; a group has none.
    let no_pixels = if record.section == RecordSection::Layer { 8 } else { 24 };
    out.extend([
        record.opacity,
        u8::from(record.clipped),
        u8::from(record.lock_alpha) | hidden | no_pixels,
        0,
    ]);
    let mut extra = Vec::new();
    mask_data(&mut extra, record.mask.as_ref());
    // No ranges of blending.
    long(&mut extra, 0);
    pascal_name(&mut extra, &record.name);
    let mut name = Vec::new();
    unicode(&mut name, &record.name);
    block(&mut extra, b"luni", &name);
    block(&mut extra, b"lyid", &id.to_be_bytes());
    if record.lock_all {
        block(&mut extra, b"lspf", &7u32.to_be_bytes());
    }
    if record.label != LayerLabel::None {
        block(&mut extra, b"lclr", &marks::label_block(record.label));
    }
    if record.fill_opacity < 255 {
        block(&mut extra, b"iOpa", &[record.fill_opacity, 0, 0, 0]);
    }
    let listed = record.effects.as_ref().map_or(&[][..], |effects| &effects.list);
    for (key, data) in effects::blocks(listed) {
        block(&mut extra, &key, &data);
    }
    for (key, data) in record.adjustment.iter().flat_map(adjustments::blocks) {
        block(&mut extra, &key, &data);
    }
    for (key, data) in shape::blocks(record) {
        block(&mut extra, &key, &data);
    }
    let kind: u32 = match record.section {
        RecordSection::Layer => 0,
        RecordSection::Group => 1,
        RecordSection::End => 3,
    };
    if kind > 0 {
        let mut divider = kind.to_be_bytes().to_vec();
        divider.extend(b"8BIM");
        divider.extend(record.blend);
        block(&mut extra, b"lsct", &divider);
    }
    section(out, &extra);
}

fn block(out: &mut Vec<u8>, key: &[u8; 4], data: &[u8]) {
    out.extend(b"8BIM");
    out.extend(key);
    let padded = data.len().next_multiple_of(4);
    long(out, padded as u32);
    out.extend(data);
    out.extend(std::iter::repeat_n(0, padded - data.len()));
}

fn mask_data(out: &mut Vec<u8>, mask: Option<&RecordMask>) {
    let Some(mask) = mask else { return long(out, 0) };
    long(out, 20);
    rect(out, mask.rect);
    out.extend([mask.outside, 0, 0, 0]);
}

/// A short name for programs that know no other.
fn pascal_name(out: &mut Vec<u8>, name: &str) {
    let plain: Vec<u8> = name
        .chars()
        .take(31)
        .map(|c| if c.is_ascii() && !c.is_control() { c as u8 } else { b'?' })
        .collect();
    let start = out.len();
    out.push(plain.len() as u8);
    out.extend(plain);
    out.resize(start + (out.len() - start).next_multiple_of(4), 0);
}
