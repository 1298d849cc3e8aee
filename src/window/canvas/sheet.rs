//! A picture as far as it is painted, and its copy on the graphics card. The canvas has two: the
//! full one, and a smaller one during drags. Floor 7.

use super::blocks::{Magnification, ShownColors, TextureBlocks, checker_shape, corners, on_screen};
use crate::io::platform::Instant;
use crate::math::{Affine2, Rect, Size, vec2};
use crate::raster::{Tile, TileAt, TileGrid};
use crate::render_thread::RenderedTileBatch;
use eframe::egui;
use std::sync::Arc;
use std::time::Duration;

#[derive(Default)]
pub struct TileSheet {
    /// The picture as far as it is painted.
    pub grid: TileGrid,
    blocks: TextureBlocks,
    size: Option<Size>,
    /// Painted tiles that are not on the graphics card yet, and since when.
    unsent: Vec<TileAt>,
    unsent_since: Option<Instant>,
    /// They are uploaded although more is being painted.
    is_urgent: bool,
}

/// A redraw shorter than this is shown at once.
const WHOLE: Duration = Duration::from_millis(160);

impl TileSheet {
    /// Starts another picture and drops the last one.
    pub fn begin(&mut self, size: Size) {
        self.grid = TileGrid::default();
        self.grid.reserve(size.rect());
        self.blocks.begin(size);
        self.size = Some(size);
        self.unsent.clear();
        (self.unsent_since, self.is_urgent) = (None, false);
    }

    /// Shows a whole picture at once, until its tiles are painted.
    pub fn show(&mut self, picture: TileGrid) {
        self.unsent.extend(picture.iter().map(|(at, _)| at));
        self.grid = picture;
        self.is_urgent = true;
    }

    pub fn size(&self) -> Option<Size> {
        self.size
    }

    /// Takes painted tiles.
    pub fn take(&mut self, painted: RenderedTileBatch) {
        self.put(painted.tiles);
    }

    /// Takes tiles that must be shown at once.
    pub fn put(&mut self, tiles: Vec<(TileAt, Option<Arc<Tile>>)>) {
        for (at, tile) in tiles {
            self.grid.set(at, tile);
            self.unsent.push(at);
        }
    }

    /// Uploads tiles to the graphics card; returns a rectangle around them, empty if there are none.
    /// A drag shows complete pictures, never the tiles of two; a long redraw is shown in progress.
    pub fn send(&mut self, ctx: &egui::Context, is_busy: bool) -> Rect {
        if self.unsent.is_empty() {
            return Rect::EMPTY;
        }
        let since = *self.unsent_since.get_or_insert_with(Instant::now);
        if is_busy && since.elapsed() < WHOLE && !self.is_urgent {
            return Rect::EMPTY;
        }
        let sent = self.unsent.iter().fold(Rect::EMPTY, |all, at| all.union(at.rect()));
        (self.unsent_since, self.is_urgent) = (None, false);
        self.blocks.update(ctx, &self.grid, self.unsent.drain(..));
        sent
    }

    /// * `scale`: pixels of the screen per pixel of the canvas; and whether it is seen upright.
    /// * `canvas`: the size that the picture is drawn at.
    pub fn magnify(&mut self, (scale, is_upright): (f32, bool), canvas: Size) {
        let Some(size) = self.size else { return };
        // A smaller picture represents the canvas: its own pixels must not be visible.
        let own_scale = scale * canvas.width as f32 / size.width.max(1) as f32;
        let magnification = match Magnification::of(own_scale, is_upright) {
            Magnification::Squares if size != canvas => Magnification::Smooth,
            own => own,
        };
        self.blocks.magnify(magnification, &self.grid);
    }

    /// Shows it in other colors.
    pub fn show_in(&mut self, colors: &ShownColors) {
        self.blocks.show_in(colors, &self.grid);
    }

    /// Draws it where the canvas lies, as large as the canvas, and behind it squares where it may be
    /// transparent.
    pub fn draw(
        &self,
        painter: &egui::Painter,
        checker: egui::TextureId,
        screen_from_canvas: Affine2,
        canvas: Size,
    ) {
        let Some(size) = self.size else {
            // Nothing is painted yet.
            let at = corners(canvas.rect()).map(|(x, y)| on_screen(screen_from_canvas, x, y));
            painter.add(checker_shape(checker, at));
            return;
        };
        let scale = vec2(
            canvas.width as f32 / size.width as f32,
            canvas.height as f32 / size.height as f32,
        );
        self.blocks.draw(painter, checker, screen_from_canvas * Affine2::from_scale(scale));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stored_picture_is_sent_before_anything_is_painted() {
        let (ctx, mut sheet) = (egui::Context::default(), TileSheet::default());
        sheet.begin(Size::new(100, 80));
        sheet.show(TileGrid::from_straight_rgba(&[9, 90, 200, 255].repeat(8000), 100, 80, 0, 0));
        assert_eq!(sheet.grid.pixel(99, 79), [9, 90, 200, 255]);
        assert!(!sheet.send(&ctx, true).is_empty(), "though the thread is busy");
        let tiles = vec![(TileAt::of_pixel(0, 0), None)];
        let batch = RenderedTileBatch {
            picture: 1,
            is_draft: false,
            size: Size::new(100, 80),
            tiles,
            is_settled: false,
            took: Duration::ZERO,
            refused: None,
        };
        sheet.take(batch);
        assert_eq!((sheet.grid.pixel(0, 0), sheet.grid.pixel(99, 79)), ([0; 4], [9, 90, 200, 255]));
        assert!(sheet.send(&ctx, true).is_empty(), "tiles of a long redraw wait a little");
    }
}
