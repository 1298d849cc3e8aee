//! Layer effects as Photoshop's descriptors say them. Floor 5. Not here: composing them
//! (`document`), the pictures of patterns (`pattern`).
//!
//! The block `lfx2` has one effect of each kind; the newer `lmfx` may have lists of one kind, and
//! counts where both are there; groups have `lfxs`. The old block `lrFX` repeats them.

mod old;
mod write;

pub use write::{as_read, blocks};

use super::colors::Colors;
use super::cursor::ByteCursor;
use super::descriptor::{self, DescriptorObject};
use super::fill::{self, share};
use super::nesting::is_of_fill;
use super::ramp;
use crate::math::{Vec2, vec2};
use crate::paint::adjustment::ToneCurve;
use crate::paint::effect::{
    BevelStyle, BevelTechnique, EffectFill, EffectSettings, GlowSource, GlowTechnique,
    StrokePosition,
};
use crate::paint::{EffectKind, LayerEffect};
use crate::raster::BlendMode;

/// The blocks that hold effects, the one that counts most last.
pub const KEYS: [[u8; 4]; 2] = [*b"lfx2", *b"lmfx"];
/// The block of groups, which counts as much as the first.
pub const OF_GROUPS: [u8; 4] = *b"lfxs";
/// The old block.
pub const OLD: [u8; 4] = *b"lrFX";

/// The effects of a record.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordEffects {
    /// As this program has them.
    pub list: Vec<LayerEffect>,
    /// The patterns that some of them are filled with, by their numbers.
    pub patterns: Vec<(usize, String)>,
    /// What is left out of them.
    pub lost: Vec<&'static str>,
    /// Which block they came from.
    rank: usize,
}

impl RecordEffects {
    /// Whether any is shown on what the layer is filled with.
    pub fn has_within(&self) -> bool {
        self.list.iter().any(|effect| effect.on && is_of_fill(effect))
    }

    /// Whether any of them is switched on.
    pub fn is_shown(&self) -> bool {
        self.list.iter().any(|effect| effect.on)
    }

    /// Patterns that go with their layer begin at a point of the canvas.
    pub fn begin_patterns_at(&mut self, (x, y): (f64, f64)) {
        for (number, _) in &self.patterns {
            let Some(effect) = self.list.get_mut(*number).filter(|e| e.settings.aligned) else {
                continue;
            };
            effect.settings.aligned = false;
            effect.settings.phase_x += x as f32;
            effect.settings.phase_y += y as f32;
            *effect = effect.clone().clamp_to_ranges();
        }
    }
}

/// Each kind with its name where there is one effect of it, and where there is a list.
const KINDS: [(EffectKind, &str, &str); 10] = [
    (EffectKind::DropShadow, "DrSh", "dropShadowMulti"),
    (EffectKind::InnerShadow, "IrSh", "innerShadowMulti"),
    (EffectKind::OuterGlow, "OrGl", "outerGlowMulti"),
    (EffectKind::InnerGlow, "IrGl", "innerGlowMulti"),
    (EffectKind::Bevel, "ebbl", "bevelEmbossMulti"),
    (EffectKind::Satin, "ChFX", "chromeFXMulti"),
    (EffectKind::ColorOverlay, "SoFi", "solidFillMulti"),
    (EffectKind::GradientOverlay, "GrFl", "gradientFillMulti"),
    (EffectKind::PatternOverlay, "patternFill", "patternFillMulti"),
    (EffectKind::Stroke, "FrFX", "frameFXMulti"),
];

/// Photoshop's words for blend modes in descriptors.
const BLENDS: [(BlendMode, &str); 27] = [
    (BlendMode::Normal, "Nrml"),
    (BlendMode::Dissolve, "Dslv"),
    (BlendMode::Multiply, "Mltp"),
    (BlendMode::Screen, "Scrn"),
    (BlendMode::Overlay, "Ovrl"),
    (BlendMode::SoftLight, "SftL"),
    (BlendMode::HardLight, "HrdL"),
    (BlendMode::ColorDodge, "CDdg"),
    (BlendMode::ColorBurn, "CBrn"),
    (BlendMode::Darken, "Drkn"),
    (BlendMode::Lighten, "Lghn"),
    (BlendMode::Difference, "Dfrn"),
    (BlendMode::Exclusion, "Xclu"),
    (BlendMode::Hue, "H   "),
    (BlendMode::Saturation, "Strt"),
    (BlendMode::Color, "Clr "),
    (BlendMode::Luminosity, "Lmns"),
    (BlendMode::LinearDodge, "linearDodge"),
    (BlendMode::LinearBurn, "linearBurn"),
    (BlendMode::LinearLight, "linearLight"),
    (BlendMode::VividLight, "vividLight"),
    (BlendMode::PinLight, "pinLight"),
    (BlendMode::HardMix, "hardMix"),
    (BlendMode::DarkerColor, "darkerColor"),
    (BlendMode::LighterColor, "lighterColor"),
    (BlendMode::Subtract, "blendSubtraction"),
    (BlendMode::Divide, "blendDivide"),
];

/// Their words in files of 2026 and later, where those differ.
const NEWER_BLENDS: [(BlendMode, &str); 17] = [
    (BlendMode::Normal, "normal"),
    (BlendMode::Dissolve, "dissolve"),
    (BlendMode::Multiply, "multiply"),
    (BlendMode::Screen, "screen"),
    (BlendMode::Overlay, "overlay"),
    (BlendMode::SoftLight, "softLight"),
    (BlendMode::HardLight, "hardLight"),
    (BlendMode::ColorDodge, "colorDodge"),
    (BlendMode::ColorBurn, "colorBurn"),
    (BlendMode::Darken, "darken"),
    (BlendMode::Lighten, "lighten"),
    (BlendMode::Difference, "difference"),
    (BlendMode::Exclusion, "exclusion"),
    (BlendMode::Hue, "hue"),
    (BlendMode::Saturation, "saturation"),
    (BlendMode::Color, "color"),
    (BlendMode::Luminosity, "luminosity"),
];

/// Reads a block into the effects of a record, unless they came from one that counts more.
pub fn take(effects: &mut Option<RecordEffects>, key: [u8; 4], data: ByteCursor, colors: &Colors) {
    let of_layers = if key == OF_GROUPS { KEYS[0] } else { key };
    let rank = KEYS.iter().position(|known| *known == of_layers).map_or(0, |place| place + 1);
    if effects.as_ref().is_some_and(|known| known.rank > rank) {
        return;
    }
    let unread = || RecordEffects { lost: vec![LEFT_OUT], rank, ..RecordEffects::default() };
    let read = if key == OLD { old::read(data, colors) } else { read(data, colors) };
    *effects = Some(read.map_or_else(unread, |read| RecordEffects { rank, ..read }));
}

/// What is noted where effects are not understood.
const LEFT_OUT: &str = "its effects are left out";

fn read(mut data: ByteCursor, colors: &Colors) -> Option<RecordEffects> {
    data.u32()?;
    let said = descriptor::read(&mut data)?;
    let is_shown = !said.is_false("masterFXSwitch");
    let mut found = RecordEffects::default();
    for (kind, one, many) in KINDS {
        let listed: Vec<&DescriptorObject> = said.objects(many).collect();
        let single = said.object(one).filter(|_| listed.is_empty());
        for object in listed.into_iter().chain(single) {
            let is_on = object.is_set("enab");
            // Without this Photoshop keeps numbers of effects that are not there.
            if (is_on || object.is_set("present")) && found.list.len() < LayerEffect::MOST {
                effect(&mut found, kind, object, colors, is_on && is_shown);
            }
        }
    }
    Some(found)
}

/// The settings that most kinds have, by the same names.
fn common(settings: &mut EffectSettings, said: &DescriptorObject, colors: &Colors) {
    settings.blend = blend(said, "Md  ").unwrap_or(settings.blend);
    settings.opacity = share(said, "Opct", settings.opacity);
    if let Some(color) = said.object("Clr ").and_then(|said| fill::color(said, colors)) {
        settings.color = color;
    }
    let number = |name: &str, before: f32| said.number(name).unwrap_or(before);
    settings.angle = number("lagl", settings.angle);
    settings.document_light = said.is_set("uglg");
    settings.distance = number("Dstn", settings.distance);
    settings.spread = share(said, "Ckmt", 0.0);
    settings.size = number("blur", settings.size);
    settings.noise = share(said, "Nose", 0.0);
}

fn effect(
    found: &mut RecordEffects,
    kind: EffectKind,
    said: &DescriptorObject,
    colors: &Colors,
    on: bool,
) {
    let mut effect = LayerEffect { on, ..LayerEffect::new(kind) };
    common(&mut effect.settings, said, colors);
    let is_unknown = |name: &str| said.word(name).is_some() && blend(said, name).is_none();
    if on && ["Md  ", "hglM", "sdwM"].into_iter().any(is_unknown) {
        lose(found, "the blend mode of an effect is unknown");
    }
    for name in ["TrnS", "MpgS"] {
        effect.contour = said.object(name).and_then(contour).unwrap_or(effect.contour);
    }
    match kind {
        EffectKind::DropShadow => effect.settings.knockout = !said.is_false("layerConceals"),
        EffectKind::InnerShadow | EffectKind::ColorOverlay => {}
        EffectKind::OuterGlow | EffectKind::InnerGlow => glow(found, &mut effect, said, colors),
        EffectKind::Bevel => bevel(found, &mut effect.settings, said, colors),
        EffectKind::Satin => effect.settings.invert = said.is_set("Invr"),
        EffectKind::GradientOverlay => read_ramp(found, &mut effect, said, colors),
        EffectKind::PatternOverlay => pattern(found, &mut effect.settings, said),
        EffectKind::Stroke => line(found, &mut effect, said, colors),
    }
    let effect = effect.with_own_settings();
    let lossless = effect.clone().clamp_to_ranges();
    if lossless != effect && on {
        lose(found, "an effect is larger elsewhere than it can be here");
    }
    found.list.push(lossless);
}

fn lose(found: &mut RecordEffects, what: &'static str) {
    if !found.lost.contains(&what) {
        found.lost.push(what);
    }
}

/// The blend mode that Photoshop's word means.
pub fn blend(said: &DescriptorObject, name: &str) -> Option<BlendMode> {
    let word = said.word(name)?;
    let mut known = BLENDS.iter().chain(&NEWER_BLENDS);
    known.find(|(_, known)| known.as_bytes() == word).map(|(mode, _)| *mode)
}

/// Points of a curve, 0 to 255.
fn contour(said: &DescriptorObject) -> Option<ToneCurve> {
    let point = |object: &DescriptorObject| Some([object.number("Hrzn")?, object.number("Vrtc")?]);
    let points: Vec<[f32; 2]> = said.objects("Crv ").map(point).collect::<Option<_>>()?;
    let curve = ToneCurve::new(points);
    (curve.points().len() > 1).then_some(curve)
}

fn read_ramp(
    found: &mut RecordEffects,
    effect: &mut LayerEffect,
    said: &DescriptorObject,
    colors: &Colors,
) {
    if said.word("Type") == Some(b"ShpB") {
        lose(found, "a ramp along the layer's edge is straight here");
    }
    let Some(read) = ramp::gradient(said, colors) else {
        return lose(found, "a ramp made of noise is left out");
    };
    let s = &mut effect.settings;
    (s.ramp, s.angle, s.scale, s.aligned) = (read.way, read.degrees, read.scale, read.aligned);
    (s.offset_x, s.offset_y) = (read.offset.x, read.offset.y);
    effect.stops = read.stops;
}

fn glow(
    found: &mut RecordEffects,
    effect: &mut LayerEffect,
    said: &DescriptorObject,
    colors: &Colors,
) {
    if let Some(read) = said.object("Grad").map(|_| ramp::gradient(said, colors)) {
        effect.settings.fill = EffectFill::Gradient;
        match read {
            Some(read) => effect.stops = read.stops,
            None => lose(found, "a ramp made of noise is left out"),
        }
    }
    let s = &mut effect.settings;
    s.glow = match said.word("GlwT") {
        Some(b"PrBL") => GlowTechnique::Precise,
        _ => GlowTechnique::Softer,
    };
    s.source = match said.word("glwS") {
        Some(b"SrcC") => GlowSource::Center,
        _ => GlowSource::Edge,
    };
    s.range = share(said, "Inpr", s.range);
}

fn bevel(
    found: &mut RecordEffects,
    s: &mut EffectSettings,
    said: &DescriptorObject,
    colors: &Colors,
) {
    s.bevel = match said.word("bvlS") {
        Some(b"OtrB") => BevelStyle::Outer,
        Some(b"Embs") => BevelStyle::Emboss,
        Some(b"PlEb") => BevelStyle::Pillow,
        Some(b"strokeEmboss") => {
            lose(found, "an embossed stroke is an emboss here");
            BevelStyle::Emboss
        }
        _ => BevelStyle::Inner,
    };
    s.technique = match said.word("bvlT") {
        Some(b"SfBL") | None => BevelTechnique::Smooth,
        Some(_) => BevelTechnique::Chisel,
    };
    s.sunken = said.word("bvlD") == Some(b"Out ");
    s.altitude = said.number("Lald").unwrap_or(s.altitude);
    s.depth = share(said, "srgR", s.depth);
    s.soften = said.number("Sftn").unwrap_or(0.0);
    s.blend = blend(said, "hglM").unwrap_or(s.blend);
    s.shade_blend = blend(said, "sdwM").unwrap_or(s.shade_blend);
    (s.opacity, s.shade_opacity) =
        (share(said, "hglO", s.opacity), share(said, "sdwO", s.shade_opacity));
    let color = |name: &str| said.object(name).and_then(|said| fill::color(said, colors));
    s.color = color("hglC").unwrap_or(s.color);
    s.shade_color = color("sdwC").unwrap_or(s.shade_color);
    if said.is_set("useShape") {
        lose(found, "the contour of a bevel's edge is left out");
    }
    if said.is_set("useTexture") {
        lose(found, "the texture of a bevel is left out");
    }
}

fn pattern(found: &mut RecordEffects, s: &mut EffectSettings, said: &DescriptorObject) {
    s.scale = share(said, "Scl ", s.scale);
    s.aligned = !said.is_false("Algn");
    let phase = said.object("phase");
    let along = |name: &str| phase.and_then(|phase| phase.number(name)).unwrap_or(0.0);
    let Vec2 { x, y } = vec2(along("Hrzn"), along("Vrtc"));
    (s.phase_x, s.phase_y) = (x, y);
    let id = said.object("Ptrn").and_then(|named| named.text("Idnt"));
    found.patterns.push((found.list.len(), id.unwrap_or_default().to_owned()));
}

fn line(
    found: &mut RecordEffects,
    effect: &mut LayerEffect,
    said: &DescriptorObject,
    colors: &Colors,
) {
    let s = &mut effect.settings;
    s.size = said.number("Sz  ").unwrap_or(s.size);
    s.position = match said.word("Styl") {
        Some(b"InsF") => StrokePosition::Inside,
        Some(b"CtrF") => StrokePosition::Center,
        _ => StrokePosition::Outside,
    };
    let is_translucent = s.opacity < 1.0 || s.blend != BlendMode::Normal;
    let lies_on_layer = said.is_set("overprint") && s.position != StrokePosition::Outside;
    if effect.on && is_translucent && lies_on_layer {
        lose(found, "a line that lies on its layer hides it here");
    }
    match said.word("PntT") {
        Some(b"GrFl") => {
            s.fill = EffectFill::Gradient;
            read_ramp(found, effect, said, colors);
        }
        Some(b"Ptrn") => {
            s.fill = EffectFill::Pattern;
            pattern(found, s, said);
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests;
