//! Drafts of filters: how far they are from the whole ones.

use super::*;
use crate::math::vec3;
use crate::raster::Plane;
use crate::surface::{Maps, Surface};

/// Odd sides: its last pixels are half of one of half the size.
const SIZE: Size = Size::new(301, 203);

/// Shapes with hard edges on a ramp, one of them transparent.
fn shapes() -> FilterWindow {
    let rect = SIZE.rect();
    let pixel = |x: i32, y: i32| {
        let ramp = x as f32 / 301.0;
        let is_in = |cx: i32, cy: i32, r: i32| (x - cx).pow(2) + (y - cy).pow(2) < r * r;
        if is_in(90, 70, 40) {
            [0.9, 0.2, 0.1, 1.0]
        } else if (x + 2 * y) % 60 < 12 {
            [0.05, 0.1, 0.3, 1.0]
        } else if is_in(230, 140, 50) {
            [0.1, 0.3, 0.2, 0.4]
        } else {
            [ramp, 0.7, 1.0 - ramp, 1.0]
        }
    };
    let places = (rect.y0..rect.y1).flat_map(|y| (rect.x0..rect.x1).map(move |x| (x, y)));
    FilterWindow::new(rect, places.map(|(x, y)| pixel(x, y)).collect())
}

/// A ball before a wall.
fn ball() -> Scene {
    let up = |x: usize, y: usize| {
        let (dx, dy) = (x as f32 - 150.0, y as f32 - 100.0);
        ((80.0f32 * 80.0 - dx * dx - dy * dy).max(0.0).sqrt(), dx, dy)
    };
    let maps = Maps {
        normals: Plane::from_fn(SIZE, |x, y| match up(x, y) {
            (0.0, ..) => crate::math::Vec3::Z,
            (z, dx, dy) => vec3(dx, -dy, z),
        }),
        depth: Plane::from_fn(SIZE, |x, y| 0.9 - 0.5 * up(x, y).0 / 80.0),
        coverage: Plane::full(SIZE, 255),
    };
    Scene { size: SIZE, surface: Some(Arc::new(Surface::new(maps).unwrap())) }
}

fn filters_with_drafts() -> Vec<PictureFilter> {
    let is_drafted = |filter: &PictureFilter| LiveFilter::new(filter.clone()).drafted().is_some();
    PictureFilter::all().into_iter().filter(is_drafted).collect()
}

/// The whole filter and its draft.
fn both(filter: &PictureFilter, scene: &Scene, source: &FilterWindow) -> [FilterWindow; 2] {
    let whole = LiveFilter::new(filter.clone());
    let draft = whole.drafted().unwrap();
    [whole, draft].map(|live| live.apply(&FilterPlace::new(scene, source.rect(), 1.0), source))
}

/// The mean difference and the largest one, levels of 255.
fn difference(a: &FilterWindow, b: &FilterWindow) -> (f32, f32) {
    let (a, b) = (a.pixels().as_flattened(), b.pixels().as_flattened());
    let off: Vec<f32> = a.iter().zip(b).map(|(a, b)| (a - b).abs() * 255.0).collect();
    (off.iter().sum::<f32>() / off.len() as f32, off.iter().copied().fold(0.0, f32::max))
}

/// The share of the values that differ by more levels.
fn share_beyond(a: &FilterWindow, b: &FilterWindow, levels: f32) -> f32 {
    let (a, b) = (a.pixels().as_flattened(), b.pixels().as_flattened());
    let far = a.iter().zip(b).filter(|(a, b)| (**a - **b).abs() * 255.0 > levels).count();
    far as f32 / a.len() as f32
}

#[test]
fn the_four_costly_and_soft_filters_have_drafts_that_are_other_filters() {
    let names: Vec<&str> = filters_with_drafts().iter().map(|filter| filter.name()).collect();
    assert_eq!(names, ["spin-blur", "zoom-blur", "lens-blur", "flow-blur"]);
    for filter in filters_with_drafts() {
        let whole = LiveFilter::new(filter);
        let draft = whole.drafted().unwrap();
        assert!(draft != whole && draft == whole.drafted().unwrap());
        assert!(draft.drafted().is_none(), "a draft is one already");
        assert_eq!(draft.params(), whole.params());
        assert!(draft.scaled(0.5) == whole.scaled(0.5).drafted().unwrap());
    }
}

#[test]
fn a_draft_is_near_the_whole_filter_on_a_picture_with_edges() {
    let (source, scene) = (shapes(), ball());
    for filter in filters_with_drafts() {
        let [whole, draft] = both(&filter, &scene, &source);
        let (mean, most) = difference(&whole, &draft);
        // Thin lines across the way, at contours, are soft for as long as the draft is seen.
        assert!(mean < 2.5, "{}: {mean} levels in the mean", filter.name());
        let rough = share_beyond(&whole, &draft, 24.0);
        assert!(rough < 0.02, "{}: {rough} of the values, up to {most} levels", filter.name());
    }
}

#[test]
fn what_a_filter_leaves_sharp_is_sharp_in_its_draft() {
    let (source, scene) = (shapes(), ball());
    // The front of the ball is in focus.
    let lens = LensBlur { focus: 45.0, range: 30.0, ..LensBlur::default() };
    let [whole, draft] = both(&PictureFilter::LensBlur(lens), &scene, &source);
    let off = |x, y| largest_difference(&[whole.at(x, y)], &[draft.at(x, y)]) * 255.0;
    for (x, y) in [(150, 100), (120, 80), (180, 130)] {
        assert!(off(x, y) < 0.5, "in focus: {} levels at {x}, {y}", off(x, y));
    }
    // Around the center of a turn and of a zoom both are nearly the picture.
    for name in ["spin-blur", "zoom-blur"] {
        let [whole, draft] = both(&of(name), &scene, &source);
        let near = Rect::new(140, 91, 161, 112);
        let [whole, draft] = [whole, draft].map(|all| FilterWindow::new(near, all.cropped(near)));
        let (mean, _) = difference(&whole, &draft);
        assert!(mean < 5.0, "{name}: {mean} levels around the center");
    }
    // Without a length nothing is filtered.
    let none = [
        PictureFilter::SpinBlur(SpinBlur { angle: 0.0, ..SpinBlur::default() }),
        PictureFilter::ZoomBlur(ZoomBlur { amount: 0.0, ..ZoomBlur::default() }),
        PictureFilter::LensBlur(LensBlur { radius: 0.0, ..lens }),
        PictureFilter::FlowBlur(FlowBlur { length: 0.0, ..FlowBlur::default() }),
    ];
    for filter in none {
        let [_, draft] = both(&filter, &scene, &source);
        let off = largest_difference(draft.pixels(), source.pixels());
        assert!(off < 1e-6, "{}: {off}", filter.name());
    }
}

#[test]
fn drafts_of_parts_are_parts_of_the_draft() {
    let (source, scene) = (shapes(), ball());
    for filter in filters_with_drafts() {
        let draft = LiveFilter::new(filter.clone()).drafted().unwrap();
        let of = |out| draft.apply(&FilterPlace::new(&scene, out, 1.0), &source);
        let whole = of(source.rect());
        // Parts with odd corners too, though blocks have even ones.
        for part in
            [Rect::new(0, 0, 128, 128), Rect::new(128, 64, 301, 203), Rect::new(61, 33, 94, 70)]
        {
            let off = largest_difference(of(part).pixels(), &whole.cropped(part));
            // Around a point, a part is read on circles and rays of its own.
            let is_round = ["spin-blur", "zoom-blur"].contains(&filter.name());
            let most = if is_round { 0.02 } else { 2e-4 };
            assert!(off < most, "{} on {part:?}: {off}", filter.name());
        }
    }
}

#[test]
fn one_color_stays_one_color_in_drafts() {
    let color = [0.3, 0.15, 0.05, 0.6];
    let plain = FilterWindow::new(SIZE.rect(), vec![color; SIZE.area()]);
    for filter in filters_with_drafts() {
        for scene in [Scene { size: SIZE, surface: None }, ball()] {
            let [_, draft] = both(&filter, &scene, &plain);
            let off = largest_difference(draft.pixels(), plain.pixels());
            assert!(off < 1e-3, "{}: {off}", filter.name());
        }
    }
}
