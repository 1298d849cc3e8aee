use super::*;

const CANVAS: Size = Size::new(256, 192);

fn frame() -> MeshFrame {
    MeshFrame::of(CANVAS)
}

#[test]
fn a_mesh_passes_through_its_points_and_an_even_one_moves_nothing() {
    let even = Mesh::even(4, 3, frame()).unwrap();
    assert_eq!(even.as_affine().map(|map| map.is_identity_on(CANVAS)), Some(true));
    let mut points = even.points().to_vec();
    points[5] += vec2(11.0, -7.0);
    let mesh = even.with_points(points.clone()).unwrap();
    assert!(mesh.as_affine().is_none());
    for (k, point) in points.iter().enumerate() {
        assert!(mesh.at(mesh.place(k)).0.distance(*point) < 1e-3, "{k}");
    }
    assert!(
        mesh.at(vec2(-50.0, 0.0)).0.distance(vec2(-50.0, 0.0)) < 1e-3,
        "the border goes on straight"
    );
}

#[test]
fn backward_finds_what_forward_took() {
    let even = Mesh::even(4, 4, frame()).unwrap();
    let mut points = even.points().to_vec();
    points[5] += vec2(14.0, -9.0);
    points[10] += vec2(-8.0, 12.0);
    let mesh = even.with_points(points).unwrap();
    let backward = mesh.backward(CANVAS);
    for (x, y) in [(20.0, 30.0), (85.0, 64.0), (130.5, 100.0), (200.0, 150.0), (240.0, 20.0)] {
        let p = vec2(x, y);
        let q = mesh.at(p).0;
        let found = q + backward.at(q).by;
        assert!(found.distance(p) < 0.1, "{p}: {found}");
    }
}

#[test]
fn folded_and_collapsed_meshes_give_numbers() {
    let even = Mesh::even(5, 5, frame()).unwrap();
    let mut folded = even.points().to_vec();
    folded.swap(6, 18);
    folded[12] = vec2(900.0, -400.0);
    let one = vec![vec2(100.0, 90.0); 25];
    let far = even.points().iter().map(|p| *p * 3000.0).collect();
    for points in [folded, one, far] {
        let backward = even.with_points(points).unwrap().backward(CANVAS);
        assert!(backward.blocks().all(|(_, block)| block.0.iter().all(|u| u.is_finite())));
        assert!(!backward.is_empty());
    }
}

#[test]
fn only_grids_that_files_hold_are_meshes() {
    assert!(Mesh::even(1, 4, frame()).is_none() && Mesh::even(34, 4, frame()).is_none());
    assert!(Mesh::even(33, 33, frame()).is_some());
    assert!(Mesh::new(2, 2, frame(), vec![Vec2::ZERO; 3]).is_none());
    assert!(Mesh::new(2, 2, frame(), vec![vec2(f32::NAN, 0.0); 4]).is_none());
    assert!(Mesh::even(2, 2, MeshFrame { size: vec2(0.0, 9.0), ..frame() }).is_none());
}

#[test]
fn a_quarter_turn_takes_the_grid_along() {
    let even = Mesh::even(4, 3, frame()).unwrap();
    let mut points = even.points().to_vec();
    points[5] += vec2(11.0, -7.0);
    let mesh = even.with_points(points).unwrap();
    let turn = PlaneMap::rotation(90.0, vec2(96.0, 96.0));
    let turn = PlaneMap::affine(turn.coefficients().unwrap().map(f64::round)).unwrap();
    let turned = mesh.transformed(&turn).unwrap();
    assert_eq!((turned.columns(), turned.rows()), (3, 4));
    let p = vec2(90.0, 80.0);
    let there = turn.to_canvas(mesh.at(p).0).unwrap();
    assert!(turned.at(turn.to_canvas(p).unwrap()).0.distance(there) < 1e-2);
}
