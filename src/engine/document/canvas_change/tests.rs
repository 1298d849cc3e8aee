use super::*;
use crate::document::parts::{Inflation, Part, PartKind};
use crate::document::{
    Content, Group, Layer, LayerMask, LayerTransform, Live, MaskKind, OutlineSource, PixelLayer,
    Progress, StrokeList, TransformShape, flatten,
};
use crate::math::{hash, srgb::Color, vec3};
use crate::paint::{Adjust, StrokeSelection, Tip};
use crate::paint::{
    Brush, Gradient, GradientStop, ImageFilter, PictureSource, PlacedImage, Placement, Sample,
    Stroke,
};
use crate::raster::{CoverageGrid, Outside, Picture, Plane, TileGrid};
use crate::shading::{Light, LightKind, Model, Shading};
use crate::shape::{Body, Primitive, Touch};
use crate::surface::plane_piece::PlanePiece;
use crate::surface::{Anchor, Bend, Maps, Operator, Surface};

const SIZE: Size = Size::new(150, 100);

pub(super) fn dome() -> Arc<Surface> {
    let at = |x: usize, y: usize| (vec2(x as f32, y as f32) + 0.5 - vec2(72.0, 51.0)) / 46.0;
    let z = |x: usize, y: usize| (1.0 - at(x, y).length_squared()).max(0.0).sqrt();
    let coverage = Plane::from_fn(SIZE, |x, y| if at(x, y).length() < 1.0 { 255 } else { 0 });
    let normals = Plane::from_fn(SIZE, |x, y| vec3(at(x, y).x, -at(x, y).y, z(x, y).max(0.01)));
    let depth = Plane::from_fn(SIZE, |x, y| 1.0 - z(x, y));
    Arc::new(Surface::new(Maps { normals, depth, coverage }).unwrap())
}

fn noise(size: Size) -> Vec<[u8; 4]> {
    let byte = |i: u32, k: u32| (hash::unit(5, i, k) * 255.0) as u8;
    (0..size.area() as u32)
        .map(|i| [byte(i, 0), byte(i, 1), byte(i, 2), 128 | byte(i, 3)])
        .collect()
}

fn waves(size: Size) -> Vec<[u8; 4]> {
    let wave =
        |i: u32, j: u32| (128.0 + 100.0 * (i as f32 * 0.06).sin() * (j as f32 * 0.05).cos()) as u8;
    (0..size.height)
        .flat_map(|y| (0..size.width).map(move |x| [wave(x, y), wave(y, x), 90, 255]))
        .collect()
}

/// Paint that reaches beyond the canvas.
pub(super) fn paint() -> Layer {
    let size = Size::new(120, 90);
    let tiles = TileGrid::from_straight_rgba(noise(size).as_flattened(), 120, 90, -20, 25);
    Layer::new("paint", Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() }))
}

pub(super) fn operator() -> Operator {
    Operator::Normal { alpha: 0.15, beta: 0.5, detail: 0.0 }
}

fn image(operator: Operator) -> Layer {
    let anchors = vec![Anchor { at: vec2(60.5, 45.5), source: vec2(55.0, 50.0) }];
    let image = PlacedImage {
        source: PictureSource::new(
            "w".into(),
            Picture::srgb8(SIZE, waves(SIZE)).unwrap(),
            Adjust::default(),
        ),
        placement: Placement { center: vec2(70.0, 52.0), scale: 1.4, rotation: 20.0 },
        outside: Outside::Mirror,
        bend: Bend { operator, anchors, ..Bend::default() },
        filter: ImageFilter::Bilinear,
        frame: PlaneMap::IDENTITY,
    };
    Layer::new("image", Content::Image(Live::new(image)))
}

pub(super) fn ramp(operator: Operator) -> Layer {
    let stops = vec![
        GradientStop { t: 0.0, color: Color::BLACK },
        GradientStop { t: 1.0, color: Color::WHITE },
    ];
    // Anchors read the pixel that holds them: on its border a turn would take them to the next, and
    // what a crop removes can no longer be read.
    let (from, to) = (vec2(45.5, 25.5), vec2(95.5, 55.5));
    let (filter, frame) = (ImageFilter::Bilinear, PlaneMap::IDENTITY);
    Layer::new(
        "ramp",
        Content::Gradient(Live::new(Gradient {
            from,
            to,
            stops,
            operator,
            filter,
            frame,
            style: Default::default(),
            pieces: Vec::new(),
        })),
    )
}

fn strokes(operator: Operator) -> Layer {
    let samples =
        [(50.5, 35.5), (70.5, 44.5), (90.5, 50.5)].map(|(x, y)| Sample::at(vec2(x, y))).to_vec();
    // A flat nib: it shows what does not turn with the canvas.
    let brush =
        Brush { size: 26.0, tip: Tip::Ellipse { ratio: 0.3 }, rotation: 30.0, ..Brush::default() };
    let mut stroke = Stroke::new(brush, operator, Color { r: 250, g: 240, b: 20, a: 255 }, samples);
    let inside = CoverageGrid::full(Rect::new(10, 20, 88, 70));
    stroke = stroke.within(Some(StrokeSelection::new(Arc::new(Selection::new(inside)))));
    Layer::new(
        "strokes",
        Content::Strokes(Live::new(StrokeList { strokes: vec![Arc::new(stroke)] })),
    )
}

fn shading() -> Layer {
    let light = |kind| Light { kind, ..Light::default() };
    let lights = vec![
        light(LightKind::Directional { direction: vec3(0.7, 0.3, 0.5) }),
        light(LightKind::Point { position: vec3(30.0, 20.0, 40.0) }),
    ];
    Layer::new("lit", Content::Shading(Live::new(Shading { lights, ..Shading::new(Model::Phong) })))
}

pub(super) fn under(layer: Layer) -> Document {
    let ground = Layer {
        clip_to_surface: false,
        ..Layer::new("ground", Content::Fill(Color { r: 40, g: 60, b: 80, a: 255 }))
    };
    Document { layers: vec![Arc::new(ground), Arc::new(layer)], ..Document::empty(SIZE) }
}

fn on_dome(layer: Layer) -> Document {
    Document { surface: Some(dome()), ..under(layer) }
}

pub(super) fn picture(document: &Document) -> Vec<u8> {
    flatten(document, &Progress::default()).unwrap().to_straight_rgba(document.size.rect())
}

/// Moves of whole pixels that hold all of the canvas, and two that do not.
fn exact() -> Vec<(&'static str, CanvasChange)> {
    let crop = |x0, y0, x1, y1| CanvasChange::crop(SIZE, Rect::new(x0, y0, x1, y1)).unwrap();
    vec![
        ("left", CanvasChange::quarter_turns(SIZE, 1)),
        ("round", CanvasChange::quarter_turns(SIZE, 2)),
        ("right", CanvasChange::quarter_turns(SIZE, -1)),
        ("mirror", CanvasChange::mirror(SIZE, CanvasMirror::LeftRight)),
        ("upside down", CanvasChange::mirror(SIZE, CanvasMirror::UpDown)),
        ("larger", crop(-7, -11, 170, 130)),
        ("crop", crop(31, 17, 101, 81)),
        ("aside", crop(40, -20, 190, 60)),
    ]
}

/// The picture after a change, from the one before; pixels that come from beyond it are left out.
fn expect_picture(before: &[u8], change: &CanvasChange) -> Vec<Option<[u8; 4]>> {
    let by = change.pixel_move().unwrap();
    let (w, h) = (change.to.width as i32, change.to.height as i32);
    let pixel = |(x, y): (i32, i32)| {
        let at = |x: i32, y: i32| (y as usize * SIZE.width as usize + x as usize) * 4;
        SIZE.rect().contains(x, y).then(|| std::array::from_fn(|c| before[at(x, y) + c]))
    };
    (0..h).flat_map(|y| (0..w).map(move |x| (x, y))).map(|(x, y)| pixel(by.source(x, y))).collect()
}

fn farthest(found: &[u8], expected: &[Option<[u8; 4]>]) -> u8 {
    let pairs = found.chunks_exact(4).zip(expected).filter_map(|(a, b)| Some((a, (*b)?)));
    pairs.flat_map(|(a, b)| (0..4).map(move |c| a[c].abs_diff(b[c]))).max().unwrap_or(0)
}

fn pixels(document: &Document) -> Vec<u8> {
    let Content::Pixels(pixels) = &document.layer_named("paint").unwrap().content else {
        unreachable!()
    };
    pixels.tiles.to_straight_rgba(Rect::new(-300, -300, 600, 600))
}

#[test]
fn paint_is_moved_turned_and_mirrored_byte_for_byte() {
    let start = under(paint());
    for (name, change) in exact() {
        let next = start.on_other_canvas(&change).unwrap();
        assert_eq!(next.size, change.size());
        assert_eq!(
            farthest(&picture(&next), &expect_picture(&picture(&start), &change)),
            0,
            "{name}"
        );
        assert!(next.layers[1].transform.is_none(), "{name}");
    }
}

#[test]
fn what_comes_round_has_the_same_bytes_beyond_the_canvas_too() {
    let start = on_dome(paint());
    let step =
        |document: &Document, change: CanvasChange| document.on_other_canvas(&change).unwrap();
    let turned =
        (0..4).fold(start.clone(), |d, _| step(&d, CanvasChange::quarter_turns(d.size, 1)));
    let mirror = |d: &Document| step(d, CanvasChange::mirror(d.size, CanvasMirror::LeftRight));
    let mirrored = mirror(&mirror(&start));
    let crop = |d: &Document, x: i32| {
        step(d, CanvasChange::crop(d.size, Rect::new(x, x, 60 + 3 * x, 50 + 3 * x)).unwrap())
    };
    let moved = step(
        &crop(&start, 7),
        CanvasChange::crop(Size::new(74, 64), Rect::new(-7, -7, 143, 93)).unwrap(),
    );
    for round in [turned, mirrored, moved] {
        assert_eq!(round.size, SIZE);
        assert!(pixels(&round) == pixels(&start));
        assert!(Arc::ptr_eq(round.surface.as_ref().unwrap(), start.surface.as_ref().unwrap()));
        assert!(picture(&round) == picture(&start));
    }
}

#[test]
fn live_layers_go_along_as_their_picture_does() {
    let flat = [image(Operator::None), ramp(Operator::None), strokes(Operator::None)].map(under);
    let bent =
        [image(operator()), ramp(operator()), strokes(operator()), shading(), paint()].map(on_dome);
    let mirror = Operator::Reflection { alpha: 0.2, detail: 0.0 };
    let more = [on_dome(image(mirror))];
    for start in flat.into_iter().chain(bent).chain(more) {
        let before = picture(&start);
        for (name, change) in exact() {
            let next = start.on_other_canvas(&change).unwrap();
            let off = farthest(&picture(&next), &expect_picture(&before, &change));
            let kind = &start.layers[1].name;
            assert!(
                off <= 2,
                "{kind} {} {name}: {off} off",
                if start.surface.is_some() { "on a ball" } else { "flat" }
            );
        }
        // The measure can fail: the same layers on the turned canvas.
        let (_, turn) = exact().remove(0);
        let stays =
            Document { layers: start.layers.clone(), ..start.on_other_canvas(&turn).unwrap() };
        assert!(farthest(&picture(&stays), &expect_picture(&before, &turn)) > 20);
    }
}

#[test]
fn a_ramp_on_a_piece_of_the_unwrapped_surface_goes_along_as_its_picture_does() {
    let on_piece = |moved| {
        let layer = ramp(Operator::Surface { amount: 1.0, smooth: 0.0 });
        let Content::Gradient(live) = &layer.content else { unreachable!() };
        let piece =
            PlanePiece { moved, scale: 0.5, rotation: 40.0, ..PlanePiece::at(vec2(60.5, 45.5)) };
        let content =
            Content::Gradient(Live::new(Gradient { pieces: vec![piece], ..live.params().clone() }));
        on_dome(Layer { content, ..layer })
    };
    let start = on_piece(vec2(9.0, -5.0));
    let before = picture(&start);
    // A crop cuts the surface, which is unwrapped anew.
    let whole = exact().into_iter().filter(|(name, _)| !["crop", "aside"].contains(name));
    for (name, change) in whole {
        let next = start.on_other_canvas(&change).unwrap();
        let off = farthest(&picture(&next), &expect_picture(&before, &change));
        assert!(off <= 2, "{name}: {off} off");
    }
    let other = picture(&on_piece(vec2(-5.0, 9.0)));
    assert!(
        farthest(&other, &before.as_chunks().0.iter().map(|p| Some(*p)).collect::<Vec<_>>()) > 20
    );
}

#[test]
fn ten_degrees_and_back_thirty_six_times_is_the_untouched_picture() {
    let start = on_dome(paint());
    let mut here = start.clone();
    for _ in 0..36 {
        here = here.on_other_canvas(&CanvasChange::turn(here.size, 10.0)).unwrap();
        assert!(here.size.width > SIZE.width && here.size.height > SIZE.height);
        here = here
            .on_other_canvas(&CanvasChange::resize(here.size, SIZE, CanvasAnchor::Center).unwrap())
            .unwrap();
        assert_eq!(here.size, SIZE);
    }
    assert!(here.layers[1].transform.is_none() && pixels(&here) == pixels(&start));
    assert!(picture(&here) == picture(&start));
    let once = start.on_other_canvas(&CanvasChange::turn(SIZE, 10.0)).unwrap();
    assert!(
        once.layers[1].transform.is_some() && pixels(&once) == pixels(&start),
        "kept as it was painted"
    );
}

#[test]
fn transforms_masks_and_groups_keep_their_places() {
    let coverage =
        Arc::new(Plane::from_fn(SIZE, |x, y| if (x / 9 + y / 7) % 3 == 0 { 40 } else { 255 }));
    let mask =
        || Some(LayerMask::new(MaskKind::File { file: String::new(), coverage: coverage.clone() }));
    let transformed = |layer: Layer, shape| Layer {
        transform: Some(LayerTransform { shape, filter: Resampling::Sharp }),
        ..layer
    };
    let skew = TransformShape::Matrix([0.8, 0.2, -0.3, 0.7, 40.0, 5.0]);
    let corners =
        [(30.0, 10.0), (120.0, 25.0), (130.0, 90.0), (20.0, 80.0)].map(|(x, y)| glam::dvec2(x, y));
    let quad = TransformShape::Quad(corners);
    let group = |layer: Layer, shape| {
        let group = Content::Group(Group { layers: vec![Arc::new(layer)], pass_through: false });
        transformed(Layer { mask: mask(), ..Layer::new("group", group) }, shape)
    };
    let masked = |layer: Layer| Layer { mask: mask(), ..layer };
    let turn =
        TransformShape::Matrix(PlaneMap::rotation(90.0, SIZE.center()).coefficients().unwrap());
    let starts = [
        transformed(paint(), skew.clone()),
        transformed(paint(), quad.clone()),
        masked(paint()),
        transformed(masked(paint()), skew.clone()),
        transformed(image(Operator::None), quad.clone()),
        transformed(masked(image(Operator::None)), skew.clone()),
        transformed(strokes(Operator::None), skew.clone()),
        group(transformed(image(Operator::None), skew.clone()), turn.clone()),
        group(transformed(paint(), quad.clone()), skew.clone()),
    ];
    for (i, start) in starts.map(under).into_iter().enumerate() {
        let before = picture(&start);
        for (name, change) in exact() {
            let next = start.on_other_canvas(&change).unwrap();
            let off = farthest(&picture(&next), &expect_picture(&before, &change));
            assert!(off <= 2, "{i} {name}: {off} off");
        }
    }
}

#[test]
fn selections_go_along_once_for_all_that_share_them() {
    let start = on_dome(strokes(operator()));
    let region = crate::surface::region::SurfaceRegion::new(Default::default(), vec2(60.5, 40.5));
    let found = Arc::new(Selection::of_region(region, &start.scene()));
    let start = Document { active_selection: Some(found.clone()), ..start }
        .with_kept_selection("face")
        .unwrap();
    let next = start.on_other_canvas(&CanvasChange::quarter_turns(SIZE, 1)).unwrap();
    let active = next.active_selection.as_ref().unwrap();
    assert!(Arc::ptr_eq(active, &next.selections[0].selection));
    assert_eq!(active.made.unwrap().at, vec2(40.5, 89.5));
    let by = CanvasChange::quarter_turns(SIZE, 1).pixel_move().unwrap();
    let differs = next.size.rect();
    let count =
        (differs.y0..differs.y1).flat_map(|y| (differs.x0..differs.x1).map(move |x| (x, y)));
    let off = count.filter(|&(x, y)| {
        let (sx, sy) = by.source(x, y);
        active.coverage.at(x, y).abs_diff(found.coverage.at(sx, sy)) > 2
    });
    assert_eq!(off.count(), 0);
    let away = CanvasChange::crop(SIZE, Rect::new(60, 60, 100, 90)).unwrap();
    let square = Arc::new(Selection::new(CoverageGrid::full(Rect::new(0, 0, 20, 20))));
    let gone = Document { active_selection: Some(square), ..start }.on_other_canvas(&away).unwrap();
    assert!(gone.active_selection.is_none(), "nothing of it is on the canvas");
}

#[test]
fn anchors_say_what_stays_in_place() {
    let corner = |anchor| {
        let change = CanvasChange::resize(Size::new(10, 10), Size::new(17, 4), anchor).unwrap();
        change.point(Vec2::ZERO)
    };
    assert_eq!(corner(CanvasAnchor::TopLeft), vec2(0.0, 0.0));
    assert_eq!(corner(CanvasAnchor::BottomRight), vec2(7.0, -6.0));
    assert_eq!(corner(CanvasAnchor::Center), vec2(3.0, -3.0));
    assert!(CanvasChange::resize(SIZE, Size::new(0, 5), CanvasAnchor::Top).is_none());
    assert!(CanvasChange::crop(SIZE, Rect::new(5, 5, 5, 9)).is_none());
    assert!(
        CanvasChange::turn(SIZE, f64::NAN).is_none() && CanvasChange::turn(SIZE, 360.0).is_none()
    );
    assert_eq!(CanvasChange::turn(SIZE, 450.0), CanvasChange::quarter_turns(SIZE, 1));
}

#[test]
fn a_canvas_without_any_of_the_shape_is_refused() {
    let start = on_dome(paint());
    let away = CanvasChange::crop(SIZE, Rect::new(0, 0, 20, 15)).unwrap();
    assert!(start.on_other_canvas(&away).err().unwrap().contains("nothing of the shape"));
    assert!(under(paint()).on_other_canvas(&away).is_ok());
}

#[test]
fn parts_keep_their_shape_wherever_the_canvas_goes() {
    let blot = |x: usize, y: usize| {
        let at = vec2(x as f32, y as f32) + 0.5 - vec2(50.0, 40.0);
        if (at / vec2(34.0, 20.0)).length() < 1.0 && !(at.x > 5.0 && at.y > 4.0) { 255 } else { 0 }
    };
    let file = crate::document::parts::CoverageFile {
        file: "o.png".into(),
        coverage: Arc::new(Plane::from_fn(SIZE, blot)),
    };
    let inflate = |outline| PartKind::Inflate { outline, inflation: Inflation::default() };
    let path = [(90.0, 20.0), (140.0, 30.0), (120.0, 70.0)].map(|(x, y)| vec2(x, y)).to_vec();
    let egg = Primitive {
        half: vec3(24.0, 12.0, 16.0),
        turn_deg: vec3(20.0, 30.0, 40.0),
        ..Primitive::new(Body::Ellipsoid, vec2(100.0, 72.0), 20.0)
    };
    let touch = Touch {
        at: vec2(40.0, 36.0),
        radius: 6.0,
        normal: vec3(0.5, 0.3, 0.8).normalize(),
        reach: 12.0,
    };
    let list = vec![
        Part {
            tilt_deg: vec2(10.0, 20.0),
            ..Part::new("blot", inflate(OutlineSource::File(file)))
        },
        Part::new("path", inflate(OutlineSource::Path(path))),
        Part::new("egg", PartKind::Primitive(egg)),
        Part::new("touch", PartKind::Touches { on: "blot".into(), touches: vec![touch] }),
    ];
    let start = under(ramp(Operator::None)).with_parts(list.into_iter().map(Arc::new).collect());
    let before = start.surface.clone().unwrap();
    for (name, change) in exact() {
        let next = start.on_other_canvas(&change).unwrap();
        let (after, by) = (next.surface.clone().unwrap(), change.pixel_move().unwrap());
        let (mut worst, mut uncovered, mut count) = (0.0f32, 0, 0);
        for y in 0..change.to.height as i32 {
            for x in 0..change.to.width as i32 {
                let (sx, sy) = by.source(x, y);
                if !SIZE.rect().contains(sx, sy) {
                    continue;
                }
                let there = (sx as usize, sy as usize);
                let (a, b) =
                    (before.coverage(there.0, there.1), after.coverage(x as usize, y as usize));
                uncovered += usize::from(a.abs_diff(b) > 3);
                if a == 255 && b == 255 && before.normal(there.0, there.1).z > 0.3 {
                    let n = before.normal(there.0, there.1);
                    let bar = change.matrix() * vec2(n.x, -n.y);
                    let expected = vec3(bar.x, -bar.y, n.z);
                    worst +=
                        expected.angle_between(after.normal(x as usize, y as usize)).to_degrees();
                    count += 1;
                }
            }
        }
        let mean = worst / count as f32;
        assert!(
            uncovered * 200 < count && mean < 0.5,
            "{name}: {uncovered} of {count} uncovered, {mean}° off"
        );
    }
}
