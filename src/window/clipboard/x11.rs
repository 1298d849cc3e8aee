//! Pictures in the clipboard of an X server, as the files that their owner offers: a JPEG stays
//! one, 16 bits stay 16 bits. Wayland's clipboard is reached through XWayland. Floor 7. X11 only.
//! Not here: decoding them (`io::picture`).

use crate::{Error, Result};
use std::time::{Duration, Instant};
use x11rb::connection::Connection;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    Atom, AtomEnum, ChangeWindowAttributesAux, ConnectionExt as _, CreateWindowAux, EventMask,
    GetPropertyReply, Property, Window, WindowClass,
};
use x11rb::rust_connection::RustConnection;
use x11rb::{COPY_DEPTH_FROM_PARENT, COPY_FROM_PARENT, CURRENT_TIME, NONE};

/// What programs call pictures, the best first, and the ending of such a file.
const TARGETS: [(&str, &str); 9] = [
    ("image/png", "png"),
    ("image/tiff", "tiff"),
    ("image/webp", "webp"),
    ("image/bmp", "bmp"),
    ("image/x-bmp", "bmp"),
    ("image/x-MS-bmp", "bmp"),
    ("image/jpeg", "jpg"),
    ("image/jpg", "jpg"),
    ("image/pjpeg", "jpg"),
];

/// How long the owner may do nothing.
const PATIENCE: Duration = Duration::from_secs(5);
const LOOK_AGAIN: Duration = Duration::from_millis(2);

/// The bytes of a picture's file, and its ending.
pub type PictureFile = (&'static str, Vec<u8>);

/// The picture in the clipboard; `None` if there is none, or no server. Fails if it has more than
/// `most_bytes`, or its owner does not answer.
pub fn picture(most_bytes: u64) -> Result<Option<PictureFile>> {
    let Ok((connection, screen)) = x11rb::connect(None) else { return Ok(None) };
    let reader = SelectionReader::new(connection, screen, most_bytes)?;
    let target = reader.atom("TARGETS")?;
    let Some(offered) = reader.read(target)? else { return Ok(None) };
    let offered: Vec<Atom> =
        offered.as_chunks().0.iter().map(|atom| Atom::from_ne_bytes(*atom)).collect();
    for (name, ending) in TARGETS {
        let target = reader.atom(name)?;
        if offered.contains(&target)
            && let Some(bytes) = reader.read(target)?.filter(|bytes| !bytes.is_empty())
        {
            return Ok(Some((ending, bytes)));
        }
    }
    Ok(None)
}

fn failure(error: impl ToString) -> Error {
    Error::unsupported_file("clipboard", error)
}

/// Asks the owner of the clipboard for its content, which it puts into a property of a window of
/// ours.
struct SelectionReader {
    connection: RustConnection,
    window: Window,
    selection: Atom,
    property: Atom,
    /// The type of a property that comes in pieces.
    in_pieces: Atom,
    most_bytes: u64,
}

impl SelectionReader {
    fn new(connection: RustConnection, screen: usize, most_bytes: u64) -> Result<Self> {
        let root = connection
            .setup()
            .roots
            .get(screen)
            .ok_or_else(|| failure("the display has no screen"))?
            .root;
        let window = connection.generate_id().map_err(failure)?;
        let kind = WindowClass::INPUT_ONLY;
        let made = connection.create_window(
            COPY_DEPTH_FROM_PARENT,
            window,
            root,
            0,
            0,
            1,
            1,
            0,
            kind,
            COPY_FROM_PARENT,
            &CreateWindowAux::new(),
        );
        made.map_err(failure)?;
        let hears = ChangeWindowAttributesAux::new().event_mask(EventMask::PROPERTY_CHANGE);
        connection.change_window_attributes(window, &hears).map_err(failure)?;
        let mut reader =
            Self { connection, window, selection: 0, property: 0, in_pieces: 0, most_bytes };
        reader.selection = reader.atom("CLIPBOARD")?;
        reader.property = reader.atom("RILIEVO_PASTED")?;
        reader.in_pieces = reader.atom("INCR")?;
        Ok(reader)
    }

    fn atom(&self, name: &str) -> Result<Atom> {
        let asked = self.connection.intern_atom(false, name.as_bytes()).map_err(failure)?;
        Ok(asked.reply().map_err(failure)?.atom)
    }

    /// The content as a target; `None` if there is none.
    fn read(&self, target: Atom) -> Result<Option<Vec<u8>>> {
        let (window, property) = (self.window, self.property);
        let asked = self.connection.convert_selection(
            window,
            self.selection,
            target,
            property,
            CURRENT_TIME,
        );
        asked.map_err(failure)?;
        let answer = self.await_event(|event| match event {
            Event::SelectionNotify(answer)
                if answer.requestor == window && answer.target == target =>
            {
                Some(answer)
            }
            _ => None,
        })?;
        if answer.property == NONE {
            return Ok(None);
        }
        let first = self.take()?;
        if first.type_ != self.in_pieces {
            return Ok(Some(first.value));
        }
        let mut bytes = Vec::new();
        loop {
            self.await_event(|event| match event {
                Event::PropertyNotify(changed) => {
                    let is_ours = changed.window == window && changed.atom == property;
                    (is_ours && changed.state == Property::NEW_VALUE).then_some(())
                }
                _ => None,
            })?;
            let piece = self.take()?.value;
            if piece.is_empty() {
                return Ok(Some(bytes));
            }
            self.check(bytes.len() as u64 + piece.len() as u64)?;
            bytes.extend(piece);
        }
    }

    /// Takes what the property holds; that it is deleted tells the owner to go on.
    fn take(&self) -> Result<GetPropertyReply> {
        let asked =
            self.connection.get_property(false, self.window, self.property, AtomEnum::ANY, 0, 0);
        self.check(asked.map_err(failure)?.reply().map_err(failure)?.bytes_after.into())?;
        let asked = self.connection.get_property(
            true,
            self.window,
            self.property,
            AtomEnum::ANY,
            0,
            u32::MAX / 4,
        );
        asked.map_err(failure)?.reply().map_err(failure)
    }

    fn check(&self, bytes: u64) -> Result<()> {
        let most = self.most_bytes;
        if bytes > most {
            Err(failure(format!("its picture has more than {most} bytes")))
        } else {
            Ok(())
        }
    }

    /// The first event that is meant; others are passed over.
    fn await_event<T>(&self, meant: impl Fn(Event) -> Option<T>) -> Result<T> {
        self.connection.flush().map_err(failure)?;
        let began = Instant::now();
        while began.elapsed() < PATIENCE {
            match self.connection.poll_for_event().map_err(failure)? {
                Some(event) => {
                    if let Some(found) = meant(event) {
                        return Ok(found);
                    }
                }
                None => std::thread::sleep(LOOK_AGAIN),
            }
        }
        Err(failure("the program that holds it does not answer"))
    }
}
