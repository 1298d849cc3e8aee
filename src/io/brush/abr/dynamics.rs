//! What drives a Photoshop brush: shape dynamics, scattering, texture, color dynamics and
//! transfer. Floor 5. Each has a switch in the description of the brush. Not here: its tip
//! (`presets`).
//!
//! A control says which input a property follows and how far it falls (“minimum”); a jitter reduces
//! the property at random, dab by dab.

use crate::brush::TipNames;
use crate::math::{srgb, vec2};
use crate::paint::dynamics::{Curve, Dynamics, Input, Property};
use crate::paint::grain::{BrushGrain, GrainSource};
use crate::paint::{Brush, ColorJitter, Tip};
use crate::psd::descriptor::DescriptorObject;
use crate::psd::pattern::PatternResource;
use crate::raster::Picture;
use std::path::Path;

/// Reported when switched on: they have no counterpart here.
const LEFT_OUT: [(&str, &str); 3] =
    [("Wtdg", "wet edges"), ("Nose", "noise"), ("useBrushPose", "brush pose")];
/// Points of a curve that is not straight.
const POINTS: usize = 9;
/// Texture blends where white keeps the stroke and black takes it away; others are reported.
const TAKEN_BLENDS: [&[u8]; 2] = [b"Mltp", b"Sbtr"];

/// What a control follows, by its number.
enum Control {
    Off,
    Follows(Input),
    Unknown(&'static str),
}

impl Control {
    fn of(object: &DescriptorObject) -> Self {
        match object.number("bVTy").map(|v| v as i32) {
            None | Some(0) => Control::Off,
            Some(1) => Control::Unknown("fading"),
            Some(2) => Control::Follows(Input::Pressure),
            Some(3) => Control::Follows(Input::Tilt),
            Some(4) => Control::Unknown("a pen's wheel"),
            Some(6) => Control::Follows(Input::Direction),
            Some(5 | 7) => Control::Unknown("the first direction, or a pen's rotation"),
            Some(_) => Control::Unknown("something unknown"),
        }
    }
}

/// A description being carried over to a brush.
pub struct AbrConversion<'a> {
    preset: &'a DescriptorObject,
    pub brush: Brush,
    pub notes: Vec<String>,
}

/// A brush with all dynamics of a description. Nothing follows the pressure unless the description
/// says so.
pub fn with_dynamics<'a>(
    preset: &'a DescriptorObject,
    brush: Brush,
    notes: Vec<String>,
) -> AbrConversion<'a> {
    let mut carried =
        AbrConversion { preset, brush: Brush { dynamics: Dynamics::none(), ..brush }, notes };
    if preset.is_set("useTipDynamics") {
        carried.shape();
    }
    if preset.is_set("useScatter") {
        carried.scatter();
    }
    if preset.is_set("usePaintDynamics") {
        carried.follow(Property::Opacity, "opVr", "minimumOpacity");
        carried.follow(Property::Flow, "prVr", "minimumFlow");
    }
    if preset.is_set("useColorDynamics") {
        carried.color();
    }
    let left_out: Vec<&str> =
        LEFT_OUT.iter().filter(|(key, _)| preset.is_set(key)).map(|(_, word)| *word).collect();
    if !left_out.is_empty() {
        carried.notes.push(format!("{} not imported from Photoshop", left_out.join(", ")));
    }
    carried
}

/// A share of 100 %, `[0, 1]`.
fn share(percent: f32) -> f32 {
    (percent / 100.0).max(0.0).min(1.0)
}

impl AbrConversion<'_> {
    /// A percentage from the brush itself, or from a part of it; 0 if neither has it.
    fn percent(&self, name: &str, part: Option<&DescriptorObject>, in_part: &str) -> f32 {
        // A part often says 0 where the brush says more.
        let own = self.preset.number(name).filter(|v| *v != 0.0);
        own.or(part.and_then(|part| part.number(in_part))).unwrap_or(0.0)
    }

    fn drive(&mut self, property: Property, input: Input, curve: Option<Curve>) {
        if let Some(curve) = curve {
            self.brush.dynamics = self.brush.dynamics.with(property, input, curve);
        }
    }

    /// The input of a control; one without a counterpart is reported once.
    fn input(&mut self, part: &DescriptorObject) -> Option<Input> {
        match Control::of(part) {
            Control::Off => None,
            Control::Follows(input) => Some(input),
            Control::Unknown(what) => {
                let note = format!("nothing here follows {what}");
                if !self.notes.contains(&note) {
                    self.notes.push(note);
                }
                None
            }
        }
    }

    /// A factor that follows its control from the minimum up, and is taken from at random.
    fn follow(&mut self, property: Property, part: &str, minimum: &str) {
        let Some(object) = self.preset.object(part) else { return };
        let least = share(self.percent(minimum, Some(object), "Mnm "));
        if let Some(input) = self.input(object) {
            self.drive(property, input, Some(Curve::Share(1.0 - least)));
        }
        let jitter = share(object.number("jitter").unwrap_or(0.0)).min(1.0 - least);
        if jitter > 0.0 {
            self.drive(property, Input::Random, Some(Curve::Share(jitter)));
        }
    }

    /// Size, angle and roundness.
    fn shape(&mut self) {
        self.follow(Property::Size, "szVr", "minimumDiameter");
        if let Some(angle) = self.preset.object("angleDynamics") {
            // The direction of the pen's tilt turns the tip.
            let input = self
                .input(angle)
                .map(|input| if input == Input::Tilt { Input::TiltDirection } else { input });
            if let Some(input) = input {
                self.drive(Property::Rotation, input, Some(Curve::Share(1.0)));
            }
            let half = 0.5 * share(angle.number("jitter").unwrap_or(0.0));
            if half > 0.0 {
                self.drive(
                    Property::Rotation,
                    Input::Random,
                    Curve::additive(vec![vec2(0.0, -half), vec2(1.0, half)]),
                );
            }
        }
        if let Some(roundness) = self.preset.object("roundnessDynamics") {
            self.round(roundness);
        }
        if self.preset.is_set("flipX") || self.preset.is_set("flipY") {
            self.notes.push("its dabs are not mirrored at random".to_owned());
        }
    }

    /// A tip that gets flatter: its elongation is one over its roundness, which no line is.
    fn round(&mut self, part: &DescriptorObject) {
        let least = share(self.percent("minimumRoundness", Some(part), "Mnm ")).max(0.05);
        let control = self.input(part).map(|input| (input, 1.0 - least));
        let jitter = share(part.number("jitter").unwrap_or(0.0)).min(1.0 - least);
        let flatter = [control, (jitter > 0.0).then_some((Input::Random, jitter))];
        let (Tip::Round | Tip::Ellipse { .. }) = self.brush.tip else {
            if flatter.iter().any(Option::is_some) {
                self.notes.push("its tip does not get flatter".to_owned());
            }
            return;
        };
        let long = 1.0 / self.brush.ratio();
        for (input, taken) in flatter.into_iter().flatten() {
            let at = |i: usize| {
                let x = i as f32 / (POINTS - 1) as f32;
                vec2(x, long / (1.0 - taken * (1.0 - x)) - long)
            };
            self.drive(Property::Elongation, input, Curve::additive((0..POINTS).map(at).collect()));
        }
    }

    fn scatter(&mut self) {
        let dynamics = self.preset.object("scatterDynamics");
        let percent = self.preset.number("Scat").filter(|v| *v > 0.0);
        let percent = percent.or(dynamics.and_then(|part| part.number("jitter"))).unwrap_or(0.0);
        // Theirs is a share of the diameter across, ours of the radius of the disc.
        self.brush.scatter = (0.5 * percent / 100.0).max(0.0).min(*Brush::SCATTER.end());
        if let Some(input) = dynamics.and_then(|part| self.input(part)) {
            self.drive(Property::Scatter, input, Some(Curve::Share(1.0)));
        }
        if !self.preset.is_set("bothAxes") && self.brush.scatter > 0.0 {
            self.notes.push("it scatters to all sides, not across the stroke alone".to_owned());
        }
        // Several dabs at a place are as dense as places that many times closer.
        let count = self.preset.number("Cnt ").unwrap_or(1.0).max(1.0).min(16.0);
        self.brush.spacing = (self.brush.spacing / count).max(*Brush::SPACING.start());
        let counts = self.preset.object("countDynamics");
        if counts.is_some_and(|part| part.number("jitter").unwrap_or(0.0) > 0.0) {
            self.notes.push("as many dabs are placed at each point".to_owned());
        }
    }

    fn color(&mut self) {
        let percent = |name: &str| share(self.preset.number(name).unwrap_or(0.0));
        let jitter = ColorJitter {
            hue_degrees: *ColorJitter::HUE_DEGREES.end() * percent("H   "),
            saturation: percent("Strt"),
            value: percent("Brgh"),
        };
        let is_other = self.preset.number("purity").is_some_and(|v| v != 0.0)
            || self.preset.object("clVr").is_some_and(|part| {
                part.number("jitter").unwrap_or(0.0) > 0.0
                    || part.number("bVTy").unwrap_or(0.0) > 0.0
            });
        self.brush.jitter = jitter;
        if is_other {
            self.notes.push("it keeps to the color in front, as pure as it is".to_owned());
        }
    }

    /// The texture that it takes paint away by; its pattern is in the collection.
    pub fn convert_texture(
        &mut self,
        file: &Path,
        patterns: &[PatternResource],
        tips: &mut TipNames,
    ) {
        if !self.preset.is_set("useTexture") {
            return;
        }
        let id = self.preset.object("Txtr").and_then(|texture| texture.text("Idnt"));
        let pattern = id.and_then(|id| patterns.iter().find(|pattern| pattern.id() == id));
        let inverted = self.preset.is_set("InvT");
        let Some(picture) = pattern.and_then(|pattern| grain_picture(pattern, inverted)) else {
            return self
                .notes
                .push("the pattern of its texture is not in the collection".to_owned());
        };
        let scale = self.preset.number("textureScale").map_or(1.0, |v| v / 100.0);
        let size_px = picture.size.longer_side() * scale;
        let depth = share(self.preset.number("textureDepth").unwrap_or(100.0));
        let source = tips.add(file, picture, "texture");
        self.brush.grain = Some(BrushGrain {
            source: GrainSource::Picture(source),
            size_px: size_px.max(*BrushGrain::SIZE_PX.start()).min(*BrushGrain::SIZE_PX.end()),
            strength: depth,
            ..BrushGrain::default()
        });
        let is_set = |name: &str| self.preset.number(name).is_some_and(|v| v != 0.0);
        let blend = self.preset.word("textureBlendMode");
        if is_set("textureBrightness")
            || is_set("textureContrast")
            || blend.is_some_and(|b| !TAKEN_BLENDS.contains(&b))
        {
            self.notes.push("its texture takes paint away as it is, in proportion".to_owned());
        }
        if self
            .preset
            .object("textureDepthDynamics")
            .is_some_and(|part| !matches!(Control::of(part), Control::Off))
        {
            self.notes.push("the depth of its texture stays the same".to_owned());
        }
    }
}

/// A pattern's light as grain; where it is transparent it takes no paint.
fn grain_picture(pattern: &PatternResource, inverted: bool) -> Option<Picture> {
    let (size, rgba) = pattern.picture();
    let gray = |[r, g, b, a]: &[u8; 4]| {
        let v = srgb::quantize(
            (0.299 * f32::from(*r) + 0.587 * f32::from(*g) + 0.114 * f32::from(*b)) / 255.0,
        );
        let v = if inverted { 255 - v } else { v };
        [v, v, v, *a]
    };
    Picture::srgb8(size, rgba.as_chunks().0.iter().map(gray).collect())
}

#[cfg(test)]
mod tests;
