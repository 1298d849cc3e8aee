//! The old block of effects, which files of before 2000, and some programs, have alone. Floor 5.
//! One effect of each kind; newer blocks repeat it, and count.

use super::{RecordEffects, lose};
use crate::math::srgb::Color;
use crate::paint::effect::{BevelStyle, EffectSettings};
use crate::paint::{EffectKind, LayerEffect};
use crate::psd::adjustments;
use crate::psd::colors::Colors;
use crate::psd::cursor::ByteCursor;
use crate::raster::BlendMode;

/// Reads the block; `None` where it is not understood.
pub fn read(mut data: ByteCursor, colors: &Colors) -> Option<RecordEffects> {
    data.u16().filter(|version| *version == 0)?;
    let mut found = RecordEffects::default();
    let mut is_shown = true;
    for _ in 0..data.u16()? {
        data.key().filter(|signature| *signature == *b"8BIM")?;
        let (key, mut part) = (data.key()?, data.section(false)?);
        // Each begins with its version.
        part.u32()?;
        let effect = match &key {
            b"cmnS" => {
                is_shown = part.u8()? != 0;
                continue;
            }
            b"dsdw" => shadow(EffectKind::DropShadow, &mut part, colors)?,
            b"isdw" => shadow(EffectKind::InnerShadow, &mut part, colors)?,
            b"oglw" => glow(EffectKind::OuterGlow, &mut part, colors)?,
            b"iglw" => glow(EffectKind::InnerGlow, &mut part, colors)?,
            b"bevl" => bevel(&mut part, colors)?,
            b"sofi" => overlay(&mut part, colors)?,
            _ => continue,
        };
        // Numbers of effects that are switched off are always there, and mean nothing.
        if effect.on {
            let effect = LayerEffect { on: is_shown, ..effect }.with_own_settings();
            let lossless = effect.clone().clamp_to_ranges();
            if lossless != effect {
                lose(&mut found, "an effect is larger elsewhere than it can be here");
            }
            found.list.push(lossless);
        }
    }
    Some(found)
}

/// A number with a fraction of 16 bits.
fn read_fixed(data: &mut ByteCursor) -> Option<f32> {
    Some(data.i32()? as f32 / 65536.0)
}

fn color(data: &mut ByteCursor, colors: &Colors) -> Option<Color> {
    // In another space than is known it is black, and the newer color that follows is the same.
    let mut ahead = *data;
    data.take(10)?;
    Some(adjustments::color(&mut ahead, colors).unwrap_or(Color::BLACK))
}

fn blend(data: &mut ByteCursor) -> Option<BlendMode> {
    data.key().filter(|signature| *signature == *b"8BIM")?;
    Some(BlendMode::from_photoshop(data.key()?).unwrap_or(BlendMode::Normal))
}

fn opacity(data: &mut ByteCursor) -> Option<f32> {
    Some(f32::from(data.u8()?) / 255.0)
}

fn build_effect(kind: EffectKind, on: bool, set: impl FnOnce(&mut EffectSettings)) -> LayerEffect {
    let mut effect = LayerEffect { on, ..LayerEffect::new(kind) };
    set(&mut effect.settings);
    effect
}

fn shadow(kind: EffectKind, data: &mut ByteCursor, colors: &Colors) -> Option<LayerEffect> {
    let (size, intensity, angle, distance) =
        (read_fixed(data)?, read_fixed(data)?, read_fixed(data)?, read_fixed(data)?);
    let (color, blend) = (color(data, colors)?, blend(data)?);
    let (on, document_light, opacity) = (data.u8()? != 0, data.u8()? != 0, opacity(data)?);
    Some(build_effect(kind, on, |s| {
        (s.size, s.spread, s.angle, s.distance) = (size, intensity / 100.0, angle, distance);
        (s.color, s.blend, s.opacity, s.document_light) = (color, blend, opacity, document_light);
    }))
}

fn glow(kind: EffectKind, data: &mut ByteCursor, colors: &Colors) -> Option<LayerEffect> {
    let (size, intensity) = (read_fixed(data)?, read_fixed(data)?);
    let (color, blend) = (color(data, colors)?, blend(data)?);
    let (on, opacity) = (data.u8()? != 0, opacity(data)?);
    Some(build_effect(kind, on, |s| {
        (s.size, s.spread) = (size, intensity / 100.0);
        (s.color, s.blend, s.opacity) = (color, blend, opacity);
    }))
}

fn bevel(data: &mut ByteCursor, colors: &Colors) -> Option<LayerEffect> {
    let (angle, _strength, size) = (read_fixed(data)?, read_fixed(data)?, read_fixed(data)?);
    let blends = [blend(data)?, blend(data)?];
    let tones = [color(data, colors)?, color(data, colors)?];
    let style = match data.u8()? {
        1 => BevelStyle::Outer,
        3 => BevelStyle::Emboss,
        4 => BevelStyle::Pillow,
        _ => BevelStyle::Inner,
    };
    let opacities = [opacity(data)?, opacity(data)?];
    let (on, document_light, sunken) = (data.u8()? != 0, data.u8()? != 0, data.u8()? != 0);
    Some(build_effect(EffectKind::Bevel, on, |s| {
        (s.angle, s.size, s.bevel, s.sunken) = (angle, size, style, sunken);
        ([s.blend, s.shade_blend], [s.color, s.shade_color]) = (blends, tones);
        [s.opacity, s.shade_opacity] = opacities;
        s.document_light = document_light;
    }))
}

fn overlay(data: &mut ByteCursor, colors: &Colors) -> Option<LayerEffect> {
    let (blend, color) = (blend(data)?, color(data, colors)?);
    let (opacity, on) = (opacity(data)?, data.u8()? != 0);
    Some(build_effect(EffectKind::ColorOverlay, on, |s| {
        (s.blend, s.color, s.opacity) = (blend, color, opacity);
    }))
}
