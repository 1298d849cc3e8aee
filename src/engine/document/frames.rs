//! Frames of groups, such as those of a comic's panels: a path in a group that clips what lies
//! beneath it there. Floor 4. Not here: composing (`compose`).

use super::layer::on_canvas::on_canvas;
use super::layer::warp::displaced_mask;
use super::{Content, Document, Group, Layer, LayerId, LayerMap, LayerMask, LayerWarp, MaskKind};
use crate::math::parallel;
use crate::math::srgb::Color;
use crate::paint::{LivePath, PathRule, PlacedImage, Scene};
use crate::raster::coverage::shapes;
use crate::raster::{CoverageGrid, TileAt, TileGrid};
use std::sync::Arc;

impl Layer {
    /// Whether it clips what lies beneath it in its group. A hidden frame clips nothing, nor does
    /// one that is itself clipped to a layer.
    pub fn is_frame(&self) -> bool {
        let path = match &self.content {
            Content::Image(live) => live.params().source.path(),
            _ => None,
        };
        self.visible && !self.clip_below && path.is_some_and(|path| path.frames)
    }
}

impl Group {
    /// The places of its frames among its layers.
    pub fn frames(&self) -> impl Iterator<Item = usize> + '_ {
        self.layers.iter().enumerate().filter(|(_, layer)| layer.is_frame()).map(|(place, _)| place)
    }
}

impl Document {
    /// What lies inside of a frame; `None` for a layer that is none.
    pub fn inside_of_frame(&self, id: LayerId) -> Option<Arc<CoverageGrid>> {
        inside(self.layer(id)?, &self.map_of(id)?.of_list(), &self.scene_of(id)?)
    }

    /// With what a frame clips in a group of its own, whose mask is the inside of the frame: the same
    /// picture once the frame clips no more. `None` for a layer that is no frame of a group.
    pub fn with_frame_as_mask(&self, id: LayerId) -> Option<Document> {
        let place = self.place_of(id)?;
        place.group?;
        let inside = self.inside_of_frame(id)?;
        let coverage = Arc::new(inside.to_plane(self.size.rect()));
        let name = self.free_layer_name("Inside");
        self.with_siblings(place, |layers, index| {
            let clipped: Vec<Arc<Layer>> = layers.drain(..index).collect();
            let group = Group { layers: clipped, pass_through: true };
            let mask = LayerMask::new(MaskKind::File { file: String::new(), coverage });
            let group = Layer {
                mask: Some(mask),
                clip_to_surface: false,
                ..Layer::new(name, Content::Group(group))
            };
            layers.insert(0, Arc::new(group));
            Some(())
        })
    }
}

/// What lies inside of a frame on the canvas; `None` for a layer that is none.
///
/// * `around`: what takes the frame's group to the canvas.
pub(super) fn inside(
    layer: &Arc<Layer>,
    around: &LayerMap,
    scene: &Scene,
) -> Option<Arc<CoverageGrid>> {
    if !layer.is_frame() {
        return None;
    }
    let cover = || cover(layer, around, scene).map(Arc::new);
    layer.cache.framed.get(scene, std::slice::from_ref(layer), around, cover)
}

fn cover(layer: &Arc<Layer>, around: &LayerMap, scene: &Scene) -> Option<CoverageGrid> {
    let shown = on_canvas(layer, around);
    let Content::Image(live) = &shown.content else { return None };
    let (image, path) = (live.params(), live.params().source.path()?);
    let is_flat = scene.surface.is_none() || image.bend.operator.is_identity();
    let grid = match is_flat {
        true => cover_flat(image, path, scene),
        false => cover_bent(image, path, scene)?,
    };
    Some(match LayerWarp::of(layer, &around.within(layer)) {
        Some(warp) => displaced(&grid, &warp, scene),
        None => grid,
    })
}

/// The inside of a path that is not bent, exactly.
fn cover_flat(image: &PlacedImage, path: &LivePath, scene: &Scene) -> CoverageGrid {
    let lines = path.flatten_for_area(|p| image.canvas_from_path(scene.size, p));
    let polygons: Vec<_> = lines.iter().map(Vec::as_slice).collect();
    shapes::polygons(&polygons, path.rule == PathRule::EvenOdd, scene.size.rect())
}

/// The inside of a path that is bent as the path is, filled.
fn cover_bent(image: &PlacedImage, path: &LivePath, scene: &Scene) -> Option<CoverageGrid> {
    let solid = LivePath { outline: 0.0, frames: false, ..path.clone() }.with_fill(Color::BLACK);
    // The pin stays where it is, although the box of the path is another.
    let solid = PlacedImage { bend: image.bend.clone(), ..image.with_path(scene.size, solid)? };
    solid.source.texture();
    let places: Vec<TileAt> = TileAt::covering(scene.size.rect()).collect();
    let tiles: Vec<_> = parallel::map(&places, |at| solid.render_tile(scene, *at).map(Arc::new));
    let mut grid = TileGrid::for_rect(scene.size.rect());
    places.into_iter().zip(tiles).for_each(|(at, tile)| grid.set(at, tile));
    Some(CoverageGrid::of_alpha(&grid))
}

/// The same through the displacement of the layer.
fn displaced(grid: &CoverageGrid, warp: &LayerWarp, scene: &Scene) -> CoverageGrid {
    let coverage = Arc::new(grid.to_plane(scene.size.rect()));
    let mask = LayerMask::new(MaskKind::File { file: String::new(), coverage });
    let seen = displaced_mask(&mask, &LayerMap::none(scene.size), warp, None);
    match &seen.kind {
        MaskKind::File { coverage, .. } => CoverageGrid::from_plane(coverage, 0, 0),
        MaskKind::Derived(_) => grid.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{LayerTransform, Live, Progress, TransformShape, flatten};
    use crate::math::{Size, vec2};
    use crate::paint::{Figure, FigureKind};
    use crate::raster::{BlendMode, Resampling};

    const SIZE: Size = Size::new(100, 80);
    const RED: Color = Color::rgb(200, 20, 10);
    const BLUE: Color = Color::rgb(10, 30, 200);

    fn fill(color: Color) -> Layer {
        Layer::new("paper", Content::Fill(color))
    }

    fn frame(outline: f32) -> Layer {
        let (from, to) = (vec2(20.0, 10.0), vec2(60.5, 50.0));
        let figure = Figure { kind: FigureKind::Rectangle, from, to, ..Figure::DEFAULT };
        let path = LivePath { outline, frames: true, ..LivePath::new(figure) };
        let image = PlacedImage::of_path(SIZE, path);
        Layer { clip_to_surface: false, ..Layer::new("Frame", Content::Image(Live::new(image))) }
    }

    fn page(layers: Vec<Layer>, pass_through: bool) -> Document {
        let layers = layers.into_iter().map(Arc::new).collect();
        let group = Layer::new("Panel 1", Content::Group(Group { layers, pass_through }));
        Document { layers: vec![Arc::new(group)], ..Document::empty(SIZE) }
    }

    fn pixels(document: &Document, at: &[(i32, i32)]) -> Vec<[u8; 4]> {
        let seen = flatten(document, &Progress::default()).unwrap();
        at.iter().map(|(x, y)| seen.pixel(*x, *y)).collect()
    }

    const CLEAR: [u8; 4] = [0; 4];

    #[test]
    fn what_lies_beneath_a_frame_is_seen_inside_of_it_and_what_lies_above_everywhere() {
        for passes in [false, true] {
            let plain = page(vec![fill(RED), frame(0.0)], passes);
            let red = [200, 20, 10, 255];
            let seen = pixels(&plain, &[(19, 30), (20, 30), (59, 49), (59, 50), (61, 30)]);
            assert_eq!(seen, [CLEAR, red, red, CLEAR, CLEAR], "passes: {passes}");
            // Half of a pixel.
            assert_eq!(pixels(&plain, &[(60, 30)])[0][3], 128);
            // The line lies half outside, and is not clipped.
            let lined = page(vec![fill(RED), frame(6.0)], passes);
            let black = [0, 0, 0, 255];
            let seen = pixels(&lined, &[(16, 30), (17, 30), (22, 30), (23, 30)]);
            assert_eq!(seen, [CLEAR, black, black, red], "passes: {passes}");
            let above = page(vec![fill(RED), frame(0.0), fill(BLUE)], passes);
            assert_eq!(pixels(&above, &[(5, 5), (30, 30)]), [[10, 30, 200, 255]; 2]);
        }
    }

    #[test]
    fn a_frame_that_passes_through_leaves_what_lies_beneath_the_group() {
        let mut document = page(vec![fill(RED), frame(0.0)], true);
        let multiplied = |layer: &Layer| {
            let mut group = layer.content.group().unwrap().clone();
            Arc::make_mut(&mut group.layers[0]).blend = BlendMode::Multiply;
            Layer { content: Content::Group(group), ..layer.clone() }
        };
        document.layers = vec![
            Arc::new(fill(Color::rgb(128, 255, 255))),
            Arc::new(multiplied(&document.layers[0])),
        ];
        let seen = pixels(&document, &[(30, 30), (5, 5)]);
        assert_eq!(seen, [[100, 20, 10, 255], [128, 255, 255, 255]]);
    }

    #[test]
    fn hidden_and_clipped_frames_and_those_of_no_group_clip_nothing() {
        let hidden = Layer { visible: false, ..frame(0.0) };
        let clipped = Layer { clip_below: true, ..frame(0.0) };
        for other in [hidden, clipped] {
            assert!(!other.is_frame());
            assert_eq!(pixels(&page(vec![fill(RED), other], false), &[(5, 5)])[0][3], 255);
        }
        let layers = vec![Arc::new(fill(RED)), Arc::new(frame(0.0))];
        let bare = Document { layers, ..Document::empty(SIZE) };
        assert_eq!(pixels(&bare, &[(5, 5)])[0][3], 255);
    }

    #[test]
    fn a_mask_in_the_place_of_a_frame_clips_the_same() {
        let oval = Figure {
            kind: FigureKind::Ellipse,
            from: vec2(30.0, 5.0),
            to: vec2(90.3, 70.0),
            ..Figure::DEFAULT
        };
        let path = LivePath { frames: true, ..LivePath::new(oval) };
        let oval = Layer::new("oval", Content::Image(Live::new(PlacedImage::of_path(SIZE, path))));
        let faint = Layer { opacity: 0.5, blend: BlendMode::Multiply, ..fill(BLUE) };
        for passes in [false, true] {
            let layers = vec![fill(RED), frame(3.0), faint.clone(), oval.clone(), faint.clone()];
            let mut document = page(layers, passes);
            document.layers.insert(0, Arc::new(fill(Color::rgb(90, 200, 120))));
            let group = document.layers[1].content.group().unwrap();
            let frames: Vec<LayerId> = group.frames().map(|place| group.layers[place].id).collect();
            let before = flatten(&document, &Progress::default()).unwrap();
            let stop_clipping = |layer: &mut Layer| {
                let Content::Image(live) = &layer.content else { panic!("a frame") };
                let path = live.params().source.path().unwrap();
                let path = LivePath { frames: false, ..LivePath::clone(path) };
                layer.content = Content::Image(Live::new(PlacedImage::of_path(SIZE, path)));
            };
            for id in frames {
                let masked = document.with_frame_as_mask(id).unwrap();
                let masked = masked.with_layer(id, stop_clipping).unwrap();
                let seen = flatten(&masked, &Progress::default()).unwrap();
                for (x, y) in (0..100).flat_map(|x| (0..80).map(move |y| (x, y))) {
                    let both = [before.pixel(x, y), seen.pixel(x, y)];
                    let off = (0..4).map(|k| both[0][k].abs_diff(both[1][k])).max();
                    assert!(off <= Some(1), "passes {passes}, {x} {y}: {both:?}");
                }
            }
            assert!(document.with_frame_as_mask(document.layers[0].id).is_none());
        }
    }

    #[test]
    fn two_frames_clip_one_after_the_other() {
        let (from, to) = (vec2(40.0, 0.0), vec2(100.0, 80.0));
        let path =
            LivePath { frames: true, ..LivePath::new(Figure { from, to, ..Figure::DEFAULT }) };
        let right =
            Layer::new("right", Content::Image(Live::new(PlacedImage::of_path(SIZE, path))));
        let document = page(vec![fill(RED), frame(0.0), fill(BLUE), right], false);
        let seen = pixels(&document, &[(30, 30), (50, 30), (90, 70)]);
        assert_eq!(seen, [CLEAR, [10, 30, 200, 255], [10, 30, 200, 255]]);
        let two = page(vec![fill(RED), frame(0.0), frame(0.0)], false);
        assert_eq!(pixels(&two, &[(30, 30), (5, 5)]), [[200, 20, 10, 255], CLEAR]);
    }

    #[test]
    fn the_inside_moves_with_the_transforms_of_the_frame_and_of_its_group() {
        let shape = TransformShape::Matrix([1.0, 0.0, 0.0, 1.0, 10.0, 5.0]);
        let moved = Some(LayerTransform { shape, filter: Resampling::default() });
        let of_frame =
            page(vec![fill(RED), Layer { transform: moved.clone(), ..frame(0.0) }], false);
        let mut of_group = page(vec![fill(RED), frame(0.0)], false);
        Arc::make_mut(&mut of_group.layers[0]).transform = moved;
        for document in [of_frame, of_group] {
            let seen = pixels(&document, &[(29, 30), (30, 30), (40, 14), (40, 15), (69, 54)]);
            let red = [200, 20, 10, 255];
            assert_eq!(seen, [CLEAR, red, CLEAR, red, red]);
        }
    }
}
