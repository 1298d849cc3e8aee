//! The color profiles that this program writes into files, sRGB and Display P3, and which of the two
//! a file's profile is. Floor 5. Not here: colors of other profiles (`picture`), what becomes of a
//! document's colors (`profile_change`).

use crate::math::ColorProfile;
use moxcms::{Layout, TransformOptions};
use std::sync::LazyLock;

/// The ICC profile that this program writes. Its encoder would write the present time into it; the
/// time is fixed, so that the same document gives the same bytes.
pub fn icc_of(profile: ColorProfile) -> &'static [u8] {
    static SRGB: LazyLock<Vec<u8>> = LazyLock::new(|| encode(ColorProfile::Srgb));
    static DISPLAY_P3: LazyLock<Vec<u8>> = LazyLock::new(|| encode(ColorProfile::DisplayP3));
    match profile {
        ColorProfile::Srgb => &SRGB,
        ColorProfile::DisplayP3 => &DISPLAY_P3,
    }
}

/// The profile that a file of a document embeds; none of sRGB, which is what files without one are.
pub fn to_embed(profile: ColorProfile) -> Option<&'static [u8]> {
    (profile != ColorProfile::Srgb).then(|| icc_of(profile))
}

/// A profile as the library of color management has it.
fn library_profile(profile: ColorProfile) -> moxcms::ColorProfile {
    match profile {
        ColorProfile::Srgb => moxcms::ColorProfile::new_srgb(),
        ColorProfile::DisplayP3 => {
            let mut p3 = moxcms::ColorProfile::new_display_p3();
            // The code points that it has are those of other primaries.
            p3.cicp = None;
            p3
        }
    }
}

fn encode(profile: ColorProfile) -> Vec<u8> {
    /// Year, month, day, hour, minute and second, as the header of a profile holds them.
    const DATE: [u8; 12] = [0x07, 0xd0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0];
    /// The illuminant of the connection space, always D50, which the encoder omits.
    const D50: [u8; 12] = [0, 0, 0xf6, 0xd6, 0, 1, 0, 0, 0, 0, 0xd3, 0x2d];
    let mut profile = library_profile(profile).encode().unwrap_or_default();
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

/// The profile of sRGB that this program writes itself: nothing needs converting.
pub fn is_own_srgb(icc: &[u8]) -> bool {
    icc_of(ColorProfile::Srgb) == icc
}

/// Whether a profile is Display P3 as far as a byte can tell, whoever made it.
pub fn is_display_p3(icc: &[u8]) -> bool {
    if icc_of(ColorProfile::DisplayP3) == icc {
        return true;
    }
    let Ok(profile) = moxcms::ColorProfile::new_from_slice(icc) else { return false };
    if profile.color_space != moxcms::DataColorSpace::Rgb {
        return false;
    }
    let target = library_profile(ColorProfile::DisplayP3);
    let options = TransformOptions::default();
    let transform = profile.create_transform_16bit(Layout::Rgb, &target, Layout::Rgb, options);
    let Ok(transform) = transform else { return false };
    let level = |i: usize| (i * 13107) as u16;
    let probe: Vec<u16> =
        (0..216).flat_map(|i| [level(i % 6), level(i / 6 % 6), level(i / 36)]).collect();
    let mut found = vec![0; probe.len()];
    let run = transform.transform(&probe, &mut found);
    run.is_ok() && probe.iter().zip(&found).all(|(a, b)| a.abs_diff(*b) <= 257)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_profile_is_itself_and_no_other() {
        let p3 = icc_of(ColorProfile::DisplayP3);
        assert!(is_display_p3(p3) && !is_display_p3(icc_of(ColorProfile::Srgb)));
        assert!(is_own_srgb(icc_of(ColorProfile::Srgb)) && !is_own_srgb(p3));
        // Another program's, and spaces that are near it.
        let of = |profile: moxcms::ColorProfile| profile.encode().unwrap();
        assert!(is_display_p3(&of(moxcms::ColorProfile::new_display_p3())));
        for other in [
            moxcms::ColorProfile::new_dci_p3(),
            moxcms::ColorProfile::new_adobe_rgb(),
            moxcms::ColorProfile::new_gray_with_gamma(2.2),
        ] {
            assert!(!is_display_p3(&of(other)));
        }
        assert!(!is_display_p3(b"no profile"));
    }

    #[test]
    fn the_profile_that_is_written_is_small_and_whole() {
        let p3 = icc_of(ColorProfile::DisplayP3);
        assert!(p3.len() < 1024, "{} bytes", p3.len());
        assert_eq!(p3[..4], (p3.len() as u32).to_be_bytes());
        assert_eq!(&p3[36..40], b"acsp");
    }
}
