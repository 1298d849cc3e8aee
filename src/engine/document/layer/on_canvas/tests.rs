use super::*;
use crate::document::layer::{LayerTransform, Live, PixelLayer, StrokeList, TransformShape};
use crate::document::{Document, Progress, diff, flatten};
use crate::math::{PlaneMap, Size, Vec2, hash, srgb::Color, vec2, vec3};
use crate::paint::{
    Brush, Gradient, GradientStop, ImageFilter, PictureSource, PlacedImage, Placement, Sample,
    Stroke,
};
use crate::raster::{Outside, Picture, Plane, Resampling, TileAt, TileGrid};
use crate::surface::{Anchor, Bend, Maps, Operator, Surface};

const SIZE: Size = Size::new(192, 128);

fn document(layers: Vec<Layer>) -> Document {
    Document { layers: layers.into_iter().map(Arc::new).collect(), ..Document::empty(SIZE) }
}

fn with(layer: Layer, shape: TransformShape) -> Layer {
    Layer { transform: Some(LayerTransform { shape, filter: Resampling::Sharp }), ..layer }
}

fn picture(document: &Document) -> Vec<u8> {
    flatten(document, &Progress::default()).unwrap().to_straight_rgba(SIZE.rect())
}

fn paint() -> Layer {
    let byte = |i: u32| (hash::unit(4, i, 1) * 256.0) as u8;
    let rgba: Vec<u8> = (0..100 * 60 * 4).map(|i| if i % 4 == 3 { 255 } else { byte(i) }).collect();
    let tiles = TileGrid::from_straight_rgba(&rgba, 100, 60, 30, 20);
    Layer::new("paint", Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() }))
}

fn stroke(samples: &[Vec2], size: f32) -> Layer {
    let samples = samples.iter().map(|at| Sample::at(*at)).collect();
    let brush = Brush { size, ..Brush::default() };
    let stroke = Stroke::new(brush, Operator::None, Color::BLACK, samples);
    Layer::new(
        "strokes",
        Content::Strokes(Live::new(StrokeList { strokes: vec![Arc::new(stroke)] })),
    )
}

fn image(bend: Bend) -> Layer {
    let texel = |i: u32| [(hash::unit(1, i, 0) * 256.0) as u8, (i % 192) as u8, 90, 255];
    let picture = Picture::srgb8(SIZE, (0..SIZE.area() as u32).map(texel).collect()).unwrap();
    let source = PictureSource::new("p.png".into(), picture, Default::default());
    let placement = Placement::covering(SIZE);
    let (outside, filter) = (Outside::None, ImageFilter::Bilinear);
    let frame = PlaneMap::IDENTITY;
    Layer::new(
        "image",
        Content::Image(Live::new(PlacedImage { source, placement, outside, bend, filter, frame })),
    )
}

fn rotation(degrees: f64) -> TransformShape {
    TransformShape::Matrix(PlaneMap::rotation(degrees, SIZE.center()).coefficients().unwrap())
}

fn farthest(a: &[u8], b: &[u8]) -> u8 {
    a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
}

#[test]
fn turns_that_add_up_to_none_give_the_untouched_picture() {
    let group = |layer: Layer, degrees| {
        let group = Group { layers: vec![Arc::new(layer)], pass_through: false };
        with(Layer::new("g", Content::Group(group)), rotation(degrees))
    };
    let ten = (0..10).fold(paint(), |layer, _| group(layer, 36.0));
    assert!(picture(&document(vec![ten])) == picture(&document(vec![paint()])));
    let one = group(paint(), 36.0);
    assert!(picture(&document(vec![one])) != picture(&document(vec![paint()])));
}

#[test]
fn a_group_takes_along_paint_strokes_and_images_as_each_alone_would_go() {
    let shape = TransformShape::Matrix([0.8, 0.3, -0.25, 0.9, 20.0, -10.0]);
    for layer in
        [paint(), stroke(&[vec2(40.0, 40.0), vec2(150.0, 90.0)], 20.0), image(Bend::default())]
    {
        let alone = picture(&document(vec![with(layer.clone(), shape.clone())]));
        let group = Group { layers: vec![Arc::new(layer)], pass_through: true };
        let group = Layer {
            transform: Some(LayerTransform { shape: shape.clone(), filter: Resampling::Sharp }),
            ..Layer::new("g", Content::Group(group))
        };
        // The group's filter is used for layers without a transform of their own.
        let off = farthest(&picture(&document(vec![group])), &alone);
        assert_eq!(off, 0);
    }
}

#[test]
fn a_stroke_layer_is_painted_with_its_samples_taken_along() {
    let map = PlaneMap::affine([0.0, 1.5, -1.5, 0.0, 170.0, 10.0]).unwrap();
    let path = [vec2(20.0, 30.0), vec2(60.0, 50.0), vec2(50.0, 90.0)];
    let shape = TransformShape::Matrix(map.coefficients().unwrap());
    let taken: Vec<Vec2> = path.iter().map(|p| map.to_canvas(*p).unwrap()).collect();
    let (seen, painted) = (with(stroke(&path, 12.0), shape), stroke(&taken, 18.0));
    assert!(farthest(&picture(&document(vec![seen])), &picture(&document(vec![painted]))) <= 1);
}

#[test]
fn an_image_turned_by_a_quarter_is_its_pixels_turned() {
    let map = PlaneMap::rotation(90.0, vec2(64.0, 64.0));
    let shape = TransformShape::Matrix(map.coefficients().unwrap());
    let (plain, seen) =
        (picture(&document(vec![image(Bend::default())])), with(image(Bend::default()), shape));
    let turned = picture(&document(vec![seen]));
    let at = |bytes: &[u8], x: usize, y: usize| bytes[(y * 192 + x) * 4..][..4].to_vec();
    for (x, y) in [(3, 5), (100, 60), (40, 120)] {
        assert_eq!(at(&turned, y, 127 - x), at(&plain, x, y), "{x}, {y}");
    }
}

#[test]
fn a_gradient_and_a_bent_image_follow_their_frame() {
    // On a curved surface the anchor stays where it was put.
    let size = SIZE;
    let normals =
        Plane::from_fn(size, |x, _| vec3(0.4 * (x as f32 * 0.05).sin(), 0.0, 1.0).normalize());
    let maps = Maps { normals, depth: Plane::full(size, 0.5), coverage: Plane::full(size, 255) };
    let surface = Some(Arc::new(Surface::new(maps).unwrap()));
    let bend = Bend {
        operator: Operator::Normal { alpha: 0.3, beta: 1.0, detail: 0.0 },
        anchors: vec![Anchor::pin(vec2(60.5, 40.5))],
        ..Bend::default()
    };
    let shift = TransformShape::Matrix([1.0, 0.0, 0.0, 1.0, 30.0, 12.0]);
    let seen =
        Document { surface: surface.clone(), ..document(vec![with(image(bend.clone()), shift)]) };
    let (before, after) = (Document { surface, ..document(vec![image(bend)]) }, picture(&seen));
    let before = picture(&before);
    let at = |bytes: &[u8], x: usize, y: usize| bytes[(y * 192 + x) * 4..][..4].to_vec();
    assert_eq!(
        at(&after, 90, 52),
        at(&before, 60, 40),
        "what the anchor holds is where the anchor went"
    );

    let stops = [(0.0, Color::BLACK), (1.0, Color::WHITE)]
        .map(|(t, color)| GradientStop { t, color })
        .to_vec();
    let ramp = |from, to| {
        let (operator, filter, frame) =
            (Operator::None, ImageFilter::Antialias, PlaneMap::IDENTITY);
        let gradient = Gradient {
            from,
            to,
            stops: stops.clone(),
            operator,
            filter,
            frame,
            style: Default::default(),
            pieces: Vec::new(),
        };
        Layer::new("ramp", Content::Gradient(Live::new(gradient)))
    };
    let turned = with(ramp(vec2(46.0, 64.0), vec2(146.0, 64.0)), rotation(90.0));
    let upright = ramp(vec2(96.0, 114.0), vec2(96.0, 14.0));
    assert!(farthest(&picture(&document(vec![turned])), &picture(&document(vec![upright]))) <= 1);
}

#[test]
fn in_a_perspective_every_kind_stays_finite_and_within_its_quad() {
    let corners =
        [(40.0, 10.0), (150.0, 30.0), (170.0, 110.0), (20.0, 90.0)].map(|(x, y)| glam::dvec2(x, y));
    for layer in
        [paint(), stroke(&[vec2(10.0, 10.0), vec2(180.0, 120.0)], 9.0), image(Bend::default())]
    {
        let seen = picture(&document(vec![with(layer, TransformShape::Quad(corners))]));
        let alpha = |x: usize, y: usize| seen[(y * 192 + x) * 4 + 3];
        assert!((0..128).any(|y| (0..192).any(|x| alpha(x, y) > 200)));
        assert_eq!((alpha(2, 2), alpha(189, 3), alpha(3, 125)), (0, 0, 0));
    }
}

#[test]
fn masks_go_along_and_what_an_edit_changes_is_reported() {
    let coverage = Arc::new(Plane::from_fn(SIZE, |x, _| if x < 96 { 255 } else { 0 }));
    let mask = LayerMask::new(MaskKind::File { file: String::new(), coverage });
    let masked = Layer { mask: Some(mask), ..image(Bend::default()) };
    let shift = |dx: f64| TransformShape::Matrix([1.0, 0.0, 0.0, 1.0, dx, 0.0]);
    let alpha = |document: &Document, x: usize| picture(document)[(60 * 192 + x) * 4 + 3];
    let seen = document(vec![with(masked, shift(40.0))]);
    assert_eq!(
        (alpha(&seen, 39), alpha(&seen, 41), alpha(&seen, 135), alpha(&seen, 137)),
        (0, 255, 255, 0)
    );

    let old = document(vec![with(paint(), shift(20.5)), image(Bend::default())]);
    let id = old.layers[0].id;
    let edits = [
        old.with_layer(id, |layer| layer.transform.as_mut().unwrap().shape = shift(60.0)).unwrap(),
        old.with_layer(id, |layer| layer.transform = None).unwrap(),
        old.with_layer(old.layers[1].id, |layer| {
            layer.transform = with(layer.clone(), rotation(20.0)).transform
        })
        .unwrap(),
    ];
    for new in edits {
        let (before, after) =
            [&old, &new].map(|d| flatten(d, &Progress::default()).unwrap()).into();
        let told = diff(&old, &new);
        let differs =
            |at: &TileAt| before.tile(*at).map(|t| t.bytes()) != after.tile(*at).map(|t| t.bytes());
        let missed: Vec<TileAt> =
            TileAt::covering(SIZE.rect()).filter(differs).filter(|at| !told.contains(at)).collect();
        assert!(missed.is_empty(), "{missed:?}");
    }
}

#[test]
fn paint_on_a_transformed_layer_is_sampled_again_only_where_it_changed() {
    let layer = Arc::new(with(paint(), TransformShape::Matrix([1.0, 0.0, 0.0, 1.0, 0.5, 0.5])));
    let map = LayerMap::none(SIZE);
    let tiles = |layer: &Arc<Layer>| match &on_canvas(layer, &map).content {
        Content::Pixels(pixels) => pixels.tiles.clone(),
        _ => unreachable!(),
    };
    let before = tiles(&layer);
    let mut next = Layer::clone(&layer);
    if let Content::Pixels(pixels) = &mut next.content {
        pixels.tiles.set(TileAt::new(0, 0), None);
    }
    let after = tiles(&Arc::new(next));
    let same = |at: TileAt| match (before.tile(at), after.tile(at)) {
        (Some(a), Some(b)) => Arc::ptr_eq(a, b),
        (a, b) => a.is_none() && b.is_none(),
    };
    assert!(!same(TileAt::new(0, 0)) && same(TileAt::new(2, 1)));
    assert!(Arc::ptr_eq(
        before.tile(TileAt::new(1, 0)).unwrap(),
        tiles(&layer).tile(TileAt::new(1, 0)).unwrap()
    ));
}

#[test]
fn a_transform_keeps_its_place_on_a_canvas_of_another_size() {
    let layer = with(
        stroke(&[vec2(40.0, 40.0), vec2(120.0, 70.0)], 16.0),
        TransformShape::Matrix([0.5, 0.2, -0.2, 0.5, 30.0, 9.0]),
    );
    let twice = document(vec![layer.clone()]).scaled(2.0).unwrap();
    let LayerTransform { shape: TransformShape::Matrix(m), .. } =
        twice.layers[0].transform.clone().unwrap()
    else {
        unreachable!()
    };
    assert_eq!(m, [0.5, 0.2, -0.2, 0.5, 60.0, 18.0]);
}

#[test]
fn an_applied_transform_shows_what_it_showed() {
    let shape = TransformShape::Matrix(
        PlaneMap::rotation(25.0, SIZE.center())
            .then(&PlaneMap::affine([0.8, 0.0, 0.0, 0.8, 20.0, 5.0]).unwrap())
            .coefficients()
            .unwrap(),
    );
    let stops = [(0.0, Color::BLACK), (1.0, Color::WHITE)]
        .map(|(t, color)| GradientStop { t, color })
        .to_vec();
    let (operator, filter, frame) = (Operator::None, ImageFilter::Antialias, PlaneMap::IDENTITY);
    let gradient = Gradient {
        from: vec2(40.0, 60.0),
        to: vec2(150.0, 70.0),
        stops,
        operator,
        filter,
        frame,
        style: Default::default(),
        pieces: Vec::new(),
    };
    let ramp = Layer::new("ramp", Content::Gradient(Live::new(gradient)));
    let strokes = stroke(&[vec2(30.0, 40.0), vec2(160.0, 90.0)], 14.0);
    for layer in [paint(), strokes, image(Bend::default()), ramp] {
        let id = layer.id;
        let group =
            Group { layers: vec![Arc::new(with(layer, shape.clone()))], pass_through: false };
        let group = with(
            Layer::new("g", Content::Group(group)),
            TransformShape::Matrix([1.0, 0.0, 0.0, 1.0, 9.0, 4.0]),
        );
        let before = document(vec![group]);
        let after = before.with_transform_applied(id).unwrap();
        assert!(after.map_of(id).unwrap().is_none(), "its frame is the canvas");
        assert!(after.layers[0].transform.is_none());
        let off = farthest(&picture(&before), &picture(&after));
        assert!(off <= 2, "{off} off: {}", before.layer(id).unwrap().name);
    }
}

#[test]
fn a_skewed_image_keeps_its_transform() {
    let skewed =
        with(image(Bend::default()), TransformShape::Matrix([1.0, 0.0, 0.4, 1.0, 0.0, 0.0]));
    let before = document(vec![skewed]);
    let after = before.with_transform_applied(before.layers[0].id).unwrap();
    assert_eq!(after.layers[0].transform, before.layers[0].transform);
}
