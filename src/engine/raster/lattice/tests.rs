use super::*;

/// A bump of this many px about a point.
fn bump(center: Vec2, radius: f32, by: Vec2) -> Lattice {
    let mut lattice = Lattice::default();
    let (low, high) = (center - radius, center + radius);
    let rect = Rect::new(low.x as i32, low.y as i32, high.x as i32 + 1, high.y as i32 + 1);
    lattice.change(rect, |_, q, _| by * (1.0 - (q.distance(center) / radius).min(1.0)).powi(2));
    lattice
}

#[test]
fn between_nodes_rows_say_what_the_readable_one_says() {
    let lattice = bump(vec2(60.0, 70.0), 50.0, vec2(12.0, -7.0));
    let mut seen = 0;
    for at in TileAt::covering(Rect::new(-64, -64, 192, 192)) {
        let Some(row) = lattice.on_tile(at) else { continue };
        for k in 0..row.len() {
            let (x, y) =
                (at.rect().x0 as f32 + (k % TILE) as f32, at.rect().y0 as f32 + (k / TILE) as f32);
            let q = vec2(x + 0.5, y + 0.5);
            let ((p, jacobian), expected) = (row.at(k), lattice.at(q));
            assert!((p - q - expected.by).length() < 1e-4, "{x} {y}: {p} {expected:?}");
            let off = jacobian - Mat2::IDENTITY - expected.jacobian;
            assert!(off.x_axis.length() + off.y_axis.length() < 1e-5, "{x} {y}");
        }
        seen += 1;
    }
    assert!(seen >= 4);
}

#[test]
fn a_linear_displacement_is_linear_between_nodes_and_its_slope_is_known() {
    let mut lattice = Lattice::default();
    lattice
        .change(Rect::new(0, 0, 256, 256), |_, q, _| vec2(q.x * 0.25, q.y * -0.125 + q.x * 0.0625));
    let found = lattice.at(vec2(101.5, 93.25));
    assert!(
        (found.by - vec2(101.5 * 0.25, 93.25 * -0.125 + 101.5 * 0.0625)).length() < 1e-3,
        "{found:?}"
    );
    assert!((found.jacobian.x_axis - vec2(0.25, 0.0625)).length() < 1e-5);
    assert!((found.jacobian.y_axis - vec2(0.0, -0.125)).length() < 1e-5);
}

#[test]
fn what_displaces_nothing_is_not_held_and_no_number_is_none() {
    let mut lattice = bump(vec2(60.0, 70.0), 50.0, vec2(12.0, -7.0));
    lattice.change(Rect::new(-64, -64, 256, 256), |_, _, _| vec2(f32::NAN, f32::INFINITY));
    assert!(lattice.is_empty());
}

#[test]
fn a_displacement_moved_by_whole_cells_is_the_same_one_there() {
    let lattice = bump(vec2(60.0, 70.0), 50.0, vec2(12.0, -7.0));
    let all = Rect::new(-999, -999, 999, 999);
    let there = lattice.transformed(&PlaneMap::translation(vec2(24.0, -8.0)), all);
    assert_eq!(there.node(10, 7), lattice.node(7, 8));
    assert!(there.node(10, 7) != Vec2::ZERO);
    assert_eq!(there.transformed(&PlaneMap::translation(vec2(-24.0, 8.0)), all), lattice);
    // Turned by a quarter, its vectors turn.
    let turn = PlaneMap::rotation(90.0, vec2(0.0, 0.0));
    let (turned, p) = (lattice.transformed(&turn, all), vec2(56.0, 64.0));
    let expected = turn.to_canvas(lattice.at(p).by).unwrap();
    assert!((turned.at(turn.to_canvas(p).unwrap()).by - expected).length() < 0.05);
}

#[test]
fn only_tiles_around_changed_nodes_differ() {
    let far = bump(vec2(600.0, 600.0), 50.0, vec2(3.0, 3.0));
    let mut both = far.clone();
    both.change(Rect::new(40, 40, 90, 90), |_, _, _| vec2(1.0, 0.0));
    let changed = both.changed_tiles(&far);
    assert!(
        changed.contains(&TileAt::new(0, 0)) && changed.contains(&TileAt::new(1, 1)),
        "{changed:?}"
    );
    assert!(changed.iter().all(|at| at.col <= 2 && at.row <= 2), "{changed:?}");
    assert!(far.changed_tiles(&far.clone()).is_empty());
}
