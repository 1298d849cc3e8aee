//! Patterns: the pictures that a file keeps for its fills, and a collection of brushes for their
//! textures. Floor 5.

use super::channel;
use super::colors::{Colors, Mode};
use super::cursor::ByteCursor;
use super::fill::PatternFill;
use super::header::PsdHeader;
use crate::Result;
use crate::math::Size;

/// A picture that repeats.
#[derive(Clone, Debug, PartialEq)]
pub struct PatternResource {
    id: String,
    name: String,
    size: Size,
    /// Straight sRGB.
    rgba: Vec<u8>,
}

/// More channels no pattern has.
const MOST_CHANNELS: u32 = 32;

/// The patterns of a file's blocks; those that cannot be read are left out, and what they fill is
/// reported. `spend`: as of [`of_block`].
pub fn read<'a>(
    blocks: impl Iterator<Item = ([u8; 4], ByteCursor<'a>)>,
    mut spend: impl FnMut(u64) -> Result<()>,
) -> Result<Vec<PatternResource>> {
    let mut patterns = Vec::new();
    for (key, data) in blocks {
        if matches!(&key, b"Patt" | b"Pat2" | b"Pat3") {
            patterns.extend(of_block(data, &mut spend)?);
        }
    }
    Ok(patterns)
}

/// The patterns of one block. `spend`: called with each one's pixels; refuses when they exceed the
/// limit for all.
pub fn of_block(
    mut data: ByteCursor,
    mut spend: impl FnMut(u64) -> Result<()>,
) -> Result<Vec<PatternResource>> {
    let mut patterns = Vec::new();
    // Each is filled up to four bytes.
    while let Some(one) = data.section(false).filter(|one| !one.rest().is_empty()) {
        patterns.extend(pattern(one, &mut spend)?);
        let filling = one.rest().len().next_multiple_of(4) - one.rest().len();
        data.take(filling.min(data.rest().len()));
    }
    Ok(patterns)
}

fn pattern(
    data: ByteCursor,
    spend: &mut impl FnMut(u64) -> Result<()>,
) -> Result<Option<PatternResource>> {
    let Some(PatternHead { id, name, mode, size, body }) = head(data) else { return Ok(None) };
    spend(size.area() as u64)?;
    Ok(rgba(body, mode, size).map(|rgba| PatternResource { id, name, size, rgba }))
}

/// What stands before the channels of a pattern.
struct PatternHead<'a> {
    id: String,
    name: String,
    mode: Mode,
    size: Size,
    body: ByteCursor<'a>,
}

fn head(mut data: ByteCursor<'_>) -> Option<PatternHead<'_>> {
    data.u32()?;
    let mode = Mode::of(u16::try_from(data.u32()?).ok()?)?;
    let (height, width) = (u32::from(data.u16()?), u32::from(data.u16()?));
    let name = data.unicode()?;
    let id = String::from_utf8_lossy(data.pascal(1)?).into_owned();
    let size = Size::new(width, height);
    (width > 0 && height > 0).then_some(PatternHead { id, name, mode, size, body: data })
}

fn rgba(mut data: ByteCursor, mode: Mode, size: Size) -> Option<Vec<u8>> {
    let mut table = Vec::new();
    if mode == Mode::Indexed {
        // Here red, green and blue of a color are interleaved.
        let interleaved = data.take(768)?;
        table = (0..3).flat_map(|c| interleaved.iter().skip(c).step_by(3).copied()).collect();
        data.take(4)?;
    }
    data.u32()?;
    let mut list = data.section(false)?;
    list.rect()?;
    let most = list.u32()?.min(MOST_CHANNELS);
    let mut planes: [Option<Vec<u8>>; 4] = [None, None, None, None];
    let mut alpha = None;
    // The places of the colors are followed by two more, for the mask and the transparency.
    for i in 0..most + 2 {
        let Some(plane) = channel_of(&mut list, mode, size)? else { continue };
        match planes.get_mut(i as usize).filter(|_| i < u32::from(mode.channels())) {
            Some(slot) => *slot = Some(plane),
            None => alpha = Some(plane),
        }
    }
    let colors = Colors {
        mode,
        channels: usize::from(mode.channels()),
        is_light: false,
        is_deep_lab: false,
        table: &table,
        nothing: None,
        icc: None,
    };
    Some(colors.to_srgb(size, &planes, alpha.as_deref()))
}

/// One place of the list; `Some(None)` if it is empty.
fn channel_of(list: &mut ByteCursor, mode: Mode, size: Size) -> Option<Option<Vec<u8>>> {
    if list.u32()? == 0 {
        return Some(None);
    }
    let mut data = list.section(false)?;
    if data.rest().is_empty() {
        return Some(None);
    }
    data.u32()?;
    let rect = data.rect()?;
    let bits = data.u16()?;
    let compression = u16::from(data.u8()?);
    // For any numbers: their difference may overflow their type.
    let side = |from: i32, to: i32| i64::from(to) - i64::from(from);
    let fits = [side(rect.x0, rect.x1), side(rect.y0, rect.y1)]
        == [i64::from(size.width), i64::from(size.height)];
    let header = PsdHeader { large: false, size, channels: 1, bits, mode, is_16_bit: false };
    Some(if fits && [8, 16, 32].contains(&bits) {
        channel::decode_as(&mut data, header.shape(size, true), compression)
    } else {
        None
    })
}

impl PatternResource {
    #[cfg(test)]
    pub fn gray(id: &str, size: Size, values: &[u8]) -> Self {
        Self {
            id: id.into(),
            name: id.into(),
            size,
            rgba: values.iter().flat_map(|v| [*v, *v, *v, 255]).collect(),
        }
    }

    /// Its name in fills and brushes.
    pub fn id(&self) -> &str {
        &self.id
    }

    /// What it is called.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// `(size, straight sRGB)`.
    pub fn picture(&self) -> (Size, &[u8]) {
        (self.size, &self.rgba)
    }

    /// Straight RGBA of a canvas filled with it; `None` if the fill names another pattern.
    pub fn pixels(&self, fill: &PatternFill, size: Size) -> Option<Vec<u8>> {
        if self.id != fill.id {
            return None;
        }
        let (w, h) = (i64::from(self.size.width), i64::from(self.size.height));
        let place = |at: usize, phase: f32, side: i64| {
            let at = ((at as f32 + 0.5 - phase) / fill.scale).floor() as i64;
            at.rem_euclid(side) as usize
        };
        let mut out = Vec::with_capacity(size.area() * 4);
        for y in 0..size.height as usize {
            let row = place(y, fill.phase.y, h) * w as usize;
            for x in 0..size.width as usize {
                let at = (row + place(x, fill.phase.x, w)) * 4;
                out.extend(self.rgba.get(at..at + 4).unwrap_or(&[0; 4]));
            }
        }
        Some(out)
    }
}
