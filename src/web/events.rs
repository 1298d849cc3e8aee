//! The page's events as the window's. Floor 8.
//!
//! A mouse and a pen move the pointer; a pen's pressure and tilt are axes of a tablet, as on a
//! desktop. A finger is a touch, and the first one moves the pointer too.

use eframe::egui::{
    Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, Pos2, TouchDeviceId,
    TouchId, TouchPhase, Vec2, vec2,
};
use rilievo_window::{AxisMeaning, PenAxes, PenAxis, SharedTablet};

/// Bits of the keys that are held, as the page's script sets them.
const SHIFT: u8 = 1;
const CTRL: u8 = 2;
const ALT: u8 = 4;
const META: u8 = 8;

/// Axes of the pen, by our own numbers.
const PRESSURE: u32 = 0;
const TILT_X: u32 = 1;
const TILT_Y: u32 = 2;

/// The devices that move the pointer, by our own numbers.
const MOUSE: u32 = 1;
const PEN: u32 = 2;
const ERASER: u32 = 3;

/// The keys that are held.
pub fn modifiers(bits: u8) -> Modifiers {
    let [shift, ctrl, alt, meta] = [SHIFT, CTRL, ALT, META].map(|bit| bits & bit != 0);
    Modifiers { alt, ctrl, shift, mac_cmd: meta, command: ctrl || meta }
}

/// A key of the page's event; `None` for one that the window does not know.
pub fn key(key: &str, code: &str, pressed: bool, modifiers: Modifiers) -> Option<Event> {
    let physical_key = Key::from_name(code);
    let key = Key::from_name(key).or(physical_key)?;
    Some(Event::Key { key, physical_key, pressed, repeat: false, modifiers })
}

/// The wheel; `mode` is the event's `deltaMode`.
pub fn wheel(delta: Vec2, mode: u32, modifiers: Modifiers) -> Event {
    let unit = match mode {
        1 => MouseWheelUnit::Line,
        2 => MouseWheelUnit::Page,
        _ => MouseWheelUnit::Point,
    };
    Event::MouseWheel {
        unit,
        delta: -delta,
        modifiers,
        phase: TouchPhase::Move,
        source: MouseWheelSource::Unknown,
    }
}

fn button(number: i16) -> Option<PointerButton> {
    use PointerButton::{Extra1, Extra2, Middle, Primary, Secondary};
    [Primary, Middle, Secondary, Extra1, Extra2].get(usize::try_from(number).ok()?).copied()
}

/// What a pointer of the page did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointerPhase {
    Down,
    Move,
    Up,
    Cancel,
    /// It left the page.
    Leave,
}

impl PointerPhase {
    /// By the number that the page's script has for it.
    pub fn of(number: u8) -> Self {
        match number {
            0 => Self::Down,
            1 => Self::Move,
            2 => Self::Up,
            3 => Self::Cancel,
            _ => Self::Leave,
        }
    }
}

/// One event of a mouse, a pen or a finger.
#[derive(Clone, Copy, Debug)]
pub struct PointerInput {
    pub phase: PointerPhase,
    /// Points of the window.
    pub at: Pos2,
    pub button: i16,
    pub modifiers: Modifiers,
    /// The page's number of the finger.
    pub id: u32,
    pub pressure: f32,
    /// Degrees, right and down positive.
    pub tilt: (f32, f32),
}

/// The pointers of the page.
pub struct Pointers {
    tablet: SharedTablet,
    device: u32,
    /// The finger that moves the pointer.
    first_finger: Option<u32>,
}

impl Pointers {
    pub fn new(tablet: SharedTablet) -> Self {
        Self { tablet, device: 0, first_finger: None }
    }

    /// Takes an event of a mouse.
    pub fn move_mouse(&mut self, input: PointerInput, px_per_pt: f32, events: &mut Vec<Event>) {
        self.follow(MOUSE);
        self.note(input.at, px_per_pt);
        push_pointer(input, events);
    }

    /// Takes an event of a pen.
    pub fn move_pen(
        &mut self,
        input: PointerInput,
        is_eraser: bool,
        px_per_pt: f32,
        events: &mut Vec<Event>,
    ) {
        self.follow(if is_eraser { ERASER } else { PEN });
        self.note(input.at, px_per_pt);
        let mut tablet = self.tablet.borrow_mut();
        tablet.axis(PRESSURE, f64::from(input.pressure));
        tablet.axis(TILT_X, f64::from(input.tilt.0));
        tablet.axis(TILT_Y, f64::from(input.tilt.1));
        drop(tablet);
        if input.phase == PointerPhase::Down {
            // The pressure of the first touch belongs to a motion.
            events.push(Event::PointerMoved(input.at));
        }
        push_pointer(input, events);
    }

    /// Takes an event of a finger.
    pub fn move_finger(&mut self, input: PointerInput, events: &mut Vec<Event>) {
        self.follow(MOUSE);
        let phase = match input.phase {
            PointerPhase::Down => TouchPhase::Start,
            PointerPhase::Move => TouchPhase::Move,
            PointerPhase::Up => TouchPhase::End,
            PointerPhase::Cancel | PointerPhase::Leave => TouchPhase::Cancel,
        };
        let (device_id, id) = (TouchDeviceId(0), TouchId(u64::from(input.id)));
        events.push(Event::Touch { device_id, id, phase, pos: input.at, force: None });
        if phase == TouchPhase::Start && self.first_finger.is_none() {
            self.first_finger = Some(input.id);
        }
        if self.first_finger != Some(input.id) {
            return;
        }
        if input.phase == PointerPhase::Down {
            events.push(Event::PointerMoved(input.at));
        }
        push_pointer(PointerInput { button: 0, ..input }, events);
        if matches!(phase, TouchPhase::End | TouchPhase::Cancel) {
            self.first_finger = None;
            events.push(Event::PointerGone);
        }
    }

    /// Another device moves the pointer.
    fn follow(&mut self, device: u32) {
        if self.device == device {
            return;
        }
        self.device = device;
        let axis = |number, reads, range| PenAxis::new(number, reads, range, 0.0);
        let axes = [
            axis(PRESSURE, AxisMeaning::Pressure, (0.0, 1.0)),
            axis(TILT_X, AxisMeaning::TiltX, (-90.0, 90.0)),
            axis(TILT_Y, AxisMeaning::TiltY, (-90.0, 90.0)),
        ];
        let axes = if device == MOUSE { Vec::new() } else { axes.into_iter().flatten().collect() };
        self.tablet.borrow_mut().follow(PenAxes { device, axes, is_eraser: device == ERASER });
    }

    fn note(&mut self, at: Pos2, px_per_pt: f32) {
        let at_px = vec2(at.x, at.y) * px_per_pt;
        self.tablet.borrow_mut().move_to([at_px.x.into(), at_px.y.into()]);
    }
}

/// The pointer's own events.
fn push_pointer(input: PointerInput, events: &mut Vec<Event>) {
    let pressed = input.phase == PointerPhase::Down;
    let press = |button| Event::PointerButton {
        pos: input.at,
        button,
        pressed,
        modifiers: input.modifiers,
    };
    match input.phase {
        PointerPhase::Move => events.push(Event::PointerMoved(input.at)),
        PointerPhase::Down | PointerPhase::Up => events.extend(button(input.button).map(press)),
        PointerPhase::Cancel => {
            events.extend(button(input.button.max(0)).map(press));
            events.push(Event::PointerGone);
        }
        PointerPhase::Leave => events.push(Event::PointerGone),
    }
}
