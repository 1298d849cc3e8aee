//! The merged picture that a Photoshop file holds for programs that read nothing else. Floor 5. Not
//! here: its use (`compare`).

use super::VERSION_INFO;
use super::alpha_channels;
use super::channel::{self, ChannelValue};
use super::colors::{ColorValue, Colors, Mode, StraightPixels};
use super::cursor::ByteCursor;
use super::header::{PsdHeader, resource};
use crate::document::NamedSelection;
use crate::math::srgb;
use crate::raster::{CoverageGrid, Plane};

/// The picture, as stored in the file.
#[derive(Default)]
pub struct Merged {
    /// Straight sRGB.
    pub pixels: StraightPixels,
    /// Its alpha is the transparency of all layers.
    pub has_alpha: bool,
    /// The writer did not say that it left the picture out.
    pub is_real: bool,
    /// Its channels beyond colors and transparency.
    pub selections: Vec<NamedSelection>,
    /// How many of them are inks, which are left out.
    pub inks: usize,
}

/// Reads the picture; `None` if it is damaged. `count`: the number before the layers, if there are
/// any; `has_room`: there is memory for selections too.
pub fn read_merged<T: ColorValue>(
    rest: &mut ByteCursor,
    header: &PsdHeader,
    colors: &Colors,
    resources: ByteCursor,
    count: Option<i16>,
    has_room: bool,
) -> Option<Merged> {
    let has_alpha = has_alpha(resources, header, count);
    let own = header.colors() + usize::from(has_alpha);
    let wanted = if has_room && header.mode != Mode::Multichannel {
        usize::from(header.channels)
    } else {
        own
    };
    let mut planes = planes::<T>(rest, header, own, wanted)?;
    let coverage = |values: Vec<T>| {
        let bytes = values.into_iter().map(ChannelValue::byte).collect();
        Some(CoverageGrid::from_plane(&Plane::from_values(header.size, bytes)?, 0, 0))
    };
    let channels = planes.split_off(own).into_iter().map_while(coverage).collect();
    let (selections, inks) = alpha_channels::selections(channels, has_alpha, resources);
    let mut planes = planes.into_iter();
    let mut slots: [Option<Vec<T>>; 4] = [None, None, None, None];
    slots.iter_mut().take(header.colors()).for_each(|slot| *slot = planes.next());
    let alpha = planes.next();
    let mut pixels = T::pixels(*colors, header.size, &slots, alpha.as_deref());
    // Photoshop blends the colors with white as far as they are transparent; some programs do not.
    if has_alpha && count.is_some() && is_on_white(&pixels.rgba, colors.is_light) {
        remove_backdrop(pixels.rgba.as_chunks_mut().0, colors.is_light);
        remove_backdrop(&mut pixels.rgba16, colors.is_light);
    }
    // Since the number of its version: whether the picture is real.
    let is_real = resource(resources, VERSION_INFO).is_none_or(|data| data.get(4) != Some(&0));
    Some(Merged { pixels, has_alpha, is_real, selections, inks })
}

/// A channel beyond the colors is the transparency of all layers, not a selection that somebody
/// kept.
fn has_alpha(resources: ByteCursor, header: &PsdHeader, count: Option<i16>) -> bool {
    let more = usize::from(header.channels).saturating_sub(header.colors());
    if more == 0 || header.mode == Mode::Multichannel {
        return false;
    }
    let names = resource(resources, alpha_channels::NUMBERS).unwrap_or_default();
    let is_named = !names.is_empty() && names.as_chunks::<4>().0.iter().all(|name| *name != [0; 4]);
    // Of a single channel that is kept the file would say something.
    let is_kept =
        more > 1 || alpha_channels::ABOUT.iter().any(|about| resource(resources, *about).is_some());
    !is_named && count.is_none_or(|count| count < 0 || !is_kept)
}

/// The first channels, `own` at least, and of the others up to `wanted` as many as are whole.
fn planes<T: ChannelValue>(
    rest: &mut ByteCursor,
    header: &PsdHeader,
    own: usize,
    wanted: usize,
) -> Option<Vec<Vec<T>>> {
    let shape = |c: usize| header.shape(header.size, c < header.colors());
    let (height, channels) = (header.size.height as usize, usize::from(header.channels));
    let compression = rest.u16()?;
    let planes: Vec<Vec<T>> = match compression {
        0 => (0..wanted).map_while(|c| channel::decode_as(rest, shape(c), 0)).collect(),
        1 => {
            let lengths = channel::row_lengths(rest, shape(0), height * channels)?;
            let rows = lengths.chunks(height).take(wanted).enumerate();
            rows.map_while(|(c, lengths)| channel::unpack_rows(rest, shape(c), lengths)).collect()
        }
        2 | 3 => {
            let inflated =
                |count| channel::inflate_planes(rest.rest(), count, shape, compression == 3);
            inflated(wanted).or_else(|| inflated(own))?
        }
        _ => return None,
    };
    (planes.len() >= own).then_some(planes)
}

/// No color is darker than it can be on white. Some programs leave what is wholly transparent black.
/// `is_light`: colors were blended with white as light.
fn is_on_white(rgba: &[u8], is_light: bool) -> bool {
    let least = |a: u8| match is_light {
        true => srgb::quantize(srgb::encode(1.0 - f32::from(a) / 255.0)),
        false => 255 - a,
    };
    let is_bright =
        |[r, g, b, a]: &[u8; 4]| [r, g, b].iter().all(|c| c.saturating_add(3) >= least(*a));
    rgba.as_chunks::<4>().0.iter().all(|pixel| pixel[3] == 0 || is_bright(pixel))
}

/// Removes the white, which colors were blended with as light or as the file stores them.
fn remove_backdrop<T: ChannelValue + TryFrom<i64>>(texels: &mut [[T; 4]], is_light: bool)
where
    i64: From<T>,
{
    if is_light { remove_white_light(texels) } else { remove_white(texels) }
}

/// As [`remove_white`], of colors that were blended with it as light.
fn remove_white_light<T: ChannelValue + TryFrom<i64>>(texels: &mut [[T; 4]])
where
    i64: From<T>,
{
    let share = |v: T| i64::from(v) as f32 / i64::from(T::WHOLE) as f32;
    let value =
        |v: f32| T::try_from((v * i64::from(T::WHOLE) as f32 + 0.5) as i64).unwrap_or(T::WHOLE);
    for [color @ .., alpha] in texels {
        let a = share(*alpha);
        if a > 0.0 {
            let light = |v: T| (srgb::decode(share(v)) - 1.0 + a) / a;
            *color = color.map(|v| value(srgb::encode(light(v).max(0.0).min(1.0))));
        }
    }
}

/// Removes the white beneath colors as far as they are transparent; fully transparent pixels keep
/// no color.
pub fn remove_white<T: ChannelValue + TryFrom<i64>>(texels: &mut [[T; 4]])
where
    i64: From<T>,
{
    let whole = i64::from(T::WHOLE);
    for [color @ .., alpha] in texels {
        let a = i64::from(*alpha);
        if a > 0 {
            let c = |c: T| ((i64::from(c) - whole + a) * whole + a / 2) / a;
            *color = color.map(|v| T::try_from(c(v).max(0).min(whole)).unwrap_or(T::WHOLE));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_beneath_what_is_transparent_is_taken_away() {
        let mut rgba: Vec<u8> =
            [[255, 127, 127, 128], [9, 9, 9, 255], [255, 255, 255, 0], [0, 0, 0, 10]].concat();
        remove_white(rgba.as_chunks_mut().0);
        assert_eq!(
            rgba,
            [[255, 0, 0, 128], [9, 9, 9, 255], [255, 255, 255, 0], [0, 0, 0, 10]].concat()
        );
        let mut rgba16: [[u16; 4]; 3] =
            [[65535, 32767, 32767, 32768], [65535, 60000, 59999, 6000], [65535, 65535, 65535, 0]];
        remove_white(&mut rgba16);
        assert_eq!(
            rgba16,
            [[65535, 0, 0, 32768], [65535, 5079, 5068, 6000], [65535, 65535, 65535, 0]]
        );
        assert!(is_on_white(&[[255, 127, 127, 128], [0, 0, 0, 255], [0; 4]].concat(), false));
        assert!(!is_on_white(&[100, 100, 100, 20], false));
    }

    #[test]
    fn white_beneath_light_is_taken_away_as_light() {
        // White that is half covered by black.
        let on_white = [[255, 187, 187, 128], [9, 9, 9, 255], [0, 0, 0, 0], [255, 255, 255, 1]];
        let mut rgba: Vec<u8> = on_white.concat();
        assert!(is_on_white(&rgba, true) && !is_on_white(&[127, 127, 127, 128], true));
        remove_backdrop(rgba.as_chunks_mut().0, true);
        let [_, green, ..] = rgba[..4] else { panic!("a pixel") };
        assert!(green < 8, "{green}");
        assert_eq!(rgba[4..], [[9, 9, 9, 255], [0, 0, 0, 0], [255, 255, 255, 1]].concat());
        let white = |alpha: u16| [srgb::quantize16(srgb::encode(0.75)), 65535, 65535, alpha];
        let mut rgba16 = [white(32768), white(65535)];
        remove_backdrop(&mut rgba16, true);
        assert!(rgba16[0][0].abs_diff(srgb::quantize16(srgb::encode(0.5))) <= 2, "{rgba16:?}");
        assert!(rgba16[1][0].abs_diff(white(0)[0]) <= 1, "{rgba16:?}");
    }
}
