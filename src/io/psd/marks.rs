//! What belongs to a document besides its layers: guides, the label colors of layers, and the
//! light of effects. Floor 5.

use super::cursor::ByteCursor;
use super::header::resource;
use crate::document::{Document, Guides, LayerLabel};
use crate::math::COORDINATE;
use crate::paint::EffectLight;

/// The grid and the guides.
const GUIDES: u16 = 1032;
/// The light of effects.
const EFFECT_ANGLE: u16 = 1037;
const EFFECT_ALTITUDE: u16 = 1049;
/// A step of a guide's place, px.
const STEPS_A_PX: f32 = 32.0;
/// Default distance between the lines of the grid, in the same steps.
const GRID: u32 = 576;

/// Photoshop's colors of layers, in the order of their numbers.
const LABELS: [LayerLabel; 8] = [
    LayerLabel::None,
    LayerLabel::Red,
    LayerLabel::Orange,
    LayerLabel::Yellow,
    LayerLabel::Green,
    LayerLabel::Blue,
    LayerLabel::Purple,
    LayerLabel::Gray,
];

/// A label of the format: there is no brown.
pub fn nearest_label(label: LayerLabel) -> LayerLabel {
    if LABELS.contains(&label) { label } else { LayerLabel::Orange }
}

/// The block of a label.
pub fn label_block(label: LayerLabel) -> [u8; 8] {
    let number = LABELS.iter().position(|known| *known == label).unwrap_or(0);
    [0, number as u8, 0, 0, 0, 0, 0, 0]
}

pub fn label(mut data: ByteCursor) -> LayerLabel {
    let number = data.u16().map_or(0, usize::from);
    LABELS.get(number).copied().unwrap_or(LayerLabel::None)
}

/// The light of effects: its direction and its height, degrees.
pub fn effect_light(resources: ByteCursor) -> EffectLight {
    let degrees = |id| ByteCursor::new(resource(resources, id)?).i32().map(|v| v as f32);
    let plain = EffectLight::default();
    let light = EffectLight {
        angle: degrees(EFFECT_ANGLE).unwrap_or(plain.angle),
        altitude: degrees(EFFECT_ALTITUDE).unwrap_or(plain.altitude),
    };
    light.clamp_to_ranges()
}

/// The resources that hold it, in whole degrees.
pub fn effect_light_resources(light: EffectLight) -> [(u16, Vec<u8>); 2] {
    [(EFFECT_ANGLE, light.angle), (EFFECT_ALTITUDE, light.altitude)]
        .map(|(id, degrees)| (id, (degrees.round() as i32).to_be_bytes().to_vec()))
}

/// The guides as the format holds them: to a 32nd of a pixel.
pub fn guides_to_write(document: &Document) -> Guides {
    let near =
        |lines: &[f32]| lines.iter().map(|at| (at * STEPS_A_PX).round() / STEPS_A_PX).collect();
    Guides {
        vertical: near(&document.guides.vertical),
        horizontal: near(&document.guides.horizontal),
    }
}

/// The resource that holds them; `None` where there are none.
pub fn guides_resource(guides: &Guides) -> Option<(u16, Vec<u8>)> {
    let count = guides.vertical.len() + guides.horizontal.len();
    let mut out: Vec<u8> =
        [1, GRID, GRID, count as u32].into_iter().flat_map(u32::to_be_bytes).collect();
    for (lines, is_level) in [(&guides.vertical, 0), (&guides.horizontal, 1)] {
        for at in lines {
            out.extend(((at * STEPS_A_PX).round() as i32).to_be_bytes());
            out.push(is_level);
        }
    }
    (count > 0).then_some((GUIDES, out))
}

/// The guides of a file, and how many were left out.
pub fn guides(resources: ByteCursor) -> (Guides, usize) {
    let mut guides = Guides::default();
    let mut data = ByteCursor::new(resource(resources, GUIDES).unwrap_or_default());
    let mut head = || Some((data.u32()?, data.u32()?, data.u32()?, data.u32()?));
    let Some((1, _, _, count)) = head() else { return (guides, 0) };
    let mut left_out = 0;
    for _ in 0..count {
        let (Some(at), Some(is_level)) = (data.i32(), data.u8()) else { break };
        let at = at as f32 / STEPS_A_PX;
        let lines = if is_level == 1 { &mut guides.horizontal } else { &mut guides.vertical };
        if lines.len() < Guides::MOST && COORDINATE.contains(&at) {
            lines.push(at);
        } else {
            left_out += 1;
        }
    }
    (guides, left_out)
}
