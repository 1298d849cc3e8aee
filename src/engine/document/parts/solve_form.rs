//! The form of one part, by its kind, without what lies on it. Floor 4.

use super::body::{self, SolvedOutline, inflate_outline, solve_form};
use super::outlines::OutlineKey;
use super::{Part, PartKind};
use crate::document::Document;
use crate::math::{Affine2, Vec2};
use crate::raster::Plane;
use crate::shape::{Form, Outline, OutlineRim, Primitive, Roundness, bevel, sweep};
use std::sync::Arc;

impl Document {
    /// A part made again, except known fields of its body; without what lies on it, not leaned and
    /// not yet moved by whole px.
    pub(super) fn solve_form(
        &self,
        part: &Part,
        (own, source): (Option<Arc<Outline>>, Option<&OutlineKey>),
        joined: Option<Arc<Plane<bool>>>,
        still: Affine2,
        known: Option<Arc<SolvedOutline>>,
    ) -> Option<(Arc<SolvedOutline>, Form)> {
        let most_px = self.most_px();
        let (body, form) = match &part.kind {
            PartKind::Inflate { inflation, .. } => {
                let body = inflate_outline(own?, joined, known.as_deref(), inflation.profile);
                let form = solve_form(&body, *inflation);
                (body, form)
            }
            PartKind::Bevel { bevel, .. } => {
                let outline = own?;
                let form = bevel::bevel_outline(&outline, bevel);
                (bare(outline), form)
            }
            PartKind::Lathe { axis, puff, .. } => turn(own?, *axis, *puff, still),
            PartKind::Sweep { balls, puff } => sweep_balls(balls, *puff, still, most_px)?,
            PartKind::Primitive(body) => with_own_outline(seen_body(body, still).form(most_px)?)?,
            PartKind::Profiles { shadings, .. } => {
                let drawn = source?.outline(self, most_px)?;
                with_own_outline(body::of_profiles(shadings, &drawn, still, most_px)?)?
            }
            PartKind::Maps(maps) => with_own_outline(body::of_maps(maps, still, most_px)?)?,
            PartKind::Touches { .. }
            | PartKind::Sculpt { .. }
            | PartKind::Relief { .. }
            | PartKind::Lines { .. } => {
                return None;
            }
        };
        Some((Arc::new(body), form))
    }
}

/// An outline in which nothing is solved.
fn bare(outline: Arc<Outline>) -> SolvedOutline {
    SolvedOutline { outline, joined: None, pillow: None, tube: None }
}

/// A form outlined by what it covers itself.
fn with_own_outline(form: Form) -> Option<(SolvedOutline, Form)> {
    Some((bare(Arc::new(Outline::new(form.corner, &form.coverage)?)), form))
}

/// A form from squares of its height, with a rim that is seen from the side.
fn round(outline: &Outline, squares: &Plane<f32>, puff: f32) -> Form {
    let roundness = Roundness { puff, rim_deg: 90.0 };
    Form::of_squares(outline, squares, &OutlineRim::silhouette(outline), roundness)
}

fn turn(
    outline: Arc<Outline>,
    axis: Option<[Vec2; 2]>,
    puff: f32,
    still: Affine2,
) -> (SolvedOutline, Form) {
    let axis = axis.map(|axis| axis.map(|p| still.transform_point2(p)));
    let form = round(&outline, &sweep::turn_outline(&outline, axis), puff);
    (bare(outline), form)
}

fn sweep_balls(
    balls: &[sweep::Ball],
    puff: f32,
    still: Affine2,
    most_px: usize,
) -> Option<(SolvedOutline, Form)> {
    let scale = length_factor(still);
    let seen = |ball: &sweep::Ball| sweep::Ball {
        at: still.transform_point2(ball.at),
        radius: ball.radius * scale,
    };
    let seen: Vec<sweep::Ball> = balls.iter().map(seen).collect();
    let (outline, squares) = sweep::sweep(&seen, most_px)?;
    let form = round(&outline, &squares, puff);
    Some((bare(Arc::new(outline)), form))
}

/// A body as it lies on the canvas.
fn seen_body(body: &Primitive, still: Affine2) -> Primitive {
    let mut seen = *body;
    let scale = length_factor(still);
    seen.center = still.transform_point2(body.center);
    for side in [&mut seen.radius, &mut seen.length, &mut seen.tube, &mut seen.round] {
        *side *= scale;
    }
    seen.half *= scale;
    seen.turn_deg.z -= still.matrix2.x_axis.to_angle().to_degrees();
    seen
}

/// How many times a map makes lengths longer.
fn length_factor(map: Affine2) -> f32 {
    map.matrix2.determinant().abs().sqrt()
}
