//! Figures: their lines, and how their handles change them.

use super::*;

fn figure(kind: FigureKind) -> Figure {
    Figure { kind, from: vec2(10.0, 20.0), to: vec2(110.0, 80.0), ..Figure::DEFAULT }
}

fn points(figure: &Figure) -> Vec<Vec2> {
    figure.subpaths().iter().flat_map(|line| line.nodes.iter().map(|node| node.at)).collect()
}

#[test]
fn each_kind_has_its_corners() {
    let count = |kind| figure(kind).subpaths()[0].nodes.len();
    assert_eq!(count(FigureKind::Rectangle), 4);
    assert_eq!(count(FigureKind::Ellipse), 4);
    assert_eq!(count(FigureKind::Polygon), 5);
    assert_eq!(count(FigureKind::Star), 10);
    assert_eq!(count(FigureKind::Line), 2);
    assert_eq!(count(FigureKind::Arrow), 7);
    assert_eq!(count(FigureKind::Balloon), 6);
    let rounded = Figure { corner: 8.0, ..figure(FigureKind::Rectangle) };
    assert_eq!(rounded.subpaths()[0].nodes.len(), 8);
}

#[test]
fn an_ellipse_deviates_from_its_equation_by_less_than_a_thousandth() {
    let ellipse = figure(FigureKind::Ellipse);
    let (center, half) = (ellipse.center(), ellipse.half());
    for curve in ellipse.subpaths()[0].curves() {
        for i in 0..=20 {
            let p = (super::super::subpath::point_at(curve, i as f32 / 20.0) - center) / half;
            assert!((p.length() - 1.0).abs() < 1e-3, "{p}");
        }
    }
}

#[test]
fn rounded_corners_are_arcs_of_the_radius() {
    let square = Figure { corner: 10.0, ..figure(FigureKind::Rectangle) };
    let line = &square.subpaths()[0];
    // The arc at the upper left corner has its middle 10 px inside.
    let middle = vec2(20.0, 30.0);
    let curve = line.curves().next().unwrap();
    for i in 0..=10 {
        let p = super::super::subpath::point_at(curve, i as f32 / 10.0);
        assert!((p.distance(middle) - 10.0).abs() < 0.02, "{p}");
    }
    // No larger than the sides leave room for.
    let pill = Figure { corner: 500.0, ..square };
    let (low, high) = points(&pill)
        .into_iter()
        .fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
    assert!((low - vec2(10.0, 20.0)).abs().max_element() < 1e-3, "{low}");
    assert!((high - vec2(110.0, 80.0)).abs().max_element() < 1e-3, "{high}");
}

#[test]
fn a_dragged_handle_keeps_the_opposite_one() {
    for rotation in [0.0, 30.0, -75.0] {
        let old = Figure { rotation, ..figure(FigureKind::Star) };
        for handle in 0..4 {
            let fixed = old.handles()[(handle + 2) % 4];
            let at = old.handles()[handle] + vec2(7.0, -3.0);
            let new = old.with_handle(handle, at, false);
            let found = new.handles();
            assert!(found[handle].distance(at) < 1e-3, "{rotation} {handle}: {found:?}");
            assert!(found[(handle + 2) % 4].distance(fixed) < 1e-3, "{rotation} {handle}");
            let kept = old.with_handle(handle, at, true);
            let (was, is) = (old.half(), kept.half());
            assert!((was.x / was.y - is.x / is.y).abs() < 1e-3, "{is}");
        }
    }
    let line = figure(FigureKind::Line).with_handle(1, vec2(50.0, 21.0), true);
    assert!((line.to.y - 20.0).abs() < 1e-3, "{}", line.to);
}

#[test]
fn a_drag_is_regular_or_about_its_beginning_if_asked() {
    let plain = Figure::DEFAULT;
    let (from, to) = (vec2(10.0, 10.0), vec2(40.0, 20.0));
    let square = plain.between(from, to, true, false);
    assert_eq!((square.from, square.to), (from, vec2(40.0, 40.0)));
    let about = plain.between(from, to, false, true);
    assert_eq!((about.from, about.to), (vec2(-20.0, 0.0), to));
}

#[test]
fn an_arrow_ends_at_its_tip_and_its_head_is_no_longer_than_it() {
    let arrow = Figure { from: Vec2::ZERO, to: vec2(100.0, 0.0), ..figure(FigureKind::Arrow) };
    let found = points(&arrow);
    assert!(found.contains(&vec2(100.0, 0.0)) && found.contains(&vec2(60.0, 20.0)), "{found:?}");
    let short = Figure { to: vec2(10.0, 0.0), ..arrow };
    assert!(points(&short).iter().all(|p| p.x >= 0.0), "{:?}", points(&short));
    let none = Figure { to: Vec2::ZERO, ..arrow };
    assert!(points(&none).iter().all(|p| p.is_finite()));
}

#[test]
fn what_files_cannot_hold_is_named() {
    assert_eq!(figure(FigureKind::Star).fits(), Ok(()));
    let wrong = Figure { inner: 3.0, ..figure(FigureKind::Star) };
    assert!(wrong.fits().unwrap_err().contains("Inner radius is 3"));
    let far = Figure { to: vec2(1e9, 0.0), ..figure(FigureKind::Line) };
    assert!(far.fits().is_err());
    assert!(Figure { from: Vec2::NAN, ..far }.fits().is_err());
}

#[test]
fn a_balloon_has_its_tail_to_its_tip_which_stays_while_the_box_changes() {
    let balloon = Figure { rotation: 20.0, ..figure(FigureKind::Balloon) };
    let tip = balloon.handles()[4];
    assert!(points(&balloon).iter().any(|p| p.distance(tip) < 1e-3));
    // The tail begins as wide as it is said to.
    let [first, last] = [0, 4].map(|i| points(&balloon)[i]);
    assert!((first.distance(last) - balloon.tail).abs() < 0.5, "{}", first.distance(last));
    let dragged = balloon.with_handle(4, vec2(200.0, 150.0), false);
    assert!(dragged.handles()[4].distance(vec2(200.0, 150.0)) < 1e-3);
    for handle in 0..4 {
        let larger =
            dragged.with_handle(handle, dragged.handles()[handle] + vec2(9.0, -4.0), false);
        assert!(larger.handles()[4].distance(vec2(200.0, 150.0)) < 1e-2, "{handle}");
    }
    // Moved and turned alone, it still points there; its shape in its own frame is another.
    let away = dragged.moved_body(vec2(-40.0, 12.0));
    assert!(away.handles()[4].distance(vec2(200.0, 150.0)) < 1e-2);
    assert_eq!(away.center(), dragged.center() + vec2(-40.0, 12.0));
    let turned = dragged.turned(-65.0);
    assert!(turned.rotation == -65.0 && turned.handles()[4].distance(vec2(200.0, 150.0)) < 1e-2);
    assert_eq!(dragged.moved(vec2(5.0, 5.0)).tail_x, dragged.tail_x);
    let star = figure(FigureKind::Star);
    assert_eq!(star.moved_body(vec2(3.0, 4.0)), star.moved(vec2(3.0, 4.0)));
    // Inside there is no tail, and a balloon without a height is no failure.
    let inside = balloon.with_handle(4, balloon.center(), false);
    assert_eq!(inside.subpaths()[0].nodes.len(), 4);
    let flat = Figure { to: vec2(110.0, 20.0), ..balloon };
    assert!(points(&flat.with_handle(4, vec2(9.0, 9.0), false)).iter().all(|p| p.is_finite()));
}
