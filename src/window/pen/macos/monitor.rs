//! Overhears the window's events on macOS before the window receives them. Floor 7. macOS only.

use super::{MacEvent, MacPen, MacReport};
use crate::pen::{PenDevices, PenNews};
use block2::RcBlock;
use objc2::MainThreadMarker;
use objc2::rc::Retained;
use objc2::runtime::AnyObject;
use objc2_app_kit::{NSEvent, NSEventMask, NSEventSubtype, NSEventType};
use std::cell::RefCell;
use std::ptr::NonNull;
use std::rc::Rc;

/// The pen that moves the pointer of this program's windows.
pub struct MacPens {
    news: Rc<RefCell<Vec<PenNews>>>,
    monitor: Retained<AnyObject>,
}

impl MacPens {
    /// `None` off the main thread, or if AppKit does not let us listen.
    pub fn listen() -> Option<Self> {
        let main = MainThreadMarker::new()?;
        let news = Rc::new(RefCell::new(Vec::new()));
        let (heard, pen) = (news.clone(), RefCell::new(MacPen::default()));
        let block = RcBlock::new(move |event: NonNull<NSEvent>| -> *mut NSEvent {
            // SAFETY: AppKit passes an event that lives during this call.
            let report = report_of(unsafe { event.as_ref() }, main);
            let place = report.and_then(|report| pen.borrow_mut().read_report(&report));
            heard.borrow_mut().extend(place.map(|(at_px, state)| PenNews::Feel(at_px, state)));
            event.as_ptr()
        });
        let mask = NSEventMask::TabletPoint
            | NSEventMask::TabletProximity
            | NSEventMask::MouseMoved
            | NSEventMask::LeftMouseDown
            | NSEventMask::LeftMouseUp
            | NSEventMask::LeftMouseDragged
            | NSEventMask::RightMouseDown
            | NSEventMask::RightMouseUp
            | NSEventMask::RightMouseDragged
            | NSEventMask::OtherMouseDown
            | NSEventMask::OtherMouseUp
            | NSEventMask::OtherMouseDragged;
        // AppKit joins moves that come faster than the window draws; a stroke is made of all.
        NSEvent::setMouseCoalescingEnabled(false);
        // SAFETY: the block returns the event that it was given.
        let monitor =
            unsafe { NSEvent::addLocalMonitorForEventsMatchingMask_handler(mask, &block) }?;
        Some(Self { news, monitor })
    }
}

impl Drop for MacPens {
    fn drop(&mut self) {
        // SAFETY: it is what AppKit gave for listening.
        unsafe { NSEvent::removeMonitor(&self.monitor) };
    }
}

impl PenDevices for MacPens {
    fn read(&mut self) -> Vec<PenNews> {
        std::mem::take(&mut self.news.borrow_mut())
    }

    fn has_all_motions(&self) -> bool {
        true
    }
}

/// `None` for an event outside the window's inner area.
fn report_of(event: &NSEvent, main: MainThreadMarker) -> Option<MacReport> {
    let is_pointer =
        !matches!(event.r#type(), NSEventType::TabletPoint | NSEventType::TabletProximity);
    // A mouse's event may also say that a pen came near.
    let is_proximity = event.r#type() == NSEventType::TabletProximity
        || is_pointer && event.subtype() == NSEventSubtype::TabletProximity;
    let is_pen = is_pointer && event.subtype() == NSEventSubtype::TabletPoint;
    let kind = if is_proximity {
        MacEvent::Proximity {
            is_entering: event.isEnteringProximity(),
            pointing_device: event.pointingDeviceType().0,
        }
    } else if is_pointer {
        MacEvent::Pointer { is_pen }
    } else {
        MacEvent::Point
    };
    let is_of_pen = is_pen || is_proximity || !is_pointer;
    let (mut at_pt, mut scale) = ([0.0; 2], 1.0);
    if let Some(window) = event.window(main) {
        let view = window.contentView()?;
        let place = view.convertPoint_fromView(event.locationInWindow(), None);
        (at_pt, scale) = ([place.x, place.y], window.backingScaleFactor());
    }
    // AppKit raises an exception when an event is asked for what it does not have.
    let has_axes = is_pen || kind == MacEvent::Point;
    let tilt = if has_axes { event.tilt() } else { Default::default() };
    Some(MacReport {
        event: kind,
        device: if is_of_pen { event.deviceID() } else { 0 },
        at_pt,
        scale,
        pressure: if has_axes { event.pressure() } else { 0.0 },
        tilt: [tilt.x, tilt.y],
        rotation: if has_axes { event.rotation() } else { 0.0 },
    })
}
