//! What a dab of a MyPaint brush looks like: tip, coverage, color and pickup. Floor 5.

use super::added::Added;
use super::settings::MyPaintSettings;
use super::{with, with_constant};
use crate::paint::dynamics::Property;
use crate::paint::{Brush, Falloff, Pickup, Tip};

/// A rim as wide as this is every dab's here, px.
const RIM_PX: f32 = 1.0;
/// Beyond this a dab counts as not round.
const ROUND: f32 = 1.001;

/// Hardness and the elliptic tip.
pub fn shape(settings: &mut MyPaintSettings, brush: Brush) -> Brush {
    let hardness = hardness(settings, 0.5 * brush.size);
    let brush = Brush { hardness: hardness.base, falloff: Falloff::Peaked, ..brush };
    let brush = with(brush, Property::Hardness, &hardness);
    let elongation =
        settings.take_added("elliptical_dab_ratio", 1.0).within(1.0, 1.0 / *Tip::RATIO.start());
    // Theirs turns clockwise.
    let angle = settings.take_added("elliptical_dab_angle", 90.0).times(-1.0);
    if elongation.base <= ROUND && elongation.rows.is_empty() {
        return brush;
    }
    let brush = Brush {
        tip: Tip::Ellipse { ratio: 1.0 / elongation.base },
        rotation: angle.base.rem_euclid(360.0),
        ..brush
    };
    let brush = with(brush, Property::Elongation, &elongation);
    with(brush, Property::Rotation, &angle.times(1.0 / 360.0))
}

/// As it becomes here, of a brush of this radius.
pub fn hardness(settings: &mut MyPaintSettings, radius: f32) -> Added {
    let rim_px = settings.take_added("anti_aliasing", 1.0).base;
    soften(settings.take_added("hardness", 0.8), rim_px, radius).within(0.0, 1.0)
}

/// A hardness for a rim wider than it would have; the radius of half coverage stays.
fn soften(hardness: Added, rim_px: f32, radius: f32) -> Added {
    let h = hardness.base.max(0.0).min(1.0);
    if rim_px <= RIM_PX || radius * (1.0 - h) >= rim_px {
        return hardness;
    }
    let middle = radius * (1.0 + h) / 2.0;
    let softer = ((middle - 0.5 * rim_px) / (middle + 0.5 * rim_px)).max(0.0);
    Added { base: softer, ..hardness }
}

/// How much one dab covers: MyPaint's opacity is the stroke's where dabs overlap, to the degree of
/// `opaque_linearize`.
pub fn flow(settings: &mut MyPaintSettings, brush: Brush) -> Brush {
    let linear = settings.plain("opaque_linearize", 0.9).max(0.0).min(2.0);
    let per_diameter = 2.0
        * (settings.base("dabs_per_actual_radius", 2.0)
            + settings.base("dabs_per_basic_radius", 0.0));
    let overlap = (1.0 + linear * (per_diameter.max(1.0) - 1.0)).max(1.0).min(100.0);
    let brush = Brush { overlap, ..brush };
    let opaque = settings.take_added("opaque", 1.0);
    let times = settings.opaque_multiply();
    // The inputs of the one that has more add up; the other multiplies.
    let (sum, factor) =
        if opaque.rows.len() < times.rows.len() { (times, opaque) } else { (opaque, times) };
    let Some(main) = factor.main_row() else {
        return flows(brush, sum.times(factor.base.max(0.0)));
    };
    if factor.rows.len() > 1 {
        settings.note("The opacity follows some of several inputs");
    }
    let row = &factor.rows[main];
    let rest = factor.middle_value() - row.middle_value();
    let most = (rest + row.most()).max(1e-3);
    let brush = flows(brush, sum.times(most));
    match row.factors(|x| (rest + row.at(x)) / most) {
        Some(curve) => {
            Brush { dynamics: brush.dynamics.with(Property::Flow, row.input, curve), ..brush }
        }
        None => brush,
    }
}

fn flows(brush: Brush, flow: Added) -> Brush {
    let flow = flow.within(0.0, 1.0);
    with(Brush { flow: flow.base, ..brush }, Property::Flow, &flow)
}

/// Color changes, pickup and erasing.
pub fn paint(settings: &mut MyPaintSettings, brush: Brush) -> Brush {
    let mut brush = brush;
    let changes = [
        ("change_color_h", Property::Hue, 1.0),
        ("change_color_v", Property::Value, 1.0),
        ("change_color_l", Property::Lightness, 1.0),
        // Theirs are ratios of the color's own saturation; a strong color's is near 1.
        ("change_color_hsv_s", Property::Saturation, 1.0),
        ("change_color_hsl_s", Property::Saturation, 1.0),
    ];
    for (name, property, factor) in changes {
        let change = settings.take_added(name, 0.0).times(factor);
        if change.rows.is_empty() {
            brush = with_constant(brush, property, change.base);
        } else {
            brush = with(brush, property, &change.within(0.0, 0.0));
        }
    }
    for name in ["colorize", "posterize"] {
        settings.plain(name, 0.0);
        settings.report_unused(name, 0.0);
    }
    if settings.base("posterize", 0.0) == 0.0 {
        settings.of_no_use(&["posterize_num"]);
    }
    let erases = settings.take_added("eraser", 0.0);
    if erases.rows.iter().any(|_| true) || (erases.base > 0.0 && erases.base < 1.0) {
        settings.note("It erases wholly or not at all");
    }
    let brush = Brush {
        erases: 0.5 * (erases.range()[0] + erases.range()[1]) >= 0.5,
        keeps_alpha: settings.plain("lock_alpha", 0.0) >= 0.5,
        ..brush
    };
    pickup(settings, brush)
}

fn pickup(settings: &mut MyPaintSettings, brush: Brush) -> Brush {
    const DETAILS: [&str; 6] = [
        "smudge_length",
        "smudge_radius_log",
        "smudge_length_log",
        "smudge_bucket",
        "smudge_transparency",
        "smudge",
    ];
    let amount = settings.take_added("smudge", 0.0).within(0.0, 1.0);
    settings.of_no_use(&DETAILS);
    if amount.base == 0.0 && amount.rows.is_empty() {
        return brush;
    }
    let length = settings.take_added("smudge_length", 0.5).within(0.0, 1.0);
    let radius = settings.plain("smudge_radius_log", 0.0).exp().max(0.05).min(20.0);
    for name in ["smudge_length_log", "smudge_bucket", "smudge_transparency"] {
        settings.report_unused(name, 0.0);
    }
    let brush =
        Brush { pickup: Pickup { amount: amount.base, length: length.base, radius }, ..brush };
    let brush = with(brush, Property::Pickup, &amount);
    with(brush, Property::PickupLength, &length)
}

impl MyPaintSettings<'_> {
    /// What `opaque` is multiplied by: the pressure, if the file does not say.
    fn opaque_multiply(&mut self) -> Added {
        if self.has_setting("opaque_multiply") {
            self.take_added("opaque_multiply", 0.0)
        } else {
            self.pressure()
        }
    }

    /// A setting with no effect here; reported if it has one in MyPaint.
    fn report_unused(&mut self, name: &'static str, idle: f32) {
        if self.is_driven(name) || self.base(name, idle) != idle {
            self.note(&format!("“{name}” has no counterpart"));
        }
    }
}
