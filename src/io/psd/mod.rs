//! Photoshop documents, in and out: the exchange format of illustrators (docs/PROJECTS.md lists what is kept).
//! Floor 5. 8- and 16-bit RGB and grey in, PSD and PSB; 8-bit RGB out.
//!
//! | file | |
//! |---|---|
//! | `cursor` | numbers and sections read from bytes, never beyond their end |
//! | `channel` | planes of bytes, plain, PackBits or ZIP |
//! | `parse`, `layers` | a file into its parts and its records |
//! | `tree` | records into a document |
//! | `lower` | a document into records |
//! | `emit` | records into a file |
//!
//! Our files hold a private resource with the document itself, so that live layers come back live.

pub(super) mod channel;
pub(super) mod cursor;
mod emit;
mod layers;
mod lower;
mod parse;
#[cfg(test)]
mod tests;
mod tree;

pub use lower::write;
pub use tree::read;

use crate::math::Rect;

/// The signature of a file.
pub const MAGIC: [u8; 4] = *b"8BPS";
/// Image resources.
const RESOLUTION: u16 = 1005;
const ICC_PROFILE: u16 = 1039;
const VERSION_INFO: u16 = 1057;
/// Our number among those reserved for plug-ins: a zip of the document and its files.
const OURS: u16 = 4711;

/// The key of a group whose layers blend with what lies beneath it.
const PASS_THROUGH: [u8; 4] = *b"pass";

/// A layer as stored in the file; groups are records too, around those of their layers.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerRecord {
    pub name: String,
    pub rect: Rect,
    pub blend: [u8; 4],
    pub opacity: u8,
    pub clipped: bool,
    pub visible: bool,
    pub lock_alpha: bool,
    pub lock_all: bool,
    pub section: RecordSection,
    pub mask: Option<RecordMask>,
    /// Straight RGBA of `rect`, row by row.
    pub rgba: Vec<u8>,
    /// Features of the layer that are not imported.
    pub lost: Vec<&'static str>,
}

/// A visible layer without a name, without pixels.
impl Default for LayerRecord {
    fn default() -> Self {
        Self {
            name: String::new(),
            rect: Rect::EMPTY,
            blend: *b"norm",
            opacity: 255,
            clipped: false,
            visible: true,
            lock_alpha: false,
            lock_all: false,
            section: RecordSection::Layer,
            mask: None,
            rgba: Vec::new(),
            lost: Vec::new(),
        }
    }
}

/// The role of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordSection {
    Layer,
    /// The bottom of a group; its layers follow, then its [`RecordSection::Group`].
    End,
    Group,
}

/// A layer's mask: coverage in its rectangle, and everywhere else.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordMask {
    pub rect: Rect,
    pub outside: u8,
    pub values: Vec<u8>,
}

/// A checksum of the layers without their pixels: it shows whether another program changed them.
fn signature(records: &[LayerRecord]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    for r in records {
        let flags = [r.clipped, r.visible, r.lock_alpha, r.lock_all].map(u8::from);
        hasher.update(format!("{:?}{:?}{:?}{}{flags:?}{:?}", r.name, r.rect, r.blend, r.opacity, r.section).as_bytes());
        if let Some(mask) = &r.mask {
            hasher.update(format!("{:?}{}", mask.rect, mask.outside).as_bytes());
            hasher.update(&mask.values);
        }
    }
    hasher.finalize()
}
