//! The brushes that come with Rilievo, as texts. To add one, add a file to this folder and a line
//! here. A file has the fields of a stroke, and what a list shows (`docs/RECIPES.md`).

macro_rules! table {
    ($($key:literal),* $(,)?) => {
        [$(($key, include_str!(concat!($key, ".json")))),*]
    };
}

/// Every brush: its key and its file, in the order of the list.
pub const BRUSHES: &[(&str, &str)] = &table![
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
    "watercolour-wash",
    "watercolour-pool",
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
