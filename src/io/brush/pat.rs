//! GIMP's patterns: a picture that repeats. Floor 5.

use crate::Budget;
use crate::psd::cursor::ByteCursor;
use crate::raster::Picture;
use crate::{Error, Result};
use std::path::Path;

const MAGIC: [u8; 4] = *b"GPAT";

pub fn is_pat(bytes: &[u8]) -> bool {
    bytes.get(20..24) == Some(&MAGIC)
}

/// Reads a pattern of gray or color, with or without alpha.
pub fn read(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Picture> {
    let cut = || Error::decode(file, "the pattern is cut short");
    let mut cursor = ByteCursor::new(bytes);
    let mut number = || cursor.u32().ok_or_else(cut);
    let [header, version, width, height, channels] =
        [number()?, number()?, number()?, number()?, number()?];
    if cursor.key().ok_or_else(cut)? != MAGIC {
        return Err(Error::decode(file, "it does not begin like a GIMP pattern"));
    }
    if version != 1 || !(1..=4).contains(&channels) {
        let reason = format!("a GIMP pattern of version {version} with {channels} bytes a pixel");
        return Err(Error::unsupported_file(file, reason));
    }
    let size = budget.size(file, u64::from(width), u64::from(height))?;
    // The rest of the header is the name.
    (header as usize).checked_sub(24).and_then(|n| cursor.take(n)).ok_or_else(cut)?;
    let texels = cursor.take(size.area() * channels as usize).ok_or_else(cut)?;
    let texels = match channels {
        1 => texels.iter().map(|&v| [v, v, v, 255]).collect(),
        2 => texels.as_chunks().0.iter().map(|&[v, a]| [v, v, v, a]).collect(),
        3 => texels.as_chunks().0.iter().map(|&[r, g, b]| [r, g, b, 255]).collect(),
        _ => texels.as_chunks().0.to_vec(),
    };
    Picture::srgb8(size, texels).ok_or_else(cut)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::picture::Texels;

    fn pat(version: u32, channels: u32, texels: &[u8]) -> Result<Picture> {
        let words = [26, version, 2, 1, channels].map(u32::to_be_bytes);
        let bytes = [words.as_flattened(), b"GPAT", b"P\0", texels].concat();
        assert!(is_pat(&bytes));
        read(Path::new("p.pat"), &bytes, &Budget::default())
    }

    #[test]
    fn patterns_have_one_to_four_bytes_a_pixel() {
        for (channels, bytes, first) in [
            (1, &[9u8, 8][..], [9, 9, 9, 255]),
            (2, &[9, 1, 8, 2], [9, 9, 9, 1]),
            (3, &[1, 2, 3, 4, 5, 6], [1, 2, 3, 255]),
            (4, &[1, 2, 3, 4, 5, 6, 7, 8], [1, 2, 3, 4]),
        ] {
            let Texels::Srgb8(texels) = pat(1, channels, bytes).unwrap().texels else {
                panic!("bytes")
            };
            assert_eq!((texels.len(), texels[0]), (2, first));
        }
    }

    #[test]
    fn what_is_no_pattern_gets_a_sentence() {
        let said = |version, channels, texels: &[u8]| {
            pat(version, channels, texels).map(|_| ()).unwrap_err().to_string()
        };
        assert!(said(2, 3, &[0; 6]).contains("version 2 with 3 bytes a pixel"));
        assert!(said(1, 5, &[0; 10]).contains("5 bytes a pixel"));
        assert!(said(1, 3, &[0; 5]).contains("cut short"));
        let other = read(Path::new("p.pat"), &[0; 40], &Budget::default());
        assert!(other.map(|_| ()).unwrap_err().to_string().contains("not begin"));
    }
}
