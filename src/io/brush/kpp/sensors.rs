//! Krita's sensors: what an option follows, and by which curve. Several multiply, as curves do
//! here. Floor 5.

use super::settings::{KppPreset, attribute, number};
use crate::math::vec2;
use crate::paint::Brush;
use crate::paint::dynamics::{Curve, FAR_DIAMETERS, Input, MAX_POINTS, Property};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::f32::consts::FRAC_PI_2;

/// Points of a curve that is computed.
const POINTS: usize = 17;

/// One sensor of an option.
struct KppSensor {
    input: Input,
    curve: Curve,
    length: SensorLength,
}

/// Where a curve over the stroke ends.
enum SensorLength {
    /// It is over something else.
    None,
    Px(f32),
    Dabs(f32),
}

impl SensorLength {
    fn of(id: &str, start: &BytesStart) -> Self {
        let length = |plain: f32| {
            attribute(start, "length").and_then(|text| number(&text)).unwrap_or(plain).max(1.0)
        };
        match id {
            "distance" => SensorLength::Px(length(30.0)),
            "fade" => SensorLength::Dabs(length(1000.0)),
            _ => SensorLength::None,
        }
    }

    /// In px for a brush.
    fn px(&self, brush: &Brush) -> Option<f32> {
        match self {
            SensorLength::None => None,
            SensorLength::Px(px) => Some(*px),
            SensorLength::Dabs(count) => Some(count * brush.spacing * brush.size),
        }
    }
}

/// What an option follows, unless its curves are off; what has no counterpart is reported once.
/// Later presets may have one curve for all sensors.
///
/// * `brush`: with its size and spacing.
pub fn of_option(
    preset: &KppPreset,
    option: &str,
    brush: &Brush,
    notes: &mut Vec<String>,
) -> Vec<(Input, Curve)> {
    if preset.text(&format!("{option}UseCurve")) == "false" {
        return Vec::new();
    }
    let mut found = read(preset.text(&format!("{option}Sensor")), notes);
    let is_same = preset.text(&format!("{option}UseSameCurve")) != "false";
    let common = curve(preset.text(&format!("{option}commonCurve"))).filter(|_| is_same);
    if let Some(common) = common {
        found.iter_mut().for_each(|sensor| sensor.curve = common.clone());
    }
    let is_product = preset.number(&format!("{option}curveMode")).is_none_or(|mode| mode == 0.0);
    if found.len() > 1 && !is_product {
        let name = option.split('/').next().unwrap_or_default().to_lowercase();
        notes.push(format!("what its {name} follows multiplies here"));
    }
    let along = |sensor: KppSensor| {
        let curve = match sensor.length.px(brush) {
            Some(px) => stretch(&sensor.curve, FAR_DIAMETERS * brush.size / px),
            None if sensor.input == Input::Tilt => curve_of(|x| sensor.curve.at(elevation(x))),
            None => None,
        };
        (sensor.input, curve.unwrap_or(sensor.curve))
    };
    found.into_iter().map(along).collect()
}

/// A brush of which one more input drives a property; the curve that it has there already stays as
/// a factor.
pub fn with_factor(mut brush: Brush, property: Property, input: Input, by: Curve) -> Brush {
    let both = match brush.dynamics.curve(property, input) {
        None => Some(by),
        Some(other) => curve_of(|x| by.at(x) * other.at(x)),
    };
    if let Some(curve) = both {
        brush.dynamics = brush.dynamics.with(property, input, curve);
    }
    brush
}

/// A curve of many points.
pub fn curve_of(at: impl Fn(f32) -> f32) -> Option<Curve> {
    let xs = (0..POINTS).map(|i| i as f32 / (POINTS - 1) as f32);
    Curve::through(xs.map(|x| vec2(x, at(x).max(0.0).min(1.0))).collect())
}

/// Krita's reading of a pen that leans so far, of 90°: 1 upright, 0 from 60° on.
fn elevation(tilt: f32) -> f32 {
    (1.5 * tilt).max(0.0).min(1.0).acos() / FRAC_PI_2
}

/// The curve over an input of which 1 is what was `share`.
fn stretch(curve: &Curve, share: f32) -> Option<Curve> {
    let share = share.max(1e-6);
    let line = [vec2(0.0, curve.at(0.0)), vec2(1.0, curve.at(1.0))];
    let points = match curve {
        Curve::Points(points) => points,
        _ => &line[..],
    };
    let inside = points.iter().filter(|point| point.x <= share);
    let mut points: Vec<_> = inside.map(|point| vec2(point.x / share, point.y)).collect();
    points.truncate(MAX_POINTS - 1);
    if share < 1.0 {
        points.push(vec2(1.0, curve.at(share)));
    }
    Curve::through(points)
}

/// The sensors that have a counterpart; the others are reported once.
fn read(text: &str, notes: &mut Vec<String>) -> Vec<KppSensor> {
    let mut reader = Reader::from_str(text);
    let mut found: Vec<KppSensor> = Vec::new();
    let mut is_in_curve = false;
    loop {
        let Ok(event) = reader.read_event() else { return found };
        match event {
            Event::Start(start) | Event::Empty(start) => {
                is_in_curve = start.local_name().as_ref() == "curve";
                let is_sensor = matches!(start.local_name().as_ref(), "params" | "ChildSensor");
                if let Some(id) =
                    attribute(&start, "id").filter(|id| is_sensor && id != "sensorslist")
                {
                    match input(&id) {
                        // Without a curve of its own it is linear.
                        Some(input) => found.push(KppSensor {
                            input,
                            curve: Curve::Share(1.0),
                            length: SensorLength::of(&id, &start),
                        }),
                        None => note(&id, notes),
                    }
                }
            }
            Event::Text(points) if is_in_curve => {
                let curve = curve(&points);
                if let (Some(last), Some(curve)) = (found.last_mut(), curve) {
                    last.curve = curve;
                }
            }
            Event::End(_) => is_in_curve = false,
            Event::Eof => return found,
            _ => {}
        }
    }
}

fn note(id: &str, notes: &mut Vec<String>) {
    let id: String = id.chars().filter(|c| !c.is_control()).take(40).collect();
    let note = format!("nothing here follows “{id}”");
    if !notes.contains(&note) {
        notes.push(note);
    }
}

fn input(id: &str) -> Option<Input> {
    Some(match id {
        "pressure" | "pressurein" => Input::Pressure,
        "speed" => Input::Speed,
        "fuzzy" => Input::Random,
        "drawingangle" => Input::Direction,
        "ascension" => Input::TiltDirection,
        "declination" => Input::Tilt,
        "distance" | "fade" => Input::Distance,
        _ => return None,
    })
}

/// `x,y;x,y;`, each from 0 to 1 and rising.
fn curve(text: &str) -> Option<Curve> {
    let pairs =
        text.split(';').filter(|pair| !pair.trim().is_empty()).take(MAX_POINTS).map(|pair| {
            let mut numbers = pair.split(',').map(number);
            Some(vec2(numbers.next()??, numbers.next()??))
        });
    Curve::through(pairs.collect::<Option<Vec<_>>>()?)
}
