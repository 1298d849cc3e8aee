//! What parts that lie on another do: lines, touches, sculpting, reliefs. Floor 4. Not here: which
//! of them are made again (`derive`).

use super::body::cut_to;
use super::{Part, PartKind, turned};
use crate::math::Affine2;
use crate::raster::Plane;
use crate::shape::{Form, Lines, Outline, Sculpting, Touch, Touching, lines, relief, touches};

/// A form with ink as lines on it.
pub fn with_lines(form: &Form, outline: &Outline, ink: &Outline, lines: Lines) -> Form {
    if form.height.size() != outline.size() {
        let cut = cut_to(form, outline);
        return if cut.height.size() == outline.size() {
            with_lines(&cut, outline, ink, lines)
        } else {
            form.clone()
        };
    }
    let shift = (outline.corner().0 - ink.corner().0, outline.corner().1 - ink.corner().1);
    let inked = Plane::from_fn(outline.size(), |x, y| {
        ink.coverage().get(x as i32 + shift.0, y as i32 + shift.1).unwrap_or(0)
    });
    lines::add_lines(form, outline, &inked, lines)
}

/// How far the work on a form came.
#[derive(Default)]
pub struct ResumePoint {
    pub sculpting: Option<Sculpting>,
    /// In drafts only.
    pub touching: Option<Touching>,
}

impl ResumePoint {
    /// Nowhere yet.
    pub fn nowhere(is_draft: bool) -> Self {
        Self { sculpting: None, touching: is_draft.then(Touching::default) }
    }
}

/// A form changed by another part. Its marks lie in the frame of the part that they are on.
///
/// * `came`: how far it came on this very form, and then on the new one.
pub fn with_modifier(
    form: &Form,
    outline: &Outline,
    part: &Part,
    still: Affine2,
    resume: &mut ResumePoint,
) -> Form {
    let known = resume.sculpting.take();
    if form.height.size() != outline.size() {
        // A primitive's planes reach beyond its outline; cut to it they fit.
        let cut = cut_to(form, outline);
        let fits = cut.height.size() == outline.size();
        return if fits {
            with_modifier(&cut, outline, part, still, &mut ResumePoint::default())
        } else {
            form.clone()
        };
    }
    match &part.kind {
        PartKind::Touches { touches: list, .. } => {
            let length = still.matrix2.determinant().abs().sqrt();
            let through = list.iter().map(|touch| Touch {
                at: still.transform_point2(touch.at),
                radius: touch.radius * length,
                reach: touch.reach * length,
                normal: turned(touch.normal, still),
            });
            touches::apply_touches(
                form,
                outline,
                &through.collect::<Vec<_>>(),
                resume.touching.as_mut(),
            )
        }
        PartKind::Sculpt { strokes, .. } => {
            let length = still.matrix2.determinant().abs().sqrt();
            let mut through = strokes.clone();
            for stroke in &mut through {
                stroke.size *= length;
                stroke.strength *= if stroke.tool.is_by_height() { length } else { 1.0 };
            }
            for sample in through.iter_mut().flat_map(|stroke| &mut stroke.samples) {
                sample.0 = still.transform_point2(sample.0);
            }
            let made = known
                .filter(|known| known.is_continued_by(&through))
                .unwrap_or_else(|| Sculpting::of(form));
            let made = made.go_on(form, &through);
            let form = form.clone().with_added(made.layer());
            resume.sculpting = Some(made);
            form
        }
        PartKind::Relief { picture, detail, .. } => {
            // The picture lies on the canvas, at the place of the unmoved part.
            let corner = outline.corner();
            let luminance = Plane::from_fn(outline.size(), |x, y| {
                let at = (x as i32 + corner.0, y as i32 + corner.1);
                f32::from(picture.coverage.get(at.0, at.1).unwrap_or(0)) / 255.0
            });
            form.clone().with_added(&relief::relief(outline, &luminance, *detail))
        }
        _ => form.clone(),
    }
}
