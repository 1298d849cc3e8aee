use super::*;
use crate::surface::unwrap::tests::of_height;

const WHOLE: UnwrapSettings = UnwrapSettings { amount: 1.0, smooth_px: 0.0 };

/// Two balls before a tilted plate.
fn scene() -> Surface {
    of_height(Size::new(200, 140), |x, y| {
        let ball = |cx: f32, cy: f32, r: f32| {
            let rest = r * r - (x - cx).powi(2) - (y - cy).powi(2);
            (rest > 4.0).then(|| 300.0 + rest.sqrt())
        };
        Some(ball(60.0, 60.0, 30.0).or(ball(150.0, 80.0, 22.0)).unwrap_or(0.5 * x))
    })
}

#[test]
fn every_object_has_a_piece_and_no_two_pieces_meet() {
    let surface = scene();
    let layout = PlaneLayout::new(&surface, WHOLE).unwrap();
    assert_eq!(layout.pieces().len(), surface.objects().count());
    let sheet = layout.size().rect();
    for (i, a) in layout.pieces().iter().enumerate() {
        assert!(a.rect.intersect(sheet) == a.rect, "{:?} on {sheet:?}", a.rect);
        for b in &layout.pieces()[i + 1..] {
            let apart = a.rect.grown(GAP_PX / 2).intersect(b.rect.grown(GAP_PX / 2));
            assert!(apart.is_empty(), "{:?} and {:?}", a.rect, b.rect);
        }
    }
}

#[test]
fn a_canvas_point_is_found_again_from_where_it_lies_on_the_sheet() {
    let surface = scene();
    let layout = PlaneLayout::new(&surface, WHOLE).unwrap();
    for q in [
        vec2(60.5, 60.5),
        vec2(75.2, 48.9),
        vec2(150.0, 80.0),
        vec2(20.5, 120.3),
        vec2(190.0, 20.0),
    ] {
        let p = layout.sheet_at(&surface, q).unwrap();
        let CanvasPlace { at: back, object, .. } = layout.canvas_at(&surface, p).unwrap();
        assert!(back.distance(q) < 0.1, "{q} came back as {back}");
        assert_eq!(object, surface.objects().labels().at(q.x as usize, q.y as usize));
    }
}

#[test]
fn the_layout_bends_a_picture_of_the_sheet_onto_the_surface() {
    let surface = scene();
    let layout = PlaneLayout::new(&surface, WHOLE).unwrap();
    let bend = layout.bend();
    let d = crate::surface::Deformation::new(Some(&surface), surface.size(), &bend);
    for (x, y) in [(60, 60), (150, 80), (20, 120), (190, 20)] {
        let p = layout.sheet_at(&surface, vec2(x as f32, y as f32) + 0.5).unwrap();
        assert!(d.at(x, y).distance(p) < 1e-3, "({x}, {y}): {} and {p}", d.at(x, y));
    }
}

#[test]
fn beside_a_piece_its_plane_goes_on_and_far_away_there_is_none() {
    let surface = of_height(Size::new(100, 80), |x, y| {
        (x > 20.0 && x < 80.0 && y > 20.0 && y < 60.0).then_some(0.5 * x)
    });
    let layout = PlaneLayout::new(&surface, WHOLE).unwrap();
    let rim = layout.sheet_at(&surface, vec2(21.5, 40.5)).unwrap();
    let q = layout.canvas_at(&surface, rim - vec2(5.0, 0.0)).unwrap().at;
    assert!((q.x - 16.5).abs() < 1.0 && (q.y - 40.5).abs() < 0.5, "flat beyond the rim: {q}");
    assert!(layout.canvas_at(&surface, rim - vec2(40.0, 0.0)).is_none());
    assert!(layout.canvas_at(&surface, Vec2::NAN).is_none());
}
