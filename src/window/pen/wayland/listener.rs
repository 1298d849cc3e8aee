//! Asks the compositor for pens on the window's own connection, in a queue of our own. Floor 7.
//! Wayland only. The windowing library does not ask for pens; once we do, the compositor no longer
//! moves the pointer for them.

use super::{ToolEvent, WaylandTool};
use crate::pen::steps::WindowStep;
use crate::pen::{PenDevices, PenNews};
use std::collections::HashMap;
use std::ffi::c_void;
use std::mem::ManuallyDrop;
use std::ptr::NonNull;
use wayland_backend::client::{Backend, ObjectId};
use wayland_client::globals::{GlobalListContents, registry_queue_init};
use wayland_client::protocol::wl_registry::{self, WlRegistry};
use wayland_client::protocol::wl_seat::WlSeat;
use wayland_client::{
    Connection, Dispatch, EventQueue, Proxy, QueueHandle, WEnum, delegate_noop, event_created_child,
};
use wayland_protocols::wp::cursor_shape::v1::client::wp_cursor_shape_device_v1::{
    Shape, WpCursorShapeDeviceV1,
};
use wayland_protocols::wp::cursor_shape::v1::client::wp_cursor_shape_manager_v1::WpCursorShapeManagerV1;
use wayland_protocols::wp::tablet::zv2::client::zwp_tablet_manager_v2::ZwpTabletManagerV2;
use wayland_protocols::wp::tablet::zv2::client::zwp_tablet_pad_group_v2::{
    self, ZwpTabletPadGroupV2,
};
use wayland_protocols::wp::tablet::zv2::client::zwp_tablet_pad_ring_v2::ZwpTabletPadRingV2;
use wayland_protocols::wp::tablet::zv2::client::zwp_tablet_pad_strip_v2::ZwpTabletPadStripV2;
use wayland_protocols::wp::tablet::zv2::client::zwp_tablet_pad_v2::{self, ZwpTabletPadV2};
use wayland_protocols::wp::tablet::zv2::client::zwp_tablet_seat_v2::{self, ZwpTabletSeatV2};
use wayland_protocols::wp::tablet::zv2::client::zwp_tablet_tool_v2::{
    self, ButtonState, Capability, ZwpTabletToolV2,
};
use wayland_protocols::wp::tablet::zv2::client::zwp_tablet_v2::{self, ZwpTabletV2};

/// The versions that are spoken.
const VERSION: u32 = 1;

/// The pens of a compositor.
///
/// Never dropped: its objects live in the window's connection, which may be gone before.
pub struct WaylandPens(ManuallyDrop<Listening>);

struct Listening {
    connection: Connection,
    queue: EventQueue<Tools>,
    tools: Tools,
    /// The connection is broken: there is no more information.
    is_gone: bool,
}

/// The tools that are known.
struct Tools {
    manager: ZwpTabletManagerV2,
    cursors: Option<WpCursorShapeManagerV1>,
    known: HashMap<ObjectId, (WaylandTool, Option<WpCursorShapeDeviceV1>)>,
    /// How many there have been.
    count: u32,
    /// Px per point of the windows' surfaces.
    scales: HashMap<u64, f64>,
    steps: Vec<WindowStep>,
}

impl WaylandPens {
    /// `None` if the compositor does not know pens.
    ///
    /// # Safety
    ///
    /// The display is a `wl_display` that stays connected while this is read.
    pub unsafe fn connect(display: NonNull<c_void>) -> Option<Self> {
        // SAFETY: by the caller.
        let backend = unsafe { Backend::from_foreign_display(display.as_ptr().cast()) };
        let connection = Connection::from_backend(backend);
        let (globals, queue) = registry_queue_init::<Tools>(&connection).ok()?;
        let handle = queue.handle();
        let manager: ZwpTabletManagerV2 = globals.bind(&handle, VERSION..=VERSION, ()).ok()?;
        let cursors = globals.bind(&handle, VERSION..=VERSION, ()).ok();
        let seats = globals.contents().clone_list();
        for seat in seats.iter().filter(|global| global.interface == WlSeat::interface().name) {
            let seat = globals.registry().bind(seat.name, VERSION, &handle, ());
            manager.get_tablet_seat(&seat, &handle, ());
        }
        let tools = Tools {
            manager,
            cursors,
            known: HashMap::new(),
            count: 0,
            scales: HashMap::new(),
            steps: Vec::new(),
        };
        connection.flush().ok()?;
        Some(Self(ManuallyDrop::new(Listening { connection, queue, tools, is_gone: false })))
    }
}

impl PenDevices for WaylandPens {
    /// Reads what the window's own loop fetched: it fetches for all queues.
    fn read(&mut self) -> Vec<PenNews> {
        let Listening { connection, queue, tools, is_gone } = &mut *self.0;
        if !*is_gone {
            *is_gone = queue.dispatch_pending(tools).is_err() || connection.flush().is_err();
        }
        let steps = tools.steps.drain(..);
        steps.map(|(window, step)| PenNews::Step(window, step)).collect()
    }

    fn rescale(&mut self, window: u64, px_per_pt: f64) {
        self.0.tools.scales.insert(window, px_per_pt);
    }

    fn is_own_pointer(&self) -> bool {
        true
    }

    fn is_unheard_by_loop(&self) -> bool {
        true
    }
}

impl Dispatch<WlRegistry, GlobalListContents> for Tools {
    fn event(
        tools: &mut Self,
        registry: &WlRegistry,
        event: wl_registry::Event,
        _: &GlobalListContents,
        _: &Connection,
        handle: &QueueHandle<Self>,
    ) {
        // Another person's mouse and keyboard.
        if let wl_registry::Event::Global { name, interface, .. } = event
            && interface == WlSeat::interface().name
        {
            let seat = registry.bind(name, VERSION, handle, ());
            tools.manager.get_tablet_seat(&seat, handle, ());
        }
    }
}

impl Dispatch<ZwpTabletSeatV2, ()> for Tools {
    fn event(
        tools: &mut Self,
        _: &ZwpTabletSeatV2,
        event: zwp_tablet_seat_v2::Event,
        _: &(),
        _: &Connection,
        handle: &QueueHandle<Self>,
    ) {
        if let zwp_tablet_seat_v2::Event::ToolAdded { id } = event {
            tools.count = tools.count.saturating_add(1);
            let cursor =
                tools.cursors.as_ref().map(|cursors| cursors.get_tablet_tool_v2(&id, handle, ()));
            tools.known.insert(id.id(), (WaylandTool::new(tools.count), cursor));
        }
    }

    event_created_child!(Tools, ZwpTabletSeatV2, [
        zwp_tablet_seat_v2::EVT_TABLET_ADDED_OPCODE => (ZwpTabletV2, ()),
        zwp_tablet_seat_v2::EVT_TOOL_ADDED_OPCODE => (ZwpTabletToolV2, ()),
        zwp_tablet_seat_v2::EVT_PAD_ADDED_OPCODE => (ZwpTabletPadV2, ()),
    ]);
}

impl Dispatch<ZwpTabletToolV2, ()> for Tools {
    fn event(
        tools: &mut Self,
        proxy: &ZwpTabletToolV2,
        event: zwp_tablet_tool_v2::Event,
        _: &(),
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
        let Some((tool, cursor)) = tools.known.get_mut(&proxy.id()) else { return };
        let scales = &tools.scales;
        let scale = |surface: u64| scales.get(&surface).copied().unwrap_or(1.0);
        if let (zwp_tablet_tool_v2::Event::ProximityIn { serial, .. }, Some(cursor)) =
            (&event, cursor.as_ref())
        {
            cursor.set_shape(*serial, Shape::Crosshair);
        }
        let Some(read) = tool_event(&event) else { return };
        tool.read_event(read, scale, &mut tools.steps);
        if read == ToolEvent::Removed {
            if let Some(cursor) = cursor {
                cursor.destroy();
            }
            proxy.destroy();
            tools.known.remove(&proxy.id());
        }
    }
}

/// `None` for what is not used.
fn tool_event(event: &zwp_tablet_tool_v2::Event) -> Option<ToolEvent> {
    use zwp_tablet_tool_v2::Event;
    Some(match event {
        Event::Type { tool_type } => ToolEvent::Kind((*tool_type).into()),
        Event::Capability { capability: WEnum::Value(Capability::Pressure) } => {
            ToolEvent::HasPressure
        }
        Event::Capability { capability: WEnum::Value(Capability::Rotation) } => {
            ToolEvent::HasRotation
        }
        Event::ProximityIn { surface, .. } => {
            ToolEvent::Near { surface: surface.id().as_ptr() as usize as u64 }
        }
        Event::ProximityOut => ToolEvent::Far,
        Event::Down { .. } => ToolEvent::Down,
        Event::Up => ToolEvent::Up,
        Event::Motion { x, y } => ToolEvent::Motion(*x, *y),
        Event::Pressure { pressure } => ToolEvent::Pressure(*pressure),
        Event::Tilt { tilt_x, tilt_y } => ToolEvent::Tilt(*tilt_x, *tilt_y),
        Event::Rotation { degrees } => ToolEvent::Rotation(*degrees),
        Event::Button { button, state, .. } => ToolEvent::Button {
            number: *button,
            pressed: matches!(state, WEnum::Value(ButtonState::Pressed)),
        },
        Event::Frame { .. } => ToolEvent::Frame,
        Event::Removed => ToolEvent::Removed,
        _ => return None,
    })
}

impl Dispatch<ZwpTabletV2, ()> for Tools {
    fn event(
        _: &mut Self,
        tablet: &ZwpTabletV2,
        event: zwp_tablet_v2::Event,
        _: &(),
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
        if let zwp_tablet_v2::Event::Removed = event {
            tablet.destroy();
        }
    }
}

// The buttons of a tablet are not read, but their objects come with it.
impl Dispatch<ZwpTabletPadV2, ()> for Tools {
    fn event(
        _: &mut Self,
        pad: &ZwpTabletPadV2,
        event: zwp_tablet_pad_v2::Event,
        _: &(),
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
        if let zwp_tablet_pad_v2::Event::Removed = event {
            pad.destroy();
        }
    }

    event_created_child!(Tools, ZwpTabletPadV2, [
        zwp_tablet_pad_v2::EVT_GROUP_OPCODE => (ZwpTabletPadGroupV2, ()),
    ]);
}

impl Dispatch<ZwpTabletPadGroupV2, ()> for Tools {
    fn event(
        _: &mut Self,
        _: &ZwpTabletPadGroupV2,
        _: zwp_tablet_pad_group_v2::Event,
        _: &(),
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
    }

    event_created_child!(Tools, ZwpTabletPadGroupV2, [
        zwp_tablet_pad_group_v2::EVT_RING_OPCODE => (ZwpTabletPadRingV2, ()),
        zwp_tablet_pad_group_v2::EVT_STRIP_OPCODE => (ZwpTabletPadStripV2, ()),
    ]);
}

delegate_noop!(Tools: ignore WlSeat);
delegate_noop!(Tools: ignore ZwpTabletManagerV2);
delegate_noop!(Tools: ignore ZwpTabletPadRingV2);
delegate_noop!(Tools: ignore ZwpTabletPadStripV2);
delegate_noop!(Tools: ignore WpCursorShapeManagerV1);
delegate_noop!(Tools: ignore WpCursorShapeDeviceV1);

#[cfg(test)]
mod tests;
