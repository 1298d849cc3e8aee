//! The window's event loop: the tablet receives pointer events before the window does.
//! Floor 7.

use super::pen::{self, PenDevices, SharedTablet};
use eframe::{EframeWinitApplication, UserEvent};
use winit::application::ApplicationHandler;
use winit::event::{DeviceEvent, DeviceId, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::window::WindowId;

/// If this is set to anything, the window is opened on Wayland where available.
///
/// Otherwise it is opened through X11 if both are available: on Wayland this windowing library
/// reports neither pen pressure nor dropped files.
#[cfg(all(unix, not(target_os = "macos")))]
const PREFERS_WAYLAND: &str = "RILIEVO_WAYLAND";

/// Runs the window until it is closed; the tablet receives every motion first.
///
/// Fails if there is no display, or the window cannot be opened on it.
pub fn run(
    options: eframe::NativeOptions,
    tablet: SharedTablet,
    start: eframe::AppCreator<'_>,
) -> eframe::Result {
    let events = event_loop()?;
    let window = eframe::create_native("rilievo", options, start, &events);
    let devices = pen::devices(&events);
    events.run_app(&mut TabletListener { window, tablet, devices })?;
    Ok(())
}

#[cfg(all(unix, not(target_os = "macos")))]
fn event_loop() -> eframe::Result<EventLoop<UserEvent>> {
    let mut builder = EventLoop::with_user_event();
    let has_x11 = std::env::var_os("DISPLAY").is_some_and(|display| !display.is_empty());
    if has_x11 && std::env::var_os(PREFERS_WAYLAND).is_none() {
        winit::platform::x11::EventLoopBuilderExtX11::with_x11(&mut builder);
    }
    Ok(builder.build()?)
}

#[cfg(not(all(unix, not(target_os = "macos"))))]
fn event_loop() -> eframe::Result<EventLoop<UserEvent>> {
    Ok(EventLoop::with_user_event().build()?)
}

/// The window, and the tablet, which receives its events.
struct TabletListener<'a> {
    window: EframeWinitApplication<'a>,
    tablet: SharedTablet,
    devices: Option<Box<dyn PenDevices>>,
}

impl TabletListener<'_> {
    fn overhear(&mut self, event: &WindowEvent) {
        let mut tablet = self.tablet.borrow_mut();
        match *event {
            WindowEvent::CursorMoved { position, .. } => {
                if let Some(axes) = self.devices.as_mut().and_then(|devices| devices.change()) {
                    tablet.follow(axes);
                }
                tablet.move_to([position.x, position.y]);
            }
            WindowEvent::AxisMotion { axis, value, .. } => tablet.axis(axis, value),
            _ => {}
        }
    }
}

impl ApplicationHandler<UserEvent> for TabletListener<'_> {
    fn window_event(&mut self, events: &ActiveEventLoop, window: WindowId, event: WindowEvent) {
        self.overhear(&event);
        self.window.window_event(events, window, event);
    }

    fn new_events(&mut self, events: &ActiveEventLoop, cause: StartCause) {
        self.window.new_events(events, cause);
    }

    fn resumed(&mut self, events: &ActiveEventLoop) {
        self.window.resumed(events);
    }

    fn suspended(&mut self, events: &ActiveEventLoop) {
        self.window.suspended(events);
    }

    fn user_event(&mut self, events: &ActiveEventLoop, event: UserEvent) {
        self.window.user_event(events, event);
    }

    fn device_event(&mut self, events: &ActiveEventLoop, device: DeviceId, event: DeviceEvent) {
        self.window.device_event(events, device, event);
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        self.window.about_to_wait(events);
    }

    fn exiting(&mut self, events: &ActiveEventLoop) {
        self.window.exiting(events);
    }

    fn memory_warning(&mut self, events: &ActiveEventLoop) {
        self.window.memory_warning(events);
    }
}
