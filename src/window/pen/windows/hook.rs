//! Asks Windows about the pen at each of its messages, before the window sees them. Floor 7.
//! Windows only. Where Windows does not have the functions, the window hears pens as touches.

use super::{Edges, PointerReport, is_made_of_pen};
use crate::pen::steps::{PenFollower, WindowStep};
use crate::pen::{PenDevices, PenNews};
use std::cell::RefCell;
use std::collections::HashSet;
use std::ptr::null_mut;
use std::rc::Rc;
use windows_sys::Win32::Foundation::{HANDLE, HWND, LPARAM, LRESULT, POINT, RECT, WPARAM};
use windows_sys::Win32::Graphics::Gdi::ClientToScreen;
use windows_sys::Win32::System::LibraryLoader::{GetModuleHandleW, GetProcAddress};
use windows_sys::Win32::UI::Input::Pointer::{GetPointerType, POINTER_PEN_INFO};
use windows_sys::Win32::UI::Shell::{DefSubclassProc, RemoveWindowSubclass, SetWindowSubclass};
use windows_sys::Win32::UI::WindowsAndMessaging::{
    GetMessageExtraInfo, PT_PEN, WM_MOUSEFIRST, WM_MOUSELAST, WM_NCDESTROY,
    WM_POINTERCAPTURECHANGED, WM_POINTERDOWN, WM_POINTERLEAVE, WM_POINTERUP, WM_POINTERUPDATE,
};

/// Our number among those that listen to the window.
const HOOK: usize = 0x7069_6c6f;
/// The most entries of a history that are asked for: more than a second of the fastest pen.
const MOST_ENTRIES: u32 = 4096;

type PenHistory = unsafe extern "system" fn(u32, *mut u32, *mut POINTER_PEN_INFO) -> i32;
type DeviceRects = unsafe extern "system" fn(HANDLE, *mut RECT, *mut RECT) -> i32;

/// What the pens did, until the event loop reads it.
struct PenInbox {
    history: PenHistory,
    rects: DeviceRects,
    pen: PenFollower,
    steps: Vec<WindowStep>,
}

/// The pens of the windows that are open.
pub struct WindowsPens {
    inbox: Rc<RefCell<PenInbox>>,
    windows: HashSet<u64>,
}

impl WindowsPens {
    /// `None` if Windows does not know pens.
    pub fn find() -> Option<Self> {
        let user32: Vec<u16> = "user32.dll\0".encode_utf16().collect();
        // SAFETY: the names end in 0, and the functions have the types of the system's headers.
        let (history, rects) = unsafe {
            let user32 = GetModuleHandleW(user32.as_ptr());
            if user32.is_null() {
                return None;
            }
            let history = GetProcAddress(user32, c"GetPointerPenInfoHistory".as_ptr().cast())?;
            let rects = GetProcAddress(user32, c"GetPointerDeviceRects".as_ptr().cast())?;
            (
                std::mem::transmute::<unsafe extern "system" fn() -> isize, PenHistory>(history),
                std::mem::transmute::<unsafe extern "system" fn() -> isize, DeviceRects>(rects),
            )
        };
        let inbox = PenInbox { history, rects, pen: PenFollower::default(), steps: Vec::new() };
        Some(Self { inbox: Rc::new(RefCell::new(inbox)), windows: HashSet::new() })
    }
}

impl PenDevices for WindowsPens {
    fn read(&mut self) -> Vec<PenNews> {
        let steps = std::mem::take(&mut self.inbox.borrow_mut().steps);
        steps.into_iter().map(|(window, step)| PenNews::Step(window, step)).collect()
    }

    fn open(&mut self, window: u64) {
        if !self.windows.insert(window) {
            return;
        }
        let inbox = Rc::into_raw(self.inbox.clone());
        // SAFETY: the number is the handle of a window of this thread. The hook owns one count of
        // the inbox until the window is destroyed.
        let is_hooked = unsafe {
            SetWindowSubclass(window as usize as HWND, Some(overhear), HOOK, inbox as usize) != 0
        };
        if !is_hooked {
            // SAFETY: nobody else took the count.
            drop(unsafe { Rc::from_raw(inbox) });
        }
    }

    fn is_own_pointer(&self) -> bool {
        true
    }
}

/// Called for each message of the window, before the window's own procedure.
///
/// # Safety
///
/// `inbox` is what [`WindowsPens::open`] passed on for this window.
unsafe extern "system" fn overhear(
    window: HWND,
    message: u32,
    wparam: WPARAM,
    lparam: LPARAM,
    _: usize,
    inbox: usize,
) -> LRESULT {
    let inbox = inbox as *const RefCell<PenInbox>;
    let is_taken = match message {
        WM_POINTERDOWN
        | WM_POINTERUPDATE
        | WM_POINTERUP
        | WM_POINTERLEAVE
        | WM_POINTERCAPTURECHANGED => {
            let pointer = (wparam & 0xFFFF) as u32;
            // SAFETY: the hook owns a count of the inbox. No call below sends messages, so it is
            // not borrowed twice; if it were, the message would pass.
            let inbox = unsafe { &*inbox };
            is_pen(pointer)
                && inbox.try_borrow_mut().is_ok_and(|mut inbox| {
                    match message {
                        WM_POINTERLEAVE | WM_POINTERCAPTURECHANGED => inbox.lose(),
                        _ => inbox.ask(window, pointer),
                    }
                    true
                })
        }
        // SAFETY: asks about the message that is being processed.
        WM_MOUSEFIRST..=WM_MOUSELAST => is_made_of_pen(unsafe { GetMessageExtraInfo() } as usize),
        WM_NCDESTROY => {
            // SAFETY: the window is going; its count of the inbox is given back once.
            unsafe {
                RemoveWindowSubclass(window, Some(overhear), HOOK);
                drop(Rc::from_raw(inbox));
            }
            false
        }
        _ => false,
    };
    if is_taken {
        return 0;
    }
    // SAFETY: passes the message on as it came.
    unsafe { DefSubclassProc(window, message, wparam, lparam) }
}

fn is_pen(pointer: u32) -> bool {
    let mut kind = 0;
    // SAFETY: writes one number.
    unsafe { GetPointerType(pointer, &raw mut kind) != 0 && kind == PT_PEN }
}

impl PenInbox {
    /// The pen left the window, or another program took it.
    fn lose(&mut self) {
        self.pen.leave(&mut self.steps);
    }

    /// Asks for all that happened up to this message: Windows joins moves that were not fetched.
    fn ask(&mut self, window: HWND, pointer: u32) {
        let mut count = 0;
        // SAFETY: without a buffer, the count alone is written.
        if unsafe { (self.history)(pointer, &raw mut count, null_mut()) } == 0 {
            return;
        }
        count = count.min(MOST_ENTRIES);
        let mut entries = vec![POINTER_PEN_INFO::default(); count as usize];
        // SAFETY: the buffer has `count` entries.
        if unsafe { (self.history)(pointer, &raw mut count, entries.as_mut_ptr()) } == 0 {
            return;
        }
        entries.truncate(count as usize);
        let mut origin = POINT { x: 0, y: 0 };
        // SAFETY: the window is alive: it is receiving a message.
        unsafe { ClientToScreen(window, &raw mut origin) };
        // The newest comes first.
        for entry in entries.iter().rev() {
            let report = self.report(window, entry, origin);
            self.pen.follow(report.moment(), &mut self.steps);
        }
    }

    fn report(&self, window: HWND, entry: &POINTER_PEN_INFO, origin: POINT) -> PointerReport {
        let info = &entry.pointerInfo;
        let (mut tablet, mut screen) = (RECT::default(), RECT::default());
        // SAFETY: writes two rectangles; where it fails they stay empty.
        unsafe { (self.rects)(info.sourceDevice, &raw mut tablet, &raw mut screen) };
        let edges = |rect: RECT| -> Edges { [rect.left, rect.top, rect.right, rect.bottom] };
        PointerReport {
            window: window as usize as u64,
            pointer: info.pointerId,
            flags: info.pointerFlags,
            pen_flags: entry.penFlags,
            pen_mask: entry.penMask,
            pressure: entry.pressure,
            rotation: entry.rotation,
            tilt: [entry.tiltX, entry.tiltY],
            pixel: [info.ptPixelLocation.x, info.ptPixelLocation.y],
            himetric: [info.ptHimetricLocation.x, info.ptHimetricLocation.y],
            tablet: edges(tablet),
            screen: edges(screen),
            origin: [origin.x, origin.y],
        }
    }
}
