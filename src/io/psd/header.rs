//! The header of a Photoshop file, and its resources. Floor 5.

use super::MAGIC;
use super::channel::ChannelLayout;
use super::colors::Mode;
use super::cursor::ByteCursor;
use crate::Budget;
use crate::math::Size;
use crate::{Error, Result};
use std::path::Path;

/// The header of the file.
#[derive(Clone, Copy, Debug)]
pub struct PsdHeader {
    pub large: bool,
    pub size: Size,
    pub channels: u16,
    pub bits: u16,
    pub mode: Mode,
    /// Its pixels are read as 16 bits: it has more than 8, of colors that are kept as they are,
    /// and the budget allows paint of 16 bits.
    pub is_16_bit: bool,
}

impl PsdHeader {
    /// How channels of a size are laid out.
    pub fn shape(&self, size: Size, is_color: bool) -> ChannelLayout {
        ChannelLayout {
            width: size.width as usize,
            height: size.height as usize,
            bits: self.bits,
            is_color,
            large: self.large,
        }
    }

    /// Memory of the merged picture while it is read: RGBA, a plane of values per channel, and the
    /// stored data.
    pub fn merged_bytes(&self) -> u64 {
        let planes = self.colors() as u64 + 1;
        let (rgba, value) = if self.is_16_bit { (12, 2) } else { (4, 1) };
        self.size.area() as u64
            * (rgba + planes * value + planes * u64::from(self.bits.div_ceil(8)))
    }

    /// Channels of color, at most four.
    pub fn colors(&self) -> usize {
        match self.mode {
            Mode::Multichannel => usize::from(self.channels.min(4)),
            mode => usize::from(mode.channels()),
        }
    }
}

pub fn header(file: &Path, rest: &mut ByteCursor, budget: &Budget) -> Result<PsdHeader> {
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
    let unknown = || Error::unsupported_file(file, format!("its color mode {mode} is unknown"));
    let mode = Mode::of(mode).ok_or_else(unknown)?;
    if ![8, 16, 32].contains(&bits) && (bits, mode) != (1, Mode::Bitmap) {
        return Err(Error::unsupported_file(
            file,
            format!("it has {bits} bits a channel; 1, 8, 16 and 32 can be read"),
        ));
    }
    if channels < mode.channels() || channels > 56 {
        return Err(Error::decode(file, format!("it has {channels} channels")));
    }
    let is_16_bit = budget.sixteen_bit_paint && bits > 8 && matches!(mode, Mode::Rgb | Mode::Gray);
    Ok(PsdHeader { large: version == 2, size, channels, bits, mode, is_16_bit })
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
