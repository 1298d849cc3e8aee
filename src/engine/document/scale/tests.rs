//! A document at another size must look like its picture at that size.

use super::*;
use crate::document::layer::scale::source_weights;
use crate::document::{
    Content, Group, Layer, LayerMask, Live, MaskKind, PixelLayer, Progress, StrokeList, flatten,
};
use crate::math::{srgb::Color, vec2, vec3};
use crate::paint::{
    Adjust, Brush, Gradient, GradientStop, ImageFilter, PictureSource, PlacedImage, Placement,
    Sample, Stroke,
};
use crate::raster::{BlendMode, Outside, Picture, Plane, TileGrid};
use crate::shading::RadianceScaling;
use crate::surface::{Anchor, Bend, Maps, Operator, Surface};

const SIZE: Size = Size::new(240, 160);

fn dome() -> Arc<Surface> {
    let at = |x: usize, y: usize| (vec2(x as f32, y as f32) + 0.5 - vec2(120.0, 80.0)) / 75.0;
    let z = |x: usize, y: usize| (1.0 - at(x, y).length_squared()).max(0.0).sqrt();
    let coverage = Plane::from_fn(SIZE, |x, y| if at(x, y).length() < 1.0 { 255 } else { 0 });
    let normals = Plane::from_fn(SIZE, |x, y| vec3(at(x, y).x, -at(x, y).y, z(x, y).max(0.01)));
    let depth = Plane::from_fn(SIZE, |x, y| 1.0 - z(x, y));
    Arc::new(Surface::new(Maps { normals, depth, coverage }).unwrap())
}

fn waves(size: Size) -> Vec<[u8; 4]> {
    let wave =
        |i: u32, j: u32| (128.0 + 100.0 * (i as f32 * 0.06).sin() * (j as f32 * 0.05).cos()) as u8;
    (0..size.height)
        .flat_map(|y| (0..size.width).map(move |x| [wave(x, y), wave(y, x), 90, 255]))
        .collect()
}

fn with(mut layer: Layer, change: impl FnOnce(&mut Layer)) -> Arc<Layer> {
    change(&mut layer);
    Arc::new(layer)
}

/// A document with every kind of layer that another resolution could break.
fn document() -> Document {
    let tiles = TileGrid::from_straight_rgba(waves(SIZE).as_flattened(), 240, 160, -20, 10);
    let pixels = Content::Pixels(PixelLayer { file: "p.png".into(), x: -20, y: 10, tiles });
    let anchor = Anchor { at: vec2(100.0, 70.0), source: vec2(90.0, 80.0) };
    let operator = Operator::Normal { alpha: 0.2, beta: 0.5, detail: 0.0 };
    let image = PlacedImage {
        source: PictureSource::new(
            "w".into(),
            Picture::srgb8(SIZE, waves(SIZE)).unwrap(),
            Adjust::default(),
        ),
        placement: Placement { center: vec2(110.0, 90.0), scale: 1.5, rotation: 20.0 },
        outside: Outside::Mirror,
        bend: Bend { operator, anchors: vec![anchor], ..Bend::default() },
        filter: ImageFilter::Bilinear,
        frame: Default::default(),
    };
    let stops = vec![
        GradientStop { t: 0.0, color: Color::BLACK },
        GradientStop { t: 1.0, color: Color::WHITE },
    ];
    let gradient = Gradient {
        from: vec2(50.0, 30.0),
        to: vec2(180.0, 120.0),
        stops,
        operator,
        filter: ImageFilter::Antialias,
        frame: Default::default(),
        style: Default::default(),
        pieces: Vec::new(),
    };
    let samples = [40.0, 120.0, 190.0].map(|x| Sample::at(vec2(x, 60.0 + 0.2 * x))).to_vec();
    let brush = Brush { size: 50.0, ..Brush::default() };
    let stroke = Stroke::new(brush, operator, Color { r: 255, g: 240, b: 200, a: 255 }, samples);
    let coverage = Arc::new(Plane::from_fn(SIZE, |x, _| x as u8));
    let layers = vec![
        with(Layer::new("pixels", pixels), |l| l.clip_to_surface = false),
        with(Layer::new("image", Content::Image(Live::new(image))), |l| l.opacity = 0.8),
        with(Layer::new("gradient", Content::Gradient(Live::new(gradient))), |l| {
            l.blend = BlendMode::SoftLight;
            l.mask = Some(LayerMask::new(MaskKind::File { file: "m.png".into(), coverage }));
        }),
        with(
            Layer::new(
                "strokes",
                Content::Strokes(Live::new(StrokeList { strokes: vec![Arc::new(stroke)] })),
            ),
            |_| {},
        ),
        with(Layer::new("scaling", Content::RadianceScaling(RadianceScaling::default())), |_| {}),
    ];
    let group =
        with(Layer::new("group", Content::Group(Group { layers, pass_through: false })), |_| {});
    Document { surface: Some(dome()), layers: vec![group], ..Document::empty(SIZE) }
}

/// Mean and largest difference of two pictures of the canvas, in steps of a byte.
fn difference(a: &TileGrid, b: &TileGrid, size: Size) -> (f64, u8) {
    let (a, b) = (a.to_straight_rgba(size.rect()), b.to_straight_rgba(size.rect()));
    let steps: Vec<u8> = a.iter().zip(&b).map(|(a, b)| a.abs_diff(*b)).collect();
    (
        steps.iter().map(|&s| f64::from(s)).sum::<f64>() / steps.len() as f64,
        steps.into_iter().max().unwrap_or(0),
    )
}

fn picture(document: &Document) -> TileGrid {
    flatten(document, &Progress::default()).unwrap()
}

fn reduce(grid: &TileGrid, factor: f32) -> TileGrid {
    CanvasScale::of(SIZE, factor).unwrap().grid(grid)
}

#[test]
fn a_preview_at_half_size_looks_like_the_full_picture_reduced() {
    let full = document();
    let half = full.scaled(0.5).unwrap();
    assert_eq!(half.size, Size::new(120, 80));
    let (mean, _) = difference(&picture(&half), &reduce(&picture(&full), 0.5), half.size);
    assert!(mean < 1.5, "mean difference {mean}");
    // The measure can fail: without scaling the lengths it is far larger.
    let wrong = Document { layers: full.layers.clone(), ..half.clone() };
    let (wrong, _) = difference(&picture(&wrong), &reduce(&picture(&full), 0.5), half.size);
    assert!(wrong > 5.0 * mean, "{wrong} is not far from {mean}");
}

#[test]
fn twice_as_large_and_reduced_again_is_the_picture() {
    let full = document();
    let double = full.scaled(2.0).unwrap();
    let (mean, _) = difference(&reduce(&picture(&double), 0.5), &picture(&full), SIZE);
    assert!(mean < 1.5, "mean difference {mean}");
}

/// A picture, a gradient and strokes bent by normals with bumps as fine as a pixel, pinned in the
/// middles of pixels.
fn bumpy() -> Document {
    let lean =
        |x: usize, y: usize, k: u32| 0.5 * (crate::math::hash::unit(x as u32, y as u32, k) - 0.5);
    let maps = Maps {
        normals: Plane::from_fn(SIZE, |x, y| vec3(lean(x, y, 1), lean(x, y, 2), 1.0)),
        depth: Plane::full(SIZE, 0.5),
        coverage: Plane::full(SIZE, 255),
    };
    let mut document = document();
    document.surface = Some(Arc::new(Surface::new(maps).unwrap()));
    let mut layers = document.layers[0].content.group().unwrap().layers.clone();
    for layer in &mut layers {
        let mut next = Layer::clone(layer);
        match &mut next.content {
            Content::Image(live) => {
                let mut image = live.params().clone();
                image.bend.anchors = vec![Anchor::pin(vec2(100.5, 70.5))];
                *live = Live::new(image);
            }
            Content::Gradient(live) => {
                let (from, to) = (vec2(50.5, 30.5), vec2(180.5, 120.5));
                *live = Live::new(Gradient { from, to, ..live.params().clone() });
            }
            _ => {}
        }
        *layer = Arc::new(next);
    }
    layers.retain(|layer| !matches!(layer.content, Content::RadianceScaling(_)));
    Document { layers, ..document }
}

#[test]
fn a_larger_picture_on_bumps_is_pinned_like_the_original() {
    let full = bumpy();
    let [two, three, four] = [2.0, 3.0, 4.0].map(|factor| {
        let larger = full.scaled(factor).unwrap();
        let back = CanvasScale::of(larger.size, 1.0 / factor).unwrap();
        difference(&back.grid(&picture(&larger)), &picture(&full), SIZE).0
    });
    // Three times as large, the middle of a pixel is one again: what is left are bumps that were
    // interpolated.
    assert!(three < 3.0 && two < 1.3 * three && four < 1.3 * three, "{two}, {three}, {four}");
}

#[test]
fn layers_keep_their_ids_and_a_factor_of_one_keeps_everything() {
    let full = document();
    let half = full.scaled(0.5).unwrap();
    let ids = |d: &Document| d.walk().iter().map(|(_, layer)| layer.id).collect::<Vec<_>>();
    assert_eq!(ids(&full), ids(&half));
    for factor in [1.0, f32::NAN, 0.0, -1.0, f32::INFINITY] {
        let same = full.scaled(factor).unwrap();
        assert!(
            same.size == full.size && Arc::ptr_eq(&same.layers[0], &full.layers[0]),
            "{factor}"
        );
    }
}

#[test]
fn weights_of_the_covered_pixels_add_up_to_one() {
    for scale in [0.3, 0.5, 0.999, 1.0, 1.7, 4.0] {
        for i in -5..50 {
            let sum: f32 = source_weights(i, scale).iter().map(|&(_, weight)| weight).sum();
            assert!((sum - 1.0).abs() < 1e-5, "{scale} {i}: {sum}");
        }
    }
    assert_eq!(source_weights(3, 0.5), [(6, 0.5), (7, 0.5)]);
    assert_eq!(source_weights(1, 2.0), [(0, 0.75), (1, 0.25)]);
}

#[test]
fn an_image_size_samples_paint_as_it_is_told_and_keeps_the_rest_live() {
    let full = document();
    let (mean, _) = difference(
        &picture(&full.resampled(Size::new(120, 80), crate::raster::Resampling::Smooth).unwrap()),
        &reduce(&picture(&full), 0.5),
        Size::new(120, 80),
    );
    assert!(mean < 2.0, "mean difference {mean}");
    let twice = full.resampled(SIZE.scaled(2.0), crate::raster::Resampling::Nearest).unwrap();
    let tiles = |document: &Document| match &document.layer_named("pixels").unwrap().content {
        Content::Pixels(pixels) => pixels.tiles.clone(),
        _ => unreachable!(),
    };
    for (x, y) in [(0, 12), (-15, 30), (100, 90)] {
        assert_eq!(tiles(&twice).pixel(2 * x + 1, 2 * y), tiles(&full).pixel(x, y));
    }
    // Another aspect: the picture is stretched, images too.
    let wide = Size::new(240, 80);
    let stretched = full.resampled(wide, crate::raster::Resampling::Smooth).unwrap();
    assert_eq!(stretched.size, wide);
    let image = stretched.layer_named("image").unwrap();
    assert!(image.transform.is_some());
    let flat = |document: &Document, only: &str| {
        let layer = document.layer_named(only).unwrap().clone();
        let alone = Layer { clip_to_surface: false, opacity: 1.0, ..Layer::clone(&layer) };
        picture(&Document {
            surface: None,
            layers: vec![Arc::new(alone)],
            ..Document::empty(document.size)
        })
    };
    let (before, after) = (flat(&full, "image"), flat(&stretched, "image"));
    let far = |x: i32, y: i32| {
        let (a, b) = (before.pixel(x, 2 * y), after.pixel(x, y));
        (0..3).map(|c| a[c].abs_diff(b[c])).max().unwrap()
    };
    let worst = [(40, 20), (120, 40), (200, 60), (70, 70)]
        .map(|(x, y)| far(x, y))
        .into_iter()
        .max()
        .unwrap();
    assert!(worst <= 8, "{worst}");
}
