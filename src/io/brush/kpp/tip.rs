//! The tip of a Krita preset: generated, or one of Krita's files. Floor 5. Not here: where the files
//! are (`beside`), what drives the tip (`sensors`).

use super::pictures::KppPictures;
use super::sensors;
use super::settings::{KppPreset, attribute, element, number};
use super::tip_file::{TipFile, TipPicture, gray};
use crate::math::{Vec2, vec2};
use crate::paint::dynamics::Input;
use crate::paint::tip::Hose;
use crate::paint::{Brush, PictureSource, Tip};
use crate::raster::Picture;
use crate::raster::picture::Texels;
use quick_xml::events::BytesStart;
use std::f32::consts::TAU;

/// The attributes of a tip's definition.
struct TipDefinition<'a>(BytesStart<'a>);

impl TipDefinition<'_> {
    fn text(&self, name: &str) -> Option<String> {
        attribute(&self.0, name)
    }

    fn number(&self, name: &str) -> Option<f32> {
        self.text(name).and_then(|text| number(&text))
    }

    fn is_set(&self, name: &str) -> bool {
        self.text(name).is_some_and(|text| text == "1" || text == "true")
    }

    /// Px between dabs of an extent: roots of it if Krita chooses, else a share of it.
    fn step(&self, extent_px: f32, plain: f32) -> f32 {
        if self.is_set("useAutoSpacing") {
            self.number("autoSpacingCoeff").unwrap_or(1.0) * extent_px.max(0.0).sqrt()
        } else {
            self.number("spacing").unwrap_or(plain) * extent_px
        }
    }
}

/// Which tip is read.
#[derive(Clone, Copy, PartialEq)]
pub enum TipUse {
    /// The brush's own, in the size of its definition.
    First,
    /// The second one of a masked brush, which only covers: in this size if there is one, px.
    Second(Option<f32>),
}

/// Tip, size, hardness, spacing, turn; and why its tip is not found, if so: then it is round.
pub fn read(
    preset: &KppPreset,
    brush: Brush,
    tip: TipUse,
    pictures: &mut KppPictures,
    notes: &mut Vec<String>,
) -> (Brush, Option<String>) {
    let definition = preset.text("brush_definition");
    let Some(outer) = element(definition, "Brush").map(TipDefinition) else {
        return (brush, Some("is missing".to_owned()));
    };
    let angle_rad = outer.number("angle").unwrap_or(0.0).rem_euclid(TAU);
    let brush = Brush { rotation: angle_rad.to_degrees(), ..brush };
    match element(definition, "MaskGenerator").map(TipDefinition) {
        Some(mask) => (generated_tip(&outer, &mask, brush, tip, notes), None),
        None => file_tip(preset, &outer, brush, tip, pictures, notes),
    }
}

impl TipUse {
    /// How much larger the tip is than its definition says, whose longer side is so long.
    fn enlargement(self, longer_px: f32) -> f32 {
        match self {
            TipUse::Second(Some(size)) if longer_px > 0.0 => size / longer_px,
            _ => 1.0,
        }
    }
}

fn generated_tip(
    outer: &TipDefinition,
    mask: &TipDefinition,
    mut brush: Brush,
    tip: TipUse,
    notes: &mut Vec<String>,
) -> Brush {
    let fade = |name: &str| mask.number(name).unwrap_or(1.0).max(0.0).min(1.0);
    let ratio = mask.number("ratio").unwrap_or(1.0).max(*Tip::RATIO.start());
    // If the tip is higher than wide, its height is the longer side.
    let (ratio, longer) = if ratio > 1.0 { (1.0 / ratio, ratio) } else { (ratio, 1.0) };
    if longer > 1.0 {
        brush.rotation = (brush.rotation + 90.0).rem_euclid(360.0);
    }
    let radius = mask.number("radius").map(|radius| 2.0 * radius);
    let diameter = mask.number("diameter").or(radius).unwrap_or(40.0);
    brush.size = clamp_size(diameter * longer * tip.enlargement(diameter * longer));
    brush.hardness = 0.5 * (fade("hfade") + fade("vfade"));
    brush.tip = match mask.text("type").as_deref() {
        Some("rect") => Tip::Square { ratio: ratio.max(*Tip::RATIO.start()) },
        _ if ratio < 1.0 => Tip::Ellipse { ratio: ratio.max(*Tip::RATIO.start()) },
        _ => Tip::Round,
    };
    if mask.number("spikes").unwrap_or(2.0) > 2.0 {
        notes.push("the spikes of its tip have no counterpart".to_owned());
    }
    if outer.number("density").is_some_and(|v| v < 1.0)
        || outer.number("randomness").is_some_and(|v| v > 0.0)
    {
        notes.push("the specks of its tip have no counterpart".to_owned());
    }
    let step_px = outer.step(brush.size, 0.1);
    spaced(brush, step_px)
}

/// A diameter within its range.
fn clamp_size(size: f32) -> f32 {
    size.max(*Brush::SIZE.start()).min(*Brush::SIZE.end())
}

/// With dabs so many px apart.
fn spaced(brush: Brush, step_px: f32) -> Brush {
    let spacing = (step_px / clamp_size(brush.size)).max(*Brush::SPACING.start()).min(10.0);
    Brush { spacing, ..brush }
}

/// A tip that is one of Krita's files.
fn file_tip(
    preset: &KppPreset,
    outer: &TipDefinition,
    brush: Brush,
    tip: TipUse,
    pictures: &mut KppPictures,
    notes: &mut Vec<String>,
) -> (Brush, Option<String>) {
    let name = outer.text("filename").unwrap_or_default();
    let file = match pictures.find_tip(preset, &name) {
        Ok(file) => file,
        Err(reason) => {
            let step_px = outer.step(brush.size, 0.25);
            return (spaced(brush, step_px), Some(reason));
        }
    };
    notes.extend(file.notes.iter().cloned());
    let look = TipLook::of(outer, &file, tip, notes);
    // Presets of the first version count radii.
    let version = outer.text("BrushVersion").unwrap_or_else(|| "1".to_owned());
    let scale =
        outer.number("scale").unwrap_or(1.0).max(0.0) * if version == "1" { 2.0 } else { 1.0 };
    let own_px = file.own_size() * scale;
    let own_px = own_px * tip.enlargement(own_px.max_element());
    let size = clamp_size(own_px.max_element());
    let step_px = outer.step(extent(preset, &brush, own_px), 0.25);
    let tip = look.tip(file, &name, pictures);
    (spaced(Brush { size, tip, ..brush }, step_px), None)
}

/// A brush of a tip's file in its own size: its dark parts cover, or it keeps its colors.
pub fn plain_brush(file: TipFile, name: &str, pictures: &mut KppPictures) -> Brush {
    let is_colored = file.pictures.iter().any(TipPicture::is_colored);
    let look = if is_colored { TipLook::Stamp } else { TipLook::Mask(TipLevels::none()) };
    let size = clamp_size(file.own_size().max_element());
    let brush = Brush { size, tip: look.tip(file, name, pictures), ..Brush::default() };
    spaced(brush, 0.25 * size)
}

fn stem(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}

/// How far a tip reaches along a stroke, px: along its own x if it turns with the stroke, else the
/// mean of both sides, which Krita tells apart.
fn extent(preset: &KppPreset, brush: &Brush, size_px: Vec2) -> f32 {
    let (sin, cos) = brush.rotation.to_radians().sin_cos();
    let turned = vec2(
        (size_px.x * cos).abs() + (size_px.y * sin).abs(),
        (size_px.x * sin).abs() + (size_px.y * cos).abs(),
    );
    let turns = sensors::of_option(preset, "Rotation", brush, &mut Vec::new());
    let is_turning = turns.iter().any(|(input, _)| *input == Input::Direction);
    if is_turning && preset.is_true("PressureRotation") {
        turned.x
    } else {
        (turned.x * turned.y).max(0.0).sqrt()
    }
}

/// What the pixels of a tip do.
enum TipLook {
    /// They cover, dark ones most.
    Mask(TipLevels),
    /// They keep their colors.
    Stamp,
    /// Their alpha covers; their light would change the color, or choose one of a gradient.
    Alpha,
    /// They cover, light ones most: a stamp that becomes coverage.
    Light,
}

impl TipLook {
    fn of(outer: &TipDefinition, file: &TipFile, tip: TipUse, notes: &mut Vec<String>) -> Self {
        const STAMP: i32 = 1;
        const LIGHTNESS: i32 = 2;
        const GRADIENT: i32 = 3;
        let is_colored = file.pictures.iter().any(TipPicture::is_colored);
        // Older presets have a word each for two of the uses.
        let older = match (outer.is_set("preserveLightness"), outer.is_set("ColorAsMask")) {
            (true, _) => LIGHTNESS,
            (false, false) => STAMP,
            _ => 0,
        };
        let mask = || TipLook::Mask(TipLevels::of(outer));
        let lost = match outer.number("brushApplication").map_or(older, |v| v as i32) {
            STAMP if is_colored && tip != TipUse::First => return TipLook::Light,
            STAMP if is_colored => return TipLook::Stamp,
            LIGHTNESS if is_colored => "its tip also lightens and darkens the color there",
            GRADIENT if is_colored => "its tip takes the colors of a gradient there",
            _ => return mask(),
        };
        notes.push(lost.to_owned());
        if file.has_alpha() { TipLook::Alpha } else { mask() }
    }

    fn tip(&self, file: TipFile, name: &str, pictures: &mut KppPictures) -> Tip {
        let several = file.pictures.len() > 1;
        let name_of = |i: usize| match several {
            true => format!("{} {}", stem(name), i + 1),
            false => stem(name).to_owned(),
        };
        let numbered = file.pictures.iter().enumerate();
        let sources: Vec<PictureSource> =
            numbered.map(|(i, picture)| pictures.add(self.picture(picture), &name_of(i))).collect();
        match (file.ranks, sources.as_slice()) {
            (None, [source]) => Tip::Picture(source.clone()),
            (ranks, _) => Tip::Hose(Hose::new(sources, ranks.unwrap_or_default())),
        }
    }

    /// The picture as a tip here: coverage as opaque grays, or colors.
    fn picture(&self, tip: &TipPicture) -> Picture {
        let Texels::Srgb8(texels) = &tip.picture.texels else { return tip.picture.clone() };
        let cover = |a: u8| [a, a, a, 255];
        let texels: Vec<[u8; 4]> = match self {
            _ if tip.is_coverage => return tip.picture.clone(),
            TipLook::Stamp => return tip.picture.clone(),
            TipLook::Alpha => texels.iter().map(|&[.., a]| cover(a)).collect(),
            TipLook::Light => {
                let light = |texel: &[u8; 4]| u32::from(gray(texel)) * u32::from(texel[3]);
                texels.iter().map(|texel| cover(((light(texel) + 127) / 255) as u8)).collect()
            }
            TipLook::Mask(levels) => {
                let table = levels.table(tip);
                let one = |texel: &[u8; 4]| {
                    let dark = 255 - u32::from(table[usize::from(gray(texel))]);
                    cover(((dark * u32::from(texel[3]) + 127) / 255) as u8)
                };
                texels.iter().map(one).collect()
            }
        };
        Picture::srgb8(tip.picture.size, texels).unwrap_or_else(|| tip.picture.clone())
    }
}

/// How the grays of a tip with colors are changed.
struct TipLevels {
    /// The gray that keeps its place; `None` for the mean of the picture.
    middle: Option<f32>,
    /// Where that gray goes, `[-1, 1]`.
    brightness: f32,
    /// How much steeper both sides are, `[-1, 1)`.
    contrast: f32,
}

impl TipLevels {
    fn of(outer: &TipDefinition) -> Self {
        let middle = outer.number("AdjustmentMidPoint").unwrap_or(127.0).max(1.0).min(254.0);
        let share = |name: &str| outer.number(name).unwrap_or(0.0).max(-1.0).min(0.99);
        Self {
            middle: (!outer.is_set("AutoAdjustMidPoint")).then_some(middle),
            brightness: share("BrightnessAdjustment"),
            contrast: share("ContrastAdjustment"),
        }
    }

    /// They stay as they are.
    fn none() -> Self {
        Self { middle: None, brightness: 0.0, contrast: 0.0 }
    }

    /// What becomes of each gray of a picture.
    fn table(&self, tip: &TipPicture) -> Vec<u8> {
        if (self.brightness == 0.0 && self.contrast == 0.0) || !tip.is_colored() {
            return (0..=255).collect();
        }
        let from = self.middle.unwrap_or_else(|| tip.mean_gray()).max(1.0).min(254.0);
        let to = 127.5 * (1.0 + self.brightness);
        let steeper =
            if self.contrast > 0.0 { 1.0 / (1.0 - self.contrast) } else { 1.0 + self.contrast };
        let (below, above) = (to / from * steeper, (255.0 - to) / (255.0 - from) * steeper);
        let of = |v: f32| to + (v - from) * if v < from { below } else { above };
        (0..=255).map(|v| of(v as f32).round().max(0.0).min(255.0) as u8).collect()
    }
}
