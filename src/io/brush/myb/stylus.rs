//! How dabs of a MyPaint brush follow the pen: how densely, how far from it, and how the hand is
//! read. Floor 5.

use super::added::Added;
use super::settings::MyPaintSettings;
use super::{Lengths, with};
use crate::paint::brush::Stabilizer;
use crate::paint::brush_options::Bearing;
use crate::paint::dynamics::Property;
use crate::paint::{Brush, Cycle, Offset, Rate, Spread, StylusFilter};

/// Spacings that a brush can have here.
const SPACINGS: [f32; 2] = [0.01, 100.0];

/// Dabs a radius of the dab, a radius of the brush, and a second.
pub fn spacing(settings: &mut MyPaintSettings, lengths: Lengths, brush: Brush) -> Brush {
    let actual = settings.take_added("dabs_per_actual_radius", 2.0);
    let basic = settings.plain("dabs_per_basic_radius", 0.0);
    let per_sec = settings.plain("dabs_per_second", 0.0);
    let [least, most] = SPACINGS;
    // No dabs are due at all where a radius has none.
    let spacing = |dabs: f32| {
        if dabs > 0.0 { (0.5 * lengths.shrunk / dabs).max(least).min(most) } else { most }
    };
    let rate = Rate {
        per_diameter: (basic / lengths.diameters()).max(0.0).min(200.0),
        per_sec: per_sec.max(0.0).min(200.0),
    };
    let brush = Brush { spacing: spacing(actual.base), rate, ..brush };
    match actual.rows.as_slice() {
        [] => brush,
        [row, rest @ ..] => {
            if !rest.is_empty() {
                settings.note("“dabs_per_actual_radius” follows one of several inputs");
            }
            let places = (0..=40).map(|i| i as f32 / 40.0);
            let widest = places.map(|x| spacing(actual.at(row, x))).fold(least, f32::max);
            let curve = row.factors(|x| spacing(actual.at(row, x)) / widest);
            let dynamics =
                curve.map(|curve| brush.dynamics.with(Property::Spacing, row.input, curve));
            Brush { spacing: widest, dynamics: dynamics.unwrap_or(brush.dynamics.clone()), ..brush }
        }
    }
}

/// How far dabs are from the pen, and how their sizes vary.
pub fn strays(settings: &mut MyPaintSettings, lengths: Lengths, brush: Brush) -> Brush {
    let scatter =
        settings.take_added("offset_by_random", 0.0).times(lengths.diameters()).within(0.0, 10.0);
    let brush = Brush { scatter: scatter.base, spread: Spread::Cloud, ..brush };
    let brush = with(brush, Property::Scatter, &scatter);
    let sizes = settings
        .take_added("radius_by_random", 0.0)
        .times(std::f32::consts::LOG2_E)
        .within(0.0, 4.0);
    let brush = Brush { size_jitter: sizes.base, ..brush };
    let brush = with(brush, Property::SizeJitter, &sizes);
    let lead = settings.take_added("offset_by_speed", 0.0).times(0.1).within(-1.0, 1.0);
    let brush = Brush { stylus: StylusFilter { lead_secs: lead.base, ..brush.stylus }, ..brush };
    settings.of_no_use(&["offset_by_speed_slowness"]);
    let brush = with(brush, Property::Lead, &lead);
    offset(settings, lengths, brush)
}

/// The kinds of offset: their settings, what they are measured from, and whether sides take turns.
const OFFSETS: [(&str, Bearing, bool, f32); 6] = [
    ("offset_angle", Bearing::Stroke, false, 90.0),
    ("offset_angle_asc", Bearing::Pen, false, 90.0),
    ("offset_angle_view", Bearing::Canvas, false, 0.0),
    ("offset_angle_2", Bearing::Stroke, true, 90.0),
    ("offset_angle_2_asc", Bearing::Pen, true, 90.0),
    ("offset_angle_2_view", Bearing::Canvas, true, 0.0),
];

fn offset(settings: &mut MyPaintSettings, lengths: Lengths, brush: Brush) -> Brush {
    let across = [settings.take_added("offset_x", 0.0), settings.take_added("offset_y", 0.0)];
    let turn = settings.take_added("offset_angle_adj", 0.0).times(-1.0);
    let times = settings.take_added("offset_multiplier", 0.0);
    let kinds = OFFSETS.map(|(name, from, alternates, degrees)| {
        (
            settings.take_added(name, 0.0),
            Offset { from, alternates, turn_degrees: degrees, amount: 0.0 },
        )
    });
    let is_idle = |added: &Added| added.base == 0.0 && added.rows.is_empty();
    let mut kinds = kinds.into_iter().filter(|(added, _)| !is_idle(added));
    let (amount, offset) = match kinds.next() {
        Some(kind) => kind,
        // Along the canvas: the longer one's way, both where neither changes.
        None if across.iter().all(is_idle) => return brush,
        None => {
            let [x, y] = across.clone();
            let away = crate::math::vec2(x.base, y.base);
            if x.rows.is_empty() && y.rows.is_empty() {
                let turn_degrees = (-away.y).atan2(away.x).to_degrees();
                let amount = Added { base: away.length(), rows: Vec::new() };
                (amount, Offset { turn_degrees, ..Offset::default() })
            } else {
                settings.note("Dabs are offset along one of the canvas's axes");
                let upright = Offset { turn_degrees: -90.0, ..Offset::default() };
                if x.rows.len() >= y.rows.len() { (x, Offset::default()) } else { (y, upright) }
            }
        }
    };
    if kinds.next().is_some() {
        settings.note("Dabs are offset in one of several ways");
    }
    // The multiplier is a logarithm; it multiplies the offset as curves do, from its most.
    let most = times.range()[1].max(-20.0).min(20.0);
    let amount = amount.times(lengths.diameters() * most.exp()).within(-10.0, 10.0);
    let turn = if offset.from == Bearing::Canvas && across.iter().any(|added| !is_idle(added)) {
        Added { base: 0.0, rows: Vec::new() }
    } else {
        turn
    };
    let turn_degrees = (offset.turn_degrees + turn.base).max(-360.0).min(360.0);
    let brush = Brush { offset: Offset { amount: amount.base, turn_degrees, ..offset }, ..brush };
    let brush = with(brush, Property::Offset, &amount);
    let mut brush = with(brush, Property::OffsetTurn, &turn.times(1.0 / 360.0));
    for row in &times.rows {
        let own = Added { base: 0.0, rows: vec![row.clone()] };
        let most = own.range()[1];
        if let Some(curve) = row.factors(|x| (own.at(row, x) - most).exp()) {
            brush.dynamics = brush.dynamics.with(Property::Offset, row.input, curve);
        }
    }
    brush
}

/// How the hand is read and stabilized.
pub fn ways(settings: &mut MyPaintSettings, lengths: Lengths, brush: Brush) -> Brush {
    let stabilizer = match settings.plain("slow_tracking", 0.0) {
        // Hundredths of a second.
        slow if slow > 0.0 => Stabilizer::Lag { secs: (slow / 100.0).min(10.0) },
        _ => Stabilizer::None,
    };
    let stylus = StylusFilter {
        tremor: (settings.plain("tracking_noise", 0.0) * lengths.diameters()).max(0.0).min(20.0),
        lag_dabs: settings.plain("slow_tracking_per_dab", 0.0).max(0.0).min(100.0),
        direction_px: ((settings.plain("direction_filter", 2.0) * 0.5).min(20.0).exp() - 1.0)
            .max(0.0)
            .min(1000.0),
        pace_secs: settings.plain("speed1_slowness", 0.04).max(0.0).min(10.0),
        slow_pace_secs: settings.plain("speed2_slowness", 0.8).max(0.0).min(10.0),
        // It comes so far at every dab.
        custom_dabs: (10.0 * settings.plain("custom_input_slowness", 0.0)).max(0.0).min(1000.0),
        ..brush.stylus
    };
    let cycle = Cycle {
        length: (settings.plain("stroke_duration_logarithmic", 4.0).min(20.0).exp()
            * lengths.diameters())
        .max(0.01)
        .min(10_000.0),
        hold: settings.plain("stroke_holdtime", 0.0).max(0.0).min(Cycle::FOR_EVER),
        pressure: settings.plain("stroke_threshold", 0.0).max(0.0).min(1.0),
    };
    Brush { stabilizer, stylus, cycle, ..brush }
}
