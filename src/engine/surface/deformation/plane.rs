//! D_s: how the plane of an unwrapped surface is laid under its anchors (MATH 8). Floor 2. Not
//! here: the unwrapping and its displacement by many anchors (`unwrap`), the operators that are sums
//! over anchors (`Deformation::at`).
//!
//! Each object has a plane of its own: anchors move, and a pair of them turns, the plane of the
//! object that they are on; the others stay where they are in the picture.

use crate::math::{Affine2, Mat2, Rect, Vec2, vec2};
use crate::raster::Plane;
use crate::surface::operator::UnwrapSettings;
use crate::surface::plane_piece::PlanePiece;
use crate::surface::pyramid::BLOCK;
use crate::surface::unwrap::{PlaneConstraint, PlaneDisplacement, PlanePlace, Unwrapping};
use crate::surface::{Bend, Objects, Surface, Weights};
use std::sync::Arc;

/// An unwrapped surface whose planes are laid under anchors.
pub(super) struct LaidPlanes {
    pub unwrapping: Arc<Unwrapping>,
    pub objects: Arc<Objects>,
    fits: Vec<PlaneFit>,
    /// How planes are displaced where a rigid fit misses anchors.
    pub displacement: Option<Arc<PlaneDisplacement>>,
    /// What is not laid lies out of reach: a dab paints on the object under it alone.
    is_bounded: bool,
    /// Where the anchor of a dab lies in the unwrapped plane.
    dab_at: Option<Vec2>,
}

/// The unwrapped plane under a dab, before it is turned: distances from the dab and lengths of
/// pixels are the same.
pub struct OwnPlane<'p> {
    /// The plane's first coordinates, one a pixel.
    pub x: &'p Plane<f32>,
    /// The plane's second coordinates, one a pixel.
    pub y: &'p Plane<f32>,
    /// The dab's center there.
    pub at: Vec2,
}

/// How one object's plane is laid: D = linear U + shift, and where its anchors pull it, `pulled`
/// times its displacement.
pub(super) struct PlaneFit {
    pub object: u32,
    pub linear: Mat2,
    pub shift: Vec2,
    pub pulled: Option<Mat2>,
}

/// An anchor's place in the unwrapped plane, and where it is to lie.
#[derive(Clone, Copy)]
struct PlanePin {
    /// Canvas px.
    on_canvas: Vec2,
    at: Vec2,
    source: Vec2,
}

/// The distance of what a dab must not touch, px.
pub(super) const OUT_OF_REACH_PX: f32 = 1e6;

/// Below this a pin lacks nothing.
const MET_PX: f32 = 1e-3;

impl LaidPlanes {
    /// D(q_i) = s_i at every anchor. Two or more on one object turn its plane as a whole, so that
    /// they are met as nearly as a turn can; what each still lacks is a constraint on the plane's
    /// displacement, by the equation that unwrapped it.
    ///
    /// With `Weights::Segment`, the gradient tool's, the plane is scaled as well: its two ends are
    /// met exactly, and the ramp runs evenly over the surface between them.
    ///
    /// Then the picture is turned, moved and scaled on the bend's pieces.
    pub fn pin_anchors(surface: &Surface, settings: UnwrapSettings, bend: &Bend) -> Self {
        let unwrapping = surface.unwrapping(settings);
        // Anchors are on the surface in front, also for a far side.
        let front = surface.front();
        let pinned = front.as_deref().unwrap_or(surface);
        let laid = pinned.unwrapping(settings);
        let mut groups: Vec<(u32, Vec<PlanePin>)> = Vec::new();
        for anchor in &bend.anchors {
            let PlanePlace { object, at, .. } = laid.place(pinned, anchor.at);
            let pin = PlanePin { on_canvas: anchor.at, at, source: anchor.source };
            match groups.iter_mut().find(|(known, _)| *known == object) {
                Some((_, pins)) => pins.push(pin),
                None => groups.push((object, vec![pin])),
            }
        }
        let mut constraints = Vec::new();
        let fits: Vec<PlaneFit> = groups
            .iter()
            .map(|(object, pins)| PlaneFit::new(*object, pins, bend.weights, &mut constraints))
            .collect();
        let displacement = displacement_of(surface, settings, &constraints);
        let mut laid = Self {
            unwrapping,
            objects: surface.objects(),
            fits,
            displacement,
            is_bounded: false,
            dab_at: None,
        };
        let of_whole = displacement_of(pinned, settings, &constraints);
        bend.pieces
            .iter()
            .for_each(|piece| laid.set_apart(pinned, settings, piece, of_whole.as_deref()));
        laid
    }

    /// Turns, moves and scales the picture on the piece that a point lies on.
    fn set_apart(
        &mut self,
        surface: &Surface,
        settings: UnwrapSettings,
        piece: &PlanePiece,
        displacement: Option<&PlaneDisplacement>,
    ) {
        if piece.is_still() || !piece.at.is_finite() {
            return;
        }
        let PlanePlace { object, at, .. } = surface.unwrapping(settings).place(surface, piece.at);
        let fit = match self.fits.iter().position(|fit| fit.object == object) {
            Some(known) => &mut self.fits[known],
            None => {
                self.fits.push(PlaneFit {
                    object,
                    linear: Mat2::IDENTITY,
                    shift: Vec2::ZERO,
                    pulled: None,
                });
                let last = self.fits.len() - 1;
                &mut self.fits[last]
            }
        };
        let displaced = displacement.map_or(Vec2::ZERO, |displacement| {
            surface.interpolate(piece.at, |x, y| displacement.at(x, y))
        });
        let shown = fit.at(at, displaced);
        let Affine2 { matrix2, .. } = fit.look_up(piece.picture_from_plane(shown));
        fit.pulled = fit.pulled.map(|pulled| matrix2 * pulled);
    }

    /// `D(q) − q_0 = R(q_0)ᵀ (U(q) − U(q_0))`: a decal, upright where it is put down.
    pub fn of_dab(surface: &Surface, settings: UnwrapSettings, at: Vec2) -> Self {
        let unwrapping = surface.unwrapping(settings);
        let front = surface.front();
        let pinned = front.as_deref().unwrap_or(surface);
        let PlanePlace { object, at: there, turn } = pinned.unwrapping(settings).place(pinned, at);
        let linear = turn.transpose();
        let fit = PlaneFit { object, linear, shift: at - linear * there, pulled: None };
        Self {
            unwrapping,
            objects: surface.objects(),
            fits: vec![fit],
            displacement: None,
            is_bounded: true,
            dab_at: Some(there),
        }
    }

    /// The same, laid wherever there is surface: what is not under the anchor stays where it is.
    pub fn unbounded(self) -> Self {
        Self { is_bounded: false, ..self }
    }

    /// D(q) at the center of a pixel that the surface covers.
    pub fn at(&self, x: usize, y: usize) -> Vec2 {
        let (object, u) = (self.objects.labels().at(x, y), self.unwrapping.at(x, y));
        match self.fits.iter().find(|fit| fit.object == object) {
            Some(fit) => fit.at(
                u,
                self.displacement.as_ref().map_or(Vec2::ZERO, |displacement| displacement.at(x, y)),
            ),
            None if self.is_bounded => u + OUT_OF_REACH_PX,
            None => u,
        }
    }

    /// For a dab: its plane itself, over a rectangle and one more pixel around it, if all of that
    /// is on its object.
    pub fn plane_over(&self, rect: Rect) -> Option<OwnPlane<'_>> {
        let ([fit], Some(at)) = (&self.fits[..], self.dab_at) else { return None };
        let blocks = self.objects.objects_of_blocks();
        let (x0, y0) = (rect.x0.max(0) as usize / BLOCK, rect.y0.max(0) as usize / BLOCK);
        let (x1, y1) = (rect.x1.max(0) as usize, rect.y1.max(0) as usize);
        let (x1, y1) =
            (x1.div_ceil(BLOCK).min(blocks.width()), y1.div_ceil(BLOCK).min(blocks.height()));
        let is_own =
            |y: usize| blocks.row(y)[x0.min(x1)..x1].iter().all(|object| *object == fit.object);
        let [x, y] = self.unwrapping.planes();
        (!rect.is_empty() && fit.object > 0 && (y0..y1).all(is_own)).then_some(OwnPlane {
            x,
            y,
            at,
        })
    }

    pub fn fits(&self) -> &[PlaneFit] {
        &self.fits
    }

    /// What is added where no fit is.
    pub fn default_shift_px(&self) -> f32 {
        if self.is_bounded { OUT_OF_REACH_PX } else { 0.0 }
    }
}

/// The displacement of a surface's planes under some constraints, if there are any.
fn displacement_of(
    surface: &Surface,
    settings: UnwrapSettings,
    constraints: &[PlaneConstraint],
) -> Option<Arc<PlaneDisplacement>> {
    (!constraints.is_empty()).then(|| surface.plane_displacement(settings, constraints))
}

impl PlaneFit {
    /// The rigid part of a fit; where it misses a pin, all of them are held.
    fn new(
        object: u32,
        pins: &[PlanePin],
        weights: Weights,
        constraints: &mut Vec<PlaneConstraint>,
    ) -> Self {
        let n = pins.len().max(1) as f32;
        let (from, to) =
            pins.iter().fold((Vec2::ZERO, Vec2::ZERO), |(a, b), pin| (a + pin.at, b + pin.source));
        let (from, to) = (from / n, to / n);
        // The rotation that leaves the least, squared.
        let (mut dot, mut cross, mut spread) = (0.0, 0.0, 0.0);
        for pin in pins {
            let (u, s) = (pin.at - from, pin.source - to);
            (dot, cross, spread) =
                (dot + u.dot(s), cross + u.perp_dot(s), spread + u.length_squared());
        }
        let turned = vec2(dot, cross);
        let linear = match weights {
            _ if spread <= MET_PX || turned.length() <= MET_PX * spread => Vec2::X,
            Weights::Segment => turned / spread,
            Weights::Shepard { .. } => turned.normalize_or(Vec2::X),
        };
        let linear = Mat2::from_cols(linear, linear.perp());
        let shift = to - linear * from;
        let held = |pin: &PlanePin| PlaneConstraint {
            at: pin.on_canvas,
            displacement: pin.source - (linear * pin.at + shift),
        };
        let held: Vec<PlaneConstraint> = pins.iter().map(held).collect();
        // Anchors thrown beyond all reach are met by no plane.
        let is_pulled = held.iter().any(|constraint| constraint.displacement.length() >= MET_PX)
            && held.iter().all(|constraint| constraint.displacement.is_finite());
        if is_pulled {
            constraints.extend(held);
        }
        Self { object, linear, shift, pulled: is_pulled.then_some(Mat2::IDENTITY) }
    }

    /// Looks a picture up where `look` leads what was looked up before; returns it.
    fn look_up(&mut self, look: Affine2) -> Affine2 {
        (self.linear, self.shift) = (look.matrix2 * self.linear, look.transform_point2(self.shift));
        look
    }

    /// D of a point of the unwrapped plane.
    ///
    /// * `displacement`: of the plane there; only where anchors pull.
    #[inline(always)]
    pub fn at(&self, u: Vec2, displacement: Vec2) -> Vec2 {
        let laid = self.linear * u + self.shift;
        self.pulled.map_or(laid, |pulled| laid + pulled * displacement)
    }
}
