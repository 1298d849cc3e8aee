//! The table of blend modes: one row says everything about a mode. Its formula is in `spec`.
//! Floor 1. To add a mode, add a row and its formula (the table has more columns than `named!`);
//! `rows` computes it from the formula until it has a faster twin there.

use super::spec::{self, BlendFunction};

/// Hands the table to a macro. The last column is how the mode is computed and by which function of
/// `spec`.
macro_rules! blend_modes {
    ($with:ident) => {
        $with! {
            // mode       documents        window            OpenRaster             Photoshop  B(cb, cs)
            #[default]
            Normal,       "normal",        "Normal",         "svg:src-over",        b"norm", separable(normal);
            Multiply,     "multiply",      "Multiply",       "svg:multiply",        b"mul ", separable(multiply);
            Screen,       "screen",        "Screen",         "svg:screen",          b"scrn", separable(screen);
            Overlay,      "overlay",       "Overlay",        "svg:overlay",         b"over", separable(overlay);
            Darken,       "darken",        "Darken",         "svg:darken",          b"dark", separable(darken);
            Lighten,      "lighten",       "Lighten",        "svg:lighten",         b"lite", separable(lighten);
            ColorDodge,   "color-dodge",   "Color dodge",   "svg:color-dodge",     b"div ", separable(color_dodge);
            ColorBurn,    "color-burn",    "Color burn",    "svg:color-burn",      b"idiv", separable(color_burn);
            HardLight,    "hard-light",    "Hard light",     "svg:hard-light",      b"hLit", separable(hard_light);
            SoftLight,    "soft-light",    "Soft light",     "svg:soft-light",      b"sLit", separable(soft_light);
            Difference,   "difference",    "Difference",     "svg:difference",      b"diff", separable(difference);
            Exclusion,    "exclusion",     "Exclusion",      "krita:exclusion",     b"smud", separable(exclusion);
            Hue,          "hue",           "Hue",            "svg:hue",             b"hue ", non_separable(hue);
            Saturation,   "saturation",    "Saturation",     "svg:saturation",      b"sat ", non_separable(saturation);
            Color,        "color",         "Color",         "svg:color",           b"colr", non_separable(color);
            Luminosity,   "luminosity",    "Luminosity",     "svg:luminosity",      b"lum ", non_separable(luminosity);
            /// Sums the premultiplied values, clamped at 1.
            Plus,         "plus",          "Plus",           "svg:plus",            b"plus", sum(plus);
            LinearDodge,  "linear-dodge",  "Linear dodge",   "krita:linear_dodge",  b"lddg", separable(linear_dodge);
            LinearBurn,   "linear-burn",   "Linear burn",    "krita:linear_burn",   b"lbrn", separable(linear_burn);
            LinearLight,  "linear-light",  "Linear light",   "krita:linear light",  b"lLit", separable(linear_light);
            VividLight,   "vivid-light",   "Vivid light",    "krita:vivid_light",   b"vLit", separable(vivid_light);
            PinLight,     "pin-light",     "Pin light",      "krita:pin_light",     b"pLit", separable(pin_light);
            HardMix,      "hard-mix",      "Hard mix",       "krita:hard mix",      b"hMix", separable(hard_mix);
            DarkerColor,  "darker-color",  "Darker color",  "krita:darker color",  b"dkCl", non_separable(darker);
            LighterColor, "lighter-color", "Lighter color", "krita:lighter color", b"lgCl", non_separable(lighter);
            Subtract,     "subtract",      "Subtract",       "krita:subtract",      b"fsub", separable(subtract);
            Divide,       "divide",        "Divide",         "krita:divide",        b"fdiv", separable(divide);
            /// Each pixel wholly or not at all, by noise fixed to the canvas, with its alpha as the
            /// probability.
            Dissolve,     "dissolve",      "Dissolve",       "krita:dissolve",      b"diss", separable(normal);
        }
    };
}
pub(super) use blend_modes;

/// A row of the table.
struct ModeRow {
    name: &'static str,
    label: &'static str,
    openraster: &'static str,
    photoshop: [u8; 4],
    function: BlendFunction,
}

macro_rules! function {
    (separable, $b:ident) => {
        BlendFunction::Separable(spec::$b)
    };
    (non_separable, $b:ident) => {
        BlendFunction::NonSeparable(spec::$b)
    };
    (sum, $b:ident) => {
        BlendFunction::Sum(spec::$b)
    };
}

macro_rules! declare {
    ($(
        $(#[$meta:meta])*
        $mode:ident, $name:literal, $label:literal, $ora:literal, $psd:literal, $kind:ident($b:ident);
    )+) => {
        /// How a layer's color meets the color below: a function `B(cb, cs)` mixed source-over as
        /// W3C mixes its own, except for [`BlendMode::Plus`]; what [`BlendMode::Dissolve`] leaves
        /// of a layer is mixed this way.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
        pub enum BlendMode {
            $(
                #[doc = concat!("“", $label, "” in the window.")]
                ///
                $(#[$meta])*
                $mode,
            )+
        }

        impl BlendMode {
            /// How many there are.
            pub const COUNT: usize = [$($name),+].len();
            /// Every mode with its name in documents.
            pub const ALL: [(BlendMode, &'static str); Self::COUNT] = [$((BlendMode::$mode, $name)),+];
            /// Every mode with its name in the window.
            pub const LABELS: [(BlendMode, &'static str); Self::COUNT] = [$((BlendMode::$mode, $label)),+];

            const fn row(self) -> ModeRow {
                match self {
                    $(BlendMode::$mode => ModeRow {
                        name: $name,
                        label: $label,
                        openraster: $ora,
                        photoshop: *$psd,
                        function: function!($kind, $b),
                    },)+
                }
            }
        }
    };
}
blend_modes!(declare);

/// One premultiplied pixel over another by the formula of a mode, which the fast rows are tested
/// against.
pub fn blend_pixel(mode: BlendMode, backdrop: [f32; 4], source: [f32; 4]) -> [f32; 4] {
    mode.function().composite(backdrop, source)
}

impl BlendMode {
    /// The gray that changes nothing, in the modes in which the opacity of a layer's fill thins its
    /// color before it is blended; in others it is an opacity.
    pub fn neutral_fill(self) -> Option<f32> {
        match self {
            BlendMode::ColorBurn | BlendMode::LinearBurn => Some(1.0),
            BlendMode::ColorDodge | BlendMode::LinearDodge | BlendMode::Difference => Some(0.0),
            BlendMode::VividLight | BlendMode::LinearLight | BlendMode::HardMix => Some(0.5),
            _ => None,
        }
    }

    /// Its name in documents.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// Its name in the window.
    pub fn label(self) -> &'static str {
        self.row().label
    }

    /// OpenRaster's word, or if it has none, that of a program which has one.
    pub fn openraster(self) -> &'static str {
        self.row().openraster
    }

    /// Photoshop's key; for a mode that it lacks, one that no file contains.
    pub fn photoshop(self) -> [u8; 4] {
        self.row().photoshop
    }

    /// Its formula.
    pub fn function(self) -> BlendFunction {
        self.row().function
    }

    /// The mode with this name in documents.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::find(|row| row.name == name)
    }

    /// The mode with this name in OpenRaster.
    pub fn from_openraster(word: &str) -> Option<Self> {
        Self::find(|row| row.openraster == word)
    }

    /// The mode of a key of Photoshop's.
    pub fn from_photoshop(key: [u8; 4]) -> Option<Self> {
        Self::find(|row| row.photoshop == key)
    }

    /// OpenRaster can express it, and other programs read it as this one does: most read its `plus`
    /// as a sum of colors alone, whatever the alpha.
    pub fn is_said_by_openraster(self) -> bool {
        self.openraster().starts_with("svg:") && self != BlendMode::Plus
    }

    /// A step of one color may change the result by more than a step.
    pub fn is_steep(self) -> bool {
        use BlendMode as Mode;
        let is_even = matches!(self, Mode::Normal | Mode::Multiply | Mode::Screen)
            || matches!(self, Mode::Darken | Mode::Lighten | Mode::Difference | Mode::Exclusion)
            || matches!(self, Mode::Plus | Mode::LinearDodge | Mode::LinearBurn | Mode::Subtract);
        !is_even
    }

    /// Photoshop can express it, and dissolves the same pixels.
    pub fn is_said_by_photoshop(self) -> bool {
        !matches!(self, BlendMode::Plus | BlendMode::Dissolve)
    }

    fn find(is: impl Fn(&ModeRow) -> bool) -> Option<Self> {
        Self::ALL.into_iter().map(|(mode, _)| mode).find(|mode| is(&mode.row()))
    }
}
