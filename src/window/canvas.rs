//! The canvas: the picture in its view, and the pen on it. Floor 7. `sheet` holds the picture and
//! its copy on the graphics card, `pointer` turns events into actions, `marks` and `overlay` draw
//! what lies over the picture. Pixels come from the render thread.

mod ants;
mod assistants;
mod barrel;
mod blocks;
pub mod crop;
mod follow;
mod frame_input;
mod gizmo;
mod ground;
mod guides;
mod loupe;
mod marks;
mod navigator_picture;
mod overlay;
mod parts;
mod path_handles;
mod pointer;
mod rulers;
mod second_view;
mod sheet;
mod text_carets;
mod tool_keys;
mod unwrapped;
mod wobble;
mod words;

pub use overlay::load_texture;
pub use parts::ball;
pub use second_view::SecondView;

use super::pen::{PenReport, SharedTablet};
use super::preferences::Preferences;
use super::render_thread::RenderThread;
use super::theme;
use super::urgency::request_repaint_now;
use crate::Error;
use crate::document::Document;
use crate::io::proof::ProofTable;
use crate::language::tr;
use crate::math::srgb::Color;
use crate::math::{Affine2, ColorProfile, Rect, Size, Vec2, vec2};
use crate::session::actions::ViewAction;
use crate::session::{Action, CanvasView, OpenDocument, Session};
use crate::tools::ToolKind;
use ants::Ants;
use blocks::{ShownColors, ShownLook, corners, middle_on_pixels, on_screen, quad};
use eframe::egui::{self, Color32, Painter, Sense, Stroke, Ui, pos2};
use ground::{Checker, surround_shape};
use navigator_picture::{EVERYWHERE, NavigatorPicture};
use overlay::{Insets, Overlay};
use parts::PartMarks;
use pointer::PointerState;
use sheet::TileSheet;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;
use unwrapped::{OnSheet, UnwrappedSheet};
use wobble::Wobble;

/// The state of the canvas.
pub struct Canvas {
    /// Absent if the system cannot start a thread.
    render_thread: Option<RenderThread>,
    /// The picture in whole pixels.
    whole: TileSheet,
    /// A smaller version, while the user drags something that takes long to redraw.
    draft: TileSheet,
    is_draft_in_front: bool,
    /// The picture unwrapped, while that is shown.
    sheet: UnwrappedSheet,
    /// The open document that is shown, by its key, and the last request.
    picture: u64,
    key: Option<usize>,
    wanted: Option<(Document, bool)>,
    hand: PointerState,
    checker: Checker,
    overlay: Overlay,
    insets: Insets,
    ants: Ants,
    parts: PartMarks,
    wobble: Option<Wobble>,
    /// Whether pixels are enlarged while a color is taken.
    has_loupe: bool,
    /// How the picture will be printed, once a profile was chosen.
    pub proof: Option<Arc<ProofTable>>,
    /// What the numbers of the picture mean.
    profile: ColorProfile,
    /// The picture for the navigator, and where it is outdated.
    small: Option<NavigatorPicture>,
    small_changed: Rect,
    /// The size of the canvas's area, screen points.
    pub area_pt: Vec2,
    /// The same when each open document was last shown, by its key.
    areas_pt: BTreeMap<usize, Vec2>,
    /// The canvas pixel under the pointer.
    pub under: Option<Vec2>,
    /// Where the canvas was last shown on the screen, and in which part of it.
    shown_at: Option<(egui::Rect, Affine2)>,
    /// How long the last redraw took.
    pub took: Duration,
    pub is_busy: bool,
    /// Errors to report once.
    pub trouble: Option<Error>,
}

/// Where what helps the hand is drawn, and for which tool.
#[derive(Clone, Copy)]
struct AidsPlace {
    /// The canvas in the window.
    rect: egui::Rect,
    view: CanvasView,
    screen_from_canvas: Affine2,
    /// What is under the pointer, px of what is shown.
    under: Option<Vec2>,
    tool: ToolKind,
}

impl Canvas {
    pub fn new(ctx: &egui::Context) -> Self {
        let waker = ctx.clone();
        let wake = move || request_repaint_now(&waker);
        let (render_thread, trouble) = match RenderThread::new(wake) {
            Ok(thread) => (Some(thread), None),
            Err(error) => (None, Some(Error::io("painter", error))),
        };
        Self {
            render_thread,
            whole: TileSheet::default(),
            draft: TileSheet::default(),
            is_draft_in_front: false,
            sheet: UnwrappedSheet::default(),
            picture: 0,
            key: None,
            wanted: None,
            hand: PointerState::default(),
            checker: Checker::default(),
            overlay: Overlay::default(),
            insets: Insets::default(),
            ants: Ants::default(),
            parts: PartMarks::default(),
            wobble: None,
            has_loupe: true,
            proof: None,
            profile: ColorProfile::Srgb,
            small: None,
            small_changed: EVERYWHERE,
            area_pt: vec2(800.0, 600.0),
            areas_pt: BTreeMap::new(),
            under: None,
            shown_at: None,
            took: Duration::ZERO,
            is_busy: false,
            trouble,
        }
    }

    /// The tablet that the window's pointer may belong to.
    pub fn draw_on(&mut self, tablet: SharedTablet) {
        self.hand.draw_on(tablet);
    }

    /// Whether the screen was touched with a finger since the program started.
    pub fn has_felt_fingers(&self) -> bool {
        self.hand.has_felt_fingers()
    }

    /// Whether what is in sight of the document in front is still to be painted.
    pub fn is_painting(&self, session: &Session) -> bool {
        self.is_busy || session.active().is_some_and(|open| self.key != Some(open.key))
    }

    /// Works as the user prefers.
    pub fn prefer(&mut self, preferences: &Preferences) {
        self.hand.prefer(preferences);
        self.has_loupe = preferences.has_loupe;
    }

    /// What the pen reported in this frame.
    pub fn pens(&self) -> &[PenReport] {
        self.hand.reports()
    }

    /// The canvas point at a point of the screen, also beneath a dialog; `None` beside the canvas's
    /// area, and where the surface is shown unwrapped.
    pub fn canvas_at(&self, pos: egui::Pos2) -> Option<Vec2> {
        let (_, placed) = self.shown_at.filter(|(area, _)| area.contains(pos))?;
        Some(placed.inverse().transform_point2(vec2(pos.x, pos.y)))
    }

    /// Draws the canvas and requests what the pen does.
    pub fn show(&mut self, ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
        let whole = ui.available_rect_before_wrap();
        let rect = egui::Rect::from_min_max(
            whole.min + egui::Vec2::splat(rulers::room_pt(session)),
            whole.max,
        );
        let response = ui.allocate_rect(rect, Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, tr("Canvas")));
        self.area_pt = vec2(rect.width(), rect.height());
        let ground = ui.painter().rect_filled(rect, 0.0, theme::surround(ui.visuals()));
        let Some(open) = session.active() else { return self.hand.overhear(ui) };
        let area_before_pt = self.areas_pt.insert(open.key, self.area_pt).unwrap_or(self.area_pt);
        let Some(view) = open.view else {
            // The first view shows the whole canvas.
            actions.push(Action::View(ViewAction::Fit { window_pt: self.area_pt }));
            ui.ctx().request_repaint();
            return;
        };
        let layout = open.cached_layout();
        if open.unwrap_settings().is_some() && layout.is_none() {
            return words::show_sentence(ui, rect, "Unwrapping the surface…");
        }
        let size = open.shown_size();
        if self.has_to_fit(open, &view, area_before_pt) {
            actions.push(Action::View(ViewAction::Fit { window_pt: self.area_pt }));
            ui.ctx().request_repaint();
        }
        let per_point = ui.ctx().pixels_per_point();
        let middle = middle_on_pixels(rect, &view, per_point);
        let to_window = Affine2::from_translation(vec2(middle.x, middle.y));
        let screen_from_canvas = to_window * view.screen_from_canvas();
        self.shown_at = layout.is_none().then_some((rect, screen_from_canvas));
        self.follow(ui.ctx(), session, &view, rect);
        self.follow_unwrapped(ui.ctx(), layout.as_ref());
        self.magnify(&view, per_point, open.document().size, size);
        self.show_colors(session);

        let painter = ui.painter_at(rect);
        let canvas = size.rect();
        let outline = corners(canvas).map(|(x, y)| on_screen(screen_from_canvas, x, y));
        painter.set(ground, surround_shape(rect, outline, ui.visuals()));
        let checker = self.checker.texture(ui.ctx());
        let picture = self.texture_in_front(layout.is_some());
        picture.draw(&painter, checker, screen_from_canvas, size);
        if layout.is_none() {
            if self.is_wobbling(ui, open.shown_document(), &painter, screen_from_canvas) {
                return;
            }
            self.draw_overlay(ui.ctx(), session, &painter, screen_from_canvas);
        }
        let line = Stroke::new(1.0, Color32::from_black_alpha(110));
        painter.add(egui::Shape::closed_line(outline.to_vec(), line));

        if session.shows_saved {
            words::show_badge(ui, rect, words::AS_SAVED);
        }
        self.hand.listen(ui, &response, session, &view, middle, actions);
        let pointer = response.hover_pos().filter(|_| !self.hand.is_looking());
        let inverse = screen_from_canvas.inverse();
        let under = pointer.map(|p| inverse.transform_point2(vec2(p.x, p.y)));
        self.under = under.filter(|p| canvas.contains(p.x.floor() as i32, p.y.floor() as i32));
        let tool = self.hand.tool(session);
        let aids = AidsPlace { rect, view, screen_from_canvas, under, tool };
        match layout.as_ref().zip(open.document().surface.as_ref()) {
            Some((layout, surface)) => {
                self.under = self.under.and_then(|p| Some(layout.canvas_at(surface, p)?.at));
                self.draw_aids_unwrapped(&painter, session, OnSheet { layout, surface }, &aids);
            }
            None => {
                // What is asked for is done before the window is laid out once more, and seen there.
                let is_unseen = !actions.is_empty() && ui.ctx().current_pass_index() == 0;
                self.draw_aids(ui, &painter, session, &aids, is_unseen)
            }
        }
        tool_keys::listen(ui, session, actions);
        if tool == ToolKind::Anchors && layout.is_none() {
            self.insets.draw(ui.ctx(), session, &painter);
            self.trouble = self.trouble.take().or(self.insets.trouble.take());
        }
        self.draw_loupe(ui, self.hand.picking(), session, inverse, layout.is_some());
        if response.hovered() || self.hand.is_looking() {
            ui.ctx().set_cursor_icon(self.hand.cursor(session, under.is_some()));
        }
    }

    /// Says at what scale the pictures are seen: `size_px` and `sheet_px` are theirs.
    fn magnify(&mut self, view: &CanvasView, per_point: f32, size_px: Size, sheet_px: Size) {
        let seen = (view.zoom * per_point, view.turn_rad == 0.0);
        self.whole.magnify(seen, size_px);
        self.draft.magnify(seen, size_px);
        self.sheet.shown.magnify(seen, sheet_px);
    }

    /// Shows the pictures in their colors, in grays, or as they will be printed.
    fn show_colors(&mut self, session: &Session) {
        let proof = self.proof.clone().filter(|_| session.shows_proof);
        let look = match proof {
            _ if session.shows_values => ShownLook::Values,
            Some(table) => ShownLook::Proof { table, is_marked: session.marks_gamut },
            None => ShownLook::Own,
        };
        let profile = session.shown_document().map_or(ColorProfile::Srgb, |seen| seen.profile);
        if profile != self.profile {
            self.small_changed = EVERYWHERE;
        }
        self.profile = profile;
        let colors = ShownColors { profile, look };
        for sheet in [&mut self.whole, &mut self.draft, &mut self.sheet.shown] {
            sheet.show_in(&colors);
        }
    }

    /// Whether the picture is seen wobbling, or has just ended to: the event that ended it does
    /// nothing else.
    fn is_wobbling(
        &mut self,
        ui: &Ui,
        document: &Document,
        painter: &Painter,
        screen_from_canvas: Affine2,
    ) -> bool {
        let Some(wobble) = self.wobble.as_mut() else { return false };
        if wobble.is_going_on(ui, document) {
            wobble.draw(painter, screen_from_canvas);
        } else {
            self.wobble = None;
            ui.ctx().request_repaint();
        }
        true
    }

    /// What helps the hand, over the picture: guides, rulers, selections, the tool's own marks, which
    /// are left out of a layout that nobody sees: a bent outline takes as long as a panel.
    fn draw_aids(
        &mut self,
        ui: &Ui,
        painter: &Painter,
        session: &Session,
        aids: &AidsPlace,
        is_unseen: bool,
    ) {
        let AidsPlace { rect, view, screen_from_canvas, under, tool } = *aids;
        let visible = visible_rect(&view, rect);
        guides::draw(painter, session, &to_screen(screen_from_canvas), visible, view.zoom);
        rulers::draw(ui, session, rect, screen_from_canvas, under);
        self.ants.draw(painter, session, screen_from_canvas, visible);
        if !is_unseen {
            marks::draw(painter, session, screen_from_canvas, under, tool);
        }
        self.parts.draw(painter, session, screen_from_canvas, under, tool);
    }

    /// The same over the unwrapped surface.
    fn draw_aids_unwrapped(
        &mut self,
        painter: &Painter,
        session: &Session,
        on_sheet: OnSheet,
        aids: &AidsPlace,
    ) {
        let AidsPlace { screen_from_canvas, under, tool, .. } = *aids;
        guides::draw_unwrapped(painter, session, on_sheet, &to_screen(screen_from_canvas));
        self.ants.draw_unwrapped(painter, session, on_sheet, screen_from_canvas);
        marks::draw_unwrapped(painter, session, on_sheet.layout, screen_from_canvas, under, tool);
    }

    /// Whether a canvas that was wholly visible is so no more: the window, or it, has another size.
    fn has_to_fit(&self, open: &OpenDocument, view: &CanvasView, area_before_pt: Vec2) -> bool {
        let is_of_open = self.key == Some(open.key);
        let last = self.wanted.as_ref().filter(|_| is_of_open).map(|(last, _)| last.size);
        let is_window_resized = area_before_pt != self.area_pt
            && *view == CanvasView::fitting(open.shown_size(), area_before_pt);
        let is_resized = last.is_some_and(|last| {
            last != open.document().size && *view == CanvasView::fitting(last, self.area_pt)
        });
        is_window_resized || is_resized
    }

    /// What is drawn of the picture: the planes of its surface, a draft of it, or all of it.
    fn texture_in_front(&self, is_unwrapped: bool) -> &TileSheet {
        match () {
            () if is_unwrapped => &self.sheet.shown,
            () if self.is_draft_in_front => &self.draft,
            () => &self.whole,
        }
    }

    /// While a color is taken: the pixels around the pen, the new color and the one before.
    ///
    /// * `picking`: where the pen is, and the color before.
    fn draw_loupe(
        &self,
        ui: &Ui,
        picking: Option<(egui::Pos2, Color)>,
        session: &Session,
        canvas_from_screen: Affine2,
        is_unwrapped: bool,
    ) {
        let Some((at, before)) = picking.filter(|_| self.has_loupe) else { return };
        let pixel = canvas_from_screen.transform_point2(vec2(at.x, at.y));
        let grid = &self.texture_in_front(is_unwrapped).grid;
        let colors = loupe::LoupeColors { new: session.picked_color().unwrap_or(before), before };
        loupe::draw(ui, at, pixel, grid, colors);
    }

    /// Starts or stops swaying the picture by its depth.
    pub fn wobble(&mut self, ctx: &egui::Context, session: &Session) {
        self.wobble = match self.wobble {
            Some(_) => None,
            None => session
                .shown_document()
                .and_then(|document| Wobble::new(ctx, document, &self.whole.grid)),
        };
    }

    /// What is selected, as last drawn.
    pub fn selected_rect(&self) -> Option<Rect> {
        self.ants.bounds()
    }

    /// Draws the picture in another place, as far as it is painted.
    fn draw_elsewhere(
        &mut self,
        ctx: &egui::Context,
        session: &Session,
        painter: &Painter,
        screen_from_canvas: Affine2,
    ) {
        let Some(size) = session.shown_document().map(|document| document.size) else { return };
        let checker = self.checker.texture(ctx);
        self.texture_in_front(false).draw(painter, checker, screen_from_canvas, size);
        self.draw_overlay(ctx, session, painter, screen_from_canvas);
    }

    /// The window has read the pen's events of a frame, in all its views.
    pub fn end_frame(&mut self) {
        self.hand.end_frame();
    }

    fn draw_overlay(
        &mut self,
        ctx: &egui::Context,
        session: &Session,
        painter: &egui::Painter,
        screen_from_canvas: Affine2,
    ) {
        let texture = match self.overlay.texture(ctx, session) {
            Ok(Some(texture)) => texture,
            Ok(None) => return,
            Err(error) => return self.trouble = Some(error),
        };
        let Some(open) = session.active() else { return };
        let uv = [pos2(0.0, 0.0), pos2(1.0, 0.0), pos2(1.0, 1.0), pos2(0.0, 1.0)];
        let at =
            corners(open.document().size.rect()).map(|(x, y)| on_screen(screen_from_canvas, x, y));
        let corners = [0, 1, 2, 3].map(|i| (at[i], uv[i]));
        painter.add(quad(
            texture,
            corners,
            Color32::from_white_alpha((session.overlay_opacity * 255.0) as u8),
        ));
    }
}

/// The visible canvas pixels.
fn visible_rect(view: &CanvasView, area: egui::Rect) -> Rect {
    let inverse = view.canvas_from_screen();
    let half = vec2(area.width(), area.height()) * 0.5;
    let corners = [vec2(-1.0, -1.0), vec2(1.0, -1.0), vec2(1.0, 1.0), vec2(-1.0, 1.0)];
    let at = corners.map(|c| inverse.transform_point2(c * half));
    let low = at.iter().fold(Vec2::INFINITY, |low, p| low.min(*p));
    let high = at.iter().fold(Vec2::NEG_INFINITY, |high, p| high.max(*p));
    Rect::new(
        low.x.floor() as i32,
        low.y.floor() as i32,
        high.x.ceil() as i32,
        high.y.ceil() as i32,
    )
}

/// Where points of the canvas are on the screen.
fn to_screen(screen_from_canvas: Affine2) -> impl Fn(Vec2) -> egui::Pos2 {
    move |p| {
        let p = screen_from_canvas.transform_point2(p);
        pos2(p.x, p.y)
    }
}
