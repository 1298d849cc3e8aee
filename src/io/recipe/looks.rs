//! Looks: groups of live layers that come with the program, and the painted balls that they are
//! made of. Floor 5. A look in `brushes/looks` has a name, a sentence, the layers for a bare shape
//! and, where they differ, those for a drawing, at the lengths of a canvas of [`SIDE`] px.

use super::{RecipeSource, read_value};
use crate::document::{Content, Document, Group, Layer};
use crate::math::Size;
use crate::raster::Picture;
use crate::{Budget, Error, Files, Result, json, picture};
use rilievo_brushes::{BALLS, LOOKS};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The longer side of the canvas that the lengths of looks are for, px.
const SIDE: u32 = 1024;
/// The folder of painted balls, as looks name it.
const FOLDER: &str = "balls/";

/// A look that can be chosen by name.
#[derive(Clone, Debug, PartialEq)]
pub struct LiveLook {
    /// Its key on the command line and in replays: lower-case letters and hyphens.
    pub key: &'static str,
    /// Its name in the window, and that of its group.
    pub name: String,
    /// One sentence.
    pub about: String,
}

/// A ball that comes with the program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaintedBall {
    /// Its key in replays.
    pub key: &'static str,
    /// Its name in the window.
    pub name: &'static str,
    bytes: &'static [u8],
}

impl PaintedBall {
    /// All of them, in the order of the list.
    pub fn all() -> impl Iterator<Item = PaintedBall> {
        BALLS.iter().map(|(key, name, bytes)| PaintedBall { key, name, bytes })
    }

    /// The ball of a key.
    pub fn of_key(key: &str) -> Option<PaintedBall> {
        Self::all().find(|ball| ball.key == key)
    }

    /// The name that its picture has in documents.
    pub fn file(&self) -> String {
        format!("{FOLDER}{}.jpg", self.key)
    }

    /// Its picture.
    pub fn picture(&self) -> Result<Picture> {
        picture::decode(Path::new(&self.file()), self.bytes, &Budget::default())
    }
}

/// The files that looks name.
pub(super) struct BuiltInFiles;

impl Files for BuiltInFiles {
    fn read(&self, name: &str, _: &Budget) -> Result<Vec<u8>> {
        let ball = PaintedBall::all().find(|ball| ball.file() == name);
        let ball =
            ball.ok_or_else(|| Error::unsupported_file(name, "no painted ball has this name"))?;
        Ok(ball.bytes.to_vec())
    }

    fn path(&self, name: &str) -> PathBuf {
        name.into()
    }
}

impl LiveLook {
    /// All of them, in the order of the list.
    pub fn all() -> impl Iterator<Item = LiveLook> {
        LOOKS.iter().filter_map(|(key, text)| {
            let file = parse_look(key, text).ok()?;
            let word = |field: &str| file.get(field).and_then(Value::as_str).unwrap_or(key);
            Some(LiveLook { key, name: word("name").into(), about: word("about").into() })
        })
    }

    /// The look of a key.
    pub fn of_key(key: &str) -> Option<LiveLook> {
        Self::all().find(|look| look.key == key)
    }

    /// Their keys, in the order of the list.
    pub fn keys() -> impl Iterator<Item = &'static str> {
        LOOKS.iter().map(|(key, _)| *key)
    }

    /// A document in this look: its group of layers on top of all others, in the place of a look
    /// that is there already. On a drawing it keeps the drawing's colors, where the look has a way
    /// to.
    pub fn on(&self, document: &Document) -> Result<Document> {
        let mut next = document.clone();
        if document.layers.last().is_some_and(|layer| is_look(layer)) {
            next.layers.pop();
        }
        let is_painted = next.walk().iter().any(|(_, layer)| layer.visible && is_drawn(layer));
        let group = self.group(next.size, is_painted)?;
        next.layers.push(Arc::new(group));
        Ok(next)
    }

    /// Its layers, at the lengths of a canvas.
    fn group(&self, canvas: Size, is_painted: bool) -> Result<Layer> {
        let (_, text) = LOOKS.iter().find(|(key, _)| *key == self.key).copied().unwrap_or_default();
        let file = parse_look(self.key, text)?;
        let painted = file.get("painted").filter(|_| is_painted);
        let layers = painted.or(file.get("layers")).cloned().unwrap_or_default();
        let layers = live_layers(&path(self.key), layers, canvas)?;
        let group = Group { layers, pass_through: true };
        Ok(Layer::new(self.name.clone(), Content::Group(group)))
    }
}

/// Layers that come with the program, at the lengths of a canvas.
pub(super) fn live_layers(path: &Path, layers: Value, canvas: Size) -> Result<Vec<Arc<Layer>>> {
    let recipe = json!({ "format": "rilievo", "version": super::VERSION,
        "canvas": { "width": SIDE, "height": SIDE }, "layers": layers });
    let budget = Budget::default();
    let source = RecipeSource { file: path, files: &BuiltInFiles, budget: &budget, onto: None };
    let whole = read_value(&recipe, source)?;
    let factor = canvas.longer_side() / SIDE as f32;
    Ok(whole.scaled(factor).map_err(|e| Error::unsupported_file(path, e))?.layers)
}

/// Whether a layer holds something of a drawing. Fills are paper, and shading is what a look covers.
fn is_drawn(layer: &Layer) -> bool {
    match &layer.content {
        Content::Pixels(pixels) => !pixels.tiles.bounds().is_empty(),
        Content::Strokes(live) => !live.params().strokes.is_empty(),
        Content::Fill(_) | Content::Shading(_) | Content::Group(_) => false,
        content => content.has_pixels(),
    }
}

/// Whether a layer is the group of a look: the user may have changed its layers, not its name.
fn is_look(layer: &Layer) -> bool {
    matches!(layer.content, Content::Group(_))
        && LiveLook::all().any(|look| look.name == layer.name)
}

fn path(key: &str) -> PathBuf {
    format!("brushes/looks/{key}.json").into()
}

fn parse_look(key: &str, text: &str) -> Result<Value> {
    parse_file(&path(key), text)
}

/// A file that comes with the program.
pub(super) fn parse_file(path: &Path, text: &str) -> Result<Value> {
    json::parse(path, text.as_bytes(), &Budget::default())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Live, Progress, flatten};
    use crate::math::{Vec3, srgb::Color, vec2, vec3};
    use crate::paint::{Gradient, GradientStop, ImageFilter};
    use crate::raster::Plane;
    use crate::surface::{Maps, Operator, Surface};

    /// A form of bumps on a page, as large as asked for.
    fn scene(side: u32, bumps: f32) -> Document {
        let size = Size::new(side, side * 3 / 4);
        let middle = size.center();
        let normals = Plane::from_fn(size, |x, y| {
            let (u, v) = ((x as f32 - middle.x) / middle.y, (middle.y - y as f32) / middle.y);
            let z2 = 1.0 - (u * u + v * v) * 1.2;
            let bump = 0.3 * vec3((x as f32 * bumps).sin(), (y as f32 * bumps).cos(), 0.0);
            if z2 > 0.0 { vec3(u, v, z2.sqrt()) + bump } else { Vec3::ZERO }
        });
        let coverage = normals.map(|n| if n == Vec3::ZERO { 0 } else { 255 });
        let depth = normals.map(|n| 0.5 - 0.5 * n.z);
        Document::over(Surface::new(Maps { normals, depth, coverage }).unwrap())
    }

    fn painted(document: Document) -> Document {
        let stop = |t: f32, color: Color| GradientStop { t, color };
        let stops = vec![stop(0.0, Color::rgb(60, 140, 90)), stop(1.0, Color::rgb(200, 90, 60))];
        let (from, to) = (vec2(0.0, 0.0), vec2(90.0, 70.0));
        let (operator, filter) = (Operator::default(), ImageFilter::Antialias);
        let frame = Default::default();
        let bent = Gradient::new(from, to, &[]).with_operator(operator);
        let gradient = Gradient { stops, filter, frame, ..bent };
        document.with_top(Layer::new("Color", Content::Gradient(Live::new(gradient))))
    }

    #[test]
    fn every_look_opens_is_rendered_and_is_saved_as_it_is() {
        let scenes = [scene(160, 0.0), scene(96, 0.5), painted(scene(160, 0.1))];
        for look in LiveLook::all() {
            for scene in &scenes {
                let dressed = look.on(scene).unwrap_or_else(|e| panic!("{}: {e}", look.key));
                let tiles = flatten(&dressed, &Progress::default()).unwrap();
                let before = flatten(scene, &Progress::default()).unwrap();
                let rect = dressed.size.rect();
                let (now, then) = (tiles.to_straight_rgba(rect), before.to_straight_rgba(rect));
                let changed = now.chunks(4).zip(then.chunks(4)).filter(|(a, b)| a != b).count();
                assert!(changed * 10 > rect.width() * rect.height(), "{}: {changed}", look.key);
                let written = crate::recipe::write(&dressed);
                let source = RecipeSource {
                    file: Path::new("dressed.json"),
                    files: &BuiltInFiles,
                    budget: &Budget::default(),
                    onto: None,
                };
                let read = read_value(&written, source).unwrap();
                assert_eq!(crate::recipe::write(&read), written, "{}", look.key);
            }
        }
    }

    #[test]
    fn a_look_takes_the_place_of_the_one_before() {
        let [first, second] = ["oil-sketch", "gold"].map(|key| LiveLook::of_key(key).unwrap());
        let scene = painted(scene(96, 0.1));
        let once = first.on(&scene).unwrap();
        let twice = second.on(&once).unwrap();
        assert_eq!((once.layers.len(), twice.layers.len()), (2, 2));
        assert_eq!(twice.layers[1].name, second.name);
        // The first one is no drawing.
        let bare = first.on(&Document { layers: Vec::new(), ..scene }).unwrap();
        assert_eq!(bare.layers.len(), second.on(&bare).unwrap().layers.len());
    }

    #[test]
    fn every_ball_is_a_picture_of_its_own() {
        let balls: Vec<Picture> = PaintedBall::all().map(|ball| ball.picture().unwrap()).collect();
        assert!(balls.len() >= 12 && balls.iter().all(|ball| ball.size == balls[0].size));
        for (i, ball) in balls.iter().enumerate() {
            assert!(balls[..i].iter().all(|other| other != ball), "{i}");
        }
    }
}
