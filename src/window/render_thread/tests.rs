//! What the thread paints, and what it does where there is no memory.

use super::*;
use crate::document::{Content, Layer, Progress, flatten};
use crate::math::{Size, srgb::Color};
use crate::raster::TileGrid;

/// All that is painted until it is settled.
fn settled(render_thread: &RenderThread, grid: &mut TileGrid) -> usize {
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
    let wanted = || RenderRequest { picture: 3, document: document.clone(), visible: size.rect(), is_dragged: false };
    let mut work = RenderWork::default();
    work.if_there_is_memory(|work| work.take_up(wanted())).unwrap();
    let none: Result<Vec<u8>, _> = work.if_there_is_memory(|_| memory::filled_or_unwind(usize::MAX / 2, 0u8));
    assert!(none.is_err() && !work.has_more(), "the thread does not try again at once");
    assert!(work.nothing().is_settled);
    work.if_there_is_memory(|work| work.take_up(wanted())).unwrap();
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
    render_thread.want(RenderRequest { picture: 1, document: document.clone(), visible, is_dragged: false });
    assert_eq!(settled(&render_thread, &mut grid), 5 * 4);
    let whole = flatten(&document, &Progress::default()).unwrap();
    assert!(grid.to_straight_rgba(visible) == whole.to_straight_rgba(visible));
    let dot = TileGrid::from_straight_rgba(&[255, 0, 0, 255], 1, 1, 100, 100);
    let pixels = crate::document::PixelLayer { file: String::new(), x: 0, y: 0, tiles: dot };
    let mut next = document.clone();
    next.layers.push(Arc::new(Layer::new("dot", Content::Pixels(pixels))));
    render_thread.want(RenderRequest { picture: 1, document: next.clone(), visible, is_dragged: false });
    assert_eq!(settled(&render_thread, &mut grid), 1);
    assert_eq!(grid.pixel(100, 100), [255, 0, 0, 255]);
    render_thread.want(RenderRequest { picture: 1, document: next, visible, is_dragged: false });
    assert_eq!(settled(&render_thread, &mut grid), 0, "what is the same is settled at once");
}
