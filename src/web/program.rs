//! The window in its worker: events in, a painted canvas and messages out. Floor 8.

use crate::dropped::DroppedDocument;
use crate::events::{self, PointerInput, PointerPhase, Pointers};
use crate::page;
use eframe::App;
use eframe::egui::{
    self, Context, Event, FullOutput, Modifiers, OutputCommand, PlatformOutput, Pos2, RawInput,
    Rect, ViewportCommand, ViewportId, pos2, vec2,
};
use egui_glow::{Painter, glow};
use rilievo_io::platform::{self, DOCUMENTS};
use rilievo_window::{MainWindow, SharedTablet};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use wasm_bindgen::prelude::*;
use web_sys::{OffscreenCanvas, WebGl2RenderingContext};

/// When the next frame is due, ms of the page's clock; any thread may bring it forward.
#[derive(Default)]
struct NextFrame(AtomicU64);

impl NextFrame {
    fn bring_forward(&self, to_ms: u64) {
        self.0.fetch_min(to_ms, Ordering::Relaxed);
    }

    /// Whether it is due; then none is any more.
    fn is_due(&self, now_ms: u64) -> bool {
        let is_due = self.0.load(Ordering::Relaxed) <= now_ms;
        if is_due {
            self.0.store(u64::MAX, Ordering::Relaxed);
        }
        is_due
    }
}

/// The program in the worker that it runs in.
#[wasm_bindgen]
pub struct Program {
    ctx: Context,
    window: MainWindow,
    painter: Painter,
    canvas: OffscreenCanvas,
    pointers: Pointers,
    input: RawInput,
    modifiers: Modifiers,
    /// Of the screen, for a point of style sheets.
    px_per_css: f32,
    size_css: egui::Vec2,
    next: Arc<NextFrame>,
    /// The page's clock at the last frame, ms.
    now_ms: f64,
    cursor: &'static str,
    is_editing: bool,
}

#[wasm_bindgen]
impl Program {
    /// The program that paints on a canvas, with so many threads.
    ///
    /// * `files`: documents to open, by their paths.
    /// * `sample`: the name of the sample that is opened if there are none.
    ///
    /// Fails if the browser has no WebGL 2.
    #[wasm_bindgen(constructor)]
    pub fn new(
        canvas: OffscreenCanvas,
        threads: usize,
        is_mac: bool,
        files: Vec<String>,
        sample: &str,
    ) -> Result<Program, JsValue> {
        std::panic::set_hook(Box::new(|panic| page::error(&panic.to_string())));
        start_threads(threads).map_err(|error| JsValue::from_str(&error))?;
        let painter = painter(&canvas)?;
        let ctx = Context::default();
        if is_mac {
            ctx.set_os(egui::os::OperatingSystem::Mac);
        }
        ctx.options_mut(|options| options.zoom_with_keyboard = false);
        let next = Arc::new(NextFrame::default());
        let asked = next.clone();
        ctx.set_request_repaint_callback(move |info| {
            let delay_ms = info.delay.as_millis().min(u128::from(u64::MAX / 2)) as u64;
            asked.bring_forward(page_ms().saturating_add(delay_ms));
        });
        let tablet = SharedTablet::default();
        let files: Vec<PathBuf> = files.into_iter().map(PathBuf::from).collect();
        let has_none = files.is_empty();
        let mut window = MainWindow::of_user(&ctx, tablet.clone(), files);
        if has_none {
            window.open_sample_named(sample);
        }
        let input = RawInput {
            max_texture_side: Some(painter.max_texture_side()),
            focused: true,
            ..RawInput::default()
        };
        Ok(Self {
            ctx,
            window,
            painter,
            canvas,
            pointers: Pointers::new(tablet),
            input,
            modifiers: Modifiers::default(),
            px_per_css: 1.0,
            size_css: vec2(1.0, 1.0),
            next,
            now_ms: 0.0,
            cursor: "",
            is_editing: false,
        })
    }

    /// The canvas has another size, in points of style sheets, each of so many px.
    pub fn resize(&mut self, width: f32, height: f32, px_per_css: f32) {
        self.size_css = vec2(width.max(1.0), height.max(1.0));
        self.px_per_css = px_per_css.max(0.1);
        let size = self.size_px();
        self.canvas.set_width(size[0]);
        self.canvas.set_height(size[1]);
        self.wake();
    }

    /// Something happened with a pointer at a place of the canvas.
    ///
    /// * `kind`: 0 for a mouse, 1 for a pen, 2 for its eraser, 3 for a finger.
    /// * `phase`: 0 down, 1 move, 2 up, 3 canceled, 4 gone.
    /// * `tilt_x`, `tilt_y`: degrees.
    #[allow(clippy::too_many_arguments)] // One call for each event, and as it comes.
    pub fn pointer(
        &mut self,
        kind: u8,
        phase: u8,
        id: u32,
        x: f32,
        y: f32,
        button: i16,
        held: u8,
        pressure: f32,
        tilt_x: f32,
        tilt_y: f32,
    ) {
        let modifiers = self.hold(held);
        let input = PointerInput {
            phase: PointerPhase::of(phase),
            at: self.place(x, y),
            button,
            modifiers,
            id,
            pressure,
            tilt: (tilt_x, tilt_y),
        };
        let (px_per_pt, events) = (self.px_per_pt(), &mut self.input.events);
        match kind {
            1 | 2 => self.pointers.move_pen(input, kind == 2, px_per_pt, events),
            3 => self.pointers.move_finger(input, events),
            _ => self.pointers.move_mouse(input, px_per_pt, events),
        }
        self.wake();
    }

    /// The wheel turned; `mode` is the event's `deltaMode`. Two fingers on a touchpad come as a wheel
    /// with Ctrl, too.
    pub fn wheel(&mut self, x: f32, y: f32, mode: u32, held: u8) {
        let event = events::wheel(vec2(x, y), mode, events::modifiers(held));
        self.push(event);
    }

    /// A key went down or up, by the event's `key` and `code`.
    pub fn key(&mut self, key: &str, code: &str, pressed: bool, held: u8) {
        let modifiers = self.hold(held);
        if let Some(event) = events::key(key, code, pressed, modifiers) {
            self.push(event);
        }
        self.wake();
    }

    /// A text was typed.
    pub fn text(&mut self, text: String) {
        self.push(Event::Text(text));
    }

    /// A text was pasted while a text is edited.
    pub fn paste(&mut self, text: String) {
        self.push(Event::Paste(text));
    }

    /// The page got or lost the focus.
    pub fn focus(&mut self, is_focused: bool) {
        self.input.focused = is_focused;
        if !is_focused {
            self.hold(0);
        }
        self.push(Event::WindowFocused(is_focused));
    }

    /// Files were dropped at a place; they are among the page's files already.
    pub fn drop(&mut self, names: Vec<String>, x: f32, y: f32) {
        let at = self.place(x, y);
        self.input.events.push(Event::PointerMoved(at));
        let files = names.iter().map(|name| Path::new(DOCUMENTS).join(name));
        let dropped = files.map(|file| Arc::new(DroppedDocument(file)) as _);
        self.input.dropped_files.extend(dropped);
        self.wake();
    }

    /// Paints a frame, if one is due at this time of the page's clock; whether it did.
    #[wasm_bindgen(js_name = tryFrame)]
    pub fn try_frame(&mut self, now_ms: f64) -> bool {
        if !self.next.is_due(page_ms()) {
            return false;
        }
        self.now_ms = now_ms;
        let mut input = self.take_input();
        let (ctx, window) = (self.ctx.clone(), &mut self.window);
        window.raw_input_hook(&ctx, &mut input);
        let output = ctx.run_ui(input, |ui| window.show(ui));
        self.paint(output);
        true
    }
}

impl Program {
    fn wake(&self) {
        self.next.bring_forward(0);
    }

    fn push(&mut self, event: Event) {
        self.input.events.push(event);
        self.wake();
    }

    fn hold(&mut self, held: u8) -> Modifiers {
        let modifiers = events::modifiers(held);
        if modifiers != std::mem::replace(&mut self.modifiers, modifiers) {
            self.input.events.push(Event::ModifiersChanged(modifiers));
        }
        modifiers
    }

    fn place(&self, x: f32, y: f32) -> Pos2 {
        let zoom = self.ctx.zoom_factor();
        pos2(x / zoom, y / zoom)
    }

    fn px_per_pt(&self) -> f32 {
        self.px_per_css * self.ctx.zoom_factor()
    }

    fn size_px(&self) -> [u32; 2] {
        let size = self.size_css * self.px_per_css;
        [size.x, size.y].map(|side| side.round().max(1.0) as u32)
    }

    fn take_input(&mut self) -> RawInput {
        let points = self.size_css / self.ctx.zoom_factor();
        self.input.screen_rect = Some(Rect::from_min_size(Pos2::ZERO, points));
        self.input.time = Some(self.now_ms / 1000.0);
        let viewport = self.input.viewports.entry(ViewportId::ROOT).or_default();
        viewport.native_pixels_per_point = Some(self.px_per_css);
        viewport.focused = Some(self.input.focused);
        self.input.take()
    }

    fn paint(&mut self, output: FullOutput) {
        let FullOutput {
            platform_output,
            mut textures_delta,
            shapes,
            pixels_per_point,
            viewport_output,
        } = output;
        self.tell(platform_output);
        for command in viewport_output.into_values().flat_map(|viewport| viewport.commands) {
            if let ViewportCommand::Title(title) = command {
                page::set_title(&title);
            }
        }
        let primitives = self.ctx.tessellate(shapes, pixels_per_point);
        let size = self.size_px();
        egui_glow::painter::clear(self.painter.gl(), size, [0.0, 0.0, 0.0, 1.0]);
        self.painter.paint_and_update_textures(
            size,
            pixels_per_point,
            &primitives,
            &mut textures_delta,
        );
    }

    /// Tells the page what it does for the window.
    fn tell(&mut self, output: PlatformOutput) {
        let cursor = page_cursor(output.cursor_icon);
        if cursor != std::mem::replace(&mut self.cursor, cursor) {
            page::set_cursor(cursor);
        }
        for command in output.commands {
            match command {
                OutputCommand::CopyText(text) => platform::tell("copied text", &text, &[]),
                OutputCommand::OpenUrl(open) => page::open_address(&open.url),
                _ => {}
            }
        }
        let was_editing = std::mem::replace(&mut self.is_editing, output.ime.is_some());
        match output.ime {
            Some(ime) => {
                let (rect, zoom) = (ime.cursor_rect, self.ctx.zoom_factor());
                let [x, y] = [rect.min.x * zoom, rect.min.y * zoom];
                page::edit_text(x, y, rect.width() * zoom, rect.height() * zoom);
            }
            None if was_editing => page::end_text(),
            None => {}
        }
    }
}

/// Now, by the page's clock, ms.
fn page_ms() -> u64 {
    let now = platform::SystemTime::now().duration_since(platform::UNIX_EPOCH);
    now.map_or(0, |since| since.as_millis() as u64)
}

/// The threads that paint together.
fn start_threads(count: usize) -> Result<(), String> {
    platform::set_thread_count(count);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(count.max(1))
        .spawn_handler(|thread| platform::spawn("painting", move || thread.run()).map(drop));
    pool.build_global().map_err(|error| error.to_string())
}

fn painter(canvas: &OffscreenCanvas) -> Result<Painter, JsValue> {
    let missing = || JsValue::from_str("this browser has no WebGL 2 to draw with");
    let found = canvas.get_context("webgl2")?.ok_or_else(missing)?;
    let gl = found.dyn_into::<WebGl2RenderingContext>().map_err(|_| missing())?;
    #[allow(clippy::arc_with_non_send_sync)] // The painter asks for it, and stays in this worker.
    let gl = Arc::new(glow::Context::from_webgl2_context(gl));
    Painter::new(gl, "", None, false).map_err(|error| JsValue::from_str(&error.to_string()))
}

/// The style sheets' name of a pointer.
fn page_cursor(icon: egui::CursorIcon) -> &'static str {
    use egui::CursorIcon as Icon;
    match icon {
        Icon::None => "none",
        Icon::ContextMenu => "context-menu",
        Icon::Help => "help",
        Icon::PointingHand => "pointer",
        Icon::Progress => "progress",
        Icon::Wait => "wait",
        Icon::Cell => "cell",
        Icon::Crosshair => "crosshair",
        Icon::Text => "text",
        Icon::VerticalText => "vertical-text",
        Icon::Alias => "alias",
        Icon::Copy => "copy",
        Icon::Move => "move",
        Icon::NoDrop => "no-drop",
        Icon::NotAllowed => "not-allowed",
        Icon::Grab => "grab",
        Icon::Grabbing => "grabbing",
        Icon::AllScroll => "all-scroll",
        Icon::ResizeHorizontal | Icon::ResizeEast | Icon::ResizeWest => "ew-resize",
        Icon::ResizeVertical | Icon::ResizeNorth | Icon::ResizeSouth => "ns-resize",
        Icon::ResizeNeSw | Icon::ResizeNorthEast | Icon::ResizeSouthWest => "nesw-resize",
        Icon::ResizeNwSe | Icon::ResizeNorthWest | Icon::ResizeSouthEast => "nwse-resize",
        Icon::ResizeColumn => "col-resize",
        Icon::ResizeRow => "row-resize",
        Icon::ZoomIn => "zoom-in",
        Icon::ZoomOut => "zoom-out",
        _ => "default",
    }
}
