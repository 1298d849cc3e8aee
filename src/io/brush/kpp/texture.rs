//! The texture of a Krita preset as grain. Floor 5.
//!
//! Krita changes each dab's coverage d by the texture's gray t at a strength s, in one of many ways
//! f(t, d, s). Grain multiplies: d · G(t). So the grays of the pattern are replaced by those that a
//! fully covered dab has, G(t) = f(t, 1, s) / max f, and the flow follows the strength: at each
//! reading it is multiplied by the paint that the texture leaves there, relative to the full
//! strength. For plain multiplication, f = t d s, both together are exact.

use super::pictures::KppPictures;
use super::settings::KppPreset;
use super::{sensors, tip_file};
use crate::math::Size;
use crate::paint::Brush;
use crate::paint::dynamics::{Curve, Input, Property};
use crate::paint::grain::{BrushGrain, GrainSource};
use crate::raster::Picture;
use crate::raster::picture::Texels;

/// The reading at which a texture whose strength follows the pen looks as it does in Krita: a hand
/// that is neither light nor heavy.
const USUAL: f32 = 0.5;

/// How a texture changes a dab, by Krita's numbers.
const MODES: [(&str, TextureMode); 16] = [
    ("multiply", TextureMode::Multiply),
    ("subtract", TextureMode::Subtract),
    ("lightness", TextureMode::Color),
    ("gradient", TextureMode::Color),
    ("darken", TextureMode::Darken),
    ("overlay", TextureMode::Overlay),
    ("color dodge", TextureMode::Dodge),
    ("color burn", TextureMode::Burn),
    ("linear dodge", TextureMode::LinearDodge),
    ("linear burn", TextureMode::LinearBurn),
    ("hard mix", TextureMode::HardMix),
    ("hard mix softer", TextureMode::SofterMix),
    ("height", TextureMode::Height),
    ("linear height", TextureMode::LinearHeight),
    ("height (Photoshop)", TextureMode::PhotoshopHeight),
    ("linear height (Photoshop)", TextureMode::PhotoshopLinearHeight),
];

#[derive(Clone, Copy, Debug, PartialEq)]
enum TextureMode {
    Multiply,
    Subtract,
    /// It changes the color, not the coverage.
    Color,
    Darken,
    Overlay,
    Dodge,
    Burn,
    LinearDodge,
    LinearBurn,
    HardMix,
    SofterMix,
    Height,
    LinearHeight,
    PhotoshopHeight,
    PhotoshopLinearHeight,
}

impl TextureMode {
    /// The share of a dab's coverage that is left at a gray, all in `[0, 1]`.
    fn share_at(self, t: f32, s: f32) -> f32 {
        // Where a full dab shows nothing of the texture, what a half covered one shows.
        let half = s.min(0.5);
        let steep = 1.0 / (1.0 - 0.99 * s);
        let left = match self {
            TextureMode::Color => 1.0,
            TextureMode::Multiply => t * s,
            TextureMode::Subtract => s - t,
            TextureMode::Darken => t.min(s),
            TextureMode::Overlay => 2.0 * half * t,
            TextureMode::Dodge => half / (1.0 - t).max(1e-3),
            TextureMode::Burn => 1.0 - (1.0 - half) / t.max(1e-3),
            TextureMode::LinearDodge => t + half,
            TextureMode::LinearBurn => t + s - 1.0,
            TextureMode::HardMix => f32::from(u8::from(t + half > 1.0)),
            TextureMode::SofterMix => 3.0 * half - 2.0 * (1.0 - t),
            TextureMode::Height => steep - (t + 1.0 / steep),
            TextureMode::LinearHeight => (steep * (1.0 - t)).max(steep - t),
            TextureMode::PhotoshopHeight => 10.0 * s - t,
            TextureMode::PhotoshopLinearHeight => (10.0 * s * (1.0 - t)).max(10.0 * s - t),
        };
        left.max(0.0).min(1.0)
    }
}

/// A texture's own settings.
struct TextureSettings {
    mode: TextureMode,
    strength: f32,
    /// The strength takes the texture back instead of the paint.
    is_soft: bool,
}

impl TextureSettings {
    fn share_at(&self, t: f32, s: f32) -> f32 {
        if self.is_soft {
            1.0 - s * (1.0 - self.mode.share_at(t, 1.0))
        } else {
            self.mode.share_at(t, s)
        }
    }
}

/// A brush with the texture of a preset, if it has one.
pub fn read(
    preset: &KppPreset,
    brush: Brush,
    pictures: &mut KppPictures,
    notes: &mut Vec<String>,
) -> Brush {
    if !preset.is_true("Texture/Pattern/Enabled") {
        return brush;
    }
    let number = preset.number("Texture/Pattern/TexturingMode").unwrap_or(0.0);
    let Some((name, mode)) = MODES.get(number.max(0.0) as usize).copied() else {
        notes.push(format!("the way “{number}” of its texture is not known"));
        return brush;
    };
    if mode == TextureMode::Color {
        notes.push(format!("its texture changes the color there (“{name}”), which is left out"));
        return brush;
    }
    let pattern = match pictures.find_pattern(preset) {
        Ok(pattern) => pattern,
        Err(reason) => {
            notes.push(format!("the pattern of its texture {reason}"));
            return brush;
        }
    };
    if mode != TextureMode::Multiply {
        notes.push(format!("its texture, “{name}” there, takes paint away in proportion here"));
    }
    let settings = TextureSettings {
        mode,
        strength: preset.unit("Texture/Strength/Value", 1.0),
        is_soft: preset.is_true("Texture/Pattern/UseSoftTexturing"),
    };
    with_grain(preset, brush, &settings, &pattern, pictures, notes)
}

/// What the strength follows.
fn strength_drives(
    preset: &KppPreset,
    brush: &Brush,
    notes: &mut Vec<String>,
) -> Vec<(Input, Curve)> {
    // Older presets write the name of the option with and without its last stroke.
    let is_on = preset.is_true("PressureTexture/Strength/")
        || preset.is_true("PressureTexture/Strength")
        || preset.text("PressureTexture/Strength/").is_empty();
    if is_on { sensors::of_option(preset, "Texture/Strength/", brush, notes) } else { Vec::new() }
}

/// The grain, and the flow that goes with it.
fn with_grain(
    preset: &KppPreset,
    brush: Brush,
    settings: &TextureSettings,
    pattern: &Picture,
    pictures: &mut KppPictures,
    notes: &mut Vec<String>,
) -> Brush {
    let Texels::Srgb8(texels) = &pattern.texels else { return brush };
    let followed = strength_drives(preset, &brush, notes);
    let grays: Vec<u8> = texels.iter().map(pattern_gray).collect();
    let counts = GrayCounts::of(&grays, &PatternLevels::of(preset));
    let full = settings.strength;
    let paint = |s: f32| counts.sum(|t| settings.share_at(t, s));
    let usual = followed.iter().fold(full, |s, (_, curve)| s * curve.at(USUAL));
    let usual = if paint(usual) > 0.0 { usual } else { full };
    let most =
        (0..=255u8).map(|t| settings.share_at(f32::from(t) / 255.0, usual)).fold(0.0, f32::max);
    // A texture that leaves no paint where a dab is not full is taken as it is.
    let is_bare = paint(usual) <= 0.0;
    let baked = |t: f32| if is_bare { t } else { settings.share_at(t, usual) / most.max(1e-3) };
    let Some(grain) = grain(preset, pattern.size, &grays, &counts.table(baked), pictures, notes)
    else {
        return brush;
    };
    let mut brush = Brush { grain: Some(grain), ..brush };
    if !is_bare {
        brush.flow *= share(paint(full), counts.sum(baked));
        for (input, curve) in &followed {
            let by = sensors::curve_of(|x| share(paint(full * curve.at(x)), paint(full)));
            if let Some(by) = by {
                brush = sensors::with_factor(brush, Property::Flow, *input, by);
            }
        }
    }
    brush
}

/// A part of a whole, `[0, 1]`; 1 of nothing.
fn share(part: f64, whole: f64) -> f32 {
    if whole > 0.0 { (part / whole).max(0.0).min(1.0) as f32 } else { 1.0 }
}

/// How often each gray of a pattern is there, and what it becomes before it acts.
struct GrayCounts {
    counts: [f64; 256],
    grays: [f32; 256],
}

impl GrayCounts {
    fn of(grays: &[u8], levels: &PatternLevels) -> Self {
        let mut counts = [0.0; 256];
        grays.iter().for_each(|gray| counts[usize::from(*gray)] += 1.0);
        Self { counts, grays: std::array::from_fn(|i| levels.gray(i as f32 / 255.0)) }
    }

    /// The sum over all pixels.
    fn sum(&self, of: impl Fn(f32) -> f32) -> f64 {
        self.grays.iter().zip(&self.counts).map(|(t, count)| f64::from(of(*t)) * count).sum()
    }

    /// What replaces each gray.
    fn table(&self, by: impl Fn(f32) -> f32) -> [u8; 256] {
        self.grays.map(|t| (by(t) * 255.0).round().max(0.0).min(255.0) as u8)
    }
}

/// A pattern's pixel as Krita's gray; what is transparent is white.
fn pattern_gray(texel: &[u8; 4]) -> u8 {
    let (gray, alpha) = (u32::from(tip_file::gray(texel)), u32::from(texel[3]));
    ((gray * alpha + 255 * (255 - alpha) + 127) / 255) as u8
}

/// How the grays of a pattern are changed before they act.
struct PatternLevels {
    brightness: f32,
    contrast: f32,
    is_inverted: bool,
    /// The gray that becomes the middle.
    neutral: f32,
    /// Grays outside of this range become the last number, if there is one.
    kept: [f32; 2],
    beyond: Option<f32>,
}

impl PatternLevels {
    fn of(preset: &KppPreset) -> Self {
        let of = |name: &str| preset.number(&format!("Texture/Pattern/{name}"));
        Self {
            brightness: of("Brightness").unwrap_or(0.0),
            contrast: of("Contrast").unwrap_or(1.0),
            is_inverted: preset.is_true("Texture/Pattern/Invert"),
            neutral: of("NeutralPoint").unwrap_or(0.5).max(0.005).min(0.995),
            kept: [("CutoffLeft", 0.0), ("CutoffRight", 255.0)]
                .map(|(name, plain)| of(name).unwrap_or(plain) / 255.0),
            beyond: match of("CutoffPolicy").map(|v| v as i32) {
                Some(1) => Some(0.0),
                Some(2) => Some(1.0),
                _ => None,
            },
        }
    }

    fn gray(&self, v: f32) -> f32 {
        let v = ((v - self.brightness - 0.5) * self.contrast + 0.5).max(0.0).min(1.0);
        let v = if self.is_inverted { 1.0 - v } else { v };
        let n = self.neutral;
        let v = if v <= n { 0.5 * v / n } else { 0.5 + 0.5 * (v - n) / (1.0 - n) };
        match self.beyond {
            Some(beyond) if v < self.kept[0] || v > self.kept[1] => beyond,
            _ => v,
        }
    }
}

/// `replaced`: what each gray becomes.
fn grain(
    preset: &KppPreset,
    size: Size,
    grays: &[u8],
    replaced: &[u8; 256],
    pictures: &mut KppPictures,
    notes: &mut Vec<String>,
) -> Option<BrushGrain> {
    let scale = preset.number("Texture/Pattern/Scale").unwrap_or(1.0).max(1e-3);
    let offset = ["X", "Y"].map(|axis| {
        let is_random = preset.is_true(&format!("Texture/Pattern/isRandomOffset{axis}"));
        (!is_random).then(|| preset.number(&format!("Texture/Pattern/Offset{axis}")).unwrap_or(0.0))
    });
    if offset.contains(&None) {
        notes.push("its texture lies at the same place for every stroke".to_owned());
    }
    let texels_by = offset.map(|px| (px.unwrap_or(0.0) / scale).round());
    let moved = shift(size, grays, texels_by).map(|gray| replaced[usize::from(gray)]);
    let texels = moved.map(|v| [v, v, v, 255]).collect();
    let source = pictures.add(Picture::srgb8(size, texels)?, "texture");
    let size_px = size.longer_side() * scale;
    Some(BrushGrain {
        source: GrainSource::Picture(source),
        size_px: size_px.max(*BrushGrain::SIZE_PX.start()).min(*BrushGrain::SIZE_PX.end()),
        ..BrushGrain::default()
    })
}

/// The grays of a repeated picture that is moved to the right and down.
fn shift(size: Size, grays: &[u8], offset: [f32; 2]) -> impl Iterator<Item = u8> {
    let (width, height) = (size.width as usize, size.height as usize);
    let by = |offset: f32, side: usize| (offset.rem_euclid(side as f32) as usize).min(side - 1);
    let (right, down) = (by(offset[0], width), by(offset[1], height));
    let at = move |x: usize, y: usize| {
        let (x, y) = ((x + width - right) % width, (y + height - down) % height);
        grays.get(y * width + x).copied().unwrap_or(0)
    };
    (0..height).flat_map(move |y| (0..width).map(move |x| at(x, y)))
}

#[cfg(test)]
mod tests;
