//! What the thread paints, and what it does without memory.

use super::*;
use crate::document::{Content, Layer, Live, Progress, flatten};
use crate::math::{Size, srgb::Color};
use crate::paint::{Adjust, ImageFilter, PictureSource, PlacedImage, Placement};
use crate::raster::{Outside, Picture, TileGrid};
use std::sync::atomic::{AtomicBool, Ordering};

/// All that is painted until it is settled.
fn wait_until_settled(render_thread: &RenderThread, grid: &mut TileGrid) -> usize {
    let mut count = 0;
    loop {
        let painted = render_thread.painted.recv_timeout(Duration::from_secs(60)).unwrap();
        count += painted.tiles.len();
        painted.tiles.into_iter().for_each(|(at, tile)| grid.set(at, tile));
        if painted.is_settled {
            return count;
        }
    }
}

#[test]
fn without_memory_the_picture_waits_and_the_next_one_is_painted_whole() {
    let size = Size::new(100, 80);
    let fill = Layer::new("fill", Content::Fill(Color { r: 9, g: 90, b: 200, a: 255 }));
    let document = Document { layers: vec![Arc::new(fill)], ..Document::empty(size) };
    let wanted = || RenderRequest {
        picture: 3,
        document: document.clone(),
        visible: size.rect(),
        is_dragged: false,
    };
    let mut work = RenderWork::default();
    work.if_there_is_memory(|work| work.begin(wanted())).unwrap();
    let none: Result<Vec<u8>, _> =
        work.if_there_is_memory(|_| memory::fill_or_unwind(usize::MAX / 2, 0u8));
    assert!(none.is_err() && !work.has_more(), "the thread does not try again at once");
    assert!(work.nothing().is_settled);
    work.if_there_is_memory(|work| work.begin(wanted())).unwrap();
    let painted = work.if_there_is_memory(RenderWork::paint).unwrap().unwrap();
    assert_eq!((painted.tiles.len(), painted.refused), (4, None));
}

#[test]
fn the_painter_shows_what_flattening_gives_and_repaints_only_what_changed() {
    let size = Size::new(300, 200);
    let fill = Layer::new("fill", Content::Fill(Color { r: 9, g: 90, b: 200, a: 255 }));
    let document = Document { layers: vec![Arc::new(fill)], ..Document::empty(size) };
    let render_thread = RenderThread::new(|| {}).unwrap();
    let mut grid = TileGrid::default();
    let visible = size.rect();
    render_thread.want(RenderRequest {
        picture: 1,
        document: document.clone(),
        visible,
        is_dragged: false,
    });
    assert_eq!(wait_until_settled(&render_thread, &mut grid), 5 * 4);
    let whole = flatten(&document, &Progress::default()).unwrap();
    assert!(grid.to_straight_rgba(visible) == whole.to_straight_rgba(visible));
    let dot = TileGrid::from_straight_rgba(&[255, 0, 0, 255], 1, 1, 100, 100);
    let pixels = crate::document::PixelLayer { file: String::new(), x: 0, y: 0, tiles: dot };
    let mut next = document.clone();
    next.layers.push(Arc::new(Layer::new("dot", Content::Pixels(pixels))));
    render_thread.want(RenderRequest {
        picture: 1,
        document: next.clone(),
        visible,
        is_dragged: false,
    });
    assert_eq!(wait_until_settled(&render_thread, &mut grid), 1);
    assert_eq!(grid.pixel(100, 100), [255, 0, 0, 255]);
    render_thread.want(RenderRequest { picture: 1, document: next, visible, is_dragged: false });
    assert_eq!(
        wait_until_settled(&render_thread, &mut grid),
        0,
        "what is the same is settled at once"
    );
}

/// A picture much finer than the canvas, moved by some px.
fn photo(size: Size, by: f32) -> Content {
    let texel = |i: usize| [(i * 37) as u8, (i * 101) as u8, (i * 11) as u8, 255];
    let picture = Picture::srgb8(Size::new(900, 600), (0..900 * 600).map(texel).collect()).unwrap();
    let mut placement = Placement::covering(size);
    placement.center.x += by;
    Content::Image(Live::new(PlacedImage {
        source: PictureSource::new("photo".into(), picture, Adjust::default()),
        placement,
        outside: Outside::Mirror,
        bend: Default::default(),
        filter: ImageFilter::Antialias,
        frame: Default::default(),
    }))
}

#[test]
fn a_drag_is_shown_in_all_pixels_and_painted_anew_once_the_hand_rests() {
    let size = Size::new(96, 64);
    let layers = ["at rest", "dragged"].map(|name| Arc::new(Layer::new(name, photo(size, 0.0))));
    let document = Document { layers: layers.to_vec(), ..Document::empty(size) };
    let wanted = |document: &Document, is_dragged: bool| RenderRequest {
        picture: 1,
        document: document.clone(),
        visible: size.rect(),
        is_dragged,
    };
    let mut work = RenderWork::default();
    let paint = |work: &mut RenderWork| {
        let mut grid = TileGrid::default();
        let mut is_draft = None;
        while let Some(batch) = work.has_more().then(|| work.paint()).flatten() {
            is_draft = Some(batch.is_draft);
            assert_eq!(batch.size, size);
            batch.tiles.into_iter().for_each(|(at, tile)| grid.set(at, tile));
        }
        (is_draft, grid.to_straight_rgba(size.rect()))
    };
    work.begin(wanted(&document, false));
    paint(&mut work);
    work.begin(wanted(&document, true));
    let dragged =
        document.with_layer(layers[1].id, |layer| layer.content = photo(size, 3.3)).unwrap();
    work.begin(wanted(&dragged, true));
    // As if whole pixels had been found to take longer than a frame.
    work.begin_draft(1);
    work.show_draft();
    let (is_draft, coarse) = paint(&mut work);
    let fine = flatten(&dragged, &Progress::default()).unwrap().to_straight_rgba(size.rect());
    assert!(is_draft == Some(true) && coarse != fine);
    work.begin(wanted(&dragged, false));
    let (is_draft, whole) = paint(&mut work);
    assert!(is_draft == Some(false) && whole == fine);
}

#[test]
fn pixels_grow_only_where_a_draft_of_all_of_them_would_take_longer_than_a_frame() {
    let steps = [16, 42, 44, 170, 180, 900].map(|ms| step_for(Duration::from_millis(ms)));
    assert_eq!(steps, [1, 1, 2, 2, 4, 8]);
}

#[test]
fn a_frame_that_waits_for_the_picture_is_not_told_of_it_again() {
    let told = Arc::new(AtomicBool::new(false));
    let teller = told.clone();
    let render_thread = RenderThread::new(move || teller.store(true, Ordering::SeqCst)).unwrap();
    let size = Size::new(100, 80);
    let want = move |picture| {
        let (document, visible) = (Document::empty(size), size.rect());
        RenderRequest { picture, document, visible, is_dragged: false }
    };
    // The request comes while a frame waits already.
    let shared = render_thread.shared.clone();
    let asking = std::thread::spawn(move || {
        while !*lock(&shared.is_awaited) {
            std::thread::yield_now();
        }
        *lock(&shared.wanted) = Some(want(1));
        shared.wake.notify_one();
    });
    let taken = render_thread.take_rendered(Duration::from_secs(60));
    asking.join().unwrap();
    assert!(taken.last().is_some_and(|batch| batch.picture == 1 && batch.is_settled));
    assert!(!told.load(Ordering::SeqCst));
    // Nobody waits.
    render_thread.want(want(2));
    while !told.load(Ordering::SeqCst) {
        std::thread::yield_now();
    }
    let taken = render_thread.take_rendered(Duration::ZERO);
    assert!(taken.last().is_some_and(|batch| batch.picture == 2));
}
