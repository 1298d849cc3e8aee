//! Strokes, brushes, images and gradients that a file can hold.
//! Floor 4.

use super::Fit;
use crate::document::Layer;
use crate::math::range::{STOPS, at_most, check_range};
use crate::math::{COORDINATE, NumberSetting, TURNS, UNIT, Vec2};
use crate::paint::adjustment::ToneCurve;
use crate::paint::effect::EffectSettings;
use crate::paint::grain::{BrushGrain, GrainSpace};
use crate::paint::settings::SETTINGS;
use crate::paint::tip::{Bristles, Hose, Noise};
use crate::paint::{
    Adjust, Brush, BrushMode, ColorAdjustment, ColorJitter, DrawingHand, DualBrush, DualSettings,
    Dynamics, FormDrawing, FormPattern, Gradient, LayerEffect, LivePath, PlacedImage, Placement,
    Sample, Stabilizer, Stroke, StrokeSelection, Tip,
};
use crate::surface::form_lines::LineSettings;
use crate::surface::hatching::HatchSettings;
use crate::surface::plane_piece::PlanePiece;
use crate::surface::{Bend, Operator, Weights};
use std::sync::Arc;

/// The most values that things take in a description.
pub const AN_ANCHOR: usize = 14;
pub const A_STOP: usize = 4;
/// An object with a color and a name.
pub const A_COLOR: usize = 10;
/// Its own list and seven numbers.
pub const A_NODE: usize = 16;
const A_STROKE: usize = 60;
/// Without its curves and pictures.
const A_BRUSH: usize = 480;
/// The same of a dual brush's second tip.
const A_SECOND_TIP: usize = 120;

/// The most values that the lists of an adjustment take.
pub fn adjustment_values(adjustment: &ColorAdjustment) -> usize {
    match adjustment {
        ColorAdjustment::GradientMap(map) => A_STOP * map.stops.len(),
        ColorAdjustment::Curves(_) => A_STOP * 4 * ToneCurve::MOST_POINTS,
        _ => 0,
    }
}

/// The samples of strokes, and the values that they take.
pub fn count_values(strokes: &[Arc<Stroke>]) -> (usize, usize) {
    let (mut samples, mut values) = (0, 0);
    let mut before: Option<&Stroke> = None;
    for stroke in strokes {
        samples += stroke.samples().len();
        values += A_STROKE;
        // A brush like the one before is not written again.
        if !before.is_some_and(|before| before.brush().is_alike(stroke.brush())) {
            values += brush_values(stroke.brush());
        }
        before = Some(stroke);
    }
    (samples, values)
}

/// The values that a brush takes.
fn brush_values(brush: &Brush) -> usize {
    let points = |dynamics: &Dynamics| -> usize {
        dynamics.drives().iter().map(|drive| 20 + 3 * drive.curve.points()).sum()
    };
    let second = brush.dual.as_ref().map_or(0, |dual| A_SECOND_TIP + points(&dual.dynamics));
    A_BRUSH + points(&brush.dynamics) + second + brush.pictures().count()
}

/// The values that a drawing by the form takes.
pub fn form_drawing_values(drawing: &FormDrawing) -> usize {
    A_STROKE + brush_values(&drawing.brush)
}

/// Whether a file can hold a drawing by the form.
pub fn form_drawing(drawing: &FormDrawing) -> Fit {
    if drawing.brush.mode.is_retouching() {
        return Err("lines are painted: smudge, blur and clone do not work here".into());
    }
    match &drawing.pattern {
        FormPattern::Lines(lines) => numbers(lines, LineSettings::SETTINGS)?,
        FormPattern::Hatching(hatch) => numbers(hatch, HatchSettings::SETTINGS)?,
    }
    let light = drawing.light().to_array();
    light.iter().try_for_each(|v| check_range("the light", *v, &(-1e6..=1e6)))?;
    numbers(&drawing.hand, DrawingHand::SETTINGS)?;
    brush(&drawing.brush)
}

fn numbers<T>(all: &T, table: &'static [NumberSetting<T>]) -> Fit {
    table
        .iter()
        .try_for_each(|setting| check_range(setting.label, (setting.get)(all), &setting.range))
}

/// Whether a file can hold the effects of a layer.
pub fn effects(layer: &Layer) -> Fit {
    at_most("effects", layer.effects.len(), LayerEffect::MOST)?;
    check_range("the opacity of the fill", layer.fill_opacity, &Layer::OPACITY)?;
    layer.effects.iter().try_for_each(|effect| {
        at_most("stops of a ramp", effect.stops.len(), Gradient::MOST_STOPS)?;
        numbers(&effect.settings, EffectSettings::SETTINGS)
    })
}

/// The values that the effects of a layer take.
pub fn effect_values(layer: &Layer) -> usize {
    let one =
        |effect: &LayerEffect| 60 + A_STOP * effect.stops.len() + 3 * effect.contour.points().len();
    layer.effects.iter().map(one).sum()
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
        check_range("how far its selection moved", own.moved.x, range)?;
        check_range("how far its selection moved", own.moved.y, range)?;
    }
    stroke.samples().iter().try_for_each(|sample| {
        point("a reading of the pen", sample.at)?;
        check_range("the pressure", sample.pressure, &Sample::PRESSURE)?;
        check_range("the tilt", sample.tilt.x, &Sample::TILT).and(check_range(
            "the tilt",
            sample.tilt.y,
            &Sample::TILT,
        ))?;
        check_range("the time", sample.time_secs, &Sample::TIME_SECS)
    })
}

/// Whether a file can hold a brush.
pub fn brush(brush: &Brush) -> Fit {
    check_range("the size of the brush", brush.size, &Brush::SIZE)?;
    check_range("the hardness", brush.hardness, &UNIT)?;
    check_range("the opacity of the brush", brush.opacity, &UNIT)?;
    check_range("the flow", brush.flow, &UNIT)?;
    check_range("the spacing", brush.spacing, &Brush::SPACING)?;
    check_range("the rotation of the brush", brush.rotation, &TURNS)?;
    check_range("the turn of the stroke", brush.facing.turn, &TURNS)?;
    check_range("the softness", brush.softness, &UNIT)?;
    check_range("the scatter", brush.scatter, &Brush::SCATTER)?;
    check_range("the reach", brush.reach, &Brush::REACHES)?;
    let ColorJitter { hue_degrees, saturation, value } = brush.jitter;
    check_range("the jitter of the hue", hue_degrees, &ColorJitter::HUE_DEGREES)?;
    check_range("the jitter of the saturation", saturation, &UNIT)?;
    check_range("the jitter of the value", value, &UNIT)?;
    mode(brush.mode)?;
    match brush.stabilizer {
        Stabilizer::None => Ok(()),
        Stabilizer::Average { weight } => {
            check_range("the weight of the stabilizer", weight, &Stabilizer::WEIGHT)
        }
        Stabilizer::String { length_px } => {
            check_range("the string of the stabilizer", length_px, &Stabilizer::LENGTH_PX)
        }
        Stabilizer::Lag { secs } => {
            check_range("the lag of the stabilizer", secs, &Stabilizer::SECS)
        }
    }?;
    for setting in &SETTINGS {
        check_range(
            &format!("“{}” of the brush", setting.number.label),
            setting.of(brush),
            &setting.number.range,
        )?;
    }
    tip(&brush.tip)?;
    brush.grain.as_ref().map_or(Ok(()), grain)?;
    brush.dual.as_ref().map_or(Ok(()), |dual| second_tip(dual))
}

fn second_tip(dual: &DualBrush) -> Fit {
    DualSettings::SETTINGS.iter().try_for_each(|setting| {
        let what = format!("“{}” of the dual brush", setting.label);
        check_range(&what, (setting.get)(&dual.settings), &setting.range)
    })?;
    tip(&dual.tip)
}

fn mode(mode: BrushMode) -> Fit {
    match mode {
        BrushMode::Paint | BrushMode::Clone { .. } => Ok(()),
        BrushMode::Smudge { length } => {
            check_range("the length of the smudge", length, &BrushMode::SHARE)
        }
        BrushMode::Blur { width } => check_range("the width of the blur", width, &BrushMode::SHARE),
    }
}

fn tip(tip: &Tip) -> Fit {
    let whole = |what: &str, n: u32, range: &std::ops::RangeInclusive<u32>| {
        check_range(what, n as f32, &(*range.start() as f32..=*range.end() as f32))
    };
    match tip {
        Tip::Round | Tip::Picture(_) => Ok(()),
        Tip::Ellipse { ratio } | Tip::Square { ratio } => {
            check_range("the ratio of the tip", *ratio, &Tip::RATIO)
        }
        Tip::Bristles(bristles) => whole("the number of hairs", bristles.count, &Bristles::COUNT),
        Tip::Noise(noise) => {
            whole("the number of specks", noise.cells, &Noise::CELLS)?;
            check_range("the density of the tip", noise.density, &UNIT)
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
    check_range("the size of the grain", grain.size_px, &BrushGrain::SIZE_PX)?;
    check_range("the rotation of the grain", grain.rotation, &TURNS)?;
    check_range("the strength of the grain", grain.strength, &UNIT)?;
    let [low, high] = grain.levels;
    check_range("a level of the grain", low, &BrushGrain::LEVEL).and(check_range(
        "a level of the grain",
        high,
        &BrushGrain::LEVEL,
    ))?;
    if low >= high {
        return Err("the lower level of the grain is not below the upper one".into());
    }
    match grain.lies {
        GrainSpace::Canvas => Ok(()),
        GrainSpace::Surface { gamma } => check_range("γ of the grain", gamma, &BrushGrain::GAMMA),
        GrainSpace::Unwrapped => Ok(()),
    }
}

/// Whether a file can hold an operator.
pub fn operator(operator: Operator) -> Fit {
    operator
        .numbers()
        .into_iter()
        .try_for_each(|(number, value)| check_range(number.label, value, &number.range))
}

/// The values that a path takes.
pub fn path_values(path: &LivePath) -> usize {
    let lines = path.figure().map_or(path.subpaths().len(), |_| 0);
    2 * A_NODE + path.dashes.len() + A_NODE * (lines + path.count_nodes())
}

/// Whether a file can hold a placed picture.
pub fn image(image: &PlacedImage) -> Fit {
    adjust(&image.source.adjust)?;
    placement(&image.placement)?;
    image.source.path().map_or(Ok(()), |path| path.fits())?;
    operator(image.bend.operator)?;
    at_most("anchors", image.bend.anchors.len(), Bend::MOST_ANCHORS)?;
    image.bend.anchors.iter().try_for_each(|anchor| {
        point("an anchor", anchor.at).and(point("an anchor", anchor.source))
    })?;
    pieces(&image.bend.pieces)?;
    match image.bend.weights {
        Weights::Shepard { power } => {
            check_range("the sharpness of the anchors", power, &Weights::POWER)
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
        .try_for_each(|v| check_range("how far a piece is moved", v, &PlanePiece::MOVED))?;
    check_range("the size of a piece", piece.scale, &PlanePiece::SCALE)?;
    check_range("the turn of a piece", piece.rotation, &PlanePiece::ROTATION)
}

/// Whether a file can hold a gradient.
pub fn gradient(gradient: &Gradient) -> Fit {
    point("an end of the gradient", gradient.from)
        .and(point("an end of the gradient", gradient.to))?;
    operator(gradient.operator)?;
    pieces(&gradient.pieces)?;
    at_most("stops of the gradient", gradient.stops.len(), Gradient::MOST_STOPS)?;
    gradient
        .stops
        .iter()
        .try_for_each(|stop| check_range("a stop of the gradient", stop.t, &UNIT))?;
    if gradient.stops.is_empty() || !gradient.stops.is_sorted_by(|a, b| a.t <= b.t) {
        return Err("the stops of the gradient must go from 0 to 1, at least one".into());
    }
    Ok(())
}

pub fn placement(placement: &Placement) -> Fit {
    point("the center", placement.center)?;
    check_range("the scale", placement.scale, &Placement::SCALE)?;
    check_range("the rotation", placement.rotation, &TURNS)
}

/// Whether a file can hold what is adjusted of a picture.
pub fn adjust(adjust: &Adjust) -> Fit {
    check_range("the blur", adjust.blur, &Adjust::BLUR)?;
    check_range("the exposure", adjust.exposure, &STOPS)?;
    check_range("the hue", adjust.hue, &TURNS)?;
    check_range("the saturation", adjust.saturation, &Adjust::FACTOR)?;
    check_range("the brightness", adjust.brightness, &Adjust::FACTOR)?;
    check_range("the contrast", adjust.contrast, &Adjust::FACTOR)
}

/// For a normal layer without a map.
pub fn relief(grain: &crate::surface::NoiseRelief) -> Fit {
    use crate::surface::NoiseRelief;
    check_range("the size of the bumps", grain.size_px, &NoiseRelief::SIZE_PX)?;
    check_range("the roughness", grain.roughness, &NoiseRelief::ROUGHNESS)?;
    check_range("the stretch", grain.stretch, &NoiseRelief::STRETCH)?;
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
    check_range(what, at.x, &COORDINATE).and(check_range(what, at.y, &COORDINATE))
}
