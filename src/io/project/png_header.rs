//! What the header of a PNG says, before anything of it is decoded. Floor 5.

use crate::math::Size;

/// Bytes at the beginning of a PNG that give its size and depth.
pub const PNG_HEADER: usize = 25;

/// Whether it has 16 bits a channel.
pub fn is_16_bit_png(bytes: &[u8]) -> bool {
    bytes.get(24) == Some(&16)
}

/// Its size.
pub fn png_size(bytes: &[u8]) -> Option<Size> {
    let side = |at: usize| Some(u32::from_be_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
    Some(Size::new(side(16)?, side(20)?))
}
