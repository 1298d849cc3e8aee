//! MyPaint's brushes (JSON, version 3): settings, each a base value plus curves over the inputs of the pen. Floor 5.
//! Curves multiply in this program: sums over several inputs are matched where all inputs are at their maximum.

mod curves;

use super::ImportedBrush;
use crate::Budget;
use crate::json;
use crate::paint::brush::Stabilizer;
use crate::paint::dynamics::{Curve, Dynamics, Input, Property};
use crate::paint::{Brush, Tip};
use crate::{Error, Result};
use curves::{DrivenSetting, MyPaintSetting, MyPaintSettings};
use std::path::Path;

pub fn read(file: &Path, bytes: &[u8], budget: &Budget) -> Result<ImportedBrush> {
    if !bytes.trim_ascii_start().starts_with(b"{") {
        return Err(Error::unsupported(file, "a MyPaint brush that is not JSON; versions before 3 are not read"));
    }
    let value = json::parse(file, bytes, budget)?;
    let version = value.get("version").and_then(serde_json::Value::as_i64);
    if version != Some(3) {
        let found = version.map_or("no version".to_owned(), |v| format!("version {v}"));
        return Err(Error::unsupported(file, format!("{found} of MyPaint's brushes; version 3 is read")));
    }
    let Some(settings) = value.get("settings").and_then(serde_json::Value::as_object) else {
        return Err(Error::decode(file, "it holds no settings"));
    };
    let mut settings = MyPaintSettings::new(settings);
    let brush = brush(&mut settings);
    let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let name = if name.is_empty() { "Brush".to_owned() } else { name };
    let notes = settings.into_notes();
    Ok(ImportedBrush { name, brush, notes })
}

fn brush(settings: &mut MyPaintSettings) -> Brush {
    let size = settings.driven("radius_logarithmic", 2.0, |v| 2.0 * v.clamp(-2.0, 8.0).exp());
    let hardness = settings.driven("hardness", 0.8, hardness_of);
    let scatter = settings.driven("offset_by_random", 0.0, |v| v.clamp(0.0, 10.0));
    let mut dynamics = Dynamics::none();
    for (property, driven) in [(Property::Size, &size), (Property::Hardness, &hardness), (Property::Scatter, &scatter)]
    {
        dynamics = with(dynamics, property, driven);
    }
    let spacing = spacing(settings);
    let (flow, dynamics) = flow(settings, spacing, dynamics);
    let (tip, rotation, dynamics) = ellipse(settings, dynamics);
    let jitter = jitter(settings);
    let stabilizer = match settings.plain("slow_tracking", 0.0) {
        // MyPaint's scale: at 1 the line clearly lags behind the pen, at 10 it crawls.
        slow if slow > 0.0 => Stabilizer::Average { weight: (slow / (slow + 1.5)).min(0.95) },
        _ => Stabilizer::None,
    };
    let (erases, keeps_alpha) = (settings.plain("eraser", 0.0) >= 0.5, settings.plain("lock_alpha", 0.0) >= 0.5);
    Brush {
        size: size.most.clamp(0.1, 20_000.0),
        hardness: hardness.most,
        flow,
        spacing,
        rotation,
        scatter: scatter.most,
        jitter,
        erases,
        keeps_alpha,
        tip,
        stabilizer,
        dynamics,
        ..Brush::default()
    }
}

/// A MyPaint dab's coverage falls in two lines over the squared radius; here it is a smoothstep. They agree where each
/// is one half.
fn hardness_of(hardness: f32) -> f32 {
    let h = hardness.clamp(0.001, 0.999);
    let half_squared = if h <= 0.5 { 0.5 * h / (1.0 - h) } else { 1.0 - 0.5 * (1.0 - h) / h };
    (2.0 * half_squared.sqrt() - 1.0).clamp(0.0, 1.0)
}

/// Dabs a radius, of the brush and of the dab, as a share of the diameter.
fn spacing(settings: &mut MyPaintSettings) -> f32 {
    let (actual, basic) = (settings.plain("dabs_per_actual_radius", 2.0), settings.plain("dabs_per_basic_radius", 0.0));
    if settings.plain("dabs_per_second", 0.0) > 0.0 {
        settings.note("Dabs that follow the clock are left out; dabs follow the way alone");
    }
    let per_radius = actual.max(0.0) + basic.max(0.0);
    (0.5 / per_radius.max(0.05)).clamp(0.01, 10.0)
}

/// How much one dab covers: MyPaint's opacity is the stroke's where dabs overlap, to the degree of `opaque_linearize`.
fn flow(settings: &mut MyPaintSettings, spacing: f32, dynamics: Dynamics) -> (f32, Dynamics) {
    let unit = |v: f32| v.clamp(0.0, 1.0);
    let (opaque, times) = (settings.driven("opaque", 1.0, unit), settings.opaque_multiply());
    let most = unit(opaque.most * times.most);
    let linear = settings.plain("opaque_linearize", 0.9).clamp(0.0, 2.0);
    let overlapping = (1.0 + linear * (1.0 / spacing - 1.0)).max(1.0);
    let flow = 1.0 - (1.0 - most.min(0.9999)).powf(1.0 / overlapping);
    let flow = if most >= 0.9999 { 1.0 } else { flow };
    (flow, with(with(dynamics, Property::Flow, &opaque), Property::Flow, &times))
}

fn ellipse(settings: &mut MyPaintSettings, dynamics: Dynamics) -> (Tip, f32, Dynamics) {
    let ratio = settings.driven("elliptical_dab_ratio", 1.0, |v| v.max(1.0));
    let angle = settings.setting("elliptical_dab_angle", 90.0);
    if ratio.most <= 1.001 {
        return (Tip::Round, 0.0, dynamics);
    }
    if !ratio.rows.is_empty() {
        settings.note("A tip that changes its shape keeps its flattest one");
    }
    let mut dynamics = dynamics;
    // MyPaint's angle is clockwise.
    let mut rotation = -angle.base;
    for (input, curve) in &angle.inputs {
        match settings.turns(input, curve) {
            Some((input, turned, curve)) => {
                rotation += turned;
                dynamics = dynamics.with(Property::Rotation, input, curve);
            }
            None => settings.note(&format!("The angle of the tip does not follow “{input}”")),
        }
    }
    (Tip::Ellipse { ratio: (1.0 / ratio.most).clamp(0.01, 1.0) }, rotation.rem_euclid(360.0), dynamics)
}

/// Colours that change at random from dab to dab.
fn jitter(settings: &mut MyPaintSettings) -> crate::paint::brush::ColorJitter {
    let mut farthest = |name: &'static str| {
        let setting = settings.setting(name, 0.0);
        for (input, _) in setting.inputs.iter().filter(|(input, _)| input != "random") {
            settings.note(&format!("“{name}” does not follow “{input}”"));
        }
        if setting.base != 0.0 {
            settings.note(&format!("“{name}” does not go on changing from dab to dab"));
        }
        let random = setting.inputs.iter().filter(|(input, _)| input == "random").flat_map(|(_, curve)| curve);
        random.map(|p| p.y.abs()).fold(0.0, f32::max)
    };
    crate::paint::brush::ColorJitter {
        hue_degrees: (360.0 * farthest("change_color_h")).min(180.0),
        saturation: farthest("change_color_hsv_s").min(1.0),
        value: farthest("change_color_v").min(1.0),
    }
}

/// With the rows of one setting; where an input drives a property twice, both count.
fn with(dynamics: Dynamics, property: Property, driven: &DrivenSetting) -> Dynamics {
    driven.rows.iter().fold(dynamics, |dynamics, (input, curve)| {
        let both = dynamics.curve(property, *input).and_then(|known| curves::product(known, curve));
        dynamics.with(property, *input, both.unwrap_or_else(|| curve.clone()))
    })
}

impl MyPaintSettings<'_> {
    /// The factor of `opaque`: the pressure, if a file does not say.
    fn opaque_multiply(&mut self) -> DrivenSetting {
        if self.has("opaque_multiply") {
            return self.driven("opaque_multiply", 0.0, |v| v.clamp(0.0, 2.0));
        }
        DrivenSetting { most: 1.0, rows: vec![(Input::Pressure, Curve::Share(1.0))] }
    }
    fn plain(&mut self, name: &'static str, default: f32) -> f32 {
        let MyPaintSetting { base, inputs } = self.setting(name, default);
        if !inputs.is_empty() {
            self.note(&format!("“{name}” follows nothing here"));
        }
        base
    }
}
