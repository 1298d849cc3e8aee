//! The color profile of sRGB that this program writes into pictures.
//! Floor 5. Not here: reading other profiles (`picture`).

use moxcms::ColorProfile;

/// The profile of sRGB that this program writes. Its encoder would write the present time into it;
/// the time is fixed, so that the same document gives the same bytes.
pub fn own_srgb() -> Vec<u8> {
    /// Year, month, day, hour, minute and second, as the header of a profile holds them.
    const DATE: [u8; 12] = [0x07, 0xd0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0];
    /// The illuminant of the connection space, always D50, which the encoder omits.
    const D50: [u8; 12] = [0, 0, 0xf6, 0xd6, 0, 1, 0, 0, 0, 0, 0xd3, 0x2d];
    let mut profile = ColorProfile::new_srgb().encode().unwrap_or_default();
    for (at, value) in [(24, DATE), (68, D50)] {
        if let Some(place) = profile.get_mut(at..at + value.len()) {
            place.copy_from_slice(&value);
        }
    }
    aligned(&profile).unwrap_or(profile)
}

/// A profile with each part at a multiple of four bytes: readers require it, but the encoder does
/// not do it.
fn aligned(profile: &[u8]) -> Option<Vec<u8>> {
    let number = |at: usize| Some(u32::from_be_bytes(*profile.get(at..)?.first_chunk()?) as usize);
    let table = 132 + 12 * number(128)?;
    let mut out = profile.get(..table)?.to_vec();
    for entry in (132..table).step_by(12) {
        let (start, length) = (number(entry + 4)?, number(entry + 8)?);
        let moved = out.len() as u32;
        out[entry + 4..entry + 8].copy_from_slice(&moved.to_be_bytes());
        out.extend(profile.get(start..)?.get(..length)?);
        out.resize(out.len().next_multiple_of(4), 0);
    }
    let size = out.len() as u32;
    out[..4].copy_from_slice(&size.to_be_bytes());
    Some(out)
}

/// The profile that this program writes itself: nothing needs converting.
pub fn is_own_srgb(icc: &[u8]) -> bool {
    own_srgb() == icc
}
