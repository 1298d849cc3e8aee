//! Splits a Photoshop file into its parts: header, resources, layers, merged picture. Floor 5. `layers` reads the
//! records, `tree` builds the document.

use super::blocks::block;
use super::channel::ChannelLayout;
use super::colours::{Colours, Mode};
use super::cursor::ByteCursor;
use super::layers::RecordReader;
use super::merged::{Merged, merged};
use super::pattern::{self, Pattern};
use super::{ICC_PROFILE, LayerRecord, MAGIC, OURS, marks};
use crate::document::Guides;
use crate::math::Size;
use crate::{Budget, picture};
use crate::{Error, Result};
use std::path::Path;

/// Which colour of the table stands for nothing.
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
    pub patterns: Vec<Pattern>,
    /// And how many were left out.
    pub guides: (Guides, usize),
    /// What could not be read.
    pub damage: Vec<String>,
    /// What the layers and the picture take in memory.
    pub held_bytes: u64,
}

/// What the file says of itself.
#[derive(Clone, Copy, Debug)]
pub struct PsdHeader {
    pub large: bool,
    pub size: Size,
    pub channels: u16,
    pub bits: u16,
    pub mode: Mode,
}

impl PsdHeader {
    /// How channels of a size are laid out.
    pub fn shape(&self, size: Size, is_colour: bool) -> ChannelLayout {
        ChannelLayout {
            width: size.width as usize,
            height: size.height as usize,
            bits: self.bits,
            is_colour,
            large: self.large,
        }
    }
    /// What the picture of all layers takes while it is read: RGBA, a plane of bytes a channel, and as it is stored.
    fn merged_bytes(&self) -> u64 {
        let planes = self.colours() as u64 + 1;
        self.size.area() as u64 * (4 + planes + planes * u64::from(self.bits.div_ceil(8)))
    }
    /// Channels of colour, at most four.
    pub fn colours(&self) -> usize {
        match self.mode {
            Mode::Multichannel => usize::from(self.channels.min(4)),
            mode => usize::from(mode.channels()),
        }
    }
}

/// Reads a file. Damaged layers are reported and left out; fails only if nothing can be recovered.
pub fn parse<'a>(file: &Path, bytes: &'a [u8], budget: &Budget) -> Result<ParsedPsd<'a>> {
    let cut = || Error::decode(file, "the file is cut short");
    let mut rest = ByteCursor::new(bytes);
    let header = header(file, &mut rest, budget)?;
    let table = rest.section(false).ok_or_else(cut)?;
    let resources = rest.section(false).ok_or_else(cut)?;
    let colours = Colours {
        mode: header.mode,
        channels: header.colours(),
        is_light: header.bits == 32,
        table: table.rest(),
        nothing: resource(resources, TRANSPARENT_NUMBER)
            .and_then(|data| u8::try_from(ByteCursor::new(data).u16()?).ok()),
        icc: resource(resources, ICC_PROFILE).filter(|icc| !picture::is_own_srgb(icc)),
    };
    let length = rest.length(header.large).ok_or_else(cut)?;
    let section = ByteCursor::new(rest.rest().get(..length).unwrap_or(rest.rest()));
    let mut reader = RecordReader::new(file, budget, &header, &colours);
    let info = layer_info(section, header.large);
    let records = info.map_or_else(|| Ok(Vec::new()), |info| reader.records(info))?;
    let patterns = pattern::read(global_blocks(section, header.large), &mut reader)?;
    let held_bytes = reader.held_bytes();
    let mut damage = reader.damage;
    let is_there = rest.take(length).is_some();
    let count = info.and_then(|info| ByteCursor::new(info.rest()).i16());
    let held_bytes = held_bytes.saturating_add(header.merged_bytes());
    budget.room(file, "reading its layers and the picture of them all", held_bytes)?;
    let channels = usize::from(header.channels).saturating_sub(header.colours());
    let with_channels = held_bytes.saturating_add((header.size.area() as u64).saturating_mul(2 * channels as u64));
    let has_room = budget.room(file, "", with_channels).is_ok();
    if !has_room {
        damage.push("the selections that it keeps are left out: there is too little memory for them".into());
    }
    let merged = if is_there { merged(&mut rest, &header, &colours, resources, count, has_room) } else { None };
    if merged.is_none() && records.is_empty() {
        return Err(Error::decode(file, "it holds no layers, and its picture is damaged or cut short"));
    }
    let guides = marks::guides(resources);
    Ok(ParsedPsd { header, ours: resource(resources, OURS), records, merged, patterns, guides, damage, held_bytes })
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
    let unknown = || Error::unsupported(file, format!("its colours are of the unknown kind {mode}"));
    let mode = Mode::of(mode).ok_or_else(unknown)?;
    if ![8, 16, 32].contains(&bits) && (bits, mode) != (1, Mode::Bitmap) {
        return Err(Error::unsupported(file, format!("it has {bits} bits a channel; 1, 8, 16 and 32 can be read")));
    }
    if channels < mode.channels() || channels > 56 {
        return Err(Error::decode(file, format!("it has {channels} channels")));
    }
    Ok(PsdHeader { large: version == 2, size, channels, bits, mode })
}

/// The data of a resource.
pub fn resource(mut rest: ByteCursor<'_>, wanted: u16) -> Option<&[u8]> {
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
    let whole = section;
    let length = section.length(large)?;
    if length > 0 {
        return Some(ByteCursor::new(section.rest().get(..length).unwrap_or(section.rest())));
    }
    let holds_layers = |key: &[u8; 4]| [*b"Lr16", *b"Lr32", *b"Layr"].contains(key);
    global_blocks(whole, large).find(|(key, _)| holds_layers(key)).map(|(_, data)| data)
}

/// The blocks behind the layers, which belong to the whole file.
fn global_blocks(mut section: ByteCursor<'_>, large: bool) -> impl Iterator<Item = ([u8; 4], ByteCursor<'_>)> {
    let is_there = section.section(large).and_then(|_| section.section(false)).is_some();
    std::iter::from_fn(move || if is_there { block(&mut section, large) } else { None })
}
