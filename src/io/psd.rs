//! Photoshop documents, in and out: the format that illustrators exchange (docs/PROJECTS.md says
//! what is carried). Floor 5. Every kind of colors in, PSD and PSB, RGB and gray with up to 16
//! bits; 8-bit RGB out.
//!
//! | file | |
//! |---|---|
//! | `cursor`, `descriptor` | numbers, sections and named values read from bytes, never beyond their end |
//! | `channel` | planes of bytes or 16 bits, plain, PackBits or ZIP |
//! | `colors` | what planes mean, as sRGB |
//! | `parse`, `layers`, `blocks` | a file into its parts, its records and what follows them |
//! | `masks`, `outline` | masks that are pictures, and those that are paths |
//! | `adjustments` | what adjustment layers do |
//! | `gray`, `inks` | adjustments of gray values and inks with a profile, as tables of sRGB |
//! | `ink_layers` | layers of inks with the colors that they have on each other |
//! | `profiled` | layers of RGB that keep the values of the file's profile, beneath a table |
//! | `knockout` | layers that hide what is beneath them in their group |
//! | `layer_base`, `nesting` | what layers are clipped to, and layers that become groups |
//! | `effects` | shadows, glows and other effects of layers |
//! | `ramp` | how colors mix between those of a gradient |
//! | `fill`, `fill_block`, `pattern`, `filled` | what fill layers are filled with, besides the pixels that show it |
//! | `line` | the line around a shape |
//! | `shape` | shapes as live paths, and paths as shapes |
//! | `alpha_channels` | selections, the channels besides the colors |
//! | `marks` | guides, and the colors of layers in the list |
//! | `merged` | the picture that the file holds of all its layers |
//! | `tree` | records into a document |
//! | `read` | a file into the document that looks most like its own picture |
//! | `restore` | the document that our own files hold |
//! | `compare` | whether that looks like the file's own picture, and what is done if it does not |
//! | `export` | a document into records |
//! | `isolation` | whether a group can be composed by itself |
//! | `write` | records into a file |
//! | `verify` | that file read again and compared |
//!
//! Our files hold a private resource with the document itself, so that live layers come back live.

mod adjustments;
mod alpha_channels;
mod blocks;
pub(super) mod channel;
mod colors;
mod compare;
pub(super) mod cursor;
pub(super) mod descriptor;
mod effects;
mod export;
mod fill;
mod fill_block;
mod filled;
mod gray;
mod header;
mod ink_layers;
mod inks;
mod isolation;
mod knockout;
mod layer_base;
mod layers;
mod line;
mod marks;
mod masks;
mod merged;
mod nesting;
mod outline;
mod parse;
pub(super) mod pattern;
mod profiled;
mod ramp;
mod read;
mod restore;
mod shape;
#[cfg(test)]
mod tests;
mod tree;
mod verify;
mod write;

pub(crate) use colors::Press;
pub use export::write;
pub use read::read;

use crate::document::{Document, LayerLabel};
use crate::math::Rect;
use crate::paint::{ColorAdjustment, LivePath};
use blocks::ArtboardBackground;
use effects::RecordEffects;
use fill::LayerFill;
use line::ShapeLine;
use outline::VectorPaths;

/// The signature of a file.
pub const MAGIC: [u8; 4] = *b"8BPS";
/// Image resources.
const RESOLUTION: u16 = 1005;
const ICC_PROFILE: u16 = 1039;
const VERSION_INFO: u16 = 1057;
/// Our number among those reserved for plug-ins: a zip of the document and its files.
const OURS: u16 = 4711;

/// Records of a file: of a group two.
const MOST_RECORDS: usize = 2 * Document::MOST_LAYERS;
/// The key of a group whose layers blend with what is beneath the group.
const PASS_THROUGH: [u8; 4] = *b"pass";

/// A layer as stored in the file; groups are records too, around those of their layers.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerRecord {
    /// The layer's name.
    pub name: String,
    /// The canvas pixels that it holds.
    pub rect: Rect,
    /// The key of its blend mode.
    pub blend: [u8; 4],
    /// 255 is opaque.
    pub opacity: u8,
    /// Of its pixels alone, not of its effects.
    pub fill_opacity: u8,
    /// It is clipped to the layer below.
    pub clipped: bool,
    /// It is shown.
    pub visible: bool,
    /// Its transparency is locked.
    pub lock_alpha: bool,
    /// All of it is locked.
    pub lock_all: bool,
    /// As in the format.
    pub label: LayerLabel,
    /// Whether it is a layer, or the beginning or the end of a group.
    pub section: RecordSection,
    /// Its mask that is a picture.
    pub mask: Option<RecordMask>,
    /// What its effects follow, if that is more than its pixels cover.
    pub effect_shape: Option<RecordMask>,
    /// Its masks that are paths.
    pub outline: Option<VectorPaths>,
    /// The path that it is, if one says its shape, its color and its line.
    pub path: Option<LivePath>,
    /// What it is filled with.
    pub fill: Option<LayerFill>,
    /// It adjusts what is beneath it.
    pub adjustment: Option<ColorAdjustment>,
    /// What it does to the fourth ink of CMYK, if that is something else.
    pub adjustment_of_black: Option<ColorAdjustment>,
    /// It is an artboard.
    pub ground: Option<ArtboardBackground>,
    /// The point that patterns of its effects begin at, on the canvas.
    pub reference: Option<(f64, f64)>,
    /// Its effects, and what is left out of them.
    pub effects: Option<RecordEffects>,
    /// Its mask hides its effects, too.
    pub masks_effects: bool,
    /// It hides what is beneath it in its group.
    pub knocks_out: bool,
    /// Layers clipped to it lie on what is beneath it, too.
    pub clips_apart: bool,
    /// Its effects and what is clipped to it ignore its own transparency.
    pub ignores_alpha: bool,
    /// The effects within it are part of what its fill opacity and its blend mode are of.
    pub fills_with_effects: bool,
    /// It is a shape, whose pixels show its vector mask.
    pub is_shape: bool,
    /// A line is drawn around its shape.
    pub stroked: bool,
    /// That line, if it is understood.
    pub line: Option<ShapeLine>,
    /// The line lies on what is clipped to the shape, and on effects within it.
    pub line_is_over: bool,
    /// It is filled with what is not understood.
    pub has_unknown_fill: bool,
    /// Its shape is not filled.
    pub unfilled: bool,
    /// Straight RGBA of `rect`, row by row.
    pub rgba: Vec<u8>,
    /// What it was rounded from, if the file has more than 8 bits a channel; else empty.
    pub rgba16: Vec<[u16; 4]>,
    /// The values of the file's colors, of inks the light that they let through, if that is asked
    /// for; else empty.
    pub inks: Vec<[u16; 4]>,
    /// What is left out of it, and so may be missing in the picture.
    pub lost: Vec<&'static str>,
    /// What it was turned into without changing its look.
    pub converted: Vec<&'static str>,
}

impl LayerRecord {
    /// Notes that a feature was left out, and that the picture may differ.
    pub fn leave_out(&mut self, what: &'static str) {
        if !self.lost.contains(&what) {
            self.lost.push(what);
        }
    }

    /// Whether something lies between its shape and the line around it: what is clipped to it, or
    /// effects within it.
    fn is_parted_by(&self, has_clipped: bool) -> bool {
        let has_within = self.effects.as_ref().is_some_and(RecordEffects::has_within);
        !self.clipped && (has_clipped || has_within)
    }

    /// A shape of one color that is thin or soft at its outline also paints beyond that, where its
    /// pixels end: its color and its mask tell more.
    pub fn show_beyond_shape(&mut self) {
        let is_plain = !self.stroked && !self.unfilled;
        if is_plain && matches!(self.fill, Some(LayerFill::Solid(_))) {
            (self.rgba, self.rgba16) = (Vec::new(), Vec::new());
        }
    }

    /// Notes what was changed without changing the picture.
    pub fn note_conversion(&mut self, what: &'static str) {
        if !self.converted.contains(&what) {
            self.converted.push(what);
        }
    }
}

/// A visible layer without a name, without pixels.
impl Default for LayerRecord {
    fn default() -> Self {
        Self {
            name: String::new(),
            rect: Rect::EMPTY,
            blend: *b"norm",
            opacity: 255,
            fill_opacity: 255,
            clipped: false,
            visible: true,
            lock_alpha: false,
            lock_all: false,
            label: LayerLabel::None,
            section: RecordSection::Layer,
            mask: None,
            effect_shape: None,
            outline: None,
            path: None,
            fill: None,
            adjustment: None,
            adjustment_of_black: None,
            ground: None,
            reference: None,
            effects: None,
            masks_effects: false,
            knocks_out: false,
            clips_apart: false,
            ignores_alpha: false,
            fills_with_effects: false,
            is_shape: false,
            stroked: false,
            line: None,
            line_is_over: false,
            has_unknown_fill: false,
            unfilled: false,
            rgba: Vec::new(),
            rgba16: Vec::new(),
            inks: Vec::new(),
            lost: Vec::new(),
            converted: Vec::new(),
        }
    }
}

/// The role of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordSection {
    /// A layer with pixels.
    Layer,
    /// The bottom of a group; its layers follow, then its [`RecordSection::Group`].
    End,
    /// The beginning of a group in the file's order from above.
    Group,
}

/// A layer's mask: coverage in its rectangle, and everywhere else.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordMask {
    /// The canvas pixels that it holds.
    pub rect: Rect,
    /// Its value outside of these.
    pub outside: u8,
    /// Its values, row by row.
    pub values: Vec<u8>,
    /// Put aside.
    pub disabled: bool,
}

/// A checksum of the layers without their pixels: it shows whether another program changed them.
fn signature(records: &[LayerRecord]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    for r in records {
        let flags = [r.clipped, r.visible, r.lock_alpha, r.lock_all].map(u8::from);
        hasher.update(
            format!("{:?}{:?}{:?}{}{flags:?}{:?}", r.name, r.rect, r.blend, r.opacity, r.section)
                .as_bytes(),
        );
        if let Some(adjustment) = &r.adjustment {
            hasher.update(format!("{adjustment:?}").as_bytes());
        }
        if let Some(effects) = &r.effects {
            hasher.update(format!("{effects:?}").as_bytes());
        }
        if r.fill_opacity < 255 {
            hasher.update(&[r.fill_opacity]);
        }
        if let Some(mask) = &r.mask {
            hasher.update(format!("{:?}{}", mask.rect, mask.outside).as_bytes());
            hasher.update(&mask.values);
        }
    }
    hasher.finalize()
}
