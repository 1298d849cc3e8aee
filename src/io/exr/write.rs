//! OpenEXR out: one layer of named 32-bit channels, the same bytes every time.
//! Floor 5.

use crate::math::{ColorProfile, Size};
use crate::{Error, Result};
use exr::meta::attribute::Chromaticities;
use exr::prelude::*;
use std::io::Cursor;
use std::path::Path;

/// Straight linear light as R, G, B and A; colors are stored multiplied by alpha, as EXR has them.
pub fn encode_light(file: &Path, size: Size, texels: &[[f32; 4]]) -> Result<Vec<u8>> {
    let channel =
        |c: usize| texels.iter().map(move |t| if c < 3 { t[c] * t[3] } else { t[3] }).collect();
    encode_channels(
        file,
        size,
        vec![("R", channel(0)), ("G", channel(1)), ("B", channel(2)), ("A", channel(3))],
    )
}

/// What a header says of the primaries; nothing of those of sRGB, which are the usual ones.
pub fn chromaticities(profile: ColorProfile) -> Option<Chromaticities> {
    let [red, green, blue, white] = profile.chromaticities().map(|[x, y]| Vec2(x, y));
    (profile != ColorProfile::Srgb).then_some(Chromaticities { red, green, blue, white })
}

/// Any channels of 32 bits, one value a pixel, row by row.
pub fn encode_channels(
    file: &Path,
    size: Size,
    channels: Vec<(&str, Vec<f32>)>,
) -> Result<Vec<u8>> {
    let channels =
        channels.into_iter().map(|(name, values)| AnyChannel::new(name, FlatSamples::F32(values)));
    // Lines in order: the bytes do not depend on which thread is done first.
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let extent = (size.width as usize, size.height as usize);
    let channels = AnyChannels::sort(channels.collect());
    let layer = Layer::new(extent, LayerAttributes::default(), encoding, channels);
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer)
        .write()
        .to_buffered(&mut bytes)
        .map_err(|e| Error::unsupported_file(file, e))?;
    Ok(bytes.into_inner())
}
