//! The options of a Krita preset that follow sensors. Floor 5. Not here: what a sensor is
//! (`sensors`).

use super::sensors;
use super::settings::KppPreset;
use crate::paint::Brush;
use crate::paint::dynamics::Property;

/// The options that follow a sensor, by the words that Krita keeps them under.
const OPTIONS: [(&str, Property); 6] = [
    ("Size", Property::Size),
    ("Opacity", Property::Opacity),
    ("Flow", Property::Flow),
    ("Softness", Property::Hardness),
    ("Rotation", Property::Rotation),
    ("Spacing", Property::Spacing),
];
/// Options that later presets cannot switch off, and do not say to be on.
const ALWAYS: [&str; 2] = ["Opacity", "Flow"];

/// A brush with what its options follow.
pub fn read(preset: &KppPreset, brush: Brush, notes: &mut Vec<String>) -> Brush {
    let mut brush = brush;
    // Dabs that build up have their opacity each, not the stroke.
    let is_built_up = preset.number("PaintOpAction") == Some(1.0);
    if is_built_up {
        brush.flow *= std::mem::replace(&mut brush.opacity, 1.0);
    }
    let follow = |brush: Brush, option: &str, property: Property, notes: &mut Vec<String>| {
        let is_on = match preset.text(&format!("Pressure{option}")) {
            "true" => true,
            "" => ALWAYS.contains(&option),
            _ => false,
        };
        if !is_on {
            return brush;
        }
        let found = sensors::of_option(preset, option, &brush, notes);
        let add = |brush, (input, curve)| sensors::with_factor(brush, property, input, curve);
        found.into_iter().fold(brush, add)
    };
    for (option, property) in OPTIONS {
        let each = is_built_up && property == Property::Opacity;
        let property = if each { Property::Flow } else { property };
        brush = follow(brush, option, property, notes);
    }
    if preset.is_true("PressureScatter") {
        // Theirs is a width, ours a radius.
        brush.scatter = (0.5 * preset.number("ScatterValue").unwrap_or(1.0)).max(0.0).min(10.0);
        brush = follow(brush, "Scatter", Property::Scatter, notes);
    }
    brush
}
