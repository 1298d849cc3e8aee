//! What effects can be set to: one table of all settings, and for each kind those that it uses.
//! Floor 3.

use super::EffectKind;
use crate::math::number_settings::number_settings;
use crate::math::srgb::Color;
use crate::math::{NumberSetting, Range, TURNS, UNIT};
use crate::paint::RampStyle;
use crate::raster::BlendMode;

crate::named! {
    /// What an effect is filled with.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum EffectFill {
        /// One color.
        Color = "color" => "Color",
        /// A ramp.
        Gradient = "gradient" => "Gradient",
        /// A repeated picture.
        Pattern = "pattern" => "Pattern",
    }
}

crate::named! {
    /// Where a line lies.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum StrokePosition {
        /// Around the layer.
        Outside = "outside" => "Outside",
        /// On the layer.
        Inside = "inside" => "Inside",
        /// Half on it.
        Center = "center" => "Center",
    }
}

crate::named! {
    /// Where the slanted edges of a bevel lie.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum BevelStyle {
        /// On the layer.
        Inner = "inner" => "Inner bevel",
        /// Around the layer.
        Outer = "outer" => "Outer bevel",
        /// Half on it, rising to it.
        Emboss = "emboss" => "Emboss",
        /// Half on it, sinking along its edge.
        Pillow = "pillow" => "Pillow emboss",
    }
}

crate::named! {
    /// How the edges of a bevel are cut.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum BevelTechnique {
        /// Rounded.
        Smooth = "smooth" => "Smooth",
        /// Flat.
        Chisel = "chisel" => "Chisel",
    }
}

crate::named! {
    /// How a glow fades.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum GlowTechnique {
        /// Blurred.
        Softer = "softer" => "Softer",
        /// By the distance from the edge.
        Precise = "precise" => "Precise",
    }
}

crate::named! {
    /// Where an inner glow comes from.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum GlowSource {
        /// From the edge inward.
        Edge = "edge" => "Edge",
        /// From the middle outward.
        Center = "center" => "Center",
    }
}

/// Lengths of effects, px. Wider ones would need more of the canvas around each tile.
const LENGTH: Range = 0.0..=250.0;
/// How far a shadow may fall, px.
const FAR: Range = 0.0..=1000.0;

number_settings! {
    /// Everything that effects can be set to but ramps, contours and pictures.
    pub struct EffectSettings {
        /// How much of it shows.
        opacity: "Opacity", "How much of it shows", UNIT, 1.0;
        /// Opacity of the shade of a bevel.
        shade_opacity: "Shade opacity", "How much of the shade shows", UNIT, 0.75;
        /// The width of a blur or a line, px.
        size: "Size", "The width of its blur or its line, px", LENGTH, 5.0, px;
        /// The share of the size that is not blurred.
        spread: "Spread", "How much of its size is solid", UNIT, 0.0;
        /// How far a shadow is from what casts it, px.
        distance: "Distance", "How far it is moved, px", FAR, 5.0, px;
        /// Degrees, counter-clockwise from the right.
        angle: "Angle", "Where the light comes from, or how a ramp runs, degrees", TURNS, 120.0;
        /// Degrees.
        altitude: "Altitude", "How high the light stands, degrees", 0.0..=90.0, 30.0;
        /// The share of a glow's fading that is used.
        range: "Range", "Less of it makes a glow stronger toward the edge", 0.01..=1.0, 0.5;
        /// How steep a bevel is.
        depth: "Depth", "How steep its edges are", 0.01..=10.0, 1.0;
        /// A blur of a bevel's light, px.
        soften: "Soften", "A blur of its light and shade, px", 0.0..=16.0, 0.0, px;
        /// Specks.
        noise: "Noise", "Specks in it", UNIT, 0.0;
        /// Of a ramp relative to what it fills, or of a picture.
        scale: "Scale", "How large a ramp or a picture is", 0.01..=10.0, 1.0;
        /// The middle of a ramp, in shares of what it fills.
        offset_x: "Offset x", "The middle of the ramp, in widths of the layer", -10.0..=10.0, 0.0;
        /// The same, downward.
        offset_y: "Offset y", "The middle of the ramp, in heights of the layer", -10.0..=10.0, 0.0;
        /// Where a repeated picture begins, px.
        phase_x: "Phase x", "Where the picture begins, px", -1e5..=1e5, 0.0, px;
        /// The same, downward.
        phase_y: "Phase y", "Where the picture begins, px", -1e5..=1e5, 0.0, px;
        and
        /// How its color meets what it falls on.
        blend: BlendMode = BlendMode::Normal;
        /// The same for the shade of a bevel.
        shade_blend: BlendMode = BlendMode::Multiply;
        /// Its color.
        color: Color = Color::BLACK;
        /// The color of the shade of a bevel.
        shade_color: Color = Color::BLACK;
        /// What it is filled with.
        fill: EffectFill = EffectFill::Color;
        /// Where a line lies.
        position: StrokePosition = StrokePosition::Outside;
        /// How a ramp runs.
        ramp: RampStyle = RampStyle::Linear;
        /// Where the edges of a bevel lie.
        bevel: BevelStyle = BevelStyle::Inner;
        /// How they are cut.
        technique: BevelTechnique = BevelTechnique::Smooth;
        /// How a glow fades.
        glow: GlowTechnique = GlowTechnique::Softer;
        /// Where an inner glow comes from.
        source: GlowSource = GlowSource::Edge;
        /// The light is the document's.
        document_light: bool = true;
        /// The layer hides what of it lies beneath it.
        knockout: bool = true;
        /// Light and dark are exchanged.
        invert: bool = false;
        /// A ramp runs the other way.
        reverse: bool = false;
        /// A bevel is sunken.
        sunken: bool = false;
        /// A ramp or picture lies on what the layer covers, not on the canvas.
        aligned: bool = true;
        /// A shadow falls on the surface, by its depth.
        on_surface: bool = false;
    }
}

/// Something that is on or off.
pub struct FlagField {
    /// Its name in documents.
    pub name: &'static str,
    /// Its name in the window.
    pub label: &'static str,
    /// What it does.
    pub hint: &'static str,
    /// Reads it.
    pub get: fn(&EffectSettings) -> bool,
    /// Sets it.
    pub set: fn(&mut EffectSettings, bool),
}

/// A color.
pub struct ColorField {
    /// Its name in documents.
    pub name: &'static str,
    /// Its name in the window.
    pub label: &'static str,
    /// Reads it.
    pub get: fn(&EffectSettings) -> Color,
    /// Sets it.
    pub set: fn(&mut EffectSettings, Color),
}

/// One of some named choices, by its place among them.
pub struct ChoiceField {
    /// Its name in documents.
    pub name: &'static str,
    /// Its name in the window.
    pub label: &'static str,
    /// `(name in documents, name in the window)` of each choice.
    pub choices: fn() -> Vec<(&'static str, &'static str)>,
    /// Reads it.
    pub get: fn(&EffectSettings) -> usize,
    /// Sets it; what is no choice leaves it.
    pub set: fn(&mut EffectSettings, usize),
}

/// Something that an effect can be set to.
#[derive(Clone, Copy)]
pub enum EffectField {
    /// A number.
    Number(&'static NumberSetting<EffectSettings>),
    /// On or off.
    Flag(&'static FlagField),
    /// A color.
    Color(&'static ColorField),
    /// A choice.
    Choice(&'static ChoiceField),
    /// `stops`.
    Stops,
    /// `contour`.
    Contour,
    /// `pattern`.
    Pattern,
}

macro_rules! flags {
    ($($name:ident: $label:literal, $hint:literal;)+) => {
        const FLAGS: &[FlagField] = &[$(FlagField {
            name: stringify!($name),
            label: $label,
            hint: $hint,
            get: |all| all.$name,
            set: |all, to| all.$name = to,
        },)+];
    };
}

flags! {
    document_light: "Document's light", "The light that all effects share";
    knockout: "Layer hides it", "It does not show through what is transparent of the layer";
    invert: "Invert", "Exchange light and dark";
    reverse: "Reverse", "The ramp runs the other way";
    sunken: "Sunken", "Down instead of up";
    aligned: "Align with layer", "It lies on the layer, not on the canvas";
    on_surface: "On the surface", "The shadow falls farther where the surface is deeper";
}

const COLORS: &[ColorField] = &[
    ColorField {
        name: "color",
        label: "Color",
        get: |all| all.color,
        set: |all, to| all.color = to,
    },
    ColorField {
        name: "shade_color",
        label: "Shade",
        get: |all| all.shade_color,
        set: |all, to| all.shade_color = to,
    },
];

macro_rules! choices {
    ($($name:ident: $type:ident, $label:literal;)+) => {
        const CHOICES: &[ChoiceField] = &[$(ChoiceField {
            name: stringify!($name),
            label: $label,
            choices: || {
                $type::ALL.iter().zip($type::LABELS).map(|((_, name), (_, label))| (*name, label)).collect()
            },
            get: |all| $type::ALL.iter().position(|(choice, _)| *choice == all.$name).unwrap_or(0),
            set: |all, to| {
                if let Some((choice, _)) = $type::ALL.get(to) {
                    all.$name = *choice;
                }
            },
        },)+];
    };
}

choices! {
    blend: BlendMode, "Blend mode";
    shade_blend: BlendMode, "Shade's blend mode";
    fill: EffectFill, "Fill";
    position: StrokePosition, "Position";
    ramp: RampStyle, "Style";
    bevel: BevelStyle, "Bevel";
    technique: BevelTechnique, "Technique";
    glow: GlowTechnique, "Glow";
    source: GlowSource, "Source";
}

const RAMP: [&str; 7] = ["ramp", "angle", "scale", "offset_x", "offset_y", "reverse", "aligned"];
const PICTURE: [&str; 4] = ["scale", "phase_x", "phase_y", "aligned"];

impl EffectKind {
    /// What it can be set to, in the order in which that is shown.
    pub fn fields(self) -> Vec<EffectField> {
        let glow: &[&str] = &["noise", "fill", "color", "stops", "glow"];
        let own: Vec<&[&str]> = match self {
            EffectKind::DropShadow => vec![
                &[
                    "color",
                    "document_light",
                    "angle",
                    "distance",
                    "spread",
                    "size",
                    "contour",
                    "noise",
                ],
                &["knockout", "on_surface", "altitude"],
            ],
            EffectKind::InnerShadow => vec![&[
                "color",
                "document_light",
                "angle",
                "distance",
                "spread",
                "size",
                "contour",
                "noise",
            ]],
            EffectKind::OuterGlow => {
                vec![glow, &["spread", "size", "contour", "range", "knockout"]]
            }
            EffectKind::InnerGlow => vec![glow, &["source", "spread", "size", "contour", "range"]],
            EffectKind::Bevel => vec![
                &["bevel", "technique", "depth", "sunken", "size", "soften"],
                &["document_light", "angle", "altitude", "contour", "color"],
                &["shade_blend", "shade_opacity", "shade_color"],
            ],
            EffectKind::Satin => {
                vec![&["color", "angle", "distance", "size", "contour", "invert"]]
            }
            EffectKind::ColorOverlay => vec![&["color"]],
            EffectKind::GradientOverlay => vec![&["stops"], &RAMP],
            EffectKind::PatternOverlay => vec![&["pattern"], &PICTURE],
            EffectKind::Stroke => {
                vec![
                    &["size", "position", "fill", "color", "stops", "pattern"],
                    &RAMP,
                    &PICTURE[1..3],
                ]
            }
        };
        let names = ["blend", "opacity"].iter().chain(own.into_iter().flatten());
        names.filter_map(|name| field(name)).collect()
    }
}

/// The setting of a name.
fn field(name: &str) -> Option<EffectField> {
    let number =
        || EffectSettings::SETTINGS.iter().find(|s| s.name == name).map(EffectField::Number);
    let flag = || FLAGS.iter().find(|s| s.name == name).map(EffectField::Flag);
    let color = || COLORS.iter().find(|s| s.name == name).map(EffectField::Color);
    let choice = || CHOICES.iter().find(|s| s.name == name).map(EffectField::Choice);
    let other = match name {
        "stops" => Some(EffectField::Stops),
        "contour" => Some(EffectField::Contour),
        "pattern" => Some(EffectField::Pattern),
        _ => None,
    };
    other.or_else(number).or_else(flag).or_else(color).or_else(choice)
}
