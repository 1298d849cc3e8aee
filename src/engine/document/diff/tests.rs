//! Redrawing only what differs must give what drawing everything gives.

use super::*;
use crate::document::{
    Content, Group, LayerSlot, Live, PixelLayer, PreparedDocument, Progress, StrokeList, flatten,
};
use crate::math::{Size, hash, srgb::Color, vec2, vec3};
use crate::paint::{Brush, Gradient, GradientStop, Stroke};
use crate::raster::{BlendMode, Picture, Plane, TileGrid};
use crate::shading::{LitSphere, Model, RadianceScaling, Shading};
use crate::surface::{Maps, Operator, Surface};

const SIZE: Size = Size::new(250, 190);

/// Numbers drawn one after the other.
struct RandomNumbers {
    seed: u32,
    count: u32,
}

impl RandomNumbers {
    fn unit(&mut self) -> f32 {
        self.count += 1;
        hash::unit(self.seed, self.count, 0)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f32) as usize
    }

    fn chance(&mut self, p: f32) -> bool {
        self.unit() < p
    }

    fn color(&mut self) -> Color {
        let mut byte = || (self.unit() * 256.0) as u8;
        Color { r: byte(), g: byte(), b: byte(), a: byte() }
    }

    /// A paint layer that holds a patch somewhere, perhaps beyond the canvas.
    fn pixels(&mut self) -> PixelLayer {
        let Color { r, g, b, a } = self.color();
        let (w, h) = (1 + self.below(90), 1 + self.below(90));
        let (x, y) = (self.below(300) as i32 - 40, self.below(220) as i32 - 40);
        let a = if self.chance(0.3) { 255 } else { a };
        PixelLayer {
            file: String::new(),
            x,
            y,
            tiles: TileGrid::from_straight_rgba(&[r, g, b, a].repeat(w * h), w, h, x, y),
        }
    }

    fn stroke(&mut self) -> Arc<Stroke> {
        let at = |d: &mut Self| vec2(d.unit() * 250.0, d.unit() * 190.0);
        let sample =
            |at| crate::paint::Sample { at, pressure: 1.0, tilt: vec2(0.0, 0.0), time_secs: 0.0 };
        let start = at(self);
        let samples = vec![sample(start), sample(start + vec2(30.0, 20.0))];
        let operator = Operator::Normal { alpha: 0.3, beta: 1.0, detail: 0.0 };
        Arc::new(Stroke::new(
            Brush { size: 30.0, ..Brush::default() },
            operator,
            self.color(),
            samples,
        ))
    }

    fn content(&mut self, depth: usize) -> Content {
        match self.below(8) {
            0 => Content::Fill(self.color()),
            1 => Content::Strokes(Live::new(StrokeList {
                strokes: (0..3).map(|_| self.stroke()).collect(),
            })),
            2 if depth < 2 => {
                let layers =
                    (0..1 + self.below(3)).map(|_| Arc::new(self.layer(depth + 1))).collect();
                Content::Group(Group { layers, pass_through: self.chance(0.5) })
            }
            3 => Content::RadianceScaling(RadianceScaling {
                keep_mean: self.chance(0.3),
                ..RadianceScaling::default()
            }),
            4 => {
                let stops = vec![
                    GradientStop { t: 0.0, color: self.color() },
                    GradientStop { t: 1.0, color: self.color() },
                ];
                let (from, to) = (vec2(10.0, 10.0), vec2(200.0, 150.0));
                let gradient = Gradient {
                    from,
                    to,
                    stops,
                    operator: Operator::None,
                    filter: Default::default(),
                    frame: Default::default(),
                    style: Default::default(),
                    pieces: Vec::new(),
                };
                Content::Gradient(Live::new(gradient))
            }
            _ => Content::Pixels(self.pixels()),
        }
    }

    fn layer(&mut self, depth: usize) -> Layer {
        let mut layer = Layer::new("", self.content(depth));
        layer.visible = self.chance(0.85);
        layer.opacity = if self.chance(0.5) { 1.0 } else { self.unit() };
        layer.clip_below = self.chance(0.3);
        layer.clip_to_surface = self.chance(0.3);
        if self.chance(0.5) {
            layer.blend = BlendMode::ALL[self.below(BlendMode::ALL.len())].0;
        }
        layer
    }

    /// One edit such as a painter makes.
    fn edit(&mut self, document: &Document) -> Option<Document> {
        let ids: Vec<LayerId> = document.walk().iter().map(|(_, layer)| layer.id).collect();
        let id = ids[self.below(ids.len())];
        let group = document
            .walk()
            .iter()
            .find(|(_, l)| matches!(l.content, Content::Group(_)))
            .map(|(_, l)| l.id);
        let place = LayerSlot { group: group.filter(|_| self.chance(0.5)), index: self.below(5) };
        match self.below(8) {
            0 => document.with_inserted(self.layer(1), place),
            1 if ids.len() > 2 => document.without_layer(id),
            2 => document.with_moved(id, place),
            3 => document.with_layer(id, |layer| layer.visible = !layer.visible),
            4 => document.with_layer(id, |layer| layer.clip_below = !layer.clip_below),
            5 => document.with_layer(id, |layer| layer.opacity = self.unit()),
            _ => document.with_layer(id, |layer| match &mut layer.content {
                Content::Pixels(pixels) => {
                    let patch = self.pixels().tiles;
                    patch.iter().for_each(|(at, tile)| pixels.tiles.set(at, Some(tile.clone())));
                }
                Content::Strokes(live) => {
                    let mut list = live.params().clone();
                    list.strokes.insert(self.below(4).min(list.strokes.len()), self.stroke());
                    *live = Live::new(list);
                }
                Content::Group(group) => group.pass_through = !group.pass_through,
                content => *content = self.content(2),
            }),
        }
    }
}

fn dome() -> Arc<Surface> {
    let at = |x: usize, y: usize| vec2(x as f32 - 120.0, y as f32 - 90.0) / 80.0;
    let coverage = Plane::from_fn(SIZE, |x, y| if at(x, y).length() < 1.0 { 255 } else { 0 });
    let normals = Plane::from_fn(SIZE, |x, y| {
        vec3(at(x, y).x, -at(x, y).y, (1.0 - at(x, y).length_squared()).max(0.0).sqrt())
    });
    let depth = normals.map(|n| 1.0 - n.z);
    Arc::new(Surface::new(Maps { normals, depth, coverage }).unwrap())
}

fn differing(a: &TileGrid, b: &TileGrid) -> Vec<TileAt> {
    let bytes = |grid: &TileGrid, at| grid.tile(at).map(|tile| tile.bytes().to_vec());
    TileAt::covering(SIZE.rect()).filter(|&at| bytes(a, at) != bytes(b, at)).collect()
}

#[test]
fn redrawing_what_differs_gives_what_redrawing_everything_gives() {
    let surface = dome();
    let (mut named, mut differ) = (0, 0);
    for seed in 0..30 {
        let mut draw = RandomNumbers { seed, count: 0 };
        let layers = (0..6).map(|_| Arc::new(draw.layer(0))).collect();
        let mut document =
            Document { surface: Some(surface.clone()), layers, ..Document::empty(SIZE) };
        let mut picture = flatten(&document, &Progress::default()).unwrap();
        for step in 0..7 {
            let Some(next) = draw.edit(&document) else { continue };
            let changed: Vec<TileAt> = diff(&document, &next).into_iter().collect();
            let prepared = PreparedDocument::new(&next, &Progress::default()).unwrap();
            let redrawn = prepared.flatten_tiles(&picture, &changed, &Progress::default()).unwrap();
            let anew = flatten(&next, &Progress::default()).unwrap();
            assert_eq!(
                differing(&redrawn, &anew),
                [],
                "seed {seed}, step {step}; {changed:?} were redrawn"
            );
            (named, differ) = (named + changed.len(), differ + differing(&picture, &anew).len());
            (document, picture) = (next, anew);
        }
    }
    assert!(named < 3 * differ, "{named} tiles were named, {differ} differ: too many to be of use");
}

#[test]
fn a_document_does_not_differ_from_its_clone() {
    let mut draw = RandomNumbers { seed: 3, count: 0 };
    let layers = (0..9).map(|_| Arc::new(draw.layer(0))).collect();
    let document = Document { layers, ..Document::empty(SIZE) };
    assert!(diff(&document, &document.clone()).is_empty());
}

#[test]
fn a_name_changes_nothing_and_a_dab_only_its_tile() {
    let mut draw = RandomNumbers { seed: 4, count: 0 };
    let layer = Layer::new("paint", Content::Pixels(draw.pixels()));
    let id = layer.id;
    let old = Document { layers: vec![Arc::new(layer)], ..Document::empty(SIZE) };
    assert!(
        diff(&old, &old.with_layer(id, |layer| layer.name = "other".into()).unwrap()).is_empty()
    );
    let dabbed = old.with_layer(id, |layer| {
        if let Content::Pixels(pixels) = &mut layer.content {
            let patch = TileGrid::from_straight_rgba(&[255; 4], 1, 1, 130, 70);
            pixels.tiles.set(TileAt::new(2, 1), patch.tile(TileAt::new(2, 1)).cloned());
        }
    });
    assert_eq!(diff(&old, &dabbed.unwrap()).into_iter().collect::<Vec<_>>(), [TileAt::new(2, 1)]);
}

#[test]
fn another_surface_changes_everything() {
    let mut draw = RandomNumbers { seed: 5, count: 0 };
    let old = Document { layers: vec![Arc::new(draw.layer(0))], ..Document::empty(SIZE) };
    let new = Document { surface: Some(dome()), ..old.clone() };
    assert_eq!(diff(&old, &new).len(), 12);
}

/// A ball before a wall, so that there are contours, under a painted ball of stripes.
fn figure_of_a_painted_ball(dab: Option<(u32, u32)>) -> Document {
    let size = Size::new(300, 260);
    let at = |x: usize, y: usize| {
        let (dx, dy) = ((x as f32 - 150.0) / 90.0, (y as f32 - 130.0) / 90.0);
        let z2 = 1.0 - dx * dx - dy * dy;
        let wall = vec3((x as f32 * 0.03).sin(), (y as f32 * 0.04).cos(), 1.5);
        if z2 > 0.0 { (vec3(dx, -dy, z2.sqrt()), 0.5 - 0.3 * z2.sqrt()) } else { (wall, 1.0) }
    };
    let surface = Surface::new(Maps {
        normals: Plane::from_fn(size, |x, y| at(x, y).0),
        depth: Plane::from_fn(size, |x, y| at(x, y).1),
        coverage: Plane::full(size, 255),
    });
    let texel = |i: u32| {
        let (x, y) = (i % 128, i / 128);
        let is_dab = dab.is_some_and(|(u, v)| x.abs_diff(u) < 5 && y.abs_diff(v) < 5);
        if is_dab { [255, 0, 0, 255] } else { [(x * 2) as u8, (y * 2) as u8, 90, 255] }
    };
    let picture = Picture::srgb8(Size::new(128, 128), (0..128 * 128).map(texel).collect()).unwrap();
    let mut shading = Shading::new(Model::LitSphere);
    shading.strokes.on = true;
    shading.strokes.size = 128.0;
    let ball = LitSphere::new("ball.png".into(), picture);
    let layer = Layer::new("Lit", Content::Shading(Live::new(shading.with_ball(false, ball))));
    Document { surface: surface.ok().map(Arc::new), ..Document::empty(size) }.with_top(layer)
}

#[test]
fn a_dab_on_a_painted_ball_changes_the_tiles_that_show_it() {
    let old = figure_of_a_painted_ball(None);
    let all = TileAt::covering(old.size.rect()).count();
    for dab in [(64, 64), (30, 50), (90, 100), (64, 3), (118, 64)] {
        let mut new = figure_of_a_painted_ball(Some(dab));
        new.surface = old.surface.clone();
        // The same layer with another ball.
        new.layers = vec![Arc::new(Layer {
            content: new.layers[0].content.clone(),
            ..Layer::clone(&old.layers[0])
        })];
        let told = diff(&old, &new);
        let [before, after] =
            [&old, &new].map(|d| flatten(d, &Progress::default()).expect("a picture"));
        let differing = differing(&before, &after);
        assert!(!differing.is_empty() && differing.len() < all, "{dab:?}");
        let missed: Vec<_> = differing.iter().filter(|at| !told.contains(at)).collect();
        assert!(missed.is_empty(), "{dab:?}: {missed:?}");
        assert!(told.len() < all, "{dab:?}: {} of {all}", told.len());
    }
}
