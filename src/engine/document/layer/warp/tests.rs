use super::*;
use crate::document::layer::{Content, Group, LayerTransform, Live, MeshFrame};
use crate::document::{Progress, diff, flatten, flatten_layer};
use crate::math::srgb::Color;
use crate::paint::{Gradient, GradientStop, ImageFilter};

const SIZE: Size = Size::new(256, 192);

/// Rings that become finer outward: a zone plate.
fn zone_plate() -> TileGrid {
    let mut rgba = Vec::new();
    for y in 0..SIZE.height {
        for x in 0..SIZE.width {
            let r2 = (x as f32 - 128.0).powi(2) + (y as f32 - 96.0).powi(2);
            let v = (127.5 + 127.5 * (r2 * 0.004).cos()) as u8;
            rgba.extend([v, 255 - v, (x % 256) as u8, 255]);
        }
    }
    TileGrid::from_straight_rgba(&rgba, SIZE.width as usize, SIZE.height as usize, 0, 0)
}

fn paint() -> Layer {
    Layer::new(
        "paint",
        Content::Pixels(PixelLayer { tiles: zone_plate(), ..PixelLayer::default() }),
    )
}

fn ramp() -> Layer {
    let stop = |t, r| GradientStop { t, color: Color { r, g: 90, b: 200, a: 255 } };
    let content = Gradient {
        from: vec2(20.0, 20.0),
        to: vec2(230.0, 150.0),
        stops: vec![stop(0.0, 0), stop(1.0, 255)],
        operator: Default::default(),
        filter: ImageFilter::Antialias,
        frame: Default::default(),
        style: Default::default(),
        pieces: Vec::new(),
    };
    Layer::new("ramp", Content::Gradient(Live::new(content)))
}

fn document(layer: Layer) -> Document {
    Document { layers: vec![Arc::new(layer)], ..Document::empty(SIZE) }
}

fn bytes(document: &Document) -> Vec<[u8; 4]> {
    let flat = flatten(document, &Progress::default()).unwrap();
    let (w, h) = (SIZE.width as i32, SIZE.height as i32);
    (0..h).flat_map(|y| (0..w).map(move |x| (x, y))).map(|(x, y)| flat.pixel(x, y)).collect()
}

fn pixel(of: &[[u8; 4]], x: usize, y: usize) -> [u8; 4] {
    of[y * SIZE.width as usize + x]
}

fn with_mesh(layer: Layer, change: impl Fn(usize, Vec2) -> Vec2) -> Layer {
    let even = Mesh::even(4, 4, MeshFrame::of(SIZE)).unwrap();
    let points = even.points().iter().enumerate().map(|(k, p)| change(k, *p)).collect();
    let shape = TransformShape::Mesh(Arc::new(even.with_points(points).unwrap()));
    Layer { transform: Some(LayerTransform { shape, filter: Resampling::Smooth }), ..layer }
}

fn with_liquify(layer: Layer, by: impl Fn(Vec2) -> Vec2) -> Layer {
    let mut lattice = Lattice::default();
    lattice.change(Rect::new(60, 40, 190, 150), |_, q, _| by(q));
    Layer { liquify: Some(Arc::new(lattice)), ..layer }
}

/// A bump about the middle.
fn bump(q: Vec2) -> Vec2 {
    vec2(14.0, -6.0) * (1.0 - (q.distance(vec2(128.0, 96.0)) / 50.0).min(1.0)).powi(2)
}

#[test]
fn an_even_mesh_changes_no_byte_and_a_moved_one_is_the_matrix() {
    for layer in [paint, ramp] {
        let plain = document(layer());
        assert!(bytes(&document(with_mesh(layer(), |_, p| p))) == bytes(&plain));
        let moved = with_mesh(layer(), |_, p| p + vec2(12.0, -5.0));
        let shape = TransformShape::Matrix([1.0, 0.0, 0.0, 1.0, 12.0, -5.0]);
        let matrix = Layer {
            transform: Some(LayerTransform { shape, filter: Resampling::Smooth }),
            ..layer()
        };
        assert!(bytes(&document(moved)) == bytes(&document(matrix)));
    }
}

#[test]
fn where_nothing_is_displaced_no_byte_changes() {
    for layer in [paint, ramp] {
        let plain = bytes(&document(layer()));
        let found = bytes(&document(with_liquify(layer(), bump)));
        assert!(plain != found);
        for (x, y) in [(5, 5), (70, 96), (200, 100), (128, 30), (250, 180)] {
            assert_eq!(pixel(&plain, x, y), pixel(&found, x, y), "{x} {y}");
        }
    }
}

#[test]
fn a_layer_shows_at_q_what_it_showed_at_q_and_u() {
    // Moved by whole pixels over a wide middle: there each byte equals that of another pixel.
    let plain = bytes(&document(paint()));
    let found = bytes(&document(with_liquify(paint(), |_| vec2(9.0, -4.0))));
    for (x, y) in [(100, 90), (128, 96), (150, 110)] {
        assert_eq!(pixel(&found, x, y), pixel(&plain, x + 9, y - 4), "{x} {y}");
    }
    // A group shows the same, and a live layer within a byte's step.
    let group = Layer::new(
        "g",
        Content::Group(Group { layers: vec![Arc::new(paint())], pass_through: false }),
    );
    assert!(bytes(&document(with_liquify(group, |_| vec2(9.0, -4.0)))) == found);
}

#[test]
fn mesh_and_liquify_are_one_resampling() {
    // One mesh undoes what the liquify does in the middle; sampled twice, the rings would be soft.
    let moved = with_liquify(with_mesh(paint(), |_, p| p + vec2(9.0, -4.0)), |_| vec2(9.0, -4.0));
    let (plain, found) = (bytes(&document(paint())), bytes(&document(moved)));
    for (x, y) in [(100, 90), (128, 96), (150, 110)] {
        let (a, b) = (pixel(&plain, x, y), pixel(&found, x, y));
        assert!(a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 1), "{x} {y}: {a:?} {b:?}");
    }
}

#[test]
fn a_zone_plate_reduced_by_a_mesh_is_its_mean_and_no_moire() {
    // To an eighth: rings finer than a pixel, whose mean is gray.
    let bend = |k: usize, p: Vec2| {
        vec2(128.0, 96.0) + (p - vec2(128.0, 96.0)) / if k == 5 { 7.9 } else { 8.0 }
    };
    let found = bytes(&document(with_mesh(paint(), bend)));
    for (x, y) in [(116, 88), (140, 88), (116, 104), (140, 104)] {
        let [r, _, _, a] = pixel(&found, x, y);
        assert!(a == 255 && r.abs_diff(127) < 40, "{x} {y}: {r}");
    }
}

#[test]
fn only_what_may_look_different_is_redrawn() {
    for layer in [paint, ramp] {
        let before = document(with_liquify(layer(), bump));
        let grown = |q: Vec2| if q.x > 150.0 && q.y > 120.0 { vec2(3.0, 2.0) } else { bump(q) };
        let id = before.layers[0].id;
        let next = with_liquify(layer(), grown).liquify;
        let after = before.with_layer(id, |layer| layer.liquify = next).unwrap();
        let (old, new, tiles) = (bytes(&before), bytes(&after), diff(&before, &after));
        assert!(!tiles.is_empty() && !tiles.contains(&TileAt::new(0, 0)), "{tiles:?}");
        let mut is_other = false;
        for y in 0..SIZE.height as i32 {
            for x in 0..SIZE.width as i32 {
                let differs =
                    pixel(&old, x as usize, y as usize) != pixel(&new, x as usize, y as usize);
                is_other |= differs;
                assert!(!differs || tiles.contains(&TileAt::of_pixel(x, y)), "{x} {y}");
            }
        }
        assert!(is_other);
    }
}

#[test]
fn paint_in_a_displaced_group_is_redrawn_where_it_shows() {
    let group =
        |child: Layer| Content::Group(Group { layers: vec![Arc::new(child)], pass_through: true });
    let before = document(with_liquify(Layer::new("g", group(paint())), |_| vec2(40.0, 0.0)));
    let mut child = Layer::clone(&before.layers[0].content.group().unwrap().layers[0]);
    let Content::Pixels(pixels) = &mut child.content else { unreachable!() };
    pixels.tiles.set(TileAt::new(2, 1), None);
    let after =
        before.with_layer(before.layers[0].id, |layer| layer.content = group(child)).unwrap();
    let (old, new, tiles) = (bytes(&before), bytes(&after), diff(&before, &after));
    for y in 0..SIZE.height as i32 {
        for x in 0..SIZE.width as i32 {
            let differs =
                pixel(&old, x as usize, y as usize) != pixel(&new, x as usize, y as usize);
            assert!(!differs || tiles.contains(&TileAt::of_pixel(x, y)), "{x} {y}");
        }
    }
    assert!(tiles.contains(&TileAt::new(1, 1)) && !tiles.contains(&TileAt::new(0, 0)), "{tiles:?}");
}

#[test]
fn hostile_meshes_show_something_or_nothing_and_never_end_the_program() {
    let folded = |k: usize, p: Vec2| if k % 3 == 1 { vec2(256.0, 192.0) - p } else { p };
    let together = |_: usize, _: Vec2| vec2(100.0, 90.0);
    let far = |k: usize, p: Vec2| if k == 5 { vec2(9e5, -9e5) } else { p };
    for change in [&folded as &dyn Fn(usize, Vec2) -> Vec2, &together, &far] {
        for layer in [paint, ramp] {
            assert_eq!(bytes(&document(with_mesh(layer(), change))).len(), SIZE.area());
        }
    }
    let nothing = bytes(&document(with_mesh(paint(), together)));
    assert_eq!(pixel(&nothing, 20, 20), [0; 4], "all points on one: nothing is left");
}

#[test]
fn what_is_applied_looks_as_it_did_and_goes_along_with_the_canvas() {
    let before = document(with_liquify(
        with_mesh(paint(), |k, p| if k == 5 { p + vec2(9.0, 4.0) } else { p }),
        bump,
    ));
    let applied = before.with_transform_applied(before.layers[0].id).unwrap();
    assert!(!applied.layers[0].is_warped() && applied.layers[0].transform.is_none());
    assert!(bytes(&applied) == bytes(&before));
    // A quarter turn and back.
    use crate::document::CanvasChange;
    let once = before.on_other_canvas(&CanvasChange::quarter_turns(before.size, 1)).unwrap();
    assert!(once.layers[0].is_warped());
    let there = flatten_layer(&once, once.layers[0].id, &Progress::default()).unwrap();
    let here = bytes(&before);
    for (x, y) in [(100i32, 90i32), (128, 96), (150, 60), (40, 150)] {
        // Counter-clockwise: (x, y) goes to (y, w − 1 − x).
        let (a, b) =
            (pixel(&here, x as usize, y as usize), there.pixel(y, SIZE.width as i32 - 1 - x));
        assert!(a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 12), "{x} {y}: {a:?} {b:?}");
    }
    let twice = before.scaled(2.0).unwrap();
    let liquify = twice.layers[0].liquify.as_ref().unwrap();
    let (a, b) = (
        before.layers[0].liquify.as_ref().unwrap().at(vec2(128.0, 96.0)).by,
        liquify.at(vec2(256.0, 192.0)).by,
    );
    assert!((a * 2.0 - b).length() < 0.1, "{a} {b}");
}

/// Along the rim of a ball a displacement of a hundredth of a pixel leaves the rim as smooth as it
/// was.
#[test]
fn a_rim_under_a_displacement_of_nearly_nothing_looks_as_without() {
    use crate::math::vec3;
    use crate::surface::{Maps, Surface};
    let at = |x: usize, y: usize| (vec2(x as f32 + 0.5, y as f32 + 0.5) - vec2(128.0, 96.0)) / 70.0;
    let normals = Plane::from_fn(SIZE, |x, y| {
        let q = at(x, y);
        vec3(q.x, -q.y, (1.0 - q.length_squared()).max(0.0).sqrt())
            .normalize_or(crate::math::Vec3::Z)
    });
    let depth =
        Plane::from_fn(SIZE, |x, y| 1.0 - (1.0 - at(x, y).length_squared()).max(0.0).sqrt());
    let coverage = Plane::from_fn(SIZE, |x, y| if at(x, y).length() < 1.0 { 255 } else { 0 });
    let surface = Surface::new(Maps { normals, depth, coverage }).ok().map(Arc::new);
    let on_ball = |layer: Layer| Document { surface: surface.clone(), ..document(layer) };
    for layer in [paint, ramp] {
        let plain = bytes(&on_ball(layer()));
        let found = bytes(&on_ball(with_liquify(layer(), |_| vec2(1.0 / 64.0, 0.0))));
        let off = plain
            .iter()
            .zip(&found)
            .flat_map(|(a, b)| a.iter().zip(b))
            .map(|(a, b)| a.abs_diff(*b));
        assert!(off.max() <= Some(6), "{}", layer().name);
    }
}
