//! The window's event loop: pens receive its events before the window does, and give it theirs.
//! Floor 7.

use super::opened_files;
use super::pen::{self, PenFeed, SharedTablet};
use super::urgency::try_take_urgency;
use eframe::{EframeWinitApplication, UserEvent};
use std::path::PathBuf;
use std::time::{Duration, Instant};
use winit::application::ApplicationHandler;
use winit::event::{DeviceEvent, DeviceId, ElementState, StartCause, TouchPhase, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::window::WindowId;

/// While something is held down, a frame that no event asks for waits so long for one.
const SETTLING: Duration = Duration::from_millis(25);
/// The time that a loop waits which would wait for ever.
const LONGEST_WAIT: Duration = Duration::from_secs(60);

/// If this is set to anything, the window is opened on Wayland where available.
///
/// Otherwise it is opened through X11 if both are available: on Wayland this windowing library
/// reports no dropped files, and a pen does not move the window by its frame.
#[cfg(all(unix, not(target_os = "macos")))]
const PREFERS_WAYLAND: &str = "RILIEVO_WAYLAND";

/// Runs the window until it is closed; the tablet receives every motion first.
///
/// * `open`: is given the files that the desktop asks the running program to open.
///
/// Fails if there is no display, or the window cannot be opened on it.
pub fn run(
    options: eframe::NativeOptions,
    tablet: SharedTablet,
    open: impl Fn(Vec<PathBuf>) + 'static,
    start: eframe::AppCreator<'_>,
) -> eframe::Result {
    let events = event_loop()?;
    let _listening = opened_files::listen(open);
    let window = eframe::create_native("rilievo", options, start, &events);
    let feed = PenFeed::new(tablet, pen::devices(&events));
    events.run_app(&mut PenListener { window, feed, held: 0 })?;
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

/// The window, and the pens, which receive its events.
struct PenListener<'a> {
    window: EframeWinitApplication<'a>,
    feed: PenFeed,
    /// Buttons and fingers that are down.
    held: usize,
}

impl PenListener<'_> {
    /// Gives the window what the pens did on their own.
    fn move_by_pens(&mut self, events: &ActiveEventLoop) {
        self.feed.read_pens();
        while let Some((window, event)) = self.feed.next_event() {
            self.pass_on(events, window.into(), event);
        }
    }

    fn pass_on(&mut self, events: &ActiveEventLoop, window: WindowId, event: WindowEvent) {
        self.held = held_after(self.held, &event);
        self.window.window_event(events, window, event);
    }
}

/// How many buttons and fingers are down after an event.
fn held_after(held: usize, event: &WindowEvent) -> usize {
    let is_down = match event {
        WindowEvent::MouseInput { state, .. } => *state == ElementState::Pressed,
        WindowEvent::Touch(touch) if touch.phase == TouchPhase::Moved => return held,
        WindowEvent::Touch(touch) => touch.phase == TouchPhase::Started,
        // What is let go elsewhere is not heard of.
        WindowEvent::Focused(false) => return 0,
        _ => return held,
    };
    if is_down { held + 1 } else { held.saturating_sub(1) }
}

impl ApplicationHandler<UserEvent> for PenListener<'_> {
    fn window_event(&mut self, events: &ActiveEventLoop, window: WindowId, event: WindowEvent) {
        self.move_by_pens(events);
        if let Some(event) = self.feed.read_event(window.into(), event) {
            self.pass_on(events, window, event);
        }
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

    fn user_event(&mut self, events: &ActiveEventLoop, mut event: UserEvent) {
        if let UserEvent::RequestRepaint { when, .. } = &mut event
            && !try_take_urgency()
            && self.held > 0
        {
            *when = (*when).max(Instant::now() + SETTLING);
        }
        self.window.user_event(events, event);
    }

    fn device_event(&mut self, events: &ActiveEventLoop, device: DeviceId, event: DeviceEvent) {
        self.window.device_event(events, device, event);
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        self.move_by_pens(events);
        self.window.about_to_wait(events);
        // Whatever comes from the display while the loop waits for a time turns it; while it waits
        // for nothing, only the windowing library's own events do.
        if self.feed.is_unheard_by_loop() && events.control_flow() == ControlFlow::Wait {
            events.set_control_flow(ControlFlow::wait_duration(LONGEST_WAIT));
        }
    }

    fn exiting(&mut self, events: &ActiveEventLoop) {
        self.window.exiting(events);
    }

    fn memory_warning(&mut self, events: &ActiveEventLoop) {
        self.window.memory_warning(events);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use winit::event::MouseButton;

    #[test]
    fn what_is_held_down_is_counted_until_the_window_loses_the_focus() {
        let button = |state| WindowEvent::MouseInput {
            device_id: DeviceId::dummy(),
            state,
            button: MouseButton::Left,
        };
        let (press, release) = (button(ElementState::Pressed), button(ElementState::Released));
        let held = |events: &[&WindowEvent]| events.iter().fold(0, |held, of| held_after(held, of));
        assert_eq!(held(&[&press, &press, &release]), 1);
        assert_eq!(held(&[&release, &press]), 1, "a release of another window's press");
        assert_eq!(held(&[&press, &WindowEvent::Focused(false)]), 0);
        assert_eq!(held(&[&press, &WindowEvent::CloseRequested]), 1);
    }
}
