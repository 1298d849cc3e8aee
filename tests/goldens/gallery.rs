//! The recipes of `sample_normals` make the pictures of `docs/gallery`. Both are compared small,
//! since the pictures are stored as JPEG. A dozen are stored here as well, as they are rendered, and
//! compared pixel by pixel.

use super::compare::{self, Place};
use image::{Rgb, RgbImage, RgbaImage};
use rilievo::files::recipe;
use rilievo::{Budget, Document, Progress, Size, TileGrid, flatten, flatten_layer};
use std::path::{Path, PathBuf};

/// Both pictures are averaged over squares of so many pixels.
const SQUARE: u32 = 8;
/// How far a square's mean may be off, and the mean of all squares, in steps of a byte.
const MOST: f32 = 10.0;
const MOST_MEAN: f32 = 1.0;

/// A picture of the gallery and what makes it.
struct Shown {
    picture: String,
    recipe: PathBuf,
    /// One layer alone on a background, else the whole document.
    layer: Option<(&'static str, Rgb<u8>)>,
    scale: f32,
}

const WHITE: Rgb<u8> = Rgb([255; 3]);
const WALL: Rgb<u8> = Rgb([0x2c, 0x2a, 0x2e]);
const LIGHT_WALL: Rgb<u8> = Rgb([0xd9, 0xd4, 0xcc]);
const CLOTH: Rgb<u8> = Rgb([0x14, 0x16, 0x1b]);
const NIGHT: Rgb<u8> = Rgb([0x14, 0x1a, 0x24]);

/// Layers that the gallery shows alone: picture, recipe, layer, background.
const LAYERS: [(&str, &str, &str, Rgb<u8>); 35] = [
    ("noise_knot_1", "noise_knot", "γ 1", WHITE),
    ("noise_knot_2", "noise_knot", "γ 2", WHITE),
    ("noise_knot_3", "noise_knot", "γ 3", WHITE),
    ("noise_knot_4", "noise_knot", "α 0.5, β 1", WHITE),
    ("noise_knot_5", "noise_knot", "α -0.5, β 1", WHITE),
    ("noise_knot_6", "noise_knot", "α -0.5, β 3", WHITE),
    ("noise_knot_7", "noise_knot", "Surface", WHITE),
    ("captured_fossil_plain", "captured_fossil", "Plain", CLOTH),
    ("warped_muse_1", "warped_muse", "Matt", WALL),
    ("warped_muse_3", "warped_muse", "Matt, scaled", WALL),
    ("warped_muse_4", "warped_muse", "Matt, turned", WALL),
    ("warped_muse_6", "warped_muse", "Matt, turned, scaled", WALL),
    ("warped_muse_7", "warped_muse", "Mirror", WALL),
    ("warped_muse_9", "warped_muse", "Mirror, scaled", WALL),
    ("relief_muse_none", "relief_muse", "No scaling", WALL),
    ("relief_muse_low", "relief_muse", "α 0.2", WALL),
    ("relief_muse_high", "relief_muse", "α 0.8", WALL),
    ("axolotl_flat", "axolotl", "Flats", WHITE),
    ("balloon_lettering_flat", "balloon_lettering", "Flats", WHITE),
    ("vase_and_pear_flat", "vase_and_pear", "Flats", WHITE),
    ("placed_knot_1", "placed_knot", "α 0.2", LIGHT_WALL),
    ("placed_knot_2", "placed_knot", "α 0.5", LIGHT_WALL),
    ("placed_knot_3", "placed_knot", "Four anchors", LIGHT_WALL),
    ("imitated_knot_mirror", "imitated_knot", "Mirror", LIGHT_WALL),
    ("imitated_knot_glass", "imitated_knot", "Glass", LIGHT_WALL),
    ("imitated_knot_plastic", "imitated_knot", "Plastic", LIGHT_WALL),
    ("solid_knot_mirror", "solid_knot", "Mirror", LIGHT_WALL),
    ("glass_muse_plain", "glass_muse", "Glass", NIGHT),
    ("glass_muse_scaled", "glass_muse", "Glass, scaled", NIGHT),
    ("precomputed_muse_1", "precomputed_muse", "Environment", WALL),
    ("precomputed_muse_2", "precomputed_muse", "Environment, scaled", WALL),
    ("precomputed_muse_3", "precomputed_muse", "Occlusion", WALL),
    ("precomputed_muse_4", "precomputed_muse", "Occlusion, scaled", WALL),
    ("precomputed_muse_5", "precomputed_muse", "Sphere", WALL),
    ("precomputed_muse_6", "precomputed_muse", "Sphere, scaled", WALL),
];

/// Recipes whose pictures are stored without loss too: shapes of drawings, models of light, prints
/// and decals.
pub const LOSSLESS: [&str; 12] = [
    "candy_lettering",
    "cartoon_knot",
    "cartoon_rocket",
    "decal_apple",
    "diffuse_knot",
    "gold_lettering",
    "imitated_knot",
    "plaster_still_life",
    "printed_folds",
    "shaded_drapery",
    "tattooed_arm",
    "toon_snail",
];
/// Steps of a byte by which their pixels may differ: C libraries round the last bit of `exp` and the
/// like otherwise.
const LOSSLESS_TOLERANCE: u8 = 1;

/// Recipes that the gallery shows at three quarters of their size.
const SMALLER: [&str; 4] =
    ["crystal_ball", "glass_1_placed", "glass_2_tree_moved", "glass_3_horizon_aligned"];

fn in_package(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn recipe_of(name: &str) -> PathBuf {
    in_package("sample_normals").join(format!("{name}.json"))
}

/// A picture for every recipe, at least.
fn shown() -> Vec<Shown> {
    let layers = LAYERS.map(|(picture, recipe, layer, background)| Shown {
        picture: picture.into(),
        recipe: recipe_of(recipe),
        layer: Some((layer, background)),
        scale: 1.0,
    });
    let files =
        std::fs::read_dir(in_package("sample_normals")).unwrap().map(|entry| entry.unwrap().path());
    let mut names: Vec<String> = files
        .filter(|path| path.extension().is_some_and(|e| e == "json"))
        .map(|path| path.file_stem().unwrap().to_string_lossy().into_owned())
        .filter(|name| {
            let is_whole = in_package("docs/gallery").join(format!("{name}.jpg")).is_file();
            is_whole || LAYERS.iter().all(|(_, recipe, ..)| recipe != name)
        })
        .collect();
    names.sort();
    assert!(names.len() >= 30, "only {} recipes", names.len());
    let whole = names.into_iter().map(|name| {
        let scale = if SMALLER.contains(&name.as_str()) { 0.75 } else { 1.0 };
        Shown { recipe: recipe_of(&name), picture: name, layer: None, scale }
    });
    whole.chain(layers).collect()
}

impl Shown {
    fn stored(&self) -> RgbImage {
        let path = in_package("docs/gallery").join(format!("{}.jpg", self.picture));
        image::open(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display())).to_rgb8()
    }

    /// The document, its pixels and what is behind them.
    fn rendered(&self) -> (Document, TileGrid, Rgb<u8>) {
        let document =
            recipe::load(&self.recipe, &Budget::default()).unwrap_or_else(|e| panic!("{e}"));
        let document =
            if self.scale == 1.0 { document } else { document.scaled(self.scale).unwrap() };
        let (tiles, background) = match self.layer {
            None => (flatten(&document, &Progress::default()), WHITE),
            Some((layer, background)) => {
                let id =
                    document.layer_named(layer).unwrap_or_else(|| panic!("{layer} is missing")).id;
                (flatten_layer(&document, id, &Progress::default()), background)
            }
        };
        (document, tiles.unwrap(), background)
    }

    /// Compares with the picture that is stored without loss, if there is one.
    fn check_lossless(&self, document: &Document, tiles: &TileGrid) -> Result<(), String> {
        if self.layer.is_some() || !LOSSLESS.contains(&self.picture.as_str()) {
            return Ok(());
        }
        let Size { width, height } = document.size;
        let pixels = tiles.to_straight_rgba(document.size.rect());
        let found = RgbaImage::from_raw(width, height, pixels).unwrap();
        let name = format!("gallery/{}", self.picture);
        let place = Place::alone(&name);
        compare::check(&super::folder(), &name, &place, &found, LOSSLESS_TOLERANCE)
    }
}

fn over(document: &Document, tiles: &TileGrid, Rgb(background): Rgb<u8>) -> RgbImage {
    let rgba = tiles.to_straight_rgba(document.size.rect());
    let pixel = |&[r, g, b, a]: &[u8; 4]| {
        let mix = |over: u8, under: u8| {
            ((u32::from(over) * u32::from(a) + u32::from(under) * (255 - u32::from(a)) + 127) / 255)
                as u8
        };
        [mix(r, background[0]), mix(g, background[1]), mix(b, background[2])]
    };
    let rgb = rgba.as_chunks::<4>().0.iter().flat_map(pixel).collect();
    RgbImage::from_raw(document.size.width, document.size.height, rgb).unwrap()
}

/// The means of squares, from the upper left; what is left over at the right and below is not seen.
fn small(picture: &RgbImage) -> Vec<[f32; 3]> {
    let (columns, rows) = (picture.width() / SQUARE, picture.height() / SQUARE);
    let mean = |i: u32| {
        let (x0, y0) = (i % columns * SQUARE, i / columns * SQUARE);
        let pixels =
            (0..SQUARE * SQUARE).map(|i| picture.get_pixel(x0 + i % SQUARE, y0 + i / SQUARE).0);
        let sum = pixels
            .fold([0.0; 3], |sum: [f32; 3], p| std::array::from_fn(|c| sum[c] + f32::from(p[c])));
        sum.map(|v| v / (SQUARE * SQUARE) as f32)
    };
    (0..columns * rows).map(mean).collect()
}

/// The largest difference of a square's mean, and the mean difference.
fn apart(a: &RgbImage, b: &RgbImage) -> (f32, f32) {
    if a.dimensions() != b.dimensions() {
        return (f32::INFINITY, f32::INFINITY);
    }
    let (a, b) = (small(a), small(b));
    let each = || a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs());
    (each().fold(0.0, f32::max), each().sum::<f32>() / each().count() as f32)
}

fn is_alike((most, mean): (f32, f32)) -> bool {
    most <= MOST && mean <= MOST_MEAN
}

#[test]
fn the_recipes_make_the_pictures_of_the_gallery() {
    let mut faults = Vec::new();
    for shown in shown() {
        let (document, tiles, background) = shown.rendered();
        faults.extend(shown.check_lossless(&document, &tiles).err());
        let (found, expected) = (over(&document, &tiles, background), shown.stored());
        let (most, mean) = apart(&found, &expected);
        if !is_alike((most, mean)) {
            let saved = compare::faults().join("gallery").join(format!("{}.png", shown.picture));
            std::fs::create_dir_all(saved.parent().unwrap()).unwrap();
            found.save(&saved).unwrap();
            faults.push(format!(
                "{}: squares of {SQUARE} px differ by up to {most:.1} (at most {MOST}), \
                 {mean:.2} in the mean (at most {MOST_MEAN}); see {}",
                shown.picture,
                saved.display()
            ));
        }
    }
    assert!(
        faults.is_empty(),
        "{}\nIf the change is meant, run the commands of docs/GALLERY.md",
        faults.join("\n")
    );
}

#[test]
fn a_picture_of_the_gallery_is_told_from_every_other_and_from_itself_moved() {
    let pictures: Vec<(String, RgbImage)> = shown()
        .into_iter()
        .map(|shown| (shown.stored(), shown))
        .map(|(p, s)| (s.picture, p))
        .collect();
    for (i, (name, picture)) in pictures.iter().enumerate() {
        for (other_name, other) in &pictures[..i] {
            assert!(
                !is_alike(apart(picture, other)),
                "{name} and {other_name} pass for each other"
            );
        }
        let wide = image::DynamicImage::from(picture.clone()).to_rgba8();
        let moved = image::DynamicImage::from(compare::moved(&wide, 4, 0)).to_rgb8();
        assert!(!is_alike(apart(picture, &moved)), "{name} passes for itself moved by 4 px");
    }
}
