//! Dabs from samples, compared with hand-computed positions and inputs.

use super::walk::MAX_STEPS;
use super::*;
use crate::math::vec2;
use crate::math::{Size, vec3};
use crate::paint::brush_options::{Bearing, Cycle, Offset, Rate, StylusFilter};
use crate::paint::{ColorJitter, Curve, Dynamics, Input, Property, Tip};
use crate::raster::Plane;
use crate::surface::{Maps, Surface};
use proptest::prelude::*;
use std::f32::consts::TAU;
use std::sync::Arc;

fn flat() -> Scene {
    Scene { size: Size::new(1000, 500), surface: None }
}

fn dabs(brush: &Brush, samples: &[Sample]) -> Vec<Dab> {
    super::dabs(brush, Operator::None, Color::BLACK, samples, &flat())
}

fn brush(size: f32) -> Brush {
    Brush { size, spacing: 0.25, ..Brush::default() }
}

fn line(n: usize) -> Vec<Sample> {
    (0..n)
        .map(|i| Sample::at(vec2(10.0, 20.0).lerp(vec2(110.0, 95.0), i as f32 / (n - 1) as f32)))
        .collect()
}

#[test]
fn dabs_stand_a_share_of_their_diameter_apart() {
    let dabs = dabs(&brush(20.0), &line(2));
    assert_eq!(dabs.len(), 26, "125 px in steps of 5, and the first");
    for pair in dabs.windows(2) {
        assert!((pair[0].at.distance(pair[1].at) - 5.0).abs() < 1e-3);
    }
    assert_eq!(dabs[0].at, vec2(10.0, 20.0));
    assert_eq!(dabs[0].radius, 10.0);
}

#[test]
fn dabs_do_not_depend_on_how_densely_a_line_was_sampled() {
    let (few, many) = (dabs(&brush(20.0), &line(2)), dabs(&brush(20.0), &line(1234)));
    assert!(few.len().abs_diff(many.len()) <= 1, "{} and {}", few.len(), many.len());
    for (a, b) in few.iter().zip(&many) {
        assert!(a.at.distance(b.at) < 0.01, "{} and {}", a.at, b.at);
    }
}

#[test]
fn a_circle_sampled_at_twelve_points_stays_round() {
    let on_circle = |i: usize| {
        vec2(200.0, 200.0) + 100.0 * Vec2::from_angle(i as f32 * std::f32::consts::PI / 6.0)
    };
    let samples: Vec<Sample> = (0..14).map(|i| Sample::at(on_circle(i))).collect();
    // Away from its ends, where the curve has no next sample.
    for dab in dabs(&brush(10.0), &samples).iter().filter(|d| d.at.distance(on_circle(0)) > 60.0) {
        let radius = dab.at.distance(vec2(200.0, 200.0));
        assert!((radius - 100.0).abs() < 0.25, "{radius}");
    }
}

#[test]
fn the_curve_passes_through_every_sample() {
    let samples: Vec<Sample> = [(0.0, 0.0), (30.0, 5.0), (32.0, 40.0), (90.0, 41.0)]
        .map(|(x, y)| Sample::at(vec2(x, y)))
        .into();
    let dabs = dabs(&Brush { size: 1.0, ..brush(1.0) }, &samples);
    for s in &samples {
        assert!(dabs.iter().any(|d| d.at.distance(s.at) < 0.3), "{}", s.at);
    }
}

#[test]
fn one_sample_and_many_at_one_place_leave_one_dab() {
    let one = dabs(&brush(20.0), &[Sample::at(vec2(5.0, 5.0))]);
    assert_eq!(one.len(), 1);
    let pressed: Vec<Sample> =
        [0.2, 0.9, 0.4].map(|pressure| Sample { pressure, ..Sample::at(vec2(5.0, 5.0)) }).into();
    let dabs = dabs(&brush(20.0), &pressed);
    assert_eq!((dabs.len(), dabs[0].flow), (1, 0.9));
}

#[test]
fn pressure_drives_what_the_dynamics_say() {
    let dynamics = Dynamics::default().with_pressure(Property::Size, 0.5);
    let brush = Brush { dynamics, ..brush(20.0) };
    let dab = dabs(&brush, &[Sample { pressure: 0.5, ..Sample::at(Vec2::ONE) }])[0];
    assert_eq!((dab.radius, dab.flow), (7.5, 0.5));
    let none = dabs(&brush, &[Sample { pressure: 0.0, ..Sample::at(Vec2::ONE) }]);
    assert!(none.is_empty(), "without pressure nothing flows");
}

#[test]
fn hostile_samples_are_dropped_and_hostile_brushes_paint_nothing() {
    let mut samples = line(5);
    let clean = dabs(&brush(20.0), &samples);
    for (i, bad) in [f32::NAN, f32::INFINITY, -1e30].into_iter().enumerate() {
        samples.insert(2 * i, Sample::at(vec2(bad, 3.0)));
        samples.push(Sample { pressure: f32::NAN, ..Sample::at(vec2(3.0, 3.0)) });
    }
    assert_eq!(dabs(&brush(20.0), &samples), clean);
    for size in [f32::NAN, f32::INFINITY, 0.0, -5.0] {
        assert!(dabs(&brush(size), &line(3)).is_empty(), "{size}");
    }
    let ends = [Sample::at(vec2(-9e5, 0.0)), Sample::at(vec2(9e5, 0.0))];
    assert!(
        dabs(&Brush { spacing: f32::NAN, ..brush(1.0) }, &ends).len() <= MAX_STEPS as usize + 1
    );
}

/// A slope to the right, its depth and normal known, hollow along a groove at x = 500.
fn slope() -> Scene {
    let size = Size::new(1000, 500);
    let nz = 0.8f32;
    let normals = Plane::from_fn(size, |_, _| vec3(0.6, 0.0, nz));
    let depth = Plane::from_fn(size, |x, _| x as f32 / 999.0);
    let coverage = Plane::from_fn(size, |_, y| if y < 400 { 255 } else { 0 });
    Scene {
        size,
        surface: Some(Arc::new(Surface::new(Maps { normals, depth, coverage }).unwrap())),
    }
}

fn timed_samples(points: &[(f32, f32, f32)]) -> Vec<Sample> {
    points.iter().map(|&(x, y, time_secs)| Sample { time_secs, ..Sample::at(vec2(x, y)) }).collect()
}

fn walk_driven(property: Property, input: Input, scene: &Scene, samples: &[Sample]) -> Vec<Dab> {
    let dynamics = Dynamics::none().with(property, input, Curve::Share(1.0));
    let brush = Brush { dynamics, ..brush(20.0) };
    super::dabs(
        &brush,
        Operator::Normal { alpha: 0.8, beta: 1.0, detail: 0.5 },
        Color::BLACK,
        samples,
        scene,
    )
}

#[test]
fn every_input_reads_what_it_says() {
    let up = timed_samples(&[(500.0, 450.0, 0.0), (500.0, 350.0, 0.1), (500.0, 250.0, 0.2)]);
    let flow = |input, scene: &Scene| walk_driven(Property::Flow, input, scene, &up);
    // 1000 px/s of 2 · 1000.
    assert!(flow(Input::Speed, &flat()).iter().all(|dab| (dab.flow - 0.5).abs() < 1e-4));
    assert!(flow(Input::Direction, &flat()).iter().all(|dab| (dab.flow - 0.25).abs() < 1e-4));
    // The first is at distance 0 and invisible; the next is a quarter of a diameter farther, of
    // ten.
    let distances: Vec<f32> =
        flow(Input::Distance, &flat()).iter().map(|dab| dab.flow).take(3).collect();
    assert!(
        distances.iter().zip([0.025, 0.05, 0.075]).all(|(a, b)| (a - b).abs() < 1e-4),
        "{distances:?}"
    );
    let slopes = flow(Input::Slope, &slope());
    assert!(
        slopes.iter().all(|dab| (dab.flow - 0.2).abs() < 1e-5 && dab.at.y < 400.0),
        "unseen off the surface"
    );
    for dab in flow(Input::Depth, &slope()) {
        let expected = if dab.at.y < 400.0 { 500.0 / 999.0 } else { 1.0 };
        assert!((dab.flow - expected).abs() < 2e-3, "{}: {}", dab.at, dab.flow);
    }
    let leaning = [Sample { tilt: vec2(0.0, 45.0), ..Sample::at(vec2(9.0, 9.0)) }];
    assert_eq!(walk_driven(Property::Flow, Input::Tilt, &flat(), &leaning)[0].flow, 0.5);
    assert_eq!(
        walk_driven(Property::Flow, Input::TiltDirection, &flat(), &leaning)[0].flow,
        0.75,
        "it leans down"
    );
    let random: Vec<f32> = flow(Input::Random, &flat()).iter().map(|dab| dab.flow).collect();
    let mean = random.iter().sum::<f32>() / random.len() as f32;
    assert!((mean - 0.5).abs() < 0.15 && random[0] != random[1], "{mean}");
}

#[test]
fn every_property_follows_what_drives_it() {
    let pressed = [Sample { pressure: 0.25, ..Sample::at(vec2(40.0, 40.0)) }];
    let dab = |property| walk_driven(property, Input::Pressure, &flat(), &pressed)[0];
    let plain = dab(Property::Spacing);
    assert_eq!((plain.radius, plain.hardness, plain.ceiling), (10.0, 0.5, 1.0));
    assert_eq!(dab(Property::Size).radius, 2.5);
    assert_eq!(dab(Property::Opacity).ceiling, 0.25);
    assert_eq!(dab(Property::Flow).flow, 0.25);
    assert_eq!(dab(Property::Hardness).hardness, 0.125);
    assert_eq!(dab(Property::Rotation).rotation_rad, TAU / 4.0);
    assert_eq!(
        dab(Property::Alpha).operator,
        Operator::Normal { alpha: 0.2, beta: 1.0, detail: 0.5 }
    );
    assert_eq!(
        dab(Property::Detail).operator,
        Operator::Normal { alpha: 0.8, beta: 1.0, detail: 0.125 }
    );
    let line = [(10.0, 10.0), (60.0, 10.0)]
        .map(|(x, y)| Sample { pressure: 0.5, ..Sample::at(vec2(x, y)) });
    let close = walk_driven(Property::Spacing, Input::Pressure, &flat(), &line);
    assert!((close[1].at.x - close[0].at.x - 2.5).abs() < 1e-4, "half of a quarter of 20 px");
    let depth = Dynamics::none().with(Property::Gamma, Input::Pressure, Curve::Share(1.0));
    let brush = Brush { dynamics: depth, ..brush(20.0) };
    let bent = super::dabs(&brush, Operator::Depth { gamma: 2.0 }, Color::BLACK, &pressed, &flat());
    assert_eq!(bent[0].operator, Operator::Depth { gamma: 0.5 });
}

#[test]
fn hollows_read_low_and_ridges_high() {
    let size = Size::new(320, 64);
    // Waves: x = 40 is a ridge's top (normals diverge), x = 80 a groove's.
    let normals =
        Plane::from_fn(size, |x, _| vec3(-(0.05 * (x as f32 + 0.5) * TAU / 4.0).cos(), 0.0, 1.0));
    let maps = Maps { normals, depth: Plane::full(size, 0.5), coverage: Plane::full(size, 255) };
    let scene = Scene { size, surface: Some(Arc::new(Surface::new(maps).unwrap())) };
    let at = |x: f32| {
        walk_driven(Property::Flow, Input::Curvature, &scene, &[Sample::at(vec2(x, 32.0))])[0].flow
    };
    // The slope −n̄/n_z turns at 0.0785 per px there, s is 10 px: κ = tanh(0.785), less a little
    // for the blur.
    let (low, high) = [at(60.0), at(100.0), at(140.0)]
        .iter()
        .fold((1.0f32, 0.0f32), |(l, h), &v| (l.min(v), h.max(v)));
    assert!((high - (0.5 + 0.5 * 0.785f32.tanh())).abs() < 0.01, "{high}");
    assert!((low - (0.5 - 0.5 * 0.785f32.tanh())).abs() < 0.01, "{low}");
}

#[test]
fn scattered_dabs_stay_within_their_reach_and_fill_it() {
    let brush = Brush { scatter: 2.0, spacing: 0.05, ..brush(20.0) };
    let (scattered, straight) =
        (dabs(&brush, &line(2)), dabs(&Brush { scatter: 0.0, ..brush.clone() }, &line(2)));
    let off: Vec<Vec2> = scattered.iter().zip(&straight).map(|(a, b)| a.at - b.at).collect();
    assert!(off.iter().all(|v| v.length() <= 40.0) && off.iter().any(|v| v.length() > 35.0));
    let mean = off.iter().sum::<Vec2>() / off.len() as f32;
    assert!(mean.length() < 8.0, "{mean}");
    assert_eq!(scattered, dabs(&brush, &line(2)), "the same samples lay the same dabs");
    assert_ne!(scattered, dabs(&Brush { seed: 1, ..brush }, &line(2)));
}

#[test]
fn colors_vary_only_where_the_brush_says() {
    let brush =
        Brush { jitter: ColorJitter { value: 0.3, ..ColorJitter::default() }, ..brush(20.0) };
    let lay = |brush: &Brush| {
        super::dabs(brush, Operator::None, Color::parse("#808080").unwrap(), &line(2), &flat())
    };
    let values: Vec<u8> = lay(&brush).iter().map(|dab| dab.color.r).collect();
    assert!(values.iter().all(|v| (51..=205).contains(v)) && values[0] != values[1], "{values:?}");
    assert!(
        lay(&Brush { jitter: ColorJitter::default(), ..brush })
            .iter()
            .all(|dab| dab.color.r == 128)
    );
}

#[test]
fn time_that_runs_backward_and_clocks_that_stand_still_do_no_harm() {
    let good = timed_samples(&[(0.0, 0.0, 0.0), (50.0, 0.0, 0.1), (100.0, 0.0, 0.2)]);
    let mut bad = good.clone();
    bad.insert(2, Sample { time_secs: 0.05, ..Sample::at(vec2(70.0, 300.0)) });
    bad.insert(1, Sample { time_secs: f32::NAN, ..Sample::at(vec2(20.0, 300.0)) });
    assert_eq!(dabs(&brush(20.0), &bad), dabs(&brush(20.0), &good));
    let still = walk_driven(
        Property::Flow,
        Input::Speed,
        &flat(),
        &timed_samples(&[(0.0, 0.0, 1.0), (50.0, 0.0, 1.0)]),
    );
    assert!(still.is_empty(), "without time there is no speed");
}

proptest! {
    #[test]
    fn dabs_come_out_the_same_however_the_samples_come_in(
        points in prop::collection::vec((-50.0f32..300.0, -50.0f32..300.0, 0.0f32..1.0, 0.0f32..0.02), 0..24),
        cuts in prop::collection::vec(0usize..24, 0..6),
    ) {
        let mut time_secs = 0.0;
        let samples: Vec<Sample> = points.iter().map(|&(x, y, pressure, dt)| {
            time_secs += dt;
            Sample { pressure, time_secs, ..Sample::at(vec2(x, y)) }
        }).collect();
        let dynamics = Dynamics::default().with(Property::Size, Input::Speed, Curve::Share(0.9));
        let brush = Brush { scatter: 0.5, dynamics, ..brush(17.0) };
        let whole = dabs(&brush, &samples);
        let mut walker = DabWalker::new(&brush, Operator::None, Color::BLACK, &flat());
        let mut laid = Vec::new();
        for (i, sample) in samples.iter().enumerate() {
            walker.push(sample, &mut laid);
            prop_assert_eq!(&laid[..], &whole[..laid.len()], "settled dabs never change");
            if cuts.contains(&i) {
                let mut shown = laid.clone();
                shown.extend(walker.tail());
                prop_assert_eq!(shown, dabs(&brush, &samples[..=i]), "what is shown is what painting at once gives");
            }
        }
        laid.extend(walker.tail());
        prop_assert_eq!(laid, whole);
    }
}

fn additive(points: &[(f32, f32)]) -> Curve {
    Curve::additive(points.iter().map(|&(x, y)| vec2(x, y)).collect()).unwrap()
}

/// To the right, 100 px a second.
fn steady(px: usize) -> Vec<Sample> {
    (0..=px / 10)
        .map(|i| Sample {
            time_secs: 0.1 * i as f32,
            ..Sample::at(vec2(100.0 + 10.0 * i as f32, 200.0))
        })
        .collect()
}

#[test]
fn dabs_of_a_flat_tip_stand_apart_as_it_is_wide_along_the_stroke() {
    let flat_tip = |rotation| Brush { tip: Tip::Ellipse { ratio: 0.2 }, rotation, ..brush(20.0) };
    // Lengthwise a quarter of 20 px, broadside a quarter of 4.
    for (rotation, step) in [(0.0, 5.0), (90.0, 1.0)] {
        let dabs = dabs(&flat_tip(rotation), &steady(100));
        assert!(
            dabs.windows(2).all(|pair| (pair[0].at.distance(pair[1].at) - step).abs() < 1e-2),
            "{rotation}"
        );
    }
}

#[test]
fn dabs_follow_the_clock_on_the_way_and_at_rest() {
    let rate = Rate { per_diameter: 0.0, per_sec: 10.0 };
    let brush = Brush { spacing: 100.0, rate, ..brush(20.0) };
    let mut samples = steady(100);
    assert_eq!(dabs(&brush, &samples).len(), 11, "a second of ten, and the first");
    let rested = Sample { time_secs: 2.0, ..samples[10] };
    samples.push(rested);
    let all = dabs(&brush, &samples);
    assert_eq!(all.len(), 21);
    assert!(all[11..].iter().all(|dab| dab.at.distance(rested.at) < 0.01));
    let both = Brush { rate: Rate { per_diameter: 2.0, per_sec: 0.0 }, ..brush };
    assert_eq!(
        dabs(&both, &steady(100)).len(),
        11,
        "100 px are five diameters of two, and 100 spacings are far"
    );
}

#[test]
fn dabs_that_overlap_come_to_the_flow_together() {
    let dab = dabs(
        &Brush { flow: 0.75, overlap: 2.0, dynamics: Dynamics::none(), ..brush(20.0) },
        &steady(20),
    )[0];
    assert!((dab.flow - 0.5).abs() < 1e-6);
}

#[test]
fn dabs_stand_aside_to_where_the_offset_says() {
    let at = |offset: Offset| {
        dabs(&Brush { offset, ..brush(20.0) }, &steady(50)).into_iter().map(|dab| dab.at)
    };
    let plain = Offset { amount: 0.5, ..Offset::default() };
    let right: Vec<Vec2> = at(plain).take(1).collect();
    assert!(right[0].distance(vec2(110.0, 200.0)) < 1e-3);
    // Upward is to the left of a stroke that goes right.
    let sides = Offset { turn_degrees: 90.0, from: Bearing::Stroke, alternates: true, ..plain };
    let sides: Vec<f32> = at(sides).map(|at| at.y).take(3).collect();
    assert!(
        sides.iter().zip([190.0, 190.0, 190.0]).all(|(y, up)| (y - up).abs() < 1e-2),
        "{sides:?}"
    );
    let straight = Offset { from: Bearing::Stroke, alternates: true, ..plain };
    let straight: Vec<f32> = at(straight).map(|at| at.x).take(2).collect();
    assert!(
        (straight[0] - 110.0).abs() < 1e-2 && (straight[1] - 95.0).abs() < 1e-2,
        "{straight:?}"
    );
}

#[test]
fn a_cycle_rises_is_held_and_begins_again() {
    let cycle = Cycle { length: 1.0, hold: 1.0, pressure: 0.0 };
    let dynamics =
        Dynamics::none().with(Property::Flow, Input::Cycle, additive(&[(0.0, -0.9), (1.0, 0.0)]));
    let dabs = dabs(&Brush { cycle, dynamics, ..brush(20.0) }, &steady(50));
    let flows: Vec<f32> = dabs.iter().map(|dab| (dab.flow * 1000.0).round()).collect();
    assert_eq!(
        flows,
        [100.0, 325.0, 550.0, 775.0, 1000.0, 1000.0, 1000.0, 1000.0, 100.0, 325.0, 550.0]
    );
}

#[test]
fn what_drives_the_custom_input_drives_what_follows_it_a_dab_later() {
    let dynamics = Dynamics::none()
        .with(Property::Custom, Input::Distance, additive(&[(0.0, 0.0), (1.0, 1.0)]))
        .with(Property::Hardness, Input::Custom, additive(&[(0.0, 0.0), (1.0, 1.0)]));
    let dabs = dabs(&Brush { hardness: 0.0, dynamics, ..brush(20.0) }, &steady(50));
    let hardness: Vec<f32> =
        dabs.iter().map(|dab| (dab.hardness * 1000.0).round()).take(4).collect();
    assert_eq!(hardness, [0.0, 0.0, 25.0, 50.0]);
}

#[test]
fn dabs_lag_behind_the_pen_and_lead_it() {
    let stylus = |stylus: StylusFilter| dabs(&Brush { stylus, ..brush(20.0) }, &steady(300));
    let at = |dabs: &[Dab]| dabs.iter().map(|dab| dab.at.x).fold(0.0, f32::max);
    let plain = at(&stylus(StylusFilter::default()));
    let lagging = at(&stylus(StylusFilter { lag_dabs: 4.0, ..StylusFilter::default() }));
    // Steps of 5 px, of which e^(−1/4) is left each time.
    assert!((plain - lagging - 5.0 / (0.25f32.exp() - 1.0)).abs() < 0.5, "{lagging}");
    let leading = at(&stylus(StylusFilter { lead_secs: 0.2, ..StylusFilter::default() }));
    assert!((leading - plain - 20.0).abs() < 0.5, "{leading}");
}

#[test]
fn an_elongation_that_is_driven_flattens_the_tip() {
    let dynamics = Dynamics::none().with(
        Property::Elongation,
        Input::Pressure,
        additive(&[(0.0, 0.0), (1.0, 3.0)]),
    );
    let dab = |tip: Tip| {
        dabs(&Brush { tip, dynamics: dynamics.clone(), ..brush(20.0) }, &steady(20))[0].ratio
    };
    assert_eq!([Tip::Round, Tip::Ellipse { ratio: 0.5 }].map(dab), [0.25, 0.2]);
}

#[test]
fn sizes_that_stray_make_large_dabs_fainter() {
    let dabs = dabs(
        &Brush { size_jitter: 0.5, flow: 0.5, dynamics: Dynamics::none(), ..brush(20.0) },
        &steady(300),
    );
    let (large, small): (Vec<&Dab>, Vec<&Dab>) = dabs.iter().partition(|dab| dab.radius > 10.0);
    assert!(large.len() > 15 && small.len() > 15);
    assert!(large.iter().all(|dab| (dab.flow * dab.radius * dab.radius - 50.0).abs() < 0.1));
    assert!(small.iter().all(|dab| dab.flow == 0.5));
}

#[test]
fn a_stroke_moved_by_whole_pixels_gives_its_dabs_moved_to_the_bit() {
    let samples = |by: Vec2| -> Vec<Sample> {
        let at = |i: u32| vec2(30.0 + 3.7 * i as f32, 60.0 + 20.0 * (i as f32 * 0.4).sin());
        (0..40).map(|i| Sample { at: at(i) + by, ..Sample::at(Vec2::ZERO) }.normalized()).collect()
    };
    let by = vec2(1037.0, 222.0);
    let (here, there) =
        (dabs(&brush(13.0), &samples(Vec2::ZERO)), dabs(&brush(13.0), &samples(by)));
    assert!(here.len() > 20 && here.len() == there.len());
    assert!(here.iter().zip(&there).all(|(a, b)| a.at + by == b.at && a.radius == b.radius));
}
