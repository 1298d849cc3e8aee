//! Evaluates D: the operator, its anchors and weights applied to a surface. Floor 2.
//! [`Deformation::at`] and [`Deformation::jacobian`] read like the paper; [`Deformation::fill`] is
//! the same over whole rows (`fill`), tested against it. `plane` is the operator that unwraps the
//! surface. Not here: looking up a picture at D(q) (`paint`).

mod fill;
mod plane;

pub use super::deformed_rect::DeformedRect;
use super::differentiate::DifferencePairs;
use super::operator::{MapSlopes, MapValues, Operator, UnwrapSettings, outer};
use super::{Anchor, Bend, Curvature, DabReach, Surface, Weights};
use crate::math::{Mat2, Rect, Size, Vec2, vec2};
use plane::LaidPlanes;
pub use plane::OwnPlane;
use std::ops::Range;
use std::sync::Arc;

/// A map from canvas points to image-plane points, ready to be evaluated.
///
/// Outside the surface (coverage 0, or beyond the maps) the operator is the identity; anchors whose
/// content was moved still move it there.
pub struct Deformation<'a> {
    surface: Option<&'a Surface>,
    /// *L*, canvas px.
    unit_px: f32,
    operator: Operator,
    weights: Weights,
    pins: Vec<Pin>,
    /// For the operator that unwraps the surface.
    planes: Option<LaidPlanes>,
    /// If the operator has detail.
    curvature: Option<Arc<Curvature>>,
    /// For a dab that must stay near the pen.
    reach: Option<DabReach>,
    /// The canvas point that q, anchors and D are counted from.
    origin: (i32, i32),
}

/// An anchor and what the maps hold there.
#[derive(Clone, Copy)]
struct Pin {
    anchor: Anchor,
    map_values: MapValues,
}

/// Positions beyond this are pulled in, so that no product of distances leaves f32.
const FARTHEST_PX: f32 = 1e7;
/// Detail enhancement reads the curvature at this scale *s*: features a few pixels wide count in
/// full.
pub const DETAIL_SCALE_PX: f32 = 4.0;
/// Blur of the normals before that, so that the steps of 8-bit maps are not taken for detail.
pub const DETAIL_BLUR_PX: f32 = 1.0;

impl<'a> Deformation<'a> {
    /// Reads the maps at the anchors, for a far side those of the surface in front; an anchor off the surface
    /// reads the background: facing the viewer, farthest.
    ///
    /// * `surface`: of the canvas's size; without one only moved anchors move anything.
    /// * `size`: the canvas; its longer side is *L*.
    ///
    /// Anchors that are not finite are dropped, and parameters that are not finite count as 0: D is
    /// finite everywhere.
    pub fn new(surface: Option<&'a Surface>, size: Size, bend: &Bend) -> Self {
        let deformation = Self::pin_anchors(
            surface,
            size,
            (bend.operator, bend.weights, &bend.anchors),
            at_anchor,
        );
        deformation.with_planes(|surface, settings, anchors| {
            LaidPlanes::pin_anchors(
                surface,
                settings,
                &Bend { anchors: anchors.to_vec(), ..bend.clone() },
            )
        })
    }

    /// D of a dab, its one anchor at the center `at` with weight 1. Off the surface it reads the
    /// nearest surface values, so that a stroke continues over the silhouette.
    pub fn of_dab(surface: Option<&'a Surface>, size: Size, operator: Operator, at: Vec2) -> Self {
        // The many dabs that nothing bends allocate no memory.
        let pinned = [Anchor::pin(at)];
        let anchors = if surface.is_none() || operator.is_identity() { &[][..] } else { &pinned };
        Self::pin_anchors(
            surface,
            size,
            (operator, Weights::default(), anchors),
            Surface::values_near,
        )
        .with_planes(|surface, settings, anchors| {
            LaidPlanes::of_dab(surface, settings, anchors.first().map_or(at, |a| a.at))
        })
    }

    /// The same for a pattern that begins at a point and lies everywhere: grain.
    pub fn of_pattern(
        surface: Option<&'a Surface>,
        size: Size,
        operator: Operator,
        at: Vec2,
    ) -> Self {
        let dab = Self::of_dab(surface, size, operator, at);
        Self { planes: dab.planes.map(LaidPlanes::unbounded), ..dab }
    }

    /// With the planes of the unwrapped surface laid under the anchors, where the operator needs
    /// them.
    fn with_planes(
        self,
        lay: impl FnOnce(&'a Surface, UnwrapSettings, &[Anchor]) -> LaidPlanes,
    ) -> Self {
        let planes = self.surface.zip(self.operator.unwrapping());
        let planes = planes.map(|(surface, settings)| lay(surface, settings, &self.anchors()));
        Self { planes, ..self }
    }

    fn pin_anchors(
        surface: Option<&'a Surface>,
        size: Size,
        (operator, weights, anchors): (Operator, Weights, &[Anchor]),
        read: impl Fn(&Surface, Vec2) -> MapValues,
    ) -> Self {
        let near = |p: Vec2| p.clamp(Vec2::splat(-FARTHEST_PX), Vec2::splat(FARTHEST_PX));
        // A far side holds readings of single pixels; anchors are on the surface in front.
        let front = surface.and_then(Surface::front);
        let pinned = front.as_deref().or(surface);
        let pins = anchors
            .iter()
            .filter(|a| a.at.is_finite() && a.source.is_finite())
            .map(|a| {
                let anchor = Anchor { at: near(a.at), source: near(a.source) };
                Pin {
                    anchor,
                    map_values: pinned.map_or(MapValues::default(), |s| read(s, anchor.at)),
                }
            })
            .collect();
        let operator = operator.finite();
        let curvature =
            surface.filter(|_| operator.detail() != 0.0).map(|s| s.curvature(DETAIL_BLUR_PX));
        let weights = sane(weights);
        Self {
            surface,
            unit_px: size.longer_side(),
            operator,
            weights,
            pins,
            planes: None,
            curvature,
            reach: None,
            origin: (0, 0),
        }
    }

    /// The same, counted from another corner of the pixels: q, anchors and D. What moved with its
    /// surface by whole px then gives the same bits as before. Where the surface is unwrapped the
    /// origin stays.
    pub fn with_origin(mut self, origin: (i32, i32)) -> Self {
        if self.planes.is_some() {
            return self;
        }
        let by = vec2((origin.0 - self.origin.0) as f32, (origin.1 - self.origin.1) as f32);
        for Pin { anchor, .. } in &mut self.pins {
            (anchor.at, anchor.source) = (anchor.at - by, anchor.source - by);
        }
        Self { origin, ..self }
    }

    /// What points are counted from, canvas px.
    pub fn origin(&self) -> (i32, i32) {
        self.origin
    }

    /// The center of a pixel of the canvas.
    fn center(&self, x: i32, y: i32) -> Vec2 {
        vec2(x.wrapping_sub(self.origin.0) as f32, y.wrapping_sub(self.origin.1) as f32) + 0.5
    }

    /// The same, of a dab that lands within a reach; where D is the identity it does so anyway.
    pub fn within(self, reach: Option<DabReach>) -> Self {
        Self { reach: reach.filter(|_| !self.is_identity()), ..self }
    }

    /// D(q) = q for every q: nothing is moved anywhere.
    pub fn is_identity(&self) -> bool {
        let bends = self.surface.is_some() && !self.operator.is_identity();
        self.planes.is_none()
            && (self.pins.is_empty()
                || !bends && self.pins.iter().all(|p| p.anchor.source == p.anchor.at))
    }

    /// D(q) at the center of a pixel: the reference that reads like the paper.
    ///
    /// MATH 2 (SF eq. 13, 15): `D(q) = q + Σ_i w_i(q) [ offset_i(q) + (s_i − q_i) ]`. Canvas px.
    pub fn at(&self, x: i32, y: i32) -> Vec2 {
        let q = self.center(x, y);
        if let Some((planes, (_, x, y))) = self.planes.as_ref().zip(self.on_surface(x, y)) {
            return self.limit_to_reach(q, planes.at(x, y));
        }
        let weights = self.weights.at(&self.anchors(), q);
        let moved: Vec2 = self
            .pins
            .iter()
            .zip(weights)
            .map(|(pin, w)| w * (self.offset(pin, q, x, y) + (pin.anchor.source - pin.anchor.at)))
            .sum();
        self.limit_to_reach(q, q + moved)
    }

    fn limit_to_reach(&self, q: Vec2, d: Vec2) -> Vec2 {
        self.reach.map_or(d, |reach| reach.limit(q, d))
    }

    /// ∂D/∂q at the center of a pixel, columns along x and y; a plain ratio. The maps are
    /// differenced within the piece of surface that holds the pixel, the weights analytically.
    ///
    /// `J = I + Σ_i [ w_i ∂offset_i/∂q + (offset_i + s_i − q_i) ∇w_iᵀ ]`.
    pub fn jacobian(&self, x: i32, y: i32) -> Mat2 {
        let q = self.center(x, y);
        if let Some((planes, (surface, x, y))) = self.planes.as_ref().zip(self.on_surface(x, y)) {
            let near = DifferencePairs::between_links(surface, x, y);
            let rows = [near.slope(|x, y| planes.at(x, y).x), near.slope(|x, y| planes.at(x, y).y)];
            return Mat2::from_cols(rows[0], rows[1]).transpose();
        }
        let anchors = self.anchors();
        let weights = self.weights.at(&anchors, q);
        let gradients = self.weights.gradients(&anchors, q);
        let mut jacobian = Mat2::IDENTITY;
        for ((pin, w), gradient) in self.pins.iter().zip(weights).zip(gradients) {
            let moved = self.offset(pin, q, x, y) + (pin.anchor.source - pin.anchor.at);
            jacobian += self.offset_jacobian(pin, q, x, y) * w + outer(moved, gradient);
        }
        jacobian
    }

    /// D at every pixel center of `rect`, which may reach beyond the canvas; within 10⁻⁴ px of
    /// [`Deformation::at`] on canvases up to 1024 px, and to f32's precision beyond.
    pub fn fill(&self, rect: Rect, out: &mut DeformedRect) {
        self.fill_rows(rect, |_| rect.x0..rect.x1, false, out);
    }

    /// The same in some columns of each row of `rect`, for the short rows of dabs; what `out` holds
    /// elsewhere is anything.
    pub fn fill_spans(
        &self,
        rect: Rect,
        columns: impl Fn(i32) -> Range<i32>,
        out: &mut DeformedRect,
    ) {
        self.fill_rows(rect, columns, true, out);
    }

    fn fill_rows(
        &self,
        rect: Rect,
        columns: impl Fn(i32) -> Range<i32>,
        are_short: bool,
        out: &mut DeformedRect,
    ) {
        let n = rect.width() * rect.height();
        out.rect = Some(rect);
        out.x.resize(n, 0.0);
        out.y.resize(n, 0.0);
        if !are_short || !fill::try_fill_dab(self, rect, &columns, &mut out.x, &mut out.y) {
            fill::fill(self, rect, &columns, &mut out.x, &mut out.y);
        }
        if let Some(reach) = self.reach.filter(|_| self.is_limited(rect)) {
            for (y, row) in (rect.y0..rect.y1).enumerate() {
                for x in columns(row).start.max(rect.x0)..columns(row).end.min(rect.x1) {
                    let i = y * rect.width() + (x - rect.x0) as usize;
                    let (mut q_x, mut q_y) = ([0.0], [0.0]);
                    self.place(x, row, &mut q_x, &mut q_y);
                    (out.x[i], out.y[i]) =
                        reach.limit(vec2(q_x[0], q_y[0]), vec2(out.x[i], out.y[i])).into();
                }
            }
        }
    }

    /// Of a dab that the surface is unwrapped under: the plane itself, where D is that, turned,
    /// over a rectangle and one more pixel around it.
    pub fn own_plane(&self, rect: Rect) -> Option<OwnPlane<'_>> {
        let planes = self.planes.as_ref()?;
        if self.is_on_far_side() || self.is_limited(rect.grown(1)) {
            return None;
        }
        planes.plane_over(rect)
    }

    /// Whether a reach changes D anywhere in a rectangle.
    pub fn is_limited(&self, rect: Rect) -> bool {
        self.reach.is_some_and(|reach| self.is_on_far_side() || reach.is_near(rect))
    }

    /// Its pixels lie anywhere on the canvas, not in rows.
    fn is_on_far_side(&self) -> bool {
        self.surface.is_some_and(|surface| surface.as_far_side().is_some())
    }

    /// The centers q of a row's pixels from column `x` on, canvas px; for a far side, of its readings.
    fn place(&self, x: i32, y: i32, q_x: &mut [f32], q_y: &mut [f32]) {
        match self.surface.filter(|_| self.is_on_far_side()) {
            Some(far) if y >= 0 => {
                for (x, (q_x, q_y)) in (x..).zip(q_x.iter_mut().zip(q_y)) {
                    let (x, y) = far.canvas_pixel(x.max(0), y);
                    (*q_x, *q_y) = self.center(x, y).into();
                }
            }
            _ => {
                let first = self.center(x, y);
                q_x.iter_mut().enumerate().for_each(|(k, q)| *q = first.x + k as i32 as f32);
                q_y.fill(first.y);
            }
        }
    }

    fn anchors(&self) -> Vec<Anchor> {
        self.pins.iter().map(|p| p.anchor).collect()
    }

    /// offset_i(q), 0 outside the surface.
    fn offset(&self, pin: &Pin, q: Vec2, x: i32, y: i32) -> Vec2 {
        let Some((surface, x, y)) = self.on_surface(x, y) else { return Vec2::ZERO };
        let offset = self.operator.offset(
            q - pin.anchor.at,
            map_values(surface, x, y),
            pin.map_values,
            self.unit_px,
        );
        self.detail_gain(x, y) * offset
    }

    fn offset_jacobian(&self, pin: &Pin, q: Vec2, x: i32, y: i32) -> Mat2 {
        let Some((surface, x, y)) = self.on_surface(x, y) else { return Mat2::ZERO };
        let (from_anchor, here) = (q - pin.anchor.at, map_values(surface, x, y));
        let offset = self.operator.offset(from_anchor, here, pin.map_values, self.unit_px);
        let jacobian = self.operator.offset_jacobian(
            from_anchor,
            here,
            slopes(surface, x, y),
            pin.map_values,
            self.unit_px,
        );
        let near = DifferencePairs::between_links(surface, x, y);
        jacobian * self.detail_gain(x, y) + outer(offset, near.slope(|x, y| self.detail_gain(x, y)))
    }

    /// 1 + μ κ(q): how much curvature scales the magnitude α (SF sec. 6, fig. 10).
    #[inline(always)]
    fn detail_gain(&self, x: usize, y: usize) -> f32 {
        self.curvature
            .as_ref()
            .map_or(1.0, |c| 1.0 + self.operator.detail() * c.kappa(x, y, DETAIL_SCALE_PX))
    }

    /// The surface and the pixel on it, if there is any surface at the pixel.
    fn on_surface(&self, x: i32, y: i32) -> Option<(&'a Surface, usize, usize)> {
        let surface =
            self.surface.filter(|s| s.coverage_plane().get(x, y).is_some_and(|c| c > 0))?;
        Some((surface, x as usize, y as usize))
    }
}

/// Weights with a power in `(0, 64]`; above that the nearest anchor has all the weight anyway.
fn sane(weights: Weights) -> Weights {
    match weights {
        Weights::Shepard { power } if power > 0.0 => Weights::Shepard { power: power.min(64.0) },
        Weights::Shepard { .. } => Weights::default(),
        Weights::Segment => Weights::Segment,
    }
}

/// What an anchor reads.
fn at_anchor(surface: &Surface, at: Vec2) -> MapValues {
    surface.values_at(at).unwrap_or(MapValues::BACKGROUND)
}

fn map_values(surface: &Surface, x: usize, y: usize) -> MapValues {
    MapValues { depth: surface.depth(x, y), nbar: surface.nbar(x, y), nz: surface.normal(x, y).z }
}

/// How the maps change at a pixel, within its piece of surface.
fn slopes(surface: &Surface, x: usize, y: usize) -> MapSlopes {
    let near = DifferencePairs::between_links(surface, x, y);
    let nbar = [near.slope(|x, y| surface.nbar(x, y).x), near.slope(|x, y| surface.nbar(x, y).y)];
    MapSlopes {
        depth: near.slope(|x, y| surface.depth(x, y)),
        nbar: Mat2::from_cols(nbar[0], nbar[1]).transpose(),
        nz: near.slope(|x, y| surface.normal(x, y).z),
    }
}

#[cfg(test)]
mod tests;
