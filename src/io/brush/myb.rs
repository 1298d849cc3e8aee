//! MyPaint's brushes: settings, each a base value and curves over what the hand does that add to
//! it. JSON of version 3, and the text of versions 1 and 2 (`old`). Floor 5. `settings` are what a
//! file says, `curves` how inputs run here, `dab` what a dab looks like and `small` how large it
//! is, `stylus` how dabs follow the pen.

mod added;
mod curves;
mod dab;
mod old;
mod settings;
mod small;
mod stylus;

use super::ImportedBrush;
use crate::Budget;
use crate::json;
use crate::paint::Brush;
use crate::paint::dynamics::{Curve, Dynamics, Input, Property};
use crate::{Error, Result};
use added::Added;
use serde_json::{Map, Value};
use settings::MyPaintSettings;
use small::DabSmoothing;
use std::path::Path;

pub fn read(file: &Path, bytes: &[u8], budget: &Budget) -> Result<ImportedBrush> {
    let settings = if bytes.trim_ascii_start().starts_with(b"{") {
        newer(file, bytes, budget)?
    } else {
        old::read(file, bytes, budget)?
    };
    let mut settings = MyPaintSettings::new(&settings);
    let brush = brush(&mut settings);
    let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let name = if name.is_empty() { "Brush".to_owned() } else { name };
    let notes = settings.into_notes();
    Ok(ImportedBrush { name, brush, notes })
}

/// The settings of a JSON file.
fn newer(file: &Path, bytes: &[u8], budget: &Budget) -> Result<Map<String, Value>> {
    let mut value = json::parse_foreign(file, bytes, budget)?;
    let version = value.get("version").and_then(Value::as_f64);
    if version != Some(3.0) {
        let found = version.map_or("no version".to_owned(), |v| format!("version {v}"));
        return Err(Error::unsupported_file(
            file,
            format!("{found} of MyPaint's brushes; JSON of version 3 is read"),
        ));
    }
    match value.get_mut("settings").map(Value::take) {
        Some(Value::Object(settings)) => Ok(settings),
        _ => Err(Error::decode(file, "it holds no settings")),
    }
}

/// The lengths that settings are measured by.
#[derive(Clone, Copy)]
struct Lengths {
    /// The radius without what drives it, px.
    radius: f32,
    /// The diameter of the brush as it becomes here.
    size: f32,
    /// The dab's radius over what it becomes here, where all that drives it is halfway.
    shrunk: f32,
}

impl Lengths {
    /// Converts a length in their radii to one in our diameters.
    fn diameters(self) -> f32 {
        self.radius / self.size
    }
}

fn brush(settings: &mut MyPaintSettings) -> Brush {
    let custom = settings.custom().within(0.0, 0.0);
    let radius_log = settings.take_added("radius_logarithmic", 2.0);
    let base = settings.base("radius_logarithmic", 2.0);
    let here = dab::hardness(settings, radius_log.base.exp()).middle_value();
    let radius = DabSmoothing::new(settings, here).radius_log_here(radius_log.clone());
    let shrunk = (radius_log.middle_value() - radius.middle_value()).exp().max(0.2).min(5.0);
    // A constant is part of the size.
    let size = (2.0 * radius.base.max(-2.0).min(6.9).exp()).max(0.1);
    let lengths = Lengths { radius: base.max(-2.0).min(6.9).exp(), size, shrunk };
    // A sum of logarithms is a product here.
    let doublings = Added { base: 0.0, ..radius }.times(std::f32::consts::LOG2_E);
    let brush = Brush { size, dynamics: Dynamics::none(), ..Brush::default() };
    let brush = with(with(brush, Property::Size, &doublings), Property::Custom, &custom);
    let brush = dab::shape(settings, brush);
    let brush = dab::paint(settings, brush);
    let brush = stylus::spacing(settings, lengths, brush);
    let brush = dab::flow(settings, brush);
    let brush = stylus::strays(settings, lengths, brush);
    stylus::ways(settings, lengths, brush)
}

/// With the rows of a setting.
fn with(brush: Brush, property: Property, added: &Added) -> Brush {
    let curves = added.rows.iter().filter_map(|row| Some((row.input, row.curve()?)));
    let dynamics = curves
        .fold(brush.dynamics, |dynamics, (input, curve)| dynamics.with(property, input, curve));
    Brush { dynamics, ..brush }
}

/// With a constant that is added to a property that has no number of its own.
fn with_constant(brush: Brush, property: Property, value: f32) -> Brush {
    let curve = Curve::additive(vec![crate::math::vec2(0.0, value)]).filter(|_| value != 0.0);
    match curve {
        Some(curve) => {
            Brush { dynamics: brush.dynamics.with(property, Input::Pressure, curve), ..brush }
        }
        None => brush,
    }
}
