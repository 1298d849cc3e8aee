//! The settings of bevels, lines, reliefs and lighting profiles. Floor 7. Not here: the rows of
//! other kinds (`numbers`).

use super::fields::{degrees, length, number};
use crate::canvas::ball;
use crate::document::parts::ProfilePicture;
use crate::language::tr;
use crate::math::{Vec2, Vec3, vec2, vec3};
use crate::paint::Curve;
use crate::panels::curve;
use crate::shape::{Bevel, BevelCurve, Detail, LineForm, Lines};
use crate::tr;
use crate::widgets::{ValueChange, choice_row, set_accessible_name};
use eframe::egui::{self, Sense, Ui};

/// The height of the square in which a bevel's profile is bent.
const CURVE_PT: f32 = 110.0;
/// The number of points that a named curve gets when the user begins to bend it.
const SHOWN_POINTS: usize = 9;
/// Points of a drag that turns a light from facing the viewer to the side.
const LIGHT_PT: f32 = 60.0;

pub fn edit_bevel(ui: &mut Ui, now: &Bevel) -> Option<ValueChange<Bevel>> {
    let hint = "How far in from the rim it rises";
    let width = length("Width", &Bevel::WIDTH, hint, now.width)
        .show(ui, |width| Bevel { width, ..now.clone() });
    let height =
        length("Height", &Bevel::HEIGHT, "How high it rises; below 0 it falls", now.height)
            .show(ui, |height| Bevel { height, ..now.clone() });
    let mut curves: Vec<(usize, &str)> =
        BevelCurve::NAMED.iter().enumerate().map(|(i, (_, word))| (i, *word)).collect();
    let named = BevelCurve::NAMED.iter().position(|(curve, _)| *curve == now.curve);
    if named.is_none() {
        curves.push((curves.len(), "its own"));
    }
    let chosen = choice_row(ui, "Curve", named.unwrap_or(BevelCurve::NAMED.len()), &curves);
    let curve = chosen.and_then(|i| BevelCurve::NAMED.get(i));
    let with = |curve: BevelCurve| Bevel { curve, ..now.clone() };
    let curve = curve.map(|(curve, _)| ValueChange { to: with(curve.clone()), done: true });
    let bent = profile(ui, &now.curve).map(|changed| changed.map(with));
    width.or(height).or(curve).or(bent)
}

/// The profile from the rim, on the left, inward: a click adds a point, a drag moves one, a right
/// click removes one.
fn profile(ui: &mut Ui, now: &BevelCurve) -> Option<ValueChange<BevelCurve>> {
    let shown = Curve::through(points_of(now))?;
    let changed = curve::show(ui, "Profile of the bevel", &shown, CURVE_PT)?;
    // After a click that bends nothing a curve keeps its name.
    let to = if changed.to == shown { now.clone() } else { own_curve(&changed.to)? };
    Some(ValueChange { to, done: changed.done })
}

/// Points that show a curve, as a user would place them.
fn points_of(curve: &BevelCurve) -> Vec<Vec2> {
    let held = |p: Vec2| p.clamp(Vec2::ZERO, Vec2::ONE);
    match curve {
        BevelCurve::Points(points) => points.iter().copied().map(held).collect(),
        BevelCurve::Chisel => vec![Vec2::ZERO, Vec2::ONE],
        BevelCurve::Step => vec![vec2(0.0, 1.0), Vec2::ONE],
        round => {
            let at = |i: usize| {
                // Where such a curve is steep, its points are closer together.
                let t = i as f32 / (SHOWN_POINTS - 1) as f32;
                let t =
                    if *round == BevelCurve::Round { t.powi(3) } else { 1.0 - (1.0 - t).powi(3) };
                held(vec2(t, if t >= 1.0 { 1.0 } else { round.at(t).0 }))
            };
            (0..SHOWN_POINTS).map(at).collect()
        }
    }
}

/// The curve of a bevel through the user's points, level beyond them.
fn own_curve(curve: &Curve) -> Option<BevelCurve> {
    let Curve::Points(points) = curve else { return None };
    let mut points = points.to_vec();
    let (first, last) = (*points.first()?, *points.last()?);
    if first.x > 0.0 {
        points.insert(0, vec2(0.0, first.y));
    }
    if last.x < 1.0 {
        points.push(vec2(1.0, last.y));
    }
    (points.len() <= BevelCurve::MOST_POINTS).then_some(BevelCurve::Points(points))
}

pub fn lines(ui: &mut Ui, now: Lines) -> Option<ValueChange<Lines>> {
    let form = choice_row(ui, "Lines are", now.form, &LineForm::ALL)
        .map(|form| ValueChange { to: Lines { form, ..now }, done: true });
    let hint = "How far the form turns next to a line";
    let angle = degrees("Angle", &Lines::ANGLE, hint, now.angle_deg)
        .show(ui, |angle_deg| Lines { angle_deg, ..now });
    let hint = "How far a line reaches; 0: to the rim and to the next lines";
    let reach =
        length("Spread", &Lines::REACH, hint, now.reach).show(ui, |reach| Lines { reach, ..now });
    ui.weak(match now.form {
        LineForm::Ridge => tr("The form falls away on both sides of a line."),
        LineForm::Valley => tr("The form rises on both sides of a line."),
        LineForm::Over => {
            tr("The inner side of a line's bend turns away at it, in front of what is behind.")
        }
        LineForm::Under => {
            tr("The outer side of a line's bend turns away at it, in front of what is behind.")
        }
    });
    form.or(angle).or(reach)
}

/// The light of each shading.
pub fn profiles(ui: &mut Ui, now: &[ProfilePicture]) -> Option<ValueChange<Vec<ProfilePicture>>> {
    ui.weak(tr("Where the light comes from in each shading: drag the ball."));
    let mut changed = None;
    for (i, shading) in now.iter().enumerate() {
        let with = |light: Vec3| {
            let mut next = now.to_vec();
            next[i].light = light;
            next
        };
        ui.horizontal(|ui| {
            let number = i + 1;
            let label = tr!("Light of shading {number}", number);
            changed = light(ui, &label, shading.light).map(|to| to.map(with)).or(changed.take());
            let [right, up] = [shading.light.x, shading.light.y]
                .map(|v| format!("{:.0}", v.max(-1.0).min(1.0).asin().to_degrees()));
            ui.label(tr!("Shading {number}", number));
            ui.weak(tr!("{right}° right, {up}° up", right, up));
        });
    }
    changed
}

/// A ball with a needle in a direction, to be dragged.
fn light(ui: &mut Ui, label: &str, now: Vec3) -> Option<ValueChange<Vec3>> {
    let side = ui.spacing().interact_size.y + 8.0;
    let (rect, response) = ui.allocate_exact_size(egui::vec2(side, side), Sense::drag());
    set_accessible_name(&response, label);
    let now = now.normalize_or(Vec3::Z);
    ball(ui.painter(), rect.center(), 0.46 * side, now);
    if response.drag_stopped() {
        return Some(ValueChange { to: now, done: true });
    }
    let by = response.drag_delta() / LIGHT_PT;
    if !response.dragged() || by == egui::Vec2::ZERO {
        return None;
    }
    let flat = vec2(now.x + by.x, now.y - by.y).clamp_length_max(0.98);
    let to = vec3(flat.x, flat.y, (1.0 - flat.length_squared()).max(0.0).sqrt());
    Some(ValueChange { to, done: false })
}

pub fn relief(ui: &mut Ui, now: Detail) -> Option<ValueChange<Detail>> {
    let coarse = length("Coarse", &Detail::HEIGHT, "How high the coarse detail is", now.coarse)
        .show(ui, |coarse| Detail { coarse, ..now });
    let fine = length("Fine", &Detail::HEIGHT, "How high the fine detail is", now.fine)
        .show(ui, |fine| Detail { fine, ..now });
    let radius = length(
        "Radius",
        &Detail::RADIUS,
        "Larger features count as form, not as detail",
        now.radius,
    )
    .show(ui, |radius| Detail { radius, ..now });
    let edge = number(
        "Edge",
        &Detail::EDGE,
        "Larger steps of brightness are edges, which are kept",
        now.edge,
    )
    .show(ui, |edge| Detail { edge, ..now });
    coarse.or(fine).or(radius).or(edge)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_named_curve_is_shown_as_it_runs_and_bends_into_one_of_its_own() {
        for (curve, word) in &BevelCurve::NAMED {
            let shown = Curve::through(points_of(curve)).unwrap_or_else(|| panic!("{word}"));
            let own = own_curve(&shown).unwrap();
            for i in 1..100 {
                let t = i as f32 / 100.0;
                let (a, b) = (curve.at(t).0, own.at(t).0);
                assert!((a - b).abs() < 0.02, "{word} at {t}: {b} for {a}");
            }
        }
    }

    #[test]
    fn a_curve_of_ones_own_reaches_from_the_rim_to_the_top() {
        let curve = Curve::through(vec![vec2(0.3, 0.2), vec2(0.6, 0.9)]).unwrap();
        let Some(BevelCurve::Points(points)) = own_curve(&curve) else { panic!("points") };
        assert_eq!((points[0], points[3]), (vec2(0.0, 0.2), vec2(1.0, 0.9)));
    }
}
