//! How stories begin: the folder with the files that they may use, and every way in.

use super::dice::{Dice, Roll};
use super::gestures::gesture;
use crate::math::{Vec2, srgb::Color, vec2};
use crate::session::actions::{
    Action, FileAction, HandAction, LayerAction, NewLayer, PartAction, PointerAction,
};
use crate::session::actions::{SelectionAction, parts::InflationPreset};
use crate::session::replay::ReplayValue;
use crate::session::storage;
use crate::tools::{PenSample, ToolKind};
use image::{DynamicImage, ImageBuffer, ImageFormat, Luma, Rgb, Rgba};
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// A folder for one story at a time.
pub struct StoryFolder {
    path: PathBuf,
    _kept: tempfile::TempDir,
}

impl StoryFolder {
    pub fn new() -> Self {
        let kept = tempfile::tempdir().unwrap();
        Self { path: kept.path().join("story"), _kept: kept }
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Empties it, but for the files that every story begins with.
    pub fn begin(&self) {
        drop(std::fs::remove_dir_all(&self.path));
        write_assets(&self.path);
    }
}

/// Writes the files that stories use to a folder.
pub fn write_assets(folder: &Path) {
    std::fs::create_dir_all(folder).unwrap();
    for (name, bytes) in assets() {
        std::fs::write(folder.join(name), bytes).unwrap();
    }
}

/// A vector drawing with a clip and an outline.
const SHAPES: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="90" height="60">
  <clipPath id="c"><circle cx="30" cy="30" r="18"/></clipPath>
  <path id="body" d="M5 50 Q20 5 60 12 T85 50 Z" fill="#c07040"/>
  <g clip-path="url(#c)"><rect x="15" y="20" width="30" height="30" fill="#40c0a0"/></g>
  <rect x="55" y="20" width="16" height="14" fill="#3040c0" stroke="#202020" stroke-width="3"/></svg>"##;

/// The files that stories use.
fn assets() -> &'static [(String, Vec<u8>)] {
    static ASSETS: OnceLock<Vec<(String, Vec<u8>)>> = OnceLock::new();
    ASSETS.get_or_init(|| {
        let mut files = pictures();
        files.push(("recipe.json".into(), RECIPE.as_bytes().to_vec()));
        files.push(("colors.gpl".into(), b"GIMP Palette\n1 2 3\tNight\n200 90 40\n".to_vec()));
        files.push(("shapes.svg".into(), SHAPES.as_bytes().to_vec()));
        let seeds = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/seeds/files");
        for name in ["im-layers16.psd", "im-rgb8.psd", "pt-RGB-ZIP.psd"] {
            files.extend(std::fs::read(seeds.join(name)).map(|bytes| (name.to_owned(), bytes)));
        }
        // The recipe as a project and as a Photoshop file.
        let folder = tempfile::tempdir().unwrap();
        files
            .iter()
            .for_each(|(name, bytes)| std::fs::write(folder.path().join(name), bytes).unwrap());
        let opened = storage::open(&folder.path().join("recipe.json")).unwrap();
        for name in ["own.ora", "own.psd"] {
            let file = folder.path().join(name);
            let terms = crate::io::Overwrite::Nothing;
            storage::save(
                &file,
                opened.open.document(),
                terms,
                &crate::document::Progress::default(),
            )
            .unwrap();
            files.push((name.into(), std::fs::read(&file).unwrap()));
        }
        files
    })
}

/// Maps of two balls on a canvas of 96 × 72 pixels and in another size, and pictures.
fn pictures() -> Vec<(String, Vec<u8>)> {
    let ball = |x: u32, y: u32, scale: f32| {
        let at = vec2(x as f32 + 0.5, y as f32 + 0.5) / scale;
        let of = |middle: Vec2, radius: f32| (at - middle) / radius;
        let off = [of(vec2(34.0, 36.0), 26.0), of(vec2(72.0, 40.0), 17.0)]
            .into_iter()
            .find(|off| off.length() < 1.0);
        off.map(|off| off.extend((1.0 - off.length_squared()).sqrt()))
    };
    let byte = |v: f32| (127.5 * (v + 1.0)).round() as u8;
    let normals = |scale: f32| {
        let pixel = |x, y| {
            ball(x, y, scale)
                .map_or(Rgba([128, 128, 255, 0]), |n| Rgba([byte(n.x), byte(-n.y), byte(n.z), 255]))
        };
        DynamicImage::ImageRgba8(ImageBuffer::from_fn(
            (96.0 * scale) as u32,
            (72.0 * scale) as u32,
            pixel,
        ))
    };
    let depth = ImageBuffer::from_fn(96, 72, |x, y| {
        Luma([ball(x, y, 1.0).map_or(0, |n| (65535.0 * n.z) as u16)])
    });
    let picture = ImageBuffer::from_fn(40, 30, |x, y| {
        Rgba([(x * 6) as u8, (y * 8) as u8, (x * y) as u8, (255 - 4 * x) as u8])
    });
    let texels16 = ImageBuffer::from_fn(32, 32, |x, y| {
        Rgb([(x * 2000 + 17) as u16, (y * 2000 + 3) as u16, (x * y * 60) as u16])
    });
    let gray = ImageBuffer::from_fn(48, 36, |x, y| Luma([((x * 5) ^ (y * 7)) as u8]));
    let inked = ImageBuffer::from_fn(48, 36, |x, y| match (x.min(47 - x).min(y).min(35 - y), x) {
        (0..4, _) => Rgba([0; 4]),
        (4..6, _) | (_, 23..25) => Rgba([28, 22, 30, 255]),
        (_, 0..23) => Rgba([210, 60, 50, 255]),
        _ => Rgba([60, 160, 90, 255]),
    });
    let mask = ImageBuffer::from_fn(96, 72, |x, y| Luma([(x * 2 + y) as u8]));
    let all = [
        ("mask.png", DynamicImage::ImageLuma8(mask)),
        ("normal.png", normals(1.0)),
        ("normal-small.png", normals(0.5)),
        ("depth.png", DynamicImage::ImageLuma16(depth)),
        ("picture.png", DynamicImage::ImageRgba8(picture)),
        ("inked.png", DynamicImage::ImageRgba8(inked)),
        ("picture-deep.png", DynamicImage::ImageRgb16(texels16)),
        ("gray.png", DynamicImage::ImageLuma8(gray)),
    ];
    let encoded = |image: DynamicImage| {
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, ImageFormat::Png).unwrap();
        bytes.into_inner()
    };
    let drawing = br##"<svg xmlns="http://www.w3.org/2000/svg" width="40" height="30">
        <circle cx="14" cy="15" r="11" fill="#d08030"/><text x="4" y="22">Ab</text></svg>"##;
    let encoded = all.into_iter().map(|(name, image)| (name.to_owned(), encoded(image)));
    encoded.chain([("drawing.svg".to_owned(), drawing.to_vec())]).collect()
}

/// A document with most kinds of layers.
const RECIPE: &str = r##"{ "format": "rilievo", "version": 2,
    "surface": { "normal": { "file": "normal.png" }, "depth": { "file": "depth.png" } },
    "layers": [
        { "name": "Ground", "kind": "fill", "color": "#304050", "clip_to_surface": false },
        { "name": "Paint", "kind": "pixels", "file": "picture.png", "x": 20, "y": 9, "opacity": 0.75 },
        { "name": "Inked", "kind": "pixels", "file": "inked.png", "x": 30, "y": 20 },
        { "name": "Ink", "kind": "ink", "of": "Inked", "opacity": 0.9 },
        { "name": "Print", "kind": "image", "source": { "file": "picture.png", "blur": 1.5 }, "blend": "multiply",
          "operator": { "kind": "normal", "alpha": 0.4 }, "mask": { "file": "mask.png" } },
        { "name": "Ramp", "kind": "gradient", "blend": "screen", "stops": [[0, "#ff000080"], [1, "#00ff00"]],
          "operator": { "kind": "normal" } },
        { "name": "Contours", "kind": "lines", "of": ["outlines", "ridges", "light"], "hand": { "wobble": 1 } },
        { "name": "Hatching", "kind": "hatching", "spacing": 12, "style": "engraving" },
        { "name": "Lines", "kind": "strokes", "mask": { "kind": "fresnel", "invert": true }, "strokes": [
            { "brush": { "preset": "soft-round", "size": 12 }, "color": "#ffcc00",
              "samples": [[4, 9, 0.5], [30, 33, 1], [50, 12, 0.25, 5, -4, 1.5]] } ] },
        { "name": "Group", "kind": "group", "opacity": 0.5, "layers": [
            { "name": "Lit", "kind": "shading", "model": "phong",
              "lights": [{ "kind": "directional", "direction": [0.3, 0.5, 0.8] }] } ] },
        { "name": "Relief", "kind": "radiance-scaling", "alpha": 0.3, "opacity": 0.6 } ] }"##;

/// The actions that a story begins with, by one of the ways in.
pub fn way_in(dice: &mut Dice) -> Vec<Action> {
    const WAYS: [fn(&mut Dice) -> Vec<Action>; 8] = [
        blank,
        drawing,
        start_with_ink,
        |d| drawing_with(d, "false"),
        |d| drawing_with(d, "true"),
        maps,
        start_from_file,
        start_from_file,
    ];
    let way = dice.one_of(&WAYS);
    way(dice)
}

fn blank(dice: &mut Dice) -> Vec<Action> {
    vec![Action::File(FileAction::New {
        width: dice.value("new", "width"),
        height: dice.value("new", "height"),
        background: dice.value("new", "background"),
        profile: dice.value("new", "profile"),
    })]
}

/// Ellipses of two colors on a paint layer.
fn drawing(dice: &mut Dice) -> Vec<Action> {
    let mut actions = vec![Action::File(FileAction::New {
        width: 96,
        height: 72,
        background: Some(Color::WHITE),
        profile: None,
    })];
    actions.push(Action::Layer(LayerAction::Add { kind: NewLayer::Paint }));
    for (color, from, to) in
        [("#c05030", (12.0, 10.0), (60.0, 62.0)), ("#3060a0", (50.0, 20.0), (84.0, 50.0))]
    {
        actions.push(Action::Hand(HandAction::Color { color: Color::parse(color).unwrap() }));
        let pen = |(x, y): (f32, f32)| PenSample::at(vec2(x, y));
        let press = |tool, pen| Action::Pointer(PointerAction::Press { tool, pen, px_per_pt: 1.0 });
        actions.extend([
            press(ToolKind::SelectEllipse, pen(from)),
            Action::Pointer(PointerAction::Drag { pens: vec![pen(to)] }),
            Action::Pointer(PointerAction::Release {}),
            press(ToolKind::Fill, pen((0.5 * (from.0 + to.0), 0.5 * (from.1 + to.1)))),
            Action::Pointer(PointerAction::Release {}),
            Action::Selection(SelectionAction::None {}),
        ]);
    }
    actions.extend(gesture(dice, ToolKind::Brush));
    actions
}

/// A drawing with ink, which gets a layer of its own.
fn start_with_ink(_: &mut Dice) -> Vec<Action> {
    let layer = ReplayValue::read(&"0".into()).unwrap();
    let open = Action::File(FileAction::Open { file: "inked.png".into() });
    vec![open, Action::Part(PartAction::Ink { layer })]
}

/// Ellipses of two colors with a shape.
fn drawing_with(dice: &mut Dice, flats: &str) -> Vec<Action> {
    let mut actions = drawing(dice);
    let layer = ReplayValue::read(&"1".into()).unwrap();
    let flats = ReplayValue::read(&serde_json::from_str(flats).unwrap()).unwrap();
    actions.push(Action::Part(PartAction::Shape {
        layer,
        preset: InflationPreset::roll(dice),
        flats,
    }));
    actions
}

fn maps(dice: &mut Dice) -> Vec<Action> {
    let normal = dice.value("open maps", "normal");
    vec![Action::File(FileAction::OpenMaps { normal, depth: dice.value("open maps", "depth") })]
}

/// A recipe, a project, a Photoshop file or a picture.
fn start_from_file(dice: &mut Dice) -> Vec<Action> {
    vec![Action::File(FileAction::Open { file: dice.value("open", "file") })]
}
