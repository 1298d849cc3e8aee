//! The small picture of the canvas, for the navigator and the preview of an export. Floor 7.

use crate::math::{Rect, Size};
use crate::raster::TileGrid;
use crate::reduce::Reduction;
use crate::theme::to_window;
use eframe::egui::{self, Color32, ColorImage, TextureHandle, TextureId, TextureOptions};

/// Its longer side, px.
const SIDE: u32 = 200;
/// All of any canvas.
pub const EVERYWHERE: Rect = Rect::new(0, 0, i32::MAX, i32::MAX);

pub struct NavigatorPicture {
    reduction: Reduction,
    /// In the document's profile.
    image: ColorImage,
    texture: TextureHandle,
}

impl NavigatorPicture {
    pub fn new(ctx: &egui::Context, canvas: Size, grid: &TileGrid) -> Self {
        let reduction = Reduction::new(canvas, SIDE);
        let image = reduction.reduce(|x, y| grid.pixel(x, y));
        let shown = in_the_window(&image);
        let texture = ctx.load_texture("navigator", shown, TextureOptions::LINEAR);
        Self { reduction, image, texture }
    }

    /// Shows another state of the picture, which differs in a rectangle, or one of another size.
    pub fn update(&mut self, ctx: &egui::Context, canvas: Size, grid: &TileGrid, changed: Rect) {
        if self.reduction != Reduction::new(canvas, SIDE) {
            *self = Self::new(ctx, canvas, grid);
            return;
        }
        self.reduction.update(&mut self.image, changed, |x, y| grid.pixel(x, y));
        self.texture.set(in_the_window(&self.image), TextureOptions::LINEAR);
    }

    pub fn id(&self) -> TextureId {
        self.texture.id()
    }
}

fn in_the_window(image: &ColorImage) -> ColorImage {
    let mut image = image.clone();
    if let Some(by) = to_window() {
        for pixel in &mut image.pixels {
            let [r, g, b, a] = by.premultiplied(pixel.to_array());
            *pixel = Color32::from_rgba_premultiplied(r, g, b, a);
        }
    }
    image
}
