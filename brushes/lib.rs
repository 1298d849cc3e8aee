//! The brushes, painted balls, looks and materials that come with Rilievo. To add one, add a file to
//! its folder and a line here. The file of a brush has the fields of a stroke, and what a list shows
//! (`docs/RECIPES.md`); that of a look or material has layers (`docs/LOOKS.md`). A ball is a picture, with the
//! recipe that it was painted by beside it.

/// The texts of a folder (`""`: this one), each with its key.
macro_rules! table {
    ($folder:literal: $($key:literal),* $(,)?) => {
        [$(($key, include_str!(concat!($folder, $key, ".json")))),*]
    };
}

/// Every brush: its key and its file, in the order of the list.
pub const BRUSHES: &[(&str, &str)] = &table!["":
    "pencil-hb",
    "pencil-2b",
    "pencil-mechanical",
    "charcoal",
    "chalk",
    "pastel",
    "hatching",
    "ink",
    "technical-pen",
    "brush-pen",
    "calligraphy",
    "marker",
    "dry-ink",
    "soft-round",
    "hard-round",
    "gouache",
    "oil-bristle",
    "oil-flat",
    "palette-knife",
    "dry-brush",
    "sponge",
    "airbrush",
    "watercolor-wash",
    "watercolor-pool",
    "wet-ink",
    "spatter",
    "eraser-soft",
    "highlight-velvet",
    "highlight-satin",
    "highlight-gloss",
    "highlight-chrome",
    "brushed-metal",
    "rim-light",
    "fresnel-glaze",
    "refracted-light",
    "cast-shadow",
    "hollow-shadow",
    "decal",
    "scales",
    "fabric-weave",
    "dots",
    "dust",
    "edge-wear",
    "moss",
    "rust",
    "smudge",
    "blender",
    "soften",
    "clone-stamp",
];

/// Every look: its key and its file, in the order of the list.
pub const LOOKS: &[(&str, &str)] = &table!["looks/":
    "oil-sketch",
    "palette-knife",
    "gouache",
    "watercolor",
    "pastel",
    "pencil-sketch",
    "charcoal",
    "ink",
    "engraving",
    "wood-print",
    "comic",
    "marker",
    "cel-rim",
    "clay",
    "porcelain",
    "gold",
    "chrome",
    "bronze",
    "blueprint",
    "moonlight",
];

/// Every material for a part: its key and its file, in the order of the list.
pub const MATERIALS: &[(&str, &str)] = &table!["materials/":
    "skin",
    "cloth",
    "leather",
    "plastic",
    "rubber",
    "wood",
    "stone",
    "porcelain",
    "gold",
    "chrome",
    "glass",
    "jelly",
    "fur",
];

macro_rules! balls {
    ($($key:literal $name:literal),* $(,)?) => {
        [$(($key, $name, include_bytes!(concat!("balls/", $key, ".jpg")))),*]
    };
}

/// Every painted ball: its key, its name and its picture, in the order of the list.
pub const BALLS: &[(&str, &str, &[u8])] = &balls![
    "oil" "Oil",
    "impasto" "Palette knife",
    "gouache" "Gouache",
    "watercolor" "Watercolor",
    "pastel" "Pastel",
    "marker" "Marker",
    "pencil" "Pencil",
    "charcoal" "Charcoal and chalk",
    "ink" "Ink",
    "cel" "Cel",
    "clay" "Clay",
    "porcelain" "Porcelain",
    "gold" "Gold",
    "chrome" "Chrome",
];
