//! The pens of a compositor that says what a test wants, over a socket.

use super::*;
use crate::pen::{PenState, PenStep};
use eframe::egui::PointerButton;
use std::io::{Read, Write};
use std::os::unix::net::UnixStream;
use std::sync::mpsc::{Sender, channel};
use wayland_client::protocol::wl_compositor::WlCompositor;
use wayland_client::protocol::wl_surface::WlSurface;

/// Objects that a compositor makes.
const TABLET: u32 = 0xFF00_0000;
const TOOL: u32 = 0xFF00_0001;
const PAD: u32 = 0xFF00_0002;
const GROUP: u32 = 0xFF00_0003;
const RING: u32 = 0xFF00_0004;
/// The first object of all.
const DISPLAY: u32 = 1;
const GLOBALS: [&str; 4] =
    ["wl_compositor", "wl_seat", "zwp_tablet_manager_v2", "wp_cursor_shape_manager_v1"];

/// The window's side of the connection.
struct Window;

impl Dispatch<WlRegistry, GlobalListContents> for Window {
    fn event(
        _: &mut Self,
        _: &WlRegistry,
        _: wl_registry::Event,
        _: &GlobalListContents,
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
    }
}

delegate_noop!(Window: WlCompositor);
delegate_noop!(Window: ignore WlSurface);

/// The compositor's side: as much of the protocol as pens need.
struct Compositor {
    socket: UnixStream,
    /// The interface of each object of the client.
    objects: HashMap<u32, String>,
    surface: u32,
    /// What the client asked of the cursor's shape.
    shapes: Sender<Vec<u32>>,
}

impl Compositor {
    fn send(&mut self, object: u32, opcode: u32, words: &[u32]) {
        let size = 8 + 4 * words.len() as u32;
        let head = [object, size << 16 | opcode];
        let message: Vec<u8> =
            head.iter().chain(words).flat_map(|word| word.to_ne_bytes()).collect();
        // A client that is gone hears nothing.
        let _ = self.socket.write_all(&message);
    }

    /// Serves until the client is gone.
    fn serve(mut self) {
        let mut heard = Vec::new();
        let mut part = [0; 4096];
        while let Ok(count @ 1..) = self.socket.read(&mut part) {
            heard.extend_from_slice(&part[..count]);
            while heard.len() >= 8 {
                let word =
                    |at: usize| u32::from_ne_bytes(heard[4 * at..4 * at + 4].try_into().unwrap());
                let size = (word(1) >> 16) as usize;
                if heard.len() < size {
                    break;
                }
                let words: Vec<u32> = (0..size / 4).map(word).collect();
                heard.drain(..size);
                self.answer(words[0], words[1] & 0xFFFF, &words[2..]);
            }
        }
    }

    fn answer(&mut self, object: u32, opcode: u32, words: &[u32]) {
        if object == DISPLAY {
            return self.answer_display(opcode, words[0]);
        }
        let interface = self.objects.get(&object).cloned().unwrap_or_default();
        match (interface.as_str(), opcode) {
            ("wl_registry", 0) => {
                let (global, new) = (GLOBALS[words[0] as usize], words[words.len() - 1]);
                self.objects.insert(new, global.to_owned());
            }
            ("wl_compositor", 0) => self.surface = words[0],
            ("zwp_tablet_manager_v2", 0) => self.add_tools(words[0]),
            ("wp_cursor_shape_manager_v1", 2) => {
                self.objects.insert(words[0], "wp_cursor_shape_device_v1".to_owned());
            }
            ("wp_cursor_shape_device_v1", 1) => self.shapes.send(words.to_vec()).unwrap(),
            _ => {}
        }
    }

    fn answer_display(&mut self, opcode: u32, new: u32) {
        if opcode == 0 {
            // Everything before is answered.
            self.send(new, 0, &[0]);
            return self.send(DISPLAY, 1, &[new]);
        }
        self.objects.insert(new, "wl_registry".to_owned());
        for (number, name) in GLOBALS.iter().enumerate() {
            let mut text = name.as_bytes().to_vec();
            let length = text.len() as u32 + 1;
            text.resize(text.len() / 4 * 4 + 4, 0);
            let words = text.chunks(4).map(|four| u32::from_ne_bytes(four.try_into().unwrap()));
            let words: Vec<u32> =
                [number as u32, length].into_iter().chain(words).chain([1]).collect();
            self.send(new, 0, &words);
        }
    }

    /// A pen with its tablet and the tablet's buttons, which draws a short stroke and is unplugged.
    fn add_tools(&mut self, seat: u32) {
        let surface = self.surface;
        let fixed = |v: f64| (v * 256.0) as i32 as u32;
        let stroke: [(u32, u32, &[u32]); 24] = [
            (seat, 0, &[TABLET]),
            (seat, 1, &[TOOL]),
            (seat, 2, &[PAD]),
            (PAD, 0, &[GROUP]),
            (GROUP, 1, &[RING]),
            (TOOL, 0, &[0x141]),
            (TOOL, 3, &[1]),
            (TOOL, 3, &[2]),
            (TOOL, 4, &[]),
            (TOOL, 6, &[77, TABLET, surface]),
            (TOOL, 10, &[fixed(10.5), fixed(20.0)]),
            (TOOL, 13, &[fixed(-30.0), fixed(12.5)]),
            (TOOL, 18, &[1000]),
            (TOOL, 8, &[78]),
            (TOOL, 11, &[65_535]),
            (TOOL, 18, &[1004]),
            (TOOL, 17, &[79, 0x14c, 1]),
            (TOOL, 18, &[1008]),
            (TOOL, 17, &[79, 0x14c, 0]),
            (TOOL, 9, &[]),
            (TOOL, 18, &[1012]),
            (TOOL, 7, &[]),
            (TOOL, 18, &[1016]),
            (TOOL, 5, &[]),
        ];
        for (object, opcode, words) in stroke {
            self.send(object, opcode, words);
        }
    }
}

#[test]
fn a_compositors_pen_draws_in_the_windows_px_and_gets_a_cursor() {
    let (client, server) = UnixStream::pair().unwrap();
    let (shapes, asked) = channel();
    let compositor = Compositor { socket: server, objects: HashMap::new(), surface: 0, shapes };
    let serves = std::thread::spawn(move || compositor.serve());
    let Ok(window) = Connection::from_socket(client) else {
        return println!("skipped: there is no library of Wayland");
    };
    let (globals, queue) = registry_queue_init::<Window>(&window).unwrap();
    let compositor: WlCompositor = globals.bind(&queue.handle(), 1..=1, ()).unwrap();
    let surface = compositor.create_surface(&queue.handle(), ());
    let number = surface.id().as_ptr() as usize as u64;
    let display = NonNull::new(window.backend().display_ptr().cast()).unwrap();
    // SAFETY: the display of a connection that lives to the end of this test.
    let mut pens = unsafe { WaylandPens::connect(display) }.expect("it knows pens");
    pens.rescale(number, 2.0);
    // The window's own loop reads for both.
    window.roundtrip().unwrap();
    let news = pens.read();
    window.roundtrip().unwrap();
    let state = |pressure| PenState {
        device: 1,
        pressure: Some(pressure),
        tilt: (-30.0, 12.5),
        twist: None,
        is_eraser: true,
    };
    let place = |pressure| PenStep::Move { at_px: [21.0, 40.0], state: state(pressure) };
    let steps = [
        place(0.0),
        place(1.0),
        PenStep::Press(PointerButton::Primary),
        PenStep::Press(PointerButton::Middle),
        PenStep::Release(PointerButton::Primary),
        PenStep::Release(PointerButton::Middle),
        PenStep::Leave,
    ];
    assert_eq!(news, steps.map(|step| PenNews::Step(number, step)));
    assert_eq!(asked.try_recv().ok(), Some(vec![77, Shape::Crosshair as u32]));
    assert!(pens.read().is_empty() && pens.is_unheard_by_loop());
    drop((pens, queue, window));
    drop(serves);
}
