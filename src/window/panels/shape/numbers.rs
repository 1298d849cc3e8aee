//! The settings of a part, with the ranges of its type. Floor 7.

use super::fields::{NumberRow, degrees, length, number, presets};
use super::kinds;
use crate::document::parts::OutlineSource;
use crate::document::{Inflation, Part, PartKind};
use crate::language::tr;
use crate::math::{Vec2, Vec3};
use crate::shape::{Body, Combine, Primitive};
use crate::tr;
use crate::widgets::{ValueChange, choice_row, name};
use eframe::egui::Ui;
use std::path::Path;

/// The rows of a part; a part with other values, if one was changed.
pub fn show(ui: &mut Ui, part: &Part) -> Option<ValueChange<Part>> {
    let kind =
        of_kind(ui, &part.kind).map(|changed| changed.map(|kind| Part { kind, ..part.clone() }));
    if part.on().is_some() {
        return kind;
    }
    let stands = stands(ui, part);
    let source = part.outline().map(|outline| match outline {
        OutlineSource::Layer { layer, color: None } => {
            tr!("Follows the layer “{layer}”", layer)
        }
        OutlineSource::Layer { layer, color: Some(flat) } => match flat.at.is_some() {
            true => {
                tr!("Follows one area of the color {color} of “{layer}”", color = flat.color, layer)
            }
            false => tr!("Follows the color {color} of “{layer}”", color = flat.color, layer),
        },
        OutlineSource::Object(object) => tr!("Follows object {object} of the maps", object),
        _ => tr("Uses the outline that was selected").to_owned(),
    });
    if let Some(source) = source {
        ui.weak(source);
    }
    kind.or(stands)
}

const PUFF_HINT: &str = "How far it puffs up: at 1 a disc becomes a half ball";

/// Puff, with fine steps where they are needed.
fn puff(value: f32) -> NumberRow<'static> {
    let row = number("Height", &Inflation::PUFF, PUFF_HINT, value);
    NumberRow { field: row.field.logarithmic(), ..row }
}

fn of_kind(ui: &mut Ui, kind: &PartKind) -> Option<ValueChange<PartKind>> {
    match kind {
        PartKind::Inflate { outline, inflation } => inflation_rows(ui, *inflation).map(|changed| {
            changed.map(|inflation| PartKind::Inflate { outline: outline.clone(), inflation })
        }),
        PartKind::Bevel { outline, bevel } => kinds::edit_bevel(ui, bevel).map(|changed| {
            changed.map(|bevel| PartKind::Bevel { outline: outline.clone(), bevel })
        }),
        PartKind::Primitive(body) => {
            primitive(ui, body).map(|changed| changed.map(PartKind::Primitive))
        }
        PartKind::Lathe { outline, axis, puff: value } => puff(*value)
            .show(ui, |puff| PartKind::Lathe { outline: outline.clone(), axis: *axis, puff }),
        PartKind::Sweep { balls, puff: value } => {
            ui.weak(tr!("{count} balls along a stroke", count = balls.len()));
            puff(*value).show(ui, |puff| PartKind::Sweep { balls: balls.clone(), puff })
        }
        PartKind::Relief { on, picture, detail } => kinds::relief(ui, *detail).map(|changed| {
            changed.map(|detail| PartKind::Relief {
                on: on.clone(),
                picture: picture.clone(),
                detail,
            })
        }),
        PartKind::Lines { on, ink, lines } => kinds::lines(ui, *lines).map(|changed| {
            changed.map(|lines| PartKind::Lines { on: on.clone(), ink: ink.clone(), lines })
        }),
        PartKind::Profiles { outline, shadings } => kinds::profiles(ui, shadings).map(|changed| {
            changed.map(|shadings| PartKind::Profiles { outline: outline.clone(), shadings })
        }),
        PartKind::Maps(maps) => {
            let (normal, depth) = (&maps.source.normal, &maps.source.depth);
            let files = [normal.as_ref().map(|map| &map.file), depth.as_ref().map(|map| &map.file)];
            let names = files
                .into_iter()
                .flatten()
                .map(|file| Path::new(file).file_name().unwrap_or_default());
            let names: Vec<_> = names.map(|name| name.to_string_lossy()).collect();
            ui.weak(tr!("Maps that were made elsewhere: {files}", files = names.join(", ")));
            None
        }
        other => show_hand_made(ui, other),
    }
}

/// What the pen made on a part; its marks are changed on the canvas.
fn show_hand_made(ui: &mut Ui, kind: &PartKind) -> Option<ValueChange<PartKind>> {
    match kind {
        PartKind::Touches { touches, .. } => {
            ui.weak(match touches.len() {
                1 => tr("1 touch. The tool Touch (N) adds, moves and removes them.").to_owned(),
                count => {
                    tr!("{count} touches. The tool Touch (N) adds, moves and removes them.", count)
                }
            });
            None
        }
        PartKind::Sculpt { on, strokes } => {
            ui.weak(match strokes.len() {
                1 => tr("1 stroke. The tool Sculpt (U) adds more.").to_owned(),
                count => tr!("{count} strokes. The tool Sculpt (U) adds more.", count),
            });
            let (_, rest) = strokes.split_last()?;
            let made = || PartKind::Sculpt { on: on.clone(), strokes: rest.to_vec() };
            ui.button(tr("Without the last stroke"))
                .clicked()
                .then(|| ValueChange { to: made(), done: true })
        }
        _ => None,
    }
}

/// The presets, and the three numbers.
fn inflation_rows(ui: &mut Ui, now: Inflation) -> Option<ValueChange<Inflation>> {
    let mut changed = None;
    let chosen = presets(ui, now);
    changed = chosen.map(|to| ValueChange { to, done: true }).or(changed);
    changed = puff(now.puff).show(ui, |puff| Inflation { puff, ..now }).or(changed);
    let hint = "A pillow is a cloth filled with air; in a tube limbs are as deep as they are wide";
    let profile = number("Pillow – tube", &Inflation::PROFILE, hint, now.profile);
    changed = profile.show(ui, |profile| Inflation { profile, ..now }).or(changed);
    let hint = "How far the rim turns away: at 90° it is a silhouette, less is a low relief";
    degrees("Rim", &Inflation::RIM, hint, now.rim_deg)
        .show(ui, |rim_deg| Inflation { rim_deg, ..now })
        .or(changed)
}

/// One of three numbers: its name, its setter, and its value.
type AxisRow = (&'static str, fn(Vec3, f32) -> Vec3, f32);

/// The numbers of a body.
fn primitive(ui: &mut Ui, now: &Primitive) -> Option<ValueChange<Primitive>> {
    let now = *now;
    let mut changed = choice_row(ui, "Body", now.body, &Body::ALL)
        .map(|body| ValueChange { to: Primitive { body, ..now }, done: true });
    let range = &Primitive::LENGTH;
    if !matches!(now.body, Body::Ellipsoid | Body::Box) {
        let hint = if now.body == Body::Torus { "Of the ring" } else { "Of the body" };
        changed = length("Radius", range, hint, now.radius)
            .show(ui, |radius| Primitive { radius, ..now })
            .or(changed);
    }
    if matches!(now.body, Body::Cylinder | Body::Cone | Body::Capsule) {
        let row = length("Length", range, "Along its axis", now.length);
        changed = row.show(ui, |length| Primitive { length, ..now }).or(changed);
    }
    if now.body == Body::Torus {
        let row = length("Tube", range, "Radius of the ring's tube", now.tube);
        changed = row.show(ui, |tube| Primitive { tube, ..now }).or(changed);
    }
    if matches!(now.body, Body::Ellipsoid | Body::Box) {
        let halves: [AxisRow; 3] = [
            ("Half width", |half, x| Vec3 { x, ..half }, now.half.x),
            ("Half height", |half, y| Vec3 { y, ..half }, now.half.y),
            ("Half depth", |half, z| Vec3 { z, ..half }, now.half.z),
        ];
        for (label, with, value) in halves {
            let row = length(label, range, "From the middle to the side", value);
            changed = row.show(ui, |v| Primitive { half: with(now.half, v), ..now }).or(changed);
        }
    }
    if now.body == Body::Box {
        let row = length("Round", &Primitive::ROUND, "Radius of the edges", now.round);
        changed = row.show(ui, |round| Primitive { round, ..now }).or(changed);
    }
    if now.body != Body::Sphere {
        let turns: [AxisRow; 3] = [
            ("Turn about x", |turn, x| Vec3 { x, ..turn }, now.turn_deg.x),
            ("Turn about y", |turn, y| Vec3 { y, ..turn }, now.turn_deg.y),
            ("Turn about z", |turn, z| Vec3 { z, ..turn }, now.turn_deg.z),
        ];
        for (label, with, value) in turns {
            // The type's range is that of files; in the window one turn is enough.
            let row = degrees(label, &(-180.0..=180.0), "In space, about its middle", value);
            changed =
                row.show(ui, |v| Primitive { turn_deg: with(now.turn_deg, v), ..now }).or(changed);
        }
    }
    changed
}

/// How it leans, how near it is, and how it joins what lies beneath.
fn stands(ui: &mut Ui, part: &Part) -> Option<ValueChange<Part>> {
    let tilted = |tilt_deg: Vec2| Part { tilt_deg, ..part.clone() };
    let tilt = part.tilt_deg;
    let right = degrees(
        "Face left",
        &Part::TILT,
        "Turns it to the left: its right side comes nearer",
        tilt.x,
    )
    .show(ui, |x| tilted(Vec2 { x, ..tilt }));
    let down = degrees("Face up", &Part::TILT, "Turns it up: its lower side comes nearer", tilt.y)
        .show(ui, |y| tilted(Vec2 { y, ..tilt }));
    let raise = length("Raise", &Part::RAISE, "Additional distance toward the viewer", part.raise)
        .show(ui, |raise| Part { raise, ..part.clone() });
    let ways: Vec<(usize, &str)> =
        Combine::ALL.iter().enumerate().map(|(i, (_, word))| (i, *word)).collect();
    let now =
        Combine::ALL.iter().position(|(way, _)| way.name() == part.combine.name()).unwrap_or(0);
    let way = choice_row(ui, "Combine", now, &ways).and_then(|i| Combine::ALL.get(i));
    let way = way.map(|(combine, _)| ValueChange {
        to: Part { combine: *combine, ..part.clone() },
        done: true,
    });
    let smooth = match part.combine {
        Combine::Union { smooth } => {
            let hint = "Over how much height the two merge";
            length("Smooth", &Combine::SMOOTH, hint, smooth)
                .show(ui, |smooth| Part { combine: Combine::Union { smooth }, ..part.clone() })
        }
        _ => None,
    };
    let is_plain = part.matrix == crate::math::Affine2::IDENTITY;
    let back = if is_plain {
        None
    } else {
        ui.horizontal(|ui| {
            name(ui, "Moved");
            let hint = "Back to where its outline was drawn, not turned and not scaled";
            let clicked = ui.button(tr("Reset position")).on_hover_text(tr(hint)).clicked();
            let to = || Part { matrix: crate::math::Affine2::IDENTITY, ..part.clone() };
            clicked.then(|| ValueChange { to: to(), done: true })
        })
        .inner
    };
    right.or(down).or(raise).or(way).or(smooth).or(back)
}
