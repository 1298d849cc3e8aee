//! Splits a Photoshop file into its parts: header, resources, layers, merged picture. Floor 5. `layers` reads the
//! records, `tree` builds the document.

use super::channel::{self, ChannelLayout};
use super::cursor::ByteCursor;
use super::layers::{RecordReader, block};
use super::{ICC_PROFILE, LayerRecord, MAGIC, OURS};
use crate::Budget;
use crate::math::Size;
use crate::{Error, Result};
use std::path::Path;

/// A file's parts.
pub struct ParsedPsd<'a> {
    pub size: Size,
    pub is_deep: bool,
    pub is_grey: bool,
    pub icc: Option<&'a [u8]>,
    /// Our own resource.
    pub ours: Option<&'a [u8]>,
    /// Bottom first.
    pub records: Vec<LayerRecord>,
    /// Straight RGBA of the merged picture; absent where it is damaged.
    pub merged: Option<Vec<u8>>,
    /// What could not be read.
    pub damage: Vec<String>,
}

/// The header of a file.
pub struct PsdHeader {
    pub large: bool,
    pub size: Size,
    pub channels: u16,
    pub bits: u16,
    /// One channel of colour: grey, or numbers of colours.
    pub is_grey: bool,
    is_indexed: bool,
}

/// Reads a file. Damaged layers are reported and left out; fails only if nothing can be recovered.
pub fn parse<'a>(file: &Path, bytes: &'a [u8], budget: &Budget) -> Result<ParsedPsd<'a>> {
    let cut = || Error::decode(file, "the file is cut short");
    let mut rest = ByteCursor::new(bytes);
    let header = header(file, &mut rest, budget)?;
    let table = rest.section(false).ok_or_else(cut)?;
    let resources = rest.section(false).ok_or_else(cut)?;
    let (icc, ours) = (resource(resources, ICC_PROFILE), resource(resources, OURS));
    let mut parsed = ParsedPsd {
        size: header.size,
        is_deep: header.bits > 8,
        is_grey: header.is_grey,
        icc,
        ours,
        records: Vec::new(),
        merged: None,
        damage: Vec::new(),
    };
    let length = rest.length(header.large).ok_or_else(cut)?;
    let layers = ByteCursor::new(rest.rest().get(..length).unwrap_or(rest.rest()));
    let mut alpha_is_ours = false;
    let mut reader = RecordReader::new(file, budget, &header);
    if let Some(info) = layer_info(layers, header.large) {
        alpha_is_ours = ByteCursor::new(info.rest()).i16().is_some_and(|count| count < 0);
        parsed.records = reader.records(info)?;
    }
    parsed.damage = reader.damage;
    if rest.take(length).is_some() {
        parsed.merged = merged(&mut rest, &header, alpha_is_ours || parsed.records.is_empty());
    }
    if let (true, Some(rgba)) = (header.is_indexed, &mut parsed.merged) {
        looked_up(rgba, table.rest());
        parsed.is_grey = false;
    }
    if parsed.merged.is_none() && parsed.records.is_empty() {
        return Err(Error::decode(file, "it holds no layers, and its picture is damaged or cut short"));
    }
    Ok(parsed)
}

/// Numbers of colours to the colours: the table holds all reds, all greens, all blues.
fn looked_up(rgba: &mut [u8], table: &[u8]) {
    let count = table.len() / 3;
    for pixel in rgba.as_chunks_mut::<4>().0 {
        let number = usize::from(pixel[0]);
        let colour = |c: usize| table.get(c * count + number).filter(|_| number < count).copied().unwrap_or(0);
        [pixel[0], pixel[1], pixel[2]] = [colour(0), colour(1), colour(2)];
    }
}

fn header(file: &Path, rest: &mut ByteCursor, budget: &Budget) -> Result<PsdHeader> {
    let mut read = || {
        let magic = rest.key()?;
        let version = rest.u16()?;
        rest.take(6)?;
        Some((magic, version, rest.u16()?, rest.u32()?, rest.u32()?, rest.u16()?, rest.u16()?))
    };
    let read = read().ok_or_else(|| Error::decode(file, "the file is cut short"))?;
    let (magic, version, channels, height, width, bits, mode) = read;
    if magic != MAGIC || !(1..=2).contains(&version) {
        return Err(Error::decode(file, "it does not begin like a Photoshop file"));
    }
    let size = budget.size(file, width.into(), height.into())?;
    let modes = ["bitmap", "grey", "indexed", "RGB", "CMYK", "", "", "multichannel", "duotone", "Lab"];
    // A duotone is read as grey.
    if ![1, 2, 3, 8].contains(&mode) {
        let name = modes.get(usize::from(mode)).copied().unwrap_or("unknown");
        return Err(Error::unsupported(file, format!("its colours are {name}; RGB, grey and indexed can be read")));
    }
    if ![8, 16].contains(&bits) {
        return Err(Error::unsupported(file, format!("it has {bits} bits a channel; 8 and 16 can be read")));
    }
    let is_grey = mode != 3;
    if channels < if is_grey { 1 } else { 3 } || channels > 56 {
        return Err(Error::decode(file, format!("it has {channels} channels")));
    }
    Ok(PsdHeader { large: version == 2, size, channels, bits, is_grey, is_indexed: mode == 2 })
}

/// The data of a resource.
fn resource(mut rest: ByteCursor<'_>, wanted: u16) -> Option<&[u8]> {
    while rest.key().is_some() {
        let id = rest.u16()?;
        rest.pascal(2)?;
        let length = rest.length(false)?;
        let data = rest.take(length)?;
        rest.take(length % 2);
        if id == wanted {
            return Some(data);
        }
    }
    None
}

/// Where the layers stand: in their own section, or, of deep files, in a block behind it.
fn layer_info(mut section: ByteCursor<'_>, large: bool) -> Option<ByteCursor<'_>> {
    let length = section.length(large)?;
    if length > 0 {
        return Some(ByteCursor::new(section.rest().get(..length).unwrap_or(section.rest())));
    }
    section.section(false)?;
    while let Some((key, data)) = block(&mut section, large) {
        if [*b"Lr16", *b"Lr32", *b"Layr"].contains(&key) {
            return Some(data);
        }
    }
    None
}

/// Planes to straight RGBA; without alpha opaque, without a colour channel black.
pub fn interleaved(planes: &[Option<Vec<u8>>; 4], area: usize, is_grey: bool) -> Vec<u8> {
    let [r, g, b, a] = planes;
    if planes.iter().all(Option::is_none) {
        return vec![0; area * 4];
    }
    let (g, b) = if is_grey { (r, r) } else { (g, b) };
    let value =
        |plane: &Option<Vec<u8>>, i: usize, absent| plane.as_ref().and_then(|p| p.get(i)).copied().unwrap_or(absent);
    (0..area).flat_map(|i| [value(r, i, 0), value(g, i, 0), value(b, i, 0), value(a, i, 255)]).collect()
}

/// The merged picture; `with_alpha`: a channel beyond the colours is its transparency.
fn merged(rest: &mut ByteCursor, header: &PsdHeader, with_alpha: bool) -> Option<Vec<u8>> {
    let size = header.size;
    let shape = ChannelLayout {
        width: size.width as usize,
        height: size.height as usize,
        bits: header.bits,
        large: header.large,
    };
    let colours = if header.is_grey { 1 } else { 3 };
    let wanted = usize::from(header.channels).min(colours + usize::from(with_alpha));
    let compression = rest.u16()?;
    let planes: Option<Vec<Vec<u8>>> = match compression {
        0 => (0..wanted).map(|_| channel::decode_as(rest, shape, 0)).collect(),
        1 => {
            let lengths = channel::row_lengths(rest, shape, shape.height * usize::from(header.channels))?;
            let channels = lengths.chunks(shape.height).take(wanted);
            channels.map(|lengths| channel::unpack_rows(rest, shape, lengths)).collect()
        }
        2 | 3 => channel::inflate_planes(rest.rest(), shape, wanted, compression == 3),
        _ => None,
    };
    let mut planes = planes?.into_iter();
    let mut slots: [Option<Vec<u8>>; 4] = [None, None, None, None];
    for slot in slots.iter_mut().take(colours) {
        *slot = planes.next();
    }
    slots[3] = planes.next();
    Some(interleaved(&slots, size.area(), header.is_grey))
}
