//! The painter: a thread that flattens documents tile by tile, so that the window never waits for pixels. It compares what it
//! shows with what it is given and paints only tiles that differ, those in sight first.
//! Floor 7. Pixels are `document::flatten`'s.

use crate::document::{Document, Prepared, Progress, diff};
use crate::math::Rect;
use crate::raster::{Tile, TileAt};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// What is to be shown.
pub struct Wanted {
    /// Another number is another picture: nothing of the last one holds.
    pub picture: u64,
    pub document: Document,
    /// The canvas pixels in sight.
    pub visible: Rect,
}

/// Tiles that were painted.
pub struct Painted {
    pub picture: u64,
    pub tiles: Vec<(TileAt, Option<Arc<Tile>>)>,
    /// Nothing in sight is left to paint.
    pub is_settled: bool,
    /// Since the document that these tiles belong to was taken up.
    pub took: Duration,
}

#[derive(Default)]
struct Shared {
    wanted: Mutex<Option<Wanted>>,
    wake: Condvar,
    closed: Mutex<bool>,
}

/// The thread's handle; it ends with it.
pub struct Painter {
    shared: Arc<Shared>,
    painted: Receiver<Painted>,
}

/// Tiles painted between two looks at whether something newer is wanted.
const BATCH: usize = 48;
/// A pass over what is in sight may take so long before something newer cuts in, so that a drag shows whole pictures.
const PASS: Duration = Duration::from_millis(150);

impl Painter {
    /// `done` is called on the painter's thread after each batch.
    pub fn new(done: impl Fn() + Send + 'static) -> Self {
        let shared = Arc::new(Shared::default());
        let (sender, painted) = channel();
        let for_thread = shared.clone();
        // Without a thread nothing is painted; the window still opens and says so by staying empty.
        let _ = std::thread::Builder::new().name("painter".into()).spawn(move || work(&for_thread, &sender, &done));
        Self { shared, painted }
    }
    /// Asks for a document; the last one asked for counts.
    pub fn want(&self, wanted: Wanted) {
        *lock(&self.shared.wanted) = Some(wanted);
        self.shared.wake.notify_one();
    }
    /// What was painted since the last call.
    pub fn painted(&self) -> impl Iterator<Item = Painted> + '_ {
        self.painted.try_iter()
    }
}

impl Drop for Painter {
    fn drop(&mut self) {
        *lock(&self.shared.closed) = true;
        self.shared.wake.notify_one();
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What the thread works on.
#[derive(Default)]
struct Work {
    wanted: Option<Wanted>,
    prepared: Option<Prepared>,
    /// Tiles that are not yet those of the wanted document.
    dirty: BTreeSet<TileAt>,
    begun: Option<Instant>,
}

fn work(shared: &Shared, sender: &Sender<Painted>, done: &dyn Fn()) {
    let mut work = Work::default();
    loop {
        let mut wanted = lock(&shared.wanted);
        while wanted.is_none() && work.dirty.is_empty() {
            if *lock(&shared.closed) {
                return;
            }
            wanted = shared.wake.wait(wanted).unwrap_or_else(PoisonError::into_inner);
        }
        if *lock(&shared.closed) {
            return;
        }
        let next = wanted.take();
        drop(wanted);
        if let Some(next) = next {
            let picture = next.picture;
            work.take_up(next);
            // Nothing differs: whoever waits for the picture has it.
            if work.dirty.is_empty() {
                let painted = Painted { picture, tiles: Vec::new(), is_settled: true, took: Duration::ZERO };
                if sender.send(painted).is_err() {
                    return;
                }
                done();
            }
        }
        let pass = Instant::now();
        while let Some(painted) = work.paint() {
            let is_settled = painted.is_settled;
            if sender.send(painted).is_err() {
                return;
            }
            done();
            let newer = lock(&shared.wanted).is_some();
            if newer && (is_settled || pass.elapsed() > PASS) {
                break;
            }
        }
    }
}

impl Work {
    fn take_up(&mut self, next: Wanted) {
        let same =
            self.wanted.as_ref().filter(|old| old.picture == next.picture && old.document.size == next.document.size);
        match same {
            Some(old) => self.dirty.extend(diff(&old.document, &next.document)),
            None => self.dirty = TileAt::covering(next.document.size.rect()).collect(),
        }
        if !self.dirty.is_empty() {
            self.begun = Some(Instant::now());
        }
        self.prepared = None;
        self.wanted = Some(next);
    }
    /// Paints the next tiles, those in sight first; `None` where nothing is left.
    fn paint(&mut self) -> Option<Painted> {
        let wanted = self.wanted.as_ref()?;
        if self.dirty.is_empty() {
            return None;
        }
        if self.prepared.is_none() {
            self.prepared = Prepared::new(&wanted.document, &Progress::default());
        }
        let prepared = self.prepared.as_ref()?;
        let in_sight = |at: &TileAt| !at.rect().intersect(wanted.visible).is_empty();
        let mut batch: Vec<TileAt> = self.dirty.iter().copied().filter(in_sight).take(BATCH).collect();
        if batch.is_empty() {
            batch = self.dirty.iter().copied().take(BATCH).collect();
        }
        let tiles: Vec<_> = batch.par_iter().map(|&at| (at, prepared.flatten_tile(at))).collect();
        for at in &batch {
            self.dirty.remove(at);
        }
        let is_settled = !self.dirty.iter().any(in_sight);
        let took = self.begun.map_or(Duration::ZERO, |begun| begun.elapsed());
        Some(Painted { picture: wanted.picture, tiles, is_settled, took })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Content, Layer, flatten};
    use crate::math::{Size, srgb::Color};
    use crate::raster::TileGrid;

    /// All that is painted until it is settled.
    fn settled(painter: &Painter, grid: &mut TileGrid) -> usize {
        let mut count = 0;
        loop {
            let painted = painter.painted.recv_timeout(Duration::from_secs(60)).unwrap();
            count += painted.tiles.len();
            painted.tiles.into_iter().for_each(|(at, tile)| grid.set(at, tile));
            if painted.is_settled {
                return count;
            }
        }
    }

    #[test]
    fn the_painter_shows_what_flattening_gives_and_repaints_only_what_changed() {
        let size = Size::new(300, 200);
        let fill = Layer::new("fill", Content::Fill(Color { r: 9, g: 90, b: 200, a: 255 }));
        let document = Document { layers: vec![Arc::new(fill)], ..Document::empty(size) };
        let painter = Painter::new(|| {});
        let mut grid = TileGrid::default();
        let visible = size.rect();
        painter.want(Wanted { picture: 1, document: document.clone(), visible });
        assert_eq!(settled(&painter, &mut grid), 5 * 4);
        let whole = flatten(&document, &Progress::default()).unwrap();
        assert!(grid.to_straight_rgba(visible) == whole.to_straight_rgba(visible));
        let dot = TileGrid::from_straight_rgba(&[255, 0, 0, 255], 1, 1, 100, 100);
        let pixels = crate::document::PixelLayer { file: String::new(), x: 0, y: 0, tiles: dot };
        let mut next = document.clone();
        next.layers.push(Arc::new(Layer::new("dot", Content::Pixels(pixels))));
        painter.want(Wanted { picture: 1, document: next.clone(), visible });
        assert_eq!(settled(&painter, &mut grid), 1);
        assert_eq!(grid.pixel(100, 100), [255, 0, 0, 255]);
        painter.want(Wanted { picture: 1, document: next, visible });
        assert_eq!(settled(&painter, &mut grid), 0, "what is the same is settled at once");
    }
}
