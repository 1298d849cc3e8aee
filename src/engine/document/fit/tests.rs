use super::*;
use crate::document::{Group, Live, PartKind, Parts, StrokeList};
use crate::math::{Vec2, Vec3, srgb::Color, vec2};
use crate::paint::{Brush, DualBrush, DualSettings, Gradient, GradientStop, Sample, Stroke};
use crate::raster::{Plane, Tile, TileAt, TileGrid};
use crate::shading::{Model, Shading};
use crate::shape::{Ball, Touch};
use crate::surface::Operator;

const SIZE: Size = Size::new(64, 64);

fn of(layers: Vec<Layer>) -> Document {
    Document { layers: layers.into_iter().map(Arc::new).collect(), ..Document::empty(SIZE) }
}

fn fill() -> Layer {
    Layer::new("Fill", Content::Fill(Color::BLACK))
}

fn strokes(brush: Brush, at: Vec2) -> Layer {
    let stroke = Stroke::new(brush, Operator::None, Color::BLACK, vec![Sample::at(at)]);
    Layer::new("Ink", Content::Strokes(Live::new(StrokeList { strokes: vec![Arc::new(stroke)] })))
}

fn says(layer: Layer, what: &str) {
    let said = of(vec![layer]).fits(None).unwrap_err();
    assert!(said.contains(what) && said.ends_with('.'), "{said}");
}

#[test]
fn what_leaves_a_range_is_refused_with_the_layers_name() {
    says(
        Layer { opacity: f32::NAN, ..fill() },
        "“Fill”: opacity is NaN; it must be between 0 and 1",
    );
    says(
        strokes(Brush { spacing: 200.0, ..Brush::default() }, Vec2::ONE),
        "“Ink”: stroke 1: the spacing is 200",
    );
    says(strokes(Brush::default(), vec2(1e7, 0.0)), "a reading of the pen is 10000000");
    says(Layer { name: "x".repeat(2000), ..fill() }, "letters of the name would be 2000");
    let shading = |change: fn(&mut Shading)| {
        let mut shading = Shading::new(Model::Phong);
        change(&mut shading);
        Layer::new("Lit", Content::Shading(Live::new(shading)))
    };
    says(
        shading(|s| s.index = 50.0),
        "“Lit”: the refractive index is 50; it must be between 0.1 and 10",
    );
    says(shading(|s| s.features.scales.clear()), "at least one scale");
    let stop = |t| GradientStop { t, color: Color::BLACK };
    let gradient = |stops| {
        let ends = (Vec2::ZERO, Vec2::ONE);
        let gradient = Gradient {
            from: ends.0,
            to: ends.1,
            stops,
            operator: Operator::None,
            filter: crate::paint::ImageFilter::Antialias,
            frame: Default::default(),
            style: Default::default(),
            pieces: Vec::new(),
        };
        Layer::new("Ramp", Content::Gradient(Live::new(gradient)))
    };
    says(gradient(vec![stop(0.5), stop(0.2)]), "the stops of the gradient must go from 0 to 1");
    says(gradient(vec![]), "at least one");
    let mask =
        MaskKind::File { file: String::new(), coverage: Arc::new(Plane::full(Size::new(2, 2), 1)) };
    says(
        Layer { mask: Some(LayerMask::new(mask)), ..fill() },
        "the mask has 2 × 2 pixels, the canvas 64 × 64",
    );
    let step = LayerMask::new(DerivedMask::Depth { from: 0.5, to: 0.5 });
    assert!(
        of(vec![Layer { mask: Some(step), ..fill() }]).fits(None).is_ok(),
        "a mask may be a step"
    );
}

#[test]
fn pixels_that_no_one_picture_holds_are_refused() {
    let dot = || Tile::from_bytes(vec![255; TILE * TILE * 4]).map(Arc::new);
    let dots = |far: i32| {
        let mut tiles = TileGrid::default();
        tiles.set(TileAt::new(0, 0), dot());
        tiles.set(TileAt::new(far, 0), dot());
        Layer::new("Dots", Content::Pixels(PixelLayer { file: String::new(), x: 0, y: 0, tiles }))
    };
    assert!(of(vec![dots(500)]).fits(None).is_ok());
    says(dots(600), "px, more than a picture can hold");
    says(dots(20_000), "a pixel's place");
}

#[test]
fn too_many_layers_groups_and_strokes_are_refused() {
    let crowd = |n: usize| of((0..n).map(|_| fill()).collect());
    assert!(crowd(2_100).fits(None).is_ok());
    assert_eq!(
        crowd(10_001).fits(None),
        Err("Layers would be 10001; at most 10000 are allowed.".into())
    );
    let nested = |n: usize| {
        let into = |inner: Layer, _| {
            Layer::new(
                "G",
                Content::Group(Group { layers: vec![Arc::new(inner)], pass_through: false }),
            )
        };
        of(vec![(0..n).fold(fill(), into)])
    };
    assert!(nested(40).fits(None).is_ok() && nested(50).fits(None).is_ok());
    assert!(nested(51).fits(None).unwrap_err().contains("Groups around a layer would be 51"));
    let stroke = Arc::new(Stroke::new(Brush::default(), Operator::None, Color::BLACK, Vec::new()));
    let list = StrokeList { strokes: vec![stroke; 100_000] };
    assert!(
        of(vec![Layer::new("Ink", Content::Strokes(Live::new(list)))])
            .fits(None)
            .unwrap_err()
            .contains("turn some into pixels")
    );
}

#[test]
fn what_was_there_before_is_no_reason_to_refuse_an_edit() {
    let old = of(vec![Layer { opacity: 7.0, ..fill() }]);
    let with = |layer: Layer| Document {
        layers: old.layers.iter().cloned().chain([Arc::new(layer)]).collect(),
        ..old.clone()
    };
    assert!(with(fill()).fits(Some(&old)).is_ok());
    assert!(with(Layer { opacity: 8.0, ..fill() }).fits(Some(&old)).is_err());
    let long = Layer { name: "x".repeat(5_000), ..fill() };
    let opened = of(vec![long]);
    let faded = opened.with_layer(opened.layers[0].id, |layer| layer.opacity = 0.5).unwrap();
    assert!(faded.fits(Some(&opened)).is_ok(), "its name came with a file");
}

#[test]
fn only_strokes_that_are_new_are_looked_at() {
    let odd = strokes(Brush { size: 1e9, ..Brush::default() }, Vec2::ONE);
    let old = of(vec![odd]);
    let id = old.layers[0].id;
    let add = |brush: Brush| {
        let stroke = Stroke::new(brush, Operator::None, Color::BLACK, vec![Sample::at(Vec2::ONE)]);
        let add = |strokes: &mut Vec<Arc<Stroke>>| {
            strokes.push(Arc::new(stroke));
            Some(())
        };
        old.with_strokes(id, add).unwrap()
    };
    assert!(add(Brush::default()).fits(Some(&old)).is_ok());
    assert!(
        add(Brush { size: 0.0, ..Brush::default() })
            .fits(Some(&old))
            .unwrap_err()
            .contains("stroke 2")
    );
    let dual = |spacing: f32| {
        let settings = DualSettings { spacing, ..DualSettings::DEFAULT };
        Brush {
            dual: Some(Arc::new(DualBrush { settings, ..Default::default() })),
            ..Brush::default()
        }
    };
    assert!(add(dual(0.5)).fits(Some(&old)).is_ok());
    for spacing in [f32::NAN, 0.0, 1e9] {
        let said = add(dual(spacing)).fits(Some(&old)).unwrap_err();
        assert!(said.contains("“Spacing” of the dual brush"), "{said}");
    }
}

#[test]
fn what_lies_on_itself_in_a_circle_or_on_no_part_is_refused_where_it_is_put_there() {
    let ball =
        PartKind::Sweep { balls: vec![Ball { at: Vec2::splat(30.0), radius: 9.0 }], puff: 1.0 };
    let on = |id: &str, on: &str| {
        Part::new(id, PartKind::Touches { on: on.into(), touches: Vec::new() })
    };
    let with = |parts: Vec<Part>| {
        let list =
            [Part::new("ball", ball.clone())].into_iter().chain(parts).map(Arc::new).collect();
        of(vec![fill()]).with_parts(list)
    };
    assert_eq!(with(vec![on("a", "ball"), on("b", "a")]).fits(None), Ok(()));
    for (parts, why) in [
        (vec![on("a", "a")], "“a” lies on itself"),
        (vec![on("a", "nose")], "“a” lies on “nose”, but there is no such part"),
        (
            vec![on("a", "b"), on("b", "a")],
            "“a” lies on “b”, which lies on no part with a form of its own",
        ),
    ] {
        let document = with(parts);
        assert_eq!(document.fits(None), Err(format!("{why}.")));
        assert!(document.note_of_astray().is_some_and(|note| note.contains(why)));
        let other =
            document.with_layer(document.layers[0].id, |layer| layer.opacity = 0.5).unwrap();
        let again = |part: &Arc<Part>| Arc::new(Part { raise: 2.0, ..Part::clone(part) });
        let other = other.with_parts(other.parts.list.iter().map(again).collect());
        assert_eq!(other.fits(Some(&document)), Ok(()), "it was opened so");
    }
    assert_eq!(with(Vec::new()).note_of_astray(), None);
}

#[test]
fn what_parts_take_of_a_description_is_counted() {
    let touch = Touch { at: Vec2::ONE, radius: 3.0, normal: Vec3::Z, reach: 0.0 };
    let kind = || PartKind::Touches { on: "ball".into(), touches: vec![touch; 20_000] };
    let ball =
        PartKind::Sweep { balls: vec![Ball { at: Vec2::splat(30.0), radius: 9.0 }], puff: 1.0 };
    let with = |n: usize| {
        let touches = (0..n).map(|i| Part { visible: false, ..Part::new(format!("t{i}"), kind()) });
        let list: Vec<Part> =
            [Part::new("ball", ball.clone())].into_iter().chain(touches).collect();
        Document { parts: Arc::new(Parts::new(list)), ..of(vec![fill()]) }
    };
    assert_eq!(with(4).fits(None), Ok(()));
    assert!(with(12).fits(None).unwrap_err().contains("parts than a file can hold: turn some"));
}
