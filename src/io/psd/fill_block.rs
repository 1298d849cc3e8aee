//! The blocks that say what a layer or the line around its shape is filled with. Floor 5.

use super::colors::Colors;
use super::cursor::ByteCursor;
use super::descriptor::{self, DescriptorObject, DescriptorWriter};
use super::fill::{self, LayerFill, PatternFill, share};
use super::ramp;
use crate::math::srgb::Color;
use crate::math::vec2;

/// Reads the block of a fill; `None` where it holds what is not understood.
pub fn read(key: [u8; 4], mut data: ByteCursor, colors: &Colors) -> Option<LayerFill> {
    of_kind(key, &descriptor::read(&mut data)?, colors)
}

/// The block of a fill of one color.
pub fn of_color(color: Color) -> Vec<u8> {
    let mut out = DescriptorWriter::default();
    out.color("Clr ", color);
    out.into_bytes()
}

/// The fill that a line is drawn with; `None` where it is not understood.
pub fn of_line(said: &DescriptorObject, colors: &Colors) -> Option<LayerFill> {
    let key = match (said.object("Clr "), said.object("Grad")) {
        (Some(_), _) => *b"SoCo",
        (None, Some(_)) => *b"GdFl",
        (None, None) => *b"PtFl",
    };
    of_kind(key, said, colors)
}

fn of_kind(key: [u8; 4], said: &DescriptorObject, colors: &Colors) -> Option<LayerFill> {
    Some(match &key {
        b"SoCo" => LayerFill::Solid(fill::color(said.object("Clr ")?, colors)?),
        b"GdFl" => LayerFill::Gradient(ramp::gradient(said, colors)?),
        _ => {
            let phase = said.object("phase");
            let along = |name: &str| phase.and_then(|phase| phase.number(name)).unwrap_or(0.0);
            LayerFill::Pattern(PatternFill {
                id: said.object("Ptrn")?.text("Idnt")?.to_owned(),
                scale: share(said, "Scl ", 1.0).max(0.01).min(100.0),
                phase: vec2(along("Hrzn"), along("Vrtc")),
            })
        }
    })
}
