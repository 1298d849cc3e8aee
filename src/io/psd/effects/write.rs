//! Effects as Photoshop's descriptors. Floor 5.

use super::{BLENDS, KEYS, KINDS, RecordEffects};
use crate::math::srgb::Color;
use crate::paint::adjustment::ToneCurve;
use crate::paint::effect::{
    BevelStyle, BevelTechnique, EffectFill, GlowSource, GlowTechnique, StrokePosition,
};
use crate::paint::{EffectKind, GradientStop, LayerEffect, RampStyle};
use crate::psd::colors::{Colors, Mode};
use crate::psd::cursor::ByteCursor;
use crate::psd::descriptor::DescriptorWriter;
use crate::raster::BlendMode;

/// A block: its key and data.
type EffectBlock = ([u8; 4], Vec<u8>);

/// What a ramp's places are written of.
const WHOLE: f32 = 4096.0;

/// Effects as they will be read from the blocks that say them; `None` if there is none.
pub fn as_read(effects: &[LayerEffect]) -> Option<RecordEffects> {
    let colors = Colors {
        mode: Mode::Rgb,
        channels: 3,
        is_light: false,
        is_deep_lab: false,
        table: &[],
        nothing: None,
        icc: None,
    };
    let mut read = None;
    for (key, data) in blocks(effects) {
        super::take(&mut read, key, ByteCursor::new(&data), &colors);
    }
    read
}

/// The blocks of effects: the first of each kind, and if there are more, another with all.
pub fn blocks(effects: &[LayerEffect]) -> Vec<EffectBlock> {
    if effects.is_empty() {
        return Vec::new();
    }
    let of = |kind: EffectKind| effects.iter().filter(move |effect| effect.kind == kind);
    let has_lists = KINDS.iter().any(|(kind, ..)| of(*kind).count() > 1);
    let block = |key: [u8; 4], with_lists: bool| {
        let mut said = DescriptorWriter::default();
        said.measure("Scl ", "#Prc", 100.0);
        said.flag("masterFXSwitch", true);
        for (kind, one, many) in KINDS {
            let all: Vec<&LayerEffect> = of(kind).collect();
            match (all.first(), with_lists && all.len() > 1) {
                (None, _) => {}
                (Some(_), true) => {
                    said.objects(
                        many,
                        one,
                        all.iter().map(|effect| write_effect(effect)).collect(),
                    );
                }
                (Some(first), false) => said.object(one, one, write_effect(first)),
            }
        }
        let mut data = vec![0; 4];
        data.extend(said.into_bytes());
        (key, data)
    };
    let [single, lists] = KEYS;
    let mut out = vec![block(single, false)];
    if has_lists {
        out.push(block(lists, true));
    }
    out
}

fn percent(said: &mut DescriptorWriter, name: &str, share: f32) {
    said.measure(name, "#Prc", f64::from(share) * 100.0);
}

fn px(said: &mut DescriptorWriter, name: &str, length: f32) {
    said.measure(name, "#Pxl", f64::from(length));
}

fn blend(said: &mut DescriptorWriter, name: &str, mode: BlendMode) {
    let known = BLENDS.iter().find(|(known, _)| *known == mode);
    said.word(name, "BlnM", known.map_or("Nrml", |(_, word)| word));
}

fn write_effect(effect: &LayerEffect) -> DescriptorWriter {
    let (mut said, s) = (DescriptorWriter::default(), &effect.settings);
    said.flag("enab", effect.on);
    said.flag("present", true);
    said.flag("showInDialog", true);
    if effect.kind == EffectKind::Bevel {
        bevel(&mut said, effect);
        return said;
    }
    if effect.kind == EffectKind::Stroke {
        let position = match s.position {
            StrokePosition::Outside => "OutF",
            StrokePosition::Inside => "InsF",
            StrokePosition::Center => "CtrF",
        };
        said.word("Styl", "FStl", position);
        let fill = if s.fill == EffectFill::Gradient { "GrFl" } else { "SClr" };
        said.word("PntT", "FrFl", fill);
    }
    blend(&mut said, "Md  ", s.blend);
    percent(&mut said, "Opct", s.opacity);
    match effect.fill() {
        EffectFill::Gradient => ramp(&mut said, effect),
        _ => said.color("Clr ", s.color),
    }
    match effect.kind {
        EffectKind::DropShadow | EffectKind::InnerShadow => {
            said.flag("uglg", s.document_light);
            said.measure("lagl", "#Ang", f64::from(s.angle));
            px(&mut said, "Dstn", s.distance);
            soft(&mut said, effect);
            if effect.kind == EffectKind::DropShadow {
                said.flag("layerConceals", s.knockout);
            }
        }
        EffectKind::OuterGlow | EffectKind::InnerGlow => {
            let technique = if s.glow == GlowTechnique::Precise { "PrBL" } else { "SfBL" };
            said.word("GlwT", "BETE", technique);
            soft(&mut said, effect);
            percent(&mut said, "ShdN", 0.0);
            percent(&mut said, "Inpr", s.range);
            if effect.kind == EffectKind::InnerGlow {
                let source = if s.source == GlowSource::Center { "SrcC" } else { "SrcE" };
                said.word("glwS", "IGSr", source);
            }
        }
        EffectKind::Satin => {
            said.flag("AntA", true);
            said.flag("Invr", s.invert);
            said.measure("lagl", "#Ang", f64::from(s.angle));
            px(&mut said, "Dstn", s.distance);
            px(&mut said, "blur", s.size);
            contour(&mut said, "MpgS", &effect.contour);
        }
        EffectKind::Stroke => px(&mut said, "Sz  ", s.size),
        _ => {}
    }
    said
}

/// The blur of shadows and glows.
fn soft(said: &mut DescriptorWriter, effect: &LayerEffect) {
    let s = &effect.settings;
    // Photoshop writes these shares as pixels.
    px(said, "Ckmt", s.spread * 100.0);
    px(said, "blur", s.size);
    percent(said, "Nose", s.noise);
    said.flag("AntA", false);
    contour(said, "TrnS", &effect.contour);
}

fn contour(said: &mut DescriptorWriter, name: &str, curve: &ToneCurve) {
    let point = |p: &[f32; 2]| {
        let mut said = DescriptorWriter::default();
        said.double("Hrzn", f64::from(p[0]));
        said.double("Vrtc", f64::from(p[1]));
        said
    };
    let mut inner = DescriptorWriter::default();
    inner.text("Nm  ", if curve.is_straight() { "Linear" } else { "Custom" });
    inner.objects("Crv ", "CrPt", curve.points().iter().map(point).collect());
    said.object(name, "ShpC", inner);
}

fn ramp(said: &mut DescriptorWriter, effect: &LayerEffect) {
    let s = &effect.settings;
    said.object("Grad", "Grdn", stops(&effect.stops));
    said.measure("Angl", "#Ang", f64::from(s.angle));
    let style = match s.ramp {
        RampStyle::Linear => "Lnr ",
        RampStyle::Radial => "Rdl ",
        RampStyle::Angle => "Angl",
        RampStyle::Reflected => "Rflc",
        RampStyle::Diamond => "Dmnd",
    };
    said.word("Type", "GrdT", style);
    // Photoshop's ramp around a middle runs the other way round.
    said.flag("Rvrs", s.reverse != (s.ramp == RampStyle::Angle));
    said.flag("Dthr", false);
    said.flag("Algn", s.aligned);
    percent(said, "Scl ", s.scale);
    let mut offset = DescriptorWriter::default();
    percent(&mut offset, "Hrzn", s.offset_x);
    percent(&mut offset, "Vrtc", s.offset_y);
    said.object("Ofst", "Pnt ", offset);
}

fn stops(stops: &[GradientStop]) -> DescriptorWriter {
    let mut said = DescriptorWriter::default();
    said.text("Nm  ", "Custom");
    said.word("GrdF", "GrdF", "CstS");
    // Straight between stops, as here.
    said.double("Intr", 0.0);
    let place = |stop: &GradientStop| (stop.t * WHOLE).round();
    let color = |stop: &GradientStop| {
        let mut said = DescriptorWriter::default();
        said.color("Clr ", Color { a: 255, ..stop.color });
        said.word("Type", "Clry", "UsrS");
        said.whole("Lctn", place(stop));
        said.whole("Mdpn", 50.0);
        said
    };
    let opacity = |stop: &GradientStop| {
        let mut said = DescriptorWriter::default();
        percent(&mut said, "Opct", f32::from(stop.color.a) / 255.0);
        said.whole("Lctn", place(stop));
        said.whole("Mdpn", 50.0);
        said
    };
    said.objects("Clrs", "Clrt", stops.iter().map(color).collect());
    said.objects("Trns", "TrnS", stops.iter().map(opacity).collect());
    said
}

fn bevel(said: &mut DescriptorWriter, effect: &LayerEffect) {
    let s = &effect.settings;
    blend(said, "hglM", s.blend);
    said.color("hglC", s.color);
    percent(said, "hglO", s.opacity);
    blend(said, "sdwM", s.shade_blend);
    said.color("sdwC", s.shade_color);
    percent(said, "sdwO", s.shade_opacity);
    let technique = if s.technique == BevelTechnique::Smooth { "SfBL" } else { "PrBL" };
    said.word("bvlT", "bvlT", technique);
    let style = match s.bevel {
        BevelStyle::Inner => "InrB",
        BevelStyle::Outer => "OtrB",
        BevelStyle::Emboss => "Embs",
        BevelStyle::Pillow => "PlEb",
    };
    said.word("bvlS", "BESl", style);
    said.flag("uglg", s.document_light);
    said.measure("lagl", "#Ang", f64::from(s.angle));
    said.measure("Lald", "#Ang", f64::from(s.altitude));
    percent(said, "srgR", s.depth);
    px(said, "blur", s.size);
    said.word("bvlD", "BESs", if s.sunken { "Out " } else { "In  " });
    contour(said, "TrnS", &effect.contour);
    said.flag("antialiasGloss", false);
    px(said, "Sftn", s.soften);
    said.flag("useShape", false);
    said.flag("useTexture", false);
}
