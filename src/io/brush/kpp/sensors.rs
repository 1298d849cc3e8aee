//! Krita's sensors: what an option follows, and by which curve. Several multiply, as curves do
//! here. Floor 5.

use super::settings::{KppPreset, attribute, number};
use crate::math::vec2;
use crate::paint::dynamics::{Curve, Input, MAX_POINTS};
use quick_xml::Reader;
use quick_xml::events::Event;

/// What an option follows, unless its curves are off. Later presets may have one curve for all
/// sensors.
pub fn of_option(preset: &KppPreset, option: &str, notes: &mut Vec<String>) -> Vec<(Input, Curve)> {
    if preset.text(&format!("{option}UseCurve")) == "false" {
        return Vec::new();
    }
    let mut found = read(preset.text(&format!("{option}Sensor")), notes);
    let is_same = preset.text(&format!("{option}UseSameCurve")) != "false";
    let common = curve(preset.text(&format!("{option}commonCurve"))).filter(|_| is_same);
    if let Some(common) = common {
        found.iter_mut().for_each(|(_, curve)| *curve = common.clone());
    }
    found
}

/// The sensors of an option that have a counterpart; the others are reported once.
fn read(text: &str, notes: &mut Vec<String>) -> Vec<(Input, Curve)> {
    let mut reader = Reader::from_str(text);
    let mut found: Vec<(Input, Curve)> = Vec::new();
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
                        Some(input) => found.push((input, Curve::Share(1.0))),
                        None => note(&id, notes),
                    }
                }
            }
            Event::Text(points) if is_in_curve => {
                let curve = curve(&points);
                if let (Some(last), Some(curve)) = (found.last_mut(), curve) {
                    last.1 = curve;
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
