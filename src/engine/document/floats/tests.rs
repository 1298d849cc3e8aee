//! Composing in floats: as fine as the layers are, and equal to the picture of bytes before it is
//! rounded.

use super::super::prepare::PreparedDocument;
use super::*;
use crate::document::{Content, Group, Layer, Live, StrokeList, flatten};
use crate::document::{flatten_rounding_once, flatten_to_floats, flatten_to_paint};
use crate::math::srgb::{self, Color};
use crate::math::{Size, Vec2, hash, vec2, vec3};
use crate::paint::{
    Adjust, Brush, Gradient, GradientStop, ImageFilter, PictureSource, PlacedImage, Placement,
    Sample,
};
use crate::paint::{Stroke, stroke};
use crate::raster::{BlendMode, Outside, Picture, Plane};
use crate::shading::{Model, RadianceScaling, Shading};
use crate::surface::{Anchor, Bend, Maps, Operator, Surface};
use std::collections::BTreeSet;

const BENT: Operator = Operator::Normal { alpha: 0.3, beta: 1.0, detail: 0.0 };

fn document(size: Size, layers: Vec<Layer>) -> Document {
    Document { layers: layers.into_iter().map(Arc::new).collect(), ..Document::empty(size) }
}

fn gradient(from: Vec2, to: Vec2, operator: Operator) -> Layer {
    let stop = |t, color| GradientStop { t, color };
    let stops = vec![stop(0.0, Color::BLACK), stop(1.0, Color::WHITE)];
    let filter = ImageFilter::Antialias;
    let gradient = Gradient {
        from,
        to,
        stops,
        operator,
        filter,
        frame: Default::default(),
        style: Default::default(),
        pieces: Vec::new(),
    };
    Layer::new("gradient", Content::Gradient(Live::new(gradient)))
}

fn image(picture: Picture, size: Size, operator: Operator) -> Layer {
    let image = PlacedImage {
        source: PictureSource::new("a.png".into(), picture, Adjust::default()),
        placement: Placement::covering(size),
        outside: Outside::Mirror,
        bend: Bend { operator, anchors: vec![Anchor::pin(size.center())], ..Bend::default() },
        filter: ImageFilter::Antialias,
        frame: Default::default(),
    };
    Layer::new("image", Content::Image(Live::new(image)))
}

fn strokes(n: u32) -> Layer {
    let brush = Brush { size: 40.0, hardness: 0.3, flow: 0.4, ..Brush::default() };
    let one = |i: u32| {
        let at = |j: u32| vec2(140.0 * hash::unit(i, j, 0), 120.0 * hash::unit(i, j, 1));
        let color = Color { r: 40 * i as u8, g: 200, b: 90, a: 255 };
        Arc::new(Stroke::new(
            brush.clone(),
            BENT,
            color,
            (0..4).map(|j| Sample::at(at(j))).collect(),
        ))
    };
    Layer::new(
        "strokes",
        Content::Strokes(Live::new(StrokeList { strokes: (0..n).map(one).collect() })),
    )
}

/// A ball before another before nothing: contours of both kinds.
fn balls(size: Size) -> Arc<Surface> {
    let ball = |x: usize, y: usize, c: Vec2, r: f32| {
        let p = (vec2(x as f32 + 0.5, y as f32 + 0.5) - c) / r;
        (p.length_squared() < 1.0).then(|| vec3(p.x, -p.y, (1.0 - p.length_squared()).sqrt()))
    };
    let seen = move |x: usize, y: usize| {
        let (near, far) = (ball(x, y, vec2(50.3, 60.1), 38.0), ball(x, y, vec2(84.0, 54.0), 40.0));
        near.map(|n| (n, 0.3 - 0.2 * n.z)).or(far.map(|n| (n, 0.9 - 0.2 * n.z)))
    };
    let maps = Maps {
        normals: Plane::from_fn(size, |x, y| seen(x, y).map_or(vec3(0.0, 0.0, 1.0), |(n, _)| n)),
        depth: Plane::from_fn(size, |x, y| seen(x, y).map_or(1.0, |(_, z)| z)),
        coverage: Plane::from_fn(size, |x, y| if seen(x, y).is_some() { 255 } else { 0 }),
    };
    Arc::new(Surface::new(maps).unwrap())
}

fn levels(values: impl Iterator<Item = f32>) -> usize {
    values.map(f32::to_bits).collect::<BTreeSet<u32>>().len()
}

#[test]
fn a_gradient_of_4096_pixels_has_4096_levels() {
    let size = Size::new(4096, 2);
    let picture = document(size, vec![gradient(vec2(0.0, 1.0), vec2(4096.0, 1.0), Operator::None)]);
    let floats = flatten_to_floats(&picture, Highlights::Clipped, &Progress::default()).unwrap();
    let found = levels(floats[..4096].iter().map(|p| (p[0] * 65535.0).round()));
    assert!(found >= 4090, "{found} levels of 16 bits");
}

#[test]
fn every_kind_of_layer_is_the_picture_of_bytes_before_it_is_rounded() {
    let size = Size::new(140, 120);
    let texels = (0..140 * 120).map(|i: u32| [(i % 140) as u8, (i / 140) as u8, 90, 255]).collect();
    let picture = Picture::srgb8(size, texels).unwrap();
    let lit = Layer::new("lit", Content::Shading(Live::new(Shading::new(Model::Phong))));
    let scaling = Layer::new("scaling", Content::RadianceScaling(RadianceScaling::default()));
    let multiplied = |mut layer: Layer| {
        (layer.blend, layer.opacity) = (BlendMode::Multiply, 0.6);
        layer
    };
    let clipped = |mut layer: Layer| {
        layer.clip_below = true;
        layer
    };
    let group = Group { layers: vec![Arc::new(strokes(3))], pass_through: false };
    let layers = [
        Layer::new("ground", Content::Fill(Color { r: 90, g: 120, b: 30, a: 255 })),
        image(picture, size, BENT),
        multiplied(gradient(vec2(10.0, 20.0), vec2(120.0, 100.0), BENT)),
        lit,
        clipped(strokes(4)),
        Layer::new("group", Content::Group(group)),
        scaling,
    ];
    let surface = Some(balls(size));
    for n in 1..=layers.len() {
        let part = layers[..n].to_vec();
        let document = Document { surface: surface.clone(), ..document(size, part) };
        let bytes = flatten(&document, &Progress::default()).unwrap();
        let floats =
            flatten_to_floats(&document, Highlights::Clipped, &Progress::default()).unwrap();
        let apart = |(i, float): (usize, &[f32; 4])| {
            let byte = bytes.pixel(i as i32 % 140, i as i32 / 140);
            byte.iter()
                .zip(float)
                .map(|(b, f)| (f32::from(*b) - f * 255.0).abs())
                .fold(0.0, f32::max)
        };
        let farthest = floats.iter().enumerate().map(apart).fold(0.0, f32::max);
        // Layers of bytes are rounded one by one; scaling multiplies the error.
        assert!(
            farthest < if n == layers.len() { 3.0 } else { 2.5 },
            "{n} layers: {farthest} of 255"
        );
    }
}

#[test]
fn a_picture_that_is_rounded_once_is_the_one_of_floats_whatever_the_blend_mode() {
    let size = Size::new(256, 64);
    let stop = |t, r, g, b, a| GradientStop { t, color: Color { r, g, b, a } };
    let ramp = |from: Vec2, to: Vec2, stops: [GradientStop; 2], blend: BlendMode| {
        let filter = ImageFilter::Antialias;
        let (operator, frame, pieces) = (Operator::None, Default::default(), Vec::new());
        let bent = Gradient::new(from, to, &[]).with_operator(operator);
        let gradient = Gradient { stops: stops.to_vec(), filter, frame, pieces, ..bent };
        Layer { blend, ..Layer::new("ramp", Content::Gradient(Live::new(gradient))) }
    };
    let mut farthest_of_bytes = 0.0f32;
    for (mode, name) in BlendMode::ALL {
        let below = ramp(
            vec2(0.0, 0.0),
            vec2(256.0, 10.0),
            [stop(0.0, 20, 90, 60, 255), stop(1.0, 60, 40, 200, 90)],
            BlendMode::Normal,
        );
        let above = ramp(
            vec2(0.0, 64.0),
            vec2(30.0, 0.0),
            [stop(0.0, 250, 200, 30, 40), stop(1.0, 40, 80, 90, 255)],
            mode,
        );
        let document = document(size, vec![below, above]);
        let floats =
            flatten_to_floats(&document, Highlights::Clipped, &Progress::default()).unwrap();
        let apart = |bytes: crate::raster::TileGrid| {
            let of_pixel = |(i, float): (usize, &[f32; 4])| {
                let byte = bytes.pixel(i as i32 % 256, i as i32 / 256);
                byte.iter()
                    .zip(float)
                    .map(|(b, f)| (f32::from(*b) - f * 255.0).abs())
                    .fold(0.0, f32::max)
            };
            floats.iter().enumerate().map(of_pixel).fold(0.0, f32::max)
        };
        let once = apart(flatten_rounding_once(&document, &Progress::default()).unwrap());
        let by_layer = apart(flatten(&document, &Progress::default()).unwrap());
        let least = if mode.is_steep() { 0.501 } else { 2.0 };
        assert!(once <= least, "{name}: {once} of 255, and {by_layer} with bytes between");
        farthest_of_bytes = farthest_of_bytes.max(by_layer);
    }
    assert!(farthest_of_bytes > 4.0, "bytes between show: {farthest_of_bytes}");
}

#[test]
fn light_beyond_white_stays_in_files_of_light_alone() {
    let size = Size::new(64, 64);
    let sun = Picture::linear(size, vec![[9.0, 2.0, 0.5, 1.0]; 64 * 64]).unwrap();
    let mut veil = Layer::new("veil", Content::Fill(Color::BLACK));
    veil.opacity = 0.5;
    let shown = |layers: Vec<Layer>, highlights| {
        flatten_to_floats(&document(size, layers), highlights, &Progress::default()).unwrap()[70]
    };
    let bright = shown(vec![image(sun.clone(), size, Operator::None)], Highlights::Kept);
    assert!((srgb::decode(bright[0]) - 9.0).abs() < 1e-3, "{bright:?}");
    let veiled =
        shown(vec![image(sun.clone(), size, Operator::None), veil.clone()], Highlights::Kept);
    assert!((veiled[0] - bright[0] / 2.0).abs() < 1e-6, "{veiled:?}");
    let clipped = shown(vec![image(sun, size, Operator::None), veil], Highlights::Clipped);
    assert_eq!(clipped[0], 0.5);
}

#[test]
fn tiles_rendered_together_are_taken_and_those_of_other_places_are_rendered() {
    let size = Size::new(140, 120);
    let document = Document { surface: Some(balls(size)), ..document(size, vec![strokes(5)]) };
    let prepared = PreparedDocument::new(&document, &Progress::default()).unwrap();
    let mut floats = FloatTiles::new(&prepared, Highlights::Clipped);
    let node = &prepared.stack[0];
    let list = document.strokes(node.layer.id).to_vec();
    let (known, other) = (TileAt::new(0, 0), TileAt::new(1, 1));
    let mut red = PlanarTile::transparent();
    red.rows_mut()[3].set(4, [1.0, 0.0, 0.0, 1.0]);
    floats.together.insert(TileKey::of(node, known, &node.scene), Some(red));
    let pixel = |at, x: usize, y: usize| match floats.content(
        node,
        node.layer.content.marks().unwrap(),
        at,
        None,
    ) {
        TileContent::Group(tile) => tile.rows()[y].pixel(x),
        _ => panic!("pixels"),
    };
    assert_eq!(pixel(known, 4, 3), [1.0, 0.0, 0.0, 1.0]);
    let rendered = stroke::render_pixels(&list, &node.scene, other).unwrap();
    assert_eq!(pixel(other, 20, 9), rendered.rows()[9].pixel(20));
}

#[test]
fn textures_of_floats_are_held_while_tiles_are_composed() {
    let size = Size::new(64, 64);
    let picture = Picture::srgb8(size, vec![[50; 4]; 64 * 64]).unwrap();
    let document = document(size, vec![image(picture, size, Operator::None), strokes(1)]);
    let prepared = PreparedDocument::new(&document, &Progress::default()).unwrap();
    assert_eq!(FloatTiles::new(&prepared, Highlights::Kept).texture_count(), 1);
}

#[test]
fn a_placed_picture_of_more_than_8_bits_becomes_paint_of_16_even_if_nothing_is_smooth() {
    let size = Size::new(100, 70);
    let value = |i: usize, c: u32| (hash::unit(i as u32, c, 4) * 65536.0) as u16;
    let texels: Vec<[u16; 4]> =
        (0..size.area()).map(|i| [value(i, 0), value(i, 1), value(i, 2), 65535]).collect();
    let bytes =
        Picture::srgb8(size, texels.iter().map(|t| t.map(|v| (v / 257) as u8)).collect()).unwrap();
    let light = texels.iter().map(|t| t.map(|v| srgb::decode(f32::from(v) / 65535.0))).collect();
    let wide = Picture::srgb16(size, texels.clone()).unwrap();
    for (picture, is_16_bit) in
        [(wide, true), (Picture::linear(size, light).unwrap(), true), (bytes.clone(), false)]
    {
        // One is in a group and clipped, as a layer may be.
        let alone = image(picture, size, Operator::None);
        let clipped = Layer { clip_below: true, ..alone.clone() };
        let base = image(bytes.clone(), size, Operator::None);
        let group = Group { layers: vec![base.into(), clipped.into()], pass_through: false };
        let grouped = Layer::new("group", Content::Group(group));
        assert_eq!(is_kept_in_16_bits(grouped, size), is_16_bit);
        let tiles = flatten_to_paint(&document(size, vec![alone]), &Progress::default()).unwrap();
        assert_eq!(tiles.is_16_bit_in(size.rect()), is_16_bit);
        let found = tiles.to_straight16(size.rect());
        let apart = found
            .iter()
            .zip(&texels)
            .flat_map(|(a, b)| a.iter().zip(b))
            .map(|(a, b)| a.abs_diff(*b))
            .max();
        assert!(!is_16_bit || apart <= Some(1), "{apart:?}");
    }
}

fn is_kept_in_16_bits(layer: Layer, size: Size) -> bool {
    let tiles = flatten_to_paint(&document(size, vec![layer]), &Progress::default()).unwrap();
    tiles.is_16_bit_in(size.rect())
}
