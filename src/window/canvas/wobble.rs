//! The picture swaying by its depth, so that the relief shows, until a key or a click. Floor 7. Not
//! here: the picture seen from aside (`document::view::wobble`).

use super::blocks::{corners, on_screen, quad};
use crate::document::Document;
use crate::document::view::wobble::WobbleScene;
use crate::math::Affine2;
use crate::raster::TileGrid;
use crate::session::is_same_look;
use crate::theme::to_window;
use eframe::egui::{
    Color32, ColorImage, Context, Event, Painter, TextureHandle, TextureOptions, Ui, pos2,
};

/// How far the viewer moves to each side, and the time of both ways.
const MOST_RAD: f32 = 10.0 * std::f32::consts::PI / 180.0;
const SECS: f64 = 3.2;
/// The most px of a side that sways: enough to see the form, few enough to be drawn again for every
/// frame.
const LONGEST: u32 = 900;

/// The picture that sways.
pub struct Wobble {
    of: Document,
    scene: WobbleScene,
    since_secs: f64,
    texture: Option<TextureHandle>,
}

impl Wobble {
    /// `flat`: the finished picture. `None` if there is no depth.
    pub fn new(ctx: &Context, document: &Document, flat: &TileGrid) -> Option<Self> {
        let scene = WobbleScene::new(flat, document.surface.as_ref()?, LONGEST);
        let since_secs = ctx.input(|input| input.time);
        Some(Self { of: document.clone(), scene, since_secs, texture: None })
    }

    /// Whether it continues: nothing was pressed, and the document is the same.
    pub fn is_going_on(&self, ui: &Ui, document: &Document) -> bool {
        let stops = |event: &Event| {
            matches!(
                event,
                Event::Key { pressed: true, repeat: false, .. }
                    | Event::PointerButton { pressed: true, .. }
            )
        };
        is_same_look(&self.of, document) && !ui.input(|input| input.events.iter().any(stops))
    }

    pub fn draw(&mut self, painter: &Painter, screen_from_canvas: Affine2) {
        let turn = (painter.ctx().input(|input| input.time) - self.since_secs) / SECS;
        let angle = MOST_RAD * (std::f64::consts::TAU * turn).sin() as f32;
        let size = self.scene.size();
        let seen = self.scene.render_from(angle);
        let pixels = seen
            .into_iter()
            .map(|texel| to_window().map_or(texel, |by| by.premultiplied(texel)))
            .map(|[r, g, b, a]| Color32::from_rgba_premultiplied(r, g, b, a))
            .collect();
        let image = ColorImage::new([size.width as usize, size.height as usize], pixels);
        let texture = match &mut self.texture {
            Some(texture) => {
                texture.set(image, TextureOptions::LINEAR);
                texture
            }
            None => self.texture.insert(painter.ctx().load_texture(
                "wobble",
                image,
                TextureOptions::LINEAR,
            )),
        };
        let uv = [pos2(0.0, 0.0), pos2(1.0, 0.0), pos2(1.0, 1.0), pos2(0.0, 1.0)];
        let at = corners(self.of.size.rect()).map(|(x, y)| on_screen(screen_from_canvas, x, y));
        painter.add(quad(texture.id(), [0, 1, 2, 3].map(|i| (at[i], uv[i])), Color32::WHITE));
        painter.ctx().request_repaint();
    }
}
