//! A bit for each pixel of a tile.
//! Floor 1.

use super::TILE;

/// One bit per pixel: rows of a tile, the leftmost pixel in the lowest bit.
pub type TileBits = [u64; TILE];

/// A row of bits as bytes, 1 where a bit is set; eight at a time: a product puts each bit into a
/// byte of its own.
pub fn bytes_of(bits: u64) -> [u8; TILE] {
    let mut bytes = [0; TILE];
    for (eight, bits) in bytes.as_chunks_mut::<8>().0.iter_mut().zip(bits.to_le_bytes()) {
        let spread = (u64::from(bits) * 0x0101_0101_0101_0101) & 0x8040_2010_0804_0201;
        // A bit anywhere in a byte carries into its highest one.
        *eight = ((spread + 0x7f7f_7f7f_7f7f_7f7f) >> 7 & 0x0101_0101_0101_0101).to_le_bytes();
    }
    bytes
}

/// The inverse of [`bytes_of`] for bytes that are 0 or 1.
pub fn bits_of(bytes: &[u8; TILE]) -> u64 {
    let eights = bytes.as_chunks::<8>().0.iter().map(|eight| u64::from_le_bytes(*eight));
    // The product gathers the lowest bits of eight bytes in the highest byte.
    eights.rev().fold(0, |bits, eight| bits << 8 | eight.wrapping_mul(0x0102_0408_1020_4080) >> 56)
}
