//! Parts that a file can hold.
//! Floor 4.

use super::{Inflation, OutlineSource, Part, PartKind, Parts, ProfilePicture};
use crate::document::{Document, NamedSelection};
use crate::math::range::{at_most, check_range};
use crate::math::{COORDINATE, PlaneMap, UNIT, Vec2, Vec3};
use crate::paint::Attachment;
use crate::shading::Light;
use crate::shape::profiles::MOST_PROFILES;
use crate::shape::{
    Ball, Bevel, BevelCurve, Combine, Detail, Lines, Primitive, SculptStroke, Touch,
};
use std::sync::Arc;

impl Document {
    /// Whether files can hold the parts. Those that lie on the same in `before` may lie on
    /// anything: so it was opened.
    pub(in crate::document) fn parts_fit(&self, before: Option<&Document>) -> Result<(), String> {
        at_most("Parts", self.parts.list.len(), Parts::MOST)?;
        for (i, part) in self.parts.list.iter().enumerate() {
            let shown: String = part.name.chars().take(60).collect();
            part.fits().map_err(|why| format!("“{shown}”: {why}."))?;
            if self.parts.list[..i].iter().any(|other| other.id == part.id) {
                return Err(format!("“{shown}”: another part also has the id “{}”.", part.id));
            }
            let lay = before.and_then(|before| before.parts.part(&part.id)).map(|part| part.on());
            if lay != Some(part.on()) {
                self.parts
                    .refusal_of_attachment(part)
                    .map_or(Ok(()), |why| Err(format!("“{shown}” {why}.")))?;
            }
            if let Some(OutlineSource::Selection(name)) = part.outline()
                && !self.selections.iter().any(|kept| kept.name == *name)
            {
                return Err(format!(
                    "“{shown}”: its outline is the selection “{name}”, which no longer exists."
                ));
            }
        }
        Ok(())
    }
}

impl Document {
    /// What is said about the parts of a document whenever it is read: those whose place is lost,
    /// and those that lie on none.
    pub fn notes_of_parts(&self) -> Vec<String> {
        self.note_of_lost(None).into_iter().chain(self.note_of_astray()).collect()
    }

    /// A sentence about the parts that lie on none with a form of its own, so that they change
    /// nothing.
    pub fn note_of_astray(&self) -> Option<String> {
        let one = |part: &Arc<Part>| {
            Some(format!("“{}” {}", part.name, self.parts.refusal_of_attachment(part)?))
        };
        let all: Vec<String> = self.parts.list.iter().filter_map(one).collect();
        (!all.is_empty()).then(|| format!("{}, and so changes nothing.", all.join("; ")))
    }
}

impl Parts {
    /// Why a part lies on none with a form of its own, if it lies on another: the rest of a
    /// sentence that begins with its name.
    fn refusal_of_attachment(&self, part: &Part) -> Option<String> {
        let on = part.on()?;
        if on == part.id {
            return Some("lies on itself".into());
        }
        if self.part(on).is_none() {
            return Some(format!("lies on “{on}”, but there is no such part"));
        }
        let body = self.body_of(on)?;
        body.on()
            .is_some()
            .then(|| format!("lies on “{on}”, which lies on no part with a form of its own"))
    }
}

impl Part {
    /// Its readings of the pen, and the values that it takes in a description.
    pub(in crate::document) fn count_values(&self) -> (usize, usize) {
        /// More than any part takes without its lists.
        const A_PART: usize = 300;
        const A_STROKE: usize = 24;
        const A_BALL: usize = 4;
        const A_TOUCH: usize = 24;
        const A_POINT: usize = 3;
        const A_SHADING: usize = 16;
        let path = |outline: &OutlineSource| match outline {
            OutlineSource::Path(points) => A_POINT * points.len(),
            _ => 0,
        };
        let (samples, lists) = match &self.kind {
            PartKind::Bevel { bevel: Bevel { curve: BevelCurve::Points(points), .. }, .. } => {
                (0, A_POINT * points.len())
            }
            PartKind::Sweep { balls, .. } => (0, A_BALL * balls.len()),
            PartKind::Touches { touches, .. } => (0, A_TOUCH * touches.len()),
            PartKind::Sculpt { strokes, .. } => {
                // Whatever its length, a list of readings is one text.
                (strokes.iter().map(|stroke| stroke.samples.len()).sum(), A_STROKE * strokes.len())
            }
            PartKind::Profiles { shadings, .. } => (0, A_SHADING * shadings.len()),
            _ => (0, 0),
        };
        (samples, A_PART + lists + self.outline().map_or(0, path))
    }

    /// Whether a file can hold it: every number in its range; else a sentence.
    pub fn fits(&self) -> Result<(), String> {
        at_most("letters of the id", self.id.chars().count(), Self::LONGEST_NAME)?;
        at_most("letters of the name", self.name.chars().count(), Self::LONGEST_NAME)?;
        if self.id.is_empty() {
            return Err("a part has no id".into());
        }
        if self.id == Attachment::CANVAS {
            return Err(format!("a part cannot have the id “{}”", Attachment::CANVAS));
        }
        if let Combine::Union { smooth } = self.combine {
            check_range("the union's smoothness", smooth, &Combine::SMOOTH)?;
        }
        check_range("the tilt", self.tilt_deg.x, &Self::TILT)?;
        check_range("the tilt", self.tilt_deg.y, &Self::TILT)?;
        check_range("how far it is raised", self.raise, &Self::RAISE)?;
        self.matrix
            .to_cols_array()
            .iter()
            .try_for_each(|v| check_range("the matrix", *v, &Self::MATRIX))?;
        if PlaneMap::affine(self.matrix.to_cols_array().map(f64::from)).is_none() {
            return Err("the matrix cannot be inverted: it has no area".into());
        }
        if let Some(outline) = self.outline() {
            outline.fits()?;
        }
        self.kind.fits()
    }
}

impl OutlineSource {
    fn fits(&self) -> Result<(), String> {
        match self {
            OutlineSource::Path(points) => {
                at_most("points of the path", points.len(), Self::MOST_POINTS)?;
                points.iter().try_for_each(|p| place("a point of the path", *p))
            }
            OutlineSource::Layer { layer, color } => {
                at_most("letters of the layer's name", layer.chars().count(), Part::LONGEST_NAME)?;
                color.and_then(|flat| flat.at).map_or(Ok(()), |at| place("the area of a color", at))
            }
            OutlineSource::Selection(name) => at_most(
                "letters of the selection's name",
                name.chars().count(),
                NamedSelection::LONGEST_NAME,
            ),
            OutlineSource::File(_) | OutlineSource::Object(_) => Ok(()),
        }
    }
}

fn place(what: &str, p: Vec2) -> Result<(), String> {
    check_range(what, p.x, &COORDINATE)?;
    check_range(what, p.y, &COORDINATE)
}

fn check_bevel(bevel: &Bevel) -> Result<(), String> {
    check_range("the bevel's width", bevel.width, &Bevel::WIDTH)?;
    check_range("the bevel's height", bevel.height, &Bevel::HEIGHT)?;
    let BevelCurve::Points(points) = &bevel.curve else { return Ok(()) };
    at_most("points of the bevel's curve", points.len(), BevelCurve::MOST_POINTS)?;
    points.iter().try_for_each(|p| {
        check_range("a point of the bevel's curve", p.x, &UNIT)?;
        check_range("a point of the bevel's curve", p.y, &UNIT)
    })
}

fn check_body(body: &Primitive) -> Result<(), String> {
    place("the middle", body.center)?;
    let Vec3 { x, y, z } = body.half;
    [body.radius, body.length, body.tube, x, y, z]
        .iter()
        .try_for_each(|side| check_range("a side of the body", *side, &Primitive::LENGTH))?;
    check_range("the radius of its edges", body.round, &Primitive::ROUND)?;
    let turns = body.turn_deg.to_array();
    turns.iter().try_for_each(|turn| check_range("its turn", *turn, &Primitive::TURN))
}

fn check_touch(touch: &Touch) -> Result<(), String> {
    place("a touch", touch.at)?;
    check_range("the radius of a touch", touch.radius, &Touch::RADIUS)?;
    check_range("the reach of a touch", touch.reach, &Touch::REACH)?;
    let normal = touch.normal.to_array();
    normal.iter().try_for_each(|v| check_range("a touch's normal", *v, &(-1.0..=1.0)))
}

fn check_sculpting(stroke: &SculptStroke) -> Result<(), String> {
    check_range("the size of a stroke", stroke.size, &SculptStroke::SIZE)?;
    check_range("the hardness of a stroke", stroke.hardness, &SculptStroke::HARDNESS)?;
    check_range("the strength of a stroke", stroke.strength, &SculptStroke::STRENGTH)?;
    stroke.samples.iter().try_for_each(|(at, pressure)| {
        place("a sample", *at)?;
        check_range("the pressure of a sample", *pressure, &SculptStroke::PRESSURE)
    })
}

fn check_light(light: Vec3) -> Result<(), String> {
    let direction = light.to_array();
    direction.iter().try_for_each(|v| check_range("a light", *v, &ProfilePicture::LIGHT))?;
    match Light::has_direction(light) {
        true => Ok(()),
        false => Err("the direction of a light has no length".into()),
    }
}

impl PartKind {
    fn fits(&self) -> Result<(), String> {
        match self {
            PartKind::Inflate { inflation, .. } => {
                check_range("the puff", inflation.puff, &Inflation::PUFF)?;
                check_range("the profile", inflation.profile, &Inflation::PROFILE)?;
                check_range("the rim", inflation.rim_deg, &Inflation::RIM)
            }
            PartKind::Bevel { bevel, .. } => check_bevel(bevel),
            PartKind::Primitive(body) => check_body(body),
            PartKind::Lathe { axis, puff, .. } => {
                check_range("the puff", *puff, &Inflation::PUFF)?;
                axis.iter().flatten().try_for_each(|p| place("the axis", *p))
            }
            PartKind::Sweep { balls, puff } => {
                check_range("the puff", *puff, &Inflation::PUFF)?;
                at_most("balls of a sweep", balls.len(), Ball::MOST)?;
                balls.iter().try_for_each(|ball| {
                    place("a ball", ball.at)?;
                    check_range("the radius of a ball", ball.radius, &Ball::RADIUS)
                })
            }
            PartKind::Touches { touches, .. } => {
                at_most("touches", touches.len(), Touch::MOST)?;
                touches.iter().try_for_each(check_touch)
            }
            PartKind::Sculpt { strokes, .. } => {
                let samples: usize = strokes.iter().map(|stroke| stroke.samples.len()).sum();
                at_most("samples of sculpting", samples + strokes.len(), SculptStroke::MOST)?;
                strokes.iter().try_for_each(check_sculpting)
            }
            PartKind::Lines { lines, .. } => {
                check_range("how far the form turns at lines", lines.angle_deg, &Lines::ANGLE)?;
                check_range("the reach of lines", lines.reach, &Lines::REACH)
            }
            PartKind::Profiles { shadings, .. } => {
                if !(2..=MOST_PROFILES).contains(&shadings.len()) {
                    return Err(format!(
                        "it has {} shadings; there must be 2 to {MOST_PROFILES}",
                        shadings.len()
                    ));
                }
                shadings.iter().try_for_each(|shading| check_light(shading.light))
            }
            PartKind::Maps(maps) => maps.source.fits(),
            PartKind::Relief { detail, .. } => {
                check_range("the coarse detail", detail.coarse, &Detail::HEIGHT)?;
                check_range("the fine detail", detail.fine, &Detail::HEIGHT)?;
                check_range("the detail's radius", detail.radius, &Detail::RADIUS)?;
                check_range("the detail's edge", detail.edge, &Detail::EDGE)
            }
        }
    }
}
