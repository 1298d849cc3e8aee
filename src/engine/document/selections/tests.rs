use super::*;
use crate::document::{DerivedMask, LayerId, Progress, diff, flatten};
use crate::math::{Rect, Size, Vec3, srgb::Color, vec2};
use crate::paint::{Brush, Sample};
use crate::surface::region::{RegionKind, SurfaceRegion};
use crate::surface::{Maps, Operator, Surface};

const SIZE: Size = Size::new(200, 130);

fn square(x0: i32, x1: i32) -> Selection {
    Selection::new(CoverageGrid::full(Rect::new(x0, 20, x1, 90)))
}

/// A line across the canvas on a stroke layer, in a selection of columns 40 to 80.
fn line() -> (Document, LayerId) {
    let samples = [vec2(10.0, 50.0), vec2(190.0, 50.0)].map(Sample::at).to_vec();
    let brush = Brush { size: 20.0, hardness: 1.0, ..Brush::default() };
    let document = Document::empty(SIZE).with_selection(Some(square(40, 80)));
    let stroke = Stroke::new(brush, Operator::None, Color::BLACK, samples)
        .within(document.stroke_selection());
    let layer = Layer::new(
        "line",
        Content::Strokes(Live::new(StrokeList { strokes: vec![Arc::new(stroke)] })),
    );
    let id = layer.id;
    (Document { layers: vec![Arc::new(layer)], ..document }, id)
}

fn alpha(document: &Document, x: i32, y: i32) -> u8 {
    flatten(document, &Progress::default()).unwrap().pixel(x, y)[3]
}

/// Left half facing left, right half facing right; the other way if `turned`.
fn roof(turned: bool) -> Arc<Surface> {
    let side = |x: usize| if (x < 100) != turned { -0.6 } else { 0.6 };
    let ridge = |x: usize| (x as f32 - 99.5).abs() / 99.5;
    let normals = Plane::from_fn(SIZE, |x, _| Vec3::new(side(x), 0.0, 0.8));
    let maps = Maps {
        normals,
        depth: Plane::from_fn(SIZE, |x, _| if turned { 1.0 - ridge(x) } else { ridge(x) }),
        coverage: Plane::full(SIZE, 255),
    };
    Arc::new(Surface::new(maps).unwrap())
}

#[test]
fn a_stroke_paints_in_its_selection_alone_and_takes_it_along() {
    let (document, id) = line();
    let at = |document: &Document| [39, 40, 79, 80].map(|x| alpha(document, x, 50));
    assert_eq!(at(&document), [0, 255, 255, 0]);
    let free = document.with_selection(None);
    assert_eq!(at(&free), [0, 255, 255, 0], "it keeps its own");
    assert!(diff(&document, &free).is_empty(), "selecting redraws nothing");
    let moved = document.with_moved_strokes(id, &[0], vec2(7.0, 3.0)).unwrap();
    assert_eq!([46, 47, 86, 87].map(|x| alpha(&moved, x, 53)), [0, 255, 255, 0]);
}

#[test]
fn selections_meet_by_every_rule() {
    let old = Document::empty(SIZE).with_selection(Some(square(40, 80)));
    let covered = |how| {
        old.with_combined(square(60, 120), how).active_coverage().map(CoverageGrid::covered_rect)
    };
    let columns = |x0, x1| Some(Rect::new(x0, 20, x1, 90));
    assert_eq!(covered(SelectionMode::Replace), columns(60, 120));
    assert_eq!(covered(SelectionMode::Add), columns(40, 120));
    assert_eq!(covered(SelectionMode::TakeAway), columns(40, 60));
    assert_eq!(covered(SelectionMode::Intersect), columns(60, 80));
    let none = Document::empty(SIZE).with_combined(square(60, 120), SelectionMode::TakeAway);
    assert_eq!(
        none.active_coverage().map(CoverageGrid::area_px),
        Some(200.0 * 130.0 - 60.0 * 70.0)
    );
    assert!(
        old.with_combined(square(40, 80), SelectionMode::TakeAway).active_coverage().is_none(),
        "nothing is none"
    );
}

#[test]
fn what_was_selected_by_the_surface_is_found_anew_when_the_surface_changes() {
    let (document, id) = line();
    let document = Document { surface: Some(roof(false)), ..document };
    let region = SurfaceRegion::new(RegionKind::Direction, vec2(20.5, 50.5));
    let left =
        Selection::of_region(SurfaceRegion { contiguous: false, ..region }, &document.scene());
    let document = document.with_selection(Some(left));
    let own = document.stroke_selection();
    let document =
        document.with_each_stroke(id, &[0], |stroke| stroke.selecting(own.clone())).unwrap();
    let document = document.with_kept_selection("left").unwrap();
    assert_eq!([50, 150].map(|x| alpha(&document, x, 50)), [255, 0]);
    let turned = Document { surface: Some(roof(true)), ..document.clone() }.with_selections_found();
    // The point faces the other way now, and so does all of its half.
    assert_eq!(
        turned.active_coverage().map(|grid| (grid.at(50, 50), grid.at(150, 50))),
        Some((255, 0))
    );
    let flat = Document { surface: None, ..document }.with_selections_found();
    assert_eq!(
        [50, 150].map(|x| alpha(&flat, x, 50)),
        [255, 255],
        "without a surface it bounds nothing"
    );
    let list = SelectionList::of(&flat);
    assert_eq!(
        list.all().len(),
        1,
        "the kept one, the active one and the stroke's are still one and the same"
    );
}

#[test]
fn selections_are_kept_by_name_each_once() {
    let one = Document::empty(SIZE).with_selection(Some(square(40, 80)));
    assert!(Document::empty(SIZE).with_kept_selection("a").is_none());
    let two = one.with_kept_selection("a").unwrap().with_selection(Some(square(10, 20)));
    let again = two.with_kept_selection("a").unwrap();
    assert_eq!(again.selections.len(), 1);
    assert_eq!(again.selections[0].selection.coverage.covered_rect(), Rect::new(10, 20, 20, 90));
    assert!(again.without_kept_selection("b").is_none());
    assert!(again.without_kept_selection("a").unwrap().selections.is_empty());
}

#[test]
fn a_mask_made_of_a_region_looks_like_the_selection() {
    let document = Document { surface: Some(roof(false)), ..Document::empty(SIZE) };
    let region = SurfaceRegion::new(RegionKind::Direction, vec2(20.5, 50.5));
    let document = document.with_selection(Some(Selection::of_region(region, &document.scene())));
    let mask = document.selection_as_mask().unwrap();
    assert!(matches!(mask.kind, MaskKind::Derived(DerivedMask::Region(_))));
    let fill = Layer { mask: Some(mask), ..Layer::new("fill", Content::Fill(Color::BLACK)) };
    assert!(document.mask_coverage(&fill).is_same(document.active_coverage().unwrap()));
    let document = Document { layers: vec![Arc::new(fill)], ..document };
    assert_eq!([50, 99, 100, 150].map(|x| alpha(&document, x, 50)), [255, 255, 0, 0]);
}
