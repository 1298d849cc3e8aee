//! D_s: how the plane of an unwrapped surface is laid under its anchors (MATH 8).
//! Floor 2. Not here: the unwrapping (`unwrap`), the operators that are sums over anchors (`Deformation::at`).
//!
//! Each object has a plane of its own: anchors move, and a pair of them turns, the plane of the object that they stand
//! on; the others stay where they are in the picture.

use crate::math::{Mat2, Vec2, vec2};
use crate::raster::Plane;
use crate::surface::unwrap::{PlanePlace, UnwrapSettings, Unwrapping};
use crate::surface::{Anchor, Surface, Weights};
use std::sync::Arc;

/// An unwrapped surface whose planes are laid under anchors.
pub(super) struct LaidPlanes<'a> {
    pub unwrapping: Arc<Unwrapping>,
    pub objects: &'a Plane<u32>,
    fits: Vec<PlaneFit>,
    /// What is not laid lies out of reach: a dab paints on the object under it alone.
    is_bounded: bool,
}

/// How one object's plane is laid: D = linear U + shift, then what its pins still lack.
pub(super) struct PlaneFit {
    pub object: u32,
    pub linear: Mat2,
    pub shift: Vec2,
    pins: Vec<PlanePin>,
    power: f32,
}

/// What a fit misses at one of its anchors.
#[derive(Clone, Copy)]
struct PlanePin {
    /// In the unwrapped plane.
    at: Vec2,
    lacks: Vec2,
}

/// How far away lies what a dab must not touch, px.
pub(super) const OUT_OF_REACH_PX: f32 = 1e6;

/// Below this a pin lacks nothing.
const MET_PX: f32 = 1e-3;

impl<'a> LaidPlanes<'a> {
    /// D(q_i) = s_i at every anchor. Two or more on one object turn its plane as a whole, so that they are met as
    /// nearly as a turn can; what each still lacks is shared by their weights, measured in the plane.
    ///
    /// With `Weights::Segment`, the gradient tool's, the plane is scaled as well: its two ends are met exactly, and the
    /// ramp runs evenly over the surface between them.
    pub fn pinned(surface: &'a Surface, settings: UnwrapSettings, anchors: &[Anchor], weights: Weights) -> Self {
        let unwrapping = surface.unwrapped(settings);
        // Anchors stand on the surface, also of a sheet.
        let whole = surface.sheet_of().and_then(|sheet| sheet.surface());
        let pinned = whole.as_deref().unwrap_or(surface);
        let laid = pinned.unwrapped(settings);
        let mut groups: Vec<(u32, Vec<(Vec2, Vec2)>)> = Vec::new();
        for anchor in anchors {
            let PlanePlace { object, at, .. } = laid.place(pinned, anchor.at);
            match groups.iter_mut().find(|(known, _)| *known == object) {
                Some((_, pairs)) => pairs.push((at, anchor.source)),
                None => groups.push((object, vec![(at, anchor.source)])),
            }
        }
        let fits = groups.iter().map(|(object, pairs)| PlaneFit::new(*object, pairs, weights)).collect();
        Self { unwrapping, objects: surface.objects().labels(), fits, is_bounded: false }
    }
    /// `D(q) − q_0 = R(q_0)ᵀ (U(q) − U(q_0))`: a decal, upright where it is put down.
    pub fn of_dab(surface: &'a Surface, settings: UnwrapSettings, at: Vec2) -> Self {
        let unwrapping = surface.unwrapped(settings);
        let whole = surface.sheet_of().and_then(|sheet| sheet.surface());
        let pinned = whole.as_deref().unwrap_or(surface);
        let PlanePlace { object, at: there, turn } = pinned.unwrapped(settings).place(pinned, at);
        let linear = turn.transpose();
        let fit = PlaneFit { object, linear, shift: at - linear * there, pins: Vec::new(), power: 2.0 };
        Self { unwrapping, objects: surface.objects().labels(), fits: vec![fit], is_bounded: true }
    }
    /// The same, laid wherever there is surface: what is not under the anchor stays where it is.
    pub fn unbounded(self) -> Self {
        Self { is_bounded: false, ..self }
    }
    /// D(q) at the centre of a pixel that the surface covers.
    pub fn at(&self, x: usize, y: usize) -> Vec2 {
        let (object, u) = (self.objects.at(x, y), self.unwrapping.at(x, y));
        match self.fits.iter().find(|fit| fit.object == object) {
            Some(fit) => fit.at(u),
            None if self.is_bounded => u + OUT_OF_REACH_PX,
            None => u,
        }
    }
    pub fn fits(&self) -> &[PlaneFit] {
        &self.fits
    }
    /// What is added where no fit is.
    pub fn elsewhere_px(&self) -> f32 {
        if self.is_bounded { OUT_OF_REACH_PX } else { 0.0 }
    }
}

impl PlaneFit {
    fn new(object: u32, pairs: &[(Vec2, Vec2)], weights: Weights) -> Self {
        let n = pairs.len().max(1) as f32;
        let (from, to) = pairs.iter().fold((Vec2::ZERO, Vec2::ZERO), |(a, b), (u, s)| (a + *u, b + *s));
        let (from, to) = (from / n, to / n);
        // Of all rotations the one that leaves the least, squared.
        let (mut dot, mut cross, mut spread) = (0.0, 0.0, 0.0);
        for (u, s) in pairs {
            let (u, s) = (*u - from, *s - to);
            (dot, cross, spread) = (dot + u.dot(s), cross + u.perp_dot(s), spread + u.length_squared());
        }
        let turned = vec2(dot, cross);
        let (linear, power) = match weights {
            _ if spread <= MET_PX || turned.length() <= MET_PX * spread => (Vec2::X, 2.0),
            Weights::Segment => (turned / spread, 2.0),
            Weights::Shepard { power } => (turned.normalize_or(Vec2::X), power),
        };
        let linear = Mat2::from_cols(linear, linear.perp());
        let shift = to - linear * from;
        let lacking = |(u, s): &(Vec2, Vec2)| PlanePin { at: *u, lacks: *s - (linear * *u + shift) };
        let mut pins: Vec<PlanePin> = pairs.iter().map(lacking).collect();
        if pins.iter().all(|pin| pin.lacks.length() < MET_PX) {
            pins.clear();
        }
        Self { object, linear, shift, pins, power }
    }
    pub fn is_rigid(&self) -> bool {
        self.pins.is_empty()
    }
    /// D of a point of the unwrapped plane.
    pub fn at(&self, u: Vec2) -> Vec2 {
        let laid = self.linear * u + self.shift;
        if self.pins.is_empty() {
            return laid;
        }
        let nearest = self.pins.iter().map(|pin| pin.at.distance_squared(u)).fold(f32::INFINITY, f32::min);
        if nearest < 1e-12 {
            return self.pins.iter().find(|pin| pin.at.distance_squared(u) == nearest).map_or(laid, |p| laid + p.lacks);
        }
        let (mut sum, mut lacks) = (0.0, Vec2::ZERO);
        for pin in &self.pins {
            let near = nearest / pin.at.distance_squared(u);
            let weight = if self.power == 2.0 { near } else { near.powf(0.5 * self.power) };
            (sum, lacks) = (sum + weight, lacks + weight * pin.lacks);
        }
        laid + lacks / sum
    }
}
