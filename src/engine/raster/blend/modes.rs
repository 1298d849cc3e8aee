//! The table of blend modes: one row says everything about a mode. Its formula stands in `spec`. Floor 1. To add a
//! mode, add a row and its formula; `rows` computes it from the formula until it has a faster twin there.

use super::spec::{self, BlendFunction};

/// Hands the table to a macro. The last column is how the mode is computed and by which function of `spec`.
macro_rules! blend_modes {
    ($with:ident) => {
        $with! {
            // mode     documents      window          OpenRaster         Photoshop  B(cb, cs)
            #[default]
            Normal,     "normal",      "Normal",       "svg:src-over",    b"norm",   separable(normal);
            Multiply,   "multiply",    "Multiply",     "svg:multiply",    b"mul ",   separable(multiply);
            Screen,     "screen",      "Screen",       "svg:screen",      b"scrn",   separable(screen);
            Overlay,    "overlay",     "Overlay",      "svg:overlay",     b"over",   separable(overlay);
            Darken,     "darken",      "Darken",       "svg:darken",      b"dark",   separable(darken);
            Lighten,    "lighten",     "Lighten",      "svg:lighten",     b"lite",   separable(lighten);
            ColorDodge, "color-dodge", "Colour dodge", "svg:color-dodge", b"div ",   separable(color_dodge);
            ColorBurn,  "color-burn",  "Colour burn",  "svg:color-burn",  b"idiv",   separable(color_burn);
            HardLight,  "hard-light",  "Hard light",   "svg:hard-light",  b"hLit",   separable(hard_light);
            SoftLight,  "soft-light",  "Soft light",   "svg:soft-light",  b"sLit",   separable(soft_light);
            Difference, "difference",  "Difference",   "svg:difference",  b"diff",   separable(difference);
            Exclusion,  "exclusion",   "Exclusion",    "krita:exclusion", b"smud",   separable(exclusion);
            Hue,        "hue",         "Hue",          "svg:hue",         b"hue ",   non_separable(hue);
            Saturation, "saturation",  "Saturation",   "svg:saturation",  b"sat ",   non_separable(saturation);
            Color,      "color",       "Colour",       "svg:color",       b"colr",   non_separable(color);
            Luminosity, "luminosity",  "Luminosity",   "svg:luminosity",  b"lum ",   non_separable(luminosity);
            /// Sums the premultiplied values, clamped at 1.
            Plus,       "plus",        "Plus",         "svg:plus",        b"lddg",   sum(plus);
        }
    };
}
pub(super) use blend_modes;

/// A row of the table.
struct Row {
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
        /// How a layer's colour meets the colour beneath: W3C's `B(cb, cs)` mixed source-over, but for
        /// [`BlendMode::Plus`].
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
        pub enum BlendMode {
            $($(#[$meta])* $mode,)+
        }

        impl BlendMode {
            /// How many there are.
            pub const COUNT: usize = [$($name),+].len();
            /// Every mode with its name in documents.
            pub const ALL: [(BlendMode, &'static str); Self::COUNT] = [$((BlendMode::$mode, $name)),+];
            /// Every mode with its name in the window.
            pub const LABELS: [(BlendMode, &'static str); Self::COUNT] = [$((BlendMode::$mode, $label)),+];

            const fn row(self) -> Row {
                match self {
                    $(BlendMode::$mode => Row {
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

impl BlendMode {
    /// As documents call it.
    pub fn name(self) -> &'static str {
        self.row().name
    }
    /// As the window calls it.
    pub fn label(self) -> &'static str {
        self.row().label
    }
    /// OpenRaster's word; where it has none, that of a program which has one.
    pub fn openraster(self) -> &'static str {
        self.row().openraster
    }
    /// Photoshop's key.
    pub fn photoshop(self) -> [u8; 4] {
        self.row().photoshop
    }
    /// Its formula.
    pub fn function(self) -> BlendFunction {
        self.row().function
    }
    pub fn from_name(name: &str) -> Option<Self> {
        Self::find(|row| row.name == name)
    }
    pub fn from_openraster(word: &str) -> Option<Self> {
        Self::find(|row| row.openraster == word)
    }
    pub fn from_photoshop(key: [u8; 4]) -> Option<Self> {
        Self::find(|row| row.photoshop == key)
    }
    /// OpenRaster says it, and other programs read it as this one does: most take its `plus` for a sum of colours
    /// alone, whatever the alpha.
    pub fn is_said_by_openraster(self) -> bool {
        self.openraster().starts_with("svg:") && self != BlendMode::Plus
    }
    fn find(is: impl Fn(&Row) -> bool) -> Option<Self> {
        Self::ALL.into_iter().map(|(mode, _)| mode).find(|mode| is(&mode.row()))
    }
}
