//! Turns events of pen and mouse on the canvas into actions. Strokes are made of events, one sample
//! each, never of the pointer's position when a frame is drawn. Floor 7.

use super::barrel::Barrel;
use super::frame_input::{FrameInput, wheel};
use super::rulers;
use crate::math::{COORDINATE, Vec2, srgb::Color, vec2};
use crate::paint::{Curve, Sample};
use crate::pen::{
    FilteredReport, PenPhase, PenReport, PenSource, ReportFilter, SharedTablet, WindowPen,
};
use crate::preferences::{BarrelAction, PickKeys, Preferences};
use crate::session::actions::{EditAction, GuideAction, HandAction, PointerAction, ViewAction};
use crate::session::{Action, CanvasView, Session};
use crate::tools::{ModifierKeys, PenSample, ToolKind};
use eframe::egui::{
    CursorIcon, Event, Key, Modifiers, PointerButton, Popup, Pos2, Rect, Response, TouchPhase, Ui,
};

/// What the pointer is doing between press and release.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
enum PointerGesture {
    #[default]
    Nothing,
    Drawing,
    Panning,
    /// Zooming about the point where it began.
    Zooming {
        about: Pos2,
        moved: bool,
    },
    Turning,
    /// Changing the brush's size from what it was.
    Sizing {
        from: Pos2,
        size: f32,
    },
}

/// The greatest time and movement of a two-finger tap.
const TAP_SECS: f64 = 0.35;
const TAP_PT: f32 = 12.0;

/// The state between frames.
pub struct PointerState {
    holding: PointerGesture,
    /// The button that it began with.
    held_by: PointerButton,
    barrel: Barrel,
    last: Pos2,
    pen: WindowPen,
    /// While a stroke is drawn.
    watch: Option<ReportFilter>,
    /// Two fingers came down: when, and how far they moved since, points.
    tap: Option<(f64, f32)>,
    keys: Modifiers,
    space: bool,
    /// The canvas's area of the window.
    area: Rect,
    /// A guide is pulled out of a ruler.
    pulls: bool,
    /// What the pen reported in this frame.
    reports: Vec<PenReport>,
    /// The keys that take a color.
    pick_keys: PickKeys,
    /// From a pen's pressure to the one that is painted with.
    pressure: Curve,
    /// The first color before a color is taken.
    color_before: Option<Color>,
}

impl Default for PointerState {
    fn default() -> Self {
        Self {
            holding: PointerGesture::default(),
            held_by: PointerButton::Primary,
            barrel: Barrel::default(),
            last: Pos2::ZERO,
            pen: WindowPen::default(),
            watch: None,
            tap: None,
            keys: Modifiers::NONE,
            space: false,
            area: Rect::NOTHING,
            pulls: false,
            reports: Vec::new(),
            pick_keys: PickKeys::default(),
            pressure: Preferences::default().pressure,
            color_before: None,
        }
    }
}

impl PointerState {
    /// The tablet that the window's pointer may belong to.
    pub fn draw_on(&mut self, tablet: SharedTablet) {
        self.pen.on(tablet);
    }

    /// Whether the screen was touched with a finger since the program started.
    pub fn has_felt_fingers(&self) -> bool {
        self.pen.has_felt_fingers()
    }

    /// Uses the pen as the user prefers.
    pub fn prefer(&mut self, preferences: &Preferences) {
        self.pick_keys = preferences.pick_keys;
        self.barrel.prefer(preferences);
        self.pressure.clone_from(&preferences.pressure);
    }

    /// What the pen reported in this frame.
    pub fn reports(&self) -> &[PenReport] {
        &self.reports
    }

    /// The pen during a color's taking: where it is, and the color before.
    pub fn picking(&self) -> Option<(Pos2, Color)> {
        let is_held = self.holding == PointerGesture::Drawing;
        self.color_before.filter(|_| is_held).map(|before| (self.last, before))
    }

    /// Reads the events of a frame without a document.
    pub fn overhear(&mut self, ui: &Ui) {
        let (events, now_secs) = ui.input(|i| (i.events.clone(), i.time));
        self.reports.clear();
        for event in events {
            self.pen.read_event(&event, ui.ctx().pixels_per_point(), now_secs);
            self.reports.extend(std::iter::from_fn(|| self.pen.next()));
        }
    }

    /// All views of the window have read the events of a frame.
    pub fn end_frame(&mut self) {
        self.pen.end_frame();
    }

    /// Whether the view is being moved: then nothing is painted, and no brush cursor is shown.
    pub fn is_looking(&self) -> bool {
        matches!(
            self.holding,
            PointerGesture::Panning | PointerGesture::Zooming { .. } | PointerGesture::Turning
        ) || self.space
    }

    /// The current tool, or the one selected by a held key.
    pub fn tool(&self, session: &Session) -> ToolKind {
        // Alt sets the source point of a clone brush.
        let clones = session.tool == ToolKind::Brush && session.tools.brush.mode.is_clone();
        let paints = matches!(session.tool, ToolKind::Brush | ToolKind::Gradient) && !clones;
        let picks = paints
            && (self.pick_keys.are_held(self.keys) || self.barrel.is_held(BarrelAction::Pick));
        match self.holding {
            PointerGesture::Nothing if self.space => ToolKind::Hand,
            PointerGesture::Nothing if picks => ToolKind::Eyedropper,
            _ => session.tool,
        }
    }

    pub fn cursor(&self, session: &Session, on_canvas: bool) -> CursorIcon {
        match (self.holding, self.tool(session)) {
            (PointerGesture::Panning | PointerGesture::Turning, _) => CursorIcon::Grabbing,
            (PointerGesture::Zooming { .. }, _) => CursorIcon::ZoomIn,
            (PointerGesture::Sizing { .. }, _) => CursorIcon::ResizeHorizontal,
            (_, ToolKind::Hand) if self.keys.command && self.space => CursorIcon::ZoomIn,
            (_, ToolKind::Hand) => CursorIcon::Grab,
            (_, ToolKind::Zoom) if self.keys.alt => CursorIcon::ZoomOut,
            (_, ToolKind::Zoom) => CursorIcon::ZoomIn,
            (_, ToolKind::Move | ToolKind::Image) => CursorIcon::Move,
            (_, ToolKind::Text) if on_canvas => CursorIcon::Text,
            // The footprint's outline is the cursor.
            (_, ToolKind::Brush | ToolKind::Eraser | ToolKind::Sculpt | ToolKind::Liquify)
                if on_canvas =>
            {
                CursorIcon::None
            }
            _ => CursorIcon::Crosshair,
        }
    }

    /// Processes the events of a frame in order.
    pub fn listen(
        &mut self,
        ui: &Ui,
        canvas: &Response,
        session: &Session,
        view: &CanvasView,
        middle: Pos2,
        actions: &mut Vec<Action>,
    ) {
        let (events, now_secs, space) =
            ui.input(|i| (i.events.clone(), i.time, i.key_down(Key::Space)));
        self.space = space
            && (canvas.contains_pointer() || self.holding != PointerGesture::Nothing)
            && !ui.ctx().egui_wants_keyboard_input();
        self.keys = ui.input(|i| i.modifiers);
        let mut listening = FrameInput { session, view: *view, middle, actions, pens: Vec::new() };
        let is_in_front = |pos: Pos2| ui.ctx().layer_id_at(pos) == Some(canvas.layer_id);
        let ours = |pos: Pos2| canvas.rect.contains(pos) && is_in_front(pos);
        self.area = canvas.rect;
        self.reports.clear();
        if let Some(touch) =
            ui.input(|i| i.multi_touch()).filter(|touch| canvas.rect.contains(touch.center_pos))
        {
            self.two_fingers(
                touch.translation_delta,
                touch.zoom_delta,
                touch.rotation_delta,
                touch.center_pos,
                &mut listening,
            );
        }
        for event in events {
            self.pen.read_event(&event, ui.ctx().pixels_per_point(), now_secs);
            if let Event::Touch { phase, pos, .. } = &event {
                self.touch(*phase, ours(*pos), now_secs, &mut listening);
            }
            while let Some(report) = self.pen.next() {
                self.reports.push(report);
                self.follow_report(ui, canvas, &report, &mut listening);
            }
            match event {
                Event::Key { key: Key::Escape, pressed: true, .. }
                    if self.holding == PointerGesture::Drawing =>
                {
                    self.holding = PointerGesture::Nothing;
                    listening.pens.clear();
                    listening.actions.push(Action::Pointer(PointerAction::Cancel {}));
                }
                Event::MouseWheel { unit, delta, modifiers, .. } if canvas.contains_pointer() => {
                    wheel(unit, delta, modifiers, self.last, &mut listening);
                }
                Event::Zoom(factor) if canvas.contains_pointer() => {
                    listening.zoom(factor, self.last)
                }
                _ => {}
            }
        }
        listening.flush();
    }

    /// One report of the pen: a press on the canvas or its rulers, a move, a release.
    fn follow_report(
        &mut self,
        ui: &Ui,
        canvas: &Response,
        report: &PenReport,
        listening: &mut FrameInput,
    ) {
        let session = listening.session;
        let report = report.pressed_along(&self.pressure);
        let is_in_front = ui.ctx().layer_id_at(report.at) == Some(canvas.layer_id);
        let is_here = is_in_front && canvas.rect.contains(report.at);
        match report.phase {
            // A press outside an open menu closes it, and does nothing else.
            PenPhase::Down(_) if is_here && Popup::is_any_open(ui.ctx()) => {
                Popup::close_all(ui.ctx())
            }
            PenPhase::Down(button) if is_here && self.pen.touches() < 2 => {
                self.press(&report, button, listening);
            }
            PenPhase::Down(PointerButton::Primary)
                if is_in_front && rulers::is_on(canvas.rect, session, report.at) =>
            {
                self.pull(&report, canvas.rect, listening);
            }
            PenPhase::Down(_) => {}
            PenPhase::Move => self.move_to(&report, listening),
            PenPhase::Up(button) => {
                self.barrel.release(button);
                self.move_to(&report, listening);
                if button == self.held_by {
                    self.release(listening);
                }
            }
            PenPhase::Lost => {
                self.barrel.release_all();
                if self.holding == PointerGesture::Drawing {
                    self.release(listening);
                }
                self.holding = PointerGesture::Nothing;
            }
        }
    }

    /// A finger, or a pen that reports itself as one. A tap with two fingers is undo.
    fn touch(
        &mut self,
        phase: TouchPhase,
        is_here: bool,
        now_secs: f64,
        listening: &mut FrameInput,
    ) {
        let touches = self.pen.touches();
        match phase {
            TouchPhase::Start => self.tap = (touches == 2 && is_here).then_some((now_secs, 0.0)),
            TouchPhase::Cancel => self.tap = None,
            TouchPhase::End if touches == 0 => {
                let Some((began_secs, moved_pt)) = self.tap.take() else { return };
                if now_secs - began_secs < TAP_SECS && moved_pt < TAP_PT {
                    listening.actions.push(Action::Pointer(PointerAction::Cancel {}));
                    listening.actions.push(Action::Edit(EditAction::Undo {}));
                }
            }
            TouchPhase::End | TouchPhase::Move => {}
        }
    }

    fn press(&mut self, report: &PenReport, button: PointerButton, listening: &mut FrameInput) {
        let barrel = self.barrel.press(report, button);
        if self.holding != PointerGesture::Nothing {
            return;
        }
        let pos = report.at;
        (self.last, self.held_by) = (pos, button);
        // The same as with the buttons of a mouse.
        let button = match barrel {
            None => button,
            Some(BarrelAction::Size) => PointerButton::Secondary,
            Some(BarrelAction::Pan) => PointerButton::Middle,
            Some(BarrelAction::Turn) => return self.holding = PointerGesture::Turning,
            Some(BarrelAction::Undo) => {
                return listening.actions.push(Action::Edit(EditAction::Undo {}));
            }
            // They say what the tip does.
            Some(BarrelAction::Pick | BarrelAction::Erase | BarrelAction::Nothing) => return,
        };
        let session = listening.session;
        let erases = report.is_eraser || self.barrel.is_held(BarrelAction::Erase);
        let tool = match self.tool(session) {
            ToolKind::Brush if erases => ToolKind::Eraser,
            tool => tool,
        };
        let is_brush = matches!(tool, ToolKind::Brush | ToolKind::Eraser);
        self.holding = match (button, tool) {
            (PointerButton::Middle, _) => PointerGesture::Panning,
            (PointerButton::Secondary, ToolKind::Sculpt) => {
                PointerGesture::Sizing { from: pos, size: session.tools.shape.size }
            }
            (PointerButton::Secondary, ToolKind::Liquify) => {
                PointerGesture::Sizing { from: pos, size: session.tools.liquify.size }
            }
            (PointerButton::Secondary, _) if is_brush => {
                PointerGesture::Sizing { from: pos, size: session.tools.brush.size }
            }
            (PointerButton::Primary, ToolKind::Hand) if self.space && self.keys.command => {
                PointerGesture::Zooming { about: pos, moved: false }
            }
            (PointerButton::Primary, ToolKind::Hand) if self.keys.shift => PointerGesture::Turning,
            (PointerButton::Primary, ToolKind::Hand) => PointerGesture::Panning,
            (PointerButton::Primary, ToolKind::Zoom) => {
                PointerGesture::Zooming { about: pos, moved: false }
            }
            (PointerButton::Primary, _) => {
                let Some((watch, reading)) =
                    ReportFilter::begin(report, session.tools.presses_by_speed)
                else {
                    return;
                };
                self.watch = Some(watch);
                self.color_before = (tool == ToolKind::Eyedropper).then_some(session.tools.color);
                let (pen, px_per_pt) =
                    (self.reading(reading, listening), 1.0 / listening.view.zoom);
                listening.actions.push(Action::Pointer(PointerAction::Press {
                    tool,
                    pen,
                    px_per_pt,
                }));
                PointerGesture::Drawing
            }
            _ => PointerGesture::Nothing,
        };
    }

    /// A guide is pulled out of a ruler.
    fn pull(&mut self, report: &PenReport, area: Rect, listening: &mut FrameInput) {
        if self.holding != PointerGesture::Nothing {
            return;
        }
        let Some((watch, reading)) = ReportFilter::begin(report, false) else { return };
        (self.last, self.watch, self.pulls) = (report.at, Some(watch), true);
        self.held_by = PointerButton::Primary;
        let (pen, px_per_pt) = (self.reading(reading, listening), 1.0 / listening.view.zoom);
        let vertical = rulers::is_upright_pull(area, &listening.view, report.at);
        listening.actions.push(Action::Guide(GuideAction::Pull { vertical, pen, px_per_pt }));
        self.holding = PointerGesture::Drawing;
    }

    fn move_to(&mut self, report: &PenReport, listening: &mut FrameInput) {
        let (pos, by) = (report.at, report.at - self.last);
        if by == eframe::egui::Vec2::ZERO {
            return;
        }
        match self.holding {
            PointerGesture::Nothing => {}
            PointerGesture::Drawing => {
                // A pen with invalid reports ends its stroke at the last good one.
                let Some(reading) = self.watch.as_mut().and_then(|watch| watch.follow(report))
                else {
                    return self.release(listening);
                };
                listening.pens.push(self.reading(reading, listening));
            }
            PointerGesture::Panning => listening.view(ViewAction::Pan { by: vec2(by.x, by.y) }),
            PointerGesture::Zooming { about, .. } => {
                self.holding = PointerGesture::Zooming { about, moved: true };
                listening.zoom(((by.x - by.y) * 0.01).exp(), about);
            }
            PointerGesture::Turning => {
                let turn = |p: Pos2| (p - listening.middle).angle();
                listening.view(ViewAction::Turn { by_rad: turn(pos) - turn(self.last) });
            }
            PointerGesture::Sizing { from, size } => {
                let to = (size * ((pos.x - from.x) * 0.01).exp()).max(1.0);
                listening.actions.push(Action::Hand(HandAction::Size { to }));
            }
        }
        self.last = pos;
    }

    fn release(&mut self, listening: &mut FrameInput) {
        match self.holding {
            PointerGesture::Drawing => {
                let is_guide =
                    std::mem::take(&mut self.pulls) || listening.session.is_dragging_guide();
                if is_guide && rulers::is_on(self.area, listening.session, self.last) {
                    // A guide that is dropped on a ruler is removed.
                    listening.pens.push(PenSample::at(Vec2::splat(*COORDINATE.start())));
                }
                listening.flush();
                listening.actions.push(Action::Pointer(PointerAction::Release {}));
            }
            PointerGesture::Zooming { about, moved: false } => {
                let factor = if self.keys.alt { 1.0 / 1.5 } else { 1.5 };
                listening.zoom(factor, about);
            }
            _ => {}
        }
        self.holding = PointerGesture::Nothing;
    }

    fn two_fingers(
        &mut self,
        by: eframe::egui::Vec2,
        zoom: f32,
        turn_rad: f32,
        about: Pos2,
        listening: &mut FrameInput,
    ) {
        if self.holding == PointerGesture::Drawing {
            listening.actions.push(Action::Pointer(PointerAction::Cancel {}));
        }
        self.holding = PointerGesture::Nothing;
        if let Some((_, moved_pt)) = &mut self.tap {
            *moved_pt += by.length() + 100.0 * ((zoom - 1.0).abs() + turn_rad.abs());
        }
        listening.view(ViewAction::Pan { by: vec2(by.x, by.y) });
        listening.zoom(zoom, about);
        if turn_rad != 0.0 {
            listening.view(ViewAction::Turn { by_rad: turn_rad });
        }
    }

    fn reading(&self, reading: FilteredReport, listening: &FrameInput) -> PenSample {
        let sample = Sample {
            at: listening.on_canvas(reading.at),
            pressure: reading.pressure,
            tilt: vec2(reading.tilt.0, reading.tilt.1),
            time_secs: reading.secs,
        };
        let keys =
            ModifierKeys { shift: self.keys.shift, ctrl: self.keys.command, alt: self.keys.alt };
        PenSample { sample, keys }
    }
}
