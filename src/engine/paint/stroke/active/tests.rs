use super::*;
use crate::math::{Size, Vec2, hash, vec2, vec3};
use crate::paint::Selection;
use crate::paint::grain::{BrushGrain, GrainSpace};
use crate::paint::stroke::render_tile;
use crate::paint::tip::Noise;
use crate::paint::{
    ColorJitter, Curve, DualBrush, DualMode, DualSettings, Dynamics, Input, Property, Tip,
};
use crate::raster::{BlendMode, CoverageGrid, Plane};
use crate::surface::{Maps, Surface};
use proptest::prelude::*;

const SIZE: Size = Size::new(300, 200);

fn waves() -> Scene {
    let normals =
        Plane::from_fn(SIZE, |x, y| vec3((0.05 * x as f32).sin(), (0.07 * y as f32).cos(), 1.0));
    let depth = Plane::from_fn(SIZE, |x, _| 0.5 + 0.4 * (0.02 * x as f32).sin());
    let maps = Maps { normals, depth, coverage: Plane::full(SIZE, 255) };
    Scene { size: SIZE, surface: Some(Arc::new(Surface::new(maps).unwrap())) }
}

fn samples(seed: u32, n: u32) -> Vec<Sample> {
    let random = |i, j| hash::unit(seed, i, j);
    let (mut at, mut time_secs) = (vec2(150.0, 100.0), 0.0);
    (0..n)
        .map(|i| {
            at = (at + 60.0 * (vec2(random(i, 0), random(i, 1)) - 0.5))
                .clamp(Vec2::ZERO, vec2(299.0, 199.0));
            time_secs += 0.01 * random(i, 2);
            Sample { pressure: random(i, 3), time_secs, ..Sample::at(at) }
        })
        .collect()
}

fn brushes() -> Vec<Brush> {
    let dynamics = Dynamics::default().with(Property::Size, Input::Speed, Curve::Share(0.8));
    let grain = BrushGrain {
        size_px: 9.0,
        lies: GrainSpace::Surface { gamma: 1.0 },
        ..BrushGrain::default()
    };
    let plain = Brush { size: 34.0, dynamics, ..Brush::default() };
    // A second tip that touches tiles that the first never does, and a small one that strays.
    let wide = DualSettings { size: 3.0, spacing: 0.4, ..DualSettings::DEFAULT };
    let wide =
        DualBrush { settings: wide, tip: Tip::Square { ratio: 0.6 }, ..DualBrush::default() };
    let small = DualSettings {
        size: 0.4,
        spacing: 0.7,
        scatter: 0.8,
        flow: 0.7,
        mode: DualMode::Subtract,
        ..DualSettings::DEFAULT
    };
    let small = DualBrush {
        settings: small,
        tip: Tip::Noise(Noise::default()),
        dynamics: Dynamics::none().with(Property::Flow, Input::Pressure, Curve::Share(0.7)),
    };
    vec![
        plain.clone(),
        Brush {
            scatter: 0.6,
            jitter: ColorJitter { hue_degrees: 90.0, ..ColorJitter::default() },
            ..plain.clone()
        },
        Brush { blend: BlendMode::Multiply, opacity: 0.6, ..plain.clone() },
        Brush { erases: true, ..plain.clone() },
        Brush { dual: Some(Arc::new(wide)), ..plain.clone() },
        Brush {
            jitter: ColorJitter { hue_degrees: 90.0, ..ColorJitter::default() },
            dual: Some(Arc::new(small.clone())),
            ..plain.clone()
        },
        Brush { grain: Some(grain.clone()), dual: Some(Arc::new(small)), ..plain.clone() },
        Brush { grain: Some(grain), tip: Tip::Square { ratio: 0.4 }, ..plain },
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn a_stroke_in_hand_is_the_stroke_painted_at_once_however_its_samples_come(seed: u32, batch in 1usize..9) {
        let scene = waves();
        let operator = Operator::Normal { alpha: 0.3, beta: 1.0, detail: 0.0 };
        let red = Color::parse("#c04020").unwrap();
        let beneath = Arc::new(Stroke::new(Brush::default(), operator, red, samples(!seed, 6)));
        // Soft, with tiles that are wholly selected or not at all; every other brush respects it.
        let soft = Plane::from_fn(SIZE, |x, y| ((x as i32 - 100) * 3 + y as i32 / 4).clamp(0, 255) as u8);
        let selection = StrokeSelection::new(Arc::new(Selection::new(CoverageGrid::from_plane(&soft, 0, 0))));
        for (i, brush) in brushes().into_iter().enumerate() {
            let own = (i % 2 == 1).then(|| selection.moved(vec2(0.25 * i as f32, 0.0)));
            let color = Color::parse("#20a0e0").unwrap();
            let samples = samples(seed, 17);
            let all = samples.clone();
            let mirror = |s: &Sample| Sample { at: vec2(300.0 - s.at.x, s.at.y), ..*s };
            let mirrored: Vec<Sample> = samples.iter().map(mirror).collect();
            let like = [(); 2].map(|_| Stroke::new(brush.clone(), operator, color, Vec::new()).within(own.clone()));
            let mut stroke = ActiveStrokes::new(&like, Backdrop::Strokes(vec![beneath.clone()]), &scene);
            let mut shown: HashMap<TileAt, Option<Arc<Tile>>> = HashMap::new();
            for (batch, mirrored) in samples.chunks(batch).zip(mirrored.chunks(batch)) {
                shown.extend(stroke.draw(&[batch.to_vec(), mirrored.to_vec()]));
            }
            let made = |samples| Stroke::new(brush.clone(), operator, color, samples).within(own.clone());
            let once = [all, mirrored].map(made);
            let mut strokes = vec![beneath.clone()];
            strokes.extend(once.into_iter().map(Arc::new));
            let bounds = stroke.strokes().iter().map(|s| s.bounds(&scene)).collect::<Vec<_>>();
            let mut finished = vec![beneath.clone()];
            finished.extend(stroke.finish().into_iter().map(Arc::new));
            for at in TileAt::covering(SIZE.rect()) {
                let whole = render_tile(&strokes, &scene, at);
                let whole = whole.as_ref().map(|tile| tile.bytes());
                let again = render_tile(&finished, &scene, at);
                prop_assert_eq!(again.as_ref().map(|tile| tile.bytes()), whole, "{:?}, finished", at);
                match shown.get(&at) {
                    Some(tile) => prop_assert_eq!(tile.as_ref().map(|tile| tile.bytes()), whole, "{:?}", at),
                    None => {
                        let is_touched = strokes[1..].iter().any(|s| s.can_touch(&scene, at));
                        prop_assert!(!is_touched, "{:?} was left out", at);
                    }
                }
            }
            for (stroke, bounds) in strokes[1..].iter().zip(bounds) {
                let own = stroke.bounds(&scene);
                prop_assert_eq!(own.intersect(bounds), own, "the bounds in hand hold the stroke");
            }
        }
    }
}

#[test]
fn on_a_paint_layer_the_tiles_that_stay_as_they_are_are_left_out() {
    let scene = waves();
    let operator = Operator::Normal { alpha: 0.3, beta: 1.0, detail: 0.0 };
    let red = Color::parse("#c04020").unwrap();
    let paint = |strokes: &[Arc<Stroke>]| {
        let mut grid = TileGrid::for_rect(SIZE.rect());
        for at in TileAt::covering(SIZE.rect()) {
            let pixels = render_pixels(strokes, &scene, at);
            grid.set(at, pixels.and_then(|pixels| pixels.to_tile_over(None)).map(Arc::new));
        }
        grid
    };
    let under = Stroke::new(Brush::default(), operator, red, samples(5, 6));
    let layer = paint(&[Arc::new(under)]);
    for (i, brush) in brushes().into_iter().enumerate() {
        let like = [Stroke::new(brush.clone(), operator, red, Vec::new())];
        // At once, and sample by sample: then the end of the curve comes and goes.
        let begin = || ActiveStrokes::new(&like, Backdrop::Pixels(layer.clone()), &scene);
        let (mut many, mut few) = (begin(), begin());
        let samples = samples(11, 24);
        let (mut at_once, mut one_by_one) = (layer.clone(), layer.clone());
        let show = |shown: &mut TileGrid, tiles: Vec<(TileAt, Option<Arc<Tile>>)>| {
            tiles.into_iter().for_each(|(at, tile)| shown.set(at, tile));
        };
        show(&mut at_once, many.draw(std::slice::from_ref(&samples)));
        for sample in samples {
            show(&mut one_by_one, few.draw(&[vec![sample]]));
        }
        assert!(few.draw(&[]).is_empty(), "nothing new comes without samples");
        for at in TileAt::covering(SIZE.rect()) {
            let same = match (at_once.tile(at), one_by_one.tile(at)) {
                (Some(a), Some(b)) => a.is_same(b),
                (a, b) => a.is_none() && b.is_none(),
            };
            assert!(same, "{at:?} of brush {i}");
        }
    }
}
