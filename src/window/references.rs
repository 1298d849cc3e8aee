//! Pictures pinned over the canvas, to look at and to take colors from: they are part of no document.
//! Floor 7. Not here: how files become pictures (`file_pictures`).

use super::file_pictures::{FilePictures, PictureState};
use super::requests::UiRequests;
use super::theme::{self, ACCENT};
use crate::language::tr;
use crate::math::srgb::Color;
use crate::session::Action;
use crate::session::actions::HandAction;
use crate::tr;
use eframe::egui::{
    Align2, Area, Color32, ColorImage, Context, CursorIcon, Id, Order, Pos2, Rect, Response, Role,
    Sense, Slider, Stroke, StrokeKind, TextStyle, Ui, Vec2, WidgetInfo, pos2, vec2,
};
use serde_json::{Map, Value, json};
use std::path::PathBuf;

/// The most references.
const MOST: usize = 40;
/// The longer side of what is read of a file, px.
const SIDE_PX: u32 = 2048;
/// The width of a new one, and the range of widths, points.
const WIDTH_PT: f32 = 240.0;
const WIDTHS_PT: [f32; 2] = [48.0, 4000.0];
/// So much of one stays in sight, points.
const IN_SIGHT_PT: f32 = 32.0;
/// The side of the handle in its corner, points.
const HANDLE_PT: f32 = 18.0;
/// The range of opacities: one that is not seen could not be found.
const OPACITY: std::ops::RangeInclusive<f32> = 0.1..=1.0;
/// Height by width where the picture is not there yet.
const PLAIN_ASPECT: f32 = 0.75;

/// A picture that is pinned, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferencePin {
    pub file: PathBuf,
    /// Its upper left corner, points from that of the canvas's area.
    pub at: Vec2,
    pub width_pt: f32,
    pub opacity: f32,
    pub is_mirrored: bool,
}

impl ReferencePin {
    fn new(file: PathBuf, at: Vec2) -> Self {
        Self { file, at, width_pt: WIDTH_PT, opacity: 1.0, is_mirrored: false }
    }

    fn name(&self) -> String {
        self.file.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    fn to_json(&self) -> Value {
        let file = self.file.to_string_lossy();
        json!({
            "file": file, "x": self.at.x, "y": self.at.y, "width": self.width_pt,
            "opacity": self.opacity, "mirrored": self.is_mirrored,
        })
    }

    fn from_json(value: &Map<String, Value>) -> Option<Self> {
        let number = |name: &str, plain: f32| {
            let read = value.get(name).and_then(Value::as_f64).map(|v| v as f32);
            read.filter(|v| v.is_finite()).unwrap_or(plain)
        };
        let file = PathBuf::from(value.get("file")?.as_str()?);
        Some(Self {
            file,
            at: vec2(number("x", 0.0), number("y", 0.0)),
            width_pt: number("width", WIDTH_PT).max(WIDTHS_PT[0]).min(WIDTHS_PT[1]),
            opacity: number("opacity", 1.0).max(*OPACITY.start()).min(*OPACITY.end()),
            is_mirrored: value.get("mirrored").and_then(Value::as_bool).unwrap_or(false),
        })
    }
}

/// All that are pinned, the one in front last. Part of the settings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReferencePins(Vec<ReferencePin>);

impl ReferencePins {
    /// Pins a file; one that is pinned already comes to the front.
    pub fn pin(&mut self, file: PathBuf) {
        let found = self.0.iter().position(|pin| pin.file == file).map(|i| self.0.remove(i));
        // Each lies a little beside the one before.
        let at = Vec2::splat(24.0 * (1 + self.0.len() % 8) as f32);
        self.0.push(found.unwrap_or_else(|| ReferencePin::new(file, at)));
        let extra = self.0.len().saturating_sub(MOST);
        self.0.drain(..extra);
    }

    /// Removes all.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    pub fn to_json(&self) -> Value {
        Value::Array(self.0.iter().map(ReferencePin::to_json).collect())
    }

    /// What cannot be read is left out.
    pub fn from_json(value: Option<&Value>) -> Self {
        let pins = value.and_then(Value::as_array).into_iter().flatten();
        let pins = pins.filter_map(Value::as_object).filter_map(ReferencePin::from_json);
        Self(pins.take(MOST).collect())
    }
}

/// The pictures of what is pinned.
pub struct References {
    pictures: FilePictures,
}

impl Default for References {
    fn default() -> Self {
        Self { pictures: FilePictures::with_side(SIDE_PX) }
    }
}

/// What was asked for in the menu of a picture.
enum PinRequest {
    Front,
    Remove,
}

impl References {
    /// Shows what is pinned over the canvas.
    ///
    /// * `area`: of the canvas, in the window.
    /// * `is_picking`: whether a click takes a color.
    pub fn show(
        &mut self,
        ctx: &Context,
        area: Rect,
        pins: &mut ReferencePins,
        is_picking: bool,
        requests: &mut UiRequests,
    ) {
        let mut wanted = None;
        for (i, pin) in pins.0.iter_mut().enumerate() {
            let state = self.pictures.state(ctx, &pin.file);
            let id = Id::unique(("reference", &pin.file));
            let place = place_of(pin, state, area);
            let shown = Area::new(id).order(Order::Middle).fixed_pos(place.min).constrain(false);
            let asked = shown.show(ctx, |ui| {
                ui.set_clip_rect(area);
                let response = draw(ui, pin, state, place);
                if is_picking {
                    pick(ui, &response, pin, state, place, requests);
                } else {
                    move_pin(ui, &response, pin, place, area);
                }
                show_menu(&response, pin)
            });
            wanted = asked.inner.map(|asked| (i, asked)).or(wanted);
        }
        match wanted {
            Some((i, PinRequest::Front)) => {
                let pin = pins.0.remove(i);
                pins.0.push(pin);
            }
            Some((i, PinRequest::Remove)) => {
                let pin = pins.0.remove(i);
                self.pictures.forget(&pin.file);
            }
            None => {}
        }
    }
}

/// Where a picture lies in the window, as much of it in sight that it can be taken hold of.
fn place_of(pin: &ReferencePin, state: &PictureState, area: Rect) -> Rect {
    let aspect = match state {
        PictureState::Made(_, pixels) => pixels.size[1] as f32 / pixels.size[0].max(1) as f32,
        PictureState::Awaited | PictureState::Missing => PLAIN_ASPECT,
    };
    let size = vec2(pin.width_pt, pin.width_pt * aspect);
    let least = area.min + Vec2::splat(IN_SIGHT_PT) - size;
    let most = area.max - Vec2::splat(IN_SIGHT_PT);
    Rect::from_min_size((area.min + pin.at).max(least).min(most), size)
}

fn draw(ui: &mut Ui, pin: &ReferencePin, state: &PictureState, place: Rect) -> Response {
    let response = ui.allocate_rect(place, Sense::click_and_drag());
    let name = pin.name();
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, tr!("Reference {name}", name)));
    let painter = ui.painter();
    match state {
        PictureState::Made(texture, _) => {
            let (left, right) = if pin.is_mirrored { (1.0, 0.0) } else { (0.0, 1.0) };
            let uv = Rect { min: pos2(left, 0.0), max: pos2(right, 1.0) };
            painter.image(texture.id(), place, uv, Color32::WHITE.gamma_multiply(pin.opacity));
        }
        PictureState::Awaited | PictureState::Missing => {
            painter.rect_filled(place, 0.0, ui.visuals().panel_fill);
            let text = match state {
                PictureState::Missing => tr!("{name}\ncannot be shown", name),
                _ => name,
            };
            let font = TextStyle::Body.resolve(ui.style());
            let color = ui.visuals().weak_text_color();
            painter.text(place.center(), Align2::CENTER_CENTER, text, font, color);
        }
    }
    if response.contains_pointer() {
        painter.rect_stroke(place, 0.0, Stroke::new(1.0, ACCENT), StrokeKind::Inside);
        painter.rect_filled(handle_of(place), 2.0, ACCENT);
    }
    response
}

fn handle_of(place: Rect) -> Rect {
    Rect::from_min_max(place.max - Vec2::splat(HANDLE_PT), place.max)
}

/// A drag moves it, a drag of its corner and the wheel make it larger or smaller.
fn move_pin(ui: &Ui, response: &Response, pin: &mut ReferencePin, place: Rect, area: Rect) {
    let began = ui.input(|input| input.pointer.press_origin());
    let is_corner = |at: Pos2| handle_of(place).contains(at);
    let sizing = response.id.with("sizing");
    if response.drag_started() {
        let is_sizing = began.is_some_and(is_corner);
        ui.data_mut(|data| data.insert_temp(sizing, is_sizing));
    }
    let mut width_pt = pin.width_pt;
    if response.dragged() && ui.data(|data| data.get_temp(sizing)).unwrap_or(false) {
        width_pt += response.drag_delta().x;
    } else if response.dragged() {
        pin.at = place.min - area.min + response.drag_delta();
    }
    if response.hovered() {
        let (wheel, pinch) = ui.input(|i| (i.smooth_scroll_delta.y, i.zoom_delta()));
        width_pt *= (wheel * 0.003).exp() * pinch;
        let is_near = response.hover_pos().is_some_and(is_corner);
        let icon = if is_near { CursorIcon::ResizeNwSe } else { CursorIcon::Grab };
        ui.ctx().set_cursor_icon(icon);
    }
    pin.width_pt = width_pt.max(WIDTHS_PT[0]).min(WIDTHS_PT[1]);
}

/// The color under the pointer becomes the one in hand.
fn pick(
    ui: &Ui,
    response: &Response,
    pin: &ReferencePin,
    state: &PictureState,
    place: Rect,
    requests: &mut UiRequests,
) {
    ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
    let is_held = response.is_pointer_button_down_on() || response.clicked();
    let (PictureState::Made(_, pixels), true) = (state, is_held) else { return };
    let at = response.interact_pointer_pos().filter(|at| place.contains(*at));
    let Some(at) = at else { return };
    let mut share = (at - place.min) / place.size();
    if pin.is_mirrored {
        share.x = 1.0 - share.x;
    }
    if let Some(color) = color_at(pixels, share) {
        let color = theme::from_window(color);
        requests.act(Action::Hand(HandAction::Color { color }));
    }
}

/// The color of a picture at a share of its sides; `None` where it is transparent.
fn color_at(pixels: &ColorImage, share: Vec2) -> Option<Color> {
    let [width, height] = pixels.size;
    let index = |share: f32, n: usize| ((share * n as f32).max(0.0) as usize).min(n - 1);
    if width == 0 || height == 0 {
        return None;
    }
    let pixel = pixels.pixels[index(share.y, height) * width + index(share.x, width)];
    let [r, g, b, a] = pixel.to_srgba_unmultiplied();
    (a > 0).then(|| Color::rgb(r, g, b))
}

fn show_menu(response: &Response, pin: &mut ReferencePin) -> Option<PinRequest> {
    let mut asked = None;
    response.context_menu(|ui| {
        ui.label(pin.name());
        ui.add(Slider::new(&mut pin.opacity, OPACITY).text(tr("Opacity")));
        ui.checkbox(&mut pin.is_mirrored, tr("Mirrored"));
        if ui.button(tr("To the front")).clicked() {
            asked = Some(PinRequest::Front);
            ui.close();
        }
        if ui.button(tr("Remove reference")).clicked() {
            asked = Some(PinRequest::Remove);
            ui.close();
        }
    });
    asked
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn pins_are_kept_as_they_were_and_what_is_wrong_is_left_out() {
        let mut pins = ReferencePins::default();
        pins.pin("/a/cat.png".into());
        pins.pin("/a/dog.jpg".into());
        pins.0[0] = ReferencePin {
            at: vec2(-20.0, 33.5),
            width_pt: 500.0,
            opacity: 0.4,
            is_mirrored: true,
            ..pins.0[0].clone()
        };
        assert_eq!(ReferencePins::from_json(Some(&pins.to_json())), pins);
        // One that is pinned again comes to the front, where it was.
        pins.pin("/a/cat.png".into());
        let last = pins.0.last().unwrap();
        assert_eq!(
            (pins.0.len(), last.file.as_path(), last.width_pt),
            (2, Path::new("/a/cat.png"), 500.0)
        );
        (0..100).for_each(|i| pins.pin(format!("/a/{i}.png").into()));
        assert_eq!(pins.0.len(), MOST);
        let wrong = json!([{ "file": 3 }, 7, { "file": "x.png", "width": 1e30, "opacity": -2, "x": "left" }]);
        let read = ReferencePins::from_json(Some(&wrong));
        assert_eq!(read.0.len(), 1);
        let ReferencePin { at, width_pt, opacity, .. } = &read.0[0];
        assert_eq!((*at, *width_pt, *opacity), (Vec2::ZERO, WIDTHS_PT[1], *OPACITY.start()));
    }

    #[test]
    fn a_picture_stays_in_sight_and_gives_its_colors() {
        let area = Rect::from_min_size(pos2(50.0, 30.0), vec2(800.0, 600.0));
        for at in [vec2(-9000.0, -9000.0), vec2(9000.0, 9000.0), vec2(f32::MAX, 0.0)] {
            let pin = ReferencePin::new("a.png".into(), at);
            let seen = place_of(&pin, &PictureState::Awaited, area).intersect(area);
            assert!(
                seen.width() >= IN_SIGHT_PT && seen.height() >= IN_SIGHT_PT,
                "{at:?}: {seen:?}"
            );
        }
        let red = Color32::from_rgb(200, 10, 20);
        let pixels = ColorImage::new([2, 1], vec![red, Color32::TRANSPARENT]);
        assert_eq!(color_at(&pixels, vec2(0.2, 0.9)), Some(Color::rgb(200, 10, 20)));
        assert_eq!(color_at(&pixels, vec2(0.7, 0.2)), None);
        assert_eq!(color_at(&ColorImage::new([0, 0], Vec::new()), vec2(0.5, 0.5)), None);
    }
}
