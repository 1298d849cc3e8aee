//! A picture as far as it is painted, and its copy on the graphics card. The canvas has two: the full one, and a
//! smaller one during drags. Floor 7.

use super::blocks::TextureBlocks;
use crate::math::{Affine2, Size, vec2};
use crate::raster::{TileAt, TileGrid};
use crate::render_thread::RenderedTileBatch;
use eframe::egui;
use std::time::{Duration, Instant};

#[derive(Default)]
pub struct TileSheet {
    /// The picture as far as it is painted.
    pub grid: TileGrid,
    blocks: TextureBlocks,
    size: Option<Size>,
    /// Painted tiles that are not on the graphics card yet, and since when.
    unsent: Vec<TileAt>,
    unsent_since: Option<Instant>,
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
        self.unsent_since = None;
    }
    pub fn size(&self) -> Option<Size> {
        self.size
    }
    /// Takes painted tiles.
    pub fn take(&mut self, painted: RenderedTileBatch) {
        for (at, tile) in painted.tiles {
            self.grid.set(at, tile);
            self.unsent.push(at);
        }
    }
    /// Uploads tiles to the graphics card; returns whether there were any. A drag shows complete pictures, never the
    /// tiles of two; a long redraw is shown in progress.
    pub fn send(&mut self, ctx: &egui::Context, is_busy: bool) -> bool {
        if self.unsent.is_empty() {
            return false;
        }
        let since = *self.unsent_since.get_or_insert_with(Instant::now);
        if is_busy && since.elapsed() < WHOLE {
            return false;
        }
        self.unsent_since = None;
        self.blocks.update(ctx, &self.grid, self.unsent.drain(..));
        true
    }
    pub fn set_sharp(&mut self, sharp: bool) {
        self.blocks.set_sharp(sharp, &self.grid);
    }
    /// Draws it where the canvas lies, as large as the canvas.
    pub fn draw(&self, painter: &egui::Painter, screen_from_canvas: Affine2, canvas: Size) {
        let Some(size) = self.size else { return };
        let scale = vec2(canvas.width as f32 / size.width as f32, canvas.height as f32 / size.height as f32);
        self.blocks.draw(painter, screen_from_canvas * Affine2::from_scale(scale));
    }
}
