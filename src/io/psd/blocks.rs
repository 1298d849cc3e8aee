//! The blocks of additional information behind a layer's record: what each says of the layer.
//! Floor 5.

use super::colors::{Colors, Mode};
use super::cursor::ByteCursor;
use super::descriptor;
use super::line::ShapeLine;
use super::outline::VectorPaths;
use super::{LayerRecord, RecordSection, adjustments, effects, fill, fill_block, marks};
use crate::math::Rect;
use crate::math::srgb::Color;
use crate::paint::ColorAdjustment;

/// The ground of an artboard, which also cuts off what is beyond it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArtboardBackground {
    pub rect: Rect,
    /// `None`: transparent.
    pub color: Option<Color>,
}

/// A block. Some programs pad them to four bytes, some to two, some not at all.
pub fn block<'a>(rest: &mut ByteCursor<'a>, large: bool) -> Option<([u8; 4], ByteCursor<'a>)> {
    const LONG: [[u8; 4]; 13] = [
        *b"LMsk", *b"Lr16", *b"Lr32", *b"Layr", *b"Mt16", *b"Mt32", *b"Mtrn", *b"Alph", *b"FMsk",
        *b"lnk2", *b"FEid", *b"FXid", *b"PxSD",
    ];
    let is_signature = |key: [u8; 4]| key == *b"8BIM" || key == *b"8B64";
    for _ in 0..4 {
        let mut ahead = *rest;
        if ahead.key().is_some_and(is_signature) {
            break;
        }
        rest.take(1)?;
    }
    rest.key().filter(|key| is_signature(*key))?;
    let key = rest.key()?;
    let data = rest.section(large && LONG.contains(&key))?;
    Some((key, data))
}

/// What is noted of text.
pub const TEXT_NOTE: &str = "its text became pixels";

/// Takes a block's word into a record.
pub fn take(record: &mut LayerRecord, key: [u8; 4], mut data: ByteCursor, colors: &Colors) {
    match &key {
        b"luni" => {
            let name = data.unicode();
            record.name = name.unwrap_or_else(|| record.name.clone());
        }
        b"lsct" | b"lsdk" => section(record, data),
        b"lspf" => {
            let locks = data.u32().unwrap_or(0);
            record.lock_all = locks & 0x8000_0002 != 0;
            record.lock_alpha |= locks & 1 != 0;
        }
        b"lclr" => record.label = marks::label(data),
        b"iOpa" => record.fill_opacity = data.u8().unwrap_or(255),
        b"GdFl" | b"SoCo" | b"PtFl" => read_fill(record, key, data, colors),
        b"vscg" if record.fill.is_none() => {
            if let Some(key) = data.key() {
                read_fill(record, key, data, colors);
            }
        }
        b"fxrp" => record.reference = data.f64().zip(data.f64()).filter(|(x, y)| is_near(*x, *y)),
        b"vmsk" | b"vsms" => {
            record.outline = VectorPaths::read(data);
            if record.outline.is_none() {
                record.leave_out("its vector mask is not understood");
            }
        }
        b"artb" | b"artd" | b"abdd" => record.ground = ground(data, colors),
        b"TySh" | b"tySh" => record.note_conversion(TEXT_NOTE),
        b"SoLd" | b"SoLE" | b"PlLd" | b"plLd" => {
            record.note_conversion("its smart object became pixels")
        }
        key if effects::KEYS.contains(key) || [effects::OF_GROUPS, effects::OLD].contains(key) => {
            effects::take(&mut record.effects, *key, data, colors);
        }
        b"vstk" => read_stroke(record, &mut data, colors),
        &adjustments::NEWER => {
            // Only brightness and contrast have newer numbers.
            let is_other = record
                .adjustment
                .as_ref()
                .is_some_and(|old| !matches!(old, ColorAdjustment::BrightnessContrast(_)));
            if let Some(newer) = adjustments::newer_brightness(&mut data).filter(|_| !is_other) {
                record.adjustment = Some(newer);
            }
        }
        // The newer numbers may have come before the old ones.
        b"brit" if record.adjustment.is_some() => {}
        key if adjustments::KEYS.contains(key) => {
            // Only inks have a fourth: what follows three colors is no part of the layer.
            if colors.mode == Mode::Cmyk {
                record.adjustment_of_black = adjustments::read_black(*key, data);
            }
            record.adjustment = adjustments::read(*key, &mut data, colors);
            if record.adjustment.is_none() {
                record.leave_out("its adjustment is left out");
            }
        }
        _ => blending(record, key, data),
    }
}

/// Whether a point may be one of a canvas.
fn is_near(x: f64, y: f64) -> bool {
    x.abs() <= 1e5 && y.abs() <= 1e5
}

/// Where groups begin and end.
fn section(record: &mut LayerRecord, mut data: ByteCursor) {
    record.section = match data.u32() {
        Some(1 | 2) => RecordSection::Group,
        Some(3) => RecordSection::End,
        _ => RecordSection::Layer,
    };
    if data.key() == Some(*b"8BIM")
        && let Some(blend) = data.key()
    {
        record.blend = blend;
    }
}

fn read_fill(record: &mut LayerRecord, key: [u8; 4], data: ByteCursor, colors: &Colors) {
    record.fill = fill_block::read(key, data, colors);
    record.has_unknown_fill = record.fill.is_none();
}

/// The line around a shape, and whether it is filled.
fn read_stroke(record: &mut LayerRecord, data: &mut ByteCursor, colors: &Colors) {
    record.is_shape = true;
    let Some(stroke) = descriptor::read(data) else { return };
    record.stroked = stroke.is_set("strokeEnabled");
    record.unfilled = stroke.is_false("fillEnabled");
    record.line = ShapeLine::read(&stroke, colors).filter(|_| record.stroked);
}

/// Ways to blend that this program has not.
fn blending(record: &mut LayerRecord, key: [u8; 4], mut data: ByteCursor) {
    match &key {
        b"knko" => match data.u8() {
            Some(1) => record.knocks_out = true,
            None | Some(0) => {}
            Some(_) => record.leave_out("its knockout is left out: it goes through all layers"),
        },
        b"lmgm" | b"vmgm" if data.u8() == Some(1) => record.masks_effects = true,
        b"clbl" => record.clips_apart = data.u8() == Some(0),
        b"infx" => record.fills_with_effects = data.u8() == Some(1),
        b"brst" if !data.rest().is_empty() => {
            record.leave_out("the channels that it leaves alone are painted too")
        }
        b"tsly" => record.ignores_alpha = data.u8() == Some(0),
        _ => {}
    }
}

/// An artboard's rectangle and color.
fn ground(mut data: ByteCursor, colors: &Colors) -> Option<ArtboardBackground> {
    let board = descriptor::read(&mut data)?;
    let rect = board.object("artboardRect")?;
    // Limited to possible canvas sizes, so that sums do not overflow.
    let side = |name: &str| rect.number(name).map(|v| v.max(-1e6).min(1e6).round() as i32);
    let rect = Rect::new(side("Left")?, side("Top ")?, side("Rght")?, side("Btom")?);
    let color = match board.number("artboardBackgroundType").map(|kind| kind as i32) {
        Some(1) => Some(Color::WHITE),
        Some(2) => Some(Color::BLACK),
        Some(4) => board.object("Clr ").and_then(|color| fill::color(color, colors)),
        _ => None,
    };
    Some(ArtboardBackground { rect, color })
}
