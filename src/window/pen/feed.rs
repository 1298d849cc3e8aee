//! What the window hears of pens: fills the tablet that the canvas reads, and moves the window's
//! pointer for pens that do not move it themselves. Floor 7. The window's events pass through here
//! first. Not here: the platforms, and the loop (`event_loop`).

use super::{PenDevices, PenNews, PenStep, SharedTablet};
use eframe::egui::PointerButton;
use std::collections::{HashSet, VecDeque};
use winit::dpi::PhysicalPosition;
use winit::event::{DeviceId, ElementState, MouseButton, WindowEvent};

/// The system's own pointer follows a pen to this far, px.
const FOLLOWS_PX: f64 = 1.5;

/// The pens, and the tablet that is read by the canvas.
pub struct PenFeed {
    tablet: SharedTablet,
    devices: Option<Box<dyn PenDevices>>,
    /// The windows that the devices know.
    windows: HashSet<u64>,
    /// Not yet taken by the window.
    steps: VecDeque<(u64, PenStep)>,
    /// Where a pen that moves the pointer itself is, while it is near.
    pen_px: Option<[f64; 2]>,
    /// What such a pen holds.
    held: usize,
}

impl PenFeed {
    pub fn new(tablet: SharedTablet, devices: Option<Box<dyn PenDevices>>) -> Self {
        let (windows, steps) = (HashSet::new(), VecDeque::new());
        Self { tablet, devices, windows, steps, pen_px: None, held: 0 }
    }

    /// Whether the loop has to turn at anything that comes from the display, since the pens' own
    /// news do not turn it.
    pub fn is_unheard_by_loop(&self) -> bool {
        self.devices.as_ref().is_some_and(|devices| devices.is_unheard_by_loop())
    }

    /// Reads what the pens did on their own, at each turn of the loop and before each event of the
    /// window; [`Self::next_event`] gives it to the window.
    pub fn read_pens(&mut self) {
        let is_own = |devices: &&mut Box<dyn PenDevices>| {
            devices.is_own_pointer() || devices.has_all_motions()
        };
        if let Some(devices) = self.devices.as_mut().filter(is_own) {
            let news = devices.read();
            self.take_news(news);
        }
    }

    fn take_news(&mut self, news: Vec<PenNews>) {
        for one in news {
            match one {
                PenNews::Follow(axes) => self.tablet.borrow_mut().follow(axes),
                PenNews::Feel(at_px, state) => self.tablet.borrow_mut().note(at_px, state),
                PenNews::Step(window, step) => self.steps.push_back((window, step)),
            }
        }
    }

    /// The next event that a pen stands for, and its window. The tablet knows its state from now on.
    pub fn next_event(&mut self) -> Option<(u64, WindowEvent)> {
        let (window, step) = self.steps.pop_front()?;
        let device_id = DeviceId::dummy();
        let event = match step {
            PenStep::Move { at_px, state } => {
                self.pen_px = Some(at_px);
                self.tablet.borrow_mut().note(at_px, state);
                let position = PhysicalPosition::new(at_px[0], at_px[1]);
                WindowEvent::CursorMoved { device_id, position }
            }
            PenStep::Press(button) => {
                self.held += 1;
                let (state, button) = (ElementState::Pressed, mouse_button(button));
                WindowEvent::MouseInput { device_id, state, button }
            }
            PenStep::Release(button) => {
                self.held = self.held.saturating_sub(1);
                let (state, button) = (ElementState::Released, mouse_button(button));
                WindowEvent::MouseInput { device_id, state, button }
            }
            PenStep::Leave => {
                (self.pen_px, self.held) = (None, 0);
                WindowEvent::CursorLeft { device_id }
            }
        };
        Some((window, event))
    }

    /// Takes an event of the window itself, and passes it on unless a pen caused it.
    pub fn read_event(&mut self, window: u64, event: WindowEvent) -> Option<WindowEvent> {
        if let Some(devices) = &mut self.devices {
            if self.windows.insert(window) {
                devices.open(window);
            }
            if let WindowEvent::ScaleFactorChanged { scale_factor, .. } = event {
                devices.rescale(window, scale_factor);
            }
        }
        match event {
            WindowEvent::CursorMoved { position, .. } => {
                let at_px = [position.x, position.y];
                if self.is_pens_own(at_px) {
                    return None;
                }
                self.read_motion(at_px);
            }
            WindowEvent::AxisMotion { axis, value, .. } => {
                self.tablet.borrow_mut().axis(axis, value)
            }
            // While a pen draws, it alone is the pointer.
            WindowEvent::MouseInput { .. }
            | WindowEvent::CursorEntered { .. }
            | WindowEvent::CursorLeft { .. }
                if self.held > 0 =>
            {
                return None;
            }
            WindowEvent::Destroyed => {
                self.windows.remove(&window);
            }
            _ => {}
        }
        Some(event)
    }

    /// Whether the system moved its own pointer after a pen, or a hand touched the mouse while the
    /// pen draws.
    fn is_pens_own(&self, at_px: [f64; 2]) -> bool {
        let is_same = |pen: [f64; 2]| (0..2).all(|i| (pen[i] - at_px[i]).abs() <= FOLLOWS_PX);
        self.held > 0 || self.pen_px.is_some_and(is_same)
    }

    fn read_motion(&mut self, at_px: [f64; 2]) {
        let has_all = self.devices.as_ref().is_some_and(|devices| devices.has_all_motions());
        if let Some(devices) = &mut self.devices {
            let news = devices.read();
            self.take_news(news);
        }
        if !has_all {
            self.tablet.borrow_mut().move_to(at_px);
        }
    }
}

fn mouse_button(button: PointerButton) -> MouseButton {
    match button {
        PointerButton::Primary => MouseButton::Left,
        PointerButton::Secondary => MouseButton::Right,
        PointerButton::Middle => MouseButton::Middle,
        PointerButton::Extra1 => MouseButton::Back,
        PointerButton::Extra2 => MouseButton::Forward,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pen::tablet::PenState;
    use std::cell::RefCell;
    use std::rc::Rc;

    /// Pens that do what a test says.
    struct ToldPens {
        news: Rc<RefCell<Vec<PenNews>>>,
        has_all: bool,
    }

    impl PenDevices for ToldPens {
        fn read(&mut self) -> Vec<PenNews> {
            std::mem::take(&mut self.news.borrow_mut())
        }

        fn is_own_pointer(&self) -> bool {
            !self.has_all
        }

        fn has_all_motions(&self) -> bool {
            self.has_all
        }
    }

    const WINDOW: u64 = 11;

    fn feed(has_all: bool) -> (PenFeed, Rc<RefCell<Vec<PenNews>>>, SharedTablet) {
        let (news, tablet) = (Rc::default(), SharedTablet::default());
        let pens = ToldPens { news: Rc::clone(&news), has_all };
        (PenFeed::new(tablet.clone(), Some(Box::new(pens))), news, tablet)
    }

    fn pressed(pressure: f32) -> PenState {
        PenState { device: 4, pressure: Some(pressure), ..PenState::default() }
    }

    fn moved(x: f64) -> WindowEvent {
        let position = PhysicalPosition::new(x, 0.0);
        WindowEvent::CursorMoved { device_id: DeviceId::dummy(), position }
    }

    fn click() -> WindowEvent {
        let (device_id, state) = (DeviceId::dummy(), ElementState::Pressed);
        WindowEvent::MouseInput { device_id, state, button: MouseButton::Left }
    }

    /// Which of its own events the window has.
    fn passed<const N: usize>(feed: &mut PenFeed, events: [WindowEvent; N]) -> [bool; N] {
        events.map(|event| feed.read_event(WINDOW, event).is_some())
    }

    fn events(feed: &mut PenFeed) -> Vec<WindowEvent> {
        feed.read_pens();
        std::iter::from_fn(|| feed.next_event()).map(|(_, event)| event).collect()
    }

    #[test]
    fn a_pen_of_its_own_moves_the_windows_pointer_with_its_state() {
        let (mut feed, news, tablet) = feed(false);
        let step = |step| PenNews::Step(WINDOW, step);
        let move_to =
            |x, pressure| step(PenStep::Move { at_px: [x, 0.0], state: pressed(pressure) });
        news.borrow_mut().extend([
            move_to(5.0, 0.25),
            step(PenStep::Press(PointerButton::Primary)),
            move_to(6.0, 0.5),
        ]);
        assert_eq!(events(&mut feed), [moved(5.0), click(), moved(6.0)]);
        let taken = |x: f64| tablet.borrow_mut().take([x, 0.0]);
        assert_eq!((taken(5.0), taken(6.0)), (Some(pressed(0.25)), Some(pressed(0.5))));
        // The mouse is still while the pen draws, and free as it hovers.
        assert_eq!(passed(&mut feed, [moved(90.0), click()]), [false; 2]);
        news.borrow_mut().push(step(PenStep::Release(PointerButton::Primary)));
        events(&mut feed);
        assert_eq!(
            passed(&mut feed, [moved(7.0)]),
            [false],
            "the system's pointer follows the pen"
        );
        assert_eq!(passed(&mut feed, [moved(90.0), click()]), [true; 2]);
        assert_eq!(taken(90.0), Some(PenState::default()), "a mouse");
        news.borrow_mut().push(step(PenStep::Leave));
        events(&mut feed);
        assert_eq!(passed(&mut feed, [moved(6.0)]), [true]);
    }

    #[test]
    fn a_pen_that_the_window_moves_for_is_felt_where_the_pointer_comes() {
        let (mut feed, news, tablet) = feed(true);
        news.borrow_mut().push(PenNews::Feel([5.0, 0.0], pressed(0.75)));
        assert_eq!(passed(&mut feed, [moved(5.0)]), [true]);
        assert_eq!(tablet.borrow_mut().take([5.0, 0.0]), Some(pressed(0.75)));
        assert_eq!(events(&mut feed), [], "its pointer is the window's own");
    }

    #[test]
    fn without_pens_every_motion_is_a_mouses() {
        let tablet = SharedTablet::default();
        let mut feed = PenFeed::new(tablet.clone(), None);
        assert_eq!(passed(&mut feed, [moved(3.0), click()]), [true; 2]);
        assert_eq!(tablet.borrow_mut().take([3.0, 0.0]), Some(PenState::default()));
    }
}
