//! The painted balls that come with the program, to choose from. Floor 7.

use super::setter::LayerSetter;
use crate::io::recipe::PaintedBall;
use crate::language::tr;
use crate::math::srgb;
use crate::raster::Picture;
use crate::session::Action;
use crate::session::actions::LayerAction;
use crate::tr;
use crate::widgets::set_accessible_name;
use eframe::egui::load::SizedTexture;
use eframe::egui::{self, Color32, ColorImage, Id, TextureHandle, TextureOptions, Ui, vec2};
use std::collections::HashMap;

/// The side of a picture, px.
const SIDE: usize = 48;

/// What was made of the balls so far, by their keys.
type Made = HashMap<&'static str, TextureHandle>;

/// A button for each ball: a click gives the layer that ball.
pub fn chooser(ui: &mut Ui, setter: &mut LayerSetter) {
    let id = Id::unique("pictures of balls");
    let mut made = ui.data(|data| data.get_temp::<Made>(id)).unwrap_or_default();
    // One a frame: reading them takes a moment.
    if let Some(ball) = PaintedBall::all().find(|ball| !made.contains_key(ball.key)) {
        let image = ball.picture().map(|picture| small(&picture));
        let image = image.unwrap_or_else(|_| ColorImage::filled([1, 1], Color32::GRAY));
        made.insert(ball.key, ui.ctx().load_texture(ball.key, image, TextureOptions::LINEAR));
        ui.data_mut(|data| data.insert_temp(id, made.clone()));
        ui.ctx().request_repaint();
    }
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(3.0, 3.0);
        for ball in PaintedBall::all() {
            let Some(texture) = made.get(ball.key) else { continue };
            let name = tr(ball.name);
            let shown = SizedTexture::new(texture.id(), vec2(36.0, 36.0));
            let response = ui.add(egui::Button::image(shown).frame(false));
            let response = response.on_hover_text(tr!("{ball}: a painted ball", ball = name));
            set_accessible_name(&response, &tr!("Ball: {ball}", ball = name));
            if response.clicked() {
                let (layer, name) = (setter.layer.clone(), ball.key.to_owned());
                let action = LayerAction::PaintedBall { layer, name, hollows: false };
                setter.requests.act(Action::Layer(action));
            }
        }
    });
}

/// The disc of a ball's picture, small.
fn small(picture: &Picture) -> ColorImage {
    let pixel = |i: usize| {
        let at = |v: usize, of: u32| ((v as f32 + 0.5) / SIDE as f32 * of as f32) as usize;
        let (x, y) = (i % SIDE, i / SIDE);
        let from_middle = |v: usize| v as f32 + 0.5 - 0.5 * SIDE as f32;
        let away = from_middle(x).hypot(from_middle(y));
        let [r, g, b, _] = picture.linear_at(at(x, picture.size.width), at(y, picture.size.height));
        let byte = |light: f32| srgb::quantize(srgb::encode(light));
        let alpha = srgb::quantize((0.5 * SIDE as f32 - away).max(0.0).min(1.0));
        Color32::from_rgba_unmultiplied(byte(r), byte(g), byte(b), alpha)
    };
    ColorImage::new([SIDE, SIDE], (0..SIDE * SIDE).map(pixel).collect())
}
