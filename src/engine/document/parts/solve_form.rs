//! The form of one part, by its kind, without what lies on it. Floor 4.

use super::body::{self, SolvedOutline, inflate_outline, solve_form};
use super::outlines::OutlineKey;
use super::{Part, PartKind};
use crate::document::Document;
use crate::math::Affine2;
use crate::raster::Plane;
use crate::shape::{Form, Outline, OutlineRim, Roundness, bevel, sweep};
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
        let bare = |outline: Arc<Outline>| SolvedOutline {
            outline,
            joined: None,
            pillow: None,
            tube: None,
        };
        let silhouette = |puff: f32| Roundness { puff, rim_deg: 90.0 };
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
            PartKind::Lathe { axis, puff, .. } => {
                let outline = own?;
                let axis = axis.map(|axis| axis.map(|p| still.transform_point2(p)));
                let squares = sweep::turn_outline(&outline, axis);
                let form = Form::of_squares(
                    &outline,
                    &squares,
                    &OutlineRim::silhouette(&outline),
                    silhouette(*puff),
                );
                (bare(outline), form)
            }
            PartKind::Sweep { balls, puff } => {
                let length = still.matrix2.determinant().abs().sqrt();
                let through = balls.iter().map(|b| sweep::Ball {
                    at: still.transform_point2(b.at),
                    radius: b.radius * length,
                });
                let (outline, squares) = sweep::sweep(&through.collect::<Vec<_>>(), most_px)?;
                let form = Form::of_squares(
                    &outline,
                    &squares,
                    &OutlineRim::silhouette(&outline),
                    silhouette(*puff),
                );
                (bare(Arc::new(outline)), form)
            }
            PartKind::Primitive(body) => {
                let length = still.matrix2.determinant().abs().sqrt();
                let mut seen = *body;
                seen.center = still.transform_point2(body.center);
                for side in [&mut seen.radius, &mut seen.length, &mut seen.tube, &mut seen.round] {
                    *side *= length;
                }
                seen.half *= length;
                seen.turn_deg.z -= still.matrix2.x_axis.to_angle().to_degrees();
                let form = seen.form(most_px)?;
                let outline = Arc::new(Outline::new(form.corner, &form.coverage)?);
                (bare(outline), form)
            }
            PartKind::Profiles { shadings, .. } => {
                let drawn = source?.outline(self, most_px)?;
                let form = body::of_profiles(shadings, &drawn, still, most_px)?;
                (bare(Arc::new(Outline::new(form.corner, &form.coverage)?)), form)
            }
            PartKind::Maps(maps) => {
                let form = body::of_maps(maps, still, most_px)?;
                (bare(Arc::new(Outline::new(form.corner, &form.coverage)?)), form)
            }
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
