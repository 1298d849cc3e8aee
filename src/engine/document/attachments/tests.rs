//! What lies on a part goes where the part goes. Not here: edits of parts and layers (`edits`).

mod edits;

use super::*;
use crate::document::{
    LayerMask, LayerSlot, MaskKind, Part, PartKind, PixelLayer, Progress, TransformShape, diff,
    flatten,
};
use crate::math::{Size, Vec2, hash, srgb::Color, vec2};
use crate::paint::{
    Brush, Gradient, GradientStop, ImageFilter, PictureSource, PlacedImage, Placement, Sample,
    Selection, StrokeSelection,
};
use crate::raster::{CoverageGrid, Outside, Picture, Plane, Resampling, TileAt, TileGrid};
use crate::shading::{Light, LightKind, Model, Shading};
use crate::shape::{Body, Primitive};
use crate::surface::{Anchor, Bend, Operator};

const SIZE: Size = Size::new(256, 192);
/// Where the body is at first: far enough from every border.
const AT: Vec2 = vec2(96.0, 80.0);
const BY: (i32, i32) = (37, 22);
const NORMAL: Operator = Operator::Normal { alpha: 0.2, beta: 1.0, detail: 0.0 };

fn ball(id: &str, at: Vec2, radius: f32) -> Part {
    Part::new(id, PartKind::Primitive(Primitive::new(Body::Sphere, at, radius)))
}

fn document(layers: Vec<Layer>) -> Document {
    let flat =
        Document { layers: layers.into_iter().map(Arc::new).collect(), ..Document::empty(SIZE) };
    flat.with_part(ball("body", AT, 48.0))
}

fn standing(document: &Document, id: &str, matrix: Affine2) -> Document {
    let part = document.parts.part(id).unwrap();
    document.with_part(Part { matrix, ..Part::clone(part) })
}

fn shifted(document: &Document, by: (i32, i32)) -> Document {
    standing(document, "body", Affine2::from_translation(vec2(by.0 as f32, by.1 as f32)))
}

fn picture(document: &Document) -> Vec<u8> {
    flatten(document, &Progress::default()).unwrap().to_straight_rgba(SIZE.rect())
}

fn pixel(picture: &[u8], x: i32, y: i32) -> [u8; 4] {
    let start = (y * SIZE.width as i32 + x) as usize * 4;
    picture[start..start + 4].try_into().unwrap()
}

fn strokes(name: &str, samples: &[Vec2], operator: Operator) -> Layer {
    let samples = samples.iter().map(|at| Sample::at(*at)).collect();
    let stroke =
        Stroke::new(Brush { size: 22.0, ..Brush::default() }, operator, Color::BLACK, samples);
    Layer::new(name, Content::Strokes(Live::new(StrokeList { strokes: vec![Arc::new(stroke)] })))
}

fn paint() -> Layer {
    let rgba: Vec<u8> = (0..90 * 70 * 4u32).map(|i| hash::mix(i) as u8 | 3).collect();
    let tiles = TileGrid::from_straight_rgba(&rgba, 90, 70, 52, 44);
    Layer::new("paint", Content::Pixels(PixelLayer { tiles, ..PixelLayer::default() }))
}

fn image() -> Layer {
    let texel = |i: u32| [(hash::unit(1, i, 0) * 256.0) as u8, (i % 256) as u8, 90, 255];
    let picture = Picture::srgb8(SIZE, (0..SIZE.area() as u32).map(texel).collect()).unwrap();
    let image = PlacedImage {
        source: PictureSource::new("p.png".into(), picture, Default::default()),
        placement: Placement::covering(SIZE),
        outside: Outside::Mirror,
        bend: Bend {
            operator: NORMAL,
            anchors: vec![Anchor::pin(AT + vec2(0.5, 0.5))],
            ..Bend::default()
        },
        filter: ImageFilter::Bilinear,
        frame: PlaneMap::IDENTITY,
    };
    Layer::new("image", Content::Image(Live::new(image)))
}

fn gradient() -> Layer {
    let stops = [(0.0, Color::BLACK), (1.0, Color::WHITE)]
        .map(|(t, color)| GradientStop { t, color })
        .to_vec();
    let (filter, frame) = (ImageFilter::Antialias, PlaneMap::IDENTITY);
    let (from, to) = (AT - vec2(40.0, 20.0), AT + vec2(44.0, 12.0));
    Layer::new(
        "ramp",
        Content::Gradient(Live::new(Gradient {
            from,
            to,
            stops,
            operator: NORMAL,
            filter,
            frame,
            style: Default::default(),
            pieces: Vec::new(),
        })),
    )
}

fn shading_layer() -> Layer {
    let position = AT.extend(60.0) + crate::math::vec3(20.0, -30.0, 0.0);
    let light = Light { kind: LightKind::Point { position }, ..Light::default() };
    let shading = Shading { lights: vec![light], ..Shading::new(Model::Phong) };
    Layer::new("light", Content::Shading(Live::new(shading)))
}

fn masked(layer: Layer) -> Layer {
    let coverage =
        Plane::from_fn(SIZE, |x, y| if (x / 8 + y / 8) % 2 == 0 { 255 } else { (x % 256) as u8 });
    let kind = MaskKind::File { file: String::new(), coverage: Arc::new(coverage) };
    Layer { mask: Some(LayerMask::new(kind)), ..layer }
}

fn on_body(layer: Layer) -> Layer {
    Layer { on: Some(Attachment::on("body")), ..layer }
}

fn path() -> [Vec2; 3] {
    [AT + vec2(-29.5, -9.5), AT + vec2(4.5, 12.5), AT + vec2(33.5, -6.5)]
}

/// How far two pictures differ if the second shows the first moved: the greatest difference of any
/// byte and the number of different pixels, first where the surface is whole, then on contours.
fn picture_difference(before: &Document, after: &Document, by: (i32, i32)) -> [(u8, usize); 2] {
    let (old, new) = (picture(before), picture(after));
    let contours: std::collections::BTreeSet<(i32, i32)> = match &before.surface {
        Some(surface) => surface.contours().pixels().iter().map(|p| (p.x, p.y)).collect(),
        None => Default::default(),
    };
    let (w, h) = (SIZE.width as i32, SIZE.height as i32);
    let mut out = [(0, 0); 2];
    for (x, y) in (0..h - by.1).flat_map(|y| (0..w - by.0).map(move |x| (x, y))) {
        let (a, b) = (pixel(&old, x, y), pixel(&new, x + by.0, y + by.1));
        // Premultiplied: nearly transparent pixels may have any color.
        let seen = |p: [u8; 4], c: usize| {
            if c == 3 { p[3] } else { (u16::from(p[c]) * u16::from(p[3]) / 255) as u8 }
        };
        let off = (0..4).map(|c| seen(a, c).abs_diff(seen(b, c))).max().unwrap();
        let (most, count) = &mut out[usize::from(contours.contains(&(x, y)))];
        (*most, *count) = ((*most).max(off), *count + usize::from(off > 0));
    }
    out
}

fn assert_moved(
    before: &Document,
    after: &Document,
    by: (i32, i32),
    name: &str,
    wrong: &mut Vec<String>,
) {
    let found = picture_difference(before, after, by);
    // Round tips are computed eight pixels of a tile at a time, no more precisely than a byte
    // shows.
    let most = if name.contains("strokes") && by.0 % 64 != 0 { (1, 200) } else { (0, 0) };
    // Few pixels of a tile show what is behind a contour.
    if found[0].0 > most.0 || found[0].1 > most.1 || found[1].0 > 4 {
        wrong.push(format!("{name}: {found:?}"));
    }
}

#[test]
fn a_part_moved_by_whole_pixels_gives_the_picture_moved_byte_for_byte() {
    let kinds = [
        strokes("strokes", &path(), NORMAL),
        strokes("flat strokes", &path(), Operator::None),
        paint(),
        image(),
        gradient(),
        shading_layer(),
        masked(gradient()),
        masked(Layer::new("fill", Content::Fill(Color { r: 200, g: 30, b: 40, a: 255 }))),
    ];
    let mut wrong = Vec::new();
    for layer in kinds {
        let name = layer.name.clone();
        let before = document(vec![on_body(layer)]);
        assert!(picture(&before).iter().any(|byte| *byte > 0), "{name} shows");
        assert_moved(&before, &shifted(&before, BY), BY, &name, &mut wrong);
        // After a move by whole tiles everything is the same, also pictures with smoothed pixels.
        let smoothed = before.with_layer(before.layers[0].id, |layer| {
            if let Content::Image(live) = &layer.content {
                let image = PlacedImage { filter: ImageFilter::Antialias, ..live.params().clone() };
                layer.content = Content::Image(Live::new(image));
            }
        });
        let smoothed = smoothed.unwrap();
        assert_moved(
            &smoothed,
            &shifted(&smoothed, (64, 0)),
            (64, 0),
            &format!("{name} by a tile"),
            &mut wrong,
        );
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

#[test]
fn what_is_on_the_canvas_stays_there_and_what_is_turned_with_a_part_bends_anew() {
    let stays = document(vec![strokes("strokes", &path(), Operator::None)]);
    let turn = |degrees: f32| {
        Affine2::from_translation(AT)
            * Affine2::from_angle(degrees.to_radians())
            * Affine2::from_translation(-AT)
    };
    let moved = standing(&stays, "body", Affine2::from_scale(vec2(1.0, 1.0)));
    assert!(picture(&stays) == picture(&moved));
    // A ball turned about its middle is the same ball: only its paint turns.
    let painted = document(vec![on_body(strokes("strokes", &path(), NORMAL))]);
    let turned = standing(&painted, "body", turn(90.0));
    let (old, new) = (picture(&painted), picture(&turned));
    let off = |x: i32, y: i32| {
        let (dx, dy) = (x - AT.x as i32, y - AT.y as i32);
        let to = (AT.x as i32 - dy - 1, AT.y as i32 + dx);
        let (a, b) = (pixel(&old, x, y)[3], pixel(&new, to.0, to.1)[3]);
        a.abs_diff(b)
    };
    let places = (40..130).flat_map(|y| (50..140).map(move |x| (x, y)));
    let (most, x, y) = places.map(|(x, y)| (off(x, y), x, y)).max().unwrap();
    assert!(most <= 12, "{most} off at {x}, {y}");
    assert!(old != new);
}

#[test]
fn painting_where_a_part_was_moved_to_stays_carried_and_comes_back() {
    let mut wrong = Vec::new();
    for layer in [
        paint(),
        strokes("strokes", &path(), NORMAL),
        image(),
        gradient(),
        shading_layer(),
        masked(paint()),
    ] {
        let name = layer.name.clone();
        let before = document(vec![on_body(layer)]);
        let id = before.layers[0].id;
        assert!(
            Arc::ptr_eq(&before.with_transform_applied(id).unwrap().layers[0], &before.layers[0]),
            "{name}"
        );
        let moved = shifted(&before, BY);
        let in_place = moved.with_transform_applied(id).unwrap();
        assert!(in_place.map_of(id).unwrap().is_none(), "{name}: its frame is the canvas");
        assert!(picture(&in_place) == picture(&moved), "{name} shows what it showed");
        // What a tool paints on the canvas now.
        let dotted = match &in_place.layers[0].content {
            Content::Strokes(_) => {
                let dot = Sample::at(AT + vec2(BY.0 as f32, BY.1 as f32 + 20.0));
                let dot = Stroke::new(
                    Brush { size: 14.0, ..Brush::default() },
                    NORMAL,
                    Color::BLACK,
                    vec![dot],
                );
                in_place.with_strokes(id, |strokes| {
                    strokes.push(Arc::new(dot));
                    Some(())
                })
            }
            _ => Some(in_place.clone()),
        }
        .unwrap();
        let again = dotted.with_transform_applied(id).unwrap();
        assert!(
            Arc::ptr_eq(&again.layers[0], &dotted.layers[0]),
            "{name}: nothing is sampled twice"
        );
        let back = shifted(&dotted, (0, 0));
        assert_moved(&back, &dotted, BY, &name, &mut wrong);
        if !matches!(back.layers[0].content, Content::Strokes(_)) && back.layers[0].mask.is_none() {
            assert_moved(&before, &back, (0, 0), &format!("{name} come back"), &mut wrong);
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

#[test]
fn paint_that_a_part_carried_beyond_the_canvas_comes_back_with_it() {
    let before = document(vec![on_body(paint())]);
    let id = before.layers[0].id;
    let away = shifted(&before, (-200, -30)).with_transform_applied(id).unwrap();
    assert!(picture(&shifted(&away, (0, 0))) == picture(&before));
}

#[test]
fn a_stroke_with_its_own_attachment_moves_with_it_and_its_neighbors_stay() {
    let other = ball("eye", vec2(180.0, 60.0), 20.0);
    let flat = strokes("strokes", &[vec2(160.0, 140.0), vec2(220.0, 150.0)], Operator::None);
    let both = document(vec![flat]).with_part(other);
    let id = both.layers[0].id;
    let eye = [vec2(170.0, 60.0), vec2(190.0, 62.5)].map(Sample::at).to_vec();
    let selection = Selection::new(CoverageGrid::full(crate::math::Rect::new(150, 40, 186, 90)));
    let eye =
        Stroke::new(Brush { size: 10.0, ..Brush::default() }, Operator::None, Color::WHITE, eye)
            .within(Some(StrokeSelection::new(Arc::new(selection))));
    let with_eye = both.with_strokes(id, |strokes| {
        strokes.push(Arc::new(eye));
        Some(())
    });
    let attachment = with_eye.unwrap().with_strokes_on(id, &[1], Some("eye")).unwrap();
    let by = Affine2::from_translation(vec2(-50.0, 30.0));
    let moved = standing(&attachment, "eye", by);
    let (old, new) = (picture(&attachment), picture(&moved));
    for (x, y) in (30..90).flat_map(|y| (150..210).map(move |x| (x, y))) {
        assert_eq!(pixel(&old, x, y), pixel(&new, x - 50, y + 30), "{x}, {y}");
    }
    assert_eq!(pixel(&old, 190, 145), pixel(&new, 190, 145));
    assert!(
        Arc::ptr_eq(&moved.strokes(id)[0], &attachment.strokes(id)[0]),
        "only the stroke on the eye is another"
    );
    // Tools see every stroke where it shows; it is carried from there.
    let shown = moved.with_transform_applied(id).unwrap();
    assert!(picture(&shown) == new);
    assert_eq!(shown.strokes(id)[1].samples()[0].at, vec2(120.0, 90.0));
    assert!(picture(&standing(&shown, "eye", Affine2::IDENTITY)) == old);
    // On another attachment of the layer it shows where it showed.
    let on_both = shown.with_layer_on(id, Some("body")).unwrap();
    assert!(picture(&on_both) == new);
    let off = moved.with_strokes_on(id, &[1], None).unwrap();
    assert!(picture(&off) == new && off.strokes(id)[1].attachment().is_none());
    let gone = moved.without_part("eye").unwrap();
    assert!(gone.strokes(id)[1].attachment().is_none() && gone.fits(None) == Ok(()));
    assert_eq!(gone.strokes(id)[1].samples()[0].at, vec2(120.0, 90.0));
}

#[test]
fn of_a_layer_in_a_group_the_innermost_attachment_counts() {
    let turn = Affine2::from_angle(0.3);
    let shift = |x: f64, y: f64| {
        let shape = TransformShape::Matrix([1.0, 0.0, 0.0, 1.0, x, y]);
        Some(LayerTransform { shape, filter: Resampling::default() })
    };
    let inner = Layer { on: Some(Attachment::on("eye")), transform: shift(3.0, 4.0), ..paint() };
    let group = Group { layers: vec![Arc::new(inner), Arc::new(gradient())], pass_through: false };
    let group =
        Layer { transform: shift(10.0, 0.0), ..on_body(Layer::new("g", Content::Group(group))) };
    let flat = document(vec![group]).with_part(ball("eye", vec2(180.0, 60.0), 20.0));
    let moved =
        standing(&standing(&flat, "eye", Affine2::from_translation(vec2(5.0, 6.0))), "body", turn);
    let ids: Vec<LayerId> = moved.walk().iter().map(|(_, layer)| layer.id).collect();
    // Its own transform, its part, the group's transform; the group's part carries only what has no
    // other.
    assert_eq!(moved.map_of(ids[0]).unwrap().point(vec2(100.0, 50.0)), vec2(118.0, 60.0));
    let turned = turn.transform_point2(vec2(110.0, 50.0));
    assert!(moved.map_of(ids[1]).unwrap().point(vec2(100.0, 50.0)).distance(turned) < 1e-3);
    assert_eq!(moved.attachment_of(ids[1]).unwrap().part(), Some("body"));
    // Taken to the canvas each shows what it showed, and is still carried.
    for id in ids {
        let applied = moved.with_transform_applied(id).unwrap();
        assert!(applied.map_of(id).unwrap().is_none());
        let off = picture(&applied)
            .iter()
            .zip(picture(&moved))
            .map(|(a, b)| a.abs_diff(b))
            .max()
            .unwrap();
        assert!(off <= 2, "{off} off");
        let back = standing(&applied, "body", Affine2::IDENTITY);
        let was = standing(&moved, "body", Affine2::IDENTITY);
        let (a, b) = (back.map_of(id).unwrap(), was.map_of(id).unwrap());
        let known = moved.map_of(id).unwrap();
        for p in [vec2(20.0, 30.0), vec2(200.0, 90.0)] {
            assert!(a.point(known.point(p)).distance(b.point(p)) < 1e-2, "carried as before");
        }
    }
}

#[test]
fn a_deleted_part_leaves_what_was_on_it_where_it_shows() {
    let turned = Affine2::from_scale_angle_translation(vec2(1.2, 0.9), 0.4, vec2(20.0, -10.0));
    let before =
        standing(&document(vec![on_body(paint()), on_body(masked(gradient()))]), "body", turned);
    let plain = Document { surface: None, ..before.clone() };
    let after = before.without_part("body").unwrap();
    assert!(after.parts.is_empty() && after.surface.is_none() && after.fits(None) == Ok(()));
    assert!(after.layers.iter().all(|layer| layer.on.is_none() && layer.transform.is_some()));
    assert!(picture(&after) == picture(&plain));
    assert!(before.without_part("none").is_none());
}

#[test]
fn a_layer_that_is_put_on_a_part_shows_where_it_showed_and_goes_with_it_from_there() {
    let before = shifted(&document(vec![paint()]), BY);
    let id = before.layers[0].id;
    let on = before.with_layer_on(id, Some("body")).unwrap();
    assert!(picture(&on) == picture(&before));
    assert_eq!(on.attachment_of(id).unwrap().part(), Some("body"));
    let back = picture(&shifted(&on, (0, 0)));
    for (x, y) in (80..110).flat_map(|y| (100..130).map(move |x| (x, y))) {
        assert_eq!(pixel(&back, x - BY.0, y - BY.1)[..3], pixel(&picture_of(&before), x, y)[..3]);
    }
    assert!(before.with_layer_on(id, Some("none")).is_none());
    let off = on.with_layer_on(id, None).unwrap();
    assert!(off.layers[0].on.is_none() && off.layers[0].transform.is_none());
}

fn picture_of(document: &Document) -> Vec<u8> {
    let bare = Document { surface: None, ..document.clone() };
    picture(&bare)
}
