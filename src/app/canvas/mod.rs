//! The canvas: the picture in its view, and the pen on it.
//! Floor 7. `blocks` holds the picture on the graphics card, `hand` turns events into actions, `marks` draws what lies over
//! the picture. Pixels come from the painter's thread.

mod blocks;
mod hand;
mod marks;

pub use marks::color32;

use super::painter::{Painter, Wanted};
use super::theme;
use crate::document::view::View as SurfaceView;
use crate::math::{Affine2, Rect, Size, Vec2, vec2};
use crate::raster::{Picture, TileAt, TileGrid};
use crate::session::actions::ViewAction;
use crate::session::{Action, Session, View, is_same};
use blocks::{Blocks, corners, on_screen, quad};
use eframe::egui::{
    self, Color32, ColorImage, Sense, Stroke, TextureHandle, TextureOptions, TextureWrapMode, Ui, pos2,
};
use hand::Hand;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// What the window knows of the canvas.
pub struct Canvas {
    painter: Painter,
    blocks: Blocks,
    /// The picture as far as it is painted.
    pub grid: TileGrid,
    /// Which tab's picture it is, and what was asked for last.
    picture: u64,
    tab: Option<usize>,
    wanted: Option<crate::document::Document>,
    hand: Hand,
    checker: Option<TextureHandle>,
    overlay: Overlay,
    /// The picture for the navigator, and whether it is older than the picture.
    small: Option<TextureHandle>,
    /// Tiles that were painted and are not on the graphics card yet, and since when.
    unsent: Vec<TileAt>,
    unsent_since: Option<Instant>,
    small_is_old: bool,
    /// Of the canvas's area, screen points.
    pub area_pt: Vec2,
    /// The canvas pixel under the pointer.
    pub under: Option<Vec2>,
    /// How long the last redraw took.
    pub took: Duration,
    pub is_busy: bool,
}

/// A redraw that takes no longer is shown at once.
const WHOLE: Duration = Duration::from_millis(160);

/// A view of the surface, drawn on a thread of its own.
#[derive(Default)]
struct Overlay {
    /// Which view of which surface, by its address.
    of: Option<(String, usize)>,
    coming: Option<Receiver<Option<Picture>>>,
    texture: Option<TextureHandle>,
}

impl Canvas {
    pub fn new(ctx: &egui::Context) -> Self {
        let waker = ctx.clone();
        Self {
            painter: Painter::new(move || waker.request_repaint()),
            blocks: Blocks::default(),
            grid: TileGrid::default(),
            picture: 0,
            tab: None,
            wanted: None,
            hand: Hand::default(),
            checker: None,
            overlay: Overlay::default(),
            small: None,
            unsent: Vec::new(),
            unsent_since: None,
            small_is_old: true,
            area_pt: vec2(800.0, 600.0),
            under: None,
            took: Duration::ZERO,
            is_busy: false,
        }
    }
    /// Draws the canvas and pushes what the pen does to it.
    pub fn show(&mut self, ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Canvas"));
        self.area_pt = vec2(rect.width(), rect.height());
        let dark = ui.visuals().dark_mode;
        ui.painter().rect_filled(rect, 0.0, theme::SURROUND[usize::from(!dark)]);
        let Some(tab) = session.tab() else { return };
        let Some(view) = tab.view else {
            // The first time it is seen, it is seen whole.
            actions.push(Action::View(ViewAction::Fit { window_pt: self.area_pt }));
            ui.ctx().request_repaint();
            return;
        };
        let middle = rect.center();
        let to_window = Affine2::from_translation(vec2(middle.x, middle.y));
        let screen_from_canvas = to_window * view.screen_from_canvas();
        self.follow(ui.ctx(), session, &view, rect);
        let pixels_per_point = ui.ctx().pixels_per_point();
        self.blocks.set_sharp(view.zoom * pixels_per_point >= 2.0, &self.grid);

        let painter = ui.painter_at(rect);
        let canvas = tab.document().size.rect();
        let shadow = corners(canvas).map(|(x, y)| on_screen(screen_from_canvas, x, y));
        self.draw_checker(ui, &painter, shadow);
        self.blocks.draw(&painter, screen_from_canvas);
        self.draw_overlay(ui.ctx(), session, &painter, screen_from_canvas);
        painter.add(egui::Shape::closed_line(shadow.to_vec(), Stroke::new(1.0, Color32::from_black_alpha(110))));

        self.hand.listen(ui, &response, session, &view, middle, actions);
        let pointer = response.hover_pos().filter(|_| !self.hand.is_looking());
        let inverse = screen_from_canvas.inverse();
        let under = pointer.map(|p| inverse.transform_point2(vec2(p.x, p.y)));
        self.under = under.filter(|p| canvas.contains(p.x.floor() as i32, p.y.floor() as i32));
        marks::draw(&painter, session, screen_from_canvas, under, self.hand.tool(session));
        if response.hovered() || self.hand.is_looking() {
            ui.ctx().set_cursor_icon(self.hand.cursor(session, under.is_some()));
        }
    }
    /// Asks for what is to be shown, and takes what was painted.
    fn follow(&mut self, ctx: &egui::Context, session: &Session, view: &View, area: egui::Rect) {
        let Some(tab) = session.tab() else { return };
        let drawn = tab.drawn();
        if self.tab != Some(tab.key) || self.wanted.as_ref().is_some_and(|old| old.size != drawn.size) {
            self.tab = Some(tab.key);
            self.picture += 1;
            self.grid = TileGrid::default();
            self.grid.reserve(drawn.size.rect());
            self.blocks.begin(drawn.size);
            self.unsent.clear();
            self.wanted = None;
        }
        if !self.wanted.as_ref().is_some_and(|old| is_same(old, &drawn)) {
            let visible = seen(view, area);
            self.painter.want(Wanted { picture: self.picture, document: drawn.clone(), visible });
            self.wanted = Some(drawn);
            self.is_busy = true;
        }
        for painted in self.painter.painted().filter(|painted| painted.picture == self.picture) {
            for (at, tile) in painted.tiles {
                self.grid.set(at, tile);
                self.unsent.push(at);
            }
            (self.took, self.is_busy) = (painted.took, !painted.is_settled);
        }
        if self.unsent.is_empty() {
            return;
        }
        // A drag shows whole pictures, not the tiles of two; a long redraw shows itself as it goes.
        let since = *self.unsent_since.get_or_insert_with(Instant::now);
        if self.is_busy && since.elapsed() < WHOLE {
            return;
        }
        self.unsent_since = None;
        self.small_is_old = true;
        self.blocks.update(ctx, &self.grid, self.unsent.drain(..));
    }
    /// The picture, small, for the navigator; made again when the painter rests.
    pub fn small(&mut self, ctx: &egui::Context, canvas: Size) -> Option<egui::TextureId> {
        const SIDE: u32 = 200;
        if self.small.is_none() || (self.small_is_old && !self.is_busy) {
            self.small_is_old = false;
            let step = canvas.width.max(canvas.height).div_ceil(SIDE).max(1);
            let (width, height) = (canvas.width.div_ceil(step), canvas.height.div_ceil(step));
            let pixel = |i: u32| {
                let (x, y) = (i % width * step + step / 2, i / width * step + step / 2);
                let at = |v: u32, n: u32| v.min(n - 1) as i32;
                let [r, g, b, a] = self.grid.pixel(at(x, canvas.width), at(y, canvas.height));
                Color32::from_rgba_premultiplied(r, g, b, a)
            };
            let image = ColorImage::new([width as usize, height as usize], (0..width * height).map(pixel).collect());
            self.small = Some(ctx.load_texture("navigator", image, TextureOptions::LINEAR));
        }
        self.small.as_ref().map(TextureHandle::id)
    }
    fn draw_checker(&mut self, ui: &Ui, painter: &egui::Painter, canvas: [egui::Pos2; 4]) {
        let [light, dark] = theme::CHECKER;
        let texture = self.checker.get_or_insert_with(|| {
            let image = ColorImage::new([2, 2], vec![light, dark, dark, light]);
            let options = TextureOptions { wrap_mode: TextureWrapMode::Repeat, ..TextureOptions::NEAREST };
            ui.ctx().load_texture("checker", image, options)
        });
        const SQUARES_PT: f32 = 16.0;
        let uv = canvas.map(|p| (p, pos2(p.x / SQUARES_PT, p.y / SQUARES_PT)));
        painter.add(quad(texture.id(), uv, Color32::WHITE));
    }
    fn draw_overlay(
        &mut self,
        ctx: &egui::Context,
        session: &Session,
        painter: &egui::Painter,
        screen_from_canvas: Affine2,
    ) {
        let Some(texture) = self.overlay.texture(ctx, session) else { return };
        let Some(tab) = session.tab() else { return };
        let uv = [pos2(0.0, 0.0), pos2(1.0, 0.0), pos2(1.0, 1.0), pos2(0.0, 1.0)];
        let at = corners(tab.document().size.rect()).map(|(x, y)| on_screen(screen_from_canvas, x, y));
        let corners = [0, 1, 2, 3].map(|i| (at[i], uv[i]));
        painter.add(quad(texture, corners, Color32::from_white_alpha((session.overlay_opacity * 255.0) as u8)));
    }
}

impl Overlay {
    /// The overlay that is wanted, once it is drawn.
    fn texture(&mut self, ctx: &egui::Context, session: &Session) -> Option<egui::TextureId> {
        let name = session.overlay.as_deref()?;
        let view = SurfaceView::from_name(name)?;
        let document = session.shown()?;
        let layer = session.layer().cloned();
        let identity = if view.is_of_layer() {
            layer.as_ref().map_or(0, |layer| std::sync::Arc::as_ptr(layer) as usize)
        } else {
            document.surface.as_ref().map_or(0, |surface| std::sync::Arc::as_ptr(surface) as usize)
        };
        let of = Some((name.to_owned(), identity));
        if self.of != of && self.coming.is_none() {
            self.of = of;
            let (sender, coming) = channel();
            self.coming = Some(coming);
            let (document, waker) = (document.clone(), ctx.clone());
            let draw = move || {
                let layer = layer.as_deref().filter(|_| view.is_of_layer());
                let picture = crate::document::view::draw(&document, layer, view, &Default::default()).ok();
                let _ = sender.send(picture);
                waker.request_repaint();
            };
            let _ = std::thread::Builder::new().name("overlay".into()).spawn(draw);
        }
        if let Some(done) = self.coming.as_ref().and_then(|coming| coming.try_recv().ok()) {
            self.coming = None;
            self.texture = done.and_then(|picture| loaded(ctx, "overlay", &picture));
        }
        self.texture.as_ref().map(TextureHandle::id)
    }
}

/// A picture as a texture, shrunk to what any driver takes.
pub fn loaded(ctx: &egui::Context, name: &str, picture: &Picture) -> Option<TextureHandle> {
    const LARGEST: u32 = 2048;
    let longer = picture.size.width.max(picture.size.height);
    let step = longer.div_ceil(LARGEST).max(1) as usize;
    let (width, height) = (picture.size.width as usize / step, picture.size.height as usize / step);
    let texel = |x: usize, y: usize| match &picture.texels {
        crate::raster::picture::Texels::Srgb8(texels) => texels[y * picture.size.width as usize + x],
        crate::raster::picture::Texels::Linear(_) => {
            let encode = |v: f32| crate::math::srgb::quantise(crate::math::srgb::encode(v));
            let [r, g, b, a] = picture.linear_at(x, y);
            [encode(r), encode(g), encode(b), crate::math::srgb::quantise(a)]
        }
    };
    if width == 0 || height == 0 {
        return None;
    }
    let pixels = (0..width * height).map(|i| {
        let [r, g, b, a] = texel(i % width * step, i / width * step);
        Color32::from_rgba_unmultiplied(r, g, b, a)
    });
    Some(ctx.load_texture(name, ColorImage::new([width, height], pixels.collect()), TextureOptions::LINEAR))
}

/// The canvas pixels in sight.
fn seen(view: &View, area: egui::Rect) -> Rect {
    let inverse = view.canvas_from_screen();
    let half = vec2(area.width(), area.height()) * 0.5;
    let corners = [vec2(-1.0, -1.0), vec2(1.0, -1.0), vec2(1.0, 1.0), vec2(-1.0, 1.0)];
    let at = corners.map(|c| inverse.transform_point2(c * half));
    let low = at.iter().fold(Vec2::INFINITY, |low, p| low.min(*p));
    let high = at.iter().fold(Vec2::NEG_INFINITY, |high, p| high.max(*p));
    Rect::new(low.x.floor() as i32, low.y.floor() as i32, high.x.ceil() as i32, high.y.ceil() as i32)
}
