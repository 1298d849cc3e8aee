//! Strokes, brushes, images and gradients that a file can hold.
//! Floor 4.

use super::Fit;
use crate::math::range::{STOPS, at_most, within};
use crate::math::{COORDINATE, NumberSetting, TURNS, UNIT, Vec2};
use crate::paint::adjustment::ToneCurve;
use crate::paint::grain::{BrushGrain, GrainSpace};
use crate::paint::settings::SETTINGS;
use crate::paint::tip::{Bristles, Hose, Noise};
use crate::paint::{
    Adjust, Brush, BrushMode, ColorAdjustment, ColorJitter, DrawingHand, FormDrawing, FormPattern,
    Gradient, PlacedImage, Placement, Sample, Stabilizer, Stroke, StrokeSelection, Tip,
};
use crate::surface::form_lines::LineSettings;
use crate::surface::plane_piece::PlanePiece;
use crate::surface::{Bend, Operator, Weights};
use std::sync::Arc;

/// The most values that things take in a description.
pub const AN_ANCHOR: usize = 14;
pub const A_STOP: usize = 4;
const A_STROKE: usize = 60;
/// Without its curves and pictures.
const A_BRUSH: usize = 480;

/// The most values that the lists of an adjustment take.
pub fn adjustment_values(adjustment: &ColorAdjustment) -> usize {
    match adjustment {
        ColorAdjustment::GradientMap(map) => A_STOP * map.stops.len(),
        ColorAdjustment::Curves(_) => A_STOP * 4 * ToneCurve::MOST_POINTS,
        _ => 0,
    }
}

/// The samples of strokes, and the values that they take.
pub fn measured(strokes: &[Arc<Stroke>]) -> (usize, usize) {
    let (mut samples, mut values) = (0, 0);
    let mut before: Option<&Stroke> = None;
    for stroke in strokes {
        samples += stroke.samples().len();
        values += A_STROKE;
        // A brush like the one before is not written again.
        if !before.is_some_and(|before| before.brush().is_alike(stroke.brush())) {
            let points: usize = stroke
                .brush()
                .dynamics
                .drives()
                .iter()
                .map(|drive| 20 + 3 * drive.curve.points())
                .sum();
            let pictures =
                if let Tip::Hose(hose) = &stroke.brush().tip { hose.pictures().len() } else { 0 };
            values += A_BRUSH + points + pictures;
        }
        before = Some(stroke);
    }
    (samples, values)
}

/// The values that a drawing by the form takes.
pub fn form_drawing_values(drawing: &FormDrawing) -> usize {
    let drives = drawing.brush.dynamics.drives().iter();
    A_STROKE + A_BRUSH + drives.map(|drive| 20 + 3 * drive.curve.points()).sum::<usize>()
}

/// Whether a file can hold a drawing by the form.
pub fn form_drawing(drawing: &FormDrawing) -> Fit {
    if drawing.brush.mode.is_retouching() {
        return Err("lines are painted: smudge, blur and clone do not work here".into());
    }
    match &drawing.pattern {
        FormPattern::Lines(lines) => {
            numbers(lines, LineSettings::SETTINGS)?;
            let reach = -1e6..=1e6;
            lines.light.to_array().iter().try_for_each(|v| within("the light", *v, &reach))?;
        }
    }
    numbers(&drawing.hand, DrawingHand::SETTINGS)?;
    brush(&drawing.brush)
}

fn numbers<T>(all: &T, table: &'static [NumberSetting<T>]) -> Fit {
    table.iter().try_for_each(|setting| within(setting.label, (setting.get)(all), &setting.range))
}

/// The new strokes that are not among the old ones, by pointer.
pub fn strokes(old: &[Arc<Stroke>], new: &[Arc<Stroke>]) -> Fit {
    let same = |(a, b): &(&Arc<Stroke>, &Arc<Stroke>)| Arc::ptr_eq(a, b);
    let start = old.iter().zip(new).take_while(same).count();
    let end = old[start..].iter().rev().zip(new[start..].iter().rev()).take_while(same).count();
    let changed = new.iter().enumerate().take(new.len() - end).skip(start);
    changed
        .into_iter()
        .try_for_each(|(i, new)| stroke(new).map_err(|why| format!("stroke {}: {why}", i + 1)))
}

fn stroke(stroke: &Stroke) -> Fit {
    if stroke.brush().mode.is_retouching() {
        return Err("smudge, blur and clone do not work on stroke layers".into());
    }
    at_most("readings of the pen", stroke.samples().len(), Stroke::MOST_SAMPLES)?;
    brush(stroke.brush())?;
    operator(stroke.operator())?;
    if let Some(own) = stroke.selection() {
        let range = &StrokeSelection::MOVED_PX;
        within("how far its selection moved", own.moved.x, range)?;
        within("how far its selection moved", own.moved.y, range)?;
    }
    stroke.samples().iter().try_for_each(|sample| {
        point("a reading of the pen", sample.at)?;
        within("the pressure", sample.pressure, &Sample::PRESSURE)?;
        within("the tilt", sample.tilt.x, &Sample::TILT).and(within(
            "the tilt",
            sample.tilt.y,
            &Sample::TILT,
        ))?;
        within("the time", sample.time_secs, &Sample::TIME_SECS)
    })
}

/// Whether a file can hold a brush.
pub fn brush(brush: &Brush) -> Fit {
    within("the size of the brush", brush.size, &Brush::SIZE)?;
    within("the hardness", brush.hardness, &UNIT)?;
    within("the opacity of the brush", brush.opacity, &UNIT)?;
    within("the flow", brush.flow, &UNIT)?;
    within("the spacing", brush.spacing, &Brush::SPACING)?;
    within("the rotation of the brush", brush.rotation, &TURNS)?;
    within("the turn of the stroke", brush.facing.turn, &TURNS)?;
    within("the softness", brush.softness, &UNIT)?;
    within("the scatter", brush.scatter, &Brush::SCATTER)?;
    within("the reach", brush.reach, &Brush::REACHES)?;
    let ColorJitter { hue_degrees, saturation, value } = brush.jitter;
    within("the jitter of the hue", hue_degrees, &ColorJitter::HUE_DEGREES)?;
    within("the jitter of the saturation", saturation, &UNIT)?;
    within("the jitter of the value", value, &UNIT)?;
    mode(brush.mode)?;
    match brush.stabilizer {
        Stabilizer::None => Ok(()),
        Stabilizer::Average { weight } => {
            within("the weight of the stabilizer", weight, &Stabilizer::WEIGHT)
        }
        Stabilizer::String { length_px } => {
            within("the string of the stabilizer", length_px, &Stabilizer::LENGTH_PX)
        }
        Stabilizer::Lag { secs } => within("the lag of the stabilizer", secs, &Stabilizer::SECS),
    }?;
    for setting in &SETTINGS {
        within(&format!("“{}” of the brush", setting.label), setting.of(brush), &setting.range)?;
    }
    tip(&brush.tip)?;
    brush.grain.as_ref().map_or(Ok(()), grain)
}

fn mode(mode: BrushMode) -> Fit {
    match mode {
        BrushMode::Paint | BrushMode::Clone { .. } => Ok(()),
        BrushMode::Smudge { length } => {
            within("the length of the smudge", length, &BrushMode::SHARE)
        }
        BrushMode::Blur { width } => within("the width of the blur", width, &BrushMode::SHARE),
    }
}

fn tip(tip: &Tip) -> Fit {
    let whole = |what: &str, n: u32, range: &std::ops::RangeInclusive<u32>| {
        within(what, n as f32, &(*range.start() as f32..=*range.end() as f32))
    };
    match tip {
        Tip::Round | Tip::Picture(_) => Ok(()),
        Tip::Ellipse { ratio } | Tip::Square { ratio } => {
            within("the ratio of the tip", *ratio, &Tip::RATIO)
        }
        Tip::Bristles(bristles) => whole("the number of hairs", bristles.count, &Bristles::COUNT),
        Tip::Noise(noise) => {
            whole("the number of specks", noise.cells, &Noise::CELLS)?;
            within("the density of the tip", noise.density, &UNIT)
        }
        Tip::Hose(hose) => {
            let (pictures, ranks) = (hose.pictures().len(), hose.ranks());
            at_most("pictures of the tip", pictures, Hose::MOST_PICTURES)?;
            at_most("ranks of the tip", ranks.len(), Hose::MOST_RANKS)?;
            let is_rank = |count: u32| (1..=Hose::MOST_PICTURES as u32).contains(&count);
            if pictures == 0 || !ranks.iter().all(|rank| is_rank(rank.count)) {
                return Err("the tip has no pictures, or a rank without any".into());
            }
            Ok(())
        }
    }
}

fn grain(grain: &BrushGrain) -> Fit {
    within("the size of the grain", grain.size_px, &BrushGrain::SIZE_PX)?;
    within("the rotation of the grain", grain.rotation, &TURNS)?;
    within("the strength of the grain", grain.strength, &UNIT)?;
    let [low, high] = grain.levels;
    within("a level of the grain", low, &BrushGrain::LEVEL).and(within(
        "a level of the grain",
        high,
        &BrushGrain::LEVEL,
    ))?;
    if low >= high {
        return Err("the lower level of the grain is not below the upper one".into());
    }
    match grain.lies {
        GrainSpace::Canvas => Ok(()),
        GrainSpace::Surface { gamma } => within("γ of the grain", gamma, &BrushGrain::GAMMA),
        GrainSpace::Unwrapped => Ok(()),
    }
}

/// Whether a file can hold an operator.
pub fn operator(operator: Operator) -> Fit {
    operator
        .numbers()
        .into_iter()
        .try_for_each(|(number, value)| within(number.label, value, &number.range))
}

/// Whether a file can hold a placed picture.
pub fn image(image: &PlacedImage) -> Fit {
    adjust(&image.source.adjust)?;
    placement(&image.placement)?;
    operator(image.bend.operator)?;
    at_most("anchors", image.bend.anchors.len(), Bend::MOST_ANCHORS)?;
    image.bend.anchors.iter().try_for_each(|anchor| {
        point("an anchor", anchor.at).and(point("an anchor", anchor.source))
    })?;
    pieces(&image.bend.pieces)?;
    match image.bend.weights {
        Weights::Shepard { power } => {
            within("the sharpness of the anchors", power, &Weights::POWER)
        }
        Weights::Segment => Err("the anchors of an image are weighted by distance".into()),
    }
}

fn pieces(list: &[PlanePiece]) -> Fit {
    at_most("pieces", list.len(), PlanePiece::MOST)?;
    list.iter().try_for_each(piece)
}

fn piece(piece: &PlanePiece) -> Fit {
    point("a piece", piece.at)?;
    let moved = [piece.moved.x, piece.moved.y];
    moved
        .into_iter()
        .try_for_each(|v| within("how far a piece is moved", v, &PlanePiece::MOVED))?;
    within("the size of a piece", piece.scale, &PlanePiece::SCALE)?;
    within("the turn of a piece", piece.rotation, &PlanePiece::ROTATION)
}

/// Whether a file can hold a gradient.
pub fn gradient(gradient: &Gradient) -> Fit {
    point("an end of the gradient", gradient.from)
        .and(point("an end of the gradient", gradient.to))?;
    operator(gradient.operator)?;
    pieces(&gradient.pieces)?;
    at_most("stops of the gradient", gradient.stops.len(), Gradient::MOST_STOPS)?;
    gradient.stops.iter().try_for_each(|stop| within("a stop of the gradient", stop.t, &UNIT))?;
    if gradient.stops.is_empty() || !gradient.stops.is_sorted_by(|a, b| a.t <= b.t) {
        return Err("the stops of the gradient must go from 0 to 1, at least one".into());
    }
    Ok(())
}

pub fn placement(placement: &Placement) -> Fit {
    point("the center", placement.center)?;
    within("the scale", placement.scale, &Placement::SCALE)?;
    within("the rotation", placement.rotation, &TURNS)
}

/// Whether a file can hold what is adjusted of a picture.
pub fn adjust(adjust: &Adjust) -> Fit {
    within("the blur", adjust.blur, &Adjust::BLUR)?;
    within("the exposure", adjust.exposure, &STOPS)?;
    within("the hue", adjust.hue, &TURNS)?;
    within("the saturation", adjust.saturation, &Adjust::FACTOR)?;
    within("the brightness", adjust.brightness, &Adjust::FACTOR)?;
    within("the contrast", adjust.contrast, &Adjust::FACTOR)
}

/// For a normal layer without a map.
pub fn relief(grain: &crate::surface::NoiseRelief) -> Fit {
    use crate::surface::NoiseRelief;
    within("the size of the bumps", grain.size_px, &NoiseRelief::SIZE_PX)?;
    within("the roughness", grain.roughness, &NoiseRelief::ROUGHNESS)?;
    within("the stretch", grain.stretch, &NoiseRelief::STRETCH)?;
    if !NoiseRelief::OCTAVES.contains(&grain.octaves) {
        return Err(format!(
            "the octaves are {}; there may be {}",
            grain.octaves,
            NoiseRelief::OCTAVES.end()
        ));
    }
    Ok(())
}

fn point(what: &str, at: Vec2) -> Fit {
    within(what, at.x, &COORDINATE).and(within(what, at.y, &COORDINATE))
}
