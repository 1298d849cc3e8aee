//! Pens on X11, XWayland's too: finds which device moves the pointer now, and which of its axes are
//! pressure and tilt, by querying the server. The values of the axes come with the window's own
//! events. Floor 7. X11 only. If the server does not reply, everything is a mouse.

use super::{AxisMeaning, PenAxes, PenAxis, PenDevices, PenNews};
use x11rb::connection::Connection;
use x11rb::errors::ReplyError;
use x11rb::protocol::Event;
use x11rb::protocol::xinput::{
    self, ConnectionExt, DeviceClass, DeviceClassData, DeviceId, Fp3232, XIEventMask,
};
use x11rb::protocol::xproto::{Atom, ConnectionExt as _};
use x11rb::rust_connection::RustConnection;

/// All pointers that slave devices move, by the server's number.
const ALL_MASTERS: DeviceId = 1;

/// The server's names of a pen's axes.
const LABELS: [(&[u8], AxisMeaning); 3] = [
    (b"Abs Pressure", AxisMeaning::Pressure),
    (b"Abs Tilt X", AxisMeaning::TiltX),
    (b"Abs Tilt Y", AxisMeaning::TiltY),
];

/// The X server, queried on a connection of its own.
pub struct X11Server {
    connection: RustConnection,
    labels: Vec<(Atom, AxisMeaning)>,
    /// Found when connecting, not yet reported.
    first: Option<PenAxes>,
    /// The connection is broken: there is no more information.
    is_gone: bool,
}

impl X11Server {
    /// `None` if there is no server, or none that supports pens.
    pub fn connect() -> Option<Self> {
        let (connection, screen) = x11rb::connect(None).ok()?;
        let root = connection.setup().roots.get(screen)?.root;
        Self::listen(connection, root).ok()
    }

    fn listen(connection: RustConnection, root: u32) -> Result<Self, ReplyError> {
        connection.xinput_xi_query_version(2, 2)?.reply()?;
        let changes =
            xinput::EventMask { deviceid: ALL_MASTERS, mask: vec![XIEventMask::DEVICE_CHANGED] };
        connection.xinput_xi_select_events(root, &[changes])?.check()?;
        let mut labels = Vec::new();
        for (name, reads) in LABELS {
            labels.push((connection.intern_atom(false, name)?.reply()?.atom, reads));
        }
        let mut server = Self { connection, labels, first: None, is_gone: false };
        let masters = server.connection.xinput_xi_query_device(ALL_MASTERS)?.reply()?.infos;
        let pointer =
            masters.iter().find(|device| device.type_ == xinput::DeviceType::MASTER_POINTER);
        server.first = pointer.map(|pointer| {
            let source = pointer.classes.first().map_or(pointer.deviceid, |class| class.sourceid);
            server.axes(source, &pointer.classes)
        });
        Ok(server)
    }

    fn axes(&self, source: DeviceId, classes: &[DeviceClass]) -> PenAxes {
        let axis = |class: &DeviceClass| match class.data {
            DeviceClassData::Valuator(valuator) => {
                let (_, reads) = self.labels.iter().find(|(label, _)| *label == valuator.label)?;
                let range = (number(valuator.min), number(valuator.max));
                PenAxis::new(valuator.number.into(), *reads, range, number(valuator.value))
            }
            _ => None,
        };
        let axes: Vec<_> = classes.iter().filter_map(axis).collect();
        // The server distinguishes a pen's two ends only by their names.
        let is_eraser = !axes.is_empty() && self.name(source).to_lowercase().contains("eraser");
        PenAxes { device: source.into(), axes, is_eraser }
    }

    /// Empty for a device that was removed.
    fn name(&self, device: DeviceId) -> String {
        let asked = self.connection.xinput_xi_query_device(device).map_err(ReplyError::from);
        let known =
            asked.and_then(|asked| asked.reply()).map(|reply| reply.infos).unwrap_or_default();
        known
            .first()
            .map_or_else(String::new, |device| String::from_utf8_lossy(&device.name).into_owned())
    }
}

impl PenDevices for X11Server {
    /// Only the last device counts: the axes of a motion come with the window's events.
    fn read(&mut self) -> Vec<PenNews> {
        let mut last = self.first.take();
        while !self.is_gone {
            match self.connection.poll_for_event() {
                Ok(Some(Event::XinputDeviceChanged(change))) => {
                    last = Some(self.axes(change.sourceid, &change.classes))
                }
                Ok(Some(_)) => {}
                Ok(None) => break,
                Err(_) => self.is_gone = true,
            }
        }
        last.map(PenNews::Follow).into_iter().collect()
    }
}

/// 32 bits of whole numbers and 32 of their fractions.
fn number(fixed: Fp3232) -> f64 {
    f64::from(fixed.integral) + f64::from(fixed.frac) / 4_294_967_296.0
}
